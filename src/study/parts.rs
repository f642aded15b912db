//! Tables of the parts of links: what each brings, and what overrules them.

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::machine::{LinkNumber, Machine, PartBody, PartSource, PlaneBody, Shape};

/// A part or a lump of a link, or all of a link together.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PartRow {
    /// The link.
    pub link: String,
    /// Name of the part, or else what it is.
    pub name: String,
    /// Mass, kg.
    pub mass: f64,
    /// Position of its centre of mass along the link, m from the root.
    pub at: f64,
    /// Distance of its centre of mass from the link's axis, to the left of the direction root to tip, m.
    pub across: f64,
    /// Inertia about its own centre of mass, kg m².
    pub inertia: f64,
}

impl PartRow {
    fn new(link: &str, name: String, body: PlaneBody) -> Self {
        let PlaneBody { mass, at, across, inertia } = body;
        Self { link: link.to_owned(), name, mass, at, across, inertia }
    }
}

/// A part or a lump, with the numbers that can be set.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkPart {
    /// The part or the lump.
    pub source: PartSource,
    /// What it brings.
    pub row: PartRow,
    /// Its material; empty for a lump.
    pub material: String,
    /// Its numbers that have keys.
    pub numbers: Vec<PartNumber>,
}

/// A number of a part that has a key.
#[derive(Clone, Debug, PartialEq)]
pub struct PartNumber {
    /// Path of the key, such as `part.1.width`.
    pub path: String,
    /// Last word of the key.
    pub word: &'static str,
    /// Its value, in SI units.
    pub value: f64,
}

impl LinkPart {
    fn of(machine: &Machine, part: &PartBody) -> Self {
        let spec = machine.spec();
        let (kind, i, words, material) = match part.source {
            PartSource::Part(i) => {
                let own = &spec.parts[i];
                let places = if own.shape == Shape::Plate {
                    Vec::new()
                } else {
                    vec![("from", part.ends[0]), ("to", part.ends[1])]
                };
                let lengths = own.lengths().into_iter().filter_map(|(word, length)| Some((word, length?)));
                let words: Vec<_> = lengths.chain(places).chain([("across", own.across)]).collect();
                ("part", i, words, own.material.clone())
            }
            PartSource::Lump(i) => {
                let own = &spec.lumps[i];
                let words =
                    vec![("mass", own.mass), ("at", part.ends[0]), ("across", own.across), ("inertia", own.inertia)];
                ("lump", i, words, String::new())
            }
        };
        let number = |(word, value)| PartNumber { path: format!("{kind}.{}.{word}", i + 1), word, value };
        let name = &spec.links[part.link].name;
        Self {
            source: part.source,
            row: PartRow::new(name, part.title(spec), part.body),
            material,
            numbers: words.into_iter().map(number).collect(),
        }
    }
}

/// The parts of one link.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkParts {
    /// The link, counted from 0.
    pub link: usize,
    /// Its parts and lumps.
    pub parts: Vec<LinkPart>,
    /// All of them together.
    pub sum: PartRow,
    /// Numbers of the link that are typed, and so overrule its parts.
    pub typed: Vec<LinkNumber>,
}

impl LinkParts {
    /// Returns the parts of a link; `None` if it has none.
    pub fn of(machine: &Machine, link: usize) -> Option<Self> {
        let sum = machine.parts_of_link(link)?;
        let own = &machine.spec().links[link];
        let of_link = machine.part_bodies().iter().filter(|part| part.link == link);
        let parts = of_link.map(|part| LinkPart::of(machine, part)).collect();
        let typed = LinkNumber::ALL.into_iter().filter(|number| !own.follows(*number)).collect();
        Some(Self { link, parts, sum: PartRow::new(&own.name, "together".into(), sum), typed })
    }

    /// Returns the links of a machine that have parts, with these.
    pub fn all(machine: &Machine) -> Vec<Self> {
        (0..machine.links().len()).filter_map(|link| Self::of(machine, link)).collect()
    }

    /// Returns the sentence that says which typed numbers overrule the parts; `None` if there are none.
    pub fn overruled(&self) -> Option<String> {
        overruled(&self.typed).map(|words| format!("link {}: {words}", self.sum.link))
    }
}

/// Returns the words that say which typed numbers overrule the parts of a link; `None` if there are none.
pub fn overruled(typed: &[LinkNumber]) -> Option<String> {
    let words: Vec<&str> = typed.iter().map(|number| number.words()).collect();
    let (last, others) = words.split_last()?;
    let all = if others.is_empty() { (*last).to_owned() } else { format!("{} and {last}", others.join(", ")) };
    let verb = if others.is_empty() { "is typed and overrules" } else { "are typed and overrule" };
    Some(format!("{all} {verb} its parts"))
}
