//! Motions with many digits, with which an ordinary run is compared.
//!
//! The motion is that of the library, over numbers of many digits. It is compiled here, as each
//! crate that uses those numbers would otherwise compile the whole engine for them again.
//!
//! ```
//! use snapload::analysis::{Unfinished, no_progress};
//! use snapload::{Case, Parameters};
//!
//! let case = Case::new(Parameters::STANDARD)?;
//! let found = snapload_verify::verify(&case, 60, 1e-3, &no_progress)?;
//! assert_eq!(found.impacts.len(), 290);
//! assert!(found.first_wrong > Some(180));
//! # Ok::<(), Unfinished>(())
//! ```

mod decimals;
mod digits_left;
mod many_digits;
mod verify;

pub use many_digits::RoundedRun;
pub use verify::{ExactImpact, MOST_DIGITS, Verification, verify, verify_as_written};
