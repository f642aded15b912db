//! A number of 128 bits from some words: the identifier of a recording, and of each part of its layout.

/// The FNV-1a hash of some words, each ended by a zero byte, so that "ab", "c" and "a", "bc" differ.
pub struct Hash(pub u128);

impl Hash {
    /// The hash of no words.
    pub fn new() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }

    /// Takes one more word in.
    pub fn add(&mut self, word: &str) {
        for byte in word.bytes().chain([0]) {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0100_0000_0000_0000_0000_013b);
        }
    }
}
