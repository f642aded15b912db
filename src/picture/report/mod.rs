//! The report on a run: one page for a browser, which is well-formed XML, needs no other file, and prints on a page or
//! two.

pub mod markup;
mod quantity;
mod sections;
mod table;

use std::fmt::Write as _;

use markup::{base64, escaped};

use super::charts::figure::Figure;
use super::notation::Notation;
use super::print::{Page, svg_element};
use stillbase_session::Run;
use stillbase_simulation::frame::Frame;
use stillbase_study::comparison::Comparison;

/// What a report shows.
pub struct Report<'a> {
    /// The run.
    pub run: &'a Run,
    /// Its last frame.
    pub frame: &'a Frame,
    /// Pictures of the scene, or why there are none.
    pub pictures: Result<Vec<ReportPicture>, String>,
    /// Drawings of plots.
    pub figures: &'a [Figure],
    /// The names of the runs laid over in the plots, with samples of their lines.
    pub legend: Option<&'a Figure>,
    /// Runs side by side.
    pub comparison: Option<&'a Comparison>,
    /// The command that repeats the run, or how to get one.
    pub command: Result<String, String>,
    /// Units and names in texts and tables.
    pub notation: Notation,
}

/// A picture of a report.
pub struct ReportPicture {
    /// What it shows.
    pub caption: String,
    /// The picture, as PNG.
    pub png: Vec<u8>,
}

impl Report<'_> {
    /// Returns the page.
    pub fn html(&self) -> String {
        let scenario = self.run.scenario();
        let title = escaped(if scenario.title.is_empty() { &scenario.name } else { &scenario.title });
        let mut page = format!(
            "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta \
             charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width\"/>\n<meta name=\"generator\" \
             content=\"Stillbase {}\"/>\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
             <h1>{title}</h1>\n",
            env!("CARGO_PKG_VERSION")
        );
        page += &self.verdicts();
        section(&mut page, "Start and end", &self.pictures_html());
        section(&mut page, "Results", &self.results());
        section(&mut page, "Plots", &self.figures_html());
        section(
            &mut page,
            "Runs compared",
            &self.comparison.map_or_else(String::new, |of| sections::compared(of, self.notation)),
        );
        section(&mut page, "Task", &self.task());
        section(&mut page, "Other settings that are not at their defaults", &self.settings());
        section(&mut page, "Machine", &self.machine());
        section(&mut page, "To repeat it", &self.repeat());
        page + "</body>\n</html>\n"
    }

    fn pictures_html(&self) -> String {
        match &self.pictures {
            Err(why) => format!("<p>No picture was drawn: {}</p>\n", escaped(why)),
            Ok(pictures) => row_of(
                "row",
                pictures.iter().map(|picture| {
                    let (caption, png) = (escaped(&picture.caption), base64(&picture.png));
                    format!(
                        "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{png}\"/><figcaption>{caption}\
                     </figcaption></figure>\n"
                    )
                }),
            ),
        }
    }

    fn figures_html(&self) -> String {
        let element = |figure: &Figure| svg_element(&Page::of_web(figure.clone()));
        let legend = self.legend.map(element);
        let legend = legend.map_or_else(String::new, |legend| format!("<div class=\"legend\">{legend}</div>\n"));
        legend
            + &row_of("row small", self.figures.iter().map(|figure| format!("<figure>{}</figure>\n", element(figure))))
    }

    fn repeat(&self) -> String {
        let version = env!("CARGO_PKG_VERSION");
        match &self.command {
            Ok(command) => format!("<pre>{}</pre>\n<p>Stillbase {version}</p>\n", escaped(command)),
            Err(how) => format!("<p>{}</p>\n<p>Stillbase {version}</p>\n", escaped(how)),
        }
    }
}

/// Adds a section with a heading, unless it is empty.
fn section(page: &mut String, heading: &str, content: &str) {
    if !content.is_empty() {
        let _ = write!(page, "<section>\n<h2>{}</h2>\n{content}</section>\n", escaped(heading));
    }
}

fn row_of(class: &str, figures: impl Iterator<Item = String>) -> String {
    let figures: String = figures.collect();
    if figures.is_empty() { figures } else { format!("<div class=\"{class}\">\n{figures}</div>\n") }
}

const STYLE: &str = "\
:root { color-scheme: light; }
body { font: 14px/1.4 Inter, 'DejaVu Sans', Verdana, sans-serif; color: #1d2129; background: #ffffff;
  max-width: 1060px; margin: 24px auto; padding: 0 16px; }
h1 { font-size: 24px; margin: 0 0 6px; }
h2 { font-size: 15px; margin: 18px 0 6px; border-bottom: 1px solid #dfe2e7; padding-bottom: 3px; break-after: avoid; }
p { margin: 4px 0; }
.dim { color: #6b7280; }
.good { color: #047857; font-weight: 600; }
.bad { color: #c81e1e; font-weight: 600; }
.open { color: #6b7280; font-weight: 600; }
table { border-collapse: collapse; font-size: 12px; font-variant-numeric: tabular-nums; margin: 4px 0 8px; }
.side { display: inline-table; vertical-align: top; margin-right: 28px; }
th { text-align: left; font-weight: 600; color: #6b7280; }
th, td { padding: 2px 14px 2px 0; vertical-align: top; overflow-wrap: break-word; }
tbody tr { border-top: 1px solid #eef0f3; break-inside: avoid; }
.number { text-align: right; }
.row { display: flex; flex-wrap: wrap; gap: 10px; }
figure { margin: 0; flex: 1 1 460px; max-width: 520px; break-inside: avoid; }
figure img, figure svg { width: 100%; height: auto; border: 1px solid #dfe2e7; border-radius: 4px; }
.legend svg { max-width: 100%; height: auto; margin-bottom: 6px; }
figcaption { font-size: 12px; color: #6b7280; }
pre { background: #f5f6f8; padding: 8px 10px; border-radius: 4px; white-space: pre-wrap; overflow-wrap: anywhere; }
@page { size: A4; margin: 11mm; }
@media print {
  body { font-size: 8.5pt; line-height: 1.3; max-width: none; margin: 0; padding: 0; }
  h1 { font-size: 15pt; margin-bottom: 2px; }
  h2 { font-size: 9.5pt; margin: 7px 0 2px; padding-bottom: 1px; }
  p { margin: 2px 0; }
  table, figcaption, pre { font-size: 7pt; }
  table { margin: 2px 0 4px; }
  th, td { padding: 1px 9px 1px 0; }
  .side { margin-right: 16px; }
  .row { display: block; }
  figure { display: inline-block; vertical-align: top; width: 49%; margin: 0 0.5% 3px 0; }
  .small figure { width: 31.8%; margin-right: 0.8%; }
}
";
