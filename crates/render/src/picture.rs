//! A picture of a surface: projects, rasterises tile by tile and mixes each pixel's colour.

use glam::DVec3;
use limitmesh::Triangles;

use crate::camera::Camera;
use crate::check::{check_count, check_finite, check_size, check_surface};
use crate::colour::{self, Linear};
use crate::colour_map::look_up;
use crate::covering::Covering;
use crate::image::Image;
use crate::project::{Projected, STEPS, project};
use crate::raster::{Bins, NOTHING, Rectangle, Tile, sample_places};
use crate::scale::Scale;
use crate::shade::shade;
use crate::style::{Shading, Style};
use crate::wire::{self, Ink, Lines};
use crate::{RenderError, parallel};

/// Draws a surface.
///
/// `normals` are the directions (of any length) of smooth shading, one for each vertex; without them the
/// triangles' own, weighted by area, are used. `vertex_colours` (8-bit sRGB, one for each vertex) are mixed across
/// triangles in linear light and stand in for both of the style's surface colours. Triangles are
/// counter-clockwise seen from outside; both sides are drawn.
///
/// # Errors
/// A size or setting out of range, no triangles, an index out of range, numbers that are not finite, an array of
/// the wrong length.
pub fn render(
    surface: Triangles<'_>,
    normals: Option<&[[f64; 3]]>,
    vertex_colours: Option<&[[u8; 3]]>,
    camera: &Camera,
    style: &Style,
    width: u32,
    height: u32,
) -> Result<Image, RenderError> {
    let paint = match vertex_colours {
        Some(colours) => {
            check_count("vertex colours", colours.len(), surface.positions.len())?;
            Paint::Vertex(colours)
        }
        None => Paint::Sides(
            colour::linear(style.surface_colour),
            colour::linear(style.back_colour),
        ),
    };
    draw(surface, normals, &paint, camera, style, width, height)
}

/// What colour the surface has.
pub(crate) enum Paint<'a> {
    /// One colour outside, one inside.
    Sides(Linear, Linear),
    /// A colour at each vertex.
    Vertex(&'a [[u8; 3]]),
    /// A number at each vertex, looked up in a table of the scale's colours.
    Scalar {
        values: &'a [f64],
        scale: &'a Scale,
        table: Vec<Linear>,
    },
    /// Materials, perhaps with textures.
    Materials {
        covering: &'a Covering<'a>,
        outside: Linear,
        inside: Linear,
    },
}

pub(crate) fn draw(
    surface: Triangles<'_>,
    normals: Option<&[[f64; 3]]>,
    paint: &Paint<'_>,
    camera: &Camera,
    style: &Style,
    width: u32,
    height: u32,
) -> Result<Image, RenderError> {
    check_size(width.into(), height.into())?;
    style.check()?;
    check_surface(surface)?;
    if let Some(normals) = normals {
        check_count("normals", normals.len(), surface.positions.len())?;
        check_finite("normal", normals)?;
    }
    let projected = project(surface, camera, width, height);
    let [right, up, back] = camera.frame();
    let seen = |n: DVec3| DVec3::new(n.dot(right), n.dot(up), n.dot(back)).normalize_or_zero();
    let normals = match (style.shading, normals) {
        (Shading::Flat, _) => Vec::new(),
        (Shading::Smooth, Some(given)) => {
            parallel::map(given.len(), |v| seen(DVec3::from_array(given[v])))
        }
        (Shading::Smooth, None) => {
            let sums = area_normals(surface);
            parallel::map(sums.len(), |v| seen(sums[v]))
        }
    };
    let inks = if style.wireframe {
        wire::ink(surface.triangles, &projected.homogeneous, style.wire_width)
    } else {
        Vec::new()
    };
    let bins = Bins::new(&projected, width, height);
    let scene = Scene {
        surface,
        camera,
        style,
        paint,
        projected: &projected,
        normals,
        inks,
    };
    let places = sample_places(style.samples);
    match style.samples {
        1 => scene.tiles::<1>(&bins, &places, width, height),
        2 => scene.tiles::<4>(&bins, &places, width, height),
        4 => scene.tiles::<16>(&bins, &places, width, height),
        _ => scene.tiles::<64>(&bins, &places, width, height),
    }
}

/// At each vertex, the sum of the normals of its triangles, weighted by their areas.
fn area_normals(surface: Triangles<'_>) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; surface.positions.len()];
    for (face, triangle) in surface.triangles.iter().enumerate() {
        let [a, b, c] = surface.corners(face).map(DVec3::from_array);
        let normal = (b - a).cross(c - a);
        for &vertex in triangle {
            sums[vertex as usize] += normal;
        }
    }
    sums
}

