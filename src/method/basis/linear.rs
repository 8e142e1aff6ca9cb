//! Linear shape functions belong to the corners of the grid's cells, D = 1, 2, 3.

use super::tensor::Line;

// ANCHOR: linear
/// Makes the line of one axis: N = 1 − ξ at the lower node of the cell and ξ at the upper one,
/// with ξ = (x − x_I)/h of the lower node; slopes ∓1/h. A particle sees the 2^D corners of its
/// cell. On a face the slope is that of the cell above.
pub fn line(cell: usize, xi: f64, h: f64) -> Line {
    let mut line = Line::default();
    line.push(cell, 1.0 - xi, -1.0 / h);
    line.push(cell + 1, xi, 1.0 / h);
    line
}
// ANCHOR_END: linear
