//! Lines as they are drawn, held against all samples; and samples that follow a session.

use proptest::prelude::*;
use stillbase::query::{Queries, RevisionMark};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session};
use stillbase::simulation::signals::{Signal, signals};
use stillbase::study::samples::SignalSamples;
use stillbase::study::series::Series;

fn samples(values: &[f64], across: &[f64], step: f64) -> SignalSamples {
    let series = |values: &[f64]| values.iter().copied().collect::<Series>();
    let times = (0..values.len()).map(|i| step * i as f64).collect();
    SignalSamples::of(times, [("y".to_owned(), series(values)), ("x".to_owned(), series(across))])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// In every column of pixels the line is as high and as low as the samples are, it begins and ends there as they do,
    /// it goes through samples only, and it has few points.
    #[test]
    fn no_column_loses_a_peak(
        values in prop::collection::vec(prop_oneof![9 => -1.0..1.0_f64, 1 => -50.0..50.0_f64], 2..3000),
        shown in (0.0..1.0_f64, 0.0..1.0_f64),
        columns in 1..90_usize,
        step in prop::sample::select(vec![1e-5, 1e-3, 0.37]),
    ) {
        let samples = samples(&values, &values, step);
        let end = step * (values.len() - 1) as f64;
        let shown = [end * shown.0.min(shown.1), end * shown.0.max(shown.1)];
        prop_assume!(shown[1] - shown[0] > step);
        let line = samples.line("y", shown, columns);
        prop_assert!(line.is_sorted_by(|a, b| a[0] < b[0]));
        prop_assert!(line.len() <= 4 * (columns + 4), "{} points in {columns} columns", line.len());
        for [time, value] in &line {
            let i = (time / step).round() as usize;
            prop_assert_eq!((samples.times()[i], values[i]), (*time, *value));
        }
        let width = (shown[1] - shown[0]) / columns as f64;
        let column = |time: f64| (time / width).floor() as i64;
        let within = samples.within(shown);
        let mut from = within.start;
        while from < within.end {
            let this = column(samples.times()[from]);
            let to = (from..within.end).find(|i| column(samples.times()[*i]) != this).unwrap_or(within.end);
            // What lies at the edge of the range shares its column with samples outside.
            if from > within.start && to < within.end {
                let all = values[from..to].iter();
                let want = all.fold([f64::INFINITY, f64::NEG_INFINITY], |m, y| [m[0].min(*y), m[1].max(*y)]);
                let here: Vec<f64> =
                    line.iter().filter(|p| p[0] >= samples.times()[from] && p[0] < samples.times()[to]).map(|p| p[1]).collect();
                let got = here.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |m, y| [m[0].min(*y), m[1].max(*y)]);
                prop_assert_eq!(got, want);
                prop_assert_eq!([here[0], here[here.len() - 1]], [values[from], values[to - 1]]);
            }
            from = to;
        }
        let all = values[within.clone()].iter();
        let want = all.fold([f64::INFINITY, f64::NEG_INFINITY], |m, y| [m[0].min(*y), m[1].max(*y)]);
        prop_assert_eq!(samples.bounds("y", shown), Some(want));
    }

    /// One signal against another keeps the outermost points of both, goes through samples only and has few points.
    #[test]
    fn one_against_another_keeps_its_outline(
        pairs in prop::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 2..3000),
        most in 12..400_usize,
    ) {
        let (x, y): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
        let samples = samples(&y, &x, 0.01);
        let shown = [0.0, 0.01 * pairs.len() as f64];
        let line = samples.line_against("x", "y", shown, most);
        prop_assert!(line.len() <= most + 6, "{} points of {most}", line.len());
        let mut rest = pairs.iter();
        for [a, b] in &line {
            prop_assert!(rest.any(|pair| pair == &(*a, *b)), "in the order of time");
        }
        for k in 0..2 {
            let ends = |all: &mut dyn Iterator<Item = f64>| all.fold([9.9, -9.9], |m: [f64; 2], v| [m[0].min(v), m[1].max(v)]);
            let all = if k == 0 { &x } else { &y };
            prop_assert_eq!(ends(&mut line.iter().map(|p| p[k])), ends(&mut all.iter().copied()));
        }
    }
}

