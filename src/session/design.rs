//! Applies a [`DesignBrief`]: edits that keep a machine balanced, and choices of counterweights.

use std::collections::BTreeSet;

use serde::Serialize;
use toml::{Table, Value};

use super::edit::Edit;
use super::proposal::Proposal;
pub use super::scenario::DesignBrief;
use crate::scenario::{Scenario, key_of};
use stillbase_mechanics::balance::{
    Body, BodyQuantity, ListedParameter, Parameter, ParameterBounds, RebalanceRequest, rebalance,
};
use stillbase_mechanics::counterweights::{
    BoundRelaxation, CounterweightError, CounterweightSite, CounterweightSpec, FreeRotor, Front, Objective,
    PlacedCounterweights, RotorFreedom, front, place_weights,
};
use stillbase_mechanics::machine::{
    BarStock, Counterweight, Drive, Inertia, Length, Link, Machine, MachineError, MachineSpec, Material,
};
use stillbase_planning::reactionless::Decimal;
use stillbase_settings::change::{DEFAULT_WORD, at, join, leaves, single_change};
use stillbase_settings::number::ShortNumber;

/// Penalty on a change of the mass of a counterweight, 1/kg.
const MASS_PENALTY_PER_KG: f64 = 1.0;
/// Penalty on a change of the place of a counterweight, 1/m.
const PLACE_PENALTY_PER_M: f64 = 5.0;

/// Weight of mass in the objective, in kg m² of Σ |D_k| for each kg: enough that no useless mass is added.
const MASS_WEIGHT: f64 = 1e-3;

impl DesignBrief {
    /// Returns a change of a machine as an edit. If the machine is kept balanced, the edit also adjusts all free
    /// numbers, each as near as possible to its value in `start`.
    ///
    /// # Errors
    /// If the changed machine is invalid or cannot be balanced. The error states the obstacle and what is feasible.
    pub fn edit(&self, machine: &Machine, start: &Machine, change: &Table) -> Result<Edit, String> {
        self.followed(machine, start, change).map(|change| Edit::Set { change })
    }

    fn followed(&self, machine: &Machine, start: &Machine, change: &Table) -> Result<Table, String> {
        if !self.keep_balanced {
            return Ok(change.clone());
        }
        let changed = machine.with_settings(change).map_err(|why| why.to_string())?;
        let named: Vec<String> = leaves(change).into_iter().map(|(key, _)| key).collect();
        let problem = self.free_numbers(&changed, start, &named);
        let kept = rebalance(&changed, &problem).map_err(|why| why.to_string())?;
        // The edit sets all free numbers, changed or not, so that the next edit of a drag replaces it.
        let follows =
            problem.parameters.iter().zip(&kept.values).filter(|(one, _)| one.bounds != ParameterBounds::Fixed);
        let follows = follows.map(|(one, value)| (one.parameter.key(&changed), *value));
        let weights = kept.machine.spec().counterweights.iter().enumerate();
        let sizes = weights.map(|(i, weight)| {
            let (key, size) = weight.free_size();
            (format!("counterweight.{}.{key}", i + 1), size)
        });
        Ok(follows.chain(sizes).fold(change.clone(), |all, (key, value)| join(all, &single_change(&key, value))))
    }

    /// Returns the numbers that may change: mass and place of counterweights if at least one is not fixed, otherwise
    /// the centres of mass of links. Numbers named by the edit are fixed.
    fn free_numbers(&self, machine: &Machine, start: &Machine, named: &[String]) -> RebalanceRequest {
        let spec = machine.spec();
        let free: Vec<(Parameter, &str)> = match spec.counterweights.iter().all(|weight| weight.fixed) {
            true => spec.links.iter().enumerate().map(|(j, link)| (Parameter::com(j), link.name.as_str())).collect(),
            false => {
                let weights = spec.counterweights.iter().enumerate();
                let all = [BodyQuantity::Mass, BodyQuantity::Along, BodyQuantity::Across];
                let may_leave_axis = |i: usize| self.greatest_across([machine, start], i) > 0.0;
                weights
                    .flat_map(|(i, weight)| {
                        all.map(|what| (Parameter::new(Body::Counterweight(i), what), weight.link.as_str()))
                    })
                    .filter(|(one, _)| match (one.quantity, one.body) {
                        (BodyQuantity::Across, Body::Counterweight(i)) => may_leave_axis(i),
                        _ => true,
                    })
                    .collect()
            }
        };
        // The penalties of the paper are for nine links.
        let penalties = self.penalties.penalty(spec.links.len()).unwrap_or_default();
        let adjusted = |(parameter, link): (Parameter, &str)| {
            let is_fixed = matches!(parameter.body, Body::Counterweight(i) if spec.counterweights[i].fixed);
            let stays = is_fixed || self.fixed.contains(link) || named.contains(&parameter.key(machine));
            ListedParameter {
                parameter,
                bounds: match (parameter.quantity, parameter.body) {
                    _ if stays => ParameterBounds::Fixed,
                    (BodyQuantity::Along, Body::Counterweight(i)) => self.along(machine, start, i),
                    (BodyQuantity::Across, Body::Counterweight(i)) => {
                        let most = self.greatest_across([machine, start], i);
                        ParameterBounds::Within([-most, most])
                    }
                    _ => ParameterBounds::Free,
                },
                penalty: match (parameter.quantity, parameter.body) {
                    (BodyQuantity::Mass, _) => MASS_PENALTY_PER_KG,
                    (_, Body::Link(j)) => penalties.get(j).copied().unwrap_or(1.0),
                    _ => PLACE_PENALTY_PER_M,
                },
                from: parameter.value(spec).unwrap_or_default(),
            }
        };
        let mut keep = RebalanceRequest { parameters: free.into_iter().map(adjusted).collect() };
        for parameter in Parameter::all(machine) {
            let key = parameter.key(machine);
            if let Some(hold) = self.hold.get(&key).filter(|_| !named.contains(&key)) {
                keep.set_bounds(machine, parameter, *hold);
            }
        }
        keep.measured_from(start)
    }

