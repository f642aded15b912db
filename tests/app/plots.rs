//! Plots, as hands and keys use them: the time they show, their curves, signals that are sought, and files of them.

use egui::accesskit::Toggled;
use egui::{Event, Key, Modifiers, MouseWheelUnit, Pos2, TouchPhase, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::export::{PictureForm, RowForm};
use stillbase::app::{Command, Message, PlotFile, SessionCommand, ViewChange};
use stillbase::files::table::signals;
use stillbase::picture::charts::choice::PlotChange;
use stillbase::picture::scene::palette::Theme;
use stillbase::session::scenario::Scenario;

use super::{Window, drag, session, window, window_of};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    hands_move_the_time_that_plots_show,
    the_plain_wheel_scrolls_the_panel,
    hands_move_the_values_that_a_plot_shows,
    keys_zoom_mark_and_show_all,
    a_curve_goes_and_comes_by_its_name,
    a_signal_is_sought_and_plotted_by_keys_alone,
    one_signal_stands_against_another,
    values_under_the_pointer_are_those_of_the_frame,
    a_plot_is_written_to_files,
    plots_look_as_they_should,
];

fn after_case(case: &str, theme: Theme, height: f32) -> Window {
    let mut h = window_of(Scenario::builtin(case).expect("built in"), theme, height);
    h.run_steps(2);
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(1.0));
    h.run_steps(2);
    h
}

fn range(h: &Window) -> Option<[f64; 2]> {
    h.state().app_state().view_state().charts.range
}

/// Where a time stands in a plot that shows one second from 0 on, some points aside of what rounding does.
fn at_share(h: &Window, plot: &str, share: f32) -> Pos2 {
    let rect = h.get_by_label_contains(plot).rect();
    let left = rect.left() + stillbase::picture::charts::figure::LEFT_MARGIN;
    pos2(left + share * (rect.right() - 2.0 - left), rect.center().y - 8.0)
}

fn wheel(h: &mut Window, at: Pos2, delta: f32, modifiers: Modifiers) {
    h.hover_at(at);
    h.step();
    h.event(Event::ModifiersChanged(modifiers));
    h.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, delta),
        phase: TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers,
    });
    h.run_steps(12);
    h.event(Event::ModifiersChanged(Modifiers::NONE));
    h.step();
}

fn press(h: &mut Window, at: Pos2) {
    h.hover_at(at);
    h.step();
    h.drag_at(at);
    h.step();
    h.drop_at(at);
    h.run_steps(2);
}

fn hands_move_the_time_that_plots_show() {
    let mut h = after_case("case-1", Theme::Dark, 800.0);
    // A click shows an instant; dragged where everything is seen, it goes along.
    let at = at_share(&h, "Torque over time", 0.3);
    press(&mut h, at);
    assert!((session(&h).frame().time - 0.3).abs() < 0.006, "{}", session(&h).frame().time);
    let to = at_share(&h, "Torque over time", 0.6);
    drag(&mut h, at, to);
    assert!((session(&h).frame().time - 0.6).abs() < 0.006 && range(&h).is_none());
    // Ctrl and the wheel go closer to the time under the pointer, which stays there.
    let at = at_share(&h, "Turning moment on the base over time", 0.25);
    wheel(&mut h, at, 120.0, Modifiers::COMMAND);
    let [from, to] = range(&h).expect("closer");
    let share = (0.25 - from) / (to - from);
    assert!(to - from < 0.8 && (share - 0.25).abs() < 0.02, "{from} to {to}: {share}");
    // Now there is something to pan: by half of the width.
    let way = [0.75, 0.25].map(|share| at_share(&h, "Torque over time", share));
    drag(&mut h, way[0], way[1]);
    let [next, _] = range(&h).expect("moved");
    let want = (from + 0.5 * (to - from)).min(1.0 - (to - from));
    assert!((next - want).abs() < 0.02, "from {from} to {next}, want {want}");
    let before = session(&h).frame().time;
    // Shift drag chooses a range; the instant stays.
    let [from, to] = range(&h).expect("moved");
    let way = [0.2, 0.6].map(|share| at_share(&h, "Torque over time", share));
    h.event(Event::ModifiersChanged(Modifiers::SHIFT));
    drag(&mut h, way[0], way[1]);
    h.event(Event::ModifiersChanged(Modifiers::NONE));
    h.run_steps(2);
    let [a, b] = range(&h).expect("chosen");
    let want = [0.2, 0.6].map(|share| from + share * (to - from));
    assert!((a - want[0]).abs() < 0.01 && (b - want[1]).abs() < 0.01, "{a} to {b}, want {want:?}");
    assert_eq!(session(&h).frame().time, before);
    // A double click shows all of it again.
    let at = at_share(&h, "Torque over time", 0.5);
    for _ in 0..2 {
        h.drag_at(at);
        h.step();
        h.drop_at(at);
        h.step();
    }
    h.run_steps(2);
    assert_eq!(range(&h), None);
    // A cursor is a handle: the second one moves alone.
    h.state_mut().app_state_mut().carry_out(ViewChange::Mark(Some(0.2)));
    h.run_steps(2);
    let before = session(&h).frame().time;
    let way = [0.2, 0.4].map(|share| at_share(&h, "Force on the base over time", share));
    drag(&mut h, way[0], way[1]);
    let mark = h.state().app_state().view_state().mark.expect("still there");
    assert!((mark - 0.4).abs() < 0.01 && session(&h).frame().time == before, "{mark}");
}

