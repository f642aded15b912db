//! Proposals after a refusal: what is proposed works when its settings are typed, whatever was refused.

use std::collections::BTreeMap;

use stillbase::mechanics::machine::Inertia;
use stillbase::mechanics::planar::Vector;
use stillbase::mechanics::sketch::{SketchStep, Template};
use stillbase::session::design::relaxations;
use stillbase::session::scenario::{Scenario, Task, TaskKind};
use stillbase::session::{Edit, Proposal, Refusal, Run, TimedEdit, improvements, proposals, replay};
use stillbase::settings::change::{join, single_change, value};
use stillbase::settings::word::Choice as _;
use toml::Table;

use crate::support::{Noise, family_machine, random};

/// Reads the settings of a proposal as the command line does.
fn typed(proposal: &Proposal) -> Table {
    proposal.settings().iter().fold(Table::new(), |all, setting| {
        let (key, text) = setting.split_once('=').expect("KEY=VALUE");
        join(all, &single_change(key, value(text)))
    })
}

/// Returns the proposals for a scenario that is refused; each starts when its settings are typed.
fn proven(scenario: &Scenario) -> Vec<Proposal> {
    let refusal = Run::new(scenario).expect_err("refused");
    let proposals = proposals(scenario, &refusal);
    for proposal in &proposals {
        let changed = scenario.with_settings(&typed(proposal)).unwrap_or_else(|why| panic!("{proposal:?}: {why}"));
        Run::new(&changed).unwrap_or_else(|why| panic!("{refusal}: {:?}: {why}", proposal.settings()));
    }
    proposals
}

fn set(name: &str, settings: &[(&str, &str)]) -> Scenario {
    let change = settings.iter().fold(Table::new(), |all, (key, text)| join(all, &single_change(key, value(text))));
    Scenario::builtin(name).expect("built in").with_settings(&change).expect("settings")
}

/// A way out of a path drawn by hand keeps the limits of the drives, or says which it exceeds.
#[test]
fn ways_out_of_a_drawn_path_keep_the_limits_or_say_so() {
    let mut seen = 0;
    for time in ["0.2", "0.4", "1"] {
        let case = set("case-3", &[("task.time", time)]);
        let points = (0..=40).map(|i| {
            let share = f64::from(i) / 40.0;
            Vector::new(0.2 + 0.5 * share, 0.55 + 0.25 * (9.0 * share).sin())
        });
        let change = Task::drawing(&points.collect::<Vec<_>>()).expect("points");
        let drawn = case.with_settings(&Table::from_iter([("task".to_owned(), change.into())])).expect("a task");
        for proposal in proven(&drawn) {
            let run = Run::new(&drawn.with_settings(&typed(&proposal)).expect("settings")).expect("proven");
            let exceeded = run.plan().forecast.exceeded_limit;
            assert_eq!(exceeded.is_some(), proposal.text.contains("times its limit"), "{time} s: {proposal:?}");
            seen += usize::from(exceeded.is_some() || proposal.text.contains("times as long"));
        }
    }
    assert!(seen > 0, "no proposal met a limit");
}

/// No other kind turns the base, so another task is proposed only if nothing else leads out.
#[test]
fn a_base_that_is_to_turn_gets_another_task_last() {
    let found = |settings: &[(&str, &str)]| {
        let all = proven(&set("spot-turn", settings));
        all.iter().flat_map(Proposal::settings).collect::<Vec<_>>()
    };
    assert_eq!(found(&[("base.kind", "fixed")]), ["base.kind=free"]);
    assert_eq!(found(&[("base.wheel.inertia", "0.02")]), ["base.wheel=default"]);
    assert_eq!(
        found(&[("base.kind", "fixed"), ("base.wheel.inertia", "0.02")]),
        ["base.kind=free", "base.wheel=default"]
    );
    assert_eq!(found(&[("task.base_turn", "300")]), ["task.cycles=2"]);
    let last = found(&[("task.base_turn", "0")]);
    assert!(last.contains(&"task.kind=zero-momentum".to_owned()), "{last:?}");
}

/// A task without B, as one that turns the base has none, gets a B that can be reached.
#[test]
fn points_that_are_the_same_are_moved_apart() {
    for kind in ["minimum-norm", "zero-momentum"] {
        let scenario = set("spot-turn", &[("task.kind", kind)]);
        let found = proven(&scenario);
        let apart = found.iter().find(|one| one.text.starts_with("take B")).unwrap_or_else(|| panic!("{found:?}"));
        let changed = scenario.with_settings(&typed(apart)).expect("settings");
        let [a, b] = [0, 1].map(|i| changed.task.points()[i]);
        assert!(((a - b).norm() - 0.1).abs() < 0.05, "{kind}: {apart:?}");
        assert!(Run::new(&changed).is_ok());
    }
}

