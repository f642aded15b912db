//! Random machines around a nominal one: the fast way against the straightforward one, laws of sampling, exact moments.

use std::collections::BTreeMap;

use proptest::prelude::*;
use stillbase::mechanics::dynamics::{ExternalLoads, base_wrench};
use stillbase::mechanics::machine::{Inertia, Machine, builtin, parse};
use stillbase::mechanics::planar::Vector;
use stillbase::planning::Motion;
use stillbase::session::Run;
use stillbase::session::scenario::{Scenario, Spread, Tolerance, default_spreads};
use stillbase::study::tolerance::{
    Agreement, Bands, Batch, CHUNK, Distributions, Ensemble, Histogram, Mode, Quantiles, SampleOutcome, Shares,
    ToleranceError, TrackingComparison, Yield, Yields, inverse_normal, simulate,
};

fn spreads(pairs: &[(&str, &str)]) -> BTreeMap<String, Spread> {
    pairs.iter().map(|(key, text)| ((*key).into(), text.parse().expect("a spread"))).collect()
}

fn nine_link() -> Machine {
    builtin("nine-link").expect("built in").clone()
}

fn motion(case: &str) -> Motion {
    let run = Run::new(&Scenario::builtin(case).expect("built in")).expect("it starts");
    Motion::clone(&run.plan().motion)
}

/// The deviations of one machine of the chunk that was drawn last.
fn of_machine(sampler: &stillbase::study::tolerance::Sampler, machine: usize) -> Vec<f64> {
    sampler.deviations().iter().map(|p| p[machine]).collect()
}

/// Machine, constants, dynamics at every instant.
fn straightforward(ensemble: &Ensemble, deviations: &[f64]) -> SampleOutcome {
    let machine = ensemble.machine_of(deviations).expect("possible");
    let (inertia, gravity) = (Inertia::of(&machine), machine.gravity());
    let around = ExternalLoads { gravity, force: Vector::default() };
    let wrenches: Vec<(f64, f64)> = (ensemble.references().iter())
        .map(|r| base_wrench(&inertia, &r.q.units(), &r.qd, &r.qdd, &around))
        .map(|w| (w.total().moment.abs(), w.dynamic.force.norm()))
        .collect();
    let peak = |f: fn(&(f64, f64)) -> f64| wrenches.iter().map(f).fold(0.0, f64::max);
    let between = &wrenches[1..wrenches.len() - 1];
    let rms =
        |f: fn(&(f64, f64)) -> f64| (between.iter().map(|w| f(w).powi(2)).sum::<f64>() / between.len() as f64).sqrt();
    SampleOutcome {
        peak_moment: peak(|w| w.0),
        peak_force: peak(|w| w.1),
        rms_moment: rms(|w| w.0),
        rms_force: rms(|w| w.1),
    }
}

/// The fast way equals the straightforward one to 1e-12 of each result.
fn compare(ensemble: &Ensemble, machines: usize) {
    let mut sampler = ensemble.sampler();
    let outcomes = *sampler.outcomes(3);
    for (machine, got) in outcomes.iter().enumerate().take(machines) {
        let want = straightforward(ensemble, &of_machine(&sampler, machine));
        for (got, want) in [
            (got.peak_moment, want.peak_moment),
            (got.rms_moment, want.rms_moment),
            (got.peak_force, want.peak_force),
            (got.rms_force, want.rms_force),
        ] {
            assert!((got - want).abs() <= 1e-12 * want, "machine {machine}: {got:e}, {want:e}");
        }
    }
}

