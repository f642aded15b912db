//! Edits of the parts of links: one more, one less, another material, and typed numbers that follow from parts again.

use stillbase_mechanics::machine::{LinkNumber, Lump, MATERIALS, Machine, MachineSpec, Part, PartSource};
use stillbase_mechanics::machine::{PlaceOnLink, Shape};
use stillbase_settings::change::{DEFAULT_WORD, join, single_change};
use toml::{Table, Value};

use super::Edit;

/// Usual width, thickness and wall of a new part, m, and mass of a new lump, kg.
const WIDTH_M: f64 = 0.03;
const HEIGHT_M: f64 = 0.02;
const THICKNESS_M: f64 = 0.006;
const WALL_M: f64 = 0.002;
const LUMP_KG: f64 = 0.1;

/// Returns the edit that adds a part of a shape to a link, counted from 0, from its root to its tip.
pub fn add_part(machine: &Machine, link: usize, shape: Shape) -> Edit {
    let length = machine.resolved_links()[link].length;
    let given = |key: &str, length: f64| shape.lengths().contains(&key).then_some(length);
    let half = 0.5 * WIDTH_M;
    let part = Part {
        link: machine.spec().links[link].name.clone(),
        name: String::new(),
        shape,
        from: PlaceOnLink::Named("root".into()),
        to: PlaceOnLink::Named("tip".into()),
        across: 0.0,
        material: MATERIALS[0].0.into(),
        width: given("width", WIDTH_M),
        thickness: given("thickness", THICKNESS_M),
        diameter: given("diameter", HEIGHT_M),
        height: given("height", HEIGHT_M),
        wall: given("wall", WALL_M),
        ends: None,
        polygon: match shape {
            Shape::Plate => vec![[0.0, -half], [length, -half], [length, half], [0.0, half]],
            _ => Vec::new(),
        },
        holes: Vec::new(),
    };
    let mut parts = machine.spec().parts.clone();
    parts.push(part);
    Edit::Set { change: list("part", &parts) }
}

/// Returns the edit that adds a lump to the tip of a link, counted from 0.
pub fn add_lump(machine: &Machine, link: usize) -> Edit {
    let mut lumps = machine.spec().lumps.clone();
    lumps.push(Lump {
        link: machine.spec().links[link].name.clone(),
        name: String::new(),
        mass: LUMP_KG,
        at: PlaceOnLink::Named("tip".into()),
        across: 0.0,
        inertia: 0.0,
    });
    Edit::Set { change: list("lump", &lumps) }
}

/// Returns the edit that removes a part or a lump. With the last one of a link, the numbers that followed from it are
/// typed, since they could not follow from nothing.
pub fn remove(machine: &Machine, source: PartSource) -> Edit {
    let mut spec = machine.spec().clone();
    let link = match source {
        PartSource::Part(i) => spec.parts.remove(i).link,
        PartSource::Lump(i) => spec.lumps.remove(i).link,
    };
    let change = match source {
        PartSource::Part(_) => list("part", &spec.parts),
        PartSource::Lump(_) => list("lump", &spec.lumps),
    };
    if spec.has_parts(&link) {
        return Edit::Set { change };
    }
    let typed = |spec: &MachineSpec| -> Table {
        let own = spec.links.iter().filter(|own| own.name == link);
        let numbers = own.flat_map(|own| LinkNumber::ALL.map(|number| (own, number)));
        let follows = numbers.filter(|(own, number)| own.follows(*number));
        follows.map(|(own, number)| (number.key().to_owned(), own.number(number).into())).collect()
    };
    Edit::Set { change: join(change, &of_link(&link, typed(&spec))) }
}

/// Returns the edit that makes a part of another material.
pub fn set_material(machine: &Machine, part: usize, material: &str) -> Edit {
    let mut parts = machine.spec().parts.clone();
    if let Some(part) = parts.get_mut(part) {
        material.clone_into(&mut part.material);
    }
    Edit::Set { change: list("part", &parts) }
}

/// Returns the edit after which numbers of a link, counted from 0, follow from its parts.
pub fn follow_parts(machine: &Machine, link: usize, numbers: &[LinkNumber]) -> Edit {
    let default = |number: &LinkNumber| (number.key().to_owned(), Value::from(DEFAULT_WORD));
    Edit::Set { change: of_link(&machine.spec().links[link].name, numbers.iter().map(default).collect()) }
}

/// Returns the edit that puts the links of a machine at the heights of another with the same links, and its payload.
pub fn set_heights(machine: &Machine, heights: &Machine) -> Edit {
    let links = heights.spec().links.iter().zip(&machine.spec().links);
    let changed = links.filter(|(now, before)| now.axial != before.axial);
    let mut change = Table::new();
    for (link, _) in changed {
        change = join(change, &of_link(&link.name, Table::from_iter([("axial".to_owned(), link.axial.into())])));
    }
    let payload = heights.spec().payload.axial;
    if payload != machine.spec().payload.axial {
        change = join(change, &single_change("payload.axial", payload));
    }
    Edit::Set { change }
}

/// Returns the names of all materials of a machine, the built-in ones first.
pub fn materials(machine: &Machine) -> Vec<&str> {
    let own = machine.spec().materials.iter().map(|material| material.name.as_str());
    MATERIALS.iter().map(|(name, _)| *name).chain(own).collect()
}

fn of_link(link: &str, numbers: Table) -> Table {
    if numbers.is_empty() {
        return Table::new();
    }
    let named = Table::from_iter([(link.to_owned(), Value::from(numbers))]);
    Table::from_iter([("link".to_owned(), Value::from(named))])
}

fn list<T: serde::Serialize>(key: &str, all: &[T]) -> Table {
    let all = all.iter().filter_map(|one| Value::try_from(one).ok()).collect();
    Table::from_iter([(key.to_owned(), Value::Array(all))])
}
