//! Traversal of the curve arc by arc, and points along an arc.

use std::f64::consts::{PI, TAU};

use super::arc::{ArcSource, FeasibleInterval, Graph, MonotoneArc, Site};
use super::cuts::{CUTS, GraphCut};
use super::few::SmallList;
use super::lifts::lifts;
use super::{Quadrilateral, REACH_ROUNDING, bend};
use crate::reactionless::plane::AngleLimit;
use stillbase_mechanics::planar::{cross, unit};

impl Quadrilateral {
    /// Returns the point of an arc at a parameter s.
    pub fn on(&self, arc: &MonotoneArc, s: f64) -> Site {
        match arc.path {
            ArcSource::Graph(Graph { sigma, piece }, turns) => self.turned(self.at(piece.alpha(s), sigma, None), turns),
            ArcSource::Line => {
                let t = (s - arc.s[0]) / (arc.s[1] - arc.s[0]);
                let mix = |from: f64, to: f64| from + t * (to - from);
                Site {
                    alpha: mix(arc.from.alpha, arc.to.alpha),
                    beta: mix(arc.from.beta, arc.to.beta),
                    b: mix(arc.from.b, arc.to.b),
                }
            }
        }
    }

    /// Returns the point with arm y turned by whole turns, rad.
    fn turned(&self, site: Site, turns: f64) -> Site {
        Site { beta: site.beta + turns, b: site.b + self.lambda[2] * turns, ..site }
    }

    /// Returns the point of an arc with a given b between those of the ends: bracketing with inverse quadratic
    /// interpolation (Chandrupatla).
    pub fn solve(&self, arc: &MonotoneArc, b: f64) -> Site {
        let gaps = [arc.from.b - b, arc.to.b - b];
        if gaps[0] * gaps[1] >= 0.0 {
            return if gaps[0].abs() < gaps[1].abs() { arc.from } else { arc.to };
        }
        let [mut first, mut second] = [(arc.s[0], gaps[0], arc.from), (arc.s[1], gaps[1], arc.to)];
        let mut t = (gaps[0] / (gaps[0] - gaps[1])).clamp(0.05, 0.95);
        for _ in 0..80 {
            let s = first.0 + t * (second.0 - first.0);
            let site = self.on(arc, s);
            let gap = site.b - b;
            let third = if (gap > 0.0) == (first.1 > 0.0) { first } else { std::mem::replace(&mut second, first) };
            first = (s, gap, site);
            let width = (second.0 - first.0).abs();
            let least = 1e-15 / width;
            if gap == 0.0 || least > 0.5 {
                break;
            }
            let xi = (first.0 - second.0) / (third.0 - second.0);
            let phi = (first.1 - second.1) / (third.1 - second.1);
            let inverse_is_monotone = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
            t = if inverse_is_monotone {
                first.1 / (second.1 - first.1) * third.1 / (second.1 - third.1)
                    + (third.0 - first.0) / (second.0 - first.0) * first.1 / (third.1 - first.1) * second.1
                        / (third.1 - second.1)
            } else {
                0.5
            };
            t = t.clamp(least, 1.0 - least);
        }
        if first.1.abs() < second.1.abs() { first.2 } else { second.2 }
    }

    /// Visits the whole curve within the limits, arc by arc. Neighbouring arcs of one graph share an end.
    pub fn arcs(&self, mut visit: impl FnMut(&MonotoneArc)) {
        if self.is_rhombus() {
            return self.lines(visit);
        }
        let Some((pieces, count)) = self.pieces() else { return };
        let cuts = self.cuts();
        let AngleLimit { min, max } = self.limits[0];
        for piece in &pieces[..count] {
            let [from, to] = piece.ends;
            let last = ((max - from) / TAU).floor();
            let mut turn = ((min - to) / TAU).ceil();
            while turn <= last {
                let piece = FeasibleInterval { ends: [from + TAU * turn, to + TAU * turn], turning: piece.turning };
                let span = [piece.ends[0].max(min), piece.ends[1].min(max)];
                if span[0] <= span[1] {
                    self.arcs_over(Graph { sigma: 1.0, piece }, span, cuts.as_slice(), &mut visit);
                    self.arcs_over(Graph { sigma: -1.0, piece }, span, cuts.as_slice(), &mut visit);
                }
                turn += 1.0;
            }
        }
    }

    /// Returns the feasible intervals of α modulo 2π; `None` if the quadrilateral never closes.
    fn pieces(&self) -> Option<([FeasibleInterval; 2], usize)> {
        let Self { m, x, y, r, .. } = *self;
        let (inner, outer) = (r + y, (r - y).abs());
        // Rounding must not make full stretch infeasible.
        let rounding = REACH_ROUNDING * self.size();
        let closes = y > 0.0 && inner >= (m - x).abs() - rounding && outer <= m + x + rounding;
        if !closes {
            return None;
        }
        let straight = inner >= m + x;
        let folded = outer <= (m - x).abs();
        let alpha = [if straight { 0.0 } else { bend(m, x, inner) }, if folded { PI } else { bend(m, x, outer) }];
        // At ρ = r + y, cos γ = −1; at ρ = |r − y|, cos γ = 1 if y ≤ r, else −1.
        let cos = [-1.0, if r >= y { 1.0 } else { -1.0 }];
        let piece = |from: f64, to: f64, turning| FeasibleInterval { ends: [from, to], turning };
        let whole = piece(-PI, PI, None);
        Some(match (straight, folded) {
            (true, true) => ([whole; 2], 1),
            (true, false) => ([piece(-alpha[1], alpha[1], Some([cos[1], cos[1]])); 2], 1),
            (false, true) => ([piece(alpha[0], TAU - alpha[0], Some([cos[0], cos[0]])); 2], 1),
            (false, false) => {
                let left = piece(-alpha[1], -alpha[0], Some([cos[1], cos[0]]));
                ([left, piece(alpha[0], alpha[1], Some(cos))], 2)
            }
        })
    }

