//! Kinds of vertices: those of one kind stand and move together.
//!
//! A kind is a number for all that a vertex has in common with others of its kind: position, displacements of all morph targets, joints
//! with weights above 0, each to the bit. Numbers are given step by step, for pairs of the kind so far and what is looked at next, so
//! that no more than that is held of a vertex with many targets.

use super::parts::Joining;
use super::primitive::Primitive;
use foldhash::fast::RandomState;
use std::collections::HashMap;
use std::hash::Hash;

/// By primitive and vertex, kinds that are the same in all primitives.
type Numbers = Vec<Vec<u32>>;

/// The kinds of a mesh's vertices.
pub(super) struct Kinds {
    /// Of what counts.
    all: Numbers,
    /// Of positions alone.
    pub(super) places: Numbers,
    /// Of all that counts but joints, and but displacements.
    pub(super) without_skins: Numbers,
    pub(super) without_morphs: Numbers,
}

impl Kinds {
    /// If vertices never become one, each is a kind of its own.
    pub(super) fn of(primitives: &[Primitive], joining: Joining) -> Self {
        let (skins_count, morphs_count) = match joining {
            Joining::Never => {
                let own = |primitive: &Primitive| (0..primitive.positions.len() as u32).collect();
                let all: Numbers = primitives.iter().map(own).collect();
                let (places, without_skins, without_morphs) = Default::default();
                return Self { all, places, without_skins, without_morphs };
            }
            Joining::Together => (true, true),
            Joining::Ignoring { skins, morphs } => (!skins, !morphs),
        };
        let nothing: Numbers =
            primitives.iter().map(|primitive| vec![0; primitive.positions.len()]).collect();
        let places = told_apart(&nothing, |part, v| primitives[part].positions[v].map(bits));
        let with_skins = |kinds: &Numbers| {
            told_apart(kinds, |part, v| {
                let list = primitives[part].influences.get(v).into_iter().flatten();
                list.map(|&(joint, weight)| (joint, bits(weight))).collect::<Vec<_>>()
            })
        };
        let with_morphs = |kinds: &Numbers| {
            let count = primitives.iter().map(|primitive| primitive.targets.len()).max().unwrap_or(0);
            (0..count).fold(kinds.clone(), |kinds, target| {
                told_apart(&kinds, |part, v| {
                    let target = primitives[part].targets.get(target);
                    let moved = target.and_then(|target| target.displacements.get(v));
                    moved.copied().unwrap_or_default().map(bits)
                })
            })
        };
        let is_skinned = skins_count && primitives.iter().any(|primitive| !primitive.influences.is_empty());
        let without_skins = if morphs_count { with_morphs(&places) } else { places.clone() };
        let without_morphs = if is_skinned { with_skins(&places) } else { places.clone() };
        let all = if is_skinned { with_skins(&without_skins) } else { without_skins.clone() };
        Self { all, places, without_skins, without_morphs }
    }

    /// The kinds of what counts.
    pub(super) fn all(&self) -> &[Vec<u32>] {
        &self.all
    }
}

/// Kinds of vertices that are of one kind and have something more in common.
fn told_apart<K: Eq + Hash>(kinds: &Numbers, key: impl Fn(usize, usize) -> K) -> Numbers {
    // Numbers go by who comes first, so that the hash does not show; its seed differs from run to run, as that of the standard one.
    let mut known = HashMap::with_hasher(RandomState::default());
    let mut number = |kind: u32, key: K| {
        let next = known.len() as u32;
        *known.entry((kind, key)).or_insert(next)
    };
    let parts = kinds
        .iter()
        .enumerate()
        .map(|(part, kinds)| kinds.iter().enumerate().map(|(v, &kind)| number(kind, key(part, v))).collect());
    parts.collect()
}

/// −0.0 is 0.0.
fn bits(x: f64) -> u64 {
    (x + 0.0).to_bits()
}
