//! Schemes outside the Loop family: those that interpolate, those whose systems are general, singular or none.

use limitmesh::interpolate::InterpolationMethod;
use limitmesh::mesh::Tags;
use limitmesh::ring::{EdgeShape, RingShape, VertexKind};
use limitmesh::scheme::{EdgeMask, Loop, ModifiedButterfly, Scheme, Support, VertexMask};
use nalgebra::DVector;

use crate::interpolation::{dense, from_limits, interpolate, refinement_tends_to, tagged};
use crate::support::{Random, distance, lumpy, mapped, octahedron, sheet, torus};

#[test]
fn a_scheme_that_interpolates_changes_nothing() {
    let mesh = tagged(lumpy(20, 3), 4, false);
    let found = interpolate(&mesh, &ModifiedButterfly).unwrap();
    assert_eq!(
        (&found.mesh, found.method),
        (&mesh, InterpolationMethod::Unchanged)
    );
    assert_eq!(
        (found.residual, found.displacement, found.iterations),
        (0.0, 0.0, 0)
    );
}

/// Loop's edges, and vertices with another weight for their neighbours together.
struct Weighted {
    ring: f64,
}

impl Scheme for Weighted {
    fn name(&self) -> &str {
        "weighted"
    }
    fn support(&self) -> Support {
        Support::OneRing
    }
    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        if shape.kind() != VertexKind::Interior {
            return Loop.vertex_mask(shape);
        }
        let k = shape.valence as usize;
        VertexMask {
            centre: 1.0 - self.ring,
            ring: vec![self.ring / k as f64; k],
        }
    }
    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        Loop.edge_mask(shape)
    }
}

/// The butterfly's edges, and vertices that do not stay.
struct Drifting;

impl Scheme for Drifting {
    fn name(&self) -> &str {
        "drifting"
    }
    fn support(&self) -> Support {
        Support::TwoRing
    }
    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        let k = shape.valence as usize;
        match shape.kind() {
            VertexKind::Interior => VertexMask {
                centre: 0.9,
                ring: vec![0.1 / k as f64; k],
            },
            _ => ModifiedButterfly.vertex_mask(shape),
        }
    }
    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        ModifiedButterfly.edge_mask(shape)
    }
}

#[test]
fn other_schemes_are_solved_for_too() {
    for mesh in [lumpy(30, 2), sheet(6, 5, 3), torus(9, 6)] {
        for scheme in [&Weighted { ring: 0.3 } as &dyn Scheme, &Drifting] {
            let found = interpolate(&mesh, scheme).unwrap();
            assert_ne!(
                found.method,
                InterpolationMethod::LeastSquares,
                "{}",
                scheme.name()
            );
            assert!(found.displacement > 1e-3);
            assert!(
                from_limits(&found, scheme, &mesh) < 1e-12 * mesh.diagonal(),
                "{}",
                scheme.name()
            );
            refinement_tends_to(&mesh, &found.mesh, scheme, 3, 0.3);
        }
    }
}

/// Where all neighbours' weights are such that a pattern of three colours vanishes in the limit, no control points have any
/// limit with that pattern; the answer is that of least squares.
#[test]
fn what_has_no_solution_is_called_least_squares() {
    // w + 6u = 1 and w = 3u: the limit weights 1/3 and 1/9, where the neighbours together have c with 3/(8β) = 3, kβ = 3/4.
    let scheme = Weighted { ring: 0.75 };
    let mut random = Random::new(8);
    let mesh = torus(9, 6);
    let mesh = mapped(&mesh, |p| p.map(|x| x + 0.1 * random.signed()));
    let found = interpolate(&mesh, &scheme).unwrap();
    assert_eq!(found.method, InterpolationMethod::LeastSquares);
    let matrix = dense(&mesh, |k| 0.75 / k);
    let svd = matrix.clone().svd(true, true);
    assert!(svd.singular_values.min() < 1e-12);
    let axis = |axis: usize| {
        let away = DVector::from_iterator(
            mesh.vertex_count(),
            mesh.positions().iter().map(|p| p[axis]),
        );
        let right = &away - &matrix * &away;
        svd.solve(&right, 1e-9).unwrap()
    };
    let [x, y, z] = [axis(0), axis(1), axis(2)];
    for (v, (p, q)) in mesh
        .positions()
        .iter()
        .zip(found.mesh.positions())
        .enumerate()
    {
        let expected = [p[0] + x[v], p[1] + y[v], p[2] + z[v]];
        assert!(distance(*q, expected) < 1e-9, "{v}: {q:?} {expected:?}");
    }
    assert!((found.residual - from_limits(&found, &scheme, &mesh)).abs() < 1e-12);
    assert!(found.residual > 1e-3);
}

#[test]
fn what_has_no_limit_is_an_error() {
    struct Broken;
    impl Scheme for Broken {
        fn name(&self) -> &str {
            "broken"
        }
        fn support(&self) -> Support {
            Support::OneRing
        }
        fn vertex_mask(&self, shape: RingShape) -> VertexMask {
            VertexMask {
                centre: 2.0,
                ring: vec![0.0; shape.valence as usize],
            }
        }
        fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
            Loop.edge_mask(shape)
        }
    }
    let error = interpolate(&octahedron(), &Broken).unwrap_err();
    assert!(error.to_string().contains("broken"), "{error}");
    // A control point beyond the greatest number.
    let huge = octahedron()
        .positions()
        .iter()
        .map(|p| p.map(|x| x * 1.2e308))
        .collect();
    let huge = octahedron().with_positions(huge).unwrap();
    assert!(interpolate(&huge, &Loop).is_err());
    let corner = crate::support::corner(0, f64::INFINITY);
    let tags = Tags {
        corners: vec![corner],
        ..Tags::default()
    };
    assert!(interpolate(&octahedron().with_tags(tags).unwrap(), &Loop).is_ok());
}
