//! The trade of speed for accuracy is measured on a grid of configurations, which is made
//! here.

use super::configuration::{Configuration, Template};
use super::map;
use crate::method::exact::mode::Mode;
use crate::run::stability;
use crate::scene::fault::Fault;
use crate::scene::{Motion, Scene};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// The time step of a configuration is given as a number c Δt / h.
#[derive(Clone, Copy)]
enum Step {
    /// Common to all.
    Common(f64),
    /// A part of the configuration's own predicted limit.
    PartOfLimit(f64),
}
use Step::{Common, PartOfLimit};

/// A sweep is what a study varies.
struct Sweep {
    /// Factors of the scene's cells from one up; below one are those of [`coarser`].
    refinements: &'static [f64],
    bases: &'static [&'static str],
    /// Methods with a basis and an integrator of their own, each with the steps common to all.
    others: &'static [&'static str],
    integrators: &'static [&'static str],
    particles_per_cell: &'static [usize],
    /// Every combination; otherwise one thing at a time.
    crossed: bool,
}

const NEWMARK: &str = map::INTEGRATORS[0];
const LINEAR: &str = "basis.kind=linear";
const UGIMP: &str = "basis.kind=ugimp";
const BSPLINE: &str = "basis.kind=bspline";
const CUBIC: &str = "basis.kind=bspline basis.degree=3";
const DDMP: &str = "basis.kind=ddmp";
const GIMP: &str = "basis.kind=gimp";
const LME_0_8: &str = "basis.kind=lme basis.gamma=0.8";
const LME_0_8_SHORT: &str = "basis.kind=lme basis.gamma=0.8 basis.cutoff=0.01";
const LME_1_8: &str = "basis.kind=lme basis.gamma=1.8";
const LME_1_8_UPDATED: &str = "basis.kind=lme basis.gamma=1.8 basis.metric=updated";
const LME_4: &str = "basis.kind=lme basis.gamma=4";
const LME_4_UPDATED: &str = "basis.kind=lme basis.gamma=4 basis.metric=updated";
const LME_6: &str = "basis.kind=lme basis.gamma=6";

const QUICK: Sweep = Sweep {
    refinements: &[1.0, 2.0, 4.0],
    bases: &[LINEAR, UGIMP, GIMP, BSPLINE, CUBIC, DDMP, LME_0_8, LME_0_8_SHORT, LME_1_8, LME_4],
    others: &[],
    integrators: &[
        NEWMARK,
        "time.integrator=forward-euler time.stress_update=last",
        "time.integrator=generalized-alpha time.rho_b=0.8",
    ],
    particles_per_cell: &[2],
    crossed: false,
};

const FULL: Sweep = Sweep {
    refinements: &[1.0, 2.0, 4.0, 8.0],
    bases: &[
        LINEAR,
        UGIMP,
        GIMP,
        BSPLINE,
        CUBIC,
        DDMP,
        "basis.kind=lme basis.gamma=0.4",
        LME_0_8,
        LME_0_8_SHORT,
        LME_1_8,
        "basis.kind=lme basis.gamma=1.8 basis.cutoff=0.01",
        LME_4,
        "basis.kind=lme basis.gamma=4 basis.cutoff=0.01",
        LME_6,
    ],
    others: &[
        "basis.kind=linear forces.reconstruction=tls time.integrator=newmark",
        "basis.kind=bspline forces.reconstruction=tls time.integrator=newmark",
        "basis.kind=bspline forces.reconstruction=mls time.integrator=newmark",
        "basis.kind=ugimp filter=null-space time.integrator=newmark",
        "basis.kind=linear time.integrator=implicit-newmark",
        "basis.kind=gimp time.integrator=implicit-newmark",
        "basis.kind=bspline time.integrator=implicit-newmark",
    ],
    integrators: &map::INTEGRATORS,
    particles_per_cell: &[1, 2, 4],
    crossed: true,
};

/// A scheme computes the scene on a grid that is still to be chosen.
struct Traded {
    method: &'static str,
    /// Mass, basis and integrator.
    parts: String,
    particles_per_cell: usize,
    step: Step,
}

