//! Scenes at the limits of what may be asked for: no panic, no memory that is not there,
//! and nothing computed that a scene does not ask for. Each test says its GOAL, its SETUP
//! and what is EXPECTED.

use crate::support::*;
use lme_mpm::run::parse;
use lme_mpm::scene::DYKA;
use nalgebra::Vector1;
use proptest::prelude::*;
use std::fmt::Write;

/// GOAL: a grid that does not fit is refused with the memory it would need.
/// SETUP: 1e9 cells and more in 1D and 2D, and a long series of large frames.
/// EXPECTED: an error at once, before anything is allocated.
#[test]
fn extremes_of_memory() {
    let frames = ["output.vtk=true", "grid.cells=[1000,1000]", "time.end=1"];
    for (text, sets) in [
        (DYKA, &["grid.cells=1000000000"][..]),
        (DYKA, &["grid.cells=9000000000000000000"]),
        (DISCS, &["grid.cells=[100000,100000]", "body.ball=[]"]),
        (DISCS, &frames),
    ] {
        let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
        let problem = parse("big", "big", text, &sets).unwrap_err().problem;
        assert!(problem.contains("GB"), "{sets:?}: {problem}");
    }
}

/// What bytes of a scene are replaced by.
const LETTERS: &[char] =
    &['0', '9', '-', 'e', '.', '"', '[', ']', '{', '}', '=', '\n', '#', 'µ', '\u{0}', ' ', 'n'];

proptest! {
    #![proptest_config(same_every_time(400))]

    /// GOAL: no scene file makes the program panic.
    /// SETUP: five shipped scenes with up to three bytes replaced, and cut off, at random; 400
    /// cases.
    /// EXPECTED: a scene or an error with a place in the text.
    #[test]
    fn extremes_of_scene_files(
        which in 0..5usize,
        cut in 0.0..1.0f64,
        at in prop::collection::vec((0.0..1.0f64, prop::sample::select(LETTERS)), 0..4),
        keep in any::<bool>(),
    ) {
        let text = [DYKA, VIBRATION, GRAVITY, MANUFACTURED, DISCS][which];
        let mut letters: Vec<char> = text.chars().collect();
        for (place, letter) in at {
            let n = (place * letters.len() as f64) as usize;
            letters[n] = letter;
        }
        if !keep {
            letters.truncate((cut * letters.len() as f64) as usize);
        }
        let text: String = letters.into_iter().collect();
        if let Err(error) = parse("fuzz", "fuzz.toml", &text, &[]) {
            prop_assert!(error.span.end <= error.text.len());
            prop_assert!(!error.to_string().is_empty());
        }
    }

    /// GOAL: no `--set` makes it panic either.
    /// SETUP: 400 texts, most of them of the form KEY=VALUE.
    /// EXPECTED: the bar with that change, or an error with words.
    #[test]
    fn extremes_of_sets(set in "[a-z_.0-9]{0,24}=?[-+0-9a-z\\[\\]{}\"., ]{0,16}") {
        if let Err(error) = parse("fuzz", "fuzz.toml", DYKA, &[set]) {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}

/// What a scene needs beyond the steps of MPM with a basis of closed form.
#[derive(PartialEq)]
enum Need {
    MaxEnt,
    Acceleration,
    Deformation,
    BodyForce,
    Traction,
    Systems,
    Search,
}

/// GOAL: only what a scene requires is computed and carried.
/// SETUP: every shipped scene and some variants, for a few steps.
/// EXPECTED: the table of counters, in which what is undeclared is 0.
#[test]
fn extremes_of_frugality() {
    use Need::*;
    let mut table = String::from(
        "scene,dimension,bytes per particle,pairs per particle and step,exponentials,\
         newton iterations,body forces,tractions,factorizations,candidates\n",
    );
    let (short, long) = ("time.end=1e-6", "time.end=0.1");
    for (name, text, end, sets, needs) in [
        ("dyka", DYKA, short, LINEAR.sets, &[Acceleration][..]),
        ("dyka (uGIMP)", DYKA, short, UGIMP.sets, &[Acceleration]),
        ("dyka (B-splines)", DYKA, short, BSPLINE.sets, &[Acceleration]),
        ("dyka (local max-ent)", DYKA, short, LME_WIDE.sets, &[MaxEnt, Acceleration]),
        ("dyka (generalized-α)", DYKA, short, GENERALIZED_ALPHA.sets, &[Acceleration]),
        ("dyka (consistent mass)", DYKA, short, CONSISTENT.sets, &[Systems, Acceleration]),
        ("dyka-otm", DYKA_OTM, short, &[], &[MaxEnt, Search, Deformation]),
        ("gravity", GRAVITY, short, &[], &[BodyForce, Acceleration]),
        ("traction", TRACTION, short, &[], &[Traction, Acceleration]),
        ("vibration", VIBRATION, long, &[], &[Acceleration]),
        ("manufactured", MANUFACTURED, short, &[], &[MaxEnt, BodyForce, Acceleration]),
        ("colliding-discs", DISCS, long, &[], &[Acceleration]),
    ] {
        let scene = scene(text, &[sets, &[end]].concat());
        let result = outcome(&scene).unwrap();
        let (cost, dimension) = (result.cost, scene.dimension());
        writeln!(
            table,
            "{name},{dimension},{},{:.1},{},{},{},{},{},{}",
            cost.bytes_per_particle,
            pairs_per_particle(&cost),
            cost.exponentials,
            cost.newton_iterations,
            cost.body_forces,
            cost.tractions,
            cost.factorizations,
            cost.candidates
        )
        .unwrap();
        for (need, count) in [
            (MaxEnt, cost.exponentials),
            (BodyForce, cost.body_forces),
            (Traction, cost.tractions),
            (Systems, cost.factorizations),
            (Search, cost.candidates),
        ] {
            assert_eq!(count > 0, needs.contains(&need), "{name}: {cost:?}");
        }
        let d = dimension as u64;
        let mut bytes = 8 * (2 + 3 * d + 2 * d * d + d * (d - 1) / 2);
        for (need, more) in [(MaxEnt, 3 * d), (Acceleration, d), (Deformation, d * d)] {
            bytes += if needs.contains(&need) { 8 * more } else { 0 };
        }
        assert_eq!(cost.bytes_per_particle, bytes, "{name}");
        assert!(result.frames.is_empty(), "{name}: frames nobody asked for");
    }
    assert_eq!(size_of::<Vector1<f64>>(), 8, "a 1D vector is a number");
    approve("extremes__frugality", &table);
}
