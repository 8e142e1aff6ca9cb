//! Reads the body force and the tractions of a scene.

use super::fault::SceneError;
use super::parts::{BodyForceSpec, Side, TractionSpec};
use super::values::Values;

/// Reads the table `body_force`.
pub fn body_force(values: &Values) -> Result<Option<BodyForceSpec>, Box<SceneError>> {
    if !values.has("body_force") {
        return Ok(None);
    }
    let key = "body_force.acceleration";
    let acceleration = values.axes(key)?;
    unforced(values, key)?;
    Ok(Some(BodyForceSpec { acceleration, ramp: ramp(values, "body_force.ramp")? }))
}

/// Reads the table `traction`.
pub fn traction(
    values: &Values,
    boundary: &[[Side; 2]],
) -> Result<Option<TractionSpec>, Box<SceneError>> {
    if !values.has("traction") {
        return Ok(None);
    }
    let given = values.sides("traction")?;
    if given.is_empty() && values.has("traction.ramp") {
        return Err(values.error("traction.ramp", "there is no side with a traction"));
    }
    let nothing = vec![0.0; values.dimension()];
    let mut sides = vec![[nothing.clone(), nothing]; values.dimension()];
    for side in given {
        let t = values.axes(&side.path)?;
        let fixed = &boundary[side.axis][side.upper].fixed;
        if t.iter().zip(fixed).any(|(t, fixed)| *fixed && *t != 0.0) {
            return Err(values.error(&side.path, "the side is fixed there"));
        }
        unforced(values, &side.path)?;
        if !values.entries("body.ball").is_empty() {
            return Err(values.error(&side.path, "a body of balls has no plane side to load"));
        }
        sides[side.axis][side.upper] = t;
    }
    Ok(Some(TractionSpec { sides, ramp: ramp(values, "traction.ramp")? }))
}

/// Reads the time over which a load grows (s); that of a quasi-static run grows to the end of it.
fn ramp(values: &Values, key: &str) -> Result<f64, Box<SceneError>> {
    match values.word("time.integrator")? {
        "quasi-static" => values.number("time.end"),
        _ => values.number(key),
    }
}

/// Refuses a load beside the body force that keeps a chosen motion going.
fn unforced(values: &Values, key: &str) -> Result<(), Box<SceneError>> {
    match ["manufactured", "vortex"].into_iter().find(|table| values.has(table)) {
        None => Ok(()),
        Some(table) => {
            let problem = format!("the scene has `{table}`, which brings its own load");
            Err(values.error(key, problem))
        }
    }
}
