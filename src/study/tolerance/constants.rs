//! The constants θ that a base wrench is linear in, and how the machine's parameters make them.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | θ | Re g_1, Im g_1, Re g_2 … ; H_11, H_22 … ; Re C_12, Im C_12, Re C_13 … | kg m; kg m² |
//! | a_jk | CM of body j is Σ_k a_jk e(q_k); bodies are the links and the payload | complex, m |
//! | δ | deviations of the parameters | their own |

use super::deviate::CHUNK;
use super::parameter::{Parameter, VariedQuantity};
use crate::mechanics::machine::{Inertia, Machine, MachineError};
use crate::mechanics::planar::{MAX_DRIVES, Vector};

/// How many constants a machine of n drives has.
pub(super) const fn count(n: usize) -> usize {
    n * n + 2 * n
}

/// Where Re g_k stands; Im g_k follows.
pub(super) fn first(k: usize) -> usize {
    2 * k
}

/// Where H_kk stands.
pub(super) fn diagonal(n: usize, k: usize) -> usize {
    2 * n + k
}

/// Where Re C_kl stands, k < l; Im C_kl follows.
pub(super) fn coupling(n: usize, k: usize, l: usize) -> usize {
    // Pairs before those of k, and those of k before l.
    3 * n + 2 * (k * (2 * n - k - 1) / 2 + (l - k - 1))
}

/// The machine of which constant i is 1 and every other 0.
pub(super) fn unit(n: usize, i: usize, like: &Inertia) -> Inertia {
    let mut unit = Inertia::nothing(n, like.motors, like.end_effector);
    let one = |imaginary: bool| if imaginary { Vector::new(0.0, 1.0) } else { Vector::new(1.0, 0.0) };
    if i < 2 * n {
        unit.g[i / 2] = one(i % 2 == 1);
    } else if i < 3 * n {
        unit.spin[i - 2 * n] = 1.0;
    } else if let Some((k, l)) = Inertia::pairs(n).nth((i - 3 * n) / 2) {
        unit.c[k][l] = one((i - 3 * n) % 2 == 1);
        unit.c[l][k] = unit.c[k][l].conj();
    }
    unit
}

/// A number that may vary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Term {
    pub nominal: f64,
    /// Which parameter adds to it.
    pub parameter: Option<usize>,
}

/// A link, or the payload.
#[derive(Clone, Debug)]
pub(super) struct LinkConstants {
    pub drive: usize,
    pub sign: f64,
    pub mass: Term,
    pub inertia: Term,
    pub com: Term,
    pub com_normal: Term,
    /// Where its root is, m.
    pub root: [f64; MAX_DRIVES],
    /// Drives on which the root lies, and the body's own.
    pub on: Vec<usize>,
    /// Lengths that vary: parameter, drive, metres of root per metre of length.
    pub stretch: Vec<(usize, usize, f64)>,
}

