//! Options as the Python half hands them over, complete, and what they are for the library.

use limitmesh::criterion::{Camera, View, Viewpoint};
use limitmesh::front::MOST_LEVELS;
use limitmesh::mesh::{BoundaryRule, BuildOptions, Weld};
use limitmesh::refine::{AngleGoal, ExactOptions, Finish};
use limitmesh::scheme::{CatmullClark, Loop, LoopWarren, ModifiedButterfly, Scheme};
use pyo3::prelude::*;

use crate::errors::{Failure, OptionError};

/// How a control mesh comes of a mesh, and its limit surface of that.
#[derive(FromPyObject, Clone)]
#[pyo3(from_item_all)]
pub(crate) struct ControlOptions {
    /// Distance within which vertices are merged; below 0 for none.
    weld: f64,
    /// Whether defects are mended.
    repair: bool,
    boundary: String,
    /// In degrees.
    pub(crate) crease_angle: Option<f64>,
    /// Whether edges are sharp that look so, if the mesh looks like a part.
    pub(crate) auto_creases: bool,
    /// Whether the surface of such a part is led through its vertices.
    pub(crate) leads_parts: bool,
    /// Whether corners of 180° and more are divided.
    pub(crate) divides_concave_corners: bool,
    /// How near the limit surface is to pass to the vertices.
    pub(crate) interpolate: Option<Extent>,
    scheme: String,
    /// Whether the surface is rounder where a cage for Catmull–Clark has triangles.
    pub(crate) smooth_triangles: bool,
}

/// A length, or a part of the diagonal.
#[derive(FromPyObject, Clone, Copy)]
pub(crate) struct Extent(f64, bool);

impl Extent {
    /// As a length.
    pub(crate) fn of(self, diagonal: f64) -> f64 {
        if self.1 { self.0 * diagonal } else { self.0 }
    }
}

impl ControlOptions {
    pub(crate) fn build(&self) -> BuildOptions {
        let weld = match self.weld {
            none if none < 0.0 => Weld::Never,
            0.0 => Weld::Exact,
            distance => Weld::Within(distance),
        };
        BuildOptions::default().weld(weld).strict(!self.repair)
    }

    pub(crate) fn boundary(&self) -> PyResult<BoundaryRule> {
        match self.boundary.as_str() {
            "smooth" => Ok(BoundaryRule::Smooth),
            "corners" => Ok(BoundaryRule::Corners),
            "fixed" => Ok(BoundaryRule::Fixed),
            other => {
                let what =
                    format!("boundary is '{other}', expected 'smooth', 'corners' or 'fixed'");
                Err(OptionError::new_err(what))
            }
        }
    }

    pub(crate) fn scheme(&self) -> PyResult<&'static dyn Scheme> {
        match self.scheme.as_str() {
            "loop" => Ok(&Loop),
            "loop-warren" => Ok(&LoopWarren),
            "butterfly" => Ok(&ModifiedButterfly),
            "catmull-clark" => Ok(&CatmullClark),
            other => {
                let what = format!(
                    "scheme is '{other}', expected 'loop', 'loop-warren', 'butterfly' or 'catmull-clark'"
                );
                Err(OptionError::new_err(what))
            }
        }
    }
}

/// A camera: eye, target, up, vertical angle of view in degrees, width and height in pixels.
pub(crate) type CameraIn = ([f64; 3], [f64; 3], [f64; 3], f64, u32, u32);

/// As the library has it.
pub(crate) fn camera(&(eye, target, up, fov_degrees, width, height): &CameraIn) -> Camera {
    Camera {
        eye,
        target,
        up,
        fov_degrees,
        width,
        height,
    }
}

/// Levels that a front may have at most: those asked for, or as many as there can be.
///
/// # Errors
/// There cannot be so many.
pub(crate) fn front_levels(max_levels: Option<usize>) -> Result<u32, Failure> {
    let Some(asked) = max_levels else {
        return Ok(MOST_LEVELS);
    };
    match u32::try_from(asked) {
        Ok(levels) if levels <= MOST_LEVELS => Ok(levels),
        _ => Err(Failure::Option(format!(
            "max_levels is {asked}, expected at most {MOST_LEVELS}"
        ))),
    }
}

