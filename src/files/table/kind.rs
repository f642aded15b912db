//! [`TableData`]: a motion or a measurement, distinguished by its columns.

use std::path::Path;

use super::column::angles;
use super::error::TableError;
use super::measured::{has_base_reaction, motions_or};
use super::reader::TableReader;
use super::samples::{SampleTable, samples_or};
use crate::text::read;
use stillbase_mechanics::machine::Machine;
use stillbase_settings::text::MAX_TEXT_BYTES;
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
    /// Reads a file that is either a motion or a measurement of a machine: see [`TableData::of`].
    ///
    /// # Errors
    /// If it cannot be read, or is neither a motion nor a measurement.
    pub fn open(file: &Path, machine: &Machine, gaps: bool) -> Result<Self, TableError> {
        let name = file.display().to_string();
        let text = read(file).map_err(|e| {
            let want = format!("want a plain file that can be read, of at most {MAX_TEXT_BYTES} bytes");
            TableError::of_file(&name, format!("{e}: {want}"))
        })?;
        Self::of(&text, &name, machine, gaps)
    }

    /// Reads text that is a motion or a measurement. If it has a column of a force or a moment on the base, it is a
    /// measurement, which [`motions`](super::motions) reads. Otherwise it is a motion, which
    /// [`samples`](super::samples()) reads. `file` is the name used in errors; `gaps` allows gaps in the time of a
    /// motion.
    ///
    /// # Errors
    /// If the text is neither; the error has its place and the expected columns of both kinds.
    pub fn of(text: &str, file: &str, machine: &Machine, gaps: bool) -> Result<Self, TableError> {
        let want = head_wanted(machine);
        match has_base_reaction(TableReader::new(text, file, &want)?.head()) {
            true => motions_or(text, file, machine, &want).map(Self::Measurement),
            false => samples_or(text, file, machine, None, gaps, &want).map(Self::Motion),
        }
    }
}

fn head_wanted(machine: &Machine) -> String {
    let q = angles(machine);
    format!("a header t,{q} (rad) or t,x,y (m) of a motion, or t,{q},fx,fy,nz (s, rad, N, N m) of a measurement")
}
