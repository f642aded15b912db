//! A hand leads machines of any number of drives: b stays, the base feels nothing, limits hold; b is slid at its price.

use proptest::prelude::*;
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Inertia, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::posture::{Posture, PostureWeights};
use stillbase::session::scenario::{PathShape, Scenario};
use stillbase::session::{Edit, Session, replay};
use stillbase::simulation::frame::{Frame, Reach};

use super::{drag, open, slide};

fn scenario(name: &str) -> Scenario {
    Scenario::builtin(name).expect("built in")
}

fn space(session: &Session) -> PoseSpace {
    PoseSpace::of(&session.scenario().machine).expect("it has a pose constant")
}

/// Steps of a session, each looked at.
fn step(session: &mut Session, steps: usize, mut see: impl FnMut(&Frame)) {
    for _ in 0..steps {
        session.step_by(1);
        see(session.frame());
    }
}

/// The largest moment and the largest torque of some steps.
fn led(session: &mut Session, steps: usize) -> [f64; 2] {
    let mut most = [0.0_f64; 2];
    let limits: Vec<[f64; 2]> =
        session.scenario().machine.angles().iter().map(|a| [*a.limits.start(), *a.limits.end()]).collect();
    step(session, steps, |f| {
        most[0] = most[0].max(f.base_moment().abs());
        most[1] = most[1].max(f.torque.iter().map(|t| t.abs()).sum());
        for (a, [low, high]) in f.a.iter().zip(&limits) {
            assert!(*a > low - 1e-6 && *a < high + 1e-6, "{a} of {low} to {high}");
        }
    });
    most
}

#[test]
fn two_drives_go_along_their_curve() {
    let mut session = open(scenario("two-drive"));
    let (b, space) = (session.frame().b_reference, space(&session));
    let curve: Vec<Vector> = space.outline(b).curve.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
    for at in [[0.5, 0.1], [0.7, 0.0], [0.3, -0.3], [0.9, 0.2]] {
        session.apply(drag(at[0], at[1])).expect("it follows");
        let [moment, torque] = led(&mut session, 2500);
        assert!(moment < 1e-9 * torque, "{moment} of {torque}");
        let f = session.frame();
        assert!((f.b - b).abs() < 1e-9);
        let p = Vector::new(at[0], at[1]);
        let nearest = curve.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        assert!((f.end_effector - p).norm() < nearest + 1e-5, "{} from {p}, {nearest} would do", f.end_effector);
        let Reach::Outside { nearest, feasible_b, displayed_b, .. } = f.target.reach else {
            panic!("{p} is beside the curve")
        };
        assert!((nearest - f.end_effector).norm() < 1e-6);
        // The b that is named reaches it.
        if let Some(mending) = feasible_b {
            assert!(!space.poses(p, mending, &space.middle()).is_empty(), "{p} at {mending}");
            let printed: f64 = displayed_b.expect("it is printed").to_string().parse().expect("a number");
            assert!(!space.poses(p, printed, &space.middle()).is_empty(), "{p} at {printed} as printed");
        }
    }
    // A point of the curve is reached.
    let on = curve[curve.len() / 3];
    session.apply(drag(on.re, on.im)).expect("it follows");
    led(&mut session, 2500);
    assert!((session.frame().end_effector - on).norm() < 1e-6);
}

/// Without limits the curve goes on from where a hand has led it.
#[test]
fn a_joint_that_turns_freely_is_led_on() {
    let named = scenario("two-drive");
    let mut spec = named.machine.spec().clone();
    (spec.angles[0].min, spec.angles[0].max) = (None, None);
    let machine = stillbase::mechanics::machine::Machine::new(spec).expect("it turns freely");
    let mut session = open(Scenario { machine, ..named });
    let (b, space) = (session.frame().b_reference, space(&session));
    for i in 1..=30 {
        let on = space.end_effector(&space.lift(&[session.frame().a[0] + 0.25], b));
        session.apply(drag(on.re, on.im)).expect("it follows");
        led(&mut session, 700);
        let off = (session.frame().end_effector - on).norm();
        assert!(off < 1e-6, "{off} m at {} rad, drag {i}", session.frame().a[0]);
    }
    assert!(session.frame().a[0] > 7.0, "more than a turn: {}", session.frame().a[0]);
}

