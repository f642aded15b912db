//! [`ComparedNumber`]: a value of the given motion next to that of the proposed one.

use super::imported::ImportedMotion;
use super::judge::{MotionEffects, Proposal};
use super::momentum::ZERO_MOMENTUM;

/// A value of the given and of the proposed motion.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedNumber {
    /// Name of the value.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Value of the given motion, if it has one.
    pub given: Option<f64>,
    /// Value of the proposal, if there is one.
    pub proposed: Option<f64>,
    /// Number of decimals to show.
    pub decimals: usize,
    /// Whether the value exists for both kinds of motions.
    pub of_both: bool,
}

impl ImportedMotion {
    /// Returns the values of both motions: reactions on the base, torques, b.
    pub fn lines(&self) -> Vec<ComparedNumber> {
        let (given, proposal) = (self.given.as_ref(), self.proposal.as_ref());
        let both =
            |name: String, of: &dyn Fn(&MotionEffects) -> f64, decimals: usize, unit: &'static str| ComparedNumber {
                name,
                unit,
                given: given.map(of),
                proposed: proposal.map(|p| of(&p.account)),
                decimals,
                of_both: true,
            };
        let mut lines = vec![
            both("peak |n_B|".into(), &|a| a.peak_base_moment, 9, "N m"),
            both("rms n_B".into(), &|a| a.rms_base_moment, 9, "N m"),
            both("∫ |n_B| dt".into(), &|a| a.moment_impulse, 9, "N m s"),
            both("peak |f_B|".into(), &|a| a.peak_base_force, 9, "N"),
            both("rms f_B".into(), &|a| a.rms_base_force, 9, "N"),
        ];
        if given.or(proposal.map(|p| &p.account)).is_some_and(|a| a.base_turn.is_some()) {
            lines.push(both("peak turn of the base".into(), &|a| a.peak_base_turn.unwrap_or_default(), 6, "rad"));
            lines.push(both("turn of the base at the end".into(), &|a| a.base_turn.unwrap_or_default(), 6, "rad"));
        }
        let drives = given.or(proposal.map(|p| &p.account)).map_or(0, |a| a.peak_torque.len());
        lines.extend((0..drives).map(|k| both(format!("peak |τ_{}|", k + 1), &|a| a.peak_torque[k], 6, "N m")));
        if self.has_b {
            lines.push(both("least b on the way".into(), &|a| a.b_range[0], 6, "rad"));
            lines.push(both("greatest b on the way".into(), &|a| a.b_range[1], 6, "rad"));
        }
        // The spline may exceed the samples: show both where they differ.
        let range = given.map(|a| a.b_range).filter(|_| self.has_b);
        if let Some(([low, high], [least, greatest])) = self.b_samples.zip(range)
            && (low - least).max(greatest - high) > 5e-7
        {
            let of_samples = |name: &str, b: f64| {
                let (name, given) = (name.to_owned(), Some(b));
                ComparedNumber { name, unit: "rad", given, proposed: None, decimals: 6, of_both: false }
            };
            lines.push(of_samples("least b of the samples", low));
            lines.push(of_samples("greatest b of the samples", high));
        }
        lines.push(both("momentum about B at the end".into(), &|a| a.angular_momentum_end, 9, "kg m²/s"));
        lines.extend(proposal.into_iter().flat_map(|proposal| proposal.lines(given.is_some())));
        lines
    }
}

impl Proposal {
    /// Returns the values that only the proposal has.
    fn lines(&self, is_measured_from_given: bool) -> Vec<ComparedNumber> {
        let line = |name: String, value: f64, decimals: usize, unit: &'static str| {
            let proposed = Some(value);
            ComparedNumber { name, unit, given: None, proposed, decimals, of_both: false }
        };
        let mut lines = Vec::new();
        if is_measured_from_given {
            lines.push(line("end effector off by up to".into(), self.tip_deviation, 9, "m"));
            let joints = self.joint_deviation.iter().enumerate();
            lines.extend(joints.map(|(k, off)| line(format!("drive {} off by up to", k + 1), *off, 6, "rad")));
            lines.push(line("drives off, rms".into(), self.rms_deviation, 6, "rad"));
        }
        lines.push(line("simulated: peak |n_B|".into(), self.simulated_peak_base_moment, 9, "N m"));
        lines
    }

    /// Returns in words what the base feels no more.
    pub fn effect(&self) -> &'static str {
        if self.reactionless { "no reactions" } else { "the base does not turn" }
    }

    /// Returns whether b is constant, if the machine has one.
    pub fn holds_b(&self) -> bool {
        self.way != ZERO_MOMENTUM
    }

    /// Returns in words what the proposal keeps of the given motion.
    pub fn keeps(&self) -> &'static str {
        match self.way {
            "turned" => "the relative joint angles kept, the arm turned as a whole",
            "same-tip" => "the end effector's motion kept",
            "as-given" => "the motion as it is",
            ZERO_MOMENTUM => "the end effector's motion kept, without angular momentum",
            _ => "the end effector's motion on one plane",
        }
    }
}
