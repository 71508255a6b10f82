//! Meshes for unit tests.

use limitmesh_mesh::{Mesh, PolygonSoup};

use crate::Random;

/// The built-in model of that name.
#[allow(clippy::unwrap_used)]
pub fn model(name: &str) -> Mesh {
    let soup = limitmesh_models::find(name).unwrap().soup();
    Mesh::from_soup(&soup, &Default::default()).unwrap().0
}

/// Points on a model's, each off by up to a share of the diagonal that depends on the seed.
#[allow(clippy::unwrap_used)]
pub fn stirred(name: &str, seed: u64) -> Mesh {
    stir(model(name), seed)
}

/// Stirs any mesh.
#[allow(clippy::unwrap_used)]
pub fn stir(mesh: Mesh, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let size = [0.0, 0.01, 0.05, 0.2][seed as usize % 4] * mesh.diagonal();
    let positions = mesh
        .positions()
        .iter()
        .map(|p| p.map(|x| x + size * random.signed()))
        .collect();
    mesh.with_positions(positions).unwrap()
}

/// Three sheets that meet at an edge, and are cut there; one of them looks the other way.
#[allow(clippy::unwrap_used)]
pub fn book() -> Mesh {
    let (pages, rows, columns) = (3, 5, 3);
    let mut soup = PolygonSoup::default();
    soup.positions
        .extend((0..rows).map(|row| [0.0, 0.0, f64::from(row)]));
    for page in 0..pages {
        let (sin, cos) = (core::f64::consts::TAU * f64::from(page) / f64::from(pages)).sin_cos();
        for column in 1..=columns {
            let out = f64::from(column);
            let at = |row| {
                [
                    out * cos,
                    out * sin,
                    f64::from(row) + 0.3 * f64::from((row * column) % 2),
                ]
            };
            soup.positions.extend((0..rows).map(at));
        }
        let number = |column: u32, row: u32| {
            let own = if column == 0 {
                0
            } else {
                1 + page as u32 * columns as u32 + column - 1
            };
            own * rows as u32 + row
        };
        for (column, row) in (0..columns as u32)
            .flat_map(|column| (0..rows as u32 - 1).map(move |row| (column, row)))
        {
            let (next, above) = (column + 1, row + 1);
            let here = number(column, row);
            for mut corners in [
                [here, number(next, row), number(next, above)],
                [here, number(next, above), number(column, above)],
            ] {
                if page == 1 {
                    corners.reverse();
                }
                soup.faces.push(&corners);
            }
        }
    }
    let mesh = Mesh::from_soup(&soup, &Default::default()).unwrap().0;
    assert!(!mesh.junctions().edges.is_empty());
    mesh
}
