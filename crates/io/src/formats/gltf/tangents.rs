//! Tangents of a primitive's vertices, which say how a normal map lies on the surface: MikkTSpace's, which the specification names, and
//! which programs find themselves where a file has none.
//!
//! They are found from the numbers that the file holds, rounded as there. Corners of a vertex whose tangents differ, as where a texture
//! is mirrored, become vertices of their own. The bitangent, cross(normal, tangent) · w, points up in the picture, against v.

use super::edit::geometry::{Geometry, VertexAttribute};
use bevy_mikktspace::{Geometry as Corners, TangentSpace, generate_tangents};
use limitmesh::math;

/// A primitive's geometry with tangents.
#[derive(Clone, Debug, PartialEq)]
pub struct WithTangents {
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    attributes: Vec<VertexAttribute>,
    targets: Vec<Vec<VertexAttribute>>,
}

const TANGENT: &str = "TANGENT";

impl WithTangents {
    /// Adds tangents to a geometry by the texture coordinates `texture`, such as `TEXCOORD_0`, and what the morph targets `moved` add to
    /// them. `None` if it has no normals, no such texture coordinates, or no such target, without which there are no tangents.
    pub fn of(geometry: &Geometry<'_>, texture: &str, moved: &[usize]) -> Option<Self> {
        let is_texture = |own: &&VertexAttribute| own.name == texture && own.width == 2;
        let places = geometry.attributes.iter().find(is_texture)?;
        let base = Surface {
            positions: singles(geometry.positions),
            normals: singles(geometry.normals?),
            places: singles(places.values.as_chunks::<2>().0),
            triangles: geometry.triangles,
        };
        let tangents = base.tangents()?;
        let mut added = Vec::new();
        for &target in moved {
            let found = base.moved(geometry.targets.get(target)?).tangents()?;
            let pairs = found.iter().zip(&tangents);
            let tangents = pairs.map(|(to, from)| [0, 1, 2].map(|i| to[i] - from[i]));
            let tangents = tangents.collect();
            added.push(Added { target, tangents });
        }
        Some(Self::split(geometry, geometry.normals?, &tangents, &added))
    }

    /// The geometry, for [`Asset::replace`](crate::Asset::replace).
    pub fn geometry(&self) -> Geometry<'_> {
        Geometry {
            positions: &self.positions,
            normals: Some(&self.normals),
            triangles: &self.triangles,
            attributes: &self.attributes,
            targets: &self.targets,
        }
    }

    /// Vertices for all corners whose tangents differ, and by target what it adds to them.
    fn split(
        geometry: &Geometry<'_>,
        normals: &[[f64; 3]],
        tangents: &[[f32; 4]],
        added: &[Added],
    ) -> Self {
        let is_same = |a: usize, b: usize| {
            let bits = |corner: usize| tangents[corner].map(f32::to_bits);
            let moved = |own: &Added, corner: usize| own.tangents[corner].map(f32::to_bits);
            bits(a) == bits(b) && added.iter().all(|own| moved(own, a) == moved(own, b))
        };
        // By vertex the new ones that are copies of it; and by new vertex what it is a copy of, and the first corner that has it.
        let mut copies: Vec<Vec<u32>> = vec![Vec::new(); geometry.positions.len()];
        let (mut sources, mut corners): (Vec<u32>, Vec<usize>) = (Vec::new(), Vec::new());
        let mut number = |corner: usize, vertex: u32| {
            let known = &mut copies[vertex as usize];
            let mut found = known.iter().copied();
            let found = found.find(|&own| is_same(corners[own as usize], corner));
            found.unwrap_or_else(|| {
                let new = sources.len() as u32;
                known.push(new);
                sources.push(vertex);
                corners.push(corner);
                new
            })
        };
        let triangles = geometry.triangles.iter().enumerate();
        let triangles = triangles
            .map(|(t, own)| [0, 1, 2].map(|corner| number(3 * t + corner, own[corner])))
            .collect();
        let rows = |own: &VertexAttribute| {
            let row = |&v: &u32| &own.values[v as usize * own.width..][..own.width];
            let values = sources.iter().flat_map(row).copied().collect();
            VertexAttribute {
                values,
                ..own.clone()
            }
        };
        let at = |points: &[[f64; 3]]| sources.iter().map(|&v| points[v as usize]).collect();
        let mut attributes: Vec<VertexAttribute> = geometry.attributes.iter().map(rows).collect();
        attributes.push(attribute(corners.iter().map(|&corner| tangents[corner])));
        let all = geometry.targets.iter();
        let targets = all.map(|own| own.iter().map(rows).collect());
        let mut targets: Vec<Vec<VertexAttribute>> = targets.collect();
        for own in added {
            let added = corners.iter().map(|&corner| own.tangents[corner]);
            targets[own.target].push(attribute(added));
        }
        let (positions, normals) = (at(geometry.positions), at(normals));
        Self {
            positions,
            normals,
            triangles,
            attributes,
            targets,
        }
    }
}

