//! What a person chooses to see in plots, how signals are found, and plots as drawings.

use proptest::prelude::*;
use stillbase::mechanics::machine::builtin;
use stillbase::picture::charts::axis::{AxisKind, floor};
use stillbase::picture::charts::choice::{PlotChange, PlotChoice};
use stillbase::picture::charts::drawn::PlotLines;
use stillbase::picture::charts::figure::{Figure, FigureItem, PlotContext, dashes, run_colour};
use stillbase::picture::charts::legend::{RunName, figure};
use stillbase::picture::charts::range::TimeExtent;
use stillbase::picture::charts::search::search;
use stillbase::picture::notation::{AngleUnit, Notation};
use stillbase::picture::numbers::{at_step, round_ticks, ticks};
use stillbase::picture::print::{Page, svg, svg_element};
use stillbase::picture::scene::palette::{Theme, palette};
use stillbase::picture::scene::thin::simplify_line;
use stillbase::session::Session;
use stillbase::session::scenario::Scenario;
use stillbase::simulation::signals::{Signal, signals};
use stillbase::study::samples::SignalSamples;

fn table() -> Vec<Signal> {
    signals(builtin("nine-link").expect("built in"))
}

#[test]
fn signals_are_found_by_name_symbol_path_and_unit() {
    let table = table();
    for (text, first) in [
        ("tau1", "torque/1"),
        ("τ₂", "torque/2"),
        ("torque 3", "torque/3"),
        ("moment/total", "moment/total"),
        ("n_b", "moment/total"),
        ("base moment", "moment/total"),
        ("qddot2", "acceleration/2"),
        ("theta", "attitude/base"),
        ("pose const", "pose/b"),
        ("kinetic", "energy/kinetic"),
        ("end eff y", "tip/y"),
        ("rad/s²", "rate/1"),
        ("mnpl", "dexterity/manipulability"),
    ] {
        let found = search(&table, text);
        let paths: Vec<&str> = found.iter().take(4).map(|s| s.path.as_str()).collect();
        let unit = found.first().is_some_and(|s| s.unit == text);
        assert!(paths.first() == Some(&first) || unit, "{text}: {paths:?}");
    }
    assert_eq!(search(&table, " ").len(), table.len());
    assert!(search(&table, "torque of the moon").is_empty());
    // Whatever stands there finds itself.
    for signal in &table {
        for words in [&signal.path, &signal.label, &signal.symbol] {
            assert!(search(&table, words).iter().any(|s| s.path == signal.path), "{words}");
        }
    }
}

/// Plots that are not on display keep their places; unknown names and windows that cannot be are ignored.
#[test]
fn plots_stand_in_the_users_order() {
    let (scenario, table) = (Scenario::builtin("case-3").expect("built in"), table());
    let names = |choice: &PlotChoice, pins: bool| -> Vec<String> {
        choice.plots(&scenario, &table, pins, Notation::default()).into_iter().map(|plot| plot.name).collect()
    };
    let mut choice = PlotChoice::default();
    let mut order = names(&choice, true);
    order.swap(0, 3);
    choice.change(PlotChange::Order(order.clone()));
    assert_eq!(order[0], "Pin forces");
    assert_eq!(names(&choice, true), order);
    // Without pin forces, in another order; with them again, they follow what they followed.
    let mut shown = names(&choice, false);
    assert_eq!(shown, order[1..]);
    shown.reverse();
    choice.change(PlotChange::Order(shown.clone()));
    assert_eq!(names(&choice, false), shown);
    assert_eq!(names(&choice, true).len(), order.len());
    choice.change(PlotChange::Plot("tip/y".into()));
    assert_eq!(names(&choice, true).last().map(String::as_str), Some("plot 1"), "a new one comes last");
    // What a file holds does not have to make sense.
    choice.order.insert(0, "cheese".into());
    choice.order.push(shown[0].clone());
    choice.change(PlotChange::Window("cheese".into(), Some([0.0, 0.0, 300.0, 200.0])));
    choice.changes.entry("Torque".into()).or_default().window = Some([f32::INFINITY, 0.0, -1.0, 2.0]);
    assert_eq!(names(&choice, false)[..shown.len()], shown);
    let plots = choice.plots(&scenario, &table, false, Notation::default());
    assert!(plots.iter().all(|plot| plot.window.is_none()));
    choice.change(PlotChange::Window("Torque".into(), Some([10.0, 20.0, 300.0, 200.0])));
    let written = toml::to_string(&choice).expect("plain data");
    assert_eq!(toml::from_str::<PlotChoice>(&written).expect("as written"), choice);
}

