//! Emits the leaves as a conforming mesh: vertices and their limits, triangles, twins, parents, origins.
//!
//! Vertices stand in this order: those of the control mesh, those on its edges, those inside its faces; triangles face
//! by face, in the order of the walk. Where each face's begin follows from the counts, so faces are written at once
//! by as many threads as there are, each into its own parts of the arrays. Faces that were emitted before and have not changed
//! since are taken over ([`kept`]).

mod arrays;
mod jobs;
mod kept;
mod leaf_writer;

use limitmesh_pages::defaults;

use super::area::Areas;
use super::chains::{Chains, first_of};
use super::close::Closed;
use super::control::Control;
use super::decide::Decision;
use super::judge::Condition;
use super::quadtree::{Edges, FULL};
use crate::mesh::{Junctions, MAX_FACES, MeshError, NONE};
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::RefineError;
use crate::refine::exact_result::Origin;
use crate::vector::{DVec3, unit_or_zero, vector};
use arrays::{Arrays, Lengths, Shifts};
use jobs::{jobs, on_edge, write};
use kept::Kept;

/// Control faces that are passed over together: some milliseconds.
const POLLED: u32 = 1 << 12;

/// The part of arrays (one in so many) that is kept free behind them, for what is divided later; and with balanced vertices, where that is a sixth
/// of all: arrays that become too short are copied. Nobody touches what is not used.
pub(super) const SPARE: usize = 32;
pub(super) const SPARE_BALANCED: usize = 4;

/// What is emitted.
pub(super) struct Emission {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) normals: Vec<[f64; 3]>,
    /// Empty where nobody asks for them.
    pub(super) origins: Vec<Origin>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) twins: Vec<u32>,
    pub(super) parents: Vec<u32>,
    /// By control face, its first triangle; one more than there are faces.
    pub(super) starts: Vec<u32>,
    /// How far each vertex was moved along its normal; empty where none was.
    pub(super) offsets: Vec<f64>,
    /// The half-edges along each control half-edge, from its start.
    pub(super) borders: Borders,
    /// By control half-edge along a sharp edge, the normals on its side of the vertices inside it.
    pub(super) sharp: Vec<(u32, Vec<[f64; 3]>)>,
    /// Copies of vertices and edges of cut sheets.
    pub(super) junctions: Junctions,
    /// Leaves that pass on conditions, with their first triangles, and one past the last, by control face.
    pub(super) conditions: Vec<(Condition, u32, u32)>,
    /// Where the vertices lay before they were moved; empty where none was.
    feet: Vec<[f64; 3]>,
    /// How the vertices of control faces that were taken over were moved before.
    before: Moves,
    numbers: Numbers,
    /// By control face, how much of it is here.
    extend: Vec<Extend>,
}

/// How far vertices were moved, and where they lie since; empty where none was.
#[derive(Default)]
struct Moves {
    offsets: Vec<f64>,
    positions: Vec<[f64; 3]>,
}

/// The numbers of vertices.
struct Numbers {
    /// By half-edge, the first of its own; one more than there are half-edges.
    on_edges: Vec<u32>,
    /// By control face, the first inside it; one more than there are faces.
    inside: Vec<u32>,
}

impl Emission {
    /// The numbers of a control face's triangles.
    pub(super) fn triangles_of(&self, face: u32) -> core::ops::Range<usize> {
        self.starts[face as usize] as usize..self.starts[face as usize + 1] as usize
    }

    /// The vertices inside a control face.
    pub(super) fn vertices_inside(&self, face: u32) -> core::ops::Range<usize> {
        self.numbers.inside[face as usize] as usize..self.numbers.inside[face as usize + 1] as usize
    }

    /// Whether what is beyond a half-edge is known to be its twin.
    pub(super) fn is_known(&self, h: u32, twin: u32) -> bool {
        twin != h && self.twins[twin as usize] == h
    }

    /// Whether everything is here, and no control face has changed since.
    pub(super) fn is_complete(&self, is_changed: &[bool]) -> bool {
        self.extend
            .iter()
            .zip(is_changed)
            .all(|(extend, &is_changed)| extend.is_whole() && !is_changed)
    }

