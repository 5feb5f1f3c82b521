//! Proves anew what is kept with the program: `data/proved.csv` and `data/stretches.csv`. It takes
//! minutes.

use std::{error::Error, fs, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    fs::write(
        data.join("stretches.csv"),
        snapload_reproduce::taut_intervals()?,
    )?;
    fs::write(data.join("proved.csv"), snapload_reproduce::proofs()?)?;
    Ok(())
}
