//! A chapter as HTML: its text, equations as MathML, figures and what commands printed.

use super::chapters::Chapter;
use super::commands::{FIGURE, OUTPUT};
use super::targets::Targets;
use crate::steps::{Failure, Outcome};
use pulldown_cmark::{CodeBlockKind, CowStr, Event, Options, Parser, Tag, TagEnd, html as as_html};
use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::{Storage, push_mathml};
use std::path::Path;

/// A chapter that stands between contents.
pub struct Html {
    /// Its heading.
    pub title: String,
    /// The anchors and the texts of its sections.
    pub sections: Vec<(String, String)>,
    /// All of its text.
    pub body: String,
}

/// Text as it stands in HTML.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The anchor of a heading, as repositories' sites make it.
fn anchor(text: &str) -> String {
    let is_kept = |c: &char| c.is_alphanumeric() || matches!(c, '-' | '_');
    text.to_lowercase().replace(' ', "-").chars().filter(is_kept).collect()
}

/// The text of the events up to an end.
fn text_of<'a>(events: impl IntoIterator<Item = &'a Event<'a>>, end: impl Fn(&Event<'_>) -> bool) -> String {
    let until = events.into_iter().take_while(|event| !end(event));
    let text = |event: &Event<'_>| match event {
        Event::Text(text) | Event::Code(text) => text.to_string(),
        Event::SoftBreak => " ".to_owned(),
        _ => String::new(),
    };
    until.map(text).collect()
}

/// Makes HTML of a chapter's text; `printed` is what its blocks of commands printed.
pub fn html(chapter: &Chapter, text: &str, printed: &[String], targets: &mut Targets<'_>) -> Outcome<Html> {
    let named = |what: &str| Failure::new(format!("{}: {what}", chapter.file));
    let options = Options::ENABLE_TABLES | Options::ENABLE_MATH;
    let events: Vec<_> = Parser::new_ext(text, options).collect();
    let (mut title, mut sections, mut out) = (String::new(), Vec::new(), Vec::new());
    let (mut blocks, mut is_link) = (0, false);
    for (i, event) in events.iter().enumerate() {
        let rest = &events[i + 1..];
        let raw = |html: String| Event::Html(CowStr::from(html));
        match event {
            Event::Start(Tag::Heading { level, .. }) => {
                let text = text_of(rest, |event| matches!(event, Event::End(TagEnd::Heading(_))));
                let id = anchor(&text);
                out.push(raw(format!("<{level} id=\"{id}\">")));
                match *level as usize {
                    1 => title = text,
                    2 => sections.push((id, text)),
                    _ => {}
                }
            }
            Event::Start(Tag::Link { dest_url, .. }) => {
                let function = match rest.first() {
                    Some(Event::Code(name)) if dest_url.ends_with(".rs") => Some(name.as_ref()),
                    _ => None,
                };
                let url =
                    targets.link(chapter.file, dest_url, function).map_err(|e| named(&e.to_string()))?;
                is_link = url.is_some();
                out.extend(url.map(|url| raw(format!("<a href=\"{}\">", escape(&url)))));
            }
            Event::End(TagEnd::Link) => out.extend(is_link.then(|| raw("</a>".to_owned()))),
            Event::Start(Tag::Image { dest_url, .. }) => {
                let alt = text_of(rest, |event| matches!(event, Event::End(TagEnd::Image)));
                let url = targets.picture(chapter.file, dest_url)?;
                out.push(raw(format!("<img src=\"{}\" alt=\"{}\">", escape(&url), escape(&alt))));
            }
            Event::Start(Tag::Table(_)) => {
                let label = sections.last().map_or(title.as_str(), |(_, text)| text);
                let region = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"";
                out.extend([raw(format!("{region}{}\">", escape(label))), event.clone()]);
            }
            Event::End(TagEnd::Table) => out.extend([event.clone(), raw("</div>\n".to_owned())]),
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(kind))) => {
                blocks += usize::from(kind.as_ref() == "sh");
                out.push(event.clone());
            }
            Event::InlineMath(latex) => {
                out.push(raw(math(latex, DisplayMode::Inline).map_err(|e| named(&e))?));
            }
            Event::DisplayMath(latex) => {
                out.push(raw(math(latex, DisplayMode::Block).map_err(|e| named(&e))?));
            }
            Event::Html(comment) | Event::InlineHtml(comment) => {
                let comment = comment.trim();
                if let Some(figure) = comment.strip_prefix(FIGURE).and_then(|rest| rest.strip_suffix(" -->"))
                {
                    out.push(raw(figure_of(figure, targets).map_err(|e| named(&e.to_string()))?));
                } else if comment == OUTPUT {
                    let text = printed.get(blocks.wrapping_sub(1)).filter(|text| !text.is_empty());
                    let text = text.ok_or_else(|| named("no command above printed anything"))?;
                    out.push(raw(format!("<pre class=\"output\">{}</pre>\n", escape(text))));
                } else if !comment.starts_with("<!--") {
                    return Err(named(&format!("{comment}: is HTML, which other readers may not show")));
                }
            }
            // The text of a picture is its alternative.
            Event::Text(_) if is_in_image(&events[..i]) => {}
            Event::End(TagEnd::Image) => {}
            _ => out.push(event.clone()),
        }
    }
    let mut body = String::new();
    as_html::push_html(&mut body, out.into_iter());
    if title.is_empty() {
        return Err(named("has no heading"));
    }
    Ok(Html { title, sections, body })
}

