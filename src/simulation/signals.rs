//! Table of signals: each is a curve of a plot, a series of the recording and a column of the CSV.

use crate::frame::Frame;
use stillbase_mechanics::joint_forces::{self, Joints, MAX_FRAME_PINS};
use stillbase_mechanics::machine::{Drive, Inertia, Machine};
use stillbase_mechanics::planar::MAX_DRIVES;
use stillbase_query::QuickQuery;
use stillbase_settings::number::subscript;

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
    quantity: Quantity,
}

#[derive(Clone, Copy, Debug)]
enum Quantity {
    PerIndex(usize, fn(&Frame, usize) -> f64),
    Whole(fn(&Frame) -> f64),
}

/// Compares the paths and the indices of the drive, angle or pin: the same path may mean another drive on another
/// machine.
impl PartialEq for Signal {
    fn eq(&self, other: &Self) -> bool {
        let place = |signal: &Self| match signal.quantity {
            Quantity::PerIndex(k, _) => Some(k),
            Quantity::Whole(_) => None,
        };
        self.path == other.path && place(self) == place(other)
    }
}

impl Signal {
    /// Returns the value at one instant.
    #[inline]
    pub fn value(&self, frame: &Frame) -> f64 {
        match self.quantity {
            Quantity::PerIndex(k, f) => f(frame, k),
            Quantity::Whole(f) => f(frame),
        }
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
        self.path.split('/').next().unwrap_or(&self.path)
    }
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

/// Returns the signals of some names, in the order of the table. A name is a path, or the first part of several paths.
///
/// # Errors
/// If no signal has one of the names; the error is that name.
pub fn chosen_signals<'a>(table: &[Signal], names: &'a [String]) -> Result<Vec<Signal>, &'a String> {
    let is_of = |signal: &Signal, name: &String| signal.path == *name || signal.group() == name;
    match names.iter().find(|name| !table.iter().any(|signal| is_of(signal, name))) {
        Some(unknown) => Err(unknown),
        None => Ok(table.iter().filter(|signal| names.iter().any(|name| is_of(signal, name))).cloned().collect()),
    }
}

/// Query for the signals of a machine.
#[derive(Debug)]
pub struct SignalsOf;

impl QuickQuery for SignalsOf {
    type Input = Machine;
    type Answer = Vec<Signal>;

    fn answer(machine: &Machine) -> Vec<Signal> {
        signals(machine)
    }
}

