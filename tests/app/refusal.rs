//! Refused edits: the window says why, and what would help.

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::{AppState, Message, SessionCommand, Switch, ViewChange, WindowCommand};
use stillbase::picture::scene::options::{Handle, ViewOptions};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;
use stillbase::session::scenario::{Scenario, TaskKind};

use super::{Window, drag, on_screen, session, type_into, window, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![
    opening_an_odd_scenario_changes_nothing_in_it,
    a_refused_path_shows_where_and_what_b_would_do,
    a_scenario_that_cannot_be_planned_is_explained,
    limits_apply_and_the_run_waits,
    a_run_that_waits_says_so_and_keeps_its_way_out,
    statements_open_what_improves_them,
    a_limit_that_is_passed_proposes_more_time,
    what_is_typed_out_of_range_proposes_the_nearest_number,
    a_number_out_of_view_never_changes_by_itself,
    a_problem_is_put_away_until_it_changes,
    a_b_that_does_not_serve_proposes_one_that_does,
    a_target_that_no_b_reaches_leads_to_the_nearest_point,
    a_limit_that_leaves_out_the_pose_is_put_back,
    a_run_that_cannot_be_planned_keeps_the_columns_and_has_a_button,
];

/// The card of a problem is put away by its button and by Esc, and comes back only with another problem.
fn a_problem_is_put_away_until_it_changes() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let waits = |h: &Window| h.query_by_label_contains("The run waits:").is_some();
    type_into(&mut h, "a₁ greatest rad", "150 deg");
    assert!(waits(&h));
    h.get_by_label("Put this message away").click();
    h.run_steps(4);
    assert!(!waits(&h), "the button puts it away");
    h.state_mut().app_state_mut().carry_out(WindowCommand::Refuse("no such number".into(), Vec::new()));
    h.run_steps(3);
    assert!(h.query_by_label("no such number").is_some() && !waits(&h), "another problem is told, not this one again");
    h.key_press(Key::Escape);
    h.run_steps(4);
    assert!(h.query_by_label("no such number").is_none() && !waits(&h), "Esc puts it away");
    type_into(&mut h, "a₁ greatest rad", "140 deg");
    h.run_steps(2);
    assert!(session(&h).run().waiting().is_some());
    type_into(&mut h, "a₁ greatest rad", "180 deg");
    assert!(session(&h).run().waiting().is_none());
    type_into(&mut h, "a₁ greatest rad", "150 deg");
    assert!(waits(&h), "it recurs after it had gone");
}

/// A number past its range: a button takes the nearest one that is allowed.
fn what_is_typed_out_of_range_proposes_the_nearest_number() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    type_into(&mut h, "time T s", "1e6");
    assert!(session(&h).scenario().task.time == 1.0, "nothing has changed");
    h.get_by_label_contains("take time T = ").click();
    h.run_steps(4);
    assert_eq!(session(&h).scenario().task.time, 3600.0);
    assert!(h.query_by_label_contains("take time T = ").is_none(), "the message goes with its reason");
}

/// The way out of a number needs its row: without it there is no button, and a click that no row took is forgotten.
fn a_number_out_of_view_never_changes_by_itself() {
    let side = |h: &mut Window, on: bool| {
        h.state_mut().app_state_mut().carry_out(ViewChange::Switch(Switch::Side, on));
        h.run_steps(3);
    };
    for hides in [false, true] {
        let mut h = window("case-3", Theme::Dark);
        h.run_steps(2);
        type_into(&mut h, "time T s", "1e6");
        side(&mut h, false);
        assert!(h.query_by_label_contains("take time T = ").is_none(), "no row would take the number");
        side(&mut h, true);
        h.get_by_label_contains("take time T = ").click();
        h.step();
        assert_eq!(session(&h).scenario().task.time, 1.0, "the row takes the number in the next pass");
        if hides {
            side(&mut h, false);
            side(&mut h, true);
            assert_eq!(session(&h).scenario().task.time, 1.0, "the click was long ago");
        } else {
            h.step();
            assert_eq!(session(&h).scenario().task.time, 3600.0);
        }
    }
}

/// A b that A and B do not allow: one button takes the nearest that they do, one turns the points with it.
fn a_b_that_does_not_serve_proposes_one_that_does() {
    for (way_out, is_turned) in [("take b = 2.6610 rad", false), ("take b = 3.6000 rad, and turn", true)] {
        let mut h = window("case-3", Theme::Dark);
        h.run_steps(2);
        let before = session(&h).scenario().task.points();
        type_into(&mut h, "b rad", "3.6");
        h.get_by_label_contains(way_out).click();
        h.run_steps(4);
        let task = &session(&h).scenario().task;
        assert_eq!(task.points() != before, is_turned, "{task:?}");
        assert!((task.b - if is_turned { 3.6 } else { 2.661 }).abs() < 1e-3, "{}", task.b);
        assert!(session(&h).run().waiting().is_none() && h.query_by_label_contains("does not serve").is_none());
    }
}

