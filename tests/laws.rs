//! Laws that hold for any data: at a point, and of the sums over particles.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::choice::Law;
use lme_mpm::method::continuum::law::{Elastic, density, symmetric_part};
use lme_mpm::method::continuum::mass::MassMatrix;
use lme_mpm::method::continuum::state::{Nodes, Particles};
use lme_mpm::method::continuum::sums;
use lme_mpm::method::grid::Grid;
use lme_mpm::method::measure;
use lme_mpm::method::model::State;
use nalgebra::{Matrix1, Matrix2, Matrix3, SMatrix, SVector, Vector2};

// ---- the pointwise laws --------------------------------------------------------

/// Hooke's law in plane strain has its textbook form, to 1e-14.
#[test]
fn law_plane_strain() {
    let (E, nu) = (210e9, 0.3);
    let law = Elastic::new(Law::Rate, E, nu);
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
    let modulus = |nu| Elastic::new(Law::Rate, 200e9, nu).p_wave_modulus();
    assert_eq!(modulus(0.0), 200e9);
    assert_relative_eq!(modulus(0.25), 200e9 * 0.75 / (1.25 * 0.5), max_relative = 1e-15);
    let eps = Matrix1::new(1e-3);
    assert_eq!(Elastic::new(Law::Rate, 200e9, 0.0).stress_increment(&eps)[0], 200e6);
}

/// ½ σ : D⁻¹ : σ of σ = D : ε is ½ σ : ε to 1e-14, in every dimension.
#[test]
fn law_energy_is_half_stress_times_strain() {
    fn check<const D: usize>(eps: SMatrix<f64, D, D>) {
        let law = Elastic::new(Law::Rate, 7.0, 0.3);
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
    sums::mass_and_momentum(&mut node, &particle, &shape);
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
    sums::mass_and_momentum(&mut node, &particle, &shape);
    for I in 0..node.len() {
        node.v[I] = Vector2::new(100.0, -50.0) + L * grid.position(I);
    }
    for p in 0..particle.len() {
        let grad_v = sums::velocity_gradient(&node, &shape, p);
        assert_relative_eq!(grad_v, L, epsilon = 1e-9);
    }
}

/// A node of tiny mass sends no particle off, however near to a face of its cell the
/// particle is: N_Ip / m_I is 1 / m_p at most, and f_I / m_I, however large, is still a
/// number, since N_Ip is 0 or not too small. One particle, from 1 down to 5e-324 cells above
/// a corner of its cell, in 1D to 3D: what it gets is Σ f_I / m_p of the nodes with mass.
#[test]
fn sums_to_particle_survives_tiny_mass() {
    fn check<const D: usize>(xi: f64) {
        let grid = Grid::over([2.0; D], [2; D], [[0, 0]; D]);
        let mut particle = Particles::at_rest(vec![SVector::repeat(xi)], 1.0);
        (particle.m[0], particle.sigma[0]) = (2.0, SMatrix::repeat(1e10));
        let shape = on_grid(&Basis::Linear, &grid, &particle.x).unwrap().shape;
        let mut node = Nodes::blank(grid.nodes());
        sums::mass_and_momentum(&mut node, &particle, &shape);
        sums::internal_force(&mut node, &particle, &shape);
        MassMatrix::Lumped.solve(&mut node.a, &node.f, &node.m);
        let with_mass = (0..node.len()).filter(|I| node.m[*I] > 0.0);
        let force: SVector<f64, D> = with_mass.map(|I| node.f[I]).sum();
        let a_p = sums::interpolate(&node.a, &shape, 0);
        assert_relative_eq!(a_p, force * 0.5, epsilon = 1e-5, max_relative = 1e-14); // of 1e10
    }
    for xi in [1.0, 0.3, 1e-20, 1e-60, 1e-100, 1e-150, 1e-279, 1e-280, 1e-281, 1e-300, 5e-324, 0.0]
    {
        check::<1>(xi);
        check::<2>(xi);
        check::<3>(xi);
    }
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
