//! Checks of a drawing that comes from a file or out of a step: names, references, numbers, straight bars.

use std::collections::BTreeSet;

use super::drawing::{Bar, Place, Sketch};
use super::refusal::SketchRefusal;
use crate::machine::ranges::{LENGTH, PLACE};
use crate::machine::{LinkNumber, MAX_COUNTERWEIGHTS, MAX_LINKS, MAX_PARTS, MAX_PER_PART};
use crate::planar::MAX_DRIVES;
use stillbase_settings::range::{quote_clipped, shortened};
use stillbase_settings::text::control_character;

/// Largest number of pins, and of places of pins on bars.
const MAX_PLACES: usize = 1000;
/// Largest number of loops, as many as a machine closes.
const MAX_LOOPS: usize = 200;
/// Largest number of relative angles.
const MAX_ANGLES: usize = 64;
/// Largest number of characters of a name.
const MAX_NAME: usize = 98;
/// Largest number of characters of the summary.
const MAX_SUMMARY: usize = 1000;
/// Largest distance of a pin from the axis of its bar, m, in a drawing of which a machine was made.
const STRAIGHT: f64 = 1e-6;

impl Sketch {
    /// Checks a drawing.
    ///
    /// # Errors
    /// If a name, a reference or a number is wrong, or a bar is bent; says where.
    pub fn check(&self) -> Result<(), SketchRefusal> {
        self.check_counts()?;
        self.check_names()?;
        self.check_pins()?;
        self.bars.iter().try_for_each(|bar| self.check_bar(bar))?;
        self.check_motors()?;
        self.check_numbers()?;
        self.check_parts()
    }

    fn check_counts(&self) -> Result<(), SketchRefusal> {
        let places = self.bars.iter().map(|bar| 2 + bar.pins.len()).sum();
        let counts = [
            ("pins", self.pins.len(), MAX_PLACES),
            ("places of pins on bars", places, MAX_PLACES),
            ("loops", usize::saturating_sub(places, self.bars.len() + self.pins.len()), MAX_LOOPS),
            ("bars", self.bars.len(), MAX_LINKS),
            ("drives", self.motors.len(), MAX_DRIVES),
            ("angles", self.angles.len(), MAX_ANGLES),
            ("counterweights", self.counterweights.len(), MAX_COUNTERWEIGHTS),
            ("materials", self.materials.len(), MAX_PARTS),
            ("parts", self.parts.len(), MAX_PARTS),
            ("lumps", self.lumps.len(), MAX_PARTS),
            ("holes on a part", self.parts.iter().map(|part| part.holes.len()).max().unwrap_or(0), MAX_PER_PART),
            ("corners of a plate", self.parts.iter().map(|part| part.polygon.len()).max().unwrap_or(0), MAX_PER_PART),
        ];
        match counts.into_iter().find(|(_, count, most)| count > most) {
            Some((what, count, most)) => whole(format!("the drawing has {count} {what}"), format!("at most {most}")),
            None => Ok(()),
        }
    }

    fn check_names(&self) -> Result<(), SketchRefusal> {
        let bars = self.bars.iter().map(|bar| (Place::Bar(bar.id), "bar", &bar.name));
        let drives = self.motors.iter().map(|motor| {
            let name = &motor.drive.name;
            (Place::Drive(name.clone()), "drive", name)
        });
        let angles = self.angles.iter().map(|angle| (Place::Whole, "angle", &angle.name));
        let mut seen: BTreeSet<(&str, &str)> = BTreeSet::new();
        for (place, kind, name) in bars.chain(drives).chain(angles).chain([(Place::Whole, "machine", &self.name)]) {
            let printed = quote_clipped(name);
            let printable = |text: &str| control_character(text).is_none();
            if name.trim().is_empty() || name.chars().count() > MAX_NAME || !printable(name) {
                let want = format!("1 to {MAX_NAME} printable characters");
                return Err(SketchRefusal::new(place, format!("{printed:?} cannot name a {kind}"), want));
            }
            if !seen.insert((kind, name.as_str())) {
                let what = format!("there is another {kind} {printed}");
                return Err(SketchRefusal::new(place, what, "a name of its own"));
            }
        }
        let wrong = |name: &&String| {
            let is_word = ["tip", "root"].contains(&name.as_str()) || name.starts_with('-') || name.trim().is_empty();
            is_word || name.chars().count() > MAX_NAME || control_character(name).is_some()
        };
        if let Some(name) = self.bars.iter().filter_map(|bar| bar.length.as_ref()).find(wrong) {
            let what = format!("{:?} cannot name a length", quote_clipped(name));
            return whole(what, "printable characters, neither tip nor root, without - before them");
        }
        match self.summary.chars().count() > MAX_SUMMARY || control_character(&self.summary).is_some() {
            true => {
                whole("the summary cannot be printed in a line", format!("{MAX_SUMMARY} printable characters at most"))
            }
            false => Ok(()),
        }
    }