fn a_target_that_no_b_reaches_leads_to_the_nearest_point() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let command = |h: &mut Window, command: SessionCommand| h.state_mut().app_state_mut().carry_out(command);
    command(&mut h, SessionCommand::Edit(Edit::DragTarget { x: 1.5, y: 1.5 }));
    command(&mut h, SessionCommand::EndGesture);
    h.run_steps(200);
    assert!(h.query_by_label("no b reaches the target").is_some());
    h.get_by_label_contains("go to the nearest point").click();
    h.run_steps(100);
    assert!(h.query_by_label("no b reaches the target").is_none());
    let frame = session(&h).frame();
    assert!((frame.end_effector - frame.target.at).norm() < 1e-2, "{:?}", frame.target);
}

/// Led by hand, a limit is tightened past the present pose: it is said, and put back or made as wide as it has to be.
fn a_limit_that_leaves_out_the_pose_is_put_back() {
    for way_out in ["put the limits of angle a1 back", "take limits of angle a1"] {
        let mut h = window("case-3", Theme::Dark);
        h.run_steps(2);
        let command = |h: &mut Window, command: SessionCommand| h.state_mut().app_state_mut().carry_out(command);
        command(&mut h, SessionCommand::Edit(Edit::DragTarget { x: 0.52, y: 0.6 }));
        command(&mut h, SessionCommand::EndGesture);
        h.run_steps(100);
        h.get_by_label("Pause").click();
        h.run_steps(2);
        let angle = &session(&h).scenario().machine.angles()[0];
        let q = session(&h).frame().q;
        let now = q[angle.to] - q[angle.from] + angle.offset;
        type_into(&mut h, "a₁ greatest rad", &format!("{:.3}", now - 0.2));
        assert!(h.query_by_label_contains("outside its limits").is_some(), "{now}");
        h.get_by_label_contains(way_out).click();
        h.run_steps(4);
        assert!(h.query_by_label_contains("outside its limits").is_none(), "{way_out}");
        assert!(session(&h).is_dragged());
    }
}

/// With a payload that unbalances the machine, no reactionless run can be planned: its row has a button, and the
/// columns keep their places.
fn a_run_that_cannot_be_planned_keeps_the_columns_and_has_a_button() {
    let place = |payload: &str| {
        let scenario = Scenario::builtin("case-1").expect("built in");
        let change = toml::from_str(&format!("payload.mass = {payload}")).expect("keys");
        let mut h = window_of(scenario.with_settings(&change).expect("settings"), Theme::Dark, 900.0);
        let open = stillbase::app::ViewChange::Switch(stillbase::app::Switch::Compare, true);
        h.state_mut().app_state_mut().carry_out(open);
        h.run_steps(60);
        let heads = h.query_all_by_label_contains("Sort by").map(|head| head.rect().right());
        let first = heads.fold(f32::INFINITY, f32::min);
        (h, first)
    };
    let (_, free) = place("0.0");
    let (mut h, loaded) = place("0.4");
    assert!((free - loaded).abs() < 30.0, "the first column ends at {free} and {loaded}");
    let rows = h.state().app_state().comparison().expect("a table").entries().len();
    h.query_all_by_label_contains("Reactionless: ").next().expect("a way out").click();
    h.run_steps(60);
    let entries = h.state().app_state().comparison().expect("a table").entries();
    assert!(entries.len() == rows + 1 && entries[rows].outcome.is_ok(), "{}", entries.len());
}

/// A plan that changes b says so; the statement opens a button that runs the task reactionless.
fn statements_open_what_improves_them() {
    let mut h = window("case-1", Theme::Dark);
    h.run_steps(6);
    h.get_by_label_contains("plan: changes b by").click();
    h.run_steps(3);
    h.snapshot("statement-dark");
    h.get_by_label("run it reactionless").click();
    h.run_steps(6);
    assert_eq!(session(&h).scenario().task.kind, TaskKind::Reactionless);
    assert!(h.query_by_label_contains("plan: holds b, good").is_some());
    // A good statement proposes nothing, but leads to where it is decided.
    h.get_by_label_contains("machine: balanced").click();
    h.run_steps(3);
    h.get_by_label("show its masses and their balance").click();
    h.run_steps(3);
    assert_eq!(h.state().app_state().view_state().view, ViewKind::Design);
}

