//! A machine balanced by counterweights: what the answer says is what the machine that comes out is.

use stillbase::mechanics::counterweights::{
    CounterweightSite, CounterweightSpec, CounterweightStock, Objective, place_weights,
};
use stillbase::mechanics::machine::Inertia;
use stillbase::query::{Portion, Query, Shared, answer_now};
use stillbase::study::balance_constants::BalanceConstants;
use stillbase::study::counterweights::{CounterweightRequest, NoCounterweights, balance_by_weights};
use stillbase::study::lengths::{FreeLength, LengthSearch, LengthsQuery, NoLengths, search};

use crate::support::family_machine;

fn weighing() -> CounterweightSpec {
    let bare = family_machine("nine-link-bare");
    CounterweightSpec::least(Objective::inertia(), CounterweightSite::anywhere(&bare), CounterweightStock::STEEL)
}

fn lengths(starts: usize) -> LengthSearch {
    LengthSearch {
        lengths: vec![FreeLength { name: "l5".into(), bounds: [0.3, 0.6] }],
        spec: weighing(),
        anywhere: true,
        least_reach: None,
        least_workspace: None,
        starts,
        seed: 5,
    }
}

#[test]
fn the_report_is_of_the_machine_that_comes_out() {
    let bare = family_machine("nine-link-bare");
    let asked = CounterweightRequest { spec: weighing(), lengths: None, front: Some(3), bars: None };
    let (machine, report) =
        balance_by_weights(&bare, &asked, None, &mut |_| true, &|| true).expect("it can be balanced");
    let placed = place_weights(&bare, &asked.spec).expect("it can be balanced");
    let inertia = Inertia::of(&machine);
    assert!(report.is_balanced && inertia.is_balanced() && report.certified == placed.is_certified());
    assert_eq!(report.weights, machine.spec().counterweights);
    assert_eq!(report.balance, BalanceConstants::of(&inertia));
    assert_eq!((report.gap, report.measures.added_mass), (placed.gap, inertia.mass() - Inertia::of(&bare).mass()));
    assert!(report.optimised_lengths.is_none() && report.taken_off.is_empty() && report.front.len() == 3);
    // From light to quick.
    assert!(report.front.windows(2).all(|w| w[0][0] <= w[1][0] + 1e-9 && w[0][1] + 1e-9 >= w[1][1]));
    let heavy = CounterweightSpec { max_added_mass: Some(1e-3), ..weighing() };
    let refused =
        balance_by_weights(&bare, &CounterweightRequest { spec: heavy, ..asked }, None, &mut |_| true, &|| true);
    assert!(matches!(refused, Err(NoCounterweights::Weights(_))));
}

#[test]
fn what_it_had_is_taken_off_and_lengths_are_sought() {
    let bare = family_machine("nine-link-bare");
    let asked = CounterweightRequest { spec: weighing(), lengths: None, front: None, bars: None };
    let (weighed, first) =
        balance_by_weights(&bare, &asked, None, &mut |_| true, &|| true).expect("it can be balanced");
    let (_, again) = balance_by_weights(&weighed, &asked, None, &mut |_| true, &|| true).expect("it can be balanced");
    assert_eq!(again.taken_off, first.weights);
    let asked = CounterweightRequest { lengths: Some(lengths(2)), ..asked };
    let (longer, report) =
        balance_by_weights(&bare, &asked, None, &mut |_| true, &|| true).expect("it can be balanced");
    let sought = report.optimised_lengths.expect("lengths");
    assert_eq!((&*sought.lengths[0].0, sought.starts, sought.certified), ("l5", 2, false));
    assert!((longer.spec().lengths["l5"] - sought.lengths[0].1).abs() < 1e-12);
}

/// The query finds what the search does, and stops when nobody waits for it any more.
#[test]
fn lengths_are_a_query() {
    let bare = family_machine("nine-link-bare");
    let found = search(&bare, &lengths(2), &mut |_| true).expect("there is one");
    assert_eq!(answer_now::<LengthsQuery>((Shared(bare.clone().into()), lengths(2))), Ok(found));
    let mut left = 5;
    let mut goes_on = |share: f64| {
        assert!((0.0..=1.0).contains(&share));
        left -= 1;
        left > 0
    };
    let mut work = LengthsQuery::begin((Shared(bare.clone().into()), lengths(2)));
    assert_eq!(work.go_on(&mut goes_on), Portion::Stopped);
    let nothing = LengthSearch { lengths: vec![FreeLength { name: "none".into(), bounds: [0.1, 0.2] }], ..lengths(1) };
    assert!(!matches!(answer_now::<LengthsQuery>((Shared(bare.into()), nothing)), Ok(_) | Err(NoLengths::Weights(_))));
}
