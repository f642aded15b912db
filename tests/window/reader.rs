//! A screen reader: what the running program says of itself on the accessibility bus.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use pollster::block_on;
use zbus::Connection;
use zbus::connection::Builder;
use zbus::zvariant::{OwnedObjectPath, OwnedValue};

use super::process::{Owned, first_line};
use super::wait::{wait_for, within};
use crate::folder::Folder;

/// The bus of a session with nothing on it, and the accessibility bus beside it.
pub struct Bus {
    pub address: String,
    accessible: Connection,
    _launcher: Owned,
    _session: Owned,
    _sockets: Sockets,
}

/// A folder of its own for sockets, whose names must be short.
struct Sockets(PathBuf);

impl Sockets {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("stillbase-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }
}

impl Drop for Sockets {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Whoever looks for services on it finds none: no dialog of the system opens by itself.
const SESSION: &str = "<busconfig><type>session</type><listen>unix:tmpdir=/tmp</listen><auth>EXTERNAL</auth>\
    <policy context=\"default\"><allow send_destination=\"*\" eavesdrop=\"true\"/><allow eavesdrop=\"true\"/>\
    <allow own=\"*\"/></policy></busconfig>";

const LAUNCHERS: [&str; 3] =
    ["/usr/libexec/at-spi-bus-launcher", "/usr/lib/at-spi2-core/at-spi-bus-launcher", "/usr/lib/at-spi-bus-launcher"];

/// The program that starts the accessibility bus.
pub fn launcher() -> Option<&'static str> {
    LAUNCHERS.into_iter().find(|launcher| Path::new(launcher).exists())
}

pub fn connect(address: &str) -> Option<Connection> {
    let builder = Builder::address(address).ok()?.method_timeout(Duration::from_secs(20));
    block_on(builder.build()).ok()
}

impl Bus {
    /// Both, with their files in a folder.
    pub fn start(folder: &Folder) -> Self {
        let (config, sockets) = (folder.file("session.conf", SESSION), Sockets::new());
        let mut command = Command::new("dbus-daemon");
        command.args(["--nofork", "--nopidfile", "--print-address=1", "--config-file"]).arg(config);
        let mut session = Owned::start(command.stdout(Stdio::piped()).stderr(Stdio::null()));
        let address = first_line(&mut session, "the address of the bus");
        let mut command = Command::new(launcher().expect("looked for before"));
        command.args(["--launch-immediately", "--a11y=1"]).env("DBUS_SESSION_BUS_ADDRESS", &address);
        command.env("XDG_RUNTIME_DIR", &sockets.0).env("XDG_CACHE_HOME", &sockets.0).env_remove("DISPLAY");
        let launcher = Owned::start(command.stdout(Stdio::null()).stderr(Stdio::null()));
        let accessible = wait_for("the accessibility bus", 20, || {
            let session = connect(&address)?;
            let (to, at) = (Some("org.a11y.Bus"), "/org/a11y/bus");
            let reply = block_on(session.call_method(to, at, Some("org.a11y.Bus"), "GetAddress", &())).ok()?;
            connect(&reply.body().deserialize::<String>().ok()?)
        });
        Self { address, accessible, _launcher: launcher, _session: session, _sockets: sockets }
    }

    fn ask<B, R>(&self, of: (&str, &str), interface: &str, what: &str, body: &B) -> Option<R>
    where
        B: serde::Serialize + zbus::zvariant::DynamicType,
        R: serde::de::DeserializeOwned + zbus::zvariant::Type,
    {
        let reply = block_on(self.accessible.call_method(Some(of.0), of.1, Some(interface), what, body)).ok()?;
        reply.body().deserialize().ok()
    }

    /// Names on the bus of the programs that can be read.
    fn programs(&self) -> Vec<String> {
        let registry = ("org.a11y.atspi.Registry", "/org/a11y/atspi/accessible/root");
        let children: Option<Vec<Reference>> = self.ask(registry, ACCESSIBLE, "GetChildren", &());
        children.unwrap_or_default().into_iter().map(|(name, _)| name).collect()
    }

