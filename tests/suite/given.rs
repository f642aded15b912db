//! A motion given by samples: the spline and its orders, smoothing, the nearest reactionless motion, and a round trip.

use proptest::prelude::*;
use stillbase::plan::given::SamplesError;
use stillbase::plan::low_pass::LowPass;
use stillbase::plan::spline::{Knots, NOISE_GAIN};
use stillbase::plan::{Motion, Path, Profile, Samples};

/// Uneven times from 0 to 1 that a smooth map makes of even ones.
fn uneven(n: usize) -> Vec<f64> {
    let map = |u: f64| u + 0.08 * (std::f64::consts::TAU * u).sin() / std::f64::consts::TAU * 4.0;
    (0..=n).map(|i| map(i as f64 / n as f64)).collect()
}

/// A reproducible tremble of variance 1.
fn noise(n: usize) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| (0..12).map(|_| next()).sum::<f64>() - 6.0).collect()
}

fn rows(t: &[f64], of: impl Fn(f64) -> Vec<f64>) -> Vec<Vec<f64>> {
    t.iter().map(|t| [&[*t][..], &of(*t)].concat()).collect()
}

fn samples(t: &[f64], of: impl Fn(f64) -> Vec<f64>) -> Samples {
    Samples::new(&rows(t, of)).expect("sound")
}

fn motion(samples: &Samples) -> Motion {
    let path = samples.path(0.0).expect("a path");
    Motion { path: Path::Table(path), profile: Profile::running(samples.duration()) }
}

proptest! {
    /// A quintic of time is met at every instant, however uneven the samples.
    #[test]
    fn quintics_are_exact(
        c in prop::array::uniform6(-1.0..1.0_f64),
        steps in prop::collection::vec(0.3..1.7_f64, 6..40),
    ) {
        let mut t = vec![0.0];
        steps.iter().for_each(|step| t.push(t[t.len() - 1] + step));
        let whole = t[t.len() - 1];
        t.iter_mut().for_each(|t| *t /= whole);
        let at = |t: f64| c.iter().rev().fold([0.0; 3], |[p, d, h], c| [p * t + c, d * t + p, h * t + d]);
        let given = motion(&samples(&t, |t| vec![at(t)[0]]));
        for i in 0..=200 {
            let t = f64::from(i) / 200.0;
            let (r, [q, qd, half]) = (given.at(t), at(t));
            prop_assert!((r.q[0] - q).abs() < 1e-12, "q {} {q}", r.q[0]);
            prop_assert!((r.qd[0] - qd).abs() < 1e-9, "q̇ {} {qd}", r.qd[0]);
            prop_assert!((r.qdd[0] - 2.0 * half).abs() < 1e-6, "q̈ {} {}", r.qdd[0], 2.0 * half);
        }
    }

    /// Angles whose samples lie on a plane lie on it between them, at rest or not.
    #[test]
    fn a_plane_is_kept(l2 in 0.05..1.5_f64, l3 in 0.05..1.5_f64, w in 1.0..6.0_f64) {
        let of = |t: f64| {
            let (q2, q3) = ((w * t).sin(), (2.0 * t).cos());
            vec![2.0 - l2 * q2 - l3 * q3, q2, q3]
        };
        let given = motion(&samples(&uneven(60), of));
        for i in 0..=500 {
            let r = given.at(f64::from(i) / 500.0);
            prop_assert!((r.q.0.dot(&[1.0, l2, l3]) - 2.0).abs() < 1e-13);
            prop_assert!(r.qd.dot(&[1.0, l2, l3]).abs() < 1e-11);
            prop_assert!(r.qdd.dot(&[1.0, l2, l3]).abs() < 1e-8);
        }
    }

    /// Parabolas pass the smoothing unchanged, at uneven times too.
    #[test]
    fn parabolas_pass(c in prop::array::uniform3(-2.0..2.0_f64), cut_off in 0.5..20.0_f64) {
        let t = uneven(80);
        let y: Vec<f64> = t.iter().map(|t| c[0] + t * (c[1] + t * c[2])).collect();
        let smooth = LowPass::new(&t, cut_off).expect("below half of the rate").smooth(&y);
        for (y, f) in y.iter().zip(&smooth) {
            prop_assert!((y - f).abs() < 1e-9, "{y} {f}");
        }
    }
}

