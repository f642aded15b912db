//! What reaches the base, drawn: an arrow and an arc in true proportion. Cases of one recording share the scale, so
//! that they can be compared; so it is drawn when all have run.

use std::f64::consts::FRAC_PI_2;
use std::io::Write;

use rerun::{Arrows3D, LineStrips3D, Points3D, Radius};

use super::recorder::{Case, Track, colour, point, under};
use super::store::{Store, StoreError};
use crate::planar::{Vector, unit};
use crate::scene::palette::{Theme, palette};
use crate::scene::stage::{round_up, signed};

/// One instant of what reaches the base.
#[derive(Clone, Copy, Debug)]
pub struct Reaction {
    /// When.
    pub at: super::store::Instant,
    /// B, m.
    pub from: Vector,
    /// f_B, static and dynamic, N.
    pub force: Vector,
    /// n_B, N m.
    pub moment: f64,
    /// Whether it counts as nothing.
    pub quiet: bool,
}

/// What a full arrow and a full arc stand for.
struct Scale {
    newtons: f64,
    newton_metres: f64,
}

/// The sweep of a full arc, rad.
const FULL: f64 = 1.5 * FRAC_PI_2;

/// Draws the reactions of all cases.
///
/// # Errors
/// If they cannot be written.
pub fn draw<W: Write>(store: &mut Store<W>, cases: &[Case]) -> Result<(), StoreError> {
    let all = || cases.iter().flat_map(|case| &case.reactions);
    let scale = Scale {
        newtons: round_up(all().map(|r| r.force.norm()).fold(1e-3, f64::max)),
        newton_metres: round_up(all().map(|r| r.moment.abs()).fold(1e-3, f64::max)),
    };
    cases.iter().try_for_each(|case| draw_case(store, case, &scale))
}

fn draw_case<W: Write>(store: &mut Store<W>, case: &Case, scale: &Scale) -> Result<(), StoreError> {
    let (palette, z) = (palette(Theme::Dark), case.top);
    let (length, radius) = (0.25 * case.reach, 0.17 * case.reach);
    let (mut arrows, mut arcs, mut words) = (Track::new(), Track::new(), Track::new());
    for r in &case.reactions {
        let arrow = r.force * (length / scale.newtons);
        let has_force = arrow.norm() > 0.004 * case.reach;
        arrows.push(r.at, has_force.then(|| (point(r.from, z), point(arrow, 0.0))));
        let sweep = r.moment / scale.newton_metres * FULL;
        let has_moment = sweep.abs() > 0.02 && !r.quiet;
        arcs.push(r.at, has_moment.then(|| arc(r.from, sweep, radius, z)));
        let mut text = format!("f_B {:.2} N\nn_B {} N m", r.force.norm(), signed(r.moment, 2));
        if has_force {
            text += &format!("\narrow {length:.2} m = {} N", scale.newtons);
        }
        if has_moment {
            text += &format!("\narc 135° = {} N m", scale.newton_metres);
        }
        let rgba = if r.quiet { palette.zero } else { palette.reaction };
        words.push(r.at, (point(r.from + Vector::new(0.0, -0.44 * case.reach), z), text, colour(rgba)));
    }
    let red = [colour(palette.reaction)];
    let path = under(&case.root, "reaction/force");
    store.fixed(&path, &Arrows3D::update_fields().with_radii([Radius::new_ui_points(2.0)]).with_colors(red))?;
    let (clock, rows) = arrows.take();
    let shown = || rows.iter().flatten();
    let lengths = rows.iter().map(|r| usize::from(r.is_some()));
    let arrows = Arrows3D::update_fields().with_vectors(shown().map(|r| r.1)).with_origins(shown().map(|r| r.0));
    store.columns(&clock.columns(), &path, arrows.columns(lengths.collect::<Vec<_>>())?)?;

    let path = under(&case.root, "reaction/moment");
    store.fixed(&path, &LineStrips3D::update_fields().with_radii([Radius::new_ui_points(1.8)]).with_colors(red))?;
    let (clock, rows) = arcs.take();
    let lengths = rows.iter().map(|r| usize::from(r.is_some()));
    let arcs = LineStrips3D::new(rows.iter().flatten().cloned());
    store.columns(&clock.columns(), &path, arcs.columns(lengths.collect::<Vec<_>>())?)?;

    let path = under(&case.root, "reaction/words");
    store.fixed(&path, &Points3D::update_fields().with_radii([Radius::ZERO]).with_show_labels(true))?;
    let (clock, rows) = words.take();
    let words = Points3D::update_fields()
        .with_positions(rows.iter().map(|r| r.0))
        .with_labels(rows.iter().map(|r| r.1.as_str()))
        .with_colors(rows.iter().map(|r| r.2));
    store.columns(&clock.columns(), &path, words.columns_of_unit_batches()?)
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
