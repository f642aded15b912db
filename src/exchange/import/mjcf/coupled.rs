//! [`CoupledBodies`]: bodies, with the sets that turn together and the couplings between them.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use roxmltree::Node;

use super::together::CoupledSets;
use crate::import::bodies::{AttachmentPoint, MjcfBodies};
use crate::import::linkage::{MAX_PARTS, common_axis, owners, plane};
use crate::import::read::{AttributeSource, each, number, word};
use crate::import::refusal::{ImportError, element_error};
use stillbase_settings::range::quote_clipped;

/// The couplings that are supported, for messages.
pub(super) const PARALLEL_WANTED: &str = "a rotor on its motor's body, coupled to the driven body, or hinges whose \
                                          coupling by 1 or -1 keeps two bodies parallel, as a belt from the base \
                                          does";

/// A set, and another relative to which it turns.
pub(super) type RelativeSet = (usize, usize);
/// A weighted sum of hinge angles about the common axis: parts with coefficients.
pub(super) type HingeSum = Vec<(usize, f64)>;

/// A part that is coupled to a sum of hinges with a gear ratio.
pub(super) struct GearedPart<'a> {
    pub part: usize,
    pub node: Node<'a, 'a>,
    pub to: HingeSum,
    pub ratio: f64,
}

/// Bodies, with the sets that their loops and equalities keep parallel.
pub(super) struct CoupledBodies<'a> {
    pub bodies: MjcfBodies<'a>,
    pub signs: Vec<f64>,
    /// Two axes of the plane, and its normal.
    pub plane: [Vector3<f64>; 3],
    pub owners: Vec<Option<usize>>,
    /// Index of the base, which follows those of the parts.
    pub base: usize,
    pub tendons: BTreeMap<&'a str, HingeSum>,
    pub together: CoupledSets,
    pub geared: Vec<GearedPart<'a>>,
    pub loops: Vec<[AttachmentPoint; 2]>,
}

impl<'a> CoupledBodies<'a> {
    /// Begins with bodies, before any equality is read.
    ///
    /// # Errors
    /// If the hinges have no common axis, or if a tendon is wrong.
    pub fn of(bodies: MjcfBodies<'a>) -> Result<Self, ImportError> {
        let (normal, signs) = common_axis(&bodies.parts)?;
        bodies.floating().map_or(Ok(()), |base| base.check_plane(&normal))?;
        let (owners, base) = (owners(&bodies.parts), bodies.parts.len());
        let tendons = tendons(&bodies, &signs)?;
        Ok(Self {
            signs,
            plane: plane(&normal),
            owners,
            base,
            tendons,
            together: CoupledSets::new(base),
            geared: Vec::new(),
            loops: Vec::new(),
            bodies,
        })
    }

    /// Returns the sum of the fixed tendon that an attribute names.
    pub fn tendon(&self, element: impl AttributeSource<'a>, attribute: &'static str) -> Result<HingeSum, ImportError> {
        let name = word(&element, attribute)?;
        let what = || format!("{attribute} \"{}\" is no fixed tendon", quote_clipped(name));
        self.tendons.get(name).cloned().ok_or_else(|| element_error(element.node(), what(), "the name of one"))
    }

    /// Returns the turning part with which a part moves, itself or the part to which it is fixed; the base otherwise.
    pub fn owner(&self, part: Option<usize>) -> usize {
        part.and_then(|part| self.owners[part]).unwrap_or(self.base)
    }

    /// Returns the turning part, or the base, that carries the hinge of a part.
    pub fn on(&self, part: usize) -> usize {
        self.owner(self.bodies.parts[part].parent)
    }

    /// Returns the set to which a part belongs.
    pub fn set(&self, part: usize) -> usize {
        self.together.root(part)
    }

    /// Returns the two parts whose relative angle equals a sum of hinge angles; `None` if there are none.
    pub fn against(&self, sum: &[(usize, f64)]) -> Option<RelativeSet> {
        let mut turns: BTreeMap<usize, f64> = BTreeMap::new();
        for (part, times) in sum {
            *turns.entry(self.owner(Some(*part))).or_default() += times;
            *turns.entry(self.on(*part)).or_default() -= times;
        }
        turns.retain(|_, times| *times != 0.0);
        let of = |times: f64| turns.iter().find(|(_, own)| **own == times).map(|(part, _)| *part);
        (turns.len() == 2).then(|| Some((of(1.0)?, of(-1.0)?))).flatten()
    }

    /// Returns the same as [`against`](Self::against).
    ///
    /// # Errors
    /// If the sum is not the angle between two parts.
    pub fn turned(&self, node: Node<'_, '_>, sum: &[(usize, f64)]) -> Result<RelativeSet, ImportError> {
        let want = "a sum of hinges from one body to another";
        self.against(sum).ok_or_else(|| element_error(node, "no body turns against another by its tendon", want))
    }
}

/// Reads the fixed tendons by name.
fn tendons<'a>(bodies: &MjcfBodies<'a>, signs: &[f64]) -> Result<BTreeMap<&'a str, HingeSum>, ImportError> {
    let mut all = BTreeMap::new();
    let fixed = each(bodies.model, "tendon").flat_map(|node| each(node, "fixed"));
    for (count, node) in fixed.enumerate() {
        if count == MAX_PARTS || each(node, "joint").nth(MAX_PARTS).is_some() {
            return Err(element_error(node, "too many tendons, or hinges of one", format!("at most {MAX_PARTS}")));
        }
        let mut sum = Vec::new();
        for joint in each(node, "joint") {
            let part = bodies.part_of(joint, "joint")?;
            sum.push((part, signs[part] * number(joint, "coef")?.unwrap_or(1.0)));
        }
        all.insert(word(node, "name")?, sum);
    }
    Ok(all)
}

/// Returns a sum sorted by hinges, with its sign chosen so that the first coefficient is not negative.
pub(super) fn unsigned(sum: &[(usize, f64)]) -> HingeSum {
    let mut sum = sum.to_vec();
    sum.sort_by_key(|(part, _)| *part);
    if sum.first().is_some_and(|(_, times)| *times < 0.0) {
        sum.iter_mut().for_each(|(_, times)| *times = -*times);
    }
    sum
}
