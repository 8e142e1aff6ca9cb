//! What a run costs, counted instead of timed: the same on every machine.
//!
//! What is made holds the count of what it took to make it: the table of shape functions
//! its fillings, the mass matrix its factorisations, the nodes their loads.
//! [`super::model::State::cost`] is their sum.

/// Deterministic cost counters.
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
    /// Iterations of Newton's method.
    pub newton_iterations: u64,
    /// Body forces evaluated: one per particle and force balance.
    pub body_forces: u64,
    /// Tractions evaluated: one per loaded particle and force balance.
    pub tractions: u64,
    /// Factorisations of the consistent mass matrix.
    pub factorizations: u64,
    /// Solutions with it, one per component.
    pub solves: u64,
    /// Nodes looked at in the search for neighbours.
    pub candidates: u64,
    /// Bytes of state that one particle carries.
    pub bytes_per_particle: u64,
}

impl Cost {
    /// Every counter with its name, in the order of `cost.csv`.
    pub fn named(&self) -> [(&'static str, u64); 11] {
        [
            ("steps", self.steps),
            ("basis_evaluations", self.basis_evaluations),
            ("particle_node_pairs", self.particle_node_pairs),
            ("exponentials", self.exponentials),
            ("newton_iterations", self.newton_iterations),
            ("body_forces", self.body_forces),
            ("tractions", self.tractions),
            ("factorizations", self.factorizations),
            ("solves", self.solves),
            ("candidates", self.candidates),
            ("bytes_per_particle", self.bytes_per_particle),
        ]
    }
}

impl std::ops::Add for Cost {
    type Output = Cost;
    fn add(self, other: Cost) -> Cost {
        Cost {
            steps: self.steps + other.steps,
            basis_evaluations: self.basis_evaluations + other.basis_evaluations,
            particle_node_pairs: self.particle_node_pairs + other.particle_node_pairs,
            exponentials: self.exponentials + other.exponentials,
            newton_iterations: self.newton_iterations + other.newton_iterations,
            body_forces: self.body_forces + other.body_forces,
            tractions: self.tractions + other.tractions,
            factorizations: self.factorizations + other.factorizations,
            solves: self.solves + other.solves,
            candidates: self.candidates + other.candidates,
            bytes_per_particle: self.bytes_per_particle + other.bytes_per_particle,
        }
    }
}
