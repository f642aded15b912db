//! Pins, change points and tilting moments against nine rigid bodies, against each link's own balance, and the laws.

use std::f64::consts::PI;

use proptest::prelude::*;
use stillbase::mechanics::dynamics::{ExternalLoads, inverse_with_wrench};
use stillbase::mechanics::joint_forces::{
    AxialMoments, FLAT_SINE, InternalLoads, Joints, JointsError, MAX_FRAME_PINS, Pin, PinForces, PinLoads, PinPeak,
    nearest_change_point, next_change_point,
};
use stillbase::mechanics::kinematics::{acceleration, least_transmission};
use stillbase::mechanics::machine::{Chain, Inertia, Machine, builtin, parse, place_of};
use stillbase::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, cross, dot, unit};

use crate::support::{State, any_body, close, machine_of, three, xy};

impl State {
    fn forces(&self, machine: &Machine, around: &ExternalLoads) -> PinForces {
        let joints = Joints::of(machine).expect("determinate");
        joints.forces(&self.q.units(), &self.qd, &self.qdd, around)
    }

    fn turned(&self, angle: f64) -> Self {
        Self { q: DriveAngles(PerDrive::from_fn(self.q.len(), |k| self.q[k] + angle)), ..*self }
    }
}

/// Any state with min |sin(q_k − q_l)| above 0.02.
fn any_state() -> impl Strategy<Value = State> {
    let three = |x: f64| prop::array::uniform3(-x..x);
    (three(6.0), three(4.0), three(12.0))
        .prop_map(|(q, qd, qdd)| State::new(q, qd, qdd))
        .prop_filter("near a change point", |s| least_transmission(&s.q.units(), 3) > 0.02)
}

/// The same with what the twin has not: CMs off the axis, inertia of the payload, heights.
fn any_machine() -> impl Strategy<Value = Machine> {
    let nine = || prop::collection::vec(-0.2..0.2, 9);
    (any_body(), nine(), nine(), 0.0..0.1, -0.2..0.2).prop_map(|(body, normal, axial, inertia, z)| {
        let mut settings = vec![("payload.inertia".to_owned(), inertia), ("payload.axial".to_owned(), z)];
        for j in 0..9 {
            settings.push((format!("link.{}.com_normal", j + 1), normal[j]));
            settings.push((format!("link.{}.axial", j + 1), axial[j]));
        }
        let settings: Vec<(String, String)> = settings.into_iter().map(|(k, v): (_, f64)| (k, v.to_string())).collect();
        machine_of(&body).set_all(settings.iter().map(|(k, v)| (k.as_str(), v.as_str()))).expect("valid")
    })
}

fn any_force() -> impl Strategy<Value = Vector> {
    (-30.0..30.0, -30.0..30.0).prop_map(|(x, y)| Vector::new(x, y))
}

fn around(machine: &Machine, force: Vector) -> ExternalLoads {
    ExternalLoads { gravity: machine.gravity(), force }
}

fn all(forces: &PinForces) -> Vec<f64> {
    forces.bounded().iter().flat_map(|f| xy(*f)).collect()
}

/// A chain with complex weights as a place and an acceleration.
fn moving(a: &[Vector; MAX_DRIVES], s: &State) -> (Vector, Vector) {
    let e = s.q.units();
    (0..s.q.len()).fold(Default::default(), |(r, rdd), k| {
        let turn = Vector::new(-s.qd[k] * s.qd[k], s.qdd[k]) * e[k];
        (r + a[k] * e[k], rdd + a[k] * turn)
    })
}

