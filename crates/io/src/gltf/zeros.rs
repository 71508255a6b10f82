//! How many zeros a document claims: accessors without a buffer view are zeros, as many as they say, and a few bytes could claim
//! any number of them.

use super::flaw::{GltfFlaw, Result};
use super::json::At;
use super::primitive::DRACO;
use super::scene::INSTANCING;
use super::source::Source;

/// Elements at most of accessors without a view, over all that name them: positions, indices and instances, which nothing else gives a
/// number.
const MOST: usize = 1 << 22;

/// The same of other attributes, and of what morph targets add, which are as many as there are positions: sparse ones often begin with
/// zeros.
const MOST_BESIDE: usize = 1 << 23;

/// Elements that are zeros.
#[derive(Default)]
struct Zeros {
    alone: usize,
    beside: usize,
}

impl Source {
    /// Refuses a document that claims more zeros than any needs.
    pub(super) fn check_zeros(&self) -> Result<()> {
        self.zeros_are_few
            .get_or_init(|| {
                let zeros = self.zeros()?;
                let flaw = |count: usize, most: usize, what: &str| {
                    let met = format!(
                        "{count} {what} in accessors without a buffer view, over all that name them"
                    );
                    Err(GltfFlaw::new("accessors", met, format!("at most {most}")))
                };
                match zeros {
                    Zeros { alone, .. } if alone > MOST => {
                        flaw(alone, MOST, "positions, indices and instances")
                    }
                    Zeros { beside, .. } if beside > MOST_BESIDE => {
                        flaw(beside, MOST_BESIDE, "attributes of vertices")
                    }
                    _ => Ok(()),
                }
            })
            .clone()
    }

    fn zeros(&self) -> Result<Zeros> {
        let root = self.root();
        let count = |at: &At<'_>| -> Result<usize> {
            let (_, accessor) = at.item_of(&root, "accessors")?;
            match accessor.get("bufferView") {
                Some(_) => Ok(0),
                None => accessor.require("count")?.count(),
            }
        };
        let add = |sum: &mut usize, at: &At<'_>| -> Result<()> {
            *sum = sum.saturating_add(count(at)?);
            Ok(())
        };
        let mut zeros = Zeros::default();
        for mesh in root.list("meshes")? {
            for primitive in mesh.list("primitives")? {
                // What is in a compressed stream has no view of its own, and is no zeros.
                let compressed = primitive.path(&["extensions", DRACO, "attributes"]);
                if let Some(indices) = primitive.get("indices").filter(|_| compressed.is_none()) {
                    add(&mut zeros.alone, &indices)?;
                }
                let is_compressed = |name: &str| {
                    compressed
                        .as_ref()
                        .is_some_and(|own| own.get(name).is_some())
                };
                for (name, at) in primitive.require("attributes")?.members()? {
                    if !is_compressed(name) {
                        add(
                            if name == "POSITION" {
                                &mut zeros.alone
                            } else {
                                &mut zeros.beside
                            },
                            &at,
                        )?;
                    }
                }
                for target in primitive.list("targets")? {
                    for (_, at) in target.members()? {
                        add(&mut zeros.beside, &at)?;
                    }
                }
            }
        }
        for node in root.list("nodes")? {
            if let Some(instances) = node.path(&["extensions", INSTANCING, "attributes"]) {
                for (_, at) in instances.members()? {
                    add(&mut zeros.alone, &at)?;
                }
            }
        }
        Ok(zeros)
    }
}
