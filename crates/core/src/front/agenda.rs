//! The nodes to test again when a demand changes: entries in buckets by a key; entries of removed
//! nodes are dropped on the way.

/// A node that is due at a key.
#[derive(Clone, Copy, Debug)]
struct Entry {
    key: f64,
    node: u32,
    stamp: u32,
}

/// How keys become buckets.
#[derive(Clone, Copy, Debug)]
enum Scale {
    /// Keys from 0 on, by their logarithms: 2⁸ buckets an octave.
    Logarithmic { exponent: u64 },
    /// Keys that only ever grow, as the hand of a clock: a ring of buckets so wide each.
    Turning { width: f64 },
}

/// Buckets of a ladder, which are 64 octaves, and of a ring.
const STEPS: usize = 1 << 14;
const RING: usize = 1 << 12;

/// Bits of a number's fraction that distinguish buckets.
const FRACTION: u32 = 8;

/// Nodes by key.
#[derive(Debug)]
pub(super) struct Agenda {
    scale: Scale,
    buckets: Vec<Vec<Entry>>,
    /// Of a ring: the turn of the hand, in buckets.
    now: u64,
    entries: usize,
}

impl Agenda {
    /// An empty one for values around `size` and below.
    pub(super) fn ladder(size: f64) -> Self {
        let octaves = (STEPS >> FRACTION) as u64;
        let exponent = ((size.to_bits() >> 52) + 8).saturating_sub(octaves);
        Self::of(Scale::Logarithmic { exponent }, STEPS)
    }

    /// An empty one for times from 0 on.
    pub(super) fn ring(width: f64) -> Self {
        Self::of(Scale::Turning { width }, RING)
    }

    fn of(scale: Scale, buckets: usize) -> Self {
        Self {
            scale,
            buckets: vec![Vec::new(); buckets],
            now: 0,
            entries: 0,
        }
    }

    /// Whether keys are times.
    pub(super) fn is_ring(&self) -> bool {
        matches!(self.scale, Scale::Turning { .. })
    }

    /// Entries, those of removed nodes included.
    pub(super) fn len(&self) -> usize {
        self.entries
    }

    fn bucket(&self, key: f64) -> usize {
        match self.scale {
            Scale::Logarithmic { exponent } => {
                let step = (key.to_bits() >> (52 - FRACTION)).saturating_sub(exponent << FRACTION);
                (step as usize).min(STEPS - 1)
            }
            // Conversions saturate; entries too far ahead are tested before the hand comes round,
            // and put off again.
            Scale::Turning { width } => {
                let ahead = ((key / width) as u64).clamp(self.now, self.now + RING as u64 - 1);
                (ahead % RING as u64) as usize
            }
        }
    }

    /// Puts a node down; `stamp` distinguishes it from earlier nodes of its number.
    pub(super) fn put(&mut self, key: f64, node: u32, stamp: u32) {
        let bucket = self.bucket(key);
        self.buckets[bucket].push(Entry { key, node, stamp });
        self.entries += 1;
    }

    /// Calls `visit` for the nodes of a ladder whose keys may be between two.
    pub(super) fn visit_between(
        &mut self,
        low: f64,
        high: f64,
        is_current: impl Fn(u32, u32) -> bool,
        mut visit: impl FnMut(u32),
    ) {
        for bucket in self.bucket(low)..=self.bucket(high) {
            let list = &mut self.buckets[bucket];
            self.entries -= list.len();
            list.retain(|entry| is_current(entry.node, entry.stamp));
            self.entries += list.len();
            list.iter().for_each(|entry| visit(entry.node));
        }
    }

    /// Turns the hand of a ring to `time`, and takes out the nodes that are due by then;
    /// `is_current` decides by a node's number and stamp whether it still exists.
    pub(super) fn turn_to(
        &mut self,
        time: f64,
        is_current: impl Fn(u32, u32) -> bool,
        due: &mut Vec<u32>,
    ) {
        let Scale::Turning { width } = self.scale else {
            return;
        };
        let last = ((time / width) as u64).max(self.now);
        let count = (last - self.now).min(RING as u64 - 1);
        let mut later = Vec::new();
        for ahead in 0..=count {
            let bucket = ((self.now + ahead) % RING as u64) as usize;
            let mut list = core::mem::take(&mut self.buckets[bucket]);
            self.entries -= list.len();
            for entry in list
                .drain(..)
                .filter(|entry| is_current(entry.node, entry.stamp))
            {
                if entry.key <= time {
                    due.push(entry.node)
                } else {
                    later.push(entry)
                }
            }
            // Its room is used again.
            self.buckets[bucket] = list;
        }
        self.now = last;
        later
            .into_iter()
            .for_each(|entry| self.put(entry.key, entry.node, entry.stamp));
    }

    /// Drops the entries of removed nodes.
    pub(super) fn sweep(&mut self, is_current: impl Fn(u32, u32) -> bool) {
        self.entries = 0;
        for list in &mut self.buckets {
            list.retain(|entry| is_current(entry.node, entry.stamp));
            self.entries += list.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use limitmesh_testing::Random;

    #[test]
    fn a_ladder_gives_what_is_between() {
        let mut ladder = Agenda::ladder(100.0);
        let keys: Vec<f64> = (0..200).map(|i| 200.0 * 0.93f64.powi(i)).collect();
        let mut stamps = vec![7; keys.len()];
        (0..)
            .zip(&keys)
            .for_each(|(node, &key)| ladder.put(key, node, 7));
        stamps[40] = 8;
        let (low, high) = (keys[60], keys[20]);
        let mut found = vec![false; keys.len()];
        ladder.visit_between(
            low,
            high,
            |node: u32, stamp| stamps[node as usize] == stamp,
            |node| found[node as usize] = true,
        );
        assert!((20..=60).all(|node| found[node] != (node == 40)));
        // Buckets are narrow.
        assert!(found[..19].iter().chain(&found[62..]).all(|found| !found));
        ladder.sweep(|node, stamp| stamps[node as usize] == stamp);
        assert_eq!(ladder.len(), keys.len() - 1);
        // Zero, tiny and infinite keys have places, too.
        ladder.put(0.0, 0, 7);
        ladder.put(f64::INFINITY, 1, 7);
        let mut count = 0;
        ladder.visit_between(
            0.0,
            f64::INFINITY,
            |node: u32, stamp| stamps[node as usize] == stamp,
            |_| count += 1,
        );
        assert_eq!(count, keys.len() + 1);
    }

    #[test]
    fn a_ring_gives_what_is_due_and_nothing_else() {
        let mut ring = Agenda::ring(0.25);
        let mut random = Random::new(3);
        let mut share = || (random.bits() >> 40) as f64 / (1u64 << 24) as f64;
        let mut waiting: Vec<(f64, u32)> = Vec::new();
        let (mut now, mut next) = (0.0, 0);
        let stamps = vec![0; 100_000];
        for _ in 0..300 {
            for _ in 0..20 {
                // Some are farther ahead than the ring is long.
                let key = now + 6000.0 * share().powi(8);
                ring.put(key, next, 0);
                waiting.push((key, next));
                next += 1;
            }
            now += 100.0 * share().powi(3);
            let (mut due, mut expected) = (Vec::new(), Vec::new());
            ring.turn_to(
                now,
                |node: u32, stamp| stamps[node as usize] == stamp,
                &mut due,
            );
            waiting.retain(|&(key, node)| {
                if key <= now {
                    expected.push(node);
                }
                key > now
            });
            due.sort_unstable();
            expected.sort_unstable();
            assert_eq!(due, expected);
            assert_eq!(ring.len(), waiting.len());
        }
    }
}
