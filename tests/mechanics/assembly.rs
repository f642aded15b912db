//! Assemblies: blocks in space against independent software, against point masses in space, and against the laws.

use nalgebra::{Matrix3, Vector3};
use serde_json::Value;
use stillbase::mechanics::assembly::{
    Assembly, AssemblySpec, Attitude, BlockState, Momentum, Reacting, SpatialBase, SpatialWrench, builtin_assemblies,
    parse,
};
use stillbase::mechanics::machine::{Counterweight, FileError, Machine, named, parse as parse_machine};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector, unit};

use crate::support::random::{a_machine, an_assembly};
use crate::support::{Noise, array, close, family_machine, numbers};

fn reference() -> Value {
    serde_json::from_str(include_str!("../reference/assembly.json")).expect("valid JSON")
}

/// The machines of the reference: the carrier is the geared nine-link machine with other centres of mass.
fn find(name: &str) -> Result<Machine, FileError> {
    if name != "carrier" {
        return Ok(["two-drive-balanced", "serial-3r-balanced"].into_iter().find(|own| *own == name).map_or_else(
            || named(name).unwrap_or_else(|_| parse_machine(name, name).expect("a machine")),
            family_machine,
        ));
    }
    let mut spec = family_machine("nine-link-geared-balanced").spec().clone();
    let com = &reference()["carrier_com"];
    for link in &mut spec.links {
        link.com = com[&link.name].as_f64().expect("a number");
    }
    Ok(Machine::new(spec).expect("a machine"))
}

/// The assembly of the reference, with the wrist mounted at a place on its platform.
fn of_reference(wrist_at: [f64; 3]) -> Assembly {
    let mounts = &reference()["mounts"];
    let block = |(name, machine): (&str, &str)| {
        let of = &mounts[name];
        let at = if name == "wrist" { wrist_at } else { array(&of["at"]) };
        let [x, y]: [[f64; 3]; 2] = [array(&of["x"]), array(&of["y"])];
        let on = &of["on"];
        format!("[[block]]\nname = {name:?}\nmachine = {machine:?}\non = {on}\nat = {at:?}\nx = {x:?}\ny = {y:?}\n")
    };
    let blocks = [("carrier", "carrier"), ("wrist", "two-drive-balanced"), ("second", "serial-3r-balanced")].map(block);
    let text = format!("kind = \"assembly\"\nname = \"reference\"\n{}", blocks.concat());
    parse(&text, "reference", &find).expect("an assembly")
}

fn state(of: [&[f64]; 3]) -> BlockState {
    let [q, qd, qdd] = of.map(|numbers| PerDrive::from_slice(numbers).expect("few"));
    BlockState { q: DriveAngles(q), qd, qdd }
}

#[test]
fn every_wrench_of_the_reference_to_nine_digits() {
    let file = reference();
    let mut kinds = Vec::new();
    for want in file["states"].as_array().expect("states") {
        let kind = want["kind"].as_str().expect("a kind");
        let assembly = of_reference(if kind.contains("off the pin") { [0.02, 0.01, 0.05] } else { [0.0; 3] });
        let states: Vec<BlockState> = (assembly.blocks().iter())
            .map(|block| {
                let given: Vec<Vec<f64>> = (0..3).map(|i| numbers(&want["state"][&block.name][i])).collect();
                state([&given[0], &given[1], &given[2]])
            })
            .collect();
        let SpatialWrench { force, moment } = assembly.loads(&states, |_, _| {}).total();
        // Where nothing reaches the base, rounding is that of the torques.
        let [want_force, want_moment]: [[f64; 3]; 2] = [array(&want["force"]), array(&want["moment"])];
        (0..3).for_each(|i| assert!((force[i] - want_force[i]).abs() < 1e-10, "{kind}: {force:?} {want_force:?}"));
        (0..3).for_each(|i| assert!((moment[i] - want_moment[i]).abs() < 1e-10, "{kind}: {moment:?} {want_moment:?}"));
        kinds.push(kind.to_owned());
    }
    assert_eq!(kinds.len(), 6);
}

