//! Numbers with units and arithmetic.

use std::f64::consts::PI;

use proptest::prelude::*;
use stillbase::settings::quantity::{QuantityError, read};

#[test]
fn numbers_are_read_with_units_and_arithmetic() {
    for (text, unit, want) in [
        ("30 deg", "rad", PI / 6.0),
        ("30°", "rad", PI / 6.0),
        ("0.5/2", "m", 0.25),
        ("1 cm", "m", 0.01),
        ("2*pi/3", "rad", 2.0 * PI / 3.0),
        ("2π/3", "rad", 2.0 * PI / 3.0),
        ("-3e-2 m", "m", -0.03),
        ("−3e-2 m", "m", -0.03),
        ("1 m - 2 cm + 3 mm", "m", 0.983),
        ("0.5/2 m", "m", 0.25),
        (" .5 ", "m", 0.5),
        ("5.", "", 5.0),
        ("2(3+4)", "", 14.0),
        ("2^10", "", 1024.0),
        ("--2", "s", 2.0),
        ("0.1 rad", "°", 0.1 * 180.0 / PI),
        ("45", "°", 45.0),
        ("20 ms", "s", 0.02),
        ("0.02 s", "ms", 20.0),
        ("3 N m", "N m", 3.0),
        ("3 Nm", "N m", 3.0),
        ("300 mN * 10 cm", "N m", 0.03),
        ("3 N m", "N m/rad", 3.0),
        ("500 g", "kg", 0.5),
        ("2 kg cm^2", "kg m²", 2e-4),
        ("60 rpm", "rad/s", 2.0 * PI),
        ("400 s⁻²", "s⁻²", 400.0),
        ("1 kHz", "Hz", 1000.0),
        ("10 mm", "m, rad", 0.01),
        ("10 deg", "m, rad", PI / 18.0),
        ("1 turn", "rad, four turns", 2.0 * PI),
        ("5 %", "", 0.05),
        ("4096", "counts", 4096.0),
    ] {
        let value = read(text, unit).unwrap_or_else(|why| panic!("{text} in {unit}: {why}"));
        assert!((value - want).abs() <= 1e-12 * want.abs(), "{text} in {unit}: {value}, not {want}");
    }
}

#[test]
fn what_is_no_number_is_named() {
    let cases = [
        ("abc", "m", "\"abc\" is not understood"),
        ("0,5", "m", "want a point, such as 0.5"),
        ("2*", "m", "something is missing"),
        ("(2", "m", "something is missing"),
        ("", "m", "something is missing"),
        ("2)", "m", "\")\" is not understood"),
        ("30 deg", "m", "30 deg is of another kind: want a number in m"),
        ("1 m", "", "1 m has a unit: want a plain number"),
        ("1 m + 1 s", "m", "different kinds"),
        ("1 m + 1", "m", "different kinds"),
        ("1/0", "m", "has no value"),
        ("1 Hz", "rad/s", "another kind"),
        ("2 2", "m", "\"2\" is not understood"),
        ("3e", "m", "\"e\" is not understood"),
        ("2^", "m", "something is missing"),
        ("1e999", "m", "has no value"),
    ];
    for (text, unit, words) in cases {
        let why = read(text, unit).expect_err(text).to_string();
        assert!(why.contains(words), "{text}: {why}");
    }
    assert_eq!(read(&"(".repeat(10_000), "m").expect_err("too deep"), QuantityError::Unknown("(((".into()));
    assert!(read(&"-".repeat(100_000), "m").is_err());
}

proptest! {
    /// Whatever a number is written like by itself, it is read as it is.
    #[test]
    fn a_plain_number_is_read_exactly(x in -1e12..1e12_f64) {
        prop_assert_eq!(read(&x.to_string(), "m"), Ok(x));
        prop_assert_eq!(read(&format!("{x:e}"), "m"), Ok(x));
    }

    /// No text does harm, and what is said of it is short.
    #[test]
    fn any_text_is_read_or_refused(text in "[-+*/^().,0-9a-z°²⁻π% ]{0,40}") {
        if let Err(why) = read(&text, "N m/rad") {
            prop_assert!(why.to_string().chars().count() < 120, "{}", why);
        }
    }
}
