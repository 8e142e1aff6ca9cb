//! Scattered nodes are sorted, so that those near a point are found without looking at all.

use crate::method::grid::odometer;
use nalgebra::SVector;

// ANCHOR: bins
/// Bins are equal boxes of nodes, so that those near a point are found without looking at the
/// others. Lengths are in units of h along each axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Bins<const D: usize> {
    low: SVector<f64, D>,
    /// Boxes per unit of length.
    per_length: SVector<f64, D>,
    count: Vec<usize>,
    /// Box b holds `node[start[b]..start[b + 1]]`.
    start: Vec<usize>,
    node: Vec<usize>,
}

impl<const D: usize> Default for Bins<D> {
    fn default() -> Self {
        Bins {
            low: SVector::zeros(),
            per_length: SVector::zeros(),
            count: Vec::new(),
            start: Vec::new(),
            node: Vec::new(),
        }
    }
}

impl<const D: usize> Bins<D> {
    /// Sorts nodes at `x` (m) into boxes of about `size` (h).
    pub fn sort(&mut self, x: &[SVector<f64, D>], h: &SVector<f64, D>, size: f64) {
        let scaled = |a: usize| x[a].component_div(h);
        let (mut low, mut high): (SVector<f64, D>, SVector<f64, D>) =
            (SVector::repeat(f64::INFINITY), SVector::repeat(-f64::INFINITY));
        for a in 0..x.len() {
            low = low.inf(&scaled(a));
            high = high.sup(&scaled(a));
        }
        self.low = low;
        self.count.clear();
        for d in 0..D {
            let length = high[d] - low[d];
            // A few far nodes must not cost a box for every h in between.
            let most = libm::ceil(libm::pow(x.len() as f64, 1.0 / D as f64)) + 1.0;
            let boxes = libm::floor(length / size).clamp(1.0, most);
            self.count.push(boxes as usize);
            self.per_length[d] = if length > 0.0 { boxes / length } else { 0.0 };
        }
        // Counting sort: within a box the nodes keep their order.
        self.start.clear();
        self.start.resize(self.count.iter().product::<usize>() + 1, 0);
        for a in 0..x.len() {
            let b = self.box_of(&scaled(a));
            self.start[b] += 1;
        }
        for b in 1..self.start.len() {
            self.start[b] += self.start[b - 1];
        }
        // From the last node to the first, each box from its end to its beginning.
        self.node.clear();
        self.node.resize(x.len(), 0);
        for a in (0..x.len()).rev() {
            let b = self.box_of(&scaled(a));
            self.start[b] -= 1;
            self.node[self.start[b]] = a;
        }
    }

    /// Gives the number of a coordinate's box along axis d; the first or last box for one
    /// outside.
    fn along(&self, d: usize, x: f64) -> usize {
        ((x - self.low[d]) * self.per_length[d]).clamp(0.0, self.count[d] as f64 - 1.0) as usize
    }

    fn number(&self, along: [usize; D]) -> usize {
        (0..D).rev().fold(0, |number, d| number * self.count[d] + along[d])
    }

    fn box_of(&self, x: &SVector<f64, D>) -> usize {
        self.number(std::array::from_fn(|d| self.along(d, x[d])))
    }

    /// Lists the nodes of all boxes that a cube of half width `reach` around x meets.
    pub fn near(&self, x: &SVector<f64, D>, reach: f64) -> impl Iterator<Item = usize> {
        let low: [usize; D] = std::array::from_fn(|d| self.along(d, x[d] - reach));
        let count: [usize; D] = std::array::from_fn(|d| self.along(d, x[d] + reach) - low[d] + 1);
        odometer(count).flat_map(move |n| {
            let b = self.number(std::array::from_fn(|d| low[d] + n[d]));
            self.node[self.start[b]..self.start[b + 1]].iter().copied()
        })
    }
}
// ANCHOR_END: bins
