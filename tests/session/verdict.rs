//! The verdict on a run, and its remarks.

use proptest::prelude::*;
use stillbase::session::scenario::Scenario;
use stillbase::session::verdict::{LIMIT_TOLERANCE, Statements, StatusLight, Verdict};
use stillbase::session::{Edit, Session, TimedEdit, replay};
use stillbase::settings::change;
use stillbase::simulation::frame::Frame;
use stillbase::simulation::plant::{BaseKind, DriveValues, Wheel};

fn case(name: &str, machine: &[(&str, &str)], settings: &str) -> Scenario {
    let mut scenario = Scenario::builtin(name).expect("built in");
    let table: toml::Table = settings.parse().expect("TOML");
    let part = |key: &str| table.get(key).and_then(|v| v.as_table()).cloned().unwrap_or_default();
    scenario.machine = scenario.machine.set_all(machine.iter().copied()).expect("valid");
    scenario.plant = change::with_changes(&scenario.plant, &part("plant")).expect("a plant");
    scenario.control = change::with_changes(&scenario.control, &part("control")).expect("control");
    scenario.base = change::with_changes(&scenario.base, &part("base")).expect("a base");
    scenario
}

fn run(scenario: &Scenario) -> (Verdict, Vec<Frame>) {
    let mut frames = Vec::new();
    let run = replay(scenario, |_, f| frames.push(*f)).expect("runs");
    (Verdict::of(run.scenario(), &run.frame()), frames)
}

fn shorts(verdict: &Verdict) -> Vec<String> {
    verdict.remarks().into_iter().map(|r| r.short).collect()
}

/// Reactionless, and nothing to remark.
fn is_clean(verdict: &Verdict) -> bool {
    verdict.reactionless && verdict.fault.is_none() && verdict.remarks().is_empty()
}

#[test]
fn the_cases_of_the_paper_need_no_remark() {
    for name in ["case-1", "case-2", "case-3"] {
        let (verdict, frames) = run(&case(name, &[], ""));
        let peak = frames.iter().map(|f| f.base_moment().abs()).fold(0.0, f64::max);
        assert_eq!((verdict.arm_moment, verdict.past_wheel), (peak, None));
        assert_eq!(verdict.reactionless, name == "case-3");
        assert_eq!(verdict.answer(), if name == "case-3" { "yes" } else { "no" });
        assert_eq!(is_clean(&verdict), name == "case-3", "{:?}", verdict.remarks());
        assert!(verdict.sentence().starts_with(if name == "case-3" { "reactionless: " } else { "not reactionless: " }));
    }
}

/// What the arm transmits and what a wheel leaves of it are two quantities: the arm is not called reactionless for it.
#[test]
fn a_wheel_does_not_make_an_arm_reactionless() {
    let mut scenario = case("case-1", &[], "");
    scenario.base.wheel = Some(Wheel { inertia: 0.002, ..Wheel::default() });
    let (verdict, frames) = run(&scenario);
    let peak = |of: fn(&Frame) -> f64| frames.iter().map(|f| of(f).abs()).fold(0.0, f64::max);
    assert_eq!(verdict.arm_moment, peak(Frame::base_moment));
    assert_eq!(verdict.past_wheel, Some(peak(|f: &Frame| f.felt_moment)));
    assert!((verdict.arm_moment - 1.0891).abs() < 1e-3 && verdict.past_wheel.is_some_and(|n| n < 1e-9));
    assert!(!verdict.reactionless && verdict.is_base_unloaded && verdict.spares_base());
    assert_eq!(
        (verdict.word(), verdict.answer().as_str()),
        ("reactionless past the wheel", "no, the wheel takes it up")
    );
    // One that is too weak leaves the base something: no praise.
    scenario.base.wheel = Some(Wheel { inertia: 0.002, torque_limit: Some(0.5), ..Wheel::default() });
    let (weak, _) = run(&scenario);
    assert!(!weak.is_base_unloaded && weak.past_wheel.is_some_and(|n| (n - 0.5891).abs() < 1e-3), "{weak:?}");
    assert_eq!((weak.word(), weak.answer().as_str()), ("not reactionless", "no"));
    assert!(weak.sentence().contains("peak |n_B| 1.0891 N m, past the wheel 0.5891 N m"), "{}", weak.sentence());
}

