//! One checklist for every basis in 1D, 2D and 3D:
//!
//! (a) ΣN = 1, (b) ΣN x = x, (c) Σ∇N = 0, (d) Σ x ⊗ ∇N = 1, (e) N ≥ 0,
//! (f) ∇N is the slope of N, (g) mirror images agree, (h) other units give the
//! same bits. And what a basis does at ends, on nodes, and at extremes.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::lme::Failure;
use lme_mpm::method::basis::scattered::NodeValues;
use lme_mpm::method::basis::scattered::values_at as lme_at;
use lme_mpm::method::basis::{Basis, Degree, Support};
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::grid::Grid;
use lme_mpm::output::figure::{self, Axes};
use nalgebra::{SMatrix, SVector, Vector1, Vector2, Vector3};
use proptest::prelude::*;
use test_case::test_case;

const BSPLINE: Basis = Basis::BSpline(Degree::Quadratic);
const CUBIC: Basis = Basis::BSpline(Degree::Cubic);
const UGIMP: Basis = Basis::Ugimp { half_length: [0.25, 0.5, 0.125] };

/// Domains that have grown longer than a cell.
const WIDE_GIMP: Basis = Basis::Ugimp { half_length: [0.75, 1.0, 0.6] };

const fn lme(gamma: f64) -> Basis {
    Basis::Lme { gamma, cutoff: 1e-6, support: Support::Ball }
}

const LENGTH: [f64; 3] = [0.7, 1.3, 0.4];
const CELLS: [usize; 3] = [5, 4, 3];
const BEYOND: [[usize; 2]; 3] = [[1, 2], [1, 1], [2, 1]];

/// A grid with different spacings, and cells before and after the body.
fn grid<const D: usize>() -> Grid<D> {
    Grid::over(
        std::array::from_fn(|d| LENGTH[d]),
        std::array::from_fn(|d| CELLS[d]),
        std::array::from_fn(|d| BEYOND[d]),
    )
}

/// A point from three numbers in [0, 1]: of the whole grid, but with GIMP of
/// the part that is half a cell, or a whole one, from its ends.
fn point<const D: usize>(basis: &Basis, s: [f64; 3]) -> SVector<f64, D> {
    let grid = grid::<D>();
    let margin = match basis {
        Basis::Ugimp { .. } if *basis == WIDE_GIMP => 1.0,
        Basis::Ugimp { .. } => 0.5,
        _ => 0.0,
    };
    SVector::from_fn(|d, _| {
        let low = (margin - grid.before[d] as f64) * grid.h[d];
        let high = grid.upper[d] - margin * grid.h[d];
        low + s[d] * (high - low)
    })
}

fn row<const D: usize>(basis: &Basis, grid: &Grid<D>, x: SVector<f64, D>) -> NodeValues<D> {
    on_grid(basis, grid, &[x]).unwrap_or_else(|fault| panic!("{basis:?} at {x:?}: {fault}")).row()
}

/// (a) to (e).
fn check_sums<const D: usize>(basis: &Basis, s: [f64; 3]) {
    let (grid, x) = (grid::<D>(), point::<D>(basis, s));
    let (mut one, mut place) = (0.0, SVector::<f64, D>::zeros());
    let (mut slope, mut moment) = (SVector::<f64, D>::zeros(), SMatrix::<f64, D, D>::zeros());
    let values = row(basis, &grid, x);
    // n − 1 additions here and as many in Z, each good to half an ε.
    let round_off = (values.len() as f64 + 3.0) * f64::EPSILON;
    for (I, N, grad_N) in values {
        assert!(N >= 0.0, "(e) N = {N:e} at {x:?}");
        let from_x = grid.position(I) - x;
        one += N;
        place += from_x * N;
        slope += grad_N;
        moment += from_x * grad_N.transpose();
    }
    assert_relative_eq!(one, 1.0, epsilon = round_off);
    assert_relative_eq!(place, SVector::zeros(), epsilon = 2e-15);
    assert_relative_eq!(slope, SVector::zeros(), epsilon = 2e-13);
    assert_relative_eq!(moment, SMatrix::identity(), epsilon = 1e-13);
}

