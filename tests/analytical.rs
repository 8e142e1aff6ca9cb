//! Against closed forms: the exact solution itself, and runs that have one.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::exact::riemann::{
    Bar, End, Patch, coupling, eigenvectors, eigenvectors_inverse,
};
use lme_mpm::method::exact::{Exact, Fields};
use lme_mpm::method::measure::{observed_order, rms};
use lme_mpm::output::summary::{Scales, lines};
use lme_mpm::scene::Scene;
use lme_mpm::scene::fault::Fault;
use nalgebra::{Matrix2, Vector2};

const E: f64 = 200e9;
const RHO: f64 = 7833.0;
const L: f64 = 0.1333;

fn dyka_bar() -> Bar {
    Bar {
        length: L,
        density: RHO,
        modulus: E,
        ends: [End::Fixed, End::Free],
        patches: vec![Patch { from: 0.75 * L, to: L, velocity: 5.0 }],
    }
}

/// The bars of data/reference/riemann_bars.csv by name.
fn reference_bar(name: &str) -> Bar {
    let text = include_str!("../data/reference/riemann_bars.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let row = reader.records().map(Result::unwrap).find(|row| &row[0] == name).unwrap();
    let number = |at: usize| row[at].parse().unwrap();
    let end = |at: usize| if &row[at] == "fixed" { End::Fixed } else { End::Free };
    let patch = |text: &str| {
        let part: Vec<f64> = text.split(':').map(|x| x.parse().unwrap()).collect();
        Patch { from: part[0], to: part[1], velocity: part[2] }
    };
    Bar {
        length: number(1),
        density: number(2),
        modulus: number(3),
        ends: [end(4), end(5)],
        patches: row[6].split(';').map(patch).collect(),
    }
}

/// (49) (50): A P = P Λ with Λ = diag(c, −c), and P⁻¹ P = 1.
#[test]
fn riemann_eigenstructure() {
    let (c, Z) = ((E / RHO).sqrt(), (E * RHO).sqrt());
    let (A, P) = (coupling(E, RHO), eigenvectors(Z));
    let Lambda = Matrix2::new(c, 0.0, 0.0, -c);
    let (left, right) = (A * P, P * Lambda);
    for k in 0..4 {
        assert_relative_eq!(left[k], right[k], max_relative = 1e-15);
    }
    let one = eigenvectors_inverse(Z) * P;
    for k in 0..4 {
        assert_relative_eq!(one[k], Matrix2::<f64>::identity()[k], epsilon = 1e-15);
    }
}

/// Bars with values so large that c t cannot be resolved are refused by time.
#[test]
fn riemann_far_times_stay_bounded() {
    let bar = dyka_bar();
    for share in [1.0, 0.7, 1e-3, 1e-9] {
        let fields = bar.at(0.3 * L, share * bar.latest());
        assert!(fields.velocity.abs() <= 5.0 && fields.stress.abs() <= 2e8);
        assert!(fields.displacement.abs() <= 5.0 * L / bar.c());
    }
}

/// (57)-(59): R^I = (v − σ/Z)/2, R^II = (v + σ/Z)/2, v = R^I + R^II,
/// σ = Z (R^II − R^I), with numbers.
#[test]
fn riemann_invariants_of_a_state() {
    let Z = 4.0;
    let R = eigenvectors_inverse(Z) * Vector2::new(8.0, 5.0); // σ = 8, v = 5
    assert_eq!((R[0], R[1]), (1.5, 3.5));
    let phi = eigenvectors(Z) * R;
    assert_eq!((phi[0], phi[1]), (8.0, 5.0));
}

/// The numbers of the Dyka bar that the paper's data give.
#[test]
fn riemann_dyka_constants() {
    let bar = dyka_bar();
    assert_relative_eq!(bar.c(), 5053.019038586247, max_relative = 1e-15);
    assert_relative_eq!(bar.Z(), 39_580_298.129_246_07, max_relative = 1e-15);
    assert_relative_eq!(L / bar.c(), 2.638026870314251e-5, max_relative = 1e-15);
}

/// v, σ and u against d'Alembert by images at 60 digits: four bars, all pairs
/// of ends, up to 2^50 L/c. See data/reference/riemann.py.
#[test]
fn riemann_against_images_at_60_digits() {
    let text = include_str!("../data/reference/riemann.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let (mut count, mut worst) = (0, 0.0_f64);
    for row in reader.records().map(Result::unwrap) {
        let bar = reference_bar(&row[0]);
        let number = |at: usize| row[at].parse::<f64>().unwrap();
        let v0 = bar.patches.iter().fold(0.0, |v0: f64, a| v0.max(a.velocity.abs()));
        let fields = bar.at(number(1), number(2));
        let error =
            |x: f64, at: usize, scale: f64| (x - number(at)).abs() / number(at).abs().max(scale);
        worst = worst
            .max(error(fields.velocity, 3, v0))
            .max(error(fields.stress, 4, bar.Z() * v0))
            .max(error(fields.displacement, 5, v0 * bar.length / bar.c()));
        count += 1;
    }
    assert_eq!(count, 384);
    assert!(worst < 1e-13, "largest relative error {worst:e}");
}

/// v(L) = +5 for ct/L in (0, ¼), −5 in (7/4, 9/4), +5 in (15/4, 4), else 0:
/// the paper's Fig. 5; and the stress at 3L/4, Fig. 6.
#[test]
fn riemann_dyka_histories() {
    let bar = dyka_bar();
    let plateau = bar.Z() * 5.0 / 2.0;
    for k in 0..400 {
        let tau = (k as f64 + 0.5) / 100.0;
        let expected = match tau {
            tau if !(0.25..3.75).contains(&tau) => 5.0,
            tau if tau > 1.75 && tau < 2.25 => -5.0,
            _ => 0.0,
        };
        let end = bar.at(L, tau * transit());
        assert_eq!(end.velocity, expected, "ct/L = {tau}");
        assert_eq!(end.stress, 0.0, "the free end, ct/L = {tau}");
        // The tension that the patch sends left comes back from the fixed end
        // as tension, after 1.5 L; the other wave the free end turns round.
        let sign = match tau {
            tau if tau < 0.5 || (tau > 1.5 && tau < 2.0) => 1.0,
            tau if (tau > 2.0 && tau < 2.5) || tau > 3.5 => -1.0,
            _ => 0.0,
        };
        let quarter = bar.at(0.75 * L, tau * transit()).stress;
        assert_relative_eq!(quarter, sign * plateau, epsilon = 1e-6);
    }
    // The wall sees both invariants: twice the plateau, Z v0.
    assert_relative_eq!(bar.at(0.0, 0.9 * transit()).stress, 2.0 * plateau, max_relative = 1e-15);
}

/// Between fronts the fields are constant, so ∫ ½ρv² + σ²/2E dx is a finite
/// sum; it must not change in time, whatever the ends.
#[test]
fn riemann_energy_is_conserved() {
    for name in ["dyka", "fixed-fixed", "free-free", "free-fixed"] {
        let bar = reference_bar(name);
        let energy = |t: f64| {
            let mut edges = vec![0.0];
            edges.extend(bar.fronts(t));
            edges.push(bar.length);
            let piece = |pair: &[f64]| {
                let at = bar.at(0.5 * (pair[0] + pair[1]), t);
                let density = 0.5 * bar.density * at.velocity * at.velocity
                    + 0.5 * at.stress * at.stress / bar.modulus;
                density * (pair[1] - pair[0])
            };
            edges.windows(2).map(piece).sum::<f64>()
        };
        let start = 0.5
            * bar.density
            * bar.patches.iter().map(|a| a.velocity.powi(2) * (a.to - a.from)).sum::<f64>();
        for k in 0..1000 {
            let t = k as f64 * 0.00973 * bar.length / bar.c();
            assert_relative_eq!(energy(t), start, max_relative = 1e-12);
        }
    }
}

/// d/dt ∫ ρv dx = σ(L) − σ(0). In the Dyka bar both stresses change only at
/// multiples of L/4c, so the impulse is a finite sum.
#[test]
fn riemann_momentum_follows_the_wall() {
    let bar = dyka_bar();
    let quarter = 0.25 * transit();
    let momentum = |t: f64| {
        let mut edges = vec![0.0];
        edges.extend(bar.fronts(t));
        edges.push(L);
        let piece = |pair: &[f64]| {
            bar.density * bar.at(0.5 * (pair[0] + pair[1]), t).velocity * (pair[1] - pair[0])
        };
        edges.windows(2).map(piece).sum::<f64>()
    };
    let scale = RHO * 5.0 * L;
    for k in 0..64 {
        let (now, next) = ((k as f64 + 0.5) * quarter, (k as f64 + 1.5) * quarter);
        let wall = |t: f64| bar.at(0.0, t).stress;
        let impulse = -0.5 * quarter * (wall(now) + wall(next));
        assert_relative_eq!(momentum(next) - momentum(now), impulse, epsilon = 1e-12 * scale);
    }
}

/// (39) with the square: the mean of 3² and 4² is 12.5.
#[test]
fn rms_has_its_square() {
    assert_relative_eq!(rms([(3.0, 0.0), (1.0, 5.0)]), 12.5_f64.sqrt(), max_relative = 1e-15);
    // Errors of opposite sign do not cancel, as they would without it.
    assert_eq!(rms([(1.0, 0.0), (-1.0, 0.0)]), 1.0);
    assert_eq!(rms([]), 0.0);
}

/// Fronts are where v and σ jump, and only there: every pair of ends, patches that touch
/// the ends or each other, at times with and without reflections behind them.
#[test]
fn riemann_fronts_are_the_jumps() {
    let patches = [(0.0, 0.2, 3.0), (0.2, 0.35, 3.0), (0.35, 0.5, -1.0), (0.8, 1.0, 2.0)]
        .map(|(from, to, velocity)| Patch { from, to, velocity })
        .to_vec();
    let (mut fronts, mut kept) = (0, 0);
    for ends in [End::Fixed, End::Free].iter().flat_map(|a| [[*a, End::Fixed], [*a, End::Free]]) {
        // All patches, and none at the ends.
        for patches in [patches.clone(), patches[1..3].to_vec()] {
            let bar = Bar { length: 1.0, density: 1.0, modulus: 1.0, ends, patches };
            let differ = |a: f64, b: f64| {
                let (a, b) = (bar.at(a, 0.0), bar.at(b, 0.0));
                (a.velocity - b.velocity).abs() + (a.stress - b.stress).abs() > 0.1
            };
            assert!(!differ(0.21, 0.22) && differ(0.34, 0.36));
            for t in [0.013, 0.07, 0.31, 0.77, 1.43, 2.9, 17.21] {
                let at = |x: f64| (bar.at(x, t).velocity, bar.at(x, t).stress);
                let jumps = |a: f64, b: f64| {
                    let (a, b) = (at(a), at(b));
                    (a.0 - b.0).abs() + (a.1 - b.1).abs() > 0.1
                };
                let found = bar.fronts(t);
                assert!(found.windows(2).all(|pair| pair[1] - pair[0] > 1e-9), "{found:?}");
                // In a unit 2^30 times as long every number is the same.
                let long = 2.0_f64.powi(30);
                let mut scaled = Bar { length: long, ..bar.clone() };
                for patch in &mut scaled.patches {
                    (patch.from, patch.to) = (patch.from * long, patch.to * long);
                }
                let expected: Vec<f64> = found.iter().map(|x| x * long).collect();
                assert_eq!(scaled.fronts(t * long), expected);
                for x in &found {
                    assert!(jumps(x - 1e-9, x + 1e-9), "{ends:?}, t = {t}: no jump at {x}");
                    fronts += 1;
                }
                // Between two fronts nothing changes.
                let edges = [&[0.0][..], &found, &[1.0]].concat();
                for pair in edges.windows(2).filter(|pair| pair[1] - pair[0] > 1e-8) {
                    let inside = |s: f64| pair[0] + s * (pair[1] - pair[0]);
                    for n in 1..20 {
                        assert!(!jumps(inside(1e-3), inside(0.05 * n as f64)), "{ends:?}, {t}");
                        kept += 1;
                    }
                }
            }
        }
    }
    assert!(fronts > 200 && kept > 4000, "{fronts}, {kept}");
}

/// Two fronts that meet are one, also where their places differ in the last digits, on a
/// bar of any length.
#[test]
fn riemann_fronts_that_meet_are_one() {
    let mut unlike = 0;
    for length in [1e-6, 1.0, 1e6] {
        for n in 1..100 {
            let (from, to) = (0.1 * length, (0.2 + 0.007 * n as f64) * length);
            let patches = vec![Patch { from, to, velocity: 1.0 }];
            let ends = [End::Free, End::Free];
            let bar = Bar { length, density: 1.0, modulus: 1.0, ends, patches };
            // c = 1: one from each edge, where they meet, and one on each side.
            let t = 0.5 * (to - from);
            assert_eq!(bar.fronts(t).len(), 3, "{length}: {:?}", bar.fronts(t));
            unlike += usize::from(from + t != to - t);
        }
    }
    assert!(unlike > 30, "{unlike}");
}

/// A free bar that is thrown as a whole flies on: v = V, σ = 0, u = V t at any time, also
/// where the digits of ct that a number does not hold reach into another period.
#[test]
fn riemann_free_flight_to_the_latest_time() {
    let ends = [End::Free, End::Free];
    let bars = [(2.5, 7e6), (0.7, 5e6), (1.1, 3e6), (2.5, 2e6)].into_iter().cycle();
    for (n, (length, modulus)) in (1..8000).zip(bars) {
        let patches = vec![Patch { from: 0.0, to: length, velocity: 3.0 }];
        let bar = Bar { length, density: 1000.0, modulus, ends, patches };
        let t = bar.latest() * n as f64 / 8000.3;
        let fields = bar.at(length * (n % 7) as f64 / 6.0, t);
        assert_eq!((fields.velocity, fields.stress), (3.0, 0.0), "t = {t:e}");
        assert_relative_eq!(fields.displacement, 3.0 * t, max_relative = 4e-15);
    }
}

/// A zero that comes from two parts is +0, so that no file has a −0.
#[test]
fn riemann_zeros_have_no_sign() {
    let bar = dyka_bar();
    let mut zeros = 0;
    for n in 0..400 {
        for x in [0.0, 0.02, 0.1, L] {
            let Fields { velocity, stress, displacement } = bar.at(x, n as f64 * 1e-6);
            for value in [velocity, stress, displacement].into_iter().filter(|x| *x == 0.0) {
                assert!(value.is_sign_positive(), "{x}, {n}");
                zeros += 1;
            }
        }
    }
    assert!(zeros > 1000, "{zeros}");
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
    assert!(four.contains(1.6) && four.contains(2.2) && four.contains(1.0));
    assert!(!four.contains(2.21) && !four.contains(0.99));
    assert_eq!(four.to_string(), "1.6000 ± 0.6085");
    // Beyond the table of Student's t there is no interval, and it contains nothing.
    assert!(!of(&[0.0; 13]).contains(0.0));
}

/// How long a solution can be trusted, and for which scenes there is none.
#[test]
fn exact_says_until_when() {
    let latest = |scene: &Scene| lme_mpm::setup::exact(scene).unwrap().latest();
    let transit = transit();
    for (scene, expected) in [
        (dyka(&[]), 2.0_f64.powi(50) * transit),
        (dyka(&["traction.right=1"]), 1e4 * transit),
        (dyka(&["body_force.acceleration=1"]), 1e4 * transit),
        (dyka(&["initial_velocity=[]", "vibration={ mode = 1, velocity = 1 }"]), 1e4 * transit),
    ] {
        assert_relative_eq!(latest(&scene), expected, max_relative = 1e-14);
    }
    // The first mode between a fixed and a free end: k = π / 2L.
    let moving = scene(MANUFACTURED, &[]);
    let Ok(Exact::Manufactured(solution)) = lme_mpm::setup::exact(&moving) else {
        panic!("{moving:?}")
    };
    let expected = 1e4 / (solution.c * solution.mode.k);
    assert_relative_eq!(latest(&moving), expected, max_relative = 1e-14);
    let error = lme_mpm::setup::exact(&scene(DISCS, &[])).unwrap_err();
    assert!(matches!(error, Fault::NoExact { .. }), "{error}");
}

/// (t, v, u) of one particle at x0 = ½ in one cell of length 1, fixed on the
/// left, E = ρ = 1, v0 = 1e-7, c Δt / h = `cfl`.
fn one_particle(cfl: f64) -> Vec<(f64, f64, f64)> {
    let one = "title = 'one'\nmethod = 'mpm'\nmass = 'lumped'\n\
        body = { length = 1, density = 1, youngs_modulus = 1, poisson_ratio = 0 }\n\
        grid = { cells = 1, particles_per_cell = 1 }\nbasis.kind = 'linear'\n\
        time = { integrator = 'newmark', cfl = 0.01, end = 20 }\n\
        boundary = { left = 'fixed' }\n\
        initial_velocity = [ { from = 0, to = 1, velocity = 1e-7 } ]\n\
        probe = [ { name = 'v', quantity = 'velocity', position = 0.5 },\n\
                  { name = 'u', quantity = 'displacement', position = 0.5 } ]";
    let outcome = finished(&scene(one, &[&format!("time.cfl={cfl}")]));
    let column = |name: &str| outcome.history.column(name).unwrap();
    let (v, u) = (column("v"), column("u"));
    column("t").into_iter().zip(v).zip(u).map(|((t, v), u)| (t, v, u)).collect()
}

const V0: f64 = 1e-7;

/// One particle in one cell: with V_p constant the equations give v = v0 cos ωt
/// and x = x0 exp(v0/(Lω) sin ωt), ω² = E/(ρL²) = 1. (The density update
/// changes V_p by a relative v0/(Lω), here 1e-7.)
///
/// The velocity is of second order: its phase runs ahead by (ωΔt)²/24 · ωt, so
/// its error is that times sin ωt, largest at the end, t = 20.
#[test]
fn one_particle_in_one_cell() {
    for cfl in [0.04, 0.02, 0.01] {
        let worst = one_particle(cfl)
            .into_iter()
            .map(|(t, v, _)| (v - V0 * t.cos()).abs() / V0)
            .fold(0.0, f64::max);
        let expected = cfl * cfl / 24.0 * 20.0 * f64::sin(20.0);
        assert_relative_eq!(worst, expected, max_relative = 0.02);
    }
}

/// The displacement of the Algorithm is of first order here. The next time step
/// maps v_p = Σ_I N a_I Δt anew, while (27) has moved the particle with a_I
/// itself: an excess of Δt² Σ_I N_I (a_I − ā_I) per step, ā_I the particles'
/// acceleration mapped back. With one particle and a fixed left node that is
/// Δt² (1 − N) a_p, and sums up to Δt (1 − N)(v − v0).
#[test]
fn one_particle_shows_the_remapping_term() {
    let (x0, n) = (0.5, 0.5);
    for cfl in [0.04, 0.02, 0.01] {
        let (mut bare, mut explained) = (0.0_f64, 0.0_f64);
        for (t, v, u) in one_particle(cfl) {
            let closed_form = x0 * (V0 * t.sin()).exp_m1();
            let excess = cfl * (1.0 - n) * (v - V0);
            bare = bare.max((u - closed_form).abs() / (x0 * V0));
            explained = explained.max((u - closed_form - excess).abs() / (x0 * V0));
        }
        assert_relative_eq!(bare, 2.0 * cfl, max_relative = cfl);
        assert!(explained < 1.1 * cfl * cfl, "cfl {cfl}: {explained:e}");
    }
}

/// The bar against its exact solution: velocity and stress within 2% of the
/// figures of data/reference/bar.py, the displacement field of its own; the
/// energy, which the scheme does not keep exactly, within half a percent.
#[test]
fn dyka_errors() {
    for (cells, rv, rs, ru) in [(40, 0.1643, 0.2649, 0.02781), (160, 0.1131, 0.1836, 0.007165)] {
        let scene = dyka(&[&format!("grid.cells={cells}")]);
        let outcome = finished(&scene);
        let lines = lines(&scene, &outcome, 0.0);
        let value = |name: &str| lines.iter().find(|line| line.quantity == name).unwrap().value;
        assert_relative_eq!(value("velocity_end_rms_relative"), rv, max_relative = 0.02);
        assert_relative_eq!(value("stress_three_quarter_rms_relative"), rs, max_relative = 0.02);
        assert_relative_eq!(value("displacement_field_rms_relative"), ru, max_relative = 0.02);
        assert!(value("energy_drift_largest") < 5e-3);
    }
}

/// The scales of the relative errors: v0, Z v0/2, v0 L/4c.
#[test]
fn scales_of_the_bar() {
    let scales = Scales::of(&dyka(&[]));
    assert_eq!(scales.velocity, 5.0);
    assert_relative_eq!(scales.stress, 98_950_745.323_115_18, max_relative = 1e-15);
    assert_relative_eq!(scales.displacement, 1.25 * transit(), max_relative = 1e-15);
}
