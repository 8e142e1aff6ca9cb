//! The exact bar by Riemann invariants, Appendix A, against closed forms and 60 digits.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::exact::Fields;
use lme_mpm::method::exact::riemann::{
    Bar, End, Patch, coupling, eigenvectors, eigenvectors_inverse,
};
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
    let rows = rows(include_str!("../data/reference/riemann_bars.csv"));
    let row = rows.iter().find(|row| row.text("bar") == name).unwrap();
    let patch = |text: &str| {
        let part: Vec<f64> = text.split(':').map(|x| x.parse().unwrap()).collect();
        Patch { from: part[0], to: part[1], velocity: part[2] }
    };
    Bar {
        length: row.number("length"),
        density: row.number("density"),
        modulus: row.number("modulus"),
        ends: row.ends(),
        patches: row.text("patches").split(';').map(patch).collect(),
    }
}

/// (49) (50): A P = P Λ with Λ = diag(c, −c), and P⁻¹ P = 1, to the last digits.
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

/// v, σ and u meet d'Alembert by images at 60 digits to 1e-13: four bars, all pairs
/// of ends, 384 places up to 2^50 L/c. See data/reference/riemann.py.
#[test]
fn riemann_against_images_at_60_digits() {
    let rows = rows(include_str!("../data/reference/riemann.csv"));
    assert_eq!(rows.len(), 384);
    for row in &rows {
        let bar = reference_bar(row.text("bar"));
        let (x, t) = (row.number("x"), row.number("t"));
        let v0 = largest(bar.patches.iter().map(|patch| patch.velocity));
        let fields = bar.at(x, t);
        for (name, here, scale) in [
            ("velocity", fields.velocity, v0),
            ("stress", fields.stress, bar.Z() * v0),
            ("displacement", fields.displacement, v0 * bar.length / bar.c()),
        ] {
            let there = row.number(name);
            let off = (here - there).abs() / there.abs().max(scale);
            assert!(off < 1e-13, "{}, x = {x}, t = {t}: {name} off by {off:e}", row.text("bar"));
        }
    }
}

/// Up to the latest time the fields stay within what the patch brings: the velocity below
/// that of the patch, the stress below twice the plateau, the displacement below v0 L/c.
#[test]
fn riemann_far_times_stay_bounded() {
    let bar = dyka_bar();
    for share in [1.0, 0.7, 1e-3, 1e-9] {
        let fields = bar.at(0.3 * L, share * bar.latest());
        assert!(fields.velocity.abs() <= 5.0 && fields.stress.abs() <= 2e8, "{share}");
        assert!(fields.displacement.abs() <= 5.0 * L / bar.c(), "{share}");
    }
}

/// v(L) = +5 for ct/L in (0, ¼), −5 in (7/4, 9/4), +5 in (15/4, 4), else 0: the paper's
/// Fig. 5; and the stress at 3L/4, Fig. 6. Both at 400 times over 4 L/c.
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

/// ∫ `density` dx over the bar at the time `t`, of what is constant between fronts.
fn integral(bar: &Bar, t: f64, density: impl Fn(Fields) -> f64) -> f64 {
    let mut edges = vec![0.0];
    edges.extend(bar.fronts(t));
    edges.push(bar.length);
    let piece = |pair: &[f64]| density(bar.at(0.5 * (pair[0] + pair[1]), t)) * (pair[1] - pair[0]);
    edges.windows(2).map(piece).sum()
}

/// The energy stays to 1e-12, whatever the ends, at 1000 times over 10 L/c. Between fronts
/// the fields are constant, so ∫ ½ρv² + σ²/2E dx is a finite sum.
#[test]
fn riemann_energy_is_conserved() {
    for name in ["dyka", "fixed-fixed", "free-free", "free-fixed"] {
        let bar = reference_bar(name);
        let energy = |t: f64| {
            integral(&bar, t, |at| {
                0.5 * bar.density * at.velocity * at.velocity
                    + 0.5 * at.stress * at.stress / bar.modulus
            })
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

/// d/dt ∫ ρv dx = σ(L) − σ(0), to 1e-12 over 64 quarters of L/c. In the Dyka bar both
/// stresses change only at multiples of L/4c, so the impulse is a finite sum.
#[test]
fn riemann_momentum_follows_the_wall() {
    let bar = dyka_bar();
    let quarter = 0.25 * transit();
    let momentum = |t: f64| integral(&bar, t, |at| bar.density * at.velocity);
    let scale = RHO * 5.0 * L;
    for k in 0..64 {
        let (now, next) = ((k as f64 + 0.5) * quarter, (k as f64 + 1.5) * quarter);
        let wall = |t: f64| bar.at(0.0, t).stress;
        let impulse = -0.5 * quarter * (wall(now) + wall(next));
        assert_relative_eq!(momentum(next) - momentum(now), impulse, epsilon = 1e-12 * scale);
    }
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

/// Two fronts that meet are one, also where their places differ in the last digits, as in
/// a tenth of the cases they do, on bars of 1e-6, 1 and 1e6 m.
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

/// A zero that comes from two parts is +0, so that no file has a −0: four places of the
/// bar at 400 times.
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
