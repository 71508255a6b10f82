//! Puts the triangles that regions come to in the place of those that give way: all that belongs to triangles, half-edges and vertices is
//! numbered anew.

use super::merge::{Assembled, Covering, edges};
use super::strips::Region;
use crate::mesh::NONE;
use crate::progress::{Cancelled, SharedWatch};
use std::collections::{HashMap, HashSet};

/// Regions with what comes in the place of their triangles.
pub(super) struct Merged<'a> {
    pub(super) list: &'a [Region],
    /// By triangle, its region.
    pub(super) of_triangle: &'a [u32],
    pub(super) coverings: &'a [Option<Covering>],
}

impl Merged<'_> {
    /// The region of a triangle that gives way, and what comes in its place.
    fn covering(&self, triangle: u32) -> Option<(u32, &Covering)> {
        let region = self.of_triangle[triangle as usize];
        self.coverings.get(region as usize)?.as_ref().map(|covering| (region, covering))
    }

    /// The mesh with the coverings that there are.
    pub(super) fn replaced(
        &self,
        mut whole: Assembled,
        starts: &[u32],
        corners: usize,
        watch: &SharedWatch<'_>,
    ) -> Result<Assembled, Cancelled> {
        self.unfold_normals(&mut whole);
        let Exchanged { mut triangles, parents, regions, first_new, fresh } =
            self.exchanged(&whole, starts, watch)?;
        let new: HashMap<[u32; 2], u32> = fresh.iter().copied().collect();
        let ends = |h: u32| [0, 1].map(|i| whole.triangles[h as usize / 3][(h as usize + i) % 3]);
        // What was inside a region is nowhere any more.
        let moved = |h: u32| match first_new[h as usize / 3] {
            NONE => new.get(&ends(h)).copied().unwrap_or(NONE),
            first => 3 * first + h % 3,
        };
        let mut twins = vec![NONE; 3 * triangles.len()];
        watch.each((0u32..).zip(whole.twins.as_chunks::<3>().0), |(triangle, beyond)| {
            for (h, &twin) in (3 * triangle..).zip(beyond) {
                let now = moved(h);
                if now != NONE && twin != NONE {
                    twins[now as usize] = moved(twin);
                }
            }
        })?;
        watch.each(fresh, |([from, to], h)| {
            if let Some(&twin) = new.get(&[to, from]) {
                twins[h as usize] = twin;
            }
        })?;
        let sides = self.sides(&whole, (&triangles, &regions), &first_new, watch)?;
        let renamed = self.renamed(&whole, corners, watch)?;
        let name = |vertex: u32| renamed[vertex as usize];
        watch.each(&mut triangles, |triangle| *triangle = triangle.map(name))?;
        let (mut tags, mut junctions) = (whole.tags, whole.junctions);
        tags.creases.iter_mut().for_each(|tag| tag.vertices = tag.vertices.map(name));
        tags.corners.iter_mut().for_each(|tag| tag.vertex = name(tag.vertex));
        junctions.vertices.rename(name);
        let borders = core::mem::take(&mut junctions.edges);
        borders.iter().for_each(|group| junctions.edges.push(group.iter().map(|&h| moved(h))));
        Ok(Assembled {
            positions: kept(whole.positions, &renamed),
            normals: kept(whole.normals, &renamed),
            origins: kept(whole.origins, &renamed),
            triangles,
            twins,
            parents,
            tags,
            sides,
            junctions,
        })
    }

    /// The triangles with those that come in the place of others, by control face and region, in that order.
    fn exchanged(
        &self,
        whole: &Assembled,
        starts: &[u32],
        watch: &SharedWatch<'_>,
    ) -> Result<Exchanged, Cancelled> {
        let mut others: Vec<(u32, u32, [u32; 3])> = Vec::new();
        let mut is_changed = vec![false; starts.len() - 1];
        watch.each((0u32..).zip(self.list.iter().zip(self.coverings)), |(number, (region, covering))| {
            let Some(covering) = covering else { return };
            others.extend(covering.triangles.iter().map(|&(triangle, face)| (face, number, triangle)));
            let faces = region.triangles.iter().map(|&triangle| whole.parents[triangle as usize]);
            faces.for_each(|face| is_changed[face as usize] = true);
        })?;
        others.sort_by_key(|&(face, region, _)| (face, region));
        others.iter().for_each(|&(face, ..)| is_changed[face as usize] = true);
        let mut others = others.into_iter().peekable();
        let most = whole.triangles.len();
        let mut found = Exchanged {
            triangles: Vec::with_capacity(most),
            parents: Vec::with_capacity(most),
            regions: Vec::with_capacity(most),
            first_new: vec![NONE; most],
            fresh: Vec::new(),
        };
        watch.each((0u32..).zip(is_changed), |(face, is_changed)| {
            let before = starts[face as usize]..starts[face as usize + 1];
            if !is_changed {
                found.keep(whole, before);
                return;
            }
            for triangle in before.filter(|&triangle| self.covering(triangle).is_none()) {
                found.keep(whole, triangle..triangle + 1);
            }
            while let Some((_, region, triangle)) = others.next_if(|&(parent, ..)| parent == face) {
                found.add(triangle, face, region);
            }
        })?;
        Ok(found)
    }

    /// The numbers of the vertices once those that only triangles have that give way are gone; [`NONE`] for these.
    fn renamed(
        &self,
        whole: &Assembled,
        corners: usize,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<u32>, Cancelled> {
        let mut is_gone = vec![false; whole.positions.len()];
        let covered = || {
            self.list
                .iter()
                .zip(self.coverings)
                .filter_map(|(region, covering)| Some((region, covering.as_ref()?)))
        };
        watch.each(covered(), |(region, _)| {
            let vertices = region.triangles.iter().flat_map(|&triangle| whole.triangles[triangle as usize]);
            vertices.for_each(|vertex| is_gone[vertex as usize] = true);
        })?;
        is_gone[..corners].fill(false);
        watch.each(covered(), |(_, covering)| {
            let vertices = covering.triangles.iter().flat_map(|(triangle, _)| triangle);
            vertices.for_each(|&vertex| is_gone[vertex as usize] = false);
        })?;
        let mut next = 0;
        let mut renamed = Vec::with_capacity(is_gone.len());
        watch.each(is_gone, |is_gone| {
            renamed.push(if is_gone { NONE } else { next });
            next += u32::from(!is_gone);
        })?;
        Ok(renamed)
    }

    /// Where a region was folded, gives its vertices that are not on sharp edges the normal of its plane: limit normals are turned
    /// over where the surface is.
    fn unfold_normals(&self, whole: &mut Assembled) {
        let folded = self.list.iter().zip(self.coverings).filter_map(|(region, covering)| {
            covering.as_ref().filter(|covering| covering.was_folded).map(|covering| (&region.plane, covering))
        });
        let mut folded = folded.peekable();
        if folded.peek().is_none() {
            return;
        }
        let corner = |&(h, _): &(u32, [f64; 3])| whole.triangles[h as usize / 3][h as usize % 3];
        let is_sided: HashSet<u32> = whole.sides.iter().map(corner).collect();
        for (plane, covering) in folded {
            for &vertex in covering.triangles.iter().flat_map(|(triangle, _)| triangle) {
                if !is_sided.contains(&vertex) {
                    whole.normals[vertex as usize] = plane.normal.to_array();
                }
            }
        }
    }

    /// The normals of corners at sharp edges: a region has one for each of its vertices that is on one.
    fn sides(
        &self,
        whole: &Assembled,
        (triangles, regions): (&[[u32; 3]], &[u32]),
        first_new: &[u32],
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<(u32, [f64; 3])>, Cancelled> {
        let was_folded = |region: u32| {
            self.coverings[region as usize].as_ref().is_some_and(|covering| covering.was_folded)
        };
        let (mut sides, mut at_rims) = (Vec::with_capacity(whole.sides.len()), HashMap::new());
        watch.each(&whole.sides, |&(h, normal)| match first_new[h as usize / 3] {
            NONE => {
                let vertex = whole.triangles[h as usize / 3][h as usize % 3];
                at_rims.insert((self.of_triangle[h as usize / 3], vertex), normal);
            }
            first => sides.push((3 * first + h % 3, normal)),
        })?;
        if at_rims.is_empty() {
            return Ok(sides);
        }
        watch.each((0u32..).zip(triangles.iter().zip(regions)), |(triangle, (vertices, &region))| {
            if region == NONE {
                return;
            }
            for (corner, &vertex) in (0u32..).zip(vertices) {
                let normal = at_rims.get(&(region, vertex)).map(|&normal| match was_folded(region) {
                    true => self.list[region as usize].plane.normal.to_array(),
                    false => normal,
                });
                sides.extend(normal.map(|normal| (3 * triangle + corner, normal)));
            }
        })?;
        sides.sort_unstable_by_key(|&(h, _)| h);
        Ok(sides)
    }
}

/// Triangles some of which have come in the place of others.
struct Exchanged {
    triangles: Vec<[u32; 3]>,
    /// By triangle, its control face, and the region that it is of where it is new.
    parents: Vec<u32>,
    regions: Vec<u32>,
    /// By triangle that there was, its number now; [`NONE`] where it has given way.
    first_new: Vec<u32>,
    /// The half-edges of new triangles, by their ends.
    fresh: Vec<([u32; 2], u32)>,
}

impl Exchanged {
    /// Adds some triangles that stay.
    fn keep(&mut self, whole: &Assembled, before: core::ops::Range<u32>) {
        let now = self.triangles.len() as u32;
        let all = before.start as usize..before.end as usize;
        self.triangles.extend_from_slice(&whole.triangles[all.clone()]);
        self.parents.extend_from_slice(&whole.parents[all.clone()]);
        self.regions.resize(self.triangles.len(), NONE);
        self.first_new[all].iter_mut().zip(now..).for_each(|(slot, now)| *slot = now);
    }

    /// Adds a triangle of a region.
    fn add(&mut self, triangle: [u32; 3], face: u32, region: u32) {
        let first = 3 * self.triangles.len() as u32;
        self.fresh.extend(edges(triangle).into_iter().zip(first..));
        self.triangles.push(triangle);
        self.parents.push(face);
        self.regions.push(region);
    }
}

/// What belongs to the vertices that are kept.
fn kept<T>(mut of_vertices: Vec<T>, renamed: &[u32]) -> Vec<T> {
    let mut is_kept = renamed.iter().map(|&name| name != NONE);
    of_vertices.retain(|_| is_kept.next().unwrap_or(true));
    of_vertices
}