/// s of a quintic from 0 to 1 with its derivatives.
fn quintic(u: f64) -> [f64; 3] {
    [u * u * u * (10.0 + u * (-15.0 + 6.0 * u)), 30.0 * (u * (1.0 - u)).powi(2), 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)]
}

fn base_of(of: &Value) -> SpatialBase {
    let [com, diagonal]: [[f64; 3]; 2] = [array(&of["com"]), array(&of["inertia"])];
    SpatialBase {
        mass: of["mass"].as_f64().expect("a mass"),
        com: com.into(),
        inertia: Matrix3::from_diagonal(&diagonal.into()),
    }
}

/// Turns a base by steps, with nothing but the motion of its blocks; returns its attitude, and where its origin went.
fn turned(
    assembly: &Assembly,
    base: &SpatialBase,
    steps: usize,
    time: f64,
    at: &dyn Fn(f64) -> Vec<BlockState>,
) -> (Attitude, Vector3<f64>) {
    let (mut attitude, h) = (Attitude::level(), time / steps as f64);
    let moving = |t: f64| assembly.base_motion(base, &at(t), &Vector3::zeros());
    for i in 0..steps {
        attitude = attitude.after(h, |part, _| moving((i as f64 + part) * h).rate);
    }
    let [first, last] = [moving(0.0).com, moving(time).com];
    (attitude, first - attitude.0 * last)
}

