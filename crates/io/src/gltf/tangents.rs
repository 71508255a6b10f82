//! Tangents of a primitive's vertices, which say how a normal map lies on the surface: MikkTSpace's, which the specification names, and
//! which programs find themselves where a file has none.
//!
//! They are found from the numbers that the file holds, rounded as there. Corners of a vertex whose tangents differ, as where a texture
//! is mirrored, become vertices of their own. The bitangent, cross(normal, tangent) · w, points up in the picture, against v.

use bevy_mikktspace::{Geometry as Corners, TangentSpace, generate_tangents};

use super::geometry::{Geometry, VertexAttribute};
use super::materials::TRANSFORM;
use super::{Asset, Flawed};
use crate::error::ReadError;

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
    /// them. `None` if it has no normals or no such texture coordinates, without which there are no tangents.
    pub fn of(geometry: &Geometry<'_>, texture: &str, moved: &[usize]) -> Option<Self> {
        let places = geometry
            .attributes
            .iter()
            .find(|own| own.name == texture && own.width == 2)?;
        let base = Surface {
            positions: geometry
                .positions
                .iter()
                .map(|p| p.map(|x| x as f32))
                .collect(),
            normals: geometry
                .normals?
                .iter()
                .map(|n| n.map(|x| x as f32))
                .collect(),
            places: places
                .values
                .as_chunks::<2>()
                .0
                .iter()
                .map(|p| p.map(|x| x as f32))
                .collect(),
            triangles: geometry.triangles,
        };
        let tangents = base.tangents()?;
        let moved = moved
            .iter()
            .filter_map(|&target| Some((target, geometry.targets.get(target)?)));
        let added = moved.map(|(target, own)| {
            let found = base.moved(own).tangents()?;
            let pairs = found.iter().zip(&tangents);
            Some((
                target,
                pairs
                    .map(|(to, from)| [0, 1, 2].map(|i| to[i] - from[i]))
                    .collect(),
            ))
        });
        let added: Vec<(usize, Vec<[f32; 3]>)> = added.collect::<Option<_>>()?;
        Some(Self::split(geometry, &tangents, &added))
    }

    /// The geometry, for [`Asset::replace`].
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
        tangents: &[[f32; 4]],
        added: &[(usize, Vec<[f32; 3]>)],
    ) -> Self {
        // By vertex the first corner that has it and its number; further ones follow by the last of these.
        let is_same = |a: usize, b: usize| {
            let bits = |corner: usize| tangents[corner].map(f32::to_bits);
            let moved = |own: &[[f32; 3]], corner: usize| own[corner].map(f32::to_bits);
            bits(a) == bits(b) && added.iter().all(|(_, own)| moved(own, a) == moved(own, b))
        };
        let mut of_vertex: Vec<Vec<u32>> = vec![Vec::new(); geometry.positions.len()];
        let (mut sources, mut corners): (Vec<u32>, Vec<usize>) = (Vec::new(), Vec::new());
        let mut number = |corner: usize, vertex: u32| {
            let known = of_vertex.get_mut(vertex as usize);
            let found = known.as_ref().and_then(|all| {
                all.iter()
                    .copied()
                    .find(|&own| is_same(corners[own as usize], corner))
            });
            found.unwrap_or_else(|| {
                let new = sources.len() as u32;
                known.into_iter().for_each(|all| all.push(new));
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
            let rows = sources
                .iter()
                .flat_map(|&v| &own.values[v as usize * own.width..][..own.width]);
            VertexAttribute {
                values: rows.copied().collect(),
                ..own.clone()
            }
        };
        let at = |points: &[[f64; 3]]| sources.iter().map(|&v| points[v as usize]).collect();
        let mut attributes: Vec<VertexAttribute> = geometry.attributes.iter().map(rows).collect();
        attributes.push(attribute(
            corners.iter().map(|&corner| &tangents[corner][..]),
            4,
        ));
        let mut targets: Vec<Vec<VertexAttribute>> = geometry
            .targets
            .iter()
            .map(|own| own.iter().map(rows).collect())
            .collect();
        for (target, own) in added {
            targets[*target].push(attribute(corners.iter().map(|&corner| &own[corner][..]), 3));
        }
        let (positions, normals) = (
            at(geometry.positions),
            at(geometry.normals.unwrap_or_default()),
        );
        Self {
            positions,
            normals,
            triangles,
            attributes,
            targets,
        }
    }
}

fn attribute<'a>(values: impl Iterator<Item = &'a [f32]>, width: usize) -> VertexAttribute {
    let values = values.flatten().map(|&x| f64::from(x)).collect();
    VertexAttribute {
        name: TANGENT.to_owned(),
        width,
        values,
        is_integer: false,
    }
}

/// What tangents are found from.
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
            let rows = own.values.as_chunks::<3>().0;
            base.iter()
                .zip(rows)
                .map(|(x, d)| [0, 1, 2].map(|i| x[i] + d[i] as f32))
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
        let is_whole = self.normals.len() == count
            && self.places.len() == count
            && self
                .triangles
                .as_flattened()
                .iter()
                .all(|&v| (v as usize) < count);
        if !is_whole {
            return None;
        }
        let mut found = Tangents {
            surface: self,
            scale: self.scale(),
            corners: Vec::new(),
        };
        found.corners = vec![None; 3 * self.triangles.len()];
        // There are no errors.
        generate_tangents(&mut found).ok()?;
        let normal = |corner: usize| self.normals[self.triangles.as_flattened()[corner] as usize];
        let corners = found.corners.into_iter().enumerate();
        Some(
            corners
                .map(|(corner, own)| own.unwrap_or_else(|| across(normal(corner))))
                .collect(),
        )
    }

    /// A power of two that brings positions between -1 and 1, so that no product overflows and equal ones stay equal.
    fn scale(&self) -> f32 {
        let most = self
            .positions
            .as_flattened()
            .iter()
            .fold(0.0f32, |most, x| most.max(x.abs()));
        if most > 0.0 && most.is_finite() {
            (-f64::from(most).log2().ceil()).exp2() as f32
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
    let least = (0..3)
        .min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs()))
        .unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let [a, b] = [normal, axis];
    let cross = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    let length = cross.iter().map(|x| x * x).sum::<f32>().sqrt();
    if length > 0.0 && length.is_finite() {
        let [x, y, z] = cross.map(|x| x / length);
        [x, y, z, 1.0]
    } else {
        [1.0, 0.0, 0.0, 1.0]
    }
}

impl Asset {
    /// The name of the texture coordinates by which a primitive's normal map lies, and so its tangents: those that its material names, or
    /// the first.
    ///
    /// # Errors
    /// There is no such primitive, or its material breaks the rules.
    pub fn tangent_coordinates(&self, mesh: usize, primitive: usize) -> Result<String, ReadError> {
        let set = || -> Flawed<usize> {
            let Some(Some(material)) = self.materials_of(mesh)?.get(primitive).copied() else {
                return Ok(0);
            };
            let materials = self.source.root().list("materials")?;
            let Some(material) = materials.get(material) else {
                return Ok(0);
            };
            let Some(map) = material.get("normalTexture") else {
                return Ok(0);
            };
            let set = map.count_or("texCoord", 0)?;
            map.path(&["extensions", TRANSFORM])
                .map_or(Ok(set), |own| own.count_or("texCoord", set))
        };
        set()
            .map(|set| format!("TEXCOORD_{set}"))
            .map_err(|flaw| self.told(flaw))
    }
}
