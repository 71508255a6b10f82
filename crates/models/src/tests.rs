//! Every built-in model is a valid mesh of the promised counts, genus, orientation and quality.

use std::sync::OnceLock;

use super::{all, find};
use limitmesh_mesh::Mesh;
use limitmesh_mesh::mesh::BuildOptions;

/// What is promised of a model.
struct Promise {
    name: &'static str,
    triangles: usize,
    /// Number of boundary loops.
    loops: usize,
    genus: i64,
    /// Bound on the least angle of any triangle, in degrees.
    least_angle: f64,
}

const fn promise(
    name: &'static str,
    triangles: usize,
    loops: usize,
    genus: i64,
    least_angle: f64,
) -> Promise {
    Promise {
        name,
        triangles,
        loops,
        genus,
        least_angle,
    }
}

/// All models in their order, but for the cube of squares.
const PROMISES: [Promise; 16] = [
    promise("head", 142, 1, 0, 5.0),
    promise("shoe", 684, 0, 0, 3.0),
    promise("bunny", 900, 0, 0, 5.0),
    promise("teddy", 800, 0, 0, 5.0),
    promise("shark", 700, 0, 0, 4.0),
    promise("cup", 700, 0, 1, 10.0),
    promise("radish", 640, 0, 0, 5.0),
    promise("cusp", 480, 0, 0, 4.0),
    promise("sphere", 360, 0, 0, 15.0),
    promise("ellipsoid", 142, 0, 0, 30.0),
    promise("icosphere", 320, 0, 0, 50.0),
    promise("torus", 256, 0, 1, 25.0),
    promise("sheet", 288, 1, 0, 30.0),
    promise("bumpy", 320, 0, 0, 25.0),
    promise("spike", 320, 1, 0, 1.0),
    promise("tetrahedron", 4, 0, 0, 59.9),
];

/// The mesh of a model; each is generated once for all tests.
fn mesh(name: &str) -> &'static Mesh {
    static MESHES: OnceLock<Vec<(&str, Mesh)>> = OnceLock::new();
    let meshes = MESHES.get_or_init(|| {
        all()
            .iter()
            .map(|model| (model.name, built(model.name)))
            .collect()
    });
    &meshes
        .iter()
        .find(|(known, _)| *known == name)
        .unwrap_or_else(|| panic!("no model {name}"))
        .1
}

