//! The references of 60 digits in `data/reference/`, row by row.

use csv::StringRecord;
use lme_mpm::method::exact::riemann::End;

/// A row of a reference file, whose cells are asked for by the names of their columns.
pub struct Row {
    header: StringRecord,
    cells: StringRecord,
}

impl Row {
    pub fn text(&self, column: &str) -> &str {
        let at = self.header.iter().position(|name| name == column);
        &self.cells[at.unwrap_or_else(|| panic!("no column `{column}`"))]
    }

    pub fn number(&self, column: &str) -> f64 {
        self.text(column).parse().unwrap()
    }

    /// What stands at the left and the right end of a bar.
    pub fn ends(&self) -> [End; 2] {
        ["left", "right"].map(|side| match self.text(side) {
            "fixed" => End::Fixed,
            "free" => End::Free,
            other => panic!("no end `{other}`"),
        })
    }
}

pub fn rows(text: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    reader.records().map(|cells| Row { header: header.clone(), cells: cells.unwrap() }).collect()
}
