//! Every place where the paper can be read in more than one way, or is misprinted, stands here
//! as a named type with its evidence.
//!
//! Notes without a type, because only one reading runs:
//!
//! * **Order of the stress update** of the Algorithm. It never says when (3) is
//!   applied. It ends step 6 here: the force of step 7 needs σ at k+1, and (3)
//!   needs Δε of step 5.
//! * **Step 1, (28).** The algorithm writes (1 − γ) Σ f N / m Δt, the text
//!   writes it with Δt in front. They are the same.
//! * **Step 2** discards the nodal values, among them the p_I of k that step 8
//!   as printed adds to. What step 8 adds to here is the momentum that step 3
//!   has mapped.
//! * **Step 9** is titled predictor; it is the corrector (29).
//! * **Start.** The nodal values at k = 0 are not defined by the paper: steps
//!   2 to 8 run once with Δt = 0.
//! * **(39)** lacks the square under the sum; see [`crate::method::measure::rms`].
//! * **Appendix A** says that the ends radiate; both reflect. See
//!   [`crate::method::exact::riemann`].

/// Step 8 carries the nodal momentum on; how far, can be read in two ways.
///
/// The predictor (27) adds Δt p_I/m_I + ½Δt² f_I/m_I, so p_I must be the
/// momentum *at* k+1. The mapped p̃_I holds the predicted velocity ṽ_p, short of
/// γ f_I Δt.
///
/// Neither reading makes x_p second order without condition. The next step 3
/// maps the particles' velocity anew, which has grown by Σ_I N a_I Δt, while
/// (27) moved x_p with a_I itself; a remainder of first order in Δt is left,
/// Σ_I N_Ip (a_I − ā_I) Δt² per step, where ā_I is the particles' acceleration
/// mapped back to the nodes. It is O(h²) on smooth data with evenly placed
/// particles, and all of the error in a single cell.
///
/// Tests: `step_eight_*` in `tests/convergence.rs`,
/// `one_particle_shows_the_remapping_term` in `tests/analytical.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum StepEight {
    /// p_I ← p_I + γ f_I Δt: the momentum at k+1, second order in time but for
    /// the remainder above.
    #[default]
    SecondOrder,
    /// p_I ← p_I + f_I Δt, as the paper prints it: half of it enters the
    /// displacement twice, which is then of first order. The velocity does not
    /// see p_I and stays of second order.
    AsPrinted,
}

/// The strain of a time step can be taken from two velocity gradients.
///
/// As printed, steps 3 to 5 take the velocity of k+½ with the ∇N of k+1, and (17) divides by
/// 1 + tr Δε. Neither is the deformation that moved the particle from x_k to x_{k+1}: at
/// finite strain stress and density are of first order in Δt, with an error of the same sign
/// in every step. While strains are small this does not show.
///
/// Tests: `finite_strain_*` in `tests/finite.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Kinematics {
    /// Δε = Δt sym ∇v and ρ ← ρ / (1 + tr Δε), by the velocity and the table that the scheme
    /// has at hand.
    #[default]
    AsPrinted,
    /// The increment f = 1 + G is the gradient of the map x ↦ x + Σ_I N_I(x) u_I that moves
    /// the particles in this step: G = Σ_I u_I ⊗ ∇N_Ip, with the N_I and u_I which move x_p.
    /// ρ ← ρ / det f, and of second order in Δt. The strain is then that of the nodes' own
    /// velocity, not mapped anew, so every scheme has the limit of Δt of stress-last.
    Consistent,
}

/// Forward Euler updates the stress at one of three points, which the paper leaves open.
///
/// On particles that do not leave their places, `First` and `ModifiedLast` are
/// one leapfrog, the same as Newmark's method, with the time labels of velocity
/// and stress shifted; `Last` takes the strain from the nodes' own velocity,
/// which differs from that of the particles mapped anew.
///
/// Tests: `integrators_are_one_leapfrog` in `tests/integrators.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressUpdate {
    /// Before the forces, from the momentum as mapped.
    First,
    /// After the particles have moved, from the advanced nodal momentum.
    Last,
    /// After the particles have moved, from their momentum mapped anew.
    ModifiedLast,
}

/// OTM's nodes take their mass from the particles, once or in every step. Where it changes, the
/// velocity of a node and its momentum cannot both stay.
///
/// The action of one step has ½ Σ_a m_a |x_a^{k+1} − x_a^k|² / Δt² with the m_a of k. Where
/// these change from step to step, what it makes stationary carries the momentum on.
///
/// Tests: `otm_nodal_masses_keep_what_they_should`, `otm_nodal_masses_side_by_side` in
/// `tests/otm_action.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum NodalMass {
    /// m_a is that of the start; velocity and momentum both stay.
    #[default]
    Kept,
    /// m_a = Σ_p m_p N_ap of each new table; v_a stays, and the momentum m_a v_a jumps.
    RenewedKeepingVelocity,
    /// m_a = Σ_p m_p N_ap of each new table; m_a v_a stays, and the velocity jumps.
    RenewedKeepingMomentum,
}
