//! Plants that differ from the model: what each deviation does is what physics says.

use proptest::prelude::*;
use stillbase::mechanics::machine::builtin;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, TimedEdit, replay};
use stillbase::settings::change;
use stillbase::simulation::control::Control;
use stillbase::simulation::frame::Frame;
use stillbase::simulation::plant::{
    Base, BaseKind, Contacts, DriveValues, EqualSteps, Friction, FrictionTorques, MovingBody,
};

use crate::support::{body_of, close, three};

fn case(name: &str, settings: &str) -> Scenario {
    let mut scenario = Scenario::builtin(name).expect("built in");
    let table: toml::Table = settings.parse().expect("TOML");
    let part = |key: &str| table.get(key).and_then(|v| v.as_table()).cloned().unwrap_or_default();
    scenario.plant = change::with_changes(&scenario.plant, &part("plant")).expect("a plant");
    scenario.control = change::with_changes(&scenario.control, &part("control")).expect("control");
    scenario.base = change::with_changes(&scenario.base, &part("base")).expect("a base");
    if let Some(step) = table.get("step").and_then(|v| v.as_float()) {
        scenario.step = step;
    }
    if let Some(duration) = table.get("duration").and_then(|v| v.as_float()) {
        scenario.duration = Some(duration);
    }
    scenario.check("test").expect("in range");
    scenario
}

fn frames(scenario: &Scenario) -> Vec<Frame> {
    let mut frames = Vec::new();
    replay(scenario, |_, f| frames.push(*f)).expect("runs");
    frames
}

fn last(scenario: &Scenario) -> Frame {
    let frames = frames(scenario);
    let last = frames[frames.len() - 1];
    assert!(last.first_violation().is_none(), "{:?} {:?}", last.audit, last.first_violation());
    last
}

/// Steps under constant torques are those of a run whose control gives none, to the last bit, where these need no substeps.
#[test]
fn steps_without_control_are_those_of_a_run() {
    let mut scenario = case("case-1", "[control]\nlaw = \"pd\"\nkp = 0\nkd = 0");
    let falls = [("gravity", "0,-1"), ("link.1.com", "0.1"), ("link.2.com", "0.2"), ("link.3.com", "0.3")];
    scenario.machine = scenario.machine.set_all(falls).expect("a machine");
    let frames = frames(&scenario);
    let start = &frames[0];
    let body = MovingBody::of(&scenario.machine, &Friction::default(), &Base::default(), &start.q).expect("a body");
    for count in [0, 1, 64, frames.len() - 1] {
        let (mut q, mut qd) = (start.q.to_vec(), start.qd.to_vec());
        let steps = EqualSteps { length: scenario.step, count };
        body.advance_under(&[0.0; 3], steps, [&mut q, &mut qd], &|| true);
        assert_eq!((&q[..], &qd[..]), (&frames[count].q[..], &frames[count].qd[..]), "after {count} steps");
    }
    let moved = (0..3).map(|k| (frames[frames.len() - 1].q[k] - start.q[k]).abs()).fold(f64::INFINITY, f64::min);
    assert!(moved > 0.01, "{moved}");
}

/// Friction between drive and base is internal to that pair: control that tracks it away leaves nothing. Here it is
/// told nothing of it, and what is left falls with the gains.
#[test]
fn friction_that_is_tracked_away_leaves_nothing() {
    let left = [400.0, 40_000.0, 400_000.0].map(|kp: f64| {
        let kd = 2.0 * kp.sqrt();
        let text = format!("step = 0.0005\n[plant.friction]\nviscous = 0.3\n[control]\nkp = {kp}\nkd = {kd}");
        last(&case("case-3", &text)).peaks.moment
    });
    // The tracking error falls as 1/K_p, and so does what is transmitted: an error that rises and falls as before.
    assert!(left[0] > 1e-2, "{left:?}");
    assert!(left[1] < left[0] / 20.0 && left[2] < left[1] / 5.0, "{left:?}");
    // Only the difference of motors and friction reaches the base.
    for f in frames(&case("case-3", "[plant.friction]\nviscous = 0.3\ncoulomb = 0.1")) {
        let net: f64 = (0..3).map(|k| f.torque[k] - f.friction[k]).sum();
        assert!((f.base_moment() + net).abs() < 1e-9, "{} {net}", f.base_moment());
    }
}

