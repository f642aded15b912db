//! [`PartsList`]: the parts list of a machine, as one table for a spreadsheet or as Markdown to read.

mod pins;

use super::cut::{Cut, CutError};
use pins::{pin_axles, pins, spacers};
use stillbase_mechanics::machine::{Counterweight, Drive, Link, Machine, PartBody, PartSource, PlaneBody, Shape};
use stillbase_settings::cell_table::{Cell, CellTable};
use stillbase_settings::number::{fixed, shortest};

/// Parts list of a machine, by kinds of parts.
#[derive(Clone, Debug, PartialEq)]
pub struct PartsList {
    /// The machine's name.
    pub machine: String,
    /// A table for each kind of part that it has, and the totals.
    pub tables: Vec<PartTable>,
}

/// The parts of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct PartTable {
    /// Name of one such part: `link`.
    pub kind: &'static str,
    /// Title of the table: `Links`.
    pub title: &'static str,
    /// Title of each column, with its unit.
    pub head: Vec<&'static str>,
    /// A row for each part.
    pub rows: Vec<Vec<PartCell>>,
}

/// Part of a number that is rounding.
const NOISE: f64 = 1e-14;

/// A cell of the table of a part.
#[derive(Clone, Debug, PartialEq)]
pub enum PartCell {
    /// A text.
    Words(String),
    /// A number, with its decimals in Markdown.
    Number(f64, usize),
    /// An empty cell.
    None,
}

impl PartsList {
    /// Makes the parts list of a machine; `cut` gives density and thickness of discs.
    ///
    /// # Errors
    /// If a dimension or the density is out of range, or if links with heights cannot be cut.
    pub fn of(machine: &Machine, cut: &Cut) -> Result<Self, CutError> {
        if has_heights(machine) { cut.check(machine) } else { cut.check_ranges() }?;
        let tables = [
            Some(links(machine, cut)),
            Some(parts(machine)),
            Some(lumps(machine)),
            Some(counterweights(machine, cut)),
            payload(machine),
            Some(motors(machine)),
            Some(pins(machine, cut)),
            Some(spacers(machine, cut)),
            Some(totals(machine, cut)),
        ];
        let tables = tables.into_iter().flatten().filter(|table| !table.rows.is_empty()).collect();
        Ok(Self { machine: machine.name().into(), tables })
    }

    /// Returns the list as one table with all columns of all kinds of parts.
    pub fn cells(&self) -> CellTable {
        let mut head: Vec<&str> = Vec::new();
        for name in self.tables.iter().flat_map(|table| &table.head) {
            if !head.contains(name) {
                head.push(name);
            }
        }
        let mut rows = Vec::new();
        for table in &self.tables {
            let places: Vec<Option<usize>> =
                head.iter().map(|name| table.head.iter().position(|own| own == name)).collect();
            rows.extend(table.rows.iter().map(|row| {
                let of = |place: &Option<usize>| place.and_then(|i| row.get(i)).map_or(Cell::Empty, PartCell::exact);
                [Cell::words(table.kind)].into_iter().chain(places.iter().map(of)).collect()
            }));
        }
        let head = ["part"].into_iter().chain(head).map(String::from).collect();
        CellTable { row: "part", about: Vec::new(), head, rows }
    }

    /// Returns the list as Markdown: a table for each kind, with aligned columns.
    pub fn markdown(&self) -> String {
        let mut text = format!("# Parts of {}\n", plain(&self.machine));
        for table in &self.tables {
            text += &format!("\n## {}\n\n{}", table.title, table.markdown());
        }
        text
    }
}

impl PartTable {
    fn markdown(&self) -> String {
        let is_number = |c: usize| self.rows.iter().any(|row| matches!(row.get(c), Some(PartCell::Number(..))));
        let mut rows: Vec<Vec<String>> = vec![self.head.iter().map(|name| (*name).to_owned()).collect()];
        rows.extend(self.rows.iter().map(|row| row.iter().map(PartCell::read).collect()));
        let width = |c: usize| rows.iter().map(|row| row[c].chars().count()).fold(3, usize::max);
        let widths: Vec<usize> = (0..self.head.len()).map(width).collect();
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let padded = |row: &Vec<String>| {
            let cell = |(c, cell): (usize, &String)| match is_number(c) {
                true => format!("{cell:>0$}", widths[c]),
                false => format!("{cell:<0$}", widths[c]),
            };
            line(row.iter().enumerate().map(cell).collect())
        };
        let rule = |(c, width): (usize, &usize)| match is_number(c) {
            true => format!("{}:", "-".repeat(width - 1)),
            false => "-".repeat(*width),
        };
        let mut text = padded(&rows[0]) + &line(widths.iter().enumerate().map(rule).collect());
        text.extend(rows[1..].iter().map(padded));
        text
    }
}

