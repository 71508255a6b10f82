//! Measures the emitted triangles among their neighbours as they are: a bound for each, and those that fail.
//!
//! Takes an emission, its vertices moved off the surface or not ([`super::offsets`]); gives, by control face, the
//! greatest bound of a distance and where it is, and the leaves whose values are too much. Distances to moved triangles are
//! bounded as [`crate::certificate::Deviation::off`] and [`EdgeBounds::deviation_off`] say.

mod at_once;
mod fours;

use core::ops::Range;
use std::collections::HashSet;

use smallvec::SmallVec;

use super::back_faces::BackFaces;
use super::backs::{Behind, looks_away};
use super::bulges::{Bulge, Bulges};
use super::changes::Changes;
use super::emit::Emission;
use super::emitted::{Emitted, Over, Sources, TriangleVisitor};
use super::judge::{Goal, ROUNDED};
use super::measured::{FoundLast, Measured, Value, fail};
use super::neighbours::{Neighbours, angles, neighbours, sharp_edges};
use super::quadtree::NodeAddress;
use super::seen::{DIVISIONS, Seen};
use super::surface::Surface;
use crate::certificate::{
    Deviation, EdgeBounds, Effort, Heights, Pieces, SubTriangle, TriangleFrame, exceeds,
};
use crate::criterion::{Apart, Backs, Criteria, Region, Viewpoint};
use crate::patch::{LimitPoint, Rules};
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::{DVec3, vector};

/// How triangles are looked at.
#[derive(Clone, Copy)]
pub(super) struct Look<'a> {
    pub(super) goal: &'a Goal,
    /// Leaves above this level that fail are divided: what they have does not count.
    pub(super) divided_above: u32,
    /// Bounds of distances below this, of triangles that do not fail, need not be tight.
    pub(super) length: f64,
    /// Triangles that these do not concern are not looked at.
    pub(super) changes: Option<&'a Changes>,
    /// How the surface bulges over the triangles as they are emitted, where that is known: most need nothing else.
    pub(super) bulges: Option<&'a Bulges>,
    /// By control face, whether its proven leaves are not looked at; empty if all are.
    pub(super) trusted: &'a [bool],
}

/// Looks at the triangles of some control faces.
pub(super) fn measure(
    sources: &Sources<'_>,
    watch: &SharedWatch<'_>,
    faces: &[u32],
    look: &Look<'_>,
) -> Result<Vec<Measured>, Cancelled> {
    let sharp = sharp_edges(sources.emission, watch)?;
    let measured = watch.long_shares(faces.len(), |block, is_stopped| {
        let measured = faces[block].iter().map(|&face| {
            let mut measuring = Measuring::of(sources, face, &sharp, look);
            if measuring.is_trusted && sources.is_whole(face) {
                return measuring.found;
            }
            let bulge = look
                .bulges
                .filter(|_| measuring.criteria.is_none() && !measuring.rim_alone);
            let bulge = bulge.map(|Bulges(bulges)| &bulges[face as usize]);
            if let Some(bulge) = bulge {
                measuring.found.each = bulge.found_last();
                let is_left = measuring.at_once(face, bulge);
                let is_done = !is_left.contains(&true);
                measuring.is_left = Some(is_left);
                if is_done {
                    return measuring.found(Some(bulge));
                }
            } else if measuring.by_fours(sources, face, is_stopped) {
                return measuring.found(None);
            }
            sources.show(face, is_stopped, &mut measuring);
            measuring.found(bulge)
        });
        measured.collect::<Vec<_>>()
    })?;
    let mut all = Vec::with_capacity(faces.len());
    watch.each(measured, |mut block| all.append(&mut block))?;
    Ok(all)
}