fn the_plain_wheel_scrolls_the_panel() {
    let mut h = after_case("case-1", Theme::Light, 600.0);
    let place = |h: &Window| h.get_by_label_contains("Torque over time").rect().top();
    let (before, at) = (place(&h), at_share(&h, "Turning moment on the base over time", 0.5));
    wheel(&mut h, at, -60.0, Modifiers::NONE);
    assert!(place(&h) < before - 20.0, "from {before} to {}", place(&h));
    assert_eq!(range(&h), None);
}

/// The numbers beside a plot are dragged along and gone closer to; the plain wheel scrolls there too.
fn hands_move_the_values_that_a_plot_shows() {
    let mut h = after_case("case-1", Theme::Dark, 600.0);
    let name = "Turning moment on the base";
    let values = |h: &Window| h.state().app_state().view_state().charts.changes.get(name).and_then(|c| c.values);
    let numbers = |h: &Window| {
        h.get_by_label_contains("Turning moment on the base over time").rect().left_center() + vec2(12.0, -8.0)
    };
    let (at, time) = (numbers(&h), session(&h).frame().time);
    h.hover_at(at);
    h.run_steps(40);
    assert!(h.query_by_label_contains("Drag: along the values").is_some(), "it is said on hover");
    wheel(&mut h, at, 120.0, Modifiers::COMMAND);
    let [low, high] = values(&h).expect("closer");
    assert!(high - low > 0.1 && range(&h).is_none(), "{low} to {high}; time stays");
    let inside = at_share(&h, "Turning moment on the base over time", 0.5);
    wheel(&mut h, inside, 120.0, Modifiers::ALT);
    let [from, to] = values(&h).expect("closer still");
    assert!(to - from < 0.8 * (high - low) && range(&h).is_none(), "{from} to {to}");
    assert_eq!(
        h.get_by_label_contains("Turning moment on the base over time").rect().left_center() + vec2(12.0, -8.0),
        at
    );
    drag(&mut h, at, at + vec2(0.0, 20.0));
    let [moved, end] = values(&h).expect("moved along");
    assert!(moved > from + 0.05 * (to - from) && (end - moved - (to - from)).abs() < 1e-9, "{moved} to {end}");
    assert_eq!(session(&h).frame().time, time, "no instant is shown by that");
    // Esc gives a drag up.
    h.drag_at(at);
    h.step();
    h.hover_at(at + vec2(0.0, 12.0));
    h.run_steps(2);
    h.key_press(Key::Escape);
    h.run_steps(2);
    h.drop_at(at + vec2(0.0, 12.0));
    h.run_steps(2);
    assert_eq!(values(&h), Some([moved, end]));
    for place in [at, inside] {
        h.state_mut().app_state_mut().carry_out(ViewChange::Charts(PlotChange::Values(name.into(), Some([-0.1, 0.1]))));
        h.run_steps(20);
        for _ in 0..2 {
            h.drag_at(place);
            h.step();
            h.drop_at(place);
            h.step();
        }
        h.run_steps(2);
        assert_eq!(values(&h), None, "a double click shows all of them");
    }
    let before = at.y;
    wheel(&mut h, at, -60.0, Modifiers::NONE);
    assert!(numbers(&h).y < before - 20.0 && values(&h).is_none(), "the plain wheel scrolls");
}

