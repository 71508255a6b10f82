//! `limitmesh render`: a picture of a mesh.

use anyhow::{Context, bail};
use limitmesh::mesh::{Channel, SplitSurface};
use limitmesh::refine::{is_certified, limit_reference};
use limitmesh::{LimitSurface, Mesh, RayCaster};
use limitmesh_render::{Camera, Shading, Style, render_exact_observed};

use super::covering::Cover;
use super::limit_control::{self, Prepared};
use super::picture;
use crate::arguments::{
    CreaseAngle, FeatureArguments, InterpolationArguments, LimitArguments, RenderArguments,
};
use crate::failure::{Outcome, usage};
use crate::format::counted;
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::vector::{cross, minus};

/// What pictures do without, or have by other ways.
const UNSEEN: [&str; 3] = ["normals", "tangents", "colours and textures of materials"];

/// Reads a mesh and draws it.
pub(crate) fn run(arguments: &RenderArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    picture::check_name(&arguments.output)?;
    check_scheme(arguments)?;
    if arguments.exact {
        return exact(arguments, progress);
    }
    if arguments.crease_angle == Some(CreaseAngle::Auto) {
        return usage("--crease-angle auto is for limit surfaces; it needs --exact");
    }
    let input = input::load_keeping(&arguments.input, &arguments.build, &UNSEEN, progress)?;
    let cover = Cover::of(&input, arguments.texture.as_deref())?;
    let mut mesh = input.mesh;
    if let Some(angle) = arguments.crease_angle.and_then(CreaseAngle::degrees) {
        mesh = mesh.with_creases_above(angle.to_radians())?;
    }
    progress.stage(format!("drawing {}", counted(mesh.face_count(), "triangle", "triangles")));
    let shading = if arguments.flat { Shading::Flat } else { Shading::Smooth };
    let style = Style::default().shading(shading).wireframe(arguments.wireframe);
    let view = picture::view_direction(arguments.view);
    let normals = input.normals.filter(|_| !arguments.smooth && arguments.crease_angle.is_none());
    let split = (!arguments.flat).then(|| match &normals {
        Some(normals) => by_normals(&mesh, normals),
        None => SplitSurface::by_faces(&mesh),
    });
    let (surface, normals) = match &split {
        Some(split) => (split.as_triangles(), Some(&split.normals[..])),
        None => (mesh.as_triangles(), None),
    };
    match &cover {
        Some(cover) => {
            let covered = (surface, normals, &cover.covering());
            picture::draw_covered(&arguments.output, covered, view, &style, arguments.size)?;
        }
        None => picture::draw(&arguments.output, surface, normals, view, &style, arguments.size)?,
    }
    let drawn = counted(mesh.face_count(), "triangle", "triangles");
    progress.note(format!("{}: {drawn} drawn", arguments.output.display()));
    Ok(Outcome::Done)
}

/// Refuses a scheme whose limit surface is not drawn.
fn check_scheme(arguments: &RenderArguments) -> anyhow::Result<()> {
    let Some(name) = arguments.scheme else { return Ok(()) };
    if !arguments.exact {
        return usage(
            "--scheme is that of a limit surface; it needs --exact, without which the mesh itself is drawn",
        );
    }
    if !is_certified(name.scheme()) {
        return usage(format!(
            "--scheme {}: rays are followed to limit surfaces of loop and loop-warren alone",
            name.scheme().name()
        ));
    }
    Ok(())
}

/// A mesh with the normals that its file has; with those of its faces where it has none.
fn by_normals(mesh: &Mesh, normals: &Channel) -> SplitSurface {
    let by_faces = SplitSurface::by_faces(mesh);
    let number = |corner: usize, i: usize| normals.value(corner).get(i).copied().unwrap_or(0.0);
    // The way round says which side is drawn, and may have been mended: normals are those of that side.
    let faces_against = |face: usize| {
        let [a, b, c] = mesh.triangles()[face].map(|v| mesh.positions()[v as usize]);
        let own = cross(minus(b, a), minus(c, a));
        (3 * face..3 * face + 3).flat_map(|corner| [0, 1, 2].map(|i| own[i] * number(corner, i))).sum::<f64>()
            < 0.0
    };
    let is_against: Vec<bool> = (0..mesh.face_count()).map(faces_against).collect();
    SplitSurface::new(mesh, |h| {
        let (corner, face) = (h.index(), h.face().index());
        let own = [0, 1, 2].map(|i| number(corner, i));
        let length = own.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 && length.is_finite() {
            let length = if is_against[face] { -length } else { length };
            return own.map(|x| x / length);
        }
        by_faces.normals[by_faces.triangles[face][corner % 3] as usize]
    })
}

/// Triangles of the mesh by which a limit surface is framed.
const FRAMED: usize = 100_000;

/// Draws the limit surface of a control mesh by rays.
fn exact(arguments: &RenderArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    let input = input::load(&arguments.input, &arguments.build, progress)?;
    let name = input.name.clone();
    let limit = LimitArguments {
        scheme: arguments.scheme,
        features: FeatureArguments { crease_angle: arguments.crease_angle, ..FeatureArguments::default() },
        interpolation: InterpolationArguments::default(),
        build: arguments.build,
    };
    let Prepared { mesh, limit, .. } = limit_control::prepared(input, &limit, progress)?;
    let scheme = limit.scheme().scheme();
    let surface = LimitSurface::new(&mesh, scheme).with_context(|| name.clone())?;
    let rays = RayCaster::new(&surface).with_context(|| name.clone())?;
    if mesh.face_count() == 0 {
        bail!("{name}: there are no faces to draw");
    }
    let levels = (0..4).find(|&levels| mesh.face_count() << (2 * levels + 2) > FRAMED).unwrap_or(4);
    let outline = limit_reference(&mesh, scheme, levels).with_context(|| name.clone())?;
    let (view, size) = (picture::view_direction(arguments.view), arguments.size);
    let camera = Camera::fit_tightly(outline.as_triangles(), view, size.width, size.height)?;
    let size = (size.width, size.height);
    let image = render_exact_observed(&rays, &camera, &Style::default(), size, &mut progress.observer())?;
    output::write_file(&arguments.output, &image.encode_png()?)?;
    let faces = counted(mesh.face_count(), "control face", "control faces");
    progress.note(format!("{}: the limit surface of {faces} drawn by rays", arguments.output.display()));
    Ok(Outcome::Done)
}
