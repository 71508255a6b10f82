//! A set of triangles that is emptied in no time, for floods that are mostly small and sometimes large.

/// Places at first: enough for the floods over a few triangles that are by far the most frequent.
const FIRST: usize = 64;

/// The set: open addressing, with stamps that separate this flood's entries from earlier ones'.
pub(super) struct Seen {
    entries: Vec<Entry>,
    stamp: u32,
    count: usize,
}

#[derive(Clone, Copy)]
struct Entry {
    face: u32,
    stamp: u32,
}

impl Seen {
    /// An empty set.
    pub(crate) fn new() -> Self {
        Self {
            entries: vec![Entry { face: 0, stamp: 0 }; FIRST],
            stamp: 1,
            count: 0,
        }
    }

    /// Empties it.
    pub(super) fn clear(&mut self) {
        self.count = 0;
        self.stamp = self.stamp.wrapping_add(1);
        if self.stamp == 0 {
            self.entries.fill(Entry { face: 0, stamp: 0 });
            self.stamp = 1;
        }
    }

    /// Whether the triangle is in the set.
    #[inline]
    pub(super) fn contains(&self, face: u32) -> bool {
        self.entries[self.place(face)].stamp == self.stamp
    }

    /// Adds a triangle.
    #[inline]
    pub(super) fn insert(&mut self, face: u32) {
        let place = self.place(face);
        if self.entries[place].stamp != self.stamp {
            self.entries[place] = Entry {
                face,
                stamp: self.stamp,
            };
            self.count += 1;
            if 2 * self.count > self.entries.len() {
                self.grow();
            }
        }
    }

    /// Where the triangle is, or where it would go.
    #[inline]
    fn place(&self, face: u32) -> usize {
        // Fibonacci hashing: neighbouring triangles spread over the table.
        let mask = self.entries.len() - 1;
        let mut place = (u64::from(face).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize & mask;
        while self.entries[place].stamp == self.stamp && self.entries[place].face != face {
            place = (place + 1) & mask;
        }
        place
    }

    fn grow(&mut self) {
        let larger = vec![Entry { face: 0, stamp: 0 }; 2 * self.entries.len()];
        let smaller = core::mem::replace(&mut self.entries, larger);
        for entry in smaller
            .into_iter()
            .filter(|entry| entry.stamp == self.stamp)
        {
            let place = self.place(entry.face);
            self.entries[place] = entry;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_what_was_put_in_since_it_was_emptied() {
        let mut seen = Seen::new();
        for round in 1..4 {
            seen.clear();
            for face in 0..1000 {
                assert!(!seen.contains(face * round));
                seen.insert(face * round);
                seen.insert(face * round);
            }
            assert_eq!(seen.count, 1000);
            assert!((0..1000).all(|face| seen.contains(face * round)));
            assert!(!seen.contains(1_000_000));
        }
    }
}
