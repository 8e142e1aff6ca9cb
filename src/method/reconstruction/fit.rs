//! Least squares with polynomials, by columns that are made orthogonal one after the other.

use nalgebra::{SMatrix, SVector};

/// A column that is so small a share of what it was depends on those before it (squared).
const DEPENDENT: f64 = 1e-16;

/// A sample has a place (–), a weight (–), and a value.
pub type Sample<const D: usize> = (SVector<f64, D>, f64, SMatrix<f64, D, D>);

/// A list of polynomials gives their values at a place.
pub type Polynomials<const D: usize> = dyn Fn(&SVector<f64, D>) -> Vec<f64>;

// ANCHOR: fit
/// Gives at `places` the sum of `polynomials` whose weighted squared distance from `samples` is
/// least.
///
/// Each polynomial is made orthogonal to those before it, in the scalar product ⟨a, b⟩ = Σ_p w_p
/// a(x_p) b(x_p): q ← q − ⟨q_k, q⟩/⟨q_k, q_k⟩ q_k. The fit is Σ_k q_k ⟨q_k, σ⟩/⟨q_k, q_k⟩. One that
/// the samples cannot tell from those before it is left out, so that n particles in one
/// dimension have at most the degree n − 1.
pub fn least_squares<const D: usize>(
    samples: &[Sample<D>],
    places: &[SVector<f64, D>],
    polynomials: &Polynomials<D>,
) -> Vec<SMatrix<f64, D, D>> {
    // A column has the values of one polynomial at the samples and then at the places.
    let all = samples.iter().map(|(x, _, _)| x).chain(places);
    let rows: Vec<Vec<f64>> = all.map(polynomials).collect();
    let dot = |a: &[f64], b: &[f64]| -> f64 {
        samples.iter().zip(a).zip(b).map(|(((_, w, _), a), b)| w * a * b).sum()
    };
    let mut fitted = vec![SMatrix::zeros(); places.len()];
    let mut kept: Vec<(Vec<f64>, f64)> = Vec::new();
    for k in 0..rows.first().map_or(0, Vec::len) {
        let mut q: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        let whole = dot(&q, &q);
        for _ in 0..2 {
            // The second time takes off the round-off of the first.
            for (q_k, square) in &kept {
                let share = dot(q_k, &q) / square;
                q.iter_mut().zip(q_k).for_each(|(q, q_k)| *q -= share * q_k);
            }
        }
        let square = dot(&q, &q);
        if square.is_nan() || square <= DEPENDENT * whole {
            continue;
        }
        let mut along = SMatrix::<f64, D, D>::zeros();
        for ((_, w, sigma), q) in samples.iter().zip(&q) {
            along += sigma * (w * q / square);
        }
        for (fitted, q) in fitted.iter_mut().zip(&q[samples.len()..]) {
            *fitted += along * *q;
        }
        kept.push((q, square));
    }
    fitted
}
// ANCHOR_END: fit