#[test]
fn four_drives_are_led_anywhere_in_their_workspace() {
    let mut session = open(scenario("four-drive"));
    let (b, space) = (session.frame().b_reference, space(&session));
    for at in [[0.5, 0.6], [0.2, 0.9], [-0.1, 0.7], [0.6, 0.2]] {
        let p = Vector::new(at[0], at[1]);
        let is_in = !space.poses(p, b, &space.middle()).is_empty();
        session.apply(drag(at[0], at[1])).expect("it follows");
        let [moment, torque] = led(&mut session, 3000);
        assert!(moment < 1e-9 * torque, "{moment} of {torque}");
        let f = session.frame();
        assert!((f.b - b).abs() < 1e-9);
        assert_eq!(f.target.reach == Reach::Inside, is_in, "{p}");
        assert!(!is_in || (f.end_effector - p).norm() < 1e-6, "{} instead of {p}", f.end_effector);
    }
    // Far outside it waits where it is nearest.
    session.apply(drag(2.0, 1.5)).expect("it waits");
    led(&mut session, 3000);
    let f = session.frame();
    let p = Vector::new(2.0, 1.5);
    let boundary = space.outline(b).loops;
    let nearest =
        boundary.iter().flatten().map(|[x, y]| (Vector::new(*x, *y) - p).norm()).fold(f64::INFINITY, f64::min);
    assert!((f.end_effector - p).norm() < nearest + 1e-3, "{} m, {nearest} m would do", (f.end_effector - p).norm());
    let again = replay(&session.to_scenario(), |_, _| {}).expect("it runs");
    assert_eq!(again.frame(), session.run().frame(), "the drags are in the script");
}

/// A hand that leads keeps the last link's orientation where the task does, and lets it go only where it has to.
#[test]
fn a_hand_keeps_the_orientation_while_it_can() {
    let led_to = |posture: Posture, at: [f64; 2]| {
        let mut scenario = scenario("four-drive");
        scenario.task.posture = posture;
        let mut session = open(scenario);
        let (before, mut most) = (session.frame().q[3], 0.0_f64);
        session.apply(drag(at[0], at[1])).expect("it follows");
        step(&mut session, 2500, |f| most = most.max((f.q[3] - before).abs()));
        let f = session.frame();
        assert!((f.end_effector - Vector::new(at[0], at[1])).norm() < 1e-6, "{posture:?}: {}", f.end_effector);
        assert!(f.peaks.is_reactionless(), "{posture:?}");
        most
    };
    for at in [[0.55, 0.55], [0.62, 0.42], [0.5, 0.6]] {
        let [kept, free] = [Posture::Orientation, Posture::LeastRates].map(|posture| led_to(posture, at));
        assert!(kept < 1e-9, "{at:?}: it turns by {kept} rad on the way");
        assert!(free > 1e-3, "{at:?}: it would turn: {free}");
    }
    // Where no pose has it, the place matters more.
    assert!(led_to(Posture::Orientation, [0.2, 0.9]) > 1e-3);
}

