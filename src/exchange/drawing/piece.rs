//! [`Piece`]: one link, or one part of it, with its annotations.

use super::lines::{below, below_link, below_part, mm, signed, sorted, weights_of, width_of};
use super::outline::{Corner, PieceOutline, weight_corners};
use super::sheet::{SheetShape, TextAlign, TextEmphasis};
use crate::cut::{Cut, SAME_PIN_DISTANCE, bar_extent};
use stillbase_mechanics::machine::Machine;
use stillbase_settings::number::fixed;

/// Distance between lines of text, as a multiple of their height.
const LINE_SPACING: f64 = 1.7;

/// The drawing of a link with its annotations, with the link's root as origin.
pub struct Piece {
    /// Its shapes.
    pub shapes: Vec<SheetShape>,
    /// Its extent: left, bottom, right and top, mm.
    pub reach: [f64; 4],
    /// The layer of its link.
    layer: Option<usize>,
}

impl Piece {
    pub fn of(machine: &Machine, cut: &Cut, (j, layer): (usize, Option<usize>), height: f64) -> Self {
        let mut piece = Self { shapes: Vec::new(), reach: [0.0; 4], layer };
        let part = &machine.resolved_links()[j];
        let holes = machine.pin_places(j);
        piece.bar(cut, part.drive, bar_extent(machine, j));
        piece.discs(machine, j);
        for at in &holes {
            piece.shapes.push(SheetShape::Hole { at: [1e3 * at, 0.0], radius: 500.0 * cut.pin_diameter, layer });
        }
        piece.centre_of_mass(machine, j, height);
        piece.stations(&holes, part.length, height);
        piece.annotate(machine, j, "", below(machine, cut, j), height);
        piece
    }

    /// Draws one part of a link; the first one shows what belongs to the whole link.
    pub fn of_part(
        machine: &Machine,
        cut: &Cut,
        (j, layer): (usize, Option<usize>),
        outline: &PieceOutline,
        first: bool,
        height: f64,
    ) -> Self {
        let mut piece = Self { shapes: Vec::new(), reach: [0.0; 4], layer };
        let link = &machine.resolved_links()[j];
        let in_mm = |at: [f64; 2]| at.map(|x| 1e3 * x);
        let corners: Vec<Corner> =
            outline.corners.iter().map(|corner| Corner { at: in_mm(corner.at), ..*corner }).collect();
        for (corner, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let [x, y] = corner.at;
            // A half circle reaches as far beyond its ends as its radius.
            let round = 0.5 * corner.bulge.abs() * (next.at[0] - x).hypot(next.at[1] - y);
            piece.include([x - round, y, x + round, y]);
        }
        piece.shapes.push(SheetShape::Outline { corners, drive: link.drive, layer });
        if first {
            piece.discs(machine, j);
        }
        for (at, diameter) in &outline.holes {
            piece.shapes.push(SheetShape::Hole { at: in_mm(*at), radius: 500.0 * diameter, layer });
        }
        if first {
            piece.centre_of_mass(machine, j, height);
        }
        let places: Vec<f64> = outline.holes.iter().map(|([at, _], _)| *at).collect();
        piece.stations(&sorted(places), link.length, height);
        let part = &machine.spec().parts[outline.part];
        let mut lines = below_part(machine, outline);
        if first {
            lines.extend(below_link(machine, cut, j));
        }
        piece.annotate(machine, j, &format!(" · {}", part.title()), lines, height);
        piece
    }

    fn discs(&mut self, machine: &Machine, j: usize) {
        let drive = machine.resolved_links()[j].drive;
        let layer = self.layer;
        for weight in weights_of(machine, j) {
            let ([from, to], radius) = weight.around();
            let [x, y] = [[from.re, to.re], [from.im, to.im]].map(|ends| ends.map(|x| 1e3 * x));
            let radius = 1e3 * radius;
            self.include([x[0] - radius, y[0] - radius, x[1] + radius, y[1] + radius]);
            let corners = weight_corners(weight);
            if !corners.is_empty() {
                let corners = corners.into_iter().map(|Corner { at, bulge }| Corner { at: at.map(|x| 1e3 * x), bulge });
                self.shapes.push(SheetShape::Weight { corners: corners.collect(), drive, layer });
            } else if radius > 0.0 {
                let inner_radius = 1e3 * weight.inner_radius;
                self.shapes.push(SheetShape::Disc { at: [x[0], y[0]], radius, inner_radius, drive, layer });
            }
        }
    }