fn keys_zoom_mark_and_show_all() {
    let mut h = after_case("case-3", Theme::Dark, 800.0);
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(0.5));
    h.run_steps(2);
    h.key_press_modifiers(Modifiers::ALT, Key::Plus);
    h.run_steps(2);
    let [from, to] = range(&h).expect("closer");
    assert!((from - 1.0 / 6.0).abs() < 1e-9 && (to - 5.0 / 6.0).abs() < 1e-9, "{from} to {to}");
    h.key_press(Key::M);
    h.run_steps(2);
    assert_eq!(h.state().app_state().view_state().mark, Some(0.5));
    h.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
    h.run_steps(2);
    assert!(h.query_by_label_contains("second cursor").is_some());
    h.key_press_modifiers(Modifiers::ALT, Key::Minus);
    h.run_steps(2);
    assert_eq!(range(&h), None, "back where it was");
    h.key_press_modifiers(Modifiers::ALT, Key::Plus);
    h.key_press_modifiers(Modifiers::ALT, Key::Num0);
    h.run_steps(2);
    assert_eq!(range(&h), None);
}

fn a_curve_goes_and_comes_by_its_name() {
    let mut h = after_case("case-1", Theme::Dark, 800.0);
    let on = |h: &Window| {
        let node = h.get_by_label_contains("torque of drive 2 in Torque");
        node.accesskit_node().toggled()
    };
    assert_eq!(on(&h), Some(Toggled::True));
    h.get_by_label_contains("torque of drive 2 in Torque").click();
    h.run_steps(2);
    assert_eq!(on(&h), Some(Toggled::False));
    let figure = h.get_by_label_contains("Torque over time").value().expect("values are said");
    assert!(figure.contains("τ₁") && !figure.contains("τ₂"), "{figure}");
    // It stays away when another scenario comes, and comes back by the keyboard.
    h.key_press(Key::Num2);
    h.run_steps(4);
    assert_eq!(on(&h), Some(Toggled::False));
    h.get_by_label_contains("torque of drive 2 in Torque").focus();
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(2);
    assert_eq!(on(&h), Some(Toggled::True));
}

/// Types into the field that has the focus.
fn say(h: &mut Window, text: &str) {
    h.event(Event::Text(text.into()));
    h.run_steps(2);
}

fn a_signal_is_sought_and_plotted_by_keys_alone() {
    let mut h = after_case("case-1", Theme::Dark, 1400.0);
    // As a window sends it: the key with its letter.
    let key = Event::Key { key: Key::A, physical_key: None, pressed: true, repeat: false, modifiers: Modifiers::NONE };
    h.input_mut().events.extend([key, Event::Text("a".into())]);
    h.run_steps(2);
    let field = |h: &Window| h.get_by_label("Plot a signal").value().unwrap_or_default();
    assert_eq!(field(&h), "", "the letter is not typed");
    assert!(h.get_by_label("Plot a signal").is_focused());
    say(&mut h, "rate drive");
    h.key_press(Key::ArrowDown);
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(3);
    assert!(h.query_by_label_contains("Rate of drive 2 over time, rad/s").is_some());
    assert!(!h.get_by_label("Plot a signal").is_focused());
    // The keyboard is the window's again.
    h.key_press(Key::Home);
    h.run_steps(2);
    assert_eq!(session(&h).frame().step, 0);
    // What nothing answers to is said; Esc leaves, and takes nothing else away.
    h.state_mut().app_state_mut().carry_out(ViewChange::Mark(Some(0.2)));
    h.key_press(Key::A);
    h.run_steps(2);
    say(&mut h, "cheese");
    assert!(h.query_by_label_contains("no signal has all these words").is_some());
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert!(h.query_by_label_contains("no signal has all these words").is_none());
    assert_eq!(h.state().app_state().view_state().mark, Some(0.2));
    // By the pointer: a press on an answer.
    h.get_by_label("Plot a signal").click();
    h.run_steps(2);
    say(&mut h, "kinetic");
    h.get_by_label("T, kinetic energy").click();
    h.run_steps(3);
    assert!(h.query_by_label_contains("Kinetic energy over time, J").is_some());
}

