//! Trim in orbit: machines whose files are wrong are found from the rates of the bases that they turn.

use std::f64::consts::TAU;

use stillbase::exchange::mjcf::middle;
use stillbase::mechanics::arm_on_base::FloatingBase;
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{PerDrive, Vector};
use stillbase::query::{Shared, answer_now};
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;
use stillbase::simulation::signal_table::{SignalColumn, SignalTable};
use stillbase::simulation::signals::signals;
use stillbase::study::trim::{
    Doubt, MeasuredUnknown, NoTrim, OrbitBase, OrbitMotion, OrbitReport, OrbitTrimQuery, OrbitTrimRequest, TrimError,
    Unknowns, orbit_trim,
};

use crate::support::Noise;

type OrbitNumbers = Vec<MeasuredUnknown>;

const RHO: [f64; 2] = [-0.0680112181717378, -0.24212956077851439];

/// A motion of ten seconds in which each drive swings in its own way; `more` goes into `[base]`.
fn flown(machine: &Machine, com: [f64; 2], more: &str, turn: f64) -> OrbitMotion {
    let (middle, is_bounded) = (middle(machine), !machine.angles().is_empty());
    // Within the limits of the angles between drives, if there are any.
    let [size, apart] = if is_bounded { [0.2, 0.0] } else { [1.0, 0.7] };
    let swing = |k: usize, t: f64| {
        let (own, k, ease) = (middle[k], k as f64, (t / 10.0 * TAU / 2.0).sin().powi(4));
        let way = 0.9 * ((0.9 + 0.4 * k) * t + turn * (k + 1.0)).sin() + 0.3 * (2.3 * t + k).cos();
        own + apart * k + size * ease * way
    };
    let row = |i: u32| {
        let t = 0.1 * f64::from(i);
        let q: Vec<String> = (0..machine.drives()).map(|k| swing(k, t).to_string()).collect();
        format!("[{t}, {}]", q.join(", "))
    };
    measured(machine, &(0..=100).map(row).collect::<Vec<_>>().join(", "), com, more)
}

/// The signals of a motion through samples of time and angles; `more` goes into `[base]`.
fn measured(machine: &Machine, samples: &str, com: [f64; 2], more: &str) -> OrbitMotion {
    let text = format!(
        "machine = '{}'\n[task]\nkind = 'given'\nsamples = [{samples}]\n[base]\nkind = 'free'\nmass = 11.211\n\
         inertia = 0.20215\ncom = {com:?}\n{more}",
        machine.name()
    );
    let scenario = Scenario { machine: machine.clone(), ..Scenario::parse(&text, "orbit", None).expect("valid") };
    let all = signals(machine);
    let (mut table, mut step) = (SignalTable::of(&all), 0);
    replay(&scenario, |_, frame| {
        if step % 20 == 0 {
            table.push(frame.time, all.iter().map(|signal| signal.value(frame)));
        }
        step += 1;
    })
    .expect("it runs");
    OrbitMotion::of(machine, &table).expect("signals of a run")
}

fn base(com: [f64; 2], wheel: f64) -> OrbitBase {
    OrbitBase { body: FloatingBase { mass: 11.211, inertia: 0.20215, com: Vector::new(com[0], com[1]) }, wheel }
}

/// The numbers of a machine, and the scale of each.
fn truth(machine: &Machine) -> (Vec<f64>, Vec<f64>) {
    let (unknowns, inertia) = (Unknowns::of(machine.drives()), Inertia::of(machine));
    (unknowns.nominal(&inertia), unknowns.scales(&inertia))
}

#[track_caller]
fn exact(what: &str, report: &OrbitReport, machine: &Machine) {
    let (numbers, scales) = truth(machine);
    for ((number, want), scale) in report.numbers.iter().zip(numbers).zip(scales) {
        let got = number.measured.unwrap_or_else(|| panic!("{what}: {} is not told", number.name));
        assert!((got - want).abs() < 1e-5 * scale, "{what}: {} is {got}, want {want}", number.name);
    }
    assert!(report.rate_noise < 1e-8, "{what}: {} rad/s", report.rate_noise);
}

/// A motion of ten seconds in which each joint turns as `amplitude` says, rad of joint and time, eased at both ends.
fn swing(machine: &Machine, amplitude: &dyn Fn(usize, f64) -> f64) -> OrbitMotion {
    let row = |i: u32| {
        let t = 0.1 * f64::from(i);
        let ease = (t / 10.0 * TAU / 2.0).sin().powi(2);
        let joint = |k: usize| ease * amplitude(k, t);
        let q: Vec<String> =
            (0..machine.drives()).map(|k| (1.57 + (0..=k).map(joint).sum::<f64>()).to_string()).collect();
        format!("[{t}, {}]", q.join(", "))
    };
    measured(machine, &(0..=100).map(row).collect::<Vec<_>>().join(", "), RHO, "")
}

