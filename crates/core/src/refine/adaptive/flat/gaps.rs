//! Regions whose rims could not be triangulated: gaps among those that are judged by their rims alone, or unfolded.
//!
//! Mostly chords cross where the curves do not, as around a thin ring under a coarse tolerance. So the rim is divided once more, and again;
//! if that is of no use, as where the curves cross themselves, the region is judged by its triangles, which then stay. All others
//! are what they were.

use std::collections::BTreeMap;

use super::regions::FlatRegions;
use super::strips::{Net, Region, Regions};
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::adaptive::control::Control;
use crate::refine::adaptive::demands::Demands;
use crate::refine::adaptive::divide::child_open;
use crate::refine::adaptive::quadtree::NodeAddress;

/// How often rims are divided once more.
const MOST_DIVISIONS: usize = 3;

/// Regions with gaps, and the nodes along their rims down to those that are no deeper than the rim was divided evenly; none where dividing it
/// is of no use.
#[derive(Debug, Default)]
pub(in super::super) struct Gaps(BTreeMap<u32, Vec<NodeAddress>>);

impl Gaps {
    pub(in super::super) fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// Asks for what may close the gaps; `attempt` counts from zero, and there may be so many triangles more. After finitely many
    /// of them there are no gaps.
    pub(in super::super) fn close(self, demands: &mut Demands, attempt: usize, room: usize) {
        // After so many attempts all regions are judged by their triangles.
        if attempt >= 6 {
            return demands.judge_all_by_triangles();
        }
        // Gaps are not worth the division of more than a million nodes.
        let mut room = if attempt < MOST_DIVISIONS {
            room.min(1 << 20)
        } else {
            0
        };
        for (region, along) in self.0 {
            match room.checked_sub(along.len()).filter(|_| !along.is_empty()) {
                Some(rest) => {
                    room = rest;
                    for place in along {
                        demands.add(place);
                    }
                }
                None => demands.judge_by_triangles(region),
            }
        }
    }
}

/// Regions of which nothing was found that could be triangulated, with the chords of their rims by control face; without chords where it is of
/// no use to divide these.
#[derive(Default)]
pub(in super::super) struct RimGaps(BTreeMap<u32, BTreeMap<u32, u32>>);

impl RimGaps {
    pub(in super::super) fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// The nodes that are divided to close them at this attempt.
    pub(in super::super) fn at_attempt(
        &self,
        attempt: usize,
        control: &Control<'_>,
        watch: &SharedWatch<'_>,
    ) -> Result<Gaps, Cancelled> {
        let flat = &control.flat;
        let mut gaps = Gaps::default();
        for (&region, chords) in &self.0 {
            let along = gaps.0.entry(region).or_default();
            // In the end as far as it is known to be of use.
            let is_last = attempt + 1 == MOST_DIVISIONS && flat.unfolds && !chords.is_empty();
            let least = if is_last {
                FlatRegions::divisions(flat.rim(control, region).count())
            } else {
                0
            };
            watch.each(chords, |(&face, &count)| {
                let open = control.open(face);
                let count_open = open.iter().filter(|&&open| open).count().max(1);
                let levels = (count as usize)
                    .div_ceil(count_open)
                    .next_power_of_two()
                    .ilog2();
                let levels = levels.max(least.saturating_sub(1));
                along_rim(NodeAddress::root(face), open, levels, along);
            })?;
        }
        Ok(gaps)
    }

    /// Notes a region.
    pub(super) fn note(&mut self, region: u32, chords: BTreeMap<u32, u32>) {
        let known = self.0.entry(region).or_default();
        for (face, count) in chords {
            let most = known.entry(face).or_default();
            *most = count.max(*most);
        }
    }
}

/// The number of chords of a region's rim, by control face.
pub(super) fn chords(
    region: &Region,
    net: &Net<'_>,
    regions: &Regions,
    watch: &SharedWatch<'_>,
) -> Result<BTreeMap<u32, u32>, Cancelled> {
    let mut chords = BTreeMap::new();
    watch.each(&region.triangles, |&triangle| {
        let on_rim = (3 * triangle..3 * triangle + 3)
            .filter(|&h| regions.is_rim(net, h))
            .count();
        *chords.entry(net.face(triangle)).or_default() += on_rim as u32;
    })?;
    Ok(chords)
}

/// The nodes along the open edges of one, down to so many levels below it.
fn along_rim(place: NodeAddress, open: [bool; 3], levels: u32, found: &mut Vec<NodeAddress>) {
    if open == [false; 3] {
        return;
    }
    found.push(place);
    if levels > 0 {
        (0..4).for_each(|child| {
            along_rim(
                place.child(child),
                child_open(open, child),
                levels - 1,
                found,
            )
        });
    }
}
