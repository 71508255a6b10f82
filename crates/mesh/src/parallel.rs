//! Loops over elements that give the same bytes for any number of threads: every slot is computed from the
//! input alone and written by exactly one call; sums are taken over pieces of fixed length, in order.

use crate::error_messages;
use core::cell::RefCell;
use core::cmp::Ordering;
use core::ops::Range;
use core::sync::atomic::{AtomicBool, Ordering::Relaxed};
#[cfg(feature = "parallel")]
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Shares that few elements are cut into, and elements of which none has more.
const SHARES: usize = 48;
const MOST_IN_SHARE: usize = 256;

/// The number of elements that one call processes together where each may take long: few enough for
/// threads to end together.
pub fn share(elements: usize) -> usize {
    (elements / SHARES).clamp(1, MOST_IN_SHARE)
}

/// How many threads there are for such calls.
pub fn threads() -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "parallel"))]
    return 1;
}

/// Below this many elements a loop stays on the calling thread: starting workers would cost more than the work.
const SEQUENTIAL_BELOW: usize = 4096;

/// `[f(0), f(1), …, f(n−1)]`.
pub fn map<T: Send, F: Fn(usize) -> T + Sync + Send>(n: usize, f: F) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if n >= SEQUENTIAL_BELOW && rayon::current_num_threads() > 1 {
            return (0..n)
                .into_par_iter()
                .with_min_len(SEQUENTIAL_BELOW / 4)
                .map(f)
                .collect();
        }
    }
    (0..n).map(f).collect()
}

/// `count` default values, with room for more: like [`limitmesh_pages::defaults_with_room`], but
/// all threads touch the pages.
pub fn defaults_with_room<T: Clone + Default + Send + Sync>(
    length: usize,
    capacity: usize,
) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        let bytes = |elements: usize| size_of::<T>().saturating_mul(elements);
        let is_alone = bytes(capacity.max(length)) >= limitmesh_pages::ALONE;
        if !is_alone && bytes(length) >= TOUCHED && rayon::current_num_threads() > 1 {
            let mut array = limitmesh_pages::with_capacity(capacity.max(length));
            let values = rayon::iter::repeat_n(T::default(), length);
            array.par_extend(values.with_min_len(TOUCHED / 4 / size_of::<T>().max(1)));
            return array;
        }
    }
    limitmesh_pages::defaults_with_room(length, capacity)
}

/// Cuts `slots` into pieces of `piece` elements and calls `f(i, piece i)` for each.
pub fn for_each_chunk<T: Send, F: Fn(usize, &mut [T]) + Sync + Send>(
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
    slots
        .chunks_mut(piece)
        .enumerate()
        .for_each(|(i, chunk)| f(i, chunk));
}

/// The number of bytes from which several threads touch them.
#[cfg(feature = "parallel")]
const TOUCHED: usize = 1 << 18;

/// Elements that are sorted together where that can be cancelled.
const SORTED_AT_ONCE: usize = 1 << 15;

/// Number of elements that one piece of a sum or search covers: fixed, so that results do not depend on threads.
const PIECE: usize = 1 << 14;

/// Cuts `0..n` into pieces of fixed length and returns `f` of each, in order.
pub fn pieces<T: Send, F: Fn(Range<usize>) -> T + Sync + Send>(n: usize, f: F) -> Vec<T> {
    pieces_of(n, PIECE, f)
}

/// Pieces of `length` elements, for work that takes long at each.
pub fn pieces_of<T: Send, F: Fn(Range<usize>) -> T + Sync + Send>(
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
            return (0..count)
                .into_par_iter()
                .map(|piece| f(range(piece)))
                .collect();
        }
    }
    (0..count).map(|piece| f(range(piece))).collect()
}

/// The least `i` below `n` for which `found(i)` holds.
pub(crate) fn first<F: Fn(usize) -> bool + Sync + Send>(n: usize, found: F) -> Option<usize> {
    pieces(n, |mut piece| piece.find(|&i| found(i)))
        .into_iter()
        .flatten()
        .next()
}

