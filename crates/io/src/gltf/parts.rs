//! A mesh's primitives as one soup: vertices that are one are one, and those that move apart stay apart.
//!
//! Files split vertices at seams of texture coordinates and normals. Within a primitive vertices are one if they are of one kind
//! (`kinds`): position, displacements of all morph targets, and joints with weights above 0 are the same. Two primitives are
//! joined along edges that are open in both and run oppositely, which a solid of several materials has; where they merely
//! touch they are not.

use super::attributes::{self, CornerAttribute};
use super::backs::Backs;
use super::flaw::Result as Flawed;
use super::kinds::Kinds;
use super::poses::Poses;
use super::primitive::Primitive;
use limitmesh::PolygonSoup;
use limitmesh::mesh::{Channel, CornerTag};
use limitmesh::ring::INFINITELY_SHARP;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// Which vertices of a mesh become one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Joining {
    /// Those that stand and move together: position, displacements of all morph targets, and joints with weights above 0 are the same.
    #[default]
    Together,
    /// Those that stand and move together but for what this says: the first of those that become one says where it stands and how it moves.
    Ignoring {
        /// What skins do to them.
        skins: bool,
        /// What morph targets do to them.
        morphs: bool,
        /// Differences of positions and of displacements up to this distance, in the mesh's coordinates and along chains, and of weights up to
        /// its share of the mesh's diagonal; 0 for none.
        distance: f64,
    },
    /// None: the indices alone connect triangles.
    Never,
}

/// The triangles of a primitive in a mesh's soup.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Part {
    /// The primitive's number among the mesh's.
    pub primitive: usize,
    /// Its faces in the soup.
    pub faces: Range<usize>,
    /// The names of its attributes, in the document's order or another.
    pub attributes: Vec<String>,
    /// By morph target, the names of the attributes that it adds to.
    pub targets: Vec<Vec<String>>,
}

/// What was not made one, though it is at one place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct KeptApart {
    /// Because morph targets or joints move them differently.
    pub moving: usize,
    /// Those of them that would be one but for their joints and weights alone.
    pub by_skins: usize,
    /// Those of them that would be one but for morph targets alone.
    pub by_morphs: usize,
    /// Because they belong to primitives with no edge in common there.
    pub touching: usize,
    /// Triangles that are the back of others, with vertices of their own.
    pub backs: usize,
}

/// The triangles of a mesh.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct MeshSoup {
    /// Positions in the mesh's own coordinates and triangles; connected by its indices alone.
    pub soup: PolygonSoup,
    /// Which faces are which primitive's.
    pub parts: Vec<Part>,
    /// Texture coordinates, colours, what has a name of its own, and what morph targets add to these and to positions.
    pub attributes: Vec<CornerAttribute>,
    /// Normals of the corners as the document has them, of any length and zero where it has none: where they differ between two faces, the
    /// edge was meant to be sharp. They are found anew, so that nothing carries them.
    pub normals: Option<Channel>,
    /// What stayed apart at one place.
    pub kept_apart: KeptApart,
    /// Edges along which the primitives that were asked for meet others. Their ends are corners of the soup, so that they stay straight
    /// and the surface does not leave the triangles beside it.
    pub borders: usize,
    /// By vertex of the soup, the joints that move it with their weights above 0, by joint; empty without a skin.
    pub influences: Vec<Vec<(u32, f64)>>,
}

impl MeshSoup {
    /// Whether there are morph targets.
    pub fn has_targets(&self) -> bool {
        self.parts.iter().any(|part| !part.targets.is_empty())
    }
}

/// A vertex before primitives are joined: the primitive, and its number there among those that differ.
type Local = (usize, u32);

