//! Strips: triangles that lie in one plane where the surface is straight in one direction, as between two lines of a cylinder's side.
//!
//! Quadtrees divide in both directions, though across the lines alone would do. Once everything is emitted, triangles that lie side by
//! side in one plane are put together as flat regions are, and what their rims have in common with one another gives way to straight
//! lines where it is straight: before and after it is the same set of points but for rounding, or for how far the file's coordinates
//! are off ([`FlatRegions::off_planes`]).
//!
//! Only control faces over which the surface may go on in one direction all alike are looked at: regular pieces of which a derivative is the
//! same everywhere, as over the quadrilaterals of an extruded profile, each two faces in one plane; and pieces at creases whose vertices
//! are irregular, as where the quadrilaterals are cut now this way and now that.

use limitmesh_pages::filled;

use super::regions::{FlatRegions, Plane};
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::NONE;
use crate::parallel::{IsStopped, asking};
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::normal_net::{CUBIC, tangents};
use crate::patch::{Patch, VertexSector};
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::adaptive::control::Control;
use crate::refine::kept_faces::KeptFaces;
use crate::vector::{DVec3, unit_normal, unit_or_zero, vector};
use std::collections::{HashMap, HashSet};

/// Control faces that one call takes together.
const BLOCK: usize = 64;

/// Where the coefficients of a regular piece's derivative along an edge, a quarter of them, are within a distance of the first, the vertex opposite
/// that edge is within half of so many times this distance of the middle between the vertices beyond the two other edges: the second
/// difference of these three is a sum of differences from the first, with weights whose sum is 24. A third more for rounding.
const BENT: f64 = 32.0;

/// Triangles as they were emitted.
#[derive(Clone, Copy)]
pub(in super::super) struct Net<'a> {
    pub(in super::super) positions: &'a [[f64; 3]],
    pub(in super::super) triangles: &'a [[u32; 3]],
    pub(in super::super) twins: &'a [u32],
    /// By triangle, its control face.
    pub(in super::super) parents: &'a [u32],
    /// By control face, its first triangle; one more than there are faces.
    pub(in super::super) starts: &'a [u32],
    /// The half-edges along sharp edges.
    pub(in super::super) sharp: &'a HashSet<u32>,
    /// The control faces that no triangle reaches over together.
    pub(in super::super) kept: &'a KeptFaces,
    /// Control vertices, which stand first and all stay.
    pub(in super::super) corners: usize,
}

impl Net<'_> {
    pub(super) fn at(&self, vertex: u32) -> DVec3 {
        vector(self.positions[vertex as usize])
    }

    pub(super) fn of_face(&self, face: u32) -> core::ops::Range<u32> {
        self.starts[face as usize]..self.starts[face as usize + 1]
    }

    /// The control face of a triangle.
    pub(super) fn face(&self, triangle: u32) -> u32 {
        self.parents[triangle as usize]
    }

    /// The ends of a half-edge.
    pub(super) fn ends(&self, h: u32) -> [u32; 2] {
        let triangle = self.triangles[h as usize / 3];
        [triangle[h as usize % 3], triangle[(h as usize + 1) % 3]]
    }

    /// The half-edge on the other side of one that is neither sharp nor kept nor on a boundary.
    pub(super) fn beyond(&self, h: u32) -> Option<u32> {
        let twin = self.twins[h as usize];
        let is_open = twin == NONE
            || !self.sharp.is_empty() && self.sharp.contains(&h)
            || self.kept.part(self.face(h / 3), self.face(twin / 3));
        (!is_open).then_some(twin)
    }

    fn plane(&self, triangle: u32) -> Plane {
        let corners = self.triangles[triangle as usize].map(|vertex| self.at(vertex));
        Plane {
            point: corners[0],
            normal: unit_normal(corners),
        }
    }

    fn double_area(&self, triangle: u32) -> f64 {
        let [a, b, c] = self.triangles[triangle as usize].map(|vertex| self.at(vertex));
        (b - a).cross(c - a).length()
    }
}

/// Triangles that lie in one plane.
pub(super) struct Region {
    pub(super) triangles: Vec<u32>,
    pub(super) plane: Plane,
    /// The flat region of control faces that they are, if they are one.
    pub(super) flat: Option<u32>,
}

impl Region {
    /// Whether some of its triangles are turned over.
    pub(super) fn has_turned(&self, net: &Net<'_>, is_stopped: &IsStopped<'_>) -> bool {
        asking(&self.triangles, is_stopped).any(|&triangle| {
            let [a, b, c] = net.triangles[triangle as usize].map(|vertex| net.at(vertex));
            (b - a).cross(c - a).dot(self.plane.normal) < 0.0
        })
    }

