//! Panels: what they show, set and take back.

use egui::Key;
use egui::accesskit::{Role, Toggled};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::{SessionCommand, Tool, ViewChange};
use stillbase::mechanics::planar::PerDrive;
use stillbase::picture::scene::exaggeration::{DrawnFrame, Exaggeration};
use stillbase::picture::scene::options::Handle;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::pointer::Pointer;
use stillbase::picture::scene::views::ViewKind;
use stillbase::planning::posture::Posture;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;
use stillbase::simulation::control::Control;
use stillbase::simulation::plant::{Base, BaseKind, DriveValues, PlantDifferences};

use super::{Window, hold, on_screen, seen, session, type_into, window, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![
    what_differs_is_set_and_taken_back,
    every_setting_goes_back_to_normal,
    any_setting_is_found_and_typed,
    a_link_that_differs_is_named,
    a_base_that_moves_is_seen_to_move,
    a_drag_on_an_exaggerated_base_leaves_it_as_drawn,
    dots_tell_the_audit,
    tolerances_are_shown_and_set,
    the_bar_covers_nothing,
    a_part_out_of_view_offers_the_way_back,
    scroll_bars_have_room_of_their_own,
    what_can_be_done_is_said_whole,
    tools_are_named_and_reached_by_keyboard,
    the_panel_holds_still,
    lists_close_and_links_are_named,
    the_fonts_have_every_letter,
    what_becomes_of_freedoms_is_chosen,
];

/// Of machines that have some left at each point of their path; others have no such choice.
fn what_becomes_of_freedoms_is_chosen() {
    let mut h = window_of(Scenario::builtin("four-drive").expect("built in"), Theme::Dark, 1700.0);
    h.run_steps(2);
    let turned = |h: &Window| {
        let motion = &session(h).run().plan().motion;
        (motion.path.at(1.0).q[3] - motion.path.at(0.0).q[3]).abs()
    };
    assert!(turned(&h) > 0.01, "turning least turns the hand too");
    h.get_by_label("Freedoms left").click();
    h.run_steps(2);
    h.get_by_label("Keep the hand's orientation").click();
    h.run_steps(4);
    assert_eq!(session(&h).scenario().task.posture, Posture::Orientation);
    assert!(turned(&h) < 1e-9, "{}", turned(&h));
    let h = window_of(Scenario::builtin("circle").expect("built in"), Theme::Dark, 1700.0);
    assert!(h.query_by_label("Freedoms left").is_none(), "three drives have none");
}

/// Whatever differs in the plant is switched on, set and taken back in its section.
fn what_differs_is_set_and_taken_back() {
    let mut h = window_of(Scenario::builtin("case-3").expect("built in"), Theme::Dark, 1700.0);
    h.step();
    assert!(h.query_by_label("payload").is_none(), "folded while all is as the model");
    assert!(h.query_by_label("as the model").is_some());
    hold(&mut h);
    assert!(h.query_by_label("1 difference").is_some());
    for label in ["friction", "torque limits", "force"] {
        h.get_by_label(label).click();
        h.run_steps(2);
    }
    h.get_by_role_and_label(Role::Slider, "Coulomb slider").set_value_accesskit(0.05);
    h.run_steps(2);
    h.get_by_label("viscous per drive").click();
    h.run_steps(2);
    let plant = session(&h).scenario().plant.clone();
    assert_eq!(plant.friction.viscous, DriveValues::Own(PerDrive::from_fn(3, |_| 0.02)));
    assert!((plant.friction.coulomb.of(3)[2] - 0.05).abs() < 1e-3 && plant.torque_limits && plant.force == [2.0, 0.0]);
    assert!(h.query_by_label("4 differences").is_some());
    assert!(h.query_by_label_contains("Friction over time").is_some(), "friction has a plot where there is some");
    // One at a time, then all.
    h.get_by_label("Coulomb back to normal").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().plant.friction.coulomb, DriveValues::All(0.0));
    h.get_by_label("Plant back to normal").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().plant, PlantDifferences::default());
    assert!(h.query_by_label("payload").is_some(), "it does not fold under the hand");
    assert!(h.query_by_label_contains("Friction over time").is_none());
}