/// A torque past its limit: the plot shows the limit, the plan says how far past, and a button takes the time it needs.
fn a_limit_that_is_passed_proposes_more_time() {
    let mut scenario = Scenario::builtin("case-3").expect("built in");
    let change = toml::from_str("task.time = 0.4\ndrive.1.torque_limit = 1.0").expect("keys");
    scenario = scenario.with_settings(&change).expect("settings");
    let mut h = window_of(scenario, Theme::Dark, 1000.0);
    h.run_steps(10);
    let lamps = h.query_all_by_role(egui::accesskit::Role::Button);
    let says =
        |node: &egui_kittest::Node<'_>| node.accesskit_node().label().is_some_and(|s| s.contains("times its limit"));
    lamps.into_iter().find(says).expect("the lamp of the plan").click();
    h.run_steps(3);
    h.snapshot("limit-dark");
    h.query_all_by_label_contains("times as long").next().expect("a proposal").click();
    h.run_steps(6);
    assert!(session(&h).scenario().task.time > 0.4);
    assert!(h.query_by_label_contains("plan: holds b, good").is_some());
}

fn opening_an_odd_scenario_changes_nothing_in_it() {
    let text = include_str!("../../assets/scenarios/case-3.toml")
        .replace("time = 1.0", "time = 20.0")
        .replace("[task]", "[control]\nkp = 20000.0\nkd = 1500.0\n\n[plant.payload]\nmass = 3.0\n\n[task]")
        .replace("compare_b = 5.0", "compare_b = 77.0");
    let scenario = Scenario::parse(&text, "odd", None).expect("odd but right");
    let mut h = window_of(scenario.clone(), Theme::Dark, 800.0);
    h.run_steps(5);
    assert!(session(&h).script().is_empty(), "{:?}", session(&h).script());
    assert_eq!(session(&h).to_scenario(), scenario);
}

/// What cannot be followed is refused, shown, and mended by a button.
fn a_refused_path_shows_where_and_what_b_would_do() {
    let mut h = window("case-3", Theme::Dark);
    h.step();
    let change = stillbase::session::scenario::TaskChange::from_iter([
        ("shape".to_owned(), "line".into()),
        ("from".to_owned(), vec![0.42, 1.12].into()),
        ("to".to_owned(), vec![0.0, 0.5].into()),
    ]);
    let before = session(&h).scenario().task.clone();
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::of("task", change)));
    h.run_steps(2);
    assert_eq!(session(&h).scenario().task, before, "nothing has changed");
    assert!(h.query_by_label_contains("the path stops at (0.418, 1.116) m").is_some());
    h.snapshot("refused-dark");
    h.get_by_label_contains("take b").click();
    h.run_steps(3);
    let task = &session(&h).scenario().task;
    let message = &h.state().app_state().view_state().status.message;
    assert!((task.b - 2.5256).abs() < 1e-3 && task.to == [0.0, 0.5], "{task:?} {message:?}");
    assert!(h.query_by_label_contains("the path stops").is_none());
}

/// A scenario that cannot be planned still opens: the machine, what was asked for, and the way out.
fn a_scenario_that_cannot_be_planned_is_explained() {
    let scenario = Scenario::builtin("case-3").expect("built in");
    let keys = "shape = 'line'\nfrom = [0.42, 1.12]\nto = [0.0, 0.5]";
    let task = scenario.task.with_change(&toml::from_str(keys).expect("keys"), &scenario.machine).expect("a task");
    let asked = Scenario { task: task.clone(), ..scenario };
    assert!(AppState::new(asked.clone(), Theme::Dark).is_err());
    let mut app_state = AppState::open_or_explain(asked, Theme::Dark).expect("explained");
    let Message { text: words, is_problem: bad } = app_state.view_state().status.message.clone().expect("a reason");
    assert!(bad && words.contains("the path stops at"), "{words}");
    let refused = app_state.view_state().status.refused.as_ref().expect("refused");
    let proposals = refused.refused.as_ref().expect("a change of settings").proposals();
    assert!(proposals[0].text.starts_with("take b = "), "{proposals:?}");
    let commands = refused.commands_with(&proposals[0]);
    assert_eq!(commands.len(), 1, "{proposals:?}");
    commands.into_iter().for_each(|command| app_state.carry_out(command));
    let done = &app_state.session().scenario().task;
    assert_eq!((done.points(), done.shape()), (task.points(), task.shape()));
}

