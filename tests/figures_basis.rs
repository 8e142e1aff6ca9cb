//! Pictures of the bases: all their functions on a line of nodes, and what a particle's force does
//! where it crosses from one cell into the next.

use crate::support::sketch::*;
use crate::support::*;
use lme_mpm::method::basis::{Basis, Degree, Support};
use lme_mpm::method::grid::Grid;
use lme_mpm::output::figure::COLOURS;
use nalgebra::Vector1;

const fn lme(gamma: f64) -> Basis {
    Basis::Lme { gamma, cutoff: 1e-6, support: Support::Ball }
}

/// A quarter of a cell is the half of a particle's share where two are in each.
const UGIMP: (&str, Basis) =
    ("uGIMP, two particles in each cell", Basis::Ugimp { half_length: [0.25; 3] });
const LINEAR: (&str, Basis) = ("linear", Basis::Linear);
const QUADRATIC: (&str, Basis) = ("quadratic B-splines", Basis::BSpline(Degree::Quadratic));
const CUBIC: (&str, Basis) = ("cubic B-splines", Basis::BSpline(Degree::Cubic));
const WIDE: (&str, Basis) = ("local max-ent, γ = 0.8", lme(0.8));
const MIDDLE: (&str, Basis) = ("local max-ent, γ = 1.8", lme(1.8));
const NARROW: (&str, Basis) = ("local max-ent, γ = 4", lme(4.0));

/// A body of six cells with h = 1, and how far its particles' centres stay from its ends.
const CELLS: usize = 6;

fn body(basis: &Basis) -> (Grid<1>, f64) {
    match basis {
        Basis::Ugimp { half_length } => {
            (Grid::over([CELLS as f64], [CELLS], [[1, 1]]), half_length[0])
        }
        _ => (Grid::over([CELLS as f64], [CELLS], [[0, 0]]), 0.0),
    }
}

/// N and h∇N of one node, at places from one end of the body to the other.
struct Function {
    /// The place of its node.
    node: f64,
    N: Vec<(f64, f64)>,
    grad: Vec<(f64, f64)>,
}

/// All functions of a basis that are not zero in the body.
fn functions(basis: &Basis) -> Vec<Function> {
    let (grid, margin) = body(basis);
    // Beside the nodes, not on them: there ∇N may have two values.
    let (low, high) = (margin + 1e-9, CELLS as f64 - margin - 1e-9);
    let mut x: Vec<f64> = (0..=120).map(|n| low + (high - low) * f64::from(n) / 120.0).collect();
    x.extend((1..CELLS).flat_map(|I| [I as f64 - 1e-9, I as f64 + 1e-9]));
    x.sort_by(f64::total_cmp);
    x.retain(|x| x.fract() != 0.0);
    let x: Vec<_> = x.into_iter().map(Vector1::new).collect();
    let table = on_grid(basis, &grid, &x).unwrap().shape;
    let mut functions: Vec<Function> = (0..grid.nodes())
        .map(|I| Function { node: grid.position(I)[0], N: Vec::new(), grad: Vec::new() })
        .collect();
    for (p, x_p) in x.iter().enumerate() {
        let (mut one, mut slope) = (0.0, 0.0);
        for (I, N, grad_N) in table.of(p) {
            assert!(N >= 0.0);
            (one, slope) = (one + N, slope + grad_N[0]);
            functions[I].N.push((x_p[0], N));
            functions[I].grad.push((x_p[0], grad_N[0]));
        }
        assert!((one - 1.0).abs() < 1e-13 && slope.abs() < 1e-12, "{x_p}: {one}, {slope}");
    }
    functions
}

/// The largest N of the middle node, and the share of a node at an end when a particle sits there.
fn peaks(basis: &Basis) -> (f64, f64) {
    let functions = functions(basis);
    let peak = |node: f64| {
        let function = functions.iter().find(|function| function.node == node).unwrap();
        largest(function.N.iter().map(|point| point.1))
    };
    (peak(3.0), peak(0.0))
}

