//! What is derived from other things is a [`Query`]: it is asked of [`Queries`], made when its input changes, and kept
//! until then. This is the one place where anything derived is kept.
//!
//! | what | how |
//! |---|---|
//! | input | a value: all that the answer depends on, and nothing else |
//! | answer | shared, never changed |
//! | [`Queries::ask`] | answers at once |
//! | [`Queries::ask_beside`] | answers at once what is known, else with the last answer while work goes on beside |
//! | [`Queries::grow`] | takes up what is new in a [`Sequence`], in portions |
//!
//! An answer follows from its input alone, because nothing else is given to the work. Of several inputs asked about one
//! after the other the newest counts: work on an older one stops, or ends first if it is short. Where there are no
//! threads the work is done in portions, one for each time it is asked about.

mod asked;
mod growing;
mod input;
mod job;
mod queries;
mod question;
mod sequence;
mod slot;

pub use asked::{Asked, State};
pub use growing::{Growing, Grown, grown};
pub use input::{Same, Shared};
pub use job::{AtOnce, Job, Poll, Short, Ticket, Work, Workers};
pub use queries::{Asking, Queries};
pub use question::{Portion, Query, Quick, Watch, Whole, answered, part};
pub use sequence::{Mark, Revision, Sequence};