#[test]
fn plots_are_what_was_chosen_and_remembered() {
    let (scenario, table) = (Scenario::builtin("case-3").expect("built in"), table());
    let mut choice = PlotChoice::default();
    let names = |choice: &PlotChoice| -> Vec<String> {
        choice.plots(&scenario, &table, false, Notation::default()).into_iter().map(|plot| plot.name).collect()
    };
    assert_eq!(
        names(&choice),
        ["Torque", "Turning moment on the base", "Force on the base", "Drive angles", "Pose constant"]
    );
    let plot = |name: &str| name.to_owned();
    choice.change(PlotChange::Show(plot("Torque"), plot("torque/2"), false));
    choice.change(PlotChange::Plot(plot("tip/y")));
    choice.change(PlotChange::Against(plot("plot 1"), Some(plot("tip/x"))));
    choice.change(PlotChange::Add(plot("Pose constant"), plot("pose/b_reference")));
    choice.change(PlotChange::Close(plot("Force on the base")));
    choice.change(PlotChange::Range(Some([0.2, 0.4])));
    choice.change(PlotChange::Range(Some([0.4, f64::NAN])));
    assert_eq!(names(&choice), ["Torque", "Turning moment on the base", "Drive angles", "Pose constant", "plot 1"]);
    let plots = choice.plots(&scenario, &table, false, Notation::default());
    let on = |i: usize| -> Vec<&str> { plots[i].shown().map(|c| c.signal.path.as_str()).collect() };
    assert_eq!((on(0), on(3)), (vec!["torque/1", "torque/3"], vec!["pose/b", "pose/b_reference"]));
    assert_eq!(plots[4].heading(), "End effector, y against x");
    assert_eq!((choice.range, choice.closed()), (None, 1));
    // Plain data: kept in a file, it is the same.
    choice.change(PlotChange::Range(Some([0.2, 0.4])));
    let kept = serde_json::to_string(&choice).expect("plain data");
    assert_eq!(serde_json::from_str::<PlotChoice>(&kept).expect("itself"), choice);
    // And all of it can be taken back.
    choice.change(PlotChange::Show(plot("Torque"), plot("torque/2"), true));
    choice.change(PlotChange::Remove(plot("Pose constant"), plot("pose/b_reference")));
    choice.change(PlotChange::Close(plot("plot 1")));
    choice.change(PlotChange::Reopen);
    choice.change(PlotChange::Range(None));
    assert_eq!(choice, PlotChoice::default());
    // A plot of what another machine has is kept, and not shown.
    choice.change(PlotChange::Plot(plot("torque/9")));
    assert!(!names(&choice).contains(&plot("plot 1")) && choice.own.len() == 1);
}

