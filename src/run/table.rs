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

    /// Refuses a number that is not finite.
    ///
    /// Errors: [`Fault::NotFinite`] with column and row.
    pub fn finite(&self) -> Result<(), Fault> {
        let all = self.rows().flat_map(|row| self.columns.iter().zip(row).map(move |x| (x, row)));
        match { all }.find(|((_, x), _)| !x.is_finite()) {
            None => Ok(()),
            Some(((column, x), row)) => {
                let quantity = format!("{column} where {} is {}", self.columns[0], row[0]);
                Err(Fault::NotFinite { quantity, value: shortest(*x) })
            }
        }
    }

    /// Writes the table as CSV with a header line.
    ///
    /// Errors: those of [`csv()`].
    pub fn csv(&self) -> Result<Vec<u8>, Fault> {
        let rows = self.rows().map(|row| row.iter().map(|x| shortest(*x)).collect());
        csv(&self.columns, rows)
    }
}

// ANCHOR: gate
/// Writes lines of text as CSV with a header line. All tables of the program go through here,
/// and no number that is not finite gets past.
///
/// Errors: [`Fault::NotFinite`] with column and row.
pub fn csv(
    header: &[impl AsRef<str>],
    rows: impl Iterator<Item = Vec<String>>,
) -> Result<Vec<u8>, Fault> {
    let header: Vec<&str> = header.iter().map(AsRef::as_ref).collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let fault = |error: std::io::Error| Fault::Write { path: "CSV".into(), source: error };
    writer.write_record(&header).map_err(|error| fault(error.into()))?;
    for row in rows {
        if let Some((column, value)) = not_finite(&header, row.iter().map(String::as_str)) {
            let quantity = format!("{column} where {} is {}", header[0], row[0]);
            return Err(Fault::NotFinite { quantity, value });
        }
        writer.write_record(row).map_err(|error| fault(error.into()))?;
    }
    writer.into_inner().map_err(|error| fault(error.into_error()))
}

/// Finds in the cells of a row a number, or one of a list with spaces between them, that is not
/// finite, with its column: NaN, inf, 1e999. The column `problem` holds words.
pub fn not_finite<'a>(
    header: &[&'a str],
    row: impl Iterator<Item = &'a str>,
) -> Option<(String, String)> {
    let is_bad = |word: &&str| word.parse::<f64>().is_ok_and(|x| !x.is_finite());
    let cells = header.iter().zip(row).filter(|(column, _)| **column != "problem");
    let mut bad = cells.filter_map(|(column, cell)| Some((column, cell.split(' ').find(is_bad)?)));
    bad.next().map(|(column, word)| (column.to_string(), word.to_string()))
}
// ANCHOR_END: gate

/// Gives the shortest decimal that reads back as the same number; whole numbers
/// below 1e15 without a point, −0 as 0.
pub fn shortest(x: f64) -> String {
    let x = x + 0.0;
    if x == libm::trunc(x) && libm::fabs(x) < 1e15 { format!("{x}") } else { format!("{x:?}") }
}
