//! A [`Query`] derives an answer from an input. [`Queries`] computes and caches the answer until the input changes.
//! This is the only cache of the program.
//!
//! Others reach this crate as `stillbase::query`; `stillbase` alone follows semantic versioning.
//!
//! | what | how |
//! |---|---|
//! | input | a value: all that the answer depends on, and nothing else |
//! | answer | shared, never changed |
//! | [`Queries::ask`] | returns the answer at once |
//! | [`Queries::ask_in_background`] | returns the answer if it is known, else the last answer while work runs in the background |
//! | [`Queries::grow`] | extends the answer by the new items of a [`Sequence`], in portions |
//!
//! An answer depends on its input alone, because the work receives nothing else. Of several inputs requested one after
//! the other, only the newest matters. Work on an older one is stopped, or finished first if it is short. Without
//! threads the work is done in portions, one at each request.

mod growing;
mod input;
mod job;
mod queries;
mod query_result;
mod question;
mod sequence;
mod slot;

#[doc(hidden)]
pub use growing::{IncrementalAnswer, IncrementalQuery, answer_sequence};
pub use input::{ByIdentity, Shared};
#[doc(hidden)]
pub use job::{InlineWorkers, Job, Poll, ShortJobs, Ticket, Work, Workers};
pub use queries::Queries;
#[doc(hidden)]
pub use queries::WeakQueries;
#[doc(hidden)]
pub use query_result::{QueryResult, QueryStatus};
#[doc(hidden)]
pub use question::part;
pub use question::{Portion, ProgressCallback, Query, QuickQuery, QuickWork, answer_now, answer_while};
pub use sequence::Sequence;
#[doc(hidden)]
pub use sequence::{Revision, RevisionMark};
