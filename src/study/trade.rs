//! The trade of speed for accuracy is measured on a grid of configurations, which is made
//! here.

use super::configuration::{Configuration, Template};
use super::map;
use crate::run::stability;
use crate::scene::fault::Fault;

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
    /// Factors of the scene's cells.
    refinements: &'static [f64],
    bases: &'static [&'static str],
    integrators: &'static [&'static str],
    particles_per_cell: &'static [usize],
    /// Every combination; otherwise one thing at a time.
    crossed: bool,
}

const NEWMARK: &str = map::INTEGRATORS[0];
const LINEAR: &str = "basis.kind=linear";
const UGIMP: &str = "basis.kind=ugimp";
const BSPLINE: &str = "basis.kind=bspline";
const LME_0_8: &str = "basis.kind=lme basis.gamma=0.8";
const LME_0_8_SHORT: &str = "basis.kind=lme basis.gamma=0.8 basis.cutoff=0.01";
const LME_1_8: &str = "basis.kind=lme basis.gamma=1.8";
const LME_4: &str = "basis.kind=lme basis.gamma=4";
const LME_6: &str = "basis.kind=lme basis.gamma=6";

const QUICK: Sweep = Sweep {
    refinements: &[1.0, 2.0, 4.0],
    bases: &[LINEAR, UGIMP, BSPLINE, LME_0_8, LME_0_8_SHORT, LME_1_8, LME_4],
    integrators: &[
        NEWMARK,
        "time.integrator=forward-euler time.stress_update=last",
        "time.integrator=generalized-alpha time.rho_b=0.8",
    ],
    particles_per_cell: &[2],
    crossed: false,
};

const FULL: Sweep = Sweep {
    refinements: &[0.25, 0.5, 1.0, 2.0, 4.0, 8.0],
    bases: &[
        LINEAR,
        UGIMP,
        BSPLINE,
        "basis.kind=lme basis.gamma=0.4",
        LME_0_8,
        LME_0_8_SHORT,
        LME_1_8,
        "basis.kind=lme basis.gamma=1.8 basis.cutoff=0.01",
        LME_4,
        "basis.kind=lme basis.gamma=4 basis.cutoff=0.01",
        LME_6,
    ],
    integrators: &map::INTEGRATORS,
    particles_per_cell: &[1, 2, 4],
    crossed: true,
};

/// A scheme computes the scene on a grid that is still to be chosen.
struct Scheme {
    method: &'static str,
    /// Mass, basis and integrator.
    parts: String,
    particles_per_cell: usize,
    step: Step,
}

/// Lists all schemes of MPM, each with a common time step and with one that is a fixed part of
/// its own limit.
fn mpm(sweep: &Sweep) -> Vec<Scheme> {
    let mut all = Vec::new();
    let mut add = |parts: String, particles_per_cell, step| {
        all.push(Scheme { method: "mpm", parts, particles_per_cell, step });
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
                let own = [LINEAR, BSPLINE, LME_0_8, LME_1_8].contains(basis);
                if per_cell > 1 && (sweep.crossed || (usual && own)) {
                    for step in [Common(0.2), PartOfLimit(0.8)] {
                        add(format!("mass=consistent {basis} {integrator}"), per_cell, step);
                    }
                }
            }
        }
    }
    all
}

/// Lists all schemes of OTM, each with a common time step and with one just below its own
/// limit.
fn otm(sweep: &Sweep) -> Vec<Scheme> {
    let mut all = Vec::new();
    for basis in [LME_0_8, LME_1_8, LME_4, LME_6] {
        for particles_per_cell in if sweep.crossed { 1..=2 } else { 1..=1 } {
            for step in [Common(0.5), PartOfLimit(0.95)] {
                let parts = format!("mass=lumped {basis} {NEWMARK}");
                all.push(Scheme { method: "otm", parts, particles_per_cell, step });
            }
        }
    }
    all
}

/// Lists the configurations of a study of this template, none twice.
///
/// In 1D the first row of each grid is the baseline: linear finite elements with
/// central differences, just below cΔt/h = 1, where they are exact on the bar. (At 1
/// itself an element that is compressed by a thousandth is beyond its limit.)
pub fn grid(template: &Template, full: bool) -> Result<Vec<Configuration>, Fault> {
    let sweep = if full { FULL } else { QUICK };
    let mut schemes = Vec::new();
    if template.scene.dimension() == 1 {
        let parts = format!("mass=lumped {LINEAR} {NEWMARK}");
        schemes.push(Scheme { method: "otm", parts, particles_per_cell: 1, step: Common(0.998) });
    }
    schemes.extend(mpm(&sweep));
    schemes.extend(otm(&sweep));
    let mut all: Vec<Configuration> = Vec::new();
    for &refinement in sweep.refinements {
        for scheme in &schemes {
            let one = configuration(template, scheme, refinement)?;
            all.extend(one.filter(|one| !all.contains(one)));
        }
    }
    Ok(all)
}

/// Puts a scheme on a grid; gives `None` where its step is a part of a limit that there is
/// not, and the common step tells what is wrong.
fn configuration(
    template: &Template,
    scheme: &Scheme,
    refinement: f64,
) -> Result<Option<Configuration>, Fault> {
    let Scheme { method, parts, particles_per_cell, step } = scheme;
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
