//! The matrix: every basis with every integrator and both mass matrices on the
//! Dyka and Ingel bar, its histories pinned and its errors bounded.

use crate::support::*;
use lme_mpm::output::summary::lines;
use lme_mpm::run::Outcome;
use std::fmt::Write;

/// Both mass matrices, each with a Courant number at which all schemes with all
/// bases are stable.
const MASSES: [(&str, [&str; 2]); 2] = [
    ("lumped", ["mass=lumped", "time.cfl=0.5"]),
    ("consistent", ["mass=consistent", "time.cfl=0.35"]),
];

/// Rows of each history that are printed; the digests cover all of them.
const ROWS: usize = 33;

struct Run {
    basis: &'static str,
    mass: &'static str,
    scheme: &'static str,
    outcome: Outcome,
    /// Relative errors of v, σ, u, and the energy drift at the end.
    errors: [f64; 4],
}

fn runs() -> Vec<Run> {
    let mut runs = Vec::new();
    for (mass, mass_sets) in &MASSES {
        for (basis, basis_sets) in BASES {
            for (scheme, scheme_sets) in SCHEMES {
                let scene = dyka(&[&mass_sets[..], basis_sets, scheme_sets].concat());
                let outcome = finished(&scene);
                let lines = lines(&scene, &outcome, 0.0);
                let errors = [
                    "velocity_end_rms_relative",
                    "stress_three_quarter_rms_relative",
                    "displacement_field_rms_relative",
                    "energy_drift",
                ]
                .map(|name| lines.iter().find(|line| line.quantity == name).unwrap().value);
                runs.push(Run { basis, mass, scheme, outcome, errors });
            }
        }
    }
    runs
}

/// One history of one basis and mass for all schemes side by side, thinned out
/// to `ROWS` rows and rounded to eight digits, and a digest of the bits of all
/// rows of each scheme.
fn pin(runs: &[&Run], probe: &str) -> String {
    let column = |run: &Run, name: &str| run.outcome.history.column(name).unwrap();
    let (step, t) = (column(runs[0], "step"), column(runs[0], "t"));
    let exact = column(runs[0], &format!("{probe}_exact"));
    let histories: Vec<Vec<f64>> = runs.iter().map(|run| column(run, probe)).collect();
    let mut text = format!("{:>5} {:>12} {:>15}", "step", "t", "exact");
    for run in runs {
        write!(text, " {:>21}", run.scheme).unwrap();
    }
    let last = t.len() - 1;
    for row in 0..ROWS {
        let k = row * last / (ROWS - 1);
        write!(text, "\n{:>5} {:>12.5e} {:>15.7e}", step[k], t[k], exact[k]).unwrap();
        for history in &histories {
            write!(text, " {:>21.7e}", history[k]).unwrap();
        }
    }
    write!(text, "\n{:<34}", "bits of all rows").unwrap();
    for history in &histories {
        write!(text, " {:>21}", format!("{:016x}", digest(history))).unwrap();
    }
    text + "\n"
}

/// Every history is the approved one, and every run is right: its errors stay
/// below those of a run that is merely stable. Stress-last and generalized-α may
/// lose energy, the others keep it to two percent.
#[test]
fn matrix_of_histories() {
    let runs = runs();
    let mut table = String::from(
        "basis,mass,scheme,velocity at L,stress at 3L/4,displacement field,energy drift\n",
    );
    for run in &runs {
        let Run { basis, mass, scheme, errors: [v, s, u, drift], .. } = run;
        let name = format!("{basis}, {mass}, {scheme}");
        assert!(*v < 0.25 && *s < 0.4 && *u < 0.1, "{name}: {v} {s} {u}");
        let damped = scheme.contains("(last)") || scheme.contains("generalized");
        let least = if damped { -0.2 } else { -0.02 };
        assert!((least..0.02).contains(drift), "{name}: {drift}");
        writeln!(table, "{basis},{mass},{scheme},{v:.4},{s:.4},{u:.4},{drift:.4}").unwrap();
    }
    approve("matrix__errors", &table);
    for (mass, _) in &MASSES {
        for (basis, _) in BASES {
            let own: Vec<&Run> =
                runs.iter().filter(|run| run.mass == *mass && run.basis == basis).collect();
            assert_eq!(own.len(), SCHEMES.len());
            let name = basis.replace("lme γ = ", "lme_");
            for probe in ["velocity_end", "stress_three_quarter"] {
                approve(&format!("matrix__{name}__{mass}__{probe}"), &pin(&own, probe));
            }
        }
    }
}

/// With the consistent mass matrix and the linear basis nothing filters the velocity
/// on its way to the nodes and back: stress-first and stress-last have one stress
/// history, up to the displacement of the particles. (Bases with light nodes, which
/// are lumped, keep a filter there.)
#[test]
fn matrix_stress_last_joins_the_leapfrog() {
    for (mass, joined) in [("consistent", true), ("lumped", false)] {
        let stress = |scheme: usize| {
            let small = ["initial_velocity.0.velocity=1e-9", "time.cfl=0.3"];
            let mass = format!("mass={mass}");
            let scene = dyka(&[SCHEMES[scheme].1, &small, &[mass.as_str()]].concat());
            finished(&scene).history.column("stress_three_quarter").unwrap()
        };
        let (first, last) = (stress(2), stress(3));
        let apart = first.iter().zip(&last).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let plateau = 1e-9 * 4e7 / 2.0;
        assert_eq!(apart < 1e-6 * plateau, joined, "{mass}: {apart:e} of {plateau:e}");
    }
}
