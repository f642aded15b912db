//! Drawing a bar from one place to another.

use super::drawing::{Bar, BarId, MIN_DISTANCE, PinId, Place, Sketch, mm};
use super::graph::Graph;
use super::loops::{LoopShape, LoopState};
use super::refusal::SketchRefusal;
use super::step::{BarEnd, SketchStep};
use crate::machine::{MAX_LINKS, Part};
use crate::planar::{Vector, cross};

impl Sketch {
    pub(super) fn with_bar(&self, from: BarEnd, to: BarEnd, name: Option<&str>) -> Result<Self, SketchRefusal> {
        if self.bars.len() >= MAX_LINKS {
            let what = format!("the machine has {MAX_LINKS} bars");
            return Err(SketchRefusal::new(Place::Whole, what, format!("at most {MAX_LINKS}")));
        }
        let mut next = self.clone();
        let (start, end) = (next.pin_at(from)?, next.pin_at(to)?);
        let length = (next.at(end) - next.at(start)).norm();
        if start == end || length < MIN_DISTANCE {
            let what = format!("the bar would be {} long", mm(length));
            let want = format!("two places at least {} apart", mm(MIN_DISTANCE));
            return Err(SketchRefusal::new(self.place_of(end), what, want));
        }
        if let Some(taken) = next.bars.iter().find(|bar| bar.has(start) && bar.has(end)) {
            let what = format!("bar {} joins these two pins already", taken.name);
            let want = "a bar to another pin; one over another would only carry the same load twice";
            return Err(SketchRefusal::new(Place::Bar(taken.id), what, want));
        }
        let base = next.pins.iter().position(|pin| pin.id == next.base).unwrap_or_default();
        let (_, far) = Graph::of(&next).distances(base);
        let is_connected = |id: PinId| next.pins.iter().zip(&far).any(|(pin, far)| pin.id == id && far.is_some());
        let (root, tip) = if is_connected(end) && !is_connected(start) { (end, start) } else { (start, end) };
        let id = BarId(next.next_id());
        next.bars.push(Bar {
            id,
            name: name.map_or_else(|| self.free_bar_name(), Into::into),
            root,
            tip,
            pins: Vec::new(),
            length: None,
            drive: None,
            against: false,
            per_metre: 1.0,
            body: None,
        });
        next.parts.extend(next.bars.last().map(|bar| Part::drawn(&bar.name)));
        match next.outside_loop(id) {
            None => Ok(next),
            Some(state) => {
                let refusal =
                    SketchRefusal::new(self.place_of(end), next.outside_reason(&state), Self::wanted_loop(&state));
                let proposals = self.instead(&next, &state, from, start, end);
                Err(refusal.or(proposals.into_iter().filter(|step| self.with(step).is_ok())))
            }
        }
    }

    /// Returns a loop outside the family that a bar belongs to.
    pub(super) fn outside_loop(&self, id: BarId) -> Option<LoopState> {
        let loops = self.recognised(&Graph::of(self)).into_iter().map(|found| found.state);
        loops.filter(|state| state.bars.contains(&id)).find(|state| state.shape == LoopShape::Outside)
    }

    /// Returns the place of a pin for a message: the whole if it is new.
    fn place_of(&self, pin: PinId) -> Place {
        self.pin(pin).map_or(Place::Whole, |pin| Place::Pin(pin.id))
    }

    /// Returns the bars that would do instead of one which makes a loop outside the family: to where a parallelogram
    /// closes, and to a free end.
    fn instead(&self, next: &Self, state: &LoopState, from: BarEnd, start: PinId, end: PinId) -> Vec<SketchStep> {
        let Some(last) = next.bars.last() else { return Vec::new() };
        let mut steps = Vec::new();
        if let (4, Some(own)) = (state.bars.len(), state.bars.iter().position(|id| *id == last.id)) {
            let pin = |i: usize| state.pins[(own + i) % 4];
            // The bar runs from pin 3 to pin 0, or back; the bar across from pin 1 to pin 2.
            let (across, other) = match pin(3) == start {
                true => (next.at(pin(1)) - next.at(pin(2)), state.bars[(own + 1) % 4]),
                false => (next.at(pin(2)) - next.at(pin(1)), state.bars[(own + 3) % 4]),
            };
            let corner = next.at(start) + across;
            if let Some(bar) = self.bar(other) {
                let away = corner - self.at(bar.root);
                if cross(self.direction(bar), away).abs() < 1e-9 {
                    let along = (away * self.direction(bar).conj()).re;
                    steps.push(SketchStep::Bar { from, to: BarEnd::on(other, along), name: None });
                }
            }
            steps.push(SketchStep::Bar { from, to: BarEnd::At([corner.re, corner.im]), name: None });
        }
        let beside = 0.5 * (next.at(start) + next.at(end));
        steps.push(SketchStep::Bar { from, to: BarEnd::At([beside.re, beside.im]), name: None });
        steps
    }

    /// Returns the pin at an end of a bar, which is made if there is none.
    pub(super) fn pin_at(&mut self, end: BarEnd) -> Result<PinId, SketchRefusal> {
        match end {
            BarEnd::Pin(at) => self.known_pin(at.pin).map(|()| at.pin),
            BarEnd::On(on) => self.pin_on(on.bar, on.along),
            BarEnd::At([x, y]) => {
                let at = Vector::new(x, y);
                match self.pins.iter().find(|pin| (self.at(pin.id) - at).norm() < MIN_DISTANCE) {
                    None => Ok(self.add_pin(at)),
                    Some(pin) => {
                        let what = "two pins would be at one place";
                        Err(SketchRefusal::new(Place::Pin(pin.id), what, "the pin that is there already"))
                    }
                }
            }
        }
    }

    /// Returns the pin on a bar, `along` m from its root, which is made if there is none.
    pub(super) fn pin_on(&mut self, id: BarId, along: f64) -> Result<PinId, SketchRefusal> {
        let bar = self.known_bar(id)?.clone();
        if let Some(pin) = bar.all_pins().find(|pin| (self.along(&bar, *pin) - along).abs() < MIN_DISTANCE) {
            return Ok(pin);
        }
        let at = self.at(bar.root) + self.direction(&bar).scale(along);
        if !(at.re.is_finite() && at.im.is_finite()) {
            let what = format!("the place on bar {} is not a finite number", bar.name);
            return Err(SketchRefusal::new(Place::Bar(id), what, "its distance from the root in m"));
        }
        let pin = self.add_pin(at);
        if let Some(own) = self.bar_mut(id) {
            own.pins.push(pin);
        }
        Ok(pin)
    }
}
