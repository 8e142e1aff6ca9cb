//! From the file as written to a checked [`Scene`]: every value in range.

use super::check::{Check, counted};
use super::fault::SceneError;
use super::file::*;
use super::limits::affordable;
use super::loads;
use super::parts::*;
use super::scheme::{basis, integrator, otm, time};
use super::sizes::wave_speed;
use super::source::{Source, Spans};
use crate::method::choice::{Mass, Method};
use crate::method::exact::mode::Mode;
use crate::method::quadrature::points;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

/// Names of the axes and of their two sides.
pub const AXES: [(&str, [&str; 2]); 3] =
    [("x", ["left", "right"]), ("y", ["bottom", "top"]), ("z", ["back", "front"])];

/// Names that columns and files of a run have already.
const TAKEN: [&str; 18] = [
    "step",
    "t",
    "kinetic_energy",
    "strain_energy",
    "momentum",
    "momentum_x",
    "momentum_y",
    "momentum_z",
    "work",
    "particles",
    "angular_momentum",
    "angular_momentum_x",
    "angular_momentum_y",
    "angular_momentum_z",
    "displacement_field",
    "velocity_field",
    "stress_field",
    "energy",
];

/// A scene with the places where its values were written.
pub struct Declared {
    pub scene: Scene,
    source: Source,
    spans: Spans,
}

impl Declared {
    /// The error `problem` with the value of `key`, wherever it was written.
    pub fn error(&self, key: &str, problem: impl Into<String>) -> Box<SceneError> {
        self.source.error(key, self.spans.of(key), problem)
    }

    /// Refuses a scene with these keys whose arrays would not fit.
    ///
    /// Errors: [`SceneError`] with the key that asks for too much.
    pub fn affordable(&self, scene: &Scene) -> Result<(), Box<SceneError>> {
        affordable(scene, &|key, problem| self.error(key, problem))
    }
}

/// Reads a scene from `text`, with the `KEY=VALUE` of `sets` in place of its own; `path`
/// is named in errors.
///
/// Errors: [`SceneError`] with file, line, key and what is allowed.
pub fn declare(
    name: &str,
    path: &str,
    text: &str,
    sets: &[String],
) -> Result<Declared, Box<SceneError>> {
    let source = Source::new(path, text, sets);
    let (file, spans) = source.read()?;
    let scene = scene(name, &source, file)?;
    let declared = Declared { scene, source, spans };
    declared.affordable(&declared.scene)?;
    Ok(declared)
}

fn scene(name: &str, source: &Source, file: File) -> Result<Scene, Box<SceneError>> {
    let length = &file.body.length;
    let dimension = length.get_ref().0.len();
    if !(1..=3).contains(&dimension) {
        let problem = format!("{} given", counted(dimension, "number"));
        return Err(source.error("body.length", length.span(), problem));
    }
    let check = Check { source, dimension };

    let methods = [("mpm", false), ("otm", true)];
    let is_otm = check.choose("method", file.method.get_ref(), file.method.span(), &methods)?;
    let masses = [("lumped", Mass::Lumped), ("consistent", Mass::Consistent)];
    let mass = check.choose("mass", file.mass.get_ref(), file.mass.span(), &masses)?;
    let body = body(&check, &file.body)?;
    let time = time(&check, &file.time)?;
    let integrator = integrator(&check, &file.time)?;
    let boundary = boundary(&check, &file.boundary)?;
    let mut grid = grid(&check, &file.grid, &boundary, file.basis.kind.get_ref() == "ugimp")?;
    let method = if is_otm { Method::Otm } else { Method::Mpm(integrator) };
    if is_otm {
        otm(&check, &file)?;
        grid.beyond.fill([0, 0]);
    }
    let basis = basis(&check, &file.basis, &grid)?;
    filled(&check, &file.body.ball, &body, &grid)?;
    let motion = motion(&check, &file, method, &body, &grid, &boundary)?;
    let (body_force, traction) = loads::read(&check, &file, &body, &boundary)?;
    let probes = probes(&check, &file.probe, &body)?;
    let every = match &file.output.every {
        None => 1,
        Some(every) if *every.get_ref() >= 1 => *every.get_ref() as usize,
        Some(every) => {
            let problem = format!("{} is out of range", every.get_ref());
            return Err(source.error("output.every", every.span(), problem));
        }
    };

    let vtk = file.output.vtk.as_ref().is_some_and(|vtk| *vtk.get_ref());
    if let Some(value) = file.output.vtk.as_ref().filter(|vtk| dimension == 1 && *vtk.get_ref()) {
        let problem = "it means nothing in 1D";
        return Err(source.error("output.vtk", value.span(), problem));
    }

    if let Some(bad) = file.title.get_ref().chars().find(|c| c.is_control()) {
        let problem = format!("it holds the control character {bad:?}");
        return Err(source.error("title", file.title.span(), problem));
    }
    Ok(Scene {
        name: name.to_string(),
        title: file.title.into_inner(),
        method,
        mass,
        body,
        grid,
        basis,
        time,
        boundary,
        motion,
        body_force,
        traction,
        probes,
        every,
        vtk,
    })
}

