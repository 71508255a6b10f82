//! Tests of the analysis against closed forms, against the paper's own construction and against brute force.

mod brute_force;
mod closed_forms;
mod meshes;
mod paper;

use crate::limit::{LimitStencil, LimitTable};
use crate::ring::RingShape;
use crate::scheme::Scheme;

/// Numbers in −1 … 1 that look random and are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        // Knuth's MMIX generator; its upper bits are the good ones.
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> [f64; 3] {
        [self.next(), self.next(), self.next()]
    }
}

fn stencil(scheme: &dyn Scheme, shape: RingShape) -> LimitStencil {
    LimitTable::new(scheme).stencil(shape).unwrap().as_ref().clone()
}

fn assert_close(met: f64, expected: f64, tolerance: f64, place: &str) {
    assert!((met - expected).abs() <= tolerance, "{place}: {met}, expected {expected}");
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / length)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
