//! Functions of one coordinate are the factors of all bases on a grid but for local max-ent in
//! a ball.

use crate::method::continuum::shape::Factor;

/// An axis holds the functions of one coordinate at one place, for neighbouring nodes from
/// `first` on; at most four.
#[derive(Clone, Copy, Debug, Default)]
pub struct Axis {
    first: usize,
    len: usize,
    factor: [Factor; 4],
}

impl Axis {
    /// Begins at the node with this index along the axis.
    pub fn from(first: usize) -> Self {
        Axis { first, ..Axis::default() }
    }

    /// Adds N (–) and the slope (1/m) of the next node.
    pub fn push(&mut self, N: f64, slope: f64) {
        self.factor[self.len] = Factor { N, slope };
        self.len += 1;
    }

    /// Gives the first node and the functions.
    pub fn factors(&self) -> (usize, &[Factor]) {
        (self.first, &self.factor[..self.len])
    }
}
