//! A flaw of a file, and its place.

use std::fmt;

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line, counted from 1.
    Line(usize),
    /// A byte, counted from 0.
    Byte(usize),
    /// A part of a document by its name: in glTF as JavaScript names it, such as `accessors[3].count`; in 3MF a part of the package, with line and
    /// column (in bytes) of its text where they are known.
    Named(String),
}

impl From<&str> for Place {
    fn from(name: &str) -> Self {
        Self::Named(name.to_owned())
    }
}

impl From<String> for Place {
    fn from(name: String) -> Self {
        Self::Named(name)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(out, "line {line}"),
            Self::Byte(byte) => write!(out, "byte {byte}"),
            Self::Named(name) => out.write_str(name),
        }
    }
}

/// Something that breaks the rules of a format, or that is not supported.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Flaw {
    /// Where.
    pub place: Place,
    /// The element there, such as `vertex 5`; empty outside elements.
    pub element: String,
    /// The problem, in words.
    pub problem: String,
}

/// The result of reading or editing a part of a file.
pub(crate) type Result<T> = std::result::Result<T, Flaw>;

impl Flaw {
    /// Something was found where the format asks for something else.
    pub(crate) fn new(
        place: impl Into<Place>,
        found: impl fmt::Display,
        expected: impl fmt::Display,
    ) -> Self {
        Self::saying(place, format!("expected {expected}, found {found}"))
    }

    /// A problem in words.
    pub(crate) fn saying(place: impl Into<Place>, problem: impl Into<String>) -> Self {
        let (place, problem) = (place.into(), problem.into());
        Self {
            place,
            element: String::new(),
            problem,
        }
    }

    /// Adds the element that the flaw is in.
    pub(crate) fn element(mut self, name: &str, index: usize) -> Self {
        self.element = format!("{name} {index}");
        self
    }

    /// Adds line and column of a byte in the text of the part that has the flaw.
    pub(crate) fn at(mut self, text: &str, byte: usize) -> Self {
        let before = &text.as_bytes()[..byte.min(text.len())];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let column = before.iter().rev().take_while(|&&b| b != b'\n').count() + 1;
        self.place = Place::Named(format!("{}, line {line}, column {column}", self.place));
        self
    }

    /// Names what led to the place of the flaw.
    pub(crate) fn met_from(mut self, place: &str) -> Self {
        self.place = Place::Named(format!("{place} ({})", self.place));
        self
    }
}

impl fmt::Display for Flaw {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let comma = if self.element.is_empty() { "" } else { ", " };
        write!(
            out,
            "{}{comma}{}: {}",
            self.place, self.element, self.problem
        )
    }
}

impl std::error::Error for Flaw {}

/// The longest piece of a text that a message holds, in letters or bytes.
const LONGEST: usize = 40;

/// A text as a message can hold it: shortened if long.
pub(crate) fn shortened(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// A word as a message can hold it: in quotes, on one line, shortened if long.
pub(crate) fn quoted(word: &[u8]) -> String {
    let text = String::from_utf8_lossy(&word[..word.len().min(LONGEST)]);
    let more = if word.len() > LONGEST { "…" } else { "" };
    format!("'{}{more}'", text.escape_debug())
}
