//! [`Unknowns`]: where the unknowns of the cone program stand, and what D_k and H_kk are as sums of them.

use super::asked::{Free, Weighing};
use super::problem::Problem;
use crate::mechanics::machine::Machine;

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

impl Problem {
    /// How a free rotor turns with drive k for one turn of the drive that it is of: what its ratio N adds to, and N's
    /// factor.
    fn rates(&self, drive: usize, k: usize) -> [f64; 2] {
        match self.bare.motors().on(drive) {
            _ if k == drive => [0.0, 1.0],
            Some(on) if k == on => [1.0, -1.0],
            _ => [0.0, 0.0],
        }
    }

    /// What free rotors bring to D_k and to H_kk.
    pub fn of_rotors(&self, asked: &Weighing, machine: &Machine, k: usize) -> [Sum; 2] {
        let unknowns = Unknowns::of(asked, self.drives());
        let mut sums = [(); 2].map(|()| Sum { terms: Vec::new(), constant: 0.0 });
        for (i, rotor) in asked.rotors.iter().enumerate() {
            let [plain, by_ratio] = self.rates(rotor.drive, k);
            let present = machine.spec().drives[rotor.drive].rotor.unwrap_or_default();
            let (x, turned, inertia) = (unknowns.rotor(i), unknowns.turned(i), present.inertia);
            match rotor.free {
                Free::Inertia(_) => {
                    let rate = plain + by_ratio * present.ratio;
                    sums[0].terms.push((x, rate));
                    sums[1].terms.push((x, rate * rate));
                }
                Free::Ratio(_) => {
                    sums[0].terms.push((x, by_ratio * inertia));
                    sums[0].constant += plain * inertia;
                    sums[1].terms.extend([(x, 2.0 * plain * by_ratio * inertia), (turned, by_ratio * by_ratio)]);
                    sums[1].constant += plain * plain * inertia;
                }
            }
        }
        sums
    }

    /// D_k but for what counterweights add to the diagonal of H, and for free rotors.
    pub fn constant(&self, k: usize) -> f64 {
        self.inertia.momentum(k) - self.inertia.diagonal(k)
    }

    /// No more than H_kk but for free rotors: that of masses and places near those given, where it is the same.
    pub fn linear_diagonal(&self, asked: &Weighing, unknowns: &Unknowns, k: usize, tangents: &[[f64; 2]]) -> Sum {
        let parts = self.bare.resolved_links();
        let mut sum = Sum { terms: Vec::new(), constant: self.inertia.diagonal(k) };
        for (j, (site, [mass, at])) in asked.sites.iter().zip(tangents).enumerate() {
            let (part, own) = (&parts[site.link], asked.disc.own());
            let (root, (w, s)) = (part.root[k], (unknowns.w(j), unknowns.s(j)));
            sum.terms.push((w, root * root));
            if part.drive == k {
                sum.terms.push((s, 2.0 * part.sign * root + 2.0 * at));
                sum.terms.push((w, 2.0 * own * mass - at * at));
                sum.constant -= own * mass * mass;
            }
        }
        sum
    }
}
