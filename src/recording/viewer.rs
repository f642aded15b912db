//! A viewer that a recording is streamed to: one that runs already, or one that is started.

use std::io::ErrorKind;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::rerun::{Client, LogMsg, ProxyUri, StreamState};
use thiserror::Error;

/// Address at which a viewer listens if nothing else is said.
pub const VIEWER_URL: &str = "rerun+http://127.0.0.1:9876/proxy";

/// Name of the program.
const PROGRAM: &str = "rerun";
/// How long a viewer that runs may take to answer.
const PATIENCE: Duration = Duration::from_secs(5);
/// How long a viewer that is started may take to answer; the first start after its installation is slow.
const START_PATIENCE: Duration = Duration::from_secs(30);
/// How long a viewer may take for the last rows.
const LAST_PATIENCE: Duration = Duration::from_secs(60);

/// Reasons why a viewer cannot be reached.
#[derive(Debug, Error)]
pub enum ViewerError {
    /// The address is none of a viewer.
    #[error("{url}: {why}: want an address such as {VIEWER_URL}")]
    Address {
        /// The address.
        url: String,
        /// Message of Rerun.
        why: String,
    },
    /// There is no viewer to start.
    #[error(
        "there is no program `{PROGRAM}` on the path: want `pip install rerun-sdk=={}`, or -o FILE.rrd",
        crate::rerun::CrateVersion::LOCAL
    )]
    Missing,
    /// The viewer does not start.
    #[error("`{PROGRAM}` does not start: {0}")]
    Start(#[source] std::io::Error),
    /// No viewer answers.
    #[error("{url}: no viewer answers within {} s: want one that runs, by `{PROGRAM}` or --spawn", waited.as_secs())]
    Silent {
        /// The address.
        url: String,
        /// How long it was waited.
        waited: Duration,
    },
    /// The viewer that was started does not answer.
    #[error(
        "`{PROGRAM}` was started, and does not answer within {} s: want a screen on which it can open a window, or \
         -o FILE.rrd",
        waited.as_secs()
    )]
    Unopened {
        /// How long it was waited.
        waited: Duration,
    },
    /// The viewer was closed before it had everything.
    #[error("{url}: the viewer was closed before it had the whole recording")]
    Closed {
        /// The address.
        url: String,
    },
}

/// A viewer.
#[derive(Clone, Debug, PartialEq)]
pub struct Viewer {
    uri: ProxyUri,
    patience: Duration,
    /// Whether this program has started it.
    is_started: bool,
}

impl Viewer {
    /// Returns the viewer that listens at an address.
    ///
    /// # Errors
    /// If the address is none of a viewer.
    pub fn at(url: &str) -> Result<Self, ViewerError> {
        let wrong = |why: String| ViewerError::Address { url: url.into(), why };
        let uri = url.parse().map_err(|why: crate::rerun::UriError| wrong(why.to_string()))?;
        Ok(Self { uri, patience: PATIENCE, is_started: false })
    }

    /// Starts the viewer; one that runs already is taken instead.
    ///
    /// # Errors
    /// If there is none on the path, or it does not start.
    pub fn started() -> Result<Self, ViewerError> {
        let mut command = Command::new(PROGRAM);
        command.args(["--expect-data-soon", "--detach-process"]);
        // It outlives this program, and what it says of itself is no message of this one.
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        match command.spawn() {
            Ok(_) => Ok(Self { patience: START_PATIENCE, is_started: true, ..Self::at(VIEWER_URL)? }),
            Err(why) if why.kind() == ErrorKind::NotFound => Err(ViewerError::Missing),
            Err(why) => Err(ViewerError::Start(why)),
        }
    }

    /// Returns the address.
    pub fn url(&self) -> String {
        self.uri.to_string()
    }

    /// Connects to the viewer.
    pub(super) fn connect(&self) -> Result<ViewerStream, ViewerError> {
        let options = crate::rerun::StreamOptions { connect_timeout_on_flush: self.patience, ..Default::default() };
        let client = Client::new(self.uri.clone(), options);
        let silent = |_| match self.is_started {
            true => ViewerError::Unopened { waited: self.patience },
            false => ViewerError::Silent { url: self.url(), waited: self.patience },
        };
        client.flush_blocking(2 * self.patience).map_err(silent)?;
        Ok(ViewerStream { client, url: self.url() })
    }
}

/// A connection to a viewer.
pub(super) struct ViewerStream {
    client: Client,
    url: String,
}

impl ViewerStream {
    /// Sends a message; waits while many are under way.
    pub(super) fn send(&self, message: LogMsg) -> Result<(), ViewerError> {
        self.client.send_blocking(message);
        match self.client.status() {
            StreamState::Disconnected(_) => Err(ViewerError::Closed { url: self.url.clone() }),
            StreamState::Connecting { .. } | StreamState::Connected => Ok(()),
        }
    }

    /// Waits until the viewer has everything.
    pub(super) fn finish(self) -> Result<(), ViewerError> {
        self.client.flush_blocking(LAST_PATIENCE).map_err(|_| ViewerError::Closed { url: self.url.clone() })
    }
}
