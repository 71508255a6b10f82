//! How long it takes to touch forty megabytes first and to give them back, on small pages and on large ones.

use std::time::Instant;

const BYTES: usize = 40 << 20;

fn main() {
    println!(
        "milliseconds for {} MB on small pages, on large ones",
        BYTES >> 20
    );
    for _ in 0..4 {
        let small = milliseconds(|| vec![1u8; BYTES]);
        println!(
            "{small:6.1} {:6.1}",
            milliseconds(|| limitmesh_pages::filled(1u8, BYTES))
        );
    }
}

fn milliseconds(make: impl Fn() -> Vec<u8>) -> f64 {
    let begin = Instant::now();
    drop(std::hint::black_box(make()));
    1e3 * begin.elapsed().as_secs_f64()
}
