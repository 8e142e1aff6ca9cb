//! What a run may take, memory and work, is known before its first step. Each test says its
//! GOAL, its SETUP and what is EXPECTED.

use crate::support::program::*;
use crate::support::*;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::run::{parse, parse_within, run_knowing};
use lme_mpm::scene::{Budget, Scene};
use nalgebra_sparse::factorization::CscSymbolicCholesky;
use nalgebra_sparse::pattern::SparsityPattern;
use std::fs;
use std::ops::ControlFlow;
use std::process::Command;

/// The entries of the consistent mass matrix of a scene with its body moved by a fifth of a cell
/// along every axis, and of its factor L.
fn counted(scene: &Scene) -> [f64; 2] {
    match scene.dimension() {
        1 => counted_in::<1>(scene),
        2 => counted_in::<2>(scene),
        _ => counted_in::<3>(scene),
    }
}

fn counted_in<const D: usize>(scene: &Scene) -> [f64; 2] {
    let (model, state) = at_start::<D>(scene);
    let x: Vec<_> = state.particle.x.iter().map(|x| x + 0.2 * model.grid.h).collect();
    let shape = on_grid(&model.basis, &model.grid, &x).unwrap().shape;
    let nodes = model.grid.nodes();
    let mut coupled = vec![false; nodes * nodes];
    for (I, p, _, _) in shape.pairs() {
        for (J, _, _) in shape.of(p) {
            coupled[I * nodes + J] = true;
        }
    }
    let (mut offsets, mut indices) = (vec![0], Vec::new());
    for row in coupled.chunks(nodes) {
        indices.extend((0..nodes).filter(|J| row[*J]));
        offsets.push(indices.len());
    }
    let entries = indices.len();
    let pattern =
        SparsityPattern::try_from_offsets_and_indices(nodes, nodes, offsets, indices).unwrap();
    let symbolic = CscSymbolicCholesky::factor(pattern);
    [entries as f64, symbolic.l_pattern().nnz() as f64]
}

/// GOAL: what is predicted for the factors of the consistent mass matrix is enough, and no more
/// than twice what they take.
/// SETUP: the strip of the bar, in 1D to 3D, with as many cells along every axis, and every basis;
/// the pattern of the matrix is factorised, with the body moved by a fifth of a cell.
/// EXPECTED: predicted entries of L from one to two times those counted, and of the matrix as many
/// as counted or more.
#[test]
fn budget_of_the_factor() {
    for (dimension, cells) in [(1, 40), (2, 24), (3, 8)] {
        for BasisCase { name, sets, .. } in BASES {
            let cells = format!("grid.cells={}", each_axis(dimension, &cells.to_string()));
            let scene = strip(dimension, &[sets, &["mass=consistent", &cells]].concat());
            let [entries, factor] = counted(&scene);
            let (predicted, most) = (scene.factor_entries(), scene.mass_entries());
            let place = format!("{name} in {dimension}D: {predicted} for {factor} entries");
            assert!(factor <= predicted && predicted <= 2.0 * factor, "{place}");
            assert!(entries <= most, "{place}");
        }
    }
}

/// GOAL: a scene that needs more than there is is refused by the key that asks for it, with the
/// need and what there is.
/// SETUP: the bar, a plate and a block with the consistent matrix, held against small budgets;
/// a block of 40³ cells with wide functions and steps of 1e-300 against the standard one.
/// EXPECTED: an error at once that names key, need and allowance; a little more is enough.
#[test]
fn budget_names_what_is_short() {
    let gb = |x: f64| Budget { memory: x * 1e9, ..Budget::default() };
    let hard = Budget { work: 1e6, ..Budget::default() };
    let cube = ["mass=consistent", "grid.cells=[20,20,20]"];
    let wide = ["mass=consistent", "grid.cells=[40,40,40]", LME_WIDE.sets[0], LME_WIDE.sets[1]];
    let wide = &[&wide[..], &LME_WIDE.sets[2..]].concat();
    let frames = ["grid.cells=[100,100]", "output.vtk=true", "time.end=0.005"];
    for (dimension, sets, less, more, key, words) in [
        (3, &cube[..], gb(0.2), gb(1.0), "mass", &["GB of memory", "0.2 GB, which is there"][..]),
        (3, wide, gb(16.0), gb(1e4), "mass", &["GB of memory", "lumped"]),
        (1, &["grid.cells=1000000"], gb(0.1), gb(1e3), "grid.cells", &["GB", "which is there"]),
        (2, &frames, gb(0.2), gb(4.0), "time.end", &["frames", "output.every"]),
        (1, &["time.cfl=1e-9"], hard, gb(100.0), "time.end", &["particle-steps", "--max-time"]),
        (1, &["time.cfl=1e-300"], gb(16.0), gb(16.0), "time.end", &["steps", "1e15"]),
    ] {
        let text = text_of_block(dimension);
        let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
        let error = parse_within(&less, "test", "test", &text, &sets).unwrap_err();
        assert_eq!(error.key, key, "{error}");
        for word in words {
            assert!(error.to_string().contains(word), "`{word}` is not in {error}");
        }
        let more = Budget { work: f64::INFINITY, ..more };
        let afforded = parse_within(&more, "test", "test", &text, &sets);
        assert_eq!(afforded.is_ok(), !sets[0].contains("1e-300"), "{sets:?}");
    }
    assert!(parse("dyka", "dyka", lme_mpm::scene::DYKA, &[]).is_ok());
}

