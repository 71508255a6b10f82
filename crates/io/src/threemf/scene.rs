//! Where objects stand: the matrices by which the build has them, through components within components.

use super::flaw::{PackageFlaw, Result};
use super::model::{Model, Use};
use crate::affine::{Affine, product};

/// Objects that are met on the way through all items of a build, at most: components may use each other twice, over and over.
const MOST_USES: usize = 1_000_000;

/// Components within each other at most.
const DEEPEST: usize = 64;

/// An object: the model's number, and the object's there.
pub(super) type Place = (usize, usize);

/// Calls `visit` for each object that the build has, with its matrix.
pub(super) fn walk(
    models: &[Model],
    find: &dyn Fn(usize, &Use) -> Option<Place>,
    visit: &mut dyn FnMut(Place, &Affine),
) -> Result<()> {
    let mut walk = Walk {
        models,
        find,
        visit,
        uses: 0,
    };
    let Some(root) = models.first() else {
        return Ok(());
    };
    for item in &root.items {
        walk.step(0, item, &crate::affine::IDENTITY, 0)?;
    }
    Ok(())
}

struct Walk<'a> {
    models: &'a [Model],
    find: &'a dyn Fn(usize, &Use) -> Option<Place>,
    visit: &'a mut dyn FnMut(Place, &Affine),
    uses: usize,
}

impl Walk<'_> {
    /// An object that is used in a model which stands by `outer`.
    fn step(&mut self, model: usize, own: &Use, outer: &Affine, depth: usize) -> Result<()> {
        let flaw = |problem: String| {
            let name = self.models[model].name.as_str();
            PackageFlaw::new(name, problem).at(&self.models[model].text, own.at)
        };
        self.uses += 1;
        if self.uses > MOST_USES {
            return Err(flaw(format!(
                "with all components there are more than {MOST_USES} objects"
            )));
        }
        if depth > DEEPEST {
            let problem =
                format!("more than {DEEPEST} components are within each other, or one uses itself");
            return Err(flaw(problem));
        }
        let Some(place) = (self.find)(model, own) else {
            let part = own
                .part
                .as_ref()
                .map_or(String::new(), |part| format!(" of {part}"));
            return Err(flaw(format!("there is no object {}{part}", own.object)));
        };
        let here = product(outer, &own.transform);
        (self.visit)(place, &here);
        let models = self.models;
        for component in &models[place.0].objects[place.1].components {
            self.step(place.0, component, &here, depth + 1)?;
        }
        Ok(())
    }
}
