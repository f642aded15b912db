//! The tour and the hints in scenes of their own: what the person did before is untouched, whenever they are left.

use egui::Key;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{AppState, Command, Preferences, SessionCommand, ViewChange, WindowCommand};
use stillbase::picture::charts::choice::PlotChange;
use stillbase::picture::scene::options::Handle;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::{Window, on_screen, session, window, window_of};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    the_tour_hands_back_an_edited_session_at_every_step,
    hints_hand_back_what_was_there,
    a_file_is_of_the_own_session,
    a_machine_without_an_amber_area_says_why,
    cards_cover_nothing_that_they_mention,
];

fn tell(h: &mut Window, command: impl Into<Command>) {
    h.state_mut().app_state_mut().carry_out(command);
    h.run_steps(3);
}

/// A session with edits, one of them undone, a time, plots and a view of its own.
fn edited() -> Window {
    let mut h = window("case-2", Theme::Dark);
    h.run_steps(2);
    for (path, value) in [("plant.payload.mass", 0.2), ("plant.friction.viscous", 0.1), ("task.time", 2.0)] {
        tell(&mut h, SessionCommand::Edit(Edit::set(path, value)));
        tell(&mut h, SessionCommand::EndGesture);
    }
    tell(&mut h, SessionCommand::Undo);
    tell(&mut h, ViewChange::Kind(ViewKind::Space));
    tell(&mut h, ViewChange::Look(stillbase::app::CameraMove::Turn([0.3, 0.1])));
    tell(&mut h, ViewChange::Charts(PlotChange::Plot("torque/1".into())));
    tell(&mut h, ViewChange::Speed(0.5));
    tell(&mut h, SessionCommand::Seek(0.4));
    h.run_steps(3);
    h
}

/// What must be as before: the session, its history, the instant, whether it is saved, the view and the plots.
fn state(app_state: &AppState) -> impl PartialEq + std::fmt::Debug + use<> {
    let (own, view_state) = (app_state.session(), app_state.view_state());
    (
        (own.to_scenario(), own.history().map(str::to_owned).collect::<Vec<_>>(), own.undo_count()),
        (own.redo_title().map(str::to_owned), own.frame().time, own.is_playing()),
        (app_state.changes(), app_state.title(), app_state.left_off()),
        (view_state.view, view_state.cameras, view_state.charts.clone(), view_state.speed),
        (view_state.arrangement.clone(), view_state.pair.clone(), view_state.below),
    )
}

/// What the journal is made of: it must be that of the person's own session at any time.
fn kept(app_state: &AppState) -> impl PartialEq + std::fmt::Debug + use<> {
    (app_state.own_session().to_scenario(), app_state.changes(), app_state.left_off(), app_state.may_leave())
}

fn the_tour_hands_back_an_edited_session_at_every_step() {
    let mut h = edited();
    let (before, journal) = (state(h.state().app_state()), kept(h.state().app_state()));
    for left_at in 0..7 {
        tell(&mut h, WindowCommand::Tour(true));
        for step in 0..=left_at {
            assert!(h.query_by_label(&format!("{} of 7", step + 1)).is_some(), "step {}", step + 1);
            // Every step is done by its button and spoilt by hand.
            for label in ["Show me", "Hang 0.3 kg on it", "Take it off", "Start time"] {
                if h.query_by_label(label).is_some() {
                    h.get_by_label(label).click();
                    h.run_steps(4);
                }
            }
            let b = session(&h).b_aim();
            tell(&mut h, SessionCommand::Edit(Edit::PoseB { b: b + 0.1 }));
            tell(&mut h, SessionCommand::Edit(Edit::DragTarget { x: 0.5, y: 0.6 }));
            tell(&mut h, ViewChange::Charts(PlotChange::Plot("torque/2".into())));
            h.run_steps(10);
            assert_ne!(session(&h).to_scenario(), h.state().app_state().own_session().to_scenario());
            assert_eq!(kept(h.state().app_state()), journal, "the journal keeps what is the person's own");
            if step < left_at {
                tell(&mut h, WindowCommand::TurnTour(true));
            }
        }
        match left_at {
            0 | 3 => h.get_by_label("Leave the tour").click(),
            6 => h.get_by_label("End: tour").click(),
            _ => h.key_press(Key::Escape),
        }
        h.run_steps(4);
        assert!(h.query_by_label_contains(" of 7").is_none(), "left at {}", left_at + 1);
        assert_eq!(state(h.state().app_state()), before, "left at {}", left_at + 1);
    }
    tell(&mut h, SessionCommand::Redo);
    assert_eq!(session(&h).scenario().task.time, 2.0, "what was undone before the tour can be redone after it");
}

