//! From the file as written to a checked [`Scene`]: every value in range.

use super::file::*;
use super::*;
use crate::fault::SceneError;
use crate::reading::{StepEight, StressUpdate};
use crate::scene::keys::nearest;
use crate::scene::source::Source;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use toml::Spanned;

/// Names of the axes and of their two sides.
const AXES: [(&str, [&str; 2]); 3] =
    [("x", ["left", "right"]), ("y", ["bottom", "top"]), ("z", ["back", "front"])];

/// Names that columns and files of a run have already.
const TAKEN: [&str; 10] = [
    "step",
    "t",
    "kinetic_energy",
    "strain_energy",
    "momentum",
    "momentum_x",
    "momentum_y",
    "momentum_z",
    "displacement_field",
    "energy",
];

/// The most memory that a scene may ask for (bytes).
const MEMORY: f64 = 16.0 * 1024.0 * 1024.0 * 1024.0;

/// More steps than any run will finish.
const MOST_STEPS: f64 = 1e12;

/// Range checks that know where every value was written.
struct Check<'a> {
    source: &'a Source,
    dimension: usize,
}

impl Check<'_> {
    fn number(
        &self,
        key: &str,
        value: &Spanned<f64>,
        good: impl Fn(f64) -> bool,
    ) -> Result<f64, Box<SceneError>> {
        let x = *value.get_ref();
        if x.is_finite() && good(x) {
            return Ok(x);
        }
        Err(self.source.error(key, value.span(), format!("{x:?} is out of range")))
    }

    /// One entry for each axis, all good.
    fn axes<T: Copy + fmt::Debug>(
        &self,
        key: &str,
        value: &Spanned<PerAxis<T>>,
        good: impl Fn(usize, T) -> bool,
    ) -> Result<Vec<T>, Box<SceneError>> {
        let list = &value.get_ref().0;
        if list.len() != self.dimension {
            let problem = format!(
                "{} given, but the scene has {}, as body.length has {}",
                counted(list.len(), "number"),
                counted(self.dimension, "axis"),
                counted(self.dimension, "entry")
            );
            return Err(self.source.error(key, value.span(), problem));
        }
        match list.iter().enumerate().find(|&(d, x)| !good(d, *x)) {
            None => Ok(list.clone()),
            Some((_, x)) => {
                Err(self.source.error(key, value.span(), format!("{x:?} is out of range")))
            }
        }
    }

    /// The choice that the text names.
    fn choose<T: Copy>(
        &self,
        key: &str,
        text: &str,
        span: Range<usize>,
        choices: &[(&str, T)],
    ) -> Result<T, Box<SceneError>> {
        if let Some((_, choice)) = choices.iter().find(|(name, _)| *name == text) {
            return Ok(*choice);
        }
        let mut error = self.source.error(key, span, format!("\"{text}\" is not known here"));
        error.suggestion = nearest(text, choices.iter().map(|(name, _)| *name));
        Err(error)
    }
}

fn counted(n: usize, word: &str) -> String {
    match (n, word) {
        (1, _) => format!("1 {word}"),
        (_, "axis") => format!("{n} axes"),
        (_, "entry") => format!("{n} entries"),
        _ => format!("{n} {word}s"),
    }
}

