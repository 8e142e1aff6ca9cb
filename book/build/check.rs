//! After the build: what a reader would stumble over.
//!
//! No leftover directive, no empty code block, no raw TeX, no link or picture
//! that leads nowhere, nothing fetched from outside, no figure or table without its number.

use anyhow::{Context, Result, bail};
use scraper::{ElementRef, Html, Node, Selector};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// What was looked at.
pub struct Counted {
    pages: usize,
    links: usize,
    equations: usize,
    listings: usize,
}

impl fmt::Display for Counted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "checked {} pages: {} links, {} formulas, {} listings",
            self.pages, self.links, self.equations, self.listings
        )
    }
}

struct Page {
    ids: BTreeSet<String>,
    links: Vec<String>,
}

/// Checks all pages under `html`; the error lists every fault.
pub fn pages(html: &Path) -> Result<Counted> {
    let mut files = Vec::new();
    html_files(html, &mut files)?;
    let select = |what: &str| Selector::parse(what).map_err(|error| anyhow::anyhow!("{error}"));
    let (any, code, maths) = (select("*")?, select("pre")?, select(".katex")?);
    let mut pages = BTreeMap::new();
    let mut faults = Vec::new();
    let mut counted = Counted { pages: files.len(), links: 0, equations: 0, listings: 0 };
    for file in &files {
        let name = file.strip_prefix(html)?.to_string_lossy().into_owned();
        let text = fs::read_to_string(file).with_context(|| format!("cannot read {name}"))?;
        let document = Html::parse_document(&text);
        for word in ["{{#", "$$", "\\frac", "\\tag", "\\begin"] {
            if visible_text(&document).contains(word) {
                faults.push(format!("{name}: `{word}` is left in the text"));
            }
        }
        for block in document.select(&code) {
            if block.text().all(|text| text.trim().is_empty()) {
                faults.push(format!("{name}: an empty code block"));
            }
            counted.listings += 1;
        }
        counted.equations += document.select(&maths).count();
        faults.extend(unnamed(&document)?.into_iter().map(|fault| format!("{name}: {fault}")));
        let mut page = Page { ids: BTreeSet::new(), links: Vec::new() };
        for element in document.select(&any) {
            let value = element.value();
            if let Some(id) = value.id()
                && !page.ids.insert(id.to_string())
                && name != "print.html"
            {
                faults.push(format!("{name}: the id `{id}` stands twice"));
            }
            let fetched = match value.name() {
                "a" => None,
                "link" | "script" | "img" => value.attr("src").or(value.attr("href")),
                _ => None,
            };
            if let Some(outside) = fetched.filter(|link| link.contains("//")) {
                faults.push(format!("{name}: fetches {outside} from outside"));
            }
            for attribute in ["href", "src"] {
                page.links.extend(value.attr(attribute).map(String::from));
            }
        }
        pages.insert(name, page);
    }
    for (name, page) in &pages {
        // In the page for print all chapters share one file.
        if name == "print.html" || name == "404.html" {
            continue;
        }
        for link in page.links.iter().filter(|link| !link.contains("://") && !link.is_empty()) {
            counted.links += 1;
            if let Some(fault) = broken(html, &pages, name, link) {
                faults.push(fault);
            }
        }
    }
    faults.extend(searched(html)?);
    if !faults.is_empty() {
        bail!("{} faults in the pages:\n  {}", faults.len(), faults.join("\n  "));
    }
    Ok(counted)
}