/// Whatever keys plant, base and control have, each section takes all of them back. A field that is added fails to
/// compile here until it has a value that is not its default.
fn every_setting_goes_back_to_normal() {
    let mut scenario = Scenario::builtin("case-3").expect("built in");
    let plant: PlantDifferences = toml::from_str(
        "torque_limits = true\nforce = [1.0, 0.0]\npayload.mass = 0.2\nfriction.viscous = 0.01\nlength.l1 = 0.51\n\
         link.5.mass = 1.1",
    )
    .expect("a plant");
    let base: Base = toml::from_str(
        "kind = \"compliant\"\nmass = 30.0\ninertia = 2.0\ncom = [0.1, 0.0]\nstiffness = [1e4, 1e4, 1e3]\n\
         damping = [100.0, 100.0, 5.0]\nwheel.inertia = 0.02",
    )
    .expect("a base");
    let control: Control = toml::from_str(
        "law = \"pd\"\nkp = 300.0\nkd = 30.0\nknows_base = false\nrate = 200.0\ndelay = 0.002\nencoder = 4096.0",
    )
    .expect("control");
    {
        let normal = PlantDifferences::default();
        let PlantDifferences { torque_limits, force, payload, friction, length, link } = &plant;
        assert!(*torque_limits != normal.torque_limits && *force != normal.force && *payload != normal.payload);
        assert!(*friction != normal.friction && *length != normal.length && *link != normal.link);
        let normal = Base::default();
        let Base { kind, mass, inertia, com, stiffness, damping, wheel } = base;
        assert!(kind != normal.kind && mass != normal.mass && inertia != normal.inertia && com != normal.com);
        assert!(stiffness != normal.stiffness && damping != normal.damping && wheel != normal.wheel);
        let normal = Control::default();
        let Control { law, kp, kd, knows_base, rate, delay, encoder } = control;
        assert!(law != normal.law && kp != normal.kp && kd != normal.kd && knows_base != normal.knows_base);
        assert!(rate != normal.rate && delay != normal.delay && encoder != normal.encoder);
    }
    (scenario.plant, scenario.base, scenario.control) = (plant, base, control);
    let mut h = window_of(scenario, Theme::Dark, 1700.0);
    h.step();
    for section in ["Plant", "Base", "Control"] {
        h.get_by_label(&format!("{section} back to normal")).click();
        h.run_steps(2);
    }
    let now = session(&h).scenario();
    assert_eq!(now.plant, PlantDifferences::default());
    assert_eq!(now.base, Base::default());
    assert_eq!(now.control, Control::default());
}

/// Every setting is found by its key, typed with its whole range, and refused beyond it with that range.
fn any_setting_is_found_and_typed() {
    let mut h = window_of(Scenario::builtin("case-3").expect("built in"), Theme::Dark, 1700.0);
    h.run_steps(2);
    h.get_by_label("All settings section").click();
    h.run_steps(2);
    assert!(h.query_by_label_contains("more: search for them").is_some());
    let mut write = |key: &str, text: &str| {
        h.get_by_label("Search the settings").focus();
        h.run_steps(2);
        h.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
        h.event(egui::Event::Text(key.into()));
        h.run_steps(2);
        h.get_by_role_and_label(Role::TextInput, key).focus();
        h.run_steps(2);
        h.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
        if text.is_empty() {
            h.key_press(Key::Backspace);
        } else {
            h.event(egui::Event::Text(text.into()));
        }
        h.run_steps(2);
        h.key_press(Key::Enter);
        h.run_steps(3);
        let said =
            ["want 1e-9", "want fixed, compliant, free"].iter().any(|words| h.query_by_label_contains(words).is_some());
        (session(&h).scenario().clone(), said)
    };
    let machine = |scenario: &Scenario, key: &str| scenario.value(key).and_then(|value| value.as_float());
    assert_eq!(machine(&write("link.9.mass", "0.5").0, "link.9.mass"), Some(0.5));
    assert_eq!(write("control.delay", "0.003").0.control.delay, 0.003);
    assert_eq!(write("control.delay", "").0.control.delay, 0.0, "nothing is what stands there by default");
    assert_eq!(write("plant.force", "1, -2").0.plant.force, [1.0, -2.0]);
    assert_eq!(write("tolerance.moment_limit", "0.01").0.tolerance.moment_limit, Some(0.01));
    let (scenario, said) = write("base.mass", "-3");
    assert_eq!((scenario.base.mass, said), (40.0, true));
    let (scenario, said) = write("base.kind", "flying");
    assert_eq!((scenario.base.kind, said), (BaseKind::Fixed, true));
    assert_eq!(write("base.kind", "free").0.base.kind, BaseKind::Free);
}

