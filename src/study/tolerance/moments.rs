//! Exact mean and covariance of the constants θ, and the exact derivatives ∂θ/∂δ.
//!
//! θ is a polynomial in the parameters' deviations δ, of degree three at most: m a_k a_l. The parameters are
//! independent, so the expectation of a monomial is a product of moments E[δᵏ].
//!
//! # Symbols
//! | letter | meaning | shape |
//! |---|---|---|
//! | x | vector of the distinct monomials in δ | K |
//! | A | θ − θ(0) = A x | constants × K |
//! | S | Cov(x) | K × K |
//! | Cov θ | A S Aᵀ | constants × constants |

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::constants::{LinkConstants, UncertainNumber, count, coupling, diagonal, first};
use super::parameter::UncertainParameter;

/// Indices of a monomial's parameters, ascending, each repeated as often as its power; [`NONE`] fills the rest.
type Monomial = [u16; 3];

const NONE: u16 = u16::MAX;

/// A polynomial in the deviations.
#[derive(Clone, Debug, Default)]
struct Polynomial(BTreeMap<Monomial, f64>);

impl Polynomial {
    fn of(term: &UncertainNumber) -> Self {
        let mut p = Self::constant(term.nominal);
        p.0.extend(term.parameter.map(|i| ([i as u16, NONE, NONE], 1.0)));
        p
    }

    fn constant(x: f64) -> Self {
        Self([([NONE; 3], x)].into())
    }

    fn add(&mut self, factor: f64, other: &Self) {
        for (monomial, c) in &other.0 {
            *self.0.entry(*monomial).or_default() += factor * c;
        }
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = Self::default();
        for (a, x) in &self.0 {
            for (b, y) in &other.0 {
                let mut all = [a[0], a[1], a[2], b[0], b[1], b[2]];
                all.sort_unstable();
                *product.0.entry([all[0], all[1], all[2]]).or_default() += x * y;
            }
        }
        product
    }
}

/// Returns the expectation of a product of deviations; the indices of the factors are ascending.
fn expectation(factors: &[u16], parameters: &[UncertainParameter]) -> f64 {
    let present = factors.iter().position(|f| *f == NONE).map_or(factors, |end| &factors[..end]);
    present.chunk_by(|a, b| a == b).map(|same| parameters[usize::from(same[0])].moments[same.len()]).product()
}

/// Mean, covariance and derivatives of θ.
#[derive(Clone, Debug)]
pub(super) struct Moments {
    /// E[θ] − θ of the nominal machine.
    pub mean: DVector<f64>,
    /// Cov θ.
    pub covariance: DMatrix<f64>,
    /// ∂θ/∂δ at the nominal machine, constants × parameters.
    pub slope: DMatrix<f64>,
    /// Whether each constant varies.
    pub varies: Vec<bool>,
}

impl Moments {
    pub fn of(n: usize, bodies: &[LinkConstants], parameters: &[UncertainParameter]) -> Self {
        let theta = polynomials(n, bodies);
        let mut monomials: Vec<Monomial> = theta.iter().flat_map(|p| p.0.keys().copied()).collect();
        monomials.sort_unstable();
        monomials.dedup();
        monomials.retain(|m| m[0] != NONE);
        let mean_of: Vec<f64> = monomials.iter().map(|m| expectation(m, parameters)).collect();
        let a = DMatrix::from_fn(theta.len(), monomials.len(), |i, x| {
            theta[i].0.get(&monomials[x]).copied().unwrap_or(0.0)
        });
        let s = DMatrix::from_fn(monomials.len(), monomials.len(), |i, j| {
            let (x, y) = (&monomials[i], &monomials[j]);
            // Monomials without a common parameter are independent.
            if !x.iter().any(|f| *f != NONE && y.contains(f)) {
                return 0.0;
            }
            let mut all = [x[0], x[1], x[2], y[0], y[1], y[2]];
            all.sort_unstable();
            expectation(&all, parameters) - mean_of[i] * mean_of[j]
        });
        let slope = DMatrix::from_fn(theta.len(), parameters.len(), |i, p| {
            theta[i].0.get(&[p as u16, NONE, NONE]).copied().unwrap_or(0.0)
        });
        let varies = (0..theta.len()).map(|i| a.row(i).iter().any(|c| *c != 0.0)).collect();
        Self { mean: &a * DVector::from_vec(mean_of), covariance: &a * s * a.transpose(), slope, varies }
    }
}

/// Returns θ of the bodies that vary, as polynomials.
fn polynomials(n: usize, bodies: &[LinkConstants]) -> Vec<Polynomial> {
    let mut theta = vec![Polynomial::default(); count(n)];
    for body in bodies {
        let [m, spin, u, v] = [&body.mass, &body.inertia, &body.com, &body.com_normal].map(Polynomial::of);
        let mut a: Vec<Polynomial> = body.root.iter().map(|w| Polynomial::constant(*w)).collect();
        for &(p, k, rate) in &body.stretch {
            let deviation = UncertainNumber { nominal: 0.0, parameter: Some(p) };
            a[k].add(rate, &Polynomial::of(&deviation));
        }
        let d = body.drive;
        a[d].add(body.sign, &u);
        let mut off = Polynomial::default();
        off.add(body.sign, &v);
        for (i, &k) in body.on.iter().enumerate() {
            let ma = m.times(&a[k]);
            theta[first(k)].add(1.0, &ma);
            theta[diagonal(n, k)].add(1.0, &ma.times(&a[k]));
            let m_off = m.times(&off);
            if k == d {
                theta[first(k) + 1].add(1.0, &m_off);
                theta[diagonal(n, k)].add(1.0, &m_off.times(&off));
                theta[diagonal(n, k)].add(1.0, &spin);
            }
            for &l in &body.on[i + 1..] {
                let at = coupling(n, k, l);
                theta[at].add(1.0, &ma.times(&a[l]));
                if k == d {
                    theta[at + 1].add(-1.0, &m_off.times(&a[l]));
                } else if l == d {
                    theta[at + 1].add(1.0, &m_off.times(&a[k]));
                }
            }
        }
    }
    theta
}
