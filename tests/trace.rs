//! Traces, and their comparison.

use crate::support::*;
use lme_mpm::check::{self, Tolerance, compare, ulps};
use lme_mpm::fault::{Fault, Moment};
use lme_mpm::model::Model;
use lme_mpm::scene::Scene;
use lme_mpm::time;
use lme_mpm::trace::{self, Entry, hex, number, trace_in};

const USUAL: Tolerance = Tolerance { relative: 1e-9, absolute: 1e-12 };

/// A trace takes the same steps as a run: the same bits after ten of them, for every
/// scheme, both masses, OTM, loads, and more than one dimension.
#[test]
fn trace_is_the_run() {
    fn same<const D: usize>(scene: &Scene) {
        let (entries, traced) = trace_in::<D>(scene, 10).unwrap();
        let model = Model::<D>::of(scene);
        let mut state = model.initial_state(scene);
        let mut cost = lme_mpm::cost::Cost::default();
        time::start(&mut state, &model, &mut cost).unwrap();
        for step in 1..=10 {
            let moment = Moment { step, time: step as f64 * model.dt };
            time::advance(&mut state, &model, moment, &mut cost).unwrap();
        }
        assert_eq!(state.particle, traced.particle);
        assert_eq!(state.node, traced.node);
        let last: Vec<&Entry> = entries.iter().filter(|e| e.k == 10 && e.symbol == "x_p").collect();
        assert_eq!(last.len(), D * state.particle.len());
        for entry in last {
            assert_eq!(entry.value, state.particle.x[entry.index][entry.component]);
        }
    }
    for (_, sets) in SCHEMES {
        for mass in ["mass=lumped", "mass=consistent"] {
            let small = [mass, "grid.cells=6", "time.cfl=0.2"];
            same::<1>(&dyka(&[sets, &small].concat()));
            same::<1>(&dyka(&[sets, &small, &["basis.kind=lme", "basis.gamma=1.8"]].concat()));
        }
        let loads = ["body_force.acceleration=5", "traction.right=1e6", "grid.cells=6"];
        same::<1>(&dyka(&[sets, &loads].concat()));
    }
    same::<1>(&dyka(&["method=otm", "basis.kind=lme", "basis.gamma=4", "grid.cells=6"]));
    same::<2>(&scene(DISCS, &["grid.cells=[8,8]"]));
}

/// Hexadecimal numbers are exact, both ways.
#[test]
fn trace_numbers_read_back() {
    for x in [
        1.0,
        -0.1,
        1.0 / 3.0,
        5e-324,
        2.2250738585072014e-308,
        1.7976931348623157e308,
        0.0,
        6.5e-310,
    ] {
        assert_eq!(number(&hex(x)), Some(x), "{}", hex(x));
        assert_eq!(number(&format!("{x:?}")), Some(x));
    }
    assert_eq!((hex(1.5).as_str(), hex(-0.1).as_str()), ("0x1.8p+0", "-0x1.999999999999ap-4"));
    assert_eq!(
        (number("0x"), number("0x1.8"), number("abc"), number("")),
        (None, None, None, None)
    );
    assert_eq!((ulps(1.0, 1.0 + f64::EPSILON), ulps(-0.0, 0.0), ulps(5e-324, -5e-324)), (1, 0, 2));
}

fn reference(sets: &[&str], steps: usize) -> Vec<Entry> {
    trace::trace(&dyka(sets), steps).unwrap()
}

/// A comparison finds the first difference in the paper's order, names what was not
/// there, and refuses what cannot be compared.
#[test]
fn check_finds_the_first_difference() {
    let all = reference(&["grid.cells=4"], 3);
    let report = compare(&all, &all, USUAL).unwrap();
    assert_eq!((report.compared, report.divergence, report.missing.len()), (all.len(), None, 0));
    // A part agrees, and the rest is named.
    let part: Vec<Entry> = all.iter().filter(|e| e.symbol == "v_p").cloned().collect();
    let report = compare(&all, &part, USUAL).unwrap();
    assert!(report.divergence.is_none() && report.missing.contains_key("sigma_p"));
    assert!(report.text().contains("not compared") && report.text().contains("x_p ("));
    // Two errors: the one that comes first in the steps is reported, not in the file.
    let mut wrong = all.clone();
    let at = |k: usize, symbol: &str| {
        let found = |e: &Entry| e.k == k && e.symbol == symbol && e.value != 0.0;
        all.iter().position(found).unwrap()
    };
    let (late, early) = (at(3, "m_I"), at(2, "sigma_p"));
    wrong[late].value *= 1.5;
    wrong[early].value *= 1.0 + 1e-6;
    wrong.reverse();
    let report = compare(&all, &wrong, USUAL).unwrap();
    let divergence = report.divergence.clone().unwrap();
    assert_eq!((divergence.reference.k, divergence.reference.symbol), (2, "sigma_p"));
    assert!(divergence.ulps > 1_000_000);
    let text = report.text();
    for word in ["k = 2, step 6", "sigma_p of (3)", "governing-equations.html#eq-3", "likely: "] {
        assert!(text.contains(word), "{text}");
    }
    // Within the tolerance nothing is found.
    let loose = Tolerance { relative: 1e-5, ..USUAL };
    assert_eq!(compare(&all, &wrong, loose).unwrap().divergence.unwrap().reference.symbol, "m_I");
    // What cannot be compared.
    let mut more = all.clone();
    more[0].index = 99;
    assert!(matches!(compare(&all, &more, USUAL), Err(Fault::Argument { .. })));
    assert!(matches!(compare(&all, &[], USUAL), Err(Fault::Argument { .. })));
    for (text, words) in [
        ("k,step,symbol,index,component,value\n", "no column `node`"),
        ("k,step,symbol,index,node,component,value\n0,0,x_p,0,,0,NaN\n", "`NaN`"),
        ("k,step,symbol,index,node,component,value\n0,0,y_p,0,,0,1\n", "`y_p` is not a symbol"),
        ("k,step,symbol,index,node,component,value\n0,-1,x_p,0,,0,1\n", "`-1`"),
        (
            "k,step,symbol,index,node,component,value\n0,0,x_p,0,,0,1\n0,0,x_p,0,,0,1\n",
            "stands in line 2",
        ),
        ("k,step,symbol,index,node,component,value\n0,0,x_p,0\n", "line 2"),
    ] {
        let fault = check::read("port.csv", text.as_bytes()).unwrap_err().to_string();
        assert!(fault.contains(words) && fault.contains("port.csv"), "{fault}");
    }
}
