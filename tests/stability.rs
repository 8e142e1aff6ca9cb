//! The largest stable time step: predicted against closed forms and against
//! marching.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::run::stability::{grows, measured, predicted};
use lme_mpm::scene::Scene;
use std::fmt::Write;

/// c Δt / h of a limit (s).
fn courant(scene: &Scene, limit: f64) -> f64 {
    let c = lme_mpm::scene::wave_speed(&scene.body);
    let h = scene.body.length[0] / scene.grid.cells[0] as f64;
    c * limit / h
}

/// In a long bar with the linear basis: with b the mean of 2ξ(1 − ξ) over the
/// particles of a cell, √(8b) for the leapfrogs, 1/√(1 + 2b) for stress-last and
/// √(1 − 2b) with the consistent mass matrix. So 2, √3, 1.6777, 1.6583 with 1 to 4
/// particles in each cell.
#[test]
fn stability_closed_forms_of_the_linear_basis() {
    for n in 1..=4 {
        let count = f64::from(n);
        let b = 1.0 / 3.0 + 1.0 / (6.0 * count * count);
        let per_cell = format!("grid.particles_per_cell={n}");
        for (sets, expected) in [
            (&["time.integrator=newmark"][..], (8.0 * b).sqrt()),
            (
                &["time.integrator=forward-euler", "time.stress_update=last"],
                1.0 / (1.0 + 2.0 * b).sqrt(),
            ),
            (&["mass=consistent"], (1.0 - 2.0 * b).sqrt()),
        ] {
            if n == 1 && expected < 0.1 {
                continue; // the limit is 0: the matrix is singular in a long bar
            }
            // Both ends fixed, where the body is like the inside.
            let fixed = ["grid.cells=60", "boundary.right=fixed", per_cell.as_str()];
            let scene = dyka(&[sets, &fixed].concat());
            let found = courant(&scene, predicted(&scene, 0.0).unwrap());
            assert!((found / expected - 1.0).abs() < 0.01, "{n}, {sets:?}: {found}, {expected}");
        }
    }
    let scene = dyka(&["grid.cells=60", "boundary.right=fixed"]);
    let found = courant(&scene, predicted(&scene, 0.0).unwrap());
    assert_relative_eq!(found, 3.0_f64.sqrt(), max_relative = 0.002);
}

/// Every basis with every scheme, both masses, 1, 2 and 4 particles per cell (with the
/// consistent mass matrix 2 and 4), two offsets: at 0.99 of the predicted limit a run stays
/// bounded, at 1.01 it grows.
#[test]
fn stability_of_every_combination() {
    let alphas = [
        ("generalized-α (0)", "time.rho_b=0"),
        ("generalized-α (0.5)", "time.rho_b=0.5"),
        ("generalized-α (0.8)", "time.rho_b=0.8"),
        ("generalized-α (1)", "time.rho_b=1"),
    ];
    let mut schemes: Vec<(&str, Vec<&str>)> =
        SCHEMES[..6].iter().map(|(name, sets)| (*name, sets.to_vec())).collect();
    for (name, rho) in alphas {
        schemes.push((name, vec!["time.integrator=generalized-alpha", rho]));
    }
    let mut table = String::from("basis,mass,per cell,offset");
    for (scheme, _) in &schemes {
        write!(table, ",{scheme}").unwrap();
    }
    let (mut count, mut singular) = (0, 0);
    for (basis, more) in BASES {
        for mass in ["mass=lumped", "mass=consistent"] {
            for per_cell in [1, 2, 4] {
                if per_cell == 1 && mass == "mass=consistent" {
                    continue; // singular, or so nearly that round-off grows
                }
                for offset in [0.0, 0.25] {
                    let mass_name = &mass[5..];
                    write!(table, "\n{basis},{mass_name},{per_cell},{offset}").unwrap();
                    for (scheme, sets) in &schemes {
                        let per_cell = format!("grid.particles_per_cell={per_cell}");
                        let fixed = [mass, "grid.cells=8", per_cell.as_str()];
                        let scene = dyka(&[more, &sets[..], &fixed].concat());
                        let limit = match predicted(&scene, offset) {
                            Err(Breakdown::SingularMass { .. }) => {
                                singular += 1;
                                table += ",singular";
                                continue;
                            }
                            limit => limit.unwrap(),
                        };
                        let name = format!("{basis}, {mass}, {per_cell}, {offset}, {scheme}");
                        let bounded = !grows(&scene, offset, 0.99 * limit, 1500).unwrap();
                        assert!(bounded, "{name}: grows below {}", courant(&scene, limit));
                        let growing = grows(&scene, offset, 1.01 * limit, 1500).unwrap();
                        let safe_side = *scheme == "generalized-α (1)" && mass.contains("cons");
                        assert!(
                            growing || safe_side,
                            "{name}: bounded above {}",
                            courant(&scene, limit)
                        );
                        write!(table, ",{:.3}", courant(&scene, limit)).unwrap();
                        count += 1;
                    }
                }
            }
        }
    }
    assert!(count > 500, "{count} and {singular} singular");
    approve("stability__limits", &(table + "\n"));
}

/// OTM in one and two dimensions, and MPM in two and three.
#[test]
fn stability_of_otm_and_of_more_dimensions() {
    let block = |dimension: usize, sets: &[&str]| {
        let list = |x: &str| format!("[{}]", vec![x; dimension].join(","));
        let text = format!(
            "title = 'block'\nmethod = 'mpm'\nmass = 'lumped'\n\
             basis = {{ kind = 'lme', gamma = 1.8 }}\nboundary.left = 'fixed'\n\
             body = {{ length = {}, density = 2, youngs_modulus = 7, poisson_ratio = 0.3 }}\n\
             grid = {{ cells = {}, particles_per_cell = {} }}\n\
             time = {{ integrator = 'newmark', cfl = 0.4, end = 0.05 }}\n",
            list("1"),
            list("3"),
            list("2"),
        );
        scene(&text, sets)
    };
    let bar = |gamma: &str| dyka(&["method=otm", "grid.cells=10", "basis.kind=lme", gamma]);
    let scenes = [
        ("otm 1D", bar("basis.gamma=0.8")),
        ("otm 1D", bar("basis.gamma=4")),
        ("otm 2D", block(2, &["method=otm"])),
        (
            "otm 3D",
            block(3, &["method=otm", "grid.cells=[2,2,2]", "grid.particles_per_cell=[1,1,1]"]),
        ),
        ("mpm 2D", block(2, &[])),
        ("mpm 2D last", block(2, &["time.integrator=forward-euler", "time.stress_update=last"])),
        ("mpm 2D consistent", block(2, &["mass=consistent"])),
        ("mpm 3D", block(3, &["grid.particles_per_cell=[1,2,1]"])),
    ];
    for (name, scene) in scenes {
        let limit = predicted(&scene, 0.0).unwrap();
        assert!(!grows(&scene, 0.0, 0.99 * limit, 800).unwrap(), "{name}");
        assert!(grows(&scene, 0.0, 1.01 * limit, 800).unwrap(), "{name}");
    }
}

/// The bisection finds the predicted limit to a percent.
#[test]
fn stability_bisection() {
    let scene = dyka(&["grid.cells=10"]);
    let limit = predicted(&scene, 0.0).unwrap();
    for guess in [0.2 * limit, limit, 7.0 * limit] {
        let found = measured(&scene, 0.0, guess, 1500, 1e-3).unwrap();
        assert!((found / limit - 1.0).abs() < 0.01, "{found} and {limit}");
    }
}
