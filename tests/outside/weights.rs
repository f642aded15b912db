//! Counterweights against HiGHS and SLSQP: with free rotors, over payloads, clear of pins, and within bounds.

use serde_json::{Value, json};
use stillbase::mechanics::counterweights::{
    CounterweightError, CounterweightForm, CounterweightSite, CounterweightSpec, CounterweightStock, FreeRotor,
    Objective, PlacedCounterweights, RotorFreedom, place_weights,
};
use stillbase::mechanics::machine::{Machine, parse, to_toml};

use super::python::answers;
use crate::random::a_chain;
use crate::{Noise, Test, count};

pub const TESTS: &[Test] = tests![scipy_finds_no_better_counterweights];

const SCRIPT: &str = concat!(include_str!("machine.py"), include_str!("weights.py"));

fn one_of(noise: &mut Noise, count: usize) -> usize {
    (noise.between(0.0, count as f64) as usize).min(count - 1)
}

fn is_so(noise: &mut Noise, share: f64) -> bool {
    noise.between(0.0, 1.0) < share
}

/// Chains of one to four drives, and machines with loops.
fn a_bare_machine(noise: &mut Noise) -> Machine {
    let of_file = |text: &str| parse(text, "reference").expect("a machine");
    match one_of(noise, 8) {
        0 => of_file(include_str!("../reference/family/two-drive.toml")),
        1 => of_file(include_str!("../reference/family/nine-link-bare.toml")),
        2 => of_file(include_str!("../reference/family/serial-3r.toml")),
        kind => a_chain(noise, 1 + kind % 4),
    }
}

/// Bounds and objectives of every kind, some of them so narrow that nothing serves.
fn a_question(noise: &mut Noise) -> (Machine, CounterweightSpec) {
    let mut machine = a_bare_machine(noise);
    let n = machine.drives();
    let weight = |noise: &mut Noise| if is_so(noise, 0.5) { noise.between(0.0, 1.0) } else { 0.0 };
    let mut objective = Objective { mass: noise.between(0.05, 1.0), ..Objective::mass() };
    if is_so(noise, 0.7) {
        (objective.inertia, objective.momentum) = (weight(noise), weight(noise));
    }
    let in_joints = machine.spec().drives.iter().any(|drive| drive.on.is_some());
    if !in_joints && is_so(noise, 0.3) {
        objective.torque = 0.1;
        objective.accelerations = (0..n).map(|_| noise.between(0.0, 20.0)).collect();
    }
    if is_so(noise, 0.2) {
        // A rotor that turns so fast the other way that D_k is negative.
        let drive = 1 + one_of(noise, n);
        let [inertia, ratio] = ["inertia", "ratio"].map(|key| format!("drive.{drive}.rotor.{key}"));
        let most = format!("{}", -noise.between(50.0, 600.0));
        machine = machine.set_all([(inertia.as_str(), "0.002"), (ratio.as_str(), &most)]).expect("in range");
        objective.momentum = 1.0;
    }
    let mut sites = Vec::new();
    for (link, part) in machine.resolved_links().iter().enumerate() {
        if is_so(noise, 0.1) {
            continue;
        }
        let (mut from, mut to) = (-noise.between(0.1, 1.0), part.length);
        if is_so(noise, 0.1) {
            // A single place, or on one side alone.
            (from, to) = if is_so(noise, 0.5) { (from, from) } else { (0.0, to) };
        }
        let most = if is_so(noise, 0.5) { noise.between(1.0, 60.0) } else { f64::INFINITY };
        sites.push(CounterweightSite { most, ..CounterweightSite::on_axis(link, from, to) });
    }
    let form = match one_of(noise, 6) {
        0 => CounterweightForm::Ring(noise.between(0.0, 0.06)),
        1 => CounterweightForm::HalfRing(noise.between(0.0, 0.06)),
        2 => CounterweightForm::HalfRing(0.0),
        3 => CounterweightForm::Box(noise.between(0.01, 0.1)),
        _ => CounterweightForm::Disc,
    };
    let stock = CounterweightStock { form, ..CounterweightStock::discs(7850.0, noise.between(0.005, 0.05)) };
    let mut asked = CounterweightSpec::least(objective, sites, stock);
    asked.max_added_mass = is_so(noise, 0.2).then(|| noise.between(2.0, 60.0));
    asked.max_inertia = is_so(noise, 0.2).then(|| noise.between(0.5, 8.0));
    // Masses beside their links, and discs that may lie there, too.
    let is_beside = is_so(noise, 0.4);
    if is_beside {
        for (j, site) in asked.sites.iter_mut().enumerate() {
            site.across = if is_so(noise, 0.8) { noise.between(0.02, 0.3) } else { 0.0 };
            let key = format!("link.{}.com_normal", machine.links()[site.link].name);
            if j % 2 == 0 {
                machine = machine.set(&key, &format!("{}", noise.between(-0.03, 0.03))).expect("in range");
            }
        }
    }
    asked.clearance = (machine.links().len() < 5 && is_so(noise, 0.4)).then(|| noise.between(0.0, 0.08));
    if !is_beside && is_so(noise, 0.3) {
        let low = if is_so(noise, 0.5) { 0.0 } else { noise.between(0.0, 0.5) };
        let wide = if is_so(noise, 0.2) { 0.0 } else { noise.between(0.0, 1.0) };
        asked.payload = Some([low, low + wide]);
    }
    if is_so(noise, 0.4) {
        let drive = one_of(noise, n);
        if is_so(noise, 0.5) {
            let low = if is_so(noise, 0.5) { 0.0 } else { noise.between(0.0, 0.01) };
            let free = RotorFreedom::Inertia([low, low + noise.between(0.0, 0.05)]);
            let ratio = noise.sign() * noise.between(1.0, 60.0);
            machine = machine.set(&format!("drive.{}.rotor.ratio", drive + 1), &format!("{ratio}")).expect("in range");
            asked.rotors.push(FreeRotor { drive, parameter: free });
        } else {
            let (low, wide) = (noise.between(-200.0, 100.0), noise.between(0.0, 200.0));
            machine = machine
                .set_all([
                    (format!("drive.{}.rotor.inertia", drive + 1).as_str(), "0.002"),
                    (format!("drive.{}.rotor.ratio", drive + 1).as_str(), "-5"),
                ])
                .expect("in range");
            asked.rotors.push(FreeRotor { drive, parameter: RotorFreedom::Ratio([low, low + wide]) });
        }
        if machine.spec().drives[drive].on.is_some() {
            asked.objective.torque = 0.0;
        }
    }
    (machine, asked)
}

