//! Reads attributes and children of elements.

use nalgebra::{Matrix3, Rotation3, Vector3};
use roxmltree::Node;

use super::refusal::{ImportError, element_error};
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::quote_clipped;

/// Maximum magnitude of a number in a file: products of larger numbers could overflow.
const MAX_MAGNITUDE: f64 = 1e9;

/// Maximum number of numbers in an attribute: a pose has one for each hinge.
const MAX_NUMBERS: usize = 1000;

/// A source of attributes: an element, or an element with the defaults of its class.
pub trait AttributeSource<'a> {
    /// Returns the value of an attribute.
    fn get(&self, name: &str) -> Option<&'a str>;
    /// Returns the element.
    fn node(&self) -> Node<'a, 'a>;
}

impl<'a> AttributeSource<'a> for Node<'a, 'a> {
    fn get(&self, name: &str) -> Option<&'a str> {
        self.attribute(name)
    }

    fn node(&self) -> Node<'a, 'a> {
        *self
    }
}

impl<'a, S: AttributeSource<'a>> AttributeSource<'a> for &S {
    fn get(&self, name: &str) -> Option<&'a str> {
        (**self).get(name)
    }

    fn node(&self) -> Node<'a, 'a> {
        (**self).node()
    }
}

/// Returns the child elements with a name.
pub fn each<'a>(node: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(move |child| child.has_tag_name(name))
}

/// Returns the first child element with a name.
pub fn child<'a>(node: Node<'a, 'a>, name: &'static str) -> Option<Node<'a, 'a>> {
    each(node, name).next()
}

/// Returns a required attribute.
pub fn word<'a>(node: impl AttributeSource<'a>, name: &'static str) -> Result<&'a str, ImportError> {
    node.get(name).ok_or_else(|| element_error(node.node(), format!("it has no {name}"), format!("{name}=\"…\"")))
}

/// Returns the numbers of an attribute; `None` if it is absent.
pub fn numbers<'a>(node: impl AttributeSource<'a>, name: &'static str) -> Result<Option<Vec<f64>>, ImportError> {
    let Some(text) = node.get(name) else { return Ok(None) };
    let number = |word: &str| {
        let value = word.parse::<f64>().ok().filter(|x| x.is_finite() && x.abs() <= MAX_MAGNITUDE);
        value.ok_or_else(|| {
            let what = format!("{name} has \"{}\"", quote_clipped(word));
            element_error(node.node(), what, "numbers from -1e9 to 1e9")
        })
    };
    let words = text.split_whitespace().take(MAX_NUMBERS + 1);
    let all: Vec<f64> = words.map(number).collect::<Result<_, _>>()?;
    match all.len() > MAX_NUMBERS {
        true => {
            Err(element_error(node.node(), format!("{name} goes on and on"), format!("at most {MAX_NUMBERS} numbers")))
        }
        false => Ok(Some(all)),
    }
}

/// Returns the `N` numbers of an attribute; `None` if it is absent.
pub fn several<'a, const N: usize>(
    node: impl AttributeSource<'a>,
    name: &'static str,
) -> Result<Option<[f64; N]>, ImportError> {
    let Some(all) = numbers(&node, name)? else { return Ok(None) };
    let count = all.len();
    all.try_into()
        .map(Some)
        .map_err(|_| element_error(node.node(), format!("{name} has {count} numbers"), format!("{N}")))
}

/// Returns the number of an attribute; `None` if it is absent.
pub fn number<'a>(node: impl AttributeSource<'a>, name: &'static str) -> Result<Option<f64>, ImportError> {
    Ok(several::<1>(node, name)?.map(|[x]| x))
}

/// Returns the number of a required attribute.
pub fn required_number<'a>(node: impl AttributeSource<'a>, name: &'static str) -> Result<f64, ImportError> {
    word(&node, name)?;
    number(node, name).map(|x| x.unwrap_or(0.0))
}

/// Returns a point or direction; `None` if it is absent.
pub fn vector<'a>(node: impl AttributeSource<'a>, name: &'static str) -> Result<Option<Vector3<f64>>, ImportError> {
    Ok(several::<3>(node, name)?.map(Vector3::from))
}

/// Returns a required mass, kg, not below 0.
pub fn mass<'a>(node: impl AttributeSource<'a>, name: &'static str) -> Result<f64, ImportError> {
    match required_number(&node, name)? {
        mass if mass >= 0.0 => Ok(mass),
        mass => {
            Err(element_error(node.node(), format!("a mass of {} kg", ShortNumber(mass)), "one that is not below 0"))
        }
    }
}

/// Returns the inertia matrix, kg m², rotated by `axes`, from its diagonal xx, yy, zz and its entries xy, xz, yz.
pub fn inertia([xx, yy, zz, xy, xz, yz]: [f64; 6], axes: &Rotation3<f64>) -> Matrix3<f64> {
    let own = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    axes * own * axes.transpose()
}