/// Friction in the pins acts on relative rates and sums to zero: the motors feel it, the base only through errors.
#[test]
fn friction_of_pins_sums_to_zero() {
    for f in frames(&case("case-3", "[plant.friction]\npin_viscous = 0.05\npin_coulomb = 0.02")) {
        assert!((f.base_moment() + f.torque.iter().sum::<f64>()).abs() < 1e-9);
        assert_eq!(f.friction.max_abs(), 0.0);
    }
}

/// Coulomb friction against its closed form: one drive coasts, v = v_0 − (τ_C / D) t, and stays where it stops.
#[test]
fn a_coasting_drive_stops_where_it_should() {
    // Control is cut out: no gains, and the model's own torque is zero once the guide rests.
    let text =
        "duration = 0.5\n[plant.friction]\ncoulomb = [2.0, 1e4, 1e4]\n[control]\nlaw = \"pd\"\nkp = 0.0\nkd = 0.0";
    let mut scenario = case("case-3", text);
    // Pushed for a while at the tip with drives 2 and 3 locked, then let go.
    let at = |step, edit| TimedEdit { step, edit };
    scenario.edits = vec![at(0, Edit::Push { x: 12.0, y: 3.0 }), at(100, Edit::Push { x: 0.0, y: 0.0 })];
    let stops = [1e-3, 5e-4, 2e-4].map(|step| {
        scenario.step = step;
        scenario.edits[1].step = (0.1 / step).round() as u64;
        let frames = frames(&scenario);
        let d = stillbase::mechanics::machine::Inertia::of(&scenario.machine).diagonal(0);
        let free = &frames[scenario.edits[1].step as usize];
        assert!(free.qd[0].abs() > 0.1 && free.qd[1].abs() < 1e-15 && free.qd[2].abs() < 1e-15, "{:?}", free.qd);
        let end = &frames[frames.len() - 1];
        assert!(end.qd.max_abs() < 1e-15, "at rest, to the last digit");
        // It stops after v² / (2 τ_C / D).
        let way = free.qd[0].powi(2) / (2.0 * 2.0 / d) * free.qd[0].signum();
        assert!((end.q[0] - free.q[0] - way).abs() < 1e-12, "{} {way}", end.q[0] - free.q[0]);
        end.q[0]
    });
    assert!((stops[0] - stops[1]).abs() < 1e-10 && (stops[1] - stops[2]).abs() < 1e-10, "{stops:?}");
}

