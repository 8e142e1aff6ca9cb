//! Pictures are drawn as SVG: histories of probes, named curves, work and precision, particles.

use super::summary::peak;
use crate::run::table::Table;
use crate::scene::keys::AXES;
use crate::scene::{Probe, Scene};
use kuva::prelude::*;
use kuva::render::render::Primitive;
use std::sync::Arc;

/// A picture has this width and height (px): its words are legible in a column of 500 px too.
const SIZE: (f64, f64) = (626.0, 420.0);

/// The exact curve stands behind in grey; the colours are safe for the colour-blind (Okabe &
/// Ito 2008).
const EXACT: &str = "#999999";
pub const COLOURS: [&str; 10] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#882255",
    "#999933", "#44aa99",
];

/// Lines differ by their dashes as well as by their colours (px on, px off).
pub const DASHES: [&str; 7] = ["", "9 4", "2 3", "10 3 2 3", "18 4", "5 2", "18 3 3 3 3 3"];

/// Clouds of points differ by their markers.
const MARKERS: [MarkerShape; 6] = [
    MarkerShape::Circle,
    MarkerShape::Square,
    MarkerShape::Triangle,
    MarkerShape::Diamond,
    MarkerShape::TriangleDown,
    MarkerShape::Plus,
];

/// A curve of so few points shows each of them.
const FEW_POINTS: usize = 20;

/// A curve has these points, from one end to the other.
pub type CurvePoints = Vec<(f64, f64)>;

/// A curve is one line of a picture.
pub struct Curve {
    pub points: CurvePoints,
    pub colour: &'static str,
    pub width: f64,
    /// One of [`DASHES`]; empty: a solid line.
    pub dash: &'static str,
    /// Whether a dot stands at each point.
    pub dots: bool,
    /// Empty: not in the legend.
    pub legend: String,
}

/// The axes and the title stand around the curves.
pub struct Axes {
    title: String,
    x_label: String,
    y_label: String,
    log: bool,
}

impl Axes {
    /// Makes axes; `log` for logarithmic ones.
    pub fn new(
        title: impl Into<String>,
        x_label: impl Into<String>,
        y_label: impl Into<String>,
        log: bool,
    ) -> Self {
        Axes { title: title.into(), x_label: x_label.into(), y_label: y_label.into(), log }
    }
}

/// Gives the layout that all pictures share: a size (px), axes, ticks that read well.
fn layout(plots: &[Plot], size: (f64, f64), axes: &Axes) -> Layout {
    let layout = Layout::auto_from_plots(plots)
        .with_width(size.0)
        .with_height(size.1)
        .with_title(&axes.title)
        .with_title_size(18)
        .with_label_size(17)
        .with_tick_size(15)
        .with_body_size(15)
        .with_x_label(&axes.x_label)
        .with_y_label(&axes.y_label)
        .with_x_tick_format(TickFormat::Custom(Arc::new(tick)))
        .with_y_tick_format(TickFormat::Custom(Arc::new(tick)))
        .with_legend_position(LegendPosition::OutsideBottomColumns)
        .with_legend_col_limit(2)
        .with_legend_box(false);
    if axes.log { layout.with_log_scale() } else { layout }
}

/// Draws curves; the x axis of plain axes begins at 0 or below.
pub fn draw(curves: Vec<Curve>, axes: &Axes) -> String {
    let (plots, layout) = laid_out(curves, axes);
    rendered(plots, layout)
}

/// Renders a picture; the keys of lines in its legend are long enough to show their dashes, and
/// the sheet is wide and high enough for the last number of an axis and the last line of a legend.
fn rendered(plots: Vec<Plot>, layout: Layout) -> String {
    const KEY: f64 = 42.0;
    const EDGE: f64 = 14.0;
    let mut scene = render_multiple(plots, layout);
    for element in &mut scene.elements {
        if let Primitive::Line { x1, x2, y1, y2, stroke_width, .. } = element
            && y1 == y2
            && *x2 - *x1 < KEY
            && *stroke_width == 2.0
        {
            *x2 = *x1 + 12.0;
            *x1 = *x2 - KEY;
        }
        if let Primitive::Text { y, .. } = element {
            scene.height = scene.height.max(*y + EDGE);
        }
    }
    scene.width += EDGE;
    own_ids(&SvgBackend.render_scene(&scene))
}

