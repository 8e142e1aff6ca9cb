//! The tie between paper, code, tests and book, held from both ends; and every
//! command in book and README, run as it is printed.

use crate::support::{approve, program};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const OPEN: &str = "not in the code yet";
const DEFINITION: &str = "definition only: ";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Files below `folder` with this ending, as (path from the top, text).
fn files(folder: &str, ending: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(root().join(folder)).unwrap() {
        let entry = entry.unwrap();
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.file_type().unwrap().is_dir() {
            found.extend(files(&path, ending));
        } else if path.ends_with(ending) {
            let text = read(&path);
            found.push((path, text));
        }
    }
    found.sort();
    found
}

/// The chapters of the book: `algorithm.md`, …
fn chapters() -> Vec<(String, String)> {
    let name = |path: &str| path.replacen("book/src/", "", 1);
    let chapters = files("book/src", ".md").into_iter().map(|(path, text)| (name(&path), text));
    chapters.filter(|(path, _)| !["SUMMARY.md", "404.md"].contains(&path.as_str())).collect()
}

fn records(path: &str) -> Vec<Vec<String>> {
    let text = read(path);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect()
}

/// True where `file` defines a function, type or constant called `item`.
fn defines(file: &str, item: &str) -> bool {
    let text = read(file);
    ["fn", "struct", "enum", "const"].iter().any(|word| {
        let wanted = format!("{word} {item}");
        text.match_indices(&wanted).any(|(at, _)| {
            let next = text[at + wanted.len()..].chars().next();
            !next.is_some_and(|c| c.is_alphanumeric() || c == '_')
        })
    })
}

/// `\tag{n}` for every display formula of a text.
fn tags(text: &str) -> Vec<String> {
    text.split("\\tag{").skip(1).map(|rest| rest.split('}').next().unwrap().to_string()).collect()
}

/// Equations (1) to (59) and steps 1 to 9, each in one row.
#[test]
fn equations_are_complete() {
    let rows = records("data/equations.csv");
    let numbers: Vec<String> =
        rows.iter().map(|row| row[0].clone()).filter(|n| !n.is_empty()).collect();
    assert_eq!(numbers, (1..=59).map(|n| n.to_string()).collect::<Vec<_>>());
    let steps: Vec<String> =
        rows.iter().map(|row| row[1].clone()).filter(|n| !n.is_empty()).collect();
    assert_eq!(steps, (1..=9).map(|n| n.to_string()).collect::<Vec<_>>());
}

/// What a row names exists: the item, the test, the place in the book. What it
/// does not name, it says why.
#[test]
fn equations_lead_somewhere() {
    for row in records("data/equations.csv") {
        let [number, step, says, code, chapter, test] = row.try_into().unwrap();
        let name = format!("equation {number}, step {step}");
        assert!(!says.is_empty(), "{name}");
        match code.split_once("::") {
            Some((file, item)) => {
                assert!(file.starts_with("src/"), "{name}: {code}");
                assert!(defines(file, item), "{name}: {code} is not defined");
                assert!(test.contains("::"), "{name}: code without a test");
            }
            None => {
                let reason = code.strip_prefix(DEFINITION).unwrap_or("");
                assert!(code == OPEN || reason.len() > 10, "{name}: {code}");
            }
        }
        match test.split_once("::") {
            Some((file, item)) => {
                assert!(file.starts_with("tests/"), "{name}: {test}");
                assert!(read(file).contains(&format!("fn {item}(")), "{name}: no test {test}");
            }
            None => {
                let reason = test.strip_prefix(DEFINITION).unwrap_or("");
                assert!(test == OPEN || reason.len() > 10, "{name}: {test}");
                assert_eq!(code == OPEN, test == OPEN, "{name}");
            }
        }
        if chapter.is_empty() {
            assert_eq!(code, OPEN, "{name}: not in the book");
            continue;
        }
        let (file, place) = chapter.split_once(".html#").unwrap();
        let text = read(&format!("book/src/{file}.md"));
        let found = match place.strip_prefix("eq-") {
            Some(n) => n == number && tags(&text).contains(&number),
            None => place == format!("step-{step}") && text.contains(&format!("{{#{place}}}")),
        };
        assert!(found, "{name}: {chapter} is not in the book");
    }
}

