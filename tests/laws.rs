//! Laws that hold for any data: at a point, and of the sums over particles.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::continuum::law::{LinearElastic, density, symmetric_part};
use lme_mpm::method::continuum::shape::Shape;
use lme_mpm::method::continuum::state::{Nodes, Particles};
use lme_mpm::method::continuum::sums;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::measure;
use lme_mpm::method::model::State;
use nalgebra::{Matrix1, Matrix2, Matrix3, SMatrix, Vector1, Vector2};

// ---- the pointwise laws --------------------------------------------------------

/// Hooke's law in plane strain has its textbook form, to 1e-14.
#[test]
fn law_plane_strain() {
    let (E, nu) = (210e9, 0.3);
    let law = LinearElastic::new(E, nu);
    let eps = Matrix2::new(1e-3, 2e-4, 2e-4, -4e-4);
    let sigma = law.stress_increment(&eps);
    let factor = E / ((1.0 + nu) * (1.0 - 2.0 * nu));
    assert_relative_eq!(
        sigma[(0, 0)],
        factor * ((1.0 - nu) * 1e-3 - nu * 4e-4),
        max_relative = 1e-14
    );
    assert_relative_eq!(
        sigma[(1, 1)],
        factor * (nu * 1e-3 - (1.0 - nu) * 4e-4),
        max_relative = 1e-14
    );
    assert_relative_eq!(sigma[(0, 1)], E / (1.0 + nu) * 2e-4, max_relative = 1e-14);
    assert_eq!(sigma[(0, 1)], sigma[(1, 0)]);
}

/// In 1D the modulus is E(1−ν)/((1+ν)(1−2ν)), and E for ν = 0.
#[test]
fn law_uniaxial_strain() {
    let modulus = |nu| LinearElastic::new(200e9, nu).p_wave_modulus();
    assert_eq!(modulus(0.0), 200e9);
    assert_relative_eq!(modulus(0.25), 200e9 * 0.75 / (1.25 * 0.5), max_relative = 1e-15);
    let eps = Matrix1::new(1e-3);
    assert_eq!(LinearElastic::new(200e9, 0.0).stress_increment(&eps)[0], 200e6);
}

/// ½ σ : D⁻¹ : σ of σ = D : ε is ½ σ : ε to 1e-14, in every dimension.
#[test]
fn law_energy_is_half_stress_times_strain() {
    fn check<const D: usize>(eps: SMatrix<f64, D, D>) {
        let law = LinearElastic::new(7.0, 0.3);
        let sigma = law.stress_increment(&eps);
        let half = 0.5 * sigma.dot(&eps);
        assert_relative_eq!(law.energy_density(&sigma), half, max_relative = 1e-14);
    }
    let eps = Matrix3::new(0.3, 0.1, -0.2, 0.1, -0.4, 0.05, -0.2, 0.05, 0.2);
    check(eps);
    check(eps.fixed_view::<2, 2>(0, 0).into_owned());
    check(Matrix1::new(0.3));
}

/// (2) of a rotation is zero, and (17) refuses to turn material inside out.
#[test]
fn law_rotation_and_inversion() {
    assert_eq!(symmetric_part(&Matrix2::new(0.0, -3.0, 3.0, 0.0)), Matrix2::zeros());
    assert_eq!(symmetric_part(&Matrix2::new(1.0, 4.0, 2.0, 5.0)), Matrix2::new(1.0, 3.0, 3.0, 5.0));
    assert_eq!(density(10.0, &Matrix2::new(0.2, 9.0, 9.0, 0.05)), Some(8.0));
    assert_eq!(density(1.0, &Matrix2::new(-0.5, 0.0, 0.0, -0.5)), None);
    assert_eq!(density(1.0, &Matrix2::new(f64::NAN, 0.0, 0.0, 0.0)), None);
}

// ---- the sums ------------------------------------------------------------------

/// A strip of 40 × 3 cells whose particles are moved off their places and have velocities
/// and stresses all of their own, tabulated.
fn scattered() -> (Grid<2>, State<2>) {
    let (model, mut state) = at_start::<2>(&strip(2, &["initial_velocity=[]"]));
    for p in 0..state.particle.len() {
        let s = p as f64;
        state.particle.x[p] += Vector2::new((1.7 * s).sin(), (2.3 * s).cos()) * 1e-4;
        state.particle.v[p] = Vector2::new((0.3 * s).sin(), (0.7 * s).cos());
        state.particle.sigma[p] = Matrix2::new(s.sin(), s.cos(), s.cos(), (2.0 * s).sin()) * 1e6;
    }
    state.shape = on_grid(&Basis::Linear, &model.grid, &state.particle.x).unwrap().shape;
    (model.grid, state)
}

