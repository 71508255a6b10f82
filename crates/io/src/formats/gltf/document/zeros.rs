//! How many zeros a document claims: accessors without a buffer view are zeros, as many as they say, and a few bytes could claim
//! any number of them.

use super::extensions::{DRACO, INSTANCING};
use super::json::At;
use super::source::Source;
use crate::flaw::{Flaw, Result};

/// Elements at most of accessors without a view, over all that name them: positions, indices and instances, which nothing else gives a
/// number.
const MOST: usize = 1 << 22;

/// Elements at most of other attributes, and of what morph targets add, which are as many as there are positions: sparse ones often begin with
/// zeros.
const MOST_ATTRIBUTES: usize = 1 << 23;

/// Elements that are zeros.
#[derive(Default)]
struct Zeros {
    alone: usize,
    attributes: usize,
}

impl Source {
    /// Refuses a document that claims more zeros than any needs.
    pub(crate) fn check_zeros(&self) -> Result<()> {
        let check = || {
            let Zeros { alone, attributes } = self.zeros()?;
            for (count, most, what) in [
                (alone, MOST, "positions, indices and instances"),
                (attributes, MOST_ATTRIBUTES, "attributes of vertices"),
            ] {
                if count > most {
                    let met = format!(
                        "{count} {what} in accessors without a buffer view, over all that name them"
                    );
                    return Err(Flaw::new("accessors", met, format!("at most {most}")));
                }
            }
            Ok(())
        };
        self.zeros_are_few.get_or_init(check).clone()
    }

    /// Adds the elements of an accessor that has no view.
    fn add_zeros(&self, sum: &mut usize, at: &At<'_>) -> Result<()> {
        let accessor = at.item_of(&self.root(), "accessors")?;
        if accessor.get("bufferView").is_none() {
            *sum = sum.saturating_add(accessor.require("count")?.count()?);
        }
        Ok(())
    }

    fn zeros(&self) -> Result<Zeros> {
        let root = self.root();
        let mut zeros = Zeros::default();
        for mesh in root.list("meshes")? {
            for primitive in mesh.list("primitives")? {
                // What is in a compressed stream has no view of its own, and is no zeros.
                let compressed = primitive.path(&["extensions", DRACO, "attributes"]);
                if let Some(indices) = primitive.get("indices").filter(|_| compressed.is_none()) {
                    self.add_zeros(&mut zeros.alone, &indices)?;
                }
                for (name, at) in primitive.require("attributes")?.members()? {
                    let is_alone = name == "POSITION";
                    let sum = if is_alone {
                        &mut zeros.alone
                    } else {
                        &mut zeros.attributes
                    };
                    if compressed.as_ref().and_then(|own| own.get(name)).is_none() {
                        self.add_zeros(sum, &at)?;
                    }
                }
                for target in primitive.list("targets")? {
                    for (_, at) in target.members()? {
                        self.add_zeros(&mut zeros.attributes, &at)?;
                    }
                }
            }
        }
        for node in root.list("nodes")? {
            if let Some(instances) = node.path(&["extensions", INSTANCING, "attributes"]) {
                for (_, at) in instances.members()? {
                    self.add_zeros(&mut zeros.alone, &at)?;
                }
            }
        }
        Ok(zeros)
    }
}
