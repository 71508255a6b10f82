//! The volume of closed parts of a mesh, and the shift along normals that gives it back to a surface that was smoothed.
//!
//! Where a closed surface of area A is moved by s along its normals, its volume grows by A·s about:
//! a few corrections by the missing volume find s, unless limits may not go as far.

use std::collections::BTreeSet;

use crate::geometry::DisjointSets;
use crate::index::HalfEdgeId;
use crate::mesh::Mesh;
use crate::parallel::Poll;
use crate::progress::Cancelled;
use crate::refine::Exact;
use crate::vector::{DVec3, unit_or_zero, vector};

/// Volumes that differ by less than this part are the same.
const SAME: f64 = 1e-3;

/// The least assumed part of the full effect of a shift where some vertices may not follow.
const LEAST_EFFECT: f64 = 0.25;

/// Faces between two calls of the observer.
const PIECE: usize = 1 << 12;

/// How far the vertices of each part of a mesh are shifted along normals.
pub(super) struct Shift {
    /// By face and by vertex, the part that it belongs to.
    of_faces: Vec<u32>,
    of_vertices: Vec<u32>,
    parts: Vec<Part>,
}

/// A component connected by vertices, and by their copies where sheets were cut apart.
struct Part {
    is_closed: bool,
    volume: f64,
    /// How far its vertices are shifted.
    by: f64,
    /// The shift before that, and the volume with it.
    before: Option<(f64, f64)>,
}

impl Shift {
    /// None as yet, for the parts of a mesh.
    pub(super) fn new(mesh: &Mesh, poll: &mut Poll<'_>) -> Result<Self, Cancelled> {
        let mut sets = DisjointSets::new(mesh.vertex_count());
        for &[a, b, c] in mesh.triangles() {
            sets.unite(a, b);
            sets.unite(a, c);
        }
        for pair in mesh
            .junctions()
            .vertices
            .iter()
            .flat_map(|copies| copies.windows(2))
        {
            sets.unite(pair[0], pair[1]);
        }
        poll(0)?;
        let (of_vertices, count) = numbered(&sets.into_roots());
        let of_faces: Vec<u32> = mesh
            .triangles()
            .iter()
            .map(|&[a, ..]| of_vertices[a as usize])
            .collect();
        let sizes = sizes(mesh, &of_faces, count, poll)?;
        let part = |size: Size| Part {
            is_closed: true,
            volume: size.volume,
            by: 0.0,
            before: None,
        };
        let mut parts: Vec<Part> = sizes.into_iter().map(part).collect();
        let cut: BTreeSet<u32> = mesh.junctions().edges.iter().flatten().copied().collect();
        let topology = mesh.topology();
        let is_rim = |h: &HalfEdgeId| topology.twin(*h).is_none() && !cut.contains(&h.0);
        for rim in topology.half_edges().filter(is_rim) {
            parts[of_faces[rim.face().index()] as usize].is_closed = false;
        }
        Ok(Self {
            of_faces,
            of_vertices,
            parts,
        })
    }

    /// Limits that are so far `away` from the vertices of the mesh, those shifted that may be, within the reach of each.
    pub(super) fn applied(
        &self,
        mesh: &Mesh,
        away: &[DVec3],
        reach: &[f64],
        may_be: impl Fn(usize) -> bool,
    ) -> Vec<DVec3> {
        let at = |v: u32| vector(mesh.positions()[v as usize]) + away[v as usize];
        let mut normals = vec![DVec3::ZERO; away.len()];
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(at);
            let normal = (b - a).cross(c - a);
            triangle.iter().for_each(|&v| normals[v as usize] += normal);
        }
        // Copies go the same way.
        for copies in mesh.junctions().vertices.iter() {
            let all: DVec3 = copies.iter().map(|&v| normals[v as usize]).sum();
            copies.iter().for_each(|&v| normals[v as usize] = all);
        }
        let shifted = |(v, &away): (usize, &DVec3)| {
            let by = self.parts[self.of_vertices[v] as usize].by;
            if by == 0.0 || !may_be(v) {
                return away;
            }
            (away + by * unit_or_zero(normals[v])).clamp_length_max(reach[v])
        };
        away.iter().enumerate().map(shifted).collect()
    }

    /// Corrects the shift, which is `most` at most, by the volumes that a refined mesh has with it; says whether there was anything to correct.
    pub(super) fn corrected(
        &mut self,
        refined: &Exact,
        most: f64,
        poll: &mut Poll<'_>,
    ) -> Result<bool, Cancelled> {
        let of_faces: Vec<u32> = refined
            .parents
            .iter()
            .map(|&face| self.of_faces[face as usize])
            .collect();
        let sizes = sizes(&refined.mesh, &of_faces, self.parts.len(), poll)?;
        let mut is_changed = false;
        for (part, now) in self
            .parts
            .iter_mut()
            .zip(sizes)
            .filter(|(part, _)| part.is_closed)
        {
            let missing = part.volume - now.volume;
            if missing.abs() <= SAME * part.volume.abs() || now.area == 0.0 {
                continue;
            }
            let by = (part.by + missing / part.effect(now)).clamp(-most, most);
            is_changed |= by != part.by;
            part.before = Some((part.by, now.volume));
            part.by = by;
        }
        Ok(is_changed)
    }
}

impl Part {
    /// The volume for a unit of shift, by the effect of the last one.
    fn effect(&self, now: Size) -> f64 {
        match self.before {
            Some((by, volume)) if by != self.by => {
                ((now.volume - volume) / (self.by - by)).clamp(LEAST_EFFECT * now.area, now.area)
            }
            _ => now.area,
        }
    }
}

/// Sets numbered from 0 in the order of their first members, by their roots; and how many there are.
fn numbered(roots: &[u32]) -> (Vec<u32>, usize) {
    let mut numbers = vec![u32::MAX; roots.len()];
    let mut count = 0;
    for &root in roots {
        if numbers[root as usize] == u32::MAX {
            numbers[root as usize] = count;
            count += 1;
        }
    }
    (
        roots.iter().map(|&root| numbers[root as usize]).collect(),
        count as usize,
    )
}

/// Area and volume of a part.
#[derive(Clone, Copy, Default)]
struct Size {
    area: f64,
    volume: f64,
}

/// The sizes of the parts of a mesh, by the part of each of its faces.
fn sizes(
    mesh: &Mesh,
    of_faces: &[u32],
    parts: usize,
    poll: &mut Poll<'_>,
) -> Result<Vec<Size>, Cancelled> {
    let mut sizes = vec![Size::default(); parts];
    // Seen from there, volumes keep their digits at any position of the mesh.
    let middle = mesh
        .as_triangles()
        .bounding_box()
        .map_or(DVec3::ZERO, |[low, high]| {
            0.5 * (vector(low) + vector(high))
        });
    for (face, &part) in of_faces.iter().enumerate() {
        if face.is_multiple_of(PIECE) {
            poll(face)?;
        }
        let [a, b, c] = mesh
            .as_triangles()
            .corners(face)
            .map(|corner| vector(corner) - middle);
        let size = &mut sizes[part as usize];
        size.area += 0.5 * (b - a).cross(c - a).length();
        size.volume += a.dot(b.cross(c)) / 6.0;
    }
    Ok(sizes)
}