/// Newton and Euler of each link by itself: forces of its pins, weight, what it holds, and a torque only where a drive
/// turns it. Knows nothing of trees and closures.
fn assert_each_link_balances(machine: &Machine, s: &State, around: &ExternalLoads, turned: &[Option<usize>]) {
    let joints = Joints::of(machine).expect("determinate");
    let (e, payload) = (s.q.units(), machine.spec().payload);
    let forces = joints.forces(&e, &s.qd, &s.qdd, around);
    let torque = forces.torque().expect("defined");
    let size = forces.largest().0.max(1.0);
    let mut carried = PerDrive::zeros(machine.drives());
    for (j, link) in machine.links().iter().enumerate() {
        let drive = machine.resolved_links()[j].drive;
        let (r, a) = moving(&machine.com_chain(j), s);
        let mut sum = link.mass * (around.gravity - a);
        let mut moment = -link.inertia * s.qdd[drive];
        if j == machine.end_link() {
            let tip = machine.end_effector();
            let at = place_of(tip, &e);
            let f = payload.mass * (around.gravity - acceleration(tip, &e, &s.qd, &s.qdd)) + around.force;
            sum += f;
            moment += cross(at - r, f) - payload.inertia * s.qdd[drive];
        }
        for (i, pin) in joints.pins().iter().enumerate() {
            let sign = if pin.to == j {
                1.0
            } else if pin.from == Some(j) {
                -1.0
            } else {
                continue;
            };
            let f = sign * forces.get(i).expect("defined");
            sum += f;
            moment += cross(place_of(&pin.at, &e) - r, f);
        }
        assert!(sum.norm() < 1e-9 * size, "link {}: {sum} N left of {size}", link.name);
        match turned[j] {
            Some(k) => carried[k] -= moment,
            None => assert!(moment.abs() < 1e-9 * size, "link {}: {moment} N m left of {size}", link.name),
        }
    }
    close("torque by the links at B", &carried, &torque, 1e-9 * size);
}

