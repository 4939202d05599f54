//! YAML, JSON and XML as one kind of tree.

use super::Fault;
use crate::limits::DEPTH;
use serde_json::{Map, Value};

/// A document.
pub(super) type Tree = Value;

/// The documents of a file: several in YAML, one in JSON and XML; or why it has none.
pub(super) fn read(text: &str) -> Result<Vec<Tree>, String> {
    let text = text.trim_start();
    if text.starts_with('<') {
        // The parser calls itself for each element in another.
        if depth(text) > DEPTH {
            return Err(format!("elements are nested more than {DEPTH} deep"));
        }
        let document = roxmltree::Document::parse(text).map_err(|e| e.to_string())?;
        return Ok(vec![element(document.root_element())]);
    }
    // OpenCV's first line is no directive of YAML, and its tags say no more than the keys under them.
    let body = match text.split_once('\n') {
        Some((first, rest)) if first.starts_with("%YAML") => rest,
        _ => text,
    };
    let body = body.replace("!!opencv-matrix", "");
    serde_saphyr::from_multiple(&body).map_err(|e| {
        // The first line says it; the others show the place.
        let text = e.to_string();
        text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned()
    })
}

/// How deep elements of XML are nested; at least that of what is none.
fn depth(text: &str) -> usize {
    let (mut depth, mut most) = (0_usize, 0);
    let mut rest = text;
    while let Some((_, tag)) = rest.split_once('<') {
        let verbatim = [("!--", "-->"), ("![CDATA[", "]]>"), ("?", "?>")];
        if let Some((_, end)) = verbatim.iter().find(|(begin, _)| tag.starts_with(begin)) {
            rest = tag.split_once(end).map_or("", |(_, rest)| rest);
            continue;
        }
        // A value may hold what ends a tag.
        let mut quote = None;
        let end = tag.find(|c| match quote {
            Some(open) => {
                if c == open {
                    quote = None;
                }
                false
            }
            None => {
                quote = Some(c).filter(|c| matches!(c, '"' | '\''));
                c == '>'
            }
        });
        let (tag, behind) = tag.split_at(end.unwrap_or(tag.len()));
        rest = behind;
        if tag.starts_with('/') {
            depth = depth.saturating_sub(1);
        } else if !tag.starts_with('!') && !tag.ends_with('/') {
            depth += 1;
            most = most.max(depth);
        }
    }
    most
}

/// An element of OpenCV's XML: its elements by name, or its text as numbers.
fn element(node: roxmltree::Node<'_, '_>) -> Value {
    let children: Map<_, _> = node
        .children()
        .filter(roxmltree::Node::is_element)
        .map(|child| (child.tag_name().name().to_owned(), element(child)))
        .collect();
    if !children.is_empty() {
        return Value::Object(children);
    }
    let words = node.text().unwrap_or("").split_ascii_whitespace();
    Value::Array(words.map(|word| Value::String(word.to_owned())).collect())
}

/// The value of a key.
pub(super) fn need<'a>(tree: &'a Tree, key: &str, form: &'static str) -> Result<&'a Value, Fault> {
    tree.get(key).ok_or_else(|| Fault::Missing(key.into(), form))
}

/// `N` finite numbers, in a list of any depth or in `data`.
pub(super) fn numbers<const N: usize>(key: &str, value: &Value) -> Result<[f64; N], Fault> {
    let all = list(key, value)?;
    let problem = || format!("has {} numbers; {N} are needed", all.len());
    all.as_slice().try_into().map_err(|_| Fault::Key { key: key.into(), problem: problem() })
}

/// The finite numbers of a list of any depth or of `data`.
pub(super) fn list(key: &str, value: &Value) -> Result<Vec<f64>, Fault> {
    let value = value.get("data").unwrap_or(value);
    let mut found = Vec::new();
    gather(key, value, &mut found)?;
    Ok(found)
}

fn gather(key: &str, value: &Value, found: &mut Vec<f64>) -> Result<(), Fault> {
    let fault = |problem: String| Fault::Key { key: key.into(), problem };
    let number = match value {
        Value::Array(values) => return values.iter().try_for_each(|value| gather(key, value, found)),
        Value::Number(number) => number.as_f64().unwrap_or(f64::NAN),
        // What is not a number of JSON.
        Value::Null => f64::NAN,
        Value::String(word) => {
            let plain = word.trim_start_matches(['.', '-', '+']).to_ascii_lowercase();
            let is_endless = plain == "nan" || plain == "inf";
            let number = if is_endless { Some(f64::NAN) } else { word.parse().ok() };
            number.ok_or_else(|| fault(format!("'{word}' is not a number")))?
        }
        other => return Err(fault(format!("'{other}' is not a number"))),
    };
    if !number.is_finite() {
        return Err(fault("a number is not finite; finite numbers are needed".into()));
    }
    found.push(number);
    Ok(())
}

/// Two whole numbers: an image's columns and rows.
pub(super) fn size(key: &str, value: &Value) -> Result<[u64; 2], Fault> {
    let [width, height] = numbers(key, value)?;
    let is_one = |side: f64| side.fract() == 0.0 && (1.0..=65535.0).contains(&side);
    if !is_one(width) || !is_one(height) {
        let problem = format!("{width} x {height} is no size of an image");
        return Err(Fault::Key { key: key.into(), problem });
    }
    Ok([width as u64, height as u64])
}
