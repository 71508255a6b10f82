//! Triangle quality: the least angle of each triangle and its distribution.
//!
//! Takes a surface; gives the least angle and its triangle, the mean and a histogram. A triangle
//! without area, or whose corners do not exist or are not finite, counts as one of 0°.

use crate::math;
use crate::mesh::Triangles;
use crate::parallel;
use crate::vector::{DVec3, vector};

/// Width of a bin of the histogram, in degrees.
const BIN_DEGREES: f64 = 5.0;

/// Least angles of the triangles of a mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TriangleQuality {
    /// The least angle of all, in degrees; 0 without triangles.
    pub min_angle_degrees: f64,
    /// The triangle of the least angle; the first of equals.
    pub worst_face: Option<u32>,
    /// Mean of the triangles' least angles, in degrees; 0 without triangles.
    pub mean_min_angle_degrees: f64,
    /// Number of triangles whose least angle lies in [0°, 5°), [5°, 10°) … [55°, 60°].
    pub histogram: [usize; 12],
}

/// Measures the triangles of a surface.
pub fn triangle_quality(surface: Triangles<'_>) -> TriangleQuality {
    let pieces = parallel::pieces(surface.triangles.len(), |faces| {
        let mut piece = Tally::EMPTY;
        for face in faces {
            piece.add(least_angle_degrees(corners(surface, face)), face);
        }
        piece
    });
    let total = pieces
        .iter()
        .fold(Tally::EMPTY, |total, piece| total.join(piece));
    let count = surface.triangles.len();
    TriangleQuality {
        min_angle_degrees: total.least.map_or(0.0, |(angle, _)| angle),
        worst_face: total.least.map(|(_, face)| face as u32),
        mean_min_angle_degrees: if count > 0 {
            total.sum / count as f64
        } else {
            0.0
        },
        histogram: total.histogram,
    }
}

/// The sums over some of the triangles.
struct Tally {
    sum: f64,
    least: Option<(f64, usize)>,
    histogram: [usize; 12],
}

impl Tally {
    const EMPTY: Self = Self {
        sum: 0.0,
        least: None,
        histogram: [0; 12],
    };

    fn add(&mut self, angle: f64, face: usize) {
        self.sum += angle;
        if self.least.is_none_or(|(least, _)| angle < least) {
            self.least = Some((angle, face));
        }
        // An equilateral triangle's 60° belong to the last bin, and rounding may lift them a little.
        self.histogram[((angle / BIN_DEGREES) as usize).min(11)] += 1;
    }

    /// These triangles and later ones.
    fn join(self, later: &Self) -> Self {
        let least = match (self.least, later.least) {
            (Some(a), Some(b)) if b.0 < a.0 => Some(b),
            (a, b) => a.or(b),
        };
        let histogram = core::array::from_fn(|bin| self.histogram[bin] + later.histogram[bin]);
        Self {
            sum: self.sum + later.sum,
            least,
            histogram,
        }
    }
}

/// The corners of a triangle, if they exist.
fn corners(surface: Triangles<'_>, face: usize) -> Option<[DVec3; 3]> {
    let [a, b, c] =
        surface.triangles[face].map(|v| surface.positions.get(v as usize).copied().map(vector));
    Some([a?, b?, c?])
}

