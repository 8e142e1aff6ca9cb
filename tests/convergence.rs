//! Observed order: in time on smooth data, in space on the bar's jumps.

use crate::support::*;
use lme_mpm::method::measure::{Order, observed_order, rms};
use lme_mpm::output::summary::lines;
use std::fmt::Write;

/// The slopes of u and v in Δt, against a run of the same grid with 16 times
/// the steps of the finest, so that the grid's own error drops out.
fn orders(reading: &str) -> (f64, f64) {
    let (u, v) = smooth_run(&["time.reading=second-order"], 8192);
    let steps = [128, 192, 256, 384, 512];
    let dt: Vec<f64> = steps.iter().map(|n| 1.0 / *n as f64).collect();
    let errors: Vec<(f64, f64)> = steps
        .iter()
        .map(|n| {
            let (u_n, v_n) = smooth_run(&[&format!("time.reading={reading}")], *n);
            (rms(u_n.into_iter().zip(u.clone())), rms(v_n.into_iter().zip(v.clone())))
        })
        .collect();
    let of =
        |pick: fn(&(f64, f64)) -> f64| slope(&dt, &errors.iter().map(pick).collect::<Vec<_>>());
    (of(|e| e.0), of(|e| e.1))
}

/// Step 8 with γ f Δt is of second order in time. (The first-order remainder of
/// the displacement, see `one_particle_shows_the_remapping_term`, is below
/// these errors on a fine grid.) As printed, with f Δt, the displacement is of
/// first order; the velocity stays of second order while the particles hardly
/// move, because p_I of step 8 enters nothing but the positions.
#[test]
fn step_eight_orders_of_both_readings() {
    let mut table = String::from("reading,displacement,velocity\n");
    for (reading, expected_u) in [("second-order", 2.0), ("as-printed", 1.0)] {
        let (u, v) = orders(reading);
        assert!((u - expected_u).abs() < 0.05, "{reading}, displacement: order {u}");
        assert!((v - 2.0).abs() < 0.05, "{reading}, velocity: order {v}");
        table += &format!("{reading},{u:.3},{v:.3}\n");
    }
    approve("newmark__orders_in_time", &table);
}

/// On the bar's jumps v and σ converge like h^(1/3): a second-order scheme
/// disperses a front over h^(2/3), and the RMS is the root of that. The error of
/// u, an integral, is of the size h^(2/3) there, which gives h. (A first-order
/// scheme would give v the order 1/4. Grids below 80 cells are not yet in the
/// asymptotic range.)
#[test]
fn dyka_order_in_space() {
    let cells = [80, 160, 320, 640];
    let h: Vec<f64> = cells.iter().map(|n| 1.0 / *n as f64).collect();
    let mut errors = vec![Vec::new(); 3];
    for n in cells {
        let scene = dyka(&[&format!("grid.cells={n}")]);
        let lines = lines(&scene, &finished(&scene), 0.0);
        let names = [
            "velocity_end_rms_relative",
            "stress_three_quarter_rms_relative",
            "displacement_field_rms_relative",
        ];
        for (list, name) in errors.iter_mut().zip(names) {
            list.push(lines.iter().find(|line| line.quantity == name).unwrap().value);
        }
    }
    let [v, stress, u] = [0, 1, 2].map(|i| slope(&h, &errors[i]));
    assert!((v - 1.0 / 3.0).abs() < 0.05, "velocity: order {v}");
    assert!((stress - 1.0 / 3.0).abs() < 0.05, "stress: order {stress}");
    assert!((u - 1.0).abs() < 0.05, "displacement: order {u}");
}

/// Fields of the vibrating bar at t = 0.8 L/c on 80 cells, with `steps` steps:
/// v, σ and u of all particles.
fn vibrating(sets: &[&str], steps: usize) -> [Vec<f64>; 3] {
    let cfl = format!("time.cfl={:?}", 0.8 * 80.0 / steps as f64);
    let scene = scene(VIBRATION, &[sets, &["grid.cells=80", "time.end=0.8", &cfl]].concat());
    let outcome = finished(&scene);
    assert_eq!(outcome.cost.steps, steps as u64);
    ["velocity", "stress", "displacement"].map(|name| outcome.particles.column(name).unwrap())
}

