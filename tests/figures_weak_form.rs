//! The picture of the weak form: from integrals over a body to sums over particles, and to one
//! equation for each node.

use crate::support::sketch::*;
use crate::support::*;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::model::State;
use lme_mpm::method::time;
use lme_mpm::output::figure::COLOURS;
use std::f64::consts::PI;

const BLUE: &str = COLOURS[0];
const RED: &str = COLOURS[1];

/// The body: a disc on 5 × 5 cells with 2 × 2 particles in each, with its grid and its state at
/// k = 0, whose nodes have their masses.
const CENTRE: f64 = 0.5;
const RADIUS: f64 = 0.42;

fn disc() -> (Grid<2>, State<2>) {
    let text = DISCS
        .replace("centre = [0.2, 0.2]\nradius = 0.2", "centre = [0.5, 0.5]\nradius = 0.42")
        .replace("\n[[body.ball]]\ncentre = [0.8, 0.8]\nradius = 0.2\n", "");
    let text = text.split("[[initial_velocity]]").next().unwrap();
    let (model, mut state) = at_start::<2>(&scene(text, &["grid.cells=[5,5]"]));
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    (model.grid, state)
}

/// Points of the rim between two angles.
fn rim(frame: &Frame, from: f64, to: f64) -> Vec<Place> {
    let at = |n: i32| {
        let angle = from + (to - from) * f64::from(n) / 48.0;
        frame.at(CENTRE + RADIUS * libm::cos(angle), CENTRE + RADIUS * libm::sin(angle))
    };
    (0..=48).map(at).collect()
}

/// Panel 1: the body, held on a part of its surface and pulled on the rest.
fn body(sketch: &mut Sketch, frame: &Frame) {
    sketch.area(&rim(frame, 0.0, 2.0 * PI), "#dce9f5");
    sketch.line(&rim(frame, 0.0, 2.0 * PI), pen(INK, 1.5));
    sketch.line(&rim(frame, 0.8 * PI, 1.2 * PI), pen(INK, 6.0));
    for angle in [-0.3, 0.0, 0.3] {
        let (x, y) = (CENTRE + RADIUS * libm::cos(angle), CENTRE + RADIUS * libm::sin(angle));
        sketch.arrow(frame.at(x, y), frame.at(x + 0.14, y), pen(RED, 2.5));
    }
    sketch.words(frame.at(0.5, 0.56), "body Ω", LABEL);
    sketch.words(frame.at(0.5, 0.38), "ρ, v, σ, b", LABEL);
    sketch.words(frame.at(0.14, 0.47), "Γ_d", LABEL.left());
    sketch.words(frame.at(0.96, 0.72), "t", Hand { colour: RED, ..HEAD });
}

/// Panel 2: a particle in the middle of each piece.
fn particles(sketch: &mut Sketch, frame: &Frame, state: &State<2>) {
    for x in &state.particle.x {
        let (h, x, y) = (0.05, x[0], x[1]);
        let corners = [(x - h, y - h), (x + h, y - h), (x + h, y + h), (x - h, y + h)];
        sketch.area(&frame.all(&corners), "#dce9f5");
        let mut closed = frame.all(&corners);
        closed.push(closed[0]);
        sketch.line(&closed, pen(PALE, 1.0));
        sketch.dot(frame.at(x, y), 3.2, BLUE);
    }
    sketch.line(&rim(frame, 0.0, 2.0 * PI), Pen { dash: "4 3", ..pen(GREY, 1.2) });
}

/// Panel 3: the nodes, the larger the more mass they have.
fn nodes(sketch: &mut Sketch, frame: &Frame, grid: &Grid<2>, state: &State<2>) {
    for n in 0..=5 {
        let at = f64::from(n) * 0.2;
        sketch.line(&[frame.at(at, 0.0), frame.at(at, 1.0)], pen(PALE, 1.2));
        sketch.line(&[frame.at(0.0, at), frame.at(1.0, at)], pen(PALE, 1.2));
    }
    state.particle.x.iter().for_each(|x| sketch.dot(frame.at(x[0], x[1]), 2.2, BLUE));
    let top = largest(state.node.m.iter().copied());
    for I in 0..grid.nodes() {
        let x = grid.position(I);
        if state.node.m[I] > 0.0 {
            let half = 7.0 * libm::sqrt(state.node.m[I] / top);
            sketch.square(frame.at(x[0], x[1]), half, RED);
        }
    }
}

/// Body, particles, grid. The mass of the nodes is that of the particles, to round-off.
#[test]
fn figure_of_the_weak_form() {
    let (grid, state) = disc();
    let [of_nodes, of_particles] =
        [&state.node.m, &state.particle.m].map(|masses| masses.iter().sum::<f64>());
    assert!((of_nodes / of_particles - 1.0).abs() < 1e-14, "{of_nodes}, {of_particles}");
    let mut sketch = Sketch::new(640.0, 300.0);
    let frame = |n: usize| Frame {
        corner: (14.0 + 214.0 * n as f64, 34.0),
        size: (184.0, 184.0),
        x: [0.0, 1.0],
        y: [0.0, 1.0],
    };
    body(&mut sketch, &frame(0));
    particles(&mut sketch, &frame(1), &state);
    nodes(&mut sketch, &frame(2), &grid, &state);
    for (n, [head, foot, number]) in [
        ["Body", "integrals over Ω", "(7)"],
        ["Particles", "sums over p", "(8) to (11)"],
        ["Nodes", "one equation for each I", "(12) to (15)"],
    ]
    .into_iter()
    .enumerate()
    {
        let middle = 106.0 + 214.0 * n as f64;
        sketch.words((middle, 22.0), head, HEAD);
        sketch.words((middle, 252.0), foot, LABEL);
        sketch.words((middle, 276.0), number, LABEL);
        if n > 0 {
            let x = middle - 107.0;
            sketch.arrow((x - 32.0, 17.0), (x + 24.0, 17.0), pen(INK, 2.0));
        }
    }
    approve_picture("weak_form__sketch", sketch.finish());
}
