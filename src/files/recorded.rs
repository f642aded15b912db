//! Reads recordings of the Rerun viewer's format: the session and the signals of each case.

use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use re_chunk::Chunk;
use re_log_encoding::{Decodable as _, DecoderApp, StreamFooter};
use re_log_types::{EntityPath, EntityPathPart, LogMsg, StoreKind};
use thiserror::Error;

use stillbase_settings::results::newest_path;
use stillbase_simulation::signal_table::{SignalColumn, SignalTable};

use crate::recorded_case::ENDING;
pub use crate::recorded_case::RecordedCase;

/// Application name of recordings.
pub const APPLICATION: &str = "stillbase";

/// Time line of simulated time.
pub const TIME_TIMELINE: &str = "sim_time";

/// Names of the components of an entity that list the paths and the units of its signals, in the order of its series.
pub const PATHS: &str = "paths";
/// See [`PATHS`].
pub const UNITS: &str = "units";

/// Largest file that is read, bytes.
const MAX_FILE_BYTES: u64 = 4 << 30;

/// Why a recording is not read.
#[derive(Debug, Error)]
#[error("{}: {why}", file.display())]
pub struct ReadError {
    /// The file.
    pub file: PathBuf,
    /// The reason, and what would be right.
    pub why: String,
}

/// Returns the cases of a recording, in the order in which they were recorded; at least one.
///
/// # Errors
/// If the file cannot be read, or is not a whole recording of this program.
pub fn cases(file: &Path) -> Result<Vec<RecordedCase>, ReadError> {
    let refused = |why: String| ReadError { file: file.into(), why };
    let unreadable = |why: io::Error| refused(format!("{why}: want a recording that can be read"));
    let wrong = |why: String| refused(format!("{why}: want a whole recording of `stillbase headless`"));
    let mut opened = crate::text::open(file, MAX_FILE_BYTES).map_err(unreadable)?;
    if !is_finished(&mut opened).map_err(unreadable)? {
        return Err(wrong("it is no recording, or its end is missing".into()));
    }
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
    let names = cases.properties.iter().map(|case| &case.name);
    if let Some(name) = names.clone().enumerate().find_map(|(i, name)| names.clone().skip(i + 1).find(|n| *n == name)) {
        return Err(refused(format!(
            "it holds two cases that are called {name}: want recordings merged by other names"
        )));
    }
    match cases.properties.is_empty() {
        true => Err(wrong("it holds no session".into())),
        false => cases.properties.iter().map(|case| cases.whole(case).map_err(wrong)).collect(),
    }
}

/// Returns whether a file ends as a finished recording does: with a footer, after which nothing follows.
fn is_finished(file: &mut (impl Read + Seek)) -> io::Result<bool> {
    let mut end = [0; StreamFooter::ENCODED_SIZE_BYTES];
    if file.seek(SeekFrom::End(0))? < end.len() as u64 {
        return Ok(false);
    }
    file.seek(SeekFrom::End(-(end.len() as i64)))?;
    file.read_exact(&mut end)?;
    file.rewind()?;
    Ok(StreamFooter::from_rrd_bytes(&end).is_ok())
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
        if table.columns.is_empty() {
            return Err(format!("{name}: version {version} of the program recorded it and named no signals"));
        }
        match table.time.is_sorted_by(|a, b| a < b) && !table.time.is_empty() {
            true => Ok(RecordedCase { name: name.clone(), version: version.clone(), session: session.clone(), table }),
            false => Err(format!("{name}: its times do not increase")),
        }
    }
}
