//! The interior of a workspace: the number of poses of a point, and the curves across which it changes.

use super::Boundary;
use super::arrangement::{Arrangement, SpanPart};
use super::line::{BoundaryLine, BoundaryVertex};
use super::span::BoundaryCurve;
use stillbase_mechanics::planar::{Vector, unit};

impl Boundary {
    /// Returns the number of poses within the limits that put the end effector on p, m, on the plane b, rad. It is the
    /// winding number of all limits and folds about p; poses are only computed for a region without area.
    ///
    /// On a fold or a limit, within 1e-12 m, it is the number on one of its sides. Elsewhere it equals the number of
    /// poses from [`PlaneMap::poses`](crate::reactionless::PlaneMap::poses).
    pub fn pose_count(&self, p: Vector, b: f64) -> usize {
        if !(p.re.is_finite() && p.im.is_finite() && b.is_finite()) {
            return 0;
        }
        if self.flat {
            return self.on.map.poses(p, b).len();
        }
        let count = self.cycle.poses_at(&self.on, p * unit(-self.on.map.turn(b)));
        count.max(0) as usize
    }

    /// Returns the largest number of poses of any point, except on the curves themselves.
    pub fn max_pose_count(&self) -> usize {
        let most = self.strands.iter().map(|s| s.left.max(s.right)).max();
        most.unwrap_or(1).max(1) as usize
    }

    /// Returns the areas of the points with at least 1, 2, 3, … poses, m². The first is [`area`](Self::area), their sum
    /// [`sheet_area`](Self::sheet_area). As with the boundary, parts may be missing for machines whose special
    /// proportions make whole curves coincide.
    pub fn areas_by_poses(&self) -> Vec<f64> {
        let arrangement = Arrangement::of(&self.on, &self.cycle);
        let swept = |p: &SpanPart| self.on.swept(&self.cycle.spans[p.span], p.from, p.to);
        let area = |n: i32| arrangement.level(&self.strands, n).iter().map(swept).sum();
        (1..=self.max_pose_count() as i32).map(area).collect()
    }

    /// Returns the folds: the complete images of det ∂(x, y)/∂(a_1, a_2) = 0 within the limits, on the boundary or
    /// inside. Two poses merge on a fold, and folds turn back at [`cusps`](Self::cusps).
    pub fn fold_curves(&self) -> Vec<BoundaryLine> {
        let spans = &self.cycle.spans;
        let mut chains: Vec<Vec<SpanPart>> = Vec::new();
        for (i, span) in spans.iter().enumerate().filter(|(_, s)| s.curve == BoundaryCurve::Fold && !self.flat) {
            let portion = SpanPart { span: i, from: 0.0, to: 1.0 };
            let follows = |last: &SpanPart| last.span + 1 == i && spans[last.span].ends[1] == span.ends[0];
            match chains.last_mut() {
                Some(chain) if chain.last().is_some_and(follows) => chain.push(portion),
                _ => chains.push(vec![portion]),
            }
        }
        chains.iter().map(|chain| BoundaryLine::of(&self.on, spans, chain)).collect()
    }

    /// Returns the cusps of the folds, at which three poses merge.
    pub fn cusps(&self) -> &[BoundaryVertex] {
        &self.cusps
    }

    /// Returns the images of limits inside the workspace, across which the number of poses changes by one, split at
    /// intersections.
    pub fn inner_limits(&self) -> Vec<BoundaryLine> {
        let spans = &self.cycle.spans;
        let is_limit = |p: &SpanPart| spans[p.span].curve != BoundaryCurve::Fold;
        let inner = self.strands.iter().filter(|s| s.right > 0 && s.parts.iter().all(is_limit));
        inner.map(|s| BoundaryLine::of(&self.on, spans, &s.parts)).collect()
    }
}
