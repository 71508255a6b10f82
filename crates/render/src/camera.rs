//! Cameras: where the viewer stands, what is up, and how space falls on the picture.
//!
//! Takes a surface to frame or an eye and a target, gives homogeneous picture coordinates in pixels.

use glam::DVec3;
use limitmesh::{Ray, Triangles};

use crate::RenderError;
use crate::check::check_size;

/// A direction of sight and what is up in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewDirection {
    /// From the viewer into the scene; any length above zero.
    pub sight: [f64; 3],
    /// What points upwards in the picture; need not be perpendicular to the sight. Where it is parallel to it,
    /// another axis is taken.
    pub up: [f64; 3],
}

impl ViewDirection {
    /// A direction of sight with the y axis up.
    pub fn along(sight: [f64; 3]) -> Self {
        Self {
            sight,
            up: [0.0, 1.0, 0.0],
        }
    }

    /// The same direction with another up.
    pub fn with_up(self, up: [f64; 3]) -> Self {
        Self { up, ..self }
    }

    /// From the front: along −z, y up.
    pub fn front() -> Self {
        Self::along([0.0, 0.0, -1.0])
    }

    /// From the right-hand side of the picture's front: along −x, y up.
    pub fn side() -> Self {
        Self::along([-1.0, 0.0, 0.0])
    }

    /// From above: along −y, with −z up.
    pub fn top() -> Self {
        Self {
            sight: [0.0, -1.0, 0.0],
            up: [0.0, 0.0, -1.0],
        }
    }
}

/// From the front, a little from the right and above, which shows most shapes well.
impl Default for ViewDirection {
    fn default() -> Self {
        Self::along([-0.5, -0.35, -1.0])
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Projection {
    /// Parallel; half of the picture's height in the scene's unit of length.
    Orthographic { half_height: f64 },
    /// Central; the tangent of half the vertical field of view.
    Perspective { tangent: f64 },
}

/// Where a picture is taken from. The vertical extent of the picture is fixed, the horizontal one follows from
/// the picture's proportions; pixels are square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    sight: DVec3,
    projection: Projection,
}

/// Empty border that framing leaves, as a part of half the picture's shorter side.
const MARGIN: f64 = 0.06;

impl Camera {
    /// A parallel projection that frames the surface's bounding sphere, so that the scale is the same from
    /// every side.
    ///
    /// # Errors
    /// No triangles, positions that are not finite, a direction without length, a size that is not possible.
    pub fn fit(
        surface: Triangles<'_>,
        view: ViewDirection,
        width: u32,
        height: u32,
    ) -> Result<Self, RenderError> {
        let (centre, radius) = bounding_sphere(surface)?;
        check_size(width.into(), height.into())?;
        let half = radius / (1.0 - MARGIN);
        let half_height = half * f64::from(height) / f64::from(width.min(height));
        Self::orthographic(centre.to_array(), view, half_height)
    }

    /// A parallel projection that frames what is seen of the surface from this side as large as the picture
    /// allows.
    ///
    /// # Errors
    /// As for [`Camera::fit`].
    pub fn fit_tightly(
        surface: Triangles<'_>,
        view: ViewDirection,
        width: u32,
        height: u32,
    ) -> Result<Self, RenderError> {
        let (centre, radius) = bounding_sphere(surface)?;
        check_size(width.into(), height.into())?;
        let [right, up, _] = basis(view)?;
        let extent = |axis: DVec3| {
            let ends = corners(surface).map(|p| (p - centre).dot(axis));
            ends.fold((f64::MAX, f64::MIN), |(low, high), x| {
                (low.min(x), high.max(x))
            })
        };
        let ((left, right_end), (bottom, top)) = (extent(right), extent(up));
        let centre = centre + right * (0.5 * (left + right_end)) + up * (0.5 * (bottom + top));
        let aspect = f64::from(height) / f64::from(width);
        let half_height = (0.5 * (top - bottom)).max(0.5 * (right_end - left) * aspect);
        // A surface seen exactly edge-on has no extent: fall back to the sphere's.
        let half_height = if half_height > 1e-6 * radius {
            half_height
        } else {
            radius
        };
        Self::orthographic(centre.to_array(), view, half_height / (1.0 - MARGIN))
    }

