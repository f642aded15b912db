//! Steps on motors, and which bars follow them.

use super::classes::Classes;
use super::drawing::{Bar, BarId, Motor, PinId, Place, Sketch};
use super::graph::Graph;
use super::refusal::SketchRefusal;
use super::step::SketchStep;
use crate::machine::{Angle, Drive, Rotor};
use crate::planar::MAX_DRIVES;

impl Sketch {
    /// Returns the step that hangs a motor on a pin. It turns the bar there that leads away from the base and follows
    /// no drive yet, as `is_free` says; away from the base, the bar that leads to the pin carries its stator.
    pub fn motor_at(&self, pin: PinId, is_free: impl Fn(BarId) -> bool) -> SketchStep {
        let free = || self.bars_from(pin).filter(|(bar, _)| is_free(bar.id));
        let turns = free().find(|(_, leads_away)| *leads_away).or_else(|| free().next()).map(|(bar, _)| bar.id);
        self.motor_turning(pin, turns)
    }

    /// Returns the step that hangs a motor on the pin of a bar next to the base, which turns the bar; `None` if the bar
    /// is not in the drawing.
    pub fn motor_for(&self, id: BarId) -> Option<SketchStep> {
        let inner = self.bars.iter().zip(self.inner_pins()).find(|(bar, _)| bar.id == id)?.1;
        Some(self.motor_turning(inner, Some(id)))
    }

    fn motor_turning(&self, pin: PinId, turns: Option<BarId>) -> SketchStep {
        let others = || self.bars_from(pin).filter(|(bar, _)| Some(bar.id) != turns);
        let carrier = || others().find(|(_, leads_away)| !leads_away).or_else(|| others().next());
        let stator = (pin != self.base).then(carrier).flatten().map(|(bar, _)| bar.id);
        SketchStep::Motor { pin, stator, drive: None, rotor: None, turns }
    }

    /// Returns the bars at a pin, and whether each leads away from the base there.
    fn bars_from(&self, pin: PinId) -> impl Iterator<Item = (&Bar, bool)> {
        let all = self.bars.iter().zip(self.inner_pins()).filter(move |(bar, _)| bar.has(pin));
        all.map(move |(bar, inner)| (bar, inner == pin))
    }

    pub(super) fn known_drive(&self, name: &str) -> Result<&Motor, SketchRefusal> {
        self.motor(name).ok_or_else(|| {
            let names: Vec<&str> = self.motors.iter().map(|motor| motor.drive.name.as_str()).collect();
            let want = if names.is_empty() {
                "a motor hung on a pin first".into()
            } else {
                format!("one of {}", names.join(", "))
            };
            SketchRefusal::new(Place::Whole, format!("there is no drive {name:?}"), want)
        })
    }

    /// Checks that a stator at a pin has something to sit on.
    pub(super) fn check_stator(&self, pin: PinId, stator: Option<BarId>) -> Result<(), SketchRefusal> {
        self.known_pin(pin)?;
        match stator {
            None if pin == self.base => Ok(()),
            None => {
                let what = "a motor on the base cannot sit at this pin: those on the base share one axis at B";
                Err(SketchRefusal::new(Place::Pin(pin), what, "a motor at B, or on a bar that has the pin"))
            }
            Some(bar) if self.known_bar(bar)?.has(pin) => Ok(()),
            Some(bar) => {
                let what = format!("bar {} does not have this pin", self.known_bar(bar)?.name);
                Err(SketchRefusal::new(Place::Pin(pin), what, "a stator on a bar at the pin of the motor"))
            }
        }
    }