/// (f) by central differences with the error of fourth order, on a stencil
/// within which the set of nodes and, for piecewise bases, the piece stays the
/// same: a point well inside the first quarter of a cell.
fn check_slope<const D: usize>(basis: &Basis, s: [f64; 3]) {
    let grid = grid::<D>();
    let inside = |d: usize| grid.before[d] as f64 * 0.0 + 1.0 + 0.3 + 0.06 * s[d];
    let x = SVector::<f64, D>::from_fn(|d, _| inside(d) * grid.h[d]);
    let all = match basis {
        Basis::Lme { gamma, .. } => {
            Basis::Lme { gamma: *gamma, cutoff: 0.0, support: Support::Ball }
        }
        other => *other,
    };
    let here = row(&all, &grid, x);
    for d in 0..D {
        let step = 2e-3 * grid.h[d];
        let at = |k: f64| {
            let mut there = x;
            there[d] += k * step;
            row(&all, &grid, there)
        };
        let (p1, m1, p2, m2) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
        for k in 0..here.len() {
            assert_eq!(p2[k].0, here[k].0);
            let first = (p1[k].1 - m1[k].1) * 8.0 - (p2[k].1 - m2[k].1);
            let difference = first / (12.0 * step);
            let error = grid.h[d] * (here[k].2[d] - difference).abs();
            assert!(error < 1e-9, "(f) {basis:?}, {D}D: {error:e}");
        }
    }
}

/// (g): the point mirrored in the middle of a grid without cells beyond sees
/// the mirrored nodes with the same N and opposite slopes.
fn check_mirror(basis: &Basis, s: f64) {
    let grid = Grid::<1>::over([1.0], [8], [[1, 1]]);
    let x = 0.02 + 0.96 * s;
    let (here, mut there) =
        (row(basis, &grid, Vector1::new(x)), row(basis, &grid, Vector1::new(1.0 - x)));
    there.reverse();
    let near = |N: f64| N > 1e-5; // at the edge of the support rounding may drop a node
    let here: Vec<_> = here.into_iter().filter(|v| near(v.1)).collect();
    let there: Vec<_> = there.into_iter().filter(|v| near(v.1)).collect();
    for (a, b) in here.iter().zip(&there) {
        assert_eq!(a.0, 10 - b.0, "(g) {basis:?} at {x}");
        assert_relative_eq!(a.1, b.1, epsilon = 1e-12);
        assert_relative_eq!(a.2[0], -b.2[0], epsilon = 1e-10);
    }
}

/// (h): all lengths times 2^k gives the same N and 2^−k ∇N, bit by bit.
fn check_units<const D: usize>(basis: &Basis, s: [f64; 3]) {
    let (grid, x) = (grid::<D>(), point::<D>(basis, s));
    for k in [-300.0, -1.0, 7.0, 300.0] {
        let unit = libm::exp2(k);
        let scaled = Grid::new(grid.h * unit, grid.cells, grid.before, grid.upper * unit);
        let (here, there) = (row(basis, &grid, x), row(basis, &scaled, x * unit));
        assert_eq!(here.len(), there.len());
        for (a, b) in here.iter().zip(&there) {
            assert_eq!((a.0, a.1, a.2), (b.0, b.1, b.2 * unit), "(h) {basis:?}, 2^{k}");
        }
    }
}

fn check<const D: usize>(basis: &Basis, s: [f64; 3]) {
    check_sums::<D>(basis, s);
    check_slope::<D>(basis, s);
    check_units::<D>(basis, s);
}

