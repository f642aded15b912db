//! Sets, renames and removes bookmarks of a session; each of these changes can be undone.

use std::sync::Arc;

use super::Session;
use super::change::HistoryStep;
use crate::document::AnnotationKind;
use crate::scenario::{Bookmark, MAX_BOOKMARKS, MAX_NAME};
use stillbase_query::Shared;
use stillbase_settings::range::shortened;

impl Session {
    /// Returns the bookmarks in the order of time.
    pub fn bookmarks(&self) -> &[Bookmark] {
        &self.document.bookmarks
    }

    /// Returns the bookmarks as a shared value.
    pub fn shared_bookmarks(&self) -> Shared<Vec<Bookmark>> {
        Shared(self.document.bookmarks.clone())
    }

    /// Returns the bookmark at an instant, s, to within half a step.
    pub fn bookmark_at(&self, time: f64) -> Option<&Bookmark> {
        let near = 0.5 * self.scenario().step;
        self.bookmarks().iter().find(|mark| (mark.time - time).abs() < near)
    }

    /// Returns a name that no bookmark has, such as `bookmark 1`.
    pub fn free_name(&self) -> String {
        let name = |n: usize| format!("bookmark {n}");
        let free = |n: &usize| self.bookmarks().iter().all(|mark| mark.name != name(*n));
        name((1..).find(free).unwrap_or_default())
    }

    /// Sets a bookmark at an instant, s, or renames the one there; an empty name removes it. Returns a description of
    /// the change, if there is one.
    ///
    /// # Errors
    /// If there are [`MAX_BOOKMARKS`] already; then nothing has changed.
    pub fn bookmark(&mut self, time: f64, name: &str) -> Result<Option<String>, String> {
        let known = self.bookmark_at(time).cloned();
        let name = shortened(name.trim(), MAX_NAME - 1);
        let mut bookmarks = self.document.bookmarks.to_vec();
        bookmarks.retain(|mark| Some(mark) != known.as_ref());
        let title = match (&known, name.is_empty()) {
            (None, true) => return Ok(None),
            (Some(known), false) if known.name == name => return Ok(None),
            (None, false) if bookmarks.len() >= MAX_BOOKMARKS => {
                return Err(format!("there are {MAX_BOOKMARKS} bookmarks: take one away first"));
            }
            (Some(known), true) => format!("remove {}", known.name),
            (Some(known), false) => format!("rename {} to {name}", known.name),
            (None, false) => format!("{name} at {time:.3} s"),
        };
        if !name.is_empty() {
            let time = known.map_or(time, |known| known.time);
            let at = bookmarks.partition_point(|mark| mark.time <= time);
            bookmarks.insert(at, Bookmark { time, name });
        }
        self.change_beside(title.clone(), AnnotationKind::Bookmarks, |document| {
            document.bookmarks = Arc::new(bookmarks)
        });
        Ok(Some(title))
    }

    /// Changes bookmarks, notes or branches without changing the run.
    pub(super) fn change_beside(
        &mut self,
        title: String,
        kept: AnnotationKind,
        change: impl FnOnce(&mut super::Document),
    ) {
        self.end_gesture();
        let before = self.document.clone();
        change(&mut self.document);
        self.redo.clear();
        self.undo.push(Arc::new(HistoryStep { before, edit: None, inverse: None, title, annotation: Some(kept) }));
    }
}