/// Of the same mass as the built-in one, for this is taken as known.
fn wrong_spot() -> Machine {
    let spot = builtin("spot").expect("built in");
    spot.set_all([("link.2.com", "0.23"), ("link.1.com_normal", "0.02"), ("link.3.inertia", "0.0003")]).expect("valid")
}

#[test]
fn without_noise_every_number_is_found() {
    let (file, built) = (builtin("spot").expect("built in"), wrong_spot());
    let report = orbit_trim(file, &base(RHO, 0.0), &[flown(&built, RHO, "", 0.0)]).expect("a fit");
    exact("spot", &report, &built);
    let off: Vec<&str> = report.numbers.iter().filter(|number| number.off).map(|n| n.name.as_str()).collect();
    for name in ["g elbow along", "g shoulder across", "C shoulder,elbow along"] {
        assert!(off.contains(&name), "{name}: {off:?}");
    }
    assert!(report.rate_off > 1e-4, "the file explained the rates: {}", report.rate_off);
    // A wheel in the base, and gears.
    let wheel = flown(&built, RHO, "[base.wheel]\ninertia = 0.01", 0.0);
    assert!(wheel.wheel_rate.iter().any(|rate| rate.abs() > 0.1));
    exact("wheel", &orbit_trim(file, &base(RHO, 0.01), &[wheel]).expect("a fit"), &built);
    let geared = builtin("nine-link-geared").expect("built in");
    let built = geared.set("link.5.com", "-0.03").expect("valid");
    let motions = [flown(&built, RHO, "", 0.0), flown(&built, RHO, "", 2.0)];
    exact("gears", &orbit_trim(geared, &base(RHO, 0.0), &motions).expect("a fit"), &built);
}

/// Intervals of 95 % hold the true numbers about as often.
#[test]
fn intervals_hold_the_truth() {
    let (file, built) = (builtin("spot").expect("built in"), wrong_spot());
    let motions = [flown(&built, RHO, "", 0.0), flown(&built, RHO, "", 2.0)];
    let (numbers, mut noise) = (truth(&built).0, Noise::of(7));
    let (mut held, mut all, mut found) = (0, 0, 0);
    for _ in 0..40 {
        let mut measured = motions.clone();
        for rate in measured.iter_mut().flat_map(|motion| &mut motion.base_rate) {
            // The sum of twelve even numbers is nearly normal.
            *rate += 2e-5 * (0..12).map(|_| noise.between(-0.5, 0.5)).sum::<f64>();
        }
        let report = orbit_trim(file, &base(RHO, 0.0), &measured).expect("a fit");
        assert!((report.rate_noise / 2e-5 - 1.0).abs() < 0.15, "{} rad/s", report.rate_noise);
        for (number, want) in report.numbers.iter().zip(&numbers) {
            if let Some((got, half)) = number.measured.zip(number.half_width) {
                (held, all) = (held + usize::from((got - want).abs() <= half), all + 1);
            }
        }
        found += usize::from(report.numbers.iter().any(|number| number.name == "g elbow along" && number.off));
    }
    let share = f64::from(held as u32) / f64::from(all as u32);
    assert!(all >= 400 && (0.90..0.995).contains(&share), "{held} of {all}");
    assert_eq!(found, 40, "the centre of mass of the forearm is 32 mm off");
}

/// With its centre of mass at the pin, a base does not tell first moments apart from couplings and momenta.
#[test]
fn what_momentum_does_not_tell_is_named() {
    let (file, built) = (builtin("spot").expect("built in"), wrong_spot());
    let motion = flown(&built, [0.0; 2], "", 0.0);
    let report = orbit_trim(file, &base([0.0; 2], 0.0), std::slice::from_ref(&motion)).expect("a fit");
    let told: Vec<bool> = report.numbers.iter().map(|number| number.identifiable).collect();
    assert!(!told[..6].contains(&true) && report.unidentifiable.iter().flatten().any(|name| name == "g elbow along"));
    let still = OrbitMotion {
        t: motion.t[..100].to_vec(),
        attitude: vec![0.0; 100],
        angles: motion.angles[..1].repeat(100),
        rates: motion.rates[..1].repeat(100),
        base_rate: vec![0.0; 100],
        wheel_rate: vec![0.0; 100],
    };
    let report = orbit_trim(file, &base(RHO, 0.0), &[still]).expect("a fit");
    assert!(report.numbers.iter().all(|number| !number.identifiable && !number.off));
    let short = OrbitMotion { base_rate: motion.base_rate[..5].to_vec(), ..motion };
    let why = orbit_trim(file, &base(RHO, 0.0), &[short]).expect_err("too short");
    assert!(matches!(why, TrimError::Motion { motion: 0, .. }), "{why}");
}

