//! The result: nodes that are not split, and thirds of split nodes next to such.
//!
//! At every moment these are a conforming mesh. Its vertices are at their limits; those of the control mesh keep their numbers.

use super::split::Triangle;
use super::{Forest, Side, side};
use crate::geometry::NONE;
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::limit::SidedNormals;
use crate::mesh::{CreaseTag, Groups, Junctions, Mesh, Tags, Topology};
use crate::refine::{Origin, RefineError};
use crate::vector::{DVec3, unit_or_zero};

/// A mesh and its bounds.
pub(in crate::sqrt3) struct Emitted {
    pub(in crate::sqrt3) mesh: Mesh,
    pub(in crate::sqrt3) normals: SidedNormals,
    /// Empty unless they were wanted.
    pub(in crate::sqrt3) origins: Vec<Origin>,
    pub(in crate::sqrt3) parents: Vec<u32>,
    /// The greatest level of a triangle.
    pub(in crate::sqrt3) levels: usize,
}

impl Forest<'_> {
    /// All triangles of the result.
    fn result(&self) -> Vec<Triangle> {
        let mut result = limitmesh_pages::with_capacity(self.triangles);
        for (t, node) in self.nodes.iter().enumerate() {
            if !node.is_split {
                result.extend(self.is_real(t).then_some(Triangle::Leaf(t as u32)));
                continue;
            }
            let thirds = (0..3)
                .filter(|&edge| !node.is_sharp(edge))
                .map(|edge| Triangle::Third(side(t, edge)));
            result.extend(thirds.filter(|&third| self.is_there(third)));
        }
        result
    }

    /// Whether both parents of a node are split.
    fn is_real(&self, t: usize) -> bool {
        let parent = self.nodes[t].parent;
        let is_split = |own: Side| self.node(own).is_split;
        parent == NONE || is_split(parent) && self.across(parent).is_none_or(is_split)
    }

    /// The present mesh.
    ///
    /// # Errors
    /// More elements than can be numbered, or coordinates that overflow.
    pub(in crate::sqrt3) fn emit(mut self) -> Result<Emitted, RefineError> {
        let result = self.result();
        let corners: Vec<[u32; 3]> = result
            .iter()
            .map(|&triangle| self.corners(triangle))
            .collect();
        let used = corners.iter().flatten().copied();
        // Limits may need more nodes and vertices than there are.
        let (count, mut is_used) = (self.vertices.len(), vec![false; self.vertices.len()]);
        used.for_each(|v| is_used[v as usize] = true);
        let numbers = self.numbers(&is_used);
        let mut positions = vec![[0.0; 3]; self.control.vertex_count()];
        let mut normals = vec![DVec3::ZERO; count];
        for v in (0..count as u32).filter(|&v| is_used[v as usize]) {
            let number = numbers[v as usize] as usize;
            if positions.len() <= number {
                positions.resize(number + 1, [0.0; 3]);
            }
            positions[number] = self.limit(v).to_array();
            normals[v as usize] = self.normal(v);
        }
        let triangles = corners
            .iter()
            .map(|own| own.map(|v| numbers[v as usize]))
            .collect();
        let topology = Topology::from_triangles(triangles, positions.len())?;
        crate::mesh::check_finite(&positions)?;
        let (tags, junctions) = (self.tags(&numbers), self.junctions(&topology, &numbers));
        let mesh = Mesh::from_parts(topology, positions, tags, junctions);
        let normals = sided(&mesh, &corners, normals);
        let parents = result.iter().map(|&triangle| match triangle {
            Triangle::Leaf(node) => self.nodes[node as usize].root,
            Triangle::Third(own) => self.root(own),
        });
        let parents = parents.collect();
        let steps = |&triangle: &Triangle| {
            usize::from(self.level(triangle)) + usize::from(matches!(triangle, Triangle::Third(_)))
        };
        let levels = result.iter().map(steps).max().unwrap_or(0);
        let mut origins = Vec::new();
        if let Some(all) = &self.origins {
            origins.resize(
                mesh.vertex_count(),
                Origin {
                    face: 0,
                    barycentric: [0.0; 3],
                },
            );
            for v in (0..count).rev().filter(|&v| is_used[v]) {
                origins[numbers[v] as usize] = all[v];
            }
        }
        Ok(Emitted {
            mesh,
            normals,
            origins,
            parents,
            levels,
        })
    }

    /// By vertex, its number in the result.
    fn numbers(&self, is_used: &[bool]) -> Vec<u32> {
        let mut numbers = vec![NONE; is_used.len()];
        let mut next = self.control.vertex_count() as u32;
        for v in (0..is_used.len()).filter(|&v| is_used[v]) {
            let vertex = &self.vertices[v];
            if vertex.level == 0 {
                numbers[v] = vertex.maker;
                continue;
            }
            let first = vertex.first as usize;
            if numbers[first] == NONE {
                numbers[first] = next;
                next += 1;
            }
            numbers[v] = numbers[first];
        }
        numbers
    }

    /// Corners as they were, and the parts of creases.
    fn tags(&self, numbers: &[u32]) -> Tags {
        let mut tags = Tags {
            creases: Vec::new(),
            corners: self.control.tags().corners.clone(),
        };
        let all = self.control.tags().creases.iter().map(|tag| tag.sharpness);
        let sharpness = all.fold(0.0, f64::max);
        for rim in self
            .rims
            .result()
            .filter(|rim| self.rims.groups[rim.group as usize].is_crease)
        {
            let ends = rim
                .ends
                .iter()
                .map(|ends| ends.map(|v| numbers[v as usize]));
            let vertices = ends.into_iter().find(|ends| !ends.contains(&NONE));
            tags.creases.extend(vertices.map(|vertices| CreaseTag {
                vertices,
                sharpness,
            }));
        }
        tags
    }

    /// Copies where sheets were cut apart.
    fn junctions(&self, topology: &Topology, numbers: &[u32]) -> Junctions {
        let control = self.control.junctions();
        let mut junctions = Junctions {
            vertices: control.vertices.clone(),
            edges: Groups::default(),
        };
        if control.is_empty() {
            return junctions;
        }
        let is_cut_apart = |group: u32| {
            let group = &self.rims.groups[group as usize];
            !group.is_crease && group.sides.len() > 1
        };
        for rim in self.rims.result().filter(|rim| is_cut_apart(rim.group)) {
            let ends = rim
                .ends
                .iter()
                .map(|ends| ends.map(|v| VertexId(numbers[v as usize])));
            junctions.edges.push(
                ends.filter_map(|[a, b]| topology.edge_between(a, b))
                    .map(|h| h.0),
            );
        }
        for rim in self.rims.cut().filter(|rim| is_cut_apart(rim.group)) {
            let middle = &self.rims.rims[rim.parts[1] as usize];
            for end in 0..2 {
                junctions
                    .vertices
                    .push(middle.ends.iter().map(|ends| numbers[ends[end] as usize]));
            }
        }
        junctions
    }
}

