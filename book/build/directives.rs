//! Directives: what a chapter may ask for instead of typing it.
//!
//! | directive | gives |
//! |---|---|
//! | `{{#code FILE:ANCHOR}}` | anchored lines of the source |
//! | `{{#side}}` … `{{#beside}}` … `{{#end}}` | prose and the code that it explains |
//! | `{{#pin SNAPSHOT}}` | an approved text |
//! | `{{#file FILE}}` | the text of a file of the repository |
//! | `{{#table FILE | CAPTION}}` | a CSV file, or a snapshot that holds CSV, as a table |
//! | `{{#caption NAME | CAPTION}}` | the caption of the table that is typed below it |
//! | `{{#value FILE KEY [percent]}}` | one approved number, in a sentence |
//! | `{{#figure SNAPSHOT | CAPTION [| ALTERNATIVE]}}` | an approved picture |
//! | `{{#see FILE}}`, `{{#see NAME}}` | "Figure 7", "Table 3": a link to what has this caption |
//! | `{{#equations}}`, `{{#symbols}}` | the two indexes |

use crate::captions::{Caption, Captions, parts};
use crate::listing::{Definitions, escape, page_of};
use crate::maths::{self, Formula};
use crate::{index, pair, read};
use anyhow::{Context, Result, anyhow, bail};
use mdbook_preprocessor::book::{Book, BookItem, Chapter, SectionNumber};
use mdbook_preprocessor::{Preprocessor, PreprocessorContext};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// What the pages need beside what mdBook makes of the chapters.
#[derive(Default)]
pub struct Gathered {
    /// The pictures that chapters asked for.
    pub figures: BTreeSet<String>,
    pub formulas: Vec<Formula>,
}

pub struct Directives {
    definitions: Definitions,
    /// "(16)" and its place, `weak-form.html#eq-16`.
    equations: BTreeMap<String, String>,
    gathered: Rc<RefCell<Gathered>>,
}

/// Where in the book the expanding stands.
struct Place<'a> {
    chapter: String,
    to_root: String,
    all_captions: &'a Captions,
    /// Those that the chapter has not come to.
    captions: Box<dyn Iterator<Item = &'a Caption> + 'a>,
    in_pair: bool,
}

impl Directives {
    pub fn new() -> Result<Self> {
        Ok(Directives {
            definitions: Definitions::collect()?,
            equations: index::places()?,
            gathered: Rc::default(),
        })
    }

    /// Filled in by the build.
    pub fn gathered(&self) -> Rc<RefCell<Gathered>> {
        self.gathered.clone()
    }

    fn chapter(&self, chapter: &Chapter, all_captions: &Captions) -> Result<String> {
        let Some(path) = &chapter.path else { return Ok(chapter.content.clone()) };
        let name = path.display().to_string();
        let to_root = "../".repeat(path.components().count() - 1);
        let captions = Box::new(all_captions.of(&name));
        let chapter_name = name.clone();
        let mut place =
            Place { chapter: chapter_name, to_root, all_captions, captions, in_pair: false };
        let mut text = String::new();
        let mut rest = chapter.content.as_str();
        while let Some((before, after)) = rest.split_once("{{#") {
            let (directive, after) = after
                .split_once("}}")
                .with_context(|| format!("{name}: a directive without its end"))?;
            text.push_str(before);
            let expanded = self
                .expand(directive, after, &mut place)
                .with_context(|| format!("{name}: {{{{#{directive}}}}}"))?;
            text.push_str(&expanded);
            rest = after;
        }
        text.push_str(rest);
        let formulas = &mut self.gathered.borrow_mut().formulas;
        maths::render(&name, &text, formulas, |number| {
            Some(format!("{}{}", place.to_root, self.equations.get(number)?))
        })
    }

