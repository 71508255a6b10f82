//! The paper's criterion, equation (2), and its view-dependent form, equation (11).

use super::view::AngleLimit;
use super::{Criterion, CriterionError, Region, View, angle_ratio, check_angle};
use crate::index::{FaceId, HalfEdgeId};
use crate::limit::LimitTable;
use crate::math;
use crate::mesh::Mesh;
use crate::parallel;
use crate::vector::{DVec3, vector};

/// A face fails where its normal leaves the cone of angle α around the limit normal of one of its vertices:
/// `min_i N_Vi · N_f < cos α`.
///
/// Vertices on sharp edges have a limit normal for each side; each face is compared with that of
/// its own. Faces without area and vertices without a limit normal are ignored.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LimitNormal {
    /// The cone's angle α, in radians.
    pub angle: f64,
    /// Makes the angle depend on the viewer.
    pub view: Option<View>,
}

impl LimitNormal {
    /// The criterion with the cone's angle in radians.
    pub fn new(angle: f64) -> Self {
        Self { angle, view: None }
    }

    /// Sets [`Self::view`].
    pub fn view(mut self, view: View) -> Self {
        self.view = Some(view);
        self
    }
}

impl Criterion for LimitNormal {
    fn name(&self) -> &str {
        "limit-normal"
    }

    fn ratios(&self, mesh: &Mesh, limits: &LimitTable<'_>) -> Result<Vec<f64>, CriterionError> {
        check_angle(self.angle)?;
        self.view.map_or(Ok(()), |view| view.check())?;
        let normals = limits.sided_normals(mesh)?;
        Ok(parallel::map(mesh.face_count(), |face| {
            let normal = mesh.unit_face_normal(face);
            let limit = match self.view {
                None => self.angle,
                Some(view) => {
                    let [a, b, c] = mesh.as_triangles().corners(face).map(vector);
                    let sight = view.direction(a / 3.0 + b / 3.0 + c / 3.0);
                    match view.limit(self.angle, sight.dot(normal)) {
                        _ if normal == DVec3::ZERO => return 0.0,
                        AngleLimit::Never => return 0.0,
                        AngleLimit::Always => return f64::INFINITY,
                        AngleLimit::Angle(angle) => angle,
                    }
                }
            };
            let corners = [0, 1, 2].map(|corner| HalfEdgeId::of(FaceId(face as u32), corner));
            ratio(
                normal,
                corners.map(|corner| vector(normals.at(mesh.topology(), corner))),
                limit,
            )
        }))
    }
}

/// How many times over a triangle's normal leaves the cones of that angle around the limit normals of its corners. All
/// are of unit length; those that are zero have no say.
pub(crate) fn ratio(normal: DVec3, corners: [DVec3; 3], limit: f64) -> f64 {
    let cosines = corners
        .iter()
        .filter(|&&corner| corner != DVec3::ZERO)
        .map(|corner| corner.dot(normal));
    match cosines.reduce(f64::min) {
        Some(cosine) if normal != DVec3::ZERO => angle_ratio(cosine, limit),
        _ => 0.0,
    }
}

/// Exact refinement continues until the criterion is met, which by equation (11) is impossible on a
/// silhouette.
impl LimitNormal {
    /// Control faces are divided by the cone until triangles would be this part of them and its
    /// angle smaller: a cone still too wide then turns within a thousandth of a control face, where
    /// the surface has hardly a tangent plane.
    const LEAST_PART: f64 = 1.0 / 1024.0;

    /// Levels below the control faces at which the cone is given up: triangles at which it stays open there lie at cusps,
    /// at creases of the parametrisation, or at vertices around which normals settle too slowly.
    pub(crate) fn deepest(&self) -> usize {
        let levels = math::log2(Self::LEAST_PART * self.angle).abs().ceil();
        if levels < 64.0 { levels as usize } else { 64 }
    }

