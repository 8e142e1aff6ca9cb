//! Each step of the Algorithm by itself, against numbers worked by hand.
//!
//! Three nodes at 0, 1, 2; node 0 is fixed. Three particles of volume 1:
//!
//! | p | x | m = ρ | v | σ | nodes | N |
//! |---|---|---|---|---|---|---|
//! | 0 | 0.25 | 2 | 1 | 8 | 0, 1 | 0.75, 0.25 |
//! | 1 | 0.75 | 4 | 3 | 16 | 0, 1 | 0.25, 0.75 |
//! | 2 | 1.5 | 8 | −2 | −4 | 1, 2 | 0.5, 0.5 |

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::method::choice::{Integrator, Law, Mass, Method};
use lme_mpm::method::continuum::law::Elastic;
use lme_mpm::method::continuum::loads::{BodyForce, Loads, Traction};
use lme_mpm::method::continuum::mass::{ConsistentMass, MassMatrix};
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::{Nodes, Particles};
use lme_mpm::method::continuum::sums;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::reading::{Kinematics, StepEight};
use lme_mpm::method::time::generalized_alpha::{self, Parameters};
use lme_mpm::method::time::steps;
use nalgebra::Vector1;

const DT: f64 = 0.25;
const FIXED: [(usize, usize); 1] = [(0, 0)];
/// m_I and p_I of step 3.
const M: [f64; 3] = [2.5, 7.5, 4.0];
const P: [f64; 3] = [4.5, 1.5, -8.0];
/// f_I of (14), before the boundary takes node 0.
const F: [f64; 3] = [24.0, -28.0, 4.0];

fn setup() -> (Particles<1>, Nodes<1>, Shape<1>) {
    let x = [0.25, 0.75, 1.5].map(Vector1::new).to_vec();
    let mut particle = Particles::at_rest(x, 1.0);
    particle.m = vec![2.0, 4.0, 8.0];
    particle.a = vec![Vector1::new(0.0); 3];
    particle.rho = vec![2.0, 4.0, 8.0];
    particle.v = [1.0, 3.0, -2.0].map(Vector1::new).to_vec();
    particle.sigma = [8.0, 16.0, -4.0].map(Vector1::new).to_vec();
    let grid = Grid::over([2.0], [2], [[0, 0]]);
    let shape = on_grid(&Basis::Linear, &grid, &particle.x).unwrap().shape;
    (particle, Nodes::blank(3), shape)
}

/// Nodes after steps 3 and 7, node 0 fixed.
fn with_nodal_values(node: &mut Nodes<1>) {
    node.m = M.to_vec();
    node.p = [0.0, P[1], P[2]].map(Vector1::new).to_vec();
    node.f = [0.0, F[1], F[2]].map(Vector1::new).to_vec();
    node.v = [0.0, 0.2, -2.0].map(Vector1::new).to_vec();
    node.a = [0.0, -56.0 / 15.0, 1.0].map(Vector1::new).to_vec();
}

fn scalars(list: &[Vector1<f64>]) -> Vec<f64> {
    list.iter().map(|x| x[0]).collect()
}

/// Particles, nodes and the pairs of a table are counted.
#[test]
fn containers_know_their_size() {
    let (particle, node, shape) = setup();
    assert_eq!((particle.len(), node.len(), shape.len()), (3, 3, 6));
}

/// (27) (28): p_I/m_I = 0, 0.2, −2 reach the particles through N; what f_I/m_I = 0,
/// −56/15, 1 give them is known.
#[test]
fn step_1_predict() {
    let (mut particle, mut node, shape) = setup();
    with_nodal_values(&mut node);
    let a_1 = -56.0 / 15.0;
    let a = [0.25 * a_1, 0.75 * a_1, 0.5 * a_1 + 0.5];
    particle.a = a.map(Vector1::new).to_vec(); // as the corrector has left it
    steps::predict(&mut particle, &node, &shape, DT);
    let v = [0.25 * 0.2, 0.75 * 0.2, 0.5 * 0.2 - 1.0];
    let (x, start) = ([0.25, 0.75, 1.5], [1.0, 3.0, -2.0]);
    for p in 0..3 {
        let expected = x[p] + DT * v[p] + 0.5 * DT * DT * a[p];
        assert_relative_eq!(particle.x[p][0], expected, max_relative = 1e-15);
        let expected = start[p] + 0.5 * DT * a[p];
        assert_relative_eq!(particle.v[p][0], expected, max_relative = 1e-15);
    }
}

