//! Makes of the values as written a checked [`Scene`].

use super::fault::SceneError;
use super::forces::forces;
use super::implicit::implicit;
use super::limits::{Budget, affordable};
use super::loading::{body_force, traction};
use super::motion::motion;
use super::parts::*;
use super::probes::probes;
use super::scheme::{basis, filter, integrator, kinematics, nodal_mass, otm, time};
use super::sizes::wave_speed;
use super::source::Source;
use super::values::{Values, counted};
use crate::method::choice::{Law, Mass, Method};

/// A body has one of these laws.
const LAWS: [(&str, Law); 3] =
    [("rate", Law::Rate), ("neo-hookean", Law::NeoHookean), ("hencky", Law::Hencky)];

/// A declared scene knows the places where its values were written.
pub struct Declared {
    pub scene: Scene,
    values: Values,
}

impl Declared {
    /// Makes the error `problem` with the value of `key`, wherever it was written.
    pub fn error(&self, key: &str, problem: impl Into<String>) -> Box<SceneError> {
        self.values.error(key, problem)
    }

    /// Refuses a scene with these keys that would need more than the `budget`.
    ///
    /// Errors: [`SceneError`] with the key that asks for too much.
    pub fn affordable(&self, scene: &Scene, budget: &Budget) -> Result<(), Box<SceneError>> {
        affordable(scene, budget)
            .map_err(|excess| self.error(excess.key, excess.problem).allowing(excess.allowed))
    }
}

/// Reads a scene from `text`, with the `KEY=VALUE` of `sets` in place of its own; `path`
/// is named in errors. Whether it can be afforded is another question,
/// [`Declared::affordable`].
///
/// Errors: [`SceneError`] with file, line, key and what is allowed.
pub fn declare(
    name: &str,
    path: &str,
    text: &str,
    sets: &[String],
) -> Result<Declared, Box<SceneError>> {
    let values = Values::read(Source::new(path, text, sets))?;
    let scene = scene(name, &values)?;
    Ok(Declared { scene, values })
}

fn scene(name: &str, values: &Values) -> Result<Scene, Box<SceneError>> {
    let is_otm = values.choose("method", &[("mpm", false), ("otm", true)])?;
    let masses = [("lumped", Mass::Lumped), ("consistent", Mass::Consistent)];
    let mass = values.choose("mass", &masses)?;
    let body = body(values)?;
    let time = time(values)?;
    let method = match is_otm {
        true => Method::Otm(nodal_mass(values)?),
        false => Method::Mpm(integrator(values)?),
    };
    let boundary = boundary(values)?;
    let mut grid = grid(values, &boundary)?;
    implicit(values, &boundary)?;
    if is_otm {
        otm(values)?;
        grid.beyond.fill([0, 0]);
    }
    crossed(values, &body, &grid)?;
    let basis = basis(values, &grid)?;
    filled(values, &body, &grid)?;
    let motion = motion(values, method, &body, &grid, &boundary)?;
    let probes = probes(values, &body)?;
    Ok(Scene {
        name: name.to_string(),
        title: values.word("title")?.to_string(),
        method,
        mass,
        kinematics: kinematics(values)?,
        filter: filter(values)?,
        reconstruction: forces(values, basis)?,
        body,
        grid,
        basis,
        time,
        check: check(values)?,
        traction: traction(values, &boundary)?,
        boundary,
        motion,
        body_force: body_force(values)?,
        probes,
        every: values.whole("output.every")?,
        vtk: vtk(values)?,
    })
}

fn check(values: &Values) -> Result<Check, Box<SceneError>> {
    let (energy, rotation) = (values.number("check.energy")?, values.number("check.rotation")?);
    Ok(Check { energy, rotation })
}

fn vtk(values: &Values) -> Result<bool, Box<SceneError>> {
    match values.flag("output.vtk")? {
        true if values.dimension() == 1 => {
            Err(values.error("output.vtk", "it means nothing in 1D"))
        }
        vtk => Ok(vtk),
    }
}

fn body(values: &Values) -> Result<Body, Box<SceneError>> {
    if !(1..=3).contains(&values.dimension()) {
        let problem = format!("{} given", counted(values.dimension(), "number"));
        return Err(values.error("body.length", problem));
    }
    let body = Body {
        length: values.axes("body.length")?,
        origin: values.axes("body.origin")?,
        density: values.number("body.density")?,
        law: values.choose("body.law", &LAWS)?,
        youngs_modulus: values.number("body.youngs_modulus")?,
        poisson_ratio: values.number("body.poisson_ratio")?,
        balls: Vec::new(),
    };
    let body = Body { balls: balls(values, &body)?, ..body };
    let c = wave_speed(&body);
    let impedance = body.density * c;
    let normal = |x: f64| x.is_normal() && x.recip().is_normal();
    if !(normal(c) && normal(impedance)) {
        let problem = format!(
            "with body.density: the wave speed {c:e} m/s, the impedance {impedance:e} Pa s/m"
        );
        let allowed = "moduli whose wave speed √((λ + 2μ)/ρ) and impedance are ordinary numbers";
        return Err(values.error("body.youngs_modulus", problem).allowing(allowed));
    }
    Ok(body)
}

