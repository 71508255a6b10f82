//! Triangles cut up, flat as they are, so that what varies inside of them can be drawn from values at vertices.

use limitmesh::Triangles;

/// Each triangle cut into `parts`² congruent ones, with vertices of its own.
///
/// Positions and triangles; the pieces of a triangle stand together, in the order of the triangles. One part and none
/// give the surface as it is.
pub fn dice(surface: Triangles<'_>, parts: usize) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    if parts <= 1 {
        return (surface.positions.to_vec(), surface.triangles.to_vec());
    }
    let corners_each = (parts + 1) * (parts + 2) / 2;
    let mut positions = Vec::with_capacity(surface.triangles.len() * corners_each);
    let mut triangles = Vec::with_capacity(surface.triangles.len() * parts * parts);
    for face in 0..surface.triangles.len() {
        let [a, b, c] = surface.corners(face);
        let first = positions.len() as u32;
        // Rows parallel to the side a b, from it to c; row i has `parts` − i + 1 vertices.
        let mut row = first;
        for i in 0..=parts {
            let length = (parts - i) as u32;
            for j in 0..=parts - i {
                let [u, v] = [j, i].map(|n| n as f64 / parts as f64);
                let at = |axis: usize| a[axis] * (1.0 - u - v) + b[axis] * u + c[axis] * v;
                positions.push([at(0), at(1), at(2)]);
            }
            let above = row + length + 1;
            for j in 0..length {
                triangles.push([row + j, row + j + 1, above + j]);
                if j + 1 < length {
                    triangles.push([row + j + 1, above + j + 1, above + j]);
                }
            }
            row = above;
        }
    }
    (positions, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_have_the_whole_area_and_its_direction() {
        let positions = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let surface = Triangles {
            positions: &positions,
            triangles: &[[0, 1, 2]],
        };
        for parts in 1..6 {
            let (positions, triangles) = dice(surface, parts);
            assert_eq!(triangles.len(), parts * parts);
            assert_eq!(positions.len(), (parts + 1) * (parts + 2) / 2);
            let pieces = Triangles {
                positions: &positions,
                triangles: &triangles,
            };
            for face in 0..triangles.len() {
                let [a, b, c] = pieces.corners(face);
                let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                assert!(
                    (doubled - 6.0 / (parts * parts) as f64).abs() < 1e-12,
                    "{doubled}"
                );
            }
        }
    }
}
