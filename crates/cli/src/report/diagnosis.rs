//! What was found in the input: each finding with its count and the first few places, and in words.

use limitmesh::mesh::{Diagnosis, Finding};
use serde::Serialize;

use crate::words::thousands;

/// One finding: how many, and the first few by their number in the input, counted from 0.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct FindingReport {
    pub(crate) count: usize,
    pub(crate) first: Vec<u32>,
}

impl From<&Finding> for FindingReport {
    fn from(finding: &Finding) -> Self {
        Self { count: finding.count, first: finding.first.clone() }
    }
}

/// All findings, whether or not something was found.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct DiagnosisReport {
    /// Whether nothing had to be repaired; polygons and equal positions are no defects.
    pub(crate) clean: bool,
    pub(crate) polygons: FindingReport,
    pub(crate) welded_vertices: FindingReport,
    pub(crate) collapsed_faces: FindingReport,
    pub(crate) zero_area_faces: FindingReport,
    pub(crate) repeated_faces: FindingReport,
    pub(crate) isolated_vertices: FindingReport,
    pub(crate) flipped_faces: FindingReport,
    pub(crate) non_orientable_faces: FindingReport,
    pub(crate) non_manifold_edges: FindingReport,
    pub(crate) bow_tie_vertices: FindingReport,
    pub(crate) dropped_tags: FindingReport,
}

impl From<&Diagnosis> for DiagnosisReport {
    fn from(d: &Diagnosis) -> Self {
        Self {
            clean: repairs_in_words(d).is_empty(),
            polygons: (&d.polygons).into(),
            welded_vertices: (&d.welded_vertices).into(),
            collapsed_faces: (&d.collapsed_faces).into(),
            zero_area_faces: (&d.zero_area_faces).into(),
            repeated_faces: (&d.repeated_faces).into(),
            isolated_vertices: (&d.isolated_vertices).into(),
            flipped_faces: (&d.flipped_faces).into(),
            non_orientable_faces: (&d.non_orientable_faces).into(),
            non_manifold_edges: (&d.non_manifold_edges).into(),
            bow_tie_vertices: (&d.bow_tie_vertices).into(),
            dropped_tags: (&d.dropped_tags).into(),
        }
    }
}

/// How a finding is told: one of it, many of it, what is done about it, what its numbers name.
type Telling = [&'static str; 4];

const POLYGONS: Telling =
    ["face with more than three corners", "faces with more than three corners", "cut into triangles", "face"];
const WELDED: Telling =
    ["vertex at the place of another", "vertices at the place of another", "merged", "vertex"];
const COLLAPSED: Telling = [
    "face with fewer than three different corners",
    "faces with fewer than three different corners",
    "left out",
    "face",
];
const ZERO_AREA: Telling = ["face without area", "faces without area", "left out", "face"];
const REPEATED: Telling = ["face that repeats another", "faces that repeat another", "left out", "face"];
const ISOLATED: Telling = ["vertex in no face", "vertices in no face", "left out", "vertex"];
const FLIPPED: Telling =
    ["face turned against its neighbours", "faces turned against their neighbours", "turned round", "face"];
const NON_ORIENTABLE: Telling = [
    "face where a one-sided surface meets itself the wrong way round",
    "faces where a one-sided surface meets itself the wrong way round",
    "cut open there",
    "face",
];
const NON_MANIFOLD: Telling =
    ["edge with more than two faces", "edges with more than two faces", "cut into sheets", "lower vertex"];
const BOW_TIES: Telling = [
    "vertex where sheets touch at a point",
    "vertices where sheets touch at a point",
    "cut into one vertex a sheet",
    "vertex",
];
const DROPPED_TAGS: Telling = [
    "crease or corner tag of nothing in the mesh",
    "crease or corner tags of nothing in the mesh",
    "left out",
    "tag",
];

fn line((finding, [one, many, remedy, place]): (&Finding, Telling)) -> Option<String> {
    if finding.is_empty() {
        return None;
    }
    let what = if finding.count == 1 { one } else { many };
    let mut places: Vec<String> = finding.first.iter().map(u32::to_string).collect();
    if finding.count > places.len() {
        places.push("…".to_owned());
    }
    Some(format!("{} {what}: {remedy} ({place} {})", thousands(finding.count), places.join(", ")))
}

/// A line for each kind of defect that was found and repaired.
pub(crate) fn repairs_in_words(d: &Diagnosis) -> Vec<String> {
    let defects = [
        (&d.collapsed_faces, COLLAPSED),
        (&d.zero_area_faces, ZERO_AREA),
        (&d.repeated_faces, REPEATED),
        (&d.isolated_vertices, ISOLATED),
        (&d.flipped_faces, FLIPPED),
        (&d.non_orientable_faces, NON_ORIENTABLE),
        (&d.non_manifold_edges, NON_MANIFOLD),
        (&d.bow_tie_vertices, BOW_TIES),
        (&d.dropped_tags, DROPPED_TAGS),
    ];
    defects.into_iter().filter_map(line).collect()
}

/// A line for each property that needs preparation but is no defect.
pub(crate) fn preparations_in_words(d: &Diagnosis) -> Vec<String> {
    [(&d.polygons, POLYGONS), (&d.welded_vertices, WELDED)].into_iter().filter_map(line).collect()
}