    /// Returns the greatest distance of a counterweight from the axis of its link, m: the bound, or its distance in one
    /// of the machines if that is larger.
    fn greatest_across(&self, machines: [&Machine; 2], i: usize) -> f64 {
        let weights = machines.into_iter().filter_map(|machine| machine.spec().counterweights.get(i));
        weights.map(|weight| weight.across.abs()).fold(self.across, f64::max)
    }

    /// Returns the edit that moves a counterweight, counted from 0, to a position along its link and to the left of the
    /// link's axis, m. It stays as near to the axis as the brief demands.
    pub fn weight_edit(&self, machine: &Machine, i: usize, [at, across]: [f64; 2]) -> Edit {
        let most = self.greatest_across([machine; 2], i);
        let mut place = Table::from_iter([("at".into(), at.into())]);
        if most > 0.0 {
            place.insert("across".into(), across.clamp(-most, most).into());
        }
        Edit::of("counterweight", Table::from_iter([((i + 1).to_string(), Value::from(place))]))
    }

    /// Returns the range of places of a counterweight, m: from its bound behind the root to the length of the link,
    /// widened to include its present place and that in `start`. If it is clear of pins now, it stays clear of them.
    fn along(&self, machine: &Machine, start: &Machine, i: usize) -> ParameterBounds {
        let weights = [machine, start].map(|machine| machine.spec().counterweights.get(i));
        let link = weights[0].and_then(|weight| machine.spec().link_index(&weight.link));
        let Some(link) = link else { return ParameterBounds::Free };
        let length = machine.resolved_links()[link].length;
        let ends = [-self.behind_root.unwrap_or(length), length];
        let within = |[low, high]: [f64; 2], at: f64| [low.min(at), high.max(at)];
        let [low, high] = weights.into_iter().flatten().map(|weight| weight.at).fold(ends, within);
        let clear = weights[0].and_then(|weight| self.clear_of_pins(&machine.resolved_links()[link].pins, weight));
        let [low, high] = clear.map_or([low, high], |[from, to]| [low.max(from), high.min(to)]);
        // Half a ring stays on its side of the root, so that its round side stays where it is.
        ParameterBounds::Within(match weights[0] {
            Some(weight) if weight.half && weight.at < 0.0 => [low, high.min(0.0)],
            Some(weight) if weight.half => [low.max(0.0), high],
            _ => [low, high],
        })
    }

    /// Returns the range of places, m, in which a counterweight of its present shape and distance from the axis stays
    /// clear of the pins on either side. Returns `None` if it is not clear of them now.
    fn clear_of_pins(&self, pins: &[f64], weight: &Counterweight) -> Option<[f64; 2]> {
        let [to_root, to_tip] = weight.clear_along(self.clearance?);
        let behind = pins.iter().filter(|pin| **pin <= weight.at).fold(f64::NEG_INFINITY, |most, pin| most.max(*pin));
        let ahead = pins.iter().filter(|pin| **pin > weight.at).fold(f64::INFINITY, |least, pin| least.min(*pin));
        let [from, to] = [behind + to_root, ahead - to_tip];
        (from..=to).contains(&weight.at).then_some([from, to])
    }

    /// Returns the Pareto front of added mass and inertia by counterweights: `count` machines, or one best in both.
    ///
    /// # Errors
    /// If no counterweights within the bounds balance the machine, or if the request is invalid or the search fails.
    pub fn front(&self, machine: &Machine, count: usize) -> Result<Front, CounterweightError> {
        front(machine, &self.lightest_problem(machine), count)
    }

