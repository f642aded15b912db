//! [`Sketch::of`]: draws a machine.

use std::f64::consts::FRAC_PI_4;

use super::body::Body;
use super::drawing::{Bar, BarId, EndEffector, Motor, PinId, Sketch};
use crate::machine::{Drive, Length, Machine, MachineSpec, RelativeAngle, place_of};
use crate::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector};

/// Distance along a link below which two points are one, m.
const SAME: f64 = 1e-9;
/// Direction of the first drive's arm, rad.
const FIRST_ARM: f64 = 1.9;
/// Where each relative angle is drawn, as a fraction of its range: in the middle parallelograms may go flat.
const FRACTION: f64 = 0.6;

/// A point of a link: its index, and the distance from its root, m.
type Point = (usize, f64);

/// Points of links in groups, each of which is one pin.
struct Pins {
    groups: Vec<Vec<Point>>,
}

impl Pins {
    fn group(&mut self, point: Point) -> usize {
        let is_same = |own: &Point| own.0 == point.0 && (own.1 - point.1).abs() < SAME;
        match self.groups.iter().position(|group| group.iter().any(is_same)) {
            Some(i) => i,
            None => {
                self.groups.push(vec![point]);
                self.groups.len() - 1
            }
        }
    }

    fn join(&mut self, a: Point, b: Point) {
        let (a, b) = (self.group(a), self.group(b));
        if a != b {
            let gone = self.groups.remove(a.max(b));
            self.groups[a.min(b)].extend(gone);
        }
    }
}

impl Sketch {
    /// Returns the drawing of a machine at drive angles, rad; by default in the pose in which it was drawn or,
    /// without one, near the middle of its limits.
    /// [`resolve`](super::resolve) makes the same machine of it again, except for the names of its lengths.
    pub fn of(machine: &Machine, at: Option<&DriveAngles>) -> Self {
        let drawn = machine.spec().pose.as_ref().filter(|pose| pose.len() == machine.drives());
        let usual =
            drawn.map_or_else(|| middle(machine), |pose| DriveAngles(PerDrive::from_fn(pose.len(), |k| pose[k])));
        let e = at.filter(|q| q.len() == machine.drives()).unwrap_or(&usual).units();
        let (spec, links) = (machine.spec(), machine.resolved_links());
        let mut pins = Pins { groups: vec![Vec::new()] };
        for (i, link) in links.iter().enumerate() {
            match link.parent {
                None => pins.groups[0].push((i, 0.0)),
                Some(parent) => pins.join((parent, link.at), (i, 0.0)),
            }
        }
        for closed in machine.loops() {
            pins.join((closed.a, closed.at_a), (closed.b, closed.at_b));
        }
        for (i, link) in links.iter().enumerate() {
            pins.group((i, link.length));
        }
        let end = end_place(machine);
        pins.group(end);
        let mut sketch = Self::blank();
        let mut ids = vec![sketch.base];
        for group in &pins.groups[1..] {
            let at = group.first().map_or_else(Vector::default, |(i, s)| place_of(&links[*i].point(*s), &e));
            ids.push(sketch.add_pin(at));
        }
        let mut id_of = |point: Point| ids[pins.group(point)];
        let ends: Vec<(PinId, PinId)> =
            links.iter().enumerate().map(|(i, link)| (id_of((i, 0.0)), id_of((i, link.length)))).collect();
        let end_pin = id_of(end);
        for (i, (link, (root, tip))) in spec.links.iter().zip(ends).enumerate() {
            let others = pins
                .groups
                .iter()
                .zip(&ids)
                .filter(|(group, id)| **id != root && **id != tip && group.iter().any(|(of, _)| *of == i));
            let others = others.map(|(_, id)| *id).collect();
            let id = BarId(sketch.next_id());
            sketch.bars.push(Bar {
                id,
                name: link.name.clone(),
                root,
                tip,
                pins: others,
                length: match &link.length {
                    Length::Named(name) => Some(name.clone()),
                    Length::Metres(_) => None,
                },
                drive: Some(link.drive.clone()),
                against: link.direction < 0,
                per_metre: 1.0,
                body: Some(Body::of(link)),
            });
        }
        sketch.take_parts(spec);
        for bar in &mut sketch.bars {
            bar.body = bar.body.filter(|body| !spec.has_parts(&bar.name) || *body != Body::default());
        }
        sketch.end_effector = sketch.bars.get(end.0).map(|bar| EndEffector { pin: end_pin, bar: bar.id });
        sketch.motors = spec.drives.iter().map(|drive| sketch.motor_of(drive)).collect();
        (sketch.name, sketch.summary) = (spec.name.clone(), spec.summary.clone());
        (sketch.gravity, sketch.payload) = (spec.gravity, spec.payload);
        (sketch.angles, sketch.counterweights) = (spec.angles.clone(), spec.counterweights.clone());
        sketch
    }

