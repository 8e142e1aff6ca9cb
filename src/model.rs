//! From a scene to what the time loop needs: grid, law, boundary, Δt, and the
//! state at k = 0.
#![allow(non_snake_case)]

use crate::basis::{Basis, Scratch, support};
use crate::continuum::law::LinearElastic;
use crate::continuum::loads::Loads;
use crate::continuum::mass::ConsistentMass;
use crate::continuum::shape::Shape;
use crate::continuum::state::{Nodes, Particles, State};
use crate::exact::Exact;
use crate::grid::Grid;
use crate::lattice;
use crate::scene::{Body, Mass, Method, Motion, Scene};
use nalgebra::{SMatrix, SVector};

/// The fixed components of nodes, as pairs (I, i).
pub type Fixed = [(usize, usize)];

/// All that stays the same from step to step.
#[derive(Clone, Debug, PartialEq)]
pub struct Model<const D: usize> {
    pub grid: Grid<D>,
    pub basis: Basis,
    pub law: LinearElastic,
    /// Node I has zero velocity component i.
    pub fixed: Vec<(usize, usize)>,
    pub loads: Option<Loads<D>>,
    pub method: Method,
    pub mass: Mass,
    /// Δt (s).
    pub dt: f64,
    /// N_t, the number of time steps.
    pub steps: usize,
}

/// c = √((λ + 2μ) / ρ) (m/s), the speed of a plane wave, (46) in the bar.
pub fn wave_speed(body: &Body) -> f64 {
    let law = LinearElastic::new(body.youngs_modulus, body.poisson_ratio);
    libm::sqrt(law.p_wave_modulus() / body.density)
}

impl Scene {
    /// The smallest spacing (m).
    fn spacing(&self) -> f64 {
        let per_axis = self.body.length.iter().zip(&self.grid.cells);
        per_axis.map(|(length, cells)| length / *cells as f64).fold(f64::INFINITY, f64::min)
    }

    // ANCHOR: step_count
    /// N_t: as many equal steps as keep c Δt / h at or below `time.cfl`.
    ///
    /// A count within 1e-9 (relative) of a whole number is that number, so that
    /// an end given to ten digits does not cost a step; the Courant number may
    /// then exceed the bound by as much.
    fn step_count(&self) -> f64 {
        let count = self.time.end * wave_speed(&self.body) / (self.time.cfl * self.spacing());
        let whole = libm::round(count);
        let close = (count - whole).abs() <= 1e-9 * whole;
        if close && whole > 0.0 { whole } else { libm::ceil(count).max(1.0) }
    }
    // ANCHOR_END: step_count

    /// Numbers of particles, nodes and time steps, before anything is built.
    pub fn sizes(&self) -> (f64, f64, f64) {
        let (mut particles, mut nodes) = (1.0, 1.0);
        for d in 0..self.dimension() {
            let cells = self.grid.cells[d] as f64;
            let [before, after] = self.grid.beyond[d].map(|n| n as f64);
            particles *= cells * self.grid.particles_per_cell[d] as f64;
            nodes *= before + cells + after + 1.0;
        }
        (particles, nodes, self.step_count())
    }

    /// The most nodes that a particle can see, before anything is built.
    pub fn pairs_per_particle(&self) -> f64 {
        let along = |d: usize| {
            let [before, after] = self.grid.beyond[d];
            let nodes = (before + self.grid.cells[d] + after) as f64 + 1.0;
            match self.basis {
                Basis::Linear => 2.0,
                Basis::Ugimp { .. } | Basis::BSpline => 3.0,
                Basis::Lme { gamma, cutoff } => {
                    (2.0 * support::radius(gamma, cutoff) + 2.0).min(nodes)
                }
            }
        };
        (0..self.dimension()).map(along).product()
    }

    /// c Δt / h of a time step (s).
    pub fn courant_number_of(&self, dt: f64) -> f64 {
        wave_speed(&self.body) * dt / self.spacing()
    }