/// The primitives that `is_wanted` by their numbers; the others are looked at for what they share with these.
///
/// # Errors
/// As for [`Kinds::of`].
pub(super) fn join(
    mut primitives: Vec<Primitive>,
    joining: Joining,
    is_wanted: impl Fn(usize) -> bool,
) -> Flawed<MeshSoup> {
    let mut kinds = Kinds::of(&primitives, joining)?;
    let backs = Backs::of(&primitives, &kinds.all);
    if !backs.is_empty() {
        let sides = backs.split(&mut primitives);
        kinds = Kinds::of(&primitives, joining)?;
        kinds.tell_apart(&sides);
    }
    let primitives = &primitives[..];
    let names: Vec<Names> = primitives
        .iter()
        .zip(&kinds.all)
        .map(|(primitive, kinds)| Names::of(primitive, kinds))
        .collect();
    let mut first = Vec::with_capacity(names.len());
    let mut count = 0;
    for names in &names {
        first.push(count);
        count += names.vertices.len();
    }
    let number = |(part, v): Local| first[part] + v as usize;
    let mut roots: Vec<usize> = (0..count).collect();
    let is_wanted: Vec<bool> = primitives
        .iter()
        .map(|primitive| is_wanted(primitive.index))
        .collect();
    let mut ends = Vec::new();
    if joining != Joining::Never && names.len() > 1 {
        for (a, b) in shared_edges(primitives, &names, &kinds.all) {
            unite(&mut roots, number(a), number(b));
            if is_wanted[a.0] != is_wanted[b.0] {
                ends.push(number(a));
            }
        }
    }
    // Two ends an edge.
    let mut result = MeshSoup {
        borders: ends.len() / 2,
        ..MeshSoup::default()
    };
    let mut numbers = vec![u32::MAX; count];
    let poses = Poses::new(primitives);
    let is_skinned = primitives
        .iter()
        .any(|primitive| !primitive.influences.is_empty());
    for (part, (primitive, names)) in primitives.iter().zip(&names).enumerate() {
        if !is_wanted[part] {
            continue;
        }
        for (v, &vertex) in names.vertices.iter().enumerate() {
            let root = root(&mut roots, number((part, v as u32)));
            if numbers[root] == u32::MAX {
                numbers[root] = result.soup.positions.len() as u32;
                result
                    .soup
                    .positions
                    .push(primitive.positions[vertex as usize]);
                if is_skinned {
                    let list = primitive.influences.get(vertex as usize);
                    result.influences.push(list.cloned().unwrap_or_default());
                }
            }
        }
        let start = result.soup.faces.len();
        for &triangle in &primitive.triangles {
            if poses.opens(part, triangle) {
                result.soup.opening.push(result.soup.faces.len() as u32);
            }
            let corners = triangle.map(|v| {
                let local = (part, names.of_vertex[v as usize]);
                numbers[root(&mut roots, number(local))]
            });
            result.soup.faces.push(&corners);
        }
        result.parts.push(Part {
            primitive: primitive.index,
            faces: start..result.soup.faces.len(),
            attributes: primitive.names.clone(),
            targets: primitive
                .targets
                .iter()
                .map(|target| target.names.clone())
                .collect(),
        });
    }
    let mut ends: Vec<u32> = ends
        .into_iter()
        .map(|end| numbers[root(&mut roots, end)])
        .collect();
    ends.sort_unstable();
    ends.dedup();
    let corner = |vertex| CornerTag {
        vertex,
        sharpness: INFINITELY_SHARP,
    };
    result.soup.corners = ends.into_iter().map(corner).collect();
    let wanted: Vec<usize> = (0..primitives.len())
        .filter(|&part| is_wanted[part])
        .collect();
    result.normals = attributes::normals(primitives, &wanted);
    result.attributes = attributes::tables(primitives, &names, &wanted, |part, v| {
        numbers[root(&mut roots, number((part, v)))]
    });
    if joining != Joining::Never {
        result.kept_apart = kept_apart(&names, &kinds, &wanted, result.soup.positions.len());
    }
    result.kept_apart.backs = wanted.iter().map(|&part| backs.count(part)).sum();
    Ok(result)
}