/// Draws N beside h∇N of all nodes for each basis, all on equal scales: that of the middle node
/// thick, those of the end nodes red and dashed.
fn rows(bases: &[(&str, Basis)]) -> String {
    const HEIGHT: f64 = 150.0;
    let mut sketch = Sketch::new(640.0, 36.0 + HEIGHT * bases.len() as f64);
    for (n, (name, basis)) in bases.iter().enumerate() {
        let top = 34.0 + HEIGHT * n as f64;
        sketch.words((36.0, top - 8.0), name, Hand { size: 16.0, ..HEAD }.left());
        let frame = |left: f64, y: [f64; 2]| Frame {
            corner: (left, top + 4.0),
            size: (246.0, HEIGHT - 56.0),
            x: [0.0, CELLS as f64],
            y,
        };
        let (value, slope) = (frame(62.0, [0.0, 1.1]), frame(382.0, [-1.6, 1.6]));
        let x_ticks: Vec<f64> = (0..=CELLS).map(|I| I as f64).collect();
        for (frame, ticks) in [(value, [0.0, 0.5, 1.0]), (slope, [-1.0, 0.0, 1.0])] {
            frame.axes(&mut sketch, &x_ticks, &ticks);
            frame.numbers(&mut sketch, &x_ticks, &ticks);
        }
        let mut functions = functions(basis);
        // The thick one is drawn last.
        functions.sort_by_key(|function| function.node == 3.0);
        for Function { node, N, grad } in &functions {
            let pen = match *node as i32 {
                3 => pen(COLOURS[0], 3.0),
                0 | 6 => Pen { dash: "7 3", ..pen(COLOURS[1], 2.2) },
                _ => pen(GREY, 1.3),
            };
            value.curve(&mut sketch, N, pen);
            slope.curve(&mut sketch, grad, pen);
        }
        sketch.words((16.0, top + 52.0), "N [–]", Hand { turned: true, size: 15.0, ..LABEL });
        sketch.words((340.0, top + 52.0), "h∇N [–]", Hand { turned: true, size: 15.0, ..LABEL });
    }
    let foot = 26.0 + HEIGHT * bases.len() as f64;
    for middle in [185.0, 505.0] {
        sketch.words((middle, foot), "place x/h [–]", Hand { size: 15.0, ..LABEL });
    }
    sketch.finish()
}

/// All functions of the bases on a grid, ends included. They add up to one everywhere; the middle
/// one is lower the smoother it is; B-splines are turned into interpolating ones at an end.
#[test]
fn figure_of_all_functions() {
    let bases = [LINEAR, UGIMP, QUADRATIC, CUBIC];
    let peaks = bases.map(|(_, basis)| peaks(&basis));
    let middle = peaks.map(|peak| peak.0);
    assert!(apart(&middle, &[1.0, 0.875, 0.75, 2.0 / 3.0]) < 1e-3, "{middle:?}");
    for n in [0, 2, 3] {
        assert!((peaks[n].1 - 1.0).abs() < 1e-3, "{peaks:?}");
    }
    approve_picture("basis__functions", rows(&bases));
}

/// The same for local max-ent: wide for a small γ, almost linear at 4, and at the ends always
/// interpolating.
#[test]
fn figure_of_all_functions_of_local_max_ent() {
    let bases = [WIDE, MIDDLE, NARROW];
    let peaks = bases.map(|(_, basis)| peaks(&basis));
    let middle = peaks.map(|peak| peak.0);
    assert!(middle[0] < 0.55 && middle[0] < middle[1] && middle[1] < middle[2], "{middle:?}");
    assert!(middle[2] > 0.95 && peaks.iter().all(|peak| (peak.1 - 1.0).abs() < 1e-3), "{peaks:?}");
    approve_picture("lme__functions", rows(&bases));
}

/// How far h times the force on node 3 has jumped where its cells meet at x = 3, and the most
/// that it changes between neighbours of a sweep in steps of 1e-3 h; the sweep itself.
struct Crossing {
    jump: f64,
    most: f64,
    sweep: Vec<(f64, f64)>,
}

