//! What several tests share: reference files, the twin of a machine, states and planes at random, comparison by scale.

use std::sync::Arc;

use proptest::prelude::*;
use serde_json::Value;
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Chain, Machine, PlaceOnLink, builtin, parse};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::curves::path::{PathError, minimum_norm_path};
use stillbase::planning::curves::{CurvePoint, PathTable};
use stillbase::planning::pose_space::{Planes, PoseSpace};
use stillbase::planning::reactionless::{AngleDefinition, AngleLimit, PlaneMap};

use crate::mechanics::nine_body::NineBody;

mod noise;
pub mod random;

pub use noise::Noise;

pub fn dynamics() -> Value {
    serde_json::from_str(include_str!("reference/dynamics.json")).expect("valid JSON")
}

pub fn planning() -> Value {
    serde_json::from_str(include_str!("reference/planning.json")).expect("valid JSON")
}

pub fn family() -> Value {
    serde_json::from_str(include_str!("reference/family.json")).expect("valid JSON")
}

/// The planes of a machine that has some.
pub fn planes(machine: &Machine) -> Arc<Planes> {
    PoseSpace::of(machine).expect("it has a b").planes().expect("three drives").clone()
}

/// The straight line of the end effector from where a pose has it, with minimum-norm rates (case 1).
pub fn tip_line(tip: &Chain, start: DriveAngles, to: Vector) -> Result<PathTable, PathError> {
    let from = end_effector(tip, &start.units());
    minimum_norm_path(tip, start, |s| CurvePoint {
        p: from + s * (to - from),
        first: to - from,
        second: Vector::default(),
    })
}

/// A machine of the reference.
pub fn family_machine(name: &str) -> Machine {
    let text = match name {
        "two-drive" => include_str!("reference/family/two-drive.toml"),
        "two-drive-balanced" => include_str!("reference/family/two-drive-balanced.toml"),
        "serial-3r" => include_str!("reference/family/serial-3r.toml"),
        "serial-3r-balanced" => include_str!("reference/family/serial-3r-balanced.toml"),
        "four-drive" => include_str!("reference/family/four-drive.toml"),
        "four-drive-balanced" => include_str!("reference/family/four-drive-balanced.toml"),
        "nine-link-geared" => include_str!("reference/family/nine-link-geared.toml"),
        "nine-link-geared-balanced" => include_str!("reference/family/nine-link-geared-balanced.toml"),
        "nine-link-bare" => include_str!("reference/family/nine-link-bare.toml"),
        "nine-link-bare-balanced" => include_str!("reference/family/nine-link-bare-balanced.toml"),
        _ => panic!("no machine {name}"),
    };
    parse(text, name).expect("a machine")
}

/// Every number of a value, row by row.
pub fn numbers(v: &Value) -> Vec<f64> {
    match v {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        v => vec![v.as_f64().expect("a number")],
    }
}

pub fn array<const N: usize>(v: &Value) -> [f64; N] {
    numbers(v).try_into().expect("the length of the array")
}

/// Largest error over max(1e-3, largest wanted).
pub fn error(got: &[f64], want: &[f64]) -> f64 {
    assert_eq!(got.len(), want.len());
    let scale = want.iter().fold(1e-3_f64, |m, w| m.max(w.abs()));
    // NaN must not pass as small.
    got.iter().zip(want).fold(0.0, |m, (g, w)| if ((g - w).abs() / scale) <= m { m } else { (g - w).abs() / scale })
}

#[track_caller]
pub fn close(what: &str, got: &[f64], want: &[f64], tolerance: f64) {
    let error = error(got, want);
    assert!(error <= tolerance, "{what}: got {got:?}, want {want:?}, error {error:e} above {tolerance:e}");
}

pub fn xy(v: Vector) -> [f64; 2] {
    [v.re, v.im]
}

pub fn three(v: &PerDrive) -> [f64; 3] {
    [v[0], v[1], v[2]]
}

pub fn angles(q: &DriveAngles) -> [f64; 3] {
    three(&q.0)
}