/// Σ_I m_I = Σ_p m_p and Σ_I p_I = Σ_p m_p v_p, to ε for each particle.
#[test]
fn sums_keep_mass_and_momentum() {
    let (_, State { particle, mut node, shape, .. }) = scattered();
    sums::lumped_mass(&mut node, &particle, &shape);
    sums::momentum(&mut node, &particle, &shape);
    let mass: f64 = node.m.iter().sum();
    let round_off = particle.len() as f64 * f64::EPSILON;
    assert_relative_eq!(mass, particle.m.iter().sum::<f64>(), max_relative = round_off);
    let momentum: Vector2<f64> = node.p.iter().sum();
    let expected = measure::momentum(&particle.carriers());
    assert_relative_eq!(momentum, expected, epsilon = round_off * mass);
}

/// Internal forces do no net work on a rigid motion: Σ_I f_I = 0 and, since σ is
/// symmetric, Σ_I x_I × f_I = 0, to 1e-14 of the sum of their sizes.
#[test]
fn sums_internal_force_is_in_balance() {
    let (grid, State { particle, mut node, shape, .. }) = scattered();
    sums::internal_force(&mut node, &particle, &shape);
    let scale: f64 = node.f.iter().map(|f| f.norm()).sum();
    let force: Vector2<f64> = node.f.iter().sum();
    let torque: f64 = (0..node.len()).map(|I| grid.position(I).perp(&node.f[I])).sum();
    assert!(scale > 1e3);
    assert!(force.norm() < 1e-14 * scale, "{force:?}");
    assert!(torque.abs() < 1e-14 * scale, "{torque:e}");
}

/// An affine velocity of the nodes gives its gradient at every particle, to 1e-9.
#[test]
fn sums_velocity_gradient_of_affine_motion() {
    let (grid, State { particle, mut node, shape, .. }) = scattered();
    let L = Matrix2::new(0.3, -0.7, 0.2, 0.9);
    sums::lumped_mass(&mut node, &particle, &shape);
    for I in 0..node.len() {
        node.v[I] = Vector2::new(100.0, -50.0) + L * grid.position(I);
    }
    for p in 0..particle.len() {
        let grad_v = sums::velocity_gradient(&node, &shape, p);
        assert_relative_eq!(grad_v, L, epsilon = 1e-9);
    }
}

/// A node with a mass 1e-300 times that of its neighbour sends no particle off: f_I/m_I
/// alone would be 5e309; mapped, both parts are f/m_p.
#[test]
fn sums_to_particle_survives_tiny_mass() {
    let mut shape = Shape::<1>::blank(0);
    shape.push(0, 1.0, Vector1::new(-1.0));
    shape.push(1, 1e-300, Vector1::new(1.0));
    shape.end_row();
    let at_rest = Particles::at_rest(vec![Vector1::new(0.0)], 1.0);
    let particle = Particles { m: vec![2.0], ..at_rest };
    let mut node = Nodes::<1>::blank(2);
    sums::lumped_mass(&mut node, &particle, &shape);
    let force = [2e10, -1e10].map(Vector1::new);
    let a = sums::to_particle(&force, &node, &shape, 0);
    assert_eq!(a[0], 0.5 * (2e10 - 1e10));
}

/// Nodes on a fixed side, and those beyond it, are fixed, component by
/// component; no others.
#[test]
fn model_fixes_the_nodes_of_a_side() {
    let sets = ["boundary={ left = { x = 'fixed' }, top = 'fixed' }", "grid.beyond={ left = 1 }"];
    let (model, _) = at_start::<2>(&strip(2, &sets));
    assert_eq!(model.grid.cells, [42, 4]); // 1 + 40 + 1 and 1 + 3 + 0
    let mut expected = Vec::new();
    for I in 0..model.grid.nodes() {
        let [i, j] = model.grid.index(I);
        let (left, top) = (i <= 1, j >= 4);
        expected.extend((left || top).then_some((I, 0)));
        expected.extend(top.then_some((I, 1)));
    }
    assert_eq!(model.fixed, expected);
}
