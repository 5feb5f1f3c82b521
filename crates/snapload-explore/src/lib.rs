//! The page of `snapload explore`, and the server that computes for it.
//!
//! A browser on the same machine shows the page and asks over a few paths: `/api/schema` says which
//! keys there are, `/api/case` reads a case file, `/api/run` runs a case, `/api/map` runs the cases
//! of a map, `/api/proof` proves a run, `/api/export/NAME` gives the files that the command
//! `snapload run --out` writes. `/api/structure` and the paths below it do the same for structures
//! in metres and kilonewtons, in the words of `snapload assess`. All numbers are the library's;
//! nothing is computed by the page.
//!
//! Nobody else is served: the server listens on the loopback address alone, answers only to its own
//! name, which keeps out pages of other sites that have the browser ask for them, and bounds what
//! one request may cost.

mod api;
mod basin;
mod case_file;
mod export;
mod guard;
mod map;
mod order;
mod page;
mod proof;
mod question;
mod refusal;
mod request;
mod run;
mod schema;
mod section;
mod server;
mod structure;
mod work;

pub use schema::Start;
pub use server::{Server, Stop};
pub use structure::Opened;
