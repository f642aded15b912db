//! [`TableData`]: a motion or a measurement, distinguished by its columns and the base.

use super::column::angles;
use super::error::TableError;
use super::measured::{has_base_reaction, motions, motions_or};
use super::opened::Table;
use super::samples::{SampleTable, samples_or};
use stillbase_mechanics::machine::Machine;
use stillbase_study::trim::{BASE_RATE, MeasuredMotion, OrbitMotion};

/// Content of a table.
#[derive(Debug)]
pub enum TableData {
    /// A motion, given by samples.
    Motion(SampleTable),
    /// Measured motions of a built machine, with forces and moments on its base.
    Measurement(Vec<MeasuredMotion>),
    /// A motion of a machine on a base that floats, with the rates of its base.
    Orbit(OrbitMotion),
}

impl TableData {
    /// Reads a table that is a motion or a measurement. If the base `floats` and the table has its rate, it is a
    /// measurement in orbit. If it has a column of a force or a moment on the base, it is a measurement, which
    /// [`motions`](super::motions) reads. Otherwise it is a motion, which [`samples`](super::samples()) reads. `gaps`
    /// allows gaps in the time of a motion.
    ///
    /// # Errors
    /// If the table is neither; the error has its place and the expected columns of both kinds.
    pub fn of(table: &Table, machine: &Machine, floats: bool, gaps: bool) -> Result<Self, TableError> {
        let want = head_wanted(machine);
        let head = Head::of(table, &want)?;
        match () {
            () if floats && head.base_rate => orbit_motion(table, machine).map(Self::Orbit),
            () if head.reaction => motions_or(table, machine, &want).map(Self::Measurement),
            () => samples_or(table, machine, None, gaps, &want).map(Self::Motion),
        }
    }

    /// Reads a table that is a measurement, on a base that `floats` or stands still.
    ///
    /// # Errors
    /// If the table is no measurement.
    pub fn measurement(table: &Table, machine: &Machine, floats: bool) -> Result<Self, TableError> {
        let head = Head::of(table, &head_wanted(machine))?;
        match floats && (head.base_rate || !head.reaction) {
            true => orbit_motion(table, machine).map(Self::Orbit),
            false => motions(table, machine).map(Self::Measurement),
        }
    }
}

/// What the head of a table tells of its kind.
struct Head {
    base_rate: bool,
    reaction: bool,
}

impl Head {
    fn of(table: &Table, want: &str) -> Result<Self, TableError> {
        let reader = table.reader(want)?;
        let rate = |cell: &str| cell.trim().to_lowercase().starts_with(BASE_RATE);
        Ok(Self { base_rate: reader.head().iter().any(rate), reaction: has_base_reaction(reader.head()) })
    }
}

/// Reads a motion in orbit from signals as a simulation records them, as [`OrbitMotion::of`] takes them.
///
/// # Errors
/// If the table has no such signals.
pub fn orbit_motion(table: &Table, machine: &Machine) -> Result<OrbitMotion, TableError> {
    OrbitMotion::of(machine, &table.signals()?).map_err(|why| TableError::of_file(&table.name, why))
}

fn head_wanted(machine: &Machine) -> String {
    let q = angles(machine);
    format!("a header t,{q} (rad) or t,x,y (m) of a motion, or t,{q},fx,fy,nz (s, rad, N, N m) of a measurement")
}
