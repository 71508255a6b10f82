//! One triangle refined a few times: the common numbering of all faces of a mesh refined by equal
//! levels.
//!
//! The tables are those of the steps themselves, taken on a mesh of one triangle, so that a mesh
//! whose faces are filled in by them is the one that the steps give: the triangles of a face are
//! consecutive and new vertices follow level by level, in the order of their first half-edges. Of
//! two faces at an edge the one with the lower number owns its vertices; which sides of a face are
//! its own decides how its vertices are counted, and there are eight cases of that.

use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Junctions, Mesh, NONE, Tags, Topology};
use crate::progress::{Stage, Watch, unobserved};
use crate::refine::RefineError;
use crate::refine::split::{SplitEdges, SplitTopology};

/// A triangle after some levels. Its vertices are numbered as the steps number them when it is
/// alone.
pub(super) struct Grid {
    pub(super) levels: usize,
    /// Segments along each side.
    pub(super) segments: usize,
    /// The triangles and their twins; [`NONE`] along the sides.
    pub(super) triangles: Vec<[u16; 3]>,
    pub(super) twins: Vec<u32>,
    /// The half-edge that each vertex keeps.
    pub(super) outgoing: Vec<u32>,
    /// Where each vertex stands: steps from corner 0 towards corners 1 and 2.
    pub(super) places: Vec<[usize; 2]>,
    /// The half-edges along each side, from the corner of its number on.
    pub(super) borders: [Vec<u32>; 3],
    /// The vertices inside each side, in the same order.
    pub(super) on_sides: [Vec<u16>; 3],
    /// By the set of owned sides.
    pub(super) owned: [Owned; 8],
}

/// The new vertices that a face with a certain set of owned sides (bit `s` for side `s`) counts as its own.
#[derive(Default)]
pub(super) struct Owned {
    /// In the order of their numbers, level by level.
    pub(super) vertices: Vec<u16>,
    /// Where each level starts in that list, and the end.
    pub(super) starts: Vec<usize>,
    /// For each of the triangle's vertices, how many of its level come before.
    pub(super) ranks: Vec<u32>,
}

impl Grid {
    /// The triangle after 1 to 7 levels.
    pub(super) fn new(levels: usize) -> Result<Self, RefineError> {
        let n = 1usize << levels;
        let mut places = vec![[0, 0], [n, 0], [0, n]];
        let mut starts = vec![places.len()];
        let mut topology = Topology::from_parts(vec![[0, 1, 2]], vec![NONE; 3], vec![0, 1, 2]);
        let observer = &mut unobserved;
        let mut watch = Watch::new(observer, Stage::Refining);
        for _ in 0..levels {
            let positions = vec![[0.0; 3]; topology.vertex_count()];
            let mesh = Mesh::from_parts(topology, positions, Tags::default(), Junctions::default());
            let split = SplitEdges::of_divisible(&mesh, &vec![true; mesh.face_count()]);
            let numbered = SplitTopology::number(&mesh, &split, &mut watch)?;
            for &edge in &numbered.edges {
                let [a, b] = mesh.topology().ends(edge).map(|v| places[v.index()]);
                places.push([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]);
            }
            starts.push(places.len());
            topology = numbered.connect(&mesh, &split, &mut watch)?;
        }
        let (borders, on_sides) = sides(&topology, &places, n);
        let owned = core::array::from_fn(|mask| Owned::new(&places, &starts, n, mask));
        Ok(Self {
            levels,
            segments: n,
            triangles: topology
                .triangles()
                .iter()
                .map(|t| t.map(|v| v as u16))
                .collect(),
            twins: topology.raw_twins().to_vec(),
            outgoing: topology
                .vertices()
                .map(|v| topology.outgoing(v).0)
                .collect(),
            places,
            borders,
            on_sides,
            owned,
        })
    }

    /// Half-edges of the refined triangle.
    pub(super) fn half_edge_count(&self) -> usize {
        self.twins.len()
    }

    /// Vertices inside the triangle that a level (from 1) adds, and those that it adds on each side.
    pub(super) fn added(level: usize) -> [usize; 2] {
        let half = 1usize << (level - 1);
        // One on each edge of the level before, which has 3 (half + 1) half / 2 edges, 3 half of them along the sides.
        [3 * half * (half - 1) / 2, half]
    }

    /// The half-edges that leave a vertex on the triangle's rim, counter-clockwise, given the one along the rim.
    pub(super) fn leaving(&self, rim: u32) -> impl Iterator<Item = u32> + '_ {
        let turned = |&h: &u32| {
            let twin = self.twins[HalfEdgeId(h).previous().index()];
            (twin != NONE).then_some(twin)
        };
        core::iter::successors(Some(rim), turned)
    }
}

impl Owned {
    fn new(places: &[[usize; 2]], starts: &[usize], n: usize, mask: usize) -> Self {
        let mut owned = Self {
            ranks: vec![0; places.len()],
            ..Self::default()
        };
        for level in starts.windows(2) {
            let start = owned.vertices.len();
            owned.starts.push(start);
            for (v, &place) in places.iter().enumerate().take(level[1]).skip(level[0]) {
                owned.ranks[v] = (owned.vertices.len() - start) as u32;
                if side_of(place, n).is_none_or(|side| mask >> side & 1 != 0) {
                    owned.vertices.push(v as u16);
                }
            }
        }
        owned.starts.push(owned.vertices.len());
        owned
    }

    /// The vertices of a level (from 1).
    pub(super) fn level(&self, level: usize) -> core::ops::Range<usize> {
        self.starts[level - 1]..self.starts[level]
    }
}

