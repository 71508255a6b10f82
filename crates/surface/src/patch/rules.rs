//! The rules of a scheme as pieces of a surface need them: the weights and characteristic maps of the Loop family for
//! those that say they are of it, limit stencils for all.

use std::sync::{Arc, OnceLock};

use super::characteristic::Characteristic;
use super::mesh_form::Forms;
use super::settling;
use crate::catmull_clark::form::QuadForms;
use crate::limit::{LimitError, LimitTable};
use crate::scheme::{Family, Scheme};

/// Valences whose weights are kept.
const KEPT: usize = 32;

/// A scheme, and its weights if it is of the Loop family.
pub struct Rules<'s> {
    scheme: &'s dyn Scheme,
    family: Option<Family>,
    betas: [f64; KEPT],
    found: Arc<Found<'s>>,
    /// The first error.
    failure: OnceLock<LimitError>,
}

/// Values that take long to find, and depend on nothing but the scheme.
struct Found<'s> {
    forms: Forms<'s>,
    quad_forms: QuadForms,
    characteristics: [OnceLock<Characteristic>; KEPT],
    settling: [OnceLock<Option<f64>>; KEPT],
}

impl<'s> Rules<'s> {
    /// The rules of `scheme`; those of the family's member if it says that it is one, whatever its own masks are.
    pub fn of(scheme: &'s dyn Scheme) -> Self {
        let family = scheme.family();
        let scheme = match family {
            Some(family) => family.scheme(),
            None => scheme,
        };
        let kept = |k| match family {
            Some(Family::Loop(family)) if k >= 2 => family.beta(k as u32),
            _ => 0.0,
        };
        Self {
            scheme,
            family,
            betas: core::array::from_fn(kept),
            found: Arc::new(Found {
                forms: Forms::of(scheme),
                quad_forms: QuadForms::default(),
                characteristics: [const { OnceLock::new() }; KEPT],
                settling: [const { OnceLock::new() }; KEPT],
            }),
            failure: OnceLock::new(),
        }
    }

    /// Rules for another surface of the scheme: both share what is found, and each has its own failures.
    pub(crate) fn sharing(&self) -> Self {
        let Self {
            scheme,
            family,
            betas,
            ..
        } = *self;
        Self {
            scheme,
            family,
            betas,
            found: Arc::clone(&self.found),
            failure: OnceLock::new(),
        }
    }

    /// The scheme whose masks count.
    pub fn scheme(&self) -> &'s dyn Scheme {
        self.scheme
    }

    /// The scheme's limit stencils.
    pub fn table(&self) -> &LimitTable<'s> {
        self.found.forms.table()
    }

    /// The forms of pieces, for schemes outside the Loop family.
    pub(super) fn forms(&self) -> &Forms<'s> {
        &self.found.forms
    }

    /// The forms of pieces over quads.
    pub(crate) fn quad_forms(&self) -> &QuadForms {
        &self.found.quad_forms
    }

    /// Whether the scheme is a known one: pieces have forms of their own, and bounds hold.
    #[inline]
    pub fn is_certified(&self) -> bool {
        self.family.is_some()
    }

    /// Whether the scheme is of the Loop family: regular pieces are quartic polynomials over triangles.
    #[inline]
    pub fn are_of_loop_family(&self) -> bool {
        matches!(self.family, Some(Family::Loop(_)))
    }

    /// Keeps a failure, for whoever looks at results: what is computed after it means nothing.
    #[cold]
    pub(crate) fn fail(&self, why: LimitError) {
        // The first counts.
        let _ = self.failure.set(why);
    }

    /// The failure, if there was one.
    pub fn failure(&self) -> Option<&LimitError> {
        self.failure.get()
    }

    /// The weight of each neighbour of a smooth vertex; 0 outside the Loop family, where it is not used.
    #[inline]
    pub fn beta(&self, valence: usize) -> f64 {
        match (self.betas.get(valence), self.family) {
            (Some(&beta), _) => beta,
            (None, Some(Family::Loop(family))) => family.beta(valence as u32),
            (None, _) => 0.0,
        }
    }
}

impl Rules<'_> {
    /// The characteristic map of a valence; `None` for those that are not kept.
    pub fn characteristic(&self, valence: usize) -> Option<&Characteristic> {
        let kept = self
            .found
            .characteristics
            .get(valence)
            .filter(|_| valence >= 3)?;
        Some(kept.get_or_init(|| Characteristic::of(valence)))
    }

    /// How much differences from the characteristic map of a valence can grow ([`settling::growth`]); `None` where that is not known.
    pub(crate) fn settling(&self, valence: usize) -> Option<f64> {
        let map = self.characteristic(valence)?;
        *self
            .found
            .settling
            .get(valence)?
            .get_or_init(|| settling::growth(map, self.beta(valence)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::{Loop, LoopWarren, ModifiedButterfly};

    #[test]
    fn the_family_is_declared() {
        let (rules, warren) = (Rules::of(&Loop), Rules::of(&LoopWarren));
        assert!(rules.is_certified() && rules.beta(6) == 0.0625 && rules.beta(100) > 0.0);
        assert!(warren.is_certified() && warren.beta(3) == 0.1875);
        assert!(!Rules::of(&ModifiedButterfly).is_certified());
    }
}
