//! Schemes that look like Loop's where one would try them, and are another elsewhere: no bound for Loop's scheme may be
//! reported for them as proven. Dense refinement by their own masks is the judge.

use limitmesh::measure::{SamplingOptions, hausdorff};
use limitmesh::refine::{UniformOptions, is_certified, uniform};
use limitmesh::ring::{EdgeShape, RingShape};
use limitmesh::scheme::{
    EdgeMask, Family, Loop, LoopFamily, LoopWarren, Scheme, Support, VertexMask,
};
use limitmesh::{Mesh, Triangles};

use crate::support::{divided, exact, octahedron, sheet, within};

/// Where a scheme departs from Loop's.
#[derive(Clone, Copy, Debug)]
enum Lie {
    /// Nowhere.
    None,
    /// Boundary vertices of one face keep their place.
    Ears,
    /// Vertices with four edges keep their place: the weight of their neighbours is 0.
    ValenceFour,
    /// Edges that end at a vertex inside without six edges have other weights.
    FarEnds,
}

struct Liar {
    lie: Lie,
    /// The member that it claims to be.
    says: Option<LoopFamily>,
}

impl Scheme for Liar {
    fn name(&self) -> &str {
        "liar"
    }

    fn support(&self) -> Support {
        Support::OneRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        let stays = match self.lie {
            Lie::None | Lie::FarEnds => false,
            Lie::Ears => shape == RingShape::boundary(2),
            Lie::ValenceFour => shape == RingShape::interior(4),
        };
        match stays {
            true => VertexMask {
                centre: 1.0,
                ring: vec![0.0; shape.valence as usize],
            },
            false => Loop.vertex_mask(shape),
        }
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        let mask = Loop.edge_mask(shape);
        let is_odd = |ring: RingShape| !ring.open && !ring.corner && ring.valence != 6;
        if !matches!(self.lie, Lie::FarEnds) || !(is_odd(shape.origin) || is_odd(shape.target)) {
            return mask;
        }
        // 1/4 everywhere instead of 3/8 and 1/8.
        let twice = |ring: Vec<f64>| ring.into_iter().map(|weight| 2.0 * weight).collect();
        EdgeMask {
            origin: 0.25,
            target: 0.25,
            origin_ring: twice(mask.origin_ring),
            ..mask
        }
    }

    fn family(&self) -> Option<Family> {
        self.says.map(Family::Loop)
    }
}

/// The greatest distance found between a mesh and what uniform refinement tends to.
fn by_brute_force(control: &Mesh, scheme: &dyn Scheme, mesh: Triangles<'_>) -> f64 {
    let fine = divided(control, scheme, 7);
    let samples = SamplingOptions::default().samples(50_000);
    hausdorff(mesh, fine.as_triangles(), &samples)
        .unwrap()
        .symmetric()
}

fn cases() -> [(Lie, Mesh); 4] {
    [
        (Lie::None, octahedron()),
        (Lie::Ears, sheet(2, 2, 5)),
        (Lie::ValenceFour, octahedron()),
        (Lie::FarEnds, octahedron()),
    ]
}

#[test]
fn what_is_called_proven_holds_for_schemes_that_lie() {
    for (lie, control) in cases() {
        let scheme = Liar { lie, says: None };
        let tolerance = 0.002 * control.diagonal();
        let result = exact(&control, &scheme, &within(tolerance)).unwrap();
        let found = by_brute_force(&control, &scheme, result.mesh.as_triangles());
        let error = result.error;
        // Seven levels of refinement are that far from the limit themselves.
        let holds = found <= error.upper + 0.1 * tolerance;
        assert!(
            holds || !error.certified,
            "{lie:?}: {found} where {error:?} is called proven"
        );
        assert_eq!(is_certified(&scheme), error.certified);
        // Estimates are not far off either, as long as a scheme keeps to its contract: far ends are not within one ring.
        let keeps = !matches!(lie, Lie::FarEnds);
        assert!(
            !keeps || found <= 1.3 * error.upper,
            "{lie:?}: {found} where about {error:?} was estimated"
        );
    }
}

#[test]
fn masks_alone_prove_nothing() {
    assert!(is_certified(&Loop));
    for (lie, _) in cases() {
        assert!(!is_certified(&Liar { lie, says: None }), "{lie:?}");
    }
}

/// Who says to be of the family gets its surface.
#[test]
fn masks_of_the_family_are_never_asked_for() {
    for family in [Loop, LoopWarren] {
        for (lie, control) in cases() {
            let scheme = Liar {
                lie,
                says: Some(family),
            };
            let options = within(0.002 * control.diagonal());
            let [found, expected] = [&scheme as &dyn Scheme, &family].map(|scheme| {
                let exact = exact(&control, scheme, &options).unwrap();
                let levels = UniformOptions::default().levels(2).limit(true);
                (
                    exact.mesh,
                    exact.normals,
                    exact.error,
                    uniform(&control, scheme, &levels).unwrap().mesh,
                )
            });
            assert!(found == expected && found.2.certified, "{lie:?}");
        }
    }
}
