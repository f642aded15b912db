//! [`Document`]: a page of the guide as blocks of text, read from its Markdown.

use pulldown_cmark::{CodeBlockKind, Event, HeadingLevel, Options, Parser, Tag, TagEnd};

use super::pages::Page;
use super::{GuidePlace, anchor_of};
use stillbase_query::QuickQuery;

/// A page as blocks.
#[derive(Debug)]
pub struct Document {
    /// The heading of the page.
    pub title: String,
    /// Its blocks in order; the first is the heading.
    pub blocks: Vec<Block>,
}

/// A block of a page.
#[derive(Debug)]
pub struct Block {
    /// Number of lists around it.
    pub depth: usize,
    /// What stands before the first block of an item of a list: a dot or a number.
    pub marker: Option<String>,
    /// Its content.
    pub content: Content,
}

/// Content of a block.
#[derive(Debug)]
pub enum Content {
    /// A heading of this level, from 1, with its anchor.
    Heading(usize, String, Vec<Span>),
    /// A paragraph.
    Text(Vec<Span>),
    /// A block of code or console text: its kind, which is all the text after the opening fence, and its text.
    Code(String, String),
    /// The rows of a table, the heads first.
    Table(Vec<Vec<Vec<Span>>>),
    /// A picture: the name of its file without theme and extension, and what it shows.
    Picture(String, Vec<Span>),
}

/// A piece of text in one style.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Span {
    /// The text.
    pub text: String,
    /// Whether it is in bold type.
    pub strong: bool,
    /// Whether it is emphasised.
    pub emphasised: bool,
    /// Whether it is code.
    pub code: bool,
    /// Where it leads.
    pub link: Option<Target>,
}

/// Target of a link.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// A place of the guide.
    Place(GuidePlace),
    /// An address of the web.
    Web(String),
}

impl Target {
    /// Returns the target of an address on a page; `None` for files of the repository, which the window cannot show.
    fn of(address: &str, page: Page) -> Option<Self> {
        if address.starts_with("https://") || address.starts_with("http://") {
            return Some(Self::Web(address.to_owned()));
        }
        // The same pages have other addresses in the documentation of the crate.
        let address = match address.strip_prefix("crate::guide") {
            Some("") => "README.md".to_owned(),
            Some(module) => format!("{}.md", module.trim_start_matches(':')),
            None => address.to_owned(),
        };
        let (file, anchor) = address.split_once('#').unwrap_or((&address, ""));
        let page = match file.strip_suffix(".md") {
            Some(name) => Page::ALL.iter().copied().find(|page| page.file() == name)?,
            None if file.is_empty() => page,
            None => return None,
        };
        Some(Self::Place(GuidePlace { page, anchor: anchor.to_owned() }))
    }
}

/// A part of a page under one heading, to be searched.
#[derive(Debug)]
pub struct Section {
    /// Where it begins.
    pub place: GuidePlace,
    /// Heading of its page.
    pub page: String,
    /// Its heading. The first section of a page has the heading of the page.
    pub heading: String,
    /// Its text.
    pub text: String,
}

/// Query for a page as blocks.
pub struct ReadPage;

impl QuickQuery for ReadPage {
    type Input = Page;
    type Answer = Document;

    fn answer(page: &Page) -> Document {
        Document::read(page.text(), *page)
    }
}

/// Query for the sections of all pages.
pub struct Sections;

impl QuickQuery for Sections {
    type Input = ();
    type Answer = Vec<Section>;

    fn answer((): &()) -> Vec<Section> {
        let mut sections: Vec<Section> = Vec::new();
        for page in Page::ALL {
            let Document { title, blocks } = Document::read(page.text(), *page);
            for Block { content, .. } in blocks {
                match (&content, sections.last_mut()) {
                    (Content::Heading(level, anchor, spans), _) => {
                        let anchor = if *level == 1 { String::new() } else { anchor.clone() };
                        let place = GuidePlace { page: *page, anchor };
                        let heading = plain_text(spans);
                        sections.push(Section { place, page: title.clone(), heading, text: String::new() });
                    }
                    (content, Some(section)) => section.text += &content.plain_text(),
                    (_, None) => {}
                }
            }
        }
        sections
    }
}

impl Content {
    /// Returns the text without its style.
    fn plain_text(&self) -> String {
        let mut text = match self {
            Self::Heading(_, _, spans) | Self::Text(spans) | Self::Picture(_, spans) => plain_text(spans),
            Self::Code(_, text) => text.clone(),
            Self::Table(rows) => rows.iter().flatten().map(|cell| plain_text(cell)).collect::<Vec<_>>().join(" "),
        };
        text.push('\n');
        text
    }
}

/// Returns the text of spans without their style.
pub fn plain_text(spans: &[Span]) -> String {
    spans.iter().map(|span| span.text.as_str()).collect()
}

