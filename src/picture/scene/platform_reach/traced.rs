//! Lines put together from their segments.

use std::collections::BTreeMap;

use nalgebra::Vector3;

/// A point to which segments lead, on a fine grid.
type Node = [i64; 3];

/// Segments of lines.
pub struct Traced {
    /// Width of the grid, m: ends that are nearer belong together.
    width: f64,
    segments: Vec<[(Node, [f32; 3]); 2]>,
}

impl Traced {
    pub fn new(width: f64) -> Self {
        Self { width, segments: Vec::new() }
    }

    /// Adds a segment; one without length is left out.
    pub fn add(&mut self, a: Vector3<f64>, b: Vector3<f64>) {
        let node = |p: &Vector3<f64>| p.map(|x| (x / self.width).round() as i64).into();
        let [from, to]: [Node; 2] = [node(&a), node(&b)];
        if from != to {
            self.segments.push([(from, a.map(|x| x as f32).into()), (to, b.map(|x| x as f32).into())]);
        }
    }

    /// Returns polylines of the segments, each as long as it goes on without a branch.
    pub fn strips(self) -> Vec<Vec<[f32; 3]>> {
        let mut at: BTreeMap<Node, Vec<usize>> = BTreeMap::new();
        for (i, segment) in self.segments.iter().enumerate() {
            segment.iter().for_each(|(node, _)| at.entry(*node).or_default().push(i));
        }
        let mut is_used = vec![false; self.segments.len()];
        let mut strips = Vec::new();
        let mut walk = |begin: usize, from: usize| {
            if is_used[begin] {
                return;
            }
            let (mut segment, mut from, mut strip) = (begin, from, vec![self.segments[begin][from].1]);
            loop {
                is_used[segment] = true;
                let (node, place) = self.segments[segment][1 - from];
                strip.push(place);
                let next = match at[&node][..] {
                    [a, b] => [a, b].into_iter().find(|i| !is_used[*i]),
                    _ => None,
                };
                let Some(next) = next else { break };
                from = usize::from(self.segments[next][0].0 != node);
                segment = next;
            }
            strips.push(strip);
        };
        // From ends and branches first; what is left are loops.
        for (i, segment) in self.segments.iter().enumerate() {
            for from in 0..2 {
                if at[&segment[from].0].len() != 2 {
                    walk(i, from);
                }
            }
        }
        (0..self.segments.len()).for_each(|i| walk(i, 0));
        strips
    }
}
