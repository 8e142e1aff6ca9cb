//! Volumetric locking: how far a cantilever bends where the material hardly changes its volume.

use crate::support::*;
use lme_mpm::method::continuum::law::symmetric_part;
use lme_mpm::method::continuum::sums;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time::{self, otm};
use lme_mpm::run::Warning;
use nalgebra::{Vector2, vector};
use std::fmt::Write;

const LENGTH: f64 = 4.0;
const MODULUS: f64 = 1000.0;
const DENSITY: f64 = 1.0;

/// A cantilever, 4 long and 1 high, fixed on the left, under its own weight.
fn cantilever(nu: &str, sets: &[&str]) -> lme_mpm::scene::Scene {
    let text = format!(
        "title = 'cantilever'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
         body = {{ length = [{LENGTH}, 1], density = {DENSITY}, youngs_modulus = {MODULUS},\n\
                  poisson_ratio = {nu} }}\n\
         grid = {{ cells = [16, 4], particles_per_cell = [2, 2] }}\n\
         time = {{ integrator = 'newmark', cfl = 0.2, end = 0.001 }}\n\
         boundary.left = 'fixed'\nbody_force.acceleration = [0, -1]\n"
    );
    scene(&text, sets)
}

/// Finds the nodes' displacements at which the stiffness of the start's functions balances the
/// loads, by conjugate gradients with the nodal masses; gives that of the particles at the free
/// end, in its mean.
fn deflection(model: &Model<2>, state: &mut State<2>) -> f64 {
    let free = |f: &mut Vec<Vector2<f64>>, m: &[f64]| {
        for &(I, i) in &model.fixed {
            f[I][i] = 0.0;
        }
        for (f_I, m_I) in f.iter_mut().zip(m) {
            if *m_I == 0.0 {
                *f_I = Vector2::zeros();
            }
        }
    };
    let State { particle, node, shape, .. } = state;
    let m = node.m.clone();
    let mut stiff = |u: &[Vector2<f64>]| {
        node.v.copy_from_slice(u);
        for p in 0..particle.len() {
            let strain = symmetric_part(&sums::velocity_gradient(node, shape, p));
            particle.sigma[p] = model.law.stress_increment(&strain);
        }
        node.f.fill(Vector2::zeros());
        sums::internal_force(node, particle, shape);
        let mut f: Vec<Vector2<f64>> = node.f.iter().map(|f| -f).collect();
        free(&mut f, &m);
        f
    };
    let dot = |a: &[Vector2<f64>], b: &[Vector2<f64>]| -> f64 {
        a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
    };
    let precondition = |r: &[Vector2<f64>]| -> Vec<Vector2<f64>> {
        r.iter().zip(&m).map(|(r, m)| if *m > 0.0 { r / *m } else { *r }).collect()
    };
    let mut u = vec![Vector2::zeros(); m.len()];
    let mut r: Vec<Vector2<f64>> = m.iter().map(|m| vector![0.0, -m]).collect();
    free(&mut r, &m);
    let mut z = precondition(&r);
    let mut d = z.clone();
    let (mut old, first) = (dot(&r, &z), dot(&r, &z));
    let mut rest = 1.0;
    for _ in 0..20_000 {
        let q = stiff(&d);
        let alpha = old / dot(&d, &q);
        for I in 0..u.len() {
            u[I] += d[I] * alpha;
            r[I] -= q[I] * alpha;
        }
        z = precondition(&r);
        let new = dot(&r, &z);
        rest = new / first;
        if rest < 1e-18 {
            break;
        }
        for I in 0..u.len() {
            d[I] = z[I] + d[I] * (new / old);
        }
        old = new;
    }
    assert!(rest < 1e-18, "{rest:e}");
    let end = largest(state.particle.x.iter().map(|x| x[0]));
    let tip: Vec<f64> = (0..state.particle.len())
        .filter(|p| state.particle.x[*p][0] > end - 1e-9)
        .map(|p| sums::interpolate(&u, &state.shape, p)[1])
        .collect();
    -tip.iter().sum::<f64>() / tip.len() as f64
}

/// That of beam theory, bending and shear, in plane strain.
fn beam(nu: f64) -> f64 {
    let (bending, shear) =
        (MODULUS / (1.0 - nu * nu) / 12.0, MODULUS / (2.0 + 2.0 * nu) * 5.0 / 6.0);
    DENSITY * (LENGTH.powi(4) / (8.0 * bending) + LENGTH.powi(2) / (2.0 * shear))
}

/// A cantilever of 16 × 4 cells under its own weight, its deflection over that of beam theory in
/// plane strain, with the stiffness of the start's functions. The program warns from the first of
/// these ratios on at which it bends less than nine tenths as far as at 0.3, and not before; with one
/// point in each cell nothing locks.
#[test]
fn locking_of_a_cantilever() {
    let nus = ["0.3", "0.4", "0.45", "0.49", "0.499", "0.4999"];
    let mut table = format!("basis,{}\n", nus.join(","));
    for (name, sets) in [
        ("linear", &["basis.kind=linear"][..]),
        ("linear with 1 per cell", &["basis.kind=linear", "grid.particles_per_cell=[1,1]"]),
        ("uGIMP", &["basis.kind=ugimp"]),
        ("GIMP", &["basis.kind=gimp"]),
        ("dual domain", &["basis.kind=ddmp"]),
        ("B-spline", &["basis.kind=bspline"]),
        ("cubic B-spline", &["basis.kind=bspline", "basis.degree=3"]),
        ("LME 0.8", &["basis.kind=lme", "basis.gamma=0.8"]),
        ("LME 1.8", &["basis.kind=lme", "basis.gamma=1.8"]),
        ("LME 4", &["basis.kind=lme", "basis.gamma=4"]),
        ("OTM 0.8", &["method=otm", "basis.kind=lme", "basis.gamma=0.8"]),
        ("OTM 4", &["method=otm", "basis.kind=lme", "basis.gamma=4"]),
        (
            "OTM 4 with 1 per cell",
            &["method=otm", "basis.kind=lme", "basis.gamma=4", "grid.particles_per_cell=[1,1]"],
        ),
    ] {
        let ratios = nus.map(|nu| {
            let (model, mut state) = at_start::<2>(&cantilever(nu, sets));
            match model.method.moves_nodes() {
                true => otm::start(&mut state, &model).unwrap(),
                false => time::start(&mut state, &model, &mut |_, _| {}).unwrap(),
            }
            deflection(&model, &mut state) / beam(nu.parse().unwrap())
        });
        let locks = |n: &usize| ratios[*n] < 0.9 * ratios[0];
        let warned = |n: &usize| Warning::locking(&cantilever(nus[*n], sets)).is_some();
        let from = |tells: &dyn Fn(&usize) -> bool| (0..nus.len()).find(|n| tells(n));
        assert_eq!(from(&warned), from(&locks), "{name}: {ratios:?}");
        let shown = ratios.map(|ratio| format!("{ratio:.2}"));
        writeln!(table, "{name},{}", shown.join(",")).unwrap();
    }
    approve("locking__cantilever", &table);
}