    fn check_pins(&self) -> Result<(), SketchRefusal> {
        let mut ids: BTreeSet<u32> = BTreeSet::new();
        for id in self.pins.iter().map(|pin| pin.id.0).chain(self.bars.iter().map(|bar| bar.id.0)) {
            if !ids.insert(id) || id >= self.next {
                return whole(
                    format!("the number {id} of a pin or bar is not its own"),
                    "numbers below `next`, each once",
                );
            }
        }
        if self.next > u32::MAX / 2 {
            return whole("`next` leaves no numbers for pins and bars", "the number after the largest in use");
        }
        for pin in &self.pins {
            if !pin.at.iter().all(|x| x.is_finite() && PLACE.contains(*x)) {
                let what = format!("a pin is at {}, {} m", pin.at[0], pin.at[1]);
                return Err(SketchRefusal::new(Place::Pin(pin.id), what, "coordinates within 1e6 m"));
            }
        }
        self.known_pin(self.base)
    }

    fn check_bar(&self, bar: &Bar) -> Result<(), SketchRefusal> {
        let wrong = |what: String, want: &str| Err(SketchRefusal::new(Place::Bar(bar.id), what, want));
        let mut seen = BTreeSet::new();
        for pin in bar.all_pins() {
            self.known_pin(pin)?;
            if !seen.insert(pin) {
                return wrong(format!("bar {} has a pin twice", bar.name), "each pin once");
            }
        }
        if !LENGTH.contains(self.length(bar)) {
            return wrong(format!("bar {} is too short", bar.name), "root and tip apart");
        }
        if self.bend(bar) > STRAIGHT.max(1e-12 * self.length(bar)) {
            return wrong(format!("bar {} is bent", bar.name), "all of its pins on one line");
        }
        if let Some(drive) = &bar.drive {
            self.known_drive(drive)?;
        }
        Ok(())
    }

    fn check_motors(&self) -> Result<(), SketchRefusal> {
        for motor in &self.motors {
            self.check_stator(motor.pin, motor.stator)?;
            if motor.drive.on.is_some() {
                let what = format!("drive {} says what carries it", motor.drive.name);
                return Err(SketchRefusal::new(
                    Place::Pin(motor.pin),
                    what,
                    "`stator` with the number of a bar instead",
                ));
            }
        }
        for name in self.angles.iter().flat_map(|angle| [&angle.to, &angle.from]) {
            self.known_drive(name)?;
        }
        if let Some(weight) = self.counterweights.iter().find(|w| !self.bars.iter().any(|bar| bar.name == w.link)) {
            return whole(format!("a counterweight is on {:?}", quote_clipped(&weight.link)), "a bar of the drawing");
        }
        match self.end_effector {
            Some(end) if !self.known_bar(end.bar)?.has(end.pin) => {
                let what = "the end effector is not on its bar";
                Err(SketchRefusal::new(Place::Bar(end.bar), what, "a pin of the bar"))
            }
            _ => Ok(()),
        }
    }

    /// Checks that every number is finite: a machine's own checks say the rest.
    fn check_numbers(&self) -> Result<(), SketchRefusal> {
        let own = |bar: &Bar| {
            let body = bar.body.unwrap_or_default();
            let moments = [Some(body.inertia_along), body.inertia_across].into_iter().flatten();
            let typed = LinkNumber::ALL.into_iter().filter_map(move |number| body.number(number));
            typed.chain(moments).chain([body.axial, bar.per_metre])
        };
        let motors = self.motors.iter().flat_map(|motor| {
            let drive = &motor.drive;
            let rotor = drive.rotor.map(|rotor| [rotor.inertia, rotor.ratio]).unwrap_or_default();
            let limits = [drive.torque_limit, drive.speed_limit, drive.acceleration_limit, drive.jerk_limit];
            rotor.into_iter().chain(limits.into_iter().flatten())
        });
        let weights = self
            .counterweights
            .iter()
            .flat_map(|w| [w.mass, w.at, w.across, w.radius, w.inner_radius, w.length, w.width]);
        let angles = self.angles.iter().flat_map(|angle| [angle.offset].into_iter().chain(angle.min).chain(angle.max));
        let payload = [self.payload.mass, self.payload.inertia, self.payload.inertia_along, self.payload.axial];
        let rest =
            payload.into_iter().chain(self.payload.inertia_across).chain(self.payload.offset).chain(self.gravity);
        let mut all = self.bars.iter().flat_map(own).chain(motors).chain(weights).chain(angles).chain(rest);
        match all.find(|x| !x.is_finite()) {
            Some(x) => whole(format!("a number of the drawing is {}", shortened(&x.to_string(), 20)), "finite numbers"),
            None => Ok(()),
        }
    }
}

fn whole<T>(what: impl Into<String>, want: impl Into<String>) -> Result<T, SketchRefusal> {
    Err(SketchRefusal::new(Place::Whole, what, want))
}
