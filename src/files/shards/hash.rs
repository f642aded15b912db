//! The two 64-bit hashes in files of samples. They detect accidental changes, not attacks, so they are short and fast.
//! The algorithms must never change, because files store their values. Identifiers of recordings, which must never
//! coincide, are truncated SHA-256 hashes instead.

/// The offset basis of FNV-1a, 64 bits.
const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;

/// Returns the FNV-1a hash of bytes, which identifies the study of a file.
pub fn fnv_1a(bytes: &[u8]) -> u64 {
    let byte = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    bytes.iter().fold(OFFSET_BASIS, byte)
}

/// A checksum like FNV-1a over words of eight bytes. Each step is a bijection of the sum, so a change of a single word
/// always changes the checksum.
pub struct Checksum {
    sum: u64,
    /// Bytes that do not yet fill a word.
    rest: Vec<u8>,
}

impl Checksum {
    /// Starts the checksum of an empty sequence of bytes.
    pub fn new() -> Self {
        Self { sum: OFFSET_BASIS, rest: Vec::with_capacity(8) }
    }

    fn step(sum: u64, word: &[u8]) -> u64 {
        let word = word.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
        (sum ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
    }

    /// Adds bytes, in their order.
    pub fn add(&mut self, bytes: &[u8]) {
        let missing = if self.rest.is_empty() { 0 } else { (8 - self.rest.len()).min(bytes.len()) };
        let (first, bytes) = bytes.split_at(missing);
        self.rest.extend_from_slice(first);
        if self.rest.len() == 8 {
            self.sum = Self::step(self.sum, &self.rest);
            self.rest.clear();
        }
        if !bytes.is_empty() {
            let words = bytes.chunks_exact(8);
            self.rest.extend_from_slice(words.remainder());
            self.sum = words.fold(self.sum, Self::step);
        }
    }

    /// Returns the checksum of all bytes; a final byte 1 marks the end, so that appended zeros change it.
    pub fn total(&self) -> u64 {
        let mut last = self.rest.clone();
        last.push(1);
        Self::step(self.sum, &last)
    }
}
