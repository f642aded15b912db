//! What a recording says in words: events, phases, properties.

use super::*;

#[test]
fn what_happened_and_what_was_run_is_told() {
    let folder = Folder::new("told");
    let scenario = Scenario::builtin("case-1").expect("built in");
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let property = |name: &'static str| contents.texts("/__properties/case-1", name);
    let [text] = &property("scenario")[..] else { panic!("one scenario") };
    assert_eq!(Scenario::parse(text, "recorded", None).expect("a scenario"), scenario);
    let [text] = &property("machine")[..] else { panic!("one machine") };
    assert_eq!(stillbase::mechanics::machine::parse(text, "recorded").expect("a machine"), scenario.machine);
    assert_eq!(property("version"), [env!("CARGO_PKG_VERSION")]);
    assert!(property("verdict")[0].starts_with("not reactionless: peak |n_B| 1.0891 N m"), "{:?}", property("verdict"));
    for (name, words) in [
        ("statement_machine", "balanced (force-balanced and invariant"),
        ("statement_plan", "changes b by 0.0"),
        ("statement_run", "peak |n_B| 1.0891 N m"),
    ] {
        assert!(property(name)[0].starts_with(words), "{:?}", property(name));
    }
    let events = contents.texts("/case-1/events", "TextLog:text");
    for part in [
        "start: Straight line: it shakes",
        "plan: minimum-norm, line, quintic, 2 points, T = 1.000 s",
        "peak |n_B| 1.0891 N m",
        "end of motion",
        "peak |τ| 2.42",
        "not reactionless",
    ] {
        assert!(events.iter().any(|e| e.starts_with(part)), "{part} in {events:?}");
    }
    assert_eq!(contents.texts("/case-1/phase", "StateChange:state"), ["motion", "rest"]);
}

#[test]
fn what_was_foreseen_is_told() {
    let folder = Folder::new("foreseen");
    let names = ["change-b", "circle", "drift", "circle"];
    let mut scenarios =
        names.map(|name| Scenario { duration: Some(0.02), ..Scenario::builtin(name).expect("built in") });
    // The last with limits on jerk.
    let smooth = &mut scenarios[3];
    (smooth.name, smooth.task.law) = ("smooth".into(), TimeLaw::FastestSmooth);
    for k in 1..=3 {
        smooth.machine = smooth.machine.set(&format!("drive.{k}.jerk_limit"), "900").expect("a limit");
    }
    record_in(&folder, "four.rrd", &scenarios).expect("four cases");
    let contents = Contents::of(&folder.path("four.rrd"));
    for scenario in &scenarios {
        let run = stillbase::session::Run::new(scenario).expect("it runs");
        let plan = run.plan();
        let told = |name: &'static str| contents.numbers(&format!("/__properties/{}", scenario.name), name);
        for name in ["forecast_duration", "forecast_time"] {
            assert_eq!(told(name), [plan.forecast.time]);
        }
        assert_eq!(told("forecast_peak_base_moment"), [plan.forecast.moment]);
        assert_eq!(told("forecast_moment_impulse"), [plan.forecast.impulse]);
        let price: Vec<f64> = plan.price.iter().map(|p| p.delta_b()).collect();
        assert_eq!((told("delta_b"), price.len()), (price.clone(), usize::from(scenario.name == "change-b")));
        let least: Vec<f64> = plan.price.iter().map(|p| p.least_peak(plan.forecast.time)).collect();
        for name in ["least_peak", "least_peak_base_moment"] {
            assert_eq!(told(name), least);
        }
        let gap: Vec<f64> = plan.pace.iter().filter_map(|pace| pace.gap()).collect();
        assert_eq!((told("gap"), gap.len()), (gap.clone(), usize::from(scenario.name == "smooth")));
        let drift = told("drift_2");
        assert_eq!(drift.len(), if scenario.name == "drift" { scenario.task.cycles as usize } else { 0 });
        if let (Some(drift), Some([start, .., end])) = (drift.last(), plan.cycles.get(..)) {
            assert_eq!(*drift, end[1] - start[1]);
        }
    }
    for name in ["limiting", "limit"] {
        let limit = contents.texts("/__properties/circle", name);
        assert!(limit.iter().any(|l| l.contains("of drive")), "{limit:?}");
    }
}

