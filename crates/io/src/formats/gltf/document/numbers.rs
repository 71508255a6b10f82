//! Numbers out of bytes, as accessors lay them out.
//!
//! Integers that are normalised become fractions: c/255, c/65535, max(c/127, −1), max(c/32767, −1).

use super::json::At;
use crate::flaw::{Flaw, Result};

/// Numbers by element.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Numbers {
    /// Numbers of one element.
    pub(crate) components: usize,
    /// One element after the other.
    pub(crate) values: Vec<f64>,
    /// Whether these are whole numbers as they stand, such as identities.
    pub(crate) is_integer: bool,
}

impl Numbers {
    /// Number of elements.
    pub(crate) fn len(&self) -> usize {
        self.values.len() / self.components
    }

    /// The elements as points.
    pub(crate) fn points(&self, at: &At<'_>) -> Result<Vec<[f64; 3]>> {
        let (points, rest) = self.values.as_chunks::<3>();
        if self.components != 3 || !rest.is_empty() {
            return Err(Flaw::new(
                at.place(),
                self.components,
                "3 numbers for each vertex",
            ));
        }
        match self.values.iter().position(|x| !x.is_finite()) {
            None => Ok(points.to_vec()),
            Some(i) => {
                let found = format!("{} in element {}", self.values[i], i / 3);
                Err(Flaw::new(at.place(), found, "a finite number"))
            }
        }
    }
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    /// By its number in the format.
    pub(crate) fn of(code: usize) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// In bytes.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// Whether indices can be stored so.
    pub(crate) fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }
}

/// The declaration of an accessor's numbers.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    pub(crate) count: usize,
    pub(crate) components: usize,
    pub(crate) component: Component,
    pub(crate) is_normalized: bool,
}

impl Layout {
    /// Bytes of an element.
    pub(crate) fn size(self) -> usize {
        self.components * self.component.size()
    }

    /// These numbers as they are, if they are as many as laid out.
    pub(crate) fn numbers(self, values: Vec<f64>) -> Numbers {
        let is_integer = self.component != Component::F32 && !self.is_normalized;
        Numbers {
            components: self.components,
            values,
            is_integer,
        }
    }

    /// Numbers of elements that are `stride` bytes apart; `bytes` are known to hold them all.
    pub(crate) fn decode(self, bytes: &[u8], stride: usize) -> Vec<f64> {
        let part = |c: f64, most: f64| {
            if self.is_normalized {
                (c / most).max(-1.0)
            } else {
                c
            }
        };
        match self.component {
            Component::I8 => self.read(bytes, stride, |b| part(i8::from_le_bytes(b).into(), 127.0)),
            Component::U8 => self.read(bytes, stride, |b| part(u8::from_le_bytes(b).into(), 255.0)),
            Component::I16 => self.read(bytes, stride, |b| {
                part(i16::from_le_bytes(b).into(), 32_767.0)
            }),
            Component::U16 => self.read(bytes, stride, |b| {
                part(u16::from_le_bytes(b).into(), 65_535.0)
            }),
            Component::U32 => self.read(bytes, stride, |b| u32::from_le_bytes(b).into()),
            Component::F32 => self.read(bytes, stride, |b| f32::from_le_bytes(b).into()),
        }
    }

    fn read<const N: usize>(
        self,
        bytes: &[u8],
        stride: usize,
        number: impl Fn([u8; N]) -> f64,
    ) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.count * self.components);
        for element in (0..self.count).map(|i| &bytes[i * stride..][..self.components * N]) {
            let (numbers, _) = element.as_chunks::<N>();
            values.extend(numbers.iter().map(|&bytes| number(bytes)));
        }
        values
    }
}
