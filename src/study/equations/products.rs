//! Products of masses and lengths: the terms of (7), (8) and (A3) with their symbols, grouped as in the paper.

use std::collections::BTreeMap;

use super::bodies::{Arm, Bodies, BodyMass};
use super::equation::{Origin, Term};
use stillbase_mechanics::balance::{Body, Condition};

/// Product of a mass and one or two lengths.
struct Product {
    sign: f64,
    /// Multiplicity: 2 for the mixed term of a square.
    count: usize,
    lengths: Vec<String>,
    /// Whether an l_c is a factor, so that the product belongs to this mass alone.
    is_own: bool,
    mass: (usize, String),
    part: (Origin, f64),
}

/// Returns the terms of g_k, kg m.
pub(super) fn first_moment(bodies: &Bodies, k: usize) -> Vec<Term> {
    grouped(moments(bodies, k))
}

fn moments(bodies: &Bodies, k: usize) -> impl Iterator<Item = Product> {
    let of = move |(at, mass): (usize, &BodyMass)| {
        let product = move |arm: &Arm| product(at, mass, arm.sign * arm.value, arm.sign, &[arm]);
        mass.arms.iter().filter(|arm| arm.drive == k).map(product).collect::<Vec<_>>()
    };
    bodies.masses.iter().enumerate().flat_map(of)
}

/// Returns the terms of C_kl, kg m²; for k = l without the distances of masses from the axes of their links.
pub(super) fn coupling(bodies: &Bodies, k: usize, l: usize) -> Vec<Term> {
    grouped(couplings(bodies, k, l))
}

/// Returns the terms of g_k or C_kl that do not depend on the centres of mass of links with their counterweights.
pub(super) fn fixed_products(bodies: &Bodies, condition: Condition) -> Vec<Term> {
    let stays = |product: &Product| !product.is_own || matches!(product.part.0, Origin::Body(Body::Payload, _));
    match condition {
        Condition::Force(k) => grouped(moments(bodies, k).filter(stays)),
        Condition::Coupling(k, l) => grouped(couplings(bodies, k, l).filter(stays)),
    }
}

fn couplings(bodies: &Bodies, k: usize, l: usize) -> impl Iterator<Item = Product> {
    let of = move |(at, mass): (usize, &BodyMass)| {
        let on = |k: usize| mass.arms.iter().filter(move |arm| arm.drive == k);
        let product = |(a, b): (&Arm, &Arm)| {
            let sign = a.sign * b.sign;
            product(at, mass, sign * a.value * b.value, sign, &[a, b])
        };
        on(k).flat_map(|a| on(l).map(move |b| (a, b))).map(product).collect::<Vec<_>>()
    };
    bodies.masses.iter().enumerate().flat_map(of)
}

fn product(at: usize, mass: &BodyMass, value: f64, sign: f64, arms: &[&Arm]) -> Product {
    let mut lengths: Vec<String> = arms.iter().map(|arm| arm.symbol.clone()).collect();
    // The lengths of links come before the l_c, as in the paper.
    lengths.sort_by_key(|symbol| (arms.iter().any(|arm| arm.is_own && arm.symbol == *symbol), symbol.clone()));
    Product {
        sign,
        count: 1,
        lengths,
        is_own: arms.iter().any(|arm| arm.is_own),
        mass: (at, mass.mass_symbol.clone()),
        part: (mass.origin, mass.kilograms * value),
    }
}

/// Combines products with the same lengths and sign into one term: (m_5 + m_7) l_1.
fn grouped(products: impl Iterator<Item = Product>) -> Vec<Term> {
    let mut groups: BTreeMap<(Vec<String>, bool, usize), Vec<Product>> = BTreeMap::new();
    for product in products {
        // A product with an l_c is grouped only with the equal mixed product of the same square.
        let own = if product.is_own { product.mass.0 } else { usize::MAX };
        let group = groups.entry((product.lengths.clone(), product.sign < 0.0, own)).or_default();
        match group.iter_mut().find(|known| known.mass.0 == product.mass.0) {
            Some(known) => {
                known.count += 1;
                known.part.1 += product.part.1;
            }
            None => group.push(product),
        }
    }
    let apart = groups.into_values().flat_map(by_count);
    let mut terms: Vec<(bool, usize, Term)> =
        apart.map(|group| (group.len() > 2, group[0].mass.0, term(&group))).collect();
    terms.sort_by_key(|(is_long, first, _)| (*is_long, *first));
    terms.into_iter().map(|(.., term)| term).collect()
}

fn by_count(group: Vec<Product>) -> Vec<Vec<Product>> {
    let mut by_count: BTreeMap<usize, Vec<Product>> = BTreeMap::new();
    for product in group {
        by_count.entry(product.count).or_default().push(product);
    }
    by_count.into_values().collect()
}

fn term(group: &[Product]) -> Term {
    let masses: Vec<&str> = group.iter().map(|product| product.mass.1.as_str()).collect();
    let masses = if masses.len() == 1 { masses[0].to_owned() } else { format!("({})", masses.join(" + ")) };
    let count = if group[0].count > 1 { format!("{} ", group[0].count) } else { String::new() };
    let lengths = match &group[0].lengths[..] {
        [one, same] if one == same => format!("{one}²"),
        lengths => lengths.join(" "),
    };
    let parts = group.iter().map(|product| product.part).collect();
    let term = Term::sum(format!("{count}{masses} {lengths}"), parts);
    if group[0].sign < 0.0 { term.negative() } else { term }
}
