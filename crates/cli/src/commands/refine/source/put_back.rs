//! The refined triangles of a mesh back into its asset, primitive by primitive.
//!
//! The file has a vertex for each vertex of the surface and each combination of values there. What morph targets add to positions
//! is a smooth channel, so that limit(base + Σ w t) = limit(base) + Σ w limit(t) at every vertex; what they add to normals is the
//! limit normal of base plus target minus the base's. Tangents, where the input had some, are found anew by the texture coordinates that
//! come out.

use anyhow::Context;
use limitmesh::mesh::{Channel, Domain, Semantic};
use limitmesh::{FaceId, LimitSurface, Mesh};
use limitmesh_io::Asset;
use limitmesh_io::gltf::{
    CornerAttribute, Geometry, MeshSoup, Part, VertexAttribute, WithTangents,
};

use super::super::refined::Refined;
use super::carried::Carried;
use super::vertices::Vertices;
use super::weights::{Weights, weights};
use crate::arguments::SchemeName;
use crate::commands::channels::Channels;

/// Numbers of a value at most that vertices of a file can have.
pub(super) const MOST_WIDE: usize = 4;

/// An attribute as a channel of the mesh's soup.
pub(super) fn channel(attribute: &CornerAttribute) -> Channel {
    let semantic = match attribute.plain_name() {
        _ if attribute.is_displacement() => Semantic::Displacement,
        name if name.starts_with("TEXCOORD_") => Semantic::TextureCoordinates,
        name if name.starts_with("COLOR_") => Semantic::Colour,
        _ if attribute.is_integer => Semantic::Label,
        _ => Semantic::Other,
    };
    Channel::new(
        attribute.name.clone(),
        semantic,
        Domain::Corner,
        attribute.width,
    )
    .with(attribute.values.clone(), attribute.corners.clone())
}

/// A mesh that was refined, and all that its primitives are put together from.
pub(super) struct PutBack<'a> {
    pub(super) own: &'a MeshSoup,
    pub(super) control: &'a Mesh,
    /// Of the control mesh.
    pub(super) channels: &'a Channels,
    pub(super) refined: &'a Refined,
    pub(super) carried: &'a Carried<'a>,
    /// How many times larger the refined mesh is than the asset's.
    pub(super) scale: f64,
    pub(super) scheme: SchemeName,
}

/// Notes on a mesh that was put back.
#[derive(Default)]
pub(super) struct PutNotes {
    pub(super) notes: Vec<String>,
    /// Names of attributes that could not be found anew.
    pub(super) left_out: Vec<String>,
}

/// Vertices of the surface that a primitive has, in the order of the file.
#[derive(Default)]
struct Numbered {
    /// By vertex, that of the surface, where vertices on sharp edges stand once for each side.
    surface: Vec<u32>,
    /// By vertex, the first corner of the refined mesh that has it.
    corners: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl PutBack<'_> {
    /// Replaces the mesh's primitives by the triangles that they became, and attributes by their values there.
    ///
    /// # Errors
    /// A morph target or weights have no limit, or the asset does not take the geometry.
    pub(super) fn put(&self, asset: &mut Asset, mesh: usize) -> anyhow::Result<PutNotes> {
        let Some(normals) = &self.refined.normals else {
            anyhow::bail!("no normals were found")
        };
        let (surface, normals) = normals.surface(&self.refined.mesh);
        let parts = &self.own.parts;
        let count = parts.iter().map(|part| part.targets.len()).max();
        let mut moved_normals = Vec::new();
        for target in 0..count.unwrap_or_default() {
            let is_asked = parts.iter().any(|part| self.has_normals(part, target));
            let channel = self.displacement(target).filter(|_| is_asked);
            let moved = |own| self.moved_normals(own, surface.triangles, normals.len());
            moved_normals.push(channel.map(moved).transpose()?);
        }
        let weights = self.weights()?;
        let notes = weights.as_ref().map(Weights::notes).unwrap_or_default();
        let mut notes = PutNotes {
            notes,
            left_out: Vec::new(),
        };
        for (number, part) in self.own.parts.iter().enumerate() {
            let channels: Vec<&Channel> = self.decisive(number).collect();
            let is_skinned = part.attributes.iter().any(|name| name == "JOINTS_0");
            let weights = weights.as_ref().filter(|_| is_skinned);
            let moving = weights.map(|weights| &weights.joints[..]);
            let mut vertices = Vertices::new(&channels, moving, surface.positions.len());
            let numbered = self.numbered(part, surface.triangles, &mut vertices);
            // A primitive of which nothing is left, as it had no area, stays as it is.
            if numbered.triangles.is_empty() {
                continue;
            }
            let own = || numbered.surface.iter().map(|&v| v as usize);
            let at = |v: usize| surface.positions[v].map(|x| x / self.scale);
            let positions: Vec<[f64; 3]> = own().map(at).collect();
            let directions: Vec<[f64; 3]> = own().map(|v| unit(normals[v])).collect();
            let mut attributes = Vec::new();
            let mut targets: Vec<Vec<VertexAttribute>> = vec![Vec::new(); part.targets.len()];
            for (target, own) in targets.iter_mut().enumerate() {
                own.extend(self.added_positions(number, target, &numbered));
                let names = &part.targets[target];
                let has = |name: &str| names.iter().any(|own| own == name);
                if has("NORMAL") && !has("POSITION") {
                    notes
                        .left_out
                        .push("NORMAL of morph targets that move nothing".to_owned());
                }
                if self.has_normals(part, target) {
                    let moved = moved_normals[target].as_deref();
                    own.push(added_normals(moved, &numbered.surface, &directions));
                }
            }
            for attribute in vertices.into_attributes() {
                let mut tables = self.own.attributes.iter();
                let table = tables.find(|table| table.name == attribute.name);
                match table.and_then(|table| Some((table, targets.get_mut(table.target?)?))) {
                    Some((table, own)) => {
                        own.push(VertexAttribute {
                            name: table.plain_name().to_owned(),
                            ..attribute
                        });
                    }
                    None => attributes.push(attribute),
                }
            }
            // Targets are counted, and each has to add something.
            for own in targets.iter_mut().filter(|own| own.is_empty()) {
                own.push(VertexAttribute::new(
                    "POSITION",
                    3,
                    vec![0.0; 3 * positions.len()],
                ));
            }
            let geometry = Geometry {
                positions: &positions,
                normals: Some(&directions),
                triangles: &numbered.triangles,
                attributes: &attributes,
                targets: &targets,
            };
            let left_out = &mut notes.left_out;
            let tangents = self.with_tangents(&geometry, asset, mesh, part, left_out)?;
            let geometry = tangents.as_ref().map_or(geometry, WithTangents::geometry);
            asset.replace(mesh, part.primitive, &geometry)?;
        }
        Ok(notes)
    }

