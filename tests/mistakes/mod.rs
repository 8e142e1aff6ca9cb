//! Mistakes that ports make, one at a time, in one to three dimensions and every method: `check`
//! finds each where it is made, and mostly says what it is.
//!
//! The port is the library's own steps with one of them changed ([`Seed`]), or its trace with
//! what a mistake of printing does to it.

mod in_1d;
mod in_2d;
mod printed;

use crate::support::kit::{BAR, BLOCK, Base, STRIP, TWO_DISCS};
use crate::support::*;
use lme_mpm::method::model::{Model, State};
use lme_mpm::method::time;
use lme_mpm::port::check::{Tolerance, compare};
use lme_mpm::port::trace::{self, Entry, TraceRecorder};
use lme_mpm::scene::Scene;
use std::fmt::Write;

/// The tolerance of the kit's level 2.
const STEPS: Tolerance = Tolerance { relative: 1e-10, absolute: 1e-12 };

/// Where a step stands, and the state at the end of the time step before.
pub struct At<'a, const D: usize> {
    pub k: usize,
    pub n: usize,
    pub dt: f64,
    /// The time of the loads.
    pub t: f64,
    pub model: &'a Model<D>,
    pub past: &'a State<D>,
}

/// What a port does wrong.
pub enum Seed<const D: usize> {
    /// It computes another scene.
    Sets(&'static [&'static str]),
    /// It starts from another model or state.
    Start(fn(&mut Model<D>, &mut State<D>)),
    /// It takes this in place of a step, where it says so.
    Instead(fn(&At<D>, &mut State<D>) -> bool),
    /// It does this besides, after a step and before it is printed.
    After(fn(&At<D>, &mut State<D>)),
    /// It does this after a step has been printed.
    Later(fn(&At<D>, &mut State<D>)),
    /// It prints this in place of each number.
    Entry(fn(&mut Entry)),
    /// It prints this in place of all.
    Printed(fn(&[Entry]) -> Vec<Entry>),
}

/// A mistake with the place where it is made, and words of the right cause.
pub struct Mistake<const D: usize> {
    pub name: &'static str,
    pub base: Base,
    pub sets: &'static [&'static str],
    pub seed: Seed<D>,
    pub shows_in: (usize, &'static str),
    pub says: &'static str,
}

/// Takes step `at.n` of the model's scheme as the library does.
fn right_step<const D: usize>(at: &At<D>, state: &mut State<D>) -> bool {
    let At { n, dt, t, model, .. } = *at;
    time::scheme::<D>(model.method).step(n, state, model, dt, t).is_ok()
}

/// The trace of a port that marches with a mistake, or without one.
fn marched<const D: usize>(scene: &Scene, steps: usize, seed: Option<&Seed<D>>) -> Vec<Entry> {
    let (mut model, mut state) = at_start::<D>(scene);
    if let Some(Seed::Start(change)) = seed {
        change(&mut model, &mut state);
    }
    let scheme = time::scheme::<D>(model.method);
    let mut recorder = TraceRecorder::default();
    recorder.given(scene, &state, &model);
    // A port prints what it was given, not what it has taken for it.
    recorder.entries.retain(|entry| entry.symbol != "gamma");
    for k in 0..=steps {
        let (dt, t) = if k == 0 { (0.0, 0.0) } else { (model.dt, k as f64 * model.dt) };
        if k == 0 && !scheme.starts_with_all_steps() {
            let mut after = |n: usize, state: &State<D>| recorder.step(0, n, state, &model);
            time::start(&mut state, &model, &mut after).unwrap();
            continue;
        }
        let past = state.clone();
        for n in 1..scheme.makes(model.kinematics).len() {
            let t = time::time_of_loads(model.method, dt, t);
            let at = At { k, n, dt, t, model: &model, past: &past };
            let done = matches!(seed, Some(Seed::Instead(step)) if step(&at, &mut state));
            // With some mistakes a run breaks down; what it has printed is there.
            if !done && !right_step(&at, &mut state) {
                return recorder.entries;
            }
            if let Some(Seed::After(change)) = seed {
                change(&at, &mut state);
            }
            recorder.step(k, n, &state, &model);
            if let Some(Seed::Later(change)) = seed {
                change(&at, &mut state);
            }
        }
    }
    recorder.entries
}

