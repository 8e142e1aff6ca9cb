//! The evidence for a choice: the bar of Dyka and Ingel on 40 to 640 cells, by method, basis, mass
//! matrix, γ, particles per cell and time step, each alone.

use super::configuration::{Configuration, Template};
use super::log::{result_cells, result_columns};
use super::measured::Measured;
use super::pool;
use super::rows::size;
use crate::run::table::csv;
use crate::scene::DYKA;
use crate::scene::fault::Fault;
use std::path::Path;

/// A part of the bar is thrown at these speeds (m/s): its own, and one so small that nothing moves.
pub const SPEEDS: [&str; 2] = ["5", "0.001"];

/// Errors are followed over these numbers of cells.
pub const CELLS: [usize; 5] = [40, 80, 160, 320, 640];

/// γ is varied so finely that a narrow optimum shows.
pub const GAMMAS: [f64; 13] = [0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 1.0, 1.2, 1.4, 1.8, 2.5, 4.0];

/// A node beyond the free end is there unless this takes it away.
pub const NO_NODE: &str = "grid.beyond={right=0}";

/// A way is a line of `KEY=VALUE` without cells, particles and time step.
const FINITE_ELEMENTS: &str = "method=otm mass=lumped basis.kind=linear time.integrator=newmark";
const OTM: &str = "method=otm mass=lumped basis.kind=lme basis.gamma=4 time.integrator=newmark";
const IMPLICIT: &str =
    "method=mpm mass=consistent basis.kind=linear time.integrator=implicit-newmark";

fn mpm(mass: &str, basis: &str) -> String {
    format!("method=mpm mass={mass} basis.kind={basis} time.integrator=newmark")
}

fn without_node(way: &str) -> String {
    format!("{way} {NO_NODE}")
}

/// One run of the study: how fast a part of the bar is thrown, and how that is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    pub speed: &'static str,
    pub configuration: Configuration,
}

/// A choice has what came of it, or a reason why nothing did.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    pub choice: Choice,
    pub measured: Result<Measured, String>,
}

impl Choice {
    /// Gives the name of its row.
    pub fn name(&self) -> String {
        format!("speed={} {}", self.speed, self.configuration)
    }
}

/// Gathers choices, none twice.
#[derive(Default)]
struct Choices(Vec<Choice>);

impl Choices {
    fn add(
        &mut self,
        speed: &'static str,
        way: &str,
        [cells, per_cell]: [usize; 2],
        cfl: f64,
    ) -> Result<(), Fault> {
        let grid = format!("grid.cells={cells} grid.particles_per_cell={per_cell}");
        let configuration = format!("{way} {grid} time.cfl={cfl}").parse()?;
        let choice = Choice { speed, configuration };
        if !self.0.contains(&choice) {
            self.0.push(choice);
        }
        Ok(())
    }

    /// Adds the ways whose errors are followed to 640 cells: methods and bases, with a common
    /// time step for each mass matrix; with a small one; with no node beyond the free end; and the
    /// bar that hardly moves.
    fn finer_and_finer(&mut self) -> Result<(), Fault> {
        let [linear, spline, wide] =
            ["linear", "bspline", "lme basis.gamma=0.8"].map(|basis| mpm("consistent", basis));
        for n in CELLS {
            for cfl in [0.5, 0.998] {
                self.add("5", FINITE_ELEMENTS, [n, 1], cfl)?;
            }
            self.add("5", OTM, [n, 1], 0.95)?;
            let narrow = "lme basis.gamma=4";
            for basis in ["linear", "ugimp", "bspline", "lme basis.gamma=0.8", narrow] {
                self.add("5", &mpm("lumped", basis), [n, 2], 0.5)?;
            }
            let cubic = "bspline basis.degree=3";
            for basis in ["linear", "bspline", cubic, "lme basis.gamma=0.8", "lme basis.gamma=1.8"]
            {
                self.add("5", &mpm("consistent", basis), [n, 2], 0.2)?;
            }
            self.add("5", &mpm("lumped", "ddmp"), [n, 2], 0.5)?;
            let fitted = "bspline forces.reconstruction=mls";
            for basis in ["ddmp", fitted] {
                self.add("5", &mpm("consistent", basis), [n, 2], 0.2)?;
            }
            self.add("5", IMPLICIT, [n, 2], 0.5)?;
            for way in [&spline, &wide] {
                self.add("5", way, [n, 2], 0.05)?;
                for cfl in [0.2, 0.05] {
                    self.add("5", &without_node(way), [n, 2], cfl)?;
                }
            }
            self.add("0.001", FINITE_ELEMENTS, [n, 1], 0.5)?;
            self.add("0.001", &mpm("lumped", "linear"), [n, 2], 0.5)?;
            for way in [&linear, &spline, &wide, &without_node(&wide)] {
                self.add("0.001", way, [n, 2], 0.2)?;
            }
            self.add("0.001", &without_node(&wide), [n, 2], 0.05)?;
        }
        Ok(())
    }

