//! The points of a task: A, those between, B; and the changes that move, add, remove and reorder them.

use super::choices::TaskKind;
use super::task::{Task, TaskChange};
use stillbase_mechanics::planar::Vector;

/// Returns the name of a point of a path of `count` points: A, 1, 2 … B.
pub(crate) fn name_of_point(point: usize, count: usize) -> String {
    match point {
        0 => "A".into(),
        i if i + 1 >= count => "B".into(),
        i => i.to_string(),
    }
}

impl Task {
    /// Returns the points that the task visits, in order, A first and B last, m. A task that turns the base visits A alone.
    pub fn points(&self) -> Vec<Vector> {
        let mut points = self.stated_points();
        points.truncate(if self.kind == TaskKind::TurnBase { 1 } else { points.len() });
        points
    }

    fn stated_points(&self) -> Vec<Vector> {
        let all = std::iter::once(&self.from).chain(&self.via).chain(std::iter::once(&self.to));
        all.map(|p| Vector::new(p[0], p[1])).collect()
    }

    /// Returns the name of a point: A, 1, 2 … B.
    pub fn name_of(&self, point: usize) -> String {
        name_of_point(point, self.via.len() + 2)
    }

    /// Returns the change that sets these points, m; `None` for fewer than two.
    pub fn visiting(points: &[Vector]) -> Option<TaskChange> {
        let [from, via @ .., to] = points else { return None };
        let pair = |p: &Vector| toml::Value::Array(vec![p.re.into(), p.im.into()]);
        let via = via.iter().map(pair).collect();
        Some(
            [("from", pair(from)), ("via", toml::Value::Array(via)), ("to", pair(to))].map(owned).into_iter().collect(),
        )
    }

    /// Returns the stated points, m, unless the task follows samples.
    fn movable(&self) -> Option<Vec<Vector>> {
        self.samples.is_none().then(|| self.stated_points())
    }

    /// Returns the stated points, m, if they may become more, fewer, or others in order.
    fn countable(&self) -> Option<Vec<Vector>> {
        self.movable().filter(|points| points.len() == self.points().len())
    }

    /// Returns the task with a point moved to `to`, m, or `None` if it follows samples or has no such point.
    pub fn moved(&self, point: usize, to: Vector) -> Option<Self> {
        let mut points = self.movable()?;
        *points.get_mut(point)? = to;
        let mut places = points.iter().map(|p| [p.re, p.im]);
        let (from, to) = (places.next()?, places.next_back()?);
        Some(Self { from, via: places.collect(), to, ..self.clone() })
    }

    /// Returns the change that moves a point to `to`, m. This and the next three methods return `None` if the task
    /// follows samples.
    pub fn moving(&self, point: usize, to: Vector) -> Option<TaskChange> {
        let mut points = self.movable()?;
        *points.get_mut(point)? = to;
        Self::visiting(&points)
    }

    /// Returns the change that adds a point, m, where it lengthens the polyline through all points least.
    pub fn adding(&self, p: Vector) -> Option<TaskChange> {
        let mut points = self.countable()?;
        let detour = |i: &usize| {
            let (a, b) = (points[*i], points[i + 1]);
            (p - a).norm() + (b - p).norm() - (b - a).norm()
        };
        let place = (0..points.len() - 1).min_by(|i, j| detour(i).total_cmp(&detour(j)))?;
        points.insert(place + 1, p);
        Self::visiting(&points)
    }

    /// Returns the change that removes a point; `None` if there are only two.
    pub fn removing(&self, point: usize) -> Option<TaskChange> {
        let mut points = self.countable()?;
        if points.len() <= 2 || point >= points.len() {
            return None;
        }
        points.remove(point);
        Self::visiting(&points)
    }

    /// Returns the change that visits a point one place earlier.
    pub fn advancing(&self, point: usize) -> Option<TaskChange> {
        let mut points = self.countable()?;
        if point == 0 || point >= points.len() {
            return None;
        }
        points.swap(point - 1, point);
        Self::visiting(&points)
    }

    /// Returns the change that sets the points of a curve drawn with the pointer, m.
    pub fn drawing(points: &[Vector]) -> Option<TaskChange> {
        // Few enough points for a file, and enough to keep the shape of the drawn curve.
        let every = points.len().div_ceil(400).max(1);
        let mut thin: Vec<Vector> = points.iter().step_by(every).copied().collect();
        thin.extend(points.last().filter(|last| thin.last() != Some(last)));
        let mut change = Self::visiting(&thin)?;
        change.insert("shape".into(), "freehand".into());
        change.insert("samples".into(), "default".into());
        Some(change)
    }
}

fn owned((key, value): (&str, toml::Value)) -> (String, toml::Value) {
    (key.into(), value)
}
