//! Results by `limitmesh-check`, which shares nothing with the library: it confirms what is certified, and nothing below what was found.

use limitmesh::Mesh;
use limitmesh::refine::{Exact, Origin, exact};
use limitmesh::scheme::{Family, Loop, Scheme};
use limitmesh_check::mesh::Mesh as Plain;
use limitmesh_check::proof::Proof as Claim;
use limitmesh_check::tiling::Refusal;
use limitmesh_check::verdict;
use limitmesh_io::{Proof, ProofError};

use crate::support::{Random, cross, minus, surface, within};

fn plain(mesh: &Mesh) -> Plain {
    Plain {
        positions: mesh.positions().to_vec(),
        triangles: mesh.triangles().to_vec(),
    }
}

/// The triangles of a result that are refused at a length; none where there can be no proof.
pub(crate) fn refused(
    control: &Mesh,
    scheme: &dyn Scheme,
    result: &Exact,
    within: f64,
) -> Result<Option<Vec<Refusal>>, String> {
    // Triangles that came of collapses are over several control faces.
    let (Some(Family::Loop(scheme)), false) = (scheme.family(), result.is_collapsed()) else {
        return Ok(None);
    };
    let proof = Proof {
        control,
        holds_control: true,
        scheme,
        result: result.mesh.as_triangles(),
        origins: &result.origins,
        parents: &result.parents,
    };
    let bytes = match proof.to_bytes(within) {
        Err(ProofError::SeveralFaces(_)) => return Ok(None),
        bytes => bytes.map_err(|why| why.to_string())?,
    };
    let claim = Claim::read(&bytes)?;
    verdict::refused(&plain(control), &plain(&result.mesh), &claim, within).map(Some)
}

/// Confirmed at what is certified, or at some multiple, and refused below what was found; whether it is the former.
pub(crate) fn check(control: &Mesh, scheme: &dyn Scheme, result: &Exact) -> Result<bool, String> {
    let error = result.error;
    let size = control
        .positions()
        .as_flattened()
        .iter()
        .fold(0.0f64, |size, x| size.max(x.abs()));
    // The checker squares lengths, and says so where that goes beyond its numbers.
    if !(1e-60..1e60).contains(&size) {
        return Ok(false);
    }
    let below = 0.999 * error.lower;
    if below > 0.0
        && refused(control, scheme, result, below)?.is_some_and(|refused| refused.is_empty())
    {
        return Err(format!("confirmed at {below:e}, although {error:?}"));
    }
    // Bounds that a search has tightened are not proven by the triangles one by one, which may move
    // along the surface; in large meshes they do not.
    let mut within = error.upper;
    while let Some(refused) = refused(control, scheme, result, within)? {
        let [first, ..] = refused[..] else {
            return Ok(within == error.upper);
        };
        if within > 4.0 * size {
            return Err(format!("not confirmed at {within:e}, {error:?}: {first:?}"));
        }
        within *= 2.0;
    }
    Ok(false)
}

/// A result that somebody may have changed, with what its proof says of it.
#[derive(Clone)]
struct Changed {
    mesh: Plain,
    origins: Vec<Origin>,
    parents: Vec<u32>,
}

impl Changed {
    /// Whether it is refused, or there is no proof of it at all.
    fn is_refused(&self, control: &Mesh, within: f64) -> bool {
        let proof = Proof {
            control,
            holds_control: true,
            scheme: Loop,
            result: surface(&self.mesh.positions, &self.mesh.triangles),
            origins: &self.origins,
            parents: &self.parents,
        };
        let Ok(bytes) = proof.to_bytes(within) else {
            return true;
        };
        let claim = Claim::read(&bytes).unwrap();
        !verdict::refused(&plain(control), &self.mesh, &claim, within)
            .unwrap()
            .is_empty()
    }

    /// Moves a vertex along the normal of a triangle at it.
    fn moved(&mut self, t: usize, by: f64) {
        let [a, b, c] = self.mesh.triangles[t].map(|v| self.mesh.positions[v as usize]);
        let normal = cross(minus(b, a), minus(c, a));
        let share = by / normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        self.mesh.positions[self.mesh.triangles[t][0] as usize] =
            [0, 1, 2].map(|i| a[i] + share * normal[i]);
    }
}

#[test]
fn faults_are_refused() {
    type Fault = fn(&mut Changed, usize, f64);
    let faults: [(&str, Fault); 8] = [
        (
            "a vertex moved by 1.2 times the length",
            |result, t, within| result.moved(t, 1.2 * within),
        ),
        ("a vertex moved by twice the length", |result, t, within| {
            result.moved(t, 2.0 * within)
        }),
        ("a triangle removed", |result, t, _| {
            result.mesh.triangles.remove(t);
            result.parents.remove(t);
        }),
        ("a triangle twice", |result, t, _| {
            result.mesh.triangles.insert(t, result.mesh.triangles[t]);
            result.parents.insert(t, result.parents[t]);
        }),
        ("a triangle turned over", |result, t, _| {
            result.mesh.triangles[t].swap(0, 1)
        }),
        ("another parent", |result, t, _| {
            let other = result
                .parents
                .iter()
                .position(|&parent| parent != result.parents[t])
                .unwrap();
            result.parents[t] = result.parents[other];
        }),
        ("another place", |result, t, _| {
            let [a, b, _] = result.mesh.triangles[t];
            result.origins[a as usize] = result.origins[b as usize];
        }),
        (
            "a triangle over a vertex that is not its own",
            |result, t, _| {
                let [a, b, _] = result.mesh.triangles[t];
                let far = result
                    .mesh
                    .triangles
                    .iter()
                    .find(|triangle| !triangle.contains(&a) && !triangle.contains(&b));
                result.mesh.triangles[t][2] = far.unwrap()[2];
            },
        ),
    ];
    let mut random = Random::new(11);
    for name in ["cup", "bunny"] {
        let control = Mesh::from_soup(
            &limitmesh_models::find(name).unwrap().soup(),
            &Default::default(),
        )
        .unwrap()
        .0;
        let options = within(2e-3 * control.diagonal()).flat_regions(false);
        let found = exact(&control, &Loop, &options).unwrap();
        let within = found.error.upper;
        let result = Changed {
            mesh: plain(&found.mesh),
            origins: found.origins.clone(),
            parents: found.parents.clone(),
        };
        assert!(!result.is_refused(&control, within), "{name} as it is");
        assert!(
            result.is_refused(&control, 0.9 * within),
            "{name} at 0.9 of its length"
        );
        for _ in 0..6 {
            let t = random.below(result.parents.len());
            for (what, fault) in &faults {
                let mut changed = result.clone();
                fault(&mut changed, t, within);
                assert!(
                    changed.is_refused(&control, within),
                    "{name}: {what}, triangle {t}"
                );
            }
            // No fault: as near as is claimed.
            let mut near = result.clone();
            near.moved(t, 0.1 * within);
            assert!(
                !near.is_refused(&control, 1.2 * within),
                "{name}: triangle {t}"
            );
        }
    }
}
