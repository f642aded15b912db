//! [`LimitArc`]: limits of a relative angle in a drawing, as the directions that a bar can have at a pin.

use std::f64::consts::{PI, TAU};

use super::classes::Classes;
use super::drawing::{Bar, PinId, Sketch};
use super::graph::Graph;
use super::step::SketchStep;
use crate::kinematics::closest_turn;
use crate::machine::{Angle, MAX_ANGLE};
use crate::planar::{Vector, dot, unit};

/// Minimum span between lower and upper limit, and minimum difference of this span from a full turn, rad.
const MIN_SPAN: f64 = PI / 180.0;

/// Limits of the angle between two drives, at a pin where bars of both meet.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitArc {
    /// The drive whose angle is added.
    pub to: String,
    /// The drive whose angle is subtracted.
    pub from: String,
    /// The pin.
    pub pin: PinId,
    /// Lower and upper limit, rad.
    pub range: [f64; 2],
    /// The angle as it is drawn, rad.
    pub now: f64,
    /// Direction of the bar at angle 0, rad, from the x axis.
    zero: f64,
    offset: f64,
}

impl LimitArc {
    /// Returns the direction of the bar at an angle, rad.
    pub fn direction(&self, angle: f64) -> Vector {
        unit(self.zero + angle)
    }

    /// Returns the limits with the lower (0) or upper (1) one dragged to a direction, in whole steps of `step` rad, if
    /// it is above 0.
    pub fn dragged(&self, end: usize, way: Vector, step: f64) -> [f64; 2] {
        let mut ends = self.range;
        let other = ends[1 - end.min(1)];
        let wanted = closest_turn(way.arg() - self.zero, ends[end.min(1)]);
        let wanted = if step > 0.0 { (wanted / step).round() * step } else { wanted };
        ends[end.min(1)] = match end {
            0 => wanted.max(other - TAU + MIN_SPAN).max(-MAX_ANGLE).min(other - MIN_SPAN),
            _ => wanted.min(other + TAU - MIN_SPAN).min(MAX_ANGLE).max(other + MIN_SPAN),
        };
        ends
    }

    /// Returns the step that sets other limits, rad.
    pub fn step(&self, range: [f64; 2]) -> SketchStep {
        SketchStep::Limits { to: self.to.clone(), from: self.from.clone(), offset: self.offset, range: Some(range) }
    }
}

impl Sketch {
    /// Returns the angle of a drive's arm from that of another as it is drawn, rad, without an offset; `None` where a
    /// drive turns no bar.
    pub fn drawn_angle(&self, to: &str, from: &str) -> Option<f64> {
        Some(closest_turn(self.arm(to)?.0.arg() - self.arm(from)?.0.arg(), 0.0))
    }

    /// Returns the arcs of all limits, in the order of the angles. An angle has none without limits, or if bars of its
    /// drives meet nowhere.
    pub fn limit_arcs(&self) -> Vec<LimitArc> {
        if self.angles.iter().all(|angle| angle.min.is_none()) {
            return Vec::new();
        }
        let classes = Classes::of(self, &self.recognised(&Graph::of(self)));
        self.angles.iter().filter_map(|angle| self.limit_arc(&classes, angle)).collect()
    }

    fn limit_arc(&self, classes: &Classes, angle: &Angle) -> Option<LimitArc> {
        let range = [angle.min?, angle.max?];
        let of = |drive: &str, pin: PinId| {
            let mut all =
                self.bars.iter().enumerate().filter(|(i, bar)| bar.has(pin) && classes.drive(self, *i) == Some(drive));
            all.next().map(|(_, bar)| bar)
        };
        let meet = |pin: PinId| of(&angle.from, pin).and_then(|_| Some((pin, of(&angle.to, pin)?)));
        let motor = self.motor(&angle.to).map(|motor| motor.pin);
        let (pin, bar) = motor.into_iter().chain(self.pins.iter().map(|pin| pin.id)).find_map(meet)?;
        let [(to, _), (from, _)] = [self.arm(&angle.to)?, self.arm(&angle.from)?];
        // The bar as it leaves the pin: along the arm of its drive, or against it.
        let turn = if dot(to, self.away(bar, pin)) < 0.0 { PI } else { 0.0 };
        let now = closest_turn(to.arg() - from.arg() + angle.offset, 0.5 * (range[0] + range[1]));
        let (to, offset) = (angle.to.clone(), angle.offset);
        Some(LimitArc { to, from: angle.from.clone(), pin, range, now, zero: from.arg() - offset + turn, offset })
    }

    /// Returns the way from a pin of a bar to the farther of its ends.
    fn away(&self, bar: &Bar, pin: PinId) -> Vector {
        let ways = [bar.root, bar.tip].map(|end| self.at(end) - self.at(pin));
        if ways[0].norm() > ways[1].norm() { ways[0] } else { ways[1] }
    }
}