fn wanted(table: &[Signal]) -> Vec<Signal> {
    table.iter().filter(|s| ["torque", "moment", "pose"].contains(&s.group())).cloned().collect()
}

/// Whatever is done to a session, its samples are those of its frames: added to while it runs, made anew when it is.
#[test]
fn samples_follow_a_session() {
    let mut session = Session::open(Scenario::builtin("case-3").expect("built in")).expect("it starts");
    let table = signals(&session.scenario().machine);
    let (at_once, in_portions) = (Queries::default(), Queries::default());
    let mut known: Option<RevisionMark> = None;
    let (mut again, mut checks) = (0, 0);
    let mut check = |session: &Session, what: &str| {
        // Asked for less in between: what comes back later is whole.
        let all = wanted(&table);
        let asked = &if checks % 3 == 1 { all[..2].to_vec() } else { all };
        let samples = at_once.grow::<SignalSamples>(asked, session.frames(), usize::MAX);
        let portions = (0..100).find(|_| in_portions.grow::<SignalSamples>(asked, session.frames(), 37).is_whole);
        let bit_by_bit = in_portions.grow::<SignalSamples>(asked, session.frames(), 0);
        let [samples, bit_by_bit] = [&samples, &bit_by_bit].map(|grown| grown.answer().expect("just asked"));
        assert!(portions.is_some() && bit_by_bit.times() == samples.times(), "{what}");
        checks += 1;
        let revision = session.frames().revision();
        again += usize::from(known.replace(revision.mark()).is_none_or(|known| revision.unchanged_since(&known) == 0));
        assert_eq!(samples.times().len(), session.frames().len(), "{what}");
        for signal in asked {
            let got = samples.series(&signal.path).expect("asked for").values();
            let want: Vec<f64> = session.frames().iter().map(|f| signal.value(f)).collect();
            assert!(got.iter().zip(&want).all(|(a, b)| a.to_bits() == b.to_bits()), "{what}: {}", signal.path);
            assert_eq!(bit_by_bit.series(&signal.path).map(|s| s.values()), Some(got), "{what}: {}", signal.path);
            let s = samples.statistics(&signal.path, [0.0, 1e9]).expect("numbers");
            assert_eq!(s.greatest, want.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x)), "{what}: {}", signal.path);
        }
    };
    check(&session, "opened");
    session.play();
    for steps in [1, 15, 16, 100, 333] {
        session.tick(steps);
        check(&session, "played");
    }
    session.apply(Edit::SlideB { b: 2.45 }).expect("it moves");
    check(&session, "led at the present instant");
    session.apply(Edit::SlideB { b: 2.5 }).expect("it moves");
    check(&session, "led on");
    session.end_gesture();
    session.tick(200);
    check(&session, "played on");
    // A copy that was led elsewhere takes its place, as work beside the window does it.
    let mut copy = session.clone();
    session.tick(40);
    check(&session, "played while something is under way");
    copy.apply(Edit::SlideB { b: 2.35 }).expect("it moves");
    copy.tick(60);
    session = copy;
    check(&session, "replaced by a copy");
    session.pause();
    session.seek(0.1);
    session.apply(Edit::SlideB { b: 2.3 }).expect("it moves");
    check(&session, "led from an earlier instant");
    session.undo().expect("it was");
    check(&session, "undone");
    session.apply(Edit::set("plant.payload.mass", 0.3)).expect("it holds");
    check(&session, "with a payload");
    session.switch(Scenario::builtin("case-1").expect("built in")).expect("it starts");
    check(&session, "another scenario");
    session.seek(0.7);
    check(&session, "simulated to an instant");
    assert!(again >= 3, "made anew {again} times");
}
