//! Cosine and sine of an angle together, by basic arithmetic.
//!
//! Trigonometry takes most of the time of the dynamics. A table and two short polynomials take half the time of the
//! system's library. Plain IEEE operations give the same bits on every computer, which no such library guarantees.
//!
//! # Source
//! Cody and Waite's reduction in two parts, and e^{i(a + r)} = e^{ia} e^{ir}, where a is a multiple of π/64.

use super::Vector;

/// Limit of |q|, rad, for the table. Below it, k times the first part of a step is exact, and the error is below 2e-16.
const MAX_TABLE_RAD: f64 = 1e5;
/// Number of steps of the table in a turn.
const STEPS: usize = 128;
/// Adding this number rounds to an integer and leaves it in the low bits of the mantissa.
const TO_INTEGER: f64 = 1.5 * (1u64 << 52) as f64;
/// One step, π/64, rad: its first 31 bits, and the remainder.
const STEP: [f64; 2] = [f64::from_bits(0x3FF9_21FB_5440_0000) / 32.0, f64::from_bits(0x3DD0_B461_1A62_6331) / 32.0];
/// (cos, sin) at every step.
static TURN: [[f64; 2]; STEPS] = turn();

/// Returns e(q) = (cos q, sin q) for q in rad, each within 2e-16; NaN if q is not finite.
#[inline]
pub fn unit(q: f64) -> Vector {
    if q.abs() < MAX_TABLE_RAD {
        by_table(q)
    } else {
        // For larger |q| the reduction needs more bits of π. The system's library is used, whose bits may differ
        // between computers.
        let (sin, cos) = q.sin_cos();
        Vector::new(cos, sin)
    }
}

#[inline]
fn by_table(q: f64) -> Vector {
    let shifted = q * (STEPS as f64 / std::f64::consts::TAU) + TO_INTEGER;
    let k = shifted - TO_INTEGER;
    let r = (q - k * STEP[0]) - k * STEP[1];
    let [c, s] = TURN[shifted.to_bits() as usize % STEPS];
    // |r| ≤ π/128: the truncation error of these series is below 1e-17.
    let z = r * r;
    let sin = r + r * z * (-1.0 / 6.0 + z * (1.0 / 120.0 - z * (1.0 / 5040.0)));
    let cos_less_1 = z * (-0.5 + z * (1.0 / 24.0 - z * (1.0 / 720.0)));
    Vector::new(c + (c * cos_less_1 - s * sin), s + (s * cos_less_1 + c * sin))
}

/// Builds the table from the first eighth of a turn and the symmetries of the circle.
const fn turn() -> [[f64; 2]; STEPS] {
    let mut table = [[0.0; 2]; STEPS];
    let mut i = 0;
    while i < STEPS {
        let (quarter, j) = (i / (STEPS / 4), i % (STEPS / 4));
        let [c, s] = if j <= STEPS / 8 {
            eighth(j)
        } else {
            let [c, s] = eighth(STEPS / 4 - j);
            [s, c]
        };
        table[i] = match quarter {
            0 => [c, s],
            1 => [-s, c],
            2 => [-c, -s],
            _ => [s, -c],
        };
        i += 1;
    }
    table
}

/// Returns (cos, sin) of j steps, up to π/4, by Taylor series of the first part of the angle; the remainder is added to
/// first order.
const fn eighth(j: usize) -> [f64; 2] {
    let (x, rest) = (j as f64 * STEP[0], j as f64 * STEP[1]);
    // The series are summed without their leading terms 1 and x, which are added last: only that sum loses bits.
    let (mut cos, mut sin, mut m) = (0.0, 0.0, 10);
    while m > 0 {
        let n = (2 * m) as f64;
        cos = -x * x / (n * (n - 1.0)) * (1.0 + cos);
        sin = -x * x / (n * (n + 1.0)) * (1.0 + sin);
        m -= 1;
    }
    let sin_x = x + x * sin;
    [1.0 + (cos - rest * sin_x), x + (x * sin + rest * (1.0 + cos))]
}