/// Wrong known values leave nothing in the rates; one of them alone explains them, and then the intervals do not hold.
#[test]
fn a_known_value_that_is_wrong_is_named() {
    let file = builtin("spot").expect("built in");
    let flown = |built: &Machine| [0.0, 2.0].map(|turn| flown(built, RHO, "", turn));
    let named = |report: &OrbitReport, key: &str| {
        let known = report.known.iter().find(|known| known.key == key);
        known.unwrap_or_else(|| panic!("{key} is not named: {:?}", report.known)).explains
    };
    let heavy = file.set("link.2.mass", "0.40").expect("valid");
    let report = orbit_trim(file, &base(RHO, 0.0), &flown(&heavy)).expect("a fit");
    assert!((named(&report, "link.2.mass") - 0.40).abs() < 1e-5, "{:?}", report.known);
    assert!(report.rate_noise < 1e-8, "the fit takes it up: {}", report.rate_noise);
    let words = report.doubts().join("\n");
    assert!(words.contains("link.2.mass = 0.40000 kg instead of 0.33500"), "{words}");
    // The base of the file.
    let mut wrong = base(RHO, 0.0);
    wrong.body.inertia = 0.21;
    let report = orbit_trim(file, &wrong, &flown(file)).expect("a fit");
    assert!((named(&report, "base.inertia") - 0.20215).abs() < 1e-5, "{:?}", report.known);
    // A centre of mass is what is looked for, and no known value explains it.
    let report = orbit_trim(file, &base(RHO, 0.0), &flown(&wrong_spot())).expect("a fit");
    assert!(report.known.is_empty() && report.doubts().is_empty(), "{:?}", report.known);
    assert!(orbit_trim(file, &base(RHO, 0.0), &flown(file)).expect("a fit").known.is_empty());
}

/// What is stated for 1 % is what the fit gives if the known values are so.
#[test]
fn known_values_count_as_stated() {
    let (file, built) = (builtin("spot").expect("built in"), wrong_spot());
    let motions = [flown(&built, RHO, "", 0.0)];
    let report = |base: &OrbitBase| orbit_trim(file, base, &motions).expect("a fit").numbers;
    let plain = report(&base(RHO, 0.0));
    let [mut mass, mut inertia] = [base(RHO, 0.0); 2];
    mass.body.mass *= 1.01;
    inertia.body.inertia *= 1.01;
    let [mass, inertia] = [report(&mass), report(&inertia)];
    for (i, number) in plain.iter().enumerate() {
        let shift = |of: &OrbitNumbers| of[i].measured.expect("told") - number.measured.expect("told");
        let [bases, stated] = [shift(&mass).hypot(shift(&inertia)), number.per_percent.expect("told")];
        // The mass of the arm, 0.8 of 12 kg, adds little.
        assert!(stated > 0.95 * bases - 1e-9 && stated < 1.5 * bases + 1e-5, "{}: {stated}, {bases}", number.name);
    }
}

#[test]
fn what_the_model_does_not_explain_is_said() {
    let file = builtin("spot").expect("built in");
    let motion = flown(&wrong_spot(), RHO, "", 0.0);
    let mut pushed = motion.clone();
    // As if thrusters fired now and then.
    for (i, rate) in pushed.base_rate.iter_mut().enumerate() {
        *rate += 1e-3 * (i as f64 * TAU / 400.0).sin().powi(3);
    }
    let report = |motion: OrbitMotion| orbit_trim(file, &base(RHO, 0.0), &[motion]).expect("a fit");
    let words = report(pushed).doubts().join("\n");
    assert!(words.contains("varies slowly"), "{words}");
    let (mut noisy, mut noise) = (motion, Noise::of(3));
    noisy.base_rate.iter_mut().for_each(|rate| *rate += 1e-4 * noise.between(-1.0, 1.0));
    assert!(report(noisy).doubts().is_empty());
    let wheel = flown(file, RHO, "[base.wheel]\ninertia = 0.01", 0.0);
    let why = orbit_trim(file, &base(RHO, 0.0), &[wheel]).expect_err("a wheel that the base does not have");
    assert!(matches!(why, TrimError::NoWheel { rate } if rate > 0.1), "{why}");
}

/// One swing of the shoulder with all else straight tells nothing apart; the report says what would.
#[test]
fn one_swing_says_what_is_wanted() {
    let scenario = Scenario::builtin("spot-swing").expect("built in");
    let (all, mut step) = (signals(&scenario.machine), 0);
    let mut table = SignalTable::of(&all);
    replay(&scenario, |_, frame| {
        if step % 20 == 0 {
            table.push(frame.time, all.iter().map(|signal| signal.value(frame)));
        }
        step += 1;
    })
    .expect("it runs");
    let swing = OrbitMotion::of(&scenario.machine, &table).expect("signals");
    let report = orbit_trim(&scenario.machine, &base(RHO, 0.0), &[swing]).expect("a fit");
    let advice = report.advice.expect("not all is told");
    assert!(advice.contains("shoulder and elbow") && advice.contains("turn apart"), "{advice}");
    let more =
        orbit_trim(&scenario.machine, &base(RHO, 0.0), &[flown(&scenario.machine, RHO, "", 0.0)]).expect("a fit");
    assert_eq!(more.advice, None);
}

