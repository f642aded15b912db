//! Results that leave the window as files: pictures, films, values of signals, the report.

use std::fs;
use std::path::Path;

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::export::{
    Export, FilmChoice, FilmForm, FilmOrder, Look, PictureChoice, PictureForm, PictureSize, RowForm, SignalChoice,
    TimeChoice, ValuesChoice, write_film,
};
use stillbase::app::jobs::Threads;
use stillbase::app::{Activity, AppState, Message, PictureOrder, SessionCommand, Shot, ViewChange, WindowCommand};
use stillbase::mechanics::machine::{Counterweight, Machine};
use stillbase::picture::charts::choice::PlotChange;
use stillbase::picture::notation::{AngleUnit, LengthUnit, NameOrder, Notation};
use stillbase::picture::render::offscreen::Picture;
use stillbase::picture::scene::palette::{Theme, palette};
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::scenario::Scenario;

use super::{Window, window};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    a_picture_is_chosen_on_a_card_and_written,
    a_scene_may_be_transparent,
    a_scene_is_written_as_outlines_and_as_webp,
    a_film_holds_the_range_that_plots_show,
    a_film_that_is_stopped_leaves_nothing,
    a_folder_of_pictures_replaces_only_its_like,
    without_its_encoder_an_mp4_says_what_to_install,
    a_film_is_drawn_beside_the_window_and_can_be_cancelled,
    values_are_those_of_the_plots_or_all,
    single_signals_and_times_are_chosen_on_the_card,
    the_keyboard_reaches_every_signal_of_the_card,
    a_choice_without_rows_is_refused,
    a_report_of_the_window_shows_its_plots,
    an_encoder_gets_every_picture,
    pixels_go_to_standard_output_whole,
    a_report_is_in_the_units_and_names_of_the_window,
    a_transparent_picture_is_legible_on_any_colour,
];

const SIZE: [u32; 2] = [320, 200];

fn png(look: Look) -> Export {
    Export::Picture(PictureChoice { look, form: PictureForm::Png })
}

fn look(shot: Shot) -> Look {
    Look { shot, size: PictureSize::Pixels(SIZE), theme: Theme::Light, transparent: false, plots: false }
}

fn picture_in(file: &Path) -> Picture {
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(fs::File::open(file).expect("a file"))).read_info().expect("a PNG");
    let mut rgba = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut rgba).expect("a picture");
    Picture { width: info.width, height: info.height, rgba }
}

fn app_state(case: &str) -> AppState {
    AppState::new(Scenario::builtin(case).expect("built in"), Theme::Dark).expect("it starts")
}

/// What is said after the file was written, or why it was not.
#[track_caller]
fn said(app_state: &mut AppState, file: &Path, wanted: Export) -> Message {
    app_state.carry_out(SessionCommand::Export(file.into(), wanted));
    app_state.view_state().status.message.clone().expect("it is said")
}

#[track_caller]
fn saved(app_state: &mut AppState, file: &Path, wanted: Export) {
    let said = said(app_state, file, wanted);
    assert!(!said.is_problem && said.text.contains("saved"), "{said:?}");
}

fn a_picture_is_chosen_on_a_card_and_written() {
    let folder = Folder::new("results");
    let file = folder.path("shot.png");
    let mut h: Window = window("case-3", Theme::Dark);
    h.run_steps(2);
    h.key_press_modifiers(Modifiers::COMMAND, Key::E);
    h.run_steps(3);
    h.get_by_label("the whole window").click();
    h.get_by_label("light").click();
    h.run_steps(3);
    let chosen = h.state().app_state().view_state().open.export.clone();
    let Some(Export::Picture(PictureChoice { look, .. })) = chosen else { panic!("{chosen:?}") };
    assert_eq!((look.shot, look.theme, look.size), (Shot::Window, Theme::Light, PictureSize::Display));
    h.get_by_label("Choose a file…").click();
    h.run_steps(3);
    assert!(h.state().app_state().view_state().open.export.is_none(), "the card has gone");
    h.key_press_modifiers(Modifiers::COMMAND, Key::A);
    h.step();
    h.event(egui::Event::Text(file.display().to_string()));
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(4);
    let picture = picture_in(&file);
    assert_eq!([picture.width, picture.height], [1280, 800], "as on display");
    assert_eq!(picture.pixel(640, 2).map(|p| p[0] > 200), Some(true), "light, though the window is dark");
    assert_eq!(h.state().app_state().view_state().arrangement.theme, Theme::Dark, "the window stays as it is");
    // Esc closes the card.
    h.key_press_modifiers(Modifiers::COMMAND, Key::E);
    h.run_steps(3);
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert!(h.state().app_state().view_state().open.export.is_none());
}

