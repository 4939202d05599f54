//! What stands around a chapter: head, contents, and the way to its neighbours.

use super::chapter::{Html, escape};
use super::chapters::CHAPTERS;
use std::fmt::Write;

/// What the book is about, on its first page.
const ABOUT: &str = "Depth from two cameras on a microcontroller: a no_std, allocation-free Rust library \
                     that turns lines of pixels into rows of depth, and a program that runs the same code, \
                     bit for bit, on images.";

/// A page: `up` leads to the book's folder.
fn page(title: &str, up: &str, body: &str, contents: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\"><meta name=\"color-scheme\" content=\"light dark\">\
         <title>{} - stereopsis</title><link rel=\"stylesheet\" href=\"{up}book.css\"></head><body>\n\
         <a class=\"skip\" href=\"#text\">To the text</a>\n<header><a href=\"{up}index.html\">stereopsis</a> \
         <a class=\"to-contents\" href=\"#contents\">Contents</a></header>\n<div class=\"book\"><main \
         id=\"text\">\n{body}</main>\n<nav id=\"contents\" aria-label=\"Contents\">{contents}</nav></div>\n\
         </body></html>\n",
        escape(title)
    )
}

/// The contents, with the sections of the chapter that one is in.
fn contents(chapters: &[Html], here: Option<usize>, up: &str) -> String {
    let mut html = String::new();
    let mut part = "";
    for (place, (chapter, made)) in CHAPTERS.iter().zip(chapters).enumerate() {
        if chapter.part != part {
            let end = if part.is_empty() { "" } else { "</ol>" };
            part = chapter.part;
            let _ = write!(html, "{end}<p>{}</p>\n<ol>", escape(part));
        }
        let is_here = here == Some(place);
        let current = if is_here { " aria-current=\"page\"" } else { "" };
        let _ = write!(html, "<li><a href=\"{up}{}\"{current}>{}</a>", chapter.page(), escape(&made.title));
        if is_here && !made.sections.is_empty() {
            let item =
                |(id, text): &(String, String)| format!("<li><a href=\"#{id}\">{}</a></li>", escape(text));
            let _ = write!(html, "<ul>{}</ul>", made.sections.iter().map(item).collect::<String>());
        }
        html.push_str("</li>\n");
    }
    html + "</ol>"
}

/// The page of a chapter.
pub fn chapter(chapters: &[Html], place: usize) -> String {
    let made = &chapters[place];
    let neighbour = |place: Option<usize>, rel: &str, word: &str| {
        let found = place.and_then(|place| CHAPTERS.get(place).zip(chapters.get(place)));
        found.map_or_else(
            || "<span></span>".to_owned(),
            |(chapter, made)| {
                let (page, title) = (chapter.page(), escape(&made.title));
                format!("<a rel=\"{rel}\" href=\"{page}\"><small>{word}</small>{title}</a>")
            },
        )
    };
    let turn = format!(
        "<nav class=\"turn\" aria-label=\"Chapters beside this one\">{}{}</nav>\n",
        neighbour(place.checked_sub(1), "prev", "before"),
        neighbour(Some(place + 1), "next", "next")
    );
    page(&made.title, "", &(made.body.clone() + &turn), &contents(chapters, Some(place), ""))
}

/// The first page.
pub fn cover(chapters: &[Html]) -> String {
    let mut body = format!("<h1>stereopsis</h1>\n<p>{}</p>\n", escape(ABOUT));
    let mut part = "";
    for (chapter, made) in CHAPTERS.iter().zip(chapters) {
        if chapter.part != part {
            let end = if part.is_empty() { "" } else { "</dl>" };
            part = chapter.part;
            let _ = write!(body, "{end}<h2>{}</h2>\n<dl>", escape(part));
        }
        let _ = writeln!(
            body,
            "<dt><a href=\"{}\">{}</a></dt><dd>{}</dd>",
            chapter.page(),
            escape(&made.title),
            escape(chapter.summary)
        );
    }
    page("The book", "", &(body + "</dl>\n"), &contents(chapters, None, ""))
}

/// The page of a source file, with an anchor for each line.
pub fn source(path: &str, text: &str, chapters: &[Html]) -> String {
    let lines: String = text
        .lines()
        .zip(1..)
        .map(|(line, number)| format!("<span id=\"L{number}\">{}\n</span>", escape(line)))
        .collect();
    let body = format!("<h1>{}</h1>\n<pre class=\"source\"><code>{lines}</code></pre>\n", escape(path));
    page(path, "../", &body, &contents(chapters, None, "../"))
}
