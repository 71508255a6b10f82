//! Triangular polynomials of degree 4 by their Bézier points: made from twelve control points of Loop's scheme,
//! divided, and restricted to sub-triangles.
//!
//! Point (j, k) has the weights (4 − j − k, j, k) of the corners 0, 1, 2; they stand in the order of j, then k.

use crate::vector::{Vector, add, middle, scale};

/// The Bézier points of a piece.
pub type Net = [Vector; 15];

/// The corners of a net, and the points over its side from each corner to the next.
pub const CORNERS: [usize; 3] = [0, 14, 4];
pub const SIDES: [[usize; 5]; 3] = [[0, 5, 9, 12, 14], [14, 13, 11, 8, 4], [4, 3, 2, 1, 0]];

/// Bézier points near a corner: how many times it, the next and the third corner count, and twenty-fourths of it and of its six
/// neighbours, counted from the next corner.
const STENCILS: [([usize; 3], [f64; 7]); 5] = [
    ([4, 0, 0], [12.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0]),
    ([3, 1, 0], [12.0, 4.0, 3.0, 1.0, 0.0, 1.0, 3.0]),
    ([3, 0, 1], [12.0, 3.0, 4.0, 3.0, 1.0, 0.0, 1.0]),
    ([2, 2, 0], [8.0, 8.0, 4.0, 0.0, 0.0, 0.0, 4.0]),
    ([2, 1, 1], [10.0, 6.0, 6.0, 1.0, 0.0, 0.0, 1.0]),
];

/// Where point (j, k) of a net of the degree `n` stands.
const fn at(n: usize, j: usize, k: usize) -> usize {
    j * (2 * n + 3 - j) / 2 + k
}

/// The net of a regular piece, from its corners and their six neighbours each, counted from the next corner.
pub fn regular(corners: [Vector; 3], rings: &[[Vector; 6]; 3]) -> Net {
    let mut net = [[0.0; 3]; 15];
    for i in 0..3 {
        for (counts, weights) in STENCILS {
            let points = [corners[i]].into_iter().chain(rings[i]);
            let sum = points
                .zip(weights)
                .fold([0.0; 3], |sum, (p, weight)| add(sum, scale(p, weight)));
            net[at(4, counts[(4 - i) % 3], counts[(5 - i) % 3])] = scale(sum, 1.0 / 24.0);
        }
    }
    net
}

/// The parts on both sides of the line from the middle of the side 0 1 to corner 2, which stays corner 2 of both.
pub fn halves(net: &Net) -> [Net; 2] {
    let (mut work, mut first, mut second) = (*net, *net, *net);
    for step in 1..5 {
        for k in 0..5 - step {
            for j in 0..5 - step - k {
                work[at(4, j, k)] = middle(work[at(4, j, k)], work[at(4, j + 1, k)]);
            }
            first[at(4, step, k)] = work[at(4, 0, k)];
            second[at(4, 4 - step - k, k)] = work[at(4, 4 - step - k, k)];
        }
    }
    [first, second]
}

/// The same piece, its corners counted from the next one.
pub fn turned(net: &Net) -> Net {
    let mut out = *net;
    for j in 0..5 {
        for k in 0..5 - j {
            out[at(4, j, k)] = net[at(4, 4 - j - k, j)];
        }
    }
    out
}

/// The net over the triangle with the given barycentric coordinates of its corners: its points are the blossom's values.
pub fn over(net: &Net, corners: &[Vector; 3]) -> Net {
    if let Some(turn) = (0..3).find(|turn| (0..3).all(|i| corners[i][(i + turn) % 3] == 1.0)) {
        return (0..turn).fold(*net, |net, _| turned(&net));
    }
    let (mut out, mut at_2) = (*net, *net);
    for k in 0..5 {
        let mut at_1 = at_2;
        for j in 0..5 - k {
            let mut at_0 = at_1;
            (1..5 - k - j)
                .rev()
                .for_each(|n| step(&mut at_0, n, corners[0]));
            out[at(4, j, k)] = at_0[0];
            if j + k < 4 {
                step(&mut at_1, 4 - k - j, corners[1]);
            }
        }
        if k < 4 {
            step(&mut at_2, 4 - k, corners[2]);
        }
    }
    out
}

/// One step of de Casteljau's algorithm, in place: degree `n` becomes `n − 1`.
fn step(net: &mut Net, n: usize, weights: Vector) {
    for j in 0..n {
        for k in 0..n - j {
            let [p, q, r] = [net[at(n, j, k)], net[at(n, j + 1, k)], net[at(n, j, k + 1)]];
            net[at(n - 1, j, k)] = add(
                add(scale(p, weights[0]), scale(q, weights[1])),
                scale(r, weights[2]),
            );
        }
    }
}
