//! Local max-ent on nodes that stand anywhere, and move: the table of OTM.

use super::kind::Basis;
use super::lme::Failure;
use super::scratch::Scratch;
use super::support;
use crate::method::breakdown::Breakdown;
use crate::method::continuum::shape::Shape;
use nalgebra::SVector;

/// How often the search radius is widened for a particle that its nodes do not
/// enclose, and by how much.
const WIDENINGS: usize = 6;
const WIDER: f64 = 1.5;

/// Where the nodes stand.
#[derive(Clone, Copy)]
pub struct Places<'a, const D: usize> {
    /// (m).
    pub x: &'a [SVector<f64, D>],
    /// h of γ = βh² (m), the spacing at the start.
    pub h: &'a SVector<f64, D>,
}

// ANCHOR: scattered
/// Fills the table with N_ap (–) and ∇N_ap (1/m) of `nodes` for particles at `x` (m);
/// `lambda` starts the search for each particle's λ h, and holds what was found.
///
/// Of local max-ent a particle sees the nodes within R. Where they do not enclose
/// it, as when the body is stretched, R is widened. The linear basis, in 1D only,
/// sees the two nodes beside it.
///
/// Errors: the first particle that cannot be served, [`Breakdown::NoBasis`] or
/// [`Breakdown::NotFinite`].
pub fn fill_from_nodes<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut [SVector<f64, D>],
    basis: &Basis,
    nodes: Places<D>,
    x: &[SVector<f64, D>],
) -> Result<(), Breakdown> {
    shape.clear();
    if let Basis::Lme { gamma, cutoff } = basis {
        // At least the nodes of a cell, however narrow the functions.
        let reach = support::radius(*gamma, *cutoff).max(1.0);
        scratch.bins.sort(nodes.x, nodes.h, if reach.is_finite() { reach } else { 1.0 });
    }
    for p in 0..x.len() {
        let row = match basis {
            Basis::Lme { gamma, cutoff } => {
                let reach = support::radius(*gamma, *cutoff).max(1.0);
                local_max_ent_row(shape, scratch, &mut lambda[p], *gamma, reach, nodes, &x[p])
            }
            _ => linear_row(shape, nodes.x, &x[p]).ok_or(Failure::OutsideHull),
        };
        row.map_err(|failure| match x[p].iter().all(|x| x.is_finite()) {
            true => Breakdown::NoBasis { particle: p, failure },
            false => Breakdown::NotFinite { particle: p, symbol: "position" },
        })?;
    }
    shape.count();
    Ok(())
}
// ANCHOR_END: scattered

/// The row of one particle: the search widens until its nodes enclose it.
fn local_max_ent_row<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut SVector<f64, D>,
    gamma: f64,
    mut reach: f64,
    Places { x: nodes, h }: Places<D>,
    x_p: &SVector<f64, D>,
) -> Result<(), Failure> {
    let Scratch { lme, nodes: seen, bins, cost } = scratch;
    let mut widenings = 0;
    *lambda = loop {
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
        match lme.evaluate(gamma, [*lambda, SVector::zeros()]) {
            Err(_) if widenings < WIDENINGS && seen.len() < nodes.len() => {
                widenings += 1;
                reach *= WIDER;
            }
            answer => break answer?,
        }
    };
    for ((a, N), grad) in seen.iter().zip(&lme.p).zip(&lme.grad) {
        shape.push(*a, *N, grad.component_div(h));
    }
    shape.end_row();
    Ok(())
}

/// The two nodes beside x_p, in 1D, where nodes stand in the order of their
/// numbers.
fn linear_row<const D: usize>(
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
