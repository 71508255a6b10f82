//! Proven directions in which whole pieces of the limit surface face.
//!
//! Takes a piece and a viewer's position; decides whether all of the piece shows its front, or its
//! back, or neither is known. A regular piece is decided by a cone of its normals (`cone`), else
//! by signs of coefficients (`normal_net`); an irregular one by those of its parts, down to the
//! part at an irregular vertex, whose normals are those of its characteristic map up to a term that
//! vanishes (`tip`). At vertices of other kinds nothing is known.

mod cone;
mod normal_net;
mod tip;
mod viewpoint;

pub(crate) use cone::Cone;
pub use cone::NormalCone;
pub(crate) use normal_net::NormalNet;
pub use viewpoint::Viewpoint;

use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::polynomial::Net;
use crate::patch::{Patch, Rules};
use crate::vector::{DVec3, unit_or_zero, vector};
use smallvec::SmallVec;

/// Levels after which parts at irregular vertices are given up. The subdominant terms there shrink
/// more slowly the more edges a vertex has.
#[doc(hidden)]
pub const DEEPEST: u32 = 24;

/// Divisions into four of regular parts that may look one way, though their coefficients have both signs.
const DIVISIONS: u32 = 2;

/// The side of a piece of the surface that a viewer sees. The front is where a face's corners run
/// counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Facing {
    /// Every point shows its front.
    Front,
    /// Every point shows its back.
    Back,
    /// There are both, or it is not known.
    Undecided,
}

/// How a piece faces the viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Look {
    /// All of it is seen from this side.
    All(Side),
    /// Some points are seen from each side.
    Both,
    Unknown,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Front,
    Back,
}

impl Look {
    /// By coefficients that are above 0 where the front is seen, each off by no more than `rounding`; those at `corners` are values.
    fn by_signs(sides: &[f64], corners: [usize; 3], rounding: f64) -> Self {
        let is_front = |&side: &f64| side > rounding && side < f64::INFINITY;
        let is_back = |&side: &f64| side < -rounding && side > f64::NEG_INFINITY;
        let at_corners = corners.map(|corner| sides[corner]);
        match () {
            () if sides.iter().all(is_front) => Self::All(Side::Front),
            () if sides.iter().all(is_back) => Self::All(Side::Back),
            () if at_corners.iter().any(is_front) && at_corners.iter().any(is_back) => Self::Both,
            () => Self::Unknown,
        }
    }

    /// The facing of two pieces together.
    fn and(self, other: Self) -> Self {
        match (self, other) {
            _ if self == other => self,
            (Self::All(_), Self::All(_)) | (Self::Both, _) | (_, Self::Both) => Self::Both,
            _ => Self::Unknown,
        }
    }

    fn is_known(self) -> bool {
        self != Self::Unknown
    }
}

impl From<Look> for Facing {
    fn from(look: Look) -> Self {
        match look {
            Look::All(Side::Front) => Self::Front,
            Look::All(Side::Back) => Self::Back,
            Look::Both | Look::Unknown => Self::Undecided,
        }
    }
}

/// How a regular piece looks from there, by its own coefficients.
fn of_net(net: &impl Net, viewpoint: &Viewpoint) -> Look {
    let Some(normals) = NormalNet::of(net) else {
        return Look::Unknown;
    };
    let eye = match *viewpoint {
        Viewpoint::Direction(sight) => return normals.along(unit_or_zero(vector(sight))),
        Viewpoint::Eye(eye) => vector(eye),
    };
    let by_cone = Cone::of(&normals).map(|cone| cone.look(net.points().iter().copied(), viewpoint));
    by_cone
        .filter(|look| look.is_known())
        .unwrap_or_else(|| normals.from(eye))
}

/// The side of a piece seen from there, with parts at irregular vertices tested this many levels
/// down.
pub(crate) fn of_patch(
    patch: &Patch,
    rules: &Rules<'_>,
    viewpoint: &Viewpoint,
    levels: u32,
) -> Facing {
    look(patch, rules, viewpoint, levels).into()
}

/// Whether all of a regular piece shows its back, by its own coefficients.
#[doc(hidden)]
pub fn is_back(net: &BezierTriangle, viewpoint: &Viewpoint) -> bool {
    has_back(net, viewpoint)
}

fn has_back(net: &impl Net, viewpoint: &Viewpoint) -> bool {
    let Some(normals) = NormalNet::of(net) else {
        return false;
    };
    match *viewpoint {
        Viewpoint::Direction(sight) => {
            normals.along(unit_or_zero(vector(sight))) == Look::All(Side::Back)
        }
        Viewpoint::Eye(eye) => normals.is_back_from(vector(eye)),
    }
}

