//! The internal forces (14) are an integral, and this is the list of the ways to take it: the sum
//! over the particles, or Gauss's points with a stress that is reconstructed there.
//!
//! A reconstructed force is not the adjoint of the strain (16), so no law keeps the energy.

mod fit;
pub mod mls;
pub mod tls;

use super::basis::{Degree, bspline, linear};
use super::continuum::shape::Shape;
use super::continuum::state::{Nodes, Particles};
use super::continuum::sums;
use super::grid::{Grid, Located, odometer};
use super::quadrature::gauss;
use nalgebra::{SMatrix, SVector};
use std::array::from_fn;

/// A reconstruction gives the stress between the particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reconstruction {
    pub rule: Rule,
    /// The degree of its polynomials, 0 to 2.
    pub degree: usize,
    pub functions: Piecewise,
}

/// These rules give a stress at Gauss's points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Least squares over the particles of the cell, with Taylor's polynomials (reference 19).
    Tls,
    /// Moving least squares about each point (reference 18).
    Mls,
}

/// These shape functions have a reconstruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piecewise {
    Linear,
    BSpline(Degree),
}

/// A cell with its Gauss's points, at ξ in [−1, 1] along each axis (–), and the particles of all
/// cells.
pub struct Cell<'a, const D: usize> {
    pub index: [usize; D],
    pub points: &'a [(SVector<f64, D>, f64)],
    pub grid: &'a Grid<D>,
    pub particle: &'a Particles<D>,
    /// The particles of each cell, which has its lowest node's number.
    pub inside: &'a [Vec<(usize, Located<D>)>],
}

impl<const D: usize> Cell<'_, D> {
    /// Lists the particles of the cell with their places.
    pub fn own(&self) -> &[(usize, Located<D>)] {
        &self.inside[self.grid.node(self.index)]
    }

    /// Gives |Ω_e|, the volume of a cell (m³).
    pub fn volume(&self) -> f64 {
        self.grid.h.product()
    }

    /// Says whether the body ends inside the cell: a cell beside it is empty, and the volumes of
    /// its particles miss its own by more than half a particle.
    fn is_cut(&self) -> bool {
        let V: f64 = self.own().iter().map(|(p, _)| volume(self.particle, *p)).sum();
        let half = 0.5 * V / self.own().len() as f64;
        let is_empty = |d: usize, above: bool| {
            let mut beside = self.index;
            if above {
                beside[d] += 1;
            } else if beside[d] > 0 {
                beside[d] -= 1;
            }
            beside[d] < self.grid.cells[d] && self.inside[self.grid.node(beside)].is_empty()
        };
        let ends = (0..D).any(|d| is_empty(d, false) || is_empty(d, true));
        ends && libm::fabs(V - self.volume()) > half
    }
}

/// Gives V_p = m_p / ρ_p (m³).
pub fn volume<const D: usize>(particle: &Particles<D>, p: usize) -> f64 {
    particle.m[p] / particle.rho[p]
}

// ANCHOR: internal
/// (14) adds the internal forces by the quadrature that a model has: the sum over the particles,
/// or with a reconstruction f_I −= Σ_e Σ_g w_g |Ω_e| σ(x_g) ∇N_I(x_g)  (N), over the cells that
/// hold particles and their Gauss's points g. Where the body ends inside a cell, the particles
/// of that cell are summed.
///
/// Tests: `reconstruction_of_uniform_stress_is_in_balance`, `reconstruction_ends_with_the_body`.
pub fn internal_force<const D: usize>(
    node: &mut Nodes<D>,
    particle: &Particles<D>,
    shape: &Shape<D>,
    grid: &Grid<D>,
    reconstruction: Option<Reconstruction>,
) {
    let Some(of) = reconstruction else {
        return sums::internal_force(node, particle, shape);
    };
    let (points, inside) = (points::<D>(of.functions), particle.by_cell(grid));
    let mut table = Shape::blank(0);
    table.clear(grid.stride());
    for index in odometer(grid.cells) {
        let cell = Cell { index, points: &points, grid, particle, inside: &inside };
        if cell.own().is_empty() {
            continue;
        }
        if cell.is_cut() {
            for (p, _) in cell.own() {
                pull(node, shape, *p, &(particle.sigma[*p] * volume(particle, *p)));
            }
            continue;
        }
        let sigma = match of.rule {
            Rule::Tls => tls::stress(&cell, of.degree, &mut node.cost.fitted_stresses),
            Rule::Mls => mls::stress(&cell, of.degree, &mut node.cost.fitted_stresses),
        };
        for ((xi, weight), sigma_g) in points.iter().zip(sigma) {
            let row = tabulate(&mut table, of.functions, &cell, xi);
            pull(node, &table, row, &(sigma_g * (weight * cell.volume())));
        }
    }
    node.cost = node.cost + table.cost;
}
// ANCHOR_END: internal

/// Adds f_I −= (V σ) ∇N_I of one row of a table.
fn pull<const D: usize>(
    node: &mut Nodes<D>,
    table: &Shape<D>,
    row: usize,
    V_sigma: &SMatrix<f64, D, D>,
) {
    for (I, _, grad_N_I) in table.of(row) {
        node.f[I] -= V_sigma * grad_N_I;
    }
}

// ANCHOR: points
/// Lists Gauss's points of a cell, at ξ in [−1, 1] with weights whose sum is 1: along each axis two
/// for linear functions, three for cubic B-splines, and for quadratic ones, which have a knot in
/// the middle of the cell, two in each half. So Σ_g w_g q(x_g) ∇N(x_g) is the integral for all
/// polynomials q up to the degree 2, 1 for linear functions.
///
/// Test: `reconstruction_has_an_exact_quadrature`.
pub fn points<const D: usize>(functions: Piecewise) -> Vec<(SVector<f64, D>, f64)> {
    let line = match functions {
        Piecewise::Linear => gauss(2),
        Piecewise::BSpline(Degree::Cubic) => gauss(3),
        Piecewise::BSpline(Degree::Quadratic) => {
            let half =
                |middle: f64| gauss(2).into_iter().map(move |[r, w]| [middle + 0.5 * r, 0.5 * w]);
            half(-0.5).chain(half(0.5)).collect()
        }
    };
    let point = |i: [usize; D]| {
        let weight = i.iter().map(|i| 0.5 * line[*i][1]).product();
        (SVector::from_fn(|d, _| line[i[d]][0]), weight)
    };
    odometer([line.len(); D]).map(point).collect()
}
// ANCHOR_END: points

/// Tabulates N_I and ∇N_I at the place ξ of a cell, and gives the number of the row.
fn tabulate<const D: usize>(
    table: &mut Shape<D>,
    functions: Piecewise,
    cell: &Cell<D>,
    xi: &SVector<f64, D>,
) -> usize {
    let row = table.cost.basis_evaluations as usize;
    let at = Located { cell: cell.index, xi: xi.map(|xi| 0.5 + 0.5 * xi) };
    match functions {
        Piecewise::Linear => {
            let axes: [_; D] = from_fn(|d| linear::factors(at.xi[d], cell.grid.per_h[d]));
            table.push_product(from_fn(|d| (at.cell[d], &axes[d][..])));
        }
        Piecewise::BSpline(degree) => {
            let axes = bspline::axes(degree, &at, cell.grid);
            table.push_product(from_fn(|d| axes[d].factors()));
        }
    }
    row
}
