//! What a picture shows, against geometry known beforehand: coverage, depth, lines, light, framing.

#![allow(clippy::unwrap_used)]

use crate::support::linear;
use limitmesh::Triangles;
use limitmesh_render::{
    Camera, Image, Lighting, RenderError, Shading, Style, ViewDirection, render,
};

const BLACK: [u8; 4] = [0, 0, 0, 255];

/// A mesh for drawing.
#[derive(Clone, Default)]
struct Shape {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Shape {
    fn view(&self) -> Triangles<'_> {
        Triangles {
            positions: &self.positions,
            triangles: &self.triangles,
        }
    }

    /// An axis-parallel rectangle at height z, facing +z.
    fn rectangle(mut self, low: [f64; 2], high: [f64; 2], z: f64) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(
            [
                [low[0], low[1]],
                [high[0], low[1]],
                [high[0], high[1]],
                [low[0], high[1]],
            ]
            .map(|[x, y]| [x, y, z]),
        );
        self.triangles
            .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        self
    }

    /// A unit sphere of many slices.
    fn sphere(slices: u32) -> Self {
        let mut shape = Self::default();
        let stacks = slices / 2;
        for i in 0..=stacks {
            let polar = std::f64::consts::PI * f64::from(i) / f64::from(stacks);
            for j in 0..slices {
                let turn = std::f64::consts::TAU * f64::from(j) / f64::from(slices);
                shape.positions.push([
                    polar.sin() * turn.sin(),
                    polar.cos(),
                    polar.sin() * turn.cos(),
                ]);
            }
        }
        for i in 0..stacks {
            for j in 0..slices {
                let at = |i: u32, j: u32| i * slices + j % slices;
                shape
                    .triangles
                    .push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                shape
                    .triangles
                    .push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        shape
    }
}

/// A camera along −z in which one unit is one pixel and the origin is in the middle of the picture.
fn pixel_camera(height: u32) -> Camera {
    Camera::orthographic([0.0; 3], ViewDirection::front(), f64::from(height) / 2.0).unwrap()
}

/// White surfaces on black, everywhere as bright as white can be.
fn mask() -> Style {
    let glow = {
        let mut lighting = Lighting::studio();
        lighting.ambient = 100.0;
        lighting
    };
    Style::default()
        .surface_colour([255; 3])
        .back_colour([255; 3])
        .background(BLACK)
        .lighting(glow)
}

/// The part of the picture that a mask covers, in pixels.
fn covered(image: &Image) -> f64 {
    image.rgba().chunks_exact(4).map(|p| linear(p[0])).sum()
}

fn draw(shape: &Shape, camera: &Camera, style: &Style, width: u32, height: u32) -> Image {
    render(shape.view(), None, None, camera, style, width, height).unwrap()
}

#[test]
fn a_square_covers_exactly_its_pixels() {
    let square = Shape::default().rectangle([-10.0, -6.0], [14.0, 8.0], 0.0);
    for samples in [1, 2, 4, 8] {
        let image = draw(&square, &pixel_camera(40), &mask().samples(samples), 60, 40);
        for y in 0..40 {
            for x in 0..60 {
                let inside = (20..44).contains(&x) && (12..26).contains(&y);
                assert_eq!(
                    image.pixel(x, y).unwrap()[0] > 127,
                    inside,
                    "pixel {x}, {y}"
                );
                assert!(
                    matches!(image.pixel(x, y).unwrap()[0], 0 | 255),
                    "no border is blurred"
                );
            }
        }
    }
}

#[test]
fn a_sphere_has_the_area_of_its_outline() {
    let sphere = Shape::sphere(200);
    let (width, height) = (300, 240);
    for perspective in [false, true] {
        let (camera, radius) = if perspective {
            let eye = [0.0, 0.0, 4.0];
            let camera = Camera::perspective(eye, [0.0; 3], [0.0, 1.0, 0.0], 40.0).unwrap();
            // The cone of sight touches the sphere at the sine 1/4 of its half angle.
            let outline = (0.25f64).asin().tan() / 20f64.to_radians().tan();
            (camera, 120.0 * outline)
        } else {
            (
                Camera::orthographic([0.0; 3], ViewDirection::front(), 1.2).unwrap(),
                100.0,
            )
        };
        let area = covered(&draw(&sphere, &camera, &mask(), width, height));
        let expected = std::f64::consts::PI * radius * radius;
        assert!(
            (area / expected - 1.0).abs() < 0.003,
            "perspective {perspective}: {area}, not {expected}"
        );
    }
}

#[test]
fn nearer_surfaces_hide_farther_ones_whatever_their_order() {
    let cameras = [
        pixel_camera(20),
        Camera::perspective([0.0, 0.0, 30.0], [0.0; 3], [0.0, 1.0, 0.0], 36.87).unwrap(),
    ];
    let near = Shape::default().rectangle([-4.0, -4.0], [4.0, 4.0], 1.0);
    for camera in cameras {
        for swapped in [false, true] {
            let mut shape = near.clone().rectangle([-9.0, -9.0], [9.0, 9.0], 0.0);
            if swapped {
                shape.triangles.reverse();
            }
            let colours: Vec<[u8; 3]> = (0..8)
                .map(|v| if v < 4 { [255, 0, 0] } else { [0, 255, 0] })
                .collect();
            let image =
                render(shape.view(), None, Some(&colours), &camera, &mask(), 20, 20).unwrap();
            let [r, g, ..] = image.pixel(10, 10).unwrap();
            assert!(r > 200 && g < 60, "the near one is seen: {r}, {g}");
            let [r, g, ..] = image.pixel(3, 10).unwrap();
            assert!(r < 60 && g > 200, "the far one shows around it: {r}, {g}");
        }
    }
}

#[test]
fn surfaces_that_cross_are_cut_where_they_meet() {
    // Two planes through the y axis: z = x and z = −x. Left of it the second is nearer, right of it the first.
    let mut shape = Shape::default();
    for slope in [1.0, -1.0] {
        let first = shape.positions.len() as u32;
        shape.positions.extend(
            [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]].map(|[x, y]| [x, y, slope * x]),
        );
        shape
            .triangles
            .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    let colours: Vec<[u8; 3]> = (0..8)
        .map(|v| if v < 4 { [255, 0, 0] } else { [0, 255, 0] })
        .collect();
    let (camera, style) = (pixel_camera(20), mask());
    let image = render(shape.view(), None, Some(&colours), &camera, &style, 20, 20).unwrap();
    for y in 2..18 {
        for x in 2..18 {
            let [r, g, ..] = image.pixel(x, y).unwrap();
            assert_eq!(r > g, x >= 10, "pixel {x}, {y}");
        }
    }
}

#[test]
fn outside_and_inside_have_their_own_colours() {
    let square = Shape::default().rectangle([-8.0, -8.0], [8.0, 8.0], 0.0);
    let style = Style::default()
        .surface_colour([20, 20, 250])
        .back_colour([250, 20, 20]);
    let from_behind =
        Camera::orthographic([0.0; 3], ViewDirection::along([0.0, 0.0, 1.0]), 10.0).unwrap();
    let [r, _, b, _] = draw(&square, &pixel_camera(20), &style, 20, 20)
        .pixel(10, 10)
        .unwrap();
    assert!(b > r + 50);
    let [r, _, b, _] = draw(&square, &from_behind, &style, 20, 20)
        .pixel(10, 10)
        .unwrap();
    assert!(r > b + 50);
}

#[test]
fn light_falls_from_the_upper_left() {
    let camera = Camera::orthographic([0.0; 3], ViewDirection::front(), 1.1).unwrap();
    for shading in [Shading::Flat, Shading::Smooth] {
        let style = Style::default().shading(shading);
        let image = draw(&Shape::sphere(60), &camera, &style, 110, 110);
        let grey = |x, y| image.pixel(x, y).unwrap()[1];
        assert!(
            grey(35, 35) > grey(75, 75) + 30 && grey(55, 30) > grey(55, 80) + 30,
            "{shading:?}"
        );
    }
}

/// Smooth shading of a sphere by its own normals cannot depend on how finely it is cut; flat shading does.
#[test]
fn smooth_normals_hide_the_triangles() {
    let camera = Camera::orthographic([0.0; 3], ViewDirection::front(), 1.4).unwrap();
    let picture = |slices: u32, shading: Shading| {
        let sphere = Shape::sphere(slices);
        let style = Style::default().shading(shading);
        let normals = Some(&sphere.positions[..]);
        render(sphere.view(), normals, None, &camera, &style, 100, 100).unwrap()
    };
    let farthest = |a: &Image, b: &Image| {
        let pixels = (30..70).flat_map(|y| (30..70).map(move |x| (x, y)));
        pixels
            .map(|(x, y)| a.pixel(x, y).unwrap()[1].abs_diff(b.pixel(x, y).unwrap()[1]))
            .max()
            .unwrap()
    };
    let fine = picture(160, Shading::Smooth);
    assert!(farthest(&picture(40, Shading::Smooth), &fine) <= 3);
    assert!(farthest(&picture(16, Shading::Flat), &fine) > 12);
}

/// Dark lines on white: how much of a row or column they cover, in pixels.
fn darkness(image: &Image, places: impl Iterator<Item = (u32, u32)>) -> f64 {
    places
        .map(|(x, y)| 1.0 - linear(image.pixel(x, y).unwrap()[1]))
        .sum()
}

#[test]
fn wires_are_as_wide_as_asked_for() {
    // Shared edges drawn from both sides (the middle), and borders drawn from one.
    let sheet = Shape::default()
        .rectangle([-100.0, -80.0], [0.3, 80.0], 0.0)
        .rectangle([0.3, -80.0], [100.0, 80.0], 0.0);
    let mut welded = sheet.clone();
    for corner in welded.triangles.iter_mut().flatten() {
        *corner = match *corner {
            4 => 1,
            7 => 2,
            other => other,
        };
    }
    for width in [0.5f32, 0.9, 2.0, 5.0] {
        let style = mask().wireframe(true).wire_colour([0; 3]).wire_width(width);
        let image = draw(&welded, &pixel_camera(200), &style, 240, 200);
        // The line x = 0.3 is at pixel 120.3; the diagonals are far from it at this height.
        let shared = darkness(&image, (112..129).map(|x| (x, 60)));
        assert!(
            (shared - f64::from(width)).abs() < 0.06 * f64::from(width) + 0.02,
            "{width}: {shared}"
        );
        // A line of full width inside of the left border at pixel 20.
        let border = darkness(&image, (20..32).map(|x| (x, 110)));
        assert!(
            (border - f64::from(width)).abs() < 0.06 * f64::from(width) + 0.02,
            "border {width}: {border}"
        );
    }
}

#[test]
fn hidden_lines_are_hidden() {
    let cover = Shape::default().rectangle([-50.0, -50.0], [50.0, 50.0], 5.0);
    let shape = cover.clone().rectangle([-20.0, -20.0], [20.0, 20.0], 0.0);
    let style = Style::default().wireframe(true);
    let with = draw(&shape, &pixel_camera(120), &style, 120, 120);
    let without = draw(&cover, &pixel_camera(120), &style, 120, 120);
    assert_eq!(with, without);
}

#[test]
fn lines_fade_where_triangles_are_smaller_than_pixels() {
    let camera = Camera::orthographic([0.0; 3], ViewDirection::front(), 1.2).unwrap();
    let share = |slices: u32| {
        let sphere = Shape::sphere(slices);
        let plain = draw(&sphere, &camera, &mask(), 120, 120);
        let style = mask().wireframe(true).wire_colour([0; 3]);
        let wired = draw(&sphere, &camera, &style, 120, 120);
        1.0 - covered(&wired) / covered(&plain)
    };
    let (coarse, dense) = (share(20), share(1000));
    assert!(coarse > 0.1 && coarse < 0.4, "{coarse}");
    assert!(dense < 0.01, "{dense}");
}

#[test]
fn the_whole_surface_is_framed() {
    let shapes = [
        Shape::sphere(40),
        Shape::default().rectangle([1e3, 1e3], [1.004e3, 1.5e3], -7.0),
        Shape::default().rectangle([0.0, 0.0], [1e-7, 2e-7], 0.0),
    ];
    for shape in shapes {
        for (width, height) in [(90, 60), (60, 90)] {
            let view = ViewDirection::default();
            let cameras = [
                Camera::fit(shape.view(), view, width, height).unwrap(),
                Camera::fit_tightly(shape.view(), view, width, height).unwrap(),
                Camera::fit_perspective(shape.view(), view, 30.0, width, height).unwrap(),
            ];
            for (which, camera) in cameras.iter().enumerate() {
                let mut reach = 0.0f64;
                for &p in &shape.positions {
                    let [x, y] = camera.project(p, width, height).unwrap();
                    let sideways = (2.0 * x / f64::from(width) - 1.0).abs();
                    reach = reach
                        .max(sideways)
                        .max((2.0 * y / f64::from(height) - 1.0).abs());
                }
                assert!(reach < 0.97, "camera {which}: {reach}");
                assert!(which != 1 || reach > 0.93, "tight: {reach}");
            }
        }
    }
}

#[test]
fn a_transparent_background_stays_transparent() {
    let square = Shape::default().rectangle([-10.0, -10.0], [10.5, 10.0], 0.0);
    let style = mask().background([0; 4]);
    let image = draw(&square, &pixel_camera(40), &style, 40, 40);
    assert_eq!(image.pixel(0, 0), Some([0; 4]));
    assert_eq!(image.pixel(20, 20), Some([255; 4]));
    let [r, _, _, opacity] = image.pixel(30, 20).unwrap();
    assert!(
        r == 255 && opacity.abs_diff(128) <= 1,
        "half covered, its colour undimmed: {r}, {opacity}"
    );
}

#[test]
fn a_camera_inside_of_the_model_sees_its_inside_everywhere() {
    let sphere = Shape::sphere(60);
    let style = mask().surface_colour([0, 0, 255]).back_colour([255, 0, 0]);
    for target in [[0.0, 0.0, -1.0], [0.3, 1.0, 0.2]] {
        let camera = Camera::perspective([0.1, 0.05, 0.0], target, [1.0, 0.0, 0.1], 100.0).unwrap();
        let image = draw(&sphere, &camera, &style.wireframe(false), 80, 60);
        for pixel in image.rgba().chunks_exact(4) {
            assert!(pixel[0] > 200 && pixel[3] == 255, "{pixel:?}");
        }
    }
    // On the surface itself, at a vertex, and looking along an edge: nothing but a picture is expected.
    for eye in [sphere.positions[700], [0.0, 1.0, 0.0]] {
        let camera = Camera::perspective(eye, [0.0, 0.0, 0.3], [0.0, 0.0, 1.0], 90.0).unwrap();
        draw(&sphere, &camera, &style.wireframe(true), 40, 40);
    }
}

/// A floor that runs from behind the eye to far away: clipped properly it fills the lower half exactly.
#[test]
fn a_floor_reaches_from_below_the_eye_to_the_horizon() {
    let mut floor = Shape::default().rectangle([-1e7, -1e7], [1e7, 1e7], 0.0);
    for p in &mut floor.positions {
        *p = [p[0], 0.0, -p[1]];
    }
    let camera =
        Camera::perspective([0.0, 1.0, 0.0], [0.0, 1.0, -1.0], [0.0, 1.0, 0.0], 60.0).unwrap();
    let image = draw(&floor, &camera, &mask(), 64, 64);
    for y in 0..64 {
        for x in 0..64 {
            let white = image.pixel(x, y).unwrap()[0] > 127;
            assert_eq!(white, y >= 32, "pixel {x}, {y}");
        }
    }
}

#[test]
fn bad_input_is_an_error() {
    let good = Shape::sphere(8);
    let camera = pixel_camera(10);
    let style = Style::default();
    let result = |shape: &Shape, style: &Style, width, height| {
        render(shape.view(), None, None, &camera, style, width, height)
    };
    for (width, height) in [(0, 10), (10, 0), (16_385, 10), (10, u32::MAX)] {
        assert!(matches!(
            result(&good, &style, width, height),
            Err(RenderError::Size { .. })
        ));
        assert!(Camera::fit(good.view(), ViewDirection::default(), width, height).is_err());
        assert!(Image::new(width, height, BLACK).is_err());
    }
    assert_eq!(
        result(&Shape::default(), &style, 10, 10),
        Err(RenderError::Empty)
    );
    let mut bad = good.clone();
    bad.triangles[3][1] = 4000;
    let found = result(&bad, &style, 10, 10);
    assert!(
        matches!(
            found,
            Err(RenderError::VertexOutOfRange {
                triangle: 3,
                vertex: 4000,
                ..
            })
        ),
        "{found:?}"
    );
    for value in [f64::NAN, f64::INFINITY] {
        let mut bad = good.clone();
        bad.positions[5][2] = value;
        assert!(matches!(
            result(&bad, &style, 10, 10),
            Err(RenderError::NotFinite { index: 5, .. })
        ));
        assert!(Camera::fit(bad.view(), ViewDirection::default(), 10, 10).is_err());
    }
    assert!(result(&good, &style.samples(3), 10, 10).is_err());
    assert!(result(&good, &style.wire_width(f32::NAN), 10, 10).is_err());
    let normals = [[0.0; 3]];
    let few = render(good.view(), Some(&normals), None, &camera, &style, 10, 10);
    assert!(matches!(few, Err(RenderError::Count { .. })));
    assert!(Camera::fit(good.view(), ViewDirection::along([0.0; 3]), 10, 10).is_err());
    assert!(Camera::perspective([1.0; 3], [1.0; 3], [0.0, 1.0, 0.0], 40.0).is_err());
    assert!(Camera::perspective([1.0; 3], [0.0; 3], [0.0, 1.0, 0.0], 180.0).is_err());
}

/// Coordinates at the ends of what f64 can hold overflow inside; that must not end in a panic.
#[test]
fn enormous_and_tiny_coordinates_end_in_a_picture_or_an_error() {
    for size in [1e-320, 1e-160, 1e150, 1e200, 1e308] {
        let shape = Shape::default().rectangle([-size, -size], [size, size], size);
        let view = ViewDirection::default();
        let cameras = [
            Camera::fit(shape.view(), view, 20, 20),
            Camera::fit_tightly(shape.view(), view, 20, 20),
            Camera::fit_perspective(shape.view(), view, 30.0, 20, 20),
        ];
        for camera in cameras.into_iter().flatten() {
            let style = Style::default().wireframe(true);
            let _ = render(shape.view(), None, None, &camera, &style, 20, 20);
        }
    }
}
