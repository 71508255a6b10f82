//! The readers of meshes, and the digest.

use limitmesh_check::read::mesh;
use limitmesh_check::sha256::digest;

const TEXT_PLY: &str = "ply\nformat ascii 1.0\ncomment a\nelement vertex 3\nproperty float x\nproperty uchar red\nproperty double y\n\
    property double z\nelement face 1\nproperty list uchar int vertex_indices\nproperty int n\n\
    property list uchar float texcoord\nend_header\n0 9 0 0\n1 9 0 0\n0 9 1.5 0\n3 0 1 2 7 2 0.5 -1\n";

#[test]
fn all_formats_give_the_same_mesh() {
    let obj =
        "# a\nv 0 0 0\nv 1 0 0 0.5\nv 0 1.5 0\nvt 0 0\nf 1/1/1 2//3 -1\nt crease 2/1/0 0 1 3\n";
    let off = "OFF # a\n3 1 0\n\n0 0 0\n1 0 0\n0 1.5 0\n3 0 1 2 255 0 0\n";
    let expected = mesh("a.obj", obj.as_bytes()).unwrap();
    assert_eq!(
        expected.positions,
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0]]
    );
    assert_eq!(expected.triangles, [[0, 1, 2]]);
    assert_eq!(mesh("b.OFF", off.as_bytes()).unwrap(), expected);
    assert_eq!(mesh("c.ply", TEXT_PLY.as_bytes()).unwrap(), expected);
    for (order, is_big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let mut bytes = TEXT_PLY[..TEXT_PLY.find("end_header").unwrap() + 11]
            .replace("ascii", order)
            .into_bytes();
        let mut push = |own: &[u8]| {
            let mut own = own.to_vec();
            if is_big {
                own.reverse();
            }
            bytes.extend(own);
        };
        for [x, y, z] in &expected.positions {
            push(&(*x as f32).to_le_bytes());
            push(&[9]);
            push(&y.to_le_bytes());
            push(&z.to_le_bytes());
        }
        push(&[3]);
        [0i32, 1, 2, 7].iter().for_each(|v| push(&v.to_le_bytes()));
        push(&[2]);
        [0.5f32, -1.0].iter().for_each(|x| push(&x.to_le_bytes()));
        assert_eq!(mesh("d.ply", &bytes).unwrap(), expected);
    }
}

#[test]
fn what_is_no_mesh_of_triangles_is_said() {
    for (name, text, words) in [
        ("a.stl", "solid", "ends with none"),
        ("a.obj", "v 0 0\n", "ends early"),
        ("a.obj", "v 0 0 x\n", "no number"),
        (
            "a.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3 4\n",
            "4 corners",
        ),
        ("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n", "not there"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n", "twice"),
        ("a.obj", "v 0 0 nan\n", "no position"),
        ("a.off", "COFF\n", "begin"),
        ("a.off", "OFF\n5000000 1 0\n0 0 0\n", "ends early"),
        ("a.ply", "ply\n", "no header"),
        (
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n",
            "ends early",
        ),
    ] {
        let what = mesh(name, text.as_bytes()).unwrap_err();
        assert!(what.contains(words), "{text:?}: {what}");
    }
    // Elements without properties take no memory.
    assert!(
        mesh(
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n"
        )
        .is_ok()
    );
}

/// The examples of FIPS 180-2, and a length on each side of a block's.
#[test]
fn digests_are_those_of_the_standard() {
    assert_eq!(
        digest(b"abc"),
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    );
    assert_eq!(
        digest(b""),
        "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    );
    assert_eq!(
        digest(b"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"
    );
    assert_eq!(
        digest(&[b'a'; 1_000_000]),
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"
    );
}
