//! The quadrilateral that a point closes with the three arms: the curve of poses that keep the end effector on the
//! point (its self-motion), cut into arcs along which b is monotone.
//!
//! Turned so that the arm both relative angles share lies on the real axis, the curve is the level line
//! |m + x e^{iα} + y e^{iβ}| = |p|. For each α the law of cosines gives two β, so it consists of two graphs,
//! and b along them is closed form and free of jumps. All cuts are closed form too: where α turns back, where the curve
//! crosses the joint limits, and the folds det = 0, whose cos α are the roots of a cubic.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m, x, y | lengths of the shared arm and of the other two; |c_k| | m |
//! | α, β | angles of arms x and y from arm m: ±a_i and a constant | rad |
//! | z, ρ | m + x e^{iα} and its length | m |
//! | w, r | z + y e^{iβ} and its length, the distance of the point from B | m |
//! | σ, γ | β = arg z + σγ, γ in [0, π], σ = ±1: the elbow | 1, rad |
//! | η | arg w = arg z + ση | rad |

mod folds;

use std::f64::consts::{PI, TAU};

use super::plane::{AngleLimit, PlaneMap};
use crate::mechanics::planar::{Vector, cross, unit};

/// A point whose distance misses the reach of the arms by less than this share of it counts as reached: rounding.
pub(super) const ROUNDING: f64 = 1e-12;

/// A point of the curve. α, β and b are continuous along an arc, never wrapped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    pub alpha: f64,
    pub beta: f64,
    pub b: f64,
}

/// A stretch of the curve along which b is monotone; a single point where both ends are equal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub from: Site,
    pub to: Site,
    /// Its parameter at the two ends, in [0, π].
    pub s: [f64; 2],
    path: Path,
}

/// What an arc is part of.
#[derive(Clone, Copy, Debug)]
enum Path {
    /// A graph, arm y turned by these angles against it: whole turns.
    Graph(Graph, f64),
    /// Linear in s between the ends.
    Line,
}

/// One elbow over one interval of feasible α. The parameter s in [0, π] runs through it as α = mid − half cos s, so
/// that γ is smooth in s where the curve turns back.
#[derive(Clone, Copy, Debug)]
struct Graph {
    sigma: f64,
    piece: Piece,
}

/// An interval of α over which the quadrilateral closes.
#[derive(Clone, Copy, Debug)]
struct Piece {
    ends: [f64; 2],
    /// cos γ = ±1 at the ends, where the curve turns back to the other elbow; none where it goes on.
    turning: Option<[f64; 2]>,
}

impl Piece {
    fn alpha(&self, s: f64) -> f64 {
        let [from, to] = self.ends;
        let (sin, cos) = (0.5 * s).sin_cos();
        if s < 0.5 * PI { from + (to - from) * sin * sin } else { to - (to - from) * cos * cos }
    }

    fn s(&self, alpha: f64) -> f64 {
        let [from, to] = self.ends;
        2.0 * (alpha - from).max(0.0).sqrt().atan2((to - alpha).max(0.0).sqrt())
    }

    /// cos γ at an α, if it is a turning end.
    fn turning_at(&self, alpha: f64) -> Option<f64> {
        let turning = self.turning?;
        (0..2).find(|&i| alpha == self.ends[i]).map(|i| turning[i])
    }
}

/// Where a graph is cut, α modulo 2π. More cuts than needed do no harm.
#[derive(Clone, Copy, Debug)]
struct Cut {
    alpha: f64,
    /// β modulo 2π, or whatever the graph says.
    beta: Option<f64>,
    /// Whether β is a bound.
    edge: bool,
}

/// A list on the stack; what does not fit is dropped.
struct Few<T, const N: usize> {
    len: usize,
    items: [T; N],
}

impl<T: Copy, const N: usize> Few<T, N> {
    fn new(filler: T) -> Self {
        Self { len: 0, items: [filler; N] }
    }

    fn push(&mut self, item: T) {
        if self.len < N {
            self.items[self.len] = item;
            self.len += 1;
        }
    }

    fn as_slice(&self) -> &[T] {
        &self.items[..self.len]
    }
}

