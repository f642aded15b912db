//! Measurements with a wrong sign, order, frame or unit are refused with the cause named; honest ones are not.
//!
//! The sensor is the nine-body twin: Newton and Euler on nine bars, which knows nothing of first moments and couplings.

use std::f64::consts::PI;

use stillbase::mechanics::dynamics::{ExternalLoads, base_wrench};
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::study::trim::{Doubt, MeasuredMotion, MeasurementSet, doubt};

use crate::mechanics::nine_body::NineBody;
use crate::support::random::a_machine;
use crate::support::{Noise, body_of};

fn normal(noise: &mut Noise) -> f64 {
    let (u, v) = (noise.between(1e-12, 1.0), noise.between(0.0, std::f64::consts::TAU));
    (-2.0 * u.ln()).sqrt() * v.cos()
}

/// How a machine is measured.
#[derive(Clone, Copy)]
struct Measuring {
    motions: usize,
    rows: usize,
    /// σ of angles, rad, of force, N, and of moment, N m.
    sigma: [f64; 3],
    /// Correlation of force and moment from row to row.
    slow: f64,
    /// Whether rates and accelerations are given, too.
    rates: bool,
    /// How far off centres of mass are, m; masses by five times that as a share.
    off: f64,
}

const USUAL: Measuring =
    Measuring { motions: 2, rows: 500, sigma: [2e-5, 0.2, 0.02], slow: 0.0, rates: false, off: 0.01 };

/// Soon looked at.
const QUICK: Measuring = Measuring { rows: 100, sigma: [0.0, 0.1, 0.01], rates: true, ..USUAL };

/// What was built of a machine: every link is off, along its axis only, as the twin is.
fn built(machine: &Machine, noise: &mut Noise, off: f64) -> NineBody {
    let mut body = body_of(machine);
    body.com.iter_mut().for_each(|com| *com += off * noise.between(-1.0, 1.0));
    body.mass.iter_mut().for_each(|mass| *mass *= 1.0 + 5.0 * off * noise.between(-1.0, 1.0));
    body.inertia.iter_mut().for_each(|inertia| *inertia *= 1.0 + 5.0 * off * noise.between(-1.0, 1.0));
    body
}

/// Motions within the joint limits [0, π] of both relative angles, two sines each.
fn recorded(body: &NineBody, noise: &mut Noise, how: Measuring) -> MeasurementSet {
    let mut motions = Vec::new();
    for _ in 0..how.motions {
        let mut wave = |size: f64| [size * noise.between(0.3, 1.0), noise.between(3.0, 7.0), noise.between(0.0, 6.0)];
        // Of q₁, a₁, a₂.
        let waves = [[wave(0.5), wave(0.2)], [wave(0.4), wave(0.15)], [wave(0.4), wave(0.15)]];
        let middle = [noise.between(-3.0, 3.0), noise.between(0.8, 2.3), noise.between(0.8, 2.3)];
        let offset = [(); 3].map(|()| noise.between(-5.0, 5.0));
        let mut error = [0.0; 3].map(|_: f64| normal(noise));
        let mut motion = MeasuredMotion::default();
        for i in 0..how.rows {
            let t = 2.0 / how.rows as f64 * i as f64;
            let own = |k: usize| {
                waves[k].iter().fold([middle[k], 0.0, 0.0], |[x, v, a], [size, w, phase]| {
                    let (sin, cos) = (w * t + phase).sin_cos();
                    [x + size * sin, v + size * w * cos, a - size * w * w * sin]
                })
            };
            let [first, second, third] = [0, 1, 2].map(own);
            let absolute = |d: usize| {
                let turn = if d == 0 { std::f64::consts::PI } else { 0.0 };
                let q2 = first[d] + second[d];
                [first[d], q2, q2 + third[d] - turn]
            };
            let [q, qd, qdd] = [0, 1, 2].map(absolute);
            let (_, wrench) = body.recursive(q, qd, qdd);
            let fresh = (1.0 - how.slow * how.slow).sqrt();
            error.iter_mut().for_each(|e| *e = how.slow * *e + fresh * normal(noise));
            motion.t.push(t);
            motion.q.push(PerDrive::from(q.map(|q| q + how.sigma[0] * normal(noise))));
            if how.rates {
                motion.qd.push(PerDrive::from(qd));
                motion.qdd.push(PerDrive::from(qdd));
            }
            let read = |i: usize, sigma: f64| wrench[i] + offset[i] + sigma * error[i];
            motion.force.push(Vector::new(read(0, how.sigma[1]), read(1, how.sigma[1])));
            motion.moment.push(read(2, how.sigma[2]));
        }
        motions.push(motion);
    }
    MeasurementSet { motions }
}

