//! The nodes have one of two mass matrices: the lumped one of (18), or the consistent one of
//! (13).

use super::light::{Light, Sight, look};
use super::shape::Shape;
use super::sparse::{coupled, factorise, place, place_from};
use super::state::Particles;
use crate::method::breakdown::Breakdown;
use crate::method::cost::Cost;
use nalgebra::{DVector, SVector};
use nalgebra_sparse::factorization::CscCholesky;
use nalgebra_sparse::pattern::SparsityPattern;

/// A mass matrix gives the nodes their velocities and accelerations; there are two.
#[derive(Clone, Debug)]
pub enum MassMatrix<const D: usize> {
    /// m_I of (18), which the nodes hold themselves.
    Lumped,
    /// m_IJ of (13).
    Consistent(Box<ConsistentMass<D>>),
}

impl<const D: usize> MassMatrix<D> {
    /// Makes m_IJ of (13); `m` is m_I (kg). The lumped matrix has nothing to make.
    ///
    /// Errors: [`Breakdown::SingularMass`].
    pub fn assemble(
        &mut self,
        particle: &Particles<D>,
        shape: &Shape<D>,
        m: &[f64],
    ) -> Result<(), Breakdown> {
        match self {
            MassMatrix::Lumped => Ok(()),
            MassMatrix::Consistent(mass) => mass.assemble(particle, shape, m),
        }
    }

    /// Solves (12), `out`_I = Σ_J (m⁻¹)_IJ q_J, for a nodal momentum or force `q`: the
    /// nodal velocity (m/s) or acceleration (m/s²). It is q_I / m_I with the lumped matrix.
    /// A node without mass has neither: 0.
    pub fn solve(&mut self, out: &mut [SVector<f64, D>], q: &[SVector<f64, D>], m: &[f64]) {
        match self {
            MassMatrix::Lumped => {
                for I in 0..m.len() {
                    out[I] = if m[I] > 0.0 { q[I] / m[I] } else { SVector::zeros() };
                }
            }
            MassMatrix::Consistent(mass) => mass.solve(out, q, m),
        }
    }

    /// Shows `each` the entries (I, J, m_IJ) (kg), column by column; m_JI follows m_IJ.
    pub fn entries(&self, m: &[f64], mut each: impl FnMut(usize, usize, f64)) {
        match self {
            MassMatrix::Lumped => (0..m.len()).for_each(|I| each(I, I, m[I])),
            MassMatrix::Consistent(mass) => {
                for ((J, I), m_IJ) in mass.pattern.entries().zip(&mass.values) {
                    if I >= J {
                        each(I, J, *m_IJ);
                    }
                    if I > J {
                        each(J, I, *m_IJ);
                    }
                }
            }
        }
    }

    /// Counts factorisations and solutions so far.
    pub fn cost(&self) -> Cost {
        match self {
            MassMatrix::Lumped => Cost::default(),
            MassMatrix::Consistent(mass) => mass.cost,
        }
    }
}

/// m_IJ stands here with its Cholesky factors, one for each different set of fixed nodes.
#[derive(Clone, Debug)]
pub struct ConsistentMass<const D: usize> {
    /// Which nodes share a particle; every node shares one with itself.
    pattern: SparsityPattern,
    /// m_IJ with I ≥ J (kg), column by column; above the diagonal, where m_IJ = m_JI, is 0.
    values: Vec<f64>,
    /// The place of m_II among them.
    diagonal: Vec<usize>,
    /// The same with the equations of fixed nodes taken out; the factors need no more.
    held: Vec<f64>,
    /// Which nodes are light along which axes.
    light: Light<D>,
    row: Vec<Sight<D>>,
    systems: Vec<System>,
    /// The system that serves component i.
    system_of: [usize; D],
    column: DVector<f64>,
    /// Factorisations and solutions so far.
    pub cost: Cost,
}

/// Components that share one set of fixed nodes share their equations.
#[derive(Clone, Debug)]
struct System {
    fixed: Vec<bool>,
    factor: Option<CscCholesky<f64>>,
}

impl<const D: usize> ConsistentMass<D> {
    /// Makes an empty matrix for `nodes` nodes, of which those in `fixed` have no
    /// velocity component i.
    pub fn blank(nodes: usize, fixed: &[(usize, usize)]) -> Self {
        let mut systems: Vec<System> = Vec::new();
        let system_of = std::array::from_fn(|i| {
            let mut held = vec![false; nodes];
            for (I, _) in fixed.iter().filter(|(_, component)| *component == i) {
                held[*I] = true;
            }
            systems.iter().position(|system| system.fixed == held).unwrap_or_else(|| {
                systems.push(System { fixed: held, factor: None });
                systems.len() - 1
            })
        });
        ConsistentMass {
            pattern: SparsityPattern::zeros(nodes, nodes),
            values: Vec::new(),
            diagonal: Vec::new(),
            held: Vec::new(),
            light: Light::blank(nodes),
            row: Vec::new(),
            systems,
            system_of,
            column: DVector::zeros(nodes),
            cost: Cost::default(),
        }
    }