/// All that a step wrote to the nodes is gone.
#[test]
fn step_2_discard() {
    let (_, mut node, _) = setup();
    with_nodal_values(&mut node);
    node.v[1][0] = 7.0;
    steps::discard(&mut node);
    assert_eq!(node, Nodes::blank(3));
}

/// m_I = Σ N m of (18) and p_I = Σ N m v: node 1 gets a quarter of particle 0, three
/// quarters of particle 1 and half of particle 2.
#[test]
fn step_3_transfer() {
    let (particle, mut node, shape) = setup();
    steps::transfer(&mut node, &mut MassMatrix::Lumped, &particle, &shape).unwrap();
    assert_eq!(node.m, M);
    assert_eq!(scalars(&node.p), P);
}

/// The fixed node loses its momentum, and v_I = p_I/m_I; a node without mass
/// keeps the velocity 0 and gives no NaN.
#[test]
fn step_4_impose_essential() {
    let (particle, mut node, shape) = setup();
    steps::transfer(&mut node, &mut MassMatrix::Lumped, &particle, &shape).unwrap();
    node.m.push(0.0);
    for list in [&mut node.p, &mut node.v] {
        list.push(Vector1::new(0.0));
    }
    steps::impose_essential(&mut node, &mut MassMatrix::Lumped, &FIXED);
    assert_eq!(scalars(&node.p), [0.0, 1.5, -8.0, 0.0]);
    assert_eq!(scalars(&node.v), [0.0, 0.2, -2.0, 0.0]);
}

/// (12) with node 0 fixed: 4.375 v_1 + 2 v_2 = 1.5 and 2 v_1 + 2 v_2 = −8 give
/// v = 4, −8; p_I stays what the particles brought.
#[test]
fn step_4_with_the_consistent_mass() {
    let (particle, mut node, shape) = setup();
    let mut mass = MassMatrix::Consistent(Box::new(ConsistentMass::blank(3, &FIXED)));
    steps::transfer(&mut node, &mut mass, &particle, &shape).unwrap();
    steps::impose_essential(&mut node, &mut mass, &FIXED);
    for (v, expected) in scalars(&node.v).iter().zip([0.0, 4.0, -8.0]) {
        assert_relative_eq!(*v, expected, max_relative = 1e-14);
    }
    assert_eq!(scalars(&node.p), [0.0, P[1], P[2]]);
    assert_eq!(mass.cost().solves, 1);
}

/// Δε = Δt (v_2 − v_1)/h in each cell: 0.25 · 0.2 and 0.25 · (−2.2).
#[test]
fn step_5_increment_strain() {
    let (mut particle, mut node, shape) = setup();
    node.m = M.to_vec();
    node.v = [0.0, 0.2, -2.0].map(Vector1::new).to_vec();
    steps::increment_strain(&mut particle, &node, &shape, DT);
    for (d_eps, expected) in scalars(&particle.d_eps).iter().zip([0.05, 0.05, -0.55]) {
        assert_relative_eq!(*d_eps, expected, max_relative = 1e-15);
    }
}

/// (17): ρ / (1 + tr Δε), and a particle that this would turn inside out is named.
#[test]
fn step_6_update_density() {
    let (mut particle, _, _) = setup();
    particle.d_eps = [0.25, -0.5, 1.0].map(Vector1::new).to_vec();
    steps::update_density(&mut particle).unwrap();
    assert_eq!(particle.rho, [1.6, 8.0, 4.0]);
    particle.d_eps[1][0] = -1.0;
    let fault = steps::update_density(&mut particle).unwrap_err();
    assert_eq!(fault, Breakdown::Inverted { particle: 1, strain: -1.0 });
}

