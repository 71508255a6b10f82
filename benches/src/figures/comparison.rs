//! Uniform refinement, the paper's method, exact refinement and its optimisation at nearly equal triangle counts: the
//! heads of the meshes above, large enough for triangles to be told apart, and the distances of the whole to the limit surface
//! below, in one colour scale.

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::measure::distances_to;
use limitmesh::refine::{Finish, SeamRule};
use limitmesh_paper::{match_angle, methods};
use limitmesh_render::{
    Camera, ColourBar, GridStyle, Image, Lighting, Panel, Scale, Shading, Style, TextStyle,
    ViewDirection, dice, grid, render, render_scalar,
};

use crate::quality::{Judge, Reference, best, builtin, optimized};

/// A model with gently and with sharply bent parts.
const MODEL: &str = "bunny";

/// The uniform level whose count all methods get.
const LEVEL: usize = 2;

/// Steps of the paper's method.
const STEPS: usize = 3;

/// The angle at which the search for the paper's begins, in degrees.
const FIRST_ANGLE: f64 = 10.0;

/// From the front, a little from the right and above.
const VIEW: ViewDirection = ViewDirection {
    sight: [-0.45, -0.2, -1.0],
    up: [0.0, 1.0, 0.0],
};

/// Pixels of a panel below.
const SIZE: (u32, u32) = (160, 214);

/// Pixels of a panel above, the middle of the head in it, and half of its height in the model's units.
const HEAD_SIZE: (u32, u32) = (160, 132);
const HEAD: [f64; 3] = [0.02, 0.14, 0.2];
const HEAD_REACH: f64 = 0.23;

/// The width of edges in pixels: thinner than usual, as triangles are some pixels wide.
const WIRE: f32 = 0.6;

/// Into so many parts a triangle's side is cut for the colours inside of it to show.
const PARTS: usize = 5;

/// The colour scale goes up to so many times the greatest distance of exact refinement, and what is beyond is marked.
const REACH: f64 = 3.0;

/// It begins at this part of its end: by ratios, all four methods have their part of it.
const SPAN: f64 = 1e-2;

/// The colour of what is beyond.
const BEYOND: [u8; 3] = [214, 39, 40];

struct Column {
    mesh: Mesh,
    words: String,
    /// Greatest distance found, in per cent of the diagonal.
    symmetric: f64,
    /// Distances of the diced mesh's vertices, in per cent of the diagonal.
    distances: Vec<f64>,
    diced: (Vec<[f64; 3]>, Vec<[u32; 3]>),
}

/// The PNG file.
pub(super) fn picture() -> Result<Vec<u8>> {
    let control = builtin(MODEL)?;
    let reference = Reference::new(&control)?;
    let judge = Judge::new(&reference)?;
    let uniform = methods::uniform_plain(&control, LEVEL)?.mesh;
    let triangles = uniform.face_count();
    let paper = match_angle(triangles, FIRST_ANGLE, |angle| {
        methods::paper(&control, angle, STEPS, SeamRule::All)
    })?;
    let columns = [
        column(uniform, "uniform".to_owned(), &judge)?,
        column(
            paper.refinement.mesh,
            format!("the paper’s method, {:.1}°", paper.angle_degrees),
            &judge,
        )?,
        column(
            best(&control, triangles, Finish::OnSurface)?,
            "exact".to_owned(),
            &judge,
        )?,
        column(
            optimized(&control, triangles)?,
            "exact, optimised".to_owned(),
            &judge,
        )?,
    ];
    let camera = Camera::fit_tightly(reference.mesh.as_triangles(), VIEW, SIZE.0, SIZE.1)?;
    let close = Camera::orthographic(HEAD, VIEW, HEAD_REACH)?;
    let [_, _, exact, _] = &columns;
    let most = REACH * exact.symmetric;
    let scale = Scale::logarithmic(SPAN * most, most).marking_above(BEYOND);
    let mut panels = Vec::new();
    for (letter, column) in ('a'..).zip(&columns) {
        panels.push(Panel::new(
            head(column, &close)?,
            format!("({letter}) {}", column.words),
        ));
    }
    for (letter, column) in ('e'..).zip(&columns) {
        let caption = format!(
            "({letter}) {} triangles, {:.3} %",
            limitmesh_paper::format::thousands(column.mesh.face_count()),
            column.symmetric
        );
        panels.push(Panel::new(heat(column, &scale, &camera)?, caption));
    }
    let style = GridStyle::default()
        .columns(columns.len())
        .gap(8)
        .caption(TextStyle::default().size(12.0));
    let bar = ColourBar::new(scale)
        .title("distance")
        .unit("%")
        .text_size(11.5);
    Ok(bar
        .beside(&grid(&panels, &style)?, style.background)?
        .encode_png()?)
}

fn column(mesh: Mesh, words: String, judge: &Judge<'_>) -> Result<Column> {
    let symmetric = judge.percent(judge.distance(&mesh)?);
    let diced = dice(mesh.as_triangles(), PARTS);
    let mut distances = distances_to(&diced.0, judge.reference.mesh.as_triangles())?;
    distances
        .iter_mut()
        .for_each(|distance| *distance = judge.percent(*distance));
    Ok(Column {
        mesh,
        words,
        symmetric,
        distances,
        diced,
    })
}

fn head(column: &Column, camera: &Camera) -> Result<Image> {
    let style = Style::default()
        .wireframe(true)
        .wire_width(WIRE)
        .shading(Shading::Flat);
    Ok(render(
        column.mesh.as_triangles(),
        None,
        None,
        camera,
        &style,
        HEAD_SIZE.0,
        HEAD_SIZE.1,
    )?)
}

fn heat(column: &Column, scale: &Scale, camera: &Camera) -> Result<Image> {
    let surface = limitmesh::Triangles {
        positions: &column.diced.0,
        triangles: &column.diced.1,
    };
    let style = Style::default()
        .shading(Shading::Flat)
        .lighting(Lighting::even());
    Ok(render_scalar(
        surface,
        None,
        &column.distances,
        scale,
        camera,
        &style,
        SIZE,
    )?)
}
