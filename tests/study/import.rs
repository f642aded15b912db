//! Motions given by samples: what they do to the base, and what is proposed in their place.

use std::sync::Arc;

use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::planning::curves::{Coordinates, Samples};
use stillbase::query::{Portion, Queries, Query, QueryStatus, Shared, answer_now};
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;
use stillbase::study::advice::Remedy;
use stillbase::study::import::{GivenMotion, ImportQuery, MotionImportError, PreservedPath, Request};

/// From rest to rest over one second, 0 to 1.
fn eased(s: f64) -> f64 {
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}

/// Forty spaces of a motion from one row of values to another.
fn moving(from: &[f64], by: &[f64]) -> Samples {
    let row = |i: i32| {
        let s = f64::from(i) / 40.0;
        let values = from.iter().zip(by).map(|(x, d)| x + d * eased(s));
        std::iter::once(s).chain(values).collect()
    };
    Samples::new(&(0..=40).map(row).collect::<Vec<_>>()).expect("samples")
}

fn names(samples: &Samples) -> Vec<String> {
    (1..=samples.columns()).map(|k| format!("column {k}")).collect()
}

fn request(machine: &Machine, coordinates: Coordinates, samples: Samples) -> Request {
    let base = Scenario::builtin("case-3").expect("built in");
    let scenario = Scenario { name: "mine".into(), title: "A table".into(), machine: machine.clone(), ..base };
    let motion = GivenMotion::new(machine, coordinates, names(&samples), samples);
    Request { scenario: Shared(scenario.into()), motion: Shared(motion.into()), b: None, keep: None }
}

/// An arm without b moves its end effector as given without angular momentum, from the given start: on a base that floats
/// the simulated base stays as it is oriented, and the end effector goes where it went, seen from the base. Where a dynamic
/// singularity is in the way, only the motion as given is left, and it is said why.
#[test]
fn an_arm_without_b_turns_no_base() {
    let spot = Scenario::builtin("spot").expect("built in");
    let found = |from: &[f64], by: &[f64], floats: bool| {
        let request = request(&spot.machine, Coordinates::Drives, moving(from, by));
        let Shared(scenario) = request.scenario;
        let base = if floats { spot.base } else { scenario.base };
        let scenario = Scenario { base, ..(*scenario).clone() };
        answer_now::<ImportQuery>(Request { scenario: Shared(scenario.into()), ..request }).expect("a motion")
    };
    for floats in [false, true] {
        let found = found(&[0.255, 1.302, 2.349], &[-0.155, -0.052, 0.551], floats);
        let proposal = found.proposal.as_ref().unwrap_or_else(|| panic!("{:?}", found.reason));
        assert!(proposal.way == "zero-momentum" && proposal.turns_no_base && !proposal.reactionless);
        assert!(proposal.tip_deviation < 1e-7 && proposal.simulated_peak_base_force > 1e-3);
        let given = found.given.as_ref().expect("it moves");
        assert!(floats || proposal.simulated_peak_base_moment < 1e-6 * given.peak_base_moment);
        let [proposed, as_given] = found.scenarios.as_ref().expect("both");
        let turn = |scenario: &Scenario| {
            let mut most = 0.0_f64;
            replay(scenario, |_, frame| most = most.max(frame.base.angle.abs())).expect("it runs");
            most
        };
        assert!(!floats || turn(proposed) < 1e-9 && turn(as_given) > 0.03);
        assert!(found.lines().iter().all(|line| !line.name.contains("b on the way")));
    }
    let none = found(&[0.2, 0.9, 1.6], &[0.8, 0.3, -0.6], true);
    let reason = none.reason.expect("a reason").to_string();
    assert!(none.proposal.is_none() && none.as_given.is_some(), "{reason}");
    assert!(reason.contains("no pose constant b") && reason.contains("dynamic singularity"), "{reason}");
}