fn line(machine: &Machine, asked: &CounterweightSpec, found: Option<&PlacedCounterweights>, seed: usize) -> String {
    let sites = asked
        .sites
        .iter()
        .map(|site| json!([site.link, site.from, site.to, Some(site.most).filter(|x| x.is_finite()), site.across]));
    let rotor = |rotor: &FreeRotor| match rotor.parameter {
        RotorFreedom::Inertia(ends) => json!({ "drive": rotor.drive, "free": "inertia", "ends": ends }),
        RotorFreedom::Ratio(ends) => json!({ "drive": rotor.drive, "free": "ratio", "ends": ends }),
    };
    let Objective { mass, inertia, momentum, torque, accelerations } = &asked.objective;
    let objective = json!({
        "mass": mass, "inertia": inertia, "momentum": momentum, "torque": torque, "accelerations": accelerations,
    });
    let (kind, size) = match asked.stock.form {
        CounterweightForm::Disc => ("disc", 0.0),
        CounterweightForm::Ring(inner) => ("ring", inner),
        CounterweightForm::HalfRing(inner) => ("half-ring", inner),
        CounterweightForm::Box(width) => ("box", width),
    };
    let area_per_mass = 1.0 / (asked.stock.density * asked.stock.thickness);
    let stock = json!({ "kind": kind, "size": size, "area_per_mass": area_per_mass });
    json!({
        "machine": to_toml(machine),
        "sites": sites.collect::<Vec<_>>(),
        "stock": stock,
        "objective": objective,
        "most_mass": asked.max_added_mass,
        "most_inertia": asked.max_inertia,
        "clearance": asked.clearance,
        "rotors": asked.rotors.iter().map(rotor).collect::<Vec<_>>(),
        "payload": asked.payload,
        "found": found.map(|found| to_toml(&found.machine)),
        "seed": seed,
    })
    .to_string()
}

