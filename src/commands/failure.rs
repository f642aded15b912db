//! Failures of commands.

use std::fmt::Display;
use std::io;

#[cfg(feature = "ui")]
use stillbase_app::export::ExportError;
use stillbase_files::WriteError;
use stillbase_files::row_file::RowError;
use stillbase_files::table::TableError;
#[cfg(feature = "ui")]
use stillbase_files::video::VideoError;
use stillbase_mechanics::balance::DesignError;
use stillbase_mechanics::joint_forces::JointsError;
use stillbase_mechanics::machine::{FileError, MachineError};
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::pose_space::{NoPoseSpace, PlaneError};
use stillbase_planning::timing::TimeError;
use stillbase_session::scenario::{Scenario, ScenarioError};
use stillbase_session::{Proposal, Refusal, WayOut, proposals_while};
use stillbase_settings::fault::Faults;
use toml::{Table, Value};

use stillbase_study::layers::NoLayers;

use super::misnamed::Misnamed;
use super::progress::goes_on;
use super::remedy::option;

/// Why a command did not finish.
#[derive(Debug)]
pub enum Failure {
    /// The reader of standard output has closed it, as `head` does: not an error.
    ReaderGone,
    /// The answer on standard output says that something is not as it should be; there is nothing to add.
    Told,
    /// The command was told to stop, and did.
    Stopped,
    /// The question has no answer: the reason, and a similar question that has one.
    NoAnswer(String),
    /// The input is wrong: the place of the error, and the expected input.
    WrongInput(String),
    /// A scenario or a question was refused, with ways out.
    Refused(Box<RefusedScenario>),
}

/// Why a scenario or a question was refused, and what leads out of it.
#[derive(Debug)]
pub struct RefusedScenario {
    /// The reason.
    pub failure: Failure,
    /// Changes after which the scenario runs, or the question has an answer.
    pub proposals: Vec<Proposal>,
    /// A word of the command line that names nothing, with what it may have been to name.
    pub misnamed: Option<Misnamed>,
    /// The file that was read, and all its faults.
    pub faults: Option<(String, Faults)>,
}

impl RefusedScenario {
    fn of(failure: Failure, proposals: Vec<Proposal>) -> Self {
        Self { failure, proposals, misnamed: None, faults: None }
    }
}

impl Failure {
    /// Returns the failure of a question without an answer.
    pub fn no_answer(why: impl Display) -> Self {
        Self::NoAnswer(why.to_string())
    }

    /// Returns the failure of wrong input.
    pub fn wrong_input(why: impl Display) -> Self {
        Self::WrongInput(why.to_string())
    }

    /// Returns the failure of a run whose audit has failed: its results cannot be trusted.
    pub fn untrusted(scenario: &str, why: impl Display) -> Self {
        Self::NoAnswer(format!("{scenario}: audit failed: {why}; want a smaller step, as --set step=0.0002"))
    }

