//! The constants θ in which the base wrench is linear, as functions of the machine's parameters.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | θ | Re g_1, Im g_1, Re g_2 … ; H_11, H_22 … ; Re C_12, Im C_12, Re C_13 … | kg m; kg m² |
//! | a_jk | coefficients of the centre of mass Σ_k a_jk e(q_k) of body j (link, payload, counterweight) | complex, m |
//! | δ | deviations of the parameters | unit of the parameter |

use super::deviate::CHUNK;
use super::parameter::{UncertainParameter, VariedQuantity};
use stillbase_mechanics::machine::{Inertia, Machine, MachineError};
use stillbase_mechanics::planar::{MAX_DRIVES, Vector};

/// Returns the number of constants of a machine with n drives.
pub(super) const fn count(n: usize) -> usize {
    n * n + 2 * n
}

/// Returns the index of Re g_k; Im g_k follows.
pub(super) fn first(k: usize) -> usize {
    2 * k
}

/// Returns the index of H_kk.
pub(super) fn diagonal(n: usize, k: usize) -> usize {
    2 * n + k
}

/// Returns the index of Re C_kl, k < l; Im C_kl follows.
pub(super) fn coupling(n: usize, k: usize, l: usize) -> usize {
    // The pairs before (k, l): those whose first drive precedes k, and (k, m) with m < l.
    3 * n + 2 * (k * (2 * n - k - 1) / 2 + (l - k - 1))
}

/// Returns the inertia with constant i equal to 1 and all others 0.
pub(super) fn unit(n: usize, i: usize, like: &Inertia) -> Inertia {
    let mut unit = Inertia::massless(n, like.motors, like.end_effector);
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
pub(super) struct UncertainNumber {
    pub nominal: f64,
    /// Index of the parameter whose deviation is added; `None` if the number is fixed.
    pub parameter: Option<usize>,
}

/// A link, the payload or a counterweight.
#[derive(Clone, Debug)]
pub(super) struct LinkConstants {
    pub drive: usize,
    pub sign: f64,
    pub mass: UncertainNumber,
    pub inertia: UncertainNumber,
    pub com: UncertainNumber,
    pub com_normal: UncertainNumber,
    /// Coefficients of the root's position, m.
    pub root: [f64; MAX_DRIVES],
    /// Drives that the position depends on, including the body's own.
    pub on: Vec<usize>,
    /// Lengths that vary: indices of parameter and drive, and change of the root's coefficient per change of length.
    pub stretch: Vec<(usize, usize, f64)>,
}

/// Returns the bodies that some parameter affects.
///
/// # Errors
/// Fails if a length cannot vary alone, because a closure of a loop fixes it.
pub(super) fn bodies(machine: &Machine, parameters: &[UncertainParameter]) -> Result<Vec<LinkConstants>, MachineError> {
    let spec = machine.spec();
    let find = |quantity| parameters.iter().position(|p| p.quantity == quantity);
    let term = |nominal, quantity| UncertainNumber { nominal, parameter: find(quantity) };
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
    let (end, [along, left]) = (&machine.resolved_links()[machine.end_link()], spec.payload.offset);
    let fixed = |nominal| UncertainNumber { nominal, parameter: None };
    bodies.push(LinkConstants {
        drive: end.drive,
        sign: end.sign,
        mass: term(spec.payload.mass, VariedQuantity::PayloadMass),
        inertia: term(spec.payload.inertia, VariedQuantity::PayloadInertia),
        com: fixed(along),
        com_normal: fixed(left),
        root: *machine.end_effector(),
        on: Vec::new(),
        stretch: Vec::new(),
    });
    // Counterweights have no parameters of their own: only the position of their link varies.
    let carriers: Vec<usize> = spec.counterweights.iter().filter_map(|weight| spec.link_index(&weight.link)).collect();
    bodies.extend(spec.counterweights.iter().zip(&carriers).map(|(weight, j)| {
        let part = &machine.resolved_links()[*j];
        LinkConstants {
            drive: part.drive,
            sign: part.sign,
            mass: fixed(weight.mass),
            inertia: fixed(weight.inertia()),
            com: fixed(weight.at),
            com_normal: fixed(weight.across),
            root: part.root,
            on: Vec::new(),
            stretch: Vec::new(),
        }
    }));
    for (p, parameter) in parameters.iter().enumerate() {
        if !matches!(parameter.quantity, VariedQuantity::Length(_)) {
            continue;
        }
        // The coefficients of a root are affine in every length, so doubling a length gives the slope up to rounding.
        let longer = parameter.changed(machine, 2.0 * parameter.nominal)?;
        let parts = longer.resolved_links();
        let roots = parts.iter().map(|part| &part.root).chain([longer.end_effector()]);
        let roots = roots.chain(carriers.iter().map(|j| &parts[*j].root));
        for (body, root) in bodies.iter_mut().zip(roots) {
            for (k, (far, near)) in root.iter().zip(&body.root).enumerate() {
                // The slope is the number of times that the length occurs, an integer: rounding it removes noise only.
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

/// Number of machines evaluated together: they fill four 128-bit vectors of baseline x86-64.
pub(super) const BLOCK_MACHINES: usize = 8;

/// One value for each machine of a block.
pub(super) type Lanes = [f64; BLOCK_MACHINES];

#[inline(always)]
fn each(f: impl Fn(usize) -> f64) -> Lanes {
    std::array::from_fn(f)
}

/// Computes θ of the bodies that vary, for one block of machines, into `theta`. `deviations` are ordered by parameter,
/// then by machine.
#[inline]
pub(super) fn evaluate(
    n: usize,
    bodies: &[LinkConstants],
    deviations: &[[f64; CHUNK]],
    block: usize,
    theta: &mut [Lanes],
) {
    theta.iter_mut().for_each(|t| *t = [0.0; BLOCK_MACHINES]);
    let delta = |p: usize| -> &Lanes { &deviations[p].as_chunks().0[block] };
    let of = |term: &UncertainNumber| match term.parameter {
        Some(p) => {
            let delta = delta(p);
            each(|w| term.nominal + delta[w])
        }
        None => [term.nominal; BLOCK_MACHINES],
    };
    for body in bodies {
        let (m, spin, u, v) = (of(&body.mass), of(&body.inertia), of(&body.com), of(&body.com_normal));
        let mut a = [[0.0; BLOCK_MACHINES]; MAX_DRIVES];
        for &k in &body.on {
            a[k] = [body.root[k]; BLOCK_MACHINES];
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
                (0..BLOCK_MACHINES).for_each(|w| sum[w] += f(w));
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
                // Im(conj(a_k) a_l): only the coefficient of the body's own drive has an imaginary part.
                if k == d {
                    add(at + 1, &|w| -m[w] * (off[w] * a[l][w]));
                } else if l == d {
                    add(at + 1, &|w| m[w] * (a[k][w] * off[w]));
                }
            }
        }
    }
}
