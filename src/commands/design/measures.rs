//! Measures of a design, as text.

use stillbase_settings::number::{fixed, fixed_or_finer};
use stillbase_study::measures::Measures;

/// Formats the measures, one in each line.
pub fn text(measures: &Measures) -> String {
    let mut text = format!(
        "added mass       {} kg\nadded inertia    {} kg m², Σ D_k\n",
        fixed_or_finer(measures.added_mass, 6),
        fixed_or_finer(measures.added_inertia, 6)
    );
    if let Some(factor) = measures.mass_inertia_factor {
        text.push_str(&format!("mass–inertia     {}, M ratio + Σ D_k ratio, now to before\n", fixed(factor, 4)));
    }
    if let Some(beta) = measures.beta {
        let [force, moment, torque] =
            [beta.force, beta.moment, beta.torque].map(|ratio| ratio.map_or_else(|| "–".into(), |x| fixed(x, 4)));
        text.push_str(&format!("β                force {force}, moment {moment}, torque {torque}, now to before\n"));
    }
    text
}
