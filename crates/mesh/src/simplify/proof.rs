//! Proof that a change of the mesh keeps it within a distance of the fine mesh, taken before the change is made.
//!
//! Each direction is proven triangle by triangle, so that a change needs proofs only of the
//! triangles that it touches.
//!
//! Proofs of changes that are far from the limit may be put off: most of their triangles are
//! changed again.
//!
//! * *From the mesh to the fine one*: each new triangle, by the sheet of fine faces over it ([`Worker::within`]).
//! * *From the fine mesh to the mesh*: each fine face, by pieces ([`super::fine_face`]). It *rests*
//!   on the faces that serve its pieces; its proof holds while these do not change.

use super::editable_mesh::EditableMesh;
use super::fine_face::{Candidates, Corner, is_within};
use super::fine_samples::FineSamples;
use super::star_region::StarRegion;
use crate::geometry::NONE;
use crate::index::VertexId;
use crate::measure::{Target, Worker};
use crate::mesh::Mesh;
use crate::progress::{Cancelled, Watch};

/// The most fine faces of a sheet: as many as a triangle of a mesh made this coarse replaces.
const SHEET: usize = 4096;

/// The observer is called at faces whose numbers are multiples of this.
const OBSERVED: u32 = 256;

/// The most faces around a vertex that are tried beyond those of a change.
const MOST_AROUND: usize = 16;

/// Faces that go, and the triangles that take their place.
pub(super) struct Change<'a> {
    /// The faces that go or get other corners.
    pub(super) old: &'a [u32],
    /// The faces across the border, which stay.
    pub(super) around: &'a [u32],
    /// The vertex that goes, or [`NONE`].
    pub(super) gone: u32,
    /// The new triangles, and the samples below, assigned to them.
    pub(super) region: &'a StarRegion,
}

/// The triangles that the proof of a fine face uses after a change.
struct Rest {
    fine: u32,
    /// Places among the candidates, as bits.
    used: u64,
    bound: f64,
}

/// The proven distances, and the triangles that they use.
pub(super) struct Prover<'t, 's, 'a> {
    worker: Worker<'t, 's, 'a>,
    fine: &'a Mesh,
    /// The rounding error of a distance.
    slack: f64,
    /// For each face of the mesh the fine faces that rest on it, perhaps among others.
    resting: Vec<Vec<u32>>,
    /// A bound of the distance of each face of the mesh from the fine mesh; infinite before the
    /// first proof.
    forward: Vec<f64>,
    /// A bound of the distance of each fine face from the mesh; infinite before the first proof.
    backward: Vec<f64>,
    /// The fine faces that the change affects, each once: `stamps` marks those met in this round.
    affected: Vec<u32>,
    stamps: Vec<u32>,
    round: u32,
    candidates: Candidates,
    /// Of the last [`Self::prove`].
    rests: Vec<Rest>,
    bounds: Vec<f64>,
    /// For each requested sample its place in the region.
    places: Vec<u32>,
    /// Fine faces and faces without proof, perhaps among others, once the proofs that were put off are taken.
    open_fine: Vec<u32>,
    open_faces: Vec<u32>,
    is_finishing: bool,
}

impl<'t, 's, 'a> Prover<'t, 's, 'a> {
    /// Of the fine mesh itself, at no distance.
    pub(crate) fn new(fine: &'a Mesh, target: &'t Target<'s, 'a>) -> Self {
        let faces = fine.face_count();
        Self {
            worker: Worker::of(target, SHEET),
            fine,
            slack: target.slack(),
            resting: (0..faces as u32).map(|face| vec![face]).collect(),
            forward: vec![0.0; faces],
            backward: vec![0.0; faces],
            affected: Vec::new(),
            stamps: vec![0; faces],
            round: 0,
            candidates: Candidates::default(),
            rests: Vec::new(),
            bounds: Vec::new(),
            places: vec![0; fine.vertex_count()],
            open_fine: Vec::new(),
            open_faces: Vec::new(),
            is_finishing: false,
        }
    }

    /// The greatest distance that the mesh and the fine one are proven to be within.
    pub(super) fn bound(&self, mesh: &EditableMesh) -> f64 {
        let forward = mesh.faces().map(|face| self.forward[face as usize]);
        self.backward
            .iter()
            .copied()
            .chain(forward)
            .fold(0.0, f64::max)
    }

    /// Whether the mesh is proven to stay within `goal` of the fine mesh by a change of it.
    pub(super) fn prove(
        &mut self,
        change: &Change<'_>,
        mesh: &EditableMesh,
        samples: &FineSamples,
        goal: f64,
    ) -> bool {
        self.gather(change, mesh, samples);
        self.prove_fine_faces(change, mesh, samples, goal) && self.prove_triangles(change, goal)
    }

