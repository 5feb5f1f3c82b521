//! Studies: many cases, one row each, in one Parquet file.
//!
//! A [`Study`] is a base case and a [`Plan`]: axes of a grid, Sobol points in a box, or a list.
//! Case i does not depend on the ones before it, so a study can be divided anywhere: into chunks,
//! into shards for several machines, at the point where a run was killed. Only [`rows()`] turns
//! cases into rows; a [`Store`] keeps each chunk as a file of its own until all are complete, and
//! then joins them. The contents of the file depend on the study alone, to the byte: not on
//! threads, chunks, shards or interruptions. Each file contains its checksum, which is checked
//! before its rows are copied into another one.

mod checksum;
mod csv_table;
mod error;
mod grid;
mod lines;
mod list;
mod metadata;
mod parquet_file;
mod parquet_writer;
#[cfg(feature = "pictures")]
mod picture;
mod plan;
mod rows;
mod sobol;
mod store;
mod study;
mod study_file;
mod sweep;
mod table;
mod table_file;
mod threads;

pub use csv_table::{in_digits_with_fraction, write_csv, write_study_csv};
pub use error::{Occupied, StudyError, no_random_range, without_number};
pub use grid::Grid;
pub use list::List;
pub use metadata::{Identity, Shard};
pub use parquet_file::{ColumnType, Values};
#[cfg(feature = "pictures")]
pub use picture::{StudyPicture, key_label, with_unit};
pub use plan::{Axis, MOST_CASES, Plan, RANDOM, RandomRange, written_grid};
pub use rows::{Row, Run, rows};
pub use sobol::Sobol;
pub use store::{Opened, Store, check_name, chunk, folder_of, parent_of};
pub use study::{NoCase, Study, StudyCases};
pub use study_file::{
    ShownValue, StudyEnds, checked_identity, columns_of_files, ends, identity_of, merge, read_rows,
    read_shown,
};
pub use sweep::sweep;
pub use table::{Column, ColumnValue, columns};
pub use table_file::write_table;
pub use threads::{THREADS, threads_for};
