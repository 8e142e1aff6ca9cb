//! Says where the particles of a cell stand at the start, and how much of it each one holds.

use super::choice::Method;

// ANCHOR: points
/// Lists the `n` points of a cell along one axis: place (0 to 1) and length (in units of the
/// cell). MPM: equal distances. OTM: Gauss's points, 1 to 4, which integrate polynomials up to
/// the degree 2n − 1.
pub fn points(method: Method, n: usize) -> Vec<[f64; 2]> {
    match (method, n) {
        (Method::Mpm(_), _) | (_, 1) => {
            (0..n).map(|k| [(k as f64 + 0.5) / n as f64, 1.0 / n as f64]).collect()
        }
        (Method::Otm(_), _) => {
            gauss(n).into_iter().map(|[r, w]| [0.5 + 0.5 * r, 0.5 * w]).collect()
        }
    }
}

/// Lists `n` of Gauss's points, 1 to 4: place (−1 to 1) and weight, whose sum is 2.
pub fn gauss(n: usize) -> Vec<[f64; 2]> {
    match n {
        1 => vec![[0.0, 2.0]],
        2 => {
            let r = 1.0 / libm::sqrt(3.0);
            vec![[-r, 1.0], [r, 1.0]]
        }
        3 => {
            let r = libm::sqrt(0.6);
            vec![[-r, 5.0 / 9.0], [0.0, 8.0 / 9.0], [r, 5.0 / 9.0]]
        }
        _ => {
            let (middle, spread) = (3.0 / 7.0, 2.0 / 7.0 * libm::sqrt(1.2));
            let (near, far) = (libm::sqrt(middle - spread), libm::sqrt(middle + spread));
            let share = libm::sqrt(30.0) / 36.0;
            let (large, small) = (0.5 + share, 0.5 - share);
            vec![[-far, small], [-near, large], [near, large], [far, small]]
        }
    }
}
// ANCHOR_END: points
