//! The pictures of the documentation are what the program draws now.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Command, Output};

use egui_kittest::{SnapshotOptions, try_image_snapshot_options};

use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    window_is_current,
    spacecraft_is_current,
    compare_is_current,
    tolerances_is_current,
    tower_is_current,
    joints_is_current,
    design_is_current,
    no_picture_is_left_over,
];

/// What the program does when it is asked for one picture.
fn figures(folder: &Folder, picture: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_stillbase"));
    program.args(["figures", picture]).current_dir(&folder.0).output().expect("the program starts")
}

fn committed() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/pictures"))
}

/// Both themes, as closely as snapshots are compared. Where they differ, `target/tmp/pictures` shows how.
fn is_current(stem: &str) {
    let beside = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pictures");
    std::fs::create_dir_all(&beside).expect("a folder");
    let folder = Folder::new("figures");
    let out = figures(&folder, stem);
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    for theme in ["dark", "light"] {
        let name = format!("{stem}-{theme}");
        let file = format!("{name}.png");
        std::fs::copy(committed().join(&file), beside.join(&file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        let drawn = image::open(folder.path(&file)).expect("a picture").to_rgba8();
        if let Err(error) = try_image_snapshot_options(&drawn, &name, &SnapshotOptions::default().output_path(&beside))
        {
            panic!(
                "assets/pictures/{file} is older than what the program draws; draw it again with `stillbase figures -o \
                 assets/pictures --force`. {error}"
            );
        }
    }
}

fn window_is_current() {
    is_current("window");
}

fn spacecraft_is_current() {
    is_current("spacecraft");
}

fn compare_is_current() {
    is_current("compare");
}

fn tolerances_is_current() {
    is_current("tolerances");
}

fn tower_is_current() {
    is_current("tower");
}

fn design_is_current() {
    is_current("design");
}

fn joints_is_current() {
    is_current("joints");
}

/// The pictures that are kept are those that can be drawn, and those that are compared above.
fn no_picture_is_left_over() {
    let entries = std::fs::read_dir(committed()).expect("pictures");
    let kept: BTreeSet<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    let both = |stem: &str| ["dark", "light"].map(|theme| format!("{stem}-{theme}.png"));
    let compared = TESTS.iter().filter_map(|(name, _)| name.rsplit("::").next()?.strip_suffix("_is_current"));
    assert_eq!(kept, compared.flat_map(both).collect());
    let said = figures(&Folder::new("figures"), "none").stderr;
    let said = String::from_utf8(said).expect("UTF-8");
    let names = said.split("[possible values: ").nth(1).and_then(|rest| rest.split(']').next());
    assert_eq!(kept, names.unwrap_or_else(|| panic!("{said}")).split(", ").flat_map(both).collect());
}
