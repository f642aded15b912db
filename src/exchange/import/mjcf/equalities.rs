//! Bodies that equalities keep parallel, and gears.

use roxmltree::Node;

use super::coupled::{CoupledBodies, GearedPart, HingeSum, PARALLEL_WANTED, unsigned};
use crate::import::bodies::{is_active, polynomial};
use crate::import::defaults::Element;
use crate::import::linkage::MAX_PARTS;
use crate::import::read::{AttributeSource, each};
use crate::import::refusal::{ImportError, element_error};
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::quote_clipped;

/// Tolerance of an equality of a tendon in the pose of the file, rad.
const EQUALITY_TOLERANCE_RAD: f64 = 1e-6;
/// Tolerance for a centre of mass on an axis: the ratio of its distances from the axis and from the hinge point. A
/// distance from the hinge point below 1 m counts as 1 m.
const ON_AXIS_TOLERANCE: f64 = 1e-9;

/// An equality of two sums of hinges: `one` is `ratio` times `other`.
struct Coupling<'a> {
    node: Node<'a, 'a>,
    one: HingeSum,
    other: HingeSum,
    ratio: f64,
}

impl<'a> CoupledBodies<'a> {
    /// Reads the equalities. Loops come last, because they are easier to resolve if parallel bodies are known.
    pub(super) fn couple(&mut self) -> Result<(), ImportError> {
        let all = each(self.bodies.model, "equality").flat_map(|node| node.children()).filter(Node::is_element);
        let (mut loops, mut couplings) = (Vec::new(), Vec::new());
        for (count, node) in all.enumerate() {
            if count == MAX_PARTS {
                return Err(element_error(node, "too many equalities", format!("at most {MAX_PARTS}")));
            }
            let element = self.bodies.element(node)?;
            if !is_active(&element) {
                continue;
            }
            match node.tag_name().name() {
                "connect" => loops.push(node),
                "joint" => couplings.extend(self.joint_equality(&element)?),
                "tendon" => couplings.extend(self.tendon_equality(&element)?),
                kind => {
                    let what = format!("an equality of kind \"{}\"", quote_clipped(kind));
                    return Err(element_error(node, what, "connect, joint or tendon"));
                }
            }
        }
        let driven = self.driven()?;
        let (rotors, mut others): (Vec<_>, Vec<_>) =
            couplings.into_iter().partition(|coupling| self.is_rotor(coupling, &driven));
        self.join_parallel(&mut others);
        for node in loops {
            let ends = self.bodies.ends(node)?;
            self.close(node, &ends)?;
            self.loops.push(ends);
        }
        self.join_parallel(&mut others);
        for Coupling { node, one, other, ratio } in rotors.into_iter().chain(others) {
            let [(part, times)] = one[..] else {
                return Err(element_error(
                    node,
                    "it couples sums of hinges that keep no bodies parallel",
                    PARALLEL_WANTED,
                ));
            };
            self.geared.push(GearedPart { part, node, to: other, ratio: ratio * times });
        }
        Ok(())
    }

    /// Joins the sets that couplings A − B = ±(C − D) keep parallel, and drops these couplings. Their other form is
    /// A + D = B + C or A + C = B + D. If a term on the left turns with one on the right, so do the other two.
    fn join_parallel(&mut self, couplings: &mut Vec<Coupling<'a>>) {
        let mut count = usize::MAX;
        while couplings.len() < count {
            count = couplings.len();
            couplings.retain(|coupling| !self.is_parallel(coupling));
        }
    }

    fn is_parallel(&mut self, coupling: &Coupling<'a>) -> bool {
        let (Some((a, b)), Some((c, d))) = (self.against(&coupling.one), self.against(&coupling.other)) else {
            return false;
        };
        let (more, less) = match coupling.ratio {
            1.0 => ([a, d], [b, c]),
            -1.0 => ([a, c], [b, d]),
            _ => return false,
        };
        let pairs = (0..4).map(|i| (i / 2, i % 2));
        let same = pairs.into_iter().find(|(i, j)| self.set(more[*i]) == self.set(less[*j]));
        if let Some((i, j)) = same {
            self.together.join(more[1 - i], less[1 - j]);
        }
        same.is_some()
    }

