//! The table has N_I(x_p) and ∇N_I(x_p), a row for each particle.
//!
//! On a grid a row is a product: it keeps the functions of each axis by themselves, from
//! the first node on, and the sums run over lines of nodes along the first axis. Where nodes
//! stand anywhere, and for local max-ent in a ball, a row is a list, and each node of it is
//! a line by itself. Every sum reads the same for both.

use crate::method::cost::Cost;
use nalgebra::{SMatrix, SVector};
use std::ops::Range;

// ANCHOR: shape
/// The table holds N_Ip and ∇N_Ip for all particles p and the nodes I that each one sees.
///
/// Rebuilt whenever the particles move. Within a row the nodes keep one order, the first
/// axis fastest, or that in which they were listed, so every sum has one fixed order.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape<const D: usize> {
    row: Vec<Row<D>>,
    /// Of rows that are products: the functions of each axis.
    factor: Vec<Factor>,
    /// Of rows that are lists: N (–) and ∇N (1/m) of each node.
    listed: Vec<Listed<D>>,
    /// The node beside node I along axis d is I + stride[d].
    stride: [usize; D],
    /// Rows and pairs of all tables so far.
    pub cost: Cost,
}

/// A row starts at `factor[start]`, or, with no node along its axes, at `listed[start]`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row<const D: usize> {
    /// The node with the lowest index along every axis.
    first: usize,
    start: usize,
    /// Nodes along each axis; 0 for a list.
    count: [u32; D],
    /// Lines of the row.
    lines: u32,
    /// Some N is 0 or tiny: that node may be without mass.
    tiny: bool,
}
// ANCHOR_END: shape

impl<const D: usize> Row<D> {
    /// Counts the nodes.
    fn pairs(&self) -> usize {
        self.lines as usize * self.count[0].max(1) as usize
    }
}

/// A factor holds the function of one node along one axis: N (–) and dN/dx (1/m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Factor {
    pub N: f64,
    pub slope: f64,
}

/// A node of a list has its N and ∇N.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Listed<const D: usize> {
    I: usize,
    N: f64,
    grad_N: SVector<f64, D>,
}

/// The product of three factors of this size is a number, and so is a mass times that.
const TINY: f64 = 1e-60;

/// A node of a list is a line by itself, which this factor leaves as it is.
const ONE: Factor = Factor { N: 1.0, slope: 1.0 };

impl<const D: usize> Default for Shape<D> {
    fn default() -> Self {
        Shape::blank(0)
    }
}

impl<const D: usize> Shape<D> {
    /// Makes a table in which each of `particles` sees no node.
    pub fn blank(particles: usize) -> Self {
        let empty = Row { first: 0, count: [0; D], start: 0, lines: 0, tiny: false };
        Shape {
            row: vec![empty; particles],
            factor: Vec::new(),
            listed: Vec::new(),
            stride: [0; D],
            cost: Cost::default(),
        }
    }

    /// Forgets all rows and keeps the memory. Rows that are products need the grid's
    /// [stride](crate::method::grid::Grid::stride).
    pub fn clear(&mut self, stride: [usize; D]) {
        self.row.clear();
        self.factor.clear();
        self.listed.clear();
        self.stride = stride;
    }

    /// Adds a row that is a product: N_Ip = Π_d N_d, and ∂N_Ip/∂x_i has the slope in place of
    /// factor i. `axes` gives for each axis the first node along it, and the functions of it
    /// and those that follow.
    #[inline(always)]
    pub fn push_product(&mut self, axes: [(usize, &[Factor]); D]) {
        let start = self.factor.len();
        let (mut first, mut count, mut tiny) = (0, [0_u32; D], false);
        for d in 0..D {
            let (node, factors) = axes[d];
            self.factor.extend_from_slice(factors);
            first += node * self.stride[d];
            count[d] = factors.len() as u32;
            tiny |= factors.iter().any(|factor| factor.N < TINY);
        }
        self.end_row(Row { first, count, start, lines: count[1..].iter().product(), tiny });
    }

    /// Adds node I with N_Ip (–) and ∇N_Ip (1/m) to the list that is being written.
    pub fn push(&mut self, I: usize, N: f64, grad_N: SVector<f64, D>) {
        self.listed.push(Listed { I, N, grad_N });
    }

    /// Ends the list, which is the row of the current particle.
    pub fn end_list(&mut self) {
        let start = self.row.last().map_or(0, |row| row.start + row.lines as usize);
        let lines = (self.listed.len() - start) as u32;
        let tiny = self.listed[start..].iter().any(|listed| listed.N < TINY);
        self.end_row(Row { first: 0, count: [0; D], start, lines, tiny });
    }

    fn end_row(&mut self, row: Row<D>) {
        self.cost.basis_evaluations += 1;
        self.cost.particle_node_pairs += row.pairs() as u64;
        self.row.push(row);
    }

    /// Counts the particle-node pairs.
    pub fn len(&self) -> usize {
        self.row.iter().map(Row::pairs).sum()
    }