/// Stick and slip under control: no chatter at rest, and the same whatever the step.
#[test]
fn stick_and_slip_do_not_depend_on_the_step() {
    let text = |step: f64| {
        format!("step = {step}\nduration = 2.0\n[plant.friction]\ncoulomb = [0.4, 0.15, 0.2]\npin_coulomb = 0.01")
    };
    let ends = [2e-3, 1e-3, 5e-4, 2.5e-4].map(|step| {
        let frames = frames(&case("case-3", &text(step)));
        // Once still, always still.
        let still: Vec<bool> = frames.iter().skip_while(|f| f.time < 1.2).map(|f| f.qd.max_abs() < 1e-14).collect();
        let first = still.iter().position(|s| *s).expect("it comes to rest");
        assert!(still[first..].iter().all(|s| *s), "it chatters at {step}");
        let end = &frames[frames.len() - 1];
        assert!(end.q_reference.0.minus(&end.q.0).max_abs() > 1e-5, "stuck short of the aim");
        [end.q[0], end.q[1], end.q[2]]
    });
    for end in &ends[..3] {
        let off = (0..3).map(|k| (end[k] - ends[3][k]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{off:e}");
    }
}

/// What friction takes is energy lost, and the books close, on every base.
#[test]
fn losses_are_in_the_balance() {
    for base in ["fixed", "free", "compliant"] {
        let text = format!(
            "[plant.friction]\nviscous = 0.1\ncoulomb = 0.1\npin_viscous = 0.01\n[base]\nkind = \"{base}\"\ncom = [0.1, 0.0]"
        );
        let end = last(&case("case-1", &text));
        assert!(end.totals.energy > 0.1);
        assert!(end.audit.energy.abs() < 1e-7 * end.totals.energy, "{base}: {:?}", end.audit);
        if base == "free" {
            assert!(end.momentum.norm() < 1e-12 && end.angular_momentum.abs() < 1e-12);
        }
    }
}

/// With equal gains errors stay on the plane; unequal gains leak, and leak nothing when there is no error.
#[test]
fn unequal_gains_leak() {
    let started_off = |kp: &str| {
        let mut scenario = case("case-3", &format!("[control]\nkp = {kp}"));
        // A push on a machine whose plan it does not stop: an error of all three drives.
        let at = |step, edit| TimedEdit { step, edit };
        scenario.edits = vec![at(200, Edit::Push { x: 5.0, y: 0.0 }), at(260, Edit::Push { x: 0.0, y: 0.0 })];
        frames(&scenario)
    };
    let d = stillbase::mechanics::machine::Inertia::of(builtin("nine-link").expect("built in")).diagonals();
    let weighted = |f: &Frame| (0..3).map(|k| d[k] * (f.q_reference[k] - f.q[k])).sum::<f64>();
    let after = |frames: &[Frame]| frames.iter().skip(261).map(|f| f.base_moment().abs()).fold(0.0, f64::max);
    let (equal, unequal) = (started_off("400.0"), started_off("[900.0, 400.0, 100.0]"));
    // The push itself moves b; what then happens to it is the decay of one error, Σ D_k e_k.
    let (e, v) = (weighted(&equal[260]), (weighted(&equal[261]) - weighted(&equal[259])) / 0.002);
    let off = |frames: &[Frame]| {
        let one = |f: &Frame| {
            let t = f.time - 0.26;
            (weighted(f) - (e + (v + 20.0 * e) * t) * (-20.0 * t).exp()).abs()
        };
        frames.iter().skip(270).step_by(10).map(one).fold(0.0, f64::max)
    };
    assert!(off(&equal) < 1e-2 * e.abs() && off(&unequal) > 0.1 * e.abs(), "{e} {} {}", off(&equal), off(&unequal));
    assert!(after(&unequal) != after(&equal));
    assert!(
        frames(&case("case-3", "[control]\nkp = [900.0, 400.0, 100.0]")).iter().all(|f| f.base_moment().abs() < 1e-6)
    );
}

/// PD without a model leaves the plane's moment small only because its gains are scaled by D_k.
#[test]
fn pd_tracks_late_and_still_keeps_the_plane() {
    let end = last(&case("case-3", "[control]\nlaw = \"pd\""));
    assert!(end.peaks.is_reactionless(), "{:?}", end.peaks);
    let late = frames(&case("case-3", "[control]\nlaw = \"pd\""))
        .iter()
        .fold(0.0_f64, |m, f| m.max(f.q_reference.0.minus(&f.q.0).max_abs()));
    assert!(late > 1e-3, "{late}");
}

/// Compensation knows the payload, so the machine tracks; but balance is lost all the same.
#[test]
fn compensation_tracks_but_does_not_balance() {
    let of = |law: &str| {
        let text = format!("[plant.payload]\nmass = 0.4\noffset = [0.05, 0.02]\n[control]\nlaw = \"{law}\"");
        let frames = frames(&case("case-3", &text));
        let late = frames.iter().fold(0.0_f64, |m, f| m.max(f.q_reference.0.minus(&f.q.0).max_abs()));
        (late, frames[frames.len() - 1].peaks)
    };
    let (blind, knowing) = (of("computed-torque"), of("payload-compensation"));
    assert!(knowing.0 < 1e-9 && blind.0 > 1e-3, "{} {}", knowing.0, blind.0);
    assert!(knowing.1.moment > 0.05 && !knowing.1.is_reactionless());
}

/// Picked up and let go in motion: no rate jumps, the books stay closed, and it is quiet without it.
#[test]
fn a_payload_comes_and_goes() {
    for base in ["fixed", "free"] {
        let text = format!(
            "duration = 1.4\n[plant.payload]\nmass = 0.3\ninertia = 0.002\nfrom = 0.3\nuntil = 0.6\n[base]\nkind = \"{base}\""
        );
        let frames = frames(&case("case-3", &text));
        for w in frames.windows(2) {
            assert!(w[1].qd.minus(&w[0].qd).max_abs() < 0.02, "no jump of rates at {}", w[1].time);
            assert_eq!(w[1].loaded, w[1].time > 0.2995 && w[1].time < 0.5995, "{}", w[1].time);
        }
        assert!(frames.iter().take(299).all(|f| f.base_moment().abs() < 1e-9));
        let end = &frames[frames.len() - 1];
        assert!(end.peaks.moment > 0.05);
        assert!(end.audit.energy.abs() < 1e-8 && end.audit.momentum < 1e-8, "{:?}", end.audit);
    }
}

/// Sampled control at every step is close to control all the time; slower, later and coarser is worse.
#[test]
fn sampling_delay_and_counts_cost_accuracy() {
    let off = |control: &str| {
        let text = format!("[plant.payload]\nmass = 0.2\n[control]\n{control}");
        let fine = frames(&case("case-3", "[plant.payload]\nmass = 0.2"));
        let these = frames(&case("case-3", &text));
        these.iter().zip(&fine).fold(0.0_f64, |m, (a, b)| m.max(a.q.0.minus(&b.q.0).max_abs()))
    };
    let (fast, slow) = (off("rate = 1000.0"), off("rate = 100.0"));
    assert!(fast > 0.0 && fast < 1e-3 && slow > 3.0 * fast, "{fast} {slow}");
    let (early, late) = (off("delay = 0.002"), off("delay = 0.01"));
    assert!(late > 1.5 * early && early > fast, "{early} {late}");
    let (fine, coarse) = (off("encoder = 1e8"), off("encoder = 4000.0"));
    assert!(coarse > 1.5 * fine && fine < 1e-3, "{fine} {coarse}");
    assert!(last(&case("case-3", "[control]\nrate = 500.0")).peaks.moment < 5e-2);
}

/// An edit on the way that changes nothing leaves no trace, whatever control has under way: rates of encoders, torques
/// that are delayed, a wheel that turns, contacts that stick.
#[test]
fn an_edit_that_changes_nothing_leaves_no_trace() {
    let text = "[control]\nrate = 250.0\ndelay = 0.006\nencoder = 20000.0\n[plant.friction]\ncoulomb = 0.05\n\
                [base]\nkind = \"free\"\ncom = [0.1, 0.0]\nwheel = { torque_limit = 0.2 }";
    let scenario = case("case-1", text);
    let mut edited = scenario.clone();
    let force = scenario.plant.force;
    edited.edits =
        [100, 101, 333].map(|step| TimedEdit { step, edit: Edit::Push { x: force[0], y: force[1] } }).to_vec();
    let (plain, edited) = (frames(&scenario), frames(&edited));
    // Later a last digit may turn a count of the encoders over.
    for (a, b) in plain.iter().zip(&edited).take(500) {
        assert!(a.q.0.minus(&b.q.0).max_abs() < 1e-11, "{} s: {:?} {:?}", a.time, a.q, b.q);
        assert!((a.base.angle - b.base.angle).abs() < 1e-11 && (a.wheel.rate - b.wheel.rate).abs() < 1e-9);
        assert!(a.torque.minus(&b.torque).max_abs() < 1e-8, "{} s: {:?} {:?}", a.time, a.torque, b.torque);
    }
    let fault = edited[edited.len() - 1].first_violation();
    assert!(fault.is_none(), "{fault:?}");
}

/// What a controller that samples, reads counts and is late tells the motors, by somebody who knows nothing of the
/// program's own: rounded angles, their differences, nine bodies at the rounded pose, a queue.
fn check_sampled(given: Sampled) {
    let Sampled { off, gravity, encoder, period, delay, base, kp } = given;
    let mut scenario = Scenario::builtin("case-1").expect("built in");
    let (off, pull) = (off.to_string(), format!("{},{}", gravity[0], gravity[1]));
    let settings = [("link.1.com", off.as_str()), ("gravity", pull.as_str())];
    scenario.machine = scenario.machine.set_all(settings).expect("valid");
    scenario.plant.payload.mass = 0.3;
    scenario.base.kind = base;
    scenario.control = Control {
        knows_base: false,
        kp: DriveValues::All(kp),
        rate: 1.0 / (period as f64 * scenario.step),
        delay: delay as f64 * scenario.step,
        encoder,
        ..Control::default()
    };
    scenario.duration = Some(0.06);
    scenario.check("test").expect("in range");
    let (body, count) = (body_of(&scenario.machine), std::f64::consts::TAU / encoder);
    let mut read: Vec<[f64; 3]> = Vec::new();
    // By the step at which each comes into effect.
    let mut told: Vec<(u64, [f64; 3])> = Vec::new();
    replay(&scenario, |run, f| {
        if f.step % period == 0 {
            let seen = [0, 1, 2].map(|k| (f.relative(k) / count).round() * count);
            let r = run.plan().motion.at(f.time);
            let rate = match read.last() {
                Some(before) => [0, 1, 2].map(|k| (seen[k] - before[k]) / (period as f64 * scenario.step)),
                None => three(&r.qd),
            };
            read.push(seen);
            if delay > 0 && told.is_empty() {
                told.push((0, body.recursive(seen, [0.0; 3], [0.0; 3]).0));
            }
            let wanted = [0, 1, 2].map(|k| r.qdd[k] + 40.0 * (r.qd[k] - rate[k]) + kp * (r.q[k] - seen[k]));
            told.push((f.step + delay, body.recursive(seen, rate, wanted).0));
        }
        let (_, now) = told.iter().rev().find(|(due, _)| *due <= f.step).expect("the hold, at least");
        close("torque", &f.torque, now, 1e-9);
    })
    .expect("runs");
}

#[derive(Clone, Debug)]
struct Sampled {
    off: f64,
    gravity: [f64; 2],
    encoder: f64,
    period: u64,
    delay: u64,
    base: BaseKind,
    kp: f64,
}

fn any_sampled() -> impl Strategy<Value = Sampled> {
    let kinds = prop_oneof![Just(BaseKind::Fixed), Just(BaseKind::Free), Just(BaseKind::Compliant)];
    (-0.2..0.2_f64, prop::array::uniform2(-9.0..9.0_f64), 2.0..5.0_f64, 1..6_u64, 0..12_u64, kinds, 0.0..900.0_f64)
        .prop_map(|(off, gravity, digits, period, delay, base, kp)| Sampled {
            off,
            gravity,
            encoder: 10.0_f64.powf(digits).round(),
            period,
            delay,
            base,
            kp,
        })
}

/// Torques that come before any was computed hold the pose: none in free space, the weight's else.
#[test]
fn a_late_controller_holds_until_its_first_torque() {
    for (gravity, base) in [("0,0", "fixed"), ("0,0", "free"), ("2,-9", "fixed"), ("2,-9", "compliant")] {
        let mut scenario = case("case-1", &format!("[control]\ndelay = 0.005\n[base]\nkind = \"{base}\""));
        let settings = [("gravity", gravity), ("link.1.com", "0.1")];
        scenario.machine = scenario.machine.set_all(settings).expect("valid");
        let frames = frames(&scenario);
        let hold = body_of(&scenario.machine).recursive(three(&frames[0].q.0), [0.0; 3], [0.0; 3]).0;
        for f in &frames[..5] {
            assert!((0..3).all(|k| (f.torque[k] - hold[k]).abs() < 1e-9), "{gravity} {base}: {:?} {hold:?}", f.torque);
            assert!(f.qd.max_abs() < 1e-9, "it stands still until then: {:?}", f.qd);
        }
        assert_eq!(hold.iter().all(|t| *t == 0.0), gravity == "0,0");
        // What was read at the start, before anything accelerates, says the same once more.
        assert!(frames[6].torque.minus(&frames[5].torque).max_abs() > 1e-3, "then it begins");
    }
}

/// Motors that saturate give no more than their limit.
#[test]
fn motors_saturate() {
    let mut scenario = case("case-3", "[plant]\ntorque_limits = true");
    scenario.machine = scenario.machine.set("drive.1.torque_limit", "0.9").expect("valid");
    let end = last(&scenario);
    assert_eq!(end.peaks.torque[0], 0.9);
    assert!(end.peaks.moment > 0.05, "and leave the plane");
    scenario.plant.torque_limits = false;
    assert!(last(&scenario).peaks.is_reactionless());
}

/// Lengths that differ keep the parallelograms, and a bar alone is refused.
#[test]
fn lengths_differ_together() {
    let text = "[plant.length]\nl1 = 0.51\n[plant.link.5]\ncom = -0.02\ncom_normal = 0.004";
    let end = last(&case("case-3", text));
    assert!(end.audit.closure < 1e-12 && end.peaks.moment > 1e-4);
    let mut scenario = Scenario::builtin("case-3").expect("built in");
    scenario.plant = toml::from_str("length.l77 = 0.5").expect("a plant");
    let why = scenario.check("test").expect_err("no such length").to_string();
    assert!(why.contains("l77"), "{why}");
}

/// Stiff gains, stiff springs, motions that jump, friction that reverses: what is shown at every step is what a tenth
/// of the step shows, to a thousandth of its peak, and the audits say so; also where a run is short.
#[test]
fn what_is_shown_does_not_depend_on_the_step() {
    for (name, text) in [
        ("case-1", "[control]\nkp = 478004.0\nkd = 1514.0\n[plant.friction]\nviscous = 15.7"),
        ("case-1", "[control]\nkp = 1e6\nkd = 2000.0"),
        ("case-1", "duration = 0.02\n[control]\nkp = 1e6\nkd = 2000.0\n[plant.payload]\nmass = 1.0"),
        ("bench-top", "duration = 0.3\n[base]\nstiffness = [2e7, 2e7, 2e6]"),
        ("change-b", "[control]\nkp = 5e5\nkd = 700.0"),
        ("circle", "[plant.friction]\ncoulomb = 0.02"),
        ("circle", ""),
    ] {
        let mut scenario = case(name, text);
        let shown = frames(&scenario);
        scenario.step *= 0.1;
        let fine: Vec<Frame> = frames(&scenario).into_iter().step_by(10).collect();
        let end = shown[shown.len() - 1];
        assert!(end.first_violation().is_none(), "{name} {text}: {:?}", end.audit);
        let peaks = end.peaks;
        for (a, b) in shown.iter().zip(&fine) {
            let torque = a.torque.minus(&b.torque).max_abs();
            let force = (a.wrench.dynamic.force - b.wrench.dynamic.force).norm();
            let moment = (a.base_moment() - b.base_moment()).abs();
            for (what, off, peak) in [
                ("torque", torque, peaks.torque_sum),
                ("f_B", force, peaks.force.max(1e-4 * peaks.inertial_pull)),
                ("n_B", moment, peaks.moment.max(1e-4 * peaks.torque_sum)),
                ("tip", (a.end_effector - b.end_effector).norm(), 0.01),
            ] {
                assert!(off <= 1e-3 * peak, "{name} {text}: {what} at {} s is {off:e} off, peak {peak:e}", a.time);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// 64 controllers at 61 steps each.
    #[test]
    fn control_knows_only_what_it_has_read(given in any_sampled()) {
        check_sampled(given);
    }

    /// Stuck contacts take what holds them, within their bounds, and what they take is never more than what moves them.
    #[test]
    fn holding_is_a_projection(
        coulomb in prop::array::uniform3(0.01..3.0_f64),
        force in prop::array::uniform3(-5.0..5.0_f64),
        pin in 0.0..0.5_f64,
        e in prop::array::uniform3(0.0..6.3_f64),
    ) {
        let machine = builtin("nine-link-table-1").expect("built in").set("link.1.com", "0.2").expect("valid");
        let friction = Friction {
            coulomb: stillbase::simulation::plant::DriveValues::Own(coulomb.into()), pin_coulomb: pin, ..Friction::default()
        };
        let contacts = Contacts::of(&machine, &friction, None);
        let inertia = stillbase::mechanics::machine::Inertia::of(&machine);
        let q = stillbase::mechanics::planar::DriveAngles::from(e);
        let (h, _) = stillbase::mechanics::dynamics::mass_matrix(&inertia, &q.units(), &[0.0; 3].into());
        let solve = |x: &[f64; 8]| {
            let y = h.solve(&[x[0], x[1], x[2]].into());
            [y[0], y[1], y[2], 0.0, 0.0, 0.0, 0.0, 0.0]
        };
        let mut padded = [0.0; 8];
        padded[..3].copy_from_slice(&force);
        let free = solve(&padded);
        let (mut total, mut bearing) = (force, [0.0; 3]);
        let mut taken = [0.0; stillbase::simulation::plant::MAX_CONTACTS];
        let torques = FrictionTorques { force: &mut total, bearing: &mut bearing, stuck_torque: &mut taken };
        contacts.solve_stuck(&[0; stillbase::simulation::plant::MAX_CONTACTS], &[0.0; 3], &free[..3], solve, torques);
        padded[..3].copy_from_slice(&total);
        let left = solve(&padded);
        let scale = free.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        for (i, f) in taken.into_iter().enumerate().take(contacts.len()) {
            let (v, most) = (contacts.sliding(i, &left[..3]), contacts.coulomb(i));
            prop_assert!(f.abs() <= most * (1.0 + 1e-12));
            // Either still, or fully against the way it goes.
            let still = v.abs() < 1e-7 * scale;
            prop_assert!(still || ((f.abs() - most).abs() < 1e-9 * most && f * v > 0.0), "{v} {f} {most}");
        }
    }
}
