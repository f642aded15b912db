//! [`RecordedFronts`]: the Pareto front of added mass and inertia, with the point of the present machine.

use crate::rerun::{EntityPath, LineStrips2D, Points2D, Radius};

use super::state::bare;
use crate::rows::SparseRows;
use crate::store::{Instant, Store, StoreError};
use crate::style::{colour, under};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_picture::numbers::{at_step, round_ticks, signed};
use stillbase_picture::scene::palette::{Theme, mix, palette};
use stillbase_session::DesignVersion;
use stillbase_session::scenario::DesignBrief;

/// Number of points of a Pareto front.
const FRONT_POINTS: usize = 13;

/// Width and height of the drawing, dimensionless; y points down, as in the viewer.
const SIZE: [f64; 2] = [2.2, 1.0];
/// Margin around all points, as a fraction of their range.
const MARGIN_FRACTION: f64 = 0.07;
/// Left, top, right and bottom of the visible part of the drawing, with space for tick labels.
pub const FRONT_VIEW: [f64; 4] = [-0.3, -0.16, 2.36, 1.4];

/// The Pareto fronts of the states of a design.
#[derive(Debug)]
pub struct RecordedFronts {
    all: Vec<RecordedFront>,
    /// Intervals of the axes, kg and kg m².
    ranges: [[f64; 2]; 2],
}

/// The Pareto front of a machine.
#[derive(Debug)]
struct RecordedFront {
    /// The machine without its counterweights, except fixed ones.
    bare: Machine,
    /// Bounds on the counterweights.
    brief: DesignBrief,
    /// Added mass, kg, and Σ D_k, kg m², of each point.
    points: Vec<[f64; 2]>,
}

impl RecordedFront {
    fn is_of(&self, bare: &Machine, brief: &DesignBrief) -> bool {
        self.bare == *bare && self.brief == *brief
    }
}

