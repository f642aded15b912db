//! [`SketchFacts`]: the drawing of the machine on display, and what it is.

use std::sync::Arc;

use stillbase_mechanics::sketch::{Resolved, Sketch, resolve};
use stillbase_query::{Queries, QuickQuery, QuickWork};
use stillbase_session::Session;

/// A drawing with what it is.
pub struct SketchFacts {
    pub sketch: Sketch,
    pub resolved: Arc<Resolved>,
}

/// Query for what a drawing is.
struct ResolvedSketch;

impl QuickQuery for ResolvedSketch {
    type Input = Sketch;
    type Answer = Resolved;

    fn answer(sketch: &Sketch) -> Resolved {
        resolve(sketch)
    }
}

impl SketchFacts {
    /// Returns the drawing of a session.
    pub fn of(queries: &Queries, session: &Session) -> Self {
        let sketch = session.scenario().drawing();
        Self { resolved: queries.ask::<QuickWork<ResolvedSketch>>(&sketch), sketch }
    }

    /// Whether nothing is missing.
    pub fn is_complete(&self) -> bool {
        self.resolved.machine.is_some()
    }
}
