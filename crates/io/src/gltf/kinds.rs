//! Kinds of vertices: those of one kind stand and move together.
//!
//! A kind is a number for all that a vertex has in common with others of its kind: position, displacements of all morph targets, joints
//! with weights above 0. Each is the same to the bit, or with a distance, numbers that differ by rounding are: then positions and
//! displacements are one along chains of vertices within the distance, and weights within its share of the mesh's diagonal, which is about
//! what they make of a vertex's place. Numbers are given step by step, for pairs of the kind so far and what is looked at next, so that no
//! more than that is held of a vertex with many targets.

use super::flaw::{GltfFlaw, Result};
use super::parts::Joining;
use super::primitive::Primitive;
use foldhash::fast::RandomState;
use limitmesh::mesh::weld_within;
use std::collections::HashMap;
use std::hash::Hash;

/// By primitive and vertex, kinds that are the same in all primitives.
pub(super) type Numbers = Vec<Vec<u32>>;

/// The kinds of a mesh's vertices.
pub(super) struct Kinds {
    /// Of what counts.
    pub(super) all: Numbers,
    /// Of positions alone.
    pub(super) places: Numbers,
    /// Of all that counts but joints, and but displacements.
    pub(super) without_skins: Numbers,
    pub(super) without_morphs: Numbers,
}

impl Kinds {
    /// If vertices never become one, each is a kind of its own.
    ///
    /// # Errors
    /// The distance of `joining` is not a finite number of at least 0.
    pub(super) fn of(primitives: &[Primitive], joining: Joining) -> Result<Self> {
        let (skins_count, morphs_count, distance) = match joining {
            Joining::Never => return Ok(Self::apart(primitives)),
            Joining::Together => (true, true, 0.0),
            Joining::Ignoring {
                skins,
                morphs,
                distance,
            } => (!skins, !morphs, distance),
        };
        if !(distance >= 0.0 && distance.is_finite()) {
            let expected = "a finite number of at least 0";
            return Err(GltfFlaw::new(
                "the joining of vertices",
                format!("a distance of {distance}"),
                expected,
            ));
        }
        let nothing: Numbers = primitives
            .iter()
            .map(|primitive| vec![0; primitive.positions.len()])
            .collect();
        let places = alike(&nothing, distance, |part, v| primitives[part].positions[v])?;
        let with_morphs = |kinds: &Numbers| -> Result<Numbers> {
            let count = primitives
                .iter()
                .map(|primitive| primitive.targets.len())
                .max()
                .unwrap_or(0);
            (0..count).try_fold(kinds.clone(), |kinds, target| {
                alike(&kinds, distance, |part, v| {
                    let target = primitives[part].targets.get(target);
                    target
                        .and_then(|target| target.displacements.get(v))
                        .copied()
                        .unwrap_or_default()
                })
            })
        };
        let with_skins = |kinds: &Numbers| joints_alike(kinds, primitives, distance);
        let is_skinned = skins_count
            && primitives
                .iter()
                .any(|primitive| !primitive.influences.is_empty());
        let without_skins = if morphs_count {
            with_morphs(&places)?
        } else {
            places.clone()
        };
        let without_morphs = if is_skinned {
            with_skins(&places)?
        } else {
            places.clone()
        };
        let all = if is_skinned {
            with_skins(&without_skins)?
        } else {
            without_skins.clone()
        };
        Ok(Self {
            all,
            places,
            without_skins,
            without_morphs,
        })
    }

    /// Each vertex of a kind of its own.
    fn apart(primitives: &[Primitive]) -> Self {
        let mut numbers = 0..;
        let own =
            |primitive: &Primitive| numbers.by_ref().take(primitive.positions.len()).collect();
        let all: Numbers = primitives.iter().map(own).collect();
        Self {
            places: all.clone(),
            without_skins: all.clone(),
            without_morphs: all.clone(),
            all,
        }
    }

    /// Tells vertices apart that have different numbers here.
    pub(super) fn tell_apart(&mut self, by: &Numbers) {
        let Self {
            all,
            places,
            without_skins,
            without_morphs,
        } = self;
        for kinds in [all, places, without_skins, without_morphs] {
            *kinds = told_apart(kinds, |part, v| by[part][v]);
        }
    }
}

