//! Reads recordings of the Rerun viewer's format: the session and the signals of each case.

use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use re_chunk::Chunk;
use re_log_encoding::DecoderApp;
use re_log_types::{EntityPath, EntityPathPart, LogMsg, StoreKind};
use thiserror::Error;

use stillbase_session::scenario::{Scenario, ScenarioError};
use stillbase_settings::results::newest_path;
use stillbase_simulation::signal_table::{SignalColumn, SignalTable};

/// Application name of recordings.
pub const APPLICATION: &str = "stillbase";

/// Time line of simulated time.
pub const TIME_TIMELINE: &str = "sim_time";

/// Names of the components of an entity that list the paths and the units of its signals, in the order of its series.
pub const PATHS: &str = "paths";
/// See [`PATHS`].
pub const UNITS: &str = "units";

/// Ending of the name of a recording.
const ENDING: &str = ".rrd";

/// Largest file that is read, bytes.
const MAX_FILE_BYTES: u64 = 4 << 30;

/// A case of a recording.
#[derive(Clone, Debug)]
pub struct RecordedCase {
    /// Name of its scenario.
    pub name: String,
    /// Version of the program that recorded it.
    pub version: String,
    /// Its session as TOML: scenario, machine and edits.
    pub session: String,
    /// Its signals, at the recorded steps.
    pub table: SignalTable,
}

/// Why a recording is not read.
#[derive(Debug, Error)]
#[error("{}: {why}", file.display())]
pub struct ReadError {
    /// The file.
    pub file: PathBuf,
    /// The reason, and what would be right.
    pub why: String,
}

impl RecordedCase {
    /// Returns the recorded scenario with its edits.
    ///
    /// # Errors
    /// If this version of the program cannot read it.
    pub fn scenario(&self) -> Result<Scenario, ScenarioError> {
        Scenario::parse(&self.session, &self.name, None)
    }
}

/// Returns the cases of a recording, in the order in which they were recorded; at least one.
///
/// # Errors
/// If the file cannot be read, or is not a whole recording of this program.
pub fn cases(file: &Path) -> Result<Vec<RecordedCase>, ReadError> {
    let refused = |why: String| ReadError { file: file.into(), why };
    let unreadable = |why: io::Error| refused(format!("{why}: want a recording that can be read"));
    let wrong = |why: String| refused(format!("{why}: want a whole recording of `stillbase headless`"));
    let opened = crate::text::open(file, MAX_FILE_BYTES).map_err(unreadable)?;
    let mut cases = Cases::default();
    for message in DecoderApp::decode_lazy(BufReader::new(opened)) {
        let message = message.map_err(|e| wrong(e.to_string()))?;
        if let LogMsg::ArrowMsg(store, message) = message
            && store.kind() == StoreKind::Recording
        {
            if store.application_id().as_str() != APPLICATION {
                return Err(wrong(format!("written by {}", store.application_id())));
            }
            let chunk = Chunk::from_arrow_msg(&message).map_err(|e| wrong(e.to_string()))?;
            cases.take(&chunk);
        }
    }
    match cases.properties.is_empty() {
        true => Err(wrong("it holds no session".into())),
        false => cases.properties.iter().map(|case| cases.whole(case).map_err(wrong)).collect(),
    }
}

/// A name of a case on the command line, such as `cases.rrd` or `cases.rrd:case-2`.
pub struct CaseName {
    /// The recording.
    pub file: PathBuf,
    /// Name of the case, if it is stated.
    pub case: Option<String>,
}

impl CaseName {
    /// Returns the parts of a name; `None` if it does not name a recording.
    pub fn of(name: &str) -> Option<Self> {
        let lower = name.to_ascii_lowercase();
        let end = match lower.find(".rrd:") {
            Some(start) => start + ENDING.len(),
            None => lower.ends_with(ENDING).then_some(name.len())?,
        };
        Some(Self { file: name[..end].into(), case: name.get(end + 1..).map(str::to_owned) })
    }

