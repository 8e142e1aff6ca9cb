//! What a scene may ask for: memory and steps, before any is spent.

use super::Scene;
use super::check::Check;
use super::file::{FileGrid, FileTime};
use crate::fault::SceneError;

/// The most memory that a scene may ask for (bytes).
const MEMORY: f64 = 16.0 * 1024.0 * 1024.0 * 1024.0;

/// More steps than any run will finish.
const MOST_STEPS: f64 = 1e12;

/// Refuses a scene whose arrays would not fit, before any is allocated.
pub fn affordable(
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
    // A row of the table of particles, and its share of a file.
    let frames = if scene.vtk { rows * particles * 8.0 * 50.0 } else { 0.0 };
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
    if frames > MEMORY {
        let problem =
            format!("{rows:e} frames of {particles:e} particles need {:e} GB", frames / 1e9);
        let mut error = check.source.error("time.end", time.end.span(), problem);
        error.allowed = format!("frames of at most {limit:.1} GB; see also output.every");
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
