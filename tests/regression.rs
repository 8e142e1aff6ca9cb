//! Pins: histories and pictures as approved, in `snapshots/`.
//!
//! A pin says "same as before". What says "right" stands in `analytical.rs`
//! and `convergence.rs`. After a change that is meant to change results, run
//! the command in the README and give the cause of each difference in the
//! commit message.

mod support;

use lme_mpm::figure;
use lme_mpm::run::Outcome;
use lme_mpm::scene::Scene;
use std::fmt::Write;
use support::*;

/// Rows of a history that are printed; the digest covers all of them.
const ROWS: usize = 41;

/// FNV-1a over the bits of every number: one changed bit changes it.
fn digest(column: &[f64]) -> u64 {
    let bytes = column.iter().flat_map(|x| x.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// A probe's history, thinned out to `ROWS` rows of nine digits, and a digest
/// of the bits of all rows.
fn pin(outcome: &Outcome, probe: &str) -> String {
    let column = |name: &str| outcome.history.column(name).unwrap();
    let (step, t, computed) = (column("step"), column("t"), column(probe));
    let exact = column(&format!("{probe}_exact"));
    let every = (computed.len() - 1) / (ROWS - 1);
    let mut text = format!(
        "rows {} of {}; bits of all rows {:016x}\n{:>5} {:>15} {:>16} {:>16}\n",
        ROWS,
        computed.len(),
        digest(&computed),
        "step",
        "t",
        "computed",
        "exact"
    );
    for k in (0..computed.len()).step_by(every) {
        let (t, computed, exact) = (t[k], computed[k], exact[k]);
        writeln!(text, "{:>5} {t:>15.8e} {computed:>16.8e} {exact:>16.8e}", step[k]).unwrap();
    }
    text
}

/// Insta with the project's snapshot directory.
fn approve(name: &str, text: &str) {
    settings().bind(|| insta::assert_snapshot!(name, text));
}

fn settings() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings
}

fn pin_both_probes(scene: &Scene, name: &str) {
    let outcome = finished(scene);
    for probe in ["velocity_end", "stress_three_quarter"] {
        approve(&format!("{name}__{probe}"), &pin(&outcome, probe));
    }
}

#[test]
fn dyka_linear_newmark() {
    pin_both_probes(&dyka(&[]), "dyka__linear__newmark");
}

#[test]
fn dyka_linear_newmark_as_printed() {
    let scene = dyka(&["time.reading=as-printed"]);
    pin_both_probes(&scene, "dyka__linear__newmark_as_printed");
}

/// The picture in the README, as the program draws it.
#[test]
fn readme_figure() {
    let scene = dyka(&[]);
    let svg = figure::probe(&scene, &scene.probes[0], &finished(&scene).history);
    settings().bind(|| insta::assert_binary_snapshot!("dyka__velocity_end.svg", svg.into_bytes()));
}
