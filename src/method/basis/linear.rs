//! Linear shape functions belong to the corners of the grid's cells, D = 1, 2, 3.

use crate::method::continuum::shape::Factor;

// ANCHOR: linear
/// Makes the functions of one axis: N = 1 − ξ at the lower node of the cell and ξ at the upper
/// one, with ξ = (x − x_I)/h of the lower node; slopes ∓`slope`, which is 1/h. A particle sees
/// the 2^D corners of its cell. On a face the slope is that of the cell above.
#[inline(always)]
pub fn factors(xi: f64, slope: f64) -> [Factor; 2] {
    [Factor { N: 1.0 - xi, slope: -slope }, Factor { N: xi, slope }]
}
// ANCHOR_END: linear
