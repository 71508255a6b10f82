//! Whether the parts of the triangles cover the control mesh, in exact integers.

use crate::mesh::{Control, Mesh, NONE, next};
use crate::proof::{Origins, Place, WHOLE};

/// A triangle, and why it is refused.
pub type Refusal = (u32, &'static str);

/// By half-edge of the result, the one that goes the other way; or what is wrong.
pub fn check(
    control: &Control,
    result: &Mesh,
    origins: &Origins,
) -> Result<Vec<u32>, Vec<Refusal>> {
    let triangles = &control.mesh.triangles;
    let (mut refused, mut areas) = (Vec::new(), vec![0i128; triangles.len()]);
    for (t, &parent) in (0..).zip(&origins.parents) {
        match part(result, origins, triangles, t) {
            Some([a, b, c]) if a == b || b == c || c == a => {
                refused.push((t, "has two corners in one place"))
            }
            Some(part) if area(part) < 0 => refused.push((t, "is turned over on the control mesh")),
            Some(part) => areas[parent as usize] += i128::from(area(part)),
            None => refused.push((t, "reaches beyond its face of the control mesh")),
        }
    }
    let is_covered: Vec<bool> = areas
        .iter()
        .map(|&area| area == i128::from(WHOLE * WHOLE))
        .collect();
    let over_others = (0..)
        .zip(&origins.parents)
        .filter(|&(_, &parent)| !is_covered[parent as usize]);
    refused.extend(over_others.map(|(t, _)| {
        (
            t,
            "is over a face of the control mesh that is not covered once",
        )
    }));
    if let (Some(face), []) = (
        is_covered.iter().position(|is_covered| !is_covered),
        &refused[..],
    ) {
        refused.push((face as u32, "of the control mesh has no triangle over it"));
    }
    let doubled = |h: u32| {
        vec![(
            h / 3,
            "has an edge in the same direction as another triangle",
        )]
    };
    let twins = result.twins().map_err(doubled)?;
    let is_torn = |&h: &u32| {
        let mut along = edges_along(result, origins, triangles, h);
        match twins[h as usize] {
            NONE => !along.any(|edge| control.twins[edge as usize] == NONE),
            twin => {
                along.next().is_none()
                    && origins.parents[h as usize / 3] != origins.parents[twin as usize / 3]
            }
        }
    };
    let torn = (0..twins.len() as u32).filter(is_torn);
    refused.extend(torn.map(|h| (h / 3, "does not go on where the control mesh goes on")));
    if refused.is_empty() {
        Ok(twins)
    } else {
        Err(refused)
    }
}

/// The weights of a triangle's corners in its parent.
pub fn part(
    result: &Mesh,
    origins: &Origins,
    triangles: &[[u32; 3]],
    t: u32,
) -> Option<[[i64; 2]; 3]> {
    let parent = origins.parents[t as usize];
    let [a, b, c] =
        result.triangles[t as usize].map(|v| origins.places[v as usize].within(triangles, parent));
    Some([a?, b?, c?])
}

/// Twice the area, zero where a part is a line; that of a face is `WHOLE²`.
fn area([a, b, c]: [[i64; 2]; 3]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The edges of the parent that a half-edge of the result is on.
fn edges_along(
    result: &Mesh,
    origins: &Origins,
    triangles: &[[u32; 3]],
    h: u32,
) -> impl Iterator<Item = u32> + use<> {
    let weights = part(result, origins, triangles, h / 3).map(|part| part.map(Place::weights));
    let parent = 3 * origins.parents[h as usize / 3];
    let is_without = move |corner: usize| {
        let ends = [h, next(h)].map(|h| h as usize % 3);
        weights.is_some_and(|weights| ends.iter().all(|&end| weights[end][corner] == 0))
    };
    // Where a corner has no weight is the edge that begins at the next one.
    (0..3)
        .filter(move |&corner| is_without(corner as usize))
        .map(move |corner| next(parent + corner))
}