/// Folds that pass a bound by less than this count as within, rad.
const NEAR_BOUND: f64 = 1e-3;
/// 4 crossings of limits, 2 flat poses, 6 folds; each of these may be found several times where some merge.
const CUTS: usize = 36;

/// The arms of a [`PlaneMap`] and a point.
#[derive(Clone, Debug)]
pub(super) struct Quadrilateral {
    m: f64,
    x: f64,
    y: f64,
    r: f64,
    /// λ of the arms m, x, y.
    lambda: [f64; 3],
    lambda_sum: f64,
    /// b = b_0 − Σλ arg w + λ_x α + λ_y β.
    b_0: f64,
    /// Bounds of α and β.
    limits: [AngleLimit; 2],
    /// Which a_i is α, and which β.
    index: [usize; 2],
    /// α = sign a + shift, β likewise.
    sign: [f64; 2],
    shift: [f64; 2],
}

/// The angle by which a side v is bent from a side u when they sum to a length t, in [0, π].
fn bend(u: f64, v: f64, t: f64) -> f64 {
    let [open, closed] = [(u + v - t) * (u + v + t), (t - u + v) * (t + u - v)].map(|n| n.max(0.0).sqrt());
    2.0 * open.atan2(closed)
}

impl Quadrilateral {
    /// The quadrilateral of a point, limits widened by `slack`.
    pub fn new(map: &PlaneMap, p: Vector, slack: f64) -> Self {
        let (c, lambda, angles) = (map.c(), map.lambda(), map.angles());
        let shared =
            if angles[1].to == angles[0].to || angles[1].from == angles[0].to { angles[0].to } else { angles[0].from };
        let half_turn = c.map(|c| if c < 0.0 { PI } else { 0.0 });
        let other = angles.map(|a| if a.to == shared { a.from } else { a.to });
        let sign = angles.map(|a| if a.to == shared { -1.0 } else { 1.0 });
        let shift = [0, 1].map(|i| half_turn[other[i]] - half_turn[shared] - sign[i] * angles[i].offset);
        let limits = [0, 1].map(|i| {
            let AngleLimit { min, max } = map.limits()[i];
            let ends = [min, max].map(|a| sign[i] * a + shift[i]);
            AngleLimit { min: ends[0].min(ends[1]) - slack, max: ends[0].max(ends[1]) + slack }
        });

        let length = c.map(f64::abs);
        let (m, l) = (length[shared], other.map(|k| length[k]));
        let far = length.iter().sum::<f64>();
        let near = (2.0 * length.into_iter().fold(0.0, f64::max) - far).max(0.0);
        let rounding = ROUNDING * far;
        let r = match p.norm() {
            r if r > far && r <= far + rounding => far,
            r if r < near && r >= near - rounding => near,
            r => r,
        };
        // The closed form wants arm y long, and z nowhere 0.
        let clearance = |x: usize| (m - l[x]).abs().max((r - l[1 - x]).abs());
        let x = usize::from(l[0] > l[1]);
        let flipped = clearance(x) < 1e-6 * far && clearance(1 - x) > clearance(x) && l[x] > 1e-3 * far;
        let x = if flipped { 1 - x } else { x };
        let index = [x, 1 - x];

        let lambda_sum = map.lambda_sum();
        Self {
            m,
            x: l[index[0]],
            y: l[index[1]],
            r,
            lambda: [lambda[shared], lambda[other[index[0]]], lambda[other[index[1]]]],
            lambda_sum,
            b_0: lambda_sum * p.im.atan2(p.re) - (0..3).map(|k| lambda[k] * half_turn[k]).sum::<f64>(),
            limits: index.map(|i| limits[i]),
            index,
            sign: index.map(|i| sign[i]),
            shift: index.map(|i| shift[i]),
        }
    }

    /// (a_1, a_2) of (α, β).
    pub fn relative_angles(&self, alpha: f64, beta: f64) -> [f64; 2] {
        let mut a = [0.0; 2];
        for (i, angle) in [alpha, beta].into_iter().enumerate() {
            a[self.index[i]] = self.sign[i] * (angle - self.shift[i]);
        }
        a
    }

    fn period(&self) -> f64 {
        TAU * self.lambda_sum
    }