/// What the port prints for a mistake.
fn printed<const D: usize>(mistake: &Mistake<D>, right: &[Entry], steps: usize) -> Vec<Entry> {
    let Mistake { base, sets, .. } = *mistake;
    match &mistake.seed {
        Seed::Sets(wrong) => {
            let scene = scene(base.text, &[sets, wrong].concat());
            let mut entries = trace::trace(&scene, steps).unwrap();
            entries.retain(|e| e.symbol != "gamma");
            entries
        }
        Seed::Entry(change) => {
            let mut entries = right.to_vec();
            entries.iter_mut().for_each(change);
            entries
        }
        Seed::Printed(change) => change(right),
        seed => marched(&scene(base.text, sets), steps, Some(seed)),
    }
}

/// What the port is of: its dimension, and what its scene says of basis, scheme, method and law.
fn port_of(dimension: usize, sets: &[&str]) -> String {
    let tells =
        ["basis.", "method", "mass", "time.integrator", "time.stress", "time.kin", "body.law"];
    let words = sets.iter().filter(|set| tells.iter().any(|key| set.starts_with(key)));
    let words: Vec<&str> = words.filter_map(|set| set.split('=').nth(1)).collect();
    let words = if words.is_empty() { "linear".to_string() } else { words.join(" ") };
    format!("{dimension}D {words}")
}

/// A line of the table, and whether the place is right, and the cause.
fn line<const D: usize>(mistake: &Mistake<D>) -> (String, bool, bool) {
    const FOUR: usize = 4;
    let right = trace::trace(&scene(mistake.base.text, mistake.sets), FOUR).unwrap();
    let theirs = printed(mistake, &right, FOUR);
    let scene = port_of(D, mistake.sets);
    let name = mistake.name;
    let report = match compare(&right, &theirs.into(), STEPS, true) {
        Ok(report) => report,
        Err(fault) => return (format!("{name},{scene},–,–,–,\"{fault}\",no"), false, false),
    };
    let Some(found) = report.divergence else {
        return (format!("{name},{scene},–,–,–,not found,no"), false, false);
    };
    let Entry { k, step, symbol, .. } = found.reference;
    let cause = found.cause.unwrap_or("–".into());
    let place = (step, symbol) == mistake.shows_in;
    let says = place && cause.contains(mistake.says);
    let yes = if says { "yes" } else { "no" };
    let cause = cause.replace('"', "'");
    (format!("{name},{scene},{k},{step},{symbol},\"{cause}\",{yes}"), place, says)
}

/// Every mistake is found where it is made, and four fifths of them with their cause: the bar on
/// 4 cells, the strip, the discs and the block of the kit, four time steps. The table names place
/// and cause, and whether it is the right one.
#[test]
fn mistakes_are_found_where_they_are_made() {
    let mut lines: Vec<(String, bool, bool)> = in_1d::MISTAKES.iter().map(line).collect();
    lines.extend(in_1d::OF_METHODS.iter().map(line));
    lines.extend(in_2d::MISTAKES.iter().map(line));
    lines.extend(in_2d::OF_METHODS.iter().map(line));
    lines.extend(in_2d::LATER.iter().map(line));
    lines.extend(printed::MISTAKES.iter().map(line));
    lines.extend(printed::IN_3D.iter().map(line));
    let mut table =
        String::from("mistake,port of,found at k,step,symbol,likely cause as reported,right\n");
    for (line, place, _) in &lines {
        writeln!(table, "{line}").unwrap();
        assert!(place, "elsewhere: {line}");
    }
    let right = lines.iter().filter(|line| line.2).count();
    assert!(lines.len() >= 60 && 5 * right >= 4 * lines.len(), "{right} of {}", lines.len());
    approve("port__seeded", &table);
}

