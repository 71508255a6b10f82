//! Channels of polygons on the quads that they become: where a step divides polygons, smooth values take it, too.

use core::ops::Range;
use std::collections::HashMap;

use super::control::{Divided, Polygons, QuadControl};
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::{
    Channel, ChannelError, Domain, Fans, Interpolation, MeshError, NONE, PolygonFaces, PolygonSoup,
    SeamRule, Semantic,
};
use crate::value_mesh::{ValueMesh, value_mesh};

impl QuadControl {
    /// A channel of the soup that the quads were made of on their mesh. Where a step divided polygons, new values are means, and those of
    /// smooth channels the scheme's.
    ///
    /// # Errors
    /// The channel does not fit the soup, or has more values than can be numbered.
    pub fn channel(&self, soup: &PolygonSoup, channel: &Channel) -> Result<Channel, ChannelError> {
        let by_means = channel.on_mesh(soup, &self.mesh, &self.trace)?;
        match (&self.divided, channel.interpolation) {
            (Some(divided), Interpolation::Smooth(rule)) if channel.domain != Domain::Face => {
                let own = divided.on_fans(soup, channel)?;
                let stepped = divided.stepped(&own, rule, self.mesh.triangles());
                let (values, indices) = stepped.map_err(|error| no_step(channel, &error))?;
                Ok(by_means.with(values, indices))
            }
            _ => Ok(by_means),
        }
    }

    /// Where the vertices of the mesh are for other positions of the vertices of `soup`, the one that the quads were made of: for the
    /// frames of an animation.
    ///
    /// # Errors
    /// Another number of positions than the soup has.
    pub fn positions(
        &self,
        soup: &PolygonSoup,
        positions: &[[f64; 3]],
    ) -> Result<Vec<[f64; 3]>, ChannelError> {
        let values = positions.as_flattened().to_vec();
        let all = Channel::new("positions", Semantic::Displacement, Domain::Vertex, 3)
            .with(values, (0..positions.len() as u32).collect());
        let all = self.channel(soup, &all)?;
        let mut found = vec![[0.0; 3]; self.mesh.vertex_count()];
        for (corner, &vertex) in self.mesh.triangles().as_flattened().iter().enumerate() {
            if let [x, y, z] = *all.value(corner) {
                found[vertex as usize] = [x, y, z];
            }
        }
        Ok(found)
    }
}

fn no_step(channel: &Channel, error: &MeshError) -> ChannelError {
    ChannelError::Limit {
        name: channel.name.clone(),
        why: error.to_string(),
    }
}

/// Values, and by corner the number of its own.
type Table = (Vec<f64>, Vec<u32>);

impl Divided {
    /// A channel on the fans; in the middle of a polygon it has the mean of its corners.
    fn on_fans(&self, soup: &PolygonSoup, channel: &Channel) -> Result<Channel, ChannelError> {
        let (fans, topology) = (&self.fans, self.fans.mesh.topology());
        let (mut trace, mut rows) = (fans.trace.clone(), PolygonFaces::default());
        let mut of_middles = vec![NONE; fans.centres.len()];
        for h in topology.half_edges() {
            let corner = |h: HalfEdgeId| fans.trace.corners[h.index()];
            let row = rows.len() as u32;
            let middle = topology.origin(h).0.checked_sub(fans.centres.start);
            match middle.and_then(|middle| of_middles.get_mut(middle as usize)) {
                None => rows.push(&[corner(h)]),
                Some(known) if *known != NONE => {
                    trace.between.push(*known);
                    continue;
                }
                Some(known) => {
                    *known = row;
                    rows.push(&fans.sides(h.next()).map(corner).collect::<Vec<_>>());
                }
            }
            trace.between.push(row);
        }
        trace.rows = rows;
        channel.on_mesh(soup, &fans.mesh, &trace)
    }

    /// The step of a channel on the fans, by corner of the triangles that positions have after it.
    fn stepped(
        &self,
        own: &Channel,
        rule: SeamRule,
        triangles: &[[u32; 3]],
    ) -> Result<Table, MeshError> {
        let fans = &self.fans;
        let is_side = |h: HalfEdgeId| fans.side(h.face()) == Some(h);
        let values = value_mesh(&fans.mesh, own, rule, is_side)?;
        let before = [fans.mesh.vertex_count(), values.values.len()].map(|count| count as u32);
        let (mut table, mut indices) = (Vec::new(), Vec::new());
        for first in (0..own.arity).step_by(ValueMesh::TOGETHER) {
            let part = Fans {
                mesh: values.with_numbers(own, first)?,
                centres: self.middles(values.mesh.triangles()),
                trace: fans.trace.clone(),
            };
            let polygons = Polygons::of(&part);
            let quads = polygons.refined(&part, self.smooth_triangles)?.mesh;
            table.resize(own.arity * quads.vertex_count(), 0.0);
            for (row, position) in table.chunks_exact_mut(own.arity).zip(quads.positions()) {
                let left = &mut row[first..];
                let count = left.len().min(ValueMesh::TOGETHER);
                left[..count].copy_from_slice(&position[..count]);
            }
            indices = as_cut(triangles, quads.triangles(), before);
        }
        share(&mut indices, &values.values, &table, own.arity);
        Ok((table, indices))
    }

    /// The vertices of a value mesh that are in the middles of polygons: as those of the fans they follow each other.
    fn middles(&self, triangles: &[[u32; 3]]) -> Range<u32> {
        let middle = |face: u32| {
            let side = self.fans.side(FaceId(face))?;
            Some(triangles[face as usize][side.previous().corner()])
        };
        let all = || (0..triangles.len() as u32).filter_map(middle);
        let (first, last) = (all().min(), all().max());
        first.unwrap_or(0)..last.map_or(0, |last| last + 1)
    }
}

/// Gives fans of one value one number again where they have stayed where they were.
fn share(indices: &mut [u32], values: &[u32], table: &[f64], arity: usize) {
    let mut first_of: HashMap<u32, u32> = HashMap::new();
    let firsts = (0..)
        .zip(values)
        .map(|(fan, &value)| *first_of.entry(value).or_insert(fan));
    let firsts: Vec<u32> = firsts.collect();
    let row = |fan: u32| &table[fan as usize * arity..][..arity];
    for index in indices {
        if let Some(&first) = firsts.get(*index as usize)
            && row(first) == row(*index)
        {
            *index = first;
        }
    }
}

/// The corners of quads for those of others that may be cut by their other diagonals, both after a step, before which there were so many
/// vertices.
fn as_cut(others: &[[u32; 3]], own: &[[u32; 3]], [other_count, count]: [u32; 2]) -> Vec<u32> {
    let mut corners = Vec::with_capacity(3 * own.len());
    let pairs = others.as_chunks::<2>().0.iter().zip(own.as_chunks::<2>().0);
    for (other, &[first, second]) in pairs {
        // A quad begins at the vertex that it keeps, or turned by one at the middle of a side.
        let turn = usize::from(first[0] >= count) + 4 - usize::from(other[0][0] >= other_count);
        let quad = [first[0], first[1], second[0], first[2]];
        // As `halves` has them.
        corners.extend([0, 1, 3, 2, 3, 1].map(|i| quad[(i + 8 - turn) % 4]));
    }
    corners
}
