//! Section 5: zero angular momentum, its integral b, and the end effector on a plane of joint space, (12)–(16).

use super::bodies::{Arm, BodyMass};
use super::equation::{Equality, Equation, Origin, Term};
use super::reactions::{AXES, Reactions, VectorComponent};
use super::state::InstantKind;
use super::symbol::{indexed_symbol, symbol_of_name};
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::machine::{Machine, RelativeAngle};

/// Tolerance of these equations, as a fraction of the sum of |terms|: simulated motions that count as reactionless meet
/// it.
const PLANE_TOLERANCE: f64 = 1e-6;

/// Equations of the plane of a pose constant. `lambda` has the machine's λ, or the reason that it has no b.
pub(super) struct PlaneEquations<'a> {
    pub instant: &'a Reactions<'a>,
    pub lambda: Result<Vec<f64>, String>,
}

/// A relative angle and its effect on the drive angles.
struct Joint {
    symbol: String,
    /// Value, rad.
    value: f64,
    offset: f64,
    /// Coefficient w for each drive, ±1 or 0: q_k − q_1 = Σ w_k (a − offset).
    ways: Vec<f64>,
}

impl PlaneEquations<'_> {
    fn name(&self, k: usize) -> &str {
        &self.machine().spec().drives[k].name
    }

    fn machine(&self) -> &Machine {
        self.instant.machine
    }

    fn drives(&self) -> usize {
        self.machine().drives()
    }

    /// Returns a term for each drive: λ_k times a value of drive k, with its symbol.
    fn terms(&self, lambda: &[f64], letter: &str, value: impl Fn(usize) -> f64, parts: bool) -> Vec<Term> {
        let first = lambda.iter().position(|lambda| *lambda != 0.0).unwrap_or_default();
        let term = |k: usize| {
            let own = indexed_symbol(letter, self.name(k));
            let symbol = if k == first { own } else { format!("λ_{{{}}} {own}", self.name(k)) };
            let term = Term::plain(symbol, lambda[k] * value(k));
            if parts { term.from(self.shares(k, value(k))) } else { term }
        };
        (0..self.drives()).map(term).collect()
    }

    /// Returns the contributions of bodies to the constant part of D_k/D_1, times a factor.
    fn shares(&self, k: usize, by: f64) -> Vec<(Origin, f64)> {
        let instant = self.instant;
        let share = by / instant.inertia.pose_inertia();
        let own = |mass: &BodyMass| {
            let turns = if mass.drive == k { mass.inertia } else { 0.0 };
            share * (mass.kilograms * mass.a[k].norm_sqr() + turns)
        };
        let mut parts = instant.bodies.each(own);
        parts.extend(instant.bodies.each_rotor(|rotor| share * rotor.rates[k]));
        parts
    }

    pub fn rates(&self) -> Equation {
        let state = self.instant.state;
        let lines = self.lambda.clone().map(|lambda| {
            let first = lambda.iter().position(|lambda| *lambda != 0.0).unwrap_or_default();
            let other = (0..self.drives()).filter(|k| *k != first);
            let ratio = other.map(|k| {
                let own = |k: usize| {
                    let parts = self.shares(k, 1.0);
                    parts.iter().map(|(_, part)| part).sum::<f64>()
                };
                let left = vec![Term::plain(indexed_symbol("λ", self.name(k)), lambda[k])];
                let symbol = format!("D_{{{}}}/D_{{{}}}", self.name(k), self.name(first));
                let right = vec![Term::plain(symbol, own(k) / own(first)).from(self.shares(k, 1.0 / own(first)))];
                Equality { name: String::new(), unit: "", left, right, tolerance: 1e-9 }
            });
            let left = self.terms(&lambda, "q\u{307}", |k| state.qd[k], true);
            let tolerance = PLANE_TOLERANCE * left.iter().map(|term| term.value.abs()).sum::<f64>();
            let law = Equality { name: String::new(), unit: "rad/s", left, right: Vec::new(), tolerance };
            [law].into_iter().chain(ratio).collect()
        });
        Equation {
            number: "12",
            title: "Motion without a moment",
            says: "Angular momentum stays zero while drives turn against each other in these proportions.",
            form: "",
            notes: Vec::new(),
            lines,
        }
    }

    pub fn pose_constant(&self) -> Equation {
        let state = self.instant.state;
        let lines = self.lambda.clone().map(|lambda| {
            let left = self.terms(&lambda, "q", |k| state.q[k], false);
            let sum: f64 = left.iter().map(|term| term.value).sum();
            let scale: f64 = left.iter().map(|term| term.value.abs()).sum();
            let right = vec![Term::plain("b", state.b.unwrap_or(sum))];
            vec![Equality { name: String::new(), unit: "rad", left, right, tolerance: PLANE_TOLERANCE * scale }]
        });
        let notes = match state.when {
            InstantKind::Plan(_) => vec!["b is the one that the motion starts with.".to_owned()],
            InstantKind::Run(_) => vec!["b is the one that control aims at.".to_owned()],
            InstantKind::Given => Vec::new(),
        };
        Equation {
            number: "13",
            title: "The pose constant",
            says: "The integral of (12): a plane of joint space, on which the machine stays if it is to shake nothing.",
            form: "",
            notes,
            lines,
        }
    }

    pub fn end_effector(&self) -> Equation {
        let instant = self.instant;
        let tip = end_effector(self.machine().end_effector(), &instant.e);
        let line = |(axis, on): VectorComponent| {
            let function = if axis == "x" { "cos" } else { "sin" };
            let terms = instant.bodies.tip.iter().map(|arm| {
                let symbol = format!("{} {function} q_{{{}}}", arm.symbol, self.name(arm.drive));
                let value = arm.sign * arm.value * on(instant.motion.unit(arm.drive));
                let term = Term::plain(symbol, value);
                if arm.sign < 0.0 { term.negative() } else { term }
            });
            let reach = instant.bodies.tip.iter().map(|arm| arm.value.abs()).sum();
            Equality::new(axis, "m", vec![Term::plain(axis, on(tip))], terms.collect(), reach)
        };
        Equation {
            number: "14",
            title: "The end effector",
            says: "It lies at the end of the links that lead to it, each along the angle of its drive.",
            form: "",
            notes: Vec::new(),
            lines: Ok(AXES.map(line).into()),
        }
    }

    /// Returns the relative angles on the paths from the first drive to all others.
    fn joints(&self) -> Result<Vec<Joint>, String> {
        let (n, q) = (self.drives(), &self.instant.state.q);
        let angles = self.machine().angles();
        let spec = self.machine();
        let mut ways: Vec<Option<Vec<f64>>> = vec![None; n];
        ways[0] = Some(vec![0.0; angles.len()]);
        // n passes suffice, because no path has more than n − 1 angles.
        for _ in 0..n {
            for (i, angle) in angles.iter().enumerate() {
                for (from, to, sign) in [(angle.from, angle.to, 1.0), (angle.to, angle.from, -1.0)] {
                    if let (Some(way), None) = (ways[from].clone(), &ways[to]) {
                        let mut way = way;
                        way[i] += sign;
                        ways[to] = Some(way);
                    }
                }
            }
        }
        let missing = || "the relative angles of this machine do not tell all its drives apart".to_owned();
        let ways: Vec<Vec<f64>> = ways.into_iter().collect::<Option<_>>().ok_or_else(missing)?;
        let joint = |(i, angle): (usize, &RelativeAngle)| Joint {
            symbol: symbol_of_name(&spec.angles()[i].name),
            value: angle.value(q),
            offset: angle.offset,
            ways: ways.iter().map(|way| way[i]).collect(),
        };
        let all = angles.iter().enumerate().map(joint);
        Ok(all.filter(|joint| joint.ways.iter().any(|way| *way != 0.0)).collect())
    }

    /// Returns the terms of q_1, (15): b* and the contribution of each relative angle.
    fn first_angle(&self) -> Result<Vec<Term>, String> {
        let (lambda, joints) = (self.lambda.clone()?, self.joints()?);
        let sum: f64 = lambda.iter().sum();
        if sum == 0.0 {
            return Err("Σλ is 0: turning the machine as a whole does not change b".into());
        }
        let state = self.instant.state;
        let b: f64 = lambda.iter().zip(state.q.iter()).map(|(l, q)| l * q).sum();
        let mut terms = vec![Term::plain("b/Σλ", b / sum)];
        for joint in joints {
            let along: f64 = joint.ways.iter().zip(&lambda).map(|(way, lambda)| way * lambda).sum();
            let behind: Vec<String> = (0..self.drives())
                .filter(|k| joint.ways[*k] != 0.0)
                .map(|k| indexed_symbol("λ", self.name(k)))
                .collect();
            let share = if behind.len() == 1 { behind[0].clone() } else { format!("({})", behind.join(" + ")) };
            let backwards = joint.ways.iter().any(|way| *way < 0.0);
            let offset = joint.offset;
            let value = (offset - joint.value) * along / sum;
            let term = match (offset == 0.0, backwards) {
                (true, false) => Term::plain(format!("{} {share}/Σλ", joint.symbol), value).negative(),
                (true, true) => Term::plain(format!("{} {share}/Σλ", joint.symbol), value),
                (false, false) => Term::plain(format!("({} − {}) {share}/Σλ", angle(offset), joint.symbol), value),
                (false, true) => {
                    Term::plain(format!("({} − {}) {share}/Σλ", angle(offset), joint.symbol), value).negative()
                }
            };
            terms.push(term);
        }
        Ok(terms)
    }

    pub fn drive_angle(&self) -> Equation {
        let q = self.instant.state.q[0];
        let lines = self.first_angle().map(|right| {
            let scale: f64 = 1.0 + right.iter().map(|term| term.value.abs()).sum::<f64>();
            let left = vec![Term::plain(indexed_symbol("q", self.name(0)), q)];
            vec![Equality { name: String::new(), unit: "rad", left, right, tolerance: PLANE_TOLERANCE * scale }]
        });
        Equation {
            number: "15",
            title: "The angle of drive 1 on a plane",
            says: "b and the relative angles say how the whole machine is turned: by b* = b/Σλ, and by φ of the angles.",
            form: "q_{1} = b* + φ(a)",
            notes: Vec::new(),
            lines,
        }
    }

    pub fn workspace(&self) -> Equation {
        Equation {
            number: "16",
            title: "The reactionless workspace",
            says: "The angles alone shape what can be reached, (u, v); b only turns it.",
            form: "(x, y) = R(b*) R(φ) (u, v)",
            notes: Vec::new(),
            lines: self.turned(),
        }
    }

    fn turned(&self) -> Result<Vec<Equality>, String> {
        let (turn, joints) = (self.first_angle()?, self.joints()?);
        let instant = self.instant;
        let turn: f64 = turn.iter().map(|term| term.value).sum();
        let tip = end_effector(self.machine().end_effector(), &instant.e);
        let unturned = tip * instant.e[0].conj();
        let reach: f64 = instant.bodies.tip.iter().map(|arm| arm.value.abs()).sum();
        let side = |function: &str| -> Vec<Term> {
            let term = |arm: &Arm| {
                let along: f64 = joints.iter().map(|joint| joint.ways[arm.drive] * (joint.value - joint.offset)).sum();
                let value = arm.sign * arm.value * if function == "cos" { along.cos() } else { along.sin() };
                let offset: f64 = joints.iter().map(|joint| -joint.ways[arm.drive] * joint.offset).sum();
                let halves = (offset / std::f64::consts::PI).round();
                let whole = (offset - halves * std::f64::consts::PI).abs() < 1e-9;
                let flips = whole && halves.rem_euclid(2.0) == 1.0;
                let words = sum_of(&joints, arm.drive, if whole { 0.0 } else { offset });
                let symbol =
                    if words.is_empty() { arm.symbol.clone() } else { format!("{} {function}({words})", arm.symbol) };
                let term = Term::plain(symbol, value);
                if (arm.sign < 0.0) != flips { term.negative() } else { term }
            };
            let arms = instant.bodies.tip.iter();
            // A drive with no angle between it and the first contributes no sine.
            arms.filter(|arm| function == "cos" || joints.iter().any(|joint| joint.ways[arm.drive] != 0.0))
                .map(term)
                .collect()
        };
        let (cos, sin) = (turn.cos(), turn.sin());
        let (u, v) = (side("cos"), side("sin"));
        let sum = |terms: &[Term]| terms.iter().map(|term| term.value).sum::<f64>();
        let (su, sv) = (sum(&u), sum(&v));
        let line = |name: &str, left: f64, right: Vec<Term>| Equality {
            name: String::new(),
            unit: "m",
            left: vec![Term::plain(name, left)],
            right,
            tolerance: PLANE_TOLERANCE * reach,
        };
        let turned = |a: &str, x: f64, b: &str, y: f64, minus: bool| {
            let last = Term::plain(format!("v {b}(b* + φ)"), y);
            vec![Term::plain(format!("u {a}(b* + φ)"), x), if minus { last.negative() } else { last }]
        };
        Ok(vec![
            line("u", unturned.re, u),
            line("v", unturned.im, v),
            line("x", tip.re, turned("cos", su * cos, "sin", -sv * sin, true)),
            line("y", tip.im, turned("sin", su * sin, "cos", sv * cos, false)),
        ])
    }
}

/// Returns the symbol of the angle from the first drive to another: a₁ + a₂ − 0.3.
fn sum_of(joints: &[Joint], drive: usize, offset: f64) -> String {
    let mut words = String::new();
    for joint in joints.iter().filter(|joint| joint.ways[drive] != 0.0) {
        let sign = match (words.is_empty(), joint.ways[drive] < 0.0) {
            (true, false) => "",
            (true, true) => "−",
            (false, false) => " + ",
            (false, true) => " − ",
        };
        words += sign;
        words += &joint.symbol;
    }
    if offset != 0.0 {
        let sign = if offset < 0.0 { " − " } else { " + " };
        words += &format!("{sign}{:.4}", offset.abs());
    }
    words
}

/// Formats an angle; ±π is written as such.
fn angle(x: f64) -> String {
    let pi = std::f64::consts::PI;
    match x {
        _ if (x - pi).abs() < 1e-12 => "π".into(),
        _ if (x + pi).abs() < 1e-12 => "−π".into(),
        _ => format!("{x:.4}").replace('-', "−"),
    }
}