/// Multiplies by 1 ± 1e-15, by a sequence that is the same every time.
fn shake(x: &mut f64, n: &mut u64) {
    *n = n.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    *x *= 1.0 + if *n >> 63 == 0 { 1e-15 } else { -1e-15 };
}

/// Shakes all numbers of a state, as other sums and other roundings would.
fn shaken<const D: usize>(at: &At<D>, state: &mut State<D>) {
    let mut n = (at.k * 16 + at.n) as u64;
    let State { particle, node, .. } = state;
    for list in [&mut particle.x, &mut particle.v, &mut particle.a, &mut node.p, &mut node.v] {
        list.iter_mut().flat_map(|x| x.iter_mut()).for_each(|x| shake(x, &mut n));
    }
    for list in [&mut node.f, &mut node.a, &mut node.a_last, &mut node.a_next, &mut node.x] {
        list.iter_mut().flat_map(|x| x.iter_mut()).for_each(|x| shake(x, &mut n));
    }
    for list in [&mut particle.sigma, &mut particle.d_eps, &mut particle.G, &mut particle.F] {
        list.iter_mut().flat_map(|x| x.iter_mut()).for_each(|x| shake(x, &mut n));
    }
    node.m.iter_mut().chain(&mut particle.rho).for_each(|x| shake(x, &mut n));
}

/// What `check` says of a right port whose numbers are shaken.
fn alarm<const D: usize>(base: Base, sets: &[&str], steps: usize) -> Option<String> {
    let scene = scene(base.text, sets);
    let (mut steps, all) = (steps, scene.step_count() as usize);
    steps = steps.min(all);
    let right = trace::trace(&scene, steps).unwrap();
    let theirs = marched::<D>(&scene, steps, Some(&Seed::After(shaken)));
    let report = compare(&right, &theirs.into(), STEPS, true).unwrap();
    report.divergence.is_some().then(|| report.text())
}

/// OTM with a point in the middle of each cell that sees two nodes: λ is 0 but for round-off.
const IN_THE_MIDDLE: [&str; 4] =
    ["method=otm", "grid.particles_per_cell=1", "basis.kind=lme", "basis.gamma=12"];
/// A free bar in flight, half of it faster by a hundred millionth, whose last particle stands
/// behind its last node by that part of the cell at k = 2: the node behind that has hardly any
/// mass, and the particle is stressed. The speed that does it is found by the secant.
fn light_node(scheme: Sets) -> Vec<String> {
    const BAR_OF_FOUR: &str = "body.length=4 body.density=1 body.youngs_modulus=1 grid.cells=4 \
         grid.beyond.left=0 time.end=5 boundary.left=free probe.0.position=4 probe.1.position=3";
    let sets = |speed: f64| -> Vec<String> {
        let words = BAR_OF_FOUR.split_whitespace().chain(scheme.iter().copied());
        let region =
            |from: f64, v: f64| format!("{{from={from:?},to={:?},velocity={v:?}}}", from + 2.0);
        let (slow, fast) = (region(0.0, speed), region(2.0, speed + 1e-8));
        words.map(String::from).chain([format!("initial_velocity=[{slow},{fast}]")]).collect()
    };
    let behind = |speed: f64| {
        let entries = trace::trace(&scene(BAR.text, &strs(&sets(speed))), 2).unwrap();
        entries.iter().rfind(|e| e.symbol == "x_p").unwrap().value - 4.0 - 1e-8
    };
    let (mut before, mut speed) = (0.25, 0.26);
    for _ in 0..8 {
        let (a, b) = (behind(before), behind(speed));
        if b.abs() < 1e-14 {
            break;
        }
        (before, speed) = (speed, speed - b * (speed - before) / (b - a));
    }
    assert!(behind(speed).abs() < 1e-11, "{speed}: {}", behind(speed));
    sets(speed)
}

const GAMMA_4: &[&str] = &["basis.kind=lme", "basis.gamma=4"];

