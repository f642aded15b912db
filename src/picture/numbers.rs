//! Numbers as a person reads them: round ones, signs, and no more digits than matter.

/// The next of 1, 2, 5 times a power of ten.
pub fn round_up(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|v| *v >= x * (1.0 - 1e-12)).unwrap_or(10.0 * decade)
}

/// Fixed decimals with a real minus sign, and no minus on zero.
pub fn signed(x: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", x.abs());
    let zero = text.chars().all(|c| c == '0' || c == '.');
    if x < 0.0 && !zero { format!("−{text}") } else { text }
}

/// Three digits, without zeros at the end.
pub fn three_digits(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return "0".into();
    }
    let decimals = (2 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = signed(x, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// A round number as it is, up to six decimals.
pub fn round_number(x: f64) -> String {
    format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').into()
}

/// An angle in whole degrees, or with a digit where it has one.
pub fn degrees(angle: f64) -> String {
    let text = signed(angle.to_degrees(), 1);
    text.strip_suffix(".0").map_or_else(|| text.clone(), Into::into)
}
