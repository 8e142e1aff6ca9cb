//! The background grid: the only place that enumerates space dimensions.
#![allow(non_snake_case)]

use nalgebra::SVector;

/// A regular grid of boxes with spacing h, in the frame of the body's lower
/// corner: node i along an axis stands at (i − before) h.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<const D: usize> {
    /// h, the spacing along each axis (m).
    pub h: SVector<f64, D>,
    /// Cells along each axis, those beyond the body included.
    pub cells: [usize; D],
    /// Cells below the body's lower corner along each axis.
    pub before: [usize; D],
    /// The grid's upper corner (m): the body's own corner, to the last bit,
    /// where the grid ends with the body.
    pub upper: SVector<f64, D>,
}

/// A point seen from its cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located<const D: usize> {
    /// The cell's index along each axis.
    pub cell: [usize; D],
    /// ξ in [0, 1]: (x − lower corner of the cell) / h along each axis.
    pub xi: SVector<f64, D>,
}

impl<const D: usize> Grid<D> {
    /// A grid of `cells` cells over a body of `length` (m) along each axis, and
    /// `beyond` cells more before and after it.
    pub fn over(length: [f64; D], cells: [usize; D], beyond: [[usize; 2]; D]) -> Self {
        let h = SVector::from_fn(|d, _| length[d] / cells[d] as f64);
        Grid {
            h,
            cells: std::array::from_fn(|d| beyond[d][0] + cells[d] + beyond[d][1]),
            before: std::array::from_fn(|d| beyond[d][0]),
            upper: SVector::from_fn(|d, _| length[d] + beyond[d][1] as f64 * h[d]),
        }
    }

    /// 2^D, the number of corners of a cell.
    pub const CORNERS: usize = 1 << D;

    /// N_n, the number of nodes.
    pub fn nodes(&self) -> usize {
        self.cells.iter().map(|cells| cells + 1).product()
    }

    /// The index along each axis of node I.
    pub fn index(&self, I: usize) -> [usize; D] {
        let mut rest = I;
        std::array::from_fn(|d| {
            let i = rest % (self.cells[d] + 1);
            rest /= self.cells[d] + 1;
            i
        })
    }

    /// x_I (m).
    pub fn position(&self, I: usize) -> SVector<f64, D> {
        let i = self.index(I);
        SVector::from_fn(|d, _| (i[d] as f64 - self.before[d] as f64) * self.h[d])
    }

    /// I of the node with index `i` along each axis; the first axis runs fastest.
    pub fn node(&self, i: [usize; D]) -> usize {
        let mut I = 0;
        for d in (0..D).rev() {
            I = I * (self.cells[d] + 1) + i[d];
        }
        I
    }

    /// The corner with number `corner` < 2^D of a cell: bit d says which end
    /// along axis d.
    pub fn corner(corner: usize) -> [usize; D] {
        std::array::from_fn(|d| corner >> d & 1)
    }

    /// The cell that holds `x` (m); `None` outside the grid or for NaN.
    ///
    /// A point on a face belongs to the cell above it, except on the grid's
    /// own upper face.
    pub fn locate(&self, x: &SVector<f64, D>) -> Option<Located<D>> {
        let mut cell = [0; D];
        let mut xi = SVector::zeros();
        for d in 0..D {
            let s = x[d] / self.h[d];
            let below = libm::floor(s);
            let i = below + self.before[d] as f64;
            let cells = self.cells[d] as f64;
            if (0.0..cells).contains(&i) {
                (cell[d], xi[d]) = (i as usize, s - below);
            } else if i >= cells && x[d] <= self.upper[d] {
                (cell[d], xi[d]) = (self.cells[d] - 1, 1.0);
            } else {
                return None;
            }
        }
        Some(Located { cell, xi })
    }
}
