//! Blocks of an assembly in the window: one is led, all are seen.

use egui_kittest::kittest::Queryable as _;
use stillbase::app::{PictureOrder, SessionCommand, Shot, ViewChange};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::scenario::Scenario;

use super::{Window, drag, session, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![
    all_blocks_are_seen_and_one_is_led,
    the_hand_leads_a_block_in_its_own_plane,
    another_block_is_led_and_taken_back,
    the_hand_leads_a_chain_in_space,
    loads_change_hands_where_the_arms_meet,
    what_belongs_to_the_assembly_is_not_offered,
];

fn opened(name: &str) -> Window {
    let found = stillbase::files::any_scenario(name).expect("built in");
    let mut h = window_of(found.scenario, Theme::Dark, 900.0);
    h.run_steps(3);
    h
}

/// Names of the blocks, and of the items of each, in the scene on display.
fn items(h: &mut Window) -> Vec<String> {
    let order = PictureOrder::new(Shot::Scene, Theme::Dark, [800, 600]);
    let (scene, _) = order.scene(h.state_mut().app_state_mut());
    assert!(scene.solids.iter().all(|solid| solid.mesh < scene.model.meshes.len()));
    let solids = scene.solids.iter().map(|solid| solid.name.to_string());
    let lines = scene.lines.iter().map(|line| line.name.to_string());
    let words = scene.labels.iter().map(|label| label.text.clone());
    solids.chain(lines).chain(words).collect()
}

fn is_plotted(h: &Window, title: &str) -> bool {
    h.query_all_by_label_contains(title).next().is_some()
}

fn all_blocks_are_seen_and_one_is_led() {
    let mut h = opened("wrist-across");
    assert_eq!(h.state().app_state().view_state().view, ViewKind::Space);
    let seen = items(&mut h);
    for name in ["machine/link/1", "wrist/machine/link/1", "wrist/workspace/boundary", "carrier", "wrist"] {
        assert!(seen.iter().any(|own| own == name), "{name} is missing in {seen:?}");
    }
    // The wrist stands on the carrier, so it has no base of its own; what the carrier alone does is not drawn.
    assert!(!seen.iter().any(|name| name.starts_with("wrist/machine/base") || name.starts_with("reaction/")));
    assert!(is_plotted(&h, "Base moment") && is_plotted(&h, "Base force"));
    // Off its pin the base feels a moment, which is drawn; a spacecraft has a body.
    let mut h = opened("off-its-pin");
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(0.5));
    h.run_steps(2);
    assert!(items(&mut h).iter().any(|name| name == "reaction/moment"));
    let mut h = opened("arm-against-arm");
    assert!(items(&mut h).iter().any(|name| name == "base"));
    assert!(is_plotted(&h, "Base attitude"));
}

/// Where a point of the world is drawn.
fn place(h: &Window, at: [f64; 3]) -> egui::Pos2 {
    let rect = h.get_by_label_contains("Scene:").rect();
    let aspect = f64::from(rect.width() / rect.height());
    let [u, v] = h.state().app_state().view_state().camera().project(at, aspect).expect("seen");
    rect.min + egui::vec2(u as f32 * rect.width(), v as f32 * rect.height())
}

/// A drag of the target leads a block in its own plane.
fn the_hand_leads_a_block_in_its_own_plane() {
    let mut h = opened("wrist-across");
    h.state_mut().app_state_mut().carry_out(SessionCommand::Lead(0));
    h.run_steps(2);
    let from = session(&h).frame().end_effector;
    let to = [from.re - 0.03, from.im + 0.04];
    // The carrier stands at the origin, its plane that of the world.
    let z = h.state().app_state().stage().handle_height();
    let [a, b] = [[from.re, from.im], to].map(|[x, y]| place(&h, [x, y, z]));
    drag(&mut h, a, b);
    let target = session(&h).frame().target.at;
    assert!((target.re - to[0]).hypot(target.im - to[1]) < 5e-3, "{target} for {to:?}");
    assert!(session(&h).is_dragged());
}

