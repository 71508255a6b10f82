//! The limit surface of a control mesh in exact pieces. Knows no triangles that approximate them, and no bounds.
//!
//! Each control face carries a [`Patch`]: its corners and their one-ring, which is all that the surface over it
//! depends on. Refining a patch gives the four over its parts, at any depth, so that only what is needed is ever
//! computed; limit positions and normals of new vertices come with it. Schemes of the Loop family have pieces of simple
//! forms, also where tags are semi-sharp; Catmull–Clark has bicubic pieces over halves of quads; for other schemes a piece is a small mesh
//! that is refined as a whole.

pub mod bezier_triangle;
pub mod bicubic;
mod box_spline;
pub mod characteristic;
pub mod extraordinary;
mod from_mesh;
pub mod large_rings;
pub mod mesh_form;
pub mod mesh_patch;
pub mod normal_net;
mod pole;
pub mod polynomial;
pub mod quad;
mod quad_settling;
pub mod quartic;
mod rules;
mod sector;
mod semi_sharp;
pub(crate) mod settling;
pub mod sextic;
mod spot;
pub mod submesh;
mod support;

pub use from_mesh::root_patch;
pub use rules::Rules;
pub use support::Support;

use std::borrow::Cow;

use crate::vector::{DVec3, unit_or_zero};
use bicubic::Bicubic;
pub use box_spline::{Points, Refined, assemble};
use extraordinary::{ExtraordinaryPatch, RefinedExtraordinary};
use mesh_patch::{MeshPatch, RefinedMeshPatch};
use pole::{LARGEST_RING, PolePatch, RefinedPole};
use quad::{QuadPatch, RefinedQuadPatch};
pub use quartic::{Quartic, reciprocal_power};
pub use sector::VertexSector;
use sector::{Far, RefinedSectors, SectorPatch};
use semi_sharp::{RefinedSemiSharp, SemiSharpPatch};
pub use spot::ParamTriangle;

/// The neighbours of a vertex: nearly all have at most eight.
pub(crate) type Neighbours<V = DVec3> = smallvec::SmallVec<[V; 8]>;

/// The limit surface over one face.
// Almost all are regular: boxing them would cost an allocation for each face.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
pub enum Patch {
    /// All corners have six edges, or mirror images beyond a crease make it so.
    Regular(Points),
    /// One corner inside the surface has another number of edges, the others are regular.
    Extraordinary(Box<ExtraordinaryPatch>),
    /// One at a vertex with very many edges.
    Pole(Box<PolePatch>),
    /// Any other without semi-sharp tags, of the Loop family.
    Sectors(Box<SectorPatch>),
    /// One with semi-sharp tags, of the Loop family.
    SemiSharp(Box<SemiSharpPatch>),
    /// Over half a quad, where the surface is a bicubic polynomial.
    Bicubic(Bicubic),
    /// Over half of any other quad.
    Quad(Box<QuadPatch>),
    /// Of a scheme of no known family.
    Mesh(MeshPatch),
}

/// A point of the limit surface with its unit normal on the side it was asked for; zero without one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitPoint {
    pub position: DVec3,
    pub normal: DVec3,
}

/// The parts of a vertex's limit that are wanted.
pub trait Limit: Copy {
    /// The limit of a regular vertex.
    fn regular(at: DVec3, ring: &[DVec3; 6]) -> Self;

    /// Of any.
    fn of(position: DVec3, normal: impl FnOnce() -> DVec3) -> Self;
}

impl Limit for LimitPoint {
    /// Tangents by cosines and sines.
    fn regular(at: DVec3, ring: &[DVec3; 6]) -> Self {
        const SINE: f64 = 0.866_025_403_784_438_6;
        let [a, b, c, d, e, f] = *ring;
        let along = (a - d) + 0.5 * ((b - e) + (f - c));
        let across = SINE * ((b - e) + (c - f));
        Self {
            position: DVec3::regular(at, ring),
            normal: unit_or_zero(along.cross(across)),
        }
    }

    fn of(position: DVec3, normal: impl FnOnce() -> DVec3) -> Self {
        Self {
            position,
            normal: normal(),
        }
    }
}

/// The position alone.
impl Limit for DVec3 {
    /// Weights 1/2 and 1/12.
    #[inline]
    fn regular(at: DVec3, &[a, b, c, d, e, f]: &[DVec3; 6]) -> Self {
        (6.0 * at + (a + d) + (b + e) + (c + f)) / 12.0
    }

    fn of(position: DVec3, _: impl FnOnce() -> DVec3) -> Self {
        position
    }
}

