//! Any machine of the family: motors in joints, rotors and gears, one to eight drives. Against independent software,
//! against bodies one by one, and against the laws.

use stillbase::mechanics::balance::design;
use stillbase::mechanics::dynamics::{
    ExternalLoads, angular_momentum, centre_of_mass, inverse_with_wrench, mass_matrix,
};
use stillbase::mechanics::joint_forces::Joints;
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Inertia, Machine, builtins, parse, to_toml};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};
use stillbase::session::design::DesignBrief;

use super::bodies::Bodies;
use crate::support::random::{a_chain, a_machine};
use crate::support::{Noise, close, family, family_machine, numbers, xy};

const NAMES: [&str; 5] = ["two-drive", "serial-3r", "four-drive", "nine-link-geared", "nine-link-bare"];

fn around(machine: &Machine) -> ExternalLoads {
    ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() }
}

/// Everything that is asked of a state, with gravity set by key.
fn state(what: &str, machine: &Machine, want: &serde_json::Value) {
    let gravity = numbers(&want["gravity"]);
    let machine = machine.set("gravity", &format!("{},{}", gravity[0], gravity[1])).expect("in range");
    let [q, qd, qdd] = ["q", "qd", "qdd"].map(|key| PerDrive::from_slice(&numbers(&want[key])).expect("few"));
    let inertia = Inertia::of(&machine);
    let e = DriveAngles(q).units();
    let (h, _) = mass_matrix(&inertia, &e, &qd);
    let (torque, wrench) = inverse_with_wrench(&inertia, &e, &qd, &qdd, &around(&machine));
    let n = machine.drives();
    let rows: Vec<f64> = (0..n * n).map(|i| h.get(i / n, i % n)).collect();
    let d: Vec<f64> = (0..n).map(|k| h.momentum_coefficient(k)).collect();
    let check = |field: &str, got: &[f64]| close(&format!("{what}, {field}"), got, &numbers(&want[field]), 1e-9);
    check("mass_matrix", &rows);
    check("d", &d);
    check("torque", &inertia.motors().motor_torques(&torque));
    check("base_force", &xy(wrench.total().force));
    check("base_moment", &[wrench.total().moment]);
    check("com", &xy(centre_of_mass(&inertia, &e)));
}

#[test]
fn every_state_of_the_reference_to_nine_digits() {
    let file = family();
    let mut states = 0;
    for name in NAMES {
        let of = &file["machines"][name];
        for (suffix, list) in [("", &of["states"]), ("-balanced", &of["balanced"]["states"])] {
            let machine = family_machine(&format!("{name}{suffix}"));
            for want in list.as_array().expect("states") {
                state(&format!("{name}{suffix}"), &machine, want);
                states += 1;
            }
        }
    }
    assert_eq!(states, 50);
}

/// Minimum norm finds the centres of mass of the reference, and of what it finds D is not the diagonal of H.
#[test]
fn balancing_them_gives_the_reference() {
    let file = family();
    for name in NAMES {
        let of = &file["machines"][name];
        let machine = family_machine(name);
        let balanced = design(&machine, &vec![1.0; machine.links().len()]).expect("it can be balanced");
        let com: Vec<f64> = balanced.links().iter().map(|l| l.com).collect();
        close(name, &com, &numbers(&of["minimum_norm_com"]), 1e-9);
        let (inertia, want) = (Inertia::of(&balanced), &of["balanced"]);
        close(&format!("{name}: H"), &inertia.diagonals(), &numbers(&want["h"]), 1e-9);
        close(&format!("{name}: D"), &inertia.momenta(), &numbers(&want["d"]), 1e-9);
        close(&format!("{name}: λ"), &inertia.lambda(), &numbers(&want["lambda"]), 1e-9);
        close(&format!("{name}: locked"), &[inertia.locked()], &numbers(&want["total_inertia"]), 1e-9);
    }
}

