//! `limitmesh render`: a picture of a mesh.

use anyhow::{Context, bail};
use limitmesh::mesh::SplitSurface;
use limitmesh::refine::limit_reference;
use limitmesh::{LimitSurface, RayCaster};
use limitmesh_render::{Camera, Shading, Style, render_exact_observed};

use super::covering::Cover;
use super::limit_control;
use super::{picture, shading};
use crate::arguments::{
    CreaseAngle, FeatureArguments, InterpolationArguments, LimitArguments, RenderArguments,
};
use crate::failure::{Outcome, usage};
use crate::format::counted;
use crate::input;
use crate::output;
use crate::progress::Progress;

/// Items of a soup's left-out list that pictures do without, or have by other ways.
const UNSEEN: [&str; 3] = ["normals", "tangents", "colours and textures of materials"];

/// Reads a mesh and draws it.
pub(crate) fn run(arguments: &RenderArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    picture::check_name(&arguments.output)?;
    let texture = arguments.texture.as_deref();
    output::check_replaced(&[&arguments.output], texture.as_slice(), None)?;
    if arguments.scheme.is_some() && !arguments.exact {
        return usage(
            "--scheme is that of a limit surface; it needs --exact, without which the mesh itself is drawn",
        );
    }
    if arguments.exact {
        return exact(arguments, progress);
    }
    if arguments.crease_angle == Some(CreaseAngle::Auto) {
        return usage("--crease-angle auto is for limit surfaces; it needs --exact");
    }
    let input = input::load(&arguments.input, &arguments.build, &UNSEEN, progress)?;
    let cover = Cover::of(&input, arguments.texture.as_deref())?;
    let mut mesh = input.mesh;
    if let Some(angle) = arguments.crease_angle.and_then(CreaseAngle::degrees) {
        mesh = mesh.with_creases_above(angle.to_radians())?;
    }
    progress.stage(format!(
        "drawing {}",
        counted(mesh.face_count(), "triangle", "triangles")
    ));
    let shading = if arguments.flat {
        Shading::Flat
    } else {
        Shading::Smooth
    };
    let style = Style::default()
        .shading(shading)
        .wireframe(arguments.wireframe);
    let view = picture::view_direction(arguments.view);
    let normals = input
        .normals
        .filter(|_| !arguments.smooth && arguments.crease_angle.is_none());
    let is_free = !arguments.smooth && arguments.crease_angle.is_none();
    let split = match &normals {
        _ if arguments.flat => None,
        Some(normals) => Some(shading::by_normals(&mesh, normals)),
        None if is_free => Some(shading::without_normals(&mesh)?),
        None => Some(SplitSurface::by_faces(&mesh)),
    };
    let (surface, normals) = match &split {
        Some(split) => (split.as_triangles(), Some(&split.normals[..])),
        None => (mesh.as_triangles(), None),
    };
    let covering = cover.as_ref().map(Cover::covering);
    let (path, size) = (&arguments.output, arguments.size);
    picture::draw(
        path,
        surface,
        normals,
        covering.as_ref(),
        view,
        &style,
        size,
    )?;
    progress.note(picture::drawn(&arguments.output, mesh.face_count()));
    Ok(Outcome::Done)
}

/// Triangles of the mesh by which a limit surface is framed.
const FRAMED: usize = 100_000;

/// Draws the limit surface of a control mesh by rays.
fn exact(arguments: &RenderArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    let limit = LimitArguments {
        scheme: arguments.scheme,
        smooth_triangles: false,
        features: FeatureArguments {
            crease_angle: arguments.crease_angle,
            ..FeatureArguments::default()
        },
        interpolation: InterpolationArguments::default(),
        build: arguments.build,
    };
    let (input, limit) = limit_control::load(&arguments.input, &limit, progress)?;
    let name = input.name.clone();
    let mesh = limit_control::prepared(input, &limit, progress)?.input.mesh;
    let scheme = limit.scheme().scheme();
    let surface = LimitSurface::new(&mesh, scheme).with_context(|| name.clone())?;
    let rays = RayCaster::new(&surface).with_context(|| name.clone())?;
    if mesh.face_count() == 0 {
        bail!("{name}: there are no faces to draw");
    }
    let levels = (0..4)
        .find(|&levels| mesh.face_count() << (2 * levels + 2) > FRAMED)
        .unwrap_or(4);
    let outline = limit_reference(&mesh, scheme, levels).with_context(|| name.clone())?;
    let (view, size) = (picture::view_direction(arguments.view), arguments.size);
    let camera = Camera::fit_tightly(outline.as_triangles(), view, size.width, size.height)?;
    let size = (size.width, size.height);
    let image = render_exact_observed(
        &rays,
        &camera,
        &Style::default(),
        size,
        &mut progress.observer(),
    )?;
    output::write_file(&arguments.output, &image.encode_png()?)?;
    let faces = counted(mesh.face_count(), "control face", "control faces");
    progress.note(format!(
        "{}: the limit surface of {faces} drawn by rays",
        arguments.output.display()
    ));
    Ok(Outcome::Done)
}
