//! [`Pen`]: the state of drawing.

use super::typed::Typed;
use crate::icon::Icon;
use stillbase_mechanics::sketch::{BarEnd, Pin, Sketch, SketchRefusal, SketchStep};
use stillbase_picture::scene::sketching::SketchItem;

/// What a click or drag in a drawing does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PenTool {
    /// Chooses things and moves pins.
    #[default]
    Move,
    /// Draws bars.
    Bar,
    /// Hangs motors on pins.
    Motor,
    /// Puts lumps on bars.
    Lump,
    /// Puts the end effector on a pin.
    EndEffector,
    /// Deletes pins and bars.
    Delete,
}

impl PenTool {
    /// All of them, in the order of the tool bar.
    pub const ALL: [Self; 6] = [Self::Bar, Self::Move, Self::Motor, Self::Lump, Self::EndEffector, Self::Delete];

    /// Returns its icon, its name, and what it does.
    pub fn words(self) -> (Icon, &'static str, &'static str) {
        match self {
            Self::Bar => (Icon::Bar, "bar", "Draw a bar from pin to pin: drag, or click both ends"),
            Self::Move => (Icon::Pointer, "move", "Click a thing for its card; drag a pin or a lump to move it"),
            Self::Motor => (Icon::Motor, "motor", "Click a pin: a motor there turns the bar that follows no drive yet"),
            Self::Lump => (Icon::Lump, "lump", "Click a bar: a known mass there, such as a motor or screws"),
            Self::EndEffector => (Icon::Tip, "end effector", "Click the pin that does the work"),
            Self::Delete => (Icon::Cross, "delete", "Click a bar, a pin or a lump to delete it"),
        }
    }

    /// Says what can be done in the drawing.
    pub fn invitation(self) -> &'static str {
        match self {
            // Short enough for a window of 1280 points.
            Self::Bar => "drag from pin to pin · type length, Tab, angle · Shift: freely · Ctrl: 10 mm",
            Self::Move => "drag a pin; onto another pin joins both · drag the end of an arc: a limit",
            Self::Motor => "click a pin to hang a motor on it",
            Self::Lump => "click a bar to put a known mass there · then drag it, and type what it weighs",
            Self::EndEffector => "click the pin that does the work",
            Self::Delete => "click a bar, a pin or a lump to delete it · Ctrl Z brings it back",
        }
    }
}

/// The start of a bar under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// As an end of the bar.
    pub end: BarEnd,
    /// Where it is, m.
    pub at: [f64; 2],
}

/// A drag under way, which is one step once it ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Drag {
    /// The pin, the lump or the limit that is dragged.
    pub item: SketchItem,
    /// The step that it would be if it ended now; `None` where it began.
    pub step: Option<SketchStep>,
    /// The place of the pin with which the dragged one would become one, m.
    pub onto: Option<[f64; 2]>,
}

/// The state of drawing, while a machine is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pen {
    /// The tool.
    pub tool: PenTool,
    /// The thing whose card is shown.
    pub chosen: Option<SketchItem>,
    /// The thing under the pointer.
    pub hot: Option<SketchItem>,
    /// The start of the bar under way.
    pub from: Option<Start>,
    /// What is typed about it.
    pub typed: Typed,
    /// The drag of a pin, a lump or a limit.
    pub drag: Option<Drag>,
    /// Why the last step was refused.
    pub refused: Option<SketchRefusal>,
    /// The pins of the last pass, by which new and moved ones are told.
    pub placed: Vec<Pin>,
}

/// A change of the [`Pen`].
#[derive(Clone, Debug)]
pub enum PenChange {
    /// Take a tool.
    Tool(PenTool),
    /// Show the card of a thing, or of none.
    Choose(Option<SketchItem>),
    /// Say why a step is refused.
    Refuse(SketchRefusal),
    /// A step is taken: no other is refused any more.
    Taken,
    /// Give up what is under way.
    GiveUp,
}

impl Pen {
    /// Whether Esc has something to give up.
    pub fn is_busy(&self) -> bool {
        self.from.is_some() || self.drag.is_some() || self.refused.is_some() || self.chosen.is_some()
    }

    /// Forgets things that a drawing does not have, as after a step was undone.
    pub fn keep_to(&mut self, sketch: &Sketch) {
        let is_there = |item: &SketchItem| match *item {
            SketchItem::Pin(pin) => sketch.pin(pin).is_some(),
            SketchItem::Bar(bar) => sketch.bar(bar).is_some(),
            SketchItem::Lump(bar, number) => {
                sketch.bar(bar).is_some_and(|bar| (1..=sketch.lumps_of(bar).count()).contains(&number))
            }
            SketchItem::Limit(arc, _) => arc < sketch.angles.len(),
        };
        self.chosen = self.chosen.filter(is_there);
        self.hot = self.hot.filter(is_there);
        self.drag = self.drag.take().filter(|drag| is_there(&drag.item));
    }

    /// Returns the state with a tool, with nothing under way.
    fn at_rest(&mut self, tool: PenTool) -> Self {
        Self { tool, chosen: self.chosen, placed: std::mem::take(&mut self.placed), ..Self::default() }
    }

    /// Takes over where the pins are now; returns whether one that is new or has moved fulfils a condition. During a drag
    /// nothing is taken over.
    pub fn places(&mut self, sketch: &Sketch, is_of: impl Fn(&Pin) -> bool) -> bool {
        if self.from.is_some() || self.drag.is_some() || self.placed == sketch.pins {
            return false;
        }
        let found = sketch.pins.iter().any(|pin| !self.placed.contains(pin) && is_of(pin));
        self.placed.clone_from(&sketch.pins);
        found
    }

    /// Applies a change.
    pub fn apply(&mut self, change: PenChange) {
        match change {
            PenChange::Tool(tool) => *self = self.at_rest(tool),
            PenChange::Choose(chosen) => self.chosen = chosen,
            PenChange::Refuse(refusal) => self.refused = Some(refusal),
            PenChange::Taken => self.refused = None,
            PenChange::GiveUp if self.from.is_some() || self.drag.is_some() || self.refused.is_some() => {
                *self = self.at_rest(self.tool);
            }
            PenChange::GiveUp => self.chosen = None,
        }
    }
}