/// Heights along the axis tilt the base whatever the plane says: the verdict says that it leaves that out.
#[test]
fn tilting_is_said_to_be_outside() {
    let (verdict, frames) = run(&case("case-3", &[("link.5.axial", "0.02"), ("link.9.axial", "0.04")], ""));
    let peak = frames.iter().map(|f| f.inside.tilt.total().norm()).fold(0.0, f64::max);
    assert!(peak > 0.01 && (verdict.tilt - peak).abs() < 1e-12, "{} {peak}", verdict.tilt);
    assert!(verdict.reactionless && !is_clean(&verdict));
    assert_eq!(verdict.answer(), "yes, tilts its base");
    assert!(verdict.sentence().contains("heights"), "{}", verdict.sentence());
}

/// An arm that friction holds transmits nothing and has shown nothing.
#[test]
fn an_arm_that_never_moves_is_not_praised() {
    let (verdict, frames) = run(&case("case-3", &[], "[plant.friction]\ncoulomb = 1e4"));
    assert!(frames.iter().all(|f| f.qd.max_abs() < 1e-12));
    assert!(!verdict.moved && !is_clean(&verdict));
    // Motors pull as hard as the error asks, and there is more of it than they have.
    assert_eq!(shorts(&verdict), ["never moved", "past a torque limit", "off its target"]);
    assert!(verdict.answer().starts_with("yes, never moved"), "{}", verdict.answer());
}

/// A miss is of the end effector where the run ended, and is told only when it has.
#[test]
fn a_miss_is_said_at_the_end() {
    let scenario = case("case-2", &[], "[base]\nkind = \"free\"");
    let (verdict, frames) = run(&scenario);
    let end = &frames[frames.len() - 1];
    assert!(verdict.miss() > Some(1e-3) && verdict.miss() == Some((end.end_effector - end.target.at).norm()));
    assert_eq!(shorts(&verdict), ["off its target"]);
    let on_the_way = Verdict::of(&scenario, &frames[frames.len() / 2]);
    assert!(on_the_way.so_far().is_empty() && Verdict::of(&scenario, end).so_far().len() == 1);
    assert_eq!(Verdict::of(&scenario, &frames[0]).so_far(), []);
}

/// Joint limits that are passed are named, with by how much.
#[test]
fn a_joint_limit_that_is_passed_is_named() {
    let mut scenario = case("case-3", &[], "[control]\nlaw = \"pd\"\nkp = 0.0\nkd = 0.0");
    scenario.duration = Some(1.5);
    scenario.edits = vec![TimedEdit { step: 1, edit: Edit::Push { x: 60.0, y: -20.0 } }];
    let (verdict, frames) = run(&scenario);
    let past = |f: &Frame, i: usize| {
        let limits = &scenario.machine.angles()[i].limits;
        (limits.start() - f.a[i]).max(f.a[i] - limits.end())
    };
    let most = |i: usize| frames.iter().map(|f| past(f, i)).fold(0.0, f64::max);
    let (worst, by) = if most(0) > most(1) { ("a1", most(0)) } else { ("a2", most(1)) };
    assert!(by > 0.1, "it swings past: {by}");
    assert_eq!(verdict.past_limit, Some((worst.into(), by)));
    assert!(verdict.answer().contains("past a joint limit") && verdict.sentence().contains(worst));
    // What rounding passes by is none.
    assert!(run(&case("case-1", &[], "")).0.past_limit.is_none_or(|(_, by)| by > LIMIT_TOLERANCE));
}

/// An audit that fails leaves no answer, whatever the peaks say.
#[test]
fn a_failed_audit_leaves_no_answer() {
    let scenario = case("case-3", &[], "");
    let (_, frames) = run(&scenario);
    let mut end = frames[frames.len() - 1];
    end.audit.energy = 1.0;
    let verdict = Verdict::of(&scenario, &end);
    assert_eq!((verdict.word(), verdict.answer().as_str()), ("untrusted", "untrusted"));
    assert!(!verdict.spares_base() && !is_clean(&verdict) && verdict.sentence().contains("audit failed: energy"));
}

