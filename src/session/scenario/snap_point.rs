//! [`SnapPoint`]: the points of a picture to which notes and measures stick.

use serde::{Deserialize, Serialize};

use super::task::POINT_RANGE;
use stillbase_mechanics::machine::Machine;
use stillbase_settings::range::{quote_clipped, range_error, shortened};

/// A point to which a note or a measure sticks; all but a place move with what they belong to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SnapPoint {
    /// The end effector.
    EndEffector,
    /// The target of the end effector.
    Target,
    /// The centre of mass of the machine.
    CentreOfMass,
    /// The pin of the base.
    BasePin,
    /// The pin that joins these links, by their names in the order of the machine.
    Pin(Vec<String>),
    /// A point of the task.
    PathPoint(PathPoint),
    /// A place in the plane of motion, m.
    Place([f64; 2]),
}

/// A point of a task: A, those between, B.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PathPoint {
    /// A.
    Start,
    /// A point between, counted from 1.
    Via(usize),
    /// B.
    End,
}

/// Maximum number of links that a pin names.
const MAX_LINKS: usize = 8;

/// Points with a name of one or a few words.
const NAMED: [(&str, SnapPoint); 6] = [
    ("end effector", SnapPoint::EndEffector),
    ("target", SnapPoint::Target),
    ("centre of mass", SnapPoint::CentreOfMass),
    ("base pin", SnapPoint::BasePin),
    ("A", SnapPoint::PathPoint(PathPoint::Start)),
    ("B", SnapPoint::PathPoint(PathPoint::End)),
];

impl SnapPoint {
    /// Reads the name of a point other than a pin and a place: `end effector`, `A`, `1`.
    ///
    /// # Errors
    /// If there is no such point; the error states the names of all.
    pub fn of_name(name: &str) -> Result<Self, String> {
        if let Some((_, point)) = NAMED.into_iter().find(|(known, _)| *known == name) {
            return Ok(point);
        }
        let via = name.parse().ok().filter(|i| (1..=super::MAX_POINTS).contains(i));
        via.map(|i| Self::PathPoint(PathPoint::Via(i))).ok_or_else(|| {
            let known = NAMED.map(|(known, _)| known).join(", ");
            format!("on is {:?}: want {known}, or the number of a point between A and B", quote_clipped(name))
        })
    }

    /// Returns the name of the point, if it is neither a pin nor a place.
    pub(super) fn name(&self) -> Option<String> {
        match self {
            Self::PathPoint(PathPoint::Via(i)) => Some(i.to_string()),
            point => NAMED.into_iter().find(|(_, known)| known == point).map(|(name, _)| name.to_owned()),
        }
    }

    /// Describes the point in a few words.
    pub fn title(&self) -> String {
        match (self, self.name()) {
            (Self::Pin(links), _) => match links.split_last() {
                Some((last, [])) => format!("pin of link {last}"),
                Some((last, before)) => format!("pin of links {} and {last}", before.join(", ")),
                None => "pin".into(),
            },
            (Self::Place([x, y]), _) => format!("place {x:.3}, {y:.3} m"),
            (Self::PathPoint(_), Some(name)) => format!("point {name}"),
            (_, name) => name.unwrap_or_default(),
        }
    }

    /// Checks the numbers of a place, and the links of a pin.
    ///
    /// # Errors
    /// If a number is out of range, or a pin names no link, too many or unknown ones. The error says what is right.
    pub fn check(&self, machine: &Machine) -> Result<(), String> {
        match self {
            Self::Place(at) => {
                let wrong = at.iter().map(|x| POINT_RANGE.check("at", *x)).find(|check| !check.ok);
                wrong.map_or(Ok(()), |check| Err(range_error("at", check.value, &check.want)))
            }
            Self::Pin(links) if links.is_empty() || links.len() > MAX_LINKS => {
                Err(format!("pin names {} links: want 1 to {MAX_LINKS}", links.len()))
            }
            Self::Pin(links) => {
                let unknown = links.iter().find(|name| machine.links().iter().all(|link| link.name != **name));
                unknown.map_or(Ok(()), |name| {
                    let known: Vec<&str> = machine.links().iter().map(|link| link.name.as_str()).collect();
                    let known = shortened(&known.join(", "), 80);
                    Err(format!("pin names link {:?}: this machine has {known}", quote_clipped(name)))
                })
            }
            _ => Ok(()),
        }
    }
}
