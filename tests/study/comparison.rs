//! Runs side by side: the ways of one task, their table, and the two instants of a cursor.

use std::sync::Arc;
use stillbase::session::scenario::{Scenario, TaskKind};
use stillbase::session::{Edit, TimedEdit};
use stillbase::simulation::signals::signals;

use stillbase::query::{Portion, Query as _, Shared, answer_now};
use stillbase::study::comparison::{
    Alternative, AlternativeRuns, ComparedRun, ComparisonTable, SLOW_FACTOR, SUMMARY_COLUMNS, SignalDifference,
    alternatives,
};

fn scenario(name: &str) -> Scenario {
    Scenario::builtin(name).expect("built in")
}

fn run(way: Alternative, of: &str) -> ComparedRun {
    ComparedRun::of(way.of(&scenario(of))).expect("it runs")
}

/// The ways of case 3 are the paper's three cases, a wheel and patience.
#[test]
fn the_ways_of_case_3_are_the_cases() {
    let ways: Vec<Alternative> = alternatives(&scenario("case-3")).into_iter().map(|(way, _)| way).collect();
    assert_eq!(
        ways,
        [
            Alternative::Reactionless,
            Alternative::StraightLine,
            Alternative::OtherPose,
            Alternative::Wheel,
            Alternative::Slowly
        ]
    );
    for (way, case) in [(Alternative::Reactionless, "case-3"), (Alternative::StraightLine, "case-1")] {
        let (got, want) = (run(way, "case-3").summary, ComparedRun::of(scenario(case)).expect("it runs").summary);
        assert_eq!((got.peak_moment, got.energy, got.peak_torque), (want.peak_moment, want.energy, want.peak_torque));
    }
    let (other, case_2) = (run(Alternative::OtherPose, "case-3").summary, scenario("case-2"));
    let case_2 = ComparedRun::of(case_2).expect("it runs").summary;
    assert!(
        (other.peak_moment / case_2.peak_moment - 1.0).abs() < 1e-3,
        "{} {}",
        other.peak_moment,
        case_2.peak_moment
    );
}

/// Forces and moments fall with the square of the time; what the base turns by does not fall at all.
#[test]
fn patience_divides_by_the_square_and_not_the_turn() {
    let mut free = scenario("case-1");
    free.base.kind = stillbase::simulation::plant::BaseKind::Free;
    let (quick, slow) = (run_of(&free, Alternative::StraightLine), run_of(&free, Alternative::Slowly));
    let (quick, slow) = (quick.summary, slow.summary);
    assert!((slow.time - SLOW_FACTOR * quick.time).abs() < 1e-9);
    assert!((quick.peak_moment / slow.peak_moment / SLOW_FACTOR.powi(2) - 1.0).abs() < 1e-3);
    assert!((quick.moment_impulse / slow.moment_impulse / SLOW_FACTOR - 1.0).abs() < 1e-3);
    assert!((quick.base_tilt / slow.base_tilt - 1.0).abs() < 1e-6, "{} {}", quick.base_tilt, slow.base_tilt);
}

fn run_of(scenario: &Scenario, way: Alternative) -> ComparedRun {
    ComparedRun::of(way.of(scenario)).expect("it runs")
}

/// A wheel that is large enough takes all of it; one that is not says when it stopped.
#[test]
fn the_wheel_says_when_it_saturates() {
    let ample = run(Alternative::Wheel, "case-3").summary;
    assert!(
        !ample.reactionless
            && ample.verdict.is_base_unloaded
            && ample.saturated_at.is_none()
            && ample.wheel_rate.is_some_and(|rate| rate > 5.0)
    );
    let mut small = scenario("case-3");
    small.base.wheel = Some(toml::from_str("torque_limit = 0.5").expect("a wheel"));
    let small_run = run_of(&small, Alternative::Wheel).summary;
    assert!(!small_run.reactionless && small_run.saturated_at.is_some_and(|t| t > 0.0 && t < 0.5));
    // What the arm transmits is told beside what is left.
    assert!(ample.peak_moment < 1e-9 && ample.peak_arm_moment > 1.0);
    // The others go without it.
    assert!(run_of(&small, Alternative::StraightLine).summary.wheel_rate.is_none());
}

/// What is none of the others stands first; what cannot be done is refused in words, and the rest goes on.
#[test]
fn a_task_of_its_own_kind_stands_first() {
    let ways = alternatives(&scenario("least-reaction"));
    assert_eq!(ways[0].0, Alternative::AsGiven);
    assert_eq!(ways[0].1.task.kind, TaskKind::LeastReaction);
    let outcomes: Vec<bool> = ways.into_iter().map(|(_, s)| ComparedRun::of(s).is_ok()).collect();
    assert!(outcomes[0] && outcomes.contains(&false) && outcomes.iter().filter(|ok| **ok).count() >= 4);
}

