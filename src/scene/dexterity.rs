//! How far the end effector moves for a motion of the joints on a plane: |det ∂(x, y)/∂(a_1, a_2)|, m². It is the same
//! for every b, 0 at singular poses, and shades the workspace.

use super::Rgba;
use super::linkage::mix;
use super::palette::{Palette, faded};
use crate::reactionless::PlaneMap;

/// Poses a side of the first search.
const GRID: i32 = 48;

/// The greatest |det| within the limits, m².
pub fn greatest(map: &PlaneMap) -> f64 {
    let [l1, l2] = map.limits();
    let det = |a: [f64; 2]| map.det(a).abs();
    let at = |i: i32, j: i32| {
        let share = |l: crate::reactionless::Limit, i: i32| l.min + f64::from(i) / f64::from(GRID) * (l.max - l.min);
        [share(l1, i), share(l2, j)]
    };
    let poses = (0..=GRID).flat_map(|i| (0..=GRID).map(move |j| at(i, j)));
    let Some(mut best) = poses.max_by(|s, t| det(*s).total_cmp(&det(*t))) else { return 0.0 };
    // Then about the best one, in steps that halve.
    let mut step = [l1, l2].map(|l| (l.max - l.min) / f64::from(GRID));
    for _ in 0..40 {
        let around = (0..9)
            .map(|k| map.clamp([best[0] + f64::from(k % 3 - 1) * step[0], best[1] + f64::from(k / 3 - 1) * step[1]]));
        best = around.fold(best, |best, a| if det(a) > det(best) { a } else { best });
        step = step.map(|s| 0.5 * s);
    }
    det(best)
}

/// The fill at |det| = 0 and at its greatest: amber, and pale.
pub fn colours(palette: &Palette) -> [Rgba; 2] {
    let pale = |share| mix(palette.amber, [1.0, 0.98, 0.92, 1.0], share);
    // The brighter of fill and background says where there is more.
    let dark = palette.background.iter().take(3).sum::<f32>() < 1.5;
    match dark {
        true => [faded(palette.amber, 0.2), faded(pale(0.45), 0.62)],
        false => [faded(palette.amber, 0.6), faded(pale(0.7), 0.6)],
    }
}