/// Observed order in Δt, one grid, against the same scheme with 32 times the
/// steps of the finest: 2 for Newmark's method, 1 for a velocity that stands half
/// a step from where it is shown and for a displacement that counts half of a
/// force twice. The displacement of the second-order schemes mixes Δt² with the
/// remainder of order Δt h² of the mapping, and so does the velocity of
/// generalized-α, which maps its acceleration: no single order fits them.
#[test]
fn order_in_time_of_every_scheme() {
    let steps = [160, 320, 640, 1280, 2560];
    let dt = steps.map(|n| 1.0 / n as f64);
    let mut table = String::from("scheme,velocity,stress,displacement,error of v at the finest\n");
    for (name, sets) in SCHEMES {
        let limit = vibrating(sets, 32 * 2560);
        let mut errors = [Vec::new(), Vec::new(), Vec::new()];
        for n in steps {
            for ((list, own), limit) in errors.iter_mut().zip(vibrating(sets, n)).zip(&limit) {
                list.push(rms(own.into_iter().zip(limit.iter().copied())));
            }
        }
        let [v, stress, u] = errors.each_ref().map(|list| observed_order(&dt, list));
        let finest = errors[0][4] / 1e-6;
        writeln!(table, "{name},{v},{stress},{u},{finest:.2e}").unwrap();
        let shifted = name.contains("euler");
        let near = |order: &Order, theory: f64| (order.slope - theory).abs() < 0.02;
        match name {
            "generalized-α (0.8)" => assert!((1.6..2.1).contains(&v.slope), "{name}: {v}"),
            _ => assert!(near(&v, if shifted { 1.0 } else { 2.0 }), "{name}: {v}"),
        }
        if name.starts_with("newmark") || name.contains("first") || name.contains("modified") {
            assert!(near(&stress, 2.0), "{name}: {stress}");
        }
        if name.contains("printed") || name.contains("first") {
            assert!(near(&u, 1.0), "{name}: {u}");
        }
    }
    approve("order__in_time", &table);
}

/// Observed order in h of the vibrating bar's fields at t = 0.8 L/c, with time
/// steps so small that they do not show. The stress of the linear basis is one
/// number in each cell and so of first order at particles off its middle; v and u
/// are of second order, and theory lies inside the 95% intervals. The wide bases
/// leave fine waves almost without energy, which the ends excite.
#[test]
fn order_in_space_of_every_basis() {
    let cells = [5, 10, 20, 40, 80];
    let h = cells.map(|n| 1.0 / f64::from(n));
    let mut table =
        String::from("basis,mass,velocity,stress,displacement,error of v at 80 cells,of u\n");
    for (basis, more) in BASES {
        for mass in ["lumped", "consistent"] {
            let mut errors = [Vec::new(), Vec::new(), Vec::new()];
            for n in cells {
                let sets = [
                    format!("mass={mass}"),
                    format!("grid.cells={n}"),
                    format!("time.cfl={:?}", 0.01 * f64::from(n) / 80.0),
                ];
                let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
                let fixed = ["time.end=0.8", "vibration.velocity=1e-7"];
                let scene = scene(VIBRATION, &[more, &sets[..], &fixed].concat());
                let outcome = finished(&scene);
                for (list, name) in errors.iter_mut().zip(["velocity", "stress", "displacement"]) {
                    list.push(value(&scene, &outcome, &format!("{name}_field_rms_relative")));
                }
            }
            let [v, stress, u] = errors.each_ref().map(|list| observed_order(&h, list));
            let (fine_v, fine_u) = (errors[0][4], errors[2][4]);
            writeln!(table, "{basis},{mass},{v},{stress},{u},{fine_v:.2e},{fine_u:.2e}").unwrap();
            if ["linear", "ugimp"].contains(&basis) {
                let name = format!("{basis}, {mass}: {v}, {stress}, {u}");
                assert!(v.contains(2.0) && u.contains(2.0), "{name}");
                assert!(stress.contains(1.0) || (stress.slope - 1.0).abs() < 1e-3, "{name}");
                // The bound of an independent prototype.
                assert!(fine_v <= 1.1e-4, "{name}: {fine_v:e}");
            }
            // Bounds for the wide bases, whose lines are not straight: the errors at 80
            // cells are what counts.
            let name = format!("{basis}, {mass}: {v}, {u}, {fine_v:e}, {fine_u:e}");
            assert!(v.slope > 0.5 && u.slope > 1.4, "{name}");
            assert!(fine_v < 7e-4 && fine_u < 7e-5, "{name}");
        }
    }
    approve("order__in_space", &table);
}