struct Measuring<'a> {
    emission: &'a Emission,
    criteria: Option<&'a Criteria>,
    back_faces: &'a BackFaces,
    /// Whether nothing counts but the rim of a flat region.
    rim_alone: bool,
    /// Whether proven leaves are not looked at, and somebody counts on what the others have.
    is_trusted: bool,
    counts_normal_deviations: bool,
    sharp: &'a HashSet<u32>,
    /// Others need not be looked at.
    changes: Option<&'a Changes>,
    /// The number of the face's first triangle, and which of its triangles are left to be looked at; `None` if all those are.
    first: u32,
    is_left: Option<Vec<bool>>,
    /// Greatest value.
    limit: f64,
    divided_above: u32,
    length: f64,
    found: Measured,
    /// The triangles that fail, their leaves, and their values.
    failing: Vec<(u32, NodeAddress, f64)>,
}

impl TriangleVisitor for Measuring<'_> {
    fn wants(&self, _: NodeAddress, triangles: Range<u32>) -> bool {
        let own = (triangles.start - self.first) as usize..(triangles.end - self.first) as usize;
        self.is_left
            .as_ref()
            .is_none_or(|is_left| is_left[own].contains(&true))
    }

    fn skips_proven(&self) -> bool {
        self.is_trusted
    }

    fn wants_triangle(&mut self, emitted: &Emitted) -> bool {
        match &self.is_left {
            Some(is_left) => is_left[(emitted.number - self.first) as usize],
            None => self
                .changes
                .is_none_or(|changes| changes.concern(self.emission, emitted.number)),
        }
    }

    fn triangle<'p>(&mut self, emitted: &Emitted, mut over: Over<'_, 'p>, rules: &'p Rules<'p>) {
        if self.rim_alone {
            return self.along_rim(emitted, over, rules);
        }
        if self.counts_normal_deviations {
            let extent = Seen::of(&over.corners()).extent();
            self.see(extent.normal_deviation, extent.slope);
        }
        let mut among = Among::of(self.emission, self.sharp, emitted, self.criteria);
        if let Some(criteria) = self.criteria {
            among.backs = among.looks_away(criteria, |viewer, rest| {
                Behind::of(self.back_faces, emitted, &over, rules).is_back(
                    &over.corners(),
                    viewer,
                    rest,
                )
            });
        }
        let cone = match self.criteria.filter(|criteria| criteria.has_cones()) {
            None => 0.0,
            Some(criteria) => among.cone(criteria, emitted.place, &over.corners()),
        };
        // Heights that are met, and about the greatest.
        let height = match &mut over {
            Over::Regular(quartic, cell, _) => {
                let heights = quartic.jet().heights(cell, among.frame.normal());
                Height::Regular(heights.lifted_range(among.lifts), heights)
            }
            Over::General(_, _, surface) => {
                Height::General(self.attained(&among, emitted, *surface))
            }
        };
        if self.fails_for_sure(height.least()) {
            return self.take(
                emitted.number,
                emitted.place,
                Value::failing(height.least()),
                0.0,
            );
        }
        let mut best: Option<Value> = None;
        let mut is_enough = |deviation: Deviation| {
            let value = self.value(&among, &deviation);
            let value = best.map_or(value, |known| value.least(&known));
            best = Some(value);
            value.value <= self.limit && value.bound <= self.length
        };
        let highest = match (over, height) {
            (Over::Regular(quartic, cell, domain), Height::Regular((height, rest), heights)) => {
                let by_piece = quartic.jet().edge_bounds(&cell, &among.frame, emitted.open);
                let edges =
                    quartic
                        .jet()
                        .closer_edge_bounds(&by_piece, &cell, &among.frame, emitted.open);
                let off = |height| edges.deviation_off(height, among.moved, among.aside);
                let refined =
                    || heights.lifted(among.lifts, DIVISIONS, self.high_enough(&among, &off(0.0)));
                // Nothing that is loose depends on heights.
                let is_met =
                    is_enough(off(height + rest)) || !edges.is_loose() && is_enough(off(refined()));
                if !is_met && !self.fails_by_height(&among, &edges, &off(height - rest)) {
                    let net = quartic.net(domain, emitted.part);
                    let deviation =
                        net.deviation(&among.frame, rules, self.effort(&among, emitted));
                    is_enough(deviation.off(among.moved, among.aside));
                }
                height
            }
            (Over::General(pieces, ..), height) => {
                let deviation = self.by_pieces(&among, emitted, pieces, rules);
                is_enough(deviation);
                // A triangle with a viewer's criterion alone has no height of its own.
                height.least().max(deviation.height - deviation.across)
            }
            (Over::Regular(..), Height::General(height)) => height,
        };
        let Some(value) = best else { return };
        let value = Value {
            value: if exceeds(value.value, cone) {
                value.value
            } else {
                cone
            },
            ..value
        };
        self.take(emitted.number, emitted.place, value, highest);
    }
}

