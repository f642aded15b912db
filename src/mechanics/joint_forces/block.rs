//! Closures that do not come apart, solved together.

use super::pins::{FLAT, MAX_PINS};
use super::tree::{CutClosure, TreeLink, lever};
use crate::mechanics::planar::{Units, Vector};

/// The most closures solved together: each holds two links, so 3 pins each beside one at B.
pub(super) const MOST: usize = MAX_PINS / 3;

/// Forces of the cut closures of a block, in its order.
pub(super) type Block = [Vector; MOST];

/// Forces of the cut closures of a block by elimination with row pivots, and whether no pivot vanished.
pub(super) fn together(
    links: &[TreeLink],
    closures: &[CutClosure],
    open: &[usize],
    rows: &[usize],
    e: &Units,
    moment: &[f64],
) -> (Block, bool) {
    let n = rows.len();
    let mut a = [[0.0; 2 * MOST + 1]; 2 * MOST];
    for (row, &j) in a.iter_mut().zip(rows) {
        let ej = e[links[j].drive];
        // Rows of unit size, so that pivots compare with 1.
        let size = open.iter().fold(0.0_f64, |m, &c| m.max(lever(&closures[c], j).abs()));
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        for (i, &c) in open.iter().enumerate() {
            let w = scale * lever(&closures[c], j);
            (row[2 * i], row[2 * i + 1]) = (-w * ej.im, w * ej.re);
        }
        row[2 * MOST] = scale * moment[j];
    }
    let mut regular = true;
    for i in 0..n {
        let p = (i..n).max_by(|&p, &q| a[p][i].abs().total_cmp(&a[q][i].abs())).unwrap_or(i);
        a.swap(i, p);
        if a[i][i].abs() < FLAT {
            regular = false;
            a[i][i] = FLAT.copysign(a[i][i]);
        }
        let pivot = a[i];
        for row in &mut a[i + 1..n] {
            let factor = row[i] / pivot[i];
            row.iter_mut().zip(&pivot).skip(i).for_each(|(x, y)| *x -= factor * y);
        }
    }
    let mut x = [0.0; 2 * MOST];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|l| a[i][l] * x[l]).sum();
        x[i] = (a[i][2 * MOST] - known) / a[i][i];
    }
    (std::array::from_fn(|i| Vector::new(x[2 * i], x[2 * i + 1])), regular)
}
