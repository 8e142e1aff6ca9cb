//! The time loop carries a scene to its end: scene → state → step, step, … → history.

pub mod columns;
mod course;
mod guards;
mod open;
mod outcome;
mod particles;
mod recorder;

pub mod stability;
pub mod table;
mod warning;

pub use course::Course;
pub use open::{parse, parse_within};
pub use outcome::{Frame, Outcome, Stopped};

pub use warning::{Warning, Worst};

use crate::method::breakdown::{Breakdown, BrokenDown};
use crate::scene::Scene;
use crate::setup;
use stability::Critical;
use std::ops::ControlFlow;

/// Runs a scene to its end; `progress` hears the number of every finished step.
///
/// A time step beyond the limit is run as well; the limit is known beforehand from
/// [`stability::critical`]. What grows is stopped by the watch, or blows up.
///
/// Errors: [`Stopped`] when the run breaks down.
pub fn run(scene: &Scene, progress: &mut dyn FnMut(usize)) -> Result<Outcome, Box<Stopped>> {
    let mut on = |step| {
        progress(step);
        ControlFlow::Continue(())
    };
    run_knowing(scene, None, &mut on)
}

/// Runs a scene of which the limit of Δt may be known, so that the watch need not predict it
/// again; `progress` hears the number of every finished step, and may break with the reason to
/// end the run there.
///
/// Errors: [`Stopped`] when the run breaks down, or `progress` ends it.
pub fn run_knowing(
    scene: &Scene,
    limit: Option<Critical>,
    progress: &mut dyn FnMut(usize) -> ControlFlow<Breakdown>,
) -> Result<Outcome, Box<Stopped>> {
    match scene.dimension() {
        1 => run_in::<1>(scene, limit, progress),
        2 => run_in::<2>(scene, limit, progress),
        _ => run_in::<3>(scene, limit, progress),
    }
}

fn run_in<const D: usize>(
    scene: &Scene,
    limit: Option<Critical>,
    progress: &mut dyn FnMut(usize) -> ControlFlow<Breakdown>,
) -> Result<Outcome, Box<Stopped>> {
    let model = setup::model::<D>(scene);
    let mut course = Course::new(scene, &model);
    let mut march = || -> Result<(), BrokenDown> {
        course.start(limit)?;
        while let Some(moment) = course.advance()? {
            match progress(moment.step) {
                ControlFlow::Break(why) if !course.is_at_end() => return Err(why.at(moment)),
                _ => {}
            }
        }
        Ok(())
    };
    match march() {
        Ok(()) => Ok(course.outcome()),
        Err(broken) => Err(Box::new(course.stopped(broken))),
    }
}
