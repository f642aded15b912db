//! Hashes of 128 bits as identifiers of a recording and of the parts of its layout. They must not collide, so they are
//! part of a cryptographic hash. Files of samples use a different, faster checksum, which only detects damage.

use sha2::{Digest, Sha256};

/// The first half of the SHA-256 hash of some words, each followed by a zero byte, so that "ab", "c" and "a", "bc"
/// differ.
#[derive(Default)]
pub struct Hash(Sha256);

impl Hash {
    /// Adds a word.
    pub fn add(&mut self, word: &str) {
        self.0.update(word);
        self.0.update([0]);
    }

    /// Returns the hash.
    pub fn number(self) -> u128 {
        let bytes = self.0.finalize();
        bytes.iter().take(16).fold(0, |number, byte| number << 8 | u128::from(*byte))
    }
}
