//! Perspective cameras: the greatest number of pixels of a distance in space, and the greatest
//! length below a number of pixels.
//!
//! **One camera.** Let e be its eye and p a point at depth z before it, at the picture's (x, y)/z =
//! u, F being the pixels of a unit length at depth 1. A point p + δ appears F(δ′ − u δ_z)/(z + δ_z)
//! away from it, δ′ being the part of δ across the line through the middle of the picture. The
//! vector (δ′ − u δ_z, 0) is the projection of δ along the line of sight on the picture, whose
//! length is at most |δ| sin θ / cos φ: θ is the angle between δ and the line of sight, which is φ
//! off the axis. So the distance in the picture is at most
//!
//! > F |δ| sin θ / (cos φ (z − |δ|)).
//!
//! **A ball.** Let p be a point of a ball that the camera sees, that is, within its picture's frame. Then cos φ is at
//! least that of the frame's corners, and that of the farthest direction that meets the ball; the distance of p
//! from e is at least that of the ball, and so z at least that times cos φ, or the depth at which the ball begins. So
//! the depth is above 0 unless e is within the ball, also where the ball reaches behind the eye. A ball that is wholly
//! outside one of the frame's sides is not seen. All these only get better for a ball within the ball.
//!
//! **Displacements.** δ may be the sum of a vector of length a in any direction and one of length h along normals, which
//! are within an angle κ of an axis. Then |δ| sin θ ≤ a + h sin θ, θ at most the angle between axis and the line of sight
//! to the ball's middle, κ, and the angle at which the ball is seen, together.
//!
//! Regions that face away from all cameras are not visible on closed surfaces: a picture shows only
//! the front, which its outlines bound. The back of an open surface may be visible. The caller
//! decides which regions are backs ([`Backs`]), since this file does not know how a surface bends
//! over a region.

use smallvec::SmallVec;

use super::region::{cosine_of, sum_of_angles};
use super::{CriterionError, Region, Viewpoint};
use crate::math;
use crate::vector::{DVec3, unit_or_zero, vector};

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Its position.
    pub eye: [f64; 3],
    /// A point in the middle of its picture.
    pub target: [f64; 3],
    /// A direction that points up in its picture.
    pub up: [f64; 3],
    /// Angle of view from the bottom to the top of the picture, in degrees: above 0, below 180.
    pub fov_degrees: f64,
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
}

impl Camera {
    /// # Errors
    /// It has no direction of sight, no upright, no picture or an impossible angle.
    pub fn check(&self) -> Result<(), CriterionError> {
        Lens::new(self).map(|_| ())
    }
}

/// The least sine assumed of the angle between line of sight and normal: surfaces that face the
/// camera keep some accuracy, for shading and for what happens when the camera moves a little.
const LEAST_SINE: f64 = 0.25;

/// The uncertain part of a piece facing away may be as near to a corner as this part of the allowed
/// length.
const REST: f64 = 0.125;

/// Sines of angles up to this are 0 within rounding.
const PARALLEL: f64 = 1e-9;

/// Cameras stand no farther away: squares of distances are finite.
const FARTHEST: f64 = 1e150;

/// Greatest lengths that are certainly within a number of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Allowed {
    /// In any direction.
    pub(crate) length: f64,
    /// Along normals.
    pub(crate) height: f64,
}

/// The viewers that see only the back of a triangle and of its piece of a closed surface.
#[derive(Clone, Debug, Default)]
pub(crate) struct Backs {
    /// By camera; nothing where none does.
    cameras: SmallVec<[bool; 8]>,
    /// The part of which that is not certain is at most this many pixels from a corner of the
    /// triangle.
    rest: f64,
    /// The viewer that an angle depends on.
    pub(crate) view: bool,
}

impl Backs {
    /// The backs where no viewer sees only the back.
    pub(crate) fn nobodys() -> Self {
        Self::default()
    }

    fn has(&self, camera: usize) -> bool {
        self.cameras.get(camera).is_some_and(|&is_back| is_back)
    }
}

