//! Differences between tables of signals.

use proptest::prelude::*;
use stillbase::simulation::signal_table::{SignalColumn, SignalTable};
use stillbase::study::difference::{TableDifference, Tolerances};

fn table(time: &[f64], columns: &[(&str, &str, &[f64])]) -> SignalTable {
    let column = |(path, unit, values): &(&str, &str, &[f64])| SignalColumn {
        path: (*path).into(),
        unit: (*unit).into(),
        values: values.to_vec(),
    };
    SignalTable { time: time.to_vec(), columns: columns.iter().map(column).collect() }
}

fn between(a: &SignalTable, b: &SignalTable) -> TableDifference {
    TableDifference::between(a, b, &Tolerances::default())
}

#[test]
fn one_number_of_many_is_found_with_its_units_in_the_last_place() {
    let time = [0.0, 0.1, 0.2];
    let a = table(&time, &[("torque/1", "N m", &[1.0, 2.0, 3.0]), ("angle/1", "rad", &[-1.0, 0.0, 1.0])]);
    let next = f64::from_bits(2.0_f64.to_bits() + 3);
    let b = table(&time, &[("torque/1", "N m", &[1.0, next, 3.0]), ("angle/1", "rad", &[-1.0, -0.0, 1.0])]);
    let difference = between(&a, &b);
    assert!(!difference.is_within() && !difference.is_equal());
    let (signal, first) = difference.first().expect("a difference");
    assert_eq!((signal.path.as_str(), first.time, first.units_in_the_last_place()), ("torque/1", 0.1, Some(3)));
    // Both zeros are one number, and the numbers beside zero are two apart.
    assert_eq!(difference.signals[1].first, None);
    let tiny = f64::from_bits(1);
    let sides = between(&table(&[0.0], &[("x", "m", &[tiny])]), &table(&[0.0], &[("x", "m", &[-tiny])]));
    assert_eq!(sides.signals[0].largest.units_in_the_last_place(), Some(2));
    let ends = between(&table(&[0.0], &[("x", "m", &[f64::MIN])]), &table(&[0.0], &[("x", "m", &[f64::MAX])]));
    assert!(ends.signals[0].largest.units_in_the_last_place() > Some(1 << 63));
}

#[test]
fn a_tolerance_belongs_to_a_signal_a_group_or_all_others() {
    let a = table(&[0.0], &[("torque/1", "N m", &[1.0]), ("torque/2", "N m", &[1.0]), ("angle/1", "rad", &[1.0])]);
    let b = table(&[0.0], &[("torque/1", "N m", &[1.1]), ("torque/2", "N m", &[1.1]), ("angle/1", "rad", &[1.1])]);
    let named = |all: f64, list: &[(&str, f64)]| Tolerances {
        all,
        relative: 0.0,
        named: list.iter().map(|(name, x)| ((*name).to_owned(), *x)).collect(),
    };
    let past = |tolerances: &Tolerances| {
        let difference = TableDifference::between(&a, &b, tolerances);
        let past: Vec<String> =
            difference.signals.iter().filter(|s| s.first.is_some()).map(|s| s.path.clone()).collect();
        past.join(" ")
    };
    assert_eq!(past(&named(0.2, &[])), "");
    assert_eq!(past(&named(0.2, &[("torque", 0.0)])), "torque/1 torque/2");
    assert_eq!(past(&named(0.0, &[("torque", 0.2), ("torque/2", 0.0)])), "torque/2 angle/1");
    let relative = Tolerances { relative: 0.1, ..Tolerances::default() };
    assert_eq!(past(&relative), "", "0.1 of 1.1");
}

#[test]
fn what_only_one_table_has_is_a_difference() {
    let a = table(&[0.0, 1.0], &[("torque/1", "N m", &[1.0, 1.0]), ("old", "m", &[0.0, 0.0])]);
    let b = table(&[0.0, 1.0], &[("torque/1", "N", &[1.0, 1.0]), ("new", "m", &[0.0, 0.0])]);
    let difference = between(&a, &b);
    assert_eq!(difference.unmatched, [vec!["old".to_owned()], vec!["new".to_owned()]]);
    assert_eq!(difference.units, [("torque/1".to_owned(), ["N m".to_owned(), "N".to_owned()])]);
    assert!(!difference.is_within());
    let shorter = table(&[0.0], &[("torque/1", "N m", &[1.0]), ("old", "m", &[0.0])]);
    assert!(!between(&a, &shorter).is_within() && between(&a, &shorter).signals.iter().all(|s| s.first.is_none()));
    let later = table(&[1.0], &[("torque/1", "N m", &[1.0]), ("old", "m", &[0.0])]);
    assert_eq!((between(&a, &later).has_same_ends(), between(&a, &later).is_within()), ([false, true], false));
    let apart = table(&[2.0, 3.0], &[("torque/1", "N m", &[1.0, 1.0]), ("old", "m", &[0.0, 0.0])]);
    assert_eq!((between(&a, &apart).overlap, between(&a, &apart).is_within()), (None, false));
    let none = SignalTable::default();
    assert!(!between(&none, &none).is_within(), "nothing was compared");
}