#[test]
fn a_gesture_is_one_event() {
    let folder = Folder::new("gestures");
    let mut scenario = short("case-3");
    scenario.duration = Some(0.9);
    let push = |step, x: f64| TimedEdit { step, edit: Edit::Push { x, y: 0.0 } };
    let drag = |step, x: f64| TimedEdit { step, edit: Edit::DragTarget { x, y: 0.8 } };
    // A frame brings an edit; a still hand brings none for a while; then the pointer leads, rests, and leads again.
    scenario.edits = (0..10).map(|i| push(16 * i, 0.1 + 0.01 * i as f64)).collect();
    scenario.edits.extend([push(450, 0.05), push(466, 0.0), push(470, 0.02), push(480, 0.0)]);
    scenario.edits.extend((0..5).map(|i| drag(500 + 16 * i, 0.52 + 0.001 * i as f64)));
    scenario.edits.push(drag(840, 0.55));
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("an edited case");
    let told = Contents::of(&folder.path("one.rrd")).texts("/case-3/events", "TextLog:text");
    let edits: Vec<&str> =
        told.iter().map(String::as_str).filter(|e| ["push", "let", "drag"].iter().any(|w| e.starts_with(w))).collect();
    assert_eq!(
        edits,
        [
            "push with up to 0.19 N, within 0.450 s",
            "let go",
            "push with 0.02, 0.00 N",
            "let go",
            "drag target to 0.524, 0.800 m, within 0.064 s",
            "drag target to 0.550, 0.800 m",
        ]
    );
}

#[test]
fn edits_on_the_way_are_recorded() {
    let folder = Folder::new("edits");
    let mut scenario = Scenario { duration: Some(0.5), ..short("case-3") };
    let edit = |step, edit| TimedEdit { step, edit };
    scenario.edits = vec![
        edit(22, Edit::DragTarget { x: 3.0, y: 0.0 }),
        edit(40, Edit::set("compare_b", 1.0)),
        edit(60, Edit::set("limits.a1", stillbase::settings::change::value("0.4,2.7"))),
    ];
    record_in(&folder, "edited.rrd", &[scenario]).expect("an edited case");
    let contents = Contents::of(&folder.path("edited.rrd"));
    let events = contents.texts("/case-3/events", "TextLog:text");
    for part in [
        "drag target to 3.000",
        "compare with b = 1.000 rad",
        "set limits of angle a1 to 0.4,2.7 rad",
        "the target is outside",
    ] {
        assert!(events.iter().any(|e| e.starts_with(part)), "{part} in {events:?}");
    }
    let steps = |path: &str, component: &'static str| -> Vec<i64> {
        let chunks = contents.at(path).into_iter().filter(|c| c.components().contains_component(component.into()));
        chunks.flat_map(|c| c.timelines()[&TimelineName::from("step")].times_raw().to_vec()).collect()
    };
    // What changes on the way is not static: with other limits workspaces are others from step 60 on, links are not.
    assert_eq!(steps("/case-3/machine/link/1", "Mesh3D:vertex_positions"), [0]);
    assert_eq!(steps("/case-3/workspace/2.400", "Mesh3D:vertex_positions"), [0, 60]);
    assert_eq!(steps("/case-3/workspace/5.000", "Mesh3D:vertex_positions"), [0]);
    assert_eq!(steps("/case-3/workspace/5.000", "Clear:is_recursive"), [40]);
    assert_eq!(steps("/case-3/workspace/1.000", "Mesh3D:vertex_positions"), [40, 60]);
    // The plan is there until the pointer leads.
    for (path, component) in [
        ("plan/path", "LineStrips3D:strips"),
        ("joint_space/path", "LineStrips3D:strips"),
        ("tower/reach/B", "LineStrips3D:strips"),
    ] {
        assert_eq!(steps(&format!("/case-3/{path}"), component), [0], "{path}");
    }
    for path in ["plan/path", "plan/start/1", "joint_space/path", "tower/reach/B", "tower/path"] {
        assert_eq!(steps(&format!("/case-3/{path}"), "Clear:is_recursive"), [22], "{path}");
    }
    assert_eq!(steps("/case-3/tower/wall", "Mesh3D:vertex_positions"), [0, 60]);
    assert_eq!(steps("/case-3/joint_space/plane", "Mesh3D:vertex_positions"), [0, 60]);
    // Also between the instants at which bodies have their rows.
    let moved = steps("/case-3/joint_space/pose", "Points3D:positions");
    assert!(moved.windows(2).all(|w| w[0] < w[1]) && moved[3..7] == [15, 20, 22, 25], "{moved:?}");
    assert_eq!(contents.texts("/case-3/phase", "StateChange:state"), ["motion", "follow"]);
    let refused = contents.texts("/case-3/refusals", "StateChange:state");
    assert!(
        refused.len() == 2 && refused[0] == "nothing refused" && refused[1] == "target out of reach",
        "{refused:?}"
    );
}

