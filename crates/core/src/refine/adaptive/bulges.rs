//! How the surface bulges over the emitted triangles while their corners lie on it: the least and the greatest height over each, for
//! [`super::offsets`], and what is kept of each part of the surface so that triangles are bounded after their corners were moved
//! ([`super::measure`]).
//!
//! Parts of regular pieces are looked at four at a time, those of a piece together ([`waiting`]). Triangles that were there before are
//! not looked at again ([`known`]): what they came to when they were measured stays with them, too.

mod known;
mod waiting;

use super::backs::{Behind, looks_away};
use super::control::Control;
use super::emit::Emission;
use super::emitted::{Emitted, Over, Sources, TriangleVisitor};
use super::judge::HOPELESS;
use super::measured::{FoundLast, Measured, fail};
use super::quadtree::NodeAddress;
use crate::certificate::{BentFour, FOUR, TriangleFrame};
use crate::criterion::Region;
use crate::patch::{Rules, reciprocal_power};
use crate::progress::{Cancelled, SharedWatch};
use crate::vector::{DVec3, vector};
use known::{Key, Known};
use waiting::Waiting;

/// The range of heights over a triangle that is divided in any case.
pub(super) const ENDS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Heights over the triangles, by control face.
#[derive(Default)]
pub(super) struct Bulges(pub(super) Vec<Bulge>);

/// Those of a control face.
#[derive(Clone, Default)]
pub(super) struct Bulge {
    /// The least and the greatest height of the surface over each; NaN where it is not measured.
    pub(super) ranges: Vec<[f64; 2]>,
    /// Leaves whose triangles bulge too far, and half of that.
    failing: Vec<(NodeAddress, f64)>,
    /// Whether triangles were not measured as they are.
    pub(super) waits: bool,
    /// Which triangles they are.
    keys: Vec<Key>,
    /// Their last measured bounds; empty as long as none was measured.
    found: Vec<FoundLast>,
    /// The bends of their parts of the surface, in units that multiply lengths by `scale`.
    pub(super) parts: Vec<BentFour>,
    pub(super) scale: f64,
}

impl Bulges {
    /// Looks at the triangles of some control faces that were not there before; heights of `allowed` on either side are good enough.
    pub(super) fn look(
        &mut self,
        sources: &Sources<'_>,
        watch: &SharedWatch<'_>,
        faces: &[u32],
        allowed: f64,
        max_levels: u32,
    ) -> Result<(), Cancelled> {
        let hopeless = HOPELESS * allowed;
        let emission = sources.emission;
        self.0
            .resize_with(emission.starts.len() - 1, Bulge::default);
        let found = watch.long_shares(faces.len(), |block, is_stopped| {
            let found = faces[block].iter().map(|&face| {
                let triangles = emission.triangles_of(face);
                let found = Bulge::unknown(triangles.len(), scale(sources.control, face));
                let (control, first) = (sources.control, triangles.start as u32);
                let known = Known::of(self.0.get(face as usize), allowed);
                let waiting = Waiting::default();
                let mut looking = Looking {
                    control,
                    emission,
                    first,
                    waiting,
                    known,
                    found,
                };
                sources.show(face, is_stopped, &mut looking);
                looking.end(face, hopeless, max_levels)
            });
            found.collect::<Vec<_>>()
        })?;
        watch.each(
            faces.iter().zip(found.into_iter().flatten()),
            |(&face, found)| {
                self.0[face as usize] = found;
            },
        )
    }

    /// Keeps what was found of the triangles of a control face, at least how far their corners are moved; says whether that is known of each of
    /// them now.
    pub(super) fn keep(&mut self, face: u32, found: &mut Measured, emission: &Emission) -> bool {
        let Some(bulge) = self.0.get_mut(face as usize) else {
            return false;
        };
        let triangles = emission.triangles_of(face);
        if found.each.is_empty() {
            bulge.found.resize(triangles.len(), FoundLast::NOTHING);
            let known = bulge.found.iter_mut().zip(triangles);
            known.for_each(|(known, at)| known.offsets = emission.offsets_of(at));
            return false;
        }
        bulge.found = core::mem::take(&mut found.each);
        let mut known = bulge.found.iter().zip(triangles);
        bulge.waits = known.any(|(known, at)| known.offsets != emission.offsets_of(at));
        true
    }

    /// Whether nothing of a control face that was not touched may have changed: triangles were measured as they are, and vertices on its
    /// edges stay where they were.
    pub(super) fn are_same(&self, face: u32, emission: &Emission) -> bool {
        let (bulge, first) = (
            &self.0[face as usize],
            3 * emission.triangles_of(face).start as u32,
        );
        let mut half_edges = (3 * face..3 * face + 3).flat_map(|h| emission.borders.along(h));
        !bulge.waits
            && half_edges.all(|&h| {
                let (own, corner) = (((h - first) / 3) as usize, (h % 3) as usize);
                bulge.found[own].offsets[corner] == emission.offsets_of(h as usize / 3)[corner]
            })
    }

    /// Whether no triangle has been measured, and all will be.
    pub(super) fn are_new(&self) -> bool {
        self.0
            .iter()
            .all(|face| face.found.is_empty() && face.failing.is_empty())
    }

