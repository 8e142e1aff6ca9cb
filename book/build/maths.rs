//! Formulas: `$…$` and `$$…$$` become HTML and MathML at build time, and "(16)" in a sentence
//! becomes a link to its equation.

use anyhow::{Result, anyhow, bail};
use katex::{KatexContext, Settings, render_to_string};
use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd};
use scraper::{ElementRef, Html, Selector};

/// A formula as it will stand on the page. Until the pages are built its words hold its place, so
/// that the search finds words and not the letters of its layout.
pub struct Formula {
    pub html: String,
    /// "16" for a display formula with `\tag{16}`.
    pub number: Option<String>,
}

const OPTIONS: Options = Options::ENABLE_MATH.union(Options::ENABLE_TABLES);

/// Renders every formula of a chapter into `formulas`. A display formula with `\tag{n}` gets
/// the id `eq-n`, so that equations can be linked by the paper's numbers: `place` knows where
/// "(n)" is.
pub fn render(
    chapter: &str,
    text: &str,
    formulas: &mut Vec<Formula>,
    place: impl Fn(&str) -> Option<String>,
) -> Result<String> {
    let context = KatexContext::default();
    let mut out = String::with_capacity(text.len());
    let (mut done, mut in_link) = (0, 0);
    for (event, range) in Parser::new_ext(text, OPTIONS).into_offset_iter() {
        let new = match event {
            Event::InlineMath(tex) => {
                let html = html(&context, &tex, false).map_err(|e| anyhow!("{chapter}: {e}"))?;
                holder(html, None, formulas)
            }
            Event::DisplayMath(tex) => {
                let html = html(&context, &tex, true).map_err(|e| anyhow!("{chapter}: {e}"))?;
                let number = tag(&tex)?.map(String::from);
                let id = number.as_ref().map_or(String::new(), |n| format!(" id=\"eq-{n}\""));
                let held = holder(html, number, formulas);
                format!("<div class=\"equation\"{id}>{held}</div>")
            }
            Event::Text(words) if in_link == 0 && words.contains('(') => {
                linked(&text[range.clone()], &place)
            }
            // A heading is a link to itself; code and the heads of tables have no equations.
            Event::Start(
                Tag::Link { .. } | Tag::Heading { .. } | Tag::CodeBlock(_) | Tag::TableHead,
            ) => {
                in_link += 1;
                continue;
            }
            Event::End(
                TagEnd::Link | TagEnd::Heading(_) | TagEnd::CodeBlock | TagEnd::TableHead,
            ) => {
                in_link -= 1;
                continue;
            }
            _ => continue,
        };
        out.push_str(&text[done..range.start]);
        out.push_str(&new);
        done = range.end;
    }
    out.push_str(&text[done..]);
    Ok(out)
}

fn html(context: &KatexContext, tex: &CowStr, display: bool) -> Result<String> {
    let settings = Settings::builder().display_mode(display).build();
    render_to_string(context, &braced_roots(tex), &settings)
        .map_err(|error| anyhow!("formula `{tex}`: {error}"))
}

/// `\sqrt3` → `\sqrt{3}`: without braces the renderer draws the root behind its number.
fn braced_roots(tex: &str) -> String {
    let mut pieces = tex.split("\\sqrt");
    let mut out = pieces.next().unwrap_or("").to_string();
    for piece in pieces {
        out.push_str("\\sqrt");
        match piece.chars().next() {
            Some(bare) if bare.is_alphanumeric() => {
                out.push_str(&format!("{{{bare}}}{}", &piece[bare.len_utf8()..]));
            }
            _ => out.push_str(piece),
        }
    }
    out
}

/// What stands for a formula until the pages are built.
fn holder(html: String, number: Option<String>, formulas: &mut Vec<Formula>) -> String {
    let held =
        format!("{HOLDER}{}\">{}</span>", formulas.len(), escape_text(&words_of_mathml(&html)));
    formulas.push(Formula { html, number });
    held
}

const HOLDER: &str = "<span class=\"formula\" id=\"formula-";

