//! Says which exact solution a scene has.

use crate::method::exact::column::Column;
use crate::method::exact::forced::{Forced, Load};
use crate::method::exact::manufactured::Manufactured;
use crate::method::exact::mode::{Mode, Vibration};
use crate::method::exact::riemann::{Bar, End, Patch};
use crate::method::exact::vortex::Vortex;
use crate::method::exact::{Exact, Moved};
use crate::scene::fault::Fault;
use crate::scene::{Motion, Scene, wave_speed};

/// Finds the exact solution of `scene`.
///
/// Errors: [`Fault::NoExact`] with the reason.
pub fn exact<const D: usize>(scene: &Scene) -> Result<Exact<D>, Fault> {
    if let Some(moved) = moved(scene) {
        return Ok(Exact::Moved(moved));
    }
    if D > 1 {
        return Err(Fault::NoExact { why: "it has more than one dimension" });
    }
    if scene.time.load_steps.is_some() {
        return column(scene).map(Exact::Static);
    }
    let ends = scene.ends(0);
    let (length, density, modulus) =
        (scene.body.length[0], scene.body.density, scene.body.elastic().p_wave_modulus());
    let c = wave_speed(&scene.body);
    let mut thrown = Bar { length, density, modulus, ends, patches: Vec::new() };
    let mut vibration = None;
    match &scene.motion {
        Motion::Regions(regions) => {
            thrown.patches = regions
                .iter()
                .map(|a| Patch { from: a.from[0], to: a.to[0], velocity: a.velocity[0] })
                .collect();
        }
        Motion::Vibration { mode, velocity } => {
            let mode = Mode::new(ends, *mode, length);
            vibration = Some(Vibration { mode, velocity: *velocity, c, modulus });
        }
        Motion::Manufactured(_) | Motion::Vortex(_) => {} // returned above
    }
    let forced = forced(scene, ends, c);
    Ok(Exact::Linear { thrown, vibration, forced })
}

/// Finds the equilibrium of a loaded bar.
fn column(scene: &Scene) -> Result<Column, Fault> {
    let why = "its bar is not held at just one end, or cannot bear its loads";
    let (body, traction) = loads(scene);
    let sizes = (scene.body.length[0], scene.body.density);
    Column::new(sizes, scene.body.elastic(), scene.ends(0), body, traction)
        .ok_or(Fault::NoExact { why })
}

/// Tells whether a scene has an exact solution, whatever its dimension.
///
/// Errors: [`Fault::NoExact`] with the reason.
pub fn has_exact(scene: &Scene) -> Result<(), Fault> {
    match scene.dimension() {
        1 => exact::<1>(scene).map(|_| ()),
        2 => exact::<2>(scene).map(|_| ()),
        _ => exact::<3>(scene).map(|_| ()),
    }
}

/// Gives the chosen motion of a scene; `None` for a scene that moves by itself.
pub fn moved<const D: usize>(scene: &Scene) -> Option<Moved<D>> {
    let (density, material) = (scene.body.density, scene.body.elastic());
    match &scene.motion {
        Motion::Manufactured(spec) => Some(Moved::Manufactured(Manufactured {
            modes: std::array::from_fn(|d| {
                Mode::new(scene.ends(d), spec.mode, scene.body.length[d])
            }),
            amplitude: spec.amplitude,
            omega: spec.frequency,
            phase: std::array::from_fn(|d| spec.phase[d]),
            density,
            material,
        })),
        Motion::Vortex(spec) => Some(Moved::Vortex(Vortex {
            centre: std::array::from_fn(|d| 0.5 * scene.body.length[d]),
            radius: spec.radius,
            angle: spec.angle,
            omega: spec.frequency,
            density,
            material,
        })),
        Motion::Regions(_) | Motion::Vibration { .. } => None,
    }
}

/// Gives what the loads of a scene do to the bar; `None` without loads.
fn forced(scene: &Scene, ends: [End; 2], c: f64) -> Option<Forced> {
    if scene.body_force.is_none() && scene.traction.is_none() {
        return None;
    }
    let (body, traction) = loads(scene);
    Some(Forced {
        length: scene.body.length[0],
        c,
        Z: scene.body.density * c,
        ends,
        body,
        traction,
    })
}

/// Gives the body force of a bar, and the tractions on its ends.
fn loads(scene: &Scene) -> (Load, [Load; 2]) {
    let side = |upper: usize| {
        let traction = scene.traction.as_ref();
        traction.map_or(Load::default(), |t| Load { value: t.sides[0][upper][0], ramp: t.ramp })
    };
    let body = scene.body_force.as_ref();
    let body = body.map_or(Load::default(), |b| Load { value: b.acceleration[0], ramp: b.ramp });
    (body, [side(0), side(1)])
}
