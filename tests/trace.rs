//! Traces, and their comparison.

use crate::support::*;
use lme_mpm::port::check::{self, Asked, Tolerance, compare, compare_as, ulps};
use lme_mpm::port::trace::{self, Entry, hex, number, trace_in};
use lme_mpm::scene::Scene;
use lme_mpm::scene::fault::Fault;
use nalgebra::Vector1;

const USUAL: Tolerance = Tolerance { relative: 1e-9, absolute: 1e-12 };

/// A trace takes the same steps as a run: the same bits after ten of them, for every
/// scheme, both masses, OTM, loads, and more than one dimension.
#[test]
fn trace_is_the_run() {
    fn same<const D: usize>(scene: &Scene) {
        let (entries, traced) = trace_in::<D>(scene, 10).unwrap();
        let (model, mut state) = at_start::<D>(scene);
        march(&model, &mut state, 10);
        assert_eq!(state.particle, traced.particle);
        assert_eq!(state.node, traced.node);
        let last: Vec<&Entry> = entries.iter().filter(|e| e.k == 10 && e.symbol == "x_p").collect();
        assert_eq!(last.len(), D * state.particle.len());
        for entry in last {
            assert_eq!(entry.value, state.particle.x[entry.index][entry.component]);
        }
    }
    for scheme in SCHEMES {
        for mass in MASSES {
            for basis in [LINEAR, LME_MIDDLE] {
                let small = ["grid.cells=6", "time.cfl=0.2"];
                same::<1>(&dyka(&[scheme.sets, mass.sets, basis.sets, &small].concat()));
            }
        }
        let loads = ["body_force.acceleration=5", "traction.right=1e6", "grid.cells=6"];
        same::<1>(&dyka(&[scheme.sets, &loads].concat()));
    }
    same::<1>(&dyka(&[LME_NARROW.sets, &["method=otm", "grid.cells=6"]].concat()));
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
    assert_eq!(["0x", "0x1.8", "abc", ""].map(number), [None; 4]);
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
    let report = compare(&all, &all.clone().into(), USUAL, false).unwrap();
    assert_eq!((report.compared, report.divergence, report.missing.len()), (all.len(), None, 0));
    // A part agrees, and the rest is named.
    let part: Vec<Entry> = all.iter().filter(|e| e.symbol == "v_p").cloned().collect();
    let report = compare(&all, &part.into(), USUAL, false).unwrap();
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
    let report = compare(&all, &wrong.clone().into(), USUAL, false).unwrap();
    let divergence = report.divergence.clone().unwrap();
    assert_eq!((divergence.reference.k, divergence.reference.symbol), (2, "sigma_p"));
    assert!(divergence.ulps > 1_000_000);
    let text = report.text();
    for word in ["k = 2, step 6", "sigma_p of (3)", "governing-equations.html#eq-3", "likely: "] {
        assert!(text.contains(word), "{text}");
    }
    // Within the tolerance nothing is found.
    let loose = Tolerance { relative: 1e-5, ..USUAL };
    let report = compare(&all, &wrong.clone().into(), loose, false).unwrap();
    assert_eq!(report.divergence.unwrap().reference.symbol, "m_I");
    // Also in a reference whose lines are in another order.
    let mut reversed = all.clone();
    reversed.reverse();
    let report = compare(&reversed, &wrong.into(), USUAL, false).unwrap();
    assert_eq!(report.divergence, Some(divergence));
    // What cannot be compared.
    let mut more = all.clone();
    more[0].index = 99;
    assert!(matches!(compare(&all, &more.into(), USUAL, false), Err(Fault::Alone { .. })));
    assert!(matches!(compare(&all, &vec![].into(), USUAL, false), Err(Fault::Alone { .. })));
    for (text, words) in [
        ("k,step,symbol,index,component,value\n", "no column `node`"),
        ("k,step,symbol,index,node,component,value\n0,0,x_p,0,,0,NaN\n", "`NaN`"),
        ("k,step,symbol,index,node,component,value\n0,0,y_p,0,,0,1\n", "`y_p` is not a symbol"),
        ("k,step,symbol,index,node,component,value\n0,-1,x_p,0,,0,1\n", "`-1`"),
        (
            "k,step,symbol,index,node,component,value\n0,0,x_p,0,,0,1\n0,0,x_p,0,,0,1\n",
            "stands in line 2",
        ),
        ("k,step,symbol,index,node,component,value\n0,0,x_p,0\n", "line 2: 4 cells instead of 7"),
        ("k,step,symbol,index,node,component,value,k\n", "`k` is there twice"),
        ("k,step,symbol,index,node,component,value\r\n\r\n0,0,x_p,0,,0,x\r\n", "line 3: `x`"),
        ("k,step,symbol,index,node,component,value\r0,0,x_p,0,,0,1\r0,0,x_p,1,,0,x", "line 3: `x`"),
        (
            "k,step,symbol,index,node,component,value\n\n0,0,x_p,0,,0,\"1\n2\"\n",
            "line 3: the quoted",
        ),
        ("k,step,symbol,index,node,component,value\n0,3,m_I,0,0,0,1\n", "m_I is not a pair"),
        (
            "k,step,symbol,index,node,component,value\n0,2,N_Ip,0,,0,1\n",
            "`` is not a value of node",
        ),
        (
            "k,step,symbol,index,node,component,value\n0,0,x_p,0,,0,0x1.8p-2147483648\n",
            "`0x1.8p-2147",
        ),
    ] {
        let fault = check::read("port.csv", text.as_bytes()).unwrap_err().to_string();
        assert!(fault.contains(words) && fault.contains("port.csv"), "{fault}");
    }
}

