//! The goals of exact refinement, combined to one ratio for a triangle and its piece of the
//! surface.

use super::{Backs, CriterionError, Distance, LimitNormal, Pixels, Region, Viewpoint, cone};
use crate::vector::DVec3;

/// How far a triangle and its piece of the surface can be from each other. Both ways every point has one of the other within
/// [`Self::own`] of it, in any direction; and one within [`Self::height`] along normals and [`Self::across`] in any
/// direction. The normals are those of the triangle and its neighbours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Apart {
    pub(crate) own: f64,
    pub(crate) height: f64,
    pub(crate) across: f64,
}

impl Apart {
    /// The lesser distance.
    pub(crate) fn least(&self) -> f64 {
        self.own.min(self.height + self.across)
    }
}

/// The uncertain part of a piece facing away from a viewer may be as near to a corner as this part
/// of its triangle's radius.
const VIEW_REST: f64 = 1.0 / 64.0;

/// The criteria that are to be met together; without any, ratios are plain distances.
#[derive(Clone, Debug, Default)]
pub(crate) struct Criteria {
    distance: Option<Distance>,
    cone: Option<LimitNormal>,
    pixels: Option<Pixels>,
    /// The greatest rounding error of a distance.
    rounding: f64,
}

impl Criteria {
    /// # Errors
    /// A view that shows nothing.
    pub(crate) fn new(
        distance: Option<Distance>,
        cone: Option<LimitNormal>,
        pixels: Option<Pixels>,
        rounding: f64,
    ) -> Result<Self, CriterionError> {
        cone.and_then(|cone| cone.view)
            .map_or(Ok(()), |view| view.check())?;
        Ok(Self {
            distance,
            cone,
            pixels,
            rounding,
        })
    }

    /// Whether there is any goal.
    pub(crate) fn is_some(&self) -> bool {
        self.distance.is_some() || self.cone.is_some() || self.pixels.is_some()
    }

    /// Whether distances matter.
    pub(crate) fn has_distances(&self) -> bool {
        self.distance.is_some() || self.pixels.is_some() || !self.is_some()
    }

    /// Whether angles matter.
    pub(crate) fn has_cones(&self) -> bool {
        self.cone.is_some()
    }

    /// Levels below the control faces at which triangles that fail by the cone alone are given up.
    pub(crate) fn deepest_cone(&self) -> usize {
        self.cone.map_or(usize::MAX, |cone| cone.deepest())
    }

    /// The number of viewers from which a surface may face away: the cameras, then the viewer of
    /// angles.
    pub(crate) fn viewers(&self) -> usize {
        let view = self.cone.and_then(|cone| cone.view);
        self.pixels.as_ref().map_or(0, Pixels::viewers) + usize::from(view.is_some())
    }

    /// The viewers that see only the back of a triangle and its piece in a region. For one of the
    /// [viewers](Self::viewers) by number `is_back` gives the distance from the triangle's corners
    /// of the uncertain part, if that is hardly more than the given length.
    pub(crate) fn backs(
        &self,
        region: &Region,
        mut is_back: impl FnMut(usize, &Viewpoint, f64) -> Option<f64>,
    ) -> Backs {
        let cameras = self.pixels.as_ref();
        let mut backs = cameras.map_or(Backs::nobodys(), |pixels| {
            pixels.backs(region, &mut is_back)
        });
        if let Some(view) = self.cone.and_then(|cone| cone.view) {
            let viewer = cameras.map_or(0, Pixels::viewers);
            backs.view = is_back(viewer, &view.viewpoint, VIEW_REST * region.radius).is_some();
        }
        backs
    }

    /// The distance, in whatever direction, that is certainly good enough anywhere in a ball.
    pub(crate) fn allowed_length(&self, region: &Region, backs: &Backs) -> f64 {
        let plain = match &self.distance {
            Some(distance) => distance.allowed(),
            None if self.is_some() => f64::INFINITY,
            None => 1.0,
        };
        let allowed = |pixels: &Pixels| pixels.allowed_length(region.centre, region.radius, backs);
        plain.min(self.pixels.as_ref().map_or(f64::INFINITY, allowed))
    }

    /// How many times over a distance fails. The region holds the triangle and its piece of the surface; its cone the
    /// normals of both and of the neighbouring triangles.
    pub(crate) fn distance_ratio(&self, apart: &Apart, region: &Region, backs: &Backs) -> f64 {
        let plain = match &self.distance {
            Some(distance) => apart.least() / distance.allowed(),
            None if self.is_some() => 0.0,
            None => apart.least(),
        };
        let Some(pixels) = &self.pixels else {
            return plain;
        };
        let allowed = pixels.allowed(region, backs);
        let own = (apart.own + self.rounding) / allowed.length;
        let among = apart.height / allowed.height + (apart.across + self.rounding) / allowed.length;
        plain.max(own.min(among)).max(pixels.rest_ratio(backs))
    }

    /// Whether there are cameras and none sees more of a region than its back.
    pub(crate) fn is_unseen(&self, region: &Region, backs: &Backs) -> bool {
        let allowed = |pixels: &Pixels| pixels.allowed_length(region.centre, region.radius, backs);
        self.pixels
            .as_ref()
            .is_some_and(|pixels| allowed(pixels) == f64::INFINITY)
    }

    /// The greatest number of pixels of a distance; `None` without cameras.
    pub(crate) fn pixels(&self, apart: &Apart, region: &Region, backs: &Backs) -> Option<f64> {
        let pixels = self.pixels.as_ref()?;
        let own = pixels.seen(region, (0.0, apart.own + self.rounding), backs);
        Some(own.min(pixels.seen(region, (apart.height, apart.across + self.rounding), backs)))
    }

    /// How many times over a triangle's normal leaves the cones around the limit normals of its corners (the paper's
    /// equations 2 and 11). The region holds the triangle, its cone both.
    pub(crate) fn cone_ratio(
        &self,
        normal: DVec3,
        corners: [DVec3; 3],
        region: &Region,
        backs: &Backs,
    ) -> f64 {
        match self.cone {
            Some(goal) if !backs.view => cone::ratio(normal, corners, goal.allowed_angle(region)),
            _ => 0.0,
        }
    }
}
