//! The linked views, and runs side by side.

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::SessionCommand;
use stillbase::picture::paint::labels::{PlacedLabel, placed};
use stillbase::picture::paint::{SceneViewport, enable_draft_quality};
use stillbase::picture::scene::framing::PictureArea;
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::planning::reactionless::PlanePoint;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::{Window, drag, seen, session, window, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![
    what_moves_is_drawn_in_draft_and_finely_once_it_rests,
    views_are_linked,
    words_of_a_scene_stand_clear_of_each_other,
    dexterity_is_shown_with_its_key_where_there_is_a_workspace,
    runs_stand_side_by_side,
];

/// In every view, wide and narrow: no words lie over others, over what covers the scene or across a link, and none are
/// cut off.
fn words_of_a_scene_stand_clear_of_each_other() {
    let usual = ["case-1", "case-3", "two-drive", "space-arm"].map(|name| Scenario::builtin(name).expect("built in"));
    // The last with a joint limit pulled in, so that its run waits.
    let pulled = usual[1].clone();
    for (i, scenario) in usual.into_iter().chain([pulled]).enumerate() {
        let name = format!("{} {i}", scenario.name);
        let mut h = window_of(scenario, Theme::Dark, 800.0);
        if i == 4 {
            let pull = Edit::at(&["limits", "a2"], vec![0.0, 0.93]);
            h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(pull));
            assert!(session(&h).run().waiting().is_some());
        }
        h.run_steps(2);
        for view in ViewKind::ALL {
            if !view.shows_machine() && session(&h).run().planes().is_none() {
                continue;
            }
            for size in [egui::vec2(900.0, 800.0), egui::vec2(380.0, 520.0)] {
                clear_words(&h, &name, view, size);
            }
        }
    }
}

fn clear_words(h: &Window, name: &str, view: ViewKind, size: egui::Vec2) {
    let state = h.state().app_state();
    let (views, frame) = (state.views(), session(h).frame());
    let rect = egui::Rect::from_min_size(egui::pos2(40.0, 30.0), size);
    let content = views.content(view, frame, &[]);
    let room = PictureArea { size: [f64::from(size.x), f64::from(size.y)], covered: Vec::new() };
    let camera = content.framed(views.camera(view), &room);
    let options = ViewOptions { show_hints: true, limits: true, ..Default::default() };
    let scene = std::sync::Arc::new(views.scene(view, frame, &options, &camera));
    let painter = egui::Painter::new(h.ctx.clone(), egui::LayerId::background(), rect);
    let grid = egui::Rect::from_min_max(rect.right_bottom() - egui::vec2(90.0, 28.0), rect.right_bottom());
    let spot = SceneViewport { rect, camera };
    let placement = placed(&painter, &spot, &scene, &[grid], None);
    let all = &placement.all;
    assert!(all.is_empty() == scene.labels.is_empty() && all.len() <= scene.labels.len());
    let bars = scene.bodies.iter().flat_map(|body| {
        let [a, b] = body.ends;
        let along = (0..=40).map(move |i| [0, 1, 2].map(|k| f64::from(a[k] + (b[k] - a[k]) * i as f32 / 40.0)));
        along.filter_map(|at| spot.screen(at))
    });
    let bars: Vec<egui::Pos2> = bars.collect();
    for (i, PlacedLabel { label, place, .. }) in all.iter().enumerate() {
        let words = (name, &label.text, view, size);
        assert!(!place.intersects(grid), "{words:?} lies over the grid's width");
        assert!(rect.expand(1.0).contains_rect(*place), "{words:?} is cut off at {place}");
        for PlacedLabel { label: other, place: there, .. } in &all[..i] {
            assert!(other.at == label.at || !place.intersects(*there), "{words:?} lies over {}", other.text);
        }
        assert!(!bars.iter().any(|at| place.contains(*at)), "{words:?} lies across a link at {place}");
    }
}

/// Where the processor draws, a repaint is asked for once it rests, and then the picture is what it is elsewhere.
fn what_moves_is_drawn_in_draft_and_finely_once_it_rests() {
    let picture = |drafts: bool, rests: bool| {
        let mut h = window("case-3", Theme::Dark);
        if drafts {
            enable_draft_quality(&h.ctx);
        }
        h.step();
        h.key_press(Key::Space);
        h.run_steps(12);
        if rests {
            h.key_press(Key::Space);
            // 0.12 s, of 20 ms each, and one to see it.
            h.run_steps(9);
        }
        (h.render().expect("drawn"), session(&h).frame().step)
    };
    let ((fine, step), (draft, moving)) = (picture(false, false), picture(true, false));
    assert_eq!(step, moving);
    let differing = fine.pixels().zip(draft.pixels()).filter(|(a, b)| a != b).count();
    assert!(differing > 500, "{differing}");
    assert_eq!(picture(false, true), picture(true, true));
}

