//! Accessors: numbers out of the bytes of buffer views, with every bound checked before room is made.
//!
//! An accessor without a view is zeros, which sparse values may replace.

use super::json::At;
use super::numbers::{Component, Layout, Numbers};
use super::source::Source;
use crate::flaw::{Flaw, Result};

impl Source {
    /// The numbers of an accessor, which `at` names by its index. If `expected` elements are, others are refused before
    /// anything is read.
    pub(crate) fn numbers(&self, at: &At<'_>, expected: Option<usize>) -> Result<Numbers> {
        let accessor = at.item_of(&self.root(), "accessors")?;
        let layout = layout(&accessor)?;
        let count = layout.count;
        if let Some(expected) = expected.filter(|&expected| expected != count) {
            let found = format!("{count}, from {}", accessor.place());
            let expected = format!("{expected} elements (as many as there are vertices)");
            return Err(Flaw::new(at.place(), found, expected));
        }
        let values = || {
            let mut values = match accessor.get("bufferView") {
                Some(view) => self.elements(&accessor, &view, layout)?,
                None => {
                    self.check_zeros()?;
                    vec![0.0; count * layout.components]
                }
            };
            if let Some(sparse) = accessor.get("sparse") {
                self.replace(&sparse, layout, &mut values)?;
            }
            Ok(values)
        };
        let values = values().map_err(|flaw: Flaw| flaw.met_from(at.place()))?;
        Ok(layout.numbers(values))
    }

    /// The whole numbers of an accessor, such as indices.
    pub(crate) fn integers(&self, at: &At<'_>) -> Result<Vec<u32>> {
        let accessor = at.item_of(&self.root(), "accessors")?;
        let layout = layout(&accessor)?;
        if !layout.component.is_index() || layout.components != 1 {
            let problem = "indices are unsigned whole numbers, one an element";
            return Err(Flaw::saying(accessor.place(), problem));
        }
        let numbers = self.numbers(at, None)?;
        Ok(numbers.values.into_iter().map(|x| x as u32).collect())
    }

    /// Elements in a view, from the `byteOffset` of what names it.
    fn elements(&self, owner: &At<'_>, view: &At<'_>, layout: Layout) -> Result<Vec<f64>> {
        let found = self.view(view)?;
        let (count, size) = (layout.count, layout.size());
        let stride = found.stride.unwrap_or(size);
        if stride < size {
            let problem =
                format!("its elements of {size} bytes overlap: the view has a stride of {stride}");
            return Err(Flaw::saying(owner.place(), problem));
        }
        let start = owner.count_or("byteOffset", 0)?;
        let end = match count.checked_sub(1) {
            Some(last) => last
                .checked_mul(stride)
                .and_then(|at| at.checked_add(size)?.checked_add(start)),
            None => Some(start),
        };
        let bytes = end.and_then(|end| found.bytes.get(start..end)).ok_or_else(|| {
            let problem = format!(
                "it has {count} elements of {size} bytes, {stride} apart, from byte {start} on, but the view has {} bytes",
                found.bytes.len()
            );
            Flaw::saying(owner.place(), problem)
        })?;
        Ok(layout.decode(bytes, stride))
    }

    /// Puts sparse values in their places.
    fn replace(&self, sparse: &At<'_>, layout: Layout, all: &mut [f64]) -> Result<()> {
        let at = sparse.require("count")?;
        let count = at.count()?;
        if count > layout.count {
            let expected = format!("at most {} (the accessor's count)", layout.count);
            return Err(at.unexpected(expected));
        }
        let (places, values) = (sparse.require("indices")?, sparse.require("values")?);
        let component = component(&places)?;
        if !component.is_index() {
            let component = places.require("componentType")?;
            return Err(component.unexpected("unsigned whole numbers"));
        }
        let of_places = Layout {
            count,
            components: 1,
            component,
            is_normalized: false,
        };
        let indices = self.elements(&places, &places.require("bufferView")?, of_places)?;
        let of_values = Layout { count, ..layout };
        let new = self.elements(&values, &values.require("bufferView")?, of_values)?;
        let width = layout.components;
        for (i, (index, new)) in indices.into_iter().zip(new.chunks_exact(width)).enumerate() {
            let index = index as usize;
            let Some(old) = all.get_mut(index * width..(index + 1) * width) else {
                let found = format!("{index} in element {i}");
                let expected = format!("indices below {}", layout.count);
                return Err(Flaw::new(places.place(), found, expected));
            };
            old.copy_from_slice(new);
        }
        Ok(())
    }
}

fn component(at: &At<'_>) -> Result<Component> {
    let code = at.require("componentType")?;
    let found = Component::of(code.count()?);
    found.ok_or_else(|| code.unexpected("5120, 5121, 5122, 5123, 5125 or 5126"))
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
