//! Takes local max-ent on nodes that stand anywhere: in a list, or, for the table of OTM, where
//! they move.

use super::anisotropic::Metric;
use super::kind::Basis;
use super::lme::{Failure, Lme, max_ent_row_in};
use super::scratch::Scratch;
use super::support::{Width, radius};
use crate::method::breakdown::Breakdown;
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::Multiplier;
use nalgebra::{SMatrix, SVector};

/// The search radius of a particle that its nodes do not enclose is widened as often, each time
/// by this factor.
const WIDENINGS: usize = 6;
const WIDER: f64 = 1.5;

/// Places tell where the nodes stand.
#[derive(Clone, Copy)]
pub struct Places<'a, const D: usize> {
    /// (m).
    pub x: &'a [SVector<f64, D>],
    /// h of γ = βh² (m), the spacing at the start.
    pub h: &'a SVector<f64, D>,
}

/// Particles are carried by the nodes: this says where they stand and, where their metric goes with
/// the material, how that has deformed.
#[derive(Clone, Copy)]
pub struct Carried<'a, const D: usize> {
    /// x_p (m).
    pub x: &'a [SVector<f64, D>],
    /// A_p of the metric (–); empty where it stays as it was.
    pub pull: &'a [SMatrix<f64, D, D>],
}

/// Fills the table of particles at `x` (m) whose metric stays as it was: [`fill_in_metric`].
pub fn fill_from_nodes<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut [Multiplier<D>],
    basis: &Basis,
    nodes: Places<D>,
    x: &[SVector<f64, D>],
) -> Result<(), Breakdown> {
    fill_in_metric(shape, scratch, lambda, basis, nodes, Carried { x, pull: &[] })
}

// ANCHOR: scattered
/// Fills the table with N_ap (–) and ∇N_ap (1/m) of `nodes` for particles at `x` (m); `lambda` starts the search for each particle's λ h, and holds what was found.
///
/// Of local max-ent a particle sees the nodes within R. Where they do not enclose
/// it, as when the body is stretched, R is widened. The linear basis, in 1D only,
/// sees the two nodes beside it.
///
/// Errors: the first particle that cannot be served, [`Breakdown::NoBasis`] or
/// [`Breakdown::NotFinite`].
pub fn fill_in_metric<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut [Multiplier<D>],
    basis: &Basis,
    nodes: Places<D>,
    Carried { x, pull }: Carried<D>,
) -> Result<(), Breakdown> {
    shape.clear([0; D]);
    // At least the nodes of a cell, however narrow the functions.
    let width = basis.width().map(|width| Width { reach: width.reach.max(1.0), ..width });
    if let Some(Width { reach, .. }) = width {
        scratch.bins.sort(nodes.x, nodes.h, if reach.is_finite() { reach } else { 1.0 });
    }
    for p in 0..x.len() {
        let row = match width {
            Some(width) => {
                let seen_from = (&x[p], Metric { h: nodes.h, A: pull.get(p) });
                row_among_nodes(shape, scratch, &mut lambda[p].lambda, width, nodes.x, seen_from)
            }
            None => linear_row(shape, nodes.x, &x[p]),
        };
        row.map_err(|failure| match x[p].iter().all(|x| x.is_finite()) {
            true => Breakdown::NoBasis { particle: p, failure },
            false => Breakdown::NotFinite { particle: p, symbol: "position" },
        })?;
        shape.end_list();
    }
    Ok(())
}

/// Writes the row of one particle: the search widens until its nodes enclose it.
fn row_among_nodes<const D: usize>(
    shape: &mut Shape<D>,
    scratch: &mut Scratch<D>,
    lambda: &mut SVector<f64, D>,
    Width { gamma, mut reach }: Width,
    nodes: &[SVector<f64, D>],
    (x_p, metric): (&SVector<f64, D>, Metric<D>),
) -> Result<(), Failure> {
    let Scratch { lme, bins, cost, .. } = scratch;
    let place = x_p.component_div(metric.h);
    let mut widenings = 0;
    *lambda = loop {
        let half_width = metric.half_width(reach).ok_or(Failure::OutsideHull)?;
        let near = bins.near(&place, half_width);
        see(lme, nodes, (x_p, metric), reach, near.inspect(|_| cost.candidates += 1));
        match max_ent_row_in(shape, lme, gamma, metric, [*lambda, SVector::zeros()]) {
            Err(_) if widenings < WIDENINGS && lme.nodes() < nodes.len() => {
                widenings += 1;
                reach *= WIDER;
            }
            answer => break answer?,
        }
    };
    Ok(())
}
// ANCHOR_END: scattered

