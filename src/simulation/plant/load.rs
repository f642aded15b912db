//! [`Load`]: a temporary payload.

use stillbase_mechanics::machine::{Machine, MachineError, Payload};
use stillbase_settings::key::Key;
use stillbase_settings::keyed::keyed;
use stillbase_settings::range::Range;

/// Maximum mass of the temporary payload, kg; also the maximum of its inertia, kg m², and of friction, N m and N m s.
pub const MAX_PAYLOAD: f64 = 1e4;

const TIME_RANGE: Range = Range::new(0.0, 1e6, "s");
const PLACE_RANGE: Range = Range::either_way(1e3, "m");
const WHEN_PAYLOAD: &str = "plant.payload.mass or plant.payload.inertia above 0";

keyed! {
    /// A payload that the model does not contain, and the time interval in which it is held.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Load at "plant.payload" {
        /// Mass of a payload that only the law payload-compensation knows of; it adds to the machine's own payload.
        mass: f64 = "0", range: Range::new(0.0, MAX_PAYLOAD, "kg"), saved: always;
        /// Inertia of the payload about its own centre of mass.
        inertia: f64 = "0", range: Range::new(0.0, MAX_PAYLOAD, "kg m²");
        /// Centre of mass of the payload, seen from the end effector: along the link that holds it, and to its left.
        offset: [f64; 2] = "0,0", range: PLACE_RANGE, when: WHEN_PAYLOAD => Load::is_some;
        /// Height of the payload's centre of mass along the drives' axis.
        axial: f64 = "0", range: PLACE_RANGE, when: WHEN_PAYLOAD => Load::is_some;
        // The hand moves along, so that rates do not change at pick-up.
        /// Time at which the payload is picked up, by a hand that moves with it.
        from: f64 = "0", range: TIME_RANGE, when: WHEN_PAYLOAD => Load::is_some;
        /// Time at which the payload is released.
        until: Option<f64> = Key::NONE, range: TIME_RANGE, instead: "it is held to the end",
            when: WHEN_PAYLOAD => Load::is_some;
    }
}

impl Load {
    /// Returns whether there is a payload.
    pub fn is_some(&self) -> bool {
        self.mass > 0.0 || self.inertia > 0.0
    }

    /// Returns whether the payload is held at a time, s. With a `slack` of half a step, s, pick-up and release are
    /// rounded to whole steps.
    pub fn is_held(&self, time: f64, slack: f64) -> bool {
        self.is_some() && time >= self.from - slack && self.until.is_none_or(|until| time < until - slack)
    }

    /// Returns this load as the payload of a machine.
    pub fn payload(&self) -> Payload {
        Payload { mass: self.mass, inertia: self.inertia, offset: self.offset, axial: self.axial, ..Payload::default() }
    }

    /// Returns a machine with this payload added to its own.
    ///
    /// # Errors
    /// If the result is not a valid machine.
    pub fn held_by(&self, machine: &Machine) -> Result<Machine, MachineError> {
        let mut spec = machine.spec().clone();
        spec.payload = spec.payload.and(self.payload());
        Machine::new(spec)
    }
}
