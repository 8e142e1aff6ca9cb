//! Piecewise linear shape functions of the grid's cells, D = 1, 2, 3.
#![allow(non_snake_case)]

use crate::continuum::shape::Shape;
use crate::grid::Grid;
use nalgebra::SVector;

// ANCHOR: linear
/// One row of the table: the 2^D corners of the cell that holds x_p.
///
/// Along each axis N = 1 − ξ at the lower corner and ξ at the upper one, with
/// ξ = (x − x_I) / h in the cell; in D dimensions N_Ip is their product, and
/// ∂N_Ip/∂x_d replaces factor d by ∓1/h_d. On a face the gradient is that of
/// the cell above. `None` when x_p is outside the grid.
pub fn row<const D: usize>(
    shape: &mut Shape<D>,
    grid: &Grid<D>,
    x_p: &SVector<f64, D>,
) -> Option<()> {
    let at = grid.locate(x_p)?;
    for corner in 0..Grid::<D>::CORNERS {
        let upper = Grid::<D>::corner(corner);
        let I = grid.node(std::array::from_fn(|d| at.cell[d] + upper[d]));
        let factor = |d: usize| if upper[d] == 1 { at.xi[d] } else { 1.0 - at.xi[d] };
        let slope = |d: usize| if upper[d] == 1 { 1.0 } else { -1.0 } / grid.h[d];
        let N_Ip = (0..D).map(factor).product();
        let grad_N_Ip = SVector::from_fn(|i, _| {
            (0..D).map(|d| if d == i { slope(d) } else { factor(d) }).product()
        });
        shape.push(I, N_Ip, grad_N_Ip);
    }
    Some(())
}
// ANCHOR_END: linear
