//! Mistakes of ports in one dimension.

use super::{Mistake, Seed};
use crate::support::kit::{BAR, ON_NODE};
use lme_mpm::method::basis::Basis;
use lme_mpm::method::continuum::sums;
use lme_mpm::method::model::State;
use lme_mpm::method::reading::StepEight;
use lme_mpm::method::time::generalized_alpha::{
    Parameters, average_velocity, balance_accelerations, move_particles,
};
use lme_mpm::method::time::steps;
use nalgebra::SVector;

const SMALL: &[&str] = &["grid.cells=4", "time.cfl=0.4"];
const QUARTER: &[&str] = &["grid.cells=4", "time.cfl=0.4", "body.poisson_ratio=0.25"];
const WIDE: &[&str] = &["grid.cells=4", "time.cfl=0.3", "basis.kind=lme", "basis.gamma=0.8"];
const ALPHA: &[&str] =
    &["grid.cells=4", "time.cfl=0.3", "time.integrator=generalized-alpha", "time.rho_b=0.8"];
const LAST: &[&str] =
    &["grid.cells=4", "time.cfl=0.3", "time.integrator=forward-euler", "time.stress_update=last"];
const FIRST: &[&str] =
    &["grid.cells=4", "time.cfl=0.3", "time.integrator=forward-euler", "time.stress_update=first"];
const CORRECTED: &[&str] = &["grid.cells=4", "time.cfl=0.3", "time.integrator=corrected-euler"];
const OTM: &[&str] =
    &["grid.cells=4", "time.cfl=0.3", "method=otm", "basis.kind=lme", "basis.gamma=4"];
const OTM_3: &[&str] = &[
    "grid.cells=4",
    "time.cfl=0.2",
    "method=otm",
    "basis.kind=lme",
    "basis.gamma=4",
    "grid.particles_per_cell=3",
];
const MASSES: &[&str] = &["grid.cells=4", "time.cfl=0.3", "mass=consistent"];
const UGIMP: &[&str] = &["grid.cells=4", "time.cfl=0.3", "basis.kind=ugimp"];
/// The bar of `on_node_3.csv`.
const FLIGHT: &[&str] = &ON_NODE;

const fn bar(
    name: &'static str,
    sets: &'static [&'static str],
    seed: Seed<1>,
    shows_in: (usize, &'static str),
    says: &'static str,
) -> Mistake<1> {
    Mistake { name, base: BAR, sets, seed, shows_in, says }
}

/// Sets γ of local max-ent.
fn with_gamma(basis: &mut Basis, factor: f64) {
    if let Basis::Lme { gamma, .. } = basis {
        *gamma *= factor;
    }
}

