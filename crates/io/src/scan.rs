//! Words and numbers out of the bytes of a text file.
//!
//! Works on bytes, so that comments and names may be in any encoding. Lines end with LF, CR LF or CR.

use crate::flaw::{Flaw, Place, Result, quoted};
use crate::names;
use memchr::memchr2;

/// The mark that some editors put before text in UTF-8.
pub(crate) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The syntax of a text format, apart from words and lines.
#[derive(Clone, Copy, Default)]
pub(crate) struct Syntax {
    /// A word that begins with `#` hides itself and the rest of its line.
    pub(crate) comments: bool,
    /// A backslash at the end of a line joins the next line to it.
    pub(crate) continuations: bool,
}

/// Walks through a text, line by line and word by word.
#[derive(Clone)]
pub(crate) struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    syntax: Syntax,
}

impl<'a> Scanner<'a> {
    /// At the beginning of `bytes`, after a byte order mark of UTF-8 if there is one.
    pub(crate) fn new(bytes: &'a [u8], syntax: Syntax) -> Self {
        let has_mark = bytes.starts_with(BYTE_ORDER_MARK);
        let at = if has_mark { BYTE_ORDER_MARK.len() } else { 0 };
        Self {
            syntax,
            ..Self::starting_at(bytes, at, 1)
        }
    }

    /// At the beginning of a text with comments, whose lines may go on after a backslash.
    pub(crate) fn of_statements(bytes: &'a [u8]) -> Self {
        Self::new(
            bytes,
            Syntax {
                comments: true,
                continuations: true,
            },
        )
    }

    /// At byte `at`, which stands in line `line`.
    pub(crate) fn starting_at(bytes: &'a [u8], at: usize, line: usize) -> Self {
        let syntax = Syntax::default();
        Self {
            bytes,
            at,
            line,
            syntax,
        }
    }

    /// The line the scanner stands in, counted from 1.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// The line as a place for an error.
    pub(crate) fn place(&self) -> Place {
        Place::Line(self.line)
    }

    /// How many bytes are left.
    pub(crate) fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Whether nothing is left.
    pub(crate) fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// The next word of this line; `None` at its end, where the scanner stays.
    #[inline]
    pub(crate) fn word(&mut self) -> Option<&'a [u8]> {
        loop {
            while self.bytes.get(self.at).is_some_and(|&b| is_blank(b)) {
                self.at += 1;
            }
            let rest = &self.bytes[self.at..];
            let length = rest.iter().position(|&b| b <= b' ').unwrap_or(rest.len());
            if length == 0 {
                return None;
            }
            if self.syntax.comments && rest[0] == b'#' {
                self.at += memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
                return None;
            }
            let word = &rest[..length];
            self.at += length;
            if self.syntax.continuations && word.ends_with(b"\\") && self.is_at_break() {
                if length > 1 {
                    // The backslash stays for the next call, so that the scanner is in the line of this word.
                    self.at -= 1;
                    return Some(&word[..length - 1]);
                }
                self.step_over_break();
                continue;
            }
            return Some(word);
        }
    }

    /// The words that are left of this line, as a name with one blank between them.
    pub(crate) fn rest_of_line(&mut self) -> String {
        joined(&std::iter::from_fn(|| self.word()).collect::<Vec<_>>())
    }

    /// Goes to the beginning of the next line.
    #[inline]
    pub(crate) fn next_line(&mut self) {
        loop {
            let rest = &self.bytes[self.at..];
            let length = memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
            self.at += length;
            // A comment ends with its line, whatever its last letter is.
            let joined = self.syntax.continuations
                && rest[..length].ends_with(b"\\")
                && !(self.syntax.comments && rest[..length].contains(&b'#'));
            self.step_over_break();
            if !joined || self.is_at_end() {
                return;
            }
        }
    }

    /// The first word of the next line that has one, from here on; `None` at the end of the text.
    pub(crate) fn first_word(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.word() {
                return Some(word);
            }
            if self.is_at_end() {
                return None;
            }
            self.next_line();
        }
    }

    /// Goes to the next line that has a word, or to the end of the text; stays if this line has one left.
    pub(crate) fn skip_empty_lines(&mut self) {
        loop {
            let (at, line) = (self.at, self.line);
            if self.word().is_some() {
                (self.at, self.line) = (at, line);
                return;
            }
            if self.is_at_end() {
                return;
            }
            self.next_line();
        }
    }

    fn is_at_break(&self) -> bool {
        matches!(self.bytes.get(self.at), Some(b'\n' | b'\r'))
    }

    fn step_over_break(&mut self) {
        match self.bytes.get(self.at) {
            Some(b'\r') if self.bytes.get(self.at + 1) == Some(&b'\n') => self.at += 2,
            Some(b'\r' | b'\n') => self.at += 1,
            _ => return,
        }
        self.line += 1;
    }

    /// A flaw here: `word` (or the end of the line or text) where `expected` should stand.
    #[cold]
    pub(crate) fn unexpected(&self, word: Option<&[u8]>, expected: impl std::fmt::Display) -> Flaw {
        let found = match word {
            Some(word) => quoted(word),
            None if self.is_at_end() => "the end of the file".to_owned(),
            None => "the end of the line".to_owned(),
        };
        Flaw::new(self.place(), found, expected)
    }

    /// The next word of this line as a finite number; `what` names it for the error.
    #[inline]
    pub(crate) fn finite_number(&mut self, what: &str) -> Result<f64> {
        let word = self.word();
        let value = word.and_then(finite);
        value.ok_or_else(|| self.unexpected(word, format!("a finite number for {what}")))
    }

    /// The next three words of this line as a point.
    #[inline]
    pub(crate) fn point(&mut self) -> Result<[f64; 3]> {
        let (x, y) = (self.finite_number("x")?, self.finite_number("y")?);
        Ok([x, y, self.finite_number("z")?])
    }
}

#[inline]
fn is_blank(byte: u8) -> bool {
    byte <= b' ' && byte != b'\n' && byte != b'\r'
}

/// A name of several words, with one blank between them.
pub(crate) fn joined(words: &[&[u8]]) -> String {
    let all = words.iter().map(|word| names::read(word));
    all.collect::<Vec<_>>().join(" ")
}

/// A word as a number at full precision, NaN and infinity included.
#[inline]
pub(crate) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A word as a finite number at full precision.
#[inline]
pub(crate) fn finite(word: &[u8]) -> Option<f64> {
    number(word).filter(|value| value.is_finite())
}

/// A word as a whole number.
#[inline]
pub(crate) fn integer(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, word),
    };
    // 18 digits cannot overflow; longer numbers are beyond every index there can be.
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let mut value = 0i64;
    for digit in digits {
        value = value * 10 + i64::from(digit.checked_sub(b'0').filter(|&digit| digit < 10)?);
    }
    Some(if negative { -value } else { value })
}