/// Of a symbol in a time step all numbers must be there, and no others; nodes that a
/// particle does not see are 0 on both sides. What differs is said first.
#[test]
fn check_wants_whole_symbols() {
    let all = reference(&["grid.cells=4"], 2);
    let without = |skip: &dyn Fn(&Entry) -> bool| -> check::Printed {
        all.iter().filter(|e| !skip(e)).cloned().collect::<Vec<Entry>>().into()
    };
    let with = |more: &[Entry]| -> check::Printed { [&all[..], more].concat().into() };
    let seen = all.iter().find(|e| e.k == 2 && e.symbol == "N_Ip" && e.value > 0.1).unwrap();
    let refused = |theirs: &check::Printed, words: &str| {
        let fault = compare(&all, theirs, USUAL, false).unwrap_err().to_string();
        assert!(fault.contains(words) && fault.contains("--part"), "{fault}");
    };
    // A number in the middle is missing: refused, unless a part is asked for.
    let gap = without(&|e| (e.k, e.symbol, e.index) == (2, "m_I", 3));
    refused(&gap, "no m_I of k = 2, step 3, index 3, component 0");
    let report = compare(&all, &gap, USUAL, true).unwrap();
    assert_eq!((report.compared, report.missing["m_I"]), (all.len() - 1, 1));
    assert!(report.text().starts_with(&format!("{} of {} num", all.len() - 1, all.len())));
    // A node that the particle sees is not there: its N is 0.
    let blind = without(&|e| e == seen);
    let report = compare(&all, &blind, USUAL, false).unwrap();
    let found = report.divergence.unwrap();
    assert_eq!((&found.reference, found.theirs), (seen, 0.0));
    // One that it does not see may be there with 0.
    let far = Entry { node: Some(99), value: 0.0, ..seen.clone() };
    let report = compare(&all, &with(std::slice::from_ref(&far)), USUAL, false).unwrap();
    assert_eq!((report.compared, report.divergence), (all.len() + 1, None));
    // With a value it is the first difference in the paper's order, part or not.
    let wrong = [3, 1].map(|index| Entry { index, value: 0.5, ..far.clone() });
    for part in [false, true] {
        let report = compare(&all, &with(&wrong), USUAL, part).unwrap();
        assert_eq!(report.divergence.unwrap().reference.index, 1);
    }
    // A particle or component that is not there.
    refused(&with(&[Entry { index: 99, ..far.clone() }]), "there is N_Ip of k = 2");
    refused(&with(&[Entry { component: 7, ..far.clone() }]), "component 7");
    // What is there too much is counted, and a difference comes before it.
    let mut more = Entry { index: 99, ..seen.clone() };
    more.value *= 2.0;
    let report = compare(&all, &with(&[more.clone()]), USUAL, true).unwrap();
    assert_eq!((report.extra, report.divergence.is_none()), (1, true));
    assert!(report.text().contains("the reference has none: 1"));
    let report = compare(&all, &with(&[more, wrong[0].clone()]), USUAL, false).unwrap();
    assert!(report.divergence.is_some());
    // Where nothing of a time step before the difference was compared, that is said.
    let mut late = all.clone();
    late.retain(|e| e.k != 1);
    late.iter_mut().filter(|e| e.k == 2 && e.symbol == "v_p").for_each(|e| e.value += 1.0);
    let report = compare(&all, &late.into(), USUAL, false).unwrap();
    assert!(report.text().contains("nothing of k = 1 was compared"), "{}", report.text());
}

