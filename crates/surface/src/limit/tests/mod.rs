//! Tests of the analysis against closed forms, against the paper's own construction and against brute force.

mod brute_force;
mod closed_forms;
mod meshes;
mod paper;

use crate::limit::{LimitStencil, LimitTable};
use crate::ring::RingShape;
use crate::scheme::Scheme;

fn stencil(scheme: &dyn Scheme, shape: RingShape) -> LimitStencil {
    LimitTable::new(scheme)
        .stencil(shape)
        .unwrap()
        .as_ref()
        .clone()
}

fn assert_close(met: f64, expected: f64, tolerance: f64, place: &str) {
    assert!(
        (met - expected).abs() <= tolerance,
        "{place}: {met}, expected {expected}"
    );
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / length)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3)
        .map(|axis| (a[axis] - b[axis]).powi(2))
        .sum::<f64>()
        .sqrt()
}
