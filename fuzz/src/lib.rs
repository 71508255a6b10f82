//! What every fuzz target does with its bytes: read them, build a mesh of what was read, write and read it again.

use std::io::{Cursor, Write};

use limitmesh::Mesh;
use limitmesh::carry::{carried, goal};
use limitmesh::mesh::{BuildOptions, Channel, PolygonSoup, Weld};
use limitmesh::refine::{ExactOptions, Traced, UniformOptions, exact, uniform};
use limitmesh::scheme::Loop;
use limitmesh_io::gltf::{CornerAttribute, Geometry, Joining, MeshSoup, VertexAttribute, WithTangents};
use limitmesh_io::threemf::{NewTriangles, Source};
use limitmesh_io::{Asset, Format, Output, Package, WriteOptions, read_bytes, write_to};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Most faces and corners that are built into a mesh, to keep each run short; reading has no limit.
const LARGEST: usize = 4096;

/// Reads `bytes` and goes on with what they hold; panics where a promise of the library is broken.
pub fn read_and_build(bytes: &[u8], format: Format) {
    let Ok(soup) = read_bytes(bytes, format) else { return };
    let vertices = soup.positions.len();
    assert!(soup.faces.iter().flatten().all(|&v| (v as usize) < vertices), "an index beyond the vertices");
    assert!(soup.positions.as_flattened().iter().all(|x| x.is_finite()), "a coordinate that is not finite");
    if soup.faces.len() > LARGEST || soup.faces.corner_count() > LARGEST {
        return;
    }
    for weld in [Weld::Exact, Weld::Never, Weld::Within(0.25)] {
        for strict in [false, true] {
            build(&soup, &BuildOptions::default().weld(weld).strict(strict));
        }
    }
}

fn build(soup: &PolygonSoup, options: &BuildOptions) {
    let Ok((mesh, _)) = Mesh::from_soup(soup, options) else { return };
    if let Err(error) = mesh.validate() {
        panic!("{options:?} built a mesh that is not valid: {error}");
    }
    let output = Output::new(mesh.as_triangles()).creases(&mesh.tags().creases).corners(&mesh.tags().corners);
    for format in [Format::Obj, Format::Ply, Format::Off] {
        let mut bytes = Vec::new();
        if let Err(error) = write_to(&mut bytes, format, &output, &WriteOptions::default()) {
            panic!("a valid mesh cannot be written: {error}");
        }
        match read_bytes(&bytes, format) {
            Ok(again) => assert_eq!(again.positions, mesh.positions(), "positions changed in {format}"),
            Err(error) => panic!("what was written cannot be read: {error}"),
        }
    }
}

/// The tables that are wanted as one attribute of vertices.
fn at_vertices(
    own: &MeshSoup,
    (name, width): (&str, usize),
    is_wanted: impl Fn(&CornerAttribute) -> bool,
) -> VertexAttribute {
    let mut values = vec![0.0; width * own.soup.positions.len()];
    for table in own.attributes.iter().filter(|table| table.width == width && is_wanted(table)) {
        for (&v, &value) in own.soup.faces.iter().flatten().zip(&table.corners) {
            let value = &table.values[width * value as usize..][..width];
            values[width * v as usize..][..width].copy_from_slice(value);
        }
    }
    VertexAttribute { name: name.to_owned(), width, values, is_integer: false }
}

/// How a morph target moves the vertices of a mesh.
fn displacement(own: &MeshSoup, target: usize) -> VertexAttribute {
    at_vertices(own, ("POSITION", 3), |table| table.target == Some(target) && table.is_displacement())
}

/// Takes the meshes out of a glTF document, puts them back, and reads what is written.
pub fn edit(bytes: &[u8]) {
    let Ok(mut asset) = Asset::from_bytes(bytes, None) else { return };
    let _ = asset.contents();
    for mesh in 0..asset.mesh_count().min(16) {
        let Ok(own) = asset.mesh(mesh, Joining::Together) else { continue };
        let positions = &own.soup.positions;
        for part in own.parts.iter().filter(|part| part.faces.len() <= LARGEST) {
            let faces = part.faces.clone().map(|face| own.soup.faces.get(face));
            let fans = faces.flat_map(|face| (2..face.len()).map(move |i| [face[0], face[i - 1], face[i]]));
            let triangles: Vec<[u32; 3]> = fans.collect();
            let targets: Vec<Vec<VertexAttribute>> =
                (0..part.targets.len()).map(|target| vec![displacement(&own, target)]).collect();
            let (normals, attributes, targets) = (None, &[][..], &targets[..]);
            let geometry = Geometry { positions, normals, triangles: &triangles, attributes, targets };
            let _ = asset.replace(mesh, part.primitive, &geometry);
            let _ = asset.tangent_coordinates(mesh, part.primitive);
            let texture = [at_vertices(&own, ("TEXCOORD_0", 2), |table| table.name == "TEXCOORD_0")];
            // Some directions, and some that are none.
            let geometry = Geometry { normals: Some(positions), attributes: &texture, ..geometry };
            let moved: Vec<usize> = (0..targets.len()).collect();
            if let Some(found) = WithTangents::of(&geometry, "TEXCOORD_0", &moved) {
                let _ = asset.replace(mesh, part.primitive, &found.geometry());
            }
        }
    }
    for format in [Format::Glb, Format::Gltf] {
        let Ok(written) = asset.to_bytes(format) else { continue };
        if let Err(error) = Asset::from_bytes(&written, None) {
            panic!("what was written cannot be read: {error}");
        }
    }
}

