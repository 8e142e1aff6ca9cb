//! Near a slanted side of the hull the weights show the axes along which nothing cancels.
//!
//! At the distance d (h) from a side the condition r = 0 is about terms of size d, made from
//! coordinates that are rounded at 1e-16: ∇p_I would be off by 1e-16/d. If one axis is normal
//! to the side, the nodes of the side have the coordinate 0 along it, all other terms are of
//! size d, and r and J are right relative to d. A rotation leaves (31)-(37) as they are.
//!
//! No side is looked for: it is where the weights are.

use super::failure::Failure;
use super::functions::{Functions, check, evaluate};
use super::search::find_lambda;
use super::seen::{Seen, share};
use super::weights::Weights;
use nalgebra::{SMatrix, SVector};

/// So far on its way to the mean of its nodes a point is served well enough along the given
/// axes that its weights show the side.
const ROUGHLY: f64 = 1e-7;

/// A point that rounding leaves on the hull, or beyond it, is moved on that way as little as
/// helps.
const INWARDS: [f64; 4] = [0.0, 1e-15, 1e-13, 1e-11];

/// Nodes this near to a line or plane (in units of the largest |ξ|) are on it.
const FLAT: f64 = 1e-12;

/// A coordinate of the point relative to a node is rounded at this, relative to the largest.
const ROUNDED: f64 = 1e-15;

/// Nodes without weight choose axes as if they had this.
const LEAST: f64 = 1e-30;

/// This holds the nodes that a point sees along other axes, and the weights that choose these.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Turned<const D: usize> {
    seen: Seen<D>,
    p: Vec<f64>,
}

// ANCHOR: lme_turned
/// Finds λ h (–), p_I and h∇p_I along the axes of `seen`.
///
/// Errors: [`Failure`]; of what is not right, [`Failure::Inexact`].
pub fn solve<const D: usize>(
    functions: &mut Functions<D>,
    weights: &mut Weights,
    seen: &mut Seen<D>,
    gamma: f64,
    starts: impl IntoIterator<Item = SVector<f64, D>>,
) -> Result<SVector<f64, D>, Failure> {
    share(seen)?;
    let lambda = find_lambda(weights, seen, gamma, starts)?;
    evaluate(functions, seen, weights, gamma, &lambda)?;
    check(functions, seen)?;
    Ok(lambda)
}

/// Finds λ h (–), p_I and h∇p_I along axes that follow the weights.
///
/// Errors: [`Failure::OutsideHull`], of a point outside by more than rounding; or what is
/// wrong along the last axes.
pub fn solve_turned<const D: usize>(
    Turned { seen: turned, p }: &mut Turned<D>,
    functions: &mut Functions<D>,
    weights: &mut Weights,
    seen: &Seen<D>,
    gamma: f64,
) -> Result<SVector<f64, D>, Failure> {
    if seen.I.is_empty() {
        return Err(Failure::OutsideHull);
    }
    let zero = SVector::zeros();
    let mean = seen.xi.iter().sum::<SVector<f64, D>>() / seen.xi.len() as f64;
    turn(turned, seen, &SMatrix::identity(), (None, mean * ROUGHLY));
    let mut answer = solve(functions, weights, turned, gamma, [zero]);
    let lambda = match answer {
        Err(Failure::OutsideHull) => return answer,
        _ => answer.unwrap_or(zero),
    };
    show_weights(p, weights, turned);
    for inwards in INWARDS {
        let (Q, b) = axes(seen, p).ok_or(Failure::OutsideHull)?;
        turn(turned, seen, &Q, (Some(b), mean * inwards));
        answer = solve(functions, weights, turned, gamma, [Q * lambda, zero]).and_then(|found| {
            functions.grad.iter_mut().for_each(|grad| *grad = Q.transpose() * *grad);
            check(functions, seen).map(|()| Q.transpose() * found)
        });
        match answer {
            Ok(_) => break,
            Err(Failure::Inexact { .. }) => show_weights(p, weights, turned),
            Err(_) => {}
        }
    }
    answer
}

/// Gives the rotation Q, whose rows are the axes, and the node b from which they start, that
/// of most weight. `None` if the nodes span no volume.
///
/// The first axis goes to the node that counts most by p_I |a_I|²; each further one to the
/// node that counts most by what is off the axes before. So the last one is normal to the
/// side that holds the weights.
fn axes<const D: usize>(seen: &Seen<D>, p: &[f64]) -> Option<(SMatrix<f64, D, D>, usize)> {
    let nodes = 0..p.len();
    let b = nodes.clone().max_by(|m, n| p[*m].total_cmp(&p[*n]))?;
    let flat = FLAT * seen.size();
    let mut Q = SMatrix::<f64, D, D>::zeros();
    let off_axes = |Q: &SMatrix<f64, D, D>, a: SVector<f64, D>| a - Q.transpose() * (Q * a);
    for k in 0..D {
        let (mut axis, mut most) = (None, 0.0);
        for n in nodes.clone() {
            let off = off_axes(&Q, seen.offset[n] - seen.offset[b]);
            let counts = p[n].max(LEAST) * off.dot(&off);
            if off.amax() > flat && counts > most {
                (axis, most) = (Some(off), counts);
            }
        }
        let axis = unit(off_axes(&Q, unit(axis?))); // twice, since the first time rounds
        Q.set_row(k, &axis.transpose());
    }
    Some((Q, b))
}

/// Fills `turned` with the nodes of `seen` along the axes Q from node b, or along the given ones,
/// and with the point moved by `inwards` (h).
fn turn<const D: usize>(
    turned: &mut Seen<D>,
    seen: &Seen<D>,
    Q: &SMatrix<f64, D, D>,
    (b, inwards): (Option<usize>, SVector<f64, D>),
) {
    turned.clear(false);
    turned.base = b;
    let (flat, b) = (FLAT * seen.size(), b.unwrap_or(0));
    let unless = |least: f64| move |y: f64| if libm::fabs(y) <= least { 0.0 } else { y };
    let xi_b = (Q * seen.xi[b]).map(unless(ROUNDED * seen.xi[b].amax())) - Q * inwards;
    for n in 0..seen.I.len() {
        let offset = (Q * (seen.offset[n] - seen.offset[b])).map(unless(flat));
        turned.push(seen.I[n], xi_b + offset, offset);
    }
}

/// Sets p_I of all nodes; a node on which the point lies has most.
fn show_weights<const D: usize>(p: &mut Vec<f64>, weights: &Weights, seen: &Seen<D>) {
    p.clear();
    p.resize(seen.I.len(), 0.0);
    for (p_I, n) in weights.p.iter().zip(&seen.sharing) {
        p[*n] = *p_I;
    }
    if let Some(n) = seen.on_node {
        p[n] = 1.0;
    }
}
// ANCHOR_END: lme_turned

/// Gives a/|a|.
fn unit<const D: usize>(a: SVector<f64, D>) -> SVector<f64, D> {
    a / libm::sqrt(a.dot(&a))
}
