//! Pictures of what moves: nodes and particles of MPM and of OTM on the bar, a block in flight, two
//! discs that meet.

use crate::support::sketch::*;
use crate::support::*;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time;
use lme_mpm::output::figure::COLOURS;
use nalgebra::Vector2;

const BLUE: &str = COLOURS[0];
const RED: &str = COLOURS[1];

/// The paths of the bar's nodes and of its particles: at each recorded time its ct/L and all places
/// x/L.
struct Paths {
    nodes: Vec<Vec<(f64, f64)>>,
    particles: Vec<Vec<(f64, f64)>>,
}

/// Ten cells with one particle each, the last quarter thrown at a fifth of the speed of a wave,
/// so that the motion is seen without being magnified.
fn paths(method: &[&str]) -> Paths {
    let fixed = [
        "grid.cells=10",
        "grid.particles_per_cell=1",
        "time.cfl=0.2",
        "initial_velocity.0.velocity=1000",
    ];
    let scene = dyka(&[method, &fixed].concat());
    let (model, mut state) = at_start::<1>(&scene);
    let length = scene.body.length[0];
    let nodes = if state.node.x.is_empty() { model.grid.nodes() } else { state.node.x.len() };
    let mut paths =
        Paths { nodes: vec![Vec::new(); nodes], particles: vec![Vec::new(); state.particle.len()] };
    let mut record = |state: &State<1>, t: f64| {
        let t = t / transit();
        for I in 0..nodes {
            let x = if state.node.x.is_empty() { model.grid.position(I) } else { state.node.x[I] };
            paths.nodes[I].push((x[0] / length, t));
        }
        for (path, x) in paths.particles.iter_mut().zip(&state.particle.x) {
            path.push((x[0] / length, t));
        }
    };
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    record(&state, 0.0);
    for step in 1..=model.steps {
        advance(&model, &mut state, step).unwrap();
        record(&state, step as f64 * model.dt);
    }
    paths
}

/// In how many of the recorded times a particle is in another cell than at the start.
fn strayed(paths: &Paths) -> usize {
    let cell = |x: f64, k: usize| paths.nodes.iter().filter(|path| path[k].0 < x).count();
    let all = paths.particles.iter().flat_map(|path| {
        path.iter().enumerate().filter(|(k, (x, _))| cell(*x, *k) != cell(path[0].0, 0))
    });
    all.count()
}

/// The bar with MPM and with OTM over a period: MPM's nodes stand, and particles cross them; OTM's
/// move along, and each material point stays between its two nodes.
#[test]
fn figure_of_moving_nodes() {
    let mpm = paths(&["basis.kind=lme", "basis.gamma=1.8"]);
    let otm = paths(&["method=otm", "basis.kind=lme", "basis.gamma=1.8"]);
    assert!(strayed(&mpm) > 10 && strayed(&otm) == 0, "{}, {}", strayed(&mpm), strayed(&otm));
    let mut sketch = Sketch::new(640.0, 470.0);
    for (n, (name, paths)) in [("MPM", &mpm), ("OTM", &otm)].into_iter().enumerate() {
        let frame = Frame {
            corner: (62.0 + 300.0 * n as f64, 34.0),
            size: (266.0, 340.0),
            x: [0.0, 1.13],
            y: [0.0, 4.0],
        };
        let ticks = [[0.0, 0.25, 0.5, 0.75, 1.0].as_slice(), &[0.0, 1.0, 2.0, 3.0, 4.0]];
        frame.axes(&mut sketch, &[], &[]);
        frame.numbers(&mut sketch, ticks[0], if n == 0 { ticks[1] } else { &[] });
        for path in &paths.nodes {
            frame.curve(&mut sketch, path, pen(BLUE, 1.6));
        }
        for path in &paths.particles {
            frame.curve(&mut sketch, path, Pen { dash: "5 3", ..pen(RED, 1.8) });
        }
        sketch.words((frame.corner.0 + 133.0, 22.0), name, HEAD);
        sketch.words((frame.corner.0 + 133.0, 412.0), "place x/L [–]", LABEL);
    }
    sketch.words((24.0, 204.0), "time ct/L [–]", Hand { turned: true, ..LABEL });
    sketch.line(&[(62.0, 445.0), (106.0, 445.0)], pen(BLUE, 2.0));
    sketch.words((114.0, 450.0), "nodes", LEFT);
    sketch.line(&[(210.0, 445.0), (254.0, 445.0)], Pen { dash: "5 3", ..pen(RED, 2.0) });
    sketch.words((262.0, 450.0), "particles (OTM: material points)", LEFT);
    approve_picture("otm__paths", sketch.finish());
}