impl<'a> Measuring<'a> {
    fn of(sources: &Sources<'a>, face: u32, sharp: &'a HashSet<u32>, look: &Look<'a>) -> Self {
        let (control, emission) = (sources.control, sources.emission);
        Self {
            emission,
            criteria: control.criteria.as_ref(),
            back_faces: &control.back_faces,
            rim_alone: control.flat.is_its_rim(face),
            is_trusted: look.trusted.get(face as usize).copied().unwrap_or(false),
            counts_normal_deviations: !look.trusted.is_empty(),
            sharp,
            changes: look.changes,
            first: emission.triangles_of(face).start as u32,
            is_left: None,
            limit: look.goal.allowed(face),
            divided_above: look.divided_above,
            length: look.length,
            found: Measured::nothing(face),
            failing: Vec::new(),
        }
    }

    /// The result for all triangles.
    fn found(mut self, bulge: Option<&Bulge>) -> Measured {
        let each = core::mem::take(&mut self.found.each);
        for (number, known) in each
            .iter()
            .enumerate()
            .filter(|(_, known)| !known.offsets[0].is_nan())
        {
            let found = &mut self.found;
            found.value = found.value.max(known.value);
            let fails = exceeds(known.value, self.limit);
            if fails
                || exceeds(known.bound, found.worst.0)
                || exceeds(known.height, found.highest.0)
            {
                let place = bulge.map_or(found.worst.1, |bulge| {
                    bulge.place(found.worst.1.face, number)
                });
                found.add(
                    place,
                    &Value {
                        bound: known.bound,
                        value: known.value,
                        pixels: 0.0,
                    },
                    known.height,
                );
                if fails {
                    fail(&mut found.failing, place, known.value);
                }
            }
        }
        self.found.each = each;
        // Triangles of a leaf stand together.
        self.failing.sort_by_key(|&(number, ..)| number);
        for (_, place, value) in self.failing {
            fail(&mut self.found.failing, place, value);
        }
        self.found
    }

    /// Takes what neighbours see of a triangle.
    fn see(&mut self, normal_deviation: f64, slope: f64) {
        self.found.normal_deviation = self.found.normal_deviation.max(normal_deviation);
        self.found.slope = self.found.slope.min(slope);
    }

    /// Takes the value of a triangle and the height of the surface over it.
    fn take(&mut self, number: u32, place: NodeAddress, value: Value, height: f64) {
        if let Some(known) = self.found.each.get_mut((number - self.first) as usize) {
            let offsets = self.emission.offsets_of(number as usize);
            *known = FoundLast {
                offsets,
                bound: value.bound,
                value: value.value,
                height,
            };
            return;
        }
        let fails = exceeds(value.value, self.limit);
        if fails {
            self.failing.push((number, place, value.value));
        }
        if !fails || place.level >= self.divided_above {
            self.found.add(place, &value, height);
        }
    }