/// The library's machine with the numbers of a twin, all set by key.
pub fn machine_of(body: &NineBody) -> Machine {
    let mut settings: Vec<(String, String)> = Vec::new();
    for j in 0..9 {
        for (field, value) in [("mass", body.mass[j]), ("inertia", body.inertia[j]), ("com", body.com[j])] {
            settings.push((format!("link.{}.{field}", j + 1), value.to_string()));
        }
    }
    for (name, j) in [("l1", 0), ("l2", 1), ("l3", 2), ("l5", 4), ("l9", 8)] {
        settings.push((format!("length.{name}"), body.length[j].to_string()));
    }
    settings.push(("gravity".into(), format!("{},{}", body.gravity[0], body.gravity[1])));
    settings.push(("payload.mass".into(), body.payload.to_string()));
    let table_1 = builtin("nine-link-table-1").expect("built in");
    table_1.set_all(settings.iter().map(|(k, v)| (k.as_str(), v.as_str()))).expect("a valid machine")
}

/// The twin of a machine of nine links.
pub fn body_of(machine: &Machine) -> NineBody {
    let spec = machine.spec();
    assert_eq!(spec.links.len(), 9);
    assert!(spec.links.iter().all(|l| l.com_normal == 0.0) && spec.payload.inertia == 0.0, "the twin has neither");
    assert!(matches!(&spec.end_effector.as_ref().expect("one").at, PlaceOnLink::Named(n) if n == "tip"));
    let of = |f: &dyn Fn(usize) -> f64| std::array::from_fn(f);
    NineBody {
        length: of(&|j| machine.resolved_links()[j].length),
        mass: of(&|j| spec.links[j].mass),
        inertia: of(&|j| spec.links[j].inertia),
        com: of(&|j| spec.links[j].com),
        gravity: spec.gravity,
        payload: spec.payload.mass,
    }
}

/// Any nine-link machine: nothing is balanced, parallelograms close.
pub fn any_body() -> impl Strategy<Value = NineBody> {
    let nine = |range: std::ops::Range<f64>| prop::collection::vec(range, 9);
    let lengths = prop::collection::vec(0.1..0.7, 5);
    (lengths, nine(0.1..8.0), nine(1e-3..0.3), nine(-0.4..0.4), (-12.0..12.0, -12.0..12.0), 0.0..2.0).prop_map(
        |(l, m, i, c, (gx, gy), payload)| NineBody {
            length: [l[0], l[1], l[2], l[0], l[3], l[0], l[2], l[3], l[4]],
            mass: std::array::from_fn(|j| m[j]),
            inertia: std::array::from_fn(|j| i[j]),
            com: std::array::from_fn(|j| c[j]),
            gravity: [gx, gy],
            payload,
        },
    )
}

/// Random limits, some folded, some not.
pub fn limits() -> impl Strategy<Value = [[f64; 2]; 2]> {
    let limit = || (-4.0..4.0, 0.05..6.2).prop_map(|(min, width)| [min, min + width]);
    (limit(), limit()).prop_map(|(a1, a2)| [a1, a2])
}

/// Random machines: any proportions, any two angles that join all three drives.
pub fn machines() -> impl Strategy<Value = PlaneMap> {
    let angles = (0..3_usize, 1..3_usize, any::<[bool; 2]>(), [-3.0..3.0, -3.0..3.0]);
    let c = [-1.0..1.0, -1.0..1.0, -1.0..1.0];
    (c, [0.05..2.0, 0.05..2.0], angles, limits()).prop_map(|(c, l, (first, skip, flip, offset), limits)| {
        let pairs = [(0, 1), (1, 2), (0, 2)];
        let angles = [0, 1].map(|i| {
            let (a, b) = pairs[(first + i * skip) % 3];
            let (to, from) = if flip[i] { (a, b) } else { (b, a) };
            AngleDefinition { to, from, offset: offset[i] }
        });
        PlaneMap::new(c, [1.0, l[0], l[1]], angles, limits.map(|[min, max]| AngleLimit { min, max })).unwrap()
    })
}

/// A state of motion.
#[derive(Clone, Copy, Debug)]
pub struct State {
    pub q: DriveAngles,
    pub qd: PerDrive,
    pub qdd: PerDrive,
}

impl State {
    pub fn new(q: [f64; 3], qd: [f64; 3], qdd: [f64; 3]) -> Self {
        Self { q: q.into(), qd: qd.into(), qdd: qdd.into() }
    }
}
