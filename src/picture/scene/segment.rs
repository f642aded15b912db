//! Where a segment on the screen runs.

/// Whether a segment meets a rectangle: left, top, right and bottom.
pub fn crosses([a, b]: [[f32; 2]; 2], [left, top, right, bottom]: [f32; 4]) -> bool {
    // Interval of the segment, from 0 to 1, that lies between both pairs of sides.
    let mut within = [0.0_f32, 1.0];
    for (from, by, low, high) in [(a[0], b[0] - a[0], left, right), (a[1], b[1] - a[1], top, bottom)] {
        if by.abs() < 1e-6 {
            if from < low || from > high {
                return false;
            }
            continue;
        }
        let ends = [(low - from) / by, (high - from) / by];
        within = [within[0].max(ends[0].min(ends[1])), within[1].min(ends[0].max(ends[1]))];
    }
    within[0] <= within[1]
}
