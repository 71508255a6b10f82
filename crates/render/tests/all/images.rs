//! Images: PNG files, pasting, text, heat maps and their colour bars, and the same bytes for any number of
//! threads.

#![allow(clippy::unwrap_used)]

use crate::support::{halves, own_colours, pool, square};
use limitmesh::Triangles;
use limitmesh_render::{
    Align, Camera, ColourBar, ColourMap, GridStyle, Image, Panel, Scale, Style, TextStyle,
    ViewDirection, grid, render, render_scalar, text_width,
};

const WHITE: [u8; 4] = [255; 4];

fn decoded(file: &[u8]) -> (png::OutputInfo, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    bytes.truncate(info.buffer_size());
    (info, bytes)
}

#[test]
fn a_png_file_holds_the_pixels() {
    let bytes: Vec<u8> = (0..5 * 3 * 4u32).map(|i| (i * 37 % 251) as u8).collect();
    let again = |bytes: &[u8]| {
        let image = Image::from_rgba(5, 3, bytes.to_vec()).unwrap();
        decoded(&image.encode_png().unwrap())
    };
    let (info, read) = again(&bytes);
    assert_eq!(
        (info.width, info.height, info.color_type),
        (5, 3, png::ColorType::Rgba)
    );
    assert_eq!(read, bytes);
    let opaque: Vec<u8> = bytes
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2], 255])
        .collect();
    let (info, read) = again(&opaque);
    assert_eq!(info.color_type, png::ColorType::Rgb);
    let expected: Vec<u8> = opaque
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    assert_eq!(read, expected);
    assert!(Image::from_rgba(5, 3, vec![0; 59]).is_err());
}

#[test]
fn pasting_clips_and_respects_opacity() {
    let mut image = Image::new(4, 4, [0, 0, 0, 255]).unwrap();
    image.paste(&Image::new(3, 3, [200, 100, 50, 255]).unwrap(), 2, -1);
    for y in 0..4 {
        for x in 0..4 {
            let expected = if x >= 2 && y < 2 {
                [200, 100, 50, 255]
            } else {
                [0, 0, 0, 255]
            };
            assert_eq!(image.pixel(x, y), Some(expected), "{x}, {y}");
        }
    }
    image.paste(&Image::new(1, 1, [255, 255, 255, 0]).unwrap(), 0, 0);
    assert_eq!(image.pixel(0, 0), Some([0, 0, 0, 255]));
    let mut clear = Image::new(1, 1, [0; 4]).unwrap();
    clear.paste(&Image::new(1, 1, [10, 20, 30, 128]).unwrap(), 0, 0);
    assert_eq!(clear.pixel(0, 0), Some([10, 20, 30, 128]));
}

/// The columns and rows in which anything but white stands: left, right, top, bottom.
fn extent(image: &Image) -> Option<[u32; 4]> {
    let inked = |x: u32, y: u32| image.pixel(x, y).is_some_and(|p| p != WHITE);
    let places = (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y)));
    places
        .filter(|&(x, y)| inked(x, y))
        .fold(None, |found, (x, y)| {
            let [left, right, top, bottom] = found.unwrap_or([x, x, y, y]);
            Some([left.min(x), right.max(x), top.min(y), bottom.max(y)])
        })
}

#[test]
fn text_stands_on_its_baseline_and_is_as_wide_as_measured() {
    let style = TextStyle::default().size(40.0);
    let width = text_width("HHH", &style).unwrap();
    assert!((text_width("HHHHHH", &style).unwrap() - 2.0 * width).abs() < 0.1);
    for (align, start) in [
        (Align::Left, 150.0),
        (Align::Centre, 150.0 - width / 2.0),
        (Align::Right, 150.0 - width),
    ] {
        let mut image = Image::new(300, 100, WHITE).unwrap();
        image
            .draw_text(150.0, 70.0, "HHH", &style.align(align))
            .unwrap();
        let [left, right, top, bottom] = extent(&image).unwrap().map(|v| v as f32);
        assert_eq!(bottom, 69.0, "capitals end above the baseline");
        assert!(
            (top - (70.0 - 0.714 * 40.0)).abs() <= 1.5,
            "a capital is 0.714 em high: {top}"
        );
        assert!(
            left >= start && left < start + 8.0,
            "{align:?}: {left} for {start}"
        );
        assert!(
            right < start + width && right > start + width - 8.0,
            "{align:?}"
        );
    }
}