    fn expand(&self, directive: &str, after: &str, place: &mut Place) -> Result<String> {
        let (word, argument) = directive.split_once(' ').unwrap_or((directive, ""));
        let argument = argument.trim();
        match word {
            "code" => {
                let (file, anchor) = argument.split_once(':').context("wants FILE:ANCHOR")?;
                self.definitions.listing(file, anchor, &place.to_root, place.in_pair)
            }
            "side" => {
                place.in_pair = true;
                let layout = pair::layout(&self.definitions, after)?;
                Ok(format!("<div class=\"side {layout}\"><div class=\"prose\">\n"))
            }
            "beside" => Ok("</div><div class=\"beside\">\n".into()),
            "end" => {
                place.in_pair = false;
                Ok("</div></div>\n".into())
            }
            "pin" => Ok(format!("```text\n{}\n```", snapshot(argument)?.trim_end())),
            "file" => Ok(read(argument)?.trim_end().to_string()),
            "table" => {
                let (file, caption, _) = parts(argument)?;
                Ok(format!("{}{}", above_table(caption, place)?, table(file)?))
            }
            "caption" => above_table(parts(argument)?.1, place),
            "value" => value(argument),
            "figure" => self.figure(argument, place),
            "see" => place.all_captions.see(argument, &place.chapter, &place.to_root),
            "equations" => index::equations(&self.definitions, &place.to_root),
            "symbols" => index::symbols(),
            _ => bail!("this directive is not known"),
        }
    }

    /// A picture that is a link to itself, at its full size.
    fn figure(&self, argument: &str, place: &mut Place) -> Result<String> {
        let (file, caption, alternative) = parts(argument)?;
        if !crate::root().join(file).is_file() {
            bail!("there is no file {file}");
        }
        self.gathered.borrow_mut().figures.insert(file.to_string());
        let number = place.captions.next().context("has no number")?;
        let alternative = escape(&maths::words(alternative.unwrap_or(caption))?);
        let picture = format!("{}figures/{}", place.to_root, figure_name(file));
        Ok(format!(
            "<figure id=\"{}\">\n<a href=\"{picture}\"><img src=\"{picture}\" alt=\"{alternative}\"></a>\n\
             <figcaption>\n\n**{}.** {caption}\n\n</figcaption></figure>",
            number.id(),
            number.title()
        ))
    }

    /// The source as chapters of its own, numbered from `number` on, so that code
    /// can be linked.
    fn source_chapters(&self, number: u32) -> Vec<BookItem> {
        let mut top = Chapter::new(
            "The source, file by file",
            "# The source, file by file\n\n".to_string(),
            "source/index.md",
            Vec::new(),
        );
        top.number = Some(SectionNumber::new([number]));
        for (n, file) in (1..).zip(self.definitions.files.keys()) {
            let path = page_of(file).replace(".html", ".md");
            let to_root = "../".repeat(path.matches('/').count());
            let from_index = page_of(file).replacen("source/", "", 1);
            top.content.push_str(&format!("- [`{file}`]({from_index})\n"));
            let content = self.definitions.page(file, &to_root);
            let parents = vec![top.name.clone()];
            let mut chapter = Chapter::new(file, content, path, parents);
            chapter.number = Some(SectionNumber::new([number, n]));
            top.sub_items.push(BookItem::Chapter(chapter));
        }
        vec![BookItem::PartTitle("The source".to_string()), BookItem::Chapter(top)]
    }
}

impl Preprocessor for Directives {
    fn name(&self) -> &str {
        "lme-mpm"
    }

    fn run(&self, _: &PreprocessorContext, mut book: Book) -> Result<Book> {
        let captions = Captions::collect(&book);
        let mut failure = None;
        book.for_each_chapter_mut(|chapter| match self.chapter(chapter, &captions) {
            Ok(content) => chapter.content = content,
            Err(error) => failure = failure.take().or(Some(error)),
        });
        if let Some(error) = failure {
            return Err(error);
        }
        let numbered = book.chapters().filter(|chapter| chapter.number.is_some()).count();
        for item in self.source_chapters(numbered as u32 + 1) {
            book.push_item(item);
        }
        Ok(book)
    }
}