type Spoil = fn(&mut MeasuredMotion);

fn each_angle(motion: &mut MeasuredMotion, change: impl Fn(&PerDrive) -> PerDrive) {
    let MeasuredMotion { q, qd, qdd, .. } = motion;
    q.iter_mut().chain(qd).chain(qdd).for_each(|x| *x = change(x));
}

fn each_force(motion: &mut MeasuredMotion, change: impl Fn(Vector) -> Vector) {
    motion.force.iter_mut().for_each(|f| *f = change(*f));
}

fn each_moment(motion: &mut MeasuredMotion, by: f64) {
    motion.moment.iter_mut().for_each(|n| *n *= by);
}

/// Faults, and words of the cause that has to be named.
const FAULTS: &[(&str, Spoil)] = &[
    ("nz has the wrong sign", |m| each_moment(m, -1.0)),
    ("fx has the wrong sign", |m| each_force(m, |f| -f.conj())),
    ("fy has the wrong sign", |m| each_force(m, |f| f.conj())),
    ("fx and fy are exchanged", |m| each_force(m, |f| Vector::new(f.im, f.re))),
    ("a sensor that reads the force of the base on the machine", |m| {
        each_force(m, |f| -f);
        each_moment(m, -1.0);
    }),
    ("q2 and q3 are exchanged", |m| each_angle(m, |q| PerDrive::from([q[0], q[2], q[1]]))),
    ("q1 and q2 are exchanged", |m| each_angle(m, |q| PerDrive::from([q[1], q[0], q[2]]))),
    ("q1 and q3 are exchanged", |m| each_angle(m, |q| PerDrive::from([q[2], q[1], q[0]]))),
    ("relative angles", |m| each_angle(m, |q| PerDrive::from([q[0], q[1] - q[0], q[2] - q[1]]))),
    ("q2 counts the other way", |m| each_angle(m, |q| PerDrive::from([q[0], -q[1], q[2]]))),
    ("nz is in N mm", |m| each_moment(m, 1e3)),
    ("the angles are in radians, not in degrees", |m| each_angle(m, |q| q.scaled(1.0_f64.to_radians()))),
    ("the angles are in degrees, not in radians", |m| each_angle(m, |q| q.scaled(1.0_f64.to_degrees()))),
];

fn spoilt(recording: &MeasurementSet, spoil: Spoil) -> MeasurementSet {
    let mut recording = recording.clone();
    recording.motions.iter_mut().for_each(spoil);
    recording
}

fn asked(machine: &Machine, recording: &MeasurementSet) -> Option<Doubt> {
    doubt(machine, recording, false).expect("a recording")
}

/// Noise, drift and offset of the sensor, and whatever was built off: none of it is a fault.
#[test]
fn honest_measurements_are_believed() {
    let machine = builtin("nine-link").expect("built in");
    let mut noise = Noise::of(31);
    for off in [0.0, 0.01, 0.03] {
        for how in [QUICK, Measuring { slow: 0.7, ..QUICK }, Measuring { motions: 1, rows: 200, ..USUAL }] {
            let body = built(machine, &mut noise, off);
            let mut recording = recorded(&body, &mut noise, how);
            for motion in &mut recording.motions {
                let [x, y, n] = [(); 3].map(|()| noise.between(-0.5, 0.5));
                let MeasuredMotion { t, force, moment, .. } = motion;
                force.iter_mut().zip(&*t).for_each(|(f, t)| *f += Vector::new(x, y) * *t);
                moment.iter_mut().zip(&*t).for_each(|(m, t)| *m += 0.1 * n * t);
            }
            assert_eq!(asked(machine, &recording), None, "off by {off}, slow {}", how.slow);
        }
    }
}

