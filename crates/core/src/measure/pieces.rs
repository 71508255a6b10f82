//! Long lists worked through in pieces of a fixed length, so that what is summed over a piece, and the sum of the
//! pieces in their order, are the same bytes for any number of threads.

use core::ops::Range;

/// `f` of each range of `size` elements out of `0..n`, in order.
pub(super) fn map_pieces<R: Send>(
    n: usize,
    size: usize,
    f: impl Fn(Range<usize>) -> R + Sync + Send,
) -> Vec<R> {
    let piece = |i: usize| f(i * size..((i + 1) * size).min(n));
    let count = n.div_ceil(size);
    #[cfg(feature = "parallel")]
    if count > 1 && rayon::current_num_threads() > 1 {
        use rayon::prelude::*;
        return (0..count).into_par_iter().map(piece).collect();
    }
    (0..count).map(piece).collect()
}