/// Newmark's steps and the start.
pub static MISTAKES: [Mistake<1>; 19] = [
    bar(
        "mass of the whole cell",
        SMALL,
        Seed::Start(|_, state| state.particle.m.iter_mut().for_each(|m| *m *= 2.0)),
        (0, "m_p"),
        "share of the body",
    ),
    bar(
        "velocity of another region",
        SMALL,
        Seed::Start(|_, state| state.particle.v.swap(1, 6)),
        (0, "v_p"),
        "region",
    ),
    bar(
        "time step from a whole CFL",
        SMALL,
        Seed::Start(|model, _| model.dt *= 0.9),
        (0, "dt"),
        "T/n",
    ),
    bar(
        "modulus E for λ + 2μ",
        QUARTER,
        Seed::Start(|model, _| (model.law.lambda, model.law.mu) = (0.0, 100e9)),
        (6, "sigma_p"),
        "λ tr(Δε)",
    ),
    bar(
        "stress of this step only",
        SMALL,
        Seed::Instead(|at, state| {
            if at.n == 6 {
                state.particle.sigma.fill(SVector::zeros());
            }
            false
        }),
        (6, "sigma_p"),
        "only what this step adds",
    ),
    bar(
        "density not updated",
        SMALL,
        Seed::After(|at, state| {
            if at.n == 6 {
                state.particle.rho.clone_from(&at.past.particle.rho)
            }
        }),
        (6, "rho_p"),
        "not changed rho_p",
    ),
    bar(
        "forces of the old stress",
        SMALL,
        Seed::Instead(|at, state| {
            if at.n == 7 {
                state.particle.sigma.clone_from(&at.past.particle.sigma);
            }
            false
        }),
        (7, "f_int_I"),
        "new σ",
    ),
    bar(
        "volume of the start",
        SMALL,
        Seed::Instead(|at, state| {
            if at.n == 7 {
                state.particle.rho.fill(7833.0);
            }
            false
        }),
        (7, "f_int_I"),
        "m_p/ρ_p is the volume",
    ),
    bar(
        "predictor with the mapped momentum",
        SMALL,
        Seed::Later(|at, state| {
            if at.n == 8 {
                for I in 0..state.node.len() {
                    state.node.v[I] = state.node.p[I] / state.node.m[I].max(1e-300);
                    let a = state.node.a[I];
                    state.node.v[I] -= a * (0.5 * at.dt);
                }
            }
        }),
        (1, "x_p"),
        "as step 8 has left it",
    ),
    bar(
        "predictor moves with v_p",
        SMALL,
        Seed::Instead(|at, state| {
            if at.n == 1 {
                let Z = &mut state.particle;
                for p in 0..Z.len() {
                    let (v, a) = (Z.v[p], Z.a[p]);
                    Z.x[p] += v * at.dt + a * (0.5 * at.dt * at.dt);
                    Z.v[p] += a * (0.5 * at.dt);
                }
            }
            at.n == 1
        }),
        (1, "x_p"),
        "not with v_p",
    ),
    bar(
        "predictor without ½ Δt² a",
        SMALL,
        Seed::Instead(|at, state| {
            if at.n == 1 {
                let State { particle, node, shape, .. } = state;
                for p in 0..particle.len() {
                    let a = particle.a[p];
                    particle.x[p] += sums::interpolate(&node.v, shape, p) * at.dt;
                    particle.v[p] += a * (0.5 * at.dt);
                }
            }
            at.n == 1
        }),
        (1, "x_p"),
        "½ Δt²",
    ),
    bar(
        "predictor takes the whole step",
        SMALL,
        Seed::After(|at, state| {
            if at.n == 1 {
                for p in 0..state.particle.len() {
                    let a = state.particle.a[p];
                    state.particle.v[p] += a * (0.5 * at.dt);
                }
            }
        }),
        (1, "v_p"),
        "factor 2; (28) is half a step",
    ),
    bar(
        "acceleration not carried",
        SMALL,
        Seed::Later(|at, state| {
            if at.n == 9 {
                state.particle.a.fill(SVector::zeros())
            }
        }),
        (1, "x_p"),
        "½ Δt²",
    ),
    bar(
        "step 8 as printed",
        SMALL,
        Seed::Instead(|at, state| {
            if at.n == 8 {
                steps::integrate_momentum(&mut state.node, at.dt, StepEight::AsPrinted);
            }
            at.n == 8
        }),
        (8, "p_I_advanced"),
        "as printed",
    ),
    bar(
        "corrector with the old N",
        SMALL,
        Seed::Instead(|at, state| {
            if at.n == 9 && at.k > 0 {
                let State { particle, node, .. } = state;
                steps::correct(particle, node, &at.past.shape, at.dt);
                return true;
            }
            false
        }),
        (9, "a_p"),
        "new N",
    ),
    bar(
        "a node without mass stands",
        FLIGHT,
        Seed::After(|at, state| {
            if at.n == 5 && at.k == 2 {
                let last = state.particle.len() - 1;
                state.particle.d_eps[last] = SVector::from([-0.25 * at.dt]);
            }
        }),
        (5, "d_eps_p"),
        "one without mass",
    ),
    bar(
        "γ = β(2h)²",
        WIDE,
        Seed::Start(|model, _| with_gamma(&mut model.basis, 4.0)),
        (2, "N_Ip"),
        "γ = βh²",
    ),
    bar("another cut-off", WIDE, Seed::Sets(&["basis.cutoff=1e-4"]), (2, "N_Ip"), "cut-off"),
    bar(
        "lumped for consistent",
        MASSES,
        Seed::Sets(&["mass=lumped"]),
        (4, "v_I"),
        "consistent mass matrix",
    ),
];