fn one_signal_stands_against_another() {
    let mut h = after_case("case-1", Theme::Dark, 1400.0);
    h.state_mut().app_state_mut().carry_out(ViewChange::Charts(PlotChange::Plot("tip/y".into())));
    h.run_steps(2);
    h.get_by_label("End effector, y: menu").focus();
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(3);
    h.get_by_label("Against another signal…").click();
    h.run_steps(3);
    say(&mut h, "end effector x");
    h.key_press(Key::Enter);
    h.run_steps(3);
    assert!(h.query_by_label_contains("End effector, y over end effector, x").is_some());
    // The right button brings the same menu.
    h.get_by_label_contains("End effector, y over").click_secondary();
    h.run_steps(3);
    h.get_by_label("Put this plot away").click();
    h.run_steps(3);
    assert!(h.query_by_label_contains("End effector, y over").is_none());
    assert_eq!(h.state().app_state().view_state().charts, Default::default());
    // A plot of the table can be put away and brought back.
    h.get_by_label_contains("Force on the base over time").click_secondary();
    h.run_steps(3);
    h.get_by_label("Put this plot away").click();
    h.run_steps(3);
    assert!(h.query_by_label_contains("Force on the base over time").is_none());
    h.get_by_label("Bring plots back").click();
    h.run_steps(3);
    assert!(h.query_by_label_contains("Force on the base over time").is_some());
}

fn values_under_the_pointer_are_those_of_the_frame() {
    let mut h = after_case("case-1", Theme::Dark, 800.0);
    let at = at_share(&h, "Torque over time", 0.42);
    h.hover_at(at);
    h.run_steps(60);
    let frame = *session(&h)
        .frames()
        .iter()
        .min_by(|a, b| (a.time - 0.42).abs().total_cmp(&(b.time - 0.42).abs()))
        .expect("one");
    let said = |h: &Window, text: &str| h.query_all_by_label(text).count() > 0;
    let near = session(&h).frames().iter().filter(|f| (f.time - frame.time).abs() < 0.005);
    let shown = near.clone().find(|f| said(&h, &format!("{:.3} s", f.time))).expect("the time is said");
    for k in 0..3 {
        let texts = [3, 4].map(|decimals| stillbase::picture::numbers::signed(shown.torque[k], decimals));
        assert!(texts.iter().any(|text| said(&h, text)), "τ{} = {texts:?} at {}", k + 1, shown.time);
    }
}

