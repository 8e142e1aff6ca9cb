//! The largest stable time step: predicted against closed forms and against
//! marching.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::run::stability::{grows, measured, predicted};
use lme_mpm::scene::{Scene, wave_speed};
use std::fmt::Write;

/// c Δt / h of a limit (s).
fn courant(scene: &Scene, limit: f64) -> f64 {
    let h = scene.body.length[0] / scene.grid.cells[0] as f64;
    wave_speed(&scene.body) * limit / h
}

/// In a long bar with the linear basis the limit c Δt/h is, to a percent on 60 cells: with
/// b the mean of 2ξ(1 − ξ) over the particles of a cell, √(8b) for the leapfrogs,
/// 1/√(1 + 2b) for stress-last and √(1 − 2b) with the consistent mass matrix. So 2, √3,
/// 1.6777, 1.6583 with 1 to 4 particles in each cell. (With one particle and the
/// consistent mass matrix it is 0, and the matrix is singular.)
#[test]
fn stability_closed_forms_of_the_linear_basis() {
    // Both ends fixed, where the body is like the inside.
    let long = ["grid.cells=60", "boundary.right=fixed"];
    let found = |sets: &[&str]| {
        let scene = dyka(&[sets, &long].concat());
        courant(&scene, predicted(&scene, 0.0).unwrap())
    };
    for n in 1..=4 {
        let count = f64::from(n);
        let b = 1.0 / 3.0 + 1.0 / (6.0 * count * count);
        let per_cell = format!("grid.particles_per_cell={n}");
        let near = |sets: Sets, expected: f64| {
            let found = found(&[sets, &[&per_cell]].concat());
            assert!((found / expected - 1.0).abs() < 0.01, "{n}, {sets:?}: {found}, {expected}");
        };
        near(NEWMARK.sets, (8.0 * b).sqrt());
        near(STRESS_LAST.sets, 1.0 / (1.0 + 2.0 * b).sqrt());
        if n > 1 {
            near(CONSISTENT.sets, (1.0 - 2.0 * b).sqrt());
        }
    }
    assert_relative_eq!(found(&[]), 3.0_f64.sqrt(), max_relative = 0.002);
}

/// Generalized-α over the whole range of ρ_b.
const ALPHAS: [Scheme; 4] = [
    Scheme {
        name: "generalized-α (0)",
        sets: &["time.integrator=generalized-alpha", "time.rho_b=0"],
        ..GENERALIZED_ALPHA
    },
    Scheme {
        name: "generalized-α (0.5)",
        sets: &["time.integrator=generalized-alpha", "time.rho_b=0.5"],
        ..GENERALIZED_ALPHA
    },
    GENERALIZED_ALPHA,
    Scheme {
        name: "generalized-α (1)",
        sets: &["time.integrator=generalized-alpha", "time.rho_b=1"],
        ..GENERALIZED_ALPHA
    },
];

/// At 0.99 of the predicted limit a run of 1500 steps stays bounded, at 1.01 it grows:
/// every basis with every scheme, 8 cells, 1, 2 and 4 particles in each (with the
/// consistent mass matrix 2 and 4: with one it is singular, or so nearly that round-off
/// grows), at two offsets. Generalized-α with ρ_b = 1 and the consistent mass matrix may
/// stay bounded above the limit, which is then on the safe side.
#[test]
fn stability_of_every_combination() {
    let others = SCHEMES.into_iter().filter(|scheme| *scheme != GENERALIZED_ALPHA);
    let schemes: Vec<Scheme> = others.chain(ALPHAS).collect();
    let mut table = String::from("basis,mass,per cell,offset");
    for scheme in &schemes {
        write!(table, ",{}", scheme.name).unwrap();
    }
    for basis in BASES {
        for (mass, counts) in [(LUMPED, &[1, 2, 4][..]), (CONSISTENT, &[2, 4])] {
            for per_cell in counts {
                for offset in [0.0, 0.25] {
                    let row = format!("{},{},{per_cell},{offset}", basis.name, mass.name);
                    write!(table, "\n{row}").unwrap();
                    for scheme in &schemes {
                        let cells = format!("grid.particles_per_cell={per_cell}");
                        let fixed = ["grid.cells=8", &cells];
                        let scene = dyka(&[basis.sets, scheme.sets, mass.sets, &fixed].concat());
                        let limit = predicted(&scene, offset).unwrap();
                        let grows =
                            |share: f64| grows(&scene, offset, share * limit, 1500).unwrap();
                        let name = format!("{row}, {}", scheme.name);
                        assert!(!grows(0.99), "{name}: grows below {limit:e}");
                        let safe_side = *scheme == ALPHAS[3] && mass == CONSISTENT;
                        assert!(grows(1.01) || safe_side, "{name}: bounded above {limit:e}");
                        write!(table, ",{:.3}", courant(&scene, limit)).unwrap();
                    }
                }
            }
        }
    }
    approve("stability__limits", &(table + "\n"));
}

/// The same holds of OTM in one to three dimensions, and of MPM in two and three, over
/// 800 steps of a small block that is fixed on the left.
#[test]
fn stability_of_otm_and_of_more_dimensions() {
    let block = |dimension: usize, sets: &[&str]| {
        let list = |x: &str| each_axis(dimension, x);
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
    let bar = |basis: BasisCase| dyka(&[basis.sets, &["method=otm", "grid.cells=10"]].concat());
    let small = ["method=otm", "grid.cells=[2,2,2]", "grid.particles_per_cell=[1,1,1]"];
    for (name, scene) in [
        ("otm 1D, γ = 0.8", bar(LME_WIDE)),
        ("otm 1D, γ = 4", bar(LME_NARROW)),
        ("otm 2D", block(2, &["method=otm"])),
        ("otm 3D", block(3, &small)),
        ("mpm 2D", block(2, &[])),
        ("mpm 2D last", block(2, STRESS_LAST.sets)),
        ("mpm 2D consistent", block(2, CONSISTENT.sets)),
        ("mpm 3D", block(3, &["grid.particles_per_cell=[1,2,1]"])),
    ] {
        let limit = predicted(&scene, 0.0).unwrap();
        assert!(!grows(&scene, 0.0, 0.99 * limit, 800).unwrap(), "{name}");
        assert!(grows(&scene, 0.0, 1.01 * limit, 800).unwrap(), "{name}");
    }
}

/// The bisection finds the predicted limit to a percent, from guesses a fifth and seven
/// times as large: the bar on 10 cells.
#[test]
fn stability_bisection() {
    let scene = dyka(&["grid.cells=10"]);
    let limit = predicted(&scene, 0.0).unwrap();
    for guess in [0.2 * limit, limit, 7.0 * limit] {
        let found = measured(&scene, 0.0, guess, 1500, 1e-3).unwrap();
        assert!((found / limit - 1.0).abs() < 0.01, "{found} and {limit}");
    }
}
