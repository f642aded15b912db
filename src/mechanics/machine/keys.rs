//! [`MACHINE_KEYS`]: every key of a machine that can be set on its own, with its description and access to its value.

use toml::Value;

use super::error::{KeyPath, KeyStep, MachineError};
use super::lengths::{length_at, link_length, set_length, set_link_length};
use super::model::Machine;
use super::parts::LinkNumber;
use super::ranges::{
    ACCELERATION_LIMIT, ANGLE, DENSITY, GRAVITY, INERTIA, JERK_LIMIT, LENGTH, LOAD, MASS, PLACE, RADIUS, RATIO,
    SPEED_LIMIT, TORQUE_LIMIT, within,
};
use super::spec::{MachineSpec, PlaceOnLink};
use stillbase_settings::change::DEFAULT_WORD;
use stillbase_settings::key::{Key, KeyType};

/// A key, with access to its value.
pub(super) struct KeyRow {
    pub key: Key,
    pub at: FieldAccess,
    /// Returns whether the key has an effect on a machine; the flag says whether a force acts on the end effector.
    /// `None` if the key always has an effect.
    pub uses: Option<fn(&MachineSpec, bool) -> bool>,
}

/// Functions that read and write the value of a key in the i-th body of a kind, such as the i-th link.
pub(super) enum FieldAccess {
    Number(fn(&MachineSpec, usize) -> f64, fn(&mut MachineSpec, usize) -> &mut f64),
    Limit(fn(&MachineSpec, usize) -> Option<f64>, fn(&mut MachineSpec, usize) -> &mut Option<f64>),
    Pair(fn(&MachineSpec, usize) -> [f64; 2], fn(&mut MachineSpec, usize) -> &mut [f64; 2]),
    Switch(fn(&MachineSpec, usize) -> bool, fn(&mut MachineSpec, usize) -> &mut bool),
    /// A number of a link, which may follow from its parts.
    LinkNumber(LinkNumber),
    /// A place along a link.
    Place(fn(&MachineSpec, usize) -> &PlaceOnLink, fn(&mut MachineSpec, usize) -> &mut PlaceOnLink),
    /// Lower and upper limit of an angle, rad.
    Bounds(fn(&MachineSpec, usize) -> [Option<f64>; 2], fn(&mut MachineSpec, usize) -> [&mut Option<f64>; 2]),
    /// A length, m, which several links may share.
    Metres(fn(&Machine, usize) -> f64, fn(&mut MachineSpec, usize, f64) -> Result<(), MachineError>),
}

/// Makes both functions of a [`FieldAccess`] from one place expression.
macro_rules! at {
    (Place, |$spec:ident, $i:tt| $place:expr) => {
        FieldAccess::Place(|$spec, $i| &$place, |$spec, $i| &mut $place)
    };
    ($kind:ident, |$spec:ident, $i:tt| $place:expr) => {
        FieldAccess::$kind(|$spec, $i| $place, |$spec, $i| &mut $place)
    };
}

const fn row(key: Key, at: FieldAccess) -> KeyRow {
    KeyRow { key, at, uses: None }
}

const UNLIMITED: &str = "no limit";
const OF_PARTS: &str = "the link's parts give it, if it has some";
const NOT_OF_THE_SHAPE: &str = "the part has a shape that has none";

