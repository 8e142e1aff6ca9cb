//! The parametric study varies γ from the mesh-free end to the finite-element end.

use super::configuration::{Configuration, Template};
use super::pool;
use super::rows::size;
use crate::output::figure::CurvePoints;
use crate::output::summary;
use crate::run::run;
use crate::run::stability;
use crate::run::table::{csv, shortest};
use crate::scene::DYKA;
use crate::scene::fault::Fault;
use std::path::Path;

/// The study takes these values of γ.
pub const GAMMAS: [f64; 12] = [0.3, 0.5, 0.8, 1.0, 1.4, 1.8, 2.5, 4.0, 6.0, 10.0, 20.0, 50.0];

/// A way is what is varied beside γ: some `KEY=VALUE` and c Δt / h.
pub struct Way {
    pub name: &'static str,
    sets: &'static str,
    cfl: f64,
}

/// The study goes these ways.
pub const WAYS: [Way; 3] = [
    Way { name: "mpm lumped", sets: "method=mpm mass=lumped grid.particles_per_cell=2", cfl: 0.5 },
    Way {
        name: "mpm consistent",
        sets: "method=mpm mass=consistent grid.particles_per_cell=2",
        cfl: 0.2,
    },
    Way { name: "otm", sets: "method=otm mass=lumped grid.particles_per_cell=1", cfl: 0.5 },
];

/// This bar has length, modulus and density 1, and vibrates in a mode of four waves.
const WAVE: &str = "
title = 'wave'
method = 'mpm'
mass = 'lumped'
body = { length = 1, density = 1, youngs_modulus = 1, poisson_ratio = 0 }
grid = { cells = 32, particles_per_cell = 2 }
basis = { kind = 'linear' }
time = { integrator = 'newmark', cfl = 0.02, end = 0.0625 }
boundary = { left = 'fixed', right = 'fixed' }
vibration = { mode = 8, velocity = 1e-7 }
";

/// An effect is what γ does to the bar.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effect {
    /// Relative errors on the bar.
    pub velocity: f64,
    pub stress: f64,
    pub displacement: f64,
    /// Of the stress, over its largest exact value.
    pub overshoot: f64,
    /// Of the stress, relative to the exact one.
    pub total_variation: f64,
    /// Relative error of the frequency of a wave of eight cells.
    pub dispersion: f64,
    pub energy_drift: f64,
    pub pairs_per_particle: f64,
    pub exponentials_per_particle: f64,
    /// The predicted limit of c Δt / h.
    pub critical_courant: f64,
}

impl Effect {
    /// Reads the numbers in the order of [`Effect::named`]; two of them may be negative.
    fn read(cells: &[&str]) -> Option<Self> {
        let named = Effect::default().named();
        let number = |((name, _), cell): (&(&str, f64), &&str)| match *name {
            "overshoot" | "dispersion" => cell.parse().ok(),
            _ => size(cell),
        };
        let numbers: Option<Vec<f64>> = named.iter().zip(cells).map(number).collect();
        let numbers: [f64; 10] = numbers?.try_into().ok()?;
        let [velocity, stress, displacement, overshoot, total_variation, rest @ ..] = numbers;
        let [dispersion, energy_drift, pairs, exponentials, critical_courant] = rest;
        Some(Effect {
            velocity,
            stress,
            displacement,
            overshoot,
            total_variation,
            dispersion,
            energy_drift,
            pairs_per_particle: pairs,
            exponentials_per_particle: exponentials,
            critical_courant,
        })
    }

    /// Lists every number with its name, in the order of the columns.
    pub fn named(&self) -> [(&'static str, f64); 10] {
        [
            ("velocity", self.velocity),
            ("stress", self.stress),
            ("displacement", self.displacement),
            ("overshoot", self.overshoot),
            ("total_variation", self.total_variation),
            ("dispersion", self.dispersion),
            ("energy_drift", self.energy_drift),
            ("pairs_per_particle", self.pairs_per_particle),
            ("exponentials_per_particle", self.exponentials_per_particle),
            ("critical_courant", self.critical_courant),
        ]
    }
}

/// One γ in one way has its effect, or a reason why that is not known.
#[derive(Clone, Debug, PartialEq)]
pub struct AtGamma {
    pub way: &'static str,
    pub gamma: f64,
    pub effect: Result<Effect, String>,
}

impl AtGamma {
    /// Gives the name of its row: the way and γ.
    pub fn name(way: &str, gamma: f64) -> String {
        format!("{way} {}", shortest(gamma))
    }

