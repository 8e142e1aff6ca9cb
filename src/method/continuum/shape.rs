//! The table has N_I(x_p) and ∇N_I(x_p) in compressed rows, one for each particle.

use crate::method::cost::Cost;
use nalgebra::SVector;

/// A pair of the table holds node I, N_Ip and ∇N_Ip.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair<const D: usize> {
    I: usize,
    N: f64,
    grad_N: SVector<f64, D>,
}

// ANCHOR: shape
/// The table holds N_Ip and ∇N_Ip for all particles p and the nodes I that each one sees.
///
/// Rebuilt whenever the particles move. Within a row the nodes keep the order
/// in which the basis names them, so every sum has one fixed order.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape<const D: usize> {
    /// Row p is `entry[start[p]..start[p + 1]]`.
    start: Vec<usize>,
    entry: Vec<Pair<D>>,
    /// Rows and pairs of all tables so far.
    pub cost: Cost,
}
// ANCHOR_END: shape

impl<const D: usize> Default for Shape<D> {
    fn default() -> Self {
        Shape::blank(0)
    }
}

impl<const D: usize> Shape<D> {
    /// Makes a table in which each of `particles` sees no node.
    pub fn blank(particles: usize) -> Self {
        Shape { start: vec![0; particles + 1], entry: Vec::new(), cost: Cost::default() }
    }

    /// Forgets all rows and keeps the memory.
    pub fn clear(&mut self) {
        self.start.truncate(1);
        self.entry.clear();
    }

    /// Adds N_Ip (–) and ∇N_Ip (1/m) to the row that is being written.
    pub fn push(&mut self, I: usize, N: f64, grad_N: SVector<f64, D>) {
        self.entry.push(Pair { I, N, grad_N });
    }

    /// Ends the row of the current particle.
    pub fn end_row(&mut self) {
        self.start.push(self.entry.len());
    }

    /// Adds the rows and pairs of the table, which is complete, to the cost.
    pub fn count(&mut self) {
        self.cost.basis_evaluations += self.start.len() as u64 - 1;
        self.cost.particle_node_pairs += self.entry.len() as u64;
    }

    /// Counts the particle-node pairs.
    pub fn len(&self) -> usize {
        self.entry.len()
    }

    // ANCHOR: pairs
    /// Σ_p Σ_I runs over every pair as (I, p, N_Ip, ∇N_Ip), particle by particle.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64, &SVector<f64, D>)> {
        (0..self.start.len() - 1)
            .flat_map(move |p| self.of(p).map(move |(I, N_Ip, grad_N_Ip)| (I, p, N_Ip, grad_N_Ip)))
    }

    /// Σ_I runs over the nodes of one particle as (I, N_Ip, ∇N_Ip).
    pub fn of(&self, p: usize) -> impl Iterator<Item = (usize, f64, &SVector<f64, D>)> {
        self.entry[self.start[p]..self.start[p + 1]]
            .iter()
            .map(|entry| (entry.I, entry.N, &entry.grad_N))
    }
    // ANCHOR_END: pairs
}

impl Shape<1> {
    /// Gives entry n of row p: node, N (–) and dN/dx (1/m).
    pub fn pair(&self, p: usize, n: usize) -> (usize, f64, f64) {
        let pair = &self.entry[self.start[p] + n];
        (pair.I, pair.N, pair.grad_N[0])
    }
}
