//! Reads how the internal forces are integrated, and refuses what has no such quadrature.

use super::fault::SceneError;
use super::scheme::is_implicit;
use super::values::Values;
use crate::method::basis::Basis;
use crate::method::reconstruction::{Piecewise, Reconstruction, Rule};

const RECONSTRUCTION: &str = "forces.reconstruction";

const NOT_PREDICTED: &str = "with a reconstructed stress the limit of the time step is not predicted: the force is not the \
     adjoint of the strain";

/// Makes the error of a key.
fn refused(values: &Values, key: &str, problem: &str, allowed: &str) -> Box<SceneError> {
    values.error(key, problem).allowing(allowed)
}

/// Reads the `forces` table.
///
/// Test: `reconstruction_refuses_what_makes_no_sense`.
pub fn forces(values: &Values, basis: Basis) -> Result<Option<Reconstruction>, Box<SceneError>> {
    if !values.has(RECONSTRUCTION) {
        return match values.has("forces.degree") {
            true => {
                Err(refused(values, "forces.degree", "nothing is reconstructed", "no such key"))
            }
            false => Ok(None),
        };
    }
    let rule = values.choose(RECONSTRUCTION, &[("tls", Rule::Tls), ("mls", Rule::Mls)])?;
    scheme(values)?;
    let functions = functions(values, basis, rule)?;
    let degree = match (values.has("forces.degree"), rule) {
        (true, _) => values.whole("forces.degree")?,
        (false, Rule::Tls) => 1,
        (false, Rule::Mls) => 2,
    };
    Ok(Some(Reconstruction { rule, degree, functions }))
}

/// Refuses methods and schemes that have no such forces, and keys that need a predicted limit.
fn scheme(values: &Values) -> Result<(), Box<SceneError>> {
    let problem = if values.word("method")? == "otm" {
        "the method \"otm\" has Gauss's points already, which keep their stress"
    } else if is_implicit(values)? {
        "an implicit scheme needs the tangent of the forces, which is made of sums"
    } else {
        let keys = ["time.fraction_of_critical", "time.watch", "time.allow_unstable"];
        return match keys.into_iter().find(|key| values.has(key)) {
            Some(key) => Err(refused(values, key, NOT_PREDICTED, "no such key")),
            None => Ok(()),
        };
    };
    Err(refused(values, RECONSTRUCTION, problem, "no such key"))
}

/// Gives the functions that can be tabulated at Gauss's points.
fn functions(values: &Values, basis: Basis, rule: Rule) -> Result<Piecewise, Box<SceneError>> {
    let (problem, allowed) = match (basis, rule) {
        (Basis::Linear, Rule::Tls) => return Ok(Piecewise::Linear),
        (Basis::BSpline(degree), _) => return Ok(Piecewise::BSpline(degree)),
        (Basis::Linear, Rule::Mls) => (
            "moving least squares with linear functions have no stable time step for some places \
             of the particles",
            "\"tls\", or no such key",
        ),
        _ => {
            ("it needs functions that are known at every point: linear or B-splines", "no such key")
        }
    };
    Err(refused(values, RECONSTRUCTION, problem, allowed))
}
