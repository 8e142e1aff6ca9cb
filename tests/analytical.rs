//! Against closed forms: measures worked by hand, and runs that have a closed form.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::measure::{observed_order, rms};
use lme_mpm::output::summary::Scales;

/// (39) with the square: the mean of 3² and 4² is 12.5.
#[test]
fn rms_has_its_square() {
    assert_relative_eq!(rms([(3.0, 0.0), (1.0, 5.0)]), 12.5_f64.sqrt(), max_relative = 1e-15);
    // Errors of opposite sign do not cancel, as they would without it.
    assert_eq!(rms([(1.0, 0.0), (-1.0, 0.0)]), 1.0);
    assert_eq!(rms([]), 0.0);
}

/// The line through ln error over ln h, and Student's interval of its slope, worked by
/// hand: three points 0, 2, 3 and four points 0, 2, 3, 5 over 0, 1, 2, 3.
#[test]
fn observed_order_is_the_least_squares_line() {
    let of = |y: &[f64]| {
        let h: Vec<f64> = (0..y.len()).map(|n| libm::exp(n as f64)).collect();
        let error: Vec<f64> = y.iter().map(|y| libm::exp(*y)).collect();
        observed_order(&h, &error)
    };
    let three = of(&[0.0, 2.0, 3.0]);
    assert_relative_eq!(three.slope, 1.5, max_relative = 1e-14);
    // Residuals −1/6, 1/3, −1/6; Σ (x − 1)² = 2; one degree of freedom.
    assert_relative_eq!(three.half_width, 12.706 * (1.0_f64 / 12.0).sqrt(), max_relative = 1e-12);
    let four = of(&[0.0, 2.0, 3.0, 5.0]);
    assert_relative_eq!(four.slope, 1.6, max_relative = 1e-14);
    // Residuals ∓0.1, ±0.3; Σ (x − 1.5)² = 5; two degrees of freedom.
    assert_relative_eq!(four.half_width, 4.303 * 0.02_f64.sqrt(), max_relative = 1e-12);
    assert!(agrees(&four, 1.6) && agrees(&four, 2.2) && agrees(&four, 1.0));
    assert!(!agrees(&four, 2.21) && !agrees(&four, 0.99));
    assert_eq!(four.to_string(), "1.6000 ± 0.6085");
    // Beyond the table of Student's t there is no interval, and no order agrees with it.
    assert!(!agrees(&of(&[0.0; 13]), 0.0));
}

/// The scales of the relative errors: v0, Z v0/2, v0 L/4c.
#[test]
fn scales_of_the_bar() {
    let scales = Scales::of(&dyka(&[]));
    assert_eq!(scales.velocity, 5.0);
    assert_relative_eq!(scales.stress, 98_950_745.323_115_18, max_relative = 1e-15);
    assert_relative_eq!(scales.displacement, 1.25 * transit(), max_relative = 1e-15);
}

/// The velocity of the one particle at t = 0 (m/s).
const V0: f64 = 1e-7;

/// The one particle at one time.
struct Instant {
    t: f64,
    v: f64,
    u: f64,
}

/// What becomes of one particle at x0 = ½ in one cell of length 1, fixed on the left,
/// E = ρ = 1, c Δt / h = `cfl`.
fn one_particle(cfl: f64) -> Vec<Instant> {
    let one = "title = 'one'\nmethod = 'mpm'\nmass = 'lumped'\n\
        body = { length = 1, density = 1, youngs_modulus = 1, poisson_ratio = 0 }\n\
        grid = { cells = 1, particles_per_cell = 1 }\nbasis.kind = 'linear'\n\
        time = { integrator = 'newmark', cfl = 0.01, end = 20 }\n\
        boundary = { left = 'fixed' }\n\
        initial_velocity = [ { from = 0, to = 1, velocity = 1e-7 } ]\n\
        probe = [ { name = 'v', quantity = 'velocity', position = 0.5 },\n\
                  { name = 'u', quantity = 'displacement', position = 0.5 } ]";
    let history = finished(&scene(one, &[&format!("time.cfl={cfl}")])).history;
    let [t, v, u] = ["t", "v", "u"].map(|name| column(&history, name));
    (0..t.len()).map(|k| Instant { t: t[k], v: v[k], u: u[k] }).collect()
}

/// One particle in one cell: with V_p constant the equations give v = v0 cos ωt
/// and x = x0 exp(v0/(Lω) sin ωt), ω² = E/(ρL²) = 1. (The density update
/// changes V_p by a relative v0/(Lω), here 1e-7.)
///
/// The velocity is of second order: its phase runs ahead by (ωΔt)²/24 · ωt, so
/// its error is that times sin ωt, largest at the end, t = 20; within 2% for
/// c Δt / h = 0.04, 0.02 and 0.01.
#[test]
fn one_particle_in_one_cell() {
    for cfl in [0.04, 0.02, 0.01] {
        let off = |at: &Instant| (at.v - V0 * at.t.cos()) / V0;
        let worst = largest(one_particle(cfl).iter().map(off));
        let expected = cfl * cfl / 24.0 * 20.0 * f64::sin(20.0);
        assert_relative_eq!(worst, expected, max_relative = 0.02);
    }
}

/// The displacement of the Algorithm is of first order here. The next time step
/// maps v_p = Σ_I N a_I Δt anew, while (27) has moved the particle with a_I
/// itself: an excess of Δt² Σ_I N_I (a_I − ā_I) per step, ā_I the particles'
/// acceleration mapped back. With one particle and a fixed left node that is
/// Δt² (1 − N) a_p, and sums up to Δt (1 − N)(v − v0). What that leaves is of second order,
/// for c Δt / h = 0.04, 0.02 and 0.01.
#[test]
fn one_particle_shows_the_remapping_term() {
    let (x0, n) = (0.5, 0.5);
    for cfl in [0.04, 0.02, 0.01] {
        let instants = one_particle(cfl);
        let off = |at: &Instant| (at.u - x0 * (V0 * at.t.sin()).exp_m1()) / (x0 * V0);
        let excess = |at: &Instant| cfl * (1.0 - n) * (at.v - V0) / (x0 * V0);
        let bare = largest(instants.iter().map(off));
        let explained = largest(instants.iter().map(|at| off(at) - excess(at)));
        assert_relative_eq!(bare, 2.0 * cfl, max_relative = cfl);
        assert!(explained < 1.1 * cfl * cfl, "cfl {cfl}: {explained:e}");
    }
}

/// The bar against its exact solution, on 40 and on 160 cells: velocity and stress within
/// 2% of the figures of data/reference/bar.py, the displacement field of its own; the
/// energy, which the scheme does not keep exactly, within half a percent.
#[test]
fn dyka_errors() {
    for (cells, expected) in [
        (40, Each { v: 0.1643, sigma: 0.2649, u: 0.02781 }),
        (160, Each { v: 0.1131, sigma: 0.1836, u: 0.007165 }),
    ] {
        let scene = dyka(&[&format!("grid.cells={cells}")]);
        let outcome = finished(&scene);
        let Each { v, sigma, u } = bar_errors(&scene, &outcome);
        assert_relative_eq!(v, expected.v, max_relative = 0.02);
        assert_relative_eq!(sigma, expected.sigma, max_relative = 0.02);
        assert_relative_eq!(u, expected.u, max_relative = 0.02);
        assert!(value(&scene, &outcome, "energy_drift_largest") < 5e-3);
    }
}
