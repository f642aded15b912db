//! Notes: short texts that stick to a point or a place, to an instant or an interval of time, or to both.

use serde::{Deserialize, Serialize};

use super::bounds::MAX_TIME;
use super::snap_point::SnapPoint;
use stillbase_mechanics::machine::Machine;
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::shortened;
use stillbase_settings::text::control_character;

/// Maximum number of notes of a session.
pub const MAX_NOTES: usize = 100;

/// Maximum length of the text of a note, characters.
pub const MAX_NOTE: usize = 120;

/// Time before and after its instant during which a note stands in the scene, s; a film shows it for some pictures.
const INSTANT_MARGIN_S: f64 = 0.05;

/// Length of a text in titles, characters.
const TITLE_CHARS: usize = 40;

/// A short text.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// The text, one line.
    pub text: String,
    /// What it sticks to in the scene.
    pub point: Option<SnapPoint>,
    /// When it stands there.
    pub time: NoteTime,
}

/// Time to which a note sticks, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NoteTime {
    /// All times.
    #[default]
    Always,
    /// An instant.
    At(f64),
    /// From one instant to another.
    Between([f64; 2]),
}

/// A note as a file states it: `on`, `pin` or `at`, and `time` with or without `until`.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StatedNote {
    text: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    on: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pin: Option<Vec<String>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    at: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    time: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    until: Option<f64>,
}

impl From<Note> for StatedNote {
    fn from(note: Note) -> Self {
        let (time, until) = match note.time {
            NoteTime::Always => (None, None),
            NoteTime::At(time) => (Some(time), None),
            NoteTime::Between([from, to]) => (Some(from), Some(to)),
        };
        let stated = Self { text: note.text, time, until, ..Self::default() };
        match note.point {
            None => stated,
            Some(SnapPoint::Pin(links)) => Self { pin: Some(links), ..stated },
            Some(SnapPoint::Place(at)) => Self { at: Some(at), ..stated },
            Some(point) => Self { on: point.name(), ..stated },
        }
    }
}

impl StatedNote {
    fn read(self) -> Result<Note, String> {
        let point = match (self.on, self.pin, self.at) {
            (None, None, None) => None,
            (Some(name), None, None) => Some(SnapPoint::of_name(&name)?),
            (None, Some(links), None) => Some(SnapPoint::Pin(links)),
            (None, None, Some(at)) => Some(SnapPoint::Place(at)),
            _ => return Err("a note sticks to one point: want only one of on, pin and at".into()),
        };
        let time = match (self.time, self.until) {
            (None, None) => NoteTime::Always,
            (Some(time), None) => NoteTime::At(time),
            (Some(from), Some(to)) => NoteTime::Between([from, to]),
            (None, Some(_)) => return Err("until stands without time: want both for an interval".into()),
        };
        Ok(Note { text: self.text, point, time })
    }
}

impl NoteTime {
    /// Returns the first instant, s, if there is one.
    pub fn start(self) -> Option<f64> {
        match self {
            Self::Always => None,
            Self::At(time) | Self::Between([time, _]) => Some(time),
        }
    }

    /// Describes the time in a few words; empty for all times.
    fn words(self) -> String {
        match self {
            Self::Always => String::new(),
            Self::At(time) => format!(" at {time:.3} s"),
            Self::Between([from, to]) => format!(" from {from:.3} to {to:.3} s"),
        }
    }

    fn check(self) -> Result<(), String> {
        let (times, count): ([f64; 2], usize) = match self {
            Self::Always => return Ok(()),
            Self::At(time) => ([time; 2], 1),
            Self::Between(times) => (times, 2),
        };
        for (key, time) in [("time", times[0]), ("until", times[1])].into_iter().take(count) {
            if !(0.0..=MAX_TIME).contains(&time) {
                return Err(format!("{key} is {}: want a number from 0 to {MAX_TIME} s", ShortNumber(time)));
            }
        }
        match times {
            [from, to] if to < from => {
                Err(format!("until is {}: want at least time, {} s", ShortNumber(to), ShortNumber(from)))
            }
            _ => Ok(()),
        }
    }
}

impl Note {
    /// Returns whether it stands in the scene at an instant, s.
    pub fn is_shown_at(&self, now: f64) -> bool {
        let rounding = 1e-9;
        match self.time {
            NoteTime::Always => true,
            NoteTime::At(time) => (now - time).abs() <= INSTANT_MARGIN_S + rounding,
            NoteTime::Between([from, to]) => (from - rounding..=to + rounding).contains(&now),
        }
    }

    /// Describes the note in one line: its text, its point and its time.
    pub fn in_one_line(&self) -> String {
        let point = self.point.as_ref().map(|point| format!(", {}", point.title())).unwrap_or_default();
        format!("{}{point}{}", self.text, self.time.words())
    }

    /// Returns its text for titles, shortened.
    pub fn title(&self) -> String {
        shortened(&self.text, TITLE_CHARS)
    }

    /// Checks text, point and time; a pin must join links of the machine.
    ///
    /// # Errors
    /// If one of them is wrong; the error says what would be right.
    pub fn check(&self, machine: &Machine) -> Result<(), String> {
        let count = self.text.chars().count();
        if self.text.trim().is_empty() || count > MAX_NOTE {
            return Err(format!("text has {count} characters: want 1 to {MAX_NOTE}, not all of them spaces"));
        }
        // A note is one line.
        if let Some(c) = control_character(&self.text).or_else(|| self.text.chars().find(|c| *c == '\n')) {
            let code = u32::from(c);
            return Err(format!("text holds the control character U+{code:04X}: want printable characters"));
        }
        if self.point.is_none() && self.time == NoteTime::Always {
            return Err("a note sticks to something: want on, pin or at, or a time".into());
        }
        self.time.check()?;
        self.point.as_ref().map_or(Ok(()), |point| point.check(machine))
    }
}

/// Reads the notes of a file for a machine.
///
/// # Errors
/// If there are too many notes or one is wrong: the index of the first such note, and the reason.
pub(super) fn notes(stated: Vec<StatedNote>, machine: &Machine) -> Result<Vec<Note>, (usize, String)> {
    if stated.len() > MAX_NOTES {
        return Err((MAX_NOTES, format!("want at most {MAX_NOTES} notes")));
    }
    let read = |(i, stated): (usize, StatedNote)| {
        let note = stated.read().map_err(|why| (i, why))?;
        note.check(machine).map_err(|why| (i, why))?;
        Ok(note)
    };
    stated.into_iter().enumerate().map(read).collect()
}