fn another_block_is_led_and_taken_back() {
    let mut h = opened("wrist-across");
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(0.7));
    h.run_steps(2);
    let shared = |h: &Window| session(h).frame().shared.expect("shared").loads.motion.components();
    let (name, before) = (|h: &Window| session(h).scenario().machine.name().to_owned(), shared(&h));
    assert_eq!(name(&h), "carrier");
    h.get_by_label("Block").click();
    h.run_steps(2);
    h.get_by_label_contains("wrist · wrist").click();
    h.run_steps(3);
    assert_eq!(name(&h), "wrist");
    assert!((session(&h).frame().time - 0.7).abs() < 1e-9);
    let scale = session(&h).frame().shared.expect("shared").scale[0];
    for (a, b) in before.iter().zip(shared(&h)) {
        assert!((a - b).abs() < 1e-7 * scale, "{a} {b}");
    }
    assert!(items(&mut h).iter().any(|name| name == "carrier/machine/link/1"));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Undo);
    h.run_steps(3);
    assert_eq!(name(&h), "carrier");
    // In 2D the block stands alone in its plane.
    h.state_mut().app_state_mut().carry_out(ViewChange::Kind(ViewKind::Flat));
    h.run_steps(2);
    assert!(!items(&mut h).iter().any(|name| name.starts_with("wrist/")));
}

/// With the box ticked, a drag of the target moves the carrier, too, and the end effector follows the pointer in the plane
/// of the screen.
fn the_hand_leads_a_chain_in_space() {
    let mut h = opened("four-freedoms");
    for name in ["reach", "tip"] {
        assert!(items(&mut h).iter().any(|own| own == name), "{name} is missing");
    }
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(6.0));
    h.run_steps(2);
    h.get_by_label("in space, with what carries it").click();
    h.run_steps(3);
    let before = session(&h).tip_on_base().expect("a tip");
    let carrier = |h: &Window| session(h).others().next().map(|(_, frame)| frame.end_effector).expect("the carrier");
    let stood = carrier(&h);
    // The handle lies beside the end effector, along the axis of the arm, which is y of the base.
    let [x, y, z] = before;
    let from = place(&h, [x, y + h.state().app_state().stage().handle_height(), z]);
    drag(&mut h, from, from + egui::vec2(25.0, 20.0));
    h.state_mut().app_state_mut().carry_out(SessionCommand::TogglePlay);
    h.run_steps(200);
    let moved = session(&h).tip_on_base().expect("a tip");
    let way = [0, 1, 2].map(|i| moved[i] - before[i]);
    assert!(way.iter().map(|x| x * x).sum::<f64>().sqrt() > 0.01, "{way:?}");
    assert!((carrier(&h) - stood).norm() > 1e-3, "the carrier stands still");
    assert_eq!(session(&h).frame().shared.expect("shared").silent(), [true; 6]);
    // The block on the base carries itself.
    h.get_by_label("Block").click();
    h.run_steps(2);
    h.get_by_label_contains("carrier · carrier").click();
    h.run_steps(3);
    assert!(h.query_by_label("in space, with what carries it").is_none());
}

/// The button passes a load at the present step where the arms meet, and says how far they are apart elsewhere.
fn loads_change_hands_where_the_arms_meet() {
    let mut h = opened("hand-over");
    let over = |h: &Window| session(h).to_scenario().to_toml().matches("do = \"hand-over\"").count();
    assert!(items(&mut h).iter().filter(|text| *text == "0.4 kg").count() == 2, "both loads are seen");
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(1.0));
    h.run_steps(2);
    h.get_by_label("exchange payloads with right").click();
    let says = |h: &Window| h.query_by_label_contains("the end effectors of left and right are apart by").is_some();
    (0..60).for_each(|_| {
        if !says(&h) {
            h.run_steps(1)
        }
    });
    assert!(says(&h));
    assert_eq!(over(&h), 1, "that of the scenario");
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(3.1));
    h.run_steps(2);
    h.get_by_label("exchange payloads with right").click();
    h.run_steps(2);
    assert_eq!(session(&h).undo_title(), Some("left hands its payload to right"));
    assert!((session(&h).frame().time - 3.1).abs() < 1e-9);
    assert_eq!(over(&h), 2, "the later one is of the branch that was left");
    h.state_mut().app_state_mut().carry_out(SessionCommand::Undo);
    h.run_steps(2);
    assert!(session(&h).length() > 4.7, "the scenario is back");
}

fn what_belongs_to_the_assembly_is_not_offered() {
    let h = opened("two-arms");
    for section in ["Plant section", "Base section"] {
        assert!(h.query_by_label(section).is_none(), "{section}");
    }
    let h = window_of(Scenario::builtin("case-3").expect("built in"), Theme::Dark, 900.0);
    assert!(h.query_by_label("Block").is_none(), "a machine by itself");
}
