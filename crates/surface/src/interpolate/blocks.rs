//! The block triangular form of a system: the unknowns that depend on one another, and an order of
//! solving.
//!
//! A limit position depends on some control points. Points that depend on each other in a circle
//! have to be found together: the strongly connected components of the matrix's pattern (Tarjan
//! 1972), which come out in an order in which each depends on earlier ones alone. So corners come
//! first, each alone, then the lines of creases and boundaries between them, then the inside of
//! each smooth region; and a line that ends in a dart is solved together with the region around
//! that.

use super::sparse::Sparse;

/// Unknowns in groups that are solved one after the other.
pub(super) struct Blocks {
    starts: Vec<u32>,
    members: Vec<u32>,
    /// The group of each unknown.
    numbers: Vec<u32>,
    /// The place of each unknown in its group.
    places: Vec<u32>,
}

impl Blocks {
    /// The groups of a square matrix, whose rows are the dependencies of the unknowns; each group
    /// ascending.
    pub(crate) fn of(matrix: &Sparse) -> Self {
        let n = matrix.rows();
        let mut search = Search {
            matrix,
            order: vec![0; n],
            lowest: vec![0; n],
            is_open: vec![false; n],
            open: Vec::new(),
            visited: 0,
            blocks: Self {
                starts: vec![0],
                members: Vec::with_capacity(n),
                numbers: vec![0; n],
                places: vec![0; n],
            },
        };
        for root in 0..n as u32 {
            if search.order[root as usize] == 0 {
                search.visit_from(root);
            }
        }
        search.blocks
    }

    /// Number of groups.
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The unknowns of a group, ascending.
    pub(super) fn block(&self, number: usize) -> &[u32] {
        &self.members[self.starts[number] as usize..self.starts[number + 1] as usize]
    }

    /// The groups, in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.len()).map(|number| self.block(number))
    }

    /// The group of an unknown.
    #[inline]
    pub(super) fn number(&self, v: u32) -> u32 {
        self.numbers[v as usize]
    }

    /// The place of an unknown in its group.
    #[inline]
    pub(super) fn place(&self, v: u32) -> u32 {
        self.places[v as usize]
    }
}

/// Tarjan's search, with a stack of its own in place of recursion.
struct Search<'m> {
    matrix: &'m Sparse,
    /// When each unknown was visited, from 1 on; 0 for not yet.
    order: Vec<u32>,
    /// The earliest open visit that was found from it.
    lowest: Vec<u32>,
    is_open: Vec<bool>,
    open: Vec<u32>,
    visited: u32,
    blocks: Blocks,
}

impl Search<'_> {
    fn visit_from(&mut self, root: u32) {
        // Unknowns on the way, and the number of their columns visited.
        let mut way = vec![(root, 0usize)];
        self.enter(root);
        while let Some(top) = way.last_mut() {
            let (v, next) = *top;
            let i = v as usize;
            if let Some(&u) = self.matrix.columns(i).get(next) {
                top.1 += 1;
                if self.order[u as usize] == 0 {
                    self.enter(u);
                    way.push((u, 0));
                } else if self.is_open[u as usize] {
                    self.lowest[i] = self.lowest[i].min(self.order[u as usize]);
                }
                continue;
            }
            way.pop();
            if let Some(&(before, _)) = way.last() {
                self.lowest[before as usize] = self.lowest[before as usize].min(self.lowest[i]);
            }
            if self.lowest[i] == self.order[i] {
                self.close(v);
            }
        }
    }

    fn enter(&mut self, v: u32) {
        self.visited += 1;
        (self.order[v as usize], self.lowest[v as usize]) = (self.visited, self.visited);
        self.is_open[v as usize] = true;
        self.open.push(v);
    }

    /// All that is open from `v` on is a group.
    fn close(&mut self, v: u32) {
        let Some(first) = self.open.iter().rposition(|&u| u == v) else {
            return;
        };
        let (start, number) = (self.blocks.members.len(), self.blocks.len() as u32);
        self.blocks.members.extend(self.open.drain(first..));
        self.blocks.members[start..].sort_unstable();
        for (place, &u) in (0..).zip(&self.blocks.members[start..]) {
            self.is_open[u as usize] = false;
            (
                self.blocks.numbers[u as usize],
                self.blocks.places[u as usize],
            ) = (number, place);
        }
        self.blocks.starts.push(self.blocks.members.len() as u32);
    }
}