    /// Adds γ from 0.5 to 4: with two to four particles per cell on 40 cells and two on 160, with
    /// the node beyond the free end and without it.
    fn gamma_by_gamma(&mut self) -> Result<(), Fault> {
        for gamma in GAMMAS {
            let basis = format!("lme basis.gamma={gamma}");
            let way = mpm("consistent", &basis);
            for grid in [[40, 2], [40, 3], [40, 4], [160, 2]] {
                self.add("5", &way, grid, 0.2)?;
                self.add("5", &without_node(&way), grid, 0.2)?;
            }
            self.add("5", &mpm("lumped", &basis), [40, 2], 0.5)?;
        }
        Ok(())
    }

    /// Adds one to four particles per cell, and Courant numbers from near the limit down.
    fn particles_and_steps(&mut self) -> Result<(), Fault> {
        for per_cell in 1..=4 {
            self.add("5", &mpm("lumped", "linear"), [40, per_cell], 0.5)?;
            self.add("5", FINITE_ELEMENTS, [40, per_cell], 0.5)?;
        }
        for basis in ["linear", "bspline"] {
            for per_cell in 2..=4 {
                self.add("5", &mpm("consistent", basis), [40, per_cell], 0.2)?;
            }
        }
        for n in [40, 160] {
            for cfl in [0.998, 0.9, 0.7, 0.5, 0.25, 0.1] {
                self.add("5", FINITE_ELEMENTS, [n, 1], cfl)?;
            }
            for cfl in [1.38, 1.0, 0.7, 0.5, 0.25, 0.1] {
                self.add("5", &mpm("lumped", "linear"), [n, 2], cfl)?;
            }
            for cfl in [0.4, 0.3, 0.2, 0.1, 0.05, 0.025] {
                for basis in ["linear", "bspline", "lme basis.gamma=0.8"] {
                    let way = mpm("consistent", basis);
                    self.add("5", &way, [n, 2], cfl)?;
                    self.add("5", &without_node(&way), [n, 2], cfl)?;
                }
            }
        }
        Ok(())
    }
}

/// Lists all choices of the study.
pub fn choices() -> Result<Vec<Choice>, Fault> {
    let mut all = Choices::default();
    all.finer_and_finer()?;
    all.gamma_by_gamma()?;
    all.particles_and_steps()?;
    Ok(all.0)
}

/// Gives the bar, a part of which is thrown at `speed` (m/s).
fn bar(speed: &str) -> Result<Template, Fault> {
    let text = DYKA.replace("velocity = 5", &format!("velocity = {speed}"));
    Template::parse(Path::new("dyka.toml"), &text)
}

/// Gives the digest of the study's scene.
pub fn digest() -> Result<String, Fault> {
    bar(SPEEDS[0])?.digest()
}

/// Runs some choices; `progress` hears of every one.
pub fn study(
    choices: &[Choice],
    jobs: usize,
    progress: &mut dyn FnMut(),
) -> Result<Vec<Chosen>, Fault> {
    let bars = [bar(SPEEDS[0])?, bar(SPEEDS[1])?];
    let work = |choice: &Choice| {
        let bar = &bars[usize::from(choice.speed == SPEEDS[1])];
        let scene = bar.scene(&choice.configuration).map_err(|fault| fault.to_string());
        Chosen { choice: choice.clone(), measured: scene.and_then(|scene| Measured::of(&scene)) }
    };
    Ok(pool::all(choices, jobs, work, progress))
}

/// Names the columns of the table.
pub fn columns() -> Vec<&'static str> {
    ["speed", "configuration"].into_iter().chain(result_columns()).collect()
}

/// Writes the study as CSV: what was chosen, why nothing came of it, errors, and counts.
pub fn table(rows: &[Chosen]) -> Result<Vec<u8>, Fault> {
    let line = |Chosen { choice, measured }: &Chosen| {
        let mut cells = vec![choice.speed.to_string(), choice.configuration.to_string()];
        cells.extend(result_cells(measured));
        cells
    };
    csv(&columns(), rows.iter().map(line))
}

/// Reads a row of the table, with its name.
pub fn read(cells: &[&str]) -> Option<(String, Chosen)> {
    let columns = columns();
    let cell = |name: &str| cells.get(columns.iter().position(|column| *column == name)?).copied();
    let speed = SPEEDS.into_iter().find(|speed| Some(*speed) == cell("speed"))?;
    let choice = Choice { speed, configuration: cell("configuration")?.parse().ok()? };
    let measured = match cell("problem")? {
        "" => Ok(Measured::read(|name| size(cell(name)?))?),
        problem => Err(problem.to_string()),
    };
    Some((choice.name(), Chosen { choice, measured }))
}
