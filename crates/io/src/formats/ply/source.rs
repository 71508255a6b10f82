//! The values of a PLY file one after another, whether they are text or bytes of either order.

use super::header::{Element, Encoding, Scalar, Start};
use crate::flaw::{Flaw, Place, Result, quoted};
use crate::scan::{Scanner, integer, number};

/// Gives the values of the body in order.
pub(super) trait Source {
    /// The next value.
    fn number(&mut self, scalar: Scalar) -> Result<f64>;

    /// The next value, of an integer type.
    fn integer(&mut self, scalar: Scalar) -> Result<i64>;

    /// Adds the next `count` values, of an integer type, to `values`.
    fn integers(&mut self, scalar: Scalar, count: usize, values: &mut Vec<i64>) -> Result<()>;

    /// Steps over `count` values.
    fn skip(&mut self, scalar: Scalar, count: usize) -> Result<()>;

    /// Called after the last value of each element.
    fn end_element(&mut self) -> Result<()>;

    /// Steps over all of `element` if that can be done without looking at each.
    fn skip_all(&mut self, element: &Element) -> bool;

    /// How many bytes are left.
    fn remaining(&self) -> usize;

    /// How many bytes follow the last element; in a text, from the next word on.
    fn trailing(&mut self) -> usize;

    /// Where the source stands, for errors.
    fn place(&self) -> Place;

    /// A second reader at this place, to go over some elements twice.
    fn fork(&self) -> Self;
}

/// Values in text, the elements one to a line.
#[derive(Clone)]
pub(super) struct Text<'a> {
    scanner: Scanner<'a>,
    /// Whether the scanner stands before the first value of an element.
    fresh: bool,
}

impl<'a> Text<'a> {
    pub(super) fn new(bytes: &'a [u8], body: Start) -> Self {
        let scanner = Scanner::starting_at(bytes, body.byte, body.line);
        Self {
            scanner,
            fresh: true,
        }
    }

    fn word(&mut self) -> Option<&'a [u8]> {
        if std::mem::take(&mut self.fresh) {
            self.scanner.first_word()
        } else {
            self.scanner.word()
        }
    }
}

impl Source for Text<'_> {
    fn number(&mut self, _: Scalar) -> Result<f64> {
        let word = self.word();
        word.and_then(number)
            .ok_or_else(|| self.scanner.unexpected(word, "a number"))
    }

    fn integer(&mut self, _: Scalar) -> Result<i64> {
        let word = self.word();
        word.and_then(integer)
            .ok_or_else(|| self.scanner.unexpected(word, "an integer"))
    }

    fn integers(&mut self, scalar: Scalar, count: usize, values: &mut Vec<i64>) -> Result<()> {
        for _ in 0..count {
            values.push(self.integer(scalar)?);
        }
        Ok(())
    }

    fn skip(&mut self, _: Scalar, count: usize) -> Result<()> {
        for _ in 0..count {
            let word = self.word();
            if word.is_none() {
                return Err(self.scanner.unexpected(word, "a number"));
            }
        }
        Ok(())
    }

    fn end_element(&mut self) -> Result<()> {
        if let Some(word) = self.scanner.word() {
            let expected = "the end of the line after the last property";
            return Err(self.scanner.unexpected(Some(word), expected));
        }
        self.scanner.next_line();
        self.fresh = true;
        Ok(())
    }

    fn skip_all(&mut self, element: &Element) -> bool {
        element.properties.is_empty()
    }

    fn remaining(&self) -> usize {
        self.scanner.remaining()
    }

    fn trailing(&mut self) -> usize {
        self.scanner.skip_empty_lines();
        self.scanner.remaining()
    }

    fn place(&self) -> Place {
        self.scanner.place()
    }

    fn fork(&self) -> Self {
        self.clone()
    }
}

