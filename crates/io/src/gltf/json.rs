//! Looking into a JSON document with a finger on the place, so that every complaint can name it.

use super::flaw::{GltfFlaw, Result};
use serde_json::Value;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub(super) struct At<'a> {
    value: &'a Value,
    place: String,
}

impl std::fmt::Display for At<'_> {
    /// The value as JSON.
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.value.fmt(out)
    }
}

/// The longest piece of a value that a message holds.
const LONGEST: usize = 40;

impl<'a> At<'a> {
    /// The whole document.
    pub(super) fn root(value: &'a Value) -> Self {
        Self {
            value,
            place: String::new(),
        }
    }

    /// Where this stands.
    pub(super) fn place(&self) -> &str {
        if self.place.is_empty() {
            "the document"
        } else {
            &self.place
        }
    }

    /// A member of an object; `None` where there is none.
    pub(super) fn get(&self, key: &str) -> Option<Self> {
        let value = self.value.get(key)?;
        let dot = if self.place.is_empty() { "" } else { "." };
        Some(Self {
            value,
            place: format!("{}{dot}{key}", self.place),
        })
    }

    /// A member that has to be there.
    pub(super) fn require(&self, key: &str) -> Result<Self> {
        self.get(key)
            .ok_or_else(|| GltfFlaw::saying(self.place(), format!("'{key}' is missing")))
    }

    /// A value on the way through objects; `None` where the way ends.
    pub(super) fn path(&self, keys: &[&str]) -> Option<Self> {
        keys.iter().try_fold(self.clone(), |at, key| at.get(key))
    }

    /// The members of an object.
    pub(super) fn members(&self) -> Result<impl Iterator<Item = (&'a str, Self)> + use<'a>> {
        let Value::Object(map) = self.value else {
            return Err(self.unexpected("an object"));
        };
        let place = self.place.clone();
        Ok(map.iter().map(move |(key, value)| {
            (
                key.as_str(),
                Self {
                    value,
                    place: format!("{place}.{key}"),
                },
            )
        }))
    }

    /// The items of an array.
    pub(super) fn items(&self) -> Result<impl ExactSizeIterator<Item = Self> + use<'a>> {
        let Value::Array(items) = self.value else {
            return Err(self.unexpected("an array"));
        };
        let place = self.place.clone();
        Ok(items.iter().enumerate().map(move |(i, value)| Self {
            value,
            place: format!("{place}[{i}]"),
        }))
    }

    /// An item of an array; `None` where there is none.
    pub(super) fn item(&self, index: usize) -> Option<Self> {
        Some(Self {
            value: self.value.get(index)?,
            place: format!("{}[{index}]", self.place),
        })
    }

    /// The items of an array that may be missing.
    pub(super) fn list(&self, key: &str) -> Result<Vec<Self>> {
        self.get(key)
            .map_or_else(|| Ok(Vec::new()), |at| Ok(at.items()?.collect()))
    }

    /// An item of one of the document's arrays, which this value names by its index.
    pub(super) fn item_of(&self, root: &At<'a>, array: &str) -> Result<(usize, Self)> {
        let index = self.count()?;
        let list = root.get(array);
        let items = list.as_ref().and_then(|list| list.value.as_array());
        match items.and_then(|items| items.get(index)) {
            Some(value) => Ok((
                index,
                Self {
                    value,
                    place: format!("{array}[{index}]"),
                },
            )),
            None => Err(GltfFlaw::new(
                self.place(),
                index.to_string(),
                format!(
                    "an index below {} (the number of {array})",
                    items.map_or(0, Vec::len)
                ),
            )),
        }
    }

    /// A whole number from 0.
    pub(super) fn count(&self) -> Result<usize> {
        // Some writers give whole numbers a point.
        let whole = self.value.as_u64().or_else(|| {
            self.value
                .as_f64()
                .filter(|x| x.fract() == 0.0 && (0.0..9e15).contains(x))
                .map(|x| x as u64)
        });
        whole
            .and_then(|count| usize::try_from(count).ok())
            .ok_or_else(|| self.unexpected("a whole number from 0"))
    }

    /// [`Self::count`] of a member that may be missing.
    pub(super) fn count_or(&self, key: &str, otherwise: usize) -> Result<usize> {
        self.get(key).map_or(Ok(otherwise), |at| at.count())
    }

    /// A number.
    pub(super) fn number(&self) -> Result<f64> {
        self.value
            .as_f64()
            .filter(|x| x.is_finite())
            .ok_or_else(|| self.unexpected("a number"))
    }

    /// As many numbers as asked for.
    pub(super) fn numbers<const N: usize>(&self) -> Result<[f64; N]> {
        let numbers = self
            .items()?
            .map(|at| at.number())
            .collect::<Result<Vec<f64>>>()?;
        numbers
            .try_into()
            .map_err(|_| self.unexpected(format!("{N} numbers")))
    }

    /// A text.
    pub(super) fn text(&self) -> Result<&'a str> {
        self.value.as_str().ok_or_else(|| self.unexpected("a text"))
    }

    /// True or false; false where the member is missing.
    pub(super) fn flag(&self, key: &str) -> Result<bool> {
        let Some(at) = self.get(key) else {
            return Ok(false);
        };
        at.value
            .as_bool()
            .ok_or_else(|| at.unexpected("true or false"))
    }

    /// The value's `name`, if it has one.
    pub(super) fn name(&self) -> Option<&'a str> {
        self.value.get("name").and_then(Value::as_str)
    }

    /// A flaw here.
    pub(super) fn unexpected(&self, expected: impl AsRef<str>) -> GltfFlaw {
        let found = match self.value {
            Value::Array(items) => format!("an array of {}", items.len()),
            Value::Object(_) => "an object".to_owned(),
            other => shortened(&other.to_string()),
        };
        GltfFlaw::new(self.place(), found, expected)
    }
}

/// A text as it may stand in a message.
pub(super) fn shortened(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}