const AT_B: [Option<usize>; 9] = [Some(0), Some(1), Some(2), None, None, None, None, None, None];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// All twelve pins of 27 equations in 27 numbers, and its torques.
    #[test]
    fn pins_of_nine_rigid_bodies(body in any_body(), s in any_state()) {
        let machine = machine_of(&body);
        let forces = s.forces(&machine, &around(&machine, Vector::default()));
        let twin = body.solve(three(&s.q.0), three(&s.qd), three(&s.qdd));
        close("pins", &all(&forces), &twin.pins.concat(), 1e-9);
        close("torque", &forces.torque().expect("defined"), &twin.torque, 1e-9);
    }

    /// Any machine, any force at the end effector: each link for itself, and the sums over all.
    #[test]
    fn each_link_is_in_balance(machine in any_machine(), s in any_state(), force in any_force()) {
        let around = around(&machine, force);
        assert_each_link_balances(&machine, &s, &around, &AT_B);
        let joints = Joints::of(&machine).expect("determinate");
        let e = s.q.units();
        let forces = joints.forces(&e, &s.qd, &s.qdd, &around);
        let (torque, wrench) = inverse_with_wrench(&Inertia::of(&machine), &e, &s.qd, &s.qdd, &around);
        let tolerance = 1e-10 / least_transmission(&e, 3);
        close("torque", &forces.torque().expect("defined"), &torque, tolerance);
        close("f_B", &xy(joints.on_base(&forces)), &xy(wrench.total().force), tolerance);
        let sum: f64 = forces.torque().expect("defined").iter().sum();
        close("n_B", &[-sum], &[wrench.total().moment], tolerance * torque.max_abs().max(1.0));
    }

    /// Pins do no work: both links of each have the same velocity there.
    #[test]
    fn pins_do_no_work(machine in any_machine(), s in any_state()) {
        let (joints, e) = (Joints::of(&machine).expect("determinate"), s.q.units());
        let forces = s.forces(&machine, &around(&machine, Vector::default()));
        let (mut power, mut scale) = (0.0, 1e-9);
        for (j, part) in machine.resolved_links().iter().enumerate() {
            let rate = |c: &Chain| (0..3).map(|k| Vector::new(0.0, s.qd[k] * c[k]) * e[k]).sum::<Vector>();
            for (i, pin) in joints.pins().iter().enumerate().filter(|(_, p)| p.to == j || p.from == Some(j)) {
                // Velocity as this link has it, from where the pin lies along it.
                let along = dot(place_of(&pin.at, &e) - place_of(&part.root, &e), e[part.drive]);
                let v = rate(&part.root) + Vector::new(0.0, s.qd[part.drive] * along) * e[part.drive];
                let p = dot(forces.bounded()[i], v) * if pin.to == j { 1.0 } else { -1.0 };
                power += p;
                scale += p.abs();
            }
        }
        prop_assert!(power.abs() < 1e-12 * scale, "{power} W of {scale}");
    }

    /// Everything turned, gravity and force too: so do the forces and what tilts the base.
    #[test]
    fn forces_turn_with_everything(machine in any_machine(), s in any_state(), force in any_force(), by in -4.0..4.0) {
        let still = around(&machine, force);
        let turned = ExternalLoads { gravity: still.gravity * unit(by), force: still.force * unit(by) };
        let (a, b) = (s.forces(&machine, &still), s.turned(by).forces(&machine, &turned));
        let want: Vec<f64> = a.bounded().iter().flat_map(|f| xy(f * unit(by))).collect();
        close("pins", &all(&b), &want, 1e-10);
        let axial = AxialMoments::of(&machine);
        let tilt = |s: &State, around| axial.tilt(&s.q.units(), &s.qd, &s.qdd, around).total();
        close("tilt", &xy(tilt(&s.turned(by), &turned)), &xy(tilt(&s, &still) * unit(by)), 1e-11);
    }

    /// Forces are linear in what causes them: weight, rates and accelerations, a force.
    #[test]
    fn causes_add(machine in any_machine(), s in any_state(), force in any_force()) {
        let still = State { qd: PerDrive::zeros(3), qdd: PerDrive::zeros(3), ..s };
        let no = ExternalLoads::default();
        let parts = [
            all(&s.forces(&machine, &no)),
            all(&still.forces(&machine, &around(&machine, Vector::default()))),
            all(&still.forces(&machine, &ExternalLoads { force, ..no })),
        ];
        let sum: Vec<f64> = (0..parts[0].len()).map(|i| parts.iter().map(|p| p[i]).sum()).collect();
        close("pins", &all(&s.forces(&machine, &around(&machine, force))), &sum, 1e-10);
    }

    /// One machine, cut elsewhere: link 5 hangs on 9, 9 on 8, and two closures meet in link 5, so that they have to be
    /// solved together. The hardware is the same, so are its forces.
    #[test]
    fn where_it_is_cut_does_not_matter(s in any_state(), force in any_force()) {
        let (machine, other) = (builtin("nine-link").expect("built in"), recut());
        let forces = |machine: &Machine| {
            let joints = Joints::of(machine).expect("determinate");
            let around = ExternalLoads { gravity: Vector::new(1.0, -9.81), force };
            let forces = joints.forces(&s.q.units(), &s.qd, &s.qdd, &around);
            (joints, forces)
        };
        let ((joints, a), (others, b)) = (forces(machine), forces(&other));
        for (i, pin) in joints.pins().iter().enumerate() {
            let same = |p: &&Pin| [(p.from, p.to), (Some(p.to), p.from.unwrap_or(p.to))].contains(&(pin.from, pin.to));
            let other = others.pins().iter().find(same).unwrap_or_else(|| panic!("no pin {}", pin.name));
            let l = others.pins().iter().position(|p| p == other).expect("found");
            let sign = if other.to == pin.to { 1.0 } else { -1.0 };
            close(&pin.name, &xy(sign * b.bounded()[l]), &xy(a.bounded()[i]), 1e-8 / least_transmission(&s.q.units(), 3));
        }
        assert_each_link_balances(&other, &s, &around(&other, force), &AT_B);
    }

    /// Σ r_j × m_j (g − a_j) in space, accelerations by differences of positions.
    #[test]
    fn tilt_is_a_sum_in_space(machine in any_machine(), s in any_state(), force in any_force()) {
        let around = around(&machine, force);
        let e = s.q.units();
        let at = |t: f64, a: &[Vector; MAX_DRIVES]| -> Vector {
            (0..3).map(|k| a[k] * unit(s.q[k] + t * s.qd[k] + 0.5 * t * t * s.qdd[k])).sum()
        };
        let h = 1e-3;
        let acceleration = |a: &[Vector; MAX_DRIVES]| {
            (-at(2.0 * h, a) + 16.0 * at(h, a) - 30.0 * at(0.0, a) + 16.0 * at(-h, a) - at(-2.0 * h, a)) / (12.0 * h * h)
        };
        let payload = machine.spec().payload;
        let tip = machine.end_effector().map(|w| Vector::new(w, 0.0));
        let links = machine.links().iter().enumerate().map(|(j, l)| (l.mass, l.axial, machine.com_chain(j)));
        let mut sum = [0.0; 3];
        let mut add = |r: Vector, z: f64, f: Vector| {
            let moment = [-z * f.im, z * f.re, cross(r, f)];
            sum.iter_mut().zip(moment).for_each(|(s, m)| *s += m);
        };
        for (m, z, a) in links.chain([(payload.mass, payload.axial, tip)]) {
            add(at(0.0, &a), z, m * (around.gravity - acceleration(&a)));
        }
        add(at(0.0, &tip), payload.axial, force);
        let tilt = AxialMoments::of(&machine).tilt(&e, &s.qd, &s.qdd, &around).total();
        close("tilt", &xy(tilt), &sum[..2], 1e-6);
    }

    /// Lifting everything by one height adds that height times f_B, and leaves the couple.
    #[test]
    fn lifting_the_machine_leaves_the_couple(machine in any_machine(), s in any_state(), lift in -0.5..0.5) {
        let mut spec = machine.spec().clone();
        spec.links.iter_mut().for_each(|l| l.axial += lift);
        spec.payload.axial += lift;
        let lifted = Machine::new(spec).expect("valid");
        let around = around(&machine, Vector::new(3.0, -5.0));
        let e = s.q.units();
        let tilt = |m: &Machine| AxialMoments::of(m).tilt(&e, &s.qd, &s.qdd, &around).total();
        let couple = |m: &Machine| AxialMoments::of(m).couple(&e, &s.qd, &s.qdd);
        let (_, wrench) = inverse_with_wrench(&Inertia::of(&machine), &e, &s.qd, &s.qdd, &around);
        let want = tilt(&machine) + Vector::new(0.0, lift) * wrench.total().force;
        close("tilt", &xy(tilt(&lifted)), &xy(want), 1e-11);
        close("couple", &xy(couple(&lifted)), &xy(couple(&machine)), 1e-10);
    }

    /// Along a straight line in joint space the change point ahead is where sin vanishes, and there is none before.
    #[test]
    fn the_change_point_ahead_is_the_first(s in any_state()) {
        let (least, first) = (nearest_change_point(&s.q, &s.qd).expect("pairs"), next_change_point(&s.q, &s.qd).expect("rates differ"));
        let sines = |t: f64| Inertia::pairs(3).map(move |(k, l)| (s.q[k] - s.q[l] + t * (s.qd[k] - s.qd[l])).sin());
        let time = first.time.expect("it has one");
        let (k, l) = first.drives;
        prop_assert!((s.q[k] - s.q[l] + time * (s.qd[k] - s.qd[l])).sin().abs() < 1e-9 * (1.0 + time));
        let start: Vec<bool> = sines(0.0).map(|x| x > 0.0).collect();
        for i in 0..200 {
            let now: Vec<bool> = sines(time * 0.999 * f64::from(i) / 200.0).map(|x| x > 0.0).collect();
            prop_assert_eq!(&now, &start);
        }
        let (k, l) = least.drives;
        prop_assert!((least_transmission(&s.q.units(), 3) - least.distance.sin()).abs() < 1e-12);
        prop_assert!(((s.q[k] - s.q[l]).sin().abs() - least.distance.sin()).abs() < 1e-12);
    }
}

