//! Ranges of plots in which the viewer writes at least two numbers beside its axis.
//!
//! The viewer writes numbers at multiples of a power of ten only, and none where they would stand closer than a line of
//! text. So a range from −5 to 5 in a low plot has a 0 and nothing else.

/// Largest number of steps of a power of ten that the viewer labels in a plot as high as a window of usual size.
const MAX_STEPS: f64 = 28.0;

/// Margin above and below the values, as a fraction of the range.
const MARGIN: f64 = 0.06;

/// Returns a range with a margin, widened until the viewer writes two numbers at least; `rows` plots of equal height
/// stand one above the other. A range that is symmetric about zero stays so.
pub fn with_ticks([low, high]: [f64; 2], rows: usize) -> [f64; 2] {
    let margin = MARGIN * (high - low);
    let (mut from, mut to) = (low - margin, high + margin);
    let step = step(to - from, rows);
    let is_symmetric = low == -high;
    while (to / step).floor() - (from / step).ceil() < 1.0 {
        // A little more, so that the number is not cut off at the edge.
        let above = ((to / step).floor() + 1.0 + MARGIN) * step;
        let below = ((from / step).ceil() - 1.0 - MARGIN) * step;
        if is_symmetric {
            (from, to) = (-above, above);
        } else if above - to <= from - below {
            to = above;
        } else {
            from = below;
        }
    }
    [from, to]
}

/// Returns the smallest power of ten at whose multiples a plot of some length has numbers.
fn step(length: f64, rows: usize) -> f64 {
    10f64.powf((length * rows.max(1) as f64 / MAX_STEPS).log10().ceil())
}
