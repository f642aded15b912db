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
    assembly_is_current,
    assembly_hand_over_is_current,
    assembly_wrist_is_current,
    assembly_in_space_is_current,
    assembly_off_its_pin_is_current,
    design_is_current,
    draw_is_current,
    workshop_is_current,
    paper_table_1_is_current,
    paper_fig_3_is_current,
    paper_fig_4_is_current,
    paper_fig_5_is_current,
    no_picture_is_left_over,
    films_and_pictures_are_rendered,
];

/// What is rendered has the size, the instants and the number of pictures that were asked for; nothing is overwritten.
fn films_and_pictures_are_rendered() {
    let folder = Folder::new("render");
    let render = |args: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_stillbase"));
        program.arg("render").args(args).current_dir(&folder.0).output().expect("the program starts")
    };
    let still = render(&["case-3", "-o", "still.png", "--at", "0.5", "--size", "320x200", "--json"]);
    assert!(still.status.success(), "{}", String::from_utf8_lossy(&still.stderr));
    let answer: serde_json::Value = serde_json::from_slice(&still.stdout).expect("an object");
    assert_eq!(answer["times"], serde_json::json!([0.5, 0.5]));
    let picture = image::open(folder.path("still.png")).expect("a picture").to_rgba8();
    assert_eq!(picture.dimensions(), (320, 200));
    for (file, view) in [("turn.gif", "window"), ("turn.png", "space")] {
        let film = ["spacecraft", "-o", file, "--film", "0.2,0.6", "--fps", "10", "--size", "480x300", "--view", view];
        let out = render(&film);
        let said = String::from_utf8_lossy(&out.stdout).into_owned();
        assert!(out.status.success() && said.contains("5 pictures, 0.200 to 0.600 s"), "{said} {:?}", out.stderr);
        assert_eq!(render(&film).status.code(), Some(2), "it is not overwritten");
    }
    let late = render(&["case-3", "-o", "late.png", "--at", "9"]);
    assert!(String::from_utf8_lossy(&late.stderr).contains("want a time within the run, 0 to 1.000 s"));
}

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

fn draw_is_current() {
    is_current("draw");
}

fn workshop_is_current() {
    is_current("workshop");
}

fn paper_table_1_is_current() {
    is_current("paper-table-1");
}

fn paper_fig_3_is_current() {
    is_current("paper-fig-3");
}

fn paper_fig_4_is_current() {
    is_current("paper-fig-4");
}

fn paper_fig_5_is_current() {
    is_current("paper-fig-5");
}

fn joints_is_current() {
    is_current("joints");
}

fn assembly_is_current() {
    is_current("assembly");
}

fn assembly_hand_over_is_current() {
    is_current("assembly-hand-over");
}

fn assembly_wrist_is_current() {
    is_current("assembly-wrist");
}

fn assembly_in_space_is_current() {
    is_current("assembly-in-space");
}

fn assembly_off_its_pin_is_current() {
    is_current("assembly-off-its-pin");
}

/// The pictures that are kept are those that can be drawn, and those that are compared above.
fn no_picture_is_left_over() {
    let entries = std::fs::read_dir(committed()).expect("pictures");
    let kept: BTreeSet<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    let both = |stem: &str| ["dark", "light"].map(|theme| format!("{stem}-{theme}.png"));
    let compared = TESTS.iter().filter_map(|(name, _)| name.rsplit("::").next()?.strip_suffix("_is_current"));
    assert_eq!(kept, compared.map(|stem| stem.replace('_', "-")).flat_map(|stem| both(&stem)).collect());
    let said = figures(&Folder::new("figures"), "none").stderr;
    let said = String::from_utf8(said).expect("UTF-8");
    let names = said.split("[possible values: ").nth(1).and_then(|rest| rest.split(']').next());
    assert_eq!(kept, names.unwrap_or_else(|| panic!("{said}")).split(", ").flat_map(both).collect());
}