/// The nine-link machine as another file may describe it.
fn recut() -> Machine {
    let mut spec = builtin("nine-link").expect("built in").spec().clone();
    let toml = |text: &str| -> stillbase::mechanics::machine::LinkPoint { toml::from_str(text).expect("a point") };
    // Turned round, so that roots are where the links now hang: 8 keeps its root, 9 hangs on 8, 5 on 9.
    let metres = |name: &str| spec.lengths[name];
    let (l2, l3, l5, l9) = (metres("l2"), metres("l3"), metres("l5"), metres("l9"));
    let number = |x: f64| stillbase::mechanics::machine::Length::Metres(x);
    let (five, nine) = (4, 8);
    spec.links[nine].attach = stillbase::mechanics::machine::Attach::On(toml("link = \"8\""));
    spec.links[nine].length = number(l9 + l3);
    spec.links[nine].com += l3;
    spec.links[five].attach = stillbase::mechanics::machine::Attach::On(toml(&format!("link = \"9\"\nat = {l3}")));
    spec.links[five].direction = 1;
    spec.links[five].length = number(l5 + l2);
    spec.links[five].com = l5 - spec.links[five].com;
    spec.closures[0].b = toml("link = \"5\"");
    spec.closures[2] = stillbase::mechanics::machine::Closure {
        a: toml("link = \"1\""),
        b: toml(&format!("link = \"5\"\nat = {l5}")),
    };
    Machine::new(spec).expect("the same hardware")
}

