//! A run that came to its end may still deserve a warning; each has a type, like an error.

use crate::method::breakdown::Moment;
use crate::scene::Scene;
use thiserror::Error;

/// This is the largest value of what a guard looked at, with its particle and moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    pub value: f64,
    pub particle: usize,
    pub moment: Moment,
}

/// A warning says what a result may not be trusted for.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Warning {
    #[error(
        "the energy has grown by {:.2e} of the largest that start and loads have given, at {}, where \
         particle {} holds the largest share",
        .0.value, .0.moment, .0.particle
    )]
    EnergyGrew(Worst),
    #[error(
        "particle {} has turned by {:.3} rad, at {}: the rate law does not turn its stress; \
         body.law = \"neo-hookean\" or \"hencky\" does",
        .0.particle, .0.value, .0.moment
    )]
    Turned(Worst),
    #[error(
        "the body is free, and its angular momentum has changed by {:.2e} of what it could be by its \
         speeds, at {}",
        .0.value, .0.moment
    )]
    AngularMomentum(Worst),
    #[error(
        "Poisson's ratio is {nu}, and from {from} on this basis is too stiff in bending, as it locks: \
         a cantilever of 16 × 4 cells bends less than nine tenths as far as at 0.3"
    )]
    Locking { nu: f64, from: f64 },
}

impl Warning {
    /// Gives its name and value with unit, as the summary has them.
    pub fn named(&self) -> (&'static str, f64, &'static str) {
        match self {
            Warning::EnergyGrew(seen) => ("warning_energy_growth", seen.value, "1"),
            Warning::Turned(seen) => ("warning_rotation", seen.value, "rad"),
            Warning::AngularMomentum(seen) => ("warning_angular_momentum", seen.value, "1"),
            Warning::Locking { nu, .. } => ("warning_locking", *nu, "1"),
        }
    }

    /// Gives what was seen, and when; `None` for what holds from the start on.
    pub fn seen(&self) -> Option<Worst> {
        match self {
            Warning::EnergyGrew(seen) | Warning::Turned(seen) | Warning::AngularMomentum(seen) => {
                Some(*seen)
            }
            Warning::Locking { .. } => None,
        }
    }

    // ANCHOR: locking
    /// Warns of a body in 2D or 3D whose material hardly changes its volume, where the basis then
    /// hardly lets it bend. With one particle per cell, which holds the volume of a cell at one
    /// place only, none does that.
    ///
    /// The bounds are those of the table in the book's chapter "At the extremes". Test:
    /// `locking_of_a_cantilever`.
    pub fn locking(scene: &Scene) -> Option<Self> {
        if scene.dimension() == 1 || scene.grid.particles_per_cell.iter().all(|n| *n == 1) {
            return None;
        }
        // Of OTM only the widest functions lock as late as on a grid.
        let from = match scene.basis.traits().locks_from {
            from if scene.method.moves_nodes() && from < 0.499 => 0.45,
            from => from,
        };
        let nu = scene.body.poisson_ratio;
        (nu >= from).then_some(Warning::Locking { nu, from })
    }
    // ANCHOR_END: locking
}
