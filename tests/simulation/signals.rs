//! The one table of signals: names, units, and that a value is what the frame holds.

use std::collections::BTreeSet;

use stillbase::mechanics::joint_forces::{Joints, nearest};
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{Vector, cross};
use stillbase::planning::pose_constant::plane_map;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Run, replay};
use stillbase::simulation::frame::{Frame, Phase, REACTIONLESS};
use stillbase::simulation::signals::{Signal, signals};

fn machine() -> &'static Machine {
    builtin("nine-link").expect("built in")
}

/// Frames of Case 1 with a payload that control does not know, in gravity: nothing in them is zero by accident.
fn frames() -> Vec<Frame> {
    let mut scenario = Scenario::builtin("case-1").expect("built in");
    scenario.plant.payload.mass = 0.1;
    let settings = [("gravity", "1,-9.81"), ("link.5.axial", "0.02"), ("payload.axial", "0.03")];
    scenario.machine = scenario.machine.set_all(settings).expect("valid");
    let mut frames = Vec::new();
    replay(&scenario, |_, f| frames.push(*f)).expect("it can start");
    frames
}

fn value(table: &[Signal], path: &str, frame: &Frame) -> f64 {
    table.iter().find(|s| s.path == path).unwrap_or_else(|| panic!("no signal {path}")).value(frame)
}

#[test]
fn paths_are_unique_and_plain() {
    for machine in stillbase::mechanics::machine::builtins() {
        let table = signals(machine);
        let paths: BTreeSet<&str> = table.iter().map(|s| s.path.as_str()).collect();
        assert_eq!(paths.len(), table.len());
        for signal in &table {
            let plain = |c: char| c.is_ascii_alphanumeric() || "/_-".contains(c);
            assert!(signal.path.chars().all(plain) && signal.path.matches('/').count() == 1, "{}", signal.path);
            assert!(!signal.label.is_empty() && !signal.symbol.is_empty(), "{}", signal.path);
            assert_eq!(signal.group(), signal.path.split_once('/').expect("a group").0);
            assert!(signal.drive.is_none_or(|k| k < machine.drives()));
        }
    }
}

/// SI without prefixes, and one unit a group: they share an axis.
#[test]
fn units_are_si_and_one_a_group() {
    let si = [
        "1", "rad", "rad/s", "rad/s²", "m", "m/s", "N", "N s", "N m s", "N m", "kg m/s", "kg m²/s", "J", "m²", "N m/N",
    ];
    let table = signals(machine());
    for signal in &table {
        assert!(si.contains(&signal.unit), "{} in {}", signal.path, signal.unit);
        for other in table.iter().filter(|o| o.group() == signal.group()) {
            assert_eq!(other.unit, signal.unit, "{} and {}", other.path, signal.path);
        }
    }
}

#[test]
fn symbols_count_drives_below_the_line() {
    let table = signals(machine());
    let of = |path: &str| table.iter().find(|s| s.path == path).map(|s| (s.symbol.as_str(), s.drive));
    assert_eq!(of("torque/1"), Some(("τ₁", Some(0))));
    assert_eq!(of("rate/3"), Some(("q̇₃", Some(2))));
    assert_eq!(of("joint/a2"), Some(("a₂", Some(2))));
    assert_eq!(of("pose/b"), Some(("b", None)));
    assert_eq!(of("moment/total"), Some(("n_B", None)));
}

