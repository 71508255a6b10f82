//! The piece over half a quad that is not regular: the quad's surroundings, refined as a whole until a part of it is.

use std::sync::Arc;

use super::bicubic::Bicubic;
use super::{Limit, ParamTriangle, Patch, Rules};
use crate::catmull_clark::form::{Middle, QuadForm, QuadForms};
use crate::catmull_clark::quads::{Connected, MeshQuads, of_face};
use crate::index::FaceId;
use crate::mesh::{Mesh, Sharpness};
use crate::row::sum;
use crate::vector::{DVec3, unit_or_zero, vector};

/// The piece over half a quad, with the points around the quad. The half's right angle is at the quad's first corner.
#[derive(Clone, Debug)]
pub struct QuadPatch {
    pub(super) form: Arc<QuadForm>,
    points: Vec<DVec3>,
}

/// A piece refined once.
pub struct RefinedQuadPatch<'a> {
    form: Arc<QuadForm>,
    points: Vec<DVec3>,
    forms: &'a QuadForms,
}

/// The piece over a face of a mesh of quads.
pub(crate) fn root_piece(
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    face: FaceId,
    rules: &Rules<'_>,
) -> Patch {
    let quads = MeshQuads { mesh, sharpness };
    let (own, sources) = quads.surroundings(of_face(face));
    let points = sources
        .iter()
        .map(|&v| vector(mesh.positions()[v as usize]));
    QuadPatch::piece(rules.quad_forms().of(own), points.collect())
}

impl QuadPatch {
    /// The piece of some surroundings, in its simplest form.
    pub(crate) fn piece(form: Arc<QuadForm>, points: Vec<DVec3>) -> Patch {
        match &form.grid {
            Some(grid) => {
                let points = grid
                    .each_ref()
                    .map(|row| row.each_ref().map(|own| sum(own, &points)));
                Patch::Bicubic(Bicubic {
                    points: Arc::new(points),
                    part: ParamTriangle::WHOLE,
                })
            }
            None => Patch::Quad(Box::new(Self { form, points })),
        }
    }

    /// The point of a corner of the half.
    pub(crate) fn control_point(&self, corner: usize) -> DVec3 {
        let [a, b, _, d] = self.form.corners();
        self.points[[a, b, d][corner] as usize]
    }

    /// Moves the piece so that one of its points is at the origin, and gives where that was.
    pub(crate) fn moved_to_origin(&mut self) -> DVec3 {
        let from = self.points[0];
        self.points.iter_mut().for_each(|point| *point -= from);
        from
    }

    /// Points whose hull holds the piece.
    pub(crate) fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The piece refined once.
    pub(crate) fn refined<'a>(&self, rules: &'a Rules<'a>) -> RefinedQuadPatch<'a> {
        let forms = rules.quad_forms();
        RefinedQuadPatch {
            points: self.form.step(forms).points(&self.points),
            form: Arc::clone(&self.form),
            forms,
        }
    }
}

impl RefinedQuadPatch<'_> {
    /// A part, numbered as those of triangles.
    pub(crate) fn part(&self, part: usize) -> Patch {
        let (form, points) = self.form.step(self.forms).part(part, &self.points);
        QuadPatch::piece(form, points)
    }

    pub(crate) fn is_regular(&self, part: usize) -> bool {
        self.form.step(self.forms).is_regular(part)
    }

    /// The limit in the middle of an edge of the half.
    pub(crate) fn middle<L: Limit>(&self, edge: usize) -> L {
        let Middle { position, tangents } = &self.form.step(self.forms).middles[edge];
        L::of(sum(position, &self.points), || {
            let [first, second] = tangents.as_ref().map_or([DVec3::ZERO; 2], |rows| {
                rows.each_ref().map(|row| sum(row, &self.points))
            });
            unit_or_zero(unit_or_zero(first).cross(unit_or_zero(second)))
        })
    }
}
