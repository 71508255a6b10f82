//! From a soup to the control mesh that is refined, and the way back: which row of the input each element is from.

use limitmesh::carry::borders;
use limitmesh::interpolate::{
    InterpolateOptions, Interpolated, InterpolationMethod, interpolate_observed,
};
use limitmesh::mesh::{BoundaryRule, Channel, Diagnosis, FaceParts, Trace};
use limitmesh::part::{Look, interpolate_unfolded_observed};
use limitmesh::progress::Observer;
use limitmesh::refine::ExactOptions;
use limitmesh::scheme::{Family, Scheme};
use limitmesh::{Mesh, PolygonSoup, QuadControl, QuadOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::Failure;
use crate::options::{ControlOptions, Goals};

/// What to make of a soup.
#[derive(Clone)]
pub(crate) struct Recipe {
    options: ControlOptions,
    boundary: BoundaryRule,
    pub(crate) scheme: &'static dyn Scheme,
}

/// What a soup becomes before anything else is done to it.
struct Built {
    mesh: Mesh,
    diagnosis: Diagnosis,
    trace: Trace,
    channels: Vec<Channel>,
}

impl Recipe {
    /// # Errors
    /// A name that stands for nothing.
    pub(crate) fn new(options: ControlOptions) -> PyResult<Self> {
        Ok(Self {
            boundary: options.boundary()?,
            scheme: options.scheme()?,
            options,
        })
    }

    /// Whether folded flat regions are taken for what their rims enclose.
    pub(crate) fn unfolds(&self) -> bool {
        self.options.divides_concave_corners
    }

    /// The mesh of a soup without what makes it a control mesh, with the soup's faces that its own are from.
    ///
    /// # Errors
    /// No mesh can be made of it.
    pub(crate) fn plain(&self, soup: &PolygonSoup) -> Result<(Mesh, Vec<u32>, Diagnosis), Failure> {
        let (mesh, diagnosis, trace) = Mesh::from_soup_traced(soup, &self.options.build())?;
        Ok((mesh, trace.faces, diagnosis))
    }

    /// The mesh of a soup as the scheme needs it, before anything else is done to it.
    ///
    /// # Errors
    /// No mesh can be made of it.
    fn built(&self, soup: &PolygonSoup) -> Result<Built, Failure> {
        let Some((quads, diagnosis)) = self.quads(soup)? else {
            let (mesh, diagnosis, trace) = Mesh::from_soup_traced(soup, &self.options.build())?;
            let channels = soup.channels.iter();
            let channels = channels.map(|channel| channel.on_mesh(soup, &mesh, &trace));
            let channels = channels.collect::<Result<_, _>>()?;
            return Ok(Built {
                mesh,
                diagnosis,
                trace,
                channels,
            });
        };
        let channels = soup.channels.iter();
        let channels = channels.map(|channel| quads.channel(soup, channel));
        let channels = channels.collect::<Result<_, _>>()?;
        Ok(Built {
            mesh: quads.mesh,
            diagnosis,
            trace: quads.trace,
            channels,
        })
    }

    /// The polygons of a soup as quads, where the scheme is for these.
    ///
    /// # Errors
    /// No mesh can be made of them.
    pub(crate) fn quads(
        &self,
        soup: &PolygonSoup,
    ) -> Result<Option<(QuadControl, Diagnosis)>, Failure> {
        if !matches!(self.scheme.family(), Some(Family::CatmullClark)) {
            return Ok(None);
        }
        let options = &self.options;
        let rules = QuadOptions::default()
            .boundary(self.boundary)
            .smooth_triangles(options.smooth_triangles)
            .crease_angle(options.crease_angle.map(f64::to_radians));
        Ok(Some(QuadControl::from_soup_with(
            soup,
            &options.build(),
            &rules,
        )?))
    }

    /// The control mesh of a soup.
    ///
    /// # Errors
    /// No mesh can be made of it, or none that interpolates.
    pub(crate) fn control(
        &self,
        soup: PolygonSoup,
        observer: &mut Observer<'_>,
    ) -> Result<Control, Failure> {
        let options = &self.options;
        let Built {
            mesh,
            mut diagnosis,
            trace,
            channels,
        } = self.built(&soup)?;
        let corners = trace.vertices(&soup);
        let is_stepped = !trace.between.is_empty();
        let vertices = trace.of_soup(&soup, &mesh);
        drop(soup);
        let mesh = mesh.with_boundary(self.boundary);
        let look = options.auto_creases.then(|| Look::of(&mesh, &trace.faces));
        let (mesh, crease_angle, is_led) = match (options.crease_angle, look) {
            // Quads have theirs from their polygons.
            (Some(degrees), _) if mesh.topology().has_quads() => (mesh, Some(degrees), false),
            (Some(degrees), _) => (
                mesh.with_creases_above(degrees.to_radians())?,
                Some(degrees),
                false,
            ),
            (None, Some(Look::Part(part))) => {
                (part.on(mesh), Some(part.degrees), options.leads_parts)
            }
            _ => (mesh, None, false),
        };
        let (whole, (mesh, concave)) = match options.divides_concave_corners {
            true => (Some(mesh.clone()), mesh.with_divided_concave_corners()?),
            false => (None, (mesh, Default::default())),
        };
        let whole = whole.filter(|_| !concave.parts.is_empty());
        diagnosis.concave_corners = concave.corners;
        let diagonal = mesh.diagonal();
        let (mesh, interpolated) = match options.interpolate {
            None if is_led => {
                let found = interpolate_unfolded_observed(&mesh, self.scheme, observer)?;
                let told = InterpolatedTold::new(&found.interpolated, found.folded.len());
                (found.interpolated.mesh, Some(told))
            }
            None => (mesh, None),
            Some(within) => {
                let goal = InterpolateOptions::default().within(within.of(diagonal));
                let found = interpolate_observed(&mesh, self.scheme, &goal, observer)?;
                let told = InterpolatedTold::new(&found, 0);
                (found.mesh, Some(told))
            }
        };
        let channels = match concave.parts.is_empty() {
            true => channels,
            false => channels
                .iter()
                .map(|channel| channel.on_parts(&concave.parts, &mesh))
                .collect(),
        };
        let tables = Tables {
            parts: concave.parts,
            diagnosis,
            faces: trace.faces,
            corners,
            is_stepped,
            crease_angle,
            interpolated,
        };
        Ok(Control {
            mesh,
            whole,
            tables,
            vertices,
            channels,
            diagonal,
        })
    }
}

/// A control mesh and where it came from.
pub(crate) struct Control {
    pub(crate) mesh: Mesh,
    /// The mesh before faces were divided, where some were.
    pub(crate) whole: Option<Mesh>,
    pub(crate) tables: Tables,
    /// By vertex of the input, the mesh's; none where no face of it was kept, the first of copies.
    pub(crate) vertices: Vec<Option<u32>>,
    pub(crate) channels: Vec<Channel>,
    /// What lengths are given in parts of.
    pub(crate) diagonal: f64,
}

/// What stays of a control mesh with each result of it.
#[derive(Clone)]
pub(crate) struct Tables {
    /// Where faces were divided.
    pub(crate) parts: FaceParts,
    pub(crate) diagnosis: Diagnosis,
    /// By face of the mesh before faces were divided, the input's.
    pub(crate) faces: Vec<u32>,
    /// By corner of the same, the input's vertex.
    pub(crate) corners: Vec<u32>,
    /// Whether a step of the scheme divided the input's polygons: a corner between several vertices has the first of them.
    pub(crate) is_stepped: bool,
    /// In degrees, as asked for or found.
    pub(crate) crease_angle: Option<f64>,
    pub(crate) interpolated: Option<InterpolatedTold>,
}

impl Control {
    /// What is asked of exact refinement. Triangles stay within one face where channels have other values in other places of it, and
    /// else where faces have one value.
    pub(crate) fn options(&self, goals: &Goals, recipe: &Recipe) -> ExactOptions {
        let varies = self.channels.iter().any(Channel::varies_within_faces);
        let options = goals.exact(self.diagonal, varies, recipe.unfolds());
        options.kept_edges(borders(&self.channels, &self.mesh))
    }
}

impl Tables {
    /// The input's faces that control faces are from; none where nothing is told of them.
    pub(crate) fn input_faces(&self, mut faces: Vec<u32>) -> Option<Vec<u32>> {
        for face in &mut faces {
            *face = self.faces[self.parts.whole(*face) as usize];
        }
        (!faces.is_empty()).then_some(faces)
    }
}

/// How control points were found.
#[derive(Clone, Copy)]
pub(crate) struct InterpolatedTold {
    method: InterpolationMethod,
    residual: f64,
    relaxed: usize,
    folded_regions: usize,
    displacement: f64,
}

impl InterpolatedTold {
    fn new(found: &Interpolated, folded_regions: usize) -> Self {
        Self {
            method: found.method,
            residual: found.residual,
            relaxed: found.relaxed.len(),
            folded_regions,
            displacement: found.displacement,
        }
    }

    pub(crate) fn told<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let method = match self.method {
            InterpolationMethod::Unchanged => "unchanged",
            InterpolationMethod::ConjugateGradients => "conjugate-gradients",
            InterpolationMethod::NormalEquations => "normal-equations",
            InterpolationMethod::LeastSquares => "least-squares",
            _ => "other",
        };
        dict.set_item("method", method)?;
        dict.set_item("residual", self.residual)?;
        dict.set_item("relaxed", self.relaxed)?;
        dict.set_item("folded_regions", self.folded_regions)?;
        dict.set_item("displacement", self.displacement)?;
        Ok(dict)
    }
}