/// Every numbered formula and every step of the book is in the index, with
/// that place, and stands only once.
#[test]
fn equations_of_the_book_are_indexed() {
    let mut places: BTreeMap<String, String> = BTreeMap::new();
    for (chapter, text) in chapters() {
        let html = chapter.replace(".md", ".html");
        for n in tags(&text) {
            let place = format!("{html}#eq-{n}");
            let before = places.insert(n.clone(), place);
            assert_eq!(before, None, "({n}) stands twice");
        }
    }
    let rows = records("data/equations.csv");
    for (n, place) in &places {
        let row = rows.iter().find(|row| row[0] == *n).unwrap_or_else(|| panic!("no row ({n})"));
        assert_eq!(row[4], *place);
    }
}

/// Every test that the book names exists: `like_this` in a sentence with "Test".
#[test]
fn named_tests_exist() {
    let sources: String = files("tests", ".rs").into_iter().map(|(_, text)| text).collect();
    let mut names = 0;
    for (chapter, text) in chapters() {
        for sentence in text.split("Test:").skip(1).chain(text.split("Tests:").skip(1)) {
            let sentence = sentence.split("\n\n").next().unwrap();
            for name in sentence.split('`').skip(1).step_by(2) {
                let plain =
                    name.chars().all(|c| c.is_ascii_lowercase() || c == '_' || c.is_ascii_digit());
                if plain && name.contains('_') {
                    assert!(sources.contains(&format!("fn {name}(")), "{chapter}: no test {name}");
                    names += 1;
                }
            }
        }
    }
    assert!(names > 10, "{names}");
}

/// Every file that README, changelog or book names in code letters exists.
#[test]
fn named_files_exist() {
    let mut texts = chapters();
    texts.extend(["README.md", "CHANGELOG.md"].map(|path| (path.to_string(), read(path))));
    let mut count = 0;
    for (name, text) in texts {
        for word in text.split('`').skip(1).step_by(2) {
            let plain = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
            let ours = ["src/", "tests/", "data/", "snapshots/", "book/"];
            if ours.iter().any(|start| word.starts_with(start))
                && word.chars().all(plain)
                && !word.contains("NAME")
            {
                assert!(root().join(word).exists(), "{name} names {word}");
                count += 1;
            }
        }
    }
    assert!(count > 40, "{count}");
}

/// Every snapshot belongs to a test that names it, whole or by its parts.
#[test]
fn snapshots_have_tests() {
    let sources: String = files("tests", ".rs").into_iter().map(|(_, text)| text).collect();
    for entry in fs::read_dir(root().join("snapshots")).unwrap() {
        let file = entry.unwrap().file_name().to_string_lossy().into_owned();
        let name = file.split(".snap").next().unwrap().to_string();
        let stem = name.split("__").next().unwrap();
        let made =
            sources.contains(&format!("\"{name}\"")) || sources.contains(&format!("\"{stem}__{{"));
        assert!(made, "snapshots/{file} belongs to no test");
    }
}

/// The rows and columns of a long table that stand in view above its fold: the short table's
/// name, the long one's, words that a row must have (rows with any of these), and columns.
type Short = (&'static str, &'static str, &'static [&'static str], &'static [usize]);

