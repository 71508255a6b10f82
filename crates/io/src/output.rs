//! The output, and the options of its file.

use crate::mtl::MaterialLibraries;
use crate::unit::LengthUnit;
use limitmesh::HalfEdgeId;
use limitmesh::mesh::{Channel, CornerTag, CreaseTag, Triangles};

/// Methods that set a field.
macro_rules! setters {
    ($($field:ident: $type:ty = $value:expr;)*) => { $(
        #[doc = concat!("Sets [`Self::", stringify!($field), "`].")]
        pub fn $field(mut self, $field: $type) -> Self {
            self.$field = $value;
            self
        }
    )* };
}

/// The output: triangles and, for each vertex, its known properties.
#[derive(Clone, Copy, Debug)]
pub struct Output<'a> {
    /// Positions and triangles.
    pub surface: Triangles<'a>,
    /// Pairs of triangles that are quads, by the half-edges between them ([`limitmesh::refine::quads`]): no triangle is in two. OBJ, PLY
    /// and OFF hold them, with the values of faces of the first triangle; other formats hold the triangles.
    pub quads: &'a [[HalfEdgeId; 2]],
    /// A normal for each vertex. OBJ, PLY and glTF (both as `float`), and OFF hold them.
    pub normals: Option<&'a [[f64; 3]]>,
    /// By triangle, the normals of its corners among these, where vertices have several: then there may be any number of normals. Only
    /// OBJ holds that; other formats hold no normals then.
    pub corner_normals: Option<&'a [[u32; 3]]>,
    /// Red, green and blue for each vertex. OBJ (after the coordinates), PLY and OFF hold them.
    pub colours: Option<&'a [[u8; 3]]>,
    /// A number for each vertex, such as a distance. PLY holds it, as property `quality`.
    pub quality: Option<&'a [f64]>,
    /// Further properties of the vertices. PLY holds them.
    pub vertex_properties: &'a [Property<'a>],
    /// Further properties of the triangles. PLY holds them.
    pub face_properties: &'a [Property<'a>],
    /// Values of corners and faces: see [`holds`](crate::holds). PLY may have vertices several times for it: see [`splits_vertices`](crate::splits_vertices).
    pub channels: &'a [Channel],
    /// Files that describe materials. OBJ names them.
    pub material_libraries: &'a [String],
    /// The looks of the materials of the channel [`MATERIAL`](crate::MATERIAL) look like. glTF holds their base colours and pictures. The files are copied
    /// below the folder of an OBJ or PLY file, which names them.
    pub materials: Option<&'a MaterialLibraries>,
    /// Pictures that texture coordinates are places on. PLY names them.
    pub texture_files: &'a [String],
    /// Sharp edges. OBJ holds them.
    pub creases: &'a [CreaseTag],
    /// Sharp vertices. OBJ holds them.
    pub corners: &'a [CornerTag],
}

impl<'a> Output<'a> {
    /// The triangles alone.
    pub fn new(surface: Triangles<'a>) -> Self {
        Self {
            surface,
            quads: &[],
            normals: None,
            corner_normals: None,
            colours: None,
            quality: None,
            vertex_properties: &[],
            face_properties: &[],
            channels: &[],
            material_libraries: &[],
            materials: None,
            texture_files: &[],
            creases: &[],
            corners: &[],
        }
    }

    setters! {
        quads: &'a [[HalfEdgeId; 2]] = quads;
        normals: &'a [[f64; 3]] = Some(normals);
        colours: &'a [[u8; 3]] = Some(colours);
        quality: &'a [f64] = Some(quality);
        vertex_properties: &'a [Property<'a>] = vertex_properties;
        face_properties: &'a [Property<'a>] = face_properties;
        channels: &'a [Channel] = channels;
        material_libraries: &'a [String] = material_libraries;
        materials: &'a MaterialLibraries = Some(materials);
        texture_files: &'a [String] = texture_files;
        creases: &'a [CreaseTag] = creases;
        corners: &'a [CornerTag] = corners;
    }

    /// Sets [`Self::normals`] and [`Self::corner_normals`].
    pub fn normals_of_corners(mut self, normals: &'a [[f64; 3]], corners: &'a [[u32; 3]]) -> Self {
        (self.normals, self.corner_normals) = (Some(normals), Some(corners));
        self
    }

    /// Normals where each vertex has one.
    pub(crate) fn vertex_normals(&self) -> Option<&'a [[f64; 3]]> {
        self.normals.filter(|_| self.corner_normals.is_none())
    }
}

/// How a file is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct WriteOptions {
    /// Text where the format has a binary form as well (PLY, STL). Default: binary there.
    pub ascii: bool,
    /// The unit of the numbers, where that is known. 3MF says so, and that they are millimetres where it is not known. In glTF, whose
    /// unit is the metre, the node of the mesh scales them; where it is not known they are as they are.
    pub unit: Option<LengthUnit>,
}

impl WriteOptions {
    setters! {
        ascii: bool = ascii;
        unit: LengthUnit = Some(unit);
    }
}

/// A named number for each vertex or for each triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Property<'a> {
    /// Its name in the file: visible ASCII characters, none that the file has already.
    pub name: &'a str,
    /// One number for each vertex or triangle.
    pub values: PropertyValues<'a>,
}

/// The numbers of a property.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PropertyValues<'a> {
    /// Whole numbers, such as indices: `int` in the file, or `uint` if one of them is beyond 2³¹.
    Integers(&'a [u32]),
    /// Finite numbers: `double` in the file.
    Numbers(&'a [f64]),
}

impl<'a> Property<'a> {
    /// Whole numbers under a name.
    pub fn integers(name: &'a str, values: &'a [u32]) -> Self {
        let values = PropertyValues::Integers(values);
        Self { name, values }
    }

    /// Numbers under a name.
    pub fn numbers(name: &'a str, values: &'a [f64]) -> Self {
        let values = PropertyValues::Numbers(values);
        Self { name, values }
    }
}
