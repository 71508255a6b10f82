//! Text and bytes gathered into large pieces before they go to a writer.

use std::io::{self, Write};

/// Elements that are put into one piece: enough for the writer's own cost not to show.
const ELEMENTS: usize = 1 << 11;

/// Bytes of what stands between lists after which they go out.
const BYTES: usize = 1 << 16;

/// Written bytes, gathered into pieces: those of long lists by all threads, in their order. Call [`Pieces::finish`] at the end.
pub(crate) struct Pieces<'w> {
    writer: &'w mut dyn Write,
    own: Piece,
}

/// Some of it, in memory.
#[derive(Default)]
pub(crate) struct Piece(Vec<u8>);

impl<'w> Pieces<'w> {
    pub(crate) fn new(writer: &'w mut dyn Write) -> Self {
        Self {
            writer,
            own: Piece::default(),
        }
    }

    /// Adds `count` elements, each by what `element` writes of it.
    pub(crate) fn each(
        &mut self,
        count: usize,
        element: impl Fn(&mut Piece, usize) + Sync,
    ) -> io::Result<()> {
        self.hand_on()?;
        let mut pieces: Vec<Piece> = Vec::new();
        pieces.resize_with(at_once().min(count.div_ceil(ELEMENTS)), Piece::default);
        for first in (0..count).step_by(ELEMENTS * pieces.len().max(1)) {
            let fill = |(number, piece): (usize, &mut Piece)| {
                piece.0.clear();
                let start = first + number * ELEMENTS;
                (start..count.min(start + ELEMENTS)).for_each(|at| element(piece, at));
            };
            fill_each(&mut pieces, fill);
            let mut all = pieces.iter();
            all.try_for_each(|piece| self.writer.write_all(&piece.0))?;
        }
        Ok(())
    }

    /// Adds bytes as they are.
    pub(crate) fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.element(|own| own.bytes(bytes))
    }

    /// Adds what `element` writes.
    pub(crate) fn element(&mut self, element: impl FnOnce(&mut Piece)) -> io::Result<()> {
        element(&mut self.own);
        if self.own.0.len() >= BYTES {
            self.hand_on()
        } else {
            Ok(())
        }
    }

    fn hand_on(&mut self) -> io::Result<()> {
        self.writer.write_all(&self.own.0)?;
        self.own.0.clear();
        Ok(())
    }

    /// Hands on what is left.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        self.hand_on()
    }
}

/// Pieces that are there at one time.
fn at_once() -> usize {
    #[cfg(feature = "parallel")]
    if rayon::current_num_threads() > 1 {
        return 4 * rayon::current_num_threads();
    }
    1
}

fn fill_each(pieces: &mut [Piece], fill: impl Fn((usize, &mut Piece)) + Sync + Send) {
    #[cfg(feature = "parallel")]
    if pieces.len() > 1 {
        use rayon::prelude::*;
        pieces.par_iter_mut().enumerate().for_each(fill);
        return;
    }
    pieces.iter_mut().enumerate().for_each(fill);
}

impl Piece {
    /// Adds text or bytes as they are.
    #[inline]
    pub(crate) fn bytes(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    /// Adds a blank and the fewest digits that read back as exactly this number.
    #[inline]
    pub(crate) fn number(&mut self, value: f64) {
        self.0.push(b' ');
        self.bare_number(value);
    }

    /// Adds the fewest digits that read back as exactly this number.
    #[inline]
    pub(crate) fn bare_number(&mut self, value: f64) {
        let mut digits = zmij::Buffer::new();
        let text = digits.format(value);
        // A whole number needs no ".0".
        self.bytes(text.strip_suffix(".0").unwrap_or(text).as_bytes());
    }

    /// Adds a blank and this number as an `f32` with a point or an exponent, also where it is whole.
    pub(crate) fn pointed(&mut self, value: f64) {
        self.0.push(b' ');
        self.bytes(zmij::Buffer::new().format(value as f32).as_bytes());
    }

    /// Adds a blank and the fewest digits that read back as exactly this `f32`.
    #[inline]
    pub(crate) fn single(&mut self, value: f32) {
        self.0.push(b' ');
        let mut digits = zmij::Buffer::new();
        let text = digits.format(value);
        self.bytes(text.strip_suffix(".0").unwrap_or(text).as_bytes());
    }

    /// Adds a blank and a whole number.
    #[inline]
    pub(crate) fn integer(&mut self, value: u32) {
        self.0.push(b' ');
        self.bare_integer(value);
    }

    /// Adds a whole number.
    #[inline]
    pub(crate) fn bare_integer(&mut self, value: u32) {
        self.bytes(itoa::Buffer::new().format(value).as_bytes());
    }

    /// Adds numbers, each with a blank before it.
    #[inline]
    pub(crate) fn numbers(&mut self, values: &[f64]) {
        values.iter().for_each(|&value| self.number(value));
    }

    /// Adds whole numbers, each with a blank before it.
    #[inline]
    pub(crate) fn integers(&mut self, values: &[u32]) {
        values.iter().for_each(|&value| self.integer(value));
    }

    /// Adds the coordinates of a point with blanks between them.
    #[inline]
    pub(crate) fn point(&mut self, [x, y, z]: [f64; 3]) {
        self.bare_number(x);
        self.numbers(&[y, z]);
    }

    /// Ends a line of text.
    #[inline]
    pub(crate) fn end_line(&mut self) {
        self.0.push(b'\n');
    }
}
