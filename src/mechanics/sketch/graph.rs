//! Which pins are on which bars: distances from the base, and a basis of shortest loops.

use std::collections::{HashMap, VecDeque};

use super::drawing::{PinId, Sketch};

/// Bars and pins by index, and how they meet. A node below `bars` is a bar; any other is a pin.
pub(super) struct Graph {
    bars: usize,
    near: Vec<Vec<usize>>,
    edges: Vec<[usize; 2]>,
}

/// A loop: `pins[i]` joins `bars[i]` and the bar after it.
pub(super) struct Loop {
    pub bars: Vec<usize>,
    pub pins: Vec<usize>,
}

type Bits = Vec<u64>;

impl Graph {
    pub fn of(sketch: &Sketch) -> Self {
        let bars = sketch.bars.len();
        let index: HashMap<PinId, usize> = sketch.pins.iter().enumerate().map(|(i, pin)| (pin.id, bars + i)).collect();
        let (mut near, mut edges) = (vec![Vec::new(); bars + sketch.pins.len()], Vec::new());
        for (i, bar) in sketch.bars.iter().enumerate() {
            for pin in bar.all_pins().filter_map(|pin| index.get(&pin)) {
                near[i].push(*pin);
                near[*pin].push(i);
                edges.push([i, *pin]);
            }
        }
        Self { bars, near, edges }
    }

    /// Returns for each node how many steps it is from a node, and the node before it.
    fn walk(&self, from: usize) -> (Vec<Option<usize>>, Vec<usize>) {
        let (mut far, mut before) = (vec![None; self.near.len()], vec![from; self.near.len()]);
        if from >= far.len() {
            return (far, before);
        }
        far[from] = Some(0);
        let mut queue = VecDeque::from([from]);
        while let Some(node) = queue.pop_front() {
            for &next in &self.near[node] {
                if far[next].is_none() {
                    far[next] = far[node].map(|steps: usize| steps + 1);
                    before[next] = node;
                    queue.push_back(next);
                }
            }
        }
        (far, before)
    }

    /// Returns how many steps each bar and each pin are from a pin; `None` if they are not connected.
    pub fn distances(&self, pin: usize) -> (Vec<Option<usize>>, Vec<Option<usize>>) {
        let mut bars = self.walk(self.bars + pin).0;
        let pins = bars.split_off(self.bars);
        (bars, pins)
    }

    /// Returns the number of loops that do not follow from others.
    fn loop_count(&self) -> usize {
        let mut seen = vec![false; self.near.len()];
        let mut parts = 0;
        for start in 0..self.near.len() {
            if seen[start] {
                continue;
            }
            parts += 1;
            let mut stack = vec![start];
            seen[start] = true;
            while let Some(node) = stack.pop() {
                for &next in &self.near[node] {
                    if !std::mem::replace(&mut seen[next], true) {
                        stack.push(next);
                    }
                }
            }
        }
        (self.edges.len() + parts).saturating_sub(self.near.len())
    }

    /// Returns loops of the fewest bars from which all others follow.
    pub fn loops(&self) -> Vec<Loop> {
        let wanted = self.loop_count();
        if wanted == 0 {
            return Vec::new();
        }
        let place: HashMap<[usize; 2], usize> = self.edges.iter().enumerate().map(|(i, edge)| (*edge, i)).collect();
        let mut found: Vec<Vec<usize>> = Vec::new();
        for root in 0..self.bars {
            let (far, before) = self.walk(root);
            let to_root = |mut node: usize| {
                let mut way = vec![node];
                while node != root {
                    node = before[node];
                    way.push(node);
                }
                way
            };
            for &[bar, pin] in self.edges.iter().filter(|[bar, _]| far[*bar].is_some()) {
                if before[bar] == pin || before[pin] == bar {
                    continue;
                }
                let (mut way, back) = (to_root(bar), to_root(pin));
                if way.iter().filter(|node| back.contains(node)).count() > 1 {
                    continue;
                }
                way.reverse();
                way.extend(back.iter().take(back.len() - 1));
                found.push(way);
            }
        }
        found.sort_by_key(Vec::len);
        let (mut basis, mut loops): (Vec<(usize, Bits)>, Vec<Loop>) = (Vec::new(), Vec::new());
        for way in found {
            let mut bits: Bits = vec![0; self.edges.len().div_ceil(64)];
            for i in 0..way.len() {
                let (a, b) = (way[i], way[(i + 1) % way.len()]);
                let edge = if a < self.bars { [a, b] } else { [b, a] };
                if let Some(e) = place.get(&edge) {
                    bits[e / 64] ^= 1 << (e % 64);
                }
            }
            for (pivot, row) in &basis {
                if bits[pivot / 64] >> (pivot % 64) & 1 == 1 {
                    bits.iter_mut().zip(row).for_each(|(own, row)| *own ^= row);
                }
            }
            let Some(pivot) = (0..self.edges.len()).find(|e| bits[e / 64] >> (e % 64) & 1 == 1) else { continue };
            basis.push((pivot, bits));
            // The way begins with a bar, and bars and pins take turns.
            let bars = way.iter().copied().step_by(2).collect();
            let pins = way.iter().skip(1).step_by(2).map(|pin| pin - self.bars).collect();
            loops.push(Loop { bars, pins });
            if loops.len() == wanted {
                break;
            }
        }
        loops
    }
}
