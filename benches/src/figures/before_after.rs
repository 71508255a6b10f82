//! What refinement is for: a part with sharp edges and an organic shape, as they were drawn and as they come out.

use anyhow::Result;
use limitmesh::mesh::PolygonFaces;
use limitmesh::refine::{Exact, ExactOptions, exact};
use limitmesh::scheme::Loop;
use limitmesh::{Mesh, PolygonSoup};
use limitmesh_paper::format::thousands;
use limitmesh_render::{
    Camera, GridStyle, Image, Panel, Shading, Style, TextStyle, ViewDirection, grid, render,
};

use crate::quality::builtin;

/// The organic shape.
const MODEL: &str = "bunny";

/// Corners of the part's cross-section: radius and height. A flange with a hub and a bore.
const PROFILE: [[f64; 2]; 6] = [
    [0.34, 0.0],
    [1.0, 0.0],
    [1.0, 0.28],
    [0.6, 0.28],
    [0.6, 0.9],
    [0.34, 0.9],
];

/// Facets around the part's axis.
const FACETS: u32 = 16;

/// Edges that are sharper stay so, in degrees: the facets meet at 22.5.
const CREASE: f64 = 30.0;

/// Part of the diagonal that the results are off by at most.
const TOLERANCE: f64 = 0.001;

/// Pixels of a panel with the part, and with the shape.
const PART_SIZE: (u32, u32) = (300, 300);
const MODEL_SIZE: (u32, u32) = (220, 300);

/// The edges of what comes out are thinner and paler: it is its shading that is to be seen.
const WIRE: f32 = 0.6;
const PALE: [u8; 3] = [104, 124, 152];

/// Where the two are looked at from.
const PART_VIEW: ViewDirection = ViewDirection {
    sight: [-0.35, -0.75, -1.0],
    up: [0.0, 1.0, 0.0],
};
const MODEL_VIEW: ViewDirection = ViewDirection {
    sight: [-0.45, -0.2, -1.0],
    up: [0.0, 1.0, 0.0],
};

/// The PNG file.
pub(super) fn picture() -> Result<Vec<u8>> {
    let part = part()?.with_creases_above(CREASE.to_radians())?;
    let mut panels = Vec::new();
    let shapes = [
        (part, PART_VIEW, PART_SIZE),
        (builtin(MODEL)?, MODEL_VIEW, MODEL_SIZE),
    ];
    for (control, view, size) in shapes {
        let options = ExactOptions::default().tolerance(TOLERANCE * control.diagonal());
        let refined = exact(&control, &Loop, &options)?;
        let camera = Camera::fit_tightly(control.as_triangles(), view, size.0, size.1)?;
        let style = Style::default().wireframe(true).shading(Shading::Flat);
        let before = render(
            control.as_triangles(),
            None,
            None,
            &camera,
            &style,
            size.0,
            size.1,
        )?;
        let triangles = |mesh: &Mesh| thousands(mesh.face_count());
        panels.push(Panel::new(
            before,
            format!("{} triangles", triangles(&control)),
        ));
        let percent = 100.0 * refined.error.upper / control.diagonal();
        let words = format!(
            "{} triangles within {percent:.2} %",
            triangles(&refined.mesh)
        );
        panels.push(Panel::new(by_sides(&refined, &camera, size)?, words));
    }
    let style = GridStyle::default()
        .columns(panels.len())
        .gap(6)
        .caption(TextStyle::default().size(14.0));
    Ok(grid(&panels, &style)?.encode_png()?)
}

/// The part: its cross-section turned around the axis.
fn part() -> Result<Mesh> {
    let corners = PROFILE.len() as u32;
    let mut soup = PolygonSoup {
        faces: PolygonFaces::with_capacity(0, 0),
        ..PolygonSoup::default()
    };
    for facet in 0..FACETS {
        let (sine, cosine) =
            (std::f64::consts::TAU * f64::from(facet) / f64::from(FACETS)).sin_cos();
        soup.positions
            .extend(PROFILE.map(|[radius, height]| [radius * cosine, height, radius * sine]));
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

/// The refined mesh with the normals of each side at sharp edges, so that these look sharp.
fn by_sides(refined: &Exact, camera: &Camera, size: (u32, u32)) -> Result<Image> {
    let surface = refined.split_surface();
    let style = Style::default()
        .wireframe(true)
        .wire_width(WIRE)
        .wire_colour(PALE);
    Ok(render(
        surface.as_triangles(),
        Some(&surface.normals),
        None,
        camera,
        &style,
        size.0,
        size.1,
    )?)
}
