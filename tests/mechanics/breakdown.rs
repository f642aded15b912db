//! What each part of a machine brings to (7) and (8): against sums by hand, and against what a change of it does.

use stillbase::mechanics::balance::{BalanceTerm, Body, Breakdown, Condition};
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::Vector;

use crate::support::Noise;
use crate::support::random::with_counterweights;

fn size(term: &BalanceTerm) -> f64 {
    term.gross().max(1e-3)
}

#[test]
fn what_the_parts_bring_sums_to_what_is_left() {
    let mut noise = Noise::of(11);
    for _ in 0..300 {
        let machine = with_counterweights(&mut noise);
        let (inertia, breakdown) = (Inertia::of(&machine), Breakdown::of(&machine));
        let n = machine.drives();
        let spec = machine.spec();
        let bodies = spec.links.len() + spec.counterweights.len() + usize::from(spec.payload.mass > 0.0);
        assert_eq!((breakdown.terms.len(), breakdown.sources.len()), (n + n * (n - 1) / 2, bodies));
        for (term, condition) in breakdown.terms.iter().zip(Condition::all(n)) {
            assert_eq!(term.condition, condition);
            assert_eq!(term.residual, condition.residual(&inertia));
            let sum: Vector = term.parts.iter().sum();
            assert!((sum - term.residual).norm() < 1e-14 * size(term), "{condition:?}: {sum} and {}", term.residual);
            let by_link: Vector = (0..spec.links.len()).map(|j| breakdown.of_link(term, j)).sum();
            assert!((by_link - sum).norm() < 1e-14 * size(term));
        }
        let force = breakdown.terms[..n].iter().all(|term| term.balanced);
        let coupling = breakdown.terms[n..].iter().all(|term| term.balanced);
        assert_eq!((force, coupling), (inertia.is_force_balanced(), inertia.is_invariant()));
    }
}

/// Twice the mass brings twice as much: what a part is said to bring is what its mass adds once more.
#[test]
fn a_part_brings_what_its_mass_adds() {
    let mut noise = Noise::of(12);
    for _ in 0..100 {
        let machine = with_counterweights(&mut noise);
        let (inertia, breakdown) = (Inertia::of(&machine), Breakdown::of(&machine));
        for (i, source) in breakdown.sources.iter().enumerate() {
            let mut spec = machine.spec().clone();
            match source.body {
                Body::Link(j) => spec.links[j].mass *= 2.0,
                Body::Counterweight(j) => spec.counterweights[j].mass *= 2.0,
                Body::Payload => spec.payload.mass *= 2.0,
            }
            let doubled = Inertia::of(&Machine::new(spec).expect("still a machine"));
            for term in &breakdown.terms {
                let added = term.condition.residual(&doubled) - term.condition.residual(&inertia);
                assert!((added - term.parts[i]).norm() < 1e-13 * size(term), "{source:?}: {added} {}", term.parts[i]);
            }
        }
    }
}

/// (7) and (8) of the nine-link machine, link by link, as they stand in the paper.
#[test]
fn the_nine_links_bring_what_the_paper_writes() {
    let machine = builtin("nine-link-table-1").expect("built in");
    let breakdown = Breakdown::of(machine);
    let m: Vec<f64> = machine.links().iter().map(|link| link.mass).collect();
    let c: Vec<f64> = machine.links().iter().map(|link| link.com).collect();
    let l: Vec<f64> = machine.resolved_links().iter().map(|part| part.length).collect();
    let want = [
        [m[0] * c[0], 0.0, 0.0, m[3] * c[3], m[4] * l[0], m[5] * c[5], m[6] * l[0], m[7] * l[0], m[8] * l[0]],
        [0.0, m[1] * c[1], 0.0, m[3] * l[1], -m[4] * c[4], 0.0, 0.0, -m[7] * c[7], -m[8] * l[4]],
        [0.0, 0.0, m[2] * c[2], 0.0, 0.0, m[5] * l[2], m[6] * c[6], m[7] * l[2], -m[8] * c[8]],
        [0.0, 0.0, 0.0, m[3] * l[1] * c[3], -m[4] * l[0] * c[4], 0.0, 0.0, -m[7] * l[0] * c[7], -m[8] * l[0] * l[4]],
        [0.0, 0.0, 0.0, 0.0, 0.0, m[5] * l[2] * c[5], m[6] * l[0] * c[6], m[7] * l[0] * l[6], -m[8] * l[0] * c[8]],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -m[7] * l[6] * c[7], m[8] * l[4] * c[8]],
    ];
    for (term, want) in breakdown.terms.iter().zip(want) {
        for (part, want) in term.parts.iter().zip(want) {
            assert!((part - Vector::new(want, 0.0)).norm() < 1e-15, "{:?}: {part} and {want}", term.condition);
        }
    }
    // Table I is rounded: none of (7) is met, which the shipped machine is.
    assert!(breakdown.terms[..3].iter().all(|term| !term.balanced));
    assert!(Breakdown::of(builtin("nine-link").expect("built in")).terms.iter().all(|term| term.balanced));
}

/// The parts and lumps of a link bring together what the link brings.
#[test]
fn parts_bring_what_their_link_brings() {
    let arm = stillbase::mechanics::machine::parse(include_str!("parts.toml"), "parts.toml").expect("an arm");
    let breakdown = Breakdown::of(&arm);
    for term in &breakdown.terms {
        for (source, whole) in breakdown.sources.iter().zip(&term.parts) {
            let Body::Link(link) = source.body else { continue };
            let own = arm.part_bodies().iter().filter(|part| part.link == link);
            let sum: Vector = own.map(|part| term.of_part(&arm, part)).sum();
            assert!((sum - whole).norm() < 1e-12 * (1.0 + whole.norm()), "{:?}: {sum} and {whole}", term.condition);
        }
    }
}
