//! Pictures of the bar of Dyka and Ingel: what it is, and its exact solution in the plane of place
//! and time.

use crate::support::sketch::*;
use crate::support::*;
use lme_mpm::method::exact::Exact;
use lme_mpm::method::exact::riemann::{Bar, End};
use lme_mpm::output::figure::COLOURS;
use lme_mpm::setup;

const BLUE: &str = COLOURS[0];
const RED: &str = COLOURS[1];

/// The pens of fronts.
const TO_THE_RIGHT: Pen = pen(BLUE, 2.5);
const TO_THE_LEFT: Pen = Pen { dash: "8 4", ..pen(RED, 2.5) };

fn thrown_bar() -> Bar {
    let Ok(Exact::Linear { thrown: bar, .. }) = setup::exact::<1>(&dyka(&[])) else {
        panic!("the bar has an exact solution");
    };
    bar
}

/// The paper's Fig. 4, with the numbers of the scene: its left end is fixed, its right one free,
/// and its last quarter is thrown.
#[test]
fn figure_of_the_bar() {
    let bar = thrown_bar();
    let [patch] = &bar.patches[..] else { panic!("{:?}", bar.patches) };
    assert_eq!(bar.ends, [End::Fixed, End::Free]);
    assert!((patch.from / bar.length - 0.75).abs() < 1e-12 && patch.to == bar.length);
    let mut sketch = Sketch::new(640.0, 300.0);
    let at = |part: f64| 70.0 + 480.0 * part;
    let (top, foot) = (96.0, 146.0);
    let stretch =
        |from: f64, to: f64| [(at(from), top), (at(to), top), (at(to), foot), (at(from), foot)];
    sketch.area(&stretch(0.0, 0.75), "#e3e3e3");
    sketch.area(&stretch(0.75, 1.0), "#f5c6a5");
    let mut outline = stretch(0.0, 1.0).to_vec();
    outline.push(outline[0]);
    sketch.line(&outline, pen(INK, 2.0));
    sketch.line(&[(at(0.75), top), (at(0.75), foot)], Pen { dash: "4 3", ..THIN });
    wall(&mut sketch, at(0.0), (top - 22.0, foot + 22.0));
    for y in [108.0, 121.0, 134.0] {
        sketch.arrow((at(0.79), y), (at(0.96), y), pen(RED, 2.5));
    }
    sketch.words((at(0.375), 127.0), "at rest", LABEL);
    let thrown = format!("thrown: v_0 = {} m/s", number(patch.velocity));
    sketch.words((at(1.0), 84.0), &thrown, Hand { colour: "#a04000", anchor: "end", ..HEAD });
    sketch.words((14.0, 44.0), "fixed end: v = 0", LEFT);
    sketch.words((628.0, 44.0), "free end: σ = 0", RIGHT);
    sketch.line(&[(at(0.0) - 8.0, 50.0), (at(0.0) - 4.0, 70.0)], THIN);
    sketch.line(&[(600.0, 50.0), (at(1.0) + 6.0, 100.0)], THIN);
    for part in [0.0, 0.75, 1.0] {
        sketch.line(&[(at(part), foot + 6.0), (at(part), 218.0)], THIN);
    }
    sketch.span((at(0.0), 184.0), (at(0.75), 184.0), pen(GREY, 1.5));
    sketch.span((at(0.75), 184.0), (at(1.0), 184.0), pen(GREY, 1.5));
    sketch.words((at(0.375), 178.0), "3L/4", LABEL);
    sketch.words((at(0.875), 178.0), "L/4", LABEL);
    sketch.span((at(0.0), 212.0), (at(1.0), 212.0), pen(GREY, 1.5));
    sketch.words((at(0.5), 206.0), &format!("L = {:.4} m", bar.length), LABEL);
    let steel = format!(
        "steel: E = {:.0} GPa, ρ = {:.0} kg/m³, Poisson's ratio 0",
        bar.modulus * 1e-9,
        bar.density
    );
    sketch.words((70.0, 250.0), &steel, LEFT);
    let waves = format!(
        "speed of a wave: c = √(E/ρ) = {:.0} m/s; period: 4L/c = {:.1} µs",
        bar.c(),
        4e6 * bar.length / bar.c()
    );
    sketch.words((70.0, 276.0), &waves, LEFT);
    approve_picture("dyka__sketch", sketch.finish());
}