    /// c Δt / h of the run, at or below `time.cfl`.
    pub fn courant_number(&self) -> f64 {
        wave_speed(&self.body) * self.time.end / (self.step_count() * self.spacing())
    }
}

impl<const D: usize> Model<D> {
    /// The model of a scene with D axes.
    pub fn of(scene: &Scene) -> Self {
        let axes = |list: &[usize]| std::array::from_fn(|d| list[d]);
        let grid = Grid::over(
            std::array::from_fn(|d| scene.body.length[d]),
            axes(&scene.grid.cells),
            std::array::from_fn(|d| scene.grid.beyond[d]),
        );
        let steps = scene.step_count();
        Model {
            fixed: match scene.method {
                Method::Mpm(_) => fixed(scene, &grid),
                Method::Otm => {
                    let corners = lattice::corners(&grid, &lattice::places(scene));
                    let number = |(I, i): (usize, usize)| {
                        corners.binary_search(&I).ok().map(|number| (number, i))
                    };
                    fixed(scene, &grid).into_iter().filter_map(number).collect()
                }
            },
            grid,
            basis: scene.basis,
            law: LinearElastic::new(scene.body.youngs_modulus, scene.body.poisson_ratio),
            loads: lattice::loads(scene, &lattice::places::<D>(scene)),
            method: scene.method,
            mass: scene.mass,
            dt: scene.time.end / steps,
            steps: steps as usize,
        }
    }

    /// The state at k = 0: particles in every cell of the body, each with its
    /// share of the cell's mass (unit thickness in the missing directions), moving
    /// as its region says.
    pub fn initial_state(&self, scene: &Scene) -> State<D> {
        let places = lattice::places::<D>(scene);
        let (count, rho) = (places.len(), scene.body.density);
        let mut particle = Particles::at_rest(places.iter().map(|place| place.x).collect(), rho);
        for (m, place) in particle.m.iter_mut().zip(&places) {
            *m = rho * place.volume;
        }
        let exact = Exact::of(scene);
        for p in 0..particle.len() {
            let x_p = particle.x[p];
            match (&scene.motion, &exact) {
                (Motion::Regions(regions), _) => {
                    if let Some(region) = regions.iter().find(|r| r.contains(x_p.as_slice())) {
                        particle.v[p] = SVector::from_fn(|d, _| region.velocity[d]);
                    }
                }
                (_, Ok(exact)) => particle.v[p] = SVector::repeat(exact.at(x_p[0], 0.0).velocity),
                // A mode of more than one dimension is refused with the scene.
                (_, Err(_)) => {}
            }
        }
        let shape = Shape::blank(count);
        let node = match self.method {
            Method::Mpm(_) => Nodes::blank(self.grid.nodes()),
            Method::Otm => {
                particle.F = vec![SMatrix::identity(); count];
                let x = lattice::corners(&self.grid, &places);
                Nodes {
                    x: x.into_iter().map(|I| self.grid.position(I)).collect(),
                    ..Nodes::blank(0)
                }
            }
        };
        let mass = match self.mass {
            Mass::Lumped => None,
            Mass::Consistent => Some(ConsistentMass::blank(node.len(), &self.fixed)),
        };
        State { particle, node, shape, mass, scratch: Scratch::default() }
    }
}

/// Nodes on or beyond a side with fixed components.
fn fixed<const D: usize>(scene: &Scene, grid: &Grid<D>) -> Vec<(usize, usize)> {
    let mut fixed = Vec::new();
    for I in 0..grid.nodes() {
        let index = grid.index(I);
        for i in 0..D {
            let holds = (0..D).any(|axis| {
                let [lower, upper] = &scene.boundary[axis];
                let first = grid.before[axis];
                let last = first + scene.grid.cells[axis];
                (lower.fixed[i] && index[axis] <= first) || (upper.fixed[i] && index[axis] >= last)
            });
            if holds {
                fixed.push((I, i));
            }
        }
    }
    fixed
}
