//! Cutting bars in two, and making one of two bars or of two pins.

use super::drawing::{Bar, BarId, MIN_DISTANCE, PinId, Place, Sketch, mm};
use super::graph::Graph;
use super::loops::LoopShape;
use super::moving::STRAIGHT;
use super::refusal::SketchRefusal;
use super::step::SketchStep;
use crate::planar::cross;

impl Sketch {
    pub(super) fn split(&self, id: BarId, along: f64) -> Result<Self, SketchRefusal> {
        let bar = self.known_bar(id)?.clone();
        let length = self.length(&bar);
        if !(along >= MIN_DISTANCE && along <= length - MIN_DISTANCE) {
            let what = format!("bar {} has no inner place at {}", bar.name, mm(along));
            return Err(SketchRefusal::new(Place::Bar(id), what, format!("a place between 0 and {}", mm(length))));
        }
        let mut next = self.clone();
        let pin = next.pin_on(id, along)?;
        let beyond = |own: &PinId| self.along(&bar, *own) > along + 0.5 * MIN_DISTANCE;
        let (outer, inner): (Vec<PinId>, Vec<PinId>) =
            bar.pins.iter().copied().filter(|own| *own != pin).partition(beyond);
        let second =
            Bar { id: BarId(next.next_id()), name: next.free_bar_name(), root: pin, pins: outer, ..bar.clone() };
        let second = Bar { length: None, ..second };
        if let Some(first) = next.bar_mut(id) {
            (first.tip, first.pins, first.length) = (pin, inner, None);
        }
        for motor in next.motors.iter_mut().filter(|motor| motor.stator == Some(id)) {
            if motor.pin != pin && second.has(motor.pin) {
                motor.stator = Some(second.id);
            }
        }
        for end in next.end_effector.iter_mut().filter(|end| end.bar == id && end.pin != pin) {
            if second.has(end.pin) {
                end.bar = second.id;
            }
        }
        let name = second.name.clone();
        next.bars.push(second);
        next.divide(self, &bar, &name, along);
        Ok(next)
    }

    pub(super) fn joined(&self, id: BarId, with: BarId) -> Result<Self, SketchRefusal> {
        let (first, second) = (self.known_bar(id)?.clone(), self.known_bar(with)?.clone());
        let shared = first.all_pins().find(|pin| second.has(*pin)).filter(|_| id != with);
        let Some(shared) = shared else {
            let what = format!("bars {} and {} share no pin", first.name, second.name);
            return Err(SketchRefusal::new(Place::Bar(with), what, "two bars that meet at a pin"));
        };
        let off = cross(self.direction(&first), self.span(&second)).abs();
        if off > STRAIGHT {
            let what = format!("bar {} is {} off the line of bar {}", second.name, mm(off), first.name);
            return Err(SketchRefusal::new(Place::Pin(shared), what, "two bars on one line"));
        }
        let mut pins: Vec<PinId> = first.all_pins().chain(second.all_pins().filter(|pin| !first.has(*pin))).collect();
        pins.sort_by(|a, b| self.along(&first, *a).total_cmp(&self.along(&first, *b)));
        let (Some(root), Some(tip)) = (pins.first().copied(), pins.last().copied()) else { return Ok(self.clone()) };
        let mut next = self.clone();
        let (from, sense) =
            (self.along(&first, second.root), self.along(&first, second.tip) - self.along(&first, second.root));
        let sense = sense.signum();
        next.unite(&first, &second, from, sense);
        next.motors.iter_mut().filter(|motor| motor.stator == Some(with)).for_each(|motor| motor.stator = Some(id));
        for end in next.end_effector.iter_mut().filter(|end| end.bar == with) {
            end.bar = id;
            next.payload.offset = next.payload.offset.map(|x| sense * x);
        }
        if let Some(own) = next.bar_mut(id) {
            own.pins = pins.into_iter().filter(|pin| *pin != own.root && *pin != own.tip).collect();
            own.length = None;
        }
        next.measure_from(id, root, tip, self.along(&first, root), false);
        next.bars.retain(|bar| bar.id != with);
        next.tidy();
        Ok(next)
    }

    pub(super) fn attached(&self, pin: PinId, id: BarId) -> Result<Self, SketchRefusal> {
        self.known_pin(pin)?;
        let bar = self.known_bar(id)?;
        if bar.has(pin) {
            let what = format!("the pin is on bar {} already", bar.name);
            return Err(SketchRefusal::new(Place::Pin(pin), what, "a pin of another bar"));
        }
        let mut next = self.clone();
        let onto = next.pin_on(id, self.along(bar, pin))?;
        next.welded(pin, onto)
    }

    pub(super) fn welded(&self, pin: PinId, onto: PinId) -> Result<Self, SketchRefusal> {
        self.known_pin(pin)?;
        self.known_pin(onto)?;
        let (pin, onto) = if pin == self.base { (onto, pin) } else { (pin, onto) };
        let refused = |what: String, want: &str| Err(SketchRefusal::new(Place::Pin(pin), what, want));
        if pin == onto {
            return refused("a pin cannot be joined with itself".into(), "two pins");
        }
        if let Some(bar) = self.bars.iter().find(|bar| bar.has(pin) && bar.has(onto)) {
            return refused(format!("both pins are on bar {}", bar.name), "pins of different bars");
        }
        let mut next = self.moved(pin, self.at(onto))?;
        if (next.at(pin) - next.at(onto)).norm() > STRAIGHT {
            let what = "the other pin hangs on this one and would move away".to_owned();
            return refused(what, "the other pin moved onto this one").map_err(|refusal: SketchRefusal| {
                refusal.or(Some(SketchStep::Weld { pin: onto, onto: pin }).filter(|_| onto != self.base))
            });
        }
        let become_one = |own: &mut PinId| {
            if *own == pin {
                *own = onto;
            }
        };
        for bar in &mut next.bars {
            [&mut bar.root, &mut bar.tip].into_iter().chain(&mut bar.pins).for_each(become_one);
        }
        next.motors.iter_mut().for_each(|motor| become_one(&mut motor.pin));
        next.end_effector.iter_mut().for_each(|end| become_one(&mut end.pin));
        next.pins.retain(|own| own.id != pin);
        let had = self.recognised(&Graph::of(self)).into_iter().filter(|found| found.state.shape == LoopShape::Outside);
        let had: Vec<Vec<BarId>> = had.map(|found| found.state.bars).collect();
        let loops = next.recognised(&Graph::of(&next)).into_iter().map(|found| found.state);
        let outside = |state: &super::loops::LoopState| state.shape == LoopShape::Outside && !had.contains(&state.bars);
        if let Some(state) = loops.filter(|state| state.pins.contains(&onto)).find(outside) {
            return Err(SketchRefusal::new(Place::Pin(onto), next.outside_reason(&state), Self::wanted_loop(&state)));
        }
        Ok(next)
    }
}
