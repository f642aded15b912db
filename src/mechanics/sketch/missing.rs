//! What a drawing lacks to be a machine.

use super::classes::Classes;
use super::drawing::{Bar, BarId, PinId, Place, Sketch, mm};
use super::graph::Graph;
use super::loops::{LoopShape, LoopState, Recognised};
use super::mends::Mend;
use crate::machine::{Machine, MachineError};

/// Kind of what is missing.
#[derive(Clone, Debug, PartialEq)]
pub enum Lack {
    /// There is no bar.
    NoBar,
    /// There is no motor.
    NoMotor,
    /// A bar is not connected to the base.
    Loose,
    /// A loop is nearly a parallelogram.
    LoopOff {
        /// The loop.
        of: LoopState,
        /// Distance of a corner from its place, m.
        off: f64,
    },
    /// A loop lies outside the family.
    LoopOutside {
        /// The loop.
        of: LoopState,
    },
    /// A bar follows no drive.
    NoDrive,
    /// Bars that must follow one drive are said to follow several.
    DrivesDiffer {
        /// The drives.
        drives: [String; 2],
    },
    /// A bar is not parallel to the arm of its drive.
    NotParallel {
        /// The drive.
        drive: String,
        /// Distance of its tip from the parallel, m.
        off: f64,
    },
    /// A drive turns no bar.
    NoBarOfDrive,
    /// There is no end effector.
    NoEndEffector,
    /// A bar runs over a pin without joining it. It may be meant so, in another layer.
    Crossing,
    /// All is drawn, but a number is wrong.
    Invalid {
        /// The machine's own error.
        error: MachineError,
    },
}

/// One thing that a drawing lacks.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// Its kind.
    pub lack: Lack,
    /// Where.
    pub place: Place,
    /// In words.
    pub text: String,
    /// Steps that mend it, the best first; each has been tried.
    pub mends: Vec<Mend>,
}

impl Missing {
    fn new(lack: Lack, place: Place, text: String) -> Self {
        Self { lack, place, text, mends: Vec::new() }
    }

    /// Returns whether another drawing lacks the same: the same kind at the same place.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        match (&self.lack, &other.lack) {
            (
                Lack::LoopOff { of: a, .. } | Lack::LoopOutside { of: a },
                Lack::LoopOff { of: b, .. } | Lack::LoopOutside { of: b },
            ) => a.bars.len() == b.bars.len() && a.bars.iter().all(|bar| b.bars.contains(bar)),
            (Lack::Invalid { error: a }, Lack::Invalid { error: b }) => a == b,
            (a, b) => std::mem::discriminant(a) == std::mem::discriminant(b) && self.place == other.place,
        }
    }
}

/// What a drawing is, and lacks.
pub(super) struct Diagnosis {
    pub loops: Vec<Recognised>,
    pub classes: Classes,
    pub missing: Vec<Missing>,
    pub machine: Option<Machine>,
}

impl Sketch {
    pub(super) fn diagnosed(&self) -> Diagnosis {
        let graph = Graph::of(self);
        let loops = self.recognised(&graph);
        let classes = Classes::of(self, &loops);
        let base = self.pins.iter().position(|pin| pin.id == self.base).unwrap_or_default();
        let (far, _) = graph.distances(base);
        let mut missing = Vec::new();
        if self.bars.is_empty() {
            missing.push(Missing::new(Lack::NoBar, Place::Whole, "no bar yet".into()));
        }
        for found in &loops {
            missing.extend(self.loop_missing(&found.state));
        }
        missing.extend(self.loose(&graph, &far));
        // Of drawn bars each says that no motor turns it.
        if self.motors.is_empty() && self.bars.is_empty() {
            missing.push(Missing::new(Lack::NoMotor, Place::Pin(self.base), "no motor yet".into()));
        }
        for first in (0..self.bars.len()).filter(|i| classes.class(*i) == *i) {
            missing.extend(self.class_missing(&classes, first, &far));
        }
        for name in self.motors.iter().map(|motor| &motor.drive.name) {
            if !self.bars.iter().any(|bar| bar.drive.as_ref() == Some(name)) {
                let text = format!("drive {name} turns no bar");
                missing.push(Missing::new(Lack::NoBarOfDrive, Place::Drive(name.clone()), text));
            }
        }
        if self.end_effector.is_none() {
            missing.push(Missing::new(Lack::NoEndEffector, Place::Whole, "no end effector yet".into()));
        }
        let machine = missing.is_empty().then(|| Machine::new(self.spec()));
        let machine = match machine {
            Some(Err(error)) => {
                let text = match &error {
                    MachineError::StatorCycle { chain, .. } => format!(
                        "the motors of drives carry each other, {chain}: want one of them on the base, or on a bar that \
                         leads there"
                    ),
                    error => error.to_string(),
                };
                missing.push(Missing::new(Lack::Invalid { error }, Place::Whole, text));
                None
            }
            Some(Ok(machine)) => Some(machine),
            None => None,
        };
        Diagnosis { loops, classes, missing, machine }
    }

