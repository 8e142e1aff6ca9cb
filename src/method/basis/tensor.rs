//! Multiplies functions of one coordinate, as all bases on a grid do but for local max-ent in a
//! ball.

use crate::method::continuum::shape::Shape;
use crate::method::grid::{Grid, odometer};
use nalgebra::SVector;

/// A line holds the functions of one axis at one coordinate: for each node the index along the
/// axis, N (–) and dN/dx (1/m). At most four.
#[derive(Clone, Copy, Debug, Default)]
pub struct Line {
    len: usize,
    node: [usize; 4],
    N: [f64; 4],
    slope: [f64; 4],
}

impl Line {
    /// Adds a node.
    pub fn push(&mut self, node: usize, N: f64, slope: f64) {
        self.node[self.len] = node;
        self.N[self.len] = N;
        self.slope[self.len] = slope;
        self.len += 1;
    }

    /// Counts the nodes.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Gives entry n: node, N and slope.
    pub fn entry(&self, n: usize) -> (usize, f64, f64) {
        (self.node[n], self.N[n], self.slope[n])
    }
}

// ANCHOR: tensor
/// Writes one row of the table as a product over the axes: N_Ip = Π_d N_d, and
/// ∂N_Ip/∂x_i has the slope in place of factor i. `factor(d, n)` gives entry n of axis d,
/// node, N and slope, and `count` the number of entries. The first axis runs fastest.
pub fn product_row<const D: usize>(
    shape: &mut Shape<D>,
    grid: &Grid<D>,
    count: [usize; D],
    factor: impl Fn(usize, usize) -> (usize, f64, f64),
) {
    for at in odometer::<D>(count) {
        let factors: [_; D] = std::array::from_fn(|d| factor(d, at[d]));
        let I = grid.node(std::array::from_fn(|d| factors[d].0));
        let N_Ip = factors.iter().map(|(_, N, _)| *N).product();
        let grad_N_Ip = SVector::from_fn(|i, _| {
            (0..D).map(|d| if d == i { factors[d].2 } else { factors[d].1 }).product()
        });
        shape.push(I, N_Ip, grad_N_Ip);
    }
}
// ANCHOR_END: tensor
