//! [`Stack`]: which layers links may have beside each other, and the search for an order.
//!
//! # Symbols
//! | letter | meaning |
//! |---|---|
//! | L_j | layer of link j, counted from 0 next to the base plate |
//! | s_ij | least |L_i − L_j| of links that overlap in plan; 0 if they never do |
//!
//! A pin takes all layers between the links that it joins, that at the base all from the base plate up. A link that
//! passes over a pin of others lies above or below all of it.

use std::collections::BTreeMap;

use super::contact::{Between, Contact, Solids, layers_between};
use stillbase_exchange::cut::Cut;

/// Greatest number of layers: one bit of a number for each.
pub const MAX_LAYERS: usize = 128;

/// Pairs of links, and of links and pins, that are one unit of work.
const MEETINGS_PER_WORK: usize = 1000;

/// What an order of the links must keep.
#[derive(Clone, Debug)]
pub struct Stack {
    /// s_ij.
    apart: Vec<Vec<usize>>,
    /// Links that pass over pins: the link, the pin, and how far from its links it must stay.
    over: Vec<(usize, usize, usize)>,
    /// The links of each pin, and whether it begins at the base plate.
    pins: Vec<(Vec<usize>, bool)>,
    /// Least layer of each link.
    floor: Vec<usize>,
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Every order was examined.
    Complete,
    /// The visitor has stopped it.
    Stopped,
    /// It reached its bound on work.
    CutShort,
}

/// What a search asks at every partial order, and tells for every order.
pub trait Visitor {
    /// Returns whether orders with layers from these sets are worth examining; bit l of a set is layer l.
    fn is_worth(&mut self, sets: &[u128]) -> bool;
    /// Takes an order; returns whether the search goes on.
    fn visit(&mut self, layers: &[usize]) -> bool;
}

/// Visitor that keeps the first order.
#[derive(Default)]
pub struct First(pub Option<Vec<usize>>);

impl Visitor for First {
    fn is_worth(&mut self, _: &[u128]) -> bool {
        true
    }

    fn visit(&mut self, layers: &[usize]) -> bool {
        self.0 = Some(layers.to_vec());
        false
    }
}

