//! The properties of certificates, one file for each reference or kind of test.
mod alterations;
mod borders;
mod common;
mod grazes;
mod oracle;
mod taut;
