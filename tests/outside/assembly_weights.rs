//! Counterweights of whole assemblies against HiGHS, which has the momenta of all bodies in space at random poses.

use std::fmt::Write as _;

use nalgebra::{UnitQuaternion, Vector3};
use serde_json::{Value, json};
use stillbase::mechanics::assembly::{Assembly, parse};
use stillbase::mechanics::counterweights::{
    CounterweightError, CounterweightSite, CounterweightSpec, CounterweightStock, Objective, PlacedCounterweights,
    SpatialGoal, place_in_assembly, reachable_goals,
};
use stillbase::mechanics::machine::{named, to_toml};

use super::python::answers;
use crate::{Noise, Test, count};

pub const TESTS: &[Test] = tests![highs_finds_no_lighter_assembly];

const SCRIPT: &str = concat!(include_str!("machine.py"), include_str!("assembly_weights.py"));

fn is_so(noise: &mut Noise, share: f64) -> bool {
    noise.between(0.0, 1.0) < share
}

fn one_of(noise: &mut Noise, count: usize) -> usize {
    (noise.between(0.0, count as f64) as usize).min(count - 1)
}

/// What keeps blocks from being flat on their pins.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Spread {
    /// Nothing.
    Flat,
    /// Links at several heights.
    Heights,
    /// Mounts beside the pins that carry them.
    Beside,
    /// Both.
    All,
}

/// A chain of one to three drives; where links have heights, each drive has two more bars, above and below.
fn a_machine(noise: &mut Noise, heights: bool) -> String {
    let (n, mut links) = (1 + one_of(noise, 3), String::new());
    for k in 1..=n {
        let at = if k == 1 { "\"base\"".to_owned() } else { format!("{{ link = \"{}\", at = \"tip\" }}", k - 1) };
        let bars: &[(&str, f64)] =
            if heights { &[("", 0.0), ("above", 1.0), ("below", -1.0)] } else { &[("", 0.0), ("bar", 0.0)] };
        for (bar, side) in bars {
            let height = if heights { 0.02 * (k as f64 - 1.0) + side * noise.between(0.02, 0.06) } else { 0.0 };
            let (mass, length) = (noise.between(0.1, 1.0), noise.between(0.2, 0.5));
            let com = noise.between(-0.1, 0.2);
            write!(
                links,
                "[[block.machine.link]]\nname = \"{k}{bar}\"\ndrive = \"{k}\"\nattach = {at}\nlength = {length}\n\
                 mass = {mass}\ninertia = {}\ncom = {com}\naxial = {height}\n",
                0.02 * mass
            )
            .expect("text");
        }
    }
    let drives: String = (1..=n).map(|k| format!("[[block.machine.drive]]\nname = \"{k}\"\n")).collect();
    let angles: String = (1..n)
        .map(|k| {
            let to = k + 1;
            format!("[[block.machine.angle]]\nname = \"a{k}\"\nto = \"{to}\"\nfrom = \"{k}\"\nmin = 0.1\nmax = 3.0\n")
        })
        .collect();
    let held = match heights && is_so(noise, 0.5) {
        true => format!("[block.machine.payload]\nmass = 0.1\naxial = {}\n", noise.between(-0.05, 0.05)),
        false => String::new(),
    };
    format!(
        "[block.machine]\nname = \"chain\"\n{held}[block.machine.end_effector]\nlink = \"{n}\"\nat = \"tip\"\n{drives}\
         {links}{angles}"
    )
}

/// Up to four blocks, some of them carried.
fn an_assembly(noise: &mut Noise, spread: Spread) -> Assembly {
    let blocks = 1 + one_of(noise, 4);
    let mut text = String::from("kind = \"assembly\"\nname = \"random\"\n");
    for i in 0..blocks {
        let on = if i == 0 || is_so(noise, 0.2) { None } else { Some(one_of(noise, i)) };
        let turn = UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| noise.between(-2.0, 2.0)));
        let axes = turn.to_rotation_matrix().into_inner();
        let [x, y]: [[f64; 3]; 2] = [axes.column(0).into_owned().into(), axes.column(1).into_owned().into()];
        let is_beside = on.is_none() || matches!(spread, Spread::Beside | Spread::All);
        let at: [f64; 3] = std::array::from_fn(|_| if is_beside { noise.between(-0.1, 0.1) } else { 0.0 });
        let on = on.map_or_else(|| "base".to_owned(), |on| format!("b{on}"));
        let machine = a_machine(noise, matches!(spread, Spread::Heights | Spread::All));
        write!(text, "[[block]]\nname = \"b{i}\"\non = \"{on}\"\nat = {at:?}\nx = {x:?}\ny = {y:?}\n{machine}")
            .expect("text");
    }
    parse(&text, "random", &named).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// Bounds of places and masses of every link, and what is to be least.
fn a_question(noise: &mut Noise) -> (Assembly, CounterweightSpec) {
    let spread = [Spread::Flat, Spread::Heights, Spread::Beside, Spread::All][one_of(noise, 4)];
    let assembly = an_assembly(noise, spread);
    let (is_narrow, is_heavy) = (is_so(noise, 0.4), is_so(noise, 0.3));
    let mut sites = Vec::new();
    for (i, block) in assembly.blocks().iter().enumerate() {
        for (link, part) in block.machine.resolved_links().iter().enumerate() {
            let share = if is_narrow { noise.between(0.2, 1.0) } else { 1.0 };
            let to = part.length * if is_narrow { noise.between(-0.1, 1.0) } else { 1.0 };
            let most = if is_heavy { noise.between(0.3, 12.0) } else { f64::INFINITY };
            let site = CounterweightSite::on_axis(assembly.first_link(i) + link, -share * part.length, to);
            sites.push(CounterweightSite { most, ..site });
        }
    }
    let objective = match one_of(noise, 3) {
        0 => Objective::inertia(),
        1 => Objective { inertia: noise.between(0.1, 3.0), ..Objective::mass() },
        _ => Objective::mass(),
    };
    (assembly, CounterweightSpec::least(objective, sites, CounterweightStock::STEEL))
}

