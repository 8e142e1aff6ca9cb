//! The dual domain method (DDMP; Zhang, Ma and Giguere 2011, reference 21) keeps the linear
//! functions and takes a gradient that does not jump, D = 1, 2, 3.

use crate::method::continuum::shape::Shape;
use crate::method::grid::{Grid, Located, odometer};
use nalgebra::SVector;
use std::array::from_fn;

/// For each node J the dual gradients G_JI = V_J⁻¹ ∫ S_J ∇S_I dx (1/m) of its neighbours I, with
/// V_J = ∫ S_J dx (m³) and S the linear functions. The integrals are over the cells that hold
/// particles, so that no node without mass has a part in them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Duals<const D: usize> {
    holds_particles: Vec<bool>,
    V: Vec<f64>,
    /// 3^D neighbours of each node, itself in the middle, the first axis fastest.
    G: Vec<SVector<f64, D>>,
    /// What a row of 4^D nodes is made in: S and its gradient.
    row: Vec<(f64, SVector<f64, D>)>,
}

impl<const D: usize> Duals<D> {
    const NEIGHBOURS: usize = 3_usize.pow(D as u32);

    // ANCHOR: duals
    /// Integrates over the cells in which particles stand at `x` (m).
    ///
    /// A cell adds Π_d h_d/2 to V_J of each corner, and to V_J G_JI along axis e
    /// ±½ Π_{d≠e} ∫ S_J S_I dx_d: the slope of S_I times the mean of S_J, and along the other
    /// axes h/3 for the same node and h/6 for two.
    pub fn integrate(&mut self, grid: &Grid<D>, x: &[SVector<f64, D>]) {
        let nodes = grid.nodes();
        self.holds_particles.clear();
        self.holds_particles.resize(nodes, false);
        self.V.clear();
        self.V.resize(nodes, 0.0);
        self.G.clear();
        self.G.resize(nodes * Self::NEIGHBOURS, SVector::zeros());
        for at in x.iter().filter_map(|x_p| grid.locate(x_p)) {
            self.holds_particles[grid.node(at.cell)] = true;
        }
        for n in (0..nodes).filter(|n| self.holds_particles[*n]) {
            let cell = grid.index(n);
            for a in odometer([2; D]) {
                let J = grid.node(from_fn(|d| cell[d] + a[d]));
                self.V[J] += (0..D).map(|d| 0.5 * grid.h[d]).product::<f64>();
                for b in odometer([2; D]) {
                    let mass = |d: usize| grid.h[d] / if a[d] == b[d] { 3.0 } else { 6.0 };
                    let others = |e: usize| (0..D).filter(|d| *d != e).map(mass).product::<f64>();
                    let neighbour = number_of(3, from_fn::<_, D, _>(|d| b[d] + 1 - a[d]));
                    self.G[J * Self::NEIGHBOURS + neighbour] +=
                        SVector::from_fn(|e, _| (b[e] as f64 - 0.5) * others(e));
                }
            }
        }
        for J in (0..nodes).filter(|J| self.V[*J] > 0.0) {
            for G_JI in &mut self.G[J * Self::NEIGHBOURS..][..Self::NEIGHBOURS] {
                *G_JI /= self.V[J];
            }
        }
    }
    // ANCHOR_END: duals

    // ANCHOR: ddmp
    /// Adds the row of a point: N_I = S_I, and α ∇S_I + (1 − α) Σ_J S_J G_JI in the place of its
    /// gradient (1/m), with α = Π_d 4 ξ_d (1 − ξ_d).
    ///
    /// α is 1 in the middle of a cell, where the gradient is that of the linear functions, and 0 on
    /// its faces, so that it is continuous there. Nodes at two cells' distance have a gradient
    /// without a value. Tests: `ddmp_owes_nothing`, `ddmp_is_the_dual_of_its_domain`.
    pub fn push_row(&mut self, shape: &mut Shape<D>, grid: &Grid<D>, at: &Located<D>) {
        let alpha: f64 = at.xi.iter().map(|xi| 4.0 * xi * (1.0 - xi)).product();
        let value = |d: usize, a: usize| if a == 0 { 1.0 - at.xi[d] } else { at.xi[d] };
        self.row.clear();
        self.row.resize(4_usize.pow(D as u32), (0.0, SVector::zeros()));
        for a in odometer([2; D]) {
            let S: f64 = (0..D).map(|d| value(d, a[d])).product();
            let slope = |e: usize| {
                let others = (0..D).filter(|d| *d != e).map(|d| value(d, a[d]));
                (2.0 * a[e] as f64 - 1.0) * grid.per_h[e] * others.product::<f64>()
            };
            let own = &mut self.row[number_of(4, a.map(|a| a + 1))];
            own.0 += S;
            own.1 += SVector::from_fn(|e, _| alpha * slope(e));
            let J = grid.node(from_fn(|d| at.cell[d] + a[d]));
            for (b, G_JI) in odometer([3; D]).zip(&self.G[J * Self::NEIGHBOURS..]) {
                self.row[number_of(4, from_fn::<_, D, _>(|d| a[d] + b[d]))].1 +=
                    G_JI * ((1.0 - alpha) * S);
            }
        }
        for (n, (S, gradient)) in odometer([4; D]).zip(&self.row) {
            if *S != 0.0 || gradient.iter().any(|slope| *slope != 0.0) {
                let I = grid.node(from_fn(|d| at.cell[d] + n[d] - 1));
                shape.push(I, *S, *gradient);
            }
        }
        shape.end_list();
    }
    // ANCHOR_END: ddmp
}

/// Numbers the places of a box with `side` places along each axis, the first axis fastest.
fn number_of<const D: usize>(side: usize, at: [usize; D]) -> usize {
    at.iter().rev().fold(0, |number, place| number * side + place)
}
