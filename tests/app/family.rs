//! Joint space and tower of machines of two and of four drives, and why others have none.

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::mechanics::planar::{Vector, unit};
use stillbase::picture::scene::options::{Handle, ViewOptions};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::scenario::TaskKind;

use super::{Window, drag, seen, session, type_into, window};
use crate::Test;

pub const TESTS: &[Test] = tests![
    joint_space_of_two_drives_is_a_plane_with_a_line,
    joint_space_of_four_drives_shows_three_of_them,
    other_numbers_of_drives_have_a_tower,
    other_numbers_of_drives_are_told_which_b_serves,
    the_ring_turns_and_another_b_is_compared,
    a_view_that_a_machine_lacks_says_why,
    the_hand_is_told_where_to_point,
    other_kinds_of_tasks_are_chosen_for_four_drives,
];

fn themes(name: &str, case: &str, mut at: impl FnMut(&mut Window)) {
    for (theme, word) in [(Theme::Dark, "dark"), (Theme::Light, "light")] {
        let mut h = window(case, theme);
        h.run_steps(2);
        at(&mut h);
        egui_kittest::image_snapshot(&h.render().expect("drawn"), format!("{name}-{word}"));
    }
}

/// As with three drives: the knob about the base turns b, and a second outline is drawn to compare with.
fn the_ring_turns_and_another_b_is_compared() {
    for case in ["two-drive", "four-drive"] {
        let mut h = window(case, Theme::Dark);
        for _ in 0..600 {
            h.run_steps(1);
            if h.state().app_state().stage().outlined().is_some() {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        let frame = *session(&h).frame();
        let stage = h.state().app_state().stage();
        let knob = stage.handle(Handle::Ring, &(&frame).into()).expect("it has a b");
        let away = unit(0.4) * Vector::new(knob[0], knob[1]);
        let (from, to) = (seen(&h, knob), seen(&h, [away.re, away.im, knob[2]]));
        if case == "four-drive" {
            // It stops where A or B would be out of reach.
            drag(&mut h, from, to);
            h.run_steps(4);
            let end =
                session(&h).run().feasible_b().expect("b that serve both").shifted_near(frame.b_reference).intervals[0]
                    [1];
            assert!((session(&h).b_aim() - end).abs() < 1e-4, "{} of {end}", session(&h).b_aim());
            h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
            h.run_steps(4);
            h.get_by_label("turn the task too").click();
            h.run_steps(2);
        }
        drag(&mut h, from, to);
        h.run_steps(4);
        let sum = session(&h).run().pose_space().expect("it has a b").period() / std::f64::consts::TAU;
        let turned = (session(&h).b_aim() - frame.b_reference) / sum;
        assert!((turned - 0.4).abs() < 0.03, "{case}: by {turned} rad");
        let lines = |h: &Window| {
            let state = h.state().app_state();
            let scene = state.stage().scene(session(h).frame(), &ViewOptions::default());
            scene.lines.iter().filter(|line| line.name == "workspace/compared/boundary").count()
        };
        assert_eq!(lines(&h), 0);
        h.get_by_label("compare").click();
        h.run_steps(4);
        assert_eq!(lines(&h), 1, "{case}");
    }
}

/// Of two drives a b is a line; the dot runs along it, and the line moves to another b.
fn joint_space_of_two_drives_is_a_plane_with_a_line() {
    themes("joints-two-drive", "two-drive", |h| {
        h.get_by_label("Joints").click();
        h.run_steps(4);
    });
    let mut h = window("two-drive", Theme::Dark);
    h.run_steps(2);
    h.get_by_label("Joints").click();
    h.run_steps(4);
    let section = h.state().app_state().views().joints().expect("two drives with a b").clone();
    let frame = *session(&h).frame();
    let line = section.surface(frame.b_reference, &frame);
    let [from, to] = line[..] else { panic!("{line:?}") };
    let dot = section.point(&frame.q, frame.b_reference);
    let middle = [0, 1, 2].map(|i| 0.5 * (from[i] + to[i]));
    // Every end is a pose of this b at a limit.
    let space = stillbase::planning::pose_space::PoseSpace::of(&session(&h).scenario().machine).expect("a b");
    let wanted = space.lift(&[space.joints()[0].limits()[0]], frame.b_reference);
    let ends = [from, to].map(|end| {
        let at = section.point(&wanted, frame.b_reference);
        [0, 1].map(|i| at[i] - end[i]).iter().fold(0.0_f64, |m, x| m.max(x.abs()))
    });
    assert!(ends[0].min(ends[1]) < 1e-9, "{ends:?}");
    let (from, to) = (seen(&h, dot), seen(&h, middle));
    drag(&mut h, from, to);
    h.run_steps(40);
    let now = *session(&h).frame();
    assert!((now.b_reference - frame.b_reference).abs() < 1e-9, "the dot keeps b");
    assert!((now.target.at - frame.target.at).norm() > 0.05, "{} {}", now.target.at, frame.target.at);
    // The line itself, beside the dot.
    let line = section.surface(now.b_reference, &now);
    let hold = [0, 1, 2].map(|i| 0.9 * line[0][i] + 0.1 * line[1][i]);
    let by = egui::vec2(40.0, -40.0);
    let from = seen(&h, hold);
    drag(&mut h, from, from + by);
    h.run_steps(4);
    assert!((session(&h).b_aim() - frame.b_reference).abs() > 0.05, "{}", session(&h).b_aim());
}

/// Three drives have an axis and the fourth is named with its angle; another one can be chosen to stand still.
fn joint_space_of_four_drives_shows_three_of_them() {
    themes("joints-four-drive", "four-drive", |h| {
        h.get_by_label("Joints").click();
        h.run_steps(4);
    });
    let mut h = window("four-drive", Theme::Dark);
    h.run_steps(2);
    h.get_by_label("Joints").click();
    h.run_steps(4);
    let shown = |h: &Window| h.state().app_state().views().joints().expect("four drives").drives().to_vec();
    assert_eq!(shown(&h), [0, 1, 2]);
    let frame = *session(&h).frame();
    let section = h.state().app_state().views().joints().expect("four drives").clone();
    let corners = section.surface(frame.b_reference, &frame);
    // Each corner, with the fourth drive where it is, is a pose of this b.
    let space = stillbase::planning::pose_space::PoseSpace::of(&session(&h).scenario().machine).expect("a b");
    let here = section.point(&frame.q, frame.b_reference);
    assert!(corners.len() >= 3);
    for corner in &corners {
        let mut q = frame.q.to_vec();
        (0..3).for_each(|i| q[i] += corner[i] - here[i]);
        assert!((space.b(&q) - frame.b_reference).abs() < 1e-9, "{q:?}");
        for joint in space.joints() {
            let ([low, high], a) = (joint.limits(), joint.of(&q));
            assert!((low - 1e-9..=high + 1e-9).contains(&a), "{a} in {low}..{high}");
        }
    }
    h.get_by_label("q₄ stands still: give it an axis").click();
    h.run_steps(4);
    assert_eq!(shown(&h), [1, 2, 3]);
    assert!(h.query_by_label("q₁ stands still: give it an axis").is_some());
    // The choice outlives what makes the views anew.
    h.key_press(Key::V);
    h.run_steps(2);
    assert_eq!(shown(&h), [1, 2, 3]);
}

fn other_numbers_of_drives_have_a_tower() {
    for case in ["two-drive", "four-drive"] {
        themes(&format!("tower-{case}"), case, |h| {
            h.get_by_label("Tower").click();
            for _ in 0..600 {
                if h.state().app_state().views().tower().is_some() {
                    break;
                }
                std::thread::sleep(std::time::Duration::from_millis(20));
                h.run_steps(1);
            }
            h.run_steps(4);
            let tower = h.state().app_state().views().tower().expect("outlined by now").clone();
            let frame = *session(h).frame();
            // A and B are reached at the b of the task.
            for (post, bars) in tower.posts(&frame) {
                let b = frame.b_reference;
                assert!(bars.iter().any(|[low, high]| low - 1e-6 <= b && b <= high + 1e-6), "{}: {bars:?}", post.name);
            }
        });
    }
}

/// Its button stays where it is and does nothing.
fn a_view_that_a_machine_lacks_says_why() {
    for (case, why) in [("scara", "this machine has no pose constant b"), ("counter-rotating", "every motion")] {
        let mut h = window(case, Theme::Dark);
        h.run_steps(2);
        let button = h.get_by_label("Tower");
        assert!(button.accesskit_node().is_disabled());
        let at = button.rect().center();
        h.hover_at(at);
        h.run_steps(60);
        let tip = format!("This machine has no such view: {why}");
        assert!(h.query_by_label_contains(&tip).is_some(), "{case}: {tip}");
        h.get_by_label("Tower").click();
        h.run_steps(2);
        assert_eq!(h.state().app_state().view_state().view, ViewKind::Flat);
    }
}

/// The panel names the b that serve all points, and a click among the bars of the points chooses one.
fn other_numbers_of_drives_are_told_which_b_serves() {
    for (case, low, high) in [("two-drive", 1.199, 1.201), ("four-drive", 2.8, 3.0)] {
        let mut h = window(case, Theme::Dark);
        h.run_steps(3);
        let common = session(&h).run().feasible_b().expect("a b for both").clone();
        assert!(common.contains(session(&h).scenario().task.b), "{case}: {common:?}");
        let [from, to] = common.shifted_near(0.5 * (low + high)).intervals[0];
        assert!(from <= high && to >= low, "{case}: {from} {to}");
        assert!(h.query_by_label_contains("A and B: b ").is_some(), "{case}");
        let plot = h.get_by_label("Which b: the b that reach each point").rect();
        let before = session(&h).b_aim();
        h.hover_at(plot.center() + egui::vec2(30.0, 0.0));
        h.run_steps(2);
        h.drag_at(plot.center() + egui::vec2(30.0, 0.0));
        h.run_steps(1);
        h.drop_at(plot.center() + egui::vec2(30.0, 0.0));
        h.run_steps(3);
        assert_ne!(session(&h).b_aim(), before, "{case}");
    }
}

/// Four drives leave a freedom: kept to the hand's orientation, it can be told which.
fn the_hand_is_told_where_to_point() {
    let mut h = window("four-drive", Theme::Dark);
    h.run_steps(2);
    assert!(h.query_by_label("hand points to rad").is_none(), "not while the drives turn least");
    h.get_by_label("Freedoms left").click();
    h.run_steps(3);
    h.get_by_label("Keep the hand's orientation").click();
    h.run_steps(4);
    let own = session(&h).run().plan().motion.path.at(0.0).q[3];
    type_into(&mut h, "hand points to rad", "0.3");
    h.run_steps(4);
    let run = session(&h).run();
    assert_eq!((run.scenario().task.orientation, run.waiting()), (Some(0.3), None));
    for s in [0.0, 0.5, 1.0] {
        // The hand runs against the angle of its drive.
        let points_to = run.plan().motion.path.at(s).q[3] - std::f64::consts::PI;
        assert!(
            (points_to - 0.3).abs() < 1e-9 && (run.plan().motion.path.at(s).q[3] - own).abs() > 1e-3,
            "{points_to}"
        );
    }
    // Where no pose has it so, it is said where the hand can point.
    type_into(&mut h, "hand points to rad", "2.5");
    h.run_steps(4);
    assert_eq!(session(&h).scenario().task.orientation, Some(0.3), "it stays as it was");
    assert!(h.query_all_by_label_contains("want it from").next().is_some(), "the reason is shown");
}

/// What becomes of the freedoms is chosen as for three drives, and what cannot be done says why.
fn other_kinds_of_tasks_are_chosen_for_four_drives() {
    let mut h = window("four-drive", Theme::Dark);
    h.run_steps(2);
    for (words, kind) in [
        ("Change b, at a price", TaskKind::ChangeB),
        ("Zero momentum", TaskKind::ZeroMomentum),
        ("Drive 1 apart", TaskKind::SameTip),
        ("Least reaction", TaskKind::LeastReaction),
    ] {
        h.get_by_label("Redundancy").click();
        h.run_steps(3);
        h.get_by_label(words).click();
        h.run_steps(4);
        let run = session(&h).run();
        assert_eq!((run.scenario().task.kind, run.waiting()), (kind, None), "{words}");
        assert!(run.planned_time() > 0.0);
    }
}
