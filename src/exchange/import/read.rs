//! Reads attributes and children of elements.

use nalgebra::{Matrix3, Rotation3, Vector3};
use roxmltree::Node;

use super::refusal::{ImportError, Mend, element_error};
use stillbase_settings::number::{ShortNumber, counted};
use stillbase_settings::range::quote_clipped;

/// Maximum magnitude of a number in a file: products of larger numbers could overflow.
const MAX_MAGNITUDE: f64 = 1e9;

/// Maximum number of numbers in an attribute: a pose has one for each hinge.
const MAX_NUMBERS: usize = 1000;

/// A value in place of one that is wrong or missing. With it the rest of the file can be judged.
const STAND_IN: &str = "1";

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

/// Makes the error of the value of an attribute, instead of which `with` may stand in the file.
fn wrong_value(node: Node<'_, '_>, name: &str, what: String, want: String, with: String) -> ImportError {
    // The value of a default stands elsewhere, and may be wrong in many elements.
    let own = node.attribute_node(name).map(|own| Mend { span: own.range_value(), with });
    element_error(node, what, want).mended_by(own)
}

/// Returns a required attribute.
pub fn word<'a>(node: impl AttributeSource<'a>, name: &'static str) -> Result<&'a str, ImportError> {
    node.get(name).ok_or_else(|| {
        let node = node.node();
        let tag = node.range().start + 1;
        let rest = node.document().input_text().get(tag..).unwrap_or_default();
        let end = rest.find(|c: char| c.is_whitespace() || matches!(c, '/' | '>')).map(|length| tag + length);
        let mend = end.map(|end| Mend { span: end..end, with: format!(" {name}=\"{STAND_IN}\"") });
        element_error(node, format!("it has no {name}"), format!("{name}=\"…\"")).mended_by(mend)
    })
}

/// Returns the numbers of an attribute; `None` if it is absent.
pub fn numbers<'a>(node: impl AttributeSource<'a>, name: &'static str) -> Result<Option<Vec<f64>>, ImportError> {
    let Some(text) = node.get(name) else { return Ok(None) };
    let number = |word: &str| {
        let value = word.parse::<f64>().ok().filter(|x| x.is_finite() && x.abs() <= MAX_MAGNITUDE);
        value.ok_or_else(|| {
            let what = format!("{name} has \"{}\"", quote_clipped(word));
            let sound = |word: &str| word.parse::<f64>().is_ok_and(|x| x.abs() <= MAX_MAGNITUDE);
            let all = text.split_whitespace().take(MAX_NUMBERS).map(|own| if sound(own) { own } else { STAND_IN });
            let with = all.collect::<Vec<_>>().join(" ");
            wrong_value(node.node(), name, what, "numbers from -1e9 to 1e9".into(), with)
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
    all.try_into().map(Some).map_err(|all: Vec<f64>| {
        let written = all.iter().map(ToString::to_string).chain(std::iter::repeat(STAND_IN.to_owned()));
        let with = written.take(N).collect::<Vec<_>>().join(" ");
        wrong_value(node.node(), name, format!("{name} has {}", counted(count, "number")), format!("{N}"), with)
    })
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
            let what = format!("a mass of {} kg", ShortNumber(mass));
            Err(wrong_value(node.node(), name, what, "one that is not below 0".into(), STAND_IN.into()))
        }
    }
}

/// Returns the inertia matrix, kg m², rotated by `axes`, from its diagonal xx, yy, zz and its entries xy, xz, yz.
pub fn inertia([xx, yy, zz, xy, xz, yz]: [f64; 6], axes: &Rotation3<f64>) -> Matrix3<f64> {
    let own = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    axes * own * axes.transpose()
}