/// Puts the formulas where their words have held the place.
pub fn fill(page: &str, formulas: &[Formula]) -> Result<String> {
    let mut pieces = page.split(HOLDER);
    let mut out = pieces.next().unwrap_or("").to_string();
    for piece in pieces {
        let parts = piece.split_once("\">").and_then(|(n, rest)| {
            // On the page for print an id may have got a number more.
            let formula = formulas.get(n.split('-').next()?.parse::<usize>().ok()?)?;
            Some((formula, rest.split_once("</span>")?.1))
        });
        let Some((formula, rest)) = parts else { bail!("a formula has lost its place") };
        out.push_str(&formula.html);
        out.push_str(rest);
    }
    Ok(out)
}

/// "(16)" and the like as links, where `place` knows them.
fn linked(text: &str, place: impl Fn(&str) -> Option<String>) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find('(') {
        let (before, from) = rest.split_at(at);
        out.push_str(before);
        let number = from.find(')').map_or("", |end| &from[..=end]);
        let is_call = before.ends_with(|c: char| c.is_alphanumeric());
        match place(number).filter(|_| !is_call) {
            Some(link) => out.push_str(&format!("<a class=\"eq\" href=\"{link}\">{number}</a>")),
            None => out.push('('),
        }
        let taken = if out.ends_with('(') { 1 } else { number.len() };
        rest = &from[taken..];
    }
    out + rest
}

/// The words of a text without its markup, its formulas as they are read.
pub fn words(markdown: &str) -> Result<String> {
    let context = KatexContext::default();
    let mut out = String::new();
    for event in Parser::new_ext(markdown, OPTIONS) {
        match event {
            Event::Text(text) | Event::Code(text) => out.push_str(&text),
            Event::SoftBreak => out.push(' '),
            Event::InlineMath(tex) => out.push_str(&words_of_mathml(&html(&context, &tex, false)?)),
            _ => {}
        }
    }
    Ok(out)
}

/// A formula as it is read in a line, from its MathML: `v_p`, `10^−3`, `(a+b)/c`.
fn words_of_mathml(html: &str) -> String {
    let html = Html::parse_fragment(html);
    let mathml = Selector::parse("math semantics > *:first-child").ok();
    let top = mathml.and_then(|mathml| html.select(&mathml).next());
    top.map_or(String::new(), read).split_whitespace().collect::<Vec<_>>().join(" ")
}

fn read(element: ElementRef) -> String {
    let parts: Vec<String> = element.child_elements().map(read).collect();
    let whole = |part: &String| match part.contains(['+', '−', '=', ' ', '/']) {
        true => format!("({part})"),
        false => part.clone(),
    };
    match (element.value().name(), &parts[..]) {
        (_, []) => element.text().collect(),
        ("msub" | "munder", [base, below]) => format!("{base}_{below}"),
        ("msup", [base, above]) => format!("{base}^{above}"),
        ("msubsup" | "munderover", [base, below, above]) => format!("{base}_{below}^{above}"),
        ("mfrac", [above, below]) => format!("{}/{}", whole(above), whole(below)),
        ("msqrt", _) => format!("√{}", whole(&parts.concat())),
        ("mtr", _) => parts.join(" ") + " ",
        _ => parts.concat(),
    }
}

/// The number in `\tag{n}`.
pub fn tag(tex: &str) -> Result<Option<&str>> {
    let Some((_, rest)) = tex.split_once("\\tag{") else { return Ok(None) };
    match rest.split_once('}') {
        Some((n, _)) => Ok(Some(n)),
        None => bail!("\\tag without its end in `{tex}`"),
    }
}

/// Markdown would read `_`, `*`, … in words; entities keep it off.
fn escape_text(words: &str) -> String {
    let mut out = String::with_capacity(words.len());
    for c in words.chars() {
        match c {
            '&' | '<' | '>' | '_' | '*' | '\\' | '[' | ']' | '|' | '`' | '~' | '$' => {
                out.push_str(&format!("&#{};", c as u32));
            }
            _ => out.push(c),
        }
    }
    out
}
