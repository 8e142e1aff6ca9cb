//! The equations of the nodal displacements of an implicit step: their sparse tangent, and what
//! solves it.

use super::law::{Elastic, outer};
use super::mass::MassMatrix;
use super::moduli::{Past, Trial};
use super::shape::Shape;
use super::sparse::{coupled, factorise, pattern_of, place};
use super::state::Particles;
use crate::method::cost::Cost;
use nalgebra::{DVector, SMatrix, SVector};
use nalgebra_sparse::factorization::CscCholesky;
use nalgebra_sparse::pattern::SparsityPattern;

/// The tangent's equations are solved to this share of their right side.
const SOLVED: f64 = 1e-12;

/// Where round-off lets it come no nearer, they are to this share.
const ROUGHLY: f64 = 1e-6;

/// So many times a solution is bettered at most.
const ROUNDS: usize = 60;

/// This is the working space of an implicit step.
#[derive(Clone, Debug)]
pub struct Equilibrium<const D: usize> {
    /// f_I^ext of the step (N).
    pub loads: Vec<SVector<f64, D>>,
    /// f_I^int of the trial (N).
    pub internal: Vec<SVector<f64, D>>,
    /// Σ_J m_IJ a_J of the trial (N).
    pub inertia: Vec<SVector<f64, D>>,
    /// f_I^ext + f_I^int − Σ_J m_IJ a_J (N), 0 where the displacement is known.
    pub residual: Vec<SVector<f64, D>>,
    /// By how much Newton's method changes u_I next (m).
    pub correction: Vec<SVector<f64, D>>,
    /// The size of the residual over that of its parts, before and after each iteration of the
    /// last step (–).
    pub residuals: Vec<f64>,
    /// Which nodes share a particle.
    nodes: SparsityPattern,
    /// The same for their components: that of node I along i is D I + i.
    pattern: SparsityPattern,
    /// K (N/m), column by column.
    values: Vec<f64>,
    /// ½ (K + Kᵀ), column by column.
    symmetric: Vec<f64>,
    factor: Option<CscCholesky<f64>>,
    row: Vec<(usize, SVector<f64, D>)>,
    /// Iterations and factorisations so far.
    pub cost: Cost,
}

// ANCHOR: row
/// Lists in `row` the nodes that particle p sees, with ∇N_Ip (1/m). A node without mass (`m` is
/// m_I) goes with the first that has some, as in [`super::sums::gradient`].
pub fn gradients<const D: usize>(
    row: &mut Vec<(usize, SVector<f64, D>)>,
    shape: &Shape<D>,
    m: &[f64],
    p: usize,
) {
    row.clear();
    let mut carried = SVector::zeros();
    for (I, _, grad_N_Ip) in shape.of(p) {
        match m[I] > 0.0 {
            true => row.push((I, grad_N_Ip)),
            false => carried += grad_N_Ip,
        }
    }
    if let Some(first) = row.first_mut() {
        first.1 += carried;
    }
}
// ANCHOR_END: row

impl<const D: usize> Equilibrium<D> {
    /// Makes the working space of `nodes` nodes.
    pub fn blank(nodes: usize) -> Self {
        let zeros = || vec![SVector::zeros(); nodes];
        Equilibrium {
            loads: zeros(),
            internal: zeros(),
            inertia: zeros(),
            residual: zeros(),
            correction: zeros(),
            residuals: Vec::new(),
            nodes: SparsityPattern::zeros(nodes, nodes),
            pattern: SparsityPattern::zeros(D * nodes, D * nodes),
            values: Vec::new(),
            symmetric: Vec::new(),
            factor: None,
            row: Vec::new(),
            cost: Cost::default(),
        }
    }

    /// Makes room for the tangent of this table of shape functions, once for all iterations of a step.
    pub fn fit(&mut self, shape: &Shape<D>, nodes: usize) {
        if !self.covers(shape) {
            self.couple(shape, nodes);
        }
    }