/// Faces of meshes that are refined, at most.
const FEW: usize = 64;

/// One input of so many is refined exactly, too: its bounds take five times as long as all the rest, and are not what is
/// looked for.
const RARE: usize = 8;

/// Reads a mesh, carries its channels to refined ones, writes these in every format that holds some, and reads them again.
pub fn carry(bytes: &[u8], format: Format) {
    let Ok(soup) = read_bytes(bytes, format) else { return };
    if soup.faces.len() > FEW || soup.faces.corner_count() > 4 * FEW || soup.channels.len() > 8 {
        return;
    }
    let Ok((mesh, _, trace)) = Mesh::from_soup_traced(&soup, &BuildOptions::default()) else { return };
    let channels: Result<Vec<_>, _> =
        soup.channels.iter().map(|own| own.on_mesh(&soup, &mesh, &trace)).collect();
    let channels = match channels {
        Ok(channels) => channels,
        Err(error) => panic!("a channel that was read does not fit: {error}"),
    };
    let levels = if mesh.face_count() > FEW / 8 { 1 } else { 2 };
    if let Ok(found) = uniform(&mesh, &Loop, &UniformOptions::default().levels(levels).origins(true)) {
        write_carried(&channels, &mesh, &found);
    }
    if bytes.len().is_multiple_of(RARE) {
        let size =
            |own: &Channel| own.values.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
        let goals = channels.iter().filter_map(|own| goal(own, &mesh, 0.2 * size(own)).ok().flatten());
        let options = ExactOptions::default()
            .tolerance(0.05 * mesh.diagonal().max(f64::MIN_POSITIVE))
            .attributes(goals.collect())
            .max_triangles(Some(16 * FEW))
            .flat_regions(false)
            .origins(true);
        if let Ok(found) = exact(&mesh, &Loop, &options) {
            write_carried(&channels, &mesh, &found);
        }
    }
}

/// Carries channels to a refined mesh, writes it with them, and reads what was written.
fn write_carried(channels: &[Channel], mesh: &Mesh, found: &dyn Traced) {
    // Values may overflow where they are blended.
    let Ok(channels) = carried(channels, mesh, &Loop, found) else { return };
    let output = Output::new(found.mesh().as_triangles()).channels(&channels);
    for (format, ascii) in [
        (Format::Obj, false),
        (Format::Ply, true),
        (Format::Ply, false),
        (Format::Off, false),
        (Format::Stl, true),
    ] {
        let mut bytes = Vec::new();
        if write_to(&mut bytes, format, &output, &WriteOptions::default().ascii(ascii)).is_ok()
            && let Err(error) = read_bytes(&bytes, format)
        {
            panic!("what was written cannot be read: {error}");
        }
    }
}

/// A package whose model is these bytes.
pub fn packed(model: &[u8]) -> Vec<u8> {
    const RELATIONSHIPS: &[u8] = b"<Relationships><Relationship Target=\"/a.model\" \
        Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in
        [("_rels/.rels", RELATIONSHIPS), ("a.model", model), ("Metadata/Slic3r_PE_model.config", model)]
    {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        let written = writer.start_file(name, options).map(|()| writer.write_all(bytes));
        assert!(matches!(written, Ok(Ok(()))), "memory can be written to");
    }
    writer.finish().map(Cursor::into_inner).unwrap_or_default()
}

/// Takes the triangles out of a 3MF package, puts them back in reverse, and reads what is written.
pub fn edit_package(bytes: Vec<u8>) {
    let Ok(mut package) = Package::from_bytes(bytes) else { return };
    let _ = (package.contents(), package.bounding_box());
    for object in 0..package.object_count().min(16) {
        let soup = package.object(object, true).soup;
        let triangles: Vec<[u32; 3]> = soup.faces.iter().filter_map(|face| face.try_into().ok()).collect();
        let last = triangles.len() - 1;
        let centre = Some([[0.4, 0.3, 0.3], [0.3, 0.4, 0.3], [0.3, 0.3, 0.4]]);
        let source = |triangle: usize| Source { face: last - triangle, corners: centre };
        let positions = &soup.positions;
        let new =
            NewTriangles { positions, triangles: &triangles, source: &source, keeps: &|name| name != "pid" };
        let _ = package.replace(object, &new);
    }
    let Ok(written) = package.to_bytes() else { return };
    match Package::from_bytes(written) {
        Ok(again) => assert_eq!(again.object_count(), package.object_count()),
        Err(error) => panic!("what was written cannot be read: {error}"),
    }
}
