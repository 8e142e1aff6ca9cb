//! Local maximum-entropy shape functions, (30)-(37), on any set of nodes.
//!
//! Nothing here has a unit: with ξ_I = (x − x_I)/h and λ scaled by h, (31) is
//! p_I ∝ exp(−γ|ξ_I|² + λ·ξ_I), γ = βh². Relative to one node 0 near x, with
//! a_I = (x_0 − x_I)/h, so that ξ_I = ξ_0 + a_I, the exponent is
//!
//! f_I = −γ|a_I|² + μ·a_I + const,   μ = λ − 2γ ξ_0.
//!
//! The place ξ_0 has left the exponent: its rounding cannot be blown up by a
//! large γ, and on a grid all a_I are whole numbers.
//!
//! Not covered: a point on a line of nodes, but on none of them, inside the set,
//! with γ above 700 and no cut-off. The weights beside that line are then too
//! small for a number; the answer is [`Failure::NotConverged`]. With the default
//! cut-off such a point is on the side of its cell, and is served.

mod weights;

use crate::method::continuum::law::{applied, outer};
use crate::method::cost::Cost;
use nalgebra::{SMatrix, SVector};
use thiserror::Error;
use weights::{FEW, Moments};

/// Iterations after which the search for λ is given up.
const MOST_ITERATIONS: usize = 200;

/// Largest relative change of a p_I in the last step of Newton's method. The
/// step is then applied to the p_I themselves; what is left is its square.
const CLOSE: f64 = 1e-8;

/// Why there is no λ.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Failure {
    /// x is not in the convex hull of the nodes, or the nodes span no volume.
    #[error("the point is outside the convex hull of its nodes, or they span no volume")]
    OutsideHull,
    /// A coordinate of the point or of a node is NaN or infinite.
    #[error("a coordinate of the point or of a node is not a finite number")]
    NotFinite,
    /// |r| (–) after so many iterations.
    #[error("|r| is still {residual:e} after {iterations} Newton iterations")]
    NotConverged { residual: f64, iterations: usize },
}

/// Buffers and result of one point; keep it, so that nothing is allocated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lme<const D: usize> {
    /// ξ_I = (x − x_I)/h of the nodes in the support.
    pub xi: Vec<SVector<f64, D>>,
    /// (x_b − x_I)/h for one node b near x: whole numbers on a grid.
    pub offset: Vec<SVector<f64, D>>,
    /// p_I, that is N_I.
    pub p: Vec<f64>,
    /// h ∇p_I.
    pub grad: Vec<SVector<f64, D>>,
    /// Exponential functions and Newton iterations so far.
    pub cost: Cost,
    /// a_I = (x_0 − x_I)/h of the nodes that share the weight.
    a: Vec<SVector<f64, D>>,
    /// Which entry of `xi` each entry of `a` is.
    shares: Vec<usize>,
    /// The weights of `a`, which add up to 1.
    weight: Vec<f64>,
    /// Σ exp f_I over `a`, the last one computed, is Z exp(largest).
    largest: f64,
    Z: f64,
    /// The offsets are whole numbers, the largest of `a` along an axis is this.
    on_grid: bool,
    reach: f64,
    /// exp(−γk²) for k = 0, 1, … and the γ it is for.
    gauss: [f64; FEW + 1],
    gauss_gamma: f64,
}

/// Axes along which x lies on a flat side of the hull, with the direction to
/// the inside: ±1, else 0.
type Faces<const D: usize> = [f64; D];

impl<const D: usize> Lme<D> {
    /// Forgets the nodes of the last point. `on_grid` promises that all offsets
    /// to come are whole numbers.
    pub fn clear(&mut self, on_grid: bool) {
        self.xi.clear();
        self.offset.clear();
        self.on_grid = on_grid;
    }

