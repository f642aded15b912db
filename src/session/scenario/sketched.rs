//! Drawing the machine of a scenario.

use super::definition::Scenario;
use stillbase_mechanics::sketch::{Sketch, SketchRefusal, SketchStep};

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
}