/// Returns every signal of a machine, in a fixed order.
pub fn signals(machine: &Machine) -> Vec<Signal> {
    let mut table = Vec::new();
    let n = machine.drives();
    type Row = (&'static str, &'static str, &'static str, &'static str, fn(&Frame, usize) -> f64);
    let per_drive: [Row; 7] = [
        ("torque", "τ", "torque of drive", "N m", |f, k| f.torque[k]),
        ("angle", "q", "angle of drive", "rad", |f, k| f.q[k]),
        ("rate", "q̇", "rate of drive", "rad/s", |f, k| f.qd[k]),
        ("acceleration", "q̈", "acceleration of drive", "rad/s²", |f, k| f.qdd[k]),
        ("reference", "q ref", "reference of drive", "rad", |f, k| f.q_reference[k]),
        ("error", "e", "tracking error of drive", "rad", |f, k| f.q_reference[k] - f.relative(k)),
        ("friction", "τ f", "friction in the bearing of drive", "N m", |f, k| f.friction[k]),
    ];
    for (path, symbol, label, unit, value) in per_drive {
        for k in 0..n {
            let drive = &machine.spec().drives[k];
            let name = &drive.name;
            table.push(Signal {
                path: format!("{path}/{name}"),
                symbol: format!("{symbol}{}", subscript(k + 1)),
                label: format!("{label} {name}"),
                unit,
                drive: Some(k),
                limit: LIMITED.iter().find(|(group, ..)| *group == path).and_then(|(.., limit)| limit(drive)),
                quantity: Quantity::PerIndex(k, value),
            });
        }
    }
    for (i, angle) in machine.angles().iter().enumerate() {
        table.push(Signal {
            path: format!("joint/{}", angle.name),
            symbol: format!("a{}", subscript(i + 1)),
            label: format!("relative joint angle {}", angle.name),
            unit: "rad",
            drive: Some(angle.to),
            limit: None,
            quantity: Quantity::PerIndex(i, |f, i| f.a[i]),
        });
    }
    type Single = (&'static str, &'static str, &'static str, &'static str, fn(&Frame) -> f64);
    let whole: &[Single] = &[
        ("pose/b", "b", "pose constant", "rad", |f| f.b),
        ("pose/b_reference", "b ref", "pose constant aimed at", "rad", |f| f.b_reference),
        ("moment/total", "n_B", "turning moment on the base", "N m", |f| f.base_moment()),
        ("moment/dynamic", "n_B dyn", "turning moment on the base, from motion", "N m", |f| f.wrench.dynamic.moment),
        ("moment/felt", "n felt", "turning moment that the base feels: n_B less a wheel's", "N m", |f| {
            f.net_base_moment()
        }),
        ("moment/wheel", "τ_w", "torque of the reaction wheel", "N m", |f| f.wheel.torque),
        ("moment/rms", "n rms", "root mean square of the moment so far", "N m", |f| f.totals.moment_rms()),
        ("moment/static", "n_B stat", "turning moment on the base, from weight", "N m", |f| {
            f.wrench.static_part.moment
        }),
        ("force/dynamic", "|f_B|", "force on the base, from motion", "N", |f| f.wrench.dynamic.force.norm()),
        ("force/rms", "f rms", "root mean square of |f_B| so far", "N", |f| f.totals.force_rms()),
        ("force/dynamic_x", "f_Bx", "force on the base along x, from motion", "N", |f| f.wrench.dynamic.force.re),
        ("force/dynamic_y", "f_By", "force on the base along y, from motion", "N", |f| f.wrench.dynamic.force.im),
        ("force/static_x", "f_Bx stat", "force on the base along x, from weight", "N", |f| {
            f.wrench.static_part.force.re
        }),
        ("force/static_y", "f_By stat", "force on the base along y, from weight", "N", |f| {
            f.wrench.static_part.force.im
        }),
        ("momentum/x", "p_x", "linear momentum along x", "kg m/s", |f| f.momentum.re),
        ("momentum/y", "p_y", "linear momentum along y", "kg m/s", |f| f.momentum.im),
        ("angular_momentum/about_b", "h_B", "angular momentum about the origin", "kg m²/s", |f| f.angular_momentum),
        ("com/x", "x_CM", "centre of mass, x", "m", |f| f.com.re),
        ("com/y", "y_CM", "centre of mass, y", "m", |f| f.com.im),
        ("tip/x", "x", "end effector, x", "m", |f| f.end_effector.re),
        ("tip/y", "y", "end effector, y", "m", |f| f.end_effector.im),
        ("target/x", "x target", "target, x", "m", |f| f.target.at.re),
        ("target/y", "y target", "target, y", "m", |f| f.target.at.im),
        ("base/x", "x_B", "base, x", "m", |f| f.base.at.re),
        ("base/y", "y_B", "base, y", "m", |f| f.base.at.im),
        ("attitude/base", "θ", "attitude of the base", "rad", |f| f.base.angle),
        ("attitude_rate/base", "θ̇", "rate of the base", "rad/s", |f| f.base_rate),
        ("base_velocity/x", "ẋ_B", "velocity of the base, x", "m/s", |f| f.base_velocity.re),
        ("base_velocity/y", "ẏ_B", "velocity of the base, y", "m/s", |f| f.base_velocity.im),
        ("wheel/rate", "Ω", "rate of the reaction wheel", "rad/s", |f| f.wheel.rate),
        ("impulse/force", "∫|f|dt", "impulse of |f_B| so far", "N s", |f| f.totals.force_impulse),
        ("angular_impulse/moment", "∫|n|dt", "impulse of the moment so far", "N m s", |f| f.totals.moment_impulse),
        ("payload/held", "held", "1 while the payload unknown to the model is held", "1", |f| {
            f64::from(u8::from(f.loaded))
        }),
        ("wheel_saturated/now", "sat", "1 while the wheel cannot give what is wanted", "1", |f| {
            f64::from(u8::from(f.wheel.saturated))
        }),
        ("energy/kinetic", "T", "kinetic energy", "J", |f| f.kinetic),
        ("energy/motors", "W motors", "energy that motors took, none given back", "J", |f| f.totals.energy),
        ("audit_energy/balance", "ΔE − W", "energy gained less work done, plus losses", "J", |f| f.audit.energy),
        ("audit_momentum/linear", "p + ∫f dt", "momentum and impulse on the base", "kg m/s", |f| f.audit.momentum),
        ("audit_angular/about_o", "h + ∫n dt", "angular momentum and its impulse", "kg m²/s", |f| f.audit.angular),
        ("audit_closure/worst", "gap", "worst gap in a pin that closes a loop", "m", |f| f.audit.closure),
        ("audit_step/worst", "h err", "error from the size of the step, as a share of the peaks", "1", |f| {
            f.audit.step
        }),
        ("audit_plane/b", "b − b ref", "distance from the plane", "rad", |f| f.audit.plane),
        ("dexterity/det", "|det|", "|det| of ∂(x, y)/∂(a₁, a₂) on the plane", "m²", |f| f.dexterity.det),
        ("dexterity/manipulability", "w", "manipulability √det J J*", "m²", |f| f.dexterity.manipulability),
        (
            "torque_per_force/worst",
            "|τ|/|F|",
            "torque of all drives for the worst unit force at the end effector",
            "N m/N",
            |f| f.dexterity.worst_torque_per_force,
        ),
        ("transmission/least", "min |sin|", "least |sin(q_k − q_l)|, 0 at a change point", "1", |f| f.transmission),
        ("reactionless/now", "reactionless", "1 while the base feels nothing", "1", |f| {
            f64::from(u8::from(f.is_base_unloaded()))
        }),
    ];
    for &(path, symbol, label, unit, value) in whole {
        table.push(Signal {
            path: path.into(),
            symbol: symbol.into(),
            label: label.into(),
            unit,
            drive: None,
            limit: None,
            quantity: Quantity::Whole(value),
        });
    }
    table.extend(inside(machine));
    table
}

