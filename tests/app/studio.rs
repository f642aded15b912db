//! The design view: what is out of balance and where it comes from, what follows when it is kept, counterweights to take.

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::SessionCommand;
use stillbase::mechanics::machine::{Inertia, Link, Machine};
use stillbase::picture::scene::options::Handle;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::pointer::Pointer;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session};

use super::{Window, drag, session, type_into, window, window_of};
use crate::Test;

pub const TESTS: &[Test] = tests![
    bars_say_which_link_brings_what,
    a_centre_of_mass_is_dragged_and_the_others_follow,
    counterweights_are_taken_and_follow_a_length,
    what_cannot_be_balanced_is_told_and_changes_nothing,
    numbers_of_links_are_typed,
    single_numbers_are_held,
    what_is_asked_is_undone_and_saved,
    rotors_take_what_drives_give_to_the_base,
    inertia_and_length_of_a_link_are_typed,
    discs_keep_clear_and_serve_a_range_of_payloads,
    colours_tell_the_machines_of_the_front_apart,
    lengths_are_sought_and_taken,
    fronts_are_kept_and_stand_beside_each_other,
    equations_light_up_their_links,
    equations_follow_the_machine_and_are_remembered,
];

/// A window in which the bare bars of the reference are designed.
fn bare() -> Window {
    let case = Scenario::builtin("nine-link-bare").expect("built in");
    let mut h = window_of(case, Theme::Dark, 900.0);
    h.key_press(Key::D);
    h.run_steps(4);
    h
}

fn machine(h: &Window) -> &Machine {
    &session(h).scenario().machine
}

fn is_balanced(machine: &Machine) -> bool {
    let inertia = Inertia::of(machine);
    inertia.is_force_balanced() && inertia.is_invariant()
}

/// Where a handle of the design view is on the screen.
fn place(h: &Window, handle: Handle) -> egui::Pos2 {
    let scene = h.get_by_label_contains("Scene:").rect();
    let camera = *h.state().app_state().view_state().camera();
    let at = |x: usize, y: usize| scene.min + egui::vec2(x as f32, y as f32);
    let under = |pos: egui::Pos2| {
        let pair = |v: egui::Vec2| [f64::from(v.x), f64::from(v.y)];
        let pointer = Pointer { camera, size: pair(scene.size()), at: pair(pos - scene.min) };
        h.state().app_state().views().under(ViewKind::Design, &session(h).frame().into(), &pointer)
    };
    let (width, height) = (scene.width() as usize, scene.height() as usize);
    let all = (0..height).step_by(3).flat_map(|y| (0..width).step_by(3).map(move |x| at(x, y)));
    let found: Vec<_> = all.filter(|pos| under(*pos) == Some(handle)).collect();
    let sum = found.iter().fold(egui::Vec2::ZERO, |sum, pos| sum + pos.to_vec2());
    assert!(!found.is_empty(), "{handle:?} is nowhere");
    (sum / found.len() as f32).to_pos2()
}

fn bars_say_which_link_brings_what() {
    let mut h = window("case-3", Theme::Light);
    h.run_steps(2);
    h.key_press(Key::D);
    h.run_steps(3);
    assert_eq!(h.state().app_state().view_state().view, ViewKind::Design);
    for words in ["g₁, no force: residual 0 kg m", "C₁₂, no coupling: residual 0 kg m²"] {
        assert!(h.query_by_label_contains(words).is_some(), "{words}");
    }
    // Link 5 alone is made to weigh on drive 2.
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::at(&["link", "5", "com"], 0.05)));
    h.run_steps(3);
    let inertia = Inertia::of(machine(&h));
    let left = inertia.first_moment(1).re;
    let words = format!("g₂, no force: residual {left:.4} kg m").replace('-', "−");
    // Drive 2 is where link 5 brings most of what pulls its way; the pointer on it lights it up.
    let rect = h.get_by_label_contains(&words).rect();
    let mut lit = Vec::new();
    for x in (rect.left() as i32..rect.right() as i32).step_by(4) {
        h.hover_at(egui::pos2(x as f32, rect.top() + 12.0));
        h.run_steps(2);
        lit.extend(h.state().app_state().view_state().pointed.panel_object);
    }
    let links: Vec<usize> = [4, 3, 8].into_iter().filter(|i| lit.contains(&Handle::Link(*i))).collect();
    assert_eq!(links, [4, 3, 8], "links 5, 4 and 9 are in the bar: {lit:?}");
    h.key_press(Key::D);
    h.run_steps(2);
    assert_eq!(h.state().app_state().view_state().view, ViewKind::Flat);
}