/// A state of motion at random.
fn motion(noise: &mut Noise, n: usize) -> [PerDrive; 3] {
    [3.0, 4.0, 10.0].map(|most| PerDrive::from_fn(n, |_| noise.between(-most, most)))
}

/// Random trees of bars and parallelograms, motors anywhere, geared rotors: mass matrix, torques of the motors, what
/// the base feels and momentum as of bodies one by one.
#[test]
fn random_machines_are_their_bodies() {
    let mut drives = [0; 9];
    for seed in 0..400 {
        let mut noise = Noise::of(seed);
        let machine = a_machine(&mut noise);
        as_bodies(&format!("machine {seed}"), &machine, &mut noise);
        drives[machine.drives()] += 1;
    }
    assert!(drives[1..].iter().all(|count| *count > 5), "{drives:?}");
}

#[test]
fn machines_of_the_reference_are_their_bodies() {
    let mut noise = Noise::of(1);
    for name in NAMES {
        for suffix in ["", "-balanced"] {
            let machine = family_machine(&format!("{name}{suffix}")).set("gravity", "1.5,-9.81").expect("in range");
            as_bodies(name, &machine, &mut noise);
        }
    }
}

/// Each machine that comes along, and those that are not balanced with counterweights too.
#[test]
fn machines_of_the_gallery_are_their_bodies() {
    let mut noise = Noise::of(5);
    let mut weighed = 0;
    for machine in builtins() {
        let machine = machine.set("gravity", "1.5,-9.81").expect("in range");
        as_bodies(machine.name(), &machine, &mut noise);
        let front = match DesignBrief::default().front(&machine, 2) {
            Ok(front) => front,
            // The centre of mass of its last link lies off the line on which counterweights may sit.
            Err(why) => {
                assert_eq!(machine.name(), "ets-vii", "it can be balanced: {why:?}");
                continue;
            }
        };
        for placed in front.points.iter().filter(|placed| placed.added_mass > 0.0) {
            as_bodies(&format!("{} with counterweights", machine.name()), &placed.machine, &mut noise);
            weighed += 1;
        }
    }
    // SCARA, space arm and the bare bars; Table I as printed is balanced by grams.
    assert!(weighed >= 6, "{weighed}");
}

fn as_bodies(what: &str, machine: &Machine, noise: &mut Noise) {
    let (bodies, inertia) = (Bodies::of(machine.spec()), Inertia::of(machine));
    for _ in 0..3 {
        let [q, qd, qdd] = motion(noise, machine.drives());
        let e = DriveAngles(q).units();
        let (h, _) = mass_matrix(&inertia, &e, &qd);
        let n = machine.drives();
        let rows: Vec<f64> = (0..n * n).map(|i| h.get(i / n, i % n)).collect();
        close(&format!("{what}: H"), &rows, &bodies.mass_matrix(&q), 1e-11);
        let (torque, wrench) = inverse_with_wrench(&inertia, &e, &qd, &qdd, &around(machine));
        close(
            &format!("{what}: motors"),
            &inertia.motors().motor_torques(&torque),
            &bodies.torques(&q, &qd, &qdd),
            1e-8,
        );
        let (force, moment) = bodies.wrench(&q, &qd, &qdd);
        close(&format!("{what}: f_B"), &xy(wrench.total().force), &xy(force), 1e-8);
        // Of the size of what cancels in it.
        let size = torque.iter().map(|t| t.abs()).sum::<f64>() + moment.abs();
        close(&format!("{what}: n_B"), &[wrench.total().moment, size], &[moment, size], 1e-8);
        close(&format!("{what}: com"), &xy(centre_of_mass(&inertia, &e)), &xy(bodies.com(&q)), 1e-11);
        close(&format!("{what}: tip"), &xy(end_effector(machine.end_effector(), &e)), &xy(bodies.tip(&q)), 1e-11);
        let d: f64 = (0..n).map(|k| h.momentum_coefficient(k) * qd[k]).sum();
        close(&format!("{what}: D q̇"), &[d], &[bodies.angular(&q, &qd)], 1e-10);
        close(&format!("{what}: momentum"), &[angular_momentum(&inertia, &e, &qd)], &[d], 1e-11);
        // What the motors bring is what comes into motion: power is the same in their angles and in those of drives.
        let motors = inertia.motors();
        let own = motors.motor_torques(&torque).dot(&motors.to_motors(&qd));
        close(&format!("{what}: power"), &[own], &[torque.dot(&qd)], 1e-10);
        let back = motors.generalised_torques(&motors.motor_torques(&torque));
        close(&format!("{what}: there and back"), &back, &torque, 1e-12);
    }
}

