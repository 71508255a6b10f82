//! Triangulates the rims of flat regions anew and checks the result against the emitted triangles. The module `replace`
//! replaces these by the result.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::super::control::Control;
use super::flattened::Flattened;
use super::gaps::{RimGaps, chords};
use super::regions::FlatRegions;
use super::replace::{Assembled, Covering, Merged, edges};
use super::strips::{Net, Region, Regions};
use crate::parallel::{IsStopped, asking, sort_asking};
use crate::progress::{Cancelled, SharedWatch};

/// Areas before and after may differ by this part.
pub(super) const SAME_AREA: f64 = 1e-9;

/// The outcome for a region.
enum Fate {
    /// Its triangles stay.
    Stays,
    /// Others come in their place.
    Covered(Covering),
    /// There are none that could.
    Fails,
}

impl Fate {
    fn covering(self) -> Option<Covering> {
        match self {
            Self::Covered(covering) => Some(covering),
            Self::Stays | Self::Fails => None,
        }
    }
}

impl FlatRegions {
    /// Triangulates the regions and strips anew; gives how many of them were folded, too. `starts` has the first triangle of each control
    /// face and one more, `sharp` the half-edges along sharp edges. Control vertices stay. Notes
    /// regions that should have been triangulated and could not be.
    pub(in super::super) fn merge(
        &self,
        control: &Control<'_>,
        whole: Assembled,
        starts: &[u32],
        sharp: &HashSet<u32>,
        gaps: &mut RimGaps,
        watch: &SharedWatch<'_>,
    ) -> Result<(Assembled, usize), Cancelled> {
        if self.regions.is_empty() && self.straight.is_empty() {
            return Ok((whole, 0));
        }
        let corners = control.mesh.vertex_count();
        let net = whole.net(starts, sharp, control.kept, corners);
        let mut regions = self.regions(&net, watch)?;
        let coverings = self.coverings(control, &net, &mut regions, gaps, watch)?;
        if coverings.iter().all(Option::is_none) {
            return Ok((whole, 0));
        }
        let folded = coverings
            .iter()
            .flatten()
            .filter(|covering| covering.was_folded)
            .count();
        let Regions {
            list, of_triangle, ..
        } = regions;
        let merged = Merged {
            list: &list,
            of_triangle: &of_triangle,
            coverings: &coverings,
        };
        Ok((merged.replaced(whole, starts, corners, watch)?, folded))
    }

