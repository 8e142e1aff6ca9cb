//! The paper's Algorithm is Newmark's explicit predictor-corrector with γ = ½, β = 0, the
//! central difference (27)-(29).

use super::deformation::gradient_of_predictor;
use super::scheme::{ADVANCED, FORCES, MAPPED, Made, NONE, Scheme, TABLE, TripFactor};
use super::steps::*;
use crate::method::breakdown::Breakdown;
use crate::method::model::{Model, State};
use crate::method::reading::{Kinematics, StepEight};

// ANCHOR: newmark
/// Takes step `n` of the Algorithm, 1 to 9, in the time step from k to k+1 that ends at `t` (s).
///
/// With Δt = 0 and blank nodes the nine steps move nothing and give the nodal values of
/// k = 0, which the first predictor needs.
pub fn step<const D: usize>(
    n: usize,
    State { particle, node, shape, mass, scratch, .. }: &mut State<D>,
    model: &Model<D>,
    reading: StepEight,
    dt: f64,
    t: f64,
) -> Result<(), Breakdown> {
    match n {
        1 => {
            if model.kinematics == Kinematics::Consistent {
                gradient_of_predictor(particle, node, shape, dt);
                particle.lengthen(); // before the table at the new places
            }
            predict(particle, node, shape, dt); // (27) (28)
        }
        2 => {
            discard(node);
            tabulate(shape, scratch, particle, model)?;
        }
        3 => transfer(node, mass, particle, shape)?, // (13)
        4 => impose_essential(node, mass, &model.fixed),
        5 if model.kinematics == Kinematics::AsPrinted => {
            increment_strain(particle, node, shape, dt); // (16)
            particle.lengthen();
        }
        5 => {}                                 // the strain is that of step 1
        6 => update_material(particle, model)?, // (17) (3)
        7 => {
            balance_forces(node, particle, shape, model, t); // (14) (15)
            accelerate(node, mass); // (18)
        }
        8 => integrate_momentum(node, dt, reading),
        _ => correct(particle, node, shape, dt), // (29)
    }
    Ok(())
}
// ANCHOR_END: newmark

/// This is the Algorithm, with one of two readings of step 8.
pub struct Newmark(pub StepEight);

impl<const D: usize> Scheme<D> for Newmark {
    fn makes(&self, _: Kinematics) -> &'static [Made] {
        &[
            NONE,
            &["x_p", "v_p"],
            TABLE,
            MAPPED,
            &["v_I"],
            &["G_p", "d_eps_p_printed"],
            &["d_eps_p_of_map", "F_p", "rho_p", "sigma_p"],
            FORCES,
            ADVANCED,
            &["a_p", "v_p"],
        ]
    }

    fn starts_with_all_steps(&self) -> bool {
        true
    }

    fn step(
        &self,
        n: usize,
        state: &mut State<D>,
        model: &Model<D>,
        dt: f64,
        t: f64,
    ) -> Result<(), Breakdown> {
        step(n, state, model, self.0, dt, t)
    }

    fn factor(&self, kinematics: Kinematics) -> TripFactor {
        TripFactor::of_strain(kinematics)
    }
}
