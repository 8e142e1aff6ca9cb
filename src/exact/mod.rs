//! Exact solutions, each in a file of its own, and which scene has one.

pub mod forced;
pub mod manufactured;
pub mod mode;
pub mod riemann;

use crate::continuum::law::LinearElastic;
use crate::fault::Fault;
use crate::model::wave_speed;
use crate::scene::{Motion, Scene};
use forced::{Forced, Load};
use manufactured::Manufactured;
use mode::{Mode, Vibration};
use riemann::{Bar, End, Patch};

/// v (m/s), σ (Pa) and u (m) at one material point and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fields {
    pub velocity: f64,
    pub stress: f64,
    pub displacement: f64,
}

impl std::ops::Add for Fields {
    type Output = Fields;
    fn add(self, other: Fields) -> Fields {
        Fields {
            velocity: self.velocity + other.velocity,
            stress: self.stress + other.stress,
            displacement: self.displacement + other.displacement,
        }
    }
}

/// The exact solution of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Exact {
    /// The elastic bar: thrown in patches or in a mode, with loads or without.
    /// Small strains, so the parts add up.
    Linear { thrown: Bar, vibration: Option<Vibration>, forced: Option<Forced> },
    /// Finite strain.
    Manufactured(Manufactured),
}

impl Exact {
    /// The exact solution of `scene`.
    ///
    /// Errors: [`Fault::NoExact`] with the reason.
    pub fn of(scene: &Scene) -> Result<Exact, Fault> {
        if scene.dimension() > 1 {
            return Err(Fault::NoExact { why: "it has more than one dimension" });
        }
        let ends = [0, 1].map(|upper: usize| End::of(&scene.boundary[0][upper]));
        let law = LinearElastic::new(scene.body.youngs_modulus, scene.body.poisson_ratio);
        let (length, density, modulus) =
            (scene.body.length[0], scene.body.density, law.p_wave_modulus());
        let c = wave_speed(&scene.body);
        let mut thrown = Bar { length, density, modulus, ends, patches: Vec::new() };
        let mut vibration = None;
        match &scene.motion {
            Motion::Regions(regions) => {
                thrown.patches = regions
                    .iter()
                    .map(|a| Patch { from: a.from[0], to: a.to[0], velocity: a.velocity[0] })
                    .collect();
            }
            Motion::Vibration { mode, velocity } => {
                let mode = Mode::new(ends, *mode, length);
                vibration = Some(Vibration { mode, velocity: *velocity, c, modulus });
            }
            Motion::Manufactured { mode, amplitude } => {
                let mode = Mode::new(ends, *mode, length);
                let amplitude = *amplitude;
                return Ok(Exact::Manufactured(Manufactured { mode, amplitude, c, modulus }));
            }
        }
        let side = |upper: usize| {
            let traction = scene.traction.as_ref().map_or(0.0, |t| t.sides[0][upper][0]);
            let ramp = scene.traction.as_ref().map_or(0.0, |t| t.ramp);
            Load { value: traction, ramp }
        };
        let loaded = scene.body_force.is_some() || scene.traction.is_some();
        let forced = loaded.then(|| Forced {
            length,
            c,
            Z: density * c,
            ends,
            body: scene.body_force.as_ref().map_or(Load::default(), |body| Load {
                value: body.acceleration[0],
                ramp: body.ramp,
            }),
            traction: [side(0), side(1)],
        });
        Ok(Exact::Linear { thrown, vibration, forced })
    }

    /// The latest time (s) at which the solution is right to ten digits or more:
    /// 2^50 L/c for a bar without loads that is thrown in patches, else 10⁴ L/c.
    pub fn latest(&self) -> f64 {
        match self {
            Exact::Linear { thrown, vibration: None, forced: None } => thrown.latest(),
            Exact::Linear { thrown, .. } => 1e4 * thrown.length / thrown.c(),
            Exact::Manufactured(solution) => 1e4 / (solution.c * solution.mode.k),
        }
    }

    /// v, σ and u of the material point that stood at `x` (m) from the body's
    /// lower corner at t = 0, at time `t` >= 0 (s).
    pub fn at(&self, x: f64, t: f64) -> Fields {
        match self {
            Exact::Linear { thrown, vibration, forced } => {
                let mut fields = thrown.at(x, t);
                if let Some(vibration) = vibration {
                    fields = fields + vibration.at(x, t);
                }
                if let Some(forced) = forced {
                    fields = fields + forced.at(x, t);
                }
                fields
            }
            Exact::Manufactured(solution) => solution.at(x, t),
        }
    }
}
