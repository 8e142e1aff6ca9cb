//! Reads basis and integrator of a scene, and refuses what OTM cannot do.

use super::fault::SceneError;
use super::parts::{GridSpec, Time};
use super::values::Values;
use crate::method::basis::{Basis, Degree, Support};
use crate::method::choice::{Filter, Integrator};
use crate::method::reading::{Kinematics, NodalMass, StepEight, StressUpdate};

/// Reads the `time` table but for the integrator.
pub fn time(values: &Values) -> Result<Time, Box<SceneError>> {
    let given = |key: &str| match values.has(key) {
        true => values.number(key).map(Some),
        false => Ok(None),
    };
    let (cfl, fraction) = (given("time.cfl")?, given("time.fraction_of_critical")?);
    let load_steps = match values.has("time.load_steps") {
        true => Some(values.whole("time.load_steps")?),
        false => None,
    };
    if (cfl, fraction, load_steps) == (None, None, None) {
        let problem = "the time step is not bounded: `time.cfl` is missing, and so is \
                       `time.fraction_of_critical`";
        return Err(values.error_at("time.cfl", "time.end", problem));
    }
    Ok(Time {
        cfl: cfl.unwrap_or(f64::INFINITY),
        fraction_of_critical: fraction,
        load_steps,
        allow_unstable: values.flag("time.allow_unstable")?,
        watch: values.number("time.watch")?,
        end: values.number("time.end")?,
    })
}

/// Reads the scheme with what it needs.
pub fn integrator(values: &Values) -> Result<Integrator, Box<SceneError>> {
    match values.word("time.integrator")? {
        "newmark" => {
            let readings =
                [("second-order", StepEight::SecondOrder), ("as-printed", StepEight::AsPrinted)];
            values.choose("time.reading", &readings).map(Integrator::Newmark)
        }
        "forward-euler" => {
            let orders = [
                ("first", StressUpdate::First),
                ("last", StressUpdate::Last),
                ("modified-last", StressUpdate::ModifiedLast),
            ];
            values.choose("time.stress_update", &orders).map(Integrator::ForwardEuler)
        }
        "corrected-euler" => Ok(Integrator::CorrectedEuler),
        "generalized-alpha" => {
            Ok(Integrator::GeneralizedAlpha { rho_b: values.number("time.rho_b")? })
        }
        "implicit-newmark" => Ok(Integrator::ImplicitNewmark),
        "quasi-static" => Ok(Integrator::QuasiStatic),
        other => Err(values.error("time.integrator", format!("\"{other}\" is not known here"))),
    }
}

/// Says whether the scheme solves for the nodal displacements.
pub fn is_implicit(values: &Values) -> Result<bool, Box<SceneError>> {
    Ok(integrator(values)?.needs().equilibrium)
}

/// Reads which map the strain is taken from; that of an implicit scheme is always the one that
/// moves the particles.
pub fn kinematics(values: &Values) -> Result<Kinematics, Box<SceneError>> {
    if is_implicit(values)? {
        return Ok(Kinematics::Consistent);
    }
    let readings = [("as-printed", Kinematics::AsPrinted), ("consistent", Kinematics::Consistent)];
    values.choose("time.kinematics", &readings)
}

/// Reads what is taken out of the stresses, and refuses a filter where no stress would stay as it
/// leaves it, or no cell has particles of its own.
pub fn filter(values: &Values) -> Result<Option<Filter>, Box<SceneError>> {
    let filters = [("none", None), ("null-space", Some(Filter::NullSpace))];
    let filter = values.choose("filter", &filters)?;
    let problem = if filter.is_none() {
        return Ok(None);
    } else if values.word("method")? == "otm" {
        "with the method \"otm\" there is no cell that holds particles for a while"
    } else if values.word("body.law")? != "rate" {
        "the law takes the stress from the deformation gradient anew in each step"
    } else if is_implicit(values)? {
        "an implicit integrator balances the stresses before the filter"
    } else {
        return Ok(filter);
    };
    Err(values.error("filter", problem).allowing("\"none\", or no such key"))
}

