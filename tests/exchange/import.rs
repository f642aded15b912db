//! Machines from other programs: what goes out comes back as the same machine, arms as others write them come in as what
//! textbooks say, and all else is refused by name.

use stillbase::exchange::cut::Cut;
use stillbase::exchange::import::{ImportedMachine, faults, import};
use stillbase::exchange::mjcf::{middle, mjcf};
use stillbase::exchange::urdf::urdf;
use stillbase::mechanics::dynamics::mass_matrix;
use stillbase::mechanics::machine::{Counterweight, Inertia, Machine, builtin, builtins, place_of};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, UnitVectors, Vector};

use super::arms::{THREE, TWO};
use crate::support::Noise;
use crate::support::random::{a_chain, a_machine};

pub fn machines() -> Vec<Machine> {
    let mut noise = Noise::of(11);
    let mut machines: Vec<Machine> = builtins().to_vec();
    for machine in builtins() {
        let mut spec = machine.spec().clone();
        spec.gravity = [0.3, -9.7];
        spec.payload = toml::from_str("mass = 0.4\ninertia = 0.003\noffset = [0.03, -0.02]").expect("a payload");
        let link = spec.links[0].name.clone();
        spec.counterweights.push(Counterweight {
            link,
            mass: 1.5,
            at: -0.1,
            across: 0.0,
            radius: 0.05,
            ..Default::default()
        });
        machines.push(Machine::new(spec).expect("a machine"));
    }
    machines.extend((0..60).map(|_| a_machine(&mut noise)));
    machines.extend((0..24).map(|i| a_chain(&mut noise, 1 + i % 8)));
    machines
}

/// The drive of another machine that has the name of drive k.
fn same_drive(machine: &Machine, k: usize, other: &Machine) -> usize {
    let name = &machine.spec().drives[k].name;
    let known = other.spec().drives.iter().position(|drive| drive.name == *name);
    known.unwrap_or_else(|| panic!("{}: no drive {name}", machine.name()))
}

#[track_caller]
fn near(what: &str, got: f64, want: f64, scale: f64) {
    assert!((got - want).abs() <= 1e-9 * scale, "{what}: {got}, want {want}");
}

#[track_caller]
fn near_point(what: &str, got: Vector, want: Vector) {
    assert!((got - want).norm() <= 1e-9 * (1.0 + want.norm()), "{what}: {got}, want {want}");
}

/// Centre of mass of a link, m.
fn com(machine: &Machine, j: usize, e: &UnitVectors) -> Vector {
    machine.com_chain(j).iter().zip(e).map(|(a, e)| a * *e).sum()
}

/// Both have the same mass matrix, momentum and places, in poses that are `pose` of the one where the other is at `at`.
pub fn same(machine: &Machine, found: &ImportedMachine, at: &[f64], noise: &mut Noise, is_urdf: bool) {
    let (n, other, name) = (machine.drives(), &found.machine, machine.name());
    assert_eq!(other.drives(), n, "{name}");
    for (k, at) in at.iter().enumerate().take(n) {
        assert_eq!(same_drive(machine, k, other), k, "{name}: the order of the drives");
        // Up to whole turns.
        let off = Vector::from_polar(1.0, found.pose[k]) - Vector::from_polar(1.0, *at);
        assert!(off.norm() < 1e-9, "{name}: drive {k} is at {} rad, was at {at}", found.pose[k]);
    }
    let parts = machine.resolved_links();
    // Of two links of one drive that are pinned together URDF makes one.
    let on = |j: usize| parts[j].parent.filter(|parent| is_urdf && parts[*parent].drive == parts[j].drive);
    let merged: Vec<usize> = (0..parts.len()).filter(|j| on(*j).is_some()).collect();
    let is_changed = |j: usize| merged.iter().any(|i| on(*i) == Some(j)) || merged.contains(&j);
    assert_eq!(other.links().len() + merged.len(), machine.links().len(), "{name}");
    near(&format!("{name}: mass"), other.mass(), machine.mass(), machine.mass());
    let drives: Vec<usize> = (0..n).map(|k| same_drive(machine, k, other)).collect();
    let (own, theirs) = (Inertia::of(machine), Inertia::of(other));
    let scale = (0..n).map(|k| own.diagonal(k)).fold(0.0, f64::max);
    for k in 0..n {
        near(&format!("{name}: D {k}"), theirs.momentum(drives[k]), own.momentum(k), scale);
        let on = machine.motors().on(k).map(|on| drives[on]);
        assert_eq!(other.motors().on(drives[k]), on, "{name}: where motor {k} sits");
        assert_eq!(other.spec().drives[drives[k]].torque_limit, machine.spec().drives[k].torque_limit, "{name}");
    }
    for _ in 0..4 {
        let q = PerDrive::from_fn(n, |_| noise.between(-3.0, 3.0));
        let mut turned = q;
        for k in 0..n {
            turned[drives[k]] = found.pose[drives[k]] + q[k] - at[k];
        }
        let (e, f) = (DriveAngles(q).units(), DriveAngles(turned).units());
        let still = PerDrive::from_fn(n, |_| 0.0);
        let ((h, _), (g, _)) = (mass_matrix(&own, &e, &still), mass_matrix(&theirs, &f, &still));
        for (k, l) in (0..n).flat_map(|k| (0..n).map(move |l| (k, l))) {
            near(&format!("{name}: H {k} {l}"), g.get(drives[k], drives[l]), h.get(k, l), scale);
        }
        near_point(
            &format!("{name}: end effector"),
            place_of(other.end_effector(), &f),
            place_of(machine.end_effector(), &e),
        );
        for (j, link) in machine.links().iter().enumerate().filter(|(j, _)| !is_changed(*j)) {
            let known = other.links().iter().position(|other| other.name == link.name);
            let i = known.unwrap_or_else(|| panic!("{name}: no link {}", link.name));
            let root = |machine: &Machine, j: usize, e: &UnitVectors| place_of(&machine.resolved_links()[j].root, e);
            near_point(&format!("{name}: root of {}", link.name), root(other, i, &f), root(machine, j, &e));
            // A payload comes back as part of what holds it.
            if machine.end_link() != j || machine.spec().payload.mass == 0.0 {
                near_point(&format!("{name}: link {}", link.name), com(other, i, &f), com(machine, j, &e));
            }
        }
    }
}

