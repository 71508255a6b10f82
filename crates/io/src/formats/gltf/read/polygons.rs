//! Polygons of a primitive, where an extension says which of its triangles are one.
//!
//! `FB_ngon_encoding`: consecutive triangles that begin at one vertex are the fan of a polygon. `EXT_mesh_polygon`, a draft: loops of
//! indices with the restart value between them, and for each polygon where its loops and its triangles begin. Its triangles are the
//! primitive's with the loops apart, or the loops are the primitive's with the triangles apart: both are in use.
//! Polygons whose triangles say more than a loop does, as they have holes or vertices inside, and triangles that are no fan, stay triangles.
//! Sources: <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/FB_ngon_encoding>,
//! <https://github.com/KhronosGroup/glTF/pull/2570>.

use super::mode::{Mode, checked};
use crate::flaw::{Flaw, Result};
use crate::formats::gltf::document::extensions::{LOOPS, NGONS};
use crate::formats::gltf::document::json::At;
use crate::formats::gltf::document::source::Source;
use limitmesh::mesh::PolygonFaces;
use std::collections::HashSet;
use std::ops::Range;

/// The faces of a primitive.
#[derive(Default)]
pub(super) struct Polygons {
    pub(super) faces: PolygonFaces,
    /// Polygons of which there are the triangles instead.
    pub(super) as_triangles: usize,
}

impl Polygons {
    /// Triangles alone.
    fn of_triangles(triangles: &[[u32; 3]]) -> Self {
        let mut all = Self {
            faces: PolygonFaces::with_capacity(triangles.len(), 3 * triangles.len()),
            as_triangles: 0,
        };
        all.add(triangles);
        all
    }

    /// Polygons whose fans are consecutive triangles.
    fn of_fans(triangles: &[[u32; 3]]) -> Self {
        let mut all = Self::default();
        let mut met = HashSet::new();
        for fan in triangles.chunk_by(|a, b| a[0] == b[0]) {
            let goes_on = fan.windows(2).all(|pair| pair[0][2] == pair[1][1]);
            let ends = fan.iter().map(|triangle| triangle[2]);
            let polygon: Vec<u32> = fan[0][..2].iter().copied().chain(ends).collect();
            met.clear();
            if fan.len() == 1 || goes_on && polygon.iter().all(|&v| met.insert(v)) {
                all.faces.push(&polygon);
            } else {
                all.add_cut(fan);
            }
        }
        all
    }

    fn add(&mut self, triangles: &[[u32; 3]]) {
        triangles.iter().for_each(|own| self.faces.push(own));
    }

    /// Adds the triangles of a polygon instead of it.
    fn add_cut(&mut self, triangles: &[[u32; 3]]) {
        self.add(triangles);
        self.as_triangles += 1;
    }
}

impl Source {
    /// The faces of the primitive at `at`, which has `count` vertices, given its triangles: these where polygons are not wanted.
    pub(super) fn polygons(
        &self,
        at: &At<'_>,
        mode: Mode,
        count: usize,
        are_wanted: bool,
        is_compressed: bool,
        triangles: impl FnOnce() -> Result<Vec<[u32; 3]>>,
    ) -> Result<Polygons> {
        let is_plain = mode == Mode::Triangles;
        let loops = at.path(&["extensions", LOOPS]);
        if let Some(extension) = loops.filter(|_| is_plain && are_wanted || mode == Mode::Loops) {
            if let (false, Some(own)) = (are_wanted, extension.get("triangleIndices")) {
                return Ok(Polygons::of_triangles(&self.triangles_of(&own, count)?));
            }
            return self.loops(at, &extension, mode, count, triangles);
        }
        let triangles = triangles()?;
        // Draco puts triangles in an order of its own.
        let is_in_order = is_plain && !is_compressed;
        let fans = at.path(&["extensions", NGONS]).filter(|_| are_wanted);
        Ok(match fans {
            Some(_) if is_in_order => Polygons::of_fans(&triangles),
            Some(_) => Polygons {
                as_triangles: triangles.len(),
                ..Polygons::of_triangles(&triangles)
            },
            None => Polygons::of_triangles(&triangles),
        })
    }