fn texts(proposals: &[Proposal]) -> Vec<&str> {
    proposals.iter().map(|proposal| proposal.text.as_str()).collect()
}

#[test]
fn a_b_without_the_points_proposes_another_b_and_the_task_turned() {
    let found = proven(&set("case-3", &[("task.b", "0.2")]));
    assert!(
        texts(&found)[..2] == ["take b = 2.2158 rad", "keep b = 0.2000 rad, and turn the task with it"],
        "{found:?}"
    );
    assert_eq!(found[0].settings(), ["task.b=2.2158"]);
}

#[test]
fn a_point_past_the_reach_proposes_a_task_of_the_machine() {
    let found = proven(&set("case-3", &[("task.to", "5,5")]));
    let (moves, made) = found.split_at(found.len() - 1);
    assert!(!moves.is_empty() && texts(moves).iter().all(|text| text.starts_with("move B to (")), "{found:?}");
    assert_eq!(texts(made), ["take a task made for this machine"]);
    // Only what changes is stated.
    assert!(made[0].settings().len() < 8, "{:?}", made[0].settings());
}

#[test]
fn a_machine_out_of_balance_proposes_to_balance_it() {
    let scenario = set("case-3", &[("link.5.com", "0.2")]);
    let found = improvements(&scenario);
    assert_eq!(texts(&found), ["balance the machine"]);
    let balanced = scenario.with_settings(&typed(&found[0])).expect("settings");
    assert!(Inertia::of(&balanced.machine).is_balanced(), "{found:?}");
}

/// A torque past its limit: the motion made longer keeps it, and is not much longer than it has to be.
#[test]
fn a_limit_that_is_exceeded_proposes_more_time_and_the_fastest() {
    let scenario = set(
        "case-3",
        &[
            ("task.time", "0.3"),
            ("drive.1.torque_limit", "0.6"),
            ("drive.2.torque_limit", "0.6"),
            ("drive.3.torque_limit", "0.6"),
        ],
    );
    assert!(Run::new(&scenario).expect("it starts").plan().forecast.exceeded_limit.is_some());
    let found = improvements(&scenario);
    let [longer, fastest] = &found[..] else { panic!("{found:?}") };
    assert!(longer.text.contains("times as long") && fastest.text.contains("fastest"), "{found:?}");
    for proposal in &found {
        let run = Run::new(&scenario.with_settings(&typed(proposal)).expect("settings")).expect("it starts");
        assert!(run.plan().forecast.exceeded_limit.is_none(), "{proposal:?}");
    }
    let time = longer.change().expect("settings")["task"]["time"].as_float().expect("a time");
    let shorter = scenario.with_settings(&single_change("task.time", 0.93 * time)).expect("a time");
    assert!(Run::new(&shorter).expect("it starts").plan().forecast.exceeded_limit.is_some(), "{time} s is too long");
}

#[test]
fn a_balanced_machine_on_a_line_proposes_to_run_it_reactionless() {
    let found = improvements(&set("case-1", &[]));
    assert_eq!(texts(&found), ["run it reactionless"]);
    assert!(improvements(&set("case-3", &[])).is_empty(), "nothing to improve");
}

/// Bounds within which no counterweights balance the machine: bounds that do are proposed, and suffice as typed.
#[test]
fn bounds_that_are_too_tight_propose_wider_ones() {
    for settings in [&[("design.heaviest", "0.5")][..], &[("design.heaviest", "2.5"), ("design.clearance", "0.2")]] {
        let scenario = set("case-3", settings);
        let bare = family_machine("nine-link-bare");
        let Err(why) = scenario.design.front(&bare, 2) else { continue };
        let found = relaxations(&why);
        assert!(!found.is_empty() && found.iter().all(|one| one.text.starts_with("use ")), "{why}: {found:?}");
        for proposal in found {
            let changed = scenario.with_settings(&typed(&proposal)).expect("settings");
            changed.design.front(&bare, 2).unwrap_or_else(|why| panic!("{proposal:?}: {why}"));
        }
    }
}