proptest! {
    #![proptest_config(same_every_time(60))]
    #[test]
    fn basis_checklist(s in [0.0..=1.0_f64, 0.0..=1.0, 0.0..=1.0], g in 0..4_usize) {
        let gamma = [0.8, 1.8, 4.0, 20.0][g];
        for basis in [Basis::Linear, UGIMP, WIDE_GIMP, BSPLINE, CUBIC, lme(gamma)] {
            check_mirror(&basis, s[0]);
            check::<1>(&basis, s);
            check::<2>(&basis, s);
        }
        for basis in [Basis::Linear, UGIMP, WIDE_GIMP, BSPLINE, CUBIC] {
            check::<3>(&basis, s);
        }
        check_sums::<3>(&lme(gamma), s);
    }

    /// (a) to (e) of local max-ent for γ over twelve decades.
    #[test]
    fn lme_checklist_at_any_gamma(s in [0.0..=1.0_f64, 0.0..=1.0, 0.0..=1.0], exponent in -6.0..=6.0_f64) {
        let basis = lme(libm::exp10(exponent));
        check_sums::<1>(&basis, s);
        check_sums::<2>(&basis, s);
    }
}

/// (f) in 3D costs 13 tables of 216 nodes: once is enough.
#[test]
fn lme_slope_in_3d() {
    check_slope::<3>(&lme(1.8), [0.3, 0.9, 0.5]);
    check_units::<3>(&lme(1.8), [0.31, 0.92, 0.55]);
}

/// Within half a cell of an end of the grid the B-spline is the linear basis,
/// and its end node interpolates.
#[test]
fn bspline_at_the_ends() {
    let grid = Grid::<1>::over([1.0], [4], [[0, 0]]);
    for x in [0.0, 0.05, 0.12, 0.88, 0.95, 1.0] {
        let linear = row(&Basis::Linear, &grid, Vector1::new(x));
        assert_eq!(row(&BSPLINE, &grid, Vector1::new(x)), linear);
    }
    // There N and its slope are continuous.
    let (before, after) = (0.125 - 1e-13, 0.125 + 1e-13);
    let side = |x| row(&BSPLINE, &grid, Vector1::new(x));
    for (a, b) in side(before).iter().zip(&side(after)) {
        assert_relative_eq!(a.1, b.1, epsilon = 1e-11);
        assert_relative_eq!(a.2[0], b.2[0], epsilon = 1e-10);
    }
}

/// Away from the ends a sum of B-splines is any polynomial of their degree: x² from
/// x_I² − h²/4 (quadratic) or x_I² − h²/3 (cubic), x³ from x_I³ − h² x_I (cubic), to 1e-13.
#[test]
fn bsplines_are_polynomials() {
    let grid = Grid::<1>::over([2.0], [8], [[0, 0]]);
    let h = 0.25;
    let square = |part: f64| move |x: f64| x * x - h * h * part;
    let cube = |x: f64| x * x * x - h * h * x;
    for n in 0..50 {
        let x = 0.5 + n as f64 * 0.02;
        let sum = |basis: &Basis, of: &dyn Fn(f64) -> f64| -> (f64, f64) {
            let row = row(basis, &grid, Vector1::new(x));
            row.iter().fold((0.0, 0.0), |(sum, slope), (I, N, grad)| {
                let q = of(grid.position(*I)[0]);
                (sum + N * q, slope + grad[0] * q)
            })
        };
        for (found, value, slope) in [
            (sum(&BSPLINE, &square(0.25)), x * x, 2.0 * x),
            (sum(&CUBIC, &square(1.0 / 3.0)), x * x, 2.0 * x),
            (sum(&CUBIC, &cube), x * x * x, 3.0 * x * x),
        ] {
            assert_relative_eq!(found.0, value, epsilon = 1e-13);
            assert_relative_eq!(found.1, slope, epsilon = 1e-12);
        }
    }
}

