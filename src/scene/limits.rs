//! Bounds what a scene may ask for, memory and steps, before any is spent.

use super::parts::Scene;

/// A scene may ask for no more memory (bytes).
const MEMORY: f64 = 16.0 * 1024.0 * 1024.0 * 1024.0;

/// No run will finish more steps.
const MOST_STEPS: f64 = 1e12;

/// An excess is what a scene asks for too much of.
pub struct Excess {
    pub key: &'static str,
    pub problem: String,
    pub allowed: String,
}

/// Refuses a scene whose arrays would not fit, before any is allocated.
///
/// Errors: [`Excess`] with the key that asks for too much.
pub fn affordable(scene: &Scene) -> Result<(), Excess> {
    let (particles, _, steps) = scene.sizes();
    let rows = steps / scene.every as f64;
    let (limit, space) = (MEMORY / 1e9, arrays(scene));
    if space > MEMORY {
        let problem = format!("this grid and basis need {:.1} GB of memory", space / 1e9);
        let allowed = format!("a grid and basis that need at most {limit:.1} GB");
        return Err(Excess { key: "grid.cells", problem, allowed });
    }
    let too_long = |problem, allowed| Err(Excess { key: "time.end", problem, allowed });
    if steps > MOST_STEPS {
        let problem = format!("with time.cfl and grid.cells it asks for {steps:e} steps");
        return too_long(problem, format!("at most {MOST_STEPS:e} steps"));
    }
    // A row of the table of particles, and its share of a file.
    let frames = if scene.vtk { rows * particles * 8.0 * 50.0 } else { 0.0 };
    if frames > MEMORY {
        let gb = frames / 1e9;
        let problem = format!("{rows:e} frames of {particles:e} particles need {gb:e} GB");
        return too_long(
            problem,
            format!("frames of at most {limit:.1} GB; see also output.every"),
        );
    }
    // A number in the table, as text in CSV, and as a point of a picture.
    let columns = 4.0 + scene.dimension() as f64 + 2.0 * scene.probes.len() as f64;
    let history = rows * 60.0 * columns;
    if history > MEMORY {
        let gb = history / 1e9;
        let problem = format!("the history of {steps:e} steps needs {gb:e} GB of memory");
        let allowed = format!("a history of at most {limit:.1} GB; see also output.every");
        return too_long(problem, allowed);
    }
    Ok(())
}

/// Estimates the memory for particles, nodes and their pairs (bytes).
fn arrays(scene: &Scene) -> f64 {
    let (particles, nodes, _) = scene.sizes();
    let d = scene.dimension() as f64;
    let particle_bytes = 8.0 * (2.0 + 3.0 * d + 2.0 * d * d);
    let pair_bytes = 8.0 * (2.0 + d) * scene.pairs_per_particle();
    let node_bytes = 8.0 * (1.0 + 3.0 * d);
    particles * (particle_bytes + pair_bytes) + nodes * node_bytes
}
