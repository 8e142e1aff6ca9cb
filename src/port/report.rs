//! Writes what a comparison found, for a reader.

use super::cause;
use super::check::{Divergence, Report};

impl Report {
    /// Writes the report for a reader; `reference` and `theirs` are the files.
    pub fn text(&self) -> String {
        let mut text = match &self.divergence {
            None => {
                let all = self.compared + self.missing.values().sum::<usize>();
                format!("{} of {all} numbers agree\n", self.compared)
            }
            Some(Divergence { reference: r, theirs, line, ulps, cause }) => {
                let (equation, link) = cause::source(r);
                let node = r.node.map_or(String::new(), |node| format!(", node {node}"));
                let line = line.map_or(String::new(), |line| format!(" in line {line}"));
                let size = r.value.abs().max(theirs.abs());
                let relative = (theirs / size - r.value / size).abs();
                let apart = match r.value * theirs > 0.0 {
                    true => format!("{ulps} numbers apart"),
                    false => "not of one sign".to_string(),
                };
                let cause = cause.as_ref().map_or(String::new(), |c| format!("  likely: {c}\n"));
                format!(
                    "first difference: k = {}, step {}, {} of {equation}, index {}{node}, \
                     component {}\n  reference {:?}\n  theirs    {:?}{line}\n  relative \
                     {relative:.1e}, {apart}\n{cause}  book: {link}\n",
                    r.k, r.step, r.symbol, r.index, r.component, r.value, theirs
                )
            }
        };
        text += &self.others();
        let before = |k: &&usize| self.divergence.as_ref().is_some_and(|d| **k < d.reference.k);
        if let Some(k) = self.missing_steps.iter().find(before) {
            text += &format!("it may come from before: nothing of k = {k} was compared\n");
        }
        if !self.missing.is_empty() {
            let list: Vec<String> =
                self.missing.iter().map(|(symbol, n)| format!("{symbol} ({n})")).collect();
            text += &format!("not compared, since they are not there: {}\n", list.join(", "));
        }
        if self.extra > 0 {
            text += &format!("not compared, since the reference has none: {}\n", self.extra);
        }
        text
    }

    /// Lists the first differences of the other symbols, if they were asked for.
    fn others(&self) -> String {
        let mut text = String::new();
        if self.each.len() > 1 {
            text += "the first difference of every symbol, in this order:\n";
        }
        for Divergence { reference: r, theirs, cause, .. } in self.each.iter().skip(1) {
            let node = r.node.map_or(String::new(), |node| format!(", node {node}"));
            let cause = cause.as_ref().map_or(String::new(), |c| format!("; likely: {c}"));
            text += &format!(
                "  k = {}, step {}, {}, index {}{node}, component {}: {:?}, theirs {:?}{cause}\n",
                r.k, r.step, r.symbol, r.index, r.component, r.value, theirs
            );
        }
        text
    }
}