/// Every fault is refused, its cause is among those named, and without it the same measurement is believed.
#[test]
fn every_fault_is_refused_by_its_name() {
    let machine = builtin("nine-link").expect("built in");
    let mut noise = Noise::of(32);
    for (name, spoil) in FAULTS {
        let body = built(machine, &mut noise, USUAL.off);
        let recording = recorded(&body, &mut noise, QUICK);
        let doubt = asked(machine, &spoilt(&recording, *spoil)).unwrap_or_else(|| panic!("{name} was believed"));
        assert!(doubt.to_string().contains(name), "{name}: {doubt}");
        assert!(doubt.causes[0].odds > 4.0, "{name}: {doubt}");
        // The number that is furthest off is told twice where the fault changes it by much.
        if name.contains("N mm") {
            assert!(doubt.to_string().contains("Without the fault, D "), "{name}: {doubt}");
        }
    }
}

/// Of a long recording a part is enough, and it is one in which everything moves.
#[test]
fn a_fault_in_a_long_recording_is_found() {
    let machine = builtin("nine-link").expect("built in");
    let mut noise = Noise::of(36);
    let body = built(machine, &mut noise, USUAL.off);
    let recording = recorded(&body, &mut noise, Measuring { rows: 9_000, ..QUICK });
    assert_eq!(asked(machine, &recording), None);
    let doubt = asked(machine, &spoilt(&recording, |m| each_moment(m, -1.0))).expect("refused");
    assert!(doubt.causes.iter().any(|cause| cause.what.starts_with("nz has the wrong sign")), "{doubt}");
}

/// Forces that are far too large belong to no machine of that mass: then first moments are named, and no momentum.
#[test]
fn what_is_impossible_is_named_by_what_makes_it_so() {
    let machine = builtin("nine-link").expect("built in");
    let mut noise = Noise::of(37);
    let body = built(machine, &mut noise, 0.04);
    let recording = recorded(&body, &mut noise, QUICK);
    let doubt = asked(machine, &spoilt(&recording, |m| each_force(m, |f| f * 300.0))).expect("refused");
    assert!(doubt.impossible.first().is_some_and(|said| said.name.starts_with('g')), "{doubt:?}");
}

/// Relative angles as the machine's file has them, whichever drive it counts them from and with whatever offsets.
#[test]
fn relative_angles_of_the_file_are_known() {
    let machine = builtin("nine-link-bare").expect("built in");
    let mut noise = Noise::of(35);
    const FIRST: f64 = 0.4;
    const SECOND: f64 = 0.7;
    let mut spec = machine.spec().clone();
    // a1 = q2 − q1 + 0.4, from 0.4 on, and a2 = q2 − q3 + 0.7, which is π + 0.7 less the usual one.
    (spec.angles[0].offset, spec.angles[0].min, spec.angles[0].max) = (FIRST, Some(FIRST), Some(FIRST + PI));
    let angle = &mut spec.angles[1];
    std::mem::swap(&mut angle.to, &mut angle.from);
    (angle.offset, angle.min, angle.max) = (SECOND, Some(SECOND), Some(SECOND + PI));
    let other = Machine::new(spec).expect("a machine");
    let body = built(machine, &mut noise, USUAL.off);
    let recording = recorded(&body, &mut noise, QUICK);
    assert_eq!(asked(&other, &recording), None);
    let relative: Spoil = |motion| {
        motion.q.iter_mut().for_each(|q| *q = PerDrive::from([q[0], q[1] - q[0] + FIRST, q[1] - q[2] + SECOND]));
        let both = motion.qd.iter_mut().chain(&mut motion.qdd);
        both.for_each(|q| *q = PerDrive::from([q[0], q[1] - q[0], q[1] - q[2]]));
    };
    let doubt = asked(&other, &spoilt(&recording, relative)).expect("refused");
    assert!(doubt.causes[0].what.contains("hold the relative angles a1 and a2 of the machine's file"), "{doubt}");
    // What is said to explain it explains all but the noise that there is.
    let [force, moment] = [0, 1].map(|of| doubt.causes[0].residuals[of].noise);
    assert!(force < 1.3 * QUICK.sigma[1] && moment < 1.3 * QUICK.sigma[2], "{doubt:?}");
}

