//! Units and names by the user's choice.

use stillbase::picture::notation::{AngleUnit, LengthUnit, NameOrder, Notation};

const DEGREES: Notation = Notation { angle: AngleUnit::Degrees, length: LengthUnit::Metres, names: NameOrder::Terms };
const MILLIMETRES: Notation =
    Notation { angle: AngleUnit::Radians, length: LengthUnit::Millimetres, names: NameOrder::Symbols };

#[test]
fn sentences_take_the_chosen_unit_of_angles() {
    let cases = [
        ("b = 2.400 rad would reach it", "b = 137.51° would reach it"),
        ("want 1.200 to 1.350 rad, or \"turn the task too\"", "want 68.75 to 77.35°, or \"turn the task too\""),
        ("b = −0.50 rad · 0.845 m²", "b = −28.6° · 0.845 m²"),
        ("3 poses at 0.5 rad", "3 poses at 29°"),
        ("b 2.400 rad  ·  one pose", "b 137.51°  ·  one pose"),
        ("at most 3.00 rad/s and 2.00 rad/s²", "at most 171.9°/s and 114.6°/s²"),
        ("moved by 0.42 mm, turned by 1.80 mrad", "moved by 0.42 mm, turned by 0.1031°"),
        ("b 1.000 or 2.000 or 3.000 rad alone", "b 57.30 or 114.59 or 171.89° alone"),
        // Other units keep their text: a spring, a moment, an exponent, and names with digits.
        ("20 N m/rad", "20 N m/rad"),
        ("peak |n_B| 1.03 N m", "peak |n_B| 1.03 N m"),
        ("1.5e-3 rad", "1.5e-3 rad"),
        ("q2 rad", "q2 rad"),
        ("radius 2 radii", "radius 2 radii"),
        ("drawn 2° for 1 N m", "drawn 2° for 1 N m"),
    ];
    for (text, want) in cases {
        assert_eq!(DEGREES.sentence(text), want);
    }
}

#[test]
fn sentences_take_the_chosen_unit_of_lengths() {
    let cases = [
        ("0.550, 0.900 m", "550, 900 mm"),
        ("0.1 m grid", "100 mm grid"),
        ("point 1, 0.25 m away", "point 1, 250 mm away"),
        ("5.20 mm off", "5.20 mm off"),
        ("1.000 m/s at 9.81 m/s²", "1000 mm/s at 9.81 m/s²"),
        ("a₁ = 30°, may be 10° to 90°", "a₁ = 0.524 rad, may be 0.175 rad to 1.571 rad"),
        ("2.0 kg m²", "2.0 kg m²"),
        ("arrow: 0.250 m = 20 N", "arrow: 250 mm = 20 N"),
    ];
    for (text, want) in cases {
        assert_eq!(MILLIMETRES.sentence(text), want);
    }
}

#[test]
fn without_a_choice_sentences_are_borrowed() {
    for text in ["b = 2.400 rad", "0.550, 0.900 m", "", "−", "…", "1", "+.5 rad"] {
        assert!(matches!(Notation::default().sentence(text), std::borrow::Cow::Borrowed(_)), "{text}");
    }
}

#[test]
fn converted_sentences_are_true_for_any_number() {
    let mut state = 7_u64;
    for _ in 0..5_000 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let value = (state >> 11) as f64 / (1_u64 << 53) as f64 * 20.0 - 10.0;
        let decimals = (state % 4) as usize + 1;
        let text = format!("b = {value:.decimals$} rad is wanted");
        let shown = DEGREES.sentence(&text);
        let number = shown.strip_prefix("b = ").and_then(|rest| rest.strip_suffix("° is wanted")).unwrap();
        let degrees: f64 = number.replace('−', "-").parse().unwrap();
        // Half a step of each of the two roundings.
        let step = 0.5 * 10f64.powi(-(decimals as i32)).to_degrees() + 0.5 * 10f64.powi(1 - decimals as i32);
        assert!((degrees - value.to_degrees()).abs() <= step, "{text}: {shown}");
    }
}

#[test]
fn both_names_are_in_the_chosen_order() {
    assert_eq!(DEGREES.name("moment on the base", "n_B"), "moment on the base, n_B");
    assert_eq!(MILLIMETRES.name("moment on the base", "n_B"), "n_B, moment on the base");
    assert_eq!(MILLIMETRES.name("held", ""), "held");
}
