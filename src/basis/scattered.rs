//! Local max-ent on nodes that stand anywhere, and move: the table of OTM.
#![allow(non_snake_case)]

use super::lme::Failure;
use super::{Basis, Scratch, support};
use crate::continuum::shape::Shape;
use crate::cost::Cost;
use crate::grid::odometer;
use nalgebra::SVector;

/// How often the search radius is widened for a particle that its nodes do not
/// enclose, and by how much.
const WIDENINGS: usize = 6;
const WIDER: f64 = 1.5;

// ANCHOR: bins
/// Nodes sorted into equal boxes, so that those near a point are found without
/// looking at the others. Lengths are in units of h along each axis.
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

    /// The number of a coordinate's box along axis d; the first or last box for one
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

    /// The nodes of all boxes that a cube of half width `reach` around x meets.
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

// ANCHOR: scattered
/// Fills the table with N_ap (–) and ∇N_ap (1/m) of nodes at `nodes` (m) for
/// particles at `x` (m). `h` (m) of γ = βh² is the spacing at the start.
///
/// Of local max-ent a particle sees the nodes within R. Where they do not enclose
/// it, as when the body is stretched, R is widened. The linear basis, in 1D only,
/// sees the two nodes beside it.
///
/// Errors: the first particle that cannot be served, with the reason.
pub fn tabulate<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    cost: &mut Cost,
    basis: &Basis,
    h: &SVector<f64, D>,
    nodes: &[SVector<f64, D>],
    x: &[SVector<f64, D>],
) -> Result<(), (usize, Failure)> {
    shape.clear();
    match basis {
        Basis::Lme { gamma, cutoff } => {
            // At least the nodes of a cell, however narrow the functions.
            let reach = support::radius(*gamma, *cutoff).max(1.0);
            scratch.bins.sort(nodes, h, if reach.is_finite() { reach } else { 1.0 });
            scratch.lambda.resize(x.len(), SVector::zeros());
            for p in 0..x.len() {
                local_max_ent(shape, scratch, cost, *gamma, reach, h, nodes, &x[p], p)
                    .map_err(|failure| (p, failure))?;
            }
        }
        _ => {
            for p in 0..x.len() {
                linear(shape, nodes, &x[p]).ok_or((p, Failure::OutsideHull))?;
            }
        }
    }
    cost.basis_evaluations += x.len() as u64;
    cost.particle_node_pairs += shape.len() as u64;
    Ok(())
}
// ANCHOR_END: scattered

#[allow(clippy::too_many_arguments)]
fn local_max_ent<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    cost: &mut Cost,
    gamma: f64,
    mut reach: f64,
    h: &SVector<f64, D>,
    nodes: &[SVector<f64, D>],
    x_p: &SVector<f64, D>,
    p: usize,
) -> Result<(), Failure> {
    let Scratch { lme, nodes: seen, lambda, bins } = scratch;
    let (exponentials, iterations) = (lme.exponentials, lme.iterations);
    let mut widenings = 0;
    let found = loop {
        seen.clear();
        let (mut nearest, mut least) = (0, f64::INFINITY);
        for a in bins.near(&x_p.component_div(h), reach) {
            let xi = (x_p - nodes[a]).component_div(h);
            let square = xi.dot(&xi);
            cost.candidates += 1;
            if square <= reach * reach {
                seen.push(a);
                if square < least {
                    (nearest, least) = (a, square);
                }
            }
        }
        lme.clear(false);
        for &a in seen.iter() {
            let offset = (nodes[nearest] - nodes[a]).component_div(h);
            lme.push((x_p - nodes[a]).component_div(h), offset);
        }
        match lme.evaluate(gamma, [lambda[p], SVector::zeros()]) {
            Err(_) if widenings < WIDENINGS && seen.len() < nodes.len() => {
                widenings += 1;
                reach *= WIDER;
            }
            answer => break answer?,
        }
    };
    lambda[p] = found;
    cost.exponentials += lme.exponentials - exponentials;
    cost.newton_iterations += lme.iterations - iterations;
    for ((a, N), grad) in seen.iter().zip(&lme.p).zip(&lme.grad) {
        shape.push(*a, *N, grad.component_div(h));
    }
    shape.end_row();
    Ok(())
}

/// The two nodes beside x_p, in 1D, where nodes stand in the order of their
/// numbers.
fn linear<const D: usize>(
    shape: &mut Shape<D>,
    nodes: &[SVector<f64, D>],
    x_p: &SVector<f64, D>,
) -> Option<()> {
    let after = nodes.partition_point(|x| x[0] <= x_p[0]).clamp(1, nodes.len() - 1);
    let (low, high) = (nodes[after - 1][0], nodes[after][0]);
    let xi = (x_p[0] - low) / (high - low);
    if !(0.0..=1.0).contains(&xi) {
        return None;
    }
    let slope = SVector::repeat(1.0 / (high - low));
    shape.push(after - 1, 1.0 - xi, -slope);
    shape.push(after, xi, slope);
    shape.end_row();
    Some(())
}
