//! Counterweights of whole assemblies: what is least is least of the whole, and nothing reaches the base.

use stillbase::mechanics::assembly::{Assembly, BlockState, builtin_assemblies, parse};
use stillbase::mechanics::counterweights::{
    AssemblyFrontSearch, CounterweightError, CounterweightSite, CounterweightSpec, CounterweightStock, Objective,
    PlacedCounterweights, SpatialGoal, place_in_assembly, place_weights, reachable_goals,
};
use stillbase::mechanics::machine::named;
use stillbase::mechanics::planar::{DriveAngles, PerDrive};
use stillbase::query::answer_now;

use crate::support::{Noise, close};

/// A block of a chain: bars of these numbers of drive, kg, centre of mass and height, m, from the tip of the bar before.
fn a_block(name: &str, place: &str, bars: &[(usize, f64, f64, f64)]) -> String {
    let mut text = format!("[[block]]\nname = {name:?}\n{place}\n[block.machine]\nname = {name:?}\n");
    let n = bars.iter().map(|bar| bar.0).max().unwrap_or(1);
    text += &format!("[block.machine.end_effector]\nlink = \"{n}\"\nat = \"tip\"\n");
    (1..=n).for_each(|k| text += &format!("[[block.machine.drive]]\nname = \"{k}\"\n"));
    for (i, (k, mass, com, height)) in bars.iter().enumerate() {
        let link = if bars[..i].iter().any(|bar| bar.0 == *k) { format!("{k}-{i}") } else { k.to_string() };
        let on = if *k == 1 { "\"base\"".to_owned() } else { format!("{{ link = \"{}\", at = \"tip\" }}", k - 1) };
        text += &format!(
            "[[block.machine.link]]\nname = {link:?}\ndrive = \"{k}\"\nattach = {on}\nlength = 0.5\nmass = {mass}\n\
             inertia = 0.01\ncom = {com}\naxial = {height}\n"
        );
    }
    text
}

