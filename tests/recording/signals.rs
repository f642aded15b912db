//! Series of a recording against the frames of the run.

use super::*;

#[test]
fn signals_are_the_frames_at_every_step() {
    let folder = Folder::new("signals");
    let mut heard = Vec::new();
    let every_step = Options { every_step: true, ..Options::default() };
    let recordings = record(&cases(), &folder.path("cases.rrd"), &every_step, &mut |p| {
        heard.push((p.done, p.total, p.what.to_owned()));
        true
    })
    .expect("three cases");
    let contents = Contents::of(&folder.path("cases.rrd"));
    for (scenario, recording) in cases().iter().zip(&recordings) {
        let mut frames: Vec<Frame> = Vec::new();
        replay(scenario, |_, frame| frames.push(*frame)).expect("it runs");
        assert_eq!(frames.len(), 1001);
        for signal in signals(&scenario.machine) {
            let (steps, nanos, values) = contents.signal(&scenario.name, &signal);
            assert!(steps.iter().copied().eq(0..=1000), "{}: a row at every step", signal.path);
            assert!(nanos.iter().copied().eq((0..=1000).map(|i| i * 1_000_000)), "{}: and its time", signal.path);
            let expected: Vec<f64> = frames.iter().map(|f| signal.value(f)).collect();
            assert_eq!(values, expected, "{} of {}", signal.path, scenario.name);
        }
        let last = frames.last().expect("frames").peaks;
        assert_eq!(recording.scenario, scenario.name);
        assert_eq!(recording.file, Some(folder.path("cases.rrd")));
        assert_eq!(recording.steps, 1000);
        assert_eq!(recording.peak_torque, last.torque.to_vec());
        assert_eq!(recording.peak_base_moment, last.moment);
        assert_eq!(recording.peak_base_force, last.force);
        assert_eq!(recording.reactionless, scenario.name == "case-3");
        assert!(recording.notes.is_empty());
    }
    assert!(heard.windows(2).all(|w| w[0].0 <= w[1].0), "progress only grows");
    assert_eq!(heard.last(), Some(&(6000, 6000, "case-3".to_owned())));
}

/// Without the option, the rows come at a fixed rate, with the last step and those of edits.
#[test]
fn signals_of_a_longer_run_have_rows_at_a_fixed_rate() {
    let folder = Folder::new("signals");
    let mut scenario = Scenario::builtin("case-3").expect("built in");
    scenario.duration = Some(7.003);
    let push = Edit::Set { change: "plant = { force = [0.1, 0.0] }".parse().expect("TOML") };
    scenario.edits.push(TimedEdit { step: 1234, edit: push });
    record_in(&folder, "long.rrd", std::slice::from_ref(&scenario)).expect("recorded");
    let contents = Contents::of(&folder.path("long.rrd"));
    let own = signals(&scenario.machine);
    let (steps, _, values) = contents.signal("case-3", &own[0]);
    let mut wanted: Vec<i64> = (0..=7000).step_by(10).chain([1234, 7003]).collect();
    wanted.sort_unstable();
    assert_eq!(steps, wanted);
    let mut frames: Vec<Frame> = Vec::new();
    replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
    assert!(steps.iter().zip(&values).all(|(step, x)| own[0].value(&frames[*step as usize]) == *x));
}

/// Limits stand beside the signals that come near them, from the first to the last instant, at plus and at minus.
#[test]
fn limits_stand_beside_their_signals() {
    let folder = Folder::new("limits");
    for (time, are_near) in [(0.35, true), (8.0, false)] {
        let change = toml::from_str(&format!("task.time = {time}")).expect("a key");
        let scenario = Scenario::builtin("case-1").expect("built in").with_settings(&change).expect("a time");
        let file = folder.path(&format!("{time}.rrd"));
        record(std::slice::from_ref(&scenario), &file, &Options::default(), &mut |_| true).expect("a case");
        let contents = Contents::of(&file);
        let torques = signals(&scenario.machine).into_iter().filter(|signal| signal.path.starts_with("torque/"));
        for signal in torques {
            let limit = signal.limit.expect("the paper's drives have limits");
            let path = format!("{}/limits", contents.series(&scenario.name, &signal).0);
            assert_eq!(contents.holds(&path), are_near, "{path} at {time} s");
            if are_near {
                let values = contents.numbers(&path, "Scalars:scalars");
                let count = |x: f64| values.iter().filter(|value| **value == x).count();
                assert!(count(limit) >= 2 && count(limit) == count(-limit), "{limit}: {values:?}");
                let names = contents.texts(&path, "SeriesLines:names");
                assert!(names.iter().any(|name| name.contains(&signal.symbol)), "{names:?}");
            }
        }
    }
}

/// Names of drives are any; what a signal is does not follow from them.
#[test]
fn drives_named_like_rows_stay_apart() {
    let folder = Folder::new("named");
    let mut scenario = short("case-3");
    let mut spec = scenario.machine.spec().clone();
    for (drive, name) in spec.drives.iter_mut().zip(["reference", "total", "limits"]) {
        let old = std::mem::replace(&mut drive.name, name.to_owned());
        spec.links.iter_mut().filter(|link| link.drive == old).for_each(|link| link.drive = name.to_owned());
        spec.angles.iter_mut().for_each(|angle| {
            for of in [&mut angle.to, &mut angle.from] {
                if *of == old {
                    *of = name.to_owned();
                }
            }
        });
    }
    scenario.machine = stillbase::mechanics::machine::Machine::new(spec).expect("a machine");
    record_in(&folder, "named.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("named.rrd"));
    let mut frames: Vec<Frame> = Vec::new();
    replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
    for signal in signals(&scenario.machine) {
        let (path, k) = contents.series(&scenario.name, &signal);
        assert_eq!(contents.texts(&path, "paths")[k], signal.path);
        let (steps, _, values) = contents.signal(&scenario.name, &signal);
        assert!(
            steps.iter().zip(&values).all(|(step, x)| signal.value(&frames[*step as usize]) == *x),
            "{}",
            signal.path
        );
        let widths = contents.at(&path).into_iter().find_map(|c| c.components().get_array("SeriesLines:widths".into()));
        let widths = widths.expect("widths");
        let widths = widths.values().as_any().downcast_ref::<Float32Array>().expect("numbers").values();
        let is_thin = widths[k] < 1.0;
        assert_eq!(
            is_thin,
            signal.path.starts_with("reference/") || signal.path == "pose/b_reference",
            "{}",
            signal.path
        );
    }
}
