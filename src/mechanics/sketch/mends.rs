//! Steps that mend what a drawing lacks.

use super::drawing::{Bar, BarId, PinId, Place, Sketch, mm};
use super::graph::Graph;
use super::loops::LoopState;
use super::missing::{Diagnosis, Lack, Missing};
use super::step::{BarEnd, SketchStep};
use crate::machine::MachineError;
use crate::planar::{MAX_DRIVES, dot};

/// Length of the bar that an empty drawing proposes, m.
const FIRST_LENGTH: f64 = 0.3;
/// A pin this near to the axis of a bar lies on it, m.
const SAME_PLACE: f64 = 1e-4;
/// Largest change of a length that a label leaves out, m.
const UNSEEN: f64 = 5e-5;

/// A step that mends something, as a button.
#[derive(Clone, Debug, PartialEq)]
pub struct Mend {
    /// What the button says.
    pub label: String,
    /// The step.
    pub step: SketchStep,
}

impl Sketch {
    /// Returns the steps that mend one thing, the best first. Each is tried: what it mends is not missing afterwards.
    pub(super) fn mends(&self, found: &Diagnosis, missing: &Missing) -> Vec<Mend> {
        let mut tried: Vec<(usize, Mend)> = Vec::new();
        for step in self.candidates(found, missing) {
            let Ok(next) = self.with(&step) else { continue };
            let after = next.diagnosed();
            let is_invalid =
                |found: &Diagnosis| found.missing.iter().any(|one| matches!(one.lack, Lack::Invalid { .. }));
            let is_left = after.missing.iter().any(|other| other.is_same(missing));
            if is_left || is_invalid(&after) && !is_invalid(found) {
                continue;
            }
            tried.push((after.missing.len(), Mend { label: self.label(&step, &next), step }));
        }
        // Of the corners of a loop, that one moves which leaves the least to mend.
        if matches!(missing.lack, Lack::LoopOff { .. } | Lack::LoopOutside { .. }) {
            tried.sort_by_key(|(left, _)| *left);
            tried.truncate(1);
        }
        tried.into_iter().map(|(_, mend)| mend).collect()
    }

    /// Returns pins that a bar runs over without joining them, each with the step that joins both.
    pub(super) fn crossings(&self) -> Vec<Missing> {
        let mut all = Vec::new();
        for bar in &self.bars {
            for pin in self.pins.iter().map(|pin| pin.id).filter(|pin| !bar.has(*pin)) {
                let (at, along) = (self.at(pin) - self.at(bar.root), self.along(bar, pin));
                let is_on = (at - self.direction(bar).scale(along)).norm() < SAME_PLACE
                    && (0.0..=self.length(bar)).contains(&along);
                if !is_on {
                    continue;
                }
                let step = SketchStep::Attach { pin, bar: bar.id };
                let of: Vec<&str> = self.bars_at(pin).map(|bar| bar.name.as_str()).collect();
                if of.is_empty() || self.with(&step).is_err() {
                    continue;
                }
                let bars = if of.len() == 1 { "bar" } else { "bars" };
                let text =
                    format!("bar {} runs over the pin of {bars} {}, and is not joined to it", bar.name, of.join(", "));
                let mends = vec![Mend { label: step.title_in(self), step }];
                all.push(Missing { lack: Lack::Crossing, place: Place::Pin(pin), text, mends });
            }
        }
        all
    }

    fn candidates(&self, found: &Diagnosis, missing: &Missing) -> Vec<SketchStep> {
        match (&missing.lack, &missing.place) {
            (Lack::NoBar, _) => {
                let base = self.at(self.base);
                let to = BarEnd::At([base.re + FIRST_LENGTH, base.im]);
                vec![SketchStep::Bar { from: BarEnd::pin(self.base), to, name: None }]
            }
            (Lack::NoMotor, _) => {
                let turns = self.bars_at(self.base).find(|bar| bar.drive.is_none()).map(|bar| bar.id);
                vec![SketchStep::Motor { pin: self.base, stator: None, drive: None, rotor: None, turns }]
            }
            (Lack::Loose, Place::Bar(bar)) => self.welds(*bar),
            (Lack::LoopOff { of, .. } | Lack::LoopOutside { of }, _) => self.loop_mends(of),
            (Lack::NoDrive, Place::Bar(bar)) => self.drives_for(found, *bar),
            (Lack::DrivesDiffer { drives }, Place::Bar(bar)) => {
                drives.iter().map(|drive| SketchStep::Follow { bar: *bar, drive: Some(drive.clone()) }).collect()
            }
            (Lack::NotParallel { drive, .. }, Place::Bar(bar)) => self.parallels(*bar, drive),
            (Lack::NoBarOfDrive, Place::Drive(drive)) => self.bars_for(found, drive),
            (Lack::NoEndEffector, _) => {
                let (_, far) = Graph::of(self).distances(self.pins.iter().position(|p| p.id == self.base).unwrap_or(0));
                // A pin at the end of one bar alone, if there is one, else any.
                let ends_one = |pin: PinId| {
                    let mut bars =
                        self.bars.iter().filter(|bar| [bar.root, bar.tip].contains(&pin) || bar.pins.contains(&pin));
                    bars.next().is_some() && bars.next().is_none()
                };
                let others = self.pins.iter().zip(far).filter(|(pin, _)| pin.id != self.base);
                let last = others.filter_map(|(pin, far)| Some((ends_one(pin.id), far?, pin.id))).max();
                last.map(|(.., pin)| SketchStep::EndEffector { pin, bar: None }).into_iter().collect()
            }
            (Lack::Invalid { error: MachineError::StatorCycle { drive, .. } }, _) => {
                vec![SketchStep::DeleteMotor { drive: drive.clone() }]
            }
            _ => Vec::new(),
        }
    }

