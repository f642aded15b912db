//! [`Bars`]: real parts of the links' contributions to the conditions (7) or (8), a group of bars for each condition.

use crate::rerun::{BarChart, EntityPath};

use crate::rows::SparseRows;
use crate::store::{Instant, Store, StoreError};
use crate::style::{colour, under};
use stillbase_mechanics::balance::{Breakdown, Condition};
use stillbase_mechanics::machine::Machine;
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::palette::{Theme, palette};

/// Width of a group of bars, as a fraction of the distance between groups.
const GROUP_WIDTH: f64 = 0.86;

/// Bars of one colour: the contributions of the links of one drive, or the residuals.
pub struct Bars {
    path: String,
    rgba: Rgba,
    is_force: bool,
    /// Indices of the links, from 0; `None` for the residuals.
    links: Option<Vec<usize>>,
    /// Number of bars for each condition.
    slots: usize,
    /// Number of conditions.
    lines: usize,
}

impl Bars {
    /// Returns all bars of a machine.
    pub fn all(machine: &Machine) -> Vec<Self> {
        let palette = palette(Theme::Dark);
        let slots = machine.links().len() + 1;
        let mut all = Vec::new();
        for (is_force, name) in [(true, "force"), (false, "coupling")] {
            let lines = Condition::all_of(machine).filter(|c| matches!(c, Condition::Force(_)) == is_force).count();
            if lines == 0 {
                continue;
            }
            let bars = |path: &str, rgba, links| Self {
                path: format!("bars/{name}/{path}"),
                rgba,
                is_force,
                links,
                slots,
                lines,
            };
            for drive in 0..machine.drives() {
                let own = machine.resolved_links().iter().enumerate().filter(|(_, part)| part.drive == drive);
                let own: Vec<usize> = own.map(|(link, _)| link).collect();
                if !own.is_empty() {
                    all.push(bars(&format!("drive_{}", drive + 1), palette.drive(drive), Some(own)));
                }
            }
            all.push(bars("left", palette.ink, None));
        }
        all
    }

    /// Returns the abscissas of the bars; the group of condition i, counted from 1, is centred at i.
    fn abscissa(&self) -> Vec<f64> {
        let place = |line: usize, slot: usize| {
            let from_middle = slot as f64 - 0.5 * (self.slots - 1) as f64;
            (line + 1) as f64 + from_middle * GROUP_WIDTH / self.slots as f64
        };
        let last = [self.slots - 1];
        let slots = self.links.as_deref().unwrap_or(&last);
        (0..self.lines).flat_map(|line| slots.iter().map(move |slot| place(line, *slot))).collect()
    }

    fn values(&self, breakdown: &Breakdown) -> Vec<f64> {
        let lines =
            breakdown.terms.iter().filter(|term| matches!(term.condition, Condition::Force(_)) == self.is_force);
        let of = |term| match &self.links {
            Some(links) => links.iter().map(|link| breakdown.of_link(term, *link).re).collect::<Vec<_>>(),
            None if term.balanced => vec![0.0],
            None => vec![term.residual.re],
        };
        lines.flat_map(of).collect()
    }

    /// Writes the bars for each state.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write<'a>(
        &self,
        store: &mut Store,
        root: &EntityPath,
        states: impl Iterator<Item = (Instant, &'a Breakdown)>,
    ) -> Result<(), StoreError> {
        let path = under(root, &self.path);
        let mut track = SparseRows::new();
        let mut moves = false;
        for (at, breakdown) in states {
            moves |= at.edit.is_some();
            track.push(at, self.values(breakdown));
        }
        let (clock, rows) = track.take();
        let abscissa = self.abscissa();
        let widths = vec![(0.92 * GROUP_WIDTH / self.slots as f64) as f32; abscissa.len()];
        let looks = BarChart::update_fields()
            .with_color(colour(self.rgba))
            .with_abscissa(abscissa.as_slice())
            .with_widths(widths);
        if let ([row], false) = (&rows[..], moves) {
            return store.fixed(&path, &looks.with_values(row.as_slice()));
        }
        store.fixed(&path, &looks)?;
        let rows = BarChart::update_fields().with_many_values(rows.iter().map(Vec::as_slice));
        store.columns(&clock.columns(), &path, rows.columns_of_unit_batches()?)
    }
}
