//! The limit surface over a node, as far as a walk needs it: regular pieces stay what they are all the way down, others are
//! refined on the way, once.

use core::array::from_fn;
use core::cell::OnceCell;
use std::borrow::Cow;

use super::quadtree::NodeAddress;
use crate::certificate::{NetPart, QuarticJet, SubTriangle};
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::bicubic::Bicubic;
use crate::patch::extraordinary::RefinedExtraordinary;
use crate::patch::{
    Limit, LimitPoint, ParamTriangle, Patch, Points, Quartic, Rules, child_corners,
};
use crate::vector::DVec3;

/// Points that are evaluated together.
const LANES: usize = 4;

/// A regular piece as a polynomial.
#[derive(Clone, Debug)]
pub(super) struct QuarticPiece {
    pub(super) piece: Quartic,
    jet: OnceCell<QuarticJet>,
}

impl QuarticPiece {
    pub(super) fn of(net: &BezierTriangle) -> Self {
        Self {
            piece: Quartic::of(net, 0),
            jet: OnceCell::new(),
        }
    }

    /// A piece with its jet, where parts are bounded for sure.
    pub(super) fn with_jet(net: &BezierTriangle) -> Self {
        let piece = Quartic::of(net, 0);
        Self {
            jet: OnceCell::from(QuarticJet::of(&piece)),
            piece,
        }
    }

    /// The jet that bounds parts of it.
    #[inline]
    pub(super) fn jet(&self) -> &QuarticJet {
        self.jet.get_or_init(|| QuarticJet::of(&self.piece))
    }

    /// The net of a part of a node.
    pub(super) fn net(&self, domain: ParamTriangle, part: SubTriangle) -> NetPart {
        let (at, part) = match part {
            SubTriangle::Child(child) => (domain.child(child), SubTriangle::Whole),
            _ => (domain, part),
        };
        NetPart::own(&self.piece.net([at.u, at.v], at.size), part)
    }

    /// The points at several places, and their unit normals.
    pub(super) fn at<const N: usize>(&self, places: [[f64; 2]; N]) -> [LimitPoint; N] {
        let [mut u, mut v] = [[0.0; N]; 2];
        for (l, place) in places.iter().enumerate() {
            [u[l], v[l]] = *place;
        }
        let [points, normals] = self.piece.points_and_normals_at(&u, &v);
        let vector = |by_axis: &[[f64; N]; 3], l: usize| {
            DVec3::new(by_axis[0][l], by_axis[1][l], by_axis[2][l])
        };
        let mut found = [LimitPoint {
            position: DVec3::ZERO,
            normal: DVec3::ZERO,
        }; N];
        for (l, found) in found.iter_mut().enumerate() {
            *found = LimitPoint {
                position: vector(&points, l),
                normal: vector(&normals, l),
            };
        }
        found
    }
}

/// A piece of the limit surface, and what was derived from it so far: walks ask for some of it several times, and for much of it
/// never.
pub(super) enum SurfacePiece {
    Regular(Points, OnceCell<Box<QuarticPiece>>),
    Bicubic(Bicubic),
    General(GeneralPiece),
}

/// A regular piece.
#[derive(Clone, Copy)]
pub(super) struct RegularPiece<'a> {
    points: PointsOf<'a>,
    quartic: &'a OnceCell<Box<QuarticPiece>>,
}

