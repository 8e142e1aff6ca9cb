//! The operator whose largest eigenvalue is 4 over the square of the limit.

use crate::method::choice::Mass;
use crate::method::continuum::law::{Elastic, symmetric_part};
use crate::method::continuum::sums;
use crate::method::model::{Model, State};
use crate::method::time;
use crate::method::time::scheme::TripFactor;
use nalgebra::{SMatrix, SVector};

/// This is the operator Ĝᵀ g(A) M⁻¹ Ĝ on the stresses of the particles, with
/// Ĝ = G √V D^½. It is symmetric and has the eigenvalues of M⁻¹ K g(A).
pub struct Operator<'a, const D: usize> {
    pub state: &'a mut State<D>,
    model: &'a Model<D>,
    factor: TripFactor,
    chebyshev: Vec<f64>,
    /// Which particles see a node without mass: they stand on the last node to the last bit.
    /// Such a node moves with another and strains nothing, though the stress pulls at it;
    /// with these particles the operator would not be symmetric, and they are left out.
    out: Vec<bool>,
    /// Passes over all particles so far.
    pub applications: u64,
}

/// A stress at each particle, times D^−½ √V: half its square is the strain energy (√J).
pub type Stress<const D: usize> = Vec<SMatrix<f64, D, D>>;
type Field<const D: usize> = Vec<SVector<f64, D>>;

/// Gives the eigenvalues 2μ and dλ + 2μ of D (Pa): what the law makes of a small strain
/// without volume, and of volume alone.
fn moduli<const D: usize>(law: &Elastic) -> (f64, f64) {
    (2.0 * law.mu, D as f64 * law.lambda + 2.0 * law.mu)
}

/// Multiplies the parts of a symmetric tensor without trace and with it alone.
fn scaled<const D: usize>(y: &SMatrix<f64, D, D>, shear: f64, bulk: f64) -> SMatrix<f64, D, D> {
    let sphere = SMatrix::<f64, D, D>::identity() * (y.trace() / D as f64);
    sphere * bulk + (y - sphere) * shear
}

impl<'a, const D: usize> Operator<'a, D> {
    /// Makes the operator of a tabulated state with masses.
    pub fn new(state: &'a mut State<D>, model: &'a Model<D>) -> Self {
        let factor = time::scheme::<D>(model.method).factor(model.kinematics);
        let bare = |p: usize| {
            state.shape.has_tiny(p) && state.shape.find(p, |I| state.node.m[I] == 0.0).is_some()
        };
        let out = (0..state.particle.len()).map(bare).collect();
        Operator { state, model, factor, chebyshev: factor.chebyshev(), out, applications: 0 }
    }

    /// Applies D^½ to a symmetric tensor: √(dλ + 2μ) on the spherical part, √(2μ) on the
    /// rest.
    fn root(&self, y: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
        let (shear, bulk) = moduli::<D>(&self.model.law);
        scaled(y, libm::sqrt(shear), libm::sqrt(bulk))
    }

    /// Gives the stress that the particles have now.
    pub fn stress(&self, sigma: &[SMatrix<f64, D, D>]) -> Stress<D> {
        let (shear, bulk) = moduli::<D>(&self.model.law);
        let one = |p: usize| {
            scaled(&sigma[p], 1.0 / libm::sqrt(shear), 1.0 / libm::sqrt(bulk))
                * libm::sqrt(self.volume(p))
        };
        (0..sigma.len()).map(one).collect()
    }

    fn volume(&self, p: usize) -> f64 {
        self.state.particle.m[p] / self.state.particle.rho[p]
    }

    // ANCHOR: operator
    /// Applies the operator.
    pub fn apply(&mut self, y: &Stress<D>) -> Stress<D> {
        self.applications += 1;
        for p in 0..y.len() {
            let share = if self.out[p] { 0.0 } else { 1.0 / libm::sqrt(self.volume(p)) };
            self.state.particle.sigma[p] = self.root(&y[p]) * share;
        }
        let State { node, particle, shape, .. } = &mut *self.state;
        node.f.fill(SVector::zeros());
        sums::internal_force(node, particle, shape);
        let mut f = std::mem::take(&mut node.f);
        self.divide(&mut f);
        self.state.node.v = self.scheme(&f);
        self.state.node.f = f;
        let State { node, shape, .. } = &*self.state;
        let strain = |p: usize| match self.out[p] {
            true => SMatrix::zeros(),
            false => symmetric_part(&sums::velocity_gradient(node, shape, p)),
        };
        // Internal forces pull back: f = −Ĝy.
        (0..y.len()).map(|p| self.root(&strain(p)) * -libm::sqrt(self.volume(p))).collect()
    }

    /// Solves q ← M⁻¹ q, 0 where the boundary is fixed.
    fn divide(&mut self, q: &mut Field<D>) {
        for &(I, i) in &self.model.fixed {
            q[I][i] = 0.0;
        }
        let State { node, mass, .. } = &mut *self.state;
        let unsolved = q.clone();
        mass.solve(q, &unsolved, &node.m);
    }