    /// Whether a control face was written anew, not taken over.
    pub(super) fn is_new(&self, face: u32) -> bool {
        self.extend[face as usize] == Extend::All
    }

    /// The vertices of a control face that is here; some more than once.
    pub(super) fn vertices_of(&self, face: u32) -> impl Iterator<Item = u32> {
        let half_edges = (3 * face..3 * face + 3).flat_map(|h| self.borders.along(h));
        let starts = half_edges.map(|&h| self.triangles[h as usize / 3][h as usize % 3]);
        self.vertices_inside(face)
            .map(|vertex| vertex as u32)
            .chain(starts)
    }

    /// How far the vertices of control faces that were taken over were moved before; of others that is not known. `None` where all are
    /// new, or none was moved.
    pub(super) fn offsets_before(&mut self) -> Option<Vec<f64>> {
        let offsets = core::mem::take(&mut self.before.offsets);
        (!offsets.is_empty()).then_some(offsets)
    }

    /// Moves the vertices along their normals. Only those of some control faces are moved otherwise than before.
    pub(super) fn shift(
        &mut self,
        (offsets, faces): (Vec<f64>, Vec<u32>),
        watch: &SharedWatch<'_>,
    ) -> Result<(), Cancelled> {
        self.offsets = offsets;
        let mut moved = core::mem::take(&mut self.before.positions);
        let at =
            |vertex: u32| (vector(self.positions[vertex as usize]) + self.step(vertex)).to_array();
        if moved.is_empty() {
            moved = limitmesh_pages::with_capacity(self.positions.len());
            watch.each(0..self.positions.len() as u32, |vertex| {
                moved.push(at(vertex))
            })?;
        } else {
            watch.each(faces, |face| {
                self.vertices_of(face)
                    .for_each(|vertex| moved[vertex as usize] = at(vertex));
            })?;
            let copies = self.junctions.vertices.iter().flatten();
            copies.for_each(|&vertex| moved[vertex as usize] = at(vertex));
        }
        self.feet = core::mem::replace(&mut self.positions, moved);
        Ok(())
    }

    /// How far the corners of a triangle were moved.
    pub(super) fn offsets_of(&self, triangle: usize) -> [f64; 3] {
        self.triangles[triangle]
            .map(|vertex| self.offsets.get(vertex as usize).copied().unwrap_or(0.0))
    }

    /// How far a vertex was moved, and in which direction.
    pub(super) fn step(&self, vertex: u32) -> DVec3 {
        let offset = self.offsets.get(vertex as usize).copied().unwrap_or(0.0);
        offset * vector(self.normals[vertex as usize])
    }
}

/// The emitted half-edges along the edges of control faces.
pub(super) struct Borders {
    starts: Vec<u32>,
    half_edges: Vec<u32>,
}

impl Borders {
    /// Along a control half-edge, from its start.
    pub(super) fn along(&self, h: u32) -> &[u32] {
        &self.half_edges[self.starts[h as usize] as usize..self.starts[h as usize + 1] as usize]
    }
}

const NOWHERE: Origin = Origin {
    face: NONE,
    barycentric: [0.0; 3],
};

/// How much of a control face is emitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Extend {
    /// Nothing.
    Nothing,
    /// The vertices on its edges that are its own.
    Edges,
    /// Everything, as it was emitted before.
    Kept,
    /// Everything.
    All,
}

impl Extend {
    fn is_whole(self) -> bool {
        self >= Self::Kept
    }
}

/// What is emitted of a plan. Half-edges beyond which nothing was have the twin [`UNKNOWN`].
#[derive(Clone, Copy)]
pub(super) enum Scope<'a> {
    All,
    /// The control faces of some areas: others have no triangles and no vertices inside.
    Faces(&'a Areas),
    /// No more of them than the areas. What is around these has room in the arrays that nobody touches.
    Areas(&'a Areas),
}

/// What arrays are made of that nobody has touched; the half-edge of that number has another one as its twin.
const UNKNOWN: u32 = 0;

/// What was emitted last.
pub(super) enum Last<'a> {
    /// It is of no more use: what is emitted goes into its arrays.
    Taken(Box<Emission>),
    /// It stays as it is.
    Kept(&'a Emission),
}

impl Last<'_> {
    fn emission(&self) -> &Emission {
        match self {
            Self::Taken(emission) => emission,
            Self::Kept(emission) => emission,
        }
    }
}

