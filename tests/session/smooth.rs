//! A led machine moves smoothly and within its motors' torques, wherever a hand leads it and whatever b it is slid to.

use std::f64::consts::TAU;

use stillbase::planning::pose_space::PoseSpace;
use stillbase::query::answer_sequence;
use stillbase::session::Edit;
use stillbase::session::events::{EventKind, EventLog};
use stillbase::session::scenario::Scenario;

use super::{drag, open, slide};

/// Built-in scenarios of every machine that can be led.
const LED: [&str; 5] = ["case-3", "nine-link-geared", "serial-3r", "two-drive", "four-drive"];
/// Torques as a share of their limits: 1, but for rounding.
const ROUNDED: f64 = 1.0 + 1e-9;

/// Of the torques of one motor: how far they go up and down, and how often they turn back by a part of the greatest.
#[derive(Clone, Copy, Default)]
struct Course {
    last: [f64; 2],
    greatest: f64,
    way: f64,
    turns: u32,
}

/// Steps back and forth of less than this share of the greatest are no chatter.
const PART: f64 = 0.03;

impl Course {
    fn see(&mut self, torque: f64) {
        self.greatest = self.greatest.max(torque.abs());
        let [before, last] = self.last;
        let steps = [last - before, torque - last];
        self.way += steps[1].abs();
        if steps[0] * steps[1] < 0.0 && steps[0].abs().min(steps[1].abs()) > PART * self.greatest {
            self.turns += 1;
        }
        self.last = [last, torque];
    }
}

