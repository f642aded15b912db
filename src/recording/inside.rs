//! What runs inside a workspace: folds with their cusps, limits that some pose meets there, change points.

use rerun::{AsComponents, Clear, EntityPath};

use super::dashes::dashed;
use super::store::{Instant, Store, StoreError};
use super::style::{dots, lines, point, under};
use crate::mechanics::planar::Vector;
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::Palette;
use crate::planning::pose_constant::Planes;
use crate::planning::reactionless::Line;

/// Writes what there is, for good or from an instant on, under a workspace, before it is turned; `[reach, z]` in m.
///
/// # Errors
/// If it cannot be written.
pub fn show(
    store: &mut Store,
    workspace: &EntityPath,
    since: Option<Instant>,
    planes: &Planes,
    [reach, z]: [f64; 2],
    palette: &Palette,
) -> Result<(), StoreError> {
    let boundary = planes.boundary();
    let drawn = |line: &Line| -> Vec<[f32; 3]> {
        line.turned(0.0).into_iter().map(|[x, y]| point(Vector::new(x, y), z)).collect()
    };
    let amber = |share| mix(palette.background, palette.amber, share);
    let folds: Vec<_> = boundary.fold_curves().iter().map(drawn).collect();
    let limits: Vec<_> = boundary.inner_limits().iter().map(drawn).collect();
    let changes = boundary.change_curves();
    let dash = 0.011 * reach as f32;
    let changes: Vec<_> = changes.iter().flat_map(|curve| dashed(&drawn(&curve.line), dash)).collect();
    let cusps: Vec<_> = boundary.cusps().iter().map(|vertex| point(vertex.at, z)).collect();
    let grey = mix(palette.background, palette.dim, 0.8);
    let kinds: [(&str, bool, &dyn AsComponents); 4] = [
        ("folds", folds.is_empty(), &lines(folds, 1.2, palette.amber)),
        ("inner_limits", limits.is_empty(), &lines(limits, 1.2, amber(0.55))),
        ("change_points", changes.is_empty(), &lines(changes, 1.2, grey)),
        ("cusps", cusps.is_empty(), &dots(2.5, palette.amber).with_positions(cusps)),
    ];
    for (name, none, shape) in kinds {
        match (none, since) {
            (false, _) => store.shape(since, &under(workspace, name), shape)?,
            // There may have been some of another machine.
            (true, Some(at)) if at.step > 0 => store.shape(since, &under(workspace, name), &Clear::flat())?,
            (true, _) => {}
        }
    }
    Ok(())
}
