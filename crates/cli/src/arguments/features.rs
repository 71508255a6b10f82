//! Options that say where the surface of a control mesh is sharp.

use clap::{Args, ValueEnum};
use limitmesh::mesh::{BoundaryRule, MeshError};
use limitmesh::part::Part;
use limitmesh::{Mesh, QuadOptions};
use serde::Serialize;

use super::values;
use crate::failure::usage;

/// The shape of a surface's boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Default)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Boundary {
    /// A smooth curve
    #[default]
    Smooth,
    /// A smooth curve that keeps the vertices in one face only
    Corners,
    /// The mesh's own boundary edges, all straight
    Fixed,
}

/// The rule for corners whose faces take 180° or more between two sharp edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ConcaveCorners {
    /// As the scheme has them, and OpenSubdiv: the surface folds over there
    Smooth,
    /// Sharp edges inside divide them: flat faces stay flat
    Fixed,
}

/// The values of a file that make edges sharp.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Default)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(crate) enum CreasesFrom {
    /// Its tags alone
    #[default]
    None,
    /// Normals that differ between the two faces (vn of OBJ, nx of PLY, NORMAL of glTF)
    Normals,
    /// Different smoothing groups, or none (s of OBJ)
    SmoothingGroups,
    /// Borders of materials, or of whatever else whole numbers name faces by
    Materials,
}

/// Which edges are sharp by the angle between their faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CreaseAngle {
    /// Those that look so, if the file has no sharpness of its own and the mesh looks like a part.
    Auto,
    /// None.
    None,
    /// Those whose faces' normals differ by more degrees.
    Above(f64),
    /// The angle that was found by looking at the mesh.
    Found(f64),
}

impl CreaseAngle {
    /// In degrees, where it is decided that there is one.
    pub(crate) fn degrees(self) -> Option<f64> {
        match self {
            Self::Above(degrees) | Self::Found(degrees) => Some(degrees),
            Self::Auto | Self::None => None,
        }
    }
}

/// A crease angle: one in degrees, or the words `auto` and `none`.
pub(super) fn crease_angle(text: &str) -> Result<CreaseAngle, String> {
    match text {
        "auto" => Ok(CreaseAngle::Auto),
        "none" => Ok(CreaseAngle::None),
        _ => match values::angle(text) {
            Ok(degrees) => Ok(CreaseAngle::Above(degrees)),
            Err(what) => Err(format!("{what}; degrees, 'auto' or 'none' are expected")),
        },
    }
}

/// A control mesh with its tags.
pub(crate) struct Featured {
    pub(crate) mesh: Mesh,
    /// The divisions at concave corners.
    pub(crate) concave: limitmesh::mesh::ConcaveCorners,
    /// Edges along needles that are as sharp as asked and have no tag for it.
    pub(crate) along_needles: usize,
}

/// Where the surface is sharp, apart from the tags of the file.
#[derive(Args, Debug, Clone, Copy, Default)]
pub(crate) struct FeatureArguments {
    /// Keep edges sharp where the faces meet at more than this angle between their normals [degrees, above 0 to 180; auto or none;
    /// default: auto, none for methods other than exact]
    ///
    /// For parts with flat faces and round ones: 30 keeps a box a box, and makes a cylinder round between sharp rims. Of the two sides of a
    /// needle that meet at its tip, the faces beyond them decide. With auto, a mesh that looks like a part gets the angle that parts
    /// its sharp edges from the others, or those edges that its normals say are sharp; the tips of its cones are sharp, too. Its surface is
    /// led through the vertices where that does not fold it, unless --interpolate says otherwise. Files with tags or several
    /// smoothing groups have sharpness of their own, and files of quadrilaterals are cages: neither are looked at. With none all edges are
    /// smooth but those that the file tags.
    #[arg(long, value_name = "DEG|auto|none", value_parser = crease_angle, allow_hyphen_values = true)]
    pub(crate) crease_angle: Option<CreaseAngle>,

    /// Keep edges sharp that the file's normals, smoothing groups or materials say are sharp [default: none]
    ///
    /// In addition to --crease-angle and the tags of the file. For OBJ, PLY, OFF and STL files; glTF assets that are edited have normals only,
    /// 3MF files none of these.
    #[arg(
        long,
        value_enum,
        value_name = "WHAT",
        hide_default_value = true,
        default_value_t
    )]
    pub(crate) creases_from: CreasesFrom,

    /// What becomes of open boundaries [default: smooth]
    #[arg(long, value_enum, value_name = "RULE")]
    pub(crate) boundary: Option<Boundary>,

    /// Rule for corners that take 180° or more between two sharp edges [default: smooth; fixed with --crease-angle
    /// or --creases-from, or with --boundary corners or fixed]
    #[arg(long, value_enum, value_name = "RULE")]
    pub(crate) concave_corners: Option<ConcaveCorners>,
}

