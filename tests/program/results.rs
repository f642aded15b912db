//! Results that leave the program as files: chosen signals, and the report.

use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::record::RowAccessor as _;

use super::*;
use stillbase::settings::number::fixed;

/// Head and rows of a CSV file.
fn rows_of(file: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(file).expect("a file");
    let head = reader.headers().expect("head").iter().map(String::from).collect();
    (head, reader.deserialize().collect::<Result<_, _>>().expect("numbers"))
}

#[test]
fn signals_and_times_can_be_chosen() {
    let folder = Folder::new("results");
    let [csv, parquet] = ["part.csv", "part.parquet"].map(|name| word(folder.path(name)));
    let choice = ["simulate", "case-3", "--signals", "moment/total,torque", "--from", "0.25", "--to", "0.5", "-o"];
    prints(&[&choice[..], &[&csv]].concat());
    prints(&[&choice[..], &[&parquet]].concat());
    let (head, rows) = rows_of(&csv);
    assert_eq!(head, ["time s", "torque/1 N m", "torque/2 N m", "torque/3 N m", "moment/total N m"]);
    assert_eq!((rows.len(), rows[0][0], rows[250][0]), (251, 0.25, 0.5), "both bounds belong to it");
    let reader = SerializedFileReader::new(fs::File::open(&parquet).expect("a file")).expect("Parquet");
    let schema = reader.metadata().file_metadata().schema_descr();
    let names: Vec<&str> = schema.columns().iter().map(|column| column.name()).collect();
    assert_eq!(names, head);
    let read = reader.get_row_iter(None).expect("rows").map(|row| {
        let row = row.expect("a row");
        (0..row.len()).map(|i| row.get_double(i).expect("a number")).collect::<Vec<f64>>()
    });
    assert_eq!(read.collect::<Vec<_>>(), rows, "both files hold the same numbers");
    // The same values as in a whole run.
    let all = object(&["simulate", "case-3"]);
    let whole = numbers(&all["signals"]["torque/2"]);
    assert_eq!(rows.iter().map(|row| row[2]).collect::<Vec<_>>(), whole[250..=500]);
    // As JSON too; the verdict is on the whole run.
    let part = object(&["simulate", "case-3", "--signals", "torque/2", "--from", "0.25", "--to", "0.5"]);
    assert_eq!(keys(&part["signals"]), ["torque/2"]);
    assert_eq!((numbers(&part["time"]).len(), &part["verdict"]), (251, &all["verdict"]));
}

#[test]
fn a_choice_of_nothing_is_refused() {
    let folder = Folder::new("results");
    let file = word(folder.path("no.csv"));
    fails(&["simulate", "--signals", "torq", "-o", &file], 2, &["torq", "torque", "moment"]);
    fails(&["simulate", "--from", "0.5", "--to", "0.25", "-o", &file], 2, &["want the first before the second"]);
    fails(&["simulate", "--from", "7", "-o", &file], 2, &["within 0 to 1.000 s"]);
    fails(&["simulate", "--from=-1"], 2, &["0 or later"]);
    fails(&["simulate", "-o", &word(folder.path("no.xls"))], 2, &[".csv or .parquet"]);
    fails(&["joints", "-o", &word(folder.path("no.xls"))], 2, &[".csv or .parquet"]);
    assert!(folder.names().is_empty());
}

/// A scenario whose title tries to end an element.
#[cfg(feature = "window")]
fn hostile() -> String {
    let scenario = include_str!("../../assets/scenarios/case-3.toml");
    let body: Vec<&str> = scenario.lines().filter(|line| !line.starts_with("title")).collect();
    format!("title = '''</title><script>alert(\"1\")</script>&amp;<!-- '''\n{}", body.join("\n"))
}