/// The points of a regular piece: its own, or those of a part of what was refined.
#[derive(Clone, Copy)]
enum PointsOf<'a> {
    Own(&'a Points),
    Part(&'a RefinedExtraordinary, usize),
}

/// Any other, with its corners' limits, normals on this side.
pub(super) struct GeneralPiece {
    pub(super) patch: Patch,
    pub(super) corners: [LimitPoint; 3],
    refined: OnceCell<Box<Refinement>>,
}

/// A piece refined once.
// Always on the heap, and most are of the larger kind.
#[allow(clippy::large_enum_variant)]
enum Refinement {
    Extraordinary(AroundVertex),
    Any {
        middles: [LimitPoint; 3],
        children: Vec<SurfacePiece>,
    },
}

/// Three regular pieces and one at an irregular vertex. They stay part of the refined piece, since many of them are never asked for anything.
struct AroundVertex {
    refined: RefinedExtraordinary,
    middles: OnceCell<[LimitPoint; 3]>,
    quartics: [OnceCell<Box<QuarticPiece>>; 4],
    at_vertex: OnceCell<Box<GeneralPiece>>,
}

impl SurfacePiece {
    pub(super) fn of(patch: Patch, corners: [LimitPoint; 3]) -> Self {
        match patch {
            Patch::Regular(points) => Self::Regular(points, OnceCell::new()),
            Patch::Bicubic(piece) => Self::Bicubic(piece),
            patch => Self::General(GeneralPiece::of(patch, corners)),
        }
    }

    /// The part over a node.
    pub(super) fn over<'a>(&'a self, place: NodeAddress, rules: &'a Rules<'a>) -> Surface<'a> {
        (0..place.level).fold(self.surface(rules), |surface, level| {
            surface.child(place.digit(level))
        })
    }

    /// All of it.
    pub(super) fn surface<'a>(&'a self, rules: &'a Rules<'a>) -> Surface<'a> {
        match self {
            Self::Regular(points, quartic) => Surface::Regular(
                RegularPiece {
                    points: PointsOf::Own(points),
                    quartic,
                },
                ParamTriangle::WHOLE,
            ),
            Self::Bicubic(piece) => Surface::Bicubic(piece, piece.part),
            Self::General(piece) => Surface::General(piece, rules),
        }
    }
}

impl<'a> RegularPiece<'a> {
    pub(super) fn quartic(self) -> &'a QuarticPiece {
        let net = || match self.points {
            PointsOf::Own(points) => BezierTriangle::of(points),
            PointsOf::Part(refined, part) => BezierTriangle::of(&refined.regular_part(part)),
        };
        self.quartic
            .get_or_init(|| Box::new(QuarticPiece::of(&net())))
    }
}

impl GeneralPiece {
    fn of(patch: Patch, corners: [LimitPoint; 3]) -> Self {
        Self {
            patch,
            corners,
            refined: OnceCell::new(),
        }
    }

    fn refined(&self, rules: &Rules<'_>) -> &Refinement {
        self.refined.get_or_init(|| {
            if let Patch::Extraordinary(patch) = &self.patch {
                return Box::new(Refinement::Extraordinary(AroundVertex {
                    refined: patch.refined(rules.beta(patch.ring.len())),
                    middles: OnceCell::new(),
                    quartics: Default::default(),
                    at_vertex: OnceCell::new(),
                }));
            }
            let refined = self.patch.refined(rules);
            let middles = [0, 1, 2].map(|edge| refined.middle(edge));
            let mut children = Vec::with_capacity(4);
            for child in 0..4 {
                let own = child_corners(self.corners, middles, child);
                children.push(SurfacePiece::of(refined.part(child), own));
            }
            Box::new(Refinement::Any { middles, children })
        })
    }

    /// The limits in the middles of the edges.
    pub(super) fn middles(&self, rules: &Rules<'_>) -> &[LimitPoint; 3] {
        match self.refined(rules) {
            Refinement::Extraordinary(around) => around.middles(),
            Refinement::Any { middles, .. } => middles,
        }
    }

    /// The surface over a child.
    fn child<'a>(&'a self, child: usize, rules: &'a Rules<'a>) -> Surface<'a> {
        let around = match self.refined(rules) {
            Refinement::Extraordinary(around) => around,
            Refinement::Any { children, .. } => return children[child].surface(rules),
        };
        if around.refined.is_regular(child) {
            let points = PointsOf::Part(&around.refined, child);
            return Surface::Regular(
                RegularPiece {
                    points,
                    quartic: &around.quartics[child],
                },
                ParamTriangle::WHOLE,
            );
        }
        let at_vertex = around.at_vertex.get_or_init(|| {
            let own = child_corners(self.corners, *around.middles(), child);
            Box::new(Self::of(
                Patch::Extraordinary(Box::new(around.refined.own().clone())),
                own,
            ))
        });
        Surface::General(at_vertex, rules)
    }
}

impl AroundVertex {
    fn middles(&self) -> &[LimitPoint; 3] {
        self.middles.get_or_init(|| {
            [0, 1, 2].map(|edge| {
                let (at, ring) = self.refined.middle(edge);
                LimitPoint::regular(at, &ring)
            })
        })
    }
}

