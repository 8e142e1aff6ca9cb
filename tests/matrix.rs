//! The matrix: every basis with every integrator and both mass matrices on the
//! Dyka and Ingel bar, its histories pinned and its errors bounded.

use crate::support::*;
use lme_mpm::run::Outcome;
use std::fmt::Write;

/// Rows of each history that are printed; the digests cover all of them.
const ROWS: usize = 33;

struct Run {
    basis: BasisCase,
    mass: MassCase,
    scheme: Scheme,
    outcome: Outcome,
    errors: Each<f64>,
    drift: f64,
}

/// All runs, each mass matrix with a Courant number at which all schemes with all bases
/// are stable.
fn runs() -> Vec<Run> {
    let mut runs = Vec::new();
    for (mass, cfl) in [(LUMPED, "time.cfl=0.5"), (CONSISTENT, "time.cfl=0.35")] {
        for basis in BASES {
            for scheme in SCHEMES {
                let scene = dyka(&[mass.sets, &[cfl], basis.sets, scheme.sets].concat());
                let outcome = finished(&scene);
                let errors = bar_errors(&scene, &outcome);
                let drift = value(&scene, &outcome, "energy_drift");
                runs.push(Run { basis, mass, scheme, outcome, errors, drift });
            }
        }
    }
    runs
}

/// One history of one basis and mass for all schemes side by side, thinned out
/// to `ROWS` rows and rounded to eight digits, and a digest of the bits of all
/// rows of each scheme.
fn pin(runs: &[&Run], probe: &str) -> String {
    let of = |run: &Run, name: &str| column(&run.outcome.history, name);
    let (step, t) = (of(runs[0], "step"), of(runs[0], "t"));
    let exact = of(runs[0], &format!("{probe}_exact"));
    let histories: Vec<Vec<f64>> = runs.iter().map(|run| of(run, probe)).collect();
    let mut text = format!("{:>5} {:>12} {:>15}", "step", "t", "exact");
    for run in runs {
        write!(text, " {:>21}", run.scheme.name).unwrap();
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
/// below those of a run that is merely stable, a quarter for v, 0.4 for σ and a tenth
/// for u on 40 cells. The leapfrogs keep the energy to two percent; stress-last and
/// generalized-α may lose a fifth, and gain no more.
#[test]
fn matrix_of_histories() {
    let runs = runs();
    let mut table = String::from(
        "basis,mass,scheme,velocity at L,stress at 3L/4,displacement field,energy drift\n",
    );
    for Run { basis, mass, scheme, errors, drift, .. } in &runs {
        let name = format!("{},{},{}", basis.name, mass.name, scheme.name);
        let Each { v, sigma, u } = *errors;
        assert!(v < 0.25 && sigma < 0.4 && u < 0.1, "{name}: {errors:?}");
        let least = if scheme.leapfrog { -0.02 } else { -0.2 };
        assert!((least..0.02).contains(drift), "{name}: {drift}");
        writeln!(table, "{name},{v:.4},{sigma:.4},{u:.4},{drift:.4}").unwrap();
    }
    approve("matrix__errors", &table);
    for own in runs.chunks(SCHEMES.len()) {
        let own: Vec<&Run> = own.iter().collect();
        let (basis, mass) = (own[0].basis.file, own[0].mass.name);
        for probe in ["velocity_end", "stress_three_quarter"] {
            approve(&format!("matrix__{basis}__{mass}__{probe}"), &pin(&own, probe));
        }
    }
}

/// With the consistent mass matrix and the linear basis nothing filters the velocity
/// on its way to the nodes and back: stress-first and stress-last have one stress
/// history, to 1e-6 of the plateau, on 40 cells where the particles hardly move; with the
/// lumped one they have not. (Bases with light nodes, which are lumped, keep a filter
/// there.)
#[test]
fn matrix_stress_last_joins_the_leapfrog() {
    for mass in MASSES {
        let slow = ["initial_velocity.0.velocity=1e-9", "time.cfl=0.3"];
        let [first, last] = [STRESS_FIRST, STRESS_LAST].map(|scheme| {
            let outcome = finished(&dyka(&[scheme.sets, &slow, mass.sets].concat()));
            column(&outcome.history, "stress_three_quarter")
        });
        let (off, plateau) = (apart(&first, &last), 1e-9 * 4e7 / 2.0);
        assert_eq!(off < 1e-6 * plateau, mass == CONSISTENT, "{}: {off:e}", mass.name);
    }
}
