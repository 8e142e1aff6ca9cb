//! Points on and near sides, edges and corners of hulls that lie in no axis: right, or refused
//! by name.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::lme::Failure;
use lme_mpm::method::basis::scattered::{NodeValues, values_at as lme_at};
use lme_mpm::method::basis::{Basis, Support};
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::grid::Grid;
use nalgebra::{Rotation2, SMatrix, SVector, Vector2};

/// Numbers in [0, 1) with a fixed seed (splitmix64).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e3779b97f4a7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58476d1ce4e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d049bb133111eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[(self.roll() * from.len() as f64) as usize]
    }

    fn vector<const D: usize>(&mut self) -> SVector<f64, D> {
        SVector::from_fn(|_, _| self.roll() - 0.5)
    }
}

/// A body whose sides are simplices that lie in no axis.
struct Outline<const D: usize> {
    bump: f64,
    nodes: Vec<SVector<f64, D>>,
    sides: Vec<[SVector<f64, D>; D]>,
}

/// A double pyramid with skew axes of uneven halves: 4 sides in 2D, 8 in 3D, on each of which
/// stand many nodes, n to an edge with a spacing of about 1. Nodes on sides are out of their
/// plane by up to `bump`, those inside by up to a sixth of the spacing.
fn outline<const D: usize>(dice: &mut Dice, n: i32, bump: f64) -> Outline<D> {
    let from = dice.pick(&[0.0, 40.0]);
    let axes = SMatrix::<f64, D, D>::identity() + SMatrix::from_fn(|_, _| dice.roll() - 0.5);
    let half: [[f64; 2]; D] = std::array::from_fn(|_| [0.7 + dice.roll(), 0.7 + dice.roll()]);
    let place = |k: &SVector<f64, D>| {
        let scaled = SVector::<f64, D>::from_fn(|d, _| k[d] * half[d][usize::from(k[d] < 0.0)]);
        SVector::repeat(from) + axes * scaled
    };
    let lattice = (0..(2 * n + 1).pow(D as u32)).map(|number| {
        SVector::<f64, D>::from_fn(|d, _| {
            f64::from(number / (2 * n + 1).pow(d as u32) % (2 * n + 1) - n)
        })
    });
    let mut nodes = Vec::new();
    for k in lattice {
        let size = k.abs().sum();
        if size <= f64::from(n) {
            let off = if size == f64::from(n) { bump } else { 0.3 };
            nodes.push(place(&k) + dice.vector() * off);
        }
    }
    let corner = |side: usize, d: usize| {
        let sign = if side >> d & 1 == 0 { 1.0 } else { -1.0 };
        place(&SVector::from_fn(|e, _| if e == d { sign * f64::from(n) } else { 0.0 }))
    };
    let sides = (0..1 << D).map(|side| std::array::from_fn(|d| corner(side, d))).collect();
    Outline { bump, nodes, sides }
}

/// Distances from the hull in units of the way to some node.
const DISTANCES: [f64; 16] = [
    0.0, 0.0, 1e-17, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4,
    1e-2,
];

/// A point on a side, an edge or in a corner, or so far inside.
fn point<const D: usize>(dice: &mut Dice, outline: &Outline<D>, distance: f64) -> SVector<f64, D> {
    let side = outline.sides[(dice.roll() * outline.sides.len() as f64) as usize];
    let first = (dice.roll() * D as f64) as usize;
    let corners = 1 + (dice.roll() * D as f64) as usize;
    let share: Vec<f64> = (0..corners).map(|_| 0.1 + dice.roll()).collect();
    let mut x = SVector::zeros();
    for (n, share_n) in share.iter().enumerate() {
        x += side[(first + n) % D] * (share_n / share.iter().sum::<f64>());
    }
    let middle = (outline.sides[0][0] + outline.sides[(1 << D) - 1][0]) / 2.0;
    // Some node may be on the same side; where that is rough, the point is to be inside.
    let goal = outline.nodes[(dice.roll() * outline.nodes.len() as f64) as usize];
    match outline.bump == 0.0 {
        true => x + (goal - x) * distance,
        false => x + (middle - x) * distance.max(outline.bump),
    }
}