    /// Returns the failure to write standard output.
    pub fn standard_output(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::ReaderGone,
            _ => Self::WrongInput(format!("standard output: {error}: want a place that can be written")),
        }
    }

    /// Returns the failure of a refused scenario, with the name of the scenario before the reason.
    pub fn refused(scenario: &Scenario, refusal: Refusal) -> Self {
        let (task, block, refusal) = match (&scenario.assembly, refusal) {
            (Some(of), Refusal::OfBlock { block, why }) => match of.task(&block) {
                Some(task) => (task, Some(block), *why),
                None => (scenario, Some(block), *why),
            },
            (_, refusal @ Refusal::OfAssembly(_)) => (scenario, None, refusal),
            (of, refusal) => (scenario, of.as_ref().map(|of| of.name().to_owned()), refusal),
        };
        let proposals = match refusal {
            Refusal::Stopped => None,
            _ => proposals_while(task, &refusal, &mut |_| goes_on()),
        };
        let Some(proposals) = proposals else { return Self::Stopped };
        let failure = Self::from(refusal).with_context(block.as_ref().unwrap_or(&scenario.name));
        let refused = Self::Refused(Box::new(RefusedScenario::of(failure, proposals)));
        match block {
            Some(block) => refused.of_block(&block),
            None => refused,
        }
    }

    /// Returns the failure of one of several blocks: ways out are keys of the block. Those that change what it holds, or
    /// that are no settings, are left out.
    #[must_use]
    pub fn of_block(self, block: &str) -> Self {
        let Self::Refused(refused) = self else { return self };
        let of_block = |Proposal { text, way }: Proposal| {
            let WayOut::Set(settings) = way else { return None };
            let own = settings.into_iter().map(|(key, value)| {
                let inner = Table::from_iter([(block.to_owned(), value.clone())]);
                match key.as_str() {
                    "task" => Some((key, Value::Table(inner))),
                    "limits" | "drive" => Some((block.to_owned(), Value::Table(Table::from_iter([(key, value)])))),
                    _ => None,
                }
            });
            let settings = own.collect::<Option<Table>>()?;
            Some(Proposal { text, way: WayOut::Set(settings) })
        };
        let proposals = refused.proposals.into_iter().filter_map(of_block).collect();
        let failure = refused.failure.worded(&|why| format!("block {why}"));
        Self::Refused(Box::new(RefusedScenario { failure, proposals, ..*refused }))
    }

    /// Returns the failure with a word of the command line that names nothing.
    #[must_use]
    pub fn with_misnamed(self, misnamed: Option<Misnamed>) -> Self {
        match self {
            Self::ReaderGone | Self::Told | Self::Stopped => self,
            Self::Refused(refused) => Self::Refused(Box::new(RefusedScenario { misnamed, ..*refused })),
            failure => {
                Self::Refused(Box::new(RefusedScenario { misnamed, ..RefusedScenario::of(failure, Vec::new()) }))
            }
        }
    }

    /// Returns the failure with the faults of the file that was read.
    #[must_use]
    pub fn with_faults(self, faults: Option<(&str, &Faults)>) -> Self {
        let faults = faults.map(|(file, faults)| (file.to_owned(), faults.clone()));
        match self {
            Self::Refused(refused) => Self::Refused(Box::new(RefusedScenario { faults, ..*refused })),
            other => other,
        }
    }

    /// Returns the word of the command line that names nothing, if that is why the command failed.
    pub fn misnamed(&self) -> Option<&Misnamed> {
        match self {
            Self::Refused(refused) => refused.misnamed.as_ref(),
            _ => None,
        }
    }

    /// Returns the failure with ways out of it.
    #[must_use]
    pub fn with_proposals(self, proposals: Vec<Proposal>) -> Self {
        match self {
            Self::NoAnswer(_) | Self::WrongInput(_) => Self::Refused(Box::new(RefusedScenario::of(self, proposals))),
            Self::Refused(refused) if refused.proposals.is_empty() => {
                Self::Refused(Box::new(RefusedScenario { proposals, ..*refused }))
            }
            other => other,
        }
    }

    /// Returns the failure with `what` before its reason.
    #[must_use]
    pub fn with_context(self, what: impl Display) -> Self {
        self.worded(&|why| format!("{what}: {why}"))
    }

    /// Returns the failure with its reason in other words.
    #[must_use]
    pub fn worded(self, words: &dyn Fn(&str) -> String) -> Self {
        match self {
            Self::ReaderGone | Self::Told | Self::Stopped => self,
            Self::NoAnswer(why) => Self::NoAnswer(words(&why)),
            Self::WrongInput(why) => Self::WrongInput(words(&why)),
            Self::Refused(refused) => {
                let failure = refused.failure.worded(words);
                Self::Refused(Box::new(RefusedScenario { failure, ..*refused }))
            }
        }
    }
}

impl From<FileError> for Failure {
    fn from(e: FileError) -> Self {
        let misnamed = Misnamed::machine(&e);
        let nearest = misnamed.as_ref().map_or_else(String::new, Misnamed::nearest_file);
        Self::wrong_input(format!("{e}{nearest}")).with_misnamed(misnamed).with_faults(e.file().zip(e.faults()))
    }
}

impl From<ScenarioError> for Failure {
    fn from(e: ScenarioError) -> Self {
        let misnamed = Misnamed::scenario(&e);
        let nearest = misnamed.as_ref().map_or_else(String::new, Misnamed::nearest_file);
        Self::wrong_input(format!("{e}{nearest}")).with_misnamed(misnamed).with_faults(e.faults())
    }
}