/// Pulling in one view moves the session, so all of them follow.
fn views_are_linked() {
    let mut h = window("case-3", Theme::Dark);
    h.step();
    // The slice of the tower, pulled up by 0.2 rad at rest: posed there.
    h.get_by_label("Tower").click();
    h.run_steps(3);
    let tower = h.state().app_state().views().tower().expect("three drives").clone();
    let up = |x: f64, y: f64, b: f64| [x, y, b * tower.rise()];
    let (from, to) = (seen(&h, up(0.1, -0.1, 2.4)), seen(&h, up(0.1, -0.1, 2.6)));
    drag(&mut h, from, to);
    h.run_steps(2);
    let f = *session(&h).frame();
    assert!((f.b - 2.6).abs() < 0.01 && f.step == 0, "{} rad at step {}", f.b, f.step);
    // A click on the bar of A chooses that b; a single undo takes it back.
    let bar = seen(&h, up(0.5, 0.5, 2.25));
    h.hover_at(bar);
    h.step();
    h.drag_at(bar);
    h.step();
    h.drop_at(bar);
    h.run_steps(2);
    let chosen = session(&h).frame().b;
    assert!((chosen - 2.25).abs() < 0.01, "{chosen}");
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(2);
    assert!((session(&h).frame().b - f.b).abs() < 1e-9);
    // V goes back around to the machine by way of the design, 2D and 3D; joint space comes fourth.
    for _ in 0..4 {
        h.key_press(Key::V);
        h.run_steps(2);
    }
    assert_eq!(h.state().app_state().view_state().view, ViewKind::Joints);
    // The dot in its plane: the end effector goes where that pose has it, without a reaction.
    let (frame, map) = (*session(&h).frame(), *session(&h).run().planes().expect("three drives").map());
    let space = h.state().app_state().views().joints().expect("a b").clone();
    let at = |q: [f64; 3]| space.point(&q, frame.b_reference);
    let a = [frame.a[0] + 0.4, frame.a[1] + 0.3];
    let (from, to) = (at([frame.q[0], frame.q[1], frame.q[2]]), at(map.lift(PlanePoint { a, b: frame.b_reference })));
    let (from, to) = (seen(&h, from), seen(&h, to));
    drag(&mut h, from, to);
    h.run_steps(120);
    let f = session(&h).frame();
    assert!((f.a[0] - a[0]).hypot(f.a[1] - a[1]) < 0.03, "{:?} for {a:?}", f.a);
    assert!(f.peaks.is_reactionless() && (f.b - frame.b).abs() < 1e-11);
}

fn dexterity_is_shown_with_its_key_where_there_is_a_workspace() {
    let mut h = window("case-3", Theme::Light);
    h.step();
    assert!(h.query_by_label("|det|").is_none());
    h.get_by_label("dexterity").click();
    h.run_steps(3);
    assert!(h.query_by_label("|det|").is_some() && h.query_by_label("0.139 m²").is_some());
    h.get_by_label("Tower").click();
    h.run_steps(3);
    assert!(h.get_by_label("dexterity").accesskit_node().is_disabled());
    h.get_by_label("3D").click();
    h.run_steps(3);
    // One measure after the other, then none.
    for symbol in ["√det JJ*", "|τ|/|F|"] {
        h.key_press(Key::J);
        h.run_steps(3);
        assert!(h.query_by_label(symbol).is_some(), "{symbol}");
    }
    h.key_press(Key::J);
    h.run_steps(3);
    assert!(h.query_by_label("dexterity").is_some() && h.query_by_label("|det|").is_none());
}

/// Runs side by side: by key, a row laid over, sorted by its head, this run kept; a second cursor shows differences.
fn runs_stand_side_by_side() {
    let mut h = window("case-1", Theme::Dark);
    h.run_steps(3);
    h.key_press(Key::C);
    h.run_steps(2);
    let comparison = |h: &Window| h.state().app_state().comparison().cloned();
    assert_eq!(comparison(&h).expect("on display").entries().len(), 5);
    h.get_by_label("Lay over: Reactionless").click();
    h.run_steps(2);
    assert_eq!(comparison(&h).expect("on display").shown().count(), 1);
    h.get_by_label("Sort by largest moment on the base, past a wheel").click();
    h.run_steps(2);
    assert_eq!(comparison(&h).expect("on display").sorted(), Some((1, false)));
    h.get_by_label("Keep this run").click();
    h.run_steps(2);
    assert!(comparison(&h).expect("on display").entries()[5].added_by_user);
    h.get_by_label("Remove case-1").click();
    h.run_steps(2);
    assert_eq!(comparison(&h).expect("on display").entries().len(), 5);
    // The other way opens in place of this one.
    h.get_by_label("Open Reactionless").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().task.kind, stillbase::session::scenario::TaskKind::Reactionless);
    h.key_press(Key::C);
    h.run_steps(2);
    assert!(comparison(&h).is_none());

    h.key_press(Key::S);
    h.run_steps(2);
    assert!(h.state().app_state().view_state().snapshots);
    let plot = h.get_by_label_contains("Torque over time").rect();
    h.event(egui::Event::ModifiersChanged(Modifiers::SHIFT));
    h.hover_at(plot.center());
    h.step();
    h.drag_at(plot.center());
    h.step();
    h.drop_at(plot.center());
    h.step();
    h.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    h.run_steps(2);
    assert!(h.state().app_state().view_state().mark.is_some(), "a second cursor");
    assert!(h.query_all_by_label_contains("Δτ").count() > 0, "differences");
    h.key_press(Key::Escape);
    h.run_steps(2);
    assert!(h.state().app_state().view_state().mark.is_none());
}
