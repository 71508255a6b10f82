//! Loops over tiles and vertices that give the same bytes for any number of threads: every slot is computed
//! from the input alone by exactly one call.

/// `[f(scratch, 0), …, f(scratch, n−1)]` in order; `scratch` is made by `init` as often as needed and must not
/// carry anything from one call to the next.
pub(crate) fn map_with<S, T: Send>(
    n: usize,
    init: impl Fn() -> S + Sync + Send,
    f: impl Fn(&mut S, usize) -> T + Sync + Send,
) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if n > 1 && rayon::current_num_threads() > 1 {
            return (0..n).into_par_iter().map_init(init, f).collect();
        }
    }
    let mut scratch = init();
    (0..n).map(|i| f(&mut scratch, i)).collect()
}

/// Elements a worker takes at once in [`map`]: enough that handing them out costs nothing.
#[cfg(feature = "parallel")]
const PIECE: usize = 8192;

/// `[f(0), …, f(n−1)]`.
pub(crate) fn map<T: Send>(n: usize, f: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        if n > PIECE && rayon::current_num_threads() > 1 {
            return (0..n).into_par_iter().with_min_len(PIECE).map(f).collect();
        }
    }
    (0..n).map(f).collect()
}
