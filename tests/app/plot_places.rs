//! The places of plots: in the user's order, in columns, and in windows of their own.

use egui::{Event, Key, RawInput, Rect, ViewportInfo, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::window::{MonitorArea, visible_place};
use stillbase::app::{Layout, ResumePoint, ViewChange};
use stillbase::picture::charts::choice::PlotChange;
use stillbase::picture::scene::palette::Theme;

use super::{Window, drag, session, window};
use crate::Test;

pub const TESTS: &[Test] = tests![
    a_heading_is_dragged_to_another_place,
    a_menu_moves_a_plot_by_keys,
    a_plot_has_a_window_of_its_own_and_goes_back,
    a_plot_in_a_window_of_the_desktop_is_not_in_the_main_one,
    a_place_on_the_desktop_is_kept_with_the_session,
    a_window_comes_back_onto_a_monitor,
    plots_fill_columns_in_compare,
    runs_are_named_above_the_plots,
];

fn plot(h: &Window, title: &str) -> Rect {
    h.get_by_label_contains(&format!("{title} over time")).rect()
}

fn heading(h: &Window, title: &str) -> Rect {
    h.get_by_label(title).rect()
}

fn order(h: &Window) -> Vec<String> {
    let app_state = h.state().app_state();
    let signals = stillbase::simulation::signals::signals(&session(h).scenario().machine);
    let plots = app_state.view_state().plots(session(h).scenario(), &signals);
    plots.into_iter().map(|plot| plot.name).collect()
}

fn shown() -> Window {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(3);
    h
}

fn a_heading_is_dragged_to_another_place() {
    let mut h = shown();
    assert_eq!(order(&h)[..3], ["Torque", "Turning moment on the base", "Force on the base"]);
    let from = heading(&h, "Torque").center();
    let to = plot(&h, "Force on the base").center() + vec2(0.0, 20.0);
    drag(&mut h, from, to);
    h.run_steps(2);
    assert_eq!(order(&h)[..3], ["Turning moment on the base", "Force on the base", "Torque"]);
    assert!(plot(&h, "Torque").top() > plot(&h, "Force on the base").bottom());
    // Back to the top; Esc gives a drag up.
    let (from, to) = (heading(&h, "Torque").center(), heading(&h, "Turning moment on the base").center());
    super::pull(&mut h, from, to);
    h.key_press(Key::Escape);
    h.run_steps(2);
    h.drop_at(to);
    h.run_steps(2);
    assert_eq!(order(&h)[2], "Torque");
    drag(&mut h, from, to - vec2(0.0, 6.0));
    h.run_steps(2);
    assert_eq!(order(&h)[0], "Torque");
    // It is saved with the session, and names that no plot has do no harm.
    h.state_mut().app_state_mut().carry_out(ViewChange::Charts(PlotChange::Order(vec![
        "cheese".into(),
        "Force on the base".into(),
        "Torque".into(),
        "Turning moment on the base".into(),
        "Drive angles".into(),
        "Pose constant".into(),
    ])));
    h.run_steps(2);
    let wanted = ["Force on the base", "Torque", "Turning moment on the base"];
    assert_eq!(order(&h)[..3], wanted);
    let text = h.state().app_state().left_off().before("# a session\n");
    let left = ResumePoint::of(&text).expect("it is there");
    assert_eq!(left.plots, h.state().app_state().view_state().charts);
}

fn a_menu_moves_a_plot_by_keys() {
    let mut h = shown();
    let mut choose = |entry: &str| {
        h.get_by_label("Torque: menu").focus();
        h.run_steps(2);
        h.key_press(Key::Enter);
        h.run_steps(3);
        h.get_by_label(entry).focus();
        h.run_steps(2);
        h.key_press(Key::Enter);
        h.run_steps(3);
        order(&h)
    };
    assert_eq!(choose("Move down")[..2], ["Turning moment on the base", "Torque"]);
    assert_eq!(choose("Move down")[1..3], ["Force on the base", "Torque"]);
    assert_eq!(choose("Move up")[1..3], ["Torque", "Force on the base"]);
}

fn a_plot_has_a_window_of_its_own_and_goes_back() {
    let mut h = shown();
    let scene = h.get_by_label_contains("Scene:").rect();
    let (from, to) = (heading(&h, "Turning moment on the base").center(), scene.center() - vec2(120.0, 160.0));
    drag(&mut h, from, to);
    h.run_steps(4);
    let at = |h: &Window| {
        let charts = &h.state().app_state().view_state().charts;
        charts.changes.get("Turning moment on the base").and_then(|changes| changes.window)
    };
    let [left, top, width, height] = at(&h).expect("out of the panel");
    let out = plot(&h, "Turning moment on the base");
    let is_as_meant = (width - 460.0).abs() < 1.0 && (height - 260.0).abs() < 16.0;
    assert!(scene.contains_rect(out) && is_as_meant, "{out} in {scene}, {width} by {height}");
    assert!((out.width() - width).abs() < 20.0 && out.top() > top && (left - to.x).abs() < 60.0);
    // Its menu leads back as well as its cross; the layout keeps it, a presentation hides it.
    h.key_press(Key::Num9);
    h.run_steps(3);
    assert!(h.query_by_label_contains("Torque over time").is_none());
    assert_eq!(plot(&h, "Turning moment on the base"), out, "without the panel");
    h.state_mut().app_state_mut().carry_out(ViewChange::Layout(Layout::Present));
    h.run_steps(3);
    assert!(h.query_by_label_contains("Turning moment on the base over time").is_none());
    h.state_mut().app_state_mut().carry_out(ViewChange::Layout(Layout::Explore));
    h.key_press(Key::Num9);
    h.run_steps(3);
    // Moved by its title, it is saved where it is; another place that is opened wins.
    let title = pos2(out.center().x, top + 14.0);
    drag(&mut h, title, title + vec2(30.0, 40.0));
    h.run_steps(3);
    let moved = at(&h).expect("still out");
    assert!(
        (moved[0] - left - 30.0).abs() < 6.0 && (moved[1] - top - 40.0).abs() < 6.0,
        "{moved:?} from {left}, {top}"
    );
    assert_eq!(moved[2..], [width, height], "its size stays");
    let change = PlotChange::Window("Turning moment on the base".into(), Some([330.0, 100.0, 300.0, 200.0]));
    h.state_mut().app_state_mut().carry_out(ViewChange::Charts(change));
    h.run_steps(4);
    assert_eq!(at(&h).map(|[left, top, ..]| [left, top]), Some([330.0, 100.0]));
    let smaller = plot(&h, "Turning moment on the base");
    assert!((smaller.width() - 282.0).abs() < 4.0, "{smaller}");
    // What no window can be is refused.
    let change = PlotChange::Window("Torque".into(), Some([f32::NAN, 0.0, 10.0, 1e9]));
    h.state_mut().app_state_mut().carry_out(ViewChange::Charts(change));
    h.run_steps(2);
    h.get_by_label("Turning moment on the base: menu").focus();
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(3);
    h.get_by_label("Put back among the plots").click();
    h.run_steps(3);
    assert!(at(&h).is_none() && plot(&h, "Turning moment on the base").left() > scene.right() - 2.0);
    assert_eq!(order(&h)[..2], ["Torque", "Turning moment on the base"]);
}

fn a_plot_in_a_window_of_the_desktop_is_not_in_the_main_one() {
    let mut h = shown();
    h.ctx.set_embed_viewports(false);
    h.state_mut().app_state_mut().carry_out(place("Torque", Some([900.0, 60.0, 460.0, 260.0])));
    h.run_steps(3);
    assert!(h.query_by_label_contains("Torque over time").is_none());
    let [window] = h.state().app_state().plot_windows().try_into().expect("one window");
    assert_eq!(window.title, format!("Torque – {}", session(&h).scenario().title));
    // The window shows it with the title above, so the plot has none.
    let mut pass = |events: Vec<Event>| {
        let mut input = RawInput { viewport_id: window.id, events, ..RawInput::default() };
        input.screen_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(460.0, 260.0)));
        input.viewports.insert(window.id, ViewportInfo::default());
        let ctx = h.ctx.clone();
        let output = ctx.run_ui(input, |ui| h.state_mut().plot_ui(ui, window.id));
        h.run_steps(2);
        let app_state = h.state().app_state();
        (output.shapes.len(), app_state.plot_windows().len(), app_state.view_state().arrangement.theme)
    };
    let key = |key| Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers: Default::default() };
    pass(Vec::new());
    let (shapes, windows, theme) = pass(Vec::new());
    assert!(shapes > 10 && windows == 1 && theme == Theme::Dark, "{shapes} shapes in {windows} window");
    // Keys do what they do in the main window, except that Esc puts the plot back.
    assert_eq!(pass(vec![key(Key::L)]).2, Theme::Light);
    assert_eq!(pass(vec![key(Key::Escape)]).1, 0);
    h.run_steps(2);
    assert!(h.query_by_label_contains("Torque over time").is_some());
}