#[test]
fn fast_and_straightforward_agree_on_the_nine_link_machine() {
    for case in ["case-1", "case-3"] {
        let motion = motion(case);
        let ensemble = Ensemble::new(&nine_link(), &motion, 200, &default_spreads(&nine_link()), 1).expect("it varies");
        compare(&ensemble, CHUNK);
    }
    // Every number, far from small, with weight and a payload; uniform and normal.
    let wild = spreads(&[
        ("link.*.com", "uniform:0.1"),
        ("link.*.com_normal", "normal:0.03"),
        ("link.*.mass", "uniform:60%"),
        ("link.*.inertia", "normal:30%"),
        ("length.*", "normal:10%"),
        ("length.l1", "uniform:0.2"),
        ("payload.mass", "uniform:100%"),
        ("payload.inertia", "normal:20%"),
    ]);
    let settings = [
        ("payload.mass", "0.8"),
        ("payload.inertia", "0.01"),
        ("payload.offset", "0.06,-0.04"),
        ("gravity", "1.2,-9.81"),
    ];
    let machine = nine_link().set_all(settings).expect("valid");
    let ensemble = Ensemble::new(&machine, &motion("case-1"), 200, &wild, 2).expect("it varies");
    assert_eq!(ensemble.parameters().len(), 9 * 4 + 5 + 2);
    compare(&ensemble, CHUNK);
}

/// Peaks are those of the whole motion, ends included: under gravity a base may feel most before it starts or after it
/// has ended.
#[test]
fn peaks_are_those_of_the_whole_motion() {
    let some = spreads(&[("link.*.com", "normal:0.002"), ("link.*.mass", "uniform:2%")]);
    let mut at_an_end = 0;
    for (case, gravity) in [("case-1", "0,-9.81"), ("case-3", "0,-9.81"), ("case-3", "9.81,0"), ("case-1", "-4,2")] {
        let (machine, motion) = (nine_link().set("gravity", gravity).expect("in range"), motion(case));
        let ensemble = Ensemble::new(&machine, &motion, 200, &some, 3).expect("it varies");
        let mut sampler = ensemble.sampler();
        let outcomes = *sampler.outcomes(0);
        for (i, outcome) in outcomes.iter().enumerate().take(6) {
            let inertia = Inertia::of(&ensemble.machine_of(&of_machine(&sampler, i)).expect("possible"));
            let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
            let moment = |t: f64| {
                let r = motion.at(t);
                base_wrench(&inertia, &r.q.units(), &r.qd, &r.qdd, &around).total().moment.abs()
            };
            let dense = (0..=20_000).map(|s| moment(motion.duration() * f64::from(s) / 2e4)).fold(0.0, f64::max);
            assert!((outcome.peak_moment / dense - 1.0).abs() < 2e-4, "{case}: {} of {dense}", outcome.peak_moment);
            at_an_end += usize::from(moment(0.0).max(moment(motion.duration())) == dense);
        }
    }
    assert!(at_an_end > 3, "{at_an_end}");
}

/// A serial arm of n links with CMs off their axes, lengths of its own and a payload.
fn serial_arm(n: usize, numbers: &[f64]) -> Machine {
    let mut text = String::from("name = \"arm\"\ngravity = [0.3, -2.0]\n[lengths]\n");
    let number = |i: usize| numbers[i % numbers.len()];
    for j in 0..n {
        text += &format!("l{j} = {}\n", 0.2 + 0.3 * number(j));
    }
    text += "[payload]\nmass = 0.4\ninertia = 0.02\noffset = [0.05, 0.03]\n";
    for j in 0..n {
        let attach = if j == 0 { "\"base\"".into() } else { format!("{{ link = \"{}\", at = \"tip\" }}", j - 1) };
        text += &format!(
            "[[drive]]\nname = \"{j}\"\n[[link]]\nname = \"{j}\"\ndrive = \"{j}\"\nattach = {attach}\nlength = \"l{j}\"\n\
             direction = {}\nmass = {}\ninertia = {}\ncom = {}\ncom_normal = {}\n",
            if number(j + 1) > 0.5 { 1 } else { -1 },
            0.5 + number(j + 2),
            0.01 + 0.1 * number(j + 3),
            number(j + 4) - 0.5,
            0.2 * number(j + 5) - 0.1,
        );
    }
    text += &format!("[end_effector]\nlink = \"{}\"\n", n - 1);
    parse(&text, "arm").expect("a machine")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn fast_and_straightforward_agree_on_any_arm(
        n in 1_usize..=8,
        numbers in prop::collection::vec(0.0..1.0_f64, 11),
        seed in any::<u64>(),
    ) {
        let machine = serial_arm(n, &numbers);
        let end = |from: usize| stillbase::mechanics::planar::PerDrive::from_fn(n, |k| 6.0 * numbers[(from + k) % 11]);
        let path = stillbase::planning::curves::Path::JointLine {
            from: stillbase::mechanics::planar::DriveAngles(end(0)),
            to: stillbase::mechanics::planar::DriveAngles(end(3)),
        };
        let motion = Motion::new(path, stillbase::planning::timing::TimeLaw::Quintic, 1.3);
        let wide = [("link.*.com", "normal:0.01"), ("link.*.com_normal", "uniform:0.01"), ("link.*.mass", "uniform:3%"),
            ("link.*.inertia", "uniform:30%"), ("length.*", "normal:0.002"), ("payload.mass", "normal:10%")];
        let ensemble = Ensemble::new(&machine, &motion, 50, &spreads(&wide), seed).expect("it varies");
        compare(&ensemble, 16);
    }
}

