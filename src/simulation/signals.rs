//! Table of signals: each is a curve of a plot, a series of the recording and a column of the CSV.

use crate::frame::{Frame, SharedBase};
use stillbase_mechanics::joint_forces::{self, Joints, MAX_FRAME_PINS};
use stillbase_mechanics::machine::{Drive, Inertia, Machine};
use stillbase_mechanics::planar::MAX_DRIVES;
use stillbase_query::QuickQuery;
use stillbase_settings::number::subscript;
use stillbase_settings::results;

/// A number in a [`Frame`], with its name and unit.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Unique path with `/` between its parts: `torque/1`.
    pub path: String,
    /// Symbol in the paper's notation: `τ₁`.
    pub symbol: String,
    /// Meaning in words.
    pub label: String,
    /// SI unit, `1` for none.
    pub unit: &'static str,
    /// Drive whose colour the signal has, counted from 0; `None` if it belongs to no single drive.
    pub drive: Option<usize>,
    /// Largest permitted |value|, in the signal's unit: the limit of a drive.
    pub limit: Option<f64>,
    /// Place in its assembly of the block whose frames have it; 0 for a machine by itself.
    pub block: usize,
    quantity: Quantity,
}

#[derive(Clone, Copy, Debug)]
enum Quantity {
    PerIndex(usize, fn(&Frame, usize) -> f64),
    Whole(fn(&Frame) -> f64),
    /// A number of the base that the blocks of an assembly share; 0 for a machine by itself.
    OfSharedBase(usize, fn(&SharedBase, usize) -> f64),
}

/// Compares the paths, the blocks, and the indices of the drive, angle or pin: the same path may mean another drive on
/// another machine.
impl PartialEq for Signal {
    fn eq(&self, other: &Self) -> bool {
        let place = |signal: &Self| match signal.quantity {
            Quantity::PerIndex(k, _) => Some(k),
            Quantity::Whole(_) | Quantity::OfSharedBase(..) => None,
        };
        (&self.path, self.block, place(self)) == (&other.path, other.block, place(other))
    }
}

impl Signal {
    /// Returns the value at one instant.
    #[inline]
    pub fn value(&self, frame: &Frame) -> f64 {
        match self.quantity {
            Quantity::PerIndex(k, f) => f(frame, k),
            Quantity::Whole(f) => f(frame),
            Quantity::OfSharedBase(i, f) => frame.shared.as_ref().map_or(0.0, |base| f(base, i)),
        }
    }

    /// Whether it states what the base does that the blocks of an assembly share.
    pub fn is_of_shared_base(&self) -> bool {
        matches!(self.quantity, Quantity::OfSharedBase(..))
    }

    /// Whether its values are never negative: a norm, a root mean square, an impulse, an energy, a worst value, 0/1.
    pub fn is_magnitude(&self) -> bool {
        match self.group() {
            "impulse" | "angular_impulse" | "payload" | "wheel_saturated" | "dexterity" | "torque_per_force"
            | "pin" => true,
            "transmission" | "change_point" | "reactionless" | "energy" | "audit_closure" | "audit_step" => true,
            "force" => matches!(self.path.as_str(), "force/dynamic" | "force/rms"),
            "moment" => self.path == "moment/rms",
            _ => false,
        }
    }

    /// Returns the last word of the settings that limit the group of the signal, one for each drive; `None` if none do.
    pub fn limit_key(&self) -> Option<&'static str> {
        LIMITED.iter().find(|(group, ..)| *group == self.group()).map(|(_, key, _)| *key)
    }

    /// Returns the first part of the path: signals of one group share a plot and a unit.
    pub fn group(&self) -> &str {
        group_of(&self.path)
    }
}

/// Returns the first part of the path of a signal, the name of its group.
pub fn group_of(path: &str) -> &str {
    path.split('/').next().unwrap_or(path)
}

/// Returns whether a name is that of a signal with a path: the path itself, or the name of its group.
pub fn is_name_of(name: &str, path: &str) -> bool {
    name == path || name == group_of(path)
}

/// Groups of signals that drives limit, with the key of the limit, and the limit of a drive.
type Limited = (&'static str, &'static str, fn(&Drive) -> Option<f64>);
const LIMITED: [Limited; 3] = [
    ("torque", "torque_limit", |drive| drive.torque_limit),
    ("rate", "speed_limit", |drive| drive.speed_limit),
    ("acceleration", "acceleration_limit", |drive| drive.acceleration_limit),
];

