//! Refuses what means nothing with an implicit scheme, and what a run without inertia lacks.

use super::fault::SceneError;
use super::keys::AXES;
use super::parts::Side;
use super::scheme::is_implicit;
use super::values::Values;

const NO_LIMIT: &str = "no time step is too large to be stable";
const NO_INERTIA: &str = "there is no inertia, and so no motion but that of the loads";
const TO_THE_END: &str = "loads grow until time.end";

/// These keys mean nothing with either of them.
const REFUSED: [(&str, &str); 3] = [
    ("time.fraction_of_critical", NO_LIMIT),
    ("time.allow_unstable", NO_LIMIT),
    ("time.watch", NO_LIMIT),
];

/// Nor do these where there is no inertia.
const REFUSED_AT_REST: [(&str, &str); 7] = [
    ("time.cfl", "time.load_steps counts the steps"),
    ("initial_velocity", NO_INERTIA),
    ("vibration", NO_INERTIA),
    ("manufactured", NO_INERTIA),
    ("vortex", NO_INERTIA),
    ("body_force.ramp", TO_THE_END),
    ("traction.ramp", TO_THE_END),
];

/// Refuses keys and words that make no sense with the integrator of the scene.
///
/// Test: `implicit_refuses_what_makes_no_sense`.
pub fn implicit(values: &Values, boundary: &[[Side; 2]]) -> Result<(), Box<SceneError>> {
    if !is_implicit(values)? {
        return Ok(());
    }
    refuse_keys(values, &REFUSED)?;
    if values.word("time.kinematics")? == "as-printed" && values.has("time.kinematics") {
        let problem = "the strain is always that of the map which moves the particles";
        return Err(refused(values, ["time.kinematics"; 2], problem, "\"consistent\""));
    }
    if values.word("time.integrator")? != "quasi-static" {
        return Ok(());
    }
    refuse_keys(values, &REFUSED_AT_REST)?;
    if values.word("mass")? != "lumped" {
        let problem = "no mass matrix is solved with";
        return Err(refused(values, ["mass"; 2], problem, "\"lumped\""));
    }
    if !(values.has("body_force") || values.has("traction")) {
        let place = ["body_force", "time.integrator"];
        return Err(refused(values, place, "something must load the body", "a load"));
    }
    let held = |i: usize| boundary.iter().flatten().any(|side| side.fixed[i]);
    match (0..values.dimension()).find(|i| !held(*i)) {
        None => Ok(()),
        Some(i) => {
            let problem = format!("no side holds the body along {}", AXES[i]);
            let allowed = "for each axis a side that is fixed along it";
            Err(refused(values, ["boundary", "time.integrator"], &problem, allowed))
        }
    }
}

/// Refuses the first of these keys that the scene has.
fn refuse_keys(values: &Values, keys: &[(&str, &str)]) -> Result<(), Box<SceneError>> {
    match keys.iter().find(|(key, _)| values.has(key)) {
        None => Ok(()),
        Some((key, problem)) => Err(refused(values, [key; 2], problem, "no such key")),
    }
}

/// Makes the error of `key`, shown at the value of `other`.
fn refused(
    values: &Values,
    [key, other]: [&str; 2],
    problem: &str,
    allowed: &str,
) -> Box<SceneError> {
    let word = values.word("time.integrator").unwrap_or_default();
    let problem = format!("with the integrator \"{word}\" {problem}");
    values.error_at(key, other, problem).allowing(allowed)
}