/// How often each fault is refused, named first and named at all; how often honest measurements are.
#[test]
#[ignore = "a campaign of thousands of recordings, a minute optimised"]
fn campaign_of_faults() {
    let machine = builtin("nine-link").expect("built in");
    let count: u64 = std::env::var("COUNT").ok().and_then(|n| n.parse().ok()).unwrap_or(300);
    let kinds = [
        ("usual", USUAL),
        ("exact", Measuring { sigma: [0.0; 3], rates: true, rows: 150, ..USUAL }),
        ("balanced", Measuring { off: 0.0, ..USUAL }),
        ("nearly", Measuring { off: 0.002, ..USUAL }),
        ("far off", Measuring { off: 0.04, ..USUAL }),
        ("slow", Measuring { slow: 0.9, off: 0.01, ..USUAL }),
        ("noisy", Measuring { sigma: [1e-4, 1.0, 0.1], ..USUAL }),
    ];
    for (kind, how) in kinds {
        let mut wrong = 0;
        let mut found = vec![[0; 3]; FAULTS.len()];
        for seed in 0..count {
            let mut noise = Noise::of(seed + 10_000);
            let body = built(machine, &mut noise, how.off);
            let recording = recorded(&body, &mut noise, how);
            if let Some(doubt) = asked(machine, &recording) {
                wrong += 1;
                println!("honest {kind} {seed}: {doubt}");
            }
            for ((name, spoil), found) in FAULTS.iter().zip(&mut found) {
                if let Some(doubt) = asked(machine, &spoilt(&recording, *spoil)) {
                    found[0] += 1;
                    found[1] += usize::from(doubt.causes.first().is_some_and(|cause| cause.what.contains(name)));
                    let named = doubt.causes.iter().any(|cause| cause.what.contains(name));
                    found[2] += usize::from(named);
                    if !named && found[0] - found[2] < 2 {
                        println!("{kind} {seed} {name}: {doubt}");
                    }
                }
            }
        }
        println!("{kind}: {wrong} honest of {count} refused");
        assert!(100 * wrong <= count, "{kind}: {wrong} of {count} honest measurements are refused");
        for ((name, _), [refused, first, named]) in FAULTS.iter().zip(found) {
            println!("  {name:48} refused {refused:4}  first {first:4}  named {named:4}");
            // The worst of all rows of a hundred: 57 named of 100 refused; 70 refused of 100.
            assert!(2 * named >= refused, "{kind}, {name}: {named} named of {refused} refused");
            // The force of a balanced machine is zero, whatever the sign of its sensor.
            assert!(
                kind == "balanced" || 5 * refused as u64 >= 3 * count,
                "{kind}, {name}: {refused} refused of {count}"
            );
        }
    }
}

/// Any machine of up to four drives, with rotors of either sense and gravity.
fn any_recording(noise: &mut Noise, rows: u32) -> (Machine, MeasurementSet) {
    let machine = std::iter::repeat_with(|| a_machine(noise)).find(|machine| machine.drives() <= 4).expect("endless");
    let off = [0.0, 0.003, 0.01, 0.05][(noise.between(0.0, 4.0) as usize).min(3)];
    let recording = a_recording(&machine, off, noise, rows);
    (machine, recording)
}

