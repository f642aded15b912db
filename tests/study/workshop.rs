//! Machines that are balanced as they are cut: bars, tails and arms are weighed with the discs that they carry.

use stillbase::exchange::cut::Cut;
use stillbase::exchange::solids::{SolidKind, link_solids};
use stillbase::mechanics::counterweights::{
    CounterweightForm, CounterweightSite, CounterweightSpec, CounterweightStock, Objective,
};
use stillbase::mechanics::machine::{BarStock, Inertia, Machine, MachineError, Part, Shape, builtin};
use stillbase::study::workshop::{
    BarsReport, CutMachine, CutRequest, NoCut, as_bought, balance_as_cut, replaced_links,
};

fn bare() -> Machine {
    builtin("nine-link-bare").expect("built in").clone()
}

fn lightest(machine: &Machine) -> CounterweightSpec {
    let disc = CounterweightStock::discs(7850.0, 0.02);
    CounterweightSpec::least(Objective::mass(), CounterweightSite::anywhere(machine), disc)
}

fn cut(machine: &Machine) -> CutMachine {
    balance_as_cut(machine, &lightest(machine), &BarStock::default()).expect("it can be balanced")
}

/// A machine with one plate instead of the bar of a link, which reaches over all its pins.
fn with_plate(link: &str, [left, right]: [f64; 2]) -> Machine {
    let mut spec = bare().spec().clone();
    spec.parts.push(Part {
        shape: Shape::Plate,
        polygon: vec![[left, -0.02], [right, -0.02], [right, 0.02], [left, 0.02]],
        ..Part::flat(link, 0.005)
    });
    Machine::new(spec).expect("a machine")
}

#[test]
fn bars_reach_over_pins_and_discs_and_no_farther() {
    let found = cut(&bare());
    let machine = &found.placed.machine;
    assert!(Inertia::of(machine).is_balanced() && found.residual.iter().all(|x| *x <= 1e-12), "{:?}", found.residual);
    let mut longest = 0.0_f64;
    for (j, link) in machine.links().iter().enumerate() {
        let bar = machine.spine(j).expect("a bar");
        let [low, high] = machine.part_ends(bar).expect("its ends");
        let discs = machine.spec().counterweights.iter().filter(|weight| weight.link == link.name);
        let [from, to] =
            discs.fold(machine.least_extent(j), |[from, to], weight| [from.min(weight.at), to.max(weight.at)]);
        assert!((low - from).abs() < 1e-8 && (high - to).abs() < 1e-8, "link {}: {low} to {high}", link.name);
        longest = longest.max(machine.least_extent(j)[0] - low).max(high - machine.least_extent(j)[1]);
        assert_eq!(machine.part_holes(bar).len(), machine.resolved_links()[j].pins.len());
        let parts = machine.parts_of_link(j).expect("parts");
        assert!((parts.mass - machine.spec().links[j].mass).abs() < 1e-15, "its mass follows from its bar");
    }
    assert!((found.tail - longest).abs() < 1e-8, "{} but {longest}", found.tail);
}

/// Bars of the lengths that were found, and other lengths: none of them does with less.
#[test]
fn no_share_of_the_tails_is_lighter() {
    let found = cut(&bare());
    let weight = |machine: &Machine| machine.mass();
    for share in [0.0, 0.2, 0.5, 0.9, 1.0] {
        let mut request = lightest(&bare());
        for site in &mut request.sites {
            site.from *= share;
        }
        if let Ok(other) = balance_as_cut(&bare(), &request, &BarStock::default()) {
            let (best, other) = (weight(&found.placed.machine), weight(&other.placed.machine));
            assert!(best <= other + 1e-9, "{best} kg, but {other} kg with {share} of the tails");
        }
    }
}

#[test]
fn what_was_cut_is_cut_the_same_again() {
    let once = cut(&bare());
    let twice = cut(&once.placed.machine);
    let masses = [&once, &twice].map(|found| found.placed.machine.mass());
    assert!((masses[0] - masses[1]).abs() < 1e-9, "{masses:?}");
    assert_eq!(once.placed.machine.spec().parts.len(), twice.placed.machine.spec().parts.len());
    // Another stock replaces the bars that were cut, and not those with a name.
    let wide = BarStock { width: 0.05, ..BarStock::default() };
    let mut spec = once.placed.machine.spec().clone();
    spec.parts[0].name = "my bar".into();
    let named = Machine::new(spec).expect("a machine");
    let again = balance_as_cut(&named, &lightest(&named), &wide).expect("it can be balanced");
    for part in &again.placed.machine.spec().parts {
        let width = if part.name == "my bar" { 0.03 } else { 0.05 };
        assert_eq!(part.width, Some(width), "{}", part.title());
    }
}

#[test]
fn discs_as_bought_leave_what_is_said() {
    let found = cut(&bare());
    let (disc, stock) = (lightest(&bare()).stock, BarStock::default());
    let bought = as_bought(&found, &disc, &stock).expect("a machine");
    let machine = &bought.placed.machine;
    for weight in &machine.spec().counterweights {
        for length in [weight.radius, weight.at] {
            assert!((1e4 * length - (1e4 * length).round()).abs() < 1e-6, "{length} m");
        }
        assert!((weight.mass - disc.mass(weight.shape())).abs() < 1e-12);
    }
    let inertia = Inertia::of(machine);
    assert_eq!(bought.residual, [inertia.force_residual(), inertia.invariance_residual()]);
    assert!(bought.residual[0] > 1e-9 && bought.residual[0] < 1e-2, "{:?}", bought.residual);
    let request = CutRequest { stock, bought: true };
    assert_eq!(request.balance(&bare(), &lightest(&bare())).expect("it can be balanced"), bought);
}

