//! [`Way`]: one way to look for counterweights.

use super::asked::Weighing;
use super::cell::Cell;
use super::refusal::Kind;
use super::room::Room;

/// Whether (7) and (8) hold, or how near they come over a range of payloads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Balance {
    /// They hold.
    Exact,
    /// Their worst residual is to be least, and nothing else.
    Nearest,
    /// It is no more than this, kg m.
    Within(f64),
}

/// One way to look for counterweights: the room between pins that each site has to stay in, if known, and how near balance
/// comes. A bound on the objective is set where the least added mass and Σ H_kk are sought among its optima.
#[derive(Clone, Debug)]
pub(super) struct Way {
    pub rooms: Vec<Option<Room>>,
    pub balance: Balance,
    pub most: Option<f64>,
    /// Bounds that are not there.
    pub loose: Vec<Kind>,
    /// A kind of bound that is to be least instead of the objective.
    pub least: Option<Kind>,
    /// Within what each counterweight is sought, where momenta below zero count.
    pub cells: Vec<Cell>,
    /// Masses, kg, and places, m, about which inertias are taken to be linear where they take from momenta below zero:
    /// then these come out no nearer to zero than they are.
    pub tangents: Option<Vec<[f64; 2]>>,
}

impl Way {
    /// Past all pins.
    pub fn free(asked: &Weighing, balance: Balance) -> Self {
        Self {
            rooms: vec![None; asked.sites.len()],
            balance,
            most: None,
            loose: Vec::new(),
            least: None,
            cells: asked.sites.iter().map(|site| Cell::of(asked, site)).collect(),
            tangents: None,
        }
    }
}
