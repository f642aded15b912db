//! Chance.

/// Numbers that look random and are the same each time.
pub struct Noise(u64);

impl Noise {
    pub fn of(seed: u64) -> Self {
        Self(seed)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // The lowest bits of such a sequence repeat soon, and neighbours are alike.
        let mixed = (self.0 ^ (self.0 >> 29)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        low + (high - low) * (mixed >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn sign(&mut self) -> f64 {
        if self.between(-1.0, 1.0) < 0.0 { -1.0 } else { 1.0 }
    }
}