/// Reads and checks a scene.
pub fn scene(name: &str, source: &Source) -> Result<Scene, Box<SceneError>> {
    let file: File = source.read()?;
    let length = &file.body.length;
    let dimension = length.get_ref().0.len();
    if !(1..=3).contains(&dimension) {
        let problem = format!("{} given", counted(dimension, "number"));
        return Err(source.error("body.length", length.span(), problem));
    }
    let check = Check { source, dimension };

    let method = check.choose(
        "method",
        file.method.get_ref(),
        file.method.span(),
        &[("mpm", Method::Mpm)],
    )?;
    let mass =
        check.choose("mass", file.mass.get_ref(), file.mass.span(), &[("lumped", Mass::Lumped)])?;
    let body = body(&check, &file.body)?;
    let time = time(&check, &file.time)?;
    let boundary = boundary(&check, &file.boundary)?;
    let grid = grid(&check, &file.grid, &boundary, file.basis.kind.get_ref() == "ugimp")?;
    let basis = basis(&check, &file.basis, &grid)?;
    let initial_velocity = regions(&check, &file.initial_velocity, &body, &grid)?;
    let probes = probes(&check, &file.probe, &body)?;
    let every = match &file.output.every {
        None => 1,
        Some(every) if *every.get_ref() >= 1 => *every.get_ref() as usize,
        Some(every) => {
            let problem = format!("{} is out of range", every.get_ref());
            return Err(source.error("output.every", every.span(), problem));
        }
    };

    if let Some(bad) = file.title.get_ref().chars().find(|c| c.is_control()) {
        let problem = format!("it holds the control character {bad:?}");
        return Err(source.error("title", file.title.span(), problem));
    }
    let scene = Scene {
        name: name.to_string(),
        title: file.title.into_inner(),
        method,
        mass,
        body,
        grid,
        basis,
        time,
        boundary,
        initial_velocity,
        probes,
        every,
    };
    affordable(&check, &scene, &file.grid, &file.time)?;
    Ok(scene)
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
    };
    let c = crate::model::wave_speed(&body);
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

fn time(check: &Check, file: &FileTime) -> Result<Time, Box<SceneError>> {
    Ok(Time {
        integrator: integrator(check, file)?,
        cfl: check.number("time.cfl", &file.cfl, |x| x > 0.0)?,
        end: check.number("time.end", &file.end, |x| x > 0.0)?,
    })
}

/// The scheme with what it needs; keys that mean nothing to it are refused.
fn integrator(check: &Check, file: &FileTime) -> Result<Integrator, Box<SceneError>> {
    let (name, span) = (file.integrator.get_ref().as_str(), file.integrator.span());
    let kinds = [
        ("newmark", "time.reading"),
        ("forward-euler", "time.stress_update"),
        ("corrected-euler", ""),
        ("generalized-alpha", "time.rho_b"),
    ];
    let own = check.choose("time.integrator", name, span.clone(), &kinds)?;
    let given = [
        ("time.reading", file.reading.as_ref().map(Spanned::span)),
        ("time.stress_update", file.stress_update.as_ref().map(Spanned::span)),
        ("time.rho_b", file.rho_b.as_ref().map(Spanned::span)),
    ];
    for (key, span) in given {
        if let Some(span) = span.filter(|_| key != own) {
            let problem = format!("it means nothing to the integrator \"{name}\"");
            return Err(check.source.error(key, span, problem));
        }
    }
    let needs = || {
        check.source.error(own, span.clone(), format!("the integrator \"{name}\" needs this key"))
    };
    match own {
        "time.reading" => {
            let readings =
                [("second-order", StepEight::SecondOrder), ("as-printed", StepEight::AsPrinted)];
            let Some(text) = &file.reading else {
                return Ok(Integrator::Newmark(StepEight::default()));
            };
            check.choose(own, text.get_ref(), text.span(), &readings).map(Integrator::Newmark)
        }
        "time.stress_update" => {
            let orders = [
                ("first", StressUpdate::First),
                ("last", StressUpdate::Last),
                ("modified-last", StressUpdate::ModifiedLast),
            ];
            let text = file.stress_update.as_ref().ok_or_else(needs)?;
            check.choose(own, text.get_ref(), text.span(), &orders).map(Integrator::ForwardEuler)
        }
        "time.rho_b" => {
            let rho_b = file.rho_b.as_ref().ok_or_else(needs)?;
            let rho_b = check.number(own, rho_b, |rho_b| (0.0..=1.0).contains(&rho_b))?;
            Ok(Integrator::GeneralizedAlpha { rho_b })
        }
        _ => Ok(Integrator::CorrectedEuler),
    }
}

