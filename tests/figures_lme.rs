//! Pictures of local max-ent: its multiplier, the function whose minimum that is, and its
//! functions in the plane.

use crate::support::sketch::*;
use crate::support::*;
use lme_mpm::method::basis::lme::plain;
use lme_mpm::method::basis::scattered::values_at;
use lme_mpm::method::basis::{Basis, Support};
use lme_mpm::method::grid::Grid;
use lme_mpm::output::figure::{COLOURS, DASHES};
use nalgebra::{Vector1, Vector2};

const GAMMAS: [f64; 3] = [0.8, 1.8, 4.0];

/// The places of seven nodes, h = 1.
const NODES: std::ops::RangeInclusive<i32> = 0..=6;

/// One step of Newton's method: where it starts.
struct Iterate {
    lambda: f64,
    log_Z: f64,
    r: f64,
    J: f64,
}

/// log Z of (32) at λ, with its first two derivatives r (37) and J (36), for the point x.
fn dual(x: f64, gamma: f64, lambda: f64) -> Iterate {
    let terms = NODES.map(|I| {
        let xi = x - f64::from(I);
        (xi, libm::exp(lambda * xi - gamma * xi * xi))
    });
    let Z: f64 = terms.clone().map(|(_, term)| term).sum();
    let r: f64 = terms.clone().map(|(xi, term)| xi * term / Z).sum();
    let J: f64 = terms.map(|(xi, term)| (xi - r) * (xi - r) * term / Z).sum();
    Iterate { lambda, log_Z: libm::log(Z), r, J }
}

/// Newton's method from λ = 0, step by step. The program's plain solver takes the same steps: |r|
/// before each of them and the λ at which it ends are the same to 1e-13.
fn newton(x: f64, gamma: f64) -> Vec<Iterate> {
    let xi: Vec<_> = NODES.map(|I| Vector1::new(x - f64::from(I))).collect();
    let mut residuals = Vec::new();
    let solution = plain::solve(&mut residuals, &xi, gamma).unwrap();
    let mut iterates = vec![dual(x, gamma, 0.0)];
    for n in 1..residuals.len() {
        let Iterate { lambda, r, J, .. } = iterates[n - 1];
        iterates.push(dual(x, gamma, lambda - r / J));
    }
    for (iterate, residual) in iterates.iter().zip(&residuals) {
        assert!((iterate.r.abs() - residual).abs() < 1e-13, "{}, {residual}", iterate.r);
    }
    let last = iterates.last().unwrap();
    assert!((last.lambda - solution.lambda[0]).abs() < 1e-13 * last.lambda.abs());
    iterates
}

/// λ h against x/h for each γ: 0 in the middle of the body, without bound at its ends.
fn multipliers(sketch: &mut Sketch, frame: &Frame) {
    let grid = Grid::<1>::over([6.0], [6], [[0, 0]]);
    // Closer together towards the ends.
    let at = |n: i32| 3.0 - 3.0 * libm::cos(std::f64::consts::PI * f64::from(n) / 600.0);
    let x: Vec<_> = (1..600).map(|n| Vector1::new(at(n))).collect();
    for (n, gamma) in GAMMAS.into_iter().enumerate() {
        let basis = Basis::Lme { gamma, cutoff: 0.0, support: Support::Ball };
        let lambda = on_grid(&basis, &grid, &x).unwrap().lambda;
        // At an end λ h grows as −log(x/h); in mirrored places it is the opposite.
        let grown = lambda[0][0] - lambda[9][0];
        assert!((grown - libm::log(x[9][0] / x[0][0])).abs() < 0.05, "{gamma}: {grown}");
        for p in 0..x.len() {
            assert!((lambda[p] + lambda[x.len() - 1 - p]).amax() < 1e-9, "{gamma}, {}", x[p]);
        }
        let points = x.iter().zip(&lambda).map(|(x, lambda)| (x[0], lambda[0]));
        let points: Vec<_> = points.filter(|point| point.1.abs() <= frame.y[1]).collect();
        frame.curve(sketch, &points, Pen { dash: DASHES[n], ..pen(COLOURS[n], 2.4) });
        let key = 356.0 + 22.0 * n as f64;
        sketch.line(&[(70.0, key), (116.0, key)], Pen { dash: DASHES[n], ..pen(COLOURS[n], 2.4) });
        sketch.words((124.0, key + 5.0), &format!("γ = {gamma}"), LEFT);
    }
}