/// A session on its way says what it knows and no more.
#[test]
fn a_session_has_a_verdict_at_any_time() {
    let session = Session::open(case("case-3", &[], "")).expect("begins");
    let verdict = Verdict::of(session.scenario(), session.frame());
    assert!(verdict.spares_base() && verdict.so_far().is_empty() && !verdict.moved);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Free fall is weightlessness: whatever gravity does to a base that nothing holds, arm and base do to each other
    /// what they do without it.
    #[test]
    fn free_fall_transmits_what_weightlessness_does(
        gravity in prop::array::uniform2(-12.0..12.0_f64),
        com in prop::array::uniform2(-0.2..0.2_f64),
        name in prop_oneof![Just("case-1"), Just("case-3")],
        payload in prop_oneof![Just(0.0), 0.0..1.0_f64],
        knows in any::<bool>(),
    ) {
        let of = |gravity: [f64; 2]| {
            let pull = format!("{},{}", gravity[0], gravity[1]);
            let mut scenario = case(name, &[("gravity", pull.as_str())], "");
            scenario.base.kind = BaseKind::Free;
            scenario.base.com = com;
            scenario.plant.payload.mass = payload;
            // PD knows no weight: it is the same controller in both.
            scenario.control.law = if knows { stillbase::simulation::control::ControlLaw::ComputedTorque } else { stillbase::simulation::control::ControlLaw::Pd };
            scenario.control.kp = DriveValues::All(400.0);
            scenario.duration = Some(0.4);
            run(&scenario)
        };
        let ((falling, frames), (floating, others)) = (of(gravity), of([0.0; 2]));
        for (a, b) in frames.iter().zip(&others) {
            prop_assert!((a.wrench.dynamic.force - b.wrench.dynamic.force).norm() < 1e-8);
            prop_assert!(a.wrench.static_part.force.norm() < 1e-12);
            prop_assert!((a.base_moment() - b.base_moment()).abs() < 1e-8);
            prop_assert!((a.inside.largest_force - b.inside.largest_force).abs() < 1e-6);
        }
        prop_assert_eq!(falling.reactionless, floating.reactionless);
        prop_assert_eq!(falling.reactionless, name == "case-3" && payload == 0.0);
        prop_assert_eq!(falling.word(), floating.word());
    }
}

fn statements(scenario: &Scenario) -> [Statements; 2] {
    let mut frames = Vec::new();
    let run = replay(scenario, |_, f| frames.push(*f)).expect("runs");
    [Statements::of(&run, &frames[0]), Statements::of(&run, &run.frame())]
}

fn lamps(of: &Statements) -> [StatusLight; 3] {
    of.named().map(|(_, statement)| statement.outcome)
}

/// Three statements: what has not run is neither praised nor blamed, and a path that leaves its plane is not the
/// machine's fault.
#[test]
fn machine_plan_and_run_are_told_apart() {
    use StatusLight::{Bad, Good, Open};
    let [before, after] = statements(&case("case-3", &[], ""));
    assert_eq!(before.line(), "machine: balanced · plan: holds b · run: none yet");
    assert_eq!(lamps(&before), [Good, Good, Open]);
    assert_eq!(after.line(), "machine: balanced · plan: holds b · run: transmitted nothing");
    assert_eq!(lamps(&after), [Good; 3]);
    // A balanced machine on a straight line: the path does it.
    let [before, after] = statements(&case("case-1", &[], ""));
    assert_eq!((lamps(&before), lamps(&after)), ([Good, Bad, Open], [Good, Bad, Bad]));
    assert!(after.run.words.starts_with("peak |n_B| 1.089") && !after.run.words.contains("f_B"), "{}", after.run.words);
    assert!(after.run.why.contains("the path does this, not the machine"), "{}", after.run.why);
    assert!(after.plan.words.starts_with("changes b by 0.0"), "{}", after.plan.words);
    // A machine off balance is told before it has moved, by how much, and its run is not praised for standing still.
    let off = case("case-3", &[("link.5.com", "-0.05")], "");
    let [before, after] = statements(&off);
    assert_eq!((lamps(&before), lamps(&after)), ([Bad, Open, Open], [Bad, Open, Bad]));
    assert!(before.machine.words.starts_with("off balance by 0.") && before.machine.words.ends_with(" kg m"));
    assert!(after.run.why.contains("the machine does this"), "{}", after.run.why);
    // The model is balanced, but not the machine with a payload that control does not know of.
    let [before, after] = statements(&case("case-3", &[], "[plant.payload]\nmass = 0.3"));
    assert_eq!((lamps(&before), lamps(&after)), ([Bad, Good, Open], [Bad, Good, Bad]));
    assert!(after.machine.words.ends_with("with its payload"), "{:?}", after.machine);
    assert!(after.machine.why.contains("payload") && after.run.words.contains("|f_B|"), "{:?}", after.run);
    // Neither does it, but what the model does not know.
    let [_, after] = statements(&case("case-3", &[], "[plant.friction]\nviscous = 0.5"));
    assert_eq!(lamps(&after), [Good, Good, Bad]);
    assert!(after.run.why.contains("friction"), "{:?}", after.run);
    // A wheel takes the moment up; an arm that friction holds has shown nothing; a failed audit leaves no praise.
    let mut wheel = case("case-1", &[], "");
    wheel.base.wheel = Some(Wheel { inertia: 0.002, ..Wheel::default() });
    assert_eq!(lamps(&statements(&wheel)[1]), [Good, Bad, Good]);
    let [_, stuck] = statements(&case("case-3", &[], "[plant.friction]\ncoulomb = 1e4"));
    assert_eq!((stuck.run.outcome, stuck.run.words.as_str()), (Open, "nothing moved"));
    let run = replay(&case("case-3", &[], ""), |_, _| ()).expect("runs");
    let mut end = run.frame();
    end.audit.energy = 1.0;
    let of = Statements::of(&run, &end).run;
    assert_eq!((of.outcome, of.words.as_str()), (Bad, "cannot be trusted"));
}

