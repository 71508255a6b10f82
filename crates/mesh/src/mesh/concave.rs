//! Divides sectors that are too wide for the rules of corners by sharp edges.
//!
//! A corner keeps its place, and its limit plane is that of the two sharp edges that bound each
//! sector: the smooth surface fills the wedge between their directions, which is the sector's own
//! only up to 180°. Beyond, it fills the other side of the corner, turned over, and a flat face
//! folds over its edge. Here such a sector is divided by edges that become sharp, until each part
//! is narrower: `Σ αᵢ < π` over its angles αᵢ at the corner. Each part then has a wedge of its own.

use core::f64::consts::PI;
use core::ops::Range;
use std::collections::BTreeMap;

use super::face_parts::{Cut, divided};
use super::{
    CreaseTag, FaceParts, Finding, Mesh, MeshError, Sector, SharpRing, Sharpness, VertexRule,
};
use crate::index::{HalfEdgeId, VertexId};
use crate::math;
use crate::ring::INFINITELY_SHARP;
use crate::vector::{DVec3, unit_or_zero, vector};

/// From this angle on a sector is divided, in radians: where its two edges are in one line they span no plane, and near that
/// rounding decides on which side it is. As much as a thousandth of 180° is far more than single precision leaves.
const WIDEST: f64 = PI * (1.0 - 1e-3);

/// Faces whose normals differ by less are in one plane, in radians: 0.1°, which no shading shows.
const FLAT: f64 = 0.1 * PI / 180.0;

/// The changes to sectors of corners of 180° and more.
#[derive(Clone, Debug, PartialEq, Default)]
#[non_exhaustive]
pub struct ConcaveCorners {
    /// The corners that had such sectors.
    pub corners: Finding,
    /// Edges that became sharp, all or half of them.
    pub edges: usize,
    /// The faces that were divided, where an edge is sharp on one half only.
    pub parts: FaceParts,
}

impl Mesh {
    /// The mesh with every sector of 180° and more at its corners (vertices that keep their place,
    /// at three sharp edges or by a tag) divided by sharp edges, so that flat faces stay flat
    /// there; and a report.
    ///
    /// Of the edges inside a sector those nearest to its bisector become sharp, in a plane all that
    /// lead to other corners. Where that would make a corner of the vertex at the other end, or
    /// show a line on a curved surface, only the half at the corner does: the edge is divided in
    /// its middle, and its two faces around a point inside each. Vertices keep their numbers, and
    /// so do faces and the first parts of those that were divided; the others follow.
    ///
    /// ```
    /// use limitmesh_mesh::mesh::{CornerTag, Tags};
    /// use limitmesh_mesh::Mesh;
    ///
    /// // A flat L whose vertices all keep their place.
    /// let positions = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]].map(|[x, y]| [x as f64, y as f64, 0.0]);
    /// let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    /// let corners = (0..6).map(|vertex| CornerTag { vertex, sharpness: f64::INFINITY }).collect();
    /// let flat = Mesh::from_triangles(positions.to_vec(), triangles)?.with_tags(Tags { corners, ..Tags::default() })?;
    ///
    /// let (flat, concave) = flat.with_divided_concave_corners()?;
    /// assert_eq!((&concave.corners.first[..], concave.edges), (&[3][..], 1));
    /// assert_eq!(flat.tags().creases[0].vertices, [3, 0]);
    /// # Ok::<(), limitmesh_mesh::mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// The mesh gets more elements than can be numbered.
    pub fn with_divided_concave_corners(self) -> Result<(Self, ConcaveCorners), MeshError> {
        if self.topology().has_quads() {
            // Their halves are what they are.
            return Ok((self, ConcaveCorners::default()));
        }
        let sharpness = Sharpness::of(&self);
        let mut ribs = ribs_of(&self, &sharpness.infinitely_sharp());
        if sharpness.is_semi_sharp() {
            for (edge, rib) in ribs_of(&self, &sharpness) {
                ribs.entry(edge).or_insert(rib);
            }
        }
        if ribs.is_empty() {
            return Ok((self, ConcaveCorners::default()));
        }
        let topology = self.topology();
        let mut corners: Vec<u32> = ribs.keys().map(|&h| topology.origin(h).0).collect();
        corners.sort_unstable();
        corners.dedup();
        let mut reaching: BTreeMap<VertexId, usize> = BTreeMap::new();
        ribs.keys()
            .for_each(|&h| *reaching.entry(topology.target(h)).or_default() += 1);
        let may_reach = |end: VertexId| match sharpness.rule(end) {
            VertexRule::Corner => true,
            VertexRule::Smooth => reaching.get(&end) == Some(&1),
            _ => false,
        };
        let (mut cuts, mut creases, mut edges) = (Vec::new(), Vec::new(), 0);
        for (&h, rib) in &ribs {
            let [corner, end] = topology.ends(h);
            let Some(twin) = topology.twin(h) else {
                continue;
            };
            let is_both = ribs.contains_key(&twin);
            if is_both && twin < h {
                continue;
            }
            edges += 1;
            let end = if is_both
                || rib.is_flat && may_reach(end) && is_flat_beyond(&self, &sharpness, twin)
            {
                end.0
            } else {
                cuts.push(Cut {
                    edge: h,
                    position: rib.middle.to_array(),
                });
                (self.vertex_count() + cuts.len() - 1) as u32
            };
            creases.push(CreaseTag {
                vertices: [corner.0, end],
                sharpness: rib.sharpness,
            });
        }
        let (mut mesh, parts) = divided(&self, &cuts)?;
        mesh.tags.creases.extend(creases);
        mesh.tags = core::mem::take(&mut mesh.tags).joined(&mesh.topology, &mesh.junctions);
        let mut found = ConcaveCorners {
            edges,
            parts,
            ..ConcaveCorners::default()
        };
        corners
            .into_iter()
            .for_each(|corner| found.corners.add(corner));
        Ok((mesh, found))
    }
}

