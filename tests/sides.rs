//! A strip is the bar: the sides of a body in 2D and 3D, and what they hold.

use crate::support::*;
use approx::assert_relative_eq;
use lme_mpm::method::continuum::mass::{ConsistentMass, MassMatrix};
use lme_mpm::method::continuum::sums;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time::steps;
use lme_mpm::scene::Scene;
use nalgebra::{Matrix2, SMatrix, SVector, Vector2};
use std::fmt::Write;

/// A problem that a bar and a strip share.
#[derive(Clone, Copy)]
struct Problem {
    name: &'static str,
    poisson_ratio: f64,
    /// What moves, counted from 0: the axis of the strip, or one across it.
    component: usize,
    /// Of the long sides, in 3D: bottom and top, back and front.
    held: [&'static str; 2],
}

/// The long sides hold their normal: the modulus is λ + 2μ.
const ROLLERS: Problem =
    Problem { name: "rollers", poisson_ratio: 0.3, component: 0, held: ["y", "z"] };

/// They hold their tangent: the modulus is μ. The body moves along y, through bottom and top.
const SHEAR: Problem =
    Problem { name: "shear wave", poisson_ratio: 0.3, component: 1, held: ["x", "z"] };

/// They are free, and ν = 0 lets them rest.
const FREE: Problem =
    Problem { name: "free sides", poisson_ratio: 0.0, component: 0, held: ["", ""] };

const PROBLEMS: [Problem; 3] = [ROLLERS, SHEAR, FREE];

/// Along the axis.
const CELLS: usize = 5;
const STEPS: usize = 6;

impl Problem {
    /// The shear wave's strain is so small that the bar, which it stretches, keeps its length.
    fn velocity(&self) -> f64 {
        if self.component == 0 { 0.05 } else { 1e-13 }
    }

