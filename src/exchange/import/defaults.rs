//! [`Defaults`]: the default classes of MJCF, and [`Element`]: an element with the defaults of its class.

use std::collections::BTreeMap;
use std::rc::Rc;

use roxmltree::Node;

use super::read::{AttributeSource, each};
use super::refusal::{ImportError, element_error};
use stillbase_settings::range::quote_clipped;

/// Maximum number of classes of a file, because each stores all attributes that it inherits.
const MAX_CLASSES: usize = 200;

/// Maximum number of sizes of a shape.
const MAX_SIZES: usize = 3;
/// Maximum number of attributes of a class, for all kinds of elements together.
const MAX_VALUES: usize = 1000;

/// Default attributes of a class.
#[derive(Clone, Debug, Default)]
struct Values<'a> {
    /// Attributes by the kind of element and their names.
    words: BTreeMap<(&'a str, &'a str), &'a str>,
    /// Sizes of shapes: sizes that a class or shape does not give are inherited from its parent.
    sizes: Vec<&'a str>,
}

/// A class with all attributes that it inherits.
#[derive(Clone, Debug)]
pub struct Class<'a>(Rc<Values<'a>>);

/// The classes of a file.
#[derive(Debug)]
pub struct Defaults<'a> {
    main: Class<'a>,
    named: BTreeMap<&'a str, Class<'a>>,
}

/// An element, with its class for attributes that it does not give.
#[derive(Clone, Debug)]
pub struct Element<'a> {
    node: Node<'a, 'a>,
    class: Class<'a>,
}

impl<'a> AttributeSource<'a> for Element<'a> {
    fn get(&self, name: &str) -> Option<&'a str> {
        let of_class = || self.class.0.words.get(&(kind(self.node), name)).copied();
        self.node.attribute(name).or_else(of_class)
    }

    fn node(&self) -> Node<'a, 'a> {
        self.node
    }
}

impl<'a> Element<'a> {
    /// Returns the sizes of a shape as text: its own first, and missing ones from its class.
    pub fn sizes(&self) -> Vec<&'a str> {
        let mut sizes = self.class.0.sizes.clone();
        override_sizes(&mut sizes, self.node.attribute("size"));
        sizes
    }
}

/// Replaces the first sizes by those of `own`.
fn override_sizes<'a>(sizes: &mut Vec<&'a str>, own: Option<&'a str>) {
    let own: Vec<&str> = own.unwrap_or_default().split_whitespace().take(MAX_SIZES).collect();
    let rest = sizes.split_off(own.len().min(sizes.len()));
    *sizes = own.into_iter().chain(rest).collect();
}

/// Returns the tag under which a class lists defaults of an element: its own, or one shared by several kinds.
fn kind<'a>(node: Node<'a, 'a>) -> &'a str {
    let parent = node.parent().map(|parent| parent.tag_name().name());
    match (parent, node.tag_name().name()) {
        (Some("actuator"), _) => "actuator",
        (Some("equality"), _) => "equality",
        (Some("tendon"), _) => "tendon",
        // All kinds of actuators share their defaults.
        (_, "general" | "motor" | "position" | "velocity" | "intvelocity" | "damper" | "cylinder") => "actuator",
        (_, own) => own,
    }
}

impl<'a> Defaults<'a> {
    /// Reads the classes of a `<mujoco>`.
    ///
    /// # Errors
    /// If a class has no name or the name of another, or if there are too many classes or attributes.
    pub fn of(model: Node<'a, 'a>) -> Result<Self, ImportError> {
        let mut main = Values::default();
        each(model, "default").try_for_each(|node| take(node, &mut main))?;
        let mut defaults = Self { main: Class(Rc::new(main)), named: BTreeMap::new() };
        let nested = |node: Node<'a, 'a>, class: &Class<'a>| {
            each(node, "default").map(|child| (child, class.clone())).collect::<Vec<_>>()
        };
        let mut open: Vec<(Node, Class)> =
            each(model, "default").flat_map(|node| nested(node, &defaults.main)).collect();
        for node in each(model, "default") {
            if let Some(name) = node.attribute("class") {
                defaults.named.insert(name, defaults.main.clone());
            }
        }
        while let Some((node, parent)) = open.pop() {
            let mut own = (*parent.0).clone();
            take(node, &mut own)?;
            let own = Class(Rc::new(own));
            open.extend(nested(node, &own));
            let name =
                node.attribute("class").ok_or_else(|| element_error(node, "a class without a name", "class=\"…\""))?;
            if defaults.named.insert(name, own).is_some() {
                let what = format!("a second class \"{}\"", quote_clipped(name));
                return Err(element_error(node, what, "each name once"));
            }
            if defaults.named.len() > MAX_CLASSES {
                return Err(element_error(node, "too many classes", format!("at most {MAX_CLASSES}")));
            }
        }
        Ok(defaults)
    }

    /// Returns the class of elements that name none.
    pub fn main(&self) -> Class<'a> {
        self.main.clone()
    }

    /// Returns the class that an attribute names, or `usual` if the attribute is absent.
    ///
    /// # Errors
    /// If there is no class of that name.
    pub fn class(&self, node: Node<'a, 'a>, attribute: &str, usual: &Class<'a>) -> Result<Class<'a>, ImportError> {
        let Some(name) = node.attribute(attribute) else { return Ok(usual.clone()) };
        let known = self.named.get(name).cloned();
        known.ok_or_else(|| {
            element_error(node, format!("no class \"{}\"", quote_clipped(name)), "the name of a <default>")
        })
    }

    /// Returns an element with its own class, or with the class `usual` if it names none.
    ///
    /// # Errors
    /// If its class does not exist.
    pub fn element(&self, node: Node<'a, 'a>, usual: &Class<'a>) -> Result<Element<'a>, ImportError> {
        Ok(Element { node, class: self.class(node, "class", usual)? })
    }
}

/// Adds the attributes of a `<default>`, which replace earlier ones.
fn take<'a>(node: Node<'a, 'a>, values: &mut Values<'a>) -> Result<(), ImportError> {
    for child in node.children().filter(|child| child.is_element() && !child.has_tag_name("default")) {
        values.words.extend(child.attributes().map(|attribute| ((kind(child), attribute.name()), attribute.value())));
        if child.has_tag_name("geom") {
            override_sizes(&mut values.sizes, child.attribute("size"));
        }
        if values.words.len() > MAX_VALUES {
            return Err(element_error(node, "too many attributes in a class", format!("at most {MAX_VALUES}")));
        }
    }
    Ok(())
}
