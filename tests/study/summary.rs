//! Summaries of many machines: they add up exactly, and say what the numbers themselves say.

use std::collections::BTreeSet;

use proptest::prelude::*;
use stillbase::study::tolerance::{
    BIN_WIDTH, BinValues, Distribution, Distributions, KnownRanks, Limits, Recount, SampleOutcome, Summary,
    Unmergeable, Yields, bin_of, lower_edge,
};

fn outcome(x: f64) -> SampleOutcome {
    SampleOutcome::of_numbers([x, 3.0 * x, 0.4 * x, x])
}

/// Numbers of many sizes, with zero, numbers next to zero, and equal ones.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => (-40.0..40.0).prop_map(f64::exp2),
        4 => 1.0..1.001,
        1 => Just(0.0),
        1 => Just(1.0),
        1 => (0_u64..1 << 53).prop_map(f64::from_bits),
    ]
}

fn whole(numbers: &[f64], limits: Limits) -> Summary {
    let outcomes: Vec<_> = numbers.iter().map(|x| outcome(*x)).collect();
    let mut sum = Summary::new(limits);
    sum.add(0, &outcomes);
    sum.hold(0..numbers.len() as u64);
    sum
}

fn each(of: &Distributions) -> [&Distribution; 4] {
    [&of.peak_moment, &of.peak_force, &of.rms_moment, &of.rms_force]
}