/// One row as its columns say.
struct Row {
    /// Absolute angles and rates of the drives.
    q: PerDrive,
    qd: PerDrive,
    /// Angle and rate of the base.
    turn: f64,
    rate: f64,
    wheel: f64,
}

/// A mistake of the columns.
type Spoil = fn(&mut Row);

fn spoilt(motion: &OrbitMotion, spoil: Spoil) -> OrbitMotion {
    let mut all = motion.clone();
    let shifted = |of: &PerDrive, by: f64| PerDrive::from_fn(of.len(), |k| of[k] + by);
    for i in 0..motion.rows() {
        let (turn, rate) = (motion.attitude[i], motion.base_rate[i]);
        let (q, qd) = (shifted(&motion.angles[i], turn), shifted(&motion.rates[i], rate));
        let mut row = Row { q, qd, turn, rate, wheel: motion.wheel_rate[i] };
        spoil(&mut row);
        (all.angles[i], all.rates[i]) = (shifted(&row.q, -row.turn), shifted(&row.qd, -row.rate));
        (all.attitude[i], all.base_rate[i], all.wheel_rate[i]) = (row.turn, row.rate, row.wheel);
    }
    all
}

impl Row {
    /// Replaces angles and rates of the drives by linear functions of them.
    fn each(&mut self, value: impl Fn(&PerDrive, f64, usize) -> f64) {
        self.q = PerDrive::from_fn(self.q.len(), |k| value(&self.q, self.turn, k));
        self.qd = PerDrive::from_fn(self.qd.len(), |k| value(&self.qd, self.rate, k));
    }
}

fn doubted(file: &Machine, base: OrbitBase, motions: Vec<OrbitMotion>) -> Option<Doubt> {
    let request = OrbitTrimRequest {
        machine: Shared(file.clone().into()),
        base,
        motions: Shared(motions.into()),
        as_given: false,
    };
    match answer_now::<OrbitTrimQuery>(request).outcome {
        Ok(_) => None,
        Err(NoTrim::Doubted(doubt)) => Some(*doubt),
        Err(why) => panic!("{why}"),
    }
}

