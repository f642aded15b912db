//! Time laws: position along a path and its derivatives as functions of time.

use stillbase_settings::word::words;

/// Position s on a path with its time derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathProgress {
    /// 0 at the start, 1 at the end.
    pub s: f64,
    /// ṡ, 1/s.
    pub rate: f64,
    /// s̈, 1/s².
    pub acceleration: f64,
    /// s⃛, 1/s³; jumps of s̈ are not included.
    pub jerk: f64,
}

impl PathProgress {
    /// Returns rest at s.
    #[inline]
    pub fn at_rest(s: f64) -> Self {
        Self { s, rate: 0.0, acceleration: 0.0, jerk: 0.0 }
    }
}

/// Definition of a law over a given duration T.
struct Law {
    /// Whether the machine's limits set T, not the task.
    is_fastest: bool,
    /// Maximum |s̈| times T².
    peak: f64,
    /// Fractions of T: the start, the end, and those between at which s̈ or its slope jumps.
    kinks: &'static [f64],
    /// Returns s and its first three derivatives with respect to u = t/T, for u from 0 to 1.
    at: fn(f64) -> [f64; 4],
}

words! {
    /// Time laws from rest to rest over a duration T. Peaks of s̈ are in units of 1/T², those of s⃛ in units of 1/T³.
    pub enum TimeLaw: Law {
        /// s = 10 u³ − 15 u⁴ + 6 u⁵, u = t/T; the peak is 10/√3.
        Quintic = "quintic", "Quintic", "Acceleration begins and ends at zero; peaks 5.7735/T²" => Law {
            is_fastest: false,
            peak: 10.0 / SQRT_3,
            kinks: &[0.0, 1.0],
            at: |u| {
                [
                    u * u * u * (10.0 + u * (-15.0 + 6.0 * u)),
                    30.0 * u * u * (1.0 - u) * (1.0 - u),
                    60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
                    60.0 * (1.0 - 6.0 * u * (1.0 - u)),
                ]
            },
        };
        /// s = 35 u⁴ − 84 u⁵ + 70 u⁶ − 20 u⁷; the peak is 84√5/25.
        Septic = "septic", "Septic", "Jerk begins and ends at zero too; peaks 7.5132/T²" => Law {
            is_fastest: false,
            peak: 84.0 * SQRT_5 / 25.0,
            kinks: &[0.0, 1.0],
            at: |u| {
                let w = u * (1.0 - u);
                [
                    u * u * u * u * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u))),
                    140.0 * w * w * w,
                    420.0 * w * w * (1.0 - 2.0 * u),
                    840.0 * w * (1.0 - 5.0 * w),
                ]
            },
        };
        /// A third of T at s̈ = 4.5, a third at the rate 1.5/T, a third at −4.5.
        Trapezoidal = "trapezoidal", "Trapezoidal", "A third speeding up, a third cruising, a third braking" => Law {
            is_fastest: false,
            peak: 4.5,
            kinks: &[0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0],
            at: |u| mirrored(u, |u| {
                if u < 1.0 / 3.0 { [2.25 * u * u, 4.5 * u, 4.5, 0.0] } else { [1.5 * u - 0.25, 1.5, 0.0, 0.0] }
            }),
        };
        /// For a given T: half of it at s̈ = 4, half at −4, the least peak of all laws.
        Fastest = "fastest", "Fastest", "As fast as torque, speed and acceleration limits allow" => Law {
            is_fastest: true,
            peak: 4.0,
            kinks: &[0.0, 0.5, 1.0],
            at: |u| mirrored(u, |u| [2.0 * u * u, 4.0 * u, 4.0, 0.0]),
        };
        /// For a given T: s⃛ is 32, −32 and 32 over a quarter, a half and a quarter of T, the least peak of
        /// |s⃛| of all laws.
        /// The peak of acceleration is 8.
        FastestSmooth = "fastest-smooth", "Fastest, smooth", "The same with limits on jerk" => Law {
            is_fastest: true,
            peak: 8.0,
            kinks: &[0.0, 0.25, 0.75, 1.0],
            at: |u| mirrored(u, |u| {
                if u < 0.25 {
                    return [16.0 / 3.0 * u * u * u, 16.0 * u * u, 32.0 * u, 32.0];
                }
                // Expansion about the middle, where s = 1/2, ṡ = 2 and s̈ = 0.
                let v = u - 0.5;
                [0.5 + v * (2.0 - 16.0 / 3.0 * v * v), 2.0 - 16.0 * v * v, -32.0 * v, -32.0]
            }),
        };
    }
}

/// √3; the square root is not a constant expression.
const SQRT_3: f64 = 1.732_050_807_568_877_2;
/// √5.
const SQRT_5: f64 = 2.236_067_977_499_79;

impl TimeLaw {
    /// Returns whether the machine's limits set T, not the task.
    pub fn is_fastest(self) -> bool {
        self.data().is_fastest
    }

    /// Returns whether s̈ and its slope are continuous inside the motion.
    pub fn is_smooth(self) -> bool {
        self.kinks().len() == 2
    }

    /// Returns the maximum |s̈| times T².
    pub fn peak(self) -> f64 {
        self.data().peak
    }

    /// Returns fractions of T: the start, the end, and those between at which s̈ or its slope jumps.
    pub fn kinks(self) -> &'static [f64] {
        self.data().kinks
    }

    /// Returns the progress at time t, s, of a motion of `duration`, s; at rest before its start and from its end on.
    #[inline]
    pub fn at(self, t: f64, duration: f64) -> PathProgress {
        if t < 0.0 {
            return PathProgress::at_rest(0.0);
        }
        if t >= duration {
            return PathProgress::at_rest(1.0);
        }
        let [s, rate, acceleration, jerk] = (self.data().at)(t / duration);
        let per = 1.0 / duration;
        PathProgress { s, rate: rate * per, acceleration: acceleration * (per * per), jerk: jerk * (per * per * per) }
    }
}

/// Evaluates a law whose second half is its first half reversed.
#[inline]
fn mirrored(u: f64, half: impl Fn(f64) -> [f64; 4]) -> [f64; 4] {
    if u < 0.5 {
        return half(u);
    }
    let [s, rate, acceleration, jerk] = half(1.0 - u);
    [1.0 - s, rate, -acceleration, jerk]
}
