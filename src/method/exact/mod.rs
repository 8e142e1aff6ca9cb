//! Each exact solution has a file of its own.

mod fields;
pub mod forced;
pub mod manufactured;
pub mod mode;
pub mod riemann;

pub use fields::Fields;

use forced::Forced;
use manufactured::Manufactured;
use mode::Vibration;
use riemann::Bar;

/// A scene has one of these exact solutions.
#[derive(Clone, Debug, PartialEq)]
pub enum Exact {
    /// The elastic bar: thrown in patches or in a mode, with loads or without.
    /// Small strains, so the parts add up.
    Linear { thrown: Bar, vibration: Option<Vibration>, forced: Option<Forced> },
    /// Finite strain.
    Manufactured(Manufactured),
}

impl Exact {
    /// Gives the latest time (s) at which the solution is right to ten digits or more:
    /// 2^50 L/c for a bar without loads that is thrown in patches, else 10⁴ L/c.
    pub fn latest(&self) -> f64 {
        match self {
            Exact::Linear { thrown, vibration: None, forced: None } => thrown.latest(),
            Exact::Linear { thrown, .. } => 1e4 * thrown.length / thrown.c(),
            Exact::Manufactured(solution) => 1e4 / (solution.c * solution.mode.k),
        }
    }

    /// Gives v, σ and u of the material point that stood at `x` (m) from the body's
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