    /// Counts the bytes that the table holds.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.row[..]) + size_of_val(&self.factor[..]) + size_of_val(&self.listed[..])
    }

    /// Gives for each axis the functions of particle p along it; `None` for a list.
    pub fn axes(&self, p: usize) -> Option<[&[Factor]; D]> {
        let Row { start, count, .. } = self.row[p];
        let mut rest = self.factor.get(start..).filter(|_| count[0] > 0)?;
        Some(count.map(|count| {
            let (axis, others) = rest.split_at(count as usize);
            rest = others;
            axis
        }))
    }

    /// Says whether particle p may see a node without mass: one whose N_Ip is 0, or so tiny
    /// that m_p N_Ip is. To ask this once for a row is cheaper than to look at every m_I.
    pub fn has_tiny(&self, p: usize) -> bool {
        self.row[p].tiny
    }

    /// Finds the first of the nodes that particle p sees with some property.
    #[inline(always)]
    pub fn find(&self, p: usize, property: impl Fn(usize) -> bool) -> Option<usize> {
        let row = &self.row[p];
        if row.count[0] > 0 && property(row.first) {
            return Some(row.first);
        }
        self.of(p).map(|(I, _, _)| I).find(|I| property(*I))
    }

    // ANCHOR: lines
    /// Shows `each` the lines of nodes that particle p sees, the second axis fastest.
    #[inline(always)]
    pub fn lines(&self, p: usize, mut each: impl FnMut(Line<D>)) {
        let row = &self.row[p];
        if row.count == [2; D] {
            self.product::<2>(row, each); // the linear basis, whose loops are then unrolled
        } else if row.count[0] > 0 {
            self.product::<0>(row, each);
        } else {
            for n in 0..row.lines as usize {
                each(self.listed_line(row, n));
            }
        }
    }

    /// Shows the lines of a product with `W` nodes along each axis; with any number if 0.
    #[inline(always)]
    fn product<const W: usize>(&self, row: &Row<D>, mut each: impl FnMut(Line<D>)) {
        let count = if W > 0 { [W; D] } else { row.count.map(|count| count as usize) };
        let factors = &self.factor[row.start..][..count.iter().sum()];
        for k in 0..if D > 2 { count[2] } else { 1 } {
            for j in 0..if D > 1 { count[1] } else { 1 } {
                each(self.product_line(row.first, factors, count, [j, k]));
            }
        }
    }

    /// Gives the line of a product at place j of the second axis and k of the third.
    #[inline(always)]
    fn product_line<'a>(
        &self,
        first: usize,
        factors: &'a [Factor],
        count: [usize; D],
        [j, k]: [usize; 2],
    ) -> Line<'a, D> {
        let (x, others) = factors.split_at(count[0]);
        let (y, z) = match D {
            1 => (&ONE, &ONE),
            2 => (&others[j], &ONE),
            _ => (&others[j], &others[count[1] + k]),
        };
        let share = y.N * z.N;
        let across = [share, y.slope * z.N, y.N * z.slope];
        let beside = [0, j, k];
        let I = first + (1..D).map(|d| beside[d] * self.stride[d]).sum::<usize>();
        Line { I, factors: x, share, across: SVector::from_fn(|d, _| across[d]) }
    }

    /// Gives node n of a list, a line by itself.
    #[inline(always)]
    fn listed_line(&self, row: &Row<D>, n: usize) -> Line<'static, D> {
        let Listed { I, N: share, grad_N: across } = self.listed[row.start + n];
        Line { I, factors: &[ONE], share, across }
    }

    /// Σ_I runs over the nodes of one particle as (I, N_Ip, ∇N_Ip).
    pub fn of(&self, p: usize) -> impl Iterator<Item = (usize, f64, SVector<f64, D>)> {
        let row = &self.row[p];
        let is_list = row.count[0] == 0;
        let factors = &self.factor[if is_list { 0 } else { row.start }..];
        let count = row.count.map(|count| count as usize);
        let along = if D > 1 { count[1].max(1) } else { 1 };
        (0..row.lines as usize).flat_map(move |n| {
            let line = match is_list {
                true => self.listed_line(row, n),
                false => self.product_line(row.first, factors, count, [n % along, n / along]),
            };
            line.entries()
        })
    }

    /// Σ_p Σ_I runs over every pair as (I, p, N_Ip, ∇N_Ip), particle by particle.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64, SVector<f64, D>)> {
        (0..self.row.len())
            .flat_map(move |p| self.of(p).map(move |(I, N_Ip, grad_N_Ip)| (I, p, N_Ip, grad_N_Ip)))
    }
    // ANCHOR_END: lines
}

// ANCHOR: line
/// A line holds neighbouring nodes along the first axis, from I on, with what they share of
/// the other axes:
/// N_Ip = share · N and ∇N_Ip = (across_1 · slope, across_2 · N, across_3 · N).
#[derive(Clone, Copy)]
pub struct Line<'a, const D: usize> {
    I: usize,
    /// N and slope along the first axis, for each node.
    pub factors: &'a [Factor],
    /// Π N over the other axes.
    pub share: f64,
    /// `share`, and the same with the slope in place of one N.
    across: SVector<f64, D>,
}

impl<'a, const D: usize> Line<'a, D> {
    /// Gives the numbers I of the nodes: where the line is in a list of nodal values.
    #[inline(always)]
    pub fn nodes(&self) -> Range<usize> {
        self.I..self.I + self.factors.len()
    }

    /// Runs over the nodes as (I, N_Ip, ∇N_Ip).
    #[inline(always)]
    pub fn entries(self) -> impl Iterator<Item = (usize, f64, SVector<f64, D>)> + use<'a, D> {
        (self.I..).zip(self.factors).map(move |(I, Factor { N, slope })| {
            let along = |d| if d == 0 { slope } else { N };
            (I, self.share * N, SVector::from_fn(|d, _| self.across[d] * along(d)))
        })
    }

    /// Splits a·∇N_Ip of a matrix a into what goes with the slope along the first axis and
    /// what goes with N: nothing, where there is no other axis.
    #[inline(always)]
    pub fn split(&self, a: &SMatrix<f64, D, D>) -> (SVector<f64, D>, SVector<f64, D>) {
        let mut across = SVector::zeros();
        for d in 1..D {
            across += a.column(d) * self.across[d];
        }
        (a.column(0) * self.across[0], across)
    }
}
// ANCHOR_END: line