    /// A perspective that frames the surface's bounding sphere.
    ///
    /// `field_of_view` is the vertical angle of the picture in degrees, above 0 and below 180.
    ///
    /// # Errors
    /// As for [`Camera::fit`], or the angle is out of range.
    pub fn fit_perspective(
        surface: Triangles<'_>,
        view: ViewDirection,
        field_of_view: f64,
        width: u32,
        height: u32,
    ) -> Result<Self, RenderError> {
        let (centre, radius) = bounding_sphere(surface)?;
        check_size(width.into(), height.into())?;
        let tangent = half_tangent(field_of_view)?;
        let [.., sight] = basis(view)?;
        // The cone inscribed in the narrower direction must touch the sphere: distance = r / sin(half angle).
        let narrow = tangent * f64::from(width.min(height)) / f64::from(height) * (1.0 - MARGIN);
        let eye = centre - sight * (radius * (1.0 + narrow * narrow).sqrt() / narrow);
        Self::perspective(eye.to_array(), centre.to_array(), view.up, field_of_view)
    }

    /// A parallel projection with `target` in the middle of the picture, whose height is twice `half_height`.
    ///
    /// # Errors
    /// A direction without length, numbers that are not finite, a height that is not above zero.
    pub fn orthographic(
        target: [f64; 3],
        view: ViewDirection,
        half_height: f64,
    ) -> Result<Self, RenderError> {
        check_finite("camera target", &target)?;
        RenderError::check_range(
            "half of the picture's height",
            half_height,
            f64::MIN_POSITIVE..=f64::MAX,
            "a finite number above 0",
        )?;
        let [right, up, sight] = basis(view)?;
        let projection = Projection::Orthographic { half_height };
        Ok(Self {
            eye: DVec3::from_array(target),
            right,
            up,
            sight,
            projection,
        })
    }

    /// A perspective from `eye` towards `target`.
    ///
    /// `field_of_view` is the vertical angle of the picture in degrees, above 0 and below 180.
    ///
    /// # Errors
    /// Eye and target coincide, numbers are not finite, or the angle is out of range.
    pub fn perspective(
        eye: [f64; 3],
        target: [f64; 3],
        up: [f64; 3],
        field_of_view: f64,
    ) -> Result<Self, RenderError> {
        check_finite("camera eye", &eye)?;
        check_finite("camera target", &target)?;
        let tangent = half_tangent(field_of_view)?;
        let sight = DVec3::from_array(target) - DVec3::from_array(eye);
        let [right, up, sight] = basis(ViewDirection {
            sight: sight.to_array(),
            up,
        })?;
        let projection = Projection::Perspective { tangent };
        Ok(Self {
            eye: DVec3::from_array(eye),
            right,
            up,
            sight,
            projection,
        })
    }

    /// The unit direction of sight through the middle of the picture, from the viewer into the scene.
    pub fn sight(&self) -> [f64; 3] {
        self.sight.to_array()
    }

    /// The eye point of a perspective; `None` for a parallel projection.
    pub fn eye(&self) -> Option<[f64; 3]> {
        self.is_perspective().then(|| self.eye.to_array())
    }

    /// Where a point falls on a picture of this size: pixels from its left and upper border. `None` for points
    /// behind the eye.
    pub fn project(&self, point: [f64; 3], width: u32, height: u32) -> Option<[f64; 2]> {
        let p = self.homogeneous(point, width, height);
        (p.w > 0.0).then(|| [p.x / p.w, p.y / p.w])
    }

    pub(crate) fn is_perspective(&self) -> bool {
        matches!(self.projection, Projection::Perspective { .. })
    }

    /// Right, up and towards the viewer.
    pub(crate) fn frame(&self) -> [DVec3; 3] {
        [self.right, self.up, -self.sight]
    }

    /// Unit direction from a point of the scene to the viewer.
    pub(crate) fn towards_viewer(&self, point: DVec3) -> DVec3 {
        match self.projection {
            Projection::Orthographic { .. } => -self.sight,
            Projection::Perspective { .. } => (self.eye - point).normalize_or(-self.sight),
        }
    }

    /// The line of sight through a point of the picture, in pixels from its left and upper border; its direction is a unit of depth long.
    /// In a parallel projection it begins at the depth of the target, and what is in front is at negative places of it.
    pub(crate) fn ray(&self, [x, y]: [f64; 2], width: u32, height: u32) -> Ray {
        let (x, y) = (x - 0.5 * f64::from(width), 0.5 * f64::from(height) - y);
        let scale = |unit: f64| 2.0 * unit / f64::from(height);
        let aside = |scale: f64| self.right * (x * scale) + self.up * (y * scale);
        let (origin, direction) = match self.projection {
            Projection::Orthographic { half_height } => {
                (self.eye + aside(scale(half_height)), self.sight)
            }
            Projection::Perspective { tangent } => (self.eye, self.sight + aside(scale(tangent))),
        };
        Ray {
            origin: origin.to_array(),
            direction: direction.to_array(),
        }
    }

