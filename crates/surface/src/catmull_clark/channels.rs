//! Channels of polygons on the quads that they become: where a step divides polygons, smooth values take it, too.

use core::ops::Range;
use std::collections::HashMap;

use super::control::{Divided, Polygons, QuadControl};
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::{
    Channel, ChannelError, Domain, Fans, Interpolation, MeshError, PolygonSoup, SeamRule,
};
use crate::value_mesh::{ValueMesh, value_mesh};

/// Numbers that take the step together.
const TOGETHER: usize = 3;

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
        let fans = &self.fans;
        let topology = fans.mesh.topology();
        let is_middle = |h: HalfEdgeId| fans.centres.contains(&topology.origin(h).0);
        let mut trace = fans.trace.clone();
        for h in topology.half_edges().filter(|&h| is_middle(h)) {
            trace.corners[h.index()] = trace.corners[h.next().index()];
        }
        let mut own = channel.on_mesh(soup, &fans.mesh, &trace)?;
        let mut middles: HashMap<u32, u32> = HashMap::with_capacity(fans.centres.len());
        for h in topology.half_edges().filter(|&h| is_middle(h)) {
            let centre = topology.origin(h).0;
            let number = *middles.entry(centre).or_insert_with(|| {
                let corners = topology
                    .outgoing_ring(topology.origin(h))
                    .map(HalfEdgeId::next);
                let corners: Vec<u32> = corners.map(|corner| own.indices[corner.index()]).collect();
                for at in 0..own.arity {
                    let values = corners
                        .iter()
                        .map(|&i| own.values[i as usize * own.arity + at]);
                    let sum: f64 = values.sum();
                    own.values.push(sum / corners.len() as f64);
                }
                (own.values.len() / own.arity) as u32 - 1
            });
            own.indices[h.index()] = number;
        }
        Ok(own)
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
        let ValueMesh { mesh, values } = value_mesh(&fans.mesh, own, rule, is_side)?;
        let centres = self.middles(mesh.triangles());
        let (mut table, mut indices) = (Vec::new(), Vec::new());
        for first in (0..own.arity).step_by(TOGETHER) {
            let last = own.arity.min(first + TOGETHER);
            let position = |&value: &u32| {
                let mut position = [0.0; TOGETHER];
                let start = value as usize * own.arity;
                let part = &own.values[start + first..start + last];
                position
                    .iter_mut()
                    .zip(part)
                    .for_each(|(to, &from)| *to = from);
                position
            };
            let mesh = mesh
                .clone()
                .with_positions(values.iter().map(position).collect())?;
            let part = Fans {
                mesh,
                centres: centres.clone(),
                trace: fans.trace.clone(),
            };
            let quads = Polygons::of(&part)
                .refined(&part, self.smooth_triangles)?
                .mesh;
            table.resize(own.arity * quads.vertex_count(), 0.0);
            for (row, position) in table.chunks_exact_mut(own.arity).zip(quads.positions()) {
                row[first..last].copy_from_slice(&position[..last - first]);
            }
            let before = [fans.mesh.vertex_count(), values.len()];
            indices = as_cut(
                triangles,
                quads.triangles(),
                before.map(|count| count as u32),
            );
        }
        // Fans of one value stay where they are, and share it.
        let mut first_of: HashMap<u32, u32> = HashMap::new();
        let shared = (0..)
            .zip(&values)
            .map(|(fan, &value)| *first_of.entry(value).or_insert(fan));
        let shared: Vec<u32> = shared.collect();
        let width = own.arity;
        for index in &mut indices {
            let Some(&first) = shared.get(*index as usize) else {
                continue;
            };
            let row = |fan: u32| &table[fan as usize * width..][..width];
            if row(first) == row(*index) {
                *index = first;
            }
        }
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
