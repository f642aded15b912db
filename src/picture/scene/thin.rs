//! Simplification of polylines within a tolerance.

/// Returns a simplified polyline; no omitted point is further than `tolerance` from it. The first and last points are
/// kept.
///
/// Each kept point has a wedge of directions whose rays pass all later points within the tolerance. The wedge narrows
/// with every point. If a point is outside the wedge or turns back, the one before is kept. Takes one pass.
pub fn simplify_line(points: &[[f32; 2]], tolerance: f32) -> Vec<[f32; 2]> {
    let mut kept = Vec::with_capacity(points.len().min(256));
    for_each_kept(points, tolerance, |i| kept.push(points[i]));
    kept
}

/// Calls `keep` with the index of each point that [`simplify_line`] keeps, in order.
pub fn for_each_kept(points: &[[f32; 2]], tolerance: f32, mut keep: impl FnMut(usize)) {
    let Some(&first) = points.first() else { return };
    keep(0);
    let mut wedge = Wedge::from(first);
    for (i, &point) in points.iter().enumerate().skip(1) {
        if !wedge.takes(point, tolerance) {
            keep(i - 1);
            wedge = Wedge::from(points[i - 1]);
            wedge.takes(point, tolerance);
        }
    }
    if points.len() > 1 {
        keep(points.len() - 1);
    }
}

/// Wedge of directions from a point; angles, rad, are relative to the direction of the first later point.
struct Wedge {
    from: [f32; 2],
    reference: Option<[f32; 2]>,
    min_angle: f32,
    max_angle: f32,
    furthest: f32,
}

impl Wedge {
    fn from(from: [f32; 2]) -> Self {
        Self { from, reference: None, min_angle: -1.0, max_angle: 1.0, furthest: 0.0 }
    }

    /// Whether the segment to the point passes all earlier points within the tolerance; if so, narrows the wedge.
    fn takes(&mut self, [x, y]: [f32; 2], tolerance: f32) -> bool {
        let [x, y] = [x - self.from[0], y - self.from[1]];
        let away = x.hypot(y);
        if away <= tolerance {
            // The point coincides with the start within the tolerance; accepted unless the line has been further off.
            return self.furthest <= tolerance;
        }
        let [along, up] = *self.reference.get_or_insert([x / away, y / away]);
        let angle = f32::atan2(along * y - up * x, along * x + up * y);
        let taken = angle >= self.min_angle && angle <= self.max_angle && away >= self.furthest - tolerance;
        if taken {
            let half = (tolerance / away).asin();
            (self.min_angle, self.max_angle) = (self.min_angle.max(angle - half), self.max_angle.min(angle + half));
            self.furthest = self.furthest.max(away);
        }
        taken
    }
}
