//! Which vertices of a mesh are one: those that stand and move together, and across primitives along open edges alone.

use super::support::{floats, glb};
use limitmesh_io::Asset;
use limitmesh_io::gltf::{Joining, MeshSoup};

/// A mesh of primitives, each with positions (three numbers a vertex) and further members that may name accessors of its
/// own bytes.
struct Builder {
    bin: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    primitives: Vec<String>,
}

impl Builder {
    fn new() -> Self {
        Self {
            bin: Vec::new(),
            views: Vec::new(),
            accessors: Vec::new(),
            primitives: Vec::new(),
        }
    }

    fn accessor(&mut self, bytes: Vec<u8>, count: usize, kind: &str, component: u32) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let (start, length) = (self.bin.len(), bytes.len());
        self.bin.extend(bytes);
        self.views.push(format!(
            r#"{{"buffer":0,"byteOffset":{start},"byteLength":{length}}}"#
        ));
        let view = self.views.len() - 1;
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"count":{count},"type":"{kind}","componentType":{component}}}"#
        ));
        self.accessors.len() - 1
    }

    fn points(&mut self, points: &[[f32; 3]]) -> usize {
        self.accessor(floats(points.as_flattened()), points.len(), "VEC3", 5126)
    }

    /// A primitive of positions alone.
    fn plain(&mut self, points: &[[f32; 3]]) {
        let points = self.points(points);
        let primitive = format!(r#"{{"attributes":{{"POSITION":{points}}}}}"#);
        self.primitives.push(primitive);
    }

    fn read(&self, joining: Joining) -> MeshSoup {
        self.asset().mesh(0, joining).unwrap()
    }

    fn asset(&self) -> Asset {
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{}]}}],"buffers":[{{"byteLength":{}}}],
                "bufferViews":[{}],"accessors":[{}]}}"#,
            self.primitives.join(","),
            self.bin.len(),
            self.views.join(","),
            self.accessors.join(",")
        );
        Asset::from_bytes(&glb(&json, &self.bin), None).unwrap()
    }
}

fn ignoring(skins: bool, morphs: bool, distance: f64) -> Joining {
    Joining::Ignoring {
        skins,
        morphs,
        distance,
    }
}

/// Two triangles over a common edge from (0, 0, 0) to (1, 0, 0), each with vertices of its own.
const APART: [[f32; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 0.0, 0.0],
    [-0.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
];

#[test]
fn what_stands_together_is_one() {
    let mut builder = Builder::new();
    builder.plain(&APART);
    assert_eq!(builder.read(Joining::Together).soup.positions.len(), 4);
    assert_eq!(builder.read(Joining::Never).soup.positions.len(), 6);
}

#[test]
fn what_morphs_apart_stays_apart() {
    let mut builder = Builder::new();
    let points = builder.points(&APART);
    // Of the edge's two ends one moves on one side only.
    let mut moved = [[0.0; 3]; 6];
    moved[1] = [0.0, 0.0, 1.0];
    let target = builder.points(&moved);
    builder.primitives.push(format!(
        r#"{{"attributes":{{"POSITION":{points}}},"targets":[{{"POSITION":{target}}},{{}}]}}"#
    ));
    let found = builder.read(Joining::Together);
    assert!(found.has_targets());
    assert_eq!(
        (
            found.soup.positions.len(),
            found.kept_apart.moving,
            found.kept_apart.touching
        ),
        (5, 1, 0)
    );
    assert_eq!(
        (found.kept_apart.by_skins, found.kept_apart.by_morphs),
        (0, 1)
    );
    // Joined all the same, they move as the first does.
    let found = builder.read(ignoring(false, true, 0.0));
    assert_eq!(found.soup.positions.len(), 4);
    assert_eq!(found.kept_apart.moving, 0);
    let table = &found.attributes[0];
    assert_eq!(
        (table.name.as_str(), table.plain_name(), table.target),
        ("targets[0].POSITION", "POSITION", Some(0))
    );
    for (&v, &value) in found.soup.faces.iter().flatten().zip(&table.corners) {
        let expected = if found.soup.positions[v as usize] == [1.0, 0.0, 0.0] {
            1.0
        } else {
            0.0
        };
        assert_eq!(
            table.values[3 * value as usize..][..3],
            [0.0, 0.0, expected]
        );
    }
}

#[test]
fn what_joints_move_apart_stays_apart() {
    let mut builder = Builder::new();
    let points = builder.points(&APART);
    // The same joints in another order and with weights of 0 between are the same; another weight is another.
    let joints = [
        [1u8, 2, 0, 0],
        [1, 2, 0, 0],
        [1, 0, 0, 0],
        [2, 7, 1, 0],
        [1, 2, 0, 0],
        [1, 0, 0, 0],
    ];
    let weights = [
        [0.75f32, 0.25, 0.0, 0.0],
        [0.5, 0.5, 0.0, 0.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.5, 0.0, 0.5, 0.0],
        [0.5, 0.5, 0.0, 0.0],
        [1.0, 0.0, 0.0, 0.0],
    ];
    let joints = builder.accessor(joints.as_flattened().to_vec(), 6, "VEC4", 5121);
    let weights = builder.accessor(floats(weights.as_flattened()), 6, "VEC4", 5126);
    builder.primitives.push(format!(
        r#"{{"attributes":{{"POSITION":{points},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}"#
    ));
    let found = builder.read(Joining::Together);
    assert_eq!(found.soup.positions.len(), 5);
    assert_eq!(found.kept_apart.moving, 1);
    assert_eq!(
        (found.kept_apart.by_skins, found.kept_apart.by_morphs),
        (1, 0)
    );
    let found = builder.read(ignoring(true, false, 0.0));
    assert_eq!(found.soup.positions.len(), 4);
    assert_eq!(found.kept_apart.moving, 0);
}

#[test]
fn primitives_are_joined_along_edges_that_match() {
    let mut builder = Builder::new();
    for half in [0..3, 3..6] {
        builder.plain(&APART[half]);
    }
    let found = builder.read(Joining::Together);
    assert_eq!(found.soup.positions.len(), 4);
    assert_eq!(found.kept_apart.touching, 0);
    let faces: Vec<_> = found
        .parts
        .iter()
        .map(|part| (part.primitive, part.faces.clone()))
        .collect();
    assert_eq!(faces, [(0, 0..1), (1, 1..2)]);
}

#[test]
fn primitives_that_touch_are_not_joined() {
    // The same edge the same way: two sheets on top of each other, with the third corners apart. And one corner alone.
    let same_way = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0f32]];
    let corner = [[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [-1.0, -1.0, 0.0f32]];
    for (other, touching) in [(same_way, 2), (corner, 1)] {
        let mut builder = Builder::new();
        for points in [[APART[0], APART[1], APART[2]], other] {
            builder.plain(&points);
        }
        let found = builder.read(Joining::Together);
        assert_eq!(found.soup.positions.len(), 6);
        assert_eq!(found.kept_apart.touching, touching);
    }
    // An edge that three primitives share is nobody's.
    let mut builder = Builder::new();
    for third in [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0f32]] {
        builder.plain(&if third[1] > 0.0 {
            [APART[0], APART[1], third]
        } else {
            [APART[1], APART[0], third]
        });
    }
    assert_eq!(builder.read(Joining::Together).soup.positions.len(), 9);
}

