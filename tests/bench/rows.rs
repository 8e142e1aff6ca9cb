//! The rows of the table of a whole time step.

use crate::cases::{CASES, scene, warm};
use lme_mpm::method::model::{Model, State};

/// What a table holds for each particle: nodes that it sees, and bytes.
pub fn pairs_and_bytes<const D: usize>(state: &State<D>) -> (f64, f64) {
    let particles = state.particle.len() as f64;
    (state.shape.len() as f64 / particles, state.shape.bytes() as f64 / particles)
}

// ANCHOR: bytes_moved
/// The bytes that a time step must at least read or write for each particle, if the nodes stay
/// in the cache: the row of the table, which is written once and read five times, and what each
/// step takes of the particle and leaves there, step by step.
pub fn bytes_moved<const D: usize>(model: &Model<D>, bytes_of_row: f64) -> f64 {
    let (vector, matrix) = ((8 * D) as f64, (8 * D * D) as f64);
    let multiplier = if model.basis.traits().multiplier { 3.0 * vector } else { 0.0 };
    let steps = [
        bytes_of_row + 5.0 * vector, // 1: a_p; x_p and v_p before and after
        bytes_of_row + vector + 2.0 * multiplier, // 2: x_p; λ_p before and after
        bytes_of_row + 8.0 + vector, // 3: m_p, v_p
        bytes_of_row + matrix,       // 5: Δε_p
        16.0 + 4.0 * matrix,         // 6: ρ_p and σ_p before and after, Δε_p twice
        bytes_of_row + 16.0 + matrix, // 7: m_p, ρ_p, σ_p
        bytes_of_row + 3.0 * vector, // 9: v_p before and after, a_p
        2.0 * vector + matrix + 8.0, // the watch for numbers that are none
    ];
    steps.iter().sum()
}
// ANCHOR_END: bytes_moved

/// The columns of the table of a whole time step.
pub const HEADER: &str = "basis,dimensions,nodes that a particle sees,bytes of its row,\
                          bytes moved,instructions\n";

/// A row of that table, but for the instructions: the same on every machine.
pub fn row<const D: usize>(n: usize) -> String {
    let (model, state) = warm::<D>(&scene::<D>(CASES[n]));
    let (pairs, bytes) = pairs_and_bytes(&state);
    format!("{},{D},{pairs:.1},{bytes:.0},{:.0}", CASES[n].name, bytes_moved(&model, bytes))
}