/// At an end of the grid the cubic end node interpolates, and the second derivative of every
/// function is 0; the neighbours' is not, half a cell inside. A grid of one cell has linear functions.
#[test]
fn bspline_cubic_at_the_ends() {
    let grid = Grid::<1>::over([1.0], [4], [[0, 0]]);
    for (end, inward) in [(0.0, 1.0), (1.0, -1.0)] {
        let slopes = |depth: f64| {
            let row = row(&CUBIC, &grid, Vector1::new(end + inward * depth));
            (0..5)
                .map(|I| row.iter().find(|v| v.0 == I).map_or(0.0, |v| v.2[0]))
                .collect::<Vec<_>>()
        };
        let at = row(&CUBIC, &grid, Vector1::new(end));
        let own = if end == 0.0 { 0 } else { 4 };
        for (I, N, _) in at {
            assert_relative_eq!(N, if I == own { 1.0 } else { 0.0 }, epsilon = 1e-15);
        }
        let (first, near, far) = (slopes(0.0), slopes(1e-4), slopes(0.125));
        for I in 0..5 {
            // The slope grows with the square of the depth.
            assert!((near[I] - first[I]).abs() < 1e-5, "{I}: {first:?} {near:?}");
        }
        assert!((0..5).any(|I| (far[I] - first[I]).abs() > 0.1), "{first:?} {far:?}");
    }
    let one = Grid::<1>::over([1.0], [1], [[0, 0]]);
    for x in [0.0, 0.3, 0.9] {
        let (cubic, linear) =
            (row(&CUBIC, &one, Vector1::new(x)), row(&Basis::Linear, &one, Vector1::new(x)));
        for (a, b) in cubic.iter().zip(&linear) {
            assert_relative_eq!(a.1, b.1, epsilon = 1e-15);
            assert_relative_eq!(a.2[0], b.2[0], epsilon = 1e-14);
        }
    }
}

/// uGIMP needs a node beyond the body for each particle that reaches beyond.
#[test]
fn ugimp_reaches_beyond_the_body() {
    let x = [Vector1::new(0.05)];
    let table = |beyond| {
        let grid = Grid::<1>::over([1.0], [4], [[beyond, 0]]);
        on_grid(&UGIMP, &grid, &x).map(|table| table.row().iter().map(|value| value.1).sum::<f64>())
    };
    assert_eq!(table(0), Err(Breakdown::ReachesBeyond { particle: 0, position: vec![0.05] }));
    assert_relative_eq!(table(1).unwrap(), 1.0, epsilon = 1e-15);
}

/// On a node and one ulp to either side: N = 1 there up to rounding, for bases
/// that interpolate.
#[test_case(Basis::Linear)]
#[test_case(lme(1000.0))]
fn basis_on_nodes(basis: Basis) {
    let grid = grid::<1>();
    for I in 0..grid.nodes() {
        let node = grid.position(I)[0];
        for x in [node, node.next_up(), node.next_down()] {
            if grid.locate(&Vector1::new(x)).is_none() {
                assert!(I == 0 || I == grid.nodes() - 1, "only beyond the ends");
                continue;
            }
            for (J, N, _) in row(&basis, &grid, Vector1::new(x)) {
                assert_relative_eq!(N, if I == J { 1.0 } else { 0.0 }, epsilon = 2e-15);
            }
        }
    }
}

/// The upper corner of a grid that ends with the body, to the last bit.
#[test]
fn grid_holds_the_last_point_of_the_body() {
    for cells in 1..200 {
        let grid = Grid::<1>::over([0.1333], [cells], [[0, 0]]);
        let at = grid.locate(&Vector1::new(0.1333)).unwrap();
        assert_eq!(at.cell[0], cells - 1);
        assert_relative_eq!(at.xi[0], 1.0, epsilon = 1e-13);
    }
}

/// One function of each basis, for the book.
#[test]
fn basis_figure() {
    let grid = Grid::<1>::over([8.0], [8], [[0, 0]]);
    let bases = [
        ("linear", Basis::Linear),
        ("uGIMP, l = ¼", UGIMP),
        ("quadratic B-spline", BSPLINE),
        ("cubic B-spline", CUBIC),
        ("local max-ent, γ = 0.8", lme(0.8)),
        ("local max-ent, γ = 4", lme(4.0)),
    ];
    let curve = |basis: &Basis| {
        let value = |n: i32| {
            let xi = f64::from(n) / 40.0;
            let row = row(basis, &grid, Vector1::new(4.0 + xi));
            (xi, row.iter().find(|v| v.0 == 4).map_or(0.0, |v| v.1))
        };
        (-120..=120).map(value).collect()
    };
    let lists: Vec<_> = bases.iter().map(|(name, b)| (name.to_string(), curve(b))).collect();
    let svg = figure::curves(
        &lists,
        &Axes::new("One function of each basis", "distance from the node / h [–]", "N [–]", false),
    );
    approve_picture("basis__shapes", svg);
}