/// Balanced arms of one to eight drives, motors in joints and on the base, rotors of any gear and sense: H is constant,
/// D is what λ is taken from, and n_B = −D_1 b̈ in every motion.
#[test]
fn the_moment_of_any_motion_is_that_of_b() {
    let mut noise = Noise::of(7);
    let mut coupled = 0;
    for seed in 0..300 {
        let chain = a_chain(&mut noise, 1 + seed % 8);
        let machine = design(&chain, &vec![1.0; chain.links().len()]).expect("a chain can be balanced");
        let inertia = Inertia::of(&machine);
        assert!(inertia.is_force_balanced() && inertia.is_invariant(), "{seed}");
        let (d, lambda, n) = (inertia.pose_inertia(), inertia.lambda(), machine.drives());
        coupled += usize::from(!inertia.is_decoupled());
        for _ in 0..4 {
            let [q, qd, qdd] = motion(&mut noise, n);
            let (torque, wrench) =
                inverse_with_wrench(&inertia, &DriveAngles(q).units(), &qd, &qdd, &ExternalLoads::default());
            let want = -d * lambda.dot(&qdd);
            let size = torque.iter().map(|t| t.abs()).sum::<f64>();
            close(&format!("{seed}"), &[wrench.total().moment, size], &[want, size], 1e-9);
            // τ = H q̈, the same in every pose.
            let (h, v) = mass_matrix(&inertia, &DriveAngles(q).units(), &qd);
            close(&format!("{seed}: V"), &[v.max_abs(), size], &[0.0, size], 1e-9);
            close(&format!("{seed}: H q̈"), &h.times(&qdd), &torque, 1e-9);
        }
    }
    assert!(coupled > 100, "{coupled} with gears or motors in joints");
}

/// A drive whose rotor turns the other way, just so fast that D_k vanishes, moves without a reaction moment.
#[test]
fn a_counter_rotating_rotor_frees_its_drive() {
    let machine = family_machine("two-drive-balanced");
    let inertia = Inertia::of(&machine);
    let d = inertia.momenta();
    let settings: Vec<(String, String)> = (0..2)
        .flat_map(|k| {
            let key = |what: &str| format!("drive.{}.rotor.{what}", k + 1);
            [(key("inertia"), (d[k] / 20.0).to_string()), (key("ratio"), "-20".to_owned())]
        })
        .collect();
    let free = machine.set_all(settings.iter().map(|(k, v)| (k.as_str(), v.as_str()))).expect("in range");
    let inertia = Inertia::of(&free);
    assert_eq!(inertia.momenta().max_abs(), 0.0);
    assert_eq!(inertia.pose_inertia(), 0.0);
    assert_eq!(inertia.lambda().max_abs(), 0.0);
    let mut noise = Noise::of(3);
    for _ in 0..50 {
        let [q, qd, qdd] = motion(&mut noise, 2);
        let (torque, wrench) =
            inverse_with_wrench(&inertia, &DriveAngles(q).units(), &qd, &qdd, &ExternalLoads::default());
        assert!(wrench.total().moment.abs() < 1e-12 * torque.iter().map(|t| t.abs()).sum::<f64>());
        assert!(torque.max_abs() > 0.1, "its rotors are turned all the same");
    }
}

