//! A machine at another size has the same counterweights at that size, and is refused for the same reason.

use stillbase::mechanics::counterweights::{
    BoundRelaxation, CounterweightError, CounterweightForm, CounterweightSite, CounterweightSpec, CounterweightStock,
    Objective, PlacedCounterweights, place_weights,
};
use stillbase::mechanics::machine::{Inertia, Machine, builtin, parse, to_toml};
use toml::{Table, Value};

use crate::support::{Noise, family_machine};

/// Factors of lengths and of masses.
#[derive(Clone, Copy, Debug)]
struct Size {
    length: f64,
    mass: f64,
}

impl Size {
    fn inertia(self) -> f64 {
        self.mass * self.length * self.length
    }

    /// Factors between a thousandth and a thousand, with masses, inertias and plates that files may have.
    fn random(noise: &mut Noise) -> Self {
        loop {
            let of = |noise: &mut Noise| 10_f64.powf(noise.between(-3.0, 3.0));
            let size = Self { length: of(noise), mass: 1.0 };
            let size = Self { mass: of(noise) * size.length.powi(2), ..size };
            let plate = size.mass / size.length.powi(2);
            if (1e-9..1e4).contains(&size.mass) && (1e-9..1e5).contains(&size.inertia()) && (1e-2..1e2).contains(&plate)
            {
                return size;
            }
        }
    }

    /// Whether forms may have these sizes.
    fn allows(self, form: CounterweightForm) -> bool {
        match form {
            CounterweightForm::Disc => true,
            CounterweightForm::Ring(inner) | CounterweightForm::HalfRing(inner) => inner * self.length <= 10.0,
            CounterweightForm::Box(width) => (1e-4..=10.0).contains(&(width * self.length)),
        }
    }

    /// The factor of a key of a machine file.
    fn factor(self, key: &str) -> Option<f64> {
        match key {
            "mass" => Some(self.mass),
            "inertia" => Some(self.inertia()),
            "com" | "com_normal" | "length" | "at" | "across" | "radius" => Some(self.length),
            _ => None,
        }
    }

    fn scale(self, value: &mut Value, key: &str) {
        match value {
            Value::Table(table) => table.iter_mut().for_each(|(key, value)| self.scale(value, key)),
            Value::Array(all) => all.iter_mut().for_each(|value| self.scale(value, key)),
            Value::Float(x) => *x *= self.factor(key).unwrap_or(1.0),
            _ => {}
        }
    }

    fn machine(self, machine: &Machine) -> Machine {
        let mut file: Table = to_toml(machine).parse().expect("a file");
        for (key, value) in &mut file {
            match value {
                Value::Table(lengths) if key == "lengths" => {
                    lengths.iter_mut().for_each(|(_, value)| self.scale(value, "length"));
                }
                value => self.scale(value, key),
            }
        }
        parse(&file.to_string(), "another-size.toml").expect("the machine at another size")
    }

    /// The same plate for this size: its mass per area, on which discs depend, grows with mass per length squared.
    fn stock(self, stock: &CounterweightStock) -> CounterweightStock {
        let area = stock.density * stock.thickness * self.mass / self.length.powi(2);
        let thickness = (area / 1000.0).clamp(1e-4, 1.0);
        let form = match stock.form {
            CounterweightForm::Disc => CounterweightForm::Disc,
            CounterweightForm::Ring(inner) => CounterweightForm::Ring(inner * self.length),
            CounterweightForm::HalfRing(inner) => CounterweightForm::HalfRing(inner * self.length),
            CounterweightForm::Box(width) => CounterweightForm::Box(width * self.length),
        };
        CounterweightStock { density: area / thickness, thickness, form }
    }