/// How far the sums are from Σ N = 1, Σ N x_I = x, Σ ∇N = 0, Σ x_I ⊗ ∇N = 1, h = 1.
fn off<const D: usize>(
    values: &NodeValues<D>,
    nodes: &[SVector<f64, D>],
    x: SVector<f64, D>,
) -> f64 {
    let (mut one, mut place) = (-1.0, SVector::<f64, D>::zeros());
    let (mut slope, mut identity) = (SVector::<f64, D>::zeros(), -SMatrix::<f64, D, D>::identity());
    for (I, N, grad) in values {
        assert!(*N >= 0.0, "{N}");
        one += N;
        place += (nodes[*I] - x) * *N;
        slope += grad;
        identity += (nodes[*I] - x) * grad.transpose();
    }
    let error = one.abs() + place.abs().sum() + slope.abs().sum() + identity.abs().sum();
    assert!(!error.is_nan());
    error
}

/// How many points were served rightly, wrongly, and refused.
#[derive(Debug, Default, PartialEq)]
struct Count {
    right: usize,
    wrong: usize,
    refused: usize,
}

fn count<const D: usize>(gammas: &[f64], bump: f64, seed: u64) -> Count {
    let (mut dice, mut count) = (Dice(seed), Count::default());
    for body in 0..20 {
        let outline = outline::<D>(&mut dice, if D == 2 { 4 } else { 3 }, bump);
        let gamma = gammas[body % gammas.len()];
        for _ in 0..32 {
            let distance = dice.pick(&DISTANCES);
            let x = point(&mut dice, &outline, distance);
            match lme_at(&outline.nodes, 1.0, gamma, 0.0, &x) {
                Ok((values, _)) if off(&values, &outline.nodes, x) < 1e-9 => count.right += 1,
                Ok(_) => count.wrong += 1,
                Err(refused) => {
                    assert!(refused.to_string().contains("; "), "what to do: {refused}");
                    count.refused += 1;
                }
            }
        }
    }
    count
}

/// No point is served wrongly. At the usual γ all are served; at a large one, and where the
/// nodes of a side are only almost in one plane, some are refused.
#[test]
fn hull_points_are_right_or_refused() {
    let usual = [0.8, 1.8, 4.0];
    let mut text = String::from("γ,sides are flat to (h),dimension,right,wrong,refused\n");
    for (gammas, name, bump) in [
        (&usual[..], "0.8 1.8 4", 0.0),
        (&[10.0, 30.0, 100.0], "10 30 100", 0.0),
        (&usual, "0.8 1.8 4", 1e-13),
        (&usual, "0.8 1.8 4", 1e-11),
        (&usual, "0.8 1.8 4", 1e-9),
        (&usual, "0.8 1.8 4", 1e-7),
    ] {
        for (D, count) in [(2, count::<2>(gammas, bump, 7)), (3, count::<3>(gammas, bump, 11))] {
            assert_eq!((count.wrong, count.right + count.refused), (0, 640), "{name}, {bump:e}");
            assert!(bump > 0.0 || gammas[0] > 1.0 || count.refused == 0, "{name}, {bump:e}");
            text +=
                &format!("{name},{bump:e},{D},{},{},{}\n", count.right, count.wrong, count.refused);
        }
    }
    approve("hull__points", &text);
}