/// log Z over λ at one place with the steps of Newton's method from λ = 0, and the parabola that
/// the first step follows.
fn valley(sketch: &mut Sketch, frame: &Frame, x: f64, gamma: f64) {
    let iterates = newton(x, gamma);
    let last = iterates.last().unwrap().lambda;
    // Each step is nearer, the last ones with the square of the distance.
    let away: Vec<f64> = iterates.iter().map(|iterate| (iterate.lambda - last).abs()).collect();
    for pair in away.windows(2).filter(|pair| pair[0] < 0.1 && pair[0] > 1e-6) {
        assert!(pair[1] < 2.0 * pair[0] * pair[0], "{away:?}");
    }
    let range = |n: i32| frame.x[0] + f64::from(n) / 100.0 * (frame.x[1] - frame.x[0]);
    let inside = |point: &(f64, f64)| frame.y[0] <= point.1 && point.1 <= frame.y[1];
    let Iterate { log_Z, r, J, .. } = iterates[0];
    let parabola = (0..=100).map(range).map(|l| (l, log_Z + r * l + 0.5 * J * l * l));
    let parabola: Vec<_> = parabola.filter(inside).collect();
    frame.curve(sketch, &parabola, Pen { dash: "4 3", ..pen(GREY, 1.6) });
    let curve = (0..=100).map(range).map(|l| (l, dual(x, gamma, l).log_Z));
    let curve: Vec<_> = curve.filter(inside).collect();
    frame.curve(sketch, &curve, pen(COLOURS[0], 2.4));
    for (n, iterate) in iterates.iter().enumerate().take(5) {
        let at = frame.at(iterate.lambda, iterate.log_Z);
        sketch.dot(at, 5.0, COLOURS[1]);
        sketch.words((at.0, at.1 - 10.0), &n.to_string(), Hand { bold: true, ..TICK });
    }
}

/// Both side by side: the multiplier against the place, and the valley at one place.
#[test]
fn figure_of_the_multiplier() {
    let mut sketch = Sketch::new(640.0, 430.0);
    let left = Frame { corner: (62.0, 40.0), size: (240.0, 250.0), x: [0.0, 6.0], y: [-6.0, 6.0] };
    let x_ticks: Vec<f64> = (0..=6).map(f64::from).collect();
    let y_ticks = [-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0];
    left.axes(&mut sketch, &x_ticks, &y_ticks);
    left.numbers(&mut sketch, &x_ticks, &y_ticks);
    multipliers(&mut sketch, &left);
    let (x, gamma) = (0.02, 0.8);
    let right =
        Frame { corner: (388.0, 40.0), size: (236.0, 250.0), x: [-1.0, 5.0], y: [0.0, 0.8] };
    let ticks = [[-1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0].as_slice(), &[0.0, 0.2, 0.4, 0.6, 0.8]];
    right.axes(&mut sketch, ticks[0], ticks[1]);
    right.numbers(&mut sketch, ticks[0], ticks[1]);
    valley(&mut sketch, &right, x, gamma);
    for (middle, head, foot) in
        [(182.0, "The multiplier", "place x/h [–]"), (506.0, "The valley of log Z", "λh [–]")]
    {
        sketch.words((middle, 24.0), head, HEAD);
        sketch.words((middle, 330.0), foot, LABEL);
    }
    sketch.words((20.0, 165.0), "λh [–]", Hand { turned: true, ..LABEL });
    sketch.words((342.0, 165.0), "log Z [–]", Hand { turned: true, ..LABEL });
    sketch.words((388.0, 361.0), &format!("at x = {x}h, γ = {gamma}"), LEFT);
    sketch.dot((396.0, 378.0), 5.0, COLOURS[1]);
    sketch.words((410.0, 383.0), "Newton's steps from λ = 0", LEFT);
    sketch.line(&[(388.0, 400.0), (430.0, 400.0)], Pen { dash: "4 3", ..pen(GREY, 1.6) });
    sketch.words((438.0, 405.0), "parabola of step 1", LEFT);
    approve_picture("lme__multiplier", sketch.finish());
}

/// Half of the width of a map (h).
const REACH: f64 = 2.5;

/// A map's levels, and how far apart points on a ray are (h).
const LEVELS: i32 = 20;
const STEP: f64 = 0.05;

/// N and h ∂N/∂x of the middle one of 7 × 7 nodes.
fn middle(gamma: f64, x: f64, y: f64) -> [f64; 2] {
    let nodes: Vec<_> =
        (-3..=3).flat_map(|j| (-3..=3).map(move |i| Vector2::new(i as f64, j as f64))).collect();
    let (values, _) = values_at(&nodes, 1.0, gamma, 1e-6, &Vector2::new(x, y)).unwrap();
    let own = values.into_iter().find(|value| value.0 == 24);
    own.map_or([0.0; 2], |(_, N, grad_N)| [N, grad_N[0]])
}

