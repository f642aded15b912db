//! A number of 128 bits from some words: the identifier of a recording, and of each part of its layout. Two of them must
//! never be equal by chance, so they are cut from a cryptographic hash. The checksum of a file of samples is another one:
//! it only has to find damage, and quickly.

use sha2::{Digest, Sha256};

/// The first half of the SHA-256 hash of some words, each ended by a zero byte, so that "ab", "c" and "a", "bc" differ.
#[derive(Default)]
pub struct Hash(Sha256);

impl Hash {
    /// Takes one more word in.
    pub fn add(&mut self, word: &str) {
        self.0.update(word);
        self.0.update([0]);
    }

    /// The number.
    pub fn number(self) -> u128 {
        let bytes = self.0.finalize();
        bytes.iter().take(16).fold(0, |number, byte| number << 8 | u128::from(*byte))
    }
}