/// Each usual mistake of the columns is refused and named first, with little noise; motions without one are believed, with
/// much noise, too.
#[test]
fn mistakes_of_columns_are_named() {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    let mistakes: [(&str, Spoil); 21] = [
        ("the drives are measured relative to the base", |row| row.each(|q, turn, k| q[k] - turn)),
        ("angle/shoulder relative to the base and angle/elbow and angle/wrist to the drive before", |row| {
            row.each(|q, turn, k| q[k] - if k == 0 { turn } else { q[k - 1] });
        }),
        ("angle/elbow counts the other way", |row| row.each(|q, _, k| if k == 1 { -q[k] } else { q[k] })),
        ("rate/elbow has the wrong sign", |row| {
            row.qd = PerDrive::from_fn(row.qd.len(), |k| if k == 1 { -row.qd[k] } else { row.qd[k] });
        }),
        ("angle/shoulder and angle/elbow are exchanged", |row| row.each(|q, _, k| q[[1, 0, 2][k]])),
        ("the angles are in degrees", |row| row.each(|q, _, k| DEGREES * q[k])),
        ("rate/shoulder, rate/elbow and rate/wrist are in degrees", |row| row.qd = row.qd.scaled(DEGREES)),
        ("attitude/base and attitude_rate/base count the other way", |row| {
            (row.turn, row.rate) = (-row.turn, -row.rate);
        }),
        ("attitude_rate/base has the wrong sign", |row| row.rate = -row.rate),
        ("attitude_rate/base is in degrees per second", |row| row.rate *= DEGREES),
        ("angle/elbow has the wrong sign", |row| {
            row.q = PerDrive::from_fn(row.q.len(), |k| if k == 1 { -row.q[k] } else { row.q[k] });
        }),
        ("the angles of the drives are measured relative to the base, their rates are not", |row| {
            row.q = PerDrive::from_fn(row.q.len(), |k| row.q[k] - row.turn);
        }),
        ("angle/shoulder, angle/elbow and angle/wrist are in degrees, their rates are not", |row| {
            row.q = row.q.scaled(DEGREES);
        }),
        ("attitude/base has the wrong sign", |row| row.turn = -row.turn),
        ("rate/shoulder and rate/elbow are exchanged, their angles are not", |row| {
            row.qd = PerDrive::from_fn(row.qd.len(), |k| row.qd[[1, 0, 2][k]]);
        }),
        ("attitude/base and the angles of the drives count from different zeros", |row| row.turn += 0.7),
        ("angle/elbow and angle/wrist count from another zero", |row| {
            row.q = PerDrive::from_fn(row.q.len(), |k| row.q[k] - if k > 0 { 0.6 } else { 0.0 });
        }),
        ("the angles count from other zeros than those of the machine's file", |row| {
            row.q = PerDrive::from_fn(row.q.len(), |k| row.q[k] - [0.5, -1.3, 0.9][k]);
        }),
        ("wheel/rate is relative to the base", |row| row.wheel -= row.rate),
        ("wheel/rate has the wrong sign", |row| row.wheel = -row.wheel),
        ("wheel/rate is in turns per minute", |row| row.wheel *= 60.0 / TAU),
    ];
    let file = builtin("spot").expect("built in");
    let built = file.set_all([("link.2.com", "0.20"), ("link.1.com_normal", "0.002")]).expect("valid");
    let mut noise = Noise::of(9);
    // The wheel turns less than the arm moves the base, so that the base turns, too.
    let more = "[base.wheel]\ninertia = 0.01\ntorque_limit = 0.002";
    let flights = [0.0, 2.0].map(|turn| flown(&built, RHO, more, turn));
    let mut measured = |size: f64| {
        let mut motions = flights.to_vec();
        for motion in &mut motions {
            for i in 0..motion.rows() {
                motion.base_rate[i] += size * (0..12).map(|_| noise.between(-0.5, 0.5)).sum::<f64>();
            }
        }
        motions
    };
    for size in [0.0, 1e-4, 1e-2] {
        let got = doubted(file, base(RHO, 0.01), measured(size));
        assert_eq!(got.map(|doubt| doubt.to_string()), None, "{size} rad/s");
    }
    for (what, spoil) in mistakes {
        for size in [0.0, 1e-5] {
            let motions = measured(size).iter().map(|motion| spoilt(motion, spoil)).collect();
            let doubt =
                doubted(file, base(RHO, 0.01), motions).unwrap_or_else(|| panic!("{what} is believed at {size}"));
            assert!(doubt.causes.first().is_some_and(|cause| cause.what.starts_with(what)), "{what}: {doubt}");
            assert!(doubt.to_string().contains("want "), "{doubt}");
        }
    }
}

/// Angles that count from elsewhere: what is to be added is named as printed, and with it the machine is found again.
#[test]
fn zeros_of_angles_are_found() {
    let file = builtin("spot").expect("built in");
    let built = file.set("link.2.com", "0.205").expect("valid");
    let flown = flown(&built, RHO, "", 1.0);
    for zeros in [[0.4, 0.4, 0.4], [0.0, 1.2, 1.2], [-2.9, 0.8, 2.0], [0.9, 0.0, 0.0]] {
        let shifted = |motion: &OrbitMotion, by: &dyn Fn(usize) -> f64| {
            let angles = motion.angles.iter().map(|q| PerDrive::from_fn(q.len(), |k| q[k] + by(k))).collect();
            OrbitMotion { angles, ..motion.clone() }
        };
        let zeroed = shifted(&flown, &|k| -zeros[k]);
        let cause = doubted(file, base(RHO, 0.0), vec![zeroed.clone()]).expect("other zeros").causes.swap_remove(0);
        // "0.4000 rad added to each of angle/shoulder, …", or "… 1.2000 rad to angle/shoulder, … added".
        let said: Vec<f64> =
            cause.want.split_whitespace().filter_map(|word| word.replace('−', "-").parse().ok()).collect();
        // One number for the base, the other for each drive; or one for some drives; or one for each.
        let told = |k: usize| match said[..] {
            [_, each] => each,
            [each] => {
                if zeros[k] == 0.0 {
                    0.0
                } else {
                    each
                }
            }
            _ => said[k],
        };
        assert!((0..3).all(|k| (told(k) - zeros[k]).abs() < 0.02), "{zeros:?}: {}", cause.want);
        let report = orbit_trim(file, &base(RHO, 0.0), &[shifted(&zeroed, &told)]).expect("a fit");
        assert_eq!(doubted(file, base(RHO, 0.0), vec![shifted(&zeroed, &told)]), None, "{}", cause.want);
        let com = report.numbers.iter().find(|number| number.name == "g elbow along").expect("a number");
        let truth = Unknowns::of(3).nominal(&Inertia::of(&built))[2];
        assert!((com.measured.expect("told") - truth).abs() < 0.03 * truth, "{com:?} {truth}");
    }
}

