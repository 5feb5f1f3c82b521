//! Checks of the lines of a CSV file while it is read.
//!
//! A reader of CSV accepts records of any length, and a quote that is not closed includes the lines
//! that follow, up to the end of the file. No key has a value of two lines, so both are errors;
//! they are reported here, with their line, before much is read.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// The longest record, which is many times what all keys need.
const LONGEST_RECORD: usize = 1 << 20;
/// The byte order mark that some programs write before the first letter.
const BYTE_ORDER_MARK: &[u8; 3] = b"\xef\xbb\xbf";

/// The position of the next byte in a record, as the `csv` crate parses it.
#[derive(Clone, Copy, Debug, PartialEq)]
enum RecordState {
    /// Before its first byte; a line without any is no record.
    Record,
    /// Before a cell, where a quote opens.
    Cell,
    /// Within a cell.
    Plain,
    /// Within quotes.
    Quoted,
    /// After a quote within quotes, which closes them unless another one follows.
    Quote,
    /// After the end of a line that was within quotes.
    Open,
}

/// Follows records byte by byte.
#[derive(Debug)]
struct LineChecker {
    state: RecordState,
    /// The line, from 1.
    line: u64,
    /// Whether the last byte was a carriage return, whose line feed does not count as another line.
    returned: bool,
    /// The length of the record so far.
    length: usize,
    /// The number of bytes of a byte order mark that were read, if nothing else was.
    mark: usize,
}

impl LineChecker {
    fn new() -> Self {
        Self {
            state: RecordState::Record,
            line: 1,
            returned: false,
            length: 0,
            mark: 0,
        }
    }

    fn read_byte(&mut self, byte: u8) {
        if BYTE_ORDER_MARK.get(self.mark) == Some(&byte) {
            self.mark += 1;
            return;
        }
        self.mark = BYTE_ORDER_MARK.len();
        if self.state == RecordState::Open || self.length > LONGEST_RECORD {
            return;
        }
        let new_line = matches!(byte, b'\r' | b'\n');
        self.state = match (self.state, byte) {
            (RecordState::Quoted, b'"') => RecordState::Quote,
            (RecordState::Quoted, _) if new_line => RecordState::Open,
            (RecordState::Quote | RecordState::Record | RecordState::Cell, b'"') => {
                RecordState::Quoted
            }
            (RecordState::Quoted, _) => RecordState::Quoted,
            (_, b',') => RecordState::Cell,
            _ if new_line => RecordState::Record,
            _ => RecordState::Plain,
        };
        if self.state == RecordState::Open {
            return;
        }
        self.line += u64::from(new_line && !(byte == b'\n' && self.returned));
        self.returned = byte == b'\r';
        self.length = match self.state {
            RecordState::Record => 0,
            _ => self.length + 1,
        };
    }

    /// Reports an error found so far.
    fn check(&self, ended: bool) -> io::Result<()> {
        let open = self.state == RecordState::Open || ended && self.state == RecordState::Quoted;
        let line = self.line;
        let words = if open {
            format!("line {line} opens a quote and does not close it; close it, or leave it out")
        } else if self.length > LONGEST_RECORD {
            format!(
                "line {line} is longer than {LONGEST_RECORD} bytes; a list has one case per line"
            )
        } else {
            return Ok(());
        };
        Err(io::Error::new(io::ErrorKind::InvalidData, words))
    }
}

/// A file whose lines are checked while it is read.
#[derive(Debug)]
pub(crate) struct CheckedFile {
    file: File,
    lines: LineChecker,
}

impl CheckedFile {
    pub(crate) fn open(path: &Path) -> io::Result<Self> {
        let (file, lines) = (File::open(path)?, LineChecker::new());
        Ok(Self { file, lines })
    }
}

impl Read for CheckedFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.file.read(buffer)?;
        for byte in &buffer[..length] {
            self.lines.read_byte(*byte);
        }
        self.lines.check(length == 0 && !buffer.is_empty())?;
        Ok(length)
    }
}

/// The line in which a record begins, from 1; the first record has the number 0.
pub(crate) fn line_of(path: &Path, record: u64) -> io::Result<Option<u64>> {
    let mut bytes = BufReader::new(File::open(path)?);
    let (mut lines, mut before) = (LineChecker::new(), 0);
    loop {
        let some = bytes.fill_buf()?;
        if some.is_empty() {
            return Ok(None);
        }
        let length = some.len();
        for byte in some {
            let (state, line) = (lines.state, lines.line);
            lines.read_byte(*byte);
            if state == RecordState::Record && lines.state != RecordState::Record {
                if before == record {
                    return Ok(Some(line));
                }
                before += 1;
            }
        }
        bytes.consume(length);
    }
}
