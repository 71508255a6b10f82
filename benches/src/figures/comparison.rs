//! Uniform refinement, the paper's method and exact refinement at nearly equal triangle counts: the meshes above, their
//! distances to the limit surface below, in one colour scale.

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::limit::LimitTable;
use limitmesh::measure::distances_to;
use limitmesh::scheme::Loop;
use limitmesh_render::{
    Camera, ColourBar, GridStyle, Image, Lighting, Panel, Scale, Shading, Style, TextStyle, ViewDirection,
    dice, grid, render, render_scalar,
};

use super::methods;
use crate::quality::{Judge, Reference, best, builtin};

/// A model with flat, round and sharply bent parts.
const MODEL: &str = "cup";

/// The uniform level whose count all methods get.
const LEVEL: usize = 1;

/// Steps of the paper's method.
const STEPS: usize = 3;

/// From the front, a little from the right and above.
const VIEW: ViewDirection = ViewDirection { sight: [-0.35, -0.45, -1.0], up: [0.0, 1.0, 0.0] };

/// Pixels of a panel.
const SIZE: (u32, u32) = (400, 380);

/// Into so many parts a triangle's side is cut for the colours inside of it to show.
const PARTS: usize = 8;

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
    let uniform = methods::uniform(&control, LEVEL, true)?;
    let triangles = uniform.face_count();
    let (angle, paper) = methods::paper_with(&control, triangles, STEPS)?;
    let exact = best(&control, triangles, false)?;
    let columns = [
        column(uniform, "uniform, vertices on the limit".to_owned(), &judge)?,
        column(paper, format!("the paper’s method, {angle:.1}°"), &judge)?,
        column(exact, "exact".to_owned(), &judge)?,
    ];
    let camera = Camera::fit_tightly(reference.mesh.as_triangles(), VIEW, SIZE.0, SIZE.1)?;
    let greatest = columns.iter().flat_map(|c| &c.distances).copied().fold(0.0, f64::max);
    let scale = Scale::new(0.0, greatest);
    let mut panels = Vec::new();
    for (letter, column) in ('a'..).zip(&columns) {
        panels.push(Panel::new(mesh(column, &camera)?, format!("({letter}) {}", column.words)));
    }
    for (letter, column) in ('d'..).zip(&columns) {
        let caption = format!(
            "({letter}) {} triangles, distance {:.2} %",
            crate::quality::count(column.mesh.face_count()),
            column.symmetric
        );
        panels.push(Panel::new(heat(column, &scale, &camera)?, caption));
    }
    let style = GridStyle::default().gap(6).caption(TextStyle::default().size(16.0));
    let bar = ColourBar::new(scale).title("distance").unit("%").text_size(15.0);
    Ok(bar.beside(&grid(&panels, &style)?, style.background)?.encode_png()?)
}

fn column(mesh: Mesh, words: String, judge: &Judge<'_>) -> Result<Column> {
    let symmetric = judge.percent(judge.distance(&mesh)?);
    let diced = dice(mesh.as_triangles(), PARTS);
    let mut distances = distances_to(&diced.0, judge.reference.mesh.as_triangles())?;
    distances.iter_mut().for_each(|distance| *distance = judge.percent(*distance));
    Ok(Column { mesh, words, symmetric, distances, diced })
}

fn mesh(column: &Column, camera: &Camera) -> Result<Image> {
    let normals = LimitTable::new(&Loop).normals(&column.mesh)?;
    let style = Style::default().wireframe(true).shading(Shading::Flat);
    Ok(render(column.mesh.as_triangles(), Some(&normals), None, camera, &style, SIZE.0, SIZE.1)?)
}

fn heat(column: &Column, scale: &Scale, camera: &Camera) -> Result<Image> {
    let surface = limitmesh::Triangles { positions: &column.diced.0, triangles: &column.diced.1 };
    let style = Style::default().shading(Shading::Flat).lighting(Lighting::even());
    Ok(render_scalar(surface, None, &column.distances, scale, camera, &style, SIZE)?)
}
