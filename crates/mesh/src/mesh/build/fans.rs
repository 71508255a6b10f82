//! Polygons into fans of triangles around vertices of their own, for schemes over polygons.
//!
//! Takes the soup's polygons over welded vertices; gives triangles around each polygon's centroid. No two polygons share one of these,
//! so that connecting, orienting and cutting the triangles does it to the polygons. Their shape is free: bent, concave, twisted or
//! without area, a polygon stays whole. Only one that visits a vertex twice is cut into triangles, which are polygons then.

use core::ops::Range;

use super::triangulate::{Cutter, Faces, clean};
use crate::geometry::NONE;
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::{Diagnosis, Mesh, MeshError, PolygonFaces, PolygonSoup, Topology, Trace};
use crate::vector::{DVec3, vector};

/// A mesh of polygons, each of them a fan of triangles around a vertex of its own.
#[derive(Clone, Debug)]
pub struct Fans {
    /// The mesh.
    pub mesh: Mesh,
    /// The vertices in the polygons' middles.
    pub centres: Range<u32>,
    /// Faces and corners of the soup for those of the mesh; without meaning for the corners at centres.
    pub trace: Trace,
}

impl Fans {
    /// The half-edge of a triangle that is a side of its polygon.
    pub fn side(&self, face: FaceId) -> Option<HalfEdgeId> {
        let corners = [0, 1, 2].map(|corner| HalfEdgeId::of(face, corner));
        let topology = self.mesh.topology();
        let is_opposite = |h: &HalfEdgeId| self.centres.contains(&topology.origin(h.previous()).0);
        corners.into_iter().find(is_opposite)
    }

    /// The sides of a polygon, from one on.
    pub fn sides(&self, first: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let topology: &Topology = self.mesh.topology();
        let next = move |h: &HalfEdgeId| Some(topology.twin(h.next())?.next());
        core::iter::successors(Some(first), move |h| next(h).filter(|&h| h != first))
    }
}

/// Triangles, and the positions of the centres, which are numbered from the soup's vertices on.
pub(super) fn fans(
    soup: &PolygonSoup,
    kept: &[u32],
    diagnosis: &mut Diagnosis,
) -> Result<(Faces, Vec<[f64; 3]>), MeshError> {
    let (polygons, inputs) = polygons(soup, kept, diagnosis);
    let (first, vertices) = (kept.len(), kept.len() + polygons.len());
    if vertices >= NONE as usize {
        return Err(MeshError::TooMany {
            what: "vertices",
            count: vertices,
            limit: NONE as usize - 1,
        });
    }
    let mut faces = Faces::with_capacity(polygons.corner_count())?;
    let mut centres = Vec::with_capacity(polygons.len());
    for (polygon, input) in polygons.iter().zip(inputs) {
        let centre = (first + centres.len()) as u32;
        let next = polygon.iter().cycle().skip(1);
        for (&from, &to) in polygon.iter().zip(next) {
            faces.push([from, to, centre], input);
        }
        // Parts of a sum, which would overflow.
        let share = 1.0 / polygon.len() as f64;
        let shares = polygon
            .iter()
            .map(|&v| share * vector(soup.positions[v as usize]));
        centres.push(shares.sum::<DVec3>().to_array());
    }
    Ok((faces, centres))
}

/// The polygons without repeated ones, and the input face of each.
fn polygons(
    soup: &PolygonSoup,
    kept: &[u32],
    diagnosis: &mut Diagnosis,
) -> (PolygonFaces, Vec<u32>) {
    let (mut found, mut inputs) = (PolygonFaces::default(), Vec::new());
    let (mut cutter, mut polygon, mut sorted) = (Cutter::default(), Vec::new(), Vec::new());
    for (face, input) in soup.faces.iter().zip(0..) {
        clean(face.iter().map(|&v| kept[v as usize]), &mut polygon);
        sorted.clone_from(&polygon);
        sorted.sort_unstable();
        let before = found.len();
        if polygon.len() >= 3 && sorted.windows(2).all(|pair| pair[0] != pair[1]) {
            found.push(&polygon);
        } else if polygon.len() >= 3 {
            diagnosis.polygons.add(input);
            let mut parts = Vec::new();
            let is_proper = cutter.cut(&soup.positions, &polygon, |part| parts.push(part));
            for part in without_pairs(parts) {
                found.push(&part);
            }
            if !is_proper {
                diagnosis.twisted_polygons.add(input);
            }
        }
        if found.len() == before {
            diagnosis.collapsed_faces.add(input);
        }
        inputs.resize(found.len(), input);
    }
    without_repeated(found, inputs, diagnosis)
}

/// The triangles of a polygon without those that name a vertex twice or cover each other, of which it has some where it touches itself.
fn without_pairs(mut parts: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    let sorted = |part: &[u32; 3]| {
        let mut corners = *part;
        corners.sort_unstable();
        corners
    };
    parts.retain(|&[a, b, c]| a != b && b != c && c != a);
    parts.sort_by_key(sorted);
    let alike = parts.chunk_by(|a, b| sorted(a) == sorted(b));
    let odd = alike.filter(|alike| alike.len() % 2 == 1);
    odd.map(|alike| alike[0]).collect()
}

/// The polygons without those that repeat an earlier one, from any first corner and in either orientation.
fn without_repeated(
    polygons: PolygonFaces,
    inputs: Vec<u32>,
    diagnosis: &mut Diagnosis,
) -> (PolygonFaces, Vec<u32>) {
    let mut keys = PolygonFaces::default();
    polygons.iter().for_each(|polygon| keys.push(&key(polygon)));
    let mut order: Vec<usize> = (0..polygons.len()).collect();
    order.sort_unstable_by(|&a, &b| keys.get(a).cmp(keys.get(b)).then(a.cmp(&b)));
    let mut repeats = vec![false; polygons.len()];
    for pair in order.windows(2) {
        repeats[pair[1]] = keys.get(pair[0]) == keys.get(pair[1]);
    }
    if !repeats.contains(&true) {
        return (polygons, inputs);
    }
    let repeats = &repeats;
    let of = |is_repeated: bool| (0..repeats.len()).filter(move |&own| repeats[own] == is_repeated);
    let mut named: Vec<u32> = of(true).map(|own| inputs[own]).collect();
    named.dedup();
    diagnosis.repeated_faces.add_all(named);
    let inputs = of(false).map(|own| inputs[own]).collect();
    (of(false).map(|own| polygons.get(own)).collect(), inputs)
}

/// A polygon from its lowest vertex on, towards the lower one of those beside it.
fn key(polygon: &[u32]) -> Vec<u32> {
    let mut key = polygon.to_vec();
    let lowest = (0..key.len()).min_by_key(|&at| key[at]);
    key.rotate_left(lowest.unwrap_or(0));
    if key.last() < key.get(1) {
        key[1..].reverse();
    }
    key
}