    /// A triangle of a flat region, of whose edges those on the rim count alone.
    fn along_rim<'p>(&mut self, emitted: &Emitted, over: Over<'_, 'p>, rules: &'p Rules<'p>) {
        if emitted.open == [false; 3] {
            return;
        }
        let at = |vertex: u32| vector(self.emission.positions[vertex as usize]);
        let frame = TriangleFrame::new(emitted.vertices.map(at));
        let effort = Effort::along_rim(self.limit.min(self.length), emitted.open);
        let deviation = match over {
            Over::Regular(quartic, _, domain) => quartic
                .net(domain, emitted.part)
                .deviation(&frame, rules, effort),
            Over::General(pieces, ..) => pieces.deviation(emitted.part, &frame, rules, effort),
        };
        let bound = deviation.own;
        self.take(emitted.number, emitted.place, Value::of(bound), bound);
    }

    /// Whether a triangle with a point of the surface so high over it fails for sure: then it needs no bound, as long as it is
    /// divided. It never does where tight bounds or more than distances are asked for.
    fn fails_for_sure(&self, height: f64) -> bool {
        self.length.is_infinite() && self.criteria.is_none() && height > self.limit
    }

    /// Whether a triangle fails by its height alone: it would pass with the least possible height, so its tangential displacements are good enough,
    /// and nets bound heights no better than derivatives do. It never does where tight bounds or more than distances are asked for.
    fn fails_by_height(&self, among: &Among, edges: &EdgeBounds, least: &Deviation) -> bool {
        let counts_alone = self.length.is_infinite() && self.criteria.is_none();
        counts_alone && !edges.is_loose() && least.bound(among.chords, among.slopes) <= self.limit
    }

    /// The greatest height of a few points of a piece that is not regular.
    fn attained(&self, among: &Among, emitted: &Emitted, surface: Surface<'_>) -> f64 {
        if self.length.is_finite() || self.criteria.is_some() || emitted.part != SubTriangle::Whole
        {
            return 0.0;
        }
        surface
            .middles()
            .iter()
            .map(|point| among.frame.height(point.position).abs())
            .fold(0.0, f64::max)
    }

    /// The height over a triangle that is surely good enough, given the deviation for none: it need not be known better. 0 where
    /// there is none, or where more counts than distances.
    fn high_enough(&self, among: &Among, flat: &Deviation) -> f64 {
        let target = self.limit.min(self.length);
        let can_be = self.criteria.is_none() && target.is_finite() && flat.is_within(among.slopes);
        let (within, aside) = (flat.height_within(target, among.chords), 2.0 * among.aside);
        // As far as `Deviation::off` lets it be.
        if can_be && within > aside {
            ROUNDED * (within * within - aside * aside).sqrt()
        } else {
            0.0
        }
    }

    fn by_pieces<'p>(
        &self,
        among: &Among,
        emitted: &Emitted,
        pieces: &mut Pieces<'p>,
        rules: &'p Rules<'p>,
    ) -> Deviation {
        let deviation = pieces.deviation(
            emitted.part,
            &among.frame,
            rules,
            self.effort(among, emitted),
        );
        deviation.off(among.moved, among.aside)
    }

    /// The effort for a bound.
    fn effort(&self, among: &Among, emitted: &Emitted) -> Effort {
        let allowed = match self.criteria {
            None => self.limit,
            Some(criteria) => self.limit * criteria.allowed_length(&among.region(), &among.backs),
        };
        Effort {
            target: allowed.min(self.length),
            // A net is halved often towards a corner with too steep tangential displacements, where only short pieces are near.
            halvings: 10,
            open: emitted.open,
            chords: among.chords,
            slopes: among.slopes,
            rim_alone: false,
            gives_up: false,
            least_chord: None,
        }
    }

    /// The value of the triangle with this deviation.
    fn value(&self, among: &Among, deviation: &Deviation) -> Value {
        let bound = deviation.bound(among.chords, among.slopes);
        let Some(criteria) = self.criteria else {
            return Value::of(bound);
        };
        let apart: Apart = deviation.apart(among.chords, among.slopes);
        let region = among.region().grown(apart.own);
        let value = criteria.distance_ratio(&apart, &region, &among.backs);
        Value {
            bound,
            value,
            pixels: criteria
                .pixels(&apart, &region, &among.backs)
                .unwrap_or(0.0),
        }
    }
}