/// A greatest distance in the pictures of some cameras.
#[derive(Clone, Debug)]
pub(crate) struct Pixels {
    limit: f64,
    /// Whether the surface is closed, so that backs are not visible.
    is_closed: bool,
    lenses: Vec<Lens>,
}

impl Pixels {
    /// At most `limit` pixels, of a surface that is closed or not.
    ///
    /// # Errors
    /// A camera that looks nowhere, has no upright, no picture or an impossible angle.
    pub(crate) fn new(
        limit: f64,
        cameras: &[Camera],
        is_closed: bool,
    ) -> Result<Self, CriterionError> {
        let lenses = cameras.iter().map(Lens::new).collect::<Result<_, _>>()?;
        Ok(Self {
            limit,
            is_closed,
            lenses,
        })
    }

    /// The number of cameras from which a surface may face away.
    pub(crate) fn viewers(&self) -> usize {
        if self.is_closed { self.lenses.len() } else { 0 }
    }

    /// The cameras that see only the back of a region. For a camera and its position `is_back`
    /// gives the distance from the corners of the region's triangle of the uncertain part, if that
    /// is hardly more than the given length.
    pub(crate) fn backs(
        &self,
        region: &Region,
        mut is_back: impl FnMut(usize, &Viewpoint, f64) -> Option<f64>,
    ) -> Backs {
        let mut backs = Backs::nobodys();
        if !self.is_closed {
            return backs;
        }
        for (camera, lens) in self.lenses.iter().enumerate() {
            let Some(glance) = lens.glance(region.centre, region.radius) else {
                continue;
            };
            let viewpoint = Viewpoint::Eye(lens.eye.to_array());
            let Some(rest) = is_back(camera, &viewpoint, REST * glance.allowed(self.limit, 1.0))
            else {
                continue;
            };
            let rest = lens
                .glance(region.centre, region.radius + rest)
                .map_or(0.0, |glance| glance.pixels(0.0, rest, 1.0));
            backs.rest = backs.rest.max(rest);
            backs.cameras.resize(self.lenses.len(), false);
            backs.cameras[camera] = true;
        }
        backs
    }

    /// The greatest distance between a point that is seen in a ball and another one, in any
    /// direction, that is certainly within the limit in all pictures: infinite where no camera sees
    /// more of the ball than its back, 0 where an eye is in it.
    ///
    /// Never less for a ball within the ball.
    pub(crate) fn allowed_length(&self, centre: DVec3, radius: f64, backs: &Backs) -> f64 {
        let seen = self.glances(centre, radius, backs);
        seen.map(|glance| glance.allowed(self.limit, 1.0))
            .fold(f64::INFINITY, f64::min)
    }

    /// The allowed lengths in any direction and along the normals of a region. Neither is less than
    /// [`Self::allowed_length`].
    ///
    /// Never less for a region within the region. Parts of the allowed lengths may be added: half
    /// of one and half of the other are within the limit together.
    pub(crate) fn allowed(&self, region: &Region, backs: &Backs) -> Allowed {
        let nothing = Allowed {
            length: f64::INFINITY,
            height: f64::INFINITY,
        };
        self.glances(region.centre, region.radius, backs)
            .fold(nothing, |least, glance| Allowed {
                length: least.length.min(glance.allowed(self.limit, 1.0)),
                height: least
                    .height
                    .min(glance.allowed(self.limit, glance.sine(region))),
            })
    }

    /// The ratio to the limit of the uncertain part for cameras that see the back.
    pub(crate) fn rest_ratio(&self, backs: &Backs) -> f64 {
        backs.rest / self.limit
    }

    /// How many pixels there are at most between a point that is seen in a region and one that is `height` along its
    /// normals and `across` in any direction from it.
    pub(crate) fn seen(&self, region: &Region, (height, across): (f64, f64), backs: &Backs) -> f64 {
        let seen = self.glances(region.centre, region.radius, backs);
        let seen = seen
            .map(|glance| glance.pixels(height, across, glance.sine(region)))
            .fold(0.0, f64::max);
        seen.max(backs.rest)
    }

