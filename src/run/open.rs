//! Makes of a scene's text a scene that is ready to run.

use super::stability;
use crate::scene::fault::SceneError;
use crate::scene::{Budget, Scene, declare};

/// Reads a scene from `text`, with the `KEY=VALUE` of `sets` in place of its own; `path`
/// is named in errors. A time step that is declared as a part of the critical one is
/// bounded by the limit that is predicted here. The budget is that of [`Budget::default`].
///
/// Errors: [`SceneError`] with file, line, key and what is allowed.
pub fn parse(
    name: &str,
    path: &str,
    text: &str,
    sets: &[String],
) -> Result<Scene, Box<SceneError>> {
    parse_within(&Budget::default(), name, path, text, sets)
}

/// Reads a scene as [`parse`] does, with another `budget`.
///
/// Errors: [`SceneError`] with file, line, key and what is allowed.
pub fn parse_within(
    budget: &Budget,
    name: &str,
    path: &str,
    text: &str,
    sets: &[String],
) -> Result<Scene, Box<SceneError>> {
    let declared = declare(name, path, text, sets)?;
    declared.affordable(&declared.scene, budget)?;
    let mut scene = declared.scene.clone();
    let Some(fraction) = scene.time.fraction_of_critical else {
        return Ok(scene);
    };
    let key = "time.fraction_of_critical";
    let limit = stability::critical(&scene)
        .map_err(|breakdown| declared.error(key, breakdown.to_string()))?;
    let courant = scene.courant_number_of(limit.used() * fraction);
    scene.time.cfl = scene.time.cfl.min(courant);
    if scene.time.cfl.is_infinite() {
        return Err(declared.error(key, "nothing strains this body: there is no limit"));
    }
    declared.affordable(&scene, budget)?;
    Ok(scene)
}
