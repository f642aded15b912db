//! Deleting bars and pins, and what is then on nothing.

use super::drawing::{BarId, PinId, Place, Sketch};
use super::recount::Recount;
use super::refusal::SketchRefusal;

impl Sketch {
    pub(super) fn without_bar(&self, id: BarId) -> Result<Self, SketchRefusal> {
        self.known_bar(id)?;
        let mut next = self.clone();
        next.bars.retain(|bar| bar.id != id);
        next.tidy();
        Ok(next)
    }

    pub(super) fn without_pin(&self, id: PinId) -> Result<Self, SketchRefusal> {
        self.known_pin(id)?;
        if id == self.base {
            let what = "B is where the machine stands";
            return Err(SketchRefusal::new(Place::Pin(id), what, "another pin, or the bars at B deleted"));
        }
        let mut next = self.clone();
        next.bars.retain(|bar| !bar.has(id) || !bar.pins.is_empty());
        let touched: Vec<BarId> = next.bars_at(id).map(|bar| bar.id).collect();
        for bar in touched {
            next.shorten(bar, id);
        }
        next.tidy();
        Ok(next)
    }

    /// Takes a pin off a bar of more than two pins. The outermost of the others becomes its end instead; parts from root
    /// to tip reach to that.
    fn shorten(&mut self, id: BarId, pin: PinId) {
        let Some(bar) = self.bar(id).cloned() else { return };
        let mut rest: Vec<PinId> = bar.all_pins().filter(|own| *own != pin).collect();
        rest.sort_by(|a, b| self.along(&bar, *a).total_cmp(&self.along(&bar, *b)));
        let (Some(first), Some(last)) = (rest.first().copied(), rest.last().copied()) else { return };
        let (root, tip) = match (bar.root == pin, bar.tip == pin) {
            (true, _) => (first, if first == bar.tip { last } else { bar.tip }),
            (_, true) => (bar.root, if last == bar.root { first } else { last }),
            _ => (bar.root, bar.tip),
        };
        let (from, turned) = (self.along(&bar, root), self.along(&bar, tip) < self.along(&bar, root));
        let spanning = self.spanning(&bar);
        self.measure_from(id, root, tip, from, turned);
        self.span_again(&spanning);
        if let Some(own) = self.bar_mut(id) {
            own.pins.retain(|own| *own != pin);
        }
    }

    /// Measures a bar from another root, `from` m along its axis, towards another tip; its mass stays where it is.
    pub(super) fn measure_from(&mut self, id: BarId, root: PinId, tip: PinId, from: f64, turned: bool) {
        let sense = if turned { -1.0 } else { 1.0 };
        let Some(bar) = self.bar(id).cloned() else { return };
        let length = (self.along(&bar, tip) - from).abs();
        self.recount(&bar.name, &Recount { from, sense, was: self.length(&bar), length });
        let Some(bar) = self.bar_mut(id) else { return };
        let pins: Vec<PinId> = bar.all_pins().filter(|pin| *pin != root && *pin != tip).collect();
        (bar.root, bar.tip, bar.pins) = (root, tip, pins);
        bar.against ^= turned && bar.drive.is_some();
        if let Some(body) = &mut bar.body {
            body.com = body.com.map(|com| sense * (com - from));
            body.com_normal = body.com_normal.map(|across| sense * across);
        }
        if self.end_effector.is_some_and(|end| end.bar == id) {
            self.payload.offset = self.payload.offset.map(|x| sense * x);
        }
    }

    /// Removes what is on nothing: pins of no bar, motors without a place, an end effector on no bar.
    pub(super) fn tidy(&mut self) {
        let base = self.base;
        let bars = std::mem::take(&mut self.bars);
        self.pins.retain(|pin| pin.id == base || bars.iter().any(|bar| bar.has(pin.id)));
        self.bars = bars;
        let pins: Vec<PinId> = self.pins.iter().map(|pin| pin.id).collect();
        let bars = &self.bars;
        let carries = |bar: BarId, pin: PinId| bars.iter().any(|own| own.id == bar && own.has(pin));
        self.motors.retain(|motor| pins.contains(&motor.pin) && motor.stator.is_none_or(|bar| carries(bar, motor.pin)));
        self.end_effector = self.end_effector.filter(|end| carries(end.bar, end.pin));
        let names: Vec<String> = self.motors.iter().map(|motor| motor.drive.name.clone()).collect();
        for bar in &mut self.bars {
            if bar.drive.as_ref().is_some_and(|drive| !names.contains(drive)) {
                (bar.drive, bar.against) = (None, false);
            }
        }
        self.angles.retain(|angle| names.contains(&angle.to) && names.contains(&angle.from));
        let bars = &self.bars;
        let is_left = |link: &String| bars.iter().any(|bar| bar.name == *link);
        self.counterweights.retain(|weight| is_left(&weight.link));
        self.parts.retain(|part| is_left(&part.link));
        self.lumps.retain(|lump| is_left(&lump.link));
    }
}
