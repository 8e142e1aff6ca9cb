//! A scene may have loads: a body force (10), and a traction on a layer of particles (11).

use super::state::Particles;
use crate::method::exact::Moved;
use crate::method::exact::forced::ramp;
use nalgebra::SVector;

/// Loads act on the particles from outside; a scene without loads has none of this.
#[derive(Clone, Debug, PartialEq)]
pub struct Loads<const D: usize> {
    pub body: Option<BodyForce<D>>,
    pub traction: Option<Traction<D>>,
}

/// A body force is b_p, a force per mass (m/s²).
#[derive(Clone, Debug, PartialEq)]
pub enum BodyForce<const D: usize> {
    /// b min(t/T, 1).
    Uniform { b: SVector<f64, D>, ramp: f64 },
    /// That which keeps a chosen motion going, at the material points X_p (m).
    Moved { solution: Moved<D>, X: Vec<SVector<f64, D>> },
}

/// A traction acts on the particles of the layer behind each loaded side.
#[derive(Clone, Debug, PartialEq)]
pub struct Traction<const D: usize> {
    /// Particle p, and the full force on it (N): m_p h⁻¹ t^s_p of (11) is the
    /// traction times the particle's share of the side at t = 0.
    pub layer: Vec<(usize, SVector<f64, D>)>,
    /// T, the time over which the load grows (s).
    pub ramp: f64,
}

// ANCHOR: loads
impl<const D: usize> BodyForce<D> {
    /// Gives b_p at time `t` (m/s²).
    pub fn at(&self, p: usize, t: f64) -> SVector<f64, D> {
        match self {
            BodyForce::Uniform { b, ramp: T } => b * ramp(t, *T),
            BodyForce::Moved { solution, X } => solution.body_force(&X[p], t),
        }
    }
}

impl<const D: usize> Traction<D> {
    /// Lists the loaded particles with the force on each at time `t` (N).
    pub fn at(&self, t: f64) -> impl Iterator<Item = (usize, SVector<f64, D>)> {
        let share = ramp(t, self.ramp);
        self.layer.iter().map(move |(p, force)| (*p, force * share))
    }
}
// ANCHOR_END: loads

impl<const D: usize> Loads<D> {
    /// Gives Σ_p f_p · Δx_p, the work of the loads over a step from `t` to `t + dt` (J),
    /// with the mean of both ends; `before` holds u_p at `t` (m).
    ///
    /// Taken with what the particles have moved by, not with their velocity: beside a fixed node
    /// the two differ. u_p has its digits where x_p would have lost them.
    pub fn work(
        &self,
        particle: &Particles<D>,
        before: &[SVector<f64, D>],
        t: f64,
        dt: f64,
    ) -> f64 {
        let mut work = 0.0;
        if let Some(body) = &self.body {
            for p in 0..particle.len() {
                let mean = (body.at(p, t) + body.at(p, t + dt)) * 0.5;
                work += mean.dot(&(particle.u[p] - before[p])) * particle.m[p];
            }
        }
        if let Some(traction) = &self.traction {
            for ((p, force), (_, next)) in traction.at(t).zip(traction.at(t + dt)) {
                work += ((force + next) * 0.5).dot(&(particle.u[p] - before[p]));
            }
        }
        work
    }
}