/// A right port is let pass, whatever its last digits are: every basis and scheme on the bar,
/// twenty time steps on 6 cells, among them uGIMP's touch and the light nodes of generalized-α;
/// OTM, whose λ is nothing but an iteration's rest; the strip, the discs in rigid flight, the
/// block.
#[test]
fn check_has_no_false_alarm() {
    let small = ["grid.cells=6", "time.cfl=0.3"];
    let mut said = Vec::new();
    for basis in BASES {
        for scheme in SCHEMES {
            for mass in MASSES {
                let sets = [basis.sets, scheme.sets, mass.sets, &small].concat();
                said.extend(alarm::<1>(BAR, &sets, 20));
            }
        }
    }
    for scheme in SCHEMES {
        said.extend(alarm::<1>(BAR, &strs(&light_node(scheme.sets)), 6));
    }
    let otm = [GAMMA_4, &["method=otm"]].concat();
    for more in [&[][..], &IN_THE_MIDDLE, &["body.law=hencky"]] {
        said.extend(alarm::<1>(BAR, &[&otm, more, &small].concat(), 20));
    }
    let alpha = GENERALIZED_ALPHA.sets;
    let finite = ["body.law=neo-hookean", "time.kinematics=consistent"];
    let ball = ["basis.kind=lme", "basis.gamma=12", "basis.support=ball"];
    let (bases, others) = ([UGIMP.sets, BSPLINE.sets, LME_WIDE.sets], [alpha, &otm, &finite]);
    for sets in [&[][..], &ball].into_iter().chain(bases).chain(others) {
        let sets = [sets, &["time.cfl=0.3"]].concat();
        said.extend(alarm::<2>(STRIP, &sets, 4));
        said.extend(alarm::<2>(TWO_DISCS, &sets, 8));
    }
    said.extend(alarm::<3>(BLOCK, &[], 4));
    said.extend(alarm::<3>(BLOCK, GAMMA_4, 4));
    assert!(said.is_empty(), "{}", said.join("\n"));
}

/// Floors do not grow with the time steps: after two hundred of them a stress that is off by a
/// thousand millionth of the modulus times the strain is found, with every basis and mass.
#[test]
fn check_keeps_its_floors_low() {
    for basis in BASES {
        for mass in MASSES {
            let sets = [basis.sets, mass.sets, &["grid.cells=6", "time.cfl=0.1"]].concat();
            let right = trace::trace(&scene(BAR.text, &sets), 200).unwrap();
            let mut wrong = right.clone();
            let strain = 5.0 / (200e9_f64 / 7833.0).sqrt();
            for entry in wrong.iter_mut().filter(|e| (e.k, e.symbol) == (200, "sigma_p")) {
                entry.value += 1e-9 * 200e9 * strain;
            }
            let report = compare(&right, &wrong.into(), STEPS, true).unwrap();
            assert!(report.divergence.is_some(), "{} {}", basis.name, mass.name);
        }
    }
}

/// Without floors, which a reference that does not give E has none of, a right port is not let
/// pass where a symbol is nothing but round-off.
#[test]
fn check_needs_its_floors() {
    fn without<const D: usize>(base: Base, sets: &[&str]) -> &'static str {
        let scene = scene(base.text, sets);
        let mut right = trace::trace(&scene, 8).unwrap();
        right.retain(|entry| entry.symbol != "E");
        let theirs = marched::<D>(&scene, 8, Some(&Seed::After(shaken)));
        let report = compare(&right, &theirs.into(), STEPS, true).unwrap();
        report.divergence.map_or("", |found| found.reference.symbol)
    }
    let small = ["grid.cells=6", "time.cfl=0.3"];
    let otm = [&IN_THE_MIDDLE[..], &small].concat();
    assert_eq!(without::<2>(TWO_DISCS, &["time.cfl=0.3"]), "d_eps_p");
    assert_eq!(without::<1>(BAR, &otm), "lambda");
    assert_eq!(without::<1>(BAR, &[UGIMP.sets, &small].concat()), "v_I");
    let alpha = light_node(GENERALIZED_ALPHA.sets);
    assert_eq!(without::<1>(BAR, &strs(&alpha)), "d_eps_p");
}