proptest! {
    /// While the clock of a run without an end goes on, as much time is shown as before: curves move, and keep their
    /// shape.
    #[test]
    fn a_clock_that_runs_on_squeezes_nothing(planned in 0.05..60.0_f64, start in 0.0..3.0_f64) {
        let width = |now: f64| {
            let [from, to] = TimeExtent::open_ended(planned, now, now).shown(None);
            assert!(from >= 0.0 && from <= now && now <= to + 1e-12, "{from} to {to} at {now}");
            to - from
        };
        let first = width(start);
        prop_assert!((4.0 - 1e-12..=12.0 + 1e-12).contains(&first));
        for i in 1..200 {
            prop_assert!((width(start + 0.4 * f64::from(i)) - first).abs() < 1e-9);
        }
    }

    /// Whatever hands do to the range, there is something to see in it, and the time under the pointer stays there.
    #[test]
    fn a_range_stays_within_the_run(
        end in prop_oneof![1e-3..1.0_f64, 1.0..3000.0_f64],
        now in 0.0..1.0_f64,
        doings in prop::collection::vec((0..4_u8, 0.0..1.0_f64, 0.0..1.0_f64), 1..20),
    ) {
        let extent = TimeExtent::of(end, now * end);
        let mut chosen = None;
        for (what, a, b) in doings {
            let shown = extent.shown(chosen);
            let at = |share: f64| shown[0] + share * (shown[1] - shown[0]);
            match what {
                0 => {
                    let factor = (8.0 * (b - 0.5)).exp2();
                    chosen = extent.zoomed(shown, at(a), factor);
                    let next = extent.shown(chosen);
                    let share = (at(a) - next[0]) / (next[1] - next[0]);
                    let inside = next[0] > 1e-9 && next[1] < end - 1e-9 * end;
                    prop_assert!(!inside || (share - a).abs() < 1e-6, "{} went to {}", a, share);
                }
                1 => chosen = Some(extent.panned(shown, (b - 0.5) * 3.0 * end)),
                2 => chosen = extent.between(at(a), at(b)).or(chosen),
                _ => chosen = extent.all(chosen),
            }
            let [from, to] = extent.shown(chosen);
            prop_assert!(from >= -1e-9 && to <= end * (1.0 + 1e-9) && to > from, "{from} to {to} of {end}");
        }
        // Twice all is what it was at first, or all of it.
        let once = extent.all(chosen);
        let twice = extent.all(once);
        prop_assert!(once.is_none() || twice.is_none());
        prop_assert!(extent.is_all(extent.shown(once)) || extent.is_all(extent.shown(twice)) );
    }

    /// Numbers of an axis lie within it, at round places, and can be told apart.
    #[test]
    fn numbers_of_an_axis_differ(low in -1e3..1e3_f64, power in -9.0..6.0_f64, count in 2.0..9.0_f64) {
        let high = low + 10f64.powf(power);
        let (values, step) = round_ticks(low, high, count);
        prop_assert!(values.len() <= count as usize + 1, "{values:?}");
        prop_assert!(values.iter().all(|v| *v >= low - 1e-5 * step && *v <= high + 1e-5 * step));
        let words: Vec<String> = values.iter().map(|v| at_step(*v, step)).collect();
        for pair in words.windows(2) {
            prop_assert!(pair[0] != pair[1], "{words:?} of {values:?} by {step}");
        }
    }
}

/// The words of the letters in a drawing.
fn labels(drawing: &str) -> Vec<String> {
    let page = roxmltree::Document::parse(drawing).expect("an SVG");
    page.descendants().filter_map(|node| node.attribute("aria-label").map(str::to_owned)).collect()
}

