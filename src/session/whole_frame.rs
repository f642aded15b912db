//! [`WholeFrame`]: the frames of all blocks at one instant, and their signals.

use super::run::Run;
use crate::assembly::SharedRun;
use crate::scenario::Scenario;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::signals::{Signal, signals, signals_of_assembly};

/// The frames of all blocks of an assembly at one instant; of a machine by itself, its one frame.
#[derive(Clone, Debug)]
pub struct WholeFrame<'a> {
    /// Place of the led block in the assembly.
    block: usize,
    led: &'a Frame,
    others: Vec<(usize, Frame)>,
}

impl<'a> WholeFrame<'a> {
    /// Returns the frames of the present step of a run, of which `led` is that of the led block.
    pub fn of(run: &Run, led: &'a Frame) -> Self {
        let block = run.shared().map_or(0, |shared| shared.block().block);
        Self { block, led, others: run.shared().into_iter().flat_map(SharedRun::frames).collect() }
    }

    /// Returns the frame of a block; that of the led one, if there is no such block.
    pub fn frame(&self, block: usize) -> &Frame {
        let other = self.others.iter().find(|(own, _)| *own == block && block != self.block);
        other.map_or(self.led, |(_, frame)| frame)
    }

    /// Returns the value of one of [`signals_of_whole`].
    pub fn value(&self, signal: &Signal) -> f64 {
        signal.value(self.frame(signal.block))
    }
}

/// Returns all signals of a scenario, in a fixed order; of an assembly, those of all its blocks and of its base.
pub fn signals_of_whole(scenario: &Scenario) -> Vec<Signal> {
    let Some(block) = &scenario.assembly else { return signals(&scenario.machine) };
    let blocks = block.scenario.assembly.blocks().iter();
    signals_of_assembly(blocks.map(|block| (block.name.as_str(), &block.machine)), block.scenario.base.moves())
}
