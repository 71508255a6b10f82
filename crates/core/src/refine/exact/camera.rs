//! Perspective cameras: how long a distance may be to stay within some pixels.

use crate::certificate::TriangleFrame;
use crate::mesh::MeshError;
use crate::patch::LimitPoint;
use crate::vector::{DVec3, vector};

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it stands.
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

/// The least sine that the angle between line of sight and normal is taken to have: what looks straight at the camera
/// keeps some accuracy, for shading and for what happens when the camera moves a little.
const LEAST_SINE: f64 = 0.25;

/// A camera's frame, ready for many triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lens {
    eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// Tangents of half the angles of view.
    across: f64,
    along: f64,
    /// Length of a pixel at depth 1.
    pixel: f64,
}

impl Lens {
    /// # Errors
    /// A camera that looks nowhere, has no upright, no picture or an impossible angle.
    pub(super) fn new(camera: &Camera) -> Result<Self, MeshError> {
        let bad = |name, value, expected| Err(MeshError::BadOption { name, value, expected });
        let places = [camera.eye, camera.target, camera.up];
        if let Some(&value) = places.as_flattened().iter().find(|x| !x.is_finite()) {
            return bad("camera", value, "finite coordinates");
        }
        if !(camera.fov_degrees > 0.0 && camera.fov_degrees < 180.0) {
            return bad("camera's angle of view", camera.fov_degrees, "degrees above 0 and below 180");
        }
        if camera.width == 0 || camera.height == 0 {
            return bad("camera's picture", 0.0, "a width and a height of at least one pixel");
        }
        let (eye, target) = (vector(camera.eye), vector(camera.target));
        let Some(forward) = (target - eye).try_normalize() else {
            return bad("distance from the camera's eye to its target", 0.0, "different points");
        };
        let Some(right) = vector(camera.up).try_normalize().and_then(|up| {
            let right = forward.cross(up);
            (right.length() > 1e-9).then(|| right.normalize())
        }) else {
            return bad("camera's upward direction", 0.0, "a direction other than that of sight");
        };
        let along = (0.5 * camera.fov_degrees).to_radians().tan();
        let (width, height) = (f64::from(camera.width), f64::from(camera.height));
        let across = along * width / height;
        Ok(Self { eye, forward, right, up: right.cross(forward), across, along, pixel: 2.0 * along / height })
    }

    /// The distance that a triangle may have from its piece of the surface to stay within one pixel: infinite where the
    /// camera does not see it.
    pub(super) fn one_pixel(&self, frame: &TriangleFrame, corners: &[LimitPoint; 3]) -> f64 {
        let sights = corners.map(|corner| corner.position - self.eye);
        let size = frame.length(0).max(frame.length(1)).max(frame.length(2));
        let depths = sights.map(|sight| sight.dot(self.forward));
        let nearest = depths.into_iter().fold(f64::INFINITY, f64::min);
        // The surface may bulge out of the triangle, by much less than its size.
        let margin = 0.5 * size;
        let is_outside = |side: f64, axis: DVec3, tangent: f64| {
            let slant = tangent.hypot(1.0);
            (0..3).all(|i| side * sights[i].dot(axis) - tangent * depths[i] > margin * slant)
        };
        if depths.iter().all(|&depth| depth < -margin)
            || is_outside(1.0, self.right, self.across)
            || is_outside(-1.0, self.right, self.across)
            || is_outside(1.0, self.up, self.along)
            || is_outside(-1.0, self.up, self.along)
        {
            return f64::INFINITY;
        }
        // Normals of the piece stay within this angle of the corners'.
        let cone = corners.iter().map(|corner| corner.normal.distance(frame.normal())).fold(0.0, f64::max);
        let sines = sights.iter().zip(corners).map(|(sight, corner)| {
            let length = sight.length().max(f64::MIN_POSITIVE);
            let cosine = (sight.dot(corner.normal) / length).clamp(-1.0, 1.0);
            (cosine, (1.0 - cosine * cosine).sqrt())
        });
        let (mut is_hidden, mut sine) = (true, LEAST_SINE);
        for (cosine, across) in sines {
            // Looking along the normal is looking at the back.
            is_hidden &= cosine > cone;
            sine = sine.max(across + cone);
        }
        if is_hidden {
            return f64::INFINITY;
        }
        // Nearer than the triangle's own size the depth says nothing.
        let depth = nearest.max(1e-3 * size);
        self.pixel * depth / sine.min(1.0)
    }
}
