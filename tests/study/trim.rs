//! Trim balancing: machines with hidden errors are found from what their bases feel, within what is said of it.

use stillbase::mechanics::balance::{Body, BodyQuantity, Condition, Parameter, ParameterBounds, RebalanceRequest};
use stillbase::mechanics::counterweights::{
    CounterweightSite, CounterweightSpec, CounterweightStock, Objective, place_weights,
};
use stillbase::mechanics::dynamics::{ExternalLoads, base_wrench};
use stillbase::mechanics::machine::{Inertia, Machine, builtin, builtins};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::query::{Portion, Query, Shared, answer_now};
use stillbase::study::trim::{
    ComplexPart, Fit, MeasuredMotion, MeasurementSet, NoTrim, Regressor, RegressorSource, TrimError, TrimMethod,
    TrimQuery, TrimRequest, Unknown, adopt_parameters, correct_machine, correction_benefit, doubt, fit,
    identified_machine, next_excitation,
};

use crate::support::random::a_machine;
use crate::support::{Noise, family_machine};

/// Each drive as a sum of three sines.
struct Sines(Vec<[[f64; 3]; 3]>, Vec<f64>);

impl Sines {
    fn of(noise: &mut Noise, drives: usize, moving: &[bool]) -> Self {
        let one = |noise: &mut Noise, moves: bool| {
            let size = if moves { 1.0 } else { 0.0 };
            [0.0, 1.0, 2.0].map(|i| {
                [
                    size * noise.between(0.2, 0.6) / (1.0 + i),
                    noise.between(2.0, 4.0) * (1.0 + i),
                    noise.between(0.0, 6.0),
                ]
            })
        };
        let parts = (0..drives).map(|k| one(noise, moving[k])).collect();
        Self(parts, (0..drives).map(|_| noise.between(-3.0, 3.0)).collect())
    }

    fn at(&self, t: f64) -> [PerDrive; 3] {
        let sum = |f: &dyn Fn(&[f64; 3]) -> f64| PerDrive::from_fn(self.0.len(), |k| self.0[k].iter().map(f).sum());
        let mut q = sum(&|[a, w, p]| a * (w * t + p).sin());
        q.iter_mut().zip(&self.1).for_each(|(q, middle)| *q += middle);
        [q, sum(&|[a, w, p]| a * w * (w * t + p).cos()), sum(&|[a, w, p]| -a * w * w * (w * t + p).sin())]
    }
}

/// How a machine is measured.
#[derive(Clone, Copy)]
struct Measuring {
    motions: usize,
    rows: usize,
    step: f64,
    /// σ of angles, force, moment.
    sigma: [f64; 3],
    /// Correlation of force and moment from row to row.
    slow: f64,
    /// Whether times are uneven.
    uneven: bool,
    /// Whether rates and accelerations are measured, too.
    rates: bool,
}

const EXACT: Measuring =
    Measuring { motions: 3, rows: 150, step: 0.01, sigma: [0.0; 3], slow: 0.0, uneven: false, rates: true };

fn normal(noise: &mut Noise) -> f64 {
    let (u, v) = (noise.between(1e-12, 1.0), noise.between(0.0, std::f64::consts::TAU));
    (-2.0 * u.ln()).sqrt() * v.cos()
}

fn measured(machine: &Machine, noise: &mut Noise, how: Measuring, moving: &[bool]) -> MeasurementSet {
    let (inertia, n) = (Inertia::of(machine), machine.drives());
    let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
    let mut motions = Vec::new();
    for _ in 0..how.motions {
        let sines = Sines::of(noise, n, moving);
        let offset = [(); 3].map(|()| noise.between(-5.0, 5.0));
        let (mut motion, mut t) = (MeasuredMotion::default(), noise.between(-3.0, 9.0));
        let mut error = [0.0; 3].map(|_: f64| normal(noise));
        for _ in 0..how.rows {
            let [q, qd, qdd] = sines.at(t);
            let wrench = base_wrench(&inertia, &DriveAngles(q).units(), &qd, &qdd, &around).total();
            let fresh = (1.0 - how.slow * how.slow).sqrt();
            error.iter_mut().for_each(|e| *e = how.slow * *e + fresh * normal(noise));
            motion.t.push(t);
            motion.q.push(PerDrive::from_fn(n, |k| q[k] + how.sigma[0] * normal(noise)));
            if how.rates {
                motion.qd.push(qd);
                motion.qdd.push(qdd);
            }
            let read = Vector::new(offset[0] + how.sigma[1] * error[0], offset[1] + how.sigma[1] * error[1]);
            motion.force.push(wrench.force + read);
            motion.moment.push(wrench.moment + offset[2] + how.sigma[2] * error[2]);
            t += how.step * if how.uneven { noise.between(0.6, 1.4) } else { 1.0 };
        }
        motions.push(motion);
    }
    MeasurementSet { motions }
}

/// The machine as it was really built: centres of mass and masses are off.
fn built(machine: &Machine, noise: &mut Noise, size: f64) -> Machine {
    let mut spec = machine.spec().clone();
    for link in &mut spec.links {
        link.com += size * noise.between(-1.0, 1.0);
        link.com_normal += 0.5 * size * noise.between(-1.0, 1.0);
        link.mass *= 1.0 + size * noise.between(-1.0, 1.0);
    }
    for weight in &mut spec.counterweights {
        weight.at += size * noise.between(-1.0, 1.0);
        weight.mass *= 1.0 + size * noise.between(-1.0, 1.0);
    }
    Machine::new(spec).expect("a machine")
}

