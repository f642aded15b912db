//! Drawing the machine of a scenario.

use thiserror::Error;

use super::definition::Scenario;
use stillbase_mechanics::sketch::{Sketch, SketchRefusal, SketchStep};

/// A drawing that lacks something to be a machine. Until it is one, the machine of its scenario is the one before, and
/// nothing that holds for that machine holds for the drawing.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the drawing {drawing:?} is no machine yet: {}", self.first_of())]
pub struct UnfinishedDrawing {
    /// Name of the drawing.
    pub drawing: String,
    /// What is missing, in words; at least one.
    pub missing: Vec<String>,
}

impl UnfinishedDrawing {
    /// Returns what is missing first, and how many things more.
    pub fn first_of(&self) -> String {
        let first = self.missing.first().map_or("", String::as_str);
        match self.missing.len() {
            0 | 1 => first.to_owned(),
            n => format!("{first}, and {} more", n - 1),
        }
    }

    /// Returns how many things are missing, in words: `1 thing missing`.
    pub fn count(&self) -> String {
        match self.missing.len() {
            1 => "1 thing missing".into(),
            n => format!("{n} things missing"),
        }
    }
}

impl Scenario {
    /// Returns the drawing of the machine: that of the scenario, or else the machine as it is drawn.
    pub fn drawing(&self) -> Sketch {
        self.sketch.clone().unwrap_or_else(|| Sketch::of(&self.machine, None))
    }

    /// Returns the scenario after a step of drawing. Once the drawing is complete, the machine is the one drawn.
    ///
    /// # Errors
    /// If the step does not fit the drawing.
    pub fn sketched(&self, step: &SketchStep) -> Result<Self, SketchRefusal> {
        let sketch = self.drawing().with(step)?;
        let machine = sketch.machine().unwrap_or_else(|| self.machine.clone());
        Ok(Self { machine, sketch: Some(sketch), ..self.clone() })
    }

    /// Returns what the drawing lacks, if it is no machine yet.
    pub fn unfinished(&self) -> Option<UnfinishedDrawing> {
        let sketch = self.sketch.as_ref()?;
        let missing = sketch.lacks();
        (!missing.is_empty()).then(|| UnfinishedDrawing { drawing: sketch.name.clone(), missing })
    }
}