/// Hands on the way belong to one run and not to the task.
#[test]
fn ways_leave_hands_out() {
    let mut led = scenario("case-3");
    let at = |step, edit| TimedEdit { step, edit };
    led.edits = vec![at(0, Edit::set("plant.payload.mass", 0.2)), at(200, Edit::Push { x: 3.0, y: 0.0 })];
    let ways = alternatives(&led);
    assert_eq!(ways[0].0, Alternative::AsGiven, "the hand makes it another run");
    assert_eq!(ways[0].1.edits.len(), 2);
    // What was set at the start is part of the ground that all ways stand on.
    assert!(ways.iter().skip(1).all(|(_, s)| s.edits.is_empty() && s.plant.payload.mass == 0.2));
    led.edits = vec![at(0, Edit::set("task.time", 2.0)), at(0, Edit::set("task.kind", "minimum-norm"))];
    let slowly = Alternative::Slowly.of(&led);
    assert_eq!((slowly.task.time, Alternative::Reactionless.of(&led).task.kind), (8.0, TaskKind::Reactionless));
}

/// RMS, impulse and peak agree with the frames by another rule.
#[test]
fn the_table_agrees_with_the_frames() {
    let run = run(Alternative::StraightLine, "case-3");
    let h = 0.001;
    // Simpson's rule.
    let sum = |f: &dyn Fn(usize) -> f64| {
        let w = |i: usize| {
            if i == 0 || i == 1000 {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        (0..=1000).map(|i| w(i) * f(i)).sum::<f64>() * h / 3.0
    };
    let moment = |i: usize| run.frames[i].base_moment();
    let s = &run.summary;
    assert_eq!(run.frames.len(), 1001);
    assert!((s.rms_moment - sum(&|i| moment(i).powi(2)).sqrt()).abs() < 1e-6);
    assert!((s.moment_impulse - sum(&|i| moment(i).abs())).abs() < 1e-4);
    assert_eq!(s.peak_moment, (0..=1000).map(|i| moment(i).abs()).fold(0.0, f64::max));
    let power = |i: usize| (0..3).map(|k| (run.frames[i].torque[k] * run.frames[i].qd[k]).abs()).sum::<f64>();
    assert!((s.energy - sum(&power)).abs() < 1e-4 * s.energy);
    // Every column has a value or none, and keys are their own.
    let mut keys: Vec<&str> = SUMMARY_COLUMNS.iter().map(|c| c.key).collect();
    keys.dedup();
    assert_eq!(keys.len(), SUMMARY_COLUMNS.len());
    assert!(SUMMARY_COLUMNS.iter().filter_map(|c| (c.value)(s)).all(f64::is_finite));
}

/// Long runs keep evenly spaced frames, and their last.
#[test]
fn long_runs_are_thinned() {
    let mut long = scenario("case-3");
    long.task.time = 9.5;
    let run = ComparedRun::of(long).expect("it runs");
    assert!(run.frames.len() < 4100 && run.frames.len() > 2000, "{}", run.frames.len());
    assert!((run.duration() - 9.5).abs() < 1e-9);
    let gaps: Vec<u64> = run.frames.to_vec().windows(2).map(|w| w[1].step - w[0].step).collect();
    assert!(gaps[..gaps.len() - 1].iter().all(|g| *g == gaps[0]), "even");
    assert_eq!(run.at(4.0).map(|f| f.time <= 4.0 + 1e-9 && f.time > 3.98), Some(true));
    assert_eq!(run.at(100.0).map(|f| f.step), run.frames.last().map(|f| f.step));
    assert_eq!(run.at(-1.0).map(|f| f.step), Some(0));
}

/// Two cursors: every signal at both, and the difference.
#[test]
fn two_instants_differ_by_their_signals() {
    let run = run(Alternative::StraightLine, "case-3");
    let table = signals(run.machine());
    let (a, b) = (run.at(0.2).expect("a frame"), run.at(0.7).expect("a frame"));
    let list: Vec<SignalDifference> = table.iter().map(|signal| SignalDifference::of(signal, a, b)).collect();
    assert_eq!(list.len(), table.len());
    for (d, signal) in list.iter().zip(&table) {
        assert_eq!((d.from, d.to), (signal.value(a), signal.value(b)), "{}", signal.path);
        assert_eq!(d.difference(), d.to - d.from);
    }
}

/// A comparison keeps what it is given, follows the task, sorts both ways and gives its table away.
#[test]
fn a_comparison_follows_sorts_and_keeps() {
    use stillbase::study::comparison::Comparison;
    let mut comparison = Comparison::empty(&scenario("case-3"));
    let ways = |scenario: Scenario| Arc::new(answer_now::<AlternativeRuns>(Shared(Arc::new(scenario))));
    comparison.follow(&ways(scenario("case-3")));
    assert_eq!(comparison.entries().len(), 5);
    comparison.show(1, true);
    comparison.keep(scenario("case-2")).expect("it runs");
    comparison.keep(scenario("case-2")).expect("it runs");
    let titles: Vec<&str> = comparison.entries().iter().map(|e| e.title.as_str()).collect();
    assert_eq!(titles[5..], ["case-2", "case-2 2"]);
    assert_eq!(comparison.shown().map(|(i, _)| i).collect::<Vec<_>>(), [1, 5, 6]);

    let column = SUMMARY_COLUMNS.iter().position(|c| c.key == "peak_felt_moment").expect("a column");
    let values = |comparison: &Comparison| -> Vec<f64> {
        let value = |i: usize| {
            comparison.entries()[i].outcome.as_ref().ok().and_then(|r| (SUMMARY_COLUMNS[column].value)(&r.summary))
        };
        comparison.order().into_iter().filter_map(value).collect()
    };
    comparison.sort_by(column);
    assert!(values(&comparison).is_sorted());
    comparison.sort_by(column);
    assert!(values(&comparison).is_sorted_by(|a, b| a >= b));
    comparison.sort_by(column);
    assert_eq!(comparison.order(), (0..7).collect::<Vec<_>>());

    let text = comparison.to_text();
    assert_eq!(text.lines().count(), 8);
    assert!(text.lines().all(|line| line.split('\t').count() == SUMMARY_COLUMNS.len() + 1));

    // Another task: its ways are run, what was ticked stays so, what was kept stays.
    let mut other = scenario("case-3");
    other.task.time = 2.0;
    comparison.follow(&ways(other.clone()));
    assert_eq!(*comparison.task(), other);
    assert_eq!(comparison.entries().len(), 7);
    assert!(comparison.entries()[1].shown && comparison.entries()[5].added_by_user);
    assert_eq!(comparison.entries()[1].outcome.as_ref().ok().map(|r| r.summary.time), Some(2.0));
    comparison.remove(0);
    assert_eq!(comparison.entries().len(), 7, "only what was kept can be taken away");
    comparison.remove(6);
    assert_eq!(comparison.entries().len(), 6);
}

/// Figures of a design agree with what the machines are, and what cannot be set side by side is not.
/// A way that is refused takes a search for ways out: it says how far it is, and stops when it is told to.
#[test]
fn the_search_for_ways_out_of_a_refused_run_stops() {
    let loaded = toml::from_str("payload.mass = 0.4").expect("keys");
    let loaded = Shared(Arc::new(scenario("case-1").with_settings(&loaded).expect("settings")));
    let way = alternatives(&loaded.0).into_iter().position(|(way, _)| way == Alternative::Reactionless);
    let way = way.expect("a way");
    let mut work = AlternativeRuns::begin(loaded);
    for _ in 0..way {
        assert!(matches!(work.go_on(&mut |_| true), Portion::More(_)));
    }
    let mut shares = Vec::new();
    let stopped = work.go_on(&mut |share| {
        shares.push(share);
        shares.len() < 2
    });
    assert!(matches!(stopped, Portion::Stopped) && shares.len() == 2, "{shares:?}");
    shares.clear();
    let done = work.go_on(&mut |share| {
        shares.push(share);
        true
    });
    let Portion::More(whole) = done else { panic!("{done:?}") };
    assert!(shares.len() > 2 && shares.is_sorted() && shares.last().is_some_and(|last| *last <= whole), "{shares:?}");
}

#[test]
fn designs_stand_beside_the_first() {
    use stillbase::mechanics::machine::Inertia;
    use stillbase::study::comparison::{Comparison, DESIGN_COLUMNS};
    let compared = |scenario: Scenario| ComparedRun::of(scenario).expect("it runs");
    let value = |design: &stillbase::study::comparison::DesignMeasures, key: &str| {
        (DESIGN_COLUMNS.iter().find(|c| c.key == key).expect("a column").value)(design)
    };
    // The same task on a machine whose links all weigh twice as much, so that every force and torque doubles.
    let bare = compared(scenario("nine-link-bare"));
    let mut heavy = scenario("nine-link-bare");
    let mut spec = heavy.machine.spec().clone();
    for link in &mut spec.links {
        (link.mass, link.inertia) = (2.0 * link.mass, 2.0 * link.inertia);
    }
    heavy.machine = stillbase::mechanics::machine::Machine::new(spec).expect("a machine");
    let design = compared(heavy.clone()).candidate.compared_with(&bare.candidate);
    let mass = bare.machine().mass();
    assert!((value(&design, "added_mass").expect("a mass") - mass).abs() < 1e-12 * mass);
    assert!((value(&design, "mass_inertia_factor").expect("a factor") - 4.0).abs() < 1e-12);
    for key in ["beta_force", "beta_moment", "beta_torque"] {
        assert!((value(&design, key).expect("a ratio") - 2.0).abs() < 1e-9, "{key}");
    }
    let left = Inertia::of(&heavy.machine);
    assert_eq!(value(&design, "force_left"), Some(left.force_residual()));
    // An edit of the session counts; β of another task or of another arm would be of nothing.
    let mut edited = scenario("nine-link-bare");
    edited.edits = vec![TimedEdit { step: 0, edit: Edit::set("link.9.mass", 0.9) }];
    let design = compared(edited).candidate.compared_with(&bare.candidate);
    let added = value(&design, "added_mass").expect("a mass");
    assert!((added - (0.9 - bare.machine().links()[8].mass)).abs() < 1e-12 && design.why_not.is_none());
    let mut elsewhere = heavy.clone();
    elsewhere.task.to = [0.52, 0.80];
    let mut longer = scenario("nine-link-bare");
    longer.machine = longer.machine.set("length.l9", "0.31").expect("a machine");
    for (other, word) in [(elsewhere, "task"), (longer, "length")] {
        let design = compared(other).candidate.compared_with(&bare.candidate);
        assert!(value(&design, "added_mass").is_some() && value(&design, "beta_force").is_none());
        assert!(design.why_not.as_ref().is_some_and(|why| why.contains(word)), "{:?}", design.why_not);
    }
    let design = compared(scenario("two-drive")).candidate.compared_with(&bare.candidate);
    assert!(value(&design, "mass").is_some() && value(&design, "added_mass").is_none());
    assert!(design.why_not.as_ref().is_some_and(|why| why.contains("2 drives")), "{:?}", design.why_not);
    // In a table they have columns of their own as soon as there are two machines.
    let mut comparison = Comparison::empty(&scenario("nine-link-bare"));
    comparison.keep(scenario("nine-link-bare")).expect("it runs");
    assert!(!comparison.has_designs());
    let columns = |comparison: &Comparison| comparison.to_text().lines().next().map(|line| line.split('\t').count());
    assert_eq!(columns(&comparison), Some(SUMMARY_COLUMNS.len() + 1));
    comparison.keep_run(compared(heavy));
    assert!(comparison.has_designs());
    assert_eq!(columns(&comparison), Some(SUMMARY_COLUMNS.len() + DESIGN_COLUMNS.len() + 1));
    let of = SUMMARY_COLUMNS.len() + DESIGN_COLUMNS.iter().position(|c| c.key == "mass").expect("a column");
    comparison.sort_by(of);
    comparison.sort_by(of);
    assert_eq!(comparison.order(), [1, 0], "the heavier first");
    // Without the first, the second is the one that all are set beside.
    comparison.remove(0);
    assert_eq!(comparison.entries()[0].value(of + 4), Some(0.0));
}

/// A row is what the run comes to, and its machine beside that of the first run that can be done.
#[test]
fn rows_are_what_runs_come_to() {
    let mut impossible = scenario("case-3");
    impossible.task.to = [5.0, 5.0];
    let mut rows = ComparisonTable::default();
    rows.run(None, &impossible, &mut |_| true);
    rows.run(Some("as it is"), &scenario("case-3"), &mut |_| true);
    assert!(!rows.have_designs());
    rows.run(None, &scenario("two-drive"), &mut |_| true);
    assert!(rows.have_designs());
    let [refused, first, other] = rows.rows() else { panic!("three runs") };
    assert!(refused.outcome.is_err() && refused.design.is_none() && refused.title() == "case-3");
    let alone = ComparedRun::of(scenario("case-3")).expect("it runs");
    assert_eq!((first.outcome.as_ref().ok(), first.title()), (Some(&alone.summary), "as it is"));
    assert_eq!(first.design, Some(alone.candidate.compared_with(&alone.candidate)));
    let two = ComparedRun::of(scenario("two-drive")).expect("it runs");
    assert_eq!(other.design, Some(two.candidate.compared_with(&alone.candidate)));
    let said = serde_json::to_value(&rows).expect("plain data");
    assert!(said[0]["refused"].is_string() && said[1]["way"] == "as it is" && said[2]["design"]["apart"].is_string());
}