impl From<TableError> for Failure {
    fn from(e: TableError) -> Self {
        Self::wrong_input(e.worded(option))
    }
}

impl From<RowError> for Failure {
    fn from(e: RowError) -> Self {
        match e {
            RowError::Write(e) => e.into(),
            e => Self::wrong_input(e),
        }
    }
}

#[cfg(feature = "ui")]
impl From<ExportError> for Failure {
    fn from(e: ExportError) -> Self {
        match e {
            ExportError::Adapter(_) | ExportError::Picture(_) => Self::no_answer(e),
            ExportError::Stopped => Self::Stopped,
            ExportError::Write(e) | ExportError::Video(VideoError::Write(e)) => e.into(),
            ExportError::Video(VideoError::NoEncoder | VideoError::Encoder { .. }) => Self::no_answer(e),
            _ => Self::wrong_input(e),
        }
    }
}

impl From<WriteError> for Failure {
    fn from(e: WriteError) -> Self {
        match e {
            WriteError::Standard(e) => Self::standard_output(&e),
            e => Self::wrong_input(e),
        }
    }
}

impl From<MachineError> for Failure {
    fn from(e: MachineError) -> Self {
        Self::wrong_input(e)
    }
}

impl From<PlaneError> for Failure {
    fn from(e: PlaneError) -> Self {
        Self::no_answer(e)
    }
}

impl From<NoPoseSpace> for Failure {
    fn from(e: NoPoseSpace) -> Self {
        Self::no_answer(e)
    }
}

impl From<Unreachable> for Failure {
    fn from(e: Unreachable) -> Self {
        Self::no_answer(e)
    }
}

impl From<JointsError> for Failure {
    fn from(e: JointsError) -> Self {
        Self::no_answer(e)
    }
}

impl From<NoLayers> for Failure {
    fn from(e: NoLayers) -> Self {
        match e {
            NoLayers::NoOrder(_) | NoLayers::NotFound => Self::no_answer(e),
            NoLayers::Cut(_) | NoLayers::Machine(_) | NoLayers::Motion(_) => Self::wrong_input(e),
        }
    }
}

impl From<DesignError> for Failure {
    fn from(e: DesignError) -> Self {
        match e {
            DesignError::Inconsistent { .. } | DesignError::Machine(_) => Self::no_answer(e),
            DesignError::Penalties { .. } | DesignError::Penalty { .. } => Self::wrong_input(e),
        }
    }
}

impl From<Refusal> for Failure {
    fn from(e: Refusal) -> Self {
        let whole = e.to_string();
        match e {
            Refusal::Edit { refusal: why, .. } | Refusal::OfBlock { why, .. } => match Self::from(*why) {
                Self::NoAnswer(_) => Self::NoAnswer(whole),
                Self::Stopped => Self::Stopped,
                _ => Self::WrongInput(whole),
            },
            Refusal::Stopped => Self::Stopped,
            // The machine lacks limits of its drives.
            Refusal::Time(TimeError::NoJerkLimit | TimeError::Unlimited { .. } | TimeError::SpeedOnly) => {
                Self::wrong_input(e)
            }
            Refusal::NoPlanes(_)
            | Refusal::NoPoseConstant(_)
            | Refusal::NoWay(_)
            | Refusal::Unreachable { .. }
            | Refusal::Path(_)
            | Refusal::Time(_)
            | Refusal::Price(_)
            | Refusal::LeastReaction(_)
            | Refusal::Drift(_)
            | Refusal::Turns { .. }
            | Refusal::Loop { .. }
            | Refusal::NoCommonPlane { .. }
            | Refusal::Blocked(_)
            | Refusal::TooLong { .. }
            | Refusal::Full { .. }
            | Refusal::Diverged { .. }
            | Refusal::Unfinished(_)
            | Refusal::Untrusted { .. } => Self::no_answer(e),
            Refusal::Machine(_)
            | Refusal::OutOfRange { .. }
            | Refusal::OfAssembly(_)
            | Refusal::TooManySteps { .. }
            | Refusal::TooLarge { .. }
            | Refusal::LeavesLimits { .. }
            | Refusal::Curve(_)
            | Refusal::Sketch(_)
            | Refusal::Task(_) => Self::wrong_input(e),
        }
    }
}
