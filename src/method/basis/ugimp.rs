//! GIMP averages linear shape functions over a particle's domain (Bardenhagen & Kober 2004), which
//! keeps its size (uGIMP) or stretches with the particle, D = 1, 2, 3.

use super::tensor::Axis;
use crate::method::breakdown::Breakdown;
use crate::method::grid::{Grid, Located};
use nalgebra::SVector;

// ANCHOR: ugimp
/// Gives N and dN/dξ of the hat 1 − |ξ| averaged over [ξ − l, ξ + l], with ξ = (x − x_I)/h and
/// l = l_p/h, 0 < l ≤ 1.
///
/// It is a parabola over the node, |ξ| < l; then the hat's own flank; then a parabola at its
/// foot, up to |ξ| = 1 + l. A domain longer than a cell, l > ½, may hold the node and reach
/// beyond the hat, |ξ| > 1 − l, and has no flank. The slope is continuous.
pub fn averaged_hat(xi: f64, l: f64) -> (f64, f64) {
    let (distance, sign) = (libm::fabs(xi), if xi < 0.0 { -1.0 } else { 1.0 });
    if distance < l && distance + l > 1.0 {
        let left = 1.0 + distance - l; // the hat at the end that is beyond the node
        ((1.0 - 0.5 * left * left) / (2.0 * l), -sign * left / (2.0 * l))
    } else if distance < l {
        (1.0 - (xi * xi + l * l) / (2.0 * l), -xi / l)
    } else if distance <= 1.0 - l {
        (1.0 - distance, -sign)
    } else if distance < 1.0 + l {
        let foot = 1.0 + l - distance;
        (foot * foot / (4.0 * l), -sign * foot / (2.0 * l))
    } else {
        (0.0, 0.0)
    }
}

/// Makes the functions of each axis; `None` when the particle reaches beyond the grid, where
/// a node is missing and ΣN would fall below 1.
pub fn axes<const D: usize>(
    at: &Located<D>,
    grid: &Grid<D>,
    half_length: [f64; 3],
) -> Option<[Axis; D]> {
    let mut axes = [Axis::default(); D];
    for d in 0..D {
        axes[d] = axis(at.cell[d], grid.cells[d], at.xi[d], half_length[d], grid.h[d])?;
    }
    Some(axes)
}

/// Makes the functions of one axis with `cells` cells: the two to four nodes whose averaged
/// hat is not zero, if the grid has them.
fn axis(cell: usize, cells: usize, xi: f64, l: f64, h: f64) -> Option<Axis> {
    let mut axis = None;
    for offset in -1..=2 {
        let (N, slope) = averaged_hat(xi - offset as f64, l);
        if N > 0.0 {
            let node = cell.checked_add_signed(offset).filter(|node| *node <= cells)?;
            axis.get_or_insert(Axis::from(node)).push(N, slope / h);
        }
    }
    axis
}
// ANCHOR_END: ugimp

// ANCHOR: domain
/// A domain may be at most so many cells long: two, over which a particle sees four nodes.
const LONGEST: f64 = 2.0;

/// Gives l of particle p along each axis: what it was at the start times the particle's
/// `stretch`, where it has one.
///
/// Errors: [`Breakdown::Domain`] where 2l is not above 0 and at most 2 cells.
pub fn stretched<const D: usize>(
    p: usize,
    half_length: [f64; 3],
    stretch: &[SVector<f64, D>],
) -> Result<[f64; 3], Breakdown> {
    let mut l = half_length;
    let Some(stretch) = stretch.get(p) else { return Ok(l) };
    for d in 0..D {
        l[d] *= stretch[d];
        let cells = 2.0 * l[d];
        if !(cells > 0.0 && cells <= LONGEST) {
            return Err(Breakdown::Domain { particle: p, axis: d, cells });
        }
    }
    Ok(l)
}
// ANCHOR_END: domain
