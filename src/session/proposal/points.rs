//! Points and a pose constant b that can be reached, near others that cannot. A task, `pose` and `reach` propose them.

use crate::scenario::POSE_CONSTANT_RANGE;
use stillbase_mechanics::planar::Vector;
use stillbase_planning::common::{common_b_set, nearest_common_place, nearest_place, no_common};
use stillbase_planning::pose_constant::NoCommonB;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::Decimal;

/// Fractions of an interval of b by which a b is moved inside, in the order of the trials.
const INWARDS: [f64; 5] = [0.0, 1e-9, 1e-6, 1e-3, 0.5];

/// What changes so that points can be reached.
#[derive(Clone, Debug, PartialEq)]
pub struct ReachablePoints {
    /// Each point that moves: its index, counted from 0, and its new place as printed, m.
    pub moved: Vec<(usize, [Decimal; 2])>,
    /// The new b, rad; `None` if it stays, or if none was asked for.
    pub b: Option<Decimal>,
}

impl ReachablePoints {
    /// Returns the values of b, rad, at which a point, m, can be reached: the nearest one and, if that is far away, before
    /// it the same one a number of whole periods nearer to 0.
    pub fn at_nearest_b(space: &PoseSpace, p: Vector, b: f64) -> Vec<Self> {
        let nearest = nearest_b(space, p, b);
        let first = nearest.and_then(|b| in_first_period(space, &[p], b));
        first.into_iter().chain(nearest).map(|b| Self { moved: Vec::new(), b: Some(b) }).collect()
    }

    /// Returns the place nearest to point `i`, m, that can be reached at b, rad.
    pub fn at_b(space: &PoseSpace, points: &[Vector], i: usize, b: f64) -> Option<Self> {
        Some(Self { moved: vec![(i, nearest_place(space, *points.get(i)?, Some(b))?)], b: None })
    }

    /// Returns the place nearest to a point, m, that can be reached at any b, with the b there that is nearest to `b`,
    /// rad.
    pub fn at_any_b(space: &PoseSpace, p: Vector, b: f64) -> Option<Self> {
        let to = nearest_place(space, p, None)?;
        let nearest = nearest_b(space, place(&to), b)?;
        Some(Self { moved: vec![(0, to)], b: in_first_period(space, &[place(&to)], nearest).or(Some(nearest)) })
    }

    /// Returns the shortest move of point `i`, m, after which it shares a b with all others, and that b.
    pub fn shared_by(space: &PoseSpace, points: &[Vector], i: usize) -> Option<Self> {
        let shown = nearest_common_place(space, points, i)?.shown?;
        Some(Self { moved: vec![(i, shown.to)], b: Some(shown.b) })
    }

    /// Returns the move of one point that gives all points a common b, and that b.
    pub fn mended(why: &NoCommonB) -> Option<Self> {
        let correction = why.correction?;
        let shown = correction.shown?;
        Some(Self { moved: vec![(correction.point, shown.to)], b: Some(shown.b) })
    }

    /// Returns moves after which all points, m, share a b: each point that cannot be reached at any b moves to the
    /// nearest place that can. If no b serves them all then, one point moves further. `None` if that does not help.
    pub fn with_common_b(space: &PoseSpace, points: &[Vector]) -> Option<Self> {
        let unreached = (0..points.len()).filter(|i| space.reach(points[*i]).is_err());
        let places = unreached.map(|i| Some((i, nearest_place(space, points[i], None)?)));
        let mut found = Self { moved: places.collect::<Option<_>>()?, b: None };
        let now = found.applied(points);
        if common_b_set(space, &now).is_none() {
            let further = Self::mended(&no_common(space, &now)?)?;
            found.moved.retain(|(i, _)| further.moved.iter().all(|(moved, _)| moved != i));
            found.moved.extend(further.moved);
            found.moved.sort_by_key(|(i, _)| *i);
            common_b_set(space, &found.applied(points))?;
        }
        Some(found)
    }

    /// Returns the new place of a point as printed, m; `None` if it stays.
    pub fn place_of(&self, point: usize) -> Option<&[Decimal; 2]> {
        self.moved.iter().find(|(i, _)| *i == point).map(|(_, to)| to)
    }

    /// Returns the points, m, with those moved that move.
    pub fn applied(&self, points: &[Vector]) -> Vec<Vector> {
        points.iter().enumerate().map(|(i, p)| self.place_of(i).map_or(*p, place)).collect()
    }

    /// Says which points move and where: `move A to (0.50, 0.60) m`; `name` returns the name of a point.
    pub fn moves_in_words(&self, name: &dyn Fn(usize) -> String) -> String {
        let moves: Vec<String> = self.moved.iter().map(|(i, [x, y])| format!("{} to ({x}, {y}) m", name(*i))).collect();
        format!("move {}", moves.join(" and "))
    }
}

/// Returns a b, rad, at which points, m, can be reached, as a number in the first period, from 0 on, as printed. Returns
/// `None` if b is within half a period of it.
pub(super) fn in_first_period(space: &PoseSpace, points: &[Vector], b: Decimal) -> Option<Decimal> {
    let turns = (b.value() / space.period()).floor();
    let is_far = (b.value() / space.period() - 0.5).abs() > 1.0;
    let serves = |b: f64| points.iter().all(|p| space.reaches(*p, b));
    is_far.then(|| Decimal::shortest_passing(b.value() - turns * space.period(), 4, serves)).flatten()
}

/// Returns the place as a vector, m.
fn place([x, y]: &[Decimal; 2]) -> Vector {
    Vector::new(x.value(), y.value())
}

/// Returns the b nearest to `b`, rad, in the range of tasks, at which a point, m, can be reached as printed.
fn nearest_b(space: &PoseSpace, p: Vector, b: f64) -> Option<Decimal> {
    let set = space.reach(p).ok()?;
    let inner = INWARDS.map(|share| set.nearest(b).map(|b| set.moved_inside(b, share)));
    // At the ends of the range of b, the nearest one may lie a period inside.
    let turns = [0.0, -space.period(), space.period()];
    let all = turns.into_iter().flat_map(|turn| inner.into_iter().flatten().map(move |b| b + turn));
    let serves = |b: f64| POSE_CONSTANT_RANGE.contains(b) && space.reaches(p, b);
    all.into_iter().find_map(|b| Decimal::shortest_passing(b, 4, serves))
}
