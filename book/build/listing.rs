//! Code in the book: real lines of the repository, coloured, every identifier
//! that the project defines linked to its definition.

use anyhow::{Context, Result, bail};
use ra_ap_rustc_lexer::{FrontmatterAllowed, LiteralKind, TokenKind, tokenize};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Where an identifier is defined.
#[derive(Clone, Debug)]
struct Definition {
    file: String,
    line: usize,
    /// The first line of its docstring.
    says: String,
    /// It is called behind a point.
    is_method: bool,
}

/// All definitions of the library and its tests by name.
pub struct Definitions {
    by_name: BTreeMap<String, Vec<Definition>>,
    /// Every Rust file, with its text, by path from the top.
    pub files: BTreeMap<String, String>,
}

const KEYWORDS: &[&str] = &[
    "as", "break", "const", "continue", "crate", "else", "enum", "false", "fn", "for", "if",
    "impl", "in", "let", "loop", "match", "mod", "move", "mut", "pub", "ref", "return", "self",
    "Self", "static", "struct", "super", "trait", "true", "type", "use", "where", "while",
];

/// Keywords that a definition's name follows.
const DEFINES: &[&str] = &["fn", "struct", "enum", "const", "type", "trait"];

impl Definitions {
    /// Reads `src/` and `tests/`.
    pub fn collect() -> Result<Self> {
        let mut files = BTreeMap::new();
        for folder in ["src", "tests"] {
            rust_files(&crate::root().join(folder), folder, &mut files)?;
        }
        let mut by_name: BTreeMap<String, Vec<Definition>> = BTreeMap::new();
        for (file, text) in &files {
            let lines: Vec<&str> = text.lines().collect();
            let mut previous = "";
            for (token, kind, line) in tokens(text) {
                if kind == TokenKind::Ident && DEFINES.contains(&previous) {
                    let says = docstring(&lines, line);
                    let is_method = takes_self(&lines[line - 1..]);
                    let definition = Definition { file: file.clone(), line, says, is_method };
                    by_name.entry(token.to_string()).or_default().push(definition);
                }
                if !matches!(kind, TokenKind::Whitespace) {
                    previous = token;
                }
            }
        }
        Ok(Definitions { by_name, files })
    }

    /// The one definition that `name` in `file` can mean, behind a point or not: the only one
    /// in that file, else in its folder, else in the library.
    fn find(&self, name: &str, file: &str, behind_point: bool) -> Option<&Definition> {
        let all = self.by_name.get(name)?.iter();
        let all: Vec<_> = all.filter(|found| found.is_method || !behind_point).collect();
        let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
        for near in [file, folder, "src/"] {
            match all.iter().filter(|found| found.file.starts_with(near)).collect::<Vec<_>>()[..] {
                [] => continue,
                [one] => return Some(one),
                _ => return None,
            }
        }
        None
    }

    /// The line on which test or item `name` is defined in `file`.
    pub fn line_of(&self, file: &str, name: &str) -> Option<usize> {
        self.by_name.get(name)?.iter().find(|found| found.file == file).map(|found| found.line)
    }

    /// The lines between `// ANCHOR: name` and its end, and the first one's number.
    pub fn anchored(&self, file: &str, anchor: &str) -> Result<(String, usize)> {
        let text = self.files.get(file).with_context(|| format!("there is no file {file}"))?;
        let marker = |line: &str, word: &str| {
            line.trim().strip_prefix(word).is_some_and(|name| name.trim() == anchor)
        };
        let lines: Vec<&str> = text.lines().collect();
        let begin = lines.iter().position(|line| marker(line, "// ANCHOR:"));
        let end = lines.iter().position(|line| marker(line, "// ANCHOR_END:"));
        let (Some(begin), Some(end)) = (begin, end) else {
            bail!("{file} has no anchor {anchor}");
        };
        let body: Vec<&str> = lines[begin + 1..end]
            .iter()
            .filter(|line| !line.trim().starts_with("// ANCHOR"))
            .copied()
            .collect();
        let indents = body.iter().filter(|line| !line.trim().is_empty());
        let Some(indent) = indents.map(|line| line.len() - line.trim_start().len()).min() else {
            bail!("anchor {anchor} of {file} is empty");
        };
        let body: Vec<&str> = body.iter().map(|line| line.get(indent..).unwrap_or("")).collect();
        Ok((body.join("\n"), begin + 2))
    }

    /// Rust code as HTML, with links that start at `to_root`.
    pub fn html(&self, code: &str, file: &str, to_root: &str) -> String {
        let mut out = String::new();
        let all: Vec<_> = tokens(code).collect();
        for (n, &(token, kind, _)) in all.iter().enumerate() {
            let before = if n > 0 { all[n - 1].0 } else { "" };
            let after = all.get(n + 1).map_or("", |next| next.0);
            let escaped = escape(token);
            let class = match kind {
                TokenKind::LineComment { doc_style: Some(_) } => "doc",
                TokenKind::LineComment { .. } | TokenKind::BlockComment { .. } => "comment",
                TokenKind::Ident if KEYWORDS.contains(&token) => "keyword",
                TokenKind::Literal { kind: LiteralKind::Str { .. }, .. } => "string",
                TokenKind::Literal { .. } => "number",
                TokenKind::Lifetime { .. } => "keyword",
                TokenKind::Ident => match self.find(token, file, before == ".") {
                    Some(found) if names_definition(token, before, after) => {
                        let title = format!("{}:{} {}", found.file, found.line, found.says);
                        let page = page_of(&found.file);
                        write!(
                            out,
                            "<a href=\"{to_root}{page}#L{}\" title=\"{}\">{escaped}</a>",
                            found.line,
                            escape(&title)
                        )
                        .ok();
                        continue;
                    }
                    _ => "",
                },
                _ => "",
            };
            match class {
                "" => out.push_str(&escaped),
                // A span for each line keeps the lines apart on source pages.
                _ => {
                    let parts: Vec<String> = escaped
                        .split('\n')
                        .map(|part| format!("<span class=\"{class}\">{part}</span>"))
                        .collect();
                    out.push_str(&parts.join("\n"));
                }
            }
        }
        out
    }

