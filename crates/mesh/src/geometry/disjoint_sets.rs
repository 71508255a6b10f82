//! Disjoint sets of numbers (union-find with path halving). A set's root is its lowest member, so that results do not
//! depend on the order of the unions.

/// The numbers from 0 on, at first each in a set of its own.
#[derive(Clone, Debug)]
pub struct DisjointSets {
    /// Never greater than the number itself.
    parent: Vec<u32>,
}

impl DisjointSets {
    /// `count` sets of one element.
    pub fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
        }
    }

    /// Sets as they are: each number leads to itself or a lower one of its set.
    pub(crate) fn from_parents(parent: Vec<u32>) -> Self {
        Self { parent }
    }

    /// The lowest member of the set of `x`.
    pub fn root(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            self.parent[x as usize] = self.parent[self.parent[x as usize] as usize];
            x = self.parent[x as usize];
        }
        x
    }

    /// Unites the sets of `a` and `b`; false if they were one already.
    pub fn unite(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// The root of every number.
    pub fn into_roots(mut self) -> Vec<u32> {
        // No parent is greater than its child, so that one ascending pass resolves all chains.
        for x in 0..self.parent.len() {
            self.parent[x] = self.parent[self.parent[x] as usize];
        }
        self.parent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use limitmesh_testing::Random;

    #[test]
    fn sets_are_those_of_a_flood_over_the_same_pairs() {
        let mut random = Random::new(1);
        for count in [1u32, 5, 60] {
            let pairs: Vec<[u32; 2]> = (0..count / 2)
                .map(|_| {
                    [
                        random.below(count as usize) as u32,
                        random.below(count as usize) as u32,
                    ]
                })
                .collect();
            let mut sets = DisjointSets::new(count as usize);
            let mut labels: Vec<u32> = (0..count).collect();
            for &[a, b] in &pairs {
                let (from, to) = (labels[a as usize], labels[b as usize]);
                assert_eq!(sets.unite(a, b), from != to);
                labels
                    .iter_mut()
                    .filter(|label| **label == from)
                    .for_each(|label| *label = to);
            }
            let lowest = |x: u32| {
                labels
                    .iter()
                    .position(|&label| label == labels[x as usize])
                    .unwrap() as u32
            };
            assert!((0..count).all(|x| sets.root(x) == lowest(x)));
            assert_eq!(
                sets.into_roots(),
                (0..count).map(lowest).collect::<Vec<u32>>()
            );
        }
    }
}
