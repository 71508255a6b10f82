//! The table of a scheme's limit stencils by ring shape, built when first asked for.

use core::fmt;
use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock};

use super::neighbourhood::Neighbourhood;
use super::stencil::LimitStencil;
use super::{LimitError, closed, open};
use crate::ring::RingShape;
use crate::scheme::Scheme;

/// Limit stencils of one scheme, by the shape of the ring; may be shared between threads.
pub struct LimitTable<'s> {
    scheme: &'s dyn Scheme,
    stencils: RwLock<HashMap<RingShape, Result<Arc<LimitStencil>, LimitError>>>,
}

impl fmt::Debug for LimitTable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LimitTable").field("scheme", &self.scheme.name()).finish_non_exhaustive()
    }
}

impl<'s> LimitTable<'s> {
    /// An empty table for `scheme`; stencils are built when first asked for.
    pub fn new(scheme: &'s dyn Scheme) -> Self {
        Self { scheme, stencils: RwLock::default() }
    }

    /// The scheme.
    pub fn scheme(&self) -> &'s dyn Scheme {
        self.scheme
    }

    /// The limit stencil of a ring.
    ///
    /// # Errors
    /// The ring has fewer than two edges, or the scheme's masks break its contract there.
    pub fn stencil(&self, shape: RingShape) -> Result<Arc<LimitStencil>, LimitError> {
        if let Some(known) = self.stencils.read().unwrap_or_else(PoisonError::into_inner).get(&shape) {
            return known.clone();
        }
        let built = analyse(self.scheme, shape).map(Arc::new);
        let mut stencils = self.stencils.write().unwrap_or_else(PoisonError::into_inner);
        stencils.entry(shape).or_insert(built).clone()
    }
}

fn analyse(scheme: &dyn Scheme, shape: RingShape) -> Result<LimitStencil, LimitError> {
    let neighbourhood = Neighbourhood::new(scheme, shape)?;
    if shape.open { open::analyse(&neighbourhood) } else { closed::analyse(&neighbourhood) }
}
