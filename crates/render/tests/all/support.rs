//! Surfaces to draw, and what all drawing has in common.

#![allow(clippy::unwrap_used, reason = "a test's helpers fail the test")]

use limitmesh::Triangles;
use limitmesh_render::{Lighting, Style};

/// A square of corners this far from its middle, and its halves.
pub(crate) fn square(half: f64) -> [[f64; 3]; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [half * x, half * y, 0.0])
}

pub(crate) const HALVES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

pub(crate) fn halves(positions: &[[f64; 3]; 4]) -> Triangles<'_> {
    Triangles {
        positions,
        triangles: &HALVES,
    }
}

/// Light by which a surface that faces the viewer has its own colour.
pub(crate) fn own_colours() -> Style {
    let mut lighting = Lighting::even();
    // Half of the sky and half of the ground light such a surface: 0.42 + 0.58 / 2.
    (lighting.key, lighting.fill, lighting.ambient) = (0.0, 0.0, 1.0 / 0.71);
    Style::default().lighting(lighting)
}

/// Light of a channel of a picture.
pub(crate) fn linear(channel: u8) -> f64 {
    let c = f64::from(channel) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// So many threads.
pub(crate) fn pool(threads: usize) -> rayon::ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap()
}
