//! Closures whose equations are coupled, solved together.

use super::pins::{FLAT_SINE, MAX_PINS};
use super::tree::{CutClosure, TreeLink, lever};
use crate::planar::{UnitVectors, Vector};

/// Maximum number of closures solved together: each closure has two undriven links, and therefore three pins.
pub(super) const MAX_BLOCK_CLOSURES: usize = MAX_PINS / 3;

/// Forces of the cut closures of a block, N, in the order of the block.
pub(super) type BlockForces = [Vector; MAX_BLOCK_CLOSURES];

/// Returns the forces λ of the closures `open`, N, and whether the equations are regular: no pivot below [`FLAT_SINE`].
/// Solves the equations of the links `rows`, two for each closure, by Gaussian elimination with partial pivoting.
pub(super) fn together(
    links: &[TreeLink],
    closures: &[CutClosure],
    open: &[usize],
    rows: &[usize],
    e: &UnitVectors,
    moment: &[f64],
) -> (BlockForces, bool) {
    let n = rows.len();
    let mut a = [[0.0; 2 * MAX_BLOCK_CLOSURES + 1]; 2 * MAX_BLOCK_CLOSURES];
    for (row, &j) in a.iter_mut().zip(rows) {
        let ej = e[links[j].drive];
        // Each row is scaled so that its largest lever is 1; pivots are then comparable to sines.
        let size = open.iter().fold(0.0_f64, |m, &c| m.max(lever(&closures[c], j).abs()));
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        for (i, &c) in open.iter().enumerate() {
            let w = scale * lever(&closures[c], j);
            (row[2 * i], row[2 * i + 1]) = (-w * ej.im, w * ej.re);
        }
        row[2 * MAX_BLOCK_CLOSURES] = scale * moment[j];
    }
    let mut regular = true;
    for i in 0..n {
        let p = (i..n).max_by(|&p, &q| a[p][i].abs().total_cmp(&a[q][i].abs())).unwrap_or(i);
        a.swap(i, p);
        if a[i][i].abs() < FLAT_SINE {
            regular = false;
            a[i][i] = FLAT_SINE.copysign(a[i][i]);
        }
        let pivot = a[i];
        for row in &mut a[i + 1..n] {
            let factor = row[i] / pivot[i];
            row.iter_mut().zip(&pivot).skip(i).for_each(|(x, y)| *x -= factor * y);
        }
    }
    let mut x = [0.0; 2 * MAX_BLOCK_CLOSURES];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|l| a[i][l] * x[l]).sum();
        x[i] = (a[i][2 * MAX_BLOCK_CLOSURES] - known) / a[i][i];
    }
    (std::array::from_fn(|i| Vector::new(x[2 * i], x[2 * i + 1])), regular)
}
