use core::sync::atomic::{AtomicUsize, Ordering};

use super::*;

/// Pools of these many threads; without the feature all do the same.
fn with_threads<R: Send>(threads: usize, run: impl FnOnce() -> R + Send) -> R {
    #[cfg(feature = "parallel")]
    return rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap()
        .install(run);
    #[cfg(not(feature = "parallel"))]
    {
        let _ = threads;
        run()
    }
}

/// Something whose value depends on every bit of the way to it, and whose work depends on the element.
fn work(i: usize) -> f64 {
    (0..i % 97).fold(i as f64, |x, _| (x * 1.000_1).sin())
}

#[test]
fn polled_loops_give_what_plain_ones_give_for_any_number_of_threads() {
    for n in [0, 1, 3, 4095, 4096, 50_000] {
        let plain = (0..n).map(work).collect::<Vec<f64>>();
        for threads in [1, 2, 5] {
            let (mapped, pieces, mut chunks) = (plain.clone(), plain.clone(), vec![0.0; n]);
            with_threads(threads, || {
                let go = &mut |_| Ok(());
                assert_eq!(map_polled(n, go, work).unwrap(), mapped);
                let summed = pieces_polled(n, 7, go, |range| range.map(work).collect::<Vec<f64>>());
                assert_eq!(summed.unwrap().concat(), pieces);
                for_each_chunk_polled(&mut chunks, 100, go, |i, chunk| {
                    chunk
                        .iter_mut()
                        .enumerate()
                        .for_each(|(j, slot)| *slot = work(100 * i + j));
                })
                .unwrap();
                assert_eq!(chunks, plain);
            });
        }
    }
}

/// Between two calls the calling thread does one block at most, and its count only grows.
#[test]
fn the_calling_thread_polls_after_each_of_its_blocks() {
    for threads in [1, 2, 4] {
        with_threads(threads, || {
            let caller = std::thread::current().id();
            let own = AtomicUsize::new(0);
            let (mut calls, mut last) = (0, 0);
            let poll = &mut |done: usize| {
                assert_eq!(std::thread::current().id(), caller);
                assert!(
                    own.swap(0, Ordering::Relaxed) <= 1,
                    "two blocks between two calls"
                );
                assert!(done >= last);
                (calls, last) = (calls + 1, done);
                Ok(())
            };
            pieces_polled(10_000, 10, poll, |range| {
                own.fetch_add(
                    usize::from(std::thread::current().id() == caller),
                    Ordering::Relaxed,
                );
                range.map(work).sum::<f64>()
            })
            .unwrap();
            assert!(calls > 0);
        });
    }
}

#[test]
fn a_cancelled_loop_begins_no_further_blocks() {
    for threads in [1, 2, 4] {
        for after in [1, 10] {
            let begun = AtomicUsize::new(0);
            let mut calls = 0;
            let result = with_threads(threads, || {
                let poll = &mut |_| {
                    calls += 1;
                    // Blocks that other threads have begun by now do not count.
                    if calls == after {
                        begun.store(0, Ordering::Relaxed);
                        return Err(Cancelled);
                    }
                    Ok(())
                };
                pieces_polled(1_000_000, 1, poll, |range| {
                    begun.fetch_add(1, Ordering::Relaxed);
                    range.map(|i| work(97 * i + 96)).sum::<f64>()
                })
            });
            assert_eq!(result, Err(Cancelled));
            assert_eq!(calls, after);
            // Each of the others may take a few blocks until it sees the flag; a machine under load
            // is slow to show it.
            assert!(begun.into_inner() < 100_000);
        }
    }
}

/// A long block that asks is polled for on the calling thread, and stopped on all.
#[test]
fn long_blocks_are_polled_for_and_stopped() {
    for threads in [1, 2, 4] {
        let mut calls = 0;
        let result = with_threads(threads, || {
            let poll = &mut |_| {
                calls += 1;
                if calls < 1000 { Ok(()) } else { Err(Cancelled) }
            };
            // Without being stopped no block would ever end.
            long_pieces_polled(threads, 1, poll, |_, is_stopped| while !is_stopped() {})
        });
        assert_eq!((result, calls), (Err(Cancelled), 1000));
    }
}

#[test]
fn what_is_sorted_in_parts_is_sorted() {
    for n in [0, 1, 40_000, 200_001] {
        let mut items: Vec<usize> = (0..n)
            .map(|i: usize| i.wrapping_mul(0x9E37_79B9_7F4A_7C15))
            .collect();
        let mut plain = items.clone();
        plain.sort_unstable();
        for threads in [1, 3] {
            with_threads(threads, || {
                sort_polled(&mut items, &mut |_| Ok(()), usize::cmp)
            })
            .unwrap();
            assert_eq!(items, plain);
            items.reverse();
        }
    }
}

/// The memory of several threads has the length, the capacity and the contents that one thread
/// gives.
#[test]
fn defaults_are_the_same_for_any_number_of_threads() {
    // This many are touched by several threads, one less is not.
    let many = (1usize << 18).div_ceil(size_of::<[u32; 3]>());
    for threads in [1, 3] {
        for (length, room) in [
            (0, 5),
            (many - 1, 0),
            (many, many),
            (9 * many + 7, 12 * many),
        ] {
            let array: Vec<[u32; 3]> = with_threads(threads, || defaults_with_room(length, room));
            assert_eq!(array, vec![[0; 3]; length], "{threads}");
            assert!(
                array.capacity() >= room.max(length),
                "{threads}: {}",
                array.capacity()
            );
        }
    }
}
