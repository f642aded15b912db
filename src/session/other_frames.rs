//! [`OtherFrames`]: frames of the blocks of an assembly beside the one that is led.

use super::run::Run;
use crate::assembly::SharedRun;
use stillbase_query::Sequence;
use stillbase_simulation::frame::Frame;

/// The frames of other blocks, one for each step, each list with the place of its block in the assembly.
#[derive(Clone, Debug, Default)]
pub struct OtherFrames(Vec<(usize, Sequence<Frame>)>);

impl OtherFrames {
    /// Adds the frames of the present step of a run.
    pub(super) fn push(&mut self, run: &Run) {
        for (place, (block, frame)) in run.shared().into_iter().flat_map(SharedRun::frames).enumerate() {
            if self.0.len() == place {
                self.0.push((block, Sequence::default()));
            }
            self.0[place].1.push(frame);
        }
    }

    /// Replaces the frames of the newest step by those of the present step of a run.
    pub(super) fn replace_last(&mut self, run: &Run) {
        for (own, (_, frame)) in self.0.iter_mut().zip(run.shared().into_iter().flat_map(SharedRun::frames)) {
            own.1.replace_last(frame);
        }
    }

    /// Returns the frames of a step.
    pub fn at(&self, step: usize) -> impl Iterator<Item = (usize, &Frame)> + Clone {
        self.0.iter().filter_map(move |(block, frames)| Some((*block, frames.get(step)?)))
    }
}
