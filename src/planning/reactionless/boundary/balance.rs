//! Numbers of poses on the sides of curves in slivers that are too thin to be sampled, from the curves around them.
//!
//! The curves that bound the points of at least n poses are closed: at each node as many of them end as begin. If a
//! fold cuts off a corner of the limits, the sides of the long curves around it are known. This leaves few solutions
//! for the short curves between. The one nearest to the samples beside the sliver is right, since of two curves in one
//! sliver the longer also runs where the other does not.

/// Maximum number of unresolved curves; only machines with coinciding curves have more.
const MAX_UNCLEAR: usize = 12;
/// Maximum number of choices that are tried.
const MAX_CHOICES: usize = 20_000;

/// A curve between two nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurveEdge {
    pub ends: [usize; 2],
    /// Number of poses on its left minus that on its right.
    pub weight: i32,
    /// Sampled numbers of poses on its left and on its right.
    pub sides: [i32; 2],
    pub length: f64,
}

impl CurveEdge {
    fn is_unclear(&self) -> bool {
        self.sides[0] - self.sides[1] != self.weight
    }

    /// Returns the change against the samples if `right` is the number of poses on the right, weighted by the length.
    fn change(&self, right: i32) -> f64 {
        let off = [right + self.weight, right].into_iter().zip(self.sides).map(|(to, from)| (to - from).abs());
        self.length * f64::from(off.sum::<i32>())
    }
}

/// Resolves the sides of unclear courses such that the curves of every level close; leaves them unchanged if that is
/// impossible.
pub(super) fn resolve_sides(courses: &mut [CurveEdge]) {
    let mut unclear: Vec<usize> = (0..courses.len()).filter(|&i| courses[i].is_unclear()).collect();
    if unclear.is_empty() || unclear.len() > MAX_UNCLEAR {
        return;
    }
    // The longest first: they contribute most to the change, so that branches are pruned early.
    unclear.sort_by(|&i, &j| courses[j].length.total_cmp(&courses[i].length));
    let levels = courses.iter().flat_map(|c| c.sides).max().unwrap_or(0).max(0) as usize + 3;
    let nodes = courses.iter().flat_map(|c| c.ends).max().map_or(0, |last| last + 1);
    let mut search = Search {
        levels,
        net: vec![0; nodes * levels],
        open: vec![0; nodes],
        chosen: vec![0; unclear.len()],
        best: None,
        remaining_choices: MAX_CHOICES,
    };
    for course in courses.iter().filter(|c| !c.is_unclear()) {
        search.put(course, course.sides[1], 1);
    }
    for &i in &unclear {
        courses[i].ends.into_iter().for_each(|node| search.open[node] += 1);
    }
    // If a node does not close where no unclear course ends, there is no solution.
    let touched = |node: usize| unclear.iter().any(|&i| courses[i].ends.contains(&node));
    if (0..nodes).any(|node| !touched(node) && !search.closes(node)) {
        return;
    }
    let list: Vec<CurveEdge> = unclear.iter().map(|&i| courses[i]).collect();
    search.from(&list, 0, 0.0);
    if let Some((_, rights)) = search.best {
        for (&i, right) in unclear.iter().zip(rights) {
            courses[i].sides = [right + courses[i].weight, right];
        }
    }
}

struct Search {
    levels: usize,
    /// For each node and level, the number of courses that begin there minus that of those that end.
    net: Vec<i32>,
    /// Number of undecided courses at each node.
    open: Vec<usize>,
    chosen: Vec<i32>,
    /// The least change, and the number of poses on the right of each course.
    best: Option<(f64, Vec<i32>)>,
    remaining_choices: usize,
}

impl Search {
    fn put(&mut self, course: &CurveEdge, right: i32, sign: i32) {
        for level in right.max(0)..(right + course.weight).min(self.levels as i32) {
            self.net[course.ends[0] * self.levels + level as usize] += sign;
            self.net[course.ends[1] * self.levels + level as usize] -= sign;
        }
    }

    fn closes(&self, node: usize) -> bool {
        self.net[node * self.levels..(node + 1) * self.levels].iter().all(|&n| n == 0)
    }

    fn from(&mut self, list: &[CurveEdge], place: usize, change: f64) {
        if self.remaining_choices == 0 || self.best.as_ref().is_some_and(|(least, _)| change >= *least) {
            return;
        }
        self.remaining_choices -= 1;
        let Some(course) = list.get(place) else {
            self.best = Some((change, self.chosen.clone()));
            return;
        };
        let most = course.sides[0].max(course.sides[1]) + 1;
        let least = (course.sides[0].min(course.sides[1]) - course.weight).max(0);
        course.ends.into_iter().for_each(|node| self.open[node] -= 1);
        // The highest numbers first: among equal changes, a sliver has one pose more rather than one less.
        for right in (least..=most).rev() {
            self.put(course, right, 1);
            self.chosen[place] = right;
            if course.ends.iter().all(|&node| self.open[node] > 0 || self.closes(node)) {
                self.from(list, place + 1, change + course.change(right));
            }
            self.put(course, right, -1);
        }
        course.ends.into_iter().for_each(|node| self.open[node] += 1);
    }
}
