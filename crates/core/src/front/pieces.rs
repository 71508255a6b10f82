//! The limit surface over nodes: points in the middles of edges, and how far it is from a node's triangle.
//!
//! Where a front has another [`Measure`], all nodes have their own pieces, with its samples
//! ([`Sampled`]).
//!
//! A node over part of a regular piece keeps the piece's number and its place there; any other its
//! own piece. Values belong to nodes alone: of parts of regular pieces by second derivatives
//! ([`SecondDerivatives`]); of others by [`ParamPatch::off_linear`] for the node's triangle, and for
//! closing triangles by the distances of the middles of edges from those of the triangle, since
//! linear interpolation of these differences is no greater than they are.

use core::array::from_fn;

use super::measure::{Measure, Sampled, greatest};
use crate::certificate::{ParamPatch, SecondDerivatives, SubTriangle};
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{ParamTriangle, Patch, Points, Quartic};
use crate::vector::DVec3;

/// Values of irregular pieces are tight down to this part of their size.
const TIGHT: f64 = 1e-6;

/// Where the surface over a node is kept. Undivided control faces have none.
#[derive(Clone, Copy, Debug)]
pub(super) enum PieceRef {
    /// Part of a regular piece.
    Regular(u32, ParamTriangle),
    /// A piece of its own.
    General(u32),
    /// A piece of its own, of a front that does not measure distances.
    Sampled(u32),
}

/// A piece that is not regular, and the points in the middles of its edges.
#[derive(Debug)]
struct General {
    sheet: ParamPatch,
    middles: [DVec3; 3],
}

/// Items in numbered slots, which are freed and used again.
#[derive(Debug)]
struct Shelf<T> {
    all: Vec<Option<T>>,
    free: Vec<u32>,
}

impl<T> Default for Shelf<T> {
    fn default() -> Self {
        Self {
            all: Vec::new(),
            free: Vec::new(),
        }
    }
}

impl<T> Shelf<T> {
    fn put(&mut self, item: T) -> u32 {
        if let Some(place) = self.free.pop() {
            self.all[place as usize] = Some(item);
            return place;
        }
        self.all.push(Some(item));
        (self.all.len() - 1) as u32
    }

    fn take(&mut self, place: u32) {
        self.all[place as usize] = None;
        self.free.push(place);
    }

    fn get(&self, place: u32) -> &T {
        match &self.all[place as usize] {
            Some(item) => item,
            None => unreachable!("a piece that was given back is asked for"),
        }
    }
}

/// The pieces of a limit surface over the existing nodes.
pub(super) struct Pieces<'a> {
    surface: LimitSurface<'a>,
    measure: Measure,
    regular: Shelf<Box<Quartic>>,
    general: Shelf<Box<General>>,
    sampled: Shelf<Box<Sampled>>,
}

/// A part of a node's surface, and its value.
pub(super) type Part = (PieceRef, f64);

impl<'a> Pieces<'a> {
    pub(super) fn of(surface: LimitSurface<'a>, measure: Measure) -> Self {
        let (regular, general, sampled) = (Shelf::default(), Shelf::default(), Shelf::default());
        Self {
            surface,
            measure,
            regular,
            general,
            sampled,
        }
    }

    pub(super) fn measure(&self) -> Measure {
        self.measure
    }