/// A small offset is too little to refuse a measurement, but the report names it. Of a machine that is off in one centre of
/// mass, no zero makes several numbers agree.
#[test]
fn a_small_offset_is_named_in_the_report() {
    let file = builtin("spot").expect("built in");
    let built = file.set("link.2.com", "0.205").expect("valid");
    let hertz = [0.3, 0.46, 0.62];
    let mut motion = swing(&built, &|k, t| (TAU * hertz[k] * t + 0.7 * k as f64).sin());
    let mut noise = Noise::of(5);
    for rate in &mut motion.base_rate {
        *rate += 1e-3 * (0..12).map(|_| noise.between(-0.5, 0.5)).sum::<f64>();
    }
    let report = |motion: OrbitMotion| {
        assert_eq!(doubted(file, base(RHO, 0.0), vec![motion.clone()]), None);
        orbit_trim(file, &base(RHO, 0.0), &[motion]).expect("a fit")
    };
    assert_eq!(report(motion.clone()).zero, None);
    let shifted = spoilt(&motion, |row| row.turn += 0.2);
    let zero = report(shifted).zero.expect("an offset");
    assert!(zero.what.starts_with("attitude/base and the angles") && zero.off_then < zero.off_given, "{zero:?}");
    assert!(zero.want.starts_with("−0.20") || zero.want.starts_with("−0.19"), "{zero:?}");
}

/// A gyroscope that is late, with and without the angle that is integrated from it, and drives that were built with it.
#[test]
fn delays_are_found() {
    let file = builtin("spot").expect("built in");
    let built = file.set("link.2.com", "0.22").expect("valid");
    let whole = flown(&built, RHO, "", 0.0);
    let late = |attitude: bool, within: bool| {
        let mut motion = whole.clone();
        for i in 1..motion.rows() {
            let rate = whole.base_rate[i - 1];
            let turn = if attitude { whole.attitude[i - 1] } else { whole.attitude[i] };
            if !within {
                let raised = |of: &PerDrive, by: f64| PerDrive::from_fn(of.len(), |k| of[k] + by);
                motion.angles[i] = raised(&whole.angles[i], whole.attitude[i] - turn);
                motion.rates[i] = raised(&whole.rates[i], whole.base_rate[i] - rate);
            }
            (motion.attitude[i], motion.base_rate[i]) = (turn, rate);
        }
        motion
    };
    for (attitude, within, what) in [
        (false, false, "attitude_rate/base comes 0.0200 s late"),
        (true, false, "attitude/base and attitude_rate/base come 0.0200 s late"),
        (true, true, "attitude/base and attitude_rate/base come 0.0200 s late, also within absolute angles and rates"),
    ] {
        let doubt = doubted(file, base(RHO, 0.0), vec![late(attitude, within)]).expect("it is late");
        let first = &doubt.causes[0];
        assert!(first.what.starts_with(what), "{what}: {doubt}");
        assert!(first.want.contains("moved by 0.0200 s to earlier times"), "{doubt}");
    }
}

/// A sensor that says the same number in each row is named, and a base that is held.
#[test]
fn dead_signals_are_named() {
    let file = builtin("spot").expect("built in");
    let motion = flown(file, RHO, "", 0.0);
    let refused = |motion: OrbitMotion| {
        let request = OrbitTrimRequest {
            machine: Shared(file.clone().into()),
            base: base(RHO, 0.0),
            motions: Shared(vec![motion].into()),
            as_given: false,
        };
        match answer_now::<OrbitTrimQuery>(request).outcome {
            Err(NoTrim::Unusable(why)) => why,
            other => panic!("{other:?}"),
        }
    };
    let why = refused(spoilt(&motion, |row| row.rate = 0.0));
    assert!(matches!(&why, TrimError::DeadSignal { path, .. } if path == "attitude_rate/base"), "{why}");
    let why = refused(spoilt(&motion, |row| row.qd = PerDrive::from_fn(3, |k| if k == 1 { 0.0 } else { row.qd[k] })));
    assert!(matches!(&why, TrimError::DeadSignal { path, .. } if path == "rate/elbow"), "{why}");
    let why = refused(spoilt(&motion, |row| row.turn = 0.0));
    assert!(matches!(&why, TrimError::DeadAngle { angle, .. } if angle == "attitude/base"), "{why}");
    let why = refused(spoilt(&motion, |row| (row.turn, row.rate) = (0.0, 0.0)));
    assert!(matches!(why, TrimError::StillBase { by_file, .. } if by_file > 0.01), "{why}");
}

