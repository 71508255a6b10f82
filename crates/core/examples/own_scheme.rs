//! A scheme of one's own, given by its masks alone, has exact limit positions and normals.
//!
//! The scheme is Loop's with a tension: 0 keeps his vertex weights, 1 leaves old vertices where they are.

use std::error::Error;

use limitmesh::limit::LimitTable;
use limitmesh::refine::{UniformOptions, uniform};
use limitmesh::ring::{EdgeShape, RingShape};
use limitmesh::scheme::{EdgeMask, Loop, Scheme, Support, VertexMask};
use limitmesh::{Mesh, VertexId};

struct Tense {
    tension: f64,
}

impl Scheme for Tense {
    fn name(&self) -> &str {
        "tense"
    }

    fn support(&self) -> Support {
        Support::OneRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        let mut mask = Loop.vertex_mask(shape);
        mask.ring
            .iter_mut()
            .for_each(|weight| *weight *= 1.0 - self.tension);
        mask.centre = 1.0 - mask.ring.iter().sum::<f64>();
        mask
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        Loop.edge_mask(shape)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let soup = limitmesh_models::find("icosphere")
        .ok_or("no such built-in model")?
        .soup();
    let (mesh, _) = Mesh::from_soup(&soup, &Default::default())?;
    let vertex = VertexId(0);
    for tension in [0.0, 0.25, 0.5] {
        let scheme = Tense { tension };
        let limits = LimitTable::new(&scheme);
        let (position, normal) = (
            limits.position(&mesh, vertex)?,
            limits.normal(&mesh, vertex)?,
        );
        // Old vertices keep their numbers, so that six levels show where the vertex is going.
        let refined = uniform(&mesh, &scheme, &UniformOptions::default().levels(6))?.mesh;
        let six_levels_on = refined.positions()[vertex.index()];
        let gap: f64 = position
            .iter()
            .zip(six_levels_on)
            .map(|(a, b)| (a - b).powi(2))
            .sum();
        println!(
            "tension {tension}: limit {position:.6?}, normal {normal:.6?}, six levels on {:.1e} away",
            gap.sqrt()
        );
    }
    Ok(())
}
