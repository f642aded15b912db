//! What of the pins does not change with the pose: the tree, the levers of the closures, and in which order to solve.

use super::error::JointsError;
use crate::mechanics::machine::{CLOSURE_TOLERANCE, Machine};
use crate::mechanics::planar::{Units, Vector, unit};

/// A link with whatever it holds, parents before children.
#[derive(Clone, Debug)]
pub struct Body {
    /// Which link, and which pin attaches it.
    pub link: usize,
    /// Place of its parent among the bodies; none: the base.
    pub parent: Option<usize>,
    /// Drive whose orientation it has.
    pub drive: usize,
    /// Drive of its parent, and how far along that its root is, signed, m.
    pub arm: (usize, f64),
    /// Σ m, kg.
    pub mass: f64,
    /// Σ m c about the root, kg m, c complex along the link.
    pub first: Vector,
    /// Σ I + m |c|² about the root, kg m².
    pub second: f64,
    /// How far along the link the end effector is, signed, m; 0 where it is on another.
    pub tip: Option<f64>,
    /// Whether a drive turns it.
    pub driven: bool,
}

/// A closure as forces see it: λ acts on the second link, −λ on the first.
#[derive(Clone, Debug)]
pub struct Closure {
    /// The pin it is.
    pub pin: usize,
    /// Bodies on whose roots λ has a moment, and its lever w, m.
    pub levers: Vec<(usize, f64)>,
    /// Bodies whose roots carry ±λ.
    pub carried: Vec<(usize, f64)>,
    /// Pins that depend on it, one bit each.
    pub reaches: u32,
}

/// What is solved at once.
#[derive(Clone, Debug)]
pub enum Step {
    /// One closure from two bodies, each with its lever.
    Pair {
        /// The closure.
        closure: usize,
        /// The bodies.
        rows: [(usize, f64); 2],
    },
    /// Closures that do not come apart, from twice as many bodies.
    Together {
        /// The closures.
        closures: Vec<usize>,
        /// The bodies.
        rows: Vec<usize>,
    },
}

/// Links of a machine as bodies, parents before children.
pub fn bodies(machine: &Machine) -> Result<Vec<Body>, JointsError> {
    let driven = driven(machine)?;
    let mut order: Vec<usize> = Vec::with_capacity(driven.len());
    while order.len() < driven.len() {
        // Machines have no cycles, so each round finds at least one.
        let ready = |j: usize| machine.parts()[j].parent.is_none_or(|p| order.contains(&p));
        let next: Vec<usize> = (0..driven.len()).filter(|j| !order.contains(j) && ready(*j)).collect();
        order.extend(next);
    }
    let place = |j: usize| order.iter().position(|i| *i == j);
    let payload = machine.spec().payload;
    let body = |&j: &usize| {
        let (link, part) = (&machine.links()[j], &machine.parts()[j]);
        let com = part.sign * Vector::new(link.com, link.com_normal);
        let mut body = Body {
            link: j,
            parent: part.parent.and_then(place),
            drive: part.drive,
            arm: part.parent.map_or((0, 0.0), |p| (machine.parts()[p].drive, machine.parts()[p].sign * part.at)),
            mass: link.mass,
            first: link.mass * com,
            second: link.inertia + link.mass * com.norm_sqr(),
            tip: None,
            driven: driven[j],
        };
        if j == machine.tip_link() {
            let tip = machine.tip()[part.drive] - part.root[part.drive];
            body.tip = Some(tip);
            let held = tip + part.sign * Vector::new(payload.offset[0], payload.offset[1]);
            body.mass += payload.mass;
            body.first += payload.mass * held;
            body.second += payload.inertia + payload.mass * held.norm_sqr();
        }
        body
    };
    Ok(order.iter().map(body).collect())
}

/// Whether a drive turns each link: those at B that follow it, or its only one.
fn driven(machine: &Machine) -> Result<Vec<bool>, JointsError> {
    let parts = machine.parts();
    let mut driven: Vec<bool> = parts.iter().map(|p| p.parent.is_none()).collect();
    for k in 0..machine.drives() {
        let followers: Vec<usize> = (0..parts.len()).filter(|&j| parts[j].drive == k).collect();
        match followers[..] {
            _ if followers.iter().any(|&j| driven[j]) => {}
            [only] => driven[only] = true,
            _ => {
                return Err(JointsError::Unattached {
                    drive: machine.spec().drives[k].name.clone(),
                    links: names(machine, followers),
                });
            }
        }
    }
    Ok(driven)
}

fn names(machine: &Machine, links: impl IntoIterator<Item = usize>) -> String {
    links.into_iter().map(|j| machine.links()[j].name.as_str()).collect::<Vec<_>>().join(", ")
}

