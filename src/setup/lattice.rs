//! Says where particles stand at the start, and which of them carry a load.

use crate::method::choice::Method;
use crate::method::continuum::loads::{BodyForce, Loads, Traction};
use crate::method::exact::Exact;
use crate::method::grid::{Grid, odometer};
use crate::method::quadrature::points;
use crate::scene::{Ball, Scene};
use nalgebra::SVector;

/// A place is where a particle stands at the start, with its share of the body.
pub struct Place<const D: usize> {
    /// From the body's lower corner (m).
    pub x: SVector<f64, D>,
    /// Its number along each axis.
    number: [usize; D],
    /// Its share of the body along each axis (m).
    size: [f64; D],
    /// The product of these (m^D).
    pub volume: f64,
}

/// Lists the places of a scene's particles: some in every cell of the body's box; with balls
/// those inside one of them.
pub fn places<const D: usize>(scene: &Scene) -> Vec<Place<D>> {
    let per_cell: [usize; D] = std::array::from_fn(|d| scene.grid.particles_per_cell[d]);
    let along = std::array::from_fn(|d| scene.grid.cells[d] * per_cell[d]);
    let h = |d: usize| scene.body.length[d] / scene.grid.cells[d] as f64;
    let points: [_; D] = std::array::from_fn(|d| points(scene.method, per_cell[d]));
    // To one side and the other in turn, so that the body stays where it is.
    let aside = |d: usize, number: usize| match (scene.method, number % 2) {
        (Method::Otm(_), _) => 0.0, // its points are those of the quadrature
        (Method::Mpm(_), 0) => scene.grid.offset / per_cell[d] as f64,
        (Method::Mpm(_), _) => -scene.grid.offset / per_cell[d] as f64,
    };
    let place = |number: [usize; D]| {
        let point = |d: usize| points[d][number[d] % per_cell[d]];
        let size = std::array::from_fn(|d| match scene.method {
            Method::Mpm(_) => h(d) / per_cell[d] as f64,
            Method::Otm(_) => h(d) * point(d)[1],
        });
        Place {
            x: SVector::from_fn(|d, _| {
                let within = point(d)[0] + aside(d, number[d]);
                ((number[d] / per_cell[d]) as f64 + within) * h(d)
            }),
            number,
            size,
            volume: size.iter().product(),
        }
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

/// Lists the nodes at the corners of all cells that hold a particle, in ascending order.
pub fn corners<const D: usize>(grid: &Grid<D>, places: &[Place<D>]) -> Vec<usize> {
    let mut held = vec![false; grid.nodes()];
    for at in places.iter().filter_map(|place| grid.locate(&place.x)) {
        for corner in odometer([2; D]) {
            held[grid.node(std::array::from_fn(|d| at.cell[d] + corner[d]))] = true;
        }
    }
    (0..held.len()).filter(|I| held[*I]).collect()
}

/// Ties the loads that the scene declares to its particles.
pub fn loads<const D: usize>(scene: &Scene, places: &[Place<D>]) -> Option<Loads<D>> {
    let uniform = scene.body_force.as_ref().map(|body| BodyForce::Uniform {
        b: SVector::from_fn(|d, _| body.acceleration[d]),
        ramp: body.ramp,
    });
    let kept_going = match super::exact::exact(scene) {
        Ok(Exact::Moved(solution)) => {
            Some(BodyForce::Moved { solution, X: places.iter().map(|place| place.x).collect() })
        }
        _ => None,
    };
    let traction = scene.traction.as_ref().map(|load| {
        let mut layer: Vec<(usize, SVector<f64, D>)> = Vec::new();
        for (p, place) in places.iter().enumerate() {
            let mut force = SVector::<f64, D>::zeros();
            for axis in 0..D {
                let area: f64 = (0..D).filter(|d| *d != axis).map(|d| place.size[d]).product();
                let last = scene.grid.cells[axis] * scene.grid.particles_per_cell[axis] - 1;
                for (upper, end) in [0, last].into_iter().enumerate() {
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
    let body = uniform.or(kept_going);
    (body.is_some() || traction.is_some()).then_some(Loads { body, traction })
}
