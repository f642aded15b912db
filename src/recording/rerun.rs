//! The parts of the Rerun SDK that recordings need, under the names that the SDK gives them.
//!
//! The whole SDK also brings a network client, a runtime and a store of the viewer's. A recording is a file of chunks:
//! data types, chunks and the encoder suffice.

pub use re_build_info::CrateVersion;
pub use re_chunk::{Chunk, ChunkError, ChunkId, RowId, TimeColumn};
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
pub use uuid::Uuid;
