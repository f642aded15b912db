//! Spectra: Parseval, known tones, white noise, limits.

use std::f64::consts::TAU;

use proptest::prelude::*;
use stillbase::session::base_loads;
use stillbase::session::scenario::Scenario;
use stillbase::study::base_spectrum::{BaseSpectrum, NoBaseSpectrum};
use stillbase::study::spectrum::{JitterLimit, MIN_SPECTRUM_SAMPLES, Spectrum, SpectrumError, WindowFunction};

/// The one-sided density by its definition, a sum for each line.
fn by_definition(x: &[f64], step: f64, weight: impl Fn(usize) -> f64) -> Vec<f64> {
    let n = x.len();
    let power: f64 = (0..n).map(|i| weight(i).powi(2)).sum();
    (0..=n / 2)
        .map(|m| {
            let (mut re, mut im) = (0.0, 0.0);
            for (i, x) in x.iter().enumerate() {
                let (s, c) = (TAU * ((m * i) % n) as f64 / n as f64).sin_cos();
                (re, im) = (re + weight(i) * x * c, im - weight(i) * x * s);
            }
            let sides = if m == 0 || 2 * m == n { 1.0 } else { 2.0 };
            (sides * step * (re * re + im * im) / power).sqrt()
        })
        .collect()
}

fn hann(n: usize) -> impl Fn(usize) -> f64 {
    move |i| (std::f64::consts::PI * i as f64 / n as f64).sin().powi(2)
}

proptest! {
    #[test]
    fn the_power_of_all_lines_is_that_of_the_samples(
        x in prop::collection::vec(-10.0..10.0_f64, MIN_SPECTRUM_SAMPLES..300),
        step in 1e-4..1.0_f64,
    ) {
        let n = x.len();
        let plain = Spectrum::of(&x, step, WindowFunction::Rectangular).expect("enough");
        let square = x.iter().map(|x| x * x).sum::<f64>() / n as f64;
        prop_assert!((plain.rms() - square.sqrt()).abs() <= 1e-12 * square.sqrt());
        let windowed = Spectrum::of(&x, step, WindowFunction::Hann).expect("enough");
        let w = hann(n);
        let sums = (0..n).fold([0.0; 2], |s, i| [s[0] + (w(i) * x[i]).powi(2), s[1] + w(i).powi(2)]);
        let rms = (sums[0] / sums[1]).sqrt();
        prop_assert!((windowed.rms() - rms).abs() <= 1e-12 * rms);
        for (spectrum, twin) in [(plain, by_definition(&x, step, |_| 1.0)), (windowed, by_definition(&x, step, w))] {
            prop_assert_eq!(spectrum.density.len(), n / 2 + 1);
            let most = twin.iter().fold(0.0_f64, |m, d| m.max(*d));
            for (got, want) in spectrum.density.iter().zip(&twin) {
                prop_assert!((got - want).abs() <= 1e-11 * most);
            }
            prop_assert!(spectrum.cumulative_rms.is_sorted());
            let last = spectrum.frequency[n / 2];
            prop_assert!((last - (n / 2) as f64 / (n as f64 * step)).abs() <= 1e-12 * last);
        }
    }
}

#[test]
fn a_tone_stands_at_its_frequency_with_its_power() {
    let (n, step, amplitude, line) = (1000, 0.001, 3.0, 40);
    let x: Vec<f64> = (0..n).map(|i| amplitude * (TAU * (line * i) as f64 / n as f64 + 0.3).cos()).collect();
    let rms = amplitude / 2_f64.sqrt();
    let plain = Spectrum::of(&x, step, WindowFunction::Rectangular).expect("enough");
    // One line of 1 Hz.
    assert!((plain.frequency[line] - 40.0).abs() < 1e-9 && (plain.density[line] - rms).abs() < 1e-12);
    assert!(plain.cumulative_rms[line - 1] < 1e-12 && (plain.cumulative_rms[line] - rms).abs() < 1e-12);
    // A Hann window spreads it over three, 1/6, 4/6, 1/6 of its power: its noise bandwidth is one and a half lines.
    let hann = Spectrum::of(&x, step, WindowFunction::Hann).expect("enough");
    let density = |m: usize| hann.density[m].powi(2) / rms.powi(2);
    assert!((density(line) - 4.0 / 6.0).abs() < 1e-12);
    assert!((density(line - 1) - 1.0 / 6.0).abs() < 1e-12 && (density(line + 1) - 1.0 / 6.0).abs() < 1e-12);
    assert!(hann.density[line + 2] < 1e-12 && (hann.rms() - rms).abs() < 1e-12);
}