/// Every field of a frame by the path that stands for it.
#[test]
fn values_are_the_frame_s() {
    let table = signals(machine());
    let joints = Joints::of(machine()).expect("determinate");
    let pins = joints.pins();
    let mut named = BTreeSet::new();
    for frame in frames().iter().step_by(97) {
        let mut is = |path: &str, want: f64| {
            let got = value(&table, path, frame);
            assert!(got == want, "{path}: {got}, and {want} in the frame");
            named.insert(path.to_owned());
        };
        for k in 0..3 {
            let drive = k + 1;
            is(&format!("torque/{drive}"), frame.torque[k]);
            is(&format!("angle/{drive}"), frame.q[k]);
            is(&format!("rate/{drive}"), frame.qd[k]);
            is(&format!("acceleration/{drive}"), frame.qdd[k]);
            is(&format!("reference/{drive}"), frame.q_reference[k]);
            is(&format!("error/{drive}"), frame.q_reference[k] - frame.q[k]);
            is(&format!("friction/{drive}"), frame.friction[k]);
        }
        is("joint/a1", frame.a[0]);
        is("joint/a2", frame.a[1]);
        is("pose/b", frame.b);
        is("pose/b_reference", frame.b_reference);
        let (still, moving) = (frame.wrench.statical, frame.wrench.dynamic);
        is("moment/total", still.moment + moving.moment);
        is("moment/dynamic", moving.moment);
        is("moment/static", still.moment);
        is("force/dynamic", moving.force.norm());
        is("force/dynamic_x", moving.force.re);
        is("force/dynamic_y", moving.force.im);
        is("force/static_x", still.force.re);
        is("force/static_y", still.force.im);
        is("momentum/x", frame.momentum.re);
        is("momentum/y", frame.momentum.im);
        is("angular_momentum/about_b", frame.angular_momentum);
        is("com/x", frame.com.re);
        is("com/y", frame.com.im);
        is("tip/x", frame.tip.re);
        is("tip/y", frame.tip.im);
        is("target/x", frame.target.at.re);
        is("target/y", frame.target.at.im);
        is("base/x", frame.base.at.re);
        is("base/y", frame.base.at.im);
        is("attitude/base", frame.base.angle);
        is("energy/kinetic", frame.kinetic);
        let (totals, audit) = (frame.totals, frame.audit);
        is("energy/motors", totals.energy);
        is("audit_energy/balance", audit.energy);
        is("audit_momentum/linear", audit.momentum);
        is("audit_angular/about_o", audit.angular);
        is("audit_closure/worst", audit.closure);
        is("audit_step/worst", audit.step);
        is("audit_plane/b", audit.plane);
        is("moment/felt", still.moment + moving.moment - frame.wheel.torque);
        is("moment/wheel", frame.wheel.torque);
        is("moment/rms", totals.moment_rms());
        is("force/rms", totals.force_rms());
        is("attitude_rate/base", frame.base_rate);
        is("base_velocity/x", frame.base_velocity.re);
        is("base_velocity/y", frame.base_velocity.im);
        is("wheel/rate", frame.wheel.rate);
        is("impulse/force", totals.force_impulse);
        is("angular_impulse/moment", totals.moment_impulse);
        is("payload/held", 1.0);
        is("wheel_saturated/now", 0.0);
        // The determinant by differences of the end effector along the plane, the others by the Jacobian's columns.
        let map = plane_map(machine()).expect("three drives");
        let a = [frame.a[0], frame.a[1]];
        let slope = |i: usize| {
            let at = |h: f64| map.forward([a[0] + h * (1 - i) as f64, a[1] + h * i as f64], 0.0);
            (at(1e-6) - at(-1e-6)) / 2e-6
        };
        assert!((frame.dexterity.det - cross(slope(0), slope(1)).abs()).abs() < 1e-9);
        let e = frame.q.units();
        let columns: Vec<_> = (0..3).map(|k| machine().tip()[k] * e[k]).collect();
        let minors: f64 = [(0, 1), (0, 2), (1, 2)].map(|(k, l)| cross(columns[k], columns[l]).powi(2)).iter().sum();
        assert!((frame.dexterity.manipulability - minors.sqrt()).abs() < 1e-12);
        let torque = |angle: f64| {
            let force = Vector::new(angle.cos(), angle.sin());
            columns.iter().map(|c| cross(*c, force).powi(2)).sum::<f64>().sqrt()
        };
        let worst = (0..3600).map(|i| torque(f64::from(i) * 1e-3)).fold(0.0, f64::max);
        assert!((frame.dexterity.worst_torque_per_force - worst).abs() < 1e-6);
        is("dexterity/det", frame.dexterity.det);
        is("dexterity/manipulability", frame.dexterity.manipulability);
        is("torque_per_force/worst", frame.dexterity.worst_torque_per_force);
        is("transmission/least", frame.transmission);
        for (i, pin) in pins.iter().enumerate() {
            is(&format!("pin/{}", pin.name), frame.inside.pin(i).expect("defined").norm());
        }
        let worst = (0..pins.len()).map(|i| frame.inside.size(i)).fold(0.0, f64::max);
        assert!((frame.inside.worst - worst).abs() <= 1e-14 * worst);
        is("pin/worst", frame.inside.worst);
        is("tilt/x", frame.inside.tilt.motion.re + frame.inside.tilt.weight.re);
        is("tilt/y", frame.inside.tilt.motion.im + frame.inside.tilt.weight.im);
        for (pair, (k, l)) in [("12", (0, 1)), ("13", (0, 2)), ("23", (1, 2))] {
            let turn = frame.q[k] - frame.q[l];
            assert!((value(&table, &format!("transmission/{pair}"), frame) - turn.sin().abs()).abs() < 1e-14, "{pair}");
            is(&format!("transmission/{pair}"), cross(e[k], e[l]).abs());
        }
        let distance = [(0, 1), (0, 2), (1, 2)].map(|(k, l)| (frame.q[k] - frame.q[l]).sin().abs().asin());
        let distance = distance.into_iter().fold(f64::INFINITY, f64::min);
        assert!((value(&table, "change_point/distance", frame) - distance).abs() < 1e-12);
        is("change_point/distance", nearest(&frame.q, &frame.qd).expect("pairs").distance);
        is("reactionless/now", f64::from(u8::from(frame.is_quiet())));
    }
    // No row is left that nobody has looked at.
    assert_eq!(named, table.iter().map(|s| s.path.clone()).collect());
}