/// Read by a parser of XML: every curve that is on, its title and its numbers stand there, and nothing that is off.
#[test]
fn a_drawing_holds_what_the_plot_shows() {
    let mut session = Session::open(Scenario::builtin("case-1").expect("built in")).expect("it starts");
    session.seek(1.0);
    let table = signals(&session.scenario().machine);
    let mut choice = PlotChoice::default();
    choice.change(PlotChange::Show("Torque".into(), "torque/2".into(), false));
    choice.change(PlotChange::Plot("transmission/12".into()));
    let plots = choice.plots(session.scenario(), &table, false, Notation::default());
    let wanted: Vec<Signal> = plots.iter().flat_map(|plot| plot.curves.iter().map(|c| c.signal.clone())).collect();
    let samples: SignalSamples = stillbase::query::answer_sequence(&wanted, session.frames());
    let p = palette(Theme::Light);
    let look =
        PlotContext { palette: &p, peaks: &session.frame().peaks, now: session.frame(), mark: None, hover: None };
    for plot in [&plots[0], plots.last().expect("one's own")] {
        let drawn = PlotLines::of(plot, &samples, &[], [0.0, 1.0], 600, true);
        let figure = Figure::of(plot, &drawn, [720.0, 320.0], &look, &[]);
        let text = svg(&Page::of_web(figure.clone()));
        let labels = labels(&text);
        assert!(labels.contains(&plot.heading()), "{labels:?}");
        assert!(plot.unit().is_empty() || labels.contains(&plot.unit().to_string()), "{labels:?}");
        assert!(!text.contains("NaN") && !text.contains("inf") && !text.contains("<text"), "letters are outlines");
        // In a page of the web the same words can be found, over their outlines.
        let element = svg_element(&Page::of_web(figure.clone()));
        let page = roxmltree::Document::parse(&element).expect("an SVG");
        let texts: Vec<&str> =
            page.descendants().filter(|node| node.has_tag_name("text")).filter_map(|node| node.text()).collect();
        assert_eq!(texts.iter().map(|text| text.trim()).collect::<Vec<_>>(), labels);
        let curves =
            figure.items.iter().filter(|i| matches!(i, FigureItem::Line { points, .. } if points.len() > 2)).count();
        assert_eq!(curves, plot.shown().count());
        for curve in &plot.curves {
            assert_eq!(labels.contains(&curve.signal.symbol), curve.on, "{}", curve.signal.symbol);
        }
        // Every curve stays within its axes, which hold the greatest value of all samples.
        let [left, top, right, bottom] = figure.axes.sides;
        for item in &figure.items {
            if let FigureItem::Line { points, .. } = item {
                assert!(
                    points
                        .iter()
                        .all(|[x, y]| *x >= left - 0.1 && *x <= right + 0.1 && *y >= top && *y <= bottom + 4.0)
                );
            }
        }
        for (curve, statistics) in plot.curves.iter().zip(&drawn.statistics) {
            let values: Vec<f64> = session.frames().iter().map(|f| curve.signal.value(f)).collect();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let s = statistics.expect("numbers");
            assert!((s.mean - mean).abs() < 1e-12 * s.rms.max(1e-300), "{} {mean}", s.mean);
        }
    }
}

/// The name of a limit stands beside its line, where no curve is.
#[test]
fn names_of_limits_lie_where_no_curve_is() {
    let p = palette(Theme::Dark);
    let mut named = 0;
    for (time, size) in
        [0.68, 0.72, 0.8, 1.1].into_iter().flat_map(|time| [(time, [300.0, 130.0]), (time, [720.0, 320.0])])
    {
        let case = Scenario::builtin("case-1").expect("built in");
        let case = case.with_settings(&stillbase::settings::change::single_change("task.time", time)).expect("a time");
        let mut session = Session::open(case).expect("it starts");
        session.seek(time);
        let table = signals(&session.scenario().machine);
        let plots = PlotChoice::default().plots(session.scenario(), &table, false, Notation::default());
        let wanted: Vec<Signal> = plots[0].curves.iter().map(|curve| curve.signal.clone()).collect();
        let samples: SignalSamples = stillbase::query::answer_sequence(&wanted, session.frames());
        let look =
            PlotContext { palette: &p, peaks: &session.frame().peaks, now: session.frame(), mark: None, hover: None };
        let drawn = PlotLines::of(&plots[0], &samples, &[], [0.0, time], 600, false);
        let figure = Figure::of(&plots[0], &drawn, size, &look, &[]);
        for item in &figure.items {
            let FigureItem::Text { at, anchor, words } = item else { continue };
            let text: String = words.iter().map(|piece| piece.text.as_str()).collect();
            if !text.starts_with("limit of") {
                continue;
            }
            named += 1;
            assert_eq!(*anchor, [0.0, 0.0]);
            let right = at[0] + 0.5 * words[0].size * text.chars().count() as f32;
            let inside = |[x, y]: &[f32; 2]| (at[0]..right).contains(x) && (at[1]..at[1] + words[0].size).contains(y);
            for curve in &figure.items {
                if let FigureItem::Line { points, inside: true, .. } = curve {
                    let middles = points.windows(2).map(|ends| [0, 1].map(|k| 0.5 * (ends[0][k] + ends[1][k])));
                    let covered = points.iter().copied().chain(middles).filter(inside).count();
                    assert!(points.len() <= 2 || covered == 0, "{text} in {size:?} at {time} s covers a curve");
                }
            }
        }
    }
    assert!(named >= 6, "{named} names");
}

