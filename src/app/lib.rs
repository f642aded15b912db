//! The user interface: panels, plots and the viewport. It draws the same pixels in a window, in a test and in a figure.
//!
//! This crate serves the workspace alone, and may change in any version.
//!
//! The panels read a [`Session`](stillbase_session::Session) and return [`Command`]s, which the [`AppState`] carries
//! out at the end of the pass. Nothing is computed here.

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
pub mod export;
mod facts;
mod file_dialog;
mod file_menu;
mod file_report;
mod finder;
mod fit;
mod focus;
mod framing;
mod gallery;
mod gesture;
mod given;
mod guide;
mod history;
mod icon;
mod intro;
pub mod jobs;
mod keys;
mod lamp;
mod layout;
mod marks;
mod measuring;
mod menu;
mod notation;
mod notes;
mod open;
mod order;
mod own_files;
mod pace;
mod pair;
mod path;
mod place;
mod plots;
mod pointing;
mod preferences;
mod present;
mod rail;
mod resume_point;
mod saved_runs;
mod saving;
mod scene_pointer;
mod search;
mod shot;
mod side;
mod sketching;
mod state;
mod status;
mod status_message;
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
mod watched_file;
mod widgets;
#[cfg(feature = "window")]
pub mod window;

pub use activity::Activity;
pub use command::{
    CameraMove, Command, ComparisonCommand, FrontsCommand, Recovery, SessionCommand, Switch, ViewChange, WindowCommand,
};
pub use file_dialog::{FileDialog, FilePurpose, PlotFile};
pub use file_report::FileReport;
pub use gesture::{DragGesture, HoverTarget, Tool};
pub use given::assess::{TableAction, TableContent, TableOptions};
pub use guide::{GuidePlace, GuideStep, GuideView, Page as GuidePage};
use intro::Intro;
pub use layout::{BottomPanel, Layout, Panel, Panels, WindowArrangement};
pub use notes::NoteDraft;
pub use open::{Finder, OpenDialogs};
pub use pair::{Pair, PairWith};
pub use plots::{MIN_PLOT_WINDOW_PT, PlotWindow};
pub use preferences::Preferences;
pub use resume_point::ResumePoint;
pub use saving::LeftSession;
pub use shot::{PictureOrder, Shot};
pub use sketching::{Pen, PenChange, PenTool};
pub use state::AppState;
pub use status_message::{Message, RefusedEdit, StatusMessage};
use view_state::set_b;
pub use view_state::{Framing, ViewState};
pub use waiting::DrawingGuard;
