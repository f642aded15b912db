//! Random machines around a nominal one: the fast way against the straightforward one, laws of sampling, exact moments.

use std::collections::BTreeMap;

use proptest::prelude::*;
use stillbase::dynamics::{Surroundings, base_wrench};
use stillbase::machine::{Inertia, Machine, builtin, parse};
use stillbase::plan::Motion;
use stillbase::planar::Vector;
use stillbase::scenario::Scenario;
use stillbase::session::Run;
use stillbase::tolerance::{
    Agreement, Bands, CHUNK, Ensemble, Histogram, Outcome, Quantiles, Shares, Spread, Tolerance, ToleranceError, Yield,
    default_spreads, inverse_normal, simulate,
};

fn spreads(pairs: &[(&str, &str)]) -> BTreeMap<String, Spread> {
    pairs.iter().map(|(key, text)| ((*key).into(), text.parse().expect("a spread"))).collect()
}

fn nine_link() -> Machine {
    builtin("nine-link").expect("built in").clone()
}

fn motion(case: &str) -> Motion {
    Run::new(&Scenario::builtin(case).expect("built in")).expect("it starts").plan().motion.clone()
}

/// The deviations of one machine of the chunk that was drawn last.
fn of_machine(sampler: &stillbase::tolerance::Sampler, machine: usize) -> Vec<f64> {
    sampler.deviations().iter().map(|p| p[machine]).collect()
}

/// Machine, constants, dynamics at every instant.
fn straightforward(ensemble: &Ensemble, deviations: &[f64]) -> Outcome {
    let machine = ensemble.machine_of(deviations).expect("possible");
    let (inertia, gravity) = (Inertia::of(&machine), machine.gravity());
    let around = Surroundings { gravity, force: Vector::default() };
    let wrenches: Vec<(f64, f64)> = (ensemble.references().iter())
        .map(|r| base_wrench(&inertia, &r.q.units(), &r.qd, &r.qdd, &around))
        .map(|w| (w.total().moment.abs(), w.dynamic.force.norm()))
        .collect();
    let peak = |f: fn(&(f64, f64)) -> f64| wrenches.iter().map(f).fold(0.0, f64::max);
    let rms =
        |f: fn(&(f64, f64)) -> f64| (wrenches.iter().map(|w| f(w).powi(2)).sum::<f64>() / wrenches.len() as f64).sqrt();
    Outcome { peak_moment: peak(|w| w.0), peak_force: peak(|w| w.1), rms_moment: rms(|w| w.0), rms_force: rms(|w| w.1) }
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
        let ensemble = Ensemble::new(&nine_link(), &motion, 200, &default_spreads(), 1).expect("it varies");
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
    let settings = [("payload.mass", "0.8"), ("payload.inertia", "0.01"), ("gravity", "1.2,-9.81")];
    let machine = nine_link().set_all(settings).expect("valid");
    let ensemble = Ensemble::new(&machine, &motion("case-1"), 200, &wild, 2).expect("it varies");
    assert_eq!(ensemble.parameters().len(), 9 * 4 + 5 + 2);
    compare(&ensemble, CHUNK);
}

/// A serial arm of n links with CMs off their axes, lengths of its own and a payload.
fn serial_arm(n: usize, numbers: &[f64]) -> Machine {
    let mut text = String::from("name = \"arm\"\ngravity = [0.3, -2.0]\n[lengths]\n");
    let number = |i: usize| numbers[i % numbers.len()];
    for j in 0..n {
        text += &format!("l{j} = {}\n", 0.2 + 0.3 * number(j));
    }
    text += "[payload]\nmass = 0.4\ninertia = 0.02\n";
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
        let end = |from: usize| stillbase::planar::PerDrive::from_fn(n, |k| 6.0 * numbers[(from + k) % 11]);
        let path = stillbase::plan::Path::JointLine {
            from: stillbase::planar::DriveAngles(end(0)),
            to: stillbase::planar::DriveAngles(end(3)),
        };
        let motion = Motion::new(path, stillbase::plan::TimeLaw::Quintic, 1.3);
        let wide = [("link.*.com", "normal:0.01"), ("link.*.com_normal", "uniform:0.01"), ("link.*.mass", "uniform:3%"),
            ("link.*.inertia", "uniform:30%"), ("length.*", "normal:0.002"), ("payload.mass", "normal:10%")];
        let ensemble = Ensemble::new(&machine, &motion, 50, &spreads(&wide), seed).expect("it varies");
        compare(&ensemble, 16);
    }
}
