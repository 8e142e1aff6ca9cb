//! A scene chooses from these closed sets: method, scheme, mass matrix.

use super::reading::{NodalMass, StepEight, StressUpdate};

/// A method carries a body through time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The material point method, by one of its schemes.
    Mpm(Integrator),
    /// The optimal transportation meshfree method, which has one scheme; its nodes' masses are
    /// read in three ways.
    Otm(NodalMass),
}

impl Method {
    /// Says whether the nodes are the body's own and go with it.
    pub fn moves_nodes(&self) -> bool {
        match self {
            Method::Mpm(_) => false,
            Method::Otm(_) => true,
        }
    }
}

/// An integrator is the scheme that carries the material point method through time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// The paper's explicit predictor-corrector, (27)-(29).
    Newmark(StepEight),
    /// Forward Euler, (20)-(21).
    ForwardEuler(StressUpdate),
    /// Its corrected form, (22)-(23).
    CorrectedEuler,
    /// Explicit generalized-α, (24)-(26).
    GeneralizedAlpha {
        /// ρ_b, the spectral radius at the bifurcation, 0 to 1.
        rho_b: f64,
    },
}

impl Integrator {
    /// Says whether particles keep an acceleration from step to step.
    pub fn carries_acceleration(&self) -> bool {
        match self {
            Integrator::Newmark(_) | Integrator::GeneralizedAlpha { .. } => true,
            Integrator::ForwardEuler(_) | Integrator::CorrectedEuler => false,
        }
    }
}

/// A law gives the stress of the material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// (3), σ̇ = D : ε̇, which is not objective: a rotation does not turn the stress.
    Rate,
    /// Neo-Hookean, from the deformation gradient F.
    NeoHookean,
    /// Hencky's, from the logarithmic strain ½ ln(F Fᵀ).
    Hencky,
}

impl Law {
    /// Says whether the stress follows from F, which the particles then carry.
    pub fn is_hyperelastic(&self) -> bool {
        match self {
            Law::Rate => false,
            Law::NeoHookean | Law::Hencky => true,
        }
    }
}

/// The nodes have one of two mass matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mass {
    /// The row sums m_I of (18).
    Lumped,
    /// m_IJ of (12) and (13).
    Consistent,
}