/// `[0, c(0), c(0)+c(1), …]`: where each element's items start when element `i` has `c(i)` of them, and their
/// total as the last entry. `None` where the total does not fit.
pub fn starts<F: Fn(usize) -> u32 + Sync + Send>(
    n: usize,
    poll: &mut Poll<'_>,
    count: F,
) -> Result<Option<Vec<u32>>, Cancelled> {
    let totals = pieces_polled(n, PIECE, poll, |piece| {
        piece.map(|i| u64::from(count(i))).sum::<u64>()
    })?;
    let mut before = Vec::with_capacity(totals.len());
    let mut total = 0u64;
    for piece_total in totals {
        before.push(total);
        total += piece_total;
    }
    let Ok(total) = u32::try_from(total) else {
        return Ok(None);
    };
    let mut starts = limitmesh_pages::defaults::<u32>(n + 1);
    starts[n] = total;
    for_each_chunk_polled(&mut starts[..n], PIECE, poll, |piece, slots| {
        let mut running = before[piece] as u32;
        for (i, slot) in slots.iter_mut().enumerate() {
            *slot = running;
            running += count(piece * PIECE + i);
        }
    })?;
    Ok(Some(starts))
}

/// For elements that own consecutive runs of two arrays of items, `a[starts[i]..starts[i+1]]` and likewise in
/// `b`: calls `f(i, run of a, run of b)` for each element.
pub fn for_each_run<A: Send, B: Send, F: Fn(usize, &mut [A], &mut [B]) + Sync + Send>(
    starts: &[u32],
    a: &mut [A],
    b: &mut [B],
    poll: &mut Poll<'_>,
    f: F,
) -> Result<(), Cancelled> {
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
    hand_out(
        pieces.into_iter(),
        &mut |pieces| poll((pieces * PIECE).min(n)),
        |piece, _| work(piece),
    )?;
    Ok(())
}

/// The observer asked to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

error_messages! {
    Cancelled { Self => ("cancelled by the observer"), }
}

/// The callback of a loop that can be cancelled, between its blocks and always on the calling
/// thread, with the number of elements done by then.
pub type Poll<'a> = dyn FnMut(usize) -> Result<(), Cancelled> + 'a;

/// The question of blocks that may take longer than some milliseconds: whether their result is no
/// longer needed, so that they may end early. On the calling thread it polls.
pub type IsStopped<'a> = dyn Fn() -> bool + 'a;

/// Items of which each takes much less than a microsecond and that blocks take between two such questions.
const ASKED: usize = 1 << 12;

/// The items, with a check now and then whether they are still needed; the iterator ends where they
/// are not.
pub fn asking<I: IntoIterator>(
    items: I,
    is_stopped: &IsStopped<'_>,
) -> impl Iterator<Item = I::Item> {
    let mut taken = 0usize;
    items.into_iter().take_while(move |_| {
        taken += 1;
        !taken.is_multiple_of(ASKED) || !is_stopped()
    })
}

/// [`sort_polled`] of a block, which leaves the items as they may be where they are of no use any more.
pub fn sort_asking<T: Send + Sync + Ord>(items: &mut [T], is_stopped: &IsStopped<'_>) {
    let poll = &mut |_| if is_stopped() { Err(Cancelled) } else { Ok(()) };
    // The caller that stops handles that.
    let _ = sort_polled(items, poll, T::cmp);
}

/// [`pieces_polled`] for pieces that may take long.
pub fn long_pieces_polled<T: Send, F: Fn(Range<usize>, &IsStopped<'_>) -> T + Sync>(
    n: usize,
    length: usize,
    poll: &mut Poll<'_>,
    f: F,
) -> Result<Vec<T>, Cancelled> {
    let pieces = (0..n.div_ceil(length)).map(|piece| piece * length..((piece + 1) * length).min(n));
    hand_out(pieces, &mut |blocks| poll((blocks * length).min(n)), f)
}

/// [`each_polled`] for items that may take long.
pub fn each_long_polled<B: Send, T: Send, F: Fn(B, &IsStopped<'_>) -> T + Sync>(
    items: Vec<B>,
    poll: &mut Poll<'_>,
    f: F,
) -> Result<Vec<T>, Cancelled> {
    hand_out(items.into_iter(), poll, f)
}

/// [`pieces_of`] that can be cancelled; a piece should take a few milliseconds at most.
pub fn pieces_polled<T: Send, F: Fn(Range<usize>) -> T + Sync>(
    n: usize,
    length: usize,
    poll: &mut Poll<'_>,
    f: F,
) -> Result<Vec<T>, Cancelled> {
    long_pieces_polled(n, length, poll, |piece, _| f(piece))
}

