//! Local max-ent against references of 60 digits and more, and how its λ is
//! found.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::lme::{Failure, plain};
use lme_mpm::method::basis::scattered::{Places, fill_from_nodes, values_at as lme_at};
use lme_mpm::method::basis::{Basis, Scratch, Support};
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::Multiplier;
use lme_mpm::method::grid::Grid;
use lme_mpm::output::figure::{self, Axes};
use nalgebra::{Matrix2, SVector, Vector1, Vector2};
use std::collections::BTreeMap;

fn rows(name: &str) -> Vec<Vec<String>> {
    let path = format!("{}/data/reference/{name}", env!("CARGO_MANIFEST_DIR"));
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect()
}

fn vector<const D: usize>(cells: &[String]) -> SVector<f64, D> {
    SVector::from_fn(|d, _| cells[d].parse().unwrap())
}

/// The distance in units of the last place of `expected`.
fn ulps(x: f64, expected: f64) -> f64 {
    let ulp = expected.abs().next_up() - expected.abs();
    (x - expected).abs() / ulp
}

#[derive(Default)]
struct Errors {
    points: usize,
    N: f64,
    grad: f64,
    ulp: f64,
    ulp_sum: f64,
    values: usize,
}

type Reference = BTreeMap<(usize, usize), Vec<f64>>;

fn reference() -> Reference {
    rows("lme_values.csv")
        .into_iter()
        .map(|row| {
            let values = row[2..].iter().filter(|cell| !cell.is_empty());
            let values = values.map(|cell| cell.parse().unwrap()).collect();
            ((row[0].parse().unwrap(), row[1].parse().unwrap()), values)
        })
        .collect()
}

fn nodes<const D: usize>(set: &str) -> Vec<SVector<f64, D>> {
    let all = rows("lme_nodes.csv");
    all.iter().filter(|row| row[0] == set).map(|row| vector(&row[2..])).collect()
}

fn compare<const D: usize>(
    errors: &mut Errors,
    point: usize,
    h: f64,
    computed: &[(usize, f64, SVector<f64, D>)],
    reference: &Reference,
) {
    errors.points += 1;
    let mut seen = 0;
    for (I, N, grad) in computed {
        let zero = vec![0.0; D + 1];
        let known = reference.get(&(point, *I));
        seen += usize::from(known.is_some());
        let expected = known.unwrap_or(&zero);
        errors.N = errors.N.max((N - expected[0]).abs());
        if expected[0] > 1e-8 {
            let distance = ulps(*N, expected[0]);
            errors.ulp = errors.ulp.max(distance);
            errors.ulp_sum += distance;
            errors.values += 1;
        }
        for d in 0..D {
            errors.grad = errors.grad.max(h * (grad[d] - expected[d + 1]).abs());
        }
    }
    let all = reference.range((point, 0)..(point + 1, 0)).count();
    assert_eq!(seen, all, "point {point}: a node is missing");
}

fn check<const D: usize>(
    set: &str,
    table: &mut BTreeMap<(String, String), Errors>,
    reference: &Reference,
) {
    let nodes = nodes::<D>(set);
    for row in rows("lme_points.csv").iter().filter(|row| row[1] == set) {
        let (point, gamma, h): (usize, f64, f64) =
            (row[0].parse().unwrap(), row[3].parse().unwrap(), row[4].parse().unwrap());
        let x = vector::<D>(&row[5..]);
        let label = row[2].clone();
        let (values, _) = lme_at(&nodes, h, gamma, 0.0, &x).unwrap_or_else(|failure| {
            panic!("point {point} ({set}, {label}, γ = {gamma}): {failure}")
        });
        let errors = table.entry((label.clone(), format!("{D}D"))).or_default();
        compare(errors, point, h, &values, reference);
        if set.starts_with("grid") || set == "line" {
            let top = nodes.last().unwrap();
            let cells: [usize; D] = std::array::from_fn(|d| (top[d] / h).round() as usize);
            let grid = Grid::new(SVector::repeat(h), cells, [0; D], *top);
            let basis = Basis::Lme { gamma, cutoff: 0.0, support: Support::Ball };
            let values = on_grid(&basis, &grid, &[x])
                .unwrap_or_else(|fault| panic!("point {point}: {fault}"))
                .row();
            let errors = table.entry((label, format!("{D}D grid"))).or_default();
            compare(errors, point, h, &values, reference);
        }
    }
}

