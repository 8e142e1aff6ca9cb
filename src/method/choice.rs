//! A scene chooses from these closed sets: method, scheme, law, filter, mass matrix.

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

    /// Says what its scheme needs; OTM keeps everything at its nodes, balances the forces of k+1
    /// and tabulates the places of k+1.
    pub fn needs(&self) -> Needs {
        match self {
            Method::Mpm(integrator) => integrator.needs(),
            Method::Otm(_) => {
                Needs { balance_at_end: true, current_table: true, ..Needs::default() }
            }
        }
    }
}

// ANCHOR: integrators
/// An integrator is the scheme that carries the material point method through time. What
/// the rest of the program asks of one stands in [`Integrator::needs`]; its steps are a file of
/// [`crate::method::time`].
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
    /// Newmark's method with β = 1/4 and γ = 1/2, whose balance holds at the end of the step.
    ImplicitNewmark,
    /// Equilibrium without inertia, under loads that grow in steps.
    QuasiStatic,
}

/// Needs say what a scheme carries from step to step, and how it treats time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Particles keep an acceleration, a_p.
    pub acceleration: bool,
    /// The particles bring it to the nodes, a_I of k.
    pub mapped_acceleration: bool,
    /// The nodes have one of k+1 beside it.
    pub next_acceleration: bool,
    /// The forces are balanced at k+1, with the loads of that time; else at k.
    pub balance_at_end: bool,
    /// At the end of a step the table is that of the places where the particles stand then.
    pub current_table: bool,
    /// Displacements are solved for, so that no time step is too large to be stable, and the
    /// strain is that of the map which moves the particles.
    pub equilibrium: bool,
}

impl Integrator {
    /// Says what the scheme needs, in one line for each.
    pub fn needs(&self) -> Needs {
        let none = Needs::default();
        let with_a = Needs { acceleration: true, ..none };
        let solved = Needs { balance_at_end: true, equilibrium: true, ..none };
        match self {
            Integrator::Newmark(_) => Needs { balance_at_end: true, current_table: true, ..with_a },
            Integrator::ForwardEuler(_) | Integrator::CorrectedEuler => none,
            Integrator::GeneralizedAlpha { .. } => {
                Needs { mapped_acceleration: true, next_acceleration: true, ..with_a }
            }
            Integrator::ImplicitNewmark => {
                Needs { acceleration: true, mapped_acceleration: true, ..solved }
            }
            Integrator::QuasiStatic => solved,
        }
    }
}
// ANCHOR_END: integrators

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

/// A filter takes something out of the stresses after each of their updates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// What no node feels: each particle gets the mean of its cell.
    NullSpace,
}

/// The nodes have one of two mass matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mass {
    /// The row sums m_I of (18).
    Lumped,
    /// m_IJ of (12) and (13).
    Consistent,
}
