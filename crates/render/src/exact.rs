//! Pictures of limit surfaces themselves, by rays: outlines without facets.
//!
//! A ray goes through the middle of each pixel. Where all around it meet one smooth sheet, that is the pixel's colour; elsewhere, along
//! outlines and creases, the pixel is the mean of rays through the places at which [`crate::render`] looks, too. Light and colours are those
//! of [`crate::render`].

use core::ops::ControlFlow;

use glam::DVec3;
use limitmesh::progress::{Observer, Progress};
use limitmesh::{Crossing, Hit, Ray, RayCaster, RayOptions};

use crate::camera::Camera;
use crate::check::check_size;
use crate::colour::{self, Linear};
use crate::image::Image;
use crate::project::STEPS;
use crate::raster::sample_places;
use crate::shade::shade;
use crate::style::Style;
use crate::{RenderError, parallel};

/// Rays that are followed together.
const BATCH: usize = 1 << 16;

/// Pixels beside each other whose normals' cosine is less are looked at closely.
const SMOOTH: f64 = 0.95;

/// Those whose depths are off a straight line by more than this many pixels' sides, too.
const STRAIGHT: f64 = 1.0;

/// Draws the limit surface that rays are followed to, without triangles: shading is smooth, and wireframes there are none.
///
/// # Errors
/// A size or setting out of range.
pub fn render_exact(
    rays: &RayCaster<'_>,
    camera: &Camera,
    style: &Style,
    size: (u32, u32),
) -> Result<Image, RenderError> {
    render_exact_observed(
        rays,
        camera,
        style,
        size,
        &mut |_| ControlFlow::Continue(()),
    )
}

/// [`render_exact`], telling how many rays were followed.
///
/// # Errors
/// As for [`render_exact`], or it was cancelled.
pub fn render_exact_observed(
    rays: &RayCaster<'_>,
    camera: &Camera,
    style: &Style,
    (width, height): (u32, u32),
    observer: &mut Observer<'_>,
) -> Result<Image, RenderError> {
    check_size(width.into(), height.into())?;
    style.check()?;
    let mut canvas = Canvas {
        rays,
        camera,
        style,
        width,
        height,
        observer,
        followed: 0,
        total: 0,
    };
    let pixels = width as usize * height as usize;
    let middle = |pixel: usize| {
        let (x, y) = (pixel % width as usize, pixel / width as usize);
        [x as f64 + 0.5, y as f64 + 0.5]
    };
    canvas.total = pixels;
    let seen: Vec<Option<Seen>> = canvas.cast(pixels, middle)?;
    let close: Vec<usize> = (0..pixels)
        .filter(|&pixel| !canvas.is_smooth(&seen, pixel))
        .collect();
    let places = sample_places(style.samples);
    let count = places.len();
    canvas.total += close.len() * count;
    let within = |sample: usize| {
        let (pixel, [x, y]) = (close[sample / count], places[sample % count]);
        let [left, top] = middle(pixel).map(f64::floor);
        [
            left + f64::from(x) / f64::from(STEPS),
            top + f64::from(y) / f64::from(STEPS),
        ]
    };
    let samples = canvas.cast(close.len() * count, within)?;
    let mut image = Image::new(width, height, style.background)?;
    let background = style.background;
    let mut paint = |pixel: usize, seen: &[Option<Seen>]| {
        let (x, y) = (pixel % width as usize, pixel / width as usize);
        image.row_mut(x as u32, y as u32)[..4].copy_from_slice(&mixed(seen, background));
    };
    (0..pixels).for_each(|pixel| paint(pixel, &seen[pixel..=pixel]));
    close
        .iter()
        .zip(samples.chunks(count))
        .for_each(|(&pixel, samples)| paint(pixel, samples));
    Ok(image)
}

/// What a ray shows.
#[derive(Clone, Copy)]
struct Seen {
    colour: Linear,
    depth: f64,
    /// In space, on the viewer's side.
    normal: DVec3,
}

struct Canvas<'a, 'o> {
    rays: &'a RayCaster<'a>,
    camera: &'a Camera,
    style: &'a Style,
    width: u32,
    height: u32,
    observer: &'a mut Observer<'o>,
    /// Rays that were followed, and all that are known to be needed.
    followed: usize,
    total: usize,
}