fn body(check: &Check, file: &FileBody) -> Result<Body, Box<SceneError>> {
    let positive = |x: f64| x > 0.0;
    let body = Body {
        length: check.axes("body.length", &file.length, |_, x| x.is_finite() && x > 0.0)?,
        origin: match &file.origin {
            None => vec![0.0; check.dimension],
            Some(origin) => check.axes("body.origin", origin, |_, x| x.is_finite())?,
        },
        density: check.number("body.density", &file.density, positive)?,
        youngs_modulus: check.number("body.youngs_modulus", &file.youngs_modulus, positive)?,
        poisson_ratio: check
            .number("body.poisson_ratio", &file.poisson_ratio, |nu| -1.0 < nu && nu < 0.5)?,
        balls: Vec::new(),
    };
    let body = Body { balls: balls(check, &file.ball, &body)?, ..body };
    let c = wave_speed(&body);
    let impedance = body.density * c;
    let normal = |x: f64| x.is_normal() && x.recip().is_normal();
    if !(normal(c) && normal(impedance)) {
        let problem = format!(
            "with body.density: the wave speed {c:e} m/s, the impedance {impedance:e} Pa s/m"
        );
        let mut error =
            check.source.error("body.youngs_modulus", file.youngs_modulus.span(), problem);
        error.allowed =
            "moduli whose wave speed √((λ + 2μ)/ρ) and impedance are ordinary numbers".into();
        return Err(error);
    }
    Ok(body)
}

fn balls(check: &Check, file: &[FileBall], body: &Body) -> Result<Vec<Ball>, Box<SceneError>> {
    let mut balls = Vec::new();
    for (n, entry) in file.iter().enumerate() {
        let key = |name: &str| format!("body.ball[{n}].{name}");
        if check.dimension == 1 {
            let problem = "a bar has no balls: the scene has 1 axis";
            return Err(check.source.error(&key("centre"), entry.centre.span(), problem));
        }
        let inside = |d: usize, x: f64| body.origin[d] < x && x < body.origin[d] + body.length[d];
        let centre = check.axes(&key("centre"), &entry.centre, inside)?;
        let from_corner: Vec<f64> =
            centre.iter().zip(&body.origin).map(|(x, origin)| x - origin).collect();
        let room = (0..check.dimension)
            .map(|d| from_corner[d].min(body.length[d] - from_corner[d]))
            .fold(f64::INFINITY, f64::min);
        // A ball may touch the side, up to the round-off of its centre.
        let radius = check.number(&key("radius"), &entry.radius, |radius| {
            radius > 0.0 && radius <= room * (1.0 + 1e-12)
        })?;
        balls.push(Ball { centre: from_corner, radius });
    }
    Ok(balls)
}

