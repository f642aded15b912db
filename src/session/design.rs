//! What follows from a [`Brief`]: the edits of a machine that is kept balanced, and counterweights to take.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use toml::{Table, Value};

use super::edit::Edit;
pub use super::scenario::Brief;
use crate::mechanics::balance::{Adjusted, Body, Hold, Keep, Parameter, Quantity, keep};
use crate::mechanics::counterweights::{
    Disc, Free, FreeRotor, Front, NoWeights, Objective, Placed, Sites, Weighing, front, place,
};
use crate::mechanics::machine::{Counterweight, Drive, Inertia, Length, Link, Machine, MachineSpec};
use crate::session::scenario::Scenario;
use crate::settings::change::{DEFAULT, at, join, leaves, one};

/// What is dear: a kilogram more or less of a counterweight, 1/kg, and a metre that one or a centre of mass moves, 1/m.
const MASS: f64 = 1.0;
const PLACE: f64 = 5.0;

/// What a kilogram counts beside a kg m² of momentum: enough that none is added for nothing.
const GRAM: f64 = 1e-3;

/// A counterweight may be so much further back, m: what found it has rounded.
const ROUNDING: f64 = 1e-6;

impl Brief {
    /// Counterweights like those that a machine has: of a plate of their density, as far back as the farthest of them.
    pub fn of(machine: &Machine) -> Self {
        let weights = &machine.spec().counterweights;
        let plates = weights.iter().filter(|weight| weight.radius > 0.0);
        // What each square metre weighs is all that is known of it: thickness, of steel.
        let thickest = plates
            .map(|weight| weight.mass / (PI * weight.radius.powi(2) * Disc::STEEL.density))
            .fold(None, |thickest: Option<f64>, thickness| {
                Some(thickest.map_or(thickness, |known| known.max(thickness)))
            });
        let length = |link: &str| {
            let place = machine.links().iter().position(|own| own.name == link)?;
            Some(machine.resolved_links()[place].length)
        };
        let is_usual =
            |weight: &Counterweight| length(&weight.link).is_some_and(|length| weight.at >= -length - ROUNDING);
        let back = weights.iter().fold(0.0_f64, |back, weight| back.max(-weight.at));
        Self {
            thickness: thickest.unwrap_or(Disc::STEEL.thickness),
            behind_root: (!weights.iter().all(is_usual)).then_some(back),
            ..Self::default()
        }
    }

    /// A change of a machine as an edit; one that is kept balanced with all that follows from it, each number as little
    /// as it can from where it was in `start`.
    ///
    /// # Errors
    /// If there is no such machine, or none that is balanced: what stands in the way, and what would do.
    pub fn edit(&self, machine: &Machine, start: &Machine, change: &Table) -> Result<Edit, String> {
        self.followed(machine, start, change).map(|change| Edit::Set { change })
    }

    fn followed(&self, machine: &Machine, start: &Machine, change: &Table) -> Result<Table, String> {
        if !self.keep_balanced {
            return Ok(change.clone());
        }
        let changed = machine.with(change).map_err(|why| why.to_string())?;
        let named: Vec<String> = leaves(change).into_iter().map(|(key, _)| key).collect();
        let asked = self.asked(&changed, start, &named);
        let kept = keep(&changed, &asked).map_err(|why| why.to_string())?;
        // All that may follow, whether it has or not: so the next edit of a drag replaces this one.
        let follows = asked.parameters.iter().zip(&kept.values).filter(|(one, _)| one.hold != Hold::Fixed);
        let follows = follows.map(|(one, value)| (one.parameter.key(&changed), *value));
        let discs = kept.machine.spec().counterweights.iter().enumerate();
        let discs = discs.map(|(i, weight)| (format!("counterweight.{}.radius", i + 1), weight.radius));
        Ok(follows.chain(discs).fold(change.clone(), |all, (key, value)| join(all, &one(&key, value))))
    }