/// How an edge that divides a sector becomes sharp.
#[derive(Clone, Copy, Debug)]
struct Rib {
    sharpness: f64,
    /// Whether all faces of the sector are in one plane.
    is_flat: bool,
    /// Where it ends if it is sharp on the half at the corner only.
    middle: DVec3,
}

/// The edges that divide the sectors of all corners, by the half-edges that leave these.
fn ribs_of(mesh: &Mesh, sharpness: &Sharpness<'_>) -> BTreeMap<HalfEdgeId, Rib> {
    let mut ribs = BTreeMap::new();
    for corner in sharpness.tagged_vertices() {
        let ring = sharpness.ring(corner);
        if ring.rule() != VertexRule::Corner {
            continue;
        }
        for sector in sharpness
            .sectors(corner)
            .iter()
            .filter(|sector| sector.shape.open)
        {
            let fan = Fan::of(mesh, corner, sector);
            if !fan.is_wide() {
                continue;
            }
            let is_flat = is_flat(mesh, fan.outgoing.iter().copied());
            // Between two corners of a plane the surface is straight anyway.
            let is_straight = |h: HalfEdgeId| {
                let is_corner = sharpness.rule(mesh.topology().target(h)) == VertexRule::Corner;
                let twin = mesh.topology().twin(h).filter(|_| is_flat && is_corner);
                twin.is_some_and(|twin| is_flat_beyond(mesh, sharpness, twin))
            };
            let dividing = fan.dividing(is_straight);
            let levels = sharp_levels(&ring).min(fan.bounds(sharpness));
            let levels = if levels >= INFINITELY_SHARP {
                f64::INFINITY
            } else {
                levels
            };
            let rib = |edge: usize| Rib {
                sharpness: levels,
                is_flat,
                middle: fan.middle(edge),
            };
            ribs.extend(dividing.iter().map(|&edge| (fan.outgoing[edge], rib(edge))));
        }
    }
    ribs
}

/// The number of levels for which a vertex is a corner: its own sharpness, or that of its third edge.
fn sharp_levels(ring: &SharpRing) -> f64 {
    let mut spokes = ring.spokes.clone();
    spokes.sort_unstable_by(|a, b| b.total_cmp(a));
    spokes.get(2).copied().unwrap_or(0.0).max(ring.vertex)
}

/// A sector of a corner in space.
struct Fan {
    corner: DVec3,
    /// The half-edges that leave the corner, one for each face.
    outgoing: Vec<HalfEdgeId>,
    /// From the corner to the other ends of its edges: one more than faces.
    spokes: Vec<DVec3>,
    /// The angles of the faces at the corner.
    angles: Vec<f64>,
}

