//! The user's units and names while a pass draws: panels ask for them here.

use std::borrow::Cow;

use egui::{Context, Id};

use stillbase_picture::notation::Notation;

fn id() -> Id {
    Id::unique("notation")
}

/// Sets the notation of the passes that follow.
pub fn set(ctx: &Context, notation: Notation) {
    ctx.data_mut(|data| data.insert_temp(id(), notation));
}

/// Returns the notation of the pass.
pub fn of(ctx: &Context) -> Notation {
    ctx.data(|data| data.get_temp(id())).unwrap_or_default()
}

/// Returns a sentence with its angles and lengths in the user's units.
pub fn sentence<'a>(ctx: &Context, text: &'a str) -> Cow<'a, str> {
    of(ctx).sentence(text)
}
