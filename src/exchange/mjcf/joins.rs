//! What joins the bodies of a machine: tendons for sums of hinge angles, equalities, and motors.

use super::{Joins, MjcfError, Model};
use crate::placed::Placed;
use crate::tree::TreePart;
use crate::turn::PinAngleSum;
use crate::xml::quoted;
use stillbase_mechanics::machine::Machine;

impl Joins {
    pub(super) fn of(of: &Placed<'_>) -> Result<Self, MjcfError> {
        let machine = of.machine;
        let motor = |k: usize| {
            let idle = || MjcfError::Idle { drive: of.told(&machine.spec().drives[k].name) };
            PinAngleSum::of_drives(machine, machine.motors().on(k), k).ok_or_else(idle)
        };
        let motors = (0..machine.drives()).map(motor).collect::<Result<_, _>>()?;
        Ok(Self { motors, limited: limited(machine), parallel: parallel(machine) })
    }
}

impl Model<'_> {
    /// Returns sums of hinge angles as fixed tendons.
    pub(super) fn tendons(&self, i: usize) -> Vec<String> {
        let (Placed { machine, tree, carries, .. }, Joins { motors, limited, parallel }) =
            (&self.of.machines[i], &self.joins[i]);
        let mut lines = Vec::new();
        let mut add = |name: String, more: &str, hinges: Vec<(String, f64)>| {
            lines.push(format!("<fixed name=\"{name}\"{more}>"));
            let joint = |(hinge, by)| format!("  <joint joint=\"{hinge}\" coef=\"{by}\"/>");
            lines.extend(hinges.into_iter().map(joint));
            lines.push("</fixed>".to_owned());
        };
        let pins = |turn: &PinAngleSum| turn.pins.iter().map(|(j, by)| (self.hinge(i, *j), *by)).collect::<Vec<_>>();
        for (k, turn) in motors.iter().enumerate().filter(|(_, turn)| turn.pin().is_none()) {
            add(tree.of_drive("drive", k), "", pins(turn));
        }
        for k in (0..motors.len()).filter(|k| self.has_rotor(i, *k) && motors[*k].pin().is_none()) {
            add(tree.of_drive("rotor", k), "", vec![(self.rotor_hinge(i, k), 1.0)]);
        }
        // A hinge can have only one range.
        let on_hinge = |i: usize| {
            let pin = limited[i].1.pin();
            pin.is_some() && limited[..i].iter().all(|(_, turn, _)| turn.pin() != pin)
        };
        for (_, (name, turn, [least, most])) in limited.iter().enumerate().filter(|(i, _)| !on_hinge(*i)) {
            add(tree.own(name), &format!(" range=\"{least} {most}\""), pins(turn));
        }
        for (j, turn) in parallel {
            add(direction_of(&tree.name(TreePart::Link(*j))), "", pins(turn));
        }
        if !carries.is_empty() {
            let mut all = pins(&PinAngleSum::between(machine, None, machine.end_link()));
            all.push((tree.holder(TreePart::Platform), 1.0));
            add(direction_of(&tree.name(TreePart::Platform)), "", all);
        }
        lines
    }

    pub(super) fn equalities(&self, i: usize) -> Vec<String> {
        let (Placed { machine, tree, carries, .. }, Joins { motors, parallel, .. }) =
            (&self.of.machines[i], &self.joins[i]);
        let mut lines = Vec::new();
        // If each link is kept parallel, the loops stay closed without further equalities.
        if parallel.is_empty() {
            for number in 1..=machine.loops().len() {
                let [name, a, b] = ["", " a", " b"].map(|side| tree.own(format_args!("loop {number}{side}")));
                lines.push(format!("<connect name=\"{name}\" site1=\"{a}\" site2=\"{b}\"/>"));
            }
        }
        let platform = (!carries.is_empty()).then_some(TreePart::Platform);
        for part in parallel.iter().map(|(j, _)| TreePart::Link(*j)).chain(platform) {
            let direction = direction_of(&tree.name(part));
            lines.push(format!("<tendon tendon1=\"{direction}\" polycoef=\"0 0 0 0 0\"/>"));
        }
        for (k, drive) in machine.spec().drives.iter().enumerate().filter(|(k, _)| self.has_rotor(i, *k)) {
            let (name, ratio) = (tree.of_drive("gear", k), drive.rotor.map_or(1.0, |rotor| rotor.ratio));
            let pair = match motors[k].pin() {
                Some(j) => {
                    let (rotor, hinge) = (self.rotor_hinge(i, k), self.hinge(i, j));
                    format!("<joint name=\"{name}\" joint1=\"{rotor}\" joint2=\"{hinge}\"")
                }
                None => {
                    let [rotor, drive] = ["rotor", "drive"].map(|what| tree.of_drive(what, k));
                    format!("<tendon name=\"{name}\" tendon1=\"{rotor}\" tendon2=\"{drive}\"")
                }
            };
            lines.push(format!("{pair} polycoef=\"0 {ratio} 0 0 0\"/>"));
        }
        lines
    }

    pub(super) fn actuators(&self, i: usize) -> Vec<String> {
        let Placed { machine, tree, .. } = &self.of.machines[i];
        let motor = |(k, turn): (usize, &PinAngleSum)| {
            let name = tree.of_drive("drive", k);
            let on = match turn.pin() {
                Some(j) => format!("joint=\"{}\"", self.hinge(i, j)),
                None => format!("tendon=\"{name}\""),
            };
            let limit = machine.spec().drives[k].torque_limit;
            let range = limit.map_or(String::new(), |most| format!(" ctrlrange=\"{} {most}\"", -most));
            format!("<motor name=\"{name}\" {on}{range}/>")
        };
        self.joins[i].motors.iter().enumerate().map(motor).collect()
    }
}

/// Returns the name of the tendon that keeps the direction of a part.
fn direction_of(part: &str) -> String {
    format!("direction of {part}")
}

/// Returns the relative angles with limits: name, sum of pin angles, and limits, rad.
fn limited(machine: &Machine) -> Vec<(String, PinAngleSum, [f64; 2])> {
    let angles = machine.angles().iter().filter(|a| a.limits.start().is_finite() && a.limits.end().is_finite());
    angles
        .filter_map(|a| {
            let turn = PinAngleSum::of_drives(machine, Some(a.from), a.to)?;
            Some((format!("angle_{}", quoted(&a.name)), turn, [a.limits.start() - a.offset, a.limits.end() - a.offset]))
        })
        .collect()
}

/// Returns the links that need an equality to stay parallel to the first link of their drive, or to the base, with the
/// angle between the two. Empty if the loops keep all links parallel.
pub(crate) fn parallel(machine: &Machine) -> Vec<(usize, PinAngleSum)> {
    let parts = machine.resolved_links();
    if machine.ground().is_none() && parts.len() == machine.drives() + 2 * machine.loops().len() {
        return Vec::new();
    }
    let first = |k: usize| parts.iter().position(|part| part.drive == k);
    let of = |j: usize| {
        if machine.drive_of_link(j).is_none() {
            return Some((j, PinAngleSum::between(machine, None, j)));
        }
        let first = first(parts[j].drive).filter(|first| *first != j)?;
        Some((j, PinAngleSum::between(machine, Some(first), j)))
    };
    (0..parts.len()).filter_map(of).collect()
}
