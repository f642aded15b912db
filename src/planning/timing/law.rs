//! Time laws: how far along its path a motion is, and how fast.

use serde::{Deserialize, Serialize};

/// The share s of a path that is done, with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// 0 at the start, 1 at the end.
    pub s: f64,
    /// ṡ, 1/s.
    pub rate: f64,
    /// s̈, 1/s².
    pub acceleration: f64,
    /// s⃛, 1/s³; steps of s̈ have none.
    pub jerk: f64,
}

impl Progress {
    /// Standing still at s.
    #[inline]
    pub fn still(s: f64) -> Self {
        Self { s, rate: 0.0, acceleration: 0.0, jerk: 0.0 }
    }
}

/// From rest to rest over a time T. Peaks of s̈ are times 1/T², those of s⃛ times 1/T³.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeLaw {
    /// s = 10 u³ − 15 u⁴ + 6 u⁵, u = t/T: acceleration starts and ends at zero and peaks at 10/√3 = 5.7735.
    #[default]
    Quintic,
    /// s = 35 u⁴ − 84 u⁵ + 70 u⁶ − 20 u⁷: jerk starts and ends at zero too; acceleration peaks at 84√5/25 = 7.5132.
    Septic,
    /// A third of T at s̈ = 4.5, a third at the rate 1.5/T, a third at −4.5.
    Trapezoidal,
    /// As fast as the machine's limits on torque, speed and acceleration allow. In a given T: half of it at s̈ = 4,
    /// half at −4, which is the least peak that any law has.
    Fastest,
    /// As fast as the machine's limits allow, those on jerk included. In a given T: s⃛ is 32, −32, 32 for a quarter, a
    /// half, a quarter of it, which is the least peak that any law has; acceleration peaks at 8.
    FastestSmooth,
}

impl TimeLaw {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Quintic, Self::Septic, Self::Trapezoidal, Self::Fastest, Self::FastestSmooth];

    /// Its name in files and commands, its name on the screen, and what it does.
    pub fn words(self) -> [&'static str; 3] {
        match self {
            Self::Quintic => ["quintic", "Quintic", "Acceleration begins and ends at zero; peaks 5.7735/T²"],
            Self::Septic => ["septic", "Septic", "Jerk begins and ends at zero too; peaks 7.5132/T²"],
            Self::Trapezoidal => {
                ["trapezoidal", "Trapezoidal", "A third speeding up, a third cruising, a third braking"]
            }
            Self::Fastest => ["fastest", "Fastest", "As fast as torque, speed and acceleration limits allow"],
            Self::FastestSmooth => ["fastest-smooth", "Fastest, smooth", "The same with limits on jerk"],
        }
    }

    /// Whether the machine's limits set T, and not the task.
    pub fn is_fastest(self) -> bool {
        matches!(self, Self::Fastest | Self::FastestSmooth)
    }

    /// The greatest |s̈|, times T².
    pub fn peak(self) -> f64 {
        match self {
            Self::Quintic => 10.0 / 3f64.sqrt(),
            Self::Septic => 84.0 * 5f64.sqrt() / 25.0,
            Self::Trapezoidal => 4.5,
            Self::Fastest => 4.0,
            Self::FastestSmooth => 8.0,
        }
    }

    /// The shares of T at which s̈ jumps or bends.
    pub fn kinks(self) -> &'static [f64] {
        match self {
            Self::Quintic | Self::Septic => &[0.0, 1.0],
            Self::Trapezoidal => &[0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0],
            Self::Fastest => &[0.0, 0.5, 1.0],
            Self::FastestSmooth => &[0.0, 0.25, 0.75, 1.0],
        }
    }

    /// Progress at time t, s, of a motion that takes T, s; still before its start and from its end on.
    #[inline]
    pub fn at(self, t: f64, duration: f64) -> Progress {
        if t < 0.0 {
            return Progress::still(0.0);
        }
        if t >= duration {
            return Progress::still(1.0);
        }
        let u = t / duration;
        let [s, rate, acceleration, jerk] = match self {
            Self::Quintic => [
                u * u * u * (10.0 + u * (-15.0 + 6.0 * u)),
                30.0 * u * u * (1.0 - u) * (1.0 - u),
                60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
                60.0 * (1.0 - 6.0 * u * (1.0 - u)),
            ],
            Self::Septic => {
                let w = u * (1.0 - u);
                [
                    u * u * u * u * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u))),
                    140.0 * w * w * w,
                    420.0 * w * w * (1.0 - 2.0 * u),
                    840.0 * w * (1.0 - 5.0 * w),
                ]
            }
            Self::Trapezoidal => mirrored(u, |u| {
                if u < 1.0 / 3.0 { [2.25 * u * u, 4.5 * u, 4.5, 0.0] } else { [1.5 * u - 0.25, 1.5, 0.0, 0.0] }
            }),
            Self::Fastest => mirrored(u, |u| [2.0 * u * u, 4.0 * u, 4.0, 0.0]),
            Self::FastestSmooth => mirrored(u, |u| {
                if u < 0.25 {
                    return [16.0 / 3.0 * u * u * u, 16.0 * u * u, 32.0 * u, 32.0];
                }
                // About the middle, where s = 1/2, ṡ = 2 and s̈ = 0.
                let v = u - 0.5;
                [0.5 + v * (2.0 - 16.0 / 3.0 * v * v), 2.0 - 16.0 * v * v, -32.0 * v, -32.0]
            }),
        };
        let per = 1.0 / duration;
        Progress { s, rate: rate * per, acceleration: acceleration * (per * per), jerk: jerk * (per * per * per) }
    }
}

/// A law whose second half is its first half, run backwards.
#[inline]
fn mirrored(u: f64, half: impl Fn(f64) -> [f64; 4]) -> [f64; 4] {
    if u < 0.5 {
        return half(u);
    }
    let [s, rate, acceleration, jerk] = half(1.0 - u);
    [1.0 - s, rate, -acceleration, jerk]
}