fn laid_out(curves: Vec<Curve>, axes: &Axes) -> (Vec<Plot>, Layout) {
    let xs = || curves.iter().flat_map(|curve| &curve.points).map(|point| point.0);
    let (first, last) = (xs().fold(0.0, f64::min), xs().fold(0.0, f64::max));
    let plots: Vec<Plot> = curves.into_iter().flat_map(plots_of).collect();
    let layout = layout(&plots, SIZE, axes);
    match axes.log {
        true => (plots, layout),
        false => (plots, layout.with_x_axis_min(first).with_x_axis_max(last)),
    }
}

/// Makes the line of a curve, and its dots, if it has any.
fn plots_of(curve: Curve) -> Vec<Plot> {
    let line = LinePlot::new()
        .with_data(curve.points.clone())
        .with_color(curve.colour)
        .with_stroke_width(curve.width);
    let line = match curve.dash {
        "" => line,
        dash => line.with_line_style(LineStyle::Custom(dash.to_string())),
    };
    let legend = !curve.legend.is_empty();
    let line = if legend { line.with_legend(&curve.legend) } else { line };
    let mut plots = vec![Plot::from(line)];
    if curve.dots {
        let points = ScatterPlot::new().with_data::<f64, f64, CurvePoints>(curve.points);
        plots.push(points.with_size(4.0).with_color(curve.colour).into());
    }
    plots
}

/// Draws the history of one probe, computed and, where known, exact.
pub fn probe(scene: &Scene, probe: &Probe, history: &Table) -> String {
    let (curves, axes) = of_probe(scene, probe, history);
    draw(curves, &axes)
}

/// Draws the same with characters and colours, small, for a terminal of any background.
pub fn in_terminal(scene: &Scene, probe: &Probe, history: &Table) -> String {
    const ROWS: u32 = 18;
    let (mut curves, axes) = of_probe(scene, probe, history);
    let over = if curves.len() > 1 { ", computed (blue) over exact (grey)" } else { "" };
    curves.iter_mut().for_each(|curve| curve.legend.clear());
    let head = format!("{}{over}", axes.y_label);
    let (plots, layout) = laid_out(curves, &Axes { title: String::new(), ..axes });
    let grey = || "#888888".to_string();
    let theme =
        Theme { axis_color: grey(), tick_color: grey(), text_color: grey(), ..Theme::light() };
    let layout = layout.with_y_label("").with_theme(theme).with_show_grid(false);
    let picture = render_multiple(plots, layout.with_term_rows(ROWS));
    format!("{head}\n{}", TerminalBackend::new(78, ROWS as usize).render_scene(&picture))
}

fn of_probe(scene: &Scene, probe: &Probe, history: &Table) -> (Vec<Curve>, Axes) {
    let column = |name: &str| history.column(name).unwrap_or_default();
    let (t, computed) = (column("t"), column(&probe.name));
    let exact = column(&format!("{}_exact", probe.name));
    let (per_t, t_prefix) = prefix(peak(&t));
    let (per_y, y_prefix) = prefix(peak(&computed).max(peak(&exact)));
    let curve = |y: &[f64], colour, width, legend: &str| Curve {
        points: t.iter().zip(y).map(|(t, y)| (t * per_t, y * per_y)).collect(),
        colour,
        width,
        dash: "",
        dots: false,
        legend: legend.to_string(),
    };
    let mut curves = Vec::new();
    if !exact.is_empty() {
        curves.push(curve(&exact, EXACT, 5.0, "exact"));
    }
    curves.push(curve(&computed, COLOURS[0], 1.6, "computed"));

    let (name, unit) = probe.quantity.name_unit();
    let at: Vec<String> =
        probe.position.iter().zip(&scene.body.origin).map(|(x, o)| format!("{}", x + o)).collect();
    let cells: Vec<String> = scene.grid.cells.iter().map(usize::to_string).collect();
    let axes = Axes::new(
        format!("{}, {} cells", scene.title, cells.join(" × ")),
        format!("time t [{t_prefix}s]"),
        format!("{name} nearest to {} m [{y_prefix}{unit}]", at.join(", ")),
        false,
    );
    (curves, axes)
}

