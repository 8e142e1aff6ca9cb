//! The rows of a study run one by one, on as many machines as there are: each is a command that
//! prints its line, and the lines are merged.

use crate::run::table::not_finite;
use crate::scene::fault::Fault;
use std::fs;
use std::path::{Path, PathBuf};

/// Finds a row by its name among those of a study.
///
/// Errors: [`Fault::Argument`].
pub fn find(names: &[String], name: &str) -> Result<usize, Fault> {
    names.iter().position(|one| one == name).ok_or_else(|| Fault::Argument {
        argument: "--row",
        problem: format!("the study has no row `{name}`"),
        allowed: "a row as --list prints it",
    })
}

/// Puts the scene's digest before every line of a table, by which one study is told from
/// another.
pub fn with_scene(scene: &str, table: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(table);
    let line = |(n, line)| format!("{},{line}\n", if n == 0 { "scene" } else { scene });
    text.lines().enumerate().map(line).collect::<String>().into_bytes()
}

/// A study whose rows are merged knows its scene's digest, the columns of its table, and all
/// its rows by name.
pub struct Study<'a> {
    pub scene: String,
    pub columns: &'a [&'a str],
    pub names: &'a [String],
}

impl Study<'_> {
    /// Reads the rows that were printed into `files`, in the order of the study. `read` makes
    /// a row and its name from the cells of a line.
    ///
    /// Errors: [`Fault::Read`]; [`Fault::Points`] with the line that is no whole row of this
    /// study, or a second one; [`Fault::Argument`] for rows that are missing.
    pub fn merged<T: Clone>(
        &self,
        files: &[PathBuf],
        read: impl Fn(&[&str]) -> Option<(String, T)>,
    ) -> Result<Vec<T>, Fault> {
        let mut rows: Vec<Option<T>> = vec![None; self.names.len()];
        for path in files {
            for (line, cells) in self.lines(path)? {
                let cells: Vec<&str> = cells.iter().skip(1).map(String::as_str).collect();
                let row = read(&cells).and_then(|(name, row)| {
                    Some((self.names.iter().position(|one| *one == name)?, row))
                });
                let Some((at, row)) = row else {
                    return Err(fault(path, line, "this is not a whole row of this study"));
                };
                if rows[at].replace(row).is_some() {
                    return Err(fault(path, line, "this row stands here a second time"));
                }
            }
        }
        let missing = rows.iter().filter(|row| row.is_none()).count();
        match rows.iter().position(Option::is_none) {
            None => Ok(rows.into_iter().flatten().collect()),
            Some(first) => Err(Fault::Argument {
                argument: "--merge",
                problem: format!(
                    "{missing} of {} rows are missing, the first is `{}`",
                    self.names.len(),
                    self.names[first]
                ),
                allowed: "what every row of --list has printed",
            }),
        }
    }

    /// Reads the lines of a file with their numbers; of a line that is not whole no cells.
    fn lines(&self, path: &Path) -> Result<Vec<(u64, Vec<String>)>, Fault> {
        let unread = |source| Fault::Read { path: path.to_path_buf(), source };
        let text = fs::read_to_string(path).map_err(unread)?;
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .has_headers(false)
            .from_reader(text.as_bytes());
        let mut lines = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| unread(error.into()))?;
            let line = record.position().map_or(0, |position| position.line());
            if line == 1 {
                if record.iter().ne(["scene"].iter().chain(self.columns).copied()) {
                    return Err(fault(path, 1, "these are other columns"));
                }
                continue;
            }
            let columns: Vec<&str> = ["scene"].iter().chain(self.columns).copied().collect();
            if let Some((column, value)) = not_finite(&columns, record.iter()) {
                return Err(fault(path, line, &no_number(&column, &value)));
            }
            let (whole, _) = is_whole(&record, &text, columns.len());
            if whole && record[0] != self.scene {
                return Err(fault(path, line, "this row belongs to another scene"));
            }
            let cells = if whole { record.iter().map(String::from).collect() } else { Vec::new() };
            lines.push((line, cells));
        }
        match lines.is_empty() {
            true => Err(fault(path, 1, "there is no row")),
            false => Ok(lines),
        }
    }
}

/// Says whether a record of `text` has all columns and the end of its line, and whether it has that
/// end: a last line without it may lack the last digits of its last number.
pub fn is_whole(record: &csv::StringRecord, text: &str, columns: usize) -> (bool, bool) {
    let from = record.position().map_or(0, |position| position.byte()) as usize;
    let has_end = text[from..].contains('\n');
    (record.len() == columns && has_end, has_end)
}

/// Says that a value that was read is no finite number.
pub fn no_number(column: &str, value: &str) -> String {
    format!("`{value}` of {column} is no finite number")
}

/// Reads a finite number of which a negative one makes no sense: an error, a count, a time.
pub fn size(cell: &str) -> Option<f64> {
    cell.parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0)
}

fn fault(path: &Path, line: u64, problem: &str) -> Fault {
    Fault::Points {
        path: path.display().to_string(),
        line,
        problem: problem.to_string(),
        allowed: "rows as --row prints them, each once".to_string(),
    }
}