    /// The triangles of each region, where others come in their place.
    fn coverings(
        &self,
        control: &Control<'_>,
        net: &Net<'_>,
        regions: &mut Regions,
        gaps: &mut RimGaps,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<Option<Covering>>, Cancelled> {
        for round in 0.. {
            let fates = watch.long_pieces(regions.list.len(), 1, |block, is_stopped| {
                let fate = |region| self.fate(region, control, net, regions, is_stopped);
                block.map(fate).collect::<Vec<_>>()
            })?;
            let fates: Vec<Fate> = fates.into_iter().flatten().collect();
            let stays: Vec<bool> = fates
                .iter()
                .map(|fate| matches!(fate, Fate::Stays))
                .collect();
            let fails: Vec<bool> = fates
                .iter()
                .map(|fate| matches!(fate, Fate::Fails))
                .collect();
            let coverings = fates.into_iter().map(Fate::covering).collect();
            let coverings = without_shared_edges(coverings, net, regions, watch)?;
            // A region that keeps its triangles keeps what is on its rim.
            let mut is_kept = false;
            watch.each(regions.list.iter().zip(&coverings), |(region, covering)| {
                if covering.is_none() && !regions.is_dropped.is_empty() {
                    for &vertex in region
                        .triangles
                        .iter()
                        .flat_map(|&at| &net.triangles[at as usize])
                    {
                        is_kept |= core::mem::take(&mut regions.is_dropped[vertex as usize]);
                    }
                }
            })?;
            if is_kept {
                // After eight rounds all of them keep what they have in common.
                if round >= 8 {
                    regions.is_dropped.clear();
                }
                continue;
            }
            for (at, region) in regions.list.iter().enumerate() {
                let Some(flat) = region.flat.filter(|_| coverings[at].is_none()) else {
                    continue;
                };
                if fails[at] && !control.demands.judges_by_triangles(flat) {
                    gaps.note(flat, chords(region, net, regions, watch)?);
                } else if self.is_by_rim(region) && !stays[at] {
                    // Finer rims have edges in common with others just the same.
                    gaps.note(flat, BTreeMap::new());
                }
            }
            return Ok(coverings);
        }
        Ok(Vec::new())
    }

    /// Whether a region is judged by its rim alone.
    fn is_by_rim(&self, region: &Region) -> bool {
        region.flat.is_some_and(|flat| self.by_rim[flat as usize])
    }

    /// The outcome for a region: its triangles give way if there can be fewer, if they are those of its rim alone, or if they fold and
    /// what is around them is asked for.
    fn fate(
        &self,
        region: usize,
        control: &Control<'_>,
        net: &Net<'_>,
        regions: &Regions,
        is_stopped: &IsStopped<'_>,
    ) -> Fate {
        let own = &regions.list[region];
        let (before, by_rim) = (&own.triangles, self.is_by_rim(own));
        let is_divided = own
            .flat
            .is_none_or(|flat| before.len() > self.regions[flat as usize].0.len());
        let is_enclosed = own.flat.is_some_and(|flat| self.is_enclosed[flat as usize]);
        let may_change = is_divided || by_rim || is_enclosed && own.has_turned(net, is_stopped);
        if !may_change {
            return Fate::Stays;
        }
        let mut flat = Flattened::new(&own.plane, self.off_planes, net.positions);
        let Some(outline) = Outline::of(own, net, regions, &mut flat, is_stopped) else {
            return if by_rim { Fate::Fails } else { Fate::Stays };
        };
        let has_turned = outline.has_turned
            || is_enclosed && by_rim && own.is_turned_at_corners(control, net, is_stopped);
        // Where the surface is proven not to be turned over, coarse triangles alone are.
        let was_folded = has_turned && (is_enclosed || !by_rim);
        if !is_divided && !has_turned || was_folded && !is_enclosed {
            return Fate::Stays;
        }
        let is_wanted = by_rim || was_folded;
        let covering = Self::covering(
            outline,
            flat,
            before,
            is_wanted,
            was_folded,
            self.off_planes,
            is_stopped,
        );
        match covering {
            Some(covering) => Fate::Covered(covering),
            None if is_wanted => Fate::Fails,
            None => Fate::Stays,
        }
    }

    /// Triangulates the inside of an outline. `None` unless it has the area of the triangles `before`, and fewer triangles or `is_wanted`.
    fn covering(
        outline: Outline,
        mut flat: Flattened<'_>,
        before: &[u32],
        is_wanted: bool,
        was_folded: bool,
        off_planes: f64,
        is_stopped: &IsStopped<'_>,
    ) -> Option<Covering> {
        let (along, lines) = outline.straightened();
        let rim: Vec<[u32; 2]> = along
            .iter()
            .map(|(ends, _)| ends.map(|vertex| flat.number(vertex)))
            .collect();
        let along: HashMap<[u32; 2], u32> = along.into_iter().collect();
        let (triangles, found) = flat.triangulated(&rim, is_stopped)?;
        let Outline {
            area,
            length,
            after,
            ..
        } = outline;
        let off = if after.is_empty() {
            0.0
        } else {
            2.0 * off_planes * length
        };
        let is_same = (is_wanted || triangles.len() < before.len())
            && (found - area).abs() <= SAME_AREA * area + off;
        if !is_same {
            return None;
        }
        Some(Covering {
            triangles: by_face(triangles, &along, is_stopped)?,
            lines,
            was_folded,
        })
    }
}

/// An edge on a rim, and the control face of its triangle.
type RimEdge = ([u32; 2], u32);

/// The rim of a region.
struct Outline {
    /// The edges from vertices that stay.
    rim: Vec<RimEdge>,
    /// The next vertex after each vertex that may be left out.
    after: HashMap<u32, u32>,
    /// Twice the area.
    area: f64,
    /// Of the edges in `rim`, all together.
    length: f64,
    /// Whether some of the triangles are turned over.
    has_turned: bool,
}

impl Outline {
    /// Numbers the control vertices inside; `None` where a triangle is not in the plane.
    fn of(
        own: &Region,
        net: &Net<'_>,
        regions: &Regions,
        flat: &mut Flattened<'_>,
        is_stopped: &IsStopped<'_>,
    ) -> Option<Self> {
        let (rim, after) = (Vec::new(), HashMap::new());
        let mut found = Self {
            rim,
            after,
            area: 0.0,
            length: 0.0,
            has_turned: false,
        };
        for &triangle in asking(&own.triangles, is_stopped) {
            let part = flat.area(net.triangles[triangle as usize])?;
            found.area += part;
            found.has_turned |= !flat.is_positive(part);
            for h in 3 * triangle..3 * triangle + 3 {
                let [from, to] = net.ends(h);
                if !regions.is_rim(net, h) {
                    if (from as usize) < net.corners {
                        flat.number(from);
                    }
                } else if regions.drops(from) {
                    found.after.insert(from, to);
                } else {
                    found.rim.push(([from, to], net.face(triangle)));
                    found.length += net.at(from).distance(net.at(to));
                }
            }
        }
        Some(found)
    }