/// A primitive of one triangle whose corners stand here, with morph targets.
fn triangle(corners: [[f32; 3]; 3], targets: &[[[f32; 3]; 3]]) -> Builder {
    let mut builder = Builder::new();
    let points = builder.points(&corners);
    let targets: Vec<String> = targets
        .iter()
        .map(|moved| format!(r#"{{"POSITION":{}}}"#, builder.points(moved)))
        .collect();
    builder.primitives.push(format!(
        r#"{{"attributes":{{"POSITION":{points}}},"targets":[{}]}}"#,
        targets.join(",")
    ));
    builder
}

#[test]
fn faces_without_area_count_where_something_opens_them() {
    const LINE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0], [2.0, 4.0, 6.0]];
    const NOWHERE: [f32; 3] = [0.0; 3];
    const NONE: [u32; 0] = [];
    let lid = [NOWHERE, [0.0, 0.0, 1.0], NOWHERE];
    let opening =
        |corners, targets: &[_]| triangle(corners, targets).read(Joining::Never).soup.opening;
    assert_eq!(opening(LINE, &[]), NONE);
    assert_eq!(opening(LINE, &[[NOWHERE; 3], lid]), [0]);
    // Twice as large it is a line still, and a triangle with area counts by itself.
    assert_eq!(opening(LINE, &[LINE]), NONE);
    assert_eq!(
        opening([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[lid]),
        NONE
    );
    // Two corners leave a point in two directions: only together they make an area.
    let apart = [
        [NOWHERE, [1.0, 0.0, 0.0], NOWHERE],
        [NOWHERE, NOWHERE, [0.0, 1.0, 0.0]],
    ];
    assert_eq!(opening([NOWHERE; 3], &apart), [0]);
    assert_eq!(opening([NOWHERE; 3], &apart[..1]), NONE);
    // Joints open what they do not move as one.
    for (weights, expected) in [([1.0f32, 1.0, 1.0], &NONE[..]), ([1.0, 0.5, 1.0], &[0])] {
        let mut builder = Builder::new();
        let points = builder.points(&LINE);
        let joints = builder.accessor([0u8, 1, 0, 0].repeat(3), 3, "VEC4", 5121);
        let weights: Vec<f32> = weights
            .iter()
            .flat_map(|&own| [own, 1.0 - own, 0.0, 0.0])
            .collect();
        let weights = builder.accessor(floats(&weights), 3, "VEC4", 5126);
        builder.primitives.push(format!(
            r#"{{"attributes":{{"POSITION":{points},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}"#
        ));
        assert_eq!(builder.read(Joining::Together).soup.opening, expected);
    }
}

#[test]
fn a_distance_joins_what_rounding_tells_apart() {
    let mut points = APART;
    points[3] = [1.0, 1e-6, 0.0];
    let read = |distance| {
        let mut builder = Builder::new();
        builder.plain(&points);
        builder
            .read(ignoring(false, false, distance))
            .soup
            .positions
            .len()
    };
    assert_eq!([0.0, 1e-7, 1e-5].map(read), [5, 5, 4]);
    let mut builder = Builder::new();
    builder.plain(&APART);
    let asset = builder.asset();
    for distance in [-1.0, f64::NAN, f64::INFINITY] {
        let joining = ignoring(false, false, distance);
        let error = asset.mesh(0, joining).expect_err("no distance").to_string();
        assert!(error.contains("at least 0"), "{error}");
    }
}