fn built(name: &str) -> Mesh {
    let soup = find(name)
        .unwrap_or_else(|| panic!("no model {name}"))
        .soup();
    // Strict: nothing about a model may need repair, but for the cube's squares.
    let options = BuildOptions::default().strict(name != "cube");
    Mesh::from_soup(&soup, &options)
        .unwrap_or_else(|error| panic!("{name}: {error}"))
        .0
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// Boundary loops, counted by walking each boundary edge once.
fn boundary_loops(mesh: &Mesh) -> usize {
    let topology = mesh.topology();
    let mut left: Vec<_> = topology
        .half_edges()
        .filter(|&h| topology.twin(h).is_none())
        .collect();
    let mut loops = 0;
    while let Some(start) = left.pop() {
        loops += 1;
        let mut at = topology.target(start);
        while let Some(next) = left.iter().position(|&h| topology.origin(h) == at) {
            at = topology.target(left.swap_remove(next));
        }
    }
    loops
}

/// The least angle of any triangle in degrees.
fn least_angle(mesh: &Mesh) -> f64 {
    let faces = mesh.as_triangles();
    let mut least = 180.0_f64;
    for face in 0..mesh.face_count() {
        let corners = faces.corners(face);
        for i in 0..3 {
            let u = subtract(corners[(i + 1) % 3], corners[i]);
            let v = subtract(corners[(i + 2) % 3], corners[i]);
            let normal = cross(u, v);
            least = least.min(dot(normal, normal).sqrt().atan2(dot(u, v)).to_degrees());
        }
    }
    least
}

/// Volume by the divergence theorem; for an open mesh with its boundary loop closed by a cone to its mean.
fn volume(mesh: &Mesh) -> f64 {
    let topology = mesh.topology();
    let mut sixfold = 0.0;
    for face in 0..mesh.face_count() {
        let [a, b, c] = mesh.as_triangles().corners(face);
        sixfold += dot(a, cross(b, c));
    }
    let position = |v: limitmesh_mesh::VertexId| mesh.positions()[v.index()];
    let rim: Vec<_> = topology
        .half_edges()
        .filter(|&h| topology.twin(h).is_none())
        .collect();
    let centre: [f64; 3] = core::array::from_fn(|i| {
        rim.iter()
            .map(|&h| position(topology.origin(h))[i])
            .sum::<f64>()
            / rim.len().max(1) as f64
    });
    for &h in &rim {
        sixfold += dot(
            centre,
            cross(position(topology.target(h)), position(topology.origin(h))),
        );
    }
    sixfold / 6.0
}

#[test]
fn every_model_is_promised_and_documented() {
    let names: Vec<_> = all().iter().map(|model| model.name).collect();
    let promised: Vec<_> = PROMISES
        .iter()
        .map(|promise| promise.name)
        .chain(["cube"])
        .collect();
    assert_eq!(names, promised);
    for model in all() {
        assert!(!model.about.is_empty());
        assert!(find(model.name).is_some_and(|found| found.about == model.about));
    }
    assert!(find("Head").is_none() && find("").is_none());
}

#[test]
fn counts_genus_and_boundaries_are_as_promised() {
    for promise in PROMISES {
        let mesh = mesh(promise.name);
        mesh.validate()
            .unwrap_or_else(|error| panic!("{}: {error}", promise.name));
        assert_eq!(mesh.face_count(), promise.triangles, "{}", promise.name);
        assert_eq!(boundary_loops(mesh), promise.loops, "{}", promise.name);
        let euler = 2 - 2 * promise.genus - promise.loops as i64;
        assert_eq!(
            mesh.topology().euler_characteristic(),
            euler,
            "{}",
            promise.name
        );
    }
}

#[test]
fn triangles_are_well_shaped_and_look_outwards() {
    for promise in PROMISES {
        let mesh = mesh(promise.name);
        let least = least_angle(mesh);
        assert!(
            least > promise.least_angle,
            "{}: least angle {least}°",
            promise.name
        );
        // The sheet encloses nothing: it looks up.
        if promise.name == "sheet" {
            let up: f64 = mesh
                .topology()
                .triangles()
                .iter()
                .enumerate()
                .map(|(face, _)| mesh.face_normal(limitmesh_mesh::FaceId(face as u32))[1])
                .sum();
            assert!(up > 0.0);
        } else {
            assert!(
                volume(mesh) > 0.02,
                "{}: volume {}",
                promise.name,
                volume(mesh)
            );
        }
    }
}

#[test]
fn sizes_are_about_one() {
    for model in all() {
        let soup = model.soup();
        let largest = soup
            .positions
            .as_flattened()
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!((0.4..1.3).contains(&largest), "{}: {largest}", model.name);
    }
}

#[test]
fn repeated_generation_gives_the_same_bits() {
    for model in all() {
        let (first, second) = (model.soup(), model.soup());
        let bits = |soup: &limitmesh_mesh::PolygonSoup| -> Vec<u64> {
            soup.positions
                .as_flattened()
                .iter()
                .map(|x| x.to_bits())
                .collect()
        };
        assert_eq!(bits(&first), bits(&second), "{}", model.name);
        assert_eq!(first.faces, second.faces, "{}", model.name);
    }
}

#[test]
fn sculpted_models_are_mirror_images_of_themselves() {
    for name in ["head", "bunny", "teddy", "shark", "radish", "cusp"] {
        let mesh = mesh(name);
        let find = |p: [f64; 3]| {
            mesh.positions()
                .iter()
                .position(|&q| q == p)
                .map(|v| v as u32)
        };
        let image: Vec<u32> = mesh
            .positions()
            .iter()
            .map(|&[x, y, z]| {
                find([-x, y, z]).unwrap_or_else(|| panic!("{name}: no image of {:?}", [x, y, z]))
            })
            .collect();
        let sorted = |mut faces: Vec<[u32; 3]>| {
            faces.iter_mut().for_each(|f| {
                let least = (0..3).min_by_key(|&i| f[i]).unwrap_or(0);
                f.rotate_left(least);
            });
            faces.sort_unstable();
            faces
        };
        let mirrored = mesh
            .triangles()
            .iter()
            .map(|&[a, b, c]| [a, c, b].map(|v| image[v as usize]))
            .collect();
        assert_eq!(
            sorted(mirrored),
            sorted(mesh.triangles().to_vec()),
            "{name}"
        );
    }
}

#[test]
fn closed_forms_lie_where_they_should() {
    for name in ["sphere", "icosphere", "tetrahedron"] {
        for &p in mesh(name).positions() {
            assert!((dot(p, p) - 1.0).abs() < 1e-12, "{name}: {p:?}");
        }
    }
    for &[x, y, z] in mesh("torus").positions() {
        let out = (x * x + z * z).sqrt() - 0.7;
        assert!((out * out + y * y - 0.09).abs() < 1e-12);
    }
    for &[x, y, z] in mesh("ellipsoid").positions() {
        assert!(((x / 0.5).powi(2) + (y / 0.8).powi(2) + (z / 0.6).powi(2) - 1.0).abs() < 1e-12);
    }
    let valence = |name: &str| {
        let mesh = mesh(name);
        let valences: Vec<u32> = mesh
            .topology()
            .vertices()
            .map(|v| mesh.topology().valence_and_openness(v).0)
            .collect();
        (
            valences.iter().copied().min().unwrap(),
            valences.iter().copied().max().unwrap(),
        )
    };
    assert_eq!(valence("sphere"), (5, 20));
    assert_eq!(valence("icosphere"), (5, 6));
    assert_eq!(valence("torus"), (6, 6));
    assert_eq!(valence("ellipsoid"), (5, 6));
    assert_eq!(valence("tetrahedron"), (3, 3));
    assert_eq!(valence("spike").1, 64);
}

#[test]
fn the_cube_builds() {
    let soup = find("cube").unwrap().soup();
    assert_eq!((soup.faces.len(), soup.positions.len()), (6, 8));
    // Each square is planar and looks away from the centre.
    for face in soup.faces.iter() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| soup.positions[face[i] as usize]);
        let normal = cross(subtract(b, a), subtract(d, a));
        assert!((dot(normal, a) - 0.5).abs() < 1e-15 && (dot(normal, c) - 0.5).abs() < 1e-15);
    }
    let cube = mesh("cube");
    assert_eq!(
        (cube.face_count(), cube.topology().euler_characteristic()),
        (12, 2)
    );
    assert!((volume(cube) - 1.0).abs() < 1e-12);
}
