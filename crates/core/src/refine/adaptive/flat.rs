//! Regions of control faces whose limit surface is a part of a plane, such as the ends of a cylinder with creased rims.
//!
//! There the quadtrees only follow the rim: what they put inside adds nothing. Once everything is emitted, a region's triangles
//! give way to the constrained Delaunay triangulation of its rim and its control vertices ([`merge`]). So do those of
//! [`strips`]. Neither reaches over an edge that is to be kept ([`ExactOptions::kept_edges`]).
//!
//! **By their rims.** Where the surface is what the rim's curves enclose, and the triangles are what its chords do, a point of the one and not
//! of the other is between a curve and its chord, in the convex hull of the curve, so no farther from the chord than that curve's
//! points are; and as near as that to the curve: of the two ways from it at right angles to the chord one at least meets the curve and not the
//! chord before. So curves and chords are all there is to judge. That is so where the surface is proven not to be turned over
//! ([`unfolded`]), or where what the rim encloses is asked for ([`ExactOptions::unfold`]) and *is* the surface ([`enclosed`]); and only
//! where nothing smooth goes on beyond the rim. Rims whose chords cross are divided further ([`gaps`]).
//!
//! **By their triangles.** Elsewhere the triangles are judged as all are. Where they all turn the same way and the rim is simple, they cover what
//! is inside of the rim: before and after it is the same set of points, and what is proven of the one holds for the other. Where some are
//! turned over, as where slivers of a fan meet a hole, the surface folds, perhaps over its rim; there they stay.
//!
//! A face is flat where the control points whose hull holds its piece of the surface lie in the plane. A triangulation of
//! a region with the same control vertices and K vertices inside its rim's control edges has K triangles more than there are
//! control faces, by Euler's formula, whatever its holes: so plans know their triangles without any triangulation, but for what strips
//! save, and for regions that turn out to have no triangulation and keep their triangles.

mod enclosed;
mod flattened;
mod gaps;
mod joined;
mod merge;
pub(super) mod regions;
mod replace;
mod strips;
mod unfolded;

pub(super) use gaps::RimGaps;
use regions::{FlatRegions, Plane};
pub(super) use replace::Assembled;
pub(super) use strips::Net;
use unfolded::{HEIGHT_ROUNDING, MOST_UNFOLDED, height_over, is_unfolded};

use super::chains::Chains;
use super::control::Control;
use crate::index::HalfEdgeId;
use crate::mesh::NONE;
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::exact_options::ExactOptions;
use crate::vector::{DVec3, vector};

/// How far control points may be off a plane, as a part of the greatest coordinate: files in single precision round to half of this.
/// How far they are is measured, and counted with every distance.
const IN_PLANE: f64 = 2e-7;

/// Faces whose unit normals differ by more than this are not looked at any closer.
const ALIKE: f64 = 1e-3;

/// Control faces that one call takes together.
const BLOCK: usize = 1024;

