//! Dashed lines: the viewer has none, so they are divided into strips.

/// Divides a polyline into dashes and gaps of about the given length, and returns the dashes. The line begins and ends
/// with a dash, and the number of dashes and gaps is at most `most` plus one.
pub fn dashed(line: &[[f32; 3]], length: f32, most: f32) -> Vec<Vec<[f32; 3]>> {
    let away = |p: [f32; 3], q: [f32; 3]| [0, 1, 2].map(|i| q[i] - p[i]).iter().map(|d| d * d).sum::<f32>().sqrt();
    let whole: f32 = line.windows(2).map(|w| away(w[0], w[1])).sum();
    let Some(&first) = line.first() else { return Vec::new() };
    // Odd, so that the line ends with a dash.
    let parts = 2.0 * (0.5 * (whole / length.max(1e-9)).min(most)).floor() + 1.0;
    let part = whole / parts;
    let (mut dashes, mut open, mut remaining) = (vec![vec![first]], true, part);
    for w in line.windows(2) {
        let [mut from, to] = [w[0], w[1]];
        let mut way = away(from, to);
        // The bound prevents rounding errors from ending the last dash early.
        while way > remaining && dashes.len() as f32 <= 0.5 * parts {
            let share = remaining / way;
            from = [0, 1, 2].map(|i| from[i] + share * (to[i] - from[i]));
            way -= remaining;
            remaining = part;
            match (open, dashes.last_mut()) {
                (true, Some(dash)) => dash.push(from),
                _ => dashes.push(vec![from]),
            }
            open = !open;
        }
        remaining -= way;
        if let (true, Some(dash)) = (open, dashes.last_mut()) {
            dash.push(to);
        }
    }
    dashes
}
