//! [`Unknowns`]: where the unknowns of the cone program stand.

use super::asked::Weighing;

/// Where the unknowns stand: w and s of each site, what its inertia needs if that counts, H_kk of each drive but for
/// free rotors, two of each free rotor, |D_k| of each drive if it counts, and the greatest torque.
#[derive(Clone, Copy)]
pub(super) struct Unknowns {
    sites: usize,
    /// Whether the inertia counts.
    pub inertia: bool,
    drives: usize,
    rotors: usize,
    /// Whether |D_k| counts.
    pub momentum: bool,
}

impl Unknowns {
    pub fn of(asked: &Weighing, drives: usize) -> Self {
        let inertia = asked.objective.turns() || asked.most_inertia.is_some();
        let (rotors, momentum) = (asked.rotors.len(), asked.objective.momentum > 0.0);
        Self { sites: asked.sites.len(), inertia, drives, rotors, momentum }
    }

    pub fn w(self, j: usize) -> usize {
        2 * j
    }

    pub fn s(self, j: usize) -> usize {
        2 * j + 1
    }

    /// At least s²/w.
    pub fn u(self, j: usize) -> usize {
        2 * (self.sites + j)
    }

    /// At least the disc's own inertia.
    pub fn v(self, j: usize) -> usize {
        2 * (self.sites + j) + 1
    }

    pub fn h(self, k: usize) -> usize {
        4 * self.sites + k
    }

    /// Inertia or ratio of a free rotor.
    pub fn rotor(self, i: usize) -> usize {
        let before = if self.inertia { 4 * self.sites + self.drives } else { 2 * self.sites };
        before + 2 * i
    }

    /// At least J N² of one whose ratio is free.
    pub fn turned(self, i: usize) -> usize {
        self.rotor(i) + 1
    }

    /// At least |D_k|.
    pub fn momentum(self, k: usize) -> usize {
        self.rotor(self.rotors) + k
    }

    pub fn torque(self) -> usize {
        if self.momentum { self.momentum(self.drives) } else { self.rotor(self.rotors) }
    }
}

/// Linear in the unknowns.
pub(super) struct Sum {
    pub terms: Vec<(usize, f64)>,
    pub constant: f64,
}
