//! All methods side by side: each on the bar of Dyka and Ingel, where hardly anything moves, and
//! on the motion across cells, where everything does.

use super::configuration::{Configuration, Template};
use super::pool;
use super::rows::size;
use crate::method::cost::Cost;
use crate::output::summary::{self, Scales};
use crate::run::table::{csv, shortest};
use crate::run::{Course, Outcome};
use crate::scene::fault::Fault;
use crate::scene::{SHIPPED, Scene, Shipped};
use crate::setup;
use std::path::Path;

/// The two motions by the names of their scenes.
pub const MOTIONS: [&str; 2] = ["dyka", "manufactured"];

// ANCHOR: methods
/// Every method has a name, a mass matrix, what its scene says of it, and its c Δt/h on the bar
/// and across cells.
const METHODS: [(&str, &str, &str, [f64; 2]); 27] = [
    ("linear", "lumped", "basis.kind=linear", LUMPED),
    ("linear", "consistent", "basis.kind=linear", CONSISTENT),
    ("uGIMP", "lumped", "basis.kind=ugimp", LUMPED),
    ("GIMP", "lumped", "basis.kind=gimp", LUMPED),
    ("B-spline 2", "lumped", "basis.kind=bspline", LUMPED),
    ("B-spline 2", "consistent", "basis.kind=bspline", CONSISTENT),
    ("B-spline 3", "lumped", "basis.kind=bspline basis.degree=3", LUMPED),
    ("B-spline 3", "consistent", "basis.kind=bspline basis.degree=3", CONSISTENT),
    ("LME 0.8", "lumped", "basis.kind=lme basis.gamma=0.8", LUMPED),
    ("LME 0.8", "consistent", "basis.kind=lme basis.gamma=0.8", CONSISTENT),
    ("DDMP", "lumped", "basis.kind=ddmp", LUMPED),
    ("DDMP", "consistent", "basis.kind=ddmp", CONSISTENT),
    ("linear + TLS 1", "lumped", "basis.kind=linear forces.reconstruction=tls", LUMPED),
    ("B-spline 2 + TLS 1", "lumped", "basis.kind=bspline forces.reconstruction=tls", LUMPED),
    ("B-spline 2 + MLS 2", "lumped", "basis.kind=bspline forces.reconstruction=mls", LUMPED),
    (
        "B-spline 2 + MLS 2",
        "consistent",
        "basis.kind=bspline forces.reconstruction=mls",
        CONSISTENT,
    ),
    ("linear + null-space", "lumped", "basis.kind=linear filter=null-space", LUMPED),
    ("uGIMP + null-space", "lumped", "basis.kind=ugimp filter=null-space", LUMPED),
    ("B-spline 2 + null-space", "lumped", "basis.kind=bspline filter=null-space", LUMPED),
    ("implicit linear", "lumped", "basis.kind=linear", IMPLICIT),
    ("implicit linear", "consistent", "basis.kind=linear", IMPLICIT),
    ("implicit uGIMP", "lumped", "basis.kind=ugimp", IMPLICIT),
    ("implicit GIMP", "lumped", "basis.kind=gimp", IMPLICIT),
    ("implicit B-spline 2", "lumped", "basis.kind=bspline", IMPLICIT),
    ("implicit LME 0.8", "lumped", "basis.kind=lme basis.gamma=0.8", IMPLICIT),
    ("OTM 1.8", "lumped", "method=otm basis.kind=lme basis.gamma=1.8", LUMPED),
    (
        "OTM 1.8 updated",
        "lumped",
        "method=otm basis.kind=lme basis.gamma=1.8 basis.metric=updated",
        LUMPED,
    ),
];
// ANCHOR_END: methods

const LUMPED: [f64; 2] = [0.5, 0.2];
const CONSISTENT: [f64; 2] = [0.2, 0.1];
const IMPLICIT: [f64; 2] = [0.5, 1.0];

