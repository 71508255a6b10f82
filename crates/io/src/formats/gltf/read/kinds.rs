//! Kinds of vertices: those of one kind stand and move together.
//!
//! A kind is a number for all that a vertex has in common with others of its kind: position, displacements of all morph targets, joints
//! with weights above 0. Each is the same to the bit, or with a distance, numbers that differ by rounding are: then positions and
//! displacements are one along chains of vertices within the distance, and weights within its share of the mesh's diagonal, which is about
//! what they make of a vertex's place. Numbers are given step by step, for pairs of the kind so far and what is looked at next, so that no
//! more than that is held of a vertex with many targets.

use super::poses::target_count;
use super::primitive::{Local, Primitive};
use crate::affine::bounding_box;
use crate::flaw::{Flaw, Result};
use foldhash::fast::RandomState;
use limitmesh::math;
use limitmesh::mesh::weld_within;
use std::collections::HashMap;
use std::hash::Hash;

/// Which vertices of a mesh become one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Joining {
    /// Those that stand and move together: position, displacements of all morph targets, and joints with weights above 0 are the same.
    #[default]
    Together,
    /// Those that stand and move together but for what this says: the first of those that become one says where it stands and how it moves.
    Ignoring {
        /// Whether joints and weights are ignored.
        skins: bool,
        /// Whether displacements are ignored.
        morphs: bool,
        /// Differences of positions and of displacements up to this distance, in the mesh's coordinates and along chains, and of weights up to
        /// its share of the mesh's diagonal; 0 for none.
        distance: f64,
    },
    /// None: the indices alone connect triangles.
    Never,
}

/// By primitive and vertex, kinds that are the same in all primitives.
pub(super) type ByVertex = Vec<Vec<u32>>;

/// The kinds of a mesh's vertices.
pub(super) struct Kinds {
    /// Of what counts.
    pub(super) all: ByVertex,
    /// Of positions alone.
    pub(super) places: ByVertex,
    /// Of all that counts but joints, and but displacements.
    pub(super) without_skins: ByVertex,
    pub(super) without_morphs: ByVertex,
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
            let (met, expected) = (
                format!("a distance of {distance}"),
                "a finite number of at least 0",
            );
            return Err(Flaw::new("the joining of vertices", met, expected));
        }
        let mut is_skinned = primitives.iter();
        let is_skinned = is_skinned.any(|primitive| !primitive.influences.is_empty());
        let with_skins = |kinds: &ByVertex| match skins_count && is_skinned {
            true => joints_alike(kinds, primitives, distance),
            false => Ok(kinds.clone()),
        };
        let nothing = primitives.iter().map(|own| vec![0; own.positions.len()]);
        let nothing = nothing.collect();
        let position = |own: Local| primitives[own.part].positions[own.vertex as usize];
        let places = alike(&nothing, distance, position)?;
        let targets = if morphs_count {
            target_count(primitives)
        } else {
            0
        };
        let without_skins = (0..targets).try_fold(places.clone(), |kinds, target| {
            // Vertices that a target does not move have no displacement.
            let displacement = |own: Local| {
                let target = primitives[own.part].targets.get(target);
                let moved =
                    target.and_then(|own_target| own_target.displacements.get(own.vertex as usize));
                moved.copied().unwrap_or([0.0; 3])
            };
            alike(&kinds, distance, displacement)
        })?;
        let (all, without_morphs) = (with_skins(&without_skins)?, with_skins(&places)?);
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
        let all: ByVertex = primitives.iter().map(own).collect();
        let [places, without_skins, without_morphs] = [(); 3].map(|()| all.clone());
        Self {
            all,
            places,
            without_skins,
            without_morphs,
        }
    }

    /// Keeps vertices apart that have different numbers here.
    pub(super) fn divide(&mut self, by: &ByVertex) {
        let Self {
            all,
            places,
            without_skins,
            without_morphs,
        } = self;
        for kinds in [all, places, without_skins, without_morphs] {
            *kinds = divided(kinds, |own| by[own.part][own.vertex as usize]);
        }
    }
}

/// All vertices with their kinds.
fn vertices(kinds: &ByVertex) -> impl Iterator<Item = (u32, Local)> {
    kinds.iter().enumerate().flat_map(|(part, kinds)| {
        kinds
            .iter()
            .zip(0..)
            .map(move |(&kind, vertex)| (kind, Local { part, vertex }))
    })
}