    /// Each camera that sees more of a ball than its back.
    fn glances(&self, centre: DVec3, radius: f64, backs: &Backs) -> impl Iterator<Item = Glance> {
        let front = self
            .lenses
            .iter()
            .enumerate()
            .filter(|&(camera, _)| !backs.has(camera));
        front.filter_map(move |(_, lens)| lens.glance(centre, radius))
    }
}

/// How a camera sees a ball.
#[derive(Clone, Copy, Debug)]
struct Glance {
    /// Pixels of a unit length at depth 1, stretched as much as it can be off the axis.
    pixels: f64,
    /// The least depth of the visible part of the ball; 0 where the eye is in it.
    depth: f64,
    /// Unit direction to the ball's middle.
    toward: DVec3,
    /// Sine of the angle between it and the lines of sight.
    spread: f64,
}

impl Glance {
    /// The greatest sine of the angle between lines of sight and the normals of a region.
    fn sine(&self, region: &Region) -> f64 {
        let spread = sum_of_angles(region.sine, self.spread);
        if region.axis == DVec3::ZERO || spread >= 1.0 {
            return 1.0;
        }
        let sine = self.toward.cross(region.axis).length();
        sum_of_angles(sine.min(1.0), spread).max(LEAST_SINE)
    }

    /// The greatest length that stays within `limit` pixels at angles to the line of sight up to
    /// that of the sine.
    fn allowed(&self, limit: f64, sine: f64) -> f64 {
        limit * self.depth / (self.pixels * sine + limit)
    }

    /// The inverse, for the sum of two lengths.
    fn pixels(&self, height: f64, across: f64, sine: f64) -> f64 {
        let length = height + across;
        if length == 0.0 {
            0.0
        } else if length < self.depth {
            self.pixels * (height * sine + across) / (self.depth - length)
        } else {
            f64::INFINITY
        }
    }
}

/// A camera's frame, ready for many regions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lens {
    pub(crate) eye: DVec3,
    pub(crate) forward: DVec3,
    /// Unit vectors at right angles to the sides of the frame, pointing outwards.
    pub(crate) sides: [DVec3; 4],
    /// Pixels of a unit length at depth 1.
    pub(crate) pixels: f64,
    /// 1/cos φ at the frame's corners.
    pub(crate) greatest_stretch: f64,
}

impl Lens {
    pub(crate) fn new(camera: &Camera) -> Result<Self, CriterionError> {
        let bad = |name, value, expected| {
            Err(CriterionError::BadParameter {
                name,
                value,
                expected,
            })
        };
        let places = [camera.eye, camera.target, camera.up];
        if let Some(&value) = places.as_flattened().iter().find(|x| !x.is_finite()) {
            return bad("camera", value, "finite coordinates");
        }
        if let Some(&value) = places.as_flattened().iter().find(|x| x.abs() > FARTHEST) {
            return bad(
                "camera's coordinate",
                value,
                "a number up to 1e150, whose square is finite",
            );
        }
        if !(camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0) {
            return bad(
                "camera's angle of view",
                camera.fov_degrees,
                "degrees above 0 and below 180",
            );
        }
        if camera.width == 0 || camera.height == 0 {
            return bad(
                "camera's picture",
                0.0,
                "a width and a height of at least one pixel",
            );
        }
        let (eye, target) = (vector(camera.eye), vector(camera.target));
        let forward = unit_or_zero(target - eye);
        if forward == DVec3::ZERO {
            return bad(
                "distance from the camera's eye to its target",
                0.0,
                "different points",
            );
        }
        let right = forward.cross(unit_or_zero(vector(camera.up)));
        let sine = right.length();
        if sine <= PARALLEL {
            let name = "sine of the angle between the camera's upward direction and that of sight";
            return bad(name, sine, "an upward direction other than that of sight");
        }
        let right = right / sine;
        let up = right.cross(forward);
        let (width, height) = (f64::from(camera.width), f64::from(camera.height));
        let along = math::tan((0.5 * camera.fov_degrees).to_radians());
        let across = along * width / height;
        let side = |axis: DVec3, tangent: f64| (axis - tangent * forward).normalize();
        Ok(Self {
            eye,
            forward,
            sides: [
                side(right, across),
                side(-right, across),
                side(up, along),
                side(-up, along),
            ],
            pixels: 0.5 * height / along,
            greatest_stretch: math::hypot(math::hypot(across, along), 1.0),
        })
    }