    fn loop_missing(&self, state: &LoopState) -> Option<Missing> {
        let names: Vec<&str> = state.bars.iter().filter_map(|id| self.bar(*id)).map(|bar| bar.name.as_str()).collect();
        let pin = state.pins.iter().copied().max().unwrap_or(self.base);
        match state.shape {
            LoopShape::Closed => None,
            LoopShape::Nearly { off } => {
                let text = format!("loop {} is {} off a parallelogram", names.join("–"), mm(off));
                Some(Missing::new(Lack::LoopOff { of: state.clone(), off }, Place::Pin(pin), text))
            }
            LoopShape::Outside => {
                let text = format!("{}: want {}", self.outside_reason(state), Self::wanted_loop(state));
                Some(Missing::new(Lack::LoopOutside { of: state.clone() }, Place::Pin(pin), text))
            }
        }
    }

    /// Returns the first bar of each part that is not connected to the base.
    fn loose(&self, graph: &Graph, far: &[Option<usize>]) -> Vec<Missing> {
        let mut seen: Vec<bool> = far.iter().map(Option::is_some).collect();
        let mut missing = Vec::new();
        for (i, bar) in self.bars.iter().enumerate() {
            if std::mem::replace(&mut seen[i], true) {
                continue;
            }
            let root = self.pins.iter().position(|pin| pin.id == bar.root).unwrap_or_default();
            let (part, _) = graph.distances(root);
            part.iter().zip(&mut seen).filter(|(far, _)| far.is_some()).for_each(|(_, seen)| *seen = true);
            let text = format!("bar {} is not connected to the base", bar.name);
            missing.push(Missing::new(Lack::Loose, Place::Bar(bar.id), text));
        }
        missing
    }

    /// Returns what the bars of a class lack: a drive, one drive for all, or the direction of its arm.
    fn class_missing(&self, classes: &Classes, first: usize, far: &[Option<usize>]) -> Option<Missing> {
        let bars = || classes.bars(first).map(|i| &self.bars[i]);
        let nearest = classes.bars(first).min_by_key(|i| far[*i].unwrap_or(usize::MAX)).unwrap_or(first);
        let (bar, place) = (&self.bars[nearest], Place::Bar(self.bars[nearest].id));
        let stated = |bar: &Bar| bar.drive.clone();
        let Some(drive) = bars().find_map(stated) else {
            let text = match self.motors.is_empty() {
                true => format!("no motor turns bar {} yet", bar.name),
                false => format!("bar {} follows no drive", bar.name),
            };
            return Some(Missing::new(Lack::NoDrive, place, text));
        };
        if let Some(other) = bars().find(|bar| bar.drive.as_ref().is_some_and(|own| *own != drive)) {
            let drives = [drive, other.drive.clone().unwrap_or_default()];
            let text = format!(
                "bar {} must follow one drive with those parallel to it, and they follow drives {} and {}",
                bar.name, drives[0], drives[1]
            );
            return Some(Missing::new(Lack::DrivesDiffer { drives }, place, text));
        }
        let off = self.off_parallel(bar, &drive)?;
        let text = format!("bar {} follows drive {drive}, but is {} off the parallel to its arm", bar.name, mm(off));
        Some(Missing::new(Lack::NotParallel { drive, off }, place, text))
    }

    /// Returns the pins of the part of the drawing that hangs together with a bar.
    pub(super) fn part_of(&self, id: BarId) -> Vec<PinId> {
        let Some(bar) = self.bar(id) else { return Vec::new() };
        let root = self.pins.iter().position(|pin| pin.id == bar.root).unwrap_or_default();
        let (_, far) = Graph::of(self).distances(root);
        self.pins.iter().zip(far).filter(|(_, far)| far.is_some()).map(|(pin, _)| pin.id).collect()
    }
}
