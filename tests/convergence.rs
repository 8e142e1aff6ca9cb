//! Observed order: in time on smooth data, in space on the bar's jumps.

mod support;

use lme_mpm::measure::rms;
use lme_mpm::summary::lines;
use support::*;

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