const SHORT: [Short; 12] = [
    (
        "orders_in_time",
        "finite__orders_in_time",
        &["newmark,rate", "newmark,neo", "newmark as printed,rate"],
        &[0, 1, 2, 4, 5, 6],
    ),
    (
        "spinning_bar",
        "finite__spinning_bar",
        &["otm,24", "mpm linear,24", "mpm bspline consistent,24"],
        &[0, 2, 3, 4, 5, 6],
    ),
    (
        "ripple",
        "ripple__energy",
        &["newmark,0.01,", "(first),0.01,", "(last),0.01,", "(0.8),0.01,"],
        &[0, 2, 4, 5, 7],
    ),
    (
        "crossing",
        "orders__study",
        &[
            "linear lumped,1",
            "ugimp lumped,1",
            "bspline lumped,1",
            "lme 0.8 lumped,1",
            "lme 0.8 consistent,1",
            "lme 1.8 lumped,1",
        ],
        &[0, 2, 3, 4, 5, 6],
    ),
    ("limits", "stability__limits", &[",2,0,"], &[0, 1, 4, 7, 12]),
    (
        "watch",
        "watch__cases",
        &[
            "1 per cell,1.199",
            "1 per cell,0.999",
            "(last),0.500",
            "(last),0.100",
            "consistent,0.322",
            "linear; lumped",
        ],
        &[0, 1, 2, 3, 5],
    ),
    (
        "trade",
        "trade__bar",
        &[
            "linear time.integrator=newmark grid.cells=40 grid.particles_per_cell=1 time.cfl=0.998",
            "lumped basis.kind=linear time.integrator=newmark grid.cells=40 grid.particles_per_cell=2",
            "gamma=6 time.integrator=newmark grid.cells=40 grid.particles_per_cell=1 time.cfl=0.95",
            "consistent basis.kind=lme basis.gamma=0.8",
        ],
        &[0, 1, 2, 3, 4, 5],
    ),
    ("verdicts", "verdicts__shipped", &["dyka,", "gravity,", "manufactured,"], &[0, 1, 2, 3, 4]),
    ("gamma", "gamma__study", &[",0.8,", ",1.8,", ",4,", ",50,"], &[0, 1, 2, 3, 4, 7, 11]),
    ("time_step", "data/instructions/time-step.csv", &[",3,"], &[0, 2, 3, 4, 5]),
    (
        "seeded",
        "port__seeded",
        &[
            "modulus E for",
            "step 8 as printed",
            "roller forgotten",
            "engineering shear",
            "∂N/∂y with 1/h_x",
            "nodes counted from 1",
            "printed with six",
            "cut off after",
        ],
        &[0, 1, 2, 3, 4, 5],
    ),
    ("vibrating_bar", "published__vibrating_bar", &[",20,", ",80,"], &[0, 1, 2, 3, 4, 5]),
];

/// A short table has rows and columns of the long one that stands in the fold below it.
#[test]
fn short_tables_are_parts_of_long_ones() {
    for (short, long, words, columns) in SHORT {
        let file = if long.contains('/') { long.into() } else { format!("snapshots/{long}.snap") };
        let text = read(&file);
        let body = text.splitn(3, "---\n").nth(2).unwrap_or(&text);
        let mut lines = csv::ReaderBuilder::new().has_headers(false).from_reader(body.as_bytes());
        let mut table = csv::Writer::from_writer(Vec::new());
        for (n, row) in lines.records().map(Result::unwrap).enumerate() {
            let line = row.iter().collect::<Vec<_>>().join(",");
            if n == 0 || words.iter().any(|word| line.contains(word)) {
                table.write_record(columns.iter().map(|&at| &row[at])).unwrap();
            }
        }
        let table = String::from_utf8(table.into_inner().unwrap()).unwrap();
        let rows = table.lines().count();
        assert!((words.len().max(4)..=14).contains(&rows), "{short}: {rows} rows");
        approve(&format!("short__{short}"), &table);
    }
}

/// Every anchor in the code is quoted by a chapter, and every quoted one exists.
#[test]
fn anchors_are_quoted() {
    let mut quoted = Vec::new();
    for (chapter, text) in chapters() {
        for rest in text.split("{{#code ").skip(1) {
            let place = rest.split("}}").next().unwrap().trim().to_string();
            let (file, anchor) = place.split_once(':').unwrap();
            let source = read(file);
            for marker in ["ANCHOR", "ANCHOR_END"] {
                let line = format!("// {marker}: {anchor}");
                let found = source.lines().filter(|text| text.trim() == line).count();
                assert_eq!(found, 1, "{chapter}: {marker} of {place}");
            }
            quoted.push(place);
        }
    }
    for (file, text) in files("src", ".rs") {
        for line in text.lines() {
            if let Some(anchor) = line.trim().strip_prefix("// ANCHOR: ") {
                let place = format!("{file}:{anchor}");
                assert!(quoted.contains(&place), "{place} is marked and quoted nowhere");
            }
        }
    }
    assert!(quoted.len() > 25, "{}", quoted.len());
}