/// Everything in a frame that follows from the rest of it does.
#[test]
fn a_frame_agrees_with_itself() {
    let mut scenario = Scenario::builtin("case-1").expect("built in");
    scenario.plant.payload.mass = 0.1;
    scenario.machine = scenario.machine.set("gravity", "1,-9.81").expect("valid");
    let plant = Inertia::of(&scenario.plant.payload.held_by(&scenario.machine).expect("valid"));
    let model = Inertia::of(&scenario.machine);
    let (mut torque, mut moment, mut force) = (0.0_f64, 0.0_f64, 0.0_f64);
    let see = |_: &Run, f: &Frame| {
        let e = f.q.units();
        assert_eq!(f.tip, stillbase::mechanics::kinematics::end_effector(scenario.machine.tip(), &e));
        assert_eq!(f.b, model.lambda().dot(&f.q));
        assert_eq!(f.com, stillbase::mechanics::dynamics::centre_of_mass(&plant, &e));
        assert_eq!(f.transmission, stillbase::mechanics::kinematics::transmission(&e, 3));
        let a = [f.q[1] - f.q[0], f.q[2] - f.q[1] + std::f64::consts::PI];
        assert!((f.a[0] - a[0]).abs() + (f.a[1] - a[1]).abs() < 1e-14);
        // −Σ τ is what the base feels.
        assert!((f.base_moment() + f.torque.iter().sum::<f64>()).abs() < 1e-12 * (1.0 + f.peaks.torque_sum));
        torque = torque.max(f.torque.iter().map(|t| t.abs()).sum());
        moment = moment.max(f.base_moment().abs());
        force = force.max(f.wrench.dynamic.force.norm());
        assert_eq!((f.peaks.torque_sum, f.peaks.moment, f.peaks.force), (torque, moment, force));
        assert!(!f.is_quiet() || f.base_moment().abs() <= REACTIONLESS * torque);
        assert_eq!(f.phase == Phase::Rest, f.step >= 1000);
    };
    replay(&scenario, see).expect("it can start");
}
