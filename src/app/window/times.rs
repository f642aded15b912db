//! [`Times`]: what a repaint takes, for whoever asks.

use std::time::{Duration, Instant};

use egui::{Align2, Area, Frame, Id, Margin, Order, RichText, vec2};

use crate::app::theme::{colour, plain};
use crate::picture::scene::palette::Palette;

/// Times of repaints, averaged over the last few.
#[derive(Default)]
pub struct Times {
    /// From one repaint to the next, while they follow each other, s.
    apart: f64,
    /// What the program takes to say what is to be drawn, s.
    interface: f64,
    begun: Option<Instant>,
    follows: bool,
    /// What is shown, and since when: figures that change at every repaint cannot be read.
    shown: Option<(String, Instant)>,
}

/// Repaints further apart than this had nothing to show in between.
const REST: Duration = Duration::from_millis(400);
const READABLE: Duration = Duration::from_millis(300);
/// Share of the newest in the average.
const NEWEST: f64 = 0.1;

impl Times {
    /// A repaint begins.
    pub fn begin(&mut self, now: Instant) {
        let apart = self.begun.map(|begun| now - begun).filter(|apart| *apart < REST);
        if let Some(apart) = apart {
            blend(&mut self.apart, apart.as_secs_f64());
        }
        self.follows = apart.is_some();
        self.begun = Some(now);
    }

    /// All is said that is to be drawn.
    pub fn end(&mut self, now: Instant) {
        // The first one reads the fonts.
        if let Some(begun) = self.begun.filter(|_| self.follows) {
            blend(&mut self.interface, (now - begun).as_secs_f64());
        }
    }

    /// Draws them at the bottom of the window, above the status.
    pub fn show(&mut self, ctx: &egui::Context, p: &Palette, now: Instant) {
        if self.shown.as_ref().is_none_or(|(_, since)| now - *since > READABLE) {
            let rate = if self.apart > 0.0 { 1.0 / self.apart } else { 0.0 };
            let [apart, interface] = [self.apart, self.interface].map(|t| 1e3 * t);
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
    *average = if *average > 0.0 { *average + NEWEST * (newest - *average) } else { newest };
}