    /// The scene with `cells` across it, none for the bar. Thrown, pulled and under gravity,
    /// for Δt = 0.2 h/c of its own wave.
    fn scene(&self, cells: &[usize], sets: &[&str]) -> Scene {
        let dimension = 1 + cells.len();
        let list = |first: &str, across: &dyn Fn(usize) -> String| {
            let entries = (0..dimension).map(|d| match d {
                0 => first.to_string(),
                d => across(d),
            });
            format!("[{}]", entries.collect::<Vec<_>>().join(", "))
        };
        let along = |x: f64| {
            let component = if dimension == 1 { 0 } else { self.component };
            let entries = (0..dimension).map(|d| if d == component { x } else { 0.0 });
            format!("{:?}", entries.collect::<Vec<_>>())
        };
        let nu = self.poisson_ratio;
        let shear_modulus = 1.0 / (2.0 + 2.0 * nu);
        let modulus = match self.component {
            0 => (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            _ => shear_modulus,
        };
        // The bar of a shear wave has E = μ.
        let (E, nu) = match (self.component, dimension) {
            (1, 1) => (shear_modulus, 0.0),
            _ => (1.0, nu),
        };
        let h = 1.0 / CELLS as f64;
        let v = self.velocity();
        let mut text = format!(
            "title = 'strip'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
             body = {{ length = {}, density = 1, youngs_modulus = {E}, poisson_ratio = {nu} }}\n\
             grid = {{ cells = {}, particles_per_cell = {} }}\n\
             time = {{ integrator = 'newmark', cfl = 1, end = {} }}\n\
             traction.right = {}\nbody_force.acceleration = {}\nboundary.left = 'fixed'\n",
            list("1", &|d| (0.15 * cells[d - 1] as f64).to_string()),
            list(&CELLS.to_string(), &|d| cells[d - 1].to_string()),
            list("2", &|_| "2".into()),
            0.2 * h / modulus.sqrt() * STEPS as f64,
            along(-0.4 * v * modulus),
            along(0.5 * v),
        );
        let long_sides = [["bottom", "top"], ["back", "front"]];
        for (pair, held) in long_sides.iter().zip(self.held).take(dimension - 1) {
            for side in pair.iter().filter(|_| !held.is_empty()) {
                writeln!(text, "boundary.{side}.{held} = 'fixed'").unwrap();
            }
        }
        let to = list("1", &|d| (0.15 * cells[d - 1] as f64).to_string());
        let from = list("0.5", &|_| "0".into());
        let velocity = along(v);
        writeln!(
            text,
            "initial_velocity = [{{ from = {from}, to = {to}, velocity = {velocity} }}]"
        )
        .unwrap();
        scene(&text, sets)
    }

    /// Takes the steps. The particles of MPM stand a quarter of a cell off their places along
    /// the axis, just before nodes and midpoints, which they cross where they move at all;
    /// those of uGIMP touch no node from outside, which the least motion would switch on.
    fn ran<const D: usize>(&self, cells: &[usize], sets: &[&str]) -> (Model<D>, State<D>) {
        let (mut model, mut state) = at_start::<D>(&self.scene(cells, sets));
        model.dt *= model.steps as f64 / STEPS as f64;
        if !model.method.moves_nodes() {
            for x in &mut state.particle.x {
                x[0] += 0.245 * model.grid.h[0];
            }
        }
        march(&model, &mut state, STEPS);
        (model, state)
    }

    /// How far the strip is from the bar: the largest distance of a velocity or stress,
    /// anything across included, over the largest of the bar. `own` changes the strip only.
    fn apart<const D: usize>(&self, cells: &[usize], sets: &[&str], own: &[&str]) -> f64 {
        let (bar_model, bar) = self.ran::<1>(&[], sets);
        let (model, strip) = self.ran::<D>(cells, &[sets, own].concat());
        let (bar_carriers, carriers) =
            (bar.carriers(bar_model.method), strip.carriers(model.method));
        let c = self.component;
        let v =
            carriers.v.iter().zip(bar_carriers.v.iter().cycle()).flat_map(|(v, bar)| {
                (0..D).map(move |d| if d == c { v[d] - bar[0] } else { v[d] })
            });
        let (sigma, bar_sigma) = (&strip.particle.sigma, &bar.particle.sigma);
        let sigma = sigma.iter().zip(bar_sigma.iter().cycle()).map(|(s, bar)| s[(0, c)] - bar[0]);
        let scale_v = largest(bar_carriers.v.iter().map(|v| v[0]));
        let scale_sigma = largest(bar_sigma.iter().map(|sigma| sigma[0]));
        assert!(scale_v > 0.5 * self.velocity() && scale_sigma > 0.1 * self.velocity());
        let end = bar_carriers.x.last().unwrap()[0];
        assert!(c == 1 || end > 1.0, "the last particle has not passed the end: {end}");
        (largest(v) / scale_v).max(largest(sigma) / scale_sigma)
    }
}

/// A strip in 2D and 3D is the bar, to 1e-10 of the largest velocity and stress: every basis,
/// mass matrix and scheme, three problems, six steps in which particles cross cells, two
/// cells across.
#[test]
fn strip_is_the_bar() {
    let mut failed = String::new();
    for problem in PROBLEMS {
        for basis in BASES {
            for mass in MASSES {
                for scheme in SCHEMES {
                    let sets = [basis.sets, mass.sets, scheme.sets].concat();
                    let off = [
                        problem.apart::<2>(&[2], &sets, &[]),
                        problem.apart::<3>(&[2, 1], &sets, &[]),
                    ];
                    if !(off[0] < 1e-10 && off[1] < 1e-10) {
                        let case = [problem.name, basis.name, mass.name, scheme.name].join(", ");
                        writeln!(failed, "{case}: {:.1e} {:.1e}", off[0], off[1]).unwrap();
                    }
                }
            }
        }
    }
    assert!(failed.is_empty(), "\n{failed}");
}

/// So it is with every law and either reading of the strain, between rollers, with the bases
/// that differ most.
#[test]
fn strip_is_the_bar_with_every_law() {
    for law in ["rate", "neo-hookean", "hencky"] {
        for strain in ["as-printed", "consistent"] {
            let own = [format!("body.law={law}"), format!("time.kinematics={strain}")];
            for BasisCase { name, sets, .. } in [LINEAR, LME_WIDE] {
                let sets = [sets, CONSISTENT.sets, &strs(&own)].concat();
                let off = ROLLERS.apart::<2>(&[2], &sets, &[]);
                assert!(off < 1e-10, "{law}, {strain}, {name}: {off:e}");
            }
        }
    }
}

/// Local max-ent in a ball and OTM are the bar as well where nothing is cut off, for then the
/// functions are products: two cells across, all three problems.
#[test]
fn strip_is_the_bar_where_nothing_is_cut_off() {
    let ball = ["basis.cutoff=0", "basis.support=ball"];
    for problem in PROBLEMS {
        for mass in MASSES {
            let sets = [LME_MIDDLE.sets, mass.sets, &ball].concat();
            let off = problem.apart::<2>(&[2], &sets, &[]);
            // The rule for light nodes knows no axes in a ball.
            let is_bar = mass == LUMPED;
            assert_eq!(off < 1e-10, is_bar, "{}, {}: {off:e}", problem.name, mass.name);
        }
        let otm = [LME_MIDDLE.sets, &["method=otm", "basis.cutoff=0"]].concat();
        let off = problem.apart::<2>(&[2], &otm, &[]);
        assert!(off < 1e-10, "{}, otm: {off:e}", problem.name);
    }
}

/// Where a strip is not the bar, and by how much: local max-ent on three cells across, whose
/// inner nodes the sum over particles does not balance; a cell beyond a side that is held; the
/// cut-off by a ball. 2D, Newmark.
#[test]
fn strip_is_not_the_bar() {
    let mut table = String::from(
        "basis,mass,\"rollers, three cells\",\"shear wave, three cells\",\
         \"shear wave, a cell beyond\",\"free sides, ball\"\n",
    );
    let beyond = "grid.beyond={ bottom = 1, top = 1 }";
    for basis in BASES {
        for mass in MASSES {
            let sets = [basis.sets, mass.sets].concat();
            let is_lme = [LME_WIDE, LME_MIDDLE, LME_NARROW].contains(&basis);
            let off = [
                Some(ROLLERS.apart::<2>(&[3], &sets, &[])),
                Some(SHEAR.apart::<2>(&[3], &sets, &[])),
                Some(SHEAR.apart::<2>(&[3], &sets, &[beyond])),
                is_lme.then(|| FREE.apart::<2>(&[2], &sets, &["basis.support=ball"])),
            ];
            for off in &off[..2] {
                assert_eq!(off.unwrap() < 1e-10, !is_lme, "{}, {}", basis.name, mass.name);
            }
            let words = off.map(|off| off.map_or("".into(), size));
            writeln!(table, "{},{},{}", basis.name, mass.name, words.join(",")).unwrap();
        }
    }
    approve("sides__strip", &table);
}

/// A side that holds any component is the last of the grid, but for uGIMP, whose particles
/// reach beyond it; a free one has a cell beyond it.
#[test]
fn side_that_holds_is_the_last_of_the_grid() {
    let beyond = |problem: &Problem, sets: &[&str]| problem.scene(&[2, 1], sets).grid.beyond;
    for BasisCase { sets, .. } in BASES {
        let held = usize::from(sets == UGIMP.sets);
        let around = [held, held];
        assert_eq!(beyond(&ROLLERS, sets), [[held, 1], around, around]);
        assert_eq!(beyond(&SHEAR, sets), [[held, 1], around, around]);
        assert_eq!(beyond(&FREE, sets), [[held, 1], [1, 1], [1, 1]]);
        let room = "grid.beyond={ bottom = 2 }";
        assert_eq!(beyond(&SHEAR, &[sets, &[room]].concat())[1], [2, held]);
    }
}

/// A size in a table; below 1e-10 it is round-off.
fn size(x: f64) -> String {
    if x < 1e-10 { "round-off".into() } else { format!("{x:.1e}") }
}

/// σ of the patch (Pa): that of rollers all around, and of tractions on free sides.
const SIGMA: [f64; 2] = [1.0, -0.5];

/// A block of 4 × 3 cells for the patch tests, with ν = 0.3; free under tractions that balance
/// SIGMA, or between rollers.
fn patch(rollers: bool, sets: &[&str]) -> Scene {
    let [x, y] = SIGMA;
    let sides = match rollers {
        true => "boundary.left.x = 'fixed'\nboundary.right.x = 'fixed'\n\
                 boundary.bottom.y = 'fixed'\nboundary.top.y = 'fixed'\n"
            .to_string(),
        false => format!(
            "traction.left = [{}, 0]\ntraction.right = [{x}, 0]\n\
             traction.bottom = [0, {}]\ntraction.top = [0, {y}]\n",
            -x, -y
        ),
    };
    let text = format!(
        "title = 'patch'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
         body = {{ length = [4, 3], density = 1, youngs_modulus = 1, poisson_ratio = 0.3 }}\n\
         grid = {{ cells = [4, 3], particles_per_cell = [2, 2] }}\n\
         time = {{ integrator = 'newmark', cfl = 0.2, end = 1 }}\n{sides}"
    );
    scene(&text, sets)
}

/// The state of a scene with its table and nodal masses; particles on their places, or moved
/// off them by up to a fifth of a cell.
fn tabulated<const D: usize>(scene: &Scene, moved: bool) -> (Model<D>, State<D>) {
    let (model, mut state) = at_start::<D>(scene);
    let State { particle, node, shape, mass, scratch, .. } = &mut state;
    for (p, x) in particle.x.iter_mut().enumerate().filter(|_| moved) {
        *x += SVector::from_fn(|d, _| 0.2 * model.grid.h[d] * (1.7 * p as f64 + d as f64).sin());
    }
    steps::tabulate(shape, scratch, particle, &model).unwrap();
    steps::transfer(node, mass, particle, shape).unwrap();
    (model, state)
}

/// Nodes with an affine velocity give every particle its strain rate, to 1e-12: in 2D and 3D,
/// on their places and off them, with every basis, with rollers and free.
#[test]
fn patch_of_uniform_strain_rate() {
    fn off<const D: usize>(scene: &Scene, moved: bool) -> f64 {
        let (model, mut state) = tabulated::<D>(scene, moved);
        let A = SMatrix::<f64, D, D>::from_fn(|i, j| (1.0 + i as f64 - 2.3 * j as f64).sin());
        for I in 0..state.node.len() {
            state.node.v[I] = A * model.grid.position(I);
        }
        steps::increment_strain(&mut state.particle, &state.node, &state.shape, 1.0);
        let expected = (A + A.transpose()) * 0.5;
        largest(state.particle.d_eps.iter().map(|d_eps| (d_eps - expected).amax()))
    }
    for BasisCase { name, sets, .. } in BASES {
        for moved in [false, true] {
            for rollers in [false, true] {
                let off = off::<2>(&patch(rollers, sets), moved);
                assert!(off < 1e-12, "{name}, {moved}, {rollers}: {off:e}");
            }
            let off = off::<3>(&FREE.scene(&[2, 1], sets), moved);
            assert!(off < 1e-12, "{name}, {moved}, 3D: {off:e}");
        }
    }
}

/// What the masses make of an affine velocity of the particles, by how much the strain rate of
/// a particle is off; and how far uniform stress is from rest: the largest acceleration of a
/// particle, times ρh/σ. Between rollers that is round-off where the sum over particles
/// integrates ∇N exactly: on their places with linear functions, uGIMP and B-splines. Else it
/// is larger with the consistent matrix than with the lumped one, and under tractions, and of
/// moved particles, least with local max-ent, γ = 0.8.
#[test]
fn patch_of_uniform_stress() {
    let mut table = String::from(
        "basis,particles,mass,strain rate free,strain rate between rollers,\
         acceleration under tractions,acceleration between rollers\n",
    );
    let mut accelerations: Vec<(BasisCase, bool, [f64; 4])> = Vec::new();
    for basis in BASES {
        for moved in [false, true] {
            let [lumped, consistent] = MASSES.map(|mass| {
                let sets = [basis.sets, mass.sets].concat();
                let [free, rollers] = [false, true].map(|rollers| {
                    let (model, mut state) = tabulated::<2>(&patch(rollers, &sets), moved);
                    [strain_rate_off(&model, &mut state), acceleration(&model, &mut state)]
                });
                let place = if moved { "moved" } else { "on their places" };
                let row = [free[0], rollers[0], free[1], rollers[1]].map(size).join(",");
                writeln!(table, "{},{place},{},{row}", basis.name, mass.name).unwrap();
                [free[1], rollers[1]]
            });
            let exact = !moved && [LINEAR, UGIMP, BSPLINE].contains(&basis);
            let case = format!("{}, {moved}: {lumped:?} {consistent:?}", basis.name);
            assert!(lumped[0] > 0.1 && consistent[0] > lumped[0], "{case}");
            match exact {
                true => assert!(lumped[1] < 1e-12 && consistent[1] < 1e-12, "{case}"),
                false => assert!(lumped[1] > 1e-12 && consistent[1] > lumped[1], "{case}"),
            }
            let felt = [lumped[0], consistent[0], lumped[1], consistent[1]];
            accelerations.push((basis, moved, felt));
        }
    }
    for moved in [false, true] {
        let at = |wide: bool| {
            let of = accelerations.iter().filter(move |(_, of, _)| *of == moved);
            of.filter(move |(basis, ..)| (*basis == LME_WIDE) == wide).map(|(.., felt)| felt)
        };
        // Between rollers others are at rest, as long as particles are on their places.
        let wide = at(true).next().unwrap();
        for n in 0..if moved { 4 } else { 2 } {
            assert!(at(false).all(|other| wide[n] < other[n]), "{moved}, {n}");
        }
    }
    approve("sides__patch", &table);
}

/// Gives the particles an affine velocity, and says by how much their strain rate is off.
fn strain_rate_off(model: &Model<2>, state: &mut State<2>) -> f64 {
    let State { particle, node, shape, .. } = state;
    let A = Matrix2::new(1.0, -0.5, 0.75, -0.25);
    for p in 0..particle.len() {
        particle.v[p] = A * particle.x[p];
    }
    node.p.fill(Vector2::zeros());
    sums::momentum(node, particle, shape);
    // No node is held: this is about the mass.
    let mut mass = match &state.mass {
        MassMatrix::Lumped => MassMatrix::Lumped,
        MassMatrix::Consistent(_) => {
            MassMatrix::Consistent(Box::new(ConsistentMass::blank(model.grid.nodes(), &[])))
        }
    };
    mass.assemble(particle, shape, &node.m).unwrap();
    mass.solve(&mut node.v, &node.p, &node.m);
    steps::increment_strain(particle, node, shape, 1.0);
    let expected = (A + A.transpose()) * 0.5;
    largest(particle.d_eps.iter().map(|d_eps| (d_eps - expected).amax()))
}

/// Gives the particles the patch's stress and no velocity, and returns the largest
/// acceleration.
fn acceleration(model: &Model<2>, state: &mut State<2>) -> f64 {
    let State { particle, node, shape, mass, .. } = state;
    particle.sigma.fill(Matrix2::from_diagonal(&Vector2::from(SIGMA)));
    steps::balance_forces(node, particle, shape, model, 0.0);
    steps::accelerate(node, mass);
    largest((0..particle.len()).map(|p| sums::interpolate(&node.a, shape, p).amax()))
}

/// A traction acts on the particles behind its side, half their distance inside: its force is
/// exact, and its moment about the other side is low by 1/(2n), with n particles between the
/// two: 2% for 25, 8% for 6. The forces of the nodes say the same, with every basis.
#[test]
fn traction_acts_half_a_particle_inside() {
    for (cells, per_cell) in [(3, 2), (5, 2), (6, 4), (25, 1)] {
        for basis in BASES {
            let text = "title = 'arm'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
                 body = { length = [2, 1], density = 1, youngs_modulus = 1, poisson_ratio = 0 }\n\
                 grid = { cells = [CELLS, 2], particles_per_cell = [EACH, 2] }\n\
                 time = { integrator = 'newmark', cfl = 0.2, end = 1 }\n\
                 traction.right = [0, 3]\n";
            let text = text.replace("CELLS", &cells.to_string());
            let scene = scene(&text.replace("EACH", &per_cell.to_string()), basis.sets);
            let (model, mut state) = tabulated::<2>(&scene, false);
            let State { particle, node, shape, .. } = &mut state;
            steps::balance_forces(node, particle, shape, &model, 0.0);
            let force: f64 = node.f.iter().map(|f| f[1]).sum();
            let arm = |I: usize| model.grid.position(I)[0];
            let moment: f64 = (0..node.len()).map(|I| arm(I) * node.f[I][1]).sum();
            let n = f64::from(cells * per_cell);
            assert_relative_eq!(force, 3.0, max_relative = 1e-13);
            assert_relative_eq!(moment, 3.0 * 2.0 * (1.0 - 0.5 / n), max_relative = 1e-12);
        }
    }
}