    /// The least angle that any triangle in a region may have: infinite where all face away. Never
    /// less for a region within another.
    ///
    /// With a view it is equation (11)'s, but not below α itself: a viewer never needs more
    /// triangles than no viewer, and refinement ends at silhouettes. Only a dilatation above 1
    /// makes faces towards the viewer coarser.
    pub(crate) fn allowed_angle(&self, region: &Region) -> f64 {
        match self.view.map(|view| view.least_limit(self.angle, region)) {
            None | Some(AngleLimit::Always) => self.angle,
            Some(AngleLimit::Never) => f64::INFINITY,
            Some(AngleLimit::Angle(angle)) => angle.max(self.angle),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::criterion::Viewpoint;
    use limitmesh_testing::Random;

    fn region(random: &mut Random) -> Region {
        let (centre, axis) = (random.signed() * random.direction(), random.direction());
        Region {
            centre,
            axis,
            radius: 0.3 * random.signed().abs(),
            sine: 0.5 * random.signed().abs(),
        }
    }

    fn criterion(random: &mut Random) -> LimitNormal {
        let viewpoint = if random.signed() > 0.0 {
            Viewpoint::Direction((3.0 * random.direction()).to_array())
        } else {
            Viewpoint::Eye((2.0 * random.direction()).to_array())
        };
        LimitNormal::new(0.1).view(View {
            viewpoint,
            dilatation: 2.0 + 2.0 * random.signed(),
        })
    }

    /// A point of a region and a normal.
    fn within(random: &mut Random, region: &Region) -> (DVec3, DVec3) {
        let sine = region.sine * random.signed().abs().sqrt().sqrt();
        let across = region.axis.cross(random.direction()).normalize();
        let point = region.centre
            + region.radius * random.signed().abs().sqrt().sqrt() * random.direction();
        (
            point,
            (1.0 - sine * sine).sqrt() * region.axis + sine * across,
        )
    }

    /// Equation (11) by hand, not below the angle.
    fn limit(criterion: &LimitNormal, point: DVec3, normal: DVec3) -> f64 {
        let view = criterion.view.unwrap();
        let sight = match view.viewpoint {
            Viewpoint::Direction(sight) => vector(sight),
            Viewpoint::Eye(eye) => point - vector(eye),
        };
        let facing = -sight.dot(normal) / sight.length();
        if facing < 0.0 {
            f64::INFINITY
        } else {
            (0.1 * view.dilatation * facing).clamp(0.1, 3.15)
        }
    }

    #[test]
    fn the_least_angle_of_a_region_is_no_more_than_any_there() {
        let mut random = Random::new(5);
        let (mut unseen, mut wide, mut closest) = (0, 0, f64::INFINITY);
        for _ in 0..3000 {
            let (criterion, region) = (criterion(&mut random), region(&mut random));
            let allowed = criterion.allowed_angle(&region);
            unseen += usize::from(allowed == f64::INFINITY);
            wide += usize::from(allowed > 0.1 && allowed < 3.2);
            for _ in 0..60 {
                let (point, normal) = within(&mut random, &region);
                let found = limit(&criterion, point, normal);
                assert!(
                    allowed <= found * (1.0 + 1e-12),
                    "{allowed} {found} {criterion:?} {region:?}"
                );
                if allowed > 0.1 && allowed.is_finite() {
                    closest = closest.min(found / allowed);
                }
            }
        }
        assert!(
            unseen > 200 && wide > 200 && closest < 1.02,
            "{unseen} {wide} {closest}"
        );
    }

    #[test]
    fn smaller_regions_have_no_smaller_angles() {
        let mut random = Random::new(9);
        for _ in 0..20_000 {
            let (criterion, region) = (criterion(&mut random), region(&mut random));
            let share = random.signed().abs();
            let centre = region.centre
                + (1.0 - share) * region.radius * random.signed() * random.direction();
            let (_, axis) = within(&mut random, &region);
            let turn = region.axis.dot(axis).clamp(-1.0, 1.0).acos();
            let sine = (region.sine.asin() - turn).max(0.0).sin();
            let inner = Region {
                centre,
                radius: share * region.radius,
                axis,
                sine,
            };
            let (outer, less) = (
                criterion.allowed_angle(&region),
                criterion.allowed_angle(&inner),
            );
            assert!(
                less >= outer * (1.0 - 1e-6),
                "{outer} {less}: {criterion:?} {region:?} {inner:?}"
            );
        }
    }

    /// Without a viewer, and with one who sees only silhouettes, the angle is the requested one.
    #[test]
    fn a_viewer_never_asks_for_more() {
        let region = Region {
            centre: DVec3::ZERO,
            radius: 0.1,
            axis: DVec3::X,
            sine: 1.0,
        };
        assert_eq!(LimitNormal::new(0.2).allowed_angle(&region), 0.2);
        let view = View {
            viewpoint: Viewpoint::Direction([0.0, 0.0, -1.0]),
            dilatation: 0.5,
        };
        assert_eq!(LimitNormal::new(0.2).view(view).allowed_angle(&region), 0.2);
        assert_eq!(LimitNormal::new(5f64.to_radians()).deepest(), 14);
    }
}
