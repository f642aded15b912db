//! Numbers and children of elements.

use nalgebra::{Matrix3, Rotation3, Vector3};
use roxmltree::Node;

use super::refusal::{ImportError, wrong};
use crate::settings::number::Short;
use crate::settings::range::clipped;

/// The largest number that is read, either way: beyond it, products would not be finite.
const MOST: f64 = 1e9;

/// Children that are elements of a name.
pub fn each<'a>(node: Node<'a, 'a>, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(move |child| child.has_tag_name(name))
}

/// The first child of a name.
pub fn child<'a>(node: Node<'a, 'a>, name: &'static str) -> Option<Node<'a, 'a>> {
    each(node, name).next()
}

/// An attribute that has to be there.
pub fn word<'a>(node: Node<'a, 'a>, name: &'static str) -> Result<&'a str, ImportError> {
    node.attribute(name).ok_or_else(|| wrong(node, format!("it has no {name}"), format!("{name}=\"…\"")))
}

/// The numbers of an attribute, none where it is left out.
pub fn numbers(node: Node<'_, '_>, name: &'static str) -> Result<Option<Vec<f64>>, ImportError> {
    let Some(text) = node.attribute(name) else { return Ok(None) };
    let number = |word: &str| {
        let value = word.parse::<f64>().ok().filter(|x| x.is_finite() && x.abs() <= MOST);
        value.ok_or_else(|| {
            let what = format!("{name} has \"{}\"", clipped(word));
            wrong(node, what, "numbers from -1e9 to 1e9")
        })
    };
    text.split_whitespace().take(100_000).map(number).collect::<Result<_, _>>().map(Some)
}

/// So many numbers of an attribute, none where it is left out.
pub fn several<const N: usize>(node: Node<'_, '_>, name: &'static str) -> Result<Option<[f64; N]>, ImportError> {
    let Some(all) = numbers(node, name)? else { return Ok(None) };
    let count = all.len();
    all.try_into().map(Some).map_err(|_| wrong(node, format!("{name} has {count} numbers"), format!("{N}")))
}

/// One number, none where it is left out.
pub fn number(node: Node<'_, '_>, name: &'static str) -> Result<Option<f64>, ImportError> {
    Ok(several::<1>(node, name)?.map(|[x]| x))
}

/// One number that has to be there.
pub fn given(node: Node<'_, '_>, name: &'static str) -> Result<f64, ImportError> {
    word(node, name)?;
    number(node, name).map(|x| x.unwrap_or(0.0))
}

/// A point or direction.
pub fn vector(node: Node<'_, '_>, name: &'static str) -> Result<Option<Vector3<f64>>, ImportError> {
    Ok(several::<3>(node, name)?.map(Vector3::from))
}

/// A mass, kg, not below 0.
pub fn mass(node: Node<'_, '_>, name: &'static str) -> Result<f64, ImportError> {
    match given(node, name)? {
        mass if mass >= 0.0 => Ok(mass),
        mass => Err(wrong(node, format!("a mass of {} kg", Short(mass)), "one that is not below 0")),
    }
}

/// Inertias about x, y and z with those of their pairs xy, xz, yz, in axes that are turned.
pub fn inertia([xx, yy, zz, xy, xz, yz]: [f64; 6], axes: &Rotation3<f64>) -> Matrix3<f64> {
    let own = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    axes * own * axes.transpose()
}
