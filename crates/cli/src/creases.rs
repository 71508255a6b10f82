//! Edges that a file says are sharp in other words than by tags: by normals that differ between two faces, by smoothing groups, by
//! the borders of materials.

use limitmesh::Mesh;
use limitmesh::mesh::{Channel, Domain, Semantic};
use limitmesh::{FaceId, HalfEdgeId};
use limitmesh_io::channels::{GROUP, MATERIAL, OBJECT, SMOOTHING_GROUP};

use crate::arguments::CreasesFrom;
use crate::failure::usage;
use crate::vector::{cross, length, vector};

/// Normals are one if they differ by less: their numbers are rounded, by 4 digits and more.
const SAME: f64 = 1e-3;

/// The sine of the angle between faces that are not in one plane, 1°.
const BENT: f64 = 0.0175;

/// A file's hints of sharp edges, on a mesh's corners and faces.
pub(crate) struct Hints<'a> {
    /// Whether it tags edges or vertices.
    pub(crate) is_tagged: bool,
    pub(crate) normals: Option<&'a Channel>,
    pub(crate) channels: &'a [Channel],
}

/// The kind of a file's own sharp edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OwnSharpness {
    /// Nothing.
    None,
    /// So many have normals that differ between their faces.
    Normals(usize),
    /// By tags, or by several smoothing groups.
    Tags,
}

impl Hints<'_> {
    /// The edges that are to be sharp, each once; `name` is the file's.
    ///
    /// # Errors
    /// The file says nothing of that kind.
    pub(crate) fn edges(
        &self,
        mesh: &Mesh,
        from: CreasesFrom,
        name: &str,
    ) -> anyhow::Result<Vec<HalfEdgeId>> {
        let of_faces = |channel: &&Channel| {
            channel.domain == Domain::Face && channel.semantic == Semantic::Label
        };
        let labels = |is_own: &dyn Fn(&str) -> bool| -> Vec<&Channel> {
            self.channels
                .iter()
                .filter(of_faces)
                .filter(|channel| is_own(&channel.name))
                .collect()
        };
        let (found, what) = match from {
            CreasesFrom::None => return Ok(Vec::new()),
            CreasesFrom::Normals => match self.normals {
                Some(normals) => return Ok(split_edges(mesh, normals)),
                None => (Vec::new(), "normals"),
            },
            CreasesFrom::SmoothingGroups => {
                (labels(&|name| name == SMOOTHING_GROUP), "smoothing groups")
            }
            CreasesFrom::Materials => (
                labels(&|name| ![OBJECT, GROUP, SMOOTHING_GROUP].contains(&name)),
                MATERIAL,
            ),
        };
        if found.is_empty() {
            return usage(format!("--creases-from: {name} has no {what}"));
        }
        let is_border = |a: FaceId, b: FaceId| {
            found
                .iter()
                .any(|channel| differ(channel, a.index(), b.index()))
        };
        Ok(inner_edges(mesh, |h, twin| {
            is_border(h.face(), twin.face())
        }))
    }

    /// The hint that makes some edges sharp, and others not.
    pub(crate) fn sharpness(&self, mesh: &Mesh) -> OwnSharpness {
        let mut groups = self
            .channels
            .iter()
            .filter(|channel| channel.name == SMOOTHING_GROUP);
        let differ = |h: HalfEdgeId, twin: HalfEdgeId, channel: &Channel| {
            differ(channel, h.face().index(), twin.face().index())
        };
        let have_borders = |channel: &Channel| {
            let is_one = channel
                .indices
                .iter()
                .all(|&index| index == channel.indices[0]);
            !is_one && !inner_edges(mesh, |h, twin| differ(h, twin, channel)).is_empty()
        };
        if self.is_tagged || groups.any(have_borders) {
            return OwnSharpness::Tags;
        }
        match self
            .normals
            .map_or(0, |normals| telling_edges(mesh, normals))
        {
            0 => OwnSharpness::None,
            edges => OwnSharpness::Normals(edges),
        }
    }

    /// How many edges have normals that differ between their faces.
    pub(crate) fn split_edges(&self, mesh: &Mesh) -> usize {
        self.normals
            .map_or(0, |normals| split_edges(mesh, normals).len())
    }
}

/// Edges inside, once each, that are as asked.
fn inner_edges(mesh: &Mesh, is_own: impl Fn(HalfEdgeId, HalfEdgeId) -> bool) -> Vec<HalfEdgeId> {
    let topology = mesh.topology();
    let inner = |h: &HalfEdgeId| {
        topology
            .twin(*h)
            .is_some_and(|twin| *h < twin && is_own(*h, twin))
    };
    topology.half_edges().filter(inner).collect()
}

/// Edges at one end of which the normals of their faces differ: at the other they are one where the crease ends.
fn split_edges(mesh: &Mesh, normals: &Channel) -> Vec<HalfEdgeId> {
    let unit = |h: HalfEdgeId| {
        let own = vector(normals.value(h.index()));
        let length = own.iter().map(|x| x * x).sum::<f64>().sqrt();
        (length > 0.0).then(|| own.map(|x| x / length))
    };
    let differ = |a: HalfEdgeId, b: HalfEdgeId| match (unit(a), unit(b)) {
        (Some(a), Some(b)) => (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>() > SAME * SAME,
        _ => false,
    };
    inner_edges(mesh, |h, twin| {
        differ(h, twin.next()) || differ(h.next(), twin)
    })
}

/// How many edges have normals that differ, if these are the same on both sides of others where faces meet at an angle: facets that are
/// shaded flat say nothing of their edges.
fn telling_edges(mesh: &Mesh, normals: &Channel) -> usize {
    let split = split_edges(mesh, normals);
    let is_bent = |h: HalfEdgeId, twin: HalfEdgeId| {
        let [m, n] = [h, twin].map(|h| mesh.face_normal(h.face()));
        length(cross(m, n)) > BENT * length(m) * length(n)
    };
    let is_smooth =
        |h: HalfEdgeId, twin: HalfEdgeId| is_bent(h, twin) && split.binary_search(&h).is_err();
    if split.is_empty() || inner_edges(mesh, is_smooth).is_empty() {
        0
    } else {
        split.len()
    }
}

/// Whether the edge between two faces is a border of what they are labelled with.
fn differ(channel: &Channel, a: usize, b: usize) -> bool {
    let (own, other) = (channel.indices[a], channel.indices[b]);
    // Faces in no smoothing group are smooth with no other.
    let is_off = |number: u32| {
        channel.name == SMOOTHING_GROUP
            && channel
                .labels
                .get(number as usize)
                .is_some_and(|name| name == "off" || name == "0")
    };
    if channel.labels.is_empty() {
        channel.value(a) != channel.value(b)
    } else {
        own != other || is_off(own)
    }
}
