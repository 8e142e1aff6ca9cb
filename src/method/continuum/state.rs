//! Particles and nodes carry these quantities (§2, Table 1, and §3.3).
//!
//! Each symbol of the paper has one array; the index is the subscript, so `m_p` is
//! `particle.m[p]` and `m_I` is `node.m[I]`. Positions are measured from the
//! body's lower corner, so moving a scene in space changes no digit.

use crate::method::cost::Cost;
use crate::method::grid::{Grid, Located};
use nalgebra::{SMatrix, SVector};

// ANCHOR: particles
/// Particles are the material points: they hold what is remembered of the material from step to
/// step.
#[derive(Clone, Debug, PartialEq)]
pub struct Particles<const D: usize> {
    /// m_p, mass (kg).
    pub m: Vec<f64>,
    /// x_p, position (m).
    pub x: Vec<SVector<f64, D>>,
    /// u_p, displacement from the material point (m), summed up beside x_p: a small motion has
    /// digits here that x_p has no room for.
    pub u: Vec<SVector<f64, D>>,
    /// v_p, velocity (m/s).
    pub v: Vec<SVector<f64, D>>,
    /// ρ_p, density (kg/m³).
    pub rho: Vec<f64>,
    /// σ_p, Cauchy stress (Pa).
    pub sigma: Vec<SMatrix<f64, D, D>>,
    /// Δε_p, strain increment of the step (–).
    pub d_eps: Vec<SMatrix<f64, D, D>>,
    /// λ_p of the last table; of local max-ent only.
    pub lambda: Vec<Multiplier<D>>,
    /// a_p, acceleration (m/s²); of Newmark's methods and generalized-α only.
    pub a: Vec<SVector<f64, D>>,
    /// G_p, the gradient of a step's displacement (–); where more is needed than Δε_p.
    pub G: Vec<SMatrix<f64, D, D>>,
    /// F_p, deformation gradient (–); of hyperelastic laws only.
    pub F: Vec<SMatrix<f64, D, D>>,
    /// How long each particle is along each axis, relative to its start (–); of GIMP with domains
    /// that stretch only.
    pub stretch: Vec<SVector<f64, D>>,
    /// A_p, the inverse of the deformation since the start (–); of local max-ent with a metric that
    /// goes with the material only: B_p = γ AᵀA/h².
    pub pull: Vec<SMatrix<f64, D, D>>,
    /// Sums of ½ (G_ji − G_ij), how far each particle has turned in each plane (rad); of the
    /// rate law in 2D and 3D only.
    pub turned: Vec<f64>,
    /// The stresses that were filtered.
    pub cost: Cost,
}
// ANCHOR_END: particles

// ANCHOR: nodes
/// Nodes are scratch paper: before they are filled anew in a time step they are wiped. With OTM
/// they are the body's own and carry its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Nodes<const D: usize> {
    /// m_I, lumped mass (kg).
    pub m: Vec<f64>,
    /// p_I, momentum (kg m/s).
    pub p: Vec<SVector<f64, D>>,
    /// v_I, velocity (m/s): p_I / m_I, or what solves (12) with the consistent mass matrix.
    pub v: Vec<SVector<f64, D>>,
    /// f_I, force (N).
    pub f: Vec<SVector<f64, D>>,
    /// a_I, acceleration (m/s²): f_I / m_I, or what solves (12) with the consistent mass matrix.
    pub a: Vec<SVector<f64, D>>,
    /// a_I of k, brought by the particles (m/s²); of generalized-α and the implicit Newmark method
    /// only.
    pub a_last: Vec<SVector<f64, D>>,
    /// a_I of k+1 (m/s²); of generalized-α only.
    pub a_next: Vec<SVector<f64, D>>,
    /// u_I, displacement in the step (m); of implicit schemes only, which solve for it.
    pub u: Vec<SVector<f64, D>>,
    /// x_I, position (m); of OTM only, whose nodes move.
    pub x: Vec<SVector<f64, D>>,
    /// The loads that were summed up here.
    pub cost: Cost,
}
// ANCHOR_END: nodes

/// A multiplier is what a particle remembers of its λ, so that the next search starts near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multiplier<const D: usize> {
    /// λ h of the last table (–).
    pub lambda: SVector<f64, D>,
    /// h ∂(λ_d h)/∂x_d along each axis (–): 2γ − 1/J_d. Of products only.
    pub rate: SVector<f64, D>,
    /// x_p of the last table (m). Of products only.
    pub x: SVector<f64, D>,
}

