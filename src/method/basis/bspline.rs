//! Quadratic and cubic B-splines are centred at the nodes and corrected at the ends of the grid
//! (the extension that the paper names, its reference 18), D = 1, 2, 3.

use super::tensor::Axis;
use crate::method::continuum::shape::Factor;
use crate::method::grid::{Grid, Located};

/// B-splines have one of two degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Degree {
    /// Parabolas, with one continuous derivative.
    Quadratic,
    /// Cubic functions, with two.
    Cubic,
}

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

/// Makes the functions of each axis.
pub fn axes<const D: usize>(degree: Degree, at: &Located<D>, grid: &Grid<D>) -> [Axis; D] {
    let axis = match degree {
        Degree::Quadratic => quadratic_axis,
        Degree::Cubic => cubic_axis,
    };
    std::array::from_fn(|d| axis(at.cell[d], grid.cells[d], at.xi[d], grid.h[d]))
}

/// Makes the quadratic functions of one axis with `cells` cells: the nearest node and its
/// neighbours.
///
/// Within half a cell of an end of the grid one neighbour is missing. Its part
/// is carried by linear extrapolation, 2 to the end node and −1 to the next,
/// which keeps ΣN = 1 and ΣN x = x. What is left there is 1 − ξ and ξ: the end
/// node interpolates, so that a fixed end is fixed by its own node.
fn quadratic_axis(cell: usize, cells: usize, xi: f64, h: f64) -> Axis {
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

// ANCHOR: cubic
/// Gives N and dN/dξ of the cubic B-spline with knots at 0, ±1 and ±2, ξ = (x − x_I)/h.
pub fn cubic(xi: f64) -> (f64, f64) {
    let (distance, sign) = (libm::fabs(xi), if xi < 0.0 { -1.0 } else { 1.0 });
    if distance <= 1.0 {
        let square = distance * distance;
        (2.0 / 3.0 - square + 0.5 * square * distance, sign * (1.5 * square - 2.0 * distance))
    } else if distance < 2.0 {
        let foot = 2.0 - distance;
        (foot * foot * foot / 6.0, -sign * 0.5 * foot * foot)
    } else {
        (0.0, 0.0)
    }
}
// ANCHOR_END: cubic

// ANCHOR: cubic_axis
/// Makes the cubic functions of one axis with `cells` cells: the two nodes of the cell and one on
/// either side.
///
/// In the first and the last cell one of these is missing, and its part is carried as with the
/// quadratic ones. A sum Σ N_I q_I is then a natural spline: it is q at the end node, and its
/// second derivative is 0 there.
fn cubic_axis(cell: usize, cells: usize, xi: f64, h: f64) -> Axis {
    let mut values = [-1.0, 0.0, 1.0, 2.0].map(|offset| cubic(xi - offset));
    let carry = |values: &mut [(f64, f64); 4], [missing, end, next]: [usize; 3]| {
        let (N, slope) = values[missing];
        values[end] = (values[end].0 + 2.0 * N, values[end].1 + 2.0 * slope);
        values[next] = (values[next].0 - N, values[next].1 - slope);
    };
    let (lowest, highest) = (cell == 0, cell + 1 == cells);
    if lowest {
        carry(&mut values, [0, 1, 2]);
    }
    if highest {
        carry(&mut values, [3, 2, 1]);
    }
    let present = &values[usize::from(lowest)..4 - usize::from(highest)];
    let mut axis = Axis::from(cell + usize::from(lowest) - 1);
    for (N, slope) in present {
        axis.push(*N, slope / h);
    }
    axis
}
// ANCHOR_END: cubic_axis