    /// All that the program shows, in no order; nothing if there is none, or one that does not answer.
    pub fn tree(&self) -> Option<Tree<'_>> {
        let program = self.programs().pop()?;
        let cache = (program.as_str(), "/org/a11y/atspi/cache");
        let items: Vec<Item> = self.ask(cache, "org.a11y.atspi.Cache", "GetItems", &())?;
        let node = |(own, _, _, _, _, _, name, role, _, states): Item| Node {
            path: own.1.to_string(),
            name,
            role,
            states: states.iter().rev().fold(0, |all, word| all << 32 | u64::from(*word)),
        };
        Some(Tree { bus: self, nodes: items.into_iter().map(node).collect(), program })
    }

    /// What is found in the tree within so many seconds.
    #[track_caller]
    pub fn wait_for<T>(&self, what: &str, seconds: u32, look: impl Fn(&Tree) -> Option<T>) -> T {
        let found = within(seconds, || look(&self.tree()?));
        found.unwrap_or_else(|| match self.tree() {
            Some(tree) => panic!("waited {seconds} s in vain for {what}; there is {:#?}", tree.names()),
            None => panic!("waited {seconds} s in vain for {what}: the program does not answer"),
        })
    }

    /// The node of a role and name, once it is there.
    #[track_caller]
    pub fn node_as(&self, role: u32, name: &str) -> Node {
        self.wait_for(&format!("\"{name}\""), 20, |tree| tree.find_as(role, name).cloned())
    }
}

type Reference = (String, OwnedObjectPath);
type Item = (Reference, Reference, Reference, i32, i32, Vec<String>, String, u32, String, Vec<u32>);

const ACCESSIBLE: &str = "org.a11y.atspi.Accessible";

/// Roles by their number on the bus.
pub const LABEL: u32 = 29;
pub const BUTTON: u32 = 43;
pub const SLIDER: u32 = 51;
pub const SPIN_BUTTON: u32 = 52;

const FOCUSED: u32 = 12;

/// What the program shows at an instant.
pub struct Tree<'a> {
    bus: &'a Bus,
    pub nodes: Vec<Node>,
    program: String,
}

/// Something that it shows.
#[derive(Clone, Debug)]
pub struct Node {
    path: String,
    pub name: String,
    pub role: u32,
    states: u64,
}

impl Node {
    pub fn is_focused(&self) -> bool {
        self.states >> FOCUSED & 1 == 1
    }
}

impl Tree<'_> {
    /// By its whole name.
    pub fn find(&self, name: &str) -> Option<&Node> {
        self.nodes.iter().find(|node| node.name == name)
    }

    pub fn find_as(&self, role: u32, name: &str) -> Option<&Node> {
        self.nodes.iter().find(|node| node.role == role && node.name == name)
    }

    /// By a part of its name.
    pub fn containing(&self, part: &str) -> Option<&Node> {
        self.nodes.iter().find(|node| node.name.contains(part))
    }

    pub fn focused(&self) -> Option<&Node> {
        self.nodes.iter().find(|node| node.is_focused())
    }

    /// What a reader would read out.
    pub fn names(&self) -> Vec<String> {
        let named = self.nodes.iter().filter(|node| !node.name.is_empty());
        named.map(|node| format!("{}: {}", node.role, node.name)).collect()
    }

    /// Left, top, width and height on the screen.
    pub fn place(&self, node: &Node) -> Option<[i32; 4]> {
        let (of, component) = ((self.program.as_str(), node.path.as_str()), "org.a11y.atspi.Component");
        let (x, y, width, height): (i32, i32, i32, i32) = self.bus.ask(of, component, "GetExtents", &0_u32)?;
        Some([x, y, width, height])
    }

    /// The middle of a node on the screen.
    pub fn middle(&self, node: &Node) -> Option<[i16; 2]> {
        let [x, y, width, height] = self.place(node)?;
        Some([(x + width / 2) as i16, (y + height / 2) as i16])
    }

    fn number(&self, node: &Node, which: &str) -> Option<f64> {
        let (of, property) = ((self.program.as_str(), node.path.as_str()), "org.freedesktop.DBus.Properties");
        let value: OwnedValue = self.bus.ask(of, property, "Get", &("org.a11y.atspi.Value", which))?;
        f64::try_from(value).ok()
    }

    /// The number that a slider or field has.
    pub fn value(&self, node: &Node) -> Option<f64> {
        self.number(node, "CurrentValue")
    }

    /// Between which numbers it can be.
    pub fn range(&self, node: &Node) -> Option<[f64; 2]> {
        Some([self.number(node, "MinimumValue")?, self.number(node, "MaximumValue")?])
    }
}