fn a_scene_is_written_as_outlines_and_as_webp() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-3");
    app_state.carry_out(ViewChange::Kind(ViewKind::Flat));
    for (form, begins) in [(PictureForm::Svg, "<?xml"), (PictureForm::Pdf, "%PDF"), (PictureForm::Webp, "RIFF")] {
        for plots in [false, true] {
            let file = folder.path(&format!("{plots}.{}", form.ending()));
            let look = Look { plots, ..look(Shot::Scene) };
            saved(&mut app_state, &file, Export::Picture(PictureChoice { look, form }));
            assert!(fs::read(&file).expect("a file").starts_with(begins.as_bytes()), "{form:?}");
        }
    }
    let drawing = fs::read_to_string(folder.path("true.svg")).expect("a file");
    let page = roxmltree::Document::parse(&drawing).expect("an SVG");
    assert!(page.descendants().filter(|node| node.has_tag_name("path")).count() > 100);
    // Other views have no outlines: that is said, and no file is left.
    app_state.carry_out(ViewChange::Kind(ViewKind::Space));
    let choice = PictureChoice { look: look(Shot::Scene), form: PictureForm::Svg };
    let said = said(&mut app_state, &folder.path("space.svg"), Export::Picture(choice));
    assert!(said.is_problem && said.text.contains("view from above"), "{said:?}");
    assert!(!folder.path("space.svg").exists());
}

fn a_scene_may_be_transparent() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-3");
    for view in [ViewKind::Flat, ViewKind::Space, ViewKind::Joints, ViewKind::Tower, ViewKind::Design] {
        app_state.carry_out(ViewChange::Kind(view));
        let [clear, filled] = [true, false].map(|transparent| {
            let file = folder.path(&format!("{}-{transparent}.png", view.name()));
            saved(&mut app_state, &file, png(Look { transparent, ..look(Shot::Scene) }));
            picture_in(&file)
        });
        let alpha = |picture: &Picture, wanted: fn(u8) -> bool| {
            picture.rgba.iter().skip(3).step_by(4).filter(|a| wanted(**a)).count()
        };
        assert_eq!(alpha(&filled, |a| a == 255), (SIZE[0] * SIZE[1]) as usize, "{view:?}");
        assert!(alpha(&clear, |a| a == 0) > 5000, "{view:?}: nothing behind it");
        assert!(alpha(&clear, |a| a == 255) > 100 || !view.shows_machine(), "{view:?}: the machine is solid");
        // Laid over white, it looks as the light picture does.
        let over = |c: u8, a: u8| (u32::from(c) * u32::from(a) + 255 * (255 - u32::from(a))).div_ceil(255);
        let far = clear
            .rgba
            .as_chunks::<4>()
            .0
            .iter()
            .zip(filled.rgba.as_chunks::<4>().0)
            .filter(|(c, f)| (0..3).any(|i| over(c[i], c[3]).abs_diff(u32::from(f[i])) > 40));
        let far = far.count();
        assert!(far < 600, "{view:?}: {far} pixels differ");
    }
}