/// One run of the study: a method in one of the two motions.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairing {
    pub method: &'static str,
    pub mass: &'static str,
    /// One of [`MOTIONS`].
    pub motion: &'static str,
    pub configuration: Configuration,
}

/// A finished run of the bar has the relative errors of the velocity at its end and of the stress
/// at three quarters over time, and of all displacements over particles and time; one across cells
/// those of all three over particles and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worth {
    pub errors: [f64; 3],
    /// The energy at the end over that at the start, less 1; 0 across cells, where loads work.
    pub energy: f64,
    pub cost: Cost,
}

/// A pairing has what came of it, or the reason why nothing did.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    pub pairing: Pairing,
    pub worth: Result<Worth, String>,
}

impl Pairing {
    /// Gives the name of its row.
    pub fn name(&self) -> String {
        format!("{}, {}, {}", self.motion, self.method, self.configuration)
    }
}

/// Lists all pairings: the bar on 80 cells with two particles in each, and ten of 160 cells crossed
/// with two particles per cell and with four.
///
/// Errors: none, as every configuration can be read.
pub fn pairings() -> Result<Vec<Pairing>, Fault> {
    let mut all = Vec::new();
    for (method, mass, sets, cfl) in METHODS {
        let scheme = if method.starts_with("implicit") { "implicit-newmark" } else { "newmark" };
        let own = if sets.starts_with("method=") { "" } else { "method=mpm " };
        for (motion, cells, per_cell, cfl) in
            [(0, 80, 2, cfl[0]), (1, 160, 2, cfl[1]), (1, 160, 4, cfl[1])]
        {
            let line = format!(
                "{own}{sets} mass={mass} time.integrator={scheme} grid.cells={cells} \
                 grid.particles_per_cell={per_cell} time.cfl={cfl}"
            );
            let configuration = line.parse()?;
            all.push(Pairing { method, mass, motion: MOTIONS[motion], configuration });
        }
    }
    Ok(all)
}

/// Reads the shipped scenes of the motions.
fn templates() -> Result<Vec<(&'static str, Template)>, Fault> {
    let shipped = SHIPPED.iter().filter(|scene| MOTIONS.contains(&scene.name));
    let read = |scene: &Shipped| Template::parse(Path::new(scene.name), scene.text);
    shipped.map(|scene| Ok((scene.name, read(scene)?))).collect()
}

/// Gives the digest of the study's scenes.
pub fn digest() -> Result<String, Fault> {
    templates()?.iter().map(|(_, template)| template.digest()).collect()
}

/// Runs some pairings; `progress` hears of every one.
pub fn study(
    pairings: &[Pairing],
    jobs: usize,
    progress: &mut dyn FnMut(),
) -> Result<Vec<Judged>, Fault> {
    let templates = templates()?;
    let work = |pairing: &Pairing| {
        let own = templates.iter().find(|(motion, _)| *motion == pairing.motion);
        let scene = own.map(|(_, template)| template.scene(&pairing.configuration));
        let worth = match scene {
            Some(Ok(scene)) => Worth::of(&scene),
            Some(Err(fault)) => Err(fault.to_string()),
            None => Err("there is no such motion".to_string()),
        };
        Judged { pairing: pairing.clone(), worth }
    };
    Ok(pool::all(pairings, jobs, work, progress))
}

impl Worth {
    /// Runs a scene in 1D and takes its errors.
    ///
    /// Errors: why there are none, in words.
    pub fn of(scene: &Scene) -> Result<Self, String> {
        let (outcome, fields) = followed(scene)?;
        let lines = summary::lines(scene, &outcome, 0.0);
        let value = |name: &str| lines.iter().find(|l| l.quantity == name).map(|l| l.value);
        let bar = [value("velocity_end_rms_relative"), value("stress_three_quarter_rms_relative")];
        let [v, sigma, u] = fields;
        let worth = Worth {
            errors: [bar[0].unwrap_or(v), bar[1].unwrap_or(sigma), u],
            energy: value("energy_drift").unwrap_or(0.0),
            cost: outcome.cost,
        };
        match worth.errors.iter().all(|x| x.is_finite()) && worth.energy.is_finite() {
            true => Ok(worth),
            false => Err("its errors are not finite".to_string()),
        }
    }
}

