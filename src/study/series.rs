//! A [`Series`]: the samples of one signal, with what is needed to draw and to sum up any stretch of them at once.
//!
//! Above the samples stands a pyramid: blocks of 16 samples, of 16 such blocks and so on, each with its least and its
//! greatest sample, sum and sum of squares. A stretch of a million samples is so made up of some hundred blocks, and no
//! peak is lost. Sums are taken block by block, so nothing is lost by cancellation either.

use std::ops::Range;

/// Samples in a block, and blocks in a larger one.
const SHARE: usize = 16;

/// What is known of a stretch of samples. What is no finite number counts for nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Block {
    least: (usize, f64),
    greatest: (usize, f64),
    count: usize,
    sum: f64,
    squares: f64,
}

impl Block {
    const EMPTY: Self =
        Self { least: (0, f64::INFINITY), greatest: (0, f64::NEG_INFINITY), count: 0, sum: 0.0, squares: 0.0 };

    fn of(place: usize, value: f64) -> Self {
        match value.is_finite() {
            true => {
                Self { least: (place, value), greatest: (place, value), count: 1, sum: value, squares: value * value }
            }
            false => Self::EMPTY,
        }
    }

    /// With the block after it; of equal samples the first counts.
    fn and(self, next: Self) -> Self {
        Self {
            least: if next.least.1 < self.least.1 { next.least } else { self.least },
            greatest: if next.greatest.1 > self.greatest.1 { next.greatest } else { self.greatest },
            count: self.count + next.count,
            sum: self.sum + next.sum,
            squares: self.squares + next.squares,
        }
    }
}

/// What a stretch of samples comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// How many samples are numbers.
    pub count: usize,
    /// The least.
    pub least: f64,
    /// The greatest.
    pub greatest: f64,
    /// Their mean.
    pub mean: f64,
    /// The root of the mean of their squares.
    pub rms: f64,
}

/// Samples in the order of time.
#[derive(Clone, Debug, Default)]
pub struct Series {
    values: Vec<f64>,
    /// Whole blocks, of each size.
    levels: Vec<Vec<Block>>,
}

impl Series {
    /// The samples.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// One more sample.
    pub fn push(&mut self, value: f64) {
        self.values.push(value);
        let mut count = self.values.len();
        let mut level = 0;
        while count.is_multiple_of(SHARE) {
            let block = match level {
                0 => {
                    let from = count - SHARE;
                    let samples = self.values[from..].iter().enumerate();
                    samples.fold(Block::EMPTY, |all, (i, value)| all.and(Block::of(from + i, *value)))
                }
                _ => self.levels[level - 1][count - SHARE..].iter().fold(Block::EMPTY, |all, block| all.and(*block)),
            };
            if level == self.levels.len() {
                self.levels.push(Vec::new());
            }
            self.levels[level].push(block);
            count = self.levels[level].len();
            level += 1;
        }
    }

    /// Only the first samples, so many of them.
    pub fn truncate(&mut self, count: usize) {
        self.values.truncate(count);
        let mut size = 1;
        for level in &mut self.levels {
            size *= SHARE;
            level.truncate(count / size);
        }
    }

    /// What is known of a stretch.
    fn block(&self, range: Range<usize>) -> Block {
        let (mut from, to) = (range.start, range.end.min(self.values.len()));
        let mut all = Block::EMPTY;
        while from < to {
            // The largest whole block that begins here and does not reach too far.
            let (mut size, mut level) = (1, 0);
            while level < self.levels.len() && from.is_multiple_of(size * SHARE) && from + size * SHARE <= to {
                size *= SHARE;
                level += 1;
            }
            all = all.and(match level {
                0 => Block::of(from, self.values[from]),
                level => self.levels[level - 1][from / size],
            });
            from += size;
        }
        all
    }

    /// Where the least and the greatest sample of a stretch stand; none where no sample is a number.
    pub fn extremes(&self, range: Range<usize>) -> Option<[usize; 2]> {
        let block = self.block(range);
        (block.count > 0).then_some([block.least.0, block.greatest.0])
    }

    /// What a stretch comes to; none where no sample is a number.
    pub fn statistics(&self, range: Range<usize>) -> Option<Statistics> {
        let block = self.block(range);
        let count = block.count as f64;
        (block.count > 0).then(|| Statistics {
            count: block.count,
            least: block.least.1,
            greatest: block.greatest.1,
            mean: block.sum / count,
            rms: (block.squares / count).sqrt(),
        })
    }
}

impl FromIterator<f64> for Series {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut series = Self::default();
        values.into_iter().for_each(|value| series.push(value));
        series
    }
}
