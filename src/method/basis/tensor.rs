//! Multiplies functions of one coordinate, which linear, uGIMP and B-spline bases share.

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
}

// ANCHOR: tensor
/// Writes one row of the table from one `Line` for each axis: N_Ip = Π_d N_d, and
/// ∂N_Ip/∂x_i has the slope in place of factor i. The first axis runs fastest.
pub fn product_row<const D: usize>(shape: &mut Shape<D>, grid: &Grid<D>, lines: &[Line; D]) {
    for at in odometer::<D>(std::array::from_fn(|d| lines[d].len)) {
        let I = grid.node(std::array::from_fn(|d| lines[d].node[at[d]]));
        let N_Ip = (0..D).map(|d| lines[d].N[at[d]]).product();
        let grad_N_Ip = SVector::from_fn(|i, _| {
            let factor = |d: usize| {
                if d == i { lines[d].slope[at[d]] } else { lines[d].N[at[d]] }
            };
            (0..D).map(factor).product()
        });
        shape.push(I, N_Ip, grad_N_Ip);
    }
}
// ANCHOR_END: tensor
