//! Carries channels from a control mesh to its refinement.
//!
//! Takes channels of the control mesh, and a refined mesh whose triangles each come from one
//! control face and whose vertices have origins on the control mesh; gives the channels of the
//! refined mesh. Linear ones are linear over each control face, so exact on every triangle, and over quads bilinear; smooth
//! ones take their values from the limit surface of a mesh of values with the same faces (`value_mesh`),
//! at the same places as the vertices: a channel whose values are positions gives the vertices'
//! positions. Where control faces meet, corners of the refined mesh have one value if the channel
//! has one there, so seams run only where they ran before.

mod borders;
mod places;
mod sites;

pub use borders::borders;

use crate::limit_surface::LimitSurface;
use crate::mesh::{Channel, ChannelError, Domain, Interpolation, Mesh, SeamRule};
use crate::refine::{AttributeGoal, Origin, Traced};
use crate::scheme::Scheme;
use crate::value_mesh::{ValueMesh, value_mesh};
use places::Places;
use sites::{Sites, SitesByFace};

/// Numbers that are evaluated together.
const TOGETHER: usize = ValueMesh::TOGETHER;

/// The channels of a refined mesh: of its corners, or of its faces, in the order of the control mesh's.
///
/// `result` must have origins and parents
/// ([`ExactOptions::origins`](crate::refine::ExactOptions::origins),
/// [`UniformOptions::origins`](crate::refine::UniformOptions::origins)), and no flat regions that
/// were triangulated from their rims
/// ([`ExactOptions::flat_regions`](crate::refine::ExactOptions::flat_regions)), unless all channels
/// are of faces, whose [`borders`] were kept, or constant. If it
/// is optimised, [`borders`] must have been kept; its triangles cover parts of several control
/// faces, so values are exact at its corners, and linear channels bend at control edges inside of
/// triangles where these do not.
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
/// A channel does not fit the control mesh, the result has no parents of its triangles, or the
/// scheme has no limit for a smooth channel.
pub fn carried(
    channels: &[Channel],
    control: &Mesh,
    scheme: &dyn Scheme,
    result: &dyn Traced,
) -> Result<Vec<Channel>, ChannelError> {
    let is_by_face = channels
        .iter()
        .all(|channel| !channel.varies_within_faces());
    let places = Places::of(control, result, is_by_face)?;
    channels
        .iter()
        .map(|channel| one(channel, control, scheme, &places))
        .collect()
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
        let indices = places
            .parents
            .iter()
            .map(|&face| channel.indices[face as usize])
            .collect();
        let mut by_face = channel.clone();
        by_face.indices = indices;
        return Ok(by_face);
    }
    if channel.is_constant() {
        let mut by_corner = channel.clone();
        by_corner.domain = Domain::Corner;
        return Ok(by_corner.with(channel.value(0).to_vec(), vec![0; places.corners().len()]));
    }
    let by_corner = by_corner(channel, control);
    match by_corner.interpolation {
        Interpolation::Nearest => nearest(by_corner, places),
        Interpolation::Linear => {
            let sites = Sites::of(&by_corner, places)?;
            let values = linear(&by_corner, control, &sites);
            Ok(by_corner.with(values, sites.indices))
        }
        Interpolation::Smooth(rule) => {
            let sites = Sites::of(&by_corner, places)?;
            let values = smooth(&by_corner, rule, control, scheme, &sites)?;
            Ok(by_corner.with(values, sites.indices))
        }
    }
}

/// The goal that the triangles' values of a channel, linear between their corners, are within a
/// tolerance of it everywhere
/// ([`Goals::attributes`](crate::refine::Goals::attributes)); `None` for channels
/// that are not smooth: linear ones are met by any triangles, and names have no distance.
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
    let Interpolation::Smooth(rule) = channel.interpolation else {
        return Ok(None);
    };
    if channel.domain == Domain::Face {
        return Ok(None);
    }
    let by_corner = by_corner(channel, control);
    let values = values_of(&by_corner, rule, control)?;
    let mesh = |first| values.with_numbers(&by_corner, first);
    let meshes = (0..channel.arity)
        .step_by(TOGETHER)
        .map(|first| mesh(first).map_err(|error| no_limit(channel, error)))
        .collect::<Result<_, _>>()?;
    Ok(Some(AttributeGoal::values(meshes, tolerance)))
}