fn a_centre_of_mass_is_dragged_and_the_others_follow() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::D);
    h.run_steps(3);
    let before = machine(&h).clone();
    h.get_by_label("Keep balanced").click();
    h.run_steps(3);
    h.get_by_label("link 9 stays").click();
    h.run_steps(2);
    let from = place(&h, Handle::Mass(0));
    let undone = session(&h).undo_count();
    drag(&mut h, from, from - egui::vec2(0.0, 12.0));
    h.run_steps(3);
    let after = machine(&h).clone();
    let moved = after.links()[0].com - before.links()[0].com;
    assert!(moved.abs() > 0.01, "link 1 by {moved} m");
    assert!(is_balanced(&after), "the others follow");
    assert!((after.links()[8].com - before.links()[8].com).abs() < 1e-12, "link 9 stays");
    let others = before.links().iter().zip(after.links()).filter(|(a, b)| a.com != b.com).count();
    assert!(others > 1, "{others} centres of mass have moved");
    // One drag is one change, saved and made again like any other.
    assert_eq!(session(&h).undo_count(), undone + 1);
    let again = Session::open(session(&h).to_scenario()).expect("it opens");
    assert_eq!(again.scenario().machine, after);
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(3);
    // As it was but for the rounding with which it was balanced at first.
    let close = |(a, b): (&Link, &Link)| (a.com - b.com).abs() < 1e-12 && a.mass == b.mass;
    assert!(machine(&h).links().iter().zip(before.links()).all(close));
}

fn counterweights_are_taken_and_follow_a_length() {
    let mut h = bare();
    assert!(h.query_by_label_contains("g₁, no force: residual 1.2750 kg m").is_some());
    h.get_by_label("behind the root").click();
    h.run_steps(3);
    h.get_by_label("least mass").click();
    h.run_steps(4);
    let added = |h: &Window| machine(h).spec().counterweights.iter().map(|weight| weight.mass).sum::<f64>();
    // The known least of these bars.
    assert!((added(&h) - 9.572_666_7).abs() < 1e-5, "{} kg", added(&h));
    assert!(is_balanced(machine(&h)));
    h.get_by_label("least inertia").click();
    h.run_steps(4);
    let inertia: f64 = Inertia::of(machine(&h)).momenta().iter().sum();
    assert!((inertia - 1.798_401_1).abs() < 1e-5, "{inertia} kg m²");
    h.get_by_label("Keep balanced").click();
    h.run_steps(3);
    let (links, weighed) = (machine(&h).spec().links.clone(), added(&h));
    let end = place(&h, Handle::End(0));
    drag(&mut h, end, end + egui::vec2(-4.0, 60.0));
    h.run_steps(4);
    assert!(is_balanced(machine(&h)), "the counterweights follow");
    assert!((added(&h) - weighed).abs() > 1e-3, "they weigh {} kg", added(&h));
    let length = |h: &Window| machine(h).resolved_links()[0].length;
    assert!((length(&h) - 0.5).abs() > 0.02, "link 1 is {} m long", length(&h));
    let now = &machine(&h).spec().links;
    assert!(links.iter().zip(now).all(|(a, b)| (a.mass, a.com) == (b.mass, b.com)), "the links stay");
}

fn what_cannot_be_balanced_is_told_and_changes_nothing() {
    let mut h = bare();
    h.get_by_label("heaviest").click();
    h.run_steps(3);
    type_into(&mut h, "heaviest kg", "0.5");
    assert!(h.query_by_label_contains("no counterweights balance these links within these bounds").is_some());
    let wider = |h: &Window| h.query_all_by_label_contains("kg a counterweight").next().is_some();
    assert!(h.query_by_label_contains("would do").is_some() && wider(&h));
    h.query_all_by_label_contains("kg a counterweight").next().expect("a proposal").click();
    h.run_steps(6);
    assert!(!wider(&h) && h.query_by_label_contains("no counterweights balance").is_none());
    type_into(&mut h, "heaviest kg", "0.5");
    // Nor does the centre of mass of one link alone.
    for link in 2..=9 {
        h.get_by_label(&format!("link {link} stays")).click();
        h.run_steps(1);
    }
    let before = machine(&h).clone();
    h.get_by_label("Keep balanced").click();
    h.run_steps(3);
    assert!(h.query_all_by_label_contains("no balance within these limits").next().is_some());
    assert!(!session(&h).scenario().design.keep_balanced);
    assert_eq!(*machine(&h), before);
}