#[cfg(feature = "window")]
#[test]
fn a_report_is_one_well_formed_page() {
    let folder = Folder::new("results");
    let file = word(folder.path("report.html"));
    let said = object(&["report", "case-1", "-o", &file, "--compare", "--set", "plant.payload.mass=0.2"]);
    let page = fs::read_to_string(&file).expect("a page");
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    let tree = roxmltree::Document::parse_with_options(&page, options).expect("well-formed");
    let has = |name: &str| tree.descendants().filter(|node| node.has_tag_name((XHTML, name))).count();
    assert_eq!((has("h1"), has("script"), has("link")), (1, 0, 0));
    assert_eq!(tree.descendants().filter(|node| node.has_tag_name((SVG, "svg"))).count() as u64, said["plots"]);
    assert_eq!(has("img") as u64, said["pictures"]);
    // Each identifier once, so that each plot is clipped to its own axes.
    let ids: Vec<&str> = tree.descendants().filter_map(|node| node.attribute("id")).collect();
    assert_eq!(ids.iter().collect::<std::collections::BTreeSet<_>>().len(), ids.len());
    // Nothing outside of the page is asked for.
    for attribute in tree.descendants().flat_map(|node| node.attributes()) {
        let (name, value) = (attribute.name(), attribute.value());
        assert!(!matches!(name, "href" | "action") && (name != "src" || value.starts_with("data:")), "{name}={value}");
    }
    assert!(!page.contains("@import") && !page.contains("url(http"));
    // The numbers that the command line answers with.
    let run = &object(&["simulate", "case-1", "--set", "plant.payload.mass=0.2", "--every", "1000"])["verdict"];
    let text: String = tree.descendants().filter_map(|node| node.text().filter(|_| node.is_text())).collect();
    for (key, decimals) in [("peak_base_moment", 9), ("peak_base_force", 9), ("rms_base_moment", 9), ("miss", 9)] {
        let number = fixed(run[key].as_f64().expect("a number"), decimals);
        assert!(text.contains(&number), "{key}: {number} is missing");
    }
    for number in numbers(&run["peak_torque"]) {
        assert!(text.contains(&fixed(number, 6)), "{number} is missing");
    }
    for subject in ["machine", "plan", "run"] {
        let statement = &run["statements"][subject];
        assert!(text.contains(statement["words"].as_str().expect("words")), "{statement}");
        assert_eq!(statement["words"], said["statements"][subject]["words"]);
    }
    let machine = object(&["check", "nine-link"]);
    assert!(text.contains(&format!("Mass {} kg", fixed(machine["mass"].as_f64().expect("kg"), 3))));
    assert!(text.contains("plant.payload.mass") && text.contains("0.2"), "the setting");
    for way in object(&["compare", "case-1", "--set", "plant.payload.mass=0.2"])["runs"].as_array().expect("runs") {
        if let Some(peak) = way["peak_felt_moment"].as_f64() {
            assert!(text.contains(&fixed(peak, 4)) || text.contains(&fixed(peak, 3)), "{way}");
        }
    }
    let again = format!("stillbase report case-1 --set plant.payload.mass=0.2 -o {file} --compare");
    assert!(text.contains(&again), "the command that repeats it");
    assert!(text.contains(&format!("Stillbase {}", env!("CARGO_PKG_VERSION"))));
}

#[cfg(feature = "window")]
const XHTML: &str = "http://www.w3.org/1999/xhtml";
#[cfg(feature = "window")]
const SVG: &str = "http://www.w3.org/2000/svg";

#[cfg(feature = "window")]
#[test]
fn no_name_gets_out_of_its_element() {
    let folder = Folder::new("results");
    let scenario = word(folder.file("<b>'&\".toml", hostile()));
    let file = word(folder.path("r.html"));
    prints(&["report", &scenario, "-o", &file]);
    let page = fs::read_to_string(&file).expect("a page");
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    let tree = roxmltree::Document::parse_with_options(&page, options).expect("well-formed");
    assert!(!tree.descendants().any(|node| node.has_tag_name((XHTML, "script"))));
    let title = tree.descendants().find(|node| node.has_tag_name((XHTML, "h1"))).and_then(|node| node.text());
    assert!(title.is_some_and(|title| title.contains("<script>alert(\"1\")</script>")), "{title:?}: shown as it is");
    assert!(!page.contains("<script"), "nothing but text");
}

#[cfg(feature = "window")]
#[test]
fn a_report_is_written_whole_or_not_at_all() {
    let folder = Folder::new("results");
    let file = word(folder.file("old.html", "old"));
    fails(&["report", "case-3", "-o", &file], 2, &["old.html exists"]);
    fails(&["report", "case-3", "-o", &word(folder.path("x.pdf"))], 2, &[".html"]);
    fails(&["report", "case-3", "-o", &word(folder.path("no/x.html"))], 2, &["no folder"]);
    fails(&["report", "nobody", "-o", &word(folder.path("x.html"))], 2, &["nobody"]);
    let refused = word(folder.path("x.html"));
    fails(&["report", "case-1", "--set", "limits.a1=0,0.1", "-o", &refused], 1, &["case-1"]);
    assert_eq!(fs::read_to_string(&file).expect("a file"), "old");
    assert_eq!(folder.names(), ["old.html"]);
    prints(&["report", "case-3", "-o", &file, "--force"]);
    assert!(fs::read_to_string(&file).expect("a page").starts_with("<!DOCTYPE html>"));
    assert_eq!(folder.names(), ["old.html"]);
}
