//! What reaches the base, drawn: an arrow and an arc in true proportion, with numbers and scale beside them.

use rerun::{Arrows3D, Color, EntityPath, LineStrips3D, Points3D, Radius};
use std::f64::consts::FRAC_PI_2;

use super::rehearsal::Rehearsal;
use super::rows::Track;
use super::store::{Instant, Store, StoreError};
use super::style::{colour, point, under};
use crate::mechanics::planar::{Vector, unit};
use crate::picture::scene::palette::Palette;
use crate::picture::scene::reaction::{ARROW, RADIUS, Reaction};
use crate::picture::scene::stage::round_up;
use crate::simulation::frame::Frame;

/// What a full arrow and a full arc stand for. Cases of one recording share it, so that they can be compared.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    newtons: f64,
    newton_metres: f64,
}

impl Scale {
    /// The next round numbers above the largest of all cases.
    pub fn of(cases: &[Rehearsal]) -> Self {
        let largest = |of: fn(&Rehearsal) -> f64| round_up(cases.iter().map(of).fold(1e-3, f64::max));
        Self { newtons: largest(|c| c.peaks.force), newton_metres: largest(|c| c.peaks.moment) }
    }
}

/// How far below B the first row of words stands, and how far apart the rows are, parts of the reach.
const FIRST: f64 = 0.37;
const ROW: f64 = 0.06;

/// The drawing of one case.
#[derive(Debug)]
pub struct Drawing {
    scale: Scale,
    palette: Palette,
    /// What the base carries besides.
    rest: &'static str,
    arrows: Track<Option<([f32; 3], [f32; 3])>>,
    arcs: Track<Option<Vec<[f32; 3]>>>,
    words: Track<Vec<([f32; 3], String, Color)>>,
}

impl Drawing {
    /// Nothing yet, but how it looks; `rest` names what the base carries besides.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn show(
        store: &mut Store,
        root: &EntityPath,
        scale: Scale,
        palette: Palette,
        rest: &'static str,
    ) -> Result<Self, StoreError> {
        let red = [colour(palette.reaction)];
        let force = Arrows3D::update_fields().with_radii([Radius::new_ui_points(2.0)]).with_colors(red);
        store.fixed(&under(root, "reaction/force"), &force)?;
        let moment = LineStrips3D::update_fields().with_radii([Radius::new_ui_points(1.8)]).with_colors(red);
        store.fixed(&under(root, "reaction/moment"), &moment)?;
        let words = Points3D::update_fields().with_radii([Radius::ZERO]).with_show_labels(true);
        store.fixed(&under(root, "reaction/words"), &words)?;
        Ok(Self { scale, palette, rest, arrows: Track::new(), arcs: Track::new(), words: Track::new() })
    }

    /// One instant, at a height above a machine of a reach, m.
    pub fn place(&mut self, at: Instant, frame: &Frame, reach: f64, z: f64) {
        let (from, felt) = (frame.base.at, Reaction::of(frame));
        let arrow = felt.arrow(self.scale.newtons).map(|parts| parts * reach);
        self.arrows.push(at, arrow.map(|arrow| (point(from, z), point(arrow, 0.0))));
        let sweep = felt.sweep(self.scale.newton_metres);
        self.arcs.push(at, sweep.map(|sweep| arc(from, sweep, RADIUS * reach, z)));
        let dim = self.palette.dim;
        let scale = [
            arrow.map(|_| format!("arrow {:.2} m = {} N", ARROW * reach, self.scale.newtons)),
            sweep.map(|_| format!("arc 135° = {} N m", self.scale.newton_metres)),
        ];
        let scale: Vec<String> = scale.into_iter().flatten().collect();
        let rows = felt
            .readings(&self.palette)
            .into_iter()
            .chain(felt.beside(self.rest).map(|text| (text, dim)))
            .chain((!scale.is_empty()).then(|| (scale.join(" · "), dim)));
        let down = |i: usize| Vector::new(0.0, -(FIRST + ROW * i as f64) * reach);
        let placed = |(i, (text, tone))| (point(from + down(i), z), text, colour(tone));
        self.words.push(at, rows.enumerate().map(placed).collect());
    }

    /// Writes the rows since the last time.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&mut self, store: &mut Store, root: &EntityPath) -> Result<(), StoreError> {
        let (clock, rows) = self.arrows.take();
        let lengths: Vec<_> = rows.iter().map(|r| usize::from(r.is_some())).collect();
        let (origins, vectors): (Vec<_>, Vec<_>) = rows.into_iter().flatten().unzip();
        let arrows = Arrows3D::update_fields().with_vectors(vectors).with_origins(origins);
        store.columns(&clock.columns(), &under(root, "reaction/force"), arrows.columns(lengths)?)?;
        let (clock, rows) = self.arcs.take();
        let lengths: Vec<_> = rows.iter().map(|r| usize::from(r.is_some())).collect();
        let arcs = LineStrips3D::new(rows.into_iter().flatten());
        store.columns(&clock.columns(), &under(root, "reaction/moment"), arcs.columns(lengths)?)?;
        let (clock, rows) = self.words.take();
        let lengths: Vec<_> = rows.iter().map(Vec::len).collect();
        let words = Points3D::update_fields()
            .with_positions(rows.iter().flatten().map(|r| r.0))
            .with_labels(rows.iter().flatten().map(|r| r.1.as_str()))
            .with_colors(rows.iter().flatten().map(|r| r.2));
        store.columns(&clock.columns(), &under(root, "reaction/words"), words.columns(lengths)?)
    }
}

/// An arc about a point with a head, in one line.
fn arc(centre: Vector, sweep: f64, radius: f64, z: f64) -> Vec<[f32; 3]> {
    let n = ((sweep.abs() * 10.0).ceil() as usize).max(2);
    let on = |i: usize| centre + unit(-FRAC_PI_2 + sweep * i as f64 / n as f64) * radius;
    let along = unit(-FRAC_PI_2 + sweep) * Vector::new(0.0, sweep.signum());
    let barb = |turn: f64| on(n) - along * unit(turn) * (0.15 * radius);
    let head = [on(n), barb(0.5), on(n), barb(-0.5)];
    (0..n).map(on).chain(head).map(|p| point(p, z)).collect()
}