/// The closures with their levers.
pub fn closures(machine: &Machine, bodies: &[Body]) -> Vec<Closure> {
    let place = |link: usize| bodies.iter().position(|b| b.link == link);
    let mut closures = Vec::with_capacity(machine.loops().len());
    for (i, closure) in machine.loops().iter().enumerate() {
        let (mut levers, mut carried) = (vec![0.0; bodies.len()], vec![0.0; bodies.len()]);
        for (link, s, sense) in [(closure.a, closure.at_a, -1.0), (closure.b, closure.at_b, 1.0)] {
            // Along each link down to the base: from where the force comes in to the root.
            let (mut at, mut along) = (place(link), machine.parts()[link].sign * s);
            while let Some(j) = at {
                levers[j] += sense * along;
                carried[j] += sense;
                (at, along) = (bodies[j].parent, bodies[j].arm.1);
            }
        }
        // What both sides share cancels.
        let kept = |values: Vec<f64>, least: f64| -> Vec<(usize, f64)> {
            values.into_iter().enumerate().filter(|(_, x)| x.abs() > least).collect()
        };
        closures.push(Closure {
            pin: machine.links().len() + i,
            levers: kept(levers, CLOSURE_TOLERANCE),
            carried: kept(carried, 0.5),
            reaches: 0,
        });
    }
    closures
}

/// In which order closures are solved, from which bodies.
pub fn steps(machine: &Machine, bodies: &[Body], closures: &[Closure]) -> Result<Vec<Step>, JointsError> {
    let mut rows: Vec<usize> = (0..bodies.len()).filter(|&j| !bodies[j].driven).collect();
    let wanted = match rows.len() {
        n if n % 2 == 0 => format!("{}", n / 2),
        n => format!("an even number of such links rather than {n}, and half as many"),
    };
    let loose = |rows: &[usize]| names(machine, rows.iter().map(|&j| bodies[j].link));
    if rows.len() > 2 * closures.len() {
        let free: Vec<usize> = rows.iter().copied().filter(|&j| closures.iter().all(|c| lever(c, j) == 0.0)).collect();
        let loose = match free.len() {
            0 => format!("one of {}", loose(&rows)),
            _ => loose(&free),
        };
        return Err(JointsError::Missing { links: rows.len(), closures: closures.len(), loose, wanted });
    }
    if rows.len() < 2 * closures.len() {
        return Err(JointsError::Redundant { closures: closures.len(), links: rows.len(), wanted });
    }
    let mut open: Vec<usize> = (0..closures.len()).collect();
    let mut steps = Vec::new();
    while let Some((closure, pair)) = open.iter().find_map(|&c| Some((c, pair(bodies, closures, &open, &rows, c)?))) {
        open.retain(|&c| c != closure);
        rows.retain(|&j| pair.iter().all(|(i, _)| *i != j));
        steps.push(Step::Pair { closure, rows: pair });
    }
    if !open.is_empty() {
        let block = Step::Together { closures: open.clone(), rows: rows.clone() };
        if !is_regular(bodies, closures, &block) {
            let pins: Vec<String> = open.iter().map(|&c| super::pins(machine)[closures[c].pin].name.clone()).collect();
            return Err(JointsError::Misplaced { closures: pins.join(", "), links: loose(&rows) });
        }
        steps.push(block);
    }
    Ok(steps)
}

/// Two bodies of different drives that feel, of all closures still open, this one only.
fn pair(bodies: &[Body], closures: &[Closure], open: &[usize], rows: &[usize], c: usize) -> Option<[(usize, f64); 2]> {
    let alone = |j: usize| open.iter().all(|&d| d == c || lever(&closures[d], j) == 0.0);
    let mut found = rows.iter().map(|&j| (j, lever(&closures[c], j))).filter(|&(j, w)| w != 0.0 && alone(j));
    let first = found.next()?;
    let second = found.find(|(j, _)| bodies[*j].drive != bodies[first.0].drive)?;
    Some([first, second])
}

/// Lever of a closure's force about the root of a body, m.
pub fn lever(closure: &Closure, body: usize) -> f64 {
    closure.levers.iter().find(|(j, _)| *j == body).map_or(0.0, |(_, w)| *w)
}

/// Whether a block can be solved in poses that have nothing special.
fn is_regular(bodies: &[Body], closures: &[Closure], block: &Step) -> bool {
    let Step::Together { closures: open, rows } = block else { return true };
    let moment = vec![0.0; bodies.len()];
    // Multiples of the golden angle: no two are near a change point.
    [0.7, 1.9, 4.4].into_iter().any(|start| {
        let e: Units = std::array::from_fn(|k| unit(start * (1.0 + k as f64) + 2.399_963 * k as f64));
        super::forces::together(bodies, closures, open, rows, &e, &moment).1
    })
}

/// Marks for each closure which pins depend on it: those that carry it, and through the closures solved after it.
pub fn spread(bodies: &[Body], closures: &mut [Closure], steps: &[Step]) {
    for (at, step) in steps.iter().enumerate().rev() {
        let mut reaches = 0;
        for (c, _) in members(step) {
            let own = &closures[c];
            reaches |= 1 << own.pin;
            reaches |= own.carried.iter().fold(0, |mask, (j, _)| mask | 1 << bodies[*j].link);
            for (d, rows) in steps[at + 1..].iter().flat_map(members) {
                if rows.iter().any(|&j| lever(own, j) != 0.0) {
                    reaches |= closures[d].reaches;
                }
            }
        }
        // Closures of one block depend on each other.
        for (c, _) in members(step) {
            closures[c].reaches = reaches;
        }
    }
}

/// Each closure of a step with the bodies it is solved from.
fn members(step: &Step) -> Vec<(usize, Vec<usize>)> {
    match step {
        Step::Pair { closure, rows } => vec![(*closure, rows.iter().map(|(j, _)| *j).collect())],
        Step::Together { closures, rows } => closures.iter().map(|&c| (c, rows.clone())).collect(),
    }
}