    /// Returns the motor of a drive: at B, or where a bar of its carrier meets one that it turns.
    fn motor_of(&self, drive: &Drive) -> Motor {
        let own = Drive { on: None, ..drive.clone() };
        let of = |name: &str| self.bars.iter().filter(|bar| bar.drive.as_deref() == Some(name)).collect::<Vec<&Bar>>();
        let Some(carriers) = drive.on.as_deref().map(of).filter(|bars| !bars.is_empty()) else {
            return Motor { pin: self.base, stator: None, drive: own };
        };
        let turned = of(&drive.name);
        let meets = |bar: &&Bar| bar.all_pins().find(|pin| turned.iter().any(|other| other.has(*pin)));
        let joint = carriers.iter().find_map(|bar| Some((meets(bar)?, bar.id)));
        let (pin, bar) = joint.unwrap_or((carriers[0].tip, carriers[0].id));
        Motor { pin, stator: Some(bar), drive: own }
    }

    /// Returns the drawing with the numbers of its machine after settings have changed it: drawn anew if it was
    /// complete, with the same identities; else with what has changed since the machine `was`, on bars and drives of
    /// the same names.
    #[must_use]
    pub fn following_machine(&self, was: &Machine, machine: &Machine) -> Self {
        let (spec, was) = (machine.spec(), was.spec());
        let mut next = self.clone();
        for motor in &mut next.motors {
            if let Some(drive) = spec.drives.iter().find(|drive| drive.name == motor.drive.name) {
                motor.drive = Drive { on: None, ..drive.clone() };
            }
        }
        (next.gravity, next.payload) = (spec.gravity, spec.payload);
        for angle in &mut next.angles {
            if let Some(own) = spec.angles.iter().find(|own| own.name == angle.name) {
                (angle.min, angle.max) = (own.min, own.max);
            }
        }
        let is_complete = self.machine().is_some();
        if is_complete || spec.counterweights != was.counterweights {
            let is_drawn = |link: &String| self.bars.iter().any(|bar| bar.name == *link);
            next.counterweights = spec.counterweights.iter().filter(|weight| is_drawn(&weight.link)).cloned().collect();
        }
        let lists = |spec: &MachineSpec| (spec.materials.clone(), spec.parts.clone(), spec.lumps.clone());
        if is_complete || lists(spec) != lists(was) {
            next.take_parts(spec);
        }
        if !is_complete {
            return next;
        }
        let mut next = next.redrawn(machine).unwrap_or(next);
        // Of a complete drawing every link is a bar, in the same order.
        let stated: Vec<Body> = next.bars.iter().map(|bar| next.stated(bar)).collect();
        for ((bar, link), stated) in next.bars.iter_mut().zip(&spec.links).zip(stated) {
            if Body::of(link) != stated {
                bar.body = Some(Body::of(link));
            }
        }
        // Where the drawing measures a bar from another end than its machine does, it is drawn anew.
        let is_same = |own: Machine| own.links() == machine.links() && own.resolved_links() == machine.resolved_links();
        if next.machine().is_some_and(is_same) { next } else { Self::of(machine, self.pose().as_ref()) }
    }

    /// Returns the drive angles of the pose in which it is drawn, rad, in the order of the motors; `None` while a drive
    /// turns no bar.
    pub fn pose(&self) -> Option<DriveAngles> {
        let angles = self.motors.iter().map(|motor| Some(self.arm(&motor.drive.name)?.0.arg()));
        let angles: Vec<f64> = angles.collect::<Option<_>>()?;
        (angles.len() <= MAX_DRIVES).then(|| DriveAngles(PerDrive::from_fn(angles.len(), |k| angles[k])))
    }

    /// Returns the drawing with the lengths of another machine of the same bars.
    fn redrawn(&self, machine: &Machine) -> Option<Self> {
        let mut next = self.clone();
        let inner = self.inner_pins();
        for (i, link) in machine.resolved_links().iter().enumerate() {
            let (bar, id) = (next.bars.get(i)?, self.bars.get(i)?.id);
            // Bars whose root lies away from the base keep their shape.
            if inner[i] == bar.root && (next.length(bar) - link.length).abs() > SAME {
                next = next.with_length(id, link.length).ok()?;
            }
        }
        Some(next)
    }
}

/// Returns the end effector as a point of a link.
fn end_place(machine: &Machine) -> Point {
    let link = machine.end_link();
    let own = &machine.resolved_links()[link];
    let drive = own.drive;
    (link, own.sign * (machine.end_effector()[drive] - own.root[drive]))
}

/// Returns a pose near the middle of the limits, rad, in which no two drives are parallel if there are no limits.
fn middle(machine: &Machine) -> DriveAngles {
    let n = machine.drives();
    let mut q: Vec<Option<f64>> = vec![None; n];
    let aim = |angle: &RelativeAngle| {
        let (low, high) = (*angle.limits.start(), *angle.limits.end());
        let relative = if low.is_finite() && high.is_finite() { low + FRACTION * (high - low) } else { -1.0 };
        relative - angle.offset
    };
    for k in 0..n {
        q[k] = q[k].or(Some(FIRST_ARM - FRAC_PI_4 * k as f64 * 0.9));
        for _ in 0..n {
            for angle in machine.angles() {
                match (q[angle.to], q[angle.from]) {
                    (None, Some(from)) => q[angle.to] = Some(from + aim(angle)),
                    (Some(to), None) => q[angle.from] = Some(to - aim(angle)),
                    _ => {}
                }
            }
        }
    }
    DriveAngles(PerDrive::from_fn(n, |k| q[k].unwrap_or_default()))
}