/// [`for_each_chunk`] that can be cancelled; a piece should take a few milliseconds at most.
pub fn for_each_chunk_polled<T: Send, F: Fn(usize, &mut [T]) + Sync>(
    slots: &mut [T],
    piece: usize,
    poll: &mut Poll<'_>,
    f: F,
) -> Result<(), Cancelled> {
    let n = slots.len();
    let chunks = slots.chunks_mut(piece).enumerate();
    hand_out(
        chunks,
        &mut |blocks| poll((blocks * piece).min(n)),
        |(i, chunk), _| f(i, chunk),
    )?;
    Ok(())
}

/// `f` of each item, in order, that can be cancelled; it should take a few milliseconds at most.
pub fn each_polled<B: Send, T: Send, F: Fn(B) -> T + Sync>(
    items: Vec<B>,
    poll: &mut Poll<'_>,
    f: F,
) -> Result<Vec<T>, Cancelled> {
    hand_out(items.into_iter(), poll, |item, _| f(item))
}

/// Sorts by an order in which no two items are equal; can be cancelled, and then leaves them in any order.
pub fn sort_polled<T: Send + Sync>(
    items: &mut [T],
    poll: &mut Poll<'_>,
    order: impl Fn(&T, &T) -> Ordering + Sync,
) -> Result<(), Cancelled> {
    let mut parts = vec![items];
    while parts.iter().any(|part| part.len() > SORTED_AT_ONCE) {
        let halves = each_polled(parts, poll, |part| {
            let middle = part.len() / 2;
            if part.len() > SORTED_AT_ONCE {
                part.select_nth_unstable_by(middle, &order);
            }
            let (lower, upper) = part.split_at_mut(middle);
            [lower, upper]
        })?;
        parts = halves.into_iter().flatten().collect();
    }
    each_polled(parts, poll, |part| part.sort_unstable_by(&order))?;
    Ok(())
}

/// [`map`] that can be cancelled.
pub fn map_polled<T: Send + Clone + Default, F: Fn(usize) -> T + Sync>(
    n: usize,
    poll: &mut Poll<'_>,
    f: F,
) -> Result<Vec<T>, Cancelled> {
    map_chunks_polled(n, SEQUENTIAL_BELOW, poll, f)
}

/// [`map_polled`], `length` items at a time; these should take a few milliseconds at most.
pub(crate) fn map_chunks_polled<T: Send + Clone + Default, F: Fn(usize) -> T + Sync>(
    n: usize,
    length: usize,
    poll: &mut Poll<'_>,
    f: F,
) -> Result<Vec<T>, Cancelled> {
    let mut slots = limitmesh_pages::defaults::<T>(n);
    for_each_chunk_polled(&mut slots, length, poll, |chunk, slots| {
        (chunk * length..)
            .zip(slots)
            .for_each(|(i, slot)| *slot = f(i));
    })?;
    Ok(slots)
}

