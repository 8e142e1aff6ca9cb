//! Says how far the particles of a scene may come, before anything is built.

use super::parts::{Motion, Scene};
use super::sizes::wave_speed;
use crate::method::exact::mode::Mode;

impl Scene {
    // ANCHOR: travel
    /// Estimates how far particles come from where they start, in cells, by what moves them: a
    /// throw v by v t, or v L/c along an axis that a side holds; a mode or a ring by its amplitude;
    /// loads by V L/c with V = b L/c + t^s/(ρc) along a held axis, and by V t/2 with
    /// V = b t + t^s t/(ρL) along a free one. These are sizes, not bounds: waves may add up
    /// to twice as much.
    pub fn travel(&self) -> f64 {
        let c = wave_speed(&self.body);
        let along = |d: usize| {
            let (length, end) = (self.body.length[d], self.time.end);
            let h = length / self.grid.cells[d] as f64;
            let held = self.boundary[d].iter().any(|side| side.fixed[d]);
            let time = if held { end.min(length / c) } else { end };
            let body = self.body_force.as_ref().map_or(0.0, |body| body.acceleration[d].abs());
            let sides = self.traction.iter().flat_map(|traction| traction.sides.iter().flatten());
            let traction = sides.map(|t| t[d].abs()).fold(0.0, f64::max);
            let pulled = traction / (self.body.density * if held { c * time } else { length });
            let loads = (body + pulled) * time * time * if held { 1.0 } else { 0.5 };
            (self.thrown(d) * time + loads) / h
        };
        let own = match &self.motion {
            Motion::Regions(_) => 0.0,
            Motion::Vibration { mode, velocity } => {
                let mode = Mode::new(self.ends(0), *mode, self.body.length[0]);
                (velocity / (c * mode.k)).abs()
            }
            Motion::Manufactured(spec) => spec.amplitude.abs(),
            Motion::Vortex(spec) => (spec.angle * spec.radius).abs(),
        };
        let h = |d: usize| self.body.length[d] / self.grid.cells[d] as f64;
        (0..self.dimension()).map(|d| along(d).max(own / h(d))).fold(0.0, f64::max)
    }
    // ANCHOR_END: travel

    /// Finds the largest velocity component along an axis that a region starts with (m/s).
    fn thrown(&self, d: usize) -> f64 {
        match &self.motion {
            Motion::Regions(regions) => {
                regions.iter().map(|region| region.fastest(d)).fold(0.0, f64::max)
            }
            _ => 0.0,
        }
    }
}
