//! Derives the numbers of poses on both sides of curves in slivers too thin to be sampled, from the curves around them.
//!
//! The curves that bound the points with at least n poses are closed: at each node as many of them end as begin. If a
//! fold cuts off a corner of the limits, the sides of the long curves around it are known. This leaves few solutions
//! for the short curves between. The one nearest to the samples is right: of two curves in a sliver, the longer extends
//! beyond the other, where it can be sampled.

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

/// Resolves the sides of unclear curves such that the curves of every level close; leaves them unchanged if that is
/// impossible.
pub(super) fn resolve_sides(edges: &mut [CurveEdge]) {
    let mut unclear: Vec<usize> = (0..edges.len()).filter(|&i| edges[i].is_unclear()).collect();
    if unclear.is_empty() || unclear.len() > MAX_UNCLEAR {
        return;
    }
    // The longest first: they contribute most to the change, so that branches are pruned early.
    unclear.sort_by(|&i, &j| edges[j].length.total_cmp(&edges[i].length));
    let levels = edges.iter().flat_map(|c| c.sides).max().unwrap_or(0).max(0) as usize + 3;
    let nodes = edges.iter().flat_map(|c| c.ends).max().map_or(0, |last| last + 1);
    let mut search = Search {
        levels,
        net: vec![0; nodes * levels],
        open: vec![0; nodes],
        chosen: vec![0; unclear.len()],
        best: None,
        remaining_choices: MAX_CHOICES,
    };
    for edge in edges.iter().filter(|c| !c.is_unclear()) {
        search.put(edge, edge.sides[1], 1);
    }
    for &i in &unclear {
        edges[i].ends.into_iter().for_each(|node| search.open[node] += 1);
    }
    // If a node without unclear curves does not close, there is no solution.
    let touched = |node: usize| unclear.iter().any(|&i| edges[i].ends.contains(&node));
    if (0..nodes).any(|node| !touched(node) && !search.closes(node)) {
        return;
    }
    let list: Vec<CurveEdge> = unclear.iter().map(|&i| edges[i]).collect();
    search.from(&list, 0, 0.0);
    if let Some((_, rights)) = search.best {
        for (&i, right) in unclear.iter().zip(rights) {
            edges[i].sides = [right + edges[i].weight, right];
        }
    }
}

struct Search {
    levels: usize,
    /// For each node and level, the number of curves that begin there minus the number that end there.
    net: Vec<i32>,
    /// Number of undecided curves at each node.
    open: Vec<usize>,
    chosen: Vec<i32>,
    /// The least change, and the number of poses on the right of each unclear curve.
    best: Option<(f64, Vec<i32>)>,
    remaining_choices: usize,
}

impl Search {
    fn put(&mut self, edge: &CurveEdge, right: i32, sign: i32) {
        for level in right.max(0)..(right + edge.weight).min(self.levels as i32) {
            self.net[edge.ends[0] * self.levels + level as usize] += sign;
            self.net[edge.ends[1] * self.levels + level as usize] -= sign;
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
        let Some(edge) = list.get(place) else {
            self.best = Some((change, self.chosen.clone()));
            return;
        };
        let most = edge.sides[0].max(edge.sides[1]) + 1;
        let least = (edge.sides[0].min(edge.sides[1]) - edge.weight).max(0);
        edge.ends.into_iter().for_each(|node| self.open[node] -= 1);
        // The highest numbers first, so that among equal changes the one with more poses is chosen.
        for right in (least..=most).rev() {
            self.put(edge, right, 1);
            self.chosen[place] = right;
            if edge.ends.iter().all(|&node| self.open[node] > 0 || self.closes(node)) {
                self.from(list, place + 1, change + edge.change(right));
            }
            self.put(edge, right, -1);
        }
        edge.ends.into_iter().for_each(|node| self.open[node] += 1);
    }
}