fn a_film_holds_the_range_that_plots_show() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-1");
    app_state.carry_out(ViewChange::Charts(PlotChange::Range(Some([0.2, 0.6]))));
    let choice = FilmChoice { look: look(Shot::Scene), form: FilmForm::Gif, whole: false, fps: 10.0, slow: 1.0 };
    saved(&mut app_state, &folder.path("frames"), Export::Film(choice));
    let names: Vec<String> = (1..=5).map(|i| format!("frame-{i:05}.png")).collect();
    let mut found: Vec<String> = fs::read_dir(folder.path("frames"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    found.sort();
    assert_eq!(found, names, "0.2, 0.3 … 0.6 s");
    assert_eq!(app_state.session().frame().time, 0.0, "the window stays where it is");
    // The first picture shows the first instant of the range.
    app_state.carry_out(SessionCommand::Seek(0.2));
    saved(&mut app_state, &folder.path("at.png"), png(look(Shot::Scene)));
    assert!(picture_in(&folder.path("at.png")) == picture_in(&folder.path("frames/frame-00001.png")));
    saved(&mut app_state, &folder.path("film.gif"), Export::Film(FilmChoice { whole: true, ..choice }));
    saved(&mut app_state, &folder.path("film.png"), Export::Film(choice));
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(fs::File::open(folder.path("film.gif")).expect("a file")).expect("a GIF");
    let mut count = 0;
    while decoder.read_next_frame().expect("a picture").is_some() {
        count += 1;
    }
    assert_eq!(count, 11, "0, 0.1 … 1 s");
    for bad in ["film.avi", "film.gif"] {
        let said = said(&mut app_state, &folder.path(bad), Export::Film(choice));
        assert!(said.is_problem, "{said:?}");
    }
    assert_eq!(folder.names(), ["at.png", "film.gif", "film.png", "frames"]);
}

fn film_order(app_state: &AppState) -> FilmOrder {
    let picture = PictureOrder::new(Shot::View(ViewKind::Flat), Theme::Dark, [64, 40]);
    FilmOrder { picture, times: [0.0, app_state.session().length()], fps: 10.0, slow: 1.0 }
}

fn a_film_that_is_stopped_leaves_nothing() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-1");
    app_state.run_to_end();
    let order = film_order(&app_state);
    for name in ["a.gif", "a.png", "frames"] {
        let (mut pictures, file) = (0, folder.path(name));
        let goes_on = &mut |_: f64| {
            pictures += 1;
            pictures < 3
        };
        let stopped = write_film(&mut app_state, &order, (&file, FilmForm::of(&file).expect("a film")), false, goes_on);
        assert!(stopped.is_err_and(|why| why.to_string().contains("no file is left")), "{name}");
        assert_eq!(pictures, 3, "{name}: it stops at once");
    }
    assert!(folder.names().is_empty());
    let order = FilmOrder { slow: 1000.0, fps: 50.0, ..order };
    let long = write_film(&mut app_state, &order, (&folder.path("a.gif"), FilmForm::Gif), false, &mut |_| true);
    assert!(long.is_err_and(|why| why.to_string().contains("want at most 5000")));
}

fn a_folder_of_pictures_replaces_only_its_like() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-1");
    app_state.run_to_end();
    let (order, frames) = (film_order(&app_state), folder.path("frames"));
    let mut film =
        |order: &FilmOrder, force| write_film(&mut app_state, order, (&frames, FilmForm::Frames), force, &mut |_| true);
    assert_eq!(film(&order, false).expect("a film").pictures, 11);
    assert!(film(&order, false).is_err_and(|why| why.to_string().contains("exists")));
    let short = FilmOrder { times: [0.0, 0.2], ..order };
    assert_eq!(film(&short, true).expect("a film").pictures, 3);
    assert_eq!(fs::read_dir(&frames).expect("a folder").count(), 3, "nothing of the longer film is left");
    fs::write(frames.join("notes.txt"), "mine").expect("a file");
    assert!(film(&order, true).is_err_and(|why| why.to_string().contains("more than numbered pictures")));
    assert_eq!(fs::read_dir(&frames).expect("a folder").count(), 4);
    assert_eq!(folder.names(), ["frames"]);
}

