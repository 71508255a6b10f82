//! Angles: a viewer never costs triangles, and where no division closes a cone refinement ends and says so.

#![allow(clippy::unwrap_used, missing_docs)]

use core::ops::ControlFlow;
use limitmesh::criterion::{View, Viewpoint};

use limitmesh::progress::{Progress, Stage};
use limitmesh::refine::{Exact, ExactOptions, ExactStop, Frame, exact_frames, exact_observed};

use crate::support::{exact, model, shared_model, shared_models};
use limitmesh::scheme::Loop;
use limitmesh::{FaceId, HalfEdgeId};

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The unit normal of each triangle and its greatest angle to the limit normals of its corners.
fn angles(result: &Exact) -> Vec<([f64; 3], f64)> {
    let of_face = |face: usize| {
        let face = FaceId(face as u32);
        let normal = result.mesh.face_normal(face);
        let normal = normal.map(|x| x / dot(normal, normal).sqrt());
        let corners = (0..3).map(|corner| result.corner_normal(HalfEdgeId::of(face, corner)));
        let cosine = corners
            .map(|corner| dot(corner, normal))
            .fold(1.0, f64::min);
        (normal, cosine.max(-1.0).acos())
    };
    (0..result.mesh.face_count()).map(of_face).collect()
}

#[test]
fn a_view_never_costs_triangles() {
    let angle = 10f64.to_radians();
    for name in ["cup", "sphere", "sheet"] {
        let control = model(name);
        let plain = exact(&control, &Loop, &ExactOptions::default().angle(angle)).unwrap();
        assert_eq!(
            (plain.stop, plain.statistics.open_cones),
            (ExactStop::Met, 0),
            "{name}"
        );
        let viewpoints = [
            Viewpoint::Direction([0.0, 0.0, -1.0]),
            Viewpoint::Direction([1.0, 2.0, 0.5]),
            Viewpoint::Eye([3.0, 0.4, 2.0]),
            Viewpoint::Eye([0.3, 1.2, 0.1]),
        ];
        for viewpoint in viewpoints {
            let mut fewest = plain.mesh.face_count();
            for dilatation in [0.0, 1.0, 4.0] {
                let view = View {
                    viewpoint,
                    dilatation,
                };
                let options = ExactOptions::default().angle_seen(angle, view);
                let seen = exact(&control, &Loop, &options).unwrap();
                assert_eq!(seen.stop, ExactStop::Met, "{name}, {view:?}");
                let count = seen.mesh.face_count();
                at_most!(count, fewest, "{name}, {view:?}");
                fewest = count;
                // Equation (11) by hand, where the angle leaves room.
                for (face, (normal, found)) in angles(&seen).into_iter().enumerate() {
                    let [a, b, c] = seen.mesh.as_triangles().corners(face);
                    let sight = match viewpoint {
                        Viewpoint::Direction(sight) => sight,
                        Viewpoint::Eye(eye) => {
                            [0, 1, 2].map(|i| (a[i] + b[i] + c[i]) / 3.0 - eye[i])
                        }
                    };
                    let facing = -dot(sight, normal) / dot(sight, sight).sqrt();
                    let limit = angle * (dilatation * facing).max(1.0);
                    assert!(
                        facing < 0.0 || found <= limit * (1.0 + 1e-6),
                        "{name}, {view:?}: {found} of {limit}"
                    );
                }
            }
            assert!(fewest < plain.mesh.face_count(), "{name}, {viewpoint:?}");
        }
    }
}

