//! Solves the elastic bar by Riemann invariants, Appendix A, (40)-(59).
//!
//! The bar is a system of two transport equations. Its invariants R^I and
//! R^II keep their value along x − ct and x + ct, and turn into each other at
//! the ends. So the state at (x, t) is found by following both characteristics
//! back to t = 0.

use super::fields::Fields;
use nalgebra::{Matrix2, Vector2};

/// An end of the bar turns waves back in one of two ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// v = 0: by (59) R^I = −R^II.
    Fixed,
    /// σ = 0: by (59) R^I = R^II.
    Free,
}

/// There are two invariants, one for each direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// R^I of (57), travels at +c.
    I,
    /// R^II of (58), travels at −c.
    II,
}

/// A patch is a stretch of the bar that is thrown with one velocity; the rest is at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// (m).
    pub from: f64,
    /// (m).
    pub to: f64,
    /// (m/s).
    pub velocity: f64,
}

/// The bar is elastic, lies on 0 ≤ x ≤ L, and is free of stress at t = 0.
///
/// On a front, where v and σ jump, the value is that of one of the two sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// L (m).
    pub length: f64,
    /// ρ (kg/m³).
    pub density: f64,
    /// E, or λ + 2μ for uniaxial strain (Pa).
    pub modulus: f64,
    /// At x = 0 and at x = L.
    pub ends: [End; 2],
    /// Disjoint.
    pub patches: Vec<Patch>,
}

// ANCHOR: eigen
/// Makes A of (48): with φ = (σ, v) it is ∂φ/∂t + A ∂φ/∂x = 0.
pub fn coupling(E: f64, rho: f64) -> Matrix2<f64> {
    Matrix2::new(0.0, -E, -1.0 / rho, 0.0)
}

/// Makes P of (49), whose columns are the eigenvectors of A, for +c and for −c.
pub fn eigenvectors(Z: f64) -> Matrix2<f64> {
    Matrix2::new(-Z, Z, 1.0, 1.0)
}

/// Makes P⁻¹, with Z = √(Eρ) (Pa s/m).
pub fn eigenvectors_inverse(Z: f64) -> Matrix2<f64> {
    Matrix2::new(-1.0 / Z, 1.0, 1.0 / Z, 1.0) * 0.5
}
// ANCHOR_END: eigen

// ANCHOR: reflect
impl End {
    /// Gives the ratio of the leaving to the arriving invariant, −1 or +1.
    pub fn reflection(self) -> f64 {
        match self {
            End::Fixed => -1.0,
            End::Free => 1.0,
        }
    }
}

impl Family {
    /// Gives the invariant that this one comes from at an end.
    fn other(self) -> Family {
        match self {
            Family::I => Family::II,
            Family::II => Family::I,
        }
    }
}
// ANCHOR_END: reflect

/// A piece is a straight part of a characteristic, followed back in time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    family: Family,
    /// Product of the reflections between (x, t) and here.
    sign: f64,
    /// From here back to there (m).
    from: f64,
    to: f64,
}

impl Bar {
    /// Gives c = √(E/ρ), (46) (m/s).
    pub fn c(&self) -> f64 {
        libm::sqrt(self.modulus / self.density)
    }

    /// Gives the impedance Z = √(Eρ) = ρc (Pa s/m).
    pub fn Z(&self) -> f64 {
        self.density * self.c()
    }

    // ANCHOR: at
    /// Gives v, σ and u at 0 ≤ `x` ≤ L (m) and `t` ≥ 0 (s).
    pub fn at(&self, x: f64, t: f64) -> Fields {
        let (periods, s) = self.travel(t);
        let R = Vector2::new(self.invariant(Family::I, x, s), self.invariant(Family::II, x, s));
        let phi = eigenvectors(self.Z()) * R; // (51), (59)
        let u = self.travelled(Family::I, x, s) + self.travelled(Family::II, x, s);
        // + 0.0 turns a reflected −0 into 0.
        Fields {
            stress: phi[0] + 0.0,
            velocity: phi[1] + 0.0,
            displacement: u / self.c() + periods * self.drift(),
        }
    }
    // ANCHOR_END: at

    // ANCHOR: travel
    /// Splits c t into n periods of 4L and a rest ≥ 0: (n, rest (m)). The rest is below 4L,
    /// or above by no more than the last digits of c t, and is followed as well.
    ///
    /// 4L is a period of every pair of ends. c and the product c t are carried
    /// with twice the digits, so the rest is right to the last bits for any
    /// number of reflections up to [`Bar::latest`].
    fn travel(&self, t: f64) -> (f64, f64) {
        let period = 4.0 * self.length;
        // c = c + c_low: the remainders of the division and of the root.
        let square = self.modulus / self.density;
        let square_low = libm::fma(-square, self.density, self.modulus) / self.density;
        let c = libm::sqrt(square);
        let c_low = (libm::fma(-c, c, square) + square_low) / (2.0 * c);
        // c t = s + s_low.
        let s = c * t;
        let s_low = libm::fma(c, t, -s) + c_low * t;
        // fmod is exact.
        let rest = libm::fmod(s, period);
        let periods = libm::round((s - rest) / period);
        match rest + s_low {
            below if below < 0.0 => (periods - 1.0, below + period),
            rest => (periods, rest),
        }
    }

