//! Vertices of later levels on and in a triangle, by which a distance is estimated.

use super::{Forest, Side, Triangle, edge_of, node_of, side};

impl Forest<'_> {
    /// Vertices on and in a triangle, up to three steps on; some may be the same on two sides of a sharp edge.
    pub(in crate::sqrt3) fn samples(&mut self, triangle: Triangle, samples: &mut Vec<u32>) {
        match triangle {
            Triangle::Leaf(node) => {
                let t = node as usize;
                self.grow(t);
                samples.push(self.nodes[t].apexes[0]);
                (0..3).for_each(|edge| self.samples_on(side(t, edge), samples));
            }
            Triangle::Third(own) => {
                self.samples_on(own, samples);
                // The middle one of the three triangles, two steps on, that it is made of.
                let across = self.across(own).and_then(|other| self.child(other));
                if let Some(child) = across {
                    let middle = side(child, 1);
                    if let Some(node) = self.child(middle) {
                        self.grow(node);
                        samples.push(self.nodes[node].apexes[0]);
                    }
                }
            }
        }
    }

    /// The vertices that lie on an edge two steps on.
    fn samples_on(&mut self, own: Side, samples: &mut Vec<u32>) {
        if self.node(own).is_sharp(edge_of(own)) {
            if let Some(child) = self.child(own) {
                self.grow(child);
                samples.extend(self.nodes[child].apexes);
            }
            return;
        }
        let Some(other) = self.require(own) else {
            return;
        };
        self.grow(node_of(own));
        self.grow(node_of(other));
        for child in [self.child(own), self.child(other)].into_iter().flatten() {
            self.grow(child);
            samples.push(self.nodes[child].apexes[0]);
        }
    }
}
