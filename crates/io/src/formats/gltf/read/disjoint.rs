//! Disjoint sets of numbers.

/// By number, another of its set with a lower number, or itself.
pub(super) struct Disjoint(Vec<u32>);

impl Disjoint {
    /// Each number is a set of its own.
    pub(super) fn new(count: u32) -> Self {
        Self((0..count).collect())
    }

    /// The lowest number of a set.
    pub(super) fn root(&mut self, mut x: u32) -> u32 {
        let Self(parents) = self;
        while parents[x as usize] != x {
            parents[x as usize] = parents[parents[x as usize] as usize];
            x = parents[x as usize];
        }
        x
    }

    /// Makes two sets one.
    pub(super) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
