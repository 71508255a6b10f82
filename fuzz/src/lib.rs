//! What every fuzz target does with its bytes: read them, build a mesh of what was read, write and read it again.

use limitmesh::Mesh;
use limitmesh::mesh::{BuildOptions, PolygonSoup, Weld};
use limitmesh_io::gltf::{Geometry, Joining};
use limitmesh_io::{Asset, Format, Output, WriteOptions, read_bytes, write_to};

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

/// Takes the meshes out of a glTF document, puts them back, and reads what is written.
pub fn edit(bytes: &[u8]) {
    let Ok(mut asset) = Asset::from_bytes(bytes, None) else { return };
    let _ = asset.contents();
    for mesh in 0..asset.mesh_count().min(16) {
        let Ok(own) = asset.mesh(mesh, Joining::Together) else { continue };
        let positions = &own.soup.positions;
        for part in own.parts.iter().filter(|part| part.faces.len() <= LARGEST) {
            let faces = part.faces.clone().map(|face| own.soup.faces.get(face));
            let triangles: Vec<[u32; 3]> = faces.filter_map(|face| face.try_into().ok()).collect();
            let _ = asset.replace(mesh, part.primitive, &Geometry { positions, normals: None, triangles: &triangles, attributes: &[] });
        }
    }
    for format in [Format::Glb, Format::Gltf] {
        let Ok(written) = asset.to_bytes(format) else { continue };
        if let Err(error) = Asset::from_bytes(&written, None) {
            panic!("what was written cannot be read: {error}");
        }
    }
}
