//! The tables of pins and of the spacers around them.

use super::{PartCell, PartTable, has_heights, on};
use crate::cut::Cut;
use crate::solids::{Axle, Spacer, axles, link_solids};
use stillbase_mechanics::machine::Machine;

/// Columns of what lies between two heights.
const BETWEEN: [&str; 2] = ["from height m", "to height m"];

/// Returns the cells of these columns, with the length between.
fn between(faces: Option<[f64; 2]>) -> [PartCell; 3] {
    let length = faces.map(|[low, high]| high - low);
    [length, faces.map(|[low, _]| low), faces.map(|[_, high]| high)].map(|metres| PartCell::some(metres, 4))
}

/// Lists the pins, with their lengths from face to face if the links have heights. Points of links that coincide in every
/// pose share one pin.
pub fn pins(machine: &Machine, cut: &Cut) -> PartTable {
    let has_heights = has_heights(machine);
    let row = |(i, axle): (usize, Axle)| {
        let places = axle.links.iter().map(|(j, at)| on(machine, *j, *at));
        let joined: Vec<String> = axle.is_on_base().then(|| "base".to_owned()).into_iter().chain(places).collect();
        let name = PartCell::words((i + 1).to_string());
        let cells = [name, PartCell::words(joined.join(" · ")), PartCell::Number(cut.pin_diameter, 4)];
        let stacked = between(axle.faces(machine, cut)).into_iter().filter(|_| has_heights);
        cells.into_iter().chain(stacked).collect()
    };
    let stacked = ["pin length m"].into_iter().chain(BETWEEN).filter(|_| has_heights);
    PartTable {
        kind: "pin",
        title: "Pins",
        head: ["name", "connects", "pin diameter m"].into_iter().chain(stacked).collect(),
        rows: pin_axles(machine).enumerate().map(row).collect(),
    }
}

/// Returns the pins that are made, that at the base first.
pub fn pin_axles(machine: &Machine) -> impl Iterator<Item = Axle> {
    axles(machine).into_iter().filter(Axle::is_pin)
}

/// Lists the rings on the pins that keep links of different heights apart.
pub fn spacers(machine: &Machine, cut: &Cut) -> PartTable {
    let solids = if has_heights(machine) { link_solids(machine, cut) } else { Vec::new() };
    let stacked = pin_axles(machine).enumerate().filter(|_| has_heights(machine));
    let of_pin = |(pin, axle): (usize, Axle)| {
        let row = |spacer: Spacer| {
            let diameters = [cut.pin_diameter, 2.0 * cut.spacer_radius()].map(|metres| PartCell::Number(metres, 4));
            let name = PartCell::words(format!("{}.{}", pin + 1, spacer.number));
            [name, PartCell::words((pin + 1).to_string())]
                .into_iter()
                .chain(diameters)
                .chain(between(Some(spacer.faces)))
                .collect()
        };
        axle.spacers(machine, cut, &solids).into_iter().map(row).collect::<Vec<Vec<PartCell>>>()
    };
    let sizes = ["inner diameter m", "outer diameter m", "spacer length m"];
    PartTable {
        kind: "spacer",
        title: "Spacers",
        head: ["name", "on pin"].into_iter().chain(sizes).chain(BETWEEN).collect(),
        rows: stacked.flat_map(of_pin).collect(),
    }
}
