//! What a run writes: tables of numbers as CSV, each file complete or not there.

use crate::fault::Fault;
use std::fs;
use std::path::Path;

/// A table of numbers with a name for each column, kept row after row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    pub columns: Vec<String>,
    values: Vec<f64>,
}

impl Table {
    /// An empty table with room for `rows`.
    pub fn new(columns: Vec<String>, rows: usize) -> Self {
        let values = Vec::with_capacity(rows * columns.len());
        Table { columns, values }
    }

    /// Adds a number to the row that is being written, column by column.
    pub fn push(&mut self, value: f64) {
        self.values.push(value);
    }

    /// All complete rows.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[f64]> + ExactSizeIterator {
        self.values.chunks_exact(self.columns.len())
    }

    /// The column called `name`.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let at = self.columns.iter().position(|column| column == name)?;
        Some(self.rows().map(|row| row[at]).collect())
    }

    /// The table as CSV with a header line.
    pub fn csv(&self) -> Result<Vec<u8>, Fault> {
        let rows = self.rows().map(|row| row.iter().map(|x| shortest(*x)).collect());
        csv(&self.columns, rows)
    }
}

/// Lines of text as CSV with a header line.
pub fn csv(
    header: &[impl AsRef<[u8]>],
    rows: impl Iterator<Item = Vec<String>>,
) -> Result<Vec<u8>, Fault> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let fault = |error: std::io::Error| Fault::Write { path: "CSV".into(), source: error };
    writer.write_record(header).map_err(|error| fault(error.into()))?;
    for row in rows {
        writer.write_record(row).map_err(|error| fault(error.into()))?;
    }
    writer.into_inner().map_err(|error| fault(error.into_error()))
}

/// The shortest decimal that reads back as the same number; whole numbers
/// below 1e15 without a point, −0 as 0.
pub fn shortest(x: f64) -> String {
    let x = x + 0.0;
    if x == libm::trunc(x) && libm::fabs(x) < 1e15 { format!("{x}") } else { format!("{x:?}") }
}

/// Writes all `files` into `dir`, each complete or not at all, and removes the
/// `stale` ones of an earlier run, so that a directory does not mix two runs.
///
/// Errors: [`Fault::Write`] with the path.
pub fn write_all(dir: &Path, files: &[(String, Vec<u8>)], stale: &[String]) -> Result<(), Fault> {
    let fault = |path: &Path, source| Fault::Write { path: path.to_path_buf(), source };
    for (name, _) in files {
        // What is not a file of its own (a device, a pipe, a link) would be replaced by one.
        let path = dir.join(name);
        if fs::symlink_metadata(&path).is_ok_and(|there| !there.is_file()) {
            return Err(fault(&path, std::io::Error::other("it is not a regular file")));
        }
    }
    let temporary = |name: &str| dir.join(format!(".{name}.{}.part", std::process::id()));
    let write = || -> Result<(), Fault> {
        for (name, bytes) in files {
            let path = temporary(name);
            fs::write(&path, bytes).map_err(|source| fault(&path, source))?;
        }
        for (name, _) in files {
            let path = dir.join(name);
            fs::rename(temporary(name), &path).map_err(|source| fault(&path, source))?;
        }
        Ok(())
    };
    write().inspect_err(|_| {
        for (name, _) in files {
            // Best effort: the error that matters is the one that led here.
            fs::remove_file(temporary(name)).ok();
        }
    })?;
    for name in stale.iter().filter(|name| !files.iter().any(|(written, _)| written == *name)) {
        let path = dir.join(name);
        if path.exists() {
            fs::remove_file(&path).map_err(|source| fault(&path, source))?;
        }
    }
    Ok(())
}

/// Makes `dir` and tries to write there, before a run spends time.
///
/// Errors: [`Fault::Write`] with the path.
pub fn prepare(dir: &Path) -> Result<(), Fault> {
    let fault = |source| Fault::Write { path: dir.to_path_buf(), source };
    fs::create_dir_all(dir).map_err(fault)?;
    let probe = dir.join(format!(".writable.{}.part", std::process::id()));
    fs::write(&probe, []).map_err(fault)?;
    fs::remove_file(&probe).map_err(fault)
}