/// What is likely is said of the right mistakes, and of no others.
#[test]
fn check_names_the_usual_cause() {
    let linear = reference(&["grid.cells=4"], 2);
    let lme = reference(&["grid.cells=4", "basis.kind=lme", "basis.gamma=0.8"], 2);
    let said = |all: &[Entry], change: &dyn Fn(&mut Entry)| {
        let mut theirs = all.to_vec();
        theirs.iter_mut().for_each(change);
        compare(all, &theirs.into(), USUAL, true).unwrap().text()
    };
    let turned = |symbol: &'static str| {
        move |e: &mut Entry| {
            if e.symbol == symbol {
                e.value = -e.value;
            }
        }
    };
    let shifted = |step: usize| {
        move |e: &mut Entry| {
            if (e.symbol, e.step) == ("v_p", step) && e.k == 2 {
                e.index += 1;
            }
        }
    };
    let scaled = |symbol: &'static str, step: usize| {
        move |e: &mut Entry| {
            if (e.symbol, e.step) == (symbol, step) {
                e.value *= 1.5;
            }
        }
    };
    let nodes_from_one = |e: &mut Entry| e.node = e.node.map(|node| node + 1);
    let kept = |symbol: &'static str| {
        move |e: &mut Entry| {
            if e.symbol == symbol && e.index == 0 {
                e.value += 1.0;
            }
        }
    };
    type Change<'a> = Box<dyn Fn(&mut Entry) + 'a>;
    let cases: [(&[Entry], Change, &str); 16] = [
        (&linear, Box::new(turned("grad_N_Ip")), "the sign of ∇N"),
        (&lme, Box::new(turned("lambda")), "the sign of λ"),
        (&linear, Box::new(turned("f_int_I")), "f_int = −Σ σ ∇N m/ρ"),
        (&linear, Box::new(shifted(1)), "numbered off by one"),
        (&linear, Box::new(shifted(9)), "numbered off by one"),
        (&linear, Box::new(nodes_from_one), "nodes are numbered off by one"),
        (&lme, Box::new(nodes_from_one), "nodes are numbered off by one"),
        (&linear, Box::new(scaled("N_Ip", 2)), "all have the factor 1.5"),
        (&lme, Box::new(scaled("N_Ip", 2)), "all have the factor 1.5"),
        (&linear, Box::new(scaled("dt", 0)), "Δt = T/n"),
        (&linear, Box::new(scaled("x_p", 0)), "the start: each particle"),
        (&linear, Box::new(scaled("x_p", 1)), "(27) moves with the nodes"),
        (&linear, Box::new(scaled("v_p", 1)), "(28) is half a step"),
        (&linear, Box::new(scaled("v_p", 9)), "(29) is half a step"),
        (&linear, Box::new(kept("f_I")), "a fixed node keeps"),
        (&linear, Box::new(kept("d_eps_p")), "at k = 0 Δt is 0"),
    ];
    for (all, change, words) in cases {
        let text = said(all, &*change);
        assert!(text.contains(words), "{words}:\n{text}");
    }
    // No node is fixed in a bar that flies: nothing of the kind is said.
    let flight = trace::trace(&scene(FREE_FLIGHT, &[]), 1).unwrap();
    let text = said(&flight, &kept("f_I"));
    assert!(text.contains("f_I of (18)") && !text.contains("a fixed node keeps"), "{text}");
}

/// With the consistent mass matrix p_I and f_I are the paper's, too: off the fixed node
/// f_I = f_int_I, and step 8 adds γ f_I Δt to the p_I of step 3. Three time steps of the bar
/// on 4 cells, two particles per cell.
#[test]
fn trace_means_the_same_with_both_masses() {
    for mass in ["mass=lumped", "mass=consistent"] {
        let scene = dyka(&["grid.cells=4", "time.cfl=0.2", mass]);
        let entries = trace::trace(&scene, 3).unwrap();
        let dt = scene.time.end / scene.step_count();
        let list = |k: usize, symbol: &str| -> Vec<f64> {
            let own = entries.iter().filter(|e| e.k == k && e.symbol == symbol && e.index > 0);
            own.map(|entry| entry.value).collect()
        };
        for k in 1..=3 {
            let (f, p) = (list(k, "f_I"), list(k, "p_I"));
            assert!(f.iter().any(|f_I| f_I.abs() > 1.0) || k == 1);
            assert_eq!(f, list(k, "f_int_I"), "{mass}, k = {k}");
            for (I, advanced) in list(k, "p_I_advanced").into_iter().enumerate() {
                assert_eq!(advanced, p[I] + f[I] * (0.5 * dt), "{mass}, k = {k}, node {}", I + 1);
            }
        }
    }
}