    /// Returns the cases that it names: that of its name, or all.
    ///
    /// # Errors
    /// As [`cases`], and if there is no case of that name.
    pub fn cases(&self) -> Result<Vec<RecordedCase>, ReadError> {
        let mut all = cases(&self.file)?;
        let Some(own) = &self.case else { return Ok(all) };
        let names: Vec<String> = all.iter().map(|case| case.name.clone()).collect();
        all.retain(|case| case.name == *own);
        match all.is_empty() {
            false => Ok(all),
            true => Err(self.refused(format!("no case {own:?}: want one of {}", names.join(", ")))),
        }
    }

    fn refused(&self, why: String) -> ReadError {
        ReadError { file: self.file.clone(), why }
    }
}

/// What the chunks of a recording hold.
#[derive(Default)]
struct Cases {
    properties: Vec<Properties>,
    topics: Vec<RecordedTopic>,
}

/// Properties of a case.
struct Properties {
    name: String,
    version: String,
    session: String,
}

/// Signals that share an entity.
struct RecordedTopic {
    path: EntityPath,
    signals: Vec<String>,
    units: Vec<String>,
    nanos: Vec<i64>,
    /// Values, row by row.
    values: Vec<f64>,
}

impl Cases {
    fn take(&mut self, chunk: &Chunk) {
        let path = chunk.entity_path();
        let parts: Vec<&EntityPathPart> = path.iter().collect();
        let texts = |name: &'static str| -> Vec<String> {
            let rows = chunk.iter_slices::<String>(name.into());
            rows.flatten().map(|text| text.as_str().to_owned()).collect()
        };
        if let Some(properties) = path.strip_prefix(&EntityPath::properties()).filter(|rest| rest.len() == 1) {
            let name = properties.iter().next().map(|part| part.unescaped_str().to_owned()).unwrap_or_default();
            let one = |name: &'static str| texts(name).into_iter().next();
            if let Some(session) = one("scenario") {
                let version = one("version").unwrap_or_default();
                self.properties.push(Properties { name, version, session });
            }
        } else if parts.len() >= 3 && parts[1].unescaped_str() == "signals" && chunk.is_static() {
            let signals: Vec<String> = texts(PATHS).iter().map(|path| newest_path(path).to_owned()).collect();
            if !signals.is_empty() {
                let (nanos, values) = Default::default();
                let topic = RecordedTopic { path: path.clone(), signals, units: texts(UNITS), nanos, values };
                self.topics.push(topic);
            }
        } else if let Some(topic) = self.topics.iter_mut().find(|topic| topic.path == *path)
            && let Some(times) = chunk.timelines().get(&TIME_TIMELINE.into())
        {
            topic.nanos.extend_from_slice(times.times_raw());
            chunk.iter_slices::<f64>("Scalars:scalars".into()).for_each(|row| topic.values.extend_from_slice(row));
        }
    }

    /// Returns a case with its signals.
    fn whole(&self, Properties { name, version, session }: &Properties) -> Result<RecordedCase, String> {
        let is_own = |topic: &&RecordedTopic| topic.path.iter().next().is_some_and(|p| p.unescaped_str() == name);
        let mut table = SignalTable::default();
        for topic in self.topics.iter().filter(is_own) {
            let (rows, width) = (topic.nanos.len(), topic.signals.len());
            if topic.units.len() != width || topic.values.len() != rows * width {
                return Err(format!("{}: rows of {width} signals are not whole", topic.path));
            }
            let time: Vec<f64> = topic.nanos.iter().map(|nanos| *nanos as f64 / 1e9).collect();
            if table.columns.is_empty() {
                table.time = time;
            } else if table.time != time {
                return Err(format!("{}: its times differ from those of other signals", topic.path));
            }
            for (k, (path, unit)) in topic.signals.iter().zip(&topic.units).enumerate() {
                let values = topic.values.iter().skip(k).step_by(width).copied().collect();
                table.columns.push(SignalColumn { path: path.clone(), unit: unit.clone(), values });
            }
        }
        match table.time.is_sorted_by(|a, b| a < b) && !table.time.is_empty() {
            true => Ok(RecordedCase { name: name.clone(), version: version.clone(), session: session.clone(), table }),
            false => Err(format!("{name}: it names no signals in the order of time")),
        }
    }
}