    /// Returns the counterweights and rotor ratios with the least Σ |D_k|. The angular momentum of the arm about B is
    /// Σ D_k q̇_k, with D_k in kg m².
    ///
    /// # Errors
    /// If none within the bounds balance the machine, or if the request is invalid or the search fails.
    pub fn least_momentum(&self, machine: &Machine) -> Result<PlacedCounterweights, CounterweightError> {
        let objective = Objective { momentum: 1.0, mass: MASS_WEIGHT, ..Objective::mass() };
        let drives = machine.spec().drives.iter().enumerate();
        let rotors = drives.filter_map(|(drive, of)| {
            let ends = *self.ratio.get(&of.name)?;
            Some(FreeRotor { drive, parameter: RotorFreedom::Ratio(ends) })
        });
        place_weights(
            machine,
            &CounterweightSpec { objective, rotors: rotors.collect(), ..self.lightest_problem(machine) },
        )
    }

    /// Returns the bars from which links are cut, and a machine that knows their material.
    ///
    /// # Errors
    /// If the machine is not valid with one more material.
    pub fn stock(&self, machine: &Machine) -> Result<(Machine, BarStock), MachineError> {
        let mut known = machine.spec().known_materials();
        let name = known.find(|(_, density)| *density == self.bar_density).map(|(name, _)| name.to_owned());
        let (machine, material) = match name {
            Some(name) => (machine.clone(), name),
            None => {
                let name = format!("{} kg/m³", ShortNumber(self.bar_density));
                let mut spec = machine.spec().clone();
                spec.materials.push(Material { name: name.clone(), density: self.bar_density });
                (Machine::new(spec)?, name)
            }
        };
        let stock = BarStock {
            width: self.bar_width,
            thickness: self.bar_thickness,
            material,
            pin_diameter: self.pin_diameter,
        };
        Ok((machine, stock))
    }

    /// Returns the brief for the counterweights that a machine has: they may lie as far off the axes as they do.
    #[must_use]
    pub fn fitting(&self, machine: &Machine) -> Self {
        let across = machine.spec().counterweights.iter().map(|weight| weight.across.abs()).fold(self.across, f64::max);
        Self { across, ..self.clone() }
    }

    /// Returns the optimisation problem of the lightest counterweights for a machine, within the bounds of the brief.
    pub fn lightest_problem(&self, machine: &Machine) -> CounterweightSpec {
        let spec = machine.spec();
        let free = machine.resolved_links().iter().enumerate();
        let sites = free.filter(|(link, _)| !self.fixed.contains(&spec.links[*link].name)).map(|(link, part)| {
            CounterweightSite {
                link,
                from: -self.behind_root.unwrap_or(part.length),
                to: part.length,
                across: self.across,
                most: self.heaviest.unwrap_or(f64::INFINITY),
            }
        });
        CounterweightSpec {
            clearance: self.clearance,
            payload: self.payload,
            ..CounterweightSpec::least(Objective::mass(), sites.collect(), self.plate())
        }
    }
}

/// Returns the edit that sets the length of a link, m, and of all links that share it.
pub fn length_edit(link: &Link, to: f64) -> Edit {
    match &link.length {
        Length::Named(name) => Edit::at(&["length", name], to),
        Length::Metres(_) => Edit::at(&["link", &link.name, "length"], to),
    }
}

/// Returns the edit that changes the brief of a scenario. If balance is kept from now on, the edit also balances the
/// machine.
///
/// # Errors
/// If the change is invalid, or nothing balances the machine. The error states the obstacle and what is feasible.
pub fn brief_edit(scenario: &Scenario, change: &Table) -> Result<Edit, String> {
    let next = scenario.with_settings(change).map_err(|why| why.to_string())?;
    let begins = next.design.keep_balanced && !scenario.design.keep_balanced;
    if !begins || Inertia::of(&next.machine).is_balanced() {
        return Ok(Edit::Set { change: change.clone() });
    }
    let follows = next.design.followed(&next.machine, &next.machine, &Table::new())?;
    Ok(Edit::Set { change: join(follows, change) })
}