fn numbers_of_links_are_typed() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::D);
    h.run_steps(3);
    type_into(&mut h, "mass of link 5 kg", "800 g");
    assert_eq!(machine(&h).links()[4].mass, 0.8);
    type_into(&mut h, "centre of mass of link 5 m", "-2 cm");
    assert_eq!(machine(&h).links()[4].com, -0.02);
    assert!(!is_balanced(machine(&h)));
}

/// What a label that begins so says.
fn said(h: &Window, begins: &str) -> String {
    let label = |node: &egui_kittest::Node<'_>| {
        let node = node.accesskit_node();
        node.label().or_else(|| node.value()).unwrap_or_default()
    };
    let found = h.query_all_by_label_contains(begins).map(|node| label(&node)).next();
    found.unwrap_or_else(|| panic!("nothing says {begins}"))
}

fn equations_light_up_their_links() {
    let mut h = window("case-3", Theme::Light);
    h.run_steps(2);
    h.key_press(Key::E);
    h.run_steps(4);
    let view_state = |h: &Window| h.state().app_state().view_state().clone();
    assert!(view_state(&h).view == ViewKind::Design && view_state(&h).arrangement.shows_equations);
    h.get_by_label("Equation 7").click();
    h.run_steps(6);
    let line = "(7) g₁: m₁ l_c1 + m₄ l_c4 + m₆ l_c6 + (m₅ + m₇ + m₈ + m₉) l₁ = 0";
    let rect = h.get_by_label_contains(line).rect();
    let mut lit = Vec::new();
    for y in (rect.top() as i32..rect.bottom() as i32).step_by(6) {
        for x in (rect.left() as i32..rect.right() as i32).step_by(8) {
            h.hover_at(egui::pos2(x as f32, y as f32));
            h.run_steps(1);
            let links = view_state(&h).pointed.lit_links;
            if !links.is_empty() && !lit.contains(&links) {
                lit.push(links);
            }
        }
    }
    lit.sort();
    assert_eq!(lit, [vec![0], vec![3], vec![4, 6, 7, 8], vec![5]]);
    // Beside it nothing is lit any more.
    h.hover_at(egui::pos2(500.0, 300.0));
    h.run_steps(2);
    assert!(view_state(&h).pointed.lit_links.is_empty());
    // The key leads back.
    h.key_press(Key::E);
    h.run_steps(3);
    assert!(
        !view_state(&h).arrangement.shows_equations
            && h.query_by_label_contains("g₁, no force: residual 0 kg m").is_some()
    );
}

fn equations_follow_the_machine_and_are_remembered() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::D);
    h.run_steps(3);
    h.get_by_label("Equations tab").click();
    h.run_steps(3);
    h.get_by_label("Equation 8").click();
    h.run_steps(6);
    assert!(said(&h, "(8) No coupling").ends_with("holds"));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::at(&["link", "5", "com"], 0.05)));
    h.run_steps(3);
    let left = Inertia::of(machine(&h)).coupling(0, 1).re;
    assert!(said(&h, "(8) No coupling").contains("off by 0.0214"), "{left}");
    let words = format!("= {left:.4} kg m²").replace('-', "− ");
    assert!(said(&h, "(8) C₁₂: ").ends_with(&words), "{words} in {}", said(&h, "(8) C₁₂: "));
    // What has no meaning any more says so.
    h.get_by_label("Equation 11").click();
    h.run_steps(6);
    assert!(h.query_by_label_contains("(11) Motion of a balanced machine: not for this machine").is_some());
    let liked = h.state().app_state().preferences([1280.0, 800.0]);
    assert!(liked.shows_equations);
    let again = stillbase::app::AppState::new(Scenario::builtin("case-3").expect("built in"), Theme::Dark);
    assert!(again.expect("it starts").with_preferences(&liked).view_state().arrangement.shows_equations);
    h.get_by_label("Balance tab").click();
    h.run_steps(3);
    assert!(!h.state().app_state().preferences([1280.0, 800.0]).shows_equations);
}