/// A joint limit applies whatever the task: what no longer fits turns red, the run waits, and there are two ways out.
fn limits_apply_and_the_run_waits() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let red = |h: &Window| {
        let app_state = h.state().app_state();
        let scene = app_state.stage().scene(session(h).frame(), &Default::default());
        let named = scene.labels.iter().filter(|l| l.colour == app_state.view_state().palette().reaction);
        named.map(|l| l.text.clone()).collect::<Vec<_>>()
    };
    for way_out in ["take b", "take back", "by hand"] {
        type_into(&mut h, "a₁ greatest rad", "150 deg");
        let limit = *session(&h).scenario().machine.angles()[0].limits.end();
        assert!((limit - 150f64.to_radians()).abs() < 1e-12, "{limit}");
        let waiting = session(&h).run().waiting().cloned().expect("B does not fit");
        let [(1, Some(b))] = waiting.points[..] else { panic!("{waiting:?}") };
        assert_eq!(red(&h), ["B".to_owned(), format!("b = {b} rad would reach it")]);
        assert!(
            h.query_by_label_contains("The run waits: B").is_some() && h.query_by_label("run: waits, open").is_some()
        );
        if way_out == "take b" {
            h.snapshot("waits-dark");
        }
        h.key_press(Key::Space);
        h.run_steps(10);
        assert_eq!(session(&h).frame().step, 0, "time stands still");
        match way_out {
            "take b" => h.get_by_label_contains("take b").click(),
            "take back" => h.key_press_modifiers(Modifiers::COMMAND, Key::Z),
            _ => {
                let (from, to) = (on_screen(&h, 0.55, 0.9), on_screen(&h, 0.55, 0.7));
                drag(&mut h, from, to);
            }
        }
        h.run_steps(3);
        assert!(session(&h).run().waiting().is_none(), "{way_out}: {:?}", session(&h).run().waiting());
        assert!(red(&h).is_empty() && h.query_by_label_contains("The run waits").is_none());
        h.key_press(Key::Space);
        h.run_steps(70);
        assert!(session(&h).frame().step > 900 && session(&h).frame().peaks.is_reactionless(), "{way_out}");
        h.key_press(Key::Num3);
        h.run_steps(2);
        h.key_press(Key::Space);
        h.key_press(Key::Home);
        h.run_steps(2);
    }
}

/// While it waits nothing invites to drag, a drag of the tip does nothing, and what is refused hides no way out.
fn a_run_that_waits_says_so_and_keeps_its_way_out() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let words = |h: &Window| {
        let app_state = h.state().app_state();
        let options = ViewOptions { show_hints: session(h).can_be_dragged(), ..Default::default() };
        let scene = app_state.stage().scene(session(h).frame(), &options);
        scene.labels.iter().any(|label| label.text == "drag me")
    };
    assert!(words(&h) && session(&h).can_be_dragged());
    type_into(&mut h, "a₁ greatest rad", "150 deg");
    assert!(session(&h).run().waiting().is_some() && !session(&h).can_be_dragged() && !words(&h));
    assert!(h.query_by_label_contains("the run waits: change points, limits or b").is_some());
    let tip = session(&h).frame().end_effector;
    let from = on_screen(&h, tip.re, tip.im);
    h.hover_at(from + egui::vec2(14.0, 10.0));
    h.run_steps(3);
    assert_ne!(h.state().app_state().view_state().pointed.object, Some(Handle::Target));
    drag(&mut h, from + egui::vec2(14.0, 10.0), from + egui::vec2(60.0, 40.0));
    h.run_steps(3);
    let has_way_out = |h: &Window| {
        h.query_by_label_contains("The run waits: B").is_some() && h.query_by_label_contains("take b").is_some()
    };
    assert!(has_way_out(&h), "{:?}", h.state().app_state().view_state().status.message);
    // What is refused meanwhile stands above it.
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::DragTarget { x: 0.5, y: 0.6 }));
    h.run_steps(3);
    assert!(has_way_out(&h), "the same reason is said once");
    h.state_mut().app_state_mut().carry_out(WindowCommand::Refuse("no such number".into(), Vec::new()));
    h.run_steps(3);
    assert!(has_way_out(&h) && h.query_by_label("no such number").is_some());
    h.snapshot("waits-refused-dark");
    let scene = h.get_by_label_contains("Scene:").rect();
    let card = h.get_by_label("no such number").rect().union(h.get_by_label_contains("The run waits: B").rect());
    assert!(scene.contains_rect(card.expand(8.0)), "{card} covers no panel: {scene}");
    h.get_by_label_contains("take b").click();
    h.run_steps(3);
    assert!(session(&h).run().waiting().is_none() && session(&h).can_be_dragged());
}
