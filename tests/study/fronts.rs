//! The fronts of several machines side by side are those of each alone.

use stillbase::mechanics::counterweights::{
    CounterweightError, CounterweightSite, CounterweightSpec, CounterweightStock, Objective, front,
};
use stillbase::planning::Motion;
use stillbase::query::{ByIdentity, Portion, Query, answer_now};
use stillbase::session::Run;
use stillbase::session::design::DesignBrief;
use stillbase::session::scenario::Scenario;
use stillbase::study::counterweights::{CounterweightRequest, balance_by_weights};
use stillbase::study::front_point::FrontMeasure;
use stillbase::study::fronts::{FrontCase, Fronts, FrontsRequest};

use stillbase::mechanics::machine::{BarStock, Inertia};
use stillbase::study::workshop::{CutRequest, NoCut};

use crate::support::family_machine;

const COUNT: usize = 5;

/// Machines whose links may each carry a disc of at most so many kilograms.
fn asked(names: &[&str], most: f64) -> FrontsRequest {
    let of = |name: &&str| {
        let machine = family_machine(name);
        let sites =
            CounterweightSite::anywhere(&machine).into_iter().map(|site| CounterweightSite { most, ..site }).collect();
        let spec = CounterweightSpec::least(Objective::mass(), sites, CounterweightStock::STEEL);
        FrontCase { name: (*name).to_owned(), machine, spec, bars: None }
    };
    FrontsRequest { machines: names.iter().map(of).collect(), count: COUNT, motion: None, workspace: true }
}

fn motion(name: &str) -> ByIdentity<Motion> {
    let scenario = Scenario::builtin(name).expect("built in");
    Run::new(&scenario).expect("it starts").shared_motion().expect("it is planned")
}

#[test]
fn each_front_is_that_of_its_machine_alone() {
    let motion = motion("case-3");
    let names = ["nine-link-bare", "two-drive"];
    let request = FrontsRequest { motion: Some(motion.clone()), ..asked(&names, f64::INFINITY) };
    let fronts = answer_now::<Fronts>(request.clone());
    assert_eq!(fronts.len(), 2);
    for (found, of) in fronts.iter().zip(&request.machines) {
        let told = found.outcome.as_ref().expect("it can be balanced");
        assert_eq!((&found.name, told.points.len()), (&of.name, COUNT));
        assert_eq!(told.front, front(&of.machine, &of.spec, COUNT).expect("it can be balanced"));
        // A motion of three drives says nothing of a machine of two.
        let own = (of.machine.drives() == 3).then_some(&*motion.0);
        let alone = CounterweightRequest { spec: of.spec.clone(), lengths: None, front: Some(COUNT), bars: None };
        let (_, report) =
            balance_by_weights(&of.machine, &alone, own, &mut |_| true, &|| true).expect("it can be balanced");
        assert_eq!((&told.points, told.measures()), (&report.front_points, report.front));
        assert!(told.points.iter().all(|point| point.torque.is_some() == own.is_some()));
    }
}

#[test]
fn one_brief_is_asked_of_all() {
    let bare = family_machine("nine-link-bare");
    let brief = DesignBrief { heaviest: Some(9.0), behind_root: Some(0.2), ..DesignBrief::default() };
    let of = FrontCase::of("bare", &bare, &brief);
    assert_eq!(of.spec, brief.lightest_problem(&bare));
    let alone = brief.front(&bare, COUNT).expect("it can be balanced");
    // Counterweights of today make no other question.
    let heavy = alone.points[0].machine.clone();
    assert_eq!(FrontCase::of("bare", &heavy, &brief), of);
    let request = FrontsRequest { machines: vec![of], count: COUNT, motion: None, workspace: false };
    let fronts = answer_now::<Fronts>(request);
    let told = fronts[0].outcome.as_ref().expect("it can be balanced");
    assert_eq!((&told.front, told.measures()), (&alone, alone.measures()));
    assert!(told.points.iter().all(|point| point.workspace.is_none()));
    let off: Vec<_> = alone.points.iter().map(|placed| FrontMeasure::OffBy.of(placed, None)).collect();
    assert_eq!(told.points.iter().map(|point| Some(point.residual_if_misplaced)).collect::<Vec<_>>(), off);
}

#[test]
fn a_machine_that_nothing_balances_says_why_and_the_others_stand() {
    let names = ["nine-link-bare", "two-drive", "nine-link-bare"];
    let mut request = asked(&names, f64::INFINITY);
    request.machines[0].spec.max_added_mass = Some(1e-3);
    let fronts = answer_now::<Fronts>(request.clone());
    assert!(matches!(fronts[0].outcome, Err(NoCut::Weights(CounterweightError::Conflict { .. }))));
    assert!(fronts[1].outcome.is_ok() && fronts[2].outcome.is_ok());
    let said = serde_json::to_value(&fronts).expect("plain data");
    let alone = front(&request.machines[0].machine, &request.machines[0].spec, COUNT).expect_err("too light");
    assert_eq!(said[0], serde_json::json!({ "machine": "nine-link-bare", "refused": alone.to_string() }));
    assert_eq!(said[1]["machine"], "two-drive");
    assert_eq!(said[2]["front_points"].as_array().map(Vec::len), Some(COUNT));
    assert!(answer_now::<Fronts>(FrontsRequest { machines: Vec::new(), ..request }).is_empty());
}

#[test]
fn progress_rises_from_portion_to_portion() {
    let mut work = Fronts::begin(asked(&["two-drive", "nine-link-bare"], f64::INFINITY));
    let mut shares = Vec::new();
    loop {
        match work.go_on(&mut |_| true) {
            Portion::More(share) => shares.push(share),
            Portion::Stopped => panic!("nobody stopped it"),
            Portion::Done(fronts) => break assert_eq!(fronts.len(), 2),
        }
    }
    // A portion finds or tells one machine of a front.
    assert!(shares.len() >= 2 * COUNT && shares.is_sorted() && shares.ends_with(&[1.0]), "{shares:?}");
}

/// With bars, each machine of the front carries its counterweights on the bars of the lightest one.
#[test]
fn a_front_on_bars_keeps_the_bars() {
    let mut request = asked(&["nine-link-bare", "two-drive"], f64::INFINITY);
    let bars = CutRequest { stock: BarStock::default(), bought: false };
    for case in &mut request.machines {
        case.bars = Some(bars.clone());
    }
    for (case, found) in request.machines.iter().zip(answer_now::<Fronts>(request.clone())) {
        let measured = found.outcome.expect("a front");
        let cut = bars.balance(&case.machine, &case.spec).expect("bars");
        let points = &measured.front.points;
        assert_eq!(points.len(), COUNT);
        // On these bars, the lightest counterweights are those of the machine as it is cut.
        assert!((points[0].added_mass - cut.placed.added_mass).abs() < 1e-5, "{}", points[0].added_mass);
        for placed in points {
            assert!(Inertia::of(&placed.machine).is_balanced());
            assert_eq!(placed.machine.spec().parts, cut.bars.spec().parts);
            for weight in &placed.machine.spec().counterweights {
                let link = placed.machine.links().iter().position(|link| link.name == weight.link).expect("a link");
                let [from, to] = cut.reach[link];
                assert!((from - 1e-6..=to + 1e-6).contains(&weight.at), "{weight:?} is not on its bar");
            }
        }
    }
}
