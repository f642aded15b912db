//! Machines that are balanced as they are cut: bars, tails and arms are weighed with the discs that they carry.

use stillbase::exchange::cut::Cut;
use stillbase::exchange::solids::{SolidKind, link_solids};
use stillbase::mechanics::counterweights::{
    BoundRelaxation, CounterweightError, CounterweightForm, CounterweightSite, CounterweightSpec, CounterweightStock,
    Objective, over_payloads, place_weights,
};
use stillbase::mechanics::machine::{BarStock, Inertia, Machine, MachineError, Part, Shape, builtin};
use stillbase::study::workshop::{BarsReport, CutMachine, CutRequest, NoCut, balance_as_cut, replaced_links};

use crate::support::Noise;

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

/// The lightest discs on bars of given ends, placed without the search for bars, with the mass of bars and discs.
fn weight_on(machine: &Machine, request: &CounterweightSpec, reach: &[[f64; 2]]) -> Option<f64> {
    let mut request = request.clone();
    for site in &mut request.sites {
        let [from, to] = reach[site.link];
        (site.from, site.to) = (site.from.max(from), site.to.min(to));
    }
    let bars = machine.with_bars(&BarStock::default(), reach).expect("bars");
    Some(place_weights(&bars, &request).ok()?.machine.mass())
}

/// Bars of random lengths, and those found with each end moved by itself: none of them does with less.
#[test]
fn no_other_bars_of_a_scan_are_lighter() {
    let (machine, request) = (bare(), lightest(&bare()));
    let found = cut(&machine);
    let (best, least) = (found.placed.machine.mass(), |link: usize| machine.least_extent(link));
    let noise = &mut Noise::of(31);
    let random = |noise: &mut Noise| {
        let end = |least: f64, most: f64, noise: &mut Noise| match noise.between(0.0, 3.0) {
            kept if kept < 1.0 => least,
            all if all > 2.5 => most,
            _ => noise.between(least, most),
        };
        let ends = |link: usize, noise: &mut Noise| {
            let ([from, to], site) = (least(link), &request.sites[link]);
            [end(from, site.from.min(from), noise), end(to, site.to.max(to), noise)]
        };
        (0..machine.links().len()).map(|link| ends(link, noise)).collect::<Vec<_>>()
    };
    let mut others: Vec<Vec<[f64; 2]>> = (0..150).map(|_| random(noise)).collect();
    for link in 0..machine.links().len() {
        for share in [0.0, 0.5, 0.9, 1.1, 2.0] {
            let mut reach = found.reach.clone();
            let ([from, to], [low, high]) = (least(link), reach[link]);
            let site = &request.sites[link];
            let low = (from + share * (low - from)).max(site.from.min(from));
            reach[link] = [low, (to + share * (high - to)).min(site.to.max(to))];
            others.push(reach);
        }
    }
    let mut compared = 0;
    for reach in others {
        let Some(other) = weight_on(&machine, &request, &reach) else { continue };
        assert!(best <= other * (1.0 + 1e-7), "{best} kg, but {other} kg with {reach:?}");
        compared += 1;
    }
    assert!(compared > 60, "{compared}");
}

fn inertia_of(machine: &Machine) -> f64 {
    Inertia::of(machine).total_momentum()
}

/// Bounds that bars of all the same share do not meet, but others do.
#[test]
fn bars_are_found_for_bounds_that_need_them() {
    let machine = bare();
    let unbounded = cut(&machine).placed.added_mass;
    let light = CounterweightSpec { max_added_mass: Some(3.0), ..lightest(&machine) };
    let found = balance_as_cut(&machine, &light, &BarStock::default()).expect("lighter than 3 kg");
    assert!((found.placed.added_mass - unbounded).abs() < 1e-5 && unbounded < 3.0, "{}", found.placed.added_mass);
    let quick = CounterweightSpec { max_inertia: Some(1.0), ..lightest(&machine) };
    let found = balance_as_cut(&machine, &quick, &BarStock::default()).expect("quicker than 1 kg m²");
    let inertia = Inertia::of(&found.placed.machine);
    assert!(inertia.is_balanced() && inertia.total_momentum() <= 1.0 + 1e-7, "{}", inertia.total_momentum());
}

