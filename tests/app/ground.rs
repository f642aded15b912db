//! Machines with links that keep their orientation, in the window.

use egui::Key;
use stillbase::mechanics::machine::{Attach, GROUND, Length, LinkPoint, Machine, PlaceOnLink, builtins};
use stillbase::picture::scene::palette::Theme;
use stillbase::session::for_machine;
use stillbase::session::scenario::Scenario;

use super::{drag, seen, session, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![a_platform_is_shown_and_nothing_turns_it];

/// The machine of the paper with a platform without offset at its end effector.
fn with_platform() -> Machine {
    let mut spec = builtins()[0].spec().clone();
    let end = spec.end_effector.clone().expect("an end effector");
    let mut platform = spec.links[0].clone();
    platform.name = "platform".into();
    platform.drive = GROUND.into();
    platform.attach = Attach::On(LinkPoint { link: end.link, at: end.at });
    platform.length = Length::Metres(0.2);
    (platform.mass, platform.inertia, platform.com, platform.direction) = (1e-3, 1e-6, 0.0, 1);
    let mut upright = platform.clone();
    upright.name = "upright".into();
    upright.attach = Attach::On(LinkPoint { link: "platform".into(), at: PlaceOnLink::default() });
    spec.links.extend([platform, upright]);
    Machine::new(spec).expect("a machine")
}

fn a_platform_is_shown_and_nothing_turns_it() {
    let machine = with_platform();
    let scenario = for_machine(&Scenario::builtin("case-3").expect("built in"), &machine);
    let mut h = window_of(scenario, Theme::Dark, 800.0);
    h.run_steps(4);
    let before = *session(&h).frame();
    let tip = before.end_effector;
    // Along both links that never turn, and back.
    for along in [0.05, 0.1, 0.15, 0.25, 0.35] {
        let height = h.state().app_state().stage().handle_height();
        let from = seen(&h, [tip.re + along, tip.im, height]);
        drag(&mut h, from, from + egui::vec2(20.0, 30.0));
        h.run_steps(2);
    }
    assert_eq!(session(&h).frame().q, before.q);
    // The design view, its equations, joint space and the run.
    for key in [Key::D, Key::E, Key::E, Key::D, Key::V, Key::V, Key::V, Key::C, Key::C, Key::Space] {
        h.key_press(key);
        h.run_steps(6);
    }
    assert!(session(&h).frame().time > 0.0);
}
