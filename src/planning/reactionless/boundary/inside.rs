//! What lies inside a workspace: how many poses reach a point, and the curves across which their number changes.

use super::Boundary;
use super::arrangement::{Arrangement, Portion};
use super::line::{BoundaryLine, Vertex};
use super::span::BoundaryCurve;
use crate::mechanics::planar::{Vector, unit};

impl Boundary {
    /// How many poses within the limits put the end effector on p, m, on the plane b, rad: the winding number of all
    /// limits and folds about p, without any pose being solved for.
    ///
    /// On a fold or a limit, to 1e-12 m, it is the number on one of its sides. Elsewhere it is how many
    /// [`PlaneMap::poses`](crate::planning::reactionless::PlaneMap::poses) lists.
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

    /// The largest number of poses that reach one point, curves left aside.
    pub fn sheets(&self) -> usize {
        let most = self.strands.iter().map(|s| s.left.max(s.right)).max();
        most.unwrap_or(1).max(1) as usize
    }

    /// Areas of the points that at least 1, 2, 3, … poses reach, m². The first is [`area`](Self::area), their sum
    /// [`sheet_area`](Self::sheet_area). As with the boundary, some may be missing for machines of such special
    /// proportions that whole curves coincide.
    pub fn areas_by_poses(&self) -> Vec<f64> {
        let arrangement = Arrangement::of(&self.on, &self.cycle);
        let swept = |p: &Portion| self.on.swept(&self.cycle.spans[p.span], p.from, p.to);
        let area = |n: i32| arrangement.level(&self.strands, n).iter().map(swept).sum();
        (1..=self.sheets() as i32).map(area).collect()
    }

    /// The folds: images of det ∂(x, y)/∂(a_1, a_2) = 0 within the limits, whole, whether they bound the workspace or
    /// run inside. Two poses meet on them; they turn back at [`cusps`](Self::cusps).
    pub fn fold_curves(&self) -> Vec<BoundaryLine> {
        let spans = &self.cycle.spans;
        let mut chains: Vec<Vec<Portion>> = Vec::new();
        for (i, span) in spans.iter().enumerate().filter(|(_, s)| s.curve == BoundaryCurve::Fold && !self.flat) {
            let portion = Portion { span: i, from: 0.0, to: 1.0 };
            let follows = |last: &Portion| last.span + 1 == i && spans[last.span].ends[1] == span.ends[0];
            match chains.last_mut() {
                Some(chain) if chain.last().is_some_and(follows) => chain.push(portion),
                _ => chains.push(vec![portion]),
            }
        }
        chains.iter().map(|chain| BoundaryLine::of(&self.on, spans, chain)).collect()
    }

    /// Where folds turn back in the workspace: three poses meet.
    pub fn cusps(&self) -> &[Vertex] {
        &self.cusps
    }

    /// Images of limits that run inside the workspace, where one pose more or less reaches a point, from crossing to
    /// crossing.
    pub fn inner_limits(&self) -> Vec<BoundaryLine> {
        let spans = &self.cycle.spans;
        let is_limit = |p: &Portion| spans[p.span].curve != BoundaryCurve::Fold;
        let inner = self.strands.iter().filter(|s| s.right > 0 && s.parts.iter().all(is_limit));
        inner.map(|s| BoundaryLine::of(&self.on, spans, &s.parts)).collect()
    }
}
