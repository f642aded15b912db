//! Holes: checks that each lies inside its part and apart from the others.

use stillbase_settings::number::ShortNumber;

use super::super::error::{KeyPath, MachineError};
use super::body::PlaneBody;
use super::section::Section;

/// Tolerance of the distance of a hole from an edge or another hole, as a fraction of its diameter.
const TOLERANCE: f64 = 1e-9;

/// A hole: the place of its centre along the link and to the left of the part's line, and its diameter, m.
pub(super) struct PlacedHole {
    pub centre: [f64; 2],
    pub diameter: f64,
}

impl PlacedHole {
    /// Returns the hole as a body of density 1.
    pub fn body(&self, across: f64) -> PlaneBody {
        PlaneBody::disc(0.5 * self.diameter).moved(self.centre[0], self.centre[1] + across)
    }
}

/// Checks the holes of a part; `place` returns the place of the i-th.
pub(super) fn check(
    section: &Section,
    holes: &[PlacedHole],
    place: &dyn Fn(usize) -> KeyPath,
) -> Result<(), MachineError> {
    // Rounded up to a thousandth, but not by rounding errors.
    let mm = |length: f64| ShortNumber((1e6 * length - 1e-3).ceil() / 1e3).to_string();
    for (i, hole) in holes.iter().enumerate() {
        let beyond = 0.5 * hole.diameter - section.depth(hole.centre);
        if beyond > TOLERANCE * hole.diameter {
            let (by, thick) = (mm(beyond), mm(hole.diameter));
            let why = format!("the hole of {thick} mm reaches {by} mm beyond the part: want it farther in, or smaller");
            return Err(MachineError::Part { place: place(i), why });
        }
        for (j, other) in holes[..i].iter().enumerate() {
            let apart = (hole.centre[0] - other.centre[0]).hypot(hole.centre[1] - other.centre[1]);
            if apart < 0.5 * (hole.diameter + other.diameter) - TOLERANCE * hole.diameter {
                let why = format!("it cuts into hole {}: want holes that lie apart", j + 1);
                return Err(MachineError::Part { place: place(i), why });
            }
        }
    }
    Ok(())
}
