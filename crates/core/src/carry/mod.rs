//! Channels carried from a control mesh to what was refined from it.
//!
//! Takes channels of the control mesh, and a refined mesh whose triangles each come from one control face and whose vertices know where
//! on the control mesh they came from; gives the channels of the refined mesh. Linear ones are linear over each control face, so exact on
//! every triangle; smooth ones take their values from the limit surface of a mesh of values with the same faces (`seams`), at the
//! same places as the vertices: a channel whose values are positions gives the vertices' positions. Where control faces meet, corners
//! of the refined mesh have one value if the channel has one there, so seams run where they ran, and there alone.

mod borders;
mod places;
mod seams;

pub use borders::borders;

use std::collections::HashMap;

use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::mesh::{Channel, ChannelError, Domain, Interpolation, Mesh, SeamRule};
use crate::refine::{AttributeGoal, Origin, Traced};
use crate::scheme::Scheme;
use places::Places;
use seams::value_mesh;

/// Numbers that are evaluated together: a value mesh has as many coordinates.
const TOGETHER: usize = 3;

/// The channels of a refined mesh: of its corners, or of its faces, in the order of the control mesh's.
///
/// `result` must have origins and parents
/// ([`ExactOptions::origins`](crate::refine::ExactOptions::origins), [`UniformOptions::origins`](crate::refine::UniformOptions::origins)), and no flat regions
/// that were triangulated from their rims ([`ExactOptions::flat_regions`](crate::refine::ExactOptions::flat_regions)), unless all channels
/// are of faces. If it is optimised, [`borders`] must have been kept; its triangles reach over several control faces, so values are exact at
/// its corners, and linear channels bend at control edges inside of triangles where these do not.
///
/// ```
/// use limitmesh::carry::carried;
/// use limitmesh::mesh::{Channel, Domain, Semantic};
/// use limitmesh::refine::{ExactOptions, exact};
/// use limitmesh::{Mesh, scheme::Loop};
///
/// // A square of two triangles, and a texture that covers it.
/// let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// let square = Mesh::from_triangles(corners.map(|[x, y]| [x, y, 0.0]).to_vec(), vec![[0, 1, 2], [0, 2, 3]])?;
/// let texture = Channel::new("uv", Semantic::TextureCoordinates, Domain::Corner, 2)
///     .with(corners.concat(), vec![0, 1, 2, 0, 2, 3]);
///
/// let options = ExactOptions::default().tolerance(1e-3).flat_regions(false);
/// let fine = exact(&square, &Loop, &options)?;
/// let textures = carried(&[texture], &square, &Loop, &fine)?;
/// assert_eq!(textures[0].indices.len(), 3 * fine.mesh.face_count());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A channel does not fit the control mesh, the result does not know where its triangles are from, or the scheme has no limit for a
/// smooth channel.
pub fn carried(
    channels: &[Channel],
    control: &Mesh,
    scheme: &dyn Scheme,
    result: &dyn Traced,
) -> Result<Vec<Channel>, ChannelError> {
    let is_by_face = channels.iter().all(|channel| channel.domain == Domain::Face);
    let places = Places::of(control, result, is_by_face)?;
    channels.iter().map(|channel| one(channel, control, scheme, &places)).collect()
}

fn one(
    channel: &Channel,
    control: &Mesh,
    scheme: &dyn Scheme,
    places: &Places<'_>,
) -> Result<Channel, ChannelError> {
    let corners = control.topology().half_edge_count();
    channel.check(control.vertex_count(), corners, control.face_count())?;
    if channel.domain == Domain::Face {
        let indices = places.parents.iter().map(|&face| channel.indices[face as usize]).collect();
        return Ok(Channel { indices, ..channel.clone() });
    }
    let by_corner = by_corner(channel, control);
    match by_corner.interpolation {
        Interpolation::Nearest => nearest(by_corner, places),
        Interpolation::Linear => {
            let (indices, wanted) = wanted(&by_corner, places)?;
            let values = linear(&by_corner, &wanted);
            Ok(Channel { indices, values, ..by_corner })
        }
        Interpolation::Smooth(rule) => {
            let (indices, wanted) = wanted(&by_corner, places)?;
            let values = smooth(&by_corner, rule, control, scheme, &wanted)?;
            Ok(Channel { indices, values, ..by_corner })
        }
    }
}

/// The goal that the triangles' own values of a channel, linear between their corners, be within a tolerance of it everywhere
/// ([`ExactOptions::attributes`](crate::refine::ExactOptions::attributes)); `None` for channels that are not smooth: linear ones are met by
/// any triangles, and names have no distance.
///
/// # Errors
/// The channel does not fit the mesh, or has more fans than can be numbered.
pub fn goal(
    channel: &Channel,
    control: &Mesh,
    tolerance: f64,
) -> Result<Option<AttributeGoal>, ChannelError> {
    let corners = control.topology().half_edge_count();
    channel.check(control.vertex_count(), corners, control.face_count())?;
    let Interpolation::Smooth(rule) = channel.interpolation else { return Ok(None) };
    if channel.domain == Domain::Face {
        return Ok(None);
    }
    let by_corner = by_corner(channel, control);
    let values = ValueMeshes::of(&by_corner, rule, control)?;
    let meshes =
        (0..channel.arity).step_by(TOGETHER).map(|first| values.mesh(first)).collect::<Result<_, _>>()?;
    Ok(Some(AttributeGoal::values(meshes, tolerance)))
}