/// Draws curves with names, each in a colour of its own and with dashes of its own.
pub fn curves(lists: &[(impl AsRef<str>, CurvePoints)], axes: &Axes) -> String {
    let curves = lists.iter().enumerate().map(|(n, (name, points))| Curve {
        points: points.clone(),
        colour: COLOURS[n % COLOURS.len()],
        width: 2.0,
        dash: DASHES[n % DASHES.len()],
        dots: points.len() <= FEW_POINTS,
        legend: in_words(name.as_ref()),
    });
    draw(curves.collect(), axes)
}

/// Writes the keys of scenes and studies as the words that a legend has.
fn in_words(name: &str) -> String {
    const WORDS: [(&str, &str); 7] = [
        ("bspline", "B-splines"),
        ("ugimp", "uGIMP"),
        ("lme", "local max-ent"),
        ("mpm", "MPM"),
        ("otm", "OTM"),
        ("newmark", "Newmark"),
        ("euler", "Euler"),
    ];
    WORDS.iter().fold(name.to_string(), |name, (key, word)| name.replace(key, word))
}

/// An effort is a point of a work-precision diagram: what it took, its relative error, and
/// the group that gives its colour; no error for a run that failed.
pub struct Effort {
    pub work: f64,
    pub error: Option<f64>,
    pub group: String,
}

/// Draws error against work, both logarithmic: one colour and marker for each group, the Pareto front
/// as a line, failed runs as crosses above all others.
pub fn work_precision(
    title: &str,
    x_label: &str,
    efforts: &[Effort],
    front: &CurvePoints,
) -> String {
    let mut plots: Vec<Plot> = Vec::new();
    if front.len() > 1 {
        let line = LinePlot::new().with_data(front.clone()).with_color("#000000");
        plots.push(Plot::from(line.with_stroke_width(1.5).with_legend("nobody is better")));
    }
    let scatter = |points: CurvePoints, colour, marker| {
        ScatterPlot::new()
            .with_data::<f64, f64, CurvePoints>(points)
            .with_size(4.5)
            .with_color(colour)
            .with_marker(marker)
    };
    for (n, (name, points)) in groups(efforts).into_iter().enumerate() {
        if !points.is_empty() {
            let (colour, marker) = (COLOURS[n % COLOURS.len()], MARKERS[n % MARKERS.len()]);
            plots.push(scatter(points, colour, marker).with_legend(in_words(name)).into());
        }
    }
    let worst = efforts.iter().filter_map(|effort| effort.error).fold(0.0, f64::max);
    let failed = efforts.iter().filter(|effort| effort.error.is_none());
    let failed: CurvePoints = failed.map(|effort| (effort.work, 2.0 * worst)).collect();
    if !failed.is_empty() && worst > 0.0 {
        let crosses = scatter(failed, "#d00000", MarkerShape::Cross);
        plots.push(crosses.with_legend("failed").into());
    }
    let axes = Axes::new(title, x_label, "relative error [–]", true);
    let layout = layout(&plots, SIZE, &axes);
    rendered(plots, layout)
}

/// Lists the groups in order of first appearance, each with the points of its runs that did
/// not fail.
fn groups(efforts: &[Effort]) -> Vec<(&str, CurvePoints)> {
    let mut groups: Vec<(&str, CurvePoints)> = Vec::new();
    for effort in efforts {
        let known = groups.iter().position(|(name, _)| *name == effort.group);
        let n = known.unwrap_or_else(|| {
            groups.push((&effort.group, Vec::new()));
            groups.len() - 1
        });
        groups[n].1.extend(effort.error.map(|error| (effort.work, error)));
    }
    groups
}