#[test]
fn a_floating_base_turns_as_in_the_reference() {
    let file: Value = serde_json::from_str(include_str!("../reference/assembly_free.json")).expect("valid JSON");
    let (assembly, base, time) = (of_reference([0.0; 3]), base_of(&file["base"]), file["T"].as_f64().expect("a time"));
    let mut seen = 0;
    for run in file["runs"].as_array().expect("runs") {
        let at = |t: f64| -> Vec<BlockState> {
            let [s, sd, sdd] = quintic(t / time);
            let of = |name: &str| {
                let [from, to] = ["start", "end"].map(|end| numbers(&run[end][name]));
                let all = |by: f64| from.iter().zip(&to).map(|(a, b)| by * (b - a)).collect::<Vec<f64>>();
                let q: Vec<f64> = all(s).iter().zip(&from).map(|(by, from)| from + by).collect();
                state([&q, &all(sd / time), &all(sdd / (time * time))])
            };
            assembly.blocks().iter().map(|block| of(&block.name)).collect()
        };
        let (attitude, origin) = turned(&assembly, &base, 400, time, &at);
        close("attitude", &attitude.components(), &numbers(&run["attitude"]), 1e-9);
        close("origin", origin.as_slice(), &numbers(&run["origin"]), 1e-9);
        // Fourth order: half the step leaves a sixteenth of the error.
        let error = |steps: usize| attitude.0.angle_to(&turned(&assembly, &base, steps, time, &at).0.0);
        let (coarse, fine) = (error(10), error(20));
        assert!(coarse < 1e-9 || (10.0..24.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
        seen += 1;
    }
    assert_eq!(seen, 3);
}

/// A point mass, or a rotor without mass that spins about an axis.
pub enum Piece {
    Mass(f64, Vector3<f64>),
    Rotor(f64, Vector3<f64>, f64),
}

/// Every link and every counterweight as six points, in pairs as far apart on its axes as its moments of inertia say, in
/// axes of the base.
pub fn pieces(assembly: &Assembly, states: &[BlockState]) -> Vec<Piece> {
    let mut all = Vec::new();
    let mut mounts: Vec<Option<Vector3<f64>>> = vec![None; states.len()];
    while mounts.iter().any(Option::is_none) {
        for (i, block) in assembly.blocks().iter().enumerate() {
            let tip_of = |carrier: usize| {
                let (own, below) = (&assembly.blocks()[carrier], mounts[carrier]?);
                let tip = own.machine.end_effector().iter().zip(states[carrier].q.iter());
                let [x, y] = tip.fold([0.0; 2], |[x, y], (w, q)| [x + w * q.cos(), y + w * q.sin()]);
                Some(below + own.mount.axes * Vector3::new(x, y, own.machine.spec().payload.axial))
            };
            let below = block.mount.on.map_or(Some(Vector3::zeros()), tip_of);
            mounts[i] = mounts[i].or(below.map(|below| below + block.mount.at));
        }
    }
    for ((block, state), mount) in assembly.blocks().iter().zip(states).zip(mounts) {
        let (machine, mount) = (&block.machine, mount.expect("found"));
        // What follows no drive keeps its orientation.
        let ahead = |k: usize| state.q.get(k).map_or(Vector::new(1.0, 0.0), |q| unit(*q));
        let chained = |chain: &[f64]| -> Vector { chain.iter().enumerate().map(|(k, a)| *a * ahead(k)).sum() };
        // Moments about the axes along, across and normal to the plane; the place is along the link and to its left.
        let mut body = |mass: f64, [a, c, n]: [f64; 3], height: f64, from: Vector, e: Vector, at: [f64; 2]| {
            let squared = [0.5 * (c + n - a), 0.5 * (a + n - c), 0.5 * (a + c - n)];
            let centre = from + e * Vector::new(at[0], at[1]);
            for (axis, second) in squared.into_iter().enumerate() {
                let away = (3.0 * second.max(0.0) / mass).sqrt();
                for away in [away, -away] {
                    let mut own = [0.0; 3];
                    own[axis] = away;
                    let place = centre + e * Vector::new(own[0], own[1]);
                    let place = Vector3::new(place.re, place.im, height + own[2]);
                    all.push(Piece::Mass(mass / 6.0, mount + block.mount.axes * place));
                }
            }
        };
        let spec = machine.spec();
        for (link, part) in spec.links.iter().zip(machine.resolved_links()) {
            let (from, e) = (chained(&part.root), part.sign * ahead(part.drive));
            let own = [link.inertia_along, link.inertia_across.unwrap_or(link.inertia), link.inertia];
            body(link.mass, own, link.axial, from, e, [link.com, link.com_normal]);
            for weight in spec.counterweights.iter().filter(|weight| weight.link == link.name) {
                let flat = flat_moments(weight);
                body(weight.mass, flat, link.axial, from, e, [weight.at, weight.across]);
            }
        }
        let payload = spec.payload;
        if payload.mass > 0.0 {
            let part = &machine.resolved_links()[machine.end_link()];
            let e = part.sign * ahead(part.drive);
            let own = [payload.inertia_along, payload.inertia_across.unwrap_or(payload.inertia), payload.inertia];
            body(payload.mass, own, payload.axial, chained(machine.end_effector()), e, payload.offset);
        }
        let on = |k: usize| {
            let name = machine.spec().drives[k].on.as_deref()?;
            machine.spec().drives.iter().position(|drive| drive.name == name)
        };
        for (k, drive) in machine.spec().drives.iter().enumerate() {
            let Some(rotor) = drive.rotor else { continue };
            let below = on(k).map_or(0.0, |on| state.q[on]);
            let turn = below + rotor.ratio * (state.q[k] - below);
            all.push(Piece::Rotor(rotor.inertia, block.mount.axes.column(2).into(), turn));
        }
    }
    all
}

/// Moments of a counterweight as a flat body about the axes along and across its link and normal to the plane, by a sum
/// over sectors of its circles.
fn flat_moments(weight: &Counterweight) -> [f64; 3] {
    let mass = weight.mass;
    if weight.length > 0.0 {
        let [length, width] = [weight.length, weight.width].map(|side| mass * side * side / 12.0);
        return [width, length, width + length];
    }
    if weight.radius == 0.0 {
        return [0.0; 3];
    }
    // The sums are exact: squares of cosines repeat after half a turn.
    let (sectors, whole) = (16, if weight.half { 0.5 } else { 1.0 } * std::f64::consts::TAU);
    let ring = |n: i32| (weight.radius.powi(n) - weight.inner_radius.powi(n)) / f64::from(n);
    let mut sums = [0.0; 3];
    for i in 0..sectors {
        let e = unit(whole * ((f64::from(i) + 0.5) / f64::from(sectors) - 0.5));
        sums[0] += ring(2);
        sums[1] += ring(4) * e.im * e.im;
        sums[2] += ring(4) * e.re * e.re;
    }
    let centre = weight.circle_at() - weight.at;
    let [along, across] = [mass * sums[1] / sums[0], mass * (sums[2] / sums[0] - centre * centre)];
    [along, across, along + across]
}

/// The states a time later.
pub fn after(states: &[BlockState], t: f64) -> Vec<BlockState> {
    let one = |s: &BlockState| BlockState {
        q: DriveAngles(s.q.0.plus(t, &s.qd).plus(0.5 * t * t, &s.qdd)),
        qd: s.qd.plus(t, &s.qdd),
        qdd: s.qdd,
    };
    states.iter().map(one).collect()
}

/// Momentum by differences of places.
fn momentum(assembly: &Assembly, states: &[BlockState]) -> Momentum {
    let h = 1e-5;
    let [before, behind] = [-h, h].map(|t| pieces(assembly, &after(states, t)));
    let mut sum = Momentum::default();
    for (a, b) in before.iter().zip(&behind) {
        match (a, b) {
            (Piece::Mass(m, a), Piece::Mass(_, b)) => {
                let p = *m * (b - a) / (2.0 * h);
                sum.linear += p;
                sum.angular += (0.5 * (a + b)).cross(&p);
            }
            (Piece::Rotor(inertia, axis, a), Piece::Rotor(_, _, b)) => {
                sum.angular += *inertia * *axis * ((b - a) / (2.0 * h));
            }
            _ => unreachable!("the same pieces"),
        }
    }
    sum
}

pub fn random_states(noise: &mut Noise, assembly: &Assembly) -> Vec<BlockState> {
    let block = |n: usize, noise: &mut Noise| {
        let mut any = |most: f64| PerDrive::from_fn(n, |_| noise.between(-most, most));
        BlockState { q: DriveAngles(any(3.0)), qd: any(1.5), qdd: any(3.0) }
    };
    assembly.blocks().iter().map(|own| block(own.machine.drives(), noise)).collect()
}

fn near(what: &str, got: &Vector3<f64>, want: &Vector3<f64>, scale: f64, tolerance: f64) {
    assert!((got - want).norm() <= tolerance * scale.max(1.0), "{what}: {got:?} {want:?}");
}

/// Any blocks, with heights, rotors and payloads, carried or not: momenta are those of point masses, loads are their rates
/// of change, and torques give the power that changes the energy.
#[test]
fn blocks_are_the_sum_of_their_points() {
    let mut noise = Noise::of(20_261);
    for round in 0..60 {
        let assembly = an_assembly(&mut noise);
        let states = random_states(&mut noise, &assembly);
        let own = assembly.momentum(&states);
        let want = momentum(&assembly, &states);
        let scale = own.angular.norm() + own.linear.norm();
        near("linear momentum", &own.linear, &want.linear, scale, 1e-8);
        near("angular momentum", &own.angular, &want.angular, scale, 1e-8);
        let h = 1e-4;
        let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|i| assembly.momentum(&after(&states, i * h)));
        let rate = |of: fn(&Momentum) -> Vector3<f64>| (of(&a) - of(&d) + 8.0 * (of(&c) - of(&b))) / (12.0 * h);
        let mut torques = vec![PerDrive::zeros(0); states.len()];
        let loads = assembly.loads(&states, |i, loads| torques[i] = loads.torque);
        let (force, moment) = (-rate(|m| m.linear), -rate(|m| m.angular));
        let scale = moment.norm() + force.norm();
        near(&format!("force {round}"), &loads.motion.force, &force, scale, 1e-7);
        near(&format!("moment {round}"), &loads.motion.moment, &moment, scale, 1e-7);
        // Weight acts at the centres of mass.
        let mut weight = SpatialWrench::default();
        for piece in pieces(&assembly, &states) {
            if let Piece::Mass(m, at) = piece {
                weight.force += m * assembly.gravity;
                weight.moment += at.cross(&(m * assembly.gravity));
            }
        }
        near("weight", &loads.weight.force, &weight.force, weight.force.norm(), 1e-12);
        near("its moment", &loads.weight.moment, &weight.moment, weight.moment.norm() + 1.0, 1e-12);
        // Each motor turns its drive against what carries it.
        let power: f64 = (assembly.blocks().iter().zip(&states).zip(&torques))
            .map(|((block, state), torque)| {
                let drives = &block.machine.spec().drives;
                let rate = |k: usize| {
                    let on = drives[k].on.as_ref().and_then(|on| drives.iter().position(|own| own.name == *on));
                    state.qd[k] - on.map_or(0.0, |on| state.qd[on])
                };
                torque.iter().enumerate().map(|(k, torque)| torque * rate(k)).sum::<f64>()
            })
            .sum();
        let energy = |t: f64| {
            let [before, at, behind] = [-h, 0.0, h].map(|by| pieces(&assembly, &after(&states, t + by)));
            let each = before.iter().zip(&at).zip(&behind).map(|((a, at), b)| match (a, at, b) {
                (Piece::Mass(m, a), Piece::Mass(_, at), Piece::Mass(_, b)) => {
                    0.5 * m * ((b - a) / (2.0 * h)).norm_squared() - m * assembly.gravity.dot(at)
                }
                (Piece::Rotor(inertia, _, a), _, Piece::Rotor(_, _, b)) => {
                    0.5 * inertia * ((b - a) / (2.0 * h)).powi(2)
                }
                _ => unreachable!("the same pieces"),
            });
            each.sum::<f64>()
        };
        let change = (energy(h) - energy(-h)) / (2.0 * h);
        assert!((power - change).abs() <= 1e-5 * (1.0 + power.abs() + scale), "{round}: {power} {change}");
    }
}

/// A base that floats has the rate at which point masses and base keep their momentum, and their inertia.
#[test]
fn a_floating_base_keeps_the_momentum_of_points() {
    let mut noise = Noise::of(77);
    for _ in 0..40 {
        let assembly = an_assembly(&mut noise);
        let states = random_states(&mut noise, &assembly);
        let any = |noise: &mut Noise| Vector3::from_fn(|_, _| noise.between(-0.4, 0.4));
        let root = Matrix3::from_fn(|_, _| noise.between(-1.0, 1.0));
        let base = SpatialBase {
            mass: noise.between(1.0, 30.0),
            com: any(&mut noise),
            inertia: root * root.transpose() + Matrix3::identity(),
        };
        let kept = any(&mut noise);
        let motion = assembly.base_motion(&base, &states, &kept);
        // Points turn with the base and move on it.
        let h = 1e-5;
        let [before, at, behind] = [-h, 0.0, h].map(|t| pieces(&assembly, &after(&states, t)));
        let mut angular = base.inertia * motion.rate;
        let (mut mass, mut first) = (base.mass, base.mass * base.com);
        let mut linear = base.mass * motion.rate.cross(&base.com);
        angular += base.com.cross(&(base.mass * motion.rate.cross(&base.com)));
        for ((a, at), b) in before.iter().zip(&at).zip(&behind) {
            match (a, at, b) {
                (Piece::Mass(m, a), Piece::Mass(_, at), Piece::Mass(_, b)) => {
                    let p = *m * ((b - a) / (2.0 * h) + motion.rate.cross(at));
                    linear += p;
                    angular += at.cross(&p);
                    mass += m;
                    first += *m * at;
                }
                (Piece::Rotor(inertia, axis, a), _, Piece::Rotor(_, _, b)) => {
                    angular += *inertia * *axis * ((b - a) / (2.0 * h) + axis.dot(&motion.rate));
                }
                _ => unreachable!("the same pieces"),
            }
        }
        near("centre of mass", &motion.com, &(first / mass), 1.0, 1e-12);
        let about_com = angular - (first / mass).cross(&linear);
        near("angular momentum", &about_com, &kept, about_com.norm() + motion.rate.norm(), 1e-7);
    }
}

/// A motion of every block on its own plane: λ · q̇ = 0 and λ · q̈ = 0 with what it carries.
fn on_planes(noise: &mut Noise, assembly: &Assembly) -> Vec<BlockState> {
    let mut states = random_states(noise, assembly);
    for (i, state) in states.iter_mut().enumerate() {
        let lambda = assembly.conditions(i).inertia.lambda();
        let along = |v: &PerDrive| lambda.dot(v) / lambda.dot(&lambda).max(1e-300);
        (state.qd, state.qdd) =
            (state.qd.plus(-along(&state.qd), &lambda), state.qdd.plus(-along(&state.qdd), &lambda));
    }
    states
}

/// What the conditions call silent is silent, what they do not reacts, and the reason is the right one.
#[test]
fn conditions_say_which_blocks_react() {
    let silent = of_reference([0.0; 3]);
    let mut noise = Noise::of(5);
    let wrench = |assembly: &Assembly, noise: &mut Noise| {
        let states = on_planes(noise, assembly);
        let (mut scale, six) = (0.0, assembly.loads(&states, |_, of| _ = of).total().components());
        assembly.loads(&states, |_, of| scale += of.torque.iter().map(|x| x.abs()).sum::<f64>());
        six.map(|x| x.abs() / scale)
    };
    for _ in 0..50 {
        assert!(wrench(&silent, &mut noise).iter().all(|x| *x < 1e-12));
    }
    assert!((0..3).all(|i| silent.conditions(i).reasons().count() == 0));
    // Off the pin the carrier couples with its platform; above the pin it tilts the base.
    for (at, want) in [
        ([0.02, 0.0, 0.0], vec![Reacting::Ground]),
        ([0.0, 0.0, 0.05], vec![Reacting::Tilt]),
        ([0.02, 0.01, 0.05], vec![Reacting::Ground, Reacting::Tilt]),
    ] {
        let off = of_reference(at);
        assert_eq!(off.conditions(0).reasons().collect::<Vec<_>>(), want);
        assert!([1, 2].iter().all(|i| off.conditions(*i).reasons().count() == 0));
        let (tilts, turns) = (want.contains(&Reacting::Tilt), want.contains(&Reacting::Ground));
        let six = wrench(&off, &mut noise);
        assert!(six[..3].iter().all(|x| *x < 1e-12), "no force");
        assert_eq!((six[3].max(six[4]) > 1e-6, six[5] > 1e-6), (tilts, turns), "{six:?}");
    }
    // Without what it carries the carrier is not balanced, and neither is one that carries what it was not made for.
    let other = silent.clone().with_machines(|name, machine| match name {
        "wrist" => machine.set("payload.mass", "0.3"),
        _ => Ok(machine),
    });
    let reasons: Vec<Vec<Reacting>> =
        other.map(|other| (0..3).map(|i| other.conditions(i).reasons().collect()).collect()).expect("a machine");
    assert_eq!(reasons[0], [Reacting::Force, Reacting::Coupling]);
    assert!(reasons[1].contains(&Reacting::Force));
}

/// A machine by itself is an assembly of one block.
#[test]
fn a_machine_is_an_assembly_of_one() {
    use stillbase::mechanics::dynamics::{ExternalLoads, inverse_with_wrench};
    let mut noise = Noise::of(8);
    for _ in 0..50 {
        let machine = a_machine(&mut noise);
        let assembly = Assembly::from(machine.clone());
        let states = random_states(&mut noise, &assembly);
        let mut torque = PerDrive::zeros(0);
        let loads = assembly.loads(&states, |_, of| torque = of.torque).total();
        let block = &assembly.blocks()[0];
        let around = ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() };
        let BlockState { q, qd, qdd } = states[0];
        let (want, wrench) = inverse_with_wrench(&block.inertia, &q.units(), &qd, &qdd, &around);
        assert_eq!(torque, block.inertia.motors().motor_torques(&want));
        let wrench = wrench.total();
        let scale = wrench.force.norm() + wrench.moment.abs();
        near("force", &loads.force, &Vector3::new(wrench.force.re, wrench.force.im, 0.0), scale, 1e-13);
        assert!((loads.moment.z - wrench.moment).abs() <= 1e-13 * scale);
    }
}