/// Every key of a machine that can be set on its own. Keys name links, drives and angles by their names,
/// counterweights, parts and lumps by their numbers, from 1.
pub(super) const MACHINE_KEYS: [KeyRow; 46] = [
    row(
        Key::number(
            "link.*.com",
            PLACE,
            Key::REQUIRED,
            "Place l_c of a link's centre of mass along the link, from its root.",
        )
        .instead(OF_PARTS),
        FieldAccess::LinkNumber(LinkNumber::Along),
    ),
    row(
        Key::number(
            "link.*.com_normal",
            PLACE,
            "0",
            "Place of a link's centre of mass off the link's axis, to the left of the direction root to tip.",
        )
        .instead("that of the link's parts, if it has some"),
        FieldAccess::LinkNumber(LinkNumber::Across),
    ),
    row(
        Key::number("link.*.mass", MASS, Key::REQUIRED, "Mass of a link.").instead(OF_PARTS),
        FieldAccess::LinkNumber(LinkNumber::Mass),
    ),
    row(
        Key::number("link.*.inertia", INERTIA, Key::REQUIRED, "Inertia of a link about its own centre of mass.")
            .instead(OF_PARTS),
        FieldAccess::LinkNumber(LinkNumber::Inertia),
    ),
    row(
        Key::number(
            "link.*.inertia_along",
            INERTIA,
            "0",
            "Inertia of a link about its own axis; a base that turns in space feels it, a plane motion does not.",
        ),
        at!(Number, |spec, i| spec.links[i].inertia_along),
    ),
    row(
        Key::number(
            "link.*.inertia_across",
            INERTIA,
            Key::NONE,
            "Inertia of a link about the axis in the plane across it; a base that turns in space feels it.",
        )
        .instead("the same as inertia"),
        at!(Limit, |spec, i| spec.links[i].inertia_across),
    ),
    row(
        Key::number("link.*.length", LENGTH, Key::REQUIRED, "Length of a link that shares it with no other."),
        FieldAccess::Metres(link_length, set_link_length),
    ),
    row(
        Key::number(
            "link.*.axial",
            PLACE,
            "0",
            "Height of a link's centre of mass along the drives' axis; it decides which moments tilt the base.",
        ),
        at!(Number, |spec, i| spec.links[i].axial),
    ),
    row(
        Key::number(
            "material.*.density",
            DENSITY,
            Key::REQUIRED,
            "Density of a material that the machine adds to the built-in ones.",
        ),
        at!(Number, |spec, i| spec.materials[i].density),
    ),
    row(
        Key::number(
            "part.*.from",
            PLACE,
            "root",
            "Place along its link where a bar begins; parts are numbered from 1.",
        ),
        at!(Place, |spec, i| spec.parts[i].from),
    ),
    row(
        Key::number("part.*.to", PLACE, "tip", "Place along its link where a bar ends."),
        at!(Place, |spec, i| spec.parts[i].to),
    ),
    row(
        Key::number(
            "part.*.across",
            PLACE,
            "0",
            "Distance of a part's line from its link's axis, to the left of the direction root to tip.",
        ),
        at!(Number, |spec, i| spec.parts[i].across),
    ),
    row(
        Key::number(
            "part.*.width",
            LENGTH,
            Key::REQUIRED,
            "Width of a flat bar or a profile, in the plane of the motion.",
        )
        .instead(NOT_OF_THE_SHAPE),
        at!(Limit, |spec, i| spec.parts[i].width),
    ),
    row(
        Key::number("part.*.thickness", LENGTH, Key::REQUIRED, "Thickness of a flat bar or a plate.")
            .instead(NOT_OF_THE_SHAPE),
        at!(Limit, |spec, i| spec.parts[i].thickness),
    ),
    row(
        Key::number("part.*.diameter", LENGTH, Key::REQUIRED, "Outer diameter of a tube.").instead(NOT_OF_THE_SHAPE),
        at!(Limit, |spec, i| spec.parts[i].diameter),
    ),
    row(
        Key::number("part.*.height", LENGTH, Key::REQUIRED, "Height of a profile, normal to the plane of the motion.")
            .instead(NOT_OF_THE_SHAPE),
        at!(Limit, |spec, i| spec.parts[i].height),
    ),
    row(
        Key::number("part.*.wall", LENGTH, Key::REQUIRED, "Thickness of the wall of a tube or a profile.")
            .instead(NOT_OF_THE_SHAPE),
        at!(Limit, |spec, i| spec.parts[i].wall),
    ),
    row(
        Key::number(
            "lump.*.mass",
            MASS,
            Key::REQUIRED,
            "Mass of a lump, such as a motor on a link; lumps are numbered from 1.",
        ),
        at!(Number, |spec, i| spec.lumps[i].mass),
    ),
    row(
        Key::number("lump.*.at", PLACE, Key::REQUIRED, "Place of a lump along the link that carries it."),
        at!(Place, |spec, i| spec.lumps[i].at),
    ),
    row(
        Key::number(
            "lump.*.across",
            PLACE,
            "0",
            "Place of a lump off its link's axis, to the left of the direction root to tip.",
        ),
        at!(Number, |spec, i| spec.lumps[i].across),
    ),
    row(
        Key::number("lump.*.inertia", INERTIA, "0", "Inertia of a lump about its own centre of mass; 0 for a point."),
        at!(Number, |spec, i| spec.lumps[i].inertia),
    ),
    row(
        Key::number(
            "counterweight.*.mass",
            MASS,
            Key::REQUIRED,
            "Mass of a counterweight; counterweights are numbered from 1, in the order of the machine.",
        ),
        at!(Number, |spec, i| spec.counterweights[i].mass),
    ),
    row(
        Key::number(
            "counterweight.*.at",
            PLACE,
            Key::REQUIRED,
            "Place of a counterweight along the link that carries it, from that link's root.",
        ),
        at!(Number, |spec, i| spec.counterweights[i].at),
    ),
    row(
        Key::number(
            "counterweight.*.across",
            PLACE,
            "0",
            "Place of a counterweight off its link's axis, to the left of the direction root to tip.",
        ),
        at!(Number, |spec, i| spec.counterweights[i].across),
    ),
    row(
        Key::number(
            "counterweight.*.radius",
            RADIUS,
            "0",
            "Radius of a counterweight, a disc or a ring; 0 for a point.",
        ),
        at!(Number, |spec, i| spec.counterweights[i].radius),
    ),
    row(
        Key::number("counterweight.*.inner_radius", RADIUS, "0", "Inner radius of a counterweight that is a ring."),
        at!(Number, |spec, i| spec.counterweights[i].inner_radius),
    ),
    row(
        Key::new(
            "counterweight.*.half",
            KeyType::Switch,
            "false",
            "Whether a counterweight is half a ring or disc: flat towards its link's root, round away from it.",
        ),
        at!(Switch, |spec, i| spec.counterweights[i].half),
    ),
    row(
        Key::new(
            "counterweight.*.turned",
            KeyType::Switch,
            "false",
            "Whether half a ring is turned round: round towards its link's root, flat away from it.",
        ),
        at!(Switch, |spec, i| spec.counterweights[i].turned),
    ),
    row(
        Key::number("counterweight.*.length", RADIUS, "0", "Length of a counterweight along its link, if it is a box."),
        at!(Number, |spec, i| spec.counterweights[i].length),
    ),
    row(
        Key::number("counterweight.*.width", RADIUS, "0", "Width of a counterweight across its link, if it is a box."),
        at!(Number, |spec, i| spec.counterweights[i].width),
    ),
    row(
        Key::new(
            "counterweight.*.fixed",
            KeyType::Switch,
            "false",
            "Whether a counterweight stays where it is, as a motor does, when others are sought or taken off.",
        ),
        at!(Switch, |spec, i| spec.counterweights[i].fixed),
    ),
    row(
        Key::number("length.*", LENGTH, Key::REQUIRED, "A named length, of all bars that share it."),
        FieldAccess::Metres(length_at, set_length),
    ),
    row(
        Key::number("payload.mass", LOAD, "0", "Mass held at the end effector, known to control."),
        at!(Number, |spec, _| spec.payload.mass),
    ),
    row(
        Key::number("payload.inertia", INERTIA, "0", "Inertia of the payload about its own centre of mass."),
        at!(Number, |spec, _| spec.payload.inertia),
    ),
    row(
        Key::number(
            "payload.inertia_along",
            INERTIA,
            "0",
            "Inertia of the payload about the axis along the link that holds it; a base that turns in space feels it.",
        ),
        at!(Number, |spec, _| spec.payload.inertia_along),
    ),
    row(
        Key::number(
            "payload.inertia_across",
            INERTIA,
            Key::NONE,
            "Inertia of the payload about the axis in the plane across that link; a base that turns in space feels it.",
        )
        .instead("the same as payload.inertia"),
        at!(Limit, |spec, _| spec.payload.inertia_across),
    ),
    KeyRow {
        key: Key::new(
            "payload.offset",
            KeyType::List(2, PLACE),
            "0,0",
            "Centre of mass of the payload, seen from the end effector: along the link that holds it, and to its left.",
        )
        .when("payload.mass above 0"),
        at: at!(Pair, |spec, _| spec.payload.offset),
        uses: Some(|spec, _| spec.payload.mass > 0.0),
    },
    KeyRow {
        key: Key::number(
            "payload.axial",
            PLACE,
            "0",
            "Height of the payload's centre of mass, and of a force on the end effector, along the drives' axis.",
        )
        .when("payload.mass above 0, or a force on the end effector"),
        at: at!(Number, |spec, _| spec.payload.axial),
        uses: Some(|spec, pushed| spec.payload.mass > 0.0 || pushed),
    },
    row(
        Key::new("gravity", KeyType::List(2, GRAVITY), "0,0", "Acceleration of gravity along the axes of the base."),
        at!(Pair, |spec, _| spec.gravity),
    ),
    row(
        Key::new(
            "limits.*",
            KeyType::List(2, ANGLE),
            Key::NONE,
            "Least and greatest value of a relative joint angle; without them it turns freely.",
        )
        .instead(UNLIMITED),
        FieldAccess::Bounds(
            |spec, i| [spec.angles[i].min, spec.angles[i].max],
            |spec, i| {
                let angle = &mut spec.angles[i];
                [&mut angle.min, &mut angle.max]
            },
        ),
    ),
    row(
        Key::number(
            "drive.*.rotor.inertia",
            INERTIA,
            "0",
            "Inertia of what turns in a drive's motor, about its own axis, before the gear.",
        ),
        FieldAccess::Number(
            |spec, i| spec.drives[i].rotor.unwrap_or_default().inertia,
            |spec, i| &mut spec.drives[i].rotor.get_or_insert_default().inertia,
        ),
    ),
    row(
        Key::number(
            "drive.*.rotor.ratio",
            RATIO,
            "1",
            "Turns of the rotor for one turn of the drive, seen from the motor's stator; below 0 it turns the other way.",
        ),
        FieldAccess::Number(
            |spec, i| spec.drives[i].rotor.unwrap_or_default().ratio,
            |spec, i| &mut spec.drives[i].rotor.get_or_insert_default().ratio,
        ),
    ),
    row(
        Key::number("drive.*.torque_limit", TORQUE_LIMIT, Key::NONE, "The greatest torque of a drive, either way.")
            .instead(UNLIMITED),
        at!(Limit, |spec, i| spec.drives[i].torque_limit),
    ),
    row(
        Key::number("drive.*.speed_limit", SPEED_LIMIT, Key::NONE, "The greatest rate of a drive, either way.")
            .instead(UNLIMITED),
        at!(Limit, |spec, i| spec.drives[i].speed_limit),
    ),
    row(
        Key::number(
            "drive.*.acceleration_limit",
            ACCELERATION_LIMIT,
            Key::NONE,
            "The greatest acceleration that is asked of a drive, either way.",
        )
        .instead(UNLIMITED),
        at!(Limit, |spec, i| spec.drives[i].acceleration_limit),
    ),
    row(
        Key::number(
            "drive.*.jerk_limit",
            JERK_LIMIT,
            Key::NONE,
            "The greatest jerk that is asked of a drive, either way, by time laws that keep jerk in bounds.",
        )
        .instead(UNLIMITED),
        at!(Limit, |spec, i| spec.drives[i].jerk_limit),
    ),
];

