//! Front and back of a sheet where both are faces, such as those of leaves and cards: each is a sheet of its own.
//!
//! By their vertices alone the two sides are one closed surface without any inside, or the same faces twice. So faces are
//! connected along edges, but never one with another that is folded onto it, in the same half-plane beyond their edge. A sheet that lies
//! on another, as its vertices are all among the other's and it is folded onto that along some edge, is a back. It gets vertices of its
//! own; nothing else changes.

use super::disjoint::Disjoint;
use super::kinds::ByVertex;
use super::poses::Poses;
use super::primitive::{Local, Primitive};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// By primitive and face, the number of the back that it is in; 0 where it is in none.
pub(super) struct Backs {
    sheets: Vec<Vec<u32>>,
}

/// Faces on both sides of an edge that are looked at: more meet at none that is worth it.
const MOST_AROUND: usize = 8;

/// The sine of the angle that two half-planes may make and count as one: what rounding to single precision makes of thin faces.
const FOLDED: f64 = 1e-4;

impl Backs {
    /// By the kinds of vertices: equal ones are one.
    pub(super) fn of(primitives: &[Primitive], kinds: &ByVertex) -> Self {
        let faces = Faces::of(primitives, kinds);
        let mut sheets = Sheets::of(&faces, Poses::new(primitives));
        let backs = sheets.backs(&faces);
        let none = primitives.iter();
        let none = none.map(|primitive| vec![0; primitive.faces.len()]);
        let mut found = Self {
            sheets: none.collect(),
        };
        if backs.is_empty() {
            return found;
        }
        for face in 0..faces.count {
            let sheet = sheets.of_face.root(face);
            if backs.contains(&sheet) {
                let part = faces.part(face);
                found.sheets[part][(face - faces.first[part]) as usize] = sheet + 1;
            }
        }
        found
    }

    pub(super) fn is_empty(&self) -> bool {
        (0..self.sheets.len()).all(|part| self.count(part) == 0)
    }

    /// How many faces of a primitive are in backs.
    pub(super) fn count(&self, part: usize) -> usize {
        let all = self.sheets[part].iter().filter(|&&sheet| sheet != 0);
        all.count()
    }

    /// Gives each sheet vertices of its own, and says of all vertices in which back they are.
    pub(super) fn split(&self, primitives: &mut [Primitive]) -> ByVertex {
        let mut sides = Vec::with_capacity(primitives.len());
        for (primitive, sheets) in primitives.iter_mut().zip(&self.sheets) {
            let mut side = vec![None; primitive.positions.len()];
            let mut copies = HashMap::new();
            let faces = std::mem::take(&mut primitive.faces);
            for (face, &sheet) in faces.iter().zip(sheets) {
                let own = face.iter().map(|&v| {
                    if *side[v as usize].get_or_insert(sheet) == sheet {
                        return v;
                    }
                    *copies.entry((v, sheet)).or_insert_with(|| {
                        side.push(Some(sheet));
                        primitive.repeat_vertex(v)
                    })
                });
                let own: Vec<u32> = own.collect();
                primitive.faces.push(&own);
            }
            // A vertex of no face is in no back.
            sides.push(side.into_iter().map(|side| side.unwrap_or(0)).collect());
        }
        sides
    }
}

/// The faces of all primitives, counted over all.
struct Faces<'a> {
    primitives: &'a [Primitive],
    kinds: &'a ByVertex,
    /// By primitive, the number of its first face; and how many there are.
    first: Vec<u32>,
    count: u32,
}

/// A corner of a face, and the side that starts there.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Corner {
    face: u32,
    at: u32,
}

impl<'a> Faces<'a> {
    fn of(primitives: &'a [Primitive], kinds: &'a ByVertex) -> Self {
        let (mut first, mut count) = (Vec::with_capacity(primitives.len()), 0);
        for primitive in primitives {
            first.push(count);
            count += primitive.faces.len() as u32;
        }
        Self {
            primitives,
            kinds,
            first,
            count,
        }
    }

    /// The primitive of a face.
    fn part(&self, face: u32) -> usize {
        self.first.partition_point(|&first| first <= face) - 1
    }

    /// The primitive of a face, and its vertices.
    fn face(&self, face: u32) -> (usize, &'a [u32]) {
        let part = self.part(face);
        let own = (face - self.first[part]) as usize;
        (part, self.primitives[part].faces.get(own))
    }

    /// The kinds of a face's vertices.
    fn kinds(&self, face: u32) -> impl ExactSizeIterator<Item = u32> + Clone {
        let (part, vertices) = self.face(face);
        vertices.iter().map(move |&v| self.kinds[part][v as usize])
    }

    /// The vertex at a corner, or at one of those that follow in its face.
    fn vertex(&self, Corner { face, at }: Corner, steps: usize) -> Local {
        let (part, vertices) = self.face(face);
        let vertex = vertices[(at as usize + steps) % vertices.len()];
        Local { part, vertex }
    }

    fn kind(&self, corner: Corner) -> u32 {
        let Local { part, vertex } = self.vertex(corner, 0);
        self.kinds[part][vertex as usize]
    }

