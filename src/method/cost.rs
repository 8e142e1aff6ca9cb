//! The cost of a run is counted instead of timed, and so is the same on every machine.
//!
//! What is made holds the count of what it took to make it: the table of shape functions its
//! rows and pairs, the working space of local max-ent its exponentials, iterations and
//! candidates, the mass matrix its factorisations and solutions, the nodes their loads and fitted
//! stresses, the particles their filtered stresses, and the equations of an implicit step their
//! iterations.
//! [`super::model::State::cost`] is their sum.

/// These counters say what a run has cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Time steps taken.
    pub steps: u64,
    /// Points at which a basis was tabulated: one per particle and table.
    pub basis_evaluations: u64,
    /// Particle-node pairs in all tables together.
    pub particle_node_pairs: u64,
    /// Calls of the exponential function.
    pub exponentials: u64,
    /// Iterations of Newton's method for λ of local max-ent.
    pub newton_iterations: u64,
    /// Body forces evaluated: one per particle and force balance.
    pub body_forces: u64,
    /// Tractions evaluated: one per loaded particle and force balance.
    pub tractions: u64,
    /// Stresses that the null-space filter has replaced: one per particle that shares its cell.
    pub filtered_stresses: u64,
    /// Stresses that least squares took in: one per particle and fit of a reconstruction.
    pub fitted_stresses: u64,
    /// Factorisations of the consistent mass matrix.
    pub factorizations: u64,
    /// Solutions with it, one per component.
    pub solves: u64,
    /// Iterations of Newton's method for the nodal displacements of an implicit step.
    pub equilibrium_iterations: u64,
    /// Tangents of these that were factorised.
    pub tangents: u64,
    /// Nodes looked at in the search for neighbours.
    pub candidates: u64,
    /// Passes over all particles by the watch on the limit of Δt: tables, bounds, and
    /// applications of the operator.
    pub limit_applications: u64,
    /// Bytes of state that one particle carries.
    pub bytes_per_particle: u64,
}

impl Cost {
    /// Lists every counter with its name, in the order of `cost.csv`.
    pub fn named(mut self) -> [(&'static str, u64); 16] {
        self.places().map(|(name, count)| (name, *count))
    }

    /// Lists every counter with its name, to be set.
    pub fn places(&mut self) -> [(&'static str, &mut u64); 16] {
        [
            ("steps", &mut self.steps),
            ("basis_evaluations", &mut self.basis_evaluations),
            ("particle_node_pairs", &mut self.particle_node_pairs),
            ("exponentials", &mut self.exponentials),
            ("newton_iterations", &mut self.newton_iterations),
            ("body_forces", &mut self.body_forces),
            ("tractions", &mut self.tractions),
            ("filtered_stresses", &mut self.filtered_stresses),
            ("fitted_stresses", &mut self.fitted_stresses),
            ("factorizations", &mut self.factorizations),
            ("solves", &mut self.solves),
            ("equilibrium_iterations", &mut self.equilibrium_iterations),
            ("tangents", &mut self.tangents),
            ("candidates", &mut self.candidates),
            ("limit_applications", &mut self.limit_applications),
            ("bytes_per_particle", &mut self.bytes_per_particle),
        ]
    }
}

impl std::ops::Add for Cost {
    type Output = Cost;

    fn add(mut self, other: Cost) -> Cost {
        for ((_, count), (_, more)) in self.places().into_iter().zip(other.named()) {
            *count += more;
        }
        self
    }
}
