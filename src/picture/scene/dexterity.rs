//! Dexterity as a colour scale of the workspace: three measures of a pose, which do not depend on b.

use super::palette::{Palette, faded, mix};
use super::{Measure, Rgba};
use stillbase_planning::reactionless::PlaneMap;

/// Intervals per side of the initial search grid.
const GRID_INTERVALS: i32 = 24;

impl Measure {
    /// All measures, in the order in which key J shows them.
    pub const ALL: [Self; 3] = [Self::Det, Self::Manipulability, Self::TorquePerForce];

    /// Returns the next measure; `None` means no measure, and comes before the first and after the last.
    pub fn after(now: Option<Self>) -> Option<Self> {
        match now {
            None => Some(Self::Det),
            Some(measure) => Self::ALL.get(measure as usize + 1).copied(),
        }
    }

    /// Symbol in the legend.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Det => "|det|",
            Self::Manipulability => "√det JJ*",
            Self::TorquePerForce => "|τ|/|F|",
        }
    }

    /// SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Det | Self::Manipulability => "m²",
            Self::TorquePerForce => "N m/N",
        }
    }

    /// Explanation in a sentence.
    pub fn explanation(self) -> &'static str {
        match self {
            Self::Det => {
                "|det ∂(x, y)/∂(a₁, a₂)|: the area that the end effector covers for each rad² of a₁, a₂; 0 if singular"
            }
            Self::Manipulability => {
                "√det(J J*), J* transposed: manipulability with b free; 0 where all arms are in line"
            }
            Self::TorquePerForce => "The greatest |τ| that a unit force at the end effector asks of the drives",
        }
    }

    /// Returns the measure of the pose (a_1, a_2), rad.
    pub fn of(self, map: &PlaneMap, a: [f64; 2]) -> f64 {
        let dexterity = map.dexterity(a);
        match self {
            Self::Det => dexterity.det,
            Self::Manipulability => dexterity.manipulability,
            Self::TorquePerForce => dexterity.worst_torque_per_force,
        }
    }

    /// Returns the ends of the colour scale: minimum and maximum within the joint limits. The scale of det starts at 0,
    /// because two sheets (branches of the inverse kinematics) may meet, and det = 0 there.
    pub fn range(self, map: &PlaneMap) -> [f64; 2] {
        let least = if self == Self::Det { 0.0 } else { -greatest(map, |a| -self.of(map, a)) };
        let most = greatest(map, |a| self.of(map, a));
        // A constant measure has the upper colour everywhere.
        if most > least { [least, most] } else { [least - 1.0, most.max(least)] }
    }
}

/// Returns the maximum of a function of (a_1, a_2) within the joint limits, by grid search and refinement.
fn greatest(map: &PlaneMap, value: impl Fn([f64; 2]) -> f64) -> f64 {
    let [l1, l2] = map.limits();
    let at = |i: i32, j: i32| {
        let share = |l: stillbase_planning::reactionless::AngleLimit, i: i32| {
            l.min + f64::from(i) / f64::from(GRID_INTERVALS) * (l.max - l.min)
        };
        [share(l1, i), share(l2, j)]
    };
    let poses = (0..=GRID_INTERVALS).flat_map(|i| (0..=GRID_INTERVALS).map(move |j| at(i, j)));
    let Some(mut best) = poses.max_by(|s, t| value(*s).total_cmp(&value(*t))) else { return 0.0 };
    // Pattern search around the best grid point, with halved steps.
    let mut step = [l1, l2].map(|l| (l.max - l.min) / f64::from(GRID_INTERVALS));
    for _ in 0..40 {
        let around = (0..9)
            .map(|k| map.clamp([best[0] + f64::from(k % 3 - 1) * step[0], best[1] + f64::from(k / 3 - 1) * step[1]]));
        best = around.fold(best, |best, a| if value(a) > value(best) { a } else { best });
        step = step.map(|s| 0.5 * s);
    }
    value(best)
}

/// Returns the fill colours at the minimum and maximum of a measure: amber, and pale amber.
pub fn colours(palette: &Palette) -> [Rgba; 2] {
    let pale = |share| mix(palette.amber, [1.0, 0.98, 0.92, 1.0], share);
    // On a dark background, brighter means more.
    let dark = palette.background.iter().take(3).sum::<f32>() < 1.5;
    match dark {
        true => [faded(palette.amber, 0.2), faded(pale(0.45), 0.62)],
        false => [faded(palette.amber, 0.6), faded(pale(0.7), 0.6)],
    }
}
