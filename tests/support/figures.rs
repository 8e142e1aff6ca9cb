//! Pictures of the book that only tests draw.

use kuva::prelude::*;
use lme_mpm::output::figure::{Axes, COLOURS, Curve, CurvePoints, curves, draw, own_ids};

/// Draws a quantity of the exact bar at the material point x over `transits` L/c:
/// the paper's Figs. 5 and 6. `value` gives the quantity at (x, t).
pub fn exact_history(
    title: &str,
    y_label: &str,
    transits: f64,
    value: impl Fn(f64) -> f64,
) -> String {
    // Jumps fall on multiples of L/4c; each plateau is drawn from its middle.
    let pieces = (transits * 4.0) as usize;
    let mut points = Vec::new();
    for k in 0..pieces {
        let y = value((k as f64 + 0.5) / 4.0);
        points.push((k as f64 / 4.0, y));
        points.push(((k + 1) as f64 / 4.0, y));
    }
    let axes = Axes::new(title, "time ct/L [–]", y_label, false);
    draw(
        vec![Curve {
            points,
            colour: COLOURS[0],
            width: 2.0,
            dash: "",
            dots: false,
            legend: String::new(),
        }],
        &axes,
    )
}

/// Draws errors against the number of cells, both on logarithmic axes; each list of
/// `(cells, error)` has its name.
pub fn convergence(title: &str, lists: &[(&str, CurvePoints)]) -> String {
    curves(lists, &Axes::new(title, "cells [–]", "relative error [–]", true))
}

/// One basis in [`dispersion`]: its name, its curves with the lumped and the consistent mass
/// matrix, and what was measured with either.
pub struct Dispersion {
    pub name: String,
    pub lumped: CurvePoints,
    pub consistent: CurvePoints,
    pub measured: CurvePoints,
}

/// Each basis has its marker.
const MARKERS: [MarkerShape; 7] = [
    MarkerShape::Circle,
    MarkerShape::Plus,
    MarkerShape::Triangle,
    MarkerShape::Diamond,
    MarkerShape::TriangleDown,
    MarkerShape::Square,
    MarkerShape::Cross,
];

/// Draws the speed of waves against their θ/π: solid lumped, dashed consistent, measured points
/// with a marker for each basis; large words, for a narrow page.
pub fn dispersion(bases: &[Dispersion]) -> String {
    let mut plots: Vec<Plot> = Vec::new();
    for (n, basis) in bases.iter().enumerate() {
        let line = |points: &CurvePoints| {
            let line = LinePlot::new().with_data(points.clone()).with_color(COLOURS[n]);
            // The first curve lies under one that is the same.
            line.with_stroke_width(if n == 0 { 6.0 } else { 2.0 })
        };
        plots.push(Plot::from(line(&basis.lumped)));
        plots.push(Plot::from(line(&basis.consistent).with_dashed()));
        let points = ScatterPlot::new().with_data::<f64, f64, CurvePoints>(basis.measured.clone());
        let points = points.with_size(5.0).with_color(COLOURS[n]).with_marker(MARKERS[n]);
        plots.push(points.with_legend(&basis.name).into());
    }
    let layout = Layout::auto_from_plots(&plots)
        .with_x_axis_min(0.0)
        .with_x_axis_max(1.0)
        .with_x_label("θ/π [–] (1: a wave of two cells)")
        .with_y_label("speed of the wave / c [–]")
        .with_label_size(17)
        .with_tick_size(15)
        .with_body_size(16)
        .with_width(640.0)
        .with_height(640.0)
        .with_y_axis_max(2.25)
        .with_legend_width(210.0)
        .with_legend_position(LegendPosition::InsideTopLeft);
    own_ids(&render_to_svg(plots, layout))
}