/// The head's mouth has corners, inside regular faces, around which the surface has no tangent plane.
#[test]
fn an_angle_alone_ends_where_no_cone_closes() {
    let control = model("head");
    for degrees in [40.0f64, 15.0] {
        let angle = degrees.to_radians();
        let result = exact(&control, &Loop, &ExactOptions::default().angle(angle)).unwrap();
        result.mesh.validate().unwrap();
        assert_eq!(result.stop, ExactStop::Cones);
        at_most!(result.statistics.worst, 1.0);
        at_most!(result.statistics.levels, 13);
        let open: Vec<usize> = angles(&result)
            .into_iter()
            .enumerate()
            .filter(|(_, (_, found))| *found > angle * (1.0 + 1e-6))
            .map(|(face, _)| face)
            .collect();
        assert_eq!(open.len(), result.statistics.open_cones);
        assert!(!open.is_empty());
        below!(open.len(), result.mesh.face_count() / 20);
        // They are small, and stand together in a few places.
        let mut places: Vec<[f64; 3]> = Vec::new();
        for face in open {
            let at = result.mesh.as_triangles().corners(face);
            for i in 0..3 {
                let edge = [0, 1, 2].map(|axis| at[i][axis] - at[(i + 1) % 3][axis]);
                assert!(dot(edge, edge).sqrt() < 1e-3 * angle * control.diagonal());
            }
            let apart = |p: &[f64; 3]| (0..3).any(|i| (p[i] - at[0][i]).abs() > 0.01);
            if places.iter().all(apart) {
                places.push(at[0]);
            }
        }
        assert!(places.len() <= 4, "{places:?}");
    }
}

/// With a tolerance, the end of the cone's goal does not end the tolerance's.
#[test]
fn a_tolerance_is_kept_where_cones_stay_open() {
    let control = model("head");
    let tolerance = 1e-4 * control.diagonal();
    let options = ExactOptions::default()
        .angle(30f64.to_radians())
        .tolerance(tolerance);
    let result = exact(&control, &Loop, &options).unwrap();
    at_most!(result.error.upper, tolerance);
    assert_eq!(result.stop, ExactStop::Cones);
}

/// By hand in every frame, whichever comes first: triangles are within the angle, or reported as
/// open, as many as in the worst frame.
#[test]
fn angles_hold_in_every_frame() {
    for (name, degrees, expected) in [
        ("cup", 15.0f64, ExactStop::Met),
        ("head", 40.0, ExactStop::Cones),
    ] {
        let (control, angle) = (model(name), degrees.to_radians());
        let positions = control.positions().to_vec();
        let stretched: Vec<[f64; 3]> = positions
            .iter()
            .map(|&[x, y, z]| [x, 1.7 * y, 0.8 * z])
            .collect();
        for frames in [
            [positions.clone(), stretched.clone()],
            [stretched, positions],
        ] {
            let options = ExactOptions::default().angle(angle);
            let found = exact_frames(&control, &Loop, &frames, &options).unwrap();
            let mut frame = Frame::default();
            let open = frames.iter().map(|positions| {
                found.replay.frame(positions, &mut frame).unwrap();
                let shown = found.refined.clone().moved_to(&frame).unwrap();
                angles(&shown)
                    .iter()
                    .filter(|(_, found)| *found > angle * (1.0 + 1e-6))
                    .count()
            });
            assert_eq!(
                found.refined.statistics.open_cones,
                open.max().unwrap(),
                "{name}"
            );
            assert_eq!(found.refined.stop, expected, "{name}");
            assert!(
                (found.refined.statistics.open_cones > 0) == (expected == ExactStop::Cones),
                "{name}"
            );
            assert_eq!(found.refined.pixels, None);
        }
    }
}

/// Where the surface folds, each layer of split leaves has the next one split: that takes one round, not hundreds.
#[test]
fn folds_take_few_rounds() {
    let Some(folder) = shared_models() else {
        return;
    };
    let control = shared_model(&folder, "rook_creased.obj");
    let plain = ExactOptions::default().angle(1.0);
    let view = View {
        viewpoint: Viewpoint::Direction([1.0, 0.0, 0.0]),
        dilatation: 1.0,
    };
    for options in [plain, ExactOptions::default().angle_seen(1.0, view)] {
        let mut rounds = 0;
        let mut observer = |at: &Progress| {
            rounds = match at.stage {
                Stage::Refining => rounds.max(at.done),
                _ => rounds,
            };
            ControlFlow::Continue(())
        };
        let found = exact_observed(&control, &Loop, &options, &mut observer).unwrap();
        assert_eq!(found.stop, ExactStop::Cones);
        at_most!(rounds, 30);
    }
}
