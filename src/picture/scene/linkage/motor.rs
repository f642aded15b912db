//! [`Motor`]: the drives, on the base or on the links that carry them.

use super::heights::Heights;
use super::{DRIVE_RADIUS, Disc};
use crate::scene::{Mesh, Name};
use stillbase_mechanics::machine::{Chain, Machine, ResolvedLink};

/// A drive.
#[derive(Clone, Debug)]
pub struct Motor {
    pub name: Name,
    pub disc: Disc,
    pub drive: usize,
    /// The pin about which it turns its link; `None` if it is mounted on the base.
    pub at: Option<Chain>,
    /// Height of its lower face, m.
    pub z: f64,
}

/// Height of the drives as a fraction of the reach.
pub const DRIVE_HEIGHT: f64 = 0.05;
/// Height of the body of a drive, as a fraction of the room that it takes.
const BODY_SHARE: f64 = 0.92;

/// Returns the drives of a machine of a reach, m; `faces` are the heights of the lower and the upper face of the bar of
/// each link, m.
pub fn motors(
    machine: &Machine,
    (heights, faces): (&Heights, &[[f64; 2]]),
    reach: f64,
    meshes: &mut Vec<Mesh>,
) -> Vec<Motor> {
    let (height, radius, gap) = (DRIVE_HEIGHT * reach, DRIVE_RADIUS * reach, heights.gap);
    let mut on_base = 0;
    let motor = |k: usize| {
        let at = joint_of(machine, k);
        let size = match at {
            Some(_) => 0.75,
            None => 1.0 + 0.12 * f64::from(on_base),
        };
        let (body, below) = match at {
            // The motor is below the link that carries it; of a machine with heights it ends at the base plate.
            Some(_) => {
                let face = carrier(machine, k).map_or(0.0, |link| faces[link][0]);
                let room = if heights.lowest.is_some() { face.max(gap) } else { f64::INFINITY };
                let body = room.min(BODY_SHARE * height);
                (body, face - body)
            }
            None => {
                on_base += 1;
                (BODY_SHARE * height, -f64::from(on_base) * height)
            }
        };
        let disc = Disc::of(meshes, size * radius, body, 0.1 * height);
        let on = if at.is_some() { "machine" } else { "machine/base" };
        Motor { name: format!("{on}/drive/{}", k + 1).into(), disc, drive: k, at, z: below - gap }
    };
    (0..machine.drives()).map(motor).collect()
}

/// Returns the link that carries motor k.
fn carrier(machine: &Machine, k: usize) -> Option<usize> {
    let (parts, on) = (machine.resolved_links(), machine.motors().on(k)?);
    let turned = parts.iter().filter(|part| part.drive == k);
    let carrier = turned.filter_map(|part| part.parent).find(|parent| parts[*parent].drive == on);
    // A motor without such a link is drawn below the first link of its carrier.
    carrier.or_else(|| parts.iter().position(|part| part.drive == on))
}

/// Returns the pin of motor k, if the motor is mounted on a link of another drive.
fn joint_of(machine: &Machine, k: usize) -> Option<Chain> {
    let (parts, on) = (machine.resolved_links(), machine.motors().on(k)?);
    let on_its_drive = |part: &&ResolvedLink| part.parent.is_some_and(|parent| parts[parent].drive == on);
    parts.iter().filter(|part| part.drive == k).find(on_its_drive).map(|part| part.root)
}