impl FlatRegions {
    /// Finds the regions.
    pub(super) fn of(
        control: &Control<'_>,
        options: &ExactOptions,
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        let mesh = control.mesh;
        let size = mesh
            .positions()
            .as_flattened()
            .iter()
            .fold(0.0f64, |size, x| size.max(x.abs()));
        let share = options
            .goals
            .tolerance
            // A surface counts as flat within a thousandth of the tolerance.
            .map_or(f64::INFINITY, |tolerance| 1e-3 * tolerance);
        let most = share.min(IN_PLANE * size);
        let normals: Vec<DVec3> =
            watch.map(mesh.face_count(), BLOCK, |face| mesh.unit_face_normal(face))?;
        let found = watch.pieces(mesh.face_count(), BLOCK, |block| {
            let flat = block.map(|face| face as u32);
            let flat = flat.filter(|&face| may_be_flat(control, &normals, face, options.unfold));
            // The largest faces know their planes best.
            let area = |face: u32| mesh.face_normal_vector(face as usize).length_squared();
            flat.map(|face| (area(face), face))
                .collect::<Vec<(f64, u32)>>()
        })?;
        let mut flat = found.concat();
        let by_area = |a: &(f64, u32), b: &(f64, u32)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
        parallel::sort_polled(&mut flat, &mut |_| watch.poll(), by_area)?;
        let mut of_face = limitmesh_pages::filled(NONE, mesh.face_count());
        let mut is_left = vec![false; mesh.face_count()];
        flat.iter()
            .for_each(|&(_, face)| is_left[face as usize] = true);
        let (mut regions, mut off_planes) = (Vec::new(), 0.0f64);
        for (_, seed) in flat {
            watch.poll()?;
            if !is_left[seed as usize] {
                continue;
            }
            let point = vector(mesh.positions()[mesh.triangles()[seed as usize][0] as usize]);
            let plane = Plane {
                point,
                normal: normals[seed as usize],
            };
            is_left[seed as usize] = false;
            let height = |face: u32| {
                let is_up = options.unfold || normals[face as usize].dot(plane.normal) > 0.0;
                is_up
                    .then(|| height_over(control, face, &plane, most))
                    .flatten()
            };
            let Some(mut off_plane) = height(seed) else {
                continue;
            };
            let mut faces = vec![seed];
            let mut next = 0;
            while let Some(&face) = faces.get(next) {
                next += 1;
                if next.is_multiple_of(BLOCK) {
                    watch.poll()?;
                }
                let open = control.open(face);
                for edge in (0..3u32).filter(|&edge| !open[edge as usize]) {
                    let Some(adjacent) = control.edges.twin(3 * face + edge).map(|twin| twin / 3)
                    else {
                        continue;
                    };
                    if !is_left[adjacent as usize] || control.kept.part(face, adjacent) {
                        continue;
                    }
                    if let Some(found) = height(adjacent) {
                        is_left[adjacent as usize] = false;
                        off_plane = off_plane.max(found);
                        faces.push(adjacent);
                    }
                }
            }
            faces.sort_unstable();
            let outwards: DVec3 = faces
                .iter()
                .map(|&face| mesh.face_normal_vector(face as usize))
                .sum();
            let plane = if outwards.dot(plane.normal) < 0.0 {
                Plane {
                    normal: -plane.normal,
                    ..plane
                }
            } else {
                plane
            };
            faces
                .iter()
                .for_each(|&face| of_face[face as usize] = regions.len() as u32);
            regions.push((faces, plane));
            off_planes = off_planes.max(off_plane + HEIGHT_ROUNDING * size);
        }
        let weight = if options.caps.memory.is_some() {
            1
        } else {
            // Sixteen leaves of a flat face count as one where memory is not limited: along a rim that is divided into hundreds of parts, half
            // of them lie within a few parts of it.
            16
        };
        let straight = match options.strips && !options.is_balanced() {
            true => strips::straight_faces(control, &normals, &of_face, most, watch)?,
            false => Vec::new(),
        };
        if regions.is_empty() && straight.is_empty() {
            return Ok(Self::default());
        }
        if !straight.is_empty() {
            off_planes = off_planes.max(HEIGHT_ROUNDING * size);
        }
        let mut is_merged: Vec<bool> = of_face.iter().map(|&region| region != NONE).collect();
        straight
            .iter()
            .for_each(|&face| is_merged[face as usize] = true);
        let unfolds = options.unfold;
        let mut found = Self {
            of_face,
            straight,
            regions,
            off_planes,
            unfolds,
            by_rim: Vec::new(),
            is_enclosed: Vec::new(),
            joined: Vec::new(),
            beyond_rims: 0.0,
            is_merged,
            weight,
        };
        found.is_enclosed = match unfolds {
            true => found.enclosed(control, IN_PLANE * size, watch)?,
            false => vec![false; found.regions.len()],
        };
        if options.is_balanced() {
            found.keep_enclosed(watch)?;
            if found.regions.is_empty() {
                return Ok(Self::default());
            }
        }
        found.by_rim = found.by_rim(control, options, most, watch)?;
        found.join(control, most, size, watch)?;
        Ok(found)
    }

    /// Leaves no regions but those for which what their rims enclose stands: that is the surface, whatever is done about the rest.
    fn keep_enclosed(&mut self, watch: &SharedWatch<'_>) -> Result<(), Cancelled> {
        let mut kept = 0;
        let number = |&is_kept: &bool| {
            kept += u32::from(is_kept);
            if is_kept { kept - 1 } else { NONE }
        };
        let numbers: Vec<u32> = self.is_enclosed.iter().map(number).collect();
        watch.each(
            self.of_face.iter_mut().zip(&mut self.is_merged),
            |(region, is_merged)| {
                *region = numbers.get(*region as usize).copied().unwrap_or(NONE);
                *is_merged = *region != NONE;
            },
        )?;
        let mut numbers = numbers.into_iter();
        self.regions
            .retain(|_| numbers.next().is_some_and(|number| number != NONE));
        self.is_enclosed = vec![true; self.regions.len()];
        Ok(())
    }