proptest! {
    /// Parts of any size, added up in any order and grouping, are the whole.
    #[test]
    fn parts_add_up_in_any_order(
        numbers in prop::collection::vec(number(), 1..200),
        cuts in prop::collection::vec(any::<prop::sample::Index>(), 0..6),
        order in any::<u64>(),
    ) {
        let limits = Limits { moment: Some(1.0), force: Some(2.5) };
        let ends: BTreeSet<usize> = cuts.iter().map(|cut| cut.index(numbers.len())).chain([0, numbers.len()]).collect();
        let ends: Vec<usize> = ends.into_iter().collect();
        let mut parts: Vec<Summary> = (ends.windows(2))
            .map(|ends| {
                let mut part = Summary::new(limits);
                let outcomes: Vec<_> = numbers[ends[0]..ends[1]].iter().map(|x| outcome(*x)).collect();
                part.add(ends[0] as u64, &outcomes);
                part.hold(ends[0] as u64..ends[1] as u64);
                part
            })
            .collect();
        // Two of them become one until one is left.
        let mut order = order;
        while parts.len() > 1 {
            let one = parts.swap_remove(order as usize % parts.len());
            order = order.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1) >> 1;
            let other = order as usize % parts.len();
            prop_assert!(parts[other].merge(&one).is_ok());
        }
        prop_assert!(parts[0] == whole(&numbers, limits));
        prop_assert_eq!(parts[0].machines().to_vec(), vec![0..numbers.len() as u64; 1]);
        prop_assert_eq!(parts[0].implausible(), None);
        // Nothing is counted twice.
        let twice = parts[0].clone().merge(&parts[0]);
        prop_assert_eq!(twice, Err(Unmergeable::Twice(0..numbers.len() as u64)));
    }

    /// What a summary says is what the numbers say, sorted and added up one by one.
    #[test]
    fn a_summary_says_what_its_numbers_say(numbers in prop::collection::vec(number(), 1..300), limit in 0.5..2.0) {
        let limits = Limits { moment: Some(limit), force: Some(limit) };
        let outcomes: Vec<_> = numbers.iter().map(|x| outcome(*x)).collect();
        let sum = whole(&numbers, limits);
        let want = Distributions::of(&outcomes).expect("machines");
        let mut known = KnownRanks::default();
        for values in BinValues::passes(&sum.quantile_bins()) {
            let mut again = Recount { values, ..Recount::default() };
            again.add(&outcomes);
            prop_assert_eq!(sum.learn(again.values, &mut known), Ok(()));
        }
        let (near, exact) = (sum.distributions(&KnownRanks::default()), sum.distributions(&known));
        let (near, exact) = (near.expect("machines"), exact.expect("machines"));
        for ((near, exact), want) in each(&near).into_iter().zip(each(&exact)).zip(each(&want)) {
            prop_assert_eq!(&exact.quantiles, &want.quantiles);
            prop_assert_eq!(exact.quantile_error, None);
            for (near, want) in near.quantiles.values.iter().zip(&want.quantiles.values) {
                let most = if *want < 1e-300 { 1e-300 } else { BIN_WIDTH * want };
                prop_assert!((near - want).abs() <= most, "{} {}", near, want);
            }
            let size = want.quantiles.values[8];
            prop_assert!((near.mean - want.mean).abs() <= 1e-13 * size, "{} {}", near.mean, want.mean);
            prop_assert!((near.deviation - want.deviation).abs() <= 1e-11 * size, "{:e} {:e}", near.deviation, want.deviation);
            prop_assert_eq!(near.histogram.counts.iter().sum::<u64>(), numbers.len() as u64);
            prop_assert!(near.histogram.edges.is_sorted() && near.histogram.edges.len() == near.histogram.counts.len() + 1);
        }
        prop_assert_eq!(sum.yields(), Yields::of(&outcomes, limits.moment, limits.force));
        let counted = numbers.iter().filter(|x| **x <= limit).count() as u64;
        let [least, most] = sum.within(0, limit);
        prop_assert!(least <= counted && counted <= most, "{} {} {}", least, counted, most);
    }

    /// A bin is what its leading bits say, and lower edges belong to their bins.
    #[test]
    fn bins_are_ordered(x in number(), y in number()) {
        prop_assert!(lower_edge(bin_of(x)) <= x && x < lower_edge(bin_of(x) + 1));
        prop_assert_eq!(bin_of(lower_edge(bin_of(y))), bin_of(y));
        prop_assert!(x > y || bin_of(x) <= bin_of(y));
    }

    /// Which machines a summary has is kept as the least number of ranges, whatever order they come in.
    #[test]
    fn machines_are_held_once(ranges in prop::collection::vec((0_u64..60, 0_u64..12), 0..20)) {
        let (mut sum, mut model) = (Summary::default(), BTreeSet::new());
        for (from, count) in ranges {
            let twice: Vec<u64> = (from..from + count).filter(|i| model.contains(i)).collect();
            match sum.hold(from..from + count) {
                None => {
                    prop_assert!(twice.is_empty());
                    model.extend(from..from + count);
                }
                // Those that are named were there before.
                Some(named) => prop_assert!(!named.is_empty() && named.into_iter().all(|i| twice.contains(&i))),
            }
        }
        let held: Vec<u64> = sum.machines().iter().cloned().flatten().collect();
        prop_assert_eq!(&held, &model.into_iter().collect::<Vec<_>>());
        prop_assert!(sum.machines().windows(2).all(|pair| pair[0].end < pair[1].start));
        let missing: Vec<u64> = sum.missing(100).into_iter().flatten().collect();
        prop_assert!((0..100).all(|i| held.contains(&i) != missing.contains(&i)));
    }
}

/// Numbers that differ only in their last places have a deviation all the same: sums do not lose it.
#[test]
fn small_deviations_are_not_lost() {
    let numbers: Vec<f64> = (0..1000).map(|i| 1.37 + 1e-9 * f64::from(i % 17)).collect();
    let got = whole(&numbers, Limits::default()).distributions(&KnownRanks::default()).expect("machines").peak_moment;
    let mean = numbers.iter().map(|x| x - 1.37).sum::<f64>() / 1000.0;
    let squares: f64 = numbers.iter().map(|x| (x - 1.37 - mean).powi(2)).sum();
    let want = (squares / 999.0).sqrt();
    assert!((got.deviation / want - 1.0).abs() < 1e-3, "{:e} {want:e}", got.deviation);
    // Equal numbers have none.
    let equal = whole(&[0.1; 50], Limits::default()).distributions(&KnownRanks::default()).expect("machines");
    assert!(equal.peak_moment.deviation < 1e-15 && equal.peak_moment.mean == 0.1, "{:?}", equal.peak_moment);
}