/// A block of 5 × 5 cells that flies, turns and swings at some tenths of the speed of a wave.
fn block_in_flight() -> (Model<2>, State<2>) {
    let sets = ["body.law=neo-hookean", "time.end=1.4", "time.cfl=0.2", "body.youngs_modulus=1e5"];
    let (model, mut state) = at_start::<2>(&block(2, &sets));
    for p in 0..state.particle.len() {
        let x = state.particle.x[p] - Vector2::repeat(0.5);
        let swing = Vector2::new((3.0 * x[1]).sin(), -(3.0 * x[0]).sin()) * 1.5;
        state.particle.v[p] = Vector2::new(2.0 - 0.8 * x[1], 0.8 * x[0]) + swing;
    }
    (model, state)
}

/// Three instants of the block: its nodes stay between their neighbours, and its volume, summed
/// up over the material points, stays within a tenth.
#[test]
fn figure_of_a_block_in_flight() {
    let (model, mut state) = block_in_flight();
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    let volume = |state: &State<2>| {
        state.particle.m.iter().zip(&state.particle.rho).map(|(m, rho)| m / rho).sum::<f64>()
    };
    let frame =
        Frame { corner: (50.0, 20.0), size: (574.0, 232.3), x: [-0.15, 4.05], y: [-0.35, 1.35] };
    let mut sketch = Sketch::new(640.0, 350.0);
    let ticks = [[0.0, 1.0, 2.0, 3.0, 4.0].as_slice(), &[0.0, 0.5, 1.0]];
    frame.axes(&mut sketch, ticks[0], ticks[1]);
    frame.numbers(&mut sketch, ticks[0], ticks[1]);
    let before = volume(&state);
    for step in 0..=model.steps {
        if step > 0 {
            advance(&model, &mut state, step).unwrap();
        }
        if step % (model.steps / 2) == 0 && step / (model.steps / 2) < 3 {
            assert!((volume(&state) / before - 1.0).abs() < 0.1, "{step}: {}", volume(&state));
            one_instant(&mut sketch, &frame, &state, step as f64 * model.dt);
        }
    }
    sketch.words((335.0, 290.0), "x [m] to the right, y [m] upwards", LABEL);
    sketch.square((66.0, 322.0), 4.5, BLUE);
    sketch.words((78.0, 327.0), "nodes", LEFT);
    sketch.ring((170.0, 322.0), 4.0, pen(RED, 2.0));
    sketch.words((182.0, 327.0), "material points", LEFT);
    sketch.line(&[(340.0, 322.0), (384.0, 322.0)], THIN);
    sketch.words((392.0, 327.0), "neighbours at the start", LEFT);
    approve_picture("otm__block", sketch.finish());
}

