//! [`ImportError`]: the reason why a file cannot be imported as a machine.

use std::ops::Range;

use roxmltree::Node;

use stillbase_settings::fault::Fault;
use stillbase_settings::range::{quote_clipped, shortened};

/// Error in a file, with its place.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{element}{what}: want {want}", line.map(|line| format!("line {line}: ")).unwrap_or_default())]
pub struct ImportError {
    /// Byte offset of the element.
    at: Option<usize>,
    line: Option<usize>,
    element: String,
    what: String,
    want: String,
    /// What may stand in the text instead, so that the rest of the file can be judged.
    mend: Option<Mend>,
}

/// A replacement in the text of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mend {
    /// The bytes that are replaced.
    pub span: Range<usize>,
    /// What stands there then.
    pub with: String,
}

impl ImportError {
    /// Makes the error of an element, by its name and byte offset.
    pub fn of(at: usize, element: &str, what: impl Into<String>, want: impl Into<String>) -> Self {
        let element = format!("{}: ", shortened(element, 100));
        Self { at: Some(at), line: None, element, what: what.into(), want: want.into(), mend: None }
    }

    /// Makes an error of the whole file.
    pub fn of_file(what: impl Into<String>, want: impl Into<String>) -> Self {
        Self { at: None, line: None, element: String::new(), what: what.into(), want: want.into(), mend: None }
    }

    /// Returns the error as a fault of the file.
    pub fn fault(&self) -> Fault {
        let Self { line, element, what, want, .. } = self;
        let key = element.trim_end_matches(": ").to_owned();
        Fault { line: *line, column: None, key, text: format!("{element}{what}: want {want}"), example: String::new() }
    }

    /// Adds what may stand in the text instead.
    pub(super) fn mended_by(self, mend: Option<Mend>) -> Self {
        Self { mend, ..self }
    }

    /// Returns the text with what is wrong mended, on the same line; `None` if only its author can mend it.
    pub(super) fn mended(&self, text: &str) -> Option<String> {
        let Mend { span, with } = self.mend.as_ref()?;
        let (before, after) = (text.get(..span.start)?, text.get(span.end..)?);
        Some([before, with, after].concat())
    }

    /// Adds the line of the element.
    #[must_use]
    pub fn located(self, text: &str) -> Self {
        let line = |at: usize| text.bytes().take(at).filter(|byte| *byte == b'\n').count() + 1;
        Self { line: self.at.map(line), ..self }
    }
}

/// Makes the error of an element.
pub fn element_error(node: Node<'_, '_>, what: impl Into<String>, want: impl Into<String>) -> ImportError {
    ImportError::of(node.range().start, &element_name(node), what, want)
}

/// Returns the name of an element in messages: `link "arm"`.
pub fn element_name(node: Node<'_, '_>) -> String {
    let kind = quote_clipped(node.tag_name().name());
    node.attribute("name").map_or_else(|| format!("<{kind}>"), |name| format!("{kind} \"{}\"", quote_clipped(name)))
}

/// Makes the error that the XML parser reports.
pub fn syntax(why: &str) -> ImportError {
    ImportError::of_file(shortened(why, 300), "XML without document types, as URDF and MJCF are")
}
