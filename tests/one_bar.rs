//! The file that is read first against the library, and against the exact solution.

use crate::support::*;
use lme_mpm::method::measure::rms;
use lme_mpm::method::one_bar::{OneBar, one_bar};

/// One file and the library agree on the bar of Dyka and Ingel, 40 cells, two particles per
/// cell, four transits: in all particles at the end and both histories, to round-off. With
/// that, its velocity at the free end is as near to the exact solution as the library's.
#[test]
fn one_bar_is_the_library() {
    for (gamma, sets, round_off) in
        [(None, &[][..], 1e-14), (Some(0.8), &["basis.kind=lme", "basis.gamma=0.8"][..], 2e-14)]
    {
        let scene = dyka(sets);
        let outcome = finished(&scene);
        let bar = OneBar {
            length: 0.1333,
            density: 7833.0,
            youngs_modulus: 200e9,
            thrown_from: scene_region_start(),
            velocity: 5.0,
            cells: 40,
            particles_per_cell: 2,
            dt: outcome.dt,
            steps: outcome.history.rows().len() - 1,
        };
        let history = one_bar(&bar, gamma).unwrap();
        let column = |name: &str| outcome.history.column(name).unwrap();
        let plateau = 0.5 * 5.0 * 7833.0 * (200e9_f64 / 7833.0).sqrt();
        let close = |what: &str, scale: f64, here: &[f64], there: &[f64]| {
            assert_eq!(here.len(), there.len());
            let worst = here.iter().zip(there).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < round_off * scale, "γ = {gamma:?}, {what}: {:e}", worst / scale);
        };
        let v_end: Vec<f64> = history.iter().map(|[_, v, ..]| v[79]).collect();
        let stress: Vec<f64> = history.iter().map(|[_, _, sigma, _]| sigma[59]).collect();
        close("velocity at L", 5.0, &v_end, &column("velocity_end"));
        close("stress at 3L/4", plateau, &stress, &column("stress_three_quarter"));
        let last = history.last().unwrap();
        let of = |name: &str| outcome.particles.column(name).unwrap();
        for (what, scale, here) in [
            ("position", 0.1333, &last[0]),
            ("velocity", 5.0, &last[1]),
            ("stress", plateau, &last[2]),
            ("density", 7833.0, &last[3]),
        ] {
            close(what, scale, here, &of(what));
        }
        let exact = column("velocity_end_exact");
        let error = rms(v_end.into_iter().zip(exact)) / 5.0;
        assert!((0.1..0.2).contains(&error), "γ = {gamma:?}: {error}");
    }
}

/// What the plain file cannot do has no answer: a particle that leaves the grid, a λ that
/// Newton's method from 0 does not find.
#[test]
fn one_bar_knows_its_limits() {
    let bar = |velocity| OneBar {
        length: 1.0,
        density: 1.0,
        youngs_modulus: 1.0,
        thrown_from: 0.75,
        velocity,
        cells: 8,
        particles_per_cell: 2,
        dt: 0.05,
        steps: 40,
    };
    assert!(one_bar(&bar(1e-3), None).is_some() && one_bar(&bar(1e-3), Some(4.0)).is_some());
    assert_eq!(one_bar(&bar(100.0), None), None);
    assert_eq!(one_bar(&bar(-100.0), None), None);
    assert_eq!(one_bar(&bar(1e-3), Some(20.0)), None);
}

/// Where the thrown quarter of the scene begins (m).
fn scene_region_start() -> f64 {
    let lme_mpm::scene::Motion::Regions(regions) = dyka(&[]).motion else {
        panic!("the bar is thrown in a region");
    };
    regions[0].from[0]
}
