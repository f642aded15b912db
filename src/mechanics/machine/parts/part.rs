//! [`Part`] and [`Lump`]: what a link is made of, as its file says it.

use serde::{Deserialize, Serialize};
use stillbase_settings::number::ShortNumber;

use super::super::spec::{PlaceOnLink, is_nought};
use super::material::USUAL;

/// A bar or a plate of a link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The link that it belongs to.
    pub link: String,
    /// Its name; empty for one that is described by its shape.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Its shape, which decides which of the lengths below it has.
    pub shape: Shape,
    /// Where a bar begins along the link.
    #[serde(default = "root", skip_serializing_if = "is_root")]
    pub from: PlaceOnLink,
    /// Where a bar ends along the link.
    #[serde(default, skip_serializing_if = "is_tip")]
    pub to: PlaceOnLink,
    /// Distance of its line from the link's axis, to the left of the direction root to tip, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub across: f64,
    /// Name of its material.
    #[serde(default = "usual", skip_serializing_if = "is_usual")]
    pub material: String,
    /// Width of a flat bar or a profile, in the plane of the motion, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// Thickness of a flat bar or a plate, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// Outer diameter of a tube, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter: Option<f64>,
    /// Height of a profile, normal to the plane of the motion, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Thickness of the wall of a tube or a profile, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<f64>,
    /// Ends of a flat bar; `None` for round ones.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends: Option<Ends>,
    /// Corners of a plate in the order around it, m: along the link from its root, and to the left of the part's
    /// line.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub polygon: Vec<[f64; 2]>,
    /// Round holes through a flat bar or a plate.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub holes: Vec<Hole>,
}

/// Shape of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// A flat bar.
    Flat,
    /// A round tube along the link.
    Tube,
    /// A hollow rectangular bar along the link.
    Profile,
    /// A plate with straight sides.
    Plate,
}

/// Ends of a flat bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ends {
    /// Half discs about the points where the bar begins and ends.
    #[default]
    Round,
    /// Cut straight where the bar begins and ends.
    Square,
}

/// A round hole through a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hole {
    /// Place of its centre along the link.
    pub at: PlaceOnLink,
    /// Distance of its centre from the part's line, to the left of the direction root to tip, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub across: f64,
    /// Diameter, m.
    pub diameter: f64,
}

/// A body on a link whose mass is known: a motor, a bearing, screws, a sensor. No design takes it off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lump {
    /// The link that carries it.
    pub link: String,
    /// Its name; may be empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Mass, kg.
    pub mass: f64,
    /// Place of its centre of mass along the link.
    pub at: PlaceOnLink,
    /// Distance of its centre of mass from the link's axis, to the left of the direction root to tip, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub across: f64,
    /// Inertia about its own centre of mass, kg m²; 0 for a point.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub inertia: f64,
}

impl Part {
    /// Returns a flat bar from root to tip of a link with a thickness, m; its width is still to be given.
    pub fn flat(link: &str, thickness: f64) -> Self {
        Self {
            link: link.into(),
            name: String::new(),
            shape: Shape::Flat,
            from: root(),
            to: PlaceOnLink::default(),
            across: 0.0,
            material: usual(),
            width: None,
            thickness: Some(thickness),
            diameter: None,
            height: None,
            wall: None,
            ends: None,
            polygon: Vec::new(),
            holes: Vec::new(),
        }
    }

    /// Returns its extent across its line in the plane of the motion, m; `None` for a plate.
    pub fn breadth(&self) -> Option<f64> {
        self.width.or(self.diameter)
    }

    /// Returns its name, or else its shape, section in mm and material.
    pub fn title(&self) -> String {
        if self.has_own_name() {
            return self.name.clone();
        }
        let mm = |length: Option<f64>| ShortNumber((1e9 * length.unwrap_or_default()).round() / 1e6).to_string();
        let words = match self.shape {
            Shape::Flat => format!("flat bar {} × {} mm", mm(self.width), mm(self.thickness)),
            Shape::Tube => format!("tube Ø {} × {} mm", mm(self.diameter), mm(self.wall)),
            Shape::Profile => format!("profile {} × {} × {} mm", mm(self.width), mm(self.height), mm(self.wall)),
            Shape::Plate => format!("plate {} mm", mm(self.thickness)),
        };
        format!("{words}, {}", self.material)
    }

    /// Returns its lengths by their keys, m; `None` for those that are not given.
    pub fn lengths(&self) -> [(&'static str, Option<f64>); 5] {
        [
            ("width", self.width),
            ("thickness", self.thickness),
            ("diameter", self.diameter),
            ("height", self.height),
            ("wall", self.wall),
        ]
    }
}

impl Lump {
    /// Returns its name, or else the word for it.
    pub fn title(&self) -> String {
        if self.name.is_empty() { "lump".into() } else { self.name.clone() }
    }
}

impl Shape {
    /// Returns the keys of the lengths that it has.
    pub fn lengths(self) -> &'static [&'static str] {
        match self {
            Self::Flat => &["width", "thickness"],
            Self::Tube => &["diameter", "wall"],
            Self::Profile => &["width", "height", "wall"],
            Self::Plate => &["thickness"],
        }
    }

    /// Returns its name, with an article.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Flat => "a flat bar",
            Self::Tube => "a tube",
            Self::Profile => "a profile",
            Self::Plate => "a plate",
        }
    }
}

fn root() -> PlaceOnLink {
    PlaceOnLink::Named("root".into())
}

fn is_root(place: &PlaceOnLink) -> bool {
    *place == root()
}

fn is_tip(place: &PlaceOnLink) -> bool {
    *place == PlaceOnLink::default()
}

fn usual() -> String {
    USUAL.into()
}

fn is_usual(material: &str) -> bool {
    material == USUAL
}

impl Part {
    /// Returns whether its places along the link are those of a part whose file names none.
    pub(crate) fn has_usual_places(&self) -> bool {
        is_root(&self.from) && is_tip(&self.to)
    }
}