#[test]
fn lme_against_60_digits() {
    let reference = reference();
    let mut table = BTreeMap::new();
    for set in ["line", "far", "huge", "tiny"] {
        check::<1>(set, &mut table, &reference);
    }
    check::<2>("grid2", &mut table, &reference);
    check::<3>("grid3", &mut table, &reference);
    check::<2>("scattered2", &mut table, &reference);
    check::<3>("scattered3", &mut table, &reference);
    check::<2>("slanted2", &mut table, &reference);
    check::<3>("slanted3", &mut table, &reference);
    let mut text = String::from(
        "domain,nodes,points,N: largest error,h∇N: largest error,N: largest ULP,N: mean ULP\n",
    );
    for ((domain, kind), e) in &table {
        assert!(e.N < 1e-14, "{domain} {kind}: N off by {:e}", e.N);
        // 1e-15 h from a slanted side the distance itself is rounded at 1e-16 h.
        let least = if domain == "near a slanted side" { 2e-10 } else { 1e-13 };
        assert!(e.grad < least, "{domain} {kind}: h∇N off by {:e}", e.grad);
        let mean = e.ulp_sum / e.values as f64;
        let points = e.points;
        text += &format!(
            "{domain},{kind},{points},{:.1e},{:.1e},{:.0},{mean:.1}\n",
            e.N, e.grad, e.ulp
        );
    }
    approve("lme__accuracy", &text);
}

/// |r| before each step of plain Newton at x among the nodes −8 … 8 with the spacing 1.
fn plain_residuals(gamma: f64, x: f64) -> Vec<f64> {
    let xi: Vec<_> = (-8..=8).map(|I| Vector1::new(x - f64::from(I))).collect();
    let mut residuals = Vec::new();
    let _ = plain::solve(&mut residuals, &xi, gamma);
    residuals
}

/// Plain Newton from λ = 0 fails at more and more places as γ grows; the damped
/// one with its starting values takes a few steps at any γ and place.
#[test]
fn lme_plain_newton_fails() {
    let places: Vec<f64> = (1..=50).map(|n| 0.01 * f64::from(n) - 0.005).collect();
    let mut text = String::from(
        "γ,plain Newton from 0 fails at (of 50 places),most steps of it elsewhere,most steps here\n",
    );
    let mut failures = Vec::new();
    for gamma in [0.8, 1.8, 4.0, 6.0, 8.0, 12.0, 20.0, 100.0, 1000.0] {
        let (mut fails, mut plain, mut most) = (0, 0, 0);
        for x in &places {
            let residuals = plain_residuals(gamma, *x);
            match residuals.last() {
                Some(r) if *r < 1e-12 => plain = plain.max(residuals.len()),
                _ => fails += 1,
            }
            let end = SVector::<f64, 1>::new(8.0);
            let grid = Grid::new(SVector::repeat(1.0), [16], [8], end);
            let basis = Basis::Lme { gamma, cutoff: 0.0, support: Support::Ball };
            let x = [SVector::<f64, 1>::new(*x)];
            most = most.max(on_grid(&basis, &grid, &x).unwrap().cost.newton_iterations);
        }
        assert!(most <= 8, "γ = {gamma}: {most}");
        failures.push(fails);
        text += &format!("{gamma},{fails},{plain},{most}\n");
    }
    assert!(failures.is_sorted(), "{failures:?}");
    assert!(failures[..3] == [0, 0, 0] && failures[3] > 0 && failures[8] > 40, "{failures:?}");
    approve("lme__newton_steps", &text);
    let curve = |gamma: f64| {
        let residuals = plain_residuals(gamma, 0.4);
        let floor = |r: f64| libm::log10(r.max(1e-17));
        let points = residuals.iter().enumerate().map(|(n, r)| (n as f64, floor(*r)));
        (format!("γ = {gamma}"), points.take(10).collect())
    };
    let lists: Vec<_> = [1.8, 4.0, 8.0, 12.0, 20.0].into_iter().map(curve).collect();
    let steps: Vec<usize> =
        lists.iter().map(|(_, points): &(String, Vec<(f64, f64)>)| points.len()).collect();
    assert!(steps[..4].is_sorted_by(|a, b| a < b) && steps[4] == 3, "{steps:?}");
    let svg = figure::curves(
        &lists,
        &Axes::new(
            "Plain Newton from λ = 0 at x = 0.4h",
            "step of Newton's method [–]",
            "log₁₀ |r| [–]",
            false,
        ),
    );
    approve_picture("lme__plain_newton", svg);
}