/// The contours of a hill around its top: `of` falls along each ray from there, so that
/// each level is one closed line. The right half is the mirror image of the left one.
fn contours(top: (f64, f64), levels: &[f64], of: impl Fn(f64, f64) -> f64) -> Vec<Vec<(f64, f64)>> {
    const RAYS: i32 = 24;
    let mut contours = vec![Vec::new(); levels.len()];
    for n in 0..=RAYS {
        let angle = std::f64::consts::PI * f64::from(n) / f64::from(RAYS);
        let e = (libm::cos(angle), libm::sin(angle));
        // A ray ends where the map does.
        let to_edge = |e: f64, from: f64| {
            if e > 1e-9 {
                (REACH - from) / e
            } else if e < -1e-9 {
                (REACH + from) / -e
            } else {
                f64::INFINITY
            }
        };
        let length = to_edge(e.0, top.0).min(to_edge(e.1, top.1));
        let steps = (length / STEP) as usize;
        let along: Vec<(f64, f64)> = (0..=steps)
            .map(|n| n as f64 * length / steps as f64)
            .map(|s| (s, of(top.0 + s * e.0, top.1 + s * e.1)))
            .collect();
        for pair in along.windows(2).take_while(|pair| pair[0].1 > levels[0]) {
            assert!(pair[1].1 < pair[0].1 + 2e-3, "{top:?}, {n}: {pair:?}");
        }
        for (contour, level) in contours.iter_mut().zip(levels) {
            let cut = along.windows(2).find(|pair| pair[1].1 < *level);
            let s = match cut {
                Some([(s, a), (t, b)]) if a > level => s + (t - s) * (a - level) / (a - b),
                Some([(s, _), _]) => *s,
                _ => length,
            };
            contour.push((top.0 + s * e.0, top.1 + s * e.1));
        }
    }
    for contour in &mut contours {
        let lower: Vec<_> = contour.iter().rev().map(|(x, y)| (*x, 2.0 * top.1 - y)).collect();
        contour.extend(lower);
    }
    contours
}

/// From white over blue to night: a larger size is darker.
fn shade(part: f64) -> String {
    let between = |a: [f64; 3], b: [f64; 3], part: f64| {
        let [r, g, b] = std::array::from_fn(|n| (a[n] + part * (b[n] - a[n])).round());
        format!("rgb({r},{g},{b})")
    };
    let (white, blue, night) = ([255.0; 3], [55.0, 135.0, 190.0], [8.0, 29.0, 88.0]);
    if part < 0.5 {
        between(white, blue, 2.0 * part)
    } else {
        between(blue, night, 2.0 * part - 1.0)
    }
}

/// From white to red above zero, to blue below.
fn warm_or_cold(part: f64) -> String {
    let to = if part > 0.0 { [180.0, 60.0, 0.0] } else { [0.0, 70.0, 140.0] };
    let mix = to.map(|channel: f64| (255.0 + (channel - 255.0) * part.abs()).round());
    format!("rgb({},{},{})", mix[0], mix[1], mix[2])
}

/// The paper's Fig. 3: N of the middle node and h ∂N/∂x in the plane for three γ, as contours
/// every twentieth, all on the same scales. With γ = 0.8, N is the same to 2% in all directions
/// half a cell and one cell from its node; with γ = 4 it is the bilinear function to a tenth, and
/// from 0.2h to 0.8h its slope along the middle of the row is the same to 2%.
#[test]
fn figure_3_as_contours() {
    for radius in [0.5, 1.0] {
        let along = middle(0.8, radius, 0.0)[0];
        for angle in [0.2, 0.4, 0.6, std::f64::consts::FRAC_PI_4] {
            let other = middle(0.8, radius * libm::cos(angle), radius * libm::sin(angle))[0];
            assert!((other / along - 1.0).abs() < 0.02, "{radius}, {angle}: {other}, {along}");
        }
    }
    let tenths = || (0..=10).map(|n| f64::from(n) / 10.0);
    for (x, y) in tenths().flat_map(|x| tenths().map(move |y| (x, y))) {
        let bilinear = (1.0 - x) * (1.0 - y);
        assert!((middle(4.0, x, y)[0] - bilinear).abs() < 0.1, "{x}, {y}");
    }
    let flat: Vec<f64> = (2..=8).map(|n| middle(4.0, 0.1 * f64::from(n), 0.0)[1]).collect();
    assert!(flat.iter().all(|slope| (slope / flat[3] - 1.0).abs() < 0.02), "{flat:?}");
    let mut sketch = Sketch::new(640.0, 476.0);
    for (column, gamma) in GAMMAS.into_iter().enumerate() {
        let frame = |row: usize| Frame {
            corner: (44.0 + 178.0 * column as f64, 40.0 + 218.0 * row as f64),
            size: (160.0, 160.0),
            x: [-REACH, REACH],
            y: [-REACH, REACH],
        };
        let (value, slope) = (frame(0), frame(1));
        hill(&mut sketch, &value, gamma);
        slopes(&mut sketch, &slope, gamma);
        for (frame, name) in [(value, "N"), (slope, "h ∂N/∂x")] {
            let ticks = [-2.0, -1.0, 0.0, 1.0, 2.0];
            frame.axes(&mut sketch, &[], &[]);
            frame.numbers(&mut sketch, &ticks, if column == 0 { &ticks } else { &[] });
            for x in -2..=2 {
                for y in -2..=2 {
                    sketch.dot(frame.at(f64::from(x), f64::from(y)), 1.6, INK);
                }
            }
            let head = (frame.corner.0 + 80.0, frame.corner.1 - 10.0);
            sketch.words(head, &format!("{name}, γ = {gamma}"), Hand { size: 15.0, ..HEAD });
        }
    }
    scale(&mut sketch, 40.0, 0, &shade);
    scale(&mut sketch, 258.0, -LEVELS, &warm_or_cold);
    sketch.words((302.0, 462.0), "x/h [–] to the right, y/h [–] upwards; dots: nodes", LABEL);
    approve_picture("lme__figure_3", sketch.finish());
}