    // ANCHOR: residual
    /// Takes G_p = Σ_I u_I ⊗ ∇N_Ip (–) and sums up f_I^int = −Σ_p V_p P_p ∇N_Ip (N), with V_p and
    /// ∇N_Ip of the beginning of the step; `m` is m_I (kg).
    ///
    /// Errors: the first particle, with det f, that the displacements `u` (m) turn inside out.
    pub fn strain(
        &mut self,
        particle: &mut Particles<D>,
        u: &[SVector<f64, D>],
        (shape, m): (&Shape<D>, &[f64]),
        material: &Elastic,
    ) -> Result<(), (usize, f64)> {
        self.internal.fill(SVector::zeros());
        for p in 0..particle.len() {
            gradients(&mut self.row, shape, m, p);
            let mut G_p = SMatrix::zeros();
            let u_0 = self.row.first().map_or(SVector::zeros(), |(first, _)| u[*first]);
            for (I, grad_N_Ip) in &self.row {
                G_p += outer(&(u[*I] - u_0), grad_N_Ip);
            }
            particle.G[p] = G_p;
            let Some(trial) = trial_of(particle, p, material) else {
                return Err((p, super::law::increment(&G_p).1));
            };
            let pull = trial.P * (particle.m[p] / particle.rho[p]);
            for (I, grad_N_Ip) in &self.row {
                self.internal[*I] -= pull * grad_N_Ip;
            }
        }
        Ok(())
    }
    // ANCHOR_END: residual

    // ANCHOR: assemble
    /// Assembles the tangent at the G_p of the particles, K = Σ_p V_p ∇N_Ip · dP/dG · ∇N_Jp, and
    /// adds `per_u` m_IJ on the diagonal of each block, the derivative of the inertia.
    pub fn assemble(
        &mut self,
        particle: &Particles<D>,
        (shape, m): (&Shape<D>, &[f64]),
        material: &Elastic,
        (mass, per_u): (&MassMatrix<D>, f64),
    ) {
        self.values.fill(0.0);
        for p in 0..particle.len() {
            gradients(&mut self.row, shape, m, p);
            let Some(trial) = trial_of(particle, p, material) else { continue };
            let V_p = particle.m[p] / particle.rho[p];
            let dP: [[SMatrix<f64, D, D>; D]; D] = unit_changes(&trial, material);
            for n in 0..self.row.len() {
                let (J, grad_N_Jp) = self.row[n];
                for (j, dP) in dP.iter().enumerate() {
                    let along: SMatrix<f64, D, D> =
                        (0..D).map(|l| dP[l] * grad_N_Jp[l]).sum::<SMatrix<f64, D, D>>() * V_p;
                    for k in 0..self.row.len() {
                        let (I, grad_N_Ip) = self.row[k];
                        self.add(I, J, j, along * grad_N_Ip);
                    }
                }
            }
        }
        if per_u > 0.0 {
            mass.entries(m, |I, J, m_IJ| {
                for j in 0..D {
                    let entry = per_u * m_IJ;
                    self.add(I, J, j, SVector::from_fn(|i, _| if i == j { entry } else { 0.0 }));
                }
            });
        }
    }
    // ANCHOR_END: assemble

    /// Adds to the entries of all components of node I in column (J, j).
    fn add(&mut self, I: usize, J: usize, j: usize, column: SVector<f64, D>) {
        let lane = self.nodes.lane(J);
        let Ok(at) = lane.binary_search(&I) else { return }; // nothing couples them any more
        let start = D * (D * self.nodes.major_offsets()[J] + j * lane.len() + at);
        for i in 0..D {
            self.values[start + i] += column[i];
        }
    }

    /// Tells whether the pattern has all pairs of nodes that share a particle.
    fn covers(&self, shape: &Shape<D>) -> bool {
        !self.values.is_empty()
            && shape.pairs().all(|(I, p, ..)| {
                let lane = self.nodes.lane(I);
                shape.of(p).all(|(J, ..)| lane.binary_search(&J).is_ok())
            })
    }

