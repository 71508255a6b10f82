//! Loops over elements that give the same bytes for any number of threads: every slot is computed from the
//! input alone and written by exactly one call; sums are taken over pieces of fixed length, in order.

use core::ops::Range;

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

/// Number of elements that one piece of a sum or search covers: fixed, so that results do not depend on threads.
const PIECE: usize = 1 << 14;

/// Cuts `0..n` into pieces of fixed length and returns `f` of each, in order.
pub(crate) fn pieces<T: Send, F: Fn(Range<usize>) -> T + Sync + Send>(n: usize, f: F) -> Vec<T> {
    pieces_of(n, PIECE, f)
}

/// The same with pieces of `length` elements, for work that takes long at each.
pub(crate) fn pieces_of<T: Send, F: Fn(Range<usize>) -> T + Sync + Send>(
    n: usize,
    length: usize,
    f: F,
) -> Vec<T> {
    let range = |piece: usize| piece * length..((piece + 1) * length).min(n);
    let count = n.div_ceil(length);
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if count > 1 && rayon::current_num_threads() > 1 {
            return (0..count).into_par_iter().map(|piece| f(range(piece))).collect();
        }
    }
    (0..count).map(|piece| f(range(piece))).collect()
}

/// Cuts `0..n` into blocks of the given length and returns `f` of each, in order: for elements whose work is worth a
/// call of its own.
pub(crate) fn blocks<T: Send, F: Fn(Range<usize>) -> T + Sync + Send>(
    n: usize,
    length: usize,
    f: F,
) -> Vec<T> {
    let range = |block: usize| block * length..((block + 1) * length).min(n);
    let count = n.div_ceil(length);
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if count > 1 && rayon::current_num_threads() > 1 {
            return (0..count).into_par_iter().map(|block| f(range(block))).collect();
        }
    }
    (0..count).map(|block| f(range(block))).collect()
}

/// The least `i` below `n` for which `found(i)` holds.
pub(crate) fn first<F: Fn(usize) -> bool + Sync + Send>(n: usize, found: F) -> Option<usize> {
    pieces(n, |mut piece| piece.find(|&i| found(i))).into_iter().flatten().next()
}

/// `[0, c(0), c(0)+c(1), …]`: where each element's items start when element `i` has `c(i)` of them, and their
/// total as the last entry. `None` where the total does not fit.
pub(crate) fn starts<F: Fn(usize) -> u32 + Sync + Send>(n: usize, count: F) -> Option<Vec<u32>> {
    let totals = pieces(n, |piece| piece.map(|i| u64::from(count(i))).sum::<u64>());
    let mut before = Vec::with_capacity(totals.len());
    let mut total = 0u64;
    for piece_total in totals {
        before.push(total);
        total += piece_total;
    }
    let total = u32::try_from(total).ok()?;
    let mut starts = vec![0u32; n + 1];
    starts[n] = total;
    for_each_chunk(&mut starts[..n], PIECE, |piece, slots| {
        let mut running = before[piece] as u32;
        for (i, slot) in slots.iter_mut().enumerate() {
            *slot = running;
            running += count(piece * PIECE + i);
        }
    });
    Some(starts)
}

/// For elements that own consecutive runs of two arrays of items, `a[starts[i]..starts[i+1]]` and likewise in
/// `b`: calls `f(i, run of a, run of b)` for each element.
pub(crate) fn for_each_run<A: Send, B: Send, F: Fn(usize, &mut [A], &mut [B]) + Sync + Send>(
    starts: &[u32],
    a: &mut [A],
    b: &mut [B],
    f: F,
) {
    let n = starts.len().saturating_sub(1);
    let mut pieces = Vec::with_capacity(n.div_ceil(PIECE));
    let (mut rest_a, mut rest_b) = (a, b);
    let mut first = 0;
    while first < n {
        let last = (first + PIECE).min(n);
        let items = (starts[last] - starts[first]) as usize;
        let (head_a, tail_a) = rest_a.split_at_mut(items);
        let (head_b, tail_b) = rest_b.split_at_mut(items);
        pieces.push((first, last, head_a, head_b));
        (rest_a, rest_b) = (tail_a, tail_b);
        first = last;
    }
    let work = |(first, last, a, b): (usize, usize, &mut [A], &mut [B])| {
        let base = starts[first] as usize;
        for i in first..last {
            let run = starts[i] as usize - base..starts[i + 1] as usize - base;
            f(i, &mut a[run.clone()], &mut b[run]);
        }
    };
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if pieces.len() > 1 && rayon::current_num_threads() > 1 {
            pieces.into_par_iter().for_each(work);
            return;
        }
    }
    pieces.into_iter().for_each(work);
}
