//! Colours at the end of lines: three or four numbers, whole ones from 0 to 255, or from 0 to 1.
//!
//! A file has one kind: if a number has a point, or none is above 1, they are from 0 to 1. What stands after four numbers is passed over. A single
//! number is an index into a map of colours that no file has.

use crate::reading::by_element;
use crate::scan::finite;
use limitmesh::mesh::{Channel, Domain, Semantic, Storage};

/// Colours of the elements of a file.
#[derive(Default)]
pub(super) struct Colours {
    /// By element, four numbers; elements beyond have none.
    values: Vec<[f64; 4]>,
    /// Whether some element has an opacity, a fraction, a number above 1.
    has_opacity: bool,
    has_fraction: bool,
    has_whole: bool,
    /// Whether what stands there is no colour somewhere.
    is_wrong: bool,
}

/// The colour of an element without one, until Geomview's grey takes its place.
const NONE: [f64; 4] = [f64::NAN; 4];

/// Geomview's colour of what has none.
const GREY: f64 = 0.666;

impl Colours {
    /// Takes the words of an element's line that may be a colour.
    pub(super) fn read(&mut self, words: &[&[u8]], element: usize) {
        let mut colour = [0.0, 0.0, 0.0, f64::NAN];
        for (own, word) in colour.iter_mut().zip(words) {
            match finite(word) {
                Some(value) => *own = value,
                None => self.is_wrong = true,
            }
            self.has_fraction |= word.iter().any(|byte| b".eE".contains(byte));
        }
        let count = words.len();
        // A lone 0 says that there is no colour.
        if count == 0 || count == 1 && colour[0] == 0.0 {
            return;
        }
        self.is_wrong |= count < 3;
        self.has_opacity |= count > 3;
        self.has_whole |= colour.iter().any(|&x| x > 1.0);
        self.values.resize(element, NONE);
        self.values.push(colour);
    }

    /// The channel of so many elements, if any has a colour.
    ///
    /// # Errors
    /// There are some that cannot be read as colours.
    pub(super) fn channel(
        mut self,
        name: &str,
        domain: Domain,
        count: usize,
    ) -> Result<Option<Channel>, ()> {
        if self.values.is_empty() && !self.is_wrong {
            return Ok(None);
        }
        let is_bytes = self.has_whole && !self.has_fraction;
        let (most, storage) = if is_bytes {
            (255.0, Storage::Byte)
        } else {
            (1.0, Storage::Single)
        };
        if self.is_wrong || self.values.iter().flatten().any(|&x| x < 0.0 || x > most) {
            return Err(());
        }
        self.values.resize(count, NONE);
        let arity = if self.has_opacity { 4 } else { 3 };
        let usual = |own: &[f64; 4], i: usize| match (own[0].is_nan(), i) {
            (_, 3) if own[3].is_nan() => 1.0,
            (true, _) => GREY,
            _ => own[i] / most,
        };
        let all = self.values.iter();
        let values = all.flat_map(|own| (0..arity).map(|i| usual(own, i)));
        let channel = by_element(name, Semantic::Colour, domain, arity, values.collect());
        Ok(Some(channel.stored(storage)))
    }
}