    /// Adds a node to the support: (x − x_I)/h and (x_b − x_I)/h. A distance
    /// along an axis below 1e-150 h is none: its square would have no number.
    pub fn push(&mut self, xi: SVector<f64, D>, offset: SVector<f64, D>) {
        self.xi.push(xi.map(|xi| if libm::fabs(xi) < 1e-150 { 0.0 } else { xi }));
        self.offset.push(offset);
    }

    // ANCHOR: lme_evaluate
    /// p_I and h∇p_I at the point with `self.xi`, for γ = βh²; returns λ (–,
    /// scaled by h).
    ///
    /// `starts` are values of λ to begin from. The first one near enough is
    /// taken, else the best. If none leads to the solution, γ is raised from 1
    /// in steps, each starting from the last. A point on a side of the hull
    /// that is normal to an axis gets the limit from inside.
    ///
    /// Errors: [`Failure`].
    pub fn evaluate(
        &mut self,
        gamma: f64,
        starts: impl IntoIterator<Item = SVector<f64, D>>,
    ) -> Result<SVector<f64, D>, Failure> {
        let faces = self.faces()?;
        let (xi_0, on_node) = self.share_weight(&faces)?;
        let lambda = if self.shares.is_empty() {
            SVector::zeros() // a corner of the box: all weight is on its node
        } else {
            match self.newton(gamma, &xi_0, &faces, starts) {
                Err(Failure::NotConverged { .. }) => self.raise_gamma(gamma, &xi_0, &faces)?,
                done => done?,
            }
        };
        self.gradients(gamma, &faces, on_node, &lambda)?;
        Ok(lambda)
    }
    // ANCHOR_END: lme_evaluate

    /// Finds the flat sides that x lies on. Outside the box of the nodes is
    /// outside their hull.
    fn faces(&self) -> Result<Faces<D>, Failure> {
        let mut faces = [0.0; D];
        for d in 0..D {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for xi in &self.xi {
                low = low.min(xi[d]);
                high = high.max(xi[d]);
            }
            faces[d] = match (low, high) {
                (low, high) if !(low <= 0.0 && 0.0 <= high) || low == high => {
                    return Err(Failure::OutsideHull);
                }
                (_, 0.0) => 1.0,
                (0.0, _) => -1.0,
                _ => 0.0,
            };
        }
        Ok(faces)
    }

    /// Lists the nodes that share the weight, those on all faces of x, relative
    /// to the nearest of them; returns its ξ_0, and its number if x is on it.
    ///
    /// A node on which x lies exactly is not listed: ξ_I = 0 adds nothing to r.
    /// The others alone fix λ, even where their weights are too small for a
    /// number.
    fn share_weight(
        &mut self,
        faces: &Faces<D>,
    ) -> Result<(SVector<f64, D>, Option<usize>), Failure> {
        self.shares.clear();
        let inside = *faces == [0.0; D];
        let (mut nearest, mut least) = (None, f64::INFINITY);
        for (n, xi) in self.xi.iter().enumerate() {
            if inside || (0..D).all(|d| faces[d] == 0.0 || xi[d] == 0.0) {
                self.shares.push(n);
                let square = xi.dot(xi);
                if square < least {
                    (nearest, least) = (Some(n), square);
                }
            }
        }
        // On two faces at once x is a corner of the box, which may hold no node.
        let nearest = nearest.ok_or(Failure::OutsideHull)?;
        let xi_0 = self.xi[nearest];
        let on_node = (least == 0.0).then_some(nearest);
        if on_node.is_some() {
            self.shares.retain(|n| Some(*n) != on_node);
        }
        self.a.clear();
        self.a.extend(self.shares.iter().map(|n| self.offset[*n] - self.offset[nearest]));
        self.reach = self.a.iter().map(|a| a.amax()).fold(0.0, f64::max);
        self.weight.clear();
        self.weight.resize(self.a.len(), 0.0);
        Ok((xi_0, on_node))
    }

