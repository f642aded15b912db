//! [`SketchFacts`]: the drawing of the machine on display, and what it is.

use std::sync::Arc;

use super::Pen;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::sketch::{Resolved, Sketch, SketchStep, resolve};
use stillbase_query::{Queries, QuickQuery, QuickWork};
use stillbase_session::Session;

/// A drawing with what it is.
pub struct SketchFacts {
    pub sketch: Sketch,
    pub resolved: Arc<Resolved>,
    /// The drawing as it would be if the drag under way ended now; `None` without one, or if it would be refused.
    preview: Option<Arc<Option<(Sketch, Resolved)>>>,
}

/// Query for a drawing after a step, with what it is; `None` if the step is refused.
struct PreviewedSketch;

impl QuickQuery for PreviewedSketch {
    type Input = (Sketch, SketchStep);
    type Answer = Option<(Sketch, Resolved)>;

    fn answer((sketch, step): &Self::Input) -> Self::Answer {
        let next = sketch.with(step).ok()?;
        let resolved = resolve(&next);
        Some((next, resolved))
    }
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
    /// Returns the drawing of a session, and as it would be after the drag under way.
    pub fn of(queries: &Queries, session: &Session, pen: &Pen) -> Self {
        let sketch = session.scenario().drawing();
        let step = pen.drag.as_ref().and_then(|drag| drag.step.as_ref());
        let preview = step.map(|step| queries.ask::<QuickWork<PreviewedSketch>>(&(sketch.clone(), step.clone())));
        Self { resolved: queries.ask::<QuickWork<ResolvedSketch>>(&sketch), sketch, preview }
    }

    fn previewed(&self) -> Option<(&Sketch, &Resolved)> {
        self.preview.as_deref().and_then(Option::as_ref).map(|(sketch, resolved)| (sketch, resolved))
    }

    /// Returns the drawing on display: as it would be after the drag under way.
    pub fn shown(&self) -> (&Sketch, &Resolved) {
        self.previewed().unwrap_or((&self.sketch, &self.resolved))
    }

    /// Returns the machine as it would be after the drag under way, while there is one.
    pub fn previewed_machine(&self) -> Option<&Machine> {
        self.previewed()?.1.machine.as_ref()
    }

    /// Whether nothing is missing.
    pub fn is_complete(&self) -> bool {
        self.resolved.machine.is_some()
    }
}