fn truth(fit: &Fit, machine: &Machine) -> Vec<f64> {
    fit.numbers.unknowns.nominal(&Inertia::of(machine))
}

fn fitted(machine: &Machine, recording: &MeasurementSet, angles_only: bool) -> Fit {
    fit(machine, &Regressor::of(machine, recording, angles_only).expect("rows")).expect("a fit")
}

/// The largest error by the scale of the machine.
fn furthest(fit: &Fit, hidden: &Machine) -> f64 {
    let scales = fit.numbers.unknowns.scales(&Inertia::of(hidden));
    let all = truth(fit, hidden).into_iter().zip(fit.numbers.measured.iter()).zip(scales);
    all.map(|((want, got), scale)| (want - got).abs() / scale).fold(0.0, f64::max)
}

#[test]
fn without_noise_every_number_is_found() {
    let mut noise = Noise::of(1);
    let mut drives = [0; 5];
    while drives[1..].iter().any(|count| *count < 3) {
        let machine = a_machine(&mut noise);
        let n = machine.drives();
        if n > 4 || drives[n] >= 3 {
            continue;
        }
        let hidden = built(&machine, &mut noise, 0.05);
        let recording = measured(&hidden, &mut noise, EXACT, &vec![true; n]);
        let fit = fitted(&machine, &recording, false);
        assert!(fit.numbers.identifiable.iter().all(|told| *told), "{:?}", fit.confounded);
        let off = furthest(&fit, &hidden);
        assert!(off < 1e-9, "{n} drives: {off:e}");
        drives[n] += 1;
    }
}

/// A balanced machine gives no force: what is left is rounding, and no evidence of another unit or a reversed drive.
#[test]
fn rounding_is_no_evidence() {
    let mut noise = Noise::of(3);
    for machine in builtins() {
        for rates in [true, false] {
            let how = Measuring { rates, ..EXACT };
            let recording = measured(machine, &mut noise, how, &vec![true; machine.drives()]);
            let doubted = doubt(machine, &recording, false).expect("it can be used");
            assert!(doubted.is_none(), "{}, {rates}: {doubted:?}", machine.name());
        }
    }
}

/// From angles alone, at even times and at others; what is left falls with the fourth power of the step.
#[test]
fn without_noise_angles_alone_will_do() {
    let machine = builtin("nine-link").expect("built in");
    let mut noise = Noise::of(2);
    let hidden = built(machine, &mut noise, 0.02);
    for uneven in [false, true] {
        let errors = [1.0, 2.0].map(|coarser: f64| {
            let how =
                Measuring { rates: false, uneven, step: 0.004 * coarser, rows: (600.0 / coarser) as usize, ..EXACT };
            let recording = measured(&hidden, &mut Noise::of(3), how, &[true; 3]);
            furthest(&fitted(machine, &recording, false), &hidden)
        });
        assert!(errors[0] < 1e-6 && errors[1] > 4.0 * errors[0], "{uneven}: {errors:?}");
    }
}

/// Noise of the angles is said as it is: σ of white noise is found from the samples, and what φ̈ makes of it, the square
/// root of h σ² ∫ φ̈² over ∫ φ, stands against the acceleration of a sine, A ω²/√2 times what the window leaves of it.
#[test]
fn noise_of_accelerations_is_that_of_the_window() {
    let machine = family_machine("two-drive");
    let (step, sigma, size, rate) = (0.002, 4e-5, 0.5, 6.0);
    let mut noise = Noise::of(12);
    let mut motion = MeasuredMotion::default();
    for i in 0..2000 {
        let t = step * f64::from(i);
        motion.t.push(t);
        motion.q.push(PerDrive::from_fn(2, |k| {
            size * (rate * t + 1.5 * k as f64).sin() + k as f64 + sigma * normal(&mut noise)
        }));
        motion.force.push(Vector::new(normal(&mut noise), normal(&mut noise)));
        motion.moment.push(normal(&mut noise));
    }
    let rows = Regressor::of(&machine, &MeasurementSet { motions: vec![motion] }, true).expect("rows");
    let RegressorSource::Windows { half, noise: share } = rows.source else { panic!("windows") };
    // Sums over u = (t − centre)/half.
    let count = 20_000;
    let sum = |f: &dyn Fn(f64) -> f64| {
        (0..count).map(|i| f(-1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(count))).sum::<f64>() * 2.0
            / f64::from(count)
    };
    let window = |u: f64| (1.0 - u * u).powi(4);
    let bent = |u: f64| -8.0 * (1.0 - u * u).powi(3) + 48.0 * u * u * (1.0 - u * u).powi(2);
    let whole = sum(&window);
    let noisy = sigma * (step / half).sqrt() * sum(&|u| bent(u).powi(2)).sqrt() / (half * half * whole);
    let left = sum(&|u| window(u) * (rate * half * u).cos()) / whole;
    let want = noisy / (size * rate * rate / 2.0_f64.sqrt() * left);
    assert!((share / want - 1.0).abs() < 0.05, "{share} instead of {want}, ± {half} s");
}