/// Returns the heads of the columns of a table of signals over time: the name and the unit of each.
pub fn row_heads(signals: &[Signal]) -> Vec<String> {
    let heads = signals.iter().map(|signal| format!("{} {}", signal.path, signal.unit));
    ["time s".to_owned()].into_iter().chain(heads).collect()
}

/// Every unit of a signal.
const UNITS: [&str; 17] = [
    "N m/N", "kg m²/s", "rad/s²", "kg m/s", "N m s", "rad/s", "N m", "N s", "m/s", "rad", "m²", "kg", "N", "m", "J",
    "s", "1",
];

/// Returns the name and the unit of a signal from the head of a column, as [`row_heads`] writes it. A name may contain
/// spaces; the unit is empty if it is not stated.
pub fn name_and_unit(head: &str) -> (&str, &str) {
    let parts = |unit: &'static str| head.strip_suffix(unit)?.strip_suffix(' ').map(|name| (name, unit));
    UNITS.into_iter().find_map(parts).unwrap_or((head, ""))
}

/// Query for the signals of a machine.
#[derive(Debug)]
pub struct SignalsOf;

impl QuickQuery for SignalsOf {
    /// The machine; for a block of an assembly, whether the base that it shares floats.
    type Input = (Machine, Option<bool>);
    type Answer = Vec<Signal>;

    fn answer((machine, shared): &Self::Input) -> Vec<Signal> {
        match shared {
            None => signals(machine),
            Some(floats) => signals_of_block(machine, *floats),
        }
    }
}

/// Groups of signals that state what one machine does to its base. A block of an assembly has those of the base that all
/// blocks share in their place.
const OF_ITS_BASE: [&str; 14] = [
    "moment",
    "force",
    "momentum",
    "angular_momentum",
    "base",
    "attitude",
    "attitude_rate",
    "base_velocity",
    "wheel",
    "wheel_saturated",
    "impulse",
    "angular_impulse",
    "tilt",
    "payload",
];

/// Returns every signal of a machine that is a block of an assembly, in a fixed order: its own in its plane, and those of
/// the base that all blocks share, in space.
pub fn signals_of_block(machine: &Machine, floats: bool) -> Vec<Signal> {
    let mut table = signals(machine);
    table.retain(|signal| !OF_ITS_BASE.contains(&signal.group()));
    table.extend(of_shared_base(floats));
    table
}

/// Groups of signals that each block of an assembly has among those of all blocks; the others are of the plane of a block,
/// or of its machine by itself.
const OF_EACH_BLOCK: [&str; 10] =
    ["torque", "angle", "rate", "acceleration", "reference", "error", "joint", "pose", "transmission", "change_point"];

/// Returns the signals of all blocks of an assembly, in a fixed order: those of each block, with its name before that of
/// the drive, as `torque/wrist.1`, its end effector in space, and those of the base.
pub fn signals_of_assembly<'a>(blocks: impl Iterator<Item = (&'a str, &'a Machine)>, floats: bool) -> Vec<Signal> {
    let mut table = Vec::new();
    for (block, (name, machine)) in blocks.enumerate() {
        let own = signals(machine).into_iter();
        let own = own.filter(|signal| OF_EACH_BLOCK.contains(&signal.group()));
        table.extend(own.map(|signal| {
            let (group, rest) = signal.path.split_once('/').unwrap_or((&signal.path, ""));
            let (path, label) = (format!("{group}/{name}.{rest}"), format!("{name}: {}", signal.label));
            Signal { path, label, block, ..signal }
        }));
        let mut add = |path: String, of: &str, i: usize, value: fn(&SharedBase, usize) -> f64| {
            let [symbol, label, unit] = described(of);
            let (symbol, label) = (symbol.into(), format!("{name}: {label}"));
            let quantity = Quantity::OfSharedBase(i, value);
            table.push(Signal { path, symbol, label, unit, drive: None, limit: None, block, quantity });
        };
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            add(format!("tip/{name}.{axis}"), &format!("tip/{axis}"), i, |base, i| base.tip[i]);
        }
        add(format!("payload/{name}.mass"), "payload/mass", 0, |base, _| base.held.mass);
    }
    table.extend(of_shared_base(floats));
    table
}