#[test]
fn what_goes_out_as_urdf_comes_back() {
    let mut noise = Noise::of(12);
    for machine in machines() {
        let text = urdf(&machine, None, &Cut::default());
        let found = import(&text).unwrap_or_else(|why| panic!("{}: {why}\n{text}", machine.name()));
        same(&machine, &found, &vec![0.0; machine.drives()], &mut noise, true);
    }
}

#[test]
fn what_goes_out_as_mjcf_comes_back_with_its_loops() {
    let mut noise = Noise::of(13);
    for machine in machines() {
        let at = middle(&machine);
        let text = mjcf(&machine, None, &at, &Cut::default()).expect("a model");
        let found = import(&text).unwrap_or_else(|why| panic!("{}: {why}\n{text}", machine.name()));
        same(&machine, &found, &at, &mut noise, false);
        assert_eq!(found.machine.spec().gravity, machine.spec().gravity);
        if builtin(machine.name()).is_some() {
            assert_eq!(found.machine.loops().len(), machine.loops().len(), "{}", machine.name());
            assert_eq!(found.machine.angles().len(), machine.angles().len(), "{}", machine.name());
        }
    }
}

/// Limits of angles come back in the same poses.
#[test]
fn limits_come_back() {
    for (name, text) in [("nine-link", true), ("serial-3r", true), ("serial-3r", false), ("scara", false)] {
        let machine = builtin(name).expect("built in");
        let at = if text { middle(machine) } else { vec![0.0; machine.drives()] };
        let text = if text {
            mjcf(machine, None, &at, &Cut::default()).expect("a model")
        } else {
            urdf(machine, None, &Cut::default())
        };
        let found = import(&text).expect("a machine");
        assert_eq!(found.machine.angles().len(), machine.angles().len(), "{name}");
        for (own, other) in machine.angles().iter().zip(found.machine.angles()) {
            // How far each is from its limits in the pose of the file.
            let left = |machine: &Machine, angle: &stillbase::mechanics::machine::RelativeAngle, q: &[f64]| {
                let _ = machine;
                let a = q[angle.to] - q[angle.from] + angle.offset;
                [a - angle.limits.start(), angle.limits.end() - a]
            };
            let (want, got) = (left(machine, own, &at), left(&found.machine, other, &found.pose));
            // An angle that is counted the other way has its limits the other way round.
            let turned = [got[1], got[0]];
            let is_near = |got: [f64; 2]| got.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(is_near(got) || is_near(turned), "{name}: {got:?}, want {want:?}");
        }
    }
}

