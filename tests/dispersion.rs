//! How fast waves of different lengths travel: predicted by Fourier analysis of one cell of an
//! endless row, and measured by running a mode on a bar.

use crate::support::figures::{self, Dispersion};
use crate::support::lines::{Dash, Frame, Line, lines};
use crate::support::*;
use kuva::prelude::MarkerShape::{self, *};
use lme_mpm::method::model::Model;
use lme_mpm::method::time;
use lme_mpm::scene::Scene;
use std::f64::consts::PI;
use std::fmt::Write;

/// A bar of 64 cells with h = c = ρ = 1, which swings in mode 8n: waves of 16/n cells. It runs
/// until the exact wave has done a quarter of its period, and so far from what the ends do to
/// the 16 cells in the middle.
const ROW: &str = "title = 'Row'\nmethod = 'mpm'\n\
     body = { length = 64, density = 1, youngs_modulus = 1, poisson_ratio = 0 }\n\
     grid = { cells = 64, particles_per_cell = 2 }\nbasis.kind = 'linear'\n\
     time = { integrator = 'newmark', cfl = 0.01, end = 1 }\n\
     boundary = { left = 'fixed', right = 'fixed' }\n\
     vibration = { mode = 8, velocity = 1e-7 }\n";

const ROW_BASES: [(&str, Sets); 7] = [
    ("linear", &[]),
    ("uGIMP", &["basis.kind=ugimp"]),
    ("B-spline, quadratic", &["basis.kind=bspline"]),
    ("B-spline, cubic", &["basis.kind=bspline", "basis.degree=3"]),
    ("LME γ = 0.8", &["basis.kind=lme", "basis.gamma=0.8"]),
    ("LME γ = 1.8", &["basis.kind=lme", "basis.gamma=1.8"]),
    ("LME γ = 4", &["basis.kind=lme", "basis.gamma=4"]),
];

/// Each basis has a marker of its own.
const MARKERS: [MarkerShape; 7] = [Circle, Plus, Square, Cross, Diamond, Triangle, TriangleDown];

/// The particles of one cell in the middle of the row, and of sixteen.
const CELL: std::ops::Range<usize> = 64..66;
const MIDDLE: std::ops::Range<usize> = 48..80;

/// The waves that are measured, θ = nπ/8.
const WAVES: std::ops::RangeInclusive<usize> = 1..=7;

fn row(basis: Sets, mass: &MassCase, wave: usize) -> Scene {
    let theta = PI / 8.0 * wave as f64;
    let more = [format!("vibration.mode={}", 8 * wave), format!("time.end={}", 0.5 * PI / theta)];
    let sets = [basis, mass.sets, &strs(&more)].concat();
    scene(ROW, &sets)
}

/// K(θ) h/E and M(θ)/(ρh) of the row, with two particles in each cell at their places:
/// ½ Σ_p |Σ_I h∇N_Ip e^{iθI}|² and ½ Σ_p |Σ_I N_Ip e^{iθI}|².
fn symbols(model: &Model<1>, x: &[nalgebra::Vector1<f64>], theta: f64) -> [f64; 2] {
    let table = on_grid(&model.basis, &model.grid, x).unwrap().shape;
    let mut symbols = [0.0; 2];
    for p in 0..x.len() {
        let [mut slope, mut value] = [[0.0; 2]; 2];
        for (I, N, grad_N) in table.of(p) {
            let angle = theta * I as f64;
            for (part, e) in [libm::cos(angle), libm::sin(angle)].into_iter().enumerate() {
                slope[part] += grad_N[0] * e;
                value[part] += N * e;
            }
        }
        symbols[0] += 0.5 * (slope[0] * slope[0] + slope[1] * slope[1]);
        symbols[1] += 0.5 * (value[0] * value[0] + value[1] * value[1]);
    }
    symbols
}

/// ω(θ)/(cθ): ω² = s K/M_L with the filter s = M/M_L of the trip to the particles and back,
/// lumped, and K/M, consistent.
pub(crate) fn predicted(basis: Sets, mass: &MassCase, theta: f64) -> f64 {
    let (model, state) = at_start::<1>(&row(basis, mass, 1));
    let [stiffness, filter] = symbols(&model, &state.particle.x[CELL], theta);
    let square = if *mass == LUMPED { stiffness * filter } else { stiffness / filter };
    square.sqrt() / theta
}

