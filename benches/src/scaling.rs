//! Exact refinement of ever larger meshes, each larger in one way: processor time a control face must not grow.

use core::f64::consts::{PI, TAU};

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::mesh::{CornerTag, CreaseTag, PolygonSoup};
use limitmesh::refine::{ExactOptions, exact};
use limitmesh::scheme::Loop;

use crate::clock::one_thread;

/// The tolerance, as a part of the diagonal.
const TOLERANCE: f64 = 0.01;

const SIZES: [usize; 4] = [100, 1_000, 10_000, 100_000];

/// A mesh that is so large.
type Shape = fn(usize) -> PolygonSoup;

/// Prints a table for each way of being large.
pub(crate) fn scaling() -> Result<()> {
    println!(
        "exact refinement within {} % of the diagonal, one thread",
        100.0 * TOLERANCE
    );
    println!(
        "shape                          size  control faces  triangles  ms         µs a face  µs a triangle"
    );
    let shapes: [(&str, Shape); 6] = [
        ("edges at one vertex", pole),
        ("edges at a boundary's vertex", fan),
        ("edges at a semi-sharp vertex", semi_sharp_pole),
        ("semi-sharp edges at a vertex", semi_sharp_edges),
        ("sheets at one edge", sheets),
        ("faces of a sphere", sphere),
    ];
    for (name, shape) in shapes {
        for size in SIZES {
            let (control, _) = Mesh::from_soup(&shape(size), &Default::default())?;
            let options = ExactOptions::default().tolerance(TOLERANCE * control.diagonal());
            let (seconds, result) = one_thread(|| exact(&control, &Loop, &options))?;
            let (faces, triangles) = (control.face_count(), result?.mesh.face_count());
            let micro = 1e6 * seconds.all;
            println!(
                "{name:28}  {size:6}  {faces:13}  {triangles:9}  {:9.1}  {:9.2}  {:6.2}",
                1e-3 * micro,
                micro / faces as f64,
                micro / triangles as f64
            );
        }
    }
    Ok(())
}

fn soup(positions: Vec<[f64; 3]>, triangles: &[[u32; 3]]) -> PolygonSoup {
    let faces = triangles.iter().map(|triangle| &triangle[..]).collect();
    PolygonSoup {
        positions,
        faces,
        ..Default::default()
    }
}

/// Points of an uneven circle.
fn circle(count: usize, turn: f64) -> impl Iterator<Item = [f64; 3]> {
    let angle = move |i: usize| turn * i as f64 / count as f64;
    (0..count).map(move |i| {
        [
            angle(i).cos(),
            angle(i).sin(),
            0.05 * (5.0 * angle(i)).sin(),
        ]
    })
}

/// Two vertices of so many edges.
fn pole(edges: usize) -> PolygonSoup {
    let positions = [[0.0, 0.0, 0.5], [0.0, 0.0, -0.5]]
        .into_iter()
        .chain(circle(edges, TAU));
    let rim = |i: usize| 2 + (i % edges) as u32;
    let faces = (0..edges).flat_map(|i| [[0, rim(i), rim(i + 1)], [1, rim(i + 1), rim(i)]]);
    soup(positions.collect(), &faces.collect::<Vec<_>>())
}

/// The same, one of them a corner for a while.
fn semi_sharp_pole(edges: usize) -> PolygonSoup {
    PolygonSoup {
        corners: vec![CornerTag {
            vertex: 0,
            sharpness: 2.5,
        }],
        ..pole(edges)
    }
}

/// The same as smooth, but for every third edge at one of them, which is sharp for a while, and longer from one to the next.
fn semi_sharp_edges(edges: usize) -> PolygonSoup {
    let crease = |i: usize| CreaseTag {
        vertices: [0, 2 + i as u32],
        sharpness: 0.4 + 0.7 * (i % 5) as f64,
    };
    PolygonSoup {
        creases: (0..edges).step_by(3).map(crease).collect(),
        ..pole(edges)
    }
}

/// A vertex of the boundary with so many edges.
fn fan(edges: usize) -> PolygonSoup {
    let positions = core::iter::once([0.0, 0.0, 0.3]).chain(circle(edges, PI));
    let faces: Vec<[u32; 3]> = (1..edges as u32).map(|i| [0, i, i + 1]).collect();
    soup(positions.collect(), &faces)
}

/// So many triangles at one edge.
fn sheets(count: usize) -> PolygonSoup {
    let positions = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        .into_iter()
        .chain(circle(count, TAU));
    let faces: Vec<[u32; 3]> = (2..2 + count as u32).map(|i| [0, 1, i]).collect();
    soup(positions.collect(), &faces)
}

/// A sphere by degrees of latitude and longitude, of about so many faces.
fn sphere(faces: usize) -> PolygonSoup {
    let rows = ((faces as f64 / 4.0).sqrt() as usize).max(3);
    let columns = 2 * rows;
    let mut positions = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    for row in 1..rows {
        let (z, radius) = (
            (PI * row as f64 / rows as f64).cos(),
            (PI * row as f64 / rows as f64).sin(),
        );
        let angle = |column: usize| TAU * column as f64 / columns as f64;
        positions
            .extend((0..columns).map(|c| [radius * angle(c).cos(), radius * angle(c).sin(), z]));
    }
    let at = |row: usize, column: usize| (2 + (row - 1) * columns + column % columns) as u32;
    let mut triangles = Vec::new();
    for column in 0..columns {
        let next = column + 1;
        triangles.push([0, at(1, column), at(1, next)]);
        triangles.push([1, at(rows - 1, next), at(rows - 1, column)]);
        for row in 1..rows - 1 {
            triangles.push([at(row, column), at(row + 1, column), at(row + 1, next)]);
            triangles.push([at(row, column), at(row + 1, next), at(row, next)]);
        }
    }
    soup(positions, &triangles)
}
