//! [`resolve`]: what a drawing is, as a machine where it is complete.

use std::collections::BTreeMap;

use super::drawing::{BarId, Sketch};
use super::loops::LoopState;
use super::missing::Missing;
use crate::machine::Machine;

/// Number of missing things for which steps are sought that mend them: more would not be read.
const MENDED: usize = 24;

/// The drive that a bar follows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Follow {
    /// Its name.
    pub drive: String,
    /// Whether the bar points against its arm.
    pub against: bool,
}

/// What a drawing is.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// The machine, if nothing is missing.
    pub machine: Option<Machine>,
    /// What is missing.
    pub missing: Vec<Missing>,
    /// What may be meant as it is: pins that a bar runs over without joining them.
    pub crossings: Vec<Missing>,
    /// Its loops.
    pub loops: Vec<LoopState>,
    /// The drive of each bar that follows one, by itself or because a loop forces it.
    pub drives: BTreeMap<BarId, Follow>,
}

/// Returns what a drawing is: its machine, or what is missing, with steps that mend it.
pub fn resolve(sketch: &Sketch) -> Resolved {
    let found = sketch.diagnosed();
    let mut missing: Vec<Missing> = found.missing.clone();
    for one in missing.iter_mut().take(MENDED) {
        one.mends = sketch.mends(&found, one);
    }
    let follow = |(i, id): (usize, BarId)| {
        let (bar, drive) = (&sketch.bars[i], found.classes.drive(sketch, i)?);
        Some((id, Follow { drive: drive.into(), against: sketch.is_against(bar, drive) }))
    };
    Resolved {
        machine: found.machine,
        missing,
        crossings: sketch.crossings(),
        drives: sketch.bars.iter().map(|bar| bar.id).enumerate().filter_map(follow).collect(),
        loops: found.loops.into_iter().map(|found| found.state).collect(),
    }
}

impl Sketch {
    /// Returns what is missing, in words, without the steps that mend it.
    pub fn lacks(&self) -> Vec<String> {
        self.diagnosed().missing.into_iter().map(|one| one.text).collect()
    }

    /// Returns the machine of a complete drawing, without the list of what is missing.
    pub fn machine(&self) -> Option<Machine> {
        self.diagnosed().machine
    }
}
