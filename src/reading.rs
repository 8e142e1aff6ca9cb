//! Every place where the paper can be read in more than one way, or is
//! misprinted, as a named type with its evidence.
//!
//! Notes without a type, because only one reading runs:
//!
//! * **Order of the stress update.** The algorithm never says when (3) is
//!   applied. It stands between steps 6 and 7 here: the force of step 7 needs
//!   σ at k+1, and (3) needs Δε of step 5.
//! * **Step 1, (28).** The algorithm writes (1 − γ) Σ f N / m Δt, the text
//!   writes it with Δt in front. They are the same.
//! * **Step 2** discards the nodal values; the p_I and m_I that step 1 of the
//!   next time step needs are those of steps 3 and 8, not discarded ones.
//! * **Step 9** is titled predictor; it is the corrector (29).
//! * **Start.** The nodal values at k = 0 are not defined by the paper: steps
//!   2 to 8 run once with Δt = 0.
//! * **(39)** lacks the square under the sum; see [`crate::measure::rms`].
//! * **Appendix A** says that the ends radiate; both reflect. See
//!   [`crate::exact::riemann`].

/// Step 8: how far the nodal momentum is carried before the next step 1.
///
/// The predictor (27) adds Δt p_I/m_I + ½Δt² f_I/m_I, so p_I must be the
/// momentum *at* k+1. The mapped p_I holds the predicted velocity, short of
/// γ f_I Δt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum StepEight {
    /// p_I ← p_I + γ f_I Δt: the momentum at k+1, second order in time.
    #[default]
    SecondOrder,
    /// p_I ← p_I + f_I Δt, as the paper prints it: f enters the displacement
    /// half a step twice, first order in time.
    AsPrinted,
}