#[test]
fn no_number_equals_no_number_alone() {
    let of = |x: f64| table(&[0.0], &[("x", "m", &[x])]);
    assert!(between(&of(f64::NAN), &of(f64::NAN)).is_equal());
    assert!(between(&of(f64::INFINITY), &of(f64::INFINITY)).is_equal());
    let loose = Tolerances { all: 1e300, relative: 1.0, named: Vec::new() };
    for (a, b) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::INFINITY, f64::NEG_INFINITY)] {
        let difference = TableDifference::between(&of(a), &of(b), &loose);
        assert!(!difference.is_within(), "{a} and {b}");
    }
}

/// Runs of steps that do not divide their duration end up to a step apart; where nothing is permitted, that differs.
#[test]
fn ends_may_be_a_row_apart_where_a_tolerance_is_given() {
    let run = |step: f64, end: f64| {
        let time: Vec<f64> = (0..).map(|i| step * f64::from(i)).take_while(|t| *t < end + 0.999 * step).collect();
        let (line, on): (Vec<f64>, Vec<f64>) = time.iter().map(|t| (2.0 * t, f64::from(*t >= 0.5))).unzip();
        table(&time, &[("x", "m", &line), ("payload/held", "1", &on)])
    };
    let loose = Tolerances { all: 1e-9, ..Tolerances::default() };
    let (fine, coarse) = (run(0.001, 1.0), run(0.0007, 1.0));
    let difference = TableDifference::between(&fine, &coarse, &loose);
    assert!(difference.is_within() && !difference.is_equal(), "{}", difference.sentence(""));
    assert!(difference.interpolated > 500 && difference.ends[0] != difference.ends[1]);
    assert!(!between(&fine, &coarse).is_within());
    assert!(!TableDifference::between(&fine, &run(0.0007, 0.99), &loose).is_within(), "ten rows are missing");
    // A switch that is late by more than a row differs.
    let late = |at: f64| {
        let mut run = run(0.0007, 1.0);
        for (t, on) in run.time.iter().zip(&mut run.columns[1].values) {
            *on = f64::from(*t >= at);
        }
        TableDifference::between(&fine, &run, &loose)
    };
    assert!(late(0.5005).is_within() && !late(0.503).is_within());
    // Rows that one table lacks are told.
    let half = table(&[0.0, 0.2], &[("x", "m", &[0.0, 0.4])]);
    let whole = table(&[0.0, 0.1, 0.2], &[("x", "m", &[0.0, 0.2, 0.4])]);
    assert_eq!(between(&half, &whole).sentence(""), "equal: 1 signal at 2 instants, of 2 and 3 rows");
}

proptest! {
    /// A straight line is the same however it is sampled, and a bent one differs by at most its sagitta.
    #[test]
    fn lines_agree_on_any_steps(
        steps in prop::collection::vec(0.01..0.3_f64, 2..40),
        other in prop::collection::vec(0.01..0.3_f64, 2..40),
        slope in -3.0..3.0_f64,
        bend in -2.0..2.0_f64,
    ) {
        let grid = |steps: &[f64]| {
            let whole: f64 = steps.iter().sum();
            let inner = steps[..steps.len() - 1].iter().scan(0.0, |at, step| { *at += step / whole; Some(*at) });
            let times: Vec<f64> = std::iter::once(0.0).chain(inner).chain([1.0]).collect();
            times
        };
        let sampled = |times: &[f64], bend: f64| {
            let values: Vec<f64> = times.iter().map(|t| 0.5 + slope * t + bend * t * t).collect();
            table(times, &[("x", "m", &values)])
        };
        let (a, b) = (grid(&steps), grid(&other));
        let straight = between(&sampled(&a, 0.0), &sampled(&b, 0.0));
        prop_assert!(straight.signals[0].largest.size() < 1e-12);
        prop_assert_eq!(straight.instants, a.len().min(b.len()));
        prop_assert_eq!(straight.has_same_ends(), [true; 2]);
        let finer = if a.len() <= b.len() { &b } else { &a };
        let widest = finer.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        let bent = between(&sampled(&a, bend), &sampled(&b, bend));
        prop_assert!(bent.signals[0].largest.size() <= 0.25 * bend.abs() * widest * widest + 1e-12);
    }

    /// The difference is symmetric, and no number is passed over: it is the largest of a plain scan.
    #[test]
    fn the_largest_difference_is_that_of_a_scan(
        values in prop::collection::vec((-1e3..1e3_f64, -1e3..1e3_f64), 1..60),
        tolerance in 0.0..500.0_f64,
    ) {
        let time: Vec<f64> = (0..values.len()).map(|i| 0.001 * i as f64).collect();
        let (a, b): (Vec<f64>, Vec<f64>) = values.iter().copied().unzip();
        let [a, b] = [a, b].map(|values| table(&time, &[("x", "m", &values)]));
        let tolerances = Tolerances { all: tolerance, ..Tolerances::default() };
        let [there, back] = [(&a, &b), (&b, &a)].map(|(a, b)| TableDifference::between(a, b, &tolerances));
        let sizes: Vec<f64> = values.iter().map(|(a, b)| (a - b).abs()).collect();
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let first = sizes.iter().position(|size| *size > tolerance);
        for got in [&there, &back] {
            prop_assert_eq!(got.signals[0].largest.size(), largest);
            prop_assert_eq!(got.first().map(|(_, at)| at.time), first.map(|i| time[i]));
            prop_assert_eq!(got.is_within(), first.is_none());
        }
    }
}
