//! Elements and attributes as their text has them.

use quick_xml::events::BytesStart;
use std::ops::Range;

/// A tag, as parts of the text.
pub(super) struct Element<'a> {
    /// Its name with its prefix.
    pub(super) name: &'a str,
    /// Its name without.
    pub(super) local: &'a str,
    /// What follows the name.
    pub(super) attributes: &'a str,
}

impl<'a> Element<'a> {
    /// Of a tag that was read from `text`.
    pub(super) fn new(tag: &BytesStart<'_>, text: &'a str) -> Self {
        let content: &str = tag;
        // What was read from a text borrows from it.
        let start = (content.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize);
        let whole = text
            .get(start..start.wrapping_add(content.len()))
            .unwrap_or_default();
        let (name, attributes) = whole.split_at(tag.name().as_ref().len().min(whole.len()));
        let local = name.rsplit_once(':').map_or(name, |(_, local)| local);
        Self {
            name,
            local,
            attributes,
        }
    }

    /// The prefix of its name with the colon.
    pub(super) fn prefix(&self) -> &'a str {
        &self.name[..self.name.len() - self.local.len()]
    }

    /// An attribute by its name without a prefix.
    pub(super) fn local_attribute(&self, local: &str) -> Option<&'a str> {
        let is_own = |name: &str| name.rsplit_once(':').map_or(name, |(_, own)| own) == local;
        attributes(self.attributes)
            .find(|own| is_own(own.name))
            .map(|own| own.value)
    }

    /// Where the text has the attributes.
    pub(super) fn attributes_at(&self, text: &str) -> Range<u32> {
        let start = (self.attributes.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize);
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

/// The value of an attribute by its whole name.
pub(super) fn attribute<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    attributes(text)
        .find(|own| own.name == name)
        .map(|own| own.value)
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
        assert_eq!(attribute(text, "x"), Some("&lt;"));
    }
}