/// A wall that holds what is to its right: a line with hatches behind it.
fn wall(sketch: &mut Sketch, x: f64, (top, foot): (f64, f64)) {
    let mut y = top + 10.0;
    while y <= foot + 1.0 {
        sketch.line(&[(x - 12.0, y), (x, y - 10.0)], pen(INK, 1.2));
        y += 10.0;
    }
    sketch.line(&[(x, top), (x, foot)], pen(INK, 3.0));
}

/// A region of the plane of x/L and ct/L, between fronts.
struct Region {
    corners: Vec<(f64, f64)>,
    /// v over v₀, and σ over Z v₀.
    v: f64,
    sigma: f64,
}

/// All fronts of the bar are x − ct = ±¾L + 2nL and x + ct = ±¾L + 2nL.
fn cuts(low: f64, high: f64) -> Vec<f64> {
    let mut cuts = vec![low, high];
    let all = (-4..=4).flat_map(|n| [0.75, -0.75].map(|at| at + 2.0 * f64::from(n)));
    cuts.extend(all.filter(|at| low < *at && *at < high));
    cuts.sort_by(f64::total_cmp);
    cuts
}

/// The part of a polygon where `side` is not negative.
fn clipped(corners: &[(f64, f64)], side: impl Fn((f64, f64)) -> f64) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    for (n, a) in corners.iter().enumerate() {
        let b = corners[(n + 1) % corners.len()];
        let (s, t) = (side(*a), side(b));
        if s >= 0.0 {
            kept.push(*a);
        }
        if s * t < 0.0 {
            let part = s / (s - t);
            kept.push((a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1)));
        }
    }
    kept
}

fn centre(corners: &[(f64, f64)]) -> (f64, f64) {
    let n = corners.len() as f64;
    let sum = corners.iter().fold((0.0, 0.0), |sum, at| (sum.0 + at.0, sum.1 + at.1));
    (sum.0 / n, sum.1 / n)
}

/// The regions of one period. In each of them v and σ are those of its centre, wherever one looks;
/// across each front both jump.
fn regions(bar: &Bar) -> Vec<Region> {
    let state = |(x, t): (f64, f64)| {
        let at = bar.at(x * bar.length, t * bar.length / bar.c());
        let v_0 = bar.patches[0].velocity;
        (at.velocity / v_0, at.stress / (bar.Z() * v_0))
    };
    let mut regions = Vec::new();
    for a in cuts(-4.0, 1.0).windows(2) {
        for b in cuts(0.0, 5.0).windows(2) {
            let corner = |a: f64, b: f64| ((a + b) / 2.0, (b - a) / 2.0);
            let square =
                [corner(a[0], b[0]), corner(a[1], b[0]), corner(a[1], b[1]), corner(a[0], b[1])];
            let mut corners = clipped(&square, |(x, _)| x);
            corners = clipped(&corners, |(x, _)| 1.0 - x);
            corners = clipped(&corners, |(_, t)| t);
            corners = clipped(&corners, |(_, t)| 4.0 - t);
            let width = largest(corners.iter().map(|at| at.0 - centre(&corners).0));
            if corners.len() < 3 || width < 1e-9 {
                continue;
            }
            let middle = centre(&corners);
            let (v, sigma) = state(middle);
            for at in &corners {
                let near = (0.95 * at.0 + 0.05 * middle.0, 0.95 * at.1 + 0.05 * middle.1);
                let (w, tau) = state(near);
                assert!((w - v).abs() < 1e-12 && (tau - sigma).abs() < 1e-12, "{near:?}");
            }
            regions.push(Region { corners, v, sigma });
        }
    }
    regions
}