/// Runs `work` on every block and gives the results in order. `poll` is called after each block
/// that the calling thread does, with the number of blocks done, and while it waits for others, and
/// by blocks that request it; once it fails it is not called again and no further block is begun.
fn hand_out<
    B: Send,
    R: Send,
    I: ExactSizeIterator<Item = B> + Send,
    F: Fn(B, &IsStopped<'_>) -> R + Sync,
>(
    blocks: I,
    poll: &mut Poll<'_>,
    work: F,
) -> Result<Vec<R>, Cancelled> {
    #[cfg(feature = "parallel")]
    {
        let threads = rayon::current_num_threads().min(blocks.len());
        if threads > 1 {
            return Blocks::new(blocks).run(threads, poll, &work);
        }
    }
    let mut results = Vec::with_capacity(blocks.len());
    let is_cancelled = AtomicBool::new(false);
    for block in blocks {
        let result = led(block, results.len(), poll, &is_cancelled, &work)?;
        results.push(result);
        poll(results.len())?;
    }
    Ok(results)
}

/// One block on the calling thread, with `done` before it.
fn led<B, R>(
    block: B,
    done: usize,
    poll: &mut Poll<'_>,
    is_cancelled: &AtomicBool,
    work: &impl Fn(B, &IsStopped<'_>) -> R,
) -> Result<R, Cancelled> {
    let poll = RefCell::new(poll);
    let result = work(block, &|| {
        if !is_cancelled.load(Relaxed) && (poll.borrow_mut())(done).is_err() {
            is_cancelled.store(true, Relaxed);
        }
        is_cancelled.load(Relaxed)
    });
    if is_cancelled.load(Relaxed) {
        Err(Cancelled)
    } else {
        Ok(result)
    }
}

/// Blocks that several threads take one after the other, the calling one among them.
#[cfg(feature = "parallel")]
struct Blocks<I, R> {
    state: Mutex<BlocksState<I, R>>,
    /// Notified when a thread has ended.
    ended: Condvar,
    is_cancelled: AtomicBool,
}

#[cfg(feature = "parallel")]
struct BlocksState<I, R> {
    /// Blocks that no thread has begun.
    left: core::iter::Enumerate<I>,
    /// Results by number of block, in the order of completion.
    results: Vec<(usize, R)>,
    /// Working threads, without the calling one.
    working: usize,
}

/// How long the calling thread waits for the others between two calls of the observer.
#[cfg(feature = "parallel")]
const WAIT: core::time::Duration = core::time::Duration::from_millis(20);

#[cfg(feature = "parallel")]
impl<B: Send, R: Send, I: ExactSizeIterator<Item = B> + Send> Blocks<I, R> {
    fn new(blocks: I) -> Self {
        let results = Vec::with_capacity(blocks.len());
        let state = BlocksState {
            left: blocks.enumerate(),
            results,
            working: 0,
        };
        Self {
            state: Mutex::new(state),
            ended: Condvar::new(),
            is_cancelled: AtomicBool::new(false),
        }
    }

    fn run(
        self,
        threads: usize,
        poll: &mut Poll<'_>,
        work: &(impl Fn(B, &IsStopped<'_>) -> R + Sync),
    ) -> Result<Vec<R>, Cancelled> {
        rayon::in_place_scope(|scope| {
            for _ in 1..threads {
                scope.spawn(|_| self.help(work));
            }
            let result = self.lead(poll, work);
            self.is_cancelled.fetch_or(result.is_err(), Relaxed);
            result
        })?;
        let state = self
            .state
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        let mut results = state.results;
        results.sort_unstable_by_key(|&(number, _)| number);
        Ok(results.into_iter().map(|(_, result)| result).collect())
    }

    fn lock(&self) -> MutexGuard<'_, BlocksState<I, R>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The calling thread: works as long as there are blocks, then waits for the others.
    fn lead(
        &self,
        poll: &mut Poll<'_>,
        work: &impl Fn(B, &IsStopped<'_>) -> R,
    ) -> Result<(), Cancelled> {
        loop {
            let (next, done) = {
                let mut state = self.lock();
                (state.left.next(), state.results.len())
            };
            let Some((number, block)) = next else { break };
            let result = led(block, done, poll, &self.is_cancelled, work)?;
            let done = self.lock().put(number, result);
            poll(done)?;
        }
        let mut state = self.lock();
        while state.working > 0 {
            let waited = self.ended.wait_timeout(state, WAIT);
            let done = waited
                .unwrap_or_else(PoisonError::into_inner)
                .0
                .results
                .len();
            poll(done)?;
            state = self.lock();
        }
        Ok(())
    }

    /// Another thread: works until nothing is left.
    fn help(&self, work: &impl Fn(B, &IsStopped<'_>) -> R) {
        self.lock().working += 1;
        let _ended = Ended(self);
        let is_stopped = || self.is_cancelled.load(Relaxed);
        while !is_stopped() {
            let Some((number, block)) = self.lock().left.next() else {
                return;
            };
            let result = work(block, &is_stopped);
            self.lock().put(number, result);
        }
    }
}

#[cfg(feature = "parallel")]
impl<I, R> BlocksState<I, R> {
    /// Takes a result in; says how many there are.
    fn put(&mut self, number: usize, result: R) -> usize {
        self.results.push((number, result));
        self.results.len()
    }
}

/// Reports that a thread has ended, also where its work panicked, so that no thread waits for it
/// for ever.
#[cfg(feature = "parallel")]
struct Ended<'b, B: Send, R: Send, I: ExactSizeIterator<Item = B> + Send>(&'b Blocks<I, R>);

#[cfg(feature = "parallel")]
impl<B: Send, R: Send, I: ExactSizeIterator<Item = B> + Send> Drop for Ended<'_, B, R, I> {
    fn drop(&mut self) {
        self.0.lock().working -= 1;
        self.0.ended.notify_one();
    }
}

#[cfg(test)]
mod tests;
