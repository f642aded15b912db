//! [`GraphCut`]: points at which the graphs are split into arcs.

use std::f64::consts::PI;

use super::few::SmallList;
use super::lifts::lifts;
use super::{Quadrilateral, bend};
use crate::reactionless::plane::AngleLimit;
use stillbase_mechanics::planar::{Vector, unit};

/// Folds outside the bounds of β by less than this are still included, rad.
const BOUND_MARGIN_RAD: f64 = 1e-3;
/// Capacity: 4 intersections with limits, 2 flat poses, 6 folds; each may be found several times where some merge.
pub(super) const CUTS: usize = 36;

/// A point at which a graph is split, α modulo 2π. Superfluous ones do no harm.
#[derive(Clone, Copy, Debug)]
pub(super) struct GraphCut {
    pub alpha: f64,
    /// β modulo 2π; `None` to take it from the graph.
    pub beta: Option<f64>,
    /// Whether β is at a bound.
    pub edge: bool,
}

impl Quadrilateral {
    /// Returns all points at which the graphs are split.
    pub(super) fn cuts(&self) -> SmallList<GraphCut, CUTS> {
        let mut cuts = SmallList::new(GraphCut { alpha: 0.0, beta: None, edge: false });
        self.limit_crossings(|alpha, beta| cuts.push(GraphCut { alpha, beta: Some(beta), edge: true }));
        // Where an end of the feasible α is a flat pose, both graphs touch and have a corner.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9 * self.size();
        if near(self.r + self.y, self.m + self.x) {
            cuts.push(GraphCut { alpha: 0.0, beta: None, edge: false });
        }
        if near((self.r - self.y).abs(), (self.m - self.x).abs()) {
            cuts.push(GraphCut { alpha: PI, beta: None, edge: false });
        }
        // Folds outside the limits need no split.
        let AngleLimit { min, max } = self.limits[1];
        let wide = AngleLimit { min: min - BOUND_MARGIN_RAD, max: max + BOUND_MARGIN_RAD };
        self.folds(|alpha, beta| {
            if beta.is_none_or(|beta| lifts(beta, wide).next().is_some()) {
                cuts.push(GraphCut { alpha, beta, edge: false });
            }
        });
        cuts
    }

    /// Finds where β is at a bound, from the triangle of arm x, the vector to the point, and the other two arms held
    /// rigid.
    fn limit_crossings(&self, mut push: impl FnMut(f64, f64)) {
        let Self { m, x, y, r, .. } = *self;
        for beta in [self.limits[1].min, self.limits[1].max] {
            let e = unit(beta);
            let rigid = Vector::new(m + y * e.re, y * e.im);
            let length = rigid.norm();
            if x > 0.0 && r <= length + x && r >= (length - x).abs() {
                let (arg, angle) = (rigid.im.atan2(rigid.re), bend(length, x, r));
                push(arg + angle, beta);
                push(arg - angle, beta);
            }
        }
    }
}
