//! Files: read, refined with what they carry, written.

use std::path::Path;

use js_sys::{Array, Object};
use limitmesh::PolygonSoup;
use limitmesh::mesh::{Channel, SplitSurface};
use limitmesh::refine::Exact;
use limitmesh_io::{Format, Output, WriteOptions, holds, read_bytes, rounding, write_to};
use wasm_bindgen::prelude::*;

use crate::asset;
use crate::control::Control;
use crate::failure::Failure;
use crate::inputs::{ControlIn, GoalsIn, Listener};
use crate::options;
use crate::refine::{Reached, Scale, exact_of};
use crate::told::{self, observer, set};

/// A file that was written.
#[wasm_bindgen]
pub struct FileOut {
    pub(crate) bytes: Vec<u8>,
    pub(crate) meshes: Vec<Object>,
    /// Names of what the format has no place for.
    pub(crate) left_out: Vec<String>,
}

/// Refines a file with what it carries, and writes it in a format. From glTF to glTF the asset is edited.
///
/// # Errors
/// The file cannot be read, an option has no meaning, or the listener said stop.
#[wasm_bindgen]
pub fn refine_file(
    bytes: &[u8],
    from: &str,
    to: &str,
    control: &ControlIn,
    goals: &GoalsIn,
    listener: Option<Listener>,
) -> Result<FileOut, JsValue> {
    Ok(refined(
        bytes,
        [("from", from), ("to", to)],
        control,
        goals,
        listener.as_ref(),
    )?)
}

fn refined(
    bytes: &[u8],
    formats: [(&str, &str); 2],
    told: &ControlIn,
    goals: &GoalsIn,
    listener: Option<&Listener>,
) -> Result<FileOut, Failure> {
    let mut observer = observer(listener);
    let [from, to] = formats.map(|(option, name)| format(option, name));
    let (from, to) = (from?, to?);
    if from.is_gltf() && to.is_gltf() {
        return asset::refined(bytes, to, told, goals, &mut observer);
    }
    let soup = read_bytes(bytes, from)?;
    let kept = Kept::of(&soup);
    let control = Control::new(soup, &options::build(told), told, &mut observer)?;
    let scale = Scale {
        diagonal: control.diagonal,
        is_rounded: rounding(to, &WriteOptions::default(), &[[0.1; 3]]) > 0.0,
    };
    let (found, channels) = exact_of(&control, told, goals, scale, &mut observer)?;
    let (held, lost): (Vec<Channel>, Vec<Channel>) = channels
        .into_iter()
        .partition(|channel| holds(to, &WriteOptions::default(), channel));
    let rounded = rounding(to, &WriteOptions::default(), found.mesh.positions());
    let reached = Reached::of(&found, goals, control.diagonal, rounded);
    let mut left_out: Vec<String> = lost.into_iter().map(|channel| channel.name).collect();
    left_out.extend(kept.left_out(to));
    Ok(FileOut {
        meshes: vec![mesh_told("", &found, &control, &reached)],
        bytes: kept.written(to, &found, &held)?,
        left_out,
    })
}

fn format(option: &str, name: &str) -> Result<Format, Failure> {
    let known = Format::from_path(Path::new(&format!("file.{name}")));
    known.map_err(|_| {
        let all: Vec<&str> = Format::ALL.iter().map(|own| own.extension()).collect();
        let message = format!("{option} is '{name}', expected one of {}", all.join(", "));
        Failure::option(option, message)
    })
}

/// What of a soup its output names again.
struct Kept {
    material_libraries: Vec<String>,
    texture_files: Vec<String>,
}

impl Kept {
    fn of(soup: &PolygonSoup) -> Self {
        Self {
            material_libraries: soup.material_libraries.clone(),
            texture_files: soup.texture_files.clone(),
        }
    }

    /// The files that a format does not name: what they say of materials and pictures goes with them.
    fn left_out(&self, format: Format) -> Vec<String> {
        let of = |own: Format, names: &[String]| match format == own {
            true => Vec::new(),
            false => names.to_vec(),
        };
        let mut names = of(Format::Obj, &self.material_libraries);
        names.extend(of(Format::Ply, &self.texture_files));
        names
    }

    fn written(
        &self,
        format: Format,
        found: &Exact,
        channels: &[Channel],
    ) -> Result<Vec<u8>, Failure> {
        let sides = Sides::of(found, format);
        let output = Output::new(found.mesh.as_triangles())
            .channels(channels)
            .material_libraries(&self.material_libraries)
            .texture_files(&self.texture_files);
        let output = match &sides {
            Some(sides) => sides.add_to(output),
            None => output.normals(&found.normals),
        };
        let mut bytes = Vec::new();
        write_to(&mut bytes, format, &output, &WriteOptions::default())?;
        Ok(bytes)
    }
}

/// Where a mesh has sharp edges: the normals of their sides as a format holds them.
enum Sides {
    /// Normals, and by corner which of them it has.
    OfCorners(Vec<[f64; 3]>, Vec<[u32; 3]>),
    /// Vertices stand once for each side.
    Split(SplitSurface),
}

impl Sides {
    /// None where each vertex has one normal.
    fn of(found: &Exact, format: Format) -> Option<Self> {
        if found.sides.is_empty() {
            return None;
        }
        if format.is_gltf() || format == Format::Ply {
            return Some(Self::Split(found.split_surface()));
        }
        let mut normals = found.normals.clone();
        let mut corners = found.mesh.triangles().to_vec();
        for &(corner, normal) in &found.sides {
            corners.as_flattened_mut()[corner as usize] = normals.len() as u32;
            normals.push(normal);
        }
        Some(Self::OfCorners(normals, corners))
    }

    fn add_to<'a>(&'a self, output: Output<'a>) -> Output<'a> {
        match self {
            Self::OfCorners(normals, corners) => output.normals_of_corners(normals, corners),
            Self::Split(split) => Output {
                surface: split.as_triangles(),
                ..output
            }
            .normals(&split.normals),
        }
    }
}

/// What is told of a refined mesh, which its file holds within these bounds.
pub(crate) fn mesh_told(name: &str, found: &Exact, control: &Control, reached: &Reached) -> Object {
    let (object, error) = (Object::new(), Object::new());
    set(&error, "lower", reached.error.lower);
    set(&error, "upper", reached.error.upper);
    set(&error, "certified", reached.error.certified);
    set(&object, "name", name);
    set(&object, "triangles", found.mesh.face_count() as f64);
    set(&object, "vertices", found.mesh.vertex_count() as f64);
    set(&object, "error", error);
    set(&object, "stop", reached.stop.name());
    let crease_angle = control.crease_angle.map(JsValue::from);
    set(
        &object,
        "creaseAngle",
        crease_angle.unwrap_or(JsValue::NULL),
    );
    set(&object, "diagnosis", told::diagnosis(&control.diagnosis));
    object
}

#[wasm_bindgen]
impl FileOut {
    /// The file, handed over once.
    pub fn bytes(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.bytes)
    }

    /// What is told of it.
    pub fn told(&self) -> Object {
        let object = Object::new();
        let meshes: Array = self.meshes.iter().collect();
        let left_out: Array = self.left_out.iter().map(JsValue::from).collect();
        set(&object, "meshes", meshes);
        set(&object, "leftOut", left_out);
        object
    }
}
