//! The surroundings of a face without their points: connectivity and tags. What a step of refinement makes of them is a linear map of the points,
//! found once for all surroundings of one form.
//!
//! Takes small meshes; gives weights. A step leaves few irregular vertices and tags near each part, so that nearly all pieces of a surface
//! are of a few forms, whatever the control mesh is.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock, PoisonError, RwLock, Weak};

use super::child_corners;
use super::submesh::{quartered, submesh_of};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::limit::{LimitError, LimitTable};
use crate::masks::Masks;
use crate::mesh::{Junctions, Mesh, Sharpness};
use crate::row::{Row, sum, summed};
use crate::scheme::Scheme;
use crate::vector::DVec3;

/// The rings of faces around a face that decide the surface over it: the points within distance 2 of a part depend on points within distance
/// 2 of the face, by masks on whole rings of points within distance 1.
const RINGS: usize = 2;

/// Forms that are kept at most, of control faces and in all: some 15 kB each. Those of an irregular mesh's control faces are all different, and
/// each is asked for a few times.
const MOST_ROOTS: usize = 1 << 10;
const MOST_FORMS: usize = 1 << 12;

/// Tangents that are longer than this part of the differences that they are sums of, and whose angle has a greater sine, span a plane
/// whatever rounding does.
const CLEAR: f64 = 1e-4;

/// Levels below a piece whose vertices are sampled where nothing can be certified: over an evenly curved piece the greatest
/// height is met within 2 per cent.
pub const SAMPLED_LEVELS: usize = 3;

/// Barycentric coordinates, multiplied by a power of 2.
pub type GridPoint = [i32; 3];

/// Where limits stand over a face, and the weights of all points of the form in each.
type Samples = Vec<(GridPoint, Vec<f64>)>;

/// The surroundings of a face, which is the first of a small mesh.
#[derive(Debug)]
pub(super) struct MeshForm {
    /// Its positions mean nothing.
    pub(super) mesh: Mesh,
    step: OnceLock<Step>,
    /// By levels, from one on.
    samples: [OnceLock<Result<Samples, LimitError>>; SAMPLED_LEVELS],
}

/// The result of a step of refinement of surroundings.
#[derive(Debug)]
pub(super) struct Step {
    /// The surroundings of the four parts, which are the first faces, each from its first corner. Positions mean nothing.
    mesh: Mesh,
    /// Its points, by those before the step.
    rows: Vec<Row>,
    /// The limits of the new vertices on the face's edges, by the points of [`Self::mesh`].
    middles: [Result<Middle, LimitError>; 3],
    parts: [Part; 4],
}

/// The limit of a new vertex, on the face's side.
#[derive(Debug)]
struct Middle {
    position: Row,
    /// Empty without a tangent plane.
    tangents: [Row; 2],
}

/// The surroundings of a part.
#[derive(Debug)]
struct Part {
    /// Where they are kept. Forms hold no others: the parts of a regular one are of the same form.
    form: Weak<MeshForm>,
    /// Its points among those of the step.
    points: Vec<VertexId>,
}

/// The face of a half-edge with its surroundings, and the vertex of the mesh that each of their points is.
pub(super) fn surroundings(
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    first: HalfEdgeId,
) -> (Mesh, Vec<VertexId>) {
    submesh_of(mesh, sharpness, &[first], RINGS)
}

/// The part `part` of the face that became faces 0 to 3: which half-edge leaves its first corner. Steps start the parts
/// at the old corner, and the middle one at the first new vertex.
fn first_of_part(part: usize) -> HalfEdgeId {
    HalfEdgeId::of(FaceId(part as u32), [0, 2, 1, 1][part])
}

impl MeshForm {
    fn new(mesh: Mesh) -> Self {
        Self {
            mesh,
            step: OnceLock::new(),
            samples: Default::default(),
        }
    }

    /// The limits of all vertices so many levels below, the corners left out.
    pub(super) fn samples(&self, levels: usize, forms: &Forms<'_>) -> Result<&Samples, LimitError> {
        let known = &self.samples[levels - 1];
        let found = match known.get() {
            Some(found) => found,
            None => {
                let found = self
                    .step(forms)
                    .samples(self.mesh.vertex_count(), levels, forms);
                known.get_or_init(|| found)
            }
        };
        found.as_ref().map_err(Clone::clone)
    }

