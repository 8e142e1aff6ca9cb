//! Body force and tractions of a scene.

use super::check::Check;
use super::file::{File, FileTraction, PerAxis};
use super::parts::{Body, BodyForce, Side, Traction};
use super::read::{AXES, axis_of, side_axis};
use crate::scene::fault::SceneError;
use toml::Spanned;

type Loads = (Option<BodyForce>, Option<Traction>);

/// The tables `body_force` and `traction`.
pub fn read(
    check: &Check,
    file: &File,
    body: &Body,
    boundary: &[[Side; 2]],
) -> Result<Loads, Box<SceneError>> {
    let mut loads = (None, None);
    if let Some(table) = &file.body_force {
        let key = "body_force.acceleration";
        let acceleration = check.axes(key, &table.acceleration, |_, b| b.is_finite())?;
        unforced(check, file, key, table.acceleration.span())?;
        let ramp = ramp(check, "body_force.ramp", &table.ramp)?;
        loads.0 = Some(BodyForce { acceleration, ramp });
    }
    if let Some(table) = &file.traction {
        if let (None, Some(ramp)) = (by_name(table).next(), &table.ramp) {
            let problem = "there is no side with a traction";
            return Err(check.source.error("traction.ramp", ramp.span(), problem));
        }
        let nothing = vec![0.0; check.dimension];
        let mut sides = vec![[nothing.clone(), nothing]; check.dimension];
        for (name, value) in by_name(table) {
            let key = format!("traction.{name}");
            let axis = axis_of(check, key.clone(), value.span(), side_axis(name))?;
            let upper = usize::from(AXES[axis].1[1] == name);
            let held = |i: usize| boundary[axis][upper].fixed[i];
            sides[axis][upper] = check.axes(&key, value, |_, t| t.is_finite())?;
            if (0..check.dimension).any(|i| held(i) && sides[axis][upper][i] != 0.0) {
                let problem = "the side is fixed there";
                return Err(check.source.error(&key, value.span(), problem));
            }
            unforced(check, file, &key, value.span())?;
            if !body.balls.is_empty() {
                let problem = "a body of balls has no plane side to load";
                return Err(check.source.error(&key, value.span(), problem));
            }
        }
        let ramp = ramp(check, "traction.ramp", &table.ramp)?;
        loads.1 = Some(Traction { sides, ramp });
    }
    Ok(loads)
}

fn by_name(table: &FileTraction) -> impl Iterator<Item = (&'static str, &Spanned<PerAxis<f64>>)> {
    let FileTraction { ramp: _, left, right, bottom, top, back, front } = table;
    [
        ("left", left),
        ("right", right),
        ("bottom", bottom),
        ("top", top),
        ("back", back),
        ("front", front),
    ]
    .into_iter()
    .filter_map(|(name, side)| side.as_ref().map(|side| (name, side)))
}

/// The body force of a manufactured solution is its own.
fn unforced(
    check: &Check,
    file: &File,
    key: &str,
    span: std::ops::Range<usize>,
) -> Result<(), Box<SceneError>> {
    match &file.manufactured {
        None => Ok(()),
        Some(_) => {
            let problem = "the scene has `manufactured`, which brings its own load";
            Err(check.source.error(key, span, problem))
        }
    }
}

fn ramp(check: &Check, key: &str, ramp: &Option<Spanned<f64>>) -> Result<f64, Box<SceneError>> {
    ramp.as_ref().map_or(Ok(0.0), |ramp| check.number(key, ramp, |time| time >= 0.0))
}