/// The force −σ V ∇N of one particle of unit σ and V on node 3, in units of σV/h.
fn crossing(basis: &Basis) -> Crossing {
    let (grid, _) = body(basis);
    let node = (0..grid.nodes()).find(|I| grid.position(*I)[0] == 3.0).unwrap();
    let force = |x: &[f64]| -> Vec<f64> {
        let x: Vec<_> = x.iter().map(|x| Vector1::new(*x)).collect();
        let table = on_grid(basis, &grid, &x).unwrap().shape;
        let of_node = |p| -> f64 {
            table.of(p).filter(|(I, ..)| *I == node).map(|(_, _, grad_N)| -grad_N[0]).sum()
        };
        (0..x.len()).map(of_node).collect()
    };
    let x: Vec<f64> = (0..4000).map(|n| 1.0005 + 1e-3 * f64::from(n)).collect();
    let all = force(&x);
    let steps = all.windows(2).map(|pair| pair[1] - pair[0]);
    let sides = force(&[3.0 - 1e-10, 3.0 + 1e-10]);
    let far = |a: usize, b: usize| (all[a] - all[b]).abs() > 0.1;
    let last = x.len() - 1;
    let kept = |n: &usize| n.is_multiple_of(10) || *n == last || far(*n, n - 1) || far(*n, n + 1);
    Crossing {
        jump: sides[1] - sides[0],
        most: largest(steps),
        sweep: (0..x.len()).filter(kept).map(|n| (x[n] - 3.0, all[n])).collect(),
    }
}

/// A particle of unit stress and volume flies past a node. With the linear basis its force on the
/// node jumps by 2/h as it passes it, and by 1/h as it enters and leaves the node's cells; with no
/// other basis does it jump there by more than 1e-8, and in a step of 1e-3 h it changes by less
/// than 0.03/h.
#[test]
fn figure_of_a_crossing() {
    let bases = [LINEAR, UGIMP, QUADRATIC, CUBIC, WIDE, MIDDLE, NARROW];
    let crossings: Vec<Crossing> = bases.iter().map(|(_, basis)| crossing(basis)).collect();
    let jump = crossings[0].jump;
    assert!((jump - 2.0).abs() < 1e-12 && (crossings[0].most - 2.0).abs() < 1e-12, "{jump}");
    for ((name, _), Crossing { jump, most, .. }) in bases.iter().zip(&crossings).skip(1) {
        assert!(jump.abs() < 1e-8 && *most < 0.03, "{name}: {jump:e}, {most:e}");
    }
    let (width, height) = (265.0, 112.0);
    let mut sketch = Sketch::new(640.0, 690.0);
    for (n, ((name, _), Crossing { sweep, .. })) in bases.iter().zip(&crossings).enumerate() {
        // The linear one has the head of the page for itself.
        let place = if n == 0 { 0 } else { n + 1 };
        let corner = (52.0 + 312.0 * (place % 2) as f64, 34.0 + 160.0 * (place / 2) as f64);
        let frame = Frame { corner, size: (width, height), x: [-2.0, 2.0], y: [-1.2, 1.2] };
        let ticks = [[-2.0, -1.0, 0.0, 1.0, 2.0].as_slice(), &[-1.0, 0.0, 1.0]];
        frame.axes(&mut sketch, ticks[0], ticks[1]);
        frame.numbers(&mut sketch, ticks[0], ticks[1]);
        if n > 0 {
            let dashed = Pen { dash: "5 3", ..pen(COLOURS[1], 1.5) };
            frame.curve(&mut sketch, &crossings[0].sweep, dashed);
        }
        let thick = if n == 0 { pen(COLOURS[1], 2.6) } else { pen(COLOURS[0], 2.6) };
        frame.curve(&mut sketch, sweep, thick);
        sketch.words((corner.0, corner.1 - 9.0), name, Hand { size: 15.0, ..HEAD }.left());
    }
    for (n, line) in [
        "The force of one particle on one node,",
        "in units of stress · volume / h, against",
        "the distance of the particle in cells.",
        "Linear: it jumps by 2 as the particle",
        "passes the node. The others (solid, with",
        "the linear one dashed): no jump.",
    ]
    .iter()
    .enumerate()
    {
        sketch.words((340.0, 48.0 + 20.0 * n as f64), line, Hand { size: 14.0, ..LEFT });
    }
    for middle in [184.0, 496.0] {
        let words = "distance of the particle / h [–]";
        sketch.words((middle, 680.0), words, Hand { size: 15.0, ..LABEL });
    }
    approve_picture("basis__crossing", sketch.finish());
}
