//! Elements of the page, with every text and attribute escaped by construction.
//!
//! The tree is the `svg` crate's, which escapes what it prints; HTML is written as well-formed XML,
//! so that both kinds of parser read the page. Limit: an element without children is printed
//! self-closed, so only void elements (`br`, `meta`, `img`) may be empty.

use svg::Node;
use svg::node::element::Element;
use svg::node::{Blob, Text};

/// An element under construction.
#[derive(Debug, Clone)]
pub(super) struct Tag(Element);

/// An element without attributes.
pub(super) fn tag(name: &str) -> Tag {
    Tag(Element::new(name))
}

impl Tag {
    /// With an attribute.
    pub(super) fn with(mut self, name: &str, value: &str) -> Self {
        self.0.assign(name, value);
        self
    }

    /// With a class.
    pub(super) fn class(self, name: &str) -> Self {
        self.with("class", name)
    }

    /// With running text at its end.
    pub(super) fn text(mut self, words: impl AsRef<str>) -> Self {
        self.0.append(Text::new(printable(words.as_ref())));
        self
    }

    /// With markup of the program's own at its end, not escaped: never what a user wrote.
    pub(super) fn verbatim(mut self, markup: &str) -> Self {
        self.0.append(Blob::new(markup));
        self
    }

    /// With an element at its end.
    pub(super) fn child(mut self, child: impl Into<Box<dyn Node>>) -> Self {
        self.0.append(child);
        self
    }

    /// With elements at its end.
    pub(super) fn children(self, children: impl IntoIterator<Item = Tag>) -> Self {
        children.into_iter().fold(self, Self::child)
    }
}

impl From<Tag> for Box<dyn Node> {
    fn from(tag: Tag) -> Self {
        tag.0.into()
    }
}

impl std::fmt::Display for Tag {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(formatter)
    }
}

/// XML has no control characters, not even escaped ones.
pub(super) fn printable(text: &str) -> String {
    let allowed = |c: char| !c.is_control() && c != '\u{fffe}' && c != '\u{ffff}';
    text.chars().map(|c| if allowed(c) { c } else { ' ' }).collect()
}

/// A number with fixed decimals and a true minus sign; what rounds to zero has none.
pub(super) fn shown(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text,
    }
}

/// A number that may be unknown: a dash then.
pub(super) fn shown_or_dash(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "\u{2013}".to_owned(), |value| shown(value, decimals))
}

/// A coordinate of a picture: two decimals, no more than needed.
pub(super) fn coordinate(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_attributes_are_escaped() {
        let page = tag("p").with("title", "a\"<'&").text("<script>\u{1}&amp;").to_string();
        let parsed = roxmltree::Document::parse(&page).unwrap();
        assert_eq!(parsed.root_element().attribute("title"), Some("a\"<'&"));
        assert_eq!(parsed.root_element().text(), Some("<script> &amp;"));
        assert!(!page.contains("<script"));
    }

    #[test]
    fn numbers_have_one_zero_and_a_true_minus() {
        assert_eq!(shown(-0.04, 1), "0.0");
        assert_eq!(shown(-1.25, 1), "\u{2212}1.2");
        assert_eq!(shown_or_dash(None, 1), "\u{2013}");
        assert_eq!(coordinate(-0.001), "0");
        assert_eq!(coordinate(12.5), "12.5");
        assert_eq!(coordinate(100.0), "100");
    }
}
