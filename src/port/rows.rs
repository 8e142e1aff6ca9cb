//! Reads CSV that somebody else has written: a header, and rows with the lines they stand in.

use crate::scene::fault::Fault;
use csv::StringRecord;
use std::io::Read;

/// Reads all of `input`.
///
/// Errors: [`Fault::Read`].
pub fn text(name: &str, mut input: impl Read) -> Result<Vec<u8>, Fault> {
    let mut text = Vec::new();
    match input.read_to_end(&mut text) {
        Ok(_) => Ok(text),
        Err(source) => Err(Fault::Read { path: name.into(), source }),
    }
}

/// The rows of a CSV file come one after the other.
pub struct Rows<'a> {
    name: &'a str,
    /// What a header line may be, for errors.
    wanted: String,
    pub header: StringRecord,
    reader: csv::Reader<&'a [u8]>,
    lines: Lines<'a>,
}

impl<'a> Rows<'a> {
    /// Reads the header. Cells are trimmed.
    ///
    /// Errors: [`Fault::Points`]: bytes that are not UTF-8, a column that is there twice.
    pub fn of(name: &'a str, text: &'a [u8], wanted: String) -> Result<Self, Fault> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text);
        let header = match reader.headers() {
            Ok(header) => header.clone(),
            Err(error) => {
                let problem = plain(&error);
                return Err(Fault::Points { path: name.into(), line: 1, problem, allowed: wanted });
            }
        };
        let lines = Lines { text, at: 0, line: 1 };
        let rows = Rows { name, wanted, header, reader, lines };
        for (n, column) in rows.header.iter().enumerate() {
            if rows.header.iter().take(n).any(|before| before == column) {
                let problem = format!("the column `{}` is there twice", brief(column));
                return Err(rows.no_header(problem));
            }
        }
        Ok(rows)
    }

    /// Gives the next row with its line, `None` behind the last.
    ///
    /// Errors: [`Fault::Points`]: bytes that are not UTF-8, more or fewer cells than
    /// the header has, a cell that goes on in the next line.
    pub fn next_row(&mut self) -> Result<Option<(u64, StringRecord)>, Fault> {
        let mut record = StringRecord::new();
        let more = self.reader.read_record(&mut record).map_err(|error| {
            let line = error.position().map_or(0, |position| self.lines.of(position.byte()));
            self.fault(line, plain(&error), format!("{} cells, as in line 1", self.header.len()))
        })?;
        if !more {
            return Ok(None);
        }
        let line = record.position().map_or(0, |position| self.lines.of(position.byte()));
        if let Some(cell) = record.iter().find(|cell| cell.contains(['\n', '\r'])) {
            let problem = format!("the quoted cell `{}` goes on in the next line", brief(cell));
            return Err(self.fault(line, problem, "cells that end in their line".into()));
        }
        Ok(Some((line, record)))
    }

    /// Makes a fault in a line of this file.
    pub fn fault(&self, line: u64, problem: String, allowed: String) -> Fault {
        Fault::Points { path: self.name.to_string(), line, problem, allowed }
    }

    /// Makes the fault of a header that does not have the right columns.
    pub fn no_header(&self, problem: String) -> Fault {
        self.fault(1, problem, self.wanted.clone())
    }
}

/// Gives the beginning of a text that may be long, in one line.
pub fn brief(text: &str) -> String {
    let line = text.lines().next().unwrap_or("");
    let start: String = line.chars().take(40).collect();
    if start.len() < text.len() { start + "…" } else { start }
}

/// Says what is wrong, without the place, which is named by line.
fn plain(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("{len} cells instead of {expected_len}")
        }
        csv::ErrorKind::Utf8 { .. } => "there are bytes that are not UTF-8".to_string(),
        _ => error.to_string(),
    }
}

/// This counts lines up to a place in a text; places must ascend.
struct Lines<'a> {
    text: &'a [u8],
    at: usize,
    line: u64,
}

impl Lines<'_> {
    /// Gives the line of the first row that begins at byte `start` or, behind the ends of
    /// lines that stand there, after it. A line ends with \n, \r or both.
    fn of(&mut self, start: u64) -> u64 {
        while let Some(byte) = self.text.get(self.at) {
            let ends = [b'\n', b'\r'].contains(byte);
            if self.at as u64 >= start && !ends {
                break;
            }
            let inside = *byte == b'\r' && self.text.get(self.at + 1) == Some(&b'\n');
            self.line += u64::from(ends && !inside);
            self.at += 1;
        }
        self.line
    }
}
