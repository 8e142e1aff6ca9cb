//! Mistakes of ports in two dimensions.

use super::{Mistake, Seed};
use crate::support::kit::{STRIP, TWO_DISCS};
use lme_mpm::method::basis::{Basis, Extents, fill_from_grid};
use lme_mpm::method::continuum::loads::BodyForce;
use lme_mpm::method::continuum::sums;
use lme_mpm::method::model::State;
use lme_mpm::method::time::steps;
use nalgebra::{SMatrix, SVector};

const LINEAR: &[&str] = &[];
const WIDE: &[&str] = &["basis.kind=lme", "basis.gamma=0.8", "time.cfl=0.3"];
const NARROW: &[&str] =
    &["basis.kind=lme", "basis.gamma=12", "grid.cells=[2,1]", "grid.particles_per_cell=[8,1]"];
const NARROW_BALL: &[&str] = &[
    "basis.kind=lme",
    "basis.gamma=12",
    "basis.support=ball",
    "grid.cells=[2,1]",
    "grid.particles_per_cell=[8,1]",
];
const NEO: &[&str] = &["body.law=neo-hookean", "time.kinematics=consistent"];
const CONSISTENT: &[&str] = &["time.kinematics=consistent"];
const OTM: &[&str] = &["method=otm", "basis.kind=lme", "basis.gamma=4"];
const BSPLINE: &[&str] = &["basis.kind=bspline"];
const ALPHA: &[&str] = &["time.integrator=generalized-alpha", "time.rho_b=0.8"];

const fn strip(
    name: &'static str,
    sets: &'static [&'static str],
    seed: Seed<2>,
    shows_in: (usize, &'static str),
    says: &'static str,
) -> Mistake<2> {
    Mistake { name, base: STRIP, sets, seed, shows_in, says }
}

