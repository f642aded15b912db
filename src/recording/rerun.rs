//! The parts of the Rerun SDK that recordings need, under the names that the SDK gives them.
//!
//! The whole SDK also brings a store of the viewer's and much else. A recording is a file of chunks, or a stream of them:
//! data types, chunks, the encoder and the client suffice.

pub use arrow::error::ArrowError;
pub use arrow::ipc::writer::StreamWriter;
pub use re_build_info::CrateVersion;
pub use re_chunk::{Chunk, ChunkError, ChunkId, RowId, TimeColumn};
pub use re_grpc_client::Client;
pub use re_grpc_client::write::{ClientConnectionState as StreamState, Options as StreamOptions};
pub use re_log_encoding::external::lz4_flex::block::compress;
pub use re_log_encoding::{
    CodecError, Compression, Encodable, EncodingOptions, MessageHeader, MessageKind, RRD_FOURCC as RECORDING_MARK,
    RrdManifestBuilder as ManifestBuilder, StreamFooter, StreamHeader, ToTransport,
};
pub use re_log_types::{
    ArrowMsg, BlueprintActivationCommand, EntityPath, EntityPathPart, LogMsg, SetStoreInfo, StoreId, StoreInfo,
    StoreKind, StoreSource, TimeInt, TimePoint, Timeline,
};
pub use re_protos::common::v1alpha1::Compression as TransportCompression;
pub use re_protos::log_msg::v1alpha1::log_msg::Msg as TransportMessage;
pub use re_protos::log_msg::v1alpha1::{
    ArrowMsg as TransportChunk, Encoding as ArrowEncoding, RrdFooter as TransportFooter,
    RrdManifest as TransportManifest,
};
pub use re_sdk_types::archetypes::*;
pub use re_sdk_types::components::{Color, MediaType, Radius, TextLogLevel};
pub use re_sdk_types::datatypes::Quaternion;
pub use re_sdk_types::{
    AnyValues, AsComponents, SerializationError, SerializedComponentBatch, SerializedComponentColumn,
};
pub use re_sdk_types::{blueprint, components, datatypes};
pub use re_sorbet::ChunkBatch;
pub use re_span::Span;
pub use re_uri::{Error as UriError, ProxyUri};
pub use uuid::Uuid;
