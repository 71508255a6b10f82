//! Loops over many vertices or triangles, by all threads: in pieces of a fixed length, so that results are the same for any
//! number of these.

use std::ops::Range;

use rayon::prelude::*;

/// How many of them a piece has.
const PIECE: usize = 1 << 13;

/// The results of `of` for each piece of so many elements, in their order.
pub(crate) fn pieces<T: Send>(
    count: usize,
    of: impl Fn(Range<usize>) -> T + Sync + Send,
) -> Vec<T> {
    let piece = |number: usize| of(number * PIECE..count.min((number + 1) * PIECE));
    (0..count.div_ceil(PIECE))
        .into_par_iter()
        .map(piece)
        .collect()
}