impl<const D: usize> Default for Multiplier<D> {
    fn default() -> Self {
        let [lambda, rate, x] = [SVector::zeros(); 3];
        Multiplier { lambda, rate, x }
    }
}

/// Carriers hold the body's mass and motion: masses, places and velocities.
pub struct Carriers<'a, const D: usize> {
    pub m: &'a [f64],
    pub x: &'a [SVector<f64, D>],
    pub v: &'a [SVector<f64, D>],
}

impl<const D: usize> Particles<D> {
    /// Takes the particles as carriers of mass and motion.
    pub fn carriers(&self) -> Carriers<'_, D> {
        Carriers { m: &self.m, x: &self.x, v: &self.v }
    }

    /// A body turns in so many planes: 0, 1 or 3.
    pub const PLANES: usize = D * (D - 1) / 2;

    /// Every particle carries so many bytes of state, whatever the scheme: 56 in 1D, where
    /// every tensor is a single number.
    pub const BYTES: usize = 2 * size_of::<f64>()
        + 3 * size_of::<SVector<f64, D>>()
        + 2 * size_of::<SMatrix<f64, D, D>>();

    /// Makes particles without mass, at rest and free of stress at positions `x` (m), with
    /// density `rho` (kg/m³).
    pub fn at_rest(x: Vec<SVector<f64, D>>, rho: f64) -> Self {
        let n = x.len();
        Particles {
            m: vec![0.0; n],
            x,
            u: vec![SVector::zeros(); n],
            v: vec![SVector::zeros(); n],
            rho: vec![rho; n],
            sigma: vec![SMatrix::zeros(); n],
            d_eps: vec![SMatrix::zeros(); n],
            lambda: Vec::new(),
            a: Vec::new(),
            G: Vec::new(),
            F: Vec::new(),
            stretch: Vec::new(),
            pull: Vec::new(),
            turned: Vec::new(),
            cost: Cost::default(),
        }
    }

    /// Lists the particles of each cell with their places in it; a cell has the number of its lowest
    /// node. A particle outside the grid is in no list, and the next table names it.
    pub fn by_cell(&self, grid: &Grid<D>) -> Vec<Vec<(usize, Located<D>)>> {
        let mut cells = vec![Vec::new(); grid.nodes()];
        for (p, x_p) in self.x.iter().enumerate() {
            if let Some(at) = grid.locate(x_p) {
                cells[grid.node(at.cell)].push((p, at));
            }
        }
        cells
    }

    /// Moves particle p by `way` (m).
    #[inline(always)]
    pub fn advance(&mut self, p: usize, way: SVector<f64, D>) {
        self.x[p] += way;
        self.u[p] += way;
    }

    /// Adds to how far particle p has turned the skew part of G_p, the gradient of a step's
    /// displacement, where that is kept.
    #[inline(always)]
    pub fn turn(&mut self, p: usize, G_p: &SMatrix<f64, D, D>) {
        if self.turned.is_empty() {
            return;
        }
        let mut n = p * Self::PLANES;
        for i in 0..D {
            for j in i + 1..D {
                self.turned[n] += 0.5 * (G_p[(j, i)] - G_p[(i, j)]);
                n += 1;
            }
        }
    }

    // ANCHOR: stretch
    /// Stretches the particles' domains by 1 + G_dd along axis d, or 1 + Δε_dd where G_p is not
    /// kept: in 1D, and while no axis turns into another, the product is F_dd. A basis without
    /// domains has nothing to stretch.
    pub fn lengthen(&mut self) {
        let step = if self.G.is_empty() { &self.d_eps } else { &self.G };
        for (stretch, step) in self.stretch.iter_mut().zip(step) {
            for d in 0..D {
                stretch[d] *= 1.0 + step[(d, d)];
            }
        }
    }
    // ANCHOR_END: stretch

    /// Gives N_p, the number of particles.
    pub fn len(&self) -> usize {
        self.m.len()
    }
}

impl<const D: usize> Nodes<D> {
    /// Makes `n` nodes that carry nothing.
    pub fn blank(n: usize) -> Self {
        Nodes {
            m: vec![0.0; n],
            p: vec![SVector::zeros(); n],
            v: vec![SVector::zeros(); n],
            f: vec![SVector::zeros(); n],
            a: vec![SVector::zeros(); n],
            a_last: Vec::new(),
            a_next: Vec::new(),
            u: Vec::new(),
            x: Vec::new(),
            cost: Cost::default(),
        }
    }

    /// Gives N_n, the number of nodes.
    pub fn len(&self) -> usize {
        self.m.len()
    }
}
