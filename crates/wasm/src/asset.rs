//! glTF in, glTF out: each mesh of the asset is refined once, at the scale of its largest appearance, and everything else stays as it is.
//!
//! Meshes with skins or morph targets are refused: to leave those out silently would spoil the asset.

use std::collections::HashMap;

use limitmesh::mesh::{Channel, Domain, Semantic, Weld};
use limitmesh::progress::Observer;
use limitmesh::refine::Exact;
use limitmesh::scheme::Family;
use limitmesh_io::gltf::{
    CornerAttribute, Geometry, Joining, MeshSoup, Part, VertexAttribute, WithTangents,
};
use limitmesh_io::{Asset, Format, WriteOptions, rounding};

use crate::control::Control;
use crate::failure::Failure;
use crate::files::{FileOut, mesh_told};
use crate::inputs::{ControlIn, GoalsIn};
use crate::options;
use crate::refine::{Reached, Scale, exact_of};

/// Numbers of a value at most that vertices of a file can have.
const MOST_WIDE: usize = 4;

/// The channel that says which primitive a face is of.
const PART: &str = "primitive";

/// The asset with refined meshes.
///
/// # Errors
/// It cannot be read, moves vertices, or the observer said stop.
pub(crate) fn refined(
    bytes: &[u8],
    to: Format,
    told: &ControlIn,
    goals: &GoalsIn,
    observer: &mut Observer<'_>,
) -> Result<FileOut, Failure> {
    let mut asset = Asset::from_bytes(bytes, None)?;
    let Some([low, high]) = asset.bounding_box()? else {
        return Err(Failure::read("scenes", "the scene shows no triangles"));
    };
    let squares = low.iter().zip(high).map(|(a, b)| (b - a) * (b - a));
    let diagonal = squares.sum::<f64>().sqrt();
    let (mut meshes, mut left_out) = (Vec::new(), Vec::new());
    for number in 0..asset.mesh_count() {
        let Some((own, scale)) = soup_of(&asset, number, told)? else {
            continue;
        };
        left_out.extend(too_wide(&own));
        left_out.extend(own.cut_polygons());
        let build = options::build(told).weld(Weld::Never).keep_windings(true);
        let control = Control::new(own.soup.clone(), &build, told, observer)?;
        let lengths = Scale {
            diagonal,
            is_rounded: true,
        };
        let (found, channels) = exact_of(&control, told, goals, lengths, observer)?;
        let back = PutBack {
            number,
            scale,
            found: &found,
            parts: control.input_faces(found.parents.clone()),
            channels: &channels,
        };
        left_out.extend(back.put(&own, &mut asset)?);
        let rounded = rounding(to, &WriteOptions::default(), found.mesh.positions());
        let name = asset.mesh_name(number);
        let reached = Reached::of(&found, goals, diagonal, rounded);
        meshes.push(mesh_told(&name, &found, &control, &reached));
    }
    left_out.extend(asset.left_out());
    Ok(FileOut {
        bytes: asset.to_bytes(to)?,
        meshes,
        left_out,
    })
}

/// A mesh as large as it is shown, with its attributes as channels, and how many times as large as in the asset; none if it is not shown.
fn soup_of(
    asset: &Asset,
    number: usize,
    told: &ControlIn,
) -> Result<Option<(MeshSoup, f64)>, Failure> {
    let scale = asset.stretch(number);
    let joining = match told.weld() {
        none if none < 0.0 => Joining::Never,
        distance => Joining::Ignoring {
            skins: false,
            morphs: false,
            distance: distance / scale,
        },
    };
    let mut own = asset.mesh(number, joining)?;
    let scheme = options::scheme(told, &own.soup)?;
    if !matches!(scheme.family(), Some(Family::CatmullClark)) {
        own = asset.triangles_of(number, joining, |_| true)?;
    }
    if own.parts.is_empty() {
        return Ok(None);
    }
    if own.has_targets() || !own.influences.is_empty() {
        let place = format!("meshes[{number}]");
        let message = format!(
            "{place} has a skin or morph targets, which refineFile does not carry: limitmesh/gltf-transform and the program do"
        );
        return Err(Failure::read(place, message));
    }
    let coordinates = own.soup.positions.iter_mut().flatten();
    coordinates.for_each(|x| *x *= scale);
    let narrow = own.attributes.iter().filter(|own| own.width <= MOST_WIDE);
    let mut channels: Vec<Channel> = narrow.map(channel).collect();
    channels.push(parts_of(&own));
    own.soup.channels = channels;
    Ok(Some((own, scale)))
}

fn too_wide(own: &MeshSoup) -> impl Iterator<Item = String> {
    let wide = own.attributes.iter().filter(|own| own.width > MOST_WIDE);
    wide.map(|own| own.name.clone())
}

/// An attribute as a channel of the mesh's soup.
fn channel(attribute: &CornerAttribute) -> Channel {
    let semantic = match attribute.plain_name() {
        name if name.starts_with("TEXCOORD_") => Semantic::TextureCoordinates,
        name if name.starts_with("COLOR_") => Semantic::Colour,
        _ if attribute.is_integer => Semantic::Label,
        _ => Semantic::Other,
    };
    let (name, width) = (attribute.name.clone(), attribute.width);
    Channel::new(name, semantic, Domain::Corner, width)
        .with(attribute.values.clone(), attribute.corners.clone())
}