/// What keeps the machine from what is asked of it has a lane of its own, from its first step to its last.
#[test]
fn what_is_refused_has_a_lane() {
    let folder = Folder::new("refused");
    let mut scenario = Scenario { duration: Some(0.6), ..Scenario::builtin("case-1").expect("built in") };
    scenario.edits = vec![
        TimedEdit { step: 100, edit: Edit::Push { x: 90.0, y: 0.0 } },
        TimedEdit { step: 120, edit: Edit::Push { x: 0.0, y: 0.0 } },
    ];
    record_in(&folder, "pushed.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("pushed.rrd"));
    let refused = contents.texts("/case-1/refusals", "StateChange:state");
    assert_eq!(refused, ["nothing refused", "drive at its torque limit", "nothing refused"]);
}

/// Notes and equations stand as Markdown that no name of the user can break.
#[test]
fn notes_and_equations_are_a_page() {
    use stillbase::session::scenario::{Bookmark, Note, NoteTime};

    let folder = Folder::new("notes");
    let mut scenario = Scenario { duration: Some(0.1), ..Scenario::builtin("case-3").expect("built in") };
    scenario.notes = vec![Note { text: "a | b *c* ``` <d>".into(), point: None, time: NoteTime::At(0.05) }];
    scenario.bookmarks = vec![Bookmark { time: 0.02, name: "look # here".into() }];
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let [page] = &contents.texts("/case-3/notes", "TextDocument:text")[..] else { panic!("one page") };
    assert!(page.starts_with("# Reactionless, from A to B\n"), "{page}");
    for part in ["## Notes", r"a \| b \*c\* \`\`\` \<d\> at 0.050 s", r"0.020 s: look \# here", "**Machine:** balanced"]
    {
        assert!(page.contains(part), "{part} in {page}");
    }
    for number in ["(5)", "(7)", "(8)", "(11)", "(12)", "(13)"] {
        assert!(page.contains(&format!("```text\n{number} ")), "{number} in {page}");
    }
    assert!(!page.contains(['ṙ', '\u{307}', '\u{308}']), "the viewer cannot write dots: {page}");
    assert_eq!(page.matches("```").count() % 2, 0, "blocks are closed: {page}");
}

/// A recording tells what the time line of the window has marks for, in the same words.
#[test]
fn the_window_and_a_recording_tell_the_same() {
    use stillbase::query::{Queries, answer_sequence};
    use stillbase::session::Session;
    use stillbase::session::events::{EventLog, Gestures, bookmarked, gestures, noted};
    use stillbase::session::scenario::{Bookmark, Note, NoteTime};

    let folder = Folder::new("same");
    let mut scenario = Scenario { duration: Some(0.6), ..Scenario::builtin("case-1").expect("built in") };
    scenario.edits = vec![
        TimedEdit { step: 100, edit: Edit::Push { x: 90.0, y: 0.0 } },
        TimedEdit { step: 120, edit: Edit::Push { x: 0.0, y: 0.0 } },
        TimedEdit { step: 300, edit: Edit::DragTarget { x: 3.0, y: 0.0 } },
    ];
    scenario.notes = vec![Note { text: "it starts".into(), point: None, time: NoteTime::At(0.05) }];
    scenario.bookmarks = vec![Bookmark { time: 0.2, name: "look here".into() }];
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("an edited case");
    let told = Contents::of(&folder.path("one.rrd")).texts("/case-1/events", "TextLog:text");
    let session = Session::open(scenario).expect("it opens");
    let of = (session.scenario().step, session.machines().clone());
    let watched: EventLog = answer_sequence(&of, session.frames());
    let mut all = gestures(&session.script().to_vec(), 0.001);
    let grown: Gestures = answer_sequence(&0.001, session.script());
    assert!(grown.events().eq(all.iter().cloned()));
    all.extend_from_slice(watched.events());
    all.extend(bookmarked(session.bookmarks(), 0.001));
    all.extend(noted(session.notes(), 0.001));
    all.push(watched.peak());
    all.sort_by_key(|event| event.step);
    let words: Vec<&str> = all.iter().map(|event| event.words.as_str()).collect();
    let own =
        |text: &&String| !["start:", "plan:", "peak |τ|", "not reactionless:"].iter().any(|w| text.starts_with(w));
    assert_eq!(told.iter().filter(own).map(String::as_str).collect::<Vec<_>>(), words);
    for part in [
        "the base begins to feel the arm",
        "push with 90.00, 0.00 N",
        "drive 2 comes to its torque limit, 5 N m",
        "bookmark: look here",
        "note: it starts at 0.050 s",
        "the target is outside",
    ] {
        assert!(words.iter().any(|told| told.starts_with(part)), "{part} in {words:?}");
    }
    // Read in portions, and once more after a frame has changed, they are the same.
    let (queries, mut frames) = (Queries::default(), session.frames().clone());
    while !queries.grow::<EventLog>(&of, &frames, 7).is_whole {}
    frames.replace_last(frames[frames.len() - 1]);
    let portions = queries.grow::<EventLog>(&of, &frames, 1);
    assert!(portions.is_whole, "only the last is read again");
    let portions = portions.answer().expect("just asked");
    assert_eq!((portions.events(), portions.peak()), (watched.events(), watched.peak()));
}

/// Notes stand where they stick, at their time, and in the log; one beyond the end is left out.
#[test]
fn notes_are_recorded_where_they_stick() {
    use stillbase::session::scenario::{Note, NoteTime, SnapPoint};

    let folder = Folder::new("notes");
    let mut scenario = short("case-3");
    let note = |text: &str, point, time| Note { text: text.into(), point, time };
    let end = scenario.duration.expect("short");
    scenario.notes = vec![
        note("on the tip", Some(SnapPoint::EndEffector), NoteTime::Always),
        note("a while", Some(SnapPoint::Place([0.2, 0.3])), NoteTime::Between([0.02, 0.04])),
        note("too late", Some(SnapPoint::BasePin), NoteTime::At(end + 1.0)),
        note("an instant alone", None, NoteTime::At(0.01)),
    ];
    record_in(&folder, "notes.rrd", std::slice::from_ref(&scenario)).expect("it is recorded");
    let contents = Contents::of(&folder.path("notes.rrd"));
    let labels = |i: usize| contents.texts(&format!("/case-3/notes/{i}"), "Points3D:labels");
    assert!(labels(1).len() > 3 && labels(1).iter().all(|text| text == "on the tip"), "{:?}", labels(1));
    let (steps, tips) = contents.vectors("/case-3/notes/1/point", "Points3D:positions");
    let mut ends = Vec::new();
    stillbase::session::replay(&scenario, |_, frame| ends.push(frame.end_effector)).expect("it runs");
    for (step, [x, y, _]) in steps.iter().zip(tips) {
        let tip = ends[usize::try_from(*step).expect("from the start")];
        assert!((tip.re - f64::from(x)).hypot(tip.im - f64::from(y)) < 1e-5, "{x}, {y} at {step}: {tip}");
    }
    let (steps, _) = contents.vectors("/case-3/notes/2/point", "Points3D:positions");
    assert!(steps.first() == Some(&20) && labels(2).iter().all(|text| text == "a while"), "{steps:?}");
    assert!(!contents.holds("/case-3/notes/3") && !contents.holds("/case-3/notes/4"));
    let events = contents.texts("/case-3/events", "TextLog:text");
    let told: Vec<&String> = events.iter().filter(|text| text.starts_with("note:")).collect();
    assert_eq!(
        told,
        [
            "note: on the tip, end effector",
            "note: an instant alone at 0.010 s",
            "note: a while, place 0.200, 0.300 m from 0.020 to 0.040 s"
        ]
    );
    // The scenario in the recording has them all.
    let path = "/__properties/case-3";
    let saved = contents.texts(path, "scenario");
    let read = Scenario::parse(&saved[0], "recorded", None).expect("what was recorded is read");
    assert_eq!(read.notes, scenario.notes);
}
