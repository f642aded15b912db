//! [`Times`]: display of repaint times.

use std::time::{Duration, Instant};

use egui::{Align2, Area, Frame, Id, Margin, Order, RichText, vec2};

use crate::theme::{colour, plain};
use stillbase_picture::scene::palette::Palette;

/// Times of repaints, averaged over the last few.
#[derive(Default)]
pub struct Times {
    /// Time from one repaint to the next, without pauses, s.
    interval: f64,
    /// Time that the program takes to determine what to draw, s.
    interface: f64,
    begun: Option<Instant>,
    follows: bool,
    /// Text on display, and since when: text that changes at every repaint could not be read.
    shown: Option<(String, Instant)>,
}

/// Longer gaps between repaints are pauses, and are not counted.
const MIN_PAUSE: Duration = Duration::from_millis(400);
/// Minimum time for which a text stays.
const MIN_TEXT_DURATION: Duration = Duration::from_millis(300);
/// Weight of the newest value in the average.
const NEWEST_WEIGHT: f64 = 0.1;

impl Times {
    /// Records the beginning of a repaint.
    pub fn begin(&mut self, now: Instant) {
        let interval = self.begun.map(|begun| now - begun).filter(|interval| *interval < MIN_PAUSE);
        if let Some(interval) = interval {
            blend(&mut self.interval, interval.as_secs_f64());
        }
        self.follows = interval.is_some();
        self.begun = Some(now);
    }

    /// Records that the shapes of a repaint are complete.
    pub fn end(&mut self, now: Instant) {
        // The first repaint is left out, because it loads the fonts; so is the first one after each pause.
        if let Some(begun) = self.begun.filter(|_| self.follows) {
            blend(&mut self.interface, (now - begun).as_secs_f64());
        }
    }

    /// Draws the times at the bottom of the window, above the status line.
    pub fn show(&mut self, ctx: &egui::Context, p: &Palette, now: Instant) {
        if self.shown.as_ref().is_none_or(|(_, since)| now - *since > MIN_TEXT_DURATION) {
            let rate = if self.interval > 0.0 { 1.0 / self.interval } else { 0.0 };
            let [apart, interface] = [self.interval, self.interface].map(|t| 1e3 * t);
            let text =
                format!("a frame every {apart:.1} ms, {rate:.0} a second; {interface:.1} ms of it for the interface");
            self.shown = Some((text, now));
        }
        let Some((text, _)) = &self.shown else { return };
        let frame = Frame::new().fill(colour(p.panel)).stroke((1.0, colour(p.line))).corner_radius(6);
        Area::new(Id::unique("times of repaints"))
            .order(Order::Foreground)
            .interactable(false)
            .anchor(Align2::CENTER_BOTTOM, vec2(0.0, -38.0))
            .show(ctx, |ui| {
                frame.inner_margin(Margin::symmetric(10, 5)).show(ui, |ui| {
                    ui.label(RichText::new(text).font(plain(12.0)).color(colour(p.ink)));
                });
            });
    }
}

fn blend(average: &mut f64, newest: f64) {
    *average = if *average > 0.0 { *average + NEWEST_WEIGHT * (newest - *average) } else { newest };
}
