//! Dashed lines: the viewer has none, so they are cut into strips.

/// A line cut into dashes and gaps, each about as long as given, in its own units. It begins and ends with a dash,
/// and has no more parts than `most`.
pub fn dashed(line: &[[f32; 3]], length: f32, most: f32) -> Vec<Vec<[f32; 3]>> {
    let away = |p: [f32; 3], q: [f32; 3]| [0, 1, 2].map(|i| q[i] - p[i]).iter().map(|d| d * d).sum::<f32>().sqrt();
    let whole: f32 = line.windows(2).map(|w| away(w[0], w[1])).sum();
    let Some(&first) = line.first() else { return Vec::new() };
    // An odd number of parts.
    let parts = 2.0 * (0.5 * (whole / length.max(1e-9)).min(most)).floor() + 1.0;
    let part = whole / parts;
    let (mut dashes, mut open, mut left) = (vec![vec![first]], true, part);
    for w in line.windows(2) {
        let [mut from, to] = [w[0], w[1]];
        let mut way = away(from, to);
        // Rounding must not end the last dash before its end.
        while way > left && dashes.len() as f32 <= 0.5 * parts {
            let share = left / way;
            from = [0, 1, 2].map(|i| from[i] + share * (to[i] - from[i]));
            way -= left;
            left = part;
            match (open, dashes.last_mut()) {
                (true, Some(dash)) => dash.push(from),
                _ => dashes.push(vec![from]),
            }
            open = !open;
        }
        left -= way;
        if let (true, Some(dash)) = (open, dashes.last_mut()) {
            dash.push(to);
        }
    }
    dashes
}