/// Runs a scene, and takes the root of the mean square over particles and time of the relative
/// errors of v, σ and u.
fn followed(scene: &Scene) -> Result<(Outcome, [f64; 3]), String> {
    let model = setup::model::<1>(scene);
    let exact = setup::exact::<1>(scene).map_err(|fault| fault.to_string())?;
    let X = setup::material_points::<1>(scene);
    let scales = Scales::of(scene);
    let mut course = Course::new(scene, &model);
    course.start(None).map_err(|broken| broken.to_string())?;
    let (mut sums, mut count) = ([0.0; 3], 0.0);
    while let Some(moment) = course.advance().map_err(|broken| broken.to_string())? {
        let particle = &course.state.particle;
        for (p, X_p) in X.iter().enumerate() {
            let right = exact.at(X_p, moment.time);
            let off = [
                (particle.v[p] - right.velocity)[0] / scales.velocity,
                (particle.sigma[p] - right.stress)[0] / scales.stress,
                (particle.u[p] - right.displacement)[0] / scales.displacement,
            ];
            for (sum, off) in sums.iter_mut().zip(off) {
                *sum += off * off;
            }
            count += 1.0;
        }
    }
    Ok((course.outcome(), sums.map(|sum| libm::sqrt(sum / count))))
}

/// Names the columns of the table.
pub fn columns() -> Vec<&'static str> {
    let own = ["method", "mass", "motion", "configuration", "problem"];
    let errors = ["velocity", "stress", "displacement", "energy"];
    let counts = Cost::default().named().map(|(name, _)| name);
    own.into_iter().chain(errors).chain(counts).collect()
}

/// Writes the study as CSV: what was paired, why nothing came of it, errors, and counts.
pub fn table(rows: &[Judged]) -> Result<Vec<u8>, Fault> {
    let line = |Judged { pairing, worth }: &Judged| {
        let name = [pairing.method, pairing.mass, pairing.motion].map(String::from);
        let mut cells = name.to_vec();
        cells.push(pairing.configuration.to_string());
        match worth {
            Ok(Worth { errors, energy, cost }) => {
                let counts = cost.named().map(|(_, count)| count as f64);
                let numbers = errors.iter().chain([energy]).chain(&counts);
                cells.push(String::new());
                cells.extend(numbers.map(|x| shortest(*x)));
            }
            Err(problem) => {
                cells.push(problem.clone());
                cells.resize(columns().len(), String::new());
            }
        }
        cells
    };
    csv(&columns(), rows.iter().map(line))
}

/// Reads a row of the table, with its name.
pub fn read(cells: &[&str]) -> Option<(String, Judged)> {
    let columns = columns();
    let cell = |name: &str| cells.get(columns.iter().position(|column| *column == name)?).copied();
    let configuration: Configuration = cell("configuration")?.parse().ok()?;
    let own = |pairing: &Pairing| {
        Some(pairing.method) == cell("method")
            && Some(pairing.motion) == cell("motion")
            && pairing.configuration == configuration
    };
    let pairing = pairings().ok()?.into_iter().find(own)?;
    let number = |name: &str| size(cell(name)?);
    let worth = match cell("problem")? {
        "" => {
            let mut cost = Cost::default();
            for (name, count) in cost.places() {
                *count = number(name).filter(|x| x.trunc() == *x && *x < 9e15)? as u64;
            }
            let errors = [number("velocity")?, number("stress")?, number("displacement")?];
            let energy = cell("energy")?.parse().ok().filter(|x: &f64| x.is_finite())?;
            Ok(Worth { errors, energy, cost })
        }
        problem => Err(problem.to_string()),
    };
    Some((pairing.name(), Judged { pairing, worth }))
}
