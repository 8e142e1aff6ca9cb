//! The background grid says where nodes stand, and which cell holds a point.

use nalgebra::SVector;

/// Counts through all index tuples below `count`, the first axis fastest; by carrying, since a
/// division per tuple would cost more than what is done with it.
pub fn odometer<const D: usize>(count: [usize; D]) -> impl Iterator<Item = [usize; D]> {
    let mut next = count.iter().all(|n| *n > 0).then_some([0; D]);
    std::iter::from_fn(move || {
        let now = next?;
        let mut after = now;
        next = None;
        for d in 0..D {
            after[d] += 1;
            if after[d] < count[d] {
                next = Some(after);
                break;
            }
            after[d] = 0;
        }
        Some(now)
    })
}

/// A point so near above a node, in cells, is on it: N_Ip and m_I are then 0, and else not so
/// small that f_I / m_I, σ/(ρh) over this at most, is no number.
const LEAST: f64 = 1e-280;

/// A grid is regular, of boxes with spacing h, in the frame of the body's lower corner: node i
/// along an axis stands at (i − before) h.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<const D: usize> {
    /// h, the spacing along each axis (m).
    pub h: SVector<f64, D>,
    /// 1/h (1/m).
    pub per_h: SVector<f64, D>,
    /// The grid's lower corner (m).
    lower: SVector<f64, D>,
    /// Cells along each axis, those beyond the body included.
    pub cells: [usize; D],
    /// Cells below the body's lower corner along each axis.
    pub before: [usize; D],
    /// The grid's upper corner (m): the body's own corner, to the last bit,
    /// where the grid ends with the body.
    pub upper: SVector<f64, D>,
}

/// A located point knows its cell, and its place there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located<const D: usize> {
    /// The cell's index along each axis.
    pub cell: [usize; D],
    /// ξ in [0, 1]: (x − lower corner of the cell) / h along each axis.
    pub xi: SVector<f64, D>,
}

impl<const D: usize> Grid<D> {
    /// Lays a grid of `cells` cells over a body of `length` (m) along each axis, and
    /// `beyond` cells more before and after it.
    pub fn over(length: [f64; D], cells: [usize; D], beyond: [[usize; 2]; D]) -> Self {
        let h = SVector::from_fn(|d, _| length[d] / cells[d] as f64);
        let upper = SVector::from_fn(|d, _| length[d] + beyond[d][1] as f64 * h[d]);
        let all = std::array::from_fn(|d| beyond[d][0] + cells[d] + beyond[d][1]);
        Grid::new(h, all, std::array::from_fn(|d| beyond[d][0]), upper)
    }

    /// Makes a grid from its spacing `h` (m), all its `cells`, those before the body's lower
    /// corner, and its upper corner (m).
    pub fn new(
        h: SVector<f64, D>,
        cells: [usize; D],
        before: [usize; D],
        upper: SVector<f64, D>,
    ) -> Self {
        let lower = SVector::from_fn(|d, _| 0.0 - before[d] as f64 * h[d]);
        Grid { h, per_h: h.map(|h| 1.0 / h), lower, cells, before, upper }
    }

    /// Gives N_n, the number of nodes.
    pub fn nodes(&self) -> usize {
        self.cells.iter().map(|cells| cells + 1).product()
    }

    /// Gives the index along each axis of node I.
    pub fn index(&self, I: usize) -> [usize; D] {
        let mut rest = I;
        std::array::from_fn(|d| {
            let i = rest % (self.cells[d] + 1);
            rest /= self.cells[d] + 1;
            i
        })
    }

    /// Gives x_I (m).
    pub fn position(&self, I: usize) -> SVector<f64, D> {
        let i = self.index(I);
        SVector::from_fn(|d, _| self.coordinate(d, i[d]))
    }

    /// Gives I of the node with index `i` along each axis; the first axis runs fastest.
    pub fn node(&self, i: [usize; D]) -> usize {
        let mut I = 0;
        for d in (0..D).rev() {
            I = I * (self.cells[d] + 1) + i[d];
        }
        I
    }

    /// Gives for each axis what the number I grows by from a node to the next.
    pub fn stride(&self) -> [usize; D] {
        std::array::from_fn(|d| self.cells[..d].iter().map(|cells| cells + 1).product())
    }

    /// Lists the nodes whose distance from a point along each axis is at most `radius`
    /// cells, and the corners of its cell; the first axis runs fastest.
    pub fn around(&self, at: &Located<D>, radius: f64) -> impl Iterator<Item = [usize; D]> {
        let (mut low, mut count) = ([0; D], [0; D]);
        for d in 0..D {
            let (cell, last) = (at.cell[d] as f64, self.cells[d] as f64);
            let lowest = libm::ceil(cell + at.xi[d] - radius).min(cell).max(0.0);
            let highest = libm::floor(cell + at.xi[d] + radius).max(cell + 1.0).min(last);
            (low[d], count[d]) = (lowest as usize, (highest - lowest) as usize + 1);
        }
        odometer(count).map(move |n| std::array::from_fn(|d| low[d] + n[d]))
    }

    /// Gives the coordinate along axis d of the nodes with index i (m).
    fn coordinate(&self, d: usize, i: usize) -> f64 {
        (i as i64 - self.before[d] as i64) as f64 * self.h[d]
    }

    // ANCHOR: locate
    /// Finds the cell that holds `x` (m); `None` outside the grid or for NaN.
    ///
    /// A point on a face belongs to the cell above it, except on the grid's
    /// own upper face. ξ is measured from the node as a number, so that a point
    /// with a node's coordinate has exactly ξ = 0; so has one that is above it by less than
    /// 1e-280 h, for a function that is not 0 must not be too small to divide by.
    #[inline]
    pub fn locate(&self, x: &SVector<f64, D>) -> Option<Located<D>> {
        let (mut cell, mut xi) = ([0; D], SVector::zeros());
        for d in 0..D {
            let x = x[d];
            if !(self.lower[d] <= x && x <= self.upper[d]) {
                return None;
            }
            let last = self.cells[d] - 1;
            // Whole part of a number from 0 up. It may be rounded across a node.
            let mut i = (((x - self.lower[d]) * self.per_h[d]) as i64 as usize).min(last);
            let mut from = x - self.coordinate(d, i);
            if from < 0.0 {
                i -= 1;
                from = x - self.coordinate(d, i);
            }
            let above = self.coordinate(d, i + 1);
            let mut within = from * self.per_h[d];
            if x >= above {
                (i, within) =
                    if i < last { (i + 1, (x - above) * self.per_h[d]) } else { (i, 1.0) };
            }
            (cell[d], xi[d]) = (i, if within < LEAST { 0.0 } else { within.min(1.0) });
        }
        Some(Located { cell, xi })
    }
    // ANCHOR_END: locate
}
