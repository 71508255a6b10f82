//! What was found in the input: each finding with its count and the first few places, and in words.

use std::collections::BTreeMap;

use limitmesh::mesh::{Diagnosis, Finding};
use serde::Serialize;

use crate::format::thousands;

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
    /// By the library's names of the findings.
    #[serde(flatten)]
    pub(crate) findings: BTreeMap<&'static str, FindingReport>,
}

impl From<&Diagnosis> for DiagnosisReport {
    fn from(d: &Diagnosis) -> Self {
        let findings = d.findings().map(|(name, finding)| (name, finding.into())).collect();
        Self { clean: d.is_clean(), findings }
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
const TWISTED: Telling = [
    "polygon that crosses itself",
    "polygons that cross themselves",
    "cut into triangles as well as may be",
    "face",
];
const ZERO_AREA: Telling = ["face without area", "faces without area", "removed", "face"];
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
    let preparations =
        [(&d.polygons, POLYGONS), (&d.twisted_polygons, TWISTED), (&d.welded_vertices, WELDED)];
    preparations.into_iter().filter_map(line).collect()
}