/// Of all intervals of 95 % about as many hold what is true, whatever the noise.
#[test]
fn intervals_are_honest() {
    let cases = [
        ("white", Measuring { sigma: [0.0, 0.3, 0.05], rows: 200, motions: 2, ..EXACT }, 200, 0.005),
        ("slow", Measuring { sigma: [0.0, 0.3, 0.05], slow: 0.8, rows: 300, motions: 2, ..EXACT }, 200, 0.005),
        (
            "angles",
            Measuring { sigma: [2e-5, 0.3, 0.05], rates: false, rows: 400, step: 0.005, motions: 2, ..EXACT },
            100,
            0.02,
        ),
    ];
    for (name, how, count, most) in cases {
        let machine = builtin("two-drive").expect("built in");
        let (mut held, mut all, mut wide) = (0, 0, 0.0_f64);
        for seed in 0..count {
            let mut noise = Noise::of(1000 + seed);
            let hidden = built(machine, &mut noise, 0.02);
            let fit = fitted(machine, &measured(&hidden, &mut noise, how, &[true; 2]), false);
            for (i, want) in truth(&fit, &hidden).into_iter().enumerate().filter(|(i, _)| fit.numbers.identifiable[*i])
            {
                held += usize::from((fit.numbers.measured[i] - want).abs() <= fit.numbers.half_width(i));
                all += 1;
                wide = wide.max(fit.numbers.half_width(i));
            }
        }
        let share = held as f64 / all as f64;
        println!("{name}: {share:.4} of {all}, widest {wide:.5}");
        assert!((0.92..=0.992).contains(&share), "{name}: {share} of {all}");
        assert!(wide < 50.0 * most, "{name}: {wide}");
    }
}

/// Offsets and drifts of sensors, in each motion of its own, change nothing; heavier machines are found heavier.
#[test]
fn laws_of_scale() {
    let machine = builtin("two-drive").expect("built in");
    let mut noise = Noise::of(4);
    let hidden = built(machine, &mut noise, 0.05);
    let how = Measuring { sigma: [0.0, 0.2, 0.1], ..EXACT };
    let recording = measured(&hidden, &mut noise, how, &[true; 2]);
    let fit = fitted(machine, &recording, false);
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs() + 1e-3);
    let mut shifted = recording.clone();
    for (i, motion) in shifted.motions.iter_mut().enumerate() {
        let MeasuredMotion { t, force, moment, .. } = motion;
        force.iter_mut().zip(&*t).for_each(|(f, t)| *f += Vector::new(7.0 - 0.4 * t, (0.3 * t - 3.0) * i as f64));
        moment.iter_mut().zip(&*t).for_each(|(n, t)| *n += 0.2 * t - 11.0);
        motion.t.iter_mut().for_each(|t| *t += 1e3);
    }
    let same = fitted(machine, &shifted, false);
    let mut heavier = recording.clone();
    for motion in &mut heavier.motions {
        motion.force.iter_mut().for_each(|f| *f *= 3.0);
        motion.moment.iter_mut().for_each(|n| *n *= 3.0);
    }
    let heavier = fitted(machine, &heavier, false);
    for i in 0..fit.numbers.unknowns.count() {
        assert!(
            near(fit.numbers.measured[i], same.numbers.measured[i])
                && near(fit.numbers.half_width(i), same.numbers.half_width(i)),
            "{i}"
        );
        assert!(near(3.0 * fit.numbers.measured[i], heavier.numbers.measured[i]), "{i}");
        assert!(near(3.0 * fit.numbers.half_width(i), heavier.numbers.half_width(i)), "{i}");
    }
}

/// Of a drive that held still exactly what depends on it is not told, and the rest is.
#[test]
fn what_data_cannot_tell_is_named() {
    let machine = builtin("nine-link").expect("built in");
    let mut noise = Noise::of(5);
    let hidden = built(machine, &mut noise, 0.02);
    let exact = Measuring { rates: true, ..EXACT };
    let angles = Measuring { sigma: [1e-5, 0.1, 0.02], rates: false, rows: 500, step: 0.004, ..EXACT };
    for how in [exact, angles] {
        let recording = measured(&hidden, &mut noise, how, &[true, false, true]);
        let rows = Regressor::of(machine, &recording, false).expect("rows");
        assert_eq!(rows.moves, [true, false, true]);
        let fit = fit(machine, &rows).expect("a fit");
        for i in 0..fit.numbers.unknowns.count() {
            // At fixed q₂ its couplings still show in the moment of the others.
            let lost = match fit.numbers.unknowns.at(i) {
                Unknown::Of(Condition::Force(1), _) | Unknown::Momentum(1) => true,
                Unknown::Of(Condition::Force(_), _) | Unknown::Momentum(_) => false,
                Unknown::Of(Condition::Coupling(0, 2), ComplexPart::Along | ComplexPart::Across) => false,
                Unknown::Of(..) => continue,
            };
            assert_eq!(
                !fit.numbers.identifiable[i],
                lost,
                "{}: {:?}",
                fit.numbers.unknowns.at(i).name(machine),
                fit.confounded
            );
            assert!(!lost || fit.numbers.measured[i] == fit.numbers.nominal[i]);
        }
        let alone: Vec<_> = fit.confounded.iter().filter(|group| group.len() == 1).flatten().collect();
        for (i, lost) in [(2, true), (3, true), (13, true), (0, false), (12, false)] {
            assert_eq!(alone.contains(&&i), lost, "{i}: {:?}", fit.confounded);
        }
    }
    // What is taken of the rest is what was measured, or the file's.
    let recording = measured(&hidden, &mut noise, angles, &[true, false, true]);
    let fit = fitted(machine, &recording, false);
    let taken = adopt_parameters(&fit);
    for i in 0..fit.numbers.unknowns.of_balance() {
        let near = [fit.numbers.measured[i], fit.numbers.nominal[i]].map(|of| (taken.values[i] - of).abs());
        assert!(near[0] <= 2.0 * fit.numbers.half_width(i) || near[1] == 0.0, "{i}: {near:?}");
        assert!(fit.numbers.identifiable[i] || near[1] == 0.0);
    }
    let none = measured(&hidden, &mut noise, exact, &[false; 3]);
    assert_eq!(Regressor::of(machine, &none, false).unwrap_err(), TrimError::Still);
}