/// ω(θ)/(cθ) from the stress of the middle, which grows as sin ωt: at 2t it is 2 cos ωt times
/// what it is at t. The leapfrog's ω is (2/Δt) sin(ω′Δt/2) for what is seen, ω′.
fn measured(basis: Sets, mass: &MassCase, wave: usize) -> f64 {
    let theta = PI / 8.0 * wave as f64;
    let (model, mut state) = at_start::<1>(&row(basis, mass, wave));
    let mode: Vec<f64> = state.particle.x.iter().map(|x| libm::cos(theta * x[0])).collect();
    time::start(&mut state, &model, &mut |_, _| {}).unwrap();
    let half = model.steps / 2;
    let mut sizes = Vec::new();
    for step in 1..=2 * half {
        advance(&model, &mut state, step).unwrap();
        if step % half == 0 {
            sizes.push(MIDDLE.map(|p| mode[p] * state.particle.sigma[p][0]).sum::<f64>());
        }
    }
    let seen = libm::acos(0.5 * sizes[1] / sizes[0]) / (half as f64 * model.dt);
    2.0 / model.dt * libm::sin(0.5 * seen * model.dt) / theta
}

/// Predicted and measured speeds agree within 1e-5 c, for every basis, both mass matrices and
/// seven lengths of waves, from 16 cells to 16/7.
#[test]
fn dispersion_is_predicted() {
    let mut table = String::from("basis,matrix,16 cells,8,4,16/7,largest difference\n");
    let (mut pictures, mut filters) = (Vec::new(), Vec::new());
    for (name, basis) in ROW_BASES {
        let [mut curves, mut dots] = [[Vec::new(), Vec::new()], [Vec::new(), Vec::new()]];
        for (n, mass) in MASSES.iter().enumerate() {
            let mut worst: f64 = 0.0;
            for wave in WAVES {
                let theta = wave as f64 / 8.0;
                let (theory, run) =
                    (predicted(basis, mass, PI * theta), measured(basis, mass, wave));
                worst = worst.max((theory - run).abs());
                dots[n].push((theta, run));
            }
            assert!(worst < 1e-5, "{name}, {}: {worst:e}", mass.name);
            let at = |wave: usize| predicted(basis, mass, PI / 8.0 * wave as f64);
            let [a, b, c, d] = [1, 2, 4, 7].map(at);
            // Digits of round-off are nobody's result.
            let digits = if worst < 1e-9 { "< 1e-9".into() } else { format!("{worst:.0e}") };
            writeln!(
                table,
                "{},{},{a:.4},{b:.4},{c:.4},{d:.4},{digits}",
                name.replace(',', ""),
                mass.name
            )
            .unwrap();
            let curve = (1..=60).map(|n| f64::from(n) / 60.0);
            curves[n] = curve.map(|x| (x, predicted(basis, mass, PI * x))).collect();
        }
        let over = |[up, down]: &[Vec<(f64, f64)>; 2]| -> Vec<(f64, f64)> {
            up.iter().zip(down).map(|(a, b)| (a.0, a.1 / b.1)).collect()
        };
        let (colour, marker) = (filters.len() / 2, MARKERS[filters.len() / 2]);
        filters.push(Line::new("", over(&curves), colour));
        filters.push(Line::new(name, over(&dots), colour).dashed(Dash::Nothing).marked(marker));
        let [lumped, consistent] = curves;
        pictures.push(Dispersion {
            name: name.into(),
            lumped,
            consistent,
            measured: dots.concat(),
        });
    }
    approve("dispersion__table", &table);
    approve_picture("dispersion__speeds", figures::dispersion(&pictures));
    let frame = Frame {
        x: "θ/π (1: a wave of two cells)",
        y: "filter s(θ)",
        x_range: Some((0.0, 1.0)),
        y_range: Some((0.0, 1.0)),
        ..Frame::default()
    };
    approve_picture("dispersion__filter", lines(&filters, &frame));
}

/// Every basis is exact for long waves, and the error of the speed falls as θ² at least; lumped it is slow by the factor s(θ) = M(θ)/M_L beside consistent, and s < 1.
#[test]
fn dispersion_of_long_waves() {
    for (name, basis) in ROW_BASES {
        for mass in &MASSES {
            let error = |theta: f64| predicted(basis, mass, theta) - 1.0;
            let (coarse, fine) = (error(0.2), error(0.1));
            assert!(fine.abs() < 0.01, "{name}, {}: {fine:e}", mass.name);
            assert!(fine.abs() < 0.3 * coarse.abs() + 1e-6, "{name}, {}: {fine:e}", mass.name);
        }
        let theta = 0.75 * PI;
        let (model, state) = at_start::<1>(&row(basis, &LUMPED, 1));
        let [_, filter] = symbols(&model, &state.particle.x[CELL], theta);
        let (lumped, consistent) =
            (predicted(basis, &LUMPED, theta), predicted(basis, &CONSISTENT, theta));
        assert!((lumped / consistent - filter).abs() < 1e-12 && filter < 1.0, "{name}: {filter}");
    }
}