    // ANCHOR: consistent_mass
    /// Assembles (13), m_IJ = Σ_p N_Ip m_p N_Jp  (kg), and factorises it; `m` is m_I (kg).
    ///
    /// Errors: [`Breakdown::SingularMass`] when it is not positive definite: the particles
    /// do not determine the velocity of every node.
    pub fn assemble(
        &mut self,
        particle: &Particles<D>,
        shape: &Shape<D>,
        m: &[f64],
    ) -> Result<(), Breakdown> {
        self.light.find(&mut self.row, particle, shape, m);
        if !self.sum(particle, shape) {
            self.couple(shape, m.len());
            self.sum(particle, shape);
        }
        for n in 0..self.systems.len() {
            if self.factorise(n, m).is_none() {
                let nodes = m.iter().filter(|m_I| **m_I > 0.0).count();
                return Err(Breakdown::SingularMass { particles: particle.len(), nodes });
            }
        }
        self.cost.factorizations += self.systems.len() as u64;
        Ok(())
    }

    /// Sums over all pairs of nodes of each particle; false where the pattern lacks one. The
    /// matrix is symmetric, so pairs with I ≥ J suffice. The shares of a pair that [`Light`] lumps
    /// and ties go to the diagonal.
    ///
    /// Each such share k ≥ 0 adds ½ k (v_I − v_J)² to ½ vᵀmv, so the matrix keeps its symmetry
    /// and row sums, and vᵀmv is at least that of (13); it is at most 1 + D times that of the
    /// lumped matrix. Tests: `mass_with_light_nodes_keeps_its_promises`, `strip_is_the_bar`.
    fn sum(&mut self, particle: &Particles<D>, shape: &Shape<D>) -> bool {
        self.values.fill(0.0);
        if self.diagonal.is_empty() {
            return false;
        }
        for p in 0..particle.len() {
            let m_p = particle.m[p];
            look(&mut self.row, shape, p);
            for J in &self.row {
                // Most nodes of a row stand in column J one after the other.
                let mut next = self.diagonal[J.I];
                for I in self.row.iter().filter(|I| I.I >= J.I) {
                    let Some(k) = place_from(next, &self.pattern, I.I, J.I) else { return false };
                    next = k + 1;
                    self.values[k] += I.N * m_p * J.N;
                    if let Some([of_I, of_J]) = self.light.diagonal_shares(I, J) {
                        self.values[k] -= I.N * m_p * of_I;
                        self.values[self.diagonal[I.I]] += I.N * m_p * of_I;
                        self.values[self.diagonal[J.I]] += J.N * m_p * of_J;
                    }
                }
            }
        }
        true
    }
    // ANCHOR_END: consistent_mass

    /// Makes the pattern of this table of shape functions; the factors go with the
    /// old one.
    fn couple(&mut self, shape: &Shape<D>, nodes: usize) {
        self.pattern = coupled(shape, nodes);
        self.values = vec![0.0; self.pattern.nnz()];
        self.diagonal = (0..nodes).filter_map(|I| place(&self.pattern, I, I)).collect();
        self.held = vec![0.0; self.pattern.nnz()];
        for system in &mut self.systems {
            system.factor = None;
        }
    }

    /// Makes the factor of system `n`, in which fixed nodes and those without mass stand
    /// alone with 1 on the diagonal; `None` when a pivot is zero.
    fn factorise(&mut self, n: usize, m: &[f64]) -> Option<()> {
        let system = &mut self.systems[n];
        let alone = |I: usize| system.fixed[I] || m[I] == 0.0;
        let (offsets, rows) = (self.pattern.major_offsets(), self.pattern.minor_indices());
        for J in 0..m.len() {
            for k in self.diagonal[J]..offsets[J + 1] {
                let I = rows[k];
                let single = if I == J { 1.0 } else { 0.0 };
                self.held[k] = if alone(I) || alone(J) { single } else { self.values[k] };
            }
        }
        system.factor = factorise(system.factor.take(), &self.pattern, &self.held);
        system.factor.as_ref().map(|_| ())
    }

    // ANCHOR: solve
    /// Solves (12): `out`_I = Σ_J (m⁻¹)_IJ q_J for a nodal momentum or force `q` that is zero
    /// where the boundary is fixed. Since Σ_J m_IJ = m_I, the sums Σ_I m_I `out`_I and Σ_I q_I
    /// of a free body are the same.
    fn solve(&mut self, out: &mut [SVector<f64, D>], q: &[SVector<f64, D>], m: &[f64]) {
        for i in 0..D {
            for I in 0..m.len() {
                self.column[I] = q[I][i];
            }
            if let Some(factor) = &self.systems[self.system_of[i]].factor {
                factor.solve_mut(&mut self.column);
            }
            for I in 0..m.len() {
                out[I][i] = if m[I] > 0.0 { self.column[I] } else { 0.0 };
            }
        }
        self.cost.solves += D as u64;
    }
    // ANCHOR_END: solve
}
