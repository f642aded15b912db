//! [`AssessmentQuery`]: the query that assesses the motion or the measured machine in a table.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::sync::Arc;

use stillbase_files::table::{SampleTable, Table, TableData as Read, motions, orbit_motion, samples};
use stillbase_mechanics::machine::Machine;
use stillbase_planning::curves::Coordinates;
use stillbase_query::{Portion, ProgressCallback, Query, Shared};
use stillbase_session::scenario::Scenario;
use stillbase_simulation::plant::BaseKind;
use stillbase_study::advice::Advice;
use stillbase_study::import::{GivenMotion, ImportQuery, ImportedMotion, MotionImportError, PreservedPath, Request};
use stillbase_study::trim::{
    MeasuredMotion, MeasurementSet, OrbitBase, OrbitMotion, OrbitOutcome, OrbitTrimQuery, OrbitTrimRequest, TrimMethod,
    TrimOutcome, TrimQuery, TrimRequest,
};

/// Type of content of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableContent {
    /// Samples of the drives.
    Drives,
    /// Samples of the end effector.
    Tip,
    /// Motions of a machine with the measured reactions on its base, or the rates of a base that floats.
    Measurement,
}

/// Options for reading and assessing a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TableOptions {
    /// Type of content; by default, the column names decide it.
    pub content: Option<TableContent>,
    /// Whether gaps in time are bridged.
    pub gaps: bool,
    /// Frequency at which smoothing halves the amplitude, Hz; by default, samples are not smoothed.
    pub smoothing: Option<f64>,
    /// What the proposed motion preserves of the given one; by default the end effector's motion, if possible.
    pub keep: Option<PreservedPath>,
    /// Pose constant b of the proposed motion, rad; by default, the program chooses it.
    pub b: Option<f64>,
    /// Whether measured rates and accelerations are ignored.
    pub angles_only: bool,
    /// Whether columns are taken as they are, even if another sign, order or unit explains them better.
    pub as_given: bool,
}

/// An open table with its options.
#[derive(Clone, Debug)]
pub struct OpenedTable {
    /// Its file.
    pub file: PathBuf,
    /// Its content.
    pub table: Shared<Table>,
    /// Further files of the same measurement, with their content.
    pub more: Vec<(PathBuf, Shared<Table>)>,
    /// Its options.
    pub options: TableOptions,
    /// The measured machine: the machine on display when the table, or later a session, was opened.
    pub measured: Shared<Machine>,
}

/// A result that can be applied to the session.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableAction {
    /// The task of the proposed motion.
    Proposal,
    /// The task of the given motion.
    AsGiven,
    /// The measured machine with the change that balances it.
    Change,
    /// The machine as it was measured.
    Measured,
}

impl OpenedTable {
    /// Returns the request for the machine, plant, base, control, step and design of a scenario; its task and edits
    /// are ignored.
    pub fn request(&self, scenario: &Scenario) -> Option<TableRequest> {
        let Scenario { machine, plant, base, control, design, .. } = scenario;
        let part = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let scenario = Scenario {
            // The proposed scenario has the name of the table.
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
        let (options, measured) = (self.options.clone(), self.measured.clone());
        let more = self.more.iter().map(|(_, table)| table.clone()).collect();
        Some(TableRequest { table: self.table.clone(), more, scenario: Shared(scenario.into()), measured, options })
    }
}

/// A request to assess a table.
#[derive(Clone, Debug, PartialEq)]
pub struct TableRequest {
    /// The table.
    pub table: Shared<Table>,
    /// Further tables of the same measurement.
    pub more: Vec<Shared<Table>>,
    /// A scenario with the session's machine, plant, base, control, step and design.
    pub scenario: Shared<Scenario>,
    /// The measured machine.
    pub measured: Shared<Machine>,
    /// The options.
    pub options: TableOptions,
}

/// Assessment of a table.
#[derive(Debug)]
pub enum TableAssessment {
    /// Assessment of a motion.
    Motion {
        /// The given motion.
        motion: Arc<GivenMotion>,
        /// Number of jumps by a whole turn that were removed, for each column.
        unwrapped: Vec<usize>,
        /// The base reactions of the given motion, and the proposed motion.
        imported: Box<Result<ImportedMotion, MotionImportError>>,
    },
    /// Assessment of a measured machine.
    Measured(Box<TrimOutcome>),
    /// Assessment of a machine that was measured in orbit.
    Orbit(Box<OrbitOutcome>),
}

/// Query that reads a table, then runs the import of a motion or the trim of a machine.
pub struct AssessmentQuery {
    request: TableRequest,
    work: Option<Work>,
}

/// The running import or trim of a table that has been read.
enum Work {
    Motion { motion: Arc<GivenMotion>, unwrapped: Vec<usize>, importing: Box<ImportQuery> },
    Measured(Box<TrimQuery>),
    Orbit(Box<OrbitTrimQuery>),
}

/// Fraction of the progress that is assigned to reading the table.
const READING_SHARE: f64 = 0.02;

impl Query for AssessmentQuery {
    type Input = TableRequest;
    /// The assessment, or the reason why the table cannot be read.
    type Answer = Result<TableAssessment, Advice>;