fn hints_hand_back_what_was_there() {
    let mut h = edited();
    let (before, journal) = (state(h.state().app_state()), kept(h.state().app_state()));
    tell(&mut h, WindowCommand::Hints);
    h.run_steps(10);
    assert!(h.query_by_label("Drag the white ring.").is_some());
    assert!(session(&h).script().is_empty(), "their scene is the task as it was opened");
    assert_eq!(kept(h.state().app_state()), journal);
    tell(&mut h, SessionCommand::Edit(Edit::DragTarget { x: 0.45, y: 0.55 }));
    h.run_steps(10);
    h.key_press(Key::Escape);
    h.run_steps(4);
    assert_eq!(state(h.state().app_state()), before);
    // A change of a setting is work of the person's own: the hints end, and it applies to the own session.
    tell(&mut h, WindowCommand::Hints);
    tell(&mut h, SessionCommand::Edit(Edit::set("plant.payload.mass", 0.35)));
    let own = session(&h);
    assert_eq!((own.scenario().plant.payload.mass, own.scenario().name.as_str()), (0.35, "case-2"));
    assert!(own.undo_count() == 3 && h.query_by_label("Drag the white ring.").is_none());
    // At the first start nothing was done yet: the hints accompany the person's own session, and it is kept.
    let start = AppState::new(Scenario::builtin("case-3").expect("built in"), Theme::Dark).expect("it starts");
    let mut start = start.with_preferences(&Preferences::default());
    start.carry_out(SessionCommand::Edit(Edit::DragTarget { x: 0.45, y: 0.55 }));
    assert!(!start.may_leave() && start.own_session().is_dragged());
    start.carry_out(WindowCommand::SkipHints);
    assert!(start.session().is_dragged() && start.title().contains('*'));
}

/// Saving, opening and closing are about the person's own session, also from within the tour.
fn a_file_is_of_the_own_session() {
    let folder = Folder::new("lessons");
    let mut h = edited();
    let own = session(&h).to_scenario();
    tell(&mut h, WindowCommand::Tour(true));
    tell(&mut h, SessionCommand::SaveFile(folder.path("mine.toml")));
    h.run_steps(3);
    assert!(h.state().app_state().view_state().open.tour.is_none(), "the tour has ended");
    let saved = std::fs::read_to_string(folder.path("mine.toml")).expect("saved");
    assert!(saved.ends_with(&own.to_toml()), "{saved}");
    assert!(!h.state().app_state().changes().1, "nothing is unsaved");
    tell(&mut h, SessionCommand::Edit(Edit::set("task.time", 3.0)));
    tell(&mut h, WindowCommand::Tour(true));
    assert!(!h.state().app_state().may_leave(), "the own session is in no file");
    tell(&mut h, WindowCommand::Quit);
    assert!(h.query_by_label("Save before closing?").is_some() || h.query_by_label("Save…").is_some());
    assert_eq!(session(&h).scenario().task.time, 3.0);
}

fn a_machine_without_an_amber_area_says_why() {
    let mut h = window("nine-link-bare", Theme::Dark);
    h.run_steps(2);
    let Err(why) = session(&h).run().pose_space() else { panic!("it has no planes") };
    let why = why.to_string();
    tell(&mut h, WindowCommand::Hints);
    assert!(h.query_by_label_contains("has nothing amber").is_some());
    assert!(h.query_by_label_contains(&format!("The reason: {why}")).is_some());
    tell(&mut h, WindowCommand::SkipHints);
    tell(&mut h, WindowCommand::Tour(true));
    assert!(h.query_by_label_contains("has no amber area").is_some(), "the tour says it, too");
    assert_eq!(session(&h).scenario().machine.name(), "nine-link");
    tell(&mut h, WindowCommand::Tour(false));
    assert_eq!(session(&h).scenario().machine.name(), "nine-link-bare");
    // On a machine with a curve in place of an area the words follow.
    let mut h = window("two-drive", Theme::Dark);
    tell(&mut h, WindowCommand::Hints);
    assert!(h.query_by_label_contains("amber curve").is_some());
}

/// The card of each step stands away from what the step mentions, in small windows too.
fn cards_cover_nothing_that_they_mention() {
    for size in [[1440.0, 900.0], [1100.0, 640.0]] {
        let mut h = window_of(Scenario::builtin("case-3").expect("built in"), Theme::Dark, 800.0);
        h.set_size(size.into());
        h.run_steps(2);
        tell(&mut h, WindowCommand::Tour(true));
        for step in 1..=7 {
            h.run_steps(4);
            let card = h.ctx.memory(|m| m.area_rect(egui::Id::unique("tour"))).expect("a card");
            let target = session(&h).frame().end_effector;
            let places = match step {
                1 | 2 | 4 => vec![on_screen(&h, 0.0, 0.0)],
                3 | 5 => vec![on_screen(&h, target.re, target.im)],
                _ => {
                    let stage = h.state().app_state().stage().clone();
                    let shown = session(&h).frame().into();
                    vec![super::seen(&h, stage.handle(Handle::Ring, &shown).expect("a ring"))]
                }
            };
            for place in places {
                assert!(!card.contains(place), "{size:?}, step {step}: {card:?} lies over {place:?}");
            }
            tell(&mut h, WindowCommand::TurnTour(true));
        }
    }
}
