//! No link of the book leads nowhere, no picture is missing, and nothing is asked for from elsewhere.

use crate::steps::{Failure, Outcome};
use std::collections::{BTreeMap, BTreeSet};

/// The values of an attribute in a page; those in its text are written out and do not count.
fn values<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    let begin = format!(" {attribute}=\"");
    page.split(&begin).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// The pages that have links of the book: what a command wrote is its own.
fn is_page(name: &str) -> bool {
    name.ends_with(".html") && !name.starts_with("pictures/")
}

/// A path in the folder of a page, without `..`.
fn beside(page: &str, link: &str) -> String {
    let mut parts: Vec<_> = page.split('/').collect();
    parts.pop();
    for part in link.split('/') {
        match part {
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// Fails with the first link that leads nowhere.
pub fn links(files: &BTreeMap<String, Vec<u8>>) -> Outcome {
    let texts: BTreeMap<_, _> = files
        .iter()
        .filter(|(name, _)| is_page(name))
        .map(|(name, bytes)| (name.as_str(), String::from_utf8_lossy(bytes).into_owned()))
        .collect();
    let ids: BTreeMap<_, _> = texts.iter().map(|(name, text)| (*name, values(text, "id"))).collect();
    for (name, text) in &texts {
        let wrong = |what: String| Err(Failure::new(format!("the book's page {name}: {what}")));
        if let Some(twice) =
            ids[name].iter().find(|id| ids[name].iter().filter(|other| other == id).count() > 1)
        {
            return wrong(format!("the id {twice} stands there twice"));
        }
        for source in values(text, "src") {
            if !files.contains_key(&beside(name, source)) {
                return wrong(format!("there is no picture {source}"));
            }
        }
        for link in values(text, "href") {
            if link.starts_with("https://") {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { (*name).to_owned() } else { beside(name, file) };
            if !files.contains_key(&target) {
                return wrong(format!("the link {link} leads nowhere"));
            }
            let has = ids.get(target.as_str()).is_some_and(|ids| ids.contains(&heading));
            if !heading.is_empty() && !has {
                return wrong(format!("the link {link} names no heading of {target}"));
            }
        }
    }
    let linked: BTreeSet<_> = texts
        .iter()
        .flat_map(|(name, text)| values(text, "href").into_iter().map(|link| beside(name, link)))
        .collect();
    match texts.keys().find(|name| !linked.iter().any(|link| link.split('#').next() == Some(name))) {
        Some(alone) => Err(Failure::new(format!("no link of the book leads to {alone}"))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(pages: &[(&str, &str)]) -> String {
        let files = pages.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec())).collect();
        links(&files).map_or_else(|failure| failure.to_string(), |()| String::new())
    }

    #[test]
    fn what_leads_nowhere_is_named() {
        let home = ("index.html", "<a href=\"a.html#b\">a</a> <a href=\"index.html\">i</a>");
        let right = ("a.html", "<h2 id=\"b\">b</h2> <a href=\"#b\">b</a> <img src=\"p/x.png\">");
        assert_eq!(said(&[home, right, ("p/x.png", "")]), "");
        assert!(said(&[home, right]).contains("there is no picture p/x.png"));
        assert!(said(&[home, ("a.html", "")]).contains("a.html#b names no heading of a.html"));
        assert!(said(&[home]).contains("the link a.html#b leads nowhere"));
        assert!(said(&[home, ("a.html", "<p id=\"b\"><p id=\"b\">")]).contains("b stands there twice"));
        assert!(said(&[("index.html", "<a href=\"http://x/\">")]).contains("leads nowhere"));
        assert!(
            said(&[home, right, ("p/x.png", ""), ("s/c.html", "")])
                .contains("no link of the book leads to s/c.html")
        );
        assert_eq!(beside("s/c.html", "../a.html"), "a.html");
    }
}
