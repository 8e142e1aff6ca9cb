//! Basis and integrator of a scene: which keys each needs, and which it refuses.

use super::check::Check;
use super::file::{File, FileBasis, FileTime};
use super::parts::{GridSpec, Time};
use crate::method::basis::Basis;
use crate::method::choice::Integrator;
use crate::method::reading::{StepEight, StressUpdate};
use crate::scene::fault::SceneError;
use toml::Spanned;

/// The `time` table.
pub fn time(check: &Check, file: &FileTime) -> Result<Time, Box<SceneError>> {
    let positive = |key: &str, value: &Option<Spanned<f64>>| match value {
        Some(value) => check.number(key, value, |x| x > 0.0).map(Some),
        None => Ok(None),
    };
    let fraction = positive("time.fraction_of_critical", &file.fraction_of_critical)?;
    let cfl = positive("time.cfl", &file.cfl)?;
    if (cfl, fraction) == (None, None) {
        let problem = "the time step is not bounded: `time.cfl` is missing, and so is \
                       `time.fraction_of_critical`";
        return Err(check.source.error("time.cfl", file.end.span(), problem));
    }
    Ok(Time {
        cfl: cfl.unwrap_or(f64::INFINITY),
        fraction_of_critical: fraction,
        allow_unstable: file.allow_unstable.as_ref().is_some_and(|value| *value.get_ref()),
        end: check.number("time.end", &file.end, |x| x > 0.0)?,
    })
}

/// The scheme with what it needs; keys that mean nothing to it are refused.
pub fn integrator(check: &Check, file: &FileTime) -> Result<Integrator, Box<SceneError>> {
    let (name, span) = (file.integrator.get_ref().as_str(), file.integrator.span());
    let kinds = [
        ("newmark", "time.reading"),
        ("forward-euler", "time.stress_update"),
        ("corrected-euler", ""),
        ("generalized-alpha", "time.rho_b"),
    ];
    let own = check.choose("time.integrator", name, span.clone(), &kinds)?;
    let given = [
        ("time.reading", file.reading.as_ref().map(Spanned::span)),
        ("time.stress_update", file.stress_update.as_ref().map(Spanned::span)),
        ("time.rho_b", file.rho_b.as_ref().map(Spanned::span)),
    ];
    for (key, span) in given {
        if let Some(span) = span.filter(|_| key != own) {
            let problem = format!("it means nothing to the integrator \"{name}\"");
            return Err(check.source.error(key, span, problem));
        }
    }
    let needs = || {
        check.source.error(own, span.clone(), format!("the integrator \"{name}\" needs this key"))
    };
    match own {
        "time.reading" => {
            let readings =
                [("second-order", StepEight::SecondOrder), ("as-printed", StepEight::AsPrinted)];
            let Some(text) = &file.reading else {
                return Ok(Integrator::Newmark(StepEight::default()));
            };
            check.choose(own, text.get_ref(), text.span(), &readings).map(Integrator::Newmark)
        }
        "time.stress_update" => {
            let orders = [
                ("first", StressUpdate::First),
                ("last", StressUpdate::Last),
                ("modified-last", StressUpdate::ModifiedLast),
            ];
            let text = file.stress_update.as_ref().ok_or_else(needs)?;
            check.choose(own, text.get_ref(), text.span(), &orders).map(Integrator::ForwardEuler)
        }
        "time.rho_b" => {
            let rho_b = file.rho_b.as_ref().ok_or_else(needs)?;
            let rho_b = check.number(own, rho_b, |rho_b| (0.0..=1.0).contains(&rho_b))?;
            Ok(Integrator::GeneralizedAlpha { rho_b })
        }
        _ => Ok(Integrator::CorrectedEuler),
    }
}

/// What a scene's basis needs; keys that mean nothing to it are refused.
pub fn basis(check: &Check, file: &FileBasis, grid: &GridSpec) -> Result<Basis, Box<SceneError>> {
    let half = |d: usize| grid.particles_per_cell.get(d).map_or(0.5, |n| 0.5 / *n as f64);
    let lme = Basis::Lme { gamma: f64::NAN, cutoff: 1e-6 };
    let kinds = [
        ("linear", Basis::Linear),
        ("ugimp", Basis::Ugimp { half_length: [half(0), half(1), half(2)] }),
        ("lme", lme),
        ("bspline", Basis::BSpline),
    ];
    let kind = check.choose("basis.kind", file.kind.get_ref(), file.kind.span(), &kinds)?;
    let Basis::Lme { mut cutoff, .. } = kind else {
        for (key, value) in [("basis.gamma", &file.gamma), ("basis.cutoff", &file.cutoff)] {
            if let Some(value) = value {
                let problem = format!("it means nothing to the basis \"{}\"", file.kind.get_ref());
                return Err(check.source.error(key, value.span(), problem));
            }
        }
        return Ok(kind);
    };
    let Some(gamma) = &file.gamma else {
        let problem = "the basis \"lme\" needs this key";
        return Err(check.source.error("basis.gamma", file.kind.span(), problem));
    };
    let gamma = check.number("basis.gamma", gamma, |gamma| (1e-6..=1e6).contains(&gamma))?;
    if let Some(value) = &file.cutoff {
        cutoff = check.number("basis.cutoff", value, |tol| (0.0..1.0).contains(&tol))?;
    }
    Ok(Basis::Lme { gamma, cutoff })
}

/// What OTM cannot do, refused.
pub fn otm(check: &Check, file: &File) -> Result<(), Box<SceneError>> {
    let refuse = |key: &str, span: std::ops::Range<usize>, problem: &str, allowed: &str| {
        let mut error = check.source.error(key, span, format!("with the method \"otm\" {problem}"));
        error.allowed = allowed.to_string();
        Err(error)
    };
    let kind = file.basis.kind.get_ref().as_str();
    if !(kind == "lme" || (kind == "linear" && check.dimension == 1)) {
        let problem = "the basis lives on moving nodes";
        return refuse(
            "basis.kind",
            file.basis.kind.span(),
            problem,
            "\"lme\", in 1D also \"linear\"",
        );
    }
    let integrator = &file.time.integrator;
    if integrator.get_ref() != "newmark" {
        let problem = "time goes by central differences";
        return refuse("time.integrator", integrator.span(), problem, "\"newmark\"");
    }
    if let Some(reading) = &file.time.reading {
        let problem = "there is no step 8 to read";
        return refuse("time.reading", reading.span(), problem, "no such key");
    }
    if file.mass.get_ref() != "lumped" {
        let problem = "the nodal mass is lumped";
        return refuse("mass", file.mass.span(), problem, "\"lumped\"");
    }
    let per_cell = &file.grid.particles_per_cell;
    if per_cell.get_ref().0.iter().any(|n| *n > 4) {
        let problem = "particles are Gauss's points";
        return refuse("grid.particles_per_cell", per_cell.span(), problem, "1, 2, 3 or 4");
    }
    if let Some((name, cells)) = file.grid.beyond.iter().next() {
        let problem = "the nodes are the body's own, and none stands beyond it";
        return refuse(&format!("grid.beyond.{name}"), cells.span(), problem, "no such key");
    }
    Ok(())
}