/// Draws the particles of a 2D scene, or of a 3D one seen along z, in six classes of
/// speed.
pub fn particles(scene: &Scene, table: &Table, t: f64) -> String {
    let column = |name: &str| table.column(name).unwrap_or_default();
    let (x, y) = (column("position_x"), column("position_y"));
    let places: CurvePoints = x.iter().copied().zip(y.iter().copied()).collect();
    let plots = by_speed(&places, &speeds(table));
    // The picture shows the body's box, and whatever has left it.
    let range = |d: usize, list: &[f64]| {
        let (low, high) = (scene.body.origin[d], scene.body.origin[d] + scene.body.length[d]);
        (list.iter().fold(low, |a, b| a.min(*b)), list.iter().fold(high, |a, b| a.max(*b)))
    };
    let (x_range, y_range) = (range(0, &x), range(1, &y));
    let axes = Axes::new(
        format!("{}: speed of the particles at t = {} s", scene.title, tick(t)),
        "x [m]",
        "y [m]",
        false,
    );
    let layout = layout(&plots, (640.0, 640.0), &axes)
        .with_title_size(16)
        .with_equal_aspect()
        .with_x_axis_min(x_range.0)
        .with_x_axis_max(x_range.1)
        .with_y_axis_min(y_range.0)
        .with_y_axis_max(y_range.1);
    rendered(plots, layout)
}

/// Gives |v| of every particle in a table (m/s).
fn speeds(table: &Table) -> Vec<f64> {
    let axes = AXES.map(|axis| table.column(&format!("velocity_{axis}")));
    let square = |p: usize| axes.iter().flatten().map(|v| v[p] * v[p]).sum();
    (0..table.rows().len()).map(|p| libm::sqrt(square(p))).collect()
}

/// Sorts points into classes of their speed (m/s), the fastest first.
fn by_speed(places: &CurvePoints, speed: &[f64]) -> Vec<Plot> {
    const CLASSES: usize = 6;
    let top = peak(speed);
    let (per_v, v_prefix) = prefix(top);
    let class = |v: f64| {
        if top > 0.0 { ((v / top * CLASSES as f64) as usize).min(CLASSES - 1) } else { 0 }
    };
    let bound = |n: usize| format!("{:.3}", n as f64 / CLASSES as f64 * top * per_v);
    let plot = |n: usize| {
        let own = places.iter().zip(speed).filter(|(_, v)| class(**v) == n);
        ScatterPlot::new()
            .with_data(own.map(|(place, _)| *place))
            .with_size(2.2)
            .with_color(ColorMap::Viridis.map((n as f64 + 0.5) / CLASSES as f64))
            .with_legend(format!("{} to {} {v_prefix}m/s", bound(n), bound(n + 1)))
            .into()
    };
    (0..CLASSES).rev().map(plot).collect()
}

/// Numbers the clip paths of a picture from 1. The library numbers them through
/// all pictures of a process, so that the same picture would differ.
pub fn own_ids(svg: &str) -> String {
    const ID: &str = "kuva-clip-";
    let mut known: Vec<&str> = Vec::new();
    let mut pieces = svg.split(ID);
    let mut out = pieces.next().unwrap_or("").to_string();
    for piece in pieces {
        let end = piece.find(|c: char| !c.is_ascii_digit()).unwrap_or(piece.len());
        let (number, rest) = piece.split_at(end);
        let at = known.iter().position(|old| *old == number).unwrap_or_else(|| {
            known.push(number);
            known.len() - 1
        });
        out.push_str(&format!("clip-{}{rest}", at + 1));
    }
    out
}

/// Finds the SI prefix that brings `largest` between 1 and 1000, and its factor.
fn prefix(largest: f64) -> (f64, &'static str) {
    const PREFIXES: [(f64, &str); 10] = [
        (1e-12, "T"),
        (1e-9, "G"),
        (1e-6, "M"),
        (1e-3, "k"),
        (1.0, ""),
        (1e3, "m"),
        (1e6, "µ"),
        (1e9, "n"),
        (1e12, "p"),
        (1e15, "f"),
    ];
    let fits = |(factor, _): &&(f64, &str)| largest * factor >= 1.0;
    PREFIXES.iter().find(fits).copied().unwrap_or((1.0, ""))
}

/// Writes a tick label: up to six decimals, no trailing zeros; a power of ten where
/// that would show nothing.
fn tick(x: f64) -> String {
    let size = libm::fabs(x);
    if x != 0.0 && !(1e-4..1e6).contains(&size) {
        return format!("{x:.1e}").replace(".0e", "e");
    }
    let rounded = format!("{x:.6}");
    let short = rounded.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".to_string() } else { short.to_string() }
}
