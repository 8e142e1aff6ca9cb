//! Pictures of lines that differ by dash and marker as well as by colour, with words that can be
//! read on a narrow page.

use kuva::plot::legend::{LegendEntry, LegendShape};
use kuva::prelude::*;
use kuva::render::annotations::TextAnnotation;
use lme_mpm::output::figure::{COLOURS, CurvePoints, own_ids};
use std::sync::Arc;

/// How a line is drawn.
#[derive(Clone, Copy, PartialEq)]
pub enum Dash {
    Solid,
    Dashed,
    Dotted,
    /// Only its markers are drawn.
    Nothing,
}

/// One line: its name in the legend, which is empty for none, and its look.
pub struct Line {
    pub name: String,
    pub points: CurvePoints,
    /// A number in [`COLOURS`].
    pub colour: usize,
    pub dash: Dash,
    pub marker: Option<MarkerShape>,
}

impl Line {
    pub fn new(name: impl Into<String>, points: CurvePoints, colour: usize) -> Self {
        Line { name: name.into(), points, colour, dash: Dash::Solid, marker: None }
    }

    pub fn dashed(self, dash: Dash) -> Self {
        Line { dash, ..self }
    }

    pub fn marked(self, marker: MarkerShape) -> Self {
        Line { marker: Some(marker), ..self }
    }

    fn style(&self) -> Option<&'static str> {
        match self.dash {
            Dash::Dashed => Some("8 4"),
            Dash::Dotted => Some("2 4"),
            _ => None,
        }
    }

    fn legend(&self) -> LegendEntry {
        let shape = match self.marker {
            Some(marker) if self.dash != Dash::Dotted => LegendShape::Marker(marker),
            _ => LegendShape::Line,
        };
        LegendEntry {
            label: self.name.clone(),
            color: COLOURS[self.colour].to_string(),
            shape,
            dasharray: self.style().map(String::from),
        }
    }
}

/// What stands around the lines.
#[derive(Default)]
pub struct Frame<'a> {
    pub x: &'a str,
    pub y: &'a str,
    /// Both axes are logarithmic.
    pub log: bool,
    pub x_range: Option<(f64, f64)>,
    pub y_range: Option<(f64, f64)>,
    /// Words at places.
    pub notes: Vec<(f64, f64, String)>,
}

/// A triangle below a line of slope −`order` from (x, y) to twice x, with the order beside it.
pub fn slope_triangle(x: f64, y: f64, order: f64, words: &str) -> (Line, (f64, f64, String)) {
    let low = y * 2.0_f64.powf(-order);
    let corners = vec![(x, y), (2.0 * x, low), (x, low), (x, y)];
    (Line::new("", corners, 6), (0.9 * x, (y * low).sqrt(), words.to_string()))
}

/// Writes a tick: a number without zeros at its end.
fn tick(x: f64) -> String {
    let text = format!("{x:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

/// Draws lines in a frame, with the legend below.
pub fn lines(lines: &[Line], frame: &Frame) -> String {
    let mut plots: Vec<Plot> = Vec::new();
    for line in lines {
        let colour = COLOURS[line.colour];
        if line.dash != Dash::Nothing {
            let plot = LinePlot::new().with_data(line.points.clone()).with_color(colour);
            let plot = plot.with_stroke_width(if line.name.is_empty() { 1.2 } else { 2.2 });
            let plot = match line.style() {
                Some(style) => plot.with_line_style(LineStyle::Custom(style.to_string())),
                None => plot,
            };
            plots.push(plot.into());
        }
        if let Some(marker) = line.marker {
            let points = ScatterPlot::new().with_data::<f64, f64, CurvePoints>(line.points.clone());
            plots.push(points.with_size(4.5).with_marker(marker).with_color(colour).into());
        }
    }
    let legend: Vec<LegendEntry> =
        lines.iter().filter(|line| !line.name.is_empty()).map(Line::legend).collect();
    let height = 460.0 + 24.0 * legend.len().div_ceil(2) as f64;
    let mut layout = Layout::auto_from_plots(&plots)
        .with_x_label(frame.x)
        .with_y_label(frame.y)
        .with_x_label_offset(0.0, -6.0)
        .with_label_size(18)
        .with_tick_size(16)
        .with_body_size(16)
        .with_width(660.0)
        .with_height(height)
        .with_tick_format(TickFormat::Custom(Arc::new(tick)))
        .with_legend_entries(legend)
        .with_legend_col_limit(2)
        .with_legend_position(LegendPosition::OutsideBottomColumns);
    if frame.log {
        layout = layout.with_log_scale();
    }
    if let Some((low, high)) = frame.x_range {
        layout = layout.with_x_axis_min(low).with_x_axis_max(high);
    }
    if let Some((low, high)) = frame.y_range {
        layout = layout.with_y_axis_min(low).with_y_axis_max(high);
    }
    for (x, y, words) in &frame.notes {
        layout = layout.with_annotation(TextAnnotation::new(words, *x, *y).with_font_size(15));
    }
    own_ids(&render_to_svg(plots, layout))
}