impl PartCell {
    fn words(text: impl Into<String>) -> Self {
        Self::Words(text.into())
    }

    fn some(value: Option<f64>, decimals: usize) -> Self {
        value.map_or(Self::None, |value| Self::Number(value, decimals))
    }

    /// Returns the cell of a table: numbers with all digits.
    fn exact(&self) -> Cell {
        match self {
            Self::Words(text) => Cell::words(text),
            // Without the noise of the last digits, as a person would write it.
            Self::Number(value, _) => Cell::Number(shortest(*value, NOISE)),
            Self::None => Cell::Empty,
        }
    }

    /// Returns the cell for Markdown.
    fn read(&self) -> String {
        match self {
            Self::Words(text) => plain(text),
            Self::Number(value, decimals) => fixed(*value, *decimals),
            Self::None => "–".into(),
        }
    }
}

/// Escapes a name for a line of a Markdown table.
fn plain(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    text.replace('\\', "\\\\").replace('|', "\\|").replace('<', "&lt;")
}

/// Columns of a body in the axes of its link.
const BODY: [&str; 4] = ["mass kg", "centre of mass m", "left of axis m", "inertia kg m²"];

/// Returns the cells of these columns.
fn of_body(body: PlaneBody) -> [PartCell; 4] {
    [(body.mass, 3), (body.at, 4), (body.across, 4), (body.inertia, 6)].map(|(x, digits)| PartCell::Number(x, digits))
}

/// Lists the links, with their layers and heights if they have some.
fn links(machine: &Machine, cut: &Cut) -> PartTable {
    let parts = machine.resolved_links();
    let (layers, has_heights) = (cut.layers_of(machine), has_heights(machine));
    let row = |(j, link): (usize, &Link)| {
        let pinned = parts[j].parent.map_or("base".into(), |p| on(machine, p, parts[j].at));
        let layer = layers.as_ref().map(|layers| layers[j] as f64);
        let stacked = [PartCell::some(layer, 0), PartCell::Number(link.axial, 4)];
        let cells = [PartCell::words(&link.name), PartCell::words(&link.drive), PartCell::Number(parts[j].length, 4)];
        let (at, across) = (link.com, link.com_normal);
        let body = of_body(PlaneBody { mass: link.mass, at, across, inertia: link.inertia });
        cells
            .into_iter()
            .chain(body)
            .chain([PartCell::words(pinned)])
            .chain(stacked.into_iter().filter(|_| has_heights))
            .collect()
    };
    let stacked = ["layer", "height m"].into_iter().filter(|_| has_heights);
    PartTable {
        kind: "link",
        title: "Links",
        head: ["name", "drive", "length m"].into_iter().chain(BODY).chain(["root pinned to"]).chain(stacked).collect(),
        rows: machine.spec().links.iter().enumerate().map(row).collect(),
    }
}

/// Lists bars and plates.
fn parts(machine: &Machine) -> PartTable {
    let row = |body: &PartBody| {
        let PartSource::Part(i) = body.source else { return None };
        let part = &machine.spec().parts[i];
        let length = match part.shape {
            Shape::Plate => None,
            _ => machine.part_ends(i).map(|[from, to]| to - from),
        };
        let cells = [
            PartCell::words(part.title()),
            PartCell::words(&part.link),
            PartCell::words(&part.material),
            PartCell::some(part.thickness, 4),
            PartCell::some(length, 4),
        ];
        Some(cells.into_iter().chain(of_body(body.body)).collect())
    };
    PartTable {
        kind: "part",
        title: "Parts of links",
        head: ["name", "on link", "material", "thickness m", "length m"].into_iter().chain(BODY).collect(),
        rows: machine.part_bodies().iter().filter_map(row).collect(),
    }
}

/// Lists motors, bearings, screws and sensors on links, with the height of their link if links have heights.
fn lumps(machine: &Machine) -> PartTable {
    let has_heights = has_heights(machine);
    let row = |body: &PartBody| match body.source {
        PartSource::Part(_) => None,
        PartSource::Lump(_) => {
            let name = PartCell::words(body.title(machine.spec()));
            let on_link = PartCell::words(&machine.links()[body.link].name);
            let height = PartCell::Number(machine.spec().links[body.link].axial, 4);
            let height = Some(height).filter(|_| has_heights);
            Some([name, on_link].into_iter().chain(of_body(body.body)).chain(height).collect())
        }
    };
    PartTable {
        kind: "lump",
        title: "Lumps",
        head: ["name", "on link"].into_iter().chain(BODY).chain(has_heights.then_some("height m")).collect(),
        rows: machine.part_bodies().iter().filter_map(row).collect(),
    }
}

