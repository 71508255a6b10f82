//! The faces around a vertex, gathered into one place, and their state if the vertex were collapsed
//! into one of its neighbours.

use super::editable_mesh::{EditableMesh, next, previous};
use super::fine_samples::FineSamples;
use super::kept_features::{Kind, walk_chain};
use super::proof::Change;
use super::reference::{LEAST_TURN, Reference, Worst, bulge};
use super::star_region::StarRegion;
use super::triangle_plane::{Plane, squared_to_segment};
use crate::mesh::NONE;
use crate::vector::DVec3;

/// A vertex, its neighbours, and the samples of its faces; filled anew for each vertex.
#[derive(Default)]
pub(super) struct VertexStar {
    pub(super) centre: u32,
    position: DVec3,
    /// Outgoing half-edges, counter-clockwise; one for each face.
    spokes: Vec<u32>,
    /// Neighbours, counter-clockwise; an open ring has one more than faces.
    pub(super) ring: Vec<u32>,
    ring_positions: Vec<DVec3>,
    region: StarRegion,
    /// For each pair of neighbours how far the surface bulges over their chord.
    sagittas: Vec<f64>,
    ways: Vec<Way>,
    /// The worst of the existing faces, computed on first use.
    worst: Option<Worst>,
    normals: Vec<DVec3>,
    /// The fine vertices of the chain between the centre's two neighbours on it, the centre's own included.
    chain: Vec<DVec3>,
    chain_ends: [u32; 2],
    /// The faces of the star, and those across its border.
    faces: Vec<u32>,
    around: Vec<u32>,
}

/// A neighbour that the centre may go to.
#[derive(Clone, Copy)]
pub(super) struct Way {
    /// Its place in the ring.
    pub(super) slot: usize,
    /// A lower bound of the error, as estimated from normals.
    pub(super) bulge: f64,
}

impl VertexStar {
    /// Gathers the star of `centre`.
    pub(super) fn gather(
        &mut self,
        centre: u32,
        surface: &EditableMesh,
        samples: &FineSamples,
        reference: &Reference<'_>,
    ) {
        self.centre = centre;
        self.position = samples.position(centre);
        self.spokes.clear();
        self.ring.clear();
        self.ring_positions.clear();
        self.region.clear();
        // The centre is likely to be the farthest sample, and the first one to refuse a collapse.
        self.region.add_sample(centre, samples);
        let mut last = NONE;
        for h in surface.outgoing_ring(centre) {
            self.spokes.push(h);
            self.ring.push(surface.target(h));
            last = h;
            self.region.add_face(h / 3, samples);
        }
        if surface.twin(previous(last)) == NONE {
            self.ring.push(surface.origin(previous(last)));
        }
        for &v in &self.ring {
            self.ring_positions.push(samples.position(v));
            self.region.add_corner(v, samples);
        }
        self.worst = None;
        self.gather_chain(surface, samples, reference);
    }

    /// Walks from the centre along its crease or boundary to the next vertices that are still there.
    fn gather_chain(
        &mut self,
        surface: &EditableMesh,
        samples: &FineSamples,
        reference: &Reference<'_>,
    ) {
        self.chain.clear();
        let Kind::Chain(ways) = reference.kind(self.centre) else {
            return;
        };
        self.chain.push(self.position);
        self.chain_ends = ways.map(|way| {
            let chain = &mut self.chain;
            walk_chain(self.centre, way, surface, reference.kinds, |v| {
                chain.push(samples.position(v))
            })
        });
    }

    /// The half-edge along the edge from the centre to the neighbour at `slot`, whichever way it runs.
    pub(super) fn edge(&self, slot: usize) -> u32 {
        // The last neighbour of an open ring is only reached the other way.
        self.spokes
            .get(slot)
            .copied()
            .unwrap_or_else(|| previous(self.spokes[slot - 1]))
    }

    /// The faces of the star as pairs of positions in the ring: their two corners other than the
    /// centre.
    fn sectors(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let neighbours = self.ring.len();
        (0..self.spokes.len()).map(move |i| [i, if i + 1 == neighbours { 0 } else { i + 1 }])
    }

    /// The worst of the triangles that are there, and all their normals.
    fn look_at_faces(&mut self, reference: &Reference<'_>) -> Worst {
        if let Some(worst) = self.worst {
            return worst;
        }
        let mut worst = Worst::NONE;
        self.normals.clear();
        for [i, j] in self.sectors() {
            let plane = Plane::new([
                self.position,
                self.ring_positions[i],
                self.ring_positions[j],
            ]);
            worst.add(
                plane.as_ref(),
                [self.centre, self.ring[i], self.ring[j]],
                reference,
            );
            self.normals
                .push(plane.map_or(DVec3::ZERO, |plane| plane.normal));
        }
        self.worst = Some(worst);
        worst
    }

    /// Finds the neighbours that the centre may go to, those with the least bulge first.
    pub(super) fn find_ways(&mut self, reference: &Reference<'_>) {
        self.ways.clear();
        let ends = match reference.kind(self.centre) {
            Kind::Smooth => None,
            // A closed chain of which two vertices are left must keep both.
            Kind::Chain(_) if self.chain_ends[0] != self.chain_ends[1] => Some(self.chain_ends),
            _ => return,
        };
        self.measure_chords(reference);
        for slot in 0..self.ring.len() {
            if ends.is_none_or(|ends| ends.contains(&self.ring[slot])) {
                let bulge = self.bulge_after(slot);
                self.ways.push(Way { slot, bulge });
            }
        }
        self.ways
            .sort_unstable_by(|a, b| a.bulge.total_cmp(&b.bulge).then(a.slot.cmp(&b.slot)));
    }

