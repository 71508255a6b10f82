//! The defects of a soup, repaired on the way to a mesh.

use core::fmt;

/// The number of findings of a kind, and the first of them.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Finding {
    /// The number of findings.
    pub count: usize,
    /// The first few, in the input's numbering and in ascending order.
    pub first: Vec<u32>,
}

impl Finding {
    /// The number of elements that a finding names.
    pub const NAMED: usize = 8;

    /// Counts one more at `place`, which must not be below an earlier one.
    pub fn add(&mut self, place: u32) {
        self.count += 1;
        if self.first.len() < Self::NAMED {
            self.first.push(place);
        }
    }

    /// Counts all of `places`, which may come in any order.
    pub(crate) fn add_all(&mut self, mut places: Vec<u32>) {
        self.count += places.len();
        places.append(&mut self.first);
        places.sort_unstable();
        places.truncate(Self::NAMED);
        self.first = places;
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// The findings of a build. Faces and vertices are named as in the input, counted from 0.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Diagnosis {
    /// Positions in the input.
    pub input_vertices: usize,
    /// Polygons in the input.
    pub input_faces: usize,
    /// Faces with more than three corners, cut into triangles (no defect).
    pub polygons: Finding,
    /// Vertices that were merged into an earlier one: at one position, or within the given
    /// distance; neither is a defect.
    pub welded_vertices: Finding,
    /// Faces with fewer than three corners, or whose corners fell together.
    pub collapsed_faces: Finding,
    /// Polygons that are not flat and cross themselves in the projection along their normal (no
    /// defect): their triangles bridge them, but no choice of diagonals is free of folds.
    pub twisted_polygons: Finding,
    /// Faces with three different corners on one line.
    pub zero_area_faces: Finding,
    /// Faces that repeat an earlier one, in either orientation.
    pub repeated_faces: Finding,
    /// Vertices in no face.
    pub isolated_vertices: Finding,
    /// Faces turned round to agree with their neighbours.
    pub flipped_faces: Finding,
    /// Closed components whose normals pointed inwards, turned round: named by their lowest face.
    pub inside_out_components: Finding,
    /// Faces that were cut apart since they run against each other: along a one-sided (non-orientable) component, or where none was to be
    /// turned.
    pub non_orientable_faces: Finding,
    /// Edges with more than two faces, named by their lower vertex.
    pub non_manifold_edges: Finding,
    /// Vertices whose faces form several fans.
    pub bow_tie_vertices: Finding,
    /// Tags that name no vertex or edge of the mesh, by their index among the input's tags (creases
    /// first).
    pub dropped_tags: Finding,
    /// Corners with a sector of 180° and more that was divided by sharp edges (no defect), named by
    /// their vertices in the mesh. The caller of
    /// [`Mesh::with_divided_concave_corners`](super::Mesh::with_divided_concave_corners) adds them.
    pub concave_corners: Finding,
}

/// The words of a finding.
struct Wording {
    /// In reports: the field's name.
    name: &'static str,
    defect: bool,
    /// One of it, and many of it.
    nouns: [&'static str; 2],
    /// The repair.
    repair: &'static str,
    /// The kind of element that its numbers name.
    place: &'static str,
}

const fn wording(
    name: &'static str,
    defect: bool,
    nouns: [&'static str; 2],
    repair: &'static str,
    place: &'static str,
) -> Wording {
    Wording {
        name,
        defect,
        nouns,
        repair,
        place,
    }
}

/// In the order of the struct's fields.
const WORDINGS: [Wording; 14] = [
    wording(
        "polygons",
        false,
        [
            "face with more than three corners",
            "faces with more than three corners",
        ],
        "cut into triangles",
        "face",
    ),
    wording(
        "welded_vertices",
        false,
        [
            "vertex at the place of another",
            "vertices at the place of another",
        ],
        "merged",
        "vertex",
    ),
    wording(
        "collapsed_faces",
        true,
        [
            "face with fewer than three different corners",
            "faces with fewer than three different corners",
        ],
        "left out",
        "face",
    ),
    wording(
        "twisted_polygons",
        false,
        [
            "polygon that crosses itself",
            "polygons that cross themselves",
        ],
        "cut into triangles as well as possible",
        "face",
    ),
    wording(
        "zero_area_faces",
        true,
        ["face without area", "faces without area"],
        "removed",
        "face",
    ),
    wording(
        "repeated_faces",
        true,
        ["face that repeats another", "faces that repeat another"],
        "left out",
        "face",
    ),
    wording(
        "isolated_vertices",
        true,
        ["vertex in no face", "vertices in no face"],
        "left out",
        "vertex",
    ),
    wording(
        "flipped_faces",
        true,
        [
            "face turned against its neighbours",
            "faces turned against their neighbours",
        ],
        "turned round",
        "face",
    ),
    wording(
        "inside_out_components",
        true,
        [
            "closed component that is inside out",
            "closed components that are inside out",
        ],
        "turned round",
        "face",
    ),
    wording(
        "non_orientable_faces",
        true,
        [
            "face that meets its neighbour the wrong way round",
            "faces that meet their neighbours the wrong way round",
        ],
        "cut open there",
        "face",
    ),
    wording(
        "non_manifold_edges",
        true,
        [
            "edge with more than two faces",
            "edges with more than two faces",
        ],
        "cut into sheets",
        "lower vertex",
    ),
    wording(
        "bow_tie_vertices",
        true,
        [
            "vertex where sheets touch at a point",
            "vertices where sheets touch at a point",
        ],
        "cut into one vertex a sheet",
        "vertex",
    ),
    wording(
        "dropped_tags",
        true,
        [
            "crease or corner tag without an edge or vertex in the mesh",
            "crease or corner tags without an edge or vertex in the mesh",
        ],
        "left out",
        "tag",
    ),
    wording(
        "concave_corners",
        false,
        ["corner of 180° or more", "corners of 180° or more"],
        "divided by sharp edges, so that flat faces stay flat",
        "vertex",
    ),
];

impl Diagnosis {
    fn in_order(&self) -> [&Finding; WORDINGS.len()] {
        [
            &self.polygons,
            &self.welded_vertices,
            &self.collapsed_faces,
            &self.twisted_polygons,
            &self.zero_area_faces,
            &self.repeated_faces,
            &self.isolated_vertices,
            &self.flipped_faces,
            &self.inside_out_components,
            &self.non_orientable_faces,
            &self.non_manifold_edges,
            &self.bow_tie_vertices,
            &self.dropped_tags,
            &self.concave_corners,
        ]
    }

    /// All findings with their names (those of the fields), in a fixed order, empty ones included.
    pub fn findings(&self) -> impl Iterator<Item = (&'static str, &Finding)> {
        WORDINGS
            .iter()
            .zip(self.in_order())
            .map(|(wording, finding)| (wording.name, finding))
    }

    /// Whether the input had no defect: nothing was done but to triangulate polygons and to weld
    /// vertices. [`strict`](super::BuildOptions::strict) requires this.
    pub fn is_clean(&self) -> bool {
        WORDINGS
            .iter()
            .zip(self.in_order())
            .all(|(wording, finding)| !wording.defect || finding.is_empty())
    }

    /// A line for each kind of defect, with its repair.
    pub fn repairs(&self) -> Vec<String> {
        self.lines(true, Wording::line)
    }

    /// A line for each finding that is no defect, with its treatment.
    pub fn preparations(&self) -> Vec<String> {
        self.lines(false, Wording::line)
    }

    /// The defects in one line, for errors.
    pub(crate) fn defects(&self) -> String {
        self.lines(true, |wording, finding| wording.found(finding, ""))
            .join("; ")
    }

    fn lines(&self, defects: bool, format: impl Fn(&Wording, &Finding) -> String) -> Vec<String> {
        let all = WORDINGS.iter().zip(self.in_order());
        let found =
            all.filter(|(wording, finding)| wording.defect == defects && !finding.is_empty());
        found
            .map(|(wording, finding)| format(wording, finding))
            .collect()
    }
}

impl Wording {
    /// For example `2 faces without area: removed (face 4, 9)`.
    fn line(&self, finding: &Finding) -> String {
        self.found(finding, &format!(": {}", self.repair))
    }

    /// A finding's message with other words, or none, before the numbers.
    fn found(&self, finding: &Finding, words: &str) -> String {
        let noun = self.nouns[usize::from(finding.count != 1)];
        let mut places = finding
            .first
            .iter()
            .map(u32::to_string)
            .collect::<Vec<_>>()
            .join(", ");
        if finding.count > finding.first.len() {
            places.push_str(", …");
        }
        format!("{} {noun}{words} ({} {places})", finding.count, self.place)
    }
}

/// A line for each finding, without a line feed at the end; nothing where there is none.
impl fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&[self.preparations(), self.repairs()].concat().join("\n"))
    }
}
