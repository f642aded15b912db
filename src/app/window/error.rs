//! [`WindowError`]: why there is no window, and what to install.

use std::path::{Path, PathBuf};

use thiserror::Error;

use stillbase_picture::render::offscreen::{Gpu, NoAdapter};
use stillbase_session::Refusal;

/// The reason why there is no window.
#[derive(Debug, Error)]
pub enum WindowError {
    /// No display server responds.
    #[error("no display: {0}")]
    NoDisplay(String),
    /// A library required by the window system is missing.
    #[error("the window needs {library}: install it with `{install}`")]
    MissingLibrary {
        /// File name of the library.
        library: &'static str,
        /// Command that installs it on Debian.
        install: &'static str,
    },
    /// The scenario cannot start.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// No graphics adapter can draw on the display.
    #[error("the window cannot be drawn: {0}")]
    NoAdapter(String),
    /// The window system failed.
    #[error("the window could not be opened: {0}")]
    Failed(String),
    /// The graphics device was lost while the window was open, and could not be replaced.
    #[error("the graphics device was lost: {why}; {}", kept_in(.kept.as_deref()))]
    DeviceLost {
        /// Why the device could not be replaced.
        why: String,
        /// File of the journal of the session, if there were changes.
        kept: Option<PathBuf>,
    },
}

fn kept_in(kept: Option<&Path>) -> String {
    match kept {
        Some(file) => format!("what was done is in {}, and the next start offers it", file.display()),
        None => "every change is in a file".into(),
    }
}

/// Returns the reason why nothing could be drawn on an existing display.
pub(super) fn what_is_missing() -> String {
    // SAFETY: this is the loader of the graphics drivers, which wgpu tried a moment ago in the same way. Its
    // initialisers only set up its own state.
    if cfg!(target_os = "linux") && unsafe { libloading::Library::new("libvulkan.so.1") }.is_err() {
        return "libvulkan.so.1 is missing: install it with `apt-get install libvulkan1`".into();
    }
    match Gpu::new() {
        // The list of drivers that were tried would not help the user.
        Err(NoAdapter::Missing(_)) => "no graphics driver answers; on Debian and the like a software one comes with \
                                       `apt-get install mesa-vulkan-drivers`"
            .into(),
        Err(other) => other.to_string(),
        Ok(gpu) => format!("the GPU adapter {} cannot draw on this display", gpu.name()),
    }
}

/// Checks the libraries that X11 needs: a missing one would end the program without a clear message.
pub(super) fn check_libraries() -> Result<(), WindowError> {
    let x11 = cfg!(target_os = "linux")
        && std::env::var_os("WAYLAND_DISPLAY").is_none()
        && std::env::var_os("DISPLAY").is_some();
    if !x11 {
        return Ok(());
    }
    for (library, install) in [
        ("libxkbcommon-x11.so.0", "apt-get install libxkbcommon-x11-0"),
        ("libXcursor.so.1", "apt-get install libxcursor1"),
        ("libXi.so.6", "apt-get install libxi6"),
    ] {
        // SAFETY: these are system libraries that the window system loads a moment later in the same way. Their
        // initialisers only set up their own state.
        if unsafe { libloading::Library::new(library) }.is_err() {
            return Err(WindowError::MissingLibrary { library, install });
        }
    }
    Ok(())
}