impl FeatureArguments {
    /// The angle in degrees beyond which edges are sharp, where there is one.
    pub(crate) fn angle(&self) -> Option<f64> {
        self.crease_angle.and_then(CreaseAngle::degrees)
    }

    /// Whether it was to be found by looking at the mesh.
    pub(crate) fn is_auto(&self) -> bool {
        matches!(
            self.crease_angle,
            Some(CreaseAngle::Auto | CreaseAngle::Found(_))
        )
    }

    /// These arguments, with edges sharp that look so unless something else is asked for.
    pub(crate) fn or_auto(mut self) -> Self {
        self.crease_angle.get_or_insert(CreaseAngle::Auto);
        self
    }

    /// The first of these options that is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let all = [
            (self.crease_angle.is_some(), "--crease-angle"),
            (self.creases_from != CreasesFrom::None, "--creases-from"),
            (self.boundary.is_some(), "--boundary"),
            (self.concave_corners.is_some(), "--concave-corners"),
        ];
        all.into_iter()
            .find(|&(is_given, _)| is_given)
            .map(|(_, option)| option)
    }

    /// Refuses what has no meaning for assets.
    ///
    /// # Errors
    /// Edges are to be sharp by what only other files say.
    pub(crate) fn check_of_asset(&self) -> anyhow::Result<()> {
        match self.creases_from {
            CreasesFrom::None | CreasesFrom::Normals => Ok(()),
            _ => usage(
                "of glTF assets --creases-from follows normals alone; --crease-angle is for all files",
            ),
        }
    }

    /// Refuses what has no meaning for packages.
    ///
    /// # Errors
    /// Edges are to be sharp by what only other files say.
    pub(crate) fn check_of_package(&self) -> anyhow::Result<()> {
        match self.creases_from {
            CreasesFrom::None => Ok(()),
            _ => usage(
                "--creases-from is for OBJ, PLY, OFF, STL and glTF files; --crease-angle is for all",
            ),
        }
    }

    /// The rule for concave corners, by the other options where none was given.
    pub(crate) fn concave_corners(&self) -> ConcaveCorners {
        let is_asked = self.angle().is_some()
            || self.creases_from != CreasesFrom::None
            || self.boundary.unwrap_or_default() != Boundary::Smooth;
        let usual = if is_asked {
            ConcaveCorners::Fixed
        } else {
            ConcaveCorners::Smooth
        };
        self.concave_corners.unwrap_or(usual)
    }

    /// The rule of boundaries.
    pub(super) fn boundary_rule(&self) -> BoundaryRule {
        match self.boundary.unwrap_or_default() {
            Boundary::Smooth => BoundaryRule::Smooth,
            Boundary::Corners => BoundaryRule::Corners,
            Boundary::Fixed => BoundaryRule::Fixed,
        }
    }

    /// The rules by which polygons become quads.
    pub(super) fn quads(&self, smooth_triangles: bool) -> QuadOptions {
        let crease_angle = match self.crease_angle {
            Some(CreaseAngle::Above(degrees)) => Some(degrees.to_radians()),
            _ => None,
        };
        let options = QuadOptions::default().boundary(self.boundary_rule());
        options
            .smooth_triangles(smooth_triangles)
            .crease_angle(crease_angle)
    }

    /// The control mesh with the tags that these options put on it.
    ///
    /// # Errors
    /// None that the command line's own checks leave.
    pub(crate) fn apply(&self, mesh: Mesh) -> Result<Featured, MeshError> {
        let mesh = mesh.with_boundary(self.boundary_rule());
        let (mesh, along_needles) = match self.crease_angle {
            // Quads have theirs from their polygons.
            Some(CreaseAngle::Above(_)) if mesh.topology().has_quads() => (mesh, 0),
            Some(CreaseAngle::Above(degrees)) => {
                let found = mesh.creases_above(degrees.to_radians())?;
                (mesh.with_creases(&found.edges), found.along_needles)
            }
            Some(CreaseAngle::Found(degrees)) => {
                let part = Part::at_angle(degrees, &mesh)?;
                (part.on(mesh), part.creases.along_needles)
            }
            Some(CreaseAngle::Auto | CreaseAngle::None) | None => (mesh, 0),
        };
        let (mesh, concave) = match self.concave_corners() {
            ConcaveCorners::Fixed => mesh.with_divided_concave_corners()?,
            ConcaveCorners::Smooth => (mesh, Default::default()),
        };
        Ok(Featured {
            mesh,
            concave,
            along_needles,
        })
    }
}
