//! A scheme carries a body through a time step, in numbered steps. What the program asks of one
//! stands in the trait here; each scheme answers in its own file.

use crate::method::breakdown::Breakdown;
use crate::method::model::{Model, State};
use crate::method::reading::Kinematics;

/// These are the symbols of the values that a step makes, in the paper's order.
pub type Made = &'static [&'static str];

pub const NONE: Made = &[];
pub const TABLE: Made = &["N_Ip", "grad_N_Ip", "lambda"];
pub const MAPPED: Made = &["m_I", "p_I"];
pub const FORCES: Made = &["f_int_I", "f_ext_I", "f_I"];
pub const ADVANCED: Made = &["p_I_advanced"];
pub const MOVED: Made = &["v_p", "x_p"];
pub const MOVED_WITH_A: Made = &["a_p", "v_p", "x_p"];
pub const MATERIAL: Made = &["G_p", "d_eps_p", "F_p", "rho_p", "sigma_p"];
pub const STRAINED: Made = &["v_I", "G_p", "d_eps_p", "F_p", "rho_p", "sigma_p"];

/// This is g, what a scheme makes of an eigenvalue s of A, the trip to the particles and back. Its
/// values stand with the prediction of Δt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TripFactor {
    /// 1.
    One,
    /// s.
    Filtered,
    /// 2 − s.
    Last,
    /// 2p/l, of generalized-α with the spectral radius ρ_b.
    Alpha { rho_b: f64 },
    /// 0: no time step is too large.
    Unlimited,
}

impl TripFactor {
    /// Gives that of explicit schemes: where the velocity that moves the particles strains them, it
    /// does so before it is filtered.
    pub fn of_strain(kinematics: Kinematics) -> Self {
        match kinematics {
            Kinematics::AsPrinted => TripFactor::Filtered,
            Kinematics::Consistent => TripFactor::Last,
        }
    }
}

// ANCHOR: scheme
/// A scheme has a start, steps from 1 on, and a factor that limits Δt.
pub trait Scheme<const D: usize> {
    /// Lists what each step makes, the start as step 0; so this list says how many steps there
    /// are.
    fn makes(&self, kinematics: Kinematics) -> &'static [Made];

    /// Says whether the values of k = 0 come from a time step with Δt = 0, in which nothing moves.
    fn starts_with_all_steps(&self) -> bool {
        false
    }

    /// Prepares what the scheme needs at k = 0 else: nothing, if it says nothing more.
    ///
    /// Errors: those of its sums.
    fn start(&self, _: &mut State<D>, _: &Model<D>) -> Result<(), Breakdown> {
        Ok(())
    }

    /// Takes step `n` of a time step of `dt` (s), whose loads are those at the time `t` (s).
    ///
    /// Errors: [`Breakdown`].
    fn step(
        &self,
        n: usize,
        state: &mut State<D>,
        model: &Model<D>,
        dt: f64,
        t: f64,
    ) -> Result<(), Breakdown>;

    /// Says what the scheme makes of the trip to the particles and back, where their strain is
    /// that of one of two maps.
    fn factor(&self, kinematics: Kinematics) -> TripFactor;
}
// ANCHOR_END: scheme
