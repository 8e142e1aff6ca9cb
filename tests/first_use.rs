//! The order of the book: every term, symbol and scene is introduced before it is used.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The chapters in the order of the table of contents, each with its name and text.
type Book = Vec<(String, String)>;

/// A thing that the book introduces.
struct Entry {
    /// What stands in the text: the forms of a term, the name of a scene, a symbol's LaTeX.
    forms: Vec<String>,
    chapter: String,
    /// The word that stands beside a symbol where it is introduced.
    word: String,
}

fn entry(forms: &[&str], chapter: &str, word: &str) -> Entry {
    let forms = forms.iter().map(|form| form.to_string()).collect();
    Entry { forms, chapter: chapter.into(), word: word.into() }
}

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The targets of the links of the table of contents.
fn book() -> Book {
    let summary = read("book/src/SUMMARY.md");
    let names = summary.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
    names.map(|name| (name.to_string(), read(&format!("book/src/{name}")))).collect()
}

/// The text from each `open` to the next `close` taken out, both included.
fn without(text: &str, open: &str, close: &str) -> String {
    let mut pieces = text.split(open);
    let mut kept = pieces.next().unwrap().to_string();
    for piece in pieces {
        kept.push(' ');
        kept.push_str(piece.split_once(close).map_or("", |(_, after)| after));
    }
    kept
}

/// The paragraphs of a chapter as they are read from the top. Left out are code, directives,
/// headings, links to other chapters (a signpost is no use of what it points to), what a
/// chapter promises on its top, and what it leaves to others at its end.
fn paragraphs(text: &str) -> Vec<String> {
    let text = text.split("```").step_by(2).collect::<Vec<_>>().join(" ");
    let text = without(&text, "{{#", "}}");
    let mut kept = Vec::new();
    let mut extensions = false;
    for paragraph in text.split("\n\n") {
        let paragraph = paragraph.trim();
        if paragraph.starts_with('#') {
            extensions = paragraph.contains("Possibilities for extensions");
        }
        let promise = ["**What it gives.**", "# "].iter().any(|start| paragraph.starts_with(start));
        if !extensions && !promise {
            let lines = paragraph.lines().filter(|line| !line.starts_with('#'));
            kept.push(signposts_taken_out(&lines.collect::<Vec<_>>().join(" ")));
        }
    }
    kept
}

/// `[words](chapter.md#place)` taken out, and words in code letters.
fn signposts_taken_out(text: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('[') {
        kept.push_str(before);
        match after.split_once("](") {
            Some((words, link)) if !words.contains('[') => {
                rest = link.split_once(')').map_or("", |(_, after)| after);
            }
            _ => rest = after,
        }
    }
    kept.push_str(rest);
    kept.split('`').step_by(2).collect::<Vec<_>>().join(" ")
}

/// Words without formulas, in small letters.
fn words(paragraph: &str) -> String {
    paragraph.replace("$$", "$").split('$').step_by(2).collect::<Vec<_>>().join(" ").to_lowercase()
}

/// True where a form of the term stands as a word of its own, or in the plural.
fn names(text: &str, forms: &[String]) -> bool {
    forms.iter().any(|form| {
        let form = form.to_lowercase();
        text.match_indices(&form).any(|(at, _)| {
            let letter = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '-');
            let after = &text[at + form.len()..];
            let after = ["es", "s"].iter().find_map(|end| after.strip_prefix(end)).unwrap_or(after);
            !letter(text[..at].chars().next_back()) && !letter(after.chars().next())
        })
    })
}

/// What is emphasised in a paragraph begins with a form of the term.
fn emphasises(text: &str, forms: &[String]) -> bool {
    forms.iter().any(|form| text.contains(&format!("*{}", form.to_lowercase())))
}

/// The symbols of a formula one by one, `\mathbf x` and its like as one.
fn tokens(latex: &str) -> Vec<String> {
    let latex = without(&without(latex, "\\text{", "}"), "\\tag{", "}");
    let latex = latex.replace("\\mathrm{", "\\"); // a word of its own: `\tol`
    let mut found: Vec<String> = Vec::new();
    let mut letters = latex.chars().filter(|c| *c != ' ' && *c != '{' && *c != '}').peekable();
    while let Some(letter) = letters.next() {
        let mut token = letter.to_string();
        if letter == '\\' {
            while let Some(next) = letters.next_if(|c| c.is_ascii_alphabetic()) {
                token.push(next);
                // A font takes one letter.
                if let Some(font) = ["\\mathbf", "\\mathsf", "\\mathfrak", "\\mathcal"]
                    .iter()
                    .find(|font| token == **font)
                {
                    token = format!("{font} {}", letters.next().unwrap_or(' '));
                    break;
                }
            }
        }
        found.push(token);
    }
    found
}

