//! Pose-independent structure: the tree of links, the levers of the closures, and the order in which to solve them.

use super::block::together;
use super::error::JointsError;
use super::pins::pins;
use super::tree::{CutClosure, SolveStep, Stator, TreeLink, lever};
use crate::machine::{CLOSURE_TOLERANCE, Inertia, Machine};
use crate::planar::{UnitVectors, Vector, unit};

/// Returns the machine's links as a tree, parents first; the end link includes the payload.
pub fn links(machine: &Machine) -> Result<Vec<TreeLink>, JointsError> {
    let driven = driven(machine)?;
    let mut order: Vec<usize> = Vec::with_capacity(driven.len());
    while order.len() < driven.len() {
        // No link is its own ancestor, so each round finds at least one link.
        let ready = |j: usize| machine.resolved_links()[j].parent.is_none_or(|p| order.contains(&p));
        let next: Vec<usize> = (0..driven.len()).filter(|j| !order.contains(j) && ready(*j)).collect();
        order.extend(next);
    }
    let place = |j: usize| order.iter().position(|i| *i == j);
    let payload = machine.spec().payload;
    let held_by = |&j: &usize| {
        let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
        let com = part.sign * Vector::new(link.com, link.com_normal);
        let mut own = TreeLink {
            link: j,
            parent: part.parent.and_then(place),
            drive: part.drive,
            arm: part
                .parent
                .map_or((0, 0.0), |p| (machine.resolved_links()[p].drive, machine.resolved_links()[p].sign * part.at)),
            mass: link.mass,
            first: link.mass * com,
            second: link.inertia + link.mass * com.norm_sqr(),
            end_effector: None,
            driven: driven[j],
        };
        if j == machine.end_link() {
            let tip = machine.end_effector()[part.drive] - part.root[part.drive];
            own.end_effector = Some(tip);
            let held = tip + part.sign * Vector::new(payload.offset[0], payload.offset[1]);
            own.mass += payload.mass;
            own.first += payload.mass * held;
            own.second += payload.inertia + payload.mass * held.norm_sqr();
        }
        own
    };
    Ok(order.iter().map(held_by).collect())
}