    /// How it sees a ball; `None` if it doesn't.
    fn glance(&self, centre: DVec3, radius: f64) -> Option<Glance> {
        let sight = centre - self.eye;
        let depth = sight.dot(self.forward);
        if depth < -radius || self.sides.iter().any(|side| side.dot(sight) > radius) {
            return None;
        }
        let distance = sight.length();
        let room = distance - radius;
        // Also where either is NaN.
        if !(room > 0.0 && distance.is_finite()) {
            let pixels = self.pixels * self.greatest_stretch;
            return Some(Glance {
                pixels,
                depth: 0.0,
                toward: DVec3::ZERO,
                spread: 1.0,
            });
        }
        let spread = radius / distance;
        let (cosine, sine) = (
            depth / distance,
            sight.cross(self.forward).length() / distance,
        );
        let farthest = cosine * cosine_of(spread) - sine * spread;
        let stretch = if farthest * self.greatest_stretch > 1.0 {
            1.0 / farthest
        } else {
            self.greatest_stretch
        };
        Some(Glance {
            pixels: self.pixels * stretch,
            depth: (depth - radius).max(room / stretch),
            toward: sight / distance,
            spread,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use limitmesh_testing::Random;

    fn camera(random: &mut Random) -> Camera {
        let eye = 3.0 * random.vector();
        Camera {
            eye: eye.to_array(),
            target: (eye + random.direction()).to_array(),
            up: random.direction().to_array(),
            fov_degrees: 85.0 + 84.0 * random.signed(),
            width: 640,
            height: 200 + (300.0 * (1.0 + random.signed())) as u32,
        }
    }

    fn region(random: &mut Random, size: f64) -> Region {
        let sine = if random.signed() > 0.9 {
            1.0
        } else {
            0.4 * (1.0 + random.signed())
        };
        Region {
            centre: random.vector(),
            radius: size * (1.0 + random.signed()),
            axis: random.direction(),
            sine,
        }
    }

    /// A point of a region and a normal, on its rim now and then.
    fn within(random: &mut Random, region: &Region) -> (DVec3, DVec3) {
        let reach = if random.signed() > 0.0 {
            1.0
        } else {
            random.signed().abs()
        };
        let point = region.centre + reach * region.radius * random.direction();
        if region.sine >= 1.0 {
            return (point, random.direction());
        }
        let sine = region.sine
            * if random.signed() > 0.0 {
                1.0
            } else {
                random.signed().abs()
            };
        let across = region.axis.cross(random.direction()).normalize();
        (
            point,
            (1.0 - sine * sine).sqrt() * region.axis + sine * across,
        )
    }

    /// The pixel at which a camera sees a point, from its description alone; `None` behind it. And whether that is in the
    /// picture.
    fn pixel(camera: &Camera, point: DVec3) -> Option<([f64; 2], bool)> {
        let forward = (vector(camera.target) - vector(camera.eye)).normalize();
        let right = forward.cross(vector(camera.up)).normalize();
        let up = right.cross(forward);
        let sight = point - vector(camera.eye);
        let (width, height) = (f64::from(camera.width), f64::from(camera.height));
        let focal = 0.5 * height / (0.5 * camera.fov_degrees.to_radians()).tan();
        let depth = sight.dot(forward);
        if depth <= 0.0 {
            return None;
        }
        let at = [right, up].map(|axis| focal * sight.dot(axis) / depth);
        Some((
            at,
            2.0 * at[0].abs() <= width && 2.0 * at[1].abs() <= height,
        ))
    }

    fn pixels_between(camera: &Camera, a: DVec3, b: DVec3) -> f64 {
        match (pixel(camera, a), pixel(camera, b)) {
            (Some((a, _)), Some((b, _))) => (a[0] - b[0]).hypot(a[1] - b[1]),
            _ => f64::INFINITY,
        }
    }

    /// No displacement of an allowed length is seen longer than the limit, and some come near it.
    #[test]
    fn what_is_allowed_stays_below_the_limit() {
        let mut random = Random::new(3);
        let (mut closest, mut closest_along) = (0.0f64, 0.0f64);
        let mut seen = 0;
        for round in 0..3000 {
            let cameras = [camera(&mut random), camera(&mut random)];
            let limit = 2f64.powf(6.0 * random.signed());
            let region = region(&mut random, if round % 2 == 0 { 0.5 } else { 0.01 });
            let pixels = Pixels::new(limit, &cameras, true).unwrap();
            let nobodys = Backs::nobodys();
            let length = pixels.allowed_length(region.centre, region.radius, &nobodys);
            let height = pixels.allowed(&region, &nobodys).height;
            assert_eq!(pixels.allowed(&region, &nobodys).length, length);
            assert!(length <= height, "{length} {height}");
            for _ in 0..40 {
                let (point, normal) = within(&mut random, &region);
                for camera in &cameras {
                    if !pixel(camera, point).is_some_and(|(_, is_inside)| is_inside) {
                        continue;
                    }
                    seen += 1;
                    assert!(length.is_finite() && height.is_finite());
                    let aside = random.direction();
                    let found = pixels_between(camera, point, point + length * aside);
                    assert!(
                        found <= limit * (1.0 + 1e-9),
                        "{found} of {limit}: {camera:?} {region:?}"
                    );
                    closest = closest.max(found / limit);
                    for along in [height * normal, -height * normal] {
                        let found = pixels_between(camera, point, point + along);
                        assert!(
                            found <= limit * (1.0 + 1e-9),
                            "{found} of {limit}: {region:?}"
                        );
                        closest_along = closest_along.max(found / limit);
                    }
                    // Both parts together, and the number of pixels that is reported.
                    let (share, total) = (random.signed().abs(), 3.0 * random.signed().abs());
                    let (part, rest) = (share * total * height, (1.0 - share) * total * length);
                    let reported = pixels.seen(&region, (part, rest), &nobodys);
                    let found = pixels_between(camera, point, point + part * normal + rest * aside);
                    assert!(found <= reported * (1.0 + 1e-9), "{found} of {reported}");
                    assert!(
                        reported <= limit || total > 1.0 - 1e-9,
                        "{reported} of {limit}"
                    );
                }
            }
        }
        assert!(
            seen > 10_000 && closest > 0.9 && closest_along > 0.9,
            "{seen} {closest} {closest_along}"
        );
    }

    /// A smaller region within never allows less.
    #[test]
    fn smaller_regions_allow_no_less() {
        let mut random = Random::new(11);
        for _ in 0..20_000 {
            let pixels =
                Pixels::new(1.0, &[camera(&mut random), camera(&mut random)], true).unwrap();
            let region = region(&mut random, 0.7);
            let share = random.signed().abs();
            let centre = region.centre
                + (1.0 - share) * region.radius * random.signed() * random.direction();
            let (_, axis) = within(&mut random, &region);
            let sine = if region.sine >= 1.0 {
                random.signed().abs()
            } else {
                let turn = region.axis.dot(axis).clamp(-1.0, 1.0).acos();
                (region.sine.asin() - turn).max(0.0).sin()
            };
            let inner = Region {
                centre,
                radius: share * region.radius,
                axis,
                sine,
            };
            let nobodys = Backs::nobodys();
            let (outer, less) = (
                pixels.allowed(&region, &nobodys),
                pixels.allowed(&inner, &nobodys),
            );
            let is_less = less.length < outer.length * (1.0 - 1e-7)
                || less.height < outer.height * (1.0 - 1e-7);
            assert!(!is_less, "{outer:?} {less:?}: {region:?} {inner:?}");
            let outer = pixels.allowed_length(region.centre, region.radius, &nobodys);
            let less = pixels.allowed_length(inner.centre, inner.radius, &nobodys);
            assert!(
                less >= outer * (1.0 - 1e-12),
                "{outer} {less}: {region:?} {inner:?}"
            );
        }
    }

    #[test]
    fn an_eye_in_the_ball_and_a_ball_out_of_sight() {
        let camera = Camera {
            eye: [0.0, 0.0, 5.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            fov_degrees: 90.0,
            width: 100,
            height: 100,
        };
        let pixels = Pixels::new(1.0, &[camera], true).unwrap();
        let nobodys = Backs::nobodys();
        let length = |at: DVec3, radius: f64| pixels.allowed_length(at, radius, &nobodys);
        assert_eq!(length(DVec3::new(0.0, 0.0, 5.5), 1.0), 0.0);
        assert_eq!(length(DVec3::new(0.0, 0.0, 6.5), 1.0), f64::INFINITY);
        assert_eq!(length(DVec3::new(9.0, 0.0, 0.0), 1.0), f64::INFINITY);
        assert!(length(DVec3::new(6.0, 0.0, 0.0), 1.0).is_finite());
        // At depth 5 a pixel is a tenth of a unit.
        assert!((length(DVec3::ZERO, 0.0) - 5.0 / 51.0).abs() < 1e-12);
        let region = Region {
            centre: DVec3::ZERO,
            radius: 0.1,
            axis: DVec3::Z,
            sine: 0.1,
        };
        assert!(pixels.allowed(&region, &nobodys).height > 3.0 * length(DVec3::ZERO, 0.1));
        assert_eq!(
            pixels.seen(&region, (0.0, f64::NAN), &nobodys),
            f64::INFINITY
        );
    }

    /// Cameras that see only the back require only that the uncertain part is within the limit;
    /// others are unaffected.
    #[test]
    fn backs_are_not_seen() {
        let mut random = Random::new(17);
        let (mut half, mut rests) = (0, 0.0f64);
        for _ in 0..2000 {
            let cameras = [camera(&mut random), camera(&mut random)];
            let region = region(&mut random, 0.3);
            let pixels = Pixels::new(2.0, &cameras, true).unwrap();
            let is_second = |viewpoint: &Viewpoint| *viewpoint == Viewpoint::Eye(cameras[1].eye);
            let share = 1.5 * random.signed().abs();
            let backs = pixels.backs(&region, |_, viewpoint, rest| {
                is_second(viewpoint).then_some(share * rest)
            });
            let first = Pixels::new(2.0, &cameras[..1], true).unwrap();
            let nobodys = Backs::nobodys();
            assert_eq!(
                pixels.allowed(&region, &backs),
                first.allowed(&region, &nobodys)
            );
            let reported = pixels.seen(&region, (0.01, 0.02), &backs);
            assert_eq!(
                reported,
                first
                    .seen(&region, (0.01, 0.02), &nobodys)
                    .max(2.0 * pixels.rest_ratio(&backs))
            );
            // An eighth of the allowed length has a little more pixels where it is nearer to the
            // eye than the region.
            assert!(pixels.rest_ratio(&backs) < 0.25);
            half += usize::from(reported > 0.0);
            rests = rests.max(pixels.rest_ratio(&backs));
            let open = Pixels::new(2.0, &cameras, false).unwrap();
            assert_eq!(
                open.allowed(&region, &open.backs(&region, |_, _, _| Some(0.0))),
                open.allowed(&region, &nobodys)
            );
        }
        assert!(half > 200 && rests > 0.1, "{half} {rests}");
    }
}
