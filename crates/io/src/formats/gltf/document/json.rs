//! Looking into a JSON document with a finger on the place, so that every complaint can name it.

use crate::flaw::{Flaw, Result, shortened};
use serde_json::Value;
use std::fmt;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct At<'a> {
    value: &'a Value,
    place: String,
}

impl fmt::Display for At<'_> {
    /// The value as JSON.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(out)
    }
}

impl<'a> At<'a> {
    /// The whole document.
    pub(crate) fn root(value: &'a Value) -> Self {
        Self::new(value, String::new())
    }

    fn new(value: &'a Value, place: String) -> Self {
        Self { value, place }
    }

    /// Where this stands.
    pub(crate) fn place(&self) -> &str {
        if self.place.is_empty() {
            "the document"
        } else {
            &self.place
        }
    }

    /// A member of an object; `None` where there is none.
    pub(crate) fn get(&self, key: &str) -> Option<Self> {
        let dot = if self.place.is_empty() { "" } else { "." };
        Some(Self::new(
            self.value.get(key)?,
            format!("{}{dot}{key}", self.place),
        ))
    }

    /// A member that has to be there.
    pub(crate) fn require(&self, key: &str) -> Result<Self> {
        let missing = || Flaw::saying(self.place(), format!("'{key}' is missing"));
        self.get(key).ok_or_else(missing)
    }

    /// A value on the way through objects; `None` where the way ends.
    pub(crate) fn path(&self, keys: &[&str]) -> Option<Self> {
        keys.iter().try_fold(self.clone(), |at, key| at.get(key))
    }

    /// The members of an object.
    pub(crate) fn members(&self) -> Result<impl Iterator<Item = (&'a str, Self)> + use<'a>> {
        let Value::Object(map) = self.value else {
            return Err(self.unexpected("an object"));
        };
        let place = self.place.clone();
        let member = move |key| format!("{place}.{key}");
        Ok(map
            .iter()
            .map(move |(key, value)| (&key[..], Self::new(value, member(key)))))
    }

    /// The items of an array.
    pub(crate) fn items(&self) -> Result<impl ExactSizeIterator<Item = Self> + use<'a>> {
        let Value::Array(items) = self.value else {
            return Err(self.unexpected("an array"));
        };
        let place = self.place.clone();
        let item = move |(i, value)| Self::new(value, format!("{place}[{i}]"));
        Ok(items.iter().enumerate().map(item))
    }

    /// An item of an array; `None` where there is none.
    pub(crate) fn item(&self, index: usize) -> Option<Self> {
        Some(Self::new(
            self.value.get(index)?,
            format!("{}[{index}]", self.place),
        ))
    }

    /// The items of an array that may be missing.
    pub(crate) fn list(&self, key: &str) -> Result<Vec<Self>> {
        match self.get(key) {
            None => Ok(Vec::new()),
            Some(at) => Ok(at.items()?.collect()),
        }
    }

    /// The number of an item of one of the document's arrays, which this value is.
    pub(crate) fn number_in(&self, root: &At<'_>, array: &str) -> Result<usize> {
        self.item_of(root, array)?;
        self.count()
    }

    /// The item of one of the document's arrays that has the number which this value is.
    pub(crate) fn item_of<'d>(&self, root: &At<'d>, array: &str) -> Result<At<'d>> {
        let (index, list) = (self.count()?, root.get(array));
        let items = list.as_ref().and_then(|list| list.value.as_array());
        let all = list.as_ref().filter(|_| items.is_some());
        let item = all.and_then(|list| list.item(index));
        item.ok_or_else(|| {
            let count = items.map_or(0, Vec::len);
            let expected = format!("an index below {count} (the number of {array})");
            Flaw::new(self.place(), index, expected)
        })
    }

    /// A whole number from 0.
    pub(crate) fn count(&self) -> Result<usize> {
        // Some writers give whole numbers a point.
        let is_whole = |x: &f64| x.fract() == 0.0 && (0.0..9e15).contains(x);
        let real = || self.value.as_f64().filter(is_whole).map(|x| x as u64);
        let whole = self.value.as_u64().or_else(real);
        let count = whole.and_then(|count| usize::try_from(count).ok());
        count.ok_or_else(|| self.unexpected("a whole number from 0"))
    }

    /// [`Self::count`] of a member that may be missing.
    pub(crate) fn count_or(&self, key: &str, otherwise: usize) -> Result<usize> {
        self.get(key).map_or(Ok(otherwise), |at| at.count())
    }

    /// A number.
    fn number(&self) -> Result<f64> {
        let number = self.value.as_f64().filter(|x| x.is_finite());
        number.ok_or_else(|| self.unexpected("a number"))
    }

    /// [`Self::number`] of a member that may be missing.
    pub(crate) fn number_or(&self, key: &str, otherwise: f64) -> Result<f64> {
        self.get(key).map_or(Ok(otherwise), |at| at.number())
    }

    /// As many numbers as asked for.
    pub(crate) fn numbers<const N: usize>(&self) -> Result<[f64; N]> {
        let numbers = self.items()?.map(|at| at.number());
        let numbers = numbers.collect::<Result<Vec<f64>>>()?;
        let found = numbers.try_into();
        found.map_err(|_| self.unexpected(format!("{N} numbers")))
    }

    /// [`Self::numbers`] of a member that may be missing.
    pub(crate) fn numbers_or<const N: usize>(
        &self,
        key: &str,
        otherwise: [f64; N],
    ) -> Result<[f64; N]> {
        self.get(key).map_or(Ok(otherwise), |at| at.numbers())
    }

    /// A text.
    pub(crate) fn text(&self) -> Result<&'a str> {
        self.value.as_str().ok_or_else(|| self.unexpected("a text"))
    }

    /// True or false; false where the member is missing.
    pub(crate) fn flag(&self, key: &str) -> Result<bool> {
        let flag = |at: Self| {
            let found = at.value.as_bool();
            found.ok_or_else(|| at.unexpected("true or false"))
        };
        self.get(key).map_or(Ok(false), flag)
    }

    /// The value's `name`, if it has one.
    pub(crate) fn name(&self) -> Option<&'a str> {
        self.value.get("name").and_then(Value::as_str)
    }

    /// A flaw here.
    pub(crate) fn unexpected(&self, expected: impl fmt::Display) -> Flaw {
        let found = match self.value {
            Value::Array(items) => format!("an array of {}", items.len()),
            Value::Object(_) => "an object".to_owned(),
            other => shortened(&other.to_string()),
        };
        Flaw::new(self.place(), found, expected)
    }
}
