//! What lies on the sides of curves in slivers too thin to be sampled: it follows from the curves that they meet.
//!
//! The curves that bound the points of at least n poses are closed: at each node as many of them end as begin. Where a
//! fold cuts off a corner of the limits, the sides of the long curves around are known and this leaves few answers for
//! the short ones between. Of these the one nearest to what was sampled beside the sliver is right, since of two curves
//! in one sliver the longer also runs where the other does not.

/// More curves than these are not told apart: only machines whose curves coincide have as many.
const MAX_CURVES: usize = 12;
/// Choices looked at.
const PATIENCE: usize = 20_000;

/// A curve from node to node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub ends: [usize; 2],
    /// How many more poses reach its left side than its right.
    pub weight: i32,
    /// Poses to its left and to its right, as sampled.
    pub sides: [i32; 2],
    pub length: f64,
}

impl Course {
    fn is_unclear(&self) -> bool {
        self.sides[0] - self.sides[1] != self.weight
    }

    /// By how much the sides differ from those sampled if `right` is right, all along.
    fn change(&self, right: i32) -> f64 {
        let off = [right + self.weight, right].into_iter().zip(self.sides).map(|(to, from)| (to - from).abs());
        self.length * f64::from(off.sum::<i32>())
    }
}

/// The sides of all courses, those that were unclear such that every level closes; as they were if none do.
pub(super) fn settle(courses: &mut [Course]) {
    let mut unclear: Vec<usize> = (0..courses.len()).filter(|&i| courses[i].is_unclear()).collect();
    if unclear.is_empty() || unclear.len() > MAX_CURVES {
        return;
    }
    // The longest first: they cost most, so that the search ends early.
    unclear.sort_by(|&i, &j| courses[j].length.total_cmp(&courses[i].length));
    let levels = courses.iter().flat_map(|c| c.sides).max().unwrap_or(0).max(0) as usize + 3;
    let nodes = courses.iter().flat_map(|c| c.ends).max().map_or(0, |last| last + 1);
    let mut search = Search {
        levels,
        net: vec![0; nodes * levels],
        open: vec![0; nodes],
        chosen: vec![0; unclear.len()],
        best: None,
        patience: PATIENCE,
    };
    for course in courses.iter().filter(|c| !c.is_unclear()) {
        search.put(course, course.sides[1], 1);
    }
    for &i in &unclear {
        courses[i].ends.into_iter().for_each(|node| search.open[node] += 1);
    }
    // Nodes that do not close without the unclear ones are nothing that these could mend.
    let touched = |node: usize| unclear.iter().any(|&i| courses[i].ends.contains(&node));
    if (0..nodes).any(|node| !touched(node) && !search.closes(node)) {
        return;
    }
    let list: Vec<Course> = unclear.iter().map(|&i| courses[i]).collect();
    search.from(&list, 0, 0.0);
    if let Some((_, rights)) = search.best {
        for (&i, right) in unclear.iter().zip(rights) {
            courses[i].sides = [right + courses[i].weight, right];
        }
    }
}

struct Search {
    levels: usize,
    /// For each node and level, how many more courses begin there than end.
    net: Vec<i32>,
    /// Courses at each node that are still to choose.
    open: Vec<usize>,
    chosen: Vec<i32>,
    /// Change, and the right side of each.
    best: Option<(f64, Vec<i32>)>,
    patience: usize,
}

impl Search {
    fn put(&mut self, course: &Course, right: i32, sign: i32) {
        for level in right.max(0)..(right + course.weight).min(self.levels as i32) {
            self.net[course.ends[0] * self.levels + level as usize] += sign;
            self.net[course.ends[1] * self.levels + level as usize] -= sign;
        }
    }

    fn closes(&self, node: usize) -> bool {
        self.net[node * self.levels..(node + 1) * self.levels].iter().all(|&n| n == 0)
    }

    fn from(&mut self, list: &[Course], place: usize, change: f64) {
        if self.patience == 0 || self.best.as_ref().is_some_and(|(least, _)| change >= *least) {
            return;
        }
        self.patience -= 1;
        let Some(course) = list.get(place) else {
            self.best = Some((change, self.chosen.clone()));
            return;
        };
        let most = course.sides[0].max(course.sides[1]) + 1;
        let least = (course.sides[0].min(course.sides[1]) - course.weight).max(0);
        course.ends.into_iter().for_each(|node| self.open[node] -= 1);
        // From the most poses down: where nothing else decides, a sliver is reached once more, not once less.
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
