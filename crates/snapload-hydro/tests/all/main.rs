//! Coefficients, memory and linear answers against files of panel codes and independent results.
mod bad_files;
mod common;
mod damped;
mod decay;
mod given;
mod linear;
mod memory;
mod panel_files;
mod places;
mod readers;
mod repeated;
mod report;
mod reports_on_memory;
mod rest;
mod seas;
mod sections;
mod textbook;