    /// The geometry with tangents, for itself and for each target that had some, if the primitive had them; those that there cannot be are
    /// left out.
    fn with_tangents(
        &self,
        geometry: &Geometry<'_>,
        asset: &Asset,
        mesh: usize,
        part: &Part,
        left_out: &mut Vec<String>,
    ) -> anyhow::Result<Option<WithTangents>> {
        let has = |names: &[String]| names.iter().any(|name| name == "TANGENT");
        let moved: Vec<usize> = (0..part.targets.len())
            .filter(|&target| has(&part.targets[target]))
            .collect();
        let found = match has(&part.attributes) {
            true => {
                let texture = asset.tangent_coordinates(mesh, part.primitive)?;
                let found = WithTangents::of(geometry, &texture, &moved);
                if found.is_none() {
                    left_out.push(format!(
                        "TANGENT (there is no {texture} that it could follow)"
                    ));
                }
                found
            }
            false => None,
        };
        if found.is_none() && !moved.is_empty() {
            left_out.push("TANGENT of morph targets".to_owned());
        }
        Ok(found)
    }

    /// The weights of the refined mesh's joints, if it has a skin and its vertices know where they are from.
    fn weights(&self) -> anyhow::Result<Option<Weights>> {
        let origins = &self.carried.trail.origins;
        if origins.is_empty() || self.own.influences.is_empty() {
            return Ok(None);
        }
        let lists = self.carried.influences(self.control, &self.own.influences);
        // The butterfly's masks reach farther than a ring.
        let is_near = self.scheme != SchemeName::Butterfly;
        weights(self.control, &lists, self.scheme.scheme(), is_near, origins).map(Some)
    }

    /// Channels of the refined mesh that a primitive has and for whose values vertices of the file differ: all but displacements, of which
    /// a vertex of the surface has one each.
    fn decisive(&self, part: usize) -> impl Iterator<Item = &Channel> {
        self.refined.channels.all().iter().filter(move |channel| {
            let mut tables = self.own.attributes.iter();
            let table = tables.find(|table| table.name == channel.name);
            table.is_some_and(|table| table.is_in[part] && !table.is_displacement())
        })
    }

    /// Whether a target is to say how normals change: where it did, and where it moves vertices, whose normals do not follow by themselves.
    fn has_normals(&self, part: &Part, target: usize) -> bool {
        let names = part.targets.get(target);
        let has = |name: &str| names.is_some_and(|names| names.iter().any(|own| own == name));
        has("NORMAL") || has("POSITION") && self.displacement(target).is_some()
    }

    /// The table of a target's displacements.
    fn table(&self, target: usize) -> Option<&CornerAttribute> {
        let mut tables = self.own.attributes.iter();
        tables.find(|table| table.target == Some(target) && table.is_displacement())
    }

    /// The control mesh's channel of a target's displacements, unless these are all zero.
    fn displacement(&self, target: usize) -> Option<&Channel> {
        let table = self.table(target)?;
        let mut channels = self.channels.all().iter();
        let channel = channels.find(|channel| channel.name == table.name)?;
        channel.values.iter().any(|&x| x != 0.0).then_some(channel)
    }

