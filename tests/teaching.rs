//! The teaching layer of the book: what each chapter needs and gives, exercises with a
//! grade and a folded answer, and what could be built on it.

use std::fs;
use std::path::{Path, PathBuf};

/// These pages are for looking things up, and set no task.
const TO_LOOK_UP: [&str; 5] = ["equations", "glossary", "cards", "bibliography", "teaching"];

/// These chapters are about the program and the book. Three exercises do, and nothing is built on
/// them.
const OF_THE_PROGRAM: [&str; 10] = [
    "lab",
    "same-bits",
    "notation",
    "scene-reference",
    "porting",
    "grid",
    "readings",
    "testing",
    "map",
    "changing",
];

const GRADES: [&str; 3] = [" ● (", " ●● (", " ●●● ("];

/// What is wrong with a chapter's teaching layer, and how many exercises it has of each grade.
fn layer(text: &str, of_the_program: bool) -> (Vec<String>, [usize; 3]) {
    let mut wrong = Vec::new();
    let top = text.split("\n## ").next().unwrap();
    for line in ["\n**What it needs.** ", "\n**What it gives.** "] {
        if !top.contains(line) {
            wrong.push(format!("no `{}`", line.trim()));
        }
    }
    if !of_the_program && !text.contains("\n### Possibilities for extensions\n") {
        wrong.push("no possibilities for extensions".into());
    }
    let exercises = text.split_once("\n## Exercises\n").map_or("", |(_, exercises)| exercises);
    if exercises.contains("\n## ") {
        wrong.push("something after the exercises".into());
    }
    if !exercises.contains("```console\n$ ") {
        wrong.push("no exercise is answered by a command".into());
    }
    let exercises = exercises.split("\n### ").next().unwrap();
    let mut count = [0; 3];
    for (n, task) in (1..).zip(exercises.split("</details>")) {
        if task.trim().is_empty() {
            break;
        }
        let head = task.trim().split(").**").next().unwrap();
        match GRADES.iter().position(|grade| head.starts_with(&format!("**{n}{grade}"))) {
            Some(grade) => count[grade] += 1,
            None => wrong.push(format!("exercise {n} begins with `{head}`")),
        }
        if !task.contains("\n<details>\n<summary>Answer</summary>\n\n**Answer.** ") {
            wrong.push(format!("the answer of exercise {n} is not folded"));
        }
    }
    let least = if of_the_program { 3 } else { 4 };
    let hard = of_the_program || count[2] > 0;
    if !(least..=6).contains(&count.iter().sum::<usize>()) || count[0] == 0 || !hard {
        wrong.push(format!("{count:?} exercises"));
    }
    (wrong, count)
}

/// The names of all chapters, in the order of the table of contents.
fn chapters() -> Vec<String> {
    let summary = fs::read_to_string(source("SUMMARY")).unwrap();
    let links = summary.split("](").skip(1).map(|rest| rest.split(".md)").next().unwrap());
    links.map(str::to_string).collect()
}

/// Where a chapter's text stands.
fn source(chapter: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("book/src/{chapter}.md"))
}

/// Each chapter has its two lines and graded exercises with folded answers, and needs no later
/// one but to look things up; the first page, which everybody begins with, needs none.
#[test]
fn teaching_layer_is_complete() {
    let chapters = chapters();
    let (mut all, mut wrong) = ([0; 3], Vec::new());
    for (n, chapter) in chapters.iter().enumerate().skip(1) {
        if TO_LOOK_UP.contains(&chapter.as_str()) {
            continue;
        }
        let text = fs::read_to_string(source(chapter)).unwrap();
        let (lacks, count) = layer(&text, OF_THE_PROGRAM.contains(&chapter.as_str()));
        wrong.extend(lacks.iter().map(|lack| format!("{chapter}: {lack}")));
        let needs = text.split_once("\n**What it needs.** ").map_or("", |(_, needs)| needs);
        let needs = needs.split("\n\n").next().unwrap();
        for link in needs.split("](").skip(1).map(|rest| rest.split(".md").next().unwrap()) {
            let place = chapters.iter().position(|other| other == link);
            if place.is_none_or(|place| place >= n) && !["grid", "equations"].contains(&link) {
                wrong.push(format!("{chapter} needs {link}, a later one"));
            }
        }
        (0..3).for_each(|grade| all[grade] += count[grade]);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(all.iter().sum::<usize>() >= 170, "{all:?}");
}

/// What is missing is told.
#[test]
fn teaching_layer_that_lacks_something_is_told() {
    let task = |n: usize, grade: &str| {
        format!(
            "**{n} {grade} (run).** Do it.\n\n<details>\n<summary>Answer</summary>\n\n**Answer.** \
             Done.\n\n```console\n$ true\n```\n\n</details>\n\n"
        )
    };
    let tasks: String =
        (1..).zip(["●", "●●", "●●", "●●●"]).map(|(n, grade)| task(n, grade)).collect();
    let top = "# A\n\n**What it needs.** B.\n\n**What it gives.** C.\n\n## Exercises\n\n";
    let end = "### Possibilities for extensions\n\nMany.\n";
    let whole = format!("{top}{tasks}{end}");
    assert_eq!(layer(&whole, false), (Vec::new(), [1, 2, 1]));
    for (part, told) in [
        ("**What it needs.** ", "no `**What it needs.**`"),
        ("**4 ●●●", "exercise 4 begins"),
        ("### Possibilities for extensions", "no possibilities"),
        ("<summary>Answer</summary>", "exercise 1 is not folded"),
    ] {
        let (wrong, _) = layer(&whole.replacen(part, "x", 1), false);
        assert!(wrong.iter().any(|wrong| wrong.contains(told)), "{part}: {wrong:?}");
    }
}