    /// What may change: the counterweights of a machine that has some which are not fixed, else the centres of mass of its links.
    fn asked(&self, machine: &Machine, start: &Machine, named: &[String]) -> Keep {
        let spec = machine.spec();
        let free: Vec<(Parameter, &str)> = match spec.counterweights.iter().all(|weight| weight.fixed) {
            true => spec.links.iter().enumerate().map(|(j, link)| (Parameter::com(j), link.name.as_str())).collect(),
            false => {
                let weights = spec.counterweights.iter().enumerate();
                let both = [Quantity::Mass, Quantity::Along];
                weights
                    .flat_map(|(i, weight)| {
                        both.map(|what| (Parameter::new(Body::Counterweight(i), what), weight.link.as_str()))
                    })
                    .collect()
            }
        };
        // Those of the paper are for nine links.
        let penalties = self.penalties.penalty(spec.links.len()).unwrap_or_default();
        let adjusted = |(parameter, link): (Parameter, &str)| {
            let is_fixed = matches!(parameter.body, Body::Counterweight(i) if spec.counterweights[i].fixed);
            let stays = is_fixed || self.fixed.contains(link) || named.contains(&parameter.key(machine));
            Adjusted {
                parameter,
                hold: match (parameter.quantity, parameter.body) {
                    _ if stays => Hold::Fixed,
                    (Quantity::Along, Body::Counterweight(i)) => self.along(machine, start, i),
                    _ => Hold::Free,
                },
                penalty: match (parameter.quantity, parameter.body) {
                    (Quantity::Mass, _) => MASS,
                    (_, Body::Link(j)) => penalties.get(j).copied().unwrap_or(1.0),
                    _ => PLACE,
                },
                from: parameter.value(spec).unwrap_or_default(),
            }
        };
        let mut keep = Keep { parameters: free.into_iter().map(adjusted).collect() };
        for parameter in Parameter::all(machine) {
            let key = parameter.key(machine);
            if let Some(hold) = self.hold.get(&key).filter(|_| !named.contains(&key)) {
                keep.hold(machine, parameter, *hold);
            }
        }
        keep.measured_from(start)
    }

    /// Where a counterweight may go: as far as on the front, and no nearer than where it is.
    fn along(&self, machine: &Machine, start: &Machine, i: usize) -> Hold {
        let weights = [machine, start].map(|machine| machine.spec().counterweights.get(i));
        let link = weights[0].and_then(|weight| machine.links().iter().position(|link| link.name == weight.link));
        let Some(link) = link else { return Hold::Free };
        let length = machine.resolved_links()[link].length;
        let ends = [-self.behind_root.unwrap_or(length), length];
        let within = |[low, high]: [f64; 2], at: f64| [low.min(at), high.max(at)];
        let [low, high] = weights.into_iter().flatten().map(|weight| weight.at).fold(ends, within);
        let clear = weights[0].and_then(|weight| self.clear_of_pins(&machine.resolved_links()[link].pins, weight));
        Hold::Within(clear.map_or([low, high], |[from, to]| [low.max(from), high.min(to)]))
    }

    /// Between which places a counterweight of its present radius stays clear of the pins that it is between, m; none if
    /// it is not clear of them now.
    fn clear_of_pins(&self, pins: &[f64], weight: &Counterweight) -> Option<[f64; 2]> {
        let away = self.clearance? + weight.radius;
        let behind = pins.iter().filter(|pin| **pin <= weight.at).fold(f64::NEG_INFINITY, |most, pin| most.max(*pin));
        let ahead = pins.iter().filter(|pin| **pin > weight.at).fold(f64::INFINITY, |least, pin| least.min(*pin));
        let [from, to] = [behind + away, ahead - away];
        (from..=to).contains(&weight.at).then_some([from, to])
    }

    /// Counterweights that balance the links alone: what less inertia costs in mass, in so many machines.
    ///
    /// # Errors
    /// If nothing within the bounds balances it.
    pub fn front(&self, machine: &Machine, count: usize) -> Result<Front, NoWeights> {
        front(machine, &self.weighing(machine), count)
    }

    /// Counterweights, and ratios of rotors, with which what the drives give to the base, Σ |D_k|, is least.
    ///
    /// # Errors
    /// If nothing within the bounds balances the machine.
    pub fn stillest(&self, machine: &Machine) -> Result<Placed, NoWeights> {
        let objective = Objective { momentum: 1.0, mass: GRAM, ..Objective::mass() };
        let drives = machine.spec().drives.iter().enumerate();
        let rotors = drives.filter_map(|(drive, of)| {
            let ends = *self.ratio.get(&of.name)?;
            Some(FreeRotor { drive, free: Free::Ratio(ends) })
        });
        place(machine, &Weighing { objective, rotors: rotors.collect(), ..self.weighing(machine) })
    }

    /// What is asked of counterweights of a machine: the lightest.
    pub fn weighing(&self, machine: &Machine) -> Weighing {
        let spec = machine.spec();
        let free = machine.resolved_links().iter().enumerate();
        let sites = free.filter(|(link, _)| !self.fixed.contains(&spec.links[*link].name)).map(|(link, part)| Sites {
            link,
            from: -self.behind_root.unwrap_or(part.length),
            to: part.length,
            most: self.heaviest.unwrap_or(f64::INFINITY),
        });
        Weighing {
            clearance: self.clearance,
            payload: self.payload,
            ..Weighing::least(Objective::mass(), sites.collect(), self.disc())
        }
    }
}

