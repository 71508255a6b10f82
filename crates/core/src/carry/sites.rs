//! The values of a channel of corners on a refined mesh, and their numbers by corner.
//!
//! Nearly all vertices have one value on all sides: those are numbered first, in the order of the
//! vertices. Vertices on seams have several, which follow in the order in which corners have them.

use core::ops::Range;

use super::places::{Key, Places};
use crate::geometry::NONE;
use crate::mesh::{Channel, ChannelError};
use crate::refine::Origin;

/// In place of a value's number: at this vertex there may be several.
const SEVERAL: u32 = u32::MAX;

/// The values of a channel: their sources and their vertices.
pub(super) struct Sites<'a> {
    /// A value's number by corner.
    pub(super) indices: Vec<u32>,
    /// The vertices of those that are their vertices' only ones.
    vertices: Vec<u32>,
    origins: &'a [Origin],
    /// Where the others are, each in a face in which a corner has it.
    others: Vec<Origin>,
}

impl<'a> Sites<'a> {
    /// # Errors
    /// It is not known where a corner is.
    pub(super) fn of(channel: &Channel, places: &Places<'a>) -> Result<Self, ChannelError> {
        let origins = places.origins();
        let mut vertices = Vec::with_capacity(origins.len());
        let mut of_vertex = vec![SEVERAL; origins.len()];
        places.for_each_vertex_of_one_value(channel, |vertex| {
            of_vertex[vertex] = vertices.len() as u32;
            vertices.push(vertex as u32);
        });
        let corners = places.corners();
        if vertices.len() == origins.len() {
            return Ok(Self {
                indices: corners.to_vec(),
                vertices,
                origins,
                others: Vec::new(),
            });
        }
        let mut others: Vec<Origin> = Vec::new();
        // The sources of each item, and the previous item of its vertex; by vertex, the last.
        let mut chained: Vec<(Key, u32)> = Vec::new();
        let mut last = vec![NONE; origins.len()];
        let mut indices = Vec::with_capacity(corners.len());
        for (corner, &vertex) in corners.iter().enumerate() {
            let only = of_vertex[vertex as usize];
            if only != SEVERAL {
                indices.push(only);
                continue;
            }
            let origin = places.known_place(corner)?;
            let key = places.key(channel, origin);
            let last = &mut last[vertex as usize];
            let mut other = *last;
            while other != NONE && chained[other as usize].0 != key {
                other = chained[other as usize].1;
            }
            if other == NONE {
                other = others.len() as u32;
                others.push(origin);
                chained.push((key, *last));
                *last = other;
            }
            indices.push(vertices.len() as u32 + other);
        }
        Ok(Self {
            indices,
            vertices,
            origins,
            others,
        })
    }

    /// How many values there are.
    pub(super) fn len(&self) -> usize {
        self.vertices.len() + self.others.len()
    }

    /// Where a value is.
    pub(super) fn origin(&self, number: u32) -> &Origin {
        let number = number as usize;
        match self.vertices.get(number) {
            Some(&vertex) => &self.origins[vertex as usize],
            None => &self.others[number - self.vertices.len()],
        }
    }

    /// Where all values are, in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Origin> {
        self.vertices
            .iter()
            .map(|&vertex| &self.origins[vertex as usize])
            .chain(&self.others)
    }

    /// The values by face, of which there are `faces`.
    pub(super) fn by_face(&self, faces: usize) -> SitesByFace<'_> {
        let mut runs: Vec<(u32, Range<u32>)> = Vec::new();
        let (mut own, mut number) = ((0, 0..0), 0);
        self.iter().for_each(|origin| {
            if origin.face != own.0 {
                runs.push(core::mem::replace(&mut own, (origin.face, number..number)));
            }
            number += 1;
            own.1.end = number;
        });
        if number > 0 {
            runs.push(own);
        }
        // A stable sort: runs of a face stay in order.
        runs.sort_by_key(|(face, _)| *face);
        let mut starts = vec![0; faces + 1];
        runs.iter()
            .for_each(|(face, _)| starts[*face as usize + 1] += 1);
        (0..faces).for_each(|face| starts[face + 1] += starts[face]);
        SitesByFace {
            sites: self,
            starts,
            runs,
        }
    }
}

/// Values in the order of their faces.
pub(super) struct SitesByFace<'a> {
    sites: &'a Sites<'a>,
    /// Where the runs of each face start, and the end.
    starts: Vec<usize>,
    /// Runs of values, with their faces; a refined mesh numbers most vertices of a face one after the other.
    runs: Vec<(u32, Range<u32>)>,
}

impl SitesByFace<'_> {
    /// Calls `visit` with the place of each value of a face.
    pub(super) fn for_each_place(&self, face: usize, mut visit: impl FnMut([f64; 3])) {
        for (_, run) in &self.runs[self.starts[face]..self.starts[face + 1]] {
            run.clone()
                .for_each(|number| visit(self.sites.origin(number).barycentric));
        }
    }

    /// Calls `visit` with the numbers of all values, face by face.
    pub(super) fn for_each_number(&self, mut visit: impl FnMut(usize)) {
        self.runs
            .iter()
            .for_each(|(_, run)| (run.start as usize..run.end as usize).for_each(&mut visit));
    }
}