#[test]
fn a_plate_carries_what_lies_on_it() {
    // As long as any disc may need it.
    let long = with_plate("6", [-0.52, 0.52]);
    let found = cut(&long);
    let plates = found.placed.machine.spec().parts.iter().filter(|part| part.shape == Shape::Plate);
    assert_eq!(plates.count(), 1);
    assert!(Inertia::of(&found.placed.machine).is_balanced());
}

#[test]
fn what_cannot_be_cut_is_refused() {
    let machine = bare();
    let holes = BarStock { pin_diameter: 0.04, ..BarStock::default() };
    let refused = balance_as_cut(&machine, &lightest(&machine), &holes).expect_err("holes wider than bars");
    assert!(matches!(&refused, NoCut::Bars(MachineError::Part { .. })), "{refused}");
    assert!(refused.to_string().contains("reaches") || refused.to_string().contains("beyond"), "{refused}");
    let unknown = BarStock { material: "wood".into(), ..BarStock::default() };
    let refused = balance_as_cut(&machine, &lightest(&machine), &unknown).expect_err("an unknown material");
    assert!(refused.to_string().contains("aluminium"), "{refused}");
    let mut request = lightest(&machine);
    request.sites.truncate(1);
    let refused = balance_as_cut(&machine, &request, &BarStock::default()).expect_err("one disc is too few");
    assert!(matches!(refused, NoCut::Weights(_)), "{refused}");
    request.sites[0].link = 99;
    balance_as_cut(&machine, &request, &BarStock::default()).expect_err("no such link");
}

/// Layers and solids take the dimensions of the parts.
#[test]
fn dimensions_fit_the_parts() {
    let stock = BarStock { width: 0.024, thickness: 0.004, pin_diameter: 0.006, ..BarStock::default() };
    let found = balance_as_cut(&bare(), &lightest(&bare()), &stock).expect("it can be balanced");
    let machine = &found.placed.machine;
    let fitted = Cut::default().fitting(machine);
    assert_eq!([fitted.bar_width, fitted.plate_thickness, fitted.pin_diameter], [0.024, 0.004, 0.006]);
    assert_eq!(Cut::default().fitting(&bare()), Cut::default());
    for solid in link_solids(machine, &Cut::default()).iter().filter(|solid| solid.kind == SolidKind::Bar) {
        assert_eq!([solid.plan.radius, solid.thickness], [0.012, 0.004]);
        let ends = machine.part_ends(machine.spine(solid.link).expect("a bar")).expect("its ends");
        assert_eq!(solid.plan.corners.iter().map(|end| end.re).collect::<Vec<_>>(), ends);
    }
}

#[test]
fn links_whose_typed_numbers_give_way_are_named() {
    let once = cut(&bare());
    let names: Vec<String> = bare().spec().links.iter().map(|link| link.name.clone()).collect();
    assert_eq!(once.replaced_links, names);
    let sentence = BarsReport::of(&once).replaced().expect("all links are typed");
    assert!(sentence.contains("typed for links 1, 2, 3") && sentence.contains("their bars"), "{sentence}");
    // Bars that were cut have nothing typed, and links with parts of their own keep their numbers.
    let twice = cut(&once.placed.machine);
    assert_eq!((twice.replaced_links.len(), BarsReport::of(&twice).replaced()), (0, None));
    let plated = replaced_links(&with_plate("4", [-0.1, 0.6]));
    assert!(!plated.contains(&"4".to_owned()) && plated.len() == names.len() - 1, "{plated:?}");
}

/// Bars of thin half rings reach to their walls, and what is weighed balances with them.
#[test]
fn bars_reach_to_the_walls_of_half_rings() {
    let machine = builtin("two-drive").expect("built in").without_counterweights().expect("a machine");
    let form = CounterweightForm::HalfRing(0.1);
    let stock = CounterweightStock { form, ..CounterweightStock::discs(7850.0, 0.02) };
    let spec = CounterweightSpec::least(Objective::mass(), CounterweightSite::anywhere(&machine), stock);
    let found = balance_as_cut(&machine, &spec, &BarStock::default()).expect("it can be balanced");
    let machine = &found.placed.machine;
    assert!(found.residual.iter().all(|x| *x <= 1e-9), "{:?}", found.residual);
    let mut beyond = 0;
    for weight in &machine.spec().counterweights {
        let link = machine.links().iter().position(|link| link.name == weight.link).expect("a link");
        let [from, to] = machine.part_ends(machine.spine(link).expect("a bar")).expect("its ends");
        let wall = weight.circle_at() + weight.outward() * weight.inner_radius;
        assert!(from < wall && wall < to, "link {}: {from} to {to}, wall at {wall}", weight.link);
        beyond += usize::from((wall - weight.at) * weight.outward() > 0.0);
    }
    assert!(beyond > 0, "no centre of mass lies in a bore");
}