/// The side on which a place that is no corner lies.
fn side_of([i, j]: [usize; 2], n: usize) -> Option<usize> {
    if j == 0 {
        Some(0)
    } else if i + j == n {
        Some(1)
    } else if i == 0 {
        Some(2)
    } else {
        None
    }
}

/// Half-edges and vertices along the sides.
fn sides(topology: &Topology, places: &[[usize; 2]], n: usize) -> ([Vec<u32>; 3], [Vec<u16>; 3]) {
    let mut borders: [Vec<u32>; 3] = [const { Vec::new() }; 3];
    let mut on_sides: [Vec<u16>; 3] = [const { Vec::new() }; 3];
    for corner in 0..3 {
        let mut h = topology.outgoing(VertexId(corner as u32));
        for step in 0..n {
            borders[corner].push(h.0);
            let end = topology.target(h);
            if step + 1 < n {
                on_sides[corner].push(end.0 as u16);
                h = topology.outgoing(end);
            }
        }
    }
    debug_assert!(
        on_sides
            .iter()
            .flatten()
            .all(|&v| side_of(places[v as usize], n).is_some())
    );
    (borders, on_sides)
}

/// The faces of a mesh whose faces are all refined like a [`Grid`]: which vertices and half-edges are whose.
pub(super) struct Numbering<'a> {
    pub(super) grid: &'a Grid,
    pub(super) topology: &'a Topology,
    /// Which sides each face owns.
    owned: Vec<u8>,
    /// How many sides the faces before each own.
    sides_before: Vec<u32>,
    /// The first vertex of each level; that of level 0 is 0. Ends with the number of all.
    pub(super) bases: Vec<u32>,
}

impl<'a> Numbering<'a> {
    pub(super) fn new(grid: &'a Grid, topology: &'a Topology) -> Self {
        let sides_of = |face: FaceId| {
            (0..3).fold(0u8, |mask, corner| {
                let h = HalfEdgeId::of(face, corner);
                mask | u8::from(topology.twin(h).is_none_or(|twin| h < twin)) << corner
            })
        };
        let owned: Vec<u8> = topology.faces().map(sides_of).collect();
        let mut edges = 0;
        let mut sides_before = Vec::with_capacity(owned.len() + 1);
        for mask in &owned {
            sides_before.push(edges);
            edges += mask.count_ones();
        }
        sides_before.push(edges);
        let mut bases = vec![0, topology.vertex_count() as u32];
        for level in 1..=grid.levels {
            let [inside, on_side] = Grid::added(level);
            let last = bases[level];
            bases.push(last + (topology.face_count() * inside + edges as usize * on_side) as u32);
        }
        Self {
            grid,
            topology,
            owned,
            sides_before,
            bases,
        }
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.bases.last().map_or(0, |&count| count as usize)
    }

    /// How many of a level's (from 1) new vertices come before those of `face`, which may be the number of faces.
    #[inline]
    pub(super) fn before(&self, level: usize, face: usize) -> usize {
        let [inside, on_side] = Grid::added(level);
        face * inside + self.sides_before[face] as usize * on_side
    }

    /// The vertices that a face counts as its own.
    #[inline]
    pub(super) fn of(&self, face: usize) -> &'a Owned {
        &self.grid.owned[self.owned[face] as usize]
    }

    /// The sides that a face owns.
    #[inline]
    pub(super) fn sides(&self, face: usize) -> u8 {
        self.owned[face]
    }

    /// The first half-edge of a face.
    #[inline]
    pub(super) fn first(&self, face: usize) -> u32 {
        (face * self.grid.half_edge_count()) as u32
    }

    /// The numbers of a face's vertices.
    pub(super) fn numbers(&self, face: usize, numbers: &mut [u32]) {
        numbers[..3].copy_from_slice(&self.topology.triangles()[face]);
        let owned = self.of(face);
        for level in 1..=self.grid.levels {
            let first = self.bases[level] + self.before(level, face) as u32;
            for (number, &v) in (first..).zip(&owned.vertices[owned.level(level)]) {
                numbers[v as usize] = number;
            }
        }
        for side in 0..3 {
            if self.owned[face] >> side & 1 != 0 {
                continue;
            }
            let Some(twin) = self
                .topology
                .twin(HalfEdgeId::of(FaceId(face as u32), side))
            else {
                continue;
            };
            let (other, ranks) = (twin.face().index(), &self.of(twin.face().index()).ranks);
            let of_other = self.grid.on_sides[twin.corner()].iter().rev();
            for (place, (&v, &w)) in (1usize..).zip(self.grid.on_sides[side].iter().zip(of_other)) {
                // A place is new at the level at which it becomes a whole number of steps.
                let level = self.grid.levels - place.trailing_zeros() as usize;
                let first = self.bases[level] + self.before(level, other) as u32;
                numbers[v as usize] = first + ranks[w as usize];
            }
        }
    }

    /// The twins of a face's half-edges, three a triangle.
    pub(super) fn twins(&self, face: usize, twins: &mut [u32]) {
        let first = self.first(face);
        for (twin, &local) in twins.iter_mut().zip(&self.grid.twins) {
            // Those along the sides follow.
            *twin = local.wrapping_add(first);
        }
        for side in 0..3 {
            let across = self
                .topology
                .twin(HalfEdgeId::of(FaceId(face as u32), side));
            let border = &self.grid.borders[side];
            match across {
                None => border.iter().for_each(|&h| twins[h as usize] = NONE),
                Some(across) => {
                    let first = self.first(across.face().index());
                    for (&h, &twin) in border
                        .iter()
                        .zip(self.grid.borders[across.corner()].iter().rev())
                    {
                        twins[h as usize] = first + twin;
                    }
                }
            }
        }
    }
}
