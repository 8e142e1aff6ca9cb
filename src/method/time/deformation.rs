//! What a time step does to the material where more is wanted than the printed strain: the
//! gradient of the map that moves the particles, and with it density and stress at finite strain.

use crate::method::breakdown::Breakdown;
use crate::method::choice::Law;
use crate::method::continuum::law::{self, Elastic};
use crate::method::continuum::shape::Shape;
use crate::method::continuum::state::{Nodes, Particles};
use crate::method::continuum::sums;

// ANCHOR: deformation
/// Takes G_p = Δt Σ_I (v_I + ½ Δt a_I) ⊗ ∇N_Ip (–), the gradient of the displacement by which
/// the predictor (27) is about to move the particles.
pub fn gradient_of_predictor<const D: usize>(
    particle: &mut Particles<D>,
    node: &Nodes<D>,
    shape: &Shape<D>,
    dt: f64,
) {
    for p in 0..particle.len() {
        let grad_v = sums::velocity_gradient(node, shape, p);
        let grad_a = sums::gradient(&node.a, &node.m, shape, p);
        particle.G[p] = (grad_v + grad_a * (0.5 * dt)) * dt;
    }
}

/// Deforms the particles by f = 1 + G_p: ρ_p ← ρ_p / det f. With the rate law σ_p += D : Δε_p,
/// where Δε_p = sym(G (1 + G/2)⁻¹); else F_p ← f F_p, and σ_p is that of F_p.
///
/// Errors: [`Breakdown::Inverted`] when det f ≤ 0; [`Breakdown::NotFinite`].
pub fn deform<const D: usize>(
    particle: &mut Particles<D>,
    material: &Elastic,
) -> Result<(), Breakdown> {
    for p in 0..particle.len() {
        let (f, J) = law::increment(&particle.G[p]);
        let inverted = Breakdown::Inverted { particle: p, strain: J - 1.0 };
        if !J.is_finite() {
            return Err(Breakdown::NotFinite { particle: p, symbol: "strain" });
        }
        if J <= 0.0 {
            return Err(inverted);
        }
        particle.rho[p] /= J;
        match material.law {
            Law::Rate => {
                let G_p = particle.G[p];
                particle.turn(p, &G_p);
                particle.d_eps[p] = law::midpoint_strain(&G_p).ok_or(inverted)?;
                particle.sigma[p] += material.stress_increment(&particle.d_eps[p]);
            }
            Law::NeoHookean | Law::Hencky => {
                particle.F[p] = f * particle.F[p];
                particle.sigma[p] = material.stress_of(&particle.F[p]);
            }
        }
    }
    Ok(())
}
// ANCHOR_END: deformation