/// The distance from one of the given corners of those parts of a piece that are not known to show
/// their back, `levels` levels down; `None` if that is more than `rest`, and for schemes
/// whose pieces have no hulls.
#[doc(hidden)]
pub fn back_but_for(
    patch: &Patch,
    rules: &Rules<'_>,
    viewpoint: &Viewpoint,
    (corners, rest): (&[DVec3; 3], f64),
    levels: u32,
) -> Option<f64> {
    let look = match patch {
        Patch::Regular(points) => {
            return is_back(&BezierTriangle::of(points), viewpoint).then_some(0.0);
        }
        Patch::Bicubic(piece) => {
            return has_back(&piece.part_net(), viewpoint).then_some(0.0);
        }
        Patch::Mesh(_) => return None,
        _ => at_tip(patch, rules, viewpoint),
    };
    if let Some(known) = look.filter(|look| look.is_known()) {
        return (known == Look::All(Side::Back)).then_some(0.0);
    }
    let mut is_near = [true; 3];
    patch.for_each_hull_point(|point| {
        (0..3).for_each(|corner| is_near[corner] &= point.distance(corners[corner]) <= rest);
    });
    if is_near.contains(&true) {
        return Some(rest);
    }
    if levels == 0 {
        return None;
    }
    let refined = patch.refined(rules);
    let mut left = 0.0f64;
    // Where the middle part is undecided, the whole is.
    for part in [3, 0, 1, 2] {
        let own = back_but_for(
            &refined.part(part),
            rules,
            viewpoint,
            (corners, rest),
            levels - 1,
        )?;
        left = left.max(own);
    }
    Some(left)
}

/// How a piece at an irregular vertex looks from there.
fn at_tip(patch: &Patch, rules: &Rules<'_>, viewpoint: &Viewpoint) -> Option<Look> {
    let cone = tip::cone(patch, rules)?;
    let mut points = SmallVec::<[DVec3; 32]>::new();
    patch.for_each_hull_point(|point| points.push(point));
    Some(cone.look(points.into_iter(), viewpoint))
}

fn look(patch: &Patch, rules: &Rules<'_>, viewpoint: &Viewpoint, levels: u32) -> Look {
    let (at_once, levels) = match patch {
        Patch::Regular(points) => (
            of_net(&BezierTriangle::of(points), viewpoint),
            levels.min(DIVISIONS),
        ),
        Patch::Bicubic(piece) => (of_net(&piece.part_net(), viewpoint), levels.min(DIVISIONS)),
        Patch::Mesh(_) => (Look::Unknown, 0),
        _ => {
            let look = at_tip(patch, rules, viewpoint);
            (look.unwrap_or(Look::Unknown), levels)
        }
    };
    if at_once.is_known() || levels == 0 {
        return at_once;
    }
    let refined = patch.refined(rules);
    let mut all: Option<Look> = None;
    // Where the middle part is undecided, the whole is.
    for part in [3, 0, 1, 2] {
        let own = look(&refined.part(part), rules, viewpoint, levels - 1);
        let together = all.map_or(own, |all| all.and(own));
        if !matches!(together, Look::All(_)) {
            return together;
        }
        all = Some(together);
    }
    all.unwrap_or(Look::Unknown)
}

/// A cone of the normals of a piece, and points whose hull holds it, added to the given ones.
pub(crate) fn cone_of_patch(
    patch: &Patch,
    rules: &Rules<'_>,
    points: &mut Vec<DVec3>,
    levels: u32,
) -> Option<Cone> {
    match patch {
        Patch::Regular(own) => {
            let net = BezierTriangle::of(own);
            points.extend(net.0);
            return Cone::of(&NormalNet::of(&net)?);
        }
        Patch::Bicubic(piece) => {
            let net = piece.part_net();
            points.extend(net.0);
            return Cone::of(&NormalNet::of(&net)?);
        }
        Patch::Mesh(_) => return None,
        _ => {
            if let Some(cone) = tip::cone(patch, rules).filter(|cone| cone.sine < tip::NARROW) {
                patch.for_each_hull_point(|point| points.push(point));
                return Some(cone);
            }
        }
    }
    if levels == 0 {
        return None;
    }
    let refined = patch.refined(rules);
    let mut all: Option<Cone> = None;
    for part in [3, 0, 1, 2] {
        let cone = cone_of_patch(&refined.part(part), rules, points, levels - 1)?;
        all = Some(all.map_or(Some(cone), |all| all.with(cone))?);
    }
    all
}

#[cfg(test)]
mod test_nets {
    use crate::patch::bezier_triangle::BezierTriangle;
    use limitmesh_testing::Random;