/// Returns the signals of a base that the blocks of an assembly share.
fn of_shared_base(floats: bool) -> Vec<Signal> {
    let mut table = Vec::new();
    let mut add = |path: String, i: usize, value: fn(&SharedBase, usize) -> f64| {
        let [symbol, label, unit] = described(&path);
        let quantity = Quantity::OfSharedBase(i, value);
        let (symbol, label) = (symbol.into(), label.into());
        table.push(Signal { path, symbol, label, unit, drive: None, limit: None, block: 0, quantity });
    };
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        add(format!("force/dynamic_{axis}"), i, |base, i| base.loads.motion.force[i]);
        add(format!("moment/dynamic_{axis}"), i, |base, i| base.loads.motion.moment[i]);
        add(format!("force/static_{axis}"), i, |base, i| base.loads.weight.force[i]);
        add(format!("moment/static_{axis}"), i, |base, i| base.loads.weight.moment[i]);
        if floats {
            add(format!("base/{axis}"), i, |base, i| base.origin[i]);
            add(format!("attitude_rate/base_{axis}"), i, |base, i| base.rate[i]);
        }
    }
    for (i, part) in ["w", "x", "y", "z"].into_iter().enumerate().filter(|_| floats) {
        add(format!("attitude/base_{part}"), i, |base, i| base.attitude.components()[i]);
    }
    table
}

/// Returns symbol, label and unit of a signal from the dictionary of results.
fn described(path: &str) -> [&'static str; 3] {
    results::signal(path).map_or(["", "", "1"], |row| [row.symbol, row.meaning, row.unit])
}