/// A patch refined once: its parts and the limits of its new vertices.
// Almost all are regular: boxing them would cost an allocation for each.
#[allow(clippy::large_enum_variant)]
pub enum RefinedPatch<'a> {
    /// Of a regular patch.
    Regular(Refined),
    /// Of one with an irregular corner.
    Extraordinary(RefinedExtraordinary),
    /// Of one with an irregular corner of very many edges.
    Pole(RefinedPole),
    /// Of another irregular one.
    Sectors(RefinedSectors<'a>),
    /// Of a semi-sharp one.
    SemiSharp(RefinedSemiSharp<'a>),
    /// Of one over half a quad.
    Bicubic(&'a Bicubic),
    Quad(RefinedQuadPatch<'a>),
    /// Of one without a form of its own.
    Mesh(RefinedMeshPatch<'a>),
}

impl Patch {
    /// The simplest form of a piece.
    pub fn of(sectors: SectorPatch) -> Self {
        if let Some(points) = sectors.regular() {
            return Self::Regular(points);
        }
        match sectors.extraordinary() {
            Some((patch, Far::Mean { valence, mean })) => {
                Self::Pole(Box::new(PolePatch::near(patch, valence, mean)))
            }
            Some((patch, _)) => Self::of_extraordinary(patch),
            None => Self::Sectors(Box::new(sectors)),
        }
    }

    /// A piece with one irregular corner, whose ring is known as a whole.
    fn of_extraordinary(patch: ExtraordinaryPatch) -> Self {
        if patch.ring.len() > LARGEST_RING {
            Self::Pole(Box::new(PolePatch::of(patch)))
        } else {
            Self::Extraordinary(Box::new(patch))
        }
    }

    /// The patch refined once.
    #[inline]
    pub fn refined<'a>(&'a self, rules: &'a Rules<'a>) -> RefinedPatch<'a> {
        match self {
            Self::Regular(points) => RefinedPatch::Regular(Refined::of(points)),
            Self::Extraordinary(patch) => {
                RefinedPatch::Extraordinary(patch.refined(rules.beta(patch.ring.len())))
            }
            Self::Pole(patch) => RefinedPatch::Pole(patch.refined(rules.beta(patch.valence()))),
            Self::Sectors(sectors) => RefinedPatch::Sectors(sectors.refined(rules)),
            Self::SemiSharp(patch) => RefinedPatch::SemiSharp(patch.refined(rules)),
            Self::Bicubic(piece) => RefinedPatch::Bicubic(piece),
            Self::Quad(patch) => RefinedPatch::Quad(patch.refined(rules)),
            Self::Mesh(local) => RefinedPatch::Mesh(local.refined(rules)),
        }
    }

    /// Whether a corner is known to be an irregular vertex inside the surface, at which no part is ever regular.
    pub(crate) fn is_irregular_at(&self, corner: usize) -> bool {
        match self {
            Self::Extraordinary(patch) => patch.corner == corner,
            Self::Pole(patch) => patch.corner() == corner,
            Self::Regular(_) | Self::Sectors(_) | Self::SemiSharp(_) | Self::Mesh(_) => false,
            Self::Bicubic(_) | Self::Quad(_) => false,
        }
    }

    /// The control point of a corner, on the piece's own level.
    pub fn control_point(&self, corner: usize) -> DVec3 {
        match self {
            Self::Regular(points) => points[box_spline::CORNERS[corner]],
            Self::Extraordinary(patch) => patch.control_point(corner),
            Self::Pole(patch) => patch.control_point(corner),
            Self::Sectors(sectors) => sectors.0[corner].at,
            Self::SemiSharp(patch) => patch.control_point(corner),
            Self::Bicubic(piece) => piece.control_point(corner),
            Self::Quad(patch) => patch.control_point(corner),
            Self::Mesh(local) => local.control_point(corner),
        }
    }

    /// Moves the piece so that one of its points is at the origin, and gives where that was. Pieces that are refined a few times before
    /// they are others, or which are asked for nothing but limits, stay.
    pub(crate) fn moved_to_origin(&mut self) -> DVec3 {
        match self {
            Self::Regular(points) => {
                let from = points[0];
                points.iter_mut().for_each(|point| *point -= from);
                from
            }
            Self::Extraordinary(patch) => patch.moved_to_origin(),
            Self::Pole(patch) => patch.moved_to_origin(),
            Self::Sectors(sectors) => sectors.moved_to_origin(),
            Self::Bicubic(piece) => piece.moved_to_origin(),
            Self::Quad(patch) => patch.moved_to_origin(),
            Self::SemiSharp(_) | Self::Mesh(_) => DVec3::ZERO,
        }
    }

    /// Calls `visit` for points whose hull holds the piece.
    pub fn for_each_hull_point(&self, mut visit: impl FnMut(DVec3)) {
        match self {
            Self::Regular(points) => points.iter().for_each(|&point| visit(point)),
            Self::Extraordinary(patch) => patch.points().for_each(visit),
            Self::Pole(patch) => patch.points().for_each(visit),
            Self::Sectors(sectors) => sectors.points().for_each(visit),
            Self::SemiSharp(patch) => patch.for_each_point(visit),
            Self::Bicubic(piece) => piece
                .points
                .as_flattened()
                .iter()
                .for_each(|&point| visit(point)),
            Self::Quad(patch) => patch.points().iter().for_each(|&point| visit(point)),
            Self::Mesh(local) => local.points().for_each(visit),
        }
    }
}

/// The corners of a part, given those of the whole and the middles of its edges.
pub fn child_corners<T: Copy>(corners: [T; 3], middles: [T; 3], child: usize) -> [T; 3] {
    let mut own = [middles[1], middles[2], middles[0]];
    if child < 3 {
        own[child] = corners[child];
        own[(child + 1) % 3] = middles[child];
        own[(child + 2) % 3] = middles[(child + 2) % 3];
    }
    own
}

impl RefinedPatch<'_> {
    /// Whether a part is regular.
    pub fn is_regular(&self, part: usize) -> bool {
        match self {
            Self::Regular(_) => true,
            Self::Extraordinary(refined) => refined.is_regular(part),
            Self::Pole(refined) => refined.is_regular(part),
            Self::Sectors(refined) => refined.is_regular(part),
            Self::Bicubic(_) => true,
            Self::Quad(refined) => refined.is_regular(part),
            // Parts without semi-sharp tags may be, too; they are few.
            Self::SemiSharp(_) | Self::Mesh(_) => false,
        }
    }

    /// One of the four parts: 0 to 2 keep the corner of their number, at its place; corner `i` of part 3, the middle
    /// one, is the new vertex opposite corner `i`.
    #[inline]
    pub fn part(&self, part: usize) -> Patch {
        match self {
            Self::Regular(refined) => Patch::Regular(refined.part(part)),
            Self::Extraordinary(refined) => refined.part(part),
            Self::Pole(refined) => refined.part(part),
            Self::Sectors(refined) => refined.piece(part),
            Self::SemiSharp(refined) => refined.part(part),
            Self::Bicubic(piece) => Patch::Bicubic(piece.child(part)),
            Self::Quad(refined) => refined.part(part),
            Self::Mesh(refined) => refined.part(part),
        }
    }

    /// The points of a part, where it is known without more ado that it is regular.
    #[inline]
    pub fn points(&self, part: usize) -> Option<Points> {
        match self {
            Self::Regular(refined) => Some(refined.part(part)),
            Self::Extraordinary(refined) => refined.points(part),
            Self::Pole(refined) => refined.points(part),
            Self::Sectors(refined) => refined.points(part),
            Self::Bicubic(_) | Self::Quad(_) | Self::SemiSharp(_) | Self::Mesh(_) => None,
        }
    }

    /// A part that is an [`ExtraordinaryPatch`] with all of its ring.
    #[inline]
    pub fn extraordinary(&self, part: usize) -> Option<Cow<'_, ExtraordinaryPatch>> {
        match self {
            Self::Extraordinary(refined) if !refined.is_regular(part) => {
                Some(Cow::Borrowed(refined.own()))
            }
            Self::Sectors(refined) => {
                let is_small = |piece: &ExtraordinaryPatch| piece.ring.len() <= LARGEST_RING;
                refined.extraordinary(part).filter(is_small).map(Cow::Owned)
            }
            _ => None,
        }
    }

    /// The limit of the new vertex on the edge from corner `edge`, seen from this face.
    #[inline]
    pub fn middle(&self, edge: usize) -> LimitPoint {
        self.middle_as(edge)
    }

    /// The limit in the middle of an edge, as far as it is wanted.
    #[inline]
    pub fn middle_as<L: Limit>(&self, edge: usize) -> L {
        // One by one, so that rings stay in registers.
        let regular = |(at, ring): (DVec3, [DVec3; 6])| L::regular(at, &ring);
        match self {
            Self::Regular(refined) => regular(refined.middle(edge)),
            Self::Extraordinary(refined) => regular(refined.middle(edge)),
            Self::Pole(refined) => regular(refined.middle(edge)),
            Self::Sectors(refined) => regular(refined.regular_middle(edge)),
            Self::SemiSharp(refined) => {
                let LimitPoint { position, normal } = refined.middle(edge);
                L::of(position, || normal)
            }
            Self::Bicubic(piece) => {
                let LimitPoint { position, normal } = piece.middle(edge);
                L::of(position, || normal)
            }
            Self::Quad(refined) => refined.middle(edge),
            Self::Mesh(refined) => refined.middle(edge),
        }
    }
}
