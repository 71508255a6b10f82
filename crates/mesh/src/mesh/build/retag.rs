//! The soup's crease and corner tags on the vertices and edges of the mesh.

use super::cut::Middle;
use crate::geometry::NONE;
use crate::index::VertexId;
use crate::mesh::{CornerTag, CreaseTag, Diagnosis, PolygonSoup, Tags, Topology};

/// How the soup's vertices and the mesh's belong together.
pub(super) struct VertexMaps<'a> {
    /// The vertex before cutting of each input vertex, or [`NONE`].
    pub(super) from_input: &'a [u32],
    /// Vertices before cutting.
    pub(super) vertex_count: usize,
    /// The original vertex of each copy.
    pub(super) copied: &'a [u32],
    /// Edges that were split in the middle.
    pub(super) middles: &'a [Middle],
}

impl VertexMaps<'_> {
    pub(super) fn vertex(&self, input: u32) -> Option<u32> {
        self.from_input
            .get(input as usize)
            .copied()
            .filter(|&v| v != NONE)
    }

    pub(super) fn original(&self, v: VertexId) -> u32 {
        v.index()
            .checked_sub(self.vertex_count)
            .map_or(v.0, |copy| self.copied[copy])
    }
}

/// Tags of a vertex or edge go to all its copies; `fixed` vertices become corners as well.
pub(super) fn retag(
    soup: &PolygonSoup,
    topology: &Topology,
    maps: &VertexMaps<'_>,
    fixed: &[u32],
    diagnosis: &mut Diagnosis,
) -> Tags {
    let creases = retag_creases(&soup.creases, topology, maps, diagnosis);
    let mut corners: Vec<CornerTag> = fixed
        .iter()
        .map(|&vertex| CornerTag {
            vertex,
            sharpness: f64::INFINITY,
        })
        .collect();
    let mut sharpness: Vec<(u32, f64)> = Vec::new();
    for (i, tag) in soup.corners.iter().enumerate() {
        match maps.vertex(tag.vertex) {
            Some(v) if tag.sharpness >= 0.0 => sharpness.push((v, tag.sharpness)),
            _ => diagnosis.dropped_tags.add((soup.creases.len() + i) as u32),
        }
    }
    if !sharpness.is_empty() {
        sharpness.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
        sharpness.dedup_by_key(|&mut (v, _)| v);
        for v in topology.vertices() {
            if let Ok(i) = sharpness.binary_search_by_key(&maps.original(v), |&(v, _)| v) {
                corners.push(CornerTag {
                    vertex: v.0,
                    sharpness: sharpness[i].1,
                });
            }
        }
    }
    let mut tags = Tags {
        creases,
        corners: Vec::new(),
    };
    tags.add_corners(corners);
    tags
}

/// A crease between two vertices before cutting (the lower first), its sharpness and its place in the input.
type Wanted = ([u32; 2], f64, u32);

/// Of several tags on one edge the sharpest counts.
fn retag_creases(
    creases: &[CreaseTag],
    topology: &Topology,
    maps: &VertexMaps<'_>,
    diagnosis: &mut Diagnosis,
) -> Vec<CreaseTag> {
    // By the edge's ends, sharpest first; the place among the input's tags decides the order of the output.
    let mut wanted: Vec<Wanted> = Vec::with_capacity(creases.len());
    let mut dropped = Vec::new();
    for (place, tag) in creases.iter().enumerate() {
        let place = place as u32;
        match tag.vertices.map(|v| maps.vertex(v)) {
            [Some(a), Some(b)] if a != b && tag.sharpness >= 0.0 => {
                wanted.push(([a.min(b), a.max(b)], tag.sharpness, place));
            }
            _ => dropped.push(place),
        }
    }
    let order =
        |a: &Wanted, b: &Wanted| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)).then(a.2.cmp(&b.2));
    wanted.sort_unstable_by(order);
    split_creases(&mut wanted, maps.middles);
    wanted.sort_unstable_by(order);
    let mut found: Vec<(u32, CreaseTag)> = Vec::with_capacity(wanted.len());
    let mut is_found = vec![false; wanted.len()];
    if !wanted.is_empty() {
        for h in topology
            .half_edges()
            .filter(|&h| topology.twin(h).is_none_or(|twin| h < twin))
        {
            let [a, b] = topology.ends(h);
            let ends = [maps.original(a), maps.original(b)];
            let ends = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let i = wanted.partition_point(|tag| tag.0 < ends);
            if let Some(&(_, sharpness, place)) = wanted.get(i).filter(|tag| tag.0 == ends) {
                is_found[i] = true;
                found.push((
                    place,
                    CreaseTag {
                        vertices: [a.0, b.0],
                        sharpness,
                    },
                ));
            }
        }
    }
    // A further tag on an edge that was found is no loss.
    for i in 0..wanted.len() {
        if i > 0 && wanted[i].0 == wanted[i - 1].0 {
            is_found[i] = is_found[i - 1];
        }
        if !is_found[i] {
            dropped.push(wanted[i].2);
        }
    }
    diagnosis.dropped_tags.add_all(dropped);
    found.sort_by_key(|&(place, _)| place);
    found.into_iter().map(|(_, tag)| tag).collect()
}

/// Replaces the creases along edges that were split by creases along both halves.
fn split_creases(wanted: &mut Vec<Wanted>, middles: &[Middle]) {
    let mut halves: Vec<Wanted> = Vec::new();
    let mut split = Vec::new();
    for middle in middles {
        let [a, b] = middle.ends;
        let ends = [a.min(b), a.max(b)];
        let start = wanted.partition_point(|tag| tag.0 < ends);
        for (i, tag) in wanted
            .iter()
            .enumerate()
            .skip(start)
            .take_while(|(_, tag)| tag.0 == ends)
        {
            // Any end of the split edge is lower than the vertex in its middle.
            halves.extend([a, b].map(|end| ([end, middle.vertex], tag.1, tag.2)));
            split.push(i);
        }
    }
    // From the back, so that the places before keep their meaning.
    split.sort_unstable();
    for &i in split.iter().rev() {
        wanted.swap_remove(i);
    }
    wanted.extend(halves);
}
