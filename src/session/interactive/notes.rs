//! Writes, changes and removes notes of a session; each of these changes can be undone.

use std::sync::Arc;

use super::Session;
use crate::document::AnnotationKind;
use crate::scenario::{MAX_NOTES, Note};
use stillbase_query::Shared;

impl Session {
    /// Returns the notes in the order in which they were written.
    pub fn notes(&self) -> &[Note] {
        &self.document.notes
    }

    /// Returns the notes as a shared value.
    pub fn shared_notes(&self) -> Shared<Vec<Note>> {
        Shared(self.document.notes.clone())
    }

    /// Writes a note in place of the one with the index `known`, or a new one. Returns a description of the change, if
    /// there is one.
    ///
    /// # Errors
    /// If the note is wrong, or there are [`MAX_NOTES`] already; then nothing has changed.
    pub fn write_note(&mut self, known: Option<usize>, note: Note) -> Result<Option<String>, String> {
        let note = Note { text: note.text.trim().to_owned(), ..note };
        note.check(&self.scenario().machine)?;
        let mut notes = self.document.notes.to_vec();
        let title = match known.filter(|i| *i < notes.len()) {
            Some(i) if notes[i] == note => return Ok(None),
            Some(i) => {
                let title = format!("change note: {}", note.title());
                notes[i] = note;
                title
            }
            None if notes.len() >= MAX_NOTES => {
                return Err(format!("there are {MAX_NOTES} notes: remove one first"));
            }
            None => {
                let title = format!("note: {}", note.title());
                notes.push(note);
                title
            }
        };
        Ok(Some(self.set_notes(notes, title)))
    }

    /// Removes the note with an index. Returns a description of the change, if there is such a note.
    pub fn remove_note(&mut self, index: usize) -> Option<String> {
        let mut notes = self.document.notes.to_vec();
        if index >= notes.len() {
            return None;
        }
        let title = format!("remove note: {}", notes.remove(index).title());
        Some(self.set_notes(notes, title))
    }

    fn set_notes(&mut self, notes: Vec<Note>, title: String) -> String {
        self.change_beside(title.clone(), AnnotationKind::Notes, |document| document.notes = Arc::new(notes));
        title
    }
}