/// Lists all schemes of MPM, each with a common time step and with one that is a fixed part of
/// its own limit.
fn mpm(sweep: &Sweep) -> Vec<Traded> {
    let mut all = Vec::new();
    let mut add = |parts: String, particles_per_cell, step| {
        all.push(Traded { method: "mpm", parts, particles_per_cell, step });
    };
    for basis in sweep.bases {
        for &per_cell in sweep.particles_per_cell {
            for integrator in sweep.integrators {
                let usual = sweep.crossed || *integrator == NEWMARK;
                if usual || [LINEAR, UGIMP].contains(basis) {
                    for step in [Common(0.5), PartOfLimit(0.8)] {
                        add(format!("mass=lumped {basis} {integrator}"), per_cell, step);
                    }
                }
                // With one particle per cell the consistent matrix is nearly singular.
                let own = [LINEAR, BSPLINE, CUBIC, DDMP, LME_0_8, LME_1_8].contains(basis);
                if per_cell > 1 && (sweep.crossed || (usual && own)) {
                    for step in [Common(0.2), PartOfLimit(0.8)] {
                        add(format!("mass=consistent {basis} {integrator}"), per_cell, step);
                    }
                }
            }
        }
    }
    for other in sweep.others {
        for (mass, cfl) in [("lumped", 0.5), ("consistent", 0.2)] {
            for &per_cell in sweep.particles_per_cell.iter().filter(|n| **n > 1) {
                add(format!("mass={mass} {other}"), per_cell, Common(cfl));
            }
        }
    }
    all
}

/// Lists all schemes of OTM, each with a common time step and with one just below its own
/// limit.
fn otm(sweep: &Sweep) -> Vec<Traded> {
    let mut all = Vec::new();
    let updated: &[&str] = if sweep.crossed { &[LME_1_8_UPDATED, LME_4_UPDATED] } else { &[] };
    for basis in [LME_0_8, LME_1_8, LME_4, LME_6].iter().chain(updated) {
        for particles_per_cell in if sweep.crossed { 1..=2 } else { 1..=1 } {
            for step in [Common(0.5), PartOfLimit(0.95)] {
                let parts = format!("mass=lumped {basis} {NEWMARK}");
                all.push(Traded { method: "otm", parts, particles_per_cell, step });
            }
        }
    }
    all
}

/// The longest side of a body has this many cells at least.
const LEAST_CELLS: f64 = 4.0;

/// Tells how many cells along each axis a grid needs to know what moves the body: two to half a
/// wave, two across the ring of a vortex, one to a patch of initial velocity; and enough of
/// them for [`LEAST_CELLS`] along the longest side.
fn needed(scene: &Scene) -> Vec<f64> {
    let length = &scene.body.length;
    let longest = length.iter().copied().fold(0.0, f64::max);
    let waves =
        |mode: usize, d: usize| Mode::new(scene.ends(d), mode, length[d]).k * length[d] / PI;
    let own = |d: usize| match &scene.motion {
        Motion::Vibration { mode, .. } => 2.0 * waves(*mode, d),
        Motion::Manufactured(spec) => 2.0 * waves(spec.mode, d),
        Motion::Vortex(spec) => 2.0 * length[d] / (0.5 * spec.radius),
        Motion::Regions(regions) => {
            let parts = regions.iter().map(|region| length[d] / (region.to[d] - region.from[d]));
            parts.fold(0.0, f64::max)
        }
    };
    // A ratio of decimal lengths may be a hair above a whole number.
    let whole = |cells: f64| libm::ceil(cells * (1.0 - 1e-9)).max(1.0);
    (0..scene.dimension()).map(|d| whole(own(d).max(LEAST_CELLS * length[d] / longest))).collect()
}

/// Lists the factors of the scene's cells that make coarser grids, from the coarsest up: a cell
/// grows by √2 from one to the next, as long as the grid has the cells that [`needed`] asks for.
fn coarser(scene: &Scene) -> Vec<f64> {
    let needed = needed(scene);
    let knows = |refinement: f64| {
        let cells = scene.grid.cells.iter().map(|n| libm::round(*n as f64 * refinement));
        cells.zip(&needed).all(|(cells, needed)| cells >= *needed)
    };
    let mut factors: Vec<f64> = Vec::new();
    let mut halvings: i32 = 0;
    loop {
        let half = 1.0 / f64::from(1_u32 << halvings);
        for factor in [half * FRAC_1_SQRT_2, 0.5 * half] {
            if !knows(factor) || halvings == 30 {
                factors.reverse();
                return factors;
            }
            factors.push(factor);
        }
        halvings += 1;
    }
}

