//! Limit stencils of rings with sharp edges: creases, corners, darts and semi-sharp edges.
//!
//! Infinitely sharp edges cut the ring into sectors, each with the stencil of its shape: one
//! position, and a tangent plane for each side. Semi-sharp tags are refined away first: with S₀ …
//! S₍ₘ₋₁₎ the ring matrices of the ring at successive levels, a weight row w on the points after m
//! refinements is w·S₍ₘ₋₁₎ ⋯ S₀ on those before. The limit is the same, so this is exact.

use std::sync::Arc;

use super::neighbourhood::Neighbourhood;
use super::stencil::{LimitStencil, TangentPlane};
use super::{LimitError, LimitTable};
use crate::ring::{INFINITELY_SHARP, RingSector, RingShape, SharpRing};
use crate::scheme::Support;

/// The tangent plane on one side of the sharp edges at a vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct SharpSide {
    first: usize,
    faces: usize,
    plane: TangentPlane,
    pub(super) tangents: Vec<[f64; 2]>,
}

impl SharpSide {
    /// The slot of its first edge in the ring.
    pub fn first(&self) -> usize {
        self.first
    }

    /// Its number of faces, counter-clockwise from the first edge.
    pub fn faces(&self) -> usize {
        self.faces
    }

    /// The plane or line that the tangents span.
    pub fn tangent_plane(&self) -> TangentPlane {
        self.plane
    }

    /// Weights of two tangents on the differences of all points to the vertex, as in
    /// [`LimitStencil::tangent_weights`]. Their lengths mean nothing.
    pub fn tangent_weights(&self) -> Option<&[[f64; 2]]> {
        (!self.tangents.is_empty()).then_some(&self.tangents[..])
    }
}

/// Limit weights of a vertex with sharp edges; the points are ordered as in a [`LimitStencil`].
#[derive(Clone, Debug, PartialEq)]
pub struct SharpStencil {
    ring: SharpRing,
    support: Support,
    pub(super) position: Vec<f64>,
    pub(super) sides: Vec<SharpSide>,
}

impl SharpStencil {
    /// The ring that the weights are for.
    pub fn ring(&self) -> &SharpRing {
        &self.ring
    }

    /// Whether the weights are for the one-ring or the two-ring.
    pub fn support(&self) -> Support {
        self.support
    }

    /// Weights of the limit position, the vertex's first; they sum to 1.
    pub fn position_weights(&self) -> &[f64] {
        &self.position
    }

    /// The sides of the infinitely sharp edges, counter-clockwise; one where the limit surface is
    /// smooth.
    pub fn sides(&self) -> &[SharpSide] {
        &self.sides
    }
}

/// The key of a ring in a table: its sharpness by bits.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct SharpKey {
    open: bool,
    vertex: u64,
    spokes: Vec<u64>,
}

/// The ring with infinite sharpness where it is infinitely sharp, and 0 where it is smooth.
fn normalised(ring: &SharpRing) -> SharpRing {
    let plain = |sharpness: f64| match sharpness {
        s if s >= INFINITELY_SHARP => f64::INFINITY,
        s if s > 0.0 => s,
        _ => 0.0,
    };
    let last = ring.spokes.len().saturating_sub(1);
    let spokes = ring.spokes.iter().enumerate().map(|(slot, &s)| {
        match ring.open && [0, last].contains(&slot) {
            true => f64::INFINITY,
            false => plain(s),
        }
    });
    SharpRing {
        open: ring.open,
        vertex: plain(ring.vertex),
        spokes: spokes.collect(),
    }
}

impl SharpKey {
    fn of(normalised: &SharpRing) -> Self {
        let spokes = normalised.spokes.iter().map(|s| s.to_bits()).collect();
        Self {
            open: normalised.open,
            vertex: normalised.vertex.to_bits(),
            spokes,
        }
    }
}