/// What plain Newton and the library make of the same places.
#[derive(Default)]
struct Beside {
    /// Places at which plain Newton finds λ.
    served: usize,
    /// The largest differences there, of N and of h∇N.
    N: f64,
    grad: f64,
}

/// Fifty places all over a set of nodes with the spacing 0.1.
fn beside_plain<const D: usize>(set: &str, gamma: f64) -> Beside {
    let (nodes, h) = (nodes::<D>(set), 0.1);
    let top = nodes.last().unwrap();
    let cells: [usize; D] = std::array::from_fn(|d| (top[d] / h).round() as usize);
    let grid = Grid::new(SVector::repeat(h), cells, [0; D], *top);
    let mut beside = Beside::default();
    for n in 1..=50 {
        let irrational = [0.618033988749895, 0.754877666246693, 0.569840290998053];
        let s = SVector::<f64, D>::from_fn(|d, _| (f64::from(n) * irrational[d]).fract());
        let x = (s * 0.9 + SVector::repeat(0.05)).component_mul(top);
        let xi: Vec<_> = nodes.iter().map(|x_I| (x - x_I) / h).collect();
        let Ok(plain) = plain::solve(&mut Vec::new(), &xi, gamma) else {
            continue;
        };
        beside.served += 1;
        let (listed, lambda) = lme_at(&nodes, h, gamma, 0.0, &x).unwrap();
        assert_relative_eq!(lambda * h, plain.lambda, epsilon = 1e-13, max_relative = 1e-13);
        let mut rows = vec![listed];
        if !set.starts_with("scattered") {
            let basis = Basis::Lme { gamma, cutoff: 0.0, support: Support::Ball };
            rows.push(on_grid(&basis, &grid, &[x]).unwrap().row());
        }
        for (I, N, grad) in rows.into_iter().flatten() {
            beside.N = beside.N.max((N - plain.p[I]).abs());
            beside.grad = beside.grad.max((grad * h - plain.grad[I]).amax());
        }
    }
    beside
}

/// Where plain Newton finds λ, the library's N and ∇N are those of the equations as they
/// stand, on grids and on scattered nodes in 1D, 2D and 3D. Up to γ = 1.8 plain Newton
/// finds it everywhere inside, and from about 6 up at few places.
#[test]
fn lme_is_what_plain_newton_finds() {
    let mut text = String::from(
        "γ,line,grid in 2D,scattered in 2D,grid in 3D,scattered in 3D,N: largest difference,h∇N: largest difference\n",
    );
    for gamma in [0.01, 0.1, 0.8, 1.8, 4.0, 6.0, 8.0, 20.0] {
        let all = [
            beside_plain::<1>("line", gamma),
            beside_plain::<2>("grid2", gamma),
            beside_plain::<2>("scattered2", gamma),
            beside_plain::<3>("grid3", gamma),
            beside_plain::<3>("scattered3", gamma),
        ];
        let N = all.iter().map(|beside| beside.N).fold(0.0, f64::max);
        let grad = all.iter().map(|beside| beside.grad).fold(0.0, f64::max);
        assert!(N < 2e-15 && grad < 1e-13, "γ = {gamma}: {N:e}, {grad:e}");
        let served = all.map(|beside| beside.served);
        assert!(gamma > 1.8 || served == [50; 5], "γ = {gamma}: {served:?}");
        assert!(gamma < 6.0 || served[1..].iter().all(|n| *n < 25), "γ = {gamma}: {served:?}");
        text +=
            &format!("{gamma},{},{N:.1e},{grad:.1e}\n", served.map(|n| n.to_string()).join(","));
    }
    approve("lme__plain_and_robust", &text);
}