/// The bar's plane of place and time over one period: five pairs of v and σ and their opposites
/// fill it. Velocity or stress is zero, or both have half of what they can have.
#[test]
fn figure_of_the_fronts() {
    let bar = thrown_bar();
    let regions = regions(&bar);
    for Region { v, sigma, .. } in &regions {
        let pair = [v.abs(), sigma.abs()];
        let known = [[0.0, 0.0], [0.5, 0.5], [1.0, 0.0], [0.0, 1.0]];
        assert!(known.iter().any(|known| apart(known, &pair) < 1e-12), "{pair:?}");
    }
    let frame = Frame { corner: (70.0, 46.0), size: (548.0, 780.0), x: [0.0, 1.0], y: [0.0, 4.0] };
    let mut sketch = Sketch::new(640.0, 914.0);
    for region in &regions {
        sketch.area(&frame.all(&region.corners), fill(region.v, region.sigma));
    }
    let (v_0, peak) = (bar.patches[0].velocity, bar.Z() * bar.patches[0].velocity * 1e-6);
    fronts(&mut sketch, &frame);
    for Region { corners, v, sigma } in &regions {
        let at = centre(&frame.all(corners));
        let (v, sigma) = (number(v * v_0), number((sigma * peak).round()));
        let corner = corners.len() == 3 && at.0 > 500.0 && (at.1 < 100.0 || at.1 > 780.0);
        let (x, y, hand) = match corner {
            true if at.1 < 100.0 => (613.0, 58.0, Hand { size: 12.0, ..RIGHT }),
            true => (613.0, 809.0, Hand { size: 12.0, ..RIGHT }),
            false => (at.0, at.1 - 2.0, Hand { size: 15.0, ..LABEL }),
        };
        sketch.words((x, y), &format!("{v} m/s"), hand);
        sketch.words((x, y + 1.1 * hand.size), &format!("{sigma} MPa"), hand);
    }
    let ticks = [[0.0, 0.25, 0.5, 0.75, 1.0].as_slice(), &[0.0, 1.0, 2.0, 3.0, 4.0]];
    frame.axes(&mut sketch, &[], &[]);
    frame.numbers(&mut sketch, ticks[0], ticks[1]);
    sketch.words((344.0, 24.0), "Velocity and stress between the fronts", HEAD);
    sketch.words((344.0, 870.0), "place x/L [–]: fixed at 0, free at 1", LABEL);
    sketch.words((24.0, 436.0), "time ct/L [–]", Hand { turned: true, ..LABEL });
    sketch.line(&[(70.0, 897.0), (112.0, 897.0)], TO_THE_RIGHT);
    sketch.words((118.0, 902.0), "R^I jumps, to the right", LEFT);
    sketch.line(&[(360.0, 897.0), (402.0, 897.0)], TO_THE_LEFT);
    sketch.words((408.0, 902.0), "R^II jumps, to the left", LEFT);
    approve_picture("exact__fronts", sketch.finish());
}

/// Warm: it moves to the right; cold: to the left; green: it rests, pulled; violet: it rests,
/// pressed. Paler: half of that.
fn fill(v: f64, sigma: f64) -> &'static str {
    match ((2.0 * v).round() as i32, (2.0 * sigma).round() as i32) {
        (0, 0) => "#ffffff",
        (2, 0) => "#f0a36b",
        (-2, 0) => "#7db4de",
        (0, 2) => "#8fd0b4",
        (0, -2) => "#cfa3d6",
        (1, s) if s > 0 => "#f5dcb0",
        (1, _) => "#f6d5cf",
        (-1, s) if s > 0 => "#cfe6ef",
        _ => "#d3d2ee",
    }
}

/// The two fronts that start at 3L/4 go to and fro: solid to the right, where R^I jumps, dashed to
/// the left, where R^II does.
fn fronts(sketch: &mut Sketch, frame: &Frame) {
    for to_the_right in [true, false] {
        let (mut x, mut t, mut right): (f64, f64, bool) = (0.75, 0.0, to_the_right);
        while t < 4.0 {
            let (end, pen) = match right {
                true => (1.0, TO_THE_RIGHT),
                false => (0.0, TO_THE_LEFT),
            };
            let step = f64::min((end - x).abs(), 4.0 - t);
            let to = x + step * (end - x).signum();
            frame.curve(sketch, &[(x, t), (to, t + step)], pen);
            (x, t, right) = (to, t + step, !right);
        }
    }
}