/// Outside the grid, and for NaN, there is no row but a named particle.
#[test_case(Basis::Linear)]
#[test_case(UGIMP)]
#[test_case(BSPLINE)]
#[test_case(CUBIC)]
#[test_case(lme(1.8))]
fn basis_names_the_particle_outside(basis: Basis) {
    let inside = Vector2::new(0.1, 0.1);
    for outside in [Vector2::new(-0.2, 0.1), Vector2::new(0.1, 1.7), Vector2::new(f64::NAN, 0.1)] {
        let refused = on_grid(&basis, &grid::<2>(), &[inside, outside]).map(|table| table.row());
        let expected = match outside[0].is_nan() {
            true => Breakdown::NotFinite { particle: 1, symbol: "position" },
            false => Breakdown::LeftGrid { particle: 1, position: outside.as_slice().to_vec() },
        };
        assert_eq!(refused, Err(expected));
    }
}

// ---- local max-ent: limits and extremes ------------------------------------------

/// For γ → ∞ local max-ent is the linear basis.
#[test]
fn lme_becomes_linear() {
    let (grid, x) = (grid::<2>(), Vector2::new(0.23, 0.71));
    let mut last = f64::INFINITY;
    for gamma in [4.0, 8.0, 16.0, 32.0] {
        let linear = row(&Basis::Linear, &grid, x);
        let lme = row(&Basis::Lme { gamma, cutoff: 0.0, support: Support::Ball }, &grid, x);
        let value = |row: &NodeValues<2>, I| row.iter().find(|v| v.0 == I).map_or(0.0, |v| v.1);
        let error = (0..grid.nodes())
            .map(|I| (value(&lme, I) - value(&linear, I)).abs())
            .fold(0.0, f64::max);
        assert!(error < 0.05 * last, "γ = {gamma}: {error:e} after {last:e}");
        last = error;
    }
    assert!(last < 1e-9, "{last:e}");
}

/// On d + 1 nodes the constraints alone fix N: the linear functions of the
/// simplex, whatever γ.
#[test]
fn lme_on_a_simplex() {
    let nodes = [Vector2::new(0.0, 0.0), Vector2::new(1.0, 0.2), Vector2::new(0.3, 0.9)];
    let barycentric = [0.2, 0.5, 0.3];
    let x: Vector2<f64> = nodes.iter().zip(barycentric).map(|(x_I, N)| x_I * N).sum();
    for gamma in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        let (values, _) = lme_at(&nodes, 1.0, gamma, 0.0, &x).unwrap();
        for (I, N, _) in &values {
            assert_relative_eq!(*N, barycentric[*I], epsilon = 1e-14);
        }
        let moment: SMatrix<f64, 2, 2> =
            values.iter().map(|(I, _, grad)| nodes[*I] * grad.transpose()).sum();
        assert_relative_eq!(moment, SMatrix::identity(), epsilon = 1e-13);
    }
}

/// On a full grid of nodes the functions of 2D are products of those of 1D.
#[test]
fn lme_is_a_product_on_a_full_grid() {
    let grid = grid::<2>();
    let line = |d: usize| {
        let [h, upper] = [grid.h[d], grid.upper[d]].map(Vector1::new);
        Grid::new(h, [grid.cells[d]], [grid.before[d]], upper)
    };
    let x = Vector2::new(0.33, 0.77);
    let basis = Basis::Lme { gamma: 1.3, cutoff: 0.0, support: Support::Ball };
    let along: Vec<NodeValues<1>> =
        (0..2).map(|d| row(&basis, &line(d), Vector1::new(x[d]))).collect();
    for (I, N, grad) in row(&basis, &grid, x) {
        let [i, j] = grid.index(I);
        let (a, b) = (along[0][i], along[1][j]);
        assert_relative_eq!(N, a.1 * b.1, epsilon = 1e-15);
        assert_relative_eq!(grad[0], a.2[0] * b.1, epsilon = 1e-13);
        assert_relative_eq!(grad[1], a.1 * b.2[0], epsilon = 1e-13);
    }
}