/// Steps of the other schemes and of OTM.
pub static OF_METHODS: [Mistake<1>; 23] = [
    bar(
        "half-length of uGIMP twice",
        UGIMP,
        Seed::Start(|model, _| model.basis = Basis::Ugimp { half_length: [0.5; 3] }),
        (2, "N_Ip"),
        "uGIMP's half-length",
    ),
    bar(
        "acceleration not carried",
        ALPHA,
        Seed::Later(|at, state| {
            if at.n == 7 {
                state.particle.a.fill(SVector::zeros())
            }
        }),
        (3, "a_I"),
        "not carried on",
    ),
    bar(
        "α_m = 0",
        ALPHA,
        Seed::Instead(|at, state| {
            if at.n == 5 {
                let mut wrong = Parameters::new(0.8);
                wrong.alpha_m = 0.0;
                balance_accelerations(&mut state.node, &wrong);
            }
            at.n == 5
        }),
        (5, "a_I"),
        "α_m",
    ),
    bar(
        "β of Newmark",
        ALPHA,
        Seed::Instead(|at, state| {
            if at.n == 6 {
                let mut wrong = Parameters::new(0.8);
                wrong.beta = 0.25;
                let State { particle, node, shape, .. } = state;
                move_particles(particle, node, shape, &wrong, at.dt);
            }
            at.n == 6
        }),
        (6, "x_p"),
        "weighs with β",
    ),
    bar(
        "γ = ½",
        ALPHA,
        Seed::Instead(|at, state| {
            if at.n == 6 {
                let mut wrong = Parameters::new(0.8);
                wrong.gamma = 0.5;
                let State { particle, node, shape, .. } = state;
                move_particles(particle, node, shape, &wrong, at.dt);
            }
            at.n == 6
        }),
        (6, "v_p"),
        "weighs with γ",
    ),
    bar(
        "a_p of the forces",
        ALPHA,
        Seed::After(|at, state| {
            if at.n == 6 {
                for p in 0..state.particle.len() {
                    state.particle.a[p] = sums::interpolate(&state.node.a, &state.shape, p);
                }
            }
        }),
        (6, "a_p"),
        "all of it",
    ),
    bar(
        "strain of v_I",
        ALPHA,
        Seed::Instead(|at, state| {
            if at.n == 7 {
                let State { particle, node, shape, .. } = state;
                steps::strain_material(particle, node, shape, at.model, at.dt).unwrap();
            }
            at.n == 7
        }),
        (7, "v_I"),
        "not changed v_I",
    ),
    bar(
        "strain of the advanced v_I",
        ALPHA,
        Seed::Instead(|at, state| {
            if at.n == 7 {
                for I in 0..state.node.len() {
                    let a = state.node.a_next[I];
                    state.node.v[I] += a * at.dt;
                }
                average_velocity(
                    &mut state.node,
                    &Parameters { beta: 0.0, ..Parameters::new(0.8) },
                    0.0,
                );
                let State { particle, node, shape, .. } = state;
                steps::strain_material(particle, node, shape, at.model, at.dt).unwrap();
            }
            at.n == 7
        }),
        (7, "v_I"),
        "inside (25)",
    ),
    bar(
        "stress first for stress last",
        LAST,
        Seed::Sets(&["time.stress_update=first"]),
        (4, "f_int_I"),
        "time.stress_update",
    ),
    bar(
        "stress last for stress first",
        FIRST,
        Seed::Sets(&["time.stress_update=last"]),
        (4, "f_int_I"),
        "time.stress_update",
    ),
    bar(
        "half of the force",
        LAST,
        Seed::Instead(|at, state| {
            if at.n == 5 {
                steps::advance_momentum(&mut state.node, 0.5 * at.dt);
            }
            at.n == 5
        }),
        (5, "p_I_advanced"),
        "factor 1/2",
    ),
    bar(
        "moves with the old momentum",
        LAST,
        Seed::Instead(|at, state| {
            if at.n == 6 {
                let State { particle, node, shape, .. } = state;
                let mut old = node.clone();
                for I in 0..node.len() {
                    old.v[I] -= node.a[I] * at.dt;
                }
                steps::move_with_nodes(particle, &old, shape, at.dt);
            }
            at.n == 6
        }),
        (6, "x_p"),
        "advanced momentum",
    ),
    bar(
        "velocity of the nodes in place of increments",
        LAST,
        Seed::After(|at, state| {
            if at.n == 6 {
                for p in 0..state.particle.len() {
                    state.particle.v[p] = sums::interpolate(&state.node.v, &state.shape, p);
                }
            }
        }),
        (6, "v_p"),
        "not the velocity itself",
    ),
    bar(
        "momentum not mapped anew",
        CORRECTED,
        Seed::Instead(|at, state| {
            if at.n == 7 {
                let State { particle, node, shape, .. } = state;
                steps::strain_material(particle, node, shape, at.model, at.dt).unwrap();
            }
            at.n == 7
        }),
        (7, "v_I"),
        "mapped anew",
    ),
    bar(
        "fixed node moves after the second map",
        CORRECTED,
        Seed::Instead(|at, state| {
            if at.n == 7 {
                let State { particle, node, shape, mass, .. } = state;
                steps::map_momentum_anew(node, particle, shape);
                steps::impose_essential(node, mass, &[]);
                steps::strain_material(particle, node, shape, at.model, at.dt).unwrap();
            }
            at.n == 7
        }),
        (7, "v_I"),
        "a fixed node keeps",
    ),
    bar(
        "points in the middle of shares",
        OTM,
        Seed::Start(|model, state| {
            for p in 0..state.particle.len() {
                state.particle.x[p][0] = (p as f64 + 0.5) / 2.0 * model.grid.h[0];
            }
        }),
        (0, "x_p"),
        "Gauss",
    ),
    bar(
        "equal weights",
        OTM_3,
        Seed::Start(|_, state| {
            let m = state.particle.m.iter().sum::<f64>() / state.particle.len() as f64;
            state.particle.m.fill(m)
        }),
        (0, "m_p"),
        "Gauss",
    ),
    bar(
        "a whole kick",
        OTM,
        Seed::After(|at, state| {
            if at.n == 1 {
                let (f, dt) = (state.node.f.clone(), at.dt);
                for a in 0..f.len() {
                    let m = state.node.m[a];
                    state.node.v[a] += f[a] * (0.5 * dt / m);
                }
            }
        }),
        (1, "v_I"),
        "a kick is ½",
    ),
    bar(
        "second kick with the old forces",
        OTM,
        Seed::Instead(|at, state| {
            if at.n == 7 {
                state.node.f.clone_from(&at.past.node.f);
            }
            false
        }),
        (7, "v_I"),
        "the new forces",
    ),
    bar(
        "N on the old nodes",
        OTM,
        Seed::Instead(|at, state| {
            if at.n == 5 {
                let moved = state.node.x.clone();
                state.node.x.clone_from(&at.past.node.x);
                lme_mpm::method::time::otm::tabulate_again(state, at.model).unwrap();
                state.node.x = moved;
            }
            at.n == 5
        }),
        (5, "N_Ip"),
        "where they stand now",
    ),
    bar(
        "points move with the velocity before the kick",
        OTM,
        Seed::Instead(|at, state| {
            if at.n == 3 {
                let State { particle, shape, .. } = state;
                lme_mpm::method::time::otm::move_particles(particle, &at.past.node, shape, at.dt);
            }
            at.n == 3
        }),
        (3, "x_p"),
        "points move by",
    ),
    bar(
        "masses renewed",
        OTM,
        Seed::Sets(&["nodal_mass=renewed-keeping-momentum"]),
        (7, "v_I"),
        "which stays",
    ),
    bar("nodes stand", OTM, Seed::Instead(|at, _| at.n == 2), (2, "x_I"), "not changed x_I"),
];