/// What a model does not leave out by its list comes back equal, for the machines that come along and random ones.
#[test]
fn what_is_not_listed_comes_back() {
    use stillbase::exchange::form::{Exported, Form};
    let mut noise = Noise::of(21);
    let mut all = machines();
    all.extend((0..100).map(|i| if i % 2 == 0 { a_machine(&mut noise) } else { a_chain(&mut noise, 1 + i / 2 % 8) }));
    for machine in all {
        for ending in ["urdf", "xml"] {
            let form = Form::of(ending).expect("a format");
            let pose = if ending == "xml" { middle(&machine) } else { vec![0.0; machine.drives()] };
            let text = form
                .written(&Exported { machine: &machine, base: None, pose: &pose, cut: &Cut::default() })
                .expect("a model")
                .text();
            let list = form.left_out(&machine);
            let lists = |words: &str| list.iter().any(|what| what.contains(words));
            let back = import(&text).unwrap_or_else(|why| panic!("{}: {why}", machine.name())).machine;
            let (own, other, of) = (machine.spec(), back.spec(), format!("{} as {ending}: {list:?}", machine.name()));
            assert!(other.name == own.name && other.gravity == own.gravity, "{of}");
            assert_eq!(other.summary == own.summary, !lists("summary"), "{of}");
            assert_eq!(other.parts == own.parts && other.lumps == own.lumps, !lists("lump"), "{of}");
            assert_eq!(other.counterweights == own.counterweights, !lists("counterweight"), "{of}");
            assert_eq!(other.payload == own.payload, !lists("payload"), "{of}");
            if !lists("named lengths") {
                assert_eq!(other.lengths.is_empty(), own.lengths.is_empty(), "{of}");
            }
            for (drive, own) in other.drives.iter().zip(&own.drives) {
                assert!((&drive.name, &drive.on) == (&own.name, &own.on), "{of}");
                assert_eq!(drive.torque_limit, own.torque_limit, "{of}");
                if !lists("limits of rate") {
                    let limits =
                        |d: &stillbase::mechanics::machine::Drive| (d.speed_limit, d.acceleration_limit, d.jerk_limit);
                    assert_eq!(limits(drive), limits(own), "{of}");
                }
                if !lists("rotor and gear") {
                    let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
                    let (a, b) = (drive.rotor.unwrap_or_default(), own.rotor.unwrap_or_default());
                    assert!(is_near(a.inertia, b.inertia) && is_near(a.ratio, b.ratio), "{of}: {a:?} {b:?}");
                }
            }
            if lists("pin of link") || (ending == "xml" && lists("pins that close loops")) {
                continue;
            }
            assert_eq!(other.links.len(), own.links.len(), "{of}");
            for (j, link) in machine.links().iter().enumerate() {
                let i = back.links().iter().position(|other| other.name == link.name).expect("its name");
                let length = |machine: &Machine, j: usize| machine.resolved_links()[j].length;
                let names = list.iter().find_map(|what| what.strip_prefix("length of link ")).unwrap_or_default();
                let is_listed = names.split(':').next().unwrap_or_default().split(", ").any(|name| name == link.name);
                let is_near = (length(&back, i) - length(&machine, j)).abs() < 1e-9;
                assert!(is_near || is_listed, "{of}: link {}: {} {}", link.name, length(&back, i), length(&machine, j));
            }
        }
    }
}

/// Belts: a link that a belt holds at the angle of a joint on the base has that joint's drive; other ratios are said to
/// be none, with what would do.
#[test]
fn belts_come_in_as_drives_of_the_base() {
    let model = |multiplier: &str| {
        let link = |name: &str| {
            format!(
                "<link name=\"{name}\"><inertial><origin xyz=\"0.2 0 0\"/><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" \
                 izz=\"0.1\"/></inertial></link>"
            )
        };
        let joint = |name: &str, parent: &str, child: &str, mimic: &str| {
            format!(
                "<joint name=\"{name}\" type=\"continuous\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
                 <origin xyz=\"{} 0 0\"/><axis xyz=\"0 0 1\"/>{mimic}</joint>",
                if parent == "base" { 0.0 } else { 0.4 }
            )
        };
        // The belt turns the distant link back by what its carrier turns, and forth by what its pulley at the base does.
        let mimic = format!("<mimic joint=\"upper\" multiplier=\"{multiplier}\"/>");
        format!(
            "<robot name=\"belted\"><link name=\"base\"/>{}{}<link name=\"tool\"/>{}{}\
             <joint name=\"t\" type=\"fixed\"><parent link=\"b\"/><child link=\"tool\"/><origin xyz=\"0.4 0 0\"/></joint>\
             <transmission name=\"x\"><actuator name=\"m\"><mechanicalReduction>3</mechanicalReduction></actuator></transmission>\
             </robot>",
            link("a"),
            link("b"),
            joint("upper", "base", "a", ""),
            joint("fore", "a", "b", &mimic)
        )
    };
    let why = import(&model("0.5")).expect_err("a belt of another ratio").to_string();
    assert!(why.contains("a belt from the base") && why.contains("multiplier 1 or -1"), "{why}");
    let free = model("1").replace("<mimic joint=\"upper\" multiplier=\"1\"/>", "");
    let found = import(&free).expect("two motors");
    assert_eq!(found.machine.drives(), 2);
    assert!(found.notes.iter().any(|note| note.contains("reductions of transmissions")), "{:?}", found.notes);
}