/// Returns proposals that relax the bounds of a brief for which there are no counterweights; each is sufficient.
pub fn relaxations(why: &CounterweightError) -> Vec<Proposal> {
    let (CounterweightError::Conflict { reliefs, .. }
    | CounterweightError::Reaches { reliefs, .. }
    | CounterweightError::OffAxis { reliefs, .. }) = why
    else {
        return Vec::new();
    };
    // These are the decimals that a refusal prints; they suffice.
    let of_key = |relaxation: &BoundRelaxation| match relaxation {
        BoundRelaxation::Most(mass) => Some(("design.heaviest", Decimal::nearest(*mass, 6), "kg a counterweight")),
        BoundRelaxation::Clearance(length) => Some(("design.clearance", Decimal::nearest(*length, 4), "m from pins")),
        BoundRelaxation::Across(length) => {
            Some(("design.across", Decimal::nearest(*length, 4), "m off the axis of a link"))
        }
        // No key of a brief bounds these.
        BoundRelaxation::Mass(_) | BoundRelaxation::Inertia(_) => None,
    };
    let proposal = |together: &Vec<BoundRelaxation>| {
        let keys = together.iter().map(of_key).collect::<Option<Vec<_>>>()?;
        let text: Vec<String> = keys.iter().map(|(_, value, unit)| format!("{value} {unit}")).collect();
        let change = keys.iter().fold(Table::new(), |all, (key, x, _)| join(all, &single_change(key, x.value())));
        Some(Proposal::new(format!("use {}", text.join(" and ")), change))
    };
    reliefs.iter().filter_map(proposal).collect()
}

/// Returns the least change of the free numbers that balances the machine of a scenario; `None` if there is none.
pub(super) fn balancing_change(scenario: &Scenario) -> Option<Table> {
    let brief = DesignBrief { keep_balanced: true, ..scenario.design.clone() };
    brief.followed(&scenario.machine, &scenario.machine, &Table::new()).ok()
}

/// Returns the edit that turns the machine into another one with the same links. It sets the properties of links, the
/// lengths, the parts, the counterweights, the payload mass and the rotor ratios. Returns `None` if nothing differs.
pub fn machine_edit(scenario: &Scenario, of: &Machine) -> Option<Edit> {
    let (was, is) = (scenario.machine.spec(), of.spec());
    let links = was.links.iter().zip(&is.links).flat_map(|(was, is)| {
        let [before, after] = [was, is].map(|link| Table::try_from(link).unwrap_or_default());
        let keys: BTreeSet<String> = before.keys().chain(after.keys()).cloned().collect();
        // Keys such as the direction of a link are no settings.
        let is_setting = |key: &String| key_of(&format!("link.{}.{key}", was.name)).is_some();
        let changed = keys.into_iter().filter(|key| before.get(key) != after.get(key)).filter(is_setting);
        // An omitted key has its default.
        let value = |key: &str| after.get(key).cloned().unwrap_or_else(|| DEFAULT_WORD.into());
        changed.map(|key| at(&["link", &was.name, &key], value(&key))).collect::<Vec<_>>()
    });
    let lengths = is.lengths.iter().filter(|(name, x)| was.lengths.get(*name) != Some(x));
    let lengths = lengths.map(|(name, x)| at(&["length", name], *x));
    let change = links.chain(lengths).fold(Table::new(), |all, one| join(all, &one));
    let carries = |spec: &MachineSpec| (spec.counterweights.clone(), spec.payload.mass, spec.drives.clone());
    let change = match counterweights_edit(scenario, of) {
        Edit::Set { change: weights } if carries(was) != carries(is) => join(change, &weights),
        _ => change,
    };
    let lists =
        [("material", lists_of(was, is, |spec| &spec.materials)), ("part", lists_of(was, is, |spec| &spec.parts))];
    let lists = lists.into_iter().filter_map(|(key, list)| Some(Table::from_iter([(key.to_owned(), list?)])));
    let change = lists.fold(change, |all, one| join(all, &one));
    (!change.is_empty()).then_some(Edit::Set { change })
}

/// Returns a list of a machine as a value if it differs from that of another.
fn lists_of<T: Serialize + PartialEq>(
    was: &MachineSpec,
    is: &MachineSpec,
    list: impl Fn(&MachineSpec) -> &Vec<T>,
) -> Option<Value> {
    (list(was) != list(is)).then(|| Value::try_from(list(is)).ok()).flatten()
}

/// Returns the edit that gives a machine the counterweights, the payload mass and the rotor ratios of another. If
/// the counterweights are on other links, the bounds of the brief on their masses and places are removed.
pub fn counterweights_edit(scenario: &Scenario, of: &Machine) -> Edit {
    let machine = &scenario.machine;
    let weights = of.spec().counterweights.iter().filter_map(|weight| Value::try_from(weight).ok());
    let change = Table::from_iter([("counterweight".to_owned(), Value::Array(weights.collect()))]);
    let [has, holds] = [machine, of].map(|machine| machine.spec().payload.mass);
    let change = if has == holds { change } else { join(change, &single_change("payload.mass", holds)) };
    let carriers = |machine: &Machine| -> Vec<String> {
        machine.spec().counterweights.iter().map(|weight| weight.link.clone()).collect()
    };
    let are_others = carriers(machine) != carriers(of);
    let change = match are_others && scenario.design.hold.keys().any(|key| key.starts_with("counterweight.")) {
        true => join(change, &single_change("design.hold.counterweight", DEFAULT_WORD)),
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
