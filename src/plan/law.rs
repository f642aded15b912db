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
}

/// From rest to rest over a time T.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeLaw {
    /// s = 10 u³ − 15 u⁴ + 6 u⁵, u = t/T: acceleration starts and ends at zero and peaks at 5.7735/T².
    #[default]
    Quintic,
}

impl TimeLaw {
    /// Progress at time t, s, of a motion that takes T, s.
    #[inline]
    pub fn at(self, t: f64, duration: f64) -> Progress {
        let u = (t / duration).clamp(0.0, 1.0);
        match self {
            Self::Quintic => Progress {
                s: u * u * u * (10.0 + u * (-15.0 + 6.0 * u)),
                rate: 30.0 * u * u * (1.0 - u) * (1.0 - u) / duration,
                acceleration: 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (duration * duration),
            },
        }
    }
}
