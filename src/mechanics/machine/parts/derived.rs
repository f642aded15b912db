//! Numbers of a link that follow from its parts: which they are, and how a file leaves them out.

use serde::{Deserialize, Serialize};

use super::super::error::{KeyPath, MachineError};
use super::super::spec::{Attach, Length, Link, MachineSpec, forwards, is_forwards, is_nought};
use super::body::PlaneBody;

/// A number of a link that its parts can give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkNumber {
    /// Mass, kg.
    Mass,
    /// Inertia about the own centre of mass, kg m².
    Inertia,
    /// Position of the centre of mass along the link, m.
    Along,
    /// Distance of the centre of mass from the link's axis, m.
    Across,
}

impl LinkNumber {
    /// All of them, in the order of a file.
    pub const ALL: [Self; 4] = [Self::Mass, Self::Inertia, Self::Along, Self::Across];

    /// Returns its key in a file.
    pub fn key(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::Inertia => "inertia",
            Self::Along => "com",
            Self::Across => "com_normal",
        }
    }

    /// Returns its name in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::Inertia => "inertia",
            Self::Along => "centre of mass along",
            Self::Across => "centre of mass across",
        }
    }

    fn of(self, body: &PlaneBody) -> f64 {
        match self {
            Self::Mass => body.mass,
            Self::Inertia => body.inertia,
            Self::Along => body.at,
            Self::Across => body.across,
        }
    }
}

/// Which numbers of a link follow from its parts. Each such number is kept as it was when the machine was last checked.
/// If the link has another value since then, someone typed it, and it overrules the parts.
#[derive(Clone, Copy, Debug, Default)]
pub struct DerivedNumbers([Option<f64>; 4]);

/// Two links are equal if a file states them alike: the values that numbers had before they were typed do not count.
impl PartialEq for Link {
    fn eq(&self, other: &Self) -> bool {
        let moments = |link: &Self| (link.inertia_along, link.inertia_across);
        let stated = |link: &Self| (link.direction, link.axial, LinkNumber::ALL.map(|number| link.follows(number)));
        let numbers = |link: &Self| LinkNumber::ALL.map(|number| link.number(number));
        (&self.name, &self.drive, &self.attach, &self.length)
            == (&other.name, &other.drive, &other.attach, &other.length)
            && stated(self) == stated(other)
            && moments(self) == moments(other)
            && numbers(self) == numbers(other)
    }
}

impl Link {
    /// Returns one of its numbers, in SI units.
    pub fn number(&self, number: LinkNumber) -> f64 {
        match number {
            LinkNumber::Mass => self.mass,
            LinkNumber::Inertia => self.inertia,
            LinkNumber::Along => self.com,
            LinkNumber::Across => self.com_normal,
        }
    }

    fn number_mut(&mut self, number: LinkNumber) -> &mut f64 {
        match number {
            LinkNumber::Mass => &mut self.mass,
            LinkNumber::Inertia => &mut self.inertia,
            LinkNumber::Along => &mut self.com,
            LinkNumber::Across => &mut self.com_normal,
        }
    }

    /// Returns whether a number follows from the parts of the link. Without parts, the distance off the axis follows,
    /// too: it is 0.
    pub fn follows(&self, number: LinkNumber) -> bool {
        self.derived.0[number as usize].is_some_and(|value| value.to_bits() == self.number(number).to_bits())
    }

    /// Types a number, which then overrules the parts, or lets it follow from them.
    pub fn type_number(&mut self, number: LinkNumber, typed: Option<f64>) {
        if let Some(value) = typed {
            *self.number_mut(number) = value;
        }
        self.derived.0[number as usize] = typed.is_none().then(|| self.number(number));
    }

    /// Replaces those numbers that follow from the parts, `None` for a link without parts. Fails for the first number
    /// that follows from nothing.
    fn settle(&mut self, parts: Option<&PlaneBody>) -> Result<(), LinkNumber> {
        for number in LinkNumber::ALL {
            let is_across = number == LinkNumber::Across;
            let value = match (self.follows(number), parts) {
                (true, Some(parts)) => Some(number.of(parts)),
                (true, None) if is_across => Some(0.0),
                (true, None) => return Err(number),
                // Files do not state this 0, so that it is as if it followed.
                (false, None) => (is_across && self.com_normal == 0.0).then_some(0.0),
                (false, Some(_)) => None,
            };
            if let Some(value) = value {
                *self.number_mut(number) = value;
            }
            self.derived.0[number as usize] = value;
        }
        Ok(())
    }
}

/// Sets every number of a link that follows from its parts; `sums` are the parts of each link combined.
pub(super) fn settle(spec: &mut MachineSpec, sums: &[Option<PlaneBody>]) -> Result<(), MachineError> {
    for (i, link) in spec.links.iter_mut().enumerate() {
        link.settle(sums.get(i).and_then(Option::as_ref)).map_err(|number| MachineError::NoParts {
            place: KeyPath::new(&[&"link", &i, &number.key()]),
            link: link.name.clone(),
        })?;
    }
    Ok(())
}

/// A link as a file states it: numbers that follow from its parts are left out.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkInFile {
    name: String,
    drive: String,
    attach: Attach,
    #[serde(default = "forwards", skip_serializing_if = "is_forwards")]
    direction: i8,
    length: Length,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    mass: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    inertia: Option<f64>,
    #[serde(default, skip_serializing_if = "is_nought")]
    inertia_along: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    inertia_across: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    com: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    com_normal: Option<f64>,
    #[serde(default, skip_serializing_if = "is_nought")]
    axial: f64,
}

impl From<LinkInFile> for Link {
    fn from(file: LinkInFile) -> Self {
        let LinkInFile { name, drive, attach, direction, length, mass, inertia, com, com_normal, axial, .. } = file;
        let none = f64::NAN;
        let mut link = Self {
            name,
            drive,
            attach,
            direction,
            length,
            mass: none,
            inertia: none,
            inertia_along: file.inertia_along,
            inertia_across: file.inertia_across,
            com: none,
            com_normal: 0.0,
            axial,
            derived: DerivedNumbers::default(),
        };
        for (number, given) in LinkNumber::ALL.into_iter().zip([mass, inertia, com, com_normal]) {
            link.type_number(number, given);
        }
        link
    }
}

impl From<Link> for LinkInFile {
    fn from(link: Link) -> Self {
        let [mass, inertia, com, com_normal] =
            LinkNumber::ALL.map(|number| (!link.follows(number)).then(|| link.number(number)));
        let Link { name, drive, attach, direction, length, inertia_along, inertia_across, axial, .. } = link;
        Self {
            name,
            drive,
            attach,
            direction,
            length,
            mass,
            inertia,
            inertia_along,
            inertia_across,
            com,
            com_normal,
            axial,
        }
    }
}