impl Canvas<'_, '_> {
    /// What is seen at so many places of the picture.
    fn cast(
        &mut self,
        count: usize,
        place: impl Fn(usize) -> [f64; 2] + Sync + Send,
    ) -> Result<Vec<Option<Seen>>, RenderError> {
        let from = if self.camera.is_perspective() {
            0.0
        } else {
            f64::NEG_INFINITY
        };
        let options = RayOptions::default().between(from, f64::INFINITY);
        let mut all = Vec::with_capacity(count);
        while all.len() < count {
            let first = all.len();
            let batch = BATCH.min(count - first);
            let (camera, width, height) = (self.camera, self.width, self.height);
            let rays: Vec<Ray> =
                parallel::map(batch, |at| camera.ray(place(first + at), width, height));
            let (followed, total, observer) = (self.followed, self.total, &mut *self.observer);
            let tell = &mut |at: &Progress| {
                let mut at = *at;
                (at.done, at.total) = (followed + at.done, Some(total));
                observer(&at)
            };
            let hits = self.rays.first_of_all_observed(&rays, &options, tell);
            let hits = hits.map_err(|_| RenderError::Cancelled)?;
            let style = self.style;
            all.extend(parallel::map(batch, |at| {
                hits[at].map(|hit| seen(camera, style, &hit))
            }));
            self.followed += batch;
        }
        Ok(all)
    }

    /// Whether one smooth sheet is seen around a pixel, or nothing.
    fn is_smooth(&self, seen: &[Option<Seen>], pixel: usize) -> bool {
        let (width, height) = (self.width as usize, self.height as usize);
        let (x, y) = (pixel % width, pixel / width);
        let at = |dx: usize, dy: usize| {
            // Beyond the border the picture is taken to go on.
            let (x, y) = ((x + dx).clamp(1, width) - 1, (y + dy).clamp(1, height) - 1);
            &seen[y * width + x]
        };
        let Some(own) = at(1, 1) else {
            return (0..9).all(|i| at(i % 3, i / 3).is_none());
        };
        let side = self.camera.pixel_at(own.depth, self.height);
        (0..4).all(|i| {
            let (dx, dy) = (i % 3, i / 3);
            let (Some(a), Some(b)) = (at(dx, dy), at(2 - dx, 2 - dy)) else {
                return false;
            };
            let bend = (a.depth - 2.0 * own.depth + b.depth).abs();
            let is_inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
            (bend <= STRAIGHT * side || !is_inside && a.normal.dot(b.normal) >= SMOOTH)
                && a.normal.dot(own.normal) >= SMOOTH
                && b.normal.dot(own.normal) >= SMOOTH
        })
    }
}

/// The colour of what is hit.
fn seen(camera: &Camera, style: &Style, hit: &Hit) -> Seen {
    let [right, up, back] = camera.frame();
    let in_frame = |v: DVec3| DVec3::new(v.dot(right), v.dot(up), v.dot(back));
    let point = DVec3::from_array(hit.position);
    let viewer = camera.towards_viewer(point);
    let outside = DVec3::from_array(hit.normal).normalize_or(viewer);
    let is_front = match hit.crossing {
        Crossing::Entering => true,
        Crossing::Leaving => false,
        Crossing::Grazing => outside.dot(viewer) >= 0.0,
    };
    let normal = if is_front { outside } else { -outside };
    let albedo = colour::linear(if is_front {
        style.surface_colour
    } else {
        style.back_colour
    });
    let colour = shade(&style.lighting, albedo, in_frame(normal), in_frame(viewer));
    Seen {
        colour,
        depth: hit.t,
        normal,
    }
}

/// A pixel's bytes from what is seen in it.
fn mixed(seen: &[Option<Seen>], background: [u8; 4]) -> [u8; 4] {
    let (mut sum, mut count) = ([0.0f32; 3], 0);
    for seen in seen.iter().flatten() {
        count += 1;
        sum.iter_mut()
            .zip(seen.colour)
            .for_each(|(sum, channel)| *sum += channel);
    }
    if count == 0 {
        return background;
    }
    let free = (seen.len() - count) as f32 * f32::from(background[3]) / 255.0;
    let backdrop = colour::linear([background[0], background[1], background[2]]);
    let weight = count as f32 + free;
    let [r, g, b] = colour::encode([0, 1, 2].map(|i| (sum[i] + backdrop[i] * free) / weight));
    [r, g, b, (weight / seen.len() as f32 * 255.0 + 0.5) as u8]
}
