//! The unit vectors' own cosine and sine against those of the system's library.

use proptest::prelude::*;
use stillbase::mechanics::planar::unit;

fn agrees(q: f64) -> Result<(), TestCaseError> {
    let e = unit(q);
    prop_assert!((e.re - q.cos()).abs() <= 2e-16, "cos {q}: {} and {}", e.re, q.cos());
    prop_assert!((e.im - q.sin()).abs() <= 2e-16, "sin {q}: {} and {}", e.im, q.sin());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn near_zero(q in -10.0..10.0) {
        agrees(q)?;
    }

    /// The reduction changes hands at 1e5.
    #[test]
    fn far_away(q in -3e5..3e5) {
        agrees(q)?;
    }

    /// Where the table changes rows, and on its rows.
    #[test]
    fn at_the_table_steps(half_steps in -4000i32..4000, off in -1e-12..1e-12) {
        agrees(f64::from(half_steps) * std::f64::consts::PI / 128.0 + off)?;
    }
}

#[test]
fn zero_is_exact_and_what_is_not_finite_gives_nan() {
    assert_eq!((unit(0.0).re, unit(0.0).im), (1.0, 0.0));
    for q in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(unit(q).re.is_nan() && unit(q).im.is_nan());
    }
}
