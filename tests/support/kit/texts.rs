//! The numbers of the conformance kit: one text for each of its files.

use crate::support::*;
use lme_mpm::method::basis::Basis;
use lme_mpm::method::choice::Law;
use lme_mpm::method::continuum::law::{Elastic, density};
use lme_mpm::method::exact::Fields;
use lme_mpm::method::measure::rms;
use lme_mpm::port::trace::{self, Entry, TraceRecorder, hex, number};
use lme_mpm::run::stability::predicted;
use lme_mpm::run::table::shortest;
use lme_mpm::scene::DYKA;
use lme_mpm::setup;
use nalgebra::{Matrix1, Matrix2, Matrix3, SMatrix, SVector, Vector3};
use std::fmt::Write;

/// A number as decimal and hexadecimal cells.
fn both(x: f64) -> String {
    format!("{},{}", shortest(x), hex(x))
}

/// The bar that level 0 tabulates shape functions on: cells of a quarter of a metre, so
/// that places in cells are exact and a forgotten h shows.
pub const QUARTERS: [&str; 5] =
    ["body.length=2", "grid.cells=8", "time.end=1", "initial_velocity=[]", "probe=[]"];

/// The grid that level 0 tabulates shape functions on in 2D: h = (½, ¼) m, three cells by
/// four.
pub const CELLS: [&str; 3] = ["body.length=[1,0.75]", "grid.cells=[2,3]", "initial_velocity=[]"];

/// The same in 3D: h = (½, ¼, 1) m.
pub const BOXES: [&str; 3] =
    ["body.length=[1,0.25,1]", "grid.cells=[2,1,1]", "initial_velocity=[]"];

/// Places in cells: inside, on a node, on faces, on two sides, in three corners, near a corner,
/// near a node.
pub const PLACES_2D: [[f64; 2]; 12] = [
    [0.5, 0.5],
    [1.25, 2.75],
    [1.0, 1.0],
    [1.0, 1.5],
    [0.0, 1.5],
    [1.5, 4.0],
    [0.0, 0.0],
    [3.0, 0.0],
    [3.0, 4.0],
    [2.999, 3.999],
    [1.0625, 1.5],
    [2.0, 1.0625],
];

/// Inside, on a node, on a side, on an edge, in a corner.
pub const PLACES_3D: [[f64; 3]; 5] =
    [[1.25, 0.5, 0.75], [1.0, 1.0, 1.0], [1.5, 0.0, 0.5], [0.0, 2.0, 0.25], [3.0, 2.0, 2.0]];

/// A basis at points inside a cell, on nodes, beside them, near the end. What level 0 gives
/// stands in step 0, what a port makes of it after.
pub fn basis(sets: &[&str]) -> String {
    let places = [0.25, 0.5, 1.0, 2.75, 3.999, 4.0, 4.001, 6.5, 7.75, 8.0];
    basis_in::<1>(DYKA, &[sets, &QUARTERS].concat(), &places.map(|x| [x]))
}

/// A basis on the grid of a scene at `places`, in cells from the body's lower corner.
pub fn basis_in<const D: usize>(base: &str, sets: &[&str], places: &[[f64; D]]) -> String {
    let model = setup::model::<D>(&scene(base, sets));
    let tabulated = |points: &[SVector<f64, D>]| on_grid(&model.basis, &model.grid, points);
    let at = |cells: &[f64; D]| SVector::from_fn(|d, _| cells[d] * model.grid.h[d]);
    // uGIMP's particles must not reach beyond the grid.
    let places: Vec<_> = places.iter().map(at).filter(|x| tabulated(&[*x]).is_ok()).collect();
    let table = tabulated(&places).unwrap();
    let mut kernel = TraceRecorder::default();
    for (p, x) in places.iter().enumerate() {
        kernel.at(0, 0).components("x_p", p, x.as_slice());
    }
    kernel.at(0, 2).shapes(&table.shape);
    kernel.gradients(&table.shape);
    if let Basis::Lme { .. } = model.basis {
        kernel.multipliers(table.lambda.iter().map(|l| l.component_div(&model.grid.h)));
    }
    in_both(&kernel.entries)
}

/// The elastic law in uniaxial strain.
pub fn law_1d() -> String {
    law([1e-3, 0.1, -0.2].map(Matrix1::new))
}

/// The elastic law in plane strain.
pub fn law_2d() -> String {
    law([[1e-3, 2e-4, -4e-4], [0.0, 0.1, 0.0], [-0.2, 0.0, 0.3]]
        .map(|[xx, xy, yy]| Matrix2::new(xx, xy, xy, yy)))
}

/// The elastic law in three dimensions.
pub fn law_3d() -> String {
    let shear = Matrix3::new(0.1, 0.01, -0.02, 0.01, -0.2, 0.03, -0.02, 0.03, 0.05);
    law([shear, Matrix3::from_diagonal(&Vector3::new(1e-3, 0.0, -2e-3)), shear * 1e-3])
}

