//! A [`Store`]: rows and columns of a recording and of its layout, encoded one chunk at a time.
//!
//! Identifiers of chunks count up from a number derived from the digest, so that equal data give equal chunks.

use std::io::Write;

use crate::rerun::{AsComponents, EntityPath, SerializedComponentColumn, StoreKind};
use crate::rerun::{BlueprintActivationCommand, SetStoreInfo, StoreInfo, StoreSource};
use crate::rerun::{Chunk, ChunkError, ChunkId, LogMsg, RowId, TimeColumn};
use crate::rerun::{CrateVersion, StoreId};
use crate::rerun::{EncodeError, Encoder, EncodingOptions};
use crate::rerun::{TimeInt, TimePoint, Timeline};
use thiserror::Error;

#[cfg(feature = "stream")]
use super::viewer::{Viewer, ViewerError, ViewerStream};
use stillbase_files::NewFile;
pub use stillbase_files::recorded::{APPLICATION, TIME_TIMELINE};

/// Time line of steps.
pub const STEP_TIMELINE: &str = "step";

/// Time line of changes of the machine, if there are any.
pub const EDIT_TIMELINE: &str = "edit";

/// Reasons why a row is not written.
#[derive(Debug, Error)]
pub enum StoreError {
    /// Error of the file system.
    #[error(transparent)]
    Write(#[from] std::io::Error),
    /// The viewer cannot be reached.
    #[cfg(feature = "stream")]
    #[error(transparent)]
    Viewer(#[from] ViewerError),
    /// Rerun refuses the data.
    #[error("{0}")]
    Data(String),
}

/// Where a recording goes.
#[derive(Debug)]
pub enum Sink {
    /// To a file.
    File(NewFile),
    /// To a viewer.
    #[cfg(feature = "stream")]
    Viewer(Viewer),
}

impl From<EncodeError> for StoreError {
    fn from(error: EncodeError) -> Self {
        match error {
            EncodeError::Write(error) => Self::Write(error),
            other => Self::Data(other.to_string()),
        }
    }
}

impl From<ChunkError> for StoreError {
    fn from(error: ChunkError) -> Self {
        Self::Data(error.to_string())
    }
}

impl From<crate::rerun::SerializationError> for StoreError {
    fn from(error: crate::rerun::SerializationError) -> Self {
        Self::Data(error.to_string())
    }
}

/// One instant on the time lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instant {
    /// Steps since the start.
    pub step: u64,
    /// Time since the start, ns.
    pub nanos: i64,
    /// Number of changes of the machine so far; `None` for rows without the time line of changes.
    pub edit: Option<usize>,
}

impl Instant {
    /// Returns the instant after `step` steps and `time`, s.
    pub fn at(step: u64, time: f64) -> Self {
        Self { step, nanos: (1e9 * time).round() as i64, edit: None }
    }
}

/// Instants of the rows of some columns.
#[derive(Clone, Debug, Default)]
pub struct RowTimes {
    steps: Vec<i64>,
    nanos: Vec<i64>,
    /// Numbers of changes of the machine; empty, or one for each row.
    edits: Vec<i64>,
}

impl RowTimes {
    /// Adds a row.
    pub fn push(&mut self, at: Instant) {
        self.steps.push(at.step as i64);
        self.nanos.push(at.nanos);
        self.edits.extend(at.edit.map(|edit| edit as i64));
    }

    /// Returns the instants of all rows.
    pub fn instants(&self) -> impl Iterator<Item = Instant> + '_ {
        let edit = |i: usize| self.edits.get(i).map(|edit| *edit as usize);
        let both = self.steps.iter().zip(&self.nanos).enumerate();
        both.map(move |(i, (step, nanos))| Instant { step: *step as u64, nanos: *nanos, edit: edit(i) })
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Removes all rows.
    pub fn clear(&mut self) {
        self.steps.clear();
        self.nanos.clear();
        self.edits.clear();
    }

    /// Returns the time lines; they are cheap to clone for each entity.
    pub fn columns(&self) -> Vec<TimeColumn> {
        let sorted = Some(true);
        let mut columns = vec![
            TimeColumn::new(sorted, Timeline::new_sequence(STEP_TIMELINE), self.steps.clone().into()),
            TimeColumn::new(sorted, Timeline::new_duration(TIME_TIMELINE), self.nanos.clone().into()),
        ];
        if !self.edits.is_empty() {
            columns.push(TimeColumn::new(sorted, Timeline::new_sequence(EDIT_TIMELINE), self.edits.clone().into()));
        }
        columns
    }
}

/// The rows of a recording and of its layout.
pub struct Store {
    to: Open,
    recording: StoreId,
    layout: StoreId,
    /// Identifier given out last; the next one is larger by [`CHUNK_ID_STEP`].
    next: u128,
}

/// A sink that has been opened.
enum Open {
    File(Box<Encoder<NewFile>>),
    #[cfg(feature = "stream")]
    Viewer(ViewerStream),
}

/// Distance between the identifiers of chunks; identifiers of the rows of a chunk count up from that of the chunk.
const CHUNK_ID_STEP: u128 = 1 << 64;

impl Store {
    /// Begins a recording and its layout; `digest` identifies the recording.
    pub fn open(to: Sink, digest: u128) -> Result<Self, StoreError> {
        let to = match to {
            Sink::File(file) => {
                let encoder = Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file)?;
                Open::File(Box::new(encoder))
            }
            #[cfg(feature = "stream")]
            Sink::Viewer(viewer) => Open::Viewer(viewer.connect()?),
        };
        let id = format!("{digest:032x}");
        let mut store = Self {
            to,
            recording: StoreId::new(StoreKind::Recording, APPLICATION, id.as_str()),
            layout: StoreId::new(StoreKind::Blueprint, APPLICATION, format!("{id}-layout")),
            // The upper half counts chunks, from a number that depends on the digest, so that recordings have different
            // identifiers. Its top bits are zero, because readers interpret it as nanoseconds.
            next: (digest >> 90 << 24) << 64,
        };
        let source = StoreSource::Other(format!("stillbase {}", env!("CARGO_PKG_VERSION")));
        for store_id in [store.recording.clone(), store.layout.clone()] {
            let info = StoreInfo::new(store_id, source.clone());
            let row_id = store.id().as_tuid();
            store.send(LogMsg::SetStoreInfo(SetStoreInfo { row_id, info }))?;
        }
        Ok(store)
    }