/// Drives that turn as one are told as one: what both bring to the force, and what both bring to the moment, each together.
#[test]
fn what_turns_as_one_is_told_as_one() {
    let machine = builtin("two-drive").expect("built in");
    let mut noise = Noise::of(6);
    let hidden = built(machine, &mut noise, 0.02);
    let mut recording = measured(&hidden, &mut noise, EXACT, &[true; 2]);
    let inertia = Inertia::of(&hidden);
    for motion in &mut recording.motions {
        for i in 0..motion.t.len() {
            let (q, qd, qdd) = (motion.q[i][0], motion.qd[i][0], motion.qdd[i][0]);
            let alike = |x: f64, more: f64| PerDrive::from_fn(2, |k| x + more * k as f64);
            (motion.q[i], motion.qd[i], motion.qdd[i]) = (alike(q, 0.7), alike(qd, 0.0), alike(qdd, 0.0));
            let e = DriveAngles(motion.q[i]).units();
            let wrench = base_wrench(&inertia, &e, &motion.qd[i], &motion.qdd[i], &ExternalLoads::default()).total();
            (motion.force[i], motion.moment[i]) = (wrench.force, wrench.moment);
        }
    }
    let fit = fitted(machine, &recording, false);
    // g₁ and g₂ in two parts each; C₁₂ in two parts, D₁ and D₂.
    let mut groups = fit.confounded.clone();
    groups.iter_mut().for_each(|group| group.sort_unstable());
    groups.sort();
    assert_eq!(groups, [vec![0, 1, 2, 3], vec![4, 5, 6, 7]]);
}

/// The nine-link bars with counterweights.
fn weighed() -> Machine {
    let bare = builtin("nine-link-bare").expect("built in");
    let sites = bare.resolved_links().iter().enumerate();
    let sites = sites.map(|(link, part)| CounterweightSite::on_axis(link, -0.3, part.length)).collect();
    let asked = CounterweightSpec::least(Objective::inertia(), sites, CounterweightStock::STEEL);
    place_weights(bare, &asked).expect("counterweights").machine
}

fn of_weights(machine: &Machine) -> TrimMethod {
    let mut asked = RebalanceRequest::default();
    for i in 0..machine.spec().counterweights.len() {
        for quantity in [BodyQuantity::Mass, BodyQuantity::Along] {
            asked.set_bounds(machine, Parameter::new(Body::Counterweight(i), quantity), ParameterBounds::Free);
        }
    }
    TrimMethod::Change(asked)
}

/// The dynamic force, root mean square, over motions that were measured.
fn shaking(machine: &Machine, recording: &MeasurementSet) -> f64 {
    let inertia = Inertia::of(machine);
    let (mut sum, mut count) = (0.0, 0);
    for motion in &recording.motions {
        for i in 0..motion.t.len() {
            let e = DriveAngles(motion.q[i]).units();
            let wrench = base_wrench(&inertia, &e, &motion.qd[i], &motion.qdd[i], &ExternalLoads::default());
            sum += wrench.dynamic.force.norm_sqr();
            count += 1;
        }
    }
    (sum / f64::from(count)).sqrt()
}

/// The change that is proposed is made on the machine that was measured, whose errors nobody knows: what shook it before
/// is gone but for the noise, and what is across the axes.
#[test]
fn the_real_machine_is_mended() {
    let machine = weighed();
    let mut noise = Noise::of(6);
    for _ in 0..3 {
        let mut spec = machine.spec().clone();
        for link in &mut spec.links {
            link.com += noise.between(-0.02, 0.02);
            link.mass *= 1.0 + noise.between(-0.05, 0.05);
        }
        for weight in &mut spec.counterweights {
            weight.at += noise.between(-0.004, 0.004);
            weight.mass *= 1.0 + noise.between(-0.01, 0.01);
        }
        let hidden = Machine::new(spec).expect("a machine");
        let how = Measuring { sigma: [0.0, 0.02, 0.005], rows: 300, ..EXACT };
        let recording = measured(&hidden, &mut noise, how, &[true; 3]);
        let fit = fitted(&machine, &recording, false);
        let taken = adopt_parameters(&fit);
        let mended = correct_machine(&machine, &taken, &of_weights(&machine)).expect("a change");
        let mut after = hidden.spec().clone();
        for change in &mended.changes {
            let tenths = (change.to - change.from) / 1e-4;
            assert!((tenths - tenths.round()).abs() < 1e-6, "{change:?} is not to be set by hand");
            let (_, rest) = change.key.split_once('.').expect("a key");
            let (number, what) = rest.split_once('.').expect("a key");
            let weight = &mut after.counterweights[number.parse::<usize>().expect("a number") - 1];
            match what {
                "mass" => weight.mass += change.to - change.from,
                _ => weight.at += change.to - change.from,
            }
        }
        let after = Machine::new(after).expect("a machine");
        let (before, now) = (shaking(&hidden, &recording), shaking(&after, &recording));
        assert!(now < 0.5 * how.sigma[1] && now < 0.15 * before, "{before} N to {now} N");
        // And each number stays within what was said of it, with room for what is taken from the file and for rounding.
        let left = fit.numbers.unknowns.nominal(&Inertia::of(&after));
        let scales = fit.numbers.unknowns.scales(&Inertia::of(&after));
        for (i, left) in left.iter().enumerate().take(fit.numbers.unknowns.of_balance()) {
            assert!(
                left.abs() < 2.0 * fit.numbers.half_width(i) + 1e-3 * scales[i],
                "{i}: {left}, {}",
                fit.numbers.half_width(i)
            );
        }
    }
}