/// Everything that a pixel's colour depends on.
struct Scene<'a> {
    surface: Triangles<'a>,
    camera: &'a Camera,
    style: &'a Style,
    paint: &'a Paint<'a>,
    projected: &'a Projected,
    /// Unit normals of the vertices in the viewer's frame; empty for flat shading.
    normals: Vec<DVec3>,
    /// Empty without wireframe.
    inks: Vec<Ink>,
}

/// The samples of a pixel at which one triangle is seen.
#[derive(Clone, Copy)]
struct Group {
    face: u32,
    members: u64,
    count: u32,
    /// Sums of the samples' places, in grid steps from the pixel's corner.
    sum: [i32; 2],
}

impl Scene<'_> {
    fn tiles<const S: usize>(
        &self,
        bins: &Bins,
        places: &[[i32; 2]],
        width: u32,
        height: u32,
    ) -> Result<Image, RenderError> {
        let mut fixed = [[0; 2]; S];
        for (place, from) in fixed.iter_mut().zip(places) {
            *place = *from;
        }
        let rows = parallel::map_with(bins.len(), Tile::<S>::new, |tile, index| {
            let area = bins.rectangle(index);
            self.tile(tile, bins.pieces(index), area, &fixed)
        });
        let mut image = Image::new(width, height, self.style.background)?;
        for (index, pixels) in rows.iter().enumerate() {
            let area = bins.rectangle(index);
            let row_bytes = (area.right - area.left) as usize * 4;
            for (y, row) in (area.top..area.bottom).zip(pixels.chunks_exact(row_bytes)) {
                image.row_mut(area.left as u32, y as u32)[..row_bytes].copy_from_slice(row);
            }
        }
        Ok(image)
    }

    /// The bytes of a tile's pixels; empty where nothing is seen.
    fn tile<const S: usize>(
        &self,
        tile: &mut Tile<S>,
        pieces: &[u32],
        area: Rectangle,
        places: &[[i32; 2]; S],
    ) -> Vec<u8> {
        if pieces.is_empty() {
            return Vec::new();
        }
        tile.clear();
        for &piece in pieces {
            let piece = &self.projected.pieces[piece as usize];
            tile.cover(places, area, self.projected.triangle(piece), piece.face);
        }
        let mut bytes = Vec::with_capacity(
            (area.right - area.left) as usize * (area.bottom - area.top) as usize * 4,
        );
        let mut groups = Vec::with_capacity(S);
        for y in area.top..area.bottom {
            for x in area.left..area.right {
                let faces = &tile.face[Tile::<S>::index(area, x, y)];
                gather(faces, places, &mut groups);
                bytes.extend(self.pixel(&groups, [x, y], places));
            }
        }
        bytes
    }

    /// A pixel's bytes from what is seen at its samples.
    fn pixel<const S: usize>(
        &self,
        groups: &[Group],
        [x, y]: [i32; 2],
        places: &[[i32; 2]; S],
    ) -> [u8; 4] {
        let background = self.style.background;
        let behind = f32::from(background[3]) / 255.0;
        let mut sum = [0.0; 3];
        let mut seen = 0;
        for group in groups {
            let colour = self.group(group, [f64::from(x), f64::from(y)], places);
            for (sum, channel) in sum.iter_mut().zip(colour) {
                *sum += channel * group.count as f32;
            }
            seen += group.count;
        }
        if seen == 0 {
            return background;
        }
        let free = (S as u32 - seen) as f32 * behind;
        let backdrop = colour::linear([background[0], background[1], background[2]]);
        let weight = seen as f32 + free;
        let mixed = [0, 1, 2].map(|i| (sum[i] + backdrop[i] * free) / weight);
        let [r, g, b] = colour::encode(mixed);
        [r, g, b, (weight / S as f32 * 255.0 + 0.5) as u8]
    }

    /// The colour of a group: light at the middle of its samples, lines sample by sample.
    fn group<const S: usize>(
        &self,
        group: &Group,
        pixel: [f64; 2],
        places: &[[i32; 2]; S],
    ) -> Linear {
        let step = 1.0 / f64::from(STEPS);
        let per = step / f64::from(group.count);
        let middle = [0, 1].map(|i| pixel[i] + f64::from(group.sum[i]) * per);
        let triangle = self.surface.triangles[group.face as usize];
        let lines = Lines::new(triangle.map(|v| self.projected.homogeneous[v as usize]));
        let colour = self.light(group.face, &lines, middle);
        let Some(ink) = self.inks.get(group.face as usize) else {
            return colour;
        };
        let share = line_share(&lines, ink, group, pixel, places);
        colour::mix(colour, colour::linear(self.style.wire_colour), share)
    }

    /// The lit surface's colour where `face` is seen at a point of the picture.
    fn light(&self, face: u32, lines: &Lines, [x, y]: [f64; 2]) -> Linear {
        let triangle = self.surface.triangles[face as usize];
        let weights = lines.barycentric(x, y);
        let corners = self.surface.corners(face as usize).map(DVec3::from_array);
        let point = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
        let [right, up, back] = self.camera.frame();
        let in_frame = |v: DVec3| DVec3::new(v.dot(right), v.dot(up), v.dot(back));
        let viewer = in_frame(self.camera.towards_viewer(point));
        let mut normal = DVec3::ZERO;
        if !self.normals.is_empty() {
            for (&vertex, weight) in triangle.iter().zip(weights) {
                normal += self.normals[vertex as usize] * weight;
            }
        }
        if normal.length_squared() < 1e-12 {
            normal = in_frame((corners[1] - corners[0]).cross(corners[2] - corners[0]));
        }
        let normal = normal.normalize_or(viewer) * if lines.front { 1.0 } else { -1.0 };
        let albedo = self.albedo(face, weights, lines, [x, y]);
        shade(&self.style.lighting, albedo, normal, viewer)
    }

    /// What part of the light the surface sends back where `face` is seen at a point of the picture.
    fn albedo(&self, face: u32, weights: [f64; 3], lines: &Lines, [x, y]: [f64; 2]) -> Linear {
        let triangle = self.surface.triangles[face as usize];
        let side = |outside: &Linear, inside: &Linear| if lines.front { *outside } else { *inside };
        match self.paint {
            Paint::Sides(outside, inside) => side(outside, inside),
            Paint::Materials {
                covering,
                outside,
                inside,
            } => {
                let own = covering.colour(face, weights, lines.steps(x, y));
                own.unwrap_or_else(|| side(outside, inside))
            }
            Paint::Vertex(colours) => {
                let mut mixed = [0.0; 3];
                for (&vertex, weight) in triangle.iter().zip(weights) {
                    let colour = colour::linear(colours[vertex as usize]);
                    for (sum, channel) in mixed.iter_mut().zip(colour) {
                        *sum += channel * weight as f32;
                    }
                }
                mixed
            }
            Paint::Scalar {
                values,
                scale,
                table,
            } => {
                let corners = triangle.iter().zip(weights);
                let value = corners
                    .map(|(&vertex, weight)| values[vertex as usize] * weight)
                    .sum();
                match scale.above {
                    Some(mark) if value > scale.high => colour::linear(mark),
                    _ => look_up(table, scale.place(value)),
                }
            }
        }
    }
}

