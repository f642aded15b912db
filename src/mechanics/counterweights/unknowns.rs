//! [`UnknownIndices`]: indices of the unknowns of the cone program, and D_k and H_kk as affine functions of them.

use super::cell::DiscPlace;
use super::problem::CounterweightProblem;
use super::spec::{CounterweightSpec, RotorFreedom};

/// Indices of the unknowns, in this order, in the units of the machine:
///
/// - w and s of each site, and t if a counterweight may lie off its link's axis;
/// - if the objective or a bound depends on inertia: u and v of each site, and H_kk of each drive without the share
///   of free rotors;
/// - two for each free rotor;
/// - if the objective contains |D_k|: |D_k| of each drive;
/// - the greatest torque.
#[derive(Clone, Copy)]
pub(super) struct UnknownIndices {
    sites: usize,
    /// Whether a counterweight may lie off its link's axis.
    across: bool,
    /// Whether the objective or a bound depends on inertia.
    pub inertia: bool,
    drives: usize,
    rotors: usize,
    /// Whether the objective contains |D_k|.
    pub momentum: bool,
}

impl UnknownIndices {
    pub fn of(request: &CounterweightSpec, drives: usize) -> Self {
        let inertia = request.objective.depends_on_inertia() || request.max_inertia.is_some();
        let (rotors, momentum) = (request.rotors.len(), request.objective.momentum > 0.0);
        let across = request.sites.iter().any(|site| site.across > 0.0);
        Self { sites: request.sites.len(), across, inertia, drives, rotors, momentum }
    }

    /// Number of unknowns of a site that enter the balance conditions.
    fn per_site(self) -> usize {
        2 + usize::from(self.across)
    }

    pub fn w(self, j: usize) -> usize {
        self.per_site() * j
    }

    pub fn s(self, j: usize) -> usize {
        self.per_site() * j + 1
    }

    /// Index of t = w y, if a counterweight may lie off its link's axis.
    pub fn t(self, j: usize) -> Option<usize> {
        self.across.then(|| self.per_site() * j + 2)
    }

    /// Index of u ≥ (s² + t²)/w, the inertia from the position of the disc, kg m².
    pub fn u(self, j: usize) -> usize {
        self.per_site() * self.sites + 2 * j
    }

    /// Index of v, an upper bound of the disc's own inertia, kg m².
    pub fn v(self, j: usize) -> usize {
        self.u(j) + 1
    }

    pub fn h(self, k: usize) -> usize {
        self.u(self.sites) + k
    }

    /// Index of the inertia or ratio of a free rotor.
    pub fn rotor(self, i: usize) -> usize {
        let before = if self.inertia { self.h(self.drives) } else { self.w(self.sites) };
        before + 2 * i
    }

    /// Index of an upper bound of J N² of a rotor with free ratio N. The unknown is 0 if the inertia is free instead.
    pub fn turned(self, i: usize) -> usize {
        self.rotor(i) + 1
    }

    /// Index of an upper bound of |D_k|.
    pub fn momentum(self, k: usize) -> usize {
        self.rotor(self.rotors) + k
    }

    pub fn torque(self) -> usize {
        if self.momentum { self.momentum(self.drives) } else { self.rotor(self.rotors) }
    }
}

/// An affine function of the unknowns.
pub(super) struct AffineForm {
    pub terms: Vec<(usize, f64)>,
    pub constant: f64,
}

impl CounterweightProblem {
    /// Returns a and b of the rate ratio r_k = a + b N of a rotor on `drive` with gear ratio N.
    fn rates(&self, drive: usize, k: usize) -> [f64; 2] {
        match self.stator(drive) {
            _ if k == drive => [0.0, 1.0],
            Some(on) if k == on => [1.0, -1.0],
            _ => [0.0, 0.0],
        }
    }

    /// Returns the contributions of free rotors to D_k and to H_kk.
    pub fn of_rotors(&self, request: &CounterweightSpec, k: usize) -> [AffineForm; 2] {
        let unknowns = UnknownIndices::of(request, self.drives());
        let mut sums = [(); 2].map(|()| AffineForm { terms: Vec::new(), constant: 0.0 });
        for (i, rotor) in request.rotors.iter().enumerate() {
            let [plain, by_ratio] = self.rates(rotor.drive, k);
            let (x, turned) = (unknowns.rotor(i), unknowns.turned(i));
            let (ratio, inertia) = (self.rotors[rotor.drive].ratio, self.rotor_inertia(rotor.drive));
            let of_ratio = by_ratio * inertia * self.ratio_units[i];
            match rotor.parameter {
                RotorFreedom::Inertia(_) => {
                    let rate = plain + by_ratio * ratio;
                    sums[0].terms.push((x, rate));
                    sums[1].terms.push((x, rate * rate));
                }
                RotorFreedom::Ratio(_) => {
                    sums[0].terms.push((x, of_ratio));
                    sums[0].constant += plain * inertia;
                    sums[1].terms.extend([(x, 2.0 * plain * of_ratio), (turned, by_ratio * by_ratio)]);
                    sums[1].constant += plain * plain * inertia;
                }
            }
        }
        sums
    }

    /// Returns an affine lower bound of H_kk without free rotors, tangent at `tangents`.
    pub fn linear_diagonal(
        &self,
        request: &CounterweightSpec,
        unknowns: &UnknownIndices,
        k: usize,
        tangents: &[DiscPlace],
    ) -> AffineForm {
        let mut sum = AffineForm { terms: Vec::new(), constant: self.diagonal(k) };
        for (j, (site, tangent)) in request.sites.iter().zip(tangents).enumerate() {
            let DiscPlace { mass, at, across } = *tangent;
            let (part, own) = (&self.parts[site.link], request.stock.own_slope(mass));
            let (root, (w, s)) = (part.root[k], (unknowns.w(j), unknowns.s(j)));
            sum.terms.push((w, root * root));
            if part.drive == k {
                sum.terms.push((s, 2.0 * part.sign * root + 2.0 * at));
                sum.terms.extend(unknowns.t(j).map(|t| (t, 2.0 * across)));
                sum.terms.push((w, own - at * at - across * across));
                sum.constant += request.stock.own(mass) - own * mass;
            }
        }
        sum
    }
}