/// The surface over a node.
#[derive(Clone, Copy)]
pub(super) enum Surface<'a> {
    /// Nobody asks.
    Unknown,
    /// Part of a regular piece.
    Regular(RegularPiece<'a>, ParamTriangle),
    /// Part of a bicubic piece.
    Bicubic(&'a Bicubic, ParamTriangle),
    /// Any other piece.
    General(&'a GeneralPiece, &'a Rules<'a>),
}

impl<'a> Surface<'a> {
    /// The surface over a child.
    pub(super) fn child(self, child: usize) -> Self {
        match self {
            Surface::Unknown => Surface::Unknown,
            Surface::Regular(piece, domain) => Surface::Regular(piece, domain.child(child)),
            Surface::Bicubic(piece, domain) => Surface::Bicubic(piece, domain.child(child)),
            Surface::General(piece, rules) => piece.child(child, rules),
        }
    }

    /// The limits at the corners.
    pub(super) fn corners(self) -> [LimitPoint; 3] {
        match self {
            Surface::Unknown => {
                [LimitPoint {
                    position: DVec3::ZERO,
                    normal: DVec3::ZERO,
                }; 3]
            }
            Surface::Regular(piece, domain) => piece.quartic().at(domain.corners()),
            Surface::Bicubic(piece, domain) => domain.corners().map(|at| piece.limit(at)),
            Surface::General(piece, _) => piece.corners,
        }
    }

    /// The limits in the middles of the edges.
    pub(super) fn middles(self) -> [LimitPoint; 3] {
        match self {
            Surface::Unknown => {
                [LimitPoint {
                    position: DVec3::ZERO,
                    normal: DVec3::ZERO,
                }; 3]
            }
            Surface::Regular(piece, domain) => piece
                .quartic()
                .at([0, 1, 2].map(|edge| domain.along(edge, 0.5))),
            Surface::Bicubic(piece, domain) => {
                [0, 1, 2].map(|edge| piece.limit(domain.along(edge, 0.5)))
            }
            Surface::General(piece, rules) => *piece.middles(rules),
        }
    }

    /// The piece over a node that is not part of a regular piece.
    pub(super) fn patch(self) -> Option<Cow<'a, Patch>> {
        match self {
            Surface::Unknown | Surface::Regular(..) => None,
            Surface::Bicubic(piece, domain) => Some(Cow::Owned(Patch::Bicubic(piece.over(domain)))),
            Surface::General(piece, _) => Some(Cow::Borrowed(&piece.patch)),
        }
    }

    /// Evaluates the points at the given places along an edge, from 0 to 1 and ascending.
    pub(super) fn along(
        self,
        edge: usize,
        places: &[f64],
        found: &mut impl FnMut(usize, LimitPoint),
    ) {
        self.part_along(edge, 0.0, 1.0, 0..places.len(), places, found);
    }

    /// Evaluates those of the points that lie on the part of the edge from one place on, of some length.
    fn part_along(
        self,
        edge: usize,
        from: f64,
        length: f64,
        own: core::ops::Range<usize>,
        places: &[f64],
        found: &mut impl FnMut(usize, LimitPoint),
    ) {
        let (first, last) = (own.start, own.end);
        if first == last {
            return;
        }
        match self {
            Surface::Unknown => {}
            Surface::Regular(piece, domain) => {
                let quartic = piece.quartic();
                let place = |at: usize| domain.along(edge, (places[at] - from) / length);
                let mut at = first;
                while at < last {
                    let count = (last - at).min(LANES);
                    if count == 1 {
                        let [point] = quartic.at([place(at)]);
                        found(at, point);
                    } else {
                        let points: [LimitPoint; LANES] =
                            quartic.at(from_fn(|l| place((at + l).min(last - 1))));
                        (at..last)
                            .zip(points)
                            .for_each(|(at, point)| found(at, point));
                    }
                    at += count;
                }
            }
            Surface::Bicubic(piece, domain) => {
                for at in own {
                    let place = domain.along(edge, (places[at] - from) / length);
                    found(at, piece.limit(place));
                }
            }
            Surface::General(piece, rules) => {
                let half = 0.5 * length;
                let middle =
                    first + places[first..last].partition_point(|&place| place < from + half);
                let mut next = middle;
                if middle < last && places[middle] == from + half {
                    found(middle, piece.middles(rules)[edge]);
                    next += 1;
                }
                for (child, from, own) in [
                    (edge, from, first..middle),
                    ((edge + 1) % 3, from + half, next..last),
                ] {
                    self.child(child)
                        .part_along(edge, from, half, own, places, found);
                }
            }
        }
    }
}
