//! Bounds what a scene may ask for, memory and work, before any is spent.

use super::parts::Scene;

/// A count of steps up to here is exact, and no run will finish more.
const MOST_STEPS: f64 = 1e15;

/// So many multiplications of a factorisation take as long as a step of a particle.
const PER_PARTICLE_STEP: f64 = 300.0;

/// An entry of L takes so much (bytes): its value, and its place in L and in Lᵀ, whose list grows
/// by doubling.
const PER_ENTRY: f64 = 32.0;

/// An implicit step takes so many factorisations.
const PER_STEP: f64 = 4.0;

/// A budget is what a run may take. This one, without a look at the machine, is 16 GiB and 1e11
/// particle-steps, which take some hours with the linear basis and a day with wide functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Memory (bytes).
    pub memory: f64,
    /// Particles times steps; a factorisation, of the consistent mass matrix or of a tangent, counts
    /// as a particle for every 300 of its multiplications.
    pub work: f64,
}

impl Default for Budget {
    fn default() -> Self {
        Budget { memory: 16.0 * 1024.0 * 1024.0 * 1024.0, work: 1e11 }
    }
}

/// An excess is what a scene asks for too much of.
pub struct Excess {
    pub key: &'static str,
    pub problem: String,
    pub allowed: String,
}

/// Refuses a scene that would need more than the `budget`, before any of it is spent.
///
/// Errors: [`Excess`] with the key that asks for too much.
pub fn affordable(scene: &Scene, budget: &Budget) -> Result<(), Excess> {
    let steps = scene.step_count();
    let (arrays, factors) = (arrays(scene), factors(scene));
    if arrays + factors > budget.memory {
        return Err(too_large(scene, budget, arrays, factors));
    }
    let work = work(scene);
    if steps > MOST_STEPS || work > budget.work {
        let problem = format!(
            "with time.cfl and grid.cells it asks for {steps:e} steps, the work of {work:.1e} \
             particle-steps"
        );
        let allowed = match steps > MOST_STEPS {
            true => format!("at most {MOST_STEPS:e} steps"),
            false => format!(
                "at most {:e} particle-steps; with `--max-time SECONDS` a run may start that needs \
                 more",
                budget.work
            ),
        };
        return Err(Excess { key: "time.end", problem, allowed });
    }
    let recorded = recorded(scene);
    if arrays + factors + recorded > budget.memory {
        let (gb, what) = (recorded / 1e9, if scene.vtk { "frames and history" } else { "history" });
        let problem = format!("{what} of {steps:e} steps ask for {gb:.1} GB of memory");
        let left = (budget.memory - arrays - factors) / 1e9;
        let allowed = format!("{what} of at most {left:.1} GB, which is there; see output.every");
        return Err(Excess { key: "time.end", problem, allowed });
    }
    Ok(())
}

/// Says what makes a scene's grid and basis too large: its arrays, or factors (bytes).
fn too_large(scene: &Scene, budget: &Budget, arrays: f64, factors: f64) -> Excess {
    let (gb, limit) = ((arrays + factors) / 1e9, budget.memory / 1e9);
    let problem = format!("this grid and basis need {gb:.1} GB of memory");
    let allowed = format!("a grid and basis that need at most {limit:.1} GB, which is there");
    let (key, of, instead) = match factors > arrays {
        false => return Excess { key: "grid.cells", problem, allowed },
        true if is_implicit(scene) => ("time.integrator", "tangent", "an explicit scheme"),
        true => ("mass", "consistent matrix", "\"lumped\""),
    };
    let problem = format!("{problem} with the factors of the {of}");
    Excess { key, problem, allowed: format!("{instead}, or {allowed}") }
}

/// Tells whether nodal displacements are solved for.
fn is_implicit(scene: &Scene) -> bool {
    scene.method.needs().equilibrium
}

/// Tells how many states a run holds: its own, and that of its watch.
fn states(scene: &Scene) -> f64 {
    let alone = scene.time.watch == 0.0 || scene.time.allow_unstable || is_implicit(scene);
    if alone { 1.0 } else { 2.0 }
}

/// Estimates the memory for particles, nodes and their pairs (bytes).
fn arrays(scene: &Scene) -> f64 {
    let (particles, nodes, _) = scene.sizes();
    let d = scene.dimension() as f64;
    let particle_bytes = 8.0 * (6.0 + 8.0 * d + 2.0 * d * d);
    let node_bytes = 8.0 * (1.0 + 6.0 * d);
    let table = 8.0 * (4.0 + 0.5 * d + scene.numbers_per_row());
    states(scene) * (particles * (particle_bytes + table) + nodes * node_bytes)
}

/// Estimates the memory for the consistent mass matrix, the tangent of an implicit step, which
/// couples all components, and their factors (bytes).
fn factors(scene: &Scene) -> f64 {
    let (systems, entries) = (scene.mass_systems(), scene.mass_entries());
    let own = if systems > 0.0 { 24.0 } else { 0.0 };
    let of_mass = own * entries + systems * (PER_ENTRY * scene.factor_entries() + 8.0 * entries);
    let d = scene.dimension() as f64;
    let of_tangent = d * d * (PER_ENTRY * scene.factor_entries() + 40.0 * entries);
    states(scene) * of_mass + if is_implicit(scene) { of_tangent } else { 0.0 }
}

/// Estimates the memory for frames and history (bytes).
fn recorded(scene: &Scene) -> f64 {
    let (particles, _, steps) = scene.sizes();
    let rows = steps / scene.every as f64;
    // A row of the table of particles, and its share of a file.
    let frames = if scene.vtk { rows * particles * 8.0 * 50.0 } else { 0.0 };
    // A number in the table, as text in CSV, and as a point of a picture.
    let columns = 4.0 + scene.dimension() as f64 + 2.0 * scene.probes.len() as f64;
    frames + rows * 60.0 * columns
}

/// Estimates the work of a run (particle-steps).
fn work(scene: &Scene) -> f64 {
    let (particles, _, steps) = scene.sizes();
    let (nodes, band) = scene.band();
    let d = scene.dimension() as f64;
    let tangents = if is_implicit(scene) { PER_STEP * d * d * d } else { 0.0 };
    let factorisation = (scene.mass_systems() + tangents) * nodes * band * band / PER_PARTICLE_STEP;
    steps * (particles + factorisation)
}