/// A link and a length that differ show what they would be in the model.
fn a_link_that_differs_is_named() {
    let text = include_str!("../../assets/scenarios/case-3.toml")
        .replace("[task]", "[plant.link.5]\nmass = 2.5\n\n[plant.length]\nl1 = 0.51\n\n[task]");
    let scenario = Scenario::parse(&text, "differs", None).expect("right");
    let mut h = window_of(scenario, Theme::Light, 1700.0);
    h.run_steps(3);
    assert!(h.query_by_label("2 differences").is_some(), "it opens unfolded");
    let reach = h.state().app_state().stage().linkage().reach();
    assert!((reach - 1.27).abs() < 1e-9, "drawn as it is: {reach}");
    h.get_by_label("link 5 mass back to normal").click();
    h.run_steps(2);
    assert!(session(&h).scenario().plant.link.get("5").is_none_or(|d| d.mass.is_none()));
    h.get_by_label("length l1 back to normal").click();
    h.run_steps(2);
    assert!(session(&h).scenario().plant.length.is_empty());
    assert!((h.state().app_state().stage().linkage().reach() - 1.26).abs() < 1e-9);
}

/// A base that floats is chosen, seen and plotted, and its motion exaggerated until it is seen.
fn a_base_that_moves_is_seen_to_move() {
    let mut h = window_of(Scenario::builtin("case-1").expect("built in"), Theme::Dark, 1700.0);
    h.step();
    assert!(h.query_by_label_contains("Motion of the base over time").is_none());
    h.get_by_label("Base section").click();
    h.run_steps(2);
    h.get_by_label("free").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().base.kind, BaseKind::Free);
    assert!(h.query_by_label_contains("Motion of the base over time").is_some());
    let foreseen = h.state().app_state().base_exaggeration();
    h.get_by_label("Play").click();
    h.run_steps(70);
    let f = *session(&h).frame();
    assert!(f.base.angle.abs() > 1e-3, "{:?}", f.base);
    assert_eq!(h.state().app_state().base_exaggeration(), foreseen, "known before it plays, so that nothing jumps");
    let moved = foreseen * (f.totals.shift + f.totals.base_angle * 1.26);
    assert!((0.04..0.13).contains(&moved), "{moved} m is seen, {foreseen} times");
    // The ring's field is where it is drawn, and pulling it there asks for the same b.
    let shown = DrawnFrame::of(&f, Exaggeration::Times(foreseen));
    let stage = h.state().app_state().stage().clone();
    let at = stage.handle(Handle::Ring, &shown).expect("three drives");
    let b = stage.ring_b([at[0], at[1]], f.b_reference, &shown).expect("three drives");
    assert!((b - f.b_reference).abs() < 1e-12);
    h.key_press(Key::X);
    h.run_steps(2);
    assert_eq!(h.state().app_state().base_exaggeration(), 1.0);
    h.get_by_label("Base back to normal").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().base, Base::default());
}