/// Every identifier of the symbol table is a word of the code.
#[test]
fn symbols_are_in_the_code() {
    let code: String = files("src", ".rs").into_iter().map(|(_, text)| text).collect();
    let words: std::collections::BTreeSet<&str> =
        code.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    for row in records("data/symbols.csv") {
        assert_eq!(row.len(), 8, "{row:?}");
        assert!(row.iter().all(|cell| !cell.is_empty()), "{row:?}");
        assert!(words.contains(row[1].as_str()), "{} is not in the code", row[1]);
    }
}

/// Results are approved, not typed: no decimal number in the prose under "What
/// came out", outside of directives and formulas.
#[test]
fn results_are_not_typed() {
    let mut sections = 0;
    for (chapter, text) in chapters() {
        for section in text.split("\n## ").filter(|section| section.starts_with("What came out")) {
            sections += 1;
            let mut prose = String::new();
            for piece in section.split("{{#") {
                prose.push_str(piece.split_once("}}").map_or(piece, |(_, after)| after));
            }
            let prose: String = prose.split('$').step_by(2).collect();
            let letters: Vec<char> = prose.chars().collect();
            for at in letters.windows(3) {
                let decimal = at[0].is_ascii_digit() && at[1] == '.' && at[2].is_ascii_digit();
                assert!(!decimal, "{chapter}: a typed number in\n{prose}");
            }
        }
    }
    assert!(sections >= 5, "{sections}");
}

/// Every chapter is in the table of contents.
#[test]
fn chapters_are_in_the_summary() {
    let summary = read("book/src/SUMMARY.md");
    for (chapter, _) in chapters() {
        assert!(summary.contains(&format!("({chapter})")), "{chapter}");
    }
}

/// The mutants that survived are still in the code, each with its reason, and every
/// module's sum is right. `data/mutants/score.py` makes the counts.
#[test]
fn surviving_mutants_are_explained() {
    let mut survived: BTreeMap<String, usize> = BTreeMap::new();
    for row in records("data/mutants/survivors.csv") {
        let [file, code, mutant, reason] = row.try_into().unwrap();
        let found = read(&file).lines().any(|line| line.trim() == code);
        assert!(found, "{file} has no line `{code}`");
        assert!(mutant.starts_with("replace ") || mutant.starts_with("delete "), "{mutant}");
        assert!(reason.len() > 20, "{mutant}: {reason}");
        let inside = file.strip_prefix("src/method/").unwrap();
        let module = inside.split(['/', '.']).next().unwrap();
        *survived.entry(module.to_string()).or_default() += 1;
    }
    let scores = records("data/mutants/scores.csv");
    for row in &scores {
        let count = |at: usize| row[at].parse::<usize>().unwrap();
        assert_eq!(count(1), (2..=5).map(count).sum::<usize>(), "{row:?}");
        // A line may hold the same mutant more than once.
        let (rows, missed) = (survived.remove(&row[0]).unwrap_or(0), count(5));
        assert!(rows <= missed && (rows > 0) == (missed > 0), "{row:?}");
    }
    assert!(survived.is_empty() && scores.len() == 6, "{survived:?}");
}

/// A directory of its own with the scenes, those of the kit too, where commands may write.
fn directory(name: &str) -> PathBuf {
    let dir = program::directory(name);
    for folder in ["data/scenes", "data/conformance"] {
        fs::create_dir_all(dir.join(folder)).unwrap();
        for entry in fs::read_dir(root().join(folder)).unwrap().map(Result::unwrap) {
            if entry.path().extension().is_some_and(|ending| ending == "toml") {
                fs::copy(entry.path(), dir.join(folder).join(entry.file_name())).unwrap();
            }
        }
    }
    dir
}

/// Runs a shell line with the program in place of `cargo run --release`.
fn shell(dir: &Path, line: &str) -> String {
    let program = format!("'{}'", env!("CARGO_BIN_EXE_lme-mpm"));
    let line = line
        .replace("cargo run --release --quiet -- ", &format!("{program} "))
        .replace("cargo run --release -- ", &format!("{program} "))
        .replace("cargo run --release", &program);
    let output = Command::new("sh").args(["-c", &line]).current_dir(dir).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "`{line}`:\n{stderr}");
    String::from_utf8(output.stdout).unwrap()
}