/// Collinear nodes in the plane, a point outside, a single node, no node in
/// reach, NaN: an error, never NaN, never a hang.
#[test]
fn lme_refuses_by_name() {
    let square = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| Vector2::new(x, y));
    let line = [0.0, 1.0, 2.0].map(|t| Vector2::new(t, t));
    let outside = [Vector2::new(1.5, 0.5), Vector2::new(-1e-9, 0.5)];
    for x in [Vector2::new(f64::NAN, 0.5), Vector2::new(0.5, f64::INFINITY)] {
        assert_eq!(lme_at(&square, 1.0, 1.0, 0.0, &x), Err(Failure::NotFinite));
    }
    for gamma in [1e-6, 1.0, 1e6] {
        for x in outside {
            assert_eq!(lme_at(&square, 1.0, gamma, 0.0, &x), Err(Failure::OutsideHull));
        }
        let on_line = lme_at(&line, 1.0, gamma, 0.0, &Vector2::new(0.7, 0.7));
        assert!(on_line.is_err(), "{on_line:?}");
        let single = lme_at(&square[..1], 1.0, gamma, 0.0, &square[0]);
        assert_eq!(single, Err(Failure::OutsideHull));
    }
    // Outside a slanted side, within the box of the nodes.
    let triangle = [square[0], square[1], square[2]];
    for gamma in [0.1, 1.0, 100.0, 1e5] {
        let beyond = lme_at(&triangle, 1.0, gamma, 0.0, &Vector2::new(0.6, 0.6));
        assert!(beyond.is_err(), "{beyond:?}");
    }
    assert_eq!(lme_at(&square, 1.0, 1e6, 0.5, &Vector2::new(0.5, 0.5)), Err(Failure::OutsideHull));
}

/// A node that is no number is no node to stand on: refused, not spread.
#[test]
fn lme_refuses_nodes_that_are_no_numbers() {
    for bad in [f64::NAN, f64::INFINITY] {
        let nodes = [0.0, 1.0, bad, 2.0].map(Vector1::new);
        for cutoff in [0.0, 1e-6] {
            let found = lme_at(&nodes, 1.0, 1.0, cutoff, &Vector1::new(0.5));
            assert_eq!(found, Err(Failure::NotFinite), "{bad}");
        }
    }
}

/// The order of the nodes does not matter, nor where the origin is: moved by a
/// power of two that all coordinates can hold, the values stay to the last bit.
#[test]
fn lme_permutation_and_translation() {
    let place = |I: i32| Vector2::new(f64::from(I % 5), f64::from(I / 5) + f64::from(I % 3) / 8.0);
    let nodes: Vec<_> = (0..25).map(place).collect();
    let x = Vector2::new(1.375, 2.21875);
    let (values, _) = lme_at(&nodes, 1.0, 1.1, 1e-6, &x).unwrap();
    let reversed: Vec<_> = nodes.iter().rev().copied().collect();
    let (other, _) = lme_at(&reversed, 1.0, 1.1, 1e-6, &x).unwrap();
    assert_eq!(values.len(), other.len());
    for (a, b) in values.iter().zip(other.iter().rev()) {
        assert_eq!(a.0, 24 - b.0);
        assert_relative_eq!(a.1, b.1, epsilon = 1e-15);
        assert_relative_eq!(a.2, b.2, epsilon = 1e-14);
    }
    let far = Vector2::new(libm::exp2(40.0), -libm::exp2(33.0));
    let moved: Vec<_> = nodes.iter().map(|x_I| x_I + far).collect();
    assert_eq!(lme_at(&moved, 1.0, 1.1, 1e-6, &(x + far)).unwrap().0, values);
}

