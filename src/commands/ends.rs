//! Parses a lower and an upper bound in an argument of the command line, alone or after a name.

/// Parses LO,HI, both finite.
pub fn parse_bounds(text: &str) -> Option<[f64; 2]> {
    let (low, high) = text.split_once(',')?;
    let end = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    Some([end(low)?, end(high)?])
}

/// Parses NAME=LO,HI, both finite.
pub fn named(text: &str) -> Option<(String, [f64; 2])> {
    let (name, rest) = text.split_once('=')?;
    Some((name.trim().into(), parse_bounds(rest)?))
}
