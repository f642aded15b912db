//! What tells one thing from another by its words.

/// FNV-1a of words, one after another.
pub struct Hash(pub u128);

impl Hash {
    /// Of no word.
    pub fn new() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }

    /// One more word.
    pub fn add(&mut self, word: &str) {
        for byte in word.bytes().chain([0]) {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0100_0000_0000_0000_0000_013b);
        }
    }
}
