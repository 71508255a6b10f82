//! Editing JSON text in place: what is not changed stays as it was written, to the byte.
//!
//! Values are found by their place in the text; new text goes between the bytes that stay. An object of which members
//! are taken or added is put together from its members' own texts.

use crate::flaw::{Flaw, Result};
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;
use std::fmt;
use std::ops::Range;

/// Changes to a text.
pub(crate) struct Edits<'a> {
    text: &'a str,
    changes: Vec<(Range<usize>, String)>,
}

impl<'a> Edits<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        let changes = Vec::new();
        Self { text, changes }
    }

    /// The text of the whole document.
    pub(crate) fn document(&self) -> &'a str {
        self.text.trim_ascii()
    }

    /// Puts `new` in the place of `old`, which is a part of the text.
    pub(crate) fn replace(&mut self, old: &'a str, new: String) {
        let start = self.offset(old);
        self.changes.push((start..start + old.len(), new));
    }

    /// Adds items, JSON each, at the end of an array that is a part of the text.
    pub(crate) fn append(&mut self, array: &'a str, items: &[String]) -> Result<()> {
        let before = if items_of(array)?.is_empty() { "" } else { "," };
        let end = self.offset(array) + array.len() - 1;
        self.changes
            .push((end..end, format!("{before}{}", items.join(","))));
        Ok(())
    }

    /// Adds a member at the end of an object that is a part of the text.
    pub(crate) fn insert(&mut self, object: &'a str, key: &str, value: &str) -> Result<()> {
        let end = self.offset(object) + object.len() - 1;
        let before = if Members::of(object)?.0.is_empty() {
            ""
        } else {
            ","
        };
        self.changes
            .push((end..end, format!("{before}\"{key}\":{value}")));
        Ok(())
    }

    /// Leaves the first `count` items of an array, at least one, whose items' texts are these.
    pub(crate) fn truncate(&mut self, items: &[&'a str], count: usize) {
        let end = |item: &str| self.offset(item) + item.len();
        if let (Some(kept), Some(last)) = (items[..count].last(), items.last()) {
            self.changes.push((end(kept)..end(last), String::new()));
        }
    }

    /// Takes members out of an object that is a part of the text, each with the comma before it; from the first on, with the one after.
    pub(crate) fn remove(&mut self, object: &'a str, keys: &[&str]) -> Result<()> {
        let mut start = self.offset(object) + 1;
        let mut is_first = true;
        for (key, value) in &Members::of(object)?.0 {
            let end = self.offset(value) + value.len();
            if keys.contains(&&key[..]) {
                self.changes.push((start..end, String::new()));
            } else if std::mem::take(&mut is_first)
                && let Some(comma) = self.text[start..].find(|c: char| !c.is_ascii_whitespace())
                && self.text[start + comma..].starts_with(',')
            {
                self.changes
                    .push((start + comma..start + comma + 1, String::new()));
            }
            start = end;
        }
        Ok(())
    }

    /// The text with all changes. Additions at one place stand in the order in which they were made.
    pub(crate) fn apply(mut self) -> String {
        self.changes.sort_by_key(|(range, _)| range.start);
        let mut out = String::with_capacity(self.text.len() + 4096);
        let mut at = 0;
        for (range, new) in &self.changes {
            out.push_str(&self.text[at..range.start]);
            out.push_str(new);
            at = range.end;
        }
        out.push_str(&self.text[at..]);
        out
    }

    /// Where a part of the text begins.
    fn offset(&self, part: &str) -> usize {
        part.as_ptr() as usize - self.text.as_ptr() as usize
    }
}

/// The members of an object, in order, with the texts of their values.
pub(crate) struct Members<'a>(pub(crate) Vec<(String, &'a str)>);

impl<'a> Members<'a> {
    /// # Errors
    /// It is no object.
    pub(crate) fn of(text: &'a str) -> Result<Self> {
        serde_json::from_str(text).map_err(|error| broken(&error))
    }