/// The grid, its sides, the loads, and Newmark's steps.
pub static MISTAKES: [Mistake<2>; 21] = [
    strip(
        "Δt from h_x",
        LINEAR,
        Seed::Start(|model, _| model.dt *= 0.5 / 0.3),
        (0, "dt"),
        "h the smallest of all axes",
    ),
    strip(
        "particles with y fastest",
        LINEAR,
        Seed::Start(|_, state| {
            let x = &mut state.particle;
            let order: Vec<usize> = (0..12).map(|n| n / 4 + 3 * (n % 4)).collect();
            x.x = order.iter().map(|p| x.x[*p]).collect();
            x.v = order.iter().map(|p| x.v[*p]).collect();
        }),
        (0, "x_p"),
        "x fastest",
    ),
    strip(
        "places from another origin",
        LINEAR,
        Seed::Entry(|e| {
            if e.symbol == "x_p" {
                e.value += 0.3
            }
        }),
        (0, "x_p"),
        "shifted",
    ),
    strip(
        "two particles change places",
        LINEAR,
        Seed::Start(|_, state| state.particle.x.swap(0, 5)),
        (0, "x_p"),
        "another order",
    ),
    strip(
        "ball for box",
        NARROW,
        Seed::Sets(&["basis.support=ball"]),
        (2, "N_Ip"),
        "a box or a ball",
    ),
    strip(
        "box for ball",
        NARROW_BALL,
        Seed::Sets(&["basis.support=box"]),
        (2, "N_Ip"),
        "a box or a ball",
    ),
    strip(
        "β from h_x along both axes",
        WIDE,
        Seed::After(|at, state| {
            if at.n == 2 {
                let Basis::Lme { gamma, cutoff, support } = at.model.basis else { return };
                let other = Basis::Lme { gamma: gamma * 0.36, cutoff, support };
                let mut wrong = state.clone();
                fill_from_grid(
                    &mut wrong.shape,
                    &mut wrong.scratch,
                    &mut wrong.particle.lambda,
                    &other,
                    &at.model.grid,
                    Extents::unstretched(&wrong.particle.x),
                )
                .unwrap();
                let right = state.shape.clone();
                state.shape.clear(at.model.grid.stride());
                for p in 0..state.particle.len() {
                    let (I, ..) = right.of(p).next().unwrap();
                    let (J, ..) = wrong.shape.of(p).next().unwrap();
                    let (i, j) = (at.model.grid.index(I), at.model.grid.index(J));
                    let (x, y) = (
                        right.axes(p).unwrap()[0].to_vec(),
                        wrong.shape.axes(p).unwrap()[1].to_vec(),
                    );
                    state.shape.push_product([(i[0], &x), (j[1], &y)]);
                }
            }
        }),
        (2, "N_Ip"),
        "h of each axis",
    ),
    strip(
        "no cell beyond the free side",
        LINEAR,
        Seed::Sets(&["grid.beyond.right=0"]),
        (2, "N_Ip"),
        "those beyond the body included",
    ),
    strip(
        "B-splines not adapted at the ends",
        BSPLINE,
        Seed::Entry(|e| {
            if e.symbol == "N_Ip" && e.node == Some(0) {
                e.value *= 0.75
            }
        }),
        (2, "N_Ip"),
        "sum up to 1",
    ),
    strip(
        "fixed components swapped",
        LINEAR,
        Seed::Start(|model, _| {
            model.fixed.iter_mut().filter(|(I, _)| *I > 0 && *I < 4).for_each(|(_, i)| *i = 1 - *i)
        }),
        (4, "v_I"),
        "other components or sides are fixed",
    ),
    strip(
        "roller holds both components",
        LINEAR,
        Seed::Start(|model, _| {
            let more: Vec<_> =
                model.fixed.iter().filter(|(_, i)| *i == 1).map(|(I, _)| (*I, 0)).collect();
            model.fixed.extend(more)
        }),
        (4, "v_I"),
        "too much is fixed",
    ),
    strip(
        "roller forgotten",
        LINEAR,
        Seed::Start(|model, _| model.fixed.retain(|(I, i)| *i == 0 || I % 5 == 0)),
        (4, "v_I"),
        "a fixed node keeps",
    ),
    strip(
        "force on fixed nodes",
        LINEAR,
        Seed::Instead(|at, state| {
            if at.n == 7 {
                let mut free = at.model.clone();
                free.fixed.clear();
                let State { particle, node, shape, mass, .. } = state;
                steps::balance_forces(node, particle, shape, &free, at.t);
                steps::accelerate(node, mass);
            }
            at.n == 7
        }),
        (7, "f_I"),
        "a fixed node keeps",
    ),
    strip(
        "engineering shear",
        LINEAR,
        Seed::After(|at, state| {
            if at.n == 5 {
                for d_eps in &mut state.particle.d_eps {
                    d_eps[(0, 1)] *= 2.0;
                    d_eps[(1, 0)] *= 2.0;
                }
            }
        }),
        (5, "d_eps_p"),
        "engineering shear",
    ),
    strip(
        "strain not symmetric",
        LINEAR,
        Seed::After(|at, state| {
            if at.n == 5 {
                for p in 0..state.particle.len() {
                    state.particle.d_eps[p] =
                        sums::velocity_gradient(&state.node, &state.shape, p) * at.dt;
                }
            }
        }),
        (5, "d_eps_p"),
        "only the symmetric part",
    ),
    strip(
        "plane stress",
        LINEAR,
        Seed::Start(|model, _| model.law.lambda *= 0.4 / 0.7),
        (6, "sigma_p"),
        "λ tr(Δε)",
    ),
    strip(
        "2μ for μ in the shear",
        LINEAR,
        Seed::After(|at, state| {
            if at.n == 6 {
                for p in 0..state.particle.len() {
                    let old = at.past.particle.sigma[p][(0, 1)];
                    let new = 0.5 * (state.particle.sigma[p][(0, 1)] + old);
                    state.particle.sigma[p][(0, 1)] = new;
                    state.particle.sigma[p][(1, 0)] = new;
                }
            }
        }),
        (6, "sigma_p"),
        "shear components of sigma_p are halved",
    ),
    strip(
        "gravity upwards",
        LINEAR,
        Seed::Start(|model, _| {
            if let Some(loads) = &mut model.loads {
                loads.body = Some(BodyForce::Uniform { b: SVector::from([20.0, 50.0]), ramp: 0.0 })
            }
        }),
        (7, "f_ext_I"),
        "sign of component 1",
    ),
    strip(
        "ramp forgotten",
        LINEAR,
        Seed::Start(|model, _| {
            if let Some(t) = model.loads.as_mut().and_then(|loads| loads.traction.as_mut()) {
                t.ramp = 0.0
            }
        }),
        (7, "f_ext_I"),
        "grown by the ramp",
    ),
    strip(
        "corner has one side only",
        LINEAR,
        Seed::Start(|model, _| {
            if let Some(t) = model.loads.as_mut().and_then(|loads| loads.traction.as_mut()) {
                t.layer
                    .iter_mut()
                    .filter(|(p, _)| *p == 11)
                    .for_each(|(_, f)| *f = SVector::from([6e3, 3e3]))
            }
        }),
        (7, "f_ext_I"),
        "both sides at a corner",
    ),
    Mistake {
        base: TWO_DISCS,
        ..strip(
            "velocity of the discs mirrored",
            LINEAR,
            Seed::Start(|_, state| state.particle.v.iter_mut().for_each(|v| v[1] = -v[1])),
            (0, "v_p"),
            "sign of component 1",
        )
    },
];