    /// The result of a step.
    pub(crate) fn step(&self, forms: &Forms<'_>) -> &Step {
        match self.step.get() {
            Some(step) => step,
            None => {
                // Not while others wait: a thread that waits may hold what this needs.
                let step = Step::of(&self.mesh, forms);
                self.step.get_or_init(|| step)
            }
        }
    }
}

impl Step {
    fn of(form: &Mesh, forms: &Forms<'_>) -> Self {
        let (topology, edges, tags) = quartered(form);
        let positions = vec![[0.0; 3]; topology.vertex_count()];
        let whole = Mesh::from_parts(topology, positions, tags, Junctions::default());
        let firsts = [0, 1, 2, 3].map(first_of_part);
        let (mesh, sources) = submesh_of(&whole, &Sharpness::of(&whole), &firsts, RINGS);
        let masks = Masks::on_demand(form, forms.table.scheme());
        let row = |source: &VertexId| match source.index().checked_sub(form.vertex_count()) {
            None => masks.vertex_weights(*source),
            Some(edge) => masks.edge_weights(edges[edge]),
        };
        let row = |source| {
            summed(
                row(source)
                    .into_iter()
                    .map(|(v, weight)| (v.0, weight))
                    .collect(),
            )
        };
        let rows = sources.iter().map(row).collect();
        let middles = [0, 1, 2].map(|edge| {
            let corner = middle_corner(edge);
            let position = forms
                .table
                .position_row(&mesh, mesh.topology().origin(corner))?;
            Ok(Middle {
                position,
                tangents: forms.table.tangent_rows(&mesh, corner)?,
            })
        });
        let parts = [0, 1, 2, 3].map(|part| {
            let (own, points) = surroundings(
                &mesh,
                &Sharpness::of(&mesh),
                HalfEdgeId::of(FaceId(part), 0),
            );
            Part {
                form: Arc::downgrade(&forms.part(own)),
                points,
            }
        });
        Self {
            mesh,
            rows,
            middles,
            parts,
        }
    }

    /// The points after the step.
    pub(super) fn points(&self, before: &[DVec3]) -> Vec<DVec3> {
        self.rows.iter().map(|row| sum(row, before)).collect()
    }

    /// A part's form and its points, of those after the step.
    pub(super) fn part(
        &self,
        part: usize,
        after: &[DVec3],
        forms: &Forms<'_>,
    ) -> (Arc<MeshForm>, Vec<DVec3>) {
        let points = self.parts[part]
            .points
            .iter()
            .map(|v| after[v.index()])
            .collect();
        (self.form_of_part(part, forms), points)
    }

    fn form_of_part(&self, part: usize, forms: &Forms<'_>) -> Arc<MeshForm> {
        self.parts[part].form.upgrade().unwrap_or_else(|| {
            let first = HalfEdgeId::of(FaceId(part as u32), 0);
            forms.part(surroundings(&self.mesh, &Sharpness::of(&self.mesh), first).0)
        })
    }

    /// The limits of all vertices so many levels below the face before the step, which has `before` points.
    fn samples(
        &self,
        before: usize,
        levels: usize,
        forms: &Forms<'_>,
    ) -> Result<Samples, LimitError> {
        let unit = 1 << levels;
        let corners: [GridPoint; 3] = [[unit, 0, 0], [0, unit, 0], [0, 0, unit]];
        let middles = [0, 1, 2]
            .map(|edge| [0, 1, 2].map(|i| (corners[edge][i] + corners[(edge + 1) % 3][i]) / 2));
        let mut samples = Samples::new();
        for (&place, middle) in middles.iter().zip(&self.middles) {
            let row = &middle.as_ref().map_err(Clone::clone)?.position;
            samples.push((place, self.by_points_before(before, row.iter().copied())));
        }
        let parts = if levels > 1 { 0..4 } else { 0..0 };
        for part in parts {
            let corners = child_corners(corners, middles, part);
            for (place, weights) in self.form_of_part(part, forms).samples(levels - 1, forms)? {
                let place = [0, 1, 2]
                    .map(|i| (0..3).map(|c| 2 * place[c] * corners[c][i]).sum::<i32>() / unit);
                if samples.iter().all(|&(known, _)| known != place) {
                    let points = self.parts[part].points.iter().map(|v| v.0);
                    samples.push((
                        place,
                        self.by_points_before(before, points.zip(weights.iter().copied())),
                    ));
                }
            }
        }
        Ok(samples)
    }

