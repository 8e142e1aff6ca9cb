//! Quadratic B-splines are centred at the nodes and corrected at the ends of the grid (the
//! extension that the paper names, its reference 18), D = 1, 2, 3.

use super::tensor::Axis;
use crate::method::continuum::shape::Factor;

// ANCHOR: bspline
/// Gives N and dN/dξ of the quadratic B-spline with knots at ±½ and ±3/2, ξ = (x − x_I)/h.
pub fn quadratic(xi: f64) -> (f64, f64) {
    let (distance, sign) = (libm::fabs(xi), if xi < 0.0 { -1.0 } else { 1.0 });
    if distance <= 0.5 {
        (0.75 - xi * xi, -2.0 * xi)
    } else if distance < 1.5 {
        let foot = 1.5 - distance;
        (0.5 * foot * foot, -sign * foot)
    } else {
        (0.0, 0.0)
    }
}

/// Makes the functions of one axis with `cells` cells: the nearest node and its neighbours.
///
/// Within half a cell of an end of the grid one neighbour is missing. Its part
/// is carried by linear extrapolation, 2 to the end node and −1 to the next,
/// which keeps ΣN = 1 and ΣN x = x. What is left there is 1 − ξ and ξ: the end
/// node interpolates, so that a fixed end is fixed by its own node.
pub fn axis(cell: usize, cells: usize, xi: f64, h: f64) -> Axis {
    let nearest = if xi < 0.5 { cell } else { cell + 1 };
    if nearest == 0 || nearest == cells {
        let mut axis = Axis::from(cell);
        for Factor { N, slope } in super::linear::factors(xi, 1.0 / h) {
            axis.push(N, slope);
        }
        return axis;
    }
    let from_nearest = xi - (nearest - cell) as f64;
    let mut axis = Axis::from(nearest - 1);
    for offset in [-1.0, 0.0, 1.0] {
        let (N, slope) = quadratic(from_nearest - offset);
        axis.push(N, slope / h);
    }
    axis
}
// ANCHOR_END: bspline