    fn arcs_over(&self, graph: Graph, span: [f64; 2], cuts: &[GraphCut], visit: &mut impl FnMut(&MonotoneArc)) {
        let Graph { sigma, piece } = graph;
        // β and b of a place are computed only where an arc can begin or end within the limits.
        let end = |alpha: f64| GraphCut { alpha, beta: None, edge: false };
        let mut places = SmallList::<GraphCut, { CUTS + 2 }>::new(end(span[0]));
        places.push(end(span[0]));
        for cut in cuts {
            let alpha = cut.alpha + TAU * ((span[0] - cut.alpha) / TAU).ceil();
            if !(alpha > span[0] && alpha < span[1]) {
                continue;
            }
            let other_elbow = |beta: f64| {
                let z = self.side(unit(alpha));
                sigma * cross(z, unit(beta)) < -1e-7 * z.norm()
            };
            if cut.beta.is_some_and(other_elbow) {
                continue;
            }
            places.push(GraphCut { alpha, ..*cut });
        }
        places.items[1..places.len].sort_unstable_by(|a, b| a.alpha.total_cmp(&b.alpha));
        places.push(end(span[1]));
        let places = places.as_slice();
        let site = |i: usize| {
            let GraphCut { alpha, beta, .. } = places[i];
            match beta {
                _ if i == 0 || i + 1 == places.len() => self.at(alpha, sigma, piece.turning_at(alpha)),
                None => self.at(alpha, sigma, None),
                Some(beta) => self.through(alpha, beta, sigma),
            }
        };

        let bound = self.limits[1];
        let mut before: Option<f64> = None;
        let mut known: Option<Site> = None;
        let mut next = piece.s(span[0]);
        for i in 0..places.len() - 1 {
            let s = [next, piece.s(places[i + 1].alpha)];
            next = s[1];
            let mut from = known.take();
            let middle = match i {
                // A limit may leave a single point of the graph.
                0 if span[0] == span[1] => from.get_or_insert_with(|| site(i)).beta,
                _ => self.beta(piece.alpha(0.5 * (s[0] + s[1])), sigma),
            };
            for beta in lifts(middle, bound) {
                let ends = [*from.get_or_insert_with(|| site(i)), *known.get_or_insert_with(|| site(i + 1))];
                visit(&self.arc(ends, s, graph, beta - middle));
            }
            // Where the curve touches a bound from outside, or both bounds coincide, it meets them in a single point.
            if let GraphCut { edge: true, beta: Some(edge), .. } = places[i] {
                let from = *from.get_or_insert_with(|| site(i));
                let turns = TAU * ((edge - from.beta) / TAU).round();
                let misses = |middle: f64| !bound.contains(middle + turns, 0.0);
                if before.is_none_or(misses) && misses(middle) {
                    visit(&self.arc([from; 2], [s[0]; 2], graph, turns));
                }
            }
            before = Some(middle);
        }
    }

    fn arc(&self, [from, to]: [Site; 2], s: [f64; 2], graph: Graph, turns: f64) -> MonotoneArc {
        MonotoneArc {
            from: self.turned(from, turns),
            to: self.turned(to, turns),
            s,
            path: ArcSource::Graph(graph, turns),
        }
    }

    /// Whether all four sides are equal. Then the curve consists of straight lines, on which one pair of arms cancels.
    fn is_rhombus(&self) -> bool {
        [self.x, self.y, self.r].iter().all(|side| (side - self.m).abs() <= REACH_ROUNDING * self.size())
    }

    /// Visits the curve of a rhombus: α = π, β = π, α − β = π, modulo 2π.
    fn lines(&self, mut visit: impl FnMut(&MonotoneArc)) {
        let [first, second] = self.limits;
        let [by_turn, by_alpha, by_beta] = [-self.lambda_sum, self.lambda[1], self.lambda[2]];
        let mut line = |[from, to]: [[f64; 2]; 2], arg_w: [f64; 2]| {
            let b =
                |i: usize, [alpha, beta]: [f64; 2]| self.b_0 + by_turn * arg_w[i] + by_alpha * alpha + by_beta * beta;
            let site = |i: usize, at: [f64; 2]| Site { alpha: at[0], beta: at[1], b: b(i, at) };
            let s = [0.0, if from == to { 0.0 } else { PI }];
            visit(&MonotoneArc { from: site(0, from), to: site(1, to), s, path: ArcSource::Line });
        };
        for alpha in lifts(PI, first) {
            line([[alpha, second.min], [alpha, second.max]], [second.min, second.max]);
        }
        for beta in lifts(PI, second) {
            line([[first.min, beta], [first.max, beta]], [first.min, first.max]);
        }
        let difference = AngleLimit { min: first.min - second.max, max: first.max - second.min };
        for difference in lifts(PI, difference) {
            let [from, to] = [first.min.max(second.min + difference), first.max.min(second.max + difference)];
            line([[from, from - difference], [to, to - difference]], [0.0; 2]);
        }
    }
}
