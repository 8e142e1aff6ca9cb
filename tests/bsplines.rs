//! Cubic B-splines beside quadratic ones: order, the bar, crossing, and the time step.

use crate::published::VIBRATING;
use crate::support::*;
use lme_mpm::method::measure::observed_order;
use lme_mpm::run::stability;
use lme_mpm::scene::{DYKA, wave_speed};
use std::fmt::Write;

const DEGREES: [(&str, &[&str]); 2] =
    [("quadratic", &["basis.kind=bspline"]), ("cubic", &["basis.kind=bspline", "basis.degree=3"])];

/// The vibrating bar swings so little that no particle crosses a cell, and for a small part of its
/// period, in small steps.
const SWINGING: [&str; 3] = ["vibration.velocity=0.001", "time.end=0.1", "time.cfl=0.0025"];

/// On the swinging bar the displacement of quadratic B-splines is of third order, that of cubic
/// ones of fourth, that of the linear basis of second, each to 0.15.
#[test]
fn bsplines_have_their_orders() {
    let mut table = String::from("basis,5 cells,10,20,40,order\n");
    let cells = [5, 10, 20, 40];
    let h = cells.map(|n| 1.0 / f64::from(n));
    let linear: (&str, &[&str]) = ("linear", &["basis.kind=linear"]);
    for ((name, sets), theory) in [(linear, 2.0), (DEGREES[0], 3.0), (DEGREES[1], 4.0)] {
        let errors = cells.map(|n| {
            let n = format!("grid.cells={n}");
            let scene = scene(VIBRATING, &[&SWINGING, sets, &[&n]].concat());
            field_errors(&scene, &finished(&scene)).u
        });
        let order = observed_order(&h, &errors).slope;
        assert!((order - theory).abs() < 0.15, "{name}: {order}");
        let shown = errors.map(|error| format!("{error:.1e}")).join(",");
        writeln!(table, "{name},{shown},{order:.2}").unwrap();
    }
    approve("bsplines__orders", &table);
}

/// The bar on 80 cells with the consistent matrix, and the motion across cells on 160 with two
/// and four particles per cell: cubic functions have the smaller error of each of the three fields
/// than quadratic ones. On the bar lumping takes that away.
#[test]
fn bsplines_side_by_side() {
    let mut table =
        String::from("motion,degree,mass,particles per cell,velocity,stress,displacement\n");
    let crossing = MANUFACTURED.replace("\"lme\"\ngamma = 0.8\n", "\"linear\"\n");
    let crossing_sets = ["grid.cells=160", "time.cfl=0.1"];
    for (motion, text, sets, per_cell) in [
        ("bar", DYKA, &["grid.cells=80", "time.cfl=0.2"], "2"),
        ("across cells", &crossing, &crossing_sets, "2"),
        ("across cells", &crossing, &crossing_sets, "4"),
    ] {
        for mass in MASSES {
            let errors = DEGREES.map(|(degree, own)| {
                let particles = format!("grid.particles_per_cell={per_cell}");
                let scene = scene(text, &[sets, own, mass.sets, &[&particles]].concat());
                let result = finished(&scene);
                let Each { v, sigma, u } = if motion == "bar" {
                    bar_errors(&scene, &result)
                } else {
                    field_errors(&scene, &result)
                };
                let row = format!("{motion},{degree},{},{per_cell}", mass.name);
                writeln!(table, "{row},{v:.1e},{sigma:.1e},{u:.1e}").unwrap();
                [v, sigma, u]
            });
            let [quadratic, cubic] = errors;
            let better = cubic.iter().zip(quadratic).all(|(cubic, quadratic)| *cubic < quadratic);
            let lumped_bar = motion == "bar" && mass == LUMPED;
            assert_eq!(better, !lumped_bar, "{motion}, {}, {per_cell}", mass.name);
        }
    }
    approve("bsplines__side_by_side", &table);
}

/// The largest stable Δt of cubic functions is predicted, and found by marching to 1%: on the bar
/// with 10 cells, both mass matrices, and particles a fifth of their distance off.
#[test]
fn bsplines_have_a_predicted_limit() {
    let mut table = String::from("degree,mass,c Δt/h predicted,marched\n");
    for (degree, sets) in DEGREES {
        for mass in MASSES {
            let scene = dyka(&[sets, mass.sets, &["grid.cells=10"]].concat());
            let limit = stability::predicted(&scene, 0.2).unwrap();
            let marched = stability::measured(&scene, 0.2, limit, 2000, 2e-3).unwrap();
            assert!((marched / limit - 1.0).abs() < 0.01, "{degree}: {marched:e} {limit:e}");
            let courant = wave_speed(&scene.body) * 10.0 / 0.1333;
            let name = format!("{degree},{}", mass.name);
            writeln!(table, "{name},{:.3},{:.3}", limit * courant, marched * courant).unwrap();
        }
    }
    approve("bsplines__limits", &table);
}