/// Kinds of vertices that are of one kind, and whose points are the same within a distance.
fn alike(kinds: &ByVertex, distance: f64, point: impl Fn(Local) -> [f64; 3]) -> Result<ByVertex> {
    if distance == 0.0 {
        return Ok(divided(kinds, |own| point(own).map(bits)));
    }
    let mut vertices: Vec<(u32, Local)> = vertices(kinds).collect();
    vertices.sort_unstable();
    let mut nearby: ByVertex = kinds.iter().map(|kinds| vec![0; kinds.len()]).collect();
    for run in vertices.chunk_by(|a, b| a.0 == b.0) {
        let points: Vec<[f64; 3]> = run.iter().map(|&(_, own)| point(own)).collect();
        let first = weld_within(&points, distance);
        let first = first.map_err(|error| Flaw::new("a mesh", error, "finite coordinates"))?;
        for (&(_, own), first) in run.iter().zip(first) {
            nearby[own.part][own.vertex as usize] = first;
        }
    }
    Ok(divided(kinds, |own| nearby[own.part][own.vertex as usize]))
}

/// Kinds of vertices that are of one kind and are moved by the same joints, with weights that are the same within a distance's share of the
/// diagonal.
fn joints_alike(kinds: &ByVertex, primitives: &[Primitive], distance: f64) -> Result<ByVertex> {
    let influences = |own: Local| {
        let found = primitives[own.part].influences.get(own.vertex as usize);
        found.into_iter().flatten().copied()
    };
    if distance == 0.0 {
        let key = |own| influences(own).map(|(joint, weight)| (joint, bits(weight)));
        return Ok(divided(kinds, |own| key(own).collect::<Vec<_>>()));
    }
    let all = primitives.iter().flat_map(|primitive| &primitive.positions);
    let [low, high] = bounding_box(all.copied()).unwrap_or_default();
    let diagonal = (0..3).map(|i| math::powi(high[i] - low[i], 2)).sum::<f64>();
    let diagonal = diagonal.sqrt();
    let share = if diagonal > 0.0 {
        distance / diagonal
    } else {
        0.0
    };
    let joints = divided(kinds, |own| {
        influences(own).map(|own| own.0).collect::<Vec<_>>()
    });
    let lengths = primitives.iter().flat_map(|own| &own.influences);
    let lengths = lengths.map(Vec::len);
    // Three weights at a time are a point.
    (0..lengths.max().unwrap_or(0))
        .step_by(3)
        .try_fold(joints, |kinds, start| {
            alike(&kinds, share, |own| {
                let mut weights = influences(own).skip(start).map(|(_, weight)| weight);
                std::array::from_fn(|_| weights.next().unwrap_or(0.0))
            })
        })
}

/// Kinds of vertices that are of one kind and have something more in common.
fn divided<K: Eq + Hash>(kinds: &ByVertex, key: impl Fn(Local) -> K) -> ByVertex {
    // Numbers go by who comes first, so that the hash does not show; its seed differs from run to run, as that of the standard one.
    let mut known = HashMap::with_hasher(RandomState::default());
    let numbers = kinds.iter().map(|own| Vec::with_capacity(own.len()));
    let mut numbers: ByVertex = numbers.collect();
    for (kind, own) in vertices(kinds) {
        let next = known.len() as u32;
        numbers[own.part].push(*known.entry((kind, key(own))).or_insert(next));
    }
    numbers
}

/// −0.0 is 0.0.
fn bits(x: f64) -> u64 {
    (x + 0.0).to_bits()
}

/// The vertices of a primitive that differ, each with a number as its name.
#[derive(Clone)]
pub(super) struct Names {
    /// A vertex of the primitive for each.
    pub(super) vertices: Vec<u32>,
    /// The number of each vertex that a face uses; `u32::MAX` for others.
    pub(super) of_vertex: Vec<u32>,
}

impl Names {
    /// By the kinds of the primitive's vertices.
    pub(super) fn of(primitive: &Primitive, kinds: &[u32]) -> Self {
        let mut of_vertex = vec![u32::MAX; primitive.positions.len()];
        let mut vertices: Vec<u32> = Vec::new();
        let mut known = HashMap::new();
        for &v in primitive.faces.iter().flatten() {
            if of_vertex[v as usize] != u32::MAX {
                continue;
            }
            let next = vertices.len() as u32;
            let name = *known.entry(kinds[v as usize]).or_insert(next);
            if name == next {
                vertices.push(v);
            }
            of_vertex[v as usize] = name;
        }
        Self {
            vertices,
            of_vertex,
        }
    }
}