    /// The weights of all points before the step, given those of points after it.
    fn by_points_before(&self, before: usize, after: impl Iterator<Item = (u32, f64)>) -> Vec<f64> {
        let mut weights = vec![0.0; before];
        for (point, weight) in after {
            self.rows[point as usize]
                .iter()
                .for_each(|&(v, share)| weights[v as usize] += weight * share);
        }
        weights
    }

    /// The limit position of the new vertex on an edge of the face.
    pub(super) fn middle(&self, edge: usize, after: &[DVec3]) -> Result<DVec3, LimitError> {
        self.middles[edge]
            .as_ref()
            .map(|middle| sum(&middle.position, after))
            .map_err(Clone::clone)
    }

    /// The limit normal of the new vertex on an edge of the face, on the face's side.
    pub(crate) fn middle_normal(
        &self,
        edge: usize,
        after: &[DVec3],
        table: &LimitTable<'_>,
    ) -> Result<[f64; 3], LimitError> {
        if let Ok(Middle { position, tangents }) = &self.middles[edge]
            && let Some(normal) = clear_normal(sum(position, after), tangents, after)
        {
            return Ok(normal.to_array());
        }
        let positions = after.iter().map(|point| point.to_array()).collect();
        let (topology, tags) = (self.mesh.topology().clone(), self.mesh.tags().clone());
        table.normal_at(
            &Mesh::from_parts(topology, positions, tags, Junctions::default()),
            middle_corner(edge),
        )
    }
}

/// The half-edge that leaves the new vertex on an edge of the face after a step, in the part at the edge's start.
fn middle_corner(edge: usize) -> HalfEdgeId {
    // Parts keep the corner of their number.
    HalfEdgeId::of(FaceId(edge as u32), (edge + 1) % 3)
}

/// The unit normal of the plane that two tangents at a point span, where it is clear that they do.
fn clear_normal(at: DVec3, tangents: &[Row; 2], points: &[DVec3]) -> Option<DVec3> {
    let size = |row: &Row| {
        row.iter()
            .map(|&(v, _)| points[v as usize].distance_squared(at))
            .fold(0.0, f64::max)
    };
    let [first, second] = tangents.each_ref().map(|row| sum(row, points));
    let squares = [first.length_squared(), second.length_squared()];
    let least = CLEAR * CLEAR * tangents.iter().map(size).fold(0.0, f64::max);
    let normal = first.cross(second);
    let square = normal.length_squared();
    let is_clear = squares.iter().all(|&square| square > least)
        && square > CLEAR * CLEAR * squares[0] * squares[1]
        && square.is_normal();
    is_clear.then(|| normal / square.sqrt())
}

/// The forms of one scheme, and its limit stencils.
pub(super) struct Forms<'s> {
    table: LimitTable<'s>,
    kept: RwLock<HashMap<FormKey, Arc<MeshForm>>>,
}

impl<'s> Forms<'s> {
    pub(crate) fn of(scheme: &'s dyn Scheme) -> Self {
        Self {
            table: LimitTable::new(scheme),
            kept: RwLock::default(),
        }
    }

    pub(super) fn table(&self) -> &LimitTable<'s> {
        &self.table
    }

    /// That of a control face.
    pub(crate) fn root(&self, mesh: Mesh) -> Arc<MeshForm> {
        self.known(mesh, MOST_ROOTS)
    }

    /// That of a part.
    fn part(&self, mesh: Mesh) -> Arc<MeshForm> {
        self.known(mesh, MOST_FORMS)
    }

    /// The form that is kept, or a new one, which is kept where there are fewer than `most`.
    fn known(&self, mesh: Mesh, most: usize) -> Arc<MeshForm> {
        let key = FormKey::of(&mesh);
        if let Some(known) = self
            .kept
            .read()
            .unwrap_or_else(PoisonError::into_inner)
            .get(&key)
        {
            return Arc::clone(known);
        }
        let form = Arc::new(MeshForm::new(mesh));
        let mut kept = self.kept.write().unwrap_or_else(PoisonError::into_inner);
        if kept.len() < most {
            return Arc::clone(kept.entry(key).or_insert(form));
        }
        form
    }
}

/// All that a step's weights depend on.
#[derive(PartialEq, Eq, Hash)]
struct FormKey {
    triangles: Vec<[u32; 3]>,
    twins: Vec<u32>,
    /// Bits of sharpness.
    creases: Vec<([u32; 2], u64)>,
    corners: Vec<(u32, u64)>,
}