/// Two nodes at one place share what one of them would get.
#[test]
fn lme_with_a_doubled_node() {
    let nodes: Vec<Vector1<f64>> = [0.0, 1.0, 2.0, 3.0, 1.0].map(Vector1::new).to_vec();
    let (values, _) = lme_at(&nodes, 1.0, 1.8, 0.0, &Vector1::new(1.3)).unwrap();
    assert_eq!(values[1].1, values[4].1);
    assert_relative_eq!(values.iter().map(|v| v.1).sum::<f64>(), 1.0, epsilon = 1e-15);
    let place: f64 = values.iter().map(|v| v.1 * nodes[v.0][0]).sum();
    assert_relative_eq!(place, 1.3, epsilon = 1e-15);
}

/// One node in each direction of the hull, seen from within.
#[test]
fn lme_with_one_node_in_each_direction() {
    let nodes = [
        Vector3::new(-1.0, 0.0, 0.0),
        Vector3::new(1.0, 0.0, 0.0),
        Vector3::new(0.0, -1.0, 0.0),
        Vector3::new(0.0, 1.0, 0.0),
        Vector3::new(0.0, 0.0, -1.0),
        Vector3::new(0.0, 0.0, 1.0),
    ];
    for gamma in [1e-3, 1.0, 1e3] {
        let (values, _) = lme_at(&nodes, 1.0, gamma, 0.0, &Vector3::zeros()).unwrap();
        for (I, N, grad) in values {
            assert_relative_eq!(N, 1.0 / 6.0, epsilon = 1e-15);
            assert_relative_eq!(grad, nodes[I] * 0.5, epsilon = 1e-14);
        }
    }
}

/// Points of a grid for γ over six decades, two in three crowded at its sides,
/// 1 to 1e-16 of the length away: every one is served, with ΣN = 1 and
/// ΣN x = x. Returns the Newton iterations per point.
fn serve_random_points<const D: usize>(tables: usize, points: usize, cells: usize) -> f64 {
    let mut state = 88172645463325252_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let grid = Grid::<D>::over([1.0; D], [cells; D], [[0, 0]; D]);
    let (mut evaluations, mut iterations) = (0, 0);
    for _ in 0..tables {
        let gamma = libm::exp10(-3.0 + 6.0 * random());
        let basis = Basis::Lme { gamma, cutoff: 1e-6, support: Support::Ball };
        let mut coordinate = || {
            let near = libm::exp10(-16.0 * random()) * 0.5;
            [random(), near, 1.0 - near][(3.0 * random()) as usize]
        };
        let x: Vec<SVector<f64, D>> =
            (0..points).map(|_| SVector::from_fn(|_, _| coordinate())).collect();
        let Tabulated { shape, cost, .. } = on_grid(&basis, &grid, &x)
            .unwrap_or_else(|fault| panic!("γ = {gamma}: {fault}, {x:?}"));
        evaluations += cost.basis_evaluations;
        iterations += cost.newton_iterations;
        for (p, x_p) in x.iter().enumerate() {
            let (mut one, mut place) = (-1.0, -x_p);
            for (I, N, _) in shape.of(p) {
                one += N;
                place += grid.position(I) * N;
            }
            assert!(one.abs() < 1e-14 && place.amax() < 1e-14, "γ = {gamma}: {one:e}, {place:?}");
        }
    }
    assert_eq!(evaluations, (tables * points) as u64);
    iterations as f64 / evaluations as f64
}

/// A million points of a line, and some more in 2D and 3D.
#[test]
fn lme_serves_random_points() {
    let iterations = [
        serve_random_points::<1>(10_000, 100, 12),
        serve_random_points::<2>(1000, 30, 6),
        serve_random_points::<3>(200, 10, 4),
    ];
    assert!(iterations.iter().all(|n| *n < 8.0), "{iterations:?} iterations per point");
}