/// A block at rest, free on all sides.
fn text_of_block(dimension: usize) -> String {
    let list = |x: &str| each_axis(dimension, x);
    format!(
        "title = 'block'\nmethod = 'mpm'\nmass = 'lumped'\nbasis.kind = 'linear'\n\
         body = {{ length = {}, density = 1000, youngs_modulus = 1e6, poisson_ratio = 0.3 }}\n\
         grid = {{ cells = {}, particles_per_cell = {} }}\n\
         time = {{ integrator = 'newmark', cfl = 0.2, end = 0.001 }}\n",
        list("1"),
        list("4"),
        list("2"),
    )
}

/// GOAL: a run can be ended from outside, by name, and keeps what it had recorded.
/// SETUP: the bar; `progress` breaks at step 7.
/// EXPECTED: the reason, the step, and the rows of steps 0 to 7.
#[test]
fn budget_of_time_in_the_library() {
    let ended = run_knowing(&dyka(&[]), None, &mut |step| match step {
        7 => ControlFlow::Break(Breakdown::OutOfTime { seconds: 2.5 }),
        _ => ControlFlow::Continue(()),
    });
    let stopped = ended.unwrap_err();
    let words = stopped.broken.to_string();
    assert!(
        words.contains("step 7") && words.contains("the 2.5 s of --max-time are over"),
        "{words}"
    );
    assert_eq!(stopped.history.rows().count(), 8);
}

/// GOAL: the program keeps to `--max-time`, and to the memory that the machine lets it have;
/// without a terminal nothing tells of a prediction.
/// SETUP: the bar with a million steps and a twentieth of a second; with so much work that it may
/// start with a limit of time only; a block with the consistent matrix in 300 MB of addresses.
/// EXPECTED: exit code 1 with `history.failed.csv` alone, without colours; a refusal, exit code 2;
/// the same for the block, and its key is the mass.
#[test]
fn budget_of_the_program() {
    let dir = directory("budget");
    let slow = ["--set", "time.cfl=1e-4", "--set", "output.every=100", "--max-time", "0.05"];
    let output = program(&dir, &[&["run", DYKA, "--out", "ended"][..], &slow].concat());
    assert_fails(&output, 1, &["0.05 s of --max-time", "history.failed.csv"]);
    assert!(!text(&output.stderr).contains("predicting"), "{}", text(&output.stderr));
    assert_eq!(files(&dir.join("ended")), ["history.failed.csv", "results.txt"]);
    let history = fs::read_to_string(dir.join("ended/history.failed.csv")).unwrap();
    assert!(history.lines().count() > 1 && !history.contains("NaN"), "{history}");
    let much = ["--set", "time.cfl=1e-8", "--set", "output.every=1000000"];
    let much = [&["run", DYKA, "--out", "much"][..], &much].concat();
    assert_fails(&program(&dir, &much), 2, &["time.end", "particle-steps", "--max-time SECONDS"]);
    let ended = program(&dir, &[&much[..], &["--max-time", "0.05"]].concat());
    assert_fails(&ended, 1, &["--max-time are over"]);
    assert_fails(&program(&dir, &["run", DYKA, "--max-time", "0"]), 2, &["above 0"]);
    fs::write(dir.join("block.toml"), text_of_block(3)).unwrap();
    let large = "run block.toml --set mass=consistent --set grid.cells=[25,25,25]";
    let line = format!("ulimit -v 300000; '{}' {large}", env!("CARGO_BIN_EXE_lme-mpm"));
    let output = Command::new("sh").args(["-c", &line]).current_dir(&dir).output().unwrap();
    assert_fails(&output, 2, &["mass:", "GB of memory", "GB, which is there"]);
}