#[test]
fn pins_are_named_by_their_links() {
    let joints = Joints::of(builtin("nine-link").expect("built in")).expect("determinate");
    let names: Vec<&str> = joints.pins().iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["B-1", "B-2", "B-3", "2-4", "1-5", "3-6", "1-7", "7-8", "5-9", "4-5", "6-7", "8-9"]);
    let loops: Vec<_> = joints.parallelograms().iter().map(|p| (p.name.as_str(), p.drives)).collect();
    assert_eq!(loops, [("4-5", (0, 1)), ("6-7", (0, 2)), ("8-9", (1, 2))]);
    // Either description puts a closure in the same place.
    let machine = builtin("nine-link").expect("built in");
    for (pin, c) in joints.pins()[9..].iter().zip(machine.loops()) {
        let b = machine.resolved_links()[c.b].point(c.at_b);
        assert!(pin.at.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-12));
    }
}

/// Towards q_3 = q_1: 3 N at 1 rad, 1.1 kN at a thousandth of it, while torques stay.
#[test]
fn forces_grow_towards_a_change_point() {
    let machine = builtin("nine-link").expect("built in");
    let none = ExternalLoads::default();
    let at = |gap: f64| State::new([1.6, 3.9, 1.6 + gap], [-0.3, 0.9, 1.7], [-1.0, 2.0, 4.0]);
    let torque = |gap: f64| {
        let s = at(gap);
        let exact = inverse_with_wrench(&Inertia::of(machine), &s.q.units(), &s.qd, &s.qdd, &none).0;
        let by_pins = s.forces(machine, &none).torque().expect("defined");
        close("torque", &by_pins, &exact, 1e-13 / gap);
        exact.max_abs()
    };
    for gap in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let ratio = at(0.1 * gap).forces(machine, &none).largest().0 / at(gap).forces(machine, &none).largest().0;
        assert!((ratio - 10.0).abs() < 20.0 * gap.max(1e-2), "{ratio} times at {gap}");
        assert!((torque(gap) - torque(1.0)).abs() < 3.0);
    }
}

/// On a change point forces are undefined where they depend on the flat parallelogram, and nowhere else.
#[test]
fn at_a_change_point_some_forces_are_undefined() {
    let machine = builtin("nine-link").expect("built in");
    let joints = Joints::of(machine).expect("determinate");
    let named = |q: [f64; 3]| -> Vec<String> {
        let s = State::new(q, [-0.3, 0.9, 1.7], [-1.0, 2.0, 4.0]);
        let forces = s.forces(machine, &ExternalLoads::default());
        assert!(forces.bounded().iter().all(|f| f.re.is_finite() && f.im.is_finite()));
        let undefined: Vec<usize> = (0..12).filter(|&i| forces.get(i).is_none()).collect();
        assert_eq!(forces.torque().is_none(), !undefined.is_empty());
        undefined.into_iter().map(|i| joints.pins()[i].name.clone()).collect()
    };
    assert!(named([1.6, 3.9, 2.5]).is_empty());
    // 6-7 closes 3-6-7-1: bearings of 1 and 3, and roots of 6 and 7.
    assert_eq!(named([1.6, 3.9, 1.6]), ["B-1", "B-3", "3-6", "1-7", "6-7"]);
    assert_eq!(named([1.6, 1.6, 2.5]), ["B-1", "B-2", "2-4", "1-5", "4-5"]);
    // 8-9 moves 5 and 7 too, so both others depend on it.
    assert_eq!(named([1.6, 3.9, 3.9]).len(), 12);
    assert_eq!(named([1.6, 3.9, 1.6 + 0.5 * FLAT_SINE]).len(), 5);
    assert!(named([1.6, 3.9, 1.6 + 2.0 * FLAT_SINE]).is_empty());
    // What is undefined does not touch what is not: the others are the limits from either side.
    let s = |gap: f64| State::new([1.6, 3.9, 1.6 + gap], [-0.3, 0.9, 1.7], [-1.0, 2.0, 4.0]);
    let (on, near) =
        (s(0.0).forces(machine, &ExternalLoads::default()), s(1e-7).forces(machine, &ExternalLoads::default()));
    for i in (0..12).filter(|&i| on.get(i).is_some()) {
        assert!((on.bounded()[i] - near.bounded()[i]).norm() < 1e-4, "{}", joints.pins()[i].name);
    }
}