    /// Whether the surface is turned over at a corner of its control faces.
    pub(super) fn is_turned_at_corners(
        &self,
        control: &Control<'_>,
        net: &Net<'_>,
        is_stopped: &IsStopped<'_>,
    ) -> bool {
        let mut last = NONE;
        let is_new = |face: &u32| core::mem::replace(&mut last, *face) != *face;
        let triangles = asking(&self.triangles, is_stopped);
        let mut faces = triangles.map(|&triangle| net.face(triangle)).filter(is_new);
        faces.any(|face| {
            control
                .corners(face)
                .iter()
                .any(|at| at.normal.dot(self.plane.normal) < 0.0)
        })
    }
}

/// All of them, and the vertices between two of them that lie on straight lines.
pub(super) struct Regions {
    pub(super) list: Vec<Region>,
    /// By triangle, its region.
    pub(super) of_triangle: Vec<u32>,
    /// By vertex, whether it is one that need not stay; empty where there are none.
    pub(super) is_dropped: Vec<bool>,
}

impl Regions {
    pub(super) fn of(&self, triangle: u32) -> Option<u32> {
        self.of_triangle
            .get(triangle as usize)
            .copied()
            .filter(|&region| region != NONE)
    }

    pub(super) fn drops(&self, vertex: u32) -> bool {
        self.is_dropped
            .get(vertex as usize)
            .copied()
            .unwrap_or(false)
    }

    /// Whether a half-edge of a region is on its rim.
    pub(super) fn is_rim(&self, net: &Net<'_>, h: u32) -> bool {
        net.beyond(h)
            .is_none_or(|twin| self.of(twin / 3) != self.of(h / 3))
    }
}

/// The control faces over which the surface is straight in a direction that is the same all over, but for those of flat regions, ascending.
pub(super) fn straight_faces(
    control: &Control<'_>,
    normals: &[DVec3],
    flat: &[u32],
    most: f64,
    watch: &SharedWatch<'_>,
) -> Result<Vec<u32>, Cancelled> {
    let mesh = control.mesh;
    let is_flat = |face: u32| {
        flat.get(face as usize)
            .is_some_and(|&region| region != NONE)
    };
    let has_a_like_neighbour = |face: u32| {
        let first = mesh.triangles()[face as usize][0];
        let plane = Plane {
            point: vector(mesh.positions()[first as usize]),
            normal: normals[face as usize],
        };
        !is_flat(face)
            && plane.normal != DVec3::ZERO
            && (3 * face..3 * face + 3).any(|h| {
                let twin = control
                    .edges
                    .twin(h)
                    .filter(|_| control.infinitely_sharp.edge(HalfEdgeId(h)) <= 0.0);
                twin.is_some_and(|twin| {
                    !is_flat(twin / 3)
                        && plane.height(control.opposite(twin)).abs() <= most
                        && normals[twin as usize / 3].dot(plane.normal) > 0.0
                })
            })
    };
    let found = watch.pieces(mesh.face_count(), super::BLOCK, |block| {
        let faces = block.map(|face| face as u32);
        faces
            .filter(|&face| has_a_like_neighbour(face) && may_have_direction(control, face, most))
            .filter(|&face| has_direction(control, face, most))
            .collect::<Vec<u32>>()
    })?;
    Ok(found.concat())
}

/// Whether the surface over a face may be straight in a direction, by its adjacent vertices ([`BENT`]).
fn may_have_direction(control: &Control<'_>, face: u32, most: f64) -> bool {
    let Control {
        mesh, sharpness, ..
    } = *control;
    let corners = mesh.triangles()[face as usize];
    let is_edged =
        |vertex: VertexId| sharpness.is_tagged(vertex) || mesh.topology().is_boundary(vertex);
    if corners.iter().any(|&vertex| is_edged(VertexId(vertex))) {
        return true;
    }
    let adjacent = [0, 1, 2].map(|edge| {
        control
            .edges
            .twin(3 * face + edge)
            .map(|twin| control.opposite(twin))
    });
    (0..3).any(|edge| {
        let (Some(before), Some(after)) = (adjacent[(edge + 1) % 3], adjacent[(edge + 2) % 3])
        else {
            return true;
        };
        let middle = vector(mesh.positions()[corners[(edge + 2) % 3] as usize]);
        (before + after - 2.0 * middle).length() <= BENT * most
    })
}

/// Whether the surface over a face is a regular piece that has the same derivative everywhere along one of the face's edges, or may be
/// straight at creases whose vertices are irregular.
fn has_direction(control: &Control<'_>, face: u32, most: f64) -> bool {
    let points = match control.patch(face) {
        Patch::Regular(points) => points,
        Patch::Sectors(sectors) => return sectors.0.iter().any(VertexSector::is_open),
        _ => return false,
    };
    let [along, across] = tangents(&BezierTriangle::of(&points));
    let between: [DVec3; CUBIC] = core::array::from_fn(|i| across[i] - along[i]);
    let is_one = |net: &[DVec3; CUBIC]| net.iter().all(|own| own.distance(net[0]) <= most);
    [along, across, between].iter().any(is_one)
}