/// True where the formulas of a paragraph have the symbol.
fn has_symbol(paragraph: &str, symbol: &[String]) -> bool {
    let paragraph = paragraph.replace("$$", "$");
    paragraph.split('$').skip(1).step_by(2).any(|formula| {
        let formula = tokens(formula);
        formula.windows(symbol.len()).any(|window| window == symbol)
    })
}

/// What is wrong with the terms: used before the chapter that introduces them, or there
/// before the paragraph that emphasises them.
fn of_terms(book: &Book, terms: &[Entry]) -> Vec<String> {
    let mut wrong = Vec::new();
    for term in terms {
        let name = &term.forms[0];
        let Some(place) = book.iter().position(|(chapter, _)| *chapter == term.chapter) else {
            wrong.push(format!("`{name}` is introduced in {}, which is no chapter", term.chapter));
            continue;
        };
        for (chapter, text) in &book[..place] {
            if paragraphs(text).iter().any(|text| names(&words(text), &term.forms)) {
                let home = &term.chapter;
                wrong.push(format!("{chapter} uses `{name}`, which {home} introduces later"));
            }
        }
        let texts: Vec<String> =
            paragraphs(&book[place].1).iter().map(|text| words(text)).collect();
        match texts.iter().find(|text| names(text, &term.forms)) {
            None => wrong.push(format!("{} does not name `{name}`", term.chapter)),
            Some(first) if !emphasises(first, &term.forms) => {
                wrong.push(format!("{} uses `{name}` before it explains it", term.chapter));
            }
            Some(_) => {}
        }
    }
    wrong
}

/// What is wrong with the symbols: used before the chapter that introduces them first, or
/// introduced without the word for them in the same paragraph or the ones beside it.
fn of_symbols(book: &Book, symbols: &[Entry]) -> Vec<String> {
    let mut wrong = Vec::new();
    let place = |name: &str| book.iter().position(|(chapter, _)| chapter == name);
    let mut first: BTreeMap<&String, usize> = BTreeMap::new();
    for symbol in symbols {
        for form in &symbol.forms {
            let at = place(&symbol.chapter).unwrap_or_else(|| panic!("{form}: {}", symbol.chapter));
            first.entry(form).and_modify(|first| *first = at.min(*first)).or_insert(at);
            let texts = paragraphs(&book[at].1);
            let wanted = tokens(form);
            let told = |n: usize| {
                let near = &texts[n.saturating_sub(1)..texts.len().min(n + 2)];
                near.iter().any(|text| words(text).contains(&symbol.word.to_lowercase()))
            };
            if !(0..texts.len()).any(|n| has_symbol(&texts[n], &wanted) && told(n)) {
                wrong.push(format!("{} has no `{form}` beside `{}`", symbol.chapter, symbol.word));
            }
        }
    }
    for (form, at) in first {
        let wanted = tokens(form);
        for (chapter, text) in &book[..at] {
            if paragraphs(text).iter().any(|text| has_symbol(text, &wanted)) {
                let home = &book[at].0;
                wrong.push(format!(
                    "{chapter} uses the symbol `{form}`, which {home} introduces later"
                ));
            }
        }
    }
    wrong
}

/// True where a chapter names the file of a scene, or a command has its name.
fn names_scene(text: &str, scene: &str) -> bool {
    let commands = ["run", "trace", "exact", "show", "--scene", "recommend", "trade"];
    text.contains(&format!("{scene}.toml"))
        || commands.iter().any(|command| {
            let command = format!("{command} {scene}");
            text.match_indices(&command).any(|(at, _)| {
                let after = text[at + command.len()..].chars().next();
                !after.is_some_and(|c| c.is_alphanumeric() || c == '-')
            })
        })
}

/// What is wrong with the scenes: named before the chapter that introduces them.
fn of_scenes(book: &Book, scenes: &[Entry]) -> Vec<String> {
    let mut wrong = Vec::new();
    for scene in scenes {
        let (name, home) = (&scene.forms[0], &scene.chapter);
        let first =
            book.iter().find(|(_, text)| names_scene(text, name)).map(|(chapter, _)| chapter);
        if first != Some(home) {
            let first = first.map_or("no chapter", String::as_str);
            wrong.push(format!("{first} is the first to name the scene `{name}`, not {home}"));
        }
    }
    wrong
}

