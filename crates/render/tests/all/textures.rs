//! Textures in pictures, against textures made of known colours.

#![allow(clippy::unwrap_used)]

use crate::support::{halves, linear, own_colours, square};
use limitmesh_render::{
    Camera, Covering, Image, Material, RenderError, Style, Texture, ViewDirection, render_textured,
};

fn camera(height: u32) -> Camera {
    Camera::orthographic([0.0; 3], ViewDirection::front(), f64::from(height) / 2.0).unwrap()
}

/// The texture coordinates of the square's corners, by triangle, if it spans `times` textures.
fn corners(times: f64) -> [[f64; 2]; 6] {
    [
        [0.0, 0.0],
        [times, 0.0],
        [times, times],
        [0.0, 0.0],
        [times, times],
        [0.0, times],
    ]
}

/// Mid-grey, so that no light is beyond what is kept as it is.
const COLOURS: [[u8; 3]; 4] = [[200, 0, 0], [0, 200, 0], [0, 0, 200], [200, 200, 200]];

fn quarters() -> Texture {
    let pixels = COLOURS
        .iter()
        .flat_map(|&[r, g, b]| [r, g, b, 255])
        .collect();
    Texture::from_image(&Image::from_rgba(2, 2, pixels).unwrap())
}

fn drawn(covering: &Covering<'_>, size: u32) -> Image {
    let positions = square(0.5 * f64::from(size));
    let (camera, style) = (camera(size), own_colours().background([0, 0, 0, 255]));
    render_textured(
        halves(&positions),
        None,
        covering,
        &camera,
        &style,
        (size, size),
    )
    .unwrap()
}

/// A square of so many quartered textures.
fn quartered(times: f64, size: u32) -> Image {
    let materials = [Material {
        colour: [1.0; 3],
        texture: Some(quarters()),
    }];
    let covering = Covering {
        materials: &materials,
        of_triangle: &[0, 0],
        corners: &corners(times),
    };
    drawn(&covering, size)
}

/// Alike in linear light, to a fiftieth of white.
fn is_near(pixel: [u8; 4], colour: [u8; 3]) -> bool {
    (0..3).all(|i| (linear(pixel[i]) - linear(colour[i])).abs() < 0.02)
}

#[test]
fn a_texture_lies_with_its_corners_where_coordinates_say() {
    // A size for which the middles of the texture's pixels are middles of the picture's, rows from above.
    let image = quartered(1.0, 42);
    for (i, colour) in COLOURS.into_iter().enumerate() {
        let (x, y) = (10 + 21 * (i as u32 % 2), 10 + 21 * (i as u32 / 2));
        let pixel = image.pixel(x, y).unwrap();
        assert!(
            is_near(pixel, colour),
            "{x} {y}: {pixel:?}, expected {colour:?}"
        );
    }
}

/// Where a pixel of the picture sees many of the texture, it has their mean in linear light.
#[test]
fn small_textures_become_their_mean() {
    let image = quartered(400.0, 40);
    let linear = |c: f64| ((c / 255.0 + 0.055) / 1.055).powf(2.4);
    let mean = 0.5 * linear(200.0);
    let grey = ((1.055 * mean.powf(1.0 / 2.4) - 0.055) * 255.0).round() as u8;
    for at in [3, 20, 36] {
        let pixel = image.pixel(at, 39 - at).unwrap();
        assert!(is_near(pixel, [grey; 3]), "{pixel:?}, expected {grey}");
    }
}

#[test]
fn materials_are_those_of_their_triangles() {
    let colour = |[r, g, b]: [u8; 3]| {
        [r, g, b]
            .map(|c| ((f32::from(c) / 255.0 + 0.055) / 1.055).powf(2.4))
            .map(|c| if c < 0.004 { 0.0 } else { c })
    };
    let materials = [Material {
        colour: colour([200, 0, 0]),
        texture: None,
    }];
    let covering = Covering {
        materials: &materials,
        of_triangle: &[0, 7],
        corners: &corners(1.0),
    };
    let image = drawn(&covering, 40);
    assert!(is_near(image.pixel(30, 35).unwrap(), [200, 0, 0]));
    // The other has none: the style's own colour.
    let pixel = image.pixel(10, 5).unwrap();
    assert!(pixel[2] > 150 && pixel[1] > 150, "{pixel:?}");
}

#[test]
fn what_does_not_fit_is_refused() {
    let positions = square(5.0);
    let drawn = |of_triangle: &[u32], corners: &[[f64; 2]]| {
        let covering = Covering {
            materials: &[],
            of_triangle,
            corners,
        };
        let (camera, style) = (camera(10), Style::default());
        render_textured(
            halves(&positions),
            None,
            &covering,
            &camera,
            &style,
            (10, 10),
        )
    };
    let mut broken = corners(1.0);
    broken[4] = [0.0, f64::NAN];
    let counts = |drawn| match drawn {
        Err(RenderError::Count { met, expected, .. }) => Some((met, expected)),
        _ => None,
    };
    assert_eq!(counts(drawn(&[0], &corners(1.0))), Some((1, 2)));
    assert_eq!(counts(drawn(&[0, 0], &corners(1.0)[..5])), Some((5, 6)));
    let place = |drawn| match drawn {
        Err(RenderError::NotFinite { index, .. }) => Some(index),
        _ => None,
    };
    assert_eq!(place(drawn(&[0, 0], &broken)), Some(4));
    // The same picture whatever is beyond single precision.
    let far = corners(1e300);
    assert!(drawn(&[0, 0], &far).is_ok());
}