#[test]
fn wrong_files_are_told_where_and_what_would_be_right() {
    let head = "kind = \"assembly\"\nname = \"a\"\n";
    let block = |name: &str, more: &str| format!("[[block]]\nname = {name:?}\nmachine = \"nine-link\"\n{more}\n");
    for (text, line, words) in [
        (head.to_owned(), None, "0 blocks: want 1 to 8"),
        (format!("{head}{}{}", block("a", ""), block("a", "")), Some(8), "taken"),
        (format!("{head}{}", block("base", "")), Some(4), "other than \"base\""),
        (format!("{head}{}", block("a", "on = \"b\"")), Some(6), "which does not exist"),
        (format!("{head}{}{}", block("a", "on = \"b\""), block("b", "on = \"a\"")), Some(6), "a on b on a"),
        (format!("{head}{}", block("a", "on = \"a\"")), Some(6), "a on a"),
        (format!("{head}{}", block("a", "x = [0, 0, 0]")), Some(6), "want a direction"),
        (format!("{head}{}", block("a", "x = [1, 1, 0]")), Some(3), "y = [-0.707106781, 0.707106781, 0]"),
        (format!("{head}{}", block("a", "at = [0, nan, 0]")), Some(6), "want three numbers"),
        (format!("{head}gravity = [0, 0, 1e9]\n{}", block("a", "")), Some(3), "want three numbers"),
        (format!("{head}{}", block("a", "mount = [0, 0, 0]")), Some(6), "on"),
        (format!("{head}{}", block("a", "").repeat(9)), Some(3), "9 blocks"),
        ("kind = \"assemblage\"\nname = \"a\"\n".to_owned(), Some(1), "assembly"),
    ] {
        let why = parse(&text, "wrong.toml", &named).expect_err(words).to_string();
        let place = line.map_or("wrong.toml: ".to_owned(), |line| format!("wrong.toml:{line}: "));
        assert!(why.starts_with(&place) && why.contains(words), "{why}");
    }
    let spec: AssemblySpec = toml::from_str(&format!("{head}{}", block("a", ""))).expect("a table");
    assert_eq!(Assembly::new(&spec, &named).expect("an assembly").blocks()[0].name, "a");
}