/// On the hull λ is infinite. Plain Newton goes there step by step until |r| is small: its
/// weights are right, and its slopes, made with a J that has all but vanished, are lost. The
/// library knows the slopes: those of the linear functions, at an end.
#[test]
fn lme_plain_newton_fails_on_the_hull() {
    let nodes: Vec<_> = (0..=6).map(|I| Vector1::new(f64::from(I))).collect();
    for gamma in [0.1, 0.8, 1.8, 4.0] {
        let (mut residuals, x) = (Vec::new(), nodes[0]);
        let xi: Vec<_> = nodes.iter().map(|x_I| x - x_I).collect();
        let plain = plain::solve(&mut residuals, &xi, gamma).unwrap();
        assert!(residuals.len() > 30, "γ = {gamma}: {residuals:?}");
        let (values, _) = lme_at(&nodes, 1.0, gamma, 0.0, &x).unwrap();
        for (I, N, grad) in values {
            assert_relative_eq!(N, plain.p[I], epsilon = 1e-15);
            assert_relative_eq!(grad[0], [-1.0, 1.0].get(I).copied().unwrap_or(0.0));
        }
        assert!((plain.grad[0][0] + 1.0).abs() > 0.5, "γ = {gamma}: {:?}", plain.grad);
    }
}

/// When a node enters the cut-off radius all N jump. The jump is of the order
/// of the tolerance, and both conditions hold on either side of it, because λ
/// is solved anew.
#[test]
fn lme_jump_at_the_cutoff() {
    let nodes: Vec<SVector<f64, 1>> =
        (-20..=20).map(|I| SVector::<f64, 1>::new(f64::from(I))).collect();
    let mut text = String::from("cut-off,γ = 0.8,γ = 1.8,γ = 4\n");
    for cutoff in [1e-2, 1e-4, 1e-6, 1e-8] {
        text += &format!("{cutoff:e}");
        for gamma in [0.8, 1.8, 4.0] {
            let radius = libm::sqrt(-libm::log(cutoff) / gamma);
            let enter = radius.ceil() - radius; // there the node at ceil(R) enters
            let side = |x: f64| {
                let x = SVector::<f64, 1>::new(x);
                let (values, _) = lme_at(&nodes, 1.0, gamma, cutoff, &x).unwrap();
                let one: f64 = values.iter().map(|v| v.1).sum();
                let place: f64 = values.iter().map(|v| v.1 * nodes[v.0][0]).sum();
                assert!((one - 1.0).abs() < 1e-14 && (place - x[0]).abs() < 1e-14);
                let mut all = vec![0.0; nodes.len()];
                values.iter().for_each(|v| all[v.0] = v.1);
                (values.len(), all)
            };
            let ((few, before), (many, after)) = (side(enter - 1e-10), side(enter + 1e-10));
            assert_eq!(few + 1, many, "γ = {gamma}, {cutoff:e}");
            let jumps = before.iter().zip(&after).map(|(a, b)| (a - b).abs());
            let jump = jumps.fold(0.0, f64::max);
            assert!(0.1 * cutoff < jump && jump < 30.0 * cutoff, "{gamma} {cutoff:e} {jump:e}");
            text += &format!(",{jump:.1e}");
        }
        text += "\n";
    }
    approve("lme__cutoff_jump", &text);
}

/// Two nodes alone: N is linear, so λ follows from ln(N_1/N_0) = β(x² − (x − h)²) − λh.
/// It is in 1/m, whatever the spacing.
#[test]
fn lme_multiplier_of_two_nodes() {
    for h in [0.25, 1.0, 3.0] {
        let (x, gamma) = (0.3 * h, 1.8);
        let nodes = [Vector1::new(0.0), Vector1::new(h)];
        let (values, lambda) = lme_at(&nodes, h, gamma, 0.0, &Vector1::new(x)).unwrap();
        assert_relative_eq!(values[1].1, 0.3, max_relative = 1e-14);
        assert_relative_eq!(values[1].2[0], 1.0 / h, max_relative = 1e-14);
        let beta = gamma / (h * h);
        let expected = (beta * (x * x - (x - h) * (x - h)) - libm::log(0.3 / 0.7)) / h;
        assert_relative_eq!(lambda[0], expected, max_relative = 1e-13);
    }
}

