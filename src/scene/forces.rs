//! Reads how the internal forces are integrated, and refuses what has no such quadrature.

use super::fault::SceneError;
use super::implicit::IMPLICIT;
use super::values::Values;
use crate::method::basis::Basis;
use crate::method::reconstruction::{Functions, Reconstruction, Rule};

const NOT_PREDICTED: &str = "with a reconstructed stress the limit of the time step is not predicted: the force is not the \
     adjoint of the strain";

/// Reads the `forces` table.
///
/// Test: `reconstruction_refuses_what_makes_no_sense`.
pub fn forces(values: &Values, basis: Basis) -> Result<Option<Reconstruction>, Box<SceneError>> {
    let refuse = |key: &str, problem: &str, allowed: &str| {
        let mut error = values.error(key, problem);
        error.allowed = allowed.to_string();
        Err(error)
    };
    let key = "forces.reconstruction";
    if !values.has(key) {
        return match values.has("forces.degree") {
            true => refuse("forces.degree", "nothing is reconstructed", "no such key"),
            false => Ok(None),
        };
    }
    let rule = values.choose(key, &[("tls", Rule::Tls), ("mls", Rule::Mls)])?;
    if values.word("method")? == "otm" {
        let problem = "the method \"otm\" has Gauss's points already, which keep their stress";
        return refuse(key, problem, "no such key");
    }
    let integrator = values.word("time.integrator")?;
    if IMPLICIT.contains(&integrator) {
        let problem = "an implicit scheme needs the tangent of the forces, which is made of sums";
        return refuse(key, problem, "no such key");
    }
    let functions = match basis {
        Basis::Linear if rule == Rule::Mls => {
            let problem = "moving least squares with linear functions have no stable time step \
                           for some places of the particles";
            return refuse(key, problem, "\"tls\", or no such key");
        }
        Basis::Linear => Functions::Linear,
        Basis::BSpline(degree) => Functions::BSpline(degree),
        _ => {
            let problem = "it needs functions that are known at every point: linear or B-splines";
            return refuse(key, problem, "no such key");
        }
    };
    for key in ["time.fraction_of_critical", "time.watch", "time.allow_unstable"] {
        if values.has(key) {
            return refuse(key, NOT_PREDICTED, "no such key");
        }
    }
    let degree = match (values.has("forces.degree"), rule) {
        (true, _) => values.whole("forces.degree")?,
        (false, Rule::Tls) => 1,
        (false, Rule::Mls) => 2,
    };
    Ok(Some(Reconstruction { rule, degree, functions }))
}