/// The commands of a `console` block, each as it is printed, and what each prints; a line that ends
/// with `\` goes on in the next one.
fn commands(block: &str) -> Vec<(String, String)> {
    let one = |piece: &str| {
        let mut rest = piece;
        let mut line = String::new();
        loop {
            let (first, after) = rest.split_once('\n').unwrap_or((rest, ""));
            rest = after;
            line.push_str(first);
            if !first.ends_with('\\') {
                return (line, rest.to_string());
            }
            line.push('\n');
        }
    };
    format!("\n{block}")
        .split("\n$ ")
        .skip(1)
        .map(|piece| one(&format!("{}\n", piece.trim_end())))
        .collect()
}

/// Every `console` block of the book runs, and prints what is printed.
#[test]
fn commands_of_the_book_run() {
    let mut count = 0;
    for (chapter, text) in chapters() {
        let dir = directory(&format!("book-{}", chapter.trim_end_matches(".md")));
        for block in text.split("```console\n").skip(1) {
            let block = block.split("```").next().unwrap();
            for (line, expected) in commands(block) {
                let printed = shell(&dir, &line);
                if let Some((whole, _)) = line.rsplit_once("| cut -c")
                    && !line.contains("done")
                {
                    let whole = shell(&dir, whole);
                    assert!(!cuts_an_exponent(&whole, &printed), "{chapter}: `{line}`");
                }
                if !expected.is_empty() {
                    assert_eq!(printed, expected, "{chapter}: `{line}`");
                }
                count += 1;
            }
        }
    }
    assert!(count >= 15, "{count}");
}

/// The line of a command fits a page, a longer command goes on in the next one; and so do the
/// lines that it prints.
#[test]
fn commands_of_the_book_are_readable() {
    for (chapter, text) in chapters() {
        for block in text.split("```console\n").skip(1) {
            let block = block.split("```").next().unwrap();
            for line in block.lines() {
                let length = line.chars().count();
                assert!(length <= 95, "{chapter}: {length} characters in `{line}`");
            }
        }
    }
}

/// Says whether an output was cut inside the exponent of a number, or before it: what is shown
/// would be another number.
fn cuts_an_exponent(whole: &str, shown: &str) -> bool {
    whole.lines().zip(shown.lines()).any(|(whole, shown)| {
        let rest = whole.strip_prefix(shown).unwrap_or("");
        let number = rest.split(',').next().unwrap_or("");
        let inside = shown.ends_with(|c: char| c.is_ascii_digit() || ".e-".contains(c));
        inside && (number.contains('e') || shown.ends_with(['e', '-']) && !number.is_empty())
    })
}

/// Such a cut is seen, and others are let pass.
#[test]
fn commands_of_the_book_cut_no_exponent() {
    assert!(cuts_an_exponent("a,7.06281e-6,1", "a,7.0628"));
    assert!(cuts_an_exponent("a,7.06281e-6,1", "a,7.06281e-"));
    assert!(!cuts_an_exponent("a,7.06281e-6,1", "a,7.06281e-6"));
    assert!(!cuts_an_exponent("a,0.70628,1", "a,0.70"));
}

/// Name and caption of every figure and table of a chapter, and every table that is typed without
/// a caption above it.
fn captions(chapter: &str, text: &str) -> (Vec<(String, String)>, Vec<String>) {
    let (mut found, mut bare) = (Vec::new(), Vec::new());
    for rest in text.split("{{#").skip(1) {
        let directive = rest.split("}}").next().unwrap();
        let (word, argument) = directive.split_once(' ').unwrap_or((directive, ""));
        if ["figure", "table", "caption"].contains(&word) {
            let (name, caption) = argument.split_once(" | ").unwrap_or((argument, ""));
            found.push((name.trim().to_string(), caption.trim().to_string()));
        }
    }
    let text = text.split("```").step_by(2).collect::<String>();
    let lines: Vec<&str> = text.lines().collect();
    for (n, line) in lines.iter().enumerate().filter(|(_, line)| line.starts_with("|-")) {
        let above = n.checked_sub(3).map_or("", |n| lines[n]);
        if !above.ends_with("}}") {
            bare.push(format!("{chapter}: {}", lines[n.saturating_sub(1)].trim_end_matches(line)));
        }
    }
    (found, bare)
}

