//! From a scene to what the time loop needs: grid, law, boundary, Δt, and the
//! state at k = 0.
#![allow(non_snake_case)]

use crate::basis::{Basis, Scratch, support};
use crate::continuum::law::LinearElastic;
use crate::continuum::loads::{BodyForce, Loads, Traction};
use crate::continuum::mass::ConsistentMass;
use crate::continuum::shape::Shape;
use crate::continuum::state::{Nodes, Particles, State};
use crate::exact::Exact;
use crate::grid::{Grid, odometer};
use crate::scene::{Ball, Body, Mass, Motion, Scene};
use crate::time::Integrator;
use nalgebra::SVector;

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
    pub integrator: Integrator,
    pub loads: Option<Loads<D>>,
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
            fixed: fixed(scene, &grid),
            grid,
            basis: scene.basis,
            law: LinearElastic::new(scene.body.youngs_modulus, scene.body.poisson_ratio),
            integrator: scene.time.integrator,
            loads: loads(scene, &lattice::<D>(scene)),
            mass: scene.mass,
            dt: scene.time.end / steps,
            steps: steps as usize,
        }
    }

    /// The state at k = 0: particles at equal distances in every cell of the
    /// body, each with an equal share of the cell's mass (unit thickness in
    /// the missing directions), moving as its region says.
    pub fn initial_state(&self, scene: &Scene) -> State<D> {
        let x: Vec<SVector<f64, D>> = lattice(scene).into_iter().map(|place| place.x).collect();
        let per_cell = |d: usize| scene.grid.particles_per_cell[d] as f64;
        let share: f64 = (0..D).map(|d| self.grid.h[d] / per_cell(d)).product();
        let (count, rho) = (x.len(), scene.body.density);
        let mut particle = Particles::at_rest(x, rho * share, rho);
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
        let node = Nodes::blank(self.grid.nodes());
        let mass = match self.mass {
            Mass::Lumped => None,
            Mass::Consistent => Some(ConsistentMass::blank(node.len(), &self.fixed)),
        };
        State { particle, node, shape, mass, scratch: Scratch::default() }
    }
}

/// Where a particle stands at the start.
struct Place<const D: usize> {
    x: SVector<f64, D>,
    /// Its number along each axis.
    number: [usize; D],
}

/// Particles at equal distances in every cell of the body's box; with balls
/// those inside one of them.
fn lattice<const D: usize>(scene: &Scene) -> Vec<Place<D>> {
    let per_cell: [usize; D] = std::array::from_fn(|d| scene.grid.particles_per_cell[d]);
    let along = std::array::from_fn(|d| scene.grid.cells[d] * per_cell[d]);
    let place = |number: [usize; D]| Place {
        number,
        x: SVector::from_fn(|d, _| {
            let (cell, within) = (number[d] / per_cell[d], number[d] % per_cell[d]);
            let xi = (within as f64 + 0.5) / per_cell[d] as f64;
            (cell as f64 + xi) * (scene.body.length[d] / scene.grid.cells[d] as f64)
        }),
    };
    let balls = &scene.body.balls;
    let material = |place: &Place<D>| {
        let inside = |ball: &Ball| {
            let r: SVector<f64, D> = SVector::from_fn(|d, _| place.x[d] - ball.centre[d]);
            r.dot(&r) <= ball.radius * ball.radius
        };
        balls.is_empty() || balls.iter().any(inside)
    };
    odometer(along).map(place).filter(material).collect()
}

/// The loads that the scene declares, tied to its particles.
fn loads<const D: usize>(scene: &Scene, lattice: &[Place<D>]) -> Option<Loads<D>> {
    let uniform = scene.body_force.as_ref().map(|body| BodyForce::Uniform {
        b: SVector::from_fn(|d, _| body.acceleration[d]),
        ramp: body.ramp,
    });
    let manufactured = match Exact::of(scene) {
        Ok(Exact::Manufactured(solution)) => Some(BodyForce::Manufactured {
            solution,
            X: lattice.iter().map(|place| place.x[0]).collect(),
        }),
        _ => None,
    };
    let along = |d: usize| scene.grid.cells[d] * scene.grid.particles_per_cell[d];
    let distance = |d: usize| scene.body.length[d] / along(d) as f64;
    let traction = scene.traction.as_ref().map(|load| {
        let mut layer: Vec<(usize, SVector<f64, D>)> = Vec::new();
        for (p, place) in lattice.iter().enumerate() {
            let mut force = SVector::<f64, D>::zeros();
            for axis in 0..D {
                let area: f64 = (0..D).filter(|d| *d != axis).map(distance).product();
                for (upper, end) in [0, along(axis) - 1].into_iter().enumerate() {
                    if place.number[axis] == end {
                        let t: &[f64] = &load.sides[axis][upper];
                        force += SVector::<f64, D>::from_fn(|d, _| t[d]) * area;
                    }
                }
            }
            if force != SVector::<f64, D>::zeros() {
                layer.push((p, force));
            }
        }
        Traction { layer, ramp: load.ramp }
    });
    let body = uniform.or(manufactured);
    (body.is_some() || traction.is_some()).then_some(Loads { body, traction })
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
