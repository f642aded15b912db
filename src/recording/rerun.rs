//! The parts of the Rerun SDK that recordings need, under the names that the SDK gives them.
//!
//! The whole SDK also brings a store of the viewer's and much else. A recording is a file of chunks, or a stream of them:
//! data types, chunks, the encoder and the client suffice.

pub use re_build_info::CrateVersion;
pub use re_chunk::{Chunk, ChunkError, ChunkId, RowId, TimeColumn};
#[cfg(feature = "stream")]
pub use re_grpc_client::Client;
#[cfg(feature = "stream")]
pub use re_grpc_client::write::{ClientConnectionState as StreamState, Options as StreamOptions};
pub use re_log_encoding::{EncodeError, Encoder, EncodingOptions};
pub use re_log_types::{
    BlueprintActivationCommand, EntityPath, EntityPathPart, LogMsg, SetStoreInfo, StoreId, StoreInfo, StoreKind,
    StoreSource, TimeInt, TimePoint, Timeline,
};
pub use re_sdk_types::archetypes::*;
pub use re_sdk_types::components::{Color, MediaType, Radius, TextLogLevel};
pub use re_sdk_types::datatypes::Quaternion;
pub use re_sdk_types::{
    AnyValues, AsComponents, SerializationError, SerializedComponentBatch, SerializedComponentColumn,
};
pub use re_sdk_types::{blueprint, components, datatypes};
#[cfg(feature = "stream")]
pub use re_uri::{Error as UriError, ProxyUri};
pub use uuid::Uuid;
