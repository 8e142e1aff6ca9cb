//! Makes of a scene what the time loop needs: model and state at k = 0, loads, exact solution.

mod exact;
pub mod lattice;

pub use exact::{exact, has_exact};

use crate::method::choice::Method;
use crate::method::continuum::law::volume_change;
use crate::method::continuum::state::Particles;
use crate::method::exact::{Exact, Moved};
use crate::method::grid::Grid;
use crate::method::model::{Model, State};
use crate::scene::{Motion, Scene};
use nalgebra::{SMatrix, SVector};

/// Makes the model of a scene with D axes; D is [`Scene::dimension`], and a larger one panics.
pub fn model<const D: usize>(scene: &Scene) -> Model<D> {
    let grid = grid::<D>(scene);
    let places = lattice::places(scene);
    let fixed = match scene.method {
        Method::Mpm(_) => fixed(scene, &grid),
        Method::Otm(_) => {
            // Its nodes are the corners of the cells that hold particles.
            let corners = lattice::corners(&grid, &places);
            let number = |(I, i): (usize, usize)| Some((corners.binary_search(&I).ok()?, i));
            fixed(scene, &grid).into_iter().filter_map(number).collect()
        }
    };
    let steps = scene.step_count();
    Model {
        fixed,
        grid,
        basis: scene.basis,
        law: scene.body.elastic(),
        loads: lattice::loads(scene, &places),
        method: scene.method,
        kinematics: scene.kinematics,
        filter: scene.filter,
        reconstruction: scene.reconstruction,
        mass: scene.mass,
        dt: scene.time.end / steps,
        steps: steps as usize,
    }
}

fn grid<const D: usize>(scene: &Scene) -> Grid<D> {
    Grid::over(
        std::array::from_fn(|d| scene.body.length[d]),
        std::array::from_fn(|d| scene.grid.cells[d]),
        std::array::from_fn(|d| scene.grid.beyond[d]),
    )
}

/// Lists the material points of a scene's particles (m): where they stand at t = 0, unless the
/// motion starts displaced.
pub fn material_points<const D: usize>(scene: &Scene) -> Vec<SVector<f64, D>> {
    lattice::places(scene).iter().map(|place| place.x).collect()
}

/// Makes the state at k = 0: particles in every cell of the body, each with its share of the
/// cell's mass (unit thickness in the missing directions), moving as its region says.
pub fn initial_state<const D: usize>(model: &Model<D>, scene: &Scene) -> State<D> {
    let places = lattice::places::<D>(scene);
    let rho = scene.body.density;
    let mut particle = Particles::at_rest(places.iter().map(|place| place.x).collect(), rho);
    let exact = exact(scene);
    for (p, place) in places.iter().enumerate() {
        particle.m[p] = rho * place.volume;
        particle.v[p] = match (&scene.motion, &exact) {
            (Motion::Regions(regions), _) => {
                let region = regions.iter().find(|r| r.contains(place.x.as_slice()));
                region.map_or(SVector::zeros(), |r| {
                    SVector::from_fn(|d, _| r.velocity_at(place.x.as_slice(), d))
                })
            }
            (_, Ok(exact)) => exact.at(&place.x, 0.0).velocity,
            // A mode of more than one dimension is refused with the scene.
            (_, Err(_)) => SVector::zeros(),
        };
    }
    let nodes = match model.method {
        Method::Mpm(_) => Vec::new(),
        Method::Otm(_) => {
            let corners = lattice::corners(&model.grid, &places);
            corners.into_iter().map(|I| model.grid.position(I)).collect()
        }
    };
    let mut state = State::new(model, particle, nodes);
    if let Ok(Exact::Moved(moved)) = &exact {
        displace(&mut state, moved);
    }
    state
}

/// Puts particles, and the nodes of OTM, where a chosen motion has them at t = 0, strained and
/// stressed as there.
fn displace<const D: usize>(state: &mut State<D>, moved: &Moved<D>) {
    let particle = &mut state.particle;
    for p in 0..particle.len() {
        let X = particle.x[p];
        let (fields, F) = (moved.at(&X, 0.0), moved.deformation(&X, 0.0));
        particle.advance(p, fields.displacement);
        particle.sigma[p] = fields.stress;
        particle.rho[p] /= 1.0 + volume_change(&(F - SMatrix::identity()));
        if let Some(stretch) = particle.stretch.get_mut(p) {
            *stretch = F.diagonal();
        }
        if let Some(A_p) = particle.pull.get_mut(p) {
            // No scene has a motion without one; the first table would refuse what is no number.
            *A_p = F.try_inverse().unwrap_or(SMatrix::repeat(f64::NAN));
        }
        if let Some(F_p) = particle.F.get_mut(p) {
            *F_p = F;
        }
    }
    for x in &mut state.node.x {
        *x += moved.at(x, 0.0).displacement;
    }
}

// ANCHOR: fixed
/// Lists the nodes on or beyond a side with the components that are fixed there.
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
// ANCHOR_END: fixed
