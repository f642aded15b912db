//! The guide in the window: every page is drawn, links and the way back work, and it opens at what is on display.

use std::collections::BTreeSet;

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::{GuidePage, GuidePlace, GuideStep, Switch, ViewChange};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;

use super::{Window, window};
use crate::Test;

pub const TESTS: &[Test] = tests![
    the_guide_opens_at_what_is_on_display,
    every_page_is_drawn_in_both_themes,
    links_lead_on_and_buttons_back,
    what_is_sought_is_found,
    enter_opens_the_first_place_found,
    pages_show_their_pictures,
    a_heading_comes_to_the_top,
    a_block_is_copied,
    keys_scroll_the_page,
];

/// The text of a page as it stands in its file.
fn text_of(page: GuidePage) -> String {
    let file = format!("{}/src/guide/{}.md", env!("CARGO_MANIFEST_DIR"), page.file());
    std::fs::read_to_string(&file).unwrap_or_else(|why| panic!("{file}: {why}"))
}

fn open(h: &mut Window, place: impl Into<GuidePlace>) {
    h.state_mut().app_state_mut().carry_out(ViewChange::Guide(GuideStep::Go(place.into())));
    h.run_steps(5);
}

fn place(h: &Window) -> Option<GuidePlace> {
    h.state().app_state().view_state().open.guide.as_ref().map(|guide| guide.place.clone())
}

fn the_guide_opens_at_what_is_on_display() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let displays: [(ViewChange, GuidePage); 5] = [
        (ViewChange::Kind(ViewKind::Flat), GuidePage::FirstRun),
        (ViewChange::Kind(ViewKind::Design), GuidePage::Design),
        (ViewChange::Switch(Switch::Study, true), GuidePage::Tolerances),
        (ViewChange::Switch(Switch::Compare, true), GuidePage::Plants),
        (ViewChange::Switch(Switch::Pins, true), GuidePage::Inside),
    ];
    for (change, page) in displays {
        let is_view = matches!(change, ViewChange::Kind(_));
        h.state_mut().app_state_mut().carry_out(change.clone());
        h.run_steps(2);
        h.key_press(Key::F2);
        h.run_steps(3);
        assert_eq!(place(&h).map(|place| place.page), Some(page), "{change:?}");
        h.key_press(Key::Escape);
        h.run_steps(3);
        assert_eq!(place(&h), None);
        let back = if is_view { ViewChange::Kind(ViewKind::Flat) } else { ViewChange::Switch(Switch::Panels, true) };
        h.state_mut().app_state_mut().carry_out(back);
        for switch in [Switch::Study, Switch::Compare] {
            h.state_mut().app_state_mut().carry_out(ViewChange::Switch(switch, false));
        }
    }
    // A panel's own button leads to its page.
    h.get_by_label("Guide: Path").click();
    h.run_steps(3);
    assert_eq!(place(&h), Some(GuidePage::Planning.into()));
}

fn every_page_is_drawn_in_both_themes() {
    let entries = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/src/guide")).expect("the guide");
    let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    let files: BTreeSet<String> = names.filter_map(|name| Some(name.strip_suffix(".md")?.to_owned())).collect();
    let shown: BTreeSet<String> = GuidePage::ALL.iter().map(|page| page.file().to_owned()).collect();
    assert_eq!(shown, files, "every page is in the window");
    for theme in [Theme::Dark, Theme::Light] {
        let mut h = window("case-3", theme);
        for size in [[1280.0, 800.0], [960.0, 600.0]] {
            h.set_size(size.into());
            for page in GuidePage::ALL {
                open(&mut h, *page);
                let text = text_of(*page);
                let title = text.lines().find_map(|line| line.strip_prefix("# ")).expect("a heading");
                assert!(h.query_all_by_label(title).next().is_some(), "{title}");
            }
        }
    }
}

fn links_lead_on_and_buttons_back() {
    let mut h = window("case-3", Theme::Dark);
    open(&mut h, GuidePage::Index);
    let link = h.get_all_by_label("Planning").next().expect("a link");
    link.click();
    h.run_steps(3);
    assert_eq!(place(&h), Some(GuidePage::Planning.into()));
    h.get_by_label("Back: guide").click();
    h.run_steps(3);
    assert_eq!(place(&h), Some(GuidePage::Index.into()));
    h.get_by_label("Forward: guide").click();
    h.run_steps(3);
    assert_eq!(place(&h), Some(GuidePage::Planning.into()));
    // The last page of the list is below its edge.
    h.get_by_label("Page: Speed").scroll_to_me();
    h.run_steps(3);
    h.get_by_label("Page: Speed").click();
    h.run_steps(3);
    assert_eq!(place(&h), Some(GuidePage::Speed.into()));
}

fn what_is_sought_is_found() {
    let mut h = window("case-3", Theme::Dark);
    open(&mut h, GuidePage::Index);
    h.get_by_label("Search the guide").focus();
    h.run_steps(2);
    h.event(egui::Event::Text("exit status".into()));
    h.run_steps(3);
    h.get_by_label("Page: Command line: Exit status").click();
    h.run_steps(4);
    assert_eq!(place(&h), Some(GuidePlace::under(GuidePage::CommandLine, "Exit status")));
    h.get_by_label("Search the guide").focus();
    h.run_steps(2);
    h.event(egui::Event::Text(" qqxz".into()));
    h.run_steps(3);
    assert!(h.query_by_label("no page says this").is_some());
    // From the list of commands, too.
    h.key_press(Key::Escape);
    h.key_press(Key::Escape);
    h.run_steps(2);
    h.key_press_modifiers(Modifiers::COMMAND, Key::K);
    h.run_steps(2);
    h.event(egui::Event::Text("guide change points".into()));
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(4);
    assert_eq!(place(&h), Some(GuidePlace::under(GuidePage::Inside, "Change points")));
}

