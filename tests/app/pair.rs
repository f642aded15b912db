//! Shake and still: the run on display and another one in one view.

use egui::Key;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{Layout, Pair, PairWith, SessionCommand, Switch, ViewChange};
use stillbase::picture::scene::palette::Theme;
use stillbase::session::Edit;
use stillbase::study::comparison::Alternative;

use super::{Window, painted, session, window};
use crate::Test;

pub const TESTS: &[Test] = tests![
    two_runs_are_brought_back_at_any_time,
    any_run_stands_beside_the_own_one,
    what_cannot_be_run_says_why,
    no_run_is_made_that_is_not_shown,
];

fn tell(h: &mut Window, change: ViewChange) {
    h.state_mut().app_state_mut().carry_out(change);
    h.run_steps(3);
}

fn beside(h: &mut Window, with: PairWith) {
    tell(h, ViewChange::Pair(Pair { with, above: None, demonstrates: false }));
}

fn scene(h: &Window) -> egui::Rect {
    h.get_by_label_contains("Scene:").rect()
}

fn two_runs_are_brought_back_at_any_time() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(0.3));
    h.run_steps(3);
    let (whole, before) = (scene(&h), session(&h).to_scenario());
    h.key_press(Key::Y);
    h.run_steps(4);
    assert!(painted(&h).iter().any(|text| text == "Straight line"), "{:?}", painted(&h));
    let half = scene(&h);
    assert!(half.width() < whole.width() || half.height() < whole.height());
    assert_eq!((session(&h).to_scenario(), session(&h).frame().time), (before, 0.3), "nothing is changed");
    // One above the other, and in the layout for an audience.
    let pair = h.state().app_state().view_state().pair.clone().expect("two runs");
    for (above, wide) in [(true, true), (false, false)] {
        tell(&mut h, ViewChange::Pair(Pair { above: Some(above), ..pair.clone() }));
        assert_eq!((scene(&h).width() - whole.width()).abs() < 1.0, wide);
    }
    tell(&mut h, ViewChange::Layout(Layout::Present));
    assert!(painted(&h).iter().any(|text| text == "Straight line"));
    h.key_press(Key::Escape);
    h.run_steps(3);
    let view_state = h.state().app_state().view_state();
    assert!(view_state.pair.is_none() && view_state.arrangement.layout == Layout::Present, "Esc closes the pair first");
}

fn any_run_stands_beside_the_own_one() {
    let mut h = window("case-1", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::Y);
    h.run_steps(4);
    assert!(painted(&h).iter().any(|text| text == "Reactionless"), "beside a shaking run stands the still one");
    // A branch, and another machine.
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("plant.payload.mass", 0.3)));
    h.run_steps(2);
    beside(&mut h, PairWith::Machine("nine-link-table-1".into()));
    assert!(painted(&h).iter().any(|text| text == "Machine nine-link-table-1"));
    let kept = session(&h).to_scenario();
    beside(&mut h, PairWith::Kept("Kept: mine".into(), Box::new(kept)));
    assert!(painted(&h).iter().any(|text| text == "Kept: mine"));
    // It follows the session.
    beside(&mut h, PairWith::Way(Alternative::StraightLine));
    let before = painted(&h);
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("task.time", 0.5)));
    h.run_steps(4);
    assert_ne!(painted(&h), before);
}

fn what_cannot_be_run_says_why() {
    let mut h = window("case-3", Theme::Light);
    h.run_steps(2);
    beside(&mut h, PairWith::Machine("two-drive".into()));
    let said = painted(&h);
    let ran = said.iter().any(|text| text.starts_with("N m"));
    assert!(ran || said.iter().any(|text| text.starts_with("This cannot be run: ")), "{said:?}");
}

fn no_run_is_made_that_is_not_shown() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::Y);
    h.run_steps(3);
    tell(&mut h, ViewChange::Switch(Switch::Pair, false));
    assert!(!painted(&h).iter().any(|text| text == "Straight line"));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("task.time", 0.5)));
    h.run_steps(3);
    assert!(!h.state().app_state().is_working());
}
