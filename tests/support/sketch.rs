//! Sketches: pictures of lines, shapes and words at places of their own, as SVG, in the look of
//! the plotted ones; and frames that give numbers a place in them.

use std::fmt::Write;

pub const INK: &str = "#222222";
pub const GREY: &str = "#777777";
pub const PALE: &str = "#cccccc";

/// A place in a picture (px), from the left and from the top.
pub type Place = (f64, f64);

/// A line is drawn with a pen.
#[derive(Clone, Copy)]
pub struct Pen {
    pub colour: &'static str,
    pub width: f64,
    /// px on, px off; empty: solid.
    pub dash: &'static str,
}

pub const THIN: Pen = Pen { colour: GREY, width: 1.0, dash: "" };
pub const THICK: Pen = Pen { colour: INK, width: 2.5, dash: "" };

pub const fn pen(colour: &'static str, width: f64) -> Pen {
    Pen { colour, width, dash: "" }
}

/// Words are written in a hand.
#[derive(Clone, Copy)]
pub struct Hand {
    pub size: f64,
    pub colour: &'static str,
    /// `start`, `middle` or `end`.
    pub anchor: &'static str,
    pub bold: bool,
    /// By a quarter, so that they run upwards.
    pub turned: bool,
}

impl Hand {
    /// The same hand, beginning at its place.
    pub fn left(self) -> Hand {
        Hand { anchor: "start", ..self }
    }
}

pub const LABEL: Hand =
    Hand { size: 16.0, colour: INK, anchor: "middle", bold: false, turned: false };
pub const LEFT: Hand = Hand { anchor: "start", ..LABEL };
pub const RIGHT: Hand = Hand { anchor: "end", ..LABEL };
pub const HEAD: Hand = Hand { size: 17.0, bold: true, ..LABEL };
pub const TICK: Hand = Hand { size: 14.0, ..LABEL };

pub struct Sketch {
    size: (f64, f64),
    body: String,
}

impl Sketch {
    pub fn new(width: f64, height: f64) -> Self {
        Sketch { size: (width, height), body: String::new() }
    }

    /// A line through points.
    pub fn line(&mut self, points: &[Place], pen: Pen) {
        let dash = match pen.dash {
            "" => String::new(),
            dash => format!(" stroke-dasharray=\"{dash}\""),
        };
        writeln!(
            self.body,
            "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" \
             stroke-linejoin=\"round\"{dash}/>",
            path(points),
            pen.colour,
            pen.width
        )
        .unwrap();
    }

    /// A filled polygon.
    pub fn area(&mut self, points: &[Place], fill: &str) {
        writeln!(self.body, "<path d=\"{} Z\" fill=\"{fill}\"/>", path(points)).unwrap();
    }

    pub fn dot(&mut self, at: Place, radius: f64, fill: &str) {
        writeln!(
            self.body,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{fill}\"/>",
            at.0, at.1
        )
        .unwrap();
    }

    /// A circle that is not filled.
    pub fn ring(&mut self, at: Place, radius: f64, pen: Pen) {
        writeln!(
            self.body,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"#ffffff\" stroke=\"{}\" \
             stroke-width=\"{}\"/>",
            at.0, at.1, pen.colour, pen.width
        )
        .unwrap();
    }

    /// A filled square with sides of twice `half`.
    pub fn square(&mut self, at: Place, half: f64, fill: &str) {
        let ((x, y), h) = (at, half);
        self.area(&[(x - h, y - h), (x + h, y - h), (x + h, y + h), (x - h, y + h)], fill);
    }

    /// A line with a tip at its end.
    pub fn arrow(&mut self, from: Place, to: Place, pen: Pen) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = (dx * dx + dy * dy).sqrt();
        let (e, size) = ((dx / length, dy / length), 5.0 + 2.0 * pen.width);
        let back = |along: f64, aside: f64| {
            (to.0 - along * e.0 - aside * e.1, to.1 - along * e.1 + aside * e.0)
        };
        self.line(&[from, back(0.8 * size, 0.0)], pen);
        self.area(&[to, back(size, 0.45 * size), back(size, -0.45 * size)], pen.colour);
    }

    /// A line with a tip at either end.
    pub fn span(&mut self, from: Place, to: Place, pen: Pen) {
        let middle = ((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0);
        self.arrow(middle, from, pen);
        self.arrow(middle, to, pen);
    }

    /// Words with the foot of their line at a place; `_x` and `^x` lower and raise what follows,
    /// up to a blank.
    pub fn words(&mut self, at: Place, words: &str, hand: Hand) {
        let turned = match hand.turned {
            true => format!(" transform=\"rotate(-90 {:.1} {:.1})\"", at.0, at.1),
            false => String::new(),
        };
        writeln!(
            self.body,
            "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"{}\" fill=\"{}\" text-anchor=\"{}\"{}{turned}>\
             {}</text>",
            at.0,
            at.1,
            hand.size,
            hand.colour,
            hand.anchor,
            if hand.bold { " font-weight=\"bold\"" } else { "" },
            shifted(words)
        )
        .unwrap();
    }

    pub fn finish(self) -> String {
        let (width, height) = self.size;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"DejaVu Sans, Verdana, Liberation Sans, \
             Arial, sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n\
             {}</svg>\n",
            self.body
        )
    }
}

