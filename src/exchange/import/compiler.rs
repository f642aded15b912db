//! [`Compiler`]: the settings with which a file of MJCF is read, and the positions of its elements.

use nalgebra::{Isometry3, Matrix3, Quaternion, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::read::{AttributeSource, each, number, several, vector};
use super::refusal::{ImportError, element_error};
use stillbase_settings::range::quote_clipped;

/// Source of masses: shapes or `<inertial>` elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassSource {
    /// Shapes, unless there is an `<inertial>`.
    Auto,
    /// Shapes always.
    Shapes,
    /// `<inertial>` always.
    Written,
}

/// Settings of `<compiler>`.
#[derive(Clone, Debug)]
pub struct Compiler {
    /// Unit of angles, rad: a degree or 1.
    pub unit: f64,
    /// Axes of the Euler angles in order. The flag says whether an axis is intrinsic, that is, turned by the rotations
    /// before it.
    sequence: [(Unit<Vector3<f64>>, bool); 3],
    /// Whether a range is a limit unless stated otherwise.
    pub are_ranges_limits: bool,
    pub weighing: MassSource,
    /// First and last of the groups whose shapes have mass.
    pub groups: [f64; 2],
    /// Lower bounds of the mass of bodies, kg, and of their principal inertias, kg m².
    least: [f64; 2],
    /// Prescribed total mass of all bodies, kg.
    pub total: Option<f64>,
}

impl Compiler {
    /// Reads the settings of a `<mujoco>`, each with its last value.
    ///
    /// # Errors
    /// If a setting has an unknown value, or is not the number or numbers expected.
    pub fn of(model: Node<'_, '_>) -> Result<Self, ImportError> {
        let last = |name: &str| each(model, "compiler").filter(|node| node.has_attribute(name)).last();
        let word = |name: &str| last(name).and_then(|node| node.attribute(name));
        let value = |name: &'static str| last(name).map_or(Ok(None), |node| number(node, name));
        let refused = |name: &str, want: &str| {
            let said = quote_clipped(word(name).unwrap_or_default());
            Err(element_error(last(name).unwrap_or(model), format!("{name} is \"{said}\""), want))
        };
        if word("coordinate").is_some_and(|word| word != "local") {
            return refused("coordinate", "local");
        }
        let sequence = sequence(word("eulerseq").unwrap_or("xyz"));
        let Some(sequence) = sequence else { return refused("eulerseq", "three of x, y, z, X, Y, Z") };
        let weighing = match word("inertiafromgeom").unwrap_or("auto") {
            "auto" => MassSource::Auto,
            "true" => MassSource::Shapes,
            "false" => MassSource::Written,
            _ => return refused("inertiafromgeom", "auto, true or false"),
        };
        let groups = last("inertiagrouprange").map(|node| several::<2>(node, "inertiagrouprange")).transpose()?;
        Ok(Self {
            unit: if word("angle") == Some("radian") { 1.0 } else { 1.0_f64.to_radians() },
            sequence,
            are_ranges_limits: word("autolimits") != Some("false"),
            weighing,
            groups: groups.flatten().unwrap_or([0.0, 5.0]),
            least: [value("boundmass")?.unwrap_or(0.0), value("boundinertia")?.unwrap_or(0.0)],
            total: value("settotalmass")?.filter(|total| *total > 0.0),
        })
    }

    /// Returns whether the range of an element is a limit.
    pub fn is_limit<'a>(&self, element: &impl AttributeSource<'a>, attribute: &str) -> bool {
        match element.get(attribute) {
            Some("true") => true,
            Some("false") => false,
            _ => self.are_ranges_limits,
        }
    }

    /// Returns position, m, and orientation of an element in the frame of its parent.
    ///
    /// # Errors
    /// If an attribute is not the numbers expected, or a vector or quaternion of its orientation is zero.
    pub fn place<'a>(&self, element: &impl AttributeSource<'a>) -> Result<Isometry3<f64>, ImportError> {
        let at = vector(element, "pos")?.unwrap_or_default();
        Ok(Isometry3::from_parts(Translation3::from(at), self.turn(element)?))
    }

    fn turn<'a>(&self, element: &impl AttributeSource<'a>) -> Result<UnitQuaternion<f64>, ImportError> {
        let none = |what: &str| {
            element_error(element.node(), format!("a {what} without direction"), "numbers that are not all 0")
        };
        let unit = |v: Vector3<f64>, what: &str| Unit::try_new(v, 1e-9).ok_or_else(|| none(what));
        if let Some([w, x, y, z]) = several::<4>(element, "quat")? {
            return UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9).ok_or_else(|| none("quat"));
        }
        if let Some([x, y, z, angle]) = several::<4>(element, "axisangle")? {
            let axis = unit(Vector3::new(x, y, z), "axisangle")?;
            return Ok(UnitQuaternion::from_axis_angle(&axis, self.unit * angle));
        }
        if let Some(both) = several::<6>(element, "xyaxes")? {
            let [x, y] = [0, 3].map(|i| Vector3::new(both[i], both[i + 1], both[i + 2]));
            let x = unit(x, "xyaxes")?;
            let y = unit(y - x.into_inner() * x.dot(&y), "xyaxes")?;
            let turn = Matrix3::from_columns(&[x.into_inner(), y.into_inner(), x.cross(&y)]);
            return Ok(UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn)));
        }
        if let Some(z) = vector(element, "zaxis")? {
            return Ok(to_axis(&unit(z, "zaxis")?));
        }
        let angles = vector(element, "euler")?.unwrap_or_default();
        let turns = self.sequence.iter().zip(angles.iter());
        Ok(turns.fold(UnitQuaternion::identity(), |turn, ((axis, is_carried), angle)| {
            let next = UnitQuaternion::from_axis_angle(axis, self.unit * angle);
            if *is_carried { turn * next } else { next * turn }
        }))
    }

    /// Returns mass and inertia of a body, raised to the lower bounds of the file.
    pub fn bounded(&self, mass: f64, inertia: Matrix3<f64>) -> (f64, Matrix3<f64>) {
        let [least_mass, least_inertia] = self.least;
        if least_inertia <= 0.0 {
            return (mass.max(least_mass), inertia);
        }
        let mut principal = inertia.symmetric_eigen();
        principal.eigenvalues.iter_mut().for_each(|x| *x = x.max(least_inertia));
        (mass.max(least_mass), principal.recompose())
    }
}

/// Returns the smallest rotation that turns z to an axis.
pub fn to_axis(axis: &Unit<Vector3<f64>>) -> UnitQuaternion<f64> {
    let half_turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    UnitQuaternion::rotation_between_axis(&Vector3::z_axis(), axis).unwrap_or(half_turn)
}

fn sequence(word: &str) -> Option<[(Unit<Vector3<f64>>, bool); 3]> {
    let axis = |letter: char| {
        let axis = match letter.to_ascii_lowercase() {
            'x' => Vector3::x_axis(),
            'y' => Vector3::y_axis(),
            'z' => Vector3::z_axis(),
            _ => return None,
        };
        Some((axis, letter.is_ascii_lowercase()))
    };
    let all: Vec<_> = word.chars().take(4).map(axis).collect::<Option<_>>()?;
    all.try_into().ok()
}
