//! [`Defaults`]: what elements of MJCF are by their classes, and [`Element`]: one with what its class says.

use std::collections::BTreeMap;
use std::rc::Rc;

use roxmltree::Node;

use super::read::{Source, each};
use super::refusal::{ImportError, wrong};
use crate::settings::range::clipped;

/// The most classes of a file: each holds all that it inherits.
const MAX_CLASSES: usize = 200;

/// The most sizes of a shape.
const MAX_SIZES: usize = 3;
/// The most attributes that a class gives all kinds of elements together.
const MAX_VALUES: usize = 1000;

/// What a class says.
#[derive(Clone, Debug, Default)]
struct Values<'a> {
    /// Attributes by the kind of element and their names.
    words: BTreeMap<(&'a str, &'a str), &'a str>,
    /// Sizes of shapes: of what a class or shape leaves out those of its parent stay.
    sizes: Vec<&'a str>,
}

/// A class with all that it inherits.
#[derive(Clone, Debug)]
pub struct Class<'a>(Rc<Values<'a>>);

/// The classes of a file.
#[derive(Debug)]
pub struct Defaults<'a> {
    main: Class<'a>,
    named: BTreeMap<&'a str, Class<'a>>,
}

/// An element, and what its class says where it says nothing.
#[derive(Clone, Debug)]
pub struct Element<'a> {
    node: Node<'a, 'a>,
    class: Class<'a>,
}

impl<'a> Source<'a> for Element<'a> {
    fn get(&self, name: &str) -> Option<&'a str> {
        let of_class = || self.class.0.words.get(&(kind(self.node), name)).copied();
        self.node.attribute(name).or_else(of_class)
    }

    fn node(&self) -> Node<'a, 'a> {
        self.node
    }
}

impl<'a> Element<'a> {
    /// Sizes of a shape as they stand: its own, and after them those of its class.
    pub fn sizes(&self) -> Vec<&'a str> {
        let mut sizes = self.class.0.sizes.clone();
        over(&mut sizes, self.node.attribute("size"));
        sizes
    }
}

/// The first sizes of these replaced.
fn over<'a>(sizes: &mut Vec<&'a str>, own: Option<&'a str>) {
    let own: Vec<&str> = own.unwrap_or_default().split_whitespace().take(MAX_SIZES).collect();
    let rest = sizes.split_off(own.len().min(sizes.len()));
    *sizes = own.into_iter().chain(rest).collect();
}

/// Under which tag a class speaks of an element: that of the element, or one that stands for several.
fn kind<'a>(node: Node<'a, 'a>) -> &'a str {
    let parent = node.parent().map(|parent| parent.tag_name().name());
    match (parent, node.tag_name().name()) {
        (Some("actuator"), _) => "actuator",
        (Some("equality"), _) => "equality",
        (Some("tendon"), _) => "tendon",
        // Shortcuts of actuators share what they say.
        (_, "general" | "motor" | "position" | "velocity" | "intvelocity" | "damper" | "cylinder") => "actuator",
        (_, own) => own,
    }
}

impl<'a> Defaults<'a> {
    /// Of a `<mujoco>`.
    ///
    /// # Errors
    /// If a class has no name or one that is taken, or there are too many.
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
            let name = node.attribute("class").ok_or_else(|| wrong(node, "a class without a name", "class=\"…\""))?;
            if defaults.named.insert(name, own).is_some() {
                let what = format!("a second class \"{}\"", clipped(name));
                return Err(wrong(node, what, "names that stand once"));
            }
            if defaults.named.len() > MAX_CLASSES {
                return Err(wrong(node, "too many classes", format!("at most {MAX_CLASSES}")));
            }
        }
        Ok(defaults)
    }

    /// The class of all that names none.
    pub fn main(&self) -> Class<'a> {
        self.main.clone()
    }

    /// The class that an attribute names; `usual` where it is left out.
    ///
    /// # Errors
    /// If there is none of that name.
    pub fn class(&self, node: Node<'a, 'a>, attribute: &str, usual: &Class<'a>) -> Result<Class<'a>, ImportError> {
        let Some(name) = node.attribute(attribute) else { return Ok(usual.clone()) };
        let known = self.named.get(name).cloned();
        known.ok_or_else(|| wrong(node, format!("no class \"{}\"", clipped(name)), "the name of a <default>"))
    }

    /// An element by its own class, or by the usual one of where it stands.
    ///
    /// # Errors
    /// If its class is none.
    pub fn element(&self, node: Node<'a, 'a>, usual: &Class<'a>) -> Result<Element<'a>, ImportError> {
        Ok(Element { node, class: self.class(node, "class", usual)? })
    }
}

/// What a `<default>` says, over what is there.
fn take<'a>(node: Node<'a, 'a>, values: &mut Values<'a>) -> Result<(), ImportError> {
    for child in node.children().filter(|child| child.is_element() && !child.has_tag_name("default")) {
        values.words.extend(child.attributes().map(|attribute| ((kind(child), attribute.name()), attribute.value())));
        if child.has_tag_name("geom") {
            over(&mut values.sizes, child.attribute("size"));
        }
        if values.words.len() > MAX_VALUES {
            return Err(wrong(node, "too many attributes in a class", format!("at most {MAX_VALUES}")));
        }
    }
    Ok(())
}