    /// Applies A to u: to the particles and back.
    fn filter(&mut self, u: &Field<D>) -> Field<D> {
        let mut q = self.mapped(u);
        self.divide(&mut q);
        q
    }

    /// Gives Σ_p N_Ip m_p Σ_J N_Jp u_J.
    fn mapped(&self, u: &Field<D>) -> Field<D> {
        let State { node, particle, shape, .. } = &*self.state;
        let mut q = vec![SVector::zeros(); node.len()];
        for p in 0..particle.len() {
            let p_p = sums::interpolate(u, shape, p) * particle.m[p];
            shape.lines(p, |line| {
                let p_line = p_p * line.share;
                for (q_I, factor) in q[line.nodes()].iter_mut().zip(line.factors) {
                    *q_I += p_line * factor.N;
                }
            });
        }
        q
    }

    /// Applies g(A) to u.
    ///
    /// A and 2 − A are not written as polynomials of 2A − 1: at a node with hardly any mass
    /// u is so large that u/2 + (2A − 1)u/2 would leave nothing of Au.
    fn scheme(&mut self, u: &Field<D>) -> Field<D> {
        match self.factor {
            TripFactor::One => u.clone(),
            TripFactor::Unlimited => vec![SVector::zeros(); u.len()],
            TripFactor::Filtered => self.filter(u),
            TripFactor::Last => {
                let filtered = self.filter(u);
                (0..u.len()).map(|I| u[I] * 2.0 - filtered[I]).collect()
            }
            TripFactor::Alpha { .. } => self.polynomial(u),
        }
    }

    /// Applies a polynomial of A to u by Clenshaw's recurrence, in 2A − 1 on [−1, 1].
    fn polynomial(&mut self, u: &Field<D>) -> Field<D> {
        let zero = || vec![SVector::zeros(); u.len()];
        let (mut above, mut now): (Field<D>, Field<D>) = (zero(), zero());
        for k in (0..self.chebyshev.len()).rev() {
            let twice = if k == 0 { 1.0 } else { 2.0 };
            let first = k + 1 == self.chebyshev.len(); // there is nothing to filter yet
            let filtered = if first { zero() } else { self.filter(&now) };
            let next = (0..u.len())
                .map(|I| {
                    let turned = filtered[I] * 2.0 - now[I];
                    u[I] * self.chebyshev[k] + turned * twice - above[I]
                })
                .collect();
            above = std::mem::replace(&mut now, next);
        }
        now
    }
    // ANCHOR_END: operator

    // ANCHOR: bound
    /// Bounds the largest eigenvalue (1/s²) by one pass over absolute values; `None` where
    /// that tells nothing: with the consistent mass matrix, whose inverse has both signs,
    /// and with generalized-α.
    ///
    /// On strains the operator is Σ_I ∇ˢN_Ip ⊗ (g(A) M⁻¹ Σ_q V_q Dε_q ∇N_Iq). With
    /// |Dε| ≤ κ|ε| and |a ⊗ b| = |a| |b| no strain grows by more than
    /// κ Σ_I |∇N_Ip| (g(A) M⁻¹ φ)_I, φ_I = Σ_q V_q |∇N_Iq|, at the particle p where that is
    /// largest. (2 − A is taken for 2.)
    pub fn bound(&mut self) -> Option<f64> {
        let factor = match self.factor {
            TripFactor::One | TripFactor::Filtered => 1.0,
            TripFactor::Last => 2.0,
            TripFactor::Alpha { .. } | TripFactor::Unlimited => return None,
        };
        if self.model.mass == Mass::Consistent || self.out.contains(&true) {
            return None;
        }
        self.applications += 1;
        let (shear, bulk) = moduli::<D>(&self.model.law);
        let along = |phi: f64| SVector::<f64, D>::from_fn(|i, _| if i == 0 { phi } else { 0.0 });
        let State { node, particle, shape, .. } = &*self.state;
        let mut phi: Field<D> = vec![SVector::zeros(); node.len()];
        for p in 0..particle.len() {
            let V_p = self.volume(p);
            shape.lines(p, |line| {
                for (I, _, grad_N_Ip) in line.entries() {
                    phi[I] += along(V_p * libm::sqrt(grad_N_Ip.dot(&grad_N_Ip)));
                }
            });
        }
        let divide = |q: &mut Field<D>| {
            for I in 0..q.len() {
                q[I] = if node.m[I] > 0.0 { q[I] / node.m[I] } else { SVector::zeros() };
            }
        };
        divide(&mut phi);
        if self.factor == TripFactor::Filtered {
            phi = self.mapped(&phi);
            divide(&mut phi);
        }
        let mut largest: f64 = 0.0;
        for p in 0..particle.len() {
            let mut growth = 0.0;
            shape.lines(p, |line| {
                for (I, _, grad_N_Ip) in line.entries() {
                    growth += phi[I][0] * libm::sqrt(grad_N_Ip.dot(&grad_N_Ip));
                }
            });
            largest = largest.max(growth);
        }
        Some(largest * shear.max(bulk) * factor)
    }
    // ANCHOR_END: bound
}