    /// The edges between vertices that stay, and those of them that are new.
    fn straightened(&self) -> (Vec<RimEdge>, Vec<[u32; 2]>) {
        let (mut edges, mut lines) = (Vec::with_capacity(self.rim.len()), Vec::new());
        for &([from, next], face) in &self.rim {
            let after = |vertex: &u32| self.after.get(vertex).copied();
            let to = core::iter::successors(Some(next), after)
                .last()
                .unwrap_or(next);
            edges.push(([from, to], face));
            lines.extend((to != next).then_some([from, to]));
        }
        (edges, lines)
    }
}

/// The coverings whose new edges are none that the mesh has elsewhere: two flat sheets may share their rims, and an edge has two
/// faces.
fn without_shared_edges(
    mut coverings: Vec<Option<Covering>>,
    net: &Net<'_>,
    regions: &Regions,
    watch: &SharedWatch<'_>,
) -> Result<Vec<Option<Covering>>, Cancelled> {
    let mut is_covered = vec![false; net.positions.len()];
    watch.each(
        coverings
            .iter()
            .flatten()
            .flat_map(|covering| &covering.triangles),
        |(triangle, _)| {
            triangle
                .iter()
                .for_each(|&vertex| is_covered[vertex as usize] = true);
        },
    )?;
    // By its ends, the region that an edge is inside of; none where it is on rims, or elsewhere.
    let covered: usize = coverings
        .iter()
        .flatten()
        .map(|covering| covering.triangles.len())
        .sum();
    // With room for the edges before and after: maps that grow move all that they have at once.
    let mut owners = HashMap::with_capacity(3 * covered);
    let touched = watch.pieces(net.triangles.len(), 1 << 14, |block| {
        let all =
            block.flat_map(|number| edges(net.triangles[number]).map(|ends| (ends, number as u32)));
        let touched =
            all.filter(|(ends, _)| ends.iter().all(|&vertex| is_covered[vertex as usize]));
        touched
            .map(|([from, to], number)| ([from.min(to), from.max(to)], number))
            .collect::<Vec<_>>()
    })?;
    watch.each(touched.into_iter().flatten(), |(ends, number)| {
        let own = regions.of(number);
        let owner = owners.entry(ends).or_insert(own);
        *owner = owner.filter(|_| *owner == own);
    })?;
    let mut all_lines = HashSet::new();
    for (region, covering) in (0u32..).zip(&mut coverings) {
        let Some(Covering {
            triangles, lines, ..
        }) = covering
        else {
            continue;
        };
        let all = || triangles.iter().flat_map(|&(triangle, _)| edges(triangle));
        let mut directed = HashSet::with_capacity(3 * triangles.len());
        watch.each(all(), |ends| {
            directed.insert(ends);
        })?;
        let mut inner: Vec<[u32; 2]> = Vec::new();
        watch.each(all(), |[from, to]| {
            if from < to && directed.contains(&[to, from]) {
                inner.push([from, to]);
            }
        })?;
        let is_others = |ends: [u32; 2]| {
            owners
                .get(&ends)
                .is_some_and(|&owner| owner != Some(region))
        };
        // A line has one region on either side: where sheets touch, two may have the same ends.
        let is_taken = |&[from, to]: &[u32; 2]| {
            all_lines.contains(&[from, to])
                || !all_lines.contains(&[to, from]) && is_others([from.min(to), from.max(to)])
        };
        let mut is_shared = lines.iter().any(is_taken);
        watch.each(&inner, |&ends| is_shared |= is_others(ends))?;
        if is_shared {
            *covering = None;
            continue;
        }
        watch.each(inner, |ends| {
            owners.insert(ends, Some(region));
        })?;
        for &[from, to] in &*lines {
            all_lines.insert([from, to]);
            owners.entry([from.min(to), from.max(to)]).or_insert(None);
        }
    }
    Ok(coverings)
}

/// Gives each triangle a control face: that of a rim edge of its own, else that of an adjacent triangle. `None` where one is
/// reached from no rim.
fn by_face(
    triangles: Vec<[u32; 3]>,
    along: &HashMap<[u32; 2], u32>,
    is_stopped: &IsStopped<'_>,
) -> Option<Vec<([u32; 3], u32)>> {
    // Maps that grow move all that they have at once.
    let mut by_edge = HashMap::with_capacity(3 * triangles.len());
    for (at, &triangle) in asking(triangles.iter().enumerate(), is_stopped) {
        edges(triangle).into_iter().for_each(|ends| {
            by_edge.insert(ends, at);
        });
    }
    let on_rim = |&triangle: &[u32; 3]| {
        edges(triangle)
            .into_iter()
            .find_map(|ends| along.get(&ends).copied())
    };
    let mut faces: Vec<Option<u32>> = asking(triangles.iter(), is_stopped).map(on_rim).collect();
    if is_stopped() {
        return None;
    }
    let mut known: Vec<usize> = (0..faces.len()).filter(|&at| faces[at].is_some()).collect();
    for next in asking(0.., is_stopped) {
        let Some(&at) = known.get(next) else { break };
        for [from, to] in edges(triangles[at]) {
            if along.contains_key(&[from, to]) {
                continue;
            }
            if let Some(&adjacent) = by_edge.get(&[to, from])
                && faces[adjacent].is_none()
            {
                faces[adjacent] = faces[at];
                known.push(adjacent);
            }
        }
    }
    let numbered = (0u32..).zip(faces).map(|(at, face)| Some((face?, at)));
    let mut order: Vec<(u32, u32)> = asking(numbered, is_stopped).collect::<Option<_>>()?;
    sort_asking(&mut order, is_stopped);
    Some(
        asking(order, is_stopped)
            .map(|(face, at)| (triangles[at as usize], face))
            .collect(),
    )
}
