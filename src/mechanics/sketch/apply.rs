//! [`Sketch::with`]: one step of drawing.

use super::drawing::{BarId, EndEffector, PinId, Place, Sketch};
use super::refusal::SketchRefusal;
use super::step::SketchStep;
use crate::machine::Angle;
use crate::planar::Vector;
use stillbase_settings::range::{MAX_SAID, quote_clipped, shortened};

impl Sketch {
    /// Returns the drawing after a step.
    ///
    /// # Errors
    /// If the step does not fit the drawing, or would make a loop outside the family; says where, and what would do.
    pub fn with(&self, step: &SketchStep) -> Result<Self, SketchRefusal> {
        let mut next = self.stepped(step)?;
        if !matches!(step, SketchStep::New { .. }) {
            next.follow_pins(self);
        }
        // Parts that someone states are as stated.
        if !matches!(step, SketchStep::New { .. } | SketchStep::Parts { .. }) {
            next.follow_with_bars(self);
        }
        next.write_plainly();
        next.check()?;
        Ok(next)
    }

    fn stepped(&self, step: &SketchStep) -> Result<Self, SketchRefusal> {
        match step {
            SketchStep::New { template } => Ok(template.sketch()),
            SketchStep::Bar { from, to, name } => self.with_bar(*from, *to, name.as_deref()),
            SketchStep::MovePin { pin, to } => {
                self.known_pin(*pin)?;
                self.moved(*pin, Vector::new(to[0], to[1]))
            }
            SketchStep::Split { bar, along } => self.split(*bar, *along),
            SketchStep::Join { bar, with } => self.joined(*bar, *with),
            SketchStep::Weld { pin, onto } => self.welded(*pin, *onto),
            SketchStep::Attach { pin, bar } => self.attached(*pin, *bar),
            SketchStep::DeleteBar { bar } => self.without_bar(*bar),
            SketchStep::DeletePin { pin } => self.without_pin(*pin),
            SketchStep::Motor { pin, stator, drive, rotor, turns } => {
                self.with_motor(*pin, *stator, drive.as_deref(), *rotor, *turns)
            }
            SketchStep::MoveMotor { drive, pin, stator } => self.with_motor_at(drive, *pin, *stator),
            SketchStep::Gear { drive, inertia, ratio } => self.with_gear(drive, *inertia, *ratio),
            SketchStep::DeleteMotor { drive } => self.without_motor(drive),
            SketchStep::Follow { bar, drive } => self.following(*bar, drive.as_deref()),
            SketchStep::EndEffector { pin, bar } => self.with_end_effector(*pin, *bar),
            SketchStep::Limits { to, from, offset, range } => self.with_limits(to, from, *offset, *range),
            SketchStep::Name { name } => Ok(Self { name: name.clone(), ..self.clone() }),
            SketchStep::NameBar { bar, name } => self.with_bar_named(*bar, name),
            SketchStep::NameDrive { drive, name } => self.with_drive_named(drive, name),
            SketchStep::Length { bar, metres } => self.with_length(*bar, *metres),
            SketchStep::Angle { bar, radians } => self.with_angle(*bar, *radians),
            SketchStep::Parallelogram { corners, moves } => self.with_parallelogram(*corners, *moves),
            SketchStep::Mass { bar, body, per_metre } => {
                self.known_bar(*bar)?;
                let mut next = self.clone();
                if let Some(own) = next.bar_mut(*bar) {
                    (own.body, own.per_metre) = (*body, *per_metre);
                }
                Ok(next)
            }
            SketchStep::Parts { bar, parts, lumps } => self.with_parts(*bar, parts, lumps),
            SketchStep::Lump { bar, number, lump } => self.with_lump(*bar, *number, lump.as_ref()),
        }
    }

