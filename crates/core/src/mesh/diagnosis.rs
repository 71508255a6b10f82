//! What was found in a soup and repaired on the way to a mesh.

use core::fmt;

/// How often something was found, and where first.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Finding {
    /// How many there are.
    pub count: usize,
    /// The first few, in the input's numbering and in ascending order.
    pub first: Vec<u32>,
}

impl Finding {
    /// How many places a finding names.
    pub const NAMED: usize = 8;

    /// Counts one more at `place`, which must not lie before an earlier one.
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
    /// Vertices that were merged into an earlier one: at the same place (no defect), or within a distance
    /// that was asked for (no defect either).
    pub welded_vertices: Finding,
    /// Faces with fewer than three corners, or whose corners fell together.
    pub collapsed_faces: Finding,
    /// Polygons so far from flat that they cross themselves seen along their normal (no defect): their
    /// triangles bridge them, but no choice of diagonals is free of folds.
    pub twisted_polygons: Finding,
    /// Faces with three different corners on one line.
    pub zero_area_faces: Finding,
    /// Faces that repeat an earlier one, whichever way round.
    pub repeated_faces: Finding,
    /// Vertices in no face.
    pub isolated_vertices: Finding,
    /// Faces turned round to agree with their neighbours.
    pub flipped_faces: Finding,
    /// Faces along which a one-sided (non-orientable) component was cut.
    pub non_orientable_faces: Finding,
    /// Edges with more than two faces, named by their lower vertex.
    pub non_manifold_edges: Finding,
    /// Vertices whose faces form several fans.
    pub bow_tie_vertices: Finding,
    /// Tags that name no vertex or edge of the mesh, by their place among the input's tags (creases first).
    pub dropped_tags: Finding,
}

/// A finding's name in reports, whether it is a defect, its noun for one and for many, and what was done.
struct Wording {
    name: &'static str,
    defect: bool,
    one: &'static str,
    many: &'static str,
    repair: &'static str,
}

const fn wording(
    name: &'static str,
    defect: bool,
    one: &'static str,
    many: &'static str,
    repair: &'static str,
) -> Wording {
    Wording { name, defect, one, many, repair }
}

/// In the order of the struct's fields.
const WORDINGS: [Wording; 12] = [
    wording("polygons", false, "polygon", "polygons", "triangulated"),
    wording("welded_vertices", false, "vertex", "vertices", "welded to an earlier one"),
    wording("collapsed_faces", true, "collapsed face", "collapsed faces", "dropped"),
    wording(
        "twisted_polygons",
        false,
        "polygon that crosses itself seen along its normal",
        "polygons that cross themselves seen along their normals",
        "triangulated as it may be",
    ),
    wording("zero_area_faces", true, "face of zero area", "faces of zero area", "removed"),
    wording("repeated_faces", true, "repeated face", "repeated faces", "dropped"),
    wording("isolated_vertices", true, "isolated vertex", "isolated vertices", "dropped"),
    wording("flipped_faces", true, "face", "faces", "turned round to agree with the neighbours"),
    wording(
        "non_orientable_faces",
        true,
        "face of a one-sided component",
        "faces of one-sided components",
        "cut apart",
    ),
    wording(
        "non_manifold_edges",
        true,
        "edge with more than two faces",
        "edges with more than two faces",
        "cut into sheets",
    ),
    wording("bow_tie_vertices", true, "bow-tie vertex", "bow-tie vertices", "cut into fans"),
    wording("dropped_tags", true, "tag that names nothing", "tags that name nothing", "dropped"),
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
            &self.non_orientable_faces,
            &self.non_manifold_edges,
            &self.bow_tie_vertices,
            &self.dropped_tags,
        ]
    }

    /// All findings with their names (those of the fields), in a fixed order, empty ones included.
    pub fn findings(&self) -> impl Iterator<Item = (&'static str, &Finding)> {
        WORDINGS.iter().zip(self.in_order()).map(|(wording, finding)| (wording.name, finding))
    }

    /// Whether the input had no defect: nothing was done but to triangulate polygons and to weld vertices. This is what
    /// [`strict`](super::BuildOptions::strict) asks for.
    pub fn is_clean(&self) -> bool {
        WORDINGS.iter().zip(self.in_order()).all(|(wording, finding)| !wording.defect || finding.is_empty())
    }

    /// The defects in one line, for errors.
    pub(crate) fn defects(&self) -> String {
        let defects = WORDINGS.iter().zip(self.in_order()).filter(|(w, f)| w.defect && !f.is_empty());
        defects.map(|(w, f)| describe(w, f)).collect::<Vec<_>>().join("; ")
    }
}

/// For example `2 repeated faces (4, 9)`.
fn describe(wording: &Wording, finding: &Finding) -> String {
    let noun = if finding.count == 1 { wording.one } else { wording.many };
    let mut places = finding.first.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
    if finding.count > finding.first.len() {
        places.push_str(", …");
    }
    format!("{} {noun} ({places})", finding.count)
}

/// A line for each finding, without a line feed at the end; nothing where there is none.
impl fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let found = WORDINGS.iter().zip(self.in_order()).filter(|(_, finding)| !finding.is_empty());
        for (line, (wording, finding)) in found.enumerate() {
            let break_before = if line == 0 { "" } else { "\n" };
            write!(f, "{break_before}{}: {}", describe(wording, finding), wording.repair)?;
        }
        Ok(())
    }
}