    /// The net of a lattice whose points were moved by up to so much, turned somehow.
    pub(super) fn piece(random: &mut Random, moved: f64) -> BezierTriangle {
        // In the order of `Points`.
        const LATTICE: [[f64; 2]; 12] = [
            [0.0, -1.0],
            [1.0, -1.0],
            [2.0, -1.0],
            [-1.0, 0.0],
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [-1.0, 1.0],
            [0.0, 1.0],
            [1.0, 1.0],
            [-1.0, 2.0],
            [0.0, 2.0],
        ];
        let [a, b] = [random.vector(), random.vector()];
        let points = LATTICE.map(|[x, y]| x * a + y * b + moved * random.vector());
        BezierTriangle::of(&points)
    }
}

#[cfg(test)]
mod tests {
    use super::test_nets::piece;
    use super::*;
    use crate::index::FaceId;
    use crate::limit_surface::LimitSurface;
    use crate::mesh::Sharpness;
    use crate::patch::large_rings::LargeRings;
    use crate::patch::{Quartic, root_patch};
    use crate::scheme::Loop;
    use limitmesh_testing::Random;
    use limitmesh_testing::models::stirred;

    /// Places over a triangle, its corners and edges among them.
    fn places() -> impl Iterator<Item = (f64, f64)> {
        (0..=12).flat_map(|i| (0..=12 - i).map(move |j| (f64::from(i) / 12.0, f64::from(j) / 12.0)))
    }

    /// How far a viewer is before a point's tangent plane, the normal having any length.
    fn before(viewpoint: &Viewpoint, point: DVec3, normal: DVec3) -> f64 {
        match *viewpoint {
            Viewpoint::Direction(sight) => -vector(sight).dot(normal),
            Viewpoint::Eye(eye) => (vector(eye) - point).dot(normal),
        }
    }

    fn viewpoint(random: &mut Random, size: f64) -> Viewpoint {
        let place = (size * random.vector()).to_array();
        if random.signed() > 0.3 {
            Viewpoint::Direction(place)
        } else {
            Viewpoint::Eye(place)
        }
    }

    #[test]
    fn backs_of_regular_pieces_are_backs_and_found_as_often() {
        let mut random = Random::new(23);
        let (mut found, mut all) = (0, 0);
        for _ in 0..4000 {
            let net = piece(&mut random, 0.15);
            let viewpoint = viewpoint(&mut random, 6.0);
            let quartic = Quartic::of(&net, 0);
            let at = |(u, v)| before(&viewpoint, quartic.point(u, v), quartic.normal(u, v)) < 0.0;
            let is_known = is_back(&net, &viewpoint);
            assert!(!is_known || places().all(at));
            assert!(is_known || of_net(&net, &viewpoint) != Look::All(Side::Back));
            found += usize::from(is_known);
            all += usize::from(places().all(at));
        }
        assert!(found > 800 && 20 * found > 17 * all, "{found} of {all}");
    }

    /// All points seen from the front on a reported back are as near to a corner as reported,
    /// except at creases, boundaries and darts.
    #[test]
    fn backs_but_for_corners_are_backs_elsewhere() {
        let mut random = Random::new(29);
        let (mut certain, mut but_for) = (0, 0);
        for (name, degrees) in [
            ("cup", 40.0),
            ("head", 35.0),
            ("bunny", 50.0),
            ("torus", 170.0),
        ] {
            let mesh = stirred(name, 3)
                .with_creases_above(f64::to_radians(degrees))
                .unwrap();
            let surface = LimitSurface::new(&mesh, &Loop).unwrap();
            let (sharpness, rules) = (Sharpness::of(&mesh), Rules::of(&Loop));
            let large = LargeRings::of(&mesh);
            for face in 0..mesh.face_count() as u32 {
                let patch = root_patch(&mesh, &sharpness, &large, FaceId(face), &rules);
                let viewpoint = viewpoint(&mut random, 3.0 * mesh.diagonal());
                let rest = 1e-3 * mesh.diagonal() * random.signed().abs();
                let at = |u: f64, v: f64| surface.at(FaceId(face), [1.0 - u - v, u, v]);
                let corners =
                    [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(u, v)| vector(at(u, v).position));
                let left = back_but_for(&patch, &rules, &viewpoint, (&corners, rest), DEEPEST);
                let Some(left) = left else { continue };
                assert!(left <= rest);
                (certain, but_for) = (
                    certain + usize::from(left == 0.0),
                    but_for + usize::from(left > 0.0),
                );
                for (u, v) in places() {
                    let point = at(u, v);
                    let (position, normal) = (vector(point.position), vector(point.normal));
                    let is_near = corners
                        .iter()
                        .any(|corner| corner.distance(position) <= left);
                    assert!(
                        is_near || before(&viewpoint, position, normal) < 0.0,
                        "{name}, face {face}"
                    );
                }
            }
        }
        assert!(certain > 10 && but_for > 50, "{certain} {but_for}");
    }
}