/// A request with other bounds, as a person types them after a refusal.
fn relieved(request: &CounterweightSpec, relief: &[BoundRelaxation]) -> CounterweightSpec {
    let mut request = request.clone();
    relief.iter().for_each(|one| match *one {
        BoundRelaxation::Mass(most) => request.max_added_mass = Some(most),
        BoundRelaxation::Inertia(most) => request.max_inertia = Some(most),
        BoundRelaxation::Clearance(clearance) => request.clearance = Some(clearance),
        BoundRelaxation::Most(most) => {
            request.sites.iter_mut().filter(|site| site.most.is_finite()).for_each(|site| site.most = most);
        }
        BoundRelaxation::Across(across) => request.sites.iter_mut().for_each(|site| site.across = across),
    });
    request
}

/// Random bounds: what is found keeps them, a refusal is not contradicted by the best without them, and what is proposed
/// does.
#[test]
fn bounds_of_bars_are_kept_or_refused_with_bounds_that_do() {
    let (machine, stock, noise) = (bare(), BarStock::default(), &mut Noise::of(17));
    let quick = CounterweightSpec { objective: Objective::inertia(), ..lightest(&machine) };
    let least =
        [lightest(&machine), quick.clone()].map(|spec| balance_as_cut(&machine, &spec, &stock).expect("balanced"));
    let [light, quickest] = [least[0].placed.added_mass, inertia_of(&least[1].placed.machine)];
    let (mut kept, mut refused) = (0, 0);
    for round in 0..16 {
        let mut request = if round % 2 == 0 { lightest(&machine) } else { quick.clone() };
        match round % 4 {
            0 | 1 => request.max_added_mass = Some(light * noise.between(0.7, 1.5)),
            2 => request.max_inertia = Some(quickest * noise.between(0.8, 1.4)),
            _ => {
                request.max_added_mass = Some(light * noise.between(0.9, 2.0));
                request.max_inertia = Some(quickest * noise.between(0.9, 1.6));
            }
        }
        if round % 3 == 0 {
            request.sites.iter_mut().for_each(|site| site.most = noise.between(0.4, 3.0));
        }
        match balance_as_cut(&machine, &request, &stock) {
            Ok(found) => {
                kept += 1;
                assert_eq!(request.broken_by(&found.placed.machine), []);
                let (added, inertia) = (found.placed.added_mass, inertia_of(&found.placed.machine));
                assert!(request.max_added_mass.is_none_or(|most| added <= most * (1.0 + 1e-7)), "{added} kg");
                assert!(request.max_inertia.is_none_or(|most| inertia <= most * (1.0 + 1e-7)), "{inertia} kg m²");
            }
            Err(NoCut::Bounds { why, .. }) => {
                refused += 1;
                let is_alone = request.sites.iter().all(|site| site.most.is_infinite());
                let of_mass = is_alone && request.max_inertia.is_none();
                assert!(!of_mass || request.max_added_mass.is_some_and(|most| most < light * (1.0 + 1e-6)), "{why}");
                let of_inertia = is_alone && request.max_added_mass.is_none();
                assert!(!of_inertia || request.max_inertia.is_some_and(|most| most < quickest * (1.0 + 1e-6)), "{why}");
                let CounterweightError::Conflict { reliefs, .. } = &why else { panic!("{why}") };
                assert!(!reliefs.is_empty(), "{why}");
                for relief in reliefs {
                    let wider = relieved(&request, relief);
                    balance_as_cut(&machine, &wider, &stock)
                        .unwrap_or_else(|other| panic!("{why}: {relief:?}: {other}"));
                }
            }
            Err(why) => panic!("{why}"),
        }
    }
    assert!(kept > 3 && refused > 3, "{kept} kept, {refused} refused");
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

/// Radii and places are whole steps, and what is left of balance is no more than half steps of all discs and bars leave.
#[test]
fn discs_as_bought_leave_what_is_said() {
    let (exact, request) = (cut(&bare()), lightest(&bare()));
    let (disc, stock) = (request.stock, BarStock::default());
    let bought = CutRequest { stock: stock.clone(), bought: true }.balance(&bare(), &request).expect("balanced");
    let (machine, was) = (&bought.placed.machine, &exact.placed.machine);
    let mut most = 0.0;
    for (weight, before) in machine.spec().counterweights.iter().zip(&was.spec().counterweights) {
        for (length, before) in [(weight.radius, before.radius), (weight.at, before.at)] {
            assert!((1e4 * length - (1e4 * length).round()).abs() < 1e-6, "{length} m");
            assert!((length - before).abs() <= 0.5e-4 + 1e-12, "{length} m, was {before} m");
        }
        let volume = std::f64::consts::PI * weight.radius.powi(2) * disc.thickness;
        assert!((weight.mass - disc.density * volume).abs() < 1e-12, "{} kg", weight.mass);
        // No root and no place is farther from B than the reach.
        most += (weight.mass - before.mass).abs() * bare().reach() + before.mass * 0.5e-4;
        // A bar may end half a step earlier or later.
        most += stock.width * stock.thickness * 2700.0 * 1e-4 * bare().reach();
    }
    let [force, coupling] = bought.residual;
    assert!(force > 1e-9 && force <= most && coupling <= most * bare().reach(), "{force} of {most}, {coupling}");
    // The value is that of the rounded discs, of which nothing is certified.
    let added: f64 = machine.spec().counterweights.iter().map(|weight| weight.mass).sum();
    assert!((bought.placed.value - added).abs() < 1e-12 && (added - exact.placed.added_mass).abs() > 1e-5);
    assert!(exact.placed.is_certified() && !bought.placed.is_certified());
}

/// Bounds that exact discs keep and rounded ones do not are named, and no others.
#[test]
fn bounds_that_rounding_breaks_are_named() {
    let (machine, stock, noise) = (bare(), BarStock::default(), &mut Noise::of(5));
    let mut seen = [0, 0];
    for _ in 0..12 {
        let mut request = lightest(&machine);
        for site in &mut request.sites {
            site.from = -noise.between(0.8, 1.0) * machine.resolved_links()[site.link].length;
        }
        let Ok(loose) = balance_as_cut(&machine, &request, &stock) else { continue };
        request.max_added_mass = Some(loose.placed.added_mass * noise.between(1.0001, 1.003));
        let Ok(bought) = (CutRequest { stock: stock.clone(), bought: true }).balance(&machine, &request) else {
            continue;
        };
        let (weights, rounding) = (&bought.placed.machine.spec().counterweights, bought.rounding.expect("rounded"));
        let mut broken = 0;
        for weight in weights {
            let site =
                request.sites.iter().find(|site| machine.links()[site.link].name == weight.link).expect("a site");
            broken += usize::from(weight.at < site.from - 1e-7 || weight.at > site.to + 1e-7);
        }
        let added: f64 = weights.iter().map(|weight| weight.mass).sum();
        broken += usize::from(added > request.max_added_mass.expect("a bound") + 1e-7);
        assert_eq!(rounding.broken.len(), broken, "{:?}", rounding.broken);
        seen[usize::from(broken > 0)] += 1;
    }
    assert!(seen[1] > 3, "{seen:?}");
}

/// A range of payloads leaves a residual, and still bars and discs agree. The least worst residual is that of the payload
/// alone, so it is the same without bars.
#[test]
fn bars_are_cut_for_a_range_of_payloads() {
    let request = CounterweightSpec { payload: Some([0.0, 0.1]), ..lightest(&bare()) };
    let found = balance_as_cut(&bare(), &request, &BarStock::default()).expect("it can be cut");
    let worst = |machine: &Machine| {
        let ends = over_payloads(machine, [0.0, 0.1], 2).expect("payloads");
        ends.iter().map(|end| end.force.max(end.coupling / machine.reach())).fold(0.0, f64::max)
    };
    let without = place_weights(&bare(), &request).expect("it can be balanced").machine;
    let [bars, plain] = [worst(&found.placed.machine), worst(&without)];
    assert!((bars - plain).abs() < 1e-6 * plain && plain > 1e-3, "{bars} {plain}");
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