    pub(super) fn no_bar(&self, id: BarId) -> SketchRefusal {
        let known: Vec<String> =
            self.bars.iter().map(|bar| format!("{} (bar {})", bar.id.0, quote_clipped(&bar.name))).collect();
        let want = match known.is_empty() {
            true => "a bar drawn first".to_owned(),
            false => format!("one of {}", shortened(&known.join(", "), MAX_SAID)),
        };
        SketchRefusal::new(Place::Whole, format!("there is no bar with the number {}", id.0), want)
    }

    pub(super) fn known_bar(&self, id: BarId) -> Result<&super::drawing::Bar, SketchRefusal> {
        self.bar(id).ok_or_else(|| self.no_bar(id))
    }

    pub(super) fn known_pin(&self, id: PinId) -> Result<(), SketchRefusal> {
        let what = || format!("there is no pin with the number {}", id.0);
        self.pin(id).map(|_| ()).ok_or_else(|| SketchRefusal::new(Place::Whole, what(), "a pin of the drawing"))
    }

    fn with_end_effector(&self, pin: PinId, bar: Option<BarId>) -> Result<Self, SketchRefusal> {
        self.known_pin(pin)?;
        let ends = self.bars.iter().rev().find(|bar| bar.tip == pin);
        let bar = match bar {
            Some(id) => Some(self.known_bar(id)?).filter(|bar| bar.has(pin)),
            None => ends.or_else(|| self.bars_at(pin).last()),
        };
        let on_none = || SketchRefusal::new(Place::Pin(pin), "the pin is on no such bar", "a pin of a bar");
        let bar = bar.ok_or_else(on_none)?.id;
        Ok(Self { end_effector: Some(EndEffector { pin, bar }), ..self.clone() })
    }

    fn with_limits(&self, to: &str, from: &str, offset: f64, range: Option<[f64; 2]>) -> Result<Self, SketchRefusal> {
        self.known_drive(to)?;
        self.known_drive(from)?;
        if to == from {
            let what = format!("drive {to} has no angle from itself");
            return Err(SketchRefusal::new(Place::Drive(to.into()), what, "the angle between two drives"));
        }
        if range.is_some_and(|[low, high]| low >= high) {
            let what = "the least angle is not below the greatest";
            return Err(SketchRefusal::new(Place::Drive(to.into()), what, "the least angle first"));
        }
        let mut next = self.clone();
        if !next.angles.iter().any(|angle| angle.to == to && angle.from == from) {
            let name = next.free_angle_name();
            next.angles.push(Angle { name, to: to.into(), from: from.into(), offset, min: None, max: None });
        }
        for angle in next.angles.iter_mut().filter(|angle| angle.to == to && angle.from == from) {
            (angle.min, angle.max) = (range.map(|ends| ends[0]), range.map(|ends| ends[1]));
        }
        Ok(next)
    }

    pub(super) fn free_angle_name(&self) -> String {
        let mut number = 1_usize;
        while self.angles.iter().any(|angle| angle.name == format!("a{number}")) {
            number += 1;
        }
        format!("a{number}")
    }

    fn with_bar_named(&self, id: BarId, name: &str) -> Result<Self, SketchRefusal> {
        let old = self.known_bar(id)?.name.clone();
        let mut next = self.clone();
        if let Some(bar) = next.bar_mut(id) {
            bar.name = name.into();
        }
        next.links_mut().filter(|link| **link == old).for_each(|link| *link = name.into());
        Ok(next)
    }

    fn with_parallelogram(&self, corners: [PinId; 4], moves: PinId) -> Result<Self, SketchRefusal> {
        corners.into_iter().try_for_each(|pin| self.known_pin(pin))?;
        let Some(i) = corners.iter().position(|pin| *pin == moves) else {
            let what = "the pin that moves is no corner of the loop";
            return Err(SketchRefusal::new(Place::Pin(moves), what, "one of the four corners"));
        };
        let [next, across, before] = [1, 2, 3].map(|steps| self.at(corners[(i + steps) % 4]));
        self.moved(moves, next + before - across)
    }
}