    /// Which regions are judged by their rims alone, where distances alone are asked for: those with nothing but sharp edges and
    /// boundaries around them, if what their rims enclose is the surface, or is taken for it.
    fn by_rim(
        &mut self,
        control: &Control<'_>,
        options: &ExactOptions,
        most: f64,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<bool>, Cancelled> {
        let mut by_rim = vec![false; self.regions.len()];
        if !options.goals.are_distances() || !control.rules.is_certified() {
            return Ok(by_rim);
        }
        watch.each((0..).zip(&mut by_rim), |(region, by_rim)| {
            let may_be = !control.demands.judges_by_triangles(region);
            *by_rim = may_be
                && match self.unfolds {
                    true => self.is_enclosed[region as usize],
                    false => !self.has_smooth_rim(control, region),
                };
        })?;
        let is_by_rim = |face: u32| {
            self.region(face)
                .is_some_and(|region| by_rim[region as usize])
        };
        let faces: Vec<u32> = (0..self.of_face.len() as u32)
            .filter(|&face| is_by_rim(face))
            .collect();
        if self.unfolds || faces.is_empty() {
            return Ok(by_rim);
        }
        if faces.len() > MOST_UNFOLDED {
            by_rim.fill(false);
            return Ok(by_rim);
        }
        // Each takes some tenths of a millisecond.
        let folded = watch.pieces(faces.len(), 16, |block| {
            let region = |face: u32| self.of_face[face as usize] as usize;
            let is_folded =
                |&face: &u32| !is_unfolded(control, face, &self.regions[region(face)].1, most);
            let folded = faces[block].iter().copied().filter(is_folded);
            folded.map(region).collect::<Vec<_>>()
        })?;
        watch.each(folded.into_iter().flatten(), |region| {
            by_rim[region] = false
        })?;
        if by_rim.contains(&true) {
            self.beyond_rims = most;
        }
        Ok(by_rim)
    }

    /// Triangles of a plan: `own` gives those of a face that is not flat.
    pub(super) fn count(
        &self,
        control: &Control<'_>,
        chains: &Chains,
        own: impl Fn(u32) -> usize,
    ) -> usize {
        let faces = 0..control.mesh.face_count() as u32;
        faces
            .map(|face| self.count_over(control, chains, face, own(face)))
            .sum()
    }

    /// The triangles of one face, of which `own` are its own if it is not flat.
    pub(super) fn count_over(
        &self,
        control: &Control<'_>,
        chains: &Chains,
        face: u32,
        own: usize,
    ) -> usize {
        if self.region(face).is_none() {
            return own;
        }
        let rim = (3 * face..3 * face + 3).filter(|&h| self.is_rim(control, h));
        1 + rim.map(|h| chains.along(&control.edges, h)).sum::<usize>()
    }

    /// The half-edges around a region.
    fn rim<'a>(&'a self, control: &'a Control<'_>, region: u32) -> impl Iterator<Item = u32> + 'a {
        let faces = self.regions[region as usize].0.iter();
        faces
            .flat_map(|&face| 3 * face..3 * face + 3)
            .filter(move |&h| self.is_rim(control, h))
    }

    /// Whether the surface goes on smoothly somewhere beyond the rim of a region.
    fn has_smooth_rim(&self, control: &Control<'_>, region: u32) -> bool {
        self.rim(control, region)
            .any(|h| control.infinitely_sharp.edge(HalfEdgeId(h)) <= 0.0)
    }

    /// Whether a half-edge of a flat face is on the rim of its region.
    fn is_rim(&self, control: &Control<'_>, h: u32) -> bool {
        let is_sharp = control.infinitely_sharp.edge(HalfEdgeId(h)) > 0.0;
        let ends_at = |twin: u32| {
            self.region(twin / 3) != self.region(h / 3) || control.kept.part(h / 3, twin / 3)
        };
        is_sharp || control.edges.twin(h).is_none_or(ends_at)
    }
}

/// Whether a face may be flat: the adjacent faces decide it for most.
/// Faces that are turned over in one plane with others are flat where what the rim encloses is asked for: control points that were moved
/// along the rim turn slivers over.
fn may_be_flat(
    control: &Control<'_>,
    normals: &[DVec3],
    face: u32,
    may_be_turned_over: bool,
) -> bool {
    let normal = normals[face as usize];
    let open = control.open(face);
    let adjacent = (0..3u32)
        .filter(|&edge| !open[edge as usize])
        .filter_map(|edge| control.edges.twin(3 * face + edge));
    let mut adjacent = adjacent.map(|twin| normals[twin as usize / 3]);
    let is_alike = |other: DVec3| {
        let other = if may_be_turned_over && other.dot(normal) < 0.0 {
            -other
        } else {
            other
        };
        other.distance_squared(normal) <= ALIKE * ALIKE
    };
    normal != DVec3::ZERO && adjacent.all(is_alike)
}
