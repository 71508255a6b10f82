//! What each control face came to. Most stay whole and pass whatever is beside them, so what only others have lies elsewhere: in a mesh of
//! many faces this is read and written more often than anything else.

use super::super::quadtree::Place;
use super::{Allowance, Condition, Extent};

/// What one face came to.
#[derive(Clone)]
pub(super) struct Found {
    /// That of its leaves, but for which is the worst.
    tilt: f64,
    slope: f64,
    drift_slope: f64,
    bound: f64,
    /// What its triangles count on.
    pub(super) allowance: Allowance,
    /// Of a face that is divided, fails or passes on conditions.
    more: Option<Box<More>>,
}

/// What there is to tell of a face that does not just stay whole.
#[derive(Clone)]
struct More {
    worst: Option<Place>,
    has_failed: bool,
    conditions: Vec<Condition>,
}

impl Found {
    /// That of a face of whose leaves nothing is known.
    pub(super) const NOTHING: Self = Self {
        tilt: Extent::NONE.tilt,
        slope: Extent::NONE.slope,
        drift_slope: Extent::NONE.drift_slope,
        bound: Extent::NONE.bound,
        allowance: Allowance::NOTHING,
        more: None,
    };

    pub(super) fn of(
        face: u32,
        extent: &Extent,
        allowance: Allowance,
        (has_failed, conditions): (bool, Vec<Condition>),
    ) -> Self {
        let Extent {
            tilt,
            slope,
            drift_slope,
            bound,
            worst,
        } = *extent;
        let is_plain = worst == worst_if_whole(face, bound) && !has_failed && conditions.is_empty();
        let more = (!is_plain).then(|| {
            Box::new(More {
                worst,
                has_failed,
                conditions,
            })
        });
        Self {
            tilt,
            slope,
            drift_slope,
            bound,
            allowance,
            more,
        }
    }

    /// What the leaves of the face come to.
    pub(super) fn extent(&self, face: u32) -> Extent {
        let Self {
            tilt,
            slope,
            drift_slope,
            bound,
            ..
        } = *self;
        let worst = self
            .more
            .as_ref()
            .map_or_else(|| worst_if_whole(face, bound), |more| more.worst);
        Extent {
            tilt,
            slope,
            drift_slope,
            bound,
            worst,
        }
    }

    /// The greatest bound of a leaf that passes.
    pub(super) fn bound(&self) -> f64 {
        self.bound
    }

    pub(super) fn has_failed(&self) -> bool {
        self.more.as_ref().is_some_and(|more| more.has_failed)
    }

    /// Leaves that pass on conditions, in the order of the tree.
    pub(super) fn conditions(&self) -> &[Condition] {
        self.more.as_ref().map_or(&[], |more| &more.conditions)
    }
}

/// The leaf with the greatest bound of a face that is not divided.
fn worst_if_whole(face: u32, bound: f64) -> Option<Place> {
    (bound > 0.0).then(|| Place::root(face))
}
