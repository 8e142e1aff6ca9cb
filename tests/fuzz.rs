//! Shipped scenes, changed at random: what comes out is a run of finite numbers, one that is
//! stopped by name, or a refusal that names its key; never a panic.
//!
//! `FUZZ_CASES=100000 cargo test fuzz_` tries so many cases in place of the few that every test
//! run tries. Each case has its own seed, its number, so that a failure comes back alone:
//! `FUZZ_FIRST=12345 FUZZ_CASES=1 cargo test fuzz_`.

use crate::support::*;
use lme_mpm::method::breakdown::Breakdown;
use lme_mpm::run::parse_within;
use lme_mpm::run::run_knowing;
use lme_mpm::run::stability::runnable;
use lme_mpm::run::table::Table;
use lme_mpm::scene::fault::Fault;
use lme_mpm::scene::keys::{AXES, KEYS, SIDES};
use lme_mpm::scene::{Budget, SHIPPED, Scene, shipped};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// As many cases are tried in every test run.
const CASES: u64 = 3000;

/// A case ends after as many steps, and has as many pairs at most.
const STEPS: usize = 12;
const PAIRS: f64 = 3e4;

/// A case may take no more, so that many can be tried.
const SMALL: Budget = Budget { memory: 3e7, work: 1e12 };

/// What a number may become.
const NUMBERS: &[&str] = &[
    "0",
    "-0.0",
    "1e-320",
    "-1e-320",
    "1e-300",
    "1e-150",
    "1e-30",
    "1e-9",
    "1e-3",
    "0.4999999999999999",
    "0.5",
    "1",
    "1.0000000000000002",
    "-1",
    "2",
    "3",
    "64",
    "65",
    "1e3",
    "1e9",
    "1e30",
    "1e150",
    "1e300",
    "1.7976931348623157e308",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "-9223372036854775808",
];

/// What a word may become; TOML as it stands.
const WORDS: &[&str] = &[
    "\"\"",
    "\"linear\"",
    "\"lme\"",
    "\"ugimp\"",
    "\"bspline\"",
    "\"otm\"",
    "\"mpm\"",
    "\"consistent\"",
    "\"ball\"",
    "\"newmark\"",
    "\"forward-euler\"",
    "\"generalized-alpha\"",
    "\"implicit-newmark\"",
    "\"quasi-static\"",
    "\"last\"",
    "\"neo-hookean\"",
    "\"hencky\"",
    "\"fixed\"",
    "\"free\"",
    "\"NaN\"",
    "\"newmark \"",
    "\"ＬＭＥ\"",
    "\"γ\\u0000\"",
    "\"a\\u001Bb\"",
    "\"../x\"",
    "\"con\"",
];

/// What has another type than most values.
const TYPES: &[&str] = &[
    "true",
    "false",
    "[]",
    "[1]",
    "[1, 1]",
    "[1, 1, 1, 1]",
    "[[1], [2]]",
    "{}",
    "{ x = 1 }",
    "{ left = \"fixed\" }",
    "1979-05-27",
    "07:32:00",
    "\"text\"",
    "'1'",
    "[\"x\", 1]",
];

/// What a letter may become.
const LETTERS: &[&str] =
    &["0", "9", "-", "e", ".", "\"", "[", "]", "{", "}", "=", "\n", "#", "µ", "\0", "\u{7f}", " "];

/// Numbers that are the same in every run: splitmix64.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n as u64) as usize
    }

    fn pick<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }
}

/// A group of changes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Group {
    Extreme,
    Numbers,
    Word,
    Type,
    Missing,
    Doubled,
    Neighbour,
    Any,
    Letters,
}

const GROUPS: [(Group, &str); 9] = [
    (Group::Extreme, "a number becomes an extreme one"),
    (Group::Numbers, "three numbers change and most a little"),
    (Group::Word, "a value becomes a word"),
    (Group::Type, "a value becomes one of another type"),
    (Group::Missing, "a line is missing"),
    (Group::Doubled, "a line is doubled"),
    (Group::Neighbour, "a key becomes one beside it"),
    (Group::Any, "any key is set to a number or a word"),
    (Group::Letters, "letters are replaced"),
];

/// Case number `n`: its scene's name, text and sets, and its group.
fn case(n: u64) -> (&'static str, String, Vec<String>, usize) {
    let random = &mut Random(n.wrapping_mul(0xd134_2543_de82_ef95));
    let which = random.below(GROUPS.len());
    let base = &SHIPPED[random.below(SHIPPED.len())];
    let mut lines: Vec<String> = base.text.lines().map(String::from).collect();
    let (mut sets, group) = (Vec::new(), GROUPS[which].0);
    let count = if group == Group::Numbers { 3 } else { 1 };
    for _ in 0..count {
        change(&mut lines, &mut sets, group, random);
    }
    (base.name, lines.join("\n"), sets, which)
}