/// A drag that begins on an exaggerated base leaves the base as it was drawn, and the tip under the pointer.
fn a_drag_on_an_exaggerated_base_leaves_it_as_drawn() {
    for (name, floats) in [("ets-vii", true), ("case-1", false)] {
        let mut scenario = Scenario::builtin(name).expect("built in");
        if !floats {
            scenario.base = Base { kind: BaseKind::Free, ..Base::default() };
        }
        let mut h = window_of(scenario, Theme::Dark, 900.0);
        h.state_mut().app_state_mut().run_to_end();
        h.run_steps(2);
        let factor = h.state().app_state().base_exaggeration();
        let before = *session(&h).frame();
        assert!(factor > 1.0 && before.base.angle.abs() > 1e-3, "{name}: {factor} of {:?}", before.base);
        let drawn = |h: &Window| {
            let frame = *session(h).frame();
            let shown = DrawnFrame::of(&frame, Exaggeration::Times(h.state().app_state().base_exaggeration()));
            (shown.base, shown.end_effector)
        };
        let (base, tip) = drawn(&h);
        // A hand puts the target a little off the tip as it is drawn.
        let place = tip * 0.98;
        let real = DrawnFrame::of(&before, Exaggeration::Times(factor)).target_at(place);
        let drag = Edit::DragTarget { x: real.re, y: real.im };
        h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(drag));
        h.run_steps(1);
        let (now, now_tip) = drawn(&h);
        assert!(session(&h).is_dragged());
        assert_eq!(h.state().app_state().base_exaggeration(), factor, "{name}");
        let moved = (now.at - base.at).norm() + (now.angle - base.angle).abs() + (now_tip - tip).norm();
        assert!(moved < 2e-3, "{name}: the picture jumps by {moved}");
        // The arm comes to rest where the hand is, as it is drawn.
        h.run_steps(200);
        let (_, tip) = drawn(&h);
        assert_eq!(h.state().app_state().base_exaggeration(), factor, "{name}");
        assert!((place - tip).norm() < 2e-3, "{name}: drawn at {tip}, led to {place}");
    }
}

/// Six dots say how far every audited figure is from zero.
fn dots_tell_the_audit() {
    let mut h = window("case-3", Theme::Light);
    h.get_by_label("Play").click();
    h.run_steps(70);
    for figure in ["momentum", "angular", "energy", "loops", "step", "plane"] {
        let words = format!("audit {figure}:");
        let dot = h.get_by_label_contains(&words);
        assert!(dot.accesskit_node().label().is_some_and(|label| label.ends_with(", good")), "{figure}");
    }
    assert!(h.query_by_label_contains("cannot be trusted").is_none());
    let dot = h.get_by_label_contains("audit energy:").rect().center();
    h.hover_at(dot);
    h.run_steps(60);
    assert!(h.query_by_label_contains("energy − work + losses").is_some(), "its figure is under the pointer");
}

/// Tolerances by key: the panel shows them, a spread is set by its number, and they make room for runs side by side.
fn tolerances_are_shown_and_set() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(3);
    h.key_press(Key::T);
    h.run_steps(2);
    assert!(h.query_by_label("Histogram of peaks of the turning moment on the base over machines, N m").is_some());
    assert!(h.query_by_label_contains("20000 machines, varied in 41 numbers each").is_some());
    h.get_by_label("Spread of limit of the moment, |n_B| N m").set_value_accesskit(0.01);
    h.run_steps(3);
    assert_eq!(session(&h).scenario().tolerance.moment_limit, Some(0.01));
    assert!(h.query_by_label_contains("keep within limits").is_some());
    type_into(&mut h, "Spread of limit of the moment, |n_B| N m", "5 N cm");
    assert_eq!(session(&h).scenario().tolerance.moment_limit, Some(0.05));
    h.key_press(Key::C);
    h.run_steps(2);
    assert!(h.query_by_label_contains("Histogram").is_none() && h.state().app_state().comparison().is_some());
    h.key_press(Key::I);
    h.run_steps(2);
    assert!(h.query_by_label_contains("Pin forces over time").is_some());
}

/// The tool bar stands beside the scene: in the default view nothing of the workspace, the machine or the target is
/// covered.
fn the_bar_covers_nothing() {
    for (width, height) in [(1280.0, 800.0), (960.0, 600.0), (1440.0, 900.0)] {
        let mut h = window("case-3", Theme::Dark);
        h.set_size(egui::vec2(width, height));
        h.run_steps(4);
        let scene = h.get_by_label_contains("Scene:").rect();
        for label in ["2D", "Tower", "draw a path", "side by side", "show everything"] {
            let rect = h.get_by_label(label).rect();
            assert!(rect.right() <= scene.left() && rect.bottom() <= height, "{label} {rect} {scene}");
        }
        let planes = session(&h).run().planes().expect("planes").clone();
        for p in planes.boundary().turned(2.4).iter().flatten() {
            let at = on_screen(&h, p[0], p[1]);
            assert!(scene.contains(at), "{p:?} at {at} in {scene}, {width} by {height}");
        }
    }
}