impl Document {
    /// Reads Markdown; links to an anchor alone refer to `page`.
    pub fn read(text: &str, page: Page) -> Self {
        let mut reader = Reader { page, ..Reader::default() };
        Parser::new_ext(text, Options::ENABLE_TABLES).for_each(|event| reader.take(event));
        reader.end_text();
        let title = reader.blocks.iter().find_map(|block| match &block.content {
            Content::Heading(_, _, spans) => Some(plain_text(spans)),
            _ => None,
        });
        Self { title: title.unwrap_or_default(), blocks: reader.blocks }
    }
}

/// State of the reader between two events.
struct Reader {
    page: Page,
    blocks: Vec<Block>,
    /// Spans of the text under way, and the style of the next one.
    spans: Vec<Span>,
    style: Span,
    /// Next number of each list around, if it is numbered.
    lists: Vec<Option<u64>>,
    marker: Option<String>,
    /// Name of the picture under way.
    picture: String,
    /// Kind and text of the block of code under way.
    code: Option<(String, String)>,
    /// Rows of the table under way.
    table: Option<Vec<Vec<Vec<Span>>>>,
}

impl Default for Reader {
    fn default() -> Self {
        Self {
            page: Page::Index,
            blocks: Vec::new(),
            spans: Vec::new(),
            style: Span::default(),
            lists: Vec::new(),
            marker: None,
            picture: String::new(),
            code: None,
            table: None,
        }
    }
}

impl Reader {
    fn take(&mut self, event: Event<'_>) {
        match event {
            Event::Start(tag) => self.start(tag),
            Event::End(tag) => self.end(tag),
            Event::Text(text) => match &mut self.code {
                Some((_, code)) => code.push_str(&text),
                None => self.say(&text, false),
            },
            Event::Code(text) => self.say(&text, true),
            Event::SoftBreak => self.say(" ", false),
            Event::HardBreak => self.say("\n", false),
            _ => {}
        }
    }

    fn start(&mut self, tag: Tag<'_>) {
        match tag {
            Tag::Strong => self.style.strong = true,
            Tag::Emphasis => self.style.emphasised = true,
            Tag::Link { dest_url, .. } => self.style.link = Target::of(&dest_url, self.page),
            Tag::Image { dest_url, .. } => {
                self.end_text();
                self.picture = super::picture::name_of(&dest_url).to_owned();
            }
            Tag::Paragraph | Tag::Heading { .. } => self.end_text(),
            Tag::List(first) => {
                self.end_text();
                self.lists.push(first);
            }
            Tag::Item => {
                self.marker = Some(match self.lists.last_mut() {
                    Some(Some(number)) => {
                        *number += 1;
                        format!("{}.", *number - 1)
                    }
                    _ => "•".into(),
                });
            }
            Tag::CodeBlock(kind) => {
                self.end_text();
                let kind = match kind {
                    CodeBlockKind::Fenced(kind) => kind.to_string(),
                    CodeBlockKind::Indented => String::new(),
                };
                self.code = Some((kind, String::new()));
            }
            Tag::Table(_) => self.table = Some(Vec::new()),
            Tag::TableHead | Tag::TableRow => self.table.iter_mut().for_each(|rows| rows.push(Vec::new())),
            _ => {}
        }
    }

    fn end(&mut self, tag: TagEnd) {
        match tag {
            TagEnd::Strong => self.style.strong = false,
            TagEnd::Emphasis => self.style.emphasised = false,
            TagEnd::Link => self.style.link = None,
            TagEnd::Heading(level) => {
                let spans = std::mem::take(&mut self.spans);
                let anchor = anchor_of(&plain_text(&spans));
                self.push(Content::Heading(level_of(level), anchor, spans));
            }
            TagEnd::Image => {
                let spans = std::mem::take(&mut self.spans);
                let name = std::mem::take(&mut self.picture);
                self.push(Content::Picture(name, spans));
            }
            TagEnd::Paragraph | TagEnd::Item => self.end_text(),
            TagEnd::List(_) => {
                self.end_text();
                self.lists.pop();
            }
            TagEnd::CodeBlock => {
                if let Some((kind, text)) = self.code.take() {
                    self.push(Content::Code(kind, text));
                }
            }
            TagEnd::TableCell => {
                let cell = std::mem::take(&mut self.spans);
                self.table.iter_mut().filter_map(|rows| rows.last_mut()).for_each(|row| row.push(cell.clone()));
            }
            TagEnd::Table => {
                if let Some(rows) = self.table.take() {
                    self.push(Content::Table(rows));
                }
            }
            _ => {}
        }
    }

    fn say(&mut self, text: &str, code: bool) {
        self.spans.push(Span { text: text.to_owned(), code, ..self.style.clone() });
    }

    /// Ends the paragraph under way, if there is one.
    fn end_text(&mut self) {
        let spans = std::mem::take(&mut self.spans);
        if !plain_text(&spans).trim().is_empty() {
            self.push(Content::Text(spans));
        }
    }

    fn push(&mut self, content: Content) {
        self.blocks.push(Block { depth: self.lists.len(), marker: self.marker.take(), content });
    }
}

fn level_of(level: HeadingLevel) -> usize {
    level as usize
}