/// Makes one change.
fn change(lines: &mut Vec<String>, sets: &mut Vec<String>, group: Group, random: &mut Random) {
    let with = |test: &dyn Fn(&str) -> bool| -> Vec<usize> {
        let code = |line: &&String| !line.starts_with('#');
        let value = |line: &String| {
            Some(line)
                .filter(code)
                .and_then(|line| line.split_once(" = "))
                .is_some_and(|(_, value)| test(value))
        };
        (0..lines.len()).filter(|n| value(&lines[*n])).collect()
    };
    let is_number = |value: &str| value.starts_with(|c: char| "-.[0123456789".contains(c));
    let all = match group {
        Group::Extreme | Group::Numbers => with(&is_number),
        _ => with(&|_| true),
    };
    let n = all[random.below(all.len())];
    let (key, value) = lines[n].split_once(" = ").unwrap();
    let (key, value) = (key.to_string(), value.to_string());
    match group {
        Group::Extreme | Group::Numbers => {
            let other = random.pick(NUMBERS);
            // Near its own value more comes of a scene.
            let factor = [0.1, 0.5, 0.999, 1.001, 2.0, 10.0][random.below(6)];
            let own = value.split('#').next().unwrap().trim().parse::<f64>();
            let near = own.map(|own| match own.fract() == 0.0 && random.below(2) == 0 {
                true => format!("{}", (own * factor).ceil()),
                false => format!("{:e}", own * factor),
            });
            let other = match near {
                Ok(near) if group == Group::Numbers && random.below(4) > 0 => near,
                _ => other.to_string(),
            };
            let other = other.as_str();
            lines[n] = match value.matches(',').count() {
                _ if !value.starts_with('[') => format!("{key} = {other}"),
                commas => {
                    let entries: Vec<&str> = (0..=commas)
                        .map(|_| if random.below(2) == 0 { other } else { "1" })
                        .collect();
                    format!("{key} = [{}]", entries.join(", "))
                }
            };
        }
        Group::Word => lines[n] = format!("{key} = {}", random.pick(WORDS)),
        Group::Type => lines[n] = format!("{key} = {}", random.pick(TYPES)),
        Group::Missing => drop(lines.remove(n)),
        Group::Doubled => {
            let to = random.below(lines.len() + 1);
            lines.insert(to, format!("{key} = {value}"));
        }
        Group::Neighbour => {
            let mut letters: Vec<char> = key.chars().collect();
            let at = random.below(letters.len());
            match random.below(3) {
                0 => drop(letters.remove(at)),
                1 => letters.insert(at, letters[at]),
                _ => letters[at] = ['a', '_', 'é', '.'][random.below(4)],
            }
            lines[n] = format!("{} = {value}", letters.into_iter().collect::<String>());
        }
        Group::Any => {
            let path = KEYS[random.below(KEYS.len())].path;
            let (side, axis) = (SIDES[random.below(3)][random.below(2)], AXES[random.below(3)]);
            let path = path.replace("<side>", side).replace("<axis>", axis);
            let path = ["probe", "initial_velocity", "body.ball"]
                .iter()
                .fold(path, |path, list| path.replace(&format!("{list}."), &format!("{list}.0.")));
            let list = [NUMBERS, NUMBERS, WORDS, TYPES, &[""]][random.below(5)];
            sets.push(format!("{path}={}", random.pick(list)));
        }
        Group::Letters => {
            let mut letters: Vec<String> = lines.join("\n").chars().map(String::from).collect();
            for _ in 0..=random.below(3) {
                let at = random.below(letters.len());
                letters[at] = random.pick(LETTERS).to_string();
            }
            *lines = letters.concat().split('\n').map(String::from).collect();
        }
    }
}

/// Reads a scene as `lme-mpm run` does, and runs `steps` steps of it if it has no more than
/// `pairs` pairs; says what came out: `refused KEY`, `stops NAME`, `runs`, or `read` alone.
fn outcome_of(text: &str, sets: &[String], budget: &Budget, steps: usize, pairs: f64) -> String {
    let scene = match parse_within(budget, "fuzz", "fuzz.toml", text, sets) {
        Ok(scene) => scene,
        Err(error) => {
            assert!(!error.problem.is_empty() && error.to_string().len() > 20, "{error:?}");
            assert!(error.span.end <= error.text.len(), "{error:?}");
            let key = if error.key.is_empty() { "TOML" } else { &error.key };
            return format!("refused {key}");
        }
    };
    if scene.sizes().0 * scene.pairs_per_particle() > pairs {
        return "read".to_string();
    }
    let limit = match runnable(&scene) {
        Ok(limit) => limit,
        Err(Fault::Unstable { courant, largest, .. }) => {
            assert!(!courant.is_nan() && !largest.is_nan() && courant > largest);
            return "refused Δt".to_string();
        }
        Err(other) => panic!("{other}"),
    };
    let ended = run_knowing(&scene, limit, &mut |step| match step >= steps {
        true => ControlFlow::Break(Breakdown::Interrupted),
        false => ControlFlow::Continue(()),
    });
    let (history, name) = match &ended {
        Ok(outcome) => {
            assert_finite(&outcome.particles);
            (&outcome.history, "Interrupted".to_string())
        }
        Err(stopped) => {
            let words = format!("{:?}", stopped.broken.breakdown);
            assert!(stopped.broken.to_string().len() > 30);
            (&stopped.history, words.split([' ', '{', '(']).next().unwrap().to_string())
        }
    };
    assert_finite(history);
    if name != "Interrupted" {
        return format!("stops {name}");
    }
    assert_balanced(&scene, history);
    "runs".to_string()
}

