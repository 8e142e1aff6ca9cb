//! Where particles stand at the start, and which of them carry a load.
#![allow(non_snake_case)]

use crate::continuum::loads::{BodyForce, Loads, Traction};
use crate::exact::Exact;
use crate::grid::{Grid, odometer};
use crate::scene::{Ball, Method, Scene};
use nalgebra::SVector;

/// Where a particle stands at the start.
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

/// The `n` points of a cell along one axis: place (0 to 1) and length (in units of
/// the cell). MPM: equal distances. OTM: Gauss's points, which integrate
/// polynomials up to the degree 2n − 1.
pub fn points(method: Method, n: usize) -> Vec<[f64; 2]> {
    let about_middle = |list: &[[f64; 2]]| -> Vec<[f64; 2]> {
        list.iter().map(|[r, w]| [0.5 + 0.5 * r, 0.5 * w]).collect()
    };
    match (method, n) {
        (Method::Mpm(_), _) | (_, 1) => {
            (0..n).map(|k| [(k as f64 + 0.5) / n as f64, 1.0 / n as f64]).collect()
        }
        (Method::Otm, 2) => {
            let r = 1.0 / libm::sqrt(3.0);
            about_middle(&[[-r, 1.0], [r, 1.0]])
        }
        (Method::Otm, 3) => {
            let r = libm::sqrt(0.6);
            about_middle(&[[-r, 5.0 / 9.0], [0.0, 8.0 / 9.0], [r, 5.0 / 9.0]])
        }
        (Method::Otm, _) => {
            let (middle, spread) = (3.0 / 7.0, 2.0 / 7.0 * libm::sqrt(1.2));
            let (near, far) = (libm::sqrt(middle - spread), libm::sqrt(middle + spread));
            let share = libm::sqrt(30.0) / 36.0;
            let (large, small) = (0.5 + share, 0.5 - share);
            about_middle(&[[-far, small], [-near, large], [near, large], [far, small]])
        }
    }
}

/// The particles of a scene: some in every cell of the body's box; with balls
/// those inside one of them.
pub fn places<const D: usize>(scene: &Scene) -> Vec<Place<D>> {
    let per_cell: [usize; D] = std::array::from_fn(|d| scene.grid.particles_per_cell[d]);
    let along = std::array::from_fn(|d| scene.grid.cells[d] * per_cell[d]);
    let h = |d: usize| scene.body.length[d] / scene.grid.cells[d] as f64;
    let points: [_; D] = std::array::from_fn(|d| points(scene.method, per_cell[d]));
    let place = |number: [usize; D]| {
        let point = |d: usize| points[d][number[d] % per_cell[d]];
        let size = std::array::from_fn(|d| match scene.method {
            Method::Mpm(_) => h(d) / per_cell[d] as f64,
            Method::Otm => h(d) * point(d)[1],
        });
        Place {
            x: SVector::from_fn(|d, _| ((number[d] / per_cell[d]) as f64 + point(d)[0]) * h(d)),
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

/// The nodes at the corners of all cells that hold a particle, in ascending order.
pub fn corners<const D: usize>(grid: &Grid<D>, places: &[Place<D>]) -> Vec<usize> {
    let mut held = vec![false; grid.nodes()];
    for at in places.iter().filter_map(|place| grid.locate(&place.x)) {
        for corner in odometer([2; D]) {
            held[grid.node(std::array::from_fn(|d| at.cell[d] + corner[d]))] = true;
        }
    }
    (0..held.len()).filter(|I| held[*I]).collect()
}

/// The loads that the scene declares, tied to its particles.
pub fn loads<const D: usize>(scene: &Scene, places: &[Place<D>]) -> Option<Loads<D>> {
    let uniform = scene.body_force.as_ref().map(|body| BodyForce::Uniform {
        b: SVector::from_fn(|d, _| body.acceleration[d]),
        ramp: body.ramp,
    });
    let manufactured = match Exact::of(scene) {
        Ok(Exact::Manufactured(solution)) => Some(BodyForce::Manufactured {
            solution,
            X: places.iter().map(|place| place.x[0]).collect(),
        }),
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
    let body = uniform.or(manufactured);
    (body.is_some() || traction.is_some()).then_some(Loads { body, traction })
}