/// Motions of a machine whose links are built off by up to `off` m along them, half of it across, and that share of mass.
fn a_recording(machine: &Machine, off: f64, noise: &mut Noise, rows: u32) -> MeasurementSet {
    let n = machine.drives();
    let mut spec = machine.spec().clone();
    for link in &mut spec.links {
        link.com += off * noise.between(-1.0, 1.0);
        link.com_normal += 0.5 * off * noise.between(-1.0, 1.0);
        link.mass *= 1.0 + off * noise.between(-1.0, 1.0);
    }
    let inertia = Inertia::of(&Machine::new(spec).expect("a machine"));
    let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
    let (sigma, rates) = (10.0_f64.powf(noise.between(-3.0, 0.0)), noise.between(0.0, 1.0) < 0.5);
    let slow = noise.between(0.0, 0.9);
    let fresh = (1.0 - slow * slow).sqrt();
    let mut motions = Vec::new();
    for _ in 0..2 {
        let wave = |noise: &mut Noise| [noise.between(0.1, 0.6), noise.between(2.0, 8.0), noise.between(0.0, 6.0)];
        let waves: Vec<[[f64; 3]; 2]> = (0..n).map(|_| [wave(noise), wave(noise)]).collect();
        let middle = PerDrive::from_fn(n, |_| noise.between(-3.0, 3.0));
        let mut motion = MeasuredMotion::default();
        let mut error = [0.0; 3].map(|_: f64| normal(noise));
        for i in 0..rows {
            let t = 2.0 / f64::from(rows) * f64::from(i);
            let sum = |f: &dyn Fn(f64, f64, f64) -> f64| {
                PerDrive::from_fn(n, |k| waves[k].iter().map(|[a, w, p]| f(*a, *w, w * t + p)).sum())
            };
            let q = sum(&|a, _, p| a * p.sin()).plus(1.0, &middle);
            let (qd, qdd) = (sum(&|a, w, p| a * w * p.cos()), sum(&|a, w, p| -a * w * w * p.sin()));
            let wrench = base_wrench(&inertia, &DriveAngles(q).units(), &qd, &qdd, &around).total();
            error.iter_mut().for_each(|e| *e = slow * *e + fresh * normal(noise));
            motion.t.push(t);
            motion.q.push(PerDrive::from_fn(n, |k| q[k] + 1e-5 * normal(noise)));
            if rates {
                motion.qd.push(qd);
                motion.qdd.push(qdd);
            }
            motion.force.push(wrench.force + Vector::new(error[0], error[1]) * sigma);
            motion.moment.push(wrench.moment + 0.2 * sigma * error[2]);
        }
        motions.push(motion);
    }
    MeasurementSet { motions }
}

/// Of any machine honest measurements are believed, and none whose moment is reversed where D is known.
#[test]
fn honest_measurements_of_any_machine_are_believed() {
    let mut noise = Noise::of(33);
    for i in 0..3 {
        let (machine, recording) = any_recording(&mut noise, 150);
        assert_eq!(asked(&machine, &recording), None, "{i}: {} drives", machine.drives());
    }
}

/// A link that is far off leaves a first moment that the file does not have; that is no fault of the force sensor.
#[test]
fn honest_measurements_of_links_that_are_far_off_are_believed() {
    let mut noise = Noise::of(41);
    let mut refused = Vec::new();
    for name in ["nine-link", "two-drive", "serial-3r", "four-drive", "nine-link-geared", "scara", "space-arm"] {
        // The motions keep no limits.
        let mut free = builtin(name).expect("built in").spec().clone();
        free.angles.clear();
        let machine = &Machine::new(free).expect("a machine");
        for (i, link) in machine.spec().links.iter().enumerate().skip(1).take(2) {
            for [along, across] in [[0.0, 0.06], [0.0, 0.15], [-0.1, -0.1]] {
                let mut spec = machine.spec().clone();
                spec.links[i].com += along;
                spec.links[i].com_normal += across;
                let recording = a_recording(&Machine::new(spec).expect("a machine"), 0.0, &mut noise, 100);
                if let Some(doubt) = asked(machine, &recording) {
                    refused.push(format!("{name}, link {} off by {along}, {across} m: {doubt}", link.name));
                }
            }
        }
    }
    assert!(refused.is_empty(), "{} refused:\n{}", refused.len(), refused.join("\n"));
}

