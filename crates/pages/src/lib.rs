//! Vectors of many megabytes on large pages.
//!
//! The system hands out memory in pages of some kilobytes, and each takes a microsecond or two when it is touched first: for a
//! mesh of a million triangles that is longer than it takes to compute some of its arrays. Linux has pages of two megabytes,
//! too, which come several times faster by the byte, but on most systems gives them only to who asks
//! (`/sys/kernel/mm/transparent_hugepage/enabled` says `madvise`). Functions of this crate ask. Elsewhere, and where there are no
//! such pages, they give the same vectors on small ones.

/// Arrays of fewer bytes are as they would be without this crate: they may not hold a large page wherever they begin.
const LEAST: usize = 1 << 22;

/// From this number of bytes on allocators take memory from the system for an array alone (`M_MMAP_THRESHOLD` of the GNU C library is
/// never greater), which is zero already and need not be touched.
pub const ALONE: usize = 1 << 25;

/// An empty vector with room for at least `capacity` elements, on large pages where they take megabytes.
///
/// ```
/// let mut numbers: Vec<u64> = limitmesh_pages::with_capacity(1 << 20);
/// numbers.extend(0..1 << 20);
/// assert_eq!(numbers.len(), 1 << 20);
/// ```
///
/// # Panics
/// Like [`Vec::with_capacity`], if that would take more than `isize::MAX` bytes.
pub fn with_capacity<T>(capacity: usize) -> Vec<T> {
    let mut array = Vec::with_capacity(capacity);
    ask(&mut array);
    array
}

/// A vector of `length` times the same value, on large pages where it takes megabytes.
///
/// ```
/// assert_eq!(limitmesh_pages::filled(7u8, 2), [7, 7]);
/// ```
///
/// # Panics
/// Like [`Vec::with_capacity`], if that would take more than `isize::MAX` bytes.
pub fn filled<T: Clone>(value: T, length: usize) -> Vec<T> {
    let mut array = with_capacity(length);
    array.resize(length, value);
    array
}

/// A vector of `length` default values, on large pages where it takes megabytes. Many zeros are not even touched: who writes them first
/// does that.
///
/// ```
/// assert_eq!(limitmesh_pages::defaults::<[u32; 3]>(2), [[0, 0, 0], [0, 0, 0]]);
/// ```
///
/// # Panics
/// Like [`Vec::with_capacity`], if that would take more than `isize::MAX` bytes.
pub fn defaults<T: Clone + Default>(length: usize) -> Vec<T> {
    defaults_with_room(length, length)
}

/// Like [`defaults`], but zeros are left to the allocator whatever their number: fresh memory is not touched, and memory that is used
/// again is cleared first and stays on the pages that it has.
///
/// ```
/// assert_eq!(limitmesh_pages::untouched_defaults::<u8>(3), [0, 0, 0]);
/// ```
///
/// # Panics
/// Like [`Vec::with_capacity`], if that would take more than `isize::MAX` bytes.
pub fn untouched_defaults<T: Clone + Default>(length: usize) -> Vec<T> {
    let mut array = vec![T::default(); length];
    ask(&mut array);
    array
}

/// Like [`defaults`], with room for at least `capacity` elements if that is more than `length`.
///
/// ```
/// let array: Vec<u32> = limitmesh_pages::defaults_with_room(2, 4);
/// assert!(array == [0, 0] && array.capacity() >= 4);
/// ```
///
/// # Panics
/// Like [`Vec::with_capacity`], if that would take more than `isize::MAX` bytes.
pub fn defaults_with_room<T: Clone + Default>(length: usize, capacity: usize) -> Vec<T> {
    let room = capacity.max(length);
    if size_of::<T>().saturating_mul(room) >= ALONE {
        let mut array = untouched_defaults(room);
        array.truncate(length);
        return array;
    }
    let mut array = with_capacity(room);
    array.resize(length, T::default());
    array
}

/// Makes room for at least `additional` more elements, on large pages where all together take megabytes.
///
/// ```
/// let mut numbers = vec![1, 2];
/// limitmesh_pages::reserve(&mut numbers, 10);
/// assert!(numbers == [1, 2] && numbers.capacity() >= 12);
/// ```
///
/// # Panics
/// Like [`Vec::reserve_exact`], if that would take more than `isize::MAX` bytes.
pub fn reserve<T>(array: &mut Vec<T>, additional: usize) {
    let length = array.len();
    if additional > array.capacity() - length {
        array.reserve_exact(additional);
        ask(array);
    }
}

/// Asks for large pages for what is not touched yet of a vector.
fn ask<T>(array: &mut Vec<T>) {
    let bytes = size_of::<T>() * array.capacity();
    if bytes >= LEAST {
        system::ask(array.as_mut_ptr().cast(), bytes);
    }
}

#[cfg(any(target_os = "linux", target_os = "android"))]
mod system {
    /// The largest small page of 64-bit processors that Linux commonly runs on; where pages are larger the advice is refused.
    const PAGE: usize = 1 << 16;

    /// Asks for large pages for `bytes` bytes from `start` on, less what does not fill a small page.
    pub(super) fn ask(start: *mut u8, bytes: usize) {
        let before = start.align_offset(PAGE);
        let whole = bytes.saturating_sub(before) / PAGE * PAGE;
        // An answer that there are none changes nothing.
        #[expect(
            unsafe_code,
            reason = "advice on how pages of the vector are mapped, which changes nothing of what they hold"
        )]
        let _ = unsafe {
            libc::madvise(
                start.wrapping_add(before).cast(),
                whole,
                libc::MADV_HUGEPAGE,
            )
        };
    }
}

#[cfg(not(any(target_os = "linux", target_os = "android")))]
mod system {
    pub(super) fn ask(_: *mut u8, _: usize) {}
}