    /// Looks for the fine faces and the triangles that matter.
    fn gather(&mut self, change: &Change<'_>, mesh: &EditableMesh, samples: &FineSamples) {
        self.round = self.round.wrapping_add(1);
        if self.round == 0 {
            self.stamps.fill(0);
            self.round = 1;
        }
        self.affected.clear();
        for &face in change.old {
            for &fine in &self.resting[face as usize] {
                if self.stamps[fine as usize] != self.round {
                    self.stamps[fine as usize] = self.round;
                    self.affected.push(fine);
                }
            }
        }
        for (place, &sample) in change.region.samples().iter().enumerate() {
            self.places[sample as usize] = place as u32;
        }
        self.candidates.clear();
        for (new, plane) in change.region.faces().iter().zip(change.region.planes()) {
            self.candidates.add(new.face, new.corners, plane.corners);
        }
        for &face in change.around {
            let corners = mesh.corners(face);
            self.candidates
                .add(face, corners, corners.map(|v| samples.position(v)));
        }
    }

    fn prove_fine_faces(
        &mut self,
        change: &Change<'_>,
        mesh: &EditableMesh,
        samples: &FineSamples,
        goal: f64,
    ) -> bool {
        self.rests.clear();
        if self.candidates.len() < change.region.faces().len() {
            return false;
        }
        for i in 0..self.affected.len() {
            let fine = self.affected[i];
            let corners = self.fine.topology().triangles()[fine as usize];
            let corners = corners.map(|v| self.corner(v, change, mesh, samples));
            let goal = goal - self.slack;
            let mut found = self.candidates.bound(corners, goal);
            if found.is_none() && self.add_more(fine, change, mesh, samples) {
                found = self.candidates.bound(corners, goal);
            }
            let Some((bound, used)) = found else {
                return false;
            };
            self.rests.push(Rest {
                fine,
                used,
                bound: bound + self.slack,
            });
        }
        true
    }

    /// A corner of a fine face, and the known distances of the triangles near it.
    fn corner(
        &mut self,
        v: u32,
        change: &Change<'_>,
        mesh: &EditableMesh,
        samples: &FineSamples,
    ) -> Corner {
        let at = samples.position(v);
        if v != change.gone && mesh.is_alive(v) {
            return Corner::vertex(at, v);
        }
        let place = self.places[v as usize] as usize;
        if change.region.samples().get(place) == Some(&v) {
            let (triangle, distance) = change.region.assigned()[place];
            return Corner::near(at, triangle, distance);
        }
        let holder = samples.holder(v);
        if holder == NONE {
            return Corner::vertex(at, v);
        }
        let corners = mesh.corners(holder);
        let triangle = self
            .candidates
            .add(holder, corners, corners.map(|v| samples.position(v)));
        self.candidates.sample(at, triangle)
    }

    /// Adds triangles that stay, around the corners of a fine face; whether there were any.
    fn add_more(
        &mut self,
        fine: u32,
        change: &Change<'_>,
        mesh: &EditableMesh,
        samples: &FineSamples,
    ) -> bool {
        let before = self.candidates.len();
        for v in self.fine.topology().triangles()[fine as usize] {
            let at_corners = if v != change.gone && mesh.is_alive(v) {
                [v; 3]
            } else {
                let place = self.places[v as usize] as usize;
                if change.region.samples().get(place) == Some(&v) {
                    change.region.faces()[change.region.assigned()[place].0].corners
                } else {
                    mesh.corners(samples.holder(v))
                }
            };
            for corner in at_corners {
                for h in mesh.outgoing_ring(corner).take(MOST_AROUND) {
                    if !change.old.contains(&(h / 3)) {
                        let corners = mesh.corners(h / 3);
                        self.candidates
                            .add(h / 3, corners, corners.map(|v| samples.position(v)));
                    }
                }
            }
        }
        self.candidates.len() > before
    }

    fn prove_triangles(&mut self, change: &Change<'_>, goal: f64) -> bool {
        self.bounds.clear();
        for (i, new) in change.region.faces().iter().enumerate() {
            let near = new.corners.map(|v| self.fine_face_at(v));
            let below = self.rests.iter().find(|rest| rest.used >> i & 1 == 1);
            let start = below.map_or(near[0], |rest| rest.fine);
            let bound = self
                .worker
                .within(change.region.planes()[i].corners, start, near, goal);
            if !is_within(bound, goal) {
                return false;
            }
            self.bounds.push(bound);
        }
        true
    }

    /// Takes in a change without proof; [`Self::finish`] has to follow.
    pub(super) fn defer(
        &mut self,
        change: &Change<'_>,
        mesh: &EditableMesh,
        samples: &FineSamples,
    ) {
        self.gather(change, mesh, samples);
        for &face in change.old {
            self.resting[face as usize].clear();
        }
        let new = change.region.faces();
        for &fine in &self.affected {
            self.backward[fine as usize] = f64::INFINITY;
            // Any face near it is enough: the search for affected fine faces mostly finds it there.
            let corners = self.fine.topology().triangles()[fine as usize];
            let holder = corners.iter().find_map(|&v| {
                let place = self.places[v as usize] as usize;
                let is_below = change.region.samples().get(place) == Some(&v);
                is_below.then(|| change.region.assigned()[place].0)
            });
            let at_corner = || {
                new.iter()
                    .position(|new| corners.iter().any(|v| new.corners.contains(v)))
            };
            let face = holder.or_else(at_corner).unwrap_or(0);
            self.resting[new[face].face as usize].push(fine);
        }
        for new in new {
            self.forward[new.face as usize] = f64::INFINITY;
        }
    }

