//! [`Waker`]: asks for a repaint once the file of the session changes, so that an idle window need not look.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use stillbase_files::stamp::FileStamp;

/// Watches a file on a thread that otherwise sleeps.
#[derive(Default)]
pub struct Waker {
    /// The file; the thread ends once nobody else holds it.
    file: Option<Arc<Mutex<Option<PathBuf>>>>,
}

/// Time between two looks at the file, and number of repaints after a change: the window waits until the file rests.
const INTERVAL: Duration = Duration::from_secs(1);
const REPAINTS: u32 = 4;

impl Waker {
    /// Watches a file from now on, or none.
    pub fn follow(&mut self, ctx: &egui::Context, file: Option<&Path>) {
        match &self.file {
            Some(shared) => {
                let mut known = shared.lock().unwrap_or_else(PoisonError::into_inner);
                if known.as_deref() != file {
                    *known = file.map(Path::to_owned);
                }
            }
            None if file.is_some() => {
                let shared = Arc::new(Mutex::new(file.map(Path::to_owned)));
                let (weak, ctx) = (Arc::downgrade(&shared), ctx.clone());
                let watch = move || {
                    let (mut last, mut repaints) = (None, 0);
                    loop {
                        thread::sleep(INTERVAL);
                        let Some(shared) = weak.upgrade() else { return };
                        let file = shared.lock().unwrap_or_else(PoisonError::into_inner).clone();
                        let now = file.as_deref().map(|file| (file.to_owned(), FileStamp::of(file)));
                        if now != last {
                            (last, repaints) = (now, REPAINTS);
                        }
                        if repaints > 0 {
                            repaints -= 1;
                            ctx.request_repaint();
                        }
                    }
                };
                // Without a thread, the file is looked at whenever the window repaints.
                if thread::Builder::new().name("file".into()).spawn(watch).is_ok() {
                    self.file = Some(shared);
                }
            }
            None => {}
        }
    }
}