fn one_instant(sketch: &mut Sketch, frame: &Frame, state: &State<2>, t: f64) {
    let place = |x: &Vector2<f64>| frame.at(x[0], x[1]);
    let x: Vec<Place> = state.node.x.iter().map(place).collect();
    let node = |i: usize, j: usize| x[i + 6 * j];
    for n in 0..6 {
        for k in 0..5 {
            sketch.line(&[node(k, n), node(k + 1, n)], THIN);
            sketch.line(&[node(n, k), node(n, k + 1)], THIN);
        }
    }
    // No cell has been turned over; y runs downwards in a picture.
    for k in 0..25 {
        let (i, j) = (k % 5, k / 5);
        let [a, b, c] = [node(i, j), node(i + 1, j), node(i, j + 1)];
        let area = (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
        assert!(area < 0.0, "cell {i}, {j} at {t}");
    }
    x.iter().for_each(|at| sketch.square(*at, 4.0, BLUE));
    state.particle.x.iter().for_each(|x| sketch.ring(place(x), 3.2, pen(RED, 1.8)));
    let middle: f64 = x.iter().map(|at| at.0).sum::<f64>() / 36.0;
    let top = x.iter().map(|at| at.1).fold(f64::INFINITY, f64::min);
    sketch.words((middle, top - 12.0), &format!("t = {t:.1} s"), HEAD);
}

/// The mean velocity of the particles of a list.
fn mean_velocity(state: &State<2>, of: &[usize]) -> Vector2<f64> {
    of.iter().map(|p| state.particle.v[*p]).sum::<Vector2<f64>>() / of.len() as f64
}

/// Four instants of the two discs: they fly towards each other at √2 · 0.1 m/s, have less than a
/// tenth of it when they are pressed most, and part with more than nine tenths; not one particle has
/// gone over to the other side of the line between them.
#[test]
fn figure_of_the_discs() {
    let (model, mut state) = at_start::<2>(&scene(DISCS, &[]));
    let first: Vec<usize> =
        (0..state.particle.len()).filter(|p| state.particle.x[*p].sum() < 1.0).collect();
    let second: Vec<usize> = (0..state.particle.len()).filter(|p| !first.contains(p)).collect();
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    let mut sketch = Sketch::new(640.0, 690.0);
    let (mut step, mut speeds) = (0, Vec::new());
    for (n, t) in [0.0, 1.9, 2.4, 3.4].into_iter().enumerate() {
        while (step as f64) * model.dt < t {
            step += 1;
            advance(&model, &mut state, step).unwrap();
        }
        let frame = Frame {
            corner: (44.0 + 304.0 * (n % 2) as f64, 34.0 + 310.0 * (n / 2) as f64),
            size: (264.0, 250.0),
            x: [0.0, 1.056],
            y: [0.0, 1.0],
        };
        let ticks = [0.0, 0.5, 1.0];
        frame.axes(&mut sketch, &ticks, &ticks);
        frame.numbers(&mut sketch, &ticks, &ticks);
        for p in 0..state.particle.len() {
            let at = frame.at(state.particle.x[p][0], state.particle.x[p][1]);
            match first.contains(&p) {
                true => sketch.dot(at, 2.4, BLUE),
                false => sketch.ring(at, 2.0, pen(RED, 1.4)),
            }
            assert_eq!(state.particle.x[p].sum() < 1.0, first.contains(&p), "{p}");
        }
        for of in [&first, &second] {
            let place = of.iter().map(|p| state.particle.x[*p]).sum::<Vector2<f64>>();
            let (x, v) = (place / of.len() as f64, mean_velocity(&state, of));
            if v.norm() > 0.02 {
                let to = x + v * 1.4;
                sketch.arrow(frame.at(x[0], x[1]), frame.at(to[0], to[1]), THICK);
            }
        }
        speeds.push(mean_velocity(&state, &first).sum() / 2.0_f64.sqrt());
        let head = format!("t = {} s", number(t));
        sketch.words((frame.corner.0 + 132.0, frame.corner.1 - 10.0), &head, HEAD);
    }
    assert!((speeds[0] - 0.02_f64.sqrt()).abs() < 1e-12, "{speeds:?}");
    assert!(speeds[1].abs() < 0.1 * speeds[0] && speeds[3] < -0.9 * speeds[0], "{speeds:?}");
    sketch.words((330.0, 650.0), "x [m] to the right, y [m] upwards", LABEL);
    sketch.words((330.0, 676.0), "arrows: mean velocity of a disc, 0.14 m/s at the start", LABEL);
    approve_picture("discs__film", sketch.finish());
}
