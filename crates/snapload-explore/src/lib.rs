//! The page of `snapload explore`, and the server that computes for it.
//!
//! A browser on the same machine shows the page and requests a few paths: `/api/schema` lists the
//! keys, `/api/case` reads a case file, `/api/run` runs a case, `/api/instant` gives its motion at
//! one time, `/api/map` runs the cases of a map, `/api/proof` proves a run, and `/api/export/NAME`
//! gives the files that the command `snapload run --out` writes. `/api/structure` and the paths
//! below it do the same for structures in metres and kilonewtons, with the texts of `snapload
//! assess`. All numbers are computed by the library, none by the page.
//!
//! No other machine is served: the server listens on the loopback address alone, answers only to
//! its own host name, which excludes pages of other sites that make the browser send requests, and
//! limits the cost of each request.

mod api;
mod basin;
mod case_file;
mod export;
mod host_check;
mod instant;
mod map;
mod motion;
mod order;
mod outcome;
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
