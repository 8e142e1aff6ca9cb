//! Reads how the body of a scene moves at the start.

use super::fault::SceneError;
use super::keys::{AXES, SIDES};
use super::parts::{Body, GridSpec, ManufacturedSpec, Motion, Region, Side, VortexSpec};
use super::sizes::wave_speed;
use super::values::{Values, counted};
use crate::method::choice::{Law, Method};
use crate::method::exact::mode::Mode;
use crate::method::quadrature::points;

/// Reads one of the tables `vibration`, `manufactured`, `vortex` and `initial_velocity`, or none.
pub fn motion(
    values: &Values,
    method: Method,
    body: &Body,
    grid: &GridSpec,
    boundary: &[[Side; 2]],
) -> Result<Motion, Box<SceneError>> {
    match only_one(values)? {
        Some("vibration") => Ok(Motion::Vibration {
            mode: mode(values, "vibration.mode", grid)?,
            velocity: values.number("vibration.velocity")?,
        }),
        Some("manufactured") => {
            manufactured(values, body, grid, boundary).map(Motion::Manufactured)
        }
        Some("vortex") => vortex(values, body).map(Motion::Vortex),
        _ => regions(values, method, body, grid).map(Motion::Regions),
    }
}

/// Reads the table `manufactured`.
fn manufactured(
    values: &Values,
    body: &Body,
    grid: &GridSpec,
    boundary: &[[Side; 2]],
) -> Result<ManufacturedSpec, Box<SceneError>> {
    let mode = mode(values, "manufactured.mode", grid)?;
    let waves = |d: usize| {
        let ends = [0, 1].map(|upper: usize| boundary[d][upper].end(d));
        Mode::new(ends, mode, body.length[d]).k
    };
    let k = (0..values.dimension()).map(waves).fold(0.0, f64::max);
    let small = |amplitude: f64| (amplitude * k).abs() < 1.0;
    let amplitude = values.number_if("manufactured.amplitude", small)?;
    if values.dimension() > 1 {
        sliding(values, boundary)?;
    }
    let frequency = match values.has("manufactured.frequency") {
        true => values.number("manufactured.frequency")?,
        false => wave_speed(body) * k,
    };
    Ok(ManufacturedSpec { mode, amplitude, frequency, phase: values.axes("manufactured.phase")? })
}

/// Refuses sides that do not hold the normal component of the velocity, or hold another: the
/// motion slides along all of them.
fn sliding(values: &Values, boundary: &[[Side; 2]]) -> Result<(), Box<SceneError>> {
    for (axis, sides) in boundary.iter().enumerate() {
        for (upper, side) in sides.iter().enumerate() {
            if (0..side.fixed.len()).any(|i| side.fixed[i] != (i == axis)) {
                let name = SIDES[axis][upper];
                let problem = format!("this motion slides along the side `{name}`");
                let allowed =
                    format!("boundary.{name} = {{ {} = \"fixed\" }}, and so on", AXES[axis]);
                return Err(values.error("manufactured", problem).allowing(allowed));
            }
        }
    }
    Ok(())
}

/// Reads the table `vortex`.
fn vortex(values: &Values, body: &Body) -> Result<VortexSpec, Box<SceneError>> {
    if body.law != Law::NeoHookean {
        let problem = "the body force of this motion is that of another law";
        let error = values.error_at("body.law", "vortex", problem);
        return Err(error.allowing("\"neo-hookean\""));
    }
    let half = 0.5 * body.length.iter().copied().fold(f64::INFINITY, f64::min);
    let inside = |radius: f64| 1.25 * radius <= half;
    Ok(VortexSpec {
        radius: values.number_if("vortex.radius", inside)?,
        angle: values.number("vortex.angle")?,
        frequency: values.number("vortex.frequency")?,
    })
}

