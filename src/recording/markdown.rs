//! Text for the documents of a recording, which the viewer shows as Markdown.

use stillbase_settings::range::shortened;

/// Escapes a text for Markdown, on one line and with at most `most` characters before escaping.
pub fn cell(text: &str, most: usize) -> String {
    let mut cell = String::new();
    for c in shortened(text, most).chars() {
        match c {
            '\\' | '|' | '*' | '_' | '`' | '[' | ']' | '<' | '>' | '#' | '~' | '!' | '$' => cell.extend(['\\', c]),
            c if c.is_control() => cell.push(' '),
            c => cell.push(c),
        }
    }
    cell
}

/// Returns a table; columns after the first are right-aligned.
pub fn table(heads: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule: Vec<String> = (0..heads.len()).map(|i| if i == 0 { "---" } else { "---:" }.to_owned()).collect();
    line(heads) + &line(&rule) + &rows.iter().map(|row| line(row)).collect::<String>()
}
