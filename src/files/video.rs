//! [`Mp4File`]: an MP4 film, which the program `ffmpeg` of the system encodes.

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::JoinHandle;

use super::{NewFile, WriteError};

/// Name of the program that encodes.
const ENCODER: &str = "ffmpeg";

/// Why an MP4 film was not written.
#[derive(Debug, thiserror::Error)]
pub enum VideoError {
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// There is no encoder.
    #[error(
        "MP4 is written by the program ffmpeg, which is not on the PATH: install it (`apt-get install ffmpeg`, `brew \
         install ffmpeg`, `winget install ffmpeg`), or want a name that ends in .gif, .png or .webp, which need nothing"
    )]
    NoEncoder,
    /// The encoder failed.
    #[error("{}: ffmpeg failed: {why}: want a name that ends in .gif, .png or .webp", file.display())]
    Encoder {
        /// The film.
        file: PathBuf,
        /// What the encoder said.
        why: String,
    },
}

/// Returns whether the encoder is on the PATH.
pub fn has_encoder() -> bool {
    let mut asks = Command::new(ENCODER);
    asks.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    asks.status().is_ok_and(|status| status.success())
}

/// A film that is being encoded. [`finish`](Self::finish) gives it its name; if it is dropped before, nothing remains.
pub struct Mp4File {
    out: NewFile,
    encoder: Encoder,
}

/// The running encoder, which is ended when it is dropped.
struct Encoder {
    child: Child,
    pixels: Option<ChildStdin>,
    /// Reads what the encoder says.
    said: Option<JoinHandle<String>>,
}

impl Drop for Encoder {
    fn drop(&mut self) {
        // It has ended already if the film is whole.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Mp4File {
    /// Begins a film of pictures of a size in pixels, at `fps` pictures per second.
    ///
    /// # Errors
    /// If the file cannot be created, or the encoder is missing or cannot be started.
    pub fn create(file: &Path, force: bool, [width, height]: [u32; 2], fps: f64) -> Result<Self, VideoError> {
        let out = NewFile::create(file, force)?;
        let mut target = std::ffi::OsString::from("file:");
        target.push(out.draft_path());
        let mut command = Command::new(ENCODER);
        command.args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgba"]);
        command.args(["-video_size", &format!("{width}x{height}"), "-framerate", &fps.to_string(), "-i", "pipe:0"]);
        // Players want even sides and colours at half the resolution.
        command.args(["-an", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]);
        command.args(["-movflags", "+faststart", "-f", "mp4"]).arg(target);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => VideoError::NoEncoder,
            _ => VideoError::Encoder { file: file.into(), why: error.to_string() },
        })?;
        let pixels = child.stdin.take();
        let said = child.stderr.take().map(|mut said| {
            std::thread::spawn(move || {
                let mut text = Vec::new();
                // What cannot be read is missing from the message only.
                let _ = said.read_to_end(&mut text);
                String::from_utf8_lossy(&text).into_owned()
            })
        });
        Ok(Self { out, encoder: Encoder { child, pixels, said } })
    }

    /// Adds a picture: four bytes for each pixel, red, green, blue and alpha, in rows from the top.
    ///
    /// # Errors
    /// If the encoder has failed.
    pub fn push(&mut self, rgba: &[u8]) -> Result<(), VideoError> {
        let sent = self.encoder.pixels.as_mut().map_or(Ok(()), |pixels| pixels.write_all(rgba));
        sent.map_err(|error| self.failed(&error.to_string()))
    }

    /// Ends the film and gives the file its name.
    ///
    /// # Errors
    /// If the encoder has failed, or if the file cannot take its name.
    pub fn finish(mut self) -> Result<(), VideoError> {
        // The end of its input ends the encoder.
        self.encoder.pixels = None;
        let status = self.encoder.child.wait();
        match status {
            Ok(status) if status.success() => Ok(self.out.finish()?),
            Ok(status) => Err(self.failed(&status.to_string())),
            Err(error) => Err(self.failed(&error.to_string())),
        }
    }

    /// Returns the failure with the last line that the encoder said, or else with `otherwise`.
    fn failed(&mut self, otherwise: &str) -> VideoError {
        self.encoder.pixels = None;
        let _ = self.encoder.child.kill();
        let said = self.encoder.said.take().and_then(|said| said.join().ok()).unwrap_or_default();
        let line = said.lines().rev().map(str::trim).find(|line| !line.is_empty());
        VideoError::Encoder { file: self.out.path().into(), why: line.unwrap_or(otherwise).to_owned() }
    }
}