#[test]
fn raised_digits_are_raised_and_smaller() {
    let style = TextStyle::default().size(40.0);
    let mut image = Image::new(100, 100, WHITE).unwrap();
    image.draw_text(10.0, 70.0, "²", &style).unwrap();
    let [.., top, bottom] = extent(&image).unwrap();
    assert!(bottom < 60 && top < 42, "{top} to {bottom}");
    let (raised, plain) = (
        text_width("⁻³", &style).unwrap(),
        text_width("−3", &style).unwrap(),
    );
    assert!(raised < 0.7 * plain && raised > 0.6 * plain);
}

#[test]
fn text_that_cannot_be_drawn_is_left_out_or_refused() {
    let mut image = Image::new(20, 20, WHITE).unwrap();
    image
        .draw_text(-500.0, 900.0, "outside", &TextStyle::default())
        .unwrap();
    image
        .draw_text(5.0, 10.0, "\n\u{7}", &TextStyle::default())
        .unwrap();
    assert_eq!(extent(&image), None);
    assert!(
        image
            .draw_text(f32::NAN, 0.0, "a", &TextStyle::default())
            .is_err()
    );
    assert!(
        image
            .draw_text(0.0, 0.0, "a", &TextStyle::default().size(0.0))
            .is_err()
    );
}

#[test]
fn a_grid_places_each_picture_in_its_cell() {
    let colours = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]];
    let panels = colours.map(|c| Panel::new(Image::new(30, 20, c).unwrap(), ""));
    let figure = grid(&panels, &GridStyle::default().columns(2).gap(10)).unwrap();
    assert_eq!((figure.width(), figure.height()), (90, 70));
    for (i, colour) in colours.into_iter().enumerate() {
        let (left, top) = (10 + 40 * (i as u32 % 2), 10 + 30 * (i as u32 / 2));
        assert_eq!(figure.pixel(left, top), Some(colour));
        assert_eq!(figure.pixel(left + 29, top + 19), Some(colour));
        assert_eq!(figure.pixel(left - 1, top), Some(WHITE));
    }
    let captioned = [Panel::new(
        Image::new(30, 20, WHITE).unwrap(),
        "a caption far wider than this",
    )];
    let figure = grid(&captioned, &GridStyle::default().gap(10)).unwrap();
    let [left, right, top, _] = extent(&figure).unwrap();
    assert!(
        left >= 9 && right <= 40 && top >= 30,
        "the caption is set smaller and stands below"
    );
    assert!(grid(&[], &GridStyle::default()).is_err());
    assert!(grid(&captioned, &GridStyle::default().columns(0)).is_err());
}

#[test]
fn numbers_and_not_colours_are_interpolated() {
    // 100 pixels seen face on.
    let positions = square(1.0);
    let camera = Camera::orthographic([0.0; 3], ViewDirection::front(), 1.0).unwrap();
    let drawn = |values: &[f64], scale: &Scale| {
        let (surface, style) = (halves(&positions), own_colours());
        render_scalar(surface, None, values, scale, &camera, &style, (100, 100))
    };
    let values = [0.0, 10.0, 10.0, 0.0];
    let scale = Scale::new(0.0, 10.0).with_map(ColourMap::Ember);
    let image = drawn(&values, &scale).unwrap();
    for x in 0..70u32 {
        let expected = ColourMap::Ember.at((f64::from(x) + 0.5) / 100.0);
        for y in [3, 50, 97] {
            let [r, g, b, _] = image.pixel(x, y).unwrap();
            for (met, expected) in [r, g, b].into_iter().zip(expected) {
                // Above 80 % of the light, highlights are softened.
                let expected_here = expected.min(228);
                assert!(
                    met.min(228).abs_diff(expected_here) <= 3,
                    "column {x}: {:?}, not {expected:?}",
                    [r, g, b]
                );
            }
        }
    }
    assert!(drawn(&[0.0; 3], &scale).is_err());
    assert!(drawn(&[f64::NAN; 4], &scale).is_err());
    assert!(drawn(&values, &Scale::new(1.0, 0.0)).is_err());
}