    /// Returns whether a coupling drives a rotor: a body without children or sites that is balanced about its hinge.
    /// The coupling must be to a sum of hinges that a motor turns.
    fn is_rotor(&self, coupling: &Coupling<'a>, driven: &[HingeSum]) -> bool {
        let [(part, _)] = coupling.one[..] else { return false };
        let parts = &self.bodies.parts;
        let carries = parts.iter().any(|other| other.parent == Some(part))
            || self.bodies.sites.iter().any(|(_, (own, _))| *own == Some(part));
        let off = parts[part].hinge.map_or(0.0, |(axis, on)| {
            let away = parts[part].com - on;
            (away - axis.into_inner() * axis.dot(&away)).norm() / away.norm().max(1.0)
        });
        !carries && off <= ON_AXIS_TOLERANCE && driven.contains(&unsigned(&coupling.other))
    }

    /// Returns the sums of hinges that motors turn.
    fn driven(&self) -> Result<Vec<HingeSum>, ImportError> {
        self.actuators()?.into_iter().map(|(element, _)| Ok(unsigned(&self.moved(&element)?))).collect()
    }

    fn joint_equality(&mut self, element: &Element<'a>) -> Result<Option<Coupling<'a>>, ImportError> {
        let node = element.node();
        let part = self.bodies.part_of(node, "joint1")?;
        if !node.has_attribute("joint2") {
            self.together.join(self.owner(Some(part)), self.on(part));
            return Ok(None);
        }
        let of = self.bodies.part_of(node, "joint2")?;
        let ratio = linear(element)? * self.signs[part] * self.signs[of];
        Ok(Some(Coupling { node, one: vec![(part, 1.0)], other: vec![(of, 1.0)], ratio }))
    }

    fn tendon_equality(&mut self, element: &Element<'a>) -> Result<Option<Coupling<'a>>, ImportError> {
        let node = element.node();
        let one = self.tendon(node, "tendon1")?;
        let factors = polynomial(element)?;
        let other = node.has_attribute("tendon2").then(|| self.tendon(node, "tendon2")).transpose()?;
        let x = other.as_ref().map_or(0.0, |other| self.stretch(other));
        let off = self.stretch(&one) - factors.iter().rev().fold(0.0, |sum, factor| sum * x + factor);
        match other {
            // Only an equality without a second tendon fixes an angle: gears may have any offset.
            None if off.abs() > EQUALITY_TOLERANCE_RAD => {
                let what = format!("its tendon is off by {} rad in the pose of the file", ShortNumber(off));
                Err(element_error(node, what, "a keyframe in which every equality holds"))
            }
            None => {
                let (to, from) = self.turned(node, &one)?;
                self.together.join(to, from);
                Ok(None)
            }
            Some(other) => Ok(Some(Coupling { node, one, other, ratio: linear(element)? })),
        }
    }

    /// Returns the change of a sum of hinges from the angles that the elements state to the pose of the file, rad.
    fn stretch(&self, sum: &[(usize, f64)]) -> f64 {
        sum.iter()
            .map(|(i, times)| times * self.signs[*i] * (self.bodies.angle(*i) - self.bodies.drawn_angle(*i)))
            .sum()
    }
}

/// Returns the ratio N of a linear coupling.
fn linear(element: &Element<'_>) -> Result<f64, ImportError> {
    match polynomial(element)?[..] {
        [_, ratio, ref rest @ ..] if rest.iter().all(|x| *x == 0.0) => Ok(ratio),
        _ => Err(element_error(element.node(), "a coupling that is not linear", "polycoef=\"0 N 0 0 0\"")),
    }
}