/// Returns for each link whether a drive turns it. A drive turns those of its links that attach at B. If there are
/// none, it turns its only link, or the only one whose parent follows the drive that carries the motor.
fn driven(machine: &Machine) -> Result<Vec<bool>, JointsError> {
    let parts = machine.resolved_links();
    let mut driven: Vec<bool> = parts.iter().map(|p| p.parent.is_none()).collect();
    for k in 0..machine.drives() {
        let followers: Vec<usize> = (0..parts.len()).filter(|&j| parts[j].drive == k).collect();
        let hangs_on = |j: &usize| parts[*j].parent.is_some_and(|p| Some(parts[p].drive) == machine.motors().on(k));
        let there: Vec<usize> = followers.iter().copied().filter(hangs_on).collect();
        match (&followers[..], &there[..]) {
            _ if followers.iter().any(|&j| driven[j]) => {}
            ([only], _) | (_, [only]) => driven[*only] = true,
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

/// Returns the motors that have rotors or whose stators sit on links. A stator sits on the parent of the link that the
/// motor turns, if this parent follows the drive that carries the motor. Otherwise it sits on the link that the
/// carrying drive turns.
///
/// # Errors
/// If a motor on an undriven link turns links whose moments depend on closure forces.
pub fn stators(machine: &Machine, links: &[TreeLink], closures: &[CutClosure]) -> Result<Vec<Stator>, JointsError> {
    let motors = machine.motors();
    let rotors = Inertia::of(machine).rotors;
    let wanted = (0..machine.drives()).filter(|&k| motors.on(k).is_some() || rotors[k].inertia > 0.0);
    let mut order: Vec<usize> = wanted.collect();
    // A drive comes after all drives that it carries.
    order.sort_by_key(|&k| std::cmp::Reverse((0..machine.drives()).filter(|&l| motors.carries(l, k)).count()));
    let in_loop = |j: usize| closures.iter().any(|c| lever(c, j) != 0.0);
    let mut stators: Vec<Stator> = Vec::with_capacity(order.len());
    for drive in order {
        let turned = (0..links.len()).filter(|&j| links[j].driven && links[j].drive == drive);
        let hangs_on = |j: usize| links[j].parent.filter(|&p| Some(links[p].drive) == motors.on(drive));
        let driven = |on: usize| (0..links.len()).find(|&j| links[j].driven && links[j].drive == on);
        let link = turned.clone().find_map(hangs_on).or_else(|| motors.on(drive).and_then(driven));
        let late = |s: &Stator| !s.before && s.link.is_some_and(|j| links[j].drive == drive);
        let before = !turned.clone().any(in_loop) && !stators.iter().any(late);
        if !before && link.is_some_and(|j| !links[j].driven) {
            return Err(JointsError::MotorInLoop { drive: machine.spec().drives[drive].name.clone() });
        }
        stators.push(Stator { drive, link, rotor: rotors[drive], before });
    }
    Ok(stators)
}

fn names(machine: &Machine, links: impl IntoIterator<Item = usize>) -> String {
    links.into_iter().map(|j| machine.links()[j].name.as_str()).collect::<Vec<_>>().join(", ")
}

/// Returns the closures with their levers.
pub fn closures(machine: &Machine, links: &[TreeLink]) -> Vec<CutClosure> {
    let place = |link: usize| links.iter().position(|b| b.link == link);
    let mut closures = Vec::with_capacity(machine.loops().len());
    for (i, closure) in machine.loops().iter().enumerate() {
        let (mut levers, mut carried) = (vec![0.0; links.len()], vec![0.0; links.len()]);
        for (link, s, sense) in [(closure.a, closure.at_a, -1.0), (closure.b, closure.at_b, 1.0)] {
            // Walks down to the base; along each link, from the point where the force acts to the root.
            let (mut at, mut along) = (place(link), machine.resolved_links()[link].sign * s);
            while let Some(j) = at {
                levers[j] += sense * along;
                carried[j] += sense;
                (at, along) = (links[j].parent, links[j].arm.1);
            }
        }
        // On links that carry both ends of the closure, the levers cancel, except where its two branches part.
        let kept = |values: Vec<f64>, least: f64| -> Vec<(usize, f64)> {
            values.into_iter().enumerate().filter(|(_, x)| x.abs() > least).collect()
        };
        closures.push(CutClosure {
            pin: machine.links().len() + i,
            levers: kept(levers, CLOSURE_TOLERANCE),
            carried: kept(carried, 0.5),
            reaches: 0,
        });
    }
    closures
}

/// Finds the order in which the closures are solved, and the links whose equations each step solves.
///
/// # Errors
/// If there are too few or too many closures, or if some are redundant where others are missing.
pub fn steps(machine: &Machine, links: &[TreeLink], closures: &[CutClosure]) -> Result<Vec<SolveStep>, JointsError> {
    let mut rows: Vec<usize> = (0..links.len()).filter(|&j| !links[j].driven).collect();
    let wanted = match rows.len() {
        n if n % 2 == 0 => format!("{}", n / 2),
        n => format!("an even number of such links rather than {n}, and half as many"),
    };
    let loose = |rows: &[usize]| names(machine, rows.iter().map(|&j| links[j].link));
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
    while let Some((closure, pair)) = open.iter().find_map(|&c| Some((c, pair(links, closures, &open, &rows, c)?))) {
        open.retain(|&c| c != closure);
        rows.retain(|&j| pair.iter().all(|(i, _)| *i != j));
        steps.push(SolveStep::Pair { closure, rows: pair });
    }
    if !open.is_empty() {
        let block = SolveStep::Together { closures: open.clone(), rows: rows.clone() };
        if !is_regular(links, closures, &block) {
            let pins: Vec<String> = open.iter().map(|&c| pins(machine)[closures[c].pin].name.clone()).collect();
            return Err(JointsError::Misplaced { closures: pins.join(", "), links: loose(&rows) });
        }
        steps.push(block);
    }
    Ok(steps)
}

/// Returns two links of different drives, with their levers, on which closure `c` is the only one of the `open`
/// closures that has a moment.
fn pair(
    links: &[TreeLink],
    closures: &[CutClosure],
    open: &[usize],
    rows: &[usize],
    c: usize,
) -> Option<[(usize, f64); 2]> {
    let alone = |j: usize| open.iter().all(|&d| d == c || lever(&closures[d], j) == 0.0);
    let mut found = rows.iter().map(|&j| (j, lever(&closures[c], j))).filter(|&(j, w)| w != 0.0 && alone(j));
    let first = found.next()?;
    let second = found.find(|(j, _)| links[*j].drive != links[first.0].drive)?;
    Some([first, second])
}

/// Returns whether a block can be solved in a generic pose.
fn is_regular(links: &[TreeLink], closures: &[CutClosure], block: &SolveStep) -> bool {
    let SolveStep::Together { closures: open, rows } = block else { return true };
    let moment = vec![0.0; links.len()];
    // Three sample poses; successive drives are `start` plus the golden angle apart. One regular pose is sufficient.
    [0.7, 1.9, 4.4].into_iter().any(|start| {
        let e: UnitVectors = std::array::from_fn(|k| unit(start * (1.0 + k as f64) + 2.399_963 * k as f64));
        together(links, closures, open, rows, &e, &moment).1
    })
}

/// Marks for each closure the pins that depend on its force. These are the pins that carry it, and the pins that depend
/// on later closures whose equations contain it.
pub fn mark_dependent_pins(links: &[TreeLink], closures: &mut [CutClosure], steps: &[SolveStep]) {
    for (at, step) in steps.iter().enumerate().rev() {
        let mut reaches = 0;
        for (c, _) in members(step) {
            let own = &closures[c];
            reaches |= 1 << own.pin;
            reaches |= own.carried.iter().fold(0, |mask, (j, _)| mask | 1 << links[*j].link);
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

/// Returns each closure of a step with the links whose equations determine it.
fn members(step: &SolveStep) -> Vec<(usize, Vec<usize>)> {
    match step {
        SolveStep::Pair { closure, rows } => vec![(*closure, rows.iter().map(|(j, _)| *j).collect())],
        SolveStep::Together { closures, rows } => closures.iter().map(|&c| (c, rows.clone())).collect(),
    }
}
