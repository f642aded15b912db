//! A display of one's own, with a hand on its pointer and keys.

use std::io::IoSlice;
use std::process::{Command, Stdio};
use std::time::Duration;

use x11rb::connection::{Connection as _, RequestConnection as _};
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConfigureWindowAux, ConnectionExt as _, EventMask, ImageFormat, InputFocus, MapState,
    Window,
};
use x11rb::rust_connection::RustConnection;

use super::process::{Owned, first_line};
use super::wait::{pause, wait_for};

/// A virtual screen and its server.
pub struct Display {
    pub name: String,
    conn: RustConnection,
    root: Window,
    /// Key symbols by key code, plain and shifted.
    keys: Vec<(u8, [u32; 2])>,
    /// The major opcode of the extension that plays the hand.
    hand: u8,
    pub size: [u16; 2],
    _server: Owned,
}

/// What a request of the extension does.
const PRESS_KEY: u8 = 2;
const LET_GO_KEY: u8 = 3;
const PRESS: u8 = 4;
const LET_GO: u8 = 5;
const MOVE: u8 = 6;

/// Symbols of keys that have no letter.
pub const SHIFT: u32 = 0xffe1;
pub const CTRL: u32 = 0xffe3;
pub const ALT: u32 = 0xffe9;
pub const ENTER: u32 = 0xff0d;
pub const ESC: u32 = 0xff1b;
pub const TAB: u32 = 0xff09;
pub const HOME: u32 = 0xff50;
pub const LEFT: u32 = 0xff51;
pub const UP: u32 = 0xff52;
pub const RIGHT: u32 = 0xff53;
pub const DOWN: u32 = 0xff54;
pub const END: u32 = 0xff57;
pub const DELETE: u32 = 0xffff;
pub const F12: u32 = 0xffc9;

impl Display {
    /// A screen of a size on a number that is free.
    pub fn start(size: [u16; 2]) -> Self {
        let screen = format!("{}x{}x24", size[0], size[1]);
        let mut command = Command::new("Xvfb");
        command.args(["-displayfd", "1", "-screen", "0", &screen, "-nolisten", "tcp", "-noreset"]);
        let mut server = Owned::start(command.stdout(Stdio::piped()).stderr(Stdio::null()));
        let name = format!(":{}", first_line(&mut server, "the number of the display"));
        let connect = || RustConnection::connect(Some(&name)).ok();
        let (conn, _) = wait_for("a connection to the display", 20, connect);
        let setup = conn.setup();
        let root = setup.roots[0].root;
        let (from, to) = (setup.min_keycode, setup.max_keycode);
        let mapping = conn.get_keyboard_mapping(from, to - from + 1).expect("sent").reply().expect("the keys");
        let each = usize::from(mapping.keysyms_per_keycode);
        let of = |(i, symbols): (usize, &[u32])| (from + i as u8, [symbols[0], *symbols.get(1).unwrap_or(&0)]);
        let keys = mapping.keysyms.chunks(each).enumerate().map(of).collect();
        let hand = conn.extension_information("XTEST").expect("asked").expect("Xvfb has it").major_opcode;
        Self { name, conn, root, keys, hand, size, _server: server }
    }

    fn do_by_hand(&self, what: u8, detail: u8, [x, y]: [i16; 2]) {
        let mut request = [0_u8; 36];
        request[..2].copy_from_slice(&[self.hand, 2]);
        request[2..4].copy_from_slice(&9_u16.to_ne_bytes());
        request[4..6].copy_from_slice(&[what, detail]);
        request[12..16].copy_from_slice(&self.root.to_ne_bytes());
        request[24..26].copy_from_slice(&x.to_ne_bytes());
        request[26..28].copy_from_slice(&y.to_ne_bytes());
        let sent = self.conn.send_request_without_reply(&[IoSlice::new(&request)], Vec::new());
        drop(sent.expect("the display takes it"));
        self.conn.flush().expect("the display takes it");
        // A hand is not faster either.
        pause(8);
    }

    pub fn move_to(&self, at: [i16; 2]) {
        self.do_by_hand(MOVE, 0, at);
    }

    pub fn press(&self, button: u8) {
        self.do_by_hand(PRESS, button, [0; 2]);
    }

    pub fn let_go(&self, button: u8) {
        self.do_by_hand(LET_GO, button, [0; 2]);
    }

    pub fn click(&self, at: [i16; 2]) {
        self.move_to(at);
        pause(40);
        self.press(1);
        pause(30);
        self.let_go(1);
        pause(40);
    }