/// On a system with the encoder, the film is written.
fn without_its_encoder_an_mp4_says_what_to_install() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-1");
    app_state.run_to_end();
    let order = film_order(&app_state);
    let file = folder.path("film.mp4");
    match write_film(&mut app_state, &order, (&file, FilmForm::Mp4), false, &mut |_| true) {
        Err(why) => {
            assert!(!stillbase::files::video::has_encoder(), "{why}");
            assert!(why.to_string().contains("apt-get install ffmpeg"), "{why}");
            assert!(folder.names().is_empty());
        }
        Ok(done) => {
            assert_eq!((done.pictures, folder.names()), (11, vec!["film.mp4".to_owned()]));
            assert_eq!(&fs::read(&file).expect("a file")[4..8], b"ftyp");
        }
    }
}

fn a_film_is_drawn_beside_the_window_and_can_be_cancelled() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-1").with_workers(Threads::Background);
    let choice = FilmChoice { look: look(Shot::Scene), form: FilmForm::Gif, whole: true, fps: 50.0, slow: 20.0 };
    app_state.carry_out(SessionCommand::Export(folder.path("film.gif"), Export::Film(choice)));
    assert!(app_state.under_way().contains(&Activity::Exporting), "the hand does not wait");
    app_state.carry_out(SessionCommand::Export(folder.path("other.gif"), Export::Film(choice)));
    let said = app_state.view_state().status.message.clone().expect("it is said");
    assert!(said.is_problem && said.text.contains("one result is being written"), "{said:?}");
    app_state.carry_out(WindowCommand::Cancel(Activity::Exporting));
    let said = app_state.view_state().status.message.clone().expect("it is said");
    assert_eq!(said.text, "cancelled: no file is left");
    // The work ends at its next picture, and takes its temporary file with it.
    for _ in 0..500 {
        if folder.names().is_empty() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    panic!("left: {:?}", folder.names());
}

/// A system with an encoder, or with one that fails: programs that say they are ffmpeg.
fn an_encoder_gets_every_picture() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = Folder::new("results");
    let film = |script: &str| {
        let encoder = folder.file("ffmpeg", format!("#!/bin/sh\n[ \"$1\" = -version ] && exit 0\n{script}\n"));
        fs::set_permissions(&encoder, fs::Permissions::from_mode(0o755)).expect("it may run");
        let path = format!("{}:{}", folder.0.display(), std::env::var("PATH").expect("a path"));
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_stillbase"));
        command.args(["render", "case-1", "-o", "film.mp4", "--film", "--fps", "10", "--size", "32x20"]);
        command.current_dir(&folder.0).env("PATH", path).output().expect("the program starts")
    };
    let out = film("echo 'no such codec' >&2; exit 1");
    let why = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(1), "{why}");
    assert!(why.contains("ffmpeg failed: no such codec"), "{why}");
    assert_eq!(folder.names(), ["ffmpeg"], "nothing else is left");
    let out = film("for last; do :; done; cat > \"${last#file:}\"");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    assert_eq!(fs::read(folder.path("film.mp4")).expect("a file").len(), 11 * 32 * 20 * 4);
    assert_eq!(folder.names(), ["ffmpeg", "film.mp4"]);
}