/// The keys of all rows.
pub const KEYS: [Key; MACHINE_KEYS.len()] = {
    let mut all = [MACHINE_KEYS[0].key; MACHINE_KEYS.len()];
    let mut i = 0;
    while i < all.len() {
        all[i] = MACHINE_KEYS[i].key;
        i += 1;
    }
    all
};

impl KeyRow {
    /// Returns the row of a key.
    pub fn of(path: &str) -> Option<&'static Self> {
        MACHINE_KEYS.iter().find(|row| row.key.matches(path))
    }

    /// Returns the value of the i-th body in a machine; the word `default` if it is not given.
    pub fn value(&self, machine: &Machine, i: usize) -> Value {
        let spec = machine.spec();
        let or_default = |value: Option<Value>| value.unwrap_or_else(|| DEFAULT_WORD.into());
        match self.at {
            FieldAccess::Number(of, _) => of(spec, i).into(),
            FieldAccess::LinkNumber(number) => {
                let link = &spec.links[i];
                let derived = link.follows(number) && spec.has_parts(&link.name);
                or_default((!derived).then(|| link.number(number).into()))
            }
            FieldAccess::Place(of, _) => match of(spec, i) {
                PlaceOnLink::Metres(metres) => (*metres).into(),
                PlaceOnLink::Named(name) => name.as_str().into(),
            },
            FieldAccess::Limit(of, _) => or_default(of(spec, i).map(Value::from)),
            FieldAccess::Pair(of, _) => of(spec, i).to_vec().into(),
            FieldAccess::Switch(of, _) => of(spec, i).into(),
            FieldAccess::Bounds(of, _) => {
                let [low, high] = of(spec, i);
                or_default(low.zip(high).map(|(low, high)| vec![low, high].into()))
            }
            FieldAccess::Metres(of, _) => of(machine, i).into(),
        }
    }

    /// Checks that the numbers of the i-th body are finite and within range. Lengths and limits of angles have other
    /// keys in files and are checked elsewhere.
    pub fn check(&self, spec: &MachineSpec, i: usize) -> Result<(), MachineError> {
        let Some(range) = self.key.range() else { return Ok(()) };
        let place = |k: Option<usize>| {
            let step = |part: &str| if part == "*" { KeyStep::At(i) } else { KeyStep::Key(part.into()) };
            KeyPath(self.key.path.split('.').map(step).chain(k.map(KeyStep::At)).collect())
        };
        match self.at {
            FieldAccess::Number(of, _) => within(range, of(spec, i), || place(None)),
            FieldAccess::LinkNumber(number) => within(range, spec.links[i].number(number), || place(None)),
            FieldAccess::Place(of, _) => match of(spec, i) {
                PlaceOnLink::Metres(metres) => within(range, *metres, || place(None)),
                PlaceOnLink::Named(_) => Ok(()),
            },
            FieldAccess::Limit(of, _) => of(spec, i).map_or(Ok(()), |value| within(range, value, || place(None))),
            FieldAccess::Pair(of, _) => {
                of(spec, i).into_iter().enumerate().try_for_each(|(k, value)| within(range, value, || place(Some(k))))
            }
            FieldAccess::Switch(..) | FieldAccess::Bounds(..) | FieldAccess::Metres(..) => Ok(()),
        }
    }
}

/// Returns the rows of a kind of body, which is the first word of their keys.
pub(super) fn rows_of(part: &str) -> Vec<&'static KeyRow> {
    MACHINE_KEYS.iter().filter(|row| row.key.part() == part).collect()
}
