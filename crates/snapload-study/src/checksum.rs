//! The checksum of a file, stored in the file itself.
//!
//! A Parquet file ends with metadata, of which readers skip entries that they do not know. The last
//! entry here is the SHA-256 of the whole file, computed with zeros in place of its own digits. So
//! every bit of a file is covered, a part that is copied to another machine contains its checksum,
//! and it is still an ordinary Parquet file.

use crate::without_number;
use parquet::file::metadata::KeyValue;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// The name of the entry.
const NAME: &str = "snapload.sha256";
/// The number of its digits.
const DIGITS: usize = 64;
/// The bytes between the name and the digits: the next field, a text, of 64 bytes.
const BETWEEN: [u8; 2] = [0x18, 0x40];
/// A Parquet file ends with the length of its metadata in four bytes, and these four letters.
const END: &[u8; 4] = b"PAR1";

/// The entry of a file whose checksum is not known yet; it has to be the last one.
pub(crate) fn blank_entry() -> KeyValue {
    KeyValue::new(NAME.to_owned(), "0".repeat(DIGITS))
}

/// Writes the checksum into a file that has a blank entry.
pub(crate) fn write_checksum(mut file: impl Read + Write + Seek) -> io::Result<()> {
    let stored = StoredChecksum::find(&mut file)?;
    let stored = stored.ok_or_else(|| io::Error::other("there is no room for its checksum"))?;
    let digits = stored.computed(&mut file)?;
    file.seek(SeekFrom::Start(stored.place))?;
    file.write_all(digits.as_bytes())
}

/// Why a file differs from what was written; none if it does not.
pub(crate) fn damage(path: &Path) -> Option<String> {
    match File::open(path).and_then(damage_of) {
        Ok(damage) => damage.map(str::to_owned),
        Err(error) => Some(without_number(&error)),
    }
}

/// The same for bytes or an open file.
pub(crate) fn damage_of(mut file: impl Read + Seek) -> io::Result<Option<&'static str>> {
    let Some(stored) = StoredChecksum::find(&mut file)? else {
        return Ok(Some(
            "it is damaged, or not a Parquet file of snapload sweep",
        ));
    };
    let intact = stored.computed(&mut file)?.as_bytes() == stored.there;
    Ok((!intact).then_some("it is damaged: its checksum is not that of its bytes"))
}

/// A checksum in a file: its position, and its digits.
struct StoredChecksum {
    place: u64,
    there: [u8; DIGITS],
}

impl StoredChecksum {
    fn find(file: &mut (impl Read + Seek)) -> io::Result<Option<Self>> {
        let size = file.seek(SeekFrom::End(0))?;
        let Some(end) = size.checked_sub(8) else {
            return Ok(None);
        };
        let mut last = [0; 8];
        file.seek(SeekFrom::Start(end))?;
        file.read_exact(&mut last)?;
        let [a, b, c, d, letters @ ..] = last;
        let length = u64::from(u32::from_le_bytes([a, b, c, d]));
        let Some(start) = end.checked_sub(length).filter(|_| letters == *END) else {
            return Ok(None);
        };
        let mut notes = vec![0; length as usize];
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(&mut notes)?;
        let mut names = notes.windows(NAME.len());
        let found = names.rposition(|name| name == NAME.as_bytes());
        let digits = found.and_then(|found| {
            let value = found + NAME.len();
            let place = value + BETWEEN.len();
            let there = notes.get(place..place + DIGITS)?.try_into().ok()?;
            (notes[value..place] == BETWEEN).then_some((place as u64, there))
        });
        Ok(digits.map(|(place, there)| Self {
            place: start + place,
            there,
        }))
    }

    /// The digits that are computed from the file.
    fn computed(&self, file: &mut (impl Read + Seek)) -> io::Result<String> {
        let mut sum = Sum::default();
        file.rewind()?;
        sum.add(file.take(self.place))?;
        sum.add(&[b'0'; DIGITS][..])?;
        file.seek(SeekFrom::Start(self.place + DIGITS as u64))?;
        sum.add(file)?;
        Ok(sum.digits())
    }
}

/// A SHA-256 that is being computed.
#[derive(Default)]
pub(crate) struct Sum(Sha256);

impl Sum {
    /// Includes everything from a reader.
    pub(crate) fn add(&mut self, mut from: impl Read) -> io::Result<()> {
        let mut buffer = vec![0; 1 << 16];
        loop {
            let length = from.read(&mut buffer)?;
            if length == 0 {
                return Ok(());
            }
            self.0.update(&buffer[..length]);
        }
    }

    /// In the form of `sha256sum`.
    pub(crate) fn digits(self) -> String {
        let mut digits = String::with_capacity(DIGITS);
        for byte in self.0.finalize() {
            // Writing to a string can not fail.
            let _ = write!(digits, "{byte:02x}");
        }
        digits
    }
}