    /// Presses at one place and lets go at another.
    pub fn drag(&self, from: [i16; 2], to: [i16; 2]) {
        const STEPS: i32 = 24;
        self.move_to(from);
        pause(60);
        self.press(1);
        pause(60);
        for i in 1..=STEPS {
            let between = |k: usize| from[k] + ((i32::from(to[k]) - i32::from(from[k])) * i / STEPS) as i16;
            self.move_to([between(0), between(1)]);
            pause(8);
        }
        pause(120);
        self.let_go(1);
        pause(40);
    }

    /// The key that has a symbol, and whether with Shift.
    fn key(&self, symbol: u32) -> Option<(u8, bool)> {
        let find = |i: usize| self.keys.iter().find(|(_, symbols)| symbols[i] == symbol).map(|(code, _)| *code);
        find(0).map(|code| (code, false)).or_else(|| find(1).map(|code| (code, true)))
    }

    /// Presses a key while others are held.
    pub fn keys(&self, held: &[u32], symbol: u32) {
        let (code, shifted) = self.key(symbol).unwrap_or_else(|| panic!("no key has the symbol {symbol:#x}"));
        let shift = [SHIFT];
        let held = held.iter().chain(shift.iter().filter(|_| shifted && !held.contains(&SHIFT)));
        let held: Vec<u8> = held.map(|symbol| self.key(*symbol).expect("every keyboard has it").0).collect();
        held.iter().for_each(|code| self.do_by_hand(PRESS_KEY, *code, [0; 2]));
        self.do_by_hand(PRESS_KEY, code, [0; 2]);
        pause(20);
        self.do_by_hand(LET_GO_KEY, code, [0; 2]);
        held.iter().rev().for_each(|code| self.do_by_hand(LET_GO_KEY, *code, [0; 2]));
        pause(20);
    }

    /// Presses a key.
    pub fn tap(&self, symbol: u32) {
        self.keys(&[], symbol);
    }

    /// Types letters, which are their own symbols.
    pub fn type_in(&self, text: &str) {
        text.chars().for_each(|letter| self.tap(letter as u32));
    }

    /// The window whose title has a part, if it is seen.
    pub fn titled(&self, part: &str) -> Option<Window> {
        let children = self.conn.query_tree(self.root).ok()?.reply().ok()?.children;
        children.into_iter().find(|window| {
            let seen = self.conn.get_window_attributes(*window).ok().and_then(|asked| asked.reply().ok());
            seen.is_some_and(|about| about.map_state == MapState::VIEWABLE)
                && self.title_of(*window).is_some_and(|title| title.contains(part))
        })
    }

    /// The program's main window, if it is there.
    pub fn window(&self) -> Option<Window> {
        self.titled("Stillbase")
    }

    /// Left, top, width and height of a window.
    pub fn place(&self, window: Window) -> Option<[i32; 4]> {
        let at = self.conn.get_geometry(window).ok()?.reply().ok()?;
        Some([at.x.into(), at.y.into(), at.width.into(), at.height.into()])
    }

    /// Puts a window elsewhere, as its frame would.
    pub fn put(&self, window: Window, [left, top]: [i32; 2]) {
        let wanted = ConfigureWindowAux::new().x(left).y(top);
        drop(self.conn.configure_window(window, &wanted).expect("sent").check());
    }

    fn atom(&self, name: &str) -> Option<u32> {
        Some(self.conn.intern_atom(false, name.as_bytes()).ok()?.reply().ok()?.atom)
    }

    fn title_of(&self, window: Window) -> Option<String> {
        let asked = self.conn.get_property(false, window, self.atom("_NET_WM_NAME")?, AtomEnum::ANY, 0, 1024).ok()?;
        String::from_utf8(asked.reply().ok()?.value).ok()
    }

    /// What stands above the window.
    pub fn title(&self) -> String {
        self.window().and_then(|window| self.title_of(window)).unwrap_or_default()
    }

    /// Keys go to the main window, as a window manager would have it.
    pub fn focus(&self) {
        self.window().into_iter().for_each(|window| self.focus_on(window));
    }

    /// Keys go to a window.
    pub fn focus_on(&self, window: Window) {
        let asked = self.conn.set_input_focus(InputFocus::PARENT, window, x11rb::CURRENT_TIME);
        // The window may be gone by now.
        drop(asked.map(|asked| asked.check()));
    }

