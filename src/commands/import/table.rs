//! The answer of `stillbase import` as a table.

use stillbase::settings::number::{counted, fixed};
use stillbase::study::import::{Account, Imported};

use crate::commands::output::{Table, yes};

/// Given and proposed side by side.
pub fn table(answer: &Imported) -> String {
    let usual = if answer.content == "tip" { "minimum norm" } else { "as given" };
    let mut table = Table::new(["", usual, "proposed", ""]).with_words(3);
    let cell = |value: Option<f64>, decimals| value.map_or_else(|| "-".into(), |x| fixed(x, decimals));
    let (given, proposal) = (answer.given.as_ref(), answer.proposal.as_ref());
    let mut row = |name: &str, of: &dyn Fn(&Account) -> f64, decimals: usize, unit: &str| {
        let both = [given.map(of), proposal.map(|p| of(&p.account))];
        table.row([name.into(), cell(both[0], decimals), cell(both[1], decimals), unit.into()]);
    };
    row("peak |n_B|", &|a| a.peak_base_moment, 9, "N m");
    row("rms n_B", &|a| a.rms_base_moment, 9, "N m");
    row("∫ |n_B| dt", &|a| a.moment_impulse, 9, "N m s");
    row("peak |f_B|", &|a| a.peak_base_force, 9, "N");
    row("rms f_B", &|a| a.rms_base_force, 9, "N");
    let drives = given.or(proposal.map(|p| &p.account)).map_or(0, |a| a.peak_torque.len());
    for k in 0..drives {
        row(&format!("peak |τ_{}|", k + 1), &|a| a.peak_torque[k], 6, "N m");
    }
    row("least b on the way", &|a| a.b_range[0], 6, "rad");
    row("greatest b on the way", &|a| a.b_range[1], 6, "rad");
    // The spline between the samples goes beyond them: both are said where they differ.
    let range = given.map(|a| a.b_range);
    if let Some(([low, high], [least, greatest])) = answer.b_samples.zip(range)
        && (low - least).max(greatest - high) > 5e-7
    {
        table.row(["least b of the samples".into(), fixed(low, 6), String::new(), "rad".into()]);
        table.row(["greatest b of the samples".into(), fixed(high, 6), String::new(), "rad".into()]);
    }
    let mut row = |name: &str, of: &dyn Fn(&Account) -> f64, decimals: usize, unit: &str| {
        let both = [given.map(of), proposal.map(|p| of(&p.account))];
        table.row([name.into(), cell(both[0], decimals), cell(both[1], decimals), unit.into()]);
    };
    row("momentum at the end", &|a| a.angular_momentum_end, 9, "kg m²/s");
    if let Some(p) = proposal {
        let mut row = |name: String, value: f64, decimals: usize, unit: &str| {
            table.row([name, String::new(), fixed(value, decimals), unit.into()]);
        };
        if given.is_some() {
            row("end effector off by up to".into(), p.tip_deviation, 9, "m");
            for (k, off) in p.joint_deviation.iter().enumerate() {
                row(format!("drive {} off by up to", k + 1), *off, 6, "rad");
            }
            row("drives off, rms".into(), p.rms_deviation, 6, "rad");
        }
        row("simulated: peak |n_B|".into(), p.simulated_peak_base_moment, 9, "N m");
    }
    let way = proposal.map(|p| {
        let kept = match p.way {
            "turned" => "the relative joint angles kept, the arm turned as a whole",
            "same-tip" => "the end effector's motion kept",
            "as-given" => "the motion as it is",
            _ => "the end effector's motion on one plane",
        };
        format!("\nproposed: b = {} rad, {kept}: {}\nreactionless: {}\n", fixed(p.b, 6), p.why, yes(p.reactionless))
    });
    let smoothed = answer
        .smoothed_at
        .zip(answer.smoothed_by)
        .map(|(at, by)| format!("smoothed at {} Hz, samples moved by up to {}\n", fixed(at, 3), fixed(by, 9)));
    format!(
        "{} over {} s\n{}{}{}",
        counted(answer.samples, "sample"),
        fixed(answer.duration, 6),
        smoothed.unwrap_or_default(),
        table.to_string().trim_start_matches('\n'),
        way.unwrap_or_default()
    )
}
