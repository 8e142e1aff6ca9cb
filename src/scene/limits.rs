//! What a scene may ask for: memory and steps, before any is spent.

use super::fault::SceneError;
use super::parts::Scene;

/// The most memory that a scene may ask for (bytes).
const MEMORY: f64 = 16.0 * 1024.0 * 1024.0 * 1024.0;

/// More steps than any run will finish.
const MOST_STEPS: f64 = 1e12;

/// Refuses a scene whose arrays would not fit, before any is allocated; `error` makes the
/// error of a key from what is wrong.
pub fn affordable(
    scene: &Scene,
    error: &dyn Fn(&str, String) -> Box<SceneError>,
) -> Result<(), Box<SceneError>> {
    let refuse = |key: &str, problem: String, allowed: String| {
        let mut error = error(key, problem);
        error.allowed = allowed;
        Err(error)
    };
    let (particles, nodes, steps) = scene.sizes();
    let d = scene.dimension() as f64;
    let particle_bytes = 8.0 * (2.0 + 3.0 * d + 2.0 * d * d);
    let pair_bytes = 8.0 * (2.0 + d) * scene.pairs_per_particle();
    let node_bytes = 8.0 * (1.0 + 3.0 * d);
    let rows = steps / scene.every as f64;
    // A row of the table of particles, and its share of a file.
    let frames = if scene.vtk { rows * particles * 8.0 * 50.0 } else { 0.0 };
    // A number in the table, as text in CSV, and as a point of a picture.
    let history = rows * 60.0 * (4.0 + d + 2.0 * scene.probes.len() as f64);
    let space = particles * (particle_bytes + pair_bytes) + nodes * node_bytes;
    let limit = MEMORY / 1e9;
    if space > MEMORY {
        let problem = format!("this grid and basis need {:.1} GB of memory", space / 1e9);
        let allowed = format!("a grid and basis that need at most {limit:.1} GB");
        return refuse("grid.cells", problem, allowed);
    }
    if steps > MOST_STEPS {
        let problem = format!("with time.cfl and grid.cells it asks for {steps:e} steps");
        return refuse("time.end", problem, format!("at most {MOST_STEPS:e} steps"));
    }
    if frames > MEMORY {
        let gb = frames / 1e9;
        let problem = format!("{rows:e} frames of {particles:e} particles need {gb:e} GB");
        let allowed = format!("frames of at most {limit:.1} GB; see also output.every");
        return refuse("time.end", problem, allowed);
    }
    if history > MEMORY {
        let gb = history / 1e9;
        let problem = format!("the history of {steps:e} steps needs {gb:e} GB of memory");
        let allowed = format!("a history of at most {limit:.1} GB; see also output.every");
        return refuse("time.end", problem, allowed);
    }
    Ok(())
}