    fn size(&self) -> f64 {
        self.m + self.x + self.y
    }

    /// Whether the point is B itself, where every b is as good as any other.
    pub fn is_at_base(&self) -> bool {
        self.r <= ROUNDING * self.size()
    }

    /// The poses of a point at B within the limits: the triangle of the arms and its mirror image.
    pub fn triangles(&self, mut visit: impl FnMut([f64; 2])) {
        if self.y == 0.0 || self.y > self.m + self.x || self.y < (self.m - self.x).abs() {
            return;
        }
        let alpha = bend(self.m, self.x, self.y);
        let beta = (-self.z(alpha).0).arg();
        let mirrored = alpha.sin().abs() > 1e-9 || beta.sin().abs() > 1e-9;
        for sign in [1.0, -1.0].into_iter().take(1 + usize::from(mirrored)) {
            self.within_limits(sign * alpha, sign * beta, &mut visit);
        }
    }

    /// The flat poses that hold the point: all arms in one line. The curve is singular there.
    pub fn flat(&self, mut visit: impl FnMut([f64; 2])) {
        for [first, second] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            if self.is_level(self.m + first * self.x + second * self.y) {
                let angle = |sign: f64| if sign > 0.0 { 0.0 } else { PI };
                self.within_limits(angle(first), angle(second), &mut visit);
            }
        }
    }

    /// The corners of the limits that hold the point. The curve may meet the limits nowhere else.
    pub fn corners(&self, mut visit: impl FnMut([f64; 2])) {
        let [first, second] = self.limits.map(|l| [l.min, l.max]);
        let units = second.map(unit);
        for alpha in first {
            let z = self.z(alpha).0;
            for (beta, unit) in second.into_iter().zip(units) {
                if self.is_level((z + self.y * unit).norm()) {
                    visit(self.relative_angles(alpha, beta));
                }
            }
        }
    }

    /// Whether arms that span `length` reach the point.
    fn is_level(&self, length: f64) -> bool {
        (length.abs() - self.r).abs() <= 10.0 * ROUNDING * self.size()
    }

    /// All (a_1, a_2) within the limits that are (α, β) give or take whole turns.
    fn within_limits(&self, alpha: f64, beta: f64, mut visit: impl FnMut([f64; 2])) {
        for alpha in lifts(alpha, self.limits[0]) {
            for beta in lifts(beta, self.limits[1]) {
                visit(self.relative_angles(alpha, beta));
            }
        }
    }

    /// z where arm x points along e.
    #[inline]
    fn side(&self, e: Vector) -> Vector {
        Vector::new(self.m + self.x * e.re, self.x * e.im)
    }

    /// z and its argument, without jumps in α unless z passes through 0.
    #[inline]
    fn z(&self, alpha: f64) -> (Vector, f64) {
        let e = unit(alpha);
        let z = self.side(e);
        let arg =
            if self.x > self.m { alpha + f64::atan2(-self.m * e.im, self.x + self.m * e.re) } else { z.im.atan2(z.re) };
        (z, arg)
    }

    /// The point of a graph at α; `cos_gamma` where it is known to be ±1.
    #[inline]
    fn at(&self, alpha: f64, sigma: f64, cos_gamma: Option<f64>) -> Site {
        let (z, arg_z) = self.z(alpha);
        let rho = z.norm_sqr().sqrt();
        let (gamma, sin, cos) = match cos_gamma {
            Some(cos) => (if cos > 0.0 { 0.0 } else { PI }, 0.0, cos),
            None => self.gamma(rho),
        };
        let eta = (self.y * sin).atan2(rho + self.y * cos);
        let beta = arg_z + sigma * gamma;
        let b = self.b_0 - self.lambda_sum * (arg_z + sigma * eta) + self.lambda[1] * alpha + self.lambda[2] * beta;
        Site { alpha, beta, b }
    }

    /// γ where z is so long, and its sine and cosine.
    #[inline]
    fn gamma(&self, rho: f64) -> (f64, f64, f64) {
        let (y, r) = (self.y, self.r);
        // Half-angle form of the law of cosines: keeps its digits where the quadrilateral is nearly flat.
        let open = ((rho + y - r) * (rho + y + r)).max(0.0);
        let closed = ((r - rho + y) * (r + rho - y)).max(0.0);
        let sum = open + closed;
        if sum > 0.0 {
            let gamma = 2.0 * open.sqrt().atan2(closed.sqrt());
            (gamma, 2.0 * (open * closed).sqrt() / sum, (closed - open) / sum)
        } else {
            (0.5 * PI, 1.0, 0.0)
        }
    }

    /// β of the point of a graph at α, where its b is not asked for.
    #[inline]
    fn beta(&self, alpha: f64, sigma: f64) -> f64 {
        let (z, arg_z) = self.z(alpha);
        arg_z + sigma * self.gamma(z.norm_sqr().sqrt()).0
    }

    /// The point of a graph where it passes through (α, β), b from both and therefore to full precision.
    fn through(&self, alpha: f64, beta: f64, sigma: f64) -> Site {
        let near = self.at(alpha, sigma, None);
        let beta = beta + TAU * ((near.beta - beta) / TAU).round();
        let w = self.z(alpha).0 + self.y * unit(beta);
        let b = self.b_0 - self.lambda_sum * w.im.atan2(w.re) + self.lambda[1] * alpha + self.lambda[2] * beta;
        Site { alpha, beta, b: b + self.period() * ((near.b - b) / self.period()).round() }
    }

    /// A point of an arc by its parameter s.
    pub fn on(&self, arc: &Arc, s: f64) -> Site {
        match arc.path {
            Path::Graph(Graph { sigma, piece }, turns) => self.turned(self.at(piece.alpha(s), sigma, None), turns),
            Path::Line => {
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

    /// The same point with arm y turned by whole turns.
    fn turned(&self, site: Site, turns: f64) -> Site {
        Site { beta: site.beta + turns, b: site.b + self.lambda[2] * turns, ..site }
    }

    /// The point of an arc with this b, which lies between those of the ends: bracketing with inverse quadratic
    /// interpolation (Chandrupatla).
    pub fn solve(&self, arc: &Arc, b: f64) -> Site {
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

    /// Visits the whole curve within the limits, arc by arc. Arcs that continue each other share an end.
    pub fn arcs(&self, mut visit: impl FnMut(&Arc)) {
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
                let piece = Piece { ends: [from + TAU * turn, to + TAU * turn], turning: piece.turning };
                let span = [piece.ends[0].max(min), piece.ends[1].min(max)];
                if span[0] <= span[1] {
                    self.arcs_over(Graph { sigma: 1.0, piece }, span, cuts.as_slice(), &mut visit);
                    self.arcs_over(Graph { sigma: -1.0, piece }, span, cuts.as_slice(), &mut visit);
                }
                turn += 1.0;
            }
        }
    }

    /// The feasible intervals of α modulo 2π, none if the quadrilateral never closes.
    fn pieces(&self) -> Option<([Piece; 2], usize)> {
        let Self { m, x, y, r, .. } = *self;
        let (inner, outer) = (r + y, (r - y).abs());
        // Full stretch is not to be lost to rounding.
        let rounding = ROUNDING * self.size();
        let closes = y > 0.0 && inner >= (m - x).abs() - rounding && outer <= m + x + rounding;
        if !closes {
            return None;
        }
        let straight = inner >= m + x;
        let folded = outer <= (m - x).abs();
        let alpha = [if straight { 0.0 } else { bend(m, x, inner) }, if folded { PI } else { bend(m, x, outer) }];
        // Where ρ = r + y arm y points back at B; where ρ = |r − y| it points on if it is the shorter.
        let cos = [-1.0, if r >= y { 1.0 } else { -1.0 }];
        let piece = |from: f64, to: f64, turning| Piece { ends: [from, to], turning };
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

    fn arcs_over(&self, graph: Graph, span: [f64; 2], cuts: &[Cut], visit: &mut impl FnMut(&Arc)) {
        let Graph { sigma, piece } = graph;
        // β and b of a place are worked out where the limits let an arc begin or end there.
        let end = |alpha: f64| Cut { alpha, beta: None, edge: false };
        let mut places = Few::<Cut, { CUTS + 2 }>::new(end(span[0]));
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
            places.push(Cut { alpha, ..*cut });
        }
        places.items[1..places.len].sort_unstable_by(|a, b| a.alpha.total_cmp(&b.alpha));
        places.push(end(span[1]));
        let places = places.as_slice();
        let site = |i: usize| {
            let Cut { alpha, beta, .. } = places[i];
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
            // A bound that the curve touches from outside, or that leaves no room, is met in a point.
            if let Cut { edge: true, beta: Some(edge), .. } = places[i] {
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

    fn arc(&self, [from, to]: [Site; 2], s: [f64; 2], graph: Graph, turns: f64) -> Arc {
        Arc { from: self.turned(from, turns), to: self.turned(to, turns), s, path: Path::Graph(graph, turns) }
    }

    /// Whether all four sides are equal. Then the curve falls apart into lines, on which one pair of arms cancels.
    fn is_rhombus(&self) -> bool {
        [self.x, self.y, self.r].iter().all(|side| (side - self.m).abs() <= ROUNDING * self.size())
    }

    /// The curve of a rhombus: α = π, β = π, α − β = π, modulo 2π.
    fn lines(&self, mut visit: impl FnMut(&Arc)) {
        let [first, second] = self.limits;
        let [by_turn, by_alpha, by_beta] = [-self.lambda_sum, self.lambda[1], self.lambda[2]];
        let mut line = |[from, to]: [[f64; 2]; 2], arg_w: [f64; 2]| {
            let b =
                |i: usize, [alpha, beta]: [f64; 2]| self.b_0 + by_turn * arg_w[i] + by_alpha * alpha + by_beta * beta;
            let site = |i: usize, at: [f64; 2]| Site { alpha: at[0], beta: at[1], b: b(i, at) };
            let s = [0.0, if from == to { 0.0 } else { PI }];
            visit(&Arc { from: site(0, from), to: site(1, to), s, path: Path::Line });
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

    fn cuts(&self) -> Few<Cut, CUTS> {
        let mut cuts = Few::new(Cut { alpha: 0.0, beta: None, edge: false });
        self.limit_crossings(|alpha, beta| cuts.push(Cut { alpha, beta: Some(beta), edge: true }));
        // The graphs touch where an end of the feasible α is flat: they have a corner there.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9 * self.size();
        if near(self.r + self.y, self.m + self.x) {
            cuts.push(Cut { alpha: 0.0, beta: None, edge: false });
        }
        if near((self.r - self.y).abs(), (self.m - self.x).abs()) {
            cuts.push(Cut { alpha: PI, beta: None, edge: false });
        }
        // Where the limits leave nothing of the graph, it need not be cut.
        let AngleLimit { min, max } = self.limits[1];
        let wide = AngleLimit { min: min - NEAR_BOUND, max: max + NEAR_BOUND };
        self.folds(|alpha, beta| {
            if beta.is_none_or(|beta| lifts(beta, wide).next().is_some()) {
                cuts.push(Cut { alpha, beta, edge: false });
            }
        });
        cuts
    }

    /// Where β is at a bound: the triangle of arm x, the point, and the other two arms held rigid.
    fn limit_crossings(&self, mut push: impl FnMut(f64, f64)) {
        let Self { m, x, y, r, .. } = *self;
        for beta in [self.limits[1].min, self.limits[1].max] {
            let e = unit(beta);
            let rigid = Vector::new(m + y * e.re, y * e.im);
            let length = rigid.norm();
            if x > 0.0 && r <= length + x && r >= (length - x).abs() {
                let (arg, angle) = (rigid.im.atan2(rigid.re), bend(length, x, r));
                push(arg + angle, beta);
                push(arg - angle, beta);
            }
        }
    }
}

/// The angles between two bounds that are `angle` give or take whole turns.
fn lifts(angle: f64, bound: AngleLimit) -> impl Iterator<Item = f64> {
    let first = ((bound.min - angle) / TAU).ceil();
    let count = ((bound.max - angle) / TAU).floor() - first + 1.0;
    // As a cast: a negative count is none.
    (0..count as usize).map(move |i| angle + TAU * (first + i as f64))
}
