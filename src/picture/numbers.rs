//! Formatting of numbers: round values, signs and significant digits.

/// Rounds up to 1, 2 or 5 times a power of ten.
pub fn round_up(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|v| *v >= x * (1.0 - 1e-12)).unwrap_or(10.0 * decade)
}

/// Formats with fixed decimals and the sign U+2212 for minus; zero has no sign.
pub fn signed(x: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", x.abs());
    let zero = text.chars().all(|c| c == '0' || c == '.');
    if x < 0.0 && !zero { format!("−{text}") } else { text }
}

/// Formats with three significant digits, or as an integer from 1000 on; no trailing decimal zeros. NaN and ∞ give 0.
pub fn three_digits(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return "0".into();
    }
    let decimals = (2 - x.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = signed(x, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// Formats with up to six decimals, without trailing zeros.
pub fn round_number(x: f64) -> String {
    format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').into()
}

/// Formats an angle, rad, in degrees with one decimal; a zero decimal is omitted.
pub fn degrees(angle: f64) -> String {
    let text = signed(angle.to_degrees(), 1);
    text.strip_suffix(".0").map_or_else(|| text.clone(), Into::into)
}

/// Returns the multiples of a round step from `low` to `high`, and the step; the step divides the interval into at most
/// `count` parts.
pub fn round_ticks(low: f64, high: f64, count: f64) -> (Vec<f64>, f64) {
    let width = high - low;
    if !(width.is_finite() && width > 0.0 && low.abs().max(high.abs()) < 1e12 * width) {
        return (Vec::new(), 1.0);
    }
    let step = round_up(width / count.max(1.0));
    let (first, last) = ((low / step - 1e-6).ceil(), (high / step + 1e-6).floor());
    let count = (last - first).clamp(-1.0, 40.0) as i64;
    ((0..=count).map(|i| (first + i as f64) * step).collect(), step)
}

/// Maximum number of characters of a tick label beside a small plot.
const MAX_TICK_CHARS: usize = 7;

/// Formats the tick labels of an axis so that they fit beside a small plot. Numbers are plain, else in thousands (k),
/// millions (M) or billions (G), else with a power of ten.
pub fn ticks(values: &[f64], step: f64) -> Vec<String> {
    let fits = |texts: &[String]| texts.iter().all(|text| text.chars().count() <= MAX_TICK_CHARS);
    let whole: Vec<String> = values.iter().map(|x| at_step(*x, step)).collect();
    let wide =
        |text: &String| text.contains('e') || text.chars().filter(char::is_ascii_digit).count() >= MAX_TICK_CHARS;
    if fits(&whole) && !whole.iter().any(wide) {
        return whole;
    }
    let most = values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for (unit, letter) in [(1e9, "G"), (1e6, "M"), (1e3, "k")] {
        if most >= unit && most < 1e3 * unit {
            let brief = |x: &f64| if *x == 0.0 { "0".into() } else { at_step(x / unit, step / unit) + letter };
            let texts: Vec<String> = values.iter().map(brief).collect();
            if fits(&texts) {
                return texts;
            }
        }
    }
    values.iter().map(|x| power(*x, step)).collect()
}

/// Formats with a power of ten and as many decimals as `step` resolves, at most two.
fn power(x: f64, step: f64) -> String {
    if x.abs() < 0.5 * step.abs() || !x.is_finite() {
        return if x.is_finite() { "0".into() } else { "–".into() };
    }
    let digits = (x.abs().log10().floor() - (step.abs().log10() + 1e-9).floor()).clamp(0.0, 2.0) as usize;
    format!("{x:.digits$e}").replace('-', "−")
}

/// Formats a number with as many decimals as resolve `step`. If `step` is outside 10^−6.5 to 10^6.5, uses a power of
/// ten.
pub fn at_step(x: f64, step: f64) -> String {
    if !x.is_finite() {
        return "–".into();
    }
    let finest = step.abs().log10();
    if !finest.is_finite() || (-6.5..6.5).contains(&finest) {
        let decimals = if finest.is_finite() { (-finest - 1e-9).ceil().max(0.0) as usize } else { 3 };
        return signed(x, decimals);
    }
    if x.abs() < 0.5 * step {
        return "0".into();
    }
    let digits = (x.abs().log10().floor() - (finest + 1e-9).floor()).clamp(0.0, 15.0) as usize;
    format!("{x:.digits$e}").replace('-', "−")
}