/// Every figure and table has a caption, and what is referred to is there. The numbers are given
/// by the build.
#[test]
fn figures_and_tables_have_captions() {
    let (mut names, mut without) = (Vec::new(), Vec::new());
    for (chapter, text) in chapters() {
        let (found, bare) = captions(&chapter, &text);
        without.extend(bare);
        for (name, caption) in found {
            if caption.len() < 10 {
                without.push(format!("{chapter}: {name}"));
            }
            let stands_twice = names.contains(&name) && !name.contains('/');
            assert!(!stands_twice, "{chapter}: {name} is another table's name");
            names.push(name);
        }
    }
    assert!(without.is_empty(), "without a caption:\n{}", without.join("\n"));
    assert!(names.len() > 80, "{}", names.len());
    for (chapter, text) in chapters() {
        for rest in text.split("{{#see ").skip(1) {
            let name = rest.split("}}").next().unwrap().trim();
            assert!(names.iter().any(|known| known == name), "{chapter}: no caption of {name}");
        }
    }
}

/// True where a caption of a figure says what is drawn, in a sentence, and then what to take away.
fn says_what_to_take_away(caption: &str) -> bool {
    let Some((drawn, taken)) = caption.split_once("What to take away: ") else { return false };
    drawn.trim_end().ends_with(['.', ')']) && taken.len() > 20 && taken.ends_with(['.', ')'])
}

/// The caption of every figure says what is drawn, and ends in what the reader should take away.
#[test]
fn figures_say_what_to_take_away() {
    let (mut count, mut without) = (0, Vec::new());
    for (chapter, text) in chapters() {
        for rest in text.split("{{#figure ").skip(1) {
            let (name, caption) = rest.split("}}\n").next().unwrap().split_once(" | ").unwrap();
            count += 1;
            if !says_what_to_take_away(caption.trim()) {
                without.push(format!("{chapter}: {name}: {caption}"));
            }
        }
    }
    assert!(without.is_empty(), "nothing to take away:\n{}", without.join("\n"));
    assert!(count > 30, "{count}");
    assert!(!says_what_to_take_away("The error against the number of cells. It falls."));
    assert!(!says_what_to_take_away("The error against the number of cells. What to take away: "));
}

/// A table without a caption is seen, and one with a caption, or in code, is not taken for one.
#[test]
fn figures_and_tables_without_captions_are_seen() {
    let bare = |text: &str| captions("x.md", text).1.len();
    assert_eq!(bare("Text.\n\n| a |\n|---|\n| 1 |\n"), 1);
    assert_eq!(bare("{{#caption x | What it shows.}}\n\n| a |\n|---|\n| 1 |\n"), 0);
    assert_eq!(bare("```text\n\n| a |\n|---|\n```\n"), 0);
}

/// mdBook's own includes build without a word where file or anchor are missing, so no chapter
/// may have one, and `cargo book` does not load what would fill them in.
#[test]
fn chapters_know_their_directives() {
    let known = [
        "code", "side", "beside", "end", "pin", "file", "table", "caption", "value", "figure",
        "see",
    ];
    for (chapter, text) in chapters() {
        for rest in text.split("{{#").skip(1) {
            let word = rest.split([' ', '}']).next().unwrap();
            let of_an_index = ["equations", "symbols"].contains(&word);
            assert!(known.contains(&word) || of_an_index, "{chapter}: {{{{#{word} is not known");
        }
    }
    assert!(read("book/book.toml").contains("\nuse-default-preprocessors = false\n"));
}

/// Every `cargo run` line of the README runs.
#[test]
fn commands_of_the_readme_run() {
    let readme = read("README.md");
    let dir = directory("readme");
    let blocks = readme.split("```sh\n").skip(1).map(|block| block.split("```").next().unwrap());
    let lines: Vec<&str> =
        blocks.flat_map(str::lines).filter(|line| line.contains("cargo run")).collect();
    assert!(lines.len() >= 5, "{lines:?}");
    for line in lines {
        shell(&dir, line);
    }
}