/// How far a share of n samples may be from its probability: five standard errors.
fn five_errors(p: f64, n: f64) -> f64 {
    5.0 * (p * (1.0 - p) / n).sqrt()
}

#[test]
fn deviates_invert_the_normal_distribution() {
    // Twin: the distribution by the convergent series of its complement, Φ(z) = ½ + φ(z) (z + z³/3 + z⁵/15 + …).
    let distribution = |z: f64| {
        let (mut term, mut sum) = (z, z);
        for k in 1..400 {
            term *= z * z / f64::from(2 * k + 1);
            sum += term;
        }
        0.5 + sum * (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt()
    };
    for i in 1..2000 {
        let p = f64::from(i) / 2000.0;
        let mut z = [p];
        inverse_normal(&mut z);
        assert!((distribution(z[0]) - p).abs() < 1e-15 * (4.0 + z[0].abs()), "{p}: {}", z[0]);
    }
    // Far out, from tables: Φ(−5), Φ(−8).
    for (p, want) in [(2.866515718791939e-7, -5.0), (6.220960574271785e-16, -8.0)] {
        let mut z = [p, 1.0 - p];
        inverse_normal(&mut z);
        assert!((z[0] - want).abs() < 1e-14, "{}", z[0]);
    }
    let mut both = [0.3, 0.7, 0.01, 0.99];
    inverse_normal(&mut both);
    assert!((both[0] + both[1]).abs() < 1e-15 && (both[2] + both[3]).abs() < 1e-14);
}

#[test]
fn what_is_drawn_follows_its_spread() {
    let keys = [
        ("link.1.com", "normal:0.002"),
        ("link.2.mass", "uniform:5%"),
        ("link.3.inertia", "normal:70%"),
        ("link.4.inertia", "uniform:110%"),
    ];
    let motion = motion("case-3");
    let ensemble = Ensemble::new(&nine_link(), &motion, 2, &spreads(&keys), 5).expect("it varies");
    let mut sampler = ensemble.sampler();
    let mut drawn = vec![Vec::new(); 4];
    for chunk in 0..400 {
        sampler.draw(chunk);
        for (all, p) in drawn.iter_mut().zip(sampler.deviations()) {
            all.extend_from_slice(p);
        }
    }
    let n = drawn[0].len() as f64;
    for (parameter, all) in ensemble.parameters().iter().zip(&drawn) {
        let mean = all.iter().sum::<f64>() / n;
        let variance = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        let error = parameter.deviation / n.sqrt();
        assert!((mean - parameter.mean_deviation()).abs() < 5.0 * error, "{}: mean {mean}", parameter.key);
        assert!((variance.sqrt() / parameter.deviation - 1.0).abs() < 5.0 / n.sqrt(), "{}", parameter.key);
    }
    let share = |p: usize, below: f64| drawn[p].iter().filter(|x| **x < below).count() as f64 / n;
    for (z, p) in [(-2.0, 0.02275013), (-1.0, 0.15865525), (0.0, 0.5), (1.5, 0.9331928)] {
        assert!((share(0, 0.002 * z) - p).abs() < five_errors(p, n));
    }
    let half = 0.05 * 1.45;
    assert!(drawn[1].iter().all(|x| x.abs() < half));
    assert!((share(1, 0.5 * half) - 0.75).abs() < five_errors(0.75, n));
    // Nothing impossible, and the rest as if it had been drawn again: cut at z = −1/0.7, the median moves up.
    let nominal = ensemble.parameters()[2].nominal;
    assert!(drawn[2].iter().all(|x| nominal + x >= 0.0));
    let cut = ensemble.parameters()[2].cut;
    assert!((cut - 0.0765637255).abs() < 1e-9, "{cut}");
    let p = (0.5 - cut) / (1.0 - cut);
    assert!((share(2, 0.0) - p).abs() < five_errors(p, n));
    assert!((ensemble.parameters()[3].cut - 0.1 / 2.2).abs() < 1e-12);
    assert!(drawn[3].iter().all(|x| ensemble.parameters()[3].nominal + x >= 0.0));
    // Independent: no two parameters of a seed, nor one of two seeds, go together.
    let other = Ensemble::new(&nine_link(), &motion, 2, &spreads(&keys), 6).expect("it varies");
    let mut sampler = other.sampler();
    sampler.draw(0);
    let correlation = |a: &[f64], b: &[f64]| {
        let (count, mean) = (a.len() as f64, |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64);
        let (ma, mb) = (mean(a), mean(b));
        let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(x, y)| f(x - ma, y - mb)).sum::<f64>();
        sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt() * count.sqrt()
    };
    assert!(correlation(&drawn[0], &drawn[1]).abs() < 5.0);
    assert!(correlation(&drawn[0][..CHUNK], &sampler.deviations()[0]).abs() < 5.0);
    assert!(correlation(&drawn[0][1..], &drawn[0][..drawn[0].len() - 1]).abs() < 5.0);
}

