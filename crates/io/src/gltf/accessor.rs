//! Accessors: numbers out of the bytes of buffer views, with every bound checked before room is made.
//!
//! Integers that are normalised become fractions: c/255, c/65535, max(c/127, −1), max(c/32767, −1). An accessor without
//! a view is zeros, which sparse values may replace.

use super::flaw::{GltfFlaw, Result};
use super::json::At;
use super::source::Source;

/// Numbers by element.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Numbers {
    /// Numbers of one element.
    pub(super) components: usize,
    /// One element after the other.
    pub(super) values: Vec<f64>,
    /// Whether these are whole numbers as they stand, such as identities.
    pub(super) is_integer: bool,
}

impl Numbers {
    /// Number of elements.
    pub(super) fn len(&self) -> usize {
        self.values.len() / self.components
    }

    /// The elements as points.
    pub(super) fn points(&self, at: &At<'_>) -> Result<Vec<[f64; 3]>> {
        let (points, rest) = self.values.as_chunks::<3>();
        if self.components != 3 || !rest.is_empty() {
            return Err(GltfFlaw::new(
                at.place(),
                self.components.to_string(),
                "3 numbers for each vertex",
            ));
        }
        match self.values.iter().position(|x| !x.is_finite()) {
            None => Ok(points.to_vec()),
            Some(i) => {
                let found = format!("{} in element {}", self.values[i], i / 3);
                Err(GltfFlaw::new(at.place(), found, "a finite number"))
            }
        }
    }
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    /// By its number in the format.
    pub(super) fn of(code: usize) -> Option<Self> {
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
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

/// What an accessor says of its numbers.
#[derive(Clone, Copy)]
struct Layout {
    count: usize,
    components: usize,
    component: Component,
    is_normalized: bool,
}

impl Source {
    /// The numbers of an accessor, which `at` names by its index. If `expected` elements are, others are refused before
    /// anything is read.
    pub(super) fn numbers(&self, at: &At<'_>, expected: Option<usize>) -> Result<Numbers> {
        let (_, accessor) = at.item_of(&self.root(), "accessors")?;
        let layout = layout(&accessor)?;
        let Layout {
            count, components, ..
        } = layout;
        if let Some(expected) = expected.filter(|&expected| expected != count) {
            let found = format!("{count}, from {}", accessor.place());
            let expected = format!("{expected} elements (as many as there are vertices)");
            return Err(GltfFlaw::new(at.place(), found, expected));
        }
        let place = |flaw: GltfFlaw| GltfFlaw {
            place: format!("{} ({})", at.place(), flaw.place),
            ..flaw
        };
        let values = match accessor.get("bufferView") {
            Some(view) => self.elements(&accessor, &view, layout).map_err(place)?,
            None => {
                self.check_zeros().map_err(place)?;
                vec![0.0; count * components]
            }
        };
        let is_integer = layout.component != Component::F32 && !layout.is_normalized;
        let mut numbers = Numbers {
            components,
            values,
            is_integer,
        };
        if let Some(sparse) = accessor.get("sparse") {
            self.replace(&sparse, layout, &mut numbers).map_err(place)?;
        }
        Ok(numbers)
    }

    /// The whole numbers of an accessor, such as indices.
    pub(super) fn integers(&self, at: &At<'_>) -> Result<Vec<u32>> {
        let (_, accessor) = at.item_of(&self.root(), "accessors")?;
        let layout = layout(&accessor)?;
        let is_index = matches!(
            layout.component,
            Component::U8 | Component::U16 | Component::U32
        );
        if !is_index || layout.components != 1 {
            return Err(GltfFlaw::saying(
                accessor.place(),
                "indices are unsigned whole numbers, one an element",
            ));
        }
        Ok(self
            .numbers(at, None)?
            .values
            .into_iter()
            .map(|x| x as u32)
            .collect())
    }

    /// Elements in a view, from the `byteOffset` of what names it.
    fn elements(&self, owner: &At<'_>, view: &At<'_>, layout: Layout) -> Result<Vec<f64>> {
        let Layout {
            count,
            components,
            component,
            is_normalized,
        } = layout;
        let found = self.view(view)?;
        let size = components * component.size();
        let stride = found.stride.unwrap_or(size);
        if stride < size {
            let problem =
                format!("its elements of {size} bytes overlap: the view has a stride of {stride}");
            return Err(GltfFlaw::saying(owner.place(), problem));
        }
        let start = owner.count_or("byteOffset", 0)?;
        let end = count.checked_sub(1).map_or(Some(start), |last| {
            last.checked_mul(stride)?
                .checked_add(size)?
                .checked_add(start)
        });
        let bytes = end.and_then(|end| found.bytes.get(start..end)).ok_or_else(|| {
            let problem = format!(
                "it has {count} elements of {size} bytes, {stride} apart, from byte {start} on, but the view has {} bytes",
                found.bytes.len()
            );
            GltfFlaw::saying(owner.place(), problem)
        })?;
        Ok(decode(
            bytes,
            count,
            components,
            stride,
            (component, is_normalized),
        ))
    }

    /// Puts sparse values in their places.
    fn replace(&self, sparse: &At<'_>, layout: Layout, numbers: &mut Numbers) -> Result<()> {
        let count = sparse.require("count")?;
        let many = count.count()?;
        if many > layout.count {
            return Err(
                count.unexpected(format!("at most {} (the accessor's count)", layout.count))
            );
        }
        let (places, values) = (sparse.require("indices")?, sparse.require("values")?);
        let kind = component(&places)?;
        if !matches!(kind, Component::U8 | Component::U16 | Component::U32) {
            return Err(places
                .require("componentType")?
                .unexpected("unsigned whole numbers"));
        }
        let of_places = Layout {
            count: many,
            components: 1,
            component: kind,
            is_normalized: false,
        };
        let indices = self.elements(&places, &places.require("bufferView")?, of_places)?;
        let of_values = Layout {
            count: many,
            ..layout
        };
        let new = self.elements(&values, &values.require("bufferView")?, of_values)?;
        let width = layout.components;
        for (i, index) in indices.into_iter().enumerate() {
            let index = index as usize;
            let Some(old) = numbers.values.get_mut(index * width..(index + 1) * width) else {
                let found = format!("{index} in element {i}");
                return Err(GltfFlaw::new(
                    places.place(),
                    found,
                    format!("indices below {}", layout.count),
                ));
            };
            old.copy_from_slice(&new[i * width..(i + 1) * width]);
        }
        Ok(())
    }
}

fn component(at: &At<'_>) -> Result<Component> {
    let code = at.require("componentType")?;
    Component::of(code.count()?)
        .ok_or_else(|| code.unexpected("5120, 5121, 5122, 5123, 5125 or 5126"))
}

fn layout(accessor: &At<'_>) -> Result<Layout> {
    let kind = accessor.require("type")?;
    let component = component(accessor)?;
    let components = match kind.text()? {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        // Columns of other matrices are padded, and nothing here has any.
        "MAT4" if component.size() == 4 => 16,
        _ => return Err(kind.unexpected("SCALAR, VEC2, VEC3, VEC4, or MAT4 of 32-bit numbers")),
    };
    let at = accessor.require("count")?;
    let count = at.count()?;
    if count > u32::MAX as usize {
        return Err(at.unexpected(format!("at most {}", u32::MAX)));
    }
    Ok(Layout {
        count,
        components,
        component,
        is_normalized: accessor.flag("normalized")?,
    })
}

/// Numbers of elements that are `stride` bytes apart; `bytes` are known to hold them all.
pub(super) fn decode(
    bytes: &[u8],
    count: usize,
    components: usize,
    stride: usize,
    (component, is_normalized): (Component, bool),
) -> Vec<f64> {
    let scaled = |most: f64| {
        move |c: f64| {
            if is_normalized {
                (c / most).max(-1.0)
            } else {
                c
            }
        }
    };
    let shape = (count, components, stride);
    match component {
        Component::I8 => read(bytes, shape, |b| {
            scaled(127.0)(f64::from(i8::from_le_bytes(b)))
        }),
        Component::U8 => read(bytes, shape, |b| {
            scaled(255.0)(f64::from(u8::from_le_bytes(b)))
        }),
        Component::I16 => read(bytes, shape, |b| {
            scaled(32_767.0)(f64::from(i16::from_le_bytes(b)))
        }),
        Component::U16 => read(bytes, shape, |b| {
            scaled(65_535.0)(f64::from(u16::from_le_bytes(b)))
        }),
        Component::U32 => read(bytes, shape, |b| f64::from(u32::from_le_bytes(b))),
        Component::F32 => read(bytes, shape, |b| f64::from(f32::from_le_bytes(b))),
    }
}

fn read<const N: usize>(
    bytes: &[u8],
    (count, components, stride): (usize, usize, usize),
    number: impl Fn([u8; N]) -> f64,
) -> Vec<f64> {
    let mut values = Vec::with_capacity(count * components);
    for element in (0..count).map(|i| &bytes[i * stride..][..components * N]) {
        let (numbers, _) = element.as_chunks::<N>();
        values.extend(numbers.iter().map(|&bytes| number(bytes)));
    }
    values
}