const ARM: &str = "name = \"arm\"\n[[drive]]\nname = \"a\"\n[[drive]]\nname = \"b\"\n\
    [[link]]\nname = \"upper\"\ndrive = \"a\"\nattach = \"base\"\nlength = 0.5\nmass = 2.0\ninertia = 0.1\ncom = 0.2\n\
    [[link]]\nname = \"fore\"\ndrive = \"b\"\nattach = { link = \"upper\", at = \"tip\" }\nlength = 0.4\nmass = 1.0\n\
    inertia = 0.05\ncom = 0.1\n[end_effector]\nlink = \"fore\"\n";

/// A serial arm: the forearm's drive turns it by a belt, so the elbow carries its weight and no couple.
#[test]
fn a_serial_arm_needs_no_closure() {
    let arm = parse(&format!("gravity = [0.0, -9.81]\n{ARM}"), "arm").expect("an arm");
    let joints = Joints::of(&arm).expect("determinate");
    assert_eq!(joints.pins().iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["B-upper", "upper-fore"]);
    let s = State { q: [0.3, 1.1].into(), qd: [1.0, -2.0].into(), qdd: [3.0, 0.5].into() };
    assert_each_link_balances(&arm, &s, &around(&arm, Vector::new(1.0, 2.0)), &[Some(0), Some(1)]);
    let forces = s.forces(&arm, &around(&arm, Vector::default()));
    let exact = inverse_with_wrench(&Inertia::of(&arm), &s.q.units(), &s.qd, &s.qdd, &around(&arm, Vector::default()));
    close("torque", &forces.torque().expect("defined"), &exact.0, 1e-14);
    let rest = State { qd: [0.0, 0.0].into(), qdd: [0.0, 0.0].into(), ..s };
    let forces = rest.forces(&arm, &around(&arm, Vector::default()));
    close("weight", &all(&forces), &[0.0, 3.0 * 9.81, 0.0, 9.81], 1e-14);
}

