//! Pictures of the book that only tests draw.

use kuva::prelude::*;
use lme_mpm::method::basis::lme::Failure;
use lme_mpm::method::basis::scattered::values_at;
use lme_mpm::method::exact::riemann::{Bar, Family};
use lme_mpm::output::figure::{Axes, COLOURS, Curve, CurvePoints, curves, draw, own_ids};
use nalgebra::Vector2;

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
    draw(vec![Curve { points, colour: COLOURS[0], width: 2.0, legend: String::new() }], &axes)
}

/// Draws the x-t diagram of a bar: every front from its source, from end to end, for
/// `transits` L/c, coloured by the invariant that carries it.
pub fn fronts(bar: &Bar, transits: f64) -> String {
    let mut curves: Vec<Curve> = Vec::new();
    for source in bar.fronts(0.0) {
        for family in [Family::I, Family::II] {
            let (mut x, mut t, mut family) = (source / bar.length, 0.0, family);
            while t < transits {
                let (end, other, colour) = match family {
                    Family::I => (1.0, Family::II, COLOURS[0]),
                    Family::II => (0.0, Family::I, COLOURS[1]),
                };
                let step = f64::min((end - x).abs(), transits - t);
                let to = x + step * (end - x).signum();
                let first = !curves.iter().any(|curve| curve.colour == colour);
                let legend = match family {
                    _ if !first => String::new(),
                    Family::I => "jump of R^I, to the right".to_string(),
                    Family::II => "jump of R^II, to the left".to_string(),
                };
                let points = vec![(x, t), (to, t + step)];
                curves.push(Curve { points, colour, width: 2.0, legend });
                (x, t, family) = (to, t + step, other);
            }
        }
    }
    let axes = Axes::new("Fronts of the bar", "place x/L [–]", "time ct/L [–]", false);
    draw(curves, &axes)
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

/// Draws the speed of waves against their θ/π: solid lumped, dashed consistent, measured points;
/// large words, for a narrow page.
pub fn dispersion(bases: &[Dispersion]) -> String {
    let mut plots: Vec<Plot> = Vec::new();
    for (n, basis) in bases.iter().enumerate() {
        let line = |points: &CurvePoints| {
            let line = LinePlot::new().with_data(points.clone()).with_color(COLOURS[n]);
            // The first curve lies under one that is the same.
            line.with_stroke_width(if n == 0 { 6.0 } else { 2.0 })
        };
        plots.push(Plot::from(line(&basis.lumped).with_legend(&basis.name)));
        plots.push(Plot::from(line(&basis.consistent).with_dashed()));
        let points = ScatterPlot::new().with_data::<f64, f64, CurvePoints>(basis.measured.clone());
        plots.push(points.with_size(3.0).with_color(COLOURS[n]).into());
    }
    let layout = Layout::auto_from_plots(&plots)
        .with_x_axis_min(0.0)
        .with_x_axis_max(1.0)
        .with_x_label("θ/π (1: a wave of two cells)")
        .with_y_label("speed of the wave / c")
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

/// Each map of [`local_max_ent`] has as many points to a side, and this half of a width in
/// cells.
const PIXELS: usize = 25;
const HALF_WIDTH: f64 = 2.5;

/// Draws the paper's Fig. 3: local max-ent in 2D for several γ. Above N of the middle
/// node, below ∂N/∂x, over a square of nodes with the spacing 1.
///
/// Errors: [`Failure`], if a point cannot be served.
pub fn local_max_ent(gammas: &[f64]) -> Result<String, Failure> {
    let (mut plots, mut layouts) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
    for gamma in gammas {
        let maps = [("N", ColorMap::Viridis), ("h ∂N/∂x", ColorMap::Inferno)];
        for (n, (values, (name, map))) in middle_function(*gamma)?.into_iter().zip(maps).enumerate()
        {
            let heatmap = Heatmap::new()
                .with_data(values)
                .with_color_map(map)
                .with_cell_size(1.0)
                .with_x_range(-HALF_WIDTH, HALF_WIDTH)
                .with_y_range(-HALF_WIDTH, HALF_WIDTH);
            let plot = Plot::from(heatmap);
            let layout = Layout::auto_from_plots(std::slice::from_ref(&plot))
                .with_x_axis_min(-HALF_WIDTH)
                .with_x_axis_max(HALF_WIDTH)
                .with_y_axis_min(-HALF_WIDTH)
                .with_y_axis_max(HALF_WIDTH)
                .with_title(format!("{name}, γ = {gamma}"))
                .with_title_size(14);
            plots[n].push(vec![plot]);
            layouts[n].push(layout);
        }
    }
    let figure = kuva::render::figure::Figure::new(2, gammas.len())
        .with_plots(plots.into_iter().flatten().collect())
        .with_layouts(layouts.into_iter().flatten().collect())
        .with_cell_size(300.0, 260.0);
    Ok(own_ids(&kuva::backend::svg::SvgBackend.render_scene(&figure.render())))
}

/// Gives N and ∂N/∂x of the middle one of 7 × 7 nodes, row by row from the top.
fn middle_function(gamma: f64) -> Result<[Vec<Vec<f64>>; 2], Failure> {
    const NODES: i32 = 3; // to each side of the middle
    let mut nodes = Vec::new();
    for j in -NODES..=NODES {
        for i in -NODES..=NODES {
            nodes.push(Vector2::new(f64::from(i), f64::from(j)));
        }
    }
    let middle = nodes.len() / 2;
    let at = |n: usize| HALF_WIDTH * (2.0 * n as f64 / (PIXELS - 1) as f64 - 1.0);
    let mut values = [vec![vec![0.0; PIXELS]; PIXELS], vec![vec![0.0; PIXELS]; PIXELS]];
    for row in 0..PIXELS {
        for column in 0..PIXELS {
            let x = Vector2::new(at(column), -at(row));
            let (found, _) = values_at(&nodes, 1.0, gamma, 1e-6, &x)?;
            if let Some((_, N, grad_N)) = found.into_iter().find(|value| value.0 == middle) {
                values[0][row][column] = N;
                values[1][row][column] = grad_N[0];
            }
        }
    }
    Ok(values)
}
