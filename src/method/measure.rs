//! Measures a run (§6): the error (39), energy and momentum.

use crate::method::continuum::law::{Elastic, volume_change};
use crate::method::continuum::state::{Carriers, Particles};
use nalgebra::{SMatrix, SVector, Vector3};

// ANCHOR: rms
/// (39), with the square that the paper's print lacks, is the root of the mean square:
/// RMS = √(1/N Σ (φ − φ̂)²), in the unit of φ; 0 for no pairs.
///
/// Test: `rms_has_its_square` in `tests/analytical.rs`.
pub fn rms(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0);
    for (phi, phi_hat) in pairs {
        sum += (phi - phi_hat) * (phi - phi_hat);
        n += 1.0;
    }
    if n == 0.0 { 0.0 } else { libm::sqrt(sum / n) }
}
// ANCHOR_END: rms

// ANCHOR: observed_order
/// An order of convergence is observed as a slope with an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The exponent of error ∝ h^slope.
    pub slope: f64,
    /// Half the width of its 95% interval.
    pub half_width: f64,
}

impl std::fmt::Display for Order {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.slope + self.half_width).is_finite() {
            true => write!(f, "{:.4} ± {:.4}", self.slope, self.half_width),
            false => write!(f, "none"),
        }
    }
}

/// Fits the line through (ln h, ln error) by least squares; its slope with the 95%
/// interval of Student's t for n − 2 degrees of freedom. 3 to 12 points, all
/// above 0.
pub fn observed_order(h: &[f64], error: &[f64]) -> Order {
    /// These are t of 97.5% for 1, 2, … degrees of freedom.
    const STUDENT: [f64; 10] =
        [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];
    let n = h.len() as f64;
    let (x, y): (Vec<f64>, Vec<f64>) =
        h.iter().zip(error).map(|(h, e)| (libm::log(*h), libm::log(*e))).unzip();
    let (mean_x, mean_y) = (x.iter().sum::<f64>() / n, y.iter().sum::<f64>() / n);
    let cross: f64 = x.iter().zip(&y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let square: f64 = x.iter().map(|x| (x - mean_x) * (x - mean_x)).sum();
    let slope = cross / square;
    let rest = |(x, y): (&f64, &f64)| {
        let off = y - mean_y - slope * (x - mean_x);
        off * off
    };
    let residual: f64 = x.iter().zip(&y).map(rest).sum();
    let freedom = h.len().saturating_sub(2);
    let t = STUDENT.get(freedom.wrapping_sub(1)).copied().unwrap_or(f64::NAN);
    let half_width = t * libm::sqrt(residual / (freedom as f64 * square));
    Order { slope, half_width }
}
// ANCHOR_END: observed_order

// ANCHOR: energy
/// Gives the strain energy of particle p (J): ½ σ_p : D⁻¹ : σ_p m_p / ρ_p with the rate law,
/// else W(F_p) m_p / (ρ_p J_p), where ρ_p J_p is the density at t = 0.
pub fn strain_energy_of<const D: usize>(particle: &Particles<D>, law: &Elastic, p: usize) -> f64 {
    let volume = particle.m[p] / particle.rho[p];
    match particle.F.get(p) {
        None => law.energy_density(&particle.sigma[p]) * volume,
        Some(F_p) => {
            let J = 1.0 + volume_change(&(F_p - SMatrix::identity()));
            law.energy_of(F_p) * (volume / J)
        }
    }
}

/// Sums ½ m |v|² (J) over particles, or over the nodes of OTM.
pub fn kinetic_energy<const D: usize>(Carriers { m, v, .. }: &Carriers<D>) -> f64 {
    total(m.len(), 0.0, |n| 0.5 * m[n] * v[n].dot(&v[n]))
}

/// Sums the strain energy over all particles (J).
pub fn strain_energy<const D: usize>(particle: &Particles<D>, law: &Elastic) -> f64 {
    total(particle.len(), 0.0, |p| strain_energy_of(particle, law, p))
}
// ANCHOR_END: energy

/// Finds the particle with the most kinetic and strain energy.
pub fn most_energetic<const D: usize>(particle: &Particles<D>, law: &Elastic) -> usize {
    let energy = |p: usize| {
        let v: SVector<f64, D> = particle.v[p];
        0.5 * particle.m[p] * v.dot(&v) + strain_energy_of(particle, law, p)
    };
    (0..particle.len()).max_by(|a, b| energy(*a).total_cmp(&energy(*b))).unwrap_or(0)
}

/// Sums m (x_i v_j − x_j v_i) about the body's lower corner (kg m²/s): one
/// number in 2D, three in 3D (for x, y, z), none in 1D.
pub fn angular_momentum<const D: usize>(Carriers { m, x, v }: &Carriers<D>) -> Vec<f64> {
    let in_plane = |n: usize, i: usize, j: usize| m[n] * (x[n][i] * v[n][j] - x[n][j] * v[n][i]);
    match D {
        1 => Vec::new(),
        2 => vec![total(m.len(), 0.0, |n| in_plane(n, 0, 1))],
        _ => {
            let about = |n| Vector3::new(in_plane(n, 1, 2), in_plane(n, 2, 0), in_plane(n, 0, 1));
            total(m.len(), Vector3::zeros(), about).as_slice().to_vec()
        }
    }
}

/// Sums m |x − x_c| |v − v_c| about the centre of mass x_c with its velocity v_c (kg m²/s), the
/// most that the angular momentum could be by these places and speeds; at least a billionth of
/// the sum with |v| itself, below which round-off is.
pub fn turning<const D: usize>(carriers: &Carriers<D>) -> f64 {
    let Carriers { m, x, v } = carriers;
    let mass = total(m.len(), 0.0, |n| m[n]);
    let centre = total(m.len(), SVector::zeros(), |n| x[n] * m[n]) / mass;
    let mean = momentum(carriers) / mass;
    let size = |r: SVector<f64, D>| libm::sqrt(r.dot(&r));
    let own = total(m.len(), 0.0, |n| m[n] * size(x[n] - centre) * size(v[n] - mean));
    let whole = total(m.len(), 0.0, |n| m[n] * size(x[n] - centre) * size(v[n]));
    own.max(1e-9 * whole)
}

/// Finds the particle that has turned most, and by which angle (rad); `None` where that is not
/// kept.
pub fn largest_rotation<const D: usize>(particle: &Particles<D>) -> Option<(usize, f64)> {
    let planes = particle.turned.chunks(Particles::<D>::PLANES.max(1));
    let square = |angles: &[f64]| angles.iter().map(|angle| angle * angle).sum::<f64>();
    let (p, square) = planes.map(square).enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some((p, libm::sqrt(square)))
}

/// Sums m v (kg m/s).
pub fn momentum<const D: usize>(Carriers { m, v, .. }: &Carriers<D>) -> SVector<f64, D> {
    total(m.len(), SVector::zeros(), |n| v[n] * m[n])
}

/// Adds `count` terms to 0 in eight parts, one after the other, so that an addition need not
/// wait for the one before: a history is recorded faster, and its sums have one fixed order.
fn total<T: Copy + std::ops::Add<Output = T>>(
    count: usize,
    zero: T,
    term: impl Fn(usize) -> T,
) -> T {
    let mut parts = [zero; 8];
    let whole = count - count % 8;
    for n in (0..whole).step_by(8) {
        for i in 0..8 {
            parts[i] = parts[i] + term(n + i);
        }
    }
    for n in whole..count {
        parts[0] = parts[0] + term(n);
    }
    parts.into_iter().fold(zero, |sum, part| sum + part)
}
