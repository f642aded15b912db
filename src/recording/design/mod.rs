//! The design of a machine: its masses, the residuals of (7) and (8), and the cost of balance. Each state of the
//! machine in a session is a row on the time line `edit`. On the other time lines it is valid from the instant of its
//! edit.

mod bars;
mod front;
mod state;
mod words;

use crate::rerun::{EntityPath, TextDocument};

use super::eye::Eye;
use super::rows::SparseRows;
use super::space::RecordingSpace;
use super::store::{Instant, Store, StoreError};
use super::style::under;
use bars::Bars;
use front::RecordedFronts;
use state::DesignState;
use stillbase_mechanics::planar::UnitVectors;
use stillbase_picture::scene::ItemChanges;
use stillbase_picture::scene::draft::DesignDrawing;
use stillbase_picture::scene::grid::Grid;
use stillbase_picture::scene::linkage::LinkageModel;
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::{Theme, palette};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Refusal, Run, designs};
use stillbase_simulation::frame::Frame;

pub use front::FRONT_VIEW;
pub use words::comparison_table;

/// Size of the machine as a fraction of the height and width of its view.
const FILL_FRACTION: f64 = 0.8;

/// A design to be recorded.
#[derive(Debug)]
pub struct RecordedDesign {
    states: Vec<DesignState>,
    /// Frame at the start of the run; every state is drawn in its pose.
    start: Frame,
    /// Eye of the view of the machine.
    pub eye: Eye,
    /// Pareto fronts of the counterweights, if the machine has any.
    pub fronts: Option<RecordedFronts>,
    /// Whether the design is the active tab: the machine has counterweights, or was changed in its session.
    pub leads: bool,
}

impl RecordedDesign {
    /// Returns the design of a run of a scenario; `start` is its first frame.
    ///
    /// # Errors
    /// If an edit cannot be applied to the machine.
    pub fn of(scenario: &Scenario, run: &Run, start: Frame) -> Result<Self, Refusal> {
        let (all, dt) = (designs(scenario)?, run.simulation().dt());
        let several = all.len() > 1;
        let first = all[0].machine.clone();
        let states = all.into_iter().map(|of| {
            let at = Instant { edit: several.then_some(of.changes), ..Instant::at(of.step, of.step as f64 * dt) };
            DesignState::of(at, of, &first, &run.plan().motion)
        });
        let states: Vec<DesignState> = states.collect();
        let has_weights = states.iter().any(|state| !state.of.machine.spec().counterweights.is_empty());
        Ok(Self {
            eye: above(states.iter().map(|state| &state.linkage), &start.q.units()),
            fronts: has_weights.then(|| RecordedFronts::of(states.iter().map(|state| &state.of))).flatten(),
            leads: several || has_weights,
            states,
            start,
        })
    }

    /// Returns the number of drives of the machine.
    pub fn drives(&self) -> usize {
        self.states[0].of.machine.drives()
    }

    /// Writes all states under a root.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&self, store: &mut Store, root: &EntityPath) -> Result<(), StoreError> {
        let root = &under(root, "design");
        self.draw(store, root)?;
        let count = self.states.last().map_or(0, |state| state.of.changes);
        self.document(store, &under(root, "state"), |state| words::state(state, count))?;
        self.document(store, &under(root, "links"), |state| words::links(&state.of.machine))?;
        self.document(store, &under(root, "balance"), |state| words::balance(&state.of.machine, &state.breakdown))?;
        for bars in Bars::all(&self.states[0].of.machine) {
            bars.write(store, root, self.states.iter().map(|state| (state.at, &state.breakdown)))?;
        }
        match &self.fronts {
            Some(fronts) => fronts.write(store, root, self.states.iter().map(|state| (state.at, &state.of))),
            None => Ok(()),
        }
    }

    /// Draws the machine from straight above.
    fn draw(&self, store: &mut Store, root: &EntityPath) -> Result<(), StoreError> {
        let palette = palette(Theme::Dark);
        let mut space = RecordingSpace::new(root.clone(), self.eye, palette.background);
        space.rename(vec![("design", "marks".into())]);
        let options = ViewOptions { show_hints: false, ..ViewOptions::default() };
        for state in &self.states {
            let machine = &state.of.machine;
            let linkage = &state.linkage;
            let mut scene = DesignDrawing::of(machine).scene((linkage, &Grid::of(linkage)), &self.start, &options);
            if state.at.edit.is_none() {
                // There is only one state, so its solids are constant.
                scene.solids.iter_mut().for_each(|solid| solid.changes = ItemChanges::Nothing);
            }
            space.draw(store, (state.at, state.at.edit.map(|_| state.at)), &scene)?;
        }
        space.write(store)
    }

    /// Writes the text of each state.
    fn document(
        &self,
        store: &mut Store,
        path: &EntityPath,
        of: impl Fn(&DesignState) -> String,
    ) -> Result<(), StoreError> {
        let mut track = SparseRows::new();
        self.states.iter().for_each(|state| track.push(state.at, of(state)));
        let (clock, texts) = track.take();
        if let ([text], None) = (&texts[..], self.states[0].at.edit) {
            return store.fixed(path, &TextDocument::from_markdown(text.as_str()));
        }
        let rows = TextDocument::update_fields()
            .with_many_media_type(texts.iter().map(|_| crate::rerun::MediaType::markdown()))
            .with_many_text(texts);
        store.columns(&clock.columns(), path, rows.columns_of_unit_batches()?)
    }
}

/// Returns an eye from which the machines of all versions are completely visible.
fn above<'a>(linkages: impl Iterator<Item = &'a LinkageModel>, e: &UnitVectors) -> Eye {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let wider = |[low, high]: [f64; 2], x: f64, r: f64| [low.min(x - r), high.max(x + r)];
    let mut seen = [wider(none, 0.0, 0.0); 2];
    for linkage in linkages {
        for bar in linkage.flat(e) {
            let covers = bar.covers.iter().flat_map(|cover| cover.ends.map(|end| (end, cover.radius)));
            for (p, r) in bar.ends.map(|end| (end, bar.radius)).into_iter().chain(covers) {
                seen = [wider(seen[0], p.re, r), wider(seen[1], p.im, r)];
            }
        }
    }
    let side = seen.iter().fold(0.0_f64, |side, [low, high]| side.max(high - low));
    Eye::above(seen.map(|[low, high]| 0.5 * (low + high)), side / FILL_FRACTION)
}