/// A side that lies in no axis is served like the same side normal to an axis: N, and ∇N turned
/// along, on it and at distances from 1e-17 to 1e-3.
#[test]
fn hull_turned_side() {
    let nodes =
        [[0.0, 0.0], [0.0, 1.0], [0.0, 2.2], [0.7, 0.3], [0.7, 1.9], [1.6, 0.9], [1.5, 2.0]]
            .map(|[x, y]| Vector2::new(x, y));
    for angle in [0.3, 0.7, 2.0, 4.0] {
        let turn = Rotation2::new(angle);
        let turned = nodes.map(|x| turn * x);
        for (d, y) in [0.0, 1e-17, 1e-15, 1e-12, 1e-10, 1e-8, 1e-6, 1e-3]
            .into_iter()
            .flat_map(|d| [0.35, 1.0, 1.7].map(|y| (d, y)))
        {
            let x = Vector2::new(d, y);
            let (expected, _) = lme_at(&nodes, 1.0, 1.8, 0.0, &x).unwrap();
            let (values, _) = lme_at(&turned, 1.0, 1.8, 0.0, &(turn * x)).unwrap();
            for ((_, N, grad), (_, M, slope)) in values.iter().zip(&expected) {
                assert_relative_eq!(N, M, epsilon = 1e-14);
                assert_relative_eq!(*grad, turn * slope, epsilon = 1e-10);
            }
        }
    }
}

/// In a box distances to sides and corners count down to 1e-150 h: N of the next node along
/// each axis is that distance. In a list, and in a ball, they need not from 1e-15 h down; the
/// sums are right at any.
#[test]
fn hull_at_the_smallest_distances() {
    let grid = Grid::over([4.0; 3], [4; 3], [[0, 0]; 3]);
    let nodes: Vec<_> = (0..grid.nodes()).map(|I| grid.position(I)).collect();
    let lme = |support| Basis::Lme { gamma: 0.8, cutoff: 1e-6, support };
    for d in [1e-12, 1e-17, 1e-30, 1e-60, 1e-80, 1e-120, 1e-149, 1e-151, 1e-200, 5e-324] {
        for x in [[d, 1.3, 2.6], [d, d, 1.7], [d, d, d]].map(SVector::from) {
            let row = on_grid(&lme(Support::Box), &grid, &[x]).unwrap().row();
            assert!(off(&row, &nodes, x) < 1e-13, "{d:e}");
            let beside: f64 = row.iter().filter(|v| nodes[v.0][0] == 1.0).map(|v| v.1).sum();
            let inner = if d < 1e-150 { 0.0 } else { d };
            assert_relative_eq!(beside, inner, epsilon = 0.0, max_relative = 1e-12);
            let ball = on_grid(&lme(Support::Ball), &grid, &[x]).unwrap().row();
            let list = lme_at(&nodes, 1.0, 0.8, 1e-6, &x).unwrap().0;
            for row in [ball, list] {
                assert!(off(&row, &nodes, x) < 1e-10, "{d:e}");
                let beside: f64 = row.iter().filter(|v| nodes[v.0][0] == 1.0).map(|v| v.1).sum();
                assert_relative_eq!(beside, d, epsilon = 1e-14);
            }
        }
    }
}

/// Outside by rounding is on the hull; outside by 1e-9 h is outside. The table names
/// the particle, and says what to do.
#[test]
fn hull_names_the_particle_outside() {
    let nodes = [[0.0, 0.0], [3.0, 1.0], [1.0, 2.0], [1.3, 0.9], [2.0, 1.5]]
        .map(|[x, y]| Vector2::new(x, y));
    let outwards = Vector2::new(1.0, -3.0);
    let on_side = |d: f64| Vector2::new(0.9, 0.3) + outwards * d;
    let basis = Basis::Lme { gamma: 0.8, cutoff: 1e-6, support: Support::Ball };
    for d in [-1e-9, -1e-12, 0.0, 1e-16, 1e-15] {
        let x = on_side(d);
        let (table, done) = on_nodes(&basis, &Vector2::repeat(1.0), &nodes, &[x]);
        done.unwrap();
        assert!(off(&table.row(), &nodes, x) < 1e-12, "{d:e}");
    }
    let x = [on_side(-0.1), on_side(1e-9)];
    let stopped = on_nodes(&basis, &Vector2::repeat(1.0), &nodes, &x).1.unwrap_err();
    assert_eq!(stopped, Breakdown::NoBasis { particle: 1, failure: Failure::OutsideHull });
    for word in ["particle 1", "outside the convex hull", "put nodes around it"] {
        assert!(stopped.to_string().contains(word), "{stopped}");
    }
}