/// The least of a triangle's angles in degrees.
fn least_angle_degrees(corners: Option<[DVec3; 3]>) -> f64 {
    let Some([a, b, c]) = corners.filter(|corners| corners.iter().all(|p| p.is_finite())) else {
        return 0.0;
    };
    // Halves cannot overflow, and sides brought to unit size neither vanish nor overflow in products.
    let sides = [b * 0.5 - a * 0.5, c * 0.5 - b * 0.5, a * 0.5 - c * 0.5];
    let size = sides
        .iter()
        .fold(0.0f64, |size, side| size.max(side.abs().max_element()));
    if size == 0.0 {
        return 0.0;
    }
    let [ab, bc, ca] = sides.map(|side| side / size);
    if [ab, bc, ca].contains(&DVec3::ZERO) {
        return 0.0;
    }
    // The least angle lies opposite the shortest side, between the other two. The arc tangent keeps its digits where
    // the arc cosine has none left.
    let (ab_ab, bc_bc, ca_ca) = (
        ab.length_squared(),
        bc.length_squared(),
        ca.length_squared(),
    );
    let (u, v) = if ab_ab <= bc_bc && ab_ab <= ca_ca {
        (-bc, ca)
    } else if bc_bc <= ca_ca {
        (-ca, ab)
    } else {
        (-ab, bc)
    };
    math::atan2(u.cross(v).length(), u.dot(v)).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quality_of(corners: [[f64; 3]; 3]) -> TriangleQuality {
        triangle_quality(Triangles {
            positions: &corners,
            triangles: &[[0, 1, 2]],
        })
    }

    #[test]
    fn known_triangles_at_any_scale_and_place() {
        let height = 3f64.sqrt() / 2.0;
        let cases = [
            ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, height, 0.0]], 60.0),
            ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], 45.0),
            (
                [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3f64.sqrt()]],
                30.0,
            ),
        ];
        for (corners, angle) in cases {
            for scale in [1e-300, 1e-3, 1.0, 1e300] {
                for turn in 0..3 {
                    let mut turned = corners.map(|p| p.map(|x| x * scale));
                    turned.rotate_left(turn);
                    let quality = quality_of(turned);
                    assert!(
                        (quality.min_angle_degrees - angle).abs() < 1e-10,
                        "{corners:?} {scale}"
                    );
                    assert_eq!(quality.worst_face, Some(0));
                    let bin = if angle == 60.0 {
                        11
                    } else {
                        (angle + 1e-9) as usize / 5
                    };
                    let near = quality.histogram[bin] + quality.histogram[bin.saturating_sub(1)];
                    assert_eq!(near, 1, "{:?}", quality.histogram);
                }
            }
        }
    }

    #[test]
    fn slivers_keep_their_digits() {
        // A needle of height h over a base of 1: its angle at the base is atan(2 h).
        for exponent in [-3, -8, -15, -100] {
            let height = 10f64.powi(exponent);
            let angle = quality_of([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, height, 0.0]])
                .min_angle_degrees;
            let expected = (2.0 * height).atan().to_degrees();
            assert!(
                (angle / expected - 1.0).abs() < 1e-12,
                "{height}: {angle} against {expected}"
            );
        }
    }

    #[test]
    fn triangles_without_area_have_no_angle() {
        for corners in [
            [[0.0; 3], [0.0; 3], [0.0; 3]],
            [[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0]],
            [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]],
            [[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]],
            [[f64::NAN; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]],
        ] {
            let quality = quality_of(corners);
            assert_eq!(quality.min_angle_degrees, 0.0, "{corners:?}");
            assert_eq!(quality.histogram[0], 1);
        }
        let missing = triangle_quality(Triangles {
            positions: &[[0.0; 3]],
            triangles: &[[0, 1, 2]],
        });
        assert_eq!(missing.min_angle_degrees, 0.0);
    }

    #[test]
    fn mean_and_worst_of_several() {
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 3f64.sqrt()],
        ];
        let quality = triangle_quality(Triangles {
            positions: &positions,
            triangles: &[[0, 1, 2], [0, 1, 3], [0, 2, 3]],
        });
        assert!((quality.min_angle_degrees - 30.0).abs() < 1e-12);
        assert_eq!(quality.worst_face, Some(1));
        assert!((quality.mean_min_angle_degrees - 35.0).abs() < 1e-12);
        assert_eq!(quality.histogram.iter().sum::<usize>(), 3);
    }

    #[test]
    fn nothing_gives_nothing() {
        let quality = triangle_quality(Triangles {
            positions: &[],
            triangles: &[],
        });
        assert_eq!(quality.worst_face, None);
        assert_eq!(
            (quality.min_angle_degrees, quality.mean_min_angle_degrees),
            (0.0, 0.0)
        );
    }
}
