//! Intervals that change along one parameter, from 0 to 1: where one set of them is and another is not. [`outline`]
//! finds the edges of what they cover.

/// An end of an interval at both ends of the parameter; in between it is straight.
pub type Line = [f64; 2];

/// An interval, lower end first.
pub type Interval = [Line; 2];

/// A trapezoid: over a range of the parameter, between two ends that are given at its begin and at its end.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// Range of the parameter, later that of a coordinate.
    pub range: [f64; 2],
    /// Lower and upper end.
    pub ends: Interval,
    /// Whether the first set is there.
    pub is_of_first: bool,
}

fn at([a, b]: Line, share: f64) -> f64 {
    a + share * (b - a)
}

/// Returns where exactly one of two sets is. Intervals of a set may overlap.
pub fn differences(first: &[Interval], second: &[Interval]) -> Vec<Piece> {
    let mut lines: Vec<Line> = first.iter().chain(second).flatten().copied().collect();
    lines.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    lines.dedup();
    // Between crossings the order stays.
    let mut cuts = vec![0.0, 1.0];
    for (i, a) in lines.iter().enumerate() {
        for b in &lines[i + 1..] {
            let (d, e) = (a[0] - b[0], a[1] - b[1]);
            cuts.extend((d * e < 0.0).then(|| d / (d - e)));
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let mut all = Vec::new();
    for cut in cuts.windows(2) {
        let middle = 0.5 * (cut[0] + cut[1]);
        lines.sort_by(|a, b| at(*a, middle).total_cmp(&at(*b, middle)));
        let mut last: Option<(Line, bool)> = None;
        let mut close = |open: Option<(Line, bool)>, high: Line| {
            if let Some((low, is_of_first)) = open {
                let part = |line: Line| [at(line, cut[0]), at(line, cut[1])];
                all.push(Piece { range: [cut[0], cut[1]], ends: [part(low), part(high)], is_of_first });
            }
        };
        for pair in lines.windows(2) {
            let s = 0.5 * (at(pair[0], middle) + at(pair[1], middle));
            let holds = |set: &[Interval]| set.iter().any(|[a, b]| at(*a, middle) < s && s < at(*b, middle));
            let here = match (holds(first), holds(second)) {
                (a, b) if a != b => Some(a),
                _ => None,
            };
            if last.map(|(_, of)| of) != here {
                close(last.take(), pair[0]);
                last = here.map(|of| (pair[0], of));
            }
        }
        if let Some(end) = lines.last() {
            close(last, *end);
        }
    }
    all
}

/// Returns the edges of trapezoids beside each other, as pairs of points (end, coordinate); an edge shorter than `same`
/// is left out.
pub fn outline(pieces: &[Piece], same: f64) -> Vec<[[f64; 2]; 2]> {
    let mut edges = Vec::new();
    for piece in pieces {
        let [from, to] = piece.range;
        edges.extend(piece.ends.map(|[a, b]| [[a, from], [b, to]]));
    }
    let mut levels: Vec<f64> = pieces.iter().flat_map(|piece| piece.range).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    for level in levels {
        let at = |side: usize| {
            let here = pieces.iter().filter(move |piece| piece.range[1 - side] == level);
            here.map(move |piece| piece.ends.map(|end| [end[1 - side]; 2])).collect::<Vec<Interval>>()
        };
        let open = differences(&at(0), &at(1)).into_iter().map(|piece| piece.ends.map(|end| end[0]));
        edges.extend(open.filter(|[a, b]| b - a > same).map(|ends| ends.map(|s| [s, level])));
    }
    edges
}