/// What already holds b is left as it is; what does not is moved onto a plane, and both scenarios do what is said.
#[test]
fn a_motion_is_moved_onto_a_plane() {
    let machine = builtin("nine-link").expect("built in");
    let samples = moving(&[1.7, 3.7, 2.2], &[-0.2, 0.5, 0.9]);
    let found = answer_now::<ImportQuery>(request(machine, Coordinates::Drives, samples.clone())).expect("a motion");
    let given = found.given.as_ref().expect("it moves");
    assert!(found.feasible && found.reason.is_none() && found.content == "drives" && given.peak_base_moment > 0.1);
    let proposal = found.proposal.as_ref().expect("a proposal");
    assert!(proposal.reactionless && proposal.way == "same-tip" && proposal.tip_deviation < 1e-7);
    let lambda = Inertia::of(machine).lambda();
    let b: Vec<f64> = (0..samples.count()).map(|i| lambda.dot(samples.values(i))).collect();
    let ends = [b.iter().copied().fold(f64::INFINITY, f64::min), b.iter().copied().fold(f64::NEG_INFINITY, f64::max)];
    assert_eq!(found.b_samples, Some(ends));
    let [proposed, as_given] = found.scenarios.as_ref().expect("both");
    assert_eq!([&*proposed.name, &*as_given.name], ["mine", "mine-given"]);
    assert_eq!([&*proposed.title, &*as_given.title], ["A table · same-tip", "A table · as given"]);
    let peaks = |scenario| replay(scenario, |_, _| {}).expect("it runs").frame().peaks;
    assert!(peaks(proposed).is_reactionless() && peaks(proposed).moment == proposal.simulated_peak_base_moment);
    assert!((peaks(as_given).moment - given.peak_base_moment).abs() < 1e-3 * given.peak_base_moment);
}

/// The end effector's motion is carried out on a plane, and compared with minimum-norm rates.
#[test]
fn a_motion_of_the_end_effector_is_carried_out() {
    let machine = builtin("nine-link").expect("built in");
    let asked = request(machine, Coordinates::EndEffector, moving(&[0.50, 0.50], &[0.05, 0.40]));
    let found = answer_now::<ImportQuery>(asked.clone()).expect("a motion");
    let proposal = found.proposal.as_ref().expect("a proposal");
    assert!(found.content == "tip" && found.b_samples.is_none() && proposal.way == "on-plane");
    assert!(proposal.simulated_peak_base_moment < 1e-6 && found.given.expect("it follows").peak_base_moment > 0.1);
    let refused =
        answer_now::<ImportQuery>(Request { keep: Some(PreservedPath::Joints), ..asked }).expect_err("no joints");
    assert_eq!(refused, MotionImportError::NoJoints);
}

/// In portions it comes to the same as at once.
#[test]
fn portions_come_to_the_same() {
    let machine = builtin("nine-link").expect("built in");
    let asked = request(machine, Coordinates::Drives, moving(&[1.7, 3.7, 2.2], &[-0.2, 0.5, 0.9]));
    let at_once = answer_now::<ImportQuery>(asked.clone()).expect("a motion");
    let queries = Queries::default();
    queries.work_in_portions();
    let found = (0..100).find_map(|_| {
        let asked = queries.ask_in_background::<ImportQuery>(&asked);
        (asked.state == QueryStatus::Known).then_some(asked.last).flatten()
    });
    let found: Arc<_> = found.expect("it ends");
    let found = found.as_ref().as_ref().expect("a motion");
    assert_eq!(found.proposal, at_once.proposal);
    assert_eq!((&found.given, &found.scenarios), (&at_once.given, &at_once.scenarios));
}