/// Whatever is refused of random machines and tasks, what is proposed starts; nearly everything has a way out.
#[test]
fn what_is_proposed_starts() {
    let mut noise = Noise::of(281);
    let (mut refused, mut without) = (0, BTreeMap::new());
    for _ in 0..80 {
        let kinds = TaskKind::ALL;
        let kind = kinds[noise.between(0.0, kinds.len() as f64) as usize];
        let n = noise.between(2.0, 4.999) as usize;
        let machine = if noise.sign() > 0.0 { random::a_chain(&mut noise, n) } else { random::a_machine(&mut noise) };
        let mut scenario = Scenario { machine, ..Scenario::builtin("case-3").expect("built in") };
        let size = noise.between(0.1, 4.0);
        scenario.task.from = [noise.between(-size, size), noise.between(-size, size)];
        scenario.task.to = [noise.between(-size, size), noise.between(-size, size)];
        scenario.task.b = noise.between(-4.0, 8.0);
        scenario.task.kind = kind;
        if scenario.check("").is_err() {
            continue;
        }
        let Err(why) = Run::new(&scenario) else { continue };
        refused += 1;
        if proven(&scenario).is_empty() {
            let own = stillbase::session::gentle_motion(&scenario.machine).map(|own| Run::new(&own).err());
            *without.entry(format!("{why} / {own:?}")).or_insert(0) += 1;
        }
    }
    let dead_ends: i32 = without.values().sum();
    assert!(refused > 30, "only {refused} are refused: too few to tell");
    assert!(20 * dead_ends <= refused, "{dead_ends} of {refused} without a way out: {without:#?}");
}

/// Values are named in plain words, with the unit of their key, so that a display in other units converts them.
#[test]
fn values_have_plain_names_and_units_that_a_notation_converts() {
    use stillbase::picture::notation::{LengthUnit, Notation};
    use stillbase::session::{proposals_for_settings, proposals_for_values};

    let case = set("case-3", &[]);
    let text = |key: &str, wanted: &str| {
        let found = proposals_for_settings(&case, &single_change(key, value(wanted)));
        found.first().unwrap_or_else(|| panic!("{key} = {wanted} has no way out")).text.clone()
    };
    let short = text("task.time", "1e-9");
    assert!(short.starts_with("take duration from A to B = ") && short.ends_with(" s"), "{short}");
    assert_eq!(text("control.law", "computed-torqu"), "take control law = computed-torque");
    // Both numbers of a point are converted.
    let wanted = single_change("task.from", value("[1, 2e9]"));
    let found = proposals_for_values(&wanted, &|path| case.value(path), &|_| true);
    let notation = Notation { length: LengthUnit::Millimetres, ..Notation::default() };
    let text = &found[0].text;
    assert!(text.starts_with("take point A = 1.0, ") && text.ends_with(" m"), "{text}");
    let shown = notation.sentence(text);
    assert!(shown.starts_with("take point A = 1000, ") && shown.ends_with(" mm"), "{shown}");
}

/// Returns a scenario with an edit before its first step.
fn opened_with(scenario: &Scenario, edits: &[Edit]) -> Scenario {
    let edits = edits.iter().map(|edit| TimedEdit { step: 0, edit: edit.clone() }).collect();
    Scenario { edits, ..scenario.clone() }
}

/// What the command line does with a scenario: its edits, from the first to the last step.
fn simulated(scenario: &Scenario) -> Result<Run, Refusal> {
    replay(&Scenario { duration: Some(0.01), ..scenario.clone() }, |_, _| {})
}

/// Machines drawn by the first edit, and settings that the first edit makes: what is proposed is for what then runs.
#[test]
fn proposals_work_before_the_edits_of_a_scenario() {
    let noise = &mut Noise::of(12);
    let case = |name: &str| Scenario::builtin(name).expect("built in");
    let draw = |template: Template| vec![Edit::Sketch(SketchStep::New { template })];
    let lengths = ["length.l1", "length.l2", "length.l5"];
    let set = |noise: &mut Noise| {
        let key = lengths[(noise.between(0.0, 3.0) as usize).min(2)];
        vec![Edit::set(key, noise.between(0.1, 0.45))]
    };
    let mut scenarios: Vec<Scenario> =
        Template::ALL.into_iter().map(|of| opened_with(&case("case-3"), &draw(of))).collect();
    scenarios.extend((0..12).map(|i| opened_with(&case(["case-1", "case-3"][i % 2]), &set(noise))));
    let (mut refused, mut proposed) = (0, 0);
    for scenario in &scenarios {
        let Err(refusal) = simulated(scenario) else { continue };
        refused += 1;
        for proposal in proposals(scenario, &refusal) {
            proposed += 1;
            let changed = scenario.with_settings(&typed(&proposal)).unwrap_or_else(|why| panic!("{proposal:?}: {why}"));
            changed.check("").unwrap_or_else(|why| panic!("{proposal:?}: {why}"));
            simulated(&changed).unwrap_or_else(|why| panic!("{refusal}: {:?}: {why}", proposal.settings()));
        }
    }
    assert!(refused > 8 && proposed > 8, "{refused} refused, {proposed} proposed");
}