/// The vertices of a primitive that differ.
pub(super) struct Names {
    /// A vertex of the primitive for each.
    vertices: Vec<u32>,
    /// The number of each vertex that a triangle uses; `u32::MAX` for others.
    pub(super) of_vertex: Vec<u32>,
}

impl Names {
    /// By the kinds of the primitive's vertices.
    fn of(primitive: &Primitive, kinds: &[u32]) -> Self {
        let mut of_vertex = vec![u32::MAX; primitive.positions.len()];
        let mut vertices: Vec<u32> = Vec::new();
        let mut known = HashMap::new();
        for &v in primitive.triangles.as_flattened() {
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

/// Pairs of vertices at both ends of edges that are open in two primitives, run oppositely, and in no third.
fn shared_edges(
    primitives: &[Primitive],
    names: &[Names],
    kinds: &[Vec<u32>],
) -> Vec<(Local, Local)> {
    // By the kinds of its ends from the lower to the higher: the primitives on each side.
    let mut sides: HashMap<[u32; 2], [Vec<(Local, Local)>; 2]> = HashMap::new();
    let mut order = Vec::new();
    for (part, (primitive, names)) in primitives.iter().zip(names).enumerate() {
        for [a, b] in open_edges(primitive, names) {
            let [from, to] = [a, b].map(|v| kinds[part][names.vertices[v as usize] as usize]);
            let edge = [from.min(to), from.max(to)];
            let entry = sides.entry(edge).or_insert_with(|| {
                order.push(edge);
                Default::default()
            });
            let ends = if from < to { (a, b) } else { (b, a) };
            entry[usize::from(from > to)].push(((part, ends.0), (part, ends.1)));
        }
    }
    let mut pairs = Vec::new();
    for edge in order {
        let Some([forward, backward]) = sides.get(&edge) else {
            continue;
        };
        if let ([one], [other]) = (&forward[..], &backward[..]) {
            pairs.extend([(one.0, other.0), (one.1, other.1)]);
        }
    }
    pairs
}

/// Edges of one triangle alone, the way it runs along them.
fn open_edges(primitive: &Primitive, names: &Names) -> Vec<[u32; 2]> {
    let mut uses: HashMap<[u32; 2], u32> = HashMap::new();
    let mut all = Vec::with_capacity(3 * primitive.triangles.len());
    for triangle in &primitive.triangles {
        let [a, b, c] = triangle.map(|v| names.of_vertex[v as usize]);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *uses.entry([from.min(to), from.max(to)]).or_default() += 1;
            all.push([from, to]);
        }
    }
    all.retain(|&[a, b]| a != b && uses.get(&[a.min(b), a.max(b)]) == Some(&1));
    all
}

fn kept_apart(names: &[Names], kinds: &Kinds, wanted: &[usize], vertices: usize) -> KeptApart {
    let mut apart = KeptApart::default();
    let (mut everywhere, mut distinct) = (HashSet::new(), 0);
    for &part in wanted {
        let names = &names[part];
        // How many vertices would be left by other kinds.
        let left = |kinds: &[Vec<u32>]| {
            let own = names.vertices.iter().map(|&v| kinds[part][v as usize]);
            own.collect::<HashSet<u32>>()
        };
        let own = left(&kinds.places);
        apart.moving += names.vertices.len() - own.len();
        apart.by_skins += names.vertices.len() - left(&kinds.without_skins).len();
        apart.by_morphs += names.vertices.len() - left(&kinds.without_morphs).len();
        distinct += own.len();
        everywhere.extend(own);
    }
    let joined = distinct + apart.moving - vertices;
    apart.touching = (distinct - everywhere.len()).saturating_sub(joined);
    apart
}

fn root(roots: &mut [usize], mut v: usize) -> usize {
    while roots[v] != v {
        roots[v] = roots[roots[v]];
        v = roots[v];
    }
    v
}

/// The lower of two roots stands for both.
fn unite(roots: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(roots, a), root(roots, b));
    roots[a.max(b)] = a.min(b);
}
