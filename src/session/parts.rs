//! Edits of the parts of links: one more, one less, another material, and typed numbers that follow from parts again.

use stillbase_mechanics::machine::{
    Hole, LinkNumber, Lump, MATERIALS, Machine, MachineSpec, Material, Part, PartSource,
};
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
/// Usual diameter of a new hole, m, and where along a bar one is tried, as shares of the bar.
const HOLE_M: f64 = 0.006;
const HOLE_SHARES: [f64; 7] = [0.5, 0.25, 0.75, 0.125, 0.875, 0.375, 0.625];

/// Returns a new part of a shape from the root to the tip of a link of a length, m.
pub fn new_part(link: &str, shape: Shape, length: f64) -> Part {
    let given = |key: &str, length: f64| shape.lengths().contains(&key).then_some(length);
    let half = 0.5 * WIDTH_M;
    Part {
        link: link.to_owned(),
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
    }
}

/// Returns the edit that adds a part of a shape to a link, counted from 0, from its root to its tip.
pub fn add_part(machine: &Machine, link: usize, shape: Shape) -> Edit {
    let (name, length) = (&machine.spec().links[link].name, machine.resolved_links()[link].length);
    let mut parts = machine.spec().parts.clone();
    parts.push(new_part(name, shape, length));
    Edit::Set { change: list("part", &parts) }
}

/// Sets a length of a part by its key, m.
pub fn set_length(part: &mut Part, key: &str, metres: f64) {
    let own = match key {
        "width" => &mut part.width,
        "thickness" => &mut part.thickness,
        "diameter" => &mut part.diameter,
        "height" => &mut part.height,
        _ => &mut part.wall,
    };
    *own = Some(metres);
}

/// Returns the edit that adds a lump to the tip of a link, counted from 0.
pub fn add_lump(machine: &Machine, link: usize) -> Edit {
    let mut lumps = machine.spec().lumps.clone();
    lumps.push(new_lump(&machine.spec().links[link].name, PlaceOnLink::Named("tip".into()), 0.0));
    Edit::Set { change: list("lump", &lumps) }
}

/// Returns a new lump on a link, along it and to the left of its axis, m.
pub fn new_lump(link: &str, at: PlaceOnLink, across: f64) -> Lump {
    Lump { link: link.to_owned(), name: String::new(), mass: LUMP_KG, at, across, inertia: 0.0 }
}

/// Returns the edit that moves a lump, counted from 0, to a position along its link and to the left of the link's axis,
/// m.
pub fn move_lump(lump: usize, [at, across]: [f64; 2]) -> Edit {
    let place = Table::from_iter([("at".into(), at.into()), ("across".into(), across.into())]);
    Edit::of("lump", Table::from_iter([((lump + 1).to_string(), Value::from(place))]))
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

/// Returns the edit that changes a part, counted from 0: its material, its name, its ends, its holes or its corners.
pub fn change_part(machine: &Machine, part: usize, change: impl FnOnce(&mut Part)) -> Edit {
    let mut parts = machine.spec().parts.clone();
    if let Some(part) = parts.get_mut(part) {
        let before = part.clone();
        change(part);
        if *part != before {
            *part = part.clone().changed_by_hand();
        }
    }
    Edit::Set { change: list("part", &parts) }
}

/// Returns a new hole for a part, counted from 0: the first of some places along it that other holes leave free. `None`
/// for a part that does not exist.
pub fn hole_of(machine: &Machine, part: usize) -> Option<Hole> {
    let own = machine.spec().parts.get(part)?;
    let body = machine.part_bodies().iter().find(|body| body.source == PartSource::Part(part))?;
    let [from, to] = body.ends;
    let diameter = HOLE_M.min(0.4 * own.width.unwrap_or(f64::INFINITY));
    let is_free = |x: &f64| {
        let off = |hole: &Hole| (machine.place_on(&own.link, &hole.at).unwrap_or(f64::MAX) - x).hypot(hole.across);
        own.holes.iter().all(|hole| off(hole) > 0.5 * (hole.diameter + diameter))
    };
    let places = HOLE_SHARES.map(|share| from + share * (to - from));
    let places: &[f64] = if own.shape == Shape::Plate { &[body.body.at] } else { &places };
    let at = places.iter().copied().find(is_free).unwrap_or(places[0]);
    let across = if own.shape == Shape::Plate { body.body.across - own.across } else { 0.0 };
    let rounded = |x: f64| (1e4 * x).round() / 1e4;
    Some(Hole { at: PlaceOnLink::Metres(rounded(at)), across: rounded(across), diameter })
}

/// Returns the edit that names a lump, counted from 0.
pub fn name_lump(machine: &Machine, lump: usize, name: String) -> Edit {
    let mut lumps = machine.spec().lumps.clone();
    if let Some(lump) = lumps.get_mut(lump) {
        lump.name = name;
    }
    Edit::Set { change: list("lump", &lumps) }
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
    materials_beside(&machine.spec().materials)
}

/// Returns the names of the built-in materials, and of those beside them.
pub fn materials_beside(own: &[Material]) -> Vec<&str> {
    let own = own.iter().map(|material| material.name.as_str());
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