/// Rates that no usual mistake explains, but that are not those of their angles; and rates that no machine explains.
#[test]
fn what_contradicts_itself_is_refused() {
    let file = builtin("spot").expect("built in");
    let mut motion = flown(file, RHO, "", 0.0);
    let mut noise = Noise::of(8);
    motion.base_rate.iter_mut().for_each(|rate| *rate += 1e-3 * noise.between(-1.0, 1.0));
    let outcome = |motion: OrbitMotion, as_given: bool| {
        let motions = Shared(vec![motion].into());
        let machine = Shared(file.clone().into());
        answer_now::<OrbitTrimQuery>(OrbitTrimRequest { machine, base: base(RHO, 0.0), motions, as_given }).outcome
    };
    let refused = |motion: &OrbitMotion| match outcome(motion.clone(), false) {
        Err(why) => why.to_string(),
        Ok(report) => panic!("{report:?}"),
    };
    let why = refused(&OrbitMotion { t: motion.t.iter().map(|t| 1e3 * t).collect(), ..motion.clone() });
    assert!(why.contains("every rate is 1000") && why.contains("not in ms"), "{why}");
    // The same factor in all rates of the drives and in that of the base; then in that of one drive.
    let why =
        refused(&spoilt(&motion, |row| row.qd = PerDrive::from_fn(3, |k| if k == 1 { 1.1 } else { 1.0 } * row.qd[k])));
    assert!(why.contains("rate/elbow is not the rate of angle/elbow: it is 1.1"), "{why}");
    // A thruster fires.
    let mut pushed = motion.clone();
    for i in 0..pushed.rows() {
        let (t, turn) = (pushed.t[i], 2e-3 * pushed.t[i]);
        pushed.base_rate[i] += turn;
        pushed.rates[i] = PerDrive::from_fn(3, |k| pushed.rates[i][k] - turn);
        pushed.attitude[i] += 1e-3 * t * t;
        pushed.angles[i] = PerDrive::from_fn(3, |k| pushed.angles[i][k] - 1e-3 * t * t);
    }
    let why = refused(&pushed);
    assert!(why.contains("no machine explains") && why.contains("thrusters off"), "{why}");
    assert!(outcome(pushed, true).is_ok() && outcome(motion.clone(), false).is_ok());
    // Rows that are missing are no contradiction.
    let mut gap = motion;
    for list in [&mut gap.t, &mut gap.attitude, &mut gap.base_rate, &mut gap.wheel_rate] {
        list.drain(150..230);
    }
    gap.angles.drain(150..230);
    gap.rates.drain(150..230);
    assert!(outcome(gap, false).is_ok());
}