/// The tangents that a morph target adds at all corners.
struct Added {
    target: usize,
    tangents: Vec<[f32; 3]>,
}

fn singles<const N: usize>(rows: &[[f64; N]]) -> Vec<[f32; N]> {
    rows.iter().map(|row| row.map(|x| x as f32)).collect()
}

fn attribute<const N: usize>(values: impl Iterator<Item = [f32; N]>) -> VertexAttribute {
    VertexAttribute::new(TANGENT, N, values.flatten().map(f64::from).collect())
}

/// The input of the tangents.
struct Surface<'a> {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    /// Texture coordinates.
    places: Vec<[f32; 2]>,
    triangles: &'a [[u32; 3]],
}

impl Surface<'_> {
    /// The surface as a morph target makes it at weight 1.
    fn moved(&self, target: &[VertexAttribute]) -> Self {
        let added = |name: &str, base: &[[f32; 3]]| -> Vec<[f32; 3]> {
            let Some(own) = target.iter().find(|own| own.name == name && own.width == 3) else {
                return base.to_vec();
            };
            let rows = base.iter().zip(own.values.as_chunks::<3>().0);
            rows.map(|(x, d)| [0, 1, 2].map(|i| x[i] + d[i] as f32))
                .collect()
        };
        Self {
            positions: added("POSITION", &self.positions),
            normals: added("NORMAL", &self.normals),
            places: self.places.clone(),
            triangles: self.triangles,
        }
    }

    /// The tangents of all corners; `None` if a vertex lacks something.
    fn tangents(&self) -> Option<Vec<[f32; 4]>> {
        let count = self.positions.len();
        let is_there = |&v: &u32| (v as usize) < count;
        let is_whole = self.normals.len() == count && self.places.len() == count;
        if !is_whole || !self.triangles.as_flattened().iter().all(is_there) {
            return None;
        }
        let corners = vec![None; 3 * self.triangles.len()];
        let mut found = Tangents {
            surface: self,
            scale: self.scale(),
            corners,
        };
        // There are no errors.
        generate_tangents(&mut found).ok()?;
        let corners = found.corners.into_iter().zip(self.triangles.as_flattened());
        let tangent = |(own, &v): (Option<[f32; 4]>, &u32)| {
            own.unwrap_or_else(|| across(self.normals[v as usize]))
        };
        Some(corners.map(tangent).collect())
    }

    /// A power of two that brings positions between -1 and 1, so that no product overflows and equal ones stay equal.
    fn scale(&self) -> f32 {
        let all = self.positions.as_flattened().iter();
        let most = all.fold(0.0f32, |most, x| most.max(x.abs()));
        let has_size = most > 0.0 && most.is_finite();
        if has_size {
            math::exp2(-math::log2(f64::from(most)).ceil()) as f32
        } else {
            1.0
        }
    }
}

struct Tangents<'a> {
    surface: &'a Surface<'a>,
    scale: f32,
    corners: Vec<Option<[f32; 4]>>,
}

impl Tangents<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.surface.triangles[face][corner] as usize
    }
}

impl Corners for Tangents<'_> {
    fn num_faces(&self) -> usize {
        self.surface.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.surface.positions[self.vertex(face, corner)].map(|x| x * self.scale)
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.surface.normals[self.vertex(face, corner)]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.surface.places[self.vertex(face, corner)]
    }

    fn set_tangent(&mut self, found: Option<TangentSpace>, face: usize, corner: usize) {
        let tangent = found.map(|found| {
            let [x, y, z, w] = found.tangent_encoded();
            // v runs downwards in glTF, upwards in MikkTSpace.
            [x, y, z, -w]
        });
        let length = |t: &[f32; 4]| t[..3].iter().map(|x| x * x).sum::<f32>();
        self.corners[3 * face + corner] = tangent.filter(|t| (0.99..1.01).contains(&length(t)));
    }
}

/// Some tangent, where the texture has no direction: across a normal.
fn across(normal: [f32; 3]) -> [f32; 4] {
    let [x, y, z] = normal.map(f32::abs);
    let axis = match (x <= y && x <= z, y <= z) {
        (true, _) => [1.0, 0.0, 0.0],
        (_, true) => [0.0, 1.0, 0.0],
        _ => [0.0, 0.0, 1.0],
    };
    let product = |i: usize, j: usize| normal[i] * axis[j] - normal[j] * axis[i];
    let cross = [product(1, 2), product(2, 0), product(0, 1)];
    let length = cross.iter().map(|x| x * x).sum::<f32>().sqrt();
    if length > 0.0 && length.is_finite() {
        let [x, y, z] = cross.map(|x| x / length);
        [x, y, z, 1.0]
    } else {
        [1.0, 0.0, 0.0, 1.0]
    }
}