/// A hand leads by the least torques, or to the middle of all ranges, where the task does.
#[test]
fn a_hand_leads_as_the_task_uses_its_freedoms() {
    let led_to = |posture: Posture, at: [f64; 2]| {
        let mut scenario = scenario("four-drive");
        scenario.task.posture = posture;
        // Joint lines begin at one pose, whatever the posture.
        scenario.task.shape = Some(PathShape::JointLine);
        let mut session = open(scenario);
        let before = session.frame().q;
        session.apply(drag(at[0], at[1])).expect("it follows");
        let [moment, torque] = led(&mut session, 3000);
        assert!(moment < 1e-9 * torque, "{posture:?}: {moment} of {torque}");
        let f = session.frame();
        assert!((f.end_effector - Vector::new(at[0], at[1])).norm() < 1e-6, "{posture:?}: {}", f.end_effector);
        assert!((f.b - session.scenario().task.b).abs() < 1e-9 && f.peaks.is_reactionless(), "{posture:?}");
        (before, f.q)
    };
    let machine = builtin("four-drive").expect("built in");
    let inertia = Inertia::of(machine);
    let space = PoseSpace::of(machine).expect("balanced");
    let middle = PostureWeights::of(machine, &space);
    for at in [[0.57, 0.53], [0.62, 0.42], [0.45, 0.65]] {
        let others = [Posture::LeastRates, Posture::Orientation].map(|posture| led_to(posture, at));
        // What the motors turn from pose to pose is what they need for the straight way there.
        let turned = |(from, to): &(DriveAngles, DriveAngles)| {
            let q = to.0.minus(&from.0);
            let h = PerDrive::from_fn(4, |k| (0..4).map(|l| inertia.constant(k, l) * q[l]).sum());
            inertia.motors().motor_torques(&h).iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        let least = turned(&led_to(Posture::LeastTorque, at));
        let (_, centred) = led_to(Posture::MidRange, at);
        for other in &others {
            // The way there is not straight, which makes up to one part in a hundred.
            assert!(least < turned(other) * 1.01, "{at:?}: {least} of {}", turned(other));
            let [own, other] = [centred, other.1].map(|q| middle.off_middle(&q));
            assert!(own < other, "{at:?}: {own} of {other}");
        }
        // No pose beside it with the same point and b is nearer to the middle.
        let b = space.b(&centred);
        let settled = space.lift(&space.midrange_pose(Vector::new(at[0], at[1]), b, &space.angles(&centred)), b);
        assert!((middle.off_middle(&settled) - middle.off_middle(&centred)).abs() < 1e-7);
    }
}

fn pull(session: &Session, link: &str, along: f64, [x, y]: [f64; 2]) -> Edit {
    assert!(session.scenario().machine.links().iter().any(|own| own.name == link), "{link}");
    Edit::PullLink { link: link.into(), along, x, y }
}

/// Where a point of a link is, m.
fn point_of(session: &Session, link: &str, along: f64) -> Vector {
    let machine = &session.scenario().machine;
    let i = machine.links().iter().position(|own| own.name == link).expect("a link");
    end_effector(&machine.resolved_links()[i].point(along), &session.frame().q.units())
}

/// Held by its tip, a machine of four drives moves in what is left: no farther than its limits, without a reaction, with
/// smooth torques, and the tip stays to rounding.
#[test]
fn a_link_is_pulled_while_the_tip_stays() {
    let mut scenario = scenario("four-drive");
    // Joint lines begin near the middle of the ranges, where there is room.
    scenario.task.shape = Some(PathShape::JointLine);
    let mut session = open(scenario);
    let link = session.scenario().machine.links()[0].name.clone();
    let (tip, b, space) = (session.frame().end_effector, session.frame().b, space(&session));
    let start = point_of(&session, &link, 0.2);
    let mut nearer = 0;
    for turn in [0.6_f64, -0.6, 2.0, -2.0, 0.0] {
        let to = start * Vector::from_polar(1.0, turn);
        let before = (point_of(&session, &link, 0.2) - to).norm();
        session.apply(pull(&session, &link, 0.2, [to.re, to.im])).expect("it is pulled");
        let (mut off, mut swung, q) = (0.0_f64, 0.0_f64, session.frame().q);
        let mut sent = 0.0_f64;
        let [moment, torque] = {
            let mut most = [0.0_f64; 2];
            let machine = session.scenario().machine.clone();
            step(&mut session, 3000, |f| {
                most = [most[0].max(f.base_moment().abs()), most[1].max(f.torque.iter().map(|t| t.abs()).sum())];
                off = off.max((f.end_effector - tip).norm());
                swung = swung.max(f.q.0.minus(&q.0).max_abs());
                for (a, angle) in f.a.iter().zip(machine.angles()) {
                    let limits = &angle.limits;
                    assert!(*a > limits.start() - 1e-9 && *a < limits.end() + 1e-9, "{a} of {limits:?}");
                }
                sent = sent.max((space.end_effector(&f.q_reference) - tip).norm());
            });
            most
        };
        assert!(off < 1e-10, "{turn}: the tip goes {off} m");
        assert!(sent < 1e-14, "{turn}: the reference goes {sent} m");
        assert!(moment < 1e-9 * torque.max(1e-3), "{turn}: {moment} of {torque}");
        let f = session.frame();
        assert!((f.b - b).abs() < 1e-12 && (swung == 0.0 || f.peaks.is_reactionless()));
        let now = (point_of(&session, &link, 0.2) - to).norm();
        assert!(now < before + 1e-9, "{turn}: it goes nearer: {now} m of {before}");
        nearer += u32::from(swung > 0.05 && now < 0.9 * before);
    }
    assert!(nearer >= 2, "it is moved by {nearer} pulls of five");
    let again = replay(&session.to_scenario(), |_, _| {}).expect("it runs");
    assert_eq!(again.frame(), session.run().frame(), "the pulls are in the script");
    let three = open(Scenario { step: 0.002, ..Scenario::builtin("case-3").expect("built in") });
    let why = three.clone().apply(pull(&three, "5", 0.1, [0.3, 0.3])).expect_err("nothing is left").to_string();
    assert!(why.contains("fewer than four drives"), "{why}");
}

/// A b that is said to reach a target does, once it is slid there.
#[test]
fn the_b_that_is_named_reaches_the_target() {
    for at in [[-0.6393, -0.483], [-1.036, 0.117], [0.9, -0.4]] {
        let mut session = open(scenario("four-drive"));
        session.apply(drag(at[0], at[1])).expect("it waits or goes");
        led(&mut session, 2000);
        let Reach::Outside { displayed_b: Some(b), .. } = session.frame().target.reach else { continue };
        let b: f64 = b.to_string().parse().expect("a number");
        // A hair inside, where rounding does not matter.
        let inside = b + 1e-3 * (b - session.frame().b).signum();
        session.apply(slide(inside)).expect("it slides");
        step(&mut session, 9000, |_| {});
        let off = (session.frame().end_effector - Vector::new(at[0], at[1])).norm();
        assert!(off < 1e-4, "{at:?} at b = {inside}: {off} m");
    }
}

#[test]
fn b_is_slid_at_its_price() {
    for name in ["two-drive", "four-drive"] {
        let mut session = open(scenario(name));
        let (space, p) = (space(&session), session.frame().end_effector);
        session.apply(drag(p.re, p.im)).expect("it stays");
        led(&mut session, 10);
        let b = session.frame().b;
        session.apply(slide(b + 0.2)).expect("it slides");
        let mut price = 0.0_f64;
        let mut before: Option<Frame> = None;
        step(&mut session, 1500, |f| {
            // n_B = −D_1 b̈, by the b that it has.
            let bdd = space.lambda().dot(&f.qdd);
            assert!((f.base_moment() + space.inertia() * bdd).abs() < 1e-9, "{} {bdd}", f.base_moment());
            price = price.max(f.base_moment().abs());
            before = Some(*f);
        });
        let f = session.frame();
        assert!((f.b - b - 0.2).abs() < 1e-6, "{name}: {} of {}", f.b - b, 0.2);
        assert!(price > 1e-3, "{name}: it costs a moment");
        let moved = (f.end_effector - p).norm();
        match name {
            // A curve that turns takes the end effector along.
            "two-drive" => assert!(moved > 0.01, "{moved}"),
            _ => assert!(moved < 1e-5, "{moved}: it keeps its place"),
        }
    }
}

#[test]
fn what_has_no_pose_constant_says_why_it_is_not_led() {
    let mut session = open(scenario("scara"));
    let why = session.apply(drag(0.3, 0.3)).expect_err("its b cannot be held").to_string();
    assert!(why.contains("depends on the pose") || why.contains("b"), "{why}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Gone to from anywhere, a pose keeps b and the limits, and comes nearer; a point that some pose is on is reached.
    #[test]
    fn a_hand_comes_as_near_as_can_be(from in prop::array::uniform3(0.05..0.95), to in prop::array::uniform3(0.05..0.95), b in -3.0..3.0) {
        let machine = builtin("four-drive").expect("built in");
        let space = PoseSpace::of(machine).expect("it is balanced");
        let at = |share: [f64; 3]| -> Vec<f64> {
            space.joints().iter().zip(share).map(|(joint, t)| joint.limits()[0] + t * (joint.limits()[1] - joint.limits()[0])).collect()
        };
        let (from, there) = (at(from), space.end_effector(&space.lift(&at(to), b)));
        let (a, off) = space.drag_to(there, b, &from);
        let q = space.lift(&a, b);
        prop_assert!((space.b(&q) - b).abs() < 1e-12);
        prop_assert!((space.end_effector(&q) - there).norm() <= off + 1e-12);
        for (a, joint) in a.iter().zip(space.joints()) {
            prop_assert!(*a >= joint.limits()[0] && *a <= joint.limits()[1]);
        }
        let start = (space.end_effector(&space.lift(&from, b)) - there).norm();
        prop_assert!(off <= start);
        // From a neighbour of the pose that is on it, it is reached.
        let near: Vec<f64> = at(to).iter().map(|a| a + 0.02).collect();
        let (_, off) = space.drag_to(there, b, &space.clamped(&near));
        prop_assert!(off < 1e-9 * space.farthest(), "{off}");
    }
}