    /// Gives 2^50 L/c (s). Later, ct in double-double digits no longer resolves a
    /// bar's length to the last digits of a number.
    pub fn latest(&self) -> f64 {
        libm::exp2(50.0) * self.length / self.c()
    }
    // ANCHOR_END: travel

    /// Says what all points have moved by after one period (m): 4L/c times the mean
    /// velocity of a bar with two free ends, else 0.
    fn drift(&self) -> f64 {
        match self.ends {
            [End::Free, End::Free] => {
                4.0 / self.c()
                    * self.patches.iter().map(|a| a.velocity * (a.to - a.from)).sum::<f64>()
            }
            _ => 0.0,
        }
    }

    // ANCHOR: trace_back
    /// Follows the characteristic of `family` through x back by the path `s`
    /// (m) in straight pieces from end to end.
    fn trace_back(&self, mut family: Family, x: f64, s: f64) -> impl Iterator<Item = Piece> {
        let (L, ends) = (self.length, self.ends);
        let (mut at, mut left, mut sign, mut done) = (x, s, 1.0, false);
        std::iter::from_fn(move || {
            if done {
                return None;
            }
            // R^I came from the left, R^II from the right.
            let (to_end, end, wall) = match family {
                Family::I => (at, ends[0], 0.0),
                Family::II => (L - at, ends[1], L),
            };
            // Also for a path that is not a number.
            done = left <= to_end || left.is_nan();
            let to = match family {
                _ if !done => wall,
                Family::I => at - left,
                Family::II => at + left,
            };
            let piece = Piece { family, sign, from: at, to };
            (at, left) = (to, left - to_end);
            (family, sign) = (family.other(), sign * end.reflection());
            Some(piece)
        })
    }

    /// Gives the invariant of `family` at x, after the path `s`: (56) with the value
    /// at the foot of the characteristic and one sign for each reflection.
    fn invariant(&self, family: Family, x: f64, s: f64) -> f64 {
        self.trace_back(family, x, s)
            .last()
            .map_or(0.0, |foot| foot.sign * self.initial_invariant(foot.family, foot.to))
    }
    // ANCHOR_END: trace_back

    // ANCHOR: initial
    /// Gives R at t = 0, (57) (58) with σ = 0 and v of the patch.
    fn initial_invariant(&self, family: Family, x: f64) -> f64 {
        let R = eigenvectors_inverse(self.Z()) * Vector2::new(0.0, self.initial_velocity(x));
        match family {
            Family::I => R[0],
            Family::II => R[1],
        }
    }

    /// Gives v at t = 0 (m/s).
    fn initial_velocity(&self, x: f64) -> f64 {
        let covers = |a: &&Patch| a.from <= x && (x < a.to || (x == a.to && x == self.length));
        self.patches.iter().find(covers).map_or(0.0, |a| a.velocity)
    }
    // ANCHOR_END: initial

    // ANCHOR: displacement
    /// Integrates R over the past, times c (m²/s): u = ∫ v dt = ∫ R^I dt + ∫ R^II dt,
    /// and along a characteristic dt is ds / c.
    fn travelled(&self, family: Family, x: f64, s: f64) -> f64 {
        let mut sum = 0.0;
        for piece in self.trace_back(family, x, s) {
            let (low, high) = (piece.from.min(piece.to), piece.from.max(piece.to));
            for a in &self.patches {
                let overlap = (high.min(a.to) - low.max(a.from)).max(0.0);
                sum += piece.sign * 0.5 * a.velocity * overlap;
            }
        }
        sum
    }
    // ANCHOR_END: displacement

    // ANCHOR: fronts
    /// Lists the places where v and σ jump at time `t`, in ascending order (m).
    ///
    /// Each jump of the initial velocity sends one front each way. A fixed end
    /// whose material was thrown is such a jump too.
    pub fn fronts(&self, t: f64) -> Vec<f64> {
        let (_, s) = self.travel(t);
        let L = self.length;
        let value = |x: f64| self.initial_velocity(x);
        let before = |x: f64| {
            let covers = |a: &&Patch| a.from < x && x <= a.to;
            self.patches.iter().find(covers).map_or(0.0, |a| a.velocity)
        };
        let mut sources: Vec<f64> = self.patches.iter().flat_map(|a| [a.from, a.to]).collect();
        sources.retain(|&x| x > 0.0 && x < L && before(x) != value(x));
        if self.ends[0] == End::Fixed && value(0.0) != 0.0 {
            sources.push(0.0);
        }
        if self.ends[1] == End::Fixed && value(L) != 0.0 {
            sources.push(L);
        }
        // The mirror images of the bar have the period 2L.
        let fold = |x: f64| {
            let x = libm::fabs(libm::fmod(x, 2.0 * L));
            if x > L { 2.0 * L - x } else { x }
        };
        let mut fronts: Vec<f64> =
            sources.iter().flat_map(|x| [fold(x + s), fold(x - s)]).collect();
        fronts.sort_by(f64::total_cmp);
        // Two ways to one front may differ in the last digits.
        fronts.dedup_by(|next, front| *next - *front <= 1e-14 * L);
        fronts
    }
    // ANCHOR_END: fronts
}