    /// Takes the proofs that were put off. Where one to be within `goal` is not found, gives the faces that it may depend on;
    /// the others are taken when this is called again.
    pub(super) fn finish(
        &mut self,
        mesh: &EditableMesh,
        samples: &FineSamples,
        goal: f64,
        watch: &mut Watch<'_>,
    ) -> Result<Option<Vec<u32>>, Cancelled> {
        if !self.is_finishing {
            self.is_finishing = true;
            self.open_fine = (0..self.fine.face_count() as u32).rev().collect();
            self.open_faces = self.open_fine.clone();
        }
        let region = StarRegion::default();
        let nothing = Change {
            old: &[],
            around: &[],
            gone: NONE,
            region: &region,
        };
        while let Some(&fine) = self.open_fine.last() {
            if !self.backward[fine as usize].is_finite() {
                if fine % OBSERVED == 0 {
                    watch.poll()?;
                }
                self.candidates.clear();
                self.affected.clear();
                self.affected.push(fine);
                if !self.prove_fine_faces(&nothing, mesh, samples, goal) {
                    return Ok(Some(self.below(fine, samples)));
                }
                self.rest(fine);
            }
            self.open_fine.pop();
        }
        while let Some(&face) = self.open_faces.last() {
            let corners = mesh.corners(face);
            if corners[0] != NONE && !self.forward[face as usize].is_finite() {
                if face % OBSERVED == 0 {
                    watch.poll()?;
                }
                let near = corners.map(|v| self.fine_face_at(v));
                let start = samples
                    .of(face)
                    .next()
                    .map_or(near[0], |v| self.fine_face_at(v));
                let triangle = corners.map(|v| samples.position(v));
                let bound = self.worker.within(triangle, start, near, goal);
                if !is_within(bound, goal) {
                    return Ok(Some(vec![face]));
                }
                self.forward[face as usize] = bound;
            }
            self.open_faces.pop();
        }
        Ok(None)
    }

    /// The faces assigned to the corners of a fine face; those of its last proof where its corners
    /// all exist.
    fn below(&self, fine: u32, samples: &FineSamples) -> Vec<u32> {
        let corners = self.fine.topology().triangles()[fine as usize];
        let holders: Vec<u32> = corners
            .map(|v| samples.holder(v))
            .into_iter()
            .filter(|&face| face != NONE)
            .collect();
        if holders.is_empty() {
            return (0..self.candidates.len())
                .map(|place| self.candidates.face(place))
                .collect();
        }
        holders
    }

    /// Takes in the last proof of a fine face, without a change.
    fn rest(&mut self, fine: u32) {
        let Some(&Rest {
            mut used, bound, ..
        }) = self.rests.first()
        else {
            return;
        };
        self.backward[fine as usize] = bound;
        while used != 0 {
            let face = self.candidates.face(used.trailing_zeros() as usize);
            used &= used - 1;
            let list = &mut self.resting[face as usize];
            if !list.contains(&fine) {
                list.push(fine);
            }
        }
    }

    /// Forgets the proofs of faces that were restored.
    pub(super) fn reopen(&mut self, faces: &mut dyn Iterator<Item = u32>) {
        for face in faces {
            for fine in self.resting[face as usize].drain(..) {
                self.backward[fine as usize] = f64::INFINITY;
                self.open_fine.push(fine);
            }
            self.forward[face as usize] = f64::INFINITY;
            self.open_faces.push(face);
        }
    }

    /// A fine face at a vertex of the fine mesh.
    fn fine_face_at(&self, v: u32) -> u32 {
        self.fine.topology().outgoing(VertexId(v)).face().0
    }

    /// Takes in the change for which the last [`Self::prove`] held.
    pub(super) fn commit(&mut self, change: &Change<'_>) {
        for &face in change.old {
            self.resting[face as usize].clear();
        }
        let new = change.region.faces();
        for rest in &self.rests {
            self.backward[rest.fine as usize] = rest.bound;
            let mut used = rest.used;
            while used != 0 {
                let place = used.trailing_zeros() as usize;
                used &= used - 1;
                let list = &mut self.resting[self.candidates.face(place) as usize];
                if place < new.len() || !list.contains(&rest.fine) {
                    list.push(rest.fine);
                }
            }
        }
        for (new, &bound) in new.iter().zip(&self.bounds) {
            self.forward[new.face as usize] = bound;
        }
    }
}
