//! Markdown as far as the tests ask: fenced blocks, links, labels.

/// A fenced block.
pub struct Block<'a> {
    /// What stands behind the fence: `sh`, `toml arm.toml`.
    pub kind: &'a str,
    /// Line of the fence, from 1.
    pub line: usize,
    pub text: String,
}

pub fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open = false;
    for (i, line) in page.lines().enumerate() {
        match (line.strip_prefix("```"), open) {
            (Some(kind), false) => {
                open = true;
                blocks.push(Block { kind: kind.trim(), line: i + 1, text: String::new() });
            }
            (Some(_), true) => open = false,
            (None, true) => {
                let text = &mut blocks.last_mut().expect("an open block").text;
                text.push_str(line);
                text.push('\n');
            }
            (None, false) => {}
        }
    }
    assert!(!open, "a block is not closed");
    blocks
}

/// The page without its fenced blocks and without what stands between backticks.
pub fn prose(page: &str) -> String {
    let mut open = false;
    let mut text = String::new();
    for line in page.lines() {
        if line.starts_with("```") {
            open = !open;
        } else if !open {
            text.extend(line.split('`').step_by(2));
            text.push('\n');
        }
    }
    text
}

/// Where links and pictures lead that stand with their address: `[…](address)`, `src="address"`, `srcset="address"`.
pub fn addresses(prose: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for (open, close) in [("](", ')'), ("src=\"", '"'), ("srcset=\"", '"')] {
        found.extend(prose.split(open).skip(1).filter_map(|rest| rest.split(close).next()));
    }
    found
}

/// Labels that are used, `[…][label]`.
pub fn labels(prose: &str) -> Vec<&str> {
    prose.split("][").skip(1).filter_map(|rest| rest.split(']').next()).collect()
}

/// Labels that are defined, `[label]: address`.
pub fn definitions(text: &str) -> Vec<(&str, &str)> {
    text.lines().filter_map(|line| line.strip_prefix('[')?.split_once("]: ")).collect()
}