#[test]
fn a_thousand_machines_go_out_and_come_back() {
    let mut noise = Noise::of(16);
    for i in 0..1000 {
        let machine = if i % 2 == 0 { a_machine(&mut noise) } else { a_chain(&mut noise, 1 + i / 2 % 8) };
        let at: Vec<f64> = (0..machine.drives()).map(|_| noise.between(-3.0, 3.0)).collect();
        let found = import(&urdf(&machine, None, &Cut::default())).unwrap_or_else(|why| panic!("{i}: {why}"));
        same(&machine, &found, &vec![0.0; machine.drives()], &mut noise, true);
        let found = import(&mjcf(&machine, None, &at, &Cut::default()).expect("a model"))
            .unwrap_or_else(|why| panic!("{i}: {why}"));
        same(&machine, &found, &at, &mut noise, false);
    }
}

/// What all limits leave on either side in a pose, in rising order.
fn room(machine: &Machine, q: &[f64]) -> Vec<f64> {
    let of = |angle: &stillbase::mechanics::machine::RelativeAngle| {
        let a = q[angle.to] - q[angle.from] + angle.offset;
        [a - angle.limits.start(), angle.limits.end() - a]
    };
    let mut all: Vec<f64> = machine.angles().iter().flat_map(of).filter(|x| x.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// Limits between any two drives, of accelerations and jerk, and names and offsets of angles as far as a format goes.
#[test]
fn all_limits_come_back() {
    let mut noise = Noise::of(15);
    for number in 0..40 {
        let machine = if number % 2 == 0 { a_machine(&mut noise) } else { a_chain(&mut noise, 2 + number / 2 % 7) };
        let (mut spec, n) = (machine.spec().clone(), machine.drives());
        for i in 0..(if n > 1 { 5 } else { 0 }) {
            let [to, from] = [0; 2].map(|_| noise.between(0.0, n as f64 - 1e-9) as usize);
            let (low, width) = (noise.between(-6.0, 2.0), noise.between(0.5, 9.0));
            let name = |k: usize| spec.drives[k].name.clone();
            let angle = stillbase::mechanics::machine::Angle {
                name: format!("of pair {i}"),
                to: name(to),
                from: name(if from == to { (from + 1) % n } else { from }),
                offset: noise.between(-3.0, 3.0),
                min: Some(low),
                max: Some(low + width),
            };
            spec.angles.push(angle);
        }
        spec.drives[0].acceleration_limit = Some(30.0);
        spec.drives[n - 1].jerk_limit = Some(400.0);
        spec.drives[n - 1].torque_limit = Some(7.0);
        let machine = Machine::new(spec).expect("a machine");
        let at: Vec<f64> = (0..n).map(|_| noise.between(-3.0, 3.0)).collect();
        for is_urdf in [true, false] {
            let text = if is_urdf {
                urdf(&machine, None, &Cut::default())
            } else {
                mjcf(&machine, None, &at, &Cut::default()).expect("a model")
            };
            let found = import(&text).unwrap_or_else(|why| panic!("{why}\n{text}"));
            let from = if is_urdf { vec![0.0; n] } else { at.clone() };
            for _ in 0..3 {
                let q: Vec<f64> = (0..n).map(|_| noise.between(-3.0, 3.0)).collect();
                let turned: Vec<f64> = (0..n).map(|k| found.pose[k] + q[k] - from[k]).collect();
                let (want, got) = (room(&machine, &q), room(&found.machine, &turned));
                let is_near = want.len() == got.len() && want.iter().zip(&got).all(|(a, b)| (a - b).abs() < 1e-9);
                assert!(is_near, "{got:?}, want {want:?}\n{text}");
            }
            if is_urdf {
                assert_eq!(found.machine.spec().drives, machine.spec().drives, "{text}");
                let named = |machine: &Machine| {
                    let mut all: Vec<_> = machine.spec().angles.iter().map(|angle| angle.name.clone()).collect();
                    all.sort();
                    all
                };
                let names = named(&machine);
                assert!(names.iter().all(|name| named(&found.machine).contains(name)), "{text}");
            }
        }
    }
}

/// Joints have one name in both formats, and so have bodies and motors.
#[test]
fn joints_have_one_name() {
    for machine in machines() {
        let at = middle(&machine);
        let texts =
            [urdf(&machine, None, &Cut::default()), mjcf(&machine, None, &at, &Cut::default()).expect("a model")];
        let documents = texts.each_ref().map(|text| roxmltree::Document::parse(text).expect("XML"));
        let joints = documents[0].root_element().children().filter(|node| node.has_tag_name("joint"));
        let names: Vec<&str> = joints.filter_map(|node| node.attribute("name")).collect();
        let hinges = documents[1].descendants().filter(|node| node.has_tag_name("body"));
        for body in hinges {
            let Some(hinge) = body.children().find(|node| node.has_tag_name("joint")) else { continue };
            let (hinge, body) = (hinge.attribute("name").expect("a name"), body.attribute("name").expect("a name"));
            assert!(names.contains(&hinge), "{}: {hinge} of {body}\n{}", machine.name(), texts[0]);
            assert!(texts[0].contains(&format!("<link name=\"{}\">", body.replace('"', "&quot;"))), "{body}");
        }
        let motors = documents[1].descendants().filter(|node| node.has_tag_name("motor"));
        for motor in motors {
            assert!(names.contains(&motor.attribute("name").expect("a name")), "{}", machine.name());
        }
    }
}

/// A URDF with a base that weighs something: that is no part of a machine, and goes into a scenario.
#[test]
fn the_base_comes_along_beside_the_machine() {
    let bare = import(TWO).expect("an arm");
    assert_eq!(bare.base, None);
    let inertial = |at: &str, mass: f64, izz: f64| {
        let inertia = format!("<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"{izz}\"/>");
        format!("<inertial><origin xyz=\"{at}\"/><mass value=\"{mass}\"/>{inertia}</inertial>")
    };
    let base = format!("<link name=\"world\">{}</link>", inertial("0.1 -0.2 0.5", 30.0, 2.0));
    let box_of = format!(
        "{base}<link name=\"box\">{}</link><joint name=\"holds\" type=\"fixed\"><parent link=\"world\"/>\
         <child link=\"box\"/><origin xyz=\"1 0 0\"/></joint>",
        inertial("0 0.4 0", 10.0, 0.5)
    );
    let text = TWO.replacen("<link name=\"world\"/>", &box_of, 1);
    // The shoulder is at 0.2, 0.05 of the base.
    let text = text.replacen("<origin xyz=\"0 0 0.1\" rpy=\"0 0 0\"/>", "<origin xyz=\"0.2 0.05 0.1\"/>", 1);
    let found = import(&text).expect("an arm");
    let base = found.base.expect("a base");
    near("the machine is the same", found.machine.reach(), bare.machine.reach(), 1.0);
    assert_eq!(found.machine.spec().drives, bare.machine.spec().drives);
    near("mass", base.mass, 40.0, 1.0);
    let com = Vector::new((30.0 * 0.1 + 10.0 * 1.0) / 40.0, (30.0 * -0.2 + 10.0 * 0.4) / 40.0);
    near_point("centre of mass", base.com, com - Vector::new(0.2, 0.05));
    let away = 30.0 * (Vector::new(0.1, -0.2) - com).norm_sqr() + 10.0 * (Vector::new(1.0, 0.4) - com).norm_sqr();
    near("inertia", base.inertia, 2.5 + away, 1.0);
}

/// The mass matrix of every textbook, in relative angles, of two links that someone else has written down.
#[test]
fn an_arm_of_two_links_is_that_of_the_textbook() {
    let found = import(TWO).expect("an arm");
    let machine = &found.machine;
    assert_eq!((machine.drives(), machine.links().len()), (2, 2));
    assert_eq!(machine.motors().on(1), Some(0), "the motor of the elbow sits on the upper arm");
    let (l1, c1, c2, m1, m2, i1, i2) = (0.4, 0.18, 0.15, 2.5, 1.5, 0.04, 0.02);
    for elbow in [0.0, 0.7, -2.1] {
        let m22 = i2 + m2 * c2 * c2;
        let m12 = m22 + m2 * l1 * c2 * f64::cos(elbow);
        let m11 = i1 + m1 * c1 * c1 + m2 * l1 * l1 + 2.0 * m12 - m22;
        let q = PerDrive::from_fn(2, |k| found.pose[k] + 0.3 + if k == 1 { elbow } else { 0.0 });
        let still = PerDrive::from_fn(2, |_| 0.0);
        let (h, _) = mass_matrix(&Inertia::of(machine), &DriveAngles(q).units(), &still);
        // θ = (q_1, q_2 − q_1).
        near("M22", h.get(1, 1), m22, m11);
        near("M12", h.get(1, 1) + h.get(0, 1), m12, m11);
        near("M11", h.get(0, 0) + 2.0 * h.get(0, 1) + h.get(1, 1), m11, m11);
    }
    let spec = machine.spec();
    assert_eq!((spec.drives[0].torque_limit, spec.drives[1].speed_limit), (Some(40.0), Some(3.0)));
    assert_eq!(spec.angles.len(), 1, "that of the shoulder is against the base");
    assert_eq!(found.notes.len(), 2, "{:?}", found.notes);
}

/// An arm in a vertical plane, with a rotor and a link that is not along x.
#[test]
fn axes_may_lie_along_any_direction() {
    let found = import(THREE).expect("an arm");
    assert_eq!(found.machine.drives(), 3);
    let rotor = found.machine.spec().drives[1].rotor.expect("a rotor");
    assert_eq!((rotor.inertia, rotor.ratio), (1e-5, 80.0));
    // What the rotor weighs belongs to the link that carries it.
    near("mass", found.machine.mass(), 3.0 + 2.0 + 1.0 + 0.2, 1.0);
    let tip =
        place_of(found.machine.end_effector(), &DriveAngles(PerDrive::from_slice(&found.pose).expect("three")).units());
    // Of the file: 0.45 and 0.3 along x, and 0.25 above the shoulder.
    near("reach", tip.norm(), 0.75_f64.hypot(0.25), 1.0);
}

/// A file with something changed, and the words of the refusal.
#[test]
fn what_is_outside_of_the_family_is_refused_by_name() {
    for (from, to, words) in [
        ("type=\"revolute\"", "type=\"prismatic\"", ["line 14: joint \"shoulder\"", "revolute, continuous or fixed"]),
        (
            "name=\"elbow\" type=\"revolute\"",
            "name=\"elbow\" type=\"floating\"",
            ["joint \"elbow\"", "type \"floating\""],
        ),
        (
            "<axis xyz=\"0 0 1\"/>\n    <limit lower=\"-2.5\"",
            "<axis xyz=\"0 1 0\"/>\n    <limit lower=\"-2.5\"",
            ["link \"forearm\"", "all parallel"],
        ),
        ("<mass value=\"2.5\"/>", "<mass value=\"-2.5\"/>", ["<mass>", "-2.5 kg"]),
        ("<mass value=\"2.5\"/>", "<mass value=\"NaN\"/>", ["<mass>", "numbers from"]),
        ("<mass value=\"2.5\"/>", "<mass value=\"1e300\"/>", ["<mass>", "numbers from"]),
        ("<mass value=\"2.5\"/>", "", ["link \"upper_arm\"", "no <mass>"]),
        ("<child link=\"forearm\"/>", "<child link=\"foream\"/>", ["<child>", "no link \"foream\""]),
        ("<child link=\"forearm\"/>", "<child link=\"upper_arm\"/>", ["joint \"elbow\"", "a second joint"]),
        ("name=\"tool0\"", "name=\"forearm\"", ["link \"forearm\"", "each name once"]),
        ("<origin xyz=\"0.4 0 0\"/>", "<origin xyz=\"0.4 0 0 1\"/>", ["<origin>", "4 numbers: want 3"]),
        ("lower=\"-2.5\"", "lower=\"9.5\"", ["joint \"elbow\"", "lower not above upper"]),
        ("izz=\"0.04\"", "izz=\"-0.04\"", ["link \"upper_arm\"", "not below 0"]),
        (
            "<robot name=\"two\">",
            "<robot name=\"two\" xmlns:xacro=\"http://x\"><xacro:include filename=\"a\"/>",
            ["<include>", "plain URDF"],
        ),
        (
            "<robot name=\"two\">",
            "<robot name=\"two\"><link name=\"loose\"/>",
            ["link \"loose\"", "no joint carries it"],
        ),
        ("<robot name=\"two\">", "<sdf><robot name=\"two\">", ["", "XML"]),
    ] {
        assert!(TWO.contains(from), "{from}");
        let why = import(&TWO.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(words.iter().all(|word| why.contains(word)), "{to}: {why}");
    }
    let missing =
        TWO.split("<inertial>").next().expect("a start").to_owned() + TWO.split_once("</inertial>").expect("one").1;
    let why = import(&missing).expect_err("no inertial").to_string();
    assert!(why.contains("link \"upper_arm\": it turns and has no <inertial>"), "{why}");
    let ends = TWO.find("<link name=\"tool0\">").expect("a tool");
    let bare = TWO[..ends].to_owned() + "</robot>";
    let why = import(&bare).expect_err("no end").to_string();
    assert!(why.contains("where the end effector is") && why.contains("want a link end_effector"), "{why}");
    assert!(import("<sdf/>").expect_err("no robot").to_string().contains("<robot> of URDF or <mujoco> of MJCF"));
}

#[test]
fn what_mjcf_has_besides_is_refused_by_name() {
    let machine = builtin("nine-link").expect("built in");
    let text = mjcf(machine, None, &middle(machine), &Cut::default()).expect("a model");
    for (from, to, words) in [
        (
            "<joint name=\"joint_link_1\"/>",
            "<joint name=\"joint_link_1\" type=\"slide\"/>",
            ["joint \"joint_link_1\"", "want hinges"],
        ),
        ("<joint name=\"joint_link_1\"/>", "<freejoint/>", ["<freejoint>", "floats on a body"]),
        (
            "<joint name=\"joint_link_4\"/>",
            "<joint name=\"joint_link_4\" armature=\"0.1\"/>",
            ["joint \"joint_link_4\": an armature of 0.1 kg m²", "a hinge that a motor without a rotor turns"],
        ),
        (
            "<joint name=\"joint_link_1\"/>",
            "<joint name=\"joint_link_1\" axis=\"1 0 0\"/>",
            ["turns about", "parallel"],
        ),
        ("<worldbody>", "<include file=\"a.xml\"/><worldbody>", ["<include>", "one file"]),
        (
            "<key name=\"start\" qpos=\"1.5",
            "<key name=\"start\" qpos=\"1.6",
            ["connect \"loop", "every loop is closed"],
        ),
        ("site2=\"loop 1 b\"", "site2=\"loop 1 c\"", ["connect \"loop 1\"", "no site \"loop 1 c\""]),
        (
            "<motor name=\"drive_2\" joint=\"joint_link_2\"",
            "<motor name=\"drive_2\" joint=\"joint_link_4\"",
            ["\"drive", "motor"],
        ),
        ("<connect name=\"loop 1\"", "<weld name=\"loop 1\"", ["an equality of kind \"weld\"", "connect, joint"]),
        ("<default>", "<default><default/>", ["<default>: a class without a name", "class="]),
        ("<worldbody>", "<worldbody><body childclass=\"x\"/>", ["no class \"x\"", "name of a <default>"]),
    ] {
        assert!(text.contains(from), "{from}\n{text}");
        let why = import(&text.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(words.iter().all(|word| why.contains(word)), "{to}: {why}");
    }
}

/// Meshes are decoration.
#[test]
fn meshes_are_left_out_with_a_note() {
    let found = import(TWO).expect("an arm");
    assert!(found.notes.iter().any(|note| note.contains("meshes")), "{:?}", found.notes);
}

/// What would cost the parser a time that grows with the square of the file is refused before it is parsed, by number.
#[test]
fn xml_that_is_dear_to_parse_is_refused_before() {
    let nested = |count: usize, space: &str| {
        let open: String = (0..count).map(|i| format!("<a xmlns:n{i}{space}=\"u{i}\">")).collect();
        format!("<robot name=\"x\">\n{open}{}</robot>", "</a>".repeat(count))
    };
    let many = |count: usize| {
        let all: String = (0..count).map(|i| format!(" a{i}='<>=\"'")).collect();
        format!("<robot>\n\n<link{all}/></robot>")
    };
    let deep = |count: usize| format!("<robot>{}{}</robot>", "<b c=\"/>\">".repeat(count), "</b>".repeat(count));
    for (text, words) in [
        (nested(33, ""), "line 2: <a>: 33 declarations of namespaces in the file so far: want at most 32"),
        (nested(3000, " "), "line 2: <a>: 33 declarations of namespaces in the file so far: want at most 32"),
        (many(101), "line 3: <link>: 101 attributes: want at most 100"),
        (many(40_000), "line 3: <link>: 40000 attributes: want at most 100"),
        (deep(250), "line 1: <b>: 251 levels of nested elements: want at most 250"),
        (deep(200_000), "line 1: <b>: 251 levels of nested elements: want at most 250"),
    ] {
        assert_eq!(import(&text).expect_err(words).to_string(), words);
    }
    // Up to there it is the reader of machines that refuses, and remarks and quotes hide nothing and count for nothing.
    let remark = format!("<!-- {} --><![CDATA[ {0} ]]>", "<a x=\"1\">".repeat(500));
    for text in [nested(32, ""), many(100), deep(248), format!("<robot>{remark}{}</robot>", "<b/>".repeat(1000))] {
        let why = import(&text).expect_err("no machine").to_string();
        assert!(!why.contains("at most"), "{why}");
    }
}

/// A link is as long as its farthest pin is from its root; one without a second pin reaches to the end effector.
#[test]
fn links_are_as_long_as_their_pins_are_apart() {
    let found = import(TWO).expect("an arm");
    let lengths: Vec<f64> = found.machine.resolved_links().iter().map(|part| part.length).collect();
    near("upper arm", lengths[0], 0.4, 1.0);
    near("forearm", lengths[1], 0.35, 1.0);
}

/// Axes along x of the file, so that no link lies along its own x: the machine is the one whose axes are along z.
#[test]
fn axes_may_lie_along_the_x_of_the_file() {
    // In the plane (y, z) instead of (x, y): x is z, and so on in a circle.
    let turned = TWO
        .replace("xyz=\"0.18 0 0\"", "xyz=\"0 0.18 0\"")
        .replace("xyz=\"0 0 0.1\"", "xyz=\"0.1 0 0\"")
        .replace("xyz=\"0 0 1\"", "xyz=\"1 0 0\"")
        .replace("xyz=\"0.4 0 0\"", "xyz=\"0 0.24 0.32\"")
        .replace("xyz=\"0.15 0 0\"", "xyz=\"0 0.09 0.12\"")
        .replace("xyz=\"0.35 0 0\"", "xyz=\"0 0.21 0.28\"")
        .replace("xyz=\"0 0.18 0\"", "xyz=\"0 0.108 0.144\"")
        .replace(
            "ixx=\"0.004\" ixy=\"0\" ixz=\"0\" iyy=\"0.04\" iyz=\"0\" izz=\"0.04\"",
            "ixx=\"0.04\" ixy=\"0\" ixz=\"0\" iyy=\"0.04\" iyz=\"0\" izz=\"0.004\"",
        )
        .replace(
            "ixx=\"0.002\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.02\"",
            "ixx=\"0.02\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.002\"",
        );
    let (own, other) = (import(TWO).expect("an arm"), import(&turned).expect("the same arm"));
    near("reach", other.machine.reach(), own.machine.reach(), 1.0);
    let [own, other] = [own, other].map(|found| {
        let q = PerDrive::from_fn(2, |k| found.pose[k] + if k == 1 { 0.7 } else { 0.0 });
        mass_matrix(&Inertia::of(&found.machine), &DriveAngles(q).units(), &PerDrive::from_fn(2, |_| 0.0)).0
    });
    for (k, l) in [(0, 0), (0, 1), (1, 1)] {
        near("H", other.get(k, l), own.get(k, l), own.get(0, 0));
    }
}

/// A limit from somewhere to below it is refused, one of no width and one to the left of 0 are read.
#[test]
fn limits_may_be_anywhere() {
    let limited =
        |low: f64, high: f64| TWO.replace("lower=\"-2.5\" upper=\"2.5\"", &format!("lower=\"{low}\" upper=\"{high}\""));
    for [low, high] in [[-2.0, -1.0], [0.5, 0.5], [0.3, 2.0]] {
        let found = import(&limited(low, high)).expect("an arm");
        let angle = &found.machine.angles()[0];
        near("width", angle.limits.end() - angle.limits.start(), high - low, 1.0);
        let a = found.pose[angle.to] - found.pose[angle.from] + angle.offset;
        near("below", a - angle.limits.start(), 0.0 - low, 1.0);
    }
    assert!(import(&limited(0.5, 0.4)).is_err());
    // A joint that goes round has none, whatever its file gives besides.
    let round =
        limited(-2.0, 1.0).replacen("name=\"elbow\" type=\"revolute\"", "name=\"elbow\" type=\"continuous\"", 1);
    assert!(import(&round).expect("an arm").machine.spec().angles.is_empty());
}

/// All values that are wrong or missing are told at once, each with its line; behind them nothing that might follow.
#[test]
fn all_wrong_values_of_a_model_are_told_at_once() {
    let text = "<robot name=\"arm\">\n<link name=\"base\"/>\n<link name=\"a\"><inertial>\n<origin xyz=\"0.1 0 zero\"/>\n\
                <mass value=\"-2\"/>\n<inertia ixx=\"0.01\" ixy=\"0\" ixz=\"0\" iyy=\"0.01\" iyz=\"0\" izz=\"1e99\"/>\n\
                </inertial></link>\n<joint name=\"ja\" type=\"revolute\">\n<parent link=\"base\"/>\n<child link=\"a\"/>\n\
                <origin xyz=\"0 0\"/>\n<axis xyz=\"0 0 1\"/>\n\
                <limit lower=\"-1\" upper=\"one\" effort=\"10\" velocity=\"5\"/>\n</joint>\n<link name=\"tip\"/>\n\
                <joint name=\"jt\" type=\"fixed\">\n<parent/>\n<child link=\"tip\"/>\n<origin xyz=\"0.3 0 0\"/>\n</joint>\n\
                </robot>\n";
    let first = import(text).expect_err("it has faults");
    let found = faults(text, first);
    let mut told: Vec<(usize, &str)> =
        found.list.iter().map(|fault| (fault.line.expect("a line"), fault.text.as_str())).collect();
    told.sort_unstable();
    let lines: Vec<usize> = told.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [4, 5, 6, 11, 13, 17], "{told:#?}");
    for ((_, said), part) in told.iter().zip(["zero", "-2 kg", "1e99", "xyz has 2 numbers", "one", "it has no link"]) {
        assert!(said.contains(part), "{said}: {part}");
    }
    // A single fault that no value mends is told alone.
    let other = "<robot name=\"arm\"><link name=\"base\"/></robot>";
    let alone = faults(other, import(other).expect_err("no joint"));
    assert_eq!((alone.count(), alone.is_cut), (1, false));
}
