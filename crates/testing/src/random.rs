//! Numbers that look random and are the same on every run, for tests.

use limitmesh_mesh::vector::DVec3;

/// Knuth's MMIX generator; its upper bits are the good ones.
pub struct Random(u64);

impl Random {
    /// Another sequence for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// All 64 bits, of which a caller takes the upper ones.
    pub fn bits(&mut self) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        self.0
    }

    /// From −1 to 1.
    pub fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// From 0 to 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A whole number below a limit.
    pub fn below(&mut self, limit: usize) -> usize {
        (self.bits() >> 33) as usize % limit
    }

    /// Each coordinate from −1 to 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    /// A vector of length 1, all directions alike.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let point = self.vector();
            // Corners of the cube would favour its diagonals; near the middle a direction is ill determined.
            if (0.01..1.0).contains(&point.length_squared()) {
                return point.normalize();
            }
        }
    }
}