/// Also a film that another program encodes; no other file is left.
fn pixels_go_to_standard_output_whole() {
    use std::os::unix::fs::PermissionsExt as _;
    let (folder, temporary) = (Folder::new("results"), Folder::new("results"));
    let encoder = folder
        .file("ffmpeg", "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\nfor last; do :; done\ncat > \"${last#file:}\"\n");
    fs::set_permissions(&encoder, fs::Permissions::from_mode(0o755)).expect("it may run");
    let path = format!("{}:{}", folder.0.display(), std::env::var("PATH").expect("a path"));
    let render = |args: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_stillbase"));
        command.args(["render", "case-1", "--size", "64x40"]).args(args);
        command.stdin(std::process::Stdio::null()).env("PATH", &path).env("TMPDIR", &temporary.0);
        let out = command.current_dir(&folder.0).output().expect("the program starts");
        assert!(out.status.success(), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
        out.stdout
    };
    let film = ["--film", "0,0.2", "--fps", "10"];
    for (more, file, format) in [
        (&[][..], "still.png", None),
        (&[], "still.webp", Some("webp")),
        (&film, "film.gif", None),
        (&film, "film.png", Some("png")),
        (&film, "film.mp4", Some("mp4")),
    ] {
        render(&[more, &["-o", file]].concat());
        let written = fs::read(folder.path(file)).expect("a file");
        let format: Vec<&str> = format.into_iter().flat_map(|format| ["--format", format]).collect();
        let printed = render(&[more, &["-o", "-"], &format].concat());
        assert!(!written.is_empty() && printed == written, "{file}: {} of {} bytes", printed.len(), written.len());
    }
    assert!(temporary.names().is_empty(), "{:?}", temporary.names());
    assert_eq!(folder.names().len(), 6, "{:?}", folder.names());
}

fn values_are_those_of_the_plots_or_all() {
    let folder = Folder::new("results");
    // Nothing is computed yet of the run: what is to be written is computed first.
    let mut app_state = app_state("case-1");
    app_state.carry_out(ViewChange::Charts(PlotChange::Range(Some([0.25, 0.5]))));
    let choice = ValuesChoice { signals: SignalChoice::Plots, times: TimeChoice::Shown, form: RowForm::Csv };
    saved(&mut app_state, &folder.path("part.csv"), Export::Values(choice.clone()));
    let text = fs::read_to_string(folder.path("part.csv")).expect("a file");
    let head = text.lines().next().expect("a head");
    assert!(head.starts_with("time s,torque/1 N m,"), "{head}");
    assert_eq!(text.lines().count(), 252, "0.25, 0.251 … 0.5 s and the head");
    assert!(text.lines().nth(1).is_some_and(|line| line.starts_with("0.25,")));
    let everything = ValuesChoice { signals: SignalChoice::All, times: TimeChoice::Whole, ..choice.clone() };
    saved(&mut app_state, &folder.path("all.csv"), Export::Values(everything));
    let all = fs::read_to_string(folder.path("all.csv")).expect("a file");
    let columns = |line: &str| line.split(',').count();
    assert!(all.lines().next().map(columns) > Some(columns(head)));
    assert_eq!(all.lines().count(), 1002);
    saved(&mut app_state, &folder.path("all.parquet"), Export::Values(choice.clone()));
    assert!(fs::read(folder.path("all.parquet")).expect("a file").starts_with(b"PAR1"));
    let why = said(&mut app_state, &folder.path("all.xls"), Export::Values(choice.clone()));
    assert!(why.is_problem && why.text.contains(".csv or .parquet"), "{why:?}");
    let why = said(&mut app_state, &folder.path("all.csv"), Export::Values(choice.clone()));
    assert!(why.is_problem && why.text.contains("exists"), "{why:?}");
    let why = said(&mut app_state, &folder.path("no/all.csv"), Export::Values(choice));
    assert!(why.is_problem && why.text.contains("no folder"), "{why:?}");
}

