//! [`TableData`]: a motion or a measurement, distinguished by its columns.

use super::column::angles;
use super::error::TableError;
use super::measured::{has_base_reaction, motions_or};
use super::opened::Table;
use super::samples::{SampleTable, samples_or};
use stillbase_mechanics::machine::Machine;
use stillbase_study::trim::MeasuredMotion;

/// Content of a table.
#[derive(Debug)]
pub enum TableData {
    /// A motion, given by samples.
    Motion(SampleTable),
    /// Measured motions of a built machine, with forces and moments on its base.
    Measurement(Vec<MeasuredMotion>),
}

impl TableData {
    /// Reads a table that is a motion or a measurement. If it has a column of a force or a moment on the base, it is a
    /// measurement, which [`motions`](super::motions) reads. Otherwise it is a motion, which
    /// [`samples`](super::samples()) reads. `gaps` allows gaps in the time of a motion.
    ///
    /// # Errors
    /// If the table is neither; the error has its place and the expected columns of both kinds.
    pub fn of(table: &Table, machine: &Machine, gaps: bool) -> Result<Self, TableError> {
        let want = head_wanted(machine);
        match has_base_reaction(table.reader(&want)?.head()) {
            true => motions_or(table, machine, &want).map(Self::Measurement),
            false => samples_or(table, machine, None, gaps, &want).map(Self::Motion),
        }
    }
}

fn head_wanted(machine: &Machine) -> String {
    let q = angles(machine);
    format!("a header t,{q} (rad) or t,x,y (m) of a motion, or t,{q},fx,fy,nz (s, rad, N, N m) of a measurement")
}
