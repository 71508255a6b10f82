//! The table of a scheme's limit stencils by ring shape, built on first use.

use core::fmt;
use core::hash::Hash;
use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock};

use super::neighbourhood::Neighbourhood;
use super::sharp::{SharpKey, SharpStencil};
use super::stencil::LimitStencil;
use super::{LimitError, closed, dart, open};
use crate::ring::RingShape;
use crate::scheme::{Scheme, declared};

/// The stencils found so far, by ring.
type Known<K, S> = RwLock<HashMap<K, Result<Arc<S>, LimitError>>>;

/// Limit stencils of one scheme, by the shape of the ring; may be shared between threads.
pub struct LimitTable<'s> {
    scheme: &'s dyn Scheme,
    stencils: Known<RingShape, LimitStencil>,
    sharp: Known<SharpKey, SharpStencil>,
}

impl fmt::Debug for LimitTable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LimitTable")
            .field("scheme", &self.scheme.name())
            .finish_non_exhaustive()
    }
}

impl<'s> LimitTable<'s> {
    /// An empty table for `scheme`; stencils are built on first use.
    pub fn new(scheme: &'s dyn Scheme) -> Self {
        Self {
            scheme: declared(scheme),
            stencils: RwLock::default(),
            sharp: RwLock::default(),
        }
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
        known(&self.stencils, shape, || {
            analyse(self.scheme, shape).map(Arc::new)
        })
    }

    /// The stencil of a ring with sharp edges, built unless it is known.
    pub(super) fn known_sharp(
        &self,
        key: SharpKey,
        build: impl FnOnce() -> Result<Arc<SharpStencil>, LimitError>,
    ) -> Result<Arc<SharpStencil>, LimitError> {
        known(&self.sharp, key, build)
    }
}

/// The entry of a key, built if there is none.
fn known<K: Eq + Hash, S>(
    all: &Known<K, S>,
    key: K,
    build: impl FnOnce() -> Result<Arc<S>, LimitError>,
) -> Result<Arc<S>, LimitError> {
    if let Some(known) = all.read().unwrap_or_else(PoisonError::into_inner).get(&key) {
        return known.clone();
    }
    let built = build();
    all.write()
        .unwrap_or_else(PoisonError::into_inner)
        .entry(key)
        .or_insert(built)
        .clone()
}

fn analyse(scheme: &dyn Scheme, shape: RingShape) -> Result<LimitStencil, LimitError> {
    let neighbourhood = Neighbourhood::new(scheme, shape)?;
    match shape {
        RingShape { open: true, .. } => open::analyse(&neighbourhood),
        RingShape { dart: true, .. } => dart::analyse(&neighbourhood),
        _ => closed::analyse(&neighbourhood),
    }
}
