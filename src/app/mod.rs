//! The user interface: panels, plots and the viewport. It draws the same pixels in a window, in a test and in a figure.
//!
//! The panels read a [`Session`](crate::session::Session) and return [`Command`]s. The [`AppState`] carries them out at
//! the end of the pass. Nothing is computed here.

pub mod actions;
mod activity;
mod arrangement;
mod background;
mod card;
mod change;
mod command;
mod compare;
mod coordinates;
mod corner;
mod facts;
mod file_dialog;
mod finder;
mod framing;
mod gallery;
mod gesture;
mod given;
mod hand;
mod history;
mod icon;
mod intro;
pub mod jobs;
mod keys;
mod layout;
mod left_off;
mod marks;
mod menu;
mod open;
mod order;
mod pace;
mod path;
mod place;
mod plots;
mod preferences;
mod present;
mod rail;
mod said;
mod saving;
mod search;
mod side;
mod state;
mod status;
mod studio;
mod study;
mod theme;
mod timeline;
mod top;
mod tour;
mod view_change;
mod view_state;
mod viewport;
mod waiting;
mod widgets;
#[cfg(feature = "window")]
pub mod window;

pub use activity::Activity;
pub use command::{
    Command, ComparisonCommand, FrontsCommand, Look, Recovery, SessionCommand, Switch, ViewChange, WindowCommand,
};
pub use file_dialog::{FileDialog, PlotFile, Purpose};
pub use gesture::{Gesture, Pointed, Tool};
pub use given::assess::{TableContent, TableOptions, Taking};
use intro::Intro;
pub use layout::{Arrangement, Below, Layout, Panel, Panels};
pub use left_off::LeftOff;
pub use open::{Finder, Open};
pub use preferences::Preferences;
pub use said::{RefusedEdit, Said};
pub use state::AppState;
use view_state::set_b;
pub use view_state::{Framing, ViewState};
pub use waiting::Drawing;
