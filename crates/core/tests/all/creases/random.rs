//! The invariants for any mesh with any tags.

use limitmesh::Mesh;
use limitmesh::limit::LimitTable;
use limitmesh::mesh::{INFINITELY_SHARP, Sharpness};
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use proptest::prelude::*;

use crate::creases::plain::randomly_tagged;
use crate::support::*;

fn any_mesh() -> impl Strategy<Value = Mesh> {
    let shape = prop_oneof![
        (0..30usize, any::<u64>()).prop_map(|(splits, seed)| lumpy(splits, seed)),
        (1..5u32, 1..5u32, any::<u64>()).prop_map(|(m, n, seed)| sheet(m, n, seed)),
    ];
    (shape, 1..8usize, any::<u64>())
        .prop_map(|(mesh, one_in, seed)| randomly_tagged(mesh, one_in, seed))
}

const SCHEMES: [&dyn Scheme; 3] = [&Loop, &LoopWarren, &ModifiedButterfly];

fn refined(mesh: &Mesh, scheme: &dyn Scheme) -> Mesh {
    divided(mesh, scheme, 2)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn refinement_is_conforming_and_finite(mesh in any_mesh(), scheme in 0..3usize) {
        let fine = refined(&mesh, SCHEMES[scheme]);
        fine.validate().unwrap();
        prop_assert_eq!(fine.face_count(), 16 * mesh.face_count());
        prop_assert_eq!(fine.topology().boundary_edge_count(), 4 * mesh.topology().boundary_edge_count());
    }

    #[test]
    fn the_limit_does_not_change_by_refining(mesh in any_mesh(), scheme in 0..3usize) {
        let table = LimitTable::new(SCHEMES[scheme]);
        let fine = divided(&mesh, SCHEMES[scheme], 1);
        let (before, after) = (table.positions(&mesh).unwrap(), table.positions(&fine).unwrap());
        for (v, (a, b)) in before.iter().zip(&after).enumerate() {
            prop_assert!(distance(*a, *b) < 1e-12, "vertex {}: {:?} and {:?}", v, a, b);
        }
    }

    #[test]
    fn crease_curves_depend_on_their_points_alone(mesh in any_mesh(), scheme in 0..3usize, seed in any::<u64>()) {
        // An infinitely sharp curve does not change when all other vertices are moved.
        let sharpness = Sharpness::of(&mesh);
        let topology = mesh.topology();
        let is_fixed = |v| {
            let fades = sharpness.spokes(v).chain([sharpness.vertex(v)]).any(|s| s > 0.0 && s < INFINITELY_SHARP);
            let edges = sharpness.spokes(v).filter(|&s| s > 0.0).count();
            !fades && (edges >= 2 || sharpness.vertex(v) > 0.0)
        };
        let mut random = Random::new(seed);
        let positions = topology.vertices().zip(mesh.positions()).map(|(v, p)| {
            if sharpness.spokes(v).any(|s| s > 0.0) || sharpness.vertex(v) > 0.0 {
                *p
            } else {
                p.map(|x| x + random.signed())
            }
        });
        let moved = mesh.clone().with_positions(positions.collect()).unwrap();
        let table = LimitTable::new(SCHEMES[scheme]);
        let (here, there) = (table.positions(&mesh).unwrap(), table.positions(&moved).unwrap());
        for v in topology.vertices().filter(|&v| is_fixed(v)) {
            prop_assert!(distance(here[v.index()], there[v.index()]) < 1e-14, "{} moved", v);
        }
    }
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let mesh = randomly_tagged(sheet(40, 30, 9), 6, 4);
    for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
        let run = |threads: usize| {
            let pool = pool(threads);
            pool.install(|| {
                let fine = refined(&mesh, scheme);
                let table = LimitTable::new(scheme);
                (
                    table.positions(&fine).unwrap(),
                    table.sided_normals(&fine).unwrap(),
                    fine,
                )
            })
        };
        assert!(run(1) == run(3));
    }
}