#[test]
fn errors_fall_with_the_sixth_fifth_and_fourth_power() {
    let exact = |t: f64| [(7.0 * t + 0.3).sin(), 7.0 * (7.0 * t + 0.3).cos(), -49.0 * (7.0 * t + 0.3).sin()];
    let worst = |n: usize| {
        let given = motion(&samples(&uneven(n), |t| vec![exact(t)[0]]));
        let mut worst = [0.0_f64; 3];
        for i in 0..=3000 {
            let t = f64::from(i) / 3000.0;
            let (r, want) = (given.at(t), exact(t));
            let got = [r.q[0], r.qd[0], r.qdd[0]];
            (0..3).for_each(|k| worst[k] = worst[k].max((got[k] - want[k]).abs()));
        }
        worst
    };
    let errors: Vec<[f64; 3]> = [20, 40, 80].map(worst).to_vec();
    for pair in errors.windows(2) {
        for (k, order) in [6.0, 5.0, 4.0].into_iter().enumerate() {
            let rate = (pair[0][k] / pair[1][k]).log2();
            assert!((rate - order).abs() < 0.7, "derivative {k}: order {rate:.2} of {errors:?}");
        }
    }
}

#[test]
fn noise_comes_out_as_stated() {
    let (n, h, sigma) = (4001, 0.001, 1e-6);
    let t: Vec<f64> = (0..n).map(|i| i as f64 * h).collect();
    let tremble = noise(n);
    let rates = Knots::new(&t).expect("rising").rates(|i| sigma * tremble[i]);
    let inside = &rates[20..n - 20];
    let rms = (inside.iter().map(|r| r[1] * r[1]).sum::<f64>() / inside.len() as f64).sqrt();
    let want = NOISE_GAIN * sigma / (h * h);
    assert!((rms / want - 1.0).abs() < 0.1, "{rms} for {want}");
    let given = samples(&t, |t| vec![t.sin() + sigma * tremble[(t / h).round() as usize]]);
    assert!((given.uncertainty(0) / want - 1.0).abs() < 0.2, "{} for {want}", given.uncertainty(0));
    // What is smooth is not called noise: here rounding is all there is.
    let smooth = samples(&t, |t| vec![t.sin()]);
    assert!(smooth.uncertainty(0) < 1e-3 * want, "{}", smooth.uncertainty(0));
}

#[test]
fn half_of_the_amplitude_is_left_at_the_cut_off_and_no_phase() {
    let (n, h) = (4001, 0.001);
    let t: Vec<f64> = (0..n).map(|i| f64::from(i) * h).collect();
    for cut_off in [5.0, 60.0, 400.0] {
        let pass = LowPass::new(&t, cut_off).expect("below half of the rate");
        for ratio in [0.25, 0.5, 1.0, 1.2] {
            let f = ratio * cut_off;
            let s = |f: f64| (std::f64::consts::PI * f * h).sin();
            let want = 1.0 / (1.0 + (s(f) / s(cut_off)).powi(6));
            let wave = |t: f64| (std::f64::consts::TAU * f * t).sin();
            let smooth = pass.smooth(&t.iter().map(|t| wave(*t)).collect::<Vec<_>>());
            for i in 1500..2500 {
                let got = smooth[i] - want * wave(t[i]);
                assert!(got.abs() < 2e-5, "{f} Hz of {cut_off}: {got:e} at {i}");
            }
        }
    }
    assert!(
        LowPass::new(&t, 500.0).is_none() && LowPass::new(&t, 0.0).is_none() && LowPass::new(&t, f64::NAN).is_none()
    );
}

#[test]
fn rows_that_are_no_samples_are_refused() {
    let t: Vec<f64> = (0..10).map(f64::from).collect();
    let good = rows(&t, |t| vec![t, t]);
    let with = |change: &dyn Fn(&mut Vec<Vec<f64>>)| {
        let mut rows = good.clone();
        change(&mut rows);
        Samples::new(&rows).expect_err("refused")
    };
    assert_eq!(with(&|r| r.truncate(5)), SamplesError::TooFew { got: 5 });
    assert_eq!(with(&|r| r[3][2] = f64::NAN), SamplesError::NotFinite { row: 3, column: 2 });
    assert_eq!(with(&|r| r[4][0] = 3.0), SamplesError::NotRising { row: 4, time: 3.0, before: 3.0 });
    assert_eq!(with(&|r| r[7].push(1.0)), SamplesError::Ragged { row: 7, got: 4, want: 3 });
    assert_eq!(with(&|r| r.iter_mut().for_each(|r| r.truncate(1))), SamplesError::Ragged { row: 0, got: 1, want: 2 });
    let many: Vec<Vec<f64>> = (0..20_001).map(|i| vec![f64::from(i), 0.0]).collect();
    assert_eq!(Samples::new(&many), Err(SamplesError::TooMany { got: 20_001 }));
    assert!(matches!(samples(&t, |t| vec![t]).smoothed(0.5), Err(SamplesError::CutOff { nyquist: 0.5, .. })));
}