/// A point 1e-100 h from the hull: μ is near −230 and exp(μ)^k leaves the range of
/// numbers, so that weights cannot be made by multiplication there. Closer than 1e-150 h
/// is on it.
#[test]
fn lme_at_the_edge_of_the_numbers() {
    let grid = Grid::over([8.0], [8], [[0, 0]]);
    for x in [1e-60, 1e-100, 1e-150, 1e-151, 1e-200, 5e-324] {
        let basis = Basis::Lme { gamma: 0.8, cutoff: 1e-6, support: Support::Ball };
        let table = on_grid(&basis, &grid, &[Vector1::new(x)]).unwrap();
        let values: Vec<f64> = table.shape.of(0).map(|(_, N, _)| N).collect();
        assert_relative_eq!(values[0], 1.0, max_relative = 1e-15);
        let inner = if x < 1e-150 { 0.0 } else { x };
        assert_relative_eq!(values[1], inner, epsilon = 0.0, max_relative = 1e-12);
        assert!(values[2..].iter().all(|N| (0.0..1e-100).contains(N)), "{values:?}");
    }
}

/// Exponentials are counted as they are evaluated. On a grid: seven for the table
/// exp(−γk²), once, and one for each axis and evaluation; where that would leave the
/// range of numbers, one for each node and evaluation.
#[test]
fn lme_counts_its_exponentials() {
    fn counts<const D: usize>(gamma: f64, points: &[[f64; D]]) -> (u64, u64) {
        let grid = Grid::over([4.0; D], [4; D], [[0, 0]; D]);
        let points: Vec<_> = points.iter().map(|x| SVector::from(*x)).collect();
        let basis = Basis::Lme { gamma, cutoff: 0.0, support: Support::Ball };
        let Tabulated { shape, cost, .. } = on_grid(&basis, &grid, &points).unwrap();
        assert_eq!(shape.len(), points.len() * 5usize.pow(D as u32), "every node is seen");
        (cost.exponentials, cost.newton_iterations)
    }
    let (exponentials, iterations) = counts(0.8, &[[1.3], [2.6]]);
    assert!(iterations > 1);
    assert_eq!(exponentials, 7 + iterations);
    let (exponentials, iterations) = counts(50.0, &[[1.3], [2.6]]);
    assert!(iterations > 1);
    // Starts that are not near enough are evaluated without being iterations.
    assert!(exponentials % 5 == 0 && exponentials >= 5 * iterations, "{exponentials}");
    // On a node among many nothing is different; where their weights are too small for a
    // number beside its own, one weighs them against it.
    let (exponentials, iterations) = counts(0.8, &[[2.0]]);
    assert_eq!(exponentials, 7 + iterations);
    // On a side the slopes take one for each node of the next layer.
    let (exponentials, iterations) = counts(0.8, &[[1.3, 0.0]]);
    assert!(iterations > 1);
    assert_eq!(exponentials, 7 + 2 * iterations + 5);
    // In a corner nothing is solved; each of its two sides has one such node.
    assert_eq!(counts(0.8, &[[0.0, 4.0]]), (2, 0));
}

/// A search that starts at no number, or far off, finds what one from λ = 0 finds.
#[test]
fn lme_starts_anywhere() {
    let grid = Grid::over([4.0; 2], [4; 2], [[0, 0]; 2]);
    let nodes: Vec<_> = (0..grid.nodes()).map(|I| grid.position(I)).collect();
    let (h, x) = (Vector2::repeat(1.0), [Vector2::new(1.3, 2.6)]);
    let basis = Basis::Lme { gamma: 0.8, cutoff: 1e-6, support: Support::Ball };
    let expected = on_nodes(&basis, &h, &nodes, &x).0;
    for start in [f64::NAN, f64::INFINITY, 1e300, -1e3] {
        let (mut shape, mut scratch) = (Shape::blank(0), Scratch::default());
        let places = Places { x: &nodes, h: &h };
        let mut known = [Multiplier { lambda: Vector2::repeat(start), ..Multiplier::default() }];
        fill_from_nodes(&mut shape, &mut scratch, &mut known, &basis, places, &x).unwrap();
        assert_relative_eq!(known[0].lambda, expected.lambda[0], max_relative = 1e-13);
        for ((I, N, grad), (J, M, slope)) in shape.of(0).zip(expected.shape.of(0)) {
            assert_eq!(I, J);
            assert_relative_eq!(N, M, epsilon = 1e-15);
            assert_relative_eq!(grad, slope, epsilon = 1e-14);
        }
    }
}