    /// How long a pixel's side is at a depth.
    pub(crate) fn pixel_at(&self, depth: f64, height: u32) -> f64 {
        match self.projection {
            Projection::Orthographic { half_height } => 2.0 * half_height / f64::from(height),
            Projection::Perspective { tangent } => 2.0 * tangent * depth.abs() / f64::from(height),
        }
    }

    /// Picture coordinates of a point.
    pub(crate) fn homogeneous(&self, point: [f64; 3], width: u32, height: u32) -> Homogeneous {
        let p = DVec3::from_array(point) - self.eye;
        let (width, height) = (f64::from(width), f64::from(height));
        let distance = p.dot(self.sight);
        let (w, scale) = match self.projection {
            Projection::Orthographic { half_height } => (1.0, 0.5 * height / half_height),
            Projection::Perspective { tangent } => (distance, 0.5 * height / tangent),
        };
        Homogeneous {
            x: p.dot(self.right) * scale + 0.5 * width * w,
            y: 0.5 * height * w - p.dot(self.up) * scale,
            w,
            distance,
        }
    }
}

/// A point in homogeneous picture coordinates: the pixel is (x/w, y/w), from the picture's upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Homogeneous {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) w: f64,
    /// Along the direction of sight, from the eye (or from the target of a parallel projection).
    pub(crate) distance: f64,
}

/// Right, up and sight of a view, orthonormal.
fn basis(view: ViewDirection) -> Result<[DVec3; 3], RenderError> {
    check_finite("direction of sight", &view.sight)?;
    check_finite("up direction", &view.up)?;
    let sight = direction(view.sight).ok_or(RenderError::BadOption {
        name: "the direction of sight's length",
        value: 0.0,
        expected: "a length above 0",
    })?;
    let up = direction(view.up).unwrap_or(DVec3::Y);
    let mut right = sight.cross(up);
    if right.length_squared() < 1e-12 {
        right = sight.cross(if sight.z.abs() < 0.9 {
            DVec3::NEG_Z
        } else {
            DVec3::Y
        });
    }
    let right = right.normalize();
    Ok([right, right.cross(sight), sight])
}

/// Normalised without overflow or underflow of the squares.
fn direction(v: [f64; 3]) -> Option<DVec3> {
    let v = DVec3::from_array(v);
    let largest = v.abs().max_element();
    if largest > 0.0 {
        (v / largest).try_normalize()
    } else {
        None
    }
}

fn half_tangent(field_of_view: f64) -> Result<f64, RenderError> {
    RenderError::check_range(
        "the field of view",
        field_of_view,
        0.01..=179.0,
        "an angle from 0.01 to 179 degrees",
    )?;
    Ok((0.5 * field_of_view.to_radians()).tan())
}

fn check_finite(what: &'static str, values: &[f64; 3]) -> Result<(), RenderError> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(RenderError::NotFinite {
            what,
            index: 0,
            value,
        }),
        None => Ok(()),
    }
}

/// The positions that triangles use; out-of-range indices are passed over, `render` reports them.
fn corners<'a>(surface: Triangles<'a>) -> impl Iterator<Item = DVec3> + 'a {
    let corner = |&v: &u32| {
        surface
            .positions
            .get(v as usize)
            .map(|&p| DVec3::from_array(p))
    };
    surface.triangles.iter().flatten().filter_map(corner)
}

/// A sphere around the middle of the bounding box that holds every triangle.
fn bounding_sphere(surface: Triangles<'_>) -> Result<(DVec3, f64), RenderError> {
    let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
    for (index, p) in corners(surface).enumerate() {
        if !p.is_finite() {
            let value = p
                .to_array()
                .into_iter()
                .find(|x| !x.is_finite())
                .unwrap_or(f64::NAN);
            return Err(RenderError::NotFinite {
                what: "the corner of triangle",
                index: index / 3,
                value,
            });
        }
        (low, high) = (low.min(p), high.max(p));
    }
    if low.x > high.x {
        return Err(RenderError::Empty);
    }
    let centre = low * 0.5 + high * 0.5;
    let radius = corners(surface)
        .map(|p| p.distance(centre))
        .fold(0.0, f64::max);
    // A single point still needs a picture around it.
    Ok((centre, if radius > 0.0 { radius } else { 1.0 }))
}
