//! After mdBook: what it cannot do. Formulas take their places, tables get a name, the page for
//! print leaves the source out, and the page for a wrong address finds its way.

use crate::check::html_files;
use crate::maths::{self, Formula};
use anyhow::{Context, Result};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Mends all pages under `html`, and writes what `pages.js` shows of an equation.
pub fn pages(html: &Path, formulas: &[Formula]) -> Result<()> {
    let mut files = Vec::new();
    html_files(html, &mut files)?;
    for file in files {
        let page = fs::read_to_string(&file)?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let mended = match &*name {
            "print.html" => print(&page)?,
            "404.html" => not_found(&page)?,
            _ => page.clone(),
        };
        // What opens the table of contents is a button, and says so.
        let mended = mended.replace("<label id", "<label role=\"button\" tabindex=\"0\" id");
        let mended = tables(&maths::fill(&mended, formulas).with_context(|| name.to_string())?);
        let mended = commands(&mended);
        if mended != page {
            fs::write(&file, mended).with_context(|| format!("cannot write {name}"))?;
        }
    }
    let mut script = String::new();
    for Formula { html, number } in formulas {
        if let Some(number) = number {
            // A string of Rust is one of JavaScript.
            script.push_str(&format!("{number:?}: {html:?},\n"));
        }
    }
    let script = format!("window.EQUATIONS = {{\n{script}}};\n");
    fs::write(html.join("theme/equations.js"), script).context("cannot write equations.js")
}

/// A table is a region that keys can scroll, with its caption as its name.
fn tables(page: &str) -> String {
    const CAPTION: &str = "<div class=\"caption\" id=\"";
    const TABLE: &str = "<div class=\"table-wrapper\"";
    let mut pieces = page.split(CAPTION);
    let mut out = pieces.next().unwrap_or("").to_string();
    for piece in pieces {
        let id = piece.split('"').next().unwrap_or("");
        let region = format!("{TABLE} tabindex=\"0\" role=\"region\" aria-labelledby=\"{id}\"");
        out.push_str(CAPTION);
        out.push_str(&piece.replacen(TABLE, &region, 1));
    }
    out
}

/// Each line of a block of commands is an element, so that one that is wrapped can be indented.
fn commands(page: &str) -> String {
    const BLOCK: &str = "<code class=\"language-console\">";
    let mut pieces = page.split(BLOCK);
    let mut out = pieces.next().unwrap_or("").to_string();
    for piece in pieces {
        let (block, rest) = piece.split_once("</code>").unwrap_or((piece, ""));
        out.push_str(BLOCK);
        for line in block.lines() {
            out.push_str(&format!("<span class=\"line\">{line}</span>\n"));
        }
        out.push_str("</code>");
        out.push_str(rest);
    }
    out
}

/// On paper nothing unfolds, and the source is not read: its pages go, and so do links to them.
fn print(page: &str) -> Result<String> {
    let (book, source) = page.split_once("<h1 id=\"the-source-file-by-file\"").context("source")?;
    let (_, end) = source.split_once("</main>").context("no end of the page for print")?;
    let page = format!("{book}</main>{end}").replace("<details", "<details open");
    let ids: BTreeSet<&str> =
        page.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let mut pieces = page.split(" href=\"#");
    let mut out = pieces.next().unwrap_or("").to_string();
    for piece in pieces {
        let (target, rest) = piece.split_once('"').context("a link without its end")?;
        if ids.contains(target) {
            out.push_str(&format!(" href=\"#{target}\""));
        }
        out.push_str(rest);
    }
    Ok(out)
}

/// The address that leads nowhere may lie in any folder of the book, which may lie in any folder
/// of a server: the page asks the address where the book begins.
fn not_found(page: &str) -> Result<String> {
    let base = "<base href=\"/\">";
    let (before, after) = page.split_once(base).context("404.html has no base")?;
    let script = "<script>document.write('<base href=\"' + \
                  location.pathname.replace(/(source\\/.*|lab\\/.*|[^\\/]*)$/, '') + '\">');</script>";
    Ok(format!("{before}{script}{after}"))
}
