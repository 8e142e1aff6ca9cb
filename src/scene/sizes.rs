//! Counts what a scene amounts to before anything is built: particles, nodes, pairs, steps.

use super::parts::{Body, Scene};

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
    /// Gives N_t: as many equal steps as keep c Δt / h at or below `time.cfl`.
    ///
    /// A count within 1e-9 (relative) of a whole number is that number, so that
    /// an end given to ten digits does not cost a step; the Courant number may
    /// then exceed the bound by as much.
    pub fn step_count(&self) -> f64 {
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
            self.basis.most_along(before + self.grid.cells[d] as f64 + after + 1.0)
        };
        (0..self.dimension()).map(along).product()
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