fn balls(values: &Values, body: &Body) -> Result<Vec<Ball>, Box<SceneError>> {
    let mut balls = Vec::new();
    for entry in values.entries("body.ball") {
        let key = format!("{entry}.centre");
        if values.dimension() == 1 {
            return Err(values.error(&key, "a bar has no balls: the scene has 1 axis"));
        }
        let inside = |d: usize, x: f64| body.origin[d] < x && x < body.origin[d] + body.length[d];
        let centre = values.axes_if(&key, inside)?;
        let from_corner: Vec<f64> =
            centre.iter().zip(&body.origin).map(|(x, origin)| x - origin).collect();
        let room = (0..values.dimension())
            .map(|d| from_corner[d].min(body.length[d] - from_corner[d]))
            .fold(f64::INFINITY, f64::min);
        // A ball may touch the side, up to the round-off of its centre.
        let fits = |radius| radius <= room * (1.0 + 1e-12);
        let radius = values.number_if(&format!("{entry}.radius"), fits)?;
        balls.push(Ball { centre: from_corner, radius });
    }
    Ok(balls)
}

/// Refuses cells so large or small that the square of the time in which a wave crosses one, of
/// which the limit of Δt is made, is no ordinary number.
fn crossed(values: &Values, body: &Body, grid: &GridSpec) -> Result<(), Box<SceneError>> {
    let c = wave_speed(body);
    for d in 0..values.dimension() {
        let time = body.length[d] / grid.cells[d] as f64 / c;
        if !(1e-150..=1e150).contains(&time) {
            let problem = format!("a wave takes {time:e} s through a cell of grid.cells");
            let allowed = "lengths that a wave takes from 1e-150 s to 1e150 s for";
            return Err(values.error("body.length", problem).allowing(allowed));
        }
    }
    Ok(())
}

/// Refuses a ball that holds no particle.
fn filled(values: &Values, body: &Body, grid: &GridSpec) -> Result<(), Box<SceneError>> {
    for (ball, entry) in body.balls.iter().zip(values.entries("body.ball")) {
        // From the centre to the particle place that is nearest along each axis.
        let offset = |d: usize| {
            let places = grid.cells[d] as f64 * grid.particles_per_cell[d] as f64;
            let distance = body.length[d] / places;
            let place = libm::floor(ball.centre[d] / distance).clamp(0.0, places - 1.0);
            ball.centre[d] - (place + 0.5) * distance
        };
        let square: f64 = (0..values.dimension()).map(|d| offset(d) * offset(d)).sum();
        if square > ball.radius * ball.radius {
            let problem = "no particle lies in this ball";
            let error = values.error(&format!("{entry}.radius"), problem);
            let least = libm::sqrt(square);
            return Err(error.allowing(format!("here a radius of at least {least:e} m")));
        }
    }
    Ok(())
}

fn boundary(values: &Values) -> Result<Vec<[Side; 2]>, Box<SceneError>> {
    let states = [("fixed", true), ("free", false)];
    let free = Side { fixed: vec![false; values.dimension()] };
    let mut boundary = vec![[free.clone(), free]; values.dimension()];
    for side in values.sides("boundary")? {
        let fixed = &mut boundary[side.axis][side.upper].fixed;
        if values.is_word(&side.path) {
            fixed.fill(values.choose(&side.path, &states)?);
        }
        for (path, i) in values.components(&side.path)? {
            fixed[i] = values.choose(&path, &states)?;
        }
    }
    Ok(boundary)
}

fn grid(values: &Values, boundary: &[[Side; 2]]) -> Result<GridSpec, Box<SceneError>> {
    // A body leaves the grid only through a side that lets it move. A side that holds any
    // component is the last of the grid: there the nodes on it are the velocity of the side,
    // while functions that are wider than a cell would blend in those beside it. The
    // particles of GIMP reach beyond their centres.
    let gimp = ["ugimp", "gimp"].contains(&values.word("basis.kind")?);
    let mut beyond: Vec<[usize; 2]> = (0..values.dimension())
        .map(|d| [0, 1].map(|upper| usize::from(gimp || !boundary[d][upper].holds())))
        .collect();
    for side in values.sides("grid.beyond")? {
        beyond[side.axis][side.upper] = values.whole(&side.path)?;
    }
    Ok(GridSpec {
        cells: values.wholes("grid.cells")?,
        particles_per_cell: values.wholes("grid.particles_per_cell")?,
        beyond,
        offset: 0.0,
    })
}