/// What is off is taken as measured, and nothing else is; what is taken lies within what was said of it.
#[test]
fn off_and_taken_agree() {
    let machine = builtin("two-drive").expect("built in");
    let how = Measuring { sigma: [0.0, 0.5, 0.1], rows: 200, motions: 2, ..EXACT };
    let (mut off, mut not) = (0, 0);
    for seed in 0..30 {
        let mut noise = Noise::of(700 + seed);
        let hidden = built(machine, &mut noise, 0.004);
        let fit = fitted(machine, &measured(&hidden, &mut noise, how, &[true; 2]), false);
        let taken = adopt_parameters(&fit);
        for i in 0..fit.numbers.unknowns.of_balance() {
            assert_eq!(taken.differs[i], taken.measured[i]);
            assert_eq!(taken.differs[i], taken.values[i] != fit.numbers.nominal[i]);
            assert_eq!(taken.differs[i], taken.half_widths[i] > 0.0);
            assert!(!taken.differs[i] || (taken.values[i] - fit.numbers.nominal[i]).abs() > taken.half_widths[i]);
            (off, not) = (off + u32::from(taken.differs[i]), not + u32::from(!taken.differs[i]));
        }
    }
    assert!(off > 30 && not > 30, "{off}, {not}");
}

/// A machine that is as its file says is made worse by any change: none is shown to help, however loud the sensor is.
/// Where a change is shown to help, it does.
#[test]
fn a_change_is_proposed_where_it_helps() {
    let machine = weighed();
    let way = of_weights(&machine);
    let (mut harmful, mut helpful) = (0, 0);
    for seed in 0..24 {
        let mut noise = Noise::of(800 + seed);
        let is_off = seed % 2 == 1;
        let mut spec = machine.spec().clone();
        if is_off {
            spec.counterweights.iter_mut().for_each(|weight| weight.at += noise.between(-0.01, 0.01));
        }
        let hidden = Machine::new(spec).expect("a machine");
        let how = Measuring { sigma: [0.0, 0.3, 0.05], rows: 200, motions: 2, ..EXACT };
        let recording = measured(&hidden, &mut noise, how, &[true; 3]);
        let rows = Regressor::of(&machine, &recording, false).expect("rows");
        let fit = fit(&machine, &rows).expect("a fit");
        let taken = adopt_parameters(&fit);
        let mended = correct_machine(&machine, &taken, &way).expect("a change");
        if !correction_benefit(&machine, &rows, &fit, &taken, &mended).helps() {
            continue;
        }
        // The force of the true machine before and after.
        let truth = fit.numbers.unknowns.nominal(&Inertia::of(&hidden));
        let size = |by: f64| {
            let left = |i: usize| Vector::new(truth[2 * i], truth[2 * i + 1]) + mended.effects[i] * by;
            (0..3).map(|i| left(i).norm_sqr()).sum::<f64>()
        };
        let helps = size(1.0) < size(0.0);
        (harmful, helpful) = (harmful + u32::from(!helps), helpful + u32::from(helps));
    }
    assert!(harmful <= 1 && helpful >= 10, "{harmful} harmful, {helpful} helpful");
}

