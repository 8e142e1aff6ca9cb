//! Formulas: `$…$` and `$$…$$` become HTML and MathML at build time.

use anyhow::{Result, anyhow, bail};
use katex::{KatexContext, Settings, render_to_string};
use pulldown_cmark::{Event, Options, Parser};

/// Renders every formula of a chapter. A display formula with `\tag{n}` gets
/// the id `eq-n`, so that equations can be linked by the paper's numbers.
pub fn render(chapter: &str, text: &str) -> Result<String> {
    let context = KatexContext::default();
    let options = Options::ENABLE_MATH | Options::ENABLE_TABLES;
    let mut out = String::with_capacity(text.len());
    let mut done = 0;
    for (event, range) in Parser::new_ext(text, options).into_offset_iter() {
        let (tex, display) = match &event {
            Event::InlineMath(tex) => (tex, false),
            Event::DisplayMath(tex) => (tex, true),
            _ => continue,
        };
        let settings = Settings::builder().display_mode(display).build();
        let html = render_to_string(&context, tex, &settings)
            .map_err(|error| anyhow!("{chapter}: formula `{tex}`: {error}"))?;
        let html = escape_text(&html);
        out.push_str(&text[done..range.start]);
        match display {
            false => out.push_str(&html),
            true => match tag(tex)? {
                Some(n) => {
                    out.push_str(&format!("<div class=\"equation\" id=\"eq-{n}\">{html}</div>"))
                }
                None => out.push_str(&format!("<div class=\"equation\">{html}</div>")),
            },
        }
        done = range.end;
    }
    out.push_str(&text[done..]);
    Ok(out)
}

/// The number in `\tag{n}`.
pub fn tag(tex: &str) -> Result<Option<&str>> {
    let Some((_, rest)) = tex.split_once("\\tag{") else { return Ok(None) };
    match rest.split_once('}') {
        Some((n, _)) => Ok(Some(n)),
        None => bail!("\\tag without its end in `{tex}`"),
    }
}

/// Markdown would read `_`, `*`, … between tags; entities keep it off.
fn escape_text(html: &str) -> String {
    let mut out = String::with_capacity(html.len());
    let mut inside_tag = false;
    for c in html.chars() {
        match c {
            '<' => inside_tag = true,
            '>' => inside_tag = false,
            '_' | '*' | '\\' | '[' | ']' | '|' | '`' | '~' if !inside_tag => {
                out.push_str(&format!("&#{};", c as u32));
                continue;
            }
            '\n' => {
                out.push(' ');
                continue;
            }
            _ => {}
        }
        out.push(c);
    }
    out
}
