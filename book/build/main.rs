//! `cargo book`: builds the book and fails loudly.
//!
//! mdBook alone finishes without an error when an include is missing. Here
//! every directive, formula, link and anchor is checked, before and after the
//! build, and the first thing wrong ends it.

mod captions;
mod check;
mod directives;
mod finish;
mod index;
mod listing;
mod maths;
mod pair;

use anyhow::{Context, Result, bail};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use mdbook_driver::MDBook;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// The top of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Reads a file of the repository; the error names it.
pub fn read(path: &str) -> Result<String> {
    fs::read_to_string(root().join(path)).with_context(|| format!("cannot read {path}"))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match build(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn build(arguments: &[String]) -> Result<()> {
    let (open, pdf) = match arguments {
        [] => (false, false),
        [flag] if flag == "--open" => (true, false),
        [flag] if flag == "--pdf" => (false, true),
        _ => bail!("usage: cargo book [--open | --pdf]"),
    };
    let book_dir = Path::new(env!("CARGO_MANIFEST_DIR"));
    let preprocessor = directives::Directives::new()?;
    let gathered = preprocessor.gathered();
    let mut book = MDBook::load(book_dir)?;
    book.with_preprocessor(preprocessor);
    book.build()?;

    let html = book.build_dir_for("html");
    copy_into(&book_dir.join("theme/katex/fonts"), &html.join("theme/katex/fonts"))?;
    let gathered = gathered.borrow();
    for figure in &gathered.figures {
        let to = html.join("figures").join(directives::figure_name(figure));
        fs::create_dir_all(html.join("figures"))?;
        fs::copy(root().join(figure), &to).with_context(|| format!("cannot copy {figure}"))?;
    }
    lab(&html.join("lab"))?;
    finish::pages(&html, &gathered.formulas)?;
    let counted = check::pages(&html)?;
    println!("{counted}");
    let first = html.join("index.html").canonicalize()?;
    println!("the book is at {}", first.display());
    if open {
        opener::open(&first)?;
    }
    if pdf {
        println!("for print it is at {}", print(&html)?.display());
    }
    Ok(())
}

/// Prints the page that holds all chapters, by the Chromium that CHROMIUM names, or by the first
/// that is installed.
fn print(html: &Path) -> Result<PathBuf> {
    let page = html.join("print.html").canonicalize()?;
    let to = page.with_file_name("lme-mpm.pdf");
    let named = std::env::var("CHROMIUM");
    let names = match &named {
        Ok(name) => vec![name.as_str()],
        Err(_) => vec!["chromium", "chromium-browser", "google-chrome"],
    };
    for name in &names {
        let mut command = Command::new(name);
        command.args(["--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer"]);
        command.arg("--generate-pdf-document-outline");
        command.arg(format!("--print-to-pdf={}", to.display()));
        command.arg(format!("file://{}", page.display())).stderr(Stdio::null());
        match command.status() {
            Ok(status) if status.success() && to.is_file() => return Ok(to),
            Ok(status) => bail!("{name} has printed nothing ({status})"),
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error).with_context(|| format!("cannot start {name}")),
        }
    }
    bail!("--pdf needs a Chromium: there is no {}; CHROMIUM may name one", names.join(", no "))
}

/// Puts the page's solver and its scenes into `to` as a script, because a page that is opened from
/// a disk may load no other file, and beside it what draws.
fn lab(to: &Path) -> Result<()> {
    copy_into(&root().join("book/lab/page"), to)?;
    let wasm =
        fs::read(root().join("book/lab/lab.wasm")).context("cannot read book/lab/lab.wasm")?;
    let mut scenes = String::new();
    for name in ["dyka", "manufactured", "colliding-discs", "spinning-bar"] {
        let text = read(&format!("data/scenes/{name}.toml"))?;
        // A string of Rust is one of JavaScript.
        scenes.push_str(&format!("{name:?}: {text:?}, "));
    }
    let script = format!(
        "window.LAB_SOLVER = {{ scenes: {{ {scenes}}}, wasm: \"{}\" }};\n",
        STANDARD.encode(wasm)
    );
    fs::write(to.join("solver.js"), script).context("cannot write lab/solver.js")
}

fn copy_into(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        fs::copy(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
}
