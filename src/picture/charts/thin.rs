//! Fewer points for the same line, as far as an eye can tell.

/// The points of a line that those left out lie no further than `tolerance` from; the first and the last are kept.
///
/// From each point that is kept a wedge of directions narrows with every point passed by, to those whose ray comes
/// close enough to all of them; a point outside it, or one that turns back, begins the next stretch. One pass.
pub fn thinned(points: &[[f32; 2]], tolerance: f32) -> Vec<[f32; 2]> {
    let mut kept = Vec::with_capacity(points.len().min(256));
    let Some((&first, rest)) = points.split_first() else { return kept };
    kept.push(first);
    let mut wedge = Wedge::from(first);
    let mut last = first;
    for &point in rest {
        if !wedge.takes(point, tolerance) {
            kept.push(last);
            wedge = Wedge::from(last);
            wedge.takes(point, tolerance);
        }
        last = point;
    }
    if !rest.is_empty() {
        kept.push(last);
    }
    kept
}

/// Directions from a point, as angles from the first of them.
struct Wedge {
    from: [f32; 2],
    middle: Option<[f32; 2]>,
    least: f32,
    most: f32,
    furthest: f32,
}

impl Wedge {
    fn from(from: [f32; 2]) -> Self {
        Self { from, middle: None, least: -1.0, most: 1.0, furthest: 0.0 }
    }

    /// Whether a line from here to the point passes by all before it.
    fn takes(&mut self, [x, y]: [f32; 2], tolerance: f32) -> bool {
        let [x, y] = [x - self.from[0], y - self.from[1]];
        let away = x.hypot(y);
        if away <= tolerance {
            // As good as here, unless the line has been further off.
            return self.furthest <= tolerance;
        }
        let [along, up] = *self.middle.get_or_insert([x / away, y / away]);
        let angle = f32::atan2(along * y - up * x, along * x + up * y);
        let taken = angle >= self.least && angle <= self.most && away >= self.furthest - tolerance;
        if taken {
            let half = (tolerance / away).asin();
            (self.least, self.most) = (self.least.max(angle - half), self.most.min(angle + half));
            self.furthest = self.furthest.max(away);
        }
        taken
    }
}
