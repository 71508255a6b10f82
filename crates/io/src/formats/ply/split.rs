//! Vertices that stand once for each combination of values, for files that hold texture coordinates at vertices as others wrote them:
//! most programs read these there, or as lists of faces, but not both.
//!
//! Takes an output whose corners have the values, gives triangles of which vertices do. Numbers of vertices stay; copies follow.

use crate::capacity::Capacity;
use crate::output::Output;
use limitmesh::mesh::{Channel, Domain, Semantic, Storage};

/// No corner, or no vertex.
const NONE: u32 = u32::MAX;

/// Whether PLY files hold a channel as numbers of vertices, as the one did that it came from: it has a name for each.
pub(super) fn is_of_vertices(channel: &Channel) -> bool {
    channel.semantic == Semantic::TextureCoordinates
        && channel.name.split(',').count() == channel.arity
}

/// Whether a PLY file has vertices several times, since channels have texture coordinates that differ between corners there, and did so at
/// vertices in the file that they come from.
pub fn splits_vertices(channels: &[Channel], triangles: &[[u32; 3]], vertices: usize) -> bool {
    let fits = |own: &Channel| {
        own.check(vertices, 3 * triangles.len(), triangles.len())
            .is_ok()
    };
    let is_own = |own: &&Channel| own.domain == Domain::Corner && is_of_vertices(own) && fits(own);
    let own: Vec<&Channel> = channels.iter().filter(is_own).collect();
    !own.is_empty() && differ(&own, triangles, vertices)
}

/// Whether channels have two values at some vertex.
fn differ(channels: &[&Channel], triangles: &[[u32; 3]], count: usize) -> bool {
    let mut first = vec![NONE; count];
    triangles
        .as_flattened()
        .iter()
        .zip(0..)
        .any(|(&v, corner)| {
            let known = &mut first[v as usize];
            if *known == NONE {
                *known = corner;
            }
            !have_same(channels, *known, corner)
        })
}

/// Triangles of which corners have a vertex of their own for each combination of values.
pub(super) struct Split {
    pub(super) triangles: Vec<[u32; 3]>,
    /// By vertex, the one of the output that it is a copy of.
    pub(super) sources: Vec<u32>,
}

impl Split {
    /// An output's, if a PLY file of this capacity needs that.
    pub(super) fn of(output: &Output<'_>, capacity: &Capacity) -> Option<Self> {
        let (count, triangles) = (output.surface.positions.len(), output.surface.triangles);
        if !splits_vertices(output.channels, triangles, count) {
            return None;
        }
        let is_list =
            |own: &Channel| own.semantic == Semantic::TextureCoordinates && !is_of_vertices(own);
        let mut channels = capacity.held(output);
        channels.retain(|own| own.domain == Domain::Corner && !is_list(own));
        let mut sources: Vec<u32> = (0..count as u32).collect();
        // By vertex, the first corner that has it, and the next copy of the same vertex.
        let (mut first, mut next) = (vec![NONE; count], vec![NONE; count]);
        let mut triangles = triangles.to_vec();
        for (v, corner) in triangles.as_flattened_mut().iter_mut().zip(0u32..) {
            if first[*v as usize] == NONE {
                first[*v as usize] = corner;
                continue;
            }
            let source = *v;
            while !have_same(&channels, first[*v as usize], corner) {
                if next[*v as usize] == NONE {
                    next[*v as usize] = sources.len() as u32;
                    next.push(NONE);
                    sources.push(source);
                    first.push(corner);
                }
                *v = next[*v as usize];
            }
        }
        Some(Self { triangles, sources })
    }
}

/// Whether two corners have the same values in a file.
fn have_same(channels: &[&Channel], a: u32, b: u32) -> bool {
    channels.iter().all(|channel| {
        let [own, other] = [a, b].map(|corner| channel.value(corner as usize).iter());
        channel.indices[a as usize] == channel.indices[b as usize]
            || match channel.storage {
                Storage::Double => own.eq(other),
                _ => own.map(|&x| x as f32).eq(other.map(|&x| x as f32)),
            }
    })
}
