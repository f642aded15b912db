//! The one table of signals: names and units; and that a frame agrees with itself. What values mean is in `meaning`.

use std::collections::BTreeSet;

use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Run, replay};
use stillbase::simulation::frame::{Frame, Phase, REACTIONLESS_SHARE};
use stillbase::simulation::signals::signals;

fn machine() -> &'static Machine {
    builtin("nine-link").expect("built in")
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
        assert_eq!(f.end_effector, stillbase::mechanics::kinematics::end_effector(scenario.machine.end_effector(), &e));
        assert_eq!(f.b, model.lambda().dot(&f.q));
        assert_eq!(f.com, stillbase::mechanics::dynamics::centre_of_mass(&plant, &e));
        assert_eq!(f.transmission, stillbase::mechanics::kinematics::least_transmission(&e, 3));
        let a = [f.q[1] - f.q[0], f.q[2] - f.q[1] + std::f64::consts::PI];
        assert!((f.a[0] - a[0]).abs() + (f.a[1] - a[1]).abs() < 1e-14);
        // −Σ τ is what the base feels.
        assert!((f.base_moment() + f.torque.iter().sum::<f64>()).abs() < 1e-12 * (1.0 + f.peaks.torque_sum));
        torque = torque.max(f.torque.iter().map(|t| t.abs()).sum());
        moment = moment.max(f.base_moment().abs());
        force = force.max(f.wrench.dynamic.force.norm());
        assert_eq!((f.peaks.torque_sum, f.peaks.moment, f.peaks.force), (torque, moment, force));
        assert!(!f.is_base_unloaded() || f.base_moment().abs() <= REACTIONLESS_SHARE * torque);
        assert_eq!(f.phase == Phase::Rest, f.step >= 1000);
    };
    replay(&scenario, see).expect("it can start");
}
