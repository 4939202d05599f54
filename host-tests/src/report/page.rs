//! Pieces of HTML.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::imageops::{FilterType, resize};
use image::{ImageFormat, RgbImage};
use std::borrow::Cow;
use std::io::{self, Cursor};

/// Pictures in the page have at most this many columns: a page of large images would take minutes to open.
const MOST_COLUMNS: u32 = 1280;

/// What the pixels of a picture mean when it is made smaller.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Brightness: neighbours are averaged.
    Photograph,
    /// A value in false colours: averages would be colours of other values.
    Map,
}

/// Text with the characters that HTML reads as its own written out.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c => out.push(c),
        }
    }
    out
}

/// A picture as large as one in the page may be.
pub(super) fn fitted(kind: Kind, picture: &RgbImage) -> Cow<'_, RgbImage> {
    if picture.width() <= MOST_COLUMNS {
        return Cow::Borrowed(picture);
    }
    let rows = u64::from(picture.height()) * u64::from(MOST_COLUMNS) / u64::from(picture.width());
    let filter = if kind == Kind::Photograph { FilterType::Triangle } else { FilterType::Nearest };
    Cow::Owned(resize(picture, MOST_COLUMNS, rows.max(1) as u32, filter))
}

/// A picture as an address that holds it.
pub(super) fn png_url(picture: &RgbImage) -> io::Result<String> {
    let mut png = Cursor::new(Vec::new());
    picture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(png.into_inner())))
}

/// A picture inside the page, with a heading; `below` is HTML.
pub(super) fn figure(title: &str, kind: Kind, picture: &RgbImage, below: &str) -> io::Result<String> {
    let picture = fitted(kind, picture);
    let (url, id) = (png_url(&picture)?, escape(&title.to_lowercase().replace(' ', "-")));
    let (title, (width, height)) = (escape(title), picture.dimensions());
    Ok(format!(
        "<figure><h3>{title}</h3><img id=\"{id}\" width=\"{width}\" height=\"{height}\" \
         alt=\"{title}\" src=\"{url}\">{below}</figure>\n"
    ))
}

/// A caption; the text is escaped.
pub(super) fn caption(text: &str) -> String {
    format!("<figcaption>{}</figcaption>", escape(text))
}

/// Two columns: names and values, both escaped.
pub(super) fn table(rows: &[(String, String)]) -> String {
    let rows: String = rows
        .iter()
        .map(|(name, value)| format!("<tr><th>{}</th><td>{}</td></tr>\n", escape(name), escape(value)))
        .collect();
    format!("<table>{rows}</table>")
}

#[cfg(test)]
mod tests {
    use super::escape;

    #[test]
    fn a_file_name_is_no_markup() {
        assert_eq!(escape("<img src=\"a&b's\">"), "&lt;img src=&quot;a&amp;b&#39;s&quot;&gt;");
    }
}
