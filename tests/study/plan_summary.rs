//! What a planned task costs, or what is in its way.

use stillbase::mechanics::arm_on_base::FloatingBase;
use stillbase::planning::common::starting_b;
use stillbase::planning::pose_space::PoseSpace;
use stillbase::session::Run;
use stillbase::session::scenario::Scenario;
use stillbase::study::plan_summary::PlanSummary;

fn summary(scenario: &Scenario, base: Option<&FloatingBase>) -> PlanSummary {
    let space = PoseSpace::of(&scenario.machine).expect("it has a b");
    let run = Run::new(scenario);
    PlanSummary::of(scenario, Some(&space), run.as_ref(), base, &mut |_| true).expect("a base")
}

#[test]
fn a_plan_says_what_it_costs() {
    let case = Scenario::builtin("case-3").expect("built in");
    let found = summary(&case, None);
    let cost = found.cost.expect("it can be planned");
    let run = Run::new(&case).expect("it can be planned");
    assert!(found.feasible && found.reason.is_none() && found.obstacle.is_none() && found.has_b);
    assert_eq!((found.b, cost.duration), (run.plan().forecast.b_start, run.planned_time()));
    assert_eq!(cost.peak_torque, run.plan().forecast.torque.to_vec());
    assert!(cost.price.is_none() && cost.peak_base_moment < 1e-9);
    // The start lies in the middle of the widest range that serves all points.
    let space = PoseSpace::of(&case.machine).expect("it has a b");
    let middle = starting_b(&space, &case.task.points()).expect("both are reached");
    assert!(found.b_common.iter().any(|[low, high]| (0.5 * (low + high) - middle).abs() < 1e-12), "{middle}");
}

#[test]
fn a_change_of_b_has_a_price() {
    let change = Scenario::builtin("change-b").expect("built in");
    let base = FloatingBase { mass: 40.0, inertia: 3.0, com: Default::default() };
    let price = |base| summary(&change, base).cost.and_then(|cost| cost.price).expect("b changes");
    let (fixed, floating) = (price(None), price(Some(&base)));
    assert!(fixed.base_turn.is_none() && floating.base_turn.is_some_and(|turn| turn != 0.0));
    assert_eq!((fixed.delta_b, fixed.least_peak), (floating.delta_b, floating.least_peak));
    let run = Run::new(&change).expect("planned");
    let bad = FloatingBase { mass: f64::NAN, ..base };
    assert!(PlanSummary::of(&change, None, Ok(&run), Some(&bad), &mut |_| true).is_err());
}

/// What is in the way is said with what would do, and serialises to the keys of the command line.
#[test]
fn a_refusal_says_what_would_do() {
    let case = Scenario::builtin("case-3").expect("built in");
    let mut change = stillbase::session::scenario::TaskChange::new();
    change.insert("b".into(), 2.9.into());
    change.insert("shape".into(), "line".into());
    let task = case.task.with_change(&change, &case.machine).expect("a task");
    let blocked = Scenario { task, ..case };
    let found = summary(&blocked, None);
    let obstacle = found.obstacle.as_ref().expect("B is on other planes");
    assert!(!found.feasible && found.cost.is_none() && found.b == 2.9);
    assert!(obstacle.feasible_b.is_some_and(|b| (b - 2.9).abs() > 0.1), "{obstacle:?}");
    let json = serde_json::to_value(&found).expect("plain data");
    assert_eq!(json["feasible"], false);
    assert_eq!(json["mending_b"].as_f64(), obstacle.feasible_b);
    assert!(json["reason"].is_string() && json.get("duration").is_none());
    if let Some(blocked) = &obstacle.blocked {
        assert_eq!(json["blocked"]["point"][0], blocked.at.re);
        assert_eq!(json["blocked"]["reason"], blocked.stop.to_string());
    }
}
