//! `snapload keys`: the schema of a case, for reading.
use crate::failure::{Failure, print};
use snapload::CASE;

const FOOTER: &str = "
Units: lengths in L (half the distance between the anchors), m the mass of the body, F its net
buoyancy, T = sqrt(m L / F). h = sqrt(r^2 - (1 - a)^2) is derived and never given.
In a file one `key = value` per line; on the command line --set key=value.
";

/// Prints it.
pub(crate) fn run() -> Result<(), Failure> {
    print(&format!("{}{FOOTER}", CASE.listing()))
}