/// By face, its primitive: edges stay where one meets another.
fn parts_of(own: &MeshSoup) -> Channel {
    let mut indices = vec![0; own.soup.faces.len()];
    for (number, part) in (0..).zip(&own.parts) {
        indices[part.faces.clone()].fill(number);
    }
    let values = (0..own.parts.len()).map(|number| number as f64).collect();
    Channel::new(PART, Semantic::Label, Domain::Face, 1).with(values, indices)
}

/// A mesh that was refined, on its way back.
struct PutBack<'a> {
    number: usize,
    scale: f64,
    found: &'a Exact,
    /// By triangle, the soup's face.
    parts: Vec<u32>,
    channels: &'a [Channel],
}

/// The vertices of a primitive in the order of the file: one for each vertex of the surface and each combination of values there.
#[derive(Default)]
struct Vertices {
    known: HashMap<Vec<u32>, u32>,
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    /// By vertex, the first corner of the refined mesh that has it.
    corners: Vec<usize>,
    triangles: Vec<[u32; 3]>,
}

impl PutBack<'_> {
    /// Replaces the primitives by the triangles that they became; gives the names of attributes that could not be found anew.
    fn put(&self, own: &MeshSoup, asset: &mut Asset) -> Result<Vec<String>, Failure> {
        let mut left_out = Vec::new();
        let sides: HashMap<usize, [f64; 3]> = self
            .found
            .sides
            .iter()
            .map(|&(corner, normal)| (corner as usize, normal))
            .collect();
        for (number, part) in own.parts.iter().enumerate() {
            let channels: Vec<&Channel> = self.channels_of(own, number).collect();
            let vertices = self.vertices(part, &channels, &sides);
            // A primitive of which nothing is left, as it had no area, stays as it is.
            if vertices.triangles.is_empty() {
                continue;
            }
            let attributes: Vec<VertexAttribute> = channels
                .iter()
                .map(|channel| vertices.attribute(channel))
                .collect();
            let geometry = Geometry {
                positions: &vertices.positions,
                normals: Some(&vertices.normals),
                triangles: &vertices.triangles,
                attributes: &attributes,
                targets: &[],
            };
            let mut tangents = None;
            if part.attributes.iter().any(|name| name == "TANGENT") {
                let texture = asset.tangent_coordinates(self.number, part.primitive)?;
                tangents = WithTangents::of(&geometry, &texture, &[]);
                if tangents.is_none() {
                    left_out.push("TANGENT".to_owned());
                }
            }
            let geometry = tangents.as_ref().map_or(geometry, WithTangents::geometry);
            asset.replace(self.number, part.primitive, &geometry)?;
        }
        Ok(left_out)
    }

    fn channels_of(&self, own: &MeshSoup, part: usize) -> impl Iterator<Item = &Channel> {
        self.channels.iter().filter(move |channel| {
            let mut tables = own.attributes.iter();
            let table = tables.find(|table| table.name == channel.name);
            table.is_some_and(|table| table.is_in[part])
        })
    }

    fn vertices(
        &self,
        part: &Part,
        channels: &[&Channel],
        sides: &HashMap<usize, [f64; 3]>,
    ) -> Vertices {
        let mut vertices = Vertices::default();
        let triangles = self.found.mesh.triangles().iter().zip(&self.parts);
        for (number, (triangle, &face)) in triangles.enumerate() {
            if !part.faces.contains(&(face as usize)) {
                continue;
            }
            let own = [0, 1, 2].map(|corner| {
                let (v, corner) = (triangle[corner] as usize, 3 * number + corner);
                let normal = unit(*sides.get(&corner).unwrap_or(&self.found.normals[v]));
                let position = self.found.mesh.positions()[v].map(|x| x / self.scale);
                let values = channels.iter().flat_map(|channel| channel.value(corner));
                let mut key = vec![v as u32];
                let bits = |x: &f64| (*x as f32).to_bits();
                key.extend(normal.iter().chain(values).map(bits));
                vertices.number(key, position, normal, corner)
            });
            vertices.triangles.push(own);
        }
        vertices
    }
}

impl Vertices {
    /// The file's vertex with these values; a new one has the next number.
    fn number(
        &mut self,
        key: Vec<u32>,
        position: [f64; 3],
        normal: [f64; 3],
        corner: usize,
    ) -> u32 {
        let next = self.positions.len() as u32;
        let number = *self.known.entry(key).or_insert(next);
        if number == next {
            self.positions.push(position);
            self.normals.push(normal);
            self.corners.push(corner);
        }
        number
    }

    fn attribute(&self, channel: &Channel) -> VertexAttribute {
        let corners = self.corners.iter();
        let values = corners.flat_map(|&corner| channel.value(corner)).copied();
        VertexAttribute {
            is_integer: channel.semantic == Semantic::Label,
            ..VertexAttribute::new(&channel.name, channel.arity, values.collect())
        }
    }
}

/// Of length 1; upwards where there is no direction, as files need one.
fn unit(n: [f64; 3]) -> [f64; 3] {
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    match length > 0.0 && length.is_finite() {
        true => n.map(|x| x / length),
        false => [0.0, 0.0, 1.0],
    }
}