/// The query says of a measurement what its parts say one by one; a wrong sign is doubted unless it is taken as given.
#[test]
fn the_query_puts_all_of_it_together() {
    let machine = weighed();
    let mut noise = Noise::of(805);
    let mut spec = machine.spec().clone();
    spec.counterweights.iter_mut().for_each(|weight| weight.at += noise.between(-0.01, 0.01));
    let hidden = Machine::new(spec).expect("a machine");
    let how = Measuring { sigma: [0.0, 0.3, 0.05], rows: 200, motions: 2, ..EXACT };
    let mut recording = measured(&hidden, &mut noise, how, &[true; 3]);
    let request = |recording: &MeasurementSet, as_given: bool| TrimRequest {
        machine: Shared(machine.clone().into()),
        recording: Shared(recording.clone().into()),
        angles_only: false,
        as_given,
        method: of_weights(&machine),
        accelerations: None,
    };
    let ask = |recording: &MeasurementSet, as_given: bool| answer_now::<TrimQuery>(request(recording, as_given));
    let found = ask(&recording, false);
    assert!(found.doubt.is_none() && found.angle_noise.is_none());
    let trim = found.outcome.expect("a fit");
    let fit = fitted(&machine, &recording, false);
    assert_eq!(trim.adopted, adopt_parameters(&fit));
    let told = trim.report.numbers.iter().map(|number| number.unknown.measured.expect("told"));
    assert!(told.eq(fit.numbers.measured.iter().map(|x| x + 0.0)) && trim.report.rows == 400);
    let mended = trim.correction.expect("a change");
    let gain = trim.report.worth.expect("what it is worth");
    assert_eq!((gain.helps, trim.report.changes.is_empty()), (gain.worth.helps(), !gain.helps));
    assert_eq!(mended.changes, trim.report.changes);
    recording.motions.iter_mut().for_each(|motion| motion.moment.iter_mut().for_each(|n| *n = -*n));
    assert!(matches!(ask(&recording, false).outcome, Err(NoTrim::Doubted(_))));
    let believed = ask(&recording, true);
    assert!(believed.doubt.is_some() && believed.outcome.is_ok());
    // Faults are tried one by one, each in a portion.
    let mut heard = Vec::new();
    let mut work = TrimQuery::begin(request(&recording, false));
    while let Portion::More(done) = work.go_on(&mut |_| true) {
        heard.push(done);
    }
    assert!(heard.is_sorted() && heard.iter().filter(|done| (0.05..0.8).contains(*done)).count() > 20, "{heard:?}");
    recording.motions.clear();
    assert!(matches!(ask(&recording, true).outcome, Err(NoTrim::Unusable(_))));
}

/// A machine without counterweights gets new ones; the machine that is written has what was measured.
#[test]
fn new_counterweights_mend_what_has_none() {
    let machine = builtin("nine-link").expect("built in");
    let mut noise = Noise::of(7);
    let mut spec = machine.spec().clone();
    spec.links.iter_mut().for_each(|link| link.com += noise.between(-0.01, 0.01));
    let hidden = Machine::new(spec).expect("a machine");
    let recording = measured(&hidden, &mut noise, EXACT, &[true; 3]);
    let taken = adopt_parameters(&fitted(machine, &recording, false));
    let sites = machine.resolved_links().iter().enumerate();
    let sites = sites.map(|(link, p)| CounterweightSite::on_axis(link, -p.length, p.length)).collect();
    let asked = CounterweightSpec::least(Objective::mass(), sites, CounterweightStock::STEEL);
    let mended = correct_machine(machine, &taken, &TrimMethod::Add(asked)).expect("new ones");
    let mut after = hidden.spec().clone();
    after.counterweights = mended.machine.spec().counterweights.clone();
    let after = Machine::new(after).expect("a machine");
    assert!(shaking(&after, &recording) < 0.02 * shaking(&hidden, &recording));
    let (written, misses) = identified_machine(machine, &taken).expect("one");
    assert!(misses.iter().all(|miss| miss.norm() < 1e-9), "{misses:?}");
    let (got, want) = (Inertia::of(&written), Inertia::of(&hidden));
    for condition in Condition::all(3) {
        assert!((condition.residual(&got) - condition.residual(&want)).norm() < 1e-7, "{condition:?}");
    }
    assert!((0..3).all(|k| (got.momentum(k) - want.momentum(k)).abs() < 1e-8), "{:?}", got.momenta());
}