/// A run that waits has no plan, and one that a hand leads holds b until the hand turns it.
#[test]
fn plans_that_wait_and_hands_that_lead() {
    let mut waits = case("case-3", &[], "");
    waits.task.b = 3.6;
    let session = Session::open_waiting(waits).expect("it waits");
    let of = Statements::of(session.run(), session.frame());
    assert_eq!([of.plan.outcome, of.run.outcome], [StatusLight::Open; 2], "{of:?}");
    let mut session = Session::open(case("case-3", &[], "")).expect("begins");
    session.apply(Edit::DragTarget { x: 0.52, y: 0.6 }).expect("inside");
    session.play();
    session.tick(300);
    let of = |session: &Session| Statements::of(session.run(), session.frames().last().expect("one"));
    assert_eq!(
        (lamps(&of(&session)), of(&session).plan.words.as_str()),
        ([StatusLight::Good; 3], "led by hand, holds b")
    );
    session.apply(Edit::SlideB { b: 2.6 }).expect("b");
    session.tick(20);
    assert_eq!(of(&session).plan.outcome, StatusLight::Bad, "{:?}", of(&session).plan);
    session.tick(20_000);
    assert_eq!(
        lamps(&of(&session)),
        [StatusLight::Good, StatusLight::Bad, StatusLight::Bad],
        "it holds the new b, but has been turned to it, and has transmitted"
    );
    assert!(of(&session).plan.words.starts_with("b turned by 0.2"), "{:?}", of(&session).plan);
    assert!(of(&session).run.why.contains("a hand does this"), "{:?}", of(&session).run);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Lamps against what frames and constants say by themselves.
    #[test]
    fn lamps_say_what_the_numbers_say(
        name in prop_oneof![Just("case-1"), Just("case-2"), Just("case-3")],
        off in prop_oneof![Just(0.0), -0.05..0.05_f64],
        payload in prop_oneof![Just(0.0), 0.05..1.0_f64],
    ) {
        let com = format!("{}", off);
        let mut scenario = case(name, &[], "");
        if off != 0.0 {
            scenario.machine = scenario.machine.set("link.9.com", &com).expect("valid");
        }
        scenario.plant.payload.mass = payload;
        let mut frames = Vec::new();
        let run = replay(&scenario, |_, f| frames.push(*f)).expect("runs");
        let of = Statements::of(&run, &run.frame());
        let most = |of: &dyn Fn(&Frame) -> f64| frames.iter().map(of).fold(0.0, f64::max);
        let [moment, force] = [most(&|f| f.base_moment().abs()), most(&|f| f.wrench.dynamic.force.norm())];
        let torque = most(&|f| f.torque.iter().map(|t| t.abs()).sum());
        prop_assert_eq!(of.machine.outcome == StatusLight::Good, off == 0.0 && payload == 0.0);
        prop_assert_eq!(of.plan.outcome == StatusLight::Good, off == 0.0 && name == "case-3");
        prop_assert_eq!(of.run.outcome == StatusLight::Good, moment < 1e-5 * torque && force < 1e-6);
        prop_assert_eq!(of.run.outcome == StatusLight::Good, off == 0.0 && name == "case-3" && payload == 0.0);
    }
}
