//! [`Device`]: the graphics device that a window draws on, and what the next one needs once it is lost.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use egui::epaint::{ImageDelta, TextureAtlas};
use egui::{Context, Event, PointerButton, TextureId, ViewportBuilder, ViewportCommand};

/// A device that is watched: it may go away at any time, with the card, its driver or a remote display.
pub struct Device {
    device: wgpu::Device,
    lost: Arc<AtomicBool>,
    ctx: Context,
    /// Where the window stood, once it has been asked to close.
    place: Option<ViewportBuilder>,
}

/// What a lost device leaves to the next one.
pub struct Left {
    /// All that egui knows, with the letters to be sent to the next device.
    pub ctx: Context,
    /// Where the window stood.
    pub place: ViewportBuilder,
    /// What the hand did that the next window will not see.
    pub events: Vec<Event>,
}

impl Device {
    /// Watches the device that draws what a context shows.
    pub fn watched(device: &wgpu::Device, ctx: &Context) -> Self {
        let lost = Arc::new(AtomicBool::new(false));
        let (tells, wakes) = (lost.clone(), ctx.clone());
        device.set_device_lost_callback(move |_, _| {
            tells.store(true, Ordering::Release);
            wakes.request_repaint();
        });
        let knows = lost.clone();
        // What is asked of a lost device fails in many ways, and none of them matters.
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            assert!(knows.load(Ordering::Acquire), "wgpu error: {error}");
        }));
        Self { device: device.clone(), lost, ctx: ctx.clone(), place: None }
    }

    /// Whether it is gone.
    pub fn is_lost(&self) -> bool {
        self.lost.load(Ordering::Acquire)
    }

    /// Takes it away, as a driver would: for tests.
    pub fn destroy(&self) {
        self.device.destroy();
        // It is lost when all that was asked of it before is done.
        let _ = self.device.poll(wgpu::PollType::wait_indefinitely());
    }

    /// Asks the window to close.
    pub fn leave(&mut self) {
        if self.place.is_none() {
            self.place = Some(self.ctx.input(place));
            self.ctx.send_viewport_cmd(ViewportCommand::Close);
        }
        self.ctx.request_repaint();
    }

    /// What the next one needs.
    pub fn left(self) -> Left {
        let ctx = self.ctx;
        let letters = ctx.fonts(|fonts| fonts.image());
        let all = ImageDelta::full(letters, TextureAtlas::texture_options());
        ctx.tex_manager().write().set(TextureId::default(), all);
        let events = ctx.input(|i| {
            let at = i.pointer.latest_pos().or(i.pointer.interact_pos()).unwrap_or_default();
            let up = |button| Event::PointerButton { pos: at, button, pressed: false, modifiers: i.modifiers };
            let buttons = [PointerButton::Primary, PointerButton::Secondary, PointerButton::Middle];
            buttons.into_iter().filter(|button| i.pointer.button_down(*button)).map(up).collect()
        });
        Left { place: self.place.unwrap_or_default(), events, ctx }
    }
}

/// Where the window stands and how large it is.
fn place(input: &egui::InputState) -> ViewportBuilder {
    let window = input.viewport();
    let mut place = ViewportBuilder::default();
    if let Some(inner) = window.inner_rect {
        place = place.with_inner_size(inner.size());
    }
    if let Some(outer) = window.outer_rect {
        place = place.with_position(outer.min);
    }
    place.with_maximized(window.maximized == Some(true)).with_fullscreen(window.fullscreen == Some(true))
}