    /// The vertices of a primitive and its triangles.
    fn numbered(
        &self,
        part: &Part,
        triangles: &[[u32; 3]],
        vertices: &mut Vertices<'_>,
    ) -> Numbered {
        let mut found = Numbered::default();
        for (triangle, corners) in triangles.iter().enumerate() {
            if self.own.parts.len() > 1 && !part.faces.contains(&self.carried.input(triangle)) {
                continue;
            }
            let of_mesh = self.refined.mesh.triangles()[triangle];
            found.triangles.push([0, 1, 2].map(|corner| {
                let v = corners[corner];
                let at = 3 * triangle + corner;
                let number = vertices.number(v, at, of_mesh[corner]);
                if number as usize == found.surface.len() {
                    found.surface.push(v);
                    found.corners.push(at as u32);
                }
                number
            }));
        }
        found
    }

    /// How a target moves the vertices of a primitive, if it says so.
    fn added_positions(
        &self,
        part: usize,
        target: usize,
        numbered: &Numbered,
    ) -> Option<VertexAttribute> {
        let table = self.table(target).filter(|table| table.is_in[part])?;
        let mut channels = self.refined.channels.all().iter();
        let channel = channels.find(|channel| channel.name == table.name)?;
        let corners = numbered.corners.iter();
        let values = corners.flat_map(|&corner| channel.value(corner as usize));
        Some(VertexAttribute::new(
            "POSITION",
            3,
            values.copied().collect(),
        ))
    }

    /// The limit normals of base plus target at the surface's vertices, each on its own side of sharp edges.
    fn moved_normals(
        &self,
        displacement: &Channel,
        triangles: &[[u32; 3]],
        count: usize,
    ) -> anyhow::Result<Vec<[f64; 3]>> {
        let positions = moved_positions(self.control, displacement, self.scale);
        let name = &displacement.name;
        let moved = self.control.clone().with_positions(positions);
        let moved = moved.with_context(|| name.clone())?;
        let limit =
            LimitSurface::new(&moved, self.scheme.scheme()).with_context(|| name.clone())?;
        // A corner for each vertex, those of one face together.
        let mut is_met = vec![false; count];
        let mut wanted = Vec::with_capacity(count);
        for (triangle, corners) in triangles.iter().enumerate() {
            for (corner, &v) in corners.iter().enumerate() {
                if !std::mem::replace(&mut is_met[v as usize], true) {
                    let of_mesh = self.refined.mesh.triangles()[triangle][corner];
                    let place = self.carried.control_place(triangle, corner, of_mesh);
                    wanted.extend(place.map(|place| (v, (FaceId(place.face), place.barycentric))));
                }
            }
        }
        let places: Vec<(FaceId, [f64; 3])> = wanted.iter().map(|&(_, place)| place).collect();
        let found = limit.at_all(&places);
        if let Some(error) = limit.failure() {
            anyhow::bail!("{name}: {error}");
        }
        let mut normals = vec![[0.0; 3]; count];
        for (&(v, _), point) in wanted.iter().zip(found) {
            normals[v as usize] = point.normal;
        }
        Ok(normals)
    }
}

/// Where a displacement moves the vertices of a mesh that is `scale` times as large as the asset's.
pub(super) fn moved_positions(mesh: &Mesh, displacement: &Channel, scale: f64) -> Vec<[f64; 3]> {
    let mut positions = mesh.positions().to_vec();
    let mut is_moved = vec![false; positions.len()];
    for (corner, &v) in mesh.triangles().as_flattened().iter().enumerate() {
        if !std::mem::replace(&mut is_moved[v as usize], true) {
            let own = displacement.value(corner);
            let moved = positions[v as usize].iter_mut().zip(own);
            moved.for_each(|(x, d)| *x += scale * d);
        }
    }
    positions
}

/// The change of the normals of the surface's vertices by a target; nothing where it does not move them, or they have none then.
fn added_normals(
    moved: Option<&[[f64; 3]]>,
    vertices: &[u32],
    base: &[[f64; 3]],
) -> VertexAttribute {
    let mut values = Vec::with_capacity(3 * vertices.len());
    for (&v, base) in vertices.iter().zip(base) {
        let moved = moved.map_or([0.0; 3], |moved| moved[v as usize]);
        let has_one = moved != [0.0; 3];
        values.extend((0..3).map(|i| if has_one { moved[i] - base[i] } else { 0.0 }));
    }
    VertexAttribute::new("NORMAL", 3, values)
}

/// Of length 1; upwards where there is no direction, as files need one.
fn unit(n: [f64; 3]) -> [f64; 3] {
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    let has_direction = length > 0.0 && length.is_finite();
    if has_direction {
        n.map(|x| x / length)
    } else {
        [0.0, 0.0, 1.0]
    }
}