/// Whether the last of the events that begins or ends a picture begins it.
fn is_in_image(before: &[Event<'_>]) -> bool {
    let mut images = before.iter().rev().filter_map(|event| match event {
        Event::Start(Tag::Image { .. }) => Some(true),
        Event::End(TagEnd::Image | TagEnd::Paragraph) => Some(false),
        _ => None,
    });
    images.next().unwrap_or(false)
}

/// An equation as MathML.
fn math(latex: &str, display_mode: DisplayMode) -> Result<String, String> {
    let storage = Storage::new();
    let parser = || pulldown_latex::Parser::new(latex, &storage);
    // What is wrong is written into the equation, where nobody would look for it.
    if let Some(error) = parser().find_map(Result::err) {
        return Err(format!("{latex}: {error}").replace('\n', " "));
    }
    let mut mathml = String::new();
    let config = RenderConfig { display_mode, ..RenderConfig::default() };
    push_mathml(&mut mathml, parser(), config).map_err(|e| format!("{latex}: {e}"))?;
    Ok(mathml)
}

/// A file that a command wrote: a picture with its caption, or a link to a page.
fn figure_of(words: &str, targets: &mut Targets<'_>) -> Outcome<String> {
    let Some((file, caption)) = words.split_once(" | ") else {
        return Err(Failure::new(format!("{words}: a figure is FILE | CAPTION")));
    };
    let (url, is_picture) = targets.figure(file)?;
    let (url, caption) = (escape(&url), escape(caption));
    let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
    Ok(if is_picture {
        format!(
            "<figure><img src=\"{url}\" alt=\"{}\"><figcaption>{caption}</figcaption></figure>\n",
            escape(&stem)
        )
    } else {
        format!("<p class=\"quiet\"><a href=\"{url}\">{caption}</a></p>\n")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn anchors_are_those_of_the_repository() {
        assert_eq!(anchor("Disparity and depth: `match`").replace('`', ""), "disparity-and-depth-match");
        assert_eq!(anchor("In a task, and on two cores"), "in-a-task-and-on-two-cores");
    }

    #[test]
    fn equations_are_mathml_or_an_error() {
        let found = math(r"z = \frac{b f}{u - u'}", DisplayMode::Inline).expect("an equation");
        assert!(found.starts_with("<math") && found.contains("<mfrac>"), "{found}");
        assert!(math(r"\frac{1}", DisplayMode::Inline).is_err());
    }
}