fn has_heights(machine: &Machine) -> bool {
    machine.spec().links.iter().any(|link| link.axial != 0.0)
}

fn counterweights(machine: &Machine, cut: &Cut) -> PartTable {
    let row = |(i, weight): (usize, &Counterweight)| {
        let thickness = cut.thickness_of(weight);
        vec![
            PartCell::words((i + 1).to_string()),
            PartCell::words(&weight.link),
            PartCell::Number(weight.mass, 3),
            PartCell::Number(weight.at, 4),
            PartCell::Number(weight.across, 4),
            PartCell::words(weight.shape().name()),
            PartCell::some((weight.radius > 0.0).then_some(weight.radius), 4),
            PartCell::some((weight.inner_radius > 0.0).then_some(weight.inner_radius), 4),
            PartCell::some((weight.length > 0.0).then_some(weight.length), 4),
            PartCell::some((weight.width > 0.0).then_some(weight.width), 4),
            PartCell::some(thickness, 4),
            PartCell::some(thickness.map(|_| cut.density), 0),
            PartCell::some(thickness.map(|thickness| cut.mass_of(weight, thickness)), 3),
        ]
    };
    PartTable {
        kind: "counterweight",
        title: "Counterweights",
        head: vec![
            "name",
            "on link",
            "mass kg",
            "place m",
            "left of axis m",
            "shape",
            "radius m",
            "inner radius m",
            "length m",
            "width m",
            "thickness m",
            "density kg/m³",
            "mass as cut kg",
        ],
        rows: machine.spec().counterweights.iter().enumerate().map(row).collect(),
    }
}

fn payload(machine: &Machine) -> Option<PartTable> {
    let payload = machine.spec().payload;
    let [along, left] = payload.offset;
    (payload.mass > 0.0 || payload.inertia > 0.0).then(|| PartTable {
        kind: "payload",
        title: "Payload",
        head: ["on link"].into_iter().chain(BODY).collect(),
        rows: vec![
            [PartCell::words(&machine.links()[machine.end_link()].name)]
                .into_iter()
                .chain(of_body(PlaneBody { mass: payload.mass, at: along, across: left, inertia: payload.inertia }))
                .collect(),
        ],
    })
}

fn motors(machine: &Machine) -> PartTable {
    let row = |drive: &Drive| {
        let stator = drive.on.as_ref().map_or("base".into(), |on| format!("links of drive {on}"));
        vec![
            PartCell::words(&drive.name),
            PartCell::words(stator),
            PartCell::some(drive.rotor.map(|rotor| rotor.ratio), 3),
            PartCell::some(drive.rotor.map(|rotor| rotor.inertia), 9),
            PartCell::some(drive.torque_limit, 2),
            PartCell::some(drive.speed_limit, 2),
        ]
    };
    PartTable {
        kind: "motor",
        title: "Motors",
        head: vec!["name", "stator on", "gear ratio", "rotor inertia kg m²", "torque limit N m", "speed limit rad/s"],
        rows: machine.spec().drives.iter().map(row).collect(),
    }
}

/// Returns a position on a link in words.
fn on(machine: &Machine, j: usize, at: f64) -> String {
    format!("link {} at {} m", machine.links()[j].name, fixed(at, 4))
}

fn totals(machine: &Machine, cut: &Cut) -> PartTable {
    let spec = machine.spec();
    let links = spec.links.iter().map(|link| link.mass).sum::<f64>();
    // The sum of nothing is −0.
    let discs = spec.counterweights.iter().map(|weight| weight.mass).sum::<f64>() + 0.0;
    let row = |name: &str, count: Option<usize>, mass: Option<f64>| {
        let count = count.map_or(PartCell::None, |count| PartCell::Number(count as f64, 0));
        vec![PartCell::words(name), count, PartCell::some(mass, 3)]
    };
    let rings = spacers(machine, cut).rows.len();
    let made = [("pins", pin_axles(machine).count()), ("spacers", rings)];
    // Nothing weighs them.
    let made = made.into_iter().filter(|(_, count)| *count > 0).map(|(name, count)| row(name, Some(count), None));
    PartTable {
        kind: "total",
        title: "Totals",
        head: vec!["name", "count", "mass kg"],
        rows: [
            row("links", Some(spec.links.len()), Some(links)),
            row("counterweights", Some(spec.counterweights.len()), Some(discs)),
        ]
        .into_iter()
        .chain(made)
        .chain([row("payload", None, Some(spec.payload.mass)), row("all", None, Some(machine.mass()))])
        .collect(),
    }
}