fn assert_finite(table: &Table) {
    assert!(table.rows().all(|row| row.iter().all(|x| x.is_finite())), "not a number in a table");
}

/// The energy of a run that was not stopped is at most ten times what start and loads gave it; one
/// that was given none has none. The work of loads is no finer than the last bit of a coordinate.
fn assert_balanced(scene: &Scene, history: &Table) {
    let total = total_energy(history);
    let work = history.column("work").unwrap_or(vec![0.0; total.len()]);
    let moved: f64 = work.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
    let given = total.first().unwrap_or(&0.0) + moved;
    let last = *total.last().unwrap_or(&0.0);
    let length = largest(scene.body.length.iter().copied());
    let volume: f64 = scene.body.length.iter().product();
    let body = scene.body_force.iter().flat_map(|body| body.acceleration.iter());
    let body = body.map(|b| b.abs() * scene.body.density * volume);
    let sides = scene.traction.iter().flat_map(|load| load.sides.iter().zip(&scene.body.length));
    let sides = sides
        .flat_map(|(sides, length)| sides.iter().flatten().map(move |t| t.abs() * volume / length));
    let force: f64 = body.chain(sides).sum();
    let steps = history.column("step").and_then(|steps| steps.last().copied()).unwrap_or(0.0);
    let fine = force * f64::EPSILON * length * steps;
    // A strain may be some last bits, and squares of small numbers underflow.
    let bits = (100.0 * f64::EPSILON).powi(2) * scene.body.youngs_modulus * volume + 1e-280;
    let enough = last <= 10.0 * given + fine + bits || scene.every > 1;
    assert!(enough, "{last:e} J, and {given:e} J were given");
}

/// GOAL: no scene makes the program panic, hang, or write what is no number.
/// SETUP: shipped scenes with changes in nine groups, each case by a seed of its own.
/// EXPECTED: refusals with key and words, runs stopped by name, runs with finite numbers whose
/// energy is bounded; how many of each is approved for the cases that every test run tries.
#[test]
fn fuzz_cases() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (first, cases) = (number("FUZZ_FIRST").unwrap_or(0), number("FUZZ_CASES"));
    let mut counts = [[0_u64; 5]; GROUPS.len()];
    let mut failed = Vec::new();
    for n in first..first + cases.unwrap_or(CASES) {
        let (name, text, sets, group) = case(n);
        let start = Instant::now();
        let outcome =
            catch_unwind(AssertUnwindSafe(|| outcome_of(&text, &sets, &SMALL, STEPS, PAIRS)));
        let took = start.elapsed().as_secs_f64();
        if took > 10.0 {
            println!("case {n} of {name} {sets:?} took {took:.0} s: {outcome:?}");
        }
        let Ok(outcome) = outcome else {
            println!("case {n}: {name} {sets:?}\n{}", changes(name, &text));
            failed.push(n);
            continue;
        };
        let kinds = ["refused", "stops", "runs", "read"];
        let kind = kinds.iter().position(|kind| outcome.starts_with(kind)).unwrap();
        counts[group][0] += 1;
        counts[group][1 + kind] += 1;
    }
    let mut table = String::from("change,cases,refused,stopped by name,ran,read only\n");
    for ((_, words), counts) in GROUPS.iter().zip(counts) {
        writeln!(table, "{words},{}", counts.map(|count| count.to_string()).join(",")).unwrap();
    }
    println!("{table}");
    assert!(failed.is_empty(), "these cases failed: {failed:?}");
    if cases.is_none() && first == 0 {
        approve("extremes__fuzz", &table);
    }
}

/// The lines of `text` that the shipped scene does not have.
fn changes(name: &str, text: &str) -> String {
    let own = shipped(name).unwrap().text;
    text.lines().filter(|line| !own.lines().any(|one| one == *line)).collect::<Vec<_>>().join("\n")
}

/// GOAL: what went wrong once stays right.
/// SETUP: the scenes of `data/fuzz/corpus.csv`: the name of a shipped one, and what `--set` says.
/// EXPECTED: the outcome that stands there.
#[test]
fn fuzz_corpus() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/fuzz/corpus.csv");
    let mut count = 0;
    for row in csv::Reader::from_path(path).unwrap().records().map(Result::unwrap) {
        let (text, expected) = (shipped(&row[0]).unwrap().text, &row[2]);
        let sets: Vec<String> = row[1].split(' ').map(String::from).collect();
        let outcome = outcome_of(text, &sets, &Budget::default(), usize::MAX, f64::INFINITY);
        assert_eq!(outcome, expected, "{} with {}", &row[0], &row[1]);
        count += 1;
    }
    assert!(count >= 7);
}