/// The card ticks signals, takes two times, and shows the command that writes the very same file.
fn single_signals_and_times_are_chosen_on_the_card() {
    let folder = Folder::new("results");
    let mut h: Window = window("case-1", Theme::Dark);
    h.state_mut().app_state_mut().carry_out(ViewChange::Export(Some(Export::values())));
    h.run_steps(3);
    h.get_by_label("none").click();
    h.run_steps(3);
    assert!(h.query_by_label_contains("no signal is chosen").is_some(), "nothing to write is said at once");
    assert!(h.get_by_label("Choose a file…").accesskit_node().is_disabled());
    h.get_by_label("Torque: all 3").click();
    h.run_steps(3);
    h.get_by_label("Find a signal to be written").click();
    h.run_steps(2);
    h.event(egui::Event::Text("n_B".into()));
    h.run_steps(3);
    h.get_by_label("turning moment on the base, n_B").click();
    h.run_steps(3);
    let export = |h: &Window| h.state().app_state().view_state().open.export.clone();
    let Some(Export::Values(mut choice)) = export(&h) else { panic!("{:?}", export(&h)) };
    let paths = ["moment/total", "torque/1", "torque/2", "torque/3"].map(String::from);
    assert_eq!(choice.signals, SignalChoice::These(paths.into()));
    choice.times = TimeChoice::Between([0.25, 0.5]);
    h.state_mut().app_state_mut().carry_out(ViewChange::Export(Some(Export::Values(choice.clone()))));
    h.run_steps(3);
    let command = "stillbase simulate case-1 -o values.csv --signals torque,moment/total --from 0.25 --to 0.5";
    assert!(h.query_by_label(command).is_some(), "the command is shown");
    let mut app_state = app_state("case-1");
    saved(&mut app_state, &folder.path("window.csv"), Export::Values(choice));
    let out = std::process::Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .args(command.split(' ').skip(1))
        .current_dir(&folder.0)
        .output()
        .expect("the program starts");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let [window, line] = ["window.csv", "values.csv"].map(|name| fs::read(folder.path(name)).expect("a file"));
    assert!(window.len() > 1000 && window == line, "the same file");
}

/// Only the rows in view are drawn; the others come into view when the keyboard gets to them.
fn the_keyboard_reaches_every_signal_of_the_card() {
    let mut h: Window = window("case-1", Theme::Dark);
    h.state_mut().app_state_mut().carry_out(ViewChange::Export(Some(Export::values())));
    h.run_steps(3);
    let all = stillbase::simulation::signals::signals(&h.state().app_state().session().scenario().machine);
    let last = all.last().expect("signals");
    let last = Notation::default().name(&last.label, &last.symbol).to_string();
    assert!(h.query_by_label(&last).is_none(), "{last} is below the list");
    h.get_by_label("Find a signal to be written").click();
    h.run_steps(2);
    let focused = |h: &Window| h.query_by_label(&last).is_some_and(|row| row.accesskit_node().is_focused());
    for _ in 0..all.len() + 60 {
        h.key_press(Key::Tab);
        h.run_steps(2);
        if focused(&h) {
            return;
        }
    }
    panic!("the keyboard does not reach {last}");
}

fn a_choice_without_rows_is_refused() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-1");
    let choice = |signals, times| Export::Values(ValuesChoice { signals, times, form: RowForm::Csv });
    for (signals, times, words) in [
        (SignalChoice::These([].into()), TimeChoice::Whole, "want at least one"),
        (SignalChoice::These(["torque/9".into()].into()), TimeChoice::Whole, "want at least one"),
        (SignalChoice::All, TimeChoice::Between([0.5, 0.2]), "the first before the second"),
        (SignalChoice::All, TimeChoice::Between([2.0, 3.0]), "want one within it"),
    ] {
        let why = said(&mut app_state, &folder.path("no.csv"), choice(signals, times));
        assert!(why.is_problem && why.text.contains(words), "{why:?}");
    }
    assert!(folder.names().is_empty());
}

fn a_report_of_the_window_shows_its_plots() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-1");
    app_state.carry_out(ViewChange::Charts(PlotChange::Plot("angle/1".into())));
    app_state.carry_out(ViewChange::Switch(stillbase::app::Switch::Compare, true));
    let file = folder.path("report.html");
    saved(&mut app_state, &file, Export::Report);
    let page = fs::read_to_string(&file).expect("a page");
    assert!(page.contains("Angle of drive 1"), "the plot that was added");
    assert!(page.contains("Runs compared"));
    assert!(page.contains("<pre>stillbase simulate case-1</pre>"));
    assert_eq!(page.matches("data:image/png;base64,").count(), 2);
    // A page of the command line shows the same numbers, and so does one of a session that was led by hand.
    app_state.carry_out(SessionCommand::Seek(0.3));
    app_state.carry_out(SessionCommand::Edit(stillbase::session::Edit::DragTarget { x: 0.5, y: 0.8 }));
    saved(&mut app_state, &folder.path("led.html"), Export::Report);
    let page = fs::read_to_string(folder.path("led.html")).expect("a page");
    assert!(page.contains("Save the session"), "no settings alone lead there");
}

