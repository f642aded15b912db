//! Bounds on XML, checked in one pass before it is parsed: the parser's work grows with the square of the attributes of
//! one element, and with depth times namespaces.

use super::refusal::ImportError;

/// The deepest an element may lie: as many bodies in a row as there may be links, and some around them.
const MAX_DEPTH: usize = 250;
/// The most attributes of one element: MJCF has elements with some 40.
const MAX_ATTRIBUTES: usize = 100;
/// The most declarations of namespaces in a file: URDF and MJCF need none, files from elsewhere bring a few.
const MAX_NAMESPACES: usize = 32;

/// What is counted of an element.
struct Tag {
    attributes: usize,
    namespaces: usize,
    closes_itself: bool,
    /// Where it ends, bytes.
    end: usize,
}

/// Refuses a file that would take long to parse; what is wrong otherwise is left to the parser.
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
                    (depth, "elements around each other", MAX_DEPTH),
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

/// The element that begins at a byte: its attributes are told by their signs of equality outside of quotes.
fn tag(bytes: &[u8], start: usize) -> Tag {
    let mut tag = Tag { attributes: 0, namespaces: 0, closes_itself: false, end: bytes.len() };
    // The open quote; where the last word began, and whether the next byte of a word begins another.
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

/// Where a word is next, bytes.
fn find(bytes: &[u8], from: usize, word: &[u8]) -> Option<usize> {
    let rest = bytes.get(from..)?;
    rest.windows(word.len()).position(|own| own == word).map(|i| from + i)
}

/// The byte after a word.
fn past(bytes: &[u8], from: usize, word: &[u8]) -> usize {
    find(bytes, from, word).map_or(bytes.len(), |i| i + word.len())
}
