//! The pyramid over samples, held against a plain scan of all of them.

use proptest::prelude::*;
use stillbase::study::series::Series;

/// Mostly numbers, some of them alike, and now and then none.
fn sample() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -1e3..1e3_f64,
        2 => (-3..4_i32).prop_map(f64::from),
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY)],
    ]
}

/// What a scan of a stretch finds: places of the least and the greatest number, the first of equal ones, and sums.
fn scan(values: &[f64], from: usize, to: usize) -> Option<([usize; 2], usize, f64, f64)> {
    let numbers: Vec<(usize, f64)> = (from..to).map(|i| (i, values[i])).filter(|(_, x)| x.is_finite()).collect();
    let mut places = [numbers.first()?.0; 2];
    let (mut sum, mut squares) = (0.0, 0.0);
    for (i, x) in &numbers {
        if *x < values[places[0]] {
            places[0] = *i;
        }
        if *x > values[places[1]] {
            places[1] = *i;
        }
        sum += x;
        squares += x * x;
    }
    Some((places, numbers.len(), sum, squares))
}

fn agrees(series: &Series, values: &[f64], from: usize, to: usize) -> Result<(), TestCaseError> {
    let (got, statistics) = (series.extremes(from..to), series.statistics(from..to));
    let Some((places, count, sum, squares)) = scan(values, from, to) else {
        prop_assert!(got.is_none() && statistics.is_none());
        return Ok(());
    };
    prop_assert_eq!(got, Some(places));
    let s = statistics.expect("there are numbers");
    prop_assert_eq!((s.count, s.least, s.greatest), (count, values[places[0]], values[places[1]]));
    let n = count as f64;
    prop_assert!((s.mean - sum / n).abs() <= 1e-12 * (squares / n).sqrt().max(1e-300), "{} {}", s.mean, sum / n);
    prop_assert!((s.rms - (squares / n).sqrt()).abs() <= 1e-12 * s.rms);
    Ok(())
}

fn held(values: &[f64], cuts: &[(f64, f64)], kept: f64) -> Result<(), TestCaseError> {
    let mut series: Series = values.iter().copied().collect();
    let ends = |count: usize, (a, b): (f64, f64)| {
        let [a, b] = [a, b].map(|share| (share * (count + 1) as f64) as usize);
        (a.min(b), a.max(b))
    };
    for cut in cuts {
        let (from, to) = ends(values.len(), *cut);
        agrees(&series, values, from, to)?;
    }
    // Cut off and grown again, with other samples, nothing of the old ones is left.
    let kept = (kept * values.len() as f64) as usize;
    series.truncate(kept);
    let mut others = values[..kept].to_vec();
    agrees(&series, &others, 0, kept)?;
    others.extend(values[kept..].iter().map(|x| 0.5 - x));
    others[kept..].iter().for_each(|x| series.push(*x));
    for cut in cuts {
        let (from, to) = ends(others.len(), *cut);
        agrees(&series, &others, from, to)?;
    }
    Ok(())
}

fn case(most: usize) -> impl Strategy<Value = (Vec<f64>, Vec<(f64, f64)>, f64)> {
    let cuts = prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 8);
    (prop::collection::vec(sample(), 0..most), cuts, 0.0..1.0_f64)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn any_stretch_is_what_a_scan_finds((values, cuts, kept) in case(700)) {
        held(&values, &cuts, kept)?;
    }
}

/// A small wave on a large offset, where the difference of running sums would have no digits left.
#[test]
fn a_mean_far_from_zero_keeps_its_digits() {
    let offset = 1e9;
    let series: Series = (0..1_000_000).map(|i| offset + f64::from(i % 4)).collect();
    let s = series.statistics(999_984..1_000_000).expect("numbers");
    assert_eq!((s.mean - offset, s.least - offset, s.greatest - offset), (1.5, 0.0, 3.0));
}
