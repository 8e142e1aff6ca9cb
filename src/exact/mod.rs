//! Exact solutions, each in a file of its own, and which scene has one.

pub mod riemann;

use crate::continuum::law::LinearElastic;
use crate::fault::Fault;
use crate::scene::Scene;
use riemann::{Bar, End, Patch};

/// v (m/s), σ (Pa) and u (m) at one material point and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields {
    pub velocity: f64,
    pub stress: f64,
    pub displacement: f64,
}

/// The exact solution of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Exact {
    /// The elastic bar by Riemann invariants, Appendix A.
    Bar(Bar),
}

impl Exact {
    /// The exact solution of `scene`.
    ///
    /// Errors: [`Fault::NoExact`] with the reason.
    pub fn of(scene: &Scene) -> Result<Exact, Fault> {
        if scene.dimension() > 1 {
            return Err(Fault::NoExact { why: "it has more than one dimension" });
        }
        let end = |upper: usize| match scene.boundary[0][upper].fixed[0] {
            true => End::Fixed,
            false => End::Free,
        };
        let law = LinearElastic::new(scene.body.youngs_modulus, scene.body.poisson_ratio);
        let patch = |region: &crate::scene::Region| Patch {
            from: region.from[0],
            to: region.to[0],
            velocity: region.velocity[0],
        };
        Ok(Exact::Bar(Bar {
            length: scene.body.length[0],
            density: scene.body.density,
            modulus: law.p_wave_modulus(),
            ends: [end(0), end(1)],
            patches: scene.initial_velocity.iter().map(patch).collect(),
        }))
    }

    /// The latest time (s) at which the solution is right to the last digits.
    pub fn latest(&self) -> f64 {
        match self {
            Exact::Bar(bar) => bar.latest(),
        }
    }

    /// v, σ and u of the material point that stood at `x` (m) from the body's
    /// lower corner at t = 0, at time `t` >= 0 (s).
    pub fn at(&self, x: f64, t: f64) -> Fields {
        match self {
            Exact::Bar(bar) => bar.at(x, t),
        }
    }
}
