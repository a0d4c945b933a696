//! The elements of an SVG document.

use super::{PdfError, not_ours};

/// What stands in an element.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Node {
    Element(Element),
    Text(String),
}

/// An element with its attributes and what stands in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Element {
    pub(super) name: String,
    attributes: Vec<(String, String)>,
    pub(super) inside: Vec<Node>,
}

impl Element {
    /// The root of a document.
    pub(super) fn document(text: &str) -> Result<Self, PdfError> {
        let mut open = vec![Self::default()];
        let mut rest = text.trim();
        while !rest.is_empty() {
            let (before, tag) = rest.split_once('<').unwrap_or((rest, ""));
            if let Some(parent) = open.last_mut().filter(|_| !before.is_empty()) {
                parent.inside.push(Node::Text(unescaped(before)));
            }
            if tag.is_empty() {
                break;
            }
            // Values are escaped: no tag holds another bracket.
            let (tag, after) = tag.split_once('>').ok_or_else(|| not_ours("a tag has no end"))?;
            rest = after;
            if tag.starts_with('/') {
                let closed = open.pop().unwrap_or_default();
                let parent = open.last_mut().ok_or_else(|| not_ours("an element ends twice"))?;
                parent.inside.push(Node::Element(closed));
                continue;
            }
            let (tag, closed) = tag.strip_suffix('/').map_or((tag, false), |tag| (tag, true));
            let element = Self::of_tag(tag)?;
            match open.last_mut() {
                Some(parent) if closed => parent.inside.push(Node::Element(element)),
                _ => open.push(element),
            }
        }
        let mut elements = open.swap_remove(0).inside.into_iter().filter_map(|node| match node {
            Node::Element(element) => Some(element),
            Node::Text(_) => None,
        });
        match (open.len(), elements.next()) {
            (0, Some(root)) if root.name == "svg" => Ok(root),
            _ => Err(not_ours("it is no whole svg element")),
        }
    }

    fn of_tag(tag: &str) -> Result<Self, PdfError> {
        let (name, mut rest) = tag.split_once(char::is_whitespace).unwrap_or((tag, ""));
        let mut attributes = Vec::new();
        loop {
            rest = rest.trim_start();
            if rest.is_empty() {
                return Ok(Self { name: name.to_owned(), attributes, inside: Vec::new() });
            }
            let wrong = || not_ours(format!("attributes of {name}"));
            let (key, after) = rest.split_once("=\"").ok_or_else(wrong)?;
            let (value, after) = after.split_once('"').ok_or_else(wrong)?;
            attributes.push((key.to_owned(), unescaped(value)));
            rest = after;
        }
    }

    pub(super) fn elements(&self) -> impl Iterator<Item = &Self> {
        self.inside.iter().filter_map(|node| match node {
            Node::Element(element) => Some(element),
            Node::Text(_) => None,
        })
    }

    /// An attribute, if it is given.
    pub(super) fn given(&self, key: &str) -> Option<&str> {
        self.attributes.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    pub(super) fn attribute(&self, key: &str) -> Result<&str, PdfError> {
        self.given(key).ok_or_else(|| not_ours(format!("{} without {key}", self.name)))
    }

    pub(super) fn number(&self, key: &str) -> Result<f64, PdfError> {
        self.number_or(key, f64::NAN).and_then(|number| {
            if number.is_finite() { Ok(number) } else { Err(not_ours(format!("{} without {key}", self.name))) }
        })
    }

    /// A number, or what it is if it isn't given.
    pub(super) fn number_or(&self, key: &str, default: f64) -> Result<f64, PdfError> {
        let Some(text) = self.given(key) else { return Ok(default) };
        text.parse().map_err(|_| not_ours(format!("{key} = {text}")))
    }

    /// Numbers between blanks.
    pub(super) fn numbers(&self, key: &str) -> Result<Vec<f64>, PdfError> {
        let text = self.attribute(key)?;
        let numbers = text.split_whitespace().map(str::parse);
        numbers.collect::<Result<_, _>>().map_err(|_| not_ours(format!("{key} = {text}")))
    }

    /// The text of the title.
    pub(super) fn title(&self) -> String {
        let title = self.elements().find(|element| element.name == "title");
        title.map(Self::text).unwrap_or_default()
    }

    fn text(&self) -> String {
        let text = |node: &Node| match node {
            Node::Text(text) => text.clone(),
            Node::Element(element) => element.text(),
        };
        self.inside.iter().map(text).collect()
    }
}

/// A text without the entities of [`escaped`](crate::escaped).
fn unescaped(text: &str) -> String {
    let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#39;", "'"), ("&apos;", "'"), ("&amp;", "&")];
    entities.iter().fold(text.to_owned(), |text, (entity, sign)| text.replace(entity, sign))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_are_read_with_what_is_escaped() {
        let root =
            Element::document("<svg a=\"1\"><g b=\"x &amp;lt;\"/><text>a&lt;b <tspan>2</tspan> c</text></svg>\n")
                .unwrap();
        let [g, text] = root.elements().collect::<Vec<_>>()[..] else { panic!("{root:?}") };
        assert_eq!((g.given("b"), g.given("c")), (Some("x &lt;"), None));
        assert_eq!((text.text(), text.inside.len()), ("a<b 2 c".to_owned(), 3));
        for wrong in
            ["", "text", "<svg>", "<svg></svg></svg>", "<p></p>", "<svg a=1></svg>", "<svg", "<svg a=\"></svg>"]
        {
            assert!(Element::document(wrong).is_err(), "{wrong}");
        }
    }
}