/// Runs with and without a wheel show one quantity: what passes the wheel. A run alone shows what the arm transmits too.
#[test]
fn runs_with_and_without_a_wheel_show_one_moment() {
    let table = table();
    let mut choice = PlotChoice::default();
    let curves = |choice: &PlotChoice, case: &str| -> Vec<String> {
        let scenario = Scenario::builtin(case).expect("built in");
        let plots = choice.plots(&scenario, &table, false, Notation::default());
        let moment = plots.iter().find(|plot| plot.name == "Turning moment on the base").expect("a plot");
        moment.curves.iter().map(|curve| curve.signal.path.clone()).collect()
    };
    assert_eq!(curves(&choice, "case-1"), ["moment/total"]);
    assert_eq!(curves(&choice, "wheel"), ["moment/total", "moment/felt"]);
    choice.wheels_differ = true;
    assert_eq!(curves(&choice, "case-1"), ["moment/felt"]);
    assert_eq!(curves(&choice, "wheel"), ["moment/felt"]);
}

fn away([x, y]: [f32; 2], [from, to]: [[f32; 2]; 2]) -> f32 {
    let way = [to[0] - from[0], to[1] - from[1]];
    let length = way[0] * way[0] + way[1] * way[1];
    let share = ((x - from[0]) * way[0] + (y - from[1]) * way[1]) / length.max(1e-12);
    let share = share.clamp(0.0, 1.0);
    (x - from[0] - share * way[0]).hypot(y - from[1] - share * way[1])
}