/// Returns the signals of pin forces (if they can be determined), tilting moments, transmission and change points.
fn inside(machine: &Machine) -> Vec<Signal> {
    let mut table = Vec::new();
    let mut add = |path: String, symbol: String, label: String, unit, drive, quantity| {
        table.push(Signal { path, symbol, label, unit, drive, limit: None, quantity });
    };
    if let Ok(joints) = Joints::of(machine) {
        for (i, pin) in joints.pins().iter().enumerate().take(MAX_FRAME_PINS) {
            let path = format!("pin/{}", pin.name);
            let (symbol, label) = (format!("F {}", pin.name), format!("force of pin {}", pin.name));
            let drive = Some(machine.resolved_links()[pin.to].drive);
            add(path, symbol, label, "N", drive, Quantity::PerIndex(i, |f, i| f.inside.size(i)));
        }
        let worst = Quantity::Whole(|f| f.inside.largest_force);
        add("pin/worst".into(), "F worst".into(), "largest force of a pin".into(), "N", None, worst);
    }
    let tilt = |value: fn(&Frame) -> f64| Quantity::Whole(value);
    let (x, y) = (tilt(|f| f.inside.tilt.total().re), tilt(|f| f.inside.tilt.total().im));
    for (axis, value) in [("x", x), ("y", y)] {
        let label = format!("moment about {axis} that tilts the base");
        add(format!("tilt/{axis}"), format!("n_{axis}"), label, "N m", None, value);
    }
    let drives = &machine.spec().drives;
    for (k, l) in Inertia::pairs(drives.len()) {
        let (a, b) = (&drives[k].name, &drives[l].name);
        let pair = if a.chars().count() + b.chars().count() == 2 { format!("{a}{b}") } else { format!("{a}_{b}") };
        let symbol = format!("|sin(q{} − q{})|", subscript(k + 1), subscript(l + 1));
        let label = format!("transmission of drives {a} and {b}, 0 at a change point");
        let value = Quantity::PerIndex(MAX_DRIVES * k + l, |f, pair| {
            joint_forces::pair_transmission(&f.q.units(), pair / MAX_DRIVES, pair % MAX_DRIVES)
        });
        add(format!("transmission/{pair}"), symbol, label, "1", None, value);
    }
    if drives.len() > 1 {
        let label = "least |q_k − q_l − mπ|: how far the nearest change point is".into();
        let value = Quantity::Whole(|f| joint_forces::nearest_change_point(&f.q, &f.qd).map_or(0.0, |c| c.distance));
        add("change_point/distance".into(), "Δq".into(), label, "rad", None, value);
    }
    table
}