/// Every ball holds a particle.
fn filled(
    check: &Check,
    file: &[FileBall],
    body: &Body,
    grid: &GridSpec,
) -> Result<(), Box<SceneError>> {
    for (n, (ball, entry)) in body.balls.iter().zip(file).enumerate() {
        // From the centre to the particle place that is nearest along each axis.
        let offset = |d: usize| {
            let places = (grid.cells[d] * grid.particles_per_cell[d]) as f64;
            let distance = body.length[d] / places;
            let place = libm::floor(ball.centre[d] / distance).clamp(0.0, places - 1.0);
            ball.centre[d] - (place + 0.5) * distance
        };
        let square: f64 = (0..check.dimension).map(|d| offset(d) * offset(d)).sum();
        if square > ball.radius * ball.radius {
            let problem = "no particle lies in this ball";
            let key = format!("body.ball[{n}].radius");
            let mut error = check.source.error(&key, entry.radius.span(), problem);
            error.allowed = format!("here a radius of at least {:e} m", libm::sqrt(square));
            return Err(error);
        }
    }
    Ok(())
}

/// Refuses a side or component that the scene has no axis for.
pub fn axis_of(
    check: &Check,
    key: String,
    span: Range<usize>,
    axis: Option<usize>,
) -> Result<usize, Box<SceneError>> {
    match axis {
        Some(axis) if axis < check.dimension => Ok(axis),
        _ => {
            let problem = format!(
                "the scene has {}, and this names another",
                counted(check.dimension, "axis")
            );
            Err(check.source.error(&key, span, problem))
        }
    }
}

fn boundary(
    check: &Check,
    file: &BTreeMap<String, Spanned<FileSide>>,
) -> Result<Vec<[Side; 2]>, Box<SceneError>> {
    let states = [("fixed", true), ("free", false)];
    let free = Side { fixed: vec![false; check.dimension] };
    let mut boundary = vec![[free.clone(), free]; check.dimension];
    for (name, entry) in file {
        let key = format!("boundary.{name}");
        let axis = axis_of(check, key.clone(), entry.span(), side_axis(name))?;
        let upper = usize::from(AXES[axis].1[1] == name);
        let fixed = &mut boundary[axis][upper].fixed;
        match entry.get_ref() {
            FileSide::Whole(text) => {
                let state = check.choose(&key, text, entry.span(), &states)?;
                fixed.fill(state);
            }
            FileSide::Each(components) => {
                for (component, text) in components {
                    let key = format!("{key}.{component}");
                    let i = AXES.iter().position(|(x, _)| x == component);
                    let i = axis_of(check, key.clone(), text.span(), i)?;
                    fixed[i] = check.choose(&key, text.get_ref(), text.span(), &states)?;
                }
            }
        }
    }
    Ok(boundary)
}

pub fn side_axis(name: &str) -> Option<usize> {
    AXES.iter().position(|(_, sides)| sides.contains(&name))
}

fn grid(
    check: &Check,
    file: &FileGrid,
    boundary: &[[Side; 2]],
    ugimp: bool,
) -> Result<GridSpec, Box<SceneError>> {
    let cells = check.axes("grid.cells", &file.cells, |_, n| n >= 1)?;
    let per_cell = check
        .axes("grid.particles_per_cell", &file.particles_per_cell, |_, n| (1..=64).contains(&n))?;
    // A body leaves the grid only through a side that lets it move, but the
    // particles of uGIMP reach beyond their centres.
    let mut beyond: Vec<[usize; 2]> = (0..check.dimension)
        .map(|d| [0, 1].map(|upper| usize::from(ugimp || !boundary[d][upper].fixed[d])))
        .collect();
    for (name, n) in &file.beyond {
        let key = format!("grid.beyond.{name}");
        let axis = axis_of(check, key.clone(), n.span(), side_axis(name))?;
        if *n.get_ref() < 0 {
            let problem = format!("{} is out of range", n.get_ref());
            return Err(check.source.error(&key, n.span(), problem));
        }
        beyond[axis][usize::from(AXES[axis].1[1] == name)] = *n.get_ref() as usize;
    }
    Ok(GridSpec {
        cells: cells.iter().map(|n| *n as usize).collect(),
        particles_per_cell: per_cell.iter().map(|n| *n as usize).collect(),
        beyond,
    })
}

