//! Random numbers that depend on (seed, parameter, sample) only, not on the order in which they are drawn.
//!
//! # Source
//! ChaCha8 as a counter: the parameter is its stream, the sample its position. Normal deviates by the inverse of the
//! distribution function: M. J. Wichura, *Algorithm AS 241: The percentage points of the normal distribution* (1988),
//! PPND16, relative error about 1e-16. Each deviate uses one uniform number, so positions are known in advance.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// Number of samples drawn together; chunk c holds the samples from c · CHUNK on.
pub const CHUNK: usize = 256;

/// The generator of random numbers.
#[derive(Clone, Debug)]
pub(super) struct RandomStream {
    rng: ChaCha8Rng,
    bytes: [u8; 8 * CHUNK],
}

impl RandomStream {
    pub(super) fn new(seed: u64) -> Self {
        Self { rng: ChaCha8Rng::seed_from_u64(seed), bytes: [0; 8 * CHUNK] }
    }

    /// Draws uniform numbers in the open interval (0, 1) for the samples of a chunk.
    pub(super) fn uniform(&mut self, stream: u64, chunk: u64, out: &mut [f64; CHUNK]) {
        self.rng.set_stream(stream);
        // Each sample takes two words of 32 bits.
        self.rng.set_word_pos(u128::from(chunk) * 2 * CHUNK as u128);
        self.rng.fill_bytes(&mut self.bytes);
        for (out, bytes) in out.iter_mut().zip(self.bytes.as_chunks().0) {
            // The midpoints of 2⁵² equal intervals: exact, and symmetric about ½.
            *out = ((u64::from_le_bytes(*bytes) >> 12) as f64 + 0.5) * (1.0 / (1_u64 << 52) as f64);
        }
    }
}

/// Replaces probabilities in (0, 1) by the corresponding quantiles of the standard normal distribution.
pub fn inverse_normal(p: &mut [f64]) {
    for block in p.chunks_mut(64) {
        let mut central = [0.0; 64];
        // Formula for the central 85 %, evaluated for all values: without branches the loop is vectorised.
        for (z, p) in central.iter_mut().zip(block.iter()) {
            let q = p - 0.5;
            let r = CENTRAL_SQUARED - q * q;
            *z = q * (polynomial(&A, r) / polynomial(&B, r));
        }
        for (p, z) in block.iter_mut().zip(&central) {
            *p = if (*p - 0.5).abs() <= 0.425 { *z } else { tail(*p) };
        }
    }
}

/// Square of the half width of the central range, 0.425².
const CENTRAL_SQUARED: f64 = 0.180625;

/// Returns the quantile for a probability in the outer 15 %.
fn tail(p: f64) -> f64 {
    let r = (-libm::log(p.min(1.0 - p))).sqrt();
    let z = match r <= 5.0 {
        true => polynomial(&C, r - 1.6) / polynomial(&D, r - 1.6),
        false => polynomial(&E, r - 5.0) / polynomial(&F, r - 5.0),
    };
    if p < 0.5 { -z } else { z }
}

#[inline(always)]
fn polynomial(c: &[f64; 8], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

const A: [f64; 8] = [
    3.387_132_872_796_366_5,
    1.331_416_678_917_843_8e2,
    1.971_590_950_306_551_3e3,
    1.373_169_376_550_946e4,
    4.592_195_393_154_987e4,
    6.726_577_092_700_87e4,
    3.343_057_558_358_813e4,
    2.509_080_928_730_122_7e3,
];
const B: [f64; 8] = [
    1.0,
    4.231_333_070_160_091e1,
    6.871_870_074_920_579e2,
    5.394_196_021_424_751e3,
    2.121_379_430_158_659_7e4,
    3.930_789_580_009_271e4,
    2.872_908_573_572_194_3e4,
    5.226_495_278_852_854e3,
];
const C: [f64; 8] = [
    1.423_437_110_749_683_5,
    4.630_337_846_156_546,
    5.769_497_221_460_691,
    3.647_848_324_763_204_5,
    1.270_458_252_452_368_4,
    2.417_807_251_774_506e-1,
    2.272_384_498_926_918_4e-2,
    7.745_450_142_783_414e-4,
];
const D: [f64; 8] = [
    1.0,
    2.053_191_626_637_759,
    1.676_384_830_183_803_8,
    6.897_673_349_851e-1,
    1.481_039_764_274_800_8e-1,
    1.519_866_656_361_645_7e-2,
    5.475_938_084_995_345e-4,
    1.050_750_071_644_416_9e-9,
];
const E: [f64; 8] = [
    6.657_904_643_501_103,
    5.463_784_911_164_114,
    1.784_826_539_917_291_3,
    2.965_605_718_285_048_7e-1,
    2.653_218_952_657_612_4e-2,
    1.242_660_947_388_078_4e-3,
    2.711_555_568_743_487_6e-5,
    2.010_334_399_292_288_1e-7,
];
const F: [f64; 8] = [
    1.0,
    5.998_322_065_558_88e-1,
    1.369_298_809_227_358e-1,
    1.487_536_129_085_061_5e-2,
    7.868_691_311_456_133e-4,
    1.846_318_317_510_054_8e-5,
    1.421_511_758_316_446e-7,
    2.044_263_103_389_939_8e-15,
];
