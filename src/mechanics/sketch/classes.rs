//! [`Classes`]: which bars must follow one drive, and which drive each of them follows.

use super::drawing::{Bar, Sketch};
use super::loops::Recognised;
use crate::planar::{Vector, cross, dot};

/// Largest distance of a bar's tip from the parallel to the arm of its drive, m.
const PARALLEL: f64 = 1e-7;

/// Bars by index, in classes that loops force to follow one drive.
pub(super) struct Classes {
    /// The class of each bar: the index of its first bar.
    of: Vec<usize>,
}

impl Classes {
    pub fn of(sketch: &Sketch, loops: &[Recognised]) -> Self {
        let mut of: Vec<usize> = (0..sketch.bars.len()).collect();
        let index = |id| sketch.bars.iter().position(|bar| bar.id == id);
        for found in loops {
            for group in &found.groups {
                let bars: Vec<usize> = group.iter().filter_map(|i| index(found.state.bars[*i])).collect();
                for pair in bars.windows(2) {
                    let (a, b) = (of[pair[0]], of[pair[1]]);
                    of.iter_mut().filter(|class| **class == a.max(b)).for_each(|class| *class = a.min(b));
                }
            }
        }
        Self { of }
    }

    /// Returns the class of a bar.
    pub fn class(&self, bar: usize) -> usize {
        self.of[bar]
    }

    /// Returns the bars of a class.
    pub fn bars(&self, class: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.of.len()).filter(move |bar| self.of[*bar] == class)
    }

    /// Returns the drive that a bar follows: its own, or that of a bar which must follow the same.
    pub fn drive<'a>(&self, sketch: &'a Sketch, bar: usize) -> Option<&'a str> {
        let own = sketch.bars[bar].drive.as_deref();
        own.or_else(|| self.bars(self.of[bar]).find_map(|other| sketch.bars[other].drive.as_deref()))
    }
}

impl Sketch {
    /// Returns the unit vector of the arm of a drive, and the bar that decides it: the first that states this drive.
    pub(super) fn arm(&self, drive: &str) -> Option<(Vector, &Bar)> {
        let first = self.bars.iter().find(|bar| bar.drive.as_deref() == Some(drive))?;
        Some((if first.against { -self.direction(first) } else { self.direction(first) }, first))
    }

    /// Returns whether a bar points against the arm of a drive.
    pub(super) fn is_against(&self, bar: &Bar, drive: &str) -> bool {
        self.arm(drive).is_some_and(|(arm, _)| dot(arm, self.direction(bar)) < 0.0)
    }

    /// Returns how far the tip of a bar is from the parallel to the arm of a drive, m, if it is not on it.
    pub(super) fn off_parallel(&self, bar: &Bar, drive: &str) -> Option<f64> {
        let (arm, _) = self.arm(drive)?;
        let off = cross(arm, self.span(bar)).abs();
        (off > PARALLEL).then_some(off)
    }
}
