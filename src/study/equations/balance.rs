//! Sections 2 and 4 and the appendix: the balance conditions on masses and lengths, (7)–(10), and the columns of γ and
//! D, (A1)–(A3).

use nalgebra::DMatrix;

use super::bodies::{Bodies, BodyMass};
use super::equation::{Equality, Equation, Origin, Term};
use super::products::{coupling, first_moment, fixed_products};
use super::reactions::{AXES, Reactions, VectorComponent, total};
use super::symbol::indexed_symbol;
use stillbase_mechanics::balance::{Body, Condition, Preset, conditions, design};
use stillbase_mechanics::machine::{Inertia, Link, Machine};
use stillbase_mechanics::planar::Vector;
use stillbase_settings::number::subscript;

/// Note for machines with masses off the axes of their links.
const OFF_AXIS: &str = "Some masses lie off the axes of their links; the terms count positions along the axes only.";

/// The data of a machine that its balance depends on.
pub(super) struct BalanceEquations<'a> {
    pub machine: &'a Machine,
    pub inertia: &'a Inertia,
    pub bodies: &'a Bodies,
}

impl BalanceEquations<'_> {
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.machine.spec().counterweights.is_empty() {
            notes.push("w and x are mass and place of a link's counterweight.".to_owned());
        }
        if self.bodies.has_normals() {
            notes.push(OFF_AXIS.into());
        }
        notes
    }

    fn condition(&self, condition: Condition) -> Equality {
        let left = match condition {
            Condition::Force(k) => first_moment(self.bodies, k),
            Condition::Coupling(k, l) => coupling(self.bodies, k, l),
        };
        let tolerance = condition.tolerance(self.inertia);
        Equality { name: symbol(condition), unit: condition.unit(), left, right: Vec::new(), tolerance }
    }

    fn all(&self) -> impl Iterator<Item = Condition> + use<> {
        Condition::all(self.machine.drives())
    }

    pub fn force(&self) -> Equation {
        let force = self.all().filter(|condition| matches!(condition, Condition::Force(_)));
        Equation {
            number: "7",
            title: "No force on the base",
            says: "Seen from each drive, masses on one side weigh as much as masses on the other.",
            form: "",
            notes: self.notes(),
            lines: Ok(force.map(|condition| self.condition(condition)).collect()),
        }
    }

    pub fn invariance(&self) -> Equation {
        let pairs: Vec<Condition> = self.all().filter(|one| matches!(one, Condition::Coupling(..))).collect();
        let lines = match pairs.is_empty() {
            true => Err("one drive alone has no other to be coupled with".to_owned()),
            false => Ok(pairs.into_iter().map(|condition| self.condition(condition)).collect()),
        };
        Equation {
            number: "8",
            title: "No coupling of the drives",
            says: "What two drives would do to each other cancels, so the mass matrix is the same in every pose.",
            form: "",
            notes: self.notes(),
            lines,
        }
    }

    pub fn linear(&self) -> Equation {
        let (a, _) = conditions(self.machine);
        let line = |(row, condition): (usize, Condition)| {
            let right: Vec<Term> = fixed_products(self.bodies, condition)
                .into_iter()
                .map(|term| Term {
                    is_negative: !term.is_negative,
                    value: -term.value,
                    parts: term.parts.into_iter().map(|(origin, part)| (origin, -part)).collect(),
                    ..term
                })
                .collect();
            let tolerance = condition.tolerance(self.inertia);
            Equality { name: symbol(condition), unit: condition.unit(), left: self.row(&a, row), right, tolerance }
        };
        let mut notes = Vec::new();
        if !self.machine.spec().counterweights.is_empty() {
            notes.push("m and l_{c} are of links with their counterweights here; in k, w is counted apart.".to_owned());
        }
        Equation {
            number: "9",
            title: "Balance is linear",
            says: "(7) and (8) are linear in the places l_{c} of the centres of mass: what moves on the left, what is given on the right.",
            form: "A l_{c} = k",
            notes,
            lines: Ok(self.all().enumerate().map(line).collect()),
        }
    }

    /// Returns the terms of one row of A l_c.
    fn row(&self, a: &DMatrix<f64>, row: usize) -> Vec<Term> {
        let links = self.machine.links().iter().enumerate().filter(|(j, _)| a[(row, *j)] != 0.0);
        let is_payload = |origin: Origin| matches!(origin, Origin::Body(Body::Payload, _));
        let term = |(j, link): (usize, &Link)| {
            let by = a[(row, j)] / link.mass;
            let on_it = |mass: &&BodyMass| mass.origin.link() == Some(j) && !is_payload(mass.origin);
            let parts = self.bodies.masses.iter().filter(on_it);
            let parts = parts.map(|mass| (mass.origin, by * mass.kilograms * com_distance(mass)));
            let symbol = format!("A_{{{},{}}} {}", row + 1, link.name, indexed_symbol("l", format!("c{}", link.name)));
            Term::plain(symbol, a[(row, j)] * link.com).from(parts.collect())
        };
        links.map(term).collect()
    }

    pub fn least(&self, preset: Preset) -> Equation {
        let links = self.machine.links();
        let (preset, penalty) = match preset.penalty(links.len()) {
            Ok(penalty) => (preset, penalty),
            Err(_) => (Preset::MinimumNorm, vec![1.0; links.len()]),
        };
        let lines = design(self.machine, &penalty).map_err(|why| why.to_string()).map(|least| {
            let sum = |machine: &Machine| {
                machine.links().iter().zip(&penalty).map(|(link, p)| (p * link.com).powi(2)).sum::<f64>()
            };
            let objective = [self.machine, &least].map(|machine| Term::plain("Σ (p_{j} l_{cj})²", sum(machine)));
            let [now, best] = objective;
            let best = Term { symbol: "least".into(), ..best };
            let of_link = |(link, least): (&Link, &Link)| {
                let now = Term::plain(indexed_symbol("l", format!("c{}", link.name)), link.com);
                let least = Term::plain(indexed_symbol("l", format!("c{}", link.name)) + " least", least.com);
                Equality { name: String::new(), unit: "m", left: vec![now], right: vec![least], tolerance: 1e-9 }
            };
            let each = links.iter().zip(least.links()).map(of_link);
            let all =
                Equality { name: String::new(), unit: "m²", left: vec![now], right: vec![best], tolerance: 1e-9 };
            [all].into_iter().chain(each).collect()
        });
        let mut notes = Vec::new();
        notes.push(match preset {
            Preset::Table1 => {
                "With W as printed this does not give Table I; what was minimised there is |W^(−1/2) l_{c}|, as here."
                    .to_owned()
            }
            Preset::AsPrinted => "With W as printed, which does not give Table I.".into(),
            Preset::MinimumNorm => "With every penalty 1.".into(),
        });
        if !self.machine.spec().counterweights.is_empty() {
            notes.push("l_{c} are of links with their counterweights here.".into());
        }
        Equation {
            number: "10",
            title: "The least shift that balances",
            says: "Of all places l_{c} that meet (9), these have the least Σ (p_{j} l_{cj})².",
            form: "l_{c} = W⁻¹ W⁻\u{1d40} A\u{1d40} (A W⁻¹ W⁻\u{1d40} A\u{1d40})⁻¹ k",
            notes,
            lines,
        }
    }

    pub fn columns(&self, instant: &Reactions<'_>) -> Equation {
        let name = |k: usize| &self.machine.spec().drives[k].name;
        let each = (0..self.machine.drives()).flat_map(|k| AXES.map(|axis| (k, axis)));
        let line = |(k, (axis, on)): (usize, VectorComponent)| {
            let parts = self.bodies.each(|mass| mass.kilograms * on(instant.motion.column(mass, k)));
            let scale = total(&self.bodies.each(|mass| mass.kilograms * instant.motion.column(mass, k).norm()));
            let gamma = on(Vector::new(0.0, 1.0) * instant.e[k] * self.inertia.first_moment(k));
            let right = Term::plain(format!("α_{{{}{axis}}} g_{{{}}}", name(k), name(k)), gamma).from(parts.clone());
            let left = Term::sum(format!("γ_{{{}{axis}}}", name(k)), parts);
            Equality::new(format!("drive {} {axis}", name(k)), "kg m", vec![left], vec![right], scale)
        };
        Equation {
            number: "A1",
            title: "The columns of γ",
            says: "Turning drive k moves the centre of mass along α_{k}, by the bracket g_{k} of (7).",
            form: "γ_{k} = α_{k} g_{k}",
            notes: Vec::new(),
            lines: Ok(each.map(line).collect()),
        }
    }

    pub fn directions(&self, instant: &Reactions<'_>) -> Equation {
        let name = |k: usize| &self.machine.spec().drives[k].name;
        let line = |k: usize| {
            let along = Vector::new(0.0, 1.0) * instant.e[k];
            let of_sine = instant.motion.unit(k);
            [("x", along.re, -of_sine.im, "sin", true), ("y", along.im, of_sine.re, "cos", false)].map(
                |(axis, closed, value, function, minus)| {
                    let right = Term::plain(format!("{function} q_{{{}}}", name(k)), value);
                    let right = if minus { right.negative() } else { right };
                    let left = vec![Term::plain(format!("α_{{{}{axis}}}", name(k)), closed)];
                    Equality::new(format!("drive {} {axis}", name(k)), "", left, vec![right], 1.0)
                },
            )
        };
        Equation {
            number: "A2",
            title: "The directions α",
            says: "α_{k} is a right angle ahead of the links of drive k.",
            form: "α_{k} = (−sin q_{k}, cos q_{k}, 0)",
            notes: Vec::new(),
            lines: Ok((0..self.machine.drives()).flat_map(line).collect()),
        }
    }

    pub fn momenta(&self, instant: &Reactions<'_>) -> Equation {
        let n = self.machine.drives();
        let name = |k: usize| &self.machine.spec().drives[k].name;
        let line = |k: usize| {
            let follows = |mass: &&BodyMass| mass.drive == k && !mass.inertia_symbol.is_empty();
            let turning: Vec<_> = self.bodies.masses.iter().filter(follows).collect();
            let symbols: Vec<&str> = turning.iter().map(|mass| mass.inertia_symbol.as_str()).collect();
            let mut right = Vec::new();
            if !turning.is_empty() {
                let parts = turning.iter().map(|mass| (mass.origin, mass.inertia)).collect();
                let symbol =
                    if symbols.len() == 1 { symbols[0].to_owned() } else { format!("({})", symbols.join(" + ")) };
                right.push(Term::sum(symbol, parts));
            }
            right.extend(coupling(self.bodies, k, k));
            let off: Vec<_> = self.bodies.masses.iter().filter(|mass| mass.drive == k && mass.normal != 0.0).collect();
            if !off.is_empty() {
                let parts = off.iter().map(|mass| (mass.origin, mass.kilograms * mass.normal * mass.normal));
                right.push(Term::sum("Σ m n²", parts.collect()));
            }
            for l in (0..n).filter(|l| *l != k) {
                let (low, high) = (k.min(l), k.max(l));
                let (a, b) = (instant.motion.unit(low), instant.motion.unit(high));
                let parts =
                    self.bodies.each(|mass| mass.kilograms * (mass.a[low].conj() * mass.a[high] * (a.conj() * b)).re);
                let bracket = symbol(Condition::Coupling(low, high));
                right.push(Term::sum(format!("{bracket} cos(q_{{{}}} − q_{{{}}})", name(low), name(high)), parts));
            }
            if !self.bodies.rotors.is_empty() {
                right.push(Term::sum("J_{rotors}", self.bodies.each_rotor(|rotor| rotor.rates[k])));
            }
            let own = instant.momentum_row(k);
            let scale = self.inertia.diagonal(k);
            Equality::new(
                format!("drive {}", name(k)),
                "kg m²",
                vec![Term::plain(indexed_symbol("d", name(k)), own)],
                right,
                scale,
            )
        };
        Equation {
            number: "A3",
            title: "The columns of D",
            says: "What drive k adds to the angular momentum; only the terms with cos depend on the pose.",
            form: "d_{k} = I_{k} + m l² + C_{kl} cos(q_{k} − q_{l})",
            notes: self.notes(),
            lines: Ok((0..n).map(line).collect()),
        }
    }
}

/// Returns the distance of a body's centre of mass from the root of its link, along the link, m.
fn com_distance(mass: &BodyMass) -> f64 {
    mass.arms.iter().filter(|arm| arm.is_own).map(|arm| arm.value).sum()
}

/// Returns the symbol of a condition: g₁, C₁₂.
fn symbol(condition: Condition) -> String {
    match condition {
        Condition::Force(k) => format!("g{}", subscript(k + 1)),
        Condition::Coupling(k, l) => format!("C{}{}", subscript(k + 1), subscript(l + 1)),
    }
}