#[test]
fn a_sample_hangs_on_its_seed_and_number_only() {
    let motion = motion("case-3");
    let some = spreads(&[("link.*.mass", "uniform:1%")]);
    let one = spreads(&[("link.4.mass", "uniform:1%")]);
    let [all, alone] = [some, one].map(|s| Ensemble::new(&nine_link(), &motion, 20, &s, 9).expect("it varies"));
    let (mut a, mut b) = (all.sampler(), alone.sampler());
    // In any order, and whatever else varies.
    let (late, early) = (*a.outcomes(7), *a.outcomes(2));
    assert_eq!((early, late), (*a.outcomes(2), *a.outcomes(7)));
    b.draw(7);
    let link_4 = all.parameters().iter().position(|p| p.key == "link.4.mass").expect("it varies");
    assert_eq!(a.deviations()[link_4], b.deviations()[0]);
    assert_ne!(early[0], late[0]);
}

/// The exact mean and deviation over time are those of many samples, to their standard error; and exactly those of
/// independent numbers where the wrench is linear in them.
#[test]
fn bands_are_those_of_many_samples() {
    let wild = spreads(&[
        ("link.*.com", "uniform:0.03"),
        ("link.*.com_normal", "normal:0.02"),
        ("link.*.mass", "uniform:40%"),
        ("link.*.inertia", "normal:60%"),
        ("length.*", "normal:0.02"),
        ("payload.mass", "normal:60%"),
    ]);
    let machine = nine_link().set_all([("payload.mass", "0.5"), ("gravity", "0,-3")]).expect("valid");
    let ensemble = Ensemble::new(&machine, &motion("case-1"), 12, &wild, 4).expect("it varies");
    let bands = Bands::of(&ensemble, 1);
    let chunks = 200;
    let (mut sums, n) = (vec![[0.0; 3]; ensemble.time().len()], (chunks * CHUNK as u64) as f64);
    let mut sampler = ensemble.sampler();
    for chunk in 0..chunks {
        sampler.courses(chunk, |s, _, moment, force| {
            let d = moment - bands.moment.mean[s];
            sums[s] = [sums[s][0] + d, sums[s][1] + d * d, sums[s][2] + force * force];
        });
    }
    for (s, [mean, squares, force]) in sums.into_iter().enumerate() {
        let (deviation, rms) = (bands.moment.deviation[s], bands.force.rms[s]);
        assert!((mean / n).abs() < 5.0 * deviation / n.sqrt(), "mean at {s}: {} of {deviation}", mean / n);
        assert!(((squares / n).sqrt() / deviation - 1.0).abs() < 0.02, "deviation at {s}");
        // At rest, at both ends, there is none.
        assert!(((force / n).sqrt() - rms).abs() < 0.02 * rms + 1e-12, "force at {s}");
    }
    let agreement = Agreement::of(&Bands::of(&ensemble, 4096));
    // So far from small, the nominal machine is not the mean one, and the report says so.
    assert!(agreement.moment_mean.largest > agreement.tolerance && agreement.moment_mean.share > 0.5);
    assert!(agreement.force_mean.largest > agreement.sampled_tolerance);
    assert!(agreement.sampling.largest < agreement.sampled_tolerance, "{:?}", agreement.sampling);
}