/// How the body moves at the start: one of three tables, or none.
fn motion(
    check: &Check,
    file: &File,
    method: Method,
    body: &Body,
    grid: &GridSpec,
    boundary: &[[Side; 2]],
) -> Result<Motion, Box<SceneError>> {
    let vibration = file.vibration.as_ref().map(|table| ("vibration", table.span()));
    let manufactured = file.manufactured.as_ref().map(|table| ("manufactured", table.span()));
    let mut tables: Vec<(&str, Range<usize>)> =
        [vibration, manufactured].into_iter().flatten().collect();
    let thrown = file.initial_velocity.first().map(|first| ("initial_velocity", first.from.span()));
    tables.extend(thrown);
    if let [(name, _), (other, span), ..] = tables.as_slice() {
        let problem = format!("the scene has `{name}`, and only one of them can set the motion");
        return Err(check.source.error(other, span.clone(), problem));
    }
    let mode = tables.first().filter(|(name, _)| *name != "initial_velocity");
    if let Some((name, span)) = mode.filter(|_| check.dimension > 1) {
        let problem = format!("the scene has {}", counted(check.dimension, "axis"));
        return Err(check.source.error(name, span.clone(), problem));
    }
    let number = |key: &str, mode: &Spanned<i64>| match *mode.get_ref() {
        n @ 1..=1000 => Ok(n as usize),
        n => Err(check.source.error(key, mode.span(), format!("{n} is out of range"))),
    };
    // Two particles for each half wave, or it is another mode that starts.
    let resolved = |key: &str, mode: &Spanned<i64>, n: usize| {
        let places = grid.cells[0] * grid.particles_per_cell[0];
        match 2 * n <= places {
            true => Ok(n),
            false => {
                let problem = format!("{places} particles cannot show mode {n}");
                Err(check.source.error(key, mode.span(), problem))
            }
        }
    };
    if let Some(table) = file.vibration.as_ref().map(Spanned::get_ref) {
        let mode = number("vibration.mode", &table.mode)?;
        let mode = resolved("vibration.mode", &table.mode, mode)?;
        let velocity = check.number("vibration.velocity", &table.velocity, |_| true)?;
        return Ok(Motion::Vibration { mode, velocity });
    }
    if let Some(table) = file.manufactured.as_ref().map(Spanned::get_ref) {
        let mode = number("manufactured.mode", &table.mode)?;
        let mode = resolved("manufactured.mode", &table.mode, mode)?;
        let ends = [0, 1].map(|upper: usize| boundary[0][upper].end());
        let k = Mode::new(ends, mode, body.length[0]).k;
        let key = "manufactured.amplitude";
        let amplitude = check.number(key, &table.amplitude, |a| (a * k).abs() < 1.0)?;
        return Ok(Motion::Manufactured { mode, amplitude });
    }
    regions(check, &file.initial_velocity, method, body, grid).map(Motion::Regions)
}