/// The rows of a table of the glossary, below a heading: first cell, and the chapter that the
/// second one links to.
fn rows(text: &str, heading: &str) -> Vec<Entry> {
    let section = text.split("\n## ").find(|section| section.starts_with(heading)).unwrap();
    let cells =
        |line: &str| line.split('|').map(|cell| cell.trim().to_string()).collect::<Vec<_>>();
    let lines = section.lines().filter(|line| line.starts_with("| ") && line.contains(".md)"));
    lines
        .map(|line| {
            let cells = cells(line);
            let forms: Vec<String> =
                cells[1].split(", ").map(|form| form.replace(['*', '`'], "")).collect();
            let chapter = cells[2].split_once("](").unwrap().1.split([')', '#']).next().unwrap();
            assert!(cells[3].ends_with('.') && cells[3].len() > 12, "{line}");
            Entry { forms, chapter: chapter.to_string(), word: String::new() }
        })
        .collect()
}

/// The terms of the glossary stand in no chapter before the one that explains them.
#[test]
fn first_use_of_terms() {
    let terms = rows(&read("book/src/glossary.md"), "Terms");
    assert!(terms.len() > 60, "{}", terms.len());
    let wrong = of_terms(&book(), &terms);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The symbols of the notation stand in no formula before the chapter that says what they are,
/// and there beside the word for them.
#[test]
fn first_use_of_symbols() {
    let text = read("data/symbols.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let symbols: Vec<Entry> = reader
        .records()
        .map(|row| {
            let row = row.unwrap();
            let forms: Vec<&str> = row[0].split(",\\ ").collect();
            entry(&forms, &format!("{}.md", &row[6]), &row[7])
        })
        .collect();
    assert!(symbols.len() > 60, "{}", symbols.len());
    let wrong = of_symbols(&book(), &symbols);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every scene that a chapter names is in the glossary, and named in no chapter before its own.
#[test]
fn first_use_of_scenes() {
    let scenes = rows(&read("book/src/glossary.md"), "Scenes");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let book = book();
    for file in fs::read_dir(folder).unwrap() {
        let name = file.unwrap().file_name().to_string_lossy().replace(".toml", "");
        let named = book.iter().any(|(_, text)| names_scene(text, &name));
        let listed = scenes.iter().any(|scene| scene.forms[0] == name);
        assert!(listed || !named, "no scene `{name}` in the glossary");
    }
    let wrong = of_scenes(&book, &scenes);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A made-up book with one fault of each kind: each is found, and named with its chapter.
#[test]
fn first_use_finds_what_comes_too_early() {
    let book: Book = [
        (
            "one.md",
            "# One\n\nA *node* has the mass $m$. See [the filter](two.md).\n\n```\nfilter\n```",
        ),
        ("two.md", "# Two\n\nThe filter acts.\n\nA *filter* has the factor $s$. `run pond`"),
        ("three.md", "# Three\n\n*Waves* of the length $\\lambda$ in `lake.toml` and `pond.toml`."),
    ]
    .map(|(name, text)| (name.to_string(), text.to_string()))
    .into();
    let right = [entry(&["node"], "one.md", ""), entry(&["wave"], "three.md", "")];
    assert!(of_terms(&book, &right).is_empty());
    let early = of_terms(&book, &[entry(&["filter"], "three.md", "")]);
    let told = "two.md uses `filter`, which three.md introduces later";
    assert_eq!(early, [told.to_string(), "three.md does not name `filter`".to_string()]);
    let unexplained = of_terms(&book, &[entry(&["filter"], "two.md", "")]);
    assert_eq!(unexplained, ["two.md uses `filter` before it explains it".to_string()]);

    let mass = entry(&["m"], "one.md", "mass");
    assert!(of_symbols(&book, &[mass, entry(&["\\lambda"], "three.md", "length")]).is_empty());
    let early = of_symbols(&book, &[entry(&["s"], "three.md", "factor")]);
    assert_eq!(early.len(), 2, "{early:?}");
    assert!(early[1].starts_with("two.md uses the symbol `s`"), "{early:?}");
    let unnamed = of_symbols(&book, &[entry(&["m"], "one.md", "speed")]);
    assert_eq!(unnamed, ["one.md has no `m` beside `speed`".to_string()]);

    assert!(of_scenes(&book, &[entry(&["lake"], "three.md", "")]).is_empty());
    let early = of_scenes(&book, &[entry(&["pond"], "three.md", "")]);
    assert_eq!(early, ["two.md is the first to name the scene `pond`, not three.md".to_string()]);
}

/// A formula falls into its symbols.
#[test]
fn first_use_knows_symbols_in_formulas() {
    assert_eq!(tokens("\\mathbf x_p^{k+1}"), ["\\mathbf x", "_", "p", "^", "k", "+", "1"]);
    assert!(has_symbol("so $\\Delta t\\,h$", &tokens("\\Delta t")));
    assert!(!has_symbol("so $\\theta$ and $\\text{mass}$", &tokens("h")));
}