/// What is wrong with an answer, by what SciPy says of it.
fn wrong(
    asked: &CounterweightSpec,
    ours: &Result<PlacedCounterweights, CounterweightError>,
    theirs: &Value,
) -> Vec<String> {
    let (low, high, worst) = (theirs["low"].as_f64(), theirs["high"].as_f64(), theirs["worst"].as_f64());
    let mut all = Vec::new();
    let mut hold = |is_so: bool, what: String| {
        if !is_so {
            all.push(what);
        }
    };
    let placed = match ours {
        Ok(placed) => placed,
        Err(why) => {
            use CounterweightError::{Conflict, OffAxis, Reaches, TooFew, Untouched};
            let is_range = asked.payload.is_some();
            // What no disc touches is refused, though over a range of payloads it might be left as it is.
            let is_right = match why {
                Untouched { .. } => is_range || high.is_none(),
                Conflict { .. } | OffAxis { .. } | Reaches { .. } | TooFew => high.is_none(),
                _ => false,
            };
            hold(is_right, format!("refused: {why}, SciPy finds {high:?}"));
            return all;
        }
    };
    let found = &theirs["found"];
    let number = |key: &str| found[key].as_f64().expect("a number");
    let scale = 1.0 + placed.value.abs();
    hold(
        (number("value") - placed.value).abs() < 1e-7 * scale,
        format!("worth {}, said {}", number("value"), placed.value),
    );
    hold(
        (number("mass") - placed.added_mass).abs() < 1e-9 * scale,
        format!("{} kg, said {}", number("mass"), placed.added_mass),
    );
    hold(number("past") < 3e-6, format!("past bounds by {}", number("past")));
    let Some((low, worst)) = low.zip(worst) else {
        hold(false, "SciPy finds none".into());
        return all;
    };
    hold(
        number("residual") < worst * (1.0 + 1e-6) + 1e-9,
        format!("{} is left, SciPy leaves {worst}", number("residual")),
    );
    // Over payloads what is left may be more by the solver's rounding, and with it the value less.
    let part = if asked.payload.is_some() { 1e-5 } else { 2e-6 };
    hold(placed.value > low - part * scale, format!("{} is below the bound {low}", placed.value));
    let bound = placed.value - placed.gap;
    if let Some(high) = high {
        hold(bound < high + part * scale, format!("{} less {} is above SciPy's {high}", placed.value, placed.gap));
    }
    // Off the axis, the bound from below leaves out the clearance.
    let is_beside = asked.sites.iter().any(|site| site.across > 0.0);
    if asked.objective.momentum == 0.0 && !(is_beside && asked.clearance.is_some()) {
        hold(bound < low + part * scale, format!("{} less {} is above {low}", placed.value, placed.gap));
        hold(placed.gap < part * scale, format!("a gap of {} without need", placed.gap));
    }
    all
}

/// What is found is within its bounds and comes to what is said, by the laws in NumPy; HiGHS finds the same least value,
/// and SLSQP nothing below it less its gap. What is refused SciPy does not find either.
fn scipy_finds_no_better_counterweights() {
    let mut noise = Noise::of(count("SEED", 71));
    let questions: Vec<_> = (0..count("WEIGHTS", 16)).map(|_| a_question(&mut noise)).collect();
    let ours: Vec<_> = questions.iter().map(|(machine, asked)| place_weights(machine, asked)).collect();
    let lines = questions.iter().zip(&ours).enumerate();
    let lines: Vec<String> =
        lines.map(|(i, ((machine, asked), ours))| line(machine, asked, ours.as_ref().ok(), i)).collect();
    let theirs = answers(SCRIPT, &lines);
    assert_eq!(theirs.len(), lines.len());
    let mut all = Vec::new();
    for (i, ((machine, asked), (ours, theirs))) in questions.iter().zip(ours.iter().zip(&theirs)).enumerate() {
        let what = wrong(asked, ours, theirs);
        if !what.is_empty() {
            let said = ours.as_ref().map(|placed| (placed.value, placed.gap));
            all.push(format!("{i}, {}: {}\n  {asked:?}\n  {said:?}\n  {theirs}", machine.name(), what.join("; ")));
        }
    }
    let done = ours.iter().filter(|ours| ours.is_ok()).count();
    println!("{} questions, {done} answered, {} wrong", questions.len(), all.len());
    assert!(3 * done > questions.len(), "{done}");
    assert!(all.is_empty(), "{}", all.join("\n"));
}
