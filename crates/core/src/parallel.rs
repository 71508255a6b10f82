//! Loops over elements that give the same bytes for any number of threads: every slot is computed from the
//! input alone and written by exactly one call; nothing is reduced across threads.

/// Below this many elements a loop stays on the calling thread: starting workers would cost more than the work.
#[cfg(feature = "parallel")]
const SEQUENTIAL_BELOW: usize = 4096;

/// `[f(0), f(1), …, f(n−1)]`.
pub(crate) fn map<T: Send, F: Fn(usize) -> T + Sync + Send>(n: usize, f: F) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if n >= SEQUENTIAL_BELOW && rayon::current_num_threads() > 1 {
            return (0..n).into_par_iter().with_min_len(SEQUENTIAL_BELOW / 4).map(f).collect();
        }
    }
    (0..n).map(f).collect()
}

/// Cuts `slots` into pieces of `piece` elements and calls `f(i, piece i)` for each.
pub(crate) fn for_each_chunk<T: Send, F: Fn(usize, &mut [T]) + Sync + Send>(
    slots: &mut [T],
    piece: usize,
    f: F,
) {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if slots.len() >= SEQUENTIAL_BELOW && rayon::current_num_threads() > 1 {
            slots
                .par_chunks_mut(piece)
                .with_min_len((SEQUENTIAL_BELOW / 4 / piece.max(1)).max(1))
                .enumerate()
                .for_each(|(i, chunk)| f(i, chunk));
            return;
        }
    }
    slots.chunks_mut(piece).enumerate().for_each(|(i, chunk)| f(i, chunk));
}
