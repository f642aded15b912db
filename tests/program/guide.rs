//! The commands of the README and the guide are run, a page in a folder of its own, and what they print is compared with
//! what is shown.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::folder::Folder;
use crate::guide::markdown::blocks;
use crate::guide::{pages, read};

/// Which blocks a test runs.
#[derive(Clone, Copy, PartialEq)]
enum Run {
    /// `sh` and `console`.
    Short,
    /// Those marked `sh long` and `sh window` too; without a display a window gives way to a recording.
    Everything,
}

/// A line for the shell, in a folder, with the program on its path: what it prints, and whether it succeeds.
fn shell(folder: &Path, line: &str) -> (String, bool) {
    let program = Path::new(env!("CARGO_BIN_EXE_stillbase")).parent().expect("a folder");
    let path = std::env::var("PATH").unwrap_or_default();
    let out = Command::new("sh")
        .args(["-c", &format!("{line} 2>&1")])
        .current_dir(folder)
        .stdin(Stdio::null())
        .env("PATH", format!("{}:{path}", program.display()))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .expect("a shell");
    (String::from_utf8(out.stdout).expect("UTF-8"), out.status.success())
}

/// What the shell is given for a line of a page: `cargo run` is the program.
fn command(line: &str) -> String {
    let line = line.split(" # ").next().unwrap_or(line).trim();
    match line.strip_prefix("cargo run") {
        Some(rest) => format!("stillbase{}", rest.trim_start().strip_prefix("--").unwrap_or(rest)),
        None => line.to_owned(),
    }
}

/// A line with single spaces, so that a table may be shown narrower than it is.
fn narrow(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Whether lines are those shown, where `…` stands for anything: alone in a line for any number of lines.
fn agrees(shown: &[&str], printed: &[&str]) -> bool {
    match (shown, printed) {
        ([], []) => true,
        (["…"], _) => true,
        (["…", rest @ ..], _) => (0..=printed.len()).any(|skip| agrees(rest, &printed[skip..])),
        ([first, rest @ ..], [line, lines @ ..]) => matches(&narrow(first), &narrow(line)) && agrees(rest, lines),
        _ => false,
    }
}

fn matches(shown: &str, line: &str) -> bool {
    let mut parts = shown.split('…');
    let Some(mut left) = parts.next().and_then(|start| line.strip_prefix(start)) else { return false };
    let mut last = None;
    for part in parts {
        let Some((_, rest)) = left.split_once(part) else { return false };
        left = rest;
        last = Some(part);
    }
    left.is_empty() || last.is_some_and(|part| line.ends_with(part))
}

#[test]
fn what_is_shown_may_leave_out_what_an_ellipsis_stands_for() {
    assert!(matches("a … c", "a b c") && matches("a … c", "a c c") && !matches("a … c", "a b d"));
    assert!(!matches("a", "a b") && matches("a …", "a b"));
    assert!(agrees(&["a", "…", "d"], &["a", "b", "c", "d"]) && !agrees(&["a", "…", "d"], &["a", "b"]));
    assert!(agrees(&["a", "…"], &["a", "b"]) && !agrees(&["a"], &["a", "b"]));
}

/// Runs the blocks of a page in their order; gives how many commands were run.
fn tried(page: &str, run: Run) -> usize {
    let (text, folder) = (read(page), Folder::new("guide"));
    let mut count = 0;
    for block in blocks(&text) {
        let place = format!("{page}:{}", block.line);
        match (block.kind, run) {
            ("sh", _) | ("sh long" | "sh window", Run::Everything) => {
                for line in block.text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#')) {
                    let ours = line.starts_with("stillbase") || line.starts_with("cargo run");
                    let cargo = ["cargo test", "cargo doc", "cargo bench"].iter().any(|start| line.starts_with(start));
                    assert!(
                        ours || cargo && block.kind == "sh long",
                        "{place}: {line} is not a command of this program"
                    );
                    if !ours {
                        continue;
                    }
                    let (printed, done) = shell(&folder.0, &command(line));
                    assert!(done, "{place}: {line}\n{printed}");
                    count += 1;
                }
            }
            ("console", _) => {
                let lines: Vec<&str> = block.text.lines().map(str::trim_end).collect();
                let starts = (0..lines.len()).filter(|i| lines[*i].starts_with("$ "));
                assert!(lines.first().is_some_and(|line| line.starts_with("$ stillbase ")), "{place}: want a command");
                for start in starts {
                    let line = &lines[start][2..];
                    let shown = lines[start + 1..].split(|line| line.starts_with("$ ")).next().unwrap_or_default();
                    let (printed, done) = shell(&folder.0, &command(line));
                    let printed_lines: Vec<&str> = printed.trim_end().lines().map(str::trim_end).collect();
                    let refused = shown.iter().any(|line| line.starts_with("stillbase: "));
                    assert!(done || refused, "{place}: {line}\n{printed}");
                    assert!(shown.is_empty() || agrees(shown, &printed_lines), "{place}: {line} prints\n{printed}");
                    count += 1;
                }
            }
            // A file that the commands after it use.
            (kind, _) => {
                if let Some((_, name)) = kind.split_once(' ').filter(|(_, name)| name.contains('.')) {
                    folder.file(name, &block.text);
                }
            }
        }
    }
    count
}

/// The page of settings is what the program says of them.
#[test]
fn the_page_of_settings_is_current() {
    let (printed, done) = shell(Path::new(env!("CARGO_TARGET_TMPDIR")), "stillbase keys --markdown");
    assert!(done, "{printed}");
    assert!(
        printed == read("src/guide/keys.md"),
        "src/guide/keys.md is older than the program; write it again with `stillbase keys --markdown > src/guide/keys.md`"
    );
}

macro_rules! pages {
    ($($name:ident: $page:literal, $least:literal;)* | $($long:literal),*) => {
        $(#[test]
        fn $name() {
            let count = tried($page, Run::Short);
            assert!(count >= $least, "only {count} commands");
        })*

        /// The pages with commands, and no others.
        #[test]
        fn every_page_with_commands_is_tried() {
            let with = |page: &String| blocks(&read(page)).iter().any(|b| b.kind.starts_with("sh") || b.kind == "console");
            let found: Vec<String> = pages().into_iter().chain(["README.md".into()]).filter(with).collect();
            for page in &found {
                assert!([$($page,)* $($long),*].contains(&page.as_str()), "{page}");
            }
        }

        #[test]
        #[ignore = "long: what is marked so in the pages, and windows, which without a display are recordings"]
        fn long_commands_and_windows() {
            let count: usize = [$($page,)* $($long),*].into_iter().map(|page| tried(page, Run::Everything)).sum();
            println!("{count} commands");
        }
    };
}

pages! {
    readme: "README.md", 1;
    planning: "src/guide/planning.md", 6;
    plants: "src/guide/plants.md", 5;
    spacecraft: "src/guide/spacecraft.md", 4;
    assemblies: "src/guide/assemblies.md", 10;
    inside: "src/guide/inside.md", 3;
    design: "src/guide/design.md", 4;
    elsewhere: "src/guide/elsewhere.md", 12;
    workshop: "src/guide/workshop.md", 7;
    tolerances: "src/guide/tolerances.md", 3;
    trim: "src/guide/trim.md", 6;
    own_motion: "src/guide/own_motion.md", 4;
    files: "src/guide/files.md", 4;
    command_line: "src/guide/command_line.md", 5;
    recording: "src/guide/recording.md", 1;
    paper: "src/guide/paper.md", 2;
    | "src/guide/first_run.md", "src/guide/many_machines.md", "src/guide/python.md", "src/guide/speed.md"
}
