//! Evaluates p_I and h∇p_I of all nodes that a point sees, (35), and their limit on the hull.

use super::failure::Failure;
use super::seen::{Faces, Seen, fill_faces};
use super::weights::Weights;
use crate::method::continuum::law::{applied, outer};
use crate::method::cost::Cost;
use nalgebra::{SMatrix, SVector};

/// The sums of a row are right to this.
const RIGHT: f64 = 1e-10;

/// Nodes of one layer are as deep as the first, to this: turned axes round.
const LEVEL: f64 = 1e-12;

/// These are the shape functions at one point, an entry for each node that it sees.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Functions<const D: usize> {
    /// p_I, that is N_I.
    pub p: Vec<f64>,
    /// h ∇p_I.
    pub grad: Vec<SVector<f64, D>>,
    /// On a face: the nodes of the next layer, and q_I.
    layer: Vec<usize>,
    q: Vec<f64>,
    /// Exponential functions so far.
    pub cost: Cost,
}

// ANCHOR: lme_gradients
/// Spreads the weights at the solution λ over all nodes, with (35):
/// h∇p_I = −p_I J⁻¹ ξ_I, where J has r = 0.
///
/// Errors: [`Failure::OutsideHull`] where J has no inverse, or a face no layer behind it.
pub fn evaluate<const D: usize>(
    functions: &mut Functions<D>,
    seen: &Seen<D>,
    weights: &Weights,
    gamma: f64,
    lambda: &SVector<f64, D>,
) -> Result<(), Failure> {
    let Functions { p, grad, .. } = functions;
    let mut J = SMatrix::zeros();
    for (p_I, n) in weights.p.iter().zip(&seen.sharing) {
        J += outer(&seen.xi[*n], &seen.xi[*n]) * *p_I;
    }
    fill_faces(&mut J, &seen.faces);
    let mut inverse = J.try_inverse().ok_or(Failure::OutsideHull)?;
    p.clear();
    p.resize(seen.xi.len(), 0.0);
    grad.clear();
    grad.resize(seen.xi.len(), SVector::zeros());
    for (p_I, n) in weights.p.iter().zip(&seen.sharing) {
        p[*n] = *p_I;
        grad[*n] = -applied(&inverse, &seen.xi[*n]) * *p_I;
    }
    if let Some(node) = seen.on_node {
        let S = weigh_node(functions, seen, weights, node);
        if S > 1e-150 {
            inverse *= (1.0 + S) / S; // of the J of all that share
        }
    }
    let f = |xi: &SVector<f64, D>| lambda.dot(xi) - gamma * xi.dot(xi);
    for d in (0..D).filter(|d| seen.faces[*d] != 0.0) {
        slopes_inwards(functions, seen, &inverse, d, f)?;
    }
    Ok(())
}

/// Holds the row against Σ p_I = 1, Σ p_I ξ_I = 0, Σ h∇p_I = 0 and Σ ξ_I ⊗ h∇p_I = −1. With L,
/// the largest |ξ_I|, the second is divided by L and the third multiplied.
///
/// Errors: [`Failure::Inexact`].
pub fn check<const D: usize>(functions: &Functions<D>, seen: &Seen<D>) -> Result<(), Failure> {
    let L = seen.size();
    let (mut one, mut place) = (-1.0, SVector::<f64, D>::zeros());
    let (mut slope, mut identity) = (SVector::<f64, D>::zeros(), SMatrix::<f64, D, D>::identity());
    for ((p, grad), xi) in functions.p.iter().zip(&functions.grad).zip(&seen.xi) {
        one += *p;
        place += xi * *p;
        slope += *grad;
        identity += outer(xi, grad);
    }
    // A sum, since that keeps what is no number.
    let size = |all: &[f64]| all.iter().map(|x| libm::fabs(*x)).sum::<f64>();
    let error = libm::fabs(one)
        + size(place.as_slice()) / L
        + size(slope.as_slice()) * L
        + size(identity.as_slice());
    match error <= RIGHT {
        true => Ok(()),
        false => Err(Failure::Inexact { error }),
    }
}

/// Gives the node on which x lies its weight, and returns S.
///
/// The exponent of that node is 0, its exponential is 1. With S, the sum of the other
/// nodes' exponentials, its weight is 1/(1 + S); the weights of the others, which have added
/// up to 1, now add up to S/(1 + S). Their gradients stay as they are, since p_I and J
/// become smaller by the same factor.
fn weigh_node<const D: usize>(
    functions: &mut Functions<D>,
    seen: &Seen<D>,
    weights: &Weights,
    node: usize,
) -> f64 {
    let mut S = 0.0;
    if !seen.sharing.is_empty() {
        S = weights.Z * libm::exp(weights.largest);
        functions.cost.exponentials += 1;
    }
    seen.sharing.iter().for_each(|n| functions.p[*n] *= S / (1.0 + S));
    functions.p[node] = 1.0 / (1.0 + S);
    S
}

/// Sets the slopes along axis d, to which the face that x lies on is normal.
///
/// On a face only its nodes have weight, and J has no part normal to it.
/// One step δ inwards, the next layer of nodes takes the weight in
/// proportion to the distance, shared as q_I ∝ exp f_I along the face; the face's own
/// weights shrink, and shift so that Σ p_I ξ_I stays 0.
fn slopes_inwards<const D: usize>(
    functions: &mut Functions<D>,
    seen: &Seen<D>,
    inverse: &SMatrix<f64, D, D>,
    d: usize,
    f: impl Fn(&SVector<f64, D>) -> f64,
) -> Result<(), Failure> {
    let Functions { p, grad, layer, q, cost } = functions;
    let delta = next_layer(layer, &seen.xi, &seen.faces, d).ok_or(Failure::OutsideHull)?;
    let inwards = seen.faces[d];
    let along = |n: usize| {
        let mut xi = seen.xi[n];
        xi[d] = 0.0;
        xi
    };
    let largest = layer.iter().map(|n| f(&along(*n))).fold(f64::NEG_INFINITY, f64::max);
    q.clear();
    q.extend(layer.iter().map(|n| libm::exp(f(&along(*n)) - largest)));
    cost.exponentials += q.len() as u64;
    let Z: f64 = q.iter().sum();
    let mut mean = SVector::zeros();
    for (n, q) in layer.iter().zip(q) {
        mean += along(*n) * (*q / Z);
        grad[*n][d] = inwards * *q / Z / delta;
    }
    for n in seen.sharing.iter().chain(&seen.on_node) {
        let shrink = 1.0 + seen.xi[*n].dot(&(inverse * mean));
        grad[*n][d] = -inwards * p[*n] * shrink / delta;
    }
    Ok(())
}

/// Lists the nodes nearest to the face normal to axis d, of those that lie on the other
/// faces of x; returns their distance δ from it.
fn next_layer<const D: usize>(
    layer: &mut Vec<usize>,
    xi: &[SVector<f64, D>],
    faces: &Faces<D>,
    d: usize,
) -> Option<f64> {
    let behind = |xi: &SVector<f64, D>| {
        xi[d] != 0.0 && (0..D).all(|e| e == d || faces[e] == 0.0 || xi[e] == 0.0)
    };
    layer.clear();
    layer.extend((0..xi.len()).filter(|n| behind(&xi[*n])));
    let delta = layer.iter().map(|n| libm::fabs(xi[*n][d])).fold(f64::INFINITY, f64::min);
    layer.retain(|n| libm::fabs(xi[*n][d]) - delta <= LEVEL * delta);
    (delta != f64::INFINITY).then_some(delta)
}
// ANCHOR_END: lme_gradients