    /// The leaves that fail wherever their corners are moved, and their least bounds.
    pub(super) fn failing(&self) -> Vec<(NodeAddress, f64)> {
        self.0
            .iter()
            .flat_map(|face| &face.failing)
            .copied()
            .collect()
    }
}

impl Bulge {
    fn unknown(triangles: usize, scale: f64) -> Self {
        Self {
            ranges: vec![[f64::NAN; 2]; triangles],
            failing: Vec::new(),
            waits: true,
            keys: vec![Key::default(); triangles],
            found: Vec::new(),
            parts: vec![BentFour::UNKNOWN; triangles.div_ceil(FOUR)],
            scale,
        }
    }

    /// The last measured bounds of all triangles.
    pub(super) fn found_last(&self) -> Vec<FoundLast> {
        let mut found = self.found.clone();
        found.resize(self.keys.len(), FoundLast::NOTHING);
        found
    }

    /// How far the corners of each were moved then; not numbers where it was not measured.
    pub(super) fn offsets_last(&self) -> impl Iterator<Item = [f64; 3]> {
        let nothing = self.keys.len() - self.found.len();
        self.found
            .iter()
            .map(|found| found.offsets)
            .chain(core::iter::repeat_n([f64::NAN; 3], nothing))
    }

    /// The leaf whose triangle has this number in the control face.
    pub(super) fn place(&self, face: u32, number: usize) -> NodeAddress {
        let code = self.keys[number].leaf;
        let level = (u64::BITS - 1 - code.leading_zeros().min(u64::BITS - 1)) / 2;
        NodeAddress {
            face,
            level,
            path: code & !(1 << (2 * level)),
        }
    }
}

/// The factor that makes the edges of a control face about 1.
pub(super) fn scale(control: &Control<'_>, face: u32) -> f64 {
    let [a, b, c] =
        control.mesh.triangles()[face as usize].map(|v| vector(control.positions[v as usize]));
    reciprocal_power((b - a).abs().max((c - a).abs()).max_element())
}

/// Looks at the triangles of a control face.
struct Looking<'a> {
    control: &'a Control<'a>,
    emission: &'a Emission,
    first: u32,
    waiting: Waiting,
    known: Known<'a>,
    found: Bulge,
}

impl TriangleVisitor for Looking<'_> {
    fn wants_triangle(&mut self, emitted: &Emitted) -> bool {
        let number = (emitted.number - self.first) as usize;
        let key = Key::of(emitted);
        self.found.keys[number] = key;
        !self.known.take_over(key, number, &mut self.found)
    }

    fn triangle<'p>(&mut self, emitted: &Emitted, over: Over<'_, 'p>, rules: &'p Rules<'p>) {
        let number = (emitted.number - self.first) as usize;
        if self.control.criteria.is_some() && self.is_unseen(emitted, &over, rules) {
            return;
        }
        match over {
            Over::Regular(quartic, cell, domain) => {
                if self.waiting.is_full(quartic) {
                    self.waiting
                        .look(self.emission, self.first, &mut self.found);
                }
                let turn = self.found.keys[number].turn() as u32;
                self.waiting.push(quartic, emitted, turn, cell, domain);
            }
            Over::General(pieces, ..) => {
                let frame = TriangleFrame::new(self.corners(emitted));
                let points = pieces.points(2, rules).into_iter();
                let inside = points.filter(|&point| {
                    (0..3).all(|edge| frame.edge_position(edge, point).outside <= 0.0)
                });
                let heights = inside.map(|point| frame.height(point));
                let range = heights.fold((0.0f64, 0.0f64), |(low, high), height| {
                    (low.min(height), high.max(height))
                });
                self.found.ranges[number] = range.into();
            }
        }
    }
}

impl Looking<'_> {
    fn corners(&self, emitted: &Emitted) -> [DVec3; 3] {
        emitted
            .vertices
            .map(|vertex| vector(self.emission.positions[vertex as usize]))
    }

    /// The result, with the leaves over which heights are in a greater range than this. These have no say where corners are moved as
    /// long as they may be divided.
    fn end(mut self, face: u32, hopeless: f64, max_levels: u32) -> Bulge {
        self.waiting
            .look(self.emission, self.first, &mut self.found);
        let found = &mut self.found;
        for number in 0..found.ranges.len() {
            let [low, high] = found.ranges[number];
            if hopeless > 0.0 && high - low > hopeless {
                let place = found.place(face, number);
                fail(&mut found.failing, place, 0.5 * (high - low));
                if place.level < max_levels {
                    found.ranges[number] = ENDS;
                }
            }
        }
        self.found
    }

    /// Whether no camera sees more of a triangle than its back, as far as the triangle and its piece tell.
    fn is_unseen(&self, emitted: &Emitted, over: &Over<'_, '_>, rules: &Rules<'_>) -> bool {
        let Control {
            criteria: Some(criteria),
            back_faces,
            ..
        } = self.control
        else {
            return false;
        };
        let corners = self.corners(emitted);
        let region = Region::around(corners, DVec3::ZERO);
        let backs = looks_away(criteria, &region, &[corners], 0.0, |viewer, rest| {
            Behind::of(back_faces, emitted, over, rules).is_back(&over.corners(), viewer, rest)
        });
        criteria.is_unseen(&region, &backs)
    }
}