/// What a next motion is said to tell, it tells.
/// Every candidate is driven, and measured as the first motions were: the number that is least known and, in the mean, all
/// numbers of balance become as certain as was promised. White errors, and errors that last.
#[test]
fn the_next_motion_keeps_its_promise() {
    let machine = builtin("two-drive").expect("built in");
    for slow in [0.0, 0.8] {
        let (mut noise, mut gained) = (Noise::of(8), 0.0);
        let hidden = built(machine, &mut noise, 0.02);
        let how = Measuring { sigma: [0.0, 0.2, 0.05], motions: 1, rows: 300, slow, ..EXACT };
        let recording = measured(&hidden, &mut noise, how, &[true; 2]);
        let rows = Regressor::of(machine, &recording, false).expect("rows");
        let before = fit(machine, &rows).expect("a fit");
        let seen = |k: usize| recording.motions[0].qdd.iter().map(|qdd| qdd[k].abs()).fold(0.0, f64::max);
        // Much faster than before, so that much is to be gained.
        let fast = [4.0 * seen(0), 4.0 * seen(1)];
        let usual = next_excitation(machine, &recording, &rows, &before, None);
        let told = next_excitation(machine, &recording, &rows, &before, Some(&fast));
        assert!(told.candidates[0].half_width < usual.candidates[0].half_width);
        let best = &told.candidates[0];
        let last = told.candidates.last().expect("several");
        assert!(best.half_width < told.half_width && best.half_width <= last.half_width);
        let ends = |k: usize| {
            let all = recording.motions[0].q.iter().map(|q| q[k]);
            all.fold([f64::MAX, f64::MIN], |[low, high]: [f64; 2], q| [low.min(q), high.max(q)])
        };
        for (candidate, most) in usual
            .candidates
            .iter()
            .map(|one| (one, [seen(0), seen(1)]))
            .chain(told.candidates.iter().map(|one| (one, fast)))
        {
            let mut parts = vec![[[0.0; 3]; 3]; 2];
            let sizes = candidate.amplitude.iter().zip(&candidate.frequency);
            for ((k, sign), (a, f)) in candidate.drives.iter().zip(sizes) {
                let w = std::f64::consts::TAU * f;
                parts[*k][0] = [sign * a, w, 0.0];
                let [low, high] = ends(*k);
                assert!(*a <= 0.5 * (high - low) * (1.0 + 1e-12), "no further than it was driven");
                assert!(a * w * w <= most[*k] * (1.0 + 1e-9), "no faster than it may be: {candidate:?}");
            }
            let sines = Sines(parts, (0..2).map(|k| ends(k).iter().sum::<f64>() / 2.0).collect());
            let (inertia, mut more) = (Inertia::of(&hidden), MeasuredMotion::default());
            let (fresh, mut error) = ((1.0 - slow * slow).sqrt(), [0.0; 3].map(|_: f64| normal(&mut noise)));
            for i in 0..how.rows {
                let t = i as f64 * how.step;
                let [q, qd, qdd] = sines.at(t);
                let wrench =
                    base_wrench(&inertia, &DriveAngles(q).units(), &qd, &qdd, &ExternalLoads::default()).total();
                error.iter_mut().for_each(|e| *e = slow * *e + fresh * normal(&mut noise));
                more.t.push(t);
                more.q.push(q);
                more.qd.push(qd);
                more.qdd.push(qdd);
                more.force.push(wrench.force + Vector::new(error[0], error[1]) * how.sigma[1]);
                more.moment.push(wrench.moment + how.sigma[2] * error[2]);
            }
            let mut both = recording.clone();
            both.motions.push(more);
            let after = fitted(machine, &both, false);
            let ratio = after.numbers.half_width(told.least_known) / candidate.half_width;
            assert!((0.6..1.6).contains(&ratio), "{candidate:?}: {} found", after.numbers.half_width(told.least_known));
            let balance = before.numbers.unknowns.of_balance();
            let gains = (0..balance).map(|i| (before.numbers.half_width(i) / after.numbers.half_width(i)).ln());
            let all = (gains.sum::<f64>() / balance as f64).exp();
            assert!((0.7..1.45).contains(&(all / candidate.all)), "{candidate:?}: {all} found");
            gained = f64::max(gained, all);
        }
        assert!(gained > 2.0, "{gained}");
    }
}

/// Each drive alone, every pair in step and against each other, all in step, and each at a frequency of its own.
#[test]
fn every_kind_of_motion_is_a_candidate() {
    let mut noise = Noise::of(17);
    for (name, count) in [("two-drive", 5), ("nine-link", 11), ("four-drive", 18)] {
        let machine = builtin(name).expect("built in");
        let n = machine.drives();
        let how = Measuring { sigma: [0.0, 0.2, 0.05], ..EXACT };
        let recording = measured(machine, &mut noise, how, &vec![true; n]);
        let rows = Regressor::of(machine, &recording, false).expect("rows");
        let candidates =
            next_excitation(machine, &recording, &rows, &fit(machine, &rows).expect("a fit"), None).candidates;
        assert_eq!(candidates.len(), count, "{name}");
        let all = candidates.iter().filter(|one| one.drives.len() == n && n > 2).collect::<Vec<_>>();
        let alike = |one: &&&stillbase::study::trim::Excitation| one.frequency.windows(2).all(|f| f[0] == f[1]);
        assert!(n < 3 || (all.len() == 2 && all.iter().filter(alike).count() == 1), "{name}");
        for one in &candidates {
            assert!(one.half_width.is_finite() && one.all >= 1.0, "{name}: {one:?}");
        }
    }
}

/// Estimates scatter as their intervals say, also where rows are few; and white errors count as what they are.
#[test]
fn estimates_scatter_as_their_intervals_say() {
    let machine = builtin("two-drive").expect("built in");
    let white = Measuring { sigma: [0.0, 0.3, 0.05], rows: 200, motions: 2, ..EXACT };
    let cases = [
        ("white", white, 200, 0.90, 1.06),
        ("few", Measuring { rows: 30, motions: 1, step: 0.05, ..white }, 400, 0.92, 1.05),
    ];
    for (name, how, count, least, most) in cases {
        let (mut sum, mut all) = (0.0, 0.0);
        for seed in 0..count {
            let mut noise = Noise::of(3000 + seed);
            let hidden = built(machine, &mut noise, 0.02);
            let fit = fitted(machine, &measured(&hidden, &mut noise, how, &[true; 2]), false);
            for (i, want) in truth(&fit, &hidden).into_iter().enumerate().filter(|(i, _)| fit.numbers.identifiable[*i])
            {
                sum += (1.96 * (fit.numbers.measured[i] - want) / fit.numbers.half_width(i)).powi(2);
                all += 1.0;
            }
        }
        let scatter = (sum / all).sqrt();
        println!("{name}: {scatter}");
        assert!((least..=most).contains(&scatter), "{name}: {scatter}");
    }
}