    fn centre_of_mass(&mut self, machine: &Machine, j: usize, height: f64) {
        let link = &machine.links()[j];
        let com = [1e3 * link.com, 1e3 * link.com_normal];
        let radius = 0.55 * height;
        self.include([com[0] - radius, com[1] - radius, com[0] + radius, com[1] + radius]);
        if self.shapes.first().is_some_and(|bar| !bar.is_around(com)) {
            // A line shows to which link the mark belongs.
            self.shapes.push(SheetShape::Line([[0.0, 0.0], com]));
        }
        self.shapes.push(SheetShape::Mark { at: com, radius });
    }

    fn include(&mut self, [left, down, right, up]: [f64; 4]) {
        let [l, d, r, u] = self.reach;
        self.reach = [l.min(left), d.min(down), r.max(right), u.max(up)];
    }

    fn bar(&mut self, cut: &Cut, drive: usize, [from, to]: [f64; 2]) {
        let (radius, layer) = (500.0 * cut.bar_width, self.layer);
        self.include([1e3 * from - radius, -radius, 1e3 * to + radius, radius]);
        self.shapes.push(SheetShape::Bar { from: [1e3 * from, 0.0], length: 1e3 * (to - from), radius, drive, layer });
    }

    /// Draws the dimension line with the distances between neighbouring holes, and to the tip.
    fn stations(&mut self, holes: &[f64], tip: f64, height: f64) {
        let mut stations = holes.to_vec();
        if stations.iter().all(|at| (at - tip).abs() > SAME_PIN_DISTANCE) {
            stations.push(tip);
            stations.sort_by(f64::total_cmp);
        }
        let line = self.reach[1] - 2.6 * height;
        for at in &stations {
            let x = 1e3 * at;
            self.shapes.push(SheetShape::Line([[x, line - 0.5 * height], [x, line + 0.5 * height]]));
        }
        for pair in stations.windows(2) {
            let [from, to] = [1e3 * pair[0], 1e3 * pair[1]];
            self.shapes.push(SheetShape::Line([[from, line], [to, line]]));
            let text = mm(pair[1] - pair[0]);
            if width_of(&text, height) < to - from {
                self.words(
                    [0.5 * (from + to), line + 0.45 * height],
                    height,
                    TextAlign::Middle,
                    TextEmphasis::Plain,
                    text,
                );
            }
        }
        self.include([0.0, line - 0.5 * height, 0.0, 0.0]);
    }

    fn words(&mut self, at: [f64; 2], height: f64, anchor: TextAlign, paint: TextEmphasis, text: String) {
        self.shapes.push(SheetShape::Words { at, height, anchor, paint, text });
    }

    /// Writes the link's name above the piece, with `what` it is, and lines of data below.
    fn annotate(&mut self, machine: &Machine, j: usize, what: &str, lines: Vec<String>, height: f64) {
        let link = &machine.spec().links[j];
        let drive = &link.drive;
        let (left, top) = (self.reach[0], self.reach[3] + 1.1 * height);
        let name = format!("link {}{what}", link.name);
        let about = format!("follows drive {drive} · {} kg · {} kg m²", fixed(link.mass, 3), fixed(link.inertia, 6));
        let shift = width_of(&name, 1.3 * height) + height;
        self.words([left, top], 1.3 * height, TextAlign::Start, TextEmphasis::Strong, name);
        self.words([left + shift, top], height, TextAlign::Start, TextEmphasis::Plain, about.clone());
        self.include([left, 0.0, left + shift + width_of(&about, height), top + 1.3 * height]);
        let stacked = self.layer.map(|layer| format!("layer {layer}, {} mm high", signed(link.axial)));
        for line in stacked.into_iter().chain(lines) {
            let at = [left, self.reach[1] - LINE_SPACING * height];
            self.include([left, at[1] - 0.3 * height, left + width_of(&line, height), 0.0]);
            self.words(at, height, TextAlign::Start, TextEmphasis::Plain, line);
        }
    }
}