/// A number in 0..1, another one for each call.
fn shares(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// What each motor does while hands lead a scenario by edits at their steps, and its limits hold; up to a last step.
fn led(scenario: Scenario, edits: &[(u64, Edit)], last: u64) -> Vec<Course> {
    let mut session = open(scenario);
    let machine = session.scenario().machine.clone();
    let mut courses = vec![Course::default(); machine.drives()];
    let mut edits = edits.iter().peekable();
    for step in 0..last {
        while let Some((_, edit)) = edits.next_if(|(at, _)| *at == step) {
            session.apply(edit.clone()).expect("it can be led");
        }
        session.step_by(1);
        let f = session.frame();
        for (k, (course, torque)) in courses.iter_mut().zip(f.torque.iter()).enumerate() {
            course.see(*torque);
            let limit = machine.spec().drives[k].torque_limit.unwrap_or(f64::INFINITY);
            assert!(torque.abs() <= limit * ROUNDED, "{edits:?}: {torque} of {limit} N m at {} s", f.time);
        }
    }
    courses
}

/// Drags to anywhere within the reach, and now and then a slide.
fn at_random(scenario: &Scenario, seed: u64, count: usize) -> (Vec<(u64, Edit)>, u64) {
    let mut share = shares(seed);
    let space = PoseSpace::of(&scenario.machine).expect("it has a pose constant");
    let (mut step, mut edits) = (0, Vec::new());
    for i in 0..count {
        let edit = if i % 3 == 1 {
            slide(scenario.task.b + 0.5 * space.period() * (share() - 0.5))
        } else {
            let (r, turn) = (space.farthest() * share().sqrt(), TAU * share());
            drag(r * turn.cos(), r * turn.sin())
        };
        edits.push((step, edit));
        step += 30 + (700.0 * share()) as u64;
    }
    (edits, step)
}

#[track_caller]
fn is_smooth(what: &str, courses: &[Course], edits: usize) {
    for (k, course) in courses.iter().enumerate() {
        let (way, turns) = (course.way / course.greatest, course.turns);
        assert!(way < 5.0 * edits as f64 + 5.0, "{what}: torque {} goes {way} times its greatest", k + 1);
        assert!(turns < 3 * edits as u32 + 3, "{what}: torque {} turns back {turns} times", k + 1);
    }
}

#[test]
fn torques_do_not_chatter_and_keep_their_limits() {
    for name in LED {
        for seed in 1..4 {
            let scenario = Scenario { step: 0.002, ..Scenario::builtin(name).expect("built in") };
            let (edits, last) = at_random(&scenario, seed, 6);
            let courses = led(scenario, &edits, last);
            is_smooth(&format!("{name}, {edits:?}"), &courses, edits.len());
        }
    }
}

/// Links pulled while the tip is held, one after the other and out of a drag.
#[test]
fn a_pulled_link_moves_smoothly() {
    for seed in 1..5 {
        let scenario = Scenario { step: 0.002, ..Scenario::builtin("four-drive").expect("built in") };
        let mut share = shares(seed);
        let names: Vec<String> = scenario.machine.links().iter().map(|link| link.name.clone()).collect();
        let mut edits = vec![(0, drag(0.5, 0.6))];
        for i in 0..6 {
            let link = names[(share() * names.len() as f64) as usize].clone();
            let (x, y) = (2.0 * share() - 1.0, 2.0 * share() - 1.0);
            edits.push((200 + 300 * i, Edit::PullLink { link, along: 0.2, x, y }));
        }
        let courses = led(scenario, &edits, 2200);
        is_smooth(&format!("seed {seed}, {edits:?}"), &courses, edits.len());
    }
}

/// Slid along folds, where the way ahead is barred again and again.
#[test]
fn folds_are_gone_along_smoothly() {
    let edits = [(1100, drag(0.75, -0.05)), (2500, slide(1.2)), (2700, slide(2.0))];
    let courses = led(Scenario::builtin("serial-3r").expect("built in"), &edits, 4000);
    is_smooth("along folds", &courses, edits.len());
}

/// Slid to a limit of a relative angle, and along it.
#[test]
fn limits_are_gone_along_smoothly() {
    let edits = [
        (0, drag(0.938_747_885, -0.490_880_381)),
        (120, slide(1.858_160_870)),
        (654, drag(-1.201_274_895, 0.025_340_200)),
        (1500, drag(-0.036_752_211, 0.985_253_458)),
        (1727, slide(1.376_370_599)),
        (2037, drag(-1.138_127_695, 0.443_661_912)),
        (2348, drag(0.063_277_266, 1.319_677_928)),
        (3221, slide(0.514_233_105)),
        (3769, drag(1.139_054_875, -0.508_784_138)),
    ];
    let courses = led(Scenario::builtin("four-drive").expect("built in"), &edits, 4300);
    is_smooth("along limits", &courses, edits.len());
}

/// The torques of an arm that nothing balances depend on its pose: where its motors come to their limits, it is said.
#[test]
fn limits_that_cannot_be_foreseen_are_told() {
    let case = Scenario::builtin("case-1").expect("built in");
    let changes = ["link.9.mass=1", "drive.1.torque_limit=3", "gravity=0,-9.81"];
    let pairs = changes.iter().filter_map(|change| change.split_once('='));
    let machine = case.machine.set_all(pairs).expect("an arm that little balances");
    let mut session = open(Scenario { machine, ..case });
    let limits: Vec<f64> = session.scenario().machine.spec().drives.iter().filter_map(|d| d.torque_limit).collect();
    let (mut most, mut watched) = (0.0_f64, answer_sequence::<EventLog>(&Default::default(), &Default::default()));
    for [x, y] in [[-0.4, 0.6], [0.7, 0.5], [-0.6, 0.3], [0.2, 0.9], [0.9, 0.2]] {
        session.apply(drag(x, y)).expect("it can be led");
        for _ in 0..700 {
            session.step_by(1);
            watched.see(session.frame(), (session.scenario().step, &session.scenario().machine));
            let loads = session.frame().torque.iter().zip(&limits).map(|(torque, limit)| torque.abs() / limit);
            most = loads.fold(most, f64::max);
        }
    }
    assert!(most > 1.0, "this test wants a limit that is passed, by {most}");
    let told =
        watched.events().iter().any(|event| event.kind == EventKind::Warning && event.words.contains("torque limit"));
    assert!(told, "{:?}", watched.events());
}
