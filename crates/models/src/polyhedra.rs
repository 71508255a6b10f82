//! Small exact shapes: tetrahedron, cube, and what grows from the icosahedron.

use super::sculpt::Surface;
use glam::DVec3;
use limitmesh_mesh::PolygonSoup;
use limitmesh_mesh::mesh::PolygonFaces;

/// Regular, 4 triangles, on the unit sphere; the smallest closed mesh, all valences 3.
pub(super) fn tetrahedron() -> PolygonSoup {
    let s = 1.0 / 3.0_f64.sqrt();
    let positions = vec![[s, s, s], [-s, -s, s], [-s, s, -s], [s, -s, -s]];
    let faces: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    PolygonSoup {
        positions,
        faces: faces.iter().map(|f| &f[..]).collect(),
        ..PolygonSoup::default()
    }
}

/// The cube from −1/2 to 1/2, 6 squares.
pub(super) fn cube() -> PolygonSoup {
    // Bit i of the index is the side along axis i.
    let positions = (0..8_u32)
        .map(|v| core::array::from_fn(|axis| f64::from(v >> axis & 1) - 0.5))
        .collect();
    let mut faces = PolygonFaces::default();
    for axis in 0..3 {
        let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        faces.push(&[0, v, u | v, u]);
        let far = 1 << axis;
        faces.push(&[far, far | u, far | u | v, far | v]);
    }
    PolygonSoup {
        positions,
        faces,
        ..PolygonSoup::default()
    }
}

/// The icosahedron with every triangle split in four and its vertices put on the unit sphere, `levels` times.
pub(super) fn icosphere(levels: usize) -> Surface {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    // Three golden rectangles in the coordinate planes: vertex 4·axis + signs.
    let positions = (0..12_usize)
        .map(|v| {
            let side = |bit: usize| if v & bit == 0 { -1.0 } else { 1.0 };
            let mut p = [0.0; 3];
            p[v / 4] = side(1);
            p[(v / 4 + 1) % 3] = golden * side(2);
            DVec3::from_array(p).normalize()
        })
        .collect();
    let mut sphere = Surface {
        positions,
        triangles: Vec::new(),
    };
    // The faces are the triples at the edge length, oriented outwards.
    let edge = 4.0 / (golden * golden + 1.0);
    let near = |a: DVec3, b: DVec3| (a.distance_squared(b) - edge).abs() < 0.1;
    for a in 0..12_u32 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|v| sphere.positions[v as usize]);
                if near(p, q) && near(q, r) && near(r, p) {
                    let outwards = p.dot(q.cross(r)) > 0.0;
                    sphere
                        .triangles
                        .push(if outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..levels {
        sphere = sphere.split_in_four();
        sphere.positions.iter_mut().for_each(|p| *p = p.normalize());
    }
    sphere
}

/// The 320-triangle icosphere with smooth bumps and dents: a polynomial of the direction shifts the radius.
pub(super) fn bumpy() -> Surface {
    let mut sphere = icosphere(2);
    for p in &mut sphere.positions {
        // Harmonic polynomials of degrees 3, 4 and 5, so that bumps of several widths overlap without symmetry.
        let DVec3 { x, y, z } = *p;
        let third = 5.0 * x * y * z;
        let fourth = 1.1 * (x * x * x * x - 6.0 * x * x * y * y + y * y * y * y);
        let fifth = 2.4 * (y * y - z * z) * x * (3.0 * z * z - x * x);
        *p *= 0.85 + 0.13 * third + 0.1 * fourth + 0.12 * fifth;
    }
    sphere
}
