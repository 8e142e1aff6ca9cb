//! Captions: every figure and every table has a number, in the order of the chapters, and can be
//! referred to by the file that it shows, or by the name that its `caption` gives it.

use anyhow::{Context, Result, bail};
use mdbook_preprocessor::book::Book;

/// One numbered figure or table.
#[derive(Clone)]
pub struct Caption {
    /// The chapter that holds it: `algorithm.md`.
    chapter: String,
    /// What `see` calls it: a file, or a name.
    name: String,
    kind: &'static str,
    number: usize,
}

impl Caption {
    /// `Figure 7`.
    pub fn title(&self) -> String {
        format!("{} {}", self.kind, self.number)
    }

    /// `figure-dyka__velocity_end`, the place on its page.
    pub fn id(&self) -> String {
        let name = self.name.rsplit('/').next().unwrap_or(&self.name);
        let stem = name.split('.').next().unwrap_or(name);
        format!("{}-{stem}", self.kind.to_lowercase())
    }
}

/// All captions of the book, in its order.
#[derive(Default)]
pub struct Captions(Vec<Caption>);

impl Captions {
    /// Numbers what the chapters ask for.
    pub fn collect(book: &Book) -> Self {
        let mut all = Captions::default();
        for chapter in book.chapters() {
            let Some(path) = &chapter.path else { continue };
            for directive in chapter.content.split("{{#").skip(1) {
                let directive = directive.split("}}").next().unwrap_or(directive);
                let (word, argument) = directive.split_once(' ').unwrap_or((directive, ""));
                let kind = match word {
                    "figure" => "Figure",
                    "table" | "caption" => "Table",
                    _ => continue,
                };
                let number = 1 + all.0.iter().filter(|other| other.kind == kind).count();
                let name = argument.split(" | ").next().unwrap_or(argument).trim().to_string();
                all.0.push(Caption { chapter: path.display().to_string(), name, kind, number });
            }
        }
        all
    }

    /// The captions of one chapter, first to last.
    pub fn of(&self, chapter: &str) -> impl Iterator<Item = &Caption> {
        self.0.iter().filter(move |caption| caption.chapter == chapter)
    }

    /// `[Figure 7](page.html#figure-…)`. What stands in more than one chapter is taken from the
    /// chapter that refers to it, or else from the first.
    pub fn see(&self, name: &str, chapter: &str, to_root: &str) -> Result<String> {
        let own = self.of(chapter).find(|caption| caption.name == name);
        let first = || self.0.iter().find(|caption| caption.name == name);
        let Some(caption) = own.or_else(first) else {
            bail!("no figure or table of the book is called `{name}`");
        };
        let page = caption.chapter.replace(".md", ".html");
        Ok(format!("[{}]({to_root}{page}#{})", caption.title(), caption.id()))
    }
}

/// `FILE | CAPTION` or `FILE | CAPTION | ALTERNATIVE` in its parts.
pub fn parts(argument: &str) -> Result<(&str, &str, Option<&str>)> {
    let mut parts = argument.split(" | ").map(str::trim);
    let name = parts.next().unwrap_or("");
    let caption = parts.next().filter(|caption| !caption.is_empty());
    Ok((name, caption.context("wants a caption: NAME | CAPTION")?, parts.next()))
}