fn regions(
    check: &Check,
    file: &[FileRegion],
    method: Method,
    body: &Body,
    grid: &GridSpec,
) -> Result<Vec<Region>, Box<SceneError>> {
    let mut regions: Vec<Region> = Vec::new();
    for (n, entry) in file.iter().enumerate() {
        let key = |name: &str| format!("initial_velocity[{n}].{name}");
        let upper = |d: usize| body.origin[d] + body.length[d];
        let from =
            check.axes(&key("from"), &entry.from, |d, x| body.origin[d] <= x && x < upper(d))?;
        let to = check.axes(&key("to"), &entry.to, |d, x| from[d] < x && x <= upper(d))?;
        let region = Region {
            velocity: check.axes(&key("velocity"), &entry.velocity, |_, v| v.is_finite())?,
            from: (0..check.dimension).map(|d| from[d] - body.origin[d]).collect(),
            to: (0..check.dimension)
                // The body's own corner, to the last bit, where the region ends with it.
                .map(|d| if to[d] == upper(d) { body.length[d] } else { to[d] - body.origin[d] })
                .collect(),
        };
        let overlaps = |other: &Region| {
            (0..check.dimension)
                .all(|d| region.from[d] < other.to[d] && other.from[d] < region.to[d])
        };
        if let Some(other) = regions.iter().position(overlaps) {
            let problem = format!("this region overlaps initial_velocity[{other}]");
            return Err(check.source.error(&key("from"), entry.from.span(), problem));
        }
        // A region that no particle of the cell at its lower corner, nor of the next,
        // stands in.
        let empty = |d: usize| {
            let h = body.length[d] / grid.cells[d] as f64;
            let cell = libm::floor(region.from[d] / h);
            let points = points(method, grid.particles_per_cell[d]);
            let inside = |x: f64| region.from[d] <= x && x < region.to[d];
            !points.iter().any(|[xi, _]| inside((cell + xi) * h) || inside((cell + 1.0 + xi) * h))
        };
        if (0..check.dimension).any(empty) {
            let problem = "no particle lies in this region";
            return Err(check.source.error(&key("to"), entry.to.span(), problem));
        }
        regions.push(region);
    }
    Ok(regions)
}

fn probes(check: &Check, file: &[FileProbe], body: &Body) -> Result<Vec<Probe>, Box<SceneError>> {
    let mut probes: Vec<Probe> = Vec::new();
    for (n, entry) in file.iter().enumerate() {
        let key = |name: &str| format!("probe[{n}].{name}");
        let name = entry.name.get_ref();
        let plain = (1..=64).contains(&name.len())
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        // Files on some systems do not tell upper from lower case.
        let used = probes.iter().any(|probe| probe.name.eq_ignore_ascii_case(name))
            || name.ends_with("_exact")
            || TAKEN.contains(&name.to_ascii_lowercase().as_str());
        if !plain || used {
            let problem = if used { "is taken" } else { "cannot name a column and a file" };
            let problem = format!("\"{name}\" {problem}");
            return Err(check.source.error(&key("name"), entry.name.span(), problem));
        }
        let position = check.axes(&key("position"), &entry.position, |d, x| {
            body.origin[d] <= x && x <= body.origin[d] + body.length[d]
        })?;
        probes.push(Probe {
            name: name.clone(),
            quantity: quantity(check, entry, &key)?,
            position: (0..check.dimension).map(|d| position[d] - body.origin[d]).collect(),
        });
    }
    Ok(probes)
}

fn quantity(
    check: &Check,
    entry: &FileProbe,
    key: &dyn Fn(&str) -> String,
) -> Result<Quantity, Box<SceneError>> {
    let kinds = [
        ("velocity", Quantity::Velocity(0)),
        ("stress", Quantity::Stress(0, 0)),
        ("displacement", Quantity::Displacement(0)),
    ];
    let kind =
        check.choose(&key("quantity"), entry.quantity.get_ref(), entry.quantity.span(), &kinds)?;
    let Some(component) = &entry.component else {
        if check.dimension == 1 {
            return Ok(kind);
        }
        let problem = "in 2D and 3D a probe needs the key `component`";
        return Err(check.source.error(&key("component"), entry.quantity.span(), problem));
    };
    let axes: Vec<usize> = component
        .get_ref()
        .chars()
        .filter_map(|c| AXES[..check.dimension].iter().position(|(x, _)| x.starts_with(c)))
        .collect();
    let complete = axes.len() == component.get_ref().len();
    match (kind, axes.as_slice()) {
        (Quantity::Velocity(_), &[i]) if complete => Ok(Quantity::Velocity(i)),
        (Quantity::Displacement(_), &[i]) if complete => Ok(Quantity::Displacement(i)),
        (Quantity::Stress(..), &[i, j]) if complete => Ok(Quantity::Stress(i, j)),
        _ => {
            let problem = format!("\"{}\" is not a component of it", component.get_ref());
            Err(check.source.error(&key("component"), component.span(), problem))
        }
    }
}