/// Seen in perspective, equal lengths on a receding plane are not equally long; the values must follow.
#[test]
fn values_are_interpolated_in_space_and_not_in_the_picture() {
    let floor = [
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 0.0, -8.0],
        [-1.0, 0.0, -8.0],
    ];
    let surface = halves(&floor);
    let camera =
        Camera::perspective([0.0, 1.0, 2.0], [0.0, 0.0, -2.0], [0.0, 1.0, 0.0], 40.0).unwrap();
    let values = [0.0, 0.0, 8.0, 8.0];
    let scale = Scale::new(0.0, 8.0).with_map(ColourMap::Grey);
    let style = own_colours();
    let image = render_scalar(surface, None, &values, &scale, &camera, &style, (200, 200)).unwrap();
    let plain = |depth: f64| {
        let [x, y] = camera.project([0.2, 0.0, -depth], 200, 200).unwrap();
        f64::from(image.pixel(x as u32, y as u32).unwrap()[1])
    };
    let steps: Vec<f64> = [1.0, 3.0, 5.0, 7.0]
        .map(plain)
        .windows(2)
        .map(|w| w[1] - w[0])
        .collect();
    // The grey map is even, so equal depths make nearly equal steps, far from those in the picture (5 to 1).
    assert!(
        steps
            .iter()
            .all(|s| *s > 0.7 * steps[0] && *s < 1.4 * steps[0]),
        "{steps:?}"
    );
}

#[test]
fn the_colour_bar_runs_from_low_to_high_with_round_ticks() {
    let bar = ColourBar::new(Scale::new(0.0, 0.5))
        .title("distance")
        .unit("%");
    let labels: Vec<String> = bar.ticks().into_iter().map(|(_, label)| label).collect();
    assert_eq!(labels, ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
    let image = bar
        .beside(&Image::new(200, 300, WHITE).unwrap(), WHITE)
        .unwrap();
    assert!(image.width() > 230 && image.height() == 300);
    // Down the middle of the bar, from the frame's upper end to its lower one, lightness falls.
    let x = (200.0 + 11.0 + 0.75 * 11.0) as u32;
    let column: Vec<[u8; 4]> = (0..300).filter_map(|y| image.pixel(x, y)).collect();
    let inside: Vec<&[u8; 4]> = column
        .iter()
        .skip_while(|p| p[2] > p[0] || p[0] > 252)
        .collect();
    let top = ColourMap::Lagoon.at(1.0);
    assert!(
        (0..3).all(|i| inside[0][i].abs_diff(top[i]) <= 6),
        "the highest value is on top: {:?}",
        inside[0]
    );
    let greens: Vec<u8> = inside.iter().map(|p| p[1]).take(200).collect();
    assert!(
        greens.windows(2).all(|pair| pair[1] <= pair[0]),
        "{greens:?}"
    );
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    // A crumpled sheet: several layers of depth, triangles of all sizes.
    let side = 60u32;
    let at = |i: u32, j: u32| {
        let (x, y) = (
            f64::from(i) / f64::from(side),
            f64::from(j) / f64::from(side),
        );
        [x + 0.1 * (9.0 * y).sin(), y, 0.3 * (17.0 * x * y).sin()]
    };
    let positions: Vec<[f64; 3]> = (0..=side)
        .flat_map(|j| (0..=side).map(move |i| at(i, j)))
        .collect();
    let corner = |i: u32, j: u32| j * (side + 1) + i;
    let triangles: Vec<[u32; 3]> = (0..side)
        .flat_map(|j| (0..side).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [
                corner(i, j),
                corner(i + 1, j),
                corner(i + 1, j + 1),
                corner(i, j + 1),
            ];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let surface = Triangles {
        positions: &positions,
        triangles: &triangles,
    };
    let camera =
        Camera::fit_perspective(surface, ViewDirection::default(), 40.0, 150, 110).unwrap();
    let style = Style::default().wireframe(true);
    let picture = || render(surface, None, None, &camera, &style, 150, 110).unwrap();
    let here = picture();
    for threads in [1, 2, 5] {
        assert!(pool(threads).install(picture) == here, "{threads} threads");
    }
}

#[test]
fn single_values_have_the_colours_of_the_map() {
    let at = |place| ColourMap::Ember.at(place);
    let scale = Scale::new(2.0, 10.0).with_map(ColourMap::Ember);
    assert_eq!(
        [1.0, 2.0, 6.0, 10.0, 12.0].map(|value| scale.colour(value)),
        [0.0, 0.0, 0.5, 1.0, 1.0].map(at)
    );
    let marked = scale.marking_above([1, 2, 3]);
    assert_eq!(
        [10.0, 10.1].map(|value| marked.colour(value)),
        [at(1.0), [1, 2, 3]]
    );
    let ratios = Scale::logarithmic(1.0, 100.0).with_map(ColourMap::Ember);
    assert_eq!(
        [-1.0, 1.0, 10.0].map(|value| ratios.colour(value)),
        [0.0, 0.0, 0.5].map(at)
    );
    // Where there is one value alone, no end of the map is its own.
    assert_eq!(
        Scale::new(0.0, 0.0).with_map(ColourMap::Ember).colour(0.0),
        at(0.5)
    );
}
