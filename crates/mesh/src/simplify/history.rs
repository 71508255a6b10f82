//! The changes of a mesh, so that single ones can be taken back: those whose proof was put off and does not hold.
//!
//! A change is recorded before it happens, by the state of the faces that it touches. Taking one
//! back first takes back those that touched any of them since, which are few: distant changes stay.

use super::editable_mesh::{EditableMesh, Slot};
use super::fine_samples::FineSamples;
use crate::geometry::NONE;

/// A face that a change takes or gives other corners.
struct OldFace {
    face: u32,
    slots: [Slot; 3],
    error: f64,
    /// The last change that touched it before.
    before: u32,
}

/// A half-edge of another face, across the border.
struct Across {
    h: u32,
    slot: Slot,
    before: u32,
}

/// Where the records of a change begin.
struct Change {
    faces: usize,
    across: usize,
    samples: usize,
    centre: u32,
}

/// All changes since the fine mesh.
pub(super) struct History {
    changes: Vec<Change>,
    faces: Vec<OldFace>,
    across: Vec<Across>,
    /// Samples of the old faces, and which face cared for each.
    samples: Vec<(u32, u32)>,
    /// By face the last change that touched it, or [`NONE`].
    last: Vec<u32>,
}

impl History {
    /// An empty history of a mesh with `faces` faces.
    pub(crate) fn new(faces: usize) -> Self {
        Self {
            changes: Vec::new(),
            faces: Vec::new(),
            across: Vec::new(),
            samples: Vec::new(),
            last: vec![NONE; faces],
        }
    }

    /// Records the faces that are about to change, with the samples that they care for and the vertex that goes, if any.
    pub(super) fn record(
        &mut self,
        old: &[u32],
        centre: u32,
        below: &[u32],
        surface: &EditableMesh,
        samples: &FineSamples,
    ) {
        let change = self.changes.len() as u32;
        self.changes.push(Change {
            faces: self.faces.len(),
            across: self.across.len(),
            samples: self.samples.len(),
            centre,
        });
        for &face in old {
            let before = core::mem::replace(&mut self.last[face as usize], change);
            let slots = [0, 1, 2].map(|corner| surface.slot(3 * face + corner));
            self.faces.push(OldFace {
                face,
                slots,
                error: samples.error(face),
                before,
            });
        }
        for h in old.iter().flat_map(|&face| 3 * face..3 * face + 3) {
            let twin = surface.twin(h);
            if twin != NONE && !old.contains(&(twin / 3)) {
                let before = core::mem::replace(&mut self.last[twin as usize / 3], change);
                self.across.push(Across {
                    h: twin,
                    slot: surface.slot(twin),
                    before,
                });
            }
        }
        self.samples
            .extend(below.iter().map(|&sample| (sample, samples.holder(sample))));
    }

    /// The last change that touched any of the faces.
    pub(super) fn latest(&self, faces: impl Iterator<Item = u32>) -> Option<u32> {
        faces
            .map(|face| self.last[face as usize])
            .filter(|&change| change != NONE)
            .max()
    }

    /// Takes back a change and those that came after it where it was; reports for each the restored
    /// faces and vertex.
    pub(super) fn take_back(
        &mut self,
        change: u32,
        surface: &mut EditableMesh,
        samples: &mut FineSamples,
        mut report: impl FnMut(&mut dyn Iterator<Item = u32>, u32),
    ) {
        let mut waiting = vec![change];
        while let Some(&change) = waiting.last() {
            let records = self.records(change);
            let faces = self.faces[records.0.clone()].iter().map(|old| old.face);
            let across = self.across[records.1.clone()]
                .iter()
                .map(|across| across.h / 3);
            let later = faces
                .chain(across)
                .map(|face| self.last[face as usize])
                .max();
            if let Some(later) = later.filter(|&later| later > change) {
                waiting.push(later);
                continue;
            }
            waiting.pop();
            self.restore(change, surface, samples);
            let faces = &self.faces[records.0];
            report(
                &mut faces.iter().map(|old| old.face),
                self.changes[change as usize].centre,
            );
        }
    }

    /// Where the records of a change are: old faces, half-edges across, samples.
    fn records(
        &self,
        change: u32,
    ) -> (
        core::ops::Range<usize>,
        core::ops::Range<usize>,
        core::ops::Range<usize>,
    ) {
        let own = &self.changes[change as usize];
        let (faces, across, samples) = match self.changes.get(change as usize + 1) {
            Some(next) => (next.faces, next.across, next.samples),
            None => (self.faces.len(), self.across.len(), self.samples.len()),
        };
        (own.faces..faces, own.across..across, own.samples..samples)
    }