    /// The text of a member's value. Of several with one key the last counts, as it does when the document is read.
    pub(crate) fn get(&self, key: &str) -> Option<&'a str> {
        let all = self.0.iter().rev().find(|(own, _)| own == key);
        all.map(|&(_, text)| text)
    }

    /// The texts of the items of an array; none where there is none.
    ///
    /// # Errors
    /// It is no array.
    pub(crate) fn items(&self, key: &str) -> Result<Vec<&'a str>> {
        self.get(key).map_or_else(|| Ok(Vec::new()), items_of)
    }

    /// The extensions without some of them; `None` where none is left.
    pub(crate) fn extensions_without(&self, names: &[&str]) -> Result<Option<String>> {
        let Some(text) = self.get("extensions") else {
            return Ok(None);
        };
        let own = Members::of(text)?;
        let changes: Vec<_> = names.iter().map(|&name| (name, None)).collect();
        let is_left = own.0.iter().any(|(key, _)| !names.contains(&&key[..]));
        Ok(is_left.then(|| own.with(&changes)))
    }

    /// An object in which members are replaced, or added at the end, or left out where there is `None`; all others stay.
    pub(crate) fn with(&self, changes: &[(&str, Option<String>)]) -> String {
        let change = |key: &str| changes.iter().find(|(own, _)| *own == key);
        let mut parts = Vec::new();
        for (key, text) in &self.0 {
            match change(key) {
                None => parts.push(format!("{}:{text}", quoted(key))),
                Some((_, Some(new))) => parts.push(format!("{}:{new}", quoted(key))),
                Some((_, None)) => {}
            }
        }
        for (key, new) in changes {
            if let Some(new) = new.as_ref().filter(|_| self.get(key).is_none()) {
                parts.push(format!("{}:{new}", quoted(key)));
            }
        }
        format!("{{{}}}", parts.join(","))
    }
}

impl<'de> Deserialize<'de> for Members<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Members<'de>;

            fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
                out.write_str("an object")
            }

            fn visit_map<A>(self, mut map: A) -> std::result::Result<Self::Value, A::Error>
            where
                A: MapAccess<'de>,
            {
                let mut members = Vec::new();
                while let Some((key, value)) = map.next_entry::<String, &'de RawValue>()? {
                    members.push((key, value.get()));
                }
                Ok(Members(members))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}

/// The texts of an array's items.
pub(crate) fn items_of(text: &str) -> Result<Vec<&str>> {
    let items: Vec<&RawValue> = serde_json::from_str(text).map_err(|error| broken(&error))?;
    Ok(items.into_iter().map(RawValue::get).collect())
}

/// A text as JSON.
pub(crate) fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn broken(error: &serde_json::Error) -> Flaw {
    Flaw::saying("the JSON text", format!("it cannot be edited: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_but_the_changes_stays() {
        let text =
            "{ \"a\" : [ 1.50 , {\"x\":1e+2} ],\n \"\\u0062\": {\"c\":\"\\/\",\"d\":[]}, \"e\":7 }";
        let members = Members::of(text).expect("members");
        assert_eq!(members.get("b"), Some("{\"c\":\"\\/\",\"d\":[]}"));
        let inner = Members::of(members.get("b").expect("b")).expect("members");
        let [a, d] = [(&members, "a"), (&inner, "d")].map(|(own, key)| own.get(key).expect(key));
        let mut edits = Edits::new(text);
        edits
            .append(a, &["3".into(), "4".into()])
            .expect("appended");
        edits.append(d, &["5".into()]).expect("appended");
        edits.replace(members.get("e").expect("e"), "8.0".into());
        edits.insert(text, "f", "[]").expect("inserted");
        assert_eq!(
            edits.apply(),
            "{ \"a\" : [ 1.50 , {\"x\":1e+2} ,3,4],\n \"\\u0062\": {\"c\":\"\\/\",\"d\":[5]}, \"e\":8.0 ,\"f\":[]}"
        );
        let mut edits = Edits::new(text);
        edits.truncate(&items_of(a).expect("items"), 1);
        assert_eq!(edits.apply(), text.replace(" , {\"x\":1e+2}", ""));
        for (keys, expected) in [
            (
                &["a"][..],
                text.replace(" \"a\" : [ 1.50 , {\"x\":1e+2} ],", ""),
            ),
            (&["e", "none"], text.replace(", \"e\":7", "")),
            (&["a", "b"], "{ \"e\":7 }".to_owned()),
            (&["a", "b", "e"], "{ }".to_owned()),
        ] {
            let mut edits = Edits::new(text);
            edits.remove(text, keys).expect("removed");
            assert_eq!(edits.apply(), expected);
        }
        let with = inner.with(&[("d", None), ("g", Some("1".into()))]);
        assert_eq!(with, "{\"c\":\"\\/\",\"g\":1}");
    }
}