/// (3), which the Algorithm forgets: σ += E Δε.
#[test]
fn step_6_update_stress() {
    let (mut particle, _, _) = setup();
    particle.d_eps = [0.25, -0.5, 1.0].map(Vector1::new).to_vec();
    steps::update_stress(&mut particle, &Elastic::new(Law::Rate, 100.0, 0.0));
    assert_eq!(scalars(&particle.sigma), [33.0, -34.0, 96.0]);
}

/// f_I = −Σ σ ∇N V: node 1 feels −8 − 16 − 4, node 2 feels 4; node 0 is fixed.
#[test]
fn step_7_balance_forces() {
    let (particle, mut node, shape) = setup();
    let balance = |node: &mut Nodes<1>, model: &Model<1>, t: f64| {
        steps::discard(node);
        steps::balance_forces(node, &particle, &shape, model, t);
    };
    balance(&mut node, &model(&[], None), 0.0);
    assert_eq!(scalars(&node.f), F);
    balance(&mut node, &model(&FIXED, None), 0.0);
    assert_eq!(scalars(&node.f), [0.0, F[1], F[2]]);
    // (15): a body force adds b m_I; a force on particle 2 goes to nodes 1 and 2
    // in halves. Half of each after half of the ramp.
    let uniform = BodyForce::Uniform { b: Vector1::new(-2.0), ramp: 4.0 };
    let layer = vec![(2, Vector1::new(24.0))];
    let loads = Loads { body: Some(uniform), traction: Some(Traction { layer, ramp: 4.0 }) };
    balance(&mut node, &model(&[], Some(loads)), 2.0);
    assert_eq!(scalars(&node.f), [F[0] - M[0], F[1] - M[1] + 6.0, F[2] - M[2] + 6.0]);
    assert_eq!((node.cost.body_forces, node.cost.tractions), (3, 1));
}

fn model(fixed: &[(usize, usize)], loads: Option<Loads<1>>) -> Model<1> {
    Model {
        grid: Grid::over([2.0], [2], [[0, 0]]),
        basis: Basis::Linear,
        law: Elastic::new(Law::Rate, 100.0, 0.0),
        fixed: fixed.to_vec(),
        loads,
        mass: Mass::Lumped,
        method: Method::Mpm(Integrator::CorrectedEuler),
        kinematics: Kinematics::AsPrinted,
        filter: None,
        reconstruction: None,
        dt: DT,
        steps: 1,
    }
}

/// p_I += γ f_I Δt, or f_I Δt as printed; and v_I stays p_I / m_I.
#[test]
fn step_8_integrate_momentum() {
    for (reading, share) in [(StepEight::SecondOrder, 0.5), (StepEight::AsPrinted, 1.0)] {
        let (_, mut node, _) = setup();
        with_nodal_values(&mut node);
        steps::integrate_momentum(&mut node, DT, reading);
        let expected = [0.0, 1.5 - 28.0 * share * DT, -8.0 + 4.0 * share * DT];
        assert_eq!(scalars(&node.p), expected);
        for I in 0..3 {
            assert_relative_eq!(node.v[I][0], expected[I] / M[I], epsilon = 1e-15);
        }
    }
}

/// (29): the second half of the velocity's increment; a_p is kept for the predictor.
#[test]
fn step_9_correct() {
    let (mut particle, mut node, shape) = setup();
    with_nodal_values(&mut node);
    steps::correct(&mut particle, &node, &shape, DT);
    let a_1 = -56.0 / 15.0;
    let expected = [
        1.0 + 0.5 * DT * 0.25 * a_1,
        3.0 + 0.5 * DT * 0.75 * a_1,
        -2.0 + 0.5 * DT * (0.5 * a_1 + 0.5),
    ];
    for (v, expected) in scalars(&particle.v).iter().zip(expected) {
        assert_relative_eq!(*v, expected, max_relative = 1e-15);
    }
    for (a, expected) in scalars(&particle.a).iter().zip([0.25 * a_1, 0.75 * a_1, 0.5 * a_1 + 0.5])
    {
        assert_relative_eq!(*a, expected, max_relative = 1e-15);
    }
    assert_eq!(scalars(&particle.x), [0.25, 0.75, 1.5], "step 9 moves nothing");
}

