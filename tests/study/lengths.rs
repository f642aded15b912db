//! Lengths that are sought: what a search finds holds what is asked for, and a grid of all lengths finds nothing better.

use stillbase::mechanics::counterweights::{
    CounterweightSite, CounterweightSpec, CounterweightStock, Objective, place_weights,
};
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::study::lengths::{FreeLength, LengthSearch, NoLengths, search};

use crate::support::family_machine;

fn asked(machine: &Machine, lengths: &[(&str, [f64; 2])]) -> LengthSearch {
    LengthSearch {
        lengths: lengths.iter().map(|(name, ends)| FreeLength { name: (*name).into(), bounds: *ends }).collect(),
        spec: CounterweightSpec::least(
            Objective::inertia(),
            CounterweightSite::anywhere(machine),
            CounterweightStock::STEEL,
        ),
        anywhere: true,
        least_reach: Some(1.26),
        least_workspace: None,
        starts: 3,
        seed: 5,
    }
}

/// The machine with other lengths of its last two arms, made by hand: every bar weighs 1 kg/m.
fn by_hand(bare: &Machine, l5: f64, l9: f64) -> Machine {
    let mut spec = bare.spec().clone();
    for (name, now) in [("l5", l5), ("l9", l9)] {
        let was = spec.lengths.insert(name.into(), now).expect("it has one");
        for link in &mut spec.links {
            let shared = match &link.length {
                stillbase::mechanics::machine::Length::Named(shared) => shared.clone(),
                stillbase::mechanics::machine::Length::Metres(_) => continue,
            };
            if shared == name {
                let scale = now / was;
                link.mass *= scale;
                link.com *= scale;
                link.inertia *= scale * scale * scale;
            }
        }
    }
    Machine::new(spec).expect("in range")
}

#[test]
fn a_grid_of_lengths_finds_nothing_better() {
    let bare = family_machine("nine-link-bare");
    let asked = asked(&bare, &[("l5", [0.3, 0.6]), ("l9", [0.2, 0.5])]);
    let found = search(&bare, &asked, &mut |_| true).expect("there is one");
    let inertia = Inertia::of(&found.placed.machine);
    assert!(inertia.is_balanced() && found.placed.gap < 1e-6);
    assert!(0.5 + found.lengths[0] + found.lengths[1] > 1.26 - 1e-9, "{:?}", found.lengths);
    assert!(found.starts[1] >= 1 && found.starts[0] == 3);
    let mut least = f64::INFINITY;
    for i in 0..=12 {
        for j in 0..=12 {
            let (l5, l9) = (0.3 + 0.025 * f64::from(i), 0.2 + 0.025 * f64::from(j));
            if 0.5 + l5 + l9 < 1.26 {
                continue;
            }
            let machine = by_hand(&bare, l5, l9);
            let weighing = CounterweightSpec { sites: CounterweightSite::anywhere(&machine), ..asked.spec.clone() };
            least = least.min(place_weights(&machine, &weighing).expect("it can be balanced").value);
        }
    }
    assert!(found.placed.value < least + 1e-6, "{} against {least}", found.placed.value);
    assert!(found.placed.value > 0.9 * least, "{} against {least}", found.placed.value);
    let by_hand = by_hand(&bare, found.lengths[0], found.lengths[1]);
    assert!((by_hand.mass() + found.placed.added_mass - found.placed.machine.mass()).abs() < 1e-9);
}

/// The same seed finds the same, and a search that is stopped has the best so far.
#[test]
fn a_search_is_the_same_again_and_can_be_stopped() {
    let bare = family_machine("nine-link-bare");
    let asked = asked(&bare, &[("l9", [0.2, 0.6])]);
    let [one, other] = [(); 2].map(|()| search(&bare, &asked, &mut |_| true).expect("there is one"));
    assert_eq!(one, other);
    let mut best = f64::INFINITY;
    let mut stop = |progress: stillbase::study::lengths::SearchProgress| {
        best = progress.best;
        progress.machines < 4
    };
    let stopped = search(&bare, &asked, &mut stop).expect("it has seen some");
    assert!(stopped.machines <= 6 && stopped.placed.value == best && best >= one.placed.value);
}

#[test]
fn what_cannot_be_sought_is_refused() {
    let bare = family_machine("nine-link-bare");
    let words = |asked: &LengthSearch| search(&bare, asked, &mut |_| true).expect_err("it cannot be").to_string();
    assert!(words(&asked(&bare, &[("l7", [0.1, 0.2])])).contains("want one of l1, l2, l3, l5, l9"));
    assert!(words(&asked(&bare, &[("l9", [0.2, 0.1])])).contains("the first below the second"));
    assert!(words(&asked(&bare, &[("l9", [0.2, 0.3]), ("l9", [0.2, 0.4])])).contains("two ranges"));
    assert!(words(&asked(&bare, &[])).contains("nothing to seek"));
    let far = LengthSearch { least_reach: Some(9.0), ..asked(&bare, &[("l9", [0.2, 0.3])]) };
    assert!(matches!(search(&bare, &far, &mut |_| true), Err(NoLengths::None { .. })));
}

/// A workspace that is asked for is there.
#[test]
fn a_workspace_is_kept() {
    let bare = family_machine("nine-link-bare");
    let area = |least_workspace| {
        let asked = LengthSearch {
            least_reach: None,
            least_workspace,
            starts: 1,
            ..asked(&bare, &[("l5", [0.3, 0.6]), ("l9", [0.2, 0.5])])
        };
        let found = search(&bare, &asked, &mut |_| true).expect("there is one");
        let planes = crate::support::planes(&found.placed.machine);
        (planes.boundary().area(), found.placed.value)
    };
    let ((free, least), (kept, value)) = (area(None), area(Some(0.8)));
    assert!(free < 0.8 && kept >= 0.8 && value > least, "{free} {kept}");
}
