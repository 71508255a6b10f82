//! Faces on the same three vertices: the first one stays. Of faces without area pairs go altogether: they fill
//! a slit from both sides, which is then closed.

use super::triangulate::{Faces, Flatness};
use crate::mesh::Diagnosis;

/// Drops faces that repeat an earlier one, from any first corner and in either orientation.
pub(super) fn drop_repeated(faces: &mut Faces, flatness: Flatness<'_>, diagnosis: &mut Diagnosis) {
    let mut marked = Vec::new();
    for_each_repetition(&faces.triangles, flatness.positions.len(), |group| {
        marked.resize(faces.triangles.len(), false);
        let stay = if flatness.is_flat(faces, group[0]) {
            group.len() % 2
        } else {
            1
        };
        group[stay..]
            .iter()
            .for_each(|&face| marked[face as usize] = true);
    });
    if marked.is_empty() {
        return;
    }
    let dropped = faces
        .inputs
        .iter()
        .zip(&marked)
        .filter(|(_, marked)| **marked);
    diagnosis
        .repeated_faces
        .add_all(dropped.map(|(&input, _)| input).collect());
    faces.drop_marked(&marked);
}

/// Calls `visit` with the ascending ids of each two or more faces that have the same vertices.
pub(super) fn for_each_repetition(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    mut visit: impl FnMut(&[u32]),
) {
    // Faces by their lowest vertex (a counting sort), and among these by the other two.
    let lowest = |t: &[u32; 3]| t[0].min(t[1]).min(t[2]);
    let mut starts = vec![0u32; vertex_count + 1];
    for t in triangles {
        starts[lowest(t) as usize + 1] += 1;
    }
    for v in 0..vertex_count {
        starts[v + 1] += starts[v];
    }
    let mut fill = starts.clone();
    let mut lists = vec![0u32; triangles.len()];
    for (face, t) in triangles.iter().enumerate() {
        let slot = &mut fill[lowest(t) as usize];
        lists[*slot as usize] = face as u32;
        *slot += 1;
    }
    drop(fill);
    let key = |face: u32| {
        let mut t = triangles[face as usize];
        t.sort_unstable();
        (t[1], t[2])
    };
    let mut keyed: Vec<((u32, u32), u32)> = Vec::new();
    let mut group = Vec::new();
    for v in 0..vertex_count {
        let list = &lists[starts[v] as usize..starts[v + 1] as usize];
        if list.len() < 2 {
            continue;
        }
        keyed.clear();
        keyed.extend(list.iter().map(|&face| (key(face), face)));
        keyed.sort_unstable();
        for run in keyed
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|run| run.len() > 1)
        {
            group.clear();
            group.extend(run.iter().map(|&(_, face)| face));
            visit(&group);
        }
    }
}