impl RecordedFronts {
    /// Computes the Pareto fronts of those machines that have counterweights, as the design view does; `None` if no
    /// counterweights within the bounds of the design balance any of them.
    pub fn of<'a>(versions: impl Iterator<Item = &'a DesignVersion>) -> Option<Self> {
        let mut all: Vec<RecordedFront> = Vec::new();
        let mut seen: Vec<[f64; 2]> = Vec::new();
        for DesignVersion { machine, brief, .. } in versions {
            let Some(bare) = bare(machine) else { continue };
            let brief = &brief.fitting(machine);
            if !all.iter().any(|known| known.is_of(&bare, brief)) {
                let found = brief.front(&bare, FRONT_POINTS);
                let points = found.map_or_else(|_| Vec::new(), |front| front.measures());
                seen.extend(&points);
                all.push(RecordedFront { bare, brief: brief.clone(), points });
            }
            seen.push(own(machine));
        }
        if all.iter().all(|front| front.points.is_empty()) {
            return None;
        }
        let range = |i: usize| {
            let ends = (f64::INFINITY, f64::NEG_INFINITY);
            let (low, high) = seen.iter().fold(ends, |(low, high), at| (low.min(at[i]), high.max(at[i])));
            let room = MARGIN_FRACTION * (high - low).max(1e-3 * high.abs()).max(1e-9);
            [low - room, high + room]
        };
        Some(Self { ranges: [range(0), range(1)], all })
    }

    fn place(&self, at: [f64; 2]) -> [f32; 2] {
        let share = |i: usize| (at[i] - self.ranges[i][0]) / (self.ranges[i][1] - self.ranges[i][0]);
        [SIZE[0] * share(0), SIZE[1] * (1.0 - share(1))].map(|x| x as f32)
    }

    /// Writes the Pareto front of each state.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write<'a>(
        &self,
        store: &mut Store,
        root: &EntityPath,
        states: impl Iterator<Item = (Instant, &'a DesignVersion)>,
    ) -> Result<(), StoreError> {
        let root = &under(root, "front");
        self.axes(store, root)?;
        let (mut curves, mut points) = (SparseRows::new(), SparseRows::new());
        for (at, DesignVersion { machine, brief, .. }) in states {
            let brief = brief.fitting(machine);
            let known = bare(machine).and_then(|bare| self.all.iter().find(|known| known.is_of(&bare, &brief)));
            curves.push(at, known.map(|known| known.points.iter().map(|at| self.place(*at)).collect::<Vec<_>>()));
            points.push(at, known.map(|_| own(machine)));
        }
        let palette = palette(Theme::Dark);
        let (clock, rows) = curves.take();
        let curve = |row: &Option<Vec<[f32; 2]>>| row.clone().unwrap_or_default();
        for (i, at) in clock.instants().enumerate() {
            let since = Some(at).filter(|at| at.edit.is_some());
            let line = curve(&rows[i]);
            let strips = LineStrips2D::new((line.len() > 1).then_some(line.clone()))
                .with_radii([Radius::new_ui_points(0.9)])
                .with_colors([colour(palette.zero)])
                .with_draw_order(1.0);
            store.shape(since, &under(root, "curve"), &strips)?;
            let dots = Points2D::new(line)
                .with_radii([Radius::new_ui_points(3.5)])
                .with_colors([colour(palette.zero)])
                .with_draw_order(2.0);
            store.shape(since, &under(root, "machines"), &dots)?;
        }
        let (clock, rows) = points.take();
        for (i, at) in clock.instants().enumerate() {
            let since = Some(at).filter(|at| at.edit.is_some());
            let dot = Points2D::new(rows[i].map(|at| self.place(at)))
                .with_radii([Radius::new_ui_points(6.0)])
                .with_colors([colour(palette.amber)])
                .with_draw_order(3.0);
            store.shape(since, &under(root, "now"), &dot)?;
            let words = |[mass, inertia]: [f64; 2]| format!("{} kg · {} kg m²", signed(mass, 2), signed(inertia, 3));
            let aside = |at: [f64; 2]| {
                let [x, y] = self.place(at);
                [x.clamp(0.42, SIZE[0] as f32 - 0.42), if y < 0.2 { y + 0.13 } else { y - 0.13 }]
            };
            let label = Points2D::new(rows[i].map(aside))
                .with_radii([Radius::ZERO])
                .with_colors([colour(palette.amber)])
                .with_labels(rows[i].map(words));
            store.shape(since, &under(root, "now/words"), &label)?;
        }
        Ok(())
    }

    /// Writes the axes with grid and tick labels.
    fn axes(&self, store: &mut Store, root: &EntityPath) -> Result<(), StoreError> {
        let palette = palette(Theme::Dark);
        let (mut grid, mut places, mut words) = (Vec::new(), Vec::new(), Vec::new());
        let [wide, high] = SIZE.map(|x| x as f32);
        for (i, [from, to]) in self.ranges.into_iter().enumerate() {
            let (marks, step) = round_ticks(from, to, if i == 0 { 7.0 } else { 5.0 });
            for mark in marks.into_iter().filter(|mark| (from..=to).contains(mark)) {
                let mut at = [self.ranges[0][0], self.ranges[1][0]];
                at[i] = mark;
                let [x, y] = self.place(at);
                let (end, beside) = match i {
                    0 => ([x, 0.0], [x, high + 0.09]),
                    _ => ([wide, y], [-0.13, y]),
                };
                grid.push([[x, y], end]);
                places.push(beside);
                words.push(at_step(mark, step));
            }
        }
        places.extend([[wide - 0.26, high + 0.24], [0.02, -0.09]]);
        words.extend(["added mass, kg", "Σ D, kg m²"].map(String::from));
        let lines = LineStrips2D::new(grid)
            .with_radii([Radius::new_ui_points(0.5)])
            .with_colors([colour(palette.line)])
            .with_draw_order(-1.0);
        store.fixed(&under(root, "grid"), &lines)?;
        let frame = LineStrips2D::new([[[0.0, 0.0], [0.0, high], [wide, high]]])
            .with_radii([Radius::new_ui_points(0.7)])
            .with_colors([colour(mix(palette.line, palette.dim, 0.5))]);
        store.fixed(&under(root, "axes"), &frame)?;
        let numbers = Points2D::new(places)
            .with_radii([Radius::ZERO])
            .with_colors([colour(palette.dim)])
            .with_labels(words)
            .with_show_labels(true);
        store.fixed(&under(root, "axes/numbers"), &numbers)
    }
}

/// Returns the mass of all counterweights of a machine, kg, and its Σ D, kg m².
fn own(machine: &Machine) -> [f64; 2] {
    let added = machine.spec().counterweights.iter().map(|weight| weight.mass).sum();
    [added, Inertia::of(machine).total_momentum()]
}
