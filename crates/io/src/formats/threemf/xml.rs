//! Elements and attributes as their text has them.

use crate::flaw::Flaw;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::ops::Range;

/// The flaw of a part whose text is no XML at a byte.
pub(super) fn not_xml(part: &str, text: &str, at: usize, why: &quick_xml::Error) -> Flaw {
    Flaw::saying(part, format!("the text is not well-formed XML: {why}")).at(text, at)
}

/// Where a piece of a text begins in it.
fn offset(piece: &str, text: &str) -> usize {
    (piece.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize)
}

/// A tag that opens an element, as parts of the text.
pub(super) struct Element<'a> {
    /// Where it begins.
    pub(super) at: usize,
    /// Its name with its prefix.
    pub(super) name: &'a str,
    /// Its name without.
    pub(super) local: &'a str,
    /// The text after the name.
    pub(super) attributes: &'a str,
}

impl<'a> Element<'a> {
    /// Of a tag that was read from the `text` of a part, where it begins at a byte.
    ///
    /// # Errors
    /// The tag is not a piece of this text.
    pub(super) fn new(
        tag: &BytesStart<'_>,
        part: &str,
        text: &'a str,
        at: usize,
    ) -> Result<Self, Flaw> {
        let content: &str = tag;
        let start = offset(content, text);
        let whole = text.get(start..start.wrapping_add(content.len()));
        let pieces = whole.and_then(|whole| whole.split_at_checked(tag.name().as_ref().len()));
        debug_assert!(pieces.is_some(), "the tag borrows from the text");
        let (name, attributes) = pieces.ok_or_else(|| {
            Flaw::saying(part, "the reader gave a tag that is not in the text").at(text, at)
        })?;
        let local = name.rsplit_once(':').map_or(name, |(_, local)| local);
        Ok(Self {
            at,
            name,
            local,
            attributes,
        })
    }

    /// An attribute by its whole name.
    pub(super) fn attribute(&self, name: &str) -> Option<&'a str> {
        let found = attributes(self.attributes).find(|own| own.name == name);
        found.map(|own| own.value)
    }

    /// The prefix of its name with the colon.
    pub(super) fn prefix(&self) -> &'a str {
        &self.name[..self.name.len() - self.local.len()]
    }

    /// An attribute by its name without a prefix.
    pub(super) fn local_attribute(&self, local: &str) -> Option<&'a str> {
        let is_own = |name: &str| name.rsplit_once(':').map_or(name, |(_, own)| own) == local;
        let found = attributes(self.attributes).find(|own| is_own(own.name));
        found.map(|own| own.value)
    }

    /// Where the text has the attributes.
    pub(super) fn attributes_at(&self, text: &str) -> Range<u32> {
        let start = offset(self.attributes, text);
        // Texts are below 4 GiB.
        start as u32..(start + self.attributes.len()) as u32
    }
}

/// An attribute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Attribute<'a> {
    /// Its name with its prefix.
    pub(super) name: &'a str,
    /// Its value as it is written.
    pub(super) value: &'a str,
    /// All of it, from the name to the last quote.
    pub(super) text: &'a str,
}

/// The attributes in the rest of a tag; what is no attribute ends them.
pub(super) fn attributes(text: &str) -> impl Iterator<Item = Attribute<'_>> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let start = rest.trim_ascii_start();
        let (name, after) = start.split_once('=')?;
        let name = name.trim_ascii_end();
        if name.contains(|c: char| c.is_whitespace() || "\"'<>&/".contains(c)) {
            return None;
        }
        let after = after.trim_ascii_start();
        let quote = after.chars().next().filter(|&c| c == '"' || c == '\'')?;
        let (value, after) = after[1..].split_once(quote)?;
        rest = after;
        Some(Attribute {
            name,
            value,
            text: &start[..start.len() - after.len()],
        })
    })
}

/// The elements of a part's text, in the order in which they begin.
pub(super) fn elements<'a>(
    part: &'a str,
    text: &'a str,
) -> impl Iterator<Item = Result<Element<'a>, Flaw>> {
    let mut reader = Reader::from_str(text);
    std::iter::from_fn(move || {
        loop {
            let at = reader.buffer_position() as usize;
            match reader.read_event() {
                Ok(Event::Start(tag) | Event::Empty(tag)) => {
                    return Some(Element::new(&tag, part, text, at));
                }
                Ok(Event::Eof) => return None,
                Ok(_) => {}
                Err(why) => return Some(Err(not_xml(part, text, at, &why))),
            }
        }
    })
}

/// A number in the value of an attribute, and where the text has the value.
pub(super) struct Number {
    pub(super) value: u32,
    pub(super) at: Range<usize>,
}

impl Number {
    pub(super) fn of(element: &Element<'_>, name: &str, text: &str) -> Option<Self> {
        let own = element.attribute(name)?;
        let start = offset(own, text);
        Some(Self {
            value: own.parse().ok()?,
            at: start..start + own.len(),
        })
    }
}

/// A value with its references replaced, as people read it; as it is if they cannot be.
pub(super) fn plain(value: &str) -> String {
    quick_xml::escape::unescape(value).map_or_else(|_| value.to_owned(), |text| text.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_are_read_as_they_are() {
        let text = " v1=\"0\"\n\tp:UUID = 'a \"b\"' x=\"&lt;\" /";
        let all: Vec<Attribute<'_>> = attributes(text).collect();
        let own = |name, value, text| Attribute { name, value, text };
        assert_eq!(all[0], own("v1", "0", "v1=\"0\""));
        assert_eq!(all[1], own("p:UUID", "a \"b\"", "p:UUID = 'a \"b\"'"));
        assert_eq!((all.len(), plain(all[2].value).as_str()), (3, "<"));
        assert_eq!(attributes(" v1= v2='3'").count(), 0);
        assert_eq!(attributes(" a\"b='1' c='2'").count(), 0);
    }
}