/// A channel of vertices as one of corners.
fn by_corner(channel: &Channel, control: &Mesh) -> Channel {
    match channel.domain {
        Domain::Vertex => {
            let vertices = control.triangles().as_flattened();
            let indices = vertices.iter().map(|&vertex| channel.indices[vertex as usize]).collect();
            Channel { indices, domain: Domain::Corner, ..channel.clone() }
        }
        _ => channel.clone(),
    }
}

/// Each corner has the value of the nearest corner of its control face, the first of those that are as near.
fn nearest(channel: Channel, places: &Places<'_>) -> Result<Channel, ChannelError> {
    let mut indices = Vec::with_capacity(3 * places.parents.len());
    places.for_each_corner(|_, Origin { face, barycentric }| {
        let mut first = 0;
        for corner in 1..3 {
            if barycentric[corner] > barycentric[first] {
                first = corner;
            }
        }
        indices.push(channel.indices[3 * face as usize + first]);
    })?;
    Ok(Channel { indices, ..channel })
}

/// A value's number by corner, and where each value is to be found: in a face in which a corner has it.
fn wanted(channel: &Channel, places: &Places<'_>) -> Result<(Vec<u32>, Vec<Wanted>), ChannelError> {
    let mut wanted: Vec<Wanted> = Vec::with_capacity(places.vertex_count);
    let mut add = |origin: Origin| {
        wanted.push((FaceId(origin.face), origin.barycentric));
        wanted.len() as u32 - 1
    };
    // Most vertices have one value, wherever one looks at them from.
    let mut of_vertex = vec![SEVERAL; places.vertex_count];
    places.for_each_vertex_of_one_value(channel, |vertex, origin| of_vertex[vertex] = add(origin));
    let mut others: HashMap<(u32, Key), u32> = HashMap::new();
    let mut indices: Vec<u32> = places.corners().iter().map(|&vertex| of_vertex[vertex as usize]).collect();
    places.for_each_corner_of(&mut indices, |vertex, origin| {
        *others.entry((vertex, places.key(channel, origin))).or_insert_with(|| add(origin))
    })?;
    Ok((indices, wanted))
}

/// In place of a value's number: at this vertex there may be several.
const SEVERAL: u32 = u32::MAX;

/// The numbers of the values at the control vertices of the face, edge or vertex that a place is in: what it depends on where
/// channels are linear, and on which side of seams it is.
type Key = [u32; 3];

/// Where a value is to be found.
type Wanted = (FaceId, [f64; 3]);

fn linear(channel: &Channel, wanted: &[Wanted]) -> Vec<f64> {
    let mut values = Vec::with_capacity(channel.arity * wanted.len());
    for (face, barycentric) in wanted {
        let corners = [0, 1, 2].map(|corner| channel.value(3 * face.index() + corner));
        for i in 0..channel.arity {
            // What is at a corner, or the same at all, is that to the bit.
            let [a, b, c] = corners.map(|value| value[i]);
            let is_one = a == b && b == c;
            let sum = barycentric[0] * a + barycentric[1] * b + barycentric[2] * c;
            values.push(if is_one { a } else { sum });
        }
    }
    values
}

/// The mesh of a channel's values, with some of their numbers as its positions.
struct ValueMeshes<'a> {
    channel: &'a Channel,
    mesh: Mesh,
    /// By vertex, the channel's value.
    values: Vec<u32>,
}

impl<'a> ValueMeshes<'a> {
    fn of(channel: &'a Channel, rule: SeamRule, control: &Mesh) -> Result<Self, ChannelError> {
        let seams::ValueMesh { mesh, values } =
            value_mesh(control, channel, rule).map_err(|error| no_limit(channel, error))?;
        Ok(Self { channel, mesh, values })
    }

    /// The one whose positions are the numbers from `first` on, and zeros where there are no more.
    fn mesh(&self, first: usize) -> Result<Mesh, ChannelError> {
        let last = self.channel.arity.min(first + TOGETHER);
        let coordinates = |&value: &u32| {
            let mut position = [0.0; TOGETHER];
            let start = value as usize * self.channel.arity;
            let own = &self.channel.values[start + first..start + last];
            position.iter_mut().zip(own).for_each(|(x, &value)| *x = value);
            position
        };
        let positions = self.values.iter().map(coordinates).collect();
        self.mesh.clone().with_positions(positions).map_err(|error| no_limit(self.channel, error))
    }
}

fn no_limit(channel: &Channel, why: impl ToString) -> ChannelError {
    ChannelError::Limit { name: channel.name.clone(), why: why.to_string() }
}

/// Values of the limit surface of the mesh of values.
fn smooth(
    channel: &Channel,
    rule: SeamRule,
    control: &Mesh,
    scheme: &dyn Scheme,
    wanted: &[Wanted],
) -> Result<Vec<f64>, ChannelError> {
    let values = ValueMeshes::of(channel, rule, control)?;
    let mut found = Vec::new();
    for first in (0..channel.arity).step_by(TOGETHER) {
        let mesh = values.mesh(first)?;
        let surface =
            LimitSurface::without_normals(&mesh, scheme).map_err(|error| no_limit(channel, error))?;
        let own = first..channel.arity.min(first + TOGETHER);
        let coordinates = surface.coordinates(wanted, own.len());
        if let Some(error) = surface.failure() {
            return Err(no_limit(channel, error));
        }
        if channel.arity <= TOGETHER {
            return Ok(coordinates);
        }
        found.resize(channel.arity * wanted.len(), 0.0);
        for (point, value) in coordinates.chunks_exact(own.len()).zip(found.chunks_exact_mut(channel.arity)) {
            value[own.clone()].copy_from_slice(point);
        }
    }
    Ok(found)
}
