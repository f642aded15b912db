//! [`DesignMeasures`]: a machine's mass, inertia and balance residuals, and its comparison with the machine of another
//! run.

use std::borrow::Cow;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::summary::{SummaryColumn, column};
use crate::measures::{Beta, Measures};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_planning::Motion;
use stillbase_session::Run;
use stillbase_session::scenario::Task;
use stillbase_settings::number::counted;

/// Points that are nearer than this are the same, m.
const PLACE_TOLERANCE_M: f64 = 1e-9;

/// A machine with its task and motion.
#[derive(Clone, Debug)]
pub struct DesignCandidate {
    machine: Machine,
    task: Task,
    motion: Arc<Motion>,
}

/// Measures of a machine, and its comparison with another one.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignMeasures {
    /// Mass of the machine, kg.
    pub mass: f64,
    /// Inertia of all drives, Σ D_k, kg m².
    pub inertia: f64,
    /// Residuals of the balance conditions: of (7), largest |g_k|, kg m; of (8), largest |C_kl|, kg m².
    pub residuals: [f64; 2],
    /// Comparison with the machine of the first run, in the first run's motion; without β if that motion does not
    /// apply.
    pub comparison: Option<Measures>,
    /// Reason, if any, for a missing comparison or a missing β.
    pub why_not: Option<String>,
}

/// Columns of a table of designs, in order.
pub const DESIGN_COLUMNS: [SummaryColumn<DesignMeasures>; 10] = [
    column(["mass", "mass", "mass", "mass of the machine"], "kg", 3, 21, |d| Some(d.mass)),
    column(["inertia", "effective inertia", "Σ D", "inertia of all drives, Σ D"], "kg m²", 4, 16, |d| {
        Some(d.inertia)
    }),
    column(
        ["force_left", "worst imbalance", "worst (7)", "largest |g|, the residual of force balance (7)"],
        "kg m",
        5,
        4,
        |d| Some(d.residuals[0]),
    ),
    column(
        ["coupling_left", "worst coupling", "worst (8)", "largest |C|, the residual of invariance (8)"],
        "kg m²",
        5,
        3,
        |d| Some(d.residuals[1]),
    ),
    column(["added_mass", "added mass", "added", "mass less that of the first run's machine"], "kg", 3, 17, |d| {
        Some(d.comparison?.added_mass)
    }),
    column(
        ["added_inertia", "added inertia", "added Σ D", "Σ D less that of the first run's machine"],
        "kg m²",
        4,
        9,
        |d| Some(d.comparison?.added_inertia),
    ),
    column(
        [
            "mass_inertia_factor",
            "mass–inertia factor",
            "factor",
            "mass–inertia factor: both as ratios to the first, summed",
        ],
        "1",
        3,
        2,
        |d| d.comparison?.mass_inertia_factor,
    ),
    column(
        [
            "beta_force",
            "share of force",
            "β force",
            "force on the base in the first run's motion, as a fraction of that of the first machine",
        ],
        "1",
        4,
        0,
        |d| d.beta()?.force,
    ),
    column(
        [
            "beta_moment",
            "share of moment",
            "β moment",
            "moment on the base in the first run's motion, as a fraction of that of the first machine",
        ],
        "1",
        4,
        11,
        |d| d.beta()?.moment,
    ),
    column(
        [
            "beta_torque",
            "share of torque",
            "β torque",
            "torques in the first run's motion, as a fraction of those of the first machine",
        ],
        "1",
        4,
        1,
        |d| d.beta()?.torque,
    ),
];

impl DesignCandidate {
    /// Returns the machine, task and motion of a run at its end, after all edits.
    pub fn of(run: &Run) -> Self {
        let scenario = run.scenario();
        Self { machine: scenario.machine.clone(), task: scenario.task.clone(), motion: run.plan().motion.clone() }
    }

    /// Compares this machine with the first of several.
    pub fn compared_with(&self, first: &Self) -> DesignMeasures {
        let inertia = Inertia::of(&self.machine);
        let mut design = DesignMeasures {
            mass: self.machine.mass(),
            inertia: inertia.total_momentum(),
            residuals: [inertia.force_residual(), inertia.invariance_residual()],
            comparison: None,
            why_not: None,
        };
        let [own, other] = [self, first].map(|one| one.machine.drives());
        if own != other {
            let [own, other] = [own, other].map(|count| counted(count, "drive"));
            design.why_not = Some(format!("it has {own} and the first {other}: the two are not compared"));
            return design;
        }
        let motion = match (self.is_alike(first), self.differs(first)) {
            // Between equal machines every β is 1: no motion is needed.
            (true, _) => None,
            (_, Some(what)) => {
                design.why_not = Some(format!("{what} differs from that of the first: no β of the same motion"));
                None
            }
            _ => Some(&*first.motion),
        };
        design.comparison = Some(Measures::of(&first.machine, &self.machine, motion));
        design
    }

    /// Returns whether the machines are equal.
    pub fn is_alike(&self, other: &Self) -> bool {
        self.machine == other.machine
    }

    /// Returns the difference due to which one motion of the drives cannot perform both tasks, if there is one.
    fn differs(&self, first: &Self) -> Option<&'static str> {
        if self.machine.end_effector() != first.machine.end_effector() {
            return Some("the arm's length");
        }
        let [own, other] = [self, first].map(|one| one.task.points());
        // A point that a pose gives is rounded.
        let is_near =
            own.len() == other.len() && own.iter().zip(&other).all(|(p, q)| (p - q).norm() <= PLACE_TOLERANCE_M);
        (!(is_near && self.task.closed == first.task.closed)).then_some("its task")
    }
}

/// Serialised as the available columns, and the reason if others are missing.
impl Serialize for DesignMeasures {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for column in DESIGN_COLUMNS {
            if let Some(value) = (column.value)(self) {
                map.serialize_entry(column.key, &value)?;
            }
        }
        if let Some(why) = &self.why_not {
            map.serialize_entry("apart", why)?;
        }
        map.end()
    }
}

impl DesignMeasures {
    fn beta(&self) -> Option<Beta> {
        self.comparison?.beta
    }
}

impl JsonSchema for DesignMeasures {
    fn schema_name() -> Cow<'static, str> {
        "DesignMeasures".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({ "type": "object", "properties": { "apart": { "type": "string" } } });
        let properties = schema.get_mut("properties").and_then(|properties| properties.as_object_mut());
        properties.into_iter().for_each(|properties| {
            let number = || json_schema!({ "type": "number" }).to_value();
            properties.extend(DESIGN_COLUMNS.iter().map(|column| (column.key.to_owned(), number())));
        });
        schema
    }
}
