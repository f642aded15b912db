//! What a change of the points of a task does to them, in words.

use toml::{Table, Value};

use crate::scenario::name_of_point;
use stillbase_settings::change::number;

/// Keys of the points.
pub const POINT_KEYS: [&str; 3] = ["from", "via", "to"];
/// Maximum number of points that are named with their places.
const MAX_NAMED: usize = 3;
/// Points nearer than this are equal, m.
const EQUAL_BELOW_M: f64 = 1e-9;

type Point = [f64; 2];

/// Describes a change of a task that sets points; `before` are the same settings before the change, if they are known.
pub fn title(change: &Table, before: Option<&Table>) -> String {
    let known = before.and_then(|before| Some((points(before)?, points(change)?)));
    match known {
        _ if change.get("shape").and_then(Value::as_str) == Some("freehand") => {
            let count = points(change).map_or(0, |points| points.len());
            format!("draw a path of {count} points")
        }
        Some((old, new)) => between(&old, &new),
        None => to(change),
    }
}

/// Describes the new places alone.
fn to(change: &Table) -> String {
    let Some(points) = points(change) else {
        let end = |(key, name): (&str, &str)| Some(format!("{name} to {}", place(point(change.get(key)?)?)));
        let ends: Vec<String> = [("from", "A"), ("to", "B")].into_iter().filter_map(end).collect();
        return if ends.is_empty() { "move points of the path".into() } else { format!("move {}", ends.join(" and ")) };
    };
    let named = |(i, at): (usize, &Point)| format!("{} at {}", name_of_point(i, points.len()), place(*at));
    match points.len() {
        0..=MAX_NAMED => format!("put {}", points.iter().enumerate().map(named).collect::<Vec<_>>().join(", ")),
        count => format!("take a path of {count} points"),
    }
}

/// Describes what leads from some points to others.
fn between(old: &[Point], new: &[Point]) -> String {
    let all = new.len();
    if all == old.len() {
        let moved: Vec<usize> = (0..all).filter(|i| !equal(old[*i], new[*i])).collect();
        let of = |i: &usize| format!("{} from {} to {}", name_of_point(*i, all), bare(old[*i]), place(new[*i]));
        return match moved.as_slice() {
            [] => "points as they were".into(),
            [i, j] if j - i == 1 && equal(old[*i], new[*j]) && equal(old[*j], new[*i]) => {
                format!("visit {} before {}", name_of_point(*j, all), name_of_point(*i, all))
            }
            few if few.len() <= MAX_NAMED => format!("move {}", few.iter().map(of).collect::<Vec<_>>().join(" and ")),
            many => format!("move {} points of {all}", many.len()),
        };
    }
    let first_other = old.iter().zip(new).take_while(|(a, b)| equal(**a, **b)).count();
    let rest_is_equal = |long: &[Point], short: &[Point]| {
        long[first_other + 1..].iter().zip(&short[first_other..]).all(|(a, b)| equal(*a, *b))
    };
    if all == old.len() + 1 && rest_is_equal(new, old) {
        return format!("add point {} at {}", name_of_point(first_other, all), place(new[first_other]));
    }
    if all + 1 == old.len() && rest_is_equal(old, new) {
        return format!("leave out point {} at {}", name_of_point(first_other, old.len()), place(old[first_other]));
    }
    format!("take a path of {all} points in place of {}", old.len())
}

/// Returns all points that a task states; `None` without both ends.
fn points(task: &Table) -> Option<Vec<Point>> {
    let via = match task.get("via") {
        Some(Value::Array(via)) => via.iter().map(point).collect::<Option<Vec<Point>>>()?,
        _ => Vec::new(),
    };
    let ends = [point(task.get("from")?)?, point(task.get("to")?)?];
    Some([vec![ends[0]], via, vec![ends[1]]].concat())
}

fn point(value: &Value) -> Option<Point> {
    let [x, y] = value.as_array()?.as_slice() else { return None };
    Some([number(x)?, number(y)?])
}

fn equal(a: Point, b: Point) -> bool {
    (a[0] - b[0]).hypot(a[1] - b[1]) < EQUAL_BELOW_M
}

fn bare([x, y]: Point) -> String {
    format!("{x:.3}, {y:.3}")
}

fn place(at: Point) -> String {
    format!("{} m", bare(at))
}