/// The bodies that vary in any way.
///
/// # Errors
/// If a length cannot vary alone, because a closure holds it against a number.
pub(super) fn bodies(machine: &Machine, parameters: &[Parameter]) -> Result<Vec<LinkConstants>, MachineError> {
    let spec = machine.spec();
    let find = |quantity| parameters.iter().position(|p| p.quantity == quantity);
    let term = |nominal, quantity| Term { nominal, parameter: find(quantity) };
    let nothing = Term { nominal: 0.0, parameter: None };
    let mut bodies: Vec<LinkConstants> = (spec.links.iter().zip(machine.resolved_links()).enumerate())
        .map(|(j, (link, part))| LinkConstants {
            drive: part.drive,
            sign: part.sign,
            mass: term(link.mass, VariedQuantity::Mass(j)),
            inertia: term(link.inertia, VariedQuantity::Inertia(j)),
            com: term(link.com, VariedQuantity::Com(j)),
            com_normal: term(link.com_normal, VariedQuantity::ComNormal(j)),
            root: part.root,
            on: Vec::new(),
            stretch: Vec::new(),
        })
        .collect();
    bodies.push(LinkConstants {
        drive: machine.resolved_links()[machine.end_link()].drive,
        sign: 1.0,
        mass: term(spec.payload.mass, VariedQuantity::PayloadMass),
        inertia: term(spec.payload.inertia, VariedQuantity::PayloadInertia),
        com: nothing,
        com_normal: nothing,
        root: *machine.end_effector(),
        on: Vec::new(),
        stretch: Vec::new(),
    });
    // Counterweights vary in nothing but where their link is.
    let carrier = |link: &str| spec.links.iter().position(|l| l.name == link);
    let carriers: Vec<usize> = spec.counterweights.iter().filter_map(|weight| carrier(&weight.link)).collect();
    bodies.extend(spec.counterweights.iter().zip(&carriers).map(|(weight, j)| {
        let (part, fixed) = (&machine.resolved_links()[*j], |nominal| Term { nominal, parameter: None });
        LinkConstants {
            drive: part.drive,
            sign: part.sign,
            mass: fixed(weight.mass),
            inertia: fixed(weight.inertia()),
            com: fixed(weight.at),
            com_normal: nothing,
            root: part.root,
            on: Vec::new(),
            stretch: Vec::new(),
        }
    }));
    for (p, parameter) in parameters.iter().enumerate() {
        if !matches!(parameter.quantity, VariedQuantity::Length(_)) {
            continue;
        }
        // A root is affine in every length, so a length twice as long shows how, to rounding.
        let longer = parameter.changed(machine, 2.0 * parameter.nominal)?;
        let parts = longer.resolved_links();
        let roots = parts.iter().map(|part| &part.root).chain([longer.end_effector()]);
        let roots = roots.chain(carriers.iter().map(|j| &parts[*j].root));
        for (body, root) in bodies.iter_mut().zip(roots) {
            for (k, (far, near)) in root.iter().zip(&body.root).enumerate() {
                // Whole bars, forwards or backwards: nothing is lost by rounding the quotient, but its noise.
                let rate = (far - near) / parameter.nominal;
                let rate = if (rate - rate.round()).abs() < 1e-6 { rate.round() } else { rate };
                if rate != 0.0 {
                    body.stretch.push((p, k, rate));
                }
            }
        }
    }
    let varies = |body: &LinkConstants| {
        let terms = [body.mass, body.inertia, body.com, body.com_normal];
        let moved = !body.stretch.is_empty() && (body.mass.nominal != 0.0 || body.mass.parameter.is_some());
        moved || terms.iter().any(|t| t.parameter.is_some())
    };
    bodies.retain(varies);
    for body in &mut bodies {
        let on =
            |k: &usize| *k == body.drive || body.root[*k] != 0.0 || body.stretch.iter().any(|(_, drive, _)| drive == k);
        body.on = (0..machine.drives()).filter(on).collect();
    }
    Ok(bodies)
}

/// Machines side by side: as many as fill four vectors of the least x86-64.
pub(super) const LANES: usize = 8;

/// One number of each of these machines.
pub(super) type Lanes = [f64; LANES];

#[inline(always)]
fn each(f: impl Fn(usize) -> f64) -> Lanes {
    std::array::from_fn(f)
}

/// θ of the bodies that vary, of one block of machines, into `theta`; `deviations` by parameter, then by machine.
#[inline]
pub(super) fn evaluate(
    n: usize,
    bodies: &[LinkConstants],
    deviations: &[[f64; CHUNK]],
    block: usize,
    theta: &mut [Lanes],
) {
    theta.iter_mut().for_each(|t| *t = [0.0; LANES]);
    let delta = |p: usize| -> &Lanes { &deviations[p].as_chunks().0[block] };
    let of = |term: &Term| match term.parameter {
        Some(p) => {
            let delta = delta(p);
            each(|w| term.nominal + delta[w])
        }
        None => [term.nominal; LANES],
    };
    for body in bodies {
        let (m, spin, u, v) = (of(&body.mass), of(&body.inertia), of(&body.com), of(&body.com_normal));
        let mut a = [[0.0; LANES]; MAX_DRIVES];
        for &k in &body.on {
            a[k] = [body.root[k]; LANES];
        }
        for &(p, k, rate) in &body.stretch {
            let delta = delta(p);
            a[k] = each(|w| a[k][w] + rate * delta[w]);
        }
        let d = body.drive;
        a[d] = each(|w| a[d][w] + body.sign * u[w]);
        let off = each(|w| body.sign * v[w]);
        for (i, &k) in body.on.iter().enumerate() {
            let mut add = |i: usize, f: &dyn Fn(usize) -> f64| {
                let sum = &mut theta[i];
                (0..LANES).for_each(|w| sum[w] += f(w));
            };
            add(first(k), &|w| m[w] * a[k][w]);
            if k == d {
                add(first(k) + 1, &|w| m[w] * off[w]);
                add(diagonal(n, k), &|w| m[w] * (a[k][w] * a[k][w] + off[w] * off[w]) + spin[w]);
            } else {
                add(diagonal(n, k), &|w| m[w] * (a[k][w] * a[k][w]));
            }
            for &l in &body.on[i + 1..] {
                let at = coupling(n, k, l);
                add(at, &|w| m[w] * (a[k][w] * a[l][w]));
                // Im of conj(a_k) a_l: the body's own drive is the one with a part off its axis.
                if k == d {
                    add(at + 1, &|w| -m[w] * (off[w] * a[l][w]));
                } else if l == d {
                    add(at + 1, &|w| m[w] * (a[k][w] * off[w]));
                }
            }
        }
    }
}
