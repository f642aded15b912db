//! [`Assessing`]: the query for what a table of numbers says, of a motion or of a machine that was measured.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::sync::Arc;

use crate::files::table::{SampleTable, Table as Read, motions, samples};
use crate::mechanics::machine::Machine;
use crate::planning::curves::Coordinates;
use crate::query::{Portion, Query, Shared, Watch};
use crate::session::scenario::Scenario;
use crate::study::advice::Advice;
use crate::study::import::{GivenMotion, ImportError, Imported, Importing, Keep, Request};
use crate::study::trim::{Motion, Recording, TrimRequest, Trimmed, Trimming, Way};

/// The text of a table, and what it is called.
#[derive(Debug, PartialEq)]
pub struct Table {
    /// Its file.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// What a table is read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableContent {
    /// Samples of the drives.
    Drives,
    /// Samples of the end effector.
    Tip,
    /// A machine that moved, with what its base felt.
    Measurement,
}

/// How a table is read, and what is asked of what it holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableOptions {
    /// As what; by default as what its columns say.
    pub content: Option<TableContent>,
    /// Gaps in time may be bridged.
    pub gaps: bool,
    /// Cut-off of smoothing, Hz.
    pub smoothing: Option<f64>,
    /// What the proposal keeps.
    pub keep: Option<Keep>,
    /// Its pose constant, rad.
    pub b: Option<f64>,
    /// Measured rates and accelerations are left alone.
    pub angles_only: bool,
    /// Columns are taken as they are, whatever explains them better.
    pub as_given: bool,
}

/// A table that was opened, and what is asked of it.
#[derive(Clone, Debug)]
pub struct Given {
    /// Where it was read.
    pub file: PathBuf,
    /// What it holds.
    pub table: Shared<Table>,
    /// How it is read, and what is asked of it.
    pub options: TableOptions,
    /// The machine that a measurement is of: the one on display when the table was opened.
    pub measured: Shared<Machine>,
}

/// What a session can take of what a table says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taking {
    /// The task of the motion that is proposed.
    Proposal,
    /// The task of the motion as it was given.
    AsGiven,
    /// What mends the machine.
    Change,
    /// The machine as it was measured.
    Measured,
}

impl Given {
    /// What is asked of it for a session's machine, base and control; its task and its edits do not matter.
    pub fn asked(&self, scenario: &Scenario) -> Option<Asked> {
        let Scenario { machine, plant, base, control, design, .. } = scenario;
        let part = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let scenario = Scenario {
            // What is proposed goes by the name of the table.
            name: part(self.file.file_stem()),
            title: part(self.file.file_name()),
            machine: machine.clone(),
            plant: plant.clone(),
            base: *base,
            control: *control,
            step: scenario.step,
            design: design.clone(),
            ..Scenario::builtin("case-3")?
        };
        let (table, options, measured) = (self.table.clone(), self.options.clone(), self.measured.clone());
        Some(Asked { table, scenario: Shared(scenario.into()), measured, options })
    }
}

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// The table.
    pub table: Shared<Table>,
    /// The machine, its base and its control.
    pub scenario: Shared<Scenario>,
    /// The machine that a measurement is of.
    pub measured: Shared<Machine>,
    /// How.
    pub options: TableOptions,
}

/// What a table says.
#[derive(Debug)]
pub enum Assessed {
    /// Of a motion.
    Motion {
        /// As it was read.
        motion: Arc<GivenMotion>,
        /// In how many places a whole turn was taken out of each column.
        unwrapped: Vec<usize>,
        /// What it does to the base, and what is proposed.
        imported: Box<Result<Imported, ImportError>>,
    },
    /// Of a machine.
    Measured(Box<Trimmed>),
}

/// Reads a table, then does what an import or a trim does with it.
pub struct Assessing {
    asked: Asked,
    work: Option<Work>,
}

/// What goes on with a table that was read.
enum Work {
    Motion { motion: Arc<GivenMotion>, unwrapped: Vec<usize>, importing: Box<Importing> },
    Measured(Box<Trimming>),
}

/// How much of the work it is to read a table.
const READ: f64 = 0.02;

impl Query for Assessing {
    type Input = Asked;
    /// Or why the table cannot be read.
    type Answer = Result<Assessed, Advice>;

    fn begin(asked: Asked) -> Self {
        Self { asked, work: None }
    }

    fn go_on(&mut self, goes_on: Watch<'_>) -> Portion<Self::Answer> {
        match &mut self.work {
            None => match self.asked.read() {
                Ok(work) => {
                    self.work = Some(work);
                    Portion::More(READ)
                }
                Err(why) => Portion::Done(Err(why)),
            },
            Some(Work::Motion { motion, unwrapped, importing }) => match importing.go_on(goes_on) {
                Portion::More(done) => Portion::More(done.max(READ)),
                Portion::Stopped => Portion::Stopped,
                Portion::Done(imported) => {
                    let (motion, unwrapped) = (motion.clone(), std::mem::take(unwrapped));
                    Portion::Done(Ok(Assessed::Motion { motion, unwrapped, imported: imported.into() }))
                }
            },
            Some(Work::Measured(trimming)) => match trimming.go_on(goes_on) {
                Portion::More(done) => Portion::More(done.max(READ)),
                Portion::Stopped => Portion::Stopped,
                Portion::Done(trimmed) => Portion::Done(Ok(Assessed::Measured(trimmed.into()))),
            },
        }
    }
}

impl Asked {
    fn read(&self) -> Result<Work, Advice> {
        let Self { table, scenario, options, measured } = self;
        let (Table { name, text }, machine) = (&*table.0, &scenario.0.machine);
        let of = |coordinates| samples(text, name, machine, Some(coordinates), options.gaps).map(Read::Motion);
        let read = match options.content {
            None => Read::of(text, name, machine, options.gaps),
            Some(TableContent::Drives) => of(Coordinates::Drives),
            Some(TableContent::Tip) => of(Coordinates::EndEffector),
            Some(TableContent::Measurement) => motions(text, name, &measured.0).map(Read::Measurement),
        };
        match read? {
            Read::Motion(table) => self.import(table),
            Read::Measurement(motions) => Ok(self.trim(motions)),
        }
    }

    fn import(&self, table: SampleTable) -> Result<Work, Advice> {
        let Self { scenario, options, .. } = self;
        let SampleTable { coordinates, samples, names, unwrapped } = table;
        let motion = GivenMotion::new(&scenario.0.machine, coordinates, names, samples);
        let motion = match options.smoothing {
            Some(cut_off) => motion.smoothed(cut_off).map_err(|why| why.to_string())?,
            None => motion,
        };
        let motion = Arc::new(motion);
        let keep = options.keep.filter(|_| coordinates == Coordinates::Drives);
        let request = Request { scenario: scenario.clone(), motion: Shared(motion.clone()), b: options.b, keep };
        Ok(Work::Motion { motion, unwrapped, importing: Importing::begin(request).into() })
    }

    fn trim(&self, motions: Vec<Motion>) -> Work {
        let Self { scenario, options, measured, .. } = self;
        let machine = &*measured.0;
        let request = TrimRequest {
            machine: measured.clone(),
            recording: Shared(Recording { motions }.into()),
            angles_only: options.angles_only,
            as_given: options.as_given,
            way: Way::of(&scenario.0.design, machine),
            accelerations: None,
        };
        Work::Measured(Trimming::begin(request).into())
    }
}