    /// Whether two faces have vertices of the same kinds.
    fn is_same(&self, a: Corner, b: Corner) -> bool {
        let is_in = |own: Corner, other: Corner| {
            let mut kinds = self.kinds(own.face);
            kinds.all(|kind| self.kinds(other.face).any(|other| other == kind))
        };
        let [own, other] = [a, b].map(|corner| self.kinds(corner.face).len());
        own == other && is_in(a, b) && is_in(b, a)
    }

    /// Whether two faces at an edge, which run oppositely along it, are on the same side of it.
    fn is_folded(&self, a: Corner, b: Corner, poses: Poses<'_>) -> bool {
        let [from, to, tip] = [0, 1, 2].map(|steps| self.vertex(a, steps));
        self.is_same(a, b) || poses.always([from, to, tip, self.vertex(b, 2)], is_one_half_plane)
    }
}

/// Whether two points lie in one half-plane beyond an edge.
fn is_one_half_plane([a, b, c, d]: [[f64; 3]; 4]) -> bool {
    let minus = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - a[i]);
    let cross = |u: [f64; 3], v: [f64; 3]| {
        [0, 1, 2].map(|i| u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3])
    };
    let dot = |u: [f64; 3], v: [f64; 3]| (0..3).map(|i| u[i] * v[i]).sum::<f64>();
    let along = minus(b);
    let [m, n] = [minus(c), minus(d)].map(|side| cross(along, side));
    let between = cross(m, n);
    dot(m, n) > 0.0 && dot(between, between) <= FOLDED * FOLDED * dot(m, m) * dot(n, n)
}

/// Faces that are connected along edges, but for folded ones.
struct Sheets {
    of_face: Disjoint,
    /// Faces that are folded onto each other.
    folds: Vec<[u32; 2]>,
}

impl Sheets {
    fn of(faces: &Faces<'_>, poses: Poses<'_>) -> Self {
        let mut sheets = Self {
            of_face: Disjoint::new(faces.count),
            folds: Vec::new(),
        };
        // The kinds of its ends from the lower to the higher, and the corner that it starts at.
        let mut sides: Vec<([u32; 2], Corner)> = Vec::new();
        for face in 0..faces.count {
            let own = faces.kinds(face);
            let nexts = own.clone().cycle().skip(1);
            for ((from, to), at) in own.zip(nexts).zip(0..) {
                if from != to {
                    sides.push(([from.min(to), from.max(to)], Corner { face, at }));
                }
            }
        }
        sides.sort_unstable();
        let (mut up, mut down) = (Vec::new(), Vec::new());
        let edges = sides.chunk_by(|a, b| a.0 == b.0);
        for edge in edges.filter(|edge| edge.len() <= MOST_AROUND) {
            up.clear();
            down.clear();
            for &([low, _], corner) in edge {
                let is_up = faces.kind(corner) == low;
                let same_way = if is_up { &mut up } else { &mut down };
                sheets.add_side(faces, corner, same_way);
            }
            sheets.connect(faces, poses, [&up, &down]);
        }
        sheets
    }

    /// Adds a side to those that run the same way, unless its face repeats one of theirs, with which it is then connected.
    fn add_side(&mut self, faces: &Faces<'_>, corner: Corner, same_way: &mut Vec<Corner>) {
        match same_way.iter().find(|&&other| faces.is_same(other, corner)) {
            Some(other) => self.of_face.unite(other.face, corner.face),
            None => same_way.push(corner),
        }
    }

    /// Connects faces at an edge where each can go on in the other alone.
    fn connect(&mut self, faces: &Faces<'_>, poses: Poses<'_>, [up, down]: [&[Corner]; 2]) {
        let goes_on = |&a: &Corner, &b: &Corner| !faces.is_folded(a, b, poses);
        for a in up {
            let folded = down.iter().filter(|b| !goes_on(a, b));
            self.folds.extend(folded.map(|b| [a.face, b.face]));
            let mut others = down.iter().filter(|b| goes_on(a, b));
            if let (Some(b), None) = (others.next(), others.next())
                && up.iter().filter(|other| goes_on(other, b)).count() == 1
            {
                self.of_face.unite(a.face, b.face);
            }
        }
    }

    /// The roots of sheets that are backs of others: of two the one with fewer vertices, or the later one.
    fn backs(&mut self, faces: &Faces<'_>) -> BTreeSet<u32> {
        let folds = std::mem::take(&mut self.folds);
        let all = folds.into_iter();
        let folds = all.map(|pair| pair.map(|face| self.of_face.root(face)));
        let all = folds.filter(|[a, b]| a != b);
        let folds = all.map(|[a, b]| [a.min(b), a.max(b)]);
        let pairs: BTreeSet<[u32; 2]> = folds.collect();
        let wanted: BTreeSet<u32> = pairs.iter().flatten().copied().collect();
        let mut vertices: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        if wanted.is_empty() {
            return wanted;
        }
        for face in 0..faces.count {
            let sheet = self.of_face.root(face);
            if wanted.contains(&sheet) {
                let own = faces.kinds(face);
                vertices.entry(sheet).or_default().extend(own);
            }
        }
        let of = |[a, b]: [u32; 2]| {
            let (own, other) = (vertices.get(&a)?, vertices.get(&b)?);
            if other.is_subset(own) {
                Some(b)
            } else {
                own.is_subset(other).then_some(a)
            }
        };
        pairs.into_iter().filter_map(of).collect()
    }
}
