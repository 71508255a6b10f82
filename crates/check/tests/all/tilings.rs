//! Places that do not cover the control mesh, each by one fault.

use limitmesh_check::mesh::Mesh;
use limitmesh_check::vector::{Vector, add, scale};

use crate::cage::{Cage, WHOLE, octahedron};

/// Within this length everything is near enough.
const FAR: f64 = 10.0;

fn why(cage: &Cage) -> &'static str {
    let refused = cage.refused(FAR).unwrap();
    refused.first().map_or("", |&(_, what)| what)
}

#[test]
fn faults_of_the_tiling_are_named() {
    let good = Cage::new(octahedron()).refined().refined();
    assert_eq!(why(&good), "");
    let with = |change: &dyn Fn(&mut Cage)| {
        let mut cage = good.clone();
        change(&mut cage);
        why(&cage)
    };
    let removed = with(&|cage| {
        cage.mesh.triangles.remove(5);
        cage.parts.remove(5);
    });
    assert!(removed.contains("not covered once"), "{removed}");
    let doubled = with(&|cage| {
        cage.mesh.triangles.insert(5, cage.mesh.triangles[5]);
        cage.parts.insert(5, cage.parts[5]);
    });
    assert!(doubled.contains("in the same direction"), "{doubled}");
    let turned = with(&|cage| {
        cage.mesh.triangles[5].swap(1, 2);
        cage.parts[5].1.swap(1, 2);
    });
    assert!(turned.contains("in the same direction"), "{turned}");
    // The same triangles with corners of their own: nothing holds them together.
    let torn = with(&|cage| {
        let corners: Vec<Vector> = cage
            .mesh
            .triangles
            .iter()
            .flatten()
            .map(|&v| cage.mesh.positions[v as usize])
            .collect();
        cage.mesh.positions = corners;
        cage.mesh.triangles = (0..cage.mesh.triangles.len() as u32)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
            .collect();
    });
    assert!(torn.contains("does not go on"), "{torn}");
}

/// Two faces with the same three corners: triangles that pass from the one to the other inside of them leave half of both uncovered.
#[test]
fn faces_with_the_same_corners_are_two() {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [0.3, 1.0, 0.0]];
    let control = Mesh {
        positions: positions.clone(),
        triangles: vec![[0, 1, 2], [0, 2, 1]],
    };
    let half = scale(add(positions[1], positions[2]), 0.5);
    let (a, b, c) = ([WHOLE, 0, 0], [0, WHOLE, 0], [0, 0, WHOLE]);
    let (m, m_other) = ([0, WHOLE / 2, WHOLE / 2], [0, WHOLE / 2, WHOLE / 2]);
    let whole = Cage {
        mesh: Mesh {
            positions: [positions.clone(), vec![half]].concat(),
            triangles: vec![[0, 1, 3], [0, 3, 2], [0, 3, 1], [0, 2, 3]],
        },
        parts: vec![
            (0, [a, b, m]),
            (0, [a, m, c]),
            (1, [a, m_other, c]),
            (1, [a, b, m_other]),
        ],
        control,
    };
    // Edge a m runs twice the same way: refused. With a middle for each side it is right.
    assert!(!whole.refused(FAR).unwrap().is_empty());
    // Two copies of half of it, each closed in itself.
    let halves = Cage {
        mesh: Mesh {
            positions: [positions.clone(), vec![half], positions, vec![half]].concat(),
            triangles: vec![[0, 1, 3], [4, 5, 7], [0, 3, 1], [4, 7, 5]],
        },
        parts: vec![
            (0, [a, b, m]),
            (0, [a, b, m]),
            (1, [a, m, c]),
            (1, [a, m, c]),
        ],
        ..whole
    };
    let refused = halves.refused(FAR).unwrap();
    assert!(
        refused
            .iter()
            .all(|(_, what)| what.contains("does not go on"))
            && !refused.is_empty(),
        "{refused:?}"
    );
}

#[test]
fn proofs_that_are_damaged_are_no_proofs() {
    let cage = Cage::new(octahedron()).refined();
    let bytes = cage.proof(FAR);
    let read = |bytes: &[u8]| {
        let proof = limitmesh_check::proof::Proof::read(bytes)?;
        limitmesh_check::verdict::refused(&cage.control, &cage.mesh, &proof, FAR)
    };
    assert_eq!(read(&bytes).unwrap(), []);
    (0..bytes.len()).for_each(|end| assert!(read(&bytes[..end]).is_err(), "{end}"));
    assert!(read(&[&bytes[..], &[0]].concat()).is_err());
    let end = bytes
        .windows(5)
        .position(|window| window == b"\nend\n")
        .unwrap();
    // Any other byte gives an error, a refusal, or a proof that holds as well.
    for place in end..bytes.len() {
        for value in [0, 1, 7, 153, 158, 200, 255] {
            let mut changed = bytes.clone();
            changed[place] = value;
            let _ = read(&changed);
        }
    }
    // An edge that is sharp, and none of the mesh: 0 and 1 are opposite corners. And a vertex that isn't there.
    let sharp = |tags: &[u8]| {
        let mut tagged = bytes.clone();
        tagged.splice(end + 7..end + 9, tags.iter().copied());
        read(&tagged).map_err(|what| what.contains("does not have"))
    };
    let three = 3f64.to_le_bytes();
    assert_eq!(
        sharp(&[&[1, 0, 2][..], &three, &[1, 3], &three].concat()),
        Ok(vec![])
    );
    assert_eq!(sharp(&[&[1, 0, 1][..], &three, &[0]].concat()), Err(true));
    assert_eq!(sharp(&[&[0, 1, 99][..], &three].concat()), Err(true));
    let mut other = cage.clone();
    other.control.positions[3][0] += 1e-9;
    let proof = limitmesh_check::proof::Proof::read(&bytes).unwrap();
    let what =
        limitmesh_check::verdict::refused(&other.control, &other.mesh, &proof, FAR).unwrap_err();
    assert!(what.contains("another control mesh"), "{what}");
}