/// Says in words which grids a study leaves out because they are too coarse.
pub fn left_out(scene: &Scene) -> String {
    let cells: Vec<String> = needed(scene).iter().map(f64::to_string).collect();
    let why = match &scene.motion {
        Motion::Vibration { .. } | Motion::Manufactured(_) => "two to half a wave",
        Motion::Vortex(_) => "two across the ring",
        Motion::Regions(regions) if !regions.is_empty() => "one to a patch of initial velocity",
        Motion::Regions(_) => "a few along the body",
    };
    format!("grids of fewer than {} cells are left out ({why}, and at least four)", cells.join("×"))
}

/// Lists the configurations of a study of this template, grid by grid from the coarsest,
/// none twice.
///
/// In 1D each grid has two rows of linear finite elements with central differences: at
/// c Δt/h = 1/2, and just below 1, where they are exact on the bar. (At 1 itself an element
/// that is compressed by a thousandth is beyond its limit.)
pub fn levels(template: &Template, full: bool) -> Result<Vec<Vec<Configuration>>, Fault> {
    let sweep = if full { FULL } else { QUICK };
    let mut schemes = Vec::new();
    if template.scene.dimension() == 1 {
        for cfl in [0.998, 0.5] {
            let parts = format!("mass=lumped {LINEAR} {NEWMARK}");
            schemes.push(Traded { method: "otm", parts, particles_per_cell: 1, step: Common(cfl) });
        }
    }
    schemes.extend(mpm(&sweep));
    schemes.extend(otm(&sweep));
    let mut levels: Vec<Vec<Configuration>> = Vec::new();
    for &refinement in coarser(&template.scene).iter().chain(sweep.refinements) {
        let mut level: Vec<Configuration> = Vec::new();
        for scheme in &schemes {
            if let Some(one) = configuration(template, scheme, refinement)?
                && !levels.iter().flatten().chain(&level).any(|known| *known == one)
            {
                level.push(one);
            }
        }
        levels.push(level);
    }
    Ok(levels)
}

/// Lists the configurations of [`levels`] one after the other.
pub fn grid(template: &Template, full: bool) -> Result<Vec<Configuration>, Fault> {
    Ok(levels(template, full)?.concat())
}

/// Estimates from below the pairs of particle and node of a run: every particle sees the 2^D
/// nodes of its cell in every step. No run is known for a scene that is refused.
pub fn least_pairs(template: &Template, configuration: &Configuration) -> Option<f64> {
    let scene = template.scene(configuration).ok()?;
    let (particles, _, steps) = scene.sizes();
    Some(particles * steps * libm::exp2(scene.dimension() as f64))
}

/// Puts a scheme on a grid; gives `None` where its step is a part of a limit that there is
/// not, and the common step tells what is wrong.
fn configuration(
    template: &Template,
    scheme: &Traded,
    refinement: f64,
) -> Result<Option<Configuration>, Fault> {
    let Traded { method, parts, particles_per_cell, step } = scheme;
    let grid = template.grid(method, refinement, *particles_per_cell);
    let with = |cfl: f64| format!("method={method} {parts} {grid} time.cfl={cfl}").parse();
    let part = match *step {
        Common(cfl) => return Ok(Some(with(cfl)?)),
        PartOfLimit(part) => part,
    };
    let Ok(scene) = template.scene(&with(0.5)?) else {
        return Ok(None);
    };
    match stability::critical(&scene).map(|limit| scene.courant_number_of(limit.used())) {
        Ok(limit) if limit.is_finite() => {
            // Two digits are enough, and the configuration is short.
            let cfl = libm::floor(part * limit * 100.0) / 100.0;
            Ok(Some(with(cfl.max(0.01))?))
        }
        _ => Ok(None),
    }
}