fn place(name: &str, window: Option<[f32; 4]>) -> ViewChange {
    ViewChange::Charts(PlotChange::Window(name.into(), window))
}

fn a_place_on_the_desktop_is_kept_with_the_session() {
    let mut h = shown();
    let app_state = h.state_mut().app_state_mut();
    app_state.carry_out(place("Torque", Some([900.0, 60.0, 460.0, 260.0])));
    let id = app_state.plot_windows()[0].id;
    assert!(app_state.keep_place(id, Some([-1200, 340]), [500.0, 300.0]), "it is new");
    assert!(!app_state.keep_place(id, Some([-1200, 340]), [500.0, 300.0]), "it is known");
    let of = |point: &ResumePoint| {
        let changes = &point.plots.changes["Torque"];
        (changes.window.expect("out"), changes.desktop)
    };
    let text = app_state.left_off().before("# a session\n");
    let kept = of(&ResumePoint::of(&text).expect("it is there"));
    assert_eq!(kept, ([900.0, 60.0, 500.0, 300.0], Some([-1200, 340])));
    // Where the system tells no places, the last one stays; what no window can be is not kept.
    app_state.keep_place(id, None, [520.0, 300.0]);
    assert_eq!(of(&app_state.left_off()), ([900.0, 60.0, 520.0, 300.0], Some([-1200, 340])));
    app_state.keep_place(id, Some([i32::MIN, 0]), [f32::NAN, 1e9]);
    assert_eq!(of(&app_state.left_off()), ([900.0, 60.0, 520.0, 300.0], Some([-1200, 340])));
    // Pulled out anew, it stands where it was let go.
    app_state.carry_out(place("Torque", None));
    assert!(app_state.plot_windows().is_empty() && !app_state.keep_place(id, Some([0, 0]), [500.0, 300.0]));
    app_state.carry_out(place("Torque", Some([10.0, 60.0, 460.0, 260.0])));
    assert_eq!(of(&app_state.left_off()), ([10.0, 60.0, 460.0, 260.0], None));
}

