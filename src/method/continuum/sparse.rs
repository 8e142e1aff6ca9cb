//! Sparse symmetric matrices of nodes that share particles: their pattern and Cholesky factors.

use super::shape::Shape;
use nalgebra_sparse::factorization::{CscCholesky, CscSymbolicCholesky};
use nalgebra_sparse::pattern::SparsityPattern;

/// A pivot below this share of its diagonal entry counts as zero.
const SINGULAR: f64 = 1e-12;

/// Lists which of `nodes` nodes share a particle; every node shares one with itself.
pub fn coupled<const D: usize>(shape: &Shape<D>, nodes: usize) -> SparsityPattern {
    let mut coupled: Vec<Vec<usize>> = (0..nodes).map(|I| vec![I]).collect();
    for (I, p, _, _) in shape.pairs() {
        let list = &mut coupled[I];
        for (J, _, _) in shape.of(p) {
            if list.len() == list.capacity() {
                // So that it takes twice what the pattern does at most.
                list.sort_unstable();
                list.dedup();
                list.reserve_exact(list.len());
            }
            list.push(J);
        }
    }
    pattern_of(&mut coupled)
}

/// Makes the pattern of a square matrix from the rows of each column.
pub fn pattern_of(columns: &mut [Vec<usize>]) -> SparsityPattern {
    let (mut offsets, mut indices) = (vec![0], Vec::new());
    for list in columns.iter_mut() {
        list.sort_unstable();
        list.dedup();
        indices.append(list);
        offsets.push(indices.len());
    }
    let n = columns.len();
    // Sorted and without doubles: this cannot fail.
    SparsityPattern::try_from_offsets_and_indices(n, n, offsets, indices)
        .unwrap_or_else(|_| SparsityPattern::zeros(n, n))
}

/// Finds the place of entry (I, J) among the values of a matrix with this pattern.
pub fn place(pattern: &SparsityPattern, I: usize, J: usize) -> Option<usize> {
    pattern.lane(J).binary_search(&I).ok().map(|n| pattern.major_offsets()[J] + n)
}

/// Finds the place of the entry (I, J) among the values of a matrix with this pattern, which may
/// be `next`.
#[inline(always)]
pub fn place_from(next: usize, pattern: &SparsityPattern, I: usize, J: usize) -> Option<usize> {
    let is_next = next < pattern.major_offsets()[J + 1] && pattern.minor_indices()[next] == I;
    if is_next { Some(next) } else { place(pattern, I, J) }
}

/// Factorises a symmetric matrix of this pattern, by the `last` factor of the same pattern if
/// there is one; `None` when a pivot is zero or below.
pub fn factorise(
    last: Option<CscCholesky<f64>>,
    pattern: &SparsityPattern,
    values: &[f64],
) -> Option<CscCholesky<f64>> {
    let factor = match last {
        Some(mut factor) => factor.refactor(values).map(|()| factor),
        None => {
            let symbolic = CscSymbolicCholesky::factor(pattern.clone());
            CscCholesky::factor_numerical(symbolic, values)
        }
    };
    let factor = factor.ok()?;
    for J in 0..pattern.major_dim() {
        let entry = place(pattern, J, J).map_or(0.0, |k| values[k]);
        let pivot = factor.l().col(J).values()[0];
        if pivot * pivot < SINGULAR * entry {
            return None;
        }
    }
    Some(factor)
}
