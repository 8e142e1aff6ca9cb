//! Pictures of a run as SVG.

use crate::history::Table;
use crate::scene::{Probe, Scene};
use kuva::prelude::*;

/// Width and height of a picture [px].
const SIZE: (f64, f64) = (860.0, 420.0);

/// Colour-blind safe (Okabe & Ito 2008): the exact curve stands behind.
const EXACT: &str = "#999999";
const COMPUTED: &str = "#0072b2";

// ANCHOR: figure
/// The history of one probe, computed and, where known, exact.
pub fn probe(scene: &Scene, probe: &Probe, history: &Table) -> String {
    let column = |name: &str| history.column(name).unwrap_or_default();
    let (t, computed) = (column("t"), column(&probe.name));
    let exact = column(&format!("{}_exact", probe.name));

    let (per_t, t_prefix) = prefix(largest(&t));
    let (per_y, y_prefix) = prefix(largest(&computed).max(largest(&exact)));
    let line = |y: &[f64], color: &str, width: f64, legend: &str| {
        let points = t.iter().zip(y).map(|(t, y)| (t * per_t, y * per_y));
        Plot::from(
            LinePlot::new()
                .with_data(points.collect::<Vec<_>>())
                .with_color(color)
                .with_stroke_width(width)
                .with_legend(legend),
        )
    };
    let mut plots = Vec::new();
    if !exact.is_empty() {
        plots.push(line(&exact, EXACT, 4.0, "exact"));
    }
    plots.push(line(&computed, COMPUTED, 1.4, "computed"));

    let (name, unit) = probe.quantity.name_unit();
    let at: Vec<String> =
        probe.position.iter().zip(&scene.body.origin).map(|(x, o)| format!("{}", x + o)).collect();
    let cells: Vec<String> = scene.grid.cells.iter().map(usize::to_string).collect();
    let layout = Layout::auto_from_plots(&plots)
        .with_width(SIZE.0)
        .with_height(SIZE.1)
        .with_title(format!("{}: {}, {} cells", scene.title, probe.name, cells.join(" × ")))
        .with_x_label(format!("time t [{t_prefix}s]"))
        .with_y_label(format!("{name} at x = {} m [{y_prefix}{unit}]", at.join(", ")))
        .with_x_tick_format(TickFormat::Custom(std::sync::Arc::new(tick)))
        .with_y_tick_format(TickFormat::Custom(std::sync::Arc::new(tick)))
        .with_x_axis_max(largest(&t) * per_t)
        .with_title_size(16)
        .with_label_size(14)
        .with_tick_size(12)
        .with_legend_position(LegendPosition::OutsideRightTop);
    render_to_svg(plots, layout)
}
// ANCHOR_END: figure

fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()))
}

/// The SI prefix that brings `largest` between 1 and 1000, and its factor.
fn prefix(largest: f64) -> (f64, &'static str) {
    const PREFIXES: [(f64, &str); 8] = [
        (1e-12, "T"),
        (1e-9, "G"),
        (1e-6, "M"),
        (1e-3, "k"),
        (1.0, ""),
        (1e3, "m"),
        (1e6, "µ"),
        (1e9, "n"),
    ];
    let fits = |(factor, _): &&(f64, &str)| largest * factor >= 1.0;
    PREFIXES.iter().find(fits).copied().unwrap_or((1.0, ""))
}

/// A tick label: up to six digits, no trailing zeros.
fn tick(x: f64) -> String {
    let rounded = format!("{x:.6}");
    let short = rounded.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_string() } else { short.to_string() }
}
