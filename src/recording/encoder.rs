//! The file format of recordings: chunks, and at the end their table of contents.
//!
//! The encoder of the SDK writes the same. It takes each chunk apart again, twice, for its table of contents; here its
//! schema is known, which saves a tenth of the time of a recording.

use std::io::Write;

use crate::rerun::{
    ArrowEncoding, ChunkBatch, CodecError, Compression, CrateVersion, Encodable, EncodingOptions, LogMsg,
    ManifestBuilder, MessageHeader, MessageKind, RECORDING_MARK, Span, StoreId, StreamFooter, StreamHeader,
    StreamWriter, ToTransport, TransportChunk, TransportCompression, TransportFooter, TransportManifest,
    TransportMessage, compress,
};

use super::store::StoreError;

/// Writes a recording; without [`RecordingEncoder::finish`] it has no table of contents.
pub struct RecordingEncoder<W> {
    to: W,
    /// Number of bytes written so far.
    written: u64,
    /// A message, before it is written.
    buffer: Vec<u8>,
    /// The columns of a chunk, before they are compressed.
    plain: Vec<u8>,
    /// Tables of contents, store by store.
    contents: Vec<(StoreId, ManifestBuilder)>,
}

impl From<CodecError> for StoreError {
    fn from(error: CodecError) -> Self {
        Self::Data(error.to_string())
    }
}

impl From<crate::rerun::ArrowError> for StoreError {
    fn from(error: crate::rerun::ArrowError) -> Self {
        Self::Data(error.to_string())
    }
}

impl<W: Write> RecordingEncoder<W> {
    /// Begins a recording.
    pub fn new(to: W) -> Result<Self, StoreError> {
        let mut encoder = Self { to, written: 0, buffer: Vec::new(), plain: Vec::new(), contents: Vec::new() };
        let options = EncodingOptions::PROTOBUF_COMPRESSED;
        encoder.put(&StreamHeader { fourcc: RECORDING_MARK, version: CrateVersion::LOCAL.to_bytes(), options })?;
        Ok(encoder)
    }

    /// Writes one thing; returns where it begins.
    fn put(&mut self, what: &dyn Encodable) -> Result<u64, StoreError> {
        self.buffer.clear();
        what.to_rrd_bytes(&mut self.buffer)?;
        self.to.write_all(&self.buffer)?;
        let start = self.written;
        self.written += self.buffer.len() as u64;
        Ok(start)
    }

    /// Writes a message that is no chunk.
    pub fn message(&mut self, message: &LogMsg) -> Result<(), StoreError> {
        self.put(&message.to_transport(Compression::LZ4)?).map(|_| ())
    }

    /// Writes a chunk of a store.
    pub fn chunk(&mut self, store: &StoreId, chunk: &ChunkBatch) -> Result<(), StoreError> {
        self.plain.clear();
        let mut columns = StreamWriter::try_new(&mut self.plain, chunk.schema_ref())?;
        columns.write(chunk)?;
        columns.finish()?;
        drop(columns);
        let size = self.plain.len() as u64;
        let message = TransportChunk {
            store_id: Some(store.clone().into()),
            chunk_id: Some(chunk.chunk_id().as_tuid().into()),
            compression: TransportCompression::Lz4 as i32,
            uncompressed_size: size,
            encoding: ArrowEncoding::ArrowIpc as i32,
            payload: compress(&self.plain).into(),
            is_static: Some(chunk.is_static()),
        };
        let header = MessageHeader::ENCODED_SIZE_BYTES as u64;
        let start = self.put(&TransportMessage::ArrowMsg(message))? + header;
        let place = Span::from_start_end(start, self.written);
        let of_store = match self.contents.iter().position(|(of, _)| of == store) {
            Some(i) => i,
            None => {
                self.contents.push((store.clone(), ManifestBuilder::default()));
                self.contents.len() - 1
            }
        };
        Ok(self.contents[of_store].1.append(chunk, place, size)?)
    }

    /// Writes the table of contents; returns where the recording went.
    pub fn finish(mut self) -> Result<W, StoreError> {
        let mut manifests = Vec::with_capacity(self.contents.len());
        for (store, contents) in std::mem::take(&mut self.contents) {
            let built = contents.build(store.clone())?;
            manifests.push(TransportManifest {
                store_id: Some(store.into()),
                sorbet_schema_sha256: Some(built.sorbet_schema_sha256.to_vec().into()),
                sorbet_schema: Some((&built.sorbet_schema).try_into()?),
                data: Some(built.data.into()),
            });
        }
        let mut footer = Vec::new();
        TransportFooter { manifests }.to_rrd_bytes(&mut footer)?;
        let start =
            self.put(&MessageHeader { kind: MessageKind::End, len: footer.len() as u64 })? + self.buffer.len() as u64;
        self.to.write_all(&footer)?;
        self.put(&StreamFooter::from_rrd_footer_bytes(start, &footer))?;
        Ok(self.to)
    }
}