    fn restore(&mut self, change: u32, surface: &mut EditableMesh, samples: &mut FineSamples) {
        let (faces, across, below) = self.records(change);
        // A face across may be recorded more than once: the first record is the oldest.
        for across in self.across[across].iter().rev() {
            surface.put(across.h, across.slot);
            self.last[across.h as usize / 3] = across.before;
        }
        for old in &self.faces[faces.clone()] {
            for (h, slot) in (3 * old.face..).zip(old.slots) {
                surface.put(h, slot);
            }
            self.last[old.face as usize] = old.before;
            samples.clear(old.face);
        }
        for old in &self.faces[faces.clone()] {
            surface.seat_corners(old.face);
        }
        for &(sample, holder) in &self.samples[below] {
            samples.give_back(holder, sample);
        }
        for old in &self.faces[faces] {
            samples.set_error(old.face, old.error);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::vector::vector;
    use limitmesh_testing::Random;

    /// Regardless of which changes are taken back and in which order, the mesh is as it was.
    /// A model as a mesh of this build.
    fn own(name: &str) -> Mesh {
        let model = limitmesh_testing::models::model(name);
        Mesh::from_triangles(model.positions().to_vec(), model.triangles().to_vec()).unwrap()
    }

    #[test]
    fn what_is_taken_back_leaves_no_trace() {
        for name in ["sphere", "sheet", "bunny"] {
            let fine = own(name);
            let positions = fine.positions().iter().copied().map(vector).collect();
            let mut samples = FineSamples::new(positions, fine.face_count());
            let whole = EditableMesh::new(fine.topology());
            let mut surface = whole.clone();
            let mut history = History::new(fine.face_count());
            let mut random = Random::new(5);
            for _ in 0..20 * fine.vertex_count() {
                let v = random.below(fine.vertex_count()) as u32;
                if !surface.is_alive(v) {
                    continue;
                }
                let spokes: Vec<u32> = surface.outgoing_ring(v).collect();
                let h = spokes[random.below(spokes.len())];
                let faces: Vec<u32> = spokes.iter().map(|h| h / 3).collect();
                let twin = surface.twin(h);
                if random.below(3) == 0 && twin != NONE {
                    let ends = [h, twin].map(|h| surface.origin((h / 3) * 3 + (h % 3 + 2) % 3));
                    if surface.are_neighbours(ends[0], ends[1]) {
                        continue;
                    }
                    let old = [h / 3, twin / 3];
                    let below: Vec<u32> = old
                        .iter()
                        .flat_map(|&face| samples.of(face).collect::<Vec<_>>())
                        .collect();
                    history.record(&old, NONE, &below, &surface, &samples);
                    surface.flip(h);
                } else if spokes.len() > 1 + usize::from(twin != NONE) && surface.can_collapse(h, v)
                {
                    let mut below: Vec<u32> = faces
                        .iter()
                        .flat_map(|&face| samples.of(face).collect::<Vec<_>>())
                        .collect();
                    below.push(v);
                    history.record(&faces, v, &below, &surface, &samples);
                    surface.collapse(h, v);
                    let left: Vec<u32> = faces
                        .iter()
                        .copied()
                        .filter(|&f| surface.corners(f)[0] != NONE)
                        .collect();
                    faces.iter().for_each(|&face| samples.clear(face));
                    for sample in below {
                        samples.give(left[random.below(left.len())], sample, 0.5);
                    }
                }
            }
            assert!(surface.faces_left() < fine.face_count() * 2 / 3, "{name}");
            let count = history.changes.len() as u32;
            let mut is_back = vec![false; count as usize];
            while let Some(change) = history.latest(0..fine.face_count() as u32) {
                // Any that is not back, so that others have to come first.
                let any = random.below(count as usize) as u32;
                let change = if is_back[any as usize] { change } else { any };
                let before = surface.faces_left();
                history.take_back(change, &mut surface, &mut samples, |_, _| {});
                assert!(surface.faces_left() >= before);
                for change in 0..count {
                    let faces = &history.faces[history.records(change).0];
                    is_back[change as usize] = faces.iter().any(|old| {
                        history.last[old.face as usize] == NONE
                            || history.last[old.face as usize] < change
                    });
                }
            }
            assert_eq!(surface.faces_left(), fine.face_count());
            for face in 0..fine.face_count() as u32 {
                assert_eq!(surface.corners(face), whole.corners(face), "{name}");
                assert_eq!(
                    (samples.of(face).count(), samples.error(face)),
                    (0, 0.0),
                    "{name}"
                );
                for h in 3 * face..3 * face + 3 {
                    assert_eq!(
                        (surface.twin(h), surface.is_sharp(h)),
                        (whole.twin(h), whole.is_sharp(h))
                    );
                }
            }
            for v in 0..fine.vertex_count() as u32 {
                let ring = |surface: &EditableMesh| surface.outgoing_ring(v).count();
                assert_eq!(
                    (ring(&surface), surface.is_boundary(v)),
                    (ring(&whole), whole.is_boundary(v)),
                    "{name}"
                );
            }
        }
    }
}
