//! Good input with numbers, keys, lines and bytes changed at random.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// What decides: the same for the same seed, target and number.
pub struct Dice(ChaCha8Rng);

impl Dice {
    pub fn new(seed: u64, target: &str, number: u64) -> Self {
        let name =
            target.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01b3));
        let mut rng = ChaCha8Rng::seed_from_u64(seed ^ name);
        rng.set_stream(number);
        Self(rng)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.0.next_u64() % n.max(1) as u64) as usize
    }

    pub fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn pick<'a, T: ?Sized>(&mut self, from: &[&'a T]) -> &'a T {
        from[self.below(from.len())]
    }
}

const NUMBERS: &[&str] = &[
    "0",
    "-0.0",
    "1",
    "-1",
    "0.5",
    "2",
    "3",
    "1e-12",
    "1e-9",
    "1e-6",
    "1e-3",
    "-1e-9",
    "10",
    "100",
    "1e4",
    "1e6",
    "1000000",
    "1e9",
    "-2.3e18",
    "1e18",
    "9007199254740993",
    "9223372036854775807",
    "-9223372036854775808",
    "1e300",
    "-1e300",
    "1.7976931348623157e308",
    "5e-324",
    "1e-308",
    "nan",
    "inf",
    "-inf",
    "25.2",
    "3.141592653589793",
    "1e",
];

const WORDS: &[&str] = &[
    "name",
    "mass",
    "com",
    "inertia",
    "length",
    "l1",
    "l9",
    "link",
    "drive",
    "attach",
    "at",
    "tip",
    "root",
    "base",
    "from",
    "to",
    "via",
    "b",
    "time",
    "step",
    "duration",
    "kind",
    "shape",
    "law",
    "arc",
    "spline",
    "line",
    "fastest",
    "fastest-smooth",
    "closed",
    "cycles",
    "blend",
    "corners",
    "change-b",
    "least-reaction",
    "zero-momentum",
    "free",
    "compliant",
    "payload",
    "samples",
];

/// Some changes of an input; `other` is another good one.
pub fn mutated(good: &[u8], other: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..1 + dice.below(4) {
        change(&mut bytes, other, dice);
    }
    bytes
}

fn change(bytes: &mut Vec<u8>, other: &[u8], dice: &mut Dice) {
    match dice.below(16) {
        // Numbers most of all: they get past whoever reads the text.
        0..=7 => number(bytes, dice),
        8 => word(bytes, dice),
        9 => lines(bytes, other, dice),
        10 => lines(bytes, other, dice),
        11 => {
            let at = dice.below(bytes.len());
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << dice.below(8);
            }
        }
        12 => {
            let (at, many) = (dice.below(bytes.len() + 1), 1 + dice.below(20));
            bytes.drain(at..(at + many).min(bytes.len()));
        }
        13 => {
            let at = dice.below(bytes.len() + 1);
            let many = 1 + dice.below(8);
            let random: Vec<u8> = (0..many).map(|_| dice.below(256) as u8).collect();
            bytes.splice(at..at, random);
        }
        14 if dice.one_in(8) => {
            let at = dice.below(bytes.len() + 1);
            let many = [100, 2000, 50_000][dice.below(3)];
            let one = dice.pick(&[&b"["[..], b"{", b"9", b"x", b"\"", b"\n", b"\x1b[31m", b"a.", b"-1,"]);
            bytes.splice(at..at, one.repeat(many));
        }
        _ => {
            if dice.one_in(8) {
                bytes.truncate(dice.below(bytes.len() + 1));
            } else {
                number(bytes, dice);
            }
        }
    }
}

fn spans(bytes: &[u8], is: impl Fn(u8) -> bool, starts: impl Fn(u8) -> bool) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut i = 0;
    while i < bytes.len() {
        let fresh = i == 0 || !is(bytes[i - 1]);
        if starts(bytes[i]) && fresh {
            let end = bytes[i..].iter().position(|b| !is(*b)).map_or(bytes.len(), |n| i + n);
            found.push((i, end));
            i = end;
        } else {
            i += 1;
        }
    }
    found
}

fn number(bytes: &mut Vec<u8>, dice: &mut Dice) {
    let part = |b: u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+' | b'e' | b'E') || b.is_ascii_alphabetic();
    let found = spans(bytes, part, |b| b.is_ascii_digit() || b == b'-');
    if found.is_empty() {
        return word(bytes, dice);
    }
    let (from, to) = found[dice.below(found.len())];
    let own: Option<f64> = std::str::from_utf8(&bytes[from..to]).ok().and_then(|text| text.parse().ok());
    let new = match (own, dice.below(6)) {
        (Some(x), 0) => format!("{}", x * (1.0 + dice.between(-0.2, 0.2))),
        (Some(x), 1) => format!("{:e}", x * 10f64.powf(dice.between(-12.0, 12.0))),
        (Some(x), 2) => format!("{}", -x),
        (_, 3) => format!("{:e}", f64::from_bits(dice.0.next_u64())),
        (_, 4) => format!("{}", dice.between(-3.0, 3.0)),
        _ => dice.pick(NUMBERS).to_owned(),
    };
    bytes.splice(from..to, new.into_bytes());
}

fn word(bytes: &mut Vec<u8>, dice: &mut Dice) {
    let part = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'-');
    let found = spans(bytes, part, |b| b.is_ascii_alphabetic());
    if found.is_empty() {
        return;
    }
    let (from, to) = found[dice.below(found.len())];
    let new = match dice.one_in(2) {
        true => dice.pick(WORDS).as_bytes().to_vec(),
        false => {
            let (from, to) = found[dice.below(found.len())];
            bytes[from..to].to_vec()
        }
    };
    bytes.splice(from..to, new);
}

fn lines(bytes: &mut Vec<u8>, other: &[u8], dice: &mut Dice) {
    let mut own: Vec<Vec<u8>> = bytes.split(|b| *b == b'\n').map(<[u8]>::to_vec).collect();
    let others: Vec<&[u8]> = other.split(|b| *b == b'\n').collect();
    let at = dice.below(own.len());
    match dice.below(4) {
        0 => {
            own.remove(at);
        }
        1 => own.insert(at, own[at].clone()),
        2 => {
            let with = dice.below(own.len());
            own.swap(at, with);
        }
        _ => own.insert(at, others[dice.below(others.len())].to_vec()),
    }
    *bytes = own.join(&b'\n');
}