    fn begin(request: TableRequest) -> Self {
        Self { request, work: None }
    }

    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        match &mut self.work {
            None => match self.request.read() {
                Ok(work) => {
                    self.work = Some(work);
                    Portion::More(READING_SHARE)
                }
                Err(why) => Portion::Done(Err(why)),
            },
            Some(Work::Motion { motion, unwrapped, importing }) => match importing.go_on(goes_on) {
                Portion::More(done) => Portion::More(done.max(READING_SHARE)),
                Portion::Stopped => Portion::Stopped,
                Portion::Done(imported) => {
                    let (motion, unwrapped) = (motion.clone(), std::mem::take(unwrapped));
                    Portion::Done(Ok(TableAssessment::Motion { motion, unwrapped, imported: imported.into() }))
                }
            },
            Some(Work::Measured(trimming)) => match trimming.go_on(goes_on) {
                Portion::More(done) => Portion::More(done.max(READING_SHARE)),
                Portion::Stopped => Portion::Stopped,
                Portion::Done(trimmed) => Portion::Done(Ok(TableAssessment::Measured(trimmed.into()))),
            },
            Some(Work::Orbit(trimming)) => match trimming.go_on(goes_on) {
                Portion::More(done) => Portion::More(done.max(READING_SHARE)),
                Portion::Stopped => Portion::Stopped,
                Portion::Done(trimmed) => Portion::Done(Ok(TableAssessment::Orbit(trimmed.into()))),
            },
        }
    }
}

impl TableRequest {
    fn read(&self) -> Result<Work, Advice> {
        let Self { table, more, scenario, options, measured } = self;
        let (table, machine) = (&*table.0, &scenario.0.machine);
        let floats = scenario.0.base.kind == BaseKind::Free;
        let of = |coordinates| samples(table, machine, Some(coordinates), options.gaps).map(Read::Motion);
        let read = match options.content {
            None => Read::of(table, machine, floats, options.gaps),
            Some(TableContent::Drives) => of(Coordinates::Drives),
            Some(TableContent::Tip) => of(Coordinates::EndEffector),
            Some(TableContent::Measurement) => Read::measurement(table, &measured.0, floats),
        };
        match read? {
            Read::Motion(table) => self.import(table),
            Read::Measurement(mut all) => {
                for table in more {
                    all.extend(motions(&table.0, &measured.0)?);
                }
                Ok(self.trim(all))
            }
            Read::Orbit(first) => {
                let more = more.iter().map(|table| orbit_motion(&table.0, &measured.0));
                let motions: Vec<OrbitMotion> = [Ok(first)].into_iter().chain(more).collect::<Result<_, _>>()?;
                let request = OrbitTrimRequest {
                    machine: measured.clone(),
                    base: OrbitBase::of(&scenario.0.base),
                    motions: Shared(motions.into()),
                    as_given: options.as_given,
                };
                Ok(Work::Orbit(OrbitTrimQuery::begin(request).into()))
            }
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
        Ok(Work::Motion { motion, unwrapped, importing: ImportQuery::begin(request).into() })
    }

    fn trim(&self, motions: Vec<MeasuredMotion>) -> Work {
        let Self { scenario, options, measured, .. } = self;
        let machine = &*measured.0;
        let request = TrimRequest {
            machine: measured.clone(),
            recording: Shared(MeasurementSet { motions }.into()),
            angles_only: options.angles_only,
            as_given: options.as_given,
            method: TrimMethod::of(&scenario.0.design, machine),
            accelerations: None,
        };
        Work::Measured(TrimQuery::begin(request).into())
    }
}