    /// A listing for a chapter: the anchored lines under a link to their place. Where they
    /// stand in a pair, the lines that would run out of sight unfold.
    pub fn listing(&self, file: &str, anchor: &str, to_root: &str, folds: bool) -> Result<String> {
        let (code, line) = self.anchored(file, anchor)?;
        let html = self.html(&code, file, to_root);
        let lines: Vec<&str> = html.split('\n').collect();
        let (shown, hidden) = if folds { shown_lines(&code) } else { (lines.len(), 0) };
        let (head, rest) = (lines[..shown].join("\n"), lines[shown..].join("\n"));
        let more = match hidden {
            0 => String::new(),
            _ => format!(
                "\n\n<details class=\"rest\"><summary>Show the whole: {hidden} more lines</summary>\n\n\
                 <pre class=\"listing\">\n{rest}\n</pre>\n\n</details>\n"
            ),
        };
        let place = format!("{to_root}{}#L{line}", page_of(file));
        Ok(format!(
            "<pre class=\"listing\" id=\"code-{anchor}\"><a class=\"place\" href=\"{place}\">\
             {file}:{line}</a>\n{head}\n</pre>{more}"
        ))
    }

    /// A whole file with numbered lines that can be linked.
    pub fn page(&self, file: &str, to_root: &str) -> String {
        let html = self.html(&self.files[file], file, to_root);
        let mut out = format!("# {file}\n\n<pre class=\"listing source\">");
        for (n, line) in html.trim_end().split('\n').enumerate() {
            let n = n + 1;
            writeln!(out, "<a class=\"line\" id=\"L{n}\" href=\"#L{n}\">{n:>4}</a>  {line}").ok();
        }
        out.push_str("</pre>\n");
        out
    }
}

/// True where `token` is a type, a constant, or a function that is called or
/// defined; a variable or a field may have a function's name by chance, and so
/// may a method of the standard library.
fn names_definition(token: &str, before: &str, after: &str) -> bool {
    const STANDARD: &[&str] = &[
        "clear", "column", "contains", "count", "filter", "last", "len", "parse", "position",
        "push", "rows", "sort", "sum", "values",
    ];
    let type_or_constant = token.len() > 1 && token.starts_with(char::is_uppercase);
    let called = after == "(" || after == "<";
    let foreign = before == "." && STANDARD.contains(&token);
    type_or_constant || (called && !foreign)
}

/// True where the function that begins in the first line has a receiver.
fn takes_self(lines: &[&str]) -> bool {
    let inside = lines[0].split_once('(').map_or("", |(_, inside)| inside);
    let first = if inside.is_empty() { lines.get(1).unwrap_or(&"") } else { &inside };
    ["self", "&self", "mut self", "&mut self"].iter().any(|own| first.trim().starts_with(own))
}

/// How many lines of a listing are shown at once, and how many unfold: a long one is cut where a
/// paragraph or an item of it ends.
pub fn shown_lines(code: &str) -> (usize, usize) {
    const MOST: usize = 25;
    let lines: Vec<&str> = code.lines().collect();
    if lines.len() <= MOST + 3 {
        return (lines.len(), 0);
    }
    let ends = |&n: &usize| lines[n].is_empty() || lines[n - 1].starts_with('}');
    let shown = (MOST / 2..=MOST).rev().find(ends).unwrap_or(MOST);
    (shown, lines.len() - shown)
}

/// `src/time/steps.rs` → `source/src/time/steps.html`.
pub fn page_of(file: &str) -> String {
    format!("source/{}.html", file.trim_end_matches(".rs"))
}

fn tokens(text: &str) -> impl Iterator<Item = (&str, TokenKind, usize)> {
    let (mut at, mut line) = (0, 1);
    tokenize(text, FrontmatterAllowed::No).map(move |token| {
        let piece = &text[at..at + token.len as usize];
        let start = line;
        at += token.len as usize;
        line += piece.matches('\n').count();
        (piece, token.kind, start)
    })
}

/// The first line of the docstring above line `line` (from 1).
fn docstring(lines: &[&str], line: usize) -> String {
    let above = lines[..line - 1].iter().rev();
    let block: Vec<&str> = above
        .map(|text| text.trim())
        .take_while(|text| text.starts_with("///") || text.starts_with("#["))
        .filter_map(|text| text.strip_prefix("///"))
        .collect();
    block.last().map_or(String::new(), |text| text.trim().to_string())
}

fn rust_files(dir: &Path, name: &str, files: &mut BTreeMap<String, String>) -> Result<()> {
    for entry in fs::read_dir(dir).with_context(|| format!("cannot list {name}"))? {
        let entry = entry?;
        let path = format!("{name}/{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            rust_files(&entry.path(), &path, files)?;
        } else if path.ends_with(".rs") {
            files.insert(path, fs::read_to_string(entry.path())?);
        }
    }
    Ok(())
}

pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
