//! Orders of convergence while particles cross cells, in one to three dimensions.

use crate::support::*;
use lme_mpm::study::configuration::Template;
use lme_mpm::study::orders::{self, Ladder, Row};
use std::fmt::Write;
use std::path::Path;

/// The motion across cells on at most 80 cells, which is five to each side there.
fn crossing() -> Template {
    let text = MANUFACTURED.replace("cells = 160", "cells = 80");
    Template::parse(Path::new("manufactured.toml"), &text).unwrap()
}

/// Climbs the ladders of the study that `wanted` picks by name.
fn climbed(template: &Template, wanted: impl Fn(&str) -> bool) -> Vec<Row> {
    let ladders: Vec<Ladder> =
        orders::ladders().into_iter().filter(|ladder| wanted(&ladder.name())).collect();
    orders::study(template, &ladders, 2, &mut || {})
}

/// A line of the table: the errors of v on every grid, and the orders.
fn line(row: &Row) -> String {
    let name = row.ladder.name().replace("basis.", "").replace("kind=", "").replace("mass=", "");
    match &row.climbed {
        Err(problem) => format!("{name}: {problem}"),
        Ok(found) => {
            let errors = found.errors.iter().map(|e| format!("{:.1e}", e[0])).collect::<Vec<_>>();
            let orders =
                found.orders().map(|order| format!("{:.2} ± {:.2}", order.slope, order.half_width));
            format!("{name}: {} | {}", errors.join(" "), orders.join(", "))
        }
    }
}

#[test]
fn orders_of_crossing() {
    let rows = climbed(&crossing(), |name| {
        name.ends_with("spans=1 volumes=own along=h")
            && (name.contains("_cell=2") || name.contains("_cell=8"))
            || name.contains("volumes=exact")
    });
    for row in &rows {
        println!("{}", line(row));
    }
}
#[test]
fn orders_of_axis() {
    let text = AXIS_ALIGNED
        .replace("[8, 8, 8]", "[16, 16]")
        .replace("[2, 2, 2]", "[2, 2]")
        .replace("[1, 1, 1]", "[1, 1]")
        .replace("[0, 2.0943951023931953, 4.1887902047863905]", "[0, 2.0943951023931953]")
        .replace("back = { z = \"fixed\" }\n", "")
        .replace("front = { z = \"fixed\" }\n", "");
    let t = Template::parse(Path::new("axis-aligned.toml"), &text).unwrap();
    let rows = climbed(&t, |name| {
        name.ends_with("spans=1 volumes=own along=h")
            && (name.contains("_cell=2") || name.contains("_cell=3"))
    });
    for row in &rows {
        println!("{}", line(row));
    }
}
