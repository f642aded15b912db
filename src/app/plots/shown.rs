//! The data that the plots show, and the frame at a time.

use std::sync::Arc;

use crate::ViewState;
use stillbase_query::Queries;
use stillbase_session::Session;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::signals::Signal;
use stillbase_study::comparison::Comparison;

/// The data shown by the plots.
pub struct DisplayContext<'a> {
    pub session: &'a Session,
    /// The queries about the session.
    pub queries: &'a Queries,
    pub signals: &'a Arc<Vec<Signal>>,
    pub comparison: Option<&'a Comparison>,
    pub view_state: &'a ViewState,
}

/// Returns the frame at a time, s, or the last one before it.
pub fn instant(session: &Session, time: f64) -> &Frame {
    let frames = session.frames();
    &frames[frames.partition_point(|f| f.time <= time + 1e-9).saturating_sub(1)]
}

/// Returns the frame nearest to a time, s.
pub fn nearest(session: &Session, time: f64) -> &Frame {
    instant(session, time + 0.5 * session.scenario().step)
}
