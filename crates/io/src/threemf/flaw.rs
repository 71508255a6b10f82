//! What is wrong with a 3MF package, and where: the part, and the line and column of its text.

use std::fmt;

/// Something that breaks the rules of 3MF, or that is not supported.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PackageFlaw {
    /// The part of the package, such as `3D/3dmodel.model`; `the package` for the archive itself.
    pub part: String,
    /// Line and column (in bytes) in the part's text, counted from 1.
    pub place: Option<(usize, usize)>,
    /// The element there, such as `object 3`; empty outside elements.
    pub element: String,
    /// What is wrong, in words.
    pub problem: String,
}

impl PackageFlaw {
    /// A problem of a part, in words.
    pub(super) fn new(part: &str, problem: impl Into<String>) -> Self {
        Self {
            part: part.to_owned(),
            place: None,
            element: String::new(),
            problem: problem.into(),
        }
    }

    /// A problem of the archive itself, in words.
    pub(super) fn of_archive(problem: impl Into<String>) -> Self {
        Self::new("the package", problem)
    }

    /// Of text that is no XML.
    pub(super) fn not_xml(part: &str, why: &quick_xml::Error) -> Self {
        Self::new(part, format!("the text is not well-formed XML: {why}"))
    }

    /// The same at a byte of the part's text.
    pub(super) fn at(mut self, text: &str, byte: usize) -> Self {
        let before = &text.as_bytes()[..byte.min(text.len())];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let column = before.iter().rev().take_while(|&&b| b != b'\n').count() + 1;
        self.place = Some((line, column));
        self
    }

    /// The same with the element it is in.
    pub(super) fn element(mut self, element: impl Into<String>) -> Self {
        self.element = element.into();
        self
    }
}

impl fmt::Display for PackageFlaw {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.part)?;
        if let Some((line, column)) = self.place {
            write!(out, ", line {line}, column {column}")?;
        }
        if !self.element.is_empty() {
            write!(out, ", {}", self.element)?;
        }
        write!(out, ": {}", self.problem)
    }
}

impl std::error::Error for PackageFlaw {}

/// What the parts of this module give.
pub(super) type Result<T> = std::result::Result<T, PackageFlaw>;
