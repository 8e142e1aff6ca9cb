//! Counts what a scene amounts to before anything is built: particles, nodes, pairs, steps.

use super::parts::{Body, Scene};
use crate::method::choice::Mass;

/// Gives c = √((λ + 2μ) / ρ) (m/s), the speed of a plane wave, (46) in the bar.
pub fn wave_speed(body: &Body) -> f64 {
    libm::sqrt(body.elastic().p_wave_modulus() / body.density)
}

impl Scene {
    /// Finds the smallest spacing (m).
    fn spacing(&self) -> f64 {
        let per_axis = self.body.length.iter().zip(&self.grid.cells);
        per_axis.map(|(length, cells)| length / *cells as f64).fold(f64::INFINITY, f64::min)
    }

    // ANCHOR: step_count
    /// Gives N_t: the load steps of a quasi-static run, else as many equal steps as keep c Δt / h at or below `time.cfl`.
    ///
    /// A count within 1e-9 (relative) of a whole number is that number, so that
    /// an end given to ten digits does not cost a step; the Courant number may
    /// then exceed the bound by as much.
    pub fn step_count(&self) -> f64 {
        if let Some(steps) = self.time.load_steps {
            return steps as f64;
        }
        let count = self.time.end * wave_speed(&self.body) / (self.time.cfl * self.spacing());
        let whole = libm::round(count);
        let close = (count - whole).abs() <= 1e-9 * whole;
        if close && whole > 0.0 { whole } else { libm::ceil(count).max(1.0) }
    }
    // ANCHOR_END: step_count

    /// Counts particles, nodes and time steps, before anything is built; with balls the
    /// particles of the whole box.
    pub fn sizes(&self) -> (f64, f64, f64) {
        let (mut particles, mut nodes) = (1.0, 1.0);
        for d in 0..self.dimension() {
            let cells = self.grid.cells[d] as f64;
            let [before, after] = self.grid.beyond[d].map(|n| n as f64);
            particles *= cells * self.grid.particles_per_cell[d] as f64;
            nodes *= before + cells + after + 1.0;
        }
        (particles, nodes, self.step_count())
    }

    /// Bounds the nodes that a particle can see, before anything is built.
    pub fn pairs_per_particle(&self) -> f64 {
        let along = |d: usize| {
            let [before, after] = self.grid.beyond[d].map(|n| n as f64);
            self.basis.traits().along.min(before + self.grid.cells[d] as f64 + after + 1.0)
        };
        (0..self.dimension()).map(along).product()
    }

    /// Bounds the numbers that a row of the table of shape functions holds: of a list N, ∇N and
    /// the node for each pair; of a product N and its slope for each node along each axis.
    pub fn numbers_per_row(&self) -> f64 {
        match self.basis.traits().lists_rows || self.method.moves_nodes() {
            true => (2.0 + self.dimension() as f64) * self.pairs_per_particle(),
            false => (0..self.dimension()).map(|d| 2.0 * self.coupled(d).0).sum(),
        }
    }

    /// Bounds along axis `d` the nodes that a particle sees, and those that particles see at all
    /// while they fill the body's cells.
    fn coupled(&self, d: usize) -> (f64, f64) {
        let [before, after] = self.grid.beyond[d];
        let (cells, all) = (self.grid.cells[d] as f64, (before + after) as f64 + 1.0);
        let all = cells + all;
        let along = libm::floor(self.basis.traits().along).min(all);
        (along, all.min(cells + along))
    }

    /// Counts the sets of equations of the consistent mass matrix: components that the same sides
    /// hold share one. There are none with the lumped matrix.
    pub fn mass_systems(&self) -> f64 {
        let held = |i: usize| {
            self.boundary.iter().flatten().map(|side| side.fixed[i]).collect::<Vec<bool>>()
        };
        let mut sets: Vec<Vec<bool>> = (0..self.dimension()).map(held).collect();
        sets.sort_unstable();
        sets.dedup();
        if self.mass == Mass::Consistent { sets.len() as f64 } else { 0.0 }
    }

    /// Bounds the entries of the consistent mass matrix.
    pub fn mass_entries(&self) -> f64 {
        let along = |d: usize| {
            let (along, all) = self.coupled(d);
            all * (2.0 * along - 1.0).min(all)
        };
        (0..self.dimension()).map(along).product()
    }

    /// Bounds the nodes that have mass, and how far apart in their natural order, the first axis
    /// fastest, two of them stand that share a particle: the half bandwidth of m_IJ.
    pub fn band(&self) -> (f64, f64) {
        let (mut nodes, mut band) = (1.0, 0.0);
        for d in 0..self.dimension() {
            let (along, all) = self.coupled(d);
            band += (along - 1.0) * nodes;
            nodes *= all;
        }
        (nodes, band)
    }

    /// Bounds the entries of L, the Cholesky factor of the consistent mass matrix: in the natural
    /// order the band fills up. Test: `budget_of_the_factor`.
    pub fn factor_entries(&self) -> f64 {
        let (nodes, band) = self.band();
        nodes * (band + 1.0) - 0.5 * band * (band + 1.0)
    }

    /// Gives c Δt / h of a time step `dt` (s).
    pub fn courant_number_of(&self, dt: f64) -> f64 {
        wave_speed(&self.body) * dt / self.spacing()
    }

    /// Gives c Δt / h of the run, at or below `time.cfl`.
    pub fn courant_number(&self) -> f64 {
        wave_speed(&self.body) * self.time.end / (self.step_count() * self.spacing())
    }
}
