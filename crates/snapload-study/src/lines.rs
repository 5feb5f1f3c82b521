//! The lines of a CSV file: checks while it is read, and where its records begin.
//!
//! A reader of CSV accepts records of any length, and a quote that is not closed includes the lines
//! that follow, up to the end of the file. No key has a value of two lines, so both are errors;
//! they are reported here, with their line, before much is read.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::ops::ControlFlow;
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

/// Where a record of a file begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RecordStart {
    /// Its number; that of the header is 0.
    pub(crate) number: u64,
    /// Its line, from 1.
    line: u64,
    /// Its first byte.
    pub(crate) byte: u64,
}

/// Passes the start of each record, until `visit` breaks, and returns the number of empty lines
/// that no record follows.
///
/// A line without any byte is no record, except for `empty_cells`: in a list of one column such a
/// line is how other programs write an empty cell, unless it precedes the header, or no other line
/// follows.
pub(crate) fn records(
    path: &Path,
    empty_cells: bool,
    mut visit: impl FnMut(RecordStart) -> ControlFlow<()>,
) -> io::Result<u64> {
    let mut bytes = BufReader::new(File::open(path)?);
    let (mut lines, mut place, mut number) = (LineChecker::new(), 0, 0);
    let mut empty: Vec<(u64, u64)> = Vec::new();
    loop {
        let some = bytes.fill_buf()?;
        let length = some.len();
        for (byte, place) in some.iter().zip(place..) {
            let (before, line, returned) = (lines.state, lines.line, lines.returned);
            lines.read_byte(*byte);
            if before != RecordState::Record {
                continue;
            }
            if lines.state != RecordState::Record {
                for (line, byte) in empty.drain(..).chain([(line, place)]) {
                    let start = RecordStart { number, line, byte };
                    if visit(start).is_break() {
                        return Ok(0);
                    }
                    number += 1;
                }
            } else if empty_cells && number > 0 && (*byte == b'\r' || *byte == b'\n' && !returned) {
                empty.push((line, place));
            }
        }
        lines.check(length == 0)?;
        if length == 0 {
            return Ok(empty.len() as u64);
        }
        place += length as u64;
        bytes.consume(length);
    }
}

/// The line in which a record begins, from 1; the first record has the number 0.
pub(crate) fn line_of(path: &Path, empty_cells: bool, record: u64) -> io::Result<Option<u64>> {
    let mut found = None;
    records(path, empty_cells, |start| {
        found = (start.number == record).then_some(start.line);
        match found {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        }
    })?;
    Ok(found)
}

/// The records of a list of one column, in which an empty line is passed on as the quotes of an
/// empty cell: a reader of CSV skips lines without any byte.
pub(crate) struct EmptyCells<R> {
    file: R,
    /// Whether the next byte begins a line, and whether a carriage return came before.
    begins: bool,
    returned: bool,
    ready: VecDeque<u8>,
}

impl<R> EmptyCells<R> {
    /// From the begin of a line on.
    pub(crate) fn new(file: R) -> Self {
        let ready = VecDeque::new();
        Self {
            file,
            begins: true,
            returned: false,
            ready,
        }
    }
}

impl<R: Read> Read for EmptyCells<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.ready.is_empty() {
            let mut some = [0; 1 << 12];
            let length = self.file.read(&mut some)?;
            for byte in &some[..length] {
                let new_line = matches!(byte, b'\r' | b'\n');
                if new_line && self.begins && !(*byte == b'\n' && self.returned) {
                    self.ready.extend(b"\"\"");
                }
                self.ready.push_back(*byte);
                (self.begins, self.returned) = (new_line, *byte == b'\r');
            }
        }
        self.ready.read(buffer)
    }
}