/// The height of the surface over a triangle, on either side.
enum Height {
    /// That of the quadratic part, by how much it may be off, and all parts.
    Regular((f64, f64), Heights),
    /// The greatest height in a few places.
    General(f64),
}

impl Height {
    /// Some point stands as high as this.
    fn least(&self) -> f64 {
        match self {
            Self::Regular((height, rest), _) => height - rest,
            Self::General(height) => *height,
        }
    }
}

/// A triangle among its neighbours.
struct Among {
    corners: [DVec3; 3],
    frame: TriangleFrame,
    /// The chords of the angles between its plane and its neighbours', by edge.
    chords: [f64; 3],
    /// The greatest slopes of tangential displacements over its edges.
    slopes: [f64; 3],
    /// Heights of the surface's corners over the triangle's plane.
    lifts: [f64; 3],
    /// How far the corners were moved.
    moved: f64,
    /// How far within the plane.
    aside: f64,
    /// The adjacent triangles, where they are asked for.
    neighbours: Neighbours,
    /// Who sees nothing but its back and theirs.
    backs: Backs,
}

impl Among {
    fn of(
        emission: &Emission,
        sharp: &HashSet<u32>,
        emitted: &Emitted,
        criteria: Option<&Criteria>,
    ) -> Self {
        let corners = emitted
            .vertices
            .map(|vertex| vector(emission.positions[vertex as usize]));
        let frame = TriangleFrame::new(corners);
        let (chords, slopes) = angles(emission, sharp, emitted.number);
        let neighbours = match criteria.is_some_and(|criteria| criteria.viewers() > 0) {
            true => neighbours(emission, sharp, emitted.number),
            false => [None; 3],
        };
        let [chords, slopes] =
            [chords, slopes].map(|own| [0, 1, 2].map(|edge| own[(emitted.turn + edge) % 3]));
        let steps = emitted.vertices.map(|vertex| emission.step(vertex));
        let (mut moved, mut aside) = (0.0f64, 0.0f64);
        let lifts = steps.map(|step| {
            let lift = frame.normal().dot(step);
            moved = moved.max(step.length());
            aside = aside.max((step - lift * frame.normal()).length());
            -lift
        });
        let backs = Backs::nobodys();
        Self {
            corners,
            frame,
            chords,
            slopes,
            lifts,
            moved,
            aside,
            neighbours,
            backs,
        }
    }

    /// The viewers that see nothing but the back of the triangle, of the adjacent ones, and of its piece.
    fn looks_away(
        &self,
        criteria: &Criteria,
        piece: impl Fn((usize, &Viewpoint), f64) -> Option<f64>,
    ) -> Backs {
        let own = core::iter::once(self.corners);
        let triangles: SmallVec<[_; 4]> =
            own.chain(self.neighbours.into_iter().flatten()).collect();
        looks_away(criteria, &self.region(), &triangles, self.moved, piece)
    }

    fn region(&self) -> Region {
        Region::around(self.corners, self.frame.normal())
            .turned(self.chords.into_iter().fold(0.0, f64::max))
    }

    /// How many times over the triangle of a leaf leaves its cones; not at all where these are given up.
    fn cone(&self, criteria: &Criteria, place: NodeAddress, corners: &[LimitPoint; 3]) -> f64 {
        let (normal, normals) = (self.frame.normal(), corners.map(|corner| corner.normal));
        let normal_deviation = normals
            .iter()
            .map(|corner| corner.distance(normal))
            .fold(0.0, f64::max);
        let region = Region::around(self.corners, normal).turned(2.0 * normal_deviation);
        let ratio = criteria.cone_ratio(normal, normals, &region, &self.backs);
        if place.level as usize >= criteria.deepest_cone() {
            ratio.min(1.0)
        } else {
            ratio
        }
    }
}
