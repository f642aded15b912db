//! [`Series`]: the samples of one signal, with fast extremes and statistics of any range.
//!
//! A pyramid of blocks summarises the samples: blocks of 16 samples, of 16 such blocks, and so on. Each block stores
//! its smallest and largest sample, sum and sum of squares. A range of a million samples then consists of some hundred
//! blocks, and no peak is lost. Sums are added block by block, never as differences of running sums, so that nothing
//! cancels.

use std::ops::Range;

/// Number of samples in a block, and of blocks in the next larger one.
const BLOCK_LEN: usize = 16;

/// Statistics of a block of samples; samples that are not finite are ignored.
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

    /// Joins the block with the next one; of equal samples, the first is kept.
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

/// Statistics of a range of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// Number of finite samples.
    pub count: usize,
    /// Smallest sample.
    pub least: f64,
    /// Largest sample.
    pub greatest: f64,
    /// Mean.
    pub mean: f64,
    /// Root mean square.
    pub rms: f64,
}

/// Samples in the order of time.
#[derive(Clone, Debug, Default)]
pub struct Series {
    values: Vec<f64>,
    /// Complete blocks of each size.
    levels: Vec<Vec<Block>>,
}

impl Series {
    /// Returns the samples.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Appends a sample.
    pub fn push(&mut self, value: f64) {
        self.values.push(value);
        let mut count = self.values.len();
        let mut level = 0;
        while count.is_multiple_of(BLOCK_LEN) {
            let block = match level {
                0 => {
                    let from = count - BLOCK_LEN;
                    let samples = self.values[from..].iter().enumerate();
                    samples.fold(Block::EMPTY, |all, (i, value)| all.and(Block::of(from + i, *value)))
                }
                _ => {
                    self.levels[level - 1][count - BLOCK_LEN..].iter().fold(Block::EMPTY, |all, block| all.and(*block))
                }
            };
            if level == self.levels.len() {
                self.levels.push(Vec::new());
            }
            self.levels[level].push(block);
            count = self.levels[level].len();
            level += 1;
        }
    }

    /// Keeps the first `count` samples.
    pub fn truncate(&mut self, count: usize) {
        self.values.truncate(count);
        let mut size = 1;
        for level in &mut self.levels {
            size *= BLOCK_LEN;
            level.truncate(count / size);
        }
    }

    /// Returns the statistics of a range.
    fn block(&self, range: Range<usize>) -> Block {
        let (mut from, to) = (range.start, range.end.min(self.values.len()));
        let mut all = Block::EMPTY;
        while from < to {
            // The largest complete block that begins here and ends within the range.
            let (mut size, mut level) = (1, 0);
            while level < self.levels.len() && from.is_multiple_of(size * BLOCK_LEN) && from + size * BLOCK_LEN <= to {
                size *= BLOCK_LEN;
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

    /// Returns the indices of the smallest and the largest sample in a range; `None` if no sample is finite.
    pub fn extremes(&self, range: Range<usize>) -> Option<[usize; 2]> {
        let block = self.block(range);
        (block.count > 0).then_some([block.least.0, block.greatest.0])
    }

    /// Returns the statistics of a range; `None` if no sample is finite.
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
