//! The planned motion of the end effector: its curve, and the points of the task.

use rerun::{Clear, EntityPath};

use super::dashes::dashed;
use super::store::{Instant, Store, StoreError};
use super::style::{dots, lines, point, under};
use crate::mechanics::planar::Vector;
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::Palette;
use crate::picture::scene::stage::waypoints;
use crate::session::Run;

/// Parts of the curve that is drawn.
const LOOKS: i32 = 256;

/// The planned curve of the end effector while it leads, m.
pub fn points(run: &Run) -> Vec<Vector> {
    let Some(motion) = run.motion() else { return Vec::new() };
    (0..=LOOKS).map(|i| run.place(&motion.path.at(f64::from(i) / f64::from(LOOKS)).q)).collect()
}

/// Writes the plan while it leads, for good or from an instant on, above a machine of a reach and a height, m; clears it
/// where the pointer leads.
///
/// # Errors
/// If it cannot be written.
pub fn show(
    store: &mut Store,
    root: &EntityPath,
    since: Option<Instant>,
    run: &Run,
    [reach, z]: [f64; 2],
    palette: &Palette,
) -> Result<(), StoreError> {
    if run.motion().is_none() {
        return store.shape(since, &under(root, "plan"), &Clear::recursive());
    }
    // A little above the trail, which it would share its place with.
    let over = z + 0.004 * reach;
    let path: Vec<_> = points(run).into_iter().map(|p| point(p, over)).collect();
    let ink = mix(palette.background, palette.ink, 0.75);
    store.shape(since, &under(root, "plan/path"), &lines(dashed(&path, 0.011 * reach as f32), 1.6, ink))?;
    let named = waypoints(run);
    let rings = dots(4.5, palette.ink)
        .with_positions(named.iter().map(|(.., p)| point(*p, over)))
        .with_labels(named.iter().map(|(_, name, _)| name.as_str()))
        .with_show_labels(true);
    store.shape(since, &under(root, "plan/waypoints"), &rings)?;
    let inside = dots(2.9, palette.background)
        .with_positions(named.iter().map(|(.., p)| point(*p, over + 0.003 * reach)))
        .with_show_labels(false);
    store.shape(since, &under(root, "plan/waypoints/inside"), &inside)
}
