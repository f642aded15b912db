//! Bounds on XML, checked in one pass before it is parsed. The parser's work grows with the square of the number of
//! attributes of one element, and with depth times number of namespaces.

use super::refusal::ImportError;

/// Maximum depth of an element: nested bodies for the maximum number of links, and some elements around them.
const MAX_DEPTH: usize = 250;
/// Maximum number of attributes of one element: MJCF has elements with some 40.
const MAX_ATTRIBUTES: usize = 100;
/// Maximum number of namespace declarations in a file: URDF and MJCF need none, files of other programs have a few.
const MAX_NAMESPACES: usize = 32;

/// Counts of a start tag.
struct Tag {
    attributes: usize,
    namespaces: usize,
    closes_itself: bool,
    /// Byte offset after the tag.
    end: usize,
}

/// Checks that a file does not take long to parse; the parser reports all other errors.
pub fn check_bounds(text: &str) -> Result<(), ImportError> {
    let bytes = text.as_bytes();
    let refused = |at: usize, count: usize, what: &str, most: usize| {
        let name: String = text[at + 1..].chars().take_while(|c| !c.is_whitespace() && !"/>".contains(*c)).collect();
        ImportError::of(at, &format!("<{name}>"), format!("{count} {what}"), format!("at most {most}"))
    };
    let (mut at, mut depth, mut namespaces) = (0, 0_usize, 0_usize);
    while let Some(start) = find(bytes, at, b"<") {
        at = match &bytes[start..] {
            rest if rest.starts_with(b"<!--") => past(bytes, start + 4, b"-->"),
            rest if rest.starts_with(b"<![CDATA[") => past(bytes, start + 9, b"]]>"),
            rest if rest.starts_with(b"<?") => past(bytes, start + 2, b"?>"),
            // A document type, which the parser refuses.
            rest if rest.starts_with(b"<!") => return Ok(()),
            rest if rest.starts_with(b"</") => {
                depth = depth.saturating_sub(1);
                past(bytes, start, b">")
            }
            _ => {
                let tag = tag(bytes, start);
                namespaces += tag.namespaces;
                depth += 1;
                for (count, what, most) in [
                    (depth, "levels of nested elements", MAX_DEPTH),
                    (tag.attributes, "attributes", MAX_ATTRIBUTES),
                    (namespaces, "declarations of namespaces in the file so far", MAX_NAMESPACES),
                ] {
                    if count > most {
                        return Err(refused(start, count, what, most));
                    }
                }
                depth -= usize::from(tag.closes_itself);
                tag.end
            }
        };
    }
    Ok(())
}

/// Reads the tag that begins at a byte offset. Equals signs outside of quotes count as attributes.
fn tag(bytes: &[u8], start: usize) -> Tag {
    let mut tag = Tag { attributes: 0, namespaces: 0, closes_itself: false, end: bytes.len() };
    // The open quote; the offset of the last word; and whether the next byte of a word begins a new word.
    let (mut quote, mut word, mut is_between) = (None, start + 1, false);
    for (i, byte) in bytes.iter().enumerate().skip(start + 1) {
        match (quote, byte) {
            (Some(open), _) => {
                if byte == open {
                    (quote, is_between) = (None, true);
                }
            }
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'=') => {
                tag.attributes += 1;
                tag.namespaces += usize::from(bytes[word..i].starts_with(b"xmlns"));
                is_between = true;
            }
            (None, b'>') => {
                tag.closes_itself = bytes[i - 1] == b'/';
                tag.end = i + 1;
                break;
            }
            (None, byte) if byte.is_ascii_whitespace() => is_between = true,
            (None, _) if is_between => (word, is_between) = (i, false),
            (None, _) => {}
        }
    }
    tag
}

/// Returns the byte offset of the next occurrence of a word.
fn find(bytes: &[u8], from: usize, word: &[u8]) -> Option<usize> {
    let rest = bytes.get(from..)?;
    rest.windows(word.len()).position(|own| own == word).map(|i| from + i)
}

/// Returns the byte offset after the next occurrence of a word.
fn past(bytes: &[u8], from: usize, word: &[u8]) -> usize {
    find(bytes, from, word).map_or(bytes.len(), |i| i + word.len())
}
