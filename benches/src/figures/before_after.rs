//! What refinement is for: a part with sharp edges and an organic shape, as they were drawn and as they come out.

use anyhow::Result;
use limitmesh::mesh::PolygonFaces;
use limitmesh::refine::{Exact, ExactOptions, exact};
use limitmesh::scheme::Loop;
use limitmesh::{FaceId, HalfEdgeId, Mesh, PolygonSoup, Triangles};
use limitmesh_paper::format::thousands;
use limitmesh_render::{
    Camera, GridStyle, Image, Panel, Shading, Style, TextStyle, ViewDirection, grid, render,
};

use crate::quality::builtin;

/// The organic shape.
const MODEL: &str = "bunny";

/// Corners of the part's cross-section: radius and height. A flange with a hub and a bore.
const PROFILE: [[f64; 2]; 6] = [[0.34, 0.0], [1.0, 0.0], [1.0, 0.28], [0.6, 0.28], [0.6, 0.9], [0.34, 0.9]];

/// Facets around the part's axis.
const FACETS: u32 = 16;

/// Edges that are sharper stay so, in degrees: the facets meet at 22.5.
const CREASE: f64 = 30.0;

/// Part of the diagonal that the results are off by at most.
const TOLERANCE: f64 = 0.001;

/// Pixels of a panel.
const SIZE: (u32, u32) = (268, 300);

/// Where the two are looked at from.
const PART_VIEW: ViewDirection = ViewDirection { sight: [-0.35, -0.75, -1.0], up: [0.0, 1.0, 0.0] };
const MODEL_VIEW: ViewDirection = ViewDirection { sight: [-0.45, -0.2, -1.0], up: [0.0, 1.0, 0.0] };

/// The PNG file.
pub(super) fn picture() -> Result<Vec<u8>> {
    let part = part()?.with_creases_above(CREASE.to_radians())?;
    let mut panels = Vec::new();
    for (control, view) in [(part, PART_VIEW), (builtin(MODEL)?, MODEL_VIEW)] {
        let options = ExactOptions::default().tolerance(TOLERANCE * control.diagonal());
        let refined = exact(&control, &Loop, &options)?;
        let camera = Camera::fit_tightly(control.as_triangles(), view, SIZE.0, SIZE.1)?;
        let style = Style::default().wireframe(true).shading(Shading::Flat);
        let before = render(control.as_triangles(), None, None, &camera, &style, SIZE.0, SIZE.1)?;
        let triangles = |mesh: &Mesh| thousands(mesh.face_count());
        panels.push(Panel::new(before, format!("{} triangles …", triangles(&control))));
        let percent = 100.0 * refined.error.upper / control.diagonal();
        let words = format!("… smooth within {percent:.2} %: {}", triangles(&refined.mesh));
        panels.push(Panel::new(by_sides(&refined, &camera)?, words));
    }
    let style = GridStyle::default().columns(panels.len()).gap(6).caption(TextStyle::default().size(15.0));
    Ok(grid(&panels, &style)?.encode_png()?)
}

/// The part: its cross-section turned around the axis.
fn part() -> Result<Mesh> {
    let corners = PROFILE.len() as u32;
    let mut soup = PolygonSoup { faces: PolygonFaces::with_capacity(0, 0), ..PolygonSoup::default() };
    for facet in 0..FACETS {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(facet) / f64::from(FACETS)).sin_cos();
        soup.positions.extend(PROFILE.map(|[radius, height]| [radius * cosine, height, radius * sine]));
        let vertex = |facet: u32, corner: u32| facet % FACETS * corners + corner % corners;
        for corner in 0..corners {
            let next = corner + 1;
            soup.faces.push(&[
                vertex(facet, corner),
                vertex(facet, next),
                vertex(facet + 1, next),
                vertex(facet + 1, corner),
            ]);
        }
    }
    Ok(Mesh::from_soup(&soup, &Default::default())?.0)
}

/// The refined mesh with the normals of each side at sharp edges, so that these look sharp: no corner is shared then.
fn by_sides(refined: &Exact, camera: &Camera) -> Result<Image> {
    let surface = refined.mesh.as_triangles();
    let faces = 0..surface.triangles.len();
    let positions: Vec<[f64; 3]> = faces.clone().flat_map(|face| surface.corners(face)).collect();
    let corners =
        faces.clone().flat_map(|face| [0, 1, 2].map(|side| HalfEdgeId::of(FaceId(face as u32), side)));
    let normals: Vec<[f64; 3]> = corners.map(|corner| refined.corner_normal(corner)).collect();
    let triangles: Vec<[u32; 3]> = faces.map(|face| [0, 1, 2].map(|side| 3 * face as u32 + side)).collect();
    let surface = Triangles { positions: &positions, triangles: &triangles };
    // Each of two triangles draws the whole width of a line on its side of an edge that is not shared.
    let style = Style::default().wireframe(true);
    let style = style.wire_width(0.5 * style.wire_width);
    Ok(render(surface, Some(&normals), None, camera, &style, SIZE.0, SIZE.1)?)
}
