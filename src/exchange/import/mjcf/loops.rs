//! Bodies that loops keep parallel.

use nalgebra::Vector3;
use roxmltree::Node;

use super::coupled::CoupledBodies;
use crate::import::bodies::AttachmentPoint;
use crate::import::refusal::{ImportError, element_error};
use stillbase_mechanics::planar::Vector;

/// Closure tolerance: vectors of a loop cancel if their sum is at most this fraction of the largest.
const CLOSURE_TOLERANCE: f64 = 1e-9;
/// Maximum number of sides of one loop.
const MAX_SIDES: usize = 12;

impl CoupledBodies<'_> {
    /// Joins the sets of parts that a loop keeps parallel: each side of the loop with its equal and opposite side.
    ///
    /// # Errors
    /// If the loop has too many sides, is open in the pose of the file, or has sides that do not form pairs.
    pub(super) fn close(&mut self, node: Node<'_, '_>, ends: &[AttachmentPoint; 2]) -> Result<(), ImportError> {
        let sides = self.sides(ends);
        let largest = sides.iter().fold(0.0_f64, |most, (_, v)| most.max(v.norm()));
        let is_zero = |v: Vector| v.norm() <= CLOSURE_TOLERANCE * largest;
        // Parts that turn together form one side.
        let mut merged: Vec<(usize, Vector)> = Vec::new();
        for (i, v) in sides {
            let set = self.together.root(i);
            match merged.iter_mut().find(|(other, _)| *other == set) {
                Some((_, sum)) => *sum += v,
                None => merged.push((set, v)),
            }
        }
        merged.retain(|(_, v)| !is_zero(*v));
        let total: Vector = merged.iter().map(|(_, v)| v).sum();
        if merged.len() > MAX_SIDES {
            return Err(element_error(
                node,
                format!("its loop has {} sides, and at most {MAX_SIDES} are read", merged.len()),
                "loops of fewer bodies, such as parallelograms",
            ));
        }
        if !is_zero(total) {
            return Err(element_error(
                node,
                "its ends are apart in the pose of the file",
                "a keyframe in which every loop is closed",
            ));
        }
        // Pairs furthest apart around the loop come first, so that antiparallel neighbours are not taken for opposite
        // sides.
        while !merged.is_empty() {
            let count = merged.len();
            let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
            let pairs = pairs.filter(|(a, b)| is_zero(merged[*a].1 + merged[*b].1));
            let apart = |(a, b): &(usize, usize)| (b - a).min(count - (b - a));
            let Some((a, b)) = pairs.max_by_key(apart) else {
                return Err(element_error(
                    node,
                    "a loop that is no parallelogram",
                    "loops whose opposite sides are equal",
                ));
            };
            self.together.join(merged[a].0, merged[b].0);
            merged.remove(b);
            merged.remove(a);
        }
        Ok(())
    }

    /// Returns the vector of each part in the plane, m, from its hinge to the next, around the loop.
    fn sides(&self, ends: &[AttachmentPoint; 2]) -> Vec<(usize, Vector)> {
        let flat = |p: Vector3<f64>| Vector::new(self.plane[0].dot(&p), self.plane[1].dot(&p));
        let mut sides: Vec<(usize, Vector)> = Vec::new();
        for (direction, (part, at)) in [(1.0, ends[0]), (-1.0, ends[1])] {
            let (mut at, mut part) = (flat(at), part.and_then(|part| self.owners[part]));
            let mut own = Vec::new();
            while let Some(i) = part {
                let root = flat(self.bodies.parts[i].hinge.map_or(Vector3::zeros(), |(_, on)| on));
                own.push((i, direction * (at - root)));
                at = root;
                part = self.bodies.parts[i].parent.and_then(|parent| self.owners[parent]);
            }
            own.push((self.base, direction * at));
            if direction > 0.0 {
                own.reverse();
            }
            sides.extend(own);
        }
        sides
    }
}