#[test]
fn limits_are_straight_in_logarithms() {
    let limit: JitterLimit = "1:0.1, 10:0.01,1000:1".parse().expect("a limit");
    assert_eq!(limit.at(0.5), None);
    assert_eq!(limit.at(1000.1), None);
    for (f, want) in [(1.0, 0.1), (10.0, 0.01), (1000.0, 1.0), (10_f64.sqrt(), 10_f64.powf(-1.5)), (100.0, 0.1)] {
        assert!((limit.at(f).expect("within") / want - 1.0).abs() < 1e-12, "{f}");
    }
    let flat: JitterLimit = "0.2".parse().expect("a limit");
    assert_eq!((flat.at(1e-9), flat.at(1e9)), (Some(0.2), Some(0.2)));
    for text in ["", "x", "-1", "0", "nan", "inf", "1:2", "2:1,1:1", "1:1,1:2", "0:1,1:1", "1:0,2:1", "1:1,2"] {
        assert!(text.parse::<JitterLimit>().is_err(), "{text}");
    }
}

#[test]
fn a_verdict_names_the_worst_frequency() {
    let x: Vec<f64> = (0..400)
        .map(|i| f64::from(i) * 0.01)
        .map(|t| 5.0 + 0.2 * (TAU * 3.0 * t).sin() + 0.1 * (TAU * 20.0 * t).sin())
        .collect();
    let spectrum = Spectrum::of(&x, 0.01, WindowFunction::Rectangular).expect("enough");
    let against = |text: &str| spectrum.against(&text.parse().expect("a limit"));
    // The mean, at 0 Hz, is not held against it. Lines are 0.25 Hz apart, so the density of a tone is its RMS by 0.5.
    let flat = against("1").expect("lines");
    assert!((flat.frequency - 3.0).abs() < 1e-9 && (flat.ratio - 0.2 / 2_f64.sqrt() / 0.5).abs() < 1e-9 && flat.within);
    let falling = against("1:1,30:0.01").expect("lines");
    assert!((falling.frequency - 20.0).abs() < 1e-9 && !falling.within && falling.ratio > 1.0);
    assert!(against("60:1,70:1").is_none());
}

#[test]
fn what_has_no_spectrum_is_refused() {
    let few = Spectrum::of(&[1.0; MIN_SPECTRUM_SAMPLES - 1], 0.1, WindowFunction::Hann);
    assert_eq!(few, Err(SpectrumError::TooFew { count: MIN_SPECTRUM_SAMPLES - 1, least: MIN_SPECTRUM_SAMPLES }));
    let mut x = [1.0; 20];
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Spectrum::of(&x, step, WindowFunction::Hann), Err(SpectrumError::Step { .. })));
    }
    x[3] = f64::NAN;
    assert_eq!(Spectrum::of(&x, 0.1, WindowFunction::Hann), Err(SpectrumError::NotFinite { index: 3 }));
}

/// What is said of a run's base is the spectrum of what it felt, axis by axis.
#[test]
fn the_spectra_of_a_base_are_those_of_what_it_felt() {
    let scenario = Scenario::builtin("case-1").expect("built in");
    let mut found = BaseSpectrum::of(&scenario, WindowFunction::Rectangular, || true).expect("long enough");
    let ([x, y, n], fault) = base_loads(&scenario, || true).expect("it runs");
    assert_eq!((found.samples, found.fault.clone(), fault), (n.len(), None, None));
    for ((.., spectrum), samples) in found.spectra.named().into_iter().zip([&x, &y, &n]) {
        assert_eq!(*spectrum, Spectrum::of(samples, scenario.step, WindowFunction::Rectangular).expect("long enough"));
        let [at, most] = spectrum.greatest();
        assert!(spectrum.density.iter().all(|density| *density <= most) && spectrum.frequency.contains(&at));
        assert!(spectrum.below(0.5) <= spectrum.below(0.99));
    }
    let moment = &found.axes.moment;
    assert!((moment.rms / moment.weighted_rms - 1.0).abs() < 1e-9, "no window, one root mean square");
    let limit: JitterLimit = "0.01".parse().expect("a limit");
    found.judge(None, Some(&limit)).expect("at every frequency");
    assert_eq!(found.axes.moment.limit, found.spectra.moment.against(&limit));
    assert!(found.axes.force_x.limit.is_none());
    let beyond: JitterLimit = "1e6:1,2e6:1".parse().expect("a limit");
    assert!(matches!(found.judge(Some(&beyond), None), Err(NoBaseSpectrum::Beyond { .. })));
}