/// A frame that keeps its orientation on a carried block is off its pin for the carrier.
#[test]
fn a_frame_of_a_carried_block_is_beside_the_pin() {
    let found = builtin_assemblies().iter().find(|own| own.name == "carrier-and-wrist").expect("built in").clone();
    let framed = found.with_machines(|name, machine| {
        let mut spec = machine.spec().clone();
        if name == "wrist" {
            let mut frame = spec.links[0].clone();
            (frame.name, frame.drive, frame.mass) = ("frame".into(), "ground".into(), 0.05);
            (frame.com, frame.inertia) = (0.1, 1e-4);
            spec.links.push(frame);
        }
        Machine::new(spec)
    });
    let framed = framed.expect("an assembly");
    let conditions = framed.conditions(0);
    // The wrist's x lies along the carrier's axis: the frame is above the pin, not beside it.
    assert!((conditions.carried.mass - 0.47).abs() < 1e-12);
    assert!((conditions.carried.above - 0.05 * 0.1 / 0.47).abs() < 1e-12, "{:?}", conditions.carried);
    assert!(conditions.carried.beside.norm() < 1e-12);
    assert!(conditions.reasons().any(|why| why == Reacting::Tilt));
}

#[test]
fn a_chain_leads_from_the_base_to_a_block() {
    let block = |name: &str, on: &str| {
        format!(
            "[[block]]\nname = {name:?}\nmachine = \"two-drive-balanced\"\non = {on:?}\nat = [0, 0, 0]\n\
             x = [1, 0, 0]\ny = [0, 1, 0]\n"
        )
    };
    // In the file the last block is not the last of the longest chain, and two chains are equally long.
    let blocks = [("top", "middle"), ("alone", "base"), ("middle", "low"), ("low", "base"), ("twin", "middle")];
    let text = blocks.map(|(name, on)| block(name, on)).concat();
    let text = format!("kind = \"assembly\"\nname = \"tower\"\n{text}{}", block("side", "alone"));
    let assembly = parse(&text, "tower", &find).expect("an assembly");
    assert_eq!(assembly.chain(0), [3, 2, 0]);
    assert_eq!(assembly.chain(5), [1, 5]);
    assert_eq!(assembly.chain(3), [3]);
    assert_eq!(assembly.longest_chain(), [3, 2, 0]);
}
