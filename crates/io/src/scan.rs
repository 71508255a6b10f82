//! Words and numbers out of the bytes of a text file.
//!
//! Works on bytes, so that comments and names may be in any encoding. Lines end with LF, CR LF or CR.

use crate::error::{Flaw, Place};
use crate::format::BYTE_ORDER_MARK;
use memchr::memchr2;

/// What a text format has besides words and lines.
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
        let at = if bytes.starts_with(BYTE_ORDER_MARK) {
            BYTE_ORDER_MARK.len()
        } else {
            0
        };
        Self {
            bytes,
            at,
            line: 1,
            syntax,
        }
    }

    /// At byte `at`, which stands in line `line`.
    pub(crate) fn starting_at(bytes: &'a [u8], at: usize, line: usize) -> Self {
        Self {
            bytes,
            at,
            line,
            syntax: Syntax::default(),
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
    pub(crate) fn unexpected(&self, word: Option<&[u8]>, expected: impl AsRef<str>) -> Flaw {
        let found = match word {
            Some(word) => quoted(word),
            None if self.is_at_end() => "the end of the file".to_owned(),
            None => "the end of the line".to_owned(),
        };
        Flaw::new(self.place(), found, expected)
    }

    /// The next word of this line as a finite number; `what` names it for the error.
    #[inline]
    pub(crate) fn finite_number(&mut self, what: &str) -> Result<f64, Flaw> {
        let word = self.word();
        match word.and_then(number) {
            Some(value) if value.is_finite() => Ok(value),
            _ => Err(self.unexpected(word, format!("a finite number for {what}"))),
        }
    }

    /// The next three words of this line as a point.
    #[inline]
    pub(crate) fn point(&mut self) -> Result<[f64; 3], Flaw> {
        Ok([
            self.finite_number("x")?,
            self.finite_number("y")?,
            self.finite_number("z")?,
        ])
    }
}

#[inline]
fn is_blank(byte: u8) -> bool {
    byte <= b' ' && byte != b'\n' && byte != b'\r'
}

/// A word as a number at full precision, NaN and infinity included.
#[inline]
pub(crate) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
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
    for &digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value * 10 + i64::from(digit - b'0');
    }
    Some(if negative { -value } else { value })
}

/// A word as it may stand in a message: in quotes, on one line, shortened if long.
pub(crate) fn quoted(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&word[..word.len().min(LONGEST)]);
    let more = if word.len() > LONGEST { "…" } else { "" };
    format!("'{}{more}'", text.escape_debug())
}