    fn send(&mut self, message: LogMsg) -> Result<(), StoreError> {
        match &mut self.to {
            Open::File(encoder) => encoder.append(&message).map(drop).map_err(StoreError::from),
            #[cfg(feature = "stream")]
            Open::Viewer(stream) => stream.send(message).map_err(StoreError::from),
        }
    }

    fn id(&mut self) -> ChunkId {
        self.next += CHUNK_ID_STEP;
        ChunkId::from_u128(self.next)
    }

    fn append(&mut self, to: StoreId, chunk: &Chunk) -> Result<(), StoreError> {
        let message = chunk.to_arrow_msg()?;
        self.send(LogMsg::ArrowMsg(to, message))
    }

    fn row(
        &mut self,
        at: impl Into<TimePoint>,
        path: &EntityPath,
        what: &dyn AsComponents,
    ) -> Result<Chunk, StoreError> {
        let id = self.id();
        let row = RowId::from_tuid(id.as_tuid()).next();
        Ok(Chunk::builder_with_id(id, path.clone()).with_archetype(row, at, what).build()?)
    }

    /// Writes components that apply at all times.
    pub fn fixed(&mut self, path: &EntityPath, what: &dyn AsComponents) -> Result<(), StoreError> {
        let chunk = self.row(TimePoint::default(), path, what)?;
        self.append(self.recording.clone(), &chunk)
    }

    fn since(&mut self, at: Instant, path: &EntityPath, what: &dyn AsComponents) -> Result<(), StoreError> {
        let mut point = TimePoint::from([
            (Timeline::new_sequence(STEP_TIMELINE), TimeInt::new_temporal(at.step as i64)),
            (Timeline::new_duration(TIME_TIMELINE), TimeInt::new_temporal(at.nanos)),
        ]);
        if let Some(edit) = at.edit {
            point.insert(Timeline::new_sequence(EDIT_TIMELINE), TimeInt::new_temporal(edit as i64));
        }
        let chunk = self.row(point, path, what)?;
        self.append(self.recording.clone(), &chunk)
    }

    /// Writes components that apply from an instant on, or at all times.
    pub fn shape(
        &mut self,
        since: Option<Instant>,
        path: &EntityPath,
        what: &dyn AsComponents,
    ) -> Result<(), StoreError> {
        match since {
            Some(at) => self.since(at, path, what),
            None => self.fixed(path, what),
        }
    }

    /// Writes many rows at once.
    pub fn columns(
        &mut self,
        clock: &[TimeColumn],
        path: &EntityPath,
        columns: impl IntoIterator<Item = SerializedComponentColumn>,
    ) -> Result<(), StoreError> {
        let timelines = clock.iter().map(|c| (*c.timeline().name(), c.clone())).collect();
        let components = columns.into_iter().collect();
        let chunk = Chunk::from_auto_row_ids(self.id(), path.clone(), timelines, components)?;
        if chunk.is_empty() {
            return Ok(());
        }
        self.append(self.recording.clone(), &chunk)
    }

    /// Writes a part of the layout.
    pub fn layout(&mut self, path: &EntityPath, what: &dyn AsComponents) -> Result<(), StoreError> {
        let at = TimePoint::from([(Timeline::new_sequence("blueprint"), TimeInt::ZERO)]);
        let chunk = self.row(at, path, what)?;
        self.append(self.layout.clone(), &chunk)
    }

    /// Makes the viewer open with the layout.
    pub fn activate_layout(&mut self) -> Result<(), StoreError> {
        let command =
            BlueprintActivationCommand { blueprint_id: self.layout.clone(), make_active: true, make_default: true };
        self.send(command.into())
    }

    /// Finishes the file with its table of contents, or waits until the viewer has everything. Returns the file, if there is one; a store that is
    /// dropped instead leaves none.
    pub fn close(self) -> Result<Option<NewFile>, StoreError> {
        match self.to {
            Open::File(mut encoder) => {
                encoder.finish()?;
                let mut file = encoder.into_inner()?;
                file.flush()?;
                Ok(Some(file))
            }
            #[cfg(feature = "stream")]
            Open::Viewer(stream) => Ok(stream.finish()?).map(|()| None),
        }
    }
}
