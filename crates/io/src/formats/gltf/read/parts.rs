//! A mesh's primitives as one soup: vertices that are one are one, and those that move apart stay apart.
//!
//! Files split vertices at seams of texture coordinates and normals. Within a primitive vertices are one if they are of one kind
//! (`kinds`): position, displacements of all morph targets, and joints with weights above 0 are the same. Two primitives are
//! joined along edges that are open in both and run oppositely, which a solid of several materials has; where they merely
//! touch they are not.

use super::attributes::{self, CornerAttribute};
use super::backs::Backs;
use super::disjoint::Disjoint;
use super::kinds::{Joining, Kinds, Names};
use super::poses::Poses;
use super::primitive::{Local, Primitive};
use crate::flaw::Result;
use limitmesh::PolygonSoup;
use limitmesh::mesh::{Channel, CornerTag};
use limitmesh::ring::INFINITELY_SHARP;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// The faces of a primitive in a mesh's soup.
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

/// Vertices that were not made one, though they are at one place.
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
    /// Faces that are the back of others, with vertices of their own.
    pub backs: usize,
}

/// The faces of a mesh.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct MeshSoup {
    /// Positions in the mesh's own coordinates and faces; connected by its indices alone.
    pub soup: PolygonSoup,
    /// Polygons of which there are the triangles instead: they have holes or vertices inside, or their triangles are no fan.
    pub as_triangles: usize,
    /// Which faces are which primitive's.
    pub parts: Vec<Part>,
    /// Texture coordinates, colours, what has a name of its own, and what morph targets add to these and to positions.
    pub attributes: Vec<CornerAttribute>,
    /// Normals of the corners as the document has them, of any length and zero where it has none: where they differ between two faces, the
    /// edge was meant to be sharp. They are found anew, so that nothing carries them.
    pub normals: Option<Channel>,
    /// Vertices that stayed apart at one place.
    pub kept_apart: KeptApart,
    /// Edges along which the primitives that were asked for meet others. Their ends are corners of the soup, so that they stay straight
    /// and the surface does not leave the adjacent triangles.
    pub borders: usize,
    /// By vertex of the soup, the joints that move it with their weights above 0, by joint; empty without a skin.
    pub influences: Vec<Vec<(u32, f64)>>,
}

/// The polygons of which there are the triangles instead, in words, if there are so many.
pub(crate) fn cut_polygons(count: usize) -> Option<String> {
    let words = "polygons with holes, with vertices inside or whose triangles are no fan, which are triangles instead";
    (count > 0).then(|| format!("{words} ({count})"))
}

impl MeshSoup {
    /// Polygons that are left out, in words, if some are.
    pub fn cut_polygons(&self) -> Option<String> {
        cut_polygons(self.as_triangles)
    }

    /// Whether there are morph targets.
    pub fn has_targets(&self) -> bool {
        self.parts.iter().any(|part| !part.targets.is_empty())
    }
}

/// The primitives that `is_wanted` by their numbers; the others are looked at for what they share with these.
///
/// # Errors
/// As for [`Kinds::of`].
pub(crate) fn join(
    mut primitives: Vec<Primitive>,
    joining: Joining,
    is_wanted: impl Fn(usize) -> bool,
) -> Result<MeshSoup> {
    let mut kinds = Kinds::of(&primitives, joining)?;
    let backs = Backs::of(&primitives, &kinds.all);
    if !backs.is_empty() {
        let sides = backs.split(&mut primitives);
        kinds = Kinds::of(&primitives, joining)?;
        kinds.divide(&sides);
    }
    let is_wanted = |part: &usize| is_wanted(primitives[*part].index);
    let wanted: Vec<usize> = (0..primitives.len()).filter(is_wanted).collect();
    let mut joiner = Joiner::new(&primitives, &kinds);
    let mut borders = Vec::new();
    if joining != Joining::Never && primitives.len() > 1 {
        borders = joiner.join_shared_edges(&wanted);
    }
    wanted.iter().for_each(|&part| joiner.add(part));
    joiner.mark_borders(&borders);
    let normals = attributes::normals(&primitives, &wanted);
    let names = joiner.names.clone();
    let vertex = |part, name| joiner.vertex(part, name);
    let attributes = attributes::tables(&primitives, &names, &wanted, vertex);
    let mut found = joiner.found;
    (found.normals, found.attributes) = (normals, attributes);
    if joining != Joining::Never {
        found.kept_apart = kept_apart(&names, &kinds, &wanted, found.soup.positions.len());
    }
    found.kept_apart.backs = wanted.iter().map(|&part| backs.count(part)).sum();
    Ok(found)
}

/// A mesh whose primitives are joined one by one.
struct Joiner<'a> {
    primitives: &'a [Primitive],
    kinds: &'a Kinds,
    names: Vec<Names>,
    /// By primitive, the number of its first name among all.
    first: Vec<u32>,
    /// Of these numbers, those that are one vertex.
    vertices: Disjoint,
    /// By the root of a set, the vertex of the soup; `u32::MAX` where there is none yet.
    of_root: Vec<u32>,
    found: MeshSoup,
}