fn an_assembly(blocks: &[String]) -> Assembly {
    let text = format!("kind = \"assembly\"\nname = \"whole\"\n{}", blocks.concat());
    parse(&text, "whole", &named).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// Every link may carry a counterweight within these places, m.
fn asked(assembly: &Assembly, objective: Objective, [from, to]: [f64; 2]) -> CounterweightSpec {
    let links: usize = assembly.blocks().iter().map(|block| block.machine.links().len()).sum();
    let sites = (0..links).map(|link| CounterweightSite::on_axis(link, from, to)).collect();
    CounterweightSpec::least(objective, sites, CounterweightStock::STEEL)
}

type Found = Result<PlacedCounterweights<Assembly>, CounterweightError>;

fn planar(assembly: &Assembly) -> Vec<SpatialGoal> {
    vec![SpatialGoal::PLANAR; assembly.blocks().len()]
}

fn placed(assembly: &Assembly, spec: &CounterweightSpec) -> Found {
    place_in_assembly(assembly, spec, &reachable_goals(assembly, spec))
}

/// At random states, the largest of the six components that no D_k of a block explains, N or N m: its moment is −D q̈ about
/// its own axis.
fn reaction(assembly: &Assembly) -> f64 {
    let mut noise = Noise::of(9);
    let mut most = 0.0_f64;
    for _ in 0..20 {
        let mut any = |n: usize| PerDrive::from_fn(n, |_| noise.between(-3.0, 3.0));
        let states: Vec<BlockState> = assembly
            .blocks()
            .iter()
            .map(|block| block.machine.drives())
            .map(|n| BlockState { q: DriveAngles(any(n)), qd: any(n), qdd: any(n) })
            .collect();
        let wrench = assembly.loads(&states, |_, _| {}).total();
        let mut moment = wrench.moment;
        for (i, (block, state)) in assembly.blocks().iter().zip(&states).enumerate() {
            let d = assembly.loaded(i).inertia.momenta();
            let own: f64 = d.iter().zip(state.qdd.iter()).map(|(d, qdd)| d * qdd).sum();
            moment += block.mount.axes.column(2) * own;
        }
        most = wrench.force.iter().chain(moment.iter()).fold(most, |most, x| most.max(x.abs()));
    }
    most
}

/// A carrier whose one bar may have a counterweight behind its pin only, with its centre of mass there already: a wrist
/// that is heavier than it need be is what balances it.
#[test]
fn a_heavier_wrist_serves_its_carrier() {
    let blocks = [
        a_block("arm", "", &[(1, 2.0, -0.2, 0.0)]),
        a_block("wrist", "on = \"arm\"\nx = [0, 0, 1]\ny = [1, 0, 0]", &[(1, 0.5, 0.0, 0.0)]),
    ];
    let whole = an_assembly(&blocks);
    let mut spec = asked(&whole, Objective::mass(), [-0.3, 0.3]);
    spec.sites[0].to = 0.0;
    // 2 kg · 0.2 m is held in balance by 0.8 kg at 0.5 m.
    let found = placed(&whole, &spec).expect("it can be balanced");
    close("added mass", &[found.added_mass], &[0.3], 1e-9);
    close("all of it on the wrist", &[found.machine.blocks()[1].inertia.mass()], &[0.8], 1e-9);
    assert!(found.is_certified() && reaction(&found.machine) < 1e-9);
    // Block by block there is no answer: the wrist needs nothing, and then the arm has none.
    let wrist = CounterweightSpec { sites: vec![CounterweightSite { link: 0, ..spec.sites[1] }], ..spec.clone() };
    assert_eq!(place_weights(&whole.blocks()[1].machine, &wrist).expect("balanced").added_mass, 0.0);
    let loaded = whole.blocks()[0].machine.set("payload.mass", "0.5").expect("in range");
    let arm = CounterweightSpec { sites: vec![spec.sites[0]], ..spec };
    assert!(matches!(place_weights(&loaded, &arm), Err(CounterweightError::Conflict { .. })));
}

/// Where each last bar may carry any mass at its end effector, the least mass comes block by block from outside, too.
#[test]
fn the_least_mass_is_that_of_the_outermost_first() {
    let mut noise = Noise::of(31);
    for _ in 0..12 {
        let mut bars = |n: usize| -> Vec<(usize, f64, f64, f64)> {
            (1..=n).map(|k| (k, noise.between(0.2, 2.0), noise.between(-0.3, 0.3), 0.0)).collect()
        };
        let blocks = [
            a_block("arm", "", &bars(2)),
            a_block("elbow", "on = \"arm\"\nx = [0, 1, 0]\ny = [0, 0, 1]", &bars(1)),
            a_block("wrist", "on = \"elbow\"\nx = [0, 0, 1]\ny = [1, 0, 0]", &bars(2)),
        ];
        let whole = an_assembly(&blocks);
        let spec = asked(&whole, Objective::mass(), [-0.5, 0.5]);
        let found = placed(&whole, &spec).expect("it can be balanced");
        assert!(found.is_certified() && reaction(&found.machine) < 1e-8 * found.machine.mass());
        let (mut carried, mut added) = (0.0, 0.0);
        for block in whole.blocks().iter().rev() {
            let machine = block.machine.set("payload.mass", &format!("{carried}")).expect("in range");
            let sites = CounterweightSite::anywhere(&machine);
            let own =
                place_weights(&machine, &CounterweightSpec { sites, ..spec.clone() }).expect("it can be balanced");
            added += own.added_mass;
            carried += block.inertia.mass() + own.added_mass;
        }
        close("added mass", &[found.added_mass], &[added], 1e-7);
        // Of least inertia the whole is never worse than its blocks one by one.
        let quick = placed(&whole, &CounterweightSpec { objective: Objective::inertia(), ..spec }).expect("balanced");
        assert!(quick.machine.total_momentum() <= found.machine.total_momentum() * (1.0 + 1e-9));
    }
}

/// Bars above and below the plane of the arm take the tilt of a wrist that sits above it.
#[test]
fn bars_at_other_heights_keep_the_base_level() {
    let above = "on = \"arm\"\nat = [0, 0, 0.05]\nx = [0, 1, 0]\ny = [0, 0, 1]";
    let wrist = a_block("wrist", above, &[(1, 0.5, 0.1, 0.0)]);
    let flat = an_assembly(&[a_block("arm", "", &[(1, 1.0, 0.2, 0.0)]), wrist.clone()]);
    let spec = asked(&flat, Objective::mass(), [-0.5, 0.5]);
    let goals = reachable_goals(&flat, &spec);
    assert_eq!([goals[0].tilt, goals[0].ground, goals[1].tilt], [false, true, true]);
    let tilted = place_in_assembly(&flat, &spec, &goals).expect("balanced in its plane");
    assert!(tilted.machine.loaded(0).inertia.is_balanced() && reaction(&tilted.machine) > 1e-2);
    let bars = [(1, 1.0, 0.2, 0.0), (1, 0.3, 0.0, 0.1), (1, 0.3, 0.0, -0.1)];
    let layered = an_assembly(&[a_block("arm", "", &bars), wrist]);
    let mut spec = asked(&layered, Objective::mass(), [-0.5, 0.5]);
    // The bars above and below reach less far behind the pin, so that it has a price.
    spec.sites[1..3].iter_mut().for_each(|site| site.from = -0.1);
    let level = placed(&layered, &spec).expect("balanced");
    assert!(reaction(&level.machine) < 1e-9, "{}", reaction(&level.machine));
    let in_plane = place_in_assembly(&layered, &spec, &planar(&layered)).expect("balanced");
    assert!(level.added_mass > in_plane.added_mass + 1e-3 && level.is_certified());
}

/// Two wrists on either side of their pin weigh the same in the end.
#[test]
fn wrists_on_either_side_hold_each_other() {
    let beside = |x: f64| format!("on = \"arm\"\nat = [{x}, 0, 0]\nx = [0, 0, 1]\ny = [1, 0, 0]");
    let whole = an_assembly(&[
        a_block("arm", "", &[(1, 1.0, 0.0, 0.0)]),
        a_block("left", &beside(-0.1), &[(1, 0.5, 0.0, 0.0)]),
        a_block("right", &beside(0.1), &[(1, 0.8, 0.0, 0.0)]),
    ]);
    let spec = asked(&whole, Objective::mass(), [-0.5, 0.5]);
    let found = placed(&whole, &spec).expect("balanced");
    let masses: Vec<f64> = found.machine.blocks().iter().map(|block| block.inertia.mass()).collect();
    close("left", &[masses[1]], &[0.8], 1e-9);
    close("right", &[masses[2]], &[0.8], 1e-9);
    // 1.6 kg at the tip, and as much behind the pin.
    close("added", &[found.added_mass], &[0.3 + 1.6], 1e-9);
    assert!(reaction(&found.machine) < 1e-9);
}

/// Its ends are what each objective alone finds, and no assembly on it is better than another in both.
#[test]
fn the_front_of_the_whole_falls() {
    let whole =
        builtin_assemblies().iter().find(|own| own.name == "carrier-and-wrist").expect("it comes along").clone();
    let spec = asked(&whole, Objective::mass(), [-0.1, 0.1]);
    let mut spec = CounterweightSpec { sites: Vec::new(), ..spec };
    for (i, block) in whole.blocks().iter().enumerate() {
        let own = CounterweightSite::anywhere(&block.machine).into_iter();
        spec.sites.extend(own.map(|site| CounterweightSite { link: whole.first_link(i) + site.link, ..site }));
    }
    let goals = reachable_goals(&whole, &spec);
    let front = answer_now::<AssemblyFrontSearch>((whole.clone(), spec.clone(), goals, 5)).expect("a front").points;
    assert_eq!(front.len(), 5);
    let measures: Vec<[f64; 2]> = front.iter().map(|of| [of.added_mass, of.machine.total_momentum()]).collect();
    assert!(measures.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] > pair[1][1]), "{measures:?}");
    let light = placed(&whole, &spec).expect("balanced");
    let quick = placed(&whole, &CounterweightSpec { objective: Objective::inertia(), ..spec }).expect("balanced");
    close("least mass", &[measures[0][0]], &[light.added_mass], 2e-6);
    close("least inertia", &[measures[4][1]], &[quick.machine.total_momentum()], 2e-6);
    assert!(front.iter().all(|of| of.is_certified() && reaction(&of.machine) < 1e-8));
}