/// Finite strain, OTM and generalized-α in two dimensions.
pub static OF_METHODS: [Mistake<2>; 8] = [
    strip(
        "F in the wrong order",
        NEO,
        Seed::After(|at, state| {
            if at.n == 6 {
                for p in 0..state.particle.len() {
                    let f = SMatrix::identity() + state.particle.G[p];
                    state.particle.F[p] = at.past.particle.F[p] * f;
                }
            }
        }),
        (6, "F_p"),
        "from the left",
    ),
    strip(
        "G transposed",
        NEO,
        Seed::After(|at, state| {
            if at.n == 5 {
                for G in &mut state.particle.G {
                    *G = G.transpose();
                }
            }
        }),
        (5, "G_p"),
        "transposed",
    ),
    strip(
        "Kirchhoff's stress",
        NEO,
        Seed::After(|at, state| {
            if at.n == 6 {
                for p in 0..state.particle.len() {
                    let J = state.particle.F[p].determinant();
                    state.particle.sigma[p] *= J;
                }
            }
        }),
        (6, "sigma_p"),
        "over J",
    ),
    strip(
        "strain of step 5 for that of the map",
        CONSISTENT,
        Seed::After(|at, state| {
            if at.n == 5 {
                for p in 0..state.particle.len() {
                    state.particle.G[p] =
                        sums::velocity_gradient(&state.node, &state.shape, p) * at.dt;
                }
            }
        }),
        (5, "G_p"),
        "predictor's displacement",
    ),
    strip(
        "volume by the trace",
        OTM,
        Seed::After(|at, state| {
            if at.n == 4 {
                for p in 0..state.particle.len() {
                    state.particle.rho[p] =
                        at.past.particle.rho[p] / (1.0 + state.particle.G[p].trace());
                }
            }
        }),
        (4, "rho_p"),
        "det(1 + G)",
    ),
    strip(
        "G transposed",
        OTM,
        Seed::After(|at, state| {
            if at.n == 4 {
                for G in &mut state.particle.G {
                    *G = G.transpose();
                }
            }
        }),
        (4, "G_p"),
        "transposed",
    ),
    strip(
        "small strain of G",
        OTM,
        Seed::After(|at, state| {
            if at.n == 4 {
                for p in 0..state.particle.len() {
                    let G = state.particle.G[p];
                    state.particle.d_eps[p] = (G + G.transpose()) * 0.5;
                }
            }
        }),
        (4, "d_eps_p"),
        "midpoint",
    ),
    strip(
        "no acceleration at the start",
        ALPHA,
        Seed::Printed(|right| {
            right
                .iter()
                .map(|e| {
                    if e.symbol == "a_p" && e.k == 0 {
                        super::Entry { value: 0.0, ..e.clone() }
                    } else {
                        e.clone()
                    }
                })
                .collect()
        }),
        (0, "a_p"),
        "0 throughout",
    ),
];

/// Mistakes that were seeded when the causes had been written, and that none was written for.
pub static LATER: [Mistake<2>; 8] = [
    strip(
        "density times 1 + tr",
        LINEAR,
        Seed::After(|at, state| {
            if at.n == 6 {
                for p in 0..state.particle.len() {
                    state.particle.rho[p] =
                        at.past.particle.rho[p] * (1.0 + state.particle.d_eps[p].trace());
                }
            }
        }),
        (6, "rho_p"),
        "ρ/(1 + tr Δε)",
    ),
    strip(
        "trace of one axis only",
        LINEAR,
        Seed::After(|at, state| {
            if at.n == 6 {
                let law = at.model.law;
                for p in 0..state.particle.len() {
                    let e = state.particle.d_eps[p];
                    state.particle.sigma[p] -= SMatrix::identity() * (law.lambda * e[(1, 1)]);
                }
            }
        }),
        (6, "sigma_p"),
        "λ tr(Δε)",
    ),
    strip(
        "momentum of the velocity before the predictor",
        LINEAR,
        Seed::Instead(|at, state| {
            if at.n == 3 && at.k > 0 {
                let now = state.particle.v.clone();
                state.particle.v.clone_from(&at.past.particle.v);
                let State { particle, node, shape, mass, .. } = state;
                steps::transfer(node, mass, particle, shape).unwrap();
                state.particle.v = now;
                return true;
            }
            false
        }),
        (3, "p_I"),
        "velocity that the particles have by now",
    ),
    strip(
        "traction on the whole face of the cell",
        LINEAR,
        Seed::Start(|model, _| {
            if let Some(t) = model.loads.as_mut().and_then(|loads| loads.traction.as_mut()) {
                t.layer.iter_mut().for_each(|(_, f)| *f *= 2.0)
            }
        }),
        (7, "f_ext_I"),
        "own face",
    ),
    strip(
        "velocity of the nodes not divided by the mass",
        LINEAR,
        Seed::After(|at, state| {
            if at.n == 4 {
                state.node.v.clone_from(&state.node.p)
            }
        }),
        (4, "v_I"),
        "p_I",
    ),
    strip(
        "forces with the volume of the step before",
        OTM,
        Seed::Instead(|at, state| {
            if at.n == 6 {
                state.particle.rho.clone_from(&at.past.particle.rho);
            }
            false
        }),
        (6, "f_int_I"),
        "volume",
    ),
    strip(
        "nodes not kicked where f is large",
        OTM,
        Seed::After(|at, state| {
            if at.n == 1 {
                state.node.v[5].clone_from(&at.past.node.v[5])
            }
        }),
        (1, "v_I"),
        "a kick is ½",
    ),
    strip(
        "a side held that is free",
        LINEAR,
        Seed::Start(|model, _| {
            let cells = model.grid.cells;
            for j in 0..=cells[1] {
                model.fixed.push((model.grid.node([3, j]), 0));
            }
        }),
        (4, "v_I"),
        "too much is fixed",
    ),
];