fn path(points: &[Place]) -> String {
    let points: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
    format!("M {}", points.join(" L "))
}

/// Escapes words, and sets what follows `_` and `^` as indices, up to a blank or a bracket.
fn shifted(words: &str) -> String {
    let words = words.replace('&', "&amp;").replace('<', "&lt;");
    let (mut out, mut level, mut rest) = (String::new(), 0, words.as_str());
    let mut put = |text: &str, target: i32| {
        if !text.is_empty() {
            let size = if target == 0 { "" } else { " font-size=\"75%\"" };
            write!(out, "<tspan dy=\"{}\"{size}>{text}</tspan>", target - level).unwrap();
            level = target;
        }
    };
    while let Some(at) = rest.find(['_', '^']) {
        put(&rest[..at], 0);
        let target = if rest[at..].starts_with('_') { 4 } else { -6 };
        let index = &rest[at + 1..];
        let end = index.find([' ', '(', ')', '[', ']', ',', '/', '_', '^']);
        let (index, after) = index.split_at(end.unwrap_or(index.len()));
        put(index, target);
        rest = after;
    }
    put(rest, 0);
    out
}

/// A frame gives numbers their place in a sketch.
#[derive(Clone, Copy)]
pub struct Frame {
    /// Its left upper corner (px), its width and height (px).
    pub corner: Place,
    pub size: (f64, f64),
    /// What its axes reach over.
    pub x: [f64; 2],
    pub y: [f64; 2],
}

impl Frame {
    pub fn at(&self, x: f64, y: f64) -> Place {
        let part = |v: f64, [low, high]: [f64; 2]| (v - low) / (high - low);
        (
            self.corner.0 + self.size.0 * part(x, self.x),
            self.corner.1 + self.size.1 * (1.0 - part(y, self.y)),
        )
    }

    /// The places of points.
    pub fn all(&self, points: &[(f64, f64)]) -> Vec<Place> {
        points.iter().map(|(x, y)| self.at(*x, *y)).collect()
    }

    /// Lines of a grid at the ticks, and the axes.
    pub fn axes(&self, sketch: &mut Sketch, x_ticks: &[f64], y_ticks: &[f64]) {
        let ([left, right], [low, high]) = (self.x, self.y);
        for x in x_ticks {
            sketch.line(&[self.at(*x, low), self.at(*x, high)], pen(PALE, 1.0));
        }
        for y in y_ticks {
            sketch.line(&[self.at(left, *y), self.at(right, *y)], pen(PALE, 1.0));
        }
        let corner = [self.at(left, high), self.at(left, low), self.at(right, low)];
        sketch.line(&corner, pen("#000000", 1.0));
    }

    /// The numbers at the ticks.
    pub fn numbers(&self, sketch: &mut Sketch, x_ticks: &[f64], y_ticks: &[f64]) {
        for x in x_ticks {
            let (at, foot) = self.at(*x, self.y[0]);
            sketch.words((at, foot + 18.0), &number(*x), TICK);
        }
        for y in y_ticks {
            let (edge, at) = self.at(self.x[0], *y);
            sketch.words((edge - 6.0, at + 5.0), &number(*y), Hand { anchor: "end", ..TICK });
        }
    }

    pub fn curve(&self, sketch: &mut Sketch, points: &[(f64, f64)], pen: Pen) {
        sketch.line(&self.all(points), pen);
    }
}

/// A number in few digits, with a true minus.
pub fn number(x: f64) -> String {
    let rounded = format!("{x:.3}");
    let short = rounded.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".into() } else { short.replace('-', "−") }
}