/// Returns every signal of a machine, in a fixed order.
pub fn signals(machine: &Machine) -> Vec<Signal> {
    let mut table = Vec::new();
    let n = machine.drives();
    type Row = (&'static str, fn(&Frame, usize) -> f64);
    let per_drive: [Row; 7] = [
        ("torque/*", |f, k| f.torque[k]),
        ("angle/*", |f, k| f.q[k]),
        ("rate/*", |f, k| f.qd[k]),
        ("acceleration/*", |f, k| f.qdd[k]),
        ("reference/*", |f, k| f.q_reference[k]),
        ("error/*", |f, k| f.q_reference[k] - f.relative(k)),
        ("friction/*", |f, k| f.friction[k]),
    ];
    for (path, value) in per_drive {
        let [symbol, label, unit] = described(path);
        for k in 0..n {
            let drive = &machine.spec().drives[k];
            let name = &drive.name;
            table.push(Signal {
                path: path.replace('*', name),
                symbol: symbol.replace('*', &subscript(k + 1)),
                label: label.replace('*', name),
                unit,
                drive: Some(k),
                limit: LIMITED
                    .iter()
                    .find(|(group, ..)| path.strip_suffix("/*") == Some(group))
                    .and_then(|(.., limit)| limit(drive)),
                block: 0,
                quantity: Quantity::PerIndex(k, value),
            });
        }
    }
    let [symbol, label, unit] = described("joint/*");
    for (i, angle) in machine.angles().iter().enumerate() {
        table.push(Signal {
            path: format!("joint/{}", angle.name),
            symbol: symbol.replace('*', &subscript(i + 1)),
            label: label.replace('*', &angle.name),
            unit,
            drive: Some(angle.to),
            limit: None,
            block: 0,
            quantity: Quantity::PerIndex(i, |f, i| f.a[i]),
        });
    }
    type Single = (&'static str, fn(&Frame) -> f64);
    let whole: &[Single] = &[
        ("pose/b", |f| f.b),
        ("pose/b_reference", |f| f.b_reference),
        ("moment/total", |f| f.base_moment()),
        ("moment/dynamic", |f| f.wrench.dynamic.moment),
        ("moment/felt", |f| f.felt_moment),
        ("moment/wheel", |f| f.wheel.torque),
        ("moment/rms", |f| f.totals.moment_rms()),
        ("moment/static", |f| f.wrench.static_part.moment),
        ("force/dynamic", |f| f.wrench.dynamic.force.norm()),
        ("force/rms", |f| f.totals.force_rms()),
        ("force/dynamic_x", |f| f.wrench.dynamic.force.re),
        ("force/dynamic_y", |f| f.wrench.dynamic.force.im),
        ("force/static_x", |f| f.wrench.static_part.force.re),
        ("force/static_y", |f| f.wrench.static_part.force.im),
        ("momentum/x", |f| f.momentum.re),
        ("momentum/y", |f| f.momentum.im),
        ("angular_momentum/about_b", |f| f.angular_momentum),
        ("com/x", |f| f.com.re),
        ("com/y", |f| f.com.im),
        ("tip/x", |f| f.end_effector.re),
        ("tip/y", |f| f.end_effector.im),
        ("target/x", |f| f.target.at.re),
        ("target/y", |f| f.target.at.im),
        ("base/x", |f| f.base.at.re),
        ("base/y", |f| f.base.at.im),
        ("attitude/base", |f| f.base.angle),
        ("attitude_rate/base", |f| f.base_rate),
        ("base_velocity/x", |f| f.base_velocity.re),
        ("base_velocity/y", |f| f.base_velocity.im),
        ("wheel/rate", |f| f.wheel.rate),
        ("impulse/force", |f| f.totals.force_impulse),
        ("angular_impulse/moment", |f| f.totals.moment_impulse),
        ("payload/held", |f| f64::from(u8::from(f.loaded))),
        ("wheel_saturated/now", |f| f64::from(u8::from(f.wheel.saturated))),
        ("energy/kinetic", |f| f.kinetic),
        ("energy/motors", |f| f.totals.energy),
        ("audit_energy/balance", |f| f.audit.energy),
        ("audit_momentum/linear", |f| f.audit.momentum),
        ("audit_angular/about_o", |f| f.audit.angular),
        ("audit_closure/worst", |f| f.audit.closure),
        ("audit_step/worst", |f| f.audit.step),
        ("audit_plane/b", |f| f.audit.plane),
        ("dexterity/det", |f| f.dexterity.det),
        ("dexterity/manipulability", |f| f.dexterity.manipulability),
        ("torque_per_force/worst", |f| f.dexterity.worst_torque_per_force),
        ("transmission/least", |f| f.transmission),
        ("reactionless/now", |f| f64::from(u8::from(f.is_base_unloaded()))),
    ];
    for &(path, value) in whole {
        let [symbol, label, unit] = described(path);
        table.push(Signal {
            path: path.into(),
            symbol: symbol.into(),
            label: label.into(),
            unit,
            drive: None,
            limit: None,
            block: 0,
            quantity: Quantity::Whole(value),
        });
    }
    table.extend(inside(machine));
    table
}

/// Returns the signals of pin forces (if they can be determined), tilting moments, transmission and change points.
fn inside(machine: &Machine) -> Vec<Signal> {
    let mut table = Vec::new();
    // The names stand for `*` in path, symbol and label.
    let mut add = |path: &str, names: [&str; 3], drive, quantity| {
        let [symbol, label, unit] = described(path);
        table.push(Signal {
            path: path.replace('*', names[0]),
            symbol: symbol.replace('*', names[1]),
            label: label.replace('*', names[2]),
            unit,
            drive,
            limit: None,
            block: 0,
            quantity,
        });
    };
    if let Ok(joints) = Joints::of(machine) {
        for (i, pin) in joints.pins().iter().enumerate().take(MAX_FRAME_PINS) {
            let drive = Some(machine.resolved_links()[pin.to].drive);
            add("pin/*", [&pin.name; 3], drive, Quantity::PerIndex(i, |f, i| f.inside.size(i)));
        }
        let worst = Quantity::Whole(|f| f.inside.largest_force);
        add("pin/worst", [""; 3], None, worst);
    }
    let tilt = |value: fn(&Frame) -> f64| Quantity::Whole(value);
    let (x, y) = (tilt(|f| f.inside.tilt.total().re), tilt(|f| f.inside.tilt.total().im));
    for (path, value) in [("tilt/x", x), ("tilt/y", y)] {
        add(path, [""; 3], None, value);
    }
    let drives = &machine.spec().drives;
    for (k, l) in Inertia::pairs(drives.len()) {
        let (a, b) = (&drives[k].name, &drives[l].name);
        let pair = if a.chars().count() + b.chars().count() == 2 { format!("{a}{b}") } else { format!("{a}_{b}") };
        let angles = format!("q{} − q{}", subscript(k + 1), subscript(l + 1));
        let value = Quantity::PerIndex(MAX_DRIVES * k + l, |f, pair| {
            joint_forces::pair_transmission(&f.q.units(), pair / MAX_DRIVES, pair % MAX_DRIVES)
        });
        add("transmission/*", [&pair, &angles, &format!("{a} and {b}")], None, value);
    }
    if drives.len() > 1 {
        let value = Quantity::Whole(|f| joint_forces::nearest_change_point(&f.q, &f.qd).map_or(0.0, |c| c.distance));
        add("change_point/distance", [""; 3], None, value);
    }
    table
}