/// A refusal names the block.
#[test]
fn refusals_say_which_block() {
    let whole = an_assembly(&[
        a_block("arm", "", &[(1, 1.0, 0.1, 0.0)]),
        a_block("wrist", "on = \"arm\"", &[(1, 0.5, 0.1, 0.0)]),
    ]);
    let spec = asked(&whole, Objective::mass(), [-0.5, 0.5]);
    let said = |spec: &CounterweightSpec| placed(&whole, spec).expect_err("no answer").to_string();
    let heavy = |most: f64| {
        let sites = spec.sites.iter().map(|site| CounterweightSite { most, ..*site }).collect();
        CounterweightSpec { sites, ..spec.clone() }
    };
    // The wrist wants 0.1 kg at 0.5 m, and the arm 0.8 kg with that.
    assert!(said(&heavy(0.5)).contains("link arm.1: no heavier"), "{}", said(&heavy(0.5)));
    assert!(
        said(&heavy(0.5)).contains("up to 0.800000 kg on each link that is bounded would do"),
        "{}",
        said(&heavy(0.5))
    );
    assert!(said(&heavy(0.05)).contains("link wrist.1: no heavier"), "{}", said(&heavy(0.05)));
    assert!(placed(&whole, &heavy(0.8)).is_ok());
    let none = CounterweightSpec { sites: vec![spec.sites[0]], ..spec.clone() };
    let why = said(&none);
    assert!(why.contains("block wrist: the force balance of drive 1, (7)") && why.contains("wrist.1"), "{why}");
    let ahead = CounterweightSpec {
        sites: spec.sites.iter().map(|site| CounterweightSite { from: 0.1, ..*site }).collect(),
        ..spec.clone()
    };
    assert!(said(&ahead).contains(".1: no further back"), "{}", said(&ahead));
    let range = CounterweightSpec { payload: Some([0.0, 1.0]), ..spec.clone() };
    assert_eq!(placed(&whole, &range), Err(CounterweightError::PayloadOfAssembly));
    let beyond = CounterweightSpec { sites: vec![CounterweightSite::on_axis(2, 0.0, 0.1)], ..spec };
    assert!(said(&beyond).contains("link number 2"), "{}", said(&beyond));
}