/// Kinds of vertices that are of one kind, and whose points are the same within a distance.
fn alike(
    kinds: &Numbers,
    distance: f64,
    point: impl Fn(usize, usize) -> [f64; 3],
) -> Result<Numbers> {
    if distance == 0.0 {
        return Ok(told_apart(kinds, |part, v| point(part, v).map(bits)));
    }
    let of_part = |(part, kinds): (usize, &Vec<u32>)| -> Vec<(u32, usize, usize)> {
        kinds
            .iter()
            .enumerate()
            .map(|(v, &kind)| (kind, part, v))
            .collect()
    };
    let mut vertices: Vec<(u32, usize, usize)> =
        kinds.iter().enumerate().flat_map(of_part).collect();
    vertices.sort_unstable();
    let mut nearby: Numbers = kinds.iter().map(|kinds| vec![0; kinds.len()]).collect();
    for run in vertices.chunk_by(|a, b| a.0 == b.0) {
        let points: Vec<[f64; 3]> = run.iter().map(|&(_, part, v)| point(part, v)).collect();
        let first = weld_within(&points, distance)
            .map_err(|error| GltfFlaw::new("a mesh", error.to_string(), "finite coordinates"))?;
        for (&(_, part, v), first) in run.iter().zip(first) {
            nearby[part][v] = first;
        }
    }
    Ok(told_apart(kinds, |part, v| nearby[part][v]))
}

/// Kinds of vertices that are of one kind and are moved by the same joints, with weights that are the same within a distance's share of the
/// diagonal.
fn joints_alike(kinds: &Numbers, primitives: &[Primitive], distance: f64) -> Result<Numbers> {
    let influences =
        |part: usize, v: usize| primitives[part].influences.get(v).into_iter().flatten();
    if distance == 0.0 {
        return Ok(told_apart(kinds, |part, v| {
            influences(part, v)
                .map(|&(joint, weight)| (joint, bits(weight)))
                .collect::<Vec<_>>()
        }));
    }
    let all = primitives.iter().flat_map(|primitive| &primitive.positions);
    let [low, high] = all.fold(
        [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]],
        |[low, high], p| {
            [
                std::array::from_fn(|i| low[i].min(p[i])),
                std::array::from_fn(|i| high[i].max(p[i])),
            ]
        },
    );
    let diagonal = (0..3)
        .map(|i| (high[i] - low[i]).powi(2))
        .sum::<f64>()
        .sqrt();
    let share = if diagonal > 0.0 {
        distance / diagonal
    } else {
        0.0
    };
    let joints = told_apart(kinds, |part, v| {
        influences(part, v)
            .map(|&(joint, _)| joint)
            .collect::<Vec<_>>()
    });
    let most = primitives
        .iter()
        .flat_map(|primitive| &primitive.influences)
        .map(Vec::len)
        .max()
        .unwrap_or(0);
    // Three weights at a time are a point.
    (0..most).step_by(3).try_fold(joints, |kinds, start| {
        alike(&kinds, share, |part, v| {
            let mut weights = influences(part, v).skip(start).map(|&(_, weight)| weight);
            std::array::from_fn(|_| weights.next().unwrap_or(0.0))
        })
    })
}

/// Kinds of vertices that are of one kind and have something more in common.
fn told_apart<K: Eq + Hash>(kinds: &Numbers, key: impl Fn(usize, usize) -> K) -> Numbers {
    // Numbers go by who comes first, so that the hash does not show; its seed differs from run to run, as that of the standard one.
    let mut known = HashMap::with_hasher(RandomState::default());
    let mut number = |kind: u32, key: K| {
        let next = known.len() as u32;
        *known.entry((kind, key)).or_insert(next)
    };
    let parts = kinds.iter().enumerate().map(|(part, kinds)| {
        kinds
            .iter()
            .enumerate()
            .map(|(v, &kind)| number(kind, key(part, v)))
            .collect()
    });
    parts.collect()
}

/// −0.0 is 0.0.
fn bits(x: f64) -> u64 {
    (x + 0.0).to_bits()
}