/// The Cauchy stress and the energy per volume at t = 0 of deformation gradients, one of them
/// a rotation.
pub fn law_of_deformation(law: Law) -> String {
    let mut kernel = TraceRecorder::default();
    let (c, s) = (0.8, 0.6);
    let deformations = [[1.1, 0.2, 0.0, 0.95], [c, -s, s, c], [1.3, -0.1, 0.25, 0.7]];
    let mut k = 0;
    for (E, nu) in [(1e6, 0.3), (7.0, 0.0)] {
        for [xx, xy, yx, yy] in deformations {
            let (law, F) = (Elastic::new(law, E, nu), Matrix2::new(xx, xy, yx, yy));
            kernel.at(k, 0).components("E", 0, &[E]);
            kernel.at(k, 0).components("nu", 0, &[nu]);
            kernel.at(k, 0).components("F_p", 0, &[xx, xy, yx, yy]);
            kernel.at(k, 6).components("sigma_p", 0, law.stress_of(&F).as_slice());
            kernel.at(k, 6).components("W_p", 0, &[law.energy_of(&F)]);
            k += 1;
        }
    }
    in_both(&kernel.entries)
}

/// Stress, density and energy of three materials after each of three strains.
fn law<const D: usize>(strains: [SMatrix<f64, D, D>; 3]) -> String {
    let mut kernel = TraceRecorder::default();
    let mut k = 0;
    for (E, nu) in [(200e9, 0.0), (1000.0, 0.3), (7.0, -0.4)] {
        for d_eps in strains {
            let law = Elastic::new(Law::Rate, E, nu);
            let sigma = law.stress_increment(&d_eps);
            kernel.at(k, 0).components("E", 0, &[E]);
            kernel.at(k, 0).components("nu", 0, &[nu]);
            kernel.at(k, 0).components("d_eps_p", 0, d_eps.as_slice());
            kernel.at(k, 6).components("rho_p", 0, &[density(1.0, &d_eps).unwrap()]);
            kernel.at(k, 6).components("sigma_p", 0, sigma.as_slice());
            kernel.at(k, 6).components("W_p", 0, &[law.energy_density(&sigma)]);
            k += 1;
        }
    }
    in_both(&kernel.entries)
}

/// The root mean square of three pairs of lists.
pub fn measure() -> String {
    let mut kernel = TraceRecorder::default();
    let cases: [(&[f64], &[f64]); 3] = [
        (&[3.0, 1.0], &[0.0, 5.0]),
        (&[1.0, -1.0], &[0.0, 0.0]),
        (&[0.1, 0.2, 0.4], &[0.1, 0.25, 0.3]),
    ];
    for (k, (computed, exact)) in cases.into_iter().enumerate() {
        for (n, (phi, phi_exact)) in computed.iter().zip(exact).enumerate() {
            kernel.at(k, 0).components("phi", n, &[*phi]);
            kernel.at(k, 0).components("phi_exact", n, &[*phi_exact]);
        }
        let pairs = computed.iter().copied().zip(exact.iter().copied());
        kernel.at(k, 1).components("rms", 0, &[rms(pairs)]);
    }
    in_both(&kernel.entries)
}

/// v, σ and u of the exact bar at places between and beside its fronts.
pub fn exact() -> String {
    let exact = setup::exact::<1>(&dyka(&[])).unwrap();
    let mut places = Vec::new();
    for x in [0.0, 0.05, 0.099, 0.12, 0.1333] {
        for tau in [0.1, 0.3, 0.9, 1.6, 2.1, 2.9, 3.6, 3.9, 17.3] {
            places.push((x, tau * transit()));
        }
    }
    let fields: Vec<Fields> = places.iter().map(|(x, t)| exact.along(*x, *t)).collect();
    let mut kernel = TraceRecorder::default();
    let mut column = |step: usize, symbol: &'static str, values: Vec<f64>| {
        for (n, value) in values.into_iter().enumerate() {
            kernel.at(0, step).components(symbol, n, &[value]);
        }
    };
    column(0, "x", places.iter().map(|place| place.0).collect());
    column(0, "t", places.iter().map(|place| place.1).collect());
    column(1, "v", fields.iter().map(|fields| fields.velocity).collect());
    column(1, "sigma", fields.iter().map(|fields| fields.stress).collect());
    column(1, "u", fields.iter().map(|fields| fields.displacement).collect());
    in_both(&kernel.entries)
}

/// A trace with one column more, the value in hexadecimal.
fn in_both(entries: &[Entry]) -> String {
    let decimal = String::from_utf8(trace::csv(entries, false).unwrap()).unwrap();
    let mut lines = decimal.lines();
    let mut text = format!("{},hex\n", lines.next().unwrap());
    for (line, entry) in lines.zip(entries) {
        assert_eq!(number(&hex(entry.value)), Some(entry.value));
        writeln!(text, "{line},{}", hex(entry.value)).unwrap();
    }
    text
}

