//! [`would_do`]: with which bounds there would be counterweights, all others as they are.

use super::asked::Weighing;
use super::question::One;
use super::refusal::{Kind, Relief};
use super::way::Way;

/// How much further than it has to the first of two bounds gives way, so that the second need not go to its end.
const AMPLE: f64 = 1.1;

/// A bound gives way so much further, as a fraction, until there is a way: the solver's rounding.
const NUDGES: [f64; 6] = [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// Steps in which a clearance is halved.
const HALVINGS: usize = 20;

/// Steps in a metre in which clearances are said, and in a kilogram or kg m² in which the other bounds are.
const CLEARANCE_STEPS: f64 = 1e4;
const STEPS: f64 = 1e6;

/// Each kind of bound that alone would have to give way, and how far; or where none does, two that do together, or more.
/// `does` says whether there is an answer to another question.
pub(super) fn would_do(one: &One, does: &dyn Fn(&Weighing) -> bool) -> Vec<Vec<Relief>> {
    let kinds = Kind::of(one.asked);
    let some = |bits: usize| (0..kinds.len()).filter(move |i| bits >> i & 1 == 1).map(|i| kinds[i]).collect::<Vec<_>>();
    let of_size = |size: usize| {
        let sets = (1..1_usize << kinds.len()).map(some).filter(move |set| set.len() == size);
        sets.filter_map(|set| together(one, &set, does)).collect::<Vec<_>>()
    };
    (1..=kinds.len()).map(of_size).find(|found| !found.is_empty()).unwrap_or_default()
}

/// What each of these bounds would have to be; none if that is not enough.
fn together(one: &One, kinds: &[Kind], does: &dyn Fn(&Weighing) -> bool) -> Option<Vec<Relief>> {
    let (last, first) = kinds.split_last()?;
    let (mut asked, mut reliefs) = (one.asked.clone(), Vec::new());
    for (i, kind) in first.iter().enumerate() {
        let relief = kind.rounded(AMPLE * least_bound(one, &asked, *kind, &kinds[i + 1..])?);
        relief.set(&mut asked);
        reliefs.push(relief);
    }
    let least = match last {
        Kind::Clearance => greatest_clearance(one, &asked)?,
        _ => least_bound(one, &asked, *last, &[])?,
    };
    let nudged =
        NUDGES.map(|by| last.rounded(if *last == Kind::Clearance { least * (1.0 - by) } else { least * (1.0 + by) }));
    let enough = |relief: &Relief| {
        relief.set(&mut asked);
        does(&asked)
    };
    reliefs.push(nudged.into_iter().find(enough)?);
    Some(reliefs)
}

/// The least that a bound may be where those of some other kinds are not there.
fn least_bound(one: &One, asked: &Weighing, kind: Kind, loose: &[Kind]) -> Option<f64> {
    let touching = Weighing { clearance: asked.clearance.map(|_| 0.0), ..asked.clone() };
    let asked = if loose.contains(&Kind::Clearance) { &touching } else { asked };
    let one = One { asked, ..*one };
    let way = Way { loose: loose.to_vec(), least: Some(kind), ..Way::free(asked, one.balance()) };
    one.on(&way).ok()?.ok().map(|least| least.value.max(0.0))
}

/// The furthest that discs can stay from pins, m.
fn greatest_clearance(one: &One, asked: &Weighing) -> Option<f64> {
    let is_clear = |clearance: f64| {
        let asked = Weighing { clearance: Some(clearance), ..asked.clone() };
        One { asked: &asked, ..*one }.is_possible()
    };
    if !is_clear(0.0) {
        return None;
    }
    let halved = |[low, high]: [f64; 2], _| {
        let middle = 0.5 * (low + high);
        if is_clear(middle) { [middle, high] } else { [low, middle] }
    };
    Some((0..HALVINGS).fold([0.0, asked.clearance?], halved)[0])
}

/// A number as it is read again where it was printed with so many decimals.
fn printed(x: f64, decimals: usize) -> f64 {
    format!("{x:.decimals$}").parse().unwrap_or(x)
}

impl Kind {
    /// Those of the bounds that are set.
    fn of(asked: &Weighing) -> Vec<Self> {
        let set = [
            (Self::Most, asked.sites.iter().any(|site| site.most.is_finite())),
            (Self::Mass, asked.most_mass.is_some()),
            (Self::Inertia, asked.most_inertia.is_some()),
            (Self::Clearance, asked.clearance.is_some()),
        ];
        set.into_iter().filter(|(_, set)| *set).map(|(kind, _)| kind).collect()
    }

    /// As a person types it, away from where it would not do.
    fn rounded(self, bound: f64) -> Relief {
        let up = printed((bound * STEPS).ceil().max(1.0) / STEPS, 6);
        match self {
            Self::Most => Relief::Most(up),
            Self::Mass => Relief::Mass(up),
            Self::Inertia => Relief::Inertia(up),
            Self::Clearance => Relief::Clearance(printed((bound * CLEARANCE_STEPS).floor() / CLEARANCE_STEPS, 4)),
        }
    }
}

impl Relief {
    fn set(self, asked: &mut Weighing) {
        match self {
            Self::Most(most) => {
                let bounded = asked.sites.iter_mut().filter(|site| site.most.is_finite());
                bounded.for_each(|site| site.most = most);
            }
            Self::Mass(most) => asked.most_mass = Some(most),
            Self::Inertia(most) => asked.most_inertia = Some(most),
            Self::Clearance(clearance) => asked.clearance = Some(clearance),
        }
    }
}