/// The normals of a mesh from those of its corners, one for each vertex and side of sharp edges;
/// where there is none, the average of the faces'.
fn sided(mesh: &Mesh, corners: &[[u32; 3]], mut normals: Vec<DVec3>) -> SidedNormals {
    let mut averages = vec![DVec3::ZERO; normals.len()];
    for (face, own) in corners.iter().enumerate() {
        for &v in own.iter().filter(|&&v| normals[v as usize] == DVec3::ZERO) {
            averages[v as usize] += mesh.face_normal_vector(face);
        }
    }
    for (normal, average) in normals
        .iter_mut()
        .zip(averages)
        .filter(|(normal, _)| **normal == DVec3::ZERO)
    {
        *normal = unit_or_zero(average);
    }
    // By number, the sum over sides, one of these, and whether there are more.
    let mut by_vertex = vec![(DVec3::ZERO, NONE, false); mesh.vertex_count()];
    let mut is_counted = vec![false; normals.len()];
    for (own, numbers) in corners.iter().zip(mesh.triangles()) {
        for (&v, &number) in own.iter().zip(numbers) {
            if !core::mem::replace(&mut is_counted[v as usize], true) {
                let (sum, one, has_more) = &mut by_vertex[number as usize];
                *sum += normals[v as usize];
                *has_more = *one != NONE;
                *one = v;
            }
        }
    }
    let whole = |&(sum, one, has_more): &(DVec3, u32, bool)| match has_more {
        false if one != NONE => normals[one as usize].to_array(),
        _ => unit_or_zero(sum).to_array(),
    };
    let mut sided = SidedNormals::new(by_vertex.iter().map(whole).collect());
    for (face, own) in corners.iter().enumerate() {
        for (corner, &v) in own.iter().enumerate() {
            let h = HalfEdgeId::of(FaceId(face as u32), corner);
            let number = mesh.topology().origin(h);
            if by_vertex[number.index()].2 {
                sided.add_side(number, core::iter::once(h), normals[v as usize].to_array());
            }
        }
    }
    sided.finished()
}