/// Goals and caps of a refinement.
#[derive(FromPyObject, Clone)]
#[pyo3(from_item_all)]
pub(crate) struct Goals {
    pub(crate) method: String,
    /// Whether √3-subdivision divides, in place of the control mesh's scheme.
    pub(crate) sqrt3: bool,
    /// Steps of the stepwise methods.
    pub(crate) levels: usize,
    pub(crate) tolerance: Option<Extent>,
    /// The greatest distance from the input; in place of a tolerance.
    pub(crate) within: Option<Extent>,
    pub(crate) triangles: Option<usize>,
    /// In degrees.
    pub(crate) angle: Option<f64>,
    pixels: Option<f64>,
    cameras: Vec<CameraIn>,
    /// Where the viewer stands, or looks along; and the dilatation.
    eye: Option<[f64; 3]>,
    view: Option<[f64; 3]>,
    dilatation: f64,
    optimize: bool,
    balance: bool,
    flat_regions: bool,
    /// Whether triangles are to be paired to quads.
    pub(crate) quads: bool,
    pub(crate) origins: bool,
    pub(crate) max_triangles: Option<usize>,
    pub(crate) max_levels: Option<usize>,
    max_memory: Option<usize>,
}

impl Goals {
    /// Where the viewer stands, if that counts.
    pub(crate) fn viewer(&self) -> Option<View> {
        let viewpoint = self
            .view
            .map(Viewpoint::Direction)
            .or(self.eye.map(Viewpoint::Eye))?;
        Some(View {
            viewpoint,
            dilatation: self.dilatation,
        })
    }

    /// Triangles that a method without a cap of its own on memory must not exceed, by number or at so many bytes each.
    pub(crate) fn cap(&self, bytes_per_triangle: usize) -> Option<usize> {
        let by_memory = self.max_memory.map(|bytes| bytes / bytes_per_triangle);
        self.max_triangles.into_iter().chain(by_memory).min()
    }

    /// What such a cap is called where it ended a refinement.
    pub(crate) fn cap_name(&self, bytes_per_triangle: usize) -> &'static str {
        if self.cap(bytes_per_triangle) == self.max_triangles {
            "triangle-cap"
        } else {
            "memory-cap"
        }
    }

    /// As exact refinement has them, for a mesh with this diagonal. Triangles stay within one face where faces are to be told apart.
    pub(crate) fn exact(
        &self,
        diagonal: f64,
        tells_faces_apart: bool,
        unfolds: bool,
    ) -> ExactOptions {
        let finish = match (self.optimize, self.balance) {
            (true, _) => Finish::Collapsed,
            (false, true) => Finish::Balanced,
            (false, false) => Finish::OnSurface,
        };
        let mut options = ExactOptions::default()
            .max_memory(self.max_memory)
            .finish(finish)
            .flat_regions(self.flat_regions && !tells_faces_apart)
            .unfold(unfolds)
            .origins(self.origins || tells_faces_apart || self.quads)
            .for_quads(self.quads);
        if let Some(cap) = self.max_triangles {
            options = options.max_triangles(Some(cap));
        }
        if let Some(levels) = self.max_levels {
            options = options.max_levels(levels);
        }
        if let Some(tolerance) = self.tolerance {
            options = options.tolerance(tolerance.of(diagonal));
        }
        if let Some(degrees) = self.angle {
            options.goals.angle = Some(AngleGoal {
                radians: degrees.to_radians(),
                view: self.viewer(),
            });
        }
        if let Some(pixels) = self.pixels {
            options = options.pixels(pixels, self.cameras.iter().map(camera).collect());
        }
        if let Some(count) = self.triangles {
            options = options.triangles(count);
        }
        options
    }
}
