//! A table holds numbers, and can be written as CSV.

use crate::scene::fault::Fault;

/// A table holds numbers row after row, with a name for each column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    pub columns: Vec<String>,
    values: Vec<f64>,
    /// The first row, which names the columns, is still being written.
    naming: bool,
}

impl Table {
    /// Makes an empty table; its first row will name the columns.
    pub fn new() -> Self {
        Table { naming: true, ..Table::default() }
    }

    /// Adds a number to the row that is being written, with the name of its column.
    pub fn put(&mut self, name: impl FnOnce() -> String, value: f64) {
        if self.naming {
            self.columns.push(name());
        }
        self.values.push(value);
    }

    /// Ends the row that is being written.
    pub fn end_row(&mut self) {
        self.naming = false;
    }

    /// Forgets the rows and keeps the columns.
    pub fn clear(&mut self) {
        self.values.clear();
    }

    /// Lists all complete rows.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[f64]> + ExactSizeIterator {
        self.values.chunks_exact(self.columns.len().max(1))
    }

    /// Gives the column called `name`.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let at = self.columns.iter().position(|column| column == name)?;
        Some(self.rows().map(|row| row[at]).collect())
    }

    /// Writes the table as CSV with a header line.
    pub fn csv(&self) -> Result<Vec<u8>, Fault> {
        let rows = self.rows().map(|row| row.iter().map(|x| shortest(*x)).collect());
        csv(&self.columns, rows)
    }
}

/// Writes lines of text as CSV with a header line.
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

/// Gives the shortest decimal that reads back as the same number; whole numbers
/// below 1e15 without a point, −0 as 0.
pub fn shortest(x: f64) -> String {
    let x = x + 0.0;
    if x == libm::trunc(x) && libm::fabs(x) < 1e15 { format!("{x}") } else { format!("{x:?}") }
}