/// Texts and tables follow the choice of the window as the plots do.
fn a_report_is_in_the_units_and_names_of_the_window() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-1");
    let mut spec = app_state.session().scenario().machine.spec().clone();
    let link = spec.links[0].name.clone();
    let disc =
        |at, mass| Counterweight { link: link.clone(), mass, at, across: 0.0, radius: 0.05, ..Default::default() };
    spec.counterweights = vec![disc(-0.1, 1.25), disc(-0.2, 0.5)];
    let machine = Machine::new(spec).expect("a machine");
    let scenario = Scenario { machine, ..app_state.session().scenario().clone() };
    app_state = AppState::new(scenario, Theme::Dark).expect("it starts");
    let page = |app_state: &mut AppState, notation: Notation, name: &str| {
        app_state.carry_out(ViewChange::Notation(notation));
        saved(app_state, &folder.path(name), Export::Report);
        fs::read_to_string(folder.path(name)).expect("a page")
    };
    let usual = page(&mut app_state, Notation::default(), "usual.html");
    assert!(usual.contains("<td>task.from</td><td>0.5,0.5</td><td>m</td>"), "{usual}");
    assert!(usual.contains("peak moment on the base, |n_B|") && usual.contains("<th class=\"number\">length (m)</th>"));
    assert!(usual.contains("kg with its counterweights, reach 1.260 m."));
    assert!(usual.contains("The masses, inertias and centres of mass of links are without counterweights."));
    assert!(usual.contains(&format!("<td>2</td><td>{link}</td><td class=\"number\">0.5</td>")), "they are numbered");
    let other = Notation { angle: AngleUnit::Degrees, length: LengthUnit::Millimetres, names: NameOrder::Symbols };
    let page = page(&mut app_state, other, "other.html");
    assert!(page.contains("<td>task.from</td><td>500,500</td><td>mm</td>"), "{page}");
    assert!(page.contains("<td>limits.a1</td><td>0,180</td><td>°</td>"));
    assert!(page.contains("|n_B|, peak moment on the base") && page.contains("<th class=\"number\">length (mm)</th>"));
    assert!(page.contains("reach 1260 mm.") && page.contains("<td class=\"number\">-200</td>"));
    for unit in ["<td>m</td>", "<td>rad</td>", "(m)", " rad<", "(rad)"] {
        assert!(!page.contains(unit), "{unit} is left");
    }
}

/// On white, grey and black alike, text stands out of what is behind it: in the colours of a plate of its own.
fn a_transparent_picture_is_legible_on_any_colour() {
    let folder = Folder::new("results");
    let mut app_state = app_state("case-3");
    for theme in [Theme::Dark, Theme::Light] {
        let file = folder.path(&format!("{theme:?}.png"));
        let look = Look { transparent: true, theme, size: PictureSize::Pixels([640, 400]), ..look(Shot::Scene) };
        saved(&mut app_state, &file, png(look));
        let picture = picture_in(&file);
        let p = palette(theme);
        let near = |pixel: &[u8], colour: [f32; 4]| {
            pixel[3] > 190 && (0..3).all(|i| (f32::from(pixel[i]) - 255.0 * colour[i]).abs() < 14.0)
        };
        let pixels = picture.rgba.as_chunks::<4>().0;
        let count = |colour| pixels.iter().filter(|pixel| near(&pixel[..], colour)).count();
        assert!(count(p.background) > 1500, "{theme:?}: {} pixels of plates", count(p.background));
        // The grid is a mean grey, which neither shouts on white nor on black.
        let faint = pixels.iter().filter(|c| (4..90).contains(&c[3]) && c[0].abs_diff(128) < 20 && c[0] == c[1]);
        assert!(faint.count() > 1000, "{theme:?}: the grid");
    }
}