fn a_window_comes_back_onto_a_monitor() {
    let left = MonitorArea { at: [0, 0], size: [1920, 1080] };
    let right = MonitorArea { at: [1920, -200], size: [2560, 1440] };
    let size = [460, 260];
    for seen in [[100, 100], [1700, 100], [-300, 50], [2500, -200], [4380, 1200]] {
        assert_eq!(visible_place(seen, size, &[left, right]), seen);
    }
    // The second monitor is gone: to the edge of the first, at the same height.
    assert_eq!(visible_place([2500, 300], size, &[left]), [1920 - 460, 300]);
    assert_eq!(visible_place([2500, -150], size, &[left]), [1920 - 460, 0]);
    // Too far up its title could not be taken; too far down it could not be seen.
    assert_eq!(visible_place([100, -40], size, &[left]), [100, 0]);
    assert_eq!(visible_place([100, 1079], size, &[left]), [100, 1080 - 260]);
    // The nearest monitor takes it, a window that is larger than it begins at its corner.
    assert_eq!(visible_place([6000, 0], size, &[left, right]), [1920 + 2560 - 460, 0]);
    assert_eq!(visible_place([i32::MAX, i32::MIN], [9000, 9000], &[left]), [0, 0]);
    assert_eq!(visible_place([70, -9000], size, &[]), [70, -9000], "nothing is known");
}

/// In a wide window, the plots of the layout Compare stand in columns; dragged, they move among these.
fn plots_fill_columns_in_compare() {
    let mut h = shown();
    h.set_size(vec2(1920.0, 1080.0));
    h.state_mut().app_state_mut().carry_out(ViewChange::Layout(Layout::Compare));
    h.run_steps(6);
    let [torque, moment, force] =
        ["Torque", "Turning moment on the base", "Force on the base"].map(|title| plot(&h, title));
    assert!(moment.left() > torque.right() && moment.top() == torque.top(), "{torque} beside {moment}");
    assert!(force.top() > torque.bottom() && force.left() == torque.left() && force.width() > 300.0, "{force}");
    let from = heading(&h, "Torque").center();
    drag(&mut h, from, pos2(moment.right() - 20.0, moment.center().y));
    h.run_steps(3);
    assert_eq!(order(&h)[..2], ["Turning moment on the base", "Torque"]);
    assert!(plot(&h, "Turning moment on the base").left() < plot(&h, "Torque").left());
}

fn runs_are_named_above_the_plots() {
    let mut h = shown();
    h.set_size(vec2(1920.0, 1080.0));
    h.state_mut().app_state_mut().carry_out(ViewChange::Layout(Layout::Compare));
    h.run_steps(8);
    h.get_by_label("Lay over: Straight line").click();
    h.get_by_label("Lay over: Slowly").click();
    h.run_steps(6);
    let comparison = h.state().app_state().comparison().expect("side by side");
    let shown: Vec<usize> = comparison.shown().map(|(place, _)| place).collect();
    assert!(!shown.is_empty());
    let first = plot(&h, "Torque");
    for place in shown {
        let title = comparison.entries()[place].title.clone();
        let named = h.query_all_by_label(&title).filter(|node| node.rect().bottom() < first.top()).count();
        assert!(named >= 1, "{title} above {first}");
    }
}
