//! The limit surface asked point by point: evaluations, and closest points beside those of a fine mesh that stands for it.
//!
//! Processor seconds of one thread.

use std::path::Path;

use anyhow::Result;
use limitmesh::measure::Bvh;
use limitmesh::refine::limit_reference;
use limitmesh::scheme::Loop;
use limitmesh::{FaceId, LimitSurface, Mesh, Proximity};

use crate::clock::one_thread;
use crate::mesh;

/// Places that are evaluated, and points that are projected.
const COUNT: usize = 200_000;

/// Points along each side of the grids over faces.
const SIDE: u32 = 32;

/// Levels of the mesh that stands for the surface.
const LEVELS: usize = 4;

/// Prints the tables of docs/benchmarks.md.
pub(crate) fn points(model: &Path) -> Result<()> {
    let mesh = mesh(model)?;
    let surface = LimitSurface::new(&mesh, &Loop)?;
    evaluations(&mesh, &surface)?;
    println!();
    closest(&mesh, &surface)
}

fn evaluations(mesh: &Mesh, surface: &LimitSurface<'_>) -> Result<()> {
    println!("| evaluation | places | million a second |");
    println!("|---|---:|---:|");
    let row = |name: &str, places: &[(FaceId, [f64; 3])], seconds: f64| {
        println!(
            "| {name} | {} | {:.2} |",
            places.len(),
            1e-6 * places.len() as f64 / seconds
        );
    };
    let scattered = places(mesh);
    let (time, _) = one_thread(|| surface.at_all(&scattered))?;
    row("points and normals, scattered", &scattered, time.all);
    let (time, _) = one_thread(|| surface.derivatives_at(&scattered))?;
    row("with second derivatives, scattered", &scattered, time.all);
    let steps = (0..=SIDE).flat_map(|j| (0..=SIDE - j).map(move |k| (j, k)));
    let weights = steps.map(|(j, k)| {
        let [u, v] = [j, k].map(|x| f64::from(x) / f64::from(SIDE));
        [1.0 - u - v, u, v]
    });
    let weights: Vec<[f64; 3]> = weights.collect();
    let faces = (0..mesh.face_count() as u32).step_by(1 + mesh.face_count() / 1000);
    let grid: Vec<_> = faces
        .flat_map(|face| weights.iter().map(move |&at| (FaceId(face), at)))
        .collect();
    let (time, _) = one_thread(|| surface.at_all(&grid))?;
    row("points and normals on grids of 33 a side", &grid, time.all);
    Ok(())
}

fn closest(mesh: &Mesh, surface: &LimitSurface<'_>) -> Result<()> {
    let diagonal = mesh.diagonal();
    let (prepared, proximity) = one_thread(|| Proximity::new(surface))?;
    let proximity = proximity?;
    let (built, fine) = one_thread(|| limit_reference(mesh, &Loop, LEVELS))?;
    let fine = fine?;
    let (indexed, tree) = one_thread(|| Bvh::new(fine.as_triangles()))?;
    let tree = tree?;
    println!(
        "prepared in {:.2} s; the mesh of {} triangles in {:.2} s\n",
        prepared.all,
        fine.face_count(),
        built.all + indexed.all
    );
    println!("| points | µs each | to | µs each on the mesh | it differs by up to |");
    println!("|---|---:|---:|---:|---:|");
    let places = places(mesh);
    let on = surface.at_all(&places);
    for share in [0.0, 0.001, 0.01, 0.1] {
        let offsets = (0..).map(|i| share * diagonal * (2.0 * fraction(i, 0.569_840_290_99) - 1.0));
        let off = |(at, offset): (&limitmesh::SurfacePoint, f64)| {
            [0, 1, 2].map(|k| at.position[k] + offset * at.normal[k])
        };
        let points: Vec<[f64; 3]> = on.iter().zip(offsets).map(off).collect();
        let (time, found) = one_thread(|| proximity.closest(&points, 1e-6 * diagonal))?;
        let found = found?;
        let (by_mesh, peers) = one_thread(|| {
            points
                .iter()
                .map(|&point| tree.closest(point).distance)
                .collect::<Vec<_>>()
        })?;
        let gap = found
            .iter()
            .map(|at| at.distance - at.lower)
            .fold(0.0, f64::max);
        let mut apart = 0.0;
        for (own, peer) in found.iter().zip(peers) {
            apart = f64::max(apart, (own.distance - peer).abs());
        }
        let each = |seconds: f64| 1e6 * seconds / points.len() as f64;
        println!(
            "| up to {} % off | {:.1} | {:.1e} | {:.1} | {:.1e} |",
            100.0 * share,
            each(time.all),
            gap / diagonal,
            each(by_mesh.all),
            apart / diagonal
        );
    }
    Ok(())
}

/// Places scattered evenly over all faces, in their order.
fn places(mesh: &Mesh) -> Vec<(FaceId, [f64; 3])> {
    let place = |i: usize| {
        let face = (i * mesh.face_count() / COUNT) as u32;
        let [u, v] = [0.618_033_988_75, 0.754_877_666_25].map(|step| fraction(i, step));
        let [u, v] = if u + v > 1.0 {
            [1.0 - u, 1.0 - v]
        } else {
            [u, v]
        };
        (FaceId(face), [1.0 - u - v, u, v])
    };
    (0..COUNT).map(place).collect()
}

fn fraction(i: usize, step: f64) -> f64 {
    (0.5 + step * i as f64).fract()
}