    /// Reads a row of the table, with its name.
    pub fn read(cells: &[&str]) -> Option<(String, Self)> {
        let [way, gamma, numbers @ .., problem] = cells else { return None };
        let way = WAYS.iter().find(|one| one.name == *way)?.name;
        let gamma = gamma.parse().ok()?;
        let effect = match *problem {
            "" => Ok(Effect::read(numbers)?),
            problem => Err(problem.to_string()),
        };
        Some((AtGamma::name(way, gamma), AtGamma { way, gamma, effect }))
    }
}

/// A γ in a way is a row of the study.
pub type Item = (&'static Way, f64);

/// Lists all rows of the study.
pub fn items() -> Vec<Item> {
    WAYS.iter().flat_map(|way| GAMMAS.map(|gamma| (way, gamma))).collect()
}

/// Gives the digest of the study's scene.
pub fn digest() -> Result<String, Fault> {
    Template::parse(Path::new("dyka.toml"), DYKA)?.digest()
}

/// Runs the bar of Dyka and Ingel at some γ in some ways; `progress` hears of every one.
pub fn study(
    items: &[Item],
    jobs: usize,
    progress: &mut dyn FnMut(),
) -> Result<Vec<AtGamma>, Fault> {
    let bar = Template::parse(Path::new("dyka.toml"), DYKA)?;
    let wave = Template::parse(Path::new("wave.toml"), WAVE)?;
    let work = |(way, gamma): &Item| {
        let effect = effect(&bar, &wave, way, *gamma);
        AtGamma { way: way.name, gamma: *gamma, effect }
    };
    Ok(pool::all(items, jobs, work, progress))
}

/// Makes the configuration of one γ in one way.
fn configuration(way: &Way, gamma: f64, cells: usize, cfl: f64) -> Result<Configuration, Fault> {
    let parts = format!("basis.kind=lme basis.gamma={gamma} time.integrator=newmark");
    format!("{} {parts} grid.cells={cells} time.cfl={cfl}", way.sets).parse()
}

fn effect(bar: &Template, wave: &Template, way: &Way, gamma: f64) -> Result<Effect, String> {
    let words = |fault: Fault| fault.to_string();
    let one = configuration(way, gamma, 40, way.cfl).map_err(words)?;
    let scene = bar.scene(&one).map_err(words)?;
    let outcome = run(&scene, &mut |_| {}).map_err(|stopped| stopped.broken.to_string())?;
    let lines = summary::lines(&scene, &outcome, 0.0);
    let line = |name: &str| lines.iter().find(|l| l.quantity == name).map_or(f64::NAN, |l| l.value);
    let column = |name: &str| outcome.history.column(name).unwrap_or_default();
    let variation =
        |list: &[f64]| list.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum::<f64>();
    let probe = "stress_three_quarter";
    let (stress, exact) = (column(probe), column(&format!("{probe}_exact")));
    let cost = outcome.cost;
    let per_particle = |count: u64| count as f64 / cost.basis_evaluations as f64;
    let limit = stability::predicted(&scene, 0.0).map_err(|breakdown| breakdown.to_string())?;
    Ok(Effect {
        velocity: line("velocity_end_rms_relative"),
        stress: line(&format!("{probe}_rms_relative")),
        displacement: line("displacement_field_rms_relative"),
        overshoot: line(&format!("{probe}_peak")) / line(&format!("{probe}_peak_exact")) - 1.0,
        total_variation: variation(&stress) / variation(&exact),
        dispersion: dispersion(wave, way, gamma)?,
        energy_drift: line("energy_drift_largest"),
        pairs_per_particle: per_particle(cost.particle_node_pairs),
        exponentials_per_particle: per_particle(cost.exponentials),
        critical_courant: scene.courant_number_of(limit),
    })
}

/// Measures the relative error of the frequency of a wave that is eight cells long, with
/// small time steps: the phase of its mode after a quarter of its period, over π/2, less 1. (After
/// a whole period a slow wave could be taken for a fast one.)
fn dispersion(wave: &Template, way: &Way, gamma: f64) -> Result<f64, String> {
    let words = |fault: Fault| fault.to_string();
    let one = configuration(way, gamma, 32, 0.02).map_err(words)?;
    let scene = wave.scene(&one).map_err(words)?;
    let outcome = run(&scene, &mut |_| {}).map_err(|stopped| stopped.broken.to_string())?;
    let column = |name: &str| outcome.particles.column(name).unwrap_or_default();
    let k = 8.0 * std::f64::consts::PI;
    let (x, u, v) = (column("position"), column("displacement"), column("velocity"));
    let onto = |list: &[f64]| -> f64 {
        list.iter().zip(x.iter().zip(&u)).map(|(y, (x, u))| y * libm::sin(k * (x - u))).sum()
    };
    Ok(libm::atan2(onto(&u) * k, onto(&v)) / std::f64::consts::FRAC_PI_2 - 1.0)
}

/// Gives the curve of each way for the size of the number called `name`, without zeros.
pub fn curves(rows: &[AtGamma], name: &str) -> Vec<(String, CurvePoints)> {
    let point = |row: &AtGamma| {
        let named = row.effect.as_ref().ok()?.named();
        let (_, x) = named.into_iter().find(|(column, _)| *column == name)?;
        (x != 0.0).then_some((row.gamma, x.abs()))
    };
    let curve = |way: &Way| {
        let own = rows.iter().filter(|row| row.way == way.name);
        (way.name.to_string(), own.filter_map(point).collect())
    };
    WAYS.iter().map(curve).collect()
}

/// Writes the study as CSV.
pub fn table(rows: &[AtGamma]) -> Result<Vec<u8>, Fault> {
    let names = Effect::default().named().map(|(name, _)| name);
    let line = |row: &AtGamma| {
        let (effect, problem) = match &row.effect {
            Ok(effect) => (effect.named().map(|(_, x)| shortest(x)), String::new()),
            Err(problem) => (names.map(|_| String::new()), problem.clone()),
        };
        let mut cells = vec![row.way.to_string(), shortest(row.gamma)];
        cells.extend(effect);
        cells.push(problem);
        cells
    };
    csv(&columns(), rows.iter().map(line))
}

/// Names the columns of the table.
pub fn columns() -> Vec<&'static str> {
    let names = Effect::default().named().map(|(name, _)| name);
    ["way", "gamma"].into_iter().chain(names).chain(["problem"]).collect()
}