    pub(super) fn with_motor(
        &self,
        pin: PinId,
        stator: Option<BarId>,
        drive: Option<&str>,
        rotor: Option<Rotor>,
        turns: Option<BarId>,
    ) -> Result<Self, SketchRefusal> {
        if self.motors.len() >= MAX_DRIVES {
            let what = format!("the machine has {} drives", self.motors.len());
            let follow = |bar: BarId| {
                let motors = self.motors.iter().map(|motor| motor.drive.name.clone());
                motors.map(move |drive| SketchStep::Follow { bar, drive: Some(drive) })
            };
            let want = format!("at most {MAX_DRIVES}: let the bar follow one of them");
            return Err(SketchRefusal::new(Place::Pin(pin), what, want).or(turns.into_iter().flat_map(follow)));
        }
        self.check_stator(pin, stator).map_err(|refusal| {
            let other = |stator| SketchStep::Motor { pin, stator, drive: drive.map(Into::into), rotor, turns };
            let on_base = (pin == self.base).then_some(None);
            let bars = self.bars_at(pin).filter(|bar| Some(bar.id) != turns).map(|bar| Some(bar.id));
            refusal.or(on_base.into_iter().chain(bars).map(other))
        })?;
        let name = drive.map_or_else(|| self.free_drive_name(), Into::into);
        let mut next = self.clone();
        // The angle from what carries the stator, or from the drive before, takes limits later.
        let from = stator.and_then(|bar| self.drive_of(bar));
        let from = from.or_else(|| self.motors.last().map(|motor| motor.drive.name.clone()));
        if let Some(from) = from {
            let angle = next.free_angle_name();
            next.angles.push(Angle { name: angle, to: name.clone(), from, offset: 0.0, min: None, max: None });
        }
        let drive = Drive {
            name: name.clone(),
            on: None,
            rotor,
            torque_limit: None,
            speed_limit: None,
            acceleration_limit: None,
            jerk_limit: None,
        };
        next.motors.push(Motor { pin, stator, drive });
        match turns {
            Some(bar) => next.following(bar, Some(&name)),
            None => Ok(next),
        }
    }

    pub(super) fn with_motor_at(&self, drive: &str, pin: PinId, stator: Option<BarId>) -> Result<Self, SketchRefusal> {
        self.known_drive(drive)?;
        self.check_stator(pin, stator)?;
        let mut next = self.clone();
        for motor in next.motors.iter_mut().filter(|motor| motor.drive.name == drive) {
            (motor.pin, motor.stator) = (pin, stator);
        }
        Ok(next)
    }

    pub(super) fn with_gear(&self, drive: &str, inertia: f64, ratio: f64) -> Result<Self, SketchRefusal> {
        self.known_drive(drive)?;
        let mut next = self.clone();
        let rotor = Some(Rotor { inertia, ratio }).filter(|rotor| *rotor != Rotor::default());
        next.motors.iter_mut().filter(|motor| motor.drive.name == drive).for_each(|motor| motor.drive.rotor = rotor);
        Ok(next)
    }

    pub(super) fn without_motor(&self, drive: &str) -> Result<Self, SketchRefusal> {
        self.known_drive(drive)?;
        let mut next = self.clone();
        next.motors.retain(|motor| motor.drive.name != drive);
        next.tidy();
        Ok(next)
    }

    pub(super) fn with_drive_named(&self, drive: &str, name: &str) -> Result<Self, SketchRefusal> {
        self.known_drive(drive)?;
        let mut next = self.clone();
        let renamed = |own: &mut String| {
            if own == drive {
                *own = name.into();
            }
        };
        next.motors.iter_mut().for_each(|motor| renamed(&mut motor.drive.name));
        next.bars.iter_mut().filter_map(|bar| bar.drive.as_mut()).for_each(renamed);
        next.angles.iter_mut().flat_map(|angle| [&mut angle.to, &mut angle.from]).for_each(renamed);
        Ok(next)
    }

    /// Returns the drawing with a bar that follows a drive, and with it all that must follow the same.
    pub(super) fn following(&self, id: BarId, drive: Option<&str>) -> Result<Self, SketchRefusal> {
        self.known_bar(id)?;
        drive.map_or(Ok(()), |name| self.known_drive(name).map(|_| ()))?;
        let classes = Classes::of(self, &self.recognised(&Graph::of(self)));
        let mut next = self.clone();
        let Some(own) = self.bars.iter().position(|bar| bar.id == id) else { return Ok(next) };
        for bar in classes.bars(classes.class(own)) {
            (next.bars[bar].drive, next.bars[bar].against) = (None, false);
        }
        // By the arms as they were, so that the drive's angle stays what it is.
        let against = drive.is_some_and(|drive| self.is_against(&self.bars[own], drive));
        (next.bars[own].drive, next.bars[own].against) = (drive.map(Into::into), against);
        Ok(next)
    }

    /// Returns the drive that a bar follows, by its name.
    pub(super) fn drive_of(&self, id: BarId) -> Option<String> {
        let classes = Classes::of(self, &self.recognised(&Graph::of(self)));
        let own = self.bars.iter().position(|bar| bar.id == id)?;
        classes.drive(self, own).map(Into::into)
    }
}