/// Finds the table that sets the motion, and refuses two, and one in a dimension that it does
/// not have.
fn only_one(values: &Values) -> Result<Option<&'static str>, Box<SceneError>> {
    let mut tables = vec!["vibration", "manufactured", "vortex"];
    tables.retain(|table| values.has(table));
    if !values.entries("initial_velocity").is_empty() {
        tables.push("initial_velocity");
    }
    if let [first, other, ..] = tables[..] {
        let problem = format!("the scene has `{first}`, and only one of them can set the motion");
        return Err(values.error(other, problem));
    }
    let table = tables.first().copied();
    let fits = match table {
        Some("vibration") => values.dimension() == 1,
        Some("vortex") => values.dimension() == 2,
        _ => true,
    };
    match table.filter(|_| !fits) {
        None => Ok(table),
        Some(name) => {
            let problem = format!("the scene has {}", counted(values.dimension(), "axis"));
            Err(values.error(name, problem))
        }
    }
}

/// Reads the number of a mode. It needs two particles for each half wave, or it is another mode
/// that starts.
fn mode(values: &Values, key: &str, grid: &GridSpec) -> Result<usize, Box<SceneError>> {
    let n = values.whole(key)?;
    let along = |d: usize| grid.cells[d].saturating_mul(grid.particles_per_cell[d]);
    let places = (0..values.dimension()).map(along).min().unwrap_or(0);
    if 2 * n > places {
        return Err(values.error(key, format!("{places} particles cannot show mode {n}")));
    }
    Ok(n)
}

fn regions(
    values: &Values,
    method: Method,
    body: &Body,
    grid: &GridSpec,
) -> Result<Vec<Region>, Box<SceneError>> {
    let mut regions: Vec<Region> = Vec::new();
    for entry in values.entries("initial_velocity") {
        let region = region(values, &entry, body)?;
        if let Some(other) = regions.iter().position(|other| overlap(&region, other)) {
            let problem = format!("this region overlaps initial_velocity[{other}]");
            return Err(values.error(&format!("{entry}.from"), problem));
        }
        if (0..values.dimension()).any(|d| is_empty(&region, d, method, body, grid)) {
            return Err(values.error(&format!("{entry}.to"), "no particle lies in this region"));
        }
        regions.push(region);
    }
    Ok(regions)
}

fn region(values: &Values, entry: &str, body: &Body) -> Result<Region, Box<SceneError>> {
    let upper = |d: usize| body.origin[d] + body.length[d];
    let in_body = |d: usize, x: f64| body.origin[d] <= x && x < upper(d);
    let from = values.axes_if(&format!("{entry}.from"), in_body)?;
    let above = |d: usize, x: f64| from[d] < x && x <= upper(d);
    let to = values.axes_if(&format!("{entry}.to"), above)?;
    let spin = format!("{entry}.spin");
    if values.has(&spin) && values.dimension() != 2 {
        let problem = format!("the scene has {}", counted(values.dimension(), "axis"));
        return Err(values.error(&spin, problem));
    }
    Ok(Region {
        velocity: values.axes(&format!("{entry}.velocity"))?,
        spin: if values.has(&spin) { values.number(&spin)? } else { 0.0 },
        from: (0..values.dimension()).map(|d| from[d] - body.origin[d]).collect(),
        to: (0..values.dimension())
            // The body's own corner, to the last bit, where the region ends with it.
            .map(|d| if to[d] == upper(d) { body.length[d] } else { to[d] - body.origin[d] })
            .collect(),
    })
}

fn overlap(one: &Region, other: &Region) -> bool {
    (0..one.from.len()).all(|d| one.from[d] < other.to[d] && other.from[d] < one.to[d])
}

/// Tells whether no particle of the cell at the region's lower corner, nor of the next, stands
/// in it along axis `d`.
fn is_empty(region: &Region, d: usize, method: Method, body: &Body, grid: &GridSpec) -> bool {
    let h = body.length[d] / grid.cells[d] as f64;
    let cell = libm::floor(region.from[d] / h);
    let inside = |x: f64| region.from[d] <= x && x < region.to[d];
    let points = points(method, grid.particles_per_cell[d]);
    !points.iter().any(|[xi, _]| inside((cell + xi) * h) || inside((cell + 1.0 + xi) * h))
}