impl FlatRegions {
    /// The flat regions and the strips of what was emitted.
    pub(super) fn regions(
        &self,
        net: &Net<'_>,
        watch: &SharedWatch<'_>,
    ) -> Result<Regions, Cancelled> {
        let of_triangle = filled(NONE, net.triangles.len());
        let mut regions = Regions {
            list: Vec::new(),
            of_triangle,
            is_dropped: Vec::new(),
        };
        for (number, (faces, plane)) in (0u32..).zip(&self.regions) {
            let mut triangles = Vec::new();
            watch.each(
                faces.iter().flat_map(|&face| net.of_face(face)),
                |triangle| {
                    regions.of_triangle[triangle as usize] = number;
                    triangles.push(triangle);
                },
            )?;
            regions.list.push(Region {
                triangles,
                plane: *plane,
                flat: Some(number),
            });
        }
        if self.straight.is_empty() {
            return Ok(regions);
        }
        self.add_strips(net, &mut regions, watch)?;
        if regions.list.len() > self.regions.len() {
            regions.is_dropped = self.straight_lines(net, &regions, watch)?;
        }
        Ok(regions)
    }

    /// How many triangles fewer there are once these are joined.
    pub(in super::super) fn saved(
        &self,
        net: &Net<'_>,
        watch: &SharedWatch<'_>,
    ) -> Result<usize, Cancelled> {
        let regions = self.regions(net, watch)?;
        let mut saved = 0;
        watch.each(&regions.list, |region| {
            let (mut vertices, mut on_rim) = (HashSet::new(), HashSet::new());
            let (mut rim, mut dropped) = (0, 0);
            for &triangle in &region.triangles {
                vertices.extend(net.triangles[triangle as usize]);
                for h in (3 * triangle..3 * triangle + 3).filter(|&h| regions.is_rim(net, h)) {
                    let [from, _] = net.ends(h);
                    on_rim.insert(from);
                    rim += 1;
                    dropped += usize::from(regions.drops(from));
                }
            }
            if region.flat.is_some() {
                saved += dropped;
                return;
            }
            // By Euler's formula, with the vertices that stay.
            let before = region.triangles.len();
            let stay = vertices
                .iter()
                .filter(|&v| (*v as usize) < net.corners || on_rim.contains(v))
                .count();
            let twice_euler = (2 * vertices.len() + 2 * before) as i64 - (3 * before + rim) as i64;
            let after = (2 * stay) as i64 - (rim + dropped) as i64 - twice_euler;
            saved += before.saturating_sub(after.max(1) as usize);
        })?;
        Ok(saved)
    }

    /// Adds the triangles that lie side by side in one plane.
    fn add_strips(
        &self,
        net: &Net<'_>,
        regions: &mut Regions,
        watch: &SharedWatch<'_>,
    ) -> Result<(), Cancelled> {
        let is_like = |triangle: u32| {
            let plane = net.plane(triangle);
            (3 * triangle..3 * triangle + 3)
                .filter_map(|h| net.beyond(h))
                .any(|twin| {
                    let opposite = net.triangles[twin as usize / 3][(twin as usize + 2) % 3];
                    // The plane of a sliver is not known well.
                    plane.height(net.at(opposite)).abs() <= 1024.0 * self.off_planes
                })
        };
        let found = watch.pieces(self.straight.len(), BLOCK, |block| {
            let triangles = self.straight[block]
                .iter()
                .flat_map(|&face| net.of_face(face));
            let found = triangles.filter(|&triangle| is_like(triangle));
            found
                .map(|triangle| (net.double_area(triangle), triangle))
                .collect::<Vec<_>>()
        })?;
        let mut seeds = found.concat();
        // The largest know their planes best.
        seeds.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut is_left = vec![false; net.triangles.len()];
        seeds
            .iter()
            .for_each(|&(_, triangle)| is_left[triangle as usize] = true);
        watch.each(seeds, |(_, seed)| {
            if !core::mem::replace(&mut is_left[seed as usize], false) {
                return;
            }
            let plane = net.plane(seed);
            let is_in_plane = |triangle: u32| {
                let corners = net.triangles[triangle as usize].map(|vertex| net.at(vertex));
                let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                corners
                    .iter()
                    .all(|&corner| plane.height(corner).abs() <= self.off_planes)
                    && normal.dot(plane.normal) > 0.0
            };
            let mut triangles = vec![seed];
            let mut next = 0;
            while let Some(&triangle) = triangles.get(next) {
                next += 1;
                for twin in (3 * triangle..3 * triangle + 3).filter_map(|h| net.beyond(h)) {
                    if is_left[twin as usize / 3] && is_in_plane(twin / 3) {
                        is_left[twin as usize / 3] = false;
                        triangles.push(twin / 3);
                    }
                }
            }
            if triangles.len() >= 3 {
                let number = regions.list.len() as u32;
                triangles.sort_unstable();
                triangles
                    .iter()
                    .for_each(|&triangle| regions.of_triangle[triangle as usize] = number);
                regions.list.push(Region {
                    triangles,
                    plane,
                    flat: None,
                });
            }
        })
    }