/// The trace of the scene `base` with changes.
pub fn traced(base: &str, sets: &[&str], steps: usize) -> String {
    in_both(&trace::trace(&scene(base, sets), steps).unwrap())
}

/// What the probes of the bar follow: its last particle, and the one nearest to 3L/4.
pub fn histories(sets: &[&str]) -> String {
    let mut entries = trace::trace(&dyka(sets), 320).unwrap();
    entries.retain(|entry| match (entry.step, entry.symbol) {
        (9, "v_p") => entry.index == 79,
        (6, "sigma_p") => entry.index == 59,
        _ => false,
    });
    in_both(&entries)
}

/// The errors of the two histories, of the linear basis and local max-ent with γ = 0.8,
/// with a tenth of room on both sides.
pub fn bands() -> String {
    let mut text = String::from("basis,quantity,error,lowest,highest\n");
    for basis in [LINEAR, LME_WIDE] {
        let scene = dyka(basis.sets);
        let Each { v, sigma, .. } = bar_errors(&scene, &finished(&scene));
        for (quantity, error) in [("velocity_end", v), ("stress_three_quarter", sigma)] {
            let (low, high) = (0.9 * error, 1.1 * error);
            writeln!(text, "{},{quantity},{error:.6},{low:.6},{high:.6}", basis.name).unwrap();
        }
    }
    text
}

/// The largest stable c Δt/h of every basis, mass and scheme on 8 cells.
pub fn limits() -> String {
    let mut text = String::from("basis,mass,integrator,particles_per_cell,courant,courant_hex\n");
    for basis in BASES {
        for mass in MASSES {
            for scheme in SCHEMES {
                let small = ["grid.cells=8"];
                let scene = dyka(&[basis.sets, scheme.sets, mass.sets, &small].concat());
                let courant = scene.courant_number_of(predicted(&scene, 0.0).unwrap());
                // Six digits: it comes from an iteration.
                let rounded: f64 = format!("{courant:.5}").parse().unwrap();
                let (basis, mass, scheme) = (basis.name, mass.name, scheme.name);
                writeln!(text, "{basis},{mass},{scheme},2,{}", both(rounded)).unwrap();
            }
        }
    }
    text
}

/// The order in h of the linear basis with both masses, with 0.05 of room on both sides.
pub fn orders() -> String {
    let mut text = String::from("basis,mass,quantity,lowest,highest\n");
    let Each { v, sigma, u } = LINEAR.order.unwrap();
    for (quantity, order) in [("velocity", v), ("displacement", u), ("stress", sigma)] {
        for mass in MASSES {
            let (basis, mass) = (LINEAR.name, mass.name);
            writeln!(text, "{basis},{mass},{quantity},{},{}", order - 0.05, order + 0.05).unwrap();
        }
    }
    text
}

/// A change of the bar's scene after which it must not run.
pub struct MustFail {
    from: &'static str,
    to: &'static str,
    pub ends: Ending,
}

/// How a scene ends that must fail.
#[derive(Debug)]
pub enum Ending {
    /// It is refused, and this key is named.
    Refused(&'static str),
    BreaksDownAtOnce,
}

impl MustFail {
    /// The bar's scene after the change.
    pub fn scene(&self) -> String {
        assert!(DYKA.contains(self.from), "{}", self.from);
        DYKA.replacen(self.from, self.to, 1)
    }
}

const fn refused(from: &'static str, to: &'static str, key: &'static str) -> MustFail {
    MustFail { from, to, ends: Ending::Refused(key) }
}

pub const MUST_FAIL: [MustFail; 8] = [
    refused("density = 7833", "density = -7833", "body.density"),
    refused("cells = 40", "cells = 0", "grid.cells"),
    refused("poisson_ratio = 0", "poisson_ratio = 0.5", "body.poisson_ratio"),
    refused("kind = \"linear\"", "kind = \"lme\"\ngamma = 0", "basis.gamma"),
    refused("cfl = 0.5", "cfl = nan", "time.cfl"),
    refused("velocity = 5", "velocity = inf", "initial_velocity.velocity"),
    refused("to = 0.1333", "to = 0.2", "initial_velocity.to"),
    MustFail { from: "velocity = 5", to: "velocity = -1e7", ends: Ending::BreaksDownAtOnce },
];

pub fn must_fail() -> String {
    let mut text = String::from("replace,by,must_name\n");
    for MustFail { from, to, ends } in MUST_FAIL {
        let (from, to) = (from.replace('"', "'"), to.replace('"', "'").replace('\n', " / "));
        let names = match ends {
            Ending::Refused(key) => key,
            Ending::BreaksDownAtOnce => "a breakdown in the first steps",
        };
        writeln!(text, "{from},{to},{names}").unwrap();
    }
    text
}