/// One node alone spans nothing: no point is in its hull, not even its own place, where
/// N would be 1 and ∇N undefined.
#[test]
fn lme_of_one_node_is_refused() {
    for x in [0.0, 0.3] {
        let nodes = [Vector1::new(0.0)];
        let refused = lme_at(&nodes, 1.0, 1.8, 0.0, &Vector1::new(x)).unwrap_err();
        assert!(matches!(refused, Failure::OutsideHull), "{refused:?}");
    }
}

/// Inside the box of a triangle, and outside the triangle: named so. Inside, on and in the
/// slanted side the functions are the linear ones.
#[test]
fn lme_beside_a_triangle() {
    let nodes = [Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.0), Vector2::new(0.0, 1.0)];
    for gamma in [0.8, 4.0, 20.0] {
        for s in [0.5 + 1e-9, 0.6, 0.9, 1.0] {
            let outside = lme_at(&nodes, 1.0, gamma, 0.0, &Vector2::new(s, s));
            assert_eq!(outside.unwrap_err(), Failure::OutsideHull, "γ = {gamma}, {s}");
        }
        for d in [1e-7, 1e-10, 1e-13, 1e-16, 0.0] {
            let x = Vector2::new(0.5 - d, 0.5 - d);
            let (values, _) = lme_at(&nodes, 1.0, gamma, 0.0, &x).unwrap();
            for ((_, N, _), expected) in values.iter().zip([1.0 - x[0] - x[1], x[0], x[1]]) {
                assert!((N - expected).abs() < 1e-14, "γ = {gamma}, {d:e}: {N}");
            }
            for ((_, _, grad), expected) in
                values.iter().zip([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
            {
                assert_relative_eq!(*grad, Vector2::from(expected), epsilon = 1e-12);
            }
        }
    }
}

/// In a corner of its nodes' box, from which both sides of the hull run slanted, no face of the
/// box has a layer of nodes behind it. The limit is the linear functions of the corner and the
/// nodes next to it; the fourth node comes in with the cube root of the distance, here 1e-15 h.
#[test]
fn lme_in_a_pointed_corner() {
    let nodes = [[0.0, 0.0], [1.0, 0.5], [0.5, 1.0], [1.0, 1.0]].map(|[x, y]| Vector2::new(x, y));
    let (values, _) = lme_at(&nodes, 1.0, 1.8, 0.0, &nodes[0]).unwrap();
    let slopes = [[-2.0, -2.0], [4.0, -2.0], [-2.0, 4.0], [0.0, 0.0]];
    for ((I, N, grad), slope) in values.into_iter().zip(slopes) {
        assert_relative_eq!(N, if I == 0 { 1.0 } else { 0.0 }, epsilon = 1e-14);
        assert_relative_eq!(grad, Vector2::from(slope) / 3.0, epsilon = 1e-5);
    }
}

/// Points on a side of nodes in no order, whose next layer does not stand opposite to
/// them: Σ ∇N = 0, Σ ξ ⊗ ∇N = 1, and ∇N is the limit of the differences from inside.
#[test]
fn lme_on_a_side_without_symmetry() {
    let nodes =
        [[0.0, 0.0], [0.0, 1.0], [0.0, 2.2], [0.7, 0.3], [0.7, 1.9], [1.6, 0.9], [1.5, 2.0]]
            .map(|[x, y]| Vector2::new(x, y));
    for gamma in [0.8, 1.8] {
        for y in [0.35, 0.8, 1.0, 1.7] {
            let x = Vector2::new(0.0, y);
            let at = |x: Vector2<f64>| lme_at(&nodes, 1.0, gamma, 0.0, &x).unwrap().0;
            let here = at(x);
            let (mut slope, mut moment) = (Vector2::zeros(), Matrix2::zeros());
            for (I, _, grad) in &here {
                slope += grad;
                moment += (nodes[*I] - x) * grad.transpose();
            }
            assert_relative_eq!(slope, Vector2::zeros(), epsilon = 1e-13);
            assert_relative_eq!(moment, Matrix2::identity(), epsilon = 1e-13);
            let step = 1e-6;
            let inside = at(x + Vector2::new(step, 0.0));
            for (a, b) in here.iter().zip(&inside) {
                assert!((a.2[0] - (b.1 - a.1) / step).abs() < 1e-4, "γ = {gamma}, {y}: {a:?}");
            }
        }
    }
}