/// Emits leaves. `closed` is what the walks over the faces found, `before` what was
/// emitted last and the control faces that were walked over since: others are taken over as they are. `has_origins` if origins are
/// asked for; one in `spare` of the arrays is kept free.
pub(super) fn emit(
    (control, watch): (&Control<'_>, &SharedWatch<'_>),
    edges: &Edges<'_>,
    (decision, chains): (&Decision, &Chains),
    closed: &[Closed],
    (scope, has_origins, spare): (Scope<'_>, bool, usize),
    before: Option<(Last<'_>, &[bool])>,
) -> Result<Emission, RefineError> {
    let faces = control.mesh.face_count();
    let too_many = |what, count| MeshError::TooMany {
        what,
        count,
        limit: MAX_FACES,
    };
    let is_kept = |face: u32| {
        // Normals on sharp edges are averages by now.
        let is_here = |(before, is_changed): &(Last<'_>, &[bool])| {
            let is_whole = before.emission().extend[face as usize].is_whole();
            is_whole && !is_changed[face as usize] && control.open(face) == [false; 3]
        };
        before.as_ref().is_some_and(is_here)
    };
    let mut extend = match scope {
        Scope::Faces(areas) | Scope::Areas(areas) => extends(edges, areas, faces),
        Scope::All => vec![Extend::All; faces],
    };
    watch.each((0..).zip(&mut extend), |(face, extend)| {
        if *extend == Extend::All && is_kept(face) {
            *extend = Extend::Kept;
        }
    })?;
    let only = match scope {
        Scope::Areas(areas) => Some(areas),
        Scope::All | Scope::Faces(_) => None,
    };
    let counts = Counts {
        closed,
        extend: &extend,
    };
    let total: usize = counts.triangles().map(|count| count as usize).sum();
    let inside: usize = counts.vertices().map(|count| count as usize).sum();
    let on_edges = control.mesh.vertex_count() + chains.count();
    if total > MAX_FACES || on_edges + inside >= NONE as usize {
        return Err(too_many("triangles", total).into());
    }
    let mut starts = defaults::<u32>(3 * faces + 1);
    watch.each(0..3 * faces, |h| {
        starts[h + 1] = starts[h] + chains.along(edges, h as u32) as u32 + 1
    })?;
    let mut next = 0;
    let first_triangles = counts.triangles().map(|count| {
        next += count;
        next - count
    });
    let first_triangles: Vec<u32> = first_triangles.chain([total as u32]).collect();
    let numbers = Numbers::of(control, chains, &counts);
    let length = Lengths {
        vertices: on_edges + inside,
        triangles: total,
    };
    let mut before = before.map(|(last, _)| last);
    let arrays = match &mut before {
        Some(Last::Taken(before)) => {
            let mut arrays = Arrays::taken(before);
            let shifts = shifts(
                control,
                (before, &extend),
                (&numbers, &first_triangles),
                watch,
            )?;
            arrays.rearrange(length, (&shifts.0, &shifts.1), watch)?;
            arrays
        }
        _ => {
            let room = room(control, chains, (closed, scope), (length, spare));
            Arrays::fresh(length, room, has_origins, watch)?
        }
    };
    let Arrays {
        positions,
        normals,
        origins,
        triangles,
        twins,
        parents,
        moves,
    } = arrays;
    let mut emission = Emission {
        positions,
        normals,
        origins,
        triangles,
        twins,
        parents,
        starts: first_triangles,
        offsets: Vec::new(),
        borders: Borders {
            half_edges: defaults(starts[3 * faces] as usize),
            starts,
        },
        sharp: Vec::new(),
        junctions: Junctions::default(),
        conditions: Vec::new(),
        feet: Vec::new(),
        before: moves,
        numbers,
        extend: Vec::new(),
    };
    corners(control, &mut emission, watch)?;
    let jobs = jobs(control, edges, chains, &counts, &mut emission, watch)?;
    let kept = before.as_ref().map(|last| Kept {
        before: last.emission(),
        mesh: control.mesh,
        edges,
        chains,
        is_in_place: matches!(last, Last::Taken(_)),
    });
    let conditions = parallel::each_long_polled(jobs, &mut |_| watch.poll(), |job, is_stopped| {
        write(
            control,
            edges,
            (decision, chains),
            (closed, kept.as_ref(), only),
            job,
            is_stopped,
        )
    });
    emission.conditions = conditions?.concat();
    emission.extend = extend;
    join(edges, &mut emission, watch)?;
    sharp_edges((control, watch), edges, chains, &mut emission)?;
    Ok(emission)
}

/// How much there may be in the end.
fn room(
    control: &Control<'_>,
    chains: &Chains,
    (closed, scope): (&[Closed], Scope<'_>),
    (length, spare): (Lengths, usize),
) -> Lengths {
    if matches!(scope, Scope::Areas(_)) {
        return length;
    }
    let count = |of: fn(&Closed) -> u32| closed.iter().map(|face| of(face) as usize).sum::<usize>();
    let vertices = control.mesh.vertex_count() + chains.count() + count(|face| face.vertices);
    let with_spare = |count: usize| count + count / spare;
    Lengths {
        vertices: with_spare(vertices),
        triangles: with_spare(count(|face| face.triangles)),
    }
}

/// Where the vertices and triangles of control faces that are kept stood before, and where they stand now.
fn shifts(
    control: &Control<'_>,
    (before, extend): (&Emission, &[Extend]),
    (now, starts): (&Numbers, &[u32]),
    watch: &SharedWatch<'_>,
) -> Result<(Shifts, Shifts), Cancelled> {
    let (mut vertices, mut triangles) = (Shifts::default(), Shifts::default());
    let is_kept = |face: usize| extend[face] == Extend::Kept;
    vertices.push(0..control.mesh.vertex_count(), 0);
    let was = &before.numbers;
    watch.each(0..3 * extend.len(), |h| {
        if is_kept(h / 3) {
            vertices.push(
                was.on_edges[h] as usize..was.on_edges[h + 1] as usize,
                now.on_edges[h] as usize,
            );
        }
    })?;
    watch.each(0..extend.len(), |face| {
        if is_kept(face) {
            vertices.push(
                before.vertices_inside(face as u32),
                now.inside[face] as usize,
            );
            triangles.push(before.triangles_of(face as u32), starts[face] as usize);
        }
    })?;
    Ok((vertices, triangles))
}

/// How much of each face some areas take: theirs, and the edges of the faces around them.
fn extends(edges: &Edges<'_>, areas: &Areas, faces: usize) -> Vec<Extend> {
    let mut extend = vec![Extend::Nothing; faces];
    for h in areas.0.keys().flat_map(|&face| 3 * face..3 * face + 3) {
        let owner = first_of(edges, h) as usize / 3;
        extend[owner] = extend[owner].max(Extend::Edges);
    }
    areas
        .0
        .keys()
        .for_each(|&face| extend[face as usize] = Extend::All);
    extend
}

/// How much is emitted, by control face.
struct Counts<'a> {
    closed: &'a [Closed],
    extend: &'a [Extend],
}

impl Counts<'_> {
    fn each(&self, count: impl Fn(&Closed) -> u32) -> impl Iterator<Item = u32> {
        let faces = self.closed.iter().zip(self.extend);
        faces.map(move |(face, &extend)| if extend.is_whole() { count(face) } else { 0 })
    }

    fn triangles(&self) -> impl Iterator<Item = u32> {
        self.each(|face| face.triangles)
    }

    /// Vertices inside.
    fn vertices(&self) -> impl Iterator<Item = u32> {
        self.each(|face| face.vertices)
    }
}

impl Numbers {
    fn of(control: &Control<'_>, chains: &Chains, counts: &Counts<'_>) -> Self {
        let first = (control.mesh.vertex_count() + chains.count()) as u32;
        let inside = counts.vertices().scan(first, |next, count| {
            *next += count;
            Some(*next)
        });
        let inside = core::iter::once(first).chain(inside);
        let on_edges = (0..3 * counts.closed.len() as u32)
            .map(|h| chains.own(h).0)
            .chain([first]);
        Self {
            on_edges: on_edges.collect(),
            inside: inside.collect(),
        }
    }
}

/// The control vertices.
fn corners(
    control: &Control<'_>,
    emission: &mut Emission,
    watch: &SharedWatch<'_>,
) -> Result<(), Cancelled> {
    let count = control.mesh.vertex_count();
    emission.positions[..count].copy_from_slice(&control.positions);
    emission.normals[..count].copy_from_slice(control.sided.by_vertex());
    if emission.origins.is_empty() {
        return Ok(());
    }
    watch.each((0..).zip(control.mesh.triangles()), |(face, triangle)| {
        for (corner, &vertex) in triangle.iter().enumerate() {
            let origin = &mut emission.origins[vertex as usize];
            if origin.face == NONE {
                let mut barycentric = [0.0; 3];
                barycentric[corner] = 1.0;
                *origin = Origin { face, barycentric };
            }
        }
    })
}

fn fraction(at: u32) -> f64 {
    f64::from(at) / f64::from(FULL)
}

/// Makes the half-edges on both sides of control edges twins; what is beyond those that are here alone is not known.
fn join(
    edges: &Edges<'_>,
    emission: &mut Emission,
    watch: &SharedWatch<'_>,
) -> Result<(), Cancelled> {
    let Emission {
        borders,
        twins,
        extend,
        ..
    } = emission;
    let is_whole = |h: u32| extend[h as usize / 3].is_whole();
    // Half-edges of areas that were passed over have no number.
    let mut meet = |[a, b]: [u32; 2], beyond: u32| {
        if a != NONE {
            twins[a as usize] = if b == NONE { beyond } else { b };
        }
    };
    watch.each(0..borders.starts.len() as u32 - 1, |h| {
        match edges.twin(h) {
            Some(twin) if h < twin && is_whole(h) && is_whole(twin) => {
                for (&a, &b) in borders
                    .along(h)
                    .iter()
                    .zip(borders.along(twin).iter().rev())
                {
                    meet([a, b], UNKNOWN);
                    meet([b, a], UNKNOWN);
                }
            }
            Some(twin) if is_whole(h) && !is_whole(twin) => {
                borders
                    .along(h)
                    .iter()
                    .for_each(|&a| meet([a, NONE], UNKNOWN));
            }
            None if is_whole(h) => borders.along(h).iter().for_each(|&a| meet([a, NONE], NONE)),
            _ => {}
        }
    })
}

/// Normals on both sides of sharp edges: a vertex has their average.
fn sharp_edges(
    (control, watch): (&Control<'_>, &SharedWatch<'_>),
    edges: &Edges<'_>,
    chains: &Chains,
    emission: &mut Emission,
) -> Result<(), Cancelled> {
    if control.lasting.is_empty() {
        return Ok(());
    }
    for face in 0..control.mesh.face_count() as u32 {
        let open = if emission.extend[face as usize].is_whole() {
            control.open(face)
        } else {
            [false; 3]
        };
        if open != [false; 3] || face.is_multiple_of(POLLED) {
            watch.poll()?;
        }
        for edge in (0..3).filter(|&edge| open[edge]) {
            let h = 3 * face + edge as u32;
            let Some(twin) = edges.twin(h) else { continue };
            let (number, places) = chains.own(first_of(edges, h));
            let mut normals = vec![[0.0; 3]; places.len()];
            if h < twin {
                normals.copy_from_slice(
                    &emission.normals[number as usize..number as usize + places.len()],
                );
            } else {
                let turned: Vec<u32> = places.iter().rev().map(|&at| FULL - at).collect();
                let piece = control.piece(face);
                on_edge(
                    face,
                    edge,
                    &turned,
                    piece.surface(control.rules),
                    |i, point, _| {
                        normals[i] = point.normal.to_array();
                    },
                );
            }
            emission.sharp.push((h, normals));
        }
    }
    watch.each(&emission.sharp, |(h, normals)| {
        let owner = first_of(edges, *h);
        if owner != *h {
            let number = chains.own(owner).0;
            for (vertex, normal) in (number..).zip(normals.iter().rev()) {
                let known = &mut emission.normals[vertex as usize];
                let sum: DVec3 = vector(*known) + vector(*normal);
                *known = unit_or_zero(sum).to_array();
            }
        }
    })
}
