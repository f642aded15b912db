//! [`DesignSpace`]: the points of a study of many designs: a grid, or points that fill a box evenly.
//!
//! # Source
//! Points of a box: an additive recurrence, whose steps are powers of the generalised golden ratio, the root of
//! x^(d+1) = x + 1 (M. Roberts, *The unreasonable effectiveness of quasirandom sequences*, 2018). Point i depends on i only,
//! so parts of a study do not overlap, and more points continue the same sequence.

/// What a setting varies over.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisValues {
    /// These values, as they are typed.
    Listed(Vec<String>),
    /// Any number from the first to the second.
    Between([f64; 2]),
}

/// A setting that varies.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Key of the setting.
    pub key: String,
    /// What it varies over.
    pub values: AxisValues,
}

/// Why there is no such study.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoDesignSpace {
    /// A range without a number of points.
    #[error("{0} may be any number of its range: want a number of values, as LO:HI:N, or a number of points")]
    Endless(String),
    /// A setting that varies twice.
    #[error("{0} varies twice: want every key once")]
    Twice(String),
    /// More points than are studied.
    #[error("more than {MAX_POINTS} points: want fewer values, or a number of points")]
    TooMany,
}

/// Largest number of points.
pub const MAX_POINTS: u64 = 1_000_000_000;

/// The points of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignSpace {
    axes: Vec<Axis>,
    count: u64,
    /// Steps of the recurrence, by axis, in units of 2⁻⁶⁴; none of a grid.
    steps: Option<Vec<u64>>,
}

impl DesignSpace {
    /// Returns the grid of all combinations of values, or, if their number is given, points that fill the box evenly.
    ///
    /// # Errors
    /// If a key occurs twice, a grid has a range without values, or there are too many points.
    pub fn new(axes: Vec<Axis>, points: Option<u64>) -> Result<Self, NoDesignSpace> {
        let twice = axes.iter().enumerate().find(|(i, axis)| axes[..*i].iter().any(|other| other.key == axis.key));
        if let Some((_, axis)) = twice {
            return Err(NoDesignSpace::Twice(axis.key.clone()));
        }
        let count = match points {
            Some(points) => points,
            None => axes.iter().try_fold(1_u64, |count, axis| match &axis.values {
                AxisValues::Listed(values) => count.checked_mul(values.len() as u64).ok_or(NoDesignSpace::TooMany),
                AxisValues::Between(_) => Err(NoDesignSpace::Endless(axis.key.clone())),
            })?,
        };
        if count > MAX_POINTS {
            return Err(NoDesignSpace::TooMany);
        }
        let steps = points.map(|_| steps(axes.len()));
        Ok(Self { axes, count, steps })
    }

    /// Returns the settings that vary.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the number of points.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the values of a point, in the order of the settings, as they are typed. Of a grid the last varies fastest.
    pub fn point(&self, i: u64) -> Vec<String> {
        let mut stride = 1;
        let mut values: Vec<String> = (self.axes.iter().enumerate().rev())
            .map(|(k, axis)| {
                let place = self.steps.as_ref().map(|steps| place(i, steps[k]));
                match (&axis.values, place) {
                    (AxisValues::Listed(all), Some(place)) => {
                        all[((place * all.len() as f64) as usize).min(all.len() - 1)].clone()
                    }
                    (AxisValues::Listed(all), None) => {
                        let at = i / stride % all.len() as u64;
                        stride *= all.len() as u64;
                        all[at as usize].clone()
                    }
                    (AxisValues::Between([low, high]), place) => {
                        let place = place.unwrap_or(0.5);
                        typed(low + (high - low) * place).clamp(*low, *high).to_string()
                    }
                }
            })
            .collect();
        values.reverse();
        values
    }
}

/// Returns a number rounded to twelve digits, so that it is short when typed.
pub fn typed(x: f64) -> f64 {
    format!("{x:.11e}").parse().unwrap_or(x)
}

/// Returns where point i of a recurrence lies, from 0 to 1.
fn place(i: u64, step: u64) -> f64 {
    let at = (1_u64 << 63).wrapping_add(step.wrapping_mul(i.wrapping_add(1)));
    (at >> 11) as f64 / (1_u64 << 53) as f64
}

/// Returns the steps of a recurrence in some dimensions, in units of 2⁻⁶⁴.
fn steps(dimensions: usize) -> Vec<u64> {
    let power = dimensions as i32 + 1;
    // Newton's method from above converges monotonically.
    let mut root = 2.0_f64;
    for _ in 0..60 {
        root -= (root.powi(power) - root - 1.0) / (f64::from(power) * root.powi(power - 1) - 1.0);
    }
    (1..=dimensions as i32).map(|k| (root.powi(-k) * 2.0_f64.powi(64)) as u64).collect()
}

/// Relative difference below which two first measures are the same: far above the gap of a certificate.
const SAME: f64 = 1e-9;

/// Returns the places of those among pairs of measures, not negative, that no other pair is better than in both, by rising
/// first measure. Of pairs with the same first measure, but for rounding, one is left.
pub fn non_dominated(measures: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..measures.len()).collect();
    order.sort_by(|a, b| measures[*a][0].total_cmp(&measures[*b][0]).then(measures[*a][1].total_cmp(&measures[*b][1])));
    let mut kept: Vec<usize> = Vec::new();
    for i in order {
        let [first, second] = measures[i];
        if kept.last().is_some_and(|last| measures[*last][1] <= second) {
            continue;
        }
        if kept.last().is_some_and(|last| first - measures[*last][0] <= SAME * first) {
            kept.pop();
        }
        kept.push(i);
    }
    kept
}
