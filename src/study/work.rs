//! The work of a run is counted: so many of each kind, times the instructions that one takes.

use crate::method::cost::Cost;

// ANCHOR: weights
/// Gives the work of a run (instructions, of 64-bit x86 and an optimised build), estimated from its
/// counters alone. A consistent matrix has as many entries to add up as its pairs have pairs, and
/// each of its solutions goes through all particles' nodes; a tangent of an implicit step goes
/// through all pairs of its table.
///
/// The weights come from a fit to the runs in `data/instructions/work.csv`, which the book's chapter
/// "Accuracy against cost" describes. Four of five are met to a fifth, the worst one to two thirds.
///
/// Test: `work_is_near_to_instructions` in `tests/verdicts.rs`.
pub fn work(cost: &Cost) -> f64 {
    let [steps, rows, pairs] =
        [cost.steps, cost.basis_evaluations, cost.particle_node_pairs].map(|count| count as f64);
    let matrix = if cost.factorizations > 0 { pairs * pairs / rows.max(1.0) } else { 0.0 };
    let tangents = cost.tangents as f64 * pairs / steps.max(1.0);
    let solves = cost.solves as f64 * rows / steps.max(1.0);
    700.0 * steps
        + 430.0 * rows
        + 140.0 * pairs
        + 310.0 * cost.newton_iterations as f64
        + 280.0 * cost.candidates as f64
        + 66.0 * matrix
        + 330.0 * solves
        + 330.0 * cost.filtered_stresses as f64
        + 1500.0 * cost.fitted_stresses as f64
        + 1100.0 * tangents
}
// ANCHOR_END: weights