    /// Asks the main window to close, as its frame would.
    pub fn close(&self) {
        self.close_one(self.window().expect("a window to close"));
    }

    /// Asks a window to close.
    pub fn close_one(&self, window: Window) {
        let [protocols, delete] = ["WM_PROTOCOLS", "WM_DELETE_WINDOW"].map(|name| self.atom(name).expect("known"));
        let event = ClientMessageEvent::new(32, window, protocols, [delete, 0, 0, 0, 0]);
        let sent = self.conn.send_event(false, window, EventMask::NO_EVENT, event);
        drop(sent.expect("the display takes it"));
        self.conn.flush().expect("the display takes it");
    }

    /// Makes the window so large.
    pub fn resize(&self, [width, height]: [u32; 2]) {
        let Some(window) = self.window() else { return };
        let wanted = ConfigureWindowAux::new().width(width).height(height);
        drop(self.conn.configure_window(window, &wanted).map(|asked| asked.check()));
        std::thread::sleep(Duration::from_millis(50));
    }

    /// What is seen, row by row.
    pub fn picture(&self) -> Picture {
        let [width, height] = self.size;
        let asked = self.conn.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, width, height, !0).expect("sent");
        let data = asked.reply().expect("a picture").data;
        let pixels = data.chunks(4).map(|p| [p[2], p[1], p[0]]).collect();
        Picture { width: usize::from(width), pixels }
    }
}

/// What a screen shows.
#[derive(PartialEq)]
pub struct Picture {
    pub width: usize,
    /// Red, green, blue.
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    fn at(&self, x: f64, y: f64) -> Option<[u8; 3]> {
        let (x, y) = (x.round(), y.round());
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64;
        self.pixels.get((y as usize) * self.width + x as usize).copied().filter(|_| inside)
    }

    /// Writes it as a PNG.
    pub fn save(&self, file: &std::path::Path) {
        let (width, bytes) = (self.width as u32, self.pixels.concat());
        let height = self.pixels.len() as u32 / width;
        image::save_buffer(file, &bytes, width, height, image::ColorType::Rgb8).expect("a file");
    }

    /// How many different colours there are.
    pub fn colours(&self) -> usize {
        self.pixels.iter().collect::<std::collections::HashSet<_>>().len()
    }

    /// How many pixels differ clearly.
    pub fn differs(&self, other: &Self) -> usize {
        let far = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).any(|k| a[k].abs_diff(b[k]) > 24);
        self.pixels.iter().zip(&other.pixels).filter(|pair| far(*pair)).count()
    }

    /// The column within left, top, width and height where the time cursor, an amber line, stands.
    pub fn cursor(&self, [left, top, width, height]: [i32; 4]) -> Option<i32> {
        let amber = |[r, g, b]: [u8; 3]| i32::from(r) - i32::from(b) > 40 && r > g && g > b && r.abs_diff(g) < 70;
        let count = |x: i32| {
            let column = (top..top + height).filter_map(|y| self.at(x.into(), y.into()));
            column.filter(|pixel| amber(*pixel)).count()
        };
        let (most, x) = (left..left + width).map(|x| (count(x), x)).max()?;
        (most > height as usize / 3).then_some(x)
    }

    /// Where the white ring of the target is within x, y, width and height.
    pub fn ring(&self, [x, y, width, height]: [i32; 4]) -> Option<[i16; 2]> {
        const RADIUS: f64 = 11.4;
        const POINTS: usize = 24;
        // A label may cover a part of it.
        const SEEN: usize = 17;
        let white = |x: f64, y: f64| self.at(x, y).is_some_and(|pixel| pixel.iter().all(|c| *c > 150));
        let on_ring = |(cx, cy): (i32, i32), i: &usize| {
            let angle = std::f64::consts::TAU * *i as f64 / POINTS as f64;
            white(f64::from(cx) + RADIUS * angle.cos(), f64::from(cy) + RADIUS * angle.sin())
        };
        let seen = |at: (i32, i32)| {
            let likely = (0..POINTS).step_by(6).filter(|i| on_ring(at, i)).count() >= 3;
            if likely { (0..POINTS).filter(|i| on_ring(at, i)).count() } else { 0 }
        };
        let all = (x..x + width).flat_map(|x| (y..y + height).map(move |y| (x, y)));
        let (seen, (x, y)) = all.map(|at| (seen(at), at)).max()?;
        (seen >= SEEN).then_some([x as i16, y as i16])
    }
}
