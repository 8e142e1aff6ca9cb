//! `cargo book`: builds the book and fails loudly.
//!
//! mdBook alone finishes without an error when an include is missing. Here
//! every directive, formula, link and anchor is checked, before and after the
//! build, and the first thing wrong ends it.

mod check;
mod directives;
mod index;
mod listing;
mod maths;

use anyhow::{Context, Result, bail};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use mdbook_driver::MDBook;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

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
    let open = match arguments {
        [] => false,
        [flag] if flag == "--open" => true,
        _ => bail!("usage: cargo book [--open]"),
    };
    let book_dir = Path::new(env!("CARGO_MANIFEST_DIR"));
    let preprocessor = directives::Directives::new()?;
    let figures = preprocessor.figures();
    let mut book = MDBook::load(book_dir)?;
    book.with_preprocessor(preprocessor);
    book.build()?;

    let html = book.build_dir_for("html");
    copy_into(&book_dir.join("theme/katex/fonts"), &html.join("theme/katex/fonts"))?;
    for figure in figures.borrow().iter() {
        let to = html.join("figures").join(directives::figure_name(figure));
        fs::create_dir_all(html.join("figures"))?;
        fs::copy(root().join(figure), &to).with_context(|| format!("cannot copy {figure}"))?;
    }
    lab(&html.join("lab"))?;
    let counted = check::pages(&html)?;
    println!("{counted}");
    let first = html.join("index.html").canonicalize()?;
    println!("the book is at {}", first.display());
    if open {
        opener::open(&first)?;
    }
    Ok(())
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
