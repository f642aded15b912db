//! Checks that a part has the lengths of its shape, and returns it as a body without holes.

use stillbase_settings::number::ShortNumber;

use super::super::error::{KeyPath, MachineError};
use super::body::PlaneBody;
use super::part::{Ends, Part, Shape};
use super::polygon;

/// Least area of a plate, as a fraction of the area of the rectangle around it.
const LEAST_FILLED: f64 = 1e-9;

/// A part whose lengths are known, m, with the places where it begins and ends along the link, m.
pub(super) struct Section<'a> {
    pub part: &'a Part,
    pub from: f64,
    pub to: f64,
    /// Returns the place of one of its keys.
    pub place: &'a dyn Fn(&str) -> KeyPath,
}

impl Section<'_> {
    fn refuse<T>(&self, key: &str, why: impl Into<String>) -> Result<T, MachineError> {
        Err(MachineError::Part { place: (self.place)(key), why: why.into() })
    }

    /// Checks that what the part states is what its shape has.
    fn check_keys(&self) -> Result<(), MachineError> {
        let Part { shape, ends, polygon, holes, .. } = self.part;
        let (is, has) = (shape.words(), shape.lengths());
        let all = if *shape == Shape::Plate { "polygon, thickness".into() } else { has.join(", ") };
        for (key, given) in self.part.lengths() {
            match (has.contains(&key), given) {
                (true, None) => return self.refuse(key, format!("{is} has a {key}: want {all}, in m")),
                (false, Some(_)) => return self.refuse(key, format!("{is} has no {key}: want {all}")),
                _ => {}
            }
        }
        let is_plate = *shape == Shape::Plate;
        if is_plate != (polygon.len() >= 3) {
            let why = match is_plate {
                true => "a plate has at least three corners: want [[along, across], …] in m, in the order around it",
                false => "only a plate has corners: want shape = \"plate\"",
            };
            return self.refuse("polygon", if is_plate || !polygon.is_empty() { why } else { return Ok(()) });
        }
        if *shape != Shape::Flat && ends.is_some() {
            return self.refuse("ends", format!("{is} has no ends to choose: want shape = \"flat\""));
        }
        if is_plate && !self.part.has_usual_places() {
            return self.refuse("from", "a plate lies where its polygon says: want neither from nor to");
        }
        if !matches!(shape, Shape::Flat | Shape::Plate) && !holes.is_empty() {
            return self.refuse("holes", format!("{is} has no holes: want a flat bar or a plate for these"));
        }
        Ok(())
    }

    /// Returns the part as a body of density 1, without its holes.
    pub fn body(&self) -> Result<PlaneBody, MachineError> {
        self.check_keys()?;
        let part = self.part;
        let length = (self.to - self.from).abs();
        let [width, thickness, diameter, height, wall] = part.lengths().map(|(_, given)| given.unwrap_or_default());
        let may_vanish = part.shape == Shape::Plate || (part.shape == Shape::Flat && part.ends != Some(Ends::Square));
        if length <= 0.0 && !may_vanish {
            return self.refuse("to", "the bar begins and ends in one place: want another place for to");
        }
        let side = match part.shape {
            Shape::Tube => diameter,
            _ => width.min(height),
        };
        if matches!(part.shape, Shape::Tube | Shape::Profile) && wall > 0.5 * side {
            let why = format!(
                "{} m is more than half of {}, {} m: want a wall of at most {} m",
                ShortNumber(wall),
                if part.shape == Shape::Tube { "the diameter" } else { "the lesser of width and height" },
                ShortNumber(side),
                ShortNumber(0.5 * side)
            );
            return self.refuse("wall", why);
        }
        let body = match part.shape {
            Shape::Flat if part.ends == Some(Ends::Square) => PlaneBody::rectangle(length, width).times(thickness),
            Shape::Flat => PlaneBody::stadium(length, width).times(thickness),
            Shape::Tube => PlaneBody::tube(length, diameter, wall),
            Shape::Profile => PlaneBody::profile(length, width, height, wall),
            Shape::Plate => return Ok(self.plate()?.times(thickness).moved(0.0, part.across)),
        };
        Ok(body.moved(0.5 * (self.from + self.to), part.across))
    }

    fn plate(&self) -> Result<PlaneBody, MachineError> {
        let corners = &self.part.polygon;
        let after = |i: usize| (i + 1) % corners.len();
        if let Some(i) = (0..corners.len()).find(|i| corners[*i] == corners[after(*i)]) {
            let [one, other] = [i.min(after(i)) + 1, i.max(after(i)) + 1];
            let why = format!("its corners {one} and {other} are one point: want each corner once");
            return self.refuse("polygon", why);
        }
        if let Some((one, other)) = polygon::crossing(corners) {
            let why = format!("its sides {one} and {other} meet: want the corners in the order around the plate");
            return self.refuse("polygon", why);
        }
        let body = polygon::body(corners);
        let extent = [0, 1].map(|i| {
            let ends = corners.iter().map(|corner| corner[i]);
            ends.clone().fold(f64::NEG_INFINITY, f64::max) - ends.fold(f64::INFINITY, f64::min)
        });
        // Corners on one line, or so near to it that the formulas lose all digits.
        if body.mass <= LEAST_FILLED * extent[0] * extent[1] {
            return self.refuse("polygon", "its corners lie on one line: want a plate with an area");
        }
        Ok(body)
    }

    /// Returns how far inside the outline a point lies, m; below 0 outside. The point is given along the link and to
    /// the left of the part's line, m.
    pub fn depth(&self, point: [f64; 2]) -> f64 {
        self.part.depth(point, [self.from, self.to])
    }
}

impl Part {
    /// Returns how far inside its outline a point lies, m; below 0 outside. The point is given along the link and to
    /// the left of the part's line, m; `ends` are the places where a bar begins and ends, m.
    pub(super) fn depth(&self, point: [f64; 2], ends: [f64; 2]) -> f64 {
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let half = 0.5 * self.breadth().unwrap_or_default();
        match (self.shape, self.ends.unwrap_or_default()) {
            (Shape::Plate, _) => polygon::depth(&self.polygon, point),
            (Shape::Flat, Ends::Round) => half - polygon::distance([low, 0.0], [high, 0.0], point),
            _ => (half - point[1].abs()).min(point[0] - low).min(high - point[0]),
        }
    }
}