    pub(super) fn surface(&self) -> &LimitSurface<'a> {
        &self.surface
    }

    fn control_sampled(&self, face: u32) -> Sampled {
        let (sheet, rules) = ParamPatch::over(&self.surface, FaceId(face));
        Sampled::of(sheet.patch, self.surface.corner_points(FaceId(face)), rules)
    }

    /// The value of a control face.
    pub(super) fn control_value(&self, face: u32) -> f64 {
        if self.measure != Measure::Distance {
            return self.control_sampled(face).value(self.measure);
        }
        let (sheet, rules) = ParamPatch::over(&self.surface, FaceId(face));
        match &sheet.patch {
            Patch::Regular(points) => SecondDerivatives::of(&quartic(points))
                .off_triangles(ParamTriangle::WHOLE.corners(), 1.0),
            _ => {
                let refined = sheet.patch.refined(rules);
                self.general_value(&sheet, from_fn(|edge| refined.middle(edge).position))
            }
        }
    }

    fn general_value(&self, sheet: &ParamPatch, middles: [DVec3; 3]) -> f64 {
        let [a, b, c] = sheet.corners;
        let size = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let off = sheet.off_linear(SubTriangle::Whole, TIGHT * size, self.surface.rules());
        let straight = [a + b, b + c, c + a].map(|sum| 0.5 * sum);
        let value = greatest((0..3).map(|edge| middles[edge].distance(straight[edge]))) + off;
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// The surface over a control face that is to be divided.
    pub(super) fn control(&mut self, face: u32) -> PieceRef {
        if self.measure != Measure::Distance {
            let own = self.control_sampled(face);
            return PieceRef::Sampled(self.sampled.put(Box::new(own)));
        }
        let (sheet, rules) = ParamPatch::over(&self.surface, FaceId(face));
        match &sheet.patch {
            Patch::Regular(points) => PieceRef::Regular(
                self.regular.put(Box::new(quartic(points))),
                ParamTriangle::WHOLE,
            ),
            _ => {
                let refined = sheet.patch.refined(rules);
                let middles = from_fn(|edge| refined.middle(edge).position);
                PieceRef::General(self.general.put(Box::new(General { sheet, middles })))
            }
        }
    }

    /// The four parts of a node's surface.
    pub(super) fn parts(&mut self, piece: PieceRef) -> [Part; 4] {
        match piece {
            PieceRef::Regular(piece, domain) => {
                let derivatives = SecondDerivatives::of(self.regular.get(piece));
                from_fn(|child| {
                    let own = domain.child(child);
                    let value = derivatives.off_triangles(own.corners(), own.size);
                    (PieceRef::Regular(piece, own), value)
                })
            }
            PieceRef::General(piece) => self
                .general
                .get(piece)
                .sheet
                .children(self.surface.rules())
                .map(|sheet| self.part(sheet)),
            PieceRef::Sampled(piece) => {
                let parts = self.sampled.get(piece).children(self.surface.rules());
                parts.map(|part| {
                    let value = part.value(self.measure);
                    (PieceRef::Sampled(self.sampled.put(Box::new(part))), value)
                })
            }
        }
    }

    fn part(&mut self, sheet: ParamPatch) -> Part {
        if let Patch::Regular(points) = &sheet.patch {
            let piece = quartic(points);
            let value =
                SecondDerivatives::of(&piece).off_triangles(ParamTriangle::WHOLE.corners(), 1.0);
            return (
                PieceRef::Regular(self.regular.put(Box::new(piece)), ParamTriangle::WHOLE),
                value,
            );
        }
        let refined = sheet.patch.refined(self.surface.rules());
        let middles = from_fn(|edge| refined.middle(edge).position);
        let value = self.general_value(&sheet, middles);
        drop(refined);
        (
            PieceRef::General(self.general.put(Box::new(General { sheet, middles }))),
            value,
        )
    }

    /// Gives back the piece of a node that is its own.
    pub(super) fn give_back(&mut self, piece: PieceRef) {
        match piece {
            PieceRef::Regular(piece, _) => self.regular.take(piece),
            PieceRef::General(piece) => self.general.take(piece),
            PieceRef::Sampled(piece) => self.sampled.take(piece),
        }
    }

    /// The limit positions of a control face's corners.
    pub(super) fn control_corners(&self, face: u32) -> [DVec3; 3] {
        self.surface.corner_positions(FaceId(face))
    }

    /// The point in the middle of a node's edge, as the piece over the node has it.
    pub(super) fn middle(&self, piece: Option<PieceRef>, face: u32, edge: usize) -> DVec3 {
        match piece {
            None => {
                let (sheet, rules) = ParamPatch::over(&self.surface, FaceId(face));
                match &sheet.patch {
                    Patch::Regular(points) if self.measure == Measure::Distance => {
                        at(&quartic(points), ParamTriangle::WHOLE.along(edge, 0.5))
                    }
                    _ => sheet.patch.refined(rules).middle(edge).position,
                }
            }
            Some(PieceRef::Regular(piece, domain)) => {
                at(self.regular.get(piece), domain.along(edge, 0.5))
            }
            Some(PieceRef::General(piece)) => self.general.get(piece).middles[edge],
            Some(PieceRef::Sampled(piece)) => self.sampled.get(piece).middle(edge),
        }
    }
}

fn quartic(points: &Points) -> Quartic {
    Quartic::of(&BezierTriangle::of(points), 0)
}

/// A point of a piece, with the same bits for each caller.
fn at(piece: &Quartic, [u, v]: [f64; 2]) -> DVec3 {
    let [[x], [y], [z]] = piece.points_at(&[u], &[v], 3);
    DVec3::new(x, y, z)
}
