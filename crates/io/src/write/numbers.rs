//! Text and bytes gathered into large pieces before they go to a writer.

use std::io::{self, Write};

/// Bytes after which a piece goes out: large enough that the writer's own cost does not show.
const PIECE: usize = 1 << 16;

/// Gathers what is written and hands it on in pieces; call [`Pieces::finish`] at the end.
pub(super) struct Pieces<'w> {
    writer: &'w mut dyn Write,
    buffer: Vec<u8>,
}

impl<'w> Pieces<'w> {
    pub(super) fn new(writer: &'w mut dyn Write) -> Self {
        Self { writer, buffer: Vec::with_capacity(PIECE + 1024) }
    }

    /// Adds text or bytes as they are.
    #[inline]
    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        self.buffer.extend_from_slice(bytes);
    }

    /// Adds a blank and the fewest digits that read back as exactly this number.
    #[inline]
    pub(super) fn number(&mut self, value: f64) {
        self.buffer.push(b' ');
        self.bare_number(value);
    }

    /// Adds the fewest digits that read back as exactly this number.
    #[inline]
    pub(super) fn bare_number(&mut self, value: f64) {
        let mut digits = zmij::Buffer::new();
        let text = digits.format(value);
        // A whole number needs no ".0".
        self.bytes(text.strip_suffix(".0").unwrap_or(text).as_bytes());
    }

    /// Adds a blank and this number as an `f32` with a point or an exponent, also where it is whole.
    pub(super) fn pointed(&mut self, value: f64) {
        self.buffer.push(b' ');
        self.bytes(zmij::Buffer::new().format(value as f32).as_bytes());
    }

    /// Adds a blank and the fewest digits that read back as exactly this `f32`.
    #[inline]
    pub(super) fn single(&mut self, value: f32) {
        self.buffer.push(b' ');
        let mut digits = zmij::Buffer::new();
        let text = digits.format(value);
        self.bytes(text.strip_suffix(".0").unwrap_or(text).as_bytes());
    }

    /// Adds a blank and a whole number.
    #[inline]
    pub(super) fn integer(&mut self, value: u32) {
        self.buffer.push(b' ');
        self.bare_integer(value);
    }

    /// Adds a whole number.
    #[inline]
    pub(super) fn bare_integer(&mut self, value: u32) {
        self.bytes(itoa::Buffer::new().format(value).as_bytes());
    }

    /// Ends an element: hands the piece on if it is large enough.
    #[inline]
    pub(super) fn end(&mut self) -> io::Result<()> {
        if self.buffer.len() >= PIECE {
            self.writer.write_all(&self.buffer)?;
            self.buffer.clear();
        }
        Ok(())
    }

    /// Ends a line of text.
    #[inline]
    pub(super) fn end_line(&mut self) -> io::Result<()> {
        self.buffer.push(b'\n');
        self.end()
    }

    /// Hands on what is left.
    pub(super) fn finish(self) -> io::Result<()> {
        self.writer.write_all(&self.buffer)
    }
}