/// What the motors give, found from the forces of the pins one by one, is what Lagrange's equations give: motors lean
/// on the links that carry them, also on links of a loop, and rotors take their part.
#[test]
fn pins_and_motors_agree() {
    let mut noise = Noise::of(31);
    let mut machines: Vec<Machine> = (0..60).map(|i| a_chain(&mut noise, 1 + i % 8)).collect();
    machines.extend(NAMES.iter().map(|name| family_machine(name)));
    let mut on_loops = 0;
    for machine in machines {
        let joints = Joints::of(&machine).expect("statics determines the forces");
        let machine = machine.set("gravity", "1.0,-9.81").expect("in range");
        let inertia = Inertia::of(&machine);
        let [q, qd, qdd] = motion(&mut noise, machine.drives());
        let e = DriveAngles(q).units();
        let (torque, wrench) = inverse_with_wrench(&inertia, &e, &qd, &qdd, &around(&machine));
        let forces = joints.forces(&e, &qd, &qdd, &around(&machine));
        let found = forces.torque().expect("not flat");
        close(machine.name(), &found, &inertia.motors().motor_torques(&torque), 1e-8);
        close(machine.name(), &xy(joints.on_base(&forces)), &xy(wrench.total().force), 1e-8);
        on_loops += usize::from(machine.name() == "four-drive");
    }
    assert_eq!(on_loops, 1);
}

/// What is wrong with motors is named, with what would be right.
#[test]
fn wrong_motors_are_named() {
    let text = include_str!("../reference/family/serial-3r.toml");
    for (from, to, said) in [
        ("on = \"1\"", "on = \"3\"", "(drive.2.on): the motor of drive \"2\" sits on itself (2 on 3 on 2)"),
        ("on = \"1\"", "on = \"2\"", "sits on itself (2 on 2)"),
        ("on = \"1\"", "on = \"7\"", "names the drive \"7\", which does not exist"),
        ("ratio = -30.0", "ratio = 0", "want a gear ratio other than 0"),
        ("ratio = -30.0", "ratio = 1e9", "drive.2.rotor.ratio"),
        ("inertia = 8.0e-5", "inertia = -1.0", "drive.2.rotor.inertia"),
        ("max = -0.2", "", "angle \"a1\" has only one limit"),
        ("[end_effector]", "[[end_effector]]", "1 end effectors: want one"),
    ] {
        let error = parse(&text.replacen(from, to, 1), "arm.toml").expect_err(to).to_string();
        assert!(error.starts_with("arm.toml") && error.contains(said), "{to}: {error}");
    }
    // Eight drives are a machine, nine are not.
    let drives: String = (4..=9).map(|k| format!("[[drive]]\nname = \"{k}\"\n")).collect();
    let error = parse(&text.replacen("[[link]]", &(drives + "[[link]]"), 1), "arm.toml").expect_err("nine").to_string();
    assert!(error.contains("9 drives: want 1 to 8"), "{error}");
}

/// A rotor is set by key, read back, and taken out again.
#[test]
fn rotors_are_set_by_key() {
    let machine = family_machine("two-drive-balanced");
    let geared =
        machine.set_all([("drive.2.rotor.ratio", "-40"), ("drive.2.rotor.inertia", "1e-5")]).expect("in range");
    let value = |key: &str| geared.value(key).and_then(|v| v.as_float()).expect("a number");
    assert_eq!((value("drive.2.rotor.ratio"), value("drive.2.rotor.inertia")), (-40.0, 1e-5));
    let [before, after] = [&machine, &geared].map(Inertia::of);
    close("H", &[after.diagonal(1) - before.diagonal(1)], &[1e-5 * 1600.0], 1e-12);
    close("D", &[after.momentum(1) - before.momentum(1)], &[-1e-5 * 40.0], 1e-9);
    let back = geared.set_all([("drive.2.rotor.ratio", "default"), ("drive.2.rotor.inertia", "default")]);
    assert_eq!(back.expect("in range"), machine);
    let free = machine.set("limits.a1", "default").expect("it turns freely");
    assert_eq!(parse(&to_toml(&free), "free").expect("its own file"), free);
}