fn a_heading_comes_to_the_top() {
    let mut h = window("case-3", Theme::Dark);
    for (page, heading) in [(GuidePage::CommandLine, "Settings"), (GuidePage::Planning, "When a path is refused")] {
        open(&mut h, GuidePlace::under(page, heading));
        h.run_steps(3);
        let top = h.get_by_label("Search the guide").rect().bottom();
        let at =
            h.get_all_by_label(heading).map(|node| node.rect().top()).filter(|at| *at > top).fold(f32::MAX, f32::min);
        assert!((0.0..60.0).contains(&(at - top)), "{heading}: {at}, below {top}");
    }
}

fn a_block_is_copied() {
    let mut h = window("case-3", Theme::Dark);
    open(&mut h, GuidePage::Speed);
    let text = text_of(GuidePage::Speed);
    let block = text.split("```").nth(1).expect("a block");
    let first = block.lines().nth(1).expect("a line").trim_start_matches("$ ").to_owned();
    h.get_all_by_label(&format!("Copy: {first}")).next().expect("a button").click();
    h.step();
    let copied = h
        .output()
        .platform_output
        .commands
        .iter()
        .any(|command| matches!(command, egui::OutputCommand::CopyText(text) if text.contains(&first)));
    assert!(copied, "{first}");
}

fn keys_scroll_the_page() {
    let mut h = window("case-3", Theme::Dark);
    open(&mut h, GuidePage::Planning);
    let heading = |h: &Window| {
        h.get_all_by_label("Planning")
            .map(|node| node.rect())
            .filter(|rect| rect.height() > 24.0)
            .map(|r| r.top())
            .next()
    };
    let before = heading(&h).expect("the heading of the page");
    h.key_press(Key::PageDown);
    h.run_steps(30);
    assert!(heading(&h).is_none_or(|now| now < before - 200.0), "{before}, then {:?}", heading(&h));
    h.key_press(Key::PageUp);
    h.run_steps(30);
    assert!((heading(&h).expect("back again") - before).abs() < 2.0);
}

/// Enter in the search opens what stands first and ends the search.
fn enter_opens_the_first_place_found() {
    let mut h = window("case-3", Theme::Dark);
    open(&mut h, GuidePage::Index);
    h.get_by_label("Search the guide").focus();
    h.get_by_label("Search the guide").type_text("finite differences nowhere");
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(3);
    assert_eq!(place(&h), Some(GuidePage::Index.into()), "nothing was found");
    let guide = h.state_mut().app_state_mut();
    guide.carry_out(ViewChange::LeaveGuideSearch);
    h.run_steps(2);
    h.get_by_label("Search the guide").focus();
    h.get_by_label("Search the guide").type_text("corner blend");
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(3);
    assert_eq!(place(&h).map(|place| place.page), Some(GuidePage::Planning));
}

/// Each picture of a page is there in both themes, as wide as the page and in the shape of its file.
fn pages_show_their_pictures() {
    let mut shown = 0;
    for theme in [Theme::Dark, Theme::Light] {
        let mut h = window("case-3", theme);
        for page in GuidePage::ALL {
            for line in text_of(*page).lines().filter(|line| line.starts_with("![")) {
                open(&mut h, *page);
                let words: String = line.trim_start_matches("![").chars().take_while(|c| *c != ']').collect();
                let picture = h
                    .query_all_by_role(egui::accesskit::Role::Image)
                    .find(|node| node.accesskit_node().label().is_some_and(|label| label.starts_with(words.as_str())));
                let rect = picture.unwrap_or_else(|| panic!("no picture: {line}")).rect();
                let file = line.rsplit('[').next().and_then(|end| end.strip_suffix(']')).map(str::to_owned);
                let file = file.or_else(|| label_after(&text_of(*page), line)).expect("the picture has a label");
                let shape = aspect_ratio(&file);
                assert!(rect.width() > 400.0 && (rect.aspect_ratio() - shape).abs() < 0.01, "{rect:?}, {file}");
                shown += 1;
            }
        }
    }
    assert!(shown >= 14, "{shown}");
}

/// The label of a picture whose words go on in the next line.
fn label_after(text: &str, line: &str) -> Option<String> {
    let after = text.split_once(line)?.1.split_once("][")?.1;
    Some(after.split_once(']')?.0.to_owned())
}

/// Width of a picture's file by its height.
fn aspect_ratio(label: &str) -> f32 {
    let file = format!("{}/assets/pictures/{label}.png", env!("CARGO_MANIFEST_DIR"));
    let bytes = std::fs::read(&file).unwrap_or_else(|why| panic!("{file}: {why}"));
    // The header of a PNG file has both at its bytes 16 and 20.
    let [width, height] = [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes")));
    width as f32 / height as f32
}