fn above_table(caption: &str, place: &mut Place) -> Result<String> {
    let number = place.captions.next().context("has no number")?;
    let (id, title) = (number.id(), number.title());
    Ok(format!("<div class=\"caption\" id=\"{id}\">\n\n**{title}.** {caption}\n\n</div>\n\n"))
}

/// `snapshots/name.snap.svg` → `name.svg`.
pub fn figure_name(file: &str) -> String {
    let name = file.rsplit('/').next().unwrap_or(file);
    name.replace(".snap.svg", ".svg")
}

/// The body of a snapshot, without its header.
fn snapshot(file: &str) -> Result<String> {
    let text = read(file)?;
    let body = text.strip_prefix("---\n").and_then(|rest| rest.split_once("\n---\n"));
    Ok(body.with_context(|| format!("{file} is not a snapshot"))?.1.to_string())
}

/// Rows of a CSV file, or of a snapshot that holds CSV.
fn rows(file: &str) -> Result<Vec<Vec<String>>> {
    let text = if file.ends_with(".snap") { snapshot(file)? } else { read(file)? };
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    let rows = reader
        .records()
        .map(|row| Ok(row?.iter().map(String::from).collect()))
        .collect::<Result<Vec<Vec<String>>>>()
        .with_context(|| format!("{file} is not CSV"))?;
    if rows.len() < 2 {
        bail!("{file} holds no rows");
    }
    Ok(rows)
}

fn table(file: &str) -> Result<String> {
    let rows = rows(file)?;
    // A cell is text: its bars end no column, its angles open no tag, its stars are stars, and
    // its brackets hold no number of an equation.
    let cell = |text: &String| {
        let text = text.replace('<', "&lt;").replace('|', "\\|");
        text.replace('*', "\\*").replace('(', "&#40;")
    };
    let line =
        |row: &[String]| format!("| {} |\n", row.iter().map(cell).collect::<Vec<_>>().join(" | "));
    let words: Vec<String> = rows[0].iter().map(|name| name.replace('_', " ")).collect();
    let mut out = line(&words);
    // Numbers stand below each other; the first column names the row.
    let is_number = |text: &str| !text.contains(|c: char| c.is_alphabetic() && c != 'e');
    let rules: Vec<String> = (0..words.len())
        .map(|n| {
            match n > 0 && rows[1..].iter().all(|row| row.get(n).is_none_or(|t| is_number(t))) {
                true => "---:".to_string(),
                false => "---".to_string(),
            }
        })
        .collect();
    out.push_str(&format!("| {} |\n", rules.join(" | ")));
    rows[1..].iter().for_each(|row| out.push_str(&line(row)));
    Ok(out)
}

/// One number of a `quantity,value,unit` table, to three digits.
fn value(argument: &str) -> Result<String> {
    let mut words = argument.split_whitespace();
    let (file, key) = (words.next().context("wants FILE KEY")?, words.next().context("wants KEY")?);
    let rows = rows(file)?;
    let row = rows.iter().find(|row| row[0] == key).with_context(|| format!("no row {key}"))?;
    let number: f64 = row[1].parse().map_err(|_| anyhow!("`{}` is not a number", row[1]))?;
    match words.next() {
        Some("percent") => Ok(format!("{} %", three_digits(100.0 * number))),
        Some("plain") => Ok(row[1].clone()),
        None => Ok(three_digits(number)),
        Some(other) => bail!("`{other}` is not a format"),
    }
}

fn three_digits(x: f64) -> String {
    let magnitude = if x == 0.0 { 0 } else { x.abs().log10().floor() as i32 };
    match magnitude {
        0..=2 => format!("{x:.*}", (2 - magnitude) as usize),
        -3..=-1 => format!("{x:.*}", (2 - magnitude) as usize),
        3..=5 => format!("{x:.0}"),
        _ => {
            let text = format!("{x:.2e}");
            let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
            format!("${digits}\\cdot10^{{{power}}}$")
        }
    }
}