/// Figures and tables without number and caption, pictures without words, and numbers of
/// equations that lead to another one.
fn unnamed(document: &Html) -> Result<Vec<String>> {
    let select = |what: &str| Selector::parse(what).map_err(|error| anyhow::anyhow!("{error}"));
    let mut faults = Vec::new();
    let text = |element: ElementRef| element.text().collect::<String>();
    let captions: BTreeMap<&str, String> = document
        .select(&select(".caption, figure:has(> figcaption)")?)
        .filter_map(|caption| Some((caption.value().id()?, text(caption))))
        .collect();
    let is_numbered = |id: &str| {
        let words = captions.get(id).map_or("", |words| words.trim());
        words.starts_with("Table ") || words.starts_with("Figure ")
    };
    for table in document.select(&select("main .table-wrapper")?) {
        if !table.attr("aria-labelledby").is_some_and(is_numbered) {
            let words: String = text(table).split_whitespace().collect::<Vec<_>>().join(" ");
            let words: String = words.chars().take(40).collect();
            faults.push(format!("a table without a caption: {words}"));
        }
    }
    for figure in document.select(&select("main figure[id]")?) {
        if !figure.value().id().is_some_and(is_numbered) {
            faults.push("a figure without a caption".to_string());
        }
    }
    for picture in document.select(&select("main img")?) {
        if picture.attr("alt").is_none_or(|words| words.len() < 10) {
            faults.push(format!("{:?} is not said in words", picture.attr("src")));
        }
    }
    for link in document.select(&select("a.eq")?) {
        let number = text(link).replace(['(', ')'], "");
        let place = format!("#eq-{number}");
        if !link.attr("href").is_some_and(|link| link.ends_with(&place)) {
            faults.push(format!("({number}) leads to another equation"));
        }
    }
    Ok(faults)
}

/// What the search would show as an excerpt holds neither TeX nor directives.
fn searched(html: &Path) -> Result<Vec<String>> {
    let mut faults = Vec::new();
    for entry in fs::read_dir(html)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.starts_with("searchindex") {
            let index = fs::read_to_string(&path)?;
            let left = ["{{#", "\\frac", "\\tag", "\\mathbf", "\\Delta"];
            let left = left.iter().filter(|word| index.contains(*word));
            faults.extend(left.map(|word| format!("{name}: `{word}` is left in what is searched")));
        }
    }
    Ok(faults)
}

/// The text that a reader sees: no scripts, no styles, no TeX source that
/// MathML keeps beside its formula.
fn visible_text(document: &Html) -> String {
    let hidden = ["script", "style", "annotation"];
    let mut out = String::new();
    for node in document.tree.nodes() {
        if let Node::Text(text) = node.value() {
            let inside_hidden = node.ancestors().any(|above| {
                above.value().as_element().is_some_and(|element| hidden.contains(&element.name()))
            });
            // Code may hold anything that its language allows.
            let inside_code = node.ancestors().any(|above| {
                above
                    .value()
                    .as_element()
                    .is_some_and(|element| ["pre", "code"].contains(&element.name()))
            });
            if !inside_hidden && !inside_code {
                out.push_str(text);
                out.push('\n');
            }
        }
    }
    out
}

fn broken(html: &Path, pages: &BTreeMap<String, Page>, name: &str, link: &str) -> Option<String> {
    let (path, fragment) = link.split_once('#').unwrap_or((link, ""));
    let path = path.split('?').next().unwrap_or(path);
    let target = match path {
        "" => PathBuf::from(name),
        _ => normal(&Path::new(name).parent().unwrap_or(Path::new("")).join(path)),
    };
    if !html.join(&target).is_file() {
        return Some(format!("{name}: the link {link} leads to no file"));
    }
    let page = pages.get(&target.to_string_lossy().into_owned())?;
    let found = fragment.is_empty() || page.ids.contains(fragment);
    (!found).then(|| format!("{name}: the link {link} leads to no place on its page"))
}

/// Resolves `..` and `.` without asking the file system.
fn normal(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            std::path::Component::ParentDir => {
                out.pop();
            }
            std::path::Component::CurDir => {}
            other => out.push(other),
        }
    }
    out
}

/// All pages below `dir`, in order.
pub fn html_files(dir: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(dir)? {
        let path = entry?.path();
        if path.is_dir() {
            html_files(&path, files)?;
        } else if path.extension().is_some_and(|ending| ending == "html") {
            files.push(path);
        }
    }
    files.sort();
    Ok(())
}