/// As tolerances shrink, first order comes right at its rate: what the exact variance has beyond it goes with the
/// square.
#[test]
fn first_order_is_the_limit_of_small_tolerances() {
    let motion = motion("case-1");
    let beyond = |size: f64| {
        let text = [("link.*.com", 0.2 * size), ("link.*.com_normal", 0.2 * size), ("length.*", 0.1 * size)];
        let mut all: BTreeMap<String, Spread> =
            text.iter().map(|(key, x)| ((*key).into(), format!("uniform:{x}").parse().expect("a spread"))).collect();
        all.insert("link.*.mass".into(), format!("uniform:{}%", 90.0 * size).parse().expect("a spread"));
        let ensemble = Ensemble::new(&nine_link(), &motion, 30, &all, 1).expect("it varies");
        let shares = Shares::of(&ensemble);
        for of in [
            |s: &stillbase::study::tolerance::Share| s.moment_share,
            |s: &stillbase::study::tolerance::Share| s.force_share,
        ] {
            let sum: f64 = shares.parameters.iter().map(of).sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
        [1.0 / shares.moment_first_order - 1.0, 1.0 / shares.force_first_order - 1.0]
    };
    let [large, small] = [beyond(0.3), beyond(0.003)];
    for i in 0..2 {
        let order = (large[i] / small[i]).log10() / 2.0;
        assert!(large[i] > 1e-3 && (order - 2.0).abs() < 0.02, "order {order}, {large:?}, {small:?}");
    }
}

/// The slopes are the derivatives of the straightforward way, by central differences.
#[test]
fn sensitivities_are_derivatives() {
    let machine = nine_link().set_all([("payload.mass", "0.5"), ("gravity", "2,-3")]).expect("valid");
    let all = spreads(&[("link.*.*", "normal:1e-6"), ("length.*", "normal:1e-6"), ("payload.*", "uniform:1e-6")]);
    let motion = motion("case-1");
    // Inertia of the payload is 0: half of any spread would lie below it.
    assert!(matches!(
        Ensemble::new(&machine, &motion, 9, &all, 1),
        Err(ToleranceError::Impossible { key, .. }) if key == "payload.inertia"
    ));
    let machine = machine.set("payload.inertia", "0.3").expect("valid");
    let ensemble = Ensemble::new(&machine, &motion, 9, &all, 1).expect("it varies");
    let shares = Shares::of(&ensemble);
    assert_eq!(shares.parameters.len(), 43);
    let wrenches = |deviations: &[f64]| -> Vec<(f64, Vector)> {
        let machine = ensemble.machine_of(deviations).expect("possible");
        let (inertia, gravity) = (Inertia::of(&machine), machine.gravity());
        let around = ExternalLoads { gravity, force: Vector::default() };
        let wrench = |r: &stillbase::planning::Reference| base_wrench(&inertia, &r.q.units(), &r.qd, &r.qdd, &around);
        ensemble.references().iter().map(wrench).map(|w| (w.total().moment, w.dynamic.force)).collect()
    };
    for (p, share) in shares.parameters.iter().enumerate() {
        let at = |d: f64| {
            let mut deviations = vec![0.0; shares.parameters.len()];
            deviations[p] = d;
            wrenches(&deviations)
        };
        let h = 1e-5;
        let (up, down) = (at(h), at(-h));
        let slopes = up.iter().zip(&down).map(|(a, b)| ((a.0 - b.0).abs() / (2.0 * h), (a.1 - b.1).norm() / (2.0 * h)));
        let [moment, force] = slopes.fold([0.0_f64; 2], |m, (n, f)| [m[0].max(n), m[1].max(f)]);
        assert!((moment - share.moment_slope).abs() < 1e-7 * (1.0 + moment), "{}: {moment}, {share:?}", share.key);
        assert!((force - share.force_slope).abs() < 1e-7 * (1.0 + force), "{}: {force}, {share:?}", share.key);
    }
}

#[test]
fn simulated_machines_come_to_perfect_tracking_as_gains_grow() {
    let base = Scenario::builtin("case-1").expect("built in");
    let some = spreads(&[("link.*.com", "normal:0.002"), ("link.*.mass", "uniform:5%")]);
    let difference = |kp: f64, kd: f64| {
        let all = stillbase::simulation::plant::DriveValues::All;
        let control = stillbase::simulation::control::Control { kp: all(kp), kd: all(kd), ..base.control };
        let scenario = Scenario { control, step: 0.0005, ..base.clone() };
        let run = Run::new(&scenario).expect("it starts");
        let ensemble = Ensemble::new(&scenario.machine, &run.plan().motion, 2000, &some, 3).expect("it varies");
        let mut sampler = ensemble.sampler();
        let outcomes = *sampler.outcomes(0);
        (0..4)
            .map(|machine| {
                let plant = ensemble.machine_of(&of_machine(&sampler, machine)).expect("possible");
                let simulated = simulate(&run, &plant, &|| true).expect("it ends");
                (simulated.rms_moment - outcomes[machine].rms_moment).abs() / outcomes[machine].rms_moment
            })
            .fold(0.0, f64::max)
    };
    let (soft, stiff) = (difference(400.0, 40.0), difference(40_000.0, 400.0));
    assert!(soft < 0.1 && stiff < 0.2 * soft, "{soft}, {stiff}");
    // The nominal machine tracks perfectly.
    let run = Run::new(&base).expect("it starts");
    let ensemble = Ensemble::new(&base.machine, &run.plan().motion, 2000, &some, 3).expect("it varies");
    let (simulated, nominal) = (simulate(&run, &base.machine, &|| true).expect("it ends"), ensemble.nominal_outcome());
    assert!((simulated.peak_moment / nominal.peak_moment - 1.0).abs() < 1e-5);
    assert!((simulated.rms_moment / nominal.rms_moment - 1.0).abs() < 2e-3, "{simulated:?}, {nominal:?}");
}

/// Batches are cut from chunks, so that shards put together are the whole.
#[test]
fn batches_are_parts_of_the_whole() {
    let scenario = Scenario::builtin("case-1").expect("built in");
    let run = Run::new(&scenario).expect("it starts");
    let some = spreads(&[("link.*.com", "normal:0.002"), ("link.*.mass", "uniform:5%")]);
    let ensemble = Ensemble::new(&scenario.machine, &run.plan().motion, 50, &some, 3).expect("it varies");
    let mut sampler = ensemble.sampler();
    let all = sampler.outcomes(1).to_vec();
    let first = CHUNK as u64;
    let range = first + 2..first + 5;
    let batch =
        Batch::of(&ensemble, &mut sampler, Mode::Tracking, 1, &range, (true, &|| true)).expect("nothing is simulated");
    assert_eq!((&batch.samples, &batch.outcomes[..]), (&range, &all[2..5]));
    assert!(batch.tracking.is_empty() && batch.deviations.len() == 3);
    assert_eq!(batch.deviations[1], of_machine(&sampler, 3));
    let simulated =
        Batch::of(&ensemble, &mut sampler, Mode::Simulated(&run), 1, &range, (false, &|| true)).expect("they end");
    assert!(simulated.tracking == batch.outcomes && simulated.deviations.is_empty());
    let plant = ensemble.machine_of(&batch.deviations[0]).expect("possible");
    assert_eq!(simulated.outcomes[0], simulate(&run, &plant, &|| true).expect("it ends"));
    let against = TrackingComparison::of(&simulated.outcomes, &simulated.tracking).expect("they were simulated");
    let furthest = simulated.outcomes.iter().zip(&batch.outcomes).map(|(a, b)| (a.peak_moment - b.peak_moment).abs());
    assert_eq!(against.peak_moment_difference, furthest.fold(0.0, f64::max));
    assert!(TrackingComparison::of(&simulated.outcomes, &[]).is_none());
}

#[test]
fn all_machines_come_to_distributions_and_yields() {
    let machine = |x: f64| SampleOutcome { peak_moment: x, peak_force: 10.0 * x, rms_moment: 0.5 * x, rms_force: x };
    let outcomes = [4.0, 1.0, 3.0, 2.0].map(machine);
    let found = Distributions::of(&outcomes).expect("some");
    assert_eq!((found.peak_moment.mean, found.peak_force.mean, found.rms_moment.mean), (2.5, 25.0, 1.25));
    assert!((found.rms_force.deviation - (5.0f64 / 3.0).sqrt()).abs() < 1e-15);
    assert_eq!([found.peak_moment.quantiles.values[0], found.peak_moment.quantiles.values[8]], [1.0, 4.0]);
    assert!(Distributions::of(&[]).is_none());
    let Yields { moment, force, both } = Yields::of(&outcomes, Some(3.0), Some(15.0));
    let good = [moment, force, both].map(|kept| kept.expect("a limit").count.good);
    assert_eq!(good, [3, 1, 1]);
    let none = Yields::of(&outcomes, None, Some(15.0));
    assert!(none.moment.is_none() && none.both.is_none());
}

#[test]
fn statistics_are_those_of_the_books() {
    let sorted = [1.0, 2.0, 4.0, 8.0];
    let q = Quantiles::of_sorted(&sorted, &[0.0, 0.25, 0.5, 0.9, 1.0]).expect("some");
    for (got, want) in q.values.iter().zip([1.0, 1.75, 3.0, 4.0 + 0.7 * 4.0, 8.0]) {
        assert!((got - want).abs() < 1e-14);
    }
    assert!(Quantiles::of_sorted(&[], &[0.5]).is_none() && Histogram::of_sorted(&[], 3).is_none());
    let h = Histogram::of_sorted(&sorted, 7).expect("some");
    assert_eq!((h.edges.len(), h.counts), (8, vec![1, 1, 0, 1, 0, 0, 1]));
    assert_eq!(Histogram::of_sorted(&[3.0; 5], 2).expect("some").counts.iter().sum::<u64>(), 5);
    // Wilson's interval of 81 of 263, and the ends.
    let y = Yield::new(81, 263);
    assert!((y.interval[0] - 0.25529).abs() < 1e-5 && (y.interval[1] - 0.36621).abs() < 1e-5, "{y:?}");
    let (none, all) = (Yield::new(0, 10), Yield::new(10, 10));
    assert!(none.interval[0] == 0.0 && (none.interval[1] - 0.27753).abs() < 1e-5 && all.interval[1] == 1.0);
    assert_eq!(Yield::new(0, 0).interval, [0.0, 1.0]);
}

#[test]
fn a_scenario_keeps_its_tolerances() {
    let text =
        "machine = \"nine-link\"\n[task]\nkind = \"reactionless\"\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\nb = 2.4\n";
    let parse = |section: &str| Scenario::parse(&format!("{text}[tolerance]\n{section}"), "mine.toml", None);
    let scenario = parse(
        "seed = 7\nsamples = 500\nmoment_limit = 0.02\nforce_limit = 1\n\"link.*.com\" = { normal = 0.0005 }\n\
         \"link.*.mass\" = { uniform = \"1%\" }\n\"link.5.mass\" = { uniform = 0 }\n",
    )
    .expect("a scenario");
    let want = Tolerance {
        seed: Some(7),
        samples: Some(500),
        moment_limit: Some(0.02),
        force_limit: Some(1.0),
        spreads: spreads(&[
            ("link.*.com", "normal:0.0005"),
            ("link.*.mass", "uniform:1%"),
            ("link.5.mass", "uniform:0"),
        ]),
    };
    assert_eq!(scenario.tolerance, want);
    assert_eq!(Scenario::parse(&scenario.to_toml(), "again", None).expect("a scenario"), scenario);
    assert!(!Scenario::parse(text, "bare", None).expect("a scenario").to_toml().contains("tolerance"));
    // A name goes before *, and a spread of zero leaves a number out.
    let ensemble = Ensemble::new(&scenario.machine, &motion("case-3"), 5, &want.spreads, 1).expect("it varies");
    assert_eq!(ensemble.parameters().len(), 9 + 8);
    for (section, words) in [
        ("sead = 1", "sead"),
        ("seed = -1", "0 or more"),
        ("samples = 0", "from 1"),
        ("moment_limit = \"x\"", "1e-12 to 1e12 N m"),
        ("\"link.*.com\" = { gaussian = 1 }", "normal = 0.0005"),
        ("\"link.*.com\" = { normal = -1 }", "0 or more"),
        ("\"link.*.com\" = { normal = 1, uniform = 1 }", "link.*.com"),
    ] {
        let error = parse(section).expect_err(section).to_string();
        assert!(error.contains("mine.toml:8") && error.contains(words), "{section}: {error}");
    }
}

#[test]
fn what_cannot_vary_is_refused() {
    let motion = motion("case-3");
    let refused =
        |pairs: &[(&str, &str)]| Ensemble::new(&nine_link(), &motion, 5, &spreads(pairs), 1).expect_err("refused");
    assert!(matches!(refused(&[("link.10.com", "normal:1")]), ToleranceError::UnknownKey { .. }));
    assert!(matches!(refused(&[("gravity", "normal:1")]), ToleranceError::UnknownKey { .. }));
    assert!(matches!(refused(&[("payload.mass", "normal:1%")]), ToleranceError::PercentOfZero { .. }));
    assert!(matches!(refused(&[("link.1.com", "normal:0")]), ToleranceError::NothingVaries));
    assert!(matches!(refused(&[]), ToleranceError::NothingVaries));
    assert!(matches!(refused(&[("link.1.mass", "normal:6")]), ToleranceError::Impossible { .. }));
    assert!(matches!(refused(&[("link.1.com", "normal:1e9")]), ToleranceError::TooWide { .. }));
}

/// What a window shows of tolerances: shares of a whole, quantiles in order, a yield by the limit, the run's
/// frequencies, and what perfect tracking leaves out.
#[test]
fn a_study_is_of_one_piece() {
    use std::sync::Arc;
    use stillbase::session::Run;

    use stillbase::query::answer_now;
    use stillbase::study::tolerance::{StudiedRun, StudyQuery, neglected_effects};
    let mut scenario = stillbase::session::scenario::Scenario::builtin("case-3").expect("built in");
    scenario.tolerance = toml::from_str("samples = 3000\nmoment_limit = 0.01").expect("tolerances");
    let run = StudiedRun(Arc::new(Run::new(&scenario).expect("planned")));
    let study = answer_now::<StudyQuery>(run).expect("something varies");
    assert!((study.shares.iter().map(|s| s.moment_share).sum::<f64>() - 1.0).abs() < 1e-9);
    assert!(study.shares.is_sorted_by(|a, b| a.moment_share >= b.moment_share));
    assert!(study.moment.values.is_sorted() && study.moment_histogram.counts.iter().sum::<u64>() == 3000);
    let good = study.yields.as_ref().expect("a limit").share;
    let [_, half, most, _] = study.moment.values[..] else { panic!("four levels") };
    assert!(half < 0.01 && most > 0.01 && good > 0.5 && good < 0.95, "{half} {most} {good}");
    let [x, _, n] = study.spectra.as_ref().expect("long enough");
    assert!(n.rms() < 1e-9 && x.rms() < 1e-9, "the run itself transmits nothing");
    assert!(study.left_out.is_empty());
    for (name, word) in
        [("spacecraft", "a base that moves"), ("pick-up", "a payload that comes or goes"), ("friction", "friction")]
    {
        let scenario = stillbase::session::scenario::Scenario::builtin(name).expect("built in");
        assert!(neglected_effects(&scenario).contains(&word), "{name}: {:?}", neglected_effects(&scenario));
    }
}