impl<'a> Joiner<'a> {
    fn new(primitives: &'a [Primitive], kinds: &'a Kinds) -> Self {
        let names = primitives.iter().zip(&kinds.all);
        let names = names.map(|(own, kinds)| Names::of(own, kinds));
        let names: Vec<Names> = names.collect();
        let (mut first, mut count) = (Vec::with_capacity(names.len()), 0);
        for names in &names {
            first.push(count);
            count += names.vertices.len() as u32;
        }
        Self {
            primitives,
            kinds,
            names,
            first,
            vertices: Disjoint::new(count),
            of_root: vec![u32::MAX; count as usize],
            found: MeshSoup::default(),
        }
    }

    /// The vertex of the soup that a vertex with a name is; `u32::MAX` before any of its set was added.
    fn vertex(&mut self, part: usize, name: u32) -> u32 {
        self.of_root[self.vertices.root(self.first[part] + name) as usize]
    }

    /// Makes the ends of edges one that two primitives share; gives the ends of those that a wanted one shares with another.
    fn join_shared_edges(&mut self, wanted: &[usize]) -> Vec<Local> {
        let mut borders = Vec::new();
        for [a, b] in self.shared_ends() {
            let number = |own: Local| self.first[own.part] + own.vertex;
            self.vertices.unite(number(a), number(b));
            if wanted.contains(&a.part) != wanted.contains(&b.part) {
                borders.push(a);
            }
        }
        // Two ends an edge.
        self.found.borders = borders.len() / 2;
        borders
    }

    /// Adds a primitive to the soup.
    fn add(&mut self, part: usize) {
        let primitive = &self.primitives[part];
        let is_skinned = self.primitives.iter().any(|own| !own.influences.is_empty());
        for (v, name) in self.names[part].vertices.clone().into_iter().zip(0..) {
            let root = self.vertices.root(self.first[part] + name) as usize;
            if self.of_root[root] == u32::MAX {
                self.of_root[root] = self.found.soup.positions.len() as u32;
                self.found
                    .soup
                    .positions
                    .push(primitive.positions[v as usize]);
                if is_skinned {
                    // A primitive without a skin is moved by no joint.
                    let list = primitive.influences.get(v as usize);
                    self.found
                        .influences
                        .push(list.cloned().unwrap_or_default());
                }
            }
        }
        let start = self.found.soup.faces.len();
        let poses = Poses::new(self.primitives);
        let mut corners = Vec::new();
        for face in primitive.faces.iter() {
            if poses.opens(part, face) {
                let face = self.found.soup.faces.len() as u32;
                self.found.soup.opening.push(face);
            }
            corners.clear();
            for &v in face {
                let name = self.names[part].of_vertex[v as usize];
                corners.push(self.vertex(part, name));
            }
            self.found.soup.faces.push(&corners);
        }
        self.found.as_triangles += primitive.as_triangles;
        let targets = primitive.targets.iter().map(|target| target.names.clone());
        self.found.parts.push(Part {
            primitive: primitive.index,
            faces: start..self.found.soup.faces.len(),
            attributes: primitive.names.clone(),
            targets: targets.collect(),
        });
    }

    /// Makes corners of the ends of edges that the soup shares with what is not in it.
    fn mark_borders(&mut self, ends: &[Local]) {
        let all = ends.iter().map(|own| self.vertex(own.part, own.vertex));
        let mut ends: Vec<u32> = all.collect();
        ends.sort_unstable();
        ends.dedup();
        let corner = |vertex| CornerTag {
            vertex,
            sharpness: INFINITELY_SHARP,
        };
        self.found.soup.corners = ends.into_iter().map(corner).collect();
    }

    /// Pairs of names, as vertices, at both ends of edges that are open in two primitives, run oppositely, and in no third.
    fn shared_ends(&self) -> Vec<[Local; 2]> {
        // By the kinds of its ends from the lower to the higher: the ends in the primitives on each side.
        let mut sides: HashMap<[u32; 2], [Vec<[Local; 2]>; 2]> = HashMap::new();
        let mut order = Vec::new();
        for (part, (primitive, names)) in self.primitives.iter().zip(&self.names).enumerate() {
            let kind = |name: u32| self.kinds.all[part][names.vertices[name as usize] as usize];
            for ends in open_edges(primitive, names) {
                let [from, to] = ends.map(kind);
                let edge = [from.min(to), from.max(to)];
                let mut ends = ends.map(|vertex| Local { part, vertex });
                if from >= to {
                    ends.reverse();
                }
                let side = usize::from(from > to);
                sides.entry(edge).or_insert_with(|| {
                    order.push(edge);
                    Default::default()
                })[side]
                    .push(ends);
            }
        }
        let mut pairs = Vec::new();
        for edge in order {
            let [forward, backward] = &sides[&edge];
            if let ([[a, b]], [[c, d]]) = (&forward[..], &backward[..]) {
                pairs.extend([[*a, *c], [*b, *d]]);
            }
        }
        pairs
    }
}

/// Edges of one face alone, the way it runs along them.
fn open_edges(primitive: &Primitive, names: &Names) -> Vec<[u32; 2]> {
    let mut uses: HashMap<[u32; 2], u32> = HashMap::new();
    let mut all = Vec::with_capacity(primitive.faces.corner_count());
    for face in primitive.faces.iter() {
        let nexts = face.iter().cycle().skip(1);
        for ends in face.iter().zip(nexts) {
            let [from, to] = [ends.0, ends.1].map(|&v| names.of_vertex[v as usize]);
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