/// A window of another size.
fn sized(size: [f32; 2]) -> Window {
    let mut h = window("case-3", Theme::Dark);
    h.set_size(size.into());
    h
}

fn scene(h: &Window) -> egui::Rect {
    h.get_by_label_contains("Scene:").rect()
}

/// Where b turns the machine out of view nothing moves by itself; a button at the edge shows everything again.
fn a_part_out_of_view_offers_the_way_back() {
    let mut h = sized([1440.0, 900.0]);
    h.run_steps(3);
    let offered = |h: &Window| h.query_by_label_contains("Show everything:").is_some();
    let camera = |h: &Window| *h.state().app_state().view_state().camera();
    assert!(!offered(&h));
    let before = camera(&h);
    for b in [3.4, 4.4, 5.4] {
        h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::SlideB { b }));
        h.run_steps(120);
    }
    h.state_mut().app_state_mut().carry_out(SessionCommand::EndGesture);
    h.run_steps(3);
    let out = |h: &Window| {
        let ends = h.state().app_state().stage().outline(&session(h).frame().into()).collect::<Vec<_>>();
        ends.into_iter().any(|at| !scene(h).contains(seen(h, at)))
    };
    assert!(out(&h) && offered(&h) && camera(&h) == before);
    h.snapshot("out-of-view-dark");
    h.get_by_label_contains("Show everything:").click();
    h.run_steps(3);
    assert!(!out(&h) && !offered(&h));
}

/// What stands in a panel that scrolls ends before its bar, also while that is wide.
fn scroll_bars_have_room_of_their_own() {
    let mut h = sized([1440.0, 700.0]);
    h.run_steps(3);
    let bar = 10.0;
    let plot = h.get_by_label_contains("Torque over time").rect();
    assert!(plot.right() <= 1440.0 - bar, "{plot}");
    let edge = scene(&h).left();
    for label in ["b slider", "gravity slider", "compare b rad", "B y m"] {
        let rect = h.get_by_label(label).rect();
        assert!(rect.right() <= edge - bar, "{label} {rect} before {edge}");
    }
}

/// In the smallest window too.
fn what_can_be_done_is_said_whole() {
    let mut h = sized([960.0, 600.0]);
    h.run_steps(3);
    for view in ViewKind::ALL {
        h.state_mut().app_state_mut().carry_out(ViewChange::Kind(view));
        h.run_steps(3);
        let font = egui::FontId::new(11.5, egui::FontFamily::Proportional);
        let words = h.ctx.fonts_mut(|f| f.layout_no_wrap(view.invitation().into(), font, egui::Color32::WHITE));
        let room = scene(&h).width() - 42.0;
        assert!(words.size().x <= room, "{:?}: {} in {room}", view, words.size().x);
    }
}

/// Each tool says what it is, whether it is on, and its key; the keyboard alone reaches and turns it.
fn tools_are_named_and_reached_by_keyboard() {
    let mut h = window("case-3", Theme::Light);
    h.run_steps(2);
    for (label, key) in [
        ("take hold", ""),
        ("draw a path", "(P)"),
        ("push", "(U)"),
        ("dexterity", "(J)"),
        ("snapshots", "(S)"),
        ("pins", "(I)"),
        ("tolerances", "(T)"),
        ("side by side", "(C)"),
    ] {
        let tool = h.get_by_label(label);
        let on = label == "take hold";
        assert_eq!(tool.accesskit_node().toggled(), Some(if on { Toggled::True } else { Toggled::False }), "{label}");
        let at = tool.rect().center();
        h.hover_at(at);
        h.run_steps(40);
        let tip = h.query_all_by_label_contains(format!("{label} {key}").trim_end()).count();
        assert!(tip > usize::from(key.is_empty()), "{label} shows its name and {key} under the pointer");
    }
    let push = |h: &Window| h.get_by_label("push").accesskit_node().toggled();
    h.get_by_label("push").focus();
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(2);
    assert!((h.state().app_state().view_state().tool == Tool::Push) && push(&h) == Some(Toggled::True));
    h.get_by_label("take hold").click();
    h.run_steps(2);
    assert!(!(h.state().app_state().view_state().tool == Tool::Push) && push(&h) == Some(Toggled::False));
    h.get_by_label("Tower").click();
    h.run_steps(2);
    assert!(h.get_by_label("push").accesskit_node().is_disabled(), "only views of the machine have it");
}