    /// The polygons of an `EXT_mesh_polygon`.
    fn loops(
        &self,
        primitive: &At<'_>,
        extension: &At<'_>,
        mode: Mode,
        vertices: usize,
        triangles: impl FnOnce() -> Result<Vec<[u32; 3]>>,
    ) -> Result<Polygons> {
        let at = extension.require("count")?;
        let count = at.count()?;
        // Where its loops and its triangles are, and where these begin for each polygon.
        let (loops, loop_offsets, triangles, triangle_offsets) = match mode {
            Mode::Loops => {
                let triangles = extension.get("triangleIndices");
                let triangles = triangles.map(|own| self.triangles_of(&own, vertices));
                let offsets = triangles.is_some().then_some("triangleIndicesOffsets");
                let loops = primitive.require("indices")?;
                (loops, "indicesOffsets", triangles.transpose()?, offsets)
            }
            _ => {
                let loops = extension.require("loopIndices")?;
                let offsets = Some("indicesOffsets");
                (loops, "loopIndicesOffsets", Some(triangles()?), offsets)
            }
        };
        let (indices, restart) = (self.integers(&loops)?, self.restart(&loops)?);
        let parts = self.ranges(extension, loop_offsets, count, indices.len())?;
        let triangles = triangles.as_deref().zip(triangle_offsets);
        let triangles = triangles.map(|(all, offsets)| {
            let ranges = self.ranges(extension, offsets, count, 3 * all.len())?;
            if let Some(own) = ranges.iter().find(|own| own.start % 3 != 0) {
                let at = extension.require(offsets)?;
                return Err(Flaw::new(at.place(), own.start, "multiples of 3"));
            }
            let own = ranges.into_iter();
            let own = own.map(|own| &all[own.start / 3..own.end / 3]);
            Ok(own.collect::<Vec<_>>())
        });
        let triangles = triangles.transpose()?;
        let mut all = Polygons::default();
        for (number, part) in parts.into_iter().enumerate() {
            let own = indices[part].split(|&v| v == restart);
            let own: Vec<&[u32]> = own.filter(|own| !own.is_empty()).collect();
            let cut = triangles.as_ref().map(|all| all[number]);
            match (&own[..], cut) {
                ([outline], cut) if is_whole(outline, cut) => {
                    let outline = checked(outline.to_vec(), vertices, &loops)?;
                    all.faces.push(&outline);
                }
                (_, Some(cut)) => all.add_cut(cut),
                (_, None) => {
                    let sizes: Vec<usize> = own.iter().map(|own| own.len()).collect();
                    let found = format!("polygon {number} with loops of {sizes:?} vertices");
                    let expected = "one loop of at least 3 vertices, or triangleIndices";
                    return Err(Flaw::new(extension.place(), found, expected));
                }
            }
        }
        Ok(all)
    }

    /// The triangles of an accessor.
    fn triangles_of(&self, at: &At<'_>, vertices: usize) -> Result<Vec<[u32; 3]>> {
        let corners = checked(self.integers(at)?, vertices, at)?;
        Ok(corners.as_chunks::<3>().0.to_vec())
    }

    /// The index that ends a loop: the highest that the accessor can have.
    fn restart(&self, at: &At<'_>) -> Result<u32> {
        let accessor = at.item_of(&self.root(), "accessors")?;
        Ok(match accessor.require("componentType")?.count()? {
            5121 => u8::MAX.into(),
            5123 => u16::MAX.into(),
            _ => u32::MAX,
        })
    }

    /// By polygon its part of `total` indices, given the accessor of where these begin.
    fn ranges(
        &self,
        extension: &At<'_>,
        key: &str,
        count: usize,
        total: usize,
    ) -> Result<Vec<Range<usize>>> {
        let at = extension.require(key)?;
        let starts = self.integers(&at)?;
        if starts.len() != count {
            let expected = format!("{count} elements (as many as there are polygons)");
            return Err(Flaw::new(at.place(), starts.len(), expected));
        }
        let starts: Vec<usize> = starts.into_iter().map(|start| start as usize).collect();
        let ends = starts.iter().skip(1).copied().chain([total]);
        let ranges: Vec<Range<usize>> = starts
            .iter()
            .zip(ends)
            .map(|(&start, end)| start..end)
            .collect();
        let is_bad = |own: &Range<usize>| own.start > own.end || own.end > total;
        let bad = ranges.iter().position(is_bad);
        let late = ranges.first().filter(|own| own.start != 0);
        match (late.map(|_| 0), bad) {
            (Some(i), _) | (None, Some(i)) => {
                let found = format!("{} in element {i}", starts[i]);
                let expected = format!("offsets that ascend from 0 to at most {total}");
                Err(Flaw::new(at.place(), found, expected))
            }
            (None, None) => Ok(ranges),
        }
    }
}

/// Whether a loop is all of a polygon: its triangles are as many as cut it without further vertices.
fn is_whole(outline: &[u32], triangles: Option<&[[u32; 3]]>) -> bool {
    outline.len() >= 3 && triangles.is_none_or(|all| all.len() + 2 == outline.len())
}