/// A channel of vertices as one of corners.
fn by_corner(channel: &Channel, control: &Mesh) -> Channel {
    let mut by_corner = channel.clone();
    if channel.domain == Domain::Vertex {
        let vertices = control.triangles().as_flattened().iter();
        by_corner.domain = Domain::Corner;
        by_corner.indices = vertices.map(|&v| channel.indices[v as usize]).collect();
    }
    by_corner
}

/// Each corner has the value of the nearest corner of its control face, the first of those that are as near.
fn nearest(mut channel: Channel, places: &Places<'_>) -> Result<Channel, ChannelError> {
    let of_corner = |corner: usize| {
        let Origin { face, barycentric } = places.known_place(corner)?;
        let mut first = 0;
        for corner in 1..3 {
            if barycentric[corner] > barycentric[first] {
                first = corner;
            }
        }
        Ok(channel.indices[3 * face as usize + first])
    };
    channel.indices = (0..places.corners().len())
        .map(of_corner)
        .collect::<Result<_, _>>()?;
    Ok(channel)
}

/// Values that are linear over the control faces, and bilinear over quads.
fn linear(channel: &Channel, control: &Mesh, sites: &Sites<'_>) -> Vec<f64> {
    let mut values = limitmesh_pages::with_capacity(channel.arity * sites.len());
    let has_quads = control.topology().has_quads();
    for &Origin { face, barycentric } in sites.iter() {
        let [first, second, third] =
            [0, 1, 2].map(|corner| channel.value(3 * face as usize + corner));
        let [at_first, at_second, at_third] = barycentric;
        // The corner beyond the diagonal. It counts nothing on the edges of the quad.
        let (beyond, twist) = match has_quads {
            true => (channel.value(3 * (face ^ 1) as usize), at_second * at_third),
            false => (first, 0.0),
        };
        for (((&a, &b), &c), &d) in first.iter().zip(second).zip(third).zip(beyond) {
            // A value that is equal at all corners is copied to the bit.
            let is_one = a == b && b == c && (twist == 0.0 || c == d);
            let sum = at_first * a + at_second * b + at_third * c;
            let sum = if twist == 0.0 {
                sum
            } else {
                sum + twist * (a - b + d - c)
            };
            values.push(if is_one { a } else { sum });
        }
    }
    values
}

/// The mesh of a channel's values.
fn values_of(channel: &Channel, rule: SeamRule, control: &Mesh) -> Result<ValueMesh, ChannelError> {
    // A quad counts once, by its own edge at a vertex.
    let begins_face = |h| !control.topology().is_diagonal(h);
    value_mesh(control, channel, rule, begins_face).map_err(|error| no_limit(channel, error))
}

fn no_limit(channel: &Channel, why: impl ToString) -> ChannelError {
    ChannelError::Limit {
        name: channel.name.clone(),
        why: why.to_string(),
    }
}

/// Values of the limit surface of the mesh of values.
fn smooth(
    channel: &Channel,
    rule: SeamRule,
    control: &Mesh,
    scheme: &dyn Scheme,
    sites: &Sites<'_>,
) -> Result<Vec<f64>, ChannelError> {
    let own = values_of(channel, rule, control)?;
    let by_face = sites.by_face(control.face_count());
    let places = |face: usize, visit: &mut dyn FnMut([f64; 3])| by_face.for_each_place(face, visit);
    let mut values = limitmesh_pages::defaults(channel.arity * sites.len());
    for first in (0..channel.arity).step_by(TOGETHER) {
        let mesh = own
            .with_numbers(channel, first)
            .map_err(|error| no_limit(channel, error))?;
        let surface = LimitSurface::without_normals(&mesh, scheme)
            .map_err(|error| no_limit(channel, error))?;
        let own = (channel.arity, first);
        match channel.arity - first {
            1 => put(&mut values, own, &by_face, surface.coordinates::<1>(places)),
            2 => put(&mut values, own, &by_face, surface.coordinates::<2>(places)),
            _ => put(
                &mut values,
                own,
                &by_face,
                surface.coordinates::<TOGETHER>(places),
            ),
        }
        if let Some(error) = surface.failure() {
            return Err(no_limit(channel, error));
        }
    }
    Ok(values)
}

/// Puts some numbers of each value, from the first of them on, where they belong; they come face by face.
fn put<const AXES: usize>(
    values: &mut [f64],
    (arity, first): (usize, usize),
    by_face: &SitesByFace<'_>,
    found: Vec<Vec<[f64; AXES]>>,
) {
    let mut found = found.iter().flatten();
    by_face.for_each_number(|number| {
        if let Some(own) = found.next() {
            values[number * arity + first..][..AXES].copy_from_slice(own);
        }
    });
}