/// Shows to `lme` those of the nodes `near` that are within `reach` = R/h of x, with offsets
/// from the nearest.
fn see<const D: usize>(
    lme: &mut Lme<D>,
    nodes: &[SVector<f64, D>],
    (x, metric): (&SVector<f64, D>, Metric<D>),
    reach: f64,
    near: impl Iterator<Item = usize>,
) {
    lme.clear(false);
    let (mut nearest, mut least) = (0, f64::INFINITY);
    for a in near {
        let xi = metric.xi(x - nodes[a]);
        let square = xi.dot(&xi);
        if square <= reach * reach {
            lme.push(a, xi, SVector::zeros());
            if square < least {
                (nearest, least) = (a, square);
            }
        }
    }
    lme.set_offsets(|a| metric.xi(nodes[nearest] - nodes[a]));
}

/// These are the values at a point, for each node that it sees: node, N (–) and ∇N (1/m).
pub type NodeValues<const D: usize> = Vec<(usize, f64, SVector<f64, D>)>;

/// Evaluates local max-ent at one point among a list of nodes: those within R of x, as
/// (node, N, ∇N), and λ (1/m).
///
/// `spacing` is the h (m) of γ = βh². Errors: [`Failure`].
pub fn values_at<const D: usize>(
    nodes: &[SVector<f64, D>],
    spacing: f64,
    gamma: f64,
    cutoff: f64,
    x: &SVector<f64, D>,
) -> Result<(NodeValues<D>, SVector<f64, D>), Failure> {
    let h = &SVector::repeat(spacing);
    values_in(nodes, Metric { h, A: None }, gamma, cutoff, x)
}

/// Evaluates it in a metric: those nodes count that are within R of x by the metric's measure.
///
/// Errors: [`Failure`].
pub fn values_in<const D: usize>(
    nodes: &[SVector<f64, D>],
    metric: Metric<D>,
    gamma: f64,
    cutoff: f64,
    x: &SVector<f64, D>,
) -> Result<(NodeValues<D>, SVector<f64, D>), Failure> {
    if nodes.iter().chain([x]).any(|place| place.iter().any(|x| !x.is_finite())) {
        return Err(Failure::NotFinite);
    }
    let (mut lme, mut shape) = (Lme::default(), Shape::default());
    see(&mut lme, nodes, (x, metric), radius(gamma, cutoff), 0..nodes.len());
    let lambda = max_ent_row_in(&mut shape, &mut lme, gamma, metric, [SVector::zeros()])?;
    shape.end_list();
    Ok((shape.of(0).collect(), metric.gradient(&lambda)))
}

/// Writes the row of the two nodes beside x_p, in 1D, where nodes stand in the order of
/// their numbers.
///
/// Errors: [`Failure::OutsideHull`].
fn linear_row<const D: usize>(
    shape: &mut Shape<D>,
    nodes: &[SVector<f64, D>],
    x_p: &SVector<f64, D>,
) -> Result<(), Failure> {
    let after = nodes.partition_point(|x| x[0] <= x_p[0]).clamp(1, nodes.len() - 1);
    let (low, high) = (nodes[after - 1][0], nodes[after][0]);
    let xi = (x_p[0] - low) / (high - low);
    if !(0.0..=1.0).contains(&xi) {
        return Err(Failure::OutsideHull);
    }
    let slope = SVector::repeat(1.0 / (high - low));
    shape.push(after - 1, 1.0 - xi, -slope);
    shape.push(after, xi, slope);
    Ok(())
}