/// Reads whether the nodes of OTM keep their masses.
pub fn nodal_mass(values: &Values) -> Result<NodalMass, Box<SceneError>> {
    let readings = [
        ("kept", NodalMass::Kept),
        ("renewed-keeping-velocity", NodalMass::RenewedKeepingVelocity),
        ("renewed-keeping-momentum", NodalMass::RenewedKeepingMomentum),
    ];
    values.choose("nodal_mass", &readings)
}

/// Reads the basis with what it needs.
pub fn basis(values: &Values, grid: &GridSpec) -> Result<Basis, Box<SceneError>> {
    let half = |d: usize| grid.particles_per_cell.get(d).map_or(0.5, |n| 0.5 / *n as f64);
    match values.word("basis.kind")? {
        "linear" => Ok(Basis::Linear),
        "ugimp" => Ok(Basis::Ugimp { half_length: [half(0), half(1), half(2)] }),
        "gimp" => Ok(Basis::Gimp { half_length: [half(0), half(1), half(2)] }),
        "ddmp" => Ok(Basis::Ddmp),
        "bspline" => Ok(Basis::BSpline(match values.whole("basis.degree")? {
            2 => Degree::Quadratic,
            _ => Degree::Cubic,
        })),
        "lme" => Ok(Basis::Lme {
            gamma: values.number("basis.gamma")?,
            cutoff: values.number("basis.cutoff")?,
            support: support(values)?,
        }),
        other => Err(values.error("basis.kind", format!("\"{other}\" is not known here"))),
    }
}

/// Reads which nodes local max-ent sees. Those of OTM stand on no grid, and its points measure
/// distances as they are now or, with the updated metric, as they were.
fn support(values: &Values) -> Result<Support, Box<SceneError>> {
    let metric = values
        .choose("basis.metric", &[("fixed", Support::Ball), ("updated", Support::Ellipsoid)])?;
    if values.word("method")? == "otm" {
        return Ok(metric);
    }
    if metric == Support::Ellipsoid {
        let problem = "with the method \"mpm\" the nodes stay behind when the material deforms, \
                       so a metric that goes with it measures nothing";
        return Err(values.error("basis.metric", problem).allowing("\"fixed\""));
    }
    values.choose("basis.support", &[("box", Support::Box), ("ball", Support::Ball)])
}

/// Refuses what OTM cannot do.
pub fn otm(values: &Values) -> Result<(), Box<SceneError>> {
    let refuse = |key: &str, problem: &str, allowed: &str| {
        let problem = format!("with the method \"otm\" {problem}");
        Err(values.error(key, problem).allowing(allowed))
    };
    let kind = values.word("basis.kind")?;
    if !(kind == "lme" || (kind == "linear" && values.dimension() == 1)) {
        let problem = "the basis lives on moving nodes";
        return refuse("basis.kind", problem, "\"lme\", in 1D also \"linear\"");
    }
    if values.has("basis.support") {
        return refuse("basis.support", "there is no grid to lay a box on", "no such key");
    }
    if values.word("time.integrator")? != "newmark" {
        return refuse("time.integrator", "time goes by central differences", "\"newmark\"");
    }
    if values.has("time.reading") {
        return refuse("time.reading", "there is no step 8 to read", "no such key");
    }
    if values.has("time.kinematics") {
        return refuse("time.kinematics", "the strain is always that of the map", "no such key");
    }
    if values.word("mass")? != "lumped" {
        return refuse("mass", "the nodal mass is lumped", "\"lumped\"");
    }
    if values.wholes("grid.particles_per_cell")?.iter().any(|n| *n > 4) {
        let problem = "particles are Gauss's points";
        return refuse("grid.particles_per_cell", problem, "1, 2, 3 or 4");
    }
    if let Some(side) = values.sides("grid.beyond")?.first() {
        let problem = "the nodes are the body's own, and none stands beyond it";
        return refuse(&side.path, problem, "no such key");
    }
    Ok(())
}
