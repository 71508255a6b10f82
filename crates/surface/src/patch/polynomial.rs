//! Pieces of the surface that are polynomials over their triangle, as searches see them, whatever the degree: quartics of the Loop
//! family, and halves of bicubic pieces.

use super::bezier_triangle::BezierTriangle;
use std::sync::Arc;

use super::bicubic::Bicubic;
use super::normal_net::{
    CUBIC, QUINTIC, SEXTIC, cross_products, differences, quintic_products, tangents,
};
use super::sextic::SexticTriangle;
use super::{Patch, Points, Quartic, Refined};
use crate::vector::DVec3;
use smallvec::SmallVec;

/// The points of a net of normals.
pub(crate) type Normals = SmallVec<[DVec3; SEXTIC]>;

/// A triangular net whose hull holds a piece.
pub(crate) trait Net {
    /// The nets of its derivatives.
    type Tangent: AsRef<[DVec3]>;

    /// How often corners are arguments of a point's blossom.
    const DEGREE: usize;

    /// The points b_ijk, i + j + k being the degree, by k, then by j.
    fn points(&self) -> &[DVec3];

    /// The same net, seen from a point.
    fn seen_from(self, origin: DVec3) -> Self;

    /// The nets of the derivatives by the second and by the third corner's weight, divided by the degree.
    fn tangents(&self) -> [Self::Tangent; 2];

    /// The net of the cross products of its derivatives, scaled.
    fn normals(tangents: [Self::Tangent; 2], scale: f64) -> Normals;

    /// The corners.
    fn corners(&self) -> [DVec3; 3] {
        let points = self.points();
        [points[0], points[Self::DEGREE], points[points.len() - 1]]
    }

    /// Where its points are, as seen from those of its triangle with the same weights.
    fn off_flat(&self) -> impl Iterator<Item = DVec3> + '_ {
        let ([a, b, c], most, step) = (
            self.corners(),
            Self::DEGREE as f64,
            1.0 / Self::DEGREE as f64,
        );
        let places = (0..=Self::DEGREE)
            .flat_map(|k| (0..=Self::DEGREE - k).map(move |j| (j as f64, k as f64)));
        self.points()
            .iter()
            .zip(places)
            .map(move |(point, (j, k))| point - step * ((most - j - k) * a + j * b + k * c))
    }
}

impl Net for BezierTriangle {
    type Tangent = [DVec3; CUBIC];
    const DEGREE: usize = 4;

    fn points(&self) -> &[DVec3] {
        &self.0
    }

    fn seen_from(self, origin: DVec3) -> Self {
        Self(self.0.map(|point| point - origin))
    }

    fn tangents(&self) -> [Self::Tangent; 2] {
        tangents(self)
    }

    fn normals(tangents: [Self::Tangent; 2], scale: f64) -> Normals {
        let scaled = tangents.map(|net| net.map(|tangent| tangent * scale));
        Normals::from_buf(cross_products(&scaled))
    }
}

impl Net for SexticTriangle {
    type Tangent = [DVec3; QUINTIC];
    const DEGREE: usize = 6;

    fn points(&self) -> &[DVec3] {
        &self.0
    }

    fn seen_from(self, origin: DVec3) -> Self {
        Self(self.0.map(|point| point - origin))
    }

    fn tangents(&self) -> [Self::Tangent; 2] {
        differences(Self::DEGREE, &self.0)
    }

    fn normals(tangents: [Self::Tangent; 2], scale: f64) -> Normals {
        let scaled = tangents.map(|net| net.map(|tangent| tangent * scale));
        Normals::from_slice(&quintic_products(&scaled))
    }
}

/// A piece that is a polynomial over its triangle.
pub(crate) trait RegularPiece: Sized {
    type Net: Net;

    /// Its net.
    fn net(&self) -> Self::Net;

    /// The polynomial, given the net.
    fn polynomial(&self, net: &Self::Net) -> Polynomial;

    /// The pieces over its four parts.
    fn parts(&self) -> [Self; 4];

    /// It with its points elsewhere, by an affine map.
    fn moved(&self, to: impl Fn(DVec3) -> DVec3) -> Self;
}

impl RegularPiece for Points {
    type Net = BezierTriangle;

    fn net(&self) -> BezierTriangle {
        BezierTriangle::of(self)
    }

    fn polynomial(&self, net: &BezierTriangle) -> Polynomial {
        Polynomial::Quartic(Quartic::of(net, 0))
    }

    fn parts(&self) -> [Self; 4] {
        let refined = Refined::of(self);
        [0, 1, 2, 3].map(|part| refined.part(part))
    }

    fn moved(&self, to: impl Fn(DVec3) -> DVec3) -> Self {
        self.map(to)
    }
}

impl RegularPiece for Bicubic {
    type Net = SexticTriangle;

    fn net(&self) -> SexticTriangle {
        self.part_net()
    }

    fn polynomial(&self, _: &SexticTriangle) -> Polynomial {
        Polynomial::Bicubic(self.clone())
    }

    fn parts(&self) -> [Self; 4] {
        [0, 1, 2, 3].map(|part| self.child(part))
    }

    fn moved(&self, to: impl Fn(DVec3) -> DVec3) -> Self {
        Self {
            points: Arc::new(self.points.map(|row| row.map(&to))),
            part: self.part,
        }
    }
}

/// A polynomial over a triangle, by the weights u and v of the second and the third corner.
#[derive(Clone, Debug)]
// Most are quartics: boxing the others would cost an allocation for each.
#[allow(clippy::large_enum_variant)]
pub enum Polynomial {
    Quartic(Quartic),
    Bicubic(Bicubic),
}

impl Polynomial {
    /// That of a piece which is one.
    pub fn of(patch: &Patch) -> Option<Self> {
        match patch {
            Patch::Regular(points) => Some(points.polynomial(&points.net())),
            Patch::Bicubic(piece) => Some(Self::Bicubic(piece.clone())),
            _ => None,
        }
    }

    /// The point at (u, v).
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        match self {
            Self::Quartic(quartic) => quartic.point(u, v),
            Self::Bicubic(piece) => piece.point(piece.part.at([u, v])),
        }
    }

    /// The derivatives by u and by v.
    pub fn tangents(&self, u: f64, v: f64) -> [DVec3; 2] {
        match self {
            Self::Quartic(quartic) => quartic.tangents(u, v),
            Self::Bicubic(piece) => piece
                .derivatives(piece.part.at([u, v]))
                .map(|by| piece.part.size * by),
        }
    }

    /// The coefficients of a quartic.
    pub fn coefficients(&self) -> Option<[DVec3; 15]> {
        match self {
            Self::Quartic(quartic) => Some(quartic.coefficients()),
            Self::Bicubic(_) => None,
        }
    }

    /// The second derivatives: by u twice, by u and v, by v twice.
    pub(crate) fn second_derivatives(&self, u: f64, v: f64) -> [DVec3; 3] {
        match self {
            Self::Quartic(quartic) => quartic.second_derivatives(u, v),
            Self::Bicubic(piece) => {
                let squared = piece.part.size * piece.part.size;
                piece
                    .second_derivatives(piece.part.at([u, v]))
                    .map(|by| squared * by)
            }
        }
    }
}
