//! A [`Store`]: rows and columns of a recording and of its layout, encoded one chunk at a time.
//!
//! A separate thread encodes and writes chunks in order, or sends them to a viewer, while the next chunk is made. It
//! returns its error, so that the caller learns of a full disk; the stream of the SDK only prints it to standard error.
//! Identifiers of chunks
//! count up from a number derived from the digest, so that equal data give equal chunks.

use std::io::Write;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use crate::rerun::StoreId;
use crate::rerun::{ArrowMsg, Chunk, ChunkBatch, ChunkError, ChunkId, LogMsg, RowId, TimeColumn};
use crate::rerun::{AsComponents, EntityPath, SerializedComponentColumn, StoreKind};
use crate::rerun::{BlueprintActivationCommand, SetStoreInfo, StoreInfo, StoreSource};
use crate::rerun::{TimeInt, TimePoint, Timeline};
use thiserror::Error;

use super::encoder::RecordingEncoder;
use super::viewer::{Viewer, ViewerError};
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
    Viewer(Viewer),
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
    to: SyncSender<Message>,
    /// Thread that writes; `None` once its result has been taken.
    writer: Option<JoinHandle<Result<Option<NewFile>, StoreError>>>,
    recording: StoreId,
    layout: StoreId,
    /// Identifier given out last; the next one is larger by [`CHUNK_ID_STEP`].
    next: u128,
}

/// Messages to the writer thread; without a final `Close` it leaves no file.
enum Message {
    Other(Box<LogMsg>),
    Chunk(StoreId, Box<ChunkBatch>),
    Close,
}

/// Maximum number of messages that wait for the writer.
const QUEUE_LENGTH: usize = 64;

/// Distance between the identifiers of chunks; identifiers of the rows of a chunk count up from that of the chunk.
const CHUNK_ID_STEP: u128 = 1 << 64;

impl Store {
    /// Begins a recording and its layout; `digest` identifies the recording.
    pub fn open(to: Sink, digest: u128) -> Result<Self, StoreError> {
        let (sender, receiver) = sync_channel(QUEUE_LENGTH);
        let take = move || match to {
            Sink::File(file) => write(file, &receiver).map(Some),
            Sink::Viewer(viewer) => stream(&viewer, &receiver).map(|()| None),
        };
        let writer = thread::Builder::new().name("recording".into()).spawn(take)?;
        let id = format!("{digest:032x}");
        let mut store = Self {
            to: sender,
            writer: Some(writer),
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
            store.send(Message::Other(Box::new(LogMsg::SetStoreInfo(SetStoreInfo { row_id, info }))))?;
        }
        Ok(store)
    }

    fn send(&mut self, message: Message) -> Result<(), StoreError> {
        match self.to.send(message) {
            Ok(()) => Ok(()),
            Err(_) => Err(self.why()),
        }
    }

    /// Returns the error that stopped the writer.
    fn why(&mut self) -> StoreError {
        match self.writer.take().map(JoinHandle::join) {
            Some(Ok(Err(error))) => error,
            _ => StoreError::Data("the writer has stopped".into()),
        }
    }

    fn id(&mut self) -> ChunkId {
        self.next += CHUNK_ID_STEP;
        ChunkId::from_u128(self.next)
    }

    fn append(&mut self, to: StoreId, chunk: &Chunk) -> Result<(), StoreError> {
        let batch = chunk.to_chunk_batch()?;
        self.send(Message::Chunk(to, Box::new(batch)))
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
        self.send(Message::Other(Box::new(command.into())))
    }

    /// Aborts the recording; no file is left.
    pub fn abandon(mut self) {
        drop(self.to);
        // The writer removes the file when it ends; its error is known already.
        let _ = self.writer.take().map(JoinHandle::join);
    }

    /// Finishes the file with its table of contents, or waits until the viewer has everything. Returns the file, if
    /// there is one.
    pub fn close(mut self) -> Result<Option<NewFile>, StoreError> {
        if self.to.send(Message::Close).is_err() {
            return Err(self.why());
        }
        match self.writer.take().map(JoinHandle::join) {
            Some(Ok(written)) => written,
            _ => Err(StoreError::Data("the writer has stopped".into())),
        }
    }
}

/// Encodes and writes messages until `Close`.
fn write(to: NewFile, messages: &Receiver<Message>) -> Result<NewFile, StoreError> {
    let mut encoder = RecordingEncoder::new(to)?;
    loop {
        match messages.recv() {
            Ok(Message::Other(message)) => encoder.message(&message)?,
            Ok(Message::Chunk(store, chunk)) => encoder.chunk(&store, &chunk)?,
            Ok(Message::Close) => break,
            Err(_) => return Err(StoreError::Data("given up".into())),
        }
    }
    let mut to = encoder.finish()?;
    to.flush()?;
    Ok(to)
}

/// Sends messages to a viewer until `Close`.
fn stream(to: &Viewer, messages: &Receiver<Message>) -> Result<(), StoreError> {
    let stream = to.connect()?;
    loop {
        match messages.recv() {
            Ok(Message::Other(message)) => stream.send(*message)?,
            Ok(Message::Chunk(store, chunk)) => {
                let chunk_id = chunk.chunk_id().as_tuid();
                let message = ArrowMsg { chunk_id, batch: (*chunk).into(), on_release: None };
                stream.send(LogMsg::ArrowMsg(store, message))?;
            }
            Ok(Message::Close) => return Ok(stream.finish()?),
            Err(_) => return Err(StoreError::Data("given up".into())),
        }
    }
}
