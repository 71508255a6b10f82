//! A one-ring with the sharpness of its edges: the rule of its vertex, the sectors between sharp
//! edges, and its state after refinements.
//!
//! The rules are OpenSubdiv's: the rule of a vertex follows from the number of its sharp edges,
//! those of a boundary included. Sharpness falls by one with each refinement and ends at 0; where
//! it falls from 1 or less, the points of that refinement lie between those of the sharp and of the
//! smooth rules.
//!
//! At a vertex with two sharp edges or more, each part of the ring between two of them refines as a boundary's open
//! ring would: the rules on sharp edges use points on sharp edges only, and all others points of their own side.
//! Masks and limits of such a sector are therefore those of its [`RingShape`].

use super::RingShape;

/// Sharpness from which edges are infinitely sharp: OpenSubdiv's convention for files.
pub const INFINITELY_SHARP: f64 = 10.0;

/// The rule of a vertex.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum VertexRule {
    /// No sharp edge.
    Smooth,
    /// One sharp edge, which ends here: the vertex itself moves as if it were smooth.
    Dart,
    /// Two sharp edges: the vertex stays on the curve that they form. Boundary vertices among them.
    Crease,
    /// Three sharp edges or more, or sharp itself: the vertex keeps its position.
    Corner,
}

/// A part of a ring between two sharp edges; all of a closed ring with fewer than two.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RingSector {
    /// The slot of its first edge, which is sharp except in a ring without sharp edges.
    pub first: usize,
    /// Its shape from there on: open between two sharp edges.
    pub shape: RingShape,
}

/// The one-ring of a vertex with the sharpness of its edges.
#[derive(Clone, PartialEq, Debug)]
pub struct SharpRing {
    /// Whether the ring ends at two boundary edges.
    pub open: bool,
    /// The sharpness of the vertex itself.
    pub vertex: f64,
    /// The sharpness of each edge, in ring order; infinite for boundary edges.
    pub spokes: Vec<f64>,
}

/// The sharpness after one refinement.
#[inline]
#[doc(hidden)]
pub fn decremented(sharpness: f64) -> f64 {
    if sharpness >= INFINITELY_SHARP {
        sharpness
    } else {
        (sharpness - 1.0).max(0.0)
    }
}

/// [`SharpRing::present_weight`] of a ring with such a vertex and such edges.
#[doc(hidden)]
pub fn present_weight(vertex: f64, spokes: &[f64]) -> f64 {
    let about = spokes
        .iter()
        .chain([&vertex])
        .copied()
        .filter(|&s| s > 0.0 && s <= 1.0);
    let (sum, count) = about.fold((0.0, 0), |(sum, count), s| (sum + s, count + 1));
    if count == 0 {
        1.0
    } else {
        sum / f64::from(count)
    }
}

fn is_sharp(open: bool, spokes: &[f64], slot: usize) -> bool {
    spokes.get(slot).is_some_and(|&s| s > 0.0) || open && (slot == 0 || slot + 1 == spokes.len())
}

/// [`SharpRing::rule`] of a ring with such a vertex and such edges.
#[doc(hidden)]
pub fn rule(open: bool, vertex: f64, spokes: &[f64]) -> VertexRule {
    match (0..spokes.len())
        .filter(|&slot| is_sharp(open, spokes, slot))
        .count()
    {
        _ if vertex > 0.0 => VertexRule::Corner,
        0 => VertexRule::Smooth,
        1 => VertexRule::Dart,
        2 => VertexRule::Crease,
        _ => VertexRule::Corner,
    }
}

impl SharpRing {
    /// A ring with the sharpness of its shape only.
    pub fn of(shape: RingShape) -> Self {
        let mut spokes = vec![0.0; shape.valence as usize];
        if shape.open {
            spokes
                .first_mut()
                .into_iter()
                .for_each(|first| *first = f64::INFINITY);
            spokes
                .last_mut()
                .into_iter()
                .for_each(|last| *last = f64::INFINITY);
        } else if shape.dart {
            spokes
                .first_mut()
                .into_iter()
                .for_each(|first| *first = f64::INFINITY);
        }
        Self {
            open: shape.open,
            vertex: if shape.corner { f64::INFINITY } else { 0.0 },
            spokes,
        }
    }

    /// The ring after one refinement.
    pub fn refined(&self) -> Self {
        let spokes = self.spokes.iter().map(|&s| decremented(s)).collect();
        Self {
            open: self.open,
            vertex: decremented(self.vertex),
            spokes,
        }
    }

    /// The greatest semi-sharp sharpness; 0 without semi-sharp tags.
    pub fn semi_sharpness(&self) -> f64 {
        let all = self.spokes.iter().chain([&self.vertex]);
        all.copied()
            .filter(|&s| s < INFINITELY_SHARP)
            .fold(0.0, f64::max)
    }

    /// The least semi-sharp sharpness; [`INFINITELY_SHARP`] without semi-sharp tags.
    #[doc(hidden)]
    pub fn least_semi_sharpness(&self) -> f64 {
        let all = self.spokes.iter().chain([&self.vertex]).copied();
        all.filter(|&s| s > 0.0).fold(INFINITELY_SHARP, f64::min)
    }

    /// The share of the next refinement that follows the rules of the present ring; the rest
    /// follows those of the ring after it. It is below 1 where semi-sharp tags are about to end:
    /// their mean sharpness.
    pub fn present_weight(&self) -> f64 {
        present_weight(self.vertex, &self.spokes)
    }

    /// Whether the edge at `slot` is sharp; boundary edges always are.
    pub fn is_sharp(&self, slot: usize) -> bool {
        is_sharp(self.open, &self.spokes, slot)
    }

    /// The rule that the vertex follows.
    pub fn rule(&self) -> VertexRule {
        rule(self.open, self.vertex, &self.spokes)
    }

    /// The sectors, counter-clockwise.
    pub fn sectors(&self) -> Vec<RingSector> {
        let corner = self.rule() == VertexRule::Corner;
        let sharp: Vec<usize> = (0..self.spokes.len())
            .filter(|&slot| self.is_sharp(slot))
            .collect();
        if !self.open && sharp.len() < 2 {
            let interior = RingShape::interior(self.spokes.len() as u32);
            let shape = RingShape {
                corner,
                dart: sharp.len() == 1,
                ..interior
            };
            return vec![RingSector {
                first: sharp.first().copied().unwrap_or(0),
                shape,
            }];
        }
        // A closed ring goes on to its first sharp edge; an open one ends with its last, a boundary edge.
        let closing = sharp
            .first()
            .filter(|_| !self.open)
            .map(|&first| first + self.spokes.len());
        let ends = sharp.iter().skip(1).copied().chain(closing);
        let between = |(&first, end): (&usize, usize)| {
            let shape = RingShape {
                corner,
                ..RingShape::boundary((end - first + 1) as u32)
            };
            RingSector { first, shape }
        };
        sharp.iter().zip(ends).map(between).collect()
    }
}