/// A machine of n coaxial drives with a parallelogram for each pair of them.
fn fan(n: usize) -> Machine {
    let mut text = String::from("name = \"fan\"\ngravity = [2.0, -9.0]\npayload = { mass = 0.4, inertia = 0.02 }\n");
    let link = |name: &str, drive: usize, attach: &str, like: usize| {
        let x = 0.1 * like as f64 + 0.03 * name.len() as f64;
        format!(
            "[[link]]\nname = \"{name}\"\ndrive = \"{drive}\"\nattach = {attach}\nlength = {}\nmass = {}\ninertia = {}\n\
             com = {}\ncom_normal = {}\n",
            0.3 + 0.05 * like as f64,
            0.5 + x,
            0.01 + 0.1 * x,
            x - 0.2,
            0.3 * x
        )
    };
    (0..n).for_each(|k| text += &format!("[[drive]]\nname = \"{k}\"\n"));
    // Children before their parents: a file may have any order.
    for (k, l) in Inertia::pairs(n) {
        text += &link(&format!("{k}on{l}"), k, &format!("{{ link = \"{l}\" }}"), k);
        text += &link(&format!("{l}on{k}"), l, &format!("{{ link = \"{k}\" }}"), l);
        text += &format!("[[closure]]\na = {{ link = \"{k}on{l}\" }}\nb = {{ link = \"{l}on{k}\" }}\n");
    }
    (0..n).for_each(|k| text += &link(&k.to_string(), k, "\"base\"", k));
    text += &format!("[end_effector]\nlink = \"{}on0\"\nat = 0.2\n", n - 1);
    parse(&text, "fan").unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Other machines than that of the paper: five pins, twelve, twenty-two, and one with more than are told.
#[test]
fn machines_of_any_number_of_drives() {
    for n in 2..=4 {
        let machine = fan(n);
        let joints = Joints::of(&machine).expect("determinate");
        assert_eq!((joints.pins().len(), joints.parallelograms().len()), (n + 3 * n * (n - 1) / 2, n * (n - 1) / 2));
        let s = State {
            q: DriveAngles(PerDrive::from_fn(n, |k| 0.4 + 0.7 * k as f64)),
            qd: PerDrive::from_fn(n, |k| 1.0 - 0.9 * k as f64),
            qdd: PerDrive::from_fn(n, |k| 3.0 * k as f64 - 2.0),
        };
        let around = around(&machine, Vector::new(-2.0, 5.0));
        let bases = machine.resolved_links().iter().map(|p| p.parent.is_none().then_some(p.drive));
        assert_each_link_balances(&machine, &s, &around, &bases.collect::<Vec<_>>());
        let exact = inverse_with_wrench(&Inertia::of(&machine), &s.q.units(), &s.qd, &s.qdd, &around);
        let forces = s.forces(&machine, &around);
        close("torque", &forces.torque().expect("defined"), &exact.0, 1e-12);
        close("f_B", &xy(joints.on_base(&forces)), &xy(exact.1.total().force), 1e-12);
        // A frame keeps the first of them, and the worst of all.
        let inside = PinLoads::of(&machine).at(&s.q.units(), &s.qd, &s.qdd, &around, |_, _| 0.0);
        assert_eq!(
            (inside.pins(), inside.largest_force),
            (joints.pins().len().min(MAX_FRAME_PINS), forces.largest().0)
        );
        assert!((0..20).all(|i| inside.pin(i) == forces.get(i).filter(|_| i < MAX_FRAME_PINS)));
    }
    let many = Joints::of(&fan(5)).map(|_| ()).expect_err("35 pins");
    assert_eq!(many, JointsError::TooMany { count: 35 });
}

/// Too many closures, too few, both at once, and a drive of which nobody knows what it turns: why, and what would do.
#[test]
fn what_statics_does_not_determine_is_refused() {
    let nine = builtin("nine-link").expect("built in");
    let with = |change: &dyn Fn(&mut stillbase::mechanics::machine::MachineSpec)| {
        let mut spec = nine.spec().clone();
        change(&mut spec);
        Joints::of(&Machine::new(spec).expect("a valid machine")).map(|_| ()).expect_err("undetermined")
    };
    let missing = with(&|spec| drop(spec.closures.remove(1)));
    assert!(matches!(&missing, JointsError::Missing { closures: 2, .. }), "{missing}");
    assert!(missing.to_string().contains("nothing holds 6:") && missing.to_string().contains("want 3"), "{missing}");
    let redundant = with(&|spec| spec.closures.push(spec.closures[1].clone()));
    assert!(matches!(redundant, JointsError::Redundant { closures: 4, links: 6, .. }), "{redundant}");
    assert!(redundant.to_string().contains("want 3"), "{redundant}");
    let misplaced = with(&|spec| spec.closures[2] = spec.closures[1].clone());
    assert!(matches!(&misplaced, JointsError::Misplaced { .. }), "{misplaced}");
    assert!(misplaced.to_string().contains("6-7"), "{misplaced}");
    let two = ARM.replace(
        "[end_effector]",
        "[[link]]\nname = \"hand\"\ndrive = \"b\"\nattach = { link = \"fore\" }\n\
        length = 0.1\nmass = 0.1\ninertia = 0.01\ncom = 0.05\n[end_effector]",
    );
    let unattached = Joints::of(&parse(&two, "arm").expect("valid")).map(|_| ()).expect_err("which one");
    assert!(matches!(&unattached, JointsError::Unattached { drive, .. } if drive == "b"), "{unattached}");
    for error in [missing, redundant, misplaced, unattached] {
        assert!(error.to_string().contains("want"), "{error}");
    }
}

/// Forces balance and yet the base is tilted: a couple, the same about every height.
#[test]
fn a_force_balanced_machine_may_tilt_its_base() {
    let machine = builtin("nine-link").expect("built in");
    let s = State::new([1.6, 3.9, 2.5], [-0.3, 0.9, 1.7], [-1.0, 2.0, 4.0]);
    let none = ExternalLoads::default();
    assert!(AxialMoments::of(machine).is_flat());
    assert_eq!(AxialMoments::of(machine).tilt(&s.q.units(), &s.qd, &s.qdd, &none).total(), Vector::default());
    // All at one height: nothing either.
    let raised: Vec<(String, String)> = (1..=9).map(|j| (format!("link.{j}.axial"), "0.03".into())).collect();
    let raised = machine.set_all(raised.iter().map(|(k, v)| (k.as_str(), v.as_str()))).expect("valid");
    let axial = AxialMoments::of(&raised);
    assert!(!axial.is_flat() && axial.residual() < 1e-12);
    assert!(axial.tilt(&s.q.units(), &s.qd, &s.qdd, &none).total().norm() < 1e-12);
    // A storey for each drive: a couple, although f_B = 0.
    let storeys: Vec<(String, String)> = (0..9)
        .map(|j| (format!("link.{}.axial", j + 1), format!("{}", 0.02 * machine.resolved_links()[j].drive as f64)))
        .collect();
    let storeys = machine.set_all(storeys.iter().map(|(k, v)| (k.as_str(), v.as_str()))).expect("valid");
    let axial = AxialMoments::of(&storeys);
    let tilt = axial.tilt(&s.q.units(), &s.qd, &s.qdd, &none).total();
    assert!(tilt.norm() > 0.01 && axial.residual() > 1e-4, "{tilt}");
    close("all of it a couple", &xy(axial.couple(&s.q.units(), &s.qd, &s.qdd)), &xy(tilt), 1e-12);
}

/// What a frame keeps is what the joints say, also for machines they say nothing of.
#[test]
fn a_frame_keeps_what_the_joints_say() {
    let machine = builtin("nine-link").expect("built in").set("link.5.axial", "0.02").expect("valid");
    let s = State::new([1.6, 3.9, 2.5], [-0.3, 0.9, 1.7], [-1.0, 2.0, 4.0]);
    let around = ExternalLoads { gravity: Vector::new(0.0, -9.81), force: Vector::default() };
    let see = |machine: &Machine, s: &State| PinLoads::of(machine).at(&s.q.units(), &s.qd, &s.qdd, &around, |_, _| 0.0);
    let (inside, forces) = (see(&machine, &s), s.forces(&machine, &around));
    assert_eq!(inside.pins(), 12);
    for i in 0..MAX_FRAME_PINS {
        assert_eq!(inside.pin(i), forces.get(i));
        assert!(inside.size(i) <= inside.largest_force);
    }
    assert_eq!((inside.largest_force, inside.worst_pin()), (forces.largest().0, Some(forces.largest().1)));
    let flat = see(&machine, &State::new([1.6, 3.9, 1.6], [-0.3, 0.9, 1.7], [-1.0, 2.0, 4.0]));
    assert!(flat.pin(0).is_none() && flat.pin(1).is_some() && flat.size(0).is_finite() && flat.largest_force > 1e6);
    let mut spec = machine.spec().clone();
    spec.closures.pop();
    let open = see(&Machine::new(spec).expect("valid"), &s);
    assert_eq!(open.tilt, inside.tilt);
    assert_eq!((open.pins(), open.worst_pin(), open.largest_force), (0, None, 0.0));
    // A session holds 180,000 frames.
    assert!(size_of::<InternalLoads>() <= 320, "{} bytes", size_of::<InternalLoads>());
}

#[test]
fn a_run_keeps_peak_time_and_mean() {
    let mut peak = PinPeak::default();
    for (t, f) in [(0.0, Some(3.0)), (0.1, Some(-5.0)), (0.2, None), (0.3, Some(4.0))] {
        peak.include(t, f.map(|x| Vector::new(0.0, x)));
    }
    assert_eq!(peak, PinPeak { force: 5.0, time: 0.1, mean: 4.0, defined: 3, undefined: 1 });
}

#[test]
fn angles_of_parallelograms_fold_at_a_right_angle() {
    let joints = Joints::of(builtin("nine-link").expect("built in")).expect("determinate");
    let angle = |q: [f64; 3]| joints.parallelograms()[0].angle(&q);
    for (q2, want) in [(0.4, 0.4), (2.0, PI - 2.0), (-0.4, 0.4), (PI + 0.3, 0.3), (9.0 * PI - 0.2, 0.2)] {
        assert!((angle([0.0, q2, 1.0]) - want).abs() < 1e-12, "{q2}");
    }
    let still = PerDrive::zeros(3);
    assert_eq!(next_change_point(&[0.0, 1.0, 2.0], &still), None);
    assert_eq!(nearest_change_point(&[0.0], &PerDrive::zeros(1)), None);
    let least = nearest_change_point(&[0.0, 1.0, 3.0], &PerDrive::from([0.0, 0.0, 0.5])).expect("pairs");
    assert_eq!(least.drives, (0, 2));
    assert!(
        (least.distance - (PI - 3.0)).abs() < 1e-12 && (least.time.expect("towards") - 2.0 * (PI - 3.0)).abs() < 1e-12
    );
}
