//! The model stays the same from step to step, and the state changes.

use super::basis::{Basis, Scratch};
use super::choice::{Filter, Mass, Method};
use super::continuum::equilibrium::Equilibrium;
use super::continuum::law::Elastic;
use super::continuum::loads::Loads;
use super::continuum::mass::{ConsistentMass, MassMatrix};
use super::continuum::shape::Shape;
use super::continuum::state::{Carriers, Multiplier, Nodes, Particles};
use super::cost::Cost;
use super::grid::Grid;
use super::reading::Kinematics;
use super::reconstruction::Reconstruction;
use nalgebra::{SMatrix, SVector};

/// Fixed components of nodes are pairs (I, i).
pub type Fixed = [(usize, usize)];

/// The model is all that stays the same from step to step.
#[derive(Clone, Debug, PartialEq)]
pub struct Model<const D: usize> {
    pub grid: Grid<D>,
    pub basis: Basis,
    pub law: Elastic,
    /// Node I has zero velocity component i.
    pub fixed: Vec<(usize, usize)>,
    pub loads: Option<Loads<D>>,
    pub method: Method,
    pub mass: Mass,
    /// Which map the strain of MPM is taken from; OTM has one.
    pub kinematics: Kinematics,
    /// What is taken out of the stresses after each update; a scene may have no filter.
    pub filter: Option<Filter>,
    /// How the internal forces are integrated, where it is not the sum over particles.
    pub reconstruction: Option<Reconstruction>,
    /// Δt (s).
    pub dt: f64,
    /// N_t, the number of time steps.
    pub steps: usize,
}

impl<const D: usize> Model<D> {
    /// Says whether particles keep G of a step, which the printed rate law has no need of.
    pub fn keeps_gradient(&self) -> bool {
        let printed = self.kinematics == Kinematics::AsPrinted;
        match self.method {
            Method::Mpm(_) => !printed || self.law.law.is_hyperelastic(),
            Method::Otm(_) => true,
        }
    }

    /// Counts the bytes of state that one particle carries in this model.
    pub fn bytes_per_particle(&self) -> usize {
        let (vector, matrix) = (size_of::<SVector<f64, D>>(), size_of::<SMatrix<f64, D, D>>());
        let of_multiplier =
            if self.basis.traits().multiplier { size_of::<Multiplier<D>>() } else { 0 };
        let of_metric = if self.basis.traits().metric { matrix } else { 0 }; // A_p
        let of_stretch = if self.basis.traits().stretch { vector } else { 0 };
        let of_basis = of_multiplier + of_metric + of_stretch;
        let of_method = if self.method.needs().acceleration { vector } else { 0 }; // a_p
        let of_map = if self.keeps_gradient() { matrix } else { 0 }; // G_p
        let of_law = if self.law.law.is_hyperelastic() {
            matrix // F_p
        } else {
            Particles::<D>::PLANES * size_of::<f64>() // how far it has turned
        };
        Particles::<D>::BYTES + of_basis + of_method + of_map + of_law
    }
}

/// The state is all that changes: particles, nodes, and the table of shape functions
/// between them.
#[derive(Clone, Debug)]
pub struct State<const D: usize> {
    pub particle: Particles<D>,
    pub node: Nodes<D>,
    pub shape: Shape<D>,
    pub mass: MassMatrix<D>,
    /// The equations of the nodal displacements; of implicit schemes only.
    pub equilibrium: Option<Box<Equilibrium<D>>>,
    /// What the basis keeps for its next table.
    pub scratch: Scratch<D>,
    /// Time steps taken.
    pub steps: u64,
}

impl<const D: usize> State<D> {
    /// Makes the state of `particle` before its first table, with all arrays that the model's
    /// method, scheme and basis need. OTM brings its nodes' places `x` (m); those of MPM
    /// are the grid's.
    pub fn new(model: &Model<D>, mut particle: Particles<D>, x: Vec<SVector<f64, D>>) -> Self {
        let particles = particle.len();
        let zeros = |count: usize| vec![SVector::zeros(); count];
        let nodes = match model.method {
            Method::Mpm(_) => model.grid.nodes(),
            Method::Otm(_) => x.len(),
        };
        let mut node = Nodes::blank(nodes);
        if let Method::Otm(_) = model.method {
            node.x = x;
        }
        let needs = model.method.needs();
        let kept = |needed: bool, count| if needed { zeros(count) } else { Vec::new() };
        particle.a = kept(needs.acceleration, particles);
        node.a_last = kept(needs.mapped_acceleration, nodes);
        node.a_next = kept(needs.next_acceleration, nodes);
        node.u = kept(needs.equilibrium, nodes);
        if model.keeps_gradient() {
            particle.G = vec![SMatrix::zeros(); particles];
        }
        let hyperelastic = model.law.law.is_hyperelastic();
        if hyperelastic && particle.F.is_empty() {
            particle.F = vec![SMatrix::identity(); particles];
        }
        particle.turned =
            vec![0.0; if hyperelastic { 0 } else { particles * Particles::<D>::PLANES }];
        if model.basis.traits().multiplier {
            particle.lambda = vec![Multiplier::default(); particles];
        }
        let metrics = if model.basis.traits().metric { particles } else { 0 };
        particle.pull = vec![SMatrix::identity(); metrics];
        if model.basis.traits().stretch {
            particle.stretch = vec![SVector::repeat(1.0); particles];
        }
        let mass = match model.mass {
            Mass::Lumped => MassMatrix::Lumped,
            Mass::Consistent => {
                MassMatrix::Consistent(Box::new(ConsistentMass::blank(nodes, &model.fixed)))
            }
        };
        let equilibrium = needs.equilibrium.then(|| Box::new(Equilibrium::blank(nodes)));
        let shape = Shape::blank(particles);
        State { particle, node, shape, mass, equilibrium, scratch: Scratch::default(), steps: 0 }
    }

    /// Gives what carries the body's mass and motion: the particles of MPM, the nodes of OTM.
    pub fn carriers(&self, method: Method) -> Carriers<'_, D> {
        match method {
            Method::Mpm(_) => self.particle.carriers(),
            Method::Otm(_) => Carriers { m: &self.node.m, x: &self.node.x, v: &self.node.v },
        }
    }

    /// Sums up what the run has cost so far.
    pub fn cost(&self) -> Cost {
        let steps = Cost { steps: self.steps, ..Cost::default() };
        let solved = self.equilibrium.as_ref().map_or(Cost::default(), |system| system.cost);
        steps
            + self.shape.cost
            + self.scratch.cost()
            + self.mass.cost()
            + self.node.cost
            + self.particle.cost
            + solved
    }
}