/// Sums of steps: smooth curves where steps are alike, hair where they are not.
fn walk() -> impl Strategy<Value = Vec<[f32; 2]>> {
    let step = (0.0..1.5f32, -1.0..1.0f32, 0..4u8);
    prop::collection::vec(step, 0..300).prop_map(|steps| {
        let (mut at, mut slope) = ([0.0f32, 0.0], 0.0f32);
        let mut place = |(across, up, kind): (f32, f32, u8)| {
            slope = if kind == 0 { 30.0 * up } else { slope + 0.1 * up };
            at = if kind == 1 { [at[0] - 0.3 * across, at[1]] } else { [at[0] + across, at[1] + slope * across] };
            at
        };
        steps.into_iter().map(&mut place).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// What is left out lies on the line that is left, in its order, and the ends stay.
    #[test]
    fn a_thinned_line_passes_all_its_points(points in walk(), tolerance in 0.01..0.5f32) {
        let thin = simplify_line(&points, tolerance);
        prop_assert_eq!((thin.first(), thin.last()), (points.first(), points.last()));
        prop_assert!(thin.len() <= points.len());
        let mut stretch = 0;
        for point in &points {
            // On this stretch or on a later one.
            let found = (stretch..thin.len().saturating_sub(1))
                .find(|i| away(*point, [thin[*i], thin[*i + 1]]) <= 1.5 * tolerance + 1e-3);
            prop_assert!(found.is_some() || thin.len() < 2, "{:?}", point);
            stretch = found.unwrap_or(stretch);
        }
    }
}

/// A smooth curve needs few points, and hair all of them.
#[test]
fn a_thinned_line_is_as_long_as_its_shape_needs() {
    let wave: Vec<[f32; 2]> = (0..1000).map(|i| [0.3 * i as f32, 40.0 * (0.02 * i as f32).sin()]).collect();
    let count = simplify_line(&wave, 0.1).len();
    assert!(count < 100, "{count}");
    let hair: Vec<[f32; 2]> = (0..1000).map(|i| [0.3 * i as f32, if i % 2 == 0 { 0.0 } else { 30.0 }]).collect();
    assert_eq!(simplify_line(&hair, 0.1), hair);
    assert_eq!(
        simplify_line(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [1.0, 1.0]], 0.1),
        [[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]]
    );
}

/// The numbers of an axis fit beside a small plot, however large or small they are, and differ.
#[test]
fn ticks_are_short() {
    let of = |values: &[f64]| ticks(values, values[1] - values[0]);
    assert_eq!(of(&[0.0, 500_000.0, 1_000_000.0]), ["0", "0.5M", "1.0M"]);
    assert_eq!(of(&[-20_000_000.0, 0.0, 20_000_000.0]), ["−20M", "0", "20M"]);
    assert_eq!(of(&[-200_000.0, 0.0, 200_000.0]), ["−200000", "0", "200000"]);
    assert_eq!(of(&[-0.5, 0.0, 0.5]), ["−0.5", "0.0", "0.5"]);
    assert_eq!(of(&[0.0, 2e12, 4e12]), ["0", "2e12", "4e12"]);
    for decade in -12..14 {
        for times in [1.0, 2.0, 5.0] {
            let step = times * 10f64.powi(decade);
            let texts = ticks(&[-step, 0.0, step, 2.0 * step, 3.0 * step], step);
            for (i, text) in texts.iter().enumerate() {
                assert!(text.chars().count() <= 8, "{text} in steps of {step}");
                assert!(!texts[..i].contains(text), "{texts:?}");
            }
        }
    }
}

/// A magnitude begins at zero, and rounding noise does not fill its axes.
#[test]
fn noise_is_no_signal_and_magnitudes_begin_at_zero() {
    let mut session = Session::open(Scenario::builtin("case-3").expect("built in")).expect("it starts");
    session.seek(1.0);
    let table = signals(&session.scenario().machine);
    let mut choice = PlotChoice::default();
    let added = ["moment/dynamic", "force/dynamic_x", "energy/kinetic", "pin/worst", "angle/1"];
    added.iter().for_each(|path| choice.change(PlotChange::Plot((*path).into())));
    choice.change(PlotChange::Against("plot 1".into(), Some("moment/total".into())));
    for notation in [Notation::default(), Notation { angle: AngleUnit::Degrees, ..Notation::default() }] {
        let plots = choice.plots(session.scenario(), &table, false, notation);
        let wanted: Vec<Signal> =
            plots.iter().flat_map(|plot| plot.curves.iter().chain(&plot.against).map(|c| c.signal.clone())).collect();
        let samples: SignalSamples = stillbase::query::answer_sequence(&wanted, session.frames());
        let drawn = |name: &str| {
            let plot = plots.iter().find(|plot| plot.name == name || plot.title == name).expect("a plot");
            PlotLines::of(plot, &samples, &[], [0.0, 1.0], 600, false)
        };
        // The moments of a reactionless run are below a micronewton metre: a flat line in the middle.
        let length = |[low, high]: [f64; 2]| high - low;
        let moment = drawn("plot 1");
        assert!(length(moment.y) >= 1e-3 && length(moment.x) >= 1e-3, "{moment:?}");
        assert!(length(drawn("plot 2").y) >= 1e-2);
        let ticks = |y: [f64; 2]| round_ticks(y[0], y[1], 9.0).0;
        for name in ["Force on the base", "plot 3", "plot 4"] {
            let y = drawn(name).y;
            assert!(ticks(y).iter().all(|tick| *tick >= 0.0) && y[0] <= 0.0, "{name}: {y:?}");
        }
        // What may be negative is shown around its values.
        let angle = drawn("plot 5").y;
        assert!(angle[0] > 0.5 * angle[1], "{angle:?}");
    }
}

/// With a component of the force beside its norm, the axis goes as far down as the component.
#[test]
fn a_negative_value_extends_the_axis_of_a_magnitude() {
    assert_eq!(AxisKind::FromZero.bounds([0.2, 3.0], 0.5), [0.0, 4.0]);
    assert_eq!(AxisKind::FromZero.bounds([-1e-12, 1e-13], 0.5), [0.0, 0.5]);
    let [low, high] = AxisKind::FromZero.bounds([-2.0, 3.0], 0.5);
    assert!(low <= -2.0 && high >= 3.0);
    assert_eq!(AxisKind::Free.bounds([f64::INFINITY, f64::NEG_INFINITY], 0.5), [0.0, 1.0]);
    let machine = Scenario::builtin("case-3").expect("built in").machine;
    for signal in signals(&machine) {
        assert!(floor(&signal) > 0.0, "{} has no floor for {:?}", signal.path, signal.unit);
        if signal.symbol.starts_with('|') {
            assert!(signal.is_magnitude(), "{} is a norm", signal.path);
        }
    }
}

/// What is called a magnitude is never negative in runs of all kinds of machines.
#[test]
fn magnitudes_are_never_negative() {
    for name in ["case-1", "scara", "spacecraft", "four-drive"] {
        let mut session = Session::open(Scenario::builtin(name).expect("built in")).expect("it starts");
        session.seek(1.0);
        for signal in signals(&session.scenario().machine).iter().filter(|signal| signal.is_magnitude()) {
            let least = session.frames().iter().map(|frame| signal.value(frame)).fold(f64::INFINITY, f64::min);
            assert!(least >= -1e-9, "{name}: {} is {least}", signal.path);
        }
    }
}

/// A picture of a plot names the runs laid over: number, name, colour and dash of each.
#[test]
fn a_picture_names_the_runs_laid_over() {
    let mut session = Session::open(Scenario::builtin("case-1").expect("built in")).expect("it starts");
    session.seek(1.0);
    let table = signals(&session.scenario().machine);
    let choice = PlotChoice::default();
    let plots = choice.plots(session.scenario(), &table, false, Notation::default());
    let wanted: Vec<Signal> = plots[1].curves.iter().map(|c| c.signal.clone()).collect();
    let samples: SignalSamples = stillbase::query::answer_sequence(&wanted, session.frames());
    let p = palette(Theme::Light);
    let look =
        PlotContext { palette: &p, peaks: &session.frame().peaks, now: session.frame(), mark: None, hover: None };
    let drawn = PlotLines::of(&plots[1], &samples, &[(2, &samples), (7, &samples)], [0.0, 1.0], 600, false);
    let long = "Least torque & a name that goes on and on until nobody reads it any more".to_owned();
    let runs = [RunName { run: 2, title: "Other <pose>".into() }, RunName { run: 7, title: long.clone() }];
    for size in [[720.0, 320.0], [200.0, 120.0]] {
        let plain = Figure::of(&plots[1], &drawn, size, &look, &[]);
        let named = Figure::of(&plots[1], &drawn, size, &look, &runs);
        assert!(named.size[1] > plain.size[1] && plain.size == size);
        let height = |figure: &Figure| figure.axes.sides[3] - figure.axes.sides[1];
        assert!((height(&named) - height(&plain)).abs() < 1e-3, "the axes keep their size");
        let words = labels(&svg(&Page::of_web(named.clone())));
        let has = |start: &str| words.iter().any(|label| label.starts_with(start));
        assert!(has("the run on disp") && has("3") && has("8") && has("Other <pose>"), "{words:?}");
        assert!(!words.contains(&long) && words.iter().any(|label| label.ends_with('…')), "{words:?}");
        let samples: Vec<_> = named
            .items
            .iter()
            .filter_map(|item| match item {
                FigureItem::Line { points, colour, dash, inside: false, .. } => Some((points, *colour, *dash)),
                _ => None,
            })
            .collect();
        assert_eq!(samples.len(), 3);
        for (sample, run) in samples[1..].iter().zip([2, 7]) {
            assert_eq!((sample.1, sample.2), (run_colour(run, &p), dashes(run).0));
        }
        assert!(samples.iter().all(|(points, ..)| {
            points.iter().all(|[x, y]| (0.0..=size[0]).contains(x) && *y > 30.0 && *y < named.axes.sides[1])
        }));
    }
    assert!(figure(&[], 800.0, &p).is_none());
    assert!(figure(&runs, 800.0, &p).is_some_and(|figure| svg(&Page::of_web(figure)).contains("Other")));
}
