//! Where objects stand: the matrices by which the build has them, through components within components.

use super::model::{Model, Use};
use crate::affine::{Affine, IDENTITY, product};
use crate::flaw::{Flaw, Result};

/// Objects that are met on the way through all items of a build, at most: components may use each other twice, over and over.
const MOST_USES: usize = 1_000_000;

/// Components within each other at most.
const DEEPEST: usize = 64;

/// Where an object is: the numbers of its model, and of the object in it.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Address {
    pub(super) model: usize,
    pub(super) object: usize,
}

/// Calls `visit` for each object that the build has, with its matrix; `find` gives the object that is used in a model.
pub(super) fn walk(
    models: &[Model],
    find: &dyn Fn(usize, &Use) -> Option<Address>,
    visit: &mut dyn FnMut(Address, &Affine),
) -> Result<()> {
    let mut walk = Walk {
        models,
        find,
        visit,
        uses: 0,
    };
    let mut items = models.iter().take(1).flat_map(|root| &root.items);
    items.try_for_each(|item| walk.step(0, item, &IDENTITY, 0))
}

struct Walk<'a> {
    models: &'a [Model],
    find: &'a dyn Fn(usize, &Use) -> Option<Address>,
    visit: &'a mut dyn FnMut(Address, &Affine),
    uses: usize,
}

impl Walk<'_> {
    /// An object that is used in a model which stands by `outer`.
    fn step(&mut self, model: usize, own: &Use, outer: &Affine, depth: usize) -> Result<()> {
        let models = self.models;
        let flaw = |problem: String| {
            let Model { name, text, .. } = &models[model];
            Err(Flaw::saying(name.as_str(), problem).at(text, own.at))
        };
        self.uses += 1;
        if self.uses > MOST_USES {
            return flaw(format!(
                "with all components there are more than {MOST_USES} objects"
            ));
        }
        if depth > DEEPEST {
            return flaw(format!(
                "more than {DEEPEST} components are within each other, or one uses itself"
            ));
        }
        let Some(address) = (self.find)(model, own) else {
            let found = own.part.as_ref();
            let part = found.map_or(String::new(), |part| format!(" of {part}"));
            return flaw(format!("there is no object {}{part}", own.object));
        };
        let here = product(outer, &own.transform);
        (self.visit)(address, &here);
        let components = &models[address.model].objects[address.object].components;
        components
            .iter()
            .try_for_each(|own| self.step(address.model, own, &here, depth + 1))
    }
}