impl LimitTable<'_> {
    /// The limit stencil of a ring with sharp edges.
    ///
    /// # Errors
    /// The ring has fewer than two edges, or the scheme's masks break its contract there.
    pub fn sharp_stencil(&self, ring: &SharpRing) -> Result<Arc<SharpStencil>, LimitError> {
        let ring = normalised(ring);
        self.known_sharp(SharpKey::of(&ring), || {
            self.analyse_sharp(ring).map(Arc::new)
        })
    }

    fn analyse_sharp(&self, ring: SharpRing) -> Result<SharpStencil, LimitError> {
        let (scheme, mut fading) = (self.scheme(), Vec::new());
        let mut lasting = ring.clone();
        while lasting.semi_sharpness() > 0.0 {
            fading.push(Neighbourhood::of_sharp(scheme, lasting.clone())?);
            lasting = lasting.refined();
        }
        let whole = Neighbourhood::of_sharp(scheme, lasting.clone())?;
        let mut position = Vec::new();
        let mut sides = Vec::new();
        for sector in lasting.sectors() {
            let stencil = self.stencil(sector.shape)?;
            let points = Points {
                ring: whole.shape,
                support: whole.support,
                sector,
            };
            if position.is_empty() {
                position = points.spread(stencil.position_weights(), whole.len());
                position = pulled_back(position, &fading)?;
            }
            sides.push(points.side(&stencil, whole.len(), &fading)?);
        }
        Ok(SharpStencil {
            ring,
            support: whole.support,
            position,
            sides,
        })
    }
}

/// A row of weights on the points after all refinements, as weights on the points before them.
fn pulled_back(
    mut weights: Vec<f64>,
    fading: &[Neighbourhood<'_>],
) -> Result<Vec<f64>, LimitError> {
    for neighbourhood in fading.iter().rev() {
        weights = neighbourhood.pulled_back(&weights)?;
    }
    Ok(weights)
}

/// The points of a sector's stencil among those of the whole ring's.
struct Points {
    ring: RingShape,
    support: Support,
    sector: RingSector,
}

impl Points {
    /// The place in the whole neighbourhood of point `i` of the sector's.
    fn whole(&self, i: usize) -> usize {
        let (k, own) = (
            self.ring.valence as usize,
            self.sector.shape.valence as usize,
        );
        if i == 0 {
            return 0;
        }
        // Ring, points beyond it, points across its faces: in each the sector's start at its first edge.
        let (kind, place) = ((i - 1) / own, (i - 1) % own);
        1 + kind * k + (self.sector.first + place) % k
    }

    /// Weights on the sector's points as weights on all.
    fn spread(&self, weights: &[f64], len: usize) -> Vec<f64> {
        let mut all = vec![0.0; len];
        weights
            .iter()
            .enumerate()
            .for_each(|(i, &weight)| all[self.whole(i)] += weight);
        all
    }

    fn side(
        &self,
        stencil: &LimitStencil,
        len: usize,
        fading: &[Neighbourhood<'_>],
    ) -> Result<SharpSide, LimitError> {
        let (first, faces) = (self.sector.first, self.sector.shape.faces() as usize);
        let mut side = SharpSide {
            first,
            faces,
            plane: stencil.tangent_plane(),
            tangents: Vec::new(),
        };
        let Some(tangents) = stencil.tangent_weights() else {
            return Ok(side);
        };
        let row = |axis: usize| {
            // On points rather than differences: the weight of the vertex makes the sum 0.
            let others = tangents.iter().map(|weights| weights[axis]);
            let centre = -others.clone().sum::<f64>();
            let weights: Vec<f64> = core::iter::once(centre).chain(others).collect();
            pulled_back(self.spread(&weights, len), fading)
        };
        let rows = [row(0)?, row(1)?];
        side.tangents = (1..len).map(|i| [rows[0][i], rows[1][i]]).collect();
        debug_assert!(self.support == stencil.support() && self.sector.shape == stencil.shape());
        Ok(side)
    }
}