/// Values in binary, `BIG` endian or little.
pub(super) struct Binary<'a, const BIG: bool> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a, const BIG: bool> Binary<'a, BIG> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    #[cold]
    fn too_short(&self, needed: usize) -> Flaw {
        let expected = format!("{needed} bytes from byte {}", self.at);
        Flaw::new(
            Place::Byte(self.bytes.len()),
            "the end of the file",
            expected,
        )
    }

    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        let Some(&value) = self.bytes[self.at..].first_chunk::<N>() else {
            return Err(self.too_short(N));
        };
        self.at += N;
        Ok(value)
    }
}

/// The next value of a type, in the byte order of the file.
macro_rules! next {
    ($source:ident, $type:ty) => {
        match $source.take()? {
            bytes if BIG => <$type>::from_be_bytes(bytes),
            bytes => <$type>::from_le_bytes(bytes),
        }
    };
}

impl<const BIG: bool> Source for Binary<'_, BIG> {
    #[inline]
    fn number(&mut self, scalar: Scalar) -> Result<f64> {
        Ok(match scalar {
            Scalar::F32 => f64::from(next!(self, f32)),
            Scalar::F64 => next!(self, f64),
            // At most 32 bits, which an f64 holds exactly.
            integer => self.integer(integer)? as f64,
        })
    }

    #[inline]
    fn integer(&mut self, scalar: Scalar) -> Result<i64> {
        Ok(match scalar {
            Scalar::U8 => i64::from(next!(self, u8)),
            Scalar::I8 => i64::from(next!(self, i8)),
            Scalar::I16 => i64::from(next!(self, i16)),
            Scalar::U16 => i64::from(next!(self, u16)),
            Scalar::I32 => i64::from(next!(self, i32)),
            Scalar::U32 => i64::from(next!(self, u32)),
            Scalar::F32 | Scalar::F64 => {
                let value = self.number(scalar)?.to_string();
                return Err(Flaw::new(
                    self.place(),
                    quoted(value.as_bytes()),
                    "an integer",
                ));
            }
        })
    }

    #[inline]
    fn integers(&mut self, scalar: Scalar, count: usize, values: &mut Vec<i64>) -> Result<()> {
        let needed = scalar.size().saturating_mul(count);
        let Some(bytes) = self.bytes[self.at..].get(..needed) else {
            return Err(self.too_short(needed));
        };
        // Nearly all files have 32-bit indices: read without asking for the type and the length each time.
        if matches!(scalar, Scalar::I32 | Scalar::U32) {
            let signed = scalar == Scalar::I32;
            values.extend(bytes.as_chunks::<4>().0.iter().map(|&four| {
                let value = if BIG {
                    u32::from_be_bytes(four)
                } else {
                    u32::from_le_bytes(four)
                };
                if signed {
                    i64::from(value.cast_signed())
                } else {
                    i64::from(value)
                }
            }));
            self.at += needed;
            return Ok(());
        }
        for _ in 0..count {
            values.push(self.integer(scalar)?);
        }
        Ok(())
    }

    #[inline]
    fn skip(&mut self, scalar: Scalar, count: usize) -> Result<()> {
        let needed = scalar.size().saturating_mul(count);
        if needed > self.remaining() {
            return Err(self.too_short(needed));
        }
        self.at += needed;
        Ok(())
    }

    fn end_element(&mut self) -> Result<()> {
        Ok(())
    }

    fn skip_all(&mut self, element: &Element) -> bool {
        let size = element.least_size(Encoding::LittleEndian);
        let all = size.saturating_mul(element.count);
        let skips = element.has_fixed_size() && all <= self.remaining();
        if skips {
            self.at += all;
        }
        skips
    }

    fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn trailing(&mut self) -> usize {
        self.remaining()
    }

    fn place(&self) -> Place {
        Place::Byte(self.at)
    }

    fn fork(&self) -> Self {
        Self {
            bytes: self.bytes,
            at: self.at,
        }
    }
}