impl Fan {
    fn of(mesh: &Mesh, corner: VertexId, sector: &Sector) -> Self {
        let topology = mesh.topology();
        let place = |v: VertexId| vector(mesh.positions()[v.index()]);
        let at = place(corner);
        let spokes: Vec<DVec3> = sector.neighbours(topology).map(|v| place(v) - at).collect();
        let angle = |pair: &[DVec3]| {
            let [a, b] = [unit_or_zero(pair[0]), unit_or_zero(pair[1])];
            math::atan2(a.cross(b).length(), a.dot(b))
        };
        let angles = spokes.windows(2).map(angle).collect();
        Self {
            corner: at,
            outgoing: sector.outgoing(topology).collect(),
            spokes,
            angles,
        }
    }

    fn is_wide(&self) -> bool {
        self.angles.len() > 1 && self.angles.iter().sum::<f64>() >= WIDEST
    }

    /// The edges that divide the sector, ascending: all those that are straight, and where a part between them is still
    /// too wide the one nearest to its bisector, and so on.
    fn dividing(&self, is_straight: impl Fn(HalfEdgeId) -> bool) -> Vec<usize> {
        let mut dividing: Vec<usize> = (1..self.angles.len())
            .filter(|&edge| is_straight(self.outgoing[edge]))
            .collect();
        let ends = dividing.iter().copied().chain([self.angles.len()]);
        let starts = [0].into_iter().chain(dividing.iter().copied());
        let mut parts: Vec<Range<usize>> =
            starts.zip(ends).map(|(start, end)| start..end).collect();
        while let Some(part) = parts.pop() {
            let angle: f64 = self.angles[part.clone()].iter().sum();
            if angle < WIDEST || part.len() < 2 {
                continue;
            }
            // Nearest to the bisector; of two as near the first.
            let mut nearest = (f64::INFINITY, part.start);
            let mut before = 0.0;
            for edge in part.start + 1..part.end {
                before += self.angles[edge - 1];
                let off = (before - 0.5 * angle).abs();
                if off < nearest.0 {
                    nearest = (off, edge);
                }
            }
            let edge = nearest.1;
            dividing.push(edge);
            parts.extend([part.start..edge, edge..part.end]);
        }
        dividing.sort_unstable();
        dividing
    }

    /// The lesser sharpness of the two edges that bound the sector.
    fn bounds(&self, sharpness: &Sharpness<'_>) -> f64 {
        let [Some(&first), Some(&last)] = [self.outgoing.first(), self.outgoing.last()] else {
            return 0.0;
        };
        sharpness.edge(first).min(sharpness.edge(last.previous()))
    }

    /// The middle of an edge, moved into the plane of the edges that bound the sector, so that both parts of a curved one have
    /// this plane at the corner: no line shows there.
    fn middle(&self, edge: usize) -> DVec3 {
        let half = 0.5 * self.spokes[edge];
        let bounds = [self.spokes.first(), self.spokes.last()]
            .map(|spoke| spoke.map_or(DVec3::ZERO, |&s| unit_or_zero(s)));
        let normal = bounds[0].cross(bounds[1]);
        let off = unit_or_zero(half).dot(unit_or_zero(normal));
        if normal.length() < LEAST_SINE || off.abs() > FARTHEST_SINE {
            return self.corner + half;
        }
        self.corner + half - off * half.length() * unit_or_zero(normal)
    }
}

/// Edges nearer to one line than this sine of their angle (5°) do not define a plane.
const LEAST_SINE: f64 = 0.087;

/// An edge that leaves the plane by more than this sine (15°) is not changed: so large a movement
/// would be more visible than a line.
const FARTHEST_SINE: f64 = 0.26;

/// Whether the faces of half-edges are in one plane, those without area left aside.
fn is_flat(mesh: &Mesh, half_edges: impl Iterator<Item = HalfEdgeId>) -> bool {
    let normals: Vec<DVec3> = half_edges
        .map(|h| mesh.unit_face_normal(h.face().index()))
        .collect();
    let mean = unit_or_zero(normals.iter().sum());
    normals
        .iter()
        .all(|normal| normal.cross(mean).length() < FLAT && normal.dot(mean) >= 0.0)
}

/// Whether all faces at the vertex that a smooth edge's half-edge leaves, in the sector of that edge, are in one plane.
fn is_flat_beyond(mesh: &Mesh, sharpness: &Sharpness<'_>, h: HalfEdgeId) -> bool {
    let sectors = sharpness.sectors(mesh.topology().origin(h));
    let has = |sector: &&Sector| {
        sector
            .outgoing(mesh.topology())
            .any(|outgoing| outgoing == h)
    };
    sectors
        .iter()
        .find(has)
        .is_some_and(|sector| is_flat(mesh, sector.outgoing(mesh.topology())))
}