impl FormKey {
    fn of(mesh: &Mesh) -> Self {
        let tags = mesh.tags();
        Self {
            triangles: mesh.triangles().to_vec(),
            twins: mesh.topology().raw_twins().to_vec(),
            creases: tags
                .creases
                .iter()
                .map(|tag| (tag.vertices, tag.sharpness.to_bits()))
                .collect(),
            corners: tags
                .corners
                .iter()
                .map(|tag| (tag.vertex, tag.sharpness.to_bits()))
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finer::{limit_reference, uniform};
    use crate::mesh::{CornerTag, CreaseTag, Tags};
    use crate::patch::mesh_patch::MeshPatch;
    use crate::patch::{Patch, Rules};
    use crate::scheme::{Loop, ModifiedButterfly};
    use crate::vector::vector;
    use limitmesh_testing::models;

    const LEVELS: usize = 3;

    /// The corners of all parts so many levels below a piece.
    fn parts(piece: &Patch, levels: usize, rules: &Rules<'_>) -> Vec<[DVec3; 3]> {
        if levels == 0 {
            return vec![[0, 1, 2].map(|corner| piece.control_point(corner))];
        }
        let refined = piece.refined(rules);
        (0..4)
            .flat_map(|part| parts(&refined.part(part), levels - 1, rules))
            .collect()
    }

    /// Whatever is shared between faces, their parts are those of uniform refinement.
    #[test]
    fn steps_are_those_of_uniform_refinement() {
        for name in ["cup", "sheet", "tetrahedron"] {
            let mesh = models::model(name);
            let vertices = mesh
                .topology()
                .ends(HalfEdgeId::of(FaceId(1), 2))
                .map(|v| v.0);
            let creases = vec![CreaseTag {
                vertices,
                sharpness: 1.4,
            }];
            let corners = vec![CornerTag {
                vertex: vertices[0],
                sharpness: 2.5,
            }];
            let mesh = mesh.with_tags(Tags { creases, corners }).unwrap();
            let near = |a: &[DVec3; 3], b: &[DVec3; 3]| {
                let turned = |turn: usize| {
                    (0..3).all(|i| a[i].distance(b[(i + turn) % 3]) < 1e-13 * mesh.diagonal())
                };
                (0..3).any(turned)
            };
            for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
                let rules = Rules::of(scheme);
                let fine = uniform(&mesh, scheme, LEVELS);
                let sharpness = Sharpness::of(&mesh);
                for face in mesh.topology().faces().take(60) {
                    let piece = Patch::Mesh(MeshPatch::of(&mesh, &sharpness, face, &rules));
                    let found = parts(&piece, LEVELS, &rules);
                    let from = face.index() << (2 * LEVELS);
                    for expected in from..from + found.len() {
                        let corners = fine.as_triangles().corners(expected).map(vector);
                        assert!(
                            found.iter().any(|own| near(own, &corners)),
                            "{name}: {expected} of {face:?}"
                        );
                    }
                }
            }
        }
    }

    /// Samples are the limits of the vertices of uniform refinement, all but the corners.
    #[test]
    fn samples_are_limits_of_uniform_refinement() {
        for name in ["cup", "sheet", "tetrahedron"] {
            let mesh = models::model(name);
            let (scheme, sharpness) = (ModifiedButterfly, Sharpness::of(&mesh));
            let rules = Rules::of(&scheme);
            let fine = limit_reference(&mesh, &scheme, SAMPLED_LEVELS);
            for face in mesh.topology().faces().take(60) {
                let mut found = MeshPatch::of(&mesh, &sharpness, face, &rules).samples(&rules);
                let from = face.index() << (2 * SAMPLED_LEVELS);
                for part in from..from + (1 << (2 * SAMPLED_LEVELS)) {
                    for corner in fine.as_triangles().corners(part).map(vector) {
                        found
                            .retain(|&(_, point)| point.distance(corner) > 1e-12 * mesh.diagonal());
                    }
                }
                assert!(found.is_empty(), "{name}: {found:?} of {face:?}");
            }
        }
    }

    /// Forms are kept once for all faces, and only so many.
    #[test]
    fn parts_of_regular_surroundings_share_a_form() {
        let mesh = models::model("torus");
        let rules = Rules::of(&ModifiedButterfly);
        for face in mesh.topology().faces() {
            parts(
                &Patch::Mesh(MeshPatch::of(&mesh, &Sharpness::of(&mesh), face, &rules)),
                2,
                &rules,
            );
        }
        let forms = rules.forms().kept.read().unwrap().len();
        assert!(
            forms < mesh.face_count() / 4,
            "{forms} of {}",
            mesh.face_count()
        );
    }
}
