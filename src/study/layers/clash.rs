//! [`Clash`]: two solids that meet at the heights that a machine has.

use schemars::JsonSchema;
use serde::Serialize;

use super::contact::Contact;
use stillbase_exchange::solids::has_heights;
use stillbase_mechanics::machine::Machine;

/// Heights closer than this are one, m.
const SAME_HEIGHT: f64 = 1e-9;

/// Number of clashes that are named.
const NAMED: usize = 4;

/// Two solids that meet at the heights that a machine has.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Clash {
    /// Name of the first: a solid of a link.
    pub a: String,
    /// Name of the second: a solid of a link, or a pin.
    pub b: String,
    /// The heights that both take, m, from the lower to the upper one.
    pub heights: [f64; 2],
    /// Angles of the drives in which they overlap in plan, rad.
    pub q: Vec<f64>,
    /// Whether they overlap for certain; else the work could not exclude it.
    pub decided: bool,
}

impl Clash {
    /// Returns the clash of two solids that overlap in plan; `None` if their heights keep them apart.
    fn of(contact: &Contact) -> Option<Self> {
        let [a, b] = contact.faces;
        let heights = [a[0].max(b[0]), a[1].min(b[1])];
        (heights[1] - heights[0] > SAME_HEIGHT).then(|| Self {
            a: contact.a.clone(),
            b: contact.b.clone(),
            heights,
            q: contact.q.clone(),
            decided: contact.decided,
        })
    }

    /// Returns the clashes among solids that overlap in plan; none if the machine states no heights.
    pub fn all(machine: &Machine, contacts: &[Contact]) -> Vec<Self> {
        let own = if has_heights(machine) { contacts } else { &[] };
        own.iter().filter_map(Self::of).collect()
    }

    /// Returns the first clashes in words, one a line, and how many more there are, with lengths in m as `write` gives
    /// them.
    pub fn lines(clashes: &[Self], write: impl Fn(f64) -> String) -> Vec<String> {
        let more = clashes.len().saturating_sub(NAMED);
        let named = clashes.iter().take(NAMED).map(|clash| clash.words(&write));
        named.chain((more > 0).then(|| format!("and {more} more"))).collect()
    }

    /// Returns it in words, with lengths in m as `write` gives them.
    fn words(&self, write: impl Fn(f64) -> String) -> String {
        let verb = if self.decided { "meets" } else { "may meet" };
        let [low, high] = self.heights.map(write);
        format!("{} {verb} {} at heights from {low} to {high}", self.a, self.b)
    }
}