fn blocks(assembly: &Assembly) -> Value {
    let one = |block: &stillbase::mechanics::assembly::Block| {
        let axes = &block.mount.axes;
        let [x, y]: [[f64; 3]; 2] = [axes.column(0).into_owned().into(), axes.column(1).into_owned().into()];
        let at: [f64; 3] = block.mount.at.into();
        json!({ "machine": to_toml(&block.machine), "on": block.mount.on, "at": at, "x": x, "y": y })
    };
    assembly.blocks().iter().map(one).collect()
}

type Found = Result<PlacedCounterweights<Assembly>, CounterweightError>;

fn line(assembly: &Assembly, asked: &CounterweightSpec, found: &Found, seed: usize) -> String {
    let sites = asked.sites.iter().map(|site| {
        let (block, link) = assembly.link_at(site.link).expect("a link");
        json!([block, link, site.from, site.to, Some(site.most).filter(|x| x.is_finite())])
    });
    json!({
        "blocks": blocks(assembly),
        "sites": sites.collect::<Vec<_>>(),
        "mass": asked.objective.mass,
        "inertia": asked.objective.inertia,
        "mass_per_area": asked.stock.density * asked.stock.thickness,
        "found": found.as_ref().ok().map(|found| blocks(&found.machine)),
        "value": found.as_ref().ok().map(|found| found.value),
        "seed": seed,
    })
    .to_string()
}

/// What is wrong with an answer, by what HiGHS says of it.
fn wrong(goals: &[SpatialGoal], ours: &Found, theirs: &Value) -> Vec<String> {
    let (silent, planar) = (theirs["silent"].as_f64(), theirs["planar"].as_f64());
    let (mut all, is_silent) = (Vec::new(), goals.iter().all(|goal| *goal == SpatialGoal::SILENT));
    let mut hold = |is_so: bool, what: String| {
        if !is_so {
            all.push(what);
        }
    };
    let Ok(placed) = ours else {
        hold(planar.is_none(), format!("refused: {ours:?}, HiGHS finds {planar:?}"));
        return all;
    };
    let near = |a: f64, b: f64| (a - b).abs() < 3e-6 * (1.0 + b.abs());
    hold(silent.is_some() == is_silent, format!("silent {is_silent}, HiGHS finds {silent:?}"));
    let least = if is_silent { silent } else { planar };
    let is_planar = goals.iter().all(|goal| *goal == SpatialGoal::PLANAR);
    match least {
        None => hold(false, "HiGHS finds none".into()),
        Some(least) if is_silent || is_planar => {
            hold(near(placed.value, least), format!("{} not {least}", placed.value))
        }
        Some(least) => hold(placed.value > least * (1.0 - 3e-6), format!("{} below {least}", placed.value)),
    }
    hold(placed.is_certified(), format!("a gap of {}", placed.gap));
    let found = &theirs[if is_silent { "found" } else { "found_planar" }];
    let number = |key: &str| found[key].as_f64().expect("a number");
    hold(number("left") < 1e-9 * (1.0 + placed.machine.mass()), format!("leaves {}", number("left")));
    let inertia = placed.machine.total_momentum();
    hold(near(inertia, number("inertia")), format!("Σ D_k {inertia}, not {}", number("inertia")));
    all
}

/// What is found leaves no momentum in space and comes to what is said. HiGHS finds the same least value of the whole, and
/// the same assemblies that can be silent. What is refused HiGHS does not find either.
fn highs_finds_no_lighter_assembly() {
    let mut noise = Noise::of(count("SEED", 72));
    let questions: Vec<_> = (0..count("ASSEMBLIES", 24)).map(|_| a_question(&mut noise)).collect();
    let ours: Vec<(Vec<SpatialGoal>, Found)> = questions
        .iter()
        .map(|(assembly, asked)| {
            let goals = reachable_goals(assembly, asked);
            let found = place_in_assembly(assembly, asked, &goals);
            (goals, found)
        })
        .collect();
    let lines = questions.iter().zip(&ours).enumerate();
    let lines: Vec<String> = lines.map(|(i, ((assembly, asked), (_, ours)))| line(assembly, asked, ours, i)).collect();
    if let Some(file) = std::env::var_os("STILLBASE_OUTSIDE_LINES") {
        std::fs::write(file, lines.join("\n")).expect("written");
    }
    let theirs = answers(SCRIPT, &lines);
    assert_eq!(theirs.len(), lines.len());
    let (mut all, mut silent) = (Vec::new(), 0);
    for (i, ((goals, ours), theirs)) in ours.iter().zip(&theirs).enumerate() {
        silent += usize::from(goals.iter().all(|goal| *goal == SpatialGoal::SILENT));
        let what = wrong(goals, ours, theirs);
        if !what.is_empty() {
            all.push(format!("{i}: {}\n  {goals:?}\n  {theirs}", what.join("; ")));
        }
    }
    let done = ours.iter().filter(|(_, ours)| ours.is_ok()).count();
    println!("{} questions, {done} answered, {silent} silent, {} wrong", questions.len(), all.len());
    assert!(3 * done > questions.len() && 5 * silent > questions.len() && silent < done, "{done}, {silent}");
    assert!(all.is_empty(), "{}", all.join("\n"));
}