fn a_plot_is_written_to_files() {
    let folder = Folder::new("plots");
    let mut h = after_case("case-1", Theme::Dark, 800.0);
    h.state_mut().app_state_mut().carry_out(ViewChange::Charts(PlotChange::Range(Some([0.2, 0.3]))));
    h.run_steps(2);
    let frames = h.state().app_state().session().frames();
    let torques: Vec<f64> = frames.iter().skip(200).take(101).map(|frame| frame.torque[1]).collect();
    let mut write = |file: PlotFile, name: &str| {
        let path = folder.path(name);
        h.state_mut().app_state_mut().carry_out(SessionCommand::WritePlot(path.clone(), "Torque".into(), file));
        let message = h.state().app_state().view_state().status.message.clone().expect("it is said");
        (std::fs::read(&path).unwrap_or_default(), message)
    };
    let (csv, Message { text: said, is_problem: bad }) = write(PlotFile::Values(RowForm::Csv), "plot.csv");
    let text = String::from_utf8(csv).expect("UTF-8");
    assert!(!bad && said.contains("plot.csv"), "{said}");
    assert_eq!(text.lines().count(), 102);
    assert!(text.starts_with("time s,torque/1 N m,torque/2 N m,torque/3 N m\n0.2,"), "{text}");
    let (parquet, Message { text: said, is_problem: bad }) = write(PlotFile::Values(RowForm::Csv), "plot.parquet");
    assert!(!bad && parquet.starts_with(b"PAR1"), "{said}: the ending decides");
    let [csv, parquet] = ["plot.csv", "plot.parquet"].map(|name| signals(&folder.path(name)).expect("a table"));
    assert_eq!(csv, parquet);
    assert!(csv.columns[1].values == torques, "every sample, to the last bit");
    let (svg, _) = write(PlotFile::Picture(PictureForm::Svg), "plot.svg");
    assert!(String::from_utf8(svg).expect("UTF-8").contains("aria-label=\"Torque\""));
    let (png, Message { text: said, is_problem: bad }) = write(PlotFile::Picture(PictureForm::Png), "plot.png");
    assert!(!bad, "{said}");
    let picture = image::load_from_memory(&png).expect("a picture").to_rgba8();
    assert_eq!(picture.dimensions(), (1440, 640));
    // The title is there: bright on the panel's colour.
    let bright = picture.pixels().filter(|p| p.0[0] > 200 && p.0[1] > 200 && p.0[2] > 200).count();
    assert!(bright > 200, "{bright} bright pixels");
    let (pdf, _) = write(PlotFile::Picture(PictureForm::Pdf), "plot.pdf");
    assert!(pdf.starts_with(b"%PDF-1."));
    let (webp, _) = write(PlotFile::Picture(PictureForm::Webp), "plot.webp");
    let smaller = image_webp::WebPDecoder::new(std::io::Cursor::new(&webp)).expect("a WebP");
    assert_eq!(smaller.dimensions(), (1440, 640));
    // What is there stays there.
    let (same, Message { text: said, is_problem: bad }) = write(PlotFile::Picture(PictureForm::Svg), "plot.svg");
    assert!(bad && said.contains("exists") && String::from_utf8(same).expect("UTF-8").starts_with("<?xml"), "{said}");
    let (_, Message { text: said, is_problem: bad }) = write(PlotFile::Values(RowForm::Csv), "values.svg");
    assert!(bad && said.contains("want a name that ends in .csv or .parquet"), "{said}");
    // Through the menu and the dialog.
    h.get_by_label_contains("Torque over time").click_secondary();
    h.run_steps(3);
    h.get_by_label("Save as CSV…").click();
    h.run_steps(3);
    let dialog = h.state().app_state().view_state().open.dialog.clone().expect("it asks");
    assert!(dialog.path.ends_with("torque.csv"), "{}", dialog.path);
    h.get_by_label("Cancel").click();
    h.run_steps(3);
    h.get_by_label_contains("Torque over time").click_secondary();
    h.run_steps(3);
    h.get_by_label("Copy the values shown").click();
    let copied = (0..5).find_map(|_| {
        h.step();
        h.output().platform_output.commands.iter().find_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
    });
    assert_eq!(copied.expect("copied"), text);
}

fn plots_look_as_they_should() {
    let mut h = window("case-1", Theme::Dark);
    h.run_steps(2);
    for command in [
        Command::Session(SessionCommand::Seek(1.0)),
        Command::Session(SessionCommand::Seek(0.62)),
        Command::View(ViewChange::Mark(Some(0.3))),
        Command::View(ViewChange::Charts(PlotChange::Close("Force on the base".into()))),
        Command::View(ViewChange::Charts(PlotChange::Show("Torque".into(), "torque/2".into(), false))),
        Command::View(ViewChange::Charts(PlotChange::Plot("tip/y".into()))),
        Command::View(ViewChange::Charts(PlotChange::Against("plot 1".into(), Some("tip/x".into())))),
        Command::View(ViewChange::Charts(PlotChange::Statistics(true))),
        Command::View(ViewChange::Charts(PlotChange::Range(Some([0.1, 0.9])))),
    ] {
        h.state_mut().app_state_mut().carry_out(command);
    }
    h.run_steps(4);
    h.snapshot("plots-dark");
}