/// Choosing what the machine stands on, or what it holds, moves nothing away from under the pointer.
fn the_panel_holds_still() {
    let mut h = window_of(Scenario::builtin("case-3").expect("built in"), Theme::Dark, 1700.0);
    h.run_steps(2);
    h.get_by_label("Base section").click();
    h.run_steps(2);
    let top = |h: &Window| ["Plant section", "Base section"].map(|label| h.get_by_label(label).rect().top());
    let before = top(&h);
    for kind in ["compliant", "free", "fixed"] {
        h.get_by_label(kind).click();
        h.run_steps(3);
        assert_eq!(top(&h), before, "{kind}");
    }
    // A limit that the plan exceeds is said in the place of another line.
    let exceeded = |h: &Window| h.query_all_by_label_contains("times its limit").next().is_some();
    assert!(!exceeded(&h) && h.query_by_label("planned").is_some());
    let torque = session(&h).run().plan().forecast.torque[0];
    let edit = Edit::set("drive.1.torque_limit", 0.5 * torque);
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(edit));
    h.run_steps(3);
    assert!(exceeded(&h) && h.query_by_label("planned").is_none());
    assert_eq!(top(&h), before, "an exceeded limit");
}

/// A list closes with Esc and nothing else does; a link says its name.
fn lists_close_and_links_are_named() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::U);
    h.run_steps(2);
    for list in ["Scenario", "Machine", "Speed", "Shape"] {
        h.get_by_label(list).click();
        h.run_steps(3);
        assert!(egui::Popup::is_any_open(&h.ctx), "{list} opens");
        h.key_press(Key::Escape);
        h.run_steps(3);
        assert!(!egui::Popup::is_any_open(&h.ctx), "{list} closes");
        assert!((h.state().app_state().view_state().tool == Tool::Push), "Esc was for the list");
    }
    h.key_press(Key::U);
    let frame = *session(&h).frame();
    let e = frame.q.units();
    let stage = h.state().app_state().stage().clone();
    for (i, bar) in stage.linkage().bars().iter().enumerate() {
        let [from, to] = bar.ends(&e);
        // Where no other link lies on it.
        let free = (1..20).map(|k| f64::from(k) / 20.0).map(|t| [0, 1, 2].map(|j| from[j] + t * (to[j] - from[j])));
        let alone = free.map(|p| seen(&h, p)).find(|at| {
            let scene = h.get_by_label_contains("Scene:").rect();
            let pair = |v: egui::Vec2| [f64::from(v.x), f64::from(v.y)];
            let camera = *h.state().app_state().view_state().camera();
            let pointer = Pointer { camera, size: pair(scene.size()), at: pair(*at - scene.min) };
            let views = h.state().app_state().views();
            views.under(ViewKind::Flat, &(&frame).into(), &pointer) == Some(Handle::Link(i))
        });
        h.hover_at(alone.unwrap_or_else(|| panic!("{} is seen somewhere", bar.name)));
        h.run_steps(40);
        let words = format!("link {}, turned by drive {}", bar.name, bar.drive + 1);
        assert!(h.query_by_label_contains(&words).is_some(), "{words}");
    }
}

/// Every letter that the sources can put on the screen is in the fonts that come along.
fn the_fonts_have_every_letter() {
    let mut h = window("case-3", Theme::Dark);
    h.step();
    let mut letters = std::collections::BTreeSet::new();
    let mut folders = vec![std::path::PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src"))];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.extend((!path.ends_with("commands") && !path.ends_with("headless")).then_some(path));
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(path).expect("readable");
                let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
                letters.extend(code.flat_map(str::chars).filter(|c| !c.is_ascii()));
            }
        }
    }
    assert!(letters.len() > 30, "{letters:?}");
    for family in [egui::FontFamily::Proportional, egui::FontFamily::Name("bold".into())] {
        let font = egui::FontId::new(13.0, family);
        let missing: Vec<char> =
            letters.iter().copied().filter(|c| !h.ctx.fonts_mut(|fonts| fonts.has_glyph(&font, *c))).collect();
        assert!(missing.is_empty(), "{font:?}: {missing:?}");
    }
}
