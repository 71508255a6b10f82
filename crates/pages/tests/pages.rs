//! What vectors hold, and what the system says of the memory that they lie in.

use limitmesh_pages::{defaults, defaults_with_room, filled, reserve, with_capacity};

#[test]
fn vectors_hold_what_they_should() {
    for length in [0, 1, 1000, 1 << 19, (1 << 21) + 3] {
        let empty: Vec<[f64; 3]> = with_capacity(length);
        assert!(empty.is_empty() && empty.capacity() >= length);
        let same = filled([1u32, 2, 3], length);
        assert!(same.len() == length && same.iter().all(|&one| one == [1, 2, 3]));
        let zeros = defaults::<[f64; 3]>(length);
        assert!(zeros.len() == length && zeros.iter().all(|&one| one == [0.0; 3]));
        let more: Vec<u8> = defaults_with_room(length, 3 * length);
        assert!(
            more.capacity() >= 3 * length
                && more.len() == length
                && more.iter().all(|&one| one == 0)
        );
    }
    assert_eq!(with_capacity::<()>(usize::MAX).len(), 0);
    assert_eq!(filled((), 1 << 20).len(), 1 << 20);
}

/// What was there stays when it is asked for what is not.
#[test]
fn a_vector_that_grew_keeps_its_elements() {
    let mut numbers: Vec<u64> = (0..1 << 19).collect();
    reserve(&mut numbers, 1 << 19);
    assert!(numbers.capacity() >= 1 << 20);
    numbers.extend((1 << 19)..(1 << 20));
    assert!(numbers.iter().copied().eq(0..1 << 20));
}

/// The flag `hg` of the mapping that an address lies in, as the kernel lists it.
#[cfg(target_os = "linux")]
fn is_asked_for(address: usize) -> Option<bool> {
    let maps = std::fs::read_to_string("/proc/self/smaps").ok()?;
    let mut is_here = false;
    for line in maps.lines() {
        let bounds = line
            .split_whitespace()
            .next()
            .and_then(|range| range.split_once('-'));
        let parsed = |bound: &str| usize::from_str_radix(bound, 16).ok();
        if let Some((Some(start), Some(end))) =
            bounds.map(|(start, end)| (parsed(start), parsed(end)))
        {
            is_here = (start..end).contains(&address);
        }
        if is_here && let Some(flags) = line.strip_prefix("VmFlags:") {
            return Some(flags.split_whitespace().any(|flag| flag == "hg"));
        }
    }
    None
}

/// The kernel, asked about the middle of arrays.
#[cfg(target_os = "linux")]
#[test]
fn the_kernel_knows_what_was_asked_for() {
    if !std::path::Path::new("/sys/kernel/mm/transparent_hugepage/enabled").exists() {
        eprintln!("skipped: this kernel has no large pages for memory without a file");
        return;
    }
    let middle = |array: &[u8]| is_asked_for(array.as_ptr() as usize + array.len() / 2);
    for bytes in [1 << 23, 1 << 26] {
        assert_eq!(middle(&filled(7, bytes)), Some(true), "{bytes} bytes");
        assert_eq!(middle(&defaults(bytes)), Some(true), "{bytes} bytes");
    }
    // So much that it never lies where something else lay before.
    assert_eq!(middle(&vec![0u8; 1 << 26]), Some(false));
}
