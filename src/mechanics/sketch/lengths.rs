//! [`Lengths`]: which lengths of a drawing are one because a parallelogram needs it, with their names.

use std::collections::{BTreeMap, HashMap};

use super::drawing::{PinId, Sketch};
use super::loops::Recognised;
use crate::machine::{Length, PlaceOnLink};

/// Digits of a metre to which a length is rounded: a picometre, far below what a closure may be off.
const PARTS: f64 = 1e12;

/// The distance of a pin from the root of a bar, by the index of the bar.
pub(super) type Distance = (usize, PinId);

/// Names of the lengths that several bars share.
pub(super) struct Lengths {
    pub named: BTreeMap<String, f64>,
    names: HashMap<Distance, String>,
}

impl Lengths {
    pub fn of(sketch: &Sketch, loops: &[Recognised]) -> Self {
        let mut shared = shared(sketch, loops);
        for (bar, own) in sketch.bars.iter().enumerate().filter(|(_, own)| own.length.is_some()) {
            unite(&mut shared, &[(bar, own.tip)]);
        }
        let is_length = |(bar, pin): &Distance| sketch.bars[*bar].tip == *pin;
        shared.iter_mut().for_each(|all| all.sort_by_key(|one| (!is_length(one), *one)));
        shared.sort();
        let (mut named, mut names) = (BTreeMap::new(), HashMap::new());
        for all in &shared {
            let Some(&(bar, pin)) = all.first() else { continue };
            let stated = all.iter().filter(|one| is_length(one)).find_map(|(bar, _)| sketch.bars[*bar].length.clone());
            let stem = stated.unwrap_or_else(|| format!("l{}", sketch.bars[bar].name));
            let mut name = stem.clone();
            let mut count = 1;
            while named.contains_key(&name) {
                count += 1;
                name = format!("{stem}-{count}");
            }
            named.insert(name.clone(), rounded(sketch.along(&sketch.bars[bar], pin).abs()));
            names.extend(all.iter().map(|one| (*one, name.clone())));
        }
        Self { named, names }
    }

    /// Returns the length of a bar as a file states it.
    pub fn length(&self, sketch: &Sketch, bar: usize) -> Length {
        match self.names.get(&(bar, sketch.bars[bar].tip)) {
            Some(name) => Length::Named(name.clone()),
            None => Length::Metres(rounded(sketch.length(&sketch.bars[bar]))),
        }
    }

    /// Returns the place of a pin on a bar as a file states it.
    pub fn place(&self, sketch: &Sketch, bar: usize, pin: PinId) -> PlaceOnLink {
        let own = &sketch.bars[bar];
        let along = sketch.along(own, pin);
        match self.names.get(&(bar, pin)) {
            _ if pin == own.root => PlaceOnLink::Named("root".into()),
            _ if pin == own.tip => PlaceOnLink::Named("tip".into()),
            Some(name) if along < 0.0 => PlaceOnLink::Named(format!("-{name}")),
            Some(name) => PlaceOnLink::Named(name.clone()),
            None => PlaceOnLink::Metres(rounded(along)),
        }
    }
}

/// Returns distances along bars that loops force to be equal, in groups.
pub(super) fn shared(sketch: &Sketch, loops: &[Recognised]) -> Vec<Vec<Distance>> {
    let mut shared: Vec<Vec<Distance>> = Vec::new();
    for found in loops {
        for pair in found.groups.iter().filter(|group| group.len() == 2) {
            let sides: Vec<Distance> = pair.iter().filter_map(|i| side(sketch, found, *i)).collect();
            if sides.len() == 2 {
                unite(&mut shared, &sides);
            }
        }
    }
    shared
}

/// Returns the side of a loop as the distance of a pin from the root of its bar, if it begins there.
fn side(sketch: &Sketch, found: &Recognised, i: usize) -> Option<Distance> {
    let n = found.state.bars.len();
    let bar = sketch.bars.iter().position(|bar| bar.id == found.state.bars[i])?;
    let (a, b) = (found.state.pins[i], found.state.pins[(i + n - 1) % n]);
    match sketch.bars[bar].root {
        root if root == a => Some((bar, b)),
        root if root == b => Some((bar, a)),
        _ => None,
    }
}

fn unite(shared: &mut Vec<Vec<Distance>>, sides: &[Distance]) {
    let (touched, mut rest): (Vec<_>, Vec<_>) =
        std::mem::take(shared).into_iter().partition(|all| sides.iter().any(|side| all.contains(side)));
    let mut all: Vec<Distance> = touched.into_iter().flatten().chain(sides.iter().copied()).collect();
    all.sort_unstable();
    all.dedup();
    rest.push(all);
    *shared = rest;
}

/// Rounds a length to a picometre, so that a decimal number that was drawn is written as such.
pub(super) fn rounded(metres: f64) -> f64 {
    if metres.abs() < 1e3 { (metres * PARTS).round() / PARTS } else { metres }
}