    /// Makes the pattern of this table of shape functions.
    fn couple(&mut self, shape: &Shape<D>, nodes: usize) {
        self.nodes = coupled(shape, nodes);
        let column = |n: usize| {
            let lane = self.nodes.lane(n / D);
            lane.iter().flat_map(|I| (0..D).map(move |i| D * I + i)).collect()
        };
        let mut columns: Vec<Vec<usize>> = (0..D * nodes).map(column).collect();
        self.pattern = pattern_of(&mut columns);
        self.values = vec![0.0; self.pattern.nnz()];
        self.symmetric = vec![0.0; self.pattern.nnz()];
        self.factor = None;
    }

    // ANCHOR: solve_tangent
    /// Solves K Δu = r for the correction, by the Cholesky factors of ½ (K + Kᵀ): what is left of
    /// the residual is solved for again, until nothing is. The tangent of a law with an energy is
    /// symmetric, and once is enough; that of the rate law in 2D and 3D is so but for parts
    /// as small as σ/E. Known displacements, where `known`(I, i), have 1 on the diagonal.
    ///
    /// `None` where the symmetric part is not positive definite, or the rest is not small.
    pub fn solve(&mut self, known: impl Fn(usize, usize) -> bool) -> Option<()> {
        self.symmetrise(|n| known(n / D, n % D));
        self.cost.tangents += 1;
        self.factor = factorise(self.factor.take(), &self.pattern, &self.symmetric);
        let factor = self.factor.as_ref()?;
        let n = self.pattern.major_dim();
        let mut left = DVector::from_fn(n, |n, _| self.residual[n / D][n % D]);
        let mut found = DVector::<f64>::zeros(n);
        let whole = largest(&left);
        for _ in 0..ROUNDS {
            let before = largest(&left);
            let mut step = left.clone();
            factor.solve_mut(&mut step);
            found += &step;
            for ((J, I), value) in self.pattern.entries().zip(&self.values) {
                left[I] -= value * step[J];
            }
            let now = largest(&left);
            if now <= SOLVED * whole {
                break;
            }
            let falls = now < 0.9 * before;
            if !falls {
                // Round-off ends it, or the symmetric part says too little of the whole.
                if now <= ROUGHLY * whole {
                    break;
                }
                return None;
            }
        }
        for I in 0..self.correction.len() {
            self.correction[I] = SVector::from_fn(|i, _| found[D * I + i]);
        }
        Some(())
    }
    // ANCHOR_END: solve_tangent

    /// Takes known components out of K, and ½ (K + Kᵀ) of it.
    fn symmetrise(&mut self, known: impl Fn(usize) -> bool) {
        for (k, (J, I)) in self.pattern.entries().enumerate() {
            if known(I) || known(J) {
                self.values[k] = if I == J { 1.0 } else { 0.0 };
            }
        }
        for (k, (J, I)) in self.pattern.entries().enumerate() {
            let mirrored = place(&self.pattern, J, I).map_or(0.0, |k| self.values[k]);
            self.symmetric[k] = 0.5 * (self.values[k] + mirrored);
        }
    }
}

/// Gives the largest size of an entry.
fn largest(list: &DVector<f64>) -> f64 {
    list.iter().fold(0.0, |most: f64, x| if x.is_nan() { *x } else { most.max(x.abs()) })
}

/// Tries G_p on particle p.
fn trial_of<const D: usize>(
    particle: &Particles<D>,
    p: usize,
    material: &Elastic,
) -> Option<Trial<D>> {
    let F = particle.F.get(p).copied().unwrap_or_else(SMatrix::identity);
    material.trial(&Past { F, sigma: particle.sigma[p] }, &particle.G[p])
}

/// Gives dP/dG_jl, for each j and l.
fn unit_changes<const D: usize>(
    trial: &Trial<D>,
    material: &Elastic,
) -> [[SMatrix<f64, D, D>; D]; D] {
    std::array::from_fn(|j| {
        std::array::from_fn(|l| {
            let mut unit = SMatrix::zeros();
            unit[(j, l)] = 1.0;
            trial.change(material, &unit)
        })
    })
}