/// Rows whose errors are alike count for fewer: of correlation ρ from row to row for (1 − ρ)/(1 + ρ) of them.
#[test]
fn alike_rows_count_for_fewer() {
    let machine = builtin("two-drive").expect("built in");
    for slow in [0.0, 0.5, 0.8] {
        let how = Measuring { sigma: [0.0, 0.3, 0.05], slow, rows: 800, motions: 2, ..EXACT };
        let rows = 1600.0 * (1.0 - slow) / (1.0 + slow);
        let mut sums = [0.0; 2];
        for seed in 0..8 {
            let mut noise = Noise::of(4000 + seed);
            let hidden = built(machine, &mut noise, 0.02);
            let fit = fitted(machine, &measured(&hidden, &mut noise, how, &[true; 2]), false);
            sums = [0, 1].map(|of| sums[of] + fit.effective[of] / 8.0);
        }
        println!("{slow}: {sums:?} of {rows}");
        for (got, want) in sums.into_iter().zip([2.0 * rows, rows]) {
            assert!((0.7..1.4).contains(&(got / want)), "{slow}: {got}, want {want}");
        }
    }
}

/// Half the interval of a gain grows with how many numbers a change was chosen by, as the square root of the 95 % quantile of
/// χ² does: numbers of a printed table.
#[test]
fn the_interval_of_a_gain_counts_what_it_was_chosen_by() {
    let machine = weighed();
    let mut noise = Noise::of(31);
    let hidden = built(&machine, &mut noise, 0.02);
    let how = Measuring { sigma: [0.0, 0.3, 0.05], rows: 200, motions: 2, ..EXACT };
    let rows = Regressor::of(&machine, &measured(&hidden, &mut noise, how, &[true; 3]), false).expect("rows");
    let fit = fit(&machine, &rows).expect("a fit");
    let mut taken = adopt_parameters(&fit);
    let mended = correct_machine(&machine, &taken, &of_weights(&machine)).expect("a change");
    let mut of = |count: usize| {
        taken.measured = (0..fit.numbers.unknowns.of_balance()).map(|i| i < count).collect();
        correction_benefit(&machine, &rows, &fit, &taken, &mended)
    };
    let first = of(1);
    for (count, quantile) in [(2, 5.991), (3, 7.815), (4, 9.488), (6, 12.592), (12, 21.026)] {
        let other = of(count);
        let want = (quantile / 3.841_f64).sqrt();
        assert!((other.half_width / first.half_width / want - 1.0).abs() < 0.03, "{count}: {other:?}, {first:?}");
        assert_eq!((other.gain, other.force, other.moment), (first.gain, first.force, first.moment));
    }
    // The gain is what the mean square of force and moment, weighed alike, loses.
    let radius_squared = Inertia::of(&machine).diagonals().iter().sum::<f64>() / machine.mass();
    let j = |i: usize| radius_squared * first.force[i].powi(2) + first.moment[i].powi(2);
    assert!((first.gain - (1.0 - j(1) / j(0))).abs() < 1e-9, "{first:?}");
}

#[test]
fn what_is_no_recording_is_refused() {
    let machine = builtin("two-drive").expect("built in");
    let mut noise = Noise::of(9);
    let good = measured(machine, &mut noise, EXACT, &[true; 2]);
    let refused = |change: &dyn Fn(&mut MeasuredMotion)| {
        let mut bad = good.clone();
        change(&mut bad.motions[1]);
        Regressor::of(machine, &bad, false).expect_err("refused").to_string()
    };
    assert!(refused(&|m| m.moment[3] = f64::NAN).starts_with("motion 2: what is no finite number"));
    assert!(refused(&|m| m.t[4] = m.t[3]).contains("times that do not rise"));
    assert!(refused(&|m| _ = m.force.pop()).contains("lists of different lengths"));
    assert!(refused(&|m| m.q.iter_mut().for_each(|q| *q = PerDrive::zeros(3))).contains("3 drives"));
    let short = |rows: usize| {
        let own = MeasuredMotion {
            t: good.motions[0].t[..rows].to_vec(),
            q: good.motions[0].q[..rows].to_vec(),
            qd: good.motions[0].qd[..rows].to_vec(),
            qdd: good.motions[0].qdd[..rows].to_vec(),
            force: good.motions[0].force[..rows].to_vec(),
            moment: good.motions[0].moment[..rows].to_vec(),
        };
        MeasurementSet { motions: vec![own] }
    };
    for name in ["two-drive", "nine-link", "four-drive"] {
        let machine = builtin(name).expect("built in");
        let rows = Regressor::of(machine, &MeasurementSet::default(), false).expect_err("nothing");
        // As many as stand in the mass matrix and beside it: g_k and C_kl have two parts each, D_k has one.
        let n = machine.drives();
        assert_eq!(rows, TrimError::TooFew { rows: 0, unknowns: 2 * (n + n * (n - 1) / 2) + n }, "{name}");
    }
    let few = Regressor::of(machine, &short(3), false).expect_err("too few");
    assert_eq!(few, TrimError::TooFew { rows: 3, unknowns: 8 });
    assert!(matches!(
        Regressor::of(machine, &short(20), true),
        Err(TrimError::Short { motion: 0, rows: 20, want: 51, .. })
    ));
    let huge = {
        let mut huge = good.clone();
        huge.motions.iter_mut().for_each(|m| m.t.iter_mut().enumerate().for_each(|(i, t)| *t = 1e-9 * i as f64));
        huge
    };
    // At a gigahertz nothing but noise moves, or what is found is finite.
    if let Ok(rows) = Regressor::of(machine, &huge, true) {
        assert!(matches!(rows.source, RegressorSource::Windows { .. }));
        if let Ok(fit) = fit(machine, &rows) {
            assert!(fit.numbers.measured.iter().all(|x| x.is_finite()));
        }
    }
}