    // ANCHOR: lme_newton
    /// Solves r(λ) = 0 by Newton's method, damped while a step would change some
    /// p_I by more than a half (Armijo on log Z, which is convex).
    ///
    /// The last step is applied to the p_I themselves, to first order: λ as a
    /// number is no finer than its last bit, which at a large γ is too coarse.
    fn newton(
        &mut self,
        gamma: f64,
        xi_0: &SVector<f64, D>,
        faces: &Faces<D>,
        starts: impl IntoIterator<Item = SVector<f64, D>>,
    ) -> Result<SVector<f64, D>, Failure> {
        let shift = xi_0 * (2.0 * gamma);
        let not_converged = |r: &SVector<f64, D>, iterations| {
            Err(Failure::NotConverged { residual: libm::sqrt(r.dot(r)), iterations })
        };
        let (mut best, mut least, mut found) = (SVector::zeros(), f64::INFINITY, None);
        for start in starts {
            let mu = start - shift;
            let here = self.moments(gamma, &mu, xi_0, faces);
            if self.step(&here).is_some_and(|(_, change)| change <= 0.5) {
                found = Some((mu, here));
                break;
            }
            let phi = here.phi();
            if phi < least {
                (best, least) = (mu, phi);
            }
        }
        let (mut mu, mut now) = match found {
            Some(near) => near,
            None => (best, self.moments(gamma, &best, xi_0, faces)),
        };
        for iteration in 1..=MOST_ITERATIONS {
            self.cost.newton_iterations += 1;
            let Some((step, change)) = self.step(&now) else {
                return not_converged(&now.r, iteration);
            };
            if change <= CLOSE {
                for (p, a) in self.weight.iter_mut().zip(&self.a) {
                    *p *= 1.0 + step.dot(&(a - now.mean));
                }
                return Ok(mu + step + shift);
            }
            let mut damping = 1.0;
            loop {
                let trial = mu + step * damping;
                let next = self.moments(gamma, &trial, xi_0, faces);
                let enough = || now.phi() + 1e-4 * damping * now.r.dot(&step);
                if change * damping <= 0.5 || next.phi() <= enough() {
                    (mu, now) = (trial, next);
                    break;
                }
                damping *= 0.5;
            }
            if self.separates(&(mu + shift)) {
                return Err(Failure::OutsideHull);
            }
        }
        not_converged(&now.r, MOST_ITERATIONS)
    }
    // ANCHOR_END: lme_newton

    /// Newton's step −J⁻¹ r and the largest relative change of a p_I by it,
    /// |Δλ·(ξ_I − r)|; `None` when J is singular.
    fn step(&self, now: &Moments<D>) -> Option<(SVector<f64, D>, f64)> {
        let step = -(now.J.try_inverse()? * now.r);
        let changes = self.a.iter().map(|a| libm::fabs(step.dot(&(a - now.mean))));
        let change = changes.fold(0.0, f64::max);
        change.is_finite().then_some((step, change))
    }

    /// True when all nodes lie strictly on one side of a plane through x: then
    /// log Z has no minimum.
    fn separates(&self, lambda: &SVector<f64, D>) -> bool {
        self.shares.iter().all(|n| lambda.dot(&self.xi[*n]) < 0.0)
    }

    /// From γ = 1 (or less) to γ in factors of 4. λ grows in proportion, up to
    /// logarithms, so each solution starts the next well.
    fn raise_gamma(
        &mut self,
        gamma: f64,
        xi_0: &SVector<f64, D>,
        faces: &Faces<D>,
    ) -> Result<SVector<f64, D>, Failure> {
        let mut reached = gamma.min(1.0);
        let mut lambda = self.newton(reached, xi_0, faces, [SVector::zeros()])?;
        while reached < gamma {
            let next = (4.0 * reached).min(gamma);
            lambda = self.newton(next, xi_0, faces, [lambda * (next / reached)])?;
            reached = next;
        }
        Ok(lambda)
    }