/// Groups a pixel's samples by triangle, in the order in which the triangles are first met.
fn gather<const S: usize>(faces: &[u32; S], places: &[[i32; 2]; S], groups: &mut Vec<Group>) {
    groups.clear();
    for s in 0..S {
        let (face, [x, y]) = (faces[s], places[s]);
        if face == NOTHING {
            continue;
        }
        match groups.iter_mut().find(|group| group.face == face) {
            Some(group) => {
                group.members |= 1 << s;
                group.count += 1;
                group.sum = [group.sum[0] + x, group.sum[1] + y];
            }
            None => groups.push(Group {
                face,
                members: 1 << s,
                count: 1,
                sum: [x, y],
            }),
        }
    }
}

/// What part of a group's samples the lines along the triangle's edges cover.
fn line_share<const S: usize>(
    lines: &Lines,
    ink: &Ink,
    group: &Group,
    pixel: [f64; 2],
    places: &[[i32; 2]; S],
) -> f32 {
    // Samples stand for squares: a line's border is blurred over that much of a pixel.
    let blur = 1.0 / (S as f32).sqrt();
    let corner = lines.lines.map(|[a, b, c]| {
        let length = a.hypot(b);
        if length > 0.0 {
            ((a * pixel[0] + b * pixel[1] + c) / length) as f32
        } else {
            0.0
        }
    });
    // No point of a pixel is farther from its corner than its diagonal.
    let near = |i: usize| corner[i].abs() < ink.reach[i] + 2.0;
    if ink.opacity <= 0.0 || !(near(0) || near(1) || near(2)) {
        return 0.0;
    }
    let slopes = lines.distances();
    let step = 1.0 / STEPS as f32;
    let mut total = 0.0;
    for (s, place) in places.iter().enumerate() {
        if group.members & (1 << s) == 0 {
            continue;
        }
        let (x, y) = (place[0] as f32 * step, place[1] as f32 * step);
        let mut darkest = 0.0f32;
        for i in 0..3 {
            let distance = (corner[i] + slopes[i][0] * x + slopes[i][1] * y).abs();
            let covered = ((ink.reach[i] - distance) / blur + 0.5).clamp(0.0, 1.0);
            darkest = darkest.max(covered);
        }
        total += darkest;
    }
    ink.opacity * total / group.count as f32
}