/// The search for what to propose tells how far it is, never less than before, and ends where it is not wanted any more.
#[test]
fn the_search_is_told_and_stopped() {
    for (name, coordinates, samples) in [
        ("nine-link", Coordinates::Drives, moving(&[1.7, 3.7, 2.2], &[-0.2, 0.5, 0.9])),
        ("nine-link", Coordinates::EndEffector, moving(&[0.50, 0.50], &[0.05, 0.40])),
        ("four-drive", Coordinates::EndEffector, moving(&[0.50, 0.50], &[0.05, 0.40])),
    ] {
        let machine = builtin(name).expect("built in");
        let asked = request(machine, coordinates, samples);
        let mut heard = Vec::new();
        let mut work = ImportQuery::begin(asked.clone());
        loop {
            match work.go_on(&mut |done| {
                heard.push(done);
                true
            }) {
                Portion::More(done) => heard.push(done),
                Portion::Done(found) => break assert!(found.expect("a motion").feasible),
                Portion::Stopped => unreachable!("all of it is wanted"),
            }
        }
        assert!(heard.is_sorted() && heard[0] > 0.0 && heard[heard.len() - 1] <= 1.0, "{heard:?}");
        assert!(heard.iter().filter(|done| **done < 0.5).count() > 3, "{heard:?}");
        // Wherever it hears that the rest is not wanted it says so, and asks no more.
        for last in [1, 3, heard.len() / 2] {
            let (mut words, mut work) = (0, ImportQuery::begin(asked.clone()));
            let end = (0..100).find_map(|_| {
                let portion = work.go_on(&mut |_| {
                    words += 1;
                    words < last
                });
                if matches!(portion, Portion::More(_)) { None } else { Some(portion) }
            });
            assert!(matches!(end, Some(Portion::Stopped)) && words == last, "{words} {last}");
        }
    }
}

/// What would help is named apart, so that no option of a command stands in what others show.
#[test]
fn what_would_help_is_named_apart() {
    let machine = builtin("scara").expect("built in");
    let asked = request(machine, Coordinates::Drives, moving(&[0.3, 0.9], &[0.4, -0.2]));
    let found = answer_now::<ImportQuery>(asked).expect("a motion");
    let why = found.reason.expect("nothing can be proposed");
    assert!(!why.to_string().contains("--"), "{why}");
    let rough = moving(&[1.7, 3.7, 2.2], &[-0.2, 0.5, 0.9]);
    let mut sign = 1e-4;
    let jagged = rough.rows().map(|row| {
        sign = -sign;
        row[1..].iter().map(|x| x + sign).collect()
    });
    let jagged = rough.with_values(jagged).expect("as many");
    let found =
        answer_now::<ImportQuery>(request(builtin("nine-link").expect("built in"), Coordinates::Drives, jagged));
    let note = found.expect("a motion").notes.swap_remove(0);
    assert_eq!(note.remedies().collect::<Vec<_>>(), [Remedy::CutOff]);
    assert!(note.to_string().ends_with("digits or samples; smoothing removes higher frequencies"), "{note}");
    assert!(note.worded(|_| "--smooth HZ").to_string().ends_with("; --smooth HZ removes higher frequencies"), "{note}");
}

/// Angles that were wrapped begin within the joint limits again, and smoothing says what it moved.
#[test]
fn wrapped_angles_are_lifted() {
    let machine = builtin("nine-link").expect("built in");
    let turn = std::f64::consts::TAU;
    let samples = moving(&[1.7, 3.7 - turn, 2.2], &[-0.2, 0.5, 0.9]);
    let motion = GivenMotion::new(machine, Coordinates::Drives, names(&samples), samples.clone());
    assert_eq!(motion.lifted, [0.0, turn, 0.0]);
    assert!((motion.samples.values(0)[1] - 3.7).abs() < 1e-12 && motion.samples.times() == samples.times());
    let smooth = motion.clone().smoothed(5.0).expect("below half of the rate");
    let changes = smooth.samples.rows().flatten().zip(motion.samples.rows().flatten()).map(|(a, b)| (a - b).abs());
    assert_eq!(smooth.smoothing, Some([5.0, changes.fold(0.0, f64::max)]));
    assert!(motion.smoothed(1e3).is_err());
}
