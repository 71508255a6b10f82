//! Wireframes: the outline of a triangle is drawn as a whole, whatever stands beside it.

#![allow(clippy::unwrap_used)]

use limitmesh::Triangles;
use limitmesh_render::{Camera, Lighting, Style, ViewDirection, render};

const SIDE: u32 = 200;

/// The width of lines in pixels, large enough for either half of one to be looked at.
const WIDTH: f64 = 8.0;

/// How much darker the insides of a triangle's edges are than its middle, edge by edge, in steps of 8-bit colours; the triangle
/// is in pixels.
fn darkness(triangle: [[f64; 2]; 3], others: &[[[f64; 2]; 3]]) -> [f64; 3] {
    let all = others.iter().chain([&triangle]);
    let positions: Vec<[f64; 3]> = {
        // Equal corners are one vertex.
        let mut unique: Vec<[f64; 3]> = Vec::new();
        for &[x, y] in all.clone().flatten() {
            if !unique.contains(&[x, -y, 0.0]) {
                unique.push([x, -y, 0.0]);
            }
        }
        unique
    };
    let vertex =
        |&[x, y]: &[f64; 2]| positions.iter().position(|&p| p == [x, -y, 0.0]).unwrap() as u32;
    let triangles: Vec<[u32; 3]> = all
        .map(|corners| [0, 1, 2].map(|corner| vertex(&corners[corner])))
        .collect();
    let half = 0.5 * f64::from(SIDE);
    let camera = Camera::orthographic([half, -half, 0.0], ViewDirection::front(), half).unwrap();
    let surface = Triangles {
        positions: &positions,
        triangles: &triangles,
    };
    let style = Style::default()
        .lighting(Lighting::even())
        .wireframe(true)
        .wire_width(WIDTH as f32);
    let image = render(surface, None, None, &camera, &style, SIDE, SIDE).unwrap();
    let light = |x: f64, y: f64| {
        let pixel = image.pixel(x as u32, y as u32).unwrap();
        f64::from(pixel[0]) + f64::from(pixel[1]) + f64::from(pixel[2])
    };
    let centre = [0, 1].map(|axis| triangle.iter().map(|p| p[axis]).sum::<f64>() / 3.0);
    let blank = light(centre[0], centre[1]);
    [0, 1, 2].map(|edge| {
        let (a, b) = (triangle[edge], triangle[(edge + 1) % 3]);
        let middle = [0, 1].map(|axis| 0.5 * (a[axis] + b[axis]));
        let inwards = [0, 1].map(|axis| centre[axis] - middle[axis]);
        let depth = inwards[0].hypot(inwards[1]);
        // In the middle of the half of the line that this triangle draws.
        let inside = 0.25 * WIDTH / depth;
        blank
            - light(
                middle[0] + inside * inwards[0],
                middle[1] + inside * inwards[1],
            )
    })
}

/// An equilateral triangle with its centre in the middle of the picture, and its mirror images at its three edges, that at the
/// first edge with its own altitude instead.
fn with_neighbours(side: f64, altitude: f64) -> ([[f64; 2]; 3], Vec<[[f64; 2]; 3]>) {
    let radius = side / 3.0_f64.sqrt();
    let corner = |i: usize| {
        // Turned, so that no edge is along the pixels.
        let angle = (17.0 + 120.0 * i as f64).to_radians();
        let half = 0.5 * f64::from(SIDE);
        // Downwards is positive: counter-clockwise as seen.
        [half + radius * angle.cos(), half - radius * angle.sin()]
    };
    let triangle = [0, 1, 2].map(corner);
    let neighbours = (0..3).map(|edge| {
        let (a, b, c) = (
            triangle[edge],
            triangle[(edge + 1) % 3],
            triangle[(edge + 2) % 3],
        );
        let own = side * 0.75_f64.sqrt();
        let far = if edge == 0 { altitude / own } else { 1.0 };
        let opposite = [0, 1].map(|axis| {
            let middle = 0.5 * (a[axis] + b[axis]);
            middle + far * (middle - c[axis])
        });
        [b, a, opposite]
    });
    (triangle, neighbours.collect())
}

#[test]
fn the_edges_of_a_triangle_are_drawn_alike_whatever_is_beside_them() {
    let mut last = 0.0;
    // From triangles whose lines are nearly gone to those with full ones; beside slivers, and beside their mirror images.
    for side in [24.0, 30.0, 40.0, 50.0, 60.0, 70.0] {
        for altitude in [1.0, 6.0, side * 0.75_f64.sqrt()] {
            let (triangle, neighbours) = with_neighbours(side, altitude);
            let [first, second, third] = darkness(triangle, &neighbours);
            assert!(
                (first - second).abs() <= 3.0,
                "{side}, {altitude}: {first}, {second}"
            );
            assert!(
                (second - third).abs() <= 3.0,
                "{side}, {altitude}: {second}, {third}"
            );
            last = first;
        }
    }
    assert!(
        last > 300.0,
        "those of the largest are drawn in full: {last}"
    );
}

#[test]
fn smaller_triangles_have_paler_edges() {
    let darkness_of = |side: f64| {
        let (triangle, neighbours) = with_neighbours(side, 20.0);
        darkness(triangle, &neighbours)[0]
    };
    assert_eq!(
        [24.0, 30.0].map(darkness_of),
        [0.0; 2],
        "those of the smallest are left out"
    );
    let dark = [40.0, 45.0, 50.0, 55.0, 60.0].map(darkness_of);
    assert!(
        dark.windows(2).all(|pair| pair[1] > pair[0] + 20.0),
        "{dark:?}"
    );
}