/// A particle on node 1 sees node 2 with N = 0; that node has no mass, and no quotient
/// of zeros comes from it.
#[test]
fn nodes_without_mass_divide_nothing() {
    let grid = Grid::over([2.0], [2], [[0, 0]]);
    let mut particle = Particles::at_rest(vec![Vector1::new(1.0)], 2.0);
    (particle.m, particle.a) = (vec![2.0], vec![Vector1::new(3.0)]);
    let mut node = Nodes::blank(3);
    (node.a_last, node.a_next) = (node.v.clone(), node.v.clone());
    let shape = on_grid(&Basis::Linear, &grid, &particle.x).unwrap().shape;
    assert!(shape.of(0).any(|(I, N, _)| N == 0.0 && I != 1), "the point of this test");
    sums::mass_and_momentum(&mut node, &particle, &shape);
    assert_eq!(node.m, [0.0, 2.0, 0.0]);
    steps::map_acceleration(&mut node, &mut MassMatrix::Lumped, &particle, &shape, &[]);
    assert_eq!(scalars(&node.a_last), [0.0, 3.0, 0.0]);
    node.f[1] = Vector1::new(8.0);
    steps::accelerate(&mut node, &mut MassMatrix::Lumped);
    assert_eq!(scalars(&node.a), [0.0, 4.0, 0.0]);
    let parameters = Parameters::new(0.8);
    generalized_alpha::balance_accelerations(&mut node, &parameters);
    let expected = (4.0 - 3.0 * parameters.alpha_m) / (1.0 - parameters.alpha_m);
    assert_eq!(scalars(&node.a_next), [0.0, expected, 0.0]);
    assert_eq!(sums::interpolate(&node.a, &shape, 0)[0], 4.0);
}

/// A value that is not finite is named with its particle.
#[test]
fn step_ends_with_finite_values() {
    let (particle, _, _) = setup();
    steps::finite(&particle).unwrap();
    for (symbol, p) in [("position", 0), ("velocity", 1), ("stress", 2)] {
        let mut broken = particle.clone();
        match symbol {
            "position" => broken.x[p][0] = f64::INFINITY,
            "velocity" => broken.v[p][0] = f64::NAN,
            _ => broken.sigma[p][0] = f64::NEG_INFINITY,
        }
        let fault = steps::finite(&broken).unwrap_err();
        assert_eq!(fault, Breakdown::NotFinite { particle: p, symbol });
    }
    for rho in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut broken = particle.clone();
        broken.rho[1] = rho;
        let fault = steps::finite(&broken).unwrap_err();
        assert_eq!(fault, Breakdown::NotFinite { particle: 1, symbol: "density" });
    }
}

/// A place that is not a number is named so, and one beyond the grid as that.
#[test]
fn step_2_names_a_place_that_it_cannot_serve() {
    let (model, mut state) = at_start::<1>(&dyka(&[]));
    let mut tabulated = |x: f64| {
        let State { particle, shape, scratch, .. } = &mut state;
        particle.x[7] = Vector1::new(x);
        steps::tabulate(shape, scratch, particle, &model)
    };
    assert_eq!(tabulated(0.05), Ok(()));
    let not_finite = Breakdown::NotFinite { particle: 7, symbol: "position" };
    assert_eq!(tabulated(f64::NAN), Err(not_finite.clone()));
    assert_eq!(tabulated(f64::INFINITY), Err(not_finite));
    let left = Breakdown::LeftGrid { particle: 7, position: vec![3.0] };
    assert_eq!(tabulated(3.0), Err(left));
}