/// Encoders that are set to zero at the start of each of three motions, and relative ones with zeros of their own.
#[test]
fn zeros_of_each_motion_are_found() {
    let file = builtin("spot").expect("built in");
    let built = file.set("link.2.com", "0.205").expect("valid");
    let whole = [0.0, 2.0, 4.0].map(|turn| flown(&built, RHO, "", turn));
    let zeros = [[1.6, 2.3, 3.0], [1.2, 2.6, 0.4], [-0.5, 0.9, 2.0]];
    let mut zeroed = whole.clone();
    for (motion, zeros) in zeroed.iter_mut().zip(zeros) {
        motion.angles.iter_mut().for_each(|q| *q = PerDrive::from_fn(3, |k| q[k] - zeros[k]));
    }
    let doubt = doubted(file, base(RHO, 0.0), zeroed.to_vec()).expect("zeros");
    let first = &doubt.causes[0];
    assert!(first.what.starts_with("each motion counts its angles from zeros of its own"), "{doubt}");
    let said: Vec<f64> = first.want.split_whitespace().filter_map(|word| word.replace('−', "-").parse().ok()).collect();
    let turned = |by: f64| (by + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
    let near = |(said, want): (&f64, &f64)| turned(said - want).abs() < 0.03;
    assert!(said.len() == 9 && said.iter().zip(zeros.as_flattened()).all(near), "{said:?}");
    let encoders = whole.map(|motion| {
        spoilt(&motion, |row| {
            row.each(|q, turn, k| q[k] - if k == 0 { turn } else { q[k - 1] });
            row.q = PerDrive::from_fn(3, |k| row.q[k] - [1.9, 0.7, 0.8][k]);
        })
    });
    let doubt = doubted(file, base(RHO, 0.0), encoders.to_vec()).expect("encoders");
    let what = &doubt.causes[0].what;
    assert!(what.starts_with("angle/shoulder relative to the base") && what.contains("other zeros"), "{doubt}");
}

/// What the guide says: ten seconds in which every joint swings at its own frequency tell all, with noise of 0.001 rad/s. The
/// motion that is proposed next makes the least known number better known, about as much as is said.
#[test]
fn swings_of_all_joints_tell_all_numbers() {
    let file = builtin("spot").expect("built in");
    let built = file.set("link.2.com", "0.22").expect("valid");
    let mut noise = Noise::of(4);
    let mut swung = |amplitude: &dyn Fn(usize, f64) -> f64| {
        let mut motion = swing(&built, amplitude);
        let chance = |noise: &mut Noise| (0..12).map(|_| noise.between(-0.5, 0.5)).sum::<f64>();
        motion.base_rate.iter_mut().for_each(|rate| *rate += 1e-3 * chance(&mut noise));
        motion
    };
    let hertz = [0.3, 0.46, 0.62];
    let first = swung(&|k, t| (TAU * hertz[k] * t + 0.7 * k as f64).sin());
    let report = orbit_trim(file, &base(RHO, 0.0), std::slice::from_ref(&first)).expect("a fit");
    assert!(report.numbers.iter().all(|number| number.identifiable), "{:?}", report.unidentifiable);
    let off: Vec<&str> = report.numbers.iter().filter(|number| number.off).map(|n| n.name.as_str()).collect();
    assert!(off.contains(&"g elbow along") && off.contains(&"D elbow"), "{off:?}");
    let (next, best) = (&report.next, &report.next.candidates[0]);
    // The best motion: absolute angles, each a sine of its amplitude and frequency.
    let of = |k: usize, t: f64| {
        let place = best.candidate.drives.iter().position(|(drive, _)| *drive == k);
        place.map_or(0.0, |i| {
            let (sign, per) = (best.candidate.drives[i].1, best.candidate.frequency[i]);
            sign * best.candidate.amplitude[i] * (TAU * per * t).sin()
        })
    };
    let joints = |k: usize, t: f64| of(k, t) - if k == 0 { 0.0 } else { of(k - 1, t) };
    let both = [first, swung(&joints)];
    let then = orbit_trim(file, &base(RHO, 0.0), &both).expect("a fit");
    let half = |report: &OrbitReport| {
        let number = report.numbers.iter().find(|number| number.name == next.worst).expect("a number");
        number.half_width.expect("told")
    };
    let [said, got] = [best.candidate.half_width, half(&then)].map(|now| now / half(&report));
    assert!(got < 0.6 && (0.3..3.0).contains(&(got / said)), "{}: {said} was said, {got} came", best.motion);
}

/// One spoilt motion among three is found alone, and named by its number.
#[test]
fn one_spoilt_motion_among_others_is_named() {
    let file = builtin("spot").expect("built in");
    let built = file.set("link.2.com", "0.22").expect("valid");
    let mut motions = vec![flown(&built, RHO, "", 0.0), flown(&built, RHO, "", 2.0), flown(&built, RHO, "", 4.0)];
    assert_eq!(doubted(file, base(RHO, 0.0), motions.clone()), None);
    motions[1] = spoilt(&motions[1], |row| row.rate = -row.rate);
    let doubt = doubted(file, base(RHO, 0.0), motions).expect("it is spoilt");
    let words = doubt.to_string();
    assert!(words.starts_with("motion 2: attitude_rate/base has the wrong sign"), "{words}");
}

/// Degrees and turns per minute that a header names are understood.
#[test]
fn units_of_the_header_are_understood() {
    let file = builtin("spot").expect("built in");
    let motion = flown(file, RHO, "[base.wheel]\ninertia = 0.01", 0.0);
    let mut table = SignalTable { time: motion.t.clone(), columns: Vec::new() };
    let mut add = |path: String, unit: &str, factor: f64, values: Vec<f64>| {
        let values = values.iter().map(|x| factor * x).collect();
        table.columns.push(SignalColumn { path, unit: unit.into(), values });
    };
    let degrees = 180.0 / std::f64::consts::PI;
    for (k, drive) in file.spec().drives.iter().enumerate() {
        let sums = |of: &[PerDrive], base: &[f64]| of.iter().zip(base).map(|(x, base)| x[k] + base).collect();
        add(format!("angle/{}", drive.name), "deg", degrees, sums(&motion.angles, &motion.attitude));
        add(format!("rate/{}", drive.name), "deg/s", degrees, sums(&motion.rates, &motion.base_rate));
    }
    add("attitude/base".into(), "°", degrees, motion.attitude.clone());
    add("attitude_rate/base".into(), "", 1.0, motion.base_rate.clone());
    add("wheel/rate".into(), "rpm", 60.0 / TAU, motion.wheel_rate.clone());
    let read = OrbitMotion::of(file, &table).expect("units");
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12 * (1.0 + b.abs()));
    assert!(near(&read.attitude, &motion.attitude) && near(&read.wheel_rate, &motion.wheel_rate));
    for (read, own) in read.angles.iter().chain(&read.rates).zip(motion.angles.iter().chain(&motion.rates)) {
        assert!((0..3).all(|k| (read[k] - own[k]).abs() < 1e-12), "{read:?} {own:?}");
    }
    table.columns[0].unit = "turns".into();
    let why = OrbitMotion::of(file, &table).expect_err("no unit of angles").to_string();
    assert!(why.contains("angle/shoulder") && why.contains("want rad"), "{why}");
}
