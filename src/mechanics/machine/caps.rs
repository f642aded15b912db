//! Maximum numbers of a machine's parts. All work on a machine grows with the length of its lists, so each is bounded.

use super::error::{KeyPath, MachineError};
use super::spec::MachineSpec;
use crate::planar::MAX_DRIVES;

/// Maximum number of links.
pub const MAX_LINKS: usize = 200;
/// Maximum number of links in a chain from the base to a tip. The balance equations list the products of the links'
/// lengths, and the number of these grows with the square of the chain's length.
pub const MAX_CHAIN_LINKS: usize = 32;
/// Maximum number of counterweights: one on each link, as design places them.
pub const MAX_COUNTERWEIGHTS: usize = MAX_LINKS;
/// Maximum number of pins that close loops.
const MAX_CLOSURES: usize = 200;
/// Maximum number of relative angles: two for each pair of drives, and some more.
const MAX_ANGLES: usize = 64;
/// Maximum number of named lengths: one for each link.
const MAX_LENGTHS: usize = MAX_LINKS;
/// Maximum number of materials beside the built-in ones.
const MAX_MATERIALS: usize = 100;
/// Maximum number of parts, and of lumps: some on each link.
pub const MAX_PARTS: usize = 1000;
/// Maximum number of holes of a part, and of corners of a plate. Each is compared with all others.
pub const MAX_PER_PART: usize = 100;
/// Maximum number of characters of a name.
const MAX_NAME: usize = 100;
/// Maximum number of characters of a summary.
const MAX_SUMMARY: usize = 1000;

/// Bounds of a list: its name, its length in a specification, and the minimum and maximum length.
type Cap = (&'static str, fn(&MachineSpec) -> usize, usize, usize);

const CAPS: [Cap; 9] = [
    ("drives", |spec| spec.drives.len(), 1, MAX_DRIVES),
    ("links", |spec| spec.links.len(), 1, MAX_LINKS),
    ("materials", |spec| spec.materials.len(), 0, MAX_MATERIALS),
    ("parts", |spec| spec.parts.len(), 0, MAX_PARTS),
    ("lumps", |spec| spec.lumps.len(), 0, MAX_PARTS),
    ("counterweights", |spec| spec.counterweights.len(), 0, MAX_COUNTERWEIGHTS),
    ("closures", |spec| spec.closures.len(), 0, MAX_CLOSURES),
    ("angles", |spec| spec.angles.len(), 0, MAX_ANGLES),
    ("named lengths", |spec| spec.lengths.len(), 0, MAX_LENGTHS),
];

/// Checks that the lists and texts of a specification are neither too short nor too long.
pub(super) fn check_counts(spec: &MachineSpec) -> Result<(), MachineError> {
    for (what, count, fewest, most) in CAPS {
        let count = count(spec);
        if !(fewest..=most).contains(&count) {
            let want = if fewest == 0 { format!("at most {most}") } else { format!("{fewest} to {most}") };
            return Err(MachineError::Count { what, count, want });
        }
    }
    for (i, drive) in spec.drives.iter().enumerate() {
        brief(&drive.name, MAX_NAME, || KeyPath::new(&[&"drive", &i, &"name"]))?;
    }
    for (i, link) in spec.links.iter().enumerate() {
        brief(&link.name, MAX_NAME, || KeyPath::new(&[&"link", &i, &"name"]))?;
    }
    for (i, part) in spec.parts.iter().enumerate() {
        brief(&part.name, MAX_NAME, || KeyPath::new(&[&"part", &i, &"name"]))?;
        for (what, count) in [("holes in a part", part.holes.len()), ("corners of a plate", part.polygon.len())] {
            if count > MAX_PER_PART {
                return Err(MachineError::Count { what, count, want: format!("at most {MAX_PER_PART}") });
            }
        }
    }
    for (i, lump) in spec.lumps.iter().enumerate() {
        brief(&lump.name, MAX_NAME, || KeyPath::new(&[&"lump", &i, &"name"]))?;
    }
    for (i, material) in spec.materials.iter().enumerate() {
        brief(&material.name, MAX_NAME, || KeyPath::new(&[&"material", &i, &"name"]))?;
    }
    for (i, angle) in spec.angles.iter().enumerate() {
        brief(&angle.name, MAX_NAME, || KeyPath::new(&[&"angle", &i, &"name"]))?;
    }
    brief(&spec.name, MAX_NAME, || KeyPath::new(&[&"name"]))?;
    brief(&spec.summary, MAX_SUMMARY, || KeyPath::new(&[&"summary"]))?;
    spec.lengths.keys().try_for_each(|name| brief(name, MAX_NAME, || KeyPath::new(&[&"lengths", name])))
}

/// Checks that a text has at most `most` characters.
fn brief(text: &str, most: usize, place: impl Fn() -> KeyPath) -> Result<(), MachineError> {
    let is_brief = text.chars().nth(most).is_none();
    is_brief.then_some(()).ok_or_else(|| MachineError::TooLong { place: place(), text: text.into(), most })
}