/// What a designer asks for is a change like any other, and makes no frame anew.
fn what_is_asked_is_undone_and_saved() {
    let mut h = bare();
    let (known, undone) = (session(&h).frames().revision().mark(), session(&h).undo_count());
    for words in ["clear of pins", "link 4 stays"] {
        h.get_by_label(words).click();
        h.run_steps(3);
    }
    type_into(&mut h, "clear of pins mm", "8");
    let asked = session(&h).scenario().design.clone();
    assert_eq!((asked.clearance, asked.fixed.len()), (Some(0.008), 1));
    assert_eq!(session(&h).undo_count(), undone + 3);
    assert!(h.state().app_state().changes().1, "it is in no file yet");
    let saved = session(&h).to_scenario().to_toml();
    let again = Scenario::parse(&saved, "again.toml", None).expect("its own file");
    assert_eq!(Session::open(again).expect("it opens").scenario().design, asked);
    for clearance in [Some(0.005), Some(0.005), None] {
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(3);
        assert_eq!(session(&h).scenario().design.clearance, clearance);
    }
    assert_eq!((session(&h).scenario().design.fixed.len(), session(&h).undo_count()), (0, undone));
    let frames = session(&h).frames();
    assert!(frames.revision().unchanged_since(&known) >= frames.len(), "no frame is made anew");
}

/// A number that stays while others of its kind follow, and one that may go only so far.
fn single_numbers_are_held() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::D);
    h.run_steps(3);
    h.get_by_label("Keep balanced").click();
    h.run_steps(3);
    let before = machine(&h).clone();
    h.get_by_label("centre of mass of link 9 m").click_secondary();
    h.run_steps(3);
    h.get_by_label("stays").click();
    h.run_steps(3);
    h.key_press(Key::Escape);
    h.run_steps(3);
    h.get_by_label("mass of link 2 kg").click_secondary();
    h.run_steps(3);
    h.get_by_label("may change").click();
    h.run_steps(3);
    let holds = &session(&h).scenario().design.hold;
    assert_eq!(holds.keys().collect::<Vec<_>>(), ["link.2.mass", "link.9.com"]);
    h.state_mut()
        .app_state_mut()
        .carry_out(SessionCommand::Edit(Edit::at(&["link", "1", "com"], before.links()[0].com - 0.01)));
    h.run_steps(3);
    let after = machine(&h);
    assert!(is_balanced(after));
    assert_eq!(after.links()[8].com, before.links()[8].com, "it stays");
    assert!(after.links()[1].mass != before.links()[1].mass, "it may change");
    assert!(after.links()[2].mass == before.links()[2].mass, "nobody said that it may");
}

/// What is asked of counterweights is typed, and those that are taken keep to it.
fn discs_keep_clear_and_serve_a_range_of_payloads() {
    let mut h = bare();
    h.get_by_label("clear of pins").click();
    h.run_steps(3);
    h.get_by_label("payload from, to").click();
    h.run_steps(3);
    let brief = &session(&h).scenario().design;
    assert_eq!((brief.clearance, brief.payload), (Some(0.005), Some([0.0, 0.2])));
    h.get_by_label("least inertia").click();
    h.run_steps(4);
    let taken = machine(&h);
    assert!(taken.spec().payload.mass == 0.1, "it holds the middle");
    for weight in &taken.spec().counterweights {
        let link = taken.links().iter().position(|link| link.name == weight.link).expect("a link");
        let nearest = taken.resolved_links()[link].pins.iter().map(|pin| (pin - weight.at).abs());
        assert!(nearest.fold(f64::INFINITY, f64::min) > weight.radius + 0.005 - 1e-6, "link {}", weight.link);
    }
    assert!(h.query_by_label_contains("Imbalance over the payloads: at worst 0.05").is_some());
}