    fn request(self, request: &CounterweightSpec) -> CounterweightSpec {
        let site = |site: &CounterweightSite| CounterweightSite {
            from: site.from * self.length,
            to: site.to * self.length,
            across: site.across * self.length,
            most: site.most * self.mass,
            ..*site
        };
        let Objective { mass, inertia, momentum, .. } = request.objective;
        // Of a weighted sum, mass and inertia keep their shares.
        let of_inertia = if mass > 0.0 { self.mass / self.inertia() } else { 1.0 };
        let objective =
            Objective { inertia: inertia * of_inertia, momentum: momentum * of_inertia, ..request.objective.clone() };
        CounterweightSpec {
            sites: request.sites.iter().map(site).collect(),
            stock: self.stock(&request.stock),
            objective,
            max_added_mass: request.max_added_mass.map(|most| most * self.mass),
            max_inertia: request.max_inertia.map(|most| most * self.inertia()),
            clearance: request.clearance.map(|clearance| clearance * self.length),
            rotors: request.rotors.clone(),
            payload: request.payload.map(|ends| ends.map(|mass| mass * self.mass)),
        }
    }

    fn relief(self, relief: BoundRelaxation) -> f64 {
        match relief {
            BoundRelaxation::Most(x) | BoundRelaxation::Mass(x) => x / self.mass,
            BoundRelaxation::Inertia(x) => x / self.inertia(),
            BoundRelaxation::Clearance(x) | BoundRelaxation::Across(x) => x / self.length,
        }
    }
}

fn requests(machine: &Machine) -> Vec<CounterweightSpec> {
    let steel = CounterweightStock::STEEL;
    let of = |objective, stock| CounterweightSpec::least(objective, CounterweightSite::anywhere(machine), stock);
    let inertia = || of(Objective::inertia(), steel);
    let form = |form| CounterweightStock { form, ..steel };
    let mixed = Objective { inertia: 5.0, ..Objective::mass() };
    let mut beside = inertia();
    beside.sites.iter_mut().for_each(|site| site.across = 0.1);
    vec![
        of(Objective::mass(), steel),
        inertia(),
        of(mixed, steel),
        of(Objective { mass: 0.1, momentum: 1.0, ..Objective::mass() }, steel),
        of(Objective::inertia(), form(CounterweightForm::Ring(0.01))),
        of(Objective::inertia(), form(CounterweightForm::HalfRing(0.02))),
        of(Objective::inertia(), form(CounterweightForm::Box(0.05))),
        CounterweightSpec { clearance: Some(0.005), ..inertia() },
        CounterweightSpec { payload: Some([0.0, 0.2]), ..inertia() },
        beside,
    ]
}

/// How an objective depends on the counterweights about its minimum.
#[derive(Clone, Copy, PartialEq)]
enum Flatness {
    /// It rises in proportion to the distance.
    None,
    /// It rises with the square of the distance.
    Smooth,
    /// It does not rise in every direction.
    Whole,
}

fn alike(a: f64, b: f64, part: f64) -> bool {
    (a - b).abs() <= part * a.abs().max(b.abs()) + 1e-12
}

/// Checks that an answer is the same at another size.
fn same(of: &PlacedCounterweights, other: &PlacedCounterweights, size: Size, flatness: Flatness, what: &str) {
    let is_flat = flatness == Flatness::Whole;
    for placed in [of, other] {
        assert!(placed.is_certified(), "{what}: {}", placed.gap);
    }
    let balanced = [of, other].map(|placed| Inertia::of(&placed.machine).is_balanced());
    assert!(balanced[0] == balanced[1] && (balanced[0] || is_flat), "{what}: {balanced:?}");
    let [value, scaled] = [of, other].map(|placed| placed.value / placed.unit);
    assert!(alike(value, scaled, 2e-6), "{what}: {value} {scaled}");
    if is_flat {
        return;
    }
    let [inertia, scaled] = [of, other].map(|placed| Inertia::of(&placed.machine).diagonals().iter().sum::<f64>());
    // A value to 2e-6 leaves the place of a smooth minimum to about its root.
    let part = if flatness == Flatness::Smooth { 5e-3 } else { 1e-5 };
    assert!(alike(of.added_mass, other.added_mass / size.mass, part), "{what}: {} {}", of.added_mass, other.added_mass);
    assert!(alike(inertia, scaled / size.inertia(), 1e-6), "{what}: {inertia} {scaled}");
    if flatness == Flatness::Smooth {
        return;
    }
    let [one, two] = [of, other].map(|placed| &placed.machine.spec().counterweights);
    assert_eq!(one.len(), two.len(), "{what}");
    for (one, two) in one.iter().zip(two) {
        let total = of.added_mass;
        assert!((one.mass - two.mass / size.mass).abs() < 1e-4 * total, "{what}, link {}: {one:?} {two:?}", one.link);
        let moment = one.mass * (one.at - two.at / size.length);
        assert!(moment.abs() < 1e-4 * total, "{what}, link {}: {one:?} {two:?}", one.link);
    }
}