    // ANCHOR: lme_gradients
    /// (35): h∇p_I = −p_I J⁻¹ ξ_I, with J at the solution.
    ///
    /// On a face only its nodes have weight, and J has no part normal to it.
    /// One step δ inwards, the next layer of nodes takes the weight in
    /// proportion to the distance, shared as q_I ∝ exp(−γ|ξ_I|² + λ·ξ_I) along the
    /// face; the face's own weights shrink, and shift so that Σ p_I ξ_I stays 0.
    fn gradients(
        &mut self,
        gamma: f64,
        faces: &Faces<D>,
        on_node: Option<usize>,
        lambda: &SVector<f64, D>,
    ) -> Result<(), Failure> {
        let mut J = SMatrix::zeros();
        for (p, n) in self.weight.iter().zip(&self.shares) {
            J += outer(&self.xi[*n], &self.xi[*n]) * *p;
        }
        fill_faces(&mut J, faces);
        let mut inverse = J.try_inverse().ok_or(Failure::OutsideHull)?;
        self.p.clear();
        self.p.resize(self.xi.len(), 0.0);
        self.grad.clear();
        self.grad.resize(self.xi.len(), SVector::zeros());
        for (p, n) in self.weight.iter().zip(&self.shares) {
            self.p[*n] = *p;
            self.grad[*n] = -applied(&inverse, &self.xi[*n]) * *p;
        }
        if let Some(node) = on_node {
            // Its exponent is 0, the others sum up to S: shares 1 and S of 1 + S.
            // In the gradient the share of the others cancels.
            let mut S = 0.0;
            if !self.shares.is_empty() {
                S = self.Z * libm::exp(self.largest);
                self.cost.exponentials += 1;
            }
            self.shares.iter().for_each(|n| self.p[*n] *= S / (1.0 + S));
            self.p[node] = 1.0 / (1.0 + S);
            self.shares.push(node);
            if S > 1e-150 {
                inverse *= (1.0 + S) / S; // of the J of all shares together
            }
        }
        for d in (0..D).filter(|d| faces[*d] != 0.0) {
            let in_layer = |xi: &SVector<f64, D>| {
                xi[d] != 0.0 && (0..D).all(|e| e == d || faces[e] == 0.0 || xi[e] == 0.0)
            };
            let layer = self.xi.iter().filter(|xi| in_layer(xi));
            let delta = layer.map(|xi| libm::fabs(xi[d])).fold(f64::INFINITY, f64::min);
            if delta == f64::INFINITY {
                return Err(Failure::OutsideHull);
            }
            let along = |mut xi: SVector<f64, D>| {
                xi[d] = 0.0;
                xi
            };
            let in_first = |xi: &SVector<f64, D>| in_layer(xi) && libm::fabs(xi[d]) == delta;
            let first: Vec<usize> = (0..self.xi.len()).filter(|n| in_first(&self.xi[*n])).collect();
            let f = |n: usize| {
                let xi = along(self.xi[n]);
                lambda.dot(&xi) - gamma * xi.dot(&xi)
            };
            let largest = first.iter().map(|n| f(*n)).fold(f64::NEG_INFINITY, f64::max);
            let q: Vec<f64> = first.iter().map(|n| libm::exp(f(*n) - largest)).collect();
            self.cost.exponentials += q.len() as u64;
            let Z: f64 = q.iter().sum();
            let mut mean = SVector::zeros();
            for (n, q) in first.iter().zip(&q) {
                mean += along(self.xi[*n]) * (q / Z);
                self.grad[*n][d] = faces[d] * q / Z / delta;
            }
            for n in &self.shares {
                let xi = self.xi[*n];
                let shrink = 1.0 + xi.dot(&(inverse * mean));
                self.grad[*n][d] = -faces[d] * self.p[*n] * shrink / delta;
            }
        }
        Ok(())
    }
    // ANCHOR_END: lme_gradients
}

/// On a face J has an empty row and column; a 1 there leaves the rest alone.
fn fill_faces<const D: usize>(J: &mut SMatrix<f64, D, D>, faces: &Faces<D>) {
    for d in (0..D).filter(|d| faces[*d] != 0.0) {
        J[(d, d)] = 1.0;
    }
}