/// What is found is lighter than with the lengths as they are, reaches as far as it has to, and is one step to undo.
fn lengths_are_sought_and_taken() {
    // What is scrolled out of view cannot be clicked.
    let mut h = window_of(Scenario::builtin("nine-link-bare").expect("built in"), Theme::Dark, 1300.0);
    h.key_press(Key::D);
    h.run_steps(4);
    let before = session(&h).scenario().clone();
    h.get_by_label("least mass").click();
    h.run_steps(4);
    let added = |h: &Window| machine(h).spec().counterweights.iter().map(|weight| weight.mass).sum::<f64>();
    let with_these = added(&h);
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(3);
    h.get_by_label("Lengths").click();
    h.run_steps(6);
    h.get_by_label("l5").click();
    h.run_steps(3);
    assert_eq!(session(&h).scenario().design.length.keys().collect::<Vec<_>>(), ["l5"]);
    h.get_by_label("Seek lengths with least mass").click();
    h.run_steps(4);
    assert!(h.query_by_label_contains("proved the least").is_some(), "how it was found");
    // What has to be reached asks anew.
    h.get_by_label("reach at least").click();
    h.run_steps(3);
    assert!(h.query_by_label("take these lengths").is_none());
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(3);
    h.get_by_label("Seek lengths with least mass").click();
    h.run_steps(4);
    h.get_by_label("take these lengths").click();
    h.run_steps(4);
    let taken = machine(&h);
    assert!(is_balanced(taken) && added(&h) < with_these - 0.01, "{} kg of {with_these} kg", added(&h));
    assert!(taken.reach() < before.machine.reach(), "nothing asks for reach");
    assert!(h.query_by_label("take these lengths").is_none(), "they are taken");
    for _ in 0..2 {
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(3);
    }
    assert_eq!(*session(&h).scenario(), before);
}

/// A front that was kept stays as it was whatever becomes of the machine; what has none says so.
fn fronts_are_kept_and_stand_beside_each_other() {
    let mut h = bare();
    h.get_by_label("keep this front").click();
    h.run_steps(4);
    let kept = |h: &Window| {
        let row = h.query_by_label_contains(" kg, ");
        row.and_then(|row| row.accesskit_node().value().or_else(|| row.accesskit_node().label())).unwrap_or_default()
    };
    let before = kept(&h);
    assert!(!before.is_empty());
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("design.density", 11_340.0)));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("length.l1", 0.6)));
    h.run_steps(4);
    assert_eq!(kept(&h), before);
    h.get_by_label("Add a front").click();
    h.run_steps(3);
    h.get_by_label("two-drive").click();
    h.run_steps(4);
    h.get_by_label("Remove the front of nine-link-bare, steel, reach 1.26 m").click();
    h.run_steps(3);
    assert!(h.query_by_label("Remove the front of nine-link-bare, steel, reach 1.26 m").is_none());
    assert!(h.query_by_label("Remove the front of two-drive").is_some());
}

fn colours_tell_the_machines_of_the_front_apart() {
    let mut h = bare();
    for words in ["greatest torque", "workspace", "greatest |g_k| if 1 % and 0.5 mm off"] {
        h.get_by_label("what the colours of the front tell").click();
        h.run_steps(3);
        h.get_by_label(words).click();
        h.run_steps(3);
        assert_eq!(h.state().app_state().view_state().front_by.map(|by| by.words()[0]), Some(words));
    }
}

/// Of the link that is chosen; a length that several links share changes for all of them.
fn inertia_and_length_of_a_link_are_typed() {
    let mut h = bare();
    h.get_by_label("link in detail").click();
    h.run_steps(3);
    h.get_by_label("link 4").click();
    h.run_steps(3);
    type_into(&mut h, "inertia of link 4 kg m²", "0.02");
    type_into(&mut h, "length of link 4 m", "0.52");
    let machine = machine(&h);
    assert_eq!(machine.links()[3].inertia, 0.02);
    for link in [0, 3, 5] {
        assert_eq!(machine.resolved_links()[link].length, 0.52);
    }
}

/// A ratio that may be chosen is, and the change is one step that is undone.
fn rotors_take_what_drives_give_to_the_base() {
    let case = Scenario::builtin("nine-link-bare").expect("built in");
    let geared = case.machine.set("drive.1.rotor.inertia", "0.02").and_then(|m| m.set("drive.1.rotor.ratio", "20"));
    let machine_of = geared.expect("in range");
    let mut h = window_of(Scenario { machine: machine_of.clone(), ..case }, Theme::Dark, 900.0);
    h.key_press(Key::D);
    h.run_steps(4);
    h.get_by_label("ratio of drive 1").click();
    h.run_steps(3);
    h.get_by_label("least momentum").click();
    h.run_steps(4);
    let taken = machine(&h);
    assert!(is_balanced(taken));
    assert!(Inertia::of(taken).momentum(0).abs() < 1e-5, "{}", Inertia::of(taken).momentum(0));
    assert!(taken.spec().drives[0].rotor.is_some_and(|rotor| rotor.ratio < -1.0 && rotor.inertia == 0.02));
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(3);
    assert_eq!(*machine(&h), machine_of);
}