#[test]
fn a_machine_at_another_size_has_the_same_counterweights() {
    let noise = &mut Noise::of(41);
    let two = builtin("two-drive").expect("built in").without_counterweights().expect("a machine");
    let mut heavier = two.spec().clone();
    heavier.links[3].mass *= 2.0;
    for machine in [family_machine("nine-link-bare"), Machine::new(heavier).expect("a machine")] {
        for (i, request) in requests(&machine).iter().enumerate() {
            let of = place_weights(&machine, request).unwrap_or_else(|why| panic!("request {i}: {why}"));
            let given = [[1e-2, 1e-6], [1e-3, 1e-7], [0.03, 2.7e-5], [10.0, 1e3], [100.0, 30.0]];
            let given = given.map(|[length, mass]| Size { length, mass });
            let sizes = given.into_iter().chain((0..4).map(|_| Size::random(noise)));
            for size in sizes.filter(|size| size.allows(request.stock.form)) {
                let what = format!("{}, request {i}, {size:?}", machine.name());
                let other = place_weights(&size.machine(&machine), &size.request(request));
                let other = other.unwrap_or_else(|why| panic!("{what}: {why}"));
                // Over payloads, and where momenta cancel, many counterweights are as good.
                let flatness = match (request.payload.is_some() || request.objective.momentum > 0.0, &request.objective)
                {
                    (true, _) => Flatness::Whole,
                    (false, objective) if objective.inertia > 0.0 => Flatness::Smooth,
                    (false, _) => Flatness::None,
                };
                same(&of, &other, size, flatness, &what);
            }
        }
    }
}

#[test]
fn a_machine_at_another_size_is_refused_for_the_same_bounds() {
    let (noise, machine) = (&mut Noise::of(42), family_machine("nine-link-bare"));
    let inertia = CounterweightSpec { objective: Objective::inertia(), ..requests(&machine)[0].clone() };
    for request in [
        CounterweightSpec { max_added_mass: Some(1.0), ..inertia.clone() },
        CounterweightSpec { max_inertia: Some(0.5), ..inertia.clone() },
        CounterweightSpec { clearance: Some(0.2), ..inertia },
    ] {
        let refusal = |size: Size| match place_weights(&size.machine(&machine), &size.request(&request)) {
            Err(CounterweightError::Conflict { bounds, reliefs }) => (bounds, reliefs),
            Err(CounterweightError::Reaches { reliefs, .. }) => (Vec::new(), reliefs),
            other => panic!("{size:?}: {other:?}"),
        };
        let (bounds, reliefs) = refusal(Size { length: 1.0, mass: 1.0 });
        assert!(!reliefs.is_empty());
        for size in [Size { length: 1e-2, mass: 1e-6 }].into_iter().chain((0..3).map(|_| Size::random(noise))) {
            let (other, would) = refusal(size);
            assert_eq!((other.len(), would.len()), (bounds.len(), reliefs.len()), "{size:?}");
            for (one, two) in reliefs.iter().flatten().zip(would.iter().flatten()) {
                let [one, two] = [Size { length: 1.0, mass: 1.0 }.relief(*one), size.relief(*two)];
                // Rounded to two digits of a length, or four of a mass.
                assert!(alike(one, two, 0.1), "{size:?}: {one} {two}");
            }
        }
    }
}