    /// By vertex, whether it lies between two regions, and nothing else, on a straight line.
    fn straight_lines(
        &self,
        net: &Net<'_>,
        regions: &Regions,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<bool>, Cancelled> {
        // Around a vertex one region follows another at rims alone, so that these tell of all that are there.
        let mut between: HashMap<u32, Between> = HashMap::new();
        let mut starts = Vec::new();
        watch.each(&regions.list, |region| {
            for h in region
                .triangles
                .iter()
                .flat_map(|&triangle| 3 * triangle..3 * triangle + 3)
            {
                if !regions.is_rim(net, h) {
                    continue;
                }
                let [from, to] = net.ends(h);
                let own = regions.of_triangle[h as usize / 3];
                let Some(other) = net.beyond(h).and_then(|twin| regions.of(twin / 3)) else {
                    for vertex in [from, to] {
                        between.entry(vertex).or_default().stays = true;
                    }
                    continue;
                };
                between.entry(from).or_default().goes_on(own, to);
                if own < other {
                    starts.push((own, from, to));
                }
            }
        })?;
        let inside = |vertex: u32| {
            between
                .get(&vertex)
                .filter(|own| vertex as usize >= net.corners && own.is_inside())
        };
        let mut is_dropped = vec![false; net.positions.len()];
        watch.each(starts, |(region, from, to)| {
            if inside(from).is_some() {
                return;
            }
            let mut line = vec![from, to];
            let mut last = to;
            while let Some(next) = inside(last).and_then(|own| own.after(region)) {
                line.push(next);
                last = next;
            }
            self.straighten(net, &line, &mut is_dropped);
        })?;
        Ok(is_dropped)
    }

    /// Drops what is on the straight line between the ends, or between one end and the farthest vertex.
    fn straighten(&self, net: &Net<'_>, line: &[u32], is_dropped: &mut [bool]) {
        let mut pending = vec![line];
        while let Some(line) = pending.pop() {
            let [first, inner @ .., last] = line else {
                continue;
            };
            let [from, to] = [first, last].map(|&vertex| net.at(vertex));
            let along = unit_or_zero(to - from);
            let off = |vertex: u32| {
                (net.at(vertex) - from)
                    .reject_from_normalized(along)
                    .length()
            };
            let farthest = (1..).zip(inner).map(|(at, &vertex)| (off(vertex), at));
            let Some((most, at)) = farthest.max_by(|a, b| a.0.total_cmp(&b.0)) else {
                continue;
            };
            if along != DVec3::ZERO && most <= self.off_planes {
                inner
                    .iter()
                    .for_each(|&vertex| is_dropped[vertex as usize] = true);
            } else {
                pending.push(&line[..=at]);
                pending.push(&line[at..]);
            }
        }
    }
}

/// A vertex among regions.
#[derive(Clone, Copy)]
struct Between {
    /// The two regions around it, and by region the next vertex on their common rim.
    regions: [u32; 2],
    next: [u32; 2],
    /// Whether it stays for other reasons.
    stays: bool,
}

impl Default for Between {
    fn default() -> Self {
        Self {
            regions: [NONE; 2],
            next: [NONE; 2],
            stays: false,
        }
    }
}

impl Between {
    /// A region's rim goes on from here.
    fn goes_on(&mut self, region: u32, to: u32) {
        match self.regions.iter().position(|&own| own == NONE) {
            Some(at) if !self.regions.contains(&region) => {
                (self.regions[at], self.next[at]) = (region, to)
            }
            // A third region, or a rim that comes twice.
            _ => self.stays = true,
        }
    }

    /// Whether it is inside of the common rim of two regions.
    fn is_inside(&self) -> bool {
        !self.stays && !self.next.contains(&NONE)
    }

    /// The next vertex along a region's rim, from one inside of a common rim.
    fn after(&self, region: u32) -> Option<u32> {
        let at = self.regions.iter().position(|&own| own == region)?;
        Some(self.next[at])
    }
}

#[cfg(test)]
mod tests;
