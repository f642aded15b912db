//! Points of studies of designs: grids, points that fill a box, and those that no other is better than.

use std::collections::BTreeSet;

use proptest::prelude::*;
use stillbase::study::design_space::{Axis, AxisValues, DesignSpace, NoDesignSpace, non_dominated};

fn listed(key: &str, count: usize) -> Axis {
    Axis { key: key.into(), values: AxisValues::Listed((0..count).map(|i| format!("{key}{i}")).collect()) }
}

fn between(key: &str, ends: [f64; 2]) -> Axis {
    Axis { key: key.into(), values: AxisValues::Between(ends) }
}

#[test]
fn a_grid_has_every_combination_once() {
    let space = DesignSpace::new(vec![listed("a", 3), listed("b", 4), listed("c", 2)], None).expect("a grid");
    let all: Vec<Vec<String>> = (0..space.count()).map(|i| space.point(i)).collect();
    assert_eq!((all.len(), all.iter().collect::<BTreeSet<_>>().len()), (24, 24));
    assert_eq!([&all[0], &all[1], &all[2]].map(|values| values.join(" ")), ["a0 b0 c0", "a0 b0 c1", "a0 b1 c0"]);
    for (axes, want) in [
        (vec![between("a", [0.0, 1.0])], NoDesignSpace::Endless("a".into())),
        (vec![listed("a", 2), listed("a", 3)], NoDesignSpace::Twice("a".into())),
        (vec![listed("a", 100_000), listed("b", 100_000)], NoDesignSpace::TooMany),
    ] {
        assert_eq!(DesignSpace::new(axes, None), Err(want));
    }
}

/// Points fill a box more evenly than random ones: any box in it holds its share of them, to within the standard deviation
/// that random ones have in a quarter of the box.
#[test]
fn points_fill_a_box() {
    let axes = vec![between("x", [-1.0, 1.0]), between("y", [2.0, 4.0]), listed("m", 3)];
    let (space, count) = (DesignSpace::new(axes, Some(4000)).expect("a box"), 4000);
    let points: Vec<(f64, f64, String)> = (0..count)
        .map(|i| {
            let [x, y, m] = space.point(i).try_into().expect("three values");
            (x.parse().expect("a number"), y.parse().expect("a number"), m)
        })
        .collect();
    assert!(points.iter().all(|(x, y, _)| (-1.0..=1.0).contains(x) && (2.0..=4.0).contains(y)));
    for (x_from, x_to, y_from, y_to) in [(-1.0, 0.0, 2.0, 3.0), (-0.3, 0.2, 2.5, 3.9), (0.9, 1.0, 2.0, 4.0)] {
        let inside = |(x, y, _): &&(f64, f64, String)| (x_from..x_to).contains(x) && (y_from..y_to).contains(y);
        let share = (x_to - x_from) * (y_to - y_from) / 4.0;
        let got = points.iter().filter(inside).count() as f64 / count as f64;
        assert!((got - share).abs() < 0.0068, "{got} {share}");
    }
    for m in ["m0", "m1", "m2"] {
        let got = points.iter().filter(|(.., own)| own == m).count();
        assert!(got.abs_diff(1333) < 12, "{m}: {got}");
    }
    // More points continue the same sequence.
    let more = DesignSpace::new(space.axes().to_vec(), Some(9000)).expect("a box");
    assert!((0..count).all(|i| more.point(i) == space.point(i)));
}

proptest! {
    #[test]
    fn what_is_kept_is_not_dominated(pairs in prop::collection::vec((0_u32..12, 0_u32..12), 1..40)) {
        let measures: Vec<[f64; 2]> = pairs.iter().map(|(a, b)| [f64::from(*a), f64::from(*b)]).collect();
        let kept = non_dominated(&measures);
        for i in &kept {
            let [a, b] = measures[*i];
            prop_assert!(measures.iter().all(|[c, d]| !(c <= &a && d <= &b && (c < &a || d < &b))), "{a} {b}");
        }
        // Every other one is dominated by one that is kept, or equal to it.
        for [a, b] in &measures {
            prop_assert!(kept.iter().any(|i| measures[*i][0] <= *a && measures[*i][1] <= *b));
        }
        prop_assert!(kept.windows(2).all(|pair| measures[pair[0]][0] < measures[pair[1]][0]));
    }
}
