//! The teaching layer of the chapters of the method: what each needs and gives, exercises with a
//! grade and a folded answer, and what could be built on it.

use std::fs;
use std::path::Path;

/// The front chapters, and those of the method.
const CHAPTERS: [&str; 13] = [
    "one-particle",
    "one-bar",
    "dyka-bar",
    "governing-equations",
    "weak-form",
    "algorithm",
    "linear",
    "basis",
    "local-max-ent",
    "time-integration",
    "consistent-mass",
    "dispersion",
    "otm",
];

const GRADES: [&str; 3] = [" ● (", " ●● (", " ●●● ("];

/// What is wrong with a chapter's teaching layer, and how many exercises it has of each grade.
fn layer(text: &str) -> (Vec<String>, [usize; 3]) {
    let mut wrong = Vec::new();
    let top = text.split("\n## ").next().unwrap();
    for line in ["\n**What it needs.** ", "\n**What it gives.** "] {
        if !top.contains(line) {
            wrong.push(format!("no `{}`", line.trim()));
        }
    }
    if !text.contains("\n### Possibilities for extensions\n") {
        wrong.push("no possibilities for extensions".into());
    }
    let exercises = text.split_once("\n## Exercises\n").map_or("", |(_, exercises)| exercises);
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
    if !(4..=6).contains(&count.iter().sum::<usize>()) {
        wrong.push(format!("{count:?} exercises"));
    }
    (wrong, count)
}

/// Each chapter has its two lines, four to six exercises of more than one grade, and its
/// possibilities.
#[test]
fn teaching_layer_is_complete() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("book/src");
    let mut all = 0;
    for chapter in CHAPTERS {
        let text = fs::read_to_string(folder.join(format!("{chapter}.md"))).unwrap();
        let (wrong, count) = layer(&text);
        assert!(wrong.is_empty(), "{chapter}: {}", wrong.join("; "));
        assert!(count[0] > 0 && count[2] > 0, "{chapter}: {count:?}");
        all += count.iter().sum::<usize>();
    }
    assert!(all >= 70, "{all}");
}

/// What is missing is told.
#[test]
fn teaching_layer_that_lacks_something_is_told() {
    let task = |n: usize, grade: &str| {
        format!(
            "**{n} {grade} (run).** Do it.\n\n<details>\n<summary>Answer</summary>\n\n**Answer.** \
             Done.\n\n</details>\n\n"
        )
    };
    let tasks: String = (1..=4).map(|n| task(n, "●●")).collect();
    let top = "# A\n\n**What it needs.** B.\n\n**What it gives.** C.\n\n## Exercises\n\n";
    let end = "### Possibilities for extensions\n\nMany.\n";
    let whole = format!("{top}{tasks}{end}");
    assert_eq!(layer(&whole), (Vec::new(), [0, 4, 0]));
    for (part, told) in [
        ("**What it needs.** ", "no `**What it needs.**`"),
        ("**4 ●●", "exercise 4 begins"),
        ("### Possibilities for extensions", "no possibilities"),
        ("<summary>Answer</summary>", "exercise 1 is not folded"),
    ] {
        let (wrong, _) = layer(&whole.replacen(part, "x", 1));
        assert!(wrong.iter().any(|wrong| wrong.contains(told)), "{part}: {wrong:?}");
    }
}
