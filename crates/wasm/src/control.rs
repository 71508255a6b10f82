//! From a soup to the control mesh that is refined, and the way back: which row of the input each face is from.

use limitmesh::interpolate::{InterpolateOptions, interpolate_observed};
use limitmesh::mesh::{BoundaryRule, BuildOptions, Channel, Diagnosis, FaceParts, Trace};
use limitmesh::part::{Look, interpolate_unfolded_observed};
use limitmesh::progress::Observer;
use limitmesh::scheme::{Family, Scheme};
use limitmesh::{Mesh, PolygonSoup, QuadControl, QuadOptions};

use crate::failure::Failure;
use crate::inputs::ControlIn;
use crate::options;

/// A control mesh and where it came from.
pub(crate) struct Control {
    pub(crate) mesh: Mesh,
    pub(crate) scheme: &'static dyn Scheme,
    /// By vertex of the input, the mesh's; none where no face of it was kept, the first of copies.
    pub(crate) vertices: Vec<Option<u32>>,
    pub(crate) channels: Vec<Channel>,
    pub(crate) diagnosis: Diagnosis,
    /// In degrees, as asked for or found.
    pub(crate) crease_angle: Option<f64>,
    /// What lengths are given in parts of.
    pub(crate) diagonal: f64,
    /// Where faces were divided.
    parts: FaceParts,
    /// By face of the mesh before faces were divided, the input's.
    faces: Vec<u32>,
}

/// What a soup becomes before anything else is done to it.
struct Built {
    mesh: Mesh,
    diagnosis: Diagnosis,
    trace: Trace,
    channels: Vec<Channel>,
}

/// A mesh whose edges are as sharp as was asked for.
struct Sharp {
    mesh: Mesh,
    crease_angle: Option<f64>,
    /// Whether the surface is led through its vertices because it looks like a part.
    is_led: bool,
}

impl Control {
    /// The control mesh of a soup.
    ///
    /// # Errors
    /// No mesh can be made of it, or none that interpolates.
    pub(crate) fn new(
        soup: PolygonSoup,
        build: &BuildOptions,
        told: &ControlIn,
        observer: &mut Observer<'_>,
    ) -> Result<Self, Failure> {
        let (scheme, boundary) = (options::scheme(told, &soup)?, options::boundary(told)?);
        let built = match scheme.family() {
            Some(Family::CatmullClark) => Built::of_quads(&soup, build, told, boundary)?,
            _ => Built::of_triangles(&soup, build)?,
        };
        let (mesh, trace) = (built.mesh, built.trace);
        let vertices = trace.of_soup(&soup, &mesh);
        drop(soup);
        let sharp = Sharp::of(mesh.with_boundary(boundary), &trace.faces, told)?;
        let (mesh, concave) = match told.divides_concave_corners() {
            true => sharp.mesh.with_divided_concave_corners()?,
            false => (sharp.mesh, Default::default()),
        };
        let diagonal = mesh.diagonal();
        let mesh = match told.interpolate() {
            None if sharp.is_led => {
                interpolate_unfolded_observed(&mesh, scheme, observer)?
                    .interpolated
                    .mesh
            }
            None => mesh,
            Some(within) => {
                let goal = InterpolateOptions::default().within(within.of(diagonal));
                interpolate_observed(&mesh, scheme, &goal, observer)?.mesh
            }
        };
        let on_parts = |channel: &Channel| channel.on_parts(&concave.parts, &mesh);
        let mut diagnosis = built.diagnosis;
        diagnosis.concave_corners = concave.corners;
        Ok(Self {
            channels: match concave.parts.is_empty() {
                true => built.channels,
                false => built.channels.iter().map(on_parts).collect(),
            },
            mesh,
            scheme,
            vertices,
            diagnosis,
            crease_angle: sharp.crease_angle,
            diagonal,
            parts: concave.parts,
            faces: trace.faces,
        })
    }

    /// The input's faces that control faces are from.
    pub(crate) fn input_faces(&self, mut faces: Vec<u32>) -> Vec<u32> {
        for face in &mut faces {
            *face = self.faces[self.parts.whole(*face) as usize];
        }
        faces
    }
}

impl Built {
    fn of_triangles(soup: &PolygonSoup, build: &BuildOptions) -> Result<Self, Failure> {
        let (mesh, diagnosis, trace) = Mesh::from_soup_traced(soup, build)?;
        let on_mesh = |channel: &Channel| channel.on_mesh(soup, &mesh, &trace);
        let channels = soup.channels.iter().map(on_mesh);
        Ok(Self {
            channels: channels.collect::<Result<_, _>>()?,
            mesh,
            diagnosis,
            trace,
        })
    }

    fn of_quads(
        soup: &PolygonSoup,
        build: &BuildOptions,
        told: &ControlIn,
        boundary: BoundaryRule,
    ) -> Result<Self, Failure> {
        let rules = QuadOptions::default()
            .boundary(boundary)
            .smooth_triangles(told.smooth_triangles())
            .crease_angle(told.crease_angle().map(f64::to_radians));
        let (quads, diagnosis) = QuadControl::from_soup_with(soup, build, &rules)?;
        let on_quads = |channel: &Channel| quads.channel(soup, channel);
        let channels = soup.channels.iter().map(on_quads);
        Ok(Self {
            channels: channels.collect::<Result<_, _>>()?,
            mesh: quads.mesh,
            diagnosis,
            trace: quads.trace,
        })
    }
}

impl Sharp {
    fn of(mesh: Mesh, faces: &[u32], told: &ControlIn) -> Result<Self, Failure> {
        let crease_angle = told.crease_angle();
        let smooth = |mesh, crease_angle| Self {
            mesh,
            crease_angle,
            is_led: false,
        };
        if let Some(degrees) = crease_angle {
            // Quads have theirs from their polygons.
            if mesh.topology().has_quads() {
                return Ok(smooth(mesh, crease_angle));
            }
            let mesh = mesh.with_creases_above(degrees.to_radians())?;
            return Ok(smooth(mesh, crease_angle));
        }
        if told.auto_creases()
            && let Look::Part(part) = Look::of(&mesh, faces)
        {
            return Ok(Self {
                mesh: part.on(mesh),
                crease_angle: Some(part.degrees),
                is_led: told.leads_parts(),
            });
        }
        Ok(smooth(mesh, None))
    }
}