    /// Returns steps that join a part to what stands on the base, the nearest pins first.
    fn welds(&self, bar: BarId) -> Vec<SketchStep> {
        let part = self.part_of(bar);
        let rest = self.pins.iter().map(|pin| pin.id).filter(|pin| !part.contains(pin));
        let mut pairs: Vec<(f64, PinId, PinId)> = rest
            .flat_map(|onto| part.iter().map(move |pin| (*pin, onto)))
            .map(|(pin, onto)| ((self.at(pin) - self.at(onto)).norm(), pin, onto))
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let welds = pairs.into_iter().take(3).map(|(_, pin, onto)| SketchStep::Weld { pin, onto });
        welds.chain([SketchStep::DeleteBar { bar }]).collect()
    }

    fn loop_mends(&self, of: &LoopState) -> Vec<SketchStep> {
        if let [a, b, c, d] = of.pins[..] {
            let corners = [a, b, c, d];
            return corners.into_iter().map(|moves| SketchStep::Parallelogram { corners, moves }).collect();
        }
        of.bars.iter().max().map(|bar| SketchStep::DeleteBar { bar: *bar }).into_iter().collect()
    }

    /// Returns the drives that a bar could follow: those with parallel arms, then one of its own, then any.
    fn drives_for(&self, found: &Diagnosis, id: BarId) -> Vec<SketchStep> {
        let Some(bar) = self.bar(id) else { return Vec::new() };
        let idle = |name: &str| !(0..self.bars.len()).any(|i| found.classes.drive(self, i) == Some(name));
        let follow = |drive: &str| SketchStep::Follow { bar: id, drive: Some(drive.into()) };
        let is_parallel = |name: &str| self.arm(name).is_some() && self.off_parallel(bar, name).is_none();
        let names = || self.motors.iter().map(|motor| motor.drive.name.as_str());
        let fits = |name: &&str| is_parallel(name) || idle(name);
        let mut steps: Vec<SketchStep> = names().filter(fits).map(follow).collect();
        steps.extend(self.motor_for(id));
        if self.motors.len() >= MAX_DRIVES {
            steps.extend(names().filter(|name| !fits(name)).map(follow));
        }
        steps
    }

    /// Returns steps that make a bar parallel to the arm of its drive, or give it one of its own.
    fn parallels(&self, id: BarId, drive: &str) -> Vec<SketchStep> {
        let Some((bar, (arm, _))) = self.bar(id).zip(self.arm(drive)) else { return Vec::new() };
        let along = if dot(arm, self.direction(bar)) < 0.0 { -arm } else { arm };
        let turn = SketchStep::Angle { bar: id, radians: along.arg() };
        std::iter::once(turn).chain(self.motor_for(id)).collect()
    }

    /// Returns the bars that a drive could turn, those at its motor first; and what takes the motor away.
    fn bars_for(&self, found: &Diagnosis, drive: &str) -> Vec<SketchStep> {
        let Some(motor) = self.motor(drive) else { return Vec::new() };
        let is_free = |bar: &Bar| {
            let own = self.bars.iter().position(|other| other.id == bar.id);
            own.is_some_and(|i| found.classes.drive(self, i).is_none())
        };
        let mut free: Vec<&Bar> = self.bars.iter().filter(|bar| is_free(bar)).collect();
        free.sort_by_key(|bar| !bar.has(motor.pin));
        let follow = |bar: &Bar| SketchStep::Follow { bar: bar.id, drive: Some(drive.into()) };
        let away = SketchStep::DeleteMotor { drive: drive.into() };
        free.into_iter().take(3).map(follow).chain([away]).collect()
    }

    /// Describes a step by what it changes.
    fn label(&self, step: &SketchStep, next: &Self) -> String {
        if !matches!(step, SketchStep::Parallelogram { .. }) {
            return step.title_in(self);
        }
        let changed =
            |bar: &&Bar| next.bar(bar.id).is_some_and(|now| (next.length(now) - self.length(bar)).abs() > UNSEEN);
        let says = |bar: &Bar| format!("bar {} becomes {}", bar.name, mm(next.length(bar)));
        let all: Vec<String> = next.bars.iter().filter(|now| self.bar(now.id).iter().any(changed)).map(says).collect();
        match all.is_empty() {
            true => step.title(),
            false => format!("make it one: {}", all.join(", ")),
        }
    }
}