/// Draws N: one hill.
fn hill(sketch: &mut Sketch, frame: &Frame, gamma: f64) {
    sketch.area(&frame.all(&square()), &shade(0.0));
    let top = middle(gamma, 0.0, 0.0)[0];
    let levels: Vec<f64> = (0..LEVELS).map(|n| f64::from(n) / f64::from(LEVELS)).collect();
    let levels: Vec<f64> =
        levels.into_iter().filter(|level| *level > 0.0 && *level < top).collect();
    let lines = contours((0.0, 0.0), &levels, |x, y| middle(gamma, x, y)[0]);
    for (line, level) in lines.iter().zip(&levels) {
        sketch.area(&frame.all(line), &shade(*level));
        outlined(sketch, frame, line);
    }
}

/// Draws h ∂N/∂x: a hill on the left, and the same hollow on the right.
fn slopes(sketch: &mut Sketch, frame: &Frame, gamma: f64) {
    let of = |x: f64, y: f64| middle(gamma, x, y)[1];
    let along = (1..100).map(|n| -0.02 * f64::from(n));
    let place = along.max_by(|a, b| of(*a, 0.0).total_cmp(&of(*b, 0.0))).unwrap();
    let top = of(place, 0.0);
    let levels: Vec<f64> = (1..LEVELS).map(|n| f64::from(n) / f64::from(LEVELS)).collect();
    let levels: Vec<f64> = levels.into_iter().filter(|level| *level < top).collect();
    let lines = contours((place, 0.0), &levels, of);
    for (line, level) in lines.iter().zip(&levels) {
        let mirrored: Vec<_> = line.iter().map(|(x, y)| (-x, *y)).collect();
        for (line, level) in [(line, *level), (&mirrored, -level)] {
            sketch.area(&frame.all(line), &warm_or_cold(level));
            outlined(sketch, frame, line);
        }
    }
}

fn outlined(sketch: &mut Sketch, frame: &Frame, line: &[(f64, f64)]) {
    let mut closed = frame.all(line);
    closed.push(closed[0]);
    sketch.line(&closed, pen("#555555", 0.5));
}

fn square() -> [(f64, f64); 4] {
    [(-REACH, -REACH), (REACH, -REACH), (REACH, REACH), (-REACH, REACH)]
}

/// A scale beside a row of maps: one colour for each level from `low` up.
fn scale(sketch: &mut Sketch, top: f64, low: i32, colour: &dyn Fn(f64) -> String) {
    let frame = Frame {
        corner: (584.0, top),
        size: (16.0, 160.0),
        x: [0.0, 1.0],
        y: [f64::from(low) / f64::from(LEVELS), 1.0],
    };
    for n in low..LEVELS {
        let (from, to) = (f64::from(n) / f64::from(LEVELS), f64::from(n + 1) / f64::from(LEVELS));
        let level = if n < 0 { to } else { from };
        sketch.area(&frame.all(&[(0.0, from), (1.0, from), (1.0, to), (0.0, to)]), &colour(level));
    }
    for y in [-1.0, -0.5, 0.0, 0.5, 1.0].into_iter().filter(|y| *y >= frame.y[0]) {
        let at = frame.at(1.0, y);
        sketch.words((at.0 + 4.0, at.1 + 5.0), &number(y), Hand { anchor: "start", ..TICK });
    }
}
