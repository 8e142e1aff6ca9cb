//! Each exact solution has a file of its own.

pub mod column;
mod fields;
pub mod forced;
pub mod manufactured;
pub mod mode;
pub mod riemann;
pub mod vortex;

pub use fields::{Fields, FieldsIn};

use column::Column;
use forced::Forced;
use manufactured::Manufactured;
use mode::Vibration;
use nalgebra::{SMatrix, SVector};
use riemann::Bar;
use vortex::Vortex;

/// A scene has one of these exact solutions.
#[derive(Clone, Debug, PartialEq)]
pub enum Exact<const D: usize> {
    /// The elastic bar: thrown in patches or in a mode, with loads or without.
    /// Small strains, so the parts add up. D = 1.
    Linear { thrown: Bar, vibration: Option<Vibration>, forced: Option<Forced> },
    /// A bar in equilibrium at finite strain. D = 1.
    Static(Column),
    /// A motion at finite strain, kept going by a body force.
    Moved(Moved<D>),
}

/// A chosen motion at finite strain has the body force that keeps it going.
#[derive(Clone, Debug, PartialEq)]
pub enum Moved<const D: usize> {
    Manufactured(Manufactured<D>),
    /// D = 2.
    Vortex(Vortex),
}

impl<const D: usize> Exact<D> {
    /// Gives the latest time (s) at which the solution is right to ten digits or more:
    /// 2^50 L/c for a bar without loads that is thrown in patches, else 10⁴ L/c or 10⁴/ω.
    pub fn latest(&self) -> f64 {
        match self {
            Exact::Linear { thrown, vibration: None, forced: None } => thrown.latest(),
            Exact::Linear { thrown, .. } => 1e4 * thrown.length / thrown.c(),
            Exact::Static(_) => f64::INFINITY,
            Exact::Moved(Moved::Manufactured(solution)) => 1e4 / solution.omega,
            Exact::Moved(Moved::Vortex(solution)) => 1e4 / solution.omega,
        }
    }

    /// Gives v, σ and u of the material point `X` (m) from the body's lower corner, at time
    /// `t` >= 0 (s). It is where the point stood at t = 0, unless the motion starts displaced.
    pub fn at(&self, X: &SVector<f64, D>, t: f64) -> FieldsIn<D> {
        match self {
            Exact::Linear { thrown, vibration, forced } => {
                let mut fields = thrown.at(X[0], t);
                if let Some(vibration) = vibration {
                    fields = fields + vibration.at(X[0], t);
                }
                if let Some(forced) = forced {
                    fields = fields + forced.at(X[0], t);
                }
                fields.into()
            }
            Exact::Static(column) => column.at(X[0], t).into(),
            Exact::Moved(moved) => moved.at(X, t),
        }
    }
}

impl Exact<1> {
    /// Does the same for a bar, in numbers.
    pub fn along(&self, x: f64, t: f64) -> Fields {
        self.at(&SVector::repeat(x), t).into()
    }
}

impl<const D: usize> Moved<D> {
    /// Gives v, σ and u of the material point `X` (m) at time `t` (s).
    pub fn at(&self, X: &SVector<f64, D>, t: f64) -> FieldsIn<D> {
        match self {
            Moved::Manufactured(solution) => solution.at(X, t),
            Moved::Vortex(solution) => {
                let plane = solution.at([X[0], X[D - 1]], t);
                Fields {
                    velocity: SVector::from_fn(|i, _| plane.velocity[i]),
                    stress: SMatrix::from_fn(|i, j| plane.stress[(i, j)]),
                    displacement: SVector::from_fn(|i, _| plane.displacement[i]),
                }
            }
        }
    }

    /// Gives F (–) there.
    pub fn deformation(&self, X: &SVector<f64, D>, t: f64) -> SMatrix<f64, D, D> {
        match self {
            Moved::Manufactured(solution) => SMatrix::from_diagonal(&solution.stretches(X, t)),
            Moved::Vortex(solution) => {
                let F = solution.deformation([X[0], X[D - 1]], t);
                SMatrix::from_fn(|i, j| F[(i, j)])
            }
        }
    }

    /// Gives the body force (m/s²) that keeps the motion going there.
    pub fn body_force(&self, X: &SVector<f64, D>, t: f64) -> SVector<f64, D> {
        match self {
            Moved::Manufactured(solution) => solution.body_force(X, t),
            Moved::Vortex(solution) => {
                let b = solution.body_force([X[0], X[D - 1]], t);
                SVector::from_fn(|i, _| b[i])
            }
        }
    }
}