/// With a hyperelastic law a trace has G_p and F_p = (1 + G_p) F_p of the step before, and the
/// stress of that F, in place of Δε_p; with the rate law and consistent kinematics it has both
/// G_p and Δε_p = G/(1 + G/2): the bar, every scheme, three time steps.
#[test]
fn trace_of_finite_strain() {
    for scheme in SCHEMES {
        for (law, kinematics) in
            [("neo-hookean", "as-printed"), ("neo-hookean", "consistent"), ("rate", "consistent")]
        {
            let sets = [
                &format!("body.law={law}")[..],
                &format!("time.kinematics={kinematics}"),
                "grid.cells=4",
            ];
            let scene = dyka(&[scheme.sets, &sets].concat());
            let (entries, state) = trace_in::<1>(&scene, 3).unwrap();
            let of = |k: usize, symbol: &str| -> Vec<f64> {
                let own = entries.iter().filter(|e| e.k == k && e.symbol == symbol);
                own.map(|e| e.value).collect()
            };
            let name = format!("{}, {law}, {kinematics}", scheme.name);
            for k in 1..=3 {
                let G = of(k, "G_p");
                assert_eq!(G.len(), 8, "{name}");
                if law == "rate" {
                    let d_eps: Vec<f64> = G.iter().map(|G| G / (1.0 + G / 2.0)).collect();
                    assert!(
                        apart(&of(k, "d_eps_p"), &d_eps) < 1e-18 && of(k, "F_p").is_empty(),
                        "{name}"
                    );
                    continue;
                }
                let before = if k == 1 { vec![1.0; 8] } else { of(k - 1, "F_p") };
                let F: Vec<f64> = G.iter().zip(&before).map(|(G, F)| (1.0 + G) * F).collect();
                assert!(of(k, "F_p") == F && of(k, "d_eps_p").is_empty(), "{name}");
                let law = scene.body.elastic();
                let sigma = F.iter().map(|F| law.stress_of(&Vector1::new(*F))[0]);
                assert_eq!(of(k, "sigma_p"), sigma.collect::<Vec<_>>(), "{name}");
            }
            assert!(state.particle.sigma.iter().any(|sigma| sigma[0].abs() > 1e5), "{name}");
        }
    }
}

/// `skip` leaves a symbol out, `from` begins later, `all` finds the first difference of every
/// symbol; places are compared before what is made at them.
#[test]
fn check_does_what_is_asked() {
    let all = reference(&["grid.cells=4"], 3);
    let mut wrong = all.clone();
    for entry in &mut wrong {
        if (entry.k, entry.symbol) == (1, "sigma_p") || (entry.k, entry.symbol) == (3, "x_p") {
            entry.value *= 1.5;
        }
    }
    let asked = Asked::whole(USUAL, false);
    let found = |asked: &Asked| {
        let report = compare_as(&all, &wrong.clone().into(), asked).unwrap();
        let each = report.each.iter().map(|d| (d.reference.k, d.reference.symbol));
        (each.collect::<Vec<_>>(), report)
    };
    assert_eq!(found(&asked).0, [(1, "sigma_p")]);
    let skip = Asked { skip: vec!["sigma_p".into()], ..asked.clone() };
    assert_eq!(found(&skip).0, [(3, "x_p")]);
    assert_eq!(found(&Asked { from: 2, ..asked.clone() }).0, [(3, "x_p")]);
    let (each, report) = found(&Asked { all: true, ..asked });
    assert_eq!(each, [(1, "sigma_p"), (3, "x_p")]);
    assert!(report.text().contains("every symbol") && report.text().contains("k = 3, step 1, x_p"));
    // At the start of OTM all stands in step 0.
    let otm = reference(&["grid.cells=4", "method=otm", "basis.kind=lme", "basis.gamma=4"], 1);
    let moved = |e: &Entry| match e.symbol {
        "x_p" | "N_Ip" | "m_I" => Entry { value: e.value * 1.01, ..e.clone() },
        _ => e.clone(),
    };
    let moved: Vec<Entry> = otm.iter().map(moved).collect();
    let report = compare(&otm, &moved.into(), USUAL, false).unwrap();
    assert_eq!(report.divergence.unwrap().reference.symbol, "x_p");
}