/// What a scene's basis needs; keys that mean nothing to it are refused.
fn basis(check: &Check, file: &FileBasis, grid: &GridSpec) -> Result<Basis, Box<SceneError>> {
    let half = |d: usize| grid.particles_per_cell.get(d).map_or(0.5, |n| 0.5 / *n as f64);
    let lme = Basis::Lme { gamma: f64::NAN, cutoff: 1e-6 };
    let kinds = [
        ("linear", Basis::Linear),
        ("ugimp", Basis::Ugimp { half_length: [half(0), half(1), half(2)] }),
        ("lme", lme),
        ("bspline", Basis::BSpline),
    ];
    let kind = check.choose("basis.kind", file.kind.get_ref(), file.kind.span(), &kinds)?;
    let Basis::Lme { mut cutoff, .. } = kind else {
        for (key, value) in [("basis.gamma", &file.gamma), ("basis.cutoff", &file.cutoff)] {
            if let Some(value) = value {
                let problem = format!("it means nothing to the basis \"{}\"", file.kind.get_ref());
                return Err(check.source.error(key, value.span(), problem));
            }
        }
        return Ok(kind);
    };
    let Some(gamma) = &file.gamma else {
        let problem = "the basis \"lme\" needs this key";
        return Err(check.source.error("basis.gamma", file.kind.span(), problem));
    };
    let gamma = check.number("basis.gamma", gamma, |gamma| (1e-6..=1e6).contains(&gamma))?;
    if let Some(value) = &file.cutoff {
        cutoff = check.number("basis.cutoff", value, |tol| (0.0..1.0).contains(&tol))?;
    }
    Ok(Basis::Lme { gamma, cutoff })
}

/// Refuses a side or component that the scene has no axis for.
fn axis_of(
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

fn side_axis(name: &str) -> Option<usize> {
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

fn regions(
    check: &Check,
    file: &[FileRegion],
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
        // Particles stand at equal distances, half of one from the ends.
        let empty = |d: usize| {
            let distance = body.length[d] / (grid.cells[d] * grid.particles_per_cell[d]) as f64;
            let first = libm::ceil(region.from[d] / distance - 0.5).max(0.0);
            (first + 0.5) * distance >= region.to[d]
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

/// Refuses a scene whose arrays would not fit, before any is allocated.
fn affordable(
    check: &Check,
    scene: &Scene,
    grid: &FileGrid,
    time: &FileTime,
) -> Result<(), Box<SceneError>> {
    let (particles, nodes, steps) = scene.sizes();
    let d = scene.dimension() as f64;
    let particle_bytes = 8.0 * (2.0 + 3.0 * d + 2.0 * d * d);
    let pair_bytes = 8.0 * (2.0 + d) * scene.pairs_per_particle();
    let node_bytes = 8.0 * (1.0 + 3.0 * d);
    let rows = steps / scene.every as f64;
    // A number in the table, as text in CSV, and as a point of a picture.
    let row_bytes = 60.0 * (4.0 + d + 2.0 * scene.probes.len() as f64);
    let space = particles * (particle_bytes + pair_bytes) + nodes * node_bytes;
    let limit = MEMORY / 1e9;
    if space > MEMORY {
        let problem = format!("this grid and basis need {:.1} GB of memory", space / 1e9);
        let mut error = check.source.error("grid.cells", grid.cells.span(), problem);
        error.allowed = format!("a grid and basis that need at most {limit:.1} GB");
        return Err(error);
    }
    if steps > MOST_STEPS {
        let problem = format!("with time.cfl and grid.cells it asks for {steps:e} steps");
        let mut error = check.source.error("time.end", time.end.span(), problem);
        error.allowed = format!("at most {MOST_STEPS:e} steps");
        return Err(error);
    }
    if rows * row_bytes > MEMORY {
        let problem = format!(
            "the history of {steps:e} steps needs {:e} GB of memory",
            rows * row_bytes / 1e9
        );
        let mut error = check.source.error("time.end", time.end.span(), problem);
        error.allowed = format!("a history of at most {limit:.1} GB; see also output.every");
        return Err(error);
    }
    Ok(())
}