impl Stack {
    /// Returns what the contacts of a machine of `links` links ask.
    pub fn of<'a>(links: usize, solids: &Solids, cut: &Cut, contacts: impl IntoIterator<Item = &'a Contact>) -> Self {
        let mut apart = vec![vec![0; links]; links];
        let mut over: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for contact in contacts {
            match contact.between {
                Between::Links(a, b) => {
                    apart[a][b] = contact.apart.max(apart[a][b]);
                    apart[b][a] = apart[a][b];
                }
                Between::Pin(link, pin) => {
                    let own = over.entry((link, pin)).or_default();
                    *own = contact.apart.max(*own);
                }
            }
        }
        let pins =
            solids.axles.iter().map(|axle| (axle.links.iter().map(|(link, _)| *link).collect(), axle.is_on_base()));
        let mut floor = vec![0; links];
        for solid in &solids.links {
            // The base plate lies below layer 0 as another layer would.
            let sunk = [solid.thickness, solid.rise.min(0.0)];
            let above = layers_between(cut, sunk, [cut.plate_thickness, 0.0]) - 1;
            floor[solid.link] = above.max(floor[solid.link]);
        }
        let over = over.into_iter().map(|((link, pin), apart)| (link, pin, apart)).collect();
        Self { apart, over, pins: pins.collect(), floor }
    }

    /// Returns the same with every distance one layer and no least layer: it has an order just if this one has.
    fn flat(&self) -> Self {
        let mut flat = self.clone();
        flat.apart.iter_mut().flatten().for_each(|apart| *apart = (*apart).min(1));
        flat.over.iter_mut().for_each(|(_, _, apart)| *apart = 1);
        flat.floor.fill(0);
        flat
    }

    /// Returns the stack of some links alone.
    fn only(&self, links: &[usize]) -> Self {
        let place = |link: &usize| links.iter().position(|own| own == link);
        let pins = self.pins.iter().map(|(own, base)| (own.iter().filter_map(&place).collect(), *base)).collect();
        let over = self.over.iter().filter_map(|(link, pin, apart)| Some((place(link)?, *pin, *apart))).collect();
        Self {
            apart: links.iter().map(|i| links.iter().map(|j| self.apart[*i][*j]).collect()).collect(),
            over,
            pins,
            floor: links.iter().map(|link| self.floor[*link]).collect(),
        }
    }

    /// Returns the work of one partial order: 1, and more where very many solids meet.
    fn work(&self) -> usize {
        1 + (self.links() * self.links() + self.over.len()) / MEETINGS_PER_WORK
    }

    fn links(&self) -> usize {
        self.floor.len()
    }

    /// Returns the most layers that a least order can need.
    fn most_layers(&self) -> usize {
        self.lowest_floor() + (self.links() - 1) * self.widest_step() + 1
    }

    /// Returns the fewest layers that an order could have.
    fn fewest_layers(&self) -> usize {
        // Links of which each two overlap need a layer each.
        let mut group: Vec<usize> = Vec::new();
        let mut order: Vec<usize> = (0..self.links()).collect();
        let degree = |link: &usize| self.apart[*link].iter().filter(|apart| **apart > 0).count();
        order.sort_by_key(|link| std::cmp::Reverse(degree(link)));
        for link in order {
            if group.iter().all(|other| self.apart[link][*other] > 0) {
                group.push(link);
            }
        }
        group.len().max(self.lowest_floor() + 1)
    }

    /// Returns whether some order exists; `None` if the work was cut short.
    pub fn has_order(&self, budget: &mut usize) -> Option<bool> {
        let mut first = First::default();
        let flat = self.flat();
        let ended = flat.search(flat.links().min(MAX_LAYERS), &mut first, budget);
        match ended {
            Ended::CutShort => None,
            _ => Some(first.0.is_some()),
        }
    }

    /// Returns an order with the fewest layers, their number, and whether no order has fewer; `None` if none was
    /// found.
    pub fn lowest(&self, budget: &mut usize) -> Option<(Vec<usize>, usize, bool)> {
        let most = self.most_layers().min(MAX_LAYERS);
        let mut proven = true;
        for count in self.fewest_layers()..=most {
            let mut first = First::default();
            // Each number of layers has its share of the work, so that an order is found where a proof is not.
            let mut share = *budget / 2;
            let given = share;
            let ended = self.search(count, &mut first, &mut share);
            *budget -= given - share;
            proven &= ended != Ended::CutShort;
            if let Some(layers) = first.0 {
                return Some((layers, count, proven));
            }
        }
        self.spread(budget).map(|layers| {
            let count = layers.iter().copied().max().unwrap_or(0) + 1;
            (layers, count, false)
        })
    }

    /// Returns an order with layers far enough apart for any two solids; `None` if it was not found, or needs more than
    /// [`MAX_LAYERS`].
    fn spread(&self, budget: &mut usize) -> Option<Vec<usize>> {
        let mut first = First::default();
        self.flat().search(self.links().min(MAX_LAYERS), &mut first, budget);
        let layers: Vec<usize> =
            first.0?.iter().map(|layer| self.lowest_floor() + layer * self.widest_step()).collect();
        layers.iter().all(|layer| *layer < MAX_LAYERS).then_some(layers)
    }

    fn widest_step(&self) -> usize {
        let steps = self.apart.iter().flatten().copied().chain(self.over.iter().map(|(_, _, apart)| *apart));
        steps.max().unwrap_or(0).max(1)
    }

    /// Returns the least layer that all links may have.
    fn lowest_floor(&self) -> usize {
        self.floor.iter().copied().max().unwrap_or(0)
    }

    /// Returns the fewest links that have no order among themselves, if all have none.
    pub fn conflict(&self, budget: &mut usize) -> Vec<usize> {
        let flat = self.flat();
        let lacks = |links: &[usize], budget: &mut usize| {
            // To choose links costs about as much as a partial order of all.
            *budget = budget.saturating_sub(flat.work());
            flat.only(links).has_order(budget) == Some(false)
        };
        let mut left: Vec<usize> = (0..self.links()).collect();
        // Without any one of these links there is an order, or it is not known that there is none.
        for link in 0..self.links() {
            let without: Vec<usize> = left.iter().copied().filter(|own| *own != link).collect();
            if !without.is_empty() && lacks(&without, budget) {
                left = without;
            }
        }
        for size in 1..left.len() {
            let mut chosen: Vec<usize> = (0..size).collect();
            loop {
                if *budget == 0 {
                    return left;
                }
                if lacks(&chosen, budget) {
                    return chosen;
                }
                if !next_subset(&mut chosen, self.links()) {
                    break;
                }
            }
        }
        left
    }

    /// Examines all orders whose layers lie below `count`.
    pub fn search(&self, count: usize, visitor: &mut dyn Visitor, budget: &mut usize) -> Ended {
        let all = if count >= MAX_LAYERS { u128::MAX } else { (1 << count) - 1 };
        let mut sets: Vec<u128> = self.floor.iter().map(|floor| all & above(*floor)).collect();
        self.descend(&mut sets, visitor, budget)
    }

    fn descend(&self, sets: &mut [u128], visitor: &mut dyn Visitor, budget: &mut usize) -> Ended {
        if *budget == 0 {
            return Ended::CutShort;
        }
        *budget = budget.saturating_sub(self.work());
        if !self.narrow(sets) || !visitor.is_worth(sets) {
            return Ended::Complete;
        }
        let open = (0..sets.len()).filter(|j| sets[*j].count_ones() > 1).min_by_key(|j| sets[*j].count_ones());
        let Some(link) = open else {
            let layers: Vec<usize> = sets.iter().map(|set| set.trailing_zeros() as usize).collect();
            return if visitor.visit(&layers) { Ended::Complete } else { Ended::Stopped };
        };
        let mut choices = sets[link];
        while choices != 0 {
            let layer = choices.trailing_zeros();
            choices &= choices - 1;
            let mut narrower = sets.to_vec();
            narrower[link] = 1 << layer;
            match self.descend(&mut narrower, visitor, budget) {
                Ended::Complete => {}
                ended => return ended,
            }
        }
        Ended::Complete
    }

    /// Removes layers that the links with one layer left exclude; returns whether each link keeps one.
    fn narrow(&self, sets: &mut [u128]) -> bool {
        loop {
            let before: u32 = sets.iter().map(|set| set.count_ones()).sum();
            self.keep_apart(sets);
            self.keep_off_pins(sets);
            if sets.contains(&0) {
                return false;
            }
            if sets.iter().map(|set| set.count_ones()).sum::<u32>() == before {
                return true;
            }
        }
    }

    fn keep_apart(&self, sets: &mut [u128]) {
        for j in 0..sets.len() {
            let Some(layer) = only(sets[j]) else { continue };
            for (i, &apart) in self.apart[j].iter().enumerate().filter(|(i, apart)| *i != j && **apart > 0) {
                sets[i] &= !between(layer as isize - apart as isize + 1, layer + apart - 1);
            }
        }
    }

    fn keep_off_pins(&self, sets: &mut [u128]) {
        for &(link, pin, apart) in &self.over {
            let (joined, on_base) = &self.pins[pin];
            let known = joined.iter().filter_map(|j| only(sets[*j]));
            let ends = known.fold(None, |ends: Option<(usize, usize)>, l| {
                Some(ends.map_or((l, l), |(low, high)| (low.min(l), high.max(l))))
            });
            if let Some((low, high)) = ends {
                let from = if *on_base { 0 } else { low as isize - apart as isize + 1 };
                sets[link] &= !between(from, high + apart - 1);
            }
            let Some(own) = only(sets[link]) else { continue };
            let is_above = *on_base || ends.is_some_and(|(_, high)| own > high);
            let is_below = !*on_base && ends.is_some_and(|(low, _)| own < low);
            let barred = match (is_above, is_below) {
                (true, _) => between(own as isize - apart as isize + 1, MAX_LAYERS - 1),
                (_, true) => between(0, own + apart - 1),
                _ => between(own as isize - apart as isize + 1, own + apart - 1),
            };
            joined.iter().for_each(|j| sets[*j] &= !barred);
        }
    }
}

/// Returns the only layer of a set; `None` if it has several, or none.
fn only(set: u128) -> Option<usize> {
    (set.count_ones() == 1).then(|| set.trailing_zeros() as usize)
}

/// Returns the set of all layers from `floor` up.
fn above(floor: usize) -> u128 {
    if floor >= MAX_LAYERS { 0 } else { u128::MAX << floor }
}

/// Returns the set of the layers from `from` to `to`, both included.
fn between(from: isize, to: usize) -> u128 {
    above(from.max(0) as usize) & !above(to + 1)
}

/// Replaces a subset of the numbers below `count`, in ascending order, by the next of its size; returns whether there
/// is one.
fn next_subset(chosen: &mut [usize], count: usize) -> bool {
    let size = chosen.len();
    let Some(i) = (0..size).rev().find(|&i| chosen[i] + size - i < count) else { return false };
    chosen[i] += 1;
    for j in i + 1..size {
        chosen[j] = chosen[j - 1] + 1;
    }
    true
}