    /// The neighbour that comes `place`th in the order of [`Self::find_ways`].
    #[inline]
    pub(super) fn way(&self, place: usize) -> Option<Way> {
        self.ways.get(place).copied()
    }

    /// Measures how far the surface bulges over each chord between two neighbours.
    fn measure_chords(&mut self, reference: &Reference<'_>) {
        let n = self.ring.len();
        self.sagittas.clear();
        self.sagittas.resize(n * n, 0.0);
        for i in 0..n {
            for j in i + 1..n {
                let ends = [self.ring_positions[i], self.ring_positions[j]];
                let sagitta = reference.sagitta([self.ring[i], self.ring[j]], ends);
                self.sagittas[i * n + j] = sagitta;
                self.sagittas[j * n + i] = sagitta;
            }
        }
    }

    /// The greatest bulge over the triangles that meet at the neighbour at `slot` after the collapse.
    fn bulge_after(&self, slot: usize) -> f64 {
        let n = self.ring.len();
        let chord = |i: usize, j: usize| self.sagittas[i * n + j];
        let triangles = self.sectors().filter(|sector| !sector.contains(&slot));
        triangles
            .map(|[i, j]| bulge([chord(slot, i), chord(i, j), chord(j, slot)]))
            .fold(0.0, f64::max)
    }

    /// Tests the triangles of the star after a collapse of the centre to the neighbour at `slot`:
    /// whether all of them are well oriented.
    pub(super) fn collapse_into(&mut self, slot: usize, reference: &Reference<'_>) -> bool {
        let worst = self.look_at_faces(reference);
        let (apex, at) = (self.ring[slot], self.ring_positions[slot]);
        let normal = reference.normal(self.centre);
        self.region.clear_triangles();
        for [i, j] in self.sectors() {
            if i == slot || j == slot {
                continue;
            }
            let Some(plane) = Plane::new([at, self.ring_positions[i], self.ring_positions[j]])
            else {
                return false;
            };
            let turn = plane.normal.dot(normal.unwrap_or(self.normals[i]));
            let corners = [apex, self.ring[i], self.ring[j]];
            if turn < LEAST_TURN.min(worst.turn) || !reference.fits(&plane, corners, worst) {
                return false;
            }
            self.region.add_triangle(plane, corners, self.spokes[i] / 3);
        }
        !self.region.planes().is_empty()
    }

    /// The least shape among the triangles of the last [`Self::collapse_into`].
    pub(super) fn shape(&self) -> f64 {
        self.region
            .planes()
            .iter()
            .map(|plane| plane.shape)
            .fold(1.0, f64::min)
    }

    /// The cost of the triangles that [`Self::collapse_into`] left for this way: their greatest error. `None` if that is not
    /// below `bound`.
    pub(super) fn cost(&mut self, way: Way, reference: &Reference<'_>, bound: f64) -> Option<f64> {
        let error = self
            .region
            .forward_error(self.chain_error().max(way.bulge), bound)?;
        // With few samples the normals at the corners are as good.
        if self.region.sample_count() <= 2 * self.spokes.len() {
            return Some(error);
        }
        let (slot, n) = (way.slot, self.ring.len());
        let at = self.ring_positions[slot];
        for (i, &to) in self.ring_positions.iter().enumerate() {
            // The edges to the adjacent neighbours exist already.
            let apart = (i + n - slot) % n;
            if (2..n - 1).contains(&apart) {
                self.region.probe_edge(at, to);
            }
        }
        let error = error.max(self.region.backward_error(reference));
        (error < bound).then_some(error)
    }

    /// The change of the mesh that the last [`Self::collapse_into`] would be.
    pub(super) fn change(&mut self, surface: &EditableMesh) -> Change<'_> {
        self.faces.clear();
        self.faces.extend(self.spokes.iter().map(|h| h / 3));
        self.around.clear();
        let across = self.spokes.iter().map(|&h| surface.twin(next(h)));
        self.around
            .extend(across.filter(|&twin| twin != NONE).map(|twin| twin / 3));
        self.region.assign();
        Change {
            old: &self.faces,
            around: &self.around,
            gone: self.centre,
            region: &self.region,
        }
    }

    /// How far the removed vertices of the chain would be from the edge that replaces them.
    fn chain_error(&self) -> f64 {
        if self.chain.is_empty() {
            return 0.0;
        }
        let position = |v: u32| {
            self.ring
                .iter()
                .position(|&r| r == v)
                .map(|slot| self.ring_positions[slot])
        };
        let [Some(a), Some(b)] = self.chain_ends.map(position) else {
            return f64::INFINITY;
        };
        self.chain
            .iter()
            .map(|&p| squared_to_segment(p, a, b))
            .fold(0.0, f64::max)
            .sqrt()
    }

    /// Gives all samples of the star to the triangles of the last [`Self::change`], which are there now.
    pub(super) fn hand_over(&self, samples: &mut FineSamples) {
        self.region.hand_over(samples, self.faces.iter().copied());
    }
}