/// The edit that makes a link so long, m; with it all that share its length.
pub fn length_of(link: &Link, to: f64) -> Edit {
    match &link.length {
        Length::Named(name) => Edit::at(&["length", name], to),
        Length::Metres(_) => Edit::at(&["link", &link.name, "length"], to),
    }
}

/// A change of the brief of a scenario; where a machine that is not balanced is kept so from now on, with what balances it.
///
/// # Errors
/// If the brief cannot be changed so, or nothing balances the machine: what stands in the way, and what would do.
pub fn briefed(scenario: &Scenario, change: &Table) -> Result<Edit, String> {
    let next = scenario.with(change).map_err(|why| why.to_string())?;
    let begins = next.design.keep_balanced && !scenario.design.keep_balanced;
    if !begins || Inertia::of(&next.machine).is_balanced() {
        return Ok(Edit::Set { change: change.clone() });
    }
    let follows = next.design.followed(&next.machine, &next.machine, &Table::new())?;
    Ok(Edit::Set { change: join(follows, change) })
}

/// The edit that makes a machine another one with the same links: numbers of these, lengths, and counterweights; none where
/// it is that.
pub fn becoming(scenario: &Scenario, of: &Machine) -> Option<Edit> {
    let (was, is) = (scenario.machine.spec(), of.spec());
    let links = was.links.iter().zip(&is.links).flat_map(|(was, is)| {
        let [before, after] = [was, is].map(|link| Table::try_from(link).unwrap_or_default());
        let keys: BTreeSet<String> = before.keys().chain(after.keys()).cloned().collect();
        let changed = keys.into_iter().filter(|key| before.get(key) != after.get(key));
        // What a file leaves out is nought.
        let value = |key: &str| after.get(key).cloned().unwrap_or_else(|| 0.0.into());
        changed.map(|key| at(&["link", &was.name, &key], value(&key))).collect::<Vec<_>>()
    });
    let lengths = is.lengths.iter().filter(|(name, x)| was.lengths.get(*name) != Some(x));
    let lengths = lengths.map(|(name, x)| at(&["length", name], *x));
    let change = links.chain(lengths).fold(Table::new(), |all, one| join(all, &one));
    let carries = |spec: &MachineSpec| (spec.counterweights.clone(), spec.payload.mass, spec.drives.clone());
    let change = match weights_of(scenario, of) {
        Edit::Set { change: weights } if carries(was) != carries(is) => join(change, &weights),
        _ => change,
    };
    (!change.is_empty()).then_some(Edit::Set { change })
}

/// The edit that gives a machine the counterweights of another, what that holds, with which they balance it, and the
/// ratios of its rotors. How numbers of the counterweights before were held is forgotten where it would be said of others.
pub fn weights_of(scenario: &Scenario, of: &Machine) -> Edit {
    let machine = &scenario.machine;
    let weights = of.spec().counterweights.iter().filter_map(|weight| Value::try_from(weight).ok());
    let change = Table::from_iter([("counterweight".to_owned(), Value::Array(weights.collect()))]);
    let [has, holds] = [machine, of].map(|machine| machine.spec().payload.mass);
    let change = if has == holds { change } else { join(change, &one("payload.mass", holds)) };
    let carriers = |machine: &Machine| -> Vec<String> {
        machine.spec().counterweights.iter().map(|weight| weight.link.clone()).collect()
    };
    let are_others = carriers(machine) != carriers(of);
    let change = match are_others && scenario.design.hold.keys().any(|key| key.starts_with("counterweight.")) {
        true => join(change, &one("design.hold.counterweight", DEFAULT)),
        false => change,
    };
    let ratio = |drive: &Drive| drive.rotor.map(|rotor| rotor.ratio);
    let both = machine.spec().drives.iter().zip(&of.spec().drives);
    let others = both.filter_map(|(was, is)| Some((&is.name, ratio(is).filter(|now| ratio(was) != Some(*now))?)));
    let change = others.fold(change, |all, (name, ratio)| {
        let rotor = Table::from_iter([("ratio".to_owned(), Value::from(ratio))]);
        let drive = Table::from_iter([("rotor".to_owned(), Value::from(rotor))]);
        let named = Table::from_iter([(name.clone(), Value::from(drive))]);
        join(all, &Table::from_iter([("drive".to_owned(), Value::from(named))]))
    });
    Edit::Set { change }
}