/// Faults of the force alone, which no momentum tells.
const OF_FORCE: &[(&str, Spoil)] = &[
    ("fx and fy have the wrong sign", |m| each_force(m, |f| -f)),
    ("turned by 90°", |m| each_force(m, |f| Vector::i() * f)),
    ("fx and fy are in kN, not in N", |m| each_force(m, |f| 1e-3 * f)),
];

/// A machine that is not balanced shows by its first moments which way its force sensor reads.
#[test]
fn faults_of_the_force_of_a_machine_that_is_not_balanced_are_refused() {
    let mut noise = Noise::of(37);
    for name in ["nine-link-bare", "scara", "space-arm"] {
        let machine = builtin(name).expect("built in");
        let recording = a_recording(machine, 0.005, &mut noise, 200);
        assert_eq!(asked(machine, &recording), None, "{name}");
        for (fault, spoil) in OF_FORCE {
            let doubt = asked(machine, &spoilt(&recording, *spoil)).unwrap_or_else(|| panic!("{name}: {fault}"));
            assert!(doubt.to_string().contains(fault), "{name}: {fault} in {doubt}");
        }
    }
}

#[test]
#[ignore = "a campaign of thousands of recordings, a minute optimised"]
fn campaign_of_any_machine() {
    let count: u64 = std::env::var("COUNT").ok().and_then(|n| n.parse().ok()).unwrap_or(300);
    let (mut wrong, mut reversed, mut reading, mut of_force) = (0, 0, 0, [0; OF_FORCE.len()]);
    for seed in 0..count {
        let (machine, recording) = any_recording(&mut Noise::of(50_000 + seed), 400);
        if let Some(doubt) = asked(&machine, &recording) {
            wrong += 1;
            println!("honest {seed}, {} drives: {doubt}", machine.drives());
        }
        reversed += u64::from(asked(&machine, &spoilt(&recording, |m| each_moment(m, -1.0))).is_some());
        let all = spoilt(&recording, |m| {
            each_moment(m, -1.0);
            each_force(m, |f| -f);
        });
        reading += u64::from(asked(&machine, &all).is_some());
        for ((_, spoil), refused) in OF_FORCE.iter().zip(&mut of_force) {
            *refused += u64::from(asked(&machine, &spoilt(&recording, *spoil)).is_some());
        }
    }
    println!(
        "{wrong} honest of {count} refused; nz reversed {reversed}, all reversed {reading}, of force {of_force:?}"
    );
    // Of a hundred, none is refused wrongly, and one at most is missed.
    assert!(100 * wrong <= count, "{wrong} of {count} honest measurements are refused");
    let nearly_all = |refused: u64| 20 * refused >= 19 * count;
    assert!([reversed, reading].into_iter().chain(of_force).all(nearly_all), "faults are missed");
}

/// Masses of the machine's file in g are a thousand times too large: the measurement seems a thousand times too small.
#[test]
fn masses_of_the_file_in_other_units_are_named() {
    let machine = builtin("nine-link").expect("built in");
    let mut noise = Noise::of(77);
    let body = built(machine, &mut noise, USUAL.off);
    let recording = recorded(&body, &mut noise, QUICK);
    for (factor, unit) in [(1e3, "in g"), (1e-3, "in t")] {
        let mut spec = machine.spec().clone();
        for link in &mut spec.links {
            (link.mass, link.inertia) = (factor * link.mass, factor * link.inertia);
        }
        let doubt = asked(&Machine::new(spec).expect("valid"), &recording).expect("refused").to_string();
        assert!(doubt.contains(&format!("masses of the machine's file {unit}")), "{unit}: {doubt}");
    }
}
